//! Twin of pass `spray`: a particle too thin to be water is drawn as droplets around its centre.
//! Each droplet is an ellipse across the view through its own centre, elongated along its motion.
//! With neighbours, the droplets fill the ellipsoid of the particle's spray. The first of several
//! droplets is mist: the projection of this ellipsoid with its motion streak.
//!
//! With p a droplet's centre, N its direction from the eye and `w = (s_x, s_y, -1)` the pixel's
//! ray, t w with `t = N.p / N.w` is the visible point of the droplet's plane, and q is its distance
//! from the centre in half-axes. [`spray`] sums `before A sqrt(1 - q^2) exp(-2 q^2)`, an optical
//! depth, and gives bounds for single precision and for the sum of a [`Sums`] in any order.
//! [`over`] blends spray over a colour.
//!
//! The conventions are those of the foam's twin, which has the same planes and rays: a number is
//! [`Rounded`], a vector [`Off`], and roundings of errors are neglected.

mod clumps;
mod relief;
#[cfg(test)]
mod single;
#[cfg(test)]
mod tests;

use clumps::{Clumps, OCTAVES};
pub use relief::{Relief, over};

use super::classify;
use super::shape::norm;
use super::surface_foam::{LooseEllipse, Off, Pattern, pixels, ray_off, scene_depth};
use super::thickness::kernel;
use super::{Image, View, smoothstep};
use crate::support::rounded::{self, Rounded, exact, off};
use crate::support::tolerance::{Between, U};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{PI, SQRT_2, TAU};

/// Drawn radius of a particle of full density, in spacings.
const RADIUS: f64 = 0.656;
/// Seed of the random numbers.
const SEED: u32 = 0x5370;
/// Numbers of this size or larger are invalid as positions and velocities.
const NOWHERE: f64 = 1e18;
/// Min width of the density ramp, relative to its lower end and in units of density.
const STEEPEST: f64 = 1e-6;
/// Below this speed, in spacings per second, there is no direction of motion.
const STILL: f64 = 1e-6;
/// There is none either if at most this fraction of the motion is across the view.
const HEAD_ON: f64 = 1e-3;
/// Min half-axis in pixels.
const LEAST: f64 = 0.7;
/// The depth of water is also looked up at this distance beside a droplet, in drawn radii.
const ASIDE: f64 = 1.5;
/// Spray behind water fades over this many spacings.
const FADE: f64 = 1.5;
/// Error of sine and cosine. Vulkan guarantees it only between -pi and pi.
const TRIGONOMETRY: f64 = 1.0 / 2048.0;
/// Mean square of the sizes of many droplets, times the mean fraction that is drawn.
const SQUARES: f64 = 0.513 * 0.6;
/// Half-axis of the smallest of many droplets, and how much larger the largest is.
pub const SIZES: [f64; 2] = [0.36, 1.661];
/// Fraction of the droplets and the mist of a particle that is only spray.
const LEAST_TORN: f64 = 0.3;
/// First of a particle's random numbers for its spindle.
const SPINDLE: u32 = 4096;
/// Of this many droplets one glints; first of a particle's random numbers for that.
const GLINT_ONE_OF: f64 = 32.0;
const GLINT: u32 = 8192;
/// Radius of a glint relative to the droplet's, where that is at least 1.4 pixels wide.
const GLINT_RADIUS: f64 = 0.35;
/// First of a particle's random numbers by which droplets are left out where spray is thin.
const KEPT: u32 = 12288;
/// Range of densities over which such a droplet fades.
const FADE_DROPLET: f64 = 0.2;
/// Sum of the squared half-axes at which droplets begin to leave the spindle for the ellipsoid, and
/// at which they fill it.
const FLAT: [f64; 2] = [3.0, 3.6];
/// Max distance of droplets from the centre, relative to that in a ball, if the ellipsoid is a
/// line.
const STRAND: f64 = 0.7;
/// If the eigenvalues of projected mist differ by less than this fraction of their sum, it has no
/// direction.
const ROUND: f64 = 1e-3;
/// Relative error of an arc tangent.
const ARC: f64 = 4096.0 * 2.0 * U;
/// Min sine of the angle between a droplet's ray and the axis from which the level axis is made.
const LEAST_SINE: f64 = 0.43;

