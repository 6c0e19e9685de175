//! A spy in Vulkan's function table shows that a record makes no forbidden calls, that memory use
//! is constant, and that every call that can fail is handled without leaks.

use std::mem;

use ash::vk;
use whitewater::bubbles::{BubbleConfig, BubbleSort};
use whitewater::headless::{Background, Headless, Whitewater};
use whitewater::shore::ShoreConfig;
use whitewater::water::{Convolution, Gate, Kernels, Shading, Shadows, Smoothing, Splat};
use whitewater::{
    Config, Context, EnvironmentSource, Equirectangular, Error, Particles, Previous, Recorded,
    Renderer, Shore, Shoreline, Slot, WhitewaterConfig,
};

use crate::light::{even, everything};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Foamed, Rig, Shot, WhitewaterCloud, config, extent, stream};
use crate::support::scenes::{self, Lens};
use crate::support::{slow, spy};
use crate::surface_foam::Foamy;

pub fn spied() -> Gpu {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    gpu
}

fn water(size: vk::Extent2D) -> Shot {
    let points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    Shot::new(size, Lens::Standard, 0.2, &points)
}

/// Checks that what records neither waits nor submits, and makes no memory and no pipelines.
pub fn only_records<T>(gpu: &Gpu, name: &str, record: impl FnOnce() -> Result<T, Error>) {
    spy::reset();
    // The allocator stays locked: a record that used it would wait for ever.
    let allocator = gpu.allocator.clone();
    let held = allocator.lock().unwrap();
    record().unwrap_or_else(|error| panic!("{name}: {error}"));
    drop(held);
    for function in spy::NOT_IN_A_RECORD {
        assert_eq!(function.calls(), 0, "{name}: record calls {:?}", function.name);
    }
    assert!(spy::CMD_BARRIER.calls() > 0 && spy::CMD_BIND_PIPELINE.calls() > 0, "it sees");
}

fn watched(name: &str, rig: &mut Rig<'_>, shot: &Shot, particles: Particles) {
    let gpu = rig.gpu;
    let (color, depth) = rig.scene(shot);
    let theirs = rig.config.bubbles.filter(|bubbles| !bubbles.crossfade);
    let blobs = theirs.map(|_| rig.blobs(shot));
    let points = scenes::world(&shot.camera, &scenes::cloud(7, 40, 1.0, 9.0));
    let foam = rig
        .config
        .whitewater
        .map(|_| rig.whitewater(&Whitewater { positions: &points, ..Default::default() }));
    let frame = shot.frame(color.host_image(), depth.host_image(), particles).with(|it| {
        it.bubbles = blobs.as_ref().map(Foamed::streams);
        it.whitewater = foam.as_ref().map(WhitewaterCloud::particles);
        it.shore = rig.config.shore.map(|_| Shore::new(0.0).with_shoreline(Shoreline::Screen));
        it.previous = rig.config.motion.then_some(Previous { camera: shot.camera, dt: 0.02 });
    });
    let shadow = shot.shadow.map(|shadow| shadow.image.image);
    for _ in 0..3 {
        let cmd = rig.stub.begin(0);
        // SAFETY: cmd is recording, and the slot was waited for.
        only_records(gpu, name, || unsafe { rig.renderer().record(cmd, &frame) });
        let (sets, room) = (spy::ALLOCATE_SETS.calls(), spy::MAX_SETS.load(RELAXED));
        assert!(sets <= room, "{name}: {sets} descriptor sets from a pool of {room}");
        // One barrier acquires each image and one releases it. The scene's colour is also the
        // output here, so it is copied before drawing; the lit scene copies it once more.
        for image in [depth.image].into_iter().chain(shadow) {
            assert_eq!(spy::barriers_of(image), 2, "{name}");
        }
        let inner = 1 + usize::from(rig.config.light_map_size.is_some());
        assert_eq!(spy::barriers_of(color.image), 2 + inner, "{name}");
        rig.stub.end(0);
        rig.stub.wait(0);
        rig.collect(Slot(0));
    }
}

