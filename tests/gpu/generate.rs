//! Compares the generator of whitewater particles with its CPU twin, over several steps of
//! turbulent water.

use std::collections::HashMap;

use ash::vk;
use glam::DVec3;
use whitewater::{Count, Error, GeneratorStep, Slot, Stream, WhitewaterParticles};
use whitewater::{Generator, GeneratorConfig, GeneratorSettings, PotentialRange, WhitewaterConfig};

use crate::reference::generate::{self as twin, Fluid, Particle};
use crate::spied::{only_records, spied};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::{Data, HOST_WRITE, Stub};
use crate::support::rig::{Rig, Shot, config as rig_config, stream};
use crate::support::scenes::{self, Lens, Random};

#[path = "snapshot.rs"]
mod snapshot;

const SLOTS: u32 = 2;
const SPACING: f32 = 0.05;

/// A generator and the host that records its steps.
struct Making {
    stub: Stub,
    generator: Option<Generator>,
    steps: u32,
}

/// The generator's state after a step.
#[derive(Clone, Debug, PartialEq)]
struct Made {
    /// The words of the counts; the last two are the slots ever taken and the newborn particles
    /// lost.
    counts: [u32; 6],
    /// Trapped air, crest, energy, number of neighbours.
    potentials: Vec<[f32; 4]>,
    particles: Vec<Particle>,
}

impl Making {
    fn new(gpu: &Gpu, config: &GeneratorConfig) -> Self {
        let generator = Generator::new(&gpu.context(SLOTS), config).expect("a generator");
        Self { stub: Stub::new(gpu, SLOTS), generator: Some(generator), steps: 0 }
    }

    /// A generator to which the allocator probably hands out the memory of another one, filled with 0x5a.
    fn in_used_memory(gpu: &Gpu) -> Self {
        let mut before = Self::new(gpu, &config());
        let size = before.generator().size() as usize;
        before.restore(&vec![0x5a; size]);
        drop(before);
        Self::new(gpu, &config())
    }

    fn generator(&mut self) -> &mut Generator {
        self.generator.as_mut().expect("only drop takes it")
    }

    /// Records commands in frame slot 0 that are never submitted; the next step is in slot 1.
    fn discard(&mut self, record: impl FnOnce(&mut Generator, vk::CommandBuffer)) {
        self.stub.wait(0);
        let cmd = self.stub.begin(0);
        record(self.generator.as_mut().expect("only drop takes it"), cmd);
        self.steps = 1;
    }

    /// Records a step in the next frame slot.
    fn record(&mut self, step: &GeneratorStep<'_>) -> Result<(), Error> {
        self.record_by(step, |generator, cmd, step| {
            // SAFETY: cmd is recording, the slot was waited for, and all handles live until the end
            // of this function.
            unsafe { generator.record_step(cmd, step) }
        })
    }

    fn record_by(
        &mut self,
        step: &GeneratorStep<'_>,
        by: impl FnOnce(&mut Generator, vk::CommandBuffer, &GeneratorStep<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let slot = self.steps % SLOTS;
        self.steps += 1;
        let cmd = self.stub.begin(slot);
        let generator = self.generator.as_mut().expect("only drop takes it");
        let result = by(generator, cmd, &step.with(|it| it.slot = Slot(slot)));
        self.stub.end(slot);
        self.stub.wait(slot);
        result
    }

    fn step(&mut self, fluid: &Fluid, settings: &GeneratorSettings, dt: f32, number: u32) -> Made {
        let data = self.upload(fluid);
        self.record(&step_of(&data, fluid, settings, dt, number)).expect("a step");
        self.made(fluid.ids.len())
    }

    fn upload(&mut self, fluid: &Fluid) -> Data {
        let mut words: Vec<u32> = (0..fluid.ids.len())
            .flat_map(|i| {
                let [x, y, z] = fluid.positions[i].map(f32::to_bits);
                let [u, v, w] = fluid.velocities[i].map(f32::to_bits);
                [x, y, z, u, v, w, fluid.ids[i]]
            })
            .collect();
        // A buffer is bound even if there are no particles.
        words.resize(words.len().max(7), 0);
        self.stub.data(bytemuck::cast_slice(&words), vk::BufferUsageFlags::STORAGE_BUFFER)
    }

    fn read(&mut self, from: vk::Buffer, words: usize) -> Vec<u32> {
        if words == 0 {
            return Vec::new();
        }
        let back = self.stub.sized(4 * words as u64, vk::BufferUsageFlags::TRANSFER_DST);
        self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, from, &back));
        bytemuck::cast_slice(&back.bytes()[..4 * words]).to_vec()
    }

    fn made(&mut self, fluid: usize) -> Made {
        let generator = self.generator();
        let (counts, potentials) = (generator.counts(), generator.potentials());
        let streams = generator.particles();
        let (ids, kinds) = (streams.ids.expect("ids"), streams.kinds.expect("kinds"));
        assert_eq!((ids.offset, ids.stride, kinds.stride), (12, 16, 4));
        let counts: [u32; 6] = self.read(counts, 6).try_into().expect("six");
        let high = counts[0] as usize;
        let potentials = self.read(potentials, 4 * fluid);
        let places = self.read(streams.positions.buffer, 4 * high);
        let drifts = self.read(ids.buffer, 4 * high);
        let kinds = self.read(kinds.buffer, high);
        let vector = |words: &[u32]| {
            DVec3::from([words[0], words[1], words[2]].map(|word| f64::from(f32::from_bits(word))))
        };
        Made {
            counts,
            potentials: bytemuck::cast_slice(&potentials).to_vec(),
            particles: (0..high)
                .map(|i| Particle {
                    position: vector(&places[4 * i..]),
                    velocity: vector(&drifts[4 * i..]),
                    age: f64::from(f32::from_bits(places[4 * i + 3])),
                    kind: kinds[i],
                    id: drifts[4 * i + 3],
                })
                .collect(),
        }
    }

    fn save(&mut self) -> Vec<u8> {
        let size = self.generator().size();
        let back = self.stub.sized(size, vk::BufferUsageFlags::TRANSFER_DST);
        let generator = self.generator.as_mut().expect("only drop takes it");
        // SAFETY: submitted at once; the buffer has the state's size.
        self.stub.run(|cmd| unsafe { generator.record_save(cmd, back.buffer, 0) });
        back.bytes().to_vec()
    }

    fn restore(&mut self, saved: &[u8]) {
        let from = self.stub.data(saved, vk::BufferUsageFlags::TRANSFER_SRC);
        let generator = self.generator.as_mut().expect("only drop takes it");
        // SAFETY: as above.
        self.stub.run(|cmd| unsafe { generator.record_restore(cmd, from.buffer, 0) });
    }
}

