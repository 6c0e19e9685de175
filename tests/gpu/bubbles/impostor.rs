//! Compares the ray-casting of blob impostors with intersections of rays with all bubbles of a
//! blob.

use glam::{DVec3, Quat, Vec3};
use whitewater::bubbles::{Blob, BubbleConfig, BubbleSort, Impostor};
use whitewater::headless::Bubble;

use crate::reference::bubbles::impostor::{first, into_blob};
use crate::reference::classify::pcg;
use crate::reference::{Image, is_surface};
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, Soaped, config, extent};
use crate::support::scenes::{Lens, Random};

pub const NONE: u32 = 0xffff_ffff;

/// The bubbles of each template of a configuration.
pub fn templates(config: &BubbleConfig) -> Vec<Vec<[f32; 4]>> {
    (0..config.variants).map(|i| Blob::new(config.seed ^ pcg(i), config.bubbles).bubbles).collect()
}

/// A blob at `at` in eye space, with a random orientation.
pub fn blob(shot: &Shot, at: [f32; 3], radius: f32, id: u32, random: &mut Random) -> Bubble {
    let [x, y, z] = crate::support::scenes::world(&shot.camera, &[at])[0];
    let axis = Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 1.0).normalize();
    let turn = Quat::from_axis_angle(axis, random.between(0.0, 6.0));
    Bubble { ball: [x, y, z, radius], turn: turn.to_array(), id }
}

/// The eye in world space, and each pixel's ray, whose length is one unit of eye depth.
pub fn rays(shot: &Shot) -> (DVec3, Image<DVec3>) {
    let view = shot.view(shot.size);
    let back = view.view.inverse();
    let (width, height) = (shot.size.width as usize, shot.size.height as usize);
    let eye = back.transform_point3(DVec3::ZERO);
    let along = Image::from_fn(width, height, |x, y| {
        let slope = view.ray(x, y);
        back.transform_vector3(slope)
    });
    (eye, along)
}

/// Each pixel's hits by brute force: depth, index of the blob, index of the bubble; nearest first.
fn seen(shot: &Shot, bubbles: &BubbleConfig) -> Image<Vec<(f64, usize, usize)>> {
    let templates = templates(bubbles);
    let (eye, rays) = rays(shot);
    rays.map(|along| {
        let near = f64::from(crate::support::scenes::NEAR);
        let mut hits: Vec<_> = shot
            .blobs
            .iter()
            .enumerate()
            .filter_map(|(i, blob)| {
                let own = &templates[(pcg(blob.id) % bubbles.variants) as usize];
                let (origin, direction) = into_blob(blob.ball, blob.turn, eye, *along);
                let scale = f64::from(blob.ball[3]) / along.length();
                let (t, bubble) = first(own, origin, direction, near / scale)?;
                Some((t * scale, i, bubble))
            })
            .collect();
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        hits
    })
}

fn draw(gpu: &Gpu, shot: &Shot, bubbles: BubbleConfig) -> Soaped {
    let config = config(shot.size).with(|it| it.bubbles = Some(bubbles));
    Rig::lit(gpu, &config, 1).draw(shot).soap.expect("bubble foam")
}

/// Four numbers: the fraction of pixels with the right first bubble, the fraction of pixels where
/// only one of the two finds a bubble, the mean error of the depth in radii of the blob, and the
/// max error of pixels amid a bubble, whose eight neighbours show it too.
fn errors(found: &Soaped, expected: &Image<Vec<(f64, usize, usize)>>, radius: f64) -> [f64; 4] {
    let (mut right, mut missed, mut all) = (0, 0, 0);
    let (mut sum, mut worst, mut met) = (0.0, 0.0_f64, 0);
    for (i, hits) in expected.data.iter().enumerate() {
        let depth = f64::from(found.depth.data[i]);
        match hits.first() {
            None => missed += usize::from(is_surface(depth)),
            Some(&(there, _, bubble)) => {
                all += 1;
                if !is_surface(depth) {
                    missed += 1;
                    continue;
                }
                right += usize::from(found.layers[i][0] & 0xff == bubble as u32);
                let off = (depth - there).abs() / radius;
                (sum, met) = (sum + off, met + 1);
                let (x, y) = ((i % expected.width) as isize, (i / expected.width) as isize);
                let amid = (0..9).all(|k| {
                    let there = expected.clamped(x + k % 3 - 1, y + k / 3 - 1);
                    there.first().is_some_and(|hit| hit.2 == bubble)
                });
                worst = if amid { worst.max(off) } else { worst };
            }
        }
    }
    let part = |n: usize| n as f64 / f64::from(all);
    [part(right), part(missed), sum / f64::from(met), worst]
}

