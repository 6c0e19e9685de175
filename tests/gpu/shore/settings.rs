//! Each setting of shoreline and contact foam has an effect: a change of any one changes the
//! picture.

use whitewater::shore::{Edge, Measure, Noise, TextureLayer};
use whitewater::{Settings, Shore};

use super::composite::{coasts, shot};
use super::with_shore;
use crate::settings::{Change, all_show};
use crate::support::device::Gpu;
use crate::support::rig::Rig;
use crate::support::scenes;

/// Settings of shoreline foam, and of contact foam on the host's water level.
#[test]
fn every_setting_of_foam_on_the_level_shows() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let mut shot = shot(&coasts, &[]);
    // The scale of a noise has an effect only if its amplitude is not 0.
    shot.settings.shore.shoreline.warp = Noise { amplitude: 0.9, scale: 1.0 / 11.0 };
    let mut rig = Rig::lit(&gpu, &with_shore(shot.size, Edge::Smooth), 1);
    let base = shot.settings.clone();
    let changes: [Change; 50] = [
        ("time", |s| s.shore.time += 1.3),
        ("period", |s| s.shore.period = Some(5.0)),
        ("reach[0]", |s| s.shore.shoreline.sea_reach *= 1.5),
        ("reach[1]", |s| s.shore.shoreline.land_reach *= 1.5),
        ("frequency", |s| s.shore.shoreline.frequency *= 1.3),
        ("speed", |s| s.shore.shoreline.speed = 0.5),
        ("swing", |s| s.shore.shoreline.swing = 0.9),
        ("swing_amplitude", |s| s.shore.shoreline.swing_amplitude *= 2.0),
        ("swing_period", |s| s.shore.shoreline.swing_period *= 1.3),
        ("frequency_noise.amplitude", |s| s.shore.shoreline.frequency_noise.amplitude *= 2.0),
        ("frequency_noise.scale", |s| s.shore.shoreline.frequency_noise.scale *= 2.0),
        ("speed_noise.amplitude", |s| s.shore.shoreline.speed_noise.amplitude *= 3.0),
        ("speed_noise.scale", |s| s.shore.shoreline.speed_noise.scale *= 2.0),
        ("speed_period", |s| s.shore.shoreline.speed_period *= 1.3),
        ("wave_slope", |s| s.shore.shoreline.wave_slope += 0.5),
        ("wave_offset", |s| s.shore.shoreline.wave_offset += 0.5),
        ("floor", |s| s.shore.shoreline.floor = Some(0.3)),
        ("wave_weight", |s| s.shore.shoreline.wave_weight *= 1.5),
        ("texture_weight", |s| s.shore.shoreline.texture_weight *= 1.5),
        ("texture_slope", |s| s.shore.shoreline.texture_slope += 0.3),
        ("texture_offset", |s| s.shore.shoreline.texture_offset += 0.3),
        ("layers[0].weight", |s| s.shore.shoreline.layers[0].weight = 0.9),
        ("layers[1].scale", |s| s.shore.shoreline.layers[1].scale *= 1.5),
        ("layers[1].angle", |s| s.shore.shoreline.layers[1].angle += 20.0),
        ("layers[0].speed[0]", |s| s.shore.shoreline.layers[0].speed[0] += 0.1),
        ("layers[0].speed[1]", |s| s.shore.shoreline.layers[0].speed[1] += 0.1),
        ("layers[2]", |s| {
            let layer = TextureLayer { weight: 0.5, scale: 0.5, angle: -110.0, speed: [0.3, 0.0] };
            s.shore.shoreline.layers[2] = layer;
        }),
        ("texture_warp.amplitude", |s| s.shore.shoreline.texture_warp.amplitude *= 3.0),
        ("texture_warp.scale", |s| s.shore.shoreline.texture_warp.scale *= 2.0),
        ("texture_warp_velocity[0]", |s| s.shore.shoreline.texture_warp_velocity[0] += 0.3),
        ("texture_warp_velocity[1]", |s| s.shore.shoreline.texture_warp_velocity[1] += 0.3),
        ("threshold", |s| s.shore.shoreline.threshold -= 0.1),
        ("threshold_noise.amplitude", |s| s.shore.shoreline.threshold_noise.amplitude *= 2.0),
        ("threshold_noise.scale", |s| s.shore.shoreline.threshold_noise.scale *= 2.0),
        ("rise_noise.amplitude", |s| s.shore.shoreline.rise_noise.amplitude *= 2.0),
        ("rise_noise.scale", |s| s.shore.shoreline.rise_noise.scale *= 2.0),
        ("warp.amplitude", |s| s.shore.shoreline.warp.amplitude *= 2.0),
        ("warp.scale", |s| s.shore.shoreline.warp.scale *= 2.0),
        ("fade", |s| s.shore.shoreline.fade = 0.6),
        ("color", |s| s.shore.shoreline.color = [0.3; 3]),
        ("opacity", |s| s.shore.shoreline.opacity = 0.5),
        ("contact.depth", |s| s.shore.contact.depth *= 1.5),
        ("contact.measure", |s| s.shore.contact.measure = Measure::View),
        ("contact.mask", |s| s.shore.contact.mask = 0.2),
        ("contact.mask_scale", |s| s.shore.contact.mask_scale *= 2.0),
        ("contact.mask_speed[0]", |s| s.shore.contact.mask_speed[0] += 0.1),
        ("contact.mask_speed[1]", |s| s.shore.contact.mask_speed[1] += 0.1),
        ("contact.color", |s| s.shore.contact.color = [0.2; 3]),
        ("contact.lit", |s| s.shore.contact.lit = 1.0),
        ("contact.opacity", |s| s.shore.contact.opacity = 0.4),
    ];
    all_show("level", &base, &changes, |settings: &Settings| {
        shot.settings = settings.clone();
        rig.draw(&shot)
    });
}

/// Settings of contact foam on the particles' water.
#[test]
fn every_setting_of_contacts_on_the_particles_water_shows() {
    let gpu = Gpu::shared();
    let coasts = coasts(&gpu);
    let points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    let mut shot = shot(&coasts, &points);
    shot.scene_depth(|x, _| Some(3.6 + 0.02 * f64::from(x)));
    shot.shore = Some(Shore::new(0.0).with(|it| it.surface = None));
    shot.settings.shore.contact.particle_opacity = 0.9;
    let mut rig = Rig::lit(&gpu, &with_shore(shot.size, Edge::Smooth), 1);
    let base = shot.settings.clone();
    let changes: [Change; 3] = [
        ("contact.particle_depth", |s| s.shore.contact.particle_depth = Some(1.5)),
        ("contact.particle_opacity", |s| s.shore.contact.particle_opacity = 0.4),
        ("contact.measure", |s| s.shore.contact.measure = Measure::Vertical),
    ];
    all_show("particles", &base, &changes, |settings: &Settings| {
        shot.settings = settings.clone();
        rig.draw(&shot)
    });
}