/// A step of the particles that [`Making::upload`] uploaded.
fn step_of<'a>(
    data: &Data,
    fluid: &Fluid,
    settings: &'a GeneratorSettings,
    dt: f32,
    number: u32,
) -> GeneratorStep<'a> {
    GeneratorStep::new(
        Slot(0),
        [stream(data, 0, 28), stream(data, 12, 28)],
        Count::Cpu(fluid.ids.len() as u32),
        dt,
        settings,
    )
    .with(|it| {
        it.ids = Some(stream(data, 24, 28));
        it.number = number;
        it.before = HOST_WRITE;
        it.after = HOST_WRITE;
    })
}

impl Drop for Making {
    fn drop(&mut self) {
        for slot in 0..SLOTS {
            self.stub.wait(slot);
        }
        if let Some(generator) = self.generator.take() {
            // SAFETY: all work was waited for.
            unsafe { generator.destroy() };
        }
    }
}

impl Made {
    fn living(&self) -> Vec<Particle> {
        self.particles.iter().filter(|particle| particle.age < 1.0).copied().collect()
    }
}

/// Turbulent water: a block that turns about its middle, a jet through it, drops above it, and
/// particles with invalid values.
fn sea(step: u32) -> Fluid {
    let mut random = Random(77 + u64::from(step));
    let mut fluid = Fluid::default();
    for i in 0..1400_u32 {
        let (x, y, z) = (i % 12, i / 12 % 9, i / 108);
        let mut jitter = || SPACING * random.between(-0.17, 0.17);
        let at = [x, y, z].map(|n| SPACING * n as f32);
        let at = [at[0] + jitter(), at[1] + jitter(), at[2] + jitter()];
        let turn = 6.0 * ((0.5 * step as f32).sin() + 0.3);
        let mut velocity = [turn * (0.2 - at[1]), turn * (at[0] - 0.3), 0.4 * jitter() / SPACING];
        if (4..7).contains(&x) && z > 8 {
            velocity = [0.5, 4.0, -1.0];
        }
        fluid.positions.push(at);
        fluid.velocities.push(velocity);
        fluid.ids.push(i * 7 + 3);
    }
    for i in 0..40_u32 {
        let at = [0.02 * i as f32, 0.9, 0.3 + random.between(0.0, 0.1)];
        fluid.positions.push(at);
        fluid.velocities.push([1.0, 2.0 - 0.1 * i as f32, 0.0]);
        fluid.ids.push(100_000 + i);
    }
    for (position, velocity) in [
        ([f32::NAN, 0.0, 0.0], [1.0; 3]),
        ([0.1, f32::INFINITY, 0.0], [1.0; 3]),
        ([0.2; 3], [f32::NAN, 0.0, 0.0]),
        ([0.2; 3], [0.0, 0.0, 2.0e18]),
        ([0.0, 0.0, -3.0e15], [5.0; 3]),
    ] {
        fluid.positions.push(position);
        fluid.velocities.push(velocity);
        fluid.ids.push(200_000 + fluid.ids.len() as u32);
    }
    fluid
}

fn settings() -> GeneratorSettings {
    let limits = |least, most| PotentialRange { min: least, max: most };
    GeneratorSettings::new(SPACING, [limits(0.5, 8.0), limits(0.3, 4.0), limits(0.2, 6.0)], 1.0)
        .with(|it| {
            it.trapped_air_rate = 60.0;
            it.wave_crest_rate = 40.0;
            [it.min_lifetime, it.max_lifetime] = [0.2, 0.5];
            it.bounds = Some([[-0.5, -0.3, -0.5], [1.2, 1.4, 1.2]]);
            it.seed = 5;
        })
}

