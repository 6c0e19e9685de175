//! Twin of the snapshot: whitewater particles of a single frame, without those of the frame before.
//!
//! Each fluid particle looks back along the water's path in 15 stages, and makes the particles that
//! the water made there and that still live.
//!
//! Bounds. The GPU sums fixed-point steps in single precision. The error of its position is
//! propagated along the path: a position error of e changes each weight by at most the kernel's
//! change over a distance of e. A mean changes by at most the sum of these changes, each times the
//! difference of its term from the mean, divided by the smallest possible sum of weights. A mean
//! also lies within the range of its terms, except for rounding. So each stage has a min and a max
//! rate, and because the count increases with the rate, the GPU's count lies between the counts of
//! both. Where the water may have ended the min is 0; the max is 0 as soon as there is certainly no
//! water within the position's error.

#[cfg(test)]
mod tests;

use super::motion::kernel;
use super::water::{Fluid, Grid, Near};
use super::{
    FOAM, Particle, Potentials, STEP, Settings, basis, hash, kind_of, potentials, seed_of_step,
    support, uniform_of, unit, wanted,
};
use glam::DVec3;
use std::f64::consts::PI;

/// Stages of a path.
pub const STAGES: usize = 15;
/// Max number of particles that a stage makes.
const MOST: u32 = 63;
/// Relative rounding error of a few consecutive operations.
const ROUNDING: f64 = 1e-6;
/// Relative rounding error of sums, as in the tests of the potentials.
const FLOAT: f64 = 4e-6;

/// Particles that a fluid particle makes from the water that it passed in an interval of the past.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// s, the time since then.
    pub seconds: f64,
    /// q, the position at that time, in scene units.
    pub place: DVec3,
    /// Error of the GPU's position.
    pub off: f64,
    /// Expected number of particles.
    pub make: f64,
    /// Number of particles.
    pub count: u32,
    /// Min and max number that the GPU may make.
    pub counts: [u32; 2],
}

/// A position with a larger error, in supports, is treated as unknown.
const FARTHEST: f64 = 2.0;
/// A mean of fixed-point steps is at most this many times its largest term.
const THRICE: f64 = 3.0;

/// A number and its bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Bounded {
    least: f64,
    is: f64,
    most: f64,
}

/// The water at a position.
struct Water {
    /// Whether there is water.
    is: bool,
    /// Whether there is certainly none.
    none: bool,
    /// Whether the GPU may find none.
    loose: bool,
    velocity: DVec3,
    /// Error of the velocity.
    velocity_off: f64,
    /// Particles made per second.
    rate: Bounded,
}

/// A fluid at a step, and the particles made from it.
pub struct Snapshot<'a> {
    fluid: &'a Fluid,
    settings: &'a Settings,
    seed: u32,
    grid: Grid,
    potentials: Vec<Option<Potentials>>,
    rates: Vec<Bounded>,
}

impl<'a> Snapshot<'a> {
    /// The snapshot of a fluid at a step.
    pub fn new(fluid: &'a Fluid, settings: &'a Settings, number: u32) -> Self {
        let parts = fluid.parts(settings.spacing);
        let fastest = parts.map(|part| part.velocity.length()).fold(0.0, f64::max);
        let potentials = potentials(fluid, settings);
        let rate = |p: &Option<Potentials>| {
            p.as_ref().map(|p| rate(p, settings, fastest)).unwrap_or_default()
        };
        Self {
            fluid,
            settings,
            seed: seed_of_step(settings, number),
            grid: Grid::new(fluid, settings.spacing),
            rates: potentials.iter().map(rate).collect(),
            potentials,
        }
    }

    /// Potentials of a fluid particle; None if it is invalid.
    pub fn potentials(&self, i: usize) -> Option<&Potentials> {
        self.potentials[i].as_ref()
    }

    /// Stages of a fluid particle's path; those after its end make none. None if the particle is
    /// invalid.
    pub fn stages(&self, i: usize) -> Option<[Stage; STAGES]> {
        let part = self.fluid.part(i, self.settings.spacing)?;
        let id = self.fluid.ids[i];
        let seconds = |k| seconds(k, uniform_of(self.seed, id, 0), self.settings);
        let mut place = part.position - seconds(0) * part.velocity;
        let mut off = ROUNDING * (part.position.length() + seconds(0) * part.velocity.length());
        // Whether the path has ended: in the twin, certainly, possibly.
        let (mut ended, mut surely, mut perhaps) = (false, false, false);
        let stages = std::array::from_fn(|k| {
            let water = self.water(place, off);
            ended |= !water.is;
            surely |= water.none;
            perhaps |= ended || water.loose;
            let rate = Bounded {
                least: if perhaps { 0.0 } else { water.rate.least },
                is: if ended { 0.0 } else { water.rate.is },
                most: if surely { 0.0 } else { water.rate.most },
            };
            let (s, next) = (seconds(k), seconds(k + 1));
            let make = |rate: f64, s: f64| {
                (rate * share(k, self.settings) * alive(s, self.settings)).min(f64::from(MOST))
            };
            let slack = ROUNDING * f64::from(self.settings.lifetime[1]);
            let chance = uniform_of(self.seed, id, 1 + k as u32);
            let stage = Stage {
                seconds: s,
                place,
                off,
                make: make(rate.is, s),
                count: count(make(rate.is, s), chance),
                counts: [
                    count(make(rate.least * (1.0 - ROUNDING), s + slack), chance),
                    count(make(rate.most * (1.0 + ROUNDING), s - slack), chance),
                ],
            };
            if !surely {
                place -= (next - s) * water.velocity;
                off += (next - s) * water.velocity_off
                    + ROUNDING * (place.length() + next * water.velocity.length());
            }
            stage
        });
        Some(stages)
    }

