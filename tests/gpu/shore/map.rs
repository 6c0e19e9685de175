//! Compares pass `map`, the distances to a shore line, with the exact nearest seeds, the shore line
//! and closed forms.

use ash::vk;
use glam::{DVec2, Mat4, Vec3};
use whitewater::shore::{Area, Heights, MapMesh, ShoreMap, ShoreMapConfig, ShoreMapStep};
use whitewater::{Error, Slot, Triangles};

use super::Mapped;
use super::shoreline::heights;
use crate::reference::Image;
use crate::reference::shore::map::{Heights as Grid, Shore, difference};
use crate::support::device::Gpu;
use crate::support::host::{Data, HOST_WRITE};
use crate::support::rig::{extent, stream};
use crate::support::scenes::Random;
use crate::support::spy;

/// Texel size of the areas, in metres.
const TEXEL: f64 = 0.25;

fn area(size: u32) -> Area {
    let edge = TEXEL as f32 * size as f32;
    Area { up: [0.0, 1.0, 0.0], center: [3.0, -2.0], edge, level: 0.5, reach: edge }
}

fn middle(area: &Area) -> DVec2 {
    DVec2::new(f64::from(area.center[0]), f64::from(area.center[1]))
}

/// Islands and lakes: a sum of waves with decreasing height, whose shortest wavelength is
/// `shortest` metres.
fn islands(area: &Area, shortest: f64, seed: u64) -> impl Fn(DVec2) -> f64 {
    let mut random = Random(seed);
    let (edge, middle, level) = (f64::from(area.edge), middle(area), f64::from(area.level));
    let growth = (edge / shortest / 1.5).powf(1.0 / 39.0);
    let waves: Vec<_> = (0..40)
        .map(|i| {
            let k = 1.5 * growth.powi(i) / edge;
            let turn = std::f64::consts::TAU;
            let [at, phase] = [0; 2].map(|_| turn * f64::from(random.between(0.0, 1.0)));
            (DVec2::from_angle(at) * k * turn, phase, 1.0 / (k * edge))
        })
        .collect();
    move |at| {
        let p = at - middle;
        let rough: f64 = waves.iter().map(|(k, phase, h)| h * (k.dot(p) + phase).sin()).sum();
        level + 3.0 + 3.0 * rough - 60.0 * p.length_squared() / (edge * edge)
    }
}

fn grid(heights: &Image<f32>, area: &Area) -> Grid {
    Grid::new(heights.width, heights.height, area.level, &heights.data)
}

/// Where a texel has the nearest seed, its distance is the twin's. Jump flooding misses the nearest
/// seed for some texels; these must have a seed that is nearly as near.
#[test]
fn distances_are_those_to_the_nearest_seed() {
    let gpu = Gpu::shared();
    let (mut texels, mut missed) = (0_u32, 0_u32);
    for size in [64, 128] {
        let mut coasts = Mapped::new(&gpu, size);
        let area = area(size);
        for (shortest, seed) in [(6.0, 3), (2.0, 4), (1.4, 5)] {
            let heights = heights(&area, size, islands(&area, shortest, seed));
            coasts.image_step(&area, &heights, None);
            let found = coasts.distances();
            let grid = grid(&heights, &area);
            let expected = grid.map(&grid.seeds(), TEXEL).expect("a shore");
            let (mut own, mut most) = (0, 0.0_f64);
            for (found, expected) in found.data.iter().zip(&expected.values) {
                let found = f64::from(*found);
                texels += 1;
                if !expected.holds(found) {
                    own += 1;
                    assert_eq!(found < 0.0, expected.value < 0.0, "land and sea");
                    most = most.max((found - expected.value).abs() / TEXEL);
                }
            }
            missed += own;
            // Distances to the exact line, of which seeds are samples.
            let line = Shore::new(&grid).distances(&grid, TEXEL);
            let to_line = difference(found.data.iter().map(|v| f64::from(*v)), &line);
            println!(
                "{size}, waves from {shortest} m: {own} texels have another seed, {most:.3} texels off; to the line {:.3} texels at most, {:.4} in the mean",
                to_line.most / TEXEL,
                to_line.mean / TEXEL
            );
            // A seed's segment of the line extends half a texel to both sides, so another seed may
            // be nearer to a point by that much. Jump flooding adds an error of less than a texel.
            assert!(most < 1.0, "{most} texels");
            assert!(to_line.most < 0.75 * TEXEL && to_line.mean < 0.15 * TEXEL);
        }
    }
    println!("{missed} of {texels} texels have another seed");
    assert!(200 * missed < texels, "{missed} of {texels}");
}

