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

use super::classify;
use super::shape::norm;
use super::surface_foam::{
    LooseEllipse, Off, Pattern, Phase, TOLD_APART, VARIANCE, WRAP, noise, noise_reach,
    noise_rounding, noise_slope, pixels, ray_off, scene_depth,
};
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
pub const SIZES: [f64; 2] = [0.2, 2.135];
/// Fraction of the droplets and the mist of a particle that is only spray.
const LEAST_TORN: f64 = 0.3;
/// First of a particle's random numbers for its spindle.
const SPINDLE: u32 = 4096;
/// Of this many droplets one glints; first of a particle's random numbers for that.
const GLINT_ONE_OF: f64 = 32.0;
const GLINT: u32 = 8192;
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
/// Relief: the nearest distance in picture heights, the number of distances, and the optical depth
/// that counts as thin.
const RELIEF: (f64, u32, f64) = (1.0 / 360.0, 5, 0.3);
/// Fraction by which relief reduces the sky's light.
const RELIEF_OF_SKY: f64 = 0.19;
/// Clumps: the cell width of the coarsest octave in spacings, the ratio of the cell widths of
/// successive octaves, and their number in mist and at a droplet.
const CLUMP: f64 = 3.0;
const FINER: f64 = 2.03;
const OCTAVES: [u32; 2] = [7, 3];
/// Excess of a cell's length over its width, relative to the way of the droplets along their
/// motion; the max ratio of length to width; the factor on the excess from octave to octave.
const STRAND_LENGTH: f64 = 4.0;
const MOST_STRAND: f64 = 4.0;
const ROUNDER: f64 = 0.75;
/// Cells are lengthened from the centre of a block this many cells wide.
const BLOCK: f64 = 8.0;
/// Max logarithm of the density.
const MOST_CLUMP: f64 = 3.0;

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
    /// n, the number of droplets per particle.
    pub droplets: u32,
    /// Max distance of droplets from the particle's centre, in spacings.
    pub spread: f64,
    /// Max distance of droplets along the motion, before and behind the particle, in seconds of
    /// motion.
    pub stretch: f64,
    /// Mist: the opacity at its middle, and its half-axis in spacings.
    pub mist: [f64; 2],
    /// Amplitude of an octave of the logarithm of the density.
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
    /// Whether it mirrors the sun.
    glints: bool,
    /// Clumps of mist, with the particle's centre and velocity in world space.
    clumps: Option<(Clumps, (Off, Off))>,
    /// Whether the droplet is drawn.
    drawn: More,
}

/// The clumps of a droplet or of mist.
#[derive(Clone, Copy, Debug)]
pub struct Clumps {
    /// Amplitude of an octave of the logarithm of the density.
    pub strength: f64,
    /// Seconds by which droplets are moved along their motion at most.
    pub stretch: f64,
    /// Rest spacing of the particles in world units.
    pub spacing: f64,
    /// The two phases of the noise, as of the foam's pattern.
    pub phases: [Phase; 2],
    /// Octaves from this number on are left out.
    pub octaves: u32,
}

