//! Shoreline and contact foam in the picture: a coat over the scene, with and without the
//! particles' water over it.

use ash::vk;
use glam::{DVec2, DVec3};
use whitewater::shore::{Edge, ShoreSettings};
use whitewater::water::{Shading, Shadows};
use whitewater::{Shadow, Shore, Shoreline};

use super::shoreline::{AREA, heights, plain};
use super::{Mapped, U, water, with_shore};
use crate::reference::Image;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent, is_around};
use crate::support::scenes::{self, Lens};

pub const WAYS: [Shading; 2] = [Shading::Raster, Shading::Compute];

fn land(at: DVec2) -> f64 {
    0.4 * (4.0 - (at - DVec2::new(7.0, -5.0)).length())
}

pub fn coasts(gpu: &Gpu) -> Mapped<'_> {
    let mut coasts = Mapped::new(gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, land), None);
    coasts
}

/// Both kinds of foam, with different values in the three channels.
pub fn look() -> ShoreSettings {
    let mut look = plain();
    (look.shoreline.color, look.shoreline.opacity) = ([0.9, 0.5, 0.25], 0.8);
    let c = &mut look.contact;
    (c.color, c.lit, c.depth, c.opacity) = ([0.6, 0.7, 0.8], 0.5, 1.5, 0.9);
    look
}

/// A seabed that slopes away below the water level, and foam along the map's shore line.
pub fn shot(coasts: &Mapped<'_>, points: &[[f32; 3]]) -> Shot {
    over_bottom(coasts, points, extent(96, 64), |x| 0.02 * x)
}

/// A shot over a seabed that lies `behind` metres of depth behind the water level, as a function of
/// the pixel's x.
fn over_bottom(
    coasts: &Mapped<'_>,
    points: &[[f32; 3]],
    size: vk::Extent2D,
    behind: impl Fn(f32) -> f32,
) -> Shot {
    let mut shot = Shot::new(size, Lens::Standard, 0.2, points);
    let level = water(&shot, DVec3::Y, 0.0);
    shot.scene_depth(|x, y| {
        let z = level.at([f64::from(x) + 0.5, f64::from(y) + 0.5]).depth.value;
        (z > 0.0 && z < 90.0).then(|| z + f64::from(behind(x as f32)))
    });
    shot.settings.shore = look();
    shot.settings.light.irradiance = [2.0, 3.0, 4.0];
    shot.settings.light.shade = [0.5, 1.0, 0.25];
    let shoreline = Some(Shoreline::Map(coasts.shore_distances()));
    shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = shoreline));
    shot
}

/// Expected colour: the coat over `under`, with the amounts of foam found in the image. The alpha is
/// that of `under`.
pub fn coated(shot: &Shot, texel: [u8; 4], under: [f32; 4], over_contact: bool) -> [f64; 4] {
    let part = texel.map(|v| f64::from(v) / 255.0);
    let (s, c) = (&shot.settings.shore.shoreline, &shot.settings.shore.contact);
    let light = &shot.settings.light;
    let mut color = under.map(f64::from);
    for (i, color) in color.iter_mut().take(3).enumerate() {
        let whole = f64::from(light.irradiance[i]);
        let shade = f64::from(light.shade[i]) / whole;
        let sun = shade + (1.0 - shade) * (1.0 - part[2]);
        let mix = |a: f64, b: f64, t: f64| a * (1.0 - t) + b * t;
        let white = whole / std::f64::consts::PI;
        let shore = f64::from(s.color[i]) * white * sun;
        *color = mix(*color, shore, part[0] * f64::from(s.opacity));
        let lit = f64::from(c.lit);
        let contact = f64::from(c.color[i]) * mix(1.0, white, lit) * mix(1.0, sun, lit);
        if over_contact {
            *color = mix(*color, contact, part[1]);
        }
    }
    color
}

