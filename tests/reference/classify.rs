//! Twin of the foam phases (Bagar 2010, thesis, Sec. 3.2, "Foam formation"): a particle turns to
//! foam and back by its Weber number, each time after a random delay.
//!
//! Unlike the other twins this one computes in `f32`, with each operation rounded in the order
//! written, so that the phases are the GPU's bit for bit.

use std::collections::HashMap;

/// An id that stands for no particle; no state is kept for it.
pub const NO_ID: u32 = 0xffff_ffff;

/// Settings of the phases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Seed of the random times.
    pub seed: u32,
    /// The Weber number at a density and a speed of 1.
    pub scale: f32,
    /// From this Weber number on water turns to foam.
    pub threshold: f32,
    /// Mean time in which foam turns back to water.
    pub foam_lifetime: f32,
    /// Density of a particle whose own is 0, negative or NaN.
    pub rest_density: f32,
    /// Velocity of the air.
    pub air: [f32; 3],
}

impl Settings {
    /// The defaults with this scale and threshold.
    pub fn new(scale: f32, threshold: f32) -> Self {
        let (foam_lifetime, rest_density) = (1.0, 1000.0);
        Self { seed: 0, scale, threshold, foam_lifetime, rest_density, air: [0.0; 3] }
    }

    /// Density of a particle, or the rest density.
    fn density(&self, own: f32) -> f32 {
        if own > 0.0 { own } else { self.rest_density }
    }
}

/// A particle in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Id, the same in all steps.
    pub id: u32,
    /// Velocity.
    pub velocity: [f32; 3],
    /// Density.
    pub density: f32,
}

/// The phase of a particle between water and foam.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Entirely water.
    #[default]
    Water,
    /// Turning to foam.
    WaterToFoam,
    /// Entirely foam.
    Foam,
    /// Turning back to water.
    FoamToWater,
}

/// State of an id; for a new one everything is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Entry {
    /// The phase at the beginning of the next step.
    pub phase: Phase,
    /// Number of transitions that have used a random number.
    pub transitions: u32,
    /// Time left until the transition ends; unused in the phases water and foam.
    pub timer: f32,
    /// Duration of the whole transition.
    pub lifetime: f32,
    /// Time since the id was first seen.
    pub age: f32,
}

/// Result of a step for a particle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Out {
    /// Amount of foam, from 0 to 1.
    pub foam: f32,
    /// Time since its id was first seen.
    pub age: f32,
    /// Phase after the step.
    pub phase: Phase,
}

/// State of all ids of the last step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Phases {
    /// State of each id after the step.
    pub map: HashMap<u32, Entry>,
    /// Number of ids whose phase changed.
    pub changed: u32,
    /// Number of ids that used a random number because they left water or foam.
    pub drawn: u32,
}

impl Phases {
    /// State of an id, if it was in the last step.
    pub fn entry(&self, id: u32) -> Option<&Entry> {
        self.map.get(&id)
    }

    /// Steps the particles and returns their results in the same order. Ids without a particle are
    /// forgotten. An id other than [`NO_ID`] must not occur twice.
    pub fn step(&mut self, settings: &Settings, dt: f32, particles: &[Particle]) -> Vec<Out> {
        let before = std::mem::take(self);
        let mut outs = Vec::with_capacity(particles.len());
        for particle in particles {
            if particle.id == NO_ID {
                outs.push(Out::default());
                continue;
            }
            let mut entry = match before.map.get(&particle.id) {
                Some(old) => Entry { age: old.age + dt, ..*old },
                None => Entry::default(),
            };
            let (phase, transitions) = (entry.phase, entry.transitions);
            let foam = entry.step(settings, dt, particle);
            self.changed += u32::from(entry.phase != phase);
            self.drawn += u32::from(entry.transitions != transitions);
            outs.push(Out { foam, age: entry.age, phase: entry.phase });
            let twin = self.map.insert(particle.id, entry);
            assert!(twin.is_none(), "id {} comes twice in a step", particle.id);
        }
        outs
    }
}

