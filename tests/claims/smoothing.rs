//! The claim of the smoothing: under `Rule::ConstantWidth` water is as rough in the world from
//! afar as from near. A jittered bed is seen from the distance where 256 iterations are planned at
//! the image's centre, and from 2, 4 and 8 times that; the same patch of the same beds is measured
//! each time. See `docs/smoothing.md`.

use std::sync::{Mutex, MutexGuard, PoisonError};

use ash::vk;
use glam::{DVec3, Mat4};
use whitewater::headless::{Background, Device, DeviceOptions, Headless, Picture};
use whitewater::water::Rule;
use whitewater::{Camera, Config, Error, Settings};

use super::bed::{self, Bed, SPACING};
use super::roughness::{self, Estimate, Found, Window};

/// Distances of the views, relative to the nearest.
const TIMES: [f32; 4] = [1.0, 2.0, 4.0, 8.0];
/// The claim: upper limit of the ratio of the roughest to the smoothest view.
const CLAIM: f64 = 1.15;

/// Iterations for water seen face on, with a smoothing width of σ pixels: `PER_VARIANCE` σ² + `MORE`, rounded up
/// (`glsl/water/reduce.comp`).
const PER_VARIANCE: f32 = 2.0;
const MORE: f32 = 2.0;

/// A row of the table.
#[derive(Clone, Debug)]
struct Row {
    name: &'static str,
    rule: Rule,
    /// Level of the smoothing's resolution.
    level: u32,
    /// Level of the resolution for which the nearest view is placed.
    placed: u32,
    /// Iterations planned at the centre of the nearest view.
    nearest: f32,
    /// Angle to the normal of the bed, degrees.
    slant: f32,
    /// Vertical field of view in degrees.
    field: f32,
    bed: Bed,
    /// Factor by which all views are nearer; the patch is smaller by the same factor.
    zoom: f32,
    /// Number of coarser levels that the smoothing may use.
    coarsening: u32,
    /// Width of the smoothing in drawn radii; the nearest view is placed for the default.
    width: f32,
}

impl Row {
    fn new(name: &'static str, rule: Rule) -> Self {
        Self {
            name,
            rule,
            level: 1,
            placed: 1,
            nearest: 256.0,
            slant: 0.0,
            field: 20.0,
            bed: Bed { side: 0.0, jitter: 0.2, upright: false, turn: None },
            zoom: 1.0,
            coarsening: 0,
            width: Settings::default().water.smoothing_width,
        }
    }

    /// The default: near views are smoothed at coarser levels.
    fn near(name: &'static str, zoom: f32) -> Self {
        let coarsening = Config::new(SMALL.extent, vk::Format::UNDEFINED, 1).coarsening;
        Self { zoom, coarsening, ..Self::new(name, Rule::ConstantWidth) }
    }
}

impl Row {
    /// The projection, and the distance of the nearest view.
    fn placing(&self, extent: vk::Extent2D) -> (Mat4, f32) {
        let mut water = Settings::default().water;
        water.spacing = SPACING;
        let wanted = water.smoothing_width * water.radius();
        let projection = bed::projection(self.field, extent);
        // World size of a pixel per unit of depth.
        let texel = 2.0 * (1 << self.placed) as f32;
        let pixel = texel / (extent.width as f32 * projection.x_axis.x);
        // The distance at which this number is planned at the image's centre.
        let near = wanted / (pixel * ((self.nearest - MORE - 0.5) / PER_VARIANCE).sqrt());
        (projection, near)
    }
}

/// Effort of a measurement: size of the image, which determines the size of the patch, and number of beds.
#[derive(Clone, Copy)]
struct Effort {
    extent: vk::Extent2D,
    beds: usize,
}

const SMALL: Effort = Effort { extent: vk::Extent2D { width: 320, height: 240 }, beds: 12 };
const LARGE: Effort = Effort { extent: vk::Extent2D { width: 640, height: 480 }, beds: 12 };