/// A filter places its samples to some u of the image's width, here 96 texels, and a channel
/// changes by up to about 2 between texels; sums and products add some tens of u.
pub const OFF: f64 = 2.0 * 4.0 * 96.0 * U + 40.0 * U;

pub fn check(name: &str, shot: &Shot, drawn: &Drawn) -> u32 {
    let shore = drawn.shore.as_ref().expect("foam");
    let most = OFF * (f64::from(shot.size.width) / 96.0).max(1.0);
    let mut seen = 0;
    for (i, texel) in shore.data.iter().enumerate() {
        let (found, under) = (drawn.output.data[i], shot.color[i]);
        if texel[0] == 0 && texel[1] == 0 {
            assert_eq!(found, under, "{name}: {i} has no foam");
            continue;
        }
        seen += 1;
        let expected = coated(shot, *texel, under, true);
        for c in 0..4 {
            let off = (f64::from(found[c]) - expected[c]).abs();
            assert!(off < most, "{name}: {i}: {found:?}, expected {expected:?}, foam {texel:?}");
        }
    }
    seen
}

/// Without particles the picture is the scene with the coat: with the output as scene or not, in a
/// part of the host's images, by raster and by compute. Without `Frame.shore`, or without foam, the
/// scene is unchanged.
#[test]
fn the_coat_lies_on_the_scene() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let shot = shot(&coasts, &[]);
    let mut pictures = Vec::new();
    for way in WAYS {
        let config = with_shore(shot.size, Edge::Smooth).with(|it| it.composite = Some(way));
        let mut rig = Rig::lit(&gpu, &config, 1);
        let name = format!("{way:?}");
        let drawn = rig.draw(&shot);
        assert!(check(&name, &shot, &drawn) > 1000, "{name}");
        let part = Shot { margin: [13, 30, 7, 21], ..shot.clone() };
        let found = rig.draw(&part);
        compare::same_color("shore-part", &found.output, &drawn.output);
        let (_, rect) = part.with_margin(part.size);
        for (i, texel) in found.whole.data.iter().enumerate() {
            let (x, y) = ((i % found.whole.width) as i32, (i / found.whole.width) as i32);
            let inside =
                (0..96).contains(&(x - rect.offset.x)) && (0..64).contains(&(y - rect.offset.y));
            assert!(inside || is_around(texel), "({x}, {y}) was written");
        }
        rig.config.in_place = false;
        compare::same_color("shore-apart", &rig.draw(&shot).output, &drawn.output);
        rig.config.in_place = true;
        let none = Shot { shore: None, ..shot.clone() };
        assert_eq!(rig.draw(&none).output.data, shot.color, "{name}: without foam");
        pictures.push(drawn.output);
    }
    compare::same_color("shore-ways", &pictures[0], &pictures[1]);
}

/// Pictures wider than a run of tiles, with foam everywhere, are drawn completely up to their
/// edges.
#[test]
fn rows_of_any_length_are_drawn() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    for width in [128, 137, 300] {
        let shot = over_bottom(&coasts, &[], extent(width, 40), |_| 0.1);
        for way in WAYS {
            let config = with_shore(shot.size, Edge::Smooth).with(|it| it.composite = Some(way));
            let drawn = Rig::lit(&gpu, &config, 1).draw(&shot);
            let seen = check(&format!("{width}, {way:?}"), &shot, &drawn);
            assert!(seen > 40 * width / 2, "{width}, {way:?}: {seen} pixels");
        }
    }
}

