//! Divergence-free SPH: Bender & Koschier, "Divergence-Free Smoothed Particle Hydrodynamics"
//! (2015), and "Divergence-Free SPH for Incompressible and Viscous Fluids" (2017).
//!
//! Each step makes the velocities free of divergence, applies gravity, viscosity and cohesion, and
//! then makes them such that the density after the step is the rest density. Both corrections are
//! one and the same relaxed Jacobi iteration for impulses `P = Δt p/ρ²` that push particles apart
//! and never pull; only the source term differs.
//!
//! Solids enter the density as in Koschier & Bender, "Density Maps for Improved SPH Boundary
//! Handling" (2017), by the part of the kernel that they cover, here of a half-space at the signed
//! distance of the solid.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use rayon::prelude::*;

use crate::bgeo::Frame;
use crate::kernel::Kernel;
use crate::neighbours::{BLOCK, Grid, NeighbourBlock};
use crate::scene::{self, Scene};

/// The rest density of water.
pub const REST_DENSITY: f32 = 1000.0;
const GRAVITY: Vec3 = Vec3::new(0.0, -9.81, 0.0);
/// Kinematic viscosity, m²/s: that of the resolved scale, not of water.
const VISCOSITY: f32 = 0.004;
/// The coefficient of the cohesion of Akinci et al., "Versatile Surface Tension and Adhesion for
/// SPH Fluids" (2013).
const COHESION: f32 = 0.4;
/// How fast a solid slows the water that touches it, 1/s.
const WALL_FRICTION: f32 = 0.6;
/// How far above a solid the half-space begins that the density sees, and how close a particle may
/// come, in spacings: particles come to rest half a spacing above a solid, as spheres lie on it.
const WALL_OFFSET: f32 = 0.2;
const CLEARANCE: f32 = 0.5;
/// The relaxation of the Jacobi iteration.
const RELAXATION: f32 = 0.5;
/// The mean compression, and the mean compression per step, at which the iterations end.
const DENSITY_TOLERANCE: f32 = 5e-4;
const DIVERGENCE_TOLERANCE: f32 = 1e-3;
const MOST_ITERATIONS: u32 = 100;
/// With fewer neighbours a particle is spray: its divergence means nothing.
const SPRAY_NEIGHBOURS: usize = 20;
/// The part of a spacing that a particle may move in a step, and the longest step.
const COURANT: f32 = 0.4;
const LONGEST_STEP: f32 = 1.0 / 300.0;
/// The time before frame 0 in which the pool settles, and how fast its motion is damped then.
const SETTLING: f32 = 0.8;
const SETTLING_DAMPING: f32 = 8.0;

/// What the last step did.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepReport {
    /// Iterations of the divergence solver.
    pub divergence_iterations: u32,
    /// Iterations of the density solver.
    pub density_iterations: u32,
}

/// The simulation.
pub struct Simulation {
    scene: Scene,
    kernel: Kernel,
    grid: Grid,
    spacing: f32,
    mass: f32,
    seed: u32,
    /// Seconds since frame 0; negative while the pool settles.
    time: f32,
    waves_started: bool,

    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    id: Vec<u32>,
    /// The density solver's impulses divided by the step, kept as its next first guess.
    pressure: Vec<f32>,

    // Of the present positions.
    fresh: bool,
    neighbours: Vec<NeighbourBlock>,
    density: Vec<f32>,
    /// `ρ₀ ∇λ`, the solids' part of the gradient of the density.
    wall: Vec<Vec3>,
    /// `1 / (|Σ m ∇W|² + Σ |m ∇W|²)`, solids included.
    factor: Vec<f32>,

    next_id: u32,
    lost: u32,
    /// How far the last layer has left the inlet.
    inflow_gap: f32,
    inflow_layers: u32,
    report: StepReport,
}

/// A hash of three numbers to the unit interval: random numbers that no order of calls changes.
fn noise(seed: u32, index: u32, stream: u32) -> f32 {
    // Multiplications and shifts that mix all bits, the constants of the finaliser of MurmurHash3.
    let mut h = seed ^ index.wrapping_mul(0x9e37_79b9) ^ stream.wrapping_mul(0x85eb_ca77);
    for _ in 0..2 {
        h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
        h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
        h ^= h >> 16;
    }
    (h >> 8) as f32 / (1u32 << 24) as f32
}

fn jitter(seed: u32, index: u32) -> Vec3 {
    Vec3::new(noise(seed, index, 1) - 0.5, noise(seed, index, 2) - 0.5, noise(seed, index, 3) - 0.5)
}

