//! `whitewater demo`: the built-in scene.

use whitewater::Settings;
use whitewater::io::particles::{self, Extension};

use crate::args::DemoArgs;
use crate::backdrop::Backdrop;
use crate::camera::CameraFile;
use crate::failure::{Failure, Outcome};
use crate::output;
use crate::progress::Progress;
use crate::session::{self, Look, Session};
use crate::settings::SettingsFile;

const PARTICLES: &[u8] = include_bytes!("../../../assets/waterfall/waterfall_0240.bgeo");
const SCENE: &str = include_str!("../../../assets/waterfall/scene.json");

pub fn run(args: &DemoArgs) -> Outcome<()> {
    let began = std::time::Instant::now();
    let checked = session::check(&args.draw, false)?;
    for target in &checked.0 {
        output::probe(&target.path(0))?;
    }
    let settings_file = args.draw.settings.as_deref().map(SettingsFile::read).transpose()?;
    let environment = session::environment(&args.draw)?;
    let particles = particles::read_bytes(PARTICLES, Extension::Bgeo)?;
    let backdrop = Backdrop::parse(SCENE).map_err(Failure::input)?;
    let mut settings = Settings { light: environment.light(), ..Settings::default() };
    if let Some(fluid) = &backdrop.fluid {
        settings.water.spacing = fluid.spacing;
    }
    settings_file.unwrap_or_default().apply(&mut settings).map_err(Failure::input)?;
    let camera = match CameraFile::from_args(&args.camera)? {
        Some(camera) => camera,
        None => CameraFile {
            fov_y_degrees: args.camera.fov.or(Some(38.0)),
            ..backdrop.camera.clone().unwrap_or_default()
        },
    };
    let count = particles.positions.len();
    let look = Look { camera, settings, environment, backdrop };
    let mut session = Session::new(&args.draw, checked, look)?;
    let mut progress = Progress::new(1);
    session.frame(0, "waterfall", &particles)?;
    let paths: Vec<_> = session.paths(0).iter().map(|p| p.display().to_string()).collect();
    progress.advance(&format!(
        "{count} particles, {:.2} s, {}",
        began.elapsed().as_secs_f32(),
        paths.join(" and ")
    ));
    session.finish()
}
