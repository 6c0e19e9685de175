//! All kinds of splat for whitewater particles agree, for streams of any layout and after changes,
//! within the documented memory.

use ash::vk;
use whitewater::{Count, Renderer, WhitewaterParticles};
use whitewater::{Occlusion as Occluding, WhitewaterConfig, WhitewaterSplat};

use super::{SIZE, Whitewater, by, ways, whitewater_config};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::HOST_WRITE;
use crate::support::rig::{Drawn, Rig, Shot, config, extent, stream};
use crate::support::scenes::{self, LENSES, Lens};

/// All kinds of splat give the same images.
#[test]
fn all_ways_are_the_same() {
    let gpu = Gpu::shared();
    let others = ways(&gpu).into_iter().filter(|way| *way != WhitewaterSplat::Compute);
    let rig = |way| Rig::lit(&gpu, &by(way, SIZE), 1);
    let (mut first, mut others) =
        (rig(WhitewaterSplat::Compute), others.map(|way| (way, rig(way))).collect::<Vec<_>>());
    for lens in LENSES {
        let cloud = Whitewater::new(lens);
        let expected = cloud.draw(&mut first);
        for (way, rig) in &mut others {
            same(*way, &cloud.draw(rig), &expected);
        }
    }
}

/// Asserts equality except for rounding, which differs between pipelines. A falloff ends in a
/// difference of nearly equal numbers.
fn same(way: WhitewaterSplat, found: &Drawn, expected: &Drawn) {
    compare::same_but_rounded(&format!("whitewater-{way:?}"), &found.output, &expected.output);
    let [found, expected] = [found, expected].map(|drawn| drawn.whitewater.as_ref().expect("foam"));
    for (name, found, expected) in [
        ("occluders", &found.occluders, &expected.occluders),
        ("thickness", &found.thickness, &expected.thickness),
        ("normal", &found.normal, &expected.normal),
    ] {
        compare::same_but_rounded(&format!("whitewater-{way:?}-{name}"), found, expected);
    }
}

/// If two spheres meet a pixel at the same depth, to the left and to the right of its centre,
/// compute chooses the same one in any order.
#[test]
fn the_frontmost_of_equals_is_the_same() {
    let gpu = Gpu::shared();
    let mut cloud = Whitewater::new(Lens::Standard);
    cloud.shot = Shot::new(SIZE, Lens::Standard, 0.2, &[]);
    let (depth, scale) = (6.0_f32, cloud.shot.camera.projection_matrix());
    let middle = |i: u32, n: u32, scale: f32| ((2 * i + 1) as f32 / n as f32 - 1.0) / scale;
    let radius = 1.5 * depth / (0.5 * SIZE.height as f32) / scale.y_axis.y.abs();
    let grid = || {
        (4..SIZE.width - 4)
            .step_by(4)
            .flat_map(|x| (4..SIZE.height - 4).step_by(4).map(move |y| (x, y)))
    };
    // First all spheres on one side, then all on the other, because neighbours may be drawn
    // together.
    let points: Vec<_> = [-0.1, 0.1]
        .into_iter()
        .flat_map(|aside| grid().map(move |(x, y)| (x, y, aside * radius)))
        .map(|(x, y, aside)| {
            let x = middle(x, SIZE.width, scale.x_axis.x) * depth + aside;
            [x, middle(y, SIZE.height, scale.y_axis.y) * depth, depth]
        })
        .collect();
    let count = points.len();
    let at = |points: &[[f32; 3]]| Whitewater {
        positions: scenes::world(&cloud.shot.camera, points),
        kinds: vec![0; count],
        radii: Some(vec![radius; count]),
        ages: vec![0.0; count],
        ids: Some(vec![0; count]),
        ..cloud.clone()
    };
    let turned: Vec<_> = points.iter().rev().copied().collect();
    let draw = |way, points: &[[f32; 3]]| at(points).draw(&mut Rig::lit(&gpu, &by(way, SIZE), 1));
    let expected = draw(WhitewaterSplat::Compute, &points);
    for way in ways(&gpu).into_iter().filter(|way| *way != WhitewaterSplat::Raster) {
        for points in [&points, &turned] {
            same(way, &draw(way, points), &expected);
        }
    }
    // Of two particles at one depth, raster takes the first, so its normals show that such pixels
    // exist.
    let [one, other] = [&points, &turned].map(|points| draw(WhitewaterSplat::Raster, points));
    let normals = [one, other].map(|drawn| drawn.whitewater.expect("foam").normal.data);
    let equals = normals[0].iter().zip(&normals[1]).filter(|(a, b)| a != b).count();
    assert!(equals > 100, "{equals} pixels with two at one depth");
}

