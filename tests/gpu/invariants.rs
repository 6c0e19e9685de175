//! Checks what must not change the picture: a frame without particles, the particles' order,
//! invalid particles, the way they are handed in, the number of chunks, and the unit of length.

use ash::vk;
use whitewater::water::Shading::{Compute, Raster};
use whitewater::water::{Exit, Splat};
use whitewater::{Config, Count, LightVolume, Packets, Particles, Previous, Stream};

use crate::depth::spheres;
use crate::reference::Image;
use crate::reference::cull::{CullParams, cull};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::HOST_WRITE;
use crate::support::rig::{Drawn, Rig, Sheets, Shot, config, extent, stream};
use crate::support::scenes::{self, Lens, Random};
use crate::support::tolerance::{self, Sum};
use crate::surface_foam::Foamy;

/// Both splats by compute, whose sums are in fixed point, so the order of the particles does not
/// matter.
pub fn exact(size: vk::Extent2D) -> Config {
    config(size).with(|it| {
        it.depth_splat = Some(Splat::Compute);
        it.thickness_splat = Some(Splat::Compute);
    })
}

pub fn water(size: vk::Extent2D) -> Shot {
    let mut points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    points.extend(scenes::cloud(4, 40, 0.2, 12.0));
    Shot::new(size, Lens::Standard, 0.2, &points)
}

pub fn same_drawn(name: &str, actual: &Drawn, expected: &Drawn) {
    compare::same(&format!("{name}-depth"), &actual.depth, &expected.depth);
    compare::same(&format!("{name}-surface"), &actual.surface, &expected.surface);
    compare::same(&format!("{name}-thickness"), &actual.thickness, &expected.thickness);
    assert!(actual.plan == expected.plan, "{name}: the plans differ");
    if let (Some(actual), Some(expected)) = (&actual.sheets, &expected.sheets) {
        same_sheets(name, actual, expected);
    }
    compare::same_color(name, &actual.output, &expected.output);
}

/// Asserts that boundaries, thicknesses and back surface of both sheets are equal.
pub fn same_sheets(name: &str, actual: &Sheets, expected: &Sheets) {
    compare::same(&format!("{name}-boundaries"), &actual.boundaries, &expected.boundaries);
    let [found, wanted] =
        [actual, expected].map(|s| s.thickness.map(|[x, y, z]| [*x, *y, *z, 1.0]));
    compare::same_color(&format!("{name}-sheets"), &found, &wanted);
    compare::same(&format!("{name}-behind"), &actual.surface, &expected.surface);
}

const TINY: [(u32, u32); 5] = [(96, 64), (1, 1), (1, 7), (3, 5), (17, 33)];

#[test]
fn no_particles_change_nothing() {
    let gpu = Gpu::shared();
    for (width, height) in TINY {
        let size = extent(width, height);
        for (in_place, way) in [(true, Raster), (false, Raster), (true, Compute), (false, Compute)]
        {
            let composite = Some(way);
            let mut rig = Rig::new(
                &gpu,
                &exact(size).with(|it| {
                    it.in_place = in_place;
                    it.composite = composite;
                }),
            );
            let mut shot = water(size);
            shot.positions.clear();
            // The water of the frame before must not show.
            rig.draw(&water(size));
            let drawn = rig.draw(&shot);
            let scene = crate::reference::Image {
                width: width as usize,
                height: height as usize,
                data: shot.color.clone(),
            };
            compare::same_color(&format!("zero-{width}-{in_place}-{way:?}"), &drawn.output, &scene);
            assert!(drawn.depth.data.iter().all(|d| *d >= 1e9));
            assert!(drawn.thickness.data.iter().all(|t| *t == 0.0));
            assert!(drawn.plan.data.iter().all(|p| *p == 0));
        }
    }
}

