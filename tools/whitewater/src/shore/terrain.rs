//! Height fields and stones, the same in every run.

use std::f32::consts::{PI, TAU};

use glam::{IVec2, Vec2, Vec3, vec2, vec3};
use whitewater::headless::scene::{Material, Mesh};

/// Hash of a lattice point, 0 to 1.
fn hash(cell: IVec2, seed: u32) -> f32 {
    let mut h = (cell.x as u32).wrapping_mul(0x8da6_b343)
        ^ (cell.y as u32).wrapping_mul(0xd816_3841)
        ^ seed.wrapping_mul(0xcb1a_b31f);
    for factor in [0x2c1b_3c6d, 0x297a_2d39] {
        h = (h ^ (h >> 15)).wrapping_mul(factor);
    }
    ((h ^ (h >> 15)) >> 8) as f32 / (1 << 24) as f32
}

/// A pseudo-random number for an index, 0 to 1, the same in every run.
pub fn number(index: usize, seed: u32) -> f32 {
    hash(IVec2::new(index as i32, 7), seed)
}

/// Value noise in [-1, 1], with unit cells.
fn noise(p: Vec2, seed: u32) -> f32 {
    let (cell, f) = (p.floor(), p - p.floor());
    let fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let at = |x, y| hash(cell.as_ivec2() + IVec2::new(x, y), seed);
    let row = |y| at(0, y) + fade.x * (at(1, y) - at(0, y));
    2.0 * (row(0) + fade.y * (row(1) - row(0))) - 1.0
}

/// Fractal sum of that noise, within about -1 to 1.
pub fn octaves(p: Vec2, count: u32, seed: u32) -> f32 {
    // Each octave is rotated relative to the one before, so that the lattices do not show.
    let turn = Vec2::from_angle(0.7);
    let step = |(sum, p, amplitude): (f32, Vec2, f32), i: u32| {
        (sum + amplitude * noise(p, seed + i), 2.03 * turn.rotate(p) + 11.3, 0.5 * amplitude)
    };
    (0..count).fold((0.0, p, 0.5), step).0
}

/// Domain warping: displaces a point by noise with cells of size `over`, along each axis usually by less than `reach`
/// and at most by 1.75 times as much.
pub fn warped(p: Vec2, reach: f32, over: f32, seed: u32) -> Vec2 {
    let q = p / over;
    p + reach * 2.0 * vec2(octaves(q, 3, seed), octaves(q, 3, seed + 50))
}

/// Smooth step: 0 below `from`, 1 above `to`.
pub fn rise(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Smooth maximum of two numbers over a width.
pub fn joined(a: f32, b: f32, width: f32) -> f32 {
    let h = (width - (a - b).abs()).max(0.0);
    a.max(b) + 0.25 * h * h / width
}

/// A rectangle of the level plane, x and z.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    pub low: Vec2,
    pub high: Vec2,
    /// Edge length of a cell.
    pub cell: f32,
}

impl Patch {
    /// Number of cells along x and z.
    pub fn cells(&self) -> [usize; 2] {
        ((self.high - self.low) / self.cell).ceil().to_array().map(|n| n as usize)
    }

    pub fn corner(&self, i: usize, j: usize) -> Vec2 {
        self.low + self.cell * vec2(i as f32, j as f32)
    }
}

