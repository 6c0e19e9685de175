//! `whitewater bench` measures the GPU time of each pass, and computes the minimum bytes that it moves, for several
//! particle counts, picture sizes and paths (ways to draw). What it draws is water, whitewater of a sea, bubble foam,
//! or shoreline foam.

mod blobs;
mod bytes;
mod calibrate;
mod covered;
mod heap;
mod isles;
mod pool;
mod rendered;
mod report;
mod sea;
mod shore;

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use clap::{ArgGroup, Args, ValueEnum};
use glam::{Mat4, Vec3, vec3};
use whitewater::ash::vk;
use whitewater::headless::scene::{Material, Mesh, Scene};
use whitewater::headless::{Background, COLOR_FORMAT, Counts, Device, DeviceOptions, Headless};
use whitewater::io::picture;
use whitewater::water::{
    Convolution, Gate, Rule, Shading, Shadows, Smoothing, Splat, SurfaceFoamSettings,
    SurfaceNoiseSettings, WeberSettings,
};
use whitewater::{Camera, Config, Error, LightVolume, Previous, Settings};
use whitewater_seas::Sea;

use crate::bounds::Bounds;
use crate::bubbles::Which;
use crate::camera::Lens;
use crate::failure::{Failure, Outcome};
use crate::layers;
use crate::output::{self, PictureFormat, Target};
use crate::progress::Progress;
use rendered::Rendered;
use report::{Format, Report, Row};

/// Arguments of `bench`.
#[derive(Args, Debug)]
#[command(group = ArgGroup::new("instead").args(["sea", "bubbles", "shore"]))]
#[command(group = ArgGroup::new("pictured").args(["sea", "shore"]))]
pub struct BenchArgs {
    /// Particle counts: 16k, 64k, 256k, 1m or any number
    ///
    /// A larger count of particles resolves the same pool of water more finely. With --shore, the time that shore
    /// foam adds to a frame is reported relative to the frame time of this pool.
    #[arg(long, value_delimiter = ',', default_values = ["64k"], value_parser = parse_count)]
    particles: Vec<u32>,
    /// Picture sizes [default: 1280x720; for a sea 800x600 or 1280x960, as in the paper about whitewater; for bubbles
    /// 640x480]
    #[arg(long, value_delimiter = ',', value_parser = parse_size)]
    size: Vec<(u32, u32)>,
    /// Measure the whitewater particles of a procedural sea instead of water
    #[arg(long, value_delimiter = ',', value_parser = sea::parser(), conflicts_with_all = ["particles", "path"])]
    sea: Vec<Sea>,
    /// Measure bubble foam instead of water: one, slope, box, slope:N and box:N with N blobs, or a file
    ///
    /// Blobs are drawn, and simulated on the GPU and on the CPU.
    #[arg(long, value_delimiter = ',', value_parser = crate::bubbles::named, conflicts_with_all = ["particles", "path"])]
    bubbles: Vec<Which>,
    /// Measure shoreline and contact foam instead of water
    ///
    /// Frames with the foam, frames without it, and frames of the bench's pool of water (--particles) are drawn in
    /// turn.
    #[arg(long, value_delimiter = ',', value_enum)]
    shore: Vec<shore::Scenery>,
    /// Fraction of the picture that the foam band (shore coordinate 0 to 2) covers; the islands of 'isles' are
    /// sized for it
    #[arg(long, value_name = "SHARE", value_delimiter = ',', value_parser = shore::parse_cover, requires = "shore")]
    cover: Vec<f64>,
    /// Whitewater particles of a sea: 20k, 0.8m, 29m or any number [default: the paper's 0.82m, 9m, 15m, 29m]
    #[arg(long, value_delimiter = ',', value_parser = sea::parse_count, requires = "sea")]
    whitewater: Vec<u32>,
    /// The former name of --whitewater
    #[arg(long, hide = true, value_parser = was_diffuse)]
    diffuse: Option<u32>,
    /// Sampling of the ambient occlusion of whitewater [default: fast]
    #[arg(long, value_delimiter = ',', value_enum, requires = "sea")]
    occlusion: Vec<sea::OcclusionArg>,
    /// Sort the sea's whitewater particles along a space-filling curve, group consecutive ones to packets, and skip
    /// packets outside the view
    #[arg(long, requires = "sea")]
    packets: bool,
    /// Degrees by which a sea's camera is turned to the left [default: 0]
    #[arg(
        long,
        value_name = "DEGREES",
        requires = "sea",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        hide_default_value = true
    )]
    turned: f32,
    /// Distance of a sea's camera from its target in metres [default: set by the sea]
    #[arg(long, value_name = "METRES", requires = "sea", value_parser = sea::parse_distance)]
    away: Option<f32>,
    /// Write the last frame of a sea or shore, if only one combination is measured; an .exr has all layers of its
    /// foam
    #[arg(long, value_name = "FILE", requires = "pictured")]
    picture: Option<PathBuf>,
    /// TOML settings: table [whitewater] for a sea, [bubbles] for bubble foam, [shore], [shoreline] and [contact]
    /// for shores
    #[arg(long, value_name = "FILE.toml", requires = "instead")]
    settings: Option<PathBuf>,
    /// Paths to measure: 'default' is the library's choice on the device, 'all' are all paths of water, or of
    /// shores with --shore
    #[arg(long, value_delimiter = ',', value_enum, default_values = ["default"])]
    path: Vec<Path>,
    /// Number of measured frames
    #[arg(long, default_value_t = 15, value_parser = clap::value_parser!(u32).range(1..=1000))]
    frames: u32,
    /// Number of warm-up frames before the measured ones
    #[arg(long, default_value_t = 3)]
    warmup: u32,
    /// Output format
    ///
    /// If a combination fails, or at Ctrl-C, the results so far are printed.
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
    /// Device to draw on, by a part of its name
    #[arg(long)]
    device: Option<String>,
}