fn twins(settings: &GeneratorSettings) -> twin::Settings {
    let limits = |limits: PotentialRange| [limits.min, limits.max];
    twin::Settings {
        spacing: settings.spacing,
        gravity: settings.gravity,
        trapped_air: limits(settings.trapped_air),
        wave_crest: limits(settings.wave_crest),
        energy: limits(settings.energy),
        trapped_air_rate: settings.trapped_air_rate,
        wave_crest_rate: settings.wave_crest_rate,
        lifetime: [settings.min_lifetime, settings.max_lifetime],
        buoyancy: settings.buoyancy,
        drag: settings.drag,
        seed: settings.seed,
        bounds: settings.bounds,
    }
}

/// Relative rounding error of the sums of single-precision terms.
const FLOAT: f64 = 4.0e-6;

#[test]
fn potentials_are_the_twins() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &config());
    let twin_settings = twins(&settings());
    let unit = twin::unit(&twin_settings);
    let (mut surface, mut crests, mut trapped, mut sure, mut all) = (0, 0, 0, 0, 0);
    for number in 0..4 {
        let fluid = sea(number);
        let made = making.step(&fluid, &settings(), 0.02, number);
        let expected = twin::potentials(&fluid, &twin_settings);
        assert_eq!(made.counts[1] as usize, fluid.ids.len());
        assert_eq!(made.counts[2] as usize, expected.iter().flatten().count());
        for (i, (found, expected)) in made.potentials.iter().zip(&expected).enumerate() {
            let Some(expected) = expected else {
                assert_eq!(*found, [0.0; 4], "{i} takes no part");
                continue;
            };
            all += 1;
            if expected.loose {
                continue;
            }
            sure += 1;
            let [air, crest, energy, neighbours] = found.map(f64::from);
            assert_eq!(neighbours, f64::from(expected.neighbours), "neighbours of {i}");
            let off = 0.5 * neighbours * unit + FLOAT * (1.0 + expected.trapped_air);
            assert!((air - expected.trapped_air).abs() <= off, "{i}: {air}, {expected:?}");
            assert!((energy - expected.energy).abs() <= FLOAT * expected.energy, "energy of {i}");
            let off = 0.5 * f64::from(expected.crest_terms) * twin::STEP + expected.crest_off;
            let off = off + FLOAT * (1.0 + expected.wave_crest);
            assert!((crest - expected.wave_crest).abs() <= off, "{i}: {crest}, {expected:?}");
            surface += usize::from(expected.normal.is_some());
            crests += usize::from(expected.wave_crest > 0.3);
            trapped += usize::from(expected.trapped_air > 1.0);
        }
    }
    assert!(10 * sure > 8 * all, "{sure} of {all} are told by more than rounding");
    assert!(surface > 300 && crests > 60 && trapped > 300, "{surface} {crests} {trapped}");
}

/// The sea at a step, with fast water, in a unit of 1/`units` metre. With a power of two no number
/// is rounded.
fn sea_in(units: f32, number: u32) -> Fluid {
    let mut fluid = sea(number);
    for position in &mut fluid.positions {
        *position = position.map(|v| units * v);
    }
    for velocity in &mut fluid.velocities {
        *velocity = velocity.map(|v| 4.0 * units * v);
    }
    fluid
}

/// These settings in a unit of 1/`units` metre.
fn settings_in(units: f32) -> GeneratorSettings {
    let scaled = |limits: PotentialRange, by: f32| PotentialRange {
        min: by * limits.min,
        max: by * limits.max,
    };
    settings().with_gravity(units, [0.0, 1.0, 0.0]).with(|it| {
        it.spacing *= units;
        it.trapped_air = scaled(it.trapped_air, units);
        it.energy = scaled(it.energy, units * units);
        it.bounds = it.bounds.map(|corners| corners.map(|corner| corner.map(|v| units * v)));
    })
}

/// Water in metres and the same water in a unit near the millimetre make the same whitewater. With
/// a limit of speeds that did not scale, the fastest water would be slower in the small unit.
#[test]
fn the_unit_of_length_is_no_matter() {
    const UNITS: f32 = 1024.0;
    let gpu = Gpu::shared();
    let [mut metres, mut small] = [(); 2].map(|()| Making::new(&gpu, &config()));
    let longer = f64::from(UNITS);
    let in_small = |particle: &Particle| Particle {
        position: longer * particle.position,
        velocity: longer * particle.velocity,
        ..*particle
    };
    for number in 0..6 {
        let [one, other] = [(&mut metres, 1.0), (&mut small, UNITS)].map(|(making, units)| {
            making.step(&sea_in(units, number), &settings_in(units), 0.03, number)
        });
        assert_eq!(one.counts, other.counts, "step {number}");
        for (i, (one, other)) in one.potentials.iter().zip(&other.potentials).enumerate() {
            let [air, crest, energy, neighbours] = *one;
            let expected = [UNITS * air, crest, UNITS * UNITS * energy, neighbours];
            assert_eq!(*other, expected, "potentials of {i} in step {number}");
        }
        let expected: Vec<_> = one.particles.iter().map(in_small).collect();
        assert_eq!(other.particles, expected, "step {number}");
    }
    assert!(metres.made(0).living().len() > 200);
}

