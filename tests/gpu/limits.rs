//! Tests on a device that claims stricter limits than it has: offset alignment, length of a
//! binding, descriptors per stage, and timestamps with few bits.

use ash::vk;
use whitewater::bubbles::{BlobSimulation, BlobSimulationConfig, BubbleConfig, DistanceField};
use whitewater::shore::ShoreConfig;
use whitewater::water::{Gate, Shading, Smoothing, Splat};
use whitewater::{
    Config, Count, Error, Packets, Particles, Renderer, Slot, SurfaceFoamState,
    SurfaceFoamStateConfig,
};
use whitewater::{Generator, GeneratorConfig, WhitewaterConfig, WhitewaterSplat};

use crate::invariants::{exact, packet_bytes, same_drawn, water};
use crate::support::device::Gpu;
use crate::support::host::HOST_WRITE;
use crate::support::limits::{Claims, claim};
use crate::support::rig::{Drawn, Rig, Shot, config, extent, stream};
use crate::support::scenes::Random;
use crate::support::spy;

const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;

fn shot() -> Shot {
    let mut shot = water(extent(96, 64));
    let mut random = Random(8);
    shot.densities = Some(shot.positions.iter().map(|_| random.between(300.0, 500.0)).collect());
    shot
}

/// A spied device without claims, and the picture that it draws.
fn unclaimed(config: &Config) -> (Gpu, Drawn) {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let drawn = Rig::new(&gpu, config).draw(&shot());
    (gpu, drawn)
}

/// Draws with `claims`, and with one buffer that contains everything: interleaved streams that
/// begin at `word`, the count and the packets. `checks` is called for every bound buffer.
fn claimed(
    name: &str,
    (gpu, expected): &mut (Gpu, Drawn),
    config: &Config,
    words: &[usize],
    claims: Claims,
    checks: impl Fn(&spy::Bound, u64),
) {
    claim(gpu, claims);
    let shot = shot();
    let mut rig = Rig::new(gpu, config);
    let densities = shot.densities.as_deref().expect("they have some");
    let n = shot.positions.len() as u32;
    let ranges: Vec<(u32, u32)> = (0..n).step_by(70).map(|i| (i, 70.min(n - i))).collect();
    let packets = packet_bytes(&shot, &ranges);
    let packets_end = 512 + packets.len();
    for &word in words {
        for (stride, density, apart) in [(4, 3, false), (5, 4, false), (16, 11, true)] {
            let start = packets_end / 4 + word;
            let mut data = vec![f32::NAN; start + stride * (n as usize + 1)];
            data[64] = f32::from_bits(n);
            data[128..packets_end / 4].copy_from_slice(bytemuck::cast_slice(&packets));
            for (i, (p, d)) in shot.positions.iter().zip(densities).enumerate() {
                data[start + i * stride..][..3].copy_from_slice(p);
                data[start + i * stride + density] = *d;
            }
            let data = rig.stub.data(bytemuck::cast_slice(&data), STORAGE);
            let (buffer, count) = (data.buffer, ranges.len() as u32);
            let bytes = 4 * stride as u32;
            let particles = Particles::new(
                stream(&data, 4 * start as u64, bytes),
                if apart { Count::Cpu(n) } else { Count::Gpu { buffer, offset: 256 } },
            )
            .with(|it| {
                it.densities = Some(stream(&data, 4 * (start + density) as u64, bytes));
                it.velocities = Some(stream(&data, 4 * start as u64, bytes));
                it.packets = (!apart).then_some(Packets { buffer, offset: 512, count });
                it.before = HOST_WRITE;
                it.after = HOST_WRITE;
            });
            drop(spy::take_bound());
            let drawn = rig.draw_particles(&shot, &particles);
            same_drawn(&format!("{name}-{word}-{stride}"), &drawn, expected);
            let bound = spy::take_bound();
            let (all, odd) = (bound.len(), bound.iter().filter(|b| b.offset > 0).count());
            assert!(all > 10 && odd > 2, "it sees {all} buffers, {odd} with an offset");
            for bound in bound {
                checks(&bound, bound.bytes(&[(buffer, data.size)]));
            }
        }
    }
}