/// Both impostors with their default sizes and steps. A bench has other sizes and steps (plotted in
/// docs/bubble-foam.md).
#[test]
fn impostors_find_the_first_bubble() {
    let gpu = Gpu::shared();
    let size = extent(160, 160);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    let mut random = Random(9);
    let standard = BubbleConfig::new(1).with(|it| it.variants = 4);
    let distance = standard.with(|it| {
        it.impostor = Impostor::Distance;
        it.map_size = Impostor::Distance.map_size();
        it.steps = Impostor::Distance.steps();
    });
    let few = distance.with(|it| it.bubbles = 64);
    for (name, bubbles, bounds) in [
        // The eye is two radii from the blob, so the square under the hit's root errs by some 20u
        // of 4. One pixel inside the outline of a bubble of 0.2 radii the root is above 0.07.
        ("ids", standard, [0.9999, 0.0001, 1.0e-5, 1.0e-4]),
        ("distance", distance, [0.0, 0.006, 0.002, 1.0]),
        ("distance, 64 bubbles", few, [0.0, 0.006, 0.002, 1.0]),
    ] {
        for id in [0, 3, 8] {
            shot.blobs = vec![blob(&shot, [0.0, 0.0, 3.0], 1.4, id, &mut random)];
            let expected = seen(&shot, &bubbles);
            let found = draw(&gpu, &shot, bubbles);
            let [right, missed, mean, worst] = errors(&found, &expected, 1.4);
            println!(
                "{name}, {id}: right {right:.4}, missed {missed:.4}, depth {mean:.5} worst {worst:.6}"
            );
            assert!(
                right >= bounds[0] || bounds[0] == 0.0,
                "{name}: {right} of first bubbles are right"
            );
            assert!(missed <= bounds[1], "{name}: {missed} of the pixels are missed or too many");
            assert!(mean <= bounds[2], "{name}: depth is off by {mean} radii in the mean");
            assert!(worst <= bounds[3], "{name}: depth is off by {worst} radii amid a bubble");
        }
    }
}

/// A heap of blobs that overlap.
pub fn heap(shot: &Shot, count: u32) -> Vec<Bubble> {
    let mut random = Random(5);
    (0..count)
        .map(|id| {
            let at =
                [random.between(-1.5, 1.5), random.between(-1.0, 1.0), random.between(3.0, 7.0)];
            let radius = random.between(0.2, 0.9);
            blob(shot, at, radius, 7 * id + 1, &mut random)
        })
        .collect()
}

#[test]
fn layers_are_the_nearest_blobs_in_order() {
    let gpu = Gpu::shared();
    let size = extent(96, 80);
    for lens in [Lens::Standard, Lens::ReversedInfinite, Lens::OffAxis, Lens::LeftHanded] {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        shot.blobs = heap(&shot, 60);
        let bubbles = BubbleConfig::new(64).with(|it| {
            it.variants = 3;
            it.bubbles = 64;
            it.layers = 4;
        });
        let expected = seen(&shot, &bubbles);
        let found = draw(&gpu, &shot, bubbles);
        let (mut same, mut all) = (0, 0);
        for (layers, hits) in found.layers.iter().zip(&expected.data) {
            for (k, hit) in hits.iter().take(4).enumerate() {
                all += 1;
                same += usize::from(layers[k] != NONE && (layers[k] >> 8) as usize == hit.1);
            }
        }
        let part = same as f64 / f64::from(all as u32);
        println!("{lens:?}: {part:.4} of {all} layers are the right blob");
        assert!(all > 5000, "{all} layers");
        assert!(part > 0.99, "{lens:?}: {part} of the layers are the right blob");
    }
}

