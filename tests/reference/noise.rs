//! Twin of the baseline's surface noise, and its effect on the surface.
//!
//! With c a particle's centre at the depth D, r the drawn radius, a the half-axis, s = (s_x, s_y) a
//! texel's slope, and d the water's depth in the pixel that contains the texel's centre:
//! ```text
//! o = D s - c.xy    q = |o|^2 / a^2    b = max(D - r - d, 0)
//! N = sum of (1 - q)^2 exp(-2 q) exp(-k b / r) noise(R^T (o, 0) cells / r + origin(id)),  q < 1
//! ```
//! with R the view's rotation; 0 where there is no water. Contributions are fixed-point steps, so
//! the sum is exact. [`noise`] gives it with bounds for single precision: u is half an ulp, and an
//! operation errs as much as Vulkan permits. There is no rim, because at q = 1 a contribution is 0.
//!
//! The surface P(x, y) with N h on it has the tangents `P_x + h N_x n` and `P_y + h N_y n`;
//! derivatives of the normal n are neglected.

use super::surface_foam::{self, Off, origin};
use super::{Image, View, is_surface};
use crate::support::rounded::{Rounded, exact, off};
use crate::support::tolerance::{Between, U};
use glam::{DVec2, DVec3};

/// Drawn radius in spacings.
const RADIUS: f64 = 0.656;
/// A contribution is a multiple of this.
pub const STEP: f64 = 1.0 / 65_536.0;
/// Numbers of this size or larger are invalid as positions.
const NOWHERE: f64 = 1e18;

/// A particle in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    pub position: DVec3,
    /// Density relative to the rest density; 0 means unknown.
    pub density: f64,
    pub id: u32,
}

/// Settings of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Rest spacing of the particles in world units.
    pub spacing: f64,
    /// Relative density below which a particle is spray.
    pub threshold: f64,
    /// k, the falloff with depth per radius.
    pub falloff: f64,
    /// Half-axis of a sprite in radii.
    pub size: f64,
    /// Noise cells per radius.
    pub cells: f64,
}

/// The noise of an image.
pub struct Noise {
    /// Exact value of the definition, without fixed-point steps.
    pub image: Image<f64>,
    pub bounds: Between,
    /// Number of particles that may contribute to a texel.
    pub count: Image<u32>,
}

/// The pixel that contains a texel's centre.
fn pixel(texel: usize, edge: f64, pixels: usize) -> usize {
    (((texel as f64 + 0.5) * edge) as usize).min(pixels - 1)
}

/// Contribution of a particle at a ray, with its error; None outside its kernel.
fn addend(
    settings: &Settings,
    centre: Off,
    id: u32,
    ray: Off,
    surface: f64,
    view: &View,
) -> Option<Rounded> {
    let radius = off(RADIUS * settings.spacing, 2.0);
    let axis = off(settings.size, 1.0) * radius;
    let depth = Rounded { v: -centre.v.z, e: centre.e };
    let along =
        |slope: f64, c: f64| Rounded { v: slope, e: ray.e } * depth - Rounded { v: c, e: centre.e };
    let o = [along(ray.v.x, centre.v.x), along(ray.v.y, centre.v.y)];
    let place = o.map(|c| c / axis);
    let q = place[0] * place[0] + place[1] * place[1];
    if q.v - q.e >= 1.0 {
        return None;
    }
    let left = (exact(1.0) - q).clamp(0.0, 1.0);
    let kernel = left * left * (-(exact(2.0) * q)).exp();
    let below = (depth - radius - exact(surface)).clamp(0.0, f64::MAX);
    let fade = (-(below * (off(settings.falloff, 1.0) / radius))).exp();

    let scale = off(settings.cells, 1.0) / radius;
    let turned = view.view.inverse().transform_vector3(DVec3::new(o[0].v, o[1].v, 0.0));
    let at = turned * scale.v + origin(id);
    // The inverse of the view errs by 16u of its entries, which are at most 1; then a product and
    // two sums, a product, and the sum with the origin. The components of an error of some length
    // sum to at most the root of 3 times it.
    let (length, e) = (o[0].v.hypot(o[1].v), o[0].e.hypot(o[1].e));
    let from = (e + 19.0 * U * length) * scale.v + length * (scale.e + U * scale.v);
    let moved = 3.0_f64.sqrt() * from + U * at.abs().element_sum();
    let e = surface_foam::noise_slope() * moved + surface_foam::noise_rounding();
    Some(kernel * fade * Rounded { v: surface_foam::noise(at), e })
}

