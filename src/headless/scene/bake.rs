//! From a scene to vertices: large triangles are split, and light that does not come straight from
//! the sun or the sky is baked per vertex: how much of the sky is seen, sunlight that bounces
//! once off the other surfaces, and their albedo. Deterministic: the same directions everywhere.

use std::collections::HashMap;

use bytemuck::{Pod, Zeroable};
use glam::{Quat, Vec2, Vec3};

use super::{Ground, Mesh, Scene};

/// A vertex of `glsl/headless/scene.vert`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Vertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub uv: [f32; 2],
    /// Share of the sky that is seen; irradiance of bounced sunlight over the sun's.
    pub light: [f32; 4],
    /// Albedo of what is seen beside the sky, weighted by how much of it is seen.
    pub around: [f32; 3],
    /// How far the smooth surface that is meant bulges over the facets.
    pub bulge: f32,
}

/// The triangles of one mesh in the index buffer.
pub struct Batch {
    /// Index in `Scene.meshes`; `None` is the ground.
    pub mesh: Option<usize>,
    pub first: u32,
    pub count: u32,
}

/// Vertices and indices of a whole scene. The ground comes last: it casts no shadow.
pub struct Baked {
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    pub batches: Vec<Batch>,
}

/// Rays a vertex.
const RAYS: usize = 64;
/// Longest edge of a lit triangle: this part of the scene's diagonal.
const EDGES: f32 = 45.0;
/// Vertices that splitting may make in one mesh.
const MOST: usize = 400_000;

pub fn bake(scene: &Scene) -> Baked {
    let (low, high) = scene.bounds();
    let diagonal = (high - low).length().max(1e-6);
    let longest = diagonal / EDGES;
    let tracer = Tracer::new(scene, diagonal);
    let mut baked = Baked { vertices: Vec::new(), indices: Vec::new(), batches: Vec::new() };
    for (index, mesh) in scene.meshes.iter().enumerate() {
        let (mut vertices, mut indices) = world(mesh);
        split(&mut vertices, &mut indices, longest);
        baked.add(Some(index), &tracer, vertices, &indices);
    }
    if let Some(ground) = &scene.ground {
        let (vertices, indices) = ground_grid(ground, low, high, longest);
        baked.add(None, &tracer, vertices, &indices);
    }
    baked
}

impl Baked {
    fn add(
        &mut self,
        mesh: Option<usize>,
        tracer: &Tracer,
        mut vertices: Vec<Vertex>,
        indices: &[u32],
    ) {
        tracer.light(&mut vertices, indices, mesh.is_some());
        let base = self.vertices.len() as u32;
        self.batches.push(Batch {
            mesh,
            first: self.indices.len() as u32,
            count: indices.len() as u32,
        });
        self.vertices.extend(vertices);
        self.indices.extend(indices.iter().map(|i| base + i));
    }
}

/// How far the ground goes from its middle, in sizes of the scene, and where its fade begins.
pub const GROUND_REACH: f32 = 60.0;
pub const GROUND_FADE: [f32; 2] = [6.0, 45.0];

/// A mesh in world space; vertices that cannot be drawn take their triangles with them.
fn world(mesh: &Mesh) -> (Vec<Vertex>, Vec<u32>) {
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
            // Of a circle's arc over a chord: an eighth of the chord times the turn.
            let turn = Vec3::from(q.normal) - Vec3::from(p.normal);
            let bulge = (0.125 * turn.dot(p_position(&q) - p_position(&p))).max(0.0);
            vertices[i].bulge = p.bulge.max(bulge);
            vertices[j].bulge = q.bulge.max(bulge);
        }
    }
    (vertices, indices)
}

