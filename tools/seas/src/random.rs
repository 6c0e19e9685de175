//! Random numbers of a particle: a sequence of its own, seeded by its id alone.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3, vec2, vec3};

use crate::noise::{mix, unit};

/// A random sequence (SplitMix64, seeded with a hash of the id).
pub struct Random(u64);

impl Random {
    pub fn new(id: u32, salt: u32) -> Self {
        Self(mix(u64::from(salt) << 32 | u64::from(id)))
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        unit(mix(self.0))
    }

    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// An integer below `count`.
    pub fn below(&mut self, count: u32) -> u32 {
        ((self.unit() * count as f32) as u32).min(count.saturating_sub(1))
    }

    /// An exponentially distributed number of this mean, at most 16 times the mean.
    pub fn decay(&mut self, mean: f32) -> f32 {
        -mean * (1.0 - self.unit()).max(1.0e-7).ln()
    }

    /// A point in the unit ball, denser towards the centre: its radius is uniform, where an even density needs a
    /// cube root.
    pub fn ball(&mut self) -> Vec3 {
        let y = self.between(-1.0, 1.0);
        let (sin, cos) = (TAU * self.unit()).sin_cos();
        let across = (1.0 - y * y).max(0.0).sqrt();
        self.unit() * vec3(across * cos, y, across * sin)
    }
}

/// A density of 0 to 1 over a rectangle, as a distribution of places.
pub struct Field {
    low: Vec2,
    cell: Vec2,
    density: fn(Vec2) -> f32,
    /// For each cell, the largest density found in it and its neighbours; and the running sum of these.
    most: Vec<f32>,
    sums: Vec<f64>,
}

impl Field {
    const CELLS: usize = 160;

    pub fn new(low: Vec2, high: Vec2, density: fn(Vec2) -> f32) -> Self {
        const N: usize = Field::CELLS;
        let cell = (high - low) / N as f32;
        let at = |i: usize, part: Vec2| {
            density(low + cell * (vec2((i % N) as f32, (i / N) as f32) + part))
        };
        const PARTS: [Vec2; 5] =
            [vec2(0.2, 0.3), vec2(0.7, 0.2), vec2(0.5, 0.55), vec2(0.25, 0.8), vec2(0.8, 0.75)];
        let found: Vec<f32> = (0..N * N)
            .map(|i| PARTS.map(|part| at(i, part)).into_iter().fold(0.0, f32::max))
            .collect();
        let widened = |i: usize| {
            let (x, y) = (i % N, i / N);
            let rows = y.saturating_sub(1)..(y + 2).min(N);
            let columns = x.saturating_sub(1)..(x + 2).min(N);
            let around = rows.flat_map(|y| columns.clone().map(move |x| y * N + x));
            (1.1 * around.map(|k| found[k]).fold(0.0, f32::max)).min(1.0)
        };
        let most: Vec<f32> = (0..N * N).map(widened).collect();
        let mut sum = 0.0;
        let add = |most: &f32| {
            sum += f64::from(*most);
            sum
        };
        let sums = most.iter().map(add).collect();
        Self { low, cell, density, most, sums }
    }

    /// Draws a place by rejection. After too many rejections it returns the last candidate.
    pub fn draw(&self, random: &mut Random) -> Vec2 {
        const TRIES: u32 = 64;
        let all = self.sums.last().copied().unwrap_or(0.0);
        let mut place = self.low;
        for _ in 0..TRIES {
            let lot = all * f64::from(random.unit());
            let i = self.sums.partition_point(|sum| *sum <= lot).min(self.sums.len() - 1);
            let corner = vec2((i % Self::CELLS) as f32, (i / Self::CELLS) as f32);
            place = self.low + self.cell * (corner + vec2(random.unit(), random.unit()));
            if random.unit() * self.most[i] < (self.density)(place) {
                break;
            }
        }
        place
    }
}
