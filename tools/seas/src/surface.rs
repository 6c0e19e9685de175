//! A sea's surface: waves of the wind, and a grid over any surface that a formula gives.

use glam::{Vec2, Vec3, vec2};
use std::sync::Arc;
use whitewater::headless::scene::{Material, Mesh, Texture};

use crate::noise::mix;

/// Waves of the wind.
pub struct Waves {
    /// Wave number vector, phase, amplitude.
    all: Vec<(Vec2, f32, f32)>,
}

impl Waves {
    /// From the longest wave on, each shorter by the same factor, turned about the wind; `steep`: slope of each.
    pub fn new(wind: Vec2, longest: f32, shortest: f32, steep: f32) -> Self {
        const COUNT: u32 = 18;
        let lot = |i: u32, which: u64| crate::noise::unit(mix(u64::from(i) << 8 | which)) - 0.5;
        let wave = |i: u32| {
            let part = i as f32 / (COUNT - 1) as f32;
            let length = longest * (shortest / longest).powf(part);
            let turn = Vec2::from_angle(2.2 * lot(i, 1)).rotate(wind.normalize_or(Vec2::X));
            let number = std::f32::consts::TAU / length;
            (number * turn, std::f32::consts::TAU * lot(i, 2), steep / number)
        };
        Self { all: (0..COUNT).map(wave).collect() }
    }

    /// Height over the mean; crests are sharper than troughs.
    pub fn height(&self, p: Vec2) -> f32 {
        let each = |(number, phase, amplitude): &(Vec2, f32, f32)| {
            let s = (number.dot(p) + phase).sin();
            amplitude * (s + 0.25 * (s * s - 0.5) * 2.0)
        };
        self.all.iter().map(each).sum()
    }
}

/// A grid of `counts` cells over a surface. `place`: from 0 to 1 on both sides to where the surface is asked, so
/// that it is finer where more is seen of it; `at`: the surface; `tint`: its colour there, linear.
pub fn grid(
    name: &str,
    counts: [u32; 2],
    place: impl Fn(Vec2) -> Vec2,
    at: impl Fn(Vec2) -> Vec3,
    tint: impl Fn(Vec2) -> Vec3,
    roughness: f32,
) -> Mesh {
    let [columns, rows] = counts;
    let mut mesh = Mesh { name: name.into(), ..Mesh::default() };
    let part = |i: u32, j: u32| vec2(i as f32 / columns as f32, j as f32 / rows as f32);
    for j in 0..=rows {
        for i in 0..=columns {
            let uv = part(i, j);
            let p = place(uv);
            const STEP: f32 = 0.08;
            let along = |d: Vec2| at(p + d) - at(p - d);
            let normal = along(vec2(0.0, STEP)).cross(along(vec2(STEP, 0.0)));
            mesh.positions.push(at(p).to_array());
            mesh.normals.push(normal.normalize_or(Vec3::Y).to_array());
            mesh.uvs.push(uv.to_array());
            if i < columns && j < rows {
                let a = j * (columns + 1) + i;
                let b = a + columns + 1;
                mesh.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
            }
        }
    }
    const TEXELS: u32 = 512;
    let texel = |i: u32| {
        let uv = (vec2((i % TEXELS) as f32, (i / TEXELS) as f32) + 0.5) / TEXELS as f32;
        let c = (tint(place(uv)) / BASE).clamp(Vec3::ZERO, Vec3::ONE);
        // The curve that the texture is read by.
        let [r, g, b] = c.to_array().map(|v| (255.0 * v.powf(1.0 / 2.2) + 0.5) as u8);
        [r, g, b, 255]
    };
    let data = (0..TEXELS * TEXELS).map(texel).collect();
    mesh.material = Material {
        base_color: [BASE; 3],
        roughness,
        texture: Some(Arc::new(Texture { width: TEXELS, height: TEXELS, data })),
        ..Material::default()
    };
    mesh
}

/// What a texel's full brightness stands for.
const BASE: f32 = 0.5;

/// What there is at a place of the water.
#[derive(Clone, Copy, Default)]
pub struct Spot {
    /// The surface.
    pub position: Vec3,
    /// How much of the water foam covers, 0 to about 1.
    pub amount: f32,
    /// Size of the holes in it, metres.
    pub cell: f32,
    /// How old it is, 0 to 1.
    pub age: f32,
}

/// The same of a whole rectangle, tabled: formulas of much noise are asked many times for each particle.
pub struct Table {
    low: Vec2,
    cell: Vec2,
    /// How far ahead the surface lies, its height, amount, size of holes, age.
    texels: Vec<[f32; 5]>,
}

/// Texels on a side: 9 to 50 cm, finer than the meshes.
const TABLE: usize = 720;

impl Table {
    pub fn new(
        low: Vec2,
        high: Vec2,
        surface: fn(Vec2) -> Vec3,
        cover: fn(Vec2) -> (f32, f32, f32),
    ) -> Self {
        let cell = (high - low) / (TABLE - 1) as f32;
        let mut texels = vec![[0.0; 5]; TABLE * TABLE];
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
        let size = (TABLE / threads + 1) * TABLE;
        // Threads of its own: one of a pool that waits for the table must not be who makes it.
        std::thread::scope(|scope| {
            for (k, part) in texels.chunks_mut(size).enumerate() {
                scope.spawn(move || {
                    for (i, texel) in part.iter_mut().enumerate() {
                        let i = k * size + i;
                        let p = low + cell * vec2((i % TABLE) as f32, (i / TABLE) as f32);
                        let (at, (amount, holes, age)) = (surface(p), cover(p));
                        *texel = [at.x - p.x, at.y, amount, holes, age];
                    }
                });
            }
        });
        Self { low, cell, texels }
    }

    /// At a place, or the nearest that is in the table.
    pub fn at(&self, p: Vec2) -> Spot {
        let most = (TABLE - 2) as f32;
        let place = ((p - self.low) / self.cell).clamp(Vec2::ZERO, Vec2::splat(most + 0.999));
        let corner = place.floor().min(Vec2::splat(most));
        let (f, first) = (place - corner, corner.y as usize * TABLE + corner.x as usize);
        let mean = |k: usize| {
            let row = |at: usize| self.texels[at][k] * (1.0 - f.x) + self.texels[at + 1][k] * f.x;
            row(first) * (1.0 - f.y) + row(first + TABLE) * f.y
        };
        Spot {
            position: Vec3::new(p.x + mean(0), mean(1), p.y),
            amount: mean(2),
            cell: mean(3),
            age: mean(4),
        }
    }
}
