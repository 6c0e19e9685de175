//! Twin of the motion vectors: from a visible point's position in the previous frame to its present
//! one.
//!
//! A point P in the present eye space that has moved by m was at `V' V^-1 (P - m)` in the previous
//! eye space, and is projected there by the previous lens. The scene does not move, so its m is 0.
//! Points at infinity are directions, which are rotated and not translated. For water and foam, m
//! is the mean displacement of particles near the frontmost surface, weighted by
//! `share sqrt(1 - rho^2) exp(-2 rho^2) near`. rho is defined as for the thickness, with half-axes
//! of at least 1.5 texels; `near = 1 - smoothstep(r, 3 r, |k - F|)`, with k the sprite's depth and
//! F that of the texel's surface: the nearest of its pixels, and the farthest if that is 3 r
//! behind.
//!
//! Every number has a bound of its error in single precision.

use super::cull::frustum;
use super::levels::Smoothed;
use super::surface_foam::{self, LooseEllipse, Off, Sprite, pixels, ray_off};
use super::thickness::kernel;
use super::{Image, View, is_surface, smoothstep};
use crate::support::rounded::{Rounded, exact, off};
use crate::support::tolerance::U;
use glam::{DVec2, DVec3};

/// Fixed-point units per weight and per spacing in the sums.
const UNITS: f64 = 2_097_152.0;
/// Max motion of a particle along each axis of the eye, in spacings.
const MOST: f64 = 1000.0;
/// Min half-axis of a sprite, in texels.
const LEAST_AXIS: f64 = 1.5;

/// A particle from the host, in world space.
#[derive(Clone, Copy, Debug)]
pub struct Particle {
    pub position: DVec3,
    pub velocity: DVec3,
    /// Density relative to the rest density; none or 0 means full density.
    pub density: Option<f64>,
    /// Fraction that is foam.
    pub foam: f64,
}

/// Settings of the motion vectors.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Rest spacing in world units.
    pub spacing: f64,
    /// Relative density below which a particle is spray, and from which on it is drawn whole.
    pub densities: [f64; 2],
    /// Speed at which foam is fully stretched, in spacings per second.
    pub motion_threshold: f64,
    /// Max difference between depths of one surface, in single precision as in the shaders.
    pub falloff: f32,
    /// Time since the previous frame, in seconds.
    pub dt: f64,
    /// Level of the thickness.
    pub level: u32,
}

/// The frame's images.
pub struct Shown<'a> {
    /// Depth of water before the scene.
    pub depth: &'a Image<f32>,
    pub foam: Option<&'a Image<f32>>,
    pub surface: Smoothed<'a>,
    /// Eye depth of the scene, infinite where there is none.
    pub scene: &'a Image<f64>,
}

/// A pixel's vector and the error of each component: infinite if rounding decides which surface the
/// pixel shows.
#[derive(Clone, Copy, Debug)]
pub struct Vector {
    pub v: DVec2,
    pub e: DVec2,
}

/// Sums of weighted displacements, of weights and of the displacements' absolute values, and the
/// errors of the first two.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    moved: DVec3,
    weight: f64,
    absolute: f64,
    moved_off: f64,
    weight_off: f64,
}

impl Sum {
    fn add(&mut self, other: &Self, by: f64) {
        self.moved += by * other.moved;
        self.weight += by * other.weight;
        self.absolute += by * other.absolute;
        self.moved_off += by * other.moved_off;
        self.weight_off += by * other.weight_off;
    }

    /// Whether any sprite contributes. None if rounding decides.
    fn is_some(&self) -> Option<bool> {
        match (self.weight > self.weight_off, self.weight + self.weight_off == 0.0) {
            (true, _) => Some(true),
            (_, true) => Some(false),
            _ => None,
        }
    }

    /// The mean and its error: conversions, bilinear weights and sums add 16u.
    fn mean(&self) -> (DVec3, f64) {
        let mean = self.moved / self.weight;
        let moved = self.moved_off + 16.0 * U * self.absolute;
        let weight = self.weight_off + 16.0 * U * self.weight;
        (mean, (moved + mean.length() * weight) / (self.weight - weight).max(0.0))
    }
}

/// The two surfaces of a texel and their sums.
type Texel = [(f32, Sum); 2];

