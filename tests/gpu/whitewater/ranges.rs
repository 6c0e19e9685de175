//! Settings at the ends of their ranges.

use glam::DVec3;
use whitewater::{OcclusionReach, ShadowMixing, Submerged, WhitewaterSettings};

use super::{HALF, SIZE, Whitewater, by, channel, ways, whitewater_config};
use crate::reference::Image;
use crate::reference::whitewater as twin;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig};
use crate::support::scenes::{self, Lens, Random};

/// So many particles on one spot that thickness to the power of the exponent overflows single
/// precision.
#[test]
fn thick_foam_is_opaque_by_any_exponent() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    let mut cloud = Whitewater::new(Lens::Standard);
    let count = 4000;
    cloud.positions = scenes::world(&cloud.shot.camera, &vec![[0.0, 0.0, 4.0]; count]);
    cloud.shot.positions.clear();
    (cloud.kinds, cloud.ages) = (vec![0; count], vec![0.0; count]);
    (cloud.radii, cloud.ids) = (Some(vec![1.0; count]), Some(vec![0; count]));
    for (half, exponent) in [
        (3.0, 1.25),
        (3.0, 12.0),
        (3.0, 16.0),
        (1.0e6, 16.0),
        (1.0e-6, 16.0),
        (1.0e-6, 0.1),
        (1.0e6, 0.1),
    ] {
        let look = &mut cloud.shot.settings.whitewater;
        (look.half_intensity_thickness, look.exponent) = (half, exponent);
        let drawn = cloud.draw(&mut rig);
        let foam = drawn.whitewater.as_ref().expect("whitewater particles");
        let most = foam.thickness.data.iter().map(|t| t[0]).fold(0.0, f32::max);
        assert!(most > 3000.0, "{most}");
        let expected = foam.thickness.map(|t| {
            twin::intensity(f64::from(t[0]) + f64::from(t[1]), half.into(), exponent.into())
        });
        // pow is exp2 of a product of up to 330 with log2: 3 ulp and 2^-21 absolute each. The
        // opacity changes by at most a quarter of that relative error.
        let off = |_: usize, _: usize, v: f64| 1.0e-4 * v.min(1.0 - v) + 1.0e-6;
        compare::close("whitewater-opaque", &channel(&foam.occluders, 1), &expected, 0, off);
        is_finite(&drawn, &format!("{half} {exponent}"));
    }
}

fn is_finite(drawn: &Drawn, name: &str) {
    let foam = drawn.whitewater.as_ref().expect("whitewater particles");
    for (what, image) in [
        ("the picture", &drawn.output),
        ("occluders", &foam.occluders),
        ("thickness", &foam.thickness),
        ("normals", &foam.normal),
        ("light", &foam.light),
    ] {
        let bad = image.data.iter().filter(|texel| texel.iter().any(|v| !v.is_finite())).count();
        assert_eq!(bad, 0, "{name}: {bad} pixels of {what}");
    }
}

/// Foam before the water keeps all of its intensity, whatever the falloff's exponents.
#[test]
fn foam_before_the_water_has_no_falloff() {
    let gpu = Gpu::shared();
    for way in ways(&gpu) {
        let mut rig = Rig::lit(&gpu, &by(way, SIZE), 1);
        let mut cloud = Whitewater::new(Lens::Standard);
        cloud.shot.positions.clear();
        let whole = cloud.draw(&mut rig).whitewater.expect("whitewater particles").thickness;
        let expected = channel(&whole, 0).map(|v| f64::from(*v));
        for (n, m) in [(0.1, 16.0), (0.1, 0.1), (16.0, 0.1), (16.0, 16.0)] {
            cloud.shot.settings.whitewater.submerged = Submerged::Falloff { depth: 1.0, n, m };
            let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
            // Another pipeline, and one fixed-point step for each of the few particles in a pixel.
            compare::close(
                "whitewater-before",
                &channel(&foam.thickness, 0),
                &expected,
                0,
                |_, _, v| 1.0e-6 * v + 8.0 / 65536.0,
            );
        }
    }
}