/// The distances of slanted straight lines and of circles.
#[test]
fn circles_and_lines_are_as_far_as_they_are() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::new(&gpu, 128);
    let area = area(128);
    let from = middle(&area) + DVec2::new(0.3, -0.7);
    for angle in [0.4_f64, 1.9, 3.6] {
        let normal = DVec2::from_angle(angle);
        let line = |p: DVec2| (p - from).dot(normal);
        let level = f64::from(area.level);
        coasts.image_step(&area, &heights(&area, 128, |p| level + 0.3 * line(p)), None);
        let corner = DVec2::from(area.corner(128).map(f64::from));
        let off = |(i, found): (usize, &f32)| {
            let at = corner + TEXEL * DVec2::new((i % 128) as f64 + 0.5, (i / 128) as f64 + 0.5);
            // The map has seeds for the lines in it alone.
            let foot = (at - line(at) * normal - corner) / TEXEL;
            let inside = foot.cmpgt(DVec2::ONE).all() && foot.cmplt(DVec2::splat(127.0)).all();
            inside.then(|| (f64::from(*found) - line(at)).abs() / TEXEL)
        };
        let found = coasts.distances();
        let all: Vec<_> = found.data.iter().enumerate().filter_map(off).collect();
        let most = all.iter().copied().fold(0.0, f64::max);
        println!("line at {angle}: {most:.4} texels at most, of {}", all.len());
        assert!(all.len() > 128 * 128 / 4, "{} texels", all.len());
        // A seed lies between two centres of texels, and is rounded to sixteenths of a texel along
        // that axis. The place itself has some roundings of 128 texels.
        assert!(most < 1.0 / 32.0 + 1.0e-3, "line at {angle}: {most} texels");
    }
    for (radius, bounds) in [(10.0, [0.06, 0.03]), (3.0, [0.07, 0.03]), (0.625, [0.25, 0.1])] {
        let circle = |p: DVec2| radius - p.distance(from);
        let level = f64::from(area.level);
        let heights = heights(&area, 128, |p| level + 0.3 * circle(p));
        coasts.image_step(&area, &heights, None);
        let found = coasts.distances();
        let corner = DVec2::from(area.corner(128).map(f64::from));
        let (mut most, mut mean) = (0.0_f64, 0.0);
        for (i, found) in found.data.iter().enumerate() {
            let at = corner + TEXEL * DVec2::new((i % 128) as f64 + 0.5, (i / 128) as f64 + 0.5);
            let off = (f64::from(*found) - circle(at)).abs() / TEXEL;
            (most, mean) = (most.max(off), mean + off / (128.0 * 128.0));
        }
        println!("circle of {radius} m: {most:.4} texels at most, {mean:.4} in the mean");
        // Seed positions are rounded to sixteenths of a texel, an error of 1/32 along each axis,
        // 0.044 in all. A chord of one texel adds 1/8r, with r in texels.
        let chord = TEXEL / (8.0 * radius);
        assert!(most < bounds[0] + chord && mean < bounds[1] + chord, "{most} {mean}");
    }
}

/// A mesh with a vertex at the middle of each texel, continued flat beyond the map's edge.
pub struct Mesh {
    positions: Data,
    indices: Data,
    counts: [u32; 2],
}