/// Refuses a renamed flag and names the new one.
fn was_diffuse(_: &str) -> Result<u32, String> {
    Err("--diffuse was renamed: use --whitewater".into())
}

/// A path: one way to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Path {
    /// The library's choice
    Default,
    /// Both splats as sprites with blending
    Raster,
    /// Both splats as compute shaders with atomics
    Compute,
    /// Thickness at full resolution
    FullThickness,
    /// Thickness at half resolution
    HalfThickness,
    /// Smoothing at full resolution
    FullSmoothing,
    /// Smoothing at quarter resolution
    QuarterSmoothing,
    /// Smoothing: one dispatch per iteration over tiles
    Tiles,
    /// Smoothing: eight iterations per dispatch in shared memory
    Fused,
    /// Smoothing: occlusion query, indirect draw count
    QueryCount,
    /// Smoothing: occlusion query, conditional rendering
    QueryPredicate,
    /// Smoothing: occlusion query, culling vertex shader
    QueryVertex,
    /// Smoothing: occlusion query read back by the host
    ReadBack,
    /// One layer of water
    OneSheet,
    /// With surface foam: the highest 5 % of the pool's particles are foam by half or more, the next 2.5 % by less
    Foam,
    /// With spray: the highest 2.5 % of the particles are spray only
    Spray,
    /// With motion vectors
    Motion,
    /// With the baseline's surface noise and its foam
    Noise,
    /// With shadows and caustics of the water, in maps of 512² texels
    Light,
    /// With shadows that a plate casts on the pool, or a shore's land on its surroundings, by percentage-closer
    /// filtering of a map of 2048² texels
    Pcf,
    /// The shadows of 'pcf', by convolution shadow maps at the library's default size
    Convolution,
    /// Composite: a render pass over the tiles
    RasterComposite,
    /// Composite: a compute shader over the tiles
    ComputeComposite,
    /// The thesis' iteration rule
    Source,
    /// The baseline: 40 iterations for every pixel
    Baseline,
    /// The baseline with its noise and foam
    BaselineNoise,
    /// With all that `render` draws of a file by default: surface foam, spray and mist, shadows, caustics and a basin
    Render,
    /// Shores, as all paths below: shore coordinate v from a distance map
    Map,
    /// Shore coordinate v from a strip
    Strip,
    /// Shore coordinate v from the screen's depth
    Screen,
    /// Shoreline foam alone
    Shoreline,
    /// Contact foam alone
    Contact,
    /// Edges of shoreline foam clipped
    Clip,
    /// Edges of shoreline foam by the fraction of a pixel that it covers
    Smooth,
    /// Edges of shoreline foam by the coverage of four samples
    Coverage,
    /// Every feature enabled: four texture layers, noise on everything
    Everything,
    /// All paths, one after the other
    All,
}

