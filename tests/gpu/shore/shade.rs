//! Shoreline and contact foam in the shadow of the host's scene.

use ash::vk;
use glam::{DVec3, Mat4, Vec3};
use whitewater::shore::Edge;
use whitewater::water::Shadows;
use whitewater::{Shadow, Shore, Shoreline, Strip, Triangles};

use super::composite::{OFF, WAYS, check, coasts, coated, shot};
use super::{STEP, U, exact, water, with_shore};
use crate::light::shadows;
use crate::reference::Image;
use crate::reference::shore::{Bounded, Point};
use crate::support::device::Gpu;
use crate::support::host::HOST_WRITE;
use crate::support::rig::{Rig, Shot, stream};
use crate::support::scenes;

/// Texels of the shadow map. The first half of each row is under a roof.
const MAP: [usize; 2] = [24, 18];

/// Fraction of sunlight lost at a point of the level near the roof's edge. Nine filtered
/// comparisons, a texel apart, are a box of three texels; the result is the part of it under the
/// roof. Beside the map it is 0. None if rounding decides whether the point is beside the map.
fn under_the_roof(shot: &Shot, point: &Point, light: &Mat4, snapped: f64) -> Option<Bounded> {
    let [east, north] = point.place.map(|p| p.value);
    let p = DVec3::new(east, 0.0, north);
    let ray = point.ray.map(|r| r.value);
    let eye = shot.camera_view().inverse().w_axis.truncate().length();
    // The point is transformed to eye space and back, by a matrix that is itself rounded.
    let by = point.depth.error * DVec3::from(ray).length()
        + snapped
        + U * (8.0 * point.depth.value + 24.0 * (p.length() + 2.0 * eye));
    let rows = light.as_dmat4().transpose();
    let texels: [Bounded; 2] = std::array::from_fn(|i| {
        let (row, size) = ([rows.x_axis, rows.y_axis][i], MAP[i] as f64);
        let (long, at) = (row.truncate().length(), row.dot(p.extend(1.0)));
        let off = long * (by + 2.0 * U * p.length()) + 4.0 * U * (long * p.length() + row.w.abs());
        exact(size * (0.5 + 0.5 * at)).wider(0.5 * size * off + 4.0 * U * size)
    });
    let within = |low: f64, high: f64, size: usize| low > 0.0 && high < size as f64;
    let sure = texels.iter().zip(MAP).all(|(t, size)| within(t.low(), t.high(), size));
    let may = texels.iter().zip(MAP).all(|(t, size)| within(t.high(), t.low(), size));
    let part = (exact(0.5 * MAP[0] as f64 + 1.5) - texels[0]) / 3.0;
    match (sure, may) {
        // A sum of sixteen rounded weights.
        (true, _) => Some(part.clamp(0.0, 1.0).wider(24.0 * U)),
        (false, true) => None,
        (false, false) => Some(exact(0.0)),
    }
}

/// A shadow map with a roof that has a straight edge. The shade on the water follows from the
/// distance to the edge's shadow, for shoreline foam by a map and by a strip and for contact foam,
/// and the picture is darker by that.
#[test]
fn foam_is_in_the_shade_of_a_map() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let base = shot(&coasts, &[]);
    let config = with_shore(base.size, Edge::Smooth).with(|it| it.shadow = Some(Shadows::Map));
    let mut rig = Rig::lit(&gpu, &config, 1);
    let corners =
        [[3.0_f32, -9.0], [11.0, -9.0], [3.0, -1.0], [11.0, -9.0], [3.0, -1.0], [11.0, -1.0]];
    let vertices = corners.map(|[x, z]| [x, 0.0, z, 0.25 * (x - 3.0)]);
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let vertices = rig.stub.data(bytemuck::cast_slice(&vertices), usage);
    let strip = Shoreline::Strip(Strip {
        triangles: Triangles { positions: stream(&vertices, 0, 16), vertices: 6, indices: None },
        coordinates: stream(&vertices, 12, 16),
        before: HOST_WRITE,
        after: HOST_WRITE,
    });
    let bits = f64::from(1_u32 << gpu.limits().sub_pixel_precision_bits);
    let (sun, at) = (Vec3::new(0.6, 0.7, 0.3).normalize(), Vec3::new(7.0, 0.0, -5.0));
    let view = Mat4::look_to_rh(at + 30.0 * sun, -sun, Vec3::new(0.3, 0.0, 1.0));
    for (name, near, far, roof, shoreline) in [
        ("map", 0.0, 60.0, 0.2, base.shore.and_then(|shore| shore.shoreline)),
        ("reversed", 60.0, 0.0, 0.8, None),
        ("strip", 0.0, 60.0, 0.2, Some(strip)),
    ] {
        let light = Mat4::orthographic_rh(-6.0, 6.0, -5.0, 5.0, near, far) * view;
        let none = if near < far { 1.0 } else { 0.0 };
        let texels =
            Image::from_fn(MAP[0], MAP[1], |x, _| if 2 * x < MAP[0] { roof } else { none });
        let image = shadows(&rig, Shadows::Map, &texels);
        let mut shot = base.clone();
        shot.settings.light.direction = sun.to_array();
        let host = image.host_image();
        shot.shadow = Some(Shadow::new(host, light.to_cols_array_2d()).with(|it| it.bias = 0.1));
        // With a strip there is no contact foam, because where both cover a pixel one of them
        // determines the light.
        let is_strip = name == "strip";
        let surface = base.shore.and_then(|shore| shore.surface).filter(|_| !is_strip);
        shot.shore = Some(Shore::new(0.0).with(|it| {
            it.surface = surface;
            it.shoreline = shoreline;
        }));
        let drawn = rig.draw(&shot);
        let level = water(&shot, DVec3::Y, 0.0);
        let (mut seen, mut edge, mut dark) = ([0; 2], 0, 0);
        for (i, texel) in drawn.shore.as_ref().expect("foam").data.iter().enumerate() {
            if texel[0] == 0 && texel[1] == 0 {
                continue;
            }
            let point = level.at([(i % 96) as f64 + 0.5, (i / 96) as f64 + 0.5]);
            // The device snaps a strip's vertices to its sub-pixel grid, and interpolated positions
            // with them.
            let moved = point.change.iter().flatten().map(|c| c.value.abs()).sum::<f64>();
            let snapped = if is_strip { moved / bits } else { 0.0 };
            let Some(lost) = under_the_roof(&shot, &point, &light, snapped) else { continue };
            let off = (f64::from(texel[2]) / 255.0 - lost.value).abs();
            assert!(off < lost.error + STEP + 4.0 * U, "{name}, {i}: {texel:?}, expected {lost:?}");
            // The bound holds for 256 steps per pixel; with fewer steps vertices move more.
            let told = if is_strip { 0.01 * (256.0 / bits).max(1.0) } else { 0.01 };
            assert!(lost.error < told, "{name}, {i}: {lost:?} tells little");
            seen = [0, 1].map(|k| seen[k] + u32::from(texel[k] > 0));
            edge += u32::from((0.05..0.95).contains(&lost.value));
            dark += u32::from(lost.value == 1.0);
        }
        println!("{name}: {seen:?} pixels with foam, {edge} at the edge, {dark} in the dark");
        let kinds = [shoreline.is_some(), !is_strip];
        assert!((0..2).all(|k| (seen[k] > 300) == kinds[k]), "{name}: {seen:?}");
        assert!(edge > 50 && dark > 80, "{name}: {edge} {dark}");
        check(name, &shot, &drawn);
    }
}