/// Without gravity the limit of speeds is that of 9.81 scene units per second squared. With any
/// gravity that is finite the potentials are, too.
#[test]
fn potentials_need_no_gravity() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &config());
    let fluid = sea(0);
    let mut potentials = |gravity: [f32; 3]| {
        let settings = settings().with(|it| it.gravity = gravity);
        making.step(&fluid, &settings, 0.0, 0).potentials
    };
    assert_eq!(potentials([0.0; 3]), potentials([0.0, -9.81, 0.0]));
    assert_eq!(potentials([0.0; 3]), potentials([9.81, 0.0, 0.0]));
    for gravity in [[f32::MAX; 3], [1.0e-40, 0.0, 0.0]] {
        let all = potentials(gravity);
        assert!(all.iter().flatten().all(|v| v.is_finite()), "{gravity:?}");
    }
}

fn config() -> GeneratorConfig {
    GeneratorConfig::new(2000, 4000).with(|it| it.max_stride = 28)
}

/// A step neither waits nor submits, and makes no memory and no pipelines.
#[test]
fn a_step_only_records() {
    let gpu = spied();
    let (mut making, fluid, settings) = (Making::new(&gpu, &config()), sea(0), settings());
    let data = making.upload(&fluid);
    for number in 0..3 {
        let step = step_of(&data, &fluid, &settings, 0.02, number);
        let recorded = making.record_by(&step, |generator, cmd, step| {
            // SAFETY: cmd is recording, the slot was waited for, and all handles outlive the step.
            only_records(&gpu, "step", || unsafe { generator.record_step(cmd, step) });
            Ok(())
        });
        recorded.expect("a step");
    }
}

/// Checks that two particles differ only by rounding and by the error of the water's velocity.
fn assert_same(name: &str, found: &Particle, expected: &Particle, off: f64, dt: f64) {
    assert_eq!((found.kind, found.id), (expected.kind, expected.id), "{name}");
    let velocity = (found.velocity - expected.velocity).abs().max_element();
    let speed = expected.velocity.length();
    assert!(velocity <= off + FLOAT * (1.0 + speed), "{name}: {found:?}, {expected:?}");
    let position = (found.position - expected.position).abs().max_element();
    let most = off * dt + FLOAT * (1.0 + speed * dt);
    assert!(position <= most, "{name}: {found:?}, {expected:?}");
    assert!((found.age - expected.age).abs() <= 1.0e-6, "{name}: {found:?}, {expected:?}");
}

#[test]
fn every_step_is_the_twins() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &config().with(|it| it.max_particles = 20_000));
    let (settings, dt) = (settings(), 0.03_f32);
    let mut before: Vec<Particle> = Vec::new();
    let mut seen = [0_usize; 3];
    let (mut gone, mut born, mut reused) = (0, 0, 0);
    for number in 0..40 {
        let fluid = sea(number);
        let made = making.step(&fluid, &settings, dt, number);
        let sure = twins(&settings);
        // Particles of the step before keep their slot. A slot whose particle may have died may
        // hold another one.
        let mut taken = vec![false; made.particles.len()];
        for (slot, particle) in before.iter().enumerate() {
            let (after, loose) = twin::moved(particle, &fluid, &sure, dt);
            if particle.age >= 1.0 || loose || after.age >= 1.0 {
                gone += usize::from(after.age >= 1.0 && particle.age < 1.0);
                taken[slot] = loose && made.particles[slot].id == particle.id;
                continue;
            }
            let water = twin::carried(particle.position, &fluid, &sure);
            // The water does not carry spray.
            let off = if after.kind == twin::SPRAY { 0.0 } else { water.off };
            assert_same(&format!("{number}/{slot}"), &made.particles[slot], &after, off, dt.into());
            seen[after.kind as usize] += 1;
            taken[slot] = true;
        }
        // New particles, by id.
        let new: HashMap<u32, usize> = (0..taken.len())
            .filter(|slot| !taken[*slot] && made.particles[*slot].age < 1.0)
            .map(|slot| (made.particles[slot].id, slot))
            .collect();
        let mut places = Vec::new();
        let mut explained = 0;
        for (i, p) in twin::potentials(&fluid, &sure).iter().enumerate() {
            let Some(p) = p else { continue };
            let wanted = twin::wanted(p, &sure, dt);
            let count = |wanted: f64| twin::count(wanted.max(0.0), &sure, fluid.ids[i], number);
            // Counts for the largest error of the potentials.
            let off = 2.0e-2 * (1.0 + wanted) + if p.loose { 64.0 } else { 0.0 };
            let (least, most) = (count(wanted - off), count((wanted + off).min(64.0)));
            let of = |k| twin::newborn(&fluid, i, p, k, &sure, dt, number);
            let found = (0..64).take_while(|k| new.contains_key(&of(*k).id)).count() as u32;
            assert!(
                (least..=most).contains(&found),
                "{number}: {i} made {found}, {wanted} of {p:?}"
            );
            for k in 0..found {
                let expected = of(k);
                let slot = new[&expected.id];
                let kind = if p.loose { made.particles[slot].kind } else { expected.kind };
                // The device's sines have an error of 2^-11.
                let off = f64::from(SPACING) / 2048.0;
                let expected = Particle { kind, ..expected };
                assert_same(
                    &format!("{number}: {k} of {i}"),
                    &made.particles[slot],
                    &expected,
                    off,
                    1.0,
                );
                places.push(slot);
                explained += 1;
            }
        }
        assert_eq!(explained, new.len(), "{number}: particles of nothing");
        assert_eq!(made.counts[4] as usize, explained);
        // New particles fill free slots first, then new slots, both in ascending order.
        let high = before.len();
        let first_new = places.iter().position(|slot| *slot >= high).unwrap_or(places.len());
        assert!(places[..first_new].is_sorted() && places[first_new..].is_sorted());
        assert!(first_new == places.len() || places[first_new] == high);
        let free = before.iter().zip(&made.particles).filter(|(_, after)| after.age >= 1.0).count();
        assert!(free == 0 || first_new == places.len(), "{number}: {free} are free");
        born += explained;
        reused += first_new;
        before = made.particles;
    }
    assert!(seen.iter().all(|n| *n > 300), "foam, spray, bubbles: {seen:?}");
    assert!(born > 1000 && reused > 300 && gone > 300, "{born} {reused} {gone}");
}

