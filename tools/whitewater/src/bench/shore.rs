//! Cost of shoreline and contact foam: the time that it adds to a frame, relative to the time of a frame of the
//! bench's pool of water. Frames with foam, frames without it and frames of the pool are drawn in turn, so that
//! changes of the machine's speed affect all three alike.

use std::sync::Mutex;

use clap::ValueEnum;
use glam::Quat;
use whitewater::ash::vk;
use whitewater::headless::scene::{Ground, Material, Mesh, Scene};
use whitewater::headless::{Background, COLOR_FORMAT, Device, DeviceOptions, Headless};
use whitewater::shore::{Edge, Noise, ShorelineSettings, TextureLayer};
use whitewater::water::Shadows;
use whitewater::{Camera, Config, Error, Settings};

use super::covered::{Waterline, band};
use super::report::{self, FOAM, Report, Row, ShoreRow};
use super::{BenchArgs, Drawn, Path, Times, calibrate, isles, lock, pool, write_picture};
use crate::camera::CameraFile;
use crate::environment::{Environment, Source};
use crate::failure::{Failure, Outcome};
use crate::progress::Progress;
use crate::settings::SettingsFile;
use crate::settings::shore::By;
use crate::shore::{ShoreScene, Shores, Which, changed, scene_of};

/// Time in seconds at which shoreline and contact foam are drawn, so that they have moved from their state at time 0.
const TIME: f64 = 5.0;
const SIZE: (u32, u32) = (1280, 720);
/// Default of `--cover`.
const COVER: f64 = 0.2;
const LAYERS: &str = "shore.amount,contact.amount,scene";

/// Scenes with a shore.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Scenery {
    /// Round islands, whose foam band covers --cover of the picture
    Isles,
    /// The scene of `render --shore archipelago`
    Archipelago,
    /// The pool of `render --shore`, with contact foam alone
    Pool,
    /// The lava of `render --shore`, with contact foam alone
    Lava,
    /// Contact foam on the bench's water, around objects that stand in it
    Splash,
}

impl Scenery {
    fn name(self) -> &'static str {
        match self {
            Self::Isles => "isles",
            Self::Archipelago => "archipelago",
            Self::Pool => "pool",
            Self::Lava => "lava",
            Self::Splash => "splash",
        }
    }

    /// The covered shares to measure, one combination each.
    fn covers(self, args: &BenchArgs) -> Vec<Option<f64>> {
        match (self, &args.cover[..]) {
            (Self::Isles, []) => vec![Some(COVER)],
            (Self::Isles, covers) => covers.iter().copied().map(Some).collect(),
            _ => vec![None],
        }
    }
}

/// Parser of `--cover`.
pub fn parse_cover(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.001..=1.0).contains(&share) => Ok(share),
        _ => Err(format!("expected a share of the picture from 0.001 to 1, found '{text}'")),
    }
}

/// One combination.
#[derive(Clone, Copy)]
struct Case {
    scenery: Scenery,
    cover: Option<f64>,
    extent: vk::Extent2D,
    path: Path,
}

fn cases(args: &BenchArgs, paths: &[Path]) -> Vec<Case> {
    let sizes = if args.size.is_empty() { &[SIZE] } else { &args.size[..] };
    let mut cases = Vec::new();
    for &scenery in &args.shore {
        for cover in scenery.covers(args) {
            for &(width, height) in sizes {
                let extent = vk::Extent2D { width, height };
                cases.extend(paths.iter().map(|&path| Case { scenery, cover, extent, path }));
            }
        }
    }
    cases
}

/// Number of combinations that the arguments ask for.
pub fn count(args: &BenchArgs, paths: usize) -> usize {
    cases(args, &[Path::Default]).len() * paths
}

