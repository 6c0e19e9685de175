//! All ray-casters against their twin, against closed forms, against each other and against whitewater.

#[path = "../../../tests/support/skipped.rs"]
mod skipped;
mod twin;

use std::ops::Deref;
use std::sync::{Mutex, MutexGuard, PoisonError};

use whitewater::WhitewaterConfig;
use whitewater::ash::vk;
use whitewater::headless::{
    Background, COLOR_FORMAT, Device, DeviceOptions, Headless, Picture, Whitewater,
};
use whitewater::{Config, Error, Settings as Look};
use whitewater_raycast::{Caster, EMPTY, Foam, Input, Method, PROFILES, SceneDepth, Settings};

use twin::{Bound, Twin, U, camera};

const SIZE: [u32; 2] = [64, 48];
const RADIUS: f32 = 0.3;
/// Fixed-point steps per unit of thickness, in the grid's sums.
const STEPS: f64 = 65536.0;

/// Debian's validation layer can crash if a thread makes a device while another one draws, so tests run one after the
/// other.
static ALONE: Mutex<()> = Mutex::new(());

/// A device whose messages fail the test at its end, and what keeps other tests from having one.
struct Gpu(Option<Device>, #[expect(dead_code, reason = "held")] MutexGuard<'static, ()>);

impl Gpu {
    fn new() -> Self {
        let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let make = |validation| Device::new(&DeviceOptions { validation, ..Default::default() });
        let required = std::env::var_os("WHITEWATER_REQUIRE_VALIDATION").is_some_and(|v| v == "1");
        let device = match make(true) {
            Err(Error::Missing { what, .. }) if what.contains("validation") && !required => {
                skipped::skipped(&format!("validation: {what} is missing"));
                make(false)
            }
            made => made,
        };
        Self(Some(device.expect("a device")), alone)
    }
}

impl Deref for Gpu {
    type Target = Device;

    fn deref(&self) -> &Device {
        self.0.as_ref().expect("until it is taken")
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        let messages = self.0.as_ref().map(Device::take_messages).unwrap_or_default();
        if !std::thread::panicking() {
            assert!(messages.is_empty(), "validation: {messages:#?}");
        }
    }
}

/// Random numbers from 0 to 1 (xorshift, Marsaglia 2003).
struct Random(u64);

impl Random {
    fn between(&mut self, low: f32, high: f32) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * (self.0 >> 40) as f32 / (1 << 24) as f32
    }
}

/// Particles of all kinds, ages and sizes: the largest fill a quarter of the picture, the smallest a tenth of a pixel,
/// and some lie beside it.
fn cloud(count: usize, seed: u64) -> Foam {
    let mut random = Random(seed);
    let mut foam = Foam::default();
    for i in 0..count {
        let depth = random.between(0.9, 3.0) * random.between(1.0, 4.0);
        let [x, y] = [0.9, 0.7].map(|edge| depth * random.between(-edge, edge));
        foam.positions.push([x, y, -depth]);
        foam.kinds.push(i as u32 % 4);
        foam.ages.push(random.between(-0.2, 0.99));
        foam.ids.push(random.between(0.0, 1.0e6) as u32);
    }
    foam
}

/// One particle in the middle of a pixel, of default radius.
fn one(kind: u32, [x, y]: [u32; 2], depth: f32) -> Foam {
    let slope = (30_f32).to_radians().tan();
    let across = slope * SIZE[0] as f32 / SIZE[1] as f32;
    let at = |v: u32, size: u32| 2.0 * (v as f32 + 0.5) / size as f32 - 1.0;
    Foam {
        positions: vec![[depth * across * at(x, SIZE[0]), -depth * slope * at(y, SIZE[1]), -depth]],
        kinds: vec![kind],
        ages: vec![0.0],
        ids: vec![0],
    }
}

struct Drawn {
    thickness: Picture<f32>,
    intensity: Picture<f32>,
    chunks: usize,
}

fn draw(gpu: &Gpu, method: Method, foam: &Foam, scene: &SceneDepth, settings: &Settings) -> Drawn {
    let camera = camera(SIZE[0] as f32 / SIZE[1] as f32);
    let input = Input { foam, radius: RADIUS, camera: &camera, size: SIZE, scene };
    let caster = Caster::new(gpu, method, &input, settings).expect("it can be drawn");
    // The second draw runs over the data that the first one left.
    for _ in 0..2 {
        caster.draw().expect("it is drawn");
    }
    let thickness = caster.thickness().expect("read back");
    let intensity = caster.intensity().expect("read back");
    Drawn { thickness, intensity, chunks: caster.chunk_count() }
}

