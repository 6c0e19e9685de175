//! The bench's particles: a wavy pool of 2 × 0.2 × 2 m, with the crown and the drops of a splash. A formula generates
//! them at any resolution.

use std::f32::consts::TAU;

/// Particles of the pool.
pub struct Pool {
    /// Centres in metres.
    pub positions: Vec<[f32; 3]>,
    /// Spacing in metres.
    pub spacing: f32,
}

/// A random number in [0, 1) for each index and purpose.
fn random(index: u32, which: u32) -> f32 {
    let mut h = index.wrapping_mul(0x9e37_79b9) ^ which.wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    (h ^ (h >> 16)) as f32 / 4_294_967_296.0
}

impl Pool {
    /// About `count` particles: nine tenths of them in the pool, the rest in the crown of the splash and its drops.
    pub fn new(count: u32) -> Self {
        let spacing = (0.8 * 0.9 / (0.9 * count as f32)).cbrt();
        let mut positions = Vec::with_capacity(count as usize);
        let steps = (2.0 / spacing) as u32;
        let wave = |x: f32, z: f32| {
            0.18 + 0.014 * (5.0 * x + 1.0).sin() * (4.0 * z).cos()
                + 0.008 * (9.0 * x - 6.0 * z).sin()
        };
        let mut index = 0;
        for i in 0..steps {
            for k in 0..steps {
                let (x, z) = (i as f32 * spacing - 1.0, k as f32 * spacing - 1.0);
                let top = wave(x, z);
                let mut y = 0.5 * spacing;
                while y < top {
                    index += 1;
                    let jitter = |which| (random(index, which) - 0.5) * 0.3 * spacing;
                    positions.push([x + jitter(0), y + jitter(1), z + jitter(2)]);
                    y += spacing;
                }
            }
        }
        // The crown: a sheet that opens upwards, thinning out into drops.
        let crown = count.saturating_sub(positions.len() as u32);
        for n in 0..crown {
            let angle = TAU * random(n, 3);
            let height = 0.45 * random(n, 4).powf(1.7);
            let lean = 0.22 + 0.35 * height + 0.03 * (9.0 * angle).sin();
            let torn = (random(n, 5) - 0.5) * (0.03 + 0.25 * height * height);
            let y = 0.18 + height * (0.7 + 0.3 * (7.0 * angle).cos());
            let radius = lean + torn;
            positions.push([0.1 + radius * angle.cos(), y, -0.15 + radius * angle.sin()]);
        }
        Self { positions, spacing }
    }
}