#[test]
fn it_is_the_same_in_every_run_and_however_it_is_cut() {
    let gpu = Gpu::shared();
    let settings = settings();
    let [mut whole, mut part] = [(); 2].map(|()| Making::new(&gpu, &config()));
    for number in 0..16 {
        let fluid = sea(number);
        let expected = whole.step(&fluid, &settings, 0.03, number);
        if number % 5 == 3 {
            let saved = part.save();
            part = Making::new(&gpu, &config());
            part.restore(&saved);
        }
        assert_eq!(part.step(&fluid, &settings, 0.03, number), expected, "step {number}");
    }
    assert!(whole.made(0).living().len() > 200);
}

#[test]
fn the_order_of_the_fluid_is_no_matter() {
    let gpu = Gpu::shared();
    let settings = settings();
    let [mut straight, mut turned] = [(); 2].map(|()| Making::new(&gpu, &config()));
    let sorted = |made: &Made| {
        let mut living = made.living();
        living.sort_by_key(|particle| particle.id);
        living
    };
    for number in 0..8 {
        let fluid = sea(number);
        let mut other = fluid.clone();
        other.positions.reverse();
        other.velocities.reverse();
        other.ids.reverse();
        let (a, b) = (
            straight.step(&fluid, &settings, 0.03, number),
            turned.step(&other, &settings, 0.03, number),
        );
        assert_eq!(sorted(&a), sorted(&b), "step {number}");
    }
}

#[test]
fn no_more_than_there_is_room_for() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &config().with(|it| it.max_particles = 150));
    let (mut before, mut lost) = (0, 0);
    for number in 0..10 {
        let made = making.step(&sea(number), &settings(), 0.03, number);
        let [high, _, _, free, new, all_lost] = made.counts;
        assert!(high <= 150);
        assert_eq!(made.particles.len(), high as usize);
        lost += new - (new.min(free) + high - before);
        assert_eq!(all_lost, lost);
        before = high;
    }
    assert!(lost > 100, "{lost}");
}

/// Where the water carries no particle, positions are exact to single precision.
#[test]
fn in_still_water_motion_is_exact() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &config());
    let settings = settings();
    let mut before = Vec::new();
    for number in 0..6 {
        before = making.step(&sea(number), &settings, 0.03, number).particles;
    }
    let mut still = sea(5);
    still.velocities.fill([0.0; 3]);
    let dt = 0.04_f32;
    let after = making.step(&still, &settings, dt, 6);
    assert_eq!(after.counts[4], 0, "it makes none");
    let mut seen = [0; 3];
    for (slot, (particle, found)) in before.iter().zip(&after.particles).enumerate() {
        let (expected, loose) = twin::moved(particle, &still, &twins(&settings), dt);
        if !loose && expected.age < 1.0 {
            assert_same(&format!("{slot}"), found, &expected, 0.0, dt.into());
            seen[expected.kind as usize] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > 20), "{seen:?}");
}