#[test]
fn pixels_outside_the_water_are_untouched() {
    let gpu = Gpu::shared();
    for (width, height) in TINY {
        let size = extent(width, height);
        let levels = [(0, 0), (1, 1), (2, 0)].map(|levels| [(levels, Raster), (levels, Compute)]);
        for ((level, thickness_level), way) in levels.into_iter().flatten() {
            let config = config(size).with(|it| {
                it.smoothing_level = level;
                it.thickness_level = thickness_level;
                it.composite = Some(way);
            });
            let mut rig = Rig::lit(&gpu, &config, 1);
            let shot = water(size);
            let drawn = rig.draw(&shot);
            for (i, depth) in drawn.depth.data.iter().enumerate() {
                let (found, scene) = (drawn.output.data[i], shot.color[i]);
                if *depth >= 1e9 {
                    assert_eq!(found.map(f32::to_bits), scene.map(f32::to_bits), "pixel {i}");
                } else {
                    let sound = found.iter().all(|v| v.is_finite()) && found[3] == 1.0;
                    assert!(sound, "{width}x{height} level {level}, pixel {i}: {found:?}");
                }
            }
        }
    }
}

#[test]
fn the_order_of_the_particles_is_no_matter() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let shot = water(size);
    let mut mixed = shot.clone();
    let order = Random(99).order(shot.positions.len());
    mixed.positions = order.iter().map(|i| shot.positions[*i]).collect();
    let mut rig = Rig::new(&gpu, &exact(size));
    let (first, second) = (rig.draw(&shot), rig.draw(&mixed));
    same_drawn("permutation", &second, &first);

    // Float sums in another order round differently, so both pictures are only checked against the
    // twin's bounds.
    let mut rig = Rig::new(&gpu, &exact(size).with(|it| it.thickness_splat = Some(Splat::Raster)));
    for shot in [&shot, &mixed] {
        let drawn = rig.draw(shot);
        let (spheres, level) = (spheres(shot), rig.config.thickness_level);
        let bounds = tolerance::thickness(&shot.splats(&spheres, level, Sum::Float));
        compare::between("permutation-floats", &drawn.thickness, &bounds);
    }
}

#[test]
fn strays_do_no_harm() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for (splat, sheets) in [(Splat::Compute, 1), (Splat::Raster, 1), (Splat::Compute, 2)] {
        // Thickness is summed in fixed point, because float sums in another order round
        // differently.
        let config = exact(size).with(|it| {
            it.depth_splat = Some(splat);
            it.sheets = sheets;
        });
        let mut rig = Rig::new(&gpu, &config);
        let clean = water(size);
        let expected = rig.draw(&clean);
        let mut shot = clean.clone();
        let (nan, inf) = (f32::NAN, f32::INFINITY);
        for (i, stray) in [
            [nan, 0.0, 0.0],
            [0.0, nan, 0.0],
            [0.0, 0.0, nan],
            [nan, nan, nan],
            [inf, 0.0, 0.0],
            [0.0, -inf, 0.0],
            [0.0, 0.0, inf],
            [inf, -inf, nan],
            [f32::MAX, 0.0, 0.0],
            [0.0, f32::MIN, f32::MAX],
            [1e30, 1e30, -1e30],
            [1e19, 0.0, 0.0],
            [9e17, 9e17, -9e17],
        ]
        .into_iter()
        .enumerate()
        {
            shot.positions.insert((i * 29) % (clean.positions.len() + i), stray);
        }
        let drawn = rig.draw(&shot);
        same_drawn(&format!("strays-{splat:?}-{sheets}"), &drawn, &expected);
        // The last position is finite and only far away, so it is not counted as dropped.
        assert_eq!((expected.work.dropped, drawn.work.dropped), (0, 12), "strays are counted");
    }
}