/// The noise on water whose surface has this `depth` at the view's resolution, in an image whose
/// texels are blocks of `2^level` pixels.
pub fn noise(
    particles: &[Particle],
    view: &View,
    settings: &Settings,
    depth: &Image<f64>,
    level: u32,
) -> Noise {
    let (edge, small) = (f64::from(1 << level), view.reduced(level));
    let mut image = Image::new(small.width, small.height, 0.0);
    let (mut low, mut high, mut count) = (image.clone(), image.clone(), image.map(|_| 0));
    let near = view.near();
    for particle in particles {
        let there = particle.position.is_finite()
            && particle.position.abs().max_element() < NOWHERE
            && !(particle.density > 0.0 && particle.density < settings.threshold);
        let centre = Off::point(view.view.transform_point3(particle.position), view);
        let drawn = -centre.v.z > near;
        let unsure = (-centre.v.z - near).abs() <= centre.e + 8.0 * U * near;
        if !there || !(drawn || unsure) {
            continue;
        }
        for (x, y) in (0..small.height).flat_map(|y| (0..small.width).map(move |x| (x, y))) {
            let surface = depth.at(pixel(x, edge, view.width), pixel(y, edge, view.height));
            if !is_surface(surface) {
                continue;
            }
            // The slope is a sum of products as for a pixel, so it has the same error.
            let terms = surface_foam::ray_off(view, 0, 0).e;
            let v = view.ray_at(DVec2::new(x as f64 + 0.5, y as f64 + 0.5) * edge);
            let ray = Off { v, e: terms };
            let found = addend(settings, centre, particle.id, ray, surface, view);
            let Some(found) = found else { continue };
            *image.at_mut(x, y) += if drawn { found.v } else { 0.0 };
            // The product with the number of steps is exact, the sum with a half is rounded.
            let steps = |v: f64, sign: f64| {
                let parts = v / STEP + 0.5;
                (parts + sign * U * parts.abs()).floor() * STEP
            };
            let (least, most) = (steps(found.v - found.e, -1.0), steps(found.v + found.e, 1.0));
            *low.at_mut(x, y) += if unsure { least.min(0.0) } else { least };
            *high.at_mut(x, y) += if unsure { most.max(0.0) } else { most };
            *count.at_mut(x, y) += 1;
        }
    }
    Noise { image, bounds: Between { low, high }, count }
}

/// Appearance of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// A texel of the image is a block of `2^level` pixels.
    pub level: u32,
    /// Height in world units of a noise of 1.
    pub height: f64,
    /// Fraction of the height that is missing where the scene is under this water.
    pub airborne: f64,
    /// Fraction of the foam's colour that a noise of 1 adds, at most all of it.
    pub foam: f64,
    /// Radiance of the foam's colour.
    pub color: [f64; 3],
}

/// Noise on the surface of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Ripples<'a> {
    pub image: &'a Image<f64>,
    pub look: Look,
}

/// Noise at a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ripple {
    /// Change of the height in world units per pixel, along x and y; then the same mean of absolute
    /// values.
    pub height: DVec2,
    pub rises: DVec2,
    /// Radiance of the added foam.
    pub foam: DVec3,
}