/// The kind of scene that a path draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Of {
    Water,
    Shore,
    Both,
}

impl Path {
    fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
    }

    fn of(self) -> Of {
        match self {
            Self::Default | Self::Pcf | Self::All => Of::Both,
            Self::Map
            | Self::Strip
            | Self::Screen
            | Self::Shoreline
            | Self::Contact
            | Self::Clip
            | Self::Smooth
            | Self::Coverage
            | Self::Everything => Of::Shore,
            _ => Of::Water,
        }
    }

    fn configure(self, config: &mut Config) {
        let query = |gate| Some(Smoothing::Query(gate));
        match self {
            // `Rendered` sets the configuration of `Render`.
            Self::Default | Self::All | Self::Render => {}
            // These paths do not draw water.
            Self::Map
            | Self::Strip
            | Self::Screen
            | Self::Shoreline
            | Self::Contact
            | Self::Clip
            | Self::Smooth
            | Self::Coverage
            | Self::Everything => {}
            Self::Raster | Self::Compute => {
                let splat = if self == Self::Raster { Splat::Raster } else { Splat::Compute };
                config.depth_splat = Some(splat);
                config.thickness_splat = Some(splat);
            }
            Self::FullThickness => config.thickness_level = 0,
            Self::HalfThickness => config.thickness_level = 1,
            Self::FullSmoothing => config.smoothing_level = 0,
            Self::QuarterSmoothing => config.smoothing_level = 2,
            Self::Tiles => config.smoothing = Some(Smoothing::Tiles),
            Self::Fused => config.smoothing = Some(Smoothing::Fused),
            Self::QueryCount => config.smoothing = query(Gate::DrawCount),
            Self::QueryPredicate => config.smoothing = query(Gate::Predicate),
            Self::QueryVertex | Self::ReadBack => config.smoothing = query(Gate::VertexCull),
            Self::OneSheet => config.sheets = 1,
            Self::Foam => config.surface_foam = true,
            Self::Spray => config.spray = true,
            Self::Motion => config.motion = true,
            Self::Noise => config.noise = Some(1),
            Self::Light => config.light_map_size = Some(512),
            Self::Pcf => config.shadow = Some(Shadows::Map),
            Self::Convolution => {
                config.shadow = Some(Shadows::Convolution(Convolution::default()));
            }
            Self::RasterComposite => config.composite = Some(Shading::Raster),
            Self::ComputeComposite => config.composite = Some(Shading::Compute),
            Self::Source => config.rule = Rule::Source,
            Self::Baseline => config.rule = Rule::Fixed(40),
            Self::BaselineNoise => {
                config.rule = Rule::Fixed(40);
                config.noise = Some(1);
            }
        }
    }
}

/// Counts of the last frame, from which minimum bytes are computed.
pub struct Drawn {
    pub extent: vk::Extent2D,
    pub config: Config,
    pub particles: u32,
    pub counts: Counts,
    /// Particles with foam.
    pub foaming: u64,
    /// Full-resolution pixels with water.
    pub covered: u64,
    /// Whitewater particles, and full-resolution pixels with their foam.
    pub whitewater: u32,
    /// Number of dispatches over all whitewater particles.
    pub goes: u64,
    pub foam: u64,
    /// Full-resolution pixels with a coat of foam.
    pub coat: u64,
    /// Active pixels summed over the iterations of the smoothing.
    pub iterations: u64,
    /// Max number of iterations of a pixel.
    pub most_iterations: u32,
}