/// Checks arguments before anything is measured.
pub fn check(args: &BenchArgs) -> Outcome<()> {
    if args.shore.is_empty() {
        return Ok(());
    }
    if !args.cover.is_empty() && !args.shore.contains(&Scenery::Isles) {
        return Err(Failure::usage("--cover applies to isles only; add isles to --shore"));
    }
    if args.particles.len() != 1 {
        let found = args.particles.len();
        return Err(Failure::usage(format!(
            "--particles: expected one count with --shore, found {found}"
        )));
    }
    Ok(())
}

pub fn measure_all(
    args: &BenchArgs,
    paths: &[Path],
    options: &DeviceOptions,
    report: &Mutex<Report>,
) -> Outcome<()> {
    let file = args.settings.as_deref().map(SettingsFile::read).transpose()?.unwrap_or_default();
    let pool = pool::Pool::new(args.particles.first().copied().unwrap_or(1 << 16));
    let cases = cases(args, paths);
    let mut progress = Progress::new(cases.len(), "combinations");
    let steps = progress.steps();
    for case in cases {
        let Case { scenery, cover, extent, path } = case;
        let share = cover.map_or_else(String::new, |cover| format!(", {cover} covered"));
        let vk::Extent2D { width, height } = extent;
        let what = format!("{}{share}, {width}x{height}, {}", scenery.name(), path.name());
        match steps.during(&what, || measure(args, options, (&file, &pool), case)) {
            Ok(Some(rows)) => {
                progress.aside(|| lock(report).add(rows))?;
                progress.advance(&what);
            }
            Ok(None) => {
                progress.advance(&format!("{what}: skipped: the path does not apply to this scene"))
            }
            Err(failure) => {
                progress.finish();
                return Err(Failure { message: format!("{what}: {}", failure.message), ..failure });
            }
        }
    }
    progress.finish();
    Ok(())
}

/// A scene with shore foam, and how it is drawn.
struct Setting {
    scene: Scene,
    environment: Environment,
    camera: Camera,
    settings: Settings,
    shores: Shores,
    /// Source of the shore coordinate.
    way: &'static str,
    /// Height of the sea; `None` without a sea.
    level: Option<f32>,
    /// Whether particles of water surround the objects.
    water: bool,
    /// Bounds in x and z (min, max) of a part of the land that moves, or could move, for the measurement of an update
    /// of the distance map in one part; `None` if there is none.
    part: Option<[[f32; 2]; 2]>,
    exposure: f32,
}

/// Makes the scene, camera and settings of a combination (`case`) of scenery and drawing path; `None` if the path
/// does not apply to the scenery.
fn setting(file: &SettingsFile, pool: &pool::Pool, case: Case) -> Outcome<Option<Setting>> {
    let Case { scenery, cover, extent, path } = case;
    let size = (extent.width, extent.height);
    let mut settings = super::plain();
    settings.shore.time = TIME;
    if scenery == Scenery::Splash {
        return splash(file, pool, case, settings);
    }
    let mut part = None;
    let (shown, by) = match scenery {
        Scenery::Archipelago => scene_of(&Which::Archipelago, 0.0, &mut settings)?,
        Scenery::Pool => scene_of(&Which::Pool, 0.0, &mut settings)?,
        Scenery::Lava => scene_of(&Which::Lava, 0.0, &mut settings)?,
        Scenery::Isles | Scenery::Splash => {
            let mut own = Settings::default();
            file.apply(&mut own);
            let reach = [own.shore.shoreline.sea_reach, own.shore.shoreline.land_reach];
            let (shown, one) = isles::isles(size, cover.unwrap_or(COVER), reach)?;
            part = Some(one);
            (shown, By::Map)
        }
    };
    let ShoreScene { mut scene, strip, level, exposure, .. } = shown;
    scene.frame = 1;
    part = part.or_else(|| changed(&scene, 2));
    let environment = Environment::sky(Some(shown.sun))?;
    environment.light_scene(&mut scene);
    settings.light = environment.light();
    file.apply(&mut settings);
    if path == Path::Everything {
        everything(&mut settings.shore.shoreline);
    }
    let by = match path {
        Path::Map => By::Map,
        Path::Strip if strip.is_some() => By::Strip,
        Path::Screen => By::Screen,
        Path::Contact => By::None,
        Path::Strip => return Ok(None),
        _ => file.shore.by.unwrap_or(by),
    };
    if path == Path::Shoreline {
        if by == By::None {
            return Ok(None);
        }
        settings.shore.contact.opacity = 0.0;
    }
    let mut file = file.clone();
    file.shore.by = Some(by);
    let reach = [settings.shore.shoreline.sea_reach, settings.shore.shoreline.land_reach];
    let shores = Shores::of(&file, &scene, level, strip, (reach, by))?;
    let camera = CameraFile {
        eye: Some(shown.eye),
        target: Some(shown.target),
        fov_y_degrees: Some(shown.fov),
        ..CameraFile::default()
    };
    Ok(Some(Setting {
        scene,
        environment,
        camera: camera.camera(size)?,
        settings,
        shores,
        way: by.name(),
        level: Some(level),
        water: false,
        part,
        exposure,
    }))
}