    /// Newborn m of fluid particle i, made from what was there `seconds` ago.
    pub fn newborn(&self, i: usize, m: u32, seconds: f64) -> Particle {
        let id = self.fluid.ids[i];
        let random = |n| uniform_of(self.seed, id, 4 * m + n);
        let [position, velocity] = [self.fluid.positions[i], self.fluid.velocities[i]]
            .map(|v| DVec3::from(v.map(f64::from)));
        let spacing = f64::from(self.settings.spacing);
        let (ahead, along) = match velocity {
            DVec3::ZERO => (DVec3::Y, 0.0),
            _ => (velocity.normalize(), spacing * random(33)),
        };
        let [x, y] = basis(ahead);
        let radius = 0.5 * spacing * random(32).sqrt();
        let turn = 2.0 * PI * (random(34) - 0.5);
        let off = -radius * (turn.cos() * x + turn.sin() * y);
        let kind = kind_of(1 + self.potentials[i].map_or(0, |p| p.neighbours));
        Particle {
            position: position + off + along * ahead,
            velocity: velocity + off,
            age: if kind == FOAM { self.foam_age(i, m, seconds) } else { 0.0 },
            kind,
            id: hash(self.seed, id, 35 + 4 * m) >> 1,
        }
    }

    /// The age of a newborn foam particle.
    pub fn foam_age(&self, i: usize, m: u32, seconds: f64) -> f64 {
        let [least, most] = self.settings.lifetime.map(f64::from);
        let shortest = seconds.max(least);
        let random = uniform_of(self.seed, self.fluid.ids[i], 35 + 4 * m);
        seconds / (shortest + (most - shortest) * random)
    }

    /// All particles, in the order of their slots.
    pub fn all(&self) -> Vec<Particle> {
        let mut all = Vec::new();
        for i in 0..self.fluid.ids.len() {
            let stages = self.stages(i).into_iter().flatten();
            let seconds = stages.flat_map(|stage| (0..stage.count).map(move |_| stage.seconds));
            all.extend(seconds.zip(0..).map(|(seconds, m)| self.newborn(i, m, seconds)));
        }
        all
    }

