//! Compares pass `classify`, which keeps the foam phase of each particle id, with its CPU twin over
//! hundreds of steps.

use ash::vk;
use whitewater::water::WeberSettings;
use whitewater::{
    Access, Count, Error, Slot, Stream, SurfaceFoamState, SurfaceFoamStateConfig, SurfaceFoamStep,
};

use crate::hostile::spoil;
use crate::reference::classify::{self as twin, Entry, NO_ID, Particle, Phase, Phases};
use crate::spied::{only_records, spied};
use crate::support::device::Gpu;
use crate::support::host::{Data, HOST_WRITE, Stub};
use crate::support::limits::{Claims, claim};
use crate::support::rig::stream;
use crate::support::scenes::Random;
use crate::support::spy;
use crate::support::tolerance::U;

const SLOTS: u32 = 2;

/// A foam state and the host that records its steps.
struct Body<'g> {
    gpu: &'g Gpu,
    stub: Stub,
    state: Option<SurfaceFoamState>,
    steps: u32,
}

/// Foam amount and age that the shader writes for each particle of a step.
type Foam = Vec<[f32; 2]>;

impl<'g> Body<'g> {
    fn new(gpu: &'g Gpu, config: SurfaceFoamStateConfig) -> Self {
        let state = SurfaceFoamState::new(&gpu.context(SLOTS), &config).expect("a state");
        Self { gpu, stub: Stub::new(gpu, SLOTS), state: Some(state), steps: 0 }
    }

    fn state(&mut self) -> &mut SurfaceFoamState {
        self.state.as_mut().expect("only drop takes it")
    }

    /// Records a step in the next frame slot.
    fn record(&mut self, step: &SurfaceFoamStep<'_>) -> Result<(), Error> {
        let slot = self.steps % SLOTS;
        self.steps += 1;
        let cmd = self.stub.begin(slot);
        let state = self.state.as_mut().expect("only drop takes it");
        // SAFETY: cmd is recording, the slot was waited for, and all handles live until the end of
        // this function.
        let result = unsafe { state.record_step(cmd, &step.with(|it| it.slot = Slot(slot))) };
        self.stub.end(slot);
        self.stub.wait(slot);
        result
    }

    fn step(&mut self, settings: &WeberSettings, dt: f32, particles: &[Particle]) -> Foam {
        let cloud = Cloud::new(&self.stub, particles);
        self.record(&cloud.step(settings, dt)).expect("a step");
        self.foam(particles.len())
    }

    fn foam(&mut self, count: usize) -> Foam {
        let size = 8 * count.max(1) as u64;
        let back = self.stub.sized(size, vk::BufferUsageFlags::TRANSFER_DST);
        let foam = self.state().foam().buffer;
        self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, foam, &back));
        bytemuck::cast_slice(&back.bytes()[..8 * count]).to_vec()
    }

    /// The bytes of the saved state.
    fn save(&mut self) -> Vec<u8> {
        let size = self.state().size();
        let back = self.stub.sized(size, vk::BufferUsageFlags::TRANSFER_DST);
        let state = self.state.as_mut().expect("only drop takes it");
        // SAFETY: submitted at once; the buffer has the state's size.
        self.stub.run(|cmd| unsafe { state.record_save(cmd, back.buffer, 0) });
        back.bytes().to_vec()
    }

    fn restore(&mut self, saved: &[u8]) {
        let from = self.stub.data(saved, vk::BufferUsageFlags::TRANSFER_SRC);
        let state = self.state.as_mut().expect("only drop takes it");
        // SAFETY: as above.
        self.stub.run(|cmd| unsafe { state.record_restore(cmd, from.buffer, 0) });
    }
}

impl Drop for Body<'_> {
    fn drop(&mut self) {
        for slot in 0..SLOTS {
            self.stub.wait(slot);
        }
        if let Some(state) = self.state.take() {
            // SAFETY: all work was waited for.
            unsafe { state.destroy() };
        }
    }
}