/// Bindings begin at multiples of the device's alignment; the shader adds the rest of the offset.
#[test]
fn offsets_are_multiples_of_the_devices_alignment() {
    for splat in [Splat::Compute, Splat::Raster] {
        let config = exact(extent(96, 64)).with(|it| {
            it.depth_splat = Some(splat);
            it.max_stride = 64;
        });
        let mut device = unclaimed(&config);
        for alignment in [64, 256] {
            let claims = Claims { offset_alignment: Some(alignment), ..Claims::default() };
            let name = format!("aligned-{alignment}-{splat:?}");
            claimed(&name, &mut device, &config, &[0, 1, 13, 63, 64], claims, |bound, _| {
                assert!(bound.offset.is_multiple_of(alignment), "{bound:?}");
            });
        }
    }
}

/// No binding is longer than the device allows, and the division into chunks does not change the
/// picture.
#[test]
fn bindings_are_no_longer_than_the_device_allows() {
    for splat in [Splat::Compute, Splat::Raster] {
        let (depth_splat, max_particles) = (Some(splat), 1024);
        let base = exact(extent(96, 64)).with(|it| it.motion = true);
        let config = base.with(|it| {
            it.depth_splat = depth_splat;
            it.max_particles = max_particles;
            it.max_stride = 64;
        });
        let mut device = unclaimed(&config);
        for (range, alignment) in [(1 << 13, 256), (5000, 16)] {
            let claims = Claims {
                offset_alignment: Some(alignment),
                max_storage_buffer_range: Some(range),
                ..Claims::default()
            };
            let name = format!("range-{range}-{splat:?}");
            claimed(&name, &mut device, &config, &[0, 13], claims, |b, bytes| {
                assert!(b.offset.is_multiple_of(alignment), "{b:?}");
                let storage = b.kind == vk::DescriptorType::STORAGE_BUFFER;
                assert!(!storage || bytes <= u64::from(range), "{bytes} bytes: {b:?}");
            });
        }
    }
}

/// An offset that another device could bind may not be aligned for this one.
#[test]
fn offsets_that_the_device_cannot_bind_are_errors() {
    let mut gpu = Gpu::own();
    claim(&mut gpu, Claims { offset_alignment: Some(256), ..Claims::default() });
    let gpu = gpu;
    let mut rig = Rig::new(&gpu, &config(extent(32, 16)));
    let shot = water(extent(32, 16));
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let good = cloud.particles();
    let buffer = good.positions.buffer;
    for (field, particles) in [
        (
            "Frame.particles.count.offset",
            good.with(|it| it.count = Count::Gpu { buffer, offset: 64 }),
        ),
        (
            "Frame.particles.packets.offset",
            good.with(|it| it.packets = Some(Packets { buffer, offset: 128, count: 1 })),
        ),
    ] {
        let frame = shot.frame(color.host_image(), depth.host_image(), particles);
        let cmd = rig.stub.begin(0);
        // SAFETY: cmd is recording; a frame with bad input uses no handle.
        let result = unsafe { rig.renderer().record(cmd, &frame) };
        rig.stub.throw_away(0);
        match result {
            Err(Error::BadInput { field: found, .. }) => assert_eq!(found, field),
            other => panic!("{field}: {:?}", other.map(|_| ())),
        }
    }
}

/// A timestamp counter with few bits wraps around within a frame.
#[test]
fn timestamps_that_wrap_are_still_durations() {
    for bits in [36_u32, 48, 64] {
        let mut gpu = Gpu::own();
        spy::install(&mut gpu);
        let claims = Claims {
            timestamp_valid_bits: Some(bits),
            timestamp_period: Some(2.0),
            ..Claims::default()
        };
        claim(&mut gpu, claims);
        let gpu = gpu;
        gpu.share_context();
        let mask = u64::MAX >> (64 - bits);
        // The counter wraps before, within and between the scopes.
        for before_the_end in [0, 50, 150, 1_050] {
            let first = mask - before_the_end;
            let stamp = move |i: usize| first.wrapping_add(100 * i as u64) & mask;
            spy::answer(Some(Box::new(stamp)));
            let mut rig = Rig::new(&gpu, &config(extent(32, 16)));
            rig.draw(&water(extent(32, 16)));
            let timings = rig.renderer().timings(Slot(0)).to_vec();
            spy::answer(None);
            assert!(timings.len() > 7, "{timings:?}");
            for (i, timing) in timings.iter().enumerate() {
                let expected = (400.0 * i as f64, 200.0);
                assert_eq!((timing.start, timing.nanoseconds), expected, "{i} of {bits} bits");
            }
        }
    }
}