    /// The water at a position with this error in scene units.
    fn water(&self, place: DVec3, off: f64) -> Water {
        let support = support(self.settings.spacing);
        let unit = unit(self.settings);
        let known = off < FARTHEST * support;
        let off = if known { off / support + ROUNDING } else { 0.0 };
        let near = self.grid.within(place, 1.0 + off).collect::<Vec<_>>();
        let rate_of = |near: &Near| self.rates[near.part.index];
        let (mut weight, mut velocity, mut rate) = (0.0, DVec3::ZERO, 0.0);
        for near in near.iter().filter(|near| near.counts()) {
            let k = kernel(near.q);
            weight += k;
            velocity += k * near.part.velocity;
            rate += k * rate_of(near).is;
        }
        let is = weight > 0.0;
        if is {
            velocity /= weight;
            rate /= weight;
        }
        let mut least_weight = 0.0;
        // Error of the sums of weight times velocity and rate relative to their means: from
        // rounding alone, and in all.
        let (mut velocity_rounded, mut rate_rounded) = (0.0, 0.0);
        let (mut velocity_off, mut rate_below, mut rate_above) = (0.0, 0.0, 0.0);
        // Max difference from the mean, and max speed.
        let (mut apart, mut fastest, mut range) = (0.0_f64, 0.0_f64, [f64::INFINITY, 0.0]);
        for near in &near {
            let at = |q: f64| if q < 1.0 { kernel(q.max(0.0)) } else { 0.0 };
            let [low, k, high] = [near.q + off, near.q, near.q - off].map(at);
            let change = (high - k).max(k - low) + ROUNDING;
            let (own, own_velocity) = (rate_of(near), near.part.velocity);
            least_weight += low - ROUNDING - 0.5 * STEP;
            velocity_rounded += 0.5 * 3.0_f64.sqrt() * unit
                + 0.5 * STEP * velocity.length()
                + FLOAT * (k + change) * (own_velocity.length() + velocity.length());
            rate_rounded += 0.5 * rate_step(self.settings)
                + 0.5 * STEP * rate
                + FLOAT * (k + change) * (own.is + rate);
            velocity_off += change * (own_velocity - velocity).length();
            rate_below += change * (own.is - rate).abs() + (k + change) * (own.is - own.least);
            rate_above += change * (own.is - rate).abs() + (k + change) * (own.most - own.is);
            apart = apart.max((own_velocity - velocity).length());
            fastest = fastest.max(own_velocity.length());
            range = [range[0].min(own.least), range[1].max(own.most)];
        }
        let mut water = Water {
            is,
            none: known && near.is_empty(),
            loose: !known || least_weight <= 0.0,
            velocity,
            velocity_off: 0.0,
            rate: Bounded { is: rate, ..Bounded::default() },
        };
        if water.none {
            return water;
        }
        if !known {
            water.velocity_off = f64::INFINITY;
            water.rate.most = THRICE * self.rates.iter().map(|rate| rate.most).fold(0.0, f64::max);
            return water;
        }
        // A term in fixed-point steps is at most twice its value, and a weight at least two thirds
        // of its value, or 0.
        water.velocity_off = velocity.length() + 3.0_f64.sqrt() * THRICE * fastest;
        water.rate.most = THRICE * range[1];
        if least_weight > 0.0 {
            // A mean lies within the range of its terms.
            let speed_off = velocity_off.min(apart * least_weight) + velocity_rounded;
            water.velocity_off = water.velocity_off.min(speed_off / least_weight);
            let rounded = rate_rounded / least_weight;
            let [least, most] = range;
            water.rate.least = (rate - rate_below / least_weight).max(least).min(rate) - rounded;
            water.rate.least = water.rate.least.max(0.0);
            let above = (rate + rate_above / least_weight).min(most).max(rate) + rounded;
            water.rate.most = water.rate.most.min(above);
        }
        // At such speeds a term may be a step although its weight is 0, and soon saturates.
        if fastest > 0.5 * unit / STEP {
            water.velocity_off = f64::INFINITY;
        }
        water
    }
}

/// Upper bound of the GPU's fixed-point step for sums of rates: the weights' step times the max
/// rate.
fn rate_step(settings: &Settings) -> f64 {
    STEP * f64::from(settings.trapped_air_rate + settings.wave_crest_rate)
}

/// Particles that a fluid particle makes per second. No particle is faster than `fastest`.
fn rate(p: &Potentials, settings: &Settings, fastest: f64) -> Bounded {
    let sum_off = |x: f64, limits: [f32; 2]| FLOAT * (1.0 + x + f64::from(limits[0]).abs());
    // A particle that may or may not be a neighbour has at most the weight near the support's edge.
    let edge = if p.loose { 1e-4 * fastest * f64::from(1 + p.neighbours) } else { 0.0 };
    let air = 0.5 * f64::from(p.neighbours) * unit(settings)
        + sum_off(p.trapped_air, settings.trapped_air)
        + edge;
    let crest = 0.5 * f64::from(p.crest_terms) * STEP
        + p.crest_off
        + sum_off(p.wave_crest, settings.wave_crest)
        + if p.loose { f64::INFINITY } else { 0.0 };
    let energy = sum_off(p.energy, settings.energy);
    let at = |side: f64| {
        let all = Potentials {
            trapped_air: (p.trapped_air + side * air).max(0.0),
            wave_crest: (p.wave_crest + side * crest).max(0.0),
            energy: (p.energy + side * energy).max(0.0),
            ..*p
        };
        wanted(&all, settings, 1.0)
    };
    let is = wanted(p, settings, 1.0);
    // A particle at rest has no crest, whatever the surface's curvature.
    Bounded { least: at(-1.0).min(is), is, most: at(1.0).max(is) }
}

/// s of stage k, by the particle's random number.
fn seconds(k: usize, random: f64, settings: &Settings) -> f64 {
    f64::from(settings.lifetime[1]) * ((k as f64 + random) / STAGES as f64).powi(2)
}

/// Seconds that stage k stands for.
fn share(k: usize, settings: &Settings) -> f64 {
    f64::from(settings.lifetime[1]) * (2 * k + 1) as f64 / (STAGES * STAGES) as f64
}

/// Fraction of particles that live for at least this time.
fn alive(seconds: f64, settings: &Settings) -> f64 {
    let [least, most] = settings.lifetime.map(f64::from);
    if seconds < least { 1.0 } else { ((most - seconds) / (most - least)).clamp(0.0, 1.0) }
}

/// The fractional part is the probability of one more.
fn count(make: f64, chance: f64) -> u32 {
    let more = if chance < make.fract() { 1 } else { 0 };
    (make as u32 + more).min(MOST)
}
