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
//! distance of the solid. What pushes the water off a solid that moves pushes the solid too.

mod inflow;
mod solids;
#[cfg(test)]
mod tests;

use std::f32::consts::PI;

use glam::Vec3;
use rayon::prelude::*;

use crate::bgeo::Frame;
use crate::hinge::GRAVITY;
use crate::kernel::Kernel;
use crate::neighbours::{BLOCK, Grid, NeighbourBlock};
use crate::scene::{Inlet, Scene};

use inflow::Inflow;
use solids::Obstacle;

/// The rest density of water.
pub const REST_DENSITY: f32 = 1000.0;
/// Kinematic viscosity, m²/s: an eddy viscosity at the resolved scale, larger than water's.
const VISCOSITY: f32 = 0.004;
/// The coefficient of the cohesion of Akinci et al., "Versatile Surface Tension and Adhesion for
/// SPH Fluids" (2013).
const COHESION: f32 = 0.4;
/// How fast a solid slows the water that touches it, 1/s.
const WALL_FRICTION: f32 = 0.6;
/// Height above a solid, in spacings, at which the density's half-space begins, and the closest distance of a particle.
/// Particles come to rest half a spacing above a solid, as spheres lie on it.
const WALL_OFFSET: f32 = 0.2;
const CLEARANCE: f32 = 0.5;
/// The relaxation of the Jacobi iteration.
const RELAXATION: f32 = 0.5;
/// The mean compression, and the mean compression per step, at which the iterations end.
const DENSITY_TOLERANCE: f32 = 5e-4;
const DIVERGENCE_TOLERANCE: f32 = 1e-3;
const MOST_ITERATIONS: u32 = 100;
/// Neighbour count below which a particle is spray: its divergence means nothing.
const SPRAY_NEIGHBOURS: usize = 20;
/// Largest motion of a particle in a step, in spacings, and the longest step.
const COURANT: f32 = 0.4;
const LONGEST_STEP: f32 = 1.0 / 300.0;
/// Duration of settling at the beginning, and damping rate of the motion during it.
const SETTLING: f32 = 0.8;
const SETTLING_DAMPING: f32 = 8.0;

/// Report of the last step.
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
    obstacles: Vec<Obstacle>,
    kernel: Kernel,
    grid: Grid,
    spacing: f32,
    mass: f32,
    seed: u32,
    /// Seconds since frame 0. It is negative while the water settles and the scene starts.
    time: f32,
    waves_started: bool,

    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    id: Vec<u32>,
    /// The density solver's impulses divided by the step, kept as the first guess of the next step.
    pressure: Vec<f32>,

    // Derived from the present positions; `fresh` is false once these have changed.
    fresh: bool,
    neighbours: Vec<NeighbourBlock>,
    density: Vec<f32>,
    /// `ρ₀ ∇λ`, the solids' part of the gradient of the density.
    wall: Vec<Vec3>,
    /// The moving solids' part of `wall`.
    moving_wall: Vec<Vec3>,
    /// `1 / (|Σ m ∇W|² + Σ |m ∇W|²)`, solids included.
    factor: Vec<f32>,

    next_id: u32,
    lost: u32,
    inflows: Vec<Inflow>,
    report: StepReport,
}