#[test]
fn the_order_of_blobs_is_no_matter() {
    let gpu = Gpu::shared();
    let size = extent(96, 80);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    shot.blobs = heap(&shot, 60);
    let bubbles = BubbleConfig::new(64).with(|it| {
        it.variants = 3;
        it.bubbles = 64;
    });
    let one = draw(&gpu, &shot, bubbles);
    let mut random = Random(3);
    let order = random.order(shot.blobs.len());
    shot.blobs = order.iter().map(|i| shot.blobs[*i]).collect();
    let other = draw(&gpu, &shot, bubbles);
    assert!(one.depth.data.iter().any(|z| is_surface((*z).into())));
    assert_eq!(one.depth.data, other.depth.data);
    assert_eq!(one.color.data, other.color.data);
}

#[test]
fn what_is_no_blob_is_not_drawn_and_none_changes_nothing() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    let bubbles = BubbleConfig::new(16).with(|it| {
        it.variants = 2;
        it.bubbles = 64;
    });
    let config = config(size).with(|it| it.bubbles = Some(bubbles));
    let mut rig = Rig::lit(&gpu, &config, 1);
    let none = rig.draw(&shot);
    assert_eq!(none.output.data, shot.color);
    let mut random = Random(2);
    let good = blob(&shot, [0.0, 0.0, 4.0], 0.5, 1, &mut random);
    let [x, y, z, r] = good.ball;
    let bad = [
        [f32::NAN, y, z, r],
        [x, f32::INFINITY, z, r],
        [x, y, z, 0.0],
        [x, y, z, -1.0],
        [x, y, z, f32::NAN],
    ];
    shot.blobs = bad.map(|ball| Bubble { ball, ..good }).to_vec();
    // Blobs behind the eye and beside the view.
    shot.blobs.push(blob(&shot, [0.0, 0.0, -4.0], 0.5, 1, &mut random));
    shot.blobs.push(blob(&shot, [30.0, 0.0, 4.0], 0.5, 1, &mut random));
    let nothing = rig.draw(&shot);
    assert_eq!(nothing.output.data, shot.color);
    let [_, _, seen, dropped, taken] = nothing.soap.expect("bubble foam").range;
    // A radius of 0 is an empty entry and no error.
    assert_eq!([seen, dropped, taken], [0, 4, 0], "on the screen, no balls, in lists");
    // A turn of 0 counts as no rotation.
    shot.blobs = vec![Bubble { turn: [0.0; 4], ..good }];
    let still = rig.draw(&shot);
    let [nearest, farthest, seen, dropped, taken] = still.soap.as_ref().expect("bubble foam").range;
    let [nearest, farthest] = [nearest, farthest].map(f32::from_bits);
    assert!((nearest - 3.5).abs() < 1.0e-4 && (farthest - nearest).abs() < 1.0e-4);
    assert!(
        [seen, dropped] == [1, 0] && taken > 0,
        "{seen} seen, {dropped} dropped, {taken} places"
    );
    shot.blobs = vec![Bubble { turn: [0.0, 0.0, 0.0, 2.0], ..good }];
    assert_eq!(rig.draw(&shot).output.data, still.output.data);
    assert_ne!(still.output.data, shot.color);
    // A scene in front of the blob hides it.
    shot.scene_depth(|x, _| (x < 32).then_some(2.0));
    let half = rig.draw(&shot).soap.expect("bubble foam");
    for (i, z) in half.depth.data.iter().enumerate() {
        assert!(i % 64 >= 32 || !is_surface((*z).into()), "a blob before the scene at {i}");
    }
    assert!(half.depth.data.iter().any(|z| is_surface((*z).into())));
}

