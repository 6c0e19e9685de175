//! Default look of the water of cache files: camera, light, surroundings, liquid, foam and spray, found from the
//! particles.

use glam::{Quat, Vec3};
use whitewater::WhitewaterSettings;
use whitewater::headless::scene::Scene;
use whitewater::io::particles::Particles;
use whitewater::water::Medium;
use whitewater::water::{Ellipsoids, SpraySettings, SurfaceFoamSettings, WaterSettings};

use crate::args::{Foaming, RenderArgs, SetArg, SprayArg, Whitewater};
use crate::bounds::Bounds;
use crate::camera::CameraFile;
use crate::environment::Environment;
use crate::failure::{Failure, Outcome};
use crate::generate::Generate;
use crate::placing;
use crate::probes::Probes;
use crate::progress::Progress;
use crate::reader::DEFAULT_FPS;
use crate::session::{self, Look};
use crate::settings::{FoamBy, SettingsFile};
use crate::spouts;
use crate::stage;
use crate::surface_foam;
use crate::turntable::Turning;
use crate::whitewater_source;

/// Impact speed of the water of a sequence in m/s: the larger of the speed of its fastest particles and the speed after
/// a fall from its highest particles to its lowest.
pub fn impact_speed(frames: &[Particles]) -> f32 {
    let fall = |frame: &Particles| {
        // Without strays, since one is enough to change the height.
        let bulk = Bounds::of_bulk(&frame.positions)?;
        let inside = frame.positions.iter().filter(|p| bulk.contains(Vec3::from(**p)));
        let heights: Vec<f32> = inside.map(|p| p[1]).collect();
        let [low, high] = [0.02, 0.998].map(|part| surface_foam::quantile(heights.clone(), part));
        Some((2.0 * 9.81 * (high? - low?)).sqrt())
    };
    let each = frames.iter().flat_map(|frame| [fall(frame), placing::fastest(frame)]);
    each.flatten().fold(0.0, f32::max)
}

/// Frame rate above which a film is faster than most screens, frames per second.
const SHOWN_FPS: f32 = 60.0;

/// Density limits of spray in caches: only lone particles, or nearly lone ones, are all spray. Solvers' densities are
/// low at every surface, in sheets and in jets, so that the library's limit of 0.85 turns most of a splash to spray (82
/// % of the highest tenth of two solid jets; limits of 0.44, 0.66 and 0.7 turn 23 %, these fewer). A particle with one neighbour one spacing
/// away has 0.40, one in a line 0.48. Sheets of one layer (0.70) stay water, and so do bumps on a pool's surface (0.63
/// or more), which would be white stains; water that is torn further stays water with droplets around it.
const SPRAY_DENSITIES: [f32; 3] = [0.44, 0.60, 0.63];

/// Density limits at which a lone particle (0.318) is drawn as a whole drop of water.
const WHOLE_DROPS: (f32, f32) = (0.0, 0.3);

/// Radius of a lone particle, or of two at one place, relative to a whole one, which would be a glass ball as large as a
/// fist.
pub const LONE: f32 = 0.35;

/// Replaces the library's spray settings by those for caches. A particle is as much water as some hundred drops, so
/// there are many small droplets, scattered widely enough to hide their repeating pattern. They are stretched along
/// their motion, by their differences in speed over a third of the time of a fall through a spacing. Mist comes from
/// fast water: its share grows with the Weber number, the square of the speed, up to 6 m/s.
pub fn spray_of_caches(spray: &mut SpraySettings, spacing: f32, speed: f32) {
    let torn = (speed / 6.0).min(1.0).powi(2);
    *spray = spray.with(|it| {
        [it.all_spray_density, it.full_water_density, it.no_spray_density] = SPRAY_DENSITIES;
        it.opacity = 0.95;
        it.droplets = 64;
        it.size = 0.185;
        it.max_angle = 0.003;
        it.scatter_radius = 4.5;
        it.stretch = (0.4 * (spacing / 9.81).sqrt()).min(1.0);
        it.mist = 0.3 * torn;
        it.mist_size = 2.4;
        it.clumps = 0.7;
        it.strand_ratio = 6.0;
        it.few_neighbours = [3.5, 9.0];
        it.exposure = 0.003;
        it.shade = 2.5 + 31.0 * torn;
        it.scattering = 0.6;
        it.relief = 2.5;
        it.glints = 12.0;
    });
}

