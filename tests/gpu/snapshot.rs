//! Compares snapshots of the generator, which make a whole population of particles at once, with
//! the CPU twin.

use super::*;
use crate::hostile::spoil;
use crate::reference::generate::snapshot::{Snapshot, Stage};

impl Making {
    fn snapshot(&mut self, fluid: &Fluid, settings: &GeneratorSettings, number: u32) -> Made {
        let data = self.upload(fluid);
        // A snapshot does not use the time step.
        let step = step_of(&data, fluid, settings, 0.0, number);
        self.record_by(&step, |generator, cmd, step| {
            // SAFETY: cmd is recording, the slot was waited for, and all handles live until the end
            // of this function.
            unsafe { generator.record_snapshot(cmd, step) }
        })
        .expect("a snapshot");
        self.made(fluid.ids.len())
    }
}

/// What a snapshot leaves: the number of particles, of those made and of those lost, and the
/// particles.
fn left(made: &Made) -> (u32, u32, u32, &[Particle]) {
    let [high, _, _, _, new, lost] = made.counts;
    (high, new, lost, &made.particles)
}

fn roomy() -> GeneratorConfig {
    config().with(|it| it.max_particles = 100_000)
}

/// A flow that is turbulent at its beginning and calm downstream, on a bed that slows it.
fn river() -> Fluid {
    let mut random = Random(91);
    let mut fluid = Fluid::default();
    for i in 0..1800_u32 {
        let (x, y, z) = (i % 50, i / 50 % 6, i / 300);
        let mut jitter = || SPACING * random.between(-0.1, 0.1);
        let at = [x, y, z].map(|n| SPACING * n as f32);
        let at = [at[0] + jitter(), at[1] + jitter(), at[2] + jitter()];
        let stir = if x < 15 { 30.0 } else { 0.5 };
        let speed = 2.0 + 4.0 * at[1];
        let velocity = [speed + stir * jitter(), stir * jitter(), stir * jitter()];
        fluid.positions.push(at);
        fluid.velocities.push(velocity);
        fluid.ids.push(i * 3 + 1);
    }
    fluid
}

/// The ages, in seconds, of the stages that newborn m may belong to.
fn ages_of(stages: &[Stage], m: u32) -> Vec<f64> {
    let (mut least, mut most) = (0, 0);
    let mut seconds = Vec::new();
    for stage in stages {
        // Each earlier stage makes between counts[0] and counts[1] particles.
        most += stage.counts[1];
        if (least..most).contains(&m) && stage.counts[1] > 0 {
            seconds.push(stage.seconds);
        }
        least += stage.counts[0];
    }
    seconds
}

/// Counts of what a comparison checked.
#[derive(Default)]
struct Seen {
    stages: u32,
    /// Stages whose number of particles does not depend on rounding.
    sure: u32,
    made: u32,
    /// Foam particles that have only one possible age.
    aged: u32,
    kinds: [u32; 3],
}

fn assert_snapshot(
    made: &Made,
    fluid: &Fluid,
    settings: &GeneratorSettings,
    number: u32,
    seen: &mut Seen,
) {
    let settings = twins(settings);
    let twin = Snapshot::new(fluid, &settings, number);
    let mut slot = 0;
    for i in 0..fluid.ids.len() {
        let Some(stages) = twin.stages(i) else { continue };
        let of = |m| twin.newborn(i, m, 0.0);
        let [least, most] =
            [0, 1].map(|side| stages.iter().map(|stage| stage.counts[side]).sum::<u32>());
        // Particles are in the order of the fluid's particles that made them, without gaps.
        let found = made.particles[slot..].iter().zip(0..most);
        let found = found.take_while(|(found, m)| found.id == of(*m).id).count() as u32;
        assert!((least..=most).contains(&found), "{number}: {i} made {found} of {stages:?}");
        for m in 0..found {
            let name = format!("{number}: {m} of {i}");
            let particle = &made.particles[slot];
            slot += 1;
            let loose = twin.potentials(i).is_none_or(|p| p.loose);
            // Everything except the age is independent of the stage.
            let expected = Particle { age: particle.age, ..of(m) };
            let kind = if loose { particle.kind } else { expected.kind };
            // The device's sines have an error of 2^-11.
            let off = f64::from(SPACING) / 2048.0;
            assert_same(&name, particle, &Particle { kind, ..expected }, off, 1.0);
            let seconds = ages_of(&stages, m);
            if particle.kind == twin::FOAM {
                // A few operations on numbers of at most about 1.
                let is = |s: f64| (twin.foam_age(i, m, s) - particle.age).abs() <= 2.0e-6;
                assert!(seconds.iter().any(|s| is(*s)), "{name}: {particle:?} of {stages:?}");
                seen.aged += u32::from(seconds.len() == 1);
            } else {
                assert_eq!(particle.age, 0.0, "{name}");
            }
            seen.kinds[particle.kind as usize] += 1;
        }
        seen.made += found;
        // Only stages that may make particles count.
        let some = stages.iter().filter(|stage| stage.counts[1] > 0);
        for stage in some {
            seen.stages += 1;
            seen.sure += u32::from(stage.counts[0] == stage.counts[1]);
        }
    }
    let high = made.particles.len() as u32;
    assert_eq!(slot as u32, high, "{number}: particles of nothing");
    assert_eq!(left(made), (high, high, 0, &made.particles[..]));
}