impl Clumps {
    /// Density relative to its mean at a point of a particle with this centre and velocity, all in
    /// world space. `pixel`: width of a pixel there.
    pub fn at(&self, point: Off, (centre, velocity): (Off, Off), pixel: Rounded) -> Rounded {
        let width = CLUMP * self.spacing;
        // The width errs by 2u, a quotient by 6u of it.
        let over = |v: Off| Off { v: v.v / width, e: v.e / width + 8.0 * U * v.v.length() / width };
        let minus = |a: Off, b: Off| {
            let v = a.v - b.v;
            Off { v, e: a.e + b.e + U * v.length() }
        };
        let speed = velocity.length();
        let along = if speed.v > 0.0 { velocity.normalize() } else { velocity };
        let longer = off(STRAND_LENGTH * self.stretch / width, 8.0) * speed;
        let excess = longer.clamp(0.0, MOST_STRAND - 1.0);
        let (middle, apart) = (over(centre), over(minus(point, centre)));
        let wrapped = middle.v - WRAP * (middle.v / WRAP + 0.5).floor();
        let middle = Off { v: wrapped, ..middle };
        let mut places = self.phases.map(|phase| {
            let way = over(Off {
                v: velocity.v * phase.carried,
                e: velocity.e * phase.carried.abs()
                    + 4.0 * U * (velocity.v * phase.carried).length(),
            });
            let begun = minus(middle, way);
            let cell = (begun.v / BLOCK).floor();
            let block = BLOCK * (cell + 0.5);
            // At the border of a block, rounding may select the next block, but there the noise is
            // not lengthened and does not depend on the block.
            let rim = Rounded {
                v: 2.0 / BLOCK * (begun.v - block).abs().max_element(),
                e: 2.0 / BLOCK * (begun.e + 6.0 * U * begun.v.length()),
            };
            let inner = exact(1.0) - rounded::smoothstep(off(0.8, 1.0), exact(1.0), rim);
            let off = Off {
                v: begun.v - block + apart.v,
                e: begun.e + apart.e + 3.0 * U * (begun.v.length() + apart.v.length()),
            };
            (off, block + phase.began, excess * inner)
        });
        let (mut sum, mut finer) = (exact(0.0), 1.0);
        for _ in 0..self.octaves {
            let (from, to) = TOLD_APART;
            let told = rounded::smoothstep(exact(from), exact(to), off(width / finer, 8.0) / pixel);
            for (phase, (off, block, excess)) in self.phases.iter().zip(&mut places) {
                let height = exact(self.strength) * self::off(phase.part, 2.0) * told;
                let on = off.dot(along) * (*excess / (exact(1.0) + *excess));
                *excess = *excess * exact(ROUNDER);
                let v = finer * (*block + off.v - on.v * along.v);
                let terms = block.length() + off.v.length() + on.v.abs();
                let e = off.e + on.e + (on.v.abs() + on.e) * (along.e + 2.0 * U) + 4.0 * U * terms;
                // Three sums; up to six products with the ratio, which is itself rounded.
                let apart = 3.0_f64.sqrt() * (finer * e + 10.0 * U * v.length());
                let near = noise_slope() * apart + noise_rounding();
                let noise = Rounded { v: noise(v), e: near.min(2.0 * noise_reach()) };
                sum = sum + height * (noise - exact(0.5 * VARIANCE) * height);
            }
            finer *= FINER;
        }
        let most = |v: f64| v.min(MOST_CLUMP);
        let (v, high, low) = (most(sum.v), most(sum.v + sum.e), most(sum.v - sum.e));
        Rounded { v, e: (high - v).max(v - low) }.exp()
    }
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
    let back = view.view.inverse();
    let eye = back.w_axis.truncate().length();
    let to_world = |p: Off| Off { v: back.transform_point3(p.v), e: p.e + back_error(p.v, eye) };
    let v = Off::direction(view.view.transform_vector3(particle.velocity));
    let moving = (to_world(c), Off { v: particle.velocity, e: 2.0 * v.e });
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
            h = h * (exact(1.0) / torn.sqrt());
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
        one.glints = many && k > 0 && GLINT_ONE_OF * random(GLINT + k) < 1.0;
        if many && k == 0 {
            let crowd = smoothstep(CROWD.0, CROWD.1, particle.crowd);
            one.amount = share * torn * torn * torn * Rounded { v: crowd, e: 8.0 * U } * one.amount;
            one.clumps = (settings.clumps > 0.0).then_some((clumps(0), moving));
        } else if many && settings.clumps > 0.0 {
            let point = to_world(one.ellipse.center);
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

/// Error of a point transformed from eye space to the world by a matrix in single precision, whose
/// entries err as the inverse does.
fn back_error(v: DVec3, eye: f64) -> f64 {
    16.0 * U * (3.0_f64.sqrt() * v.length() + eye)
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
    (Droplet { ellipse, amount, aside, glints: false, clumps: None, drawn }, pixel)
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
    for (particle, one) in all {
        let center = one.ellipse.center;
        let p = back.transform_point3(center.v);
        // The position is transformed to the light's space by one matrix, with the same error as
        // through world space.
        let share = sun(particle, p, center.e + 24.0 * U * (p.length() + 2.0 * eye));
        // Three products with a rounded third, and their sum.
        let share = scattered(share * off(1.0, 4.0), settings.scattering);
        let glint = if one.glints { off(1.0 + settings.glints, 2.0) } else { exact(1.0) };
        let share = share * glint;
        for (x, y) in pixels(view, one.ellipse.center.v, one.ellipse.reach()) {
            let hidden = scene_depth(scene.at(x, y));
            let hit = one.ellipse.meet(ray_off(view, x, y), near, hidden);
            let Some(hit) = hit else { continue };
            let before = one.aside.map(|aside| {
                let behind = hit.k - exact(body(water, (x, y), aside));
                let fade = off(FADE * settings.spacing, 1.0);
                exact(1.0) - rounded::smoothstep(exact(0.0), fade, behind)
            });
            let apart = (before[0].v - before[1].v).abs();
            let before = Rounded { e: before[0].e.max(before[1].e) + apart, ..before[0] };
            let ray = ray_off(view, x, y);
            let clumps = one.clumps.map_or(exact(1.0), |(clumps, moving)| {
                let at =
                    Off { v: ray.v * hit.k.v, e: ray.v.length() * (hit.k.e + 4.0 * U * hit.k.v) };
                let point = Off {
                    v: back.transform_point3(at.v),
                    e: at.e + ray.e * hit.k.v + back_error(at.v, eye),
                };
                clumps.at(point, moving, hit.k * off(view.c_x().max(view.c_y()), 2.0))
            });
            let (top, q) = (before * one.amount * clumps, hit.rho_squared);
            if one.drawn.is && q.v <= 1.0 && hit.k.v >= near && hit.k.v < hidden {
                *depth.at_mut(x, y) += top.v * kernel(q.v);
            }
            // u/2 under the root, 9u for the root, 7 ulp for the exponential, 2u for the products.
            let rounding = U * (0.5 + 9.0 + 14.0 + 2.0);
            if one.drawn.surely && hit.sure {
                let least = (top.v - top.e).max(0.0) * kernel((q.v + q.e).min(1.0));
                *low.at_mut(x, y) += settings.sums.in_steps(least * (1.0 - rounding), -1.0);
                let least = least * (share.v - share.e).max(0.0) * (1.0 - rounding - U);
                *lit.low.at_mut(x, y) += settings.sums.in_steps(least, -1.0);
            }
            let most = (top.v + top.e) * kernel((q.v - q.e).max(0.0));
            *high.at_mut(x, y) += settings.sums.in_steps(most * (1.0 + rounding), 1.0);
            let most = most * (share.v + share.e) * (1.0 + rounding + U);
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

/// Logarithm of a positive number: errs by 2^-21 from 1/2 to 2, elsewhere by 3 ulp.
fn ln(x: Rounded) -> Rounded {
    let v = x.v.ln();
    let own = if (0.49..=2.01).contains(&x.v) { 8.0 } else { 6.0 * v.abs() };
    Rounded { v, e: x.e / (x.v - x.e) + own * U }
}

/// Relief of spray: its strength, and the direction to the sun in pixels of the screen, or 0.
#[derive(Clone, Copy, Debug)]
pub struct Relief {
    pub strength: f64,
    pub toward: DVec2,
}

impl Relief {
    /// `sun`: direction to the sun in world space.
    pub fn new(strength: f64, sun: DVec3, view: &View) -> Self {
        let toward = view.view.transform_vector3(sun.normalize()).truncate() / view.slope_step();
        Self { strength, toward: toward.normalize_or_zero() }
    }

    /// Fraction of sunlight in the spray of a pixel with relief, from the optical depths of all
    /// spray and of its lit part.
    pub fn lit(&self, all: &Image<f32>, lit: &Image<f32>, (x, y): (usize, usize)) -> Rounded {
        let own = f64::from(all.at(x, y));
        let part = exact(f64::from(lit.at(x, y))) / exact(own);
        if self.strength == 0.0 {
            return part;
        }
        let (near, octaves, thin) = RELIEF;
        let thin = off(thin, 1.0);
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let mut sum = exact(0.0);
        for i in 0..octaves {
            let away = self.toward * near * all.height as f64 * f64::from(1 << i);
            let there = at + away;
            // Position rounding may select a neighbouring texel, in columns and in rows.
            let loose = 16.0 * U * (there.abs().max_element() + away.length() + 1.0) + 1.0e-4;
            let mut logs = [-1.0, 1.0].into_iter().flat_map(|i| {
                [-1.0, 1.0].map(|j| {
                    let place = (there + DVec2::new(i, j) * loose).floor();
                    ln(thin + exact(f64::from(all.clamped(place.x as isize, place.y as isize))))
                })
            });
            let first = logs.next().expect("four");
            let [mut low, mut high] = [first.v - first.e, first.v + first.e];
            for log in logs {
                (low, high) = (low.min(log.v - log.e), high.max(log.v + log.e));
            }
            sum = sum + Rounded { v: 0.5 * (low + high), e: 0.5 * (high - low) };
        }
        let denser = sum / exact(f64::from(octaves)) - ln(thin + exact(own));
        let factor = (-(off(self.strength, 1.0) * denser)).exp();
        let (lit, most) = (part * factor, at_least(part, exact(1.0)));
        // Far enough above its maximum, the value is the maximum.
        let above = lit.v - lit.e > most.v + most.e;
        let e = if above { most.e } else { lit.e.max(most.e) };
        Rounded { v: lit.v.min(most.v), e }
    }

    /// Light with relief, divided by the sun's; `sky`: the sky's light divided by the sun's.
    pub fn light(&self, lit: Rounded, sky: f64) -> Rounded {
        let sky = off(sky, 5.0);
        let under = rounded::mix(sky, exact(1.0), lit);
        let dull = off(RELIEF_OF_SKY, 1.0) * off(self.strength, 1.0);
        under * (exact(1.0) - dull * (exact(1.0) - lit).clamp(0.0, 1.0))
    }
}

/// A colour channel behind spray of this optical depth and light, and its error in single
/// precision: exp errs by 3 + 2x ulp, a difference and five products are added, for each of the two
/// terms.
pub fn over(behind: f64, spray: f64, light: Rounded, additive: bool) -> (f64, f64) {
    let k = (-spray).exp();
    let v = behind * if additive { 1.0 } else { k } + light.v * (1.0 - k);
    (v, light.e * (1.0 - k) + U * (12.0 + 4.0 * spray) * (behind.abs() + light.v))
}

#[cfg(test)]
mod tests {
    use super::super::tests::view;
    use super::super::thickness::J;
    use super::*;
    use crate::reference::EMPTY;
    use crate::support::scenes::Random;
    use glam::{Mat3, Mat4, Vec2, Vec3};

    fn settings() -> Settings {
        Settings {
            spacing: 0.5,
            rest_density: 1000.0,
            opacity: 0.5,
            size: 0.5,
            droplets: 1,
            spread: 0.0,
            stretch: 0.0,
            mist: [0.1, 0.4],
            clumps: 0.0,
            pattern: Pattern { strength: 0.0, size: 1.0, period: 0.25, time: 0.3 },
            densities: [0.6, 0.85],
            shutter: 1.0 / 60.0,
            scattering: 0.0,
            glints: 0.0,
            sums: Sums { step: 0.0, ..Sums::HALF },
        }
    }

    fn particle(position: [f64; 3]) -> Particle {
        let position = DVec3::from(position);
        Particle {
            position,
            velocity: DVec3::ZERO,
            density: 500.0,
            id: 7,
            shape: BALL,
            crowd: CROWDED,
        }
    }

    fn open(view: &View) -> Image<f64> {
        Image::new(view.width, view.height, EMPTY)
    }

    fn total(particles: &[Particle], view: &View, settings: &Settings) -> f64 {
        let none = open(view);
        spray(particles, view, settings, &none, &none).depth.data.iter().sum()
    }

    #[test]
    fn the_amount_is_the_integral_and_no_motion_changes_it() {
        let (settings, view) = (settings(), view(DVec2::splat(3.0), DVec2::ZERO, 401, 301));
        let (at, d) = ([0.0, 0.0, -9.0], 9.0);
        let area = view.c_x() * view.c_y() * d * d;
        let h = 0.5 * RADIUS * 0.5;
        let expected = 2.0_f64.ln() * h * h * PI * J;
        for (density, share) in [(500.0, 1.0), (725.0, 0.5)] {
            for velocity in [DVec3::ZERO, 20.0 * DVec3::X, DVec3::new(-9.0, 30.0, 0.0)] {
                let found =
                    total(&[Particle { density, velocity, ..particle(at) }], &view, &settings);
                let ratio = found * area / (share * expected);
                assert!((ratio - 1.0).abs() < 3e-3, "{density}, {velocity}: {ratio}");
            }
            // Motion straight towards the eye is not visible.
            let towards = Particle { velocity: 30.0 * DVec3::Z, ..particle(at) };
            assert_eq!(
                total(&[towards], &view, &settings),
                total(&[particle(at)], &view, &settings)
            );
        }
        // Many droplets have the same sum in the mean, plus the mist, which is the first. For 400
        // particles the drawn fraction, uniform from a fifth to 1, averages to within 2 %, and the
        // sizes to within 1 %.
        let mist = 0.3_f64.powi(3) * (0.9_f64.ln() / 0.5_f64.ln()) * (0.4 * 0.5 / h).powi(2);
        let many = Settings { droplets: 64, spread: 1.5, stretch: 0.02, ..settings };
        let velocity = DVec3::new(5.0, 0.0, 2.0);
        let all: Vec<_> = (0..400).map(|id| Particle { id, velocity, ..particle(at) }).collect();
        let ratio = total(&all, &view, &many) * area / (400.0 * expected * (1.0 + mist));
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }

    /// Whatever the mist's shape and streak, the sum over the picture only depends on its
    /// half-axis. Pixels sample the kernel of an ellipse at least two pixels wide to within a
    /// hundredth.
    #[test]
    fn mist_keeps_its_amount_in_every_shape() {
        let view = view(DVec2::splat(3.0), DVec2::ZERO, 401, 301);
        let look = Settings { droplets: 2, opacity: 0.0, mist: [0.4, 1.0], ..settings() };
        let area = view.c_x() * view.c_y() * 81.0;
        // The particle is half spray, and has all of its mist.
        let expected = 0.5 * -(0.6_f64.ln()) * (1.0 * 0.5_f64).powi(2) * PI * J;
        let strand = shaped([4.0, 0.5, 0.5], DVec3::new(1.0, 2.0, 0.5), 1.1);
        for shape in [BALL, shaped([2.0, 2.0, 0.25], DVec3::Y, 1.2), strand] {
            for velocity in [DVec3::ZERO, DVec3::new(30.0, 60.0, -9.0)] {
                let one =
                    Particle { density: 725.0, velocity, shape, ..particle([0.0, 0.0, -9.0]) };
                let ratio = total(&[one], &view, &look) * area / expected;
                assert!((ratio - 1.0).abs() < 0.01, "{shape}, {velocity}: {ratio}");
            }
        }
    }

    /// Ellipses computed by hand: a sheet of mist seen edge-on, with streaks along it and across
    /// it.
    #[test]
    fn mist_is_seen_as_its_ellipsoid_and_its_streak() {
        let view = view(DVec2::splat(3.0), DVec2::ZERO, 101, 101);
        let look =
            Settings { droplets: 2, mist: [0.4, 1.0], shutter: 0.5, spread: 0.0, ..settings() };
        let sheet = shaped([2.0, 0.25, 2.0], DVec3::X, 0.0);
        // The half-axis is 0.5, so the sheet has 1 and 0.125 across the view; half of a streak of 2
        // m over half a second is added.
        for (velocity, wide) in [
            (DVec3::ZERO, [1.0, 0.125]),
            (2.0 * DVec3::X, [1.25_f64.sqrt(), 0.125]),
            (2.0 * DVec3::Y, [1.0, 0.265_625_f64.sqrt()]),
            (2.0 * DVec3::Z, [1.0, 0.125]),
            (4.0 * DVec3::Y, [1.0, 1.015_625_f64.sqrt()]),
        ] {
            let one = Particle { velocity, shape: sheet, ..particle([0.0, 0.0, -9.0]) };
            let mist = droplets(&one, &view, &look)[0];
            let LooseEllipse { a, b, e1, .. } = mist.ellipse;
            let upright = wide[1] > wide[0];
            let [long, short] = if upright { [wide[1], wide[0]] } else { wide };
            assert!(
                (a.v - long).abs() < 1e-3 && (b.v - short).abs() < 1e-3,
                "{velocity}: {a:?} {b:?}"
            );
            let along = if upright { e1.v.y } else { e1.v.x };
            assert!(along.abs() > 0.999, "{velocity}: {}", e1.v);
        }
    }

    /// Droplets of a strand lie in it. Droplets of a ball lie in the spindle, as without shapes.
    #[test]
    fn droplets_fill_their_shape() {
        let view = view(DVec2::splat(3.0), DVec2::ZERO, 101, 101);
        let look = Settings { droplets: 64, spread: 1.5, ..settings() };
        let at = DVec3::new(0.0, 0.0, -9.0);
        let strand = shaped([4.0, 0.5, 0.5], DVec3::Z, 0.6);
        let along = DVec3::new(0.6_f64.cos(), 0.6_f64.sin(), 0.0);
        let (mut squares, mut count) = ([0.0, 0.0], 0.0);
        for id in 0..60 {
            let one = Particle { id, density: 725.0, ..particle(at.to_array()) };
            let of = |shape| droplets(&Particle { shape, ..one }, &view, &look);
            for droplet in of(strand) {
                let off = droplet.ellipse.center.v - at;
                squares[0] += off.dot(along).powi(2);
                squares[1] += off.length_squared() - off.dot(along).powi(2);
                count += 1.0;
            }
            for (k, droplet) in of(BALL).iter().enumerate() {
                let random = |n| f64::from(classify::random(SEED, n, id));
                let ball = direction(random(5 * k as u32), random(5 * k as u32 + 1)).v
                    * (0.75 * random(5 * k as u32 + 2).cbrt());
                let axis = direction(random(SPINDLE), random(SPINDLE + 1)).v;
                let wide = (1.0 + 5.0 * random(SPINDLE + 2)) / 6.0;
                let thin = wide * (0.4 * ball + 0.6 * ball.dot(axis) * axis);
                assert!((droplet.ellipse.center.v - at - thin).length() < 1e-6, "{id} {k}");
            }
        }
        // A ball with r = 0.75 has a variance of r^2/5 per axis; the squared factors are 0.49/16.5
        // times 16, and 1/4 for each of the other two axes.
        let of_ball = 0.75 * 0.75 / 5.0 * 0.49 / 16.5;
        let [long, wide] = squares.map(|sum| sum / count / of_ball);
        // Sampling error of about a thousand droplets.
        assert!((long / 16.0 - 1.0).abs() < 0.1 && (wide / 0.5 - 1.0).abs() < 0.1, "{long} {wide}");
    }

    /// Scattering takes the fourth root; without direct light there is none.
    #[test]
    fn scattering_brightens_the_shade() {
        for (direct, scattering, expected) in [
            (1.0, 0.7, 1.0),
            (0.0, 1.0, 0.0),
            (1.0 / 16.0, 1.0, 0.5),
            (1.0 / 16.0, 0.0, 1.0 / 16.0),
        ] {
            assert!((scattered(exact(direct), scattering).v - expected).abs() < 1e-12);
        }
    }

    /// A dense strip shades the spray behind it, seen from the sun, and its own side facing the sun
    /// is brighter. Uniform spray has no relief.
    #[test]
    fn relief_is_on_the_side_away_from_the_sun() {
        let strip =
            Image::from_fn(90, 80, |x, _| if (40..48).contains(&x) { 2.0_f32 } else { 0.2 });
        let lit = strip.map(|x| 0.5 * x);
        let of = |image: &Image<f32>, lit: &Image<f32>, x| {
            let relief = Relief { strength: 1.0, toward: DVec2::X };
            relief.lit(image, lit, (x, 40)).v
        };
        // The farthest sample is 3.6 texels away.
        assert!(of(&strip, &lit, 38) < 0.35 && (of(&strip, &lit, 50) - 0.5).abs() < 1e-9);
        assert!(of(&strip, &lit, 46) > 0.6 && (of(&strip, &lit, 42) - 0.5).abs() < 1e-9);
        let even = strip.map(|_| 0.7);
        assert!((of(&even, &even.map(|x| 0.25 * x), 3) - 0.25).abs() < 1e-7);
    }

    /// Clumps at points of a particle with a velocity.
    fn clumps(velocity: DVec3, strength: f64) -> impl Fn(DVec3, DVec3) -> f64 {
        let phases = settings().pattern.phases();
        let held = |v| Off { v, e: 0.0 };
        let clumps = Clumps { strength, stretch: 0.1, spacing: 0.5, phases, octaves: OCTAVES[0] };
        move |point, centre| clumps.at(held(point), (held(centre), held(velocity)), exact(1.0e-3)).v
    }

    /// Clumpy spray has the same mean as even spray: within 4 % up to an amplitude of 2, plus the
    /// sampling error of 40000 points. A Gaussian logarithm with the same variance varies more.
    #[test]
    fn clumps_keep_the_mean() {
        let mut random = Random(3);
        for strength in [0.5, 1.0, 2.0] {
            let density = clumps(DVec3::new(3.0, 1.0, 0.0), strength);
            let all = (0..40_000).map(|_| {
                let mut of = || f64::from(random.between(-900.0, 900.0));
                let point = DVec3::new(of(), of(), of());
                density(point, point)
            });
            let all: Vec<f64> = all.collect();
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            let square = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / all.len() as f64;
            let chance = 4.0 * (square / all.len() as f64).sqrt();
            assert!((mean - 1.0).abs() < 0.04 + chance, "{strength}: {mean}");
            let most = (f64::from(OCTAVES[0]) * VARIANCE * strength * strength).exp() - 1.0;
            assert!((0.5 * most..1.05 * most).contains(&square), "{strength}: {square} of {most}");
        }
    }

    /// Particles of one block share their clumps. With lengthened cells those of another block have
    /// others.
    #[test]
    fn neighbours_share_their_clumps() {
        let density = clumps(DVec3::new(3.0, 1.0, 0.0), 2.0);
        // Blocks are 12 m wide. The velocity moves them by up to a quarter of a metre.
        let point = DVec3::new(5.8, 6.1, 5.9);
        let own = density(point, point);
        for near in [DVec3::X, DVec3::new(-0.6, 0.4, 0.9)] {
            assert!((density(point, point + near) / own - 1.0).abs() < 1e-9, "{near}");
        }
        assert!((density(point, point + 12.0 * DVec3::X) / own - 1.0).abs() > 1e-3);
    }

    /// Densities stay similar over a longer way along the motion than across it; without motion,
    /// over equal ways. Compared is the root mean square change of the logarithm over a step half as
    /// long as the finest cell is wide.
    #[test]
    fn clumps_are_longer_along_the_motion() {
        let change = |velocity: DVec3, step: DVec3| {
            let density = clumps(velocity, 1.0);
            let mut random = Random(5);
            let all = (0..4000).map(|_| {
                let mut of = || f64::from(random.between(-90.0, 90.0));
                let point = DVec3::new(of(), of(), of());
                (density(point + 0.01 * step, point) / density(point, point)).ln().powi(2)
            });
            (all.sum::<f64>() / 4000.0).sqrt()
        };
        let fast = 20.0 * DVec3::X;
        let ratio = change(fast, DVec3::X) / change(fast, DVec3::Y);
        assert!(ratio < 0.75, "{ratio}");
        let still = change(DVec3::ZERO, DVec3::X) / change(DVec3::ZERO, DVec3::Y);
        assert!((still - 1.0).abs() < 0.1, "{still}");
    }

    /// Spray that hardly moves is the same for every direction of motion, so a direction that
    /// changes between frames does not make it flicker.
    #[test]
    fn clumps_do_not_turn_with_the_motion() {
        let base = settings();
        let look = Settings { droplets: 64, stretch: 0.02, mist: [0.9, 2.0], clumps: 2.0, ..base };
        let view = view(DVec2::splat(3.0), DVec2::ZERO, 101, 101);
        let image = |velocity: DVec3| {
            let one = Particle { velocity, density: 700.0, ..particle([0.2, -0.1, -9.0]) };
            let none = open(&view);
            spray(&[one], &view, &look, &none, &none).depth.data
        };
        let ways = [DVec3::X, DVec3::Y, DVec3::new(-0.6, 0.8, 0.0), DVec3::ZERO];
        let images = ways.map(|way| image(1.0e-4 * way));
        let sum: f64 = images[3].iter().sum();
        assert!(sum > 1.0, "{sum}");
        for (way, other) in ways.iter().zip(&images) {
            let apart: f64 = other.iter().zip(&images[3]).map(|(a, b)| (a - b).abs()).sum();
            assert!(apart < 1.0e-3 * sum, "{way}: {apart} of {sum}");
        }
    }

    #[test]
    fn what_takes_no_part() {
        let (settings, view) = (settings(), view(DVec2::ONE, DVec2::ZERO, 17, 17));
        let good = particle([0.0, 0.0, -3.0]);
        for density in [850.0, 1000.0, f64::INFINITY, 0.0, -1.0, f64::NAN] {
            let none = total(&[Particle { density, ..good }], &view, &settings);
            assert_eq!(none, 0.0, "{density}");
        }
        assert!(total(&[Particle { density: 849.0, ..good }], &view, &settings) > 0.0);
        let (nan, far) = (DVec3::new(0.0, f64::NAN, 0.0), DVec3::new(-2e18, 0.0, 0.0));
        for bad in [
            Particle { position: nan, ..good },
            Particle { velocity: nan, ..good },
            Particle { velocity: far, ..good },
            particle([0.0, 0.0, -0.09]),
            particle([0.0, 0.0, 3.0]),
            // Nearer than twice the droplet's half-axis.
            particle([0.0, 0.0, -0.3]),
        ] {
            assert_eq!(total(&[bad], &view, &settings), 0.0, "{bad:?}");
        }
        let spread = Settings { spread: 6.1, ..settings };
        assert_eq!(total(&[good], &view, &spread), 0.0, "nearer than the spread");
        // Spray behind water fades completely, spray before it is unchanged.
        let none = open(&view);
        let of = |scene: f64, water: f64| {
            spray(&[good], &view, &settings, &none.map(|_| scene), &none.map(|_| water)).depth.data
        };
        assert_eq!(of(EMPTY, 3.0), of(EMPTY, EMPTY));
        assert!(of(EMPTY, 2.2).iter().chain(&of(2.9, EMPTY)).all(|v| *v == 0.0));
    }

    /// Covariance in space of a ball with half-axis h, transformed by a matrix, plus half a streak.
    fn covariance(map: &Mat3, h: f32, streak: Vec3) -> Mat3 {
        let scaled = h * *map;
        let outer = Mat3::from_cols(streak * streak.x, streak * streak.y, streak * streak.z);
        scaled * scaled.transpose() + outer
    }

    /// A matrix rounded to 16 bits.
    fn held_shape(m: DMat3) -> DMat3 {
        DMat3::from_cols_array(
            &m.to_cols_array().map(|x| (x / 4.0 * 32767.0).round() * 4.0 / 32767.0),
        )
    }

    /// A shape with these half-axes, rotated about an axis.
    fn shaped(axes: [f64; 3], about: DVec3, angle: f64) -> DMat3 {
        let r = DMat3::from_axis_angle(about.normalize(), angle);
        held_shape(r * DMat3::from_diagonal(axes.into()) * r.transpose())
    }

    /// The definition in single precision, with every operation rounded and the sum in half
    /// precision.
    fn single(
        particle: &Particle,
        view: &View,
        settings: &Settings,
        (scene, water): (&Image<f64>, &Image<f64>),
    ) -> Image<half::f16> {
        let mut sum = Image::new(view.width, view.height, half::f16::ZERO);
        let to_eye = view.view.as_mat4();
        let (s, n, near) = (settings.spacing as f32, settings.droplets, view.near() as f32);
        let step = |low: f32, high: f32, x: f32| {
            let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        let (spread, rest) = (settings.spread as f32 * s, settings.rest_density as f32);
        let [all, none] = settings.densities.map(|d| d as f32 * rest);
        let scale = view.slope_step().as_vec2();
        let first = ((view.shift() - 1.0) / view.focal()).as_vec2();
        let share = 1.0 - step(all, none.max(all * 1.000001 + 1e-6), particle.density as f32);
        let c = to_eye.transform_point3(particle.position.as_vec3());
        let v = to_eye.transform_vector3(particle.velocity.as_vec3());
        if share <= 0.0 || -c.z <= near.max(spread) {
            return sum;
        }
        let torn = if n > 1 { (4.0 - 4.0 * share).clamp(0.3, 1.0) } else { 1.0 };
        let shape = particle.shape.as_mat3();
        let squares: f32 = shape.to_cols_array().into_iter().map(|x| x * x).sum();
        for k in 0..n {
            let random = |j| classify::random(SEED, j, particle.id);
            let u = [0, 1, 2, 3, 4].map(|j| random(5 * k + j));
            let way = |a: f32, b: f32| {
                let (level, turn) = (2.0 * a - 1.0, std::f32::consts::TAU * b);
                let ring = (1.0 - level * level).max(0.0).sqrt();
                Vec3::new(ring * turn.cos(), ring * turn.sin(), level)
            };
            let mut far = spread * u[2].powf(1.0 / 3.0) * way(u[0], u[1]);
            if n > 1 {
                let axis = way(random(4096), random(4097));
                let wide = (1.0 + 5.0 * random(4098)) / 6.0;
                let thin = wide * (0.4 * far + 0.6 * far.dot(axis) * axis);
                far = thin.lerp(0.7 / squares.sqrt() * (shape * far), step(3.0, 3.6, squares));
                if k as f32 >= 0.5 + torn * (0.2 + 0.8 * random(4099)) * n as f32 {
                    continue;
                }
            }
            let p = c
                + to_eye.transform_vector3(far)
                + (2.0 * u[4] - 1.0) * settings.stretch as f32 * v;
            let normal = p / p.length();
            let m = v - v.dot(normal) * normal;
            let speed = m.length();
            let side = if normal.y.abs() < 0.9 { Vec3::Y } else { Vec3::X };
            let e1 = if speed > (1e-6 * s).max(1e-3 * v.length()) { m } else { side.cross(normal) };
            // For motion straight at the eye, e1 is a random direction.
            let e2 = (e1 / e1.length()).cross(normal);
            let e2 = if e2.length() > 1e-3 { e2 } else { side.cross(normal).cross(normal) };
            let e2 = e2 / e2.length();
            let mut e1 = normal.cross(e2);
            let many = if n > 1 { 0.6 * 0.513 * n as f32 } else { 1.0 };
            let [least, range] = SIZES.map(|size| size as f32);
            let g = if n > 1 { (least + range * u[3].powi(6)) / torn.sqrt() } else { 1.0 };
            let mist = n > 1 && k == 0;
            let h = g * settings.size as f32 * 0.656 * s / many.sqrt();
            let [taken, wide] = settings.mist.map(|v| v as f32);
            let (h, taken) = if mist { (wide * s, taken) } else { (h, settings.opacity as f32) };
            let pixel = -p.z * scale.abs().max_element();
            let (mut a, mut b) = (h + 0.5 * speed * settings.shutter as f32, h);
            if mist {
                let c = covariance(
                    &(Mat3::from_mat4(to_eye) * shape),
                    h,
                    0.5 * settings.shutter as f32 * m,
                );
                let plane =
                    [side.cross(normal).normalize(), normal.cross(side.cross(normal)).normalize()];
                let of = |i: usize, j: usize| plane[i].dot(c * plane[j]);
                let (xx, xy, yy) = (of(0, 0), of(0, 1), of(1, 1));
                let (middle, apart) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
                if apart > 1e-3 * middle {
                    // The longer column of C minus its smaller eigenvalue.
                    let least = middle - apart;
                    let (first, second) = (Vec2::new(xx - least, xy), Vec2::new(xy, yy - least));
                    let long = if xx > yy { first } else { second }.normalize();
                    e1 = plane[0] * long.x + plane[1] * long.y;
                }
                (a, b) = ((middle + apart).sqrt(), (middle - apart).max(0.0).sqrt());
            }
            let e2 = e1.cross(normal);
            let (a, b) = (a.max(0.7 * pixel), b.max(0.7 * pixel));
            let crowd = step(1.0, 6.0, particle.crowd as f32);
            let misty = if mist { torn * torn * torn * crowd } else { 1.0 };
            let amount = share * misty * -(1.0 - taken).ln() * h * h / (a * b);
            let back = to_eye.inverse();
            let centre = back.transform_point3(c);
            let drift = back.transform_vector3(v);
            let clumps = |at: Vec3, octaves: u32, pixel: f32| {
                if settings.clumps == 0.0 || n == 1 {
                    return 1.0;
                }
                let wide = 3.0 * s;
                let on = if drift == Vec3::ZERO { drift } else { drift / drift.length() };
                let far = back.transform_point3(at) - centre;
                let mut sum = 0.0_f32;
                for phase in settings.pattern.phases() {
                    let begun = centre / wide - drift * phase.carried as f32 / wide;
                    let block = 8.0 * ((begun / 8.0).floor() + 0.5);
                    let off = begun - block + far / wide;
                    let way = drift.length() * settings.stretch as f32;
                    let rim = 0.25 * (begun - block).abs().max_element();
                    let mut longer =
                        1.0 + (4.0 * way / wide).min(3.0) * (1.0 - step(0.8, 1.0, rim));
                    let mut finer = 1.0_f32;
                    for _ in 0..octaves {
                        let told = step(1.0, 2.0, wide / finer / pixel);
                        let height = settings.clumps as f32 * phase.part as f32 * told;
                        let round = off + off.dot(on) * (1.0 / longer - 1.0) * on;
                        let at = finer * (round + block + phase.began as f32);
                        let noise = noise(at.as_dvec3()) as f32;
                        sum += height * noise - 0.5 * 0.073 * height * height;
                        finer *= 2.03;
                        longer = 1.0 + 0.75 * (longer - 1.0);
                    }
                }
                sum.min(3.0).exp()
            };
            let density = if mist { 1.0 } else { clumps(p, 3, pixel) };
            let fade = ((density - random(12288 + k)) / 0.2 + 0.5).clamp(0.0, 1.0);
            let clumpy = settings.clumps > 0.0 && n > 1 && !mist;
            let amount = if clumpy { amount * density.max(1.0) * fade } else { amount };
            if -p.z <= (2.0 * (a + pixel)).max(near) {
                continue;
            }
            for (x, y) in (0..view.height).flat_map(|y| (0..view.width).map(move |x| (x, y))) {
                let w = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) * scale + first;
                let w = w.extend(-1.0);
                let t = normal.dot(p) / normal.dot(w);
                let at = w * t - p;
                let q = Vec2::new(at.dot(e1) / a, at.dot(e2) / b).length_squared();
                let hidden = f64::from(t) >= scene.at(x, y) && scene.at(x, y) > 0.0;
                if normal.dot(w).abs() < 1e-6 || t < near || q > 1.0 || hidden {
                    continue;
                }
                let radii = 1.5 * (0.656 * s) / pixel + 0.5;
                let water = body(water, (x, y), (radii as isize).clamp(1, 64)) as f32;
                let before = 1.0 - step(0.0, 1.5 * s, t - water);
                let pixel = t * scale.abs().max_element();
                let dense = if mist { clumps(w * t, 7, pixel) } else { 1.0 };
                let value = before * amount * dense * (1.0 - q).max(0.0).sqrt() * (-2.0 * q).exp();
                let pixel = sum.at_mut(x, y);
                *pixel = half::f16::from_f32(pixel.to_f32() + value);
            }
        }
        sum
    }

    #[test]
    fn single_precision_stays_in_the_bounds() {
        let full = view(DVec2::new(0.9, -1.2), DVec2::new(0.2, -0.1), 37, 26);
        let turned = Mat4::from_rotation_y(0.7) * Mat4::from_rotation_x(0.4);
        let scene =
            Image::from_fn(37, 26, |x, y| if (x / 9 + y / 5) % 2 == 0 { 7.0 } else { EMPTY });
        let water = Image::from_fn(37, 26, |x, _| if x < 12 { 5.0 } else { EMPTY });
        // Without clumps, and with them.
        let (mut sure, mut seen, mut widths) = (0, 0, [Vec::new(), Vec::new()]);
        for (eye, droplets, size, shutter) in [
            (2.0, 1, 2.0, 0.02),
            (50.0, 16, 4.0, 0.02),
            (0.0, 5, 0.5, 0.2),
            (1.0, 64, 8.0, 0.0),
            (2.0, 17, 4.0, 0.02),
        ] {
            let eye = Mat4::from_translation(eye * Vec3::new(1.0, -0.7, 0.3));
            let view = View { view: (turned * eye).as_dmat4(), ..full };
            let back = view.view.inverse();
            let spread = f64::from(0.7_f32) * f64::from(u8::from(droplets > 1));
            let stretch = f64::from(0.02_f32);
            let [opacity, size, shutter] = [0.9_f32, size, shutter].map(f64::from);
            let [all, none] = [0.6_f32, 0.85].map(f64::from);
            let densities = [all, none];
            let settings = Settings {
                droplets,
                size,
                spread,
                stretch,
                opacity,
                shutter,
                densities,
                clumps: f64::from(u8::from(droplets == 17)),
                ..settings()
            };
            let mut r = Random(u64::from(droplets));
            let mut random = |low: f32, high: f32| f64::from(r.between(low, high));
            for i in 0..80 {
                let d = random(0.1, 12.0);
                let at = DVec3::new(random(-1.0, 1.0) * d, random(-1.0, 1.0) * d, -d);
                let any =
                    20.0 * DVec3::new(random(-1.0, 1.0), random(-1.0, 1.0), random(-1.0, 1.0));
                // Any motion, none, hardly any, or straight at the eye.
                let v = [any, DVec3::ZERO, 1e-7 * any, at][i % 5 % 4];
                let held = |v: DVec3| v.as_vec3().as_dvec3();
                let about = DVec3::new(random(-1.0, 1.0), random(-1.0, 1.0), 0.3);
                let shape = match i % 3 {
                    0 => BALL,
                    1 => shaped([2.0, 2.0, 0.25], about, random(0.0, 3.0)),
                    _ => shaped([3.0, 0.6, 1.0 / 1.8], about, random(0.0, 3.0)),
                };
                let particle = Particle {
                    shape,
                    crowd: [CROWDED, random(0.0, 8.0)][i % 2],
                    position: held(back.transform_point3(at)),
                    velocity: held(back.transform_vector3(v)),
                    density: random(400.0, 900.0),
                    id: i as u32,
                };
                let twin = spray(&[particle], &view, &settings, &scene, &water);
                let single = single(&particle, &view, &settings, (&scene, &water));
                for (i, n) in twin.count.data.iter().enumerate() {
                    let (low, high) = (twin.bounds.low.data[i], twin.bounds.high.data[i]);
                    for value in [twin.depth.data[i], single.data[i].to_f64()] {
                        assert!(low <= value && value <= high, "{low} {value} {high}, {n} times");
                    }
                    seen += usize::from(single.data[i].to_f32() > 0.0);
                    if low > 0.0 {
                        sure += 1;
                        widths[usize::from(droplets == 17)]
                            .push((high - low) / (high + low) / f64::from(*n));
                    }
                }
            }
        }
        widths.iter_mut().for_each(|all| all.sort_by(f64::total_cmp));
        let [even, clumpy] = widths.map(|all| all[all.len() / 2]);
        assert!(sure > 4000 && seen < sure + sure / 10, "{sure} of {seen} pixels are sure");
        assert!(even < 2e-3 && clumpy < 2e-2, "{even} {clumpy}");
    }
}
