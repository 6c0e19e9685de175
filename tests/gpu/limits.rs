//! On a device that claims stricter limits than it has: alignment of offsets, the longest binding,
//! and timestamps of few bits.

use ash::vk;
use whitewater::bubbles::{BubbleConfig, DistanceField, Heap, HeapConfig};
use whitewater::foam::DiffuseConfig;
use whitewater::water::Splat;
use whitewater::{Config, Count, Error, Packets, Particles, Slot};

use crate::invariants::{exact, packet_bytes, same_drawn, water};
use crate::support::device::Gpu;
use crate::support::host::HOST_WRITE;
use crate::support::limits::{Claims, claim};
use crate::support::rig::{Rig, Shot, config, extent, stream};
use crate::support::scenes::Random;
use crate::support::spy;

const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;

fn shot() -> Shot {
    let mut shot = water(extent(96, 64));
    let mut random = Random(8);
    shot.densities = Some(shot.positions.iter().map(|_| random.between(300.0, 500.0)).collect());
    shot
}

/// Draws with claims from one buffer that holds everything, as interleaved streams from `word` on,
/// with the count and the packets in it; `checks` looks at every buffer that was bound.
fn claimed(
    name: &str,
    config: &Config,
    words: &[usize],
    claims: Claims,
    checks: impl Fn(&spy::Bound, u64),
) {
    let mut gpu = Gpu::spied();
    spy::install(&mut gpu);
    let shot = shot();
    let expected = Rig::new(&gpu, config).draw(&shot);
    claim(&mut gpu, claims);
    let gpu = gpu;
    let mut rig = Rig::new(&gpu, config);
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
            let particles = Particles {
                densities: Some(stream(&data, 4 * (start + density) as u64, bytes)),
                velocities: Some(stream(&data, 4 * start as u64, bytes)),
                packets: (!apart).then_some(Packets { buffer, offset: 512, count }),
                before: HOST_WRITE,
                after: HOST_WRITE,
                ..Particles::new(
                    stream(&data, 4 * start as u64, bytes),
                    if apart { Count::Cpu(n) } else { Count::Gpu { buffer, offset: 256 } },
                )
            };
            drop(spy::take_bound());
            let drawn = rig.draw_particles(&shot, &particles);
            same_drawn(&format!("{name}-{word}-{stride}"), &drawn, &expected);
            let bound = spy::take_bound();
            let (all, odd) = (bound.len(), bound.iter().filter(|b| b.offset > 0).count());
            assert!(all > 10 && odd > 2, "it sees {all} buffers, {odd} with an offset");
            for bound in bound {
                checks(&bound, bound.bytes(&[(buffer, data.size)]));
            }
        }
    }
}

/// Windows begin where the device can bind, the rest is left to the shader.
#[test]
fn offsets_are_multiples_of_the_devices_alignment() {
    for splat in [Splat::Compute, Splat::Raster] {
        let config = Config { depth_splat: Some(splat), max_stride: 64, ..exact(extent(96, 64)) };
        for alignment in [64, 256] {
            let claims = Claims { offset_alignment: Some(alignment), ..Claims::default() };
            let name = format!("aligned-{alignment}-{splat:?}");
            claimed(&name, &config, &[0, 1, 13, 63, 64], claims, |bound, _| {
                assert!(bound.offset.is_multiple_of(alignment), "{bound:?}");
            });
        }
    }
}

/// No storage buffer is bound longer than the device allows; chunks do not show.
#[test]
fn bindings_are_no_longer_than_the_device_allows() {
    for splat in [Splat::Compute, Splat::Raster] {
        let (depth_splat, max_particles) = (Some(splat), 1024);
        let base = Config { motion: true, ..exact(extent(96, 64)) };
        let config = Config { depth_splat, max_particles, max_stride: 64, ..base };
        for (range, alignment) in [(1 << 13, 256), (5000, 16)] {
            let claims = Claims {
                offset_alignment: Some(alignment),
                max_storage_buffer_range: Some(range),
                ..Claims::default()
            };
            claimed(&format!("range-{range}-{splat:?}"), &config, &[0, 13], claims, |b, bytes| {
                assert!(b.offset.is_multiple_of(alignment), "{b:?}");
                let storage = b.kind == vk::DescriptorType::STORAGE_BUFFER;
                assert!(!storage || bytes <= u64::from(range), "{bytes} bytes: {b:?}");
            });
        }
    }
}