/// Turbulent water, with drops above it that collide.
fn torn(number: u32) -> Fluid {
    let mut fluid = sea(number);
    for i in 0..180_u32 {
        let (drop, n) = (i / 3, i % 3);
        let at = [0.3 * (drop % 8) as f32, 1.3 + 0.3 * (drop / 8) as f32, 0.03 * n as f32];
        fluid.positions.push(at);
        fluid.velocities.push([0.5, 0.0, 2.0 - 2.0 * n as f32]);
        fluid.ids.push(300_000 + i);
    }
    fluid
}

/// Lifetimes so short that the particles' way back is only a few spacings.
fn short(lifetime: [f32; 2]) -> GeneratorSettings {
    settings().with(|it| {
        [it.min_lifetime, it.max_lifetime] = lifetime;
        it.trapped_air_rate = 400.0;
        it.wave_crest_rate = 300.0;
    })
}

/// Where ways are long, rounding leaves many ages open; the order, the ids and everything else are
/// still compared.
#[test]
fn snapshots_are_the_twins() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &roomy());
    let mut all = Seen::default();
    for number in 0..2 {
        let fluid = torn(number);
        let made = making.snapshot(&fluid, &settings(), number);
        assert_snapshot(&made, &fluid, &settings(), number, &mut all);
    }
    assert!(all.made > 1000, "{}", all.made);

    let mut near = Seen::default();
    let settings = short([0.02, 0.05]);
    for number in 0..3 {
        let fluid = torn(number);
        let made = making.snapshot(&fluid, &settings, number);
        assert_snapshot(&made, &fluid, &settings, number, &mut near);
    }
    // A particle at rest at an end of the water.
    let mut fluid = river();
    fluid.velocities[49] = [0.0; 3];
    let settings = short([0.05, 0.15]);
    let made = making.snapshot(&fluid, &settings, 7);
    assert_snapshot(&made, &fluid, &settings, 7, &mut near);
    let Seen { stages, sure, made, aged, kinds } = near;
    assert!(made > 2500 && kinds.iter().all(|n| *n > 50), "{made}: {kinds:?}");
    assert!(3 * sure > 2 * stages, "{sure} of {stages} are sure");
    assert!(3 * aged > 2 * kinds[twin::FOAM as usize], "{aged} of {kinds:?} have one age");
}

#[test]
fn the_fluids_order_is_a_snapshots_order_alone() {
    let gpu = Gpu::shared();
    let [mut straight, mut turned] = [(); 2].map(|()| Making::new(&gpu, &roomy()));
    let fluid = sea(2);
    let mut other = fluid.clone();
    other.positions.reverse();
    other.velocities.reverse();
    other.ids.reverse();
    let sorted = |made: Made| {
        let mut particles = made.particles;
        particles.sort_by_key(|particle| particle.id);
        particles
    };
    let a = sorted(straight.snapshot(&fluid, &settings(), 4));
    let b = sorted(turned.snapshot(&other, &settings(), 4));
    assert!(a.len() > 1000, "{}", a.len());
    assert!(a == b, "{} and {}", a.len(), b.len());
}

#[test]
fn a_snapshot_knows_nothing_of_what_was_before() {
    let gpu = Gpu::shared();
    let settings = settings();
    let small = config().with(|it| it.max_particles = 500);
    for config in [roomy(), small] {
        let fluid = torn(3);
        let expected = Making::new(&gpu, &config).snapshot(&fluid, &settings, 3);
        assert!(!expected.particles.is_empty());
        let mut making = Making::new(&gpu, &config);
        let same = |making: &mut Making, after: &str| {
            let made = making.snapshot(&fluid, &settings, 3);
            assert!(left(&made) == left(&expected), "after {after}: {:?}", made.counts);
        };
        same(&mut making, "nothing");
        same(&mut making, "itself");
        for number in 0..4 {
            making.step(&sea(number), &settings, 0.03, number);
        }
        same(&mut making, "steps");
        making.snapshot(&sea(0), &settings.with(|it| it.trapped_air_rate = 400.0), 9);
        same(&mut making, "one of more");
        making.snapshot(&river(), &settings.with(|it| it.trapped_air_rate = 1.0), 9);
        same(&mut making, "one of less");
        making.snapshot(&Fluid::default(), &settings, 9);
        same(&mut making, "one of nothing");
    }
}