/// Replaces the library's foam settings by those for caches: thin foam is lace, as dim as the water under it, and all
/// foam is lit by the shape of the splash. (With the library's full relief, which is as large as a particle, it looks
/// like gravel; with its veil, like a cloud.)
pub fn foam_of_caches(foam: &mut SurfaceFoamSettings, spacing: f32) {
    *foam = foam.with(|it| {
        it.extinction = 0.35 / spacing;
        it.front_extinction = 0.1 / spacing;
        it.min_thickness = 0.1 * spacing;
        it.normal_strength = 0.35;
        it.lace = 1.0;
        it.lace_size = 0.8;
        it.lace_shade = 1.0;
        // Accelerating water shears the lace; the longer the period, the farther.
        it.pattern_period = (5.0 * (spacing / 9.81).sqrt()).min(1.0);
        it.aeration = 0.6;
        it.shape = 0.8;
        it.few_neighbours = [7.0, 12.0];
        it.back_color = [0.62, 0.68, 0.73];
        it.front_color = [0.97; 3];
    });
}

/// Replaces the library's whitewater settings by those for caches: as bright as the spray beside it, and of more sizes.
pub fn whitewater_of_caches(whitewater: &mut WhitewaterSettings) {
    whitewater.scale = 1.3;
    whitewater.sizes = whitewater_source::VARIETY;
}

/// Sets small waves on level water. Particles resolve waves of four spacings and more. Wavelength also grows with the
/// basin's width, because the waves tell the eye how large the basin is.
pub fn waves_of_caches(water: &mut WaterSettings, spacing: f32, bounds: &Bounds) {
    let wide = bounds.size().x.max(bounds.size().z);
    water.wavelets.slope = 0.08;
    water.wavelets.length = (6.0 * spacing).max(0.13 * wide);
}

/// Width in metres below which water has its natural clarity: a glass or a tub, for which the colour of a pool is too
/// blue.
const SMALL: f32 = 2.0;
/// Part of a pool's colour that comes from the water itself; the rest comes from blue tiles.
const OWN_BLUE: f32 = 0.45;
/// Width in metres above which the water is clearer than nature, so that its ground is visible. Natural water of that
/// depth is dark, and few solvers' units are metres.
const LARGE: f32 = 10.0;

/// Depth of pool water, in metres, whose colour a sheet of two-dimensional water has. The thickness of the sheet, one
/// spacing, is the solver's choice, and so little water has no colour.
const SHEET: f32 = 1.0;

/// Results that are found before the look.
pub struct Found {
    pub camera: Option<CameraFile>,
    pub spacing: f32,
    pub files: Option<whitewater_source::Files>,
    /// Index of the axis perpendicular to a two-dimensional sheet of particles.
    pub sheet: Option<usize>,
}

/// Values that decide which times are needed.
#[derive(Clone, Copy)]
pub struct Sequence {
    /// Whether there is more than one frame.
    pub is: bool,
    /// Whether motion vectors are written.
    pub motion: bool,
    /// Step between frame numbers, if a film is written.
    pub film: Option<f32>,
    /// Orbit of the camera.
    pub turning: Option<Turning>,
    /// The only frame that is drawn, in all pictures.
    pub still: Option<u64>,
    /// Value of `--fps`.
    pub said: Option<f32>,
    /// Step from one frame number to the next.
    pub step: f32,
}