impl Mesh {
    fn new(coasts: &Mapped<'_>, positions: &[[f32; 3]], indices: &[u32]) -> Self {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        Self {
            positions: coasts.stub.data(bytemuck::cast_slice(positions), usage),
            indices: coasts.stub.data(bytemuck::cast_slice(indices), usage),
            counts: [positions.len() as u32, indices.len() as u32],
        }
    }

    pub fn of(coasts: &Mapped<'_>, area: &Area, height: impl Fn(DVec2) -> f64) -> Self {
        let n = coasts.size as usize + 2;
        let corner = DVec2::from(area.corner(coasts.size).map(f64::from));
        let texel = f64::from(area.edge) / f64::from(coasts.size);
        let place = |i: usize| {
            let at = DVec2::new((i % n) as f64 - 0.5, (i / n) as f64 - 0.5);
            let at = corner + texel * at;
            [at.x as f32, height(at) as f32, at.y as f32]
        };
        let positions: Vec<_> = (0..n * n).map(place).collect();
        let mut indices = Vec::new();
        for y in 0..n as u32 - 1 {
            for x in 0..n as u32 - 1 {
                let i = y * n as u32 + x;
                let n = n as u32;
                indices.extend([i, i + 1, i + n, i + n, i + 1, i + n + 1]);
            }
        }
        Self::new(coasts, &positions, &indices)
    }

    pub fn mesh(&self, transform: Mat4) -> MapMesh {
        let [vertices, indices] = self.counts;
        let triangles = Triangles {
            positions: stream(&self.positions, 0, 12),
            vertices,
            indices: Some((stream(&self.indices, 0, 4), indices)),
        };
        MapMesh { triangles, transform: transform.to_cols_array_2d() }
    }
}

/// The max and the mean difference of two maps, in texels.
fn apart(a: &Image<f32>, b: &Image<f32>) -> [f64; 2] {
    let expected: Vec<_> = b.data.iter().map(|v| f64::from(*v)).collect();
    let off = difference(a.data.iter().map(|v| f64::from(*v)), &expected);
    [off.most / TEXEL, off.mean / TEXEL]
}

/// Heights of a mesh err by the snapping of its vertices and the rounding of depths. Seeds move by
/// that error over the slope, and by a sixteenth of a texel where rounding changes.
#[test]
fn a_mesh_gives_what_its_heights_give() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::new(&gpu, 128);
    let area = area(128);
    let from = middle(&area) + DVec2::new(0.3, -0.7);
    let level = f64::from(area.level);
    let height = |p: DVec2| level + 0.3 * (9.0 - p.distance(from));
    coasts.image_step(&area, &heights(&area, 128, height), None);
    let expected = coasts.distances();
    // The whole mesh, and two meshes of which one has a transform and the other is under water.
    let whole = Mesh::of(&coasts, &area, height);
    let turn = Mat4::from_rotation_y(0.7) * Mat4::from_translation(Vec3::new(3.0, -1.0, 2.0));
    let back = turn.inverse();
    let far: Vec<[f32; 3]> = whole
        .positions
        .bytes()
        .chunks_exact(12)
        .map(|c| {
            let at: [f32; 3] = bytemuck::pod_read_unaligned(c);
            back.transform_point3(Vec3::from(at)).to_array()
        })
        .collect();
    let order: Vec<u32> =
        whole.indices.bytes().chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
    let moved = Mesh::new(&coasts, &far, &order);
    let low = Mesh::of(&coasts, &area, |p| height(p) - 2.0);
    for (name, meshes) in [
        ("one", vec![whole.mesh(Mat4::IDENTITY)]),
        ("turned", vec![moved.mesh(turn)]),
        ("over another", vec![low.mesh(Mat4::IDENTITY), whole.mesh(Mat4::IDENTITY)]),
    ] {
        coasts.step(&area, Heights::Meshes(&meshes), None);
        let [most, mean] = apart(&coasts.distances(), &expected);
        println!("{name}: {most:.4} texels at most, {mean:.5} in the mean");
        // Vertices are snapped to 2^-bits of a texel along each axis; depths are rounded to 2^-24
        // of twice the edge, which is divided by the slope and by a texel.
        let bits = f64::from(1_u32 << gpu.limits().sub_pixel_precision_bits);
        let depth = 8.0 * f64::from(area.edge) / (0.3 * TEXEL * f64::from(1 << 24));
        let off = 2.0 / bits + depth;
        assert!(most < off + 2.0_f64.sqrt() / 16.0 && mean < off, "{name}: {most} {mean}");
    }
    // Triangles with an invalid or missing vertex are not drawn.
    let mut broken: Vec<[f32; 3]> = vec![[-100.0, 9.0, -100.0], [100.0, 9.0, -100.0]];
    broken.extend([[f32::NAN, 9.0, 0.0], [0.0, f32::INFINITY, 100.0], [2.0e18, 0.0, 0.0]]);
    let broken =
        Mesh::new(&coasts, &broken, &[0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 77, 1, 0, u32::MAX]);
    let meshes = [whole.mesh(Mat4::IDENTITY), broken.mesh(Mat4::IDENTITY)];
    coasts.step(&area, Heights::Meshes(&[whole.mesh(Mat4::IDENTITY)]), None);
    let alone = coasts.distances();
    coasts.step(&area, Heights::Meshes(&meshes), None);
    assert_eq!(coasts.distances().data, alone.data);
    // Without any mesh everything is sea.
    coasts.step(&area, Heights::Meshes(&[]), None);
    assert!(coasts.distances().data.iter().all(|v| *v <= -area.edge));
}

