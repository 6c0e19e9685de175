//! `whitewater demo`: the built-in scene.

use glam::Vec3;
use whitewater::LightVolume;
use whitewater::headless::scene::Scene;
use whitewater::io::particles::{self, Extension};

use crate::args::{DemoArgs, Foaming, SetArg, SprayArg};
use crate::bounds::Bounds;
use crate::camera::CameraFile;
use crate::failure::{Failure, Outcome};
use crate::looks::{LONE, foam_of_caches, impact_speed, spray_of_caches, waves_of_caches};
use crate::output;
use crate::progress::Progress;
use crate::session::{self, Look, Session};
use crate::settings::{FoamBy, SettingsFile};
use crate::stage;
use crate::surface_foam;
use crate::written;

const PARTICLES: &[u8] = include_bytes!("../../../assets/waterfall/waterfall_0240.bgeo");
const SCENE: &[u8] = include_bytes!("../../../assets/waterfall/scene.json");

/// Particle spacing, as in the scene.
const SPACING: f32 = 0.04;

/// Density limits of the spray.
const DENSITIES: [f32; 3] = [0.5, 0.8, 0.85];

/// Camera above the corner of the basin: it shows the chute, the fall, the pool and some sky.
fn viewpoint(fov: Option<f32>) -> CameraFile {
    CameraFile {
        eye: Some([1.9, 1.75, 3.1]),
        target: Some([-0.4, 0.52, 0.0]),
        up: Some([0.0, 1.0, 0.0]),
        fov_y_degrees: fov.or(Some(36.0)),
        ..CameraFile::default()
    }
}

pub fn run(args: &DemoArgs) -> Outcome<()> {
    let began = std::time::Instant::now();
    written::check_pictures(&args.draw, &[args.camera.file.as_deref()])?;
    let checked = session::check(&args.draw, false)?;
    for target in &checked.0 {
        output::probe(&target.path(0))?;
    }
    let mut file = SettingsFile::of_args(&args.draw)?;
    let camera = match CameraFile::from_args(&args.camera)? {
        Some(camera) => camera,
        None => viewpoint(args.camera.fov),
    };
    camera.check([0], args.draw.size)?;
    // The light is the same as `render` uses for particle files. The sun's position follows from the demo's own
    // viewpoint, also if the user sets another camera.
    let eye = Vec3::from(viewpoint(None).eye.unwrap_or_default());
    let environment = session::environment(&args.draw, Some(stage::side_light(eye)))?;
    let particles = particles::read_bytes(PARTICLES, Extension::Bgeo)?;
    let mut scene = Scene::parse_json(SCENE).map_err(Failure::input)?;
    stage::furnish(&mut scene, eye, SetArg::Pool);
    environment.light_scene(&mut scene);
    let mut settings = file.look(SPACING, environment.light());
    settings.noise = session::noise(&args.draw, &file);
    if !file.is_thesis() {
        foam_of_caches(&mut settings.surface_foam, SPACING);
        let bounds = Bounds::of_bulk(&particles.positions);
        if let Some(bounds) = bounds {
            waves_of_caches(&mut settings.water, SPACING, &bounds);
        }
        let speed = impact_speed(std::slice::from_ref(&particles));
        spray_of_caches(&mut settings.spray, SPACING, speed);
        // The particles are large, so one drop for each of them would be too large, and many tiny drops for each
        // would look like a star.
        (settings.spray.droplets, settings.spray.size) = (40, 0.12);
        [
            settings.spray.all_spray_density,
            settings.spray.full_water_density,
            settings.spray.no_spray_density,
        ] = DENSITIES;
        settings.water.ellipsoids.lone = LONE;
    }
    file.apply(&mut settings);
    let count = particles.positions.len();
    let foam = args.draw.surface_foam.unwrap_or(Foaming::Auto);
    let spray = args.draw.spray != Some(SprayArg::None);
    let frames = std::slice::from_ref(&particles);
    // The threshold of its foam was chosen for the Weber number of speed.
    let by = *file.surface_foam.by.get_or_insert(FoamBy::Speed);
    let foam = surface_foam::settings(foam, (&file.surface_foam, by), frames, &[0.0], &settings);
    let bounds = Bounds::of_bulk(&particles.positions);
    let region = bounds.map_or(LightVolume { center: [0.0; 3], radius: 1.0 }, |b| b.region());
    let (whitewater, fps, rate) = (None, None, None);
    let look = Look {
        camera,
        settings,
        fluids: Vec::new(),
        photograph: !file.is_thesis(),
        file,
        environment,
        scene,
        matte: false,
        still: None,
        foam,
        whitewater,
        bubbles: None,
        shores: None,
        exposure: stage::exposure(SetArg::Pool),
        spray,
        region,
        fps,
        clock: None,
        rate,
        film: crate::reader::DEFAULT_FPS,
        fullest: count,
    };
    let mut progress = Progress::new(1, "frames");
    let mut session = Session::new(&args.draw, checked, look, progress.steps())?;
    session.frame(0, None, "waterfall", &particles)?;
    let paths: Vec<_> = session.paths(0).iter().map(|p| p.display().to_string()).collect();
    progress.advance(&format!(
        "{count} particles, {:.2} s, {}",
        began.elapsed().as_secs_f32(),
        paths.join(" and ")
    ));
    session.finish()
}
