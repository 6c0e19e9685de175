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

use std::f32::consts::PI;

use glam::{Quat, Vec3};
use rayon::prelude::*;

use crate::bgeo::Frame;
use crate::hinge::GRAVITY;
use crate::kernel::Kernel;
use crate::neighbours::{BLOCK, Grid, NeighbourBlock};
use crate::scene::{Fill, Inlet, Scene, Section, Solid};

/// The rest density of water.
pub const REST_DENSITY: f32 = 1000.0;
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
/// The time at the beginning in which the water settles, and how fast its motion is damped then.
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

/// A solid that water collides with, where it is now.
struct Obstacle {
    solid: Solid,
    reach: f32,
}

impl Obstacle {
    /// The distance, where it is less than `limit`, and the direction in which it grows.
    fn within(&self, at: Vec3, limit: f32) -> Option<(f32, Vec3)> {
        let far = self.reach + limit;
        if (at - self.solid.centre).length_squared() > far * far {
            return None;
        }
        Some(self.solid.distance(at)).filter(|(d, _)| *d < limit)
    }
}

/// What an inlet has let in.
#[derive(Clone, Copy, Debug, Default)]
struct Inflow {
    /// How far the last layer has left the inlet.
    gap: f32,
    layers: u32,
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
    /// Seconds since frame 0; negative while the water settles and the scene gets going.
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
    /// The part of it that is the moving solids'.
    moving_wall: Vec<Vec3>,
    /// `1 / (|Σ m ∇W|² + Σ |m ∇W|²)`, solids included.
    factor: Vec<f32>,

    next_id: u32,
    lost: u32,
    inflows: Vec<Inflow>,
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
    /// The scene with its first water, before that settles.
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

    /// Brings the moving solids to where the hinge has turned.
    fn pose(&mut self) {
        let solids = self.scene.posed(self.scene.hinge.as_ref().map_or(0.0, |hinge| hinge.turn));
        let solids = solids.into_iter().filter(|solid| solid.collides);
        self.obstacles = solids.map(|solid| Obstacle { reach: solid.reach(), solid }).collect();
    }

    fn spawn(&mut self, at: Vec3, velocity: Vec3) {
        self.position.push(at);
        self.velocity.push(velocity);
        self.id.push(self.next_id);
        self.pressure.push(0.0);
        self.next_id += 1;
        self.fresh = false;
    }

