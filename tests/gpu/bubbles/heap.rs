//! Compares a step of moving blobs with the CPU twin, and checks invariants of any heap.

use ash::vk;
use glam::{DQuat, DVec3, Quat, Vec3, Vec4};
use whitewater::bubbles::{
    BlobSimulation, BlobSimulationConfig, BlobSimulationSettings, BlobSimulationStep,
    DistanceField, Solid,
};
use whitewater::headless::Bubble;
use whitewater::{Blobs, Count, Error, Slot};

use crate::hostile::spoil;
use crate::reference::bubbles::heap::{self as twin, Blob, Cuboid, Plane};
use crate::support::device::Gpu;
use crate::support::host::{HOST_WRITE, Stub};
use crate::support::rig::stream;
use crate::support::scenes::Random;
use crate::support::tolerance::U;

/// A blob simulation and the host that records its steps.
pub struct Running {
    stub: Stub,
    pub heap: Option<BlobSimulation>,
    count: usize,
}

impl Running {
    fn new(
        gpu: &Gpu,
        blobs: &[Bubble],
        velocities: &[[f32; 3]],
        field: Option<&DistanceField>,
    ) -> Self {
        Self::stepped(gpu, (blobs, velocities), field, 0, None)
    }

    /// A simulation whose blobs may split this often.
    pub fn halving(gpu: &Gpu, blobs: &[Bubble], max_splits: u32) -> Self {
        Self::stepped(gpu, (blobs, &[]), None, max_splits, None)
    }

    /// `step` is recorded in the same command buffer that sets the blobs.
    fn stepped(
        gpu: &Gpu,
        (blobs, velocities): (&[Bubble], &[[f32; 3]]),
        field: Option<&DistanceField>,
        max_splits: u32,
        step: Option<&BlobSimulationStep<'_>>,
    ) -> Self {
        let config = BlobSimulationConfig::new(blobs.len().max(1) as u32)
            .with(|it| it.max_splits = max_splits);
        let stub = Stub::new(gpu, 1);
        let mut heap = BlobSimulation::new(&gpu.context(1), &config, field).expect("a heap");
        let mut bytes = bytemuck::cast_slice(blobs).to_vec();
        bytes.resize(bytes.len().max(64), 0);
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let data = stub.data(&bytes, usage);
        let mut speeds: Vec<[f32; 3]> = velocities.to_vec();
        speeds.resize(blobs.len().max(4), [0.0; 3]);
        let speeds = stub.data(bytemuck::cast_slice(&speeds), usage);
        let all = |offset| stream(&data, offset, size_of::<Bubble>() as u32);
        let set = Blobs::new(all(0), Count::Cpu(blobs.len() as u32)).with(|it| {
            it.rotations = Some(all(16));
            it.ids = Some(all(32));
            it.before = HOST_WRITE;
            it.after = HOST_WRITE;
        });
        // Blobs with other values are none.
        let valid = |b: &&Bubble| b.ball.iter().all(|v| v.abs() < 1.0e18);
        let largest = blobs.iter().filter(valid).map(|b| b.ball[3]).fold(0.01, f32::max);
        let drifts = stream(&speeds, 0, 12);
        // SAFETY: the commands are submitted at once, and the buffers live until their end.
        stub.run(|cmd| unsafe {
            heap.record_set(cmd, Slot(0), &set, Some(&drifts), largest).expect("set");
            step.map_or(Ok(()), |step| heap.record_step(cmd, step)).expect("a step");
        });
        let count = heap.count() as usize;
        Self { stub, heap: Some(heap), count }
    }

    pub fn step(
        &mut self,
        dt: f32,
        settings: &BlobSimulationSettings,
        solids: &[Solid],
    ) -> Result<(), Error> {
        let heap = self.heap.as_mut().expect("only drop takes it");
        let step = BlobSimulationStep::new(Slot(0), dt, settings).with_solids(solids);
        // SAFETY: submitted at once.
        self.stub.run(|cmd| unsafe { heap.record_step(cmd, &step) })
    }