const RELAXED: std::sync::atomic::Ordering = std::sync::atomic::Ordering::Relaxed;

#[test]
fn record_only_records() {
    let gpu = spied();
    let size = extent(48, 32);
    let base = config(size);
    let query = Some(Smoothing::Query(Gate::VertexCull));
    let bubbles = BubbleConfig::new(64).with(|it| {
        it.variants = 2;
        it.bubbles = 16;
    });
    let billboards = bubbles.with(|it| it.sort = BubbleSort::Peel);
    let mut configs = vec![
        ("one sheet", base),
        ("two sheets", base.with(|it| it.sheets = 2)),
        (
            "raster",
            base.with(|it| {
                it.depth_splat = Some(Splat::Raster);
                it.thickness_splat = Some(Splat::Raster);
            }),
        ),
        ("compute composite", base.with(|it| it.composite = Some(Shading::Compute))),
        ("fused", base.with(|it| it.smoothing = Some(Smoothing::Fused))),
        ("query", base.with(|it| it.smoothing = query)),
        ("motion", base.with(|it| it.motion = true)),
        ("noise", base.with(|it| it.noise = Some(1))),
        ("whitewater", base.with(|it| it.whitewater = Some(WhitewaterConfig::new(1024)))),
        ("ellipsoids", base.with(|it| it.kernels = Kernels::Ellipsoids)),
        ("shore", base.with(|it| it.shore = Some(ShoreConfig::default()))),
        ("bubbles", base.with(|it| it.bubbles = Some(bubbles))),
        (
            "crossfade",
            base.with(|it| {
                it.whitewater = Some(WhitewaterConfig::new(1024));
                it.bubbles = Some(bubbles.with(|it| it.crossfade = true));
            }),
        ),
        ("billboards", base.with(|it| it.bubbles = Some(billboards))),
    ];
    if gpu.enabled.conditional_rendering {
        let smoothing = Some(Smoothing::Query(Gate::Predicate));
        configs.push(("predicate", base.with(|it| it.smoothing = smoothing)));
    }
    if gpu.enabled.draw_indirect_count {
        let smoothing = Some(Smoothing::Query(Gate::DrawCount));
        configs.push(("draw count", base.with(|it| it.smoothing = smoothing)));
    }
    gpu.share_context();
    for (name, config) in configs {
        let mut rig = Rig::new(&gpu, &config);
        let (shot, cloud) = (water(size), rig.particles(&water(size)));
        let velocities = Some(stream(&cloud.positions, 0, 12)); // any values will do
        watched(name, &mut rig, &shot, cloud.particles().with(|it| it.velocities = velocities));
    }
}

/// A new environment, as a frame, only records.
#[test]
fn an_environment_only_records() {
    let gpu = spied();
    let mut rig = Rig::new(&gpu, &config(extent(16, 8)));
    let map = rig.map(extent(16, 8), &[[0.5; 4]; 128]);
    let source = EnvironmentSource::Equirectangular(Equirectangular::new(map.host_image()));
    for _ in 0..3 {
        let cmd = rig.stub.begin(0);
        only_records(&gpu, "environment", || {
            // SAFETY: cmd is recording, the slot was waited for, and the map outlives the commands.
            unsafe { rig.renderer().record_environment(cmd, Slot(0), &source) }
        });
        rig.stub.end(0);
        rig.stub.wait(0);
        rig.collect(Slot(0));
    }
}