/// Updating only the changed part gives the same map as computing all of it, up to the reach.
#[test]
fn a_part_made_anew_is_as_the_whole() {
    let gpu = Gpu::shared();
    let (mut coasts, mut fresh) = (Mapped::new(&gpu, 128), Mapped::new(&gpu, 128));
    let area = Area { reach: 3.0, ..area(128) };
    let islands = islands(&area, 3.0, 9);
    let level = f64::from(area.level);
    // A rock moves onto the land, into the sea and beyond the map.
    let rock = |at: DVec2| move |p: DVec2| level + 1.5 - 2.0 * p.distance(at);
    let places = [[0.0, 0.0], [0.4, 0.3], [-9.0, 5.0], [12.9, -17.0], [14.0, 20.0], [3.0, -2.0]];
    let mut before: Option<DVec2> = None;
    for meshes in [false, true] {
        for place in places {
            let at = DVec2::from(place);
            let height = |p: DVec2| islands(p).max(rock(at)(p));
            let changed = before.map(|before| {
                let (least, most) = (at.min(before) - 1.0, at.max(before) + 1.0);
                [least.as_vec2().to_array(), most.as_vec2().to_array()]
            });
            for (coasts, changed) in [(&mut coasts, changed), (&mut fresh, None)] {
                if meshes {
                    let mesh = Mesh::of(coasts, &area, height);
                    coasts.step(&area, Heights::Meshes(&[mesh.mesh(Mat4::IDENTITY)]), changed);
                } else {
                    coasts.image_step(&area, &heights(&area, 128, height), changed);
                }
            }
            let (found, expected) = (coasts.distances(), fresh.distances());
            let mut within = 0;
            for (i, (a, b)) in found.data.iter().zip(&expected.data).enumerate() {
                if b.abs() < area.reach || a.abs() < area.reach {
                    within += 1;
                    assert_eq!(a, b, "{place:?}, meshes {meshes}: ({}, {})", i % 128, i / 128);
                }
            }
            assert!(within > 2000, "{within} texels");
            before = Some(at);
        }
    }
}

