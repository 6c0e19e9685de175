//! Dressed stone: blocks with chamfered edges, and rows of them.

use glam::{Vec3, vec3};
use whitewater::headless::scene::{Material, Mesh};

use crate::shore::terrain::number;

/// A box whose edges have a chamfer with smooth normals. `hidden` lists the faces that are left out because other
/// objects hide them, as indices in the order +x -x +y -y +z -z.
pub fn dressed(low: Vec3, high: Vec3, chamfer: f32, material: Material, hidden: &[usize]) -> Mesh {
    let mut mesh = Mesh { name: "stone".into(), material, ..Mesh::default() };
    add(&mut mesh, low, high, chamfer, hidden);
    mesh
}

fn add(mesh: &mut Mesh, low: Vec3, high: Vec3, chamfer: f32, hidden: &[usize]) {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let chamfer = chamfer.min(0.5 * half.min_element());
    let first = mesh.positions.len() as u32;
    let sign = |corner: usize| {
        let of = |axis: usize| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
        vec3(of(0), of(1), of(2))
    };
    // Each corner is three vertices, one for each adjacent face.
    for corner in 0..8 {
        for axis in 0..3 {
            let sign = sign(corner);
            let mut at = half - chamfer;
            at[axis] = half[axis];
            let mut normal = Vec3::ZERO;
            normal[axis] = sign[axis];
            mesh.positions.push((middle + sign * at).to_array());
            mesh.normals.push(normal.to_array());
        }
    }
    let vertex = |corner: usize, axis: usize| first + (3 * corner + axis) as u32;
    let mut polygon = |corners: &[u32]| {
        let at = |i: u32| Vec3::from(mesh.positions[i as usize]);
        let out: Vec3 = corners.iter().map(|i| Vec3::from(mesh.normals[*i as usize])).sum();
        let mut corners = corners.to_vec();
        let face = (at(corners[1]) - at(corners[0])).cross(at(corners[2]) - at(corners[0]));
        if face.dot(out) < 0.0 {
            corners.reverse();
        }
        for i in 1..corners.len() - 1 {
            mesh.indices.extend([corners[0], corners[i], corners[i + 1]]);
        }
    };
    for axis in 0..3 {
        let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        for side in 0..2 {
            // Faces are in pairs, the positive side first.
            if !hidden.contains(&(2 * axis + 1 - side)) {
                let base = side << axis;
                polygon(&[base, base | u, base | u | v, base | v].map(|c| vertex(c, axis)));
            }
        }
        // The four edges along the axis.
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        for edge in [0, u, v, u | v] {
            let other = edge | 1 << axis;
            polygon(&[vertex(edge, a), vertex(other, a), vertex(other, b), vertex(edge, b)]);
        }
    }
    for corner in 0..8 {
        polygon(&[vertex(corner, 0), vertex(corner, 1), vertex(corner, 2)]);
    }
}

/// A row of stones that fills a box along an axis. Each stone is about `long`, and has one of three shades.
pub fn row(
    (low, high): (Vec3, Vec3),
    axis: usize,
    long: f32,
    chamfer: f32,
    material: &Material,
    seed: u32,
) -> Vec<Mesh> {
    let shade = |by: f32, warm: f32| {
        let [r, g, b] = material.base_color;
        let base_color = [r * (by + warm), g * by, b * (by - warm)];
        Material { base_color, ..material.clone() }
    };
    let mut rows = [(0.9, -0.02), (1.0, 0.0), (1.07, 0.02)]
        .map(|(by, warm)| Mesh { material: shade(by, warm), ..Mesh::default() });
    let count = ((high[axis] - low[axis]) / long).round().max(1.0) as usize;
    for i in 0..count {
        let at = |i: usize| {
            // The stones' lengths vary.
            let off = if i == 0 || i == count { 0.0 } else { 0.24 * (number(i, seed) - 0.5) };
            low[axis] + (high[axis] - low[axis]) * (i as f32 + off) / count as f32
        };
        let (mut from, mut to) = (low, high);
        (from[axis], to[axis]) = (at(i), at(i + 1));
        let mut hidden = Vec::new();
        if i > 0 {
            hidden.push(2 * axis + 1);
        }
        if i + 1 < count {
            hidden.push(2 * axis);
        }
        let shade = (3.0 * number(i, seed + 1)) as usize % 3;
        add(&mut rows[shade], from, to, chamfer, &hidden);
    }
    rows.into_iter().filter(|mesh| !mesh.indices.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stones_are_closed_and_face_outward() {
        let (low, high) = (vec3(-1.0, 0.0, 2.0), vec3(3.0, 0.4, 2.5));
        let stone = dressed(low, high, 0.05, Material::default(), &[]);
        let corner = |i: u32| Vec3::from(stone.positions[i as usize]);
        let (mut volume, mut area) = (0.0, Vec3::ZERO);
        for t in stone.indices.chunks_exact(3) {
            let [a, b, c] = [corner(t[0]), corner(t[1]), corner(t[2])];
            let face = (b - a).cross(c - a);
            let out: Vec3 = t.iter().map(|i| Vec3::from(stone.normals[*i as usize])).sum();
            assert!(face.dot(out) > 0.0, "{face} {out}");
            volume += a.dot(b.cross(c)) / 6.0;
            area += face;
        }
        assert!(area.length() < 1.0e-5, "open: {area}");
        // Volume of the box minus twelve prisms; the corners are neglected.
        let prisms = 0.5 * 0.05 * 0.05 * 4.0 * (high - low).element_sum();
        let expected = (high - low).element_product() - prisms;
        assert!((volume - expected).abs() < 8.0 * 0.05_f32.powi(3), "{volume} {expected}");
    }

    #[test]
    fn a_row_fills_its_box() {
        let (low, high) = (vec3(-1.0, 0.0, 2.0), vec3(3.0, 0.4, 2.5));
        let meshes = row((low, high), 0, 0.7, 0.02, &Material::default(), 5);
        let points = || meshes.iter().flat_map(|m| &m.positions).map(|p| Vec3::from(*p));
        assert_eq!(points().fold(Vec3::INFINITY, Vec3::min), low);
        assert_eq!(points().fold(Vec3::NEG_INFINITY, Vec3::max), high);
        // Six stones of 24 vertices.
        assert_eq!(points().count(), 6 * 24);
    }
}