impl Effort {
    /// The patch, as large as fits into the nearest view at any slant: 11.2 by 8.4 spacings for the small image.
    fn window(self) -> Window {
        let spacings = |pixels: u32| f64::from(pixels) * 5.6 / 320.0 * f64::from(SPACING);
        Window { x: spacings(self.extent.width), y: spacings(self.extent.height) }
    }
}

/// Results of a row: for each distance, the views of all beds.
struct Measured {
    views: Vec<Vec<Found>>,
}

impl Measured {
    fn rms(&self, view: usize, keep: &dyn Fn(usize) -> bool) -> f64 {
        let kept = self.views[view].iter().enumerate().filter(|(bed, _)| keep(*bed));
        let (sum, count) =
            kept.fold((0.0, 0.0), |(s, n), (_, found)| (s + found.variance, n + 1.0));
        (sum / count).sqrt() / f64::from(SPACING)
    }

    /// Roughness in spacings.
    fn roughness(&self, view: usize) -> Estimate {
        roughness::jackknife(self.views[view].len(), |keep| self.rms(view, keep))
    }

    /// Ratio of the roughest to the smoothest view.
    fn spread(&self) -> Estimate {
        roughness::jackknife(self.views[0].len(), |keep| {
            let all: Vec<f64> = (0..TIMES.len()).map(|view| self.rms(view, keep)).collect();
            all.iter().copied().fold(0.0, f64::max) / all.iter().copied().fold(1e9, f64::min)
        })
    }

    fn holds(&self) -> bool {
        self.spread().value <= CLAIM
    }

    /// Mean number of iterations planned in the patch.
    fn iterations(&self, view: usize) -> f64 {
        let views = &self.views[view];
        views.iter().map(|found| found.iterations).sum::<f64>() / views.len() as f64
    }

    fn line(&self, name: &str) -> String {
        let mut line = format!("| {name} |");
        for view in 0..TIMES.len() {
            let Estimate { value, error } = self.roughness(view);
            line += &format!(" {value:.4} ± {error:.4} ({:.0}) |", self.iterations(view));
        }
        let Estimate { value, error } = self.spread();
        let verdict = if self.holds() { "yes" } else { "no" };
        line + &format!(" {:.0} ± {:.0} % | {verdict} |", 100.0 * (value - 1.0), 100.0 * error)
    }
}

/// Debian's validation layer can crash if a thread makes a device while another one draws, so tests with a device run
/// one after the other.
static ALONE: Mutex<()> = Mutex::new(());

/// A device, and what keeps others from having one.
fn device() -> (MutexGuard<'static, ()>, Device) {
    let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let set = |name| std::env::var_os(name).is_some_and(|value| value == "1");
    let open = |validation| Device::new(&DeviceOptions { validation, ..Default::default() });
    let device = match open(true) {
        Err(Error::Missing { what, .. })
            if what.contains("validation") && !set("WHITEWATER_REQUIRE_VALIDATION") =>
        {
            open(false)
        }
        device => device,
    };
    let device = device.unwrap_or_else(|error| panic!("no device: {error}"));
    if let Ok(expected) = std::env::var("WHITEWATER_EXPECT_ADAPTER") {
        let found = device.adapter.to_lowercase();
        assert!(found.contains(&expected.to_lowercase()), "expected {expected}, found {found}");
    }
    (alone, device)
}