/// Particles below the density threshold are spray, thin water has smaller spheres, and particles
/// of density 0 have the whole radius.
#[test]
fn densities_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &exact(size));
    let mut shot = water(size);
    let mut random = Random(5);
    let densities: Vec<f32> =
        (0..shot.positions.len()).map(|_| random.between(200.0, 600.0).max(0.0)).collect();
    shot.densities = Some(densities.iter().map(|d| if *d > 590.0 { 0.0 } else { *d }).collect());
    let drawn = rig.draw(&shot);
    let below = |d: &&f32| **d > 0.0 && **d < 350.0;
    let spray = shot.densities.iter().flatten().filter(below).count();
    assert_eq!(drawn.work.set_aside as usize, spray, "spray is counted, on the screen or not");
    let radius = f64::from(shot.settings.water.radius());
    let params = CullParams::new(radius, f64::from(shot.settings.water.rest_density));
    let view = shot.view(size);
    let culled = cull(&shot.positions, shot.densities.as_deref(), &params, &view);
    assert!(culled.spray.len() > 50 && culled.visible.len() > 50, "both kinds");
    compare::between("densities-depth", &drawn.depth, &tolerance::depth(&culled.visible, &view));
    let level = rig.config.thickness_level;
    let bounds = tolerance::thickness(&shot.splats(&culled.visible, level, Sum::Fixed));
    compare::between("densities-thickness", &drawn.thickness, &bounds);

    for stray in [f32::NAN, f32::INFINITY, -f32::INFINITY, -5.0, f32::MAX, f32::MIN_POSITIVE] {
        let mut shot = shot.clone();
        for density in shot.densities.iter_mut().flatten().step_by(3) {
            *density = stray;
        }
        let drawn = rig.draw(&shot);
        let finite = drawn.output.data.iter().flatten().all(|v| v.is_finite());
        assert!(finite, "a density of {stray}");
    }
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

fn packed(positions: Stream, count: Count) -> Particles {
    Particles::new(positions, count).with(|it| {
        it.before = HOST_WRITE;
        it.after = HOST_WRITE;
    })
}

const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;

#[test]
fn a_count_on_the_gpu_is_that_of_the_cpu_and_is_clamped() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let shot = water(size);
    let all = shot.positions.len() as u32;
    let most = 200;
    let mut rig = Rig::new(&gpu, &exact(size).with(|it| it.max_particles = most));
    let positions = rig.stub.data(bytemuck::cast_slice(&shot.positions), STORAGE);
    let alignment = gpu.limits().min_storage_buffer_offset_alignment.max(4);
    assert!(all > most + 50);
    for (host, offset, drawn) in [
        (0, 0, 0),
        (1, alignment, 1),
        (150, 0, 150),
        (most, 3 * alignment, most),
        (all, alignment, most),
        (u32::MAX, 0, most),
    ] {
        let mut bytes = vec![0xFF; offset as usize];
        bytes.extend(words(&[host, 77]));
        let count = rig.stub.data(&bytes, STORAGE);
        let stream = stream(&positions, 0, 12);
        let on_gpu =
            rig.draw_particles(&shot, &packed(stream, Count::Gpu { buffer: count.buffer, offset }));
        let on_cpu = rig.draw_particles(&shot, &packed(stream, Count::Cpu(drawn)));
        same_drawn(&format!("count-{host}"), &on_gpu, &on_cpu);
    }
    // The stream is shorter than the count.
    let count = rig.stub.data(&words(&[190]), STORAGE);
    let short = Stream { size: 100 * 12, ..stream(&positions, 0, 12) };
    let on_gpu = packed(short, Count::Gpu { buffer: count.buffer, offset: 0 });
    let on_gpu = rig.draw_particles(&shot, &on_gpu);
    let on_cpu = rig.draw_particles(&shot, &packed(short, Count::Cpu(100)));
    same_drawn("count-short-stream", &on_gpu, &on_cpu);
}