/// Samples per slab; the twin uses the same number as the ray-casters.
fn samples(method: Method, step: f32) -> u32 {
    match method {
        Method::Kernel | Method::Plain => (32.0 / step).ceil().max(1.0) as u32,
        Method::Grid => 8,
    }
}

fn twin_of(method: Method, foam: &Foam, scene: &SceneDepth, settings: &Settings) -> Twin {
    Twin::new(foam, RADIUS, SIZE, scene, settings, samples(method, settings.step))
}

/// Adds the rounding of the grid's fixed point to a bound.
fn bound_of(method: Method, bound: Bound) -> Bound {
    let rounding = match method {
        Method::Kernel | Method::Plain => 0.0,
        Method::Grid => f64::from(bound.hits) * 0.5 / STEPS,
    };
    Bound { error: bound.error + rounding, ..bound }
}

fn at(picture: &Picture<f32>, (x, y): (u32, u32)) -> f64 {
    f64::from(*picture.at(x as usize, y as usize))
}

const WHOLE: Settings = Settings {
    step: 0.5,
    shifted: true,
    half: 3.0,
    exponent: 1.25,
    opaque: 1.0,
    tile: None,
    cell: None,
    chunk: None,
};

#[test]
fn all_are_their_twins() {
    let gpu = Gpu::new();
    let foam = cloud(500, 7);
    let mut random = Random(3);
    let near = (0..SIZE[0] * SIZE[1]).map(|_| random.between(2.0, 9.0)).collect();
    let near = SceneDepth::Depths(near);
    for (step, shifted, tile, scene) in [
        (0.5, true, None, &SceneDepth::Nothing),
        (0.5, false, Some(8), &near),
        (0.15, true, Some(16), &near),
        (3.0, true, Some(4), &SceneDepth::Nothing),
    ] {
        let settings = Settings { step, shifted, tile, ..WHOLE };
        for method in Method::ALL {
            let drawn = draw(&gpu, method, &foam, scene, &settings);
            let twin = twin_of(method, &foam, scene, &settings);
            let (mut some, mut sum, mut errors) = (0, 0.0, 0.0);
            for pixel in twin.pixels() {
                let Bound { value, error, .. } = bound_of(method, twin.thickness(pixel.0, pixel.1));
                let found = at(&drawn.thickness, pixel);
                assert!(
                    (found - value).abs() <= error,
                    "{method:?} step {step} {pixel:?}: {found}, expected {value} ± {error}"
                );
                let iota = found.powf(1.25) / (3.0 + found.powf(1.25));
                let iota_found = at(&drawn.intensity, pixel);
                assert!((iota_found - iota).abs() <= 4.0e-6, "{pixel:?}: {iota_found} not {iota}");
                some += usize::from(value > 0.01);
                sum += value;
                errors += error;
            }
            assert!(some > 1000, "only {some} pixels with foam");
            // The bounds are narrow enough to show a fault.
            assert!(errors < 0.01 * sum, "{method:?} step {step}: ±{errors} of {sum}");
        }
    }
}

#[test]
fn one_particle_has_its_sprites_thickness() {
    let gpu = Gpu::new();
    let settings = Settings { step: 1.0 / 64.0, shifted: false, ..WHOLE };
    let own = [|x: f64| 1.0 - x.powf(2.25), |x: f64| 1.0 - x.powf(1.5)];
    for method in Method::ALL {
        for kind in 0..3 {
            let pixel = [37, 18];
            let foam = one(kind, pixel, 2.0);
            let drawn = draw(&gpu, method, &foam, &SceneDepth::Nothing, &settings);
            let profile = PROFILES[kind as usize];
            let size = if kind == 2 { 0.5 } else { 1.0 };
            // Steps in radii. With equal steps the error is at most one step times the total variation of the kernel,
            // which is at most twice the sum of its coefficients.
            let step = f64::from(settings.step) / size;
            let most = 2.0 * step * profile.iter().map(|v| v.abs()).sum::<f64>();
            let middle: f64 = profile.iter().sum();
            let found = at(&drawn.thickness, (pixel[0], pixel[1]));
            assert!((found - middle).abs() < most, "{method:?} {kind}: {found}, not {middle}");
            let reach = 0.5 * SIZE[1] as f64 * f64::from(RADIUS) * size
                / (2.0 * (30_f64).to_radians().tan());
            for dx in 0..12_u32 {
                let x = f64::from(dx) / reach;
                let y = (1.0 - x * x).max(0.0);
                let found = at(&drawn.thickness, (pixel[0] + dx, pixel[1]));
                let here = y * (profile[0] + y * (profile[1] + y * profile[2]));
                assert!((found - here).abs() < most, "{method:?} {kind} {dx}: {found} not {here}");
                if let Some(sprite) = own.get(kind as usize).filter(|_| x < 1.0) {
                    let near = [0.0064, 0.035][kind as usize];
                    let sprite = sprite(x);
                    assert!((found - sprite).abs() < most + near, "{kind} {dx}: {sprite}");
                }
            }
        }
    }
}

