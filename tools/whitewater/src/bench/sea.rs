//! Measures the foam of a sea: millions of whitewater particles over the scene of the sea, without water particles.

use std::sync::Mutex;

use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::{Mat4, Vec3};
use whitewater::ash::vk;
use whitewater::headless::scene::Scene;
use whitewater::headless::{Background, COLOR_FORMAT, Device, DeviceOptions, Headless, Whitewater};
use whitewater::io::picture;
use whitewater::water::Shadows;
use whitewater::{Config, Error, Settings};
use whitewater::{Occlusion, OcclusionReach, WhitewaterConfig, WhitewaterSettings};
use whitewater_seas::{Foam, Sea};

use super::report::{Report, Row, SeaRow};
use super::{BenchArgs, Drawn, lock, times, write_picture};
use crate::environment::Environment;
use crate::failure::{Failure, Outcome};
use crate::progress::Progress;
use crate::settings::SettingsFile;

/// Number of particles that are generated and uploaded at a time.
const PART: u32 = 1 << 20;

/// Layers that are written beside the picture.
const LAYERS: &str = "whitewater,whitewater.radius,whitewater.normal,whitewater.thickness,whitewater.intensity,whitewater.shadow,whitewater.irradiance,scene";

/// How ambient occlusion is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OcclusionArg {
    /// A sixteenth of the source's samples
    Fast,
    /// The samples of the source
    Reference,
}

impl OcclusionArg {
    fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Reference => "reference",
        }
    }
}

impl From<OcclusionArg> for Occlusion {
    fn from(arg: OcclusionArg) -> Self {
        match arg {
            OcclusionArg::Fast => Self::Fast,
            OcclusionArg::Reference => Self::Reference,
        }
    }
}

/// Parser of `--sea`.
pub fn parser() -> impl TypedValueParser<Value = Sea> {
    PossibleValuesParser::new(Sea::ALL.map(Sea::name))
        .try_map(|name| Sea::from_name(&name).ok_or("no such sea"))
}

/// Parser of `--whitewater`. Suffixes are decimal, as in the source.
pub fn parse_count(text: &str) -> Result<u32, String> {
    let lower = text.to_lowercase();
    let (digits, scale) = match lower.strip_suffix('k') {
        Some(digits) => (digits, 1e3),
        None => match lower.strip_suffix('m') {
            Some(digits) => (digits, 1e6),
            None => (lower.as_str(), 1.0),
        },
    };
    match digits.parse::<f64>().map(|n| (n * scale).round()) {
        Ok(count) if (1.0..=268_435_456.0).contains(&count) => Ok(count as u32),
        _ => Err(format!("expected a count from 1 to 268m such as 20k or 0.8m, found '{text}'")),
    }
}

/// Parser of `--away`. The camera's near plane is at half a metre.
pub fn parse_distance(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(metres) if (1.0..=1.0e5).contains(&metres) => Ok(metres),
        _ => Err(format!("expected metres from 1 to 100000, found '{text}'")),
    }
}

/// One combination.
#[derive(Clone, Copy)]
struct Case {
    sea: Sea,
    count: u32,
    extent: vk::Extent2D,
    occlusion: OcclusionArg,
}

fn cases(args: &BenchArgs) -> Vec<Case> {
    let mut cases = Vec::new();
    for &sea in &args.sea {
        let (count, size) = sea.source();
        let counts = if args.whitewater.is_empty() { vec![count] } else { args.whitewater.clone() };
        let sizes = if args.size.is_empty() { vec![size] } else { args.size.clone() };
        for &count in &counts {
            for &(width, height) in &sizes {
                let modes = match &args.occlusion[..] {
                    [] => &[OcclusionArg::Fast],
                    modes => modes,
                };
                let extent = vk::Extent2D { width, height };
                cases.extend(modes.iter().map(|&occlusion| Case { sea, count, extent, occlusion }));
            }
        }
    }
    cases
}

/// Number of combinations that the arguments ask for.
pub fn count(args: &BenchArgs) -> usize {
    cases(args).len()
}