/// Interleaved particles: velocity, density, id.
struct Cloud {
    data: Data,
    count: u32,
}

impl Cloud {
    fn new(stub: &Stub, particles: &[Particle]) -> Self {
        let words: Vec<u32> = particles
            .iter()
            .flat_map(|p| {
                let [x, y, z] = p.velocity.map(f32::to_bits);
                [x, y, z, p.density.to_bits(), p.id]
            })
            .collect();
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        Self { data: stub.data(bytemuck::cast_slice(&words), usage), count: particles.len() as u32 }
    }

    fn step<'a>(&self, settings: &'a WeberSettings, dt: f32) -> SurfaceFoamStep<'a> {
        SurfaceFoamStep::new(
            Slot(0),
            stream(&self.data, 0, 20),
            Count::Cpu(self.count),
            dt,
            settings,
        )
        .with(|it| {
            it.densities = Some(stream(&self.data, 12, 20));
            it.ids = Some(stream(&self.data, 16, 20));
            it.before = HOST_WRITE;
            it.after = HOST_WRITE;
        })
    }
}

fn settings() -> WeberSettings {
    WeberSettings::weber(0.05, 2500.0).with(|it| {
        it.seed = 7;
        it.air = [0.5, 0.0, -0.25];
    })
}

fn twin_settings(settings: &WeberSettings) -> twin::Settings {
    twin::Settings {
        seed: settings.seed,
        scale: settings.scale,
        threshold: settings.threshold,
        foam_lifetime: settings.foam_lifetime,
        air: settings.air,
        rest_density: settings.rest_density,
    }
}

/// Ages are equal bit for bit. The foam amount is 1 minus a quotient whose division errs by up to
/// 2.5 ulp.
fn assert_foam(name: &str, found: &Foam, expected: &[twin::Out]) {
    assert_eq!(found.len(), expected.len());
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let off = (found[0] - expected.foam).abs();
        assert!(
            f64::from(off) <= 6.0 * U,
            "{name}, particle {i}: foam {}, expected {expected:?}",
            found[0]
        );
        assert_eq!(found[1].to_bits(), expected.age.to_bits(), "{name}, particle {i}: age");
    }
}

/// The saved rows are the twin's entries bit for bit, and there are no others.
fn assert_state(name: &str, saved: &[u8], phases: &Phases) {
    let words: &[u32] = bytemuck::cast_slice(saved);
    let mut rows = 0;
    for row in words.chunks_exact(5).filter(|row| row[0] != 0) {
        rows += 1;
        let id = row[0].wrapping_sub(1);
        let entry = phases.entry(id).unwrap_or_else(|| panic!("{name}: {id} is forgotten"));
        let Entry { phase, transitions, timer, lifetime, age } = *entry;
        let phase = match phase {
            Phase::Water => 0,
            Phase::WaterToFoam => 1,
            Phase::Foam => 2,
            Phase::FoamToWater => 3,
        };
        let expected =
            [transitions << 2 | phase, timer.to_bits(), lifetime.to_bits(), age.to_bits()];
        assert_eq!(row[1..], expected, "{name}: state of {id}");
    }
    assert_eq!(rows, phases.map.len(), "{name}: rows");
}

/// Water that becomes turbulent now and then. Some particles vanish, others are born, and the order
/// changes.
struct Sea {
    random: Random,
    particles: Vec<Particle>,
    next: u32,
}

impl Sea {
    fn new(count: usize) -> Self {
        let mut sea = Self { random: Random(5), particles: Vec::new(), next: 0 };
        for _ in 0..count {
            sea.bear();
        }
        sea
    }

    fn bear(&mut self) {
        // The ids are not consecutive, and the largest permitted id is among them.
        let id = self.next.wrapping_mul(2_654_435_761).wrapping_add(NO_ID - 1);
        self.next += 1;
        if id != NO_ID {
            self.particles.push(Particle { id, velocity: [0.0; 3], density: 1000.0 });
        }
    }