/// How the contributions of droplets are summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sums {
    /// A contribution is rounded to a neighbouring multiple of this; 0: not rounded.
    pub step: f64,
    /// Half an ulp: relative, and absolute for denormals.
    half: (f64, f64),
}

impl Sums {
    /// 32-bit floats.
    pub const SINGLE: Self = Self { step: 1.0 / 262_144.0, half: (U, 0.0) };
    /// 16-bit floats.
    pub const HALF: Self = Self { step: 1.0 / 512.0, half: (1.0 / 2048.0, 1.0 / (1 << 25) as f64) };

    /// Sums of multiples of the step are exact up to this value.
    fn exact(&self) -> f64 {
        self.step / self.half.0
    }

    /// A contribution rounded to a step: down for a negative sign, up for a positive one.
    fn in_steps(&self, addend: f64, sign: f64) -> f64 {
        if self.step == 0.0 {
            return addend;
        }
        let steps = addend / self.step;
        let whole = if sign > 0.0 { steps.ceil() } else { steps.floor() };
        whole * self.step
    }

    /// Bounds of a sum of `count` contributions, in any order. Each addition rounds at most the
    /// whole sum, to the nearest or, as Vulkan permits, towards zero.
    fn summed(&self, sum: f64, count: u32) -> [f64; 2] {
        if self.step > 0.0 && sum <= self.exact() {
            return [sum; 2];
        }
        let (n, (by, least)) = (f64::from(count), self.half);
        let low = sum * (1.0 - 2.0 * by).powf(n) - 2.0 * n * least;
        [low.max(0.0), sum * (1.0 + by).powf(n) + n * least]
    }

    /// Bounds for a value that is itself such a sum, made in another order.
    pub fn again(&self, sum: f64, count: u32) -> [f64; 2] {
        if sum < self.exact() {
            return [sum; 2];
        }
        let (n, (by, least)) = (f64::from(count), self.half);
        let ratio = ((1.0 + by) / (1.0 - 2.0 * by)).powf(n);
        // Three of the smallest numbers, or two times the ratio and one.
        [sum / ratio - 4.0 * n * least, sum * ratio + 4.0 * n * least]
    }
}

/// A particle in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Position of its centre.
    pub position: DVec3,
    /// Velocity in world units per second.
    pub velocity: DVec3,
    /// Density in the unit of [`Settings::rest_density`].
    pub density: f64,
    /// Id, which selects the droplets' random numbers.
    pub id: u32,
    /// Matrix from a ball to the ellipsoid of its spray, as 16 bits store it.
    pub shape: DMat3,
    /// Sum of the neighbours' weights.
    pub crowd: f64,
}

/// Sums of the neighbours' weights between which mist appears, and the sum for particles whose
/// neighbours are unknown.
const CROWD: (f64, f64) = (1.0, 6.0);
pub const CROWDED: f64 = 64.0;

/// The shape of a ball in 16 bits, which store signed fractions of 4.
pub const BALL: DMat3 = DMat3::from_diagonal(DVec3::splat(8192.0 * 4.0 / 32767.0));

/// Settings of the spray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Rest spacing of the particles in world units.
    pub spacing: f64,
    /// Rest density of water.
    pub rest_density: f64,
    /// Opacity at the middle of a droplet at rest, [0, 1).
    pub opacity: f64,
    /// Half-axis of a disc with the area of all droplets, in drawn radii.
    pub size: f64,
    /// Max half-axis of one of several droplets, relative to its depth.
    pub max_angle: f64,
    /// n, the number of droplets per particle.
    pub droplets: u32,
    /// Max distance of droplets from the particle's centre, in spacings.
    pub spread: f64,
    /// Max distance of droplets along the motion, before and behind the particle, in seconds of
    /// motion.
    pub stretch: f64,
    /// Mist: the opacity at its middle, and its half-axis in spacings.
    pub mist: [f64; 2],
    /// Amplitude of the coarsest octave of the logarithm of the density.
    pub clumps: f64,
    /// The pattern of the foam, whose phases the clumps have.
    pub pattern: Pattern,
    /// Fractions of the rest density: up to the first, the particle is only spray; from the second
    /// on, it has none.
    pub densities: [f64; 2],
    /// Exposure time in seconds, over which a droplet is streaked.
    pub shutter: f64,
    /// Fraction of the sunlight that is scattered, of which the fourth root is taken.
    pub scattering: f64,
    /// Sunlight that a glint adds, relative to that on a white droplet.
    pub glints: f64,
    /// How the contributions are summed.
    pub sums: Sums,
}