    fn entries<T: bytemuck::AnyBitPattern + bytemuck::NoUninit>(&self, from: vk::Buffer) -> Vec<T> {
        let bytes = size_of::<T>() * self.count.max(1);
        let back = self.stub.sized(bytes as u64, vk::BufferUsageFlags::TRANSFER_DST);
        self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, from, &back));
        bytemuck::cast_slice(&back.bytes()[..size_of::<T>() * self.count]).to_vec()
    }

    pub fn read(&self, from: vk::Buffer) -> Vec<[f32; 4]> {
        self.entries(from)
    }

    pub fn blobs(&self) -> Vec<Blob> {
        let heap = self.heap.as_ref().expect("only drop takes it");
        let set = heap.blobs();
        let balls = self.read(set.spheres.buffer);
        let turns = self.read(set.rotations.expect("rotations").buffer);
        let ids: Vec<u32> = self.entries(set.ids.expect("ids").buffer);
        let (speeds, spins) = (self.read(heap.velocities().buffer), self.read(heap.spins().buffer));
        let vector = |v: &[f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
        let one = |i: usize| Blob {
            place: vector(&balls[i]),
            radius: balls[i][3].into(),
            speed: vector(&speeds[i]),
            spin: vector(&spins[i]),
            turn: DQuat::from_array(turns[i].map(f64::from)),
            id: ids[i],
        };
        (0..self.count).map(one).collect()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(heap) = self.heap.take() {
            // SAFETY: all work was waited for.
            unsafe { heap.destroy() };
        }
    }
}

/// Turns blobs at random. The quaternions have all lengths from 0.2 to 2.
pub fn turn_at_random(blobs: &mut [Bubble], seed: u64) {
    let mut random = Random(seed);
    for blob in blobs {
        let q = loop {
            let q = Vec4::from([0; 4].map(|_| random.between(-1.0, 1.0)));
            if q.length() > 0.2 {
                break q;
            }
        };
        blob.turn = q.to_array();
    }
}

/// Checks that blobs have the host's rotations, normalised, and its ids. The squared length has at
/// most six roundings, and its square root half of their error. The reciprocal of the root adds 4u,
/// the product with it 1u.
fn check_turns(running: &Running, blobs: &[Bubble]) {
    for (found, own) in running.blobs().iter().zip(blobs) {
        let expected = DQuat::from_array(own.turn.map(f64::from)).normalize();
        let off = (found.turn - expected).length();
        assert!(off < 8.0 * U && found.id == own.id, "{found:?}, {own:?}");
    }
}

/// Bound of a blob's turn after a step of the twin, whose spin has this error. A step turns by the
/// tangent in place of the angle, whose cube over 3 is the difference; sum, normalization and the
/// turn before have 16u.
fn turned_by(dt: f64, spin: f64, off: f64) -> f64 {
    let half = 0.5 * dt * spin;
    0.5 * dt * off + half.powi(3) / 3.0 + 16.0 * U
}

/// Blobs at random positions in a box; some overlap.
pub fn cloud(count: u32, size: [f32; 3], radius: [f32; 2], seed: u64) -> Vec<Bubble> {
    let mut random = Random(seed);
    (0..count)
        .map(|id| {
            let [x, y, z] = size.map(|edge| random.between(0.0, edge));
            let r = random.between(radius[0], radius[1]);
            Bubble {
                ball: [x - 0.5 * size[0], y + r, z - 0.5 * size[2], r],
                turn: [0.0, 0.0, 0.0, 1.0],
                id: 3 * id,
            }
        })
        .collect()
}

pub const FLOOR: Solid = Solid::Plane { normal: [0.0, 1.0, 0.0], distance: 0.0 };