#[test]
fn streams_may_be_strided_offset_and_interleaved() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &exact(size).with(|it| it.max_stride = 64));
    let mut shot = water(size);
    let mut random = Random(8);
    shot.densities = Some(shot.positions.iter().map(|_| random.between(300.0, 500.0)).collect());
    let expected = rig.draw(&shot);
    let densities = shot.densities.clone().expect("set above");
    // Words from one particle to the next, and the first words of position and density.
    for (stride, position, density) in [(4, 0, 3), (5, 1, 0), (8, 4, 2), (16, 13, 6), (7, 3, 20)] {
        let mut data = vec![f32::NAN; stride * shot.positions.len() + 32];
        for (i, (p, d)) in shot.positions.iter().zip(&densities).enumerate() {
            data[i * stride + position..][..3].copy_from_slice(p);
            data[i * stride + density] = *d;
        }
        if density == 20 {
            // In this case the densities have their own buffer.
            for (i, p) in shot.positions.iter().enumerate() {
                data[i * stride + position..][..3].copy_from_slice(p);
            }
        }
        let buffer = rig.stub.data(bytemuck::cast_slice(&data), STORAGE);
        let own = rig.stub.data(bytemuck::cast_slice(&densities), STORAGE);
        let interleaved = density != 20;
        let mut particles = packed(
            stream(&buffer, 4 * position as u64, 4 * stride as u32),
            Count::Cpu(densities.len() as u32),
        );
        particles.densities = Some(match interleaved {
            true => stream(&buffer, 4 * density as u64, 4 * stride as u32),
            false => stream(&own, 0, 4),
        });
        let drawn = rig.draw_particles(&shot, &particles);
        same_drawn(&format!("stream-{stride}-{position}"), &drawn, &expected);
    }
}

pub fn packet_bytes(shot: &Shot, ranges: &[(u32, u32)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for &(first, count) in ranges {
        let mut low = [f32::INFINITY; 3];
        let mut high = [f32::NEG_INFINITY; 3];
        for p in shot.positions.iter().skip(first as usize).take(count as usize) {
            for i in 0..3 {
                (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
            }
        }
        bytes.extend(words(&[first, count]));
        bytes.extend(low.into_iter().chain(high).flat_map(f32::to_le_bytes));
    }
    bytes
}

#[test]
fn packets_cull_as_single_particles() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let shot = water(size);
    let n = shot.positions.len() as u32;
    // All particles in one chunk, and several chunks whose borders cut packets.
    for max_stride in [16, 1 << 19] {
        let mut rig = Rig::new(&gpu, &exact(size).with(|it| it.max_stride = max_stride));
        let expected = rig.draw(&shot);
        let all: Vec<(u32, u32)> = (0..n).step_by(70).map(|i| (i, 70.min(n - i))).collect();
        // The last packet's count reaches beyond the particles, and its end beyond 32 bits.
        let mut open = all.clone();
        open.last_mut().expect("some").1 = u32::MAX - 1;
        let mut mixed = all.clone();
        mixed.reverse();
        for (name, ranges) in [("all", &all), ("open", &open), ("reversed", &mixed)] {
            let cloud = rig.particles(&shot);
            let packets = rig.stub.data(&packet_bytes(&shot, ranges), STORAGE);
            let (buffer, count) = (packets.buffer, ranges.len() as u32);
            let packets = Some(Packets { buffer, offset: 0, count });
            let particles = cloud.particles().with(|it| it.packets = packets);
            let drawn = rig.draw_particles(&shot, &particles);
            same_drawn(&format!("packets-{name}-{max_stride}"), &drawn, &expected);
        }
        // Particles in no packet are not drawn.
        let half: Vec<(u32, u32)> = vec![(0, n / 2)];
        let cloud = rig.particles(&shot);
        let data = rig.stub.data(&packet_bytes(&shot, &half), STORAGE);
        let packets = Some(Packets { buffer: data.buffer, offset: 0, count: 1 });
        let drawn = rig.draw_particles(&shot, &cloud.particles().with(|it| it.packets = packets));
        let mut less = shot.clone();
        less.positions.truncate(n as usize / 2);
        same_drawn("packets-half", &drawn, &rig.draw(&less));
    }
}

/// Packets that overlap, against the contract, may draw particles twice, but give no more entries than the lists hold.
#[test]
fn packets_that_overlap_do_no_harm() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let shot = water(size);
    let n = shot.positions.len() as u32;
    let mut rig = Rig::new(&gpu, &exact(size).with(|it| it.max_particles = n));
    let single = rig.draw(&shot).work.visible;
    let cloud = rig.particles(&shot);
    let data = rig.stub.data(&packet_bytes(&shot, &[(0, n); 3]), STORAGE);
    let packets = Some(Packets { buffer: data.buffer, offset: 0, count: 3 });
    let drawn = rig.draw_particles(&shot, &cloud.particles().with(|it| it.packets = packets));
    // Lists are a multiple of 16 long.
    let room = n.next_multiple_of(16);
    assert!(3 * single > room, "{single} of {n} are visible");
    assert!(drawn.work.visible <= room && drawn.work.front <= room, "more than {room} entries");
}

