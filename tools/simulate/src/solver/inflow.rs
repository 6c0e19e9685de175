//! Water that enters the scene: the first fill, the inlets, and the waves that are started.

use std::f32::consts::PI;

use glam::{Quat, Vec3};

use super::{CLEARANCE, Simulation, WALL_OFFSET};
use crate::scene::{Fill, Section};

/// State of an inlet.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Inflow {
    /// Distance of the last layer from the inlet.
    gap: f32,
    layers: u32,
}

/// A hash of three numbers in [0, 1): random numbers that do not depend on the order of calls.
fn noise(seed: u32, index: u32, stream: u32) -> f32 {
    // Multiplications and shifts that mix all bits, with the constants of MurmurHash3's finaliser.
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

impl Simulation {
    fn spawn(&mut self, at: Vec3, velocity: Vec3) {
        self.position.push(at);
        self.velocity.push(velocity);
        self.id.push(self.next_id);
        self.pressure.push(0.0);
        self.next_id += 1;
        self.fresh = false;
    }

    /// Fills with a lattice whose jitter lets it settle to a packing without visible layers.
    pub(super) fn fill(&mut self, fill: Fill) {
        let h = self.spacing;
        // Solids begin where the density calculation places them.
        let inset = WALL_OFFSET * h;
        let margin = (CLEARANCE - WALL_OFFSET) * h;
        // The filled box, in a frame of its own that is rotated and moved into place.
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

    /// Starts standing waves: the velocity of linear potential flow in a basin at the moment when its surface is flat.
    pub(super) fn start_waves(&mut self) {
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

    /// Adds the water that enters during a step, layer by layer, each shifted against the last.
    pub(super) fn let_in(&mut self, dt: f32) {
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
}