    /// Fills by a lattice so jittered that it settles to a packing without visible layers.
    fn fill(&mut self, fill: Fill) {
        let h = self.spacing;
        // Solids begin where the density sees them begin.
        let inset = WALL_OFFSET * h;
        let margin = (CLEARANCE - WALL_OFFSET) * h;
        // What the lattice fills, in a frame of its own that is turned and moved to its place.
        let (min, max, origin, turn) = match fill {
            Fill::Basin { min, max } => (min, max, Vec3::ZERO, 0.0),
            Fill::Bore { foot, angle, radius, length, .. } => {
                (Vec3::new(-radius, 0.0, -radius), Vec3::new(radius, length, radius), foot, angle)
            }
        };
        let turn = Quat::from_rotation_z(turn);
        let (low, high) = (min + inset, max - inset);
        let size = Vec3::new(high.x - low.x, max.y - min.y, high.z - low.z);
        let count = (size / h).round().as_ivec3();
        let cell = size / count.as_vec3();
        for y in 0..count.y {
            for z in 0..count.z {
                for x in 0..count.x {
                    let lattice = Vec3::new(x as f32, y as f32, z as f32) + 0.5;
                    let number = ((y * count.z + z) * count.x + x) as u32;
                    let mut at = low + cell * (lattice + 0.9 * jitter(self.seed, number));
                    at = at.max(low + margin);
                    match fill {
                        Fill::Basin { .. } => {
                            let wall = high - margin;
                            at = at.min(Vec3::new(wall.x, f32::MAX, wall.z));
                        }
                        Fill::Bore { radius, level, .. } => {
                            let middle = low + cell * lattice;
                            let away = Vec3::new(middle.x, 0.0, middle.z).length();
                            if away > radius - inset || (origin + turn * middle).y > level {
                                continue;
                            }
                            let away = Vec3::new(at.x, 0.0, at.z).length();
                            let scale = ((radius - CLEARANCE * h) / away.max(1e-6)).min(1.0);
                            at *= Vec3::new(scale, 1.0, scale);
                            at = origin + turn * at;
                        }
                    }
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
        let Some(Vec3 { x: half_x, y: depth, z: half_z }) = self.scene.waves else {
            return;
        };
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

    /// The distance of the nearest solid; far ones count as one support away.
    fn nearest_solid(&self, at: Vec3) -> f32 {
        self.nearest(at).map_or(self.kernel.support(), |(d, _)| d)
    }

    /// The distance of the nearest solid, and whether it moves; none is farther than a support.
    fn nearest(&self, at: Vec3) -> Option<(f32, bool)> {
        let limit = self.kernel.support();
        let near = self.obstacles.iter().filter_map(|obstacle| {
            obstacle.within(at, limit).map(|(d, _)| (d, obstacle.solid.moves))
        });
        near.reduce(|a, b| if b.0 < a.0 { b } else { a })
    }

    /// The part of the kernel at `at` that solids cover, its gradient, and the moving solids' part
    /// of that. Solids that meet at an edge overlap; what they leave free is taken to be the
    /// product of what each leaves free, which is exact for a particle in the corner of
    /// perpendicular walls.
    fn covered(&self, at: Vec3) -> (f32, Vec3, Vec3) {
        let mut free = 1.0;
        let (mut gradient, mut moving) = (Vec3::ZERO, Vec3::ZERO);
        let offset = WALL_OFFSET * self.spacing;
        for obstacle in &self.obstacles {
            if let Some((d, normal)) = obstacle.within(at, self.kernel.support() + offset) {
                let (part, slope) = self.kernel.half_space(d - offset);
                let own = normal * (slope * free);
                gradient = gradient * (1.0 - part) - own;
                moving *= 1.0 - part;
                if obstacle.solid.moves {
                    moving -= own;
                }
                free *= 1.0 - part;
            }
        }
        (1.0 - free, gradient, moving)
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

    /// The part of `Dρ/Dt` that is the moving solids' motion.
    fn solids_rate(&self) -> Vec<f32> {
        match &self.scene.hinge {
            Some(hinge) => {
                let walls = self.moving_wall.iter().zip(&self.position);
                walls.map(|(wall, at)| -wall.dot(hinge.velocity(*at))).collect()
            }
            None => vec![0.0; self.position.len()],
        }
    }

    /// The angular impulse on the hinge by impulses `strength` of the water.
    fn reaction(&self, strength: &[f32]) -> f64 {
        let Some(hinge) = &self.scene.hinge else {
            return 0.0;
        };
        // In the order of the particles, whatever the threads do.
        let walls = self.moving_wall.iter().zip(&self.position).zip(strength);
        let impulses = walls.map(|((wall, at), strength)| {
            f64::from(hinge.torque(*at, *wall * (self.mass * strength)))
        });
        impulses.sum()
    }

    /// The moment of inertia of the water that the moving solids carry: what lies against them or
    /// in a bore.
    fn carried(&self, axle: Vec3) -> f32 {
        let moving: Vec<&Solid> =
            self.obstacles.iter().map(|o| &o.solid).filter(|solid| solid.moves).collect();
        let inertia = |at: &Vec3| {
            let arm = (*at - axle).truncate().length_squared();
            let held = moving.iter().any(|solid| solid.holds(*at));
            if held { f64::from(self.mass * arm) } else { 0.0 }
        };
        self.position.iter().map(inertia).sum::<f64>() as f32
    }

    /// The rate of change of the density, `Dρ/Dt`, for these velocities between resting solids.
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

    /// Lets in what enters during a step, layer after layer, each shifted against the last.
    fn let_in(&mut self, dt: f32) {
        let h = self.spacing;
        for index in 0..self.inflows.len() {
            let inlet = self.scene.inlets[index].clone();
            if !inlet.is_open(self.time) {
                continue;
            }
            let speed = inlet.speed_at(self.time);
            let mut inflow = self.inflows[index];
            inflow.gap += speed * dt;
            while inflow.gap >= h {
                inflow.gap -= h;
                let (across, deep, floor) = match inlet.section {
                    Section::Channel { half_width, depth } => (
                        (2.0 * (half_width / h - WALL_OFFSET)).floor() as i32,
                        (depth / h).floor() as i32,
                        WALL_OFFSET,
                    ),
                    Section::Pipe { radius } => {
                        let across = (2.0 * (radius / h - WALL_OFFSET)).floor() as i32;
                        (across, across, -0.5 * across as f32)
                    }
                };
                for v in 0..deep {
                    for w in 0..across {
                        let number =
                            (inflow.layers * deep as u32 + v as u32) * across as u32 + w as u32;
                        let up = v as f32 + 0.5 + floor;
                        let aside = w as f32 + 0.5 - 0.5 * across as f32;
                        if matches!(inlet.section, Section::Pipe { .. })
                            && up.hypot(aside) > 0.5 * across as f32
                        {
                            continue;
                        }
                        let stream = (index as u32) << 16;
                        let shake = 0.2 * jitter(self.seed ^ 0x5eed ^ stream, number);
                        let up = (up + shake.y) * h;
                        let aside = (w as f32 + 0.5 + shake.z - 0.5 * across as f32) * h;
                        let down = inflow.gap + inlet.start + shake.x * h;
                        let at =
                            inlet.origin + inlet.along * down + inlet.up * up + Vec3::Z * aside;
                        self.spawn(at, inlet.along * speed);
                    }
                }
                inflow.layers += 1;
            }
            self.inflows[index] = inflow;
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

    /// Advances by at most `limit` seconds, and returns by how many.
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
        // A wall that moves towards the water shortens the step as the water itself does.
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
            // Held while the water settles.
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

    /// Moves the solids and the particles, keeps them out of each other, and drops what left the
    /// scene. Returns the angular impulse on the hinge.
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
            // What has just entered moves as one until the next layers stand behind it.
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

    /// What the last step did.
    pub fn report(&self) -> StepReport {
        self.report
    }

    /// How far the moving solids have turned from rest, radians about +z.
    pub fn turn(&self) -> f32 {
        self.scene.hinge.as_ref().map_or(0.0, |hinge| hinge.turn)
    }

    /// The scene; its hinge where it is now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The distance of particles at rest.
    pub fn spacing(&self) -> f32 {
        self.spacing
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
    use crate::hinge::Hinge;
    use crate::scene::Shape;

    fn run(threads: usize) -> Frame {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a thread pool").install(|| {
            let mut simulation = Simulation::new(crate::scenes::waterfall(), 0.09, 1);
            simulation.advance_to(0.05);
            simulation.frame()
        })
    }

    #[test]
    fn the_number_of_threads_changes_nothing() {
        assert_eq!(run(1), run(3));
    }

    /// A tilted pipe with water in it on an axle below, in the scene 'bamboo' less all else. A
    /// counterweight has `part` of the water's moment.
    fn pipe(part: f32) -> Simulation {
        let bamboo = crate::scenes::bamboo();
        let (angle, axle) = (-60_f32.to_radians(), Vec3::ZERO);
        let along = Quat::from_rotation_z(angle) * Vec3::Y;
        let solid = |shape, from: f32, to: f32, radius: f32| {
            let half = Vec3::new(radius, 0.5 * (to - from), radius);
            let centre = along * (0.5 * (from + to));
            let solid = Solid::new("pipe", "bamboo", shape, centre, half, angle);
            Solid { moves: true, ..solid }
        };
        let hinge = Hinge {
            axle,
            mass: 1.0,
            lever: Vec3::ZERO,
            inertia: 0.05,
            range: [-0.5, 0.0],
            ..bamboo.hinge.clone().expect("has one")
        };
        let foot = along * 0.1;
        let scene = Scene {
            solids: vec![
                solid(Shape::Tube { bore: 0.07, slope: 0.0 }, 0.06, 0.5, 0.095),
                solid(Shape::Cylinder, 0.06, 0.1, 0.07),
            ],
            fills: vec![Fill::Bore { foot, angle, radius: 0.07, length: 0.4, level: 0.15 }],
            inlets: Vec::new(),
            hinge: Some(hinge),
            lead: 0.0,
            ..bamboo
        };
        let mut simulation = Simulation::new(scene, 0.02, 1);
        simulation.advance_to(0.0);
        let moment: f32 = simulation.position.iter().map(|at| simulation.mass * at.x).sum();
        if let Some(hinge) = &mut simulation.scene.hinge {
            hinge.lever = -along * (part * moment / along.x);
        }
        simulation
    }

    #[test]
    fn a_pipe_holds_its_water_and_feels_its_weight() {
        let mut held = pipe(1.1);
        let count = held.position.len();
        held.advance_to(0.5);
        assert_eq!((held.turn(), held.lost()), (0.0, 0));
        let spilt = held.position.iter().filter(|at| !held.obstacles[0].solid.holds(**at));
        assert_eq!(spilt.count(), 0, "of {count}");
        let mut tipped = pipe(0.9);
        tipped.advance_to(0.5);
        assert!(tipped.turn() < -0.02, "{}", tipped.turn());
    }

    #[test]
    fn a_pipe_that_turns_takes_its_water_along() {
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("a thread pool").install(|| {
                let mut simulation = pipe(0.2);
                simulation.advance_to(0.4);
                (simulation.turn(), simulation.frame(), simulation)
            })
        };
        let (turn, frame, simulation) = run(1);
        assert!(turn < -0.3, "{turn}");
        // Through the wall there is no way; out of the mouth there is.
        for at in &simulation.position {
            let solid = &simulation.obstacles[0].solid;
            let local = Quat::from_rotation_z(-solid.angle) * (*at - solid.centre);
            assert!(local.y > -0.22, "{local}");
            assert!(local.x.hypot(local.z) < 0.07 || local.y > 0.22, "{local}");
        }
        let (other_turn, other_frame, _) = run(3);
        assert_eq!((turn, frame), (other_turn, other_frame));
    }

    #[test]
    fn the_gradient_of_the_cover_is_its_derivative() {
        let simulation = Simulation::new(crate::scenes::waterfall(), 0.09, 1);
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