/// Particles in no packet are absent from every pass. Particles in packets that the camera does not
/// see still cast their shadows and caustics into the view.
#[test]
fn particles_in_no_packet_are_in_no_pass() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for max_stride in [16, 1 << 19] {
        let passes = exact(size).with(|it| {
            it.surface_foam = true;
            it.spray = true;
            it.noise = Some(1);
            it.motion = true;
        });
        let mut rig = Rig::lit(
            &gpu,
            &passes.with(|it| {
                it.light_map_size = Some(64);
                it.max_stride = max_stride;
            }),
            1,
        );
        let mut case = Foamy::new(size, Lens::Standard, 20.0);
        let n = case.shot.positions.len();
        let mut random = Random(8);
        case.shot.densities = Some((0..n).map(|_| random.between(300.0, 1000.0)).collect());
        case.shot.settings.noise.foam = 1.0;
        case.shot.settings.light.direction = [0.0, 1.0, 0.0];
        let region = |center| Some(LightVolume { center, radius: 6.0 });
        case.shot.light_volume = region(scenes::world(&case.shot.camera, &[[0.0, 0.0, 5.0]])[0]);
        case.shot.previous = Some(Previous { camera: case.shot.camera, dt: 0.05 });
        let packed = |case: &Foamy, rig: &mut Rig<'_>, ranges: &[(u32, u32)]| {
            let streams = case.streams(rig);
            let bytes = packet_bytes(&case.shot, ranges);
            // A buffer cannot be empty, so it has room for one packet.
            let bytes = if bytes.is_empty() { vec![0; 32] } else { bytes };
            let data = rig.stub.data(&bytes, STORAGE);
            let count = ranges.len() as u32;
            let packets = Some(Packets { buffer: data.buffer, offset: 0, count });
            rig.draw_particles(&case.shot, &streams.particles().with(|it| it.packets = packets))
        };
        let of = |case: &Foamy, ranges: &[(u32, u32)]| {
            let which = || ranges.iter().flat_map(|&(first, count)| first..first + count);
            let pick = |i: u32| i as usize;
            let mut less = case.clone();
            less.shot.positions = which().map(|i| case.shot.positions[pick(i)]).collect();
            let densities = case.shot.densities.as_ref();
            less.shot.densities = densities.map(|d| which().map(|i| d[pick(i)]).collect());
            less.amounts = which().map(|i| case.amounts[pick(i)]).collect();
            less.velocities = which().map(|i| case.velocities[pick(i)]).collect();
            less.ids = case.ids.as_ref().map(|ids| which().map(|i| ids[pick(i)]).collect());
            less
        };
        let n = n as u32;
        let (half, some) = (vec![(0, n / 2)], vec![(3, 40), (60, 1), (90, 37)]);
        let all: Vec<_> = (0..n).step_by(7).map(|i| (i, 7.min(n - i))).collect();
        for (name, ranges) in [("half", half), ("some", some), ("all", all), ("none", Vec::new())] {
            let name = format!("packets-{name}-{max_stride}");
            let (drawn, expected) =
                (packed(&case, &mut rig, &ranges), of(&case, &ranges).draw(&mut rig));
            same_drawn(&name, &drawn, &expected);
            same_passes(&name, &drawn, &expected);
        }
        // All particles lie behind the eye.
        case.shot.light_volume = region(scenes::world(&case.shot.camera, &[[0.0, 0.0, -8.0]])[0]);
        let behind = scenes::world(&case.shot.camera, &scenes::cloud(31, n as usize, -10.0, -6.0));
        case.shot.positions = behind;
        let (drawn, expected) = (packed(&case, &mut rig, &[(0, n)]), case.draw(&mut rig));
        same_passes("packets-behind", &drawn, &expected);
        let lit = drawn.light_thickness.expect("a map");
        assert!(lit.data.iter().any(|t| t[0] > 0.0), "what is behind the eye casts");
    }
}

