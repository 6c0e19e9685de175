//! The fluid in front of or behind whitewater particles, which also occludes them.

use whitewater::Submerged;

use super::{SIZE, Whitewater, channel, doubles, whitewater_config};
use crate::level::smoothed;
use crate::reference::whitewater::foam_bounds;

use crate::reference::{EMPTY, Image};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, coarsening, extent};
use crate::support::scenes::{self, LENSES, Lens};

/// The fluid around foam is the smoothed surface where it is near the spheres, also at coarser
/// levels.
#[test]
fn the_fluid_round_foam_is_smooth() {
    let gpu = Gpu::shared();
    for (lens, smoothing_level, near) in [
        (Lens::Standard, 1, false),
        (Lens::OffAxis, 0, false),
        (Lens::Reversed, 2, false),
        (Lens::Standard, 0, true),
    ] {
        let config = whitewater_config(SIZE).with(|it| {
            it.smoothing_level = smoothing_level;
            it.max_particles = 20_000;
        });
        // So few iterations that coarser levels show.
        let few = coarsening(config).with(|it| it.max_iterations = 3);
        let config = if near { few } else { config };
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut cloud = Whitewater::new(lens);
        let block = scenes::block(3, 0.2, [30, 20, 4], [-3.0, -2.0, 4.0]);
        cloud.shot.positions = scenes::world(&cloud.shot.camera, &block);
        let drawn = cloud.draw(&mut rig);
        let fluid = channel(&drawn.whitewater.as_ref().expect("whitewater particles").occluders, 2);
        let surface = smoothed(&drawn, &cloud.shot, config.max_iterations);
        let falloff = cloud.shot.falloff();
        let coarser = |x: usize, y: usize| {
            let (level, _) = surface
                .levels
                .shown(surface.levels.nearness_at((x, y), f64::from(drawn.depth.at(x, y))));
            level > 0
        };
        let shown = (0..fluid.height).flat_map(|y| (0..fluid.width).map(move |x| (x, y)));
        let shown = shown.filter(|&(x, y)| coarser(x, y)).count();
        assert!(!near || shown > 500, "{shown} pixels of coarser levels");
        let expected = Image::from_fn(fluid.width, fluid.height, |x, y| {
            let sphere = drawn.depth.at(x, y);
            if f64::from(sphere) >= EMPTY {
                return f64::from(sphere);
            }
            surface.at((x, y), sphere, falloff)
        });
        let off = |(smooth, sphere): (&f64, &f32)| (smooth - f64::from(*sphere)).abs();
        let moved = expected.data.iter().zip(&drawn.depth.data).map(off).filter(|off| *off > 0.01);
        let moved = moved.count();
        // Weights and a mean of four values: 8 roundings of at most the falloff, and one of the
        // depth.
        let ulp = f64::from(f32::EPSILON);
        compare::close("whitewater-fluid", &fluid, &expected, 0, |_, _, v| {
            8.0 * ulp * f64::from(falloff) + ulp * v
        });
        assert!(moved > 500, "{lens:?}: {moved} pixels moved by the smoothing");
    }
}

/// A fluid image from the host decides whether foam is before or behind the surface; the image may
/// have another size and be a part of a larger one. Where there is also particle water, the nearer
/// of both counts.
#[test]
fn foam_is_told_by_a_fluid_of_the_hosts() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    for lens in LENSES {
        let mut cloud = Whitewater::new(lens);
        cloud.shot.settings.whitewater.submerged =
            Submerged::Falloff { depth: 1.5, n: 2.0, m: 4.0 };
        let mut sea = cloud.shot.clone();
        (sea.depth_extent, sea.margin) = (extent(40, 50), [3, 0, 5, 2]);
        sea.scene_depth(|x, y| (y > 9).then_some(4.0 + 0.02 * f64::from(x) + 0.05 * f64::from(y)));
        let both = Whitewater { fluid: Some(sea.clone()), ..cloud.clone() }.draw(&mut rig);
        let nearest =
            channel(&both.whitewater.as_ref().expect("whitewater particles").occluders, 2);
        cloud.shot.positions.clear();
        cloud.fluid = Some(sea.clone());
        let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
        let view = cloud.shot.view(SIZE);
        let (fluid, scene) = (channel(&foam.occluders, 2), cloud.shot.scene_at(SIZE, 0));
        let (sea, falloff) = (sea.scene_at(SIZE, 0), f64::from(cloud.shot.falloff()));
        let expected = Image::from_fn(fluid.width, fluid.height, |x, y| {
            if sea.at(x, y) < scene.at(x, y) { sea.at(x, y).min(EMPTY) } else { EMPTY }
        });
        // A depth is the inverse of a sum of two rounded terms, which is 1 at the near plane.
        let off = |v: f64| 4.0 * f64::from(f32::EPSILON) * v * (1.0 + v / view.near());
        let most = |_, _, v: f64| if v < EMPTY { off(v) } else { 0.0 };
        compare::close("whitewater-host", &fluid, &expected, 0, most);
        let hosts = expected.data.iter().filter(|v| **v < EMPTY).count();
        let mut ours = 0;
        for (i, sphere) in both.depth.data.iter().map(|v| f64::from(*v)).enumerate() {
            let (found, host) = (f64::from(nearest.data[i]), f64::from(fluid.data[i]));
            // The nearer of both, where smoothing cannot change their order.
            if (sphere - host).abs() > 2.0 * falloff {
                assert!(
                    (found < host) == (sphere < host),
                    "{lens:?}: {found} of {sphere} and {host}"
                );
                ours += usize::from(sphere < host);
            }
        }
        assert!(ours > 200, "{lens:?}: {ours} pixels with water of ours");
        assert!(hosts > 1000, "{lens:?}: {hosts} pixels with the host's fluid");
        let settings = cloud.twin_settings();
        let bounds = foam_bounds(&cloud.particles(), &view, &settings, &scene, &doubles(&fluid));
        for (i, sum) in bounds.sums.iter().enumerate() {
            let name = format!("whitewater-host-sum-{i}");
            compare::between(&name, &channel(&foam.thickness, i), sum);
        }
    }
}