/// If nothing is occluded there is no shadow, whatever the shadow's exponent.
#[test]
fn foam_in_the_open_has_no_shadow() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    let mut cloud = Whitewater::new(Lens::Standard);
    cloud.shot.positions.clear();
    cloud.shot.scene_depth(|_, _| None);
    let look = &mut cloud.shot.settings.whitewater;
    // The foam is so transparent that it does not occlude itself.
    (
        look.half_intensity_thickness,
        look.exponent,
        [look.shadow_scale, look.shadow_exponent, look.shadow_offset],
    ) = (1.0e6, 16.0, [0.0, 0.1, 0.0]);
    let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
    let most = foam.light.data.iter().map(|light| light[3]).fold(0.0, f32::max);
    assert!(f64::from(most) < HALF, "{most}");
}

/// With a reach of almost 0 nothing is occluded.
#[test]
fn occluders_without_reach_hide_nothing() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    let mut cloud = Whitewater::new(Lens::Standard);
    let look = &mut cloud.shot.settings.whitewater;
    (look.reach, [look.shadow_scale, look.shadow_exponent, look.shadow_offset]) =
        (OcclusionReach::Radii(1.0e-9), [1.0, 1.0, 0.0]);
    let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
    let most = foam.light.data.iter().map(|light| light[3]).fold(0.0, f32::max);
    assert!(f64::from(most) < HALF, "{most}");
}

/// The end of ranges up to ∞.
const MOST: f32 = 1.0e12;

