//! Pass `blur` with wide kernels.

use glam::DVec2;
use whitewater::{Occlusion as Occluding, WhitewaterConfig};

use super::{Whitewater, channel, doubles, seen, whitewater_config};
use crate::reference::Image;
use crate::reference::whitewater::{self as twin, Layers, Seen};
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::{self, Lens, Random};

/// The blur by its definition: a Gaussian over a disc, with σ half the radius, that does not cross
/// gaps in depth. Returns also the fraction of the weights over the surrounding square that lies
/// outside the disc; for values up to 1 apart, a blur over the square differs by at most that.
fn disc(
    values: &Image<f64>,
    front: &Image<Option<Seen>>,
    (radius, gap): (f64, f64),
    (x, y): (usize, usize),
) -> (f64, f64) {
    let middle = front.at(x, y).expect("foam").depth;
    let (mut sum, mut inside, mut all) = (0.0, 0.0, 0.0);
    for v in 0..values.height {
        for u in 0..values.width {
            let (across, down) = (u as f64 - x as f64, v as f64 - y as f64);
            let Some(there) = front.at(u, v) else { continue };
            if (there.depth - middle).abs() > gap || across.abs().max(down.abs()) > radius {
                continue;
            }
            let squared = across * across + down * down;
            let weight = (-squared / (2.0 * (0.5 * radius).powi(2))).exp();
            all += weight;
            if squared <= radius * radius {
                sum += weight * values.at(u, v);
                inside += weight;
            }
        }
    }
    (sum / inside, 1.0 - inside / all)
}

/// Foam with this radius in pixels that covers the picture. The wall behind it exists only in the
/// left half.
fn sheet(radius: f32) -> Whitewater {
    let size = extent(192, 128);
    let mut cloud = Whitewater::new(Lens::Standard);
    cloud.shot = Shot::new(size, Lens::Standard, 0.2, &scenes::cloud(31, 1, 30.0, 31.0));
    let view = cloud.shot.view(size);
    let depth = 6.0_f64;
    let world = f64::from(radius) * view.c_y() * depth;
    cloud.shot.scene_depth(|x, _| (x < 96).then_some(depth));
    let mut random = Random(5);
    let step = 4.0_f32.min(radius);
    let [columns, rows] = [192.0, 128.0].map(|side| (side / step) as u32 + 4);
    let points: Vec<_> = (0..columns * rows)
        .map(|i| {
            let [x, y] = [i % columns, i / columns]
                .map(|n| f64::from(step * (n as f32 - 1.5 + random.between(-0.3, 0.3))));
            let ray = view.ray_at(DVec2::new(x, y));
            let depth = depth - world * f64::from(random.between(0.0, 0.6));
            [ray.x * depth, ray.y * depth, depth].map(|v| v as f32)
        })
        .collect();
    let count = points.len();
    cloud.positions = scenes::world(&cloud.shot.camera, &points);
    (cloud.kinds, cloud.ages) = (vec![0; count], vec![0.0; count]);
    (cloud.radii, cloud.ids) = (Some(vec![world as f32; count]), Some(vec![0; count]));
    let look = &mut cloud.shot.settings.whitewater;
    (
        look.passes,
        [look.min_samples, look.max_samples],
        [look.shadow_scale, look.shadow_exponent, look.shadow_offset],
    ) = (1, [24, 24], [1.5, 1.0, 0.0]);
    cloud
}

#[test]
fn a_wide_blur_is_nearly_the_gaussian() {
    let gpu = Gpu::shared();
    let whitewater = WhitewaterConfig::new(10_000).with(|it| it.occlusion = Occluding::Reference);
    let size = extent(192, 128);
    let mut rig =
        Rig::lit(&gpu, &whitewater_config(size).with(|it| it.whitewater = Some(whitewater)), 1);
    // The kernel is 12 radii wide: small enough to be read pixel by pixel, and beyond that up to
    // more than the picture.
    for radius in [2.0_f32, 4.0, 9.0, 30.0] {
        let mut cloud = sheet(radius);
        // One case has the source's width.
        cloud.shot.settings.whitewater.blur = if radius == 4.0 { 3.0 } else { 1.5 };
        let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
        let (front, by, view) = (seen(&foam), cloud.occlusion(), cloud.shot.view(size));
        let of = |i| doubles(&channel(&foam.occluders, i));
        let (opacity, fluid, solid) = (of(1), of(2), of(3));
        let layers = Layers { front: &front, opacity: &opacity, fluid: &fluid, solid: &solid };
        let zeta =
            twin::occlusion(&layers, &view, &by).map(|o| o.map_or(0.0, |o| by.zeta(o.value)));
        let foams: Vec<_> = (zeta.data.iter().zip(&front.data))
            .filter_map(|(zeta, front)| front.is_some().then_some(*zeta))
            .collect();
        let (low, high) = foams.iter().fold((1.0_f64, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
        let mean = foams.iter().sum::<f64>() / foams.len() as f64;
        let spread = foams.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / foams.len() as f64;
        assert!(high - low > 0.4, "{radius}: {low} to {high}");
        let (mut worst, mut told) = (0.0_f64, 0);
        for (x, y) in (0..192).step_by(9).flat_map(|x| (0..128).step_by(13).map(move |y| (x, y))) {
            let Some(there) = front.at(x, y) else { continue };
            let wide = by.blur * 0.5 * by.search(there.h, 1) * view.extent().y;
            let gap = 2.0 * there.h * there.depth / view.focal().y.abs();
            let (expected, beside) = disc(&zeta, &front, (wide, gap), (x, y));
            let off = (f64::from(foam.light.at(x, y)[3]) - expected).abs();
            // The square's corners; then the sampling error of at least 11 points along each axis,
            // which are 5.5 in σ: about 4 pi 5.5^2 / 2 points count, and four standard deviations
            // of their mean are allowed; then three roundings to half precision.
            let allowed = beside * (high - low)
                + 4.0 * (spread / (2.0 * std::f64::consts::PI * 5.5 * 5.5)).sqrt()
                + 3.0 / 1024.0;
            worst = worst.max(off / allowed);
            told += 1;
        }
        assert!(told > 100, "{radius}: {told}");
        assert!(worst <= 1.0, "{radius}: {worst} of what is allowed");
    }
}
