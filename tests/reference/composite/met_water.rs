//! Colour of the scene where a reflected or refracted ray hits it, seen through the water that lies
//! there: a level layer over a bed.
//! ```text
//! wet = smoothstep(0.5, 0.7, t / room)      seen = dry + wet (F env + (1 - F) through(bed, h / cos_in) - dry)
//! ```
//! The layer has the thickness t along the eye's ray and the vertical height h. F and cos_in are
//! those of the marched ray at a level surface.

use glam::{DVec2, DVec3};

use super::super::{EMPTY, View, smoothstep};
use super::bed::{film, under_water};
use super::mirror::depth;
use super::sheets::{Behind, air};
use super::{Inputs, Settings, Under, lit_medium, scene_at, through};

/// Where a ray meets the scene, in pixels, and its direction in eye space.
pub type Meeting = (DVec2, DVec3);

/// How water lies on the scene at a position: fraction to which it touches the scene, and its
/// height; and the fraction to which it darkens the scene. With two sheets this is the back one.
fn lies(
    inputs: &Inputs<'_>,
    behind: Option<&Behind<'_>>,
    settings: &Settings,
    view: &View,
    at: DVec2,
) -> (f64, f64, f64) {
    let (x, y) = (at.x as usize, at.y as usize);
    let level = inputs.thickness_level;
    let texel = (x >> level, y >> level);
    let mut t = inputs.thickness.at(texel.0, texel.1);
    let mut z = inputs.depth.at(x, y);
    let boundary = behind.map_or(EMPTY, |behind| behind.boundaries.at(texel.0, texel.1));
    if let Some(behind) = behind.filter(|_| boundary < EMPTY && z < boundary) {
        let [front, back, window] = behind.thickness.at(texel.0, texel.1);
        let apart = air(window, settings.radius / 0.656);
        let back_z = behind.smoothed.at(x >> behind.level, y >> behind.level);
        z += apart * (back_z - z);
        t = back + (1.0 - apart) * front;
    }
    let room = depth(inputs, view, at) - z;
    if settings.bed.is_none() || room <= 0.0 || t <= 0.0 {
        return (0.0, 0.0, 0.0);
    }
    let up = view.view.transform_vector3(DVec3::Y);
    let height = (t.min(room) * -view.ray_at(at).dot(up)).max(0.0);
    (smoothstep(0.5, 0.7, t / room), height, film(settings, t.min(room)))
}

/// The colour there.
pub fn met_scene(
    inputs: &Inputs<'_>,
    behind: Option<&Behind<'_>>,
    settings: &Settings,
    view: &View,
    (at, along): Meeting,
    env: impl Fn(DVec3) -> DVec3,
) -> DVec3 {
    let dry = scene_at(inputs, at);
    let (wet, height, film) = lies(inputs, behind, settings, view, at);
    let Some(bed) = settings.bed.filter(|_| wet > 0.0) else { return dry };
    let up = view.view.transform_vector3(DVec3::Y);
    let under = Under { wet: 1.0, down: height, path: 0.0, film };
    let below = under_water(settings, &under, dry);
    let cosine = along.dot(up).abs();
    let inside = (1.0 - (1.0 - cosine * cosine) / bed.index.powi(2)).sqrt();
    let medium = lit_medium(settings, up, view);
    let through = through(&medium, below, height / inside);
    let world = view.view.inverse().transform_vector3(along);
    let mirrored = env(DVec3::new(world.x, world.y.abs(), world.z));
    dry.lerp(through.lerp(mirrored, settings.fresnel.reflectance(cosine)), wet)
}