impl Drawn {
    /// Counts of 0, for a frame of this configuration.
    fn nothing(config: Config) -> Self {
        Self {
            extent: config.extent,
            config,
            particles: 0,
            counts: Counts::default(),
            foaming: 0,
            covered: 0,
            whitewater: 0,
            goes: 0,
            foam: 0,
            coat: 0,
            iterations: 0,
            most_iterations: 0,
        }
    }
}

/// Measures all combinations and prints the results, also those before an early end.
pub fn run(args: &BenchArgs) -> Outcome<()> {
    let paths = paths(args)?;
    shore::check(args)?;
    check_picture(args, paths.len())?;
    let options = DeviceOptions { name: args.device.clone(), ..Default::default() };
    let device = Device::new(&options)?;
    let (adapter, driver) = (device.adapter.clone(), device.driver.clone());
    drop(device);
    let report = Arc::new(Mutex::new(Report::new(args.format, adapter, driver)?));
    let begun = Arc::clone(&report);
    output::at_interrupt(move || lock(&begun).finish());
    let outcome = if !args.sea.is_empty() {
        sea::measure_all(args, &options, &report)
    } else if !args.bubbles.is_empty() {
        blobs::measure_all(args, &options, &report)
    } else if !args.shore.is_empty() {
        shore::measure_all(args, &paths, &options, &report)
    } else {
        measure_all(args, &paths, &options, &report)
    };
    // The results so far are printed even if a combination failed.
    let told = output::at_end();
    outcome.and(told)
}

/// The paths that the arguments ask for.
fn paths(args: &BenchArgs) -> Outcome<Vec<Path>> {
    let (own, others) = match args.shore.is_empty() {
        true => (Of::Water, Of::Shore),
        false => (Of::Shore, Of::Water),
    };
    if let Some(path) = args.path.iter().find(|path| path.of() == others) {
        let name = path.name();
        return Err(Failure::usage(match own {
            Of::Water => format!("--path {name} draws shores; add --shore isles"),
            _ => format!("--path {name} draws water; leave out either it or --shore"),
        }));
    }
    let all = || Path::value_variants().iter().copied();
    Ok(match args.path.contains(&Path::All) {
        true => all().filter(|path| *path != Path::All && path.of() != others).collect(),
        false => args.path.clone(),
    })
}

/// Checks `--picture` before anything is measured; `paths` is the number of paths.
fn check_picture(args: &BenchArgs, paths: usize) -> Outcome<()> {
    let Some(path) = &args.picture else { return Ok(()) };
    let (count, of) = match args.shore.is_empty() {
        true => (sea::count(args), "sea, count, size and occlusion"),
        false => (shore::count(args, paths), "shore, cover, size and path"),
    };
    if count != 1 {
        return Err(Failure::usage(format!(
            "--picture: expected one combination of {of}, found {count}; leave only one"
        )));
    }
    Target::new(path, false)?;
    output::probe(path)
}

/// Writes a picture of the last frame; an .exr has layers.
fn write_picture(
    headless: &mut Headless,
    path: &std::path::Path,
    wanted: &str,
    camera: &Camera,
    exposure: f32,
) -> Outcome<()> {
    let vk::Extent2D { width, height } = headless.renderer().config().extent;
    let format = Target::new(path, false)?.format;
    let wanted = match format {
        PictureFormat::Exr => layers::wanted(wanted)?,
        PictureFormat::Png => Vec::new(),
    };
    let layers = layers::collect(headless, (width, height), &wanted, &Lens::new(camera)?)?;
    output::write(path, |to| match format {
        PictureFormat::Exr => picture::write_exr(&layers, to),
        PictureFormat::Png => picture::write_png(&layers, exposure, to),
    })
}

fn lock(report: &Mutex<Report>) -> MutexGuard<'_, Report> {
    report.lock().unwrap_or_else(PoisonError::into_inner)
}