/// Checks the errors that the documentation states for the profiles.
#[test]
fn profiles_are_near_the_sprites() {
    type Shape = fn(f64) -> f64;
    let shapes: [(Shape, f64, f64, f64); 3] = [
        (|x| 1.0 - x.powf(2.25), 1.0 - 2.0 / 4.25, 0.0064, 0.00101),
        (|x| 1.0 - x.powf(1.5), 1.0 - 2.0 / 3.5, 0.0349, 0.00421),
        (|x| x * x, 0.5, 1.0, 0.324),
    ];
    for ([a, b, c], (shape, mean, most, rms)) in PROFILES.into_iter().zip(shapes) {
        assert!((a / 2.0 + b / 3.0 + c / 4.0 - mean).abs() < 1.0e-8);
        let (mut largest, mut squares) = (0.0_f64, 0.0);
        const COUNT: u32 = 100_000;
        for i in 0..COUNT {
            let y = (f64::from(i) + 0.5) / f64::from(COUNT);
            let thickness = y * (a + y * (b + y * c));
            let d = (thickness - shape((1.0 - y).sqrt())).abs();
            largest = largest.max(d);
            squares += d * d;
            let abel = whitewater_raycast::ABEL;
            let kernel = abel[0] * a + y * (abel[1] * b + y * abel[2] * c);
            assert!(kernel > -1.0e-8, "a kernel below nothing: {kernel} at {y}");
        }
        assert!(largest < most, "{largest} of {most}");
        let found = (squares / f64::from(COUNT)).sqrt();
        assert!(found < rms && found > 0.98 * rms, "{found} of {rms}");
    }
}

/// All methods converge to the integral with order 3/2: an eighth of the step has a 22nd of the error.
#[test]
fn all_converge_to_the_integral() {
    let gpu = Gpu::new();
    let foam = cloud(400, 11);
    for method in Method::ALL {
        let rms = |step| {
            let settings = Settings { step, ..WHOLE };
            let drawn = draw(&gpu, method, &foam, &SceneDepth::Nothing, &settings);
            let twin = twin_of(method, &foam, &SceneDepth::Nothing, &settings);
            let squares =
                twin.pixels().map(|p| (at(&drawn.thickness, p) - twin.integral(p.0, p.1)).powi(2));
            (squares.sum::<f64>() / f64::from(SIZE[0] * SIZE[1])).sqrt()
        };
        let (coarse, fine) = (rms(0.125), rms(0.125 / 8.0));
        let order = (coarse / fine).log2() / 3.0;
        eprintln!("{method:?}: {coarse} to {fine}, order {order}");
        assert!((1.3..1.8).contains(&order), "{method:?}: {coarse} to {fine}: order {order}");
    }
}

#[test]
fn both_are_one_picture() {
    let gpu = Gpu::new();
    let foam = cloud(400, 5);
    let settings = Settings { step: 1.0 / 32.0, ..WHOLE };
    let both = [Method::Kernel, Method::Grid];
    let [kernel, grid] = both.map(|m| draw(&gpu, m, &foam, &SceneDepth::Nothing, &settings));
    // The methods may have different slabs. Samples then differ only where steps grow, by the growth within a slab.
    let twins = both.map(|m| twin_of(m, &foam, &SceneDepth::Nothing, &settings));
    for pixel in twins[0].pixels() {
        let [a, b] = [0, 1].map(|i| bound_of(both[i], twins[i].thickness(pixel.0, pixel.1)));
        // `most` sums each picture's distance from the integral and its rounding.
        let exact = twins[0].integral(pixel.0, pixel.1);
        let most = (a.value - exact).abs() + (b.value - exact).abs() + a.error + b.error;
        let d = (at(&kernel.thickness, pixel) - at(&grid.thickness, pixel)).abs();
        assert!(d <= most, "{pixel:?}: {d} apart, {most} expected");
        assert!(d < 0.01 * f64::from(a.met.max(1)), "{pixel:?}: {d} of {} particles", a.met);
    }
}