/// A frame without foam equals that of a renderer without shore foam, bit for bit; so does each
/// pixel far from foam.
#[test]
fn no_foam_is_no_change() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let points = scenes::block(3, 0.25, [10, 6, 4], [-1.6, -0.4, 3.0]);
    let shot = shot(&coasts, &points);
    let none = Shot { shore: None, ..shot.clone() };
    for way in WAYS {
        let plain = config(shot.size).with(|it| it.composite = Some(way));
        let with = plain.with(|it| it.shore = with_shore(shot.size, Edge::Smooth).shore);
        let expected = Rig::lit(&gpu, &plain, 1).draw(&none);
        let mut rig = Rig::lit(&gpu, &with, 1);
        compare::same_color("shore-none", &rig.draw(&none).output, &expected.output);
        let found = rig.draw(&shot);
        let shore = found.shore.as_ref().expect("foam");
        let mut alike = 0;
        for i in 0..shore.data.len() {
            let dry = f64::from(found.depth.data[i]) > 1.0e9;
            if dry && shore.data[i][..2] == [0, 0] {
                alike += 1;
                assert_eq!(found.output.data[i], expected.output.data[i], "{i}");
            }
        }
        assert!(alike > 1000, "{alike} pixels without foam");
    }
}

/// Foam under the particles' water looks like a part of the scene: over a scene of one colour, the
/// result equals that with the coat already in the scene's colour.
#[test]
fn foam_is_seen_through_water() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    // The water covers the shore line.
    let points = scenes::block(3, 0.25, [14, 8, 3], [-1.6, -1.0, 3.0]);
    let mut shot = shot(&coasts, &points);
    shot.color.fill([0.3, 0.5, 0.7, 0.75]);
    shot.settings.shore.contact.opacity = 0.0;
    shot.settings.water.refraction = 0.3;
    for way in WAYS {
        let plain = config(shot.size).with(|it| it.composite = Some(way));
        let with = plain.with(|it| it.shore = with_shore(shot.size, Edge::Smooth).shore);
        let found = Rig::lit(&gpu, &with, 1).draw(&shot);
        let shore = found.shore.as_ref().expect("foam");
        let mut other = Shot { shore: None, ..shot.clone() };
        for (color, texel) in other.color.iter_mut().zip(&shore.data) {
            *color = coated(&shot, *texel, *color, false).map(|v| v as f32);
        }
        let mut rig = Rig::lit(&gpu, &plain, 1);
        let expected = rig.draw(&other);
        let bare = rig.draw(&Shot { shore: None, ..shot.clone() });
        let (mut wet, mut changed) = (0, 0);
        for i in 0..shore.data.len() {
            if f64::from(found.depth.data[i]) > 1.0e9 {
                continue;
            }
            wet += 1;
            let (found, expected) = (found.output.data[i], expected.output.data[i]);
            for c in 0..3 {
                let off = (found[c] - expected[c]).abs();
                // Filter positions rounded to 1/256 texel, between texels that differ by at most 2.
                assert!(off < 2.0 / 256.0, "{way:?}, {i}: {found:?}, expected {expected:?}");
            }
            changed += i32::from((expected[0] - bare.output.data[i][0]).abs() > 0.05);
        }
        println!("{way:?}: of {wet} pixels of water {changed} show foam");
        assert!(wet > 500 && changed > 50, "{way:?}: {wet} {changed}");
    }
}

/// Contact foam lies on top of the particles' water.
#[test]
fn contacts_lie_on_the_water() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    let mut shot = shot(&coasts, &points);
    shot.scene_depth(|x, _| Some(3.6 + 0.02 * f64::from(x)));
    shot.shore = Some(Shore::new(0.0).with(|it| it.surface = None));
    shot.settings.shore.contact.particle_opacity = 0.9;
    for way in WAYS {
        let config = with_shore(shot.size, Edge::Smooth).with(|it| it.composite = Some(way));
        let mut rig = Rig::lit(&gpu, &config, 1);
        let found = rig.draw(&shot);
        let bare = rig.draw(&Shot { shore: None, ..shot.clone() });
        let shore = found.shore.as_ref().expect("foam");
        let mut seen = 0;
        for (i, texel) in shore.data.iter().enumerate() {
            let under = bare.output.data[i];
            let covered = [0, texel[3], texel[2], 0];
            let expected = coated(&shot, covered, under, true);
            seen += u32::from(texel[3] > 0);
            for c in 0..3 {
                let off = (f64::from(found.output.data[i][c]) - expected[c]).abs();
                assert!(
                    off < OFF,
                    "{way:?}, {i}: {:?}, expected {expected:?}",
                    found.output.data[i]
                );
            }
        }
        assert!(seen > 200, "{seen} pixels with foam on the water");
    }
}