impl Entry {
    /// At most one transition, from the phase at the beginning. Returns the amount of foam.
    fn step(&mut self, settings: &Settings, dt: f32, particle: &Particle) -> f32 {
        // False if the Weber number is NaN.
        let density = settings.density(particle.density);
        let foams = weber(settings, particle.velocity, density) >= settings.threshold;
        match self.phase {
            Phase::Water => {
                if foams {
                    let lifetime = 0.25 + 0.25 * self.random(settings, particle.id);
                    self.draw(Phase::WaterToFoam, lifetime);
                }
                0.0
            }
            Phase::WaterToFoam => {
                self.timer -= dt;
                if self.timer <= 0.0 {
                    self.phase = Phase::Foam;
                    1.0
                } else {
                    1.0 - self.timer / self.lifetime
                }
            }
            Phase::Foam => {
                if !foams {
                    let random = self.random(settings, particle.id);
                    self.draw(Phase::FoamToWater, settings.foam_lifetime * (0.5 + random));
                }
                1.0
            }
            Phase::FoamToWater => {
                self.timer -= dt;
                if self.timer <= 0.0 {
                    self.phase = Phase::Water;
                    0.0
                } else {
                    self.timer / self.lifetime
                }
            }
        }
    }

    /// The random number of the next transition.
    fn random(&self, settings: &Settings, id: u32) -> f32 {
        random(settings.seed, self.transitions, id)
    }

    /// Begins a transition of this duration.
    fn draw(&mut self, phase: Phase, lifetime: f32) {
        self.phase = phase;
        self.lifetime = lifetime;
        self.timer = lifetime;
        self.transitions = self.transitions.wrapping_add(1);
    }
}

/// Weber number relative to the air: density times squared speed times the scale.
pub fn weber(settings: &Settings, velocity: [f32; 3], density: f32) -> f32 {
    let [x, y, z] = [0, 1, 2].map(|axis| velocity[axis] - settings.air[axis]);
    let v2 = (x * x + y * y) + z * z;
    (density * v2) * settings.scale
}

/// Amount of foam of a particle without an id: a half where the Weber number is at the threshold.
/// NaN gives none.
pub fn stateless(settings: &Settings, velocity: [f32; 3], density: f32) -> f32 {
    let foam = weber(settings, velocity, settings.density(density)) / settings.threshold - 0.5;
    if foam.is_nan() { 0.0 } else { foam.clamp(0.0, 1.0) }
}

