//! Twin of the snapshot: whitewater particles of a single frame, without those of the previous frame.
//!
//! Each fluid particle looks back along the water's way in 15 stages, and makes what the water
//! made there and still lives.
//!
//! Bounds. The GPU sums whole steps in single precision. How far its place may be from the one
//! here is carried along the path: a place that is off by e changes each weight by no more than
//! the kernel does over a distance of e, and with it a mean by no more than the sum of these
//! changes, each times how far its term is from the mean, over the least weight there may be.
//! Besides a mean is among its terms, but for rounding. So each stage has a least and a most number
//! to make, and as the count never falls while that grows, the GPU's lies between the counts of
//! the two. Where the water may have ended the least is none; after that the most is, once there
//! is no water as far around as the place may be off.

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
/// A stage makes no more than this.
const MOST: u32 = 63;
/// What single precision leaves of a few operations in a row, relative.
const ROUNDING: f64 = 1e-6;
/// What it leaves of sums, as in the tests of the potentials.
const FLOAT: f64 = 4e-6;

/// What a fluid particle makes of the water it passed in a part of the time behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// s, how long ago that was.
    pub seconds: f64,
    /// q, where it was then, metres.
    pub place: DVec3,
    /// How far the GPU's place may be from that.
    pub off: f64,
    /// How many are to be made.
    pub make: f64,
    /// How many are made.
    pub count: u32,
    /// The least and the most that the GPU may make.
    pub counts: [u32; 2],
}

/// Of a place that may be off by more than so many supports nothing is known.
const FARTHEST: f64 = 2.0;
/// A mean of whole steps is no more than so many times the most it is of.
const THRICE: f64 = 3.0;

/// A number and what it may be at least and at most.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Bounded {
    least: f64,
    is: f64,
    most: f64,
}

/// The water at a place.
struct Water {
    /// Whether there is any.
    is: bool,
    /// Whether there is surely none.
    none: bool,
    /// Whether the GPU may find none.
    loose: bool,
    velocity: DVec3,
    /// How far it may be off.
    velocity_off: f64,
    /// Made a second.
    rate: Bounded,
}

/// A fluid at a step, and what is made of it.
pub struct Snapshot<'a> {
    fluid: &'a Fluid,
    settings: &'a Settings,
    seed: u32,
    grid: Grid,
    potentials: Vec<Option<Potentials>>,
    rates: Vec<Bounded>,
}