/// The bench's pool with objects in it.
fn splash(
    file: &SettingsFile,
    pool: &pool::Pool,
    case: Case,
    mut settings: Settings,
) -> Outcome<Option<Setting>> {
    if matches!(
        case.path,
        Path::Map | Path::Strip | Path::Screen | Path::Shoreline | Path::Everything
    ) {
        return Ok(None);
    }
    let stone = Material::named("stone").unwrap_or_default();
    let post = |x: f32, z: f32, turn: f32| {
        let turn = Quat::from_rotation_y(turn).to_array();
        Mesh::cuboid([x, 0.2, z], [0.09, 0.2, 0.09], turn, stone.clone())
    };
    let meshes = vec![
        post(0.55, 0.55, 0.4),
        post(-0.6, 0.4, 0.9),
        post(0.7, -0.2, 0.1),
        Mesh::cylinder([-0.1, 0.2, 0.75], 0.08, 0.4, stone.clone()),
        Mesh::sphere([-0.55, 0.17, -0.45], 0.2, stone.clone()),
    ];
    let ground = Some(Ground { y: -0.01, material: stone.clone(), reach: None });
    let environment = Environment::sky(Some([-0.55, 0.6, 0.45]))?;
    settings.light = environment.light();
    settings.shore.contact.particle_opacity = 1.0;
    file.apply(&mut settings);
    settings.water.spacing = pool.spacing;
    Ok(Some(Setting {
        scene: Scene { meshes, ground, sun: environment.sun_light(), ..Scene::default() },
        environment,
        camera: super::camera(case.extent),
        settings,
        shores: Shores::on_particles(file)?,
        way: By::None.name(),
        level: None,
        water: true,
        part: None,
        exposure: 0.0,
    }))
}

/// Enables every feature of the look.
fn everything(look: &mut ShorelineSettings) {
    let noise = |amplitude, metres: f32| Noise { amplitude, scale: 1.0 / metres };
    look.frequency_noise = noise(5.0, 90.0);
    look.speed_noise = noise(0.35, 70.0);
    look.rise_noise = noise(0.22, 60.0);
    look.threshold_noise = noise(0.1, 50.0);
    look.warp = noise(1.0, 40.0);
    look.texture_warp = noise(0.7, 18.0);
    let layer = |weight, scale, angle| TextureLayer { weight, scale, angle, speed: [0.1, 0.05] };
    look.layers = [
        layer(0.4, 1.0 / 10.5, 0.0),
        layer(0.3, 1.0 / 6.4, 37.0),
        layer(0.2, 1.0 / 4.0, 71.0),
        layer(0.1, 1.0 / 2.7, 112.0),
    ];
}