/// The twin tests all pairs, and starts every step from the GPU's state, so that errors do not
/// grow. A velocity is a sum of forces with about fifty roundings each. Its bound is 64u times the
/// speed plus dt times the largest sizes of the forces:
/// - of a pair, twice (the share of the masses) the stiffness times the distance at rest plus the
///   damping times the speeds;
/// - of a solid, the solidity times the radius plus the damping times the speed, and some roundings
///   of the place;
/// - of water, the weight over the density.
///
/// The bound of a position is dt times that, plus the position's own rounding.
#[test]
fn a_step_is_the_twins() {
    let gpu = Gpu::shared();
    let settings = BlobSimulationSettings::default().with(|it| {
        it.substeps = 1;
        (it.water, it.density) = (Some(0.5), 0.25);
    });
    let mut random = Random(4);
    let mut blobs = cloud(120, [1.0, 1.2, 1.0], [0.05, 0.2], 8);
    turn_at_random(&mut blobs, 7);
    let speeds: Vec<[f32; 3]> =
        blobs.iter().map(|_| [0, 1, 2].map(|_| random.between(-1.0, 1.0))).collect();
    let mut running = Running::new(&gpu, &blobs, &speeds, None);
    check_turns(&running, &blobs);
    let slanted = Vec3::new(-0.6, 0.8, 0.0);
    let solids = [FLOOR, Solid::Plane { normal: slanted.to_array(), distance: -0.3 }];
    let planes: [Plane; 2] = [(DVec3::Y, 0.0), (slanted.as_dvec3(), f64::from(-0.3_f32))];
    let dt = 1.0 / 240.0_f32;
    let u = U;
    let (mut worst, mut touched, mut spun) = (0.0_f64, 0, 0);
    for _ in 0..12 {
        let before = running.blobs();
        running.step(dt, &settings, &solids).expect("a step");
        let expected = twin::part(&before, &planes, &settings, dt.into());
        let speed = |b: &twin::Blob| b.speed.length() + b.radius * b.spin.length();
        let fast = before.iter().chain(&expected).map(speed).fold(0.0, f64::max);
        for ((found, expected), old) in running.blobs().iter().zip(&expected).zip(&before) {
            let [stiff, rest, reach, damping] =
                [settings.stiffness, settings.rest, settings.reach, settings.normal_damping]
                    .map(f64::from);
            let [solid, held] = [settings.solidity, settings.solid_damping].map(f64::from);
            let sum = |other: &twin::Blob| old.radius + other.radius;
            let beside = |other: &&twin::Blob| {
                other.id != old.id && other.place.distance(old.place) < reach * sum(other)
            };
            let pair =
                |other: &twin::Blob| 2.0 * (stiff * rest * sum(other) + 4.0 * damping * fast);
            let pairs: f64 = before.iter().filter(beside).map(pair).sum();
            let push = pairs + 2.0 * (solid * old.radius + held * fast) + 9.81 / 0.25;
            let loose = 8.0 * u * solid * old.place.length() * f64::from(dt);
            let bound = 64.0 * u * (push * f64::from(dt) + fast) + loose;
            let off = found.speed.distance(expected.speed);
            worst = worst.max(off / bound);
            assert!(off < bound, "{found:?}, {expected:?}");
            let spin_bound = 8.0 * bound / old.radius;
            assert!(found.spin.distance(expected.spin) < spin_bound, "{found:?}, {expected:?}");
            let (turned, dt64) = ((found.turn - expected.turn).length(), f64::from(dt));
            let spin = found.spin.length().max(expected.spin.length());
            let turn_bound = turned_by(dt64, spin, spin_bound);
            assert!(turned < turn_bound && found.id == old.id, "{found:?}, {expected:?}");
            // About the blob's own axes, the same spin turns it elsewhere.
            let own = old.turn * DQuat::from_scaled_axis(dt64 * expected.spin);
            let elsewhere = [own, old.turn].map(|turn| (turn - found.turn).length());
            spun += usize::from(elsewhere.iter().all(|off| *off > 4.0 * turn_bound));
            let bound = bound * f64::from(dt) + 4.0 * u * expected.place.length();
            assert!(found.place.distance(expected.place) < bound, "{found:?}, {expected:?}");
            touched += usize::from(expected.speed.distance(old.speed) > 0.1);
        }
    }
    println!("speeds: worst {worst:.3} of the bound, {touched} pushed, {spun} turned");
    assert!(touched > 200, "only {touched} were pushed");
    assert!(spun > 200, "only {spun} were turned");
}

