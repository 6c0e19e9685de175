//! Twin of the whitewater particles: spray, foam and bubbles emitted by a particle fluid, after "Unified spray, foam
//! and air bubbles for particle-based fluids" (Ihmsen et al. 2012).
//!
//! Metres and seconds, ids and random numbers as on the GPU. h = 2 s is the support of all sums,
//! with s the fluid's spacing; `W = 1 - d/h`. The GPU sums whole steps, [`unit`] or [`STEP`], so
//! that the order is no matter; here sums are of `f64`, and beside them stands what bounds the
//! difference: how many terms there were, how far they may be off, and whether rounding may decide
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

/// Code of foam, which lies on the surface.
pub const FOAM: u32 = 0;
/// Code of spray, drops in the air.
pub const SPRAY: u32 = 1;
/// Code of bubbles, which are under water.
pub const BUBBLE: u32 = 2;
/// What sums of weights are whole multiples of on the GPU.
pub const STEP: f64 = 1.0 / 65536.0;
/// At most so many steps of [`unit`] are summed of a neighbour.
const MOST_STEPS: f64 = 131_072.0;
/// A particle makes no more than this in a step.
const MOST: u32 = 64;

/// What particles are made and moved by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// s, the rest spacing of the fluid's particles, metres.
    pub spacing: f32,
    /// g, metres a second squared.
    pub gravity: [f32; 3],
    /// Limits, low and high, of the trapped air, metres a second.
    pub trapped_air: [f32; 2],
    /// Those of the wave crest, which has no unit.
    pub wave_crest: [f32; 2],
    /// Those of the kinetic energy of a unit mass, metres squared a second squared.
    pub energy: [f32; 2],
    /// Particles a second that the most trapped air makes.
    pub trapped_air_rate: f32,
    /// Particles a second that the highest crest makes.
    pub wave_crest_rate: f32,
    /// Shortest and longest life of foam, seconds.
    pub lifetime: [f32; 2],
    /// Rise of bubbles, in gravities.
    pub buoyancy: f32,
    /// The share of the water's velocity that bubbles take on in a step.
    pub drag: f32,
    /// Seeds all random numbers.
    pub seed: u32,
    /// Low and high corner of the box that particles live in, metres.
    pub bounds: Option<[[f32; 3]; 2]>,
}

/// A whitewater particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Where it is, metres.
    pub position: DVec3,
    /// Its velocity, metres a second.
    pub velocity: DVec3,
    /// The part of its life that is over; from 1 on it is gone.
    pub age: f64,
    /// [`FOAM`], [`SPRAY`] or [`BUBBLE`].
    pub kind: u32,
    /// What its life goes by.
    pub id: u32,
}

/// U, what sums of speeds are whole multiples of on the GPU, metres a second.
pub fn unit(spacing: f32) -> f64 {
    (9.81 * f64::from(spacing)).sqrt() / 256.0
}

/// h, the support of the sums, metres.
fn support(spacing: f32) -> f64 {
    2.0 * f64::from(spacing)
}

/// What becomes of a particle among so many of the fluid.
fn kind_of(neighbours: u32) -> u32 {
    match neighbours {
        0..6 => SPRAY,
        6..=20 => FOAM,
        _ => BUBBLE,
    }
}

/// The hash of a seed, a particle and a counter.
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

/// How far a potential is on the way from the low limit to the high one. Where both are the same
/// it jumps, and is 0 at them.
fn phi(potential: f64, limits: [f32; 2]) -> f64 {
    let [low, high] = limits.map(f64::from);
    let part = (potential - low) / (high - low);
    if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) }
}

/// How many particles a fluid particle is to make in a step of dt seconds.
pub fn wanted(p: &Potentials, settings: &Settings, dt: f32) -> f64 {
    let trapped_air = phi(p.trapped_air, settings.trapped_air);
    let wave_crest = phi(p.wave_crest, settings.wave_crest);
    let rate = f64::from(settings.trapped_air_rate) * trapped_air
        + f64::from(settings.wave_crest_rate) * wave_crest;
    phi(p.energy, settings.energy) * rate * f64::from(dt)
}

/// How many it makes: what is left of a whole number is the chance of one more.
pub fn count(wanted: f64, settings: &Settings, id: u32, number: u32) -> u32 {
    let whole = wanted.floor();
    let chance = uniform_of(seed_of_step(settings, number), id, 0);
    let more = if chance < wanted - whole { 1.0 } else { 0.0 };
    // The cast saturates, and makes 0 of what is not a number.
    ((whole + more) as u32).min(MOST)
}

/// Newborn k of fluid particle i, which has these potentials: somewhere in the cylinder that a disc
/// of half a spacing across its motion sweeps in the step.
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
        // The offset is added as published: a metre is a metre a second.
        velocity: velocity + aside,
        age: 0.0,
        kind: kind_of(p.neighbours + 1),
        id: hash(seed, id, 4 * k + 4) >> 1,
    }
}

/// Two unit vectors across a third, z, so that all are right-handed: "Building an orthonormal
/// basis, revisited" (Duff et al. 2017). Those of +z for the zero vector.
fn basis(z: DVec3) -> [DVec3; 2] {
    let sign = if z.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    let e1 = DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
    let e2 = DVec3::new(b, sign + z.y * z.y * a, -z.y);
    [e1, e2]
}