fn sprites_of(
    particle: &Particle,
    view: &View,
    thick: &View,
    settings: &Settings,
) -> Vec<(f64, Vec<LooseEllipse>)> {
    let center = view.view.transform_point3(particle.position);
    let velocity = view.view.transform_vector3(particle.velocity);
    let foam = if particle.foam > 0.0 { particle.foam.min(1.0) } else { 0.0 };
    let density = particle.density.filter(|d| *d > 0.0);
    let [none, all] = settings.densities;
    if density.is_some_and(|d| d < none) || !velocity.is_finite() || !center.is_finite() {
        return Vec::new();
    }
    let body = density.map_or(1.0, |d| smoothstep(none, all, d));
    let radius = 0.656 * settings.spacing;
    let least = LEAST_AXIS * -center.z * thick.c_x().max(thick.c_y());
    let widened = |axis: Rounded| {
        let least = Rounded { v: least, e: (8.0 * U) * least + Off::point(center, view).e };
        if axis.v < least.v { least } else { axis }
    };
    let mut all = Vec::new();
    if foam < 1.0 {
        let axis = widened(off(2.0 * radius * (0.5 + 0.5 * body), 24.0));
        let unit = |v| Off { v, e: 0.0 };
        let ellipse = LooseEllipse {
            center: Off::point(center, view),
            e1: unit(DVec3::X),
            e2: unit(DVec3::Y),
            n: unit(DVec3::Z),
            a: axis,
            b: axis,
            turn: 0.0,
        };
        all.push((1.0 - foam, vec![ellipse]));
    }
    if foam * body > 0.0 {
        let sprite = Sprite { center, foam, velocity, age: 0.0, id: 0, sun: [1.0; 2] };
        let look = surface_foam::Settings {
            motion_threshold: settings.motion_threshold,
            ..surface_foam::Settings::new(settings.spacing)
        };
        let mut ellipses = LooseEllipse::all(&sprite, view, &look, 2.0);
        for ellipse in &mut ellipses {
            (ellipse.a, ellipse.b) = (widened(ellipse.a), widened(ellipse.b));
        }
        all.push((foam * body, ellipses));
    }
    all
}

/// Min and max of a decreasing function over an uncertain argument.
fn falling(of: impl Fn(f64) -> f64, at: Rounded) -> [f64; 2] {
    [of(at.v + at.e), of(at.v - at.e)]
}

