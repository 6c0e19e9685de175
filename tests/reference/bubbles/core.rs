//! Twin of pass `core`: the image of small bubbles inside a blob, as cells around scattered points
//! on the sphere (Worley 1996).

use glam::{DVec2, DVec3, IVec3};

use crate::reference::classify::pcg;
use crate::reference::{Image, smoothstep};

/// Appearance of the inside in a direction.
#[derive(Clone, Copy, Debug)]
pub struct Pattern {
    /// Tilt that is added to the normal.
    pub lean: DVec3,
    /// Brightness, 1 in the mean.
    pub brightness: f64,
}

/// The point of a lattice cell, in [0, 1) along each axis.
fn scattered(cell: IVec3, seed: u32) -> DVec3 {
    let [x, y, z] = cell.to_array().map(i32::cast_unsigned);
    let id = pcg(x.wrapping_add(pcg(y.wrapping_add(pcg(z.wrapping_add(seed))))));
    let part = |n: u32| f64::from(pcg(id.wrapping_add(n)) >> 8) / f64::from(1 << 24);
    DVec3::new(part(0), part(1), part(2))
}

/// Vector from the nearest lattice point, and the difference of the distances to the second nearest
/// and to the nearest point.
fn nearest(place: DVec3, seed: u32) -> (DVec3, f64) {
    let middle = place.floor().as_ivec3();
    let around = (-1..2).flat_map(|z| (-1..2).flat_map(move |y| (-1..2).map(move |x| (x, y, z))));
    let mut ways: Vec<_> = around
        .map(|(x, y, z)| {
            let cell = middle + IVec3::new(x, y, z);
            place - cell.as_dvec3() - scattered(cell, seed)
        })
        .collect();
    ways.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    (ways[0], ways[1].length() - ways[0].length())
}

/// Cells of three sizes: bubbles whose normals tilt away from their centres, with bright seams
/// between.
fn pattern(direction: DVec3, seed: u32) -> Pattern {
    let mut pattern = Pattern { lean: DVec3::ZERO, brightness: 0.8 };
    for octave in 0..3_u32 {
        let (cells, part) = (6.0 * 2.1_f64.powi(octave as i32), 0.6_f64.powi(octave as i32));
        let (way, apart) = nearest(direction * cells, pcg(seed.wrapping_add(octave)));
        let seam = 1.0 - smoothstep(0.0, 0.18, apart);
        let round = (1.0 - way.length_squared()).clamp(0.0, 1.0);
        pattern.lean += part * 0.6 * way;
        pattern.brightness += part * (0.35 * seam + 0.3 * (round - 0.72));
    }
    pattern.brightness = pattern.brightness.clamp(0.2, 1.8);
    pattern
}

/// Position of a direction in the square of an octahedron whose lower half is folded outwards, -1
/// to 1 along each axis.
fn place(d: DVec3) -> DVec2 {
    let p = DVec2::new(d.x, d.y) / (d.x.abs() + d.y.abs() + d.z.abs());
    let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
    match d.z < 0.0 {
        true => DVec2::new((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y)),
        false => p,
    }
}

/// Direction of a position in the octahedral map. A position beyond an edge of the map continues at
/// the mirrored position on the same edge, where the halves meet.
fn direction(mut p: DVec2) -> DVec3 {
    if p.x.abs() > 1.0 {
        p = DVec2::new(2.0 * p.x.signum() - p.x, -p.y);
    }
    if p.y.abs() > 1.0 {
        p = DVec2::new(-p.x, 2.0 * p.y.signum() - p.y);
    }
    let z = 1.0 - p.x.abs() - p.y.abs();
    let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
    let [x, y] = match z < 0.0 {
        true => [(1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y)],
        false => [p.x, p.y],
    };
    DVec3::new(x, y, z).normalize()
}

/// The image as drawn, filtered between texels, with a border of one texel.
pub struct Picture {
    texels: Image<[f64; 4]>,
    /// Error of a filter's position, in texels.
    step: f64,
}

impl Picture {
    /// An image of this size in texels; `bits`: precision of a filter's weights.
    pub fn new(size: usize, seed: u32, bits: u32) -> Self {
        let texels = Image::from_fn(size + 2, size + 2, |x, y| {
            let at = DVec2::new(x as f64 - 0.5, y as f64 - 0.5) / size as f64;
            let Pattern { lean, brightness } = pattern(direction(2.0 * at - 1.0), seed);
            lean.extend(brightness).to_array()
        });
        Self { texels, step: 1.0 / f64::from(1 << bits) }
    }

    /// Appearance of the inside in a direction, and the error of its brightness.
    pub fn at(&self, towards: DVec3) -> (Pattern, f64) {
        let size = (self.texels.width - 2) as f64;
        let at = (0.5 * place(towards) + 0.5) * size + 1.0;
        let [mut sum, mut least, mut most] = [[0.0; 4], [f64::INFINITY; 4], [-f64::INFINITY; 4]];
        for (x, y, weight) in self.texels.bilinear(at) {
            for (c, value) in self.texels.clamped(x, y).into_iter().enumerate() {
                sum[c] += weight * value;
                (least[c], most[c]) = (least[c].min(value), most[c].max(value));
            }
        }
        let [x, y, z, brightness] = sum;
        // Each texel has half precision, and the filter's weights err along both axes.
        let off = brightness / 1024.0 + 2.0 * self.step * (most[3] - least[3]);
        (Pattern { lean: DVec3::new(x, y, z), brightness }, off)
    }
}

#[test]
fn an_octahedron_folds_back() {
    for d in [[0.3, -0.2, 0.9], [-0.5, 0.1, -0.7], [0.2, 0.9, -0.1], [-0.6, -0.6, -0.4]] {
        let d = DVec3::from(d).normalize();
        assert!(direction(place(d)).distance(d) < 1.0e-12, "{d}");
    }
    // Positions at the same distance outside and inside of an edge, at mirrored places along it,
    // have one direction.
    let across = direction(DVec2::new(1.01, 0.3));
    assert!(across.distance(direction(DVec2::new(0.99, -0.3))) < 1.0e-12);
}

#[test]
fn the_picture_is_as_bright_as_there_is_none_in_the_mean() {
    for seed in [1, 7, 4242] {
        let picture = Picture::new(96, seed, 8);
        let mean = picture.texels.data.iter().map(|t| t[3]).sum::<f64>() / 98.0_f64.powi(2);
        println!("seed {seed}: {mean:.4}");
        assert!((mean - 1.0).abs() < 0.02, "seed {seed}: {mean}");
    }
}
