//! Twin of whitewater foam in screen space: spray, foam and bubbles as spheres that are discs in
//! the picture; the frontmost of them and their thickness, their mutual occlusion, their light, and
//! the picture.
//!
//! Lengths are in scene units, `d` is the positive eye depth, and C_x and C_y are the world size of
//! a pixel at depth 1. A sphere of radius r at depth d_c is an ellipse with half-axes of
//! `R = r / (d_c C)` pixels around the projected centre; the true outline of a sphere off the axis
//! is different. Sprites that would fall between pixels are widened to R', and their thickness is
//! spread over the pixels that they cover.
//!
//! [`foam`] is the definition, and [`foam_bounds`] gives its bounds for single precision and
//! fixed-point sums. A number is [`Rounded`](crate::support::rounded::Rounded), a vector has the
//! length of its error, and roundings of errors are neglected. u is half an ulp; operations are as
//! accurate as Vulkan requires.

mod blur;
mod bounds;
mod irradiance;
mod layers;
mod loose;
mod occlusion;
mod picture;
#[cfg(test)]
mod single;
mod sprite;
#[cfg(test)]
mod tests;

use super::{EMPTY, smoothstep};
use glam::DVec3;

pub use blur::blur;
pub use bounds::{Bounds, Candidate, foam_bounds};
pub use irradiance::{irradiance, irradiance_of};
pub use layers::{Foam, Seen, foam};
pub use occlusion::{
    Layers, Occlusion, Omega, Reach, halton, occlusion, pairs, points, shared_occlusion,
};
pub use picture::{composite_hdr, composite_source, intensity, zeta_final};

/// Sums of thickness are multiples of this.
pub const STEP: f64 = 1.0 / 65536.0;
/// Min half-axis of a sprite in pixels: such a disc contains a pixel centre wherever it lies.
const LEAST: f64 = 0.75;
/// Half-axes, in pixels, between which the thickness changes from a uniform distribution to the
/// kind's shape.
const TOLD: (f64, f64) = (1.0, 2.0);

/// Kind of a particle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Foam on the surface.
    Foam,
    /// A drop in the air.
    Spray,
    /// A bubble under water.
    Bubble,
}

impl Kind {
    /// The kind of a number: everything except spray and bubbles is foam.
    pub fn of(code: u32) -> Self {
        match code {
            1 => Self::Spray,
            2 => Self::Bubble,
            _ => Self::Foam,
        }
    }

    /// The source's [`Look::shape`].
    pub fn shape(self, x: f64) -> f64 {
        Look::default().shape(self, x)
    }

    /// Mean of the shape over the disc.
    pub fn mean(self) -> f64 {
        Look::default().mean(self)
    }

    /// Index of the kind.
    fn index(self) -> usize {
        match self {
            Self::Foam => 0,
            Self::Spray => 1,
            Self::Bubble => 2,
        }
    }
}

/// Appearance of the particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Exponents of the [`falloff`] of foam, spray and bubbles, by which the thickness decreases
    /// from the middle or, for a bubble, increases.
    pub shapes: [[f64; 2]; 3],
    /// Exponents of the falloff with age.
    pub life: [f64; 2],
    /// Number of sizes.
    pub sizes: u32,
    /// Radius of a bubble relative to other particles.
    pub bubble: f64,
}

impl Default for Look {
    /// The source's values.
    fn default() -> Self {
        let shapes = [[2.25, 1.0], [1.5, 1.0], [2.0, 1.0]];
        Self { shapes, life: [2.0, 0.4], sizes: 5, bubble: 0.5 }
    }
}

impl Look {
    /// Thickness of a kind at a distance from the middle, 0 to 1 radii.
    pub fn shape(&self, kind: Kind, x: f64) -> f64 {
        let [n, m] = self.shapes[kind.index()];
        let f = falloff(x, 1.0, n, m);
        if kind == Kind::Bubble { 1.0 - f } else { f }
    }