/// Checks frames with foam, spray, two sheets and light together, with raster and compute splats.
#[test]
fn record_only_records_with_foam_spray_and_light() {
    let gpu = spied();
    gpu.share_context();
    let mut case = Foamy::new(extent(48, 32), Lens::Reversed, 30.0);
    let all = everything(&mut case);
    for (name, splat) in [("compute", Splat::Compute), ("raster", Splat::Raster)] {
        let config = all.with(|it| {
            it.depth_splat = Some(splat);
            it.thickness_splat = Some(splat);
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let (_image, shadow) = even(&rig, 0.5);
        case.shot.shadow = Some(shadow);
        let streams = case.streams(&rig);
        watched(name, &mut rig, &case.shot, streams.particles());
    }
    // All passes that need descriptor sets, in one frame.
    let convolution = Convolution { terms: 16, texels: 32, bits: 8 };
    let shadow = Some(Shadows::Convolution(convolution));
    let size = extent(48, 32);
    let config = config(size).with(|it| {
        it.shadow = shadow;
        it.light_map_size = Some(16);
        it.surface_foam = true;
        it.spray = true;
        it.sheets = 2;
    });
    let (mut rig, mut shot) = (Rig::new(&gpu, &config), water(size));
    let _shade = crate::contract::sunny(&rig, &mut shot);
    let cloud = rig.particles(&shot);
    watched("in the sun", &mut rig, &shot, cloud.particles());
}

/// Drivers that count the sets of a pool must have enough for every chunk.
#[test]
fn many_chunks_have_their_descriptor_sets() {
    let gpu = spied();
    let size = extent(48, 32);
    let config = config(size).with(|it| {
        it.max_stride = 1 << 16;
        it.max_particles = 1 << 16;
        it.motion = true;
    });
    let mut rig = Rig::new(&gpu, &config);
    let (shot, cloud) = (water(size), rig.particles(&water(size)));
    watched("many chunks", &mut rig, &shot, cloud.particles());
    let noisy = config.with(|it| it.noise = Some(0));
    let mut rig = Rig::new(&gpu, &noisy);
    let (shot, cloud) = (water(size), rig.particles(&water(size)));
    watched("many chunks of noise", &mut rig, &shot, cloud.particles());
}

/// Frames in a steady state destroy as many objects as they create.
#[test]
fn memory_is_steady() {
    let gpu = spied();
    let size = extent(16, 8);
    let mut rig = Rig::with_slots(&gpu, &config(size).with(|it| it.sheets = 2), 3);
    let shot = Shot::new(size, Lens::Standard, 0.3, &[[0.0, 0.0, 3.0], [0.4, 0.1, 4.0]]);
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let mut after_warm_up = None;
    let frames = if slow() { 10_000 } else { 300 };
    for i in 0..frames {
        let slot = i % 3;
        let frame = shot
            .frame(color.host_image(), depth.host_image(), cloud.particles())
            .with(|it| it.slot = Slot(slot));
        let cmd = rig.stub.begin(slot);
        rig.collect(Slot(slot));
        // SAFETY: cmd is recording, and the slot was waited for.
        unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
        rig.stub.end(slot);
        if i == 20 || i == frames - 1 {
            let now = (spy::live(), gpu.allocations().len(), rig.renderer().memory());
            let before = after_warm_up.get_or_insert_with(|| now.clone());
            assert_eq!(*before, now, "frame {i}");
        }
    }
    (0..3).for_each(|slot| rig.stub.wait(slot));
    assert!(gpu.expect_messages().is_empty());
}

/// Which calls of a function should fail: all in the slow tests, otherwise the first, a middle and
/// the last.
fn chosen(calls: u32) -> Vec<u32> {
    if slow() || calls <= 3 {
        return (1..=calls).collect();
    }
    vec![1, calls / 2, calls]
}

fn is_memory_error(error: &Error) -> bool {
    match error {
        Error::Vulkan { result, .. } => *result == vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
        Error::Allocation { .. } => true,
        _ => false,
    }
}

/// Whichever call of the construction fails, there is an error that names it, and no object
/// remains.
#[test]
fn a_failed_construction_leaves_nothing() {
    let gpu = spied();
    let size = extent(32, 16);
    let config = config(size).with(|it| it.depth_splat = Some(Splat::Raster));
    // SAFETY: the handles are live.
    let context = || unsafe { Context::new(&gpu.host(2)) };
    let make = || context().and_then(|context| Renderer::new(&context, &config));
    spy::reset();
    let renderer = make().unwrap_or_else(|error| panic!("{error}"));
    let calls: Vec<u32> = spy::MAKERS.iter().map(|f| f.calls()).collect();
    // SAFETY: nothing was recorded.
    unsafe { renderer.destroy() };
    assert_eq!(spy::live(), Vec::<String>::new());
    let mut wrong = Vec::new();
    for (function, calls) in spy::MAKERS.iter().zip(calls) {
        for k in chosen(calls) {
            spy::reset();
            spy::forget();
            // The allocator keeps memory blocks and only asks for more when it has none, so it is
            // replaced by an empty one.
            *gpu.allocator.lock().unwrap() = gpu.make_allocator(&gpu.functions);
            function.fail(k, vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
            let name = format!("{} call {k}", function.name.to_string_lossy());
            match make() {
                Err(error) if is_memory_error(&error) && !error.to_string().is_empty() => {}
                Err(error) => wrong.push(format!("{name}: {error}")),
                Ok(renderer) => {
                    // An allocator may try another memory type instead.
                    let made_up = function.name == c"vkAllocateMemory" && function.calls() > calls;
                    if !function.pending() && !made_up {
                        wrong.push(format!("{name}: no error"));
                    }
                    // SAFETY: nothing was recorded.
                    unsafe { renderer.destroy() };
                }
            }
            let (live, held) = (spy::live(), gpu.allocations());
            if !live.is_empty() || !held.is_empty() {
                wrong.push(format!("{name}: left {} allocations, {}", held.len(), live.join(", ")));
            }
            let fresh = gpu.make_allocator(&gpu.functions);
            let used = mem::replace(&mut *gpu.allocator.lock().unwrap(), fresh);
            // Leaked memory is reported once, and must not disturb the following checks.
            if !held.is_empty() {
                mem::forget(used);
            }
        }
    }
    let messages = gpu.expect_messages();
    assert!(messages.is_empty(), "{messages:?}");
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

/// Renderers of one context share its pipelines. A context lives until its last user is destroyed.
#[test]
fn objects_of_a_context_share_its_pipelines() {
    let gpu = spied();
    let config = config(extent(32, 16));
    let made = || spy::CREATE_COMPUTE_PIPELINES.calls() + spy::CREATE_GRAPHICS_PIPELINES.calls();
    let context = gpu.context(1);
    spy::reset();
    let first = Renderer::new(&context, &config).expect("a renderer");
    assert!(made() > 10, "{}", made());
    spy::reset();
    let other = context.with_frames_in_flight(3).expect("three");
    assert_eq!((context.frames_in_flight(), other.frames_in_flight()), (1, 3));
    let mut second = Renderer::new(&other, &config).expect("a renderer");
    assert_eq!(made(), 0, "the same pipelines");
    // Another configuration needs other pipelines, which are created once.
    let raster = config.with(|it| it.depth_splat = Some(Splat::Raster));
    second.reconfigure(&raster).expect("raster");
    assert!(made() > 0);
    spy::reset();
    second.reconfigure(&config).expect("compute");
    second.reconfigure(&raster).expect("raster");
    assert_eq!(made(), 0, "there and back");
    drop((context, other));
    // SAFETY: nothing was recorded.
    unsafe { first.destroy() };
    assert!(!spy::live().is_empty(), "the second still needs them");
    // SAFETY: as above.
    unsafe { second.destroy() };
    assert_eq!(spy::live(), Vec::<String>::new());

    // The context is dropped last.
    let context = gpu.context(1);
    let renderer = Renderer::new(&context, &config).expect("a renderer");
    // SAFETY: as above.
    unsafe { renderer.destroy() };
    assert!(!spy::live().is_empty(), "for the next");
    drop(context);
    assert_eq!(spy::live(), Vec::<String>::new());
}

/// A renderer that is dropped without `destroy` may still be in use by the GPU, so its context
/// stays.
#[test]
fn a_renderer_that_is_only_dropped_keeps_its_context() {
    let mut gpu = spied();
    gpu.leaks = true;
    let context = gpu.context(1);
    let renderer = Renderer::new(&context, &config(extent(32, 16))).expect("a renderer");
    spy::reset();
    drop((context, renderer));
    let pipelines = spy::live().into_iter().find(|what| what.ends_with(" of pipelines"));
    assert!(pipelines.is_some(), "{:?}", spy::live());
}

/// Draws at one size, lets the `k`-th call of a function fail during a change, and returns what is
/// wrong afterwards. Returns None if the change makes fewer calls.
fn failed_change(
    gpu: &Gpu,
    config: &Config,
    function: &spy::Function,
    k: u32,
    change: impl Fn(&mut whitewater::Renderer) -> Result<(), Error>,
    recovers: impl Fn(&mut whitewater::Renderer) -> Result<(), Error>,
) -> Option<String> {
    let shot = water(config.extent);
    // A shared context has the change's pipelines already, so that none would be created.
    if std::ptr::eq(function, &spy::CREATE_COMPUTE_PIPELINES) {
        gpu.drop_context();
    }
    let before = spy::live();
    let mut wrong = Vec::new();
    {
        let mut rig = Rig::new(gpu, config);
        // Compared bit for bit. Thickness is left out, because float sums depend on the order.
        let expected = rig.draw(&shot);
        spy::reset();
        function.fail(k, vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
        let result = change(rig.renderer());
        let pending = function.pending();
        spy::reset();
        match result {
            Ok(()) if pending => return None,
            Ok(()) => wrong.push("no error".into()),
            Err(error) if !is_memory_error(&error) => wrong.push(error.to_string()),
            Err(_) => {}
        }
        match recovers(rig.renderer()) {
            Ok(()) => {
                let found = rig.draw(&shot);
                if found.surface != expected.surface || found.plan != expected.plan {
                    wrong.push("another picture afterwards".into());
                }
            }
            Err(error) => wrong.push(format!("no way back: {error}")),
        }
    }
    let live = spy::live();
    if live != before {
        wrong.push(format!("left: {}", live.join(", ")));
    }
    let messages = gpu.expect_messages();
    wrong.extend(messages.first().map(|m| m.chars().take(160).collect()));
    (!wrong.is_empty()).then(|| wrong.join("; ")).or(Some(String::new()))
}

const CHANGED: [&spy::Function; 6] = [
    &spy::CREATE_IMAGE,
    &spy::CREATE_IMAGE_VIEW,
    &spy::CREATE_BUFFER,
    &spy::CREATE_FRAMEBUFFER,
    &spy::BIND_IMAGE_MEMORY,
    &spy::CREATE_COMPUTE_PIPELINES,
];

/// After a failed resize, frames are refused before any command until another resize succeeds.
#[test]
fn a_failed_resize_is_made_good_by_another() {
    let gpu = spied();
    let (old, new) = (extent(48, 32), extent(96, 64));
    let (mut tried, mut wrong) = (0, Vec::new());
    for splat in [Splat::Raster, Splat::Compute] {
        let config = config(old).with(|it| {
            it.depth_splat = Some(splat);
            it.thickness_splat = Some(splat);
        });
        gpu.share_context();
        Rig::new(&gpu, &config).resize(new);
        for function in CHANGED {
            // All calls in the slow tests, otherwise some.
            for k in (1..=20).filter(|k| slow() || [1, 2, 4, 8, 16].contains(k)) {
                let found = failed_change(
                    &gpu,
                    &config,
                    function,
                    k,
                    |renderer| renderer.resize(new),
                    |renderer| renderer.resize(old),
                );
                match found {
                    None => break,
                    Some(what) if what.is_empty() => tried += 1,
                    Some(what) => {
                        let name = function.name.to_string_lossy();
                        wrong.push(format!("{splat:?}, {name} call {k}: {what}"));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
    assert!(tried >= 26, "{tried} failures");
}

#[test]
fn frames_are_refused_after_a_failed_resize() {
    let gpu = spied();
    let size = extent(48, 32);
    let mut rig = Rig::new(&gpu, &config(size));
    let shot = water(size);
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    spy::reset();
    spy::CREATE_IMAGE.fail(3, vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
    assert!(rig.renderer().resize(extent(96, 64)).is_err());
    let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    let cmd = rig.stub.begin(0);
    spy::reset();
    // SAFETY: cmd is recording.
    let result = unsafe { rig.renderer().record(cmd, &frame) };
    let commands: u32 = spy::COMMANDS.iter().map(|f| f.calls()).sum();
    rig.stub.end(0);
    rig.stub.wait(0);
    assert!(matches!(result, Err(Error::BadInput { .. })) && commands == 0, "{commands} commands");
}

/// A failed reconfigure leaves the renderer as it was.
#[test]
fn a_failed_reconfigure_changes_nothing() {
    let gpu = spied();
    let old = config(extent(48, 32));
    let new = config(extent(96, 64)).with(|it| {
        it.smoothing_level = 0;
        it.environment_size = 32;
    });
    gpu.share_context();
    for config in [&old, &new] {
        drop(Rig::new(&gpu, config));
    }
    let (mut tried, mut wrong) = (0, Vec::new());
    for function in CHANGED {
        for k in [1, 2, 3, 5, 8, 13].into_iter().filter(|k| slow() || [1, 3, 8].contains(k)) {
            let found = failed_change(
                &gpu,
                &old,
                function,
                k,
                |renderer| renderer.reconfigure(&new).map(|_| ()),
                |renderer| {
                    assert_eq!(*renderer.config(), old, "the configuration is kept");
                    Ok(())
                },
            );
            match found {
                None => break,
                Some(what) if what.is_empty() => tried += 1,
                Some(what) => {
                    wrong.push(format!("{} call {k}: {what}", function.name.to_string_lossy()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
    assert!(tried >= 13, "{tried} failures");
}

/// Whichever call of a record fails, there is an error, and after `abandon` the slot can be used
/// again.
#[test]
fn a_failed_record_can_be_repeated() {
    let gpu = spied();
    let size = extent(48, 32);
    let mut rig = Rig::new(&gpu, &config(size));
    let shot = water(size);
    let expected = rig.draw(&shot);
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    for (function, calls) in [
        (&spy::CREATE_FRAMEBUFFER, vec![1]),
        (&spy::RESET_DESCRIPTOR_POOL, vec![1]),
        (&spy::ALLOCATE_SETS, vec![1, 2, 5, 8]),
    ] {
        for k in calls {
            let cmd = rig.stub.begin(0);
            spy::reset();
            function.fail(k, vk::Result::ERROR_DEVICE_LOST);
            // SAFETY: cmd is recording, and the slot was waited for.
            let result = unsafe { rig.renderer().record(cmd, &frame) };
            spy::reset();
            match result {
                Err(error) => assert!(error.is_device_lost(), "{error}"),
                Ok(_) => panic!("{:?} call {k}: no error", function.name),
            }
            // The commands are discarded, because `begin` resets the command buffer.
            rig.abandon(Slot(0));
        }
    }
    let cmd = rig.stub.begin(0);
    // SAFETY: as above.
    unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    rig.stub.end(0);
    rig.stub.wait(0);
    let found = rig.read(&color.host_image(), &Recorded::default());
    compare::same_color("after-failed-record", &found.output, &expected.output);
}

/// The headless renderer reports a lost device from submit and from wait.
#[test]
fn headless_reports_a_lost_device() {
    let mut gpu = Gpu::own();
    let functions = spy::functions(&gpu);
    let mut device = gpu.take_device();
    device.device = functions;
    let size = extent(32, 16);
    let mut headless = Headless::new(device, &config(size)).expect("headless");
    let shot = water(size);
    headless.particles(&shot.positions, None).expect("particles");
    for function in [&spy::QUEUE_SUBMIT, &spy::WAIT_FOR_FENCES] {
        spy::reset();
        function.fail(1, vk::Result::ERROR_DEVICE_LOST);
        let background = Background::Color([0.1, 0.2, 0.3]);
        match headless.render(&shot.camera, &shot.settings, &background) {
            Err(error) => assert!(error.is_device_lost(), "{error}"),
            Ok(()) => panic!("{:?}: no error", function.name),
        }
        // If only the wait failed, the work was submitted and must end before the device is
        // destroyed.
        // SAFETY: the device is live.
        unsafe { headless.device().device.device_wait_idle() }.expect("idle");
    }
    spy::reset();
    drop(headless.finish());
}
