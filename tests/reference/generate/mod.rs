//! Twin of the whitewater particles: spray, foam and bubbles emitted by a particle fluid, after
//! "Unified spray, foam and air bubbles for particle-based fluids" (Ihmsen et al. 2012).
//!
//! Units are scene units and seconds; ids and random numbers are those of the GPU. h = 2 s is the
//! support of all sums, with s the fluid's spacing, and `W = 1 - d/h`. The GPU sums fixed-point
//! steps, [`unit`] or [`STEP`], so that the order does not matter. Here sums are in `f64`, together
//! with what bounds the difference: number of terms, their errors, and whether rounding may decide
//! something ("loose").

mod motion;
mod potentials;
mod slots;
pub mod snapshot;
#[cfg(test)]
mod tests;
mod water;

use super::classify::pcg;
use glam::DVec3;
use std::f64::consts::TAU;

pub use motion::{carried, moved};
pub use potentials::{Potentials, potentials};
pub use slots::Slots;
pub use water::Fluid;

/// Code of foam on the surface.
pub const FOAM: u32 = 0;
/// Code of spray, drops in the air.
pub const SPRAY: u32 = 1;
/// Code of bubbles under water.
pub const BUBBLE: u32 = 2;
/// Sums of weights are multiples of this on the GPU.
pub const STEP: f64 = 1.0 / 65536.0;
/// Max number of steps of [`unit`] that a neighbour contributes.
const MOST_STEPS: f64 = 131_072.0;
/// Max number of particles that one particle makes in a step.
const MOST: u32 = 64;

/// Settings of the generator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// s, the rest spacing of the fluid's particles in scene units.
    pub spacing: f32,
    /// g, in scene units per second squared.
    pub gravity: [f32; 3],
    /// Lower and upper limit of the trapped air, in scene units per second.
    pub trapped_air: [f32; 2],
    /// Limits of the wave crest, which has no unit.
    pub wave_crest: [f32; 2],
    /// Limits of the kinetic energy per mass, in scene units squared per second squared.
    pub energy: [f32; 2],
    /// Particles per second at the upper limit of the trapped air.
    pub trapped_air_rate: f32,
    /// Particles per second at the upper limit of the wave crest.
    pub wave_crest_rate: f32,
    /// Min and max lifetime of foam in seconds.
    pub lifetime: [f32; 2],
    /// Buoyancy of bubbles, in units of gravity.
    pub buoyancy: f32,
    /// Fraction of the difference to the water's velocity that bubbles take on in a step.
    pub drag: f32,
    /// Seed of all random numbers.
    pub seed: u32,
    /// Lower and upper corner of the box in which particles live, in scene units.
    pub bounds: Option<[[f32; 3]; 2]>,
}

/// A whitewater particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Position in scene units.
    pub position: DVec3,
    /// Velocity in scene units per second.
    pub velocity: DVec3,
    /// Fraction of its life that has passed; from 1 on it is dead.
    pub age: f64,
    /// [`FOAM`], [`SPRAY`] or [`BUBBLE`].
    pub kind: u32,
    /// Id, which selects its lifetime.
    pub id: u32,
}

/// U: sums of speeds are multiples of this on the GPU; in scene units per second. It goes by |g| s;
/// without gravity |g| is taken as 9.81.
pub fn unit(settings: &Settings) -> f64 {
    let gravity = DVec3::from(settings.gravity.map(f64::from));
    let pull = if gravity == DVec3::ZERO { 9.81 } else { gravity.length() };
    (pull * f64::from(settings.spacing)).sqrt() / 256.0
}

/// h, the support of the sums in scene units.
fn support(spacing: f32) -> f64 {
    2.0 * f64::from(spacing)
}

/// Kind of a particle with this number of fluid particles around it.
fn kind_of(neighbours: u32) -> u32 {
    match neighbours {
        0..6 => SPRAY,
        6..=20 => FOAM,
        _ => BUBBLE,
    }
}

/// Hash of a seed, a particle and a counter.
fn hash(seed: u32, id: u32, counter: u32) -> u32 {
    pcg(id.wrapping_add(pcg(counter.wrapping_add(pcg(seed)))))
}

/// Uniform in [0, 1): 24 bits of the hash, exact in single precision.
fn uniform_of(seed: u32, id: u32, counter: u32) -> f64 {
    f64::from(hash(seed, id, counter) >> 8) / 16_777_216.0
}

/// S, the seed of a step's random numbers.
fn seed_of_step(settings: &Settings, number: u32) -> u32 {
    pcg(settings.seed.wrapping_add(pcg(number)))
}

/// Position of a potential between its lower and upper limit, clamped to 0..1. If both limits are
/// equal it is a step, and 0 at the limit.
fn phi(potential: f64, limits: [f32; 2]) -> f64 {
    let [low, high] = limits.map(f64::from);
    let part = (potential - low) / (high - low);
    if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) }
}

/// Expected number of particles that a fluid particle makes in a step of dt seconds.
pub fn wanted(p: &Potentials, settings: &Settings, dt: f32) -> f64 {
    let trapped_air = phi(p.trapped_air, settings.trapped_air);
    let wave_crest = phi(p.wave_crest, settings.wave_crest);
    let rate = f64::from(settings.trapped_air_rate) * trapped_air
        + f64::from(settings.wave_crest_rate) * wave_crest;
    phi(p.energy, settings.energy) * rate * f64::from(dt)
}

/// Number of particles that it makes: the fractional part is the probability of one more.
pub fn count(wanted: f64, settings: &Settings, id: u32, number: u32) -> u32 {
    let whole = wanted.floor();
    let chance = uniform_of(seed_of_step(settings, number), id, 0);
    let more = if chance < wanted - whole { 1.0 } else { 0.0 };
    // The cast saturates, and NaN becomes 0.
    ((whole + more) as u32).min(MOST)
}

/// Newborn k of fluid particle i with these potentials: at a random point of the cylinder that a
/// disc with a radius of half a spacing, across its motion, sweeps in the step.
pub fn newborn(
    fluid: &Fluid,
    i: usize,
    p: &Potentials,
    k: u32,
    settings: &Settings,
    dt: f32,
    number: u32,
) -> Particle {
    let (seed, id) = (seed_of_step(settings, number), fluid.ids[i]);
    let random = |n| uniform_of(seed, id, 4 * k + n);
    let position = DVec3::from(fluid.positions[i].map(f64::from));
    let velocity = DVec3::from(fluid.velocities[i].map(f64::from));
    let axis = velocity.normalize_or_zero();
    let [e1, e2] = basis(axis);
    let radius = 0.5 * f64::from(settings.spacing) * random(1).sqrt();
    let along = random(2) * velocity.length() * f64::from(dt);
    let turn = TAU * random(3);
    let aside = radius * (turn.cos() * e1 + turn.sin() * e2);
    Particle {
        position: position + aside + along * axis,
        // The offset is added to the velocity as published, a scene unit as one per second.
        velocity: velocity + aside,
        age: 0.0,
        kind: kind_of(p.neighbours + 1),
        id: hash(seed, id, 4 * k + 4) >> 1,
    }
}

/// Two unit vectors across a third, z, right-handed: "Building an orthonormal basis, revisited"
/// (Duff et al. 2017). For the zero vector those of +z.
fn basis(z: DVec3) -> [DVec3; 2] {
    let sign = if z.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    let e1 = DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
    let e2 = DVec3::new(b, sign + z.y * z.y * a, -z.y);
    [e1, e2]
}