/// Whether a number is larger than another: by their values, for certain, possibly.
#[derive(Clone, Copy, Debug)]
struct More {
    is: bool,
    surely: bool,
    maybe: bool,
}

fn more(a: Rounded, b: Rounded) -> More {
    let (d, e) = (a.v - b.v, a.e + b.e);
    More { is: d > 0.0, surely: d > e, maybe: d > -e }
}

impl More {
    fn and(self, other: Self) -> Self {
        let (is, surely) = (self.is && other.is, self.surely && other.surely);
        Self { is, surely, maybe: self.maybe && other.maybe }
    }
}

fn at_least(a: Rounded, b: Rounded) -> Rounded {
    Rounded { v: a.v.max(b.v), e: a.e.max(b.e) }
}

fn at_most(a: Rounded, b: Rounded) -> Rounded {
    Rounded { v: a.v.min(b.v), e: if a.v + a.e < b.v - b.e { a.e } else { a.e.max(b.e) } }
}

fn depth_of(p: Off) -> Rounded {
    Rounded { v: -p.v.z, e: p.e }
}

impl Particle {
    /// Fraction of the particle that is spray; `None` if the particle has no spray. The ramp may be
    /// narrower than the rounding of its ends: then the bounds allow any fraction near them.
    fn share(&self, settings: &Settings) -> Option<Rounded> {
        let is = |v: DVec3| v.is_finite() && v.abs().max_element() < NOWHERE;
        if !(self.density > 0.0 && is(self.position) && is(self.velocity)) {
            return None;
        }
        let density = self.density.min(1e30);
        let [all, none] = settings.densities.map(|d| off(d * settings.rest_density, 1.0));
        let end = at_least(none, all * off(1.0 + STEEPEST, 1.0) + off(STEEPEST, 1.0));
        let (above, width) = (exact(density) - all, end - all);
        let part = |above: f64, width: f64, sign: f64| match (above > 0.0, width > 0.0) {
            (false, _) => 0.0,
            (true, false) => 1.0,
            _ => (above / width * (1.0 + sign * 5.0 * U)).min(1.0),
        };
        let least = part(above.v - above.e, width.v + width.e, -1.0);
        let most = part(above.v + above.e, width.v - width.e, 1.0);
        let share = |part: f64| 1.0 - smoothstep(0.0, 1.0, part);
        let v = 1.0 - smoothstep(all.v, end.v, density);
        let own = if least < 1.0 { 6.0 * U } else { 0.0 };
        let e = (share(least) - v).max(v - share(most)) + own;
        (v + e > 0.0).then_some(Rounded { v, e })
    }
}

impl Settings {
    /// Half-axis of droplet k by its random number, and optical depth at its middle at rest.
    fn half_axis(&self, k: u32, u: f64) -> (Rounded, Rounded) {
        let many = self.droplets > 1;
        if many && k == 0 {
            let [taken, axis] = self.mist;
            return (off(axis * self.spacing, 1.0), optical_depth(taken));
        }
        let squares = if many { SQUARES * f64::from(self.droplets) } else { 1.0 };
        // Radius 2u, products 3u, root 9u, quotient 5u; the size has three products and a sum.
        let whole = off(self.size * RADIUS * self.spacing / squares.sqrt(), 19.0);
        let size = if many { off(SIZES[0] + SIZES[1] * u.powi(6), 9.0) } else { exact(1.0) };
        (size * whole, optical_depth(self.opacity))
    }
}