/// On a queue without timestamps there are no queries, no timings and no error.
#[test]
fn a_queue_without_timestamps_has_no_timings() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let size = extent(32, 16);
    let expected = Rig::new(&gpu, &config(size)).draw(&water(size));
    claim(&mut gpu, Claims { timestamp_valid_bits: Some(0), ..Claims::default() });
    let gpu = gpu;
    spy::reset();
    let mut rig = Rig::new(&gpu, &config(size));
    for _ in 0..2 {
        same_drawn("no-timestamps", &rig.draw(&water(size)), &expected);
        assert!(rig.renderer().timings(Slot(0)).is_empty());
    }
    for unused in [&spy::CREATE_QUERY_POOL, &spy::CMD_TIMESTAMP, &spy::QUERY_RESULTS] {
        assert_eq!(unused.calls(), 0, "{:?}", unused.name);
    }
}

/// Buffers that are bound as a whole and are too long for the device give an error that names the
/// setting.
#[test]
fn what_the_device_does_not_bind_at_once_is_an_error() {
    let mut gpu = Gpu::own();
    claim(&mut gpu, Claims { max_storage_buffer_range: Some(1 << 17), ..Claims::default() });
    let gpu = gpu;
    gpu.share_context();
    // 8 bytes per pixel of 120x120 are 115 200, below the limit of 131 072.
    let base = config(extent(120, 120)).with(|it| it.thickness_level = 0);
    drop(Rig::new(&gpu, &base));
    let foam = base.with(|it| it.surface_foam = true);
    // Blended thickness needs images instead of buffers.
    drop(Rig::new(&gpu, &foam.with(|it| it.thickness_splat = Some(Splat::Raster))));
    let bubbles = BubbleConfig::new(8).with(|it| {
        it.variants = 1;
        it.bubbles = 8;
    });
    let of = |own| base.with(|it| it.bubbles = Some(own));
    drop(Rig::new(&gpu, &of(bubbles.with(|it| it.layers = 1))));
    let many = bubbles.with(|it| {
        it.layers = 1;
        it.max_blobs = 10_000;
    });
    // With blended thickness, two sheets still have a buffer with one depth per texel: 160 000
    // bytes for 200x200.
    let blended = config(extent(200, 200)).with(|it| {
        it.thickness_level = 0;
        it.thickness_splat = Some(Splat::Raster);
    });
    drop(Rig::new(&gpu, &blended.with(|it| it.sheets = 1)));
    for (field, bad) in [
        ("Config.extent", blended.with(|it| it.sheets = 2)),
        ("Config.extent", base.with(|it| it.sheets = 2)),
        ("Config.extent", foam),
        ("Config.whitewater", base.with(|it| it.whitewater = Some(WhitewaterConfig::new(64)))),
        ("Config.bubbles.layers", of(bubbles.with(|it| it.layers = 2))),
        ("Config.bubbles.max_blobs", of(many)),
    ] {
        match Rig::try_new(&gpu, &bad, 1) {
            Err(Error::BadInput { field: found, why }) => {
                assert!(found == field && why.contains("131072"), "{field}: {found}, {why}");
            }
            other => panic!("{field}: {:?}", other.map(|_| "no error")),
        }
    }
    let points = [33, 33, 33];
    let field = DistanceField {
        points,
        corner: [0.0; 3],
        edge: 1.0,
        distances: vec![1.0; points.iter().product::<u32>() as usize],
    };
    let heap = BlobSimulation::new(&gpu.context(1), &BlobSimulationConfig::new(8), Some(&field));
    match heap.map(|_| "no error") {
        Err(Error::BadInput { field: "DistanceField", why }) => {
            assert!(why.contains("131072"), "{why}");
        }
        other => panic!("{other:?}"),
    }
}

