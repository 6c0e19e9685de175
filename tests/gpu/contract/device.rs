//! Checks missing features and limits of a device, memory use and timed passes against the
//! documentation.

use ash::vk;
use whitewater::bubbles::{BubbleConfig, BubbleSort};
use whitewater::headless::Whitewater;
use whitewater::shore::ShoreConfig;
use whitewater::water::{Gate, Kernels, Shading, Smoothing};
use whitewater::{
    Config, Context, DeviceSupport, EnabledFeatures, Error, Renderer, Shore, Shoreline, Slot,
    SurfaceFoamState, SurfaceFoamStateConfig, WhitewaterConfig, WhitewaterSplat,
};

use crate::support::device::Gpu;
use crate::support::rig::{Rig, config, extent};
use crate::support::scenes::Lens;
use crate::support::{compare, slow};

use super::life::convolved;
use super::{sunny, water};

/// Engines share these objects between threads, or create them on other threads.
const _: () = {
    const fn shared<T: Send + Sync>() {}
    shared::<Context>();
    shared::<Renderer>();
    shared::<SurfaceFoamState>();
    shared::<whitewater::Generator>();
    shared::<whitewater::bubbles::BlobSimulation>();
    shared::<whitewater::shore::ShoreMap>();
    shared::<whitewater::Frame<'static>>();
    shared::<Error>();
};

#[test]
fn a_device_with_nothing_optional_draws_the_same() {
    let size = extent(64, 48);
    let shot = water(size, Lens::Standard);
    let expected = {
        let gpu = Gpu::shared();
        Rig::new(&gpu, &config(size)).draw(&shot)
    };
    let options = whitewater::headless::DeviceOptions { bare: true, ..Default::default() };
    let mut gpu = Gpu::own_with(&options);
    gpu.leaks = false;
    let found = Rig::new(&gpu, &config(size)).draw(&shot);
    compare::same_color("bare", &found.output, &expected.output);
}

/// An old driver: instance and device of Vulkan 1.2, with the barriers of Vulkan 1.0. The picture
/// is the same bit for bit, and validation reports nothing.
#[test]
fn a_device_of_vulkan_1_2_draws_the_same() {
    let size = extent(64, 48);
    let options = whitewater::headless::DeviceOptions { vulkan_1_2: true, ..Default::default() };
    let mut old = Gpu::own_with(&options);
    old.leaks = false;
    old.share_context();
    assert!(!old.enabled.synchronization2);
    let plain = config(size).with(|it| it.sheets = 2);
    for config in [
        plain,
        plain.with(|it| {
            it.smoothing = Some(Smoothing::Fused);
            it.surface_foam = true;
            it.spray = true;
            it.motion = true;
            it.noise = Some(1);
        }),
        plain.with(|it| {
            it.light_map_size = Some(64);
            it.shadow = convolved(8, 8);
            it.composite = Some(Shading::Compute);
            it.depth_splat = Some(whitewater::water::Splat::Raster);
        }),
        plain.with(|it| it.smoothing = Some(Smoothing::Query(Gate::VertexCull))),
    ] {
        let [expected, found] = [&Gpu::shared(), &old].map(|gpu| {
            let mut rig = Rig::new(gpu, &config);
            let mut shot = water(size, Lens::Standard);
            let _map = sunny(&rig, &mut shot);
            rig.draw(&shot)
        });
        compare::same_color("vulkan-1.2", &found.output, &expected.output);
    }
}

/// Below Vulkan 1.3, passes that store to images without a format report that they need the
/// feature; plain water does not need it.
#[test]
fn an_old_device_says_what_it_lacks() {
    let options =
        whitewater::headless::DeviceOptions { vulkan_1_2: true, bare: true, ..Default::default() };
    let gpu = Gpu::own_with(&options);
    let host = gpu.host(1).with(|it| it.enabled = EnabledFeatures::default());
    // SAFETY: the handles are live, and the device is destroyed last.
    let context = unsafe { Context::new(&host) }.expect("a context");
    let config = config(extent(16, 16));
    let lacks = |config: Config| match Renderer::new(&context, &config) {
        Err(Error::Missing { what, .. }) => what,
        other => panic!("{:?}", other.map(|_| ())),
    };
    assert!(lacks(config.with(|it| it.surface_foam = true)).contains("storage"));
    assert!(lacks(config.with(|it| it.motion = true)).contains("storage"));
    let atomics = WhitewaterConfig::new(16).with(|it| it.splat = Some(WhitewaterSplat::Compute64));
    assert!(lacks(config.with(|it| it.whitewater = Some(atomics))).contains("Int64"));
    assert!(lacks(config.with(|it| it.composite = Some(Shading::Compute))).contains("storage"));
    let renderer = Renderer::new(&context, &config).expect("water");
    // SAFETY: nothing was submitted.
    unsafe { renderer.destroy() };
}