fn measure(
    args: &BenchArgs,
    options: &DeviceOptions,
    (file, pool): (&SettingsFile, &pool::Pool),
    case: Case,
) -> Outcome<Option<Vec<Row>>> {
    let Some(setting) = setting(file, pool, case)? else { return Ok(None) };
    let count = pool.positions.len() as u32;
    let water = Config::new(case.extent, COLOR_FORMAT, count);
    // Without water there is still room for a few particles, because a renderer cannot have room for none.
    let max_particles = if setting.water { count } else { 64 };
    let shadow = (case.path == Path::Pcf).then_some(Shadows::Map);
    let without = water.with(|it| {
        it.max_particles = max_particles;
        it.shadow = shadow;
    });
    let mut shore = setting.shores.config;
    match case.path {
        Path::Clip => shore.edge = Edge::Clip,
        Path::Smooth => shore.edge = Edge::Smooth,
        Path::Coverage => shore.edge = Edge::Coverage,
        _ => {}
    }
    let with = without.with(|it| it.shore = Some(shore));
    let mut made = Vec::new();
    let mut result = Ok(());
    for config in [with, without, water] {
        match Device::new(options).and_then(|device| Headless::new(device, &config)) {
            Ok(headless) => made.push(headless),
            Err(error) => {
                result = Err(error.into());
                break;
            }
        }
    }
    let rows = match (result, &mut made[..]) {
        (Ok(()), [with, without, water]) => {
            sample([with, without, water], args, pool, (case, &setting), shore.edge).map(Some)
        }
        (result, _) => result.map(|()| None),
    };
    let finished = made.into_iter().map(|headless| headless.finish().map(drop));
    let finished = finished.fold(Ok(()), Result::and);
    let rows = rows?;
    finished?;
    Ok(rows)
}

/// Uploads everything but the foam.
fn set_up(headless: &mut Headless, setting: &Setting, pool: &pool::Pool) -> Result<(), Error> {
    if let Source::Sky(sky) = &setting.environment.source {
        headless.sky(sky)?;
    }
    headless.scene(&setting.scene, true)?;
    headless.particles(if setting.water { &pool.positions } else { &[] }, None)
}

fn sample(
    [with, without, water]: [&mut Headless; 3],
    args: &BenchArgs,
    pool: &pool::Pool,
    (case, setting): (Case, &Setting),
    edge: Edge,
) -> Outcome<Vec<Row>> {
    let Setting { camera, settings, shores, scene, .. } = setting;
    set_up(with, setting, pool)?;
    set_up(without, setting, pool)?;
    shores.set_up(with, scene)?;
    water.particles(&pool.positions, None)?;
    let mut plain = super::plain();
    plain.water.spacing = pool.spacing;
    let seen = super::camera(case.extent);
    let background = Background::Color([0.4, 0.4, 0.4]);
    let [mut coated, mut bare, mut watery] = [(); 3].map(|()| Times::default());
    for frame in 0..args.warmup + args.frames {
        coated.calibration.push(calibrate::milliseconds());
        with.render(camera, settings, &Background::Scene)?;
        without.render(camera, settings, &Background::Scene)?;
        water.render(&seen, &plain, &background)?;
        if frame >= args.warmup {
            coated.note(with);
            bare.note(without);
            watery.note(water);
        }
    }
    let maps = maps(with, args, setting)?;
    let covered = covered(with, setting)?;
    let both = [with.layer("shore.amount")?, with.layer("contact.amount")?];
    let [shoreline, contact] = both.map(|layer| layer.map_or_else(Vec::new, |layer| layer.data));
    let coat = shoreline.iter().zip(&contact).filter(|(a, b)| a.max(**b) > 0.0).count();
    let pixels = f64::from(case.extent.width) * f64::from(case.extent.height);
    if let Some(path) = &args.picture {
        let exposure = setting.environment.exposure() + setting.exposure;
        write_picture(with, path, LAYERS, camera, exposure)?;
    }
    let count = pool.positions.len() as u32;
    let calibration = coated.calibration();
    let mut template = Row {
        particles: if setting.water { count } else { 0 },
        width: case.extent.width,
        height: case.extent.height,
        path: case.path.name(),
        calibration,
        shore: Some(ShoreRow {
            shore: case.scenery.name(),
            way: setting.way,
            edge: match edge {
                Edge::Smooth => "smooth",
                Edge::Clip => "clip",
                Edge::Coverage => "coverage",
            },
            cover: case.cover,
            covered,
            foam: coat as f64 / pixels,
            water: count,
            ratio: f64::NAN,
        }),
        ..Row::of(with)
    };
    let costs = Costs::new(&coated, &bare, &watery);
    if let Some(shore) = &mut template.shore {
        shore.ratio = costs.all.0 / costs.water.0;
    }
    let config = *with.renderer().config();
    let drawn = match setting.water {
        true => super::drawn(with, config, pool)?,
        false => Drawn::nothing(config),
    };
    let drawn = Drawn { coat: coat as u64, ..drawn };
    let mut rows = coated.rows(&template, &drawn);
    let Costs { bare, coat, all, water } = costs;
    let parts = [("composite without", bare), ("coat", coat), (FOAM, all), ("water frame", water)];
    for (pass, (middle, mut times)) in parts {
        rows.push(Row { median: middle, ..template.of_pass(pass, &mut times) });
    }
    rows.extend(maps.into_iter().map(|(pass, mut times)| template.of_pass(pass, &mut times)));
    Ok(rows)
}