/// The PCG hash.
pub fn pcg(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A random number in 0..1 from the seed, the number of transitions so far and the id.
pub fn random(seed: u32, transitions: u32, id: u32) -> f32 {
    let hash = pcg(id.wrapping_add(pcg(transitions.wrapping_add(pcg(seed)))));
    // 24 bits are exact.
    (hash >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2^24: random numbers are multiples of its inverse.
    const UNIT: f64 = 16_777_216.0;

    /// With these settings, the Weber number of [`particle`] is its density.
    fn settings() -> Settings {
        Settings { seed: 42, rest_density: 0.0, ..Settings::new(1.0, 10.0) }
    }

    fn particle(id: u32, weber: f32) -> Particle {
        Particle { id, velocity: [0.0, 1.0, 0.0], density: weber }
    }

    /// Steps a single particle.
    fn one(phases: &mut Phases, dt: f32, id: u32, weber: f32) -> Out {
        phases.step(&settings(), dt, &[particle(id, weber)])[0]
    }

    fn entry(phases: &Phases, id: u32) -> Entry {
        *phases.entry(id).expect("the id was in the last step")
    }

    #[test]
    fn the_hash_is_pcg() {
        // For 0 the state is the increment 0xac564b05, whose top four bits are 10, so it is shifted
        // by 14.
        assert_eq!(0xac56_4b05_u32 >> 14, 0x0002_b159);
        assert_eq!(0x0002_b159 ^ 0xac56_4b05_u32, 0xac54_fa5c);
        assert_eq!(pcg(0), 129_708_002);
        assert_eq!([1, 2, u32::MAX].map(pcg), [0xa8be_ea3c, 0x7a7e_cc88, 0xe62a_4902]);
    }

    #[test]
    fn random_numbers_have_24_bits_of_the_hash() {
        for (seed, transitions, id, bits) in [
            (0, 0, 0, 0x007f_ddb4),
            (0, 0, 7, 0x0034_b077),
            (0, 1, 7, 0x0035_e38d),
            (42, 0, 7, 7_461_844),
            (42, 1, 7, 11_415_383),
        ] {
            assert_eq!(f64::from(random(seed, transitions, id)) * UNIT, f64::from(bits));
        }
        assert!((0..10_000).map(|id| random(1, 2, id)).all(|u| (0.0..1.0).contains(&u)));
        let mean = (0..10_000).map(|id| f64::from(random(3, 0, id))).sum::<f64>() / 1e4;
        assert!((mean - 0.5).abs() < 0.015, "{mean} is five deviations off");
    }

    #[test]
    fn the_weber_number_is_against_the_air() {
        let still = Settings::new(0.5, 1.0);
        assert_eq!(weber(&still, [1.0, 2.0, 3.0], 4.0), 28.0);
        let windy = Settings { air: [1.0, 0.0, 5.0], ..still };
        assert_eq!(weber(&windy, [1.0, 2.0, 3.0], 4.0), 16.0);
    }

    #[test]
    fn the_weber_number_is_rounded_in_order() {
        let unit = Settings::new(1.0, 1.0);
        // 1 + 2^-24 ties to the even 1, twice; the sum of both small squares first would not.
        let small = 1.0 / 4096.0;
        assert_eq!(weber(&unit, [1.0, small, small], 1.0), 1.0);
        assert_eq!(weber(&unit, [small, small, 1.0], 1.0), 1.0 + f32::EPSILON);
        // (1 + 2^-12)^2 = 1 + 2^-11 + 2^-24 ties to 1 + 2^-11. With another 2^-24 added before the
        // product is rounded, the result would be 1 + 2^-11 + 2^-23.
        let big = 1.0 + small;
        for velocity in [[big, small, 0.0], [small, big, 0.0], [small, 0.0, big]] {
            assert_eq!(weber(&unit, velocity, 1.0), 1.0 + 2.0 * small);
        }
        // The density is multiplied before the scale, so this overflows.
        let tiny = Settings::new(1e-30, 1.0);
        assert_eq!(weber(&tiny, [1e10, 0.0, 0.0], 1e20), f32::INFINITY);
    }

    #[test]
    fn a_particle_goes_round() {
        let mut phases = Phases::default();
        let dt = 0.125;

        // Below the threshold the particle stays water.
        let out = one(&mut phases, dt, 7, 9.999);
        assert_eq!(out, Out { foam: 0.0, age: 0.0, phase: Phase::Water });
        assert_eq!((entry(&phases, 7), phases.changed), (Entry::default(), 0));

        // At the threshold the particle begins to turn to foam, in a time of 0.25 + 0.25 * 7461844
        // / 2^24 = 0.361190140...
        let out = one(&mut phases, dt, 7, 10.0);
        assert_eq!(out, Out { foam: 0.0, age: 0.125, phase: Phase::WaterToFoam });
        let lifetime = 0.361_190_14_f32;
        assert_eq!(f64::from(lifetime) * UNIT, 4_194_304.0 + 7_461_844.0 / 4.0);
        let way = Entry {
            phase: Phase::WaterToFoam,
            transitions: 1,
            timer: lifetime,
            lifetime,
            age: 0.125,
        };
        assert_eq!((entry(&phases, 7), phases.changed, phases.drawn), (way, 1, 1));

        // A lower speed does not stop the transition.
        for left in [0.236_190_14, 0.111_190_14] {
            let out = one(&mut phases, dt, 7, 0.0);
            assert_eq!(out.phase, Phase::WaterToFoam);
            assert_eq!(entry(&phases, 7).timer, left);
            assert_eq!(out.foam, 1.0 - left / lifetime);
            assert_eq!((phases.changed, phases.drawn), (0, 0));
        }
        let out = one(&mut phases, dt, 7, 0.0);
        assert_eq!(out, Out { foam: 1.0, age: 0.5, phase: Phase::Foam });
        assert_eq!((phases.changed, phases.drawn), (1, 0));
        assert_eq!(entry(&phases, 7).timer, -0.013_809_86);

        // At the threshold foam stays foam.
        let out = one(&mut phases, dt, 7, 10.0);
        assert_eq!(out, Out { foam: 1.0, age: 0.625, phase: Phase::Foam });
        assert_eq!(phases.changed, 0);

        // It turns back in a time of 0.5 + 11415383 / 2^24 = 1.180409848..., which ties to even.
        let out = one(&mut phases, dt, 7, 9.999);
        assert_eq!(out, Out { foam: 1.0, age: 0.75, phase: Phase::FoamToWater });
        let lifetime = 1.180_409_9_f32;
        assert_eq!(f64::from(lifetime) * UNIT, 8_388_608.0 + 11_415_383.0 + 1.0);
        let way = Entry {
            phase: Phase::FoamToWater,
            transitions: 2,
            timer: lifetime,
            lifetime,
            age: 0.75,
        };
        assert_eq!((entry(&phases, 7), phases.changed, phases.drawn), (way, 1, 1));

        // A higher speed does not stop the transition: 9 steps are 1.125.
        for step in 1..=9_u8 {
            let out = one(&mut phases, dt, 7, 99.0);
            let left = lifetime - f32::from(step) * dt;
            assert_eq!((out.phase, out.foam), (Phase::FoamToWater, left / lifetime));
        }
        let out = one(&mut phases, dt, 7, 99.0);
        assert_eq!(out, Out { foam: 0.0, age: 2.0, phase: Phase::Water });
        assert_eq!((phases.changed, phases.drawn), (1, 0));

        // Once more, with the third random number.
        let out = one(&mut phases, dt, 7, 99.0);
        assert_eq!((out.foam, out.phase), (0.0, Phase::WaterToFoam));
        assert_eq!(entry(&phases, 7).lifetime, 0.25 + 0.25 * random(42, 2, 7));
        assert_eq!(entry(&phases, 7).transitions, 3);
    }

    #[test]
    fn timers_are_rounded_at_each_step() {
        // 22 steps of 1/60 to foam, 71 back, and the remaining time to the bit.
        let mut phases = Phases::default();
        let dt = 1.0 / 60.0;
        assert_eq!(one(&mut phases, dt, 7, 10.0).phase, Phase::WaterToFoam);
        for (weber, on_the_way, there, steps, first, last) in [
            (0.0, Phase::WaterToFoam, Phase::Foam, 22, 0x3eb0_6561_u32, -0.005_476_599_6),
            (10.0, Phase::FoamToWater, Phase::Water, 71, 0x3f94_f58a, -0.002_922_987_6),
        ] {
            for step in 1..=steps {
                let phase = one(&mut phases, dt, 7, weber).phase;
                assert_eq!(phase, if step < steps { on_the_way } else { there });
                if step == 1 {
                    assert_eq!(entry(&phases, 7).timer.to_bits(), first);
                }
            }
            assert_eq!(entry(&phases, 7).timer, last);
            one(&mut phases, dt, 7, if there == Phase::Foam { 0.0 } else { 10.0 });
        }
        assert_eq!(entry(&phases, 7).transitions, 3);
    }

    #[test]
    fn a_timer_of_zero_is_over() {
        let mut phases = Phases::default();
        let way =
            Entry { phase: Phase::WaterToFoam, timer: 0.25, lifetime: 0.5, ..Entry::default() };
        phases.map.insert(1, way);
        phases.map.insert(2, Entry { phase: Phase::FoamToWater, ..way });
        let both = [particle(1, 0.0), particle(2, 99.0)];
        let foam =
            |outs: Vec<Out>| outs.iter().map(|out| (out.foam, out.phase)).collect::<Vec<_>>();
        let outs = phases.step(&settings(), 0.125, &both);
        assert_eq!(foam(outs), [(0.75, Phase::WaterToFoam), (0.25, Phase::FoamToWater)]);
        let outs = phases.step(&settings(), 0.0, &both);
        assert_eq!(foam(outs), [(0.75, Phase::WaterToFoam), (0.25, Phase::FoamToWater)]);
        let outs = phases.step(&settings(), 0.125, &both);
        assert_eq!(foam(outs), [(1.0, Phase::Foam), (0.0, Phase::Water)]);
        assert_eq!((phases.changed, phases.drawn), (2, 0));
        let outs = phases.step(&settings(), 0.125, &both);
        assert_eq!(foam(outs), [(1.0, Phase::FoamToWater), (0.0, Phase::WaterToFoam)]);
        assert_eq!((phases.changed, phases.drawn), (2, 2));
    }

    #[test]
    fn foam_lasts_by_its_lifetime() {
        let mut phases = Phases::default();
        let foam = Entry { phase: Phase::Foam, transitions: 1, ..Entry::default() };
        phases.map.insert(7, foam);
        let long = Settings { foam_lifetime: 2.0, ..settings() };
        phases.step(&long, 0.125, &[particle(7, 0.0)]);
        assert_eq!(entry(&phases, 7).lifetime, 2.360_819_8);

        // With a lifetime of 0 foam ends in the next step, even in one of 0 s.
        phases.map.insert(7, foam);
        let none = Settings { foam_lifetime: 0.0, ..settings() };
        assert_eq!(phases.step(&none, 0.125, &[particle(7, 0.0)])[0].foam, 1.0);
        assert_eq!(phases.step(&none, 0.0, &[particle(7, 0.0)])[0].foam, 0.0);
        assert_eq!(entry(&phases, 7).phase, Phase::Water);
    }

    #[test]
    fn what_is_not_a_number_is_slow() {
        let mut phases = Phases::default();
        phases.map.insert(1, Entry { phase: Phase::Foam, ..Entry::default() });
        let nan = |id| Particle { id, velocity: [f32::NAN, 1.0, 1.0], density: 1e9 };
        let outs = phases.step(&settings(), 0.1, &[nan(1), nan(2), particle(3, f32::INFINITY)]);
        assert_eq!(
            outs.iter().map(|out| out.phase).collect::<Vec<_>>(),
            [Phase::FoamToWater, Phase::Water, Phase::WaterToFoam]
        );
        assert_eq!(stateless(&settings(), [f32::NAN, 1.0, 1.0], 1.0), 0.0);
    }

    #[test]
    fn an_id_that_is_missing_is_forgotten() {
        let mut phases = Phases::default();
        phases.step(&settings(), 0.1, &[particle(1, 99.0), particle(2, 99.0)]);
        phases.step(&settings(), 0.1, &[particle(2, 99.0)]);
        assert_eq!((phases.entry(1), phases.map.len()), (None, 1));
        let outs = phases.step(&settings(), 0.1, &[particle(1, 0.0), particle(2, 0.0)]);
        assert_eq!(outs[0], Out::default());
        assert_eq!((outs[1].age, entry(&phases, 2).transitions), (0.2, 1));
        phases.step(&settings(), 0.1, &[]);
        assert_eq!(phases, Phases::default());
    }

    #[test]
    fn the_last_id_has_no_state() {
        let mut phases = Phases::default();
        for _ in 0..5 {
            let particles = [particle(NO_ID, 99.0), particle(NO_ID, 99.0), particle(0, 99.0)];
            let outs = phases.step(&settings(), 1.0, &particles);
            assert_eq!(outs[..2], [Out::default(); 2]);
            assert_eq!((phases.entry(NO_ID), phases.map.len()), (None, 1));
        }
        assert_eq!(entry(&phases, 0).age, 4.0);
    }

    #[test]
    #[should_panic(expected = "id 3 comes twice")]
    fn an_id_must_not_come_twice() {
        let twice = [particle(3, 0.0), particle(4, 0.0), particle(3, 0.0)];
        Phases::default().step(&settings(), 0.1, &twice);
    }

    #[test]
    fn the_order_does_not_matter() {
        let (mut forwards, mut backwards) = (Phases::default(), Phases::default());
        let mut drawn = 0;
        for step in 0..200 {
            // The Weber number changes every 10 steps, and an eighth of the particles comes and
            // goes.
            let mut particles: Vec<_> = (0..64)
                .filter(|id| id % 8 != 0 || step / 50 % 2 == 0)
                .map(|id| particle(id, 20.0 * random(9, step / 10, id)))
                .collect();
            let outs = forwards.step(&settings(), 0.02, &particles);
            particles.reverse();
            let mut reversed = backwards.step(&settings(), 0.02, &particles);
            reversed.reverse();
            assert_eq!(outs, reversed);
            assert_eq!(forwards, backwards);
            assert!(outs.iter().all(|out| (0.0..=1.0).contains(&out.foam)));
            drawn += forwards.drawn;
        }
        assert!(drawn > 64, "only {drawn} transitions");
    }

    #[test]
    fn without_ids_foam_rises_about_the_threshold() {
        let foam = |weber| stateless(&settings(), [0.0, 1.0, 0.0], weber);
        assert_eq!([0.0, 5.0, 7.5, 10.0, 15.0, 99.0].map(foam), [0.0, 0.0, 0.25, 0.5, 1.0, 1.0]);
        assert_eq!([-10.0, f32::INFINITY, f32::NAN].map(foam), [0.0, 1.0, 0.0]);
        // 0 / 0 is NaN.
        assert_eq!(stateless(&Settings::new(1.0, 0.0), [0.0; 3], 1.0), 0.0);
        assert_eq!(stateless(&Settings::new(1.0, 0.0), [1.0; 3], 1.0), 1.0);
    }
}