/// Changes what the device reports, to test errors for features that this device does have.
#[test]
fn what_a_device_lacks_is_named() {
    let gpu = Gpu::shared();
    let config = config(extent(32, 16));
    let offer = whitewater::DeviceSupport::of(&gpu.instance, gpu.physical, config.output_format);
    offer.check(&config).expect("this device will do");
    let raster = config.with(|it| it.depth_splat = Some(whitewater::water::Splat::Raster));
    let foam = config.with(|it| it.surface_foam = true);
    let convolving = |bits| config.with(|it| it.shadow = convolved(8, bits));
    let motion = config.with(|it| it.motion = true);
    let noise = config.with(|it| it.noise = Some(1));
    let unsummed = offer.with(|it| {
        it.blend_floats = false;
        it.foam_floats = false;
    });
    let bare = offer.with(|it| it.optional = EnabledFeatures::default());
    let gate = |gate| config.with(|it| it.smoothing = Some(Smoothing::Query(gate)));
    let drawn = config.with(|it| it.composite = Some(Shading::Raster));
    let stored = config.with(|it| it.composite = Some(Shading::Compute));
    let lacking = [
        (offer.with(|it| it.api_version = vk::API_VERSION_1_1), config, "Vulkan 1.2"),
        (offer.with(|it| it.output_attachment = false), drawn, "attachment use of the output"),
        (offer.with(|it| it.output_storage = false), stored, "storage use of the output"),
        (offer.with(|it| it.blend_floats = false), raster, "R32_SFLOAT"),
        (offer.with(|it| it.foam_floats = false), foam, "R32G32_SFLOAT"),
        (offer.with(|it| it.basis = [false, true]), convolving(8), "R8G8B8A8_SNORM"),
        (offer.with(|it| it.basis = [true, false]), convolving(16), "R16G16B16A16_SFLOAT"),
        (offer.with(|it| it.motion_floats = false), motion, "R32G32_SFLOAT"),
        (unsummed, noise, "R32_SFLOAT"),
        (bare, gate(Gate::DrawCount), "drawIndirectCount"),
        (bare, gate(Gate::Predicate), "VK_EXT_conditional_rendering"),
    ];
    for (offer, config, needle) in lacking {
        match offer.check(&config) {
            Err(Error::Missing { what, why }) => {
                assert!(what.contains(needle) && !why.is_empty(), "{what}: {why}");
            }
            other => panic!("{needle}: {other:?}"),
        }
    }
    let unblended = offer.with(|it| it.blend_floats = false);
    unblended.check(&config).expect("the compute paths need no blending");
    let unfoamed = offer.with(|it| it.foam_floats = false);
    unfoamed.check(&raster).expect("water needs nothing of foam's");
    let other = offer.with(|it| it.basis = [true, false]);
    other.check(&convolving(8)).expect("eight bits are there");
    let mut small = offer;
    small.limits.max_image_dimension2_d = 99;
    let shown = convolving(8).with(|it| it.extent = extent(32, 16));
    assert!(matches!(small.check(&shown), Err(Error::BadInput { field: "Config.shadow", .. })));
    unfoamed.check(&noise).expect("what the raster splats blend is enough for noise");
    // A chunk of surface foam holds at least 64 particles.
    let mut narrow = offer;
    narrow.limits.max_storage_buffer_range = (1 << 20) + 256;
    let wide = |foam| {
        config.with(|it| {
            it.surface_foam = foam;
            it.max_stride = 1 << 16;
        })
    };
    narrow.check(&wide(false)).expect("sixteen particles are bound at once");
    assert!(matches!(narrow.check(&wide(true)), Err(Error::BadInput { .. })));
    let unattached = offer.with(|it| it.output_attachment = false);
    unattached.check(&stored).expect("nothing is drawn into the output");
    let unstored = offer.with(|it| it.output_storage = false);
    unstored.check(&drawn).expect("nothing is stored to the output");
}