/// Optical depth with this opacity. A logarithm errs by 2^-21 from 1/2 upwards, below that by 3
/// ulp.
fn optical_depth(taken: f64) -> Rounded {
    let left = off(1.0 - taken, 1.0);
    let v = -left.v.ln();
    let own = if left.v >= 0.5 { 8.0 } else { 6.0 * v };
    Rounded { v, e: left.e / left.v + own * U }
}

/// A droplet that may be drawn.
#[derive(Clone, Copy, Debug)]
struct Droplet {
    ellipse: LooseEllipse,
    /// Optical depth at its middle.
    amount: Rounded,
    /// Distance in pixels at which water is also looked up; two values if rounding decides.
    aside: [isize; 2],
    /// Squared ratio of its radius to that of its glint, if it mirrors the sun.
    glint: Option<Rounded>,
    /// Clumps of mist, with the particle's centre and velocity in world space.
    clumps: Option<(Clumps, (Off, Off))>,
    /// Whether the droplet is drawn.
    drawn: More,
}

/// All droplets of a particle.
fn droplets(particle: &Particle, view: &View, settings: &Settings) -> Vec<Droplet> {
    let Some(share) = particle.share(settings) else { return Vec::new() };
    let c = Off::point(view.view.transform_point3(particle.position), view);
    let (near, from) = (off(view.near(), 8.0), off(settings.spread * settings.spacing, 2.0));
    let drawn = more(depth_of(c), at_least(near, from));
    // 1 - share errs as much as the share.
    let torn = at_least(exact(4.0) * (exact(1.0) - share), off(LEAST_TORN, 1.0));
    let torn = if settings.droplets > 1 { torn.clamp(0.0, 1.0) } else { exact(1.0) };
    // The shader transforms centres and velocities back from eye space.
    let v = Off::direction(view.view.transform_vector3(particle.velocity));
    let moving = (c.to_world(view), Off { v: particle.velocity, e: 2.0 * v.e });
    let phases = settings.pattern.phases();
    let clumps = |kind: usize| Clumps {
        strength: settings.clumps,
        stretch: settings.stretch,
        spacing: settings.spacing,
        phases,
        octaves: OCTAVES[kind],
    };
    let all = (0..settings.droplets).map(|k| {
        let random = |n| f64::from(classify::random(SEED, n, particle.id));
        let u = |j| random(5 * k + j);
        let many = settings.droplets > 1;
        let own = |j| random(SPINDLE + j);
        let spindle =
            many.then(|| (direction(own(0), own(1)), off((1.0 + 5.0 * own(2)) / 6.0, 3.0)));
        let apart = off((2.0 * u(4) - 1.0) * settings.stretch, 3.0);
        let at = Off {
            v: c.v + apart.v * v.v,
            e: c.e + apart.v.abs() * v.e + (apart.e + apart.v.abs() * U) * v.v.length(),
        };
        let p = placed(at, spindle, (&particle.shape, [u(0), u(1), u(2)]), view, settings);
        let depth = depth_of(p);
        let (mut h, thick) = settings.half_axis(k, u(3));
        if many && k > 0 {
            h = at_most(h * (exact(1.0) / torn.sqrt()), off(settings.max_angle, 1.0) * depth);
        }
        let mist = (many && k == 0).then_some(&particle.shape);
        let (mut one, pixel) = droplet(p, v, (h, thick, mist), view, settings);
        let twice = exact(2.0) * (one.ellipse.a + pixel);
        let kept = if many {
            exact(0.5) + torn * off((0.2 + 0.8 * own(3)) * f64::from(settings.droplets), 3.0)
        } else {
            exact(1.0)
        };
        one.drawn = drawn
            .and(more(kept, exact(f64::from(k))))
            .and(more(depth, twice))
            .and(more(depth, near));
        let glints = many && k > 0 && GLINT_ONE_OF * random(GLINT + k) < 1.0;
        one.glint = glints.then(|| {
            let radius = at_least(off(LEAST, 1.0) * pixel / one.ellipse.b, off(GLINT_RADIUS, 1.0));
            exact(1.0) / (radius * radius)
        });
        if many && k == 0 {
            let crowd = smoothstep(CROWD.0, CROWD.1, particle.crowd);
            one.amount = share * torn * torn * torn * Rounded { v: crowd, e: 8.0 * U } * one.amount;
            one.clumps = (settings.clumps > 0.0).then_some((clumps(0), moving));
        } else if many && settings.clumps > 0.0 {
            let point = one.ellipse.center.to_world(view);
            let density = clumps(1).at(point, moving, pixel);
            let own = exact(random(KEPT + k));
            let shown = ((density - own) / off(FADE_DROPLET, 1.0) + exact(0.5)).clamp(0.0, 1.0);
            one.amount = share * one.amount * at_least(density, exact(1.0)) * shown;
        } else {
            one.amount = share * one.amount;
        }
        one
    });
    all.filter(|one| one.drawn.maybe).collect()
}