/// `f` for every particle, in parallel, written to `out`.
fn for_each<T: Send>(
    out: &mut [T],
    neighbours: &[NeighbourBlock],
    f: impl Fn(usize, usize, &NeighbourBlock, &mut T) + Sync,
) {
    out.par_chunks_mut(BLOCK).zip(neighbours).enumerate().for_each(|(block, (out, near))| {
        for (local, value) in out.iter_mut().enumerate() {
            f(block * BLOCK + local, local, near, value);
        }
    });
}

impl Simulation {
    /// The pool at rest, before it settles.
    pub fn new(scene: Scene, spacing: f32, seed: u32) -> Self {
        let kernel = Kernel::new(2.0 * spacing);
        let mass = REST_DENSITY / kernel.lattice_sum(spacing);
        let grid =
            Grid::new(Vec3::new(-2.9, -0.2, -1.5), Vec3::new(2.1, 2.6, 1.5), kernel.support());
        let mut simulation = Self {
            scene,
            kernel,
            grid,
            spacing,
            mass,
            seed,
            time: -SETTLING,
            waves_started: false,
            position: Vec::new(),
            velocity: Vec::new(),
            id: Vec::new(),
            pressure: Vec::new(),
            fresh: false,
            neighbours: Vec::new(),
            density: Vec::new(),
            wall: Vec::new(),
            factor: Vec::new(),
            next_id: 0,
            lost: 0,
            inflow_gap: 0.0,
            inflow_layers: 0,
            report: StepReport::default(),
        };
        simulation.fill_pool();
        simulation
    }

    fn spawn(&mut self, at: Vec3, velocity: Vec3) {
        self.position.push(at);
        self.velocity.push(velocity);
        self.id.push(self.next_id);
        self.pressure.push(0.0);
        self.next_id += 1;
        self.fresh = false;
    }

    /// Fills the pool by a lattice so jittered that it settles to a packing without visible layers.
    fn fill_pool(&mut self) {
        let h = self.spacing;
        // Solids begin where the density sees them begin.
        let inset = WALL_OFFSET * h;
        let [half_x, half_z] = scene::BASIN_HALF.map(|half| half - inset);
        let size = Vec3::new(2.0 * half_x, scene::POOL_DEPTH, 2.0 * half_z);
        let count = (size / h).round().as_ivec3();
        let cell = size / count.as_vec3();
        let low = Vec3::new(-half_x, inset, -half_z);
        let margin = (CLEARANCE - WALL_OFFSET) * h;
        for y in 0..count.y {
            for z in 0..count.z {
                for x in 0..count.x {
                    let lattice = Vec3::new(x as f32, y as f32, z as f32) + 0.5;
                    let number = ((y * count.z + z) * count.x + x) as u32;
                    let at = low + cell * (lattice + 0.9 * jitter(self.seed, number));
                    let at = at.max(low + margin);
                    let at = at.min(Vec3::new(half_x - margin, f32::MAX, half_z - margin));
                    if self.nearest_solid(at) > 0.4 * h {
                        self.spawn(at, Vec3::ZERO);
                    }
                }
            }
        }
    }

    /// Sets standing waves going: the velocity of the linear potential flow in a basin, as it
    /// passes through the flat surface.
    fn start_waves(&mut self) {
        let [half_x, half_z] = scene::BASIN_HALF;
        let depth = scene::POOL_DEPTH;
        // (half waves along x, half waves along z, amplitude in metres)
        for (m, n, amplitude) in
            [(2.0, 0.0, 0.020), (3.0, 1.0, 0.014), (1.0, 2.0, 0.012), (5.0, 3.0, 0.006)]
        {
            let kx: f32 = PI * m / (2.0 * half_x);
            let kz: f32 = PI * n / (2.0 * half_z);
            let k = kx.hypot(kz);
            let omega = (9.81 * k * (k * depth).tanh()).sqrt();
            let scale = amplitude * omega / (k * (k * depth).sinh());
            for (at, velocity) in self.position.iter().zip(&mut self.velocity) {
                let (sx, cx) = (kx * (at.x + half_x)).sin_cos();
                let (sz, cz) = (kz * (at.z + half_z)).sin_cos();
                let (cosh, sinh) = ((k * at.y).cosh(), (k * at.y).sinh());
                *velocity += scale
                    * Vec3::new(-kx * sx * cz * cosh, k * cx * cz * sinh, -kz * cx * sz * cosh);
            }
        }
    }