/// If the host's instance has an older Vulkan version, newer functions are missing although the
/// driver has them. ash replaces a missing function by one that panics, so `Context::new` must
/// report an error.
#[test]
fn an_instance_of_an_older_vulkan_is_an_error() {
    // SAFETY: the library outlives all objects made here, which are destroyed before its end;
    // nothing is submitted.
    unsafe {
        let entry = ash::Entry::load().expect("a loader");
        let of_1_3 = Gpu::own();
        for version in [vk::API_VERSION_1_0, vk::API_VERSION_1_1, vk::API_VERSION_1_2] {
            let enough = version == vk::API_VERSION_1_2;
            let application = vk::ApplicationInfo::default().api_version(version);
            let info = vk::InstanceCreateInfo::default().application_info(&application);
            let instance = entry.create_instance(&info, None).expect("an instance");
            let all = instance.enumerate_physical_devices().expect("devices");
            let named = |physical: &vk::PhysicalDevice| {
                instance.get_physical_device_properties(*physical).device_id
            };
            let own = of_1_3.instance.get_physical_device_properties(of_1_3.physical).device_id;
            let physical = all.into_iter().find(|p| named(p) == own).expect("the same");
            let priorities = [1.0];
            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(of_1_3.queue_family)
                .queue_priorities(&priorities)];
            let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
            let device = instance.create_device(physical, &info, None).expect("a device");
            // The error is also reported if the host claims features that the device does not have.
            for enabled in [EnabledFeatures::default(), of_1_3.enabled] {
                let host = of_1_3.host(1).with(|it| {
                    it.instance = &instance;
                    it.physical_device = physical;
                    it.device = &device;
                    it.enabled = enabled;
                });
                // Some drivers load the functions of their own version, whatever the instance's
                // version is.
                let has = |name: &std::ffi::CStr| {
                    instance.get_device_proc_addr(device.handle(), name.as_ptr()).is_some()
                };
                let second = (has(c"vkCmdPipelineBarrier2") || !enabled.synchronization2)
                    && (has(c"vkCmdBeginConditionalRenderingEXT")
                        || !enabled.conditional_rendering);
                let all = second && (enough || has(c"vkResetQueryPool"));
                match Context::new(&host) {
                    Ok(_) if all => {}
                    Err(Error::Missing { what, why }) if !(enough && second) => {
                        assert!(what.contains("vk") && why.contains("1.2"), "{what}: {why}");
                    }
                    other => panic!("{version:x}: {:?}", other.map(|_| ())),
                }
            }
            device.destroy_device(None);
            instance.destroy_instance(None);
        }
    }
}

/// Function tables in which one function is missing.
#[test]
fn functions_that_are_not_loaded_are_named() {
    let gpu = Gpu::shared();
    let device = &gpu.device;
    let (v1_2, v1_3) = (device.fp_v1_2(), device.fp_v1_3());
    let none_1_2 = ash::DeviceFnV1_2::load(|_| std::ptr::null());
    let none_1_3 = ash::DeviceFnV1_3::load(|_| std::ptr::null());
    let of = |v1_2, v1_3| {
        let (v1_0, v1_1) = (device.fp_v1_0().clone(), device.fp_v1_1().clone());
        ash::Device::from_parts_1_3(device.handle(), v1_0, v1_1, v1_2, v1_3)
    };
    let (barrier, stamp) = (none_1_3.cmd_pipeline_barrier2, none_1_3.cmd_write_timestamp2);
    let count = none_1_2.cmd_draw_indirect_count;
    let counted = gpu.enabled.with(|it| it.draw_indirect_count = true);
    for (functions, enabled, name) in [
        (
            of(v1_2.clone(), ash::DeviceFnV1_3 { cmd_pipeline_barrier2: barrier, ..v1_3.clone() }),
            gpu.enabled,
            "vkCmdPipelineBarrier2",
        ),
        (
            of(v1_2.clone(), ash::DeviceFnV1_3 { cmd_write_timestamp2: stamp, ..v1_3.clone() }),
            gpu.enabled,
            "vkCmdWriteTimestamp2",
        ),
        (
            of(ash::DeviceFnV1_2 { cmd_draw_indirect_count: count, ..v1_2.clone() }, v1_3.clone()),
            counted,
            "vkCmdDrawIndirectCount",
        ),
        (of(none_1_2, v1_3.clone()), gpu.enabled, "vkResetQueryPool"),
    ] {
        let host = gpu.host(1).with(|it| {
            it.device = &functions;
            it.enabled = enabled;
        });
        // SAFETY: the handles are live, and nothing is created.
        match unsafe { Context::new(&host) } {
            Err(Error::Missing { what, .. }) => assert!(what.contains(name), "{name}: {what}"),
            other => panic!("{name}: {:?}", other.map(|_| ())),
        }
    }
}