/// A whitewater particle's kind depends on the number of water particles around it, including the
/// one that creates it: five make spray, six foam and 21 bubbles. The kind at birth is that of the
/// next step.
#[test]
fn kinds_at_birth_are_those_of_the_next_step() {
    let gpu = Gpu::shared();
    let mut making = Making::new(&gpu, &config());
    let mut random = Random(11);
    let mut fluid = Fluid { positions: Vec::new(), velocities: Vec::new(), ids: Vec::new() };
    for (at, count) in [(0.0, 5), (0.5, 6), (1.0, 20), (1.5, 21)] {
        for _ in 0..count {
            let [x, y, z] = [0; 3].map(|_| random.between(-0.1, 0.1) * SPACING);
            fluid.positions.push([at + x, y, z]);
            fluid.velocities.push([0; 3].map(|_| random.between(-3.0, 3.0)));
            fluid.ids.push(fluid.ids.len() as u32);
        }
    }
    for (snapshot, rate) in [(false, 4000.0), (true, 200.0)] {
        let settings = settings().with(|it| {
            it.trapped_air_rate = rate;
            it.bounds = None;
        });
        let data = making.upload(&fluid);
        // Speeds are below 3√3, so in this step particles move at most 0.052 spacings.
        let step = step_of(&data, &fluid, &settings, 0.01 * SPACING, 0);
        let recorded = making.record_by(&step, |generator, cmd, step| {
            // SAFETY: cmd is recording; the slot was waited for; the handles live to the end of
            // this.
            unsafe {
                match snapshot {
                    true => generator.record_snapshot(cmd, step),
                    false => generator.record_step(cmd, step),
                }
            }
        });
        recorded.expect("recorded");
        let born = making.made(fluid.ids.len()).particles;
        // With a time step of 0 the kinds are determined again at the place of birth.
        let after = making.step(&fluid, &settings, 0.0, 1).particles;
        let mut seen = [0; 3];
        for (born, after) in born.iter().zip(&after) {
            let cluster = (born.position.x / 0.5).round() as usize;
            let expected = [twin::SPRAY, twin::FOAM, twin::FOAM, twin::BUBBLE][cluster];
            assert_eq!([born.kind, after.kind], [expected; 2], "{snapshot}: {born:?}");
            seen[born.kind as usize] += 1;
        }
        assert!(seen.iter().all(|count| *count > 5), "{snapshot}: {seen:?}");
    }
}

/// Counts on the GPU, separate streams, chunks, no ids, no particles, and all particles on one
/// spot.
#[test]
fn every_kind_of_input() {
    let gpu = Gpu::shared();
    let settings = settings();
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let fluid = sea(1);
    let count = fluid.ids.len();
    let mut plain = Making::new(&gpu, &config());
    let place = Fluid { ids: (0..count as u32).collect(), ..fluid.clone() };
    let expected = plain.step(&place, &settings, 0.03, 1);

    // Without ids a particle's index is its id.
    let mut making = Making::new(&gpu, &GeneratorConfig::new(2000, 4000));
    let positions = making.stub.data(bytemuck::cast_slice(&fluid.positions), storage);
    let velocities = making.stub.data(bytemuck::cast_slice(&fluid.velocities), storage);
    let counter = making.stub.data(&(count as u32).to_ne_bytes(), storage);
    let step = GeneratorStep::new(
        Slot(0),
        [stream(&positions, 0, 12), stream(&velocities, 0, 12)],
        Count::Gpu { buffer: counter.buffer, offset: 0 },
        0.03,
        &settings,
    )
    .with(|it| {
        it.number = 1;
        it.before = HOST_WRITE;
        it.after = HOST_WRITE;
    });
    making.record(&step).expect("a step");
    assert_eq!(making.made(count), expected, "a count on the GPU");

    // One chunk holds only a part of the particles.
    let range = u64::from(gpu.limits().max_storage_buffer_range);
    let stride = (range / 900).next_multiple_of(4).min(1 << 17) as u32;
    let mut chunked =
        Making::new(&gpu, &GeneratorConfig::new(2000, 4000).with(|it| it.max_stride = stride));
    let wide: Vec<u8> = (0..count)
        .flat_map(|i| {
            let mut record = vec![0_u8; stride as usize];
            record[..12].copy_from_slice(bytemuck::cast_slice(&fluid.positions[i]));
            record[12..24].copy_from_slice(bytemuck::cast_slice(&fluid.velocities[i]));
            record
        })
        .collect();
    let wide = chunked.stub.data(&wide, storage);
    let of = |offset| Stream { stride, ..stream(&wide, offset, stride) };
    let step = step.with(|it| {
        it.positions = of(0);
        it.velocities = of(12);
        it.count = Count::Cpu(count as u32);
    });
    chunked.record(&step).expect("a step");
    assert_eq!(chunked.made(count), expected, "chunks");

    let mut making =
        Making::new(&gpu, &GeneratorConfig::new(9000, 50).with(|it| it.max_stride = 28));
    let none = making.step(&Fluid::default(), &settings, 0.03, 0);
    assert_eq!(none.counts, [0; 6]);
    // On one spot all particles are neighbours, up to the max number that is examined.
    let heap = Fluid {
        positions: vec![[0.1, 0.2, 0.3]; 9000],
        velocities: vec![[1.0, 0.0, 0.0]; 9000],
        ids: (0..9000).collect(),
    };
    let heaped = making.step(&heap, &settings, 0.03, 0);
    assert_eq!(heaped.counts[2], 9000);
    assert!(heaped.potentials.iter().all(|all| all[3] > 200.0), "{:?}", heaped.potentials[0]);
}

