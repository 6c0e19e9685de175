//! Twin of the foam sprites: each particle of foam is an ellipse in a plane of its own through its
//! centre, drawn out along its velocity.
//!
//! With `w = (s_x, s_y, -1)` the pixel's ray, n the plane's normal and c the centre, `k w` with
//! `k = n.c / n.w` is the point of the plane that is seen, at the depth k; (x, y) is its place in
//! the ellipse, in half-axes. [`depth`] holds the least k where foam is, [`thickness`] the sum of
//! `A sqrt(1 - rho^2) exp(-2 rho^2)`, torn by a noise that is each particle's own.
//!
//! [`depth_bounds`] and [`thickness_bounds`] say between what single precision must lie. u is half
//! an ulp; what an operation may add is what Vulkan allows. A number is [`Rounded`], of a vector
//! the length of the error is kept. Roundings of an error are left out.

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
pub use lace::{covered, ends};
pub use layers::{depth, seen, thickness};
pub use loose::LooseEllipse;
pub use noise::{noise, noise_reach, noise_rounding, noise_slope, origin};
pub use off::{Off, ray_off};
pub use pattern::Pattern;
pub use texels::{pixels, scene_depth};

/// Drawn radius of a whole particle over the spacing.
const RADIUS: f64 = 0.656;
/// Half-axis of a sprite at rest, in radii.
const AXIS: f64 = 2.0;
/// Slower than this, in spacings a second, there is no direction of motion.
const STILL: f64 = 1e-6;
/// The sine below which two directions span no plane.
const PARALLEL: f64 = 1e-3;
/// Between these cosines of velocity and view the stretch ends.
const HEAD_ON: (f64, f64) = (0.9, 1.0);
/// A ray with |n.w| below this does not meet the plane.
const EDGE_ON: f64 = 1e-6;
/// The least |n_z| that the amplitude is divided by.
const LEAST_FACING: f64 = 0.2;
/// Cells of the noise to a half-axis.
const CELLS: f64 = 1.6;
/// Least half-axis of what makes the thickness, in texels of both.
const LEAST_AXIS: f64 = 1.5;
/// Texels of a cell between which its noise comes.
const TOLD_APART: (f64, f64) = (1.0, 2.0);
/// The noise of the particles begins within this many cells.
const SPREAD: f64 = 64.0;

/// The part of the thickness' half-axes that the depth's have: eight times the foam, at most all.
fn depth_part(foam: f64) -> f64 {
    (8.0 * foam).min(1.0)
}

/// A particle of foam, in eye space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sprite {
    /// Its centre, world units; z is negative before the camera.
    pub center: DVec3,
    /// How much of it is foam; none is drawn at 0, more than 1 counts as 1.
    pub foam: f64,
    /// Its velocity, world units a second.
    pub velocity: DVec3,
    /// Seconds since it was first seen.
    pub age: f64,
    /// What it is known by: the noise goes by it.
    pub id: u32,
    /// Share of the sun's light in its middle, at least and at most.
    pub sun: [f64; 2],
}

/// What foam is drawn by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Rest spacing of the particles, world units.
    pub spacing: f64,
    /// From this speed on, spacings a second, a sprite is twice as long as wide.
    pub motion_threshold: f64,
    /// Foam this far behind the nearest is before the water still, world units.
    pub front_depth: f64,
    /// g, how much the noise tears a sprite; 0 is not at all.
    pub noise: f64,
    /// Cells of the noise that pass in a second.
    pub noise_rate: f64,
    /// In the place of that noise.
    pub pattern: Option<Pattern>,
    /// What a sprite adds is rounded to multiples of this, world units; 0: it is not. A power of two.
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

    /// What an addend may be rounded to, at least or at most by the sign: down or up to a whole step next to
    /// it. The quotient is rounded by u, and the sum with the chance.
    fn in_steps(&self, addend: f64, sign: f64) -> f64 {
        if self.step == 0.0 {
            return addend;
        }
        let steps = addend / self.step;
        let steps = steps * (1.0 + sign * 2.0 * U);
        let whole = if sign > 0.0 { (steps + 2.0 * U).ceil() } else { steps.floor() };
        (whole * self.step).max(0.0)
    }

    /// How much of what lies so far behind the nearest foam counts to the front layer.
    fn within(&self, behind: f64) -> f64 {
        1.0 - smoothstep(self.front_depth, self.front_depth + self.spacing, behind)
    }

    /// How far what lies so far behind the nearest foam is, 0 to 1: `d / (d + s)`, d less a spacing s.
    fn far(&self, behind: f64) -> f64 {
        let past = (behind - self.spacing).max(0.0);
        past / (past + self.spacing)
    }

    /// How much of a sprite there still is so far before the scene: it sinks into it within half a
    /// spacing.
    fn sunk(&self, before: f64) -> f64 {
        (before / (0.5 * self.spacing)).clamp(0.0, 1.0)
    }

    /// r, the drawn radius of a whole particle, world units.
    fn radius(&self) -> f64 {
        RADIUS * self.spacing
    }
}

impl Sprite {
    /// f, which is in (0, 1], if it may be drawn at all.
    fn part(&self) -> Option<f64> {
        let finite = self.center.is_finite() && self.velocity.is_finite();
        (finite && self.foam > 0.0).then_some(self.foam.min(1.0))
    }

    /// The same if it lies beyond a depth.
    fn part_beyond(&self, near: f64) -> Option<f64> {
        self.part().filter(|_| -self.center.z > near)
    }

    /// Where its noise is looked up at (x, y) of its ellipse.
    fn place(&self, x: f64, y: f64, settings: &Settings) -> DVec3 {
        let own = origin(self.id);
        let p = DVec3::new(CELLS * x, CELLS * y, self.age * settings.noise_rate);
        p + own
    }
}