/// A map that follows a moving centre: moves within a texel change nothing, larger moves shift the
/// map by whole texels.
#[test]
fn a_map_that_follows_shows_the_same() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::new(&gpu, 128);
    let area = Area { reach: 3.0, ..area(128) };
    let islands = islands(&area, 3.0, 9);
    let mut at = |center: [f32; 2]| {
        let area = Area { center, ..area };
        coasts.image_step(&area, &heights(&area, 128, &islands), None);
        (area.corner(128), coasts.distances())
    };
    let (corner, first) = at(area.center);
    let [x, y] = area.center;
    let (same, within) = at([x + 0.1, y - 0.1]);
    assert_eq!(corner, same);
    assert_eq!(first.data, within.data);
    let (moved, other) = at([x + 5.0 * TEXEL as f32, y - 3.0 * TEXEL as f32]);
    let by = [0, 1].map(|i| f64::from(moved[i] - corner[i]) / TEXEL);
    assert_eq!(by, [5.0, -3.0]);
    let (mut seen, mut missed) = (0, 0);
    // Texels away from the borders, beyond which heights are unknown.
    for j in 16..112_usize {
        for i in 16..107_usize {
            let (a, b) = (first.at(i + 5, j), other.at(i, j + 3));
            if a.abs() < area.reach && b.abs() < area.reach {
                seen += 1;
                missed += u32::from(a != b);
                assert!((a - b).abs() < TEXEL as f32, "({i}, {j}): {a} {b}");
            }
        }
    }
    println!("{missed} of {seen} texels have another seed after a move");
    assert!(seen > 3000 && 100 * missed < seen, "{missed} of {seen}");
}

#[test]
fn land_alone_sea_alone_and_no_numbers() {
    let gpu = Gpu::shared();
    for size in [16, 64] {
        let mut coasts = Mapped::new(&gpu, size);
        let area = area(size);
        let level = f64::from(area.level);
        for sign in [-1.0, 1.0] {
            coasts.image_step(&area, &heights(&area, size, |_| level + sign), None);
            let most = 2.0 * area.edge;
            assert!(coasts.distances().data.iter().all(|v| *v == sign as f32 * most));
        }
        // Ground exactly at the water's level is sea.
        coasts.image_step(&area, &heights(&area, size, |_| level), None);
        assert!(coasts.distances().data.iter().all(|v| *v == -2.0 * area.edge));
        // Beside land the line passes through the first texel centres at the water's level.
        let [x0, _] = area.corner(size).map(f64::from);
        let half = |p: DVec2| level + f64::from(u8::from(p.x > x0 + 5.0 * TEXEL));
        coasts.image_step(&area, &heights(&area, size, half), None);
        for (i, found) in coasts.distances().data.iter().enumerate() {
            let expected = TEXEL * ((i % size as usize) as f64 - 4.0);
            assert!((f64::from(*found) - expected).abs() < 1.0e-5 * expected.abs().max(1.0), "{i}");
        }
        // Invalid heights are sea: a hole in the land that begins at their texels.
        let mut holed = heights(&area, size, |_| level + 1.0);
        for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1.0e30].into_iter().enumerate()
        {
            *holed.at_mut(5 + i, 7) = bad;
        }
        coasts.image_step(&area, &holed, None);
        let found = coasts.distances();
        for (i, found) in found.data.iter().enumerate() {
            let (x, y) = (i % size as usize, i / size as usize);
            let hole = (5..9).contains(&x) && y == 7;
            assert_eq!(*found < 0.0, hole, "({x}, {y}): {found}");
            assert!(found.is_finite() && found.abs() < 2.0 * area.edge);
        }
    }
}

/// Heights of an image of another size, or of a part of an image, are interpolated.
#[test]
fn an_image_of_any_size_is_taken_in_between() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::new(&gpu, 64);
    let area = area(64);
    let islands = islands(&area, 6.0, 3);
    let coarse = heights(&area, 32, &islands);
    let between = Image::from_fn(64, 64, |x, y| {
        let at = |i: usize| (i as f64 + 0.5) * 0.5;
        let corners = coarse.map(|h| f64::from(*h)).bilinear(DVec2::new(at(x), at(y)));
        let sum = corners.iter().map(|(i, j, w)| w * f64::from(coarse.clamped(*i, *j)));
        sum.sum::<f64>() as f32
    });
    coasts.image_step(&area, &between, None);
    let expected = coasts.distances();
    coasts.image_step(&area, &coarse, None);
    let [most, _] = apart(&coasts.distances(), &expected);
    assert!(most < 0.1, "{most} texels");
    let mut around = Image::new(40, 37, 77.0_f32);
    for y in 0..32 {
        for x in 0..32 {
            *around.at_mut(x + 5, y + 3) = coarse.at(x, y);
        }
    }
    let image = coasts.image(&around);
    let offset = vk::Offset2D { x: 5, y: 3 };
    let rect = vk::Rect2D { offset, extent: extent(32, 32) };
    let image = image.host_image().with(|it| it.rect = rect);
    coasts.image_step(&area, &coarse, None);
    let whole = coasts.distances();
    coasts.step(&area, Heights::Image(image), None);
    assert_eq!(coasts.distances().data, whole.data);
}