/// Draws the beds of a row from all its distances, and returns the device.
fn measure(device: Device, row: &Row, effort: Effort) -> (Device, Measured) {
    let Window { x, y } = effort.window();
    // At the image's edge the flow is one-sided, which affects a large part of a small patch.
    let edge = if row.zoom > 1.0 { 1.5 * f64::from(SPACING) } else { 0.0 };
    let within = |size: f64| size / f64::from(row.zoom) - edge;
    let window = Window { x: within(x), y: within(y) };
    let mut settings = Settings::default();
    settings.water.spacing = SPACING;
    settings.water.smoothing_width = row.width;
    let (projection, near) = row.placing(effort.extent);
    // A margin of six spacings on all sides, for any rotation of the bed.
    let side = 2.0 * (window.x.hypot(window.y) as f32 / SPACING + 6.0);
    let config = Config::new(effort.extent, vk::Format::R16G16B16A16_SFLOAT, 1 << 16).with(|it| {
        it.smoothing_level = row.level;
        it.rule = row.rule;
        it.coarsening = row.coarsening;
        it.environment_size = 16;
    });
    let mut headless = Headless::new(device, &config).unwrap();
    let mut views = vec![Vec::new(); TIMES.len()];
    for seed in 0..effort.beds {
        let particles = Bed { side, ..row.bed }.particles(seed as u64 + 1);
        headless.particles(&particles, None).unwrap();
        for (view, times) in TIMES.iter().enumerate() {
            let camera = bed::camera(near * times / row.zoom, row.slant, projection);
            headless.render(&camera, &settings, &Background::Color([0.0; 3])).unwrap();
            let surface = headless.layer("water.surface").unwrap().unwrap();
            let plan = headless.layer("water.iterations").unwrap().unwrap();
            views[view].push(roughness::measure(&camera, &surface, &plan, window));
        }
    }
    let device = headless.finish().unwrap();
    let messages = device.take_messages();
    assert!(messages.is_empty(), "validation messages:\n{}", messages.join("\n"));
    (device, Measured { views })
}

#[test]
fn constant_width_keeps_its_roughness() {
    let row = Row::new("constant width", Rule::ConstantWidth);
    let (_alone, device) = device();
    let (_, measured) = measure(device, &row, SMALL);
    eprintln!("{}", measured.line(row.name));
    // Check that the views are at the intended distances.
    for (view, planned) in [256.0, 64.0, 16.0, 4.0].into_iter().enumerate() {
        let found = measured.iterations(view);
        assert!((found - planned).abs() < 3.0 + 0.03 * planned, "{found} planned at {view}");
    }
    // Check that there are enough beds.
    let spread = measured.spread();
    assert!(spread.error < 0.05, "{spread:?}");
    assert!(measured.holds(), "{spread:?}");
}

/// Where the iteration limit would apply, the smoothing uses a coarser level. At half the distance the claim still
/// holds, and without the coarser level it does not.
#[test]
fn near_views_keep_it_too() {
    let row = Row::near("constant width, by default, twice as near", 2.0);
    let capped = Row { coarsening: 0, ..row };
    let (_alone, device) = device();
    let (device, near) = measure(device, &row, LARGE);
    let (_, capped) = measure(device, &capped, LARGE);
    eprintln!("{}\n{}", near.line(row.name), capped.line("the same, capped"));
    assert!(near.holds(), "{:?}", near.spread());
    assert!(!capped.holds(), "{:?}", capped.spread());
}

/// From far away, a lattice at 45° to the pixels is nearly a checkerboard of pixels, which the largest stable step
/// inverts without damping.
#[test]
fn a_checkerboard_dies_out() {
    let row = Row::new("constant width, lattice at 45° to the pixels", Rule::ConstantWidth);
    let row = Row { bed: Bed { turn: Some(45.0), ..row.bed }, ..row };
    let (_alone, device) = device();
    let (_, measured) = measure(device, &row, SMALL);
    eprintln!("{}", measured.line(row.name));
    assert!(measured.holds(), "{:?}", measured.spread());
}

/// The check can fail: a fixed count smooths distant water too much and near water too little.
#[test]
fn a_fixed_count_does_not_keep_it() {
    let row = Row::new("fixed count of 40", Rule::Fixed(40));
    let (_alone, device) = device();
    let (_, measured) = measure(device, &row, SMALL);
    eprintln!("{}", measured.line(row.name));
    assert!(!measured.holds(), "{:?}", measured.spread());
    for view in 1..TIMES.len() {
        assert!(measured.roughness(view).value < measured.roughness(view - 1).value);
    }
}