    fn step(&mut self) -> &[Particle] {
        for _ in 0..3 {
            let gone = self.random.bits() % self.particles.len() as u64;
            self.particles.swap_remove(gone as usize);
            self.bear();
        }
        for p in &mut self.particles {
            for v in &mut p.velocity {
                *v = 0.93 * *v + self.random.between(-1.0, 1.0);
            }
            p.density = self.random.between(300.0, 1100.0);
        }
        let order = self.random.order(self.particles.len());
        self.particles = order.iter().map(|i| self.particles[*i]).collect();
        &self.particles
    }
}

/// A step neither waits nor submits, and makes no memory and no pipelines.
#[test]
fn a_step_only_records() {
    let gpu = spied();
    let mut body = Body::new(&gpu, SurfaceFoamStateConfig::new(700).with(|it| it.max_stride = 20));
    let (settings, mut sea) = (settings(), Sea::new(700));
    let cloud = Cloud::new(&body.stub, sea.step());
    let step = cloud.step(&settings, 0.02);
    for _ in 0..3 {
        let cmd = body.stub.begin(0);
        let state = body.state.as_mut().expect("only drop takes it");
        // SAFETY: cmd is recording, the slot was waited for, and all handles outlive the step.
        only_records(&gpu, "step", || unsafe { state.record_step(cmd, &step) });
        body.stub.end(0);
        body.stub.wait(0);
    }
}

#[test]
fn phases_are_the_twins_over_hundreds_of_steps() {
    let gpu = Gpu::shared();
    let mut body = Body::new(&gpu, SurfaceFoamStateConfig::new(700).with(|it| it.max_stride = 20));
    let (settings, mut phases, mut sea) = (settings(), Phases::default(), Sea::new(700));
    let mut most = [0_usize; 4];
    for step in 0..400 {
        let dt = [1.0 / 60.0, 1.0 / 24.0, 0.0][step % 3];
        let particles = sea.step().to_vec();
        let expected = phases.step(&twin_settings(&settings), dt, &particles);
        let found = body.step(&settings, dt, &particles);
        let name = format!("step {step}");
        assert_foam(&name, &found, &expected);
        for (i, phase) in
            [Phase::Water, Phase::WaterToFoam, Phase::Foam, Phase::FoamToWater].iter().enumerate()
        {
            most[i] = most[i].max(expected.iter().filter(|out| out.phase == *phase).count());
        }
        if step % 50 == 0 || step == 399 {
            assert_state(&name, &body.save(), &phases);
        }
    }
    assert!(most.iter().all(|n| *n > 30), "the sea is too calm or too wild: {most:?}");
}

/// Saving and restoring the state between steps does not change the foam by a bit.
#[test]
fn a_saved_state_goes_on_as_if_uncut() {
    let gpu = Gpu::shared();
    let config = SurfaceFoamStateConfig::new(300).with(|it| it.max_stride = 20);
    let settings = settings();
    let mut whole = Body::new(&gpu, config);
    let mut part = Body::new(&gpu, config);
    let mut sea = Sea::new(300);
    for step in 0..60 {
        let particles = sea.step().to_vec();
        let expected = whole.step(&settings, 0.05, &particles);
        if step % 7 == 3 {
            let saved = part.save();
            part = Body::new(&gpu, config);
            part.restore(&saved);
        }
        assert_eq!(part.step(&settings, 0.05, &particles), expected, "step {step}");
    }
}