fn measure_all(
    args: &BenchArgs,
    paths: &[Path],
    options: &DeviceOptions,
    report: &Mutex<Report>,
) -> Outcome<()> {
    let sizes = if args.size.is_empty() { &[(1280, 720)] } else { &args.size[..] };
    let total = args.particles.len() * sizes.len() * paths.len();
    let mut progress = Progress::new(total, "combinations");
    let steps = progress.steps();
    for &count in &args.particles {
        let pool = pool::Pool::new(count);
        for &(width, height) in sizes {
            for &path in paths {
                let what = format!(
                    "{} particles, {width}x{height}, {}",
                    pool.positions.len(),
                    path.name()
                );
                let extent = vk::Extent2D { width, height };
                let rendered = match path {
                    Path::Render => Some(Rendered::new(&pool, EYE)?),
                    _ => None,
                };
                let outcome = steps.during(&what, || {
                    Device::new(options).and_then(|device| {
                        measure(device, args, &pool, extent, (path, rendered.as_ref()))
                    })
                });
                match outcome {
                    Ok(rows) => {
                        progress.aside(|| lock(report).add(rows))?;
                        progress.advance(&what);
                    }
                    // If a device lacks one path, the others are still measured.
                    Err(Error::Missing { what: lacks, why }) => {
                        progress.advance(&format!("{what}: skipped: {lacks} is missing: {why}"));
                    }
                    Err(error) => {
                        progress.finish();
                        let failure = Failure::from(error);
                        return Err(Failure {
                            message: format!("{what}: {}", failure.message),
                            ..failure
                        });
                    }
                }
            }
        }
    }
    progress.finish();
    Ok(())
}

/// Measures one combination.
fn measure(
    device: Device,
    args: &BenchArgs,
    pool: &pool::Pool,
    extent: vk::Extent2D,
    (path, rendered): (Path, Option<&Rendered>),
) -> Result<Vec<Row>, Error> {
    let mut config = Config::new(extent, COLOR_FORMAT, pool.positions.len() as u32);
    path.configure(&mut config);
    if let Some(rendered) = rendered {
        rendered.configure(&mut config);
    }
    let mut headless = Headless::new(device, &config)?;
    let rows = sample(&mut headless, args, pool, config, (path, rendered));
    headless.finish()?;
    rows
}

fn sample(
    headless: &mut Headless,
    args: &BenchArgs,
    pool: &pool::Pool,
    config: Config,
    (path, rendered): (Path, Option<&Rendered>),
) -> Result<Vec<Row>, Error> {
    let extent = config.extent;
    let camera = camera(extent);
    let mut settings = match rendered {
        Some(rendered) => rendered.stage(headless, pool)?,
        None => {
            if config.shadow.is_some() {
                headless.scene(&plate(pool), false)?;
            }
            let densities = config.spray.then(|| densities(pool));
            headless.particles(&pool.positions, densities.as_deref())?;
            plain()
        }
    };
    settings.water.spacing = pool.spacing;
    settings.noise = SurfaceNoiseSettings::SOURCE;
    if config.light_map_size.is_some() {
        headless.region(region(pool));
    }
    let mut foaming = 0;
    if config.surface_foam {
        if rendered.is_none() {
            settings.surface_foam = SurfaceFoamSettings::of_spacing(pool.spacing);
        }
        foaming = foam(headless, pool)?;
    }
    if config.motion {
        let velocities: Vec<[f32; 3]> = pool.positions.iter().map(|p| [p[1], -p[0], 0.0]).collect();
        headless.motion(&velocities, None)?;
        headless.previous(Some(Previous { camera, dt: 1.0 / 60.0 }));
    }
    let background = match config.shadow {
        Some(_) => Background::Scene,
        None => Background::Color([0.4, 0.4, 0.4]),
    };
    let times = times(headless, args, |headless| match path {
        Path::ReadBack => headless.render_with_read_back(&camera, &settings, &background),
        _ => headless.render(&camera, &settings, &background),
    })?;
    let drawn = Drawn { foaming, ..drawn(headless, config, pool)? };
    let template = Row {
        particles: drawn.particles,
        width: extent.width,
        height: extent.height,
        path: path.name(),
        most_iterations: drawn.most_iterations,
        ..Row::of(headless)
    };
    Ok(times.rows(&template, &drawn))
}