/// Mesh of the height field `height` over `patch`, without the cells that are entirely below `bottom`.
pub fn field(patch: Patch, bottom: f32, material: Material, height: impl Fn(Vec2) -> f32) -> Mesh {
    let [nx, nz] = patch.cells();
    let all: Vec<f32> = (0..=nz)
        .flat_map(|j| (0..=nx).map(move |i| (i, j)))
        .map(|(i, j)| height(patch.corner(i, j)))
        .collect();
    let mut mesh = Mesh { name: "terrain".into(), material, ..Mesh::default() };
    let mut places = vec![u32::MAX; all.len()];
    let at = |i: usize, j: usize| j * (nx + 1) + i;
    for (i, j) in (0..nz).flat_map(|j| (0..nx).map(move |i| (i, j))) {
        let corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)];
        if corners.iter().all(|&(i, j)| all[at(i, j)] < bottom) {
            continue;
        }
        let [a, b, c, d] = corners.map(|(i, j)| {
            let place = &mut places[at(i, j)];
            if *place == u32::MAX {
                *place = mesh.positions.len() as u32;
                let p = patch.corner(i, j);
                let y = all[at(i, j)];
                mesh.positions.push([p.x, y, p.y]);
                let step = 0.5 * patch.cell;
                let slope = |d: Vec2| (height(p + d) - height(p - d)) / (2.0 * step);
                let normal = vec3(-slope(vec2(step, 0.0)), 1.0, -slope(vec2(0.0, step)));
                mesh.normals.push(normal.normalize().to_array());
            }
            *place
        });
        // Each cell is split along its flatter diagonal.
        let flat =
            |p: (usize, usize), q: (usize, usize)| (all[at(p.0, p.1)] - all[at(q.0, q.1)]).abs();
        match flat(corners[0], corners[2]) < flat(corners[1], corners[3]) {
            true => mesh.indices.extend([a, b, c, a, c, d]),
            false => mesh.indices.extend([a, b, d, b, c, d]),
        }
    }
    mesh
}

/// A rounded object: centre, radii, and the depth of its dents relative to the radii.
#[derive(Clone, Copy, Debug)]
pub struct Lump {
    pub middle: Vec3,
    pub half: Vec3,
    pub rough: f32,
    pub seed: u32,
}

/// Lumps as one mesh, each with this number of rings.
pub fn lumps(lumps: &[Lump], rings: u32, material: Material) -> Mesh {
    let mut mesh = Mesh { name: "lumps".into(), material, ..Mesh::default() };
    let sides = rings * 3 / 2;
    for lump in lumps {
        let first = mesh.positions.len() as u32;
        let place = |up: f32, around: f32| {
            let ((s, c), (sin, cos)) = (up.sin_cos(), around.sin_cos());
            let out = vec3(s * cos, c, s * sin);
            // Noise on a sphere, from three planes through it.
            let q = 1.7 * out;
            let dent = octaves(vec2(q.x, q.y), 3, lump.seed)
                + octaves(vec2(q.y, q.z), 3, lump.seed + 1)
                + octaves(vec2(q.z, q.x), 3, lump.seed + 2);
            lump.middle + lump.half * out * (1.0 + lump.rough * dent)
        };
        mesh.positions.push(place(0.0, 0.0).to_array());
        for ring in 1..rings {
            let up = PI * ring as f32 / rings as f32;
            for side in 0..sides {
                mesh.positions.push(place(up, TAU * side as f32 / sides as f32).to_array());
            }
        }
        mesh.positions.push(place(PI, 0.0).to_array());
        let last = mesh.positions.len() as u32 - 1;
        let at = |ring: u32, side: u32| first + 1 + (ring - 1) * sides + side % sides;
        for side in 0..sides {
            mesh.indices.extend([first, at(1, side + 1), at(1, side)]);
            mesh.indices.extend([last, at(rings - 1, side), at(rings - 1, side + 1)]);
            for ring in 1..rings - 1 {
                let (a, b) = (at(ring, side), at(ring, side + 1));
                let (c, d) = (at(ring + 1, side), at(ring + 1, side + 1));
                mesh.indices.extend([a, b, d, a, d, c]);
            }
        }
    }
    mesh.normals = smooth_normals(&mesh.positions, &mesh.indices);
    mesh
}