pub fn measure_all(
    args: &BenchArgs,
    options: &DeviceOptions,
    report: &Mutex<Report>,
) -> Outcome<()> {
    let cases = cases(args);
    let mut progress = Progress::new(cases.len(), "combinations");
    let steps = progress.steps();
    for case in cases {
        let Case { sea, count, extent, occlusion } = case;
        let what = format!(
            "{}, {count} whitewater particles, {}x{}, {}",
            sea.name(),
            extent.width,
            extent.height,
            occlusion.name()
        );
        match steps.during(&what, || measure(args, options, case)) {
            Ok(rows) => {
                progress.aside(|| lock(report).add(rows))?;
                progress.advance(&what);
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

fn measure(args: &BenchArgs, options: &DeviceOptions, case: Case) -> Outcome<Vec<Row>> {
    let device = Device::new(options)?;
    // There is no water, but room for 0 particles is not allowed.
    let mut config = Config::new(case.extent, COLOR_FORMAT, 64);
    config.whitewater = Some(WhitewaterConfig::new(case.count).with(|it| {
        it.occlusion = case.occlusion.into();
        it.packets = args.packets;
    }));
    config.shadow = Some(Shadows::Map);
    let mut headless = Headless::new(device, &config)?;
    let rows = sample(&mut headless, args, case, config);
    headless.finish()?;
    rows
}

fn sample(
    headless: &mut Headless,
    args: &BenchArgs,
    case: Case,
    config: Config,
) -> Outcome<Vec<Row>> {
    let Case { sea, count, extent, occlusion } = case;
    let scene = sea.scene();
    let environment = Environment::sky(Some(scene.sun.direction))?;
    if let crate::environment::Source::Sky(sky) = &environment.source {
        headless.sky(sky)?;
    }
    headless.scene(&Scene { sun: environment.sun_light(), ..scene }, true)?;
    headless.particles(&[], None)?;
    upload(headless, sea, count, args.packets)?;
    let mut settings = Settings::default().with(|it| {
        // The scene has the source's size, so it takes the source's search radius.
        it.whitewater = WhitewaterSettings::default().with(|it| {
            it.radius = sea.radius(count);
            it.reach = OcclusionReach::Metres(5.0);
        });
        it.light = environment.light();
    });
    if let Some(path) = &args.settings {
        SettingsFile::read(path)?.whitewater.put(&mut settings.whitewater);
    }
    let aspect = extent.width as f32 / extent.height as f32;
    let from = |distance| sea.camera_from(distance, aspect);
    let mut camera = args.away.map_or_else(|| sea.camera(aspect), from);
    camera.view = (Mat4::from_rotation_y(-args.turned.to_radians()) * camera.view_matrix())
        .to_cols_array_2d();
    let times =
        times(headless, args, |headless| headless.render(&camera, &settings, &Background::Scene))?;
    let depth = headless.layer("whitewater")?;
    let foam = depth.map_or(0, |depth| depth.data.iter().filter(|z| **z < picture::EMPTY).count());
    let drawn = Drawn {
        whitewater: count,
        goes: if headless.device().enabled.buffer_int64_atomics { 1 } else { 2 },
        foam: foam as u64,
        ..Drawn::nothing(config)
    };
    if let Some(path) = &args.picture {
        write_picture(headless, path, LAYERS, &camera, environment.exposure())?;
    }
    let template = Row {
        width: extent.width,
        height: extent.height,
        path: "sea".into(),
        sea: Some(SeaRow { sea: sea.name(), whitewater: count, occlusion: occlusion.name() }),
        ..Row::of(headless)
    };
    let mut rows = times.rows(&template, &drawn);
    for row in rows.iter_mut().filter(|row| row.pass == "splat") {
        row.ns_per_whitewater = Some(row.median * 1e6 / f64::from(count));
    }
    Ok(rows)
}

/// Uploads the foam part by part, so that the host's memory never holds all of it.
fn upload(headless: &mut Headless, sea: Sea, count: u32, sorted: bool) -> Result<(), Error> {
    let mut parts = headless.whitewater_parts(count as usize)?;
    let mut first = 0;
    while first < count {
        let next = count.min(first.saturating_add(PART));
        let mut foam = sea.foam(first..next, count);
        if sorted {
            foam = along_curve(&foam);
        }
        parts.push(&Whitewater {
            positions: &foam.positions,
            kinds: Some(&foam.kinds),
            ages: Some(&foam.ages),
            ids: Some(&foam.ids),
            radii: None,
        })?;
        first = next;
    }
    parts.finish()
}

/// Sorts the particles along a Morton curve through their bounding box, so that neighbours in the list are near each
/// other in space.
fn along_curve(foam: &Foam) -> Foam {
    let all = || foam.positions.iter().map(|p| Vec3::from(*p));
    let low = all().fold(Vec3::INFINITY, Vec3::min);
    let scale = 1023.0 / (all().fold(Vec3::NEG_INFINITY, Vec3::max) - low).max(Vec3::splat(1e-6));
    let key = |i: &u32| {
        let cell = ((Vec3::from(foam.positions[*i as usize]) - low) * scale).as_uvec3().to_array();
        let bit = |b: u32, axis: u32| (cell[axis as usize] >> b & 1) << (3 * b + axis);
        (0..30).fold(0, |key, i| key | bit(i / 3, i % 3))
    };
    let mut order: Vec<u32> = (0..foam.positions.len() as u32).collect();
    order.sort_by_cached_key(key);
    let order = || order.iter().map(|i| *i as usize);
    Foam {
        positions: order().map(|i| foam.positions[i]).collect(),
        kinds: order().map(|i| foam.kinds[i]).collect(),
        ages: order().map(|i| foam.ages[i]).collect(),
        ids: order().map(|i| foam.ids[i]).collect(),
    }
}