/// Sets a limit by its Vulkan name.
fn set(limits: &mut vk::PhysicalDeviceLimits, name: &str, value: u32) {
    let [x, y, z] = &mut limits.max_compute_work_group_size;
    *match name {
        "maxPerStageDescriptorSamplers" => &mut limits.max_per_stage_descriptor_samplers,
        "maxPerStageDescriptorSampledImages" => &mut limits.max_per_stage_descriptor_sampled_images,
        "maxPerStageDescriptorStorageBuffers" => {
            &mut limits.max_per_stage_descriptor_storage_buffers
        }
        "maxPerStageDescriptorUniformBuffers" => {
            &mut limits.max_per_stage_descriptor_uniform_buffers
        }
        "maxPerStageDescriptorStorageImages" => &mut limits.max_per_stage_descriptor_storage_images,
        "maxPerStageResources" => &mut limits.max_per_stage_resources,
        "maxFragmentOutputAttachments" => &mut limits.max_fragment_output_attachments,
        "maxFragmentCombinedOutputResources" => &mut limits.max_fragment_combined_output_resources,
        "maxPushConstantsSize" => &mut limits.max_push_constants_size,
        "maxComputeWorkGroupInvocations" => &mut limits.max_compute_work_group_invocations,
        "maxComputeWorkGroupSize[0]" => x,
        "maxComputeWorkGroupSize[1]" => y,
        "maxComputeWorkGroupSize[2]" => z,
        "maxComputeSharedMemorySize" => &mut limits.max_compute_shared_memory_size,
        other => panic!("what is {other}?"),
    } = value;
}

/// A device whose limits are exactly what a configuration needs makes all its pipelines. If one
/// limit is lower by 1, the error names it.
#[test]
fn limits_are_what_the_shaders_use() {
    let mut gpu = Gpu::own();
    let all = gpu.limits();
    let base = config(extent(64, 48));
    let whitewater = Some(WhitewaterConfig::new(64));
    let bubbles = Some(BubbleConfig::new(8).with(|it| {
        it.variants = 1;
        it.bubbles = 8;
        it.crossfade = true;
    }));
    let own = |splat| Some(WhitewaterConfig::new(64).with(|it| it.splat = Some(splat)));
    let fluid = base.with(|it| {
        it.surface_foam = true;
        it.spray = true;
        it.motion = true;
        it.noise = Some(1);
        it.sheets = 2;
    });
    let configs = [
        base,
        base.with(|it| {
            it.composite = Some(Shading::Compute);
            it.smoothing = Some(Smoothing::Fused);
        }),
        fluid.with(|it| {
            it.depth_splat = Some(Splat::Raster);
            it.thickness_splat = Some(Splat::Raster);
        }),
        fluid.with(|it| {
            it.light_map_size = Some(32);
            it.whitewater = whitewater;
        }),
        base.with(|it| it.whitewater = own(WhitewaterSplat::Compute)),
        base.with(|it| it.whitewater = own(WhitewaterSplat::Raster)),
        base.with(|it| {
            it.whitewater = whitewater;
            it.bubbles = bubbles;
            it.shore = Some(ShoreConfig::default());
        }),
    ];
    for config in &configs {
        let offer =
            whitewater::DeviceSupport::of(&gpu.instance, gpu.physical, config.output_format);
        let needed = offer.limits(config);
        let mut exact = all;
        for limit in &needed {
            set(&mut exact, limit.name, limit.needed);
        }
        claim(&mut gpu, Claims { limits: Some(exact), ..Claims::default() });
        drop(Rig::new(&gpu, config));
        for limit in needed.iter().filter(|limit| limit.needed > 0) {
            assert!(limit.of(&all) >= limit.needed, "{limit:?}");
            let mut less = exact;
            set(&mut less, limit.name, limit.needed - 1);
            let offer = offer.with(|it| it.limits = less);
            match offer.check(config) {
                Err(Error::Missing { what, why }) => {
                    let said = format!(
                        "{} of {} (the device has {})",
                        limit.name,
                        limit.needed,
                        limit.needed - 1
                    );
                    assert!(what == said && why.contains(limit.shader), "{said}: {what}, {why}");
                }
                other => panic!("{limit:?}: {other:?}"),
            }
        }
        gpu.claims = None;
    }
    // The min that Vulkan guarantees, which is too few for every object that has no configuration
    // check.
    let mut least = all;
    least.max_per_stage_descriptor_storage_buffers = 4;
    claim(&mut gpu, Claims { limits: Some(least), ..Claims::default() });
    let context = gpu.context(1);
    let made = [
        SurfaceFoamState::new(&context, &SurfaceFoamStateConfig::new(8)).map(|_| ()),
        BlobSimulation::new(&context, &BlobSimulationConfig::new(8), None).map(|_| ()),
        Generator::new(&context, &GeneratorConfig::new(8, 8)).map(|_| ()),
        Renderer::new(&context, &base).map(|_| ()),
    ];
    for result in made {
        match result {
            Err(Error::Missing { what, .. }) => {
                assert!(what.starts_with("maxPerStageDescriptorStorageBuffers of "), "{what}");
                assert!(what.ends_with("(the device has 4)"), "{what}");
            }
            other => panic!("{other:?}"),
        }
    }
}