/// The layers of all passes except those of the water's surface.
fn same_passes(name: &str, actual: &Drawn, expected: &Drawn) {
    let foam = |drawn: &Drawn| drawn.foam.clone().expect("foam");
    let (found, wanted) = (foam(actual), foam(expected));
    compare::same(&format!("{name}-foam"), &found.depth, &wanted.depth);
    assert!(found.thickness.data == wanted.thickness.data, "{name}: foam's thickness");
    for (layer, of) in [
        ("spray", (|drawn| drawn.spray.clone()) as fn(&Drawn) -> Option<Image<f32>>),
        ("noise", |drawn| drawn.noise.clone()),
        ("front to the sun", |drawn| drawn.light_front.clone()),
        ("to the right", |drawn| drawn.motion.as_ref().map(|m| m.map(|m| m[0]))),
        ("down", |drawn| drawn.motion.as_ref().map(|m| m.map(|m| m[1]))),
    ] {
        let [found, wanted] = [actual, expected].map(|drawn| of(drawn).expect("a layer"));
        compare::same(&format!("{name}-{layer}"), &found, &wanted);
    }
    let map = |drawn: &Drawn| drawn.light_thickness.clone().expect("a map");
    compare::same_color(&format!("{name}-to-the-sun"), &map(actual), &map(expected));
}

/// `max_stride` decides how many particles fit in a chunk; the picture does not change.
#[test]
fn chunks_do_not_show() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut shot = water(size);
    let more = scenes::cloud(21, 3000, 0.5, 15.0);
    shot.positions.extend(scenes::world(&shot.camera, &more));
    for splat in [Splat::Compute, Splat::Raster] {
        let config = exact(size).with(|it| {
            it.depth_splat = Some(splat);
            it.max_stride = 1 << 17;
        });
        let mut rig = Rig::new(&gpu, &config);
        let drawn = rig.draw(&shot);
        let one = exact(size).with(|it| it.depth_splat = Some(splat));
        let expected = Rig::new(&gpu, &one).draw(&shot);
        same_drawn(&format!("chunks-{splat:?}"), &drawn, &expected);
        // Fewer particles than one chunk holds, so further chunks are empty.
        let mut few = shot.clone();
        few.positions.truncate(100);
        let expected =
            Rig::new(&gpu, &exact(size).with(|it| it.depth_splat = Some(splat))).draw(&few);
        same_drawn(&format!("chunks-few-{splat:?}"), &rig.draw(&few), &expected);
    }
}

/// With the max number of chunks of a configuration, the descriptor pool has sets for each.
#[test]
fn many_chunks_have_their_descriptors() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let most = 65_536;
    let mut rig = Rig::new(
        &gpu,
        &exact(size).with(|it| {
            it.max_stride = 1 << 16;
            it.max_particles = most;
        }),
    );
    let shot = water(size);
    let expected = Rig::new(&gpu, &exact(size)).draw(&shot);
    same_drawn("many-chunks", &rig.draw(&shot), &expected);
}

/// A stream longer than one binding is read through several windows.
#[test]
fn a_stream_longer_than_a_binding_is_read_whole() {
    let gpu = Gpu::shared();
    let range = u64::from(gpu.limits().max_storage_buffer_range);
    if range > 1 << 28 {
        crate::support::skipped::skipped(&format!("a binding holds {range} bytes here"));
        return;
    }
    let size = extent(96, 64);
    let shot = water(size);
    let stride = 1_u64 << 20;
    let count = (range / stride + 20).min(shot.positions.len() as u64);
    let data = {
        let mut rig = Rig::new(&gpu, &exact(size).with(|it| it.max_stride = 1 << 20));
        let mut data = rig.stub.sized(count * stride, STORAGE);
        // Only pages that are written use memory.
        for (i, p) in shot.positions.iter().take(count as usize).enumerate() {
            data.write_at(i as u64 * stride, bytemuck::cast_slice(p));
        }
        let particles = packed(stream(&data, 0, stride as u32), Count::Cpu(count as u32));
        rig.draw_particles(&shot, &particles)
    };
    let mut less = shot.clone();
    less.positions.truncate(count as usize);
    same_drawn("long-stream", &data, &Rig::new(&gpu, &exact(size)).draw(&less));
}