/// The documentation promises 32 bytes of device memory per particle besides the input.
#[test]
fn ten_million_particles_have_room() {
    let gpu = Gpu::shared();
    let count = 10_000_000;
    let config = config(extent(64, 48)).with(|it| it.max_particles = count);
    let foam = config.with(|it| it.surface_foam = true);
    // SAFETY: the handles are live, and nothing is recorded.
    let state = unsafe {
        Renderer::new(&gpu.context(1), &foam).expect("room for foam").destroy();
        let state = SurfaceFoamState::new(&gpu.context(1), &SurfaceFoamStateConfig::new(count))
            .expect("room for its phases");
        let memory = state.memory();
        state.destroy();
        memory
    };
    let documented = 68 * u64::from(count);
    assert!(state.abs_diff(documented) < documented / 1000, "{state} bytes of phases");
    let renderer = whitewater::Renderer::new(&gpu.context(1), &config).expect("room");
    let memory = renderer.memory();
    // SAFETY: nothing was recorded.
    unsafe { renderer.destroy() };
    let documented = 32 * u64::from(count);
    assert!(memory.buffers > documented, "{memory:?} holds no spheres");
    // Chunks are rounded up to 64 particles; other buffers take less than a thousandth.
    let most = documented + documented / 1000;
    assert!(memory.buffers < most, "{memory:?}");
}

