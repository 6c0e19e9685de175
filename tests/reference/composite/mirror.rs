//! Reflection of the scene by a surface: a march along the ray on the screen, with steps that grow
//! from a 128th of the picture's height until the ray leaves the view, each compared with the
//! scene's depth; then six bisections and a secant step.

use glam::{DVec2, DVec3};

use super::super::surface::Surface;
use super::super::{EMPTY, View};
use super::{Inputs, Settings};

/// What a ray meets of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Met {
    /// Position in pixels.
    pub at: DVec2,
    /// Fraction that is visible; 0: the ray meets nothing.
    pub share: f64,
}

/// A ray, and the factor by which its first step is longer.
#[derive(Clone, Copy, Debug)]
struct Ray {
    from: DVec3,
    along: DVec3,
    stretch: f64,
}

pub fn on_screen(view: &View, eye: DVec3) -> DVec3 {
    let slope = eye.truncate() / -eye.z;
    ((slope - view.ray_at(DVec2::ZERO).truncate()) / view.slope_step()).extend(-1.0 / eye.z)
}

/// Depth of the scene in a pixel; the far plane counts as empty.
pub fn depth(inputs: &Inputs<'_>, view: &View, at: DVec2) -> f64 {
    let (scene, depth) = (inputs.scene_depth, inputs.depth);
    let texel = |at: f64, texels: usize, pixels: usize| {
        ((at.max(0.0) * texels as f64 / pixels as f64) as usize).min(texels - 1)
    };
    let z =
        scene.at(texel(at.x, scene.width, depth.width), texel(at.y, scene.height, depth.height));
    if z < 0.9999 * view.far().unwrap_or(EMPTY).min(EMPTY) { z } else { EMPTY }
}

fn march(inputs: &Inputs<'_>, view: &View, ray: Ray, steps: u32) -> Met {
    let Ray { from, along, stretch } = ray;
    let (z, extent) = (-from.z, view.extent());
    let towards = if along.z > 0.0 { 0.75 * z / along.z } else { f64::INFINITY };
    let start = on_screen(view, from);
    let way = on_screen(view, from + along * towards.min(64.0 * z)) - start;
    // To the centre of the last pixel in this direction. A ray that stays in its column, or row, never leaves it there.
    let end = |axis: usize| {
        let edge = if way[axis] > 0.0 { extent[axis] - 0.5 } else { 0.5 };
        if way[axis].abs() < 1e-6 { f64::INFINITY } else { (edge - start[axis]) / way[axis] }
    };
    let whole = end(0).min(end(1)).clamp(0.0, 1.0);
    let pixels = whole * way.truncate().length();
    let first = (extent.y / 128.0 / pixels.max(1e-6)).min(1.0) * stretch;
    let growth = first.min(1.0).recip().powf(1.0 / (f64::from(steps) - 1.0).max(1.0));
    let gap = |part: f64| {
        let at = start + way * part;
        let scene = depth(inputs, view, at.truncate());
        (at.z.recip() - scene, scene)
    };
    let (mut free, mut front, mut before) = ((0.0, -1.0), true, z);
    for step in 0..steps {
        let part = (whole * first * growth.powi(step as i32)).min(whole);
        let (by, scene) = gap(part);
        let here = (start.z + way.z * part).recip();
        if front && by > 0.0 && by <= 2.0 * (here - before).abs() + scene / 32.0 {
            let mut behind = (part, by);
            for _ in 0..6 {
                let middle = 0.5 * (free.0 + behind.0);
                let (by, _) = gap(middle);
                *(if by > 0.0 { &mut behind } else { &mut free }) = (middle, by);
            }
            // Objects in front of the ray alone do not count.
            let depth = |part: f64| (start.z + way.z * part).recip();
            let high = depth(behind.0);
            let deep = 2.0 * (high - depth(free.0)).abs() + (high - behind.1) / 32.0;
            if behind.1 > deep {
                return Met::default();
            }
            let straight = free.0 > 0.0 && free.1 > -0.5 * EMPTY;
            let part = if straight {
                (free.0 * behind.1 - behind.0 * free.1) / (behind.1 - free.1)
            } else {
                behind.0
            };
            let at = start.truncate() + way.truncate() * part;
            let fade = at.min(extent - at).min_element() / (extent.y / 16.0);
            return Met { at, share: fade.clamp(0.0, 1.0) };
        }
        (free, front, before) = ((part, by), by <= 0.0, here);
    }
    Met::default()
}

/// What a ray from a position in a direction meets in this number of steps, with the first step
/// multiplied by a factor.
pub fn march_from(
    inputs: &Inputs<'_>,
    view: &View,
    (from, along, stretch): (DVec3, DVec3, f64),
    steps: u32,
) -> Met {
    march(inputs, view, Ray { from, along, stretch }, steps)
}

/// What a surface mirrors of the scene.
pub fn met(inputs: &Inputs<'_>, settings: &Settings, surface: &Surface, view: &View) -> Met {
    let along = direction(surface);
    let ray = Ray { from: surface.position, along, stretch: 1.0 };
    march(inputs, view, ray, settings.mirror_steps)
}

/// The mirrored direction in eye space.
pub fn direction(surface: &Surface) -> DVec3 {
    let (n, v) = (surface.normal, -surface.position.normalize());
    2.0 * n.dot(v) * n - v
}

/// What a surface mirrors, the error of its position in pixels for a rotated direction and a
/// relative error of the surface's position, and whether the ray may meet something else. The
/// errors come from marches of rays with these deviations in both directions.
pub fn met_about(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    (turned, scaled): (f64, f64),
) -> (Met, f64, bool) {
    let found = met(inputs, settings, surface, view);
    let plain = Ray { from: surface.position, along: direction(surface), stretch: 1.0 };
    let sides = [-1.0, 1.0].into_iter();
    let rays = sides.flat_map(|side| {
        let turn = |axis: DVec3| Ray {
            along: (plain.along + axis * (side * turned)).normalize(),
            ..plain
        };
        let scale = |by: f64| 1.0 + side * by;
        [
            turn(DVec3::X),
            turn(DVec3::Y),
            turn(DVec3::Z),
            Ray { from: plain.from * scale(scaled), ..plain },
            Ray { stretch: scale(8.0 * scaled), ..plain },
        ]
    });
    let others: Vec<_> = rays.map(|ray| march(inputs, view, ray, settings.mirror_steps)).collect();
    let off = others.iter().map(|other| other.at.distance(found.at)).fold(0.0, f64::max);
    let sure = others.iter().all(|other| (other.share > 0.0) == (found.share > 0.0)) && off < 1.0;
    (found, off, sure)
}