impl Ripples<'_> {
    /// The noise at a pixel of a surface with this depth, from those of the four texels around it
    /// that lie on the surface. A texel has the mean of its differences to neighbours on its own
    /// surface.
    pub fn at(
        &self,
        depth: &Image<f64>,
        (x, y): (usize, usize),
        front: f64,
        threshold: f64,
        margin: &mut f64,
    ) -> Ripple {
        let Look { level, height, foam, color, .. } = self.look;
        let edge = f64::from(1 << level);
        let texel = |i: isize, j: isize| {
            let n = self.image.checked(i, j)?;
            let (i, j) = (i as usize, j as usize);
            Some((n, depth.at(pixel(i, edge, depth.width), pixel(j, edge, depth.height))))
        };
        let mut same = |a: f64, b: f64| {
            *margin = margin.min(((a - b).abs() - threshold).abs());
            (a - b).abs() <= threshold
        };
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / edge - 0.5;
        let (base, f) = (at.floor(), at - at.floor());
        let (mut weight, mut n, mut rise, mut rises) = (0.0, 0.0, DVec2::ZERO, DVec2::ZERO);
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (i, j) = (base.x as isize + dx, base.y as isize + dy);
            let part = [1.0 - f.x, f.x][dx as usize] * [1.0 - f.y, f.y][dy as usize];
            let Some((here, z)) = texel(i, j).filter(|t| part > 0.0 && same(t.1, front)) else {
                continue;
            };
            let mut sides = |before: Option<(f64, f64)>, after: Option<(f64, f64)>| {
                let before = before.filter(|t| same(t.1, z)).map(|t| here - t.0);
                let after = after.filter(|t| same(t.1, z)).map(|t| t.0 - here);
                let all: Vec<f64> = before.into_iter().chain(after).collect();
                let mean = |of: fn(f64) -> f64| {
                    all.iter().map(|r| of(*r)).sum::<f64>() / all.len().max(1) as f64
                };
                (mean(|r| r), mean(f64::abs))
            };
            let along_x = sides(texel(i - 1, j), texel(i + 1, j));
            let along_y = sides(texel(i, j - 1), texel(i, j + 1));
            weight += part;
            n += part * here;
            rise += part * DVec2::new(along_x.0, along_y.0);
            rises += part * DVec2::new(along_x.1, along_y.1);
        }
        if weight == 0.0 {
            return Ripple::default();
        }
        let scale = height / (weight * edge);
        let foam = DVec3::from(color) * (foam * (n / weight).abs()).min(1.0);
        Ripple { height: rise * scale, rises: rises * scale, foam }
    }
}

impl Ripple {
    /// The normal of a surface with this part of the noise, from the tangents per pixel.
    pub fn turn(&self, part: f64, normal: DVec3, [x, y]: [DVec3; 2]) -> DVec3 {
        let height = part * self.height;
        let turned = (x + height.x * normal).cross(y + height.y * normal);
        turned.normalize() * turned.dot(normal).signum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A height that rises by s along a plane tilts the normal by atan s, for any orientation of
    /// the plane.
    #[test]
    fn a_slope_on_a_plane_turns_its_normal() {
        for turn in [0.0, 0.4, 1.2] {
            let turn =
                glam::DMat3::from_rotation_y(turn) * glam::DMat3::from_rotation_x(0.7 * turn);
            let (tangent, other, n) = (turn * DVec3::X, turn * DVec3::Y, turn * DVec3::Z);
            let (step, slope) = (0.03, 0.5);
            let height = DVec2::new(slope * step, 0.0);
            let ripple = Ripple { height, ..Ripple::default() };
            let found = ripple.turn(1.0, n, [tangent * step, other * 0.01]);
            let expected = (n - slope * tangent).normalize();
            assert!((found - expected).length() < 1e-12, "{found} {expected}");
            let back = ripple.turn(1.0, n, [tangent * step, other * -0.01]);
            assert!((back - expected).length() < 1e-12, "{back} of a mirrored image");
        }
    }

    /// For a particle one radius deeper under the surface, the noise is 1 / e^2 of that at the
    /// surface, in every texel.
    #[test]
    fn noise_falls_with_the_depth() {
        let view = super::super::tests::view(DVec2::new(1.0, -1.0), DVec2::ZERO, 40, 40);
        let settings =
            Settings { spacing: 0.5, threshold: 0.35, falloff: 2.0, size: 2.0, cells: 1.5 };
        let particle = Particle { position: DVec3::new(0.0, 0.0, -5.0), density: 1.0, id: 3 };
        let radius = RADIUS * 0.5;
        let at = |below: f64| {
            let depth = Image::new(40, 40, 5.0 - radius - below);
            noise(&[particle], &view, &settings, &depth, 0).image
        };
        let (whole, before, deeper) = (at(0.0), at(-0.3), at(radius));
        let lit = whole.data.iter().filter(|n| **n != 0.0).count();
        assert!(lit > 15 && whole == before, "{lit} texels");
        for (a, b) in whole.data.iter().zip(&deeper.data) {
            assert!((b - a * (-2.0_f64).exp()).abs() < 1e-12);
        }
    }
}
