//! Compares contact foam on the host's water level and on the particles' water with the CPU twin.

use ash::vk;
use glam::DVec3;
use whitewater::shore::{ContactSettings, Edge, Measure, ShoreSettings, TextureLayer};
use whitewater::{Shore, Shoreline};

use super::{Tally, clock, is_shared, measure_of, shared_at, textures, water, with_shore};
use crate::reference::Image;
use crate::reference::shore::{Bounded, Contact, U, dot, exact};
use crate::support::device::Gpu;
use crate::support::host::Texture;
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::{self, Lens};

use super::SAMPLED;

/// The twin of these settings, on the host's surface and on the particles' surface.
pub fn twins(look: &ShoreSettings, spacing: f32) -> [Contact; 2] {
    let c = &look.contact;
    let depths = [c.depth, c.particle_depth.unwrap_or(4.0 * spacing)];
    let opacities = [c.opacity, c.particle_opacity];
    [0, 1].map(|i| {
        let numbers = [depths[i], c.mask, c.mask_scale, opacities[i]];
        Contact::new(clock(look), measure_of(c.measure), numbers, c.mask_speed)
    })
}

fn look(contact: ContactSettings) -> ShoreSettings {
    ShoreSettings::default().with(|it| {
        it.time = 3.25;
        it.contact = contact;
    })
}

/// A third texture layer, which selects the general pipeline.
fn more_layers(shot: &mut Shot) {
    shot.settings.shore.shoreline.layers[2] =
        TextureLayer { weight: 0.1, scale: 0.1, ..TextureLayer::NONE };
}

/// Eye depth of the scene as the shader computes it in single precision.
pub fn scene_of(shot: &Shot, i: usize) -> Option<Bounded> {
    let view = shot.view(shot.size);
    let device = exact(f64::from(shot.depth[i]));
    let z = exact(view.projection.w_axis.z) / (device + view.projection.z_axis.z);
    (z.low() > 0.0 && z.high() < 1.0e3).then_some(z)
}

/// A mask image from the host that covers the view.
fn mask(rig: &Rig<'_>) -> (Texture, Image<f32>) {
    let image = Image::from_fn(24, 16, |x, y| (x * 5 + y * 3) as f32 % 7.0 / 5.0 - 0.1);
    let usage = vk::ImageUsageFlags::SAMPLED;
    let format = vk::Format::R32_SFLOAT;
    let bytes = bytemuck::cast_slice(&image.data);
    (rig.stub.uploaded(format, extent(24, 16), usage, bytes, SAMPLED), image)
}

#[test]
fn a_level_s_contacts_are_the_twin_s() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let (texture, pattern) = mask(&rig);
    let base = ContactSettings::default().with(|it| {
        it.depth = 0.8;
        it.mask_scale = 0.3;
    });
    for (name, lens, contact, own) in [
        ("distance", Lens::Standard, base, false),
        ("view", Lens::Reversed, base.with(|it| it.measure = Measure::View), false),
        ("vertical", Lens::ReversedInfinite, base.with(|it| it.measure = Measure::Vertical), false),
        ("alone", Lens::Standard, base, false),
        (
            "no mask",
            Lens::LeftHanded,
            base.with(|it| {
                it.mask = 0.0;
                it.opacity = 0.6;
            }),
            false,
        ),
        (
            "host's",
            Lens::OffAxis,
            base.with(|it| {
                it.mask = 1.0;
                it.depth = 2.0;
            }),
            true,
        ),
    ] {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        let level = water(&shot, DVec3::Y, 0.25);
        // A slanted wall, and a seabed that slopes away.
        shot.scene_depth(|x, y| {
            let z = level.at([f64::from(x) + 0.5, f64::from(y) + 0.5]).depth.value;
            let wall = 5.0 + 0.03 * f64::from(x) - 0.01 * f64::from(y);
            let bottom = if z > 0.0 { z + 0.004 * (f64::from(x) - 20.0) } else { 80.0 };
            Some(wall.min(bottom).clamp(0.2, 80.0))
        });
        let mask = own.then(|| texture.host_image());
        // Objects before the surface by less than the bias count as behind it; they still make no
        // foam.
        shot.shore = Some(Shore::new(0.25).with(|it| {
            it.mask = mask;
            it.bias = 0.05;
        }));
        shot.settings.shore = look(contact);
        if name == "alone" {
            more_layers(&mut shot);
        }
        let found = rig.draw(&shot).shore.expect("contact foam");
        let [twin, _] = twins(&shot.settings.shore, shot.settings.water.spacing);
        let [_, web] = textures();
        let mut tally = Tally::default();
        for (i, texel) in found.data.iter().enumerate() {
            let (x, y) = (i % found.width, i / found.width);
            assert_eq!(texel[0], 0, "no shore");
            let point = level.at([x as f64 + 0.5, y as f64 + 0.5]);
            let Some(scene) = scene_of(&shot, i).filter(|_| point.depth.low() > 0.0) else {
                if point.depth.high() < 0.0 {
                    tally.add((x, y), texel[1], exact(0.0));
                }
                continue;
            };
            let up = [level.up[0], level.up[1], level.up[2]];
            let t = twin.part([point.depth, scene], point.ray, up);
            let (at, off) = shared_at(is_shared(&shot), [x, y]);
            let middle = level.at(at);
            if middle.depth.low() <= 0.0 {
                continue;
            }
            let masked = if own {
                twin.mask_of(exact(f64::from(pattern.at(x / 4, y / 4))))
            } else {
                twin.masked(web, &middle, off)
            };
            tally.add((x, y), texel[1], twin.amount(t, masked));
        }
        tally.check(name, 100, 0.05);
        // With opacity 0 there is no foam.
        shot.settings.shore.contact.opacity = 0.0;
        let found = rig.draw(&shot).shore.expect("contact foam");
        assert!(found.data.iter().all(|c| *c == [0; 4]), "{name}: of no opacity");
    }
}