/// Two steps are submitted before the first is waited for, repeatedly. Each slot has its own data,
/// and both write the same map.
#[test]
fn steps_of_two_slots_in_flight() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::with_slots(&gpu, 64, 2);
    let area = area(64);
    let islands = [3, 4].map(|seed| heights(&area, 64, islands(&area, 4.0, seed)));
    let images = islands.each_ref().map(|image| coasts.image(image));
    let expected = islands.each_ref().map(|image| {
        coasts.image_step(&area, image, None);
        coasts.distances()
    });
    for round in 0..3 {
        for slot in 0..2_u32 {
            let heights = Heights::Image(images[slot as usize].host_image());
            let (before, after) = (HOST_WRITE, HOST_WRITE);
            let step = ShoreMapStep::new(Slot(slot), area, heights).with(|it| {
                it.before = before;
                it.after = after;
            });
            let cmd = coasts.stub.begin(slot);
            let map = coasts.map.as_mut().expect("only drop takes it");
            // SAFETY: the slot was waited for, and the image lives until the end of this function.
            unsafe { map.record_step(cmd, &step) }.expect("a step");
            coasts.stub.end(slot);
        }
        (0..2).for_each(|slot| coasts.stub.wait(slot));
        assert_eq!(coasts.distances().data, expected[1].data, "{round}: the last is seen");
    }
    assert!(coasts.map.as_mut().is_some_and(|map| map.timings(Slot(1)).len() == 1));
}

/// Result of `ShoreMap::shore_distances`, as text.
fn known(coasts: &Mapped<'_>) -> String {
    let map = coasts.map.as_ref().expect("only drop takes it");
    format!("{:?}", map.shore_distances())
}

/// Records a step whose commands are never submitted.
fn discarded(
    coasts: &mut Mapped<'_>,
    slot: u32,
    area: &Area,
    heights: Heights<'_>,
) -> Result<(), Error> {
    let step = ShoreMapStep::new(Slot(slot), *area, heights).with(|it| {
        it.before = HOST_WRITE;
        it.after = HOST_WRITE;
    });
    let cmd = coasts.stub.begin(slot);
    let map = coasts.map.as_mut().expect("only drop takes it");
    // SAFETY: cmd is recording and never submitted.
    unsafe { map.record_step(cmd, &step) }
}

fn abandon(coasts: &mut Mapped<'_>, slot: u32) {
    coasts.map.as_mut().expect("only drop takes it").abandon(Slot(slot));
}

/// An area with a small reach, the area beside it, and a rectangle around all rocks.
fn rocky() -> (Area, Area, Option<[[f32; 2]; 2]>) {
    let area = Area { reach: 3.0, ..area(64) };
    let beside = Area { center: [5.0, -2.0], ..area };
    (area, beside, Some([[-3.0, -4.0], [9.0, 0.0]]))
}

/// Heights of a small rock at this x.
fn rock(area: &Area, x: f64) -> impl Fn(DVec2) -> f64 {
    let level = f64::from(area.level);
    move |at| level + 1.5 - 2.0 * at.distance(DVec2::new(x, -2.0))
}

fn assert_same(name: &str, found: &Image<f32>, expected: &Image<f32>, reach: f32) {
    let mut within = 0;
    for (i, (a, b)) in found.data.iter().zip(&expected.data).enumerate() {
        if a.abs() < reach || b.abs() < reach {
            within += 1;
            assert_eq!(a, b, "{name}: ({}, {})", i % found.width, i / found.width);
        }
    }
    assert!(within > 200, "{name}: {within} texels");
}