/// More large particles than their list holds: single invocations draw the rest like groups do. The
/// result equals that of several chunks with a list each.
#[test]
fn more_large_ones_than_there_is_room_for() {
    let gpu = Gpu::shared();
    let mut cloud = Whitewater::new(Lens::Standard);
    cloud.shot = Shot::new(SIZE, Lens::Standard, 0.2, &[]);
    let points = scenes::cloud(7, 30_000, 5.0, 6.0);
    let n = points.len();
    cloud.positions = scenes::world(&cloud.shot.camera, &points);
    // Every particle is at least 18 pixels wide.
    let scale = cloud.shot.camera.projection_matrix().y_axis.y.abs() * 0.5 * SIZE.height as f32;
    cloud.radii = Some(vec![5.0 * 9.0 * 6.0 / scale; n]);
    (cloud.kinds, cloud.ages, cloud.ids) = (vec![0; n], vec![0.0; n], Some(vec![4; n]));
    let range = u64::from(gpu.limits().max_storage_buffer_range);
    for way in ways(&gpu).into_iter().filter(|way| *way != WhitewaterSplat::Raster) {
        // One chunk for all, and chunks of a few thousand particles.
        let [found, expected] = [12, range as u32 / 5000 / 4 * 4].map(|max_stride| {
            let config = by(way, SIZE);
            let max_particles = n as u32;
            let whitewater = config.whitewater.map(|own| {
                own.with(|it| {
                    it.max_particles = max_particles;
                    it.max_stride = max_stride;
                })
            });
            cloud.draw(&mut Rig::lit(&gpu, &config.with(|it| it.whitewater = whitewater), 1))
        });
        same(way, &found, &expected);
    }
}

/// The same particles in buffers with other layouts.
#[test]
fn streams_of_any_shape_are_the_same() {
    let gpu = Gpu::shared();
    for way in ways(&gpu) {
        streams_of_any_shape_by(&gpu, way);
    }
}

fn streams_of_any_shape_by(gpu: &Gpu, way: WhitewaterSplat) {
    let cloud = Whitewater::new(Lens::Standard);
    let mut rig = Rig::lit(gpu, &by(way, SIZE), 1);
    let nameless = Whitewater { ids: None, ..cloud.clone() };
    let expected = [&cloud, &nameless].map(|cloud| cloud.draw(&mut rig));
    // Interleaved records of 48 bytes, after 20 bytes of other data; with the large stride a chunk
    // holds only a part of the particles.
    let range = u64::from(gpu.limits().max_storage_buffer_range);
    let strides = [48, (range / 150).next_multiple_of(4).min(1 << 20) as u32];
    let [whole, chunked] = strides;
    for (stride, counted, named) in
        [(whole, false, true), (whole, true, true), (chunked, true, true), (chunked, false, false)]
    {
        let occlusion = Occluding::Reference;
        let splat = Some(way);
        let whitewater = WhitewaterConfig::new(500).with(|it| {
            it.max_stride = stride;
            it.splat = splat;
            it.occlusion = occlusion;
        });
        let mut rig =
            Rig::lit(gpu, &whitewater_config(SIZE).with(|it| it.whitewater = Some(whitewater)), 1);
        let count = cloud.positions.len();
        let mut bytes = vec![0xa5_u8; 20 + stride as usize * count];
        for (i, record) in bytes[20..].chunks_exact_mut(stride as usize).enumerate() {
            record[..12].copy_from_slice(bytemuck::bytes_of(&cloud.positions[i]));
            record[12..16].copy_from_slice(&cloud.kinds[i].to_ne_bytes());
            let (radii, ids) = (cloud.radii.as_ref(), cloud.ids.as_ref());
            record[16..20].copy_from_slice(&radii.expect("radii")[i].to_ne_bytes());
            record[20..24].copy_from_slice(&cloud.ages[i].to_ne_bytes());
            record[24..28].copy_from_slice(&ids.expect("ids")[i].to_ne_bytes());
        }
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let data = rig.stub.data(&bytes, usage);
        let number = rig.stub.data(&(count as u32).to_ne_bytes(), usage);
        let at = |offset: u64| stream(&data, 20 + offset, stride);
        let count = if counted {
            Count::Gpu { buffer: number.buffer, offset: 0 }
        } else {
            Count::Cpu(count as u32)
        };
        let particles = WhitewaterParticles::new(at(0), count).with(|it| {
            it.kinds = Some(at(12));
            it.radii = Some(at(16));
            it.ages = Some(at(20));
            it.ids = named.then(|| at(24));
            it.before = HOST_WRITE;
            it.after = HOST_WRITE;
        });
        let water = rig.particles(&cloud.shot);
        let drawn = rig.draw_whitewater(&cloud.shot, &water.particles(), Some(particles));
        let name = format!("whitewater-stride-{way:?}-{stride}-{counted}");
        let expected = &expected[usize::from(!named)];
        compare::same_color(&name, &drawn.output, &expected.output);
    }
}