impl<'a> Snapshot<'a> {
    /// That of a fluid at a step.
    pub fn new(fluid: &'a Fluid, settings: &'a Settings, number: u32) -> Self {
        let parts = fluid.parts(settings.spacing);
        let fastest = parts.map(|part| part.velocity.length()).fold(0.0, f64::max);
        let potentials = potentials(fluid, settings.spacing);
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

    /// Those of a fluid particle; none if it takes no part.
    pub fn potentials(&self, i: usize) -> Option<&Potentials> {
        self.potentials[i].as_ref()
    }

    /// The stages of a fluid particle's path; those after its end make none. None if it takes no
    /// part.
    pub fn stages(&self, i: usize) -> Option<[Stage; STAGES]> {
        let part = self.fluid.part(i, self.settings.spacing)?;
        let id = self.fluid.ids[i];
        let seconds = |k| seconds(k, uniform_of(self.seed, id, 0), self.settings);
        let mut place = part.position - seconds(0) * part.velocity;
        let mut off = ROUNDING * (part.position.length() + seconds(0) * part.velocity.length());
        // Whether it ended, here, surely and perhaps.
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

    /// Newborn m of fluid particle i, which is made of what was this many seconds ago.
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

    /// Its age if it is foam.
    pub fn foam_age(&self, i: usize, m: u32, seconds: f64) -> f64 {
        let [least, most] = self.settings.lifetime.map(f64::from);
        let shortest = seconds.max(least);
        let random = uniform_of(self.seed, self.fluid.ids[i], 35 + 4 * m);
        seconds / (shortest + (most - shortest) * random)
    }

    /// All that are made, in the order of their slots.
    pub fn all(&self) -> Vec<Particle> {
        let mut all = Vec::new();
        for i in 0..self.fluid.ids.len() {
            let stages = self.stages(i).into_iter().flatten();
            let seconds = stages.flat_map(|stage| (0..stage.count).map(move |_| stage.seconds));
            all.extend(seconds.zip(0..).map(|(seconds, m)| self.newborn(i, m, seconds)));
        }
        all
    }

    /// The water at a place that may be off by so many metres.
    fn water(&self, place: DVec3, off: f64) -> Water {
        let support = support(self.settings.spacing);
        let unit = unit(self.settings.spacing);
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
        // What may be added to the sums of weight times velocity and rate beyond their means: by
        // rounding, and with it by all else.
        let (mut velocity_rounded, mut rate_rounded) = (0.0, 0.0);
        let (mut velocity_off, mut rate_below, mut rate_above) = (0.0, 0.0, 0.0);
        // The most that one differs.
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
        // A term of whole steps is no more than twice itself, and a weight no less than two
        // thirds, or none.
        water.velocity_off = velocity.length() + 3.0_f64.sqrt() * THRICE * fastest;
        water.rate.most = THRICE * range[1];
        if least_weight > 0.0 {
            // A mean is among what it is the mean of.
            let speed_off = velocity_off.min(apart * least_weight) + velocity_rounded;
            water.velocity_off = water.velocity_off.min(speed_off / least_weight);
            let rounded = rate_rounded / least_weight;
            let [least, most] = range;
            water.rate.least = (rate - rate_below / least_weight).max(least).min(rate) - rounded;
            water.rate.least = water.rate.least.max(0.0);
            let above = (rate + rate_above / least_weight).min(most).max(rate) + rounded;
            water.rate.most = water.rate.most.min(above);
        }
        // So fast a term may be a step where the weight is none, and soon saturates.
        if fastest > 0.5 * unit / STEP {
            water.velocity_off = f64::INFINITY;
        }
        water
    }
}

/// No longer than these are the steps that sums of rates are of on the GPU: those of weights, of
/// the most there is.
fn rate_step(settings: &Settings) -> f64 {
    STEP * f64::from(settings.trapped_air_rate + settings.wave_crest_rate)
}

/// How many a fluid particle makes a second. None is faster than `fastest`.
fn rate(p: &Potentials, settings: &Settings, fastest: f64) -> Bounded {
    let sum_off = |x: f64, limits: [f32; 2]| FLOAT * (1.0 + x + f64::from(limits[0]).abs());
    // One that may be a neighbour weighs no more than the edge does.
    let edge = if p.loose { 1e-4 * fastest * f64::from(1 + p.neighbours) } else { 0.0 };
    let air = 0.5 * f64::from(p.neighbours) * unit(settings.spacing)
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
    // What does not move has no crest, however it bends.
    Bounded { least: at(-1.0).min(is), is, most: at(1.0).max(is) }
}

/// s of stage k, by the particle's random number.
fn seconds(k: usize, random: f64, settings: &Settings) -> f64 {
    f64::from(settings.lifetime[1]) * ((k as f64 + random) / STAGES as f64).powi(2)
}

/// For how many seconds stage k stands.
fn share(k: usize, settings: &Settings) -> f64 {
    f64::from(settings.lifetime[1]) * (2 * k + 1) as f64 / (STAGES * STAGES) as f64
}

/// What part lives so many seconds and more.
fn alive(seconds: f64, settings: &Settings) -> f64 {
    let [least, most] = settings.lifetime.map(f64::from);
    if seconds < least { 1.0 } else { ((most - seconds) / (most - least)).clamp(0.0, 1.0) }
}

/// What is left of a whole number is the chance of one more.
fn count(make: f64, chance: f64) -> u32 {
    let more = if chance < make.fract() { 1 } else { 0 };
    (make as u32 + more).min(MOST)
}