/// What was aligned on another device may not be on this one.
#[test]
fn offsets_that_the_device_cannot_bind_are_errors() {
    let mut gpu = Gpu::spied();
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
            Particles { count: Count::Gpu { buffer, offset: 64 }, ..good },
        ),
        (
            "Frame.particles.packets.offset",
            Particles { packets: Some(Packets { buffer, offset: 128, count: 1 }), ..good },
        ),
    ] {
        let frame = shot.frame(color.host_image(), depth.host_image(), particles);
        let cmd = rig.stub.begin(0);
        // SAFETY: cmd is recording; nothing of a bad frame is used.
        let result = unsafe { rig.renderer().record(cmd, &frame) };
        rig.stub.throw_away(0);
        match result {
            Err(Error::BadInput { field: found, .. }) => assert_eq!(found, field),
            other => panic!("{field}: {:?}", other.map(|_| ())),
        }
    }
}

/// A counter of few bits starts again from 0 within a frame.
#[test]
fn timestamps_that_wrap_are_still_durations() {
    for bits in [36_u32, 48, 64] {
        let mut gpu = Gpu::spied();
        spy::install(&mut gpu);
        let claims = Claims {
            timestamp_valid_bits: Some(bits),
            timestamp_period: Some(2.0),
            ..Claims::default()
        };
        claim(&mut gpu, claims);
        let gpu = gpu;
        let mask = u64::MAX >> (64 - bits);
        // Before, within and between the scopes.
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

/// A queue without timestamps: no queries, no timings, no error.
#[test]
fn a_queue_without_timestamps_has_no_timings() {
    let mut gpu = Gpu::spied();
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

/// What is bound whole, of a size that each of these alone is over: errors that say which.
#[test]
fn what_the_device_does_not_bind_at_once_is_an_error() {
    let mut gpu = Gpu::spied();
    claim(&mut gpu, Claims { max_storage_buffer_range: Some(1 << 17), ..Claims::default() });
    let gpu = gpu;
    // 8 bytes a pixel of 120x120 are 115 200, under the 131 072.
    let base = Config { thickness_level: 0, ..config(extent(120, 120)) };
    drop(Rig::new(&gpu, &base));
    let foam = Config { foam: true, ..base };
    // Blended, they are images.
    drop(Rig::new(&gpu, &Config { thickness_splat: Some(Splat::Raster), ..foam }));
    let bubbles = BubbleConfig { templates: 1, bubbles: 8, ..BubbleConfig::new(8) };
    let of = |own| Config { bubbles: Some(own), ..base };
    drop(Rig::new(&gpu, &of(BubbleConfig { layers: 1, ..bubbles })));
    let many = BubbleConfig { layers: 1, max_blobs: 10_000, ..bubbles };
    for (field, bad) in [
        ("Config.extent", Config { sheets: 2, ..base }),
        ("Config.extent", foam),
        ("Config.diffuse", Config { diffuse: Some(DiffuseConfig::new(64)), ..base }),
        ("Config.bubbles.layers", of(BubbleConfig { layers: 2, ..bubbles })),
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
    // SAFETY: the device outlives it.
    let heap = unsafe { Heap::new(&gpu.host(1), &HeapConfig::new(8), Some(&field)) };
    match heap.map(|_| "no error") {
        Err(Error::BadInput { field: "DistanceField", why }) => {
            assert!(why.contains("131072"), "{why}");
        }
        other => panic!("{other:?}"),
    }
}
