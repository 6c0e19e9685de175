//! Noise in the plane, from hashes of lattice cells: smooth value noise, its octaves, and cellular noise, whose borders
//! make the laces of foam.

use glam::{Vec2, vec2};

/// Mixes all bits (the finaliser of SplitMix64).
pub fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// The upper bits as a number in [0, 1).
pub fn unit(bits: u64) -> f32 {
    (bits >> 40) as f32 / 16_777_216.0
}

fn cell(x: i32, y: i32) -> u64 {
    mix((u64::from(x as u32) << 32 | u64::from(y as u32)) ^ 0x9e37_79b9_7f4a_7c15)
}

/// Smooth value noise in [0, 1], with cells of size 1.
pub fn value(p: Vec2) -> f32 {
    let low = p.floor();
    let f = p - low;
    let f = f * f * f * (f * (6.0 * f - 15.0) + 10.0);
    let (x, y) = (low.x as i32, low.y as i32);
    let at = |i, j| unit(cell(x.wrapping_add(i), y.wrapping_add(j)));
    let row = |j| at(0, j) + f.x * (at(1, j) - at(0, j));
    row(0) + f.y * (row(1) - row(0))
}

/// Sum of octaves of [`value`], each of half the size, in [0, 1].
pub fn octaves(mut p: Vec2, count: u32) -> f32 {
    let (mut sum, mut all, mut size) = (0.0, 0.0, 1.0);
    for _ in 0..count {
        sum += size * value(p);
        all += size;
        size *= 0.5;
        // Each octave is rotated, so that the edges of its cells do not line up with the others.
        p = 2.03 * vec2(0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y) + 17.3;
    }
    sum / all
}

/// Distance from the border between two cells: 0 on it, about 1 in their middles (Worley 1996, F2 - F1).
pub fn border(p: Vec2) -> f32 {
    let low = p.floor();
    let (mut first, mut second) = (f32::MAX, f32::MAX);
    for j in -1..=1 {
        for i in -1..=1 {
            let corner = low + vec2(i as f32, j as f32);
            let bits = cell(corner.x as i32, corner.y as i32);
            let point = corner + vec2(unit(bits), unit(bits << 24));
            let squared = point.distance_squared(p);
            if squared < first {
                (first, second) = (squared, first);
            } else {
                second = second.min(squared);
            }
        }
    }
    second.sqrt() - first.sqrt()
}

/// Smoothstep: 0 below `low`, 1 above `high`. If `high` is below `low`, it falls from 1 to 0.
pub fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Density of foam at a place, 0 to 1, where foam covers `amount` of the water: as that falls, a sheet with holes, then
/// laces, then threads. `cell` is the size of the holes.
pub fn laces(p: Vec2, amount: f32, cell: f32) -> f32 {
    if amount <= 0.01 {
        return 0.0;
    }
    let p = p / cell;
    // Warp, as flow distorts foam.
    let warp = vec2(octaves(0.6 * p + 3.1, 3), octaves(0.6 * p - 41.7, 3)) - 0.5;
    let p = p + 1.8 * warp;
    let coarse = border(p) + 0.30 * (value(4.3 * p) - 0.5);
    let reach = amount * amount.sqrt();
    let thread = smooth(reach + 0.09, reach - 0.06, coarse);
    if thread <= 0.0 {
        return 0.0;
    }
    let fine = border(3.7 * p + 1.3 * warp);
    let small = smooth(0.30 + amount, amount - 0.10, fine);
    // Laces are thicker where the flow has pushed foam together.
    let thick = 0.35 + 0.65 * smooth(0.3, 0.65, octaves(1.7 * p + 9.0, 2));
    thread * (0.2 + 0.8 * small) * thick
}