/// A step whose commands were thrown away leaves the map unchanged: the first one leaves none, and
/// later ones neither another area nor heights of meshes that were never drawn.
#[test]
fn an_abandoned_step_leaves_the_map_before_it() {
    let gpu = Gpu::shared();
    let (mut coasts, mut fresh) = (Mapped::with_slots(&gpu, 64, 2), Mapped::new(&gpu, 64));
    let (area, beside, changed) = rocky();
    let texture = coasts.image(&heights(&area, 64, rock(&area, 0.0)));
    let image = Heights::Image(texture.host_image());
    discarded(&mut coasts, 0, &area, image).expect("a step");
    assert_ne!(known(&coasts), "None");
    abandon(&mut coasts, 1);
    assert_ne!(known(&coasts), "None", "the step is of another slot");
    abandon(&mut coasts, 0);
    assert_eq!(known(&coasts), "None", "the first step was never submitted");
    coasts.step(&area, image, None);
    fresh.step(&area, image, None);
    assert_same("first", &coasts.distances(), &fresh.distances(), area.reach);
    let before = known(&coasts);

    let meshes = [4.0, 5.0].map(|x| Mesh::of(&coasts, &area, rock(&area, x)));
    let [mesh, other] = meshes.each_ref().map(|mesh| [mesh.mesh(Mat4::IDENTITY)]);
    for (area, land) in [(&beside, image), (&area, Heights::Meshes(&mesh))] {
        discarded(&mut coasts, 1, area, land).expect("a step");
        // The second call has no effect.
        (0..2).for_each(|_| abandon(&mut coasts, 1));
        assert_eq!(known(&coasts), before);
    }
    coasts.step(&area, Heights::Meshes(&other), changed);
    fresh.step(&area, Heights::Meshes(&other), None);
    assert_same("meshes", &coasts.distances(), &fresh.distances(), area.reach);

    // A refused step records nothing, so the step before it can still be taken back.
    discarded(&mut coasts, 0, &beside, image).expect("a step");
    assert_ne!(known(&coasts), before);
    let refused = discarded(&mut coasts, 1, &Area { edge: 0.0, ..area }, image);
    assert!(matches!(refused, Err(Error::BadInput { field: "Area.edge", .. })), "{refused:?}");
    abandon(&mut coasts, 0);
    assert_eq!(known(&coasts), before);
}

/// After a failed step there is no map, and after `abandon` there is again the one before.
#[test]
fn a_failed_step_can_be_taken_back() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let (mut coasts, mut fresh) = (Mapped::new(&gpu, 64), Mapped::new(&gpu, 64));
    let (area, beside, changed) = rocky();
    let [first, next] = [0.0, 2.0].map(|x| coasts.image(&heights(&area, 64, rock(&area, x))));
    let [first, next] = [&first, &next].map(|image| Heights::Image(image.host_image()));
    coasts.step(&area, first, None);
    let before = known(&coasts);
    for (function, nth) in
        [(&spy::RESET_DESCRIPTOR_POOL, 1), (&spy::ALLOCATE_SETS, 1), (&spy::ALLOCATE_SETS, 4)]
    {
        spy::reset();
        function.fail(nth, vk::Result::ERROR_DEVICE_LOST);
        let result = discarded(&mut coasts, 0, &beside, first);
        spy::reset();
        let lost = result.is_err_and(|error| error.is_device_lost());
        assert!(lost, "{:?} call {nth}: no error", function.name);
        assert_eq!(known(&coasts), "None");
        abandon(&mut coasts, 0);
        assert_eq!(known(&coasts), before, "{:?} call {nth}", function.name);
    }
    coasts.step(&area, next, changed);
    fresh.step(&area, next, None);
    assert_same("after failures", &coasts.distances(), &fresh.distances(), area.reach);
}