/// The smoothed surface at a pixel, interpolated between texels of 2x2 pixels that belong to the
/// pixel's own surface. None if rounding decides which texels belong to it.
fn smoothed(
    surface: &Image<f32>,
    (x, y): (usize, usize),
    front: f64,
    threshold: f64,
) -> Option<Bounded> {
    let at = glam::DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / 2.0;
    let (mut sum, mut all) = (0.0, 0.0);
    for (i, j, weight) in surface.bilinear(at) {
        let off = f64::from(surface.clamped(i, j)) - front;
        if (off.abs() - threshold).abs() < 4.0 * U * front {
            return None;
        }
        if off.abs() <= threshold {
            (sum, all) = (sum + weight * off, all + weight);
        }
    }
    let z = if all > 0.0 { front + sum / all } else { front };
    Some(exact(z).wider(4.0 * U * front))
}

/// On the particles' water the surface is the smoothed depth, whatever surface the host gives.
#[test]
fn contacts_on_particles_are_the_twin_s() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    // Posts one pixel wide, about one per tile: few pixels have foam, and no tile with foam may be
    // skipped.
    for (name, lens, contact) in [
        ("posts", Lens::Reversed, ContactSettings::default()),
        ("posts, alone", Lens::OffAxis, ContactSettings::default()),
        ("distance", Lens::Standard, ContactSettings::default()),
        ("view", Lens::Reversed, ContactSettings::default().with(|it| it.measure = Measure::View)),
        (
            "vertical",
            Lens::LeftHanded,
            ContactSettings::default().with(|it| {
                it.measure = Measure::Vertical;
                it.mask = 0.3;
            }),
        ),
    ] {
        let contact = contact.with(|it| {
            it.particle_opacity = 0.9;
            it.mask_scale = 0.3;
        });
        let mut shot = Shot::new(size, lens, 0.2, &points);
        shot.settings.shore = look(contact);
        let posts = name.starts_with("posts");
        shot.scene_depth(|x, y| match posts && !(7 * x + 3 * y).is_multiple_of(61) {
            true => Some(60.0),
            false => Some(3.6 + 0.02 * f64::from(x)),
        });
        if name == "posts, alone" {
            more_layers(&mut shot);
        }
        shot.shore = Some(Shore::new(0.0).with(|it| it.surface = None));
        let drawn = rig.draw(&shot);
        let found = drawn.shore.as_ref().expect("contact foam");
        let level = water(&shot, DVec3::Y, 0.0);
        let [_, twin] = twins(&shot.settings.shore, shot.settings.water.spacing);
        let [_, web] = textures();
        let mut tally = Tally::default();
        let threshold = f64::from(shot.falloff());
        let mut above = 0;
        for (i, texel) in found.data.iter().enumerate() {
            let (x, y) = (i % found.width, i / found.width);
            assert_eq!(texel[..2], [0, 0], "neither shore nor surface");
            let front = f64::from(drawn.depth.data[i]);
            if front > 1.0e9 {
                tally.add((x, y), texel[3], exact(0.0));
                continue;
            }
            let Some(z) = smoothed(&drawn.surface, (x, y), front, threshold) else { continue };
            let Some(scene) = scene_of(&shot, i) else { continue };
            let point = level.at_depth(level.ray([x as f64 + 0.5, y as f64 + 0.5]), z);
            let up = [level.up[0], level.up[1], level.up[2]];
            // Where the smoothed surface lies behind the scene, its distance to the scene is 0.
            let behind = scene.rising(|scene| scene.max(z.high()));
            let t = twin.part([z, behind], point.ray, up).max(0.0);
            let part = twin.masked(web, &point, [0.0; 2]);
            let amount = twin.amount(t, part);
            above += u32::from(dot(up, point.ray).low() > 0.0);
            tally.add((x, y), texel[3], amount);
        }
        tally.check(name, if posts { 15 } else { 100 }, 0.05);
        // The wall also rises above the water's surface, where the ray points upwards.
        println!("{name}: {above} pixels look up");
        assert!(name != "vertical" || above > 50, "{name}: {above} pixels look up");
        shot.settings.shore.contact.particle_opacity = 0.0;
        let found = rig.draw(&shot).shore.expect("contact foam");
        assert!(found.data.iter().all(|c| *c == [0; 4]), "{name}: of no opacity");
    }
}