pub fn scaled(shot: &Shot, scale: f32) -> Shot {
    use whitewater::water::Medium;
    let mut shot = shot.clone();
    for p in &mut shot.positions {
        *p = p.map(|x| x * scale);
    }
    // Depths are scaled; device depths stay the same.
    let mut view = shot.camera.view_matrix();
    view.w_axis = (view.w_axis.truncate() * scale).extend(1.0);
    shot.camera.view = view.to_cols_array_2d();
    shot.camera.projection[3][2] *= scale;
    shot.settings.water.spacing *= scale;
    if let Medium::Physical { absorption, scattering } = &mut shot.settings.water.medium {
        *absorption = absorption.map(|k| k / scale);
        *scattering = scattering.map(|k| k / scale);
    }
    shot
}

/// A scale by a power of two changes no rounding, so the pictures are equal bit for bit. Other
/// scales are compared with the twins at their scale.
#[test]
fn the_unit_of_length_does_not_show() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(
        &gpu,
        &exact(size).with(|it| {
            it.mirror_steps = 10;
            it.exit = Exit::TwoInterfaces;
        }),
    );
    rig.environment(extent(4, 2), &[[0.5, 0.75, 1.0, 1.0]; 8]);
    let mut shot = water(size);
    shot.scene_depth(|x, _| Some(if x < 40 { 4.5 } else { 60.0 }));
    let expected = rig.draw(&shot);
    for scale in [1024.0, 1.0 / 1024.0] {
        let drawn = rig.draw(&scaled(&shot, scale));
        compare::same_color(&format!("unit-{scale}"), &drawn.output, &expected.output);
        assert!(drawn.plan == expected.plan, "the plans differ at {scale}");
    }
    for scale in [1000.0, 0.001] {
        let shot = scaled(&shot, scale);
        let mut open = shot.clone();
        open.scene_depth(|_, _| None);
        let drawn = rig.draw(&open);
        let bounds = tolerance::depth(&spheres(&open), &open.view(size));
        compare::between(&format!("unit-depth-{scale}"), &drawn.depth, &bounds);
        let drawn = rig.draw(&shot);
        let (spheres, level) = (spheres(&shot), rig.config.thickness_level);
        let bounds = tolerance::thickness(&shot.splats(&spheres, level, Sum::Fixed));
        compare::between(&format!("unit-thickness-{scale}"), &drawn.thickness, &bounds);
    }
}

/// An interleaved buffer may end with the last particle's values, before its stride is complete.
#[test]
fn the_last_interleaved_particle_is_drawn() {
    let gpu = Gpu::shared();
    let size = extent(33, 21);
    let mut rig = Rig::new(&gpu, &config(size));
    let mut shot = Shot::new(size, Lens::Standard, 0.3, &[[0.0, 0.0, 4.0], [0.6, 0.2, 4.0]]);
    shot.densities = Some(vec![1000.0; 2]);
    let expected = rig.draw(&shot);
    let words: Vec<f32> =
        shot.positions.iter().flat_map(|[x, y, z]| [*x, *y, *z, 1000.0]).collect();
    let storage = ash::vk::BufferUsageFlags::STORAGE_BUFFER;
    let data = rig.stub.data(bytemuck::cast_slice(&words), storage);
    let particles = rig.particles(&shot).particles().with(|it| {
        it.positions = stream(&data, 0, 16);
        it.densities = Some(stream(&data, 12, 16));
    });
    let found = rig.draw_particles(&shot, &particles);
    compare::same("interleaved-last", &found.depth, &expected.depth);
}