/// Billboards find the same layers as the tiles. Blended opacities have half precision.
#[test]
fn billboards_find_what_the_tiles_do() {
    let gpu = Gpu::shared();
    let size = extent(96, 80);
    for (lens, layers) in [(Lens::Standard, 1), (Lens::ReversedInfinite, 3), (Lens::LeftHanded, 4)]
    {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        shot.blobs = heap(&shot, 60);
        let tiles = BubbleConfig::new(64).with(|it| {
            it.variants = 3;
            it.bubbles = 64;
            it.layers = layers;
        });
        let one = draw(&gpu, &shot, tiles);
        let other = draw(&gpu, &shot, tiles.with(|it| it.sort = BubbleSort::Peel));
        let (mut differ, mut all, mut off) = (0, 0, 0);
        for (a, b) in one.layers.iter().zip(&other.layers) {
            let last = layers as usize;
            for k in 0..last {
                all += usize::from(a[k] != NONE || b[k] != NONE);
                differ += usize::from(a[k] != b[k]);
            }
            // Tiles also stop when all layers are found and hide what is behind them.
            let [x, y] = [a, b].map(|words| f32::from_bits(words[last]));
            let ended = a[last - 1] != NONE && y > x;
            assert!((x - y).abs() < 1.0 / 1024.0 || ended, "opacity {x} and {y}");
        }
        for (a, b) in one.color.data.iter().zip(&other.color.data) {
            // What is behind may still have a weight of 1/256; colours have half precision.
            off += usize::from((0..4).any(|c| (a[c] - b[c]).abs() > (1.0 + a[c]) / 200.0));
        }
        assert!(off <= 2 * differ, "{off} pixels differ, {differ} layers");
        // Layers may differ at equal depths, and at edges where two compilations of a shader round
        // differently.
        let part = differ as f64 / f64::from(all as u32);
        println!("{lens:?}: {differ} of {all} layers differ");
        assert!(all > 1000 && part < 0.002, "{lens:?}: {differ} of {all} layers differ");
    }
}

/// Of several blobs at exactly one depth all become layers, the one with the lower index first; the
/// blob behind them follows.
#[test]
fn blobs_at_one_depth_are_all_layers() {
    let gpu = Gpu::shared();
    let mut shot = Shot::new(extent(64, 56), Lens::Standard, 0.1, &[]);
    let one = blob(&shot, [0.0, 0.0, 4.0], 1.0, 0, &mut Random(5));
    let behind = blob(&shot, [0.0, 0.0, 7.0], 1.0, 0, &mut Random(6));
    shot.blobs = vec![one, behind, one, Bubble { id: 9, ..one }];
    let tiles = BubbleConfig::new(8).with(|it| {
        it.variants = 1;
        it.bubbles = 64;
        it.layers = 5;
    });
    for sort in [BubbleSort::Tiles, BubbleSort::Peel] {
        let found = draw(&gpu, &shot, tiles.with(|it| it.sort = sort));
        let order = |words: &Vec<u32>| -> Vec<u32> {
            words[..5].iter().take_while(|word| **word != NONE).map(|word| word >> 8).collect()
        };
        let orders: Vec<_> = found.layers.iter().map(order).collect();
        let [three, four] = [&[0, 2, 3][..], &[0, 2, 3, 1]]
            .map(|blobs| orders.iter().filter(|order| order.as_slice() == blobs).count());
        let others = orders.iter().filter(|order| order.as_slice() == [1]).count();
        let none = orders.iter().filter(|order| order.is_empty()).count();
        println!("{sort:?}: {three} pixels show three blobs, {four} four, {others} one");
        assert_eq!(three + four + others + none, 64 * 56, "{sort:?}: another order");
        assert!(three > 200 && four > 80, "{sort:?}: {three} and {four}");
    }
}
