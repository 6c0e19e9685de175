//! Measures bubble foam: the built-in scenes of blobs are drawn, and simulated on the GPU and on the CPU.

use std::sync::Mutex;
use std::time::Instant;

use glam::{Mat4, Vec3, vec3};
use whitewater::ash::vk;
use whitewater::bubbles::{BlobSimulationSettings, BubbleConfig, BubbleSort, Impostor, Solid};
use whitewater::headless::scene::Scene;
use whitewater::headless::{Background, COLOR_FORMAT, Device, DeviceOptions, Headless};
use whitewater::{Camera, Config, Settings};

use super::heap::CpuHeap;
use super::report::{BlobRow, Report, Row};
use super::{BenchArgs, Drawn, lock, times};
use crate::bubbles::{FPS, Set, Which, set};
use crate::environment::{self, Environment};
use crate::failure::{Failure, Outcome};
use crate::progress::Progress;
use crate::settings::SettingsFile;

/// Warm-up steps, which are not counted: blobs fall onto each other.
const FALLING: u32 = 30;

/// Picture size of the source.
const SIZE: (u32, u32) = (640, 480);

pub fn measure_all(
    args: &BenchArgs,
    options: &DeviceOptions,
    report: &Mutex<Report>,
) -> Outcome<()> {
    let sizes = if args.size.is_empty() { &[SIZE] } else { &args.size[..] };
    let file = args.settings.as_deref().map(SettingsFile::read).transpose()?.unwrap_or_default();
    let mut progress = Progress::new(args.bubbles.len() * sizes.len(), "combinations");
    let steps = progress.steps();
    for which in &args.bubbles {
        for &(width, height) in sizes {
            let name = which.name();
            let what = format!("{name}, {width}x{height}");
            let extent = vk::Extent2D { width, height };
            match steps.during(&what, || measure(args, options, &file, which, extent)) {
                Ok(rows) => {
                    progress.aside(|| lock(report).add(rows))?;
                    progress.advance(&what);
                }
                Err(failure) => {
                    progress.finish();
                    let message = format!("{what}: {}", failure.message);
                    return Err(Failure { message, ..failure });
                }
            }
        }
    }
    progress.finish();
    Ok(())
}

fn measure(
    args: &BenchArgs,
    options: &DeviceOptions,
    file: &SettingsFile,
    which: &Which,
    extent: vk::Extent2D,
) -> Outcome<Vec<Row>> {
    let set = set(which)?;
    let max_blobs = set.blobs.blobs.len().max(1) as u32;
    let bubbles = file.bubbles.config().with(|it| {
        it.max_blobs = max_blobs;
        it.crossfade = false;
    });
    // There is no water, but room for 0 particles is not allowed.
    let config = Config::new(extent, COLOR_FORMAT, 64).with(|it| it.bubbles = Some(bubbles));
    let mut headless = Headless::new(Device::new(options)?, &config)?;
    let rows = sample(&mut headless, args, file, (which, set), config, bubbles);
    headless.finish()?;
    rows
}

fn sample(
    headless: &mut Headless,
    args: &BenchArgs,
    file: &SettingsFile,
    (which, set): (&Which, Set),
    config: Config,
    bubbles: BubbleConfig,
) -> Outcome<Vec<Row>> {
    let Set { blobs, scene, eye, target, .. } = set;
    let extent = config.extent;
    let environment = Environment::sky(Some([-0.55, 0.6, 0.45]))?;
    if let environment::Source::Sky(sky) = &environment.source {
        headless.sky(sky)?;
    }
    headless.scene(&Scene { sun: environment.sun_light(), ..scene }, true)?;
    headless.particles(&[], None)?;
    headless.bubbles(&blobs.blobs)?;
    let mut settings = Settings::default().with(|it| it.light = environment.light());
    file.apply(&mut settings);
    let aspect = extent.width as f32 / extent.height as f32;
    let fov = 36.0_f32.to_radians();
    let flip = Mat4::from_scale(vec3(1.0, -1.0, 1.0));
    let camera = Camera::of(
        Mat4::look_at_rh(eye.into(), target.into(), Vec3::Y),
        flip * Mat4::perspective_infinite_reverse_rh(fov, aspect, 0.05),
    );
    let times =
        times(headless, args, |headless| headless.render(&camera, &settings, &Background::Scene))?;
    let count = blobs.blobs.len() as u32;
    let template = Row {
        width: extent.width,
        height: extent.height,
        path: match bubbles.sort {
            BubbleSort::Tiles => "tiles".into(),
            BubbleSort::Peel => "peel".into(),
        },
        blobs: Some(BlobRow {
            bubble_scene: which.name(),
            blobs: count,
            bubbles: count * bubbles.bubbles,
            layers: bubbles.layers,
            impostor: match bubbles.impostor {
                Impostor::Ids => "ids",
                Impostor::Distance => "distance",
            },
            map: bubbles.map_size,
            steps: bubbles.steps,
        }),
        ..Row::of(headless)
    };
    let calibration = times.calibration();
    let mut rows = times.rows(&template, &Drawn::nothing(config));
    // Blobs without a scene fall onto the ground.
    let floor = Solid::Plane { normal: [0.0, 1.0, 0.0], distance: 0.0 };
    let moved = blobs.motion.map(|motion| (motion.settings, motion.solids));
    let (settings, solids) =
        moved.unwrap_or_else(|| (BlobSimulationSettings::default(), vec![floor]));
    // Blobs stay whole, because the CPU simulation does not split them.
    headless.heap(&blobs.blobs, None, 0)?;
    let gpu = steps(args, || {
        headless.heap_step(1.0 / FPS, &settings, &solids)?;
        Ok(headless.heap_time().unwrap_or(f64::NAN) * 1.0e-6)
    })?;
    let mut heap = CpuHeap::new(&blobs.blobs, &settings, &solids);
    let cpu = steps(args, || {
        let began = Instant::now();
        heap.step(1.0 / FPS);
        Ok(began.elapsed().as_secs_f64() * 1.0e3)
    })?;
    for (pass, mut times) in [("heap", gpu), ("heap on CPU", cpu)] {
        rows.push(Row { calibration, ..template.of_pass(pass, &mut times) });
    }
    Ok(rows)
}

/// Milliseconds of each counted step; `step` runs one and returns its time.
fn steps(args: &BenchArgs, mut step: impl FnMut() -> Outcome<f64>) -> Outcome<Vec<f64>> {
    for _ in 0..FALLING {
        step()?;
    }
    (0..args.frames).map(|_| step()).collect()
}