#[test]
fn a_snapshot_of_nothing_is_empty() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &config());
    let nothing = Fluid::default();
    assert_eq!(left(&making.snapshot(&nothing, &settings(), 0)), (0, 0, 0, &[][..]));
    // A snapshot without water also removes earlier particles.
    making.step(&sea(0), &settings(), 0.03, 0);
    assert!(making.step(&sea(1), &settings(), 0.03, 1).counts[0] > 0);
    assert_eq!(left(&making.snapshot(&nothing, &settings(), 2)), (0, 0, 0, &[][..]));
    // Water without valid positions removes earlier particles too.
    let mut nowhere = sea(0);
    nowhere.positions.fill([f32::NAN; 3]);
    assert_eq!(left(&making.snapshot(&nowhere, &settings(), 2)), (0, 0, 0, &[][..]));
}

#[test]
fn a_snapshot_counts_what_has_no_room() {
    let gpu = Gpu::shared();
    let fluid = sea(1);
    let all = Making::new(&gpu, &roomy()).snapshot(&fluid, &settings(), 1);
    let wanted = all.particles.len() as u32;
    assert!(wanted > 200, "{wanted}");
    for most in [1, 150, wanted - 1, wanted] {
        let config = config().with(|it| it.max_particles = most);
        let mut making = Making::new(&gpu, &config);
        for _ in 0..2 {
            let made = making.snapshot(&fluid, &settings(), 1);
            // The first particles are kept.
            let expected = (most, wanted, wanted - most, &all.particles[..most as usize]);
            assert!(left(&made) == expected, "{most}: {:?}", made.counts);
        }
    }
}

/// Steps may follow a snapshot and move its particles.
#[test]
fn steps_go_on_from_a_snapshot() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &roomy());
    let settings = settings();
    let before = making.snapshot(&sea(1), &settings, 1).particles;
    let mut still = sea(1);
    still.velocities.fill([0.0; 3]);
    let dt = 0.02_f32;
    let after = making.step(&still, &settings, dt, 2);
    assert_eq!((after.counts[0] as usize, after.counts[4]), (before.len(), 0));
    let mut seen = 0;
    for (slot, (particle, found)) in before.iter().zip(&after.particles).enumerate() {
        let (expected, loose) = twin::moved(particle, &still, &twins(&settings), dt);
        if !loose && expected.age < 1.0 {
            assert_same(&format!("{slot}"), found, &expected, 0.0, dt.into());
            seen += 1;
        }
    }
    assert!(seen > 300, "{seen} of {}", before.len());
}

/// A step ends and stays in its own memory, with any bits in the streams and in a restored state.
#[test]
fn hostile_bits_in_a_step() {
    let gpu = Gpu::shared();
    let (mut random, whole) = (Random(8), sea(0));
    let mut words: Vec<u32> = (0..whole.ids.len())
        .flat_map(|i| {
            let [p, v] = [whole.positions[i], whole.velocities[i]].map(|v| v.map(f32::to_bits));
            [p[0], p[1], p[2], v[0], v[1], v[2], whole.ids[i]]
        })
        .collect();
    spoil(&mut words, 7, &mut random);
    let mut fluid = Fluid::default();
    for w in words.chunks(7) {
        fluid.positions.push([w[0], w[1], w[2]].map(f32::from_bits));
        fluid.velocities.push([w[3], w[4], w[5]].map(f32::from_bits));
        fluid.ids.push(w[6]);
    }
    let mut making = Making::new(&gpu, &config());
    for number in 0..3 {
        making.step(&fluid, &settings(), 0.02, number);
    }
    assert!(!making.snapshot(&fluid, &settings(), 3).particles.is_empty(), "none was made");
    let mut saved: Vec<u32> = bytemuck::pod_collect_to_vec(&making.save());
    spoil(&mut saved, 1, &mut random);
    making.restore(bytemuck::cast_slice(&saved));
    let data = making.upload(&fluid);
    making.record(&step_of(&data, &fluid, &settings(), 0.02, 4)).expect("a step");
    let counts = making.generator().counts();
    let high = making.read(counts, 1)[0];
    assert!(high <= config().max_particles, "{high} slots of {}", config().max_particles);
}