/// Blobs in and around a box are pushed as the twin says: off its faces, edges and corners, and
/// also from its middle. In the level box some lie exactly on its mid-planes; in the rotated one
/// they lie beside these, where rounding does not decide on the side.
#[test]
fn a_box_pushes_as_the_twins() {
    let gpu = Gpu::shared();
    let settings = BlobSimulationSettings::default().with(|it| it.substeps = 1);
    let (dt, radius, u) = (1.0 / 240.0_f32, 0.1, crate::support::tolerance::U);
    let half = Vec3::new(0.3, 0.2, 0.5);
    let turn = Quat::from_xyzw(0.1, 0.7, -0.5, 0.5).normalize();
    for (center, turn, beside) in
        [(Vec3::ZERO, Quat::IDENTITY, 0.0), (Vec3::new(0.3, -0.2, 0.1), turn, 0.01)]
    {
        // In the box's own frame; the last one does not touch it.
        let places = [
            [0.0, 0.0, 0.0],
            [0.05, 0.0, 0.0],
            [0.0, 0.1, 0.1],
            [0.25, 0.0, 0.0],
            [0.0, 0.0, 0.45],
            [-0.28, 0.1, -0.2],
            [0.36, 0.0, -0.4],
            [0.34, 0.23, 0.1],
            [-0.33, -0.23, -0.53],
            [0.0, -0.26, 0.0],
            [0.5, 0.5, 0.5],
        ];
        let blobs: Vec<_> = (0..)
            .zip(places)
            .map(|(id, place)| {
                let aside = if id == 0 { Vec3::ZERO } else { Vec3::splat(beside) };
                let at = center + turn * (Vec3::from(place) + aside);
                Bubble { ball: at.extend(radius).to_array(), turn: [0.0, 0.0, 0.0, 1.0], id }
            })
            .collect();
        let mut running = Running::new(&gpu, &blobs, &[], None);
        let solid = Solid::Box {
            center: center.to_array(),
            half_extents: half.to_array(),
            rotation: turn.to_array(),
        };
        let cuboid = Cuboid {
            center: center.as_dvec3(),
            half: half.as_dvec3(),
            turn: DQuat::from_array(turn.to_array().map(f64::from)),
        };
        let before = running.blobs();
        running.step(dt, &settings, &[solid]).expect("a step");
        let solids = |place: DVec3| vec![cuboid.out_of(place)];
        let expected = twin::part_among(&before, &solids, &settings, dt.into());
        // As for planes, but a blob may lie as deep as half the box's shortest edge, and overlaps
        // several others.
        let push = f64::from(settings.solidity * (radius + half.min_element()))
            + 8.0 * f64::from(settings.stiffness * radius);
        // They were at rest.
        let fast = expected.iter().map(|b| b.speed.length()).fold(0.0, f64::max);
        let bound = 64.0 * u * ((push + 9.81) * f64::from(dt) + fast);
        for (i, (found, expected)) in running.blobs().iter().zip(&expected).enumerate() {
            let off = [found.speed - expected.speed, found.spin - expected.spin];
            assert!(off[0].length() < bound, "{i}: {found:?}, {expected:?}");
            assert!(off[1].length() < 8.0 * bound / found.radius, "{i}: {found:?}, {expected:?}");
            let bound = bound * f64::from(dt) + 4.0 * u * expected.place.length();
            assert!(found.place.distance(expected.place) < bound, "{i}: {found:?}, {expected:?}");
        }
    }
}

/// A blob in the middle of a box, as near to both sides of it, leaves it.
#[test]
fn a_blob_amid_a_box_leaves_it() {
    let gpu = Gpu::shared();
    let settings = BlobSimulationSettings::default().with(|it| it.gravity = [0.0; 3]);
    let ball = [0.0, 1.0, 0.0, 0.1];
    let blob = Bubble { ball, turn: [0.0, 0.0, 0.0, 1.0], id: 0 };
    let mut running = Running::new(&gpu, &[blob], &[], None);
    let solid = Solid::Box {
        center: [0.0, 1.0, 0.0],
        half_extents: [0.3, 0.2, 0.5],
        rotation: [0.0, 0.0, 0.0, 1.0],
    };
    for _ in 0..30 {
        running.step(1.0 / 60.0, &settings, &[solid]).expect("a step");
    }
    let end = running.blobs()[0].place;
    assert!(end.y > 1.2 + 0.8 * 0.1, "it is still at {end}");
}

/// Solids as far off and as large as they may be leave a blob finite.
#[test]
fn the_largest_solids_leave_a_blob_finite() {
    let gpu = Gpu::shared();
    let settings = BlobSimulationSettings::default().with(|it| {
        it.solidity = 1.0e5;
        it.solid_damping = 200.0;
        it.friction = 10.0;
    });
    let most = 1.0e12;
    let rotation = Quat::from_xyzw(0.1, 0.7, -0.5, 0.5).normalize().to_array();
    let cube =
        |center: [f32; 3], edge: f32| Solid::Box { center, half_extents: [edge; 3], rotation };
    for solid in [
        Solid::Plane { normal: [0.6, 0.8, 0.0], distance: most },
        Solid::Plane { normal: [0.6, 0.8, 0.0], distance: -most },
        cube([most; 3], 0.0),
        cube([-most, most, most], most),
        cube([0.0; 3], most),
    ] {
        let mut running = Running::new(&gpu, &cloud(1, [1.0; 3], [0.02, 0.1], 3), &[], None);
        for dt in [1.0 / 60.0, 1.0] {
            running.step(dt, &settings, &[solid]).expect("a step");
        }
        let blob = running.blobs()[0];
        let finite = [blob.place, blob.speed, blob.spin].iter().all(|v| v.is_finite());
        assert!(finite, "{solid:?}: {blob:?}");
    }
}