/// Prints the table of `docs/smoothing.md`, with all rows besides the claim's.
#[test]
fn table() {
    if std::env::var_os("WHITEWATER_SLOW").is_none_or(|value| value != "1") {
        crate::skipped::skipped("the whole table takes long: WHITEWATER_SLOW=1 makes it");
        return;
    }
    use Rule::{ConstantWidth, Fixed, Source};
    let row = Row::new;
    let slanted = |name, rule, slant| Row { slant, ..row(name, rule) };
    let full = |name, slant| Row { level: 0, slant, ..row(name, ConstantWidth) };
    let other = |name, bed| Row { bed, ..row(name, ConstantWidth) };
    let bed = row("", ConstantWidth).bed;
    let rows = [
        row("**constant width**", ConstantWidth),
        Row::near("constant width, by default, from ½×", 2.0),
        Row::near("constant width, by default, from ¼×", 4.0),
        Row { coarsening: 0, ..Row::near("constant width, capped, from ¼×", 4.0) },
        row("source", Source),
        row("fixed count of 40", Fixed(40)),
        slanted("constant width, 45°", ConstantWidth, 45.0),
        slanted("constant width, 60°", ConstantWidth, 60.0),
        slanted("constant width, 75°", ConstantWidth, 75.0),
        slanted("source, 60°", Source, 60.0),
        slanted("fixed count of 40, 60°", Fixed(40), 60.0),
        Row { nearest: 120.0, ..row("constant width, nearest N = 120", ConstantWidth) },
        Row { field: 60.0, ..row("constant width, lens of 60°", ConstantWidth) },
        Row { placed: 0, ..full("constant width, full resolution, nearest N = 256", 0.0) },
        full("constant width, full resolution, same places", 0.0),
        full("constant width, full resolution, same places, 60°", 60.0),
        full("constant width, full resolution, same places, 75°", 75.0),
        Row { level: 2, ..row("constant width, quarter resolution, same places", ConstantWidth) },
        other("constant width, jitter 0.15", Bed { jitter: 0.15, ..bed }),
        other("constant width, jitter 0.25", Bed { jitter: 0.25, ..bed }),
        other("constant width, layers not staggered", Bed { upright: true, ..bed }),
        other("constant width, lattice along the pixels", Bed { turn: Some(0.0), ..bed }),
        other("constant width, lattice at 45° to them", Bed { turn: Some(45.0), ..bed }),
        Row { width: 0.0, ..row("not smoothed", ConstantWidth) },
        Row { width: 0.0, ..full("not smoothed, full resolution, same places", 0.0) },
    ];
    let (_alone, mut device) = device();
    eprintln!("{} ({})", device.adapter, device.driver);
    eprintln!("| rule and view | 1× | 2× | 4× | 8× | spread | within 15 % |");
    eprintln!("|---|---|---|---|---|---|---|");
    let mut claimed = Vec::new();
    for row in &rows {
        let measured;
        (device, measured) = measure(device, row, LARGE);
        eprintln!("{}", measured.line(row.name));
        claimed.push(measured.holds());
    }
    assert!(claimed[0], "the claim");
    assert!(claimed[1] && claimed[2], "near views");
    assert!(!claimed[4] && !claimed[5], "the other rules pass: the measure is blind");
}

/// Heights of the waves on the picture's bed, in spacings.
fn wave(x: f32, y: f32) -> f32 {
    0.4 * (x / 2.3 + 0.4 * y).sin() + 0.3 * (0.35 * x - y / 1.9 + 1.0).sin()
}