/// Bytes per pixel and per particle as in the memory table of the crate's documentation. A driver
/// pads and aligns images; the tolerance is a hundredth more than the device reports for single
/// images, and some KiB per object.
#[test]
fn memory_is_as_documented() {
    let gpu = Gpu::shared();
    let needed = |width: u32, height: u32, count: u32, (sheets, coarsening, foam, spray)| {
        let format = vk::Format::R16G16B16A16_SFLOAT;
        let size = extent(width, height);
        let config = Config::new(size, format, count).with(|it| {
            it.sheets = sheets;
            it.coarsening = coarsening;
            it.surface_foam = foam;
            it.spray = spray;
        });
        let renderer = Renderer::new(&gpu.context(1), &config).expect("a renderer");
        let memory = renderer.memory();
        // SAFETY: nothing was recorded.
        unsafe { renderer.destroy() };
        (memory.images + memory.buffers) as f64
    };
    for (width, height, count) in [(1280, 720, 65_536), (1920, 1080, 1 << 20)] {
        // A renderer takes a second or two to compile. The normal test checks a few configurations
        // of the larger size and every second of the smaller; the slow test checks all.
        let whole = slow() || width == 1280;
        let step = if slow() { 1 } else { 2 };
        let (pixels, n) = (f64::from(width * height), f64::from(count));
        let spare = 0.01 + gpu.padding(extent(width, height));
        let cube = 6.0 * 8.0 * 4.0 / 3.0 * 256.0 * 256.0;
        // The light maps; the lit scene replaces the copied scene and has half precision too. With
        // foam each texel has one more sum.
        let ways = [(None, false), (Some(256), false), (Some(256), true), (Some(1024), false)];
        for (cast, foam) in ways.into_iter().step_by(step).filter(|_| whole) {
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let config = Config::new(extent(width, height), format, count).with(|it| {
                it.light_map_size = cast;
                it.surface_foam = foam;
            });
            let renderer = Renderer::new(&gpu.context(1), &config).expect("a renderer");
            let memory = renderer.memory();
            // SAFETY: nothing was recorded.
            unsafe { renderer.destroy() };
            let maps = cast.map_or(0.0, |n| 36.0 * f64::from(n * n));
            let found = (memory.images + memory.buffers) as f64;
            let lit = if cast.is_some() && foam { 0.25 * pixels } else { 0.0 };
            let said = needed(width, height, count, (2, 3, foam, false)) + maps + lit;
            let off = (found - said).abs();
            assert!(off < spare * said + 512.0 * 1024.0, "{cast:?}, {foam}: {found}, said {said}");
        }
        // Motion has a vector per pixel, and per thickness texel of 16 pixels 64 bytes of sums and
        // two depths.
        for (thickness_level, said) in [(0, 48.0), (1, 26.0), (2, 12.5), (3, 9.125)]
            .into_iter()
            .step_by(step)
            .filter(|_| whole)
        {
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let of = |motion| {
                let size = extent(width, height);
                let config = Config::new(size, format, count).with(|it| {
                    it.motion = motion;
                    it.thickness_level = thickness_level;
                });
                let renderer = Renderer::new(&gpu.context(1), &config).expect("a renderer");
                let memory = renderer.memory();
                // SAFETY: nothing was recorded.
                unsafe { renderer.destroy() };
                (memory.images + memory.buffers) as f64
            };
            let found = of(true) - of(false);
            let off = (found - said * pixels).abs();
            assert!(off < spare * said * pixels + 512.0 * 1024.0, "{thickness_level}: {found}");
        }
        // Bubble foam has depth, colour and layers per pixel and lists per tile; then the blobs,
        // the film's table and an image of the core.
        for (sort, layers, each) in [
            (BubbleSort::Tiles, 3, 14.5 + 16.0),
            (BubbleSort::Tiles, 1, 14.5 + 8.0),
            (BubbleSort::Peel, 3, 14.5 + 16.0 + 22.0),
        ]
        .into_iter()
        .step_by(step)
        .filter(|_| whole)
        {
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let templates = BubbleConfig::new(count).with(|it| {
                it.variants = 1;
                it.bubbles = 8;
                it.map_size = 8;
            });
            let bubbles = Some(templates.with(|it| {
                it.sort = sort;
                it.layers = layers;
            }));
            let config =
                Config::new(extent(width, height), format, count).with(|it| it.bubbles = bubbles);
            let renderer = Renderer::new(&gpu.context(1), &config).expect("a renderer");
            let memory = renderer.memory();
            // SAFETY: nothing was recorded.
            unsafe { renderer.destroy() };
            let found = (memory.images + memory.buffers) as f64;
            let more = found - needed(width, height, count, (2, 3, false, false));
            let said = each * pixels + 64.0 * n + 64.0 * 256.0 * 8.0 + 258.0 * 258.0 * 8.0;
            assert!(
                (more - said).abs() < spare * said + 64.0 * 1024.0,
                "{sort:?}, {layers}: {more}, said {said}"
            );
        }
        // Ellipsoids have a grid, shapes and lists.
        if whole {
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let config = Config::new(extent(width, height), format, count)
                .with(|it| it.kernels = Kernels::Ellipsoids);
            let renderer = Renderer::new(&gpu.context(1), &config).expect("a renderer");
            let memory = renderer.memory();
            // SAFETY: nothing was recorded.
            unsafe { renderer.destroy() };
            let found = (memory.images + memory.buffers) as f64;
            let more = found - needed(width, height, count, (2, 3, false, false));
            let slack = spare * 112.0 * n + 512.0 * 1024.0;
            let said = 108.0 * n - slack..112.0 * n + slack;
            assert!(said.contains(&more), "ellipsoids: {more}, said {said:?}");
        }
        // Noise has one number per texel of its level, and sprites.
        for level in (0..4).step_by(step).filter(|_| whole) {
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let config =
                Config::new(extent(width, height), format, count).with(|it| it.noise = Some(level));
            let renderer = Renderer::new(&gpu.context(1), &config).expect("a renderer");
            let memory = renderer.memory();
            // SAFETY: nothing was recorded.
            unsafe { renderer.destroy() };
            let texels = f64::from(width.div_ceil(1 << level) * height.div_ceil(1 << level));
            let found = (memory.images + memory.buffers) as f64;
            let plain = needed(width, height, count, (2, 3, false, false));
            let (more, said) = (found - plain, 4.0 * texels + 16.0 * n);
            assert!(
                (more - said).abs() < spare * said + 64.0 * 1024.0,
                "{level}: {more}, said {said}"
            );
        }
        // With two sheets, a texel of 16 pixels has 16 more bytes of thickness, 16 of sums and a
        // boundary, and a cell of 64 pixels 17 numbers. The smoothing has two numbers and a plan
        // for a quarter of the pixels, 3 bytes; coarser levels add half as much, and the back sheet
        // three quarters. With foam, a texel has 4 bytes of depth, 16 of thickness, 4 of the water
        // before it with a sum of 8, and three sums and two depths that share memory with others.
        for (sheets, coarsening, foam, spray, smoothing, more) in [
            (1, 3, false, false, 4.5, 0.0),
            (1, 0, false, false, 3.0, 0.0),
            (2, 3, false, false, 5.25, 3.3125),
            (2, 0, false, false, 4.5, 3.3125),
            (1, 3, true, false, 4.5, 3.25),
            (2, 3, true, false, 5.25, 6.5625),
            (1, 3, false, true, 4.5, 8.0),
            (2, 3, true, true, 5.25, 14.5625),
        ]
        .into_iter()
        .step_by(if whole { step } else { 7 })
        {
            let each = 32.0 + if foam { 68.0 } else { 0.0 } + if spray { 48.0 } else { 0.0 };
            let each = each + if foam || spray { 0.125 } else { 0.0 };
            let said = pixels * (4.0 + smoothing + 0.5 + 0.25 + 8.0 + more) + each * n + cube;
            let found = needed(width, height, count, (sheets, coarsening, foam, spray));
            let off = (found - said).abs();
            let name = format!("{width}x{height}, {sheets} sheets, foam {foam}, spray {spray}");
            // A driver may keep a border around each face of the cube map: two texels more along
            // each axis, at all mip levels.
            let border: f64 = (0..9).map(|mip| 48.0 * 4.0 * f64::from((256 >> mip) + 1)).sum();
            let most = spare * said + 512.0 * 1024.0 + border;
            assert!(off < most, "{name}: {found}, said {said}");
        }
    }
}