/// Numbers in a value's `{:#?}`, each with the names of its field and of all that contain it.
fn numbers(value: &impl std::fmt::Debug) -> Vec<(String, f32)> {
    let (mut names, mut found) = (Vec::new(), Vec::new());
    for line in format!("{value:#?}").lines().map(str::trim) {
        let (name, rest) = line.split_once(": ").unwrap_or(("", line));
        if rest.ends_with(['{', '(', '[']) {
            names.push(name.to_owned());
        } else if rest.starts_with(['}', ')', ']']) {
            names.pop();
        } else if let Ok(number) = rest.trim_end_matches(',').parse() {
            let path = names.iter().map(String::as_str).chain([name]);
            let path: Vec<_> = path.filter(|part| !part.is_empty()).collect();
            found.push((path.join("."), number));
        }
    }
    found
}

/// The settings that follow from spacing and unit, with the powers of the two. The products with
/// powers of two are exact, and all other numbers stay as they are.
#[test]
fn settings_follow_from_spacing_and_unit() {
    const POWERS: [(&str, [i32; 2]); 27] = [
        ("water.spacing", [1, 0]),
        ("water.medium.absorption", [0, -1]),
        ("water.medium.scattering", [0, -1]),
        ("water.wavelets.length", [0, 1]),
        ("water.wavelets.gravity", [0, 1]),
        ("surface_foam.extinction", [-1, 0]),
        ("surface_foam.front_extinction", [-1, 0]),
        ("surface_foam.front_depth", [1, 0]),
        ("surface_foam.min_thickness", [1, 0]),
        ("surface_foam.shadow", [-1, 0]),
        ("whitewater.radius", [1, 0]),
        ("bubbles.crossfade.near", [0, 1]),
        ("bubbles.crossfade.far", [0, 1]),
        ("shore.shoreline.sea_reach", [0, 1]),
        ("shore.shoreline.land_reach", [0, 1]),
        ("shore.shoreline.frequency_noise.scale", [0, -1]),
        ("shore.shoreline.speed_noise.scale", [0, -1]),
        ("shore.shoreline.layers.scale", [0, -1]),
        ("shore.shoreline.layers.speed", [0, 1]),
        ("shore.shoreline.texture_warp.amplitude", [0, 1]),
        ("shore.shoreline.texture_warp.scale", [0, -1]),
        ("shore.shoreline.texture_warp_velocity", [0, 1]),
        ("shore.shoreline.threshold_noise.scale", [0, -1]),
        ("shore.shoreline.rise_noise.scale", [0, -1]),
        ("shore.contact.depth", [0, 1]),
        ("shore.contact.mask_scale", [0, -1]),
        ("shore.contact.mask_speed", [0, 1]),
    ];
    let metres = whitewater::Settings::new(0.05, 1.0);
    let (from, to) = (numbers(&metres), numbers(&whitewater::Settings::new(0.1, 8.0)));
    assert_eq!(from.len(), to.len());
    let mut alike = 0;
    for ((name, a), (_, b)) in from.iter().zip(&to) {
        let power = POWERS.iter().find(|(listed, _)| listed == name);
        alike += usize::from(power.is_none());
        let [spacing, unit] = power.map_or([0; 2], |(_, powers)| *powers);
        assert_eq!(*b, a * 2.0_f32.powi(spacing) * 8.0_f32.powi(unit), "{name}");
    }
    for (listed, _) in POWERS {
        assert!(from.iter().any(|(name, _)| name == listed), "{listed} is no setting");
    }
    // A new number that scales belongs to the list, another one to this count.
    assert_eq!(alike, 182, "numbers that are not listed");
    // The Weber number's scale describes the same particles at the same speed.
    let [a, b] = [(0.05, 1.0), (5.0, 100.0)].map(|(spacing, unit)| {
        whitewater::water::WeberSettings::weber_in(spacing, unit, 1.0).scale * unit * unit
    });
    assert!((a - b).abs() <= 1.0e-5 * a.abs(), "{a} {b}");
    assert_eq!(metres, whitewater::Settings::default());
}
