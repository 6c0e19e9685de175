//! Blobs in the particles' water and in front of it.

use glam::DVec3;
use whitewater::Config;
use whitewater::water::{Medium, Shading};

use super::soap::{Expected, Scene, even, water};
use crate::reference::{Image, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Shot, config, extent};
use crate::support::scenes::{self, Lens};
use crate::support::tolerance::U;

const RADIUS: f32 = 0.2;

/// A strongly coloured medium that absorbs most light within a metre, and one that scatters much of
/// it.
const CLEAR: Medium = Medium::Physical { absorption: [0.9, 0.4, 0.2], scattering: [0.0, 0.0, 0.0] };
const TURBID: Medium =
    Medium::Physical { absorption: [0.7, 0.3, 0.1], scattering: [0.1, 0.4, 0.3] };

/// A block of water in the left part of the picture, from this depth on, `deep` particles deep.
fn block(depth: f32, deep: usize) -> Vec<[f32; 3]> {
    scenes::block(3, 0.25, [8, 14, deep], [-1.8, -1.6, depth])
}

fn small(thickness_level: u32) -> Config {
    config(extent(112, 96)).with(|it| it.thickness_level = thickness_level)
}

/// Layers before, in and behind water: each layer is seen through the water in front of it,
/// whatever the other layers are, and hides the water's own light from behind it.
#[test]
fn layers_in_water_are_the_twins() {
    let gpu = Gpu::shared();
    let source = Medium::Source { base: [0.3, 0.5, 0.9], falloff: [0.5, 0.4, 0.2, 0.7] };
    let thin = even(380.0).with(|it| [it.core_opaque_radius, it.core_outer_radius] = [0.1, 0.5]);
    for (name, level, layers, medium, look) in [
        ("turbid", 0, 3, TURBID, thin),
        ("turbid, coarse", 2, 3, TURBID, even(380.0)),
        ("turbid, eight", 2, 8, TURBID, thin),
        ("source's", 0, 3, source, thin),
        ("source's, open", 2, 3, source, thin.with(|it| it.fill_holes = false)),
    ] {
        let mut scene = Scene::of(&gpu, DVec3::ZERO, layers, small(level));
        for (lens, depth, deep) in [(Lens::Standard, 2.6, 4), (Lens::LeftHanded, 1.6, 3)] {
            let mut shot = scene.shot_in(lens, true, (RADIUS, &block(depth, deep)));
            shot.settings.water.medium = medium;
            shot.settings.light.ambient = [0.9, 0.5, 0.7];
            shot.settings.bubbles = look;
            let drawn = scene.rig.draw(&shot);
            let expected = scene.expected(&shot, &drawn);
            let found = drawn.soap.expect("bubble foam").color;
            let mut seen = [0; 3];
            for (color, Expected { pixel, .. }) in found.data.iter().zip(&expected.data) {
                if pixel.layers == 0 {
                    assert_eq!(*color, [0.0; 4], "{name}: nothing is there");
                }
                let both = (1..pixel.layers).contains(&pixel.wet);
                let shows = [pixel.layers > 0, pixel.wet > 1, both];
                seen.iter_mut().zip(shows).for_each(|(n, shows)| *n += u32::from(shows));
            }
            let [all, wet, both] = seen;
            println!(
                "{name}, {lens:?}: of {all} pixels {wet} show two in water, {both} also one before it"
            );
            assert!(wet > 300 && both + wet > 500, "{name}, {lens:?}: {seen:?}");
            let colors = expected.map(|e| e.pixel.color);
            let off = |x: usize, y: usize| expected.data[y * expected.width + x].off;
            compare::close_color(&format!("soap-water-{level}-{layers}"), &found, &colors, off);
        }
    }
}

/// Water that scatters no light and lies before all foam: a colour is that in air, times the
/// water's transmittance, and the opacity is unchanged. This also holds if the water ends long
/// before the foam.
#[test]
fn water_before_foam_takes_of_its_colour_alone() {
    let gpu = Gpu::shared();
    let mut scene = Scene::of(&gpu, DVec3::ZERO, 3, small(0));
    for (deep, look) in [
        (3, even(380.0)),
        (2, even(500.0).with(|it| [it.core_opaque_radius, it.core_outer_radius] = [0.1, 0.5])),
    ] {
        let mut shot = scene.shot_in(Lens::Standard, true, (RADIUS, &block(0.9, deep)));
        shot.settings.water.medium = CLEAR;
        shot.settings.bubbles = look;
        let wet = scene.rig.draw(&shot);
        shot.positions.clear();
        let dry = scene.rig.draw(&shot).soap.expect("bubble foam").color;
        let rays = super::impostor::rays(&shot).1;
        let mut lost = Vec::new();
        let left = Image::from_fn(dry.width, dry.height, |x, y| {
            let own = water(&shot, &wet, (x, y), rays.at(x, y).length());
            let (left, _) = own.medium.of(own.metres);
            let [r, g, b, a] = dry.at(x, y).map(f64::from);
            (DVec3::new(r, g, b) * left).extend(a).to_array()
        });
        for (color, dry) in left.data.iter().zip(&dry.data).filter(|(_, dry)| dry[3] > 0.9) {
            lost.push(color[0] / f64::from(dry[0]));
        }
        lost.sort_by(f64::total_cmp);
        println!("{deep}: least {:.3}, most {:.3} of red", lost[0], lost[lost.len() - 1]);
        assert!(lost[lost.len() / 4] < 0.7 && lost[lost.len() - 1] == 1.0, "{deep}");
        // Both colours are rounded to half precision.
        let found = wet.soap.expect("bubble foam").color;
        let off = |x: usize, y: usize| left.at(x, y).map(|v| v * 2.0 / 1024.0 + 1.0e-6);
        compare::close_color("soap-water-before", &found, &left, off);
    }
}