/// Milliseconds of each frame.
#[derive(Default)]
struct Times {
    passes: Vec<(&'static str, Vec<f64>)>,
    totals: Vec<f64>,
    calibration: Vec<f64>,
}

/// Draws the warm-up frames and the measured frames.
fn times(
    headless: &mut Headless,
    args: &BenchArgs,
    mut draw: impl FnMut(&mut Headless) -> Result<(), Error>,
) -> Result<Times, Error> {
    let mut times = Times::default();
    for frame in 0..args.warmup + args.frames {
        times.calibration.push(calibrate::milliseconds());
        draw(headless)?;
        if frame >= args.warmup {
            times.note(headless);
        }
    }
    Ok(times)
}

impl Times {
    /// Adds the times of the frame drawn last.
    fn note(&mut self, headless: &mut Headless) {
        let mut total = 0.0;
        for timing in headless.timings() {
            let ms = timing.nanoseconds * 1e-6;
            total += ms;
            match self.passes.iter_mut().find(|(name, _)| *name == timing.name) {
                Some((_, list)) => list.push(ms),
                None => self.passes.push((timing.name, vec![ms])),
            }
        }
        self.totals.push(total);
    }

    /// Times of a pass in each frame; empty if it did not run.
    fn of(&self, pass: &str) -> &[f64] {
        self.passes.iter().find(|(name, _)| *name == pass).map_or(&[], |(_, list)| list)
    }

    fn calibration(&self) -> f64 {
        report::median(&mut self.calibration.clone())
    }