/// A direction from two random numbers. Its components err by the root, by sine, cosine and their
/// argument, and by a product.
fn direction(first: f64, second: f64) -> Off {
    let level = exact(2.0 * first - 1.0);
    let ring = (exact(1.0) - level * level).clamp(0.0, 1.0).sqrt();
    let turn = TAU * second;
    let v = DVec3::new(ring.v * turn.cos(), ring.v * turn.sin(), level.v);
    Off { v, e: ring.e + ring.v * (SQRT_2 * (TRIGONOMETRY + U) + 2.0 * U * turn) }
}

/// Centre of a droplet from three random numbers: in a ball, or in a spindle with an axis and a
/// width, or in the ellipsoid if that is far from round. The world-space offset errs by two
/// products; a scalar product has three products and two sums; its product with the axis, their sum
/// and the width add five.
fn placed(
    c: Off,
    spindle: Option<(Off, Rounded)>,
    (shape, u): (&DMat3, [f64; 3]),
    view: &View,
    settings: &Settings,
) -> Off {
    let way = direction(u[0], u[1]);
    let third = off(1.0 / 3.0, 1.0);
    let away = off(settings.spread * settings.spacing, 1.0) * exact(u[2]).pow(third);
    let (mut off, mut from) = (away.v * way.v, away.e + away.v * (way.e + 2.0 * U));
    if let Some((axis, wide)) = spindle {
        let length = off.length();
        let thin = wide.v * (0.4 * off + 0.6 * off.dot(axis.v) * axis.v);
        let thin_e = wide.v * (from + 1.2 * length * axis.e + 10.0 * U * length) + wide.e * length;
        let squares = squares(shape);
        let part = STRAND / squares.v.sqrt();
        let flat = part * (*shape * off);
        // A matrix entry errs by 5u and a row's product by 3u, as a vector times the root of 3; the
        // factor errs by half of the relative error of `squares`, a root of 4u and two products;
        // the last product adds one.
        let rows = norm(shape) * (from + (5.0 + 3.0 * 3.0_f64.sqrt()) * U * length);
        let flat_e = part * rows + (0.5 * squares.e / squares.v + 8.0 * U) * flat.length();
        let t = rounded::smoothstep(exact(FLAT[0]), self::off(FLAT[1], 1.0), squares);
        off = thin.lerp(flat, t.v);
        from = thin_e * (1.0 - t.v) + flat_e * t.v + (flat - thin).length() * t.e;
        from += 3.0 * U * (thin.length() + flat.length());
    }
    let eye = Off::direction(view.view.transform_vector3(off));
    let v = c.v + eye.v;
    Off { v, e: c.e + eye.e + from + U * v.length() }
}

/// Sum of the squares of a shape's entries: an entry errs by 5u, a square by u, and there are at
/// most eight sums.
fn squares(shape: &DMat3) -> Rounded {
    off(norm(shape).powi(2), 20.0)
}