/// Splits until no edge is longer. Whether an edge is split is a matter of that edge alone, so
/// neighbours agree and there are no T-junctions.
fn split(vertices: &mut Vec<Vertex>, indices: &mut Vec<u32>, longest: f32) {
    for _ in 0..16 {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut out = Vec::with_capacity(indices.len());
        let before = vertices.len();
        for triangle in indices.chunks_exact(3) {
            let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
            let mut middle = |i: u32, j: u32| {
                let (p, q) = (vertices[i as usize], vertices[j as usize]);
                let length = Vec3::from(p.position).distance(p_position(&q));
                if length <= longest {
                    return None;
                }
                Some(*middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    vertices.push(halfway(&p, &q));
                    vertices.len() as u32 - 1
                }))
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            // Turned so that the case is one of: none, the first edge, the first two, all.
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

fn p_position(vertex: &Vertex) -> Vec3 {
    vertex.position.into()
}

fn halfway(p: &Vertex, q: &Vertex) -> Vertex {
    let normal = (Vec3::from(p.normal) + Vec3::from(q.normal)).normalize_or(p.normal.into());
    Vertex {
        position: p_position(p).midpoint(p_position(q)).to_array(),
        normal: normal.to_array(),
        uv: Vec2::from(p.uv).midpoint(q.uv.into()).to_array(),
        bulge: p.bulge.max(q.bulge),
        ..Vertex::default()
    }
}

/// A grid, even round the scene and ever coarser outwards.
fn ground_grid(ground: &Ground, low: Vec3, high: Vec3, longest: f32) -> (Vec<Vertex>, Vec<u32>) {
    let diagonal = (high - low).length().max(1e-6);
    let axis = |low: f32, high: f32| {
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low) + 0.3 * diagonal);
        // Light varies less out here than in corners.
        let cells = (half / (1.2 * longest)).ceil().clamp(4.0, 120.0);
        let mut side: Vec<f32> = (0..=cells as u32).map(|i| half * i as f32 / cells).collect();
        let mut step = half / cells;
        let mut at = half;
        while at < GROUND_REACH * diagonal {
            step *= 1.35;
            at += step;
            side.push(at);
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

struct Triangle {
    corner: Vec3,
    edges: [Vec3; 2],
    normal: Vec3,
    albedo: Vec3,
}

/// Leaf: `count` triangles from `first`. Inner: children `first` and `first + 1`.
struct Node {
    low: Vec3,
    high: Vec3,
    first: u32,
    count: u32,
}

struct Hit {
    distance: f32,
    normal: Vec3,
    albedo: Vec3,
    /// From behind: the ray began inside a solid.
    inside: bool,
}

/// Rays against the unsplit triangles, which are few.
struct Tracer {
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
    ground: Option<(f32, Vec3)>,
    sun: Vec3,
    /// How far a ray starts off its surface.
    lift: f32,
    directions: Vec<Vec3>,
}

impl Tracer {
    fn new(scene: &Scene, diagonal: f32) -> Self {
        let mut triangles = Vec::new();
        for mesh in &scene.meshes {
            let albedo = mesh.material.albedo();
            let (vertices, indices) = world(mesh);
            for t in indices.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|k| p_position(&vertices[t[k] as usize]));
                let mut normal = (b - a).cross(c - a).normalize_or_zero();
                // Winding is not trusted: the given normal says where outside is.
                if normal.dot(vertices[t[0] as usize].normal.into()) < 0.0 {
                    normal = -normal;
                }
                triangles.push(Triangle { corner: a, edges: [b - a, c - a], normal, albedo });
            }
        }
        // Cosine-weighted about +z, by a Fibonacci spiral.
        let directions = (0..RAYS)
            .map(|i| {
                let u = (i as f32 + 0.5) / RAYS as f32;
                let (sin, cos) = (2.399_963_1 * i as f32).sin_cos();
                Vec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt())
            })
            .collect();
        let mut tracer = Self {
            triangles,
            nodes: Vec::new(),
            ground: scene.ground.as_ref().map(|g| (g.y, g.material.albedo())),
            sun: Vec3::from(scene.sun.direction).normalize_or(Vec3::Y),
            lift: 5e-4 * diagonal,
            directions,
        };
        tracer.nodes.push(Node { low: Vec3::ZERO, high: Vec3::ZERO, first: 0, count: 0 });
        tracer.build(0, 0, tracer.triangles.len());
        tracer
    }

    fn build(&mut self, node: usize, first: usize, end: usize) {
        let part = &mut self.triangles[first..end];
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for t in part.iter() {
            for at in [t.corner, t.corner + t.edges[0], t.corner + t.edges[1]] {
                low = low.min(at);
                high = high.max(at);
            }
        }
        let leaf = Node { low, high, first: first as u32, count: (end - first) as u32 };
        if end - first <= 4 {
            self.nodes[node] = leaf;
            return;
        }
        let size = high - low;
        let axis = if size.x >= size.max_element() {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let middle = part.len() / 2;
        let key = |t: &Triangle| t.corner[axis] + (t.edges[0][axis] + t.edges[1][axis]) / 3.0;
        part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
        let child = self.nodes.len();
        let empty = || Node { low, high, first: 0, count: 0 };
        self.nodes.push(empty());
        self.nodes.push(empty());
        self.nodes[node] = Node { low, high, first: child as u32, count: 0 };
        self.build(child, first, first + middle);
        self.build(child + 1, first + middle, end);
    }

    /// The nearest hit, or any when that is enough.
    fn trace(&self, from: Vec3, along: Vec3, any: bool) -> Option<Hit> {
        let inverse = along.recip();
        let mut best: Option<(f32, usize)> = None;
        // A median split halves: 64 levels would be 2^64 triangles.
        let mut stack = [0u32; 64];
        let mut depth = 1;
        while depth > 0 && !self.triangles.is_empty() {
            depth -= 1;
            let node = &self.nodes[stack[depth] as usize];
            let (a, b) = ((node.low - from) * inverse, (node.high - from) * inverse);
            let near = a.min(b).max_element().max(0.0);
            let far = a.max(b).min_element();
            // A ray in the plane of a face is NaN here, and goes on.
            if near > far || best.is_some_and(|(t, _)| near > t) {
                continue;
            }
            if node.count == 0 {
                // The child whose middle comes first along the ray is taken first.
                let [a, b] = [0, 1].map(|k| &self.nodes[node.first as usize + k]);
                let later = u32::from((b.low + b.high - a.low - a.high).dot(along) > 0.0);
                stack[depth] = node.first + later;
                stack[depth + 1] = node.first + 1 - later;
                depth += 2;
                continue;
            }
            for index in node.first as usize..(node.first + node.count) as usize {
                let Some(t) = self.triangles[index].hit(from, along) else { continue };
                if any {
                    best = Some((t, index));
                    depth = 0;
                    break;
                }
                if best.is_none_or(|(nearest, _)| t < nearest) {
                    best = Some((t, index));
                }
            }
        }
        let hit = best.map(|(distance, index)| {
            let t = &self.triangles[index];
            let inside = t.normal.dot(along) > 0.0;
            Hit { distance, normal: t.normal, albedo: t.albedo, inside }
        });
        let Some((y, albedo)) = self.ground else { return hit };
        let distance = (y - from.y) / along.y;
        if along.y < 0.0 && hit.as_ref().is_none_or(|hit| distance < hit.distance) {
            return Some(Hit {
                distance: distance.max(0.0),
                normal: Vec3::Y,
                albedo,
                inside: false,
            });
        }
        hit
    }

    /// Bakes the light of vertices; those inside of solids take it from their neighbours, so that
    /// no darkness leaks out from under a wall.
    fn light(&self, vertices: &mut [Vertex], indices: &[u32], is_mesh: bool) {
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
        let size = vertices.len().div_ceil(threads).max(1);
        let mut valid = vec![false; vertices.len()];
        std::thread::scope(|scope| {
            for (vertices, valid) in vertices.chunks_mut(size).zip(valid.chunks_mut(size)) {
                scope.spawn(move || {
                    for (vertex, valid) in vertices.iter_mut().zip(valid) {
                        *valid = self.light_vertex(vertex, is_mesh);
                    }
                });
            }
        });
        for _ in 0..64 {
            let mut sums: HashMap<u32, (f32, [f32; 4], Vec3)> = HashMap::new();
            for t in indices.chunks_exact(3) {
                for (i, j) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    for (to, from) in [(i, j), (j, i)] {
                        if !valid[to as usize] && valid[from as usize] {
                            let source = &vertices[from as usize];
                            let sum = sums.entry(to).or_default();
                            sum.0 += 1.0;
                            for (a, b) in sum.1.iter_mut().zip(source.light) {
                                *a += b;
                            }
                            sum.2 += Vec3::from(source.around);
                        }
                    }
                }
            }
            if sums.is_empty() {
                break;
            }
            for (index, (count, light, around)) in sums {
                vertices[index as usize].light = light.map(|v| v / count);
                vertices[index as usize].around = (around / count).to_array();
                valid[index as usize] = true;
            }
        }
    }

    fn light_vertex(&self, vertex: &mut Vertex, is_mesh: bool) -> bool {
        let normal = Vec3::from(vertex.normal);
        let from = p_position(vertex) + normal * self.lift;
        let frame = Quat::from_rotation_arc(Vec3::Z, normal);
        // Where there is ground, sky is what is above the horizon.
        let is_sky = |d: Vec3| self.ground.is_none() || d.y > 0.0;
        let (mut sky, mut seen, mut rays, mut inside) = (0.0_f32, 0.0_f32, 0.0_f32, 0);
        let (mut bounced, mut around) = (Vec3::ZERO, Vec3::ZERO);
        for &direction in &self.directions {
            let d = frame * direction;
            let hit = self.trace(from, d, false);
            if hit.as_ref().is_some_and(|hit| hit.inside) {
                inside += 1;
                continue;
            }
            rays += 1.0;
            sky += f32::from(is_sky(d));
            match hit {
                None => seen += f32::from(is_sky(d)),
                Some(hit) => {
                    around += hit.albedo;
                    let lit = hit.normal.dot(self.sun);
                    let at = from + d * hit.distance + hit.normal * self.lift;
                    if lit > 0.0 && self.trace(at, self.sun, true).is_none() {
                        bounced += hit.albedo * lit;
                    }
                }
            }
        }
        let visible = if sky > 0.0 { seen / sky } else { 0.0 };
        let share = if rays > 0.0 { 1.0 / rays } else { 0.0 };
        let [r, g, b] = (bounced * share).to_array();
        vertex.light = [visible, r, g, b];
        vertex.around = (around * share).to_array();
        // Single sheets are seen from behind: only what is nearly all inside is in a solid. A
        // vertex below the ground is of no use either.
        let buried = is_mesh && self.ground.is_some_and(|(y, _)| from.y < y);
        inside * 10 < RAYS * 7 && !buried
    }
}