/// Every pass has a timer scope. Start times never decrease and durations are not negative; their
/// values do not matter.
#[test]
fn timings_name_every_pass() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let config = config(size).with(|it| {
        it.sheets = 2;
        it.surface_foam = true;
        it.spray = true;
        it.motion = true;
        it.noise = Some(1);
    });
    let mut rig = Rig::with_slots(&gpu, &config, 2);
    let mut shot = water(size, Lens::Standard);
    assert!(rig.renderer().timings(Slot(0)).is_empty(), "before the first frame");
    assert!(rig.renderer().timings(Slot(9)).is_empty(), "no such slot");
    for _ in 0..3 {
        rig.draw(&shot);
        let timings = rig.renderer().timings(Slot(0)).to_vec();
        let names: Vec<&str> = timings.iter().map(|t| t.name).collect();
        let wanted = [
            "cull",
            "front",
            "depth",
            "surface_foam",
            "spray",
            "gaps",
            "thickness",
            "reduce",
            "level",
            "back",
            "tiles",
            "smooth",
            "split",
            "motion",
            "noise",
            "scene",
            "composite",
        ];
        assert_eq!(names, wanted);
        for t in &timings {
            assert!(t.start >= 0.0 && t.nanoseconds >= 0.0 && t.nanoseconds < 6e10, "{t:?}");
        }
        let falls = timings.windows(2).any(|w| w[1].start < w[0].start);
        assert!(!falls, "{timings:?}");
    }
    assert!(rig.renderer().timings(Slot(1)).is_empty(), "a slot without a frame");
    // A frame that is recorded and not yet executed does not take the times of the one before for its own.
    let before = rig.renderer().timings(Slot(0)).to_vec();
    let fewer = config.with(|it| it.spray = false);
    rig.renderer().reconfigure(&fewer).expect("reconfigure");
    rig.config = fewer;
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    let cmd = rig.stub.begin(0);
    // SAFETY: cmd is recording, the slot was waited for, and the handles live until it is waited for again.
    unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    assert_eq!(rig.renderer().timings(Slot(0)), before, "it has not begun");
    rig.stub.end(0);
    rig.stub.wait(0);
    let names: Vec<&str> = rig.renderer().timings(Slot(0)).iter().map(|t| t.name).collect();
    assert!(names.len() + 1 == before.len() && !names.contains(&"spray"), "{names:?}");
    let mut rig = Rig::new(&gpu, &config.with(|it| it.light_map_size = Some(16)));
    sunny(&rig, &mut shot);
    rig.draw(&shot);
    let names: Vec<&str> = rig.renderer().timings(Slot(0)).iter().map(|t| t.name).collect();
    let at = |name| names.iter().position(|n| *n == name);
    let (light, caustics, lit) = (at("light"), at("caustics"), at("lit"));
    assert!(light.is_some() && light < caustics && caustics < lit, "{names:?}");
    assert!(lit < at("composite"), "{names:?}");
}