/// Layers behind the first opaque one do not matter, neither in water nor in air.
#[test]
fn opaque_foam_has_one_colour_in_water_however_many_layers() {
    let gpu = Gpu::shared();
    // The opaque core has no film before it, so only the first layer is visible.
    let look = even(380.0).with(|it| {
        [it.core_opaque_radius, it.core_outer_radius] = [1.9, 2.0];
        it.fill_holes = false;
    });
    let mut means = Vec::new();
    for layers in [1, 3, 8] {
        let mut scene = Scene::of(&gpu, DVec3::ZERO, layers, small(2));
        let mut shot = scene.shot_in(Lens::Standard, true, (RADIUS, &block(1.2, 6)));
        shot.settings.water.medium = TURBID;
        shot.settings.bubbles = look;
        let found = scene.rig.draw(&shot).soap.expect("bubble foam").color;
        let sum: DVec3 =
            found.data.iter().map(|c| DVec3::from([c[0], c[1], c[2]].map(f64::from))).sum();
        let covered = found.data.iter().filter(|c| c[3] > 0.0);
        assert!(covered.clone().all(|c| c[3] == 1.0), "{layers}: nothing behind shines through");
        means.push(sum / covered.count() as f64);
    }
    println!("{means:.4?}");
    assert!(means.iter().all(|mean| *mean == means[0]), "{means:?}");
}

/// Foam in water hides only what lies behind it, so reflection, highlight and the water's own light
/// before the foam appear once. Foam in front of the water hides those too.
#[test]
fn foam_in_water_hides_what_is_behind_it_alone() {
    let gpu = Gpu::shared();
    for (shading, level) in [(Shading::Raster, 0), (Shading::Compute, 2)] {
        let base = small(level).with(|it| it.composite = Some(shading));
        let mut scene = Scene::of(&gpu, DVec3::new(0.2, 0.5, 0.1), 3, base);
        // The water begins before all blobs, and then behind the first ones.
        for (lens, depth) in [(Lens::Standard, 1.6), (Lens::LeftHanded, 5.0)] {
            let mut shot = scene.shot_in(lens, true, (RADIUS, &block(depth, 4)));
            shot.settings.water.medium = TURBID;
            shot.settings.bubbles =
                even(380.0).with(|it| [it.core_opaque_radius, it.core_outer_radius] = [0.1, 0.5]);
            shot.settings.light.color = [3.0, 2.0, 1.0];
            shot.settings.light.direction = [0.2, 0.4, 0.9];
            let whole = scene.rig.draw(&shot);
            let soap = whole.soap.as_ref().expect("bubble foam");
            // The same water without foam, then its surface alone before black and before white,
            // which gives its reflection.
            let mut bare = Shot { blobs: Vec::new(), ..shot.clone() };
            let water = scene.rig.draw(&bare).output;
            bare.settings.water.medium =
                Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] };
            let mut of = |scene_color: f32| {
                bare.color.fill([scene_color, scene_color, scene_color, 1.0]);
                scene.rig.draw(&bare).output
            };
            let (black, white) = (of(0.0), of(1.0));
            let near = f64::from(shot.falloff());
            let (mut wet, mut dry) = (0, 0);
            let mut off = Image::new(water.width, water.height, [0.0; 4]);
            let expected = Image::from_fn(water.width, water.height, |x, y| {
                let [r, g, b, alpha] = soap.color.at(x, y).map(f64::from);
                let soap_light = DVec3::new(r, g, b);
                let rgb = |image: &Image<[f32; 4]>| {
                    let [r, g, b, _] = image.at(x, y).map(f64::from);
                    DVec3::new(r, g, b)
                };
                let [all, surface, lit] = [&water, &black, &white].map(rgb);
                let under = f64::from(soap.depth.at(x, y)) > f64::from(whole.depth.at(x, y));
                let seen = if under {
                    // From back to front: what is behind the foam, without the surface; then the
                    // surface over it.
                    let below = all - surface;
                    surface + below * (1.0 - alpha) + (lit - surface) * soap_light
                } else {
                    all * (1.0 - alpha) + soap_light
                };
                seen.extend(f64::from(whole.output.at(x, y)[3])).to_array()
            });
            for y in 0..water.height {
                for x in 0..water.width {
                    let [foam, front] = [soap.depth.at(x, y), whole.depth.at(x, y)].map(f64::from);
                    if is_surface(foam) && is_surface(front) {
                        // At this distance, rounding or smoothing decides whether foam or surface
                        // is in front.
                        let unsure = (foam - front).abs() <= near;
                        wet += u32::from(!unsure && foam > front);
                        dry += u32::from(!unsure && foam < front);
                        let most = expected.at(x, y).into_iter().fold(1.0, f64::max);
                        *off.at_mut(x, y) = [if unsure { 1.0e3 } else { 64.0 * U * most }; 4];
                    } else {
                        *off.at_mut(x, y) = [64.0 * U * 4.0; 4];
                    }
                }
            }
            println!("{shading:?}, {lens:?}: {wet} pixels in water, {dry} before it");
            let compared = if lens == Lens::Standard { wet } else { dry };
            assert!(compared > 300, "{shading:?}, {lens:?}: {wet} and {dry}");
            compare::close_color("soap-water-composite", &whole.output, &expected, |x, y| {
                off.at(x, y)
            });
        }
    }
}