/// The plain and the kernel ray-caster have the same samples, so each differs from the twin's sum by rounding alone.
#[test]
fn plain_is_the_kernels_picture() {
    let gpu = Gpu::new();
    let mut random = Random(37);
    let near = (0..SIZE[0] * SIZE[1]).map(|_| random.between(2.0, 9.0)).collect();
    let near = SceneDepth::Depths(near);
    for (seed, count, farther, step, cell, scene) in [
        (41, 2000, 1.0, 0.5, None, &SceneDepth::Nothing),
        // One particle has only two buckets where rows may begin, so rows share them.
        (43, 1, 0.5, 0.1, Some(1.0), &SceneDepth::Nothing),
        (47, 800, 1.0, 0.07, Some(2.0), &near),
        // Most particles lie where cells grow with the depth.
        (53, 2000, 5.0, 0.5, Some(1.0), &SceneDepth::Nothing),
        (59, 4000, 1.0, 7.0, None, &SceneDepth::Nothing),
    ] {
        let mut foam = cloud(count, seed);
        foam.positions.as_flattened_mut().iter_mut().for_each(|x| *x *= farther);
        let settings = Settings { step, cell, ..WHOLE };
        let [kernel, plain] =
            [Method::Kernel, Method::Plain].map(|m| draw(&gpu, m, &foam, scene, &settings));
        let twin = twin_of(Method::Plain, &foam, scene, &settings);
        let (mut sum, mut errors) = (0.0, 0.0);
        for pixel in twin.pixels() {
            let (a, b) = (at(&kernel.thickness, pixel), at(&plain.thickness, pixel));
            let Bound { value, error, .. } = twin.thickness(pixel.0, pixel.1);
            let most = 2.0 * error;
            assert!((a - b).abs() <= most, "step {step} {pixel:?}: {a} and {b}, {most} expected");
            sum += value;
            errors += error;
        }
        assert!(sum > 0.0 && errors < 0.01 * sum, "seed {seed}: ±{errors} of {sum}");
    }
}

#[test]
fn nothing_is_drawn_of_nothing() {
    let gpu = Gpu::new();
    let nan = f32::NAN;
    let foam = cloud(300, 13);
    let mut more = foam.clone();
    for (position, age) in [
        ([nan, 0.0, -3.0], 0.0),
        ([0.0, nan, -3.0], 0.0),
        ([0.0, 0.0, nan], 0.0),
        ([f32::INFINITY, 0.0, -3.0], 0.0),
        ([0.0, 0.0, f32::NEG_INFINITY], 0.0),
        ([0.0, 0.0, -1.0e20], 0.0),
        ([0.0, 0.0, 3.0], 0.0),
        ([0.0, 0.0, -3.0], 1.0),
        ([0.0, 0.0, -3.0], nan),
        ([50.0, 0.0, -3.0], 0.0),
    ] {
        more.positions.push(position);
        more.kinds.push(0);
        more.ages.push(age);
        more.ids.push(0);
    }
    for method in Method::ALL {
        let none = draw(&gpu, method, &Foam::default(), &SceneDepth::Nothing, &WHOLE);
        assert!(none.thickness.data.iter().chain(&none.intensity.data).all(|v| *v == 0.0));
        let [a, b] = [&foam, &more]
            .map(|foam| draw(&gpu, method, foam, &SceneDepth::Nothing, &WHOLE).thickness.data);
        for (a, b) in a.iter().zip(&b) {
            // The order in which kernels are summed is not defined: at most all 300 particles, with some samples each.
            let error = 3000.0 * U as f32 * a;
            assert!((a - b).abs() <= error, "{method:?}: {a}, with nothing more {b}");
        }
    }
}