/// Foam on the particles' water and on the host's surface behind it in one pixel, each lit
/// separately: the light shines along the view or against it, with a plane of shade between the
/// two.
#[test]
fn foam_on_particles_and_behind_them_has_its_own_light() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    // The particles end at 3.6 m, in front of the water level.
    let points = scenes::block(3, 0.25, [14, 6, 3], [-1.6, -0.6, 3.0]);
    let mut shot = shot(&coasts, &points);
    let contact = &mut shot.settings.shore.contact;
    (contact.particle_depth, contact.particle_opacity) = (Some(80.0), 0.9);
    let eye = shot.camera.view_matrix();
    let along = eye.inverse().transform_vector3(Vec3::NEG_Z);
    let lens = Mat4::orthographic_rh(-90.0, 90.0, -90.0, 90.0, 0.0, 100.0);
    let back = Mat4::look_to_rh(Vec3::new(0.0, 0.0, -100.0), Vec3::Z, Vec3::Y);
    for way in WAYS {
        let map = with_shore(shot.size, Edge::Smooth).with(|it| {
            it.composite = Some(way);
            it.shadow = Some(Shadows::Map);
        });
        let mut rig = Rig::lit(&gpu, &map, 1);
        for (name, view_projection, sun, depth, lost) in [
            ("along", lens * eye, -along, 0.036, [0, 255]),
            ("against", lens * back * eye, along, 0.964, [255, 0]),
        ] {
            let name = format!("{way:?}, {name}");
            let image = shadows(&rig, Shadows::Map, &Image::new(2, 2, depth));
            shot.settings.light.direction = sun.to_array();
            shot.shadow = Some(Shadow::new(image.host_image(), view_projection.to_cols_array_2d()));
            let found = rig.draw(&shot);
            let mut none = shot.clone();
            none.settings.shore.contact.particle_opacity = 0.0;
            let bare = rig.draw(&none);
            let [foam, host] = [&found, &bare].map(|drawn| drawn.shore.as_ref().expect("foam"));
            let (mut both, mut seen) = (0, 0);
            for (i, texel) in foam.data.iter().enumerate() {
                assert_eq!(
                    texel[..3],
                    host.data[i][..3],
                    "{name}, {i}: the host's foam is another"
                );
                let on_host = texel[0] > 0 || texel[1] > 0;
                if on_host && found.depth.data[i] < 3.6 {
                    assert_eq!(texel[2], lost[1], "{name}, {i}: {texel:?}");
                    both += u32::from(texel[3] > 0);
                }
                let under = bare.output.data[i];
                let expected = coated(&shot, [0, texel[3], lost[0], 0], under, true);
                for c in 0..3 {
                    let off = (f64::from(found.output.data[i][c]) - expected[c]).abs();
                    let found = found.output.data[i];
                    assert!(
                        off < OFF,
                        "{name}, {i}: {found:?}, expected {expected:?}, foam {texel:?}"
                    );
                }
                seen += u32::from(texel[3] > 0);
            }
            assert!(both > 100 && seen > 500, "{name}: {both} of {seen} pixels have both");
        }
    }
}