/// The surface under grazing light, as sRGB.
fn shaded(surface: &Picture<f32>, camera: &Camera) -> Vec<[u8; 3]> {
    let (projection, world) =
        (camera.projection_matrix().as_dmat4(), camera.view_matrix().as_dmat4().inverse());
    let at = |x: usize, y: usize| {
        let (x, y) = (x.min(surface.width - 1), y.min(surface.height - 1));
        let ray = roughness::ray(&projection, surface, x, y);
        world.transform_point3(f64::from(*surface.at(x, y)) * ray)
    };
    let light = DVec3::new(-0.85, 0.4, 0.34).normalize();
    let eye = world.w_axis.truncate();
    let pixel = |x: usize, y: usize| {
        let right = at(x + 1, y) - at(x.saturating_sub(1), y);
        let down = at(x, y + 1) - at(x, y.saturating_sub(1));
        let normal = down.cross(right).normalize_or_zero();
        let half = (light + (eye - at(x, y)).normalize()).normalize();
        let glint = 0.6 * normal.dot(half).max(0.0).powi(60);
        let level = 0.06 + 0.85 * normal.dot(light).max(0.0);
        let color = level * DVec3::new(0.25, 0.55, 0.75) + glint;
        color.powf(1.0 / 2.2).to_array().map(|c| (255.0 * c.min(1.0)) as u8)
    };
    let rows = (0..surface.height).flat_map(|y| (0..surface.width).map(move |x| (x, y)));
    rows.map(|(x, y)| pixel(x, y)).collect()
}

/// The picture of `docs/smoothing.md`, written to the file that `WHITEWATER_PICTURE` names: a wavy bed seen at 45°, in
/// the lower row from eight times as far; the rules side by side.
#[test]
fn picture() {
    let Some(path) = std::env::var_os("WHITEWATER_PICTURE") else {
        crate::skipped::skipped("WHITEWATER_PICTURE names no file for it");
        return;
    };
    const GAP: u32 = 8;
    let rules = [Rule::Fixed(40), Rule::Source, Rule::ConstantWidth];
    let times = [1.0, 8.0];
    let (_alone, mut device) = device();
    let mut all = image::RgbImage::new(0, 0);
    for (column, rule) in rules.into_iter().enumerate() {
        let row = Row { slant: 45.0, ..Row::new("picture", rule) };
        let (projection, near) = row.placing(LARGE.extent);
        let mut particles = Bed { side: 84.0, ..row.bed }.particles(1);
        for p in &mut particles {
            p[2] += SPACING * wave(p[0] / SPACING, p[1] / SPACING);
        }
        let mut settings = Settings::default();
        settings.water.spacing = SPACING;
        let config =
            Config::new(LARGE.extent, vk::Format::R16G16B16A16_SFLOAT, 1 << 16).with(|it| {
                it.smoothing_level = row.level;
                it.rule = rule;
                it.coarsening = 0;
                it.environment_size = 16;
            });
        let mut headless = Headless::new(device, &config).unwrap();
        headless.particles(&particles, None).unwrap();
        for (line, times) in times.into_iter().enumerate() {
            let camera = bed::camera(near * times, row.slant, projection);
            headless.render(&camera, &settings, &Background::Color([0.0; 3])).unwrap();
            let surface = headless.layer("water.surface").unwrap().unwrap();
            let plan = headless.layer("water.iterations").unwrap().unwrap();
            eprintln!("{rule:?}, {times}: {} planned", plan.at(plan.width / 2, plan.height / 2));
            let (width, height) = (surface.width as u32, surface.height as u32);
            let bytes = shaded(&surface, &camera).into_flattened();
            let whole = image::RgbImage::from_raw(width, height, bytes).unwrap();
            // The same patch at the same size.
            let (w, h) = (width / times as u32, height / times as u32);
            let patch = image::imageops::crop_imm(&whole, (width - w) / 2, (height - h) / 2, w, h);
            let filter = image::imageops::FilterType::CatmullRom;
            let tile = image::imageops::resize(&patch.to_image(), width, height, filter);
            if all.width() == 0 {
                let size = [(width, rules.len()), (height, 2)]
                    .map(|(tile, count)| (tile + GAP) * count as u32 - GAP);
                all = image::RgbImage::from_pixel(size[0], size[1], image::Rgb([255; 3]));
            }
            let place = [column as u32 * (width + GAP), line as u32 * (height + GAP)];
            image::imageops::replace(&mut all, &tile, place[0].into(), place[1].into());
        }
        device = headless.finish().unwrap();
    }
    all.save(path).unwrap();
}