/// If the device binds only a part of the tables and of the particles at once, the results are the
/// same.
#[test]
fn tables_in_parts_hold_the_same_state() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let config = SurfaceFoamStateConfig::new(700).with(|it| it.max_stride = 20);
    let (settings, mut phases, mut sea) = (settings(), Phases::default(), Sea::new(700));
    let steps: Vec<Vec<Particle>> = (0..40).map(|_| sea.step().to_vec()).collect();
    let run = |gpu: &Gpu, looks: &dyn Fn(u64)| -> (Vec<Foam>, Vec<u8>) {
        let mut body = Body::new(gpu, config);
        let mut foam = Vec::new();
        for (i, particles) in steps.iter().enumerate() {
            let cloud = Cloud::new(&body.stub, particles);
            let step = cloud.step(&settings, 0.05);
            drop(spy::take_bound());
            // Every ninth step has no ids, which clears the table in both runs.
            let step = if i % 9 == 8 { step.with(|it| it.ids = None) } else { step };
            body.record(&step).expect("a step");
            let bytes = (cloud.data.buffer, cloud.data.size);
            let foamed = (body.state().foam().buffer, 8 * 700);
            for bound in spy::take_bound() {
                let table = bound.range == vk::WHOLE_SIZE && bound.buffer != bytes.0;
                assert!(!table, "of a buffer of unknown size: {bound:?}");
                looks(bound.bytes(&[bytes, foamed]));
            }
            foam.push(body.foam(particles.len()));
        }
        (foam, body.save())
    };
    let (whole, saved) = run(&gpu, &|_| {});
    // A binding holds 250 rows of the table, or 237 particles of 20 bytes, which is rounded down to
    // 224.
    let claims = Claims { max_storage_buffer_range: Some(5000), ..Claims::default() };
    claim(&mut gpu, claims);
    let gpu = gpu;
    let longest = std::cell::Cell::new(0);
    let (parts, in_parts) = run(&gpu, &|bytes| longest.set(longest.get().max(bytes)));
    assert!(longest.get() <= 5000, "{} bytes bound", longest.get());
    assert!(in_parts.len() > saved.len(), "of one part: {} bytes", in_parts.len());
    for (i, (parts, whole)) in parts.iter().zip(&whole).enumerate() {
        assert_eq!(parts, whole, "step {i}");
    }
    for (i, particles) in steps.iter().enumerate() {
        if i % 9 == 8 {
            phases = Phases::default();
        } else {
            let _ = phases.step(&twin_settings(&settings), 0.05, particles);
        }
    }
    assert_state("whole", &saved, &phases);
    assert_state("parts", &in_parts, &phases);
}

/// More ids than a device binds at once that has the common limit of 128 MiB, which is 4 473 924
/// rows.
#[test]
fn a_step_of_millions_of_ids() {
    if !crate::support::slow() {
        return crate::support::skipped::skipped(
            "millions of particles take long: WHITEWATER_SLOW=1 has them",
        );
    }
    const COUNT: usize = 4_800_000;
    let gpu = Gpu::shared();
    let config = SurfaceFoamStateConfig::new(COUNT as u32).with(|it| it.max_stride = 20);
    let mut body = Body::new(&gpu, config);
    assert!(body.state().size() > 128 << 20, "{} bytes of state", body.state().size());
    let (settings, mut phases, mut sea) = (settings(), Phases::default(), Sea::new(COUNT));
    for step in 0..3 {
        let mut particles = sea.step().to_vec();
        // In two steps, water that begins at rest would not become foam without this factor.
        particles.iter_mut().for_each(|p| p.velocity = p.velocity.map(|v| 4.0 * v));
        let expected = phases.step(&twin_settings(&settings), 0.25, &particles);
        let found = body.step(&settings, 0.25, &particles);
        let foam = expected.iter().filter(|out| out.foam > 0.0).count();
        eprintln!("step {step}: {foam} of {COUNT} foam");
        assert!(step == 0 || foam > COUNT / 100, "step {step}: {foam} foam");
        assert_foam(&format!("step {step}"), &found, &expected);
    }
    assert_state("millions", &body.save(), &phases);
}