/// Each setting at both ends of its range, then all settings at random ends.
#[test]
fn no_setting_in_its_range_makes_nan() {
    type Turn = fn(&mut WhitewaterSettings, bool);
    fn pick<T>(most: bool, least: T, greatest: T) -> T {
        if most { greatest } else { least }
    }
    // A value of the submerged particles' falloff, which keeps the other two.
    fn falloff(
        look: &mut WhitewaterSettings,
        change: fn(&mut f32, &mut f32, &mut f32, bool),
        most: bool,
    ) {
        let (mut depth, mut n, mut m) = match look.submerged {
            Submerged::Falloff { depth, n, m } => (depth, n, m),
            Submerged::Water => (0.5, 2.0, 4.0),
        };
        change(&mut depth, &mut n, &mut m, most);
        look.submerged = Submerged::Falloff { depth, n, m };
    }
    let turns: [(&str, Turn); 29] = [
        ("radius", |look, most| look.radius = pick(most, 1.0e-9, MOST)),
        ("submerged.most", |look, most| {
            falloff(look, |depth, _, _, most| *depth = pick(most, 1.0e-9, MOST), most);
        }),
        ("submerged.n", |look, most| {
            falloff(look, |_, n, _, most| *n = pick(most, 0.1, 16.0), most)
        }),
        ("submerged.m", |look, most| {
            falloff(look, |_, _, m, most| *m = pick(most, 0.1, 16.0), most)
        }),
        ("half", |look, most| look.half_intensity_thickness = pick(most, 1.0e-6, 1.0e6)),
        ("exponent", |look, most| look.exponent = pick(most, 0.1, 16.0)),
        ("passes", |look, most| look.passes = pick(most, 0, 8)),
        ("search.first", |look, most| look.search_radius = pick(most, 0.0, 100.0)),
        ("search.more", |look, most| look.search_radius_step = pick(most, 0.0, 100.0)),
        ("density", |look, most| look.sample_density = pick(most, 0.0, 16.0)),
        ("samples", |look, most| {
            [look.min_samples, look.max_samples] = pick(most, [1, 1], [512, 512])
        }),
        ("reach", |look, most| {
            let value = pick(most, 1.0e-9, MOST);
            look.reach = match look.reach {
                OcclusionReach::Radii(_) => OcclusionReach::Radii(value),
                OcclusionReach::Metres(_) => OcclusionReach::Metres(value),
            };
        }),
        ("fluid_opacity", |look, most| look.fluid_opacity = pick(most, 0.0, 1.0)),
        ("scene_opacity", |look, most| look.scene_opacity = pick(most, 0.0, 1.0)),
        ("foam_shape", |look, most| look.foam_shape = pick(most, [0.1; 2], [16.0; 2])),
        ("spray_shape", |look, most| look.spray_shape = pick(most, [0.1, 16.0], [16.0, 0.1])),
        ("bubble_shape", |look, most| look.bubble_shape = pick(most, [0.1; 2], [16.0; 2])),
        ("life", |look, most| look.life = pick(most, [0.1, 16.0], [16.0, 0.1])),
        ("sizes", |look, most| look.sizes = pick(most, 1, 64)),
        ("bubble_size", |look, most| look.bubble_size = pick(most, 1.0e-6, 1.0)),
        ("blur", |look, most| look.blur = pick(most, 0.0, 16.0)),
        ("shadow.scale", |look, most| look.shadow_scale = pick(most, 0.0, 16.0)),
        ("shadow.exponent", |look, most| look.shadow_exponent = pick(most, 0.1, 16.0)),
        ("shadow.offset", |look, most| look.shadow_offset = pick(most, -1.0, 1.0)),
        ("shadow.color", |look, most| look.shadow_color = pick(most, [0.0; 3], [1.0; 3])),
        ("albedo", |look, most| look.albedo = pick(most, [0.0; 3], [1.0; 3])),
        ("scale", |look, most| look.scale = pick(most, 0.0, 64.0)),
        ("mixing", |look, most| {
            look.mixing = pick(most, ShadowMixing::Scaled, ShadowMixing::Source)
        }),
        ("metres", |look, most| {
            let (OcclusionReach::Radii(value) | OcclusionReach::Metres(value)) = look.reach;
            look.reach = pick(most, OcclusionReach::Radii(value), OcclusionReach::Metres(value));
        }),
    ];
    let gpu = Gpu::shared();
    let mut random = Random(17);
    for way in ways(&gpu) {
        let mut rig = Rig::lit(&gpu, &by(way, SIZE), 1);
        let mut cloud = Whitewater::new(Lens::Standard);
        // Few particles, some without a radius of their own.
        cloud.positions.truncate(60);
        for (name, ages) in [(" whole", 0.0), (" nearly gone", 0.999_999_94)] {
            cloud.ages = vec![ages; 60];
            for (field, turn) in turns {
                for most in [false, true] {
                    let mut cloud = cloud.clone();
                    turn(&mut cloud.shot.settings.whitewater, most);
                    if field == "radius" {
                        cloud.radii = None;
                    }
                    is_finite(&cloud.draw(&mut rig), &format!("{field} {most}{name}"));
                }
            }
        }
        for round in 0..8 {
            let mut cloud = cloud.clone();
            cloud.ages = vec![0.0; 60];
            for (_, turn) in &turns[1..] {
                turn(&mut cloud.shot.settings.whitewater, random.between(0.0, 1.0) < 0.5);
            }
            let name = format!("{round}: {:?}", cloud.shot.settings.whitewater);
            is_finite(&cloud.draw(&mut rig), &name);
        }
    }
}

/// The sun's direction may have any length.
#[test]
fn the_sun_is_as_bright_by_any_length_of_its_direction() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    let mut cloud = Whitewater::new(Lens::Standard);
    let mut draw = |length: f32| {
        cloud.shot.settings.light.direction = [0.48, 0.6, 0.64].map(|part| part * length);
        cloud.draw(&mut rig).whitewater.expect("whitewater particles").light
    };
    let one: Image<[f32; 4]> = draw(1.0);
    let sunny = one.map(|texel| DVec3::from_slice(&texel.map(f64::from)).x);
    assert!(sunny.data.iter().filter(|v| **v > 0.01).count() > 500);
    for length in [0.1, 7.0, 1.0e-20, 1.0e20] {
        let other = channel(&draw(length), 0);
        compare::close("whitewater-sun", &other, &sunny, 0, |_, _, v| 4.0 * HALF * v);
    }
}