/// A droplet at position p with velocity v, half-axis h and optical depth; for mist also its shape.
/// Returns also the world width of a pixel.
///
/// An error of the motion m across the view turns the axes in their plane, by any angle if m is
/// nearly 0. They do not leave the plane, so a circle stays a circle.
fn droplet(
    p: Off,
    v: Off,
    (h, thick, mist): (Rounded, Rounded, Option<&DMat3>),
    view: &View,
    settings: &Settings,
) -> (Droplet, Rounded) {
    let n = p.normalize();
    let along = v.dot(n);
    let m = v.v - along.v * n.v;
    let m_e = v.e + along.e + along.v.abs() * (n.e + U) + U * m.length();
    let m = Off { v: m, e: m_e };
    let speed = m.length();
    let towards = off(HEAD_ON * v.v.length(), 4.0);
    let moving = more(speed, at_least(off(STILL * settings.spacing, 1.0), towards));
    let angle = m.e / (m.v.length() - m.e).max(f64::MIN_POSITIVE);
    let mut turn = match moving {
        More { surely: true, .. } => angle,
        More { maybe: true, .. } => 1.0,
        _ => 0.0,
    };
    let side = if n.v.y.abs() < 0.9 { DVec3::Y } else { DVec3::X };
    let level = side.cross(n.v).normalize();
    let upright = level.cross(n.v);
    // A cross product over the min sine, and a quotient.
    let mut e1 = Off { v: if moving.is { m.v.normalize() } else { level }, e: 24.0 * U };
    let streak = off(0.5 * settings.shutter, 1.0);
    let mut axes = [h + streak * speed, h];
    if let Some(shape) = mist {
        let seen = Seen::new(shape, h, (m, streak), (n, [level, upright]), view);
        axes = seen.half_axes();
        match more(seen.apart, off(ROUND, 1.0) * seen.middle) {
            More { surely: true, .. } => {
                // Perturbation of an eigenvector; then errors of angle, sine and cosine.
                let by = seen.e / (2.0 * seen.apart.v - seen.e).max(f64::MIN_POSITIVE);
                let own = SQRT_2 * (TRIGONOMETRY + U) + 0.5 * ARC * PI;
                e1 = Off { v: seen.longer, e: 24.0 * U + by.min(2.0) + own };
                turn = 0.0;
            }
            More { is, maybe: true, .. } => {
                e1.v = if is { seen.longer } else { e1.v };
                turn = 2.0;
            }
            _ => {}
        }
    }
    let e2 = e1.cross(n);
    let pixel = depth_of(p) * off(view.c_x().max(view.c_y()), 2.0);
    let least = off(LEAST, 1.0) * pixel;
    let [a, b] = axes.map(|half| at_least(half, least));
    let amount = thick * ((h / a) * (h / b));
    let ellipse = LooseEllipse { center: p, e1, e2, n, a, b, turn };
    let drawn = More { is: true, surely: true, maybe: true };
    let radii = off(ASIDE * RADIUS * settings.spacing, 4.0) / pixel + exact(0.5);
    let aside = [radii.v - radii.e, radii.v + radii.e].map(|n| (n as isize).clamp(1, 64));
    (Droplet { ellipse, amount, aside, glint: None, clumps: None, drawn }, pixel)
}

/// The projection of mist: the covariance `C = h^2 P S^2 P^T + s s^T` in the plane across the view.
/// P projects to that plane, S is the shape and s is half the streak.
struct Seen {
    /// Half the sum and half the difference of the eigenvalues.
    middle: Rounded,
    apart: Rounded,
    /// Error of C, as a matrix norm.
    e: f64,
    /// Direction of the longer half-axis.
    longer: DVec3,
}