/// A step whose commands were thrown away leaves the state unchanged.
#[test]
fn an_abandoned_step_leaves_the_state_before_it() {
    let gpu = Gpu::shared();
    let mut body = Body::new(&gpu, SurfaceFoamStateConfig::new(100).with(|it| it.max_stride = 20));
    let (settings, mut phases, mut sea) = (settings(), Phases::default(), Sea::new(100));
    for _ in 0..9 {
        let particles = sea.step().to_vec();
        let cloud = Cloud::new(&body.stub, &particles);
        body.stub.wait(0);
        let cmd = body.stub.begin(0);
        let state = body.state.as_mut().expect("only drop takes it");
        // SAFETY: cmd is recording and never submitted.
        unsafe { state.record_step(cmd, &cloud.step(&settings, 0.1)) }.expect("a step");
        state.abandon(Slot(0));
        body.steps = 1;
        let particles = sea.step().to_vec();
        let expected = phases.step(&twin_settings(&settings), 0.1, &particles);
        let found = body.step(&settings, 0.1, &particles);
        assert_foam("after an abandoned step", &found, &expected);
    }
    assert_state("after abandoned steps", &body.save(), &phases);
}

/// Abandoning the first step, which was never executed, leaves an empty state and not the memory's
/// old contents.
#[test]
fn an_abandoned_first_step_leaves_an_empty_state() {
    let gpu = Gpu::shared();
    let config = SurfaceFoamStateConfig::new(100).with(|it| it.max_stride = 20);
    let settings = settings();
    // The allocator probably hands out this memory, filled with 0x5a, to the next state.
    let mut before = Body::new(&gpu, config);
    let size = before.state().size() as usize;
    before.restore(&vec![0x5a; size]);
    drop(before);
    let mut body = Body::new(&gpu, config);
    let mut sea = Sea::new(100);
    let cloud = Cloud::new(&body.stub, sea.step());
    let to = body.stub.data(&vec![0; size], vk::BufferUsageFlags::TRANSFER_DST);
    body.stub.wait(0);
    let cmd = body.stub.begin(0);
    let state = body.state.as_mut().expect("only drop takes it");
    // SAFETY: cmd is recording and never submitted.
    unsafe {
        // Nor does a reset or a save that is never executed.
        state.record_reset(cmd);
        state.record_save(cmd, to.buffer, 0);
        state.record_step(cmd, &cloud.step(&settings, 0.1)).expect("a step");
    }
    state.abandon(Slot(0));
    state.abandon(Slot(0));
    assert!(body.save().iter().all(|byte| *byte == 0), "rows of another's");
}

/// A reset or restore after a step replaces what the step wrote, so abandoning the step must not
/// undo it.
#[test]
fn an_abandoned_step_does_not_undo_a_reset_or_a_restore() {
    let gpu = Gpu::shared();
    let config = SurfaceFoamStateConfig::new(100).with(|it| it.max_stride = 20);
    let (settings, mut sea) = (settings(), Sea::new(100));
    for restored in [true, false] {
        let mut body = Body::new(&gpu, config);
        for _ in 0..9 {
            body.step(&settings, 0.1, sea.step());
        }
        let saved = body.save();
        assert!(saved.iter().any(|byte| *byte != 0));
        // After only one step the previous table would be the saved one, and the fault would not
        // show.
        for _ in 0..2 {
            body.steps = 0;
            body.step(&settings, 0.1, sea.step());
        }
        let wanted = if restored {
            body.restore(&saved);
            saved
        } else {
            let state = body.state.as_mut().expect("only drop takes it");
            // SAFETY: submitted at once, after the step.
            body.stub.run(|cmd| unsafe { state.record_reset(cmd) });
            vec![0; saved.len()]
        };
        body.state().abandon(Slot(0));
        assert!(body.save() == wanted, "restored {restored}: another state");
    }
}