    fn nearest_solid(&self, at: Vec3) -> f32 {
        let distances = self.scene.solids.iter().map(|solid| solid.distance(at).0);
        distances.fold(f32::MAX, f32::min)
    }

    /// The part of the kernel at `at` that solids cover, and its gradient. Solids that meet at an
    /// edge overlap; what they leave free is taken to be the product of what each leaves free,
    /// which is exact for a particle in the corner of perpendicular walls.
    fn covered(&self, at: Vec3) -> (f32, Vec3) {
        let mut free = 1.0;
        let mut gradient = Vec3::ZERO;
        for solid in &self.scene.solids {
            let (d, normal) = solid.distance(at);
            let d = d - WALL_OFFSET * self.spacing;
            if d < self.kernel.support() {
                let (part, slope) = self.kernel.half_space(d);
                gradient = gradient * (1.0 - part) - normal * (slope * free);
                free *= 1.0 - part;
            }
        }
        (1.0 - free, gradient)
    }

    /// Sorts the particles and finds neighbours, densities and factors of their positions.
    fn refresh(&mut self) {
        if self.fresh {
            return;
        }
        let order = self.grid.sort(&self.position);
        fn arranged<T: Copy>(values: &[T], order: &[u32]) -> Vec<T> {
            order.iter().map(|&i| values[i as usize]).collect()
        }
        self.position = arranged(&self.position, &order);
        self.velocity = arranged(&self.velocity, &order);
        self.id = arranged(&self.id, &order);
        self.pressure = arranged(&self.pressure, &order);
        self.neighbours = self.grid.neighbours(&self.position, &self.kernel, self.mass);

        let mut all = vec![(0.0, Vec3::ZERO, 0.0); self.position.len()];
        for_each(&mut all, &self.neighbours, |i, local, near, out| {
            let at = self.position[i];
            let (part, gradient) = self.covered(at);
            let wall = REST_DENSITY * gradient;
            let mut density = self.mass * self.kernel.value(0.0) + REST_DENSITY * part;
            let (mut sum, mut squares) = (wall, 0.0);
            for (j, g) in near.of(local) {
                density += self.mass * self.kernel.value(at.distance(self.position[j]));
                sum += g;
                squares += g.length_squared();
            }
            let diagonal = sum.length_squared() + squares;
            *out = (density, wall, if diagonal > 1e-3 { 1.0 / diagonal } else { 0.0 });
        });
        self.density = all.iter().map(|a| a.0).collect();
        self.wall = all.iter().map(|a| a.1).collect();
        self.factor = all.iter().map(|a| a.2).collect();
        self.fresh = true;
    }

    /// The rate of change of the density, `Dρ/Dt`, for these velocities.
    fn density_rate(&self, velocity: &[Vec3]) -> Vec<f32> {
        let mut rate = vec![0.0; velocity.len()];
        for_each(&mut rate, &self.neighbours, |i, local, near, out| {
            let own = velocity[i];
            let sum: f32 = near.of(local).map(|(j, g)| (own - velocity[j]).dot(g)).sum();
            *out = sum + own.dot(self.wall[i]);
        });
        rate
    }

    /// The change of velocity by impulses.
    fn impulse(&self, strength: &[f32]) -> Vec<Vec3> {
        let mut change = vec![Vec3::ZERO; strength.len()];
        for_each(&mut change, &self.neighbours, |i, local, near, out| {
            let own = strength[i];
            let mut sum = own * self.wall[i];
            for (j, g) in near.of(local) {
                sum += (own + strength[j]) * g;
            }
            *out = -sum;
        });
        change
    }

    /// Finds impulses that take away the part of `source` (a rate of compression) above zero,
    /// applies them to the velocities, and returns them with the number of iterations.
    fn project(
        &mut self,
        source: &[f32],
        mut strength: Vec<f32>,
        tolerance: f32,
        least: u32,
    ) -> (Vec<f32>, u32) {
        let mut iterations = 0;
        let change = loop {
            let change = self.impulse(&strength);
            let rate = self.density_rate(&change);
            let error: f64 = strength
                .par_chunks_mut(BLOCK)
                .enumerate()
                .map(|(block, strength)| {
                    let mut error = 0.0;
                    for (local, value) in strength.iter_mut().enumerate() {
                        let i = block * BLOCK + local;
                        let residual = source[i] + rate[i];
                        *value = (*value + RELAXATION * residual * self.factor[i]).max(0.0);
                        error += f64::from(residual.max(0.0));
                    }
                    error
                })
                .collect::<Vec<f64>>()
                .iter()
                .sum();
            iterations += 1;
            let mean = (error / source.len().max(1) as f64) as f32;
            if iterations >= MOST_ITERATIONS || iterations > least && mean <= tolerance {
                break self.impulse(&strength);
            }
        };
        for (velocity, change) in self.velocity.iter_mut().zip(change) {
            *velocity += change;
        }
        (strength, iterations)
    }