impl Seen {
    fn new(
        shape: &DMat3,
        h: Rounded,
        (m, half): (Off, Rounded),
        (n, plane): (Off, [DVec3; 2]),
        view: &View,
    ) -> Self {
        let back = DMat3::from_mat4(view.view).transpose();
        let rows = plane.map(|axis| h.v * (*shape * (back * axis)));
        let s = plane.map(|axis| half.v * m.v.dot(axis));
        let entry = |i: usize, j: usize| rows[i].dot(rows[j]) + s[i] * s[j];
        let (xx, yy, xy) = (entry(0, 0), entry(1, 1), entry(0, 1));
        // An axis errs by 24u and by the error of the normal. Two matrix products err by 3u per
        // entry each, times the root of 3 as a vector; the size adds its own error, an entry of the
        // shape 5u.
        let axis = 24.0 * U + n.e / LEAST_SINE;
        let (size, length) = (h.v * norm(shape), half.v * m.v.length());
        let row = size * (axis + (6.0 * 3.0_f64.sqrt() + 6.0) * U) + h.e * norm(shape);
        let along = half.v * m.e + half.e * m.v.length() + length * (axis + 6.0 * U);
        // An entry has products of two uncertain factors, four products and as many sums; the norm
        // of four entries is twice that.
        let of = |v: f64, e: f64| 2.0 * v * e + e * e + 5.0 * U * v * v;
        let e = 2.0 * (of(size, row) + of(length, along));
        let (middle, apart) = (0.5 * (xx + yy), DVec2::new(0.5 * (xx - yy), xy).length());
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        let longer = plane[0] * angle.cos() + plane[1] * angle.sin();
        let rounded = |v: f64, by: f64| Rounded { v, e: e + by * U * v };
        Self { middle: rounded(middle, 2.0), apart: rounded(apart, 13.0), e, longer }
    }

    /// Eigenvalues err by at most the norm; sum and root are in single precision.
    fn half_axes(&self) -> [Rounded; 2] {
        let most = self.middle.v + self.apart.v;
        [most, (self.middle.v - self.apart.v).max(0.0)].map(|square| {
            let e = self.e + 16.0 * U * most;
            let root = Rounded { v: square, e }.sqrt();
            Rounded { e: root.e.min(e.sqrt() + 9.0 * U * root.v), ..root }
        })
    }
}

/// Depth of the water that may hide spray in a pixel. A single drop does not hide it, so the
/// farthest of the pixel and four around it counts.
fn body(water: &Image<f64>, (x, y): (usize, usize), aside: isize) -> f64 {
    let corner = |i: isize, j: isize| water.clamped(x as isize + i * aside, y as isize + j * aside);
    let corners = [corner(-1, -1), corner(1, -1), corner(-1, 1), corner(1, 1)];
    corners.into_iter().fold(water.at(x, y), f64::max)
}

/// The spray in each pixel.
pub struct Spray {
    /// Optical depth by the definition.
    pub depth: Image<f64>,
    /// Bounds of the optical depth in the GPU's image. Contributions that rounding may drop, at
    /// rims, at the scene or by culling, are only in `high`.
    pub bounds: Between,
    /// Bounds of the part that is lit by the sun.
    pub lit: Between,
    /// Max number of contributions to a pixel.
    pub count: Image<u32>,
}

/// Fraction of sunlight at a droplet of a particle, by the droplet's world position and the
/// position's error in world units.
pub type Sun<'a> = dyn Fn(&Particle, DVec3, f64) -> Rounded + 'a;

/// The spray of particles. `scene`: eye depth of the scene that hides spray, infinite or
/// [`EMPTY`](super::EMPTY) where there is nothing; `water`: eye depth of the nearest water,
/// likewise.
pub fn spray(
    particles: &[Particle],
    view: &View,
    settings: &Settings,
    scene: &Image<f64>,
    water: &Image<f64>,
) -> Spray {
    spray_in_sun(particles, view, settings, scene, water, &|_, _, _| exact(1.0))
}