#[test]
fn size_and_configuration_change() {
    let gpu = Gpu::shared();
    let cloud = Whitewater::new(Lens::Standard);
    for way in ways(&gpu) {
        let mut rig = Rig::lit(&gpu, &by(way, extent(200, 100)), 1);
        let expected = cloud.draw(&mut Rig::lit(&gpu, &by(way, SIZE), 1)).output;
        rig.resize(extent(1, 1));
        rig.resize(SIZE);
        compare::same_color("whitewater-resized", &cloud.draw(&mut rig).output, &expected);
        rig.renderer().reconfigure(&config(SIZE)).expect("reconfigure");
        rig.renderer().reconfigure(&by(way, SIZE)).expect("reconfigure");
        compare::same_color("whitewater-again", &cloud.draw(&mut rig).output, &expected);
    }
}

/// Bytes of the lists of large particles: 64 KiB and 16 bytes per chunk. A chunk is what one
/// binding holds, or what a dispatch with groups of 64 invocations can process.
pub fn lists(gpu: &Gpu, most: u32) -> f64 {
    let bound = (gpu.limits().max_storage_buffer_range - 256) / 12;
    f64::from(most.div_ceil(bound.min(64 * 65_535))) * (65_536.0 + 16.0)
}

#[test]
fn memory_is_by_the_pixel() {
    let gpu = Gpu::shared();
    let of = |most, way| {
        let size = extent(1280, 720);
        let whitewater = WhitewaterConfig::new(most).with(|it| it.splat = Some(way));
        let whitewater = (most > 1).then_some(whitewater);
        let renderer =
            Renderer::new(&gpu.context(1), &config(size).with(|it| it.whitewater = whitewater));
        let renderer = renderer.expect("a renderer");
        let memory = renderer.memory();
        // SAFETY: nothing was recorded.
        unsafe { renderer.destroy() };
        (memory.images + memory.buffers) as f64
    };
    let without = of(1, WhitewaterSplat::Compute);
    for way in ways(&gpu) {
        let a_pixel = if way == WhitewaterSplat::Raster { 100.0 } else { 88.0 };
        let goes = [
            (WhitewaterSplat::Raster, 0.0),
            (WhitewaterSplat::Compute, 2.0),
            (WhitewaterSplat::Compute64, 1.0),
        ];
        let goes = goes.iter().find(|(of, _)| *of == way).expect("one of them").1;
        let found = [2, 30_000_000].map(|most| of(most, way) - without);
        // The images cancel. A list has 64 KiB.
        let more = goes * (lists(&gpu, 30_000_000) - lists(&gpu, 2));
        let off = (found[1] - found[0] - more).abs();
        assert!(off < 32.0 * 1024.0, "{way:?}: {found:?}, {more} more were said");
        for (most, found) in [2, 30_000_000].into_iter().zip(found) {
            let said = a_pixel * 1280.0 * 720.0 + goes * lists(&gpu, most);
            let spare = 0.01 + gpu.padding(extent(1280, 720));
            assert!(
                (found - said).abs() < spare * said + 128.0 * 1024.0,
                "{way:?} {most}: {found}"
            );
        }
    }
}