/// Evaluates `f` for every particle in parallel, into `out`.
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
    /// The scene with its first water, before it settles.
    pub fn new(scene: Scene, spacing: f32, seed: u32) -> Self {
        let kernel = Kernel::new(2.0 * spacing);
        let mass = REST_DENSITY / kernel.lattice_sum(spacing);
        let [low, high] = scene.bounds;
        let grid = Grid::new(low, high, kernel.support());
        let mut simulation = Self {
            obstacles: Vec::new(),
            inflows: vec![Inflow::default(); scene.inlets.len()],
            time: -SETTLING - scene.lead,
            scene,
            kernel,
            grid,
            spacing,
            mass,
            seed,
            waves_started: false,
            position: Vec::new(),
            velocity: Vec::new(),
            id: Vec::new(),
            pressure: Vec::new(),
            fresh: false,
            neighbours: Vec::new(),
            density: Vec::new(),
            wall: Vec::new(),
            moving_wall: Vec::new(),
            factor: Vec::new(),
            next_id: 0,
            lost: 0,
            report: StepReport::default(),
        };
        simulation.pose();
        for fill in simulation.scene.fills.clone() {
            simulation.fill(fill);
        }
        simulation
    }

    /// Sorts the particles, and finds their neighbours, densities and factors.
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

        let mut all = vec![(0.0, Vec3::ZERO, 0.0, Vec3::ZERO); self.position.len()];
        for_each(&mut all, &self.neighbours, |i, local, near, out| {
            let at = self.position[i];
            let (part, gradient, moving) = self.covered(at);
            let wall = REST_DENSITY * gradient;
            let mut density = self.mass * self.kernel.value(0.0) + REST_DENSITY * part;
            let (mut sum, mut squares) = (wall, 0.0);
            for (j, g) in near.of(local) {
                density += self.mass * self.kernel.value(at.distance(self.position[j]));
                sum += g;
                squares += g.length_squared();
            }
            let diagonal = sum.length_squared() + squares;
            let factor = if diagonal > 1e-3 { 1.0 / diagonal } else { 0.0 };
            *out = (density, wall, factor, REST_DENSITY * moving);
        });
        self.density = all.iter().map(|a| a.0).collect();
        self.wall = all.iter().map(|a| a.1).collect();
        self.factor = all.iter().map(|a| a.2).collect();
        self.moving_wall = all.iter().map(|a| a.3).collect();
        self.fresh = true;
    }

    /// The rate of change of the density, `Dρ/Dt`, for these velocities between solids at rest.
    fn density_rate(&self, velocity: &[Vec3]) -> Vec<f32> {
        let mut rate = vec![0.0; velocity.len()];
        for_each(&mut rate, &self.neighbours, |i, local, near, out| {
            let own = velocity[i];
            let sum: f32 = near.of(local).map(|(j, g)| (own - velocity[j]).dot(g)).sum();
            *out = sum + own.dot(self.wall[i]);
        });
        rate
    }

    /// Change of velocity by impulses.
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

    /// Finds impulses that remove the positive part of `source` (a rate of compression), applies them to the
    /// velocities, and returns them with the number of iterations.
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

    /// Acceleration by gravity, viscosity, cohesion and friction at solids.
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
            // Friction is full at half a spacing from a wall, and zero from one spacing on.
            let (d, moves) = self.nearest(at).unwrap_or((support, false));
            let touch = (2.0 - 2.0 * d / self.spacing).clamp(0.0, 1.0);
            let wall = match &self.scene.hinge {
                Some(hinge) if moves => hinge.velocity(at),
                _ => Vec3::ZERO,
            };
            *out = a - (velocity - wall) * (WALL_FRICTION * touch);
        });
        out
    }

    /// Advances by at most `limit` seconds, and returns the step taken.
    fn step(&mut self, limit: f32) -> f32 {
        self.refresh();
        let h = self.spacing;
        let count = self.position.len();

        let rate = self.density_rate(&self.velocity);
        let solids = self.solids_rate();
        let source: Vec<f32> = (0..count)
            .map(|i| {
                let near = self.neighbours[i / BLOCK].count(i % BLOCK);
                let spray = near < SPRAY_NEIGHBOURS && self.wall[i] == Vec3::ZERO;
                if spray { -1e9 } else { rate[i] + solids[i] }
            })
            .collect();
        let tolerance = DIVERGENCE_TOLERANCE * REST_DENSITY / LONGEST_STEP;
        let (push, divergence_iterations) = self.project(&source, vec![0.0; count], tolerance, 1);

        let mut torque = self.reaction(&push);

        let a = self.accelerations();
        let hinge = self.scene.hinge.as_ref();
        // A wall that moves towards the water shortens the step, just as fast water does.
        let walls = hinge.map_or(0.0, |hinge| {
            let moving = self.obstacles.iter().filter(|o| o.solid.moves);
            let arms = moving.map(|o| o.solid.centre.distance(hinge.axle) + o.reach);
            hinge.speed.abs() * arms.fold(0.0, f32::max)
        });
        let fastest = self
            .velocity
            .iter()
            .zip(&a)
            .map(|(v, a)| (*v + *a * LONGEST_STEP).length())
            .fold(0.1, f32::max)
            + walls;
        let dt = (COURANT * h / fastest).clamp(5e-4, LONGEST_STEP);
        let steps = (limit / dt).ceil().max(1.0);
        let dt = limit / steps;
        for (velocity, a) in self.velocity.iter_mut().zip(&a) {
            *velocity += *a * dt;
        }

        let rate = self.density_rate(&self.velocity);
        let source: Vec<f32> = (0..count)
            .map(|i| (self.density[i] - REST_DENSITY) / dt + (rate[i] + solids[i]))
            .collect();
        let guess = self.pressure.iter().map(|p| 0.5 * p * dt).collect();
        let tolerance = DENSITY_TOLERANCE * REST_DENSITY / dt;
        let (strength, density_iterations) = self.project(&source, guess, tolerance, 2);
        self.pressure = strength.iter().map(|p| p / dt).collect();
        self.report = StepReport { divergence_iterations, density_iterations };

        torque += self.reaction(&strength);
        torque += self.move_by(dt);
        let carried = self.scene.hinge.as_ref().map_or(0.0, |hinge| self.carried(hinge.axle));
        match &mut self.scene.hinge {
            // The hinge is held while the water settles.
            Some(hinge) if self.time >= -self.scene.lead => {
                hinge.accelerate(torque as f32, carried, dt);
            }
            _ => {}
        }
        self.fresh = false;
        self.time += dt;
        self.let_in(dt);
        dt
    }

    /// Moves solids and particles, keeps them apart, and drops particles that left the scene. Returns the angular
    /// impulse on the hinge.
    fn move_by(&mut self, dt: f32) -> f64 {
        let h = self.spacing;
        let settling = self.time < -self.scene.lead;
        let damping = if settling { (-SETTLING_DAMPING * dt).exp() } else { 1.0 };
        if let Some(hinge) = self.scene.hinge.as_mut().filter(|hinge| hinge.speed != 0.0) {
            hinge.advance(dt);
            self.pose();
        }
        let inlets = self.scene.inlets.iter().filter(|inlet| inlet.is_open(self.time));
        let inflows: Vec<(&Inlet, Vec3)> =
            inlets.map(|inlet| (inlet, inlet.along * inlet.speed_at(self.time))).collect();
        let (obstacles, hinge) = (&self.obstacles, self.scene.hinge.as_ref());
        let (mass, clearance) = (self.mass, CLEARANCE * h);
        let mut torques = vec![0.0; self.position.len()];
        let particles = self.position.par_iter_mut().zip(&mut self.velocity).zip(&mut torques);
        particles.for_each(|((at, velocity), torque)| {
            *velocity *= damping;
            // New water moves rigidly until the next layers stand behind it.
            for (inlet, speed) in &inflows {
                if inlet.has_just_entered(*at, h) {
                    *velocity = *speed;
                }
            }
            *at += *velocity * dt;
            for obstacle in obstacles {
                let Some((d, normal)) = obstacle.within(*at, clearance) else {
                    continue;
                };
                let hinge = hinge.filter(|_| obstacle.solid.moves);
                let wall = hinge.map_or(Vec3::ZERO, |hinge| hinge.velocity(*at));
                *at += normal * (clearance - d);
                let push = normal * (*velocity - wall).dot(normal).min(0.0);
                *velocity -= push;
                if let Some(hinge) = hinge {
                    *torque += hinge.torque(*at, push * mass);
                }
            }
        });
        let torque = torques.iter().map(|t| f64::from(*t)).sum();
        let kept: Vec<usize> =
            (0..self.position.len()).filter(|&i| !self.scene.lost(self.position[i])).collect();
        if kept.len() < self.position.len() {
            self.lost += (self.position.len() - kept.len()) as u32;
            self.position = kept.iter().map(|&i| self.position[i]).collect();
            self.velocity = kept.iter().map(|&i| self.velocity[i]).collect();
            self.id = kept.iter().map(|&i| self.id[i]).collect();
            self.pressure = kept.iter().map(|&i| self.pressure[i]).collect();
        }
        torque
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

    /// Report of the last step.
    pub fn report(&self) -> StepReport {
        self.report
    }

    /// Angle of the moving solids from rest, radians about +z.
    pub fn turn(&self) -> f32 {
        self.scene.hinge.as_ref().map_or(0.0, |hinge| hinge.turn)
    }

    /// The scene, with its hinge in the present position.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Distance between particles at rest.
    pub fn spacing(&self) -> f32 {
        self.spacing
    }

    /// Number of particles that have left the scene.
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