fn texels(
    particles: &[Particle],
    view: &View,
    settings: &Settings,
    visible: &Image<f32>,
) -> Image<Texel> {
    let thick = view.reduced(settings.level);
    let edge = 1_usize << settings.level;
    let radius = 0.656 * settings.spacing;
    let mut texels = Image::from_fn(thick.width, thick.height, |x, y| {
        let (mut near, mut far) = (1e10_f32, 0.0_f32);
        for y in y * edge..((y + 1) * edge).min(view.height) {
            for x in x * edge..((x + 1) * edge).min(view.width) {
                let z = visible.at(x, y);
                near = near.min(z);
                far = if z < 1e9 { far.max(z) } else { far };
            }
        }
        let other = near < 1e9 && far - near > 3.0 * radius as f32;
        let two = [near, if other { far } else { 1e10 }];
        two.map(|front| (front, Sum::default()))
    });
    let (planes, near) = (frustum(view), view.near());
    for particle in particles {
        let center = Off::point(view.view.transform_point3(particle.position), view);
        let velocity = view.view.transform_vector3(particle.velocity);
        let limit = DVec3::splat(MOST * settings.spacing);
        let moved = (velocity * settings.dt).clamp(-limit, limit);
        // Transformed as a direction, multiplied by the time over the spacing, and back.
        let moved_off = Off::direction(moved).e + 12.0 * U * moved.length();
        let inside = |p: &glam::DVec4| p.dot(center.v.extend(1.0));
        let inside = planes.iter().map(inside).fold(f64::INFINITY, f64::min) + 4.0 * radius;
        let reached = inside.min(-center.v.z - near * (1.0 + 8.0 * U));
        let slack = 4.0 * center.e + 16.0 * U * (center.v.length() + 4.0 * radius);
        // A particle without a valid position has no valid distance.
        if reached.is_nan() || reached <= -slack {
            continue;
        }
        for (share, ellipses) in sprites_of(particle, view, &thick, settings) {
            let reach = ellipses.iter().map(LooseEllipse::reach).fold(0.0, f64::max);
            for (x, y) in pixels(&thick, center.v, reach) {
                let ray = ray_off(&thick, x, y);
                let hits: Vec<_> =
                    ellipses.iter().map(|e| e.meet(ray, near, f64::INFINITY)).collect();
                for (front, sum) in texels.at_mut(x, y) {
                    if *front >= 1e9 {
                        continue;
                    }
                    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
                    for hit in &hits {
                        let Some(hit) = hit else {
                            least = 0.0;
                            continue;
                        };
                        // The radius is rounded once more under the root.
                        let rho = Rounded { e: hit.rho_squared.e + U, ..hit.rho_squared };
                        let shape = falling(|r| kernel(r.clamp(0.0, 1.0)), rho);
                        let away = hit.k - exact(f64::from(*front));
                        let away = Rounded { v: away.v.abs(), e: away.e + 4.0 * U * radius };
                        let near = falling(|d| 1.0 - smoothstep(radius, 3.0 * radius, d), away);
                        let sure = hit.sure && reached > slack;
                        // The root 9u, the exponential 7 ulp, smoothstep 8u, then the products.
                        let low = share * shape[0] * (near[0] - 8.0 * U).max(0.0);
                        least = least.min(if sure { low * (1.0 - 48.0 * U) } else { 0.0 });
                        // Beyond its end, smoothstep is exactly 0.
                        let near = if near[1] > 0.0 { (near[1] + 8.0 * U).min(1.0) } else { 0.0 };
                        let high = share * shape[1] * near;
                        most = most.max(high * (1.0 + 48.0 * U));
                    }
                    // With densities the fraction errs by a smoothstep.
                    (least, most) = ((least * (1.0 - 24.0 * U)), most * (1.0 + 24.0 * U));
                    if most * UNITS < 0.25 {
                        continue;
                    }
                    let (weight, half) = (0.5 * (least + most), 0.5 * (most - least));
                    let length = moved.length();
                    // Both are rounded to units; less than half a unit becomes 0.
                    let unit = 0.5 / UNITS;
                    sum.moved += weight * moved;
                    sum.weight += weight;
                    sum.absolute += weight * length;
                    sum.moved_off += half * length
                        + most * (moved_off + 2.0 * U * length)
                        + unit * (length + 3.0_f64.sqrt() * settings.spacing);
                    sum.weight_off += half + unit + 2.0 * U * most;
                }
            }
        }
    }
    texels
}

/// The sum of the texel's surface that is nearer to this depth and has contributions, and its
/// distance in depth. None if rounding decides.
fn nearer(texel: &Texel, z: f32) -> Option<(f32, Sum)> {
    let mut best = (2e10_f32, Sum::default());
    for (front, sum) in texel {
        let away = (front - z).abs();
        if *front < 1e9 && away < best.0 && sum.is_some()? {
            best = (away, *sum);
        }
    }
    Some(best)
}

/// Displacement of the surface in a pixel, in eye space, and its error.
fn moved_at(
    texels: &Image<Texel>,
    settings: &Settings,
    (x, y): (usize, usize),
    z: f32,
) -> Option<(DVec3, f64)> {
    let edge = f64::from(1_u32 << settings.level);
    let h = (DVec2::new(x as f64, y as f64) + 0.5) / edge - 0.5;
    let (base, f) = (h.floor(), h - h.floor());
    let (base_x, base_y) = (base.x as isize, base.y as isize);
    let mut sum = Sum::default();
    let mut any = false;
    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let weight =
            (if dx == 0 { 1.0 - f.x } else { f.x }) * (if dy == 0 { 1.0 - f.y } else { f.y });
        let texel = texels.checked(base_x + dx, base_y + dy);
        if let Some(texel) = texel.filter(|_| weight > 0.0) {
            let (away, there) = nearer(&texel, z)?;
            if away <= settings.falloff {
                sum.add(&there, weight);
                any = true;
            }
        }
    }
    if !any {
        let mut least = 2e10_f32;
        for i in 0..16 {
            let texel = texels.clamped(base_x + i % 4 - 1, base_y + i / 4 - 1);
            let (away, there) = nearer(&texel, z)?;
            if away < least {
                (least, sum, any) = (away, there, true);
            }
        }
    }
    Some(if any { sum.mean() } else { (DVec3::ZERO, 0.0) })
}