/// If an image cannot hold the smoothing's levels below each other, they lie side by side; the
/// picture is the same.
#[test]
fn levels_beside_each_other_smooth_the_same() {
    let mut gpu = Gpu::own();
    let all = gpu.limits();
    let ways = [Smoothing::Fused, Smoothing::Tiles, Smoothing::Query(Gate::VertexCull)];
    let shot = water(extent(64, 64));
    let draw = |gpu: &Gpu| {
        gpu.share_context();
        ways.map(|smoothing| {
            let config = exact(extent(64, 64)).with(|it| {
                it.smoothing_level = 0;
                it.sheets = 2;
                it.coarsening = 3;
                it.max_iterations = 8;
                it.smoothing = Some(smoothing);
            });
            Rig::new(gpu, &config).draw(&shot)
        })
    };
    let expected = draw(&gpu);
    let narrow = vk::PhysicalDeviceLimits { max_image_dimension2_d: 96, ..all };
    claim(&mut gpu, Claims { limits: Some(narrow), ..Claims::default() });
    for ((way, drawn), expected) in ways.iter().zip(draw(&gpu)).zip(&expected) {
        same_drawn(&format!("{way:?}"), &drawn, expected);
    }
    // If they have no room at all, the error names the extent. At half the resolution they have
    // room.
    let wide = config(extent(80, 80)).with(|it| {
        it.smoothing_level = 0;
        it.sheets = 2;
        it.coarsening = 3;
    });
    match Rig::try_new(&gpu, &wide, 1) {
        Err(Error::BadInput { field: "Config.extent", why }) => {
            assert!(why.contains("smoothing") && why.contains("96x96"), "{why}");
        }
        other => panic!("{:?}", other.map(|_| "no error")),
    }
    drop(Rig::new(&gpu, &wide.with(|it| it.smoothing_level = 1)));
    for larger in [extent(97, 8), extent(8, 97)] {
        let made = Rig::try_new(&gpu, &config(larger), 1);
        assert!(matches!(made, Err(Error::BadInput { field: "Config.extent", .. })));
    }
}

/// Images of the device's max width and height, without validation messages.
#[test]
fn the_longest_images_are_drawn() {
    let gpu = Gpu::shared();
    let limits = gpu.limits();
    // Limits of an image that is drawn to.
    let [across, down] = [0, 1].map(|i| {
        let frame = [limits.max_framebuffer_width, limits.max_framebuffer_height][i];
        limits.max_image_dimension2_d.min(frame).min(limits.max_viewport_dimensions[i])
    });
    for size in [extent(16, down), extent(across, 16)] {
        for smoothing_level in [0, 1] {
            let config = config(size).with(|it| {
                it.smoothing_level = smoothing_level;
                it.sheets = 2;
            });
            let mut rig = Rig::new(&gpu, &config);
            // Draws only a part of the image, because the whole would take long.
            rig.draw(&water(extent(16, 16)));
        }
    }
}