/// The passes of parts that [`timings_name_every_pass`] leaves out have timer scopes, too, in the
/// order of their commands.
#[test]
fn timings_name_the_passes_of_other_parts() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let bubbles = BubbleConfig::new(64).with(|it| {
        it.variants = 2;
        it.bubbles = 16;
        it.map_size = 32;
    });
    let plain = config(size);
    let sun = plain.with(|it| it.light_map_size = Some(16));
    let foam = |config: Config| config.with(|it| it.whitewater = Some(WhitewaterConfig::new(1024)));
    let cases: [(Config, &[&str]); 6] = [
        (foam(sun), &["whitewater_light", "splat", "radiance", "blur"]),
        (sun.with(|it| it.bubbles = Some(bubbles)), &["blobs", "cast", "peel", "soap"]),
        (
            foam(plain.with(|it| it.bubbles = Some(bubbles.with(|it| it.crossfade = true)))),
            &["near", "blobs", "splat", "peel", "radiance", "blur", "soap"],
        ),
        (
            plain.with(|it| it.shore = Some(ShoreConfig::default())),
            &["shore-tiles", "shoreline", "contact"],
        ),
        (plain.with(|it| it.shadow = convolved(4, 8)), &["convolution"]),
        (plain.with(|it| it.kernels = Kernels::Ellipsoids), &["shape"]),
    ];
    for (config, wanted) in cases {
        let mut rig = Rig::new(&gpu, &config);
        let mut shot = water(size, Lens::Standard);
        let _shade = sunny(&rig, &mut shot);
        // Contact foam on the particles' water is off by default.
        shot.settings.shore.contact.particle_opacity = 1.0;
        shot.shore = config.shore.map(|_| Shore::new(0.0).with_shoreline(Shoreline::Screen));
        let cloud = rig.particles(&shot);
        let points =
            rig.whitewater(&Whitewater { positions: &shot.positions, ..Default::default() });
        let whitewater = config.whitewater.map(|_| points.particles());
        rig.draw_whitewater(&shot, &cloud.particles(), whitewater);
        let names: Vec<_> = rig.renderer().timings(Slot(0)).iter().map(|t| t.name).collect();
        // The passes of water and of the sun's light are those of the test above.
        let others = [
            "cull",
            "front",
            "depth",
            "thickness",
            "reduce",
            "level",
            "tiles",
            "smooth",
            "split",
            "scene",
            "light",
            "caustics",
            "lit",
            "composite",
        ];
        let own: Vec<_> = names.iter().copied().filter(|name| !others.contains(name)).collect();
        assert_eq!(own, wanted, "of {names:?}");
    }
}

/// If a Vulkan 1.2 host does not plan to enable a needed feature, the check names it before the
/// host creates the device.
#[test]
fn what_a_selection_of_features_lacks_is_named() {
    let gpu = Gpu::shared();
    let config = config(extent(64, 64)).with(|it| it.surface_foam = true);
    let support = DeviceSupport::of(&gpu.instance, gpu.physical, config.output_format);
    let none = EnabledFeatures::default();
    let stores = none.with(|it| it.storage_image_write_without_format = true);
    support.with_enabled(vk::API_VERSION_1_3, none).check(&config).expect("of 1.3");
    if !support.optional.storage_image_write_without_format {
        return crate::support::skipped::skipped("no shaderStorageImageWriteWithoutFormat");
    }
    support.with_enabled(vk::API_VERSION_1_2, stores).check(&config).expect("it is enabled");
    let bare = support.with_enabled(vk::API_VERSION_1_2, none);
    let error = bare.check(&config).expect_err("it is not enabled").to_string();
    assert!(error.contains("enable shaderStorageImageWriteWithoutFormat"), "{error}");
}
