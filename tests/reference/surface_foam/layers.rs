//! The foam images, and the foam that a pixel shows.

use super::super::thickness::kernel;
use super::super::{EMPTY, Image, View, is_surface};
use super::ellipse::Ellipse;
use super::noise::noise;
use super::texels::{in_full, pixels, scene_depth};
use super::{Settings, Sprite};
use glam::DVec2;

/// Depth of the frontmost foam in each texel, in world units. Texels are blocks of `2^level` x
/// `2^level` pixels. `scene`: eye depth of the scene at the view's resolution, infinite or
/// [`EMPTY`] where there is nothing.
pub fn depth(
    sprites: &[Sprite],
    view: &View,
    level: u32,
    settings: &Settings,
    scene: &Image<f64>,
) -> Image<f64> {
    let (view, near) = (&view.reduced(level), view.near());
    let mut depth = Image::new(view.width, view.height, EMPTY);
    for sprite in sprites {
        let Some(foam) = sprite.part_beyond(near) else { continue };
        let ellipse = Ellipse::deep(sprite, foam, view, settings);
        for (x, y) in pixels(view, sprite.center, ellipse.half.x) {
            let hit = ellipse.meet(view.ray(x, y), near);
            let hidden = scene_depth(in_full(scene, x, y, level));
            if let Some(hit) = hit.filter(|hit| hit.k < hidden) {
                let pixel = depth.at_mut(x, y);
                *pixel = pixel.min(hit.k);
            }
        }
    }
    depth
}

/// Three thicknesses of foam along z in each texel, in world units: of all foam; of foam at most
/// [`Settings::front_depth`] behind `foam_depth`, which comes from [`depth`]; and of all foam
/// weighted by its distance behind that. Where there is no depth, the second and the third are 0.
pub fn thickness(
    sprites: &[Sprite],
    view: &View,
    level: u32,
    settings: &Settings,
    scene: &Image<f64>,
    foam_depth: &Image<f64>,
) -> Image<[f64; 3]> {
    let (view, near) = (&view.reduced(level), view.near());
    let mut thickness = Image::new(view.width, view.height, [0.0; 3]);
    for sprite in sprites {
        let Some(foam) = sprite.part_beyond(near) else { continue };
        let (ellipse, torn) = Ellipse::thick(sprite, view, settings);
        let amplitude = ellipse.amplitude(foam, settings);
        for (x, y) in pixels(view, sprite.center, ellipse.half.x) {
            let hit = ellipse.meet(view.ray(x, y), near);
            let hidden = scene_depth(in_full(scene, x, y, level));
            let Some(hit) = hit.filter(|hit| hit.k < hidden) else { continue };
            let torn = 1.0 + torn * noise(sprite.place(hit.at.x, hit.at.y, settings));
            let value = amplitude * kernel(hit.at.length_squared()) * torn.max(0.0);
            let value = value * settings.sunk(hidden - hit.k);
            let nearest = foam_depth.at(x, y);
            let front = if is_surface(nearest) { settings.within(hit.k - nearest) } else { 0.0 };
            let texel = thickness.at_mut(x, y);
            texel[0] += value;
            texel[1] += value * front;
            texel[2] += value * settings.far(hit.k - nearest);
        }
    }
    thickness
}

/// The foam that a pixel shows: the nearest depth of the texels around it, [`EMPTY`] if there is
/// none, and both thicknesses by bilinear weights of four texels. Texels whose foam lies more than
/// a spacing behind the scene at the pixel are ignored.
pub fn seen(
    (depth, thickness): (&Image<f32>, &Image<[f32; 2]>),
    (x, y): (usize, usize),
    level: u32,
    scene: f64,
    spacing: f64,
) -> (f64, [f64; 2]) {
    let at = (DVec2::new(x as f64, y as f64) + 0.5) / f64::from(1_u32 << level);
    let end = (scene_depth(scene) + spacing).min(EMPTY);
    let mut found = (EMPTY, [0.0; 2]);
    for (x, y, weight) in depth.bilinear(at) {
        let z = f64::from(depth.clamped(x, y));
        if weight > 0.0 && is_surface(z) && z < end {
            found.0 = z.min(found.0);
        }
        if z < end || !is_surface(z) {
            let there = thickness.clamped(x, y);
            (0..2).for_each(|i| found.1[i] += weight * f64::from(there[i]));
        }
    }
    found
}