/// Foam has only the light of shade where the sun is blocked. The shadow mask is the visible
/// fraction of the sun itself.
#[test]
fn foam_in_the_shade_is_darker() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let mut shot = shot(&coasts, &[]);
    let config = with_shore(shot.size, Edge::Smooth).with(|it| it.shadow = Some(Shadows::Mask));
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut shade = shot.clone();
    for (i, color) in shade.color.iter_mut().enumerate() {
        *color = [if i % 96 < 48 { 0.0 } else { (i % 96) as f32 / 96.0 }, 0.0, 0.0, 0.0];
    }
    let (image, _depth) = rig.scene(&shade);
    let view_projection = shot.camera.projection_matrix() * shot.camera.view_matrix();
    shot.shadow = Some(
        Shadow::new(image.host_image(), view_projection.to_cols_array_2d())
            .with(|it| it.bias = 0.1),
    );
    let drawn = rig.draw(&shot);
    let shore = drawn.shore.as_ref().expect("foam");
    let mut seen = 0;
    for (i, texel) in shore.data.iter().enumerate() {
        if texel[0] > 0 || texel[1] > 0 {
            seen += 1;
            let expected = if i % 96 < 48 { 1.0 } else { 1.0 - (i % 96) as f64 / 96.0 };
            assert!(
                (f64::from(texel[2]) / 255.0 - expected).abs() < 1.0 / 255.0 + 4.0 * U,
                "{i}: {texel:?}"
            );
        }
    }
    assert!(seen > 1000, "{seen}");
    let mut lit = Image::new(96, 64, [0.0_f32; 4]);
    lit.data.copy_from_slice(&drawn.output.data);
    assert!(lit.data.iter().all(|c| c.iter().all(|v| v.is_finite())));
    check("shade", &shot, &drawn);
}

/// If the scene's depth contains the surface itself, the bias makes its foam visible.
#[test]
fn a_bias_lets_the_surface_be_in_the_depth() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let mut shot = shot(&coasts, &[]);
    let level = water(&shot, DVec3::Y, 0.0);
    shot.scene_depth(|x, y| {
        let z = level.at([f64::from(x) + 0.5, f64::from(y) + 0.5]).depth.value;
        (z > 0.0 && z < 50.0).then_some(z - 0.05)
    });
    let mut rig = Rig::lit(&gpu, &with_shore(shot.size, Edge::Smooth), 1);
    let count = |drawn: Drawn| {
        let shore = drawn.shore.expect("foam");
        shore.data.iter().filter(|c| c[0] > 0).count()
    };
    let near = |bias| Shot {
        shore: shot.shore.map(|shore| shore.with(|it| it.bias = bias)),
        ..shot.clone()
    };
    let hidden = count(rig.draw(&near(0.0)));
    let seen = count(rig.draw(&near(0.2)));
    // Foam that shows without the bias lies beyond 50 m, where the scene's depth is empty.
    assert!(hidden < 10 && seen > 500, "{hidden} and {seen}");
}