#[test]
fn fields_out_of_their_ranges_are_errors() {
    let gpu = Gpu::shared();
    let made = |field: &DistanceField| {
        let heap = BlobSimulation::new(&gpu.context(1), &BlobSimulationConfig::new(1), Some(field));
        // SAFETY: nothing was recorded.
        heap.map(|heap| unsafe { heap.destroy() })
    };
    let good =
        DistanceField { points: [2; 3], corner: [0.0; 3], edge: 1.0, distances: vec![1.0; 8] };
    let distances = |d: f32| DistanceField { distances: vec![d; 8], ..good.clone() };
    assert!(made(&good).is_ok() && made(&distances(f32::MAX)).is_ok());
    for bad in [
        DistanceField { corner: [0.0, 1.0e38, 0.0], ..good.clone() },
        DistanceField { edge: 1.0e-40, ..good.clone() },
        DistanceField { edge: f32::NAN, ..good.clone() },
        distances(-1.0e38),
        distances(f32::NAN),
    ] {
        let result = made(&bad);
        assert!(
            matches!(result, Err(Error::BadInput { field: "DistanceField", .. })),
            "{bad:?}: {result:?}"
        );
    }
}

#[test]
fn a_heap_comes_to_rest_and_loses_energy() {
    let gpu = Gpu::shared();
    let settings = BlobSimulationSettings::default();
    let blobs = cloud(400, [1.2, 2.0, 1.2], [0.06, 0.12], 5);
    let mut running = Running::new(&gpu, &blobs, &[], None);
    let wall = |normal: [f32; 3]| Solid::Plane { normal, distance: -0.7 };
    let solids = [
        FLOOR,
        wall([1.0, 0.0, 0.0]),
        wall([-1.0, 0.0, 0.0]),
        wall([0.0, 0.0, 1.0]),
        wall([0.0, 0.0, -1.0]),
    ];
    let planes: Vec<Plane> = [DVec3::Y, DVec3::X, -DVec3::X, DVec3::Z, -DVec3::Z]
        .iter()
        .enumerate()
        .map(|(i, n)| (*n, if i == 0 { 0.0 } else { f64::from(-0.7_f32) }))
        .collect();
    let mut last = twin::energy(&running.blobs(), &planes, &settings);
    let (first, mut rises) = (last, 0.0_f64);
    for _ in 0..360 {
        running.step(1.0 / 60.0, &settings, &solids).expect("a step");
        let blobs = running.blobs();
        assert!(
            blobs.iter().all(|b| b.place.is_finite() && b.speed.length() < 30.0),
            "it explodes"
        );
        let energy = twin::energy(&blobs, &planes, &settings);
        rises = rises.max(energy - last);
        last = energy;
    }
    let blobs = running.blobs();
    let fastest = blobs.iter().map(|b| b.speed.length()).fold(0.0, f64::max);
    let deepest =
        blobs.iter().map(|b| (0.85 * b.radius - b.place.y) / b.radius).fold(0.0, f64::max);
    println!(
        "energy {first:.4} to {last:.4}, largest rise {rises:.2e}; fastest {fastest:.3} m/s, deepest {deepest:.3}"
    );
    assert!(rises <= 1.0e-4 * first.abs(), "energy rises by {rises} of {first}");
    assert!(fastest < 0.1, "{fastest} m/s after six seconds");
    assert!(deepest < 0.2, "one has sunk by {deepest} radii into the floor");
}

/// Settings in other units move blobs alike: a heap in a world of 64 units per metre is the same, 64 times as large.
/// The factor is a power of two, so that only sums in steps of absolute size can differ.
#[test]
fn a_heap_is_the_same_in_other_units() {
    let gpu = Gpu::shared();
    let metres = BlobSimulationSettings::default().with(|it| it.water = Some(0.2));
    let settings = [metres, metres.in_units(64.0)];
    let blobs = cloud(300, [0.8, 1.0, 0.8], [0.05, 0.1], 6);
    let larger = |b: &Bubble| Bubble { ball: b.ball.map(|v| 64.0 * v), ..*b };
    let wide: Vec<Bubble> = blobs.iter().map(larger).collect();
    let mut both = [&blobs, &wide].map(|b| Running::new(&gpu, b, &[], None));
    for _ in 0..20 {
        for (running, settings) in both.iter_mut().zip(&settings) {
            running.step(1.0 / 60.0, settings, &[FLOOR]).expect("a step");
        }
    }
    let [one, other] = both.each_ref().map(Running::blobs);
    let moved = blobs
        .iter()
        .zip(&one)
        .filter(|(from, to)| (f64::from(from.ball[1]) - to.place.y).abs() > 0.05);
    assert!(moved.count() > 200, "they hardly move");
    for (i, (a, b)) in one.iter().zip(&other).enumerate() {
        let apart = (64.0 * a.place).distance(b.place) / 64.0;
        assert!(apart < 1.0e-3 * a.radius, "blob {i}: {apart} m");
    }
}