/// The particles rotated to eight sides, and their bounding box. A camera that sees all of these sees the water during
/// a whole orbit.
fn from_all_sides(frames: &[Particles], bounds: &Bounds) -> (Vec<Vec<[f32; 3]>>, Bounds) {
    let centre = bounds.center();
    let mut all = Vec::new();
    for positions in frames.iter().map(|frame| &frame.positions) {
        let step = positions.len().div_ceil(20_000).max(1);
        let inside = positions.iter().step_by(step).map(|p| Vec3::from(*p));
        let inside: Vec<Vec3> = inside.filter(|p| bounds.contains(*p)).collect();
        for side in 0..8_u8 {
            let turned = Quat::from_rotation_y(f32::from(side) * std::f32::consts::FRAC_PI_4);
            let at = |p: &Vec3| (centre + turned * (*p - centre)).to_array();
            all.push(inside.iter().map(at).collect());
        }
    }
    let reach = 0.5 * bounds.size().with_y(0.0).length();
    let reach = Vec3::new(reach, 0.5 * bounds.size().y, reach);
    (all, Bounds { min: centre - reach, max: centre + reach })
}

/// The look of a run: from arguments and settings, with the rest found from the particles.
pub fn look(
    args: &RenderArgs,
    sequence: Sequence,
    probes: &mut Probes,
    found: Found,
    mut file: SettingsFile,
    environment: Environment,
    progress: &Progress,
) -> Outcome<Look> {
    let Found { camera, spacing, mut files, sheet } = found;
    let unit = Bounds { min: Vec3::splat(-1.0), max: Vec3::ONE };
    let bounds = probes.bounds().unwrap_or(unit).padded(0.5 * spacing);
    let mut settings = file.look(spacing, environment.light());
    if let Some(density) = probes.rest_density() {
        if density != settings.water.rest_density && file.water.rest_density.is_none() {
            progress
                .say(&format!("rest density {density} (estimated; water.rest_density sets it)"));
        }
        settings.water.rest_density = density;
    }
    settings.noise = session::noise(&args.draw, &file);
    // If there are few particles, spray would leave no water to see. The limits of spray count the neighbours in a
    // volume; those in a plane are too few.
    let few = probes.spacing().is_none();
    let lone = args.draw.spray.is_none() && (few || sheet.is_some());
    if !file.is_thesis() {
        spray_of_caches(&mut settings.spray, spacing, impact_speed(&probes.frames));
        foam_of_caches(&mut settings.surface_foam, spacing);
        if args.draw.spray == Some(SprayArg::None) || lone {
            // Nothing disappears: particles that would be spray are drawn as water.
            (settings.water.density_threshold, settings.water.density_full) = WHOLE_DROPS;
        } else {
            settings.water.ellipsoids.lone = LONE;
        }
        whitewater_of_caches(&mut settings.whitewater);
        waves_of_caches(&mut settings.water, spacing, &bounds);
        let wide = bounds.size().x.max(bounds.size().z);
        if sheet.is_some() {
            settings.water.medium = Medium::POOL.thinned(SHEET / spacing);
            file.water.leave_straight();
            if file.water.medium.is_none() {
                progress.say(&format!(
                    "the sheet has the colour of {SHEET} metre of pool water (--medium, table [water] medium)"
                ));
            }
        } else if wide < SMALL {
            settings.water.medium = Medium::CLEAR;
        } else if args.scene.is_none() && args.set.unwrap_or_default() == SetArg::Pool {
            settings.water.medium = settings.water.medium.thinned(OWN_BLUE);
        }
        if wide > LARGE && sheet.is_none() && file.water.medium.is_none() {
            settings.water.medium = settings.water.medium.thinned(LARGE / wide);
            let wide = round(wide);
            progress.say(&format!(
                "water {wide} metres wide is drawn as clear as a pool {LARGE} metres wide (--unit, if lengths are not in \
                 metres; table [water] medium)"
            ));
        }
    }
    file.apply(&mut settings);
    settings.water.spacing = spacing;
    // The sums of the neighbours' weights grow with the volume that they are searched in.
    let volume = (settings.water.ellipsoids.reach / Ellipsoids::default().reach).powi(3);
    let scaled = |sums: [f32; 2]| sums.map(|sum| (sum * volume).min(64.0));
    if file.spray.few_neighbours.is_none() {
        settings.spray.few_neighbours = scaled(settings.spray.few_neighbours);
    }
    if file.surface_foam.few_neighbours.is_none() {
        settings.surface_foam.few_neighbours = scaled(settings.surface_foam.few_neighbours);
    }
    if let Some(files) = &mut files {
        files.choose(&file, &mut settings);
        if let Some([foam, spray, bubbles]) =
            files.radii().filter(|_| file.whitewater.radii.is_none())
        {
            let copies = files.copies();
            if copies > 1 {
                progress
                    .say(&format!("each whitewater particle is drawn as {copies} scattered ones, because there are few"));
            }
            progress.say(&format!(
                "whitewater particles with radii of {}, {} and {} (foam, spray, bubbles) and half_intensity_thickness = {} (found; table \
                 [whitewater] sets them)",
                round(foam),
                round(spray),
                round(bubbles),
                round(settings.whitewater.half_intensity_thickness),
            ));
        }
        // The picture stores the settings it was drawn with.
        file.whitewater.radii = files.radii();
        file.whitewater.copies = file.whitewater.radii.map(|_| files.copies());
    }

    let camera = camera.unwrap_or_else(|| {
        let (fov, size) = (args.camera.fov, args.draw.size);
        let camera = match sequence.turning {
            Some(_) => {
                let (frames, round) = from_all_sides(&probes.frames, &bounds);
                let frames: Vec<_> = frames.iter().map(|positions| &positions[..]).collect();
                CameraFile::of_particles(&frames, &round, fov, size).over(bounds.center())
            }
            None => {
                let mut frames: Vec<_> = probes.frames.iter().map(|f| &f.positions[..]).collect();
                // A margin, so that a lone drop does not fill the picture.
                let room = bounds.padded(2.0 * spacing);
                let of = |side: usize| if side == 0 { room.min } else { room.max };
                let corners = [0, 1, 2, 3, 4, 5, 6, 7]
                    .map(|i: usize| [of(i & 1).x, of(i >> 1 & 1).y, of(i >> 2).z]);
                if few {
                    frames = vec![&corners];
                }
                match sheet {
                    Some(across) => CameraFile::of_sheet(across == 0, &frames, &bounds, fov, size),
                    None => {
                        let bounds = if few { room } else { bounds };
                        CameraFile::of_particles(&frames, &bounds, fov, size)
                    }
                }
            }
        };
        progress.say(&format!("camera {} (found; --camera sets it)", camera.json()));
        camera
    });
    let mut environment = environment;
    let set = args.set.unwrap_or_default();
    let view = camera.at_frame(probes.first).camera(args.draw.size)?.view_matrix();
    let eye = view.inverse().transform_point3(Vec3::ZERO);
    if set == SetArg::None && args.scene.is_some() {
        return Err(Failure::usage(
            "--set none draws no scene, but --scene names one; leave one of them out",
        ));
    }
    let surrounded = args.scene.is_none() || args.set.is_some();
    // The sun is placed so that the basin's walls do not block it and it shines through the spray.
    let own_sky = surrounded && args.draw.environment == "sky";
    let sun = own_sky.then(|| stage::side_light(eye - bounds.center()));
    let mut scene = match &args.scene {
        None if set == SetArg::None => Scene::default(),
        Some(path) if path.as_os_str() == "ground" => stage::ground_under(&bounds, eye, set),
        Some(path) => {
            let mut scene = stage::read(path)?;
            if args.set.is_some() {
                stage::furnish(&mut scene, eye, set);
            }
            scene
        }
        None => {
            let inside = |frame: &Particles| -> Vec<[f32; 3]> {
                let inside = frame.positions.iter().filter(|p| bounds.contains(Vec3::from(**p)));
                inside.copied().collect()
            };
            let frames: Vec<_> = probes.frames.iter().map(inside).collect();
            let frames: Vec<_> = frames.iter().map(|positions| &positions[..]).collect();
            let seen_from = (eye, sequence.turning.is_some());
            let jets = probes.frames.iter().find_map(|frame| {
                let velocities = frame.velocities.as_ref()?;
                let found = spouts::find(&frame.positions, velocities, spacing, bounds.min.y);
                (!found.is_empty()).then_some(found)
            });
            let jets = jets.unwrap_or_default();
            let basin = stage::basin_round(&frames, &bounds, spacing, seen_from, set, &jets);
            match basin.filter(|_| sheet.is_none()) {
                Some(basin) => {
                    let spouts = match jets.len() {
                        0 => "",
                        1 => ", and a spout where a jet begins in mid-air",
                        _ => ", and spouts where jets begin in mid-air",
                    };
                    progress.say(&format!(
                        "drawn as well: a basin (the water stands against sides of a box){spouts}; --scene ground \
                         leaves it out"
                    ));
                    basin
                }
                None => stage::ground_under(&bounds, eye, set),
            }
        }
    };
    let plain = args.draw.environment == "sky" && args.draw.sun.is_none() && surrounded;
    let own = if plain { stage::light(set, eye - bounds.center())? } else { None };
    if sun.is_some() || own.is_some() {
        environment = match own {
            Some(own) => own,
            None => session::environment(&args.draw, sun)?,
        };
        settings.light = file.in_light(environment.light());
        file.light.put(&mut settings.light);
    }
    environment.light_scene(&mut scene);
    let spray = args.draw.spray.unwrap_or(if lone { SprayArg::None } else { SprayArg::Auto });
    let spray = spray == SprayArg::Auto;
    // The same as in `Session::frame`.
    for frame in probes.frames.iter_mut().filter(|frame| frame.densities.is_none()) {
        frame.densities = session::guessed_densities(spray, frame, &settings.water);
    }
    let fps = sequence.said.or(probes.fps).unwrap_or(DEFAULT_FPS * sequence.step);
    let camera = match sequence.turning {
        Some(turning) => camera.turned(turning.turn(fps))?,
        None => camera,
    };
    let seconds: Vec<f32> =
        probes.numbers.iter().map(|n| n.saturating_sub(probes.first) as f32 / fps).collect();
    let wanted = args.draw.surface_foam.unwrap_or(Foaming::Auto);
    let by = file.surface_foam.by(wanted, file.is_thesis());
    file.surface_foam.by = Some(by);
    if by == FoamBy::Air {
        file.surface_foam.turbulence.get_or_insert(surface_foam::TURBULENCE);
    }
    let foam = surface_foam::settings(
        wanted,
        (&file.surface_foam, by),
        &probes.frames,
        &seconds,
        &settings,
    );
    if let Some(foam) = &foam {
        let of = match by {
            FoamBy::Air => "of trapped air ",
            FoamBy::Speed => "",
        };
        let number = round(foam.threshold);
        progress.say(&format!(
            "surface foam from Weber number {of}{number} on (--surface-foam sets it; none)"
        ));
    } else if wanted == Foaming::Auto && probes.frames.iter().any(|f| f.velocities.is_some()) {
        let onset = surface_foam::ONSET;
        progress.say(&format!(
            "no foam: the water is calm or moves as a whole; it entrains air from {onset} m/s relative to its \
             surroundings (--surface-foam N sets a Weber number; --unit, if lengths are not in metres)"
        ));
    }
    let moving = |f: &Particles| f.velocities.is_some() && f.ids.is_some();
    let made = args.whitewater == [Whitewater::Generate];
    if made && !probes.frames.iter().any(|frame| frame.velocities.is_some()) {
        let why = "--whitewater generate: expected velocities in the files, or a sequence whose particles have ids or \
             keep their order, found neither";
        return Err(Failure::input(why));
    }
    if made && file.generate.max_particles == Some(0) {
        let why = "[generate] max_particles: expected 1 or more, found 0";
        return Err(Failure::input(why));
    }
    let remembers = sequence.is && (made || foam.is_some() && probes.frames.iter().any(moving));
    let vectors = sequence.motion && (sequence.is || sequence.still.is_some());
    let film = fps / sequence.film.unwrap_or(1.0);
    let clock = sequence.is.then(|| {
        if args.fps.is_none() {
            let found = if probes.fps.is_some() { "found" } else { "assumed" };
            let fps = round(fps / sequence.step);
            progress.say(&format!("{fps} frames a second ({found}; --fps sets it)"));
        }
        if sequence.film.is_some() && args.draw.film_fps.is_none() && film > SHOWN_FPS {
            let rate = round(film);
            progress.say(&format!("the film has {rate} frames a second, more than most screens show (--film-fps sets it)"));
        }
        fps
    });
    let region = bounds.region();
    let rate = vectors.then_some(fps);
    let fps = clock.filter(|_| remembers);
    let fullest = probes.frames.iter().map(|f| f.positions.len()).max().unwrap_or(0);
    let whitewater = match made {
        true => {
            let probes = std::mem::take(&mut probes.frames);
            let seconds = fps.map(|_| seconds.last().copied().unwrap_or(0.0));
            let table = file.generate.clone();
            let generate = Generate::new(table, spacing, &bounds, seconds, probes)?;
            Some(whitewater_source::WhitewaterSource::Made(Box::new(generate)))
        }
        false => files.map(whitewater_source::WhitewaterSource::Files),
    };
    let matte = set == SetArg::None;
    Ok(Look {
        camera,
        settings,
        fluids: Vec::new(),
        photograph: args.fluids.is_empty()
            && !(sequence.is || sequence.still.is_some() || matte || file.is_thesis()),
        file,
        environment,
        scene,
        matte,
        still: sequence.still,
        foam,
        whitewater,
        bubbles: None,
        shores: None,
        exposure: stage::exposure(set),
        spray,
        region,
        fps,
        clock,
        rate,
        film,
        fullest,
    })
}

