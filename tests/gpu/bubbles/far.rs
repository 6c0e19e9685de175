//! Blobs too small to be seen one by one: which of them are kept, and their combined look.

use glam::DVec3;
use whitewater::bubbles::BubbleConfig;
use whitewater::headless::Bubble;

use super::impostor::blob;
use crate::reference::bubbles::merge::{order, scale};
use crate::reference::is_surface;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::{Lens, Random};

/// Allowed deviation of a mean, in standard errors.
const RARE: f64 = 5.0;

/// The kept blobs cover as much as all of them would. None of them is small, and each changes only
/// a little from distance to distance.
#[test]
fn what_is_left_covers_as_much() {
    let ids: Vec<u32> = (0..40_000).map(|i| 3 * i + 1).collect();
    for merge in [1.0, 4.0] {
        for part in [1.5, 1.0, 0.95, 0.7, 0.4, 0.1, 0.03] {
            let pixels = part * merge;
            let scales: Vec<f64> = ids.iter().map(|id| scale(pixels, merge, *id)).collect();
            let squares = scales.iter().map(|s| s * s);
            let count = ids.len() as f64;
            let mean = squares.clone().sum::<f64>() / count;
            let spread = (squares.map(|s| (s - mean).powi(2)).sum::<f64>() / count).sqrt();
            assert!((mean - 1.0).abs() <= RARE * spread / count.sqrt(), "{part}: {mean}");
            let largest = scales.iter().copied().fold(0.0, f64::max);
            assert!(pixels * largest >= 0.92 * merge.min(pixels), "{part}: {largest}");
        }
    }
    for id in &ids[..200] {
        for i in 0..400 {
            let pixels = |i: u32| 0.99_f64.powf(f64::from(i));
            let [near, far] = [i, i + 1].map(|i| pixels(i) * scale(pixels(i), 1.0, *id));
            // From one distance to the next the kept fraction falls by a fiftieth. A blob shrinks
            // while its number is between 1 and 1.5 times the fraction, within half of the
            // fraction, and is about a pixel large.
            assert!((near - far).abs() < 0.02 * 1.5 / 0.5 + 0.01, "{id}: {near} and {far} at {i}");
        }
    }
}

/// Blobs of one size, each at another distance.
fn cloud(shot: &Shot, radius: f32) -> Vec<Bubble> {
    let mut random = Random(9);
    let mut one = |i: u32| {
        let z = 2.0 + 0.05 * i as f32;
        let at = [z * random.between(-0.4, 0.4), z * random.between(-0.3, 0.3), z];
        blob(shot, at, radius, 5 * i + 2, &mut random)
    };
    (0..250).map(&mut one).collect()
}

#[test]
fn those_left_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(96, 80);
    let bubbles = BubbleConfig::new(256).with(|it| {
        it.variants = 2;
        it.bubbles = 28;
        it.map_size = 64;
    });
    let config = config(size).with(|it| it.bubbles = Some(bubbles));
    let mut rig = Rig::lit(&gpu, &config, 1);
    for (lens, merge) in [(Lens::Standard, 1.0), (Lens::OffAxis, 1.1)] {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        shot.blobs = cloud(&shot, 0.06);
        let view = shot.view(size);
        shot.settings.bubbles.min_pixels = merge;
        let found = rig.draw(&shot).soap.expect("bubble foam");
        let (mut gone, mut grown) = (0, 0);
        let all = shot.blobs.len();
        shot.blobs.retain_mut(|blob| {
            let [x, y, z, r] = blob.ball.map(f64::from);
            let far = view.view.transform_point3(DVec3::new(x, y, z)).length();
            let scale = scale(r / (far * view.c_x()), merge.into(), blob.id);
            blob.ball[3] = (r * scale) as f32;
            gone += usize::from(scale == 0.0);
            grown += usize::from(scale > 1.1);
            scale > 0.0
        });
        assert!(gone > 40 && grown > 40, "{gone} gone and {grown} grown of {all}");
        shot.settings.bubbles.min_pixels = 0.0;
        let expected = rig.draw(&shot).soap.expect("bubble foam");
        let same = |a: f32, b: f32| {
            is_surface(a.into()) == is_surface(b.into())
                && (!is_surface(a.into()) || (a - b).abs() < 1.0e-3 * b)
        };
        let pairs = found.depth.data.iter().zip(&expected.depth.data);
        let off = pairs.filter(|(a, b)| !same(**a, **b)).count();
        let there = expected.depth.data.iter().filter(|z| is_surface((**z).into())).count();
        println!("{lens:?}: {gone} gone, {grown} grown of {all}; {off} of {there} pixels off");
        // Radii differ by rounding, so a pixel at an outline or between two bubbles may show the
        // other bubble.
        assert!(there > 250 && 200 * off <= there, "{off} of {there} pixels");
        assert!(found.range[2] <= expected.range[2], "{:?} and {:?}", found.range, expected.range);
    }
    assert_ne!(order(1), order(2));
}

