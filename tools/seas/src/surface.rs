//! A sea's surface: wind waves, and a grid over any surface that a function gives.

use glam::{Vec2, Vec3, vec2};
use std::sync::Arc;
use whitewater::headless::scene::{Material, Mesh, Texture};

use crate::noise::mix;

/// Wind waves, as a sum of sines.
pub struct Waves {
    /// Wave number vector, phase, amplitude.
    all: Vec<(Vec2, f32, f32)>,
}

impl Waves {
    /// Waves from the longest on, each shorter by a constant factor and turned about the wind's direction. `steep` is
    /// the slope of each.
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

    /// Height over the mean level. Crests are sharper than troughs.
    pub fn height(&self, p: Vec2) -> f32 {
        let each = |(number, phase, amplitude): &(Vec2, f32, f32)| {
            let s = (number.dot(p) + phase).sin();
            amplitude * (s + 0.25 * (s * s - 0.5) * 2.0)
        };
        self.all.iter().map(each).sum()
    }
}

/// A grid of `counts` cells over a surface. `place` maps [0, 1]² to positions, so that cells can be finer where more is
/// visible; `at` gives the surface there, and `tint` its linear colour.
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
        // Encode with gamma 2.2, near the curve by which the texture is decoded.
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

/// Albedo that a texel's full brightness stands for.
const BASE: f32 = 0.5;

/// Surface and foam at a place on the water.
#[derive(Clone, Copy, Default)]
pub struct Spot {
    /// The surface.
    pub position: Vec3,
    /// Fraction of the water that foam covers, 0 to about 1.
    pub amount: f32,
    /// Size of the holes in the foam, metres.
    pub cell: f32,
    /// Age of the foam, 0 to 1.
    pub age: f32,
}

/// [`Spot`]s of a rectangle, tabulated: the noise is slow, and each particle needs many evaluations.
pub struct Table {
    low: Vec2,
    cell: Vec2,
    /// Forward displacement of the surface, its height, covered fraction, size of holes, age.
    texels: Vec<[f32; 5]>,
}

/// Texels per side: 9 to 50 cm each, finer than the meshes.
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
        // Threads of its own: a pool's threads may all wait for this table, and then none could fill it.
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

    /// Interpolated values at a place; places outside are clamped to the table.
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
