//! Foam of shores and contacts in the shade of the host's scene.

use glam::{Mat4, Vec3};
use whitewater::shore::Edge;
use whitewater::water::Shadows;
use whitewater::{Config, Shadow};

use super::composite::{OFF, WAYS, coasts, coated, shot};
use super::with_shore;
use crate::light::shadows;
use crate::reference::Image;
use crate::support::device::Gpu;
use crate::support::rig::Rig;
use crate::support::scenes;

/// Foam on the particles' water and on the host's surface behind it in one pixel, each in the sun or not by itself: a light
/// along the view or against it, and a plane of shade between both.
#[test]
fn foam_on_particles_and_behind_them_has_its_own_light() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    // Before 3.6 m. The level is farther where they are seen.
    let points = scenes::block(3, 0.25, [14, 6, 3], [-1.6, -0.6, 3.0]);
    let mut shot = shot(&coasts, &points);
    let contact = &mut shot.settings.shore.contact;
    (contact.particle_depth, contact.particle_opacity) = (Some(80.0), 0.9);
    let eye = shot.camera.view;
    let along = eye.inverse().transform_vector3(Vec3::NEG_Z);
    let lens = Mat4::orthographic_rh(-90.0, 90.0, -90.0, 90.0, 0.0, 100.0);
    let back = Mat4::look_to_rh(Vec3::new(0.0, 0.0, -100.0), Vec3::Z, Vec3::Y);
    for way in WAYS {
        let map = Config {
            composite: Some(way),
            shadow: Some(Shadows::Map),
            ..with_shore(shot.size, Edge::Smooth)
        };
        let mut rig = Rig::lit(&gpu, &map, 1);
        for (name, view_projection, sun, depth, lost) in [
            ("along", lens * eye, -along, 0.036, [0, 255]),
            ("against", lens * back * eye, along, 0.964, [255, 0]),
        ] {
            let name = format!("{way:?}, {name}");
            let image = shadows(&rig, Shadows::Map, &Image::new(2, 2, depth));
            shot.settings.light.direction = sun.to_array();
            shot.sun.shadow =
                Some(Shadow { image: image.host_image(), view_projection, bias: 0.0 });
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