/// A wall of foam across the whole view, of blobs with this radius.
fn wall(shot: &Shot, radius: f32) -> Vec<Bubble> {
    let mut random = Random(4);
    let apart = 1.2 * radius;
    let row = (2.0 / apart) as i32;
    let places = (-row..=row).flat_map(|y| (-row..=row).map(move |x| (x, y)));
    let all: Vec<_> = places.flat_map(|at| [0, 1].map(|layer| (at, layer))).collect();
    all.into_iter()
        .enumerate()
        .map(|(i, ((x, y), layer))| {
            let mut off = || 0.3 * apart * random.between(-1.0, 1.0);
            let at = [
                apart * x as f32 + off(),
                apart * y as f32 + off(),
                3.0 + apart * layer as f32 + off(),
            ];
            blob(shot, at, radius, i as u32, &mut random)
        })
        .collect()
}

/// Where blobs are smaller than pixels, each pixel shows their mean: the foam does not sparkle, and
/// its brightness does not depend on the distance.
#[test]
fn far_foam_is_even_and_as_bright_as_near_foam() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let bubbles = BubbleConfig::new(65_536).with(|it| {
        it.variants = 4;
        it.bubbles = 64;
        it.map_size = 64;
    });
    let config = config(size).with(|it| it.bubbles = Some(bubbles));
    let mut rig = Rig::with_slots(&gpu, &config, 1);
    rig.environment(extent(16, 8), &[[0.5, 0.5, 0.5, 1.0]; 128]);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    shot.settings.light.shade = shot.settings.light.irradiance;
    shot.settings.light.color = [0.0; 3];
    let texel = shot.view(size).c_x() as f32;
    let mut shown = |pixels: f32, merge: f32| {
        shot.blobs = wall(&shot, 3.0 * texel * pixels);
        shot.settings.bubbles.min_pixels = merge;
        let soap = rig.draw(&shot).soap.expect("bubble foam");
        let inner: Vec<[f32; 4]> =
            soap.color.data.iter().copied().filter(|c| c[3] > 0.999).collect();
        let count = inner.len() as f32;
        let mean = [0, 1, 2].map(|c| inner.iter().map(|v| v[c]).sum::<f32>() / count);
        let off = |c: usize| inner.iter().map(|v| (v[c] - mean[c]).powi(2)).sum::<f32>() / count;
        let spread = ([0, 1, 2].map(off).iter().sum::<f32>() / 3.0).sqrt();
        println!("{pixels} pixels, merge {merge}: mean {mean:?}, off by {spread}, {count} pixels");
        (mean, spread, inner.len())
    };
    let (near, uneven, pixels) = shown(8.0, 0.0);
    assert!(uneven > 0.05 * near[1] && pixels > 2000, "near foam shows its bubbles");
    for (size, merge) in [(0.8, 0.0), (0.5, 1.0)] {
        let (far, uneven, pixels) = shown(size, merge);
        assert!(uneven < 0.005 * far[1] && pixels > 2000, "{size}: off by {uneven}");
        for (far, near) in far.iter().zip(near) {
            assert!((far / near - 1.0).abs() < 0.02, "{size}: {far}, near {near}");
        }
    }
}