/// A blob floats with the part of its height under water that its density asks for, whichever way is up.
#[test]
fn blobs_float_at_their_density_whichever_way_is_up() {
    let gpu = Gpu::shared();
    for up in [Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::new(0.6, 0.0, 0.8)] {
        let settings = BlobSimulationSettings::default()
            .with(|it| (it.water, it.density) = (Some(0.4), 0.25))
            .with_gravity(1.0, up.to_array());
        let aside = up.any_orthonormal_vector();
        let at = 0.9 * up + 0.3 * aside;
        let ball = [at.x, at.y, at.z, 0.1];
        let blob = Bubble { ball, turn: [0.0, 0.0, 0.0, 1.0], id: 0 };
        let mut running = Running::new(&gpu, &[blob], &[], None);
        for _ in 0..400 {
            running.step(1.0 / 60.0, &settings, &[]).expect("a step");
        }
        let place = running.blobs()[0].place;
        // A quarter of the diameter of 0.2 is below the water.
        let height = 0.4 + 0.1 - 0.25 * 0.2;
        let wide = up.as_dvec3();
        assert!((place.dot(wide) - height).abs() < 1.0e-3, "up {up}: {place}");
        let drifted = place.dot(aside.as_dvec3()) - 0.3;
        assert!(drifted.abs() < 1.0e-3, "up {up}: drifted by {drifted}");
    }
}

#[test]
fn the_order_of_blobs_is_no_matter_to_a_heap() {
    let gpu = Gpu::shared();
    let settings = BlobSimulationSettings::default();
    let mut random = Random(2);
    // Blobs with space between them, and more blobs in one grid cell than the pass examines.
    for (count, edge, steps) in [(300, [0.8, 1.0, 0.8], 20), (1200, [0.004; 3], 2)] {
        let blobs = cloud(count, edge, [0.05, 0.1], 6);
        let order = random.order(blobs.len());
        let turned: Vec<Bubble> = order.iter().map(|i| blobs[*i]).collect();
        let mut both = [&blobs, &turned].map(|b| Running::new(&gpu, b, &[], None));
        for _ in 0..steps {
            for running in &mut both {
                running.step(1.0 / 60.0, &settings, &[FLOOR]).expect("a step");
            }
        }
        let [one, other] = both.each_ref().map(Running::blobs);
        for (i, from) in order.iter().enumerate() {
            assert_eq!(one[*from], other[i], "blob {from} of {edge:?}");
        }
    }
}

/// A blob slides down a slope without friction, and rolls with much friction.
#[test]
fn blobs_slide_down_a_slope_that_is_steep() {
    let gpu = Gpu::shared();
    let settings = BlobSimulationSettings::default().with(|it| {
        it.cohesion = 0.0;
        it.drag = 0.0;
    });
    let run = |steep: f32, friction: f32| {
        let (sine, cosine) = steep.to_radians().sin_cos();
        let slope = Solid::Plane { normal: [sine, cosine, 0.0], distance: 0.0 };
        let r = 0.1;
        let ball = [sine * 0.085, cosine * 0.085, 0.0, r];
        let blob = Bubble { ball, turn: [0.0, 0.0, 0.0, 1.0], id: 0 };
        let mut running = Running::new(&gpu, &[blob], &[], None);
        let settings = settings.with(|it| it.friction = friction);
        for _ in 0..60 {
            running.step(1.0 / 60.0, &settings, &[slope]).expect("a step");
        }
        let b = running.blobs()[0];
        (b.speed.dot(DVec3::new(cosine.into(), f64::from(-sine), 0.0)), b.spin.z)
    };
    let g = 9.81;
    // Without friction the acceleration is g sin; rolling it is 5/7 of that, with v = w r.
    let (free, spin) = run(30.0, 0.0);
    assert!((free - 0.5 * g).abs() < 0.02 * g && spin.abs() < 1e-6, "{free} m/s, {spin}");
    let (rolling, spin) = run(30.0, 5.0);
    assert!((rolling - 0.5 * g * 5.0 / 7.0).abs() < 0.02 * g, "{rolling} m/s");
    assert!((rolling + 0.1 * spin).abs() < 0.02 * rolling, "{rolling} m/s, {spin} 1/s");
}