#[test]
fn nothing_is_drawn_behind_the_scene() {
    let gpu = Gpu::new();
    let foam = cloud(300, 17);
    let behind = |depth: f32| SceneDepth::Depths(vec![depth; (SIZE[0] * SIZE[1]) as usize]);
    for method in Method::ALL {
        let free = draw(&gpu, method, &foam, &SceneDepth::Nothing, &WHOLE).thickness;
        let far = draw(&gpu, method, &foam, &behind(40.0), &WHOLE).thickness;
        let none = draw(&gpu, method, &foam, &behind(0.2), &WHOLE).thickness;
        assert!(none.data.iter().all(|v| *v == 0.0), "{method:?}");
        for (a, b) in free.data.iter().zip(&far.data) {
            assert!((a - b).abs() <= 3000.0 * U as f32 * a, "{method:?}: {a} {b}");
        }
        // A plane that cuts the cloud.
        let across = (30_f64).to_radians().tan();
        let depths = (0..SIZE[0] * SIZE[1]).map(|i| {
            let y = 1.0 - 2.0 * (f64::from(i / SIZE[0]) + 0.5) / f64::from(SIZE[1]);
            // 0.3 y z + 2 (−z) = −7
            (7.0 / (2.0 - 0.3 * across * y)) as f32
        });
        let depths = SceneDepth::Depths(depths.collect());
        let twin = twin_of(method, &foam, &depths, &WHOLE);
        let cut = draw(&gpu, method, &foam, &depths, &WHOLE).thickness;
        let mut less = 0;
        for pixel in twin.pixels() {
            let bound = bound_of(method, twin.thickness(pixel.0, pixel.1));
            let found = at(&cut, pixel);
            assert!((found - bound.value).abs() <= bound.error, "{pixel:?}: {found} {bound:?}");
            less += usize::from(found < at(&free, pixel) - 0.1);
        }
        assert!(less > 100, "{less} pixels are cut");
    }
}

#[test]
fn chunks_make_no_difference() {
    let gpu = Gpu::new();
    let foam = cloud(400, 19);
    let chunked = Settings { chunk: Some(130), ..WHOLE };
    for method in Method::ALL {
        let whole = draw(&gpu, method, &foam, &SceneDepth::Nothing, &WHOLE);
        let parts = draw(&gpu, method, &foam, &SceneDepth::Nothing, &chunked);
        assert_eq!((whole.chunks, parts.chunks), (1, 4));
        for (a, b) in whole.thickness.data.iter().zip(&parts.thickness.data) {
            assert!((a - b).abs() <= 4000.0 * U as f32 * a, "{method:?}: {a}, in chunks {b}");
        }
    }
}

/// Rays end early within half a step of 8 bits.
#[test]
fn rays_end_when_nothing_more_shows() {
    let gpu = Gpu::new();
    // Dense, and deeper than a slab of any method.
    let mut foam = cloud(3000, 23);
    for (i, position) in foam.positions.iter_mut().enumerate() {
        let depth = 2.0 + 0.008 * i as f32;
        // A wide cone of particles around a narrow, denser one.
        let wide = depth / -position[2] * if i % 3 == 0 { 0.15 } else { 0.05 };
        *position = [-0.2 * depth + wide * position[0], wide * position[1], -depth];
        foam.kinds[i] = 0;
        foam.ids[i] = 0;
        foam.ages[i] = 0.0;
    }
    for method in Method::ALL {
        let whole = draw(&gpu, method, &foam, &SceneDepth::Nothing, &WHOLE);
        let settings = Settings { opaque: Settings::default().opaque, ..WHOLE };
        let ended = draw(&gpu, method, &foam, &SceneDepth::Nothing, &settings);
        let mut early = 0;
        for i in 0..whole.intensity.data.len() {
            let (a, b) = (whole.intensity.data[i], ended.intensity.data[i]);
            assert!((a - b).abs() <= 1.0 / 512.0, "{method:?}: {a} {b}");
            early += usize::from(ended.thickness.data[i] < 0.95 * whole.thickness.data[i]);
        }
        assert!(early > 3, "{method:?}: {early} rays end early");
    }
}