#[test]
fn an_abandoned_first_step_leaves_nothing() {
    let gpu = Gpu::shared();
    let mut making = Making::in_used_memory(&gpu);
    let (fluid, settings) = (sea(0), settings());
    let data = making.upload(&fluid);
    making.discard(|generator, cmd| {
        let step = step_of(&data, &fluid, &settings, 0.1, 0);
        // SAFETY: cmd is recording and never submitted.
        unsafe { generator.record_step(cmd, &step) }.expect("a step");
    });
    making.generator().abandon(Slot(0));
    assert_eq!(making.step(&Fluid::default(), &settings, 0.1, 1).counts, [0; 6]);
}

/// Whether a reset, a saved or a restored state was recorded before it, an abandoned step or a discarded command buffer
/// leaves neither undefined memory nor an empty state.
#[test]
fn states_outlive_what_is_discarded() {
    let gpu = Gpu::shared();
    let settings = settings();
    let mut making = Making::in_used_memory(&gpu);
    let size = making.generator().size();
    let to = making.stub.data(&vec![0; size as usize], vk::BufferUsageFlags::TRANSFER_DST);
    making.discard(|generator, cmd| {
        // SAFETY: cmd is recording and never submitted.
        unsafe {
            generator.record_reset(cmd);
            generator.record_save(cmd, to.buffer, 0);
        }
    });
    assert_eq!(making.step(&Fluid::default(), &settings, 0.1, 1).counts, [0; 6]);

    let mut other = Making::new(&gpu, &config());
    other.step(&sea(0), &settings, 0.03, 0);
    let alive = other.step(&sea(1), &settings, 0.03, 1).living().len();
    let saved = other.save();
    let mut making = Making::new(&gpu, &config());
    making.step(&sea(0), &settings, 0.03, 0);
    making.restore(&saved);
    making.generator().abandon(Slot(0));
    let left = making.step(&Fluid::default(), &settings, 1.0e-4, 2).living().len();
    assert!(left > 0 && left <= alive, "{left} of {alive}");
}

/// A step that is refused leaves the step before it, in another slot, to `abandon`.
#[test]
fn a_refused_step_does_not_keep_the_one_before() {
    let gpu = Gpu::shared();
    let settings = settings();
    let mut making = Making::in_used_memory(&gpu);
    let fluid = sea(0);
    let data = making.upload(&fluid);
    let good = step_of(&data, &fluid, &settings, 0.1, 0);
    let bad = good.with(|it| {
        it.slot = Slot(1);
        it.dt = f32::NAN;
    });
    making.discard(|generator, cmd| {
        // SAFETY: cmd is recording and never submitted.
        unsafe {
            generator.record_step(cmd, &good).expect("a step");
            generator.record_step(cmd, &bad).expect_err("no time");
        }
    });
    making.generator().abandon(Slot(0));
    assert_eq!(making.step(&Fluid::default(), &settings, 0.1, 1).counts, [0; 6]);
}

