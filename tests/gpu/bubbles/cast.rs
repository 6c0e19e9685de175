//! The shadow of blobs: the sunlight that they leave to the scene.

use glam::{DVec2, DVec3, Vec3};
use whitewater::LightVolume;
use whitewater::bubbles::BubbleConfig;
use whitewater::headless::Bubble;

use crate::reference::Image;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens};

/// Radius of the core that casts a shadow, and the fraction of light that it leaves
/// (glsl/bubbles/cast.comp, glsl/include/sunlight.glsl).
const CORE: f64 = 0.78;
const LEFT: f64 = 0.15;

/// A blob's shadow on a wall, with light from the side: fully dark inside its outline, no shadow
/// outside.
#[test]
fn a_blob_casts_the_shadow_of_its_core() {
    let gpu = Gpu::shared();
    let size = extent(128, 96);
    let bubbles = BubbleConfig::new(4).with(|it| {
        it.variants = 1;
        it.bubbles = 32;
    });
    let edge = 256;
    let config = config(size).with(|it| {
        it.bubbles = Some(bubbles);
        it.light_map_size = Some(edge);
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    for (lens, radius) in [(Lens::Standard, 0.5_f32), (Lens::LeftHanded, 0.45)] {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        let depth = 5.0;
        shot.scene_depth(|_, _| Some(depth));
        let points = [[-0.9, 0.3, 3.4], [0.0, 0.0, 4.0], [-0.5, 0.2, 2.9]];
        let [at, middle, sunward] =
            [0, 1, 2].map(|i| Vec3::from(scenes::world(&shot.camera, &points)[i]));
        let sun = (sunward - middle).normalize();
        shot.settings.light.direction = sun.to_array();
        shot.settings.light.irradiance = [2.0; 3];
        shot.settings.light.shade = [0.0; 3];
        let region = LightVolume { center: middle.to_array(), radius: 4.0 };
        shot.light_volume = Some(region);
        let lit = rig.draw(&shot).output;
        shot.blobs = vec![
            Bubble { ball: at.extend(radius).to_array(), turn: [0.0, 0.0, 0.0, 1.0], id: 0 },
            Bubble { ball: [f32::NAN; 4], turn: [0.0; 4], id: 1 },
        ];
        let drawn = rig.draw(&shot);
        let soap = drawn.soap.as_ref().expect("bubble foam");
        let view = shot.view(size);
        let back = view.view.inverse();
        // The filter covers two texels of the blobs' map to each side along both of its axes. That
        // map has half the resolution.
        let blur = 2.0 * f64::from(2.0 * region.radius) / f64::from(edge / 2);
        let toward = sun.as_dvec3();
        let right = DVec3::Y.cross(toward).normalize();
        let axes = [right, toward.cross(right)];
        let (mut dark, mut light) = (0, 0);
        for y in 0..drawn.output.height {
            for x in 0..drawn.output.width {
                if soap.color.at(x, y)[3] > 0.0 {
                    continue;
                }
                let p: DVec3 = back.transform_point3(view.ray(x, y) * depth);
                let to = at.as_dvec3() - p;
                let beside = DVec2::from(axes.map(|axis| to.dot(axis).abs()));
                let [nearest, farthest] = [(beside - blur).max(DVec2::ZERO), beside + blur];
                let shares = [0, 1, 2]
                    .map(|c| f64::from(drawn.output.at(x, y)[c]) / f64::from(lit.at(x, y)[c]));
                let core = CORE * f64::from(radius);
                if farthest.length() < core {
                    dark += 1;
                    assert!(
                        shares.iter().all(|share| (share - LEFT).abs() < 2.0e-3),
                        "{lens:?} ({x}, {y}): {shares:?} of the light"
                    );
                } else if nearest.length() > core {
                    light += 1;
                    assert_eq!(shares, [1.0; 3], "{lens:?} ({x}, {y})");
                }
            }
        }
        println!("{lens:?}: {dark} pixels in the shadow, {light} beside it");
        assert!(
            dark > 20 && light > 2000,
            "{lens:?}: {dark} pixels in the shadow, {light} beside it"
        );
    }
}

/// A blob does not lie in the shadow of its own core, however coarse the map of shadows is: with the
/// sun behind the eye it looks as without the map.
#[test]
fn a_blob_does_not_shade_its_own_sunny_side() {
    let gpu = Gpu::shared();
    let size = extent(128, 96);
    let seen = |texels: Option<u32>| {
        let config = config(size).with(|it| {
            it.bubbles = Some(BubbleConfig::new(4).with(|it| (it.variants, it.bubbles) = (1, 32)));
            it.light_map_size = texels;
        });
        let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
        let at = Vec3::from(scenes::world(&shot.camera, &[[0.0, 0.0, 3.0]])[0]);
        let sun = shot.camera_view().inverse().transform_vector3(DVec3::new(0.1, 0.15, 1.0));
        shot.settings.light.direction = sun.normalize().as_vec3().to_array();
        shot.settings.light.shade = [0.0; 3];
        let turn = [0.0, 0.0, 0.0, 1.0];
        shot.blobs = vec![Bubble { ball: at.extend(0.5).to_array(), turn, id: 0 }];
        shot.light_volume = texels.map(|_| LightVolume { center: at.to_array(), radius: 4.0 });
        Rig::lit(&gpu, &config, 1).draw(&shot).soap.expect("bubble foam").color
    };
    let open = seen(None);
    let covered = open.data.iter().filter(|c| c[3] > 0.0).count();
    assert!(covered > 300, "{covered} pixels");
    let light = |image: &Image<[f32; 4]>| image.data.iter().map(|c| f64::from(c[0])).sum::<f64>();
    for texels in [256, 128] {
        let lost = 1.0 - light(&seen(Some(texels))) / light(&open);
        println!("{texels} texels: {lost:.5} of the light is lost");
        // At the rim a few pixels lie deeper than what the map has beside them.
        assert!(lost.abs() < 0.002, "{texels} texels: {lost} of the light is lost");
    }
}