impl Triangle {
    /// Möller and Trumbore 1997.
    fn hit(&self, from: Vec3, along: Vec3) -> Option<f32> {
        let p = along.cross(self.edges[1]);
        let determinant = self.edges[0].dot(p);
        if determinant == 0.0 {
            return None;
        }
        let inverse = determinant.recip();
        let offset = from - self.corner;
        let u = offset.dot(p) * inverse;
        let q = offset.cross(self.edges[0]);
        let v = along.dot(q) * inverse;
        let t = self.edges[1].dot(q) * inverse;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Material;
    use super::*;

    fn scene(meshes: Vec<Mesh>) -> Scene {
        Scene {
            meshes,
            ground: Some(Ground { y: 0.0, material: Material::default() }),
            ..Scene::default()
        }
    }

    #[test]
    fn splitting_keeps_the_area_and_bounds_the_edges() {
        let mesh =
            Mesh::cuboid([0.0; 3], [1.0, 0.5, 0.1], [0.0, 0.0, 0.0, 1.0], Material::default());
        let (mut vertices, mut indices) = world(&mesh);
        split(&mut vertices, &mut indices, 0.2);
        let mut area = 0.0;
        for t in indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| p_position(&vertices[t[k] as usize]));
            area += 0.5 * (b - a).cross(c - a).length();
            assert!(a.distance(b).max(b.distance(c)).max(c.distance(a)) <= 0.2 + 1e-6);
        }
        assert!((area - 2.0 * (2.0 + 0.4 + 0.2)).abs() < 1e-4, "{area}");
    }

    #[test]
    fn free_ground_sees_the_sky_and_a_wall_half_of_it_blocked() {
        let m = Material::default;
        let far = bake(&scene(vec![Mesh::sphere([0.0, 0.2, 0.0], 0.2, m())]));
        let edge = far.vertices.last().expect("has a ground");
        assert!(edge.light[0] > 0.99, "{:?}", edge.light);
        // At the foot of a very wide and high wall half of the sky is hidden.
        let wall = Mesh::cuboid([0.0, 50.0, -1.0], [100.0, 50.0, 1.0], [0.0, 0.0, 0.0, 1.0], m());
        let scene = scene(vec![wall]);
        let tracer = Tracer::new(&scene, 1.0);
        let mut foot =
            Vertex { position: [0.0, 0.0, 0.01], normal: [0.0, 1.0, 0.0], ..Vertex::default() };
        assert!(tracer.light_vertex(&mut foot, false));
        assert!((foot.light[0] - 0.5).abs() < 0.03, "{:?}", foot.light);
    }

    #[test]
    fn bounced_sunlight_matches_a_closed_form() {
        // Sun overhead on an endless ground: a vertical face gets half of what the ground sends.
        let mut scene = scene(vec![]);
        scene.sun.direction = [0.0, 1.0, 0.0];
        let tracer = Tracer::new(&scene, 1.0);
        let mut side =
            Vertex { position: [0.0, 1.0, 0.0], normal: [1.0, 0.0, 0.0], ..Vertex::default() };
        assert!(tracer.light_vertex(&mut side, true));
        assert!((side.light[1] - 0.6 * 0.5).abs() < 0.02, "{:?}", side.light);
        assert!((side.light[0] - 1.0).abs() < 1e-6);
    }
}