/// The thickness converges to that of whitewater's sprites, for foam whose half-axis is at least half a pixel.
#[test]
fn converged_thickness_is_whitewaters() {
    let mut gpu = Gpu::new();
    let mut foam = cloud(300, 29);
    foam.kinds.fill(0);
    foam.ids.iter_mut().for_each(|id| *id -= *id % 5);
    let settings = Settings { step: 1.0 / 64.0, ..WHOLE };
    let casts = Method::ALL.map(|m| draw(&gpu, m, &foam, &SceneDepth::Nothing, &settings));
    let twin = twin_of(Method::Kernel, &foam, &SceneDepth::Nothing, &settings);
    let extent = vk::Extent2D { width: SIZE[0], height: SIZE[1] };
    let whitewater = Some(WhitewaterConfig::new(300));
    let config = Config::new(extent, COLOR_FORMAT, 1024).with(|it| it.whitewater = whitewater);
    let mut headless = Headless::new(gpu.0.take().expect("a device"), &config).expect("renderer");
    headless.particles(&[], None).expect("no particles");
    headless
        .whitewater(Some(&Whitewater {
            positions: &foam.positions,
            kinds: Some(&foam.kinds),
            radii: None,
            ages: Some(&foam.ages),
            ids: Some(&foam.ids),
        }))
        .expect("particles");
    let mut look = Look::default();
    look.whitewater.radius = RADIUS;
    let camera = camera(SIZE[0] as f32 / SIZE[1] as f32);
    headless.render(&camera, &look, &Background::Color([0.0; 3])).expect("drawn");
    let ours = headless.layer("whitewater.thickness").expect("read").expect("a layer");
    gpu.0 = Some(headless.finish().expect("the device"));
    let mut some = 0;
    for pixel in twin.pixels() {
        let ours = at(&ours, pixel);
        for (method, cast) in Method::ALL.into_iter().zip(&casts) {
            let met = f64::from(twin.thickness(pixel.0, pixel.1).met);
            // Per particle: the error of the profile, the error of equal steps (see above; foam's kernel rises and
            // falls once), and half a step of whitewater's fixed-point sum.
            let most = met * (0.0064 + 2.0 / 64.0 * 0.72 + 1.0e-4);
            let cast = at(&cast.thickness, pixel);
            assert!((cast - ours).abs() <= most, "{method:?} {pixel:?}: {cast}, ours {ours}");
        }
        some += usize::from(ours > 0.1);
    }
    assert!(some > 1000, "{some} pixels with foam");
}

#[test]
fn bad_input_is_an_error() {
    let gpu = Gpu::new();
    let foam = cloud(10, 31);
    let camera = camera(1.0);
    let scene = SceneDepth::Nothing;
    let input = Input { foam: &foam, radius: 0.1, camera: &camera, size: [8, 8], scene: &scene };
    let settings = Settings::default();
    let short = Foam { ages: vec![0.0; 9], ..foam.clone() };
    let flat = whitewater::Camera { projection: glam::Mat4::IDENTITY.to_cols_array_2d(), ..camera };
    let depths = SceneDepth::Depths(vec![EMPTY; 63]);
    for (name, input, settings) in [
        ("Settings.step", input, Settings { step: f32::NAN, ..settings }),
        ("Settings.step", input, Settings { step: 0.0, ..settings }),
        ("Settings.opaque", input, Settings { opaque: 1.1, ..settings }),
        ("Settings.half", input, Settings { half: -1.0, ..settings }),
        ("Settings.exponent", input, Settings { exponent: 0.0, ..settings }),
        ("Settings.tile", input, Settings { tile: Some(5), ..settings }),
        ("Settings.cell", input, Settings { cell: Some(0.9), ..settings }),
        ("Settings.cell", input, Settings { cell: Some(f32::NAN), ..settings }),
        ("Settings.chunk", input, Settings { chunk: Some(0), ..settings }),
        ("Input.radius", Input { radius: 0.0, ..input }, settings),
        ("Input.size", Input { size: [0, 8], ..input }, settings),
        ("Input.size", Input { size: [65536, 65536], ..input }, settings),
        ("Input.foam", Input { foam: &short, ..input }, settings),
        ("Input.scene", Input { scene: &depths, ..input }, settings),
        ("Input.camera", Input { camera: &flat, ..input }, settings),
    ] {
        match Caster::new(&gpu, Method::Grid, &input, &settings) {
            Err(Error::BadInput { field, .. }) => assert_eq!(field, name),
            Err(error) => panic!("{name}: {error}"),
            Ok(_) => panic!("{name} is taken"),
        }
    }
}
