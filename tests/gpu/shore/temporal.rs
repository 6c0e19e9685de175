//! Temporal stability: the camera moves by fractions of a pixel, or flies low over the water.

use glam::{DVec2, DVec3, Mat4, Vec3};
use whitewater::shore::Edge;
use whitewater::{Shore, Shoreline};

use super::shoreline::{AREA, heights, plain};
use super::{Mapped, water, with_shore};
use crate::reference::Image;
use crate::reference::shore::Water;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::Lens;

/// A shore line that passes through the view from near to far.
fn land(at: DVec2) -> f64 {
    0.3 * (at.x - 7.0 + 1.5 * (0.5 * at.y).sin())
}

fn amounts(found: &Image<[u8; 4]>) -> Image<f64> {
    found.map(|c| f64::from(c[0]) / 255.0)
}

/// Mean absolute change of the amount between two frames at the same points of the water, where
/// both frames see them.
fn change(now: (&Image<f64>, &Water), before: (&Image<f64>, &Shot)) -> f64 {
    let view = before.1.view(before.1.size);
    let (mut sum, mut count) = (0.0, 0.0);
    for y in 0..now.0.height {
        for x in 0..now.0.width {
            let point = now.1.at([x as f64 + 0.5, y as f64 + 0.5]);
            if point.depth.value <= 0.0 || point.depth.value > 40.0 {
                continue;
            }
            let [east, north] = point.place.map(|p| p.value);
            let eye = view.view.transform_point3(DVec3::new(east, 0.0, north));
            let at = view.project(eye);
            let inner = at.x > 1.0 && at.y > 1.0 && at.x < 95.0 && at.y < 63.0;
            if eye.z > -0.2 || !inner {
                continue;
            }
            let there = before.0.bilinear(at);
            let there: f64 = there.iter().map(|(i, j, w)| w * before.0.clamped(*i, *j)).sum();
            sum += (now.0.at(x, y) - there).abs();
            count += 1.0;
        }
    }
    sum / count
}

/// Number of borders of foam along rows and columns of a clipped picture, per pixel.
fn borders(clipped: &Image<f64>) -> f64 {
    let mut count = 0;
    for y in 0..clipped.height - 1 {
        for x in 0..clipped.width - 1 {
            let own = clipped.at(x, y);
            count +=
                i32::from(own != clipped.at(x + 1, y)) + i32::from(own != clipped.at(x, y + 1));
        }
    }
    f64::from(count) / clipped.data.len() as f64
}

/// Between pixels, a fraction f from one to the next, linear interpolation of a border that is a
/// ramp of one pixel errs by f(1 - f) pixels in the mean, at most a quarter, along rows and
/// columns; a step errs by twice that. A well sampled picture at rest changes no more than that.
#[test]
fn smooth_foam_neither_crawls_nor_sparkles() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, land), None);
    let mut means = Vec::new();
    for edge in [Edge::Smooth, Edge::Clip] {
        let mut rig = Rig::new(&gpu, &with_shore(size, edge));
        for (name, step, low) in [
            // A third of a pixel at a distance of 8 m, and a flight one metre above the water.
            ("sideways", Vec3::new(0.04, 0.0, 0.03), 0.0),
            ("low", Vec3::new(0.06, 0.0, -0.08), 1.2),
        ] {
            let mut before: Option<(Image<f64>, Shot)> = None;
            let (mut sum, mut covers, mut edges) = (0.0, 0.0, 0.0);
            for frame in 0..6_u8 {
                let mut shot = Shot::new(size, Lens::ReversedInfinite, 0.1, &[]);
                let moved = f32::from(frame) * step - Vec3::new(0.0, low, 0.0);
                shot.camera.view =
                    (shot.camera.view_matrix() * Mat4::from_translation(-moved)).to_cols_array_2d();
                let shoreline = Some(Shoreline::Map(coasts.shore_distances()));
                shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = shoreline));
                shot.settings.shore = plain();
                let found = amounts(&rig.draw(&shot).shore.expect("shoreline foam"));
                covers += found.data.iter().sum::<f64>() / found.data.len() as f64 / 6.0;
                edges += borders(&found) / 6.0;
                let water = water(&shot, DVec3::Y, 0.0);
                if let Some((there, own)) = &before {
                    sum += change((&found, &water), (there, own)) / 5.0;
                }
                before = Some((found, shot));
            }
            println!("{edge:?}, {name}: changes by {sum:.5}, of {covers:.4} covered");
            means.push((sum, covers, edges));
        }
    }
    for (i, name) in ["sideways", "low"].into_iter().enumerate() {
        let ((smooth, covers, _), (clipped, _, edges)) = (means[i], means[i + 2]);
        assert!(covers > 0.02, "{name}: {covers} is covered");
        println!("{name}: {smooth:.5} of a bound of {:.5}, clipped {clipped:.5}", 0.25 * edges);
        assert!(smooth < 0.25 * edges, "{name}: {smooth} of {edges}");
        assert!(smooth < 0.66 * clipped, "{name}: {smooth}, clipped {clipped}");
    }
}

/// From a distance foam covers as much as from near: the mean of many pixels of a high resolution
/// equals the pixel of a low one.
#[test]
fn far_foam_covers_what_near_foam_does() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, land), None);
    let drawn = |width: u32, edge| {
        let size = extent(width, width);
        let mut shot = Shot::new(size, Lens::ReversedInfinite, 0.1, &[]);
        // From 20 m above.
        shot.camera.view =
            Mat4::look_to_rh(Vec3::new(7.0, 20.0, -5.0), Vec3::NEG_Y, Vec3::Z).to_cols_array_2d();
        let shoreline = Some(Shoreline::Map(coasts.shore_distances()));
        shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = shoreline));
        shot.settings.shore = plain();
        let mut rig = Rig::new(&gpu, &with_shore(size, edge));
        amounts(&rig.draw(&shot).shore.expect("shoreline foam"))
    };
    let near = drawn(512, Edge::Clip);
    for width in [32, 64] {
        let far = drawn(width, Edge::Smooth);
        let block = 512 / width as usize;
        let (mut off, mut bias, mut mean) = (0.0, 0.0, 0.0);
        let share = (block * block) as f64;
        let count = f64::from(width * width);
        for y in 0..width as usize {
            for x in 0..width as usize {
                let all = (0..block * block)
                    .map(|i| near.at(x * block + i % block, y * block + i / block));
                let inside = all.sum::<f64>() / share;
                let own = far.at(x, y);
                off += (own - inside).abs() / count;
                bias += (own - inside) / count;
                mean += inside / count;
            }
        }
        println!("{width}: covers {mean:.4}, bias {bias:.5}, mean error {off:.5}");
        // Details too fine for a pixel are replaced by their mean, which is an estimate. Allowed is
        // about twice what was measured: a bias of a hundredth of the covered fraction, and a
        // seventh of it as the mean error of a pixel.
        assert!(bias.abs() < 0.025 * mean && off < 0.3 * mean, "{bias} {off} of {mean}");
    }
}