/// Rounds to four significant digits for messages.
pub fn round(value: f32) -> f32 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A column of water 2 metres high, with strays high above it.
    fn column(strays: usize) -> Particles {
        let at =
            |i: usize| [0.1 * (i % 10) as f32, 0.02 * (i / 100) as f32, 0.1 * (i / 10 % 10) as f32];
        let mut positions: Vec<_> = (0..10_001).map(at).collect();
        positions.extend((1..=strays).map(|i| [0.0, 1.0e3 * i as f32, 0.0]));
        Particles::from_positions(positions)
    }

    #[test]
    fn water_meets_things_as_fast_as_it_falls_or_flies() {
        let fall = impact_speed(&[column(0)]);
        // Speed after a fall through 2 metres, minus the share that the quantiles cut off.
        let free = (2.0_f32 * 9.81 * 2.0).sqrt();
        assert!(fall < free && fall > 0.97 * free, "{fall}, not {free}");
        assert_eq!(impact_speed(&[column(60)]), fall, "strays");
        let mut fast = column(0);
        fast.velocities = Some(vec![[0.0, -9.0, 12.0]; fast.positions.len()]);
        assert!((impact_speed(&[column(0), fast]) - 15.0).abs() < 1.0e-4);
    }

    #[test]
    fn mist_goes_with_the_square_of_the_speed() {
        let mist = |speed: f32| {
            let mut spray = SpraySettings::default();
            spray_of_caches(&mut spray, 0.05, speed);
            spray.mist
        };
        assert!((mist(6.0) - 4.0 * mist(3.0)).abs() < 1.0e-6 && mist(3.0) > 0.0);
        assert_eq!(mist(20.0), mist(6.0));
    }
}
