//! Turns a scene into vertices with baked light. Large triangles are subdivided, so that the vertices are dense
//! enough for the light that they store.

use std::collections::HashMap;

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};

use super::tracer::{Around, Tracer};
use super::{Ground, Mesh, Scene};

/// A vertex of `glsl/headless/scene.vert`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Vertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub uv: [f32; 2],
    /// Baked light at the vertex. x: visible fraction of the sky. yzw: RGB irradiance by sunlight that has
    /// bounced once or twice, divided by the sun's irradiance.
    pub light: [f32; 4],
    /// Mean albedo of what the vertex sees over its hemisphere, weighted by the cosine; the sky counts as 0.
    pub around: [f32; 3],
    /// Distance, in scene units, from the flat facets out to the smooth surface that they approximate. At vertices of
    /// the backdrop instead: fraction of the sun's disc, seen from the vertex, that the backdrop does not hide, 0 to
    /// 1.
    pub bulge: f32,
}

impl Vertex {
    pub fn at(&self) -> Vec3 {
        self.position.into()
    }
}

/// A part of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Index into `Scene.meshes`.
    Mesh(usize),
    Ground,
    /// Index into `Scene.backdrop`.
    Backdrop(usize),
}

/// The triangles of one part in the index buffer.
pub struct Batch {
    pub part: Part,
    pub first: u32,
    pub count: u32,
}

/// Vertices and indices of a whole scene. Ground and backdrop come last, because they cast no shadow: the
/// shadow map draws only the indices before theirs.
pub struct Baked {
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    pub batches: Vec<Batch>,
}

/// Max edge of a lit triangle: the scene's diagonal divided by this.
const EDGES: f32 = 45.0;
/// Max number of vertices that subdivision may create in one mesh.
const MOST: usize = 400_000;

/// Bakes the light of the scene at rest. Moving meshes keep their baked light; only the shadow map follows
/// them.
pub fn bake(scene: &Scene) -> Baked {
    let (low, high) = scene.bounds();
    let diagonal = (high - low).length().max(1e-6);
    let longest = diagonal / EDGES;
    let tracer = Tracer::new(scene, diagonal);
    let mut baked = Baked { vertices: Vec::new(), indices: Vec::new(), batches: Vec::new() };
    for (index, mesh) in scene.meshes.iter().enumerate() {
        let (mut vertices, mut indices) = world(mesh);
        split(&mut vertices, &mut indices, longest);
        tracer.light(&mut vertices, &indices, true);
        baked.add(Part::Mesh(index), vertices, &indices);
    }
    if let Some(ground) = &scene.ground {
        let (mut vertices, indices) = ground_grid(ground, low, high, longest);
        tracer.light(&mut vertices, &indices, false);
        baked.add(Part::Ground, vertices, &indices);
    }
    if !scene.backdrop.is_empty() {
        let around = Around::new(scene, diagonal);
        for (index, mesh) in scene.backdrop.iter().enumerate() {
            let (mut vertices, indices) = world(mesh);
            around.light(&mut vertices);
            baked.add(Part::Backdrop(index), vertices, &indices);
        }
    }
    baked
}

impl Baked {
    /// The vertices with the poses of [`Scene::frame`].
    pub fn placed(&self, scene: &Scene) -> Vec<Vertex> {
        let mut vertices = self.vertices.clone();
        for batch in &self.batches {
            let Part::Mesh(mesh) = batch.part else { continue };
            let Some(pose) = scene.pose(mesh) else { continue };
            let turn = pose.inverse().transpose();
            let indices = batch.first as usize..(batch.first + batch.count) as usize;
            // The vertices of a mesh are contiguous and belong to one batch.
            let (low, high) = self.indices[indices]
                .iter()
                .fold((u32::MAX, 0), |(low, high), i| (low.min(*i), high.max(*i)));
            for vertex in vertices.iter_mut().take(high as usize + 1).skip(low as usize) {
                let normal = turn.transform_vector3(vertex.normal.into());
                vertex.position = pose.transform_point3(vertex.at()).to_array();
                vertex.normal = normal.normalize_or(vertex.normal.into()).to_array();
            }
        }
        vertices
    }

    fn add(&mut self, part: Part, vertices: Vec<Vertex>, indices: &[u32]) {
        let base = self.vertices.len() as u32;
        let (first, count) = (self.indices.len() as u32, indices.len() as u32);
        self.batches.push(Batch { part, first, count });
        self.vertices.extend(vertices);
        self.indices.extend(indices.iter().map(|i| base + i));
    }
}

/// Distance from the scene's centre to which the ground extends along x and z, unless it has a
/// [`reach`](Ground::reach). Unit: diagonals of the scene.
pub const GROUND_REACH: f32 = 60.0;
/// Distances from the scene's centre at which the ground begins and ends to fade. Unit: diagonals of the scene.
pub const GROUND_FADE: [f32; 2] = [6.0, 45.0];