    /// One row for each pass, and one for the whole frame.
    fn rows(mut self, template: &Row, drawn: &Drawn) -> Vec<Row> {
        let template = Row { calibration: self.calibration(), ..template.clone() };
        let row = |pass: &str, list: &mut Vec<f64>, bytes: Option<u64>| Row {
            bytes,
            ..template.of_pass(pass, list)
        };
        let mut rows: Vec<Row> = self
            .passes
            .iter_mut()
            .map(|(name, list)| row(name, list, bytes::moved(name, drawn)))
            .collect();
        let all = rows.iter().filter_map(|row| row.bytes).sum();
        rows.push(row("frame", &mut self.totals, Some(all)));
        rows
    }
}

/// Densities with which the highest fortieth of the particles is spray.
fn densities(pool: &pool::Pool) -> Vec<f32> {
    let mut heights: Vec<f32> = pool.positions.iter().map(|p| p[1]).collect();
    heights.sort_unstable_by(f32::total_cmp);
    let high = heights[heights.len() * 39 / 40];
    pool.positions.iter().map(|p| if p[1] > high { 300.0 } else { 1000.0 }).collect()
}

/// A square plate over the middle of the pool. Its edge, and its height above the pool's centre, are the radius of
/// the pool's bounding sphere, so it covers about half of the pool.
fn plate(pool: &pool::Pool) -> Scene {
    let LightVolume { center: [x, y, z], radius: r } = region(pool);
    let corner = |i: i32, j: i32| [x + 0.5 * r * i as f32, y + r, z + 0.5 * r * j as f32];
    Scene {
        meshes: vec![Mesh {
            name: "plate".into(),
            positions: vec![corner(-1, -1), corner(1, -1), corner(-1, 1), corner(1, 1)],
            normals: vec![[0.0, 1.0, 0.0]; 4],
            uvs: Vec::new(),
            indices: vec![0, 2, 1, 1, 2, 3],
            material: Material::default(),
            transform: Mat4::IDENTITY,
        }],
        ..Scene::default()
    }
}

/// Bounding sphere of the pool, for the light's maps.
fn region(pool: &pool::Pool) -> LightVolume {
    Bounds::of_bulk(&pool.positions)
        .map_or(LightVolume { center: [0.0; 3], radius: 1.0 }, |bounds| bounds.region())
}

/// Gives the particles velocities that grow with height, so that the splash foams. Returns the number of foaming
/// particles.
fn foam(headless: &mut Headless, pool: &pool::Pool) -> Result<u64, Error> {
    let mut heights: Vec<f32> = pool.positions.iter().map(|p| p[1].max(0.0)).collect();
    let velocities: Vec<[f32; 3]> = heights.iter().map(|y| [20.0 * y, 0.0, 0.0]).collect();
    heights.sort_unstable_by(f32::total_cmp);
    let high = heights[heights.len() * 95 / 100];
    let settings = WeberSettings::reduced(pool.spacing, 1.0);
    let threshold = settings.scale * settings.rest_density * (20.0 * high).powi(2);
    headless.motion(&velocities, None)?;
    headless.step(None, &settings.with(|it| it.threshold = threshold))?;
    // Foam begins where the Weber number is half its threshold; at the threshold the particle is half foam.
    Ok(heights.iter().filter(|y| **y > high * 0.5_f32.sqrt()).count() as u64)
}

fn drawn(headless: &mut Headless, config: Config, pool: &pool::Pool) -> Result<Drawn, Error> {
    let counts = headless.counts()?;
    let depth = headless.layer("water.depth")?;
    let iterations = headless.layer("water.iterations")?;
    let covered = depth.map_or(0, |d| d.data.iter().filter(|z| **z < 1.0e9).count() as u64);
    let surface = headless.layer("water.surface")?;
    let (mut sum, mut most) = (0.0, 0.0_f32);
    if let (Some(iterations), Some(surface), Some(levels)) =
        (iterations, surface, headless.levels())
    {
        let [x, y, first_x, first_y] = levels.level[0].slope;
        for (i, (n, z)) in iterations.data.iter().zip(&surface.data).enumerate() {
            let at = [i % surface.width, i / surface.width].map(|v| v as f32 + 0.5);
            // A texel of a level covers four texels of the next finer one.
            let (level, _) = levels.shown(*z, [x * at[0] + first_x, y * at[1] + first_y]);
            sum += f64::from(*n) / 4.0_f64.powi(level as i32);
            most = most.max(*n);
        }
    }
    Ok(Drawn {
        particles: pool.positions.len() as u32,
        counts,
        covered,
        iterations: sum as u64,
        most_iterations: most as u32,
        ..Drawn::nothing(config)
    })
}

/// Camera position for the pool.
const EYE: Vec3 = vec3(1.7, 1.15, 2.15);

fn camera(extent: vk::Extent2D) -> Camera {
    let aspect = extent.width as f32 / extent.height as f32;
    let flip = Mat4::from_scale(vec3(1.0, -1.0, 1.0));
    Camera::of(
        Mat4::look_at_rh(EYE, vec3(0.0, 0.12, 0.0), Vec3::Y),
        flip * Mat4::perspective_infinite_reverse_rh(45f32.to_radians(), aspect, 0.05),
    )
}

fn parse_count(text: &str) -> Result<u32, String> {
    let lower = text.to_lowercase();
    let (digits, scale) = match lower.strip_suffix('k') {
        Some(digits) => (digits, 1 << 10),
        None => match lower.strip_suffix('m') {
            Some(digits) => (digits, 1 << 20),
            None => (lower.as_str(), 1),
        },
    };
    match digits.parse::<u32>().ok().and_then(|n| n.checked_mul(scale)) {
        Some(count) if (64..=1 << 28).contains(&count) => Ok(count),
        _ => Err(format!("expected a count such as 64k or 1m, found '{text}'")),
    }
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match parts {
        Some((width, height)) if width > 0 && height > 0 => Ok((width, height)),
        _ => Err(format!("expected a size such as 1280x720, found '{text}'")),
    }
}

/// The default settings, with a light that is the same in all measurements.
fn plain() -> Settings {
    Settings::default().with(|it| {
        it.light.color = [4.0, 3.8, 3.4];
        it.light.ambient = [0.35, 0.45, 0.6];
        it.light.irradiance = [3.6, 3.5, 3.4];
        it.light.shade = [0.6, 0.8, 1.1];
    })
}
