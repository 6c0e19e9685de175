//! Twin of the foam sprites: each foam particle is an ellipse in its own plane through its centre,
//! elongated along its velocity.
//!
//! With `w = (s_x, s_y, -1)` the pixel's ray, n the plane's normal and c the centre, `k w` with
//! `k = n.c / n.w` is the visible point of the plane at the depth k, and (x, y) is its position in
//! the ellipse, in half-axes. [`depth`] contains the smallest k of all foam, [`thickness`] the sum
//! of `A sqrt(1 - rho^2) exp(-2 rho^2)`, modulated by each particle's own noise.
//!
//! [`depth_bounds`] and [`thickness_bounds`] are the bounds for single precision. u is half an ulp,
//! and an operation errs as much as Vulkan permits. A number is [`Rounded`], a vector has the
//! length of its error. Roundings of errors are neglected.

mod bounds;
mod ellipse;
mod lace;
mod layers;
mod loose;
mod noise;
mod off;
mod pattern;
#[cfg(test)]
mod single;
#[cfg(test)]
mod tests;
mod texels;

use super::smoothstep;
use crate::support::tolerance::U;
use glam::DVec3;

pub use bounds::{depth_bounds, thickness_bounds};
pub use lace::{covered, ends, pore};
pub use layers::{depth, seen, thickness};
pub use loose::LooseEllipse;
pub use noise::{noise, noise_reach, noise_rounding, noise_slope, origin};
pub use off::{Off, ray_off};
pub use pattern::{Pattern, Phase, VARIANCE, WRAP};
pub use texels::{pixels, scene_depth};

/// Drawn radius of a whole particle, in spacings.
const RADIUS: f64 = 0.656;
/// Half-axis of a sprite at rest, in radii.
const AXIS: f64 = 2.0;
/// Below this speed, in spacings per second, there is no direction of motion.
const STILL: f64 = 1e-6;
/// Sine below which two directions do not span a plane.
const PARALLEL: f64 = 1e-3;
/// Cosines of velocity and view between which the stretch vanishes.
const HEAD_ON: (f64, f64) = (0.9, 1.0);
/// A ray with |n.w| below this does not meet the plane.
const EDGE_ON: f64 = 1e-6;
/// Min |n_z| by which the amplitude is divided.
const LEAST_FACING: f64 = 0.2;
/// Noise cells per half-axis.
const CELLS: f64 = 1.6;
/// Min half-axis of a thickness sprite in texels, along both axes.
const LEAST_AXIS: f64 = 1.5;
/// Texels per cell between which the noise appears.
pub const TOLD_APART: (f64, f64) = (1.0, 2.0);
/// The particles' noises begin within this many cells.
const SPREAD: f64 = 64.0;

/// Half-axes of the depth's sprite relative to the thickness': eight times the foam, at most 1.
fn depth_part(foam: f64) -> f64 {
    (8.0 * foam).min(1.0)
}

/// A foam particle in eye space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sprite {
    /// Centre in world units; z is negative in front of the camera.
    pub center: DVec3,
    /// Amount of foam; at 0 none is drawn, more than 1 counts as 1.
    pub foam: f64,
    /// Velocity in world units per second.
    pub velocity: DVec3,
    /// Seconds since it was first seen.
    pub age: f64,
    /// Id, which selects its noise.
    pub id: u32,
    /// Fraction of sunlight at its centre, min and max.
    pub sun: [f64; 2],
}

/// Settings of the foam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Rest spacing of the particles in world units.
    pub spacing: f64,
    /// Speed from which on a sprite is twice as long as wide, in spacings per second.
    pub motion_threshold: f64,
    /// Depth of the front layer behind the frontmost foam, in world units.
    pub front_depth: f64,
    /// g, strength of the noise; 0 means none.
    pub noise: f64,
    /// Noise cells that pass per second.
    pub noise_rate: f64,
    /// Replaces that noise, if there is one.
    pub pattern: Option<Pattern>,
    /// A contribution is rounded to multiples of this, a power of two in world units; 0: not
    /// rounded.
    pub step: f64,
}

impl Settings {
    /// The defaults for a spacing in world units.
    pub fn new(spacing: f64) -> Self {
        let (front_depth, noise) = (7.0 * spacing, 0.9);
        Self {
            spacing,
            motion_threshold: 21.0,
            front_depth,
            noise,
            noise_rate: 2.0,
            pattern: None,
            step: 0.0,
        }
    }

    /// Contribution rounded to a step: down for a negative sign, up for a positive one. The
    /// quotient is rounded by u, and so is the sum with the random number.
    fn in_steps(&self, addend: f64, sign: f64) -> f64 {
        if self.step == 0.0 {
            return addend;
        }
        let steps = addend / self.step;
        let steps = steps * (1.0 + sign * 2.0 * U);
        let whole = if sign > 0.0 { (steps + 2.0 * U).ceil() } else { steps.floor() };
        (whole * self.step).max(0.0)
    }

    /// Fraction of foam this far behind the frontmost that counts to the front layer.
    fn within(&self, behind: f64) -> f64 {
        1.0 - smoothstep(self.front_depth, self.front_depth + self.spacing, behind)
    }

    /// Weight of the distance behind the frontmost foam, 0 to 1: `d / (d + s)`, with d reduced by a
    /// spacing s.
    fn far(&self, behind: f64) -> f64 {
        let past = (behind - self.spacing).max(0.0);
        past / (past + self.spacing)
    }

    /// Fraction of a sprite that is drawn this far before the scene: it fades out within half a
    /// spacing.
    fn sunk(&self, before: f64) -> f64 {
        (before / (0.5 * self.spacing)).clamp(0.0, 1.0)
    }

    /// r, the drawn radius of a whole particle in world units.
    fn radius(&self) -> f64 {
        RADIUS * self.spacing
    }
}

impl Sprite {
    /// f, which is in (0, 1], if the sprite may be drawn.
    fn part(&self) -> Option<f64> {
        let finite = self.center.is_finite() && self.velocity.is_finite();
        (finite && self.foam > 0.0).then_some(self.foam.min(1.0))
    }

    /// f, if the sprite may be drawn and its centre lies beyond a depth.
    fn part_beyond(&self, near: f64) -> Option<f64> {
        self.part().filter(|_| -self.center.z > near)
    }

    /// Position in the noise at (x, y) of its ellipse.
    fn place(&self, x: f64, y: f64, settings: &Settings) -> DVec3 {
        let own = origin(self.id);
        let p = DVec3::new(CELLS * x, CELLS * y, self.age * settings.noise_rate);
        p + own
    }
}