/// Counts on the GPU, separate streams, no densities, no ids, and no particles.
#[test]
fn every_kind_of_input() {
    let gpu = Gpu::shared();
    let mut body = Body::new(&gpu, SurfaceFoamStateConfig::new(400));
    let (settings, mut phases, mut sea) = (settings(), Phases::default(), Sea::new(400));
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    for step in 0..40 {
        let mut particles = sea.step().to_vec();
        particles.truncate(if step % 9 == 4 { 0 } else { 300 + step });
        let velocities: Vec<[f32; 3]> = particles.iter().map(|p| p.velocity).collect();
        let ids: Vec<u32> = particles.iter().map(|p| p.id).collect();
        let velocity_data = body.stub.data(bytemuck::cast_slice(&velocities), storage);
        let id_data = body.stub.data(bytemuck::cast_slice(&ids), storage);
        let counts = [0, 0, 0, 0, particles.len() as u32];
        let from_gpu = body.gpu.limits().min_storage_buffer_offset_alignment <= 16;
        let count_data = body.stub.data(bytemuck::cast_slice(&counts), storage);
        for p in &mut particles {
            p.density = settings.rest_density;
        }
        let count = match from_gpu && step % 2 == 0 {
            true => Count::Gpu { buffer: count_data.buffer, offset: 16 },
            false => Count::Cpu(particles.len() as u32),
        };
        let whole =
            SurfaceFoamStep::new(Slot(0), stream(&velocity_data, 0, 12), count, 0.03, &settings)
                .with(|it| {
                    it.ids = Some(stream(&id_data, 0, 4));
                    it.before = HOST_WRITE;
                    it.after = HOST_WRITE;
                });
        body.record(&whole).expect("a step");
        let expected = phases.step(&twin_settings(&settings), 0.03, &particles);
        let found = body.foam(particles.len());
        assert_foam(&format!("step {step}"), &found, &expected);
    }
    assert_state("other streams", &body.save(), &phases);

    let particles = sea.step().to_vec();
    let cloud = Cloud::new(&body.stub, &particles);
    let mut wide = Body::new(&gpu, SurfaceFoamStateConfig::new(400).with(|it| it.max_stride = 20));
    let step = cloud.step(&settings, 0.1);
    wide.record(&step.with(|it| it.ids = None)).expect("a step");
    for (p, found) in particles.iter().zip(wide.foam(particles.len())) {
        let expected = twin::stateless(&twin_settings(&settings), p.velocity, p.density);
        // The division errs by 2.5 ulp, for numbers up to 1.5.
        assert!(f64::from((found[0] - expected).abs()) <= 8.0 * U, "{found:?}, not {expected}");
    }
}

/// Particles with NaN or infinite velocities are not foam and do not affect others. A density of 0,
/// below 0 or NaN counts as the rest density, so the particle foams like others of its speed.
#[test]
fn broken_particles() {
    let gpu = Gpu::shared();
    let mut body = Body::new(&gpu, SurfaceFoamStateConfig::new(8).with(|it| it.max_stride = 20));
    let (settings, mut phases) = (settings(), Phases::default());
    let of = |id, speed, density| Particle { id, velocity: [speed, 0.0, 0.0], density };
    let particles = [
        of(1, f32::NAN, 1000.0),
        of(2, f32::INFINITY, 1000.0),
        of(3, 9.0, f32::NAN),
        of(4, 9.0, 0.0),
        of(5, 9.0, -1.0),
        of(6, 9.0, 1000.0),
        of(NO_ID, 9.0, 1000.0),
        of(NO_ID, 9.0, 1000.0),
    ];
    for _ in 0..20 {
        let expected = phases.step(&twin_settings(&settings), 0.05, &particles);
        assert_foam("broken", &body.step(&settings, 0.05, &particles), &expected);
    }
    assert!(body.foam(6)[2..].iter().all(|foam| foam[0] > 0.99), "those with a speed are foam");
    assert!(body.foam(6)[0][0] == 0.0, "the one without is not");
    // Two particles with the same id: no crash, and one of them is kept.
    let twins = [of(6, 9.0, 1000.0), of(6, 9.0, 1000.0)];
    assert!(body.step(&settings, 0.05, &twins).iter().all(|foam| foam[0] > 0.99));
}