/// The spray of particles, with a fraction of sunlight for each droplet.
pub fn spray_in_sun(
    particles: &[Particle],
    view: &View,
    settings: &Settings,
    scene: &Image<f64>,
    water: &Image<f64>,
    sun: &Sun<'_>,
) -> Spray {
    let near = view.near();
    let back = view.view.inverse();
    let eye = back.w_axis.truncate().length();
    let mut depth = Image::new(view.width, view.height, 0.0);
    let (mut low, mut high, mut count) = (depth.clone(), depth.clone(), depth.map(|_| 0));
    let mut lit = Between { low: low.clone(), high: high.clone() };
    let all =
        particles.iter().flat_map(|p| droplets(p, view, settings).into_iter().map(move |d| (p, d)));
    // Of the kernel: u/2 under the root, 9u for the root, 7 ulp for the exponential, 2u for the products.
    let rounding = U * (0.5 + 9.0 + 14.0 + 2.0);
    for (particle, one) in all {
        let center = one.ellipse.center;
        let p = back.transform_point3(center.v);
        // The position is transformed to the light's space by one matrix, with the same error as
        // through world space.
        let share = sun(particle, p, center.e + 24.0 * U * (p.length() + 2.0 * eye));
        // Three products with a rounded third, and their sum.
        let share = scattered(share * off(1.0, 4.0), settings.scattering);
        // The product under the kernel's root errs by u, the kernel as above, product and sum by u each.
        let glint = |ratio: f64, by: f64| {
            let light = settings.glints * kernel((ratio * (1.0 + by * U)).clamp(0.0, 1.0));
            1.0 + light * (1.0 - by * rounding) - by * 2.0 * U * (1.0 + light)
        };
        for (x, y) in pixels(view, one.ellipse.center.v, one.ellipse.reach()) {
            let hidden = scene_depth(scene.at(x, y));
            let ray = ray_off(view, x, y);
            let Some(hit) = one.ellipse.meet(ray, near, hidden) else { continue };
            let before = one.aside.map(|aside| {
                let behind = hit.k - exact(body(water, (x, y), aside));
                let fade = off(FADE * settings.spacing, 1.0);
                exact(1.0) - rounded::smoothstep(exact(0.0), fade, behind)
            });
            let apart = (before[0].v - before[1].v).abs();
            let before = Rounded { e: before[0].e.max(before[1].e) + apart, ..before[0] };
            let clumps = one.clumps.map_or(exact(1.0), |(clumps, moving)| {
                let e = ray.v.length() * (hit.k.e + 4.0 * U * hit.k.v) + ray.e * hit.k.v;
                let point = Off { v: ray.v * hit.k.v, e }.to_world(view);
                clumps.at(point, moving, hit.k * off(view.c_x().max(view.c_y()), 2.0))
            });
            let (top, q) = (before * one.amount * clumps, hit.rho_squared);
            if one.drawn.is && q.v <= 1.0 && hit.k.v >= near && hit.k.v < hidden {
                *depth.at_mut(x, y) += top.v * kernel(q.v);
            }
            if one.drawn.surely && hit.sure {
                let least = (top.v - top.e).max(0.0) * kernel((q.v + q.e).min(1.0));
                *low.at_mut(x, y) += settings.sums.in_steps(least * (1.0 - rounding), -1.0);
                let glint =
                    one.glint.map_or(1.0, |of| glint((q.v + q.e) * (of.v + of.e), 1.0).max(0.0));
                let least =
                    least * (share.v - share.e).max(0.0) * glint * (1.0 - rounding - 2.0 * U);
                *lit.low.at_mut(x, y) += settings.sums.in_steps(least, -1.0);
            }
            let most = (top.v + top.e) * kernel((q.v - q.e).max(0.0));
            *high.at_mut(x, y) += settings.sums.in_steps(most * (1.0 + rounding), 1.0);
            let glint =
                one.glint.map_or(1.0, |of| glint((q.v - q.e).max(0.0) * (of.v - of.e), -1.0));
            let most = most * (share.v + share.e) * glint * (1.0 + rounding + 2.0 * U);
            *lit.high.at_mut(x, y) += settings.sums.in_steps(most, 1.0);
            *count.at_mut(x, y) += 1;
        }
    }
    let mut bounds = Between { low, high };
    for of in [&mut bounds, &mut lit] {
        for (i, n) in count.data.iter().enumerate() {
            of.low.data[i] = settings.sums.summed(of.low.data[i], *n)[0];
            of.high.data[i] = settings.sums.summed(of.high.data[i], *n)[1];
        }
    }
    Spray { depth, bounds, lit, count }
}

/// Sunlight with the scattered part, for the fraction that arrives directly: two roots and a
/// mixture. It increases with that fraction.
fn scattered(direct: Rounded, scattering: f64) -> Rounded {
    let of = |direct: f64| {
        let direct = direct.max(0.0);
        direct * (1.0 - scattering) + direct.powf(0.25) * scattering
    };
    let (v, low, high) = (of(direct.v), of(direct.v - direct.e), of(direct.v + direct.e));
    Rounded { v, e: (high - v).max(v - low) + 18.0 * U * high }
}