    fn speed_of_inflow(&self) -> f32 {
        let t = self.time - scene::INLET_OPENS;
        scene::INLET_SPEED
            * (1.0 + 0.06 * (TAU * 1.7 * t).sin() + 0.04 * (TAU * 3.9 * t + 1.0).sin())
    }

    /// Lets in what enters during a step, layer after layer, each shifted against the last.
    fn let_in(&mut self, dt: f32) {
        if self.time < scene::INLET_OPENS {
            return;
        }
        let h = self.spacing;
        let speed = self.speed_of_inflow();
        let frame = scene::chute_frame();
        self.inflow_gap += speed * dt;
        while self.inflow_gap >= h {
            self.inflow_gap -= h;
            let across = (2.0 * (scene::CHUTE_HALF_WIDTH / h - WALL_OFFSET)).floor() as i32;
            let deep = (scene::INLET_DEPTH / h).floor() as i32;
            for v in 0..deep {
                for w in 0..across {
                    let number =
                        (self.inflow_layers * deep as u32 + v as u32) * across as u32 + w as u32;
                    let shake = 0.2 * jitter(self.seed ^ 0x5eed, number);
                    let up = (v as f32 + 0.5 + WALL_OFFSET + shake.y) * h;
                    let aside = (w as f32 + 0.5 + shake.z - 0.5 * across as f32) * h;
                    let down = self.inflow_gap - scene::INLET + shake.x * h;
                    let at = scene::LIP + frame.along * down + frame.up * up + Vec3::Z * aside;
                    self.spawn(at, frame.along * speed);
                }
            }
            self.inflow_layers += 1;
        }
    }

    /// The acceleration by gravity, viscosity, cohesion and the friction of solids.
    fn accelerations(&self) -> Vec<Vec3> {
        let support = self.kernel.support();
        let viscosity = 10.0 * VISCOSITY;
        let cohesion = COHESION * self.mass * 32.0 / (PI * support.powi(9));
        let mut out = vec![Vec3::ZERO; self.position.len()];
        for_each(&mut out, &self.neighbours, |i, local, near, out| {
            let (at, velocity) = (self.position[i], self.velocity[i]);
            let mut a = GRAVITY;
            for (j, g) in near.of(local) {
                let x = at - self.position[j];
                let square = x.length_squared();
                let along =
                    (velocity - self.velocity[j]).dot(x) / (square + 0.01 * support * support);
                a += g * (viscosity * along / self.density[j]);
                let r = square.sqrt();
                if r > 1e-6 {
                    let mut c = (support - r).powi(3) * r.powi(3);
                    if 2.0 * r <= support {
                        c = 2.0 * c - support.powi(6) / 64.0;
                    }
                    a -= x * (cohesion * c / r);
                }
            }
            // A wall at half a spacing slows in full, one a spacing away not at all.
            let touch = (2.0 - 2.0 * self.nearest_solid(at) / self.spacing).clamp(0.0, 1.0);
            *out = a - velocity * (WALL_FRICTION * touch);
        });
        out
    }

    /// Advances by at most `limit` seconds, and returns by how many.
    fn step(&mut self, limit: f32) -> f32 {
        self.refresh();
        let h = self.spacing;
        let count = self.position.len();

        let rate = self.density_rate(&self.velocity);
        let source: Vec<f32> = (0..count)
            .map(|i| {
                let near = self.neighbours[i / BLOCK].count(i % BLOCK);
                if near < SPRAY_NEIGHBOURS && self.wall[i] == Vec3::ZERO { -1e9 } else { rate[i] }
            })
            .collect();
        let tolerance = DIVERGENCE_TOLERANCE * REST_DENSITY / LONGEST_STEP;
        let (_, divergence_iterations) = self.project(&source, vec![0.0; count], tolerance, 1);

        let a = self.accelerations();
        let fastest = self
            .velocity
            .iter()
            .zip(&a)
            .map(|(v, a)| (*v + *a * LONGEST_STEP).length())
            .fold(0.1, f32::max);
        let dt = (COURANT * h / fastest).clamp(5e-4, LONGEST_STEP);
        let steps = (limit / dt).ceil().max(1.0);
        let dt = limit / steps;
        for (velocity, a) in self.velocity.iter_mut().zip(&a) {
            *velocity += *a * dt;
        }

        let rate = self.density_rate(&self.velocity);
        let source: Vec<f32> =
            (0..count).map(|i| (self.density[i] - REST_DENSITY) / dt + rate[i]).collect();
        let guess = self.pressure.iter().map(|p| 0.5 * p * dt).collect();
        let tolerance = DENSITY_TOLERANCE * REST_DENSITY / dt;
        let (strength, density_iterations) = self.project(&source, guess, tolerance, 2);
        self.pressure = strength.iter().map(|p| p / dt).collect();
        self.report = StepReport { divergence_iterations, density_iterations };

        self.move_by(dt);
        self.fresh = false;
        self.time += dt;
        self.let_in(dt);
        dt
    }