    /// M, the mean of the shape over the disc: for `x^n` it is `2 / (n + 2)`. Otherwise by rings of
    /// equal areas.
    pub fn mean(&self, kind: Kind) -> f64 {
        let [n, m] = self.shapes[kind.index()];
        let falls = match m {
            1.0 => 1.0 - 2.0 / (n + 2.0),
            _ => {
                let rings = (0..20_000).map(|i| ((f64::from(i) + 0.5) / 20_000.0).sqrt());
                rings.map(|x| falloff(x, 1.0, n, m)).sum::<f64>() / 20_000.0
            }
        };
        if kind == Kind::Bubble { 1.0 - falls } else { falls }
    }
}

/// A whitewater particle in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Position of its centre.
    pub position: DVec3,
    /// Kind.
    pub kind: Kind,
    /// Its own radius, if it has one.
    pub radius: Option<f64>,
    /// l, the fraction of its life that has passed; from 1 on it is not drawn.
    pub age: f64,
    /// Id, which selects its size.
    pub id: u32,
}

/// Treatment of foam behind the fluid's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attenuation {
    /// The foam is summed separately, so that the water attenuates it.
    Water,
    /// Reduced by its distance behind the surface: `falloff(x, max, n, m)`.
    Falloff {
        /// Distance from which on nothing is left.
        max: f64,
        /// Inner exponent.
        n: f64,
        /// Outer exponent.
        m: f64,
    },
}

/// Settings of the foam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Radius of a particle without its own.
    pub radius: f64,
    /// Rest spacing of the fluid's particles.
    pub spacing: f64,
    /// Treatment of foam behind the fluid's surface.
    pub attenuation: Attenuation,
    /// Appearance of the particles.
    pub look: Look,
}

impl Settings {
    /// The defaults for a spacing.
    pub fn new(spacing: f64) -> Self {
        let look = Look::default();
        Self { radius: 0.15 * spacing, spacing, attenuation: Attenuation::Water, look }
    }

    /// Fractions of a fragment for the three sums: above the fluid's surface, below it, and below
    /// it weighted by the distance.
    fn shares(&self, depth: f64, fluid: f64) -> [f64; 3] {
        let behind = depth - fluid;
        match self.attenuation {
            _ if !has_fluid(fluid) => [1.0, 0.0, 0.0],
            Attenuation::Water => {
                let below = smoothstep(0.0, 1.0, behind / self.spacing);
                let y = behind.max(0.0);
                [1.0 - below, below, below * y / (y + self.spacing)]
            }
            Attenuation::Falloff { max, n, m } => [falloff(behind, max, n, m), 0.0, 0.0],
        }
    }
}

impl Particle {
    /// r, the radius of the sphere, if it is drawn. Sizes depend on the id.
    fn drawn_radius(&self, settings: &Settings) -> Option<f64> {
        let alive = self.age.is_finite() && self.age < 1.0;
        let whole = self.radius.unwrap_or(settings.radius);
        let part = if self.kind == Kind::Bubble { settings.look.bubble } else { 1.0 };
        let r = part * whole / f64::from(self.id % settings.look.sizes + 1);
        (alive && self.position.is_finite() && r.is_finite() && r > 0.0).then_some(r)
    }

    /// Fraction of the thickness left at its age.
    fn lifetime(&self, look: &Look) -> f64 {
        let [n, m] = look.life;
        falloff(self.age, 1.0, n, m)
    }
}

/// `(1 - (x/b)^n)^m` from 0 to b, 1 below 0, 0 beyond b.
pub fn falloff(x: f64, b: f64, n: f64, m: f64) -> f64 {
    match x {
        x if x < 0.0 => 1.0,
        x if x <= b => (1.0 - (x / b).powf(n)).powf(m),
        _ => 0.0,
    }
}

/// Whether a depth belongs to a surface of the fluid.
fn has_fluid(depth: f64) -> bool {
    depth < EMPTY
}