/// A finite far plane is not a surface: without a scene there is no contact foam, however near to
/// that plane the water comes, and no shoreline foam from the seabed's depth.
#[test]
fn nothing_is_not_at_the_far_plane() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let points = scenes::block(3, 2.5, [12, 8, 4], [-14.0, -8.0, 50.0]);
    let far = f64::from(scenes::FAR);
    for lens in [Lens::Standard, Lens::Reversed, Lens::Mirrored, Lens::LeftHanded] {
        let mut shot = Shot::new(size, lens, 2.0, &points);
        let contact = ContactSettings::default().with(|it| {
            it.depth = 90.0;
            it.measure = Measure::View;
        });
        let particles = (Some(90.0), 0.9);
        shot.settings.shore = look(contact.with(|it| {
            it.particle_depth = particles.0;
            it.particle_opacity = particles.1;
        }));
        // As wide as the water in front of the wall below.
        shot.settings.shore.shoreline.sea_reach = 90.0;
        let level = water(&shot, DVec3::Y, 0.0);
        let before = (0..96 * 64)
            .map(|i| level.at([(i % 96) as f64 + 0.5, (i / 96) as f64 + 0.5]).depth.value)
            .filter(|z| (10.0..far).contains(z));
        assert!(before.count() > 500, "{lens:?}: the level comes to the plane");
        for (name, shoreline, layers) in [
            ("together", None, 2),
            ("alone", None, 4),
            ("by the depth alone", Some(Shoreline::Screen), 2),
        ] {
            let name = format!("{lens:?}, {name}");
            shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = shoreline));
            for (i, layer) in shot.settings.shore.shoreline.layers.iter_mut().enumerate() {
                (layer.weight, layer.scale) = (if i < layers { 0.25 } else { 0.0 }, 0.2);
            }
            // A wall a little nearer than the far plane has all foam.
            for (at, seen) in [(Some(0.98 * far), true), (None, false)] {
                shot.scene_depth(|_, _| at);
                let foam = rig.draw(&shot).shore.expect("foam");
                let count = |c: usize| foam.data.iter().filter(|texel| texel[c] > 0).count();
                let counts = [count(1), count(3)];
                println!("{name}, {at:?}: {counts:?}");
                assert!(
                    counts.iter().all(|n| if seen { *n > 500 } else { *n == 0 }),
                    "{name}, {at:?}"
                );
                let shores = shoreline.is_some() && seen;
                assert_eq!(count(0) > 0, shores, "{name}, {at:?}: {} along shores", count(0));
            }
        }
    }
}