/// Depth of the smoothed surface in a pixel, from the smoothed image and its texels' width in
/// pixels.
pub fn smoothed_at(
    (surface, edge): (&Image<f32>, usize),
    (x, y): (usize, usize),
    front: f32,
    falloff: f32,
) -> f64 {
    let at = (DVec2::new(x as f64, y as f64) + 0.5) / edge as f64;
    let (mut sum, mut all) = (0.0, 0.0);
    for (x, y, weight) in surface.bilinear(at) {
        let off = surface.clamped(x, y) - front;
        if off.abs() <= falloff {
            sum += weight * f64::from(off);
            all += weight;
        }
    }
    f64::from(front) + if all > 0.0 { sum / all } else { 0.0 }
}

/// Vector of a pixel that shows something at depth `z` (infinite: a direction), which was displaced
/// by `moved` in eye space; both with their errors.
pub fn vector(
    view: &View,
    then: &View,
    (x, y): (usize, usize),
    z: Rounded,
    moved: (DVec3, f64),
) -> Vector {
    let (ray, slope_off) = (view.ray(x, y), ray_off(view, x, y).e);
    let slope = ray.truncate();
    let sky = z.v.is_infinite();
    let (depth, depth_off) = if sky { (1.0, 0.0) } else { (z.v, z.e) };
    let here = ray * depth;
    let (moved, moved_off) = moved;
    let turn = then.view * view.view.inverse();
    let (there, shift) = match sky {
        true => (turn.transform_vector3(here), 0.0),
        false => (turn.transform_point3(here - moved), turn.w_axis.truncate().length()),
    };
    let change = there - here;
    let least = if sky { 1.0e-3 } else { then.near() };
    let before = (depth - change.z).max(least);
    let slope_change = (change.truncate() + slope * change.z) / before;
    let now = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let v = now - then.pixel_of_slope(slope + slope_change);

    // Norm of the rotation minus the identity.
    let rotation = glam::DMat3::from_mat4(turn) - glam::DMat3::IDENTITY;
    let norm = rotation.to_cols_array().iter().map(|c| c * c).sum::<f64>().sqrt();
    let here_off = depth * slope_off + depth_off * ray.length() + 2.0 * U * here.length();
    // The matrix's own rounding, three products and sums, and two more for the translation and
    // `moved`.
    let sums = 8.0 * U * (norm * (here.length() + moved.length()) + shift + moved.length());
    let change_off = moved_off * (1.0 + norm) + norm * here_off + sums;
    let before_off = depth_off + change_off + 8.0 * U * (least + depth);
    let size = slope.length();
    let above = (1.0 + size) * change_off
        + slope_off * change.z.abs()
        + 3.0 * U * change.length() * (1.0 + size);
    let below = (before - before_off).max(0.0);
    let quotient = above / below + slope_change.length() * (before_off / below + 5.0 * U);
    let lens = (view.focal() - then.focal()).abs();
    let shifted = (view.shift() - then.shift()).abs();
    let terms = slope.abs() * lens + shifted + slope_change.abs() * then.focal().abs();
    let e = then.focal().abs() * quotient + lens * slope_off + 6.0 * U * terms;
    Vector { v, e: 0.5 * view.extent() * e }
}

/// The vectors of a frame.
pub fn motion(
    particles: &[Particle],
    view: &View,
    then: &View,
    settings: &Settings,
    shown: &Shown<'_>,
) -> Image<Vector> {
    let foam_at = |x, y| shown.foam.map_or(1e10, |foam| foam.at(x, y));
    let visible =
        Image::from_fn(view.width, view.height, |x, y| shown.depth.at(x, y).min(foam_at(x, y)));
    let texels = texels(particles, view, settings, &visible);
    let far = view.far().map_or(f64::INFINITY, |far| far * (1.0 - 1e-6));
    Image::from_fn(view.width, view.height, |x, y| {
        let front = visible.at(x, y);
        if !is_surface(f64::from(front)) {
            let scene = shown.scene.at(x, y);
            let scene = if scene >= far { f64::INFINITY } else { scene };
            return vector(view, then, (x, y), off(scene, 6.0), (DVec3::ZERO, 0.0));
        }
        let Some(moved) = moved_at(&texels, settings, (x, y), front) else {
            return Vector { v: DVec2::ZERO, e: DVec2::INFINITY };
        };
        let water = shown.depth.at(x, y);
        let z = match foam_at(x, y) < water {
            true => f64::from(front),
            false => shown.surface.at((x, y), water, settings.falloff),
        };
        vector(view, then, (x, y), off(z, 4.0), moved)
    })
}