/// A horizontal torus: radius of its centre line, and of its tube.
pub fn ring(middle: Vec3, [radius, tube]: [f32; 2], material: Material) -> Mesh {
    const AROUND: u32 = 64;
    const ACROSS: u32 = 24;
    let mut mesh = Mesh { name: "ring".into(), material, ..Mesh::default() };
    for i in 0..AROUND {
        let (sin, cos) = (TAU * i as f32 / AROUND as f32).sin_cos();
        for j in 0..ACROSS {
            let (s, c) = (TAU * j as f32 / ACROSS as f32).sin_cos();
            let out = vec3(c * cos, s, c * sin);
            let line = middle + radius * vec3(cos, 0.0, sin);
            mesh.positions.push((line + tube * out).to_array());
            mesh.normals.push(out.to_array());
            let at = |i: u32, j: u32| (i % AROUND) * ACROSS + j % ACROSS;
            let (a, b, c, d) = (at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
            mesh.indices.extend([a, b, c, a, c, d]);
        }
    }
    mesh
}

/// A box from corner to corner, divided into cells no wider than `cell`, because ray tracing is faster if the
/// triangles of a scene are of similar size.
pub fn block(low: Vec3, high: Vec3, cell: f32, material: Material) -> Mesh {
    let mut mesh = Mesh { name: "block".into(), material, ..Mesh::default() };
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    for normal in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        let u = if normal.x == 0.0 { Vec3::X } else { Vec3::Y };
        let v = normal.cross(u);
        let [nu, nv] =
            [u, v].map(|axis| (2.0 * half.dot(axis.abs()) / cell).ceil().max(1.0) as u32);
        let first = mesh.positions.len() as u32;
        for (j, i) in (0..=nv).flat_map(|j| (0..=nu).map(move |i| (j, i))) {
            let [a, b] = [(i, nu), (j, nv)].map(|(at, count)| 2.0 * at as f32 / count as f32 - 1.0);
            mesh.positions.push((middle + half * (normal + a * u + b * v)).to_array());
            mesh.normals.push(normal.to_array());
            if i < nu && j < nv {
                let at = first + j * (nu + 1) + i;
                let up = at + nu + 1;
                mesh.indices.extend([at, at + 1, up + 1, at, up + 1, up]);
            }
        }
    }
    mesh
}

/// Means of the triangles' normals, weighted by area.
pub fn smooth_normals(positions: &[[f32; 3]], indices: &[u32]) -> Vec<[f32; 3]> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for t in indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| Vec3::from(positions[t[k] as usize]));
        let area = (b - a).cross(c - a);
        for corner in t {
            sums[*corner as usize] += area;
        }
    }
    sums.iter().map(|n| n.normalize_or(Vec3::Y).to_array()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_face_outward() {
        let lump = Lump { middle: Vec3::ZERO, half: Vec3::ONE, rough: 0.3, seed: 3 };
        let ball = lumps(&[lump], 10, Material::default());
        let torus = ring(Vec3::ZERO, [2.0, 0.5], Material::default());
        let patch = Patch { low: Vec2::splat(-3.0), high: Vec2::splat(3.0), cell: 0.5 };
        let hill = field(patch, -9.0, Material::default(), |p| (-p.length_squared()).exp());
        let block = block(Vec3::ZERO, vec3(1.0, 2.0, 3.0), 0.7, Material::default());
        for (mesh, closed) in [(ball, true), (torus, true), (hill, false), (block, true)] {
            let (mut volume, mut up) = (0.0, true);
            assert_eq!(mesh.positions.len(), mesh.normals.len());
            for t in mesh.indices.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|k| Vec3::from(mesh.positions[t[k] as usize]));
                let face = (b - a).cross(c - a);
                let normal = Vec3::from(mesh.normals[t[0] as usize]);
                assert!(face.dot(normal) > 0.0, "{}: {face} {normal}", mesh.name);
                volume += a.dot(b.cross(c)) / 6.0;
                up &= face.y > 0.0;
            }
            // A closed mesh that faces inward has a negative volume.
            assert!(if closed { volume > 0.0 } else { up }, "{}: {volume}", mesh.name);
        }
    }

    #[test]
    fn what_is_deep_is_left_out() {
        let patch = Patch { low: Vec2::splat(-4.0), high: Vec2::splat(4.0), cell: 1.0 };
        let all = field(patch, -9.0, Material::default(), |p| -p.length());
        let some = field(patch, -2.0, Material::default(), |p| -p.length());
        assert_eq!(all.indices.len(), 8 * 8 * 6);
        assert!(
            some.indices.len() < all.indices.len() && some.positions.len() < all.positions.len()
        );
    }
}
