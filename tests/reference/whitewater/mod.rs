//! Twin of the screen-space foam: spray, foam and bubbles as spheres that are discs in the picture,
//! the nearest of them and how much there is, what they hide from each other, the light they get,
//! and the picture.
//!
//! Lengths are scene units, `d` is the positive eye depth, C_x and C_y the world size of a pixel
//! at depth 1. A sphere of radius r about a centre at depth d_c is an ellipse of `R = r / (d_c C)`
//! pixels about the centre's place in the picture: the true outline of a sphere off the axis is
//! another one. Sprites that fall between pixels are widened to R', their thickness is spread over
//! what they meet.
//!
//! [`foam`] is the definition; [`foam_bounds`] says between what single precision and sums of
//! whole steps must lie. A number is [`Rounded`](crate::support::rounded::Rounded), a vector has
//! the length of its error; roundings of an error are left out. u is half an ulp, operations are
//! as exact as Vulkan asks for.

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

/// Sums of thickness are whole multiples of this.
pub const STEP: f64 = 1.0 / 65536.0;
/// Least half-axis of a sprite, in pixels: such a disc holds a pixel's centre wherever it lies.
const LEAST: f64 = 0.75;
/// Half-axes, in pixels, between which the thickness goes from an even share to the kind's shape.
const TOLD: (f64, f64) = (1.0, 2.0);

/// What a particle is.
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
    /// The kind of a number: what is neither spray nor bubble is foam.
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

    /// Its mean.
    pub fn mean(self) -> f64 {
        Look::default().mean(self)
    }

    /// Which of a few it is.
    fn index(self) -> usize {
        match self {
            Self::Foam => 0,
            Self::Spray => 1,
            Self::Bubble => 2,
        }
    }
}

/// What particles are like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Of foam, spray, bubbles the powers of the [`falloff`] by which the thickness falls or, of a bubble, grows.
    pub shapes: [[f64; 2]; 3],
    /// Those of the lifetime.
    pub life: [f64; 2],
    /// How many sizes there are.
    pub sizes: u32,
    /// Radius of a bubble in that of another particle.
    pub bubble: f64,
}

impl Default for Look {
    /// The source's.
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

    /// M, the mean of that over the disc: of `x^n` it is `2 / (n + 2)`. Else by rings of equal areas.
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

/// A whitewater particle, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Its centre.
    pub position: DVec3,
    /// What it is.
    pub kind: Kind,
    /// Its radius, if the data has one.
    pub radius: Option<f64>,
    /// l, the part of its life that is over; from 1 on it is not drawn.
    pub age: f64,
    /// What it is known by: the size goes by it.
    pub id: u32,
}

/// What becomes of foam behind the fluid's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attenuation {
    /// It is summed apart, for the water to attenuate it.
    Water,
    /// It is less by how far behind it lies: `falloff(x, max, n, m)`.
    Falloff {
        /// From here on there is none left.
        max: f64,
        /// Inner power.
        n: f64,
        /// Outer power.
        m: f64,
    },
}

/// What foam is drawn by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Radius of a particle without one.
    pub radius: f64,
    /// Rest spacing of the fluid's particles.
    pub spacing: f64,
    /// What becomes of foam behind the fluid's surface.
    pub attenuation: Attenuation,
    /// What particles are like.
    pub look: Look,
}

impl Settings {
    /// The defaults for a spacing.
    pub fn new(spacing: f64) -> Self {
        let look = Look::default();
        Self { radius: 0.15 * spacing, spacing, attenuation: Attenuation::Water, look }
    }

    /// What share of a fragment at a depth goes to the sums above the fluid's surface, below it,
    /// and below it by how far.
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
    /// r, the radius of its sphere, if it is drawn at all. Sizes differ by the id.
    fn drawn_radius(&self, settings: &Settings) -> Option<f64> {
        let alive = self.age.is_finite() && self.age < 1.0;
        let whole = self.radius.unwrap_or(settings.radius);
        let part = if self.kind == Kind::Bubble { settings.look.bubble } else { 1.0 };
        let r = part * whole / f64::from(self.id % settings.look.sizes + 1);
        (alive && self.position.is_finite() && r.is_finite() && r > 0.0).then_some(r)
    }

    /// How much of it there is left by its age.
    fn lifetime(&self, look: &Look) -> f64 {
        let [n, m] = look.life;
        falloff(self.age, 1.0, n, m)
    }
}

/// `(1 - (x/b)^n)^m` from 0 to b, 1 before, 0 beyond.
pub fn falloff(x: f64, b: f64, n: f64, m: f64) -> f64 {
    match x {
        x if x < 0.0 => 1.0,
        x if x <= b => (1.0 - (x / b).powf(n)).powf(m),
        _ => 0.0,
    }
}

/// Whether a depth means a surface of fluid.
fn has_fluid(depth: f64) -> bool {
    depth < EMPTY
}