    /// Moves the particles, keeps them out of solids, and drops those that left the scene.
    fn move_by(&mut self, dt: f32) {
        let h = self.spacing;
        let damping = if self.time < 0.0 { (-SETTLING_DAMPING * dt).exp() } else { 1.0 };
        let frame = scene::chute_frame();
        let inflow = frame.along * self.speed_of_inflow();
        let (scene, clearance) = (&self.scene, CLEARANCE * h);
        self.position.par_iter_mut().zip(&mut self.velocity).for_each(|(at, velocity)| {
            *velocity *= damping;
            // What has just entered moves as one until the next layers stand behind it.
            let entered = *at - scene::LIP;
            if entered.dot(frame.along) < 2.0 * h - scene::INLET
                && entered.dot(frame.up).abs() < 2.0 * scene::INLET_DEPTH
            {
                *velocity = inflow;
            }
            *at += *velocity * dt;
            for solid in &scene.solids {
                let (d, normal) = solid.distance(*at);
                if d < clearance {
                    *at += normal * (clearance - d);
                    *velocity -= normal * velocity.dot(normal).min(0.0);
                }
            }
        });
        let kept: Vec<usize> =
            (0..self.position.len()).filter(|&i| !self.scene.lost(self.position[i])).collect();
        if kept.len() < self.position.len() {
            self.lost += (self.position.len() - kept.len()) as u32;
            self.position = kept.iter().map(|&i| self.position[i]).collect();
            self.velocity = kept.iter().map(|&i| self.velocity[i]).collect();
            self.id = kept.iter().map(|&i| self.id[i]).collect();
            self.pressure = kept.iter().map(|&i| self.pressure[i]).collect();
        }
    }

    /// Advances to `time`, seconds since frame 0, and returns the number of steps.
    pub fn advance_to(&mut self, time: f32) -> u32 {
        let mut steps = 0;
        while self.time < time - 1e-5 {
            let end = if self.time < -1e-5 { 0.0 } else { time };
            if self.time > -1e-5 && !self.waves_started {
                self.waves_started = true;
                self.start_waves();
            }
            self.step(end - self.time);
            steps += 1;
        }
        steps
    }

    /// What the last step did.
    pub fn report(&self) -> StepReport {
        self.report
    }

    /// How many particles have left the scene.
    pub fn lost(&self) -> u32 {
        self.lost
    }

    /// The particles, sorted by id.
    pub fn frame(&mut self) -> Frame {
        self.refresh();
        let mut order: Vec<usize> = (0..self.id.len()).collect();
        order.sort_unstable_by_key(|&i| self.id[i]);
        Frame {
            positions: order.iter().map(|&i| self.position[i]).collect(),
            velocities: order.iter().map(|&i| self.velocity[i]).collect(),
            densities: order.iter().map(|&i| self.density[i]).collect(),
            ids: order.iter().map(|&i| self.id[i]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(threads: usize) -> Frame {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a thread pool").install(|| {
            let mut simulation = Simulation::new(Scene::waterfall(), 0.09, 1);
            simulation.advance_to(0.05);
            simulation.frame()
        })
    }

    #[test]
    fn the_number_of_threads_changes_nothing() {
        assert_eq!(run(1), run(3));
    }

    #[test]
    fn the_gradient_of_the_cover_is_its_derivative() {
        let simulation = Simulation::new(Scene::waterfall(), 0.09, 1);
        let at = Vec3::new(-1.43, 0.06, 0.85);
        let gradient = simulation.covered(at).1;
        for axis in Vec3::AXES {
            let step = axis * 2e-3;
            let numeric =
                (simulation.covered(at + step).0 - simulation.covered(at - step).0) / 4e-3;
            assert!((numeric - gradient.dot(axis)).abs() < 0.03 * gradient.length() + 0.02);
        }
    }
}