/// Transforms a mesh to world space. A triangle with a vertex that is not finite is dropped. Also sets `bulge`.
pub fn world(mesh: &Mesh) -> (Vec<Vertex>, Vec<u32>) {
    let normal_matrix = mesh.transform.inverse().transpose();
    let mut vertices: Vec<Vertex> = mesh
        .positions
        .iter()
        .enumerate()
        .map(|(i, &position)| {
            let normal = mesh.normals.get(i).copied().unwrap_or([0.0, 1.0, 0.0]);
            Vertex {
                position: mesh.transform.transform_point3(position.into()).to_array(),
                normal: normal_matrix.transform_vector3(normal.into()).normalize_or(Vec3::Y).into(),
                uv: mesh.uvs.get(i).copied().unwrap_or_default(),
                ..Vertex::default()
            }
        })
        .collect();
    let fine =
        |&i: &u32| vertices.get(i as usize).is_some_and(|v| Vec3::from(v.position).is_finite());
    let indices: Vec<u32> = mesh
        .indices
        .chunks_exact(3)
        .filter(|triangle| triangle.iter().all(fine))
        .flatten()
        .copied()
        .collect();
    for t in indices.chunks_exact(3) {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (i, j) = (t[i] as usize, t[j] as usize);
            let (p, q) = (vertices[i], vertices[j]);
            // Height of a circle's arc over its chord: an eighth of the chord times the turn of the normal in
            // radians.
            let turn = Vec3::from(q.normal) - Vec3::from(p.normal);
            let bulge = (0.125 * turn.dot(q.at() - p.at())).max(0.0);
            vertices[i].bulge = p.bulge.max(bulge);
            vertices[j].bulge = q.bulge.max(bulge);
        }
    }
    (vertices, indices)
}

/// Subdivides until no edge is longer than `longest`. Whether an edge is split depends on that edge alone, so
/// the two triangles that share it agree, and no T-junctions appear.
fn split(vertices: &mut Vec<Vertex>, indices: &mut Vec<u32>, longest: f32) {
    for _ in 0..16 {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut out = Vec::with_capacity(indices.len());
        let before = vertices.len();
        for triangle in indices.chunks_exact(3) {
            let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
            let mut middle = |i: u32, j: u32| {
                let (p, q) = (vertices[i as usize], vertices[j as usize]);
                let length = Vec3::from(p.position).distance(q.at());
                if length <= longest {
                    return None;
                }
                Some(*middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    vertices.push(halfway(&p, &q));
                    vertices.len() as u32 - 1
                }))
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            // In each case the corners are listed so that the edges to split come first.
            match (ab, bc, ca) {
                (None, None, None) => out.extend([a, b, c]),
                (Some(x), Some(y), Some(z)) => out.extend([a, x, z, x, b, y, z, y, c, x, y, z]),
                (Some(x), None, None) => out.extend([a, x, c, x, b, c]),
                (None, Some(x), None) => out.extend([b, x, a, x, c, a]),
                (None, None, Some(x)) => out.extend([c, x, b, x, a, b]),
                (Some(x), Some(y), None) => out.extend([a, x, c, x, y, c, x, b, y]),
                (None, Some(x), Some(y)) => out.extend([b, x, a, x, y, a, x, c, y]),
                (Some(y), None, Some(x)) => out.extend([c, x, b, x, y, b, x, a, y]),
            }
        }
        *indices = out;
        if vertices.len() == before || vertices.len() > MOST {
            return;
        }
    }
}

fn halfway(p: &Vertex, q: &Vertex) -> Vertex {
    let normal = (Vec3::from(p.normal) + Vec3::from(q.normal)).normalize_or(p.normal.into());
    Vertex {
        position: p.at().midpoint(q.at()).to_array(),
        normal: normal.to_array(),
        uv: Vec2::from(p.uv).midpoint(q.uv.into()).to_array(),
        bulge: p.bulge.max(q.bulge),
        ..Vertex::default()
    }
}

/// A grid over the ground, uniform around the scene and coarser outwards.
fn ground_grid(ground: &Ground, low: Vec3, high: Vec3, longest: f32) -> (Vec<Vertex>, Vec<u32>) {
    let diagonal = (high - low).length().max(1e-6);
    let axis = |low: f32, high: f32| {
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low) + 0.3 * diagonal);
        // Light on the ground varies less than in corners.
        let cells = (half / (1.2 * longest)).ceil().clamp(4.0, 120.0);
        let mut side: Vec<f32> = (0..=cells as u32).map(|i| half * i as f32 / cells).collect();
        let mut step = half / cells;
        let mut at = half;
        while at < GROUND_REACH * diagonal {
            step *= 1.35;
            at += step;
            side.push(at);
        }
        if let Some(reach) = ground.reach.filter(|reach| *reach < at) {
            side.retain(|at| *at < 0.999 * reach);
            side.push(reach);
        }
        let left = side[1..].iter().rev().map(|x| centre - x);
        left.chain(side.iter().map(|x| centre + x)).collect::<Vec<_>>()
    };
    let (xs, zs) = (axis(low.x, high.x), axis(low.z, high.z));
    let mut vertices = Vec::with_capacity(xs.len() * zs.len());
    let mut indices = Vec::new();
    for (j, &z) in zs.iter().enumerate() {
        for (i, &x) in xs.iter().enumerate() {
            vertices.push(Vertex {
                position: [x, ground.y, z],
                normal: [0.0, 1.0, 0.0],
                uv: [x, z],
                ..Vertex::default()
            });
            if i + 1 < xs.len() && j + 1 < zs.len() {
                let a = (j * xs.len() + i) as u32;
                let b = a + xs.len() as u32;
                indices.extend([a, b, b + 1, a, b + 1, a + 1]);
            }
        }
    }
    (vertices, indices)
}

#[cfg(test)]
mod tests {
    use super::super::Material;
    use super::*;

    #[test]
    fn splitting_keeps_the_area_and_bounds_the_edges() {
        let mesh =
            Mesh::cuboid([0.0; 3], [1.0, 0.5, 0.1], [0.0, 0.0, 0.0, 1.0], Material::default());
        let (mut vertices, mut indices) = world(&mesh);
        split(&mut vertices, &mut indices, 0.2);
        let mut area = 0.0;
        for t in indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| vertices[t[k] as usize].at());
            area += 0.5 * (b - a).cross(c - a).length();
            assert!(a.distance(b).max(b.distance(c)).max(c.distance(a)) <= 0.2 + 1e-6);
        }
        assert!((area - 2.0 * (2.0 + 0.4 + 0.2)).abs() < 1e-4, "{area}");
    }
}