#[test]
fn bad_maps_and_steps_name_their_field() {
    let gpu = Gpu::shared();
    for (field, size, max_meshes) in [
        ("ShoreMapConfig.size", 8, 1),
        ("ShoreMapConfig.size", 100, 1),
        ("ShoreMapConfig.size", 8192, 1),
        ("ShoreMapConfig.max_meshes", 64, 65_537),
    ] {
        let config = ShoreMapConfig::default().with(|it| {
            it.size = size;
            it.max_meshes = max_meshes;
        });
        let made = ShoreMap::new(&gpu.context(1), &config);
        match made {
            Err(Error::BadInput { field: found, why }) => {
                assert!(found == field && !why.is_empty())
            }
            _ => panic!("{field}: no error of it for {size}, {max_meshes}"),
        }
    }
    let mut coasts = Mapped::new(&gpu, 64);
    assert!(
        coasts.map.as_ref().is_some_and(|map| map.shore_distances().is_none()),
        "before a step"
    );
    assert!(coasts.map.as_ref().is_some_and(|map| map.memory() >= 16 * 64 * 64));
    let good = area(64);
    let image = coasts.image(&heights(&good, 64, |_| 0.0));
    let image = image.host_image();
    let mesh = Mesh::of(&coasts, &good, |_| 0.0);
    let meshes = [mesh.mesh(Mat4::IDENTITY); 5];
    let mut three = meshes[0];
    three.triangles.indices = three.triangles.indices.map(|(stream, n)| (stream, n - 1));
    let mut narrow = meshes[0];
    narrow.triangles.positions.stride = 8;
    let mut short = meshes[0];
    short.triangles.vertices = 1 << 24;
    let mut odd = meshes[0];
    odd.triangles.indices =
        odd.triangles.indices.map(|(stream, n)| (whitewater::Stream { offset: 2, ..stream }, n));
    let bent = mesh.mesh(Mat4::from_cols_array(&[f32::NAN; 16]));
    let nowhere = image.with(|it| it.rect = extent(65, 64).into());
    let mut refused = |field: &str, slot, area: &Area, heights: Heights<'_>, changed| {
        let (before, after) = (HOST_WRITE, HOST_WRITE);
        let step = ShoreMapStep::new(Slot(slot), *area, heights).with(|it| {
            it.changed = changed;
            it.before = before;
            it.after = after;
        });
        let map = coasts.map.as_mut().expect("only drop takes it");
        // SAFETY: a step with bad input uses no handle.
        let result = coasts.stub.run(|cmd| unsafe { map.record_step(cmd, &step) });
        match result {
            Err(Error::BadInput { field: found, why }) => {
                assert!(found == field && !why.is_empty(), "{field}: {found}: {why}");
            }
            other => panic!("{field}: {other:?}"),
        }
    };
    let heights = Heights::Image(image);
    for (field, area) in [
        ("Area.up", Area { up: [0.0, 2.0, 0.0], ..good }),
        ("Area.up", Area { up: [f32::NAN; 3], ..good }),
        ("Area.center[0]", Area { center: [f32::INFINITY, 0.0], ..good }),
        ("Area.center[1]", Area { center: [0.0, 2.0e9], ..good }),
        ("Area.edge", Area { edge: 0.0, ..good }),
        ("Area.level", Area { level: f32::NAN, ..good }),
        ("Area.reach", Area { reach: 0.0, ..good }),
        ("Area.reach", Area { reach: 2.0 * good.edge, ..good }),
    ] {
        refused(field, 0, &area, heights, None);
    }
    refused("ShoreMapStep.slot", 1, &good, heights, None);
    refused("ShoreMapStep.changed", 0, &good, heights, Some([[1.0, 0.0], [0.0, 1.0]]));
    refused("ShoreMapStep.changed", 0, &good, heights, Some([[f32::NAN, 0.0], [0.0, 1.0]]));
    refused("ShoreMapStep.heights", 0, &good, Heights::Meshes(&meshes), None);
    for (field, mesh) in &[
        ("MapMesh.triangles", three),
        ("MapMesh.triangles.positions", narrow),
        ("MapMesh.triangles.positions", short),
        ("MapMesh.triangles.indices", odd),
        ("MapMesh.transform", bent),
    ] {
        refused(field, 0, &good, Heights::Meshes(std::slice::from_ref(mesh)), None);
    }
    refused("ShoreMapStep.heights.rect", 0, &good, Heights::Image(nowhere), None);
    coasts.step(&good, heights, None);
}