#[test]
fn bad_steps_are_errors() {
    let gpu = Gpu::shared();
    let mut body = Body::new(&gpu, SurfaceFoamStateConfig::new(10).with(|it| it.max_stride = 20));
    let mut sea = Sea::new(10);
    let cloud = Cloud::new(&body.stub, sea.step());
    let settings = settings();
    let good = cloud.step(&settings, 0.1);
    body.record(&good).expect("a good step");
    let wide = Stream { stride: 24, ..good.velocities };
    let never = settings.with(|it| it.threshold = 0.0);
    let bad: [(&str, SurfaceFoamStep<'_>); 7] = [
        ("SurfaceFoamStep.dt", good.with(|it| it.dt = f32::NAN)),
        ("SurfaceFoamStep.dt", good.with(|it| it.dt = -0.1)),
        ("SurfaceFoamStep.count", good.with(|it| it.count = Count::Cpu(11))),
        ("SurfaceFoamStep.velocities", good.with(|it| it.velocities = wide)),
        (
            "SurfaceFoamStep.ids",
            good.with(|it| it.ids = Some(Stream { offset: 18, ..good.velocities })),
        ),
        (
            "SurfaceFoamStep.densities",
            good.with(|it| it.densities = Some(Stream { size: 9, ..good.velocities })),
        ),
        ("WeberSettings.threshold", good.with(|it| it.settings = &never)),
    ];
    for (field, step) in bad {
        match body.record(&step) {
            Err(Error::BadInput { field: found, .. }) => assert_eq!(found, field),
            other => panic!("{field}: {other:?}"),
        }
    }
    let nothing = Access::new(
        vk::PipelineStageFlags2::NONE,
        vk::AccessFlags2::NONE,
        vk::ImageLayout::UNDEFINED,
    );
    body.record(&good.with(|it| it.before = nothing)).expect("as before");
    for config in [
        SurfaceFoamStateConfig::new(0),
        SurfaceFoamStateConfig::new(1).with(|it| it.max_stride = 6),
        SurfaceFoamStateConfig::new(u32::MAX),
    ] {
        match SurfaceFoamState::new(&gpu.context(1), &config) {
            Err(Error::BadInput { .. }) => {}
            Err(other) => panic!("{config:?}: {other}"),
            Ok(_) => panic!("{config:?} is accepted"),
        }
    }
}

/// A step ends with any bits in the streams and in a restored state. From hostile streams it writes
/// amounts between 0 and 1.
#[test]
fn hostile_bits_in_a_step() {
    let gpu = Gpu::shared();
    let mut body = Body::new(&gpu, SurfaceFoamStateConfig::new(600).with(|it| it.max_stride = 20));
    let (settings, mut random) = (settings(), Random(9));
    let mut words = vec![0x4120_0000_u32; 5 * 600];
    for (i, id) in words.iter_mut().skip(4).step_by(5).enumerate() {
        *id = i as u32;
    }
    spoil(&mut words, 5, &mut random);
    let particle = |w: &[u32]| Particle {
        velocity: [w[0], w[1], w[2]].map(f32::from_bits),
        density: f32::from_bits(w[3]),
        id: w[4],
    };
    let particles: Vec<_> = words.chunks(5).map(particle).collect();
    for _ in 0..3 {
        let foam = body.step(&settings, 0.02, &particles);
        let bad = foam.iter().filter(|foam| !(0.0..=1.0).contains(&foam[0])).count();
        assert_eq!(bad, 0, "shares of foam that are none");
    }
    let mut saved: Vec<u32> = bytemuck::pod_collect_to_vec(&body.save());
    spoil(&mut saved, 1, &mut random);
    // The second table has no free row.
    for all in [saved, vec![0xdead_beef; body.state().size() as usize / 4]] {
        body.restore(bytemuck::cast_slice(&all));
        body.step(&settings, 0.02, &particles);
    }
}