/// The distance field of a sphere of triangles: its distances, and a blob that falls on it.
#[test]
fn a_mesh_is_solid_by_its_field() {
    let gpu = Gpu::shared();
    let (n, radius) = (24, 0.5_f32);
    let at = |i: i32, j: i32| {
        let (a, b) = (
            std::f32::consts::PI * i as f32 / n as f32,
            std::f32::consts::TAU * j as f32 / n as f32,
        );
        [radius * a.sin() * b.cos(), radius * a.cos(), -radius * a.sin() * b.sin()]
    };
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    let field = DistanceField::of_mesh(&triangles, 0.08, 0.4).expect("a field");
    let [nx, ny, _] = field.points.map(|n| n as usize);
    // The triangles lie inside the sphere by up to the height of the arcs over their edges.
    let inside = radius * (1.0 - (std::f32::consts::PI / n as f32).cos().powi(2));
    for (i, d) in field.distances.iter().enumerate() {
        let at = [i % nx, i / nx % ny, i / nx / ny];
        let p = Vec3::from([0, 1, 2].map(|k| field.corner[k] + field.edge * at[k] as f32));
        let exact = p.length() - radius;
        assert!(
            *d >= exact - 1e-4 && *d <= exact + inside + 1e-4,
            "{d} at {p}, {exact} of the ball"
        );
    }
    let blob = Bubble { ball: [0.05, 1.0, 0.0, 0.1], turn: [0.0, 0.0, 0.0, 1.0], id: 0 };
    let mut running = Running::new(&gpu, &[blob], &[], Some(&field));
    let mut nearest = f64::INFINITY;
    for _ in 0..90 {
        running.step(1.0 / 60.0, &BlobSimulationSettings::default(), &[]).expect("a step");
        nearest = nearest.min(running.blobs()[0].place.length());
    }
    let end = running.blobs()[0];
    assert!(nearest > 0.5 + 0.06 - 0.02 && nearest < 0.62, "{nearest} m from the middle");
    assert!(end.place.y < 0.0 && end.place.x > 0.3, "it has not rolled off: {end:?}");
}

/// A mesh has at most 1024 grid points along an axis: 1022 edges from its start to its end, and one more point beyond it.
#[test]
fn a_mesh_has_as_many_points_as_a_field_may_have() {
    let long = |n: f32| [[[0.0; 3], [n, 0.0, 0.0], [0.0, 0.0, 0.5]]];
    let field = DistanceField::of_mesh(&long(1022.0), 1.0, 0.0).expect("a field");
    assert_eq!(field.points[0], 1024);
    assert!(DistanceField::of_mesh(&long(1023.0), 1.0, 0.0).is_err());
}