/// The coat is blended where the format permits it, and otherwise mixed with the scene colour that
/// is read. Both show all foam, in the same colour.
///
/// Half precision errs by 2^-10 of a value (a device may round towards 0), eight bits by a step
/// (either neighbour may be written: Vulkan 1.3, "Conversion from Floating-Point to Normalized
/// Fixed-Point"). A blend rounds the input, the remaining fraction, the product and the sum.
#[test]
fn the_coat_is_the_same_in_every_format() {
    use ash::vk::Format;
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let mut shot = shot(&coasts, &[]);
    // Values are below 1, because not every format can hold more.
    shot.settings.light.irradiance = [1.0, 2.0, 3.0];
    let mut first: Option<Image<[u8; 4]>> = None;
    for way in WAYS {
        for (format, relative, absolute) in [
            (Format::R32G32B32A32_SFLOAT, 0.0, 0.0),
            (Format::R16G16B16A16_SFLOAT, 1.0 / 1024.0, 0.0),
            (Format::R8G8B8A8_UNORM, 0.0, 1.0 / 255.0),
        ] {
            let blended = way == Shading::Raster && format != Format::R32G32B32A32_SFLOAT;
            let roundings = if blended { 4.0 } else { 1.0 };
            let name = format!("{way:?}, {format:?}");
            let base = with_shore(shot.size, Edge::Smooth);
            let config = base.with(|it| {
                it.composite = Some(way);
                it.output_format = format;
            });
            let mut rig = Rig::lit(&gpu, &config, 1);
            let bare = rig.draw(&Shot { shore: None, ..shot.clone() }).output;
            let drawn = rig.draw(&shot);
            let foam = drawn.shore.as_ref().expect("foam");
            let (mut seen, mut shown, mut worst) = (0, 0, 0.0_f64);
            for (i, texel) in foam.data.iter().enumerate() {
                let (found, under) = (drawn.output.data[i], bare.data[i]);
                if texel[..2] == [0, 0] {
                    assert_eq!(found, under, "{name}: {i} has no foam");
                    continue;
                }
                seen += 1;
                let expected = coated(&shot, *texel, under, true);
                let mut differs = false;
                for c in 0..3 {
                    let size = expected[c].abs() + f64::from(under[c]);
                    let most = OFF + roundings * (relative * size + absolute);
                    let off = (f64::from(found[c]) - expected[c]).abs();
                    worst = worst.max(off / most);
                    assert!(
                        off <= most,
                        "{name}: {i}: {found:?}, expected {expected:?}, foam {texel:?}"
                    );
                    differs |= (expected[c] - f64::from(under[c])).abs() > most;
                }
                assert!(!differs || found[..3] != under[..3], "{name}: {i} shows nothing");
                shown += u32::from(differs);
            }
            println!(
                "{name}: {seen} pixels with foam, {shown} that must show it, {worst:.2} of the bound"
            );
            assert!(seen > 1000 && 10 * shown > 8 * seen, "{name}: {shown} of {seen}");
            let first = first.get_or_insert_with(|| foam.clone());
            assert_eq!(first.data, foam.data, "{name}: other foam");
        }
    }
}

/// Whether the coat is blended, or mixed with the scene by raster or by compute, the output keeps its
/// alpha.
#[test]
fn the_coat_keeps_the_output_s_alpha() {
    use ash::vk::Format;
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let mut shot = shot(&coasts, &[]);
    shot.color.iter_mut().for_each(|color| color[3] = 0.5);
    for way in WAYS {
        // The raster path blends the second.
        for format in [Format::R32G32B32A32_SFLOAT, Format::R16G16B16A16_SFLOAT] {
            let config = with_shore(shot.size, Edge::Smooth).with(|it| {
                it.composite = Some(way);
                it.output_format = format;
            });
            let mut rig = Rig::lit(&gpu, &config, 1);
            for in_place in [true, false] {
                rig.config.in_place = in_place;
                let name = format!("{way:?}, {format:?}, in place {in_place}");
                let drawn = rig.draw(&shot);
                let foam = drawn.shore.as_ref().expect("foam");
                let foam = foam.data.iter().filter(|texel| texel[..2] != [0, 0]).count();
                assert!(foam > 1000, "{name}: {foam} pixels with foam");
                let other = drawn.output.data.iter().find(|color| color[3] != 0.5);
                assert_eq!(other, None, "{name}");
            }
        }
    }
}