#[test]
fn mistakes_are_named() {
    let gpu = Gpu::shared();
    let bad_config = |config: GeneratorConfig| match Generator::new(&gpu.context(SLOTS), &config) {
        Err(Error::BadInput { field, .. }) => field,
        other => panic!("expected bad input, found {:?}", other.map(|_| ())),
    };
    let good = GeneratorConfig::new(100, 100);
    for (field, config) in [
        ("GeneratorConfig.max_fluid", good.with(|it| it.max_fluid = 0)),
        ("GeneratorConfig.max_particles", good.with(|it| it.max_particles = 0)),
        ("GeneratorConfig.max_particles", good.with(|it| it.max_particles = u32::MAX)),
        ("GeneratorConfig.max_stride", good.with(|it| it.max_stride = 8)),
        ("GeneratorConfig.max_stride", good.with(|it| it.max_stride = 14)),
    ] {
        assert_eq!(bad_config(config), field);
    }

    let mut making = Making::new(&gpu, &GeneratorConfig::new(100, 100));
    let data = making.stub.data(&[0; 1200], vk::BufferUsageFlags::STORAGE_BUFFER);
    let settings = settings();
    let step = GeneratorStep::new(
        Slot(0),
        [stream(&data, 0, 12), stream(&data, 0, 12)],
        Count::Cpu(100),
        0.1,
        &settings,
    )
    .with(|it| {
        it.before = HOST_WRITE;
        it.after = HOST_WRITE;
    });
    let generator = making.generator.as_mut().expect("only drop takes it");
    let mut bad = |field: &str, step: GeneratorStep<'_>| {
        // SAFETY: nothing is recorded.
        match unsafe { generator.record_step(vk::CommandBuffer::null(), &step) } {
            Err(Error::BadInput { field: named, .. }) => assert_eq!(named, field),
            other => panic!("{field}: {other:?}"),
        }
    };
    bad("GeneratorStep.slot", step.with(|it| it.slot = Slot(9)));
    bad("GeneratorStep.dt", step.with(|it| it.dt = -1.0));
    bad("GeneratorStep.dt", step.with(|it| it.dt = f32::NAN));
    bad("GeneratorStep.count", step.with(|it| it.count = Count::Cpu(101)));
    let counter = Count::Gpu { buffer: data.buffer, offset: 2 };
    bad("GeneratorStep.count.offset", step.with(|it| it.count = counter));
    bad("GeneratorStep.positions", step.with(|it| it.positions = stream(&data, 4, 12)));
    bad("GeneratorStep.velocities", step.with(|it| it.velocities = stream(&data, 0, 20)));
    bad("GeneratorStep.ids", step.with(|it| it.ids = Some(stream(&data, 1000, 4))));
    let limits = |least, most| PotentialRange { min: least, max: most };
    for (field, settings) in [
        ("GeneratorSettings.spacing", settings.with(|it| it.spacing = 0.0)),
        ("GeneratorSettings.trapped_air", settings.with(|it| it.trapped_air = limits(2.0, 1.0))),
        ("GeneratorSettings.wave_crest", settings.with(|it| it.wave_crest = limits(-1.0, 1.0))),
        ("GeneratorSettings.energy", settings.with(|it| it.energy = limits(0.0, f32::NAN))),
        ("GeneratorSettings.trapped_air_rate", settings.with(|it| it.trapped_air_rate = -1.0)),
        ("GeneratorSettings.wave_crest_rate", settings.with(|it| it.wave_crest_rate = f32::NAN)),
        (
            "GeneratorSettings.max_lifetime",
            settings.with(|it| [it.min_lifetime, it.max_lifetime] = [0.0, 1.0]),
        ),
        ("GeneratorSettings.buoyancy", settings.with(|it| it.buoyancy = 65.0)),
        ("GeneratorSettings.drag", settings.with(|it| it.drag = 1.5)),
        ("GeneratorSettings.gravity", settings.with(|it| it.gravity = [f32::NAN; 3])),
        ("GeneratorSettings.bounds", settings.with(|it| it.bounds = Some([[1.0; 3], [0.0; 3]]))),
    ] {
        bad(field, step.with(|it| it.settings = &settings));
    }
}

/// A renderer draws the generated particles without a copy.
#[test]
fn what_is_made_is_drawn() {
    let gpu = Gpu::shared();
    let size = vk::Extent2D { width: 64, height: 48 };
    let whitewater = WhitewaterConfig::new(4000).with(|it| it.max_stride = 16);
    let mut rig = Rig::lit(&gpu, &rig_config(size).with(|it| it.whitewater = Some(whitewater)), 1);
    let mut shot = Shot::new(size, Lens::Standard, 0.2, &scenes::cloud(31, 10, 6.0, 9.0));
    shot.settings.whitewater.radius = 0.05;
    let mut fluid = sea(0);
    // The water lies in front of the eye.
    let eye: Vec<_> =
        fluid.positions.iter().map(|p| [p[0] - 0.3, p[1] - 0.3, 1.5 + p[2]]).collect();
    fluid.positions = scenes::world(&shot.camera, &eye);
    let settings = settings().with(|it| it.bounds = None);
    let mut making = Making::new(&gpu, &config());
    for number in 0..4 {
        making.step(&fluid, &settings, 0.03, number);
    }
    let made = making.made(0);
    assert!(made.living().len() > 100, "{}", made.living().len());
    let water = rig.particles(&shot);
    let streams = making.generator().particles();
    let found = rig.draw_whitewater(&shot, &water.particles(), Some(streams));

    let positions: Vec<[f32; 3]> =
        made.particles.iter().map(|p| p.position.as_vec3().to_array()).collect();
    let ages: Vec<f32> = made.particles.iter().map(|p| p.age as f32).collect();
    let kinds: Vec<u32> = made.particles.iter().map(|p| p.kind).collect();
    let ids: Vec<u32> = made.particles.iter().map(|p| p.id).collect();
    let data = |bytes: &[u8]| rig.stub.data(bytes, vk::BufferUsageFlags::STORAGE_BUFFER);
    let positions = data(bytemuck::cast_slice(&positions));
    let [ages, kinds, ids] =
        [bytemuck::cast_slice(&ages), bytemuck::cast_slice(&kinds), bytemuck::cast_slice(&ids)]
            .map(data);
    let count = Count::Cpu(made.particles.len() as u32);
    let copied = WhitewaterParticles::new(stream(&positions, 0, 12), count).with(|it| {
        it.kinds = Some(stream(&kinds, 0, 4));
        it.ages = Some(stream(&ages, 0, 4));
        it.ids = Some(stream(&ids, 0, 4));
        it.before = HOST_WRITE;
        it.after = HOST_WRITE;
    });
    let expected = rig.draw_whitewater(&shot, &water.particles(), Some(copied));
    compare::same_color("generate-drawn", &found.output, &expected.output);
    let without = rig.draw_whitewater(&shot, &water.particles(), None);
    assert!(found.output != without.output, "nothing is drawn");
}