#[test]
fn what_is_no_blob_and_none_do_nothing() {
    let gpu = Gpu::shared();
    let good = Bubble { ball: [0.0, 1.0, 0.0, 0.1], turn: [0.0; 4], id: 1 };
    let bad = [[f32::NAN, 0.0, 0.0, 0.1], [0.0, f32::INFINITY, 0.0, 0.1], [0.0, 0.0, 0.0, -1.0]];
    let mut blobs = vec![good];
    blobs.extend(bad.map(|ball| Bubble { ball, ..good }));
    let mut all = Running::new(&gpu, &blobs, &[[f32::NAN; 3]], None);
    let mut alone = Running::new(&gpu, &[good], &[], None);
    let mut none = Running::new(&gpu, &[], &[], None);
    for running in [&mut all, &mut alone, &mut none] {
        for _ in 0..10 {
            running.step(1.0 / 60.0, &BlobSimulationSettings::default(), &[FLOOR]).expect("a step");
        }
    }
    assert_eq!(all.blobs()[0], alone.blobs()[0]);
    assert!(all.blobs()[1..].iter().all(|b| b.radius == 0.0 && b.place == DVec3::ZERO));
    assert!(alone.blobs()[0].place.y < 1.0);
    type Spoil = fn(&mut BlobSimulationSettings);
    let spoils: [(&str, Spoil); 4] = [
        ("BlobSimulationSettings.reach", |s| s.reach = 0.5),
        ("BlobSimulationSettings.stiffness", |s| s.stiffness = f32::NAN),
        ("BlobSimulationSettings.substeps", |s| s.substeps = 0),
        ("BlobSimulationSettings.density", |s| s.density = 0.0),
    ];
    for (field, spoil) in spoils {
        let mut settings = BlobSimulationSettings::default();
        spoil(&mut settings);
        let result = alone.step(1.0 / 60.0, &settings, &[]);
        assert!(
            matches!(result, Err(Error::BadInput { field: found, .. }) if found == field),
            "{field}"
        );
    }
    let flat = Solid::Plane { normal: [0.0; 3], distance: 0.0 };
    let deep = Solid::Plane { normal: [0.0, 1.0, 0.0], distance: -1.0e38 };
    let cube = |center: [f32; 3], edge: f32| Solid::Box {
        center,
        half_extents: [edge; 3],
        rotation: [0.0, 0.0, 0.0, 1.0],
    };
    for (field, dt, solids) in [
        ("BlobSimulationStep.solids", 0.01, vec![flat]),
        ("BlobSimulationStep.solids", 0.01, vec![deep]),
        ("BlobSimulationStep.solids", 0.01, vec![cube([1.0e38, 0.0, 0.0], 1.0)]),
        ("BlobSimulationStep.solids", 0.01, vec![cube([0.0; 3], 1.0e38)]),
        ("BlobSimulationStep.solids", 0.01, vec![cube([0.0; 3], -1.0)]),
        ("BlobSimulationStep.solids", 0.01, vec![FLOOR; 65]),
        ("BlobSimulationStep.dt", f32::NAN, vec![]),
    ] {
        let result = alone.step(dt, &BlobSimulationSettings::default(), &solids);
        assert!(
            matches!(result, Err(Error::BadInput { field: found, .. }) if found == field),
            "{field}"
        );
    }
}

/// One command buffer may set the blobs and move them.
#[test]
fn blobs_are_set_and_moved_in_one_command_buffer() {
    let gpu = Gpu::shared();
    let blobs = cloud(70, [0.8, 1.0, 0.8], [0.05, 0.2], 3);
    let settings = BlobSimulationSettings::default();
    let step = BlobSimulationStep::new(Slot(0), 1.0 / 60.0, &settings).with_solids(&[FLOOR]);
    let mut apart = Running::new(&gpu, &blobs, &[], None);
    apart.step(step.dt, step.settings, step.solids).expect("a step");
    let at_once = Running::stepped(&gpu, (&blobs, &[]), None, 0, Some(&step));
    let balls = |running: &Running| {
        running.read(running.heap.as_ref().expect("only drop takes it").blobs().spheres.buffer)
    };
    assert_eq!(balls(&apart), balls(&at_once));
    assert!(balls(&apart).iter().zip(&blobs).any(|(now, then)| *now != then.ball), "they move");
}

/// Two thirds of the blobs get hostile bits. All radii stay finite and all rotations normalised; the
/// other blobs stay finite in everything.
#[test]
fn hostile_bits_in_a_heap() {
    let gpu = Gpu::shared();
    let sound = cloud(300, [1.0; 3], [0.02, 0.1], 3);
    let mut words: Vec<u32> = bytemuck::cast_slice(&sound).to_vec();
    let mut speeds = vec![0x3f80_0000_u32; 900];
    let mut random = Random(4);
    spoil(&mut words, size_of::<Bubble>() / 4, &mut random);
    spoil(&mut speeds, 3, &mut random);
    let blobs: Vec<Bubble> = bytemuck::cast_slice(&words).to_vec();
    for max_splits in [0, 2] {
        let streams = (&blobs[..], bytemuck::cast_slice(&speeds));
        let mut running = Running::stepped(&gpu, streams, None, max_splits, None);
        for _ in 0..5 {
            running.step(1.0 / 60.0, &BlobSimulationSettings::default(), &[FLOOR]).expect("a step");
        }
        let after = running.blobs();
        for (i, blob) in after.iter().enumerate() {
            // A normalization has fewer roundings.
            let turned = (blob.turn.length() - 1.0).abs() < 8.0 * U;
            assert!(blob.radius.is_finite() && turned, "{i}: {blob:?}");
            // Every third blob is as it was.
            if i < sound.len() && i % 3 == 0 {
                let finite = [blob.place, blob.speed, blob.spin].iter().all(|v| v.is_finite());
                let radius = f64::from(sound[i].ball[3]);
                let kept = blob.radius == radius || max_splits > 0 && blob.radius > 0.0;
                assert!(finite && kept, "{i}: {blob:?}");
            }
        }
    }
}