/// Medians, and the values of each frame.
struct Costs {
    /// The composite without foam.
    bare: (f64, Vec<f64>),
    /// Additional time of the composite with foam.
    coat: (f64, Vec<f64>),
    /// The same, plus the passes that compute the foam.
    all: (f64, Vec<f64>),
    water: (f64, Vec<f64>),
}

impl Costs {
    /// Subtracts medians; a median of differences would be another number.
    fn new(with: &Times, without: &Times, water: &Times) -> Self {
        let median = |times: &[f64]| report::median(&mut times.to_vec());
        let (more, less) = (with.of("composite"), without.of("composite"));
        let coat: Vec<_> = more.iter().zip(less).map(|(more, less)| more - less).collect();
        let coat_median = median(more) - median(less);
        let (mut all, mut all_median) = (coat.clone(), coat_median);
        for own in ["shore-tiles", "shoreline", "contact"].map(|pass| with.of(pass)) {
            if own.is_empty() {
                continue;
            }
            all.iter_mut().zip(own).for_each(|(all, own)| *all += own);
            all_median += median(own);
        }
        Self {
            bare: (median(less), less.to_vec()),
            coat: (coat_median, coat),
            all: (all_median, all),
            water: (median(&water.totals), water.totals.clone()),
        }
    }
}

/// Share of the picture that shows water within reach of a shore; `None` without shoreline foam.
fn covered(headless: &mut Headless, setting: &Setting) -> Outcome<Option<f64>> {
    let Some(level) = setting.level.filter(|_| setting.way != By::None.name()) else {
        return Ok(None);
    };
    let reach = setting.settings.shore.shoreline.sea_reach;
    let line = Waterline::new(&setting.scene, level, reach);
    band(&headless.scene_depth()?, &setting.camera, level, &line).map(Some)
}

/// Measures GPU times in milliseconds of updates of the map of distances to the shore: of the whole map ("map"),
/// without a change in it ("map again"), and after a change in one part ("map in part"). Empty if the foam uses no
/// map.
fn maps(
    headless: &mut Headless,
    args: &BenchArgs,
    setting: &Setting,
) -> Outcome<Vec<(&'static str, Vec<f64>)>> {
    if !setting.shores.by_map() {
        return Ok(Vec::new());
    }
    let beside = [[f32::MAX; 2]; 2];
    let kinds = [("map", None), ("map again", Some(beside)), ("map in part", setting.part)];
    let mut all = Vec::new();
    for (pass, changed) in kinds {
        if pass == "map in part" && changed.is_none() {
            continue;
        }
        let mut times = Vec::new();
        for _ in 0..args.frames {
            setting.shores.step(headless, &setting.scene, changed)?;
            times.push(headless.shore_map_time().unwrap_or(f64::NAN) * 1e-6);
        }
        all.push((pass, times));
    }
    Ok(all)
}
