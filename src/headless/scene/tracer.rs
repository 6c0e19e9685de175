//! Bakes indirect light by rays from each vertex: visibility of the sky, sunlight that has bounced once or twice off
//! other surfaces, and the albedo of the surroundings. The backdrop gets one bounce only, and far away few rays or
//! none. Deterministic: the directions are fixed, only turned to each vertex's normal.

use std::collections::HashMap;

use glam::{Quat, Vec3};

use super::bake::{Vertex, world};
use super::{Mesh, Scene};

/// Rays per vertex.
const RAYS: usize = 64;
/// Rays per vertex of the backdrop: `FEW` over the hemisphere for vertices not near the meshes, `FEWEST` for
/// farther ones; and `SUNS` to the sun, for farther vertices one. `PENUMBRA` is the tangent of the angular radius
/// that the sun is given, larger than the real one, because leaves blur shadows.
const FEW: usize = 6;
const FEWEST: usize = 4;
const SUNS: usize = 2;
const PENUMBRA: f32 = 0.06;
/// Distance from the scene's centre up to which rays are traced for the light of the backdrop, in multiples of
/// `Around::near`, the distance up to which it counts as near the meshes.
const FAR: f32 = 14.0;

struct Triangle {
    corner: Vec3,
    edges: [Vec3; 2],
    normal: Vec3,
    albedo: Vec3,
}

/// A leaf has `count` triangles from `first`. An inner node has `count` 0 and the children `first` and `first
/// + 1`.
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
    /// Whether the ray hit a back face, so that it began inside a solid.
    inside: bool,
}

/// Traces rays against the triangles before subdivision.
pub struct Tracer {
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
    ground: Option<(f32, Vec3)>,
    sun: Vec3,
    /// Offset of a ray's origin from its surface.
    lift: f32,
    directions: Vec<Vec3>,
}

impl Tracer {
    pub fn new(scene: &Scene, diagonal: f32) -> Self {
        Self::of(&scene.meshes, |_, _| true, scene, diagonal)
    }

    /// A tracer for `meshes` and the scene's ground. `counts` receives a corner and the size of a triangle and
    /// returns whether the triangle is used; it rejects distant ones.
    fn of<'a>(
        meshes: impl IntoIterator<Item = &'a Mesh>,
        counts: impl Fn(Vec3, f32) -> bool,
        scene: &Scene,
        diagonal: f32,
    ) -> Self {
        let mut triangles = Vec::new();
        for mesh in meshes {
            let albedo = mesh.material.albedo();
            let (vertices, indices) = world(mesh);
            for t in indices.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|k| vertices[t[k] as usize].at());
                if !counts(a, (b - a).length().max((c - a).length())) {
                    continue;
                }
                let mut normal = (b - a).cross(c - a).normalize_or_zero();
                // The winding is not reliable; the vertex normal tells the outside.
                if normal.dot(vertices[t[0] as usize].normal.into()) < 0.0 {
                    normal = -normal;
                }
                triangles.push(Triangle { corner: a, edges: [b - a, c - a], normal, albedo });
            }
        }
        let mut tracer = Self {
            triangles,
            nodes: Vec::new(),
            ground: scene.ground.as_ref().map(|g| (g.y, g.material.albedo())),
            sun: Vec3::from(scene.sun.direction).normalize_or(Vec3::Y),
            lift: 5e-4 * diagonal,
            directions: directions(RAYS),
        };
        tracer.nodes.push(Node { low: Vec3::ZERO, high: Vec3::ZERO, first: 0, count: 0 });
        tracer.build(0, 0, 0, tracer.triangles.len());
        tracer
    }

    /// Builds the nodes below `node`, at a depth of `level`, for a part of the triangles.
    fn build(&mut self, node: usize, level: u32, first: usize, end: usize) {
        let part = &mut self.triangles[first..end];
        let Bounds { low, high } = Bounds::of(part);
        if part.len() <= 4 {
            self.nodes[node] = Node { low, high, first: first as u32, count: part.len() as u32 };
            return;
        }
        let middle = if level < CHOSEN { cut(part) } else { None };
        let middle = middle.unwrap_or_else(|| halve(part, (high - low).max_position()));
        let child = self.nodes.len();
        let empty = || Node { low, high, first: 0, count: 0 };
        self.nodes.push(empty());
        self.nodes.push(empty());
        self.nodes[node] = Node { low, high, first: child as u32, count: 0 };
        self.build(child, level + 1, first, first + middle);
        self.build(child + 1, level + 1, first + middle, end);
    }

    /// The nearest hit; with `any`, the first hit found.
    fn trace(&self, from: Vec3, along: Vec3, any: bool) -> Option<Hit> {
        self.trace_to(f32::INFINITY, from, along, any)
    }

    /// The same, for hits nearer than `reach`.
    fn trace_to(&self, reach: f32, from: Vec3, along: Vec3, any: bool) -> Option<Hit> {
        let inverse = along.recip();
        let mut best: Option<(f32, usize)> = None;
        // From a depth of CHOSEN on each level halves the triangles, so 64 levels are never reached.
        let mut stack = [0u32; 64];
        let mut depth = 1;
        while depth > 0 && !self.triangles.is_empty() {
            depth -= 1;
            let node = &self.nodes[stack[depth] as usize];
            let (a, b) = ((node.low - from) * inverse, (node.high - from) * inverse);
            let near = a.min(b).max_element().max(0.0);
            let far = a.max(b).min_element();
            // A ray in the plane of a box's face gives NaN here and is not rejected.
            if near > far || near > reach || best.is_some_and(|(t, _)| near > t) {
                continue;
            }
            if node.count == 0 {
                // Visit the child first whose centre comes first along the ray.
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

    /// Bakes the indirect light of the vertices. A vertex inside a solid takes the light of its neighbours in the
    /// triangles, so that no darkness leaks out from under a wall. With `is_mesh` (a mesh, not the ground) a vertex
    /// below the ground counts as inside a solid, too.
    pub fn light(&self, vertices: &mut [Vertex], indices: &[u32], is_mesh: bool) {
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

    /// The sun's irradiance at a point of a surface, divided by that on a surface that faces the sun; 0 in
    /// shadow.
    fn sunny(&self, at: Vec3, normal: Vec3) -> f32 {
        let cosine = normal.dot(self.sun);
        if cosine > 0.0 && self.trace(at, self.sun, true).is_none() { cosine } else { 0.0 }
    }

    fn light_vertex(&self, vertex: &mut Vertex, is_mesh: bool) -> bool {
        let normal = Vec3::from(vertex.normal);
        let from = vertex.at() + normal * self.lift;
        let frame = Quat::from_rotation_arc(Vec3::Z, normal);
        // With a ground, only directions above the horizon count as sky.
        let is_sky = |d: Vec3| self.ground.is_none() || d.y > 0.0;
        let (mut sky, mut seen, mut rays, mut inside) = (0.0_f32, 0.0_f32, 0.0_f32, 0);
        let (mut bounced, mut around) = (Vec3::ZERO, Vec3::ZERO);
        for (i, &direction) in self.directions.iter().enumerate() {
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
                    let at = from + d * hit.distance + hit.normal * self.lift;
                    let mut light = Vec3::splat(self.sunny(at, hit.normal));
                    // One ray for the second bounce, in another direction for each hit of the first: a wall above
                    // its own shadow is lit by the sunlit ground beyond the shadow.
                    let turn = Quat::from_rotation_arc(Vec3::Z, hit.normal);
                    let d = turn * self.directions[(29 * i + 13) % self.directions.len()];
                    if let Some(next) = self.trace(at, d, false).filter(|next| !next.inside) {
                        let at = at + d * next.distance + next.normal * self.lift;
                        light += next.albedo * self.sunny(at, next.normal);
                    }
                    bounced += hit.albedo * light;
                }
            }
        }
        let visible = if sky > 0.0 { seen / sky } else { 0.0 };
        let share = if rays > 0.0 { 1.0 / rays } else { 0.0 };
        let [r, g, b] = (bounced * share).to_array();
        vertex.light = [visible, r, g, b];
        vertex.around = (around * share).to_array();
        // Surfaces without thickness have back faces without being solids, so a vertex counts as inside a solid
        // only if at least 70 % of its rays hit back faces. A vertex of a mesh below the ground counts as inside
        // too.
        let buried = is_mesh && self.ground.is_some_and(|(y, _)| from.y < y);
        inside * 10 < RAYS * 7 && !buried
    }
}

/// Cosine-weighted directions around +z on a Fibonacci spiral.
fn directions(count: usize) -> Vec<Vec3> {
    (0..count)
        .map(|i| {
            let u = (i as f32 + 0.5) / count as f32;
            let (sin, cos) = (2.399_963_1 * i as f32).sin_cos();
            Vec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt())
        })
        .collect()
}

/// Bakes the light of the backdrop: near the meshes with as many rays per vertex as for the meshes, farther away
/// with few rays, and very far away without rays.
pub struct Around {
    all: Tracer,
    /// Finds whether the backdrop hides the sun; the meshes' own shadow is in the shadow map.
    backdrop: Tracer,
    few: Vec<Vec3>,
    fewest: Vec<Vec3>,
    to_sun: [Vec3; SUNS],
    middle: Vec3,
    near: f32,
}

impl Around {
    pub fn new(scene: &Scene, diagonal: f32) -> Self {
        let (low, high) = scene.bounds();
        let (middle, near) = (0.5 * (low + high), 0.75 * diagonal);
        let counts = |at: Vec3, size: f32| at.distance(middle) - size < FAR * near;
        let all = scene.meshes.iter().chain(&scene.backdrop);
        let all = Tracer::of(all, counts, scene, diagonal);
        let backdrop = Tracer::of(&scene.backdrop, counts, &Scene::default(), diagonal);
        let turn = Quat::from_rotation_arc(Vec3::Z, all.sun);
        let to_sun = std::array::from_fn(|i| {
            let (sin, cos) = (2.399_963_1 * i as f32).sin_cos();
            let away = PENUMBRA * ((i as f32 + 0.5) / SUNS as f32).sqrt();
            (turn * Vec3::new(away * cos, away * sin, 1.0)).normalize()
        });
        Self {
            all,
            backdrop,
            few: directions(FEW),
            fewest: directions(FEWEST),
            to_sun,
            middle,
            near,
        }
    }

    /// Bakes the light of the backdrop's vertices: the visible fractions of sky and sun, the light bounced by other
    /// surfaces, and their albedo. Here, unlike in `Tracer::light`, a vertex inside a solid does not take the light of
    /// its neighbours but stays dark: leaves deep inside a bush are dark, too.
    pub fn light(&self, vertices: &mut [Vertex]) {
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
        let size = vertices.len().div_ceil(threads).max(1);
        std::thread::scope(|scope| {
            for part in vertices.chunks_mut(size) {
                scope.spawn(move || {
                    let mut last = Vertex { position: [f32::MAX; 3], ..Vertex::default() };
                    for vertex in part {
                        // The corners of a leaf share their light.
                        let same = vertex.normal == last.normal
                            && vertex.at().distance(last.at()) < 0.05 * self.near;
                        if same {
                            let Vertex { light, around, bulge, .. } = last;
                            *vertex = Vertex { light, around, bulge, ..*vertex };
                        } else {
                            self.light_vertex(vertex);
                            last = *vertex;
                        }
                    }
                });
            }
        });
    }

    fn light_vertex(&self, vertex: &mut Vertex) {
        let away = vertex.at().distance(self.middle);
        if away > FAR * self.near {
            // Haze hides about half of what is so far away, so no rays are traced: the vertex gets full sun,
            // and as much sky as its slope alone allows.
            vertex.bulge = 1.0;
            let down = 0.5 - 0.5 * vertex.normal[1];
            vertex.light = [1.0 - 0.6 * down, 0.0, 0.0, 0.0];
            return;
        }
        let near = away < self.near;
        // Distant objects hide little of a tree's sky, hence the limited reach.
        let (directions, reach) = match near {
            true => (&self.all.directions, f32::INFINITY),
            false => (&self.few, self.near),
        };
        let farther = !near && away > 3.0 * self.near;
        let directions = if farther { &self.fewest } else { directions };
        let to_sun = if farther { &self.to_sun[..1] } else { &self.to_sun };
        let normal = Vec3::from(vertex.normal);
        let from = vertex.at() + normal * 4.0 * self.all.lift;
        let frame = Quat::from_rotation_arc(Vec3::Z, normal);
        let (mut sky, mut seen, mut bounced, mut around) = (0.0_f32, 0.0, Vec3::ZERO, Vec3::ZERO);
        for direction in directions {
            let d = frame * *direction;
            sky += f32::from(d.y > 0.0);
            match self.all.trace_to(reach, from, d, !near) {
                None => seen += f32::from(d.y > 0.0),
                Some(hit) if hit.inside => {}
                Some(hit) => {
                    around += hit.albedo;
                    // No ray is traced from the hit point to the sun: the visibility of the sun at the vertex
                    // stands for it, below.
                    bounced += hit.albedo * hit.normal.dot(self.all.sun).max(0.0);
                }
            }
        }
        let sunny = to_sun.iter().filter(|to| self.backdrop.trace(from, **to, true).is_none());
        vertex.bulge = sunny.count() as f32 / to_sun.len() as f32;
        let share = (directions.len() as f32).recip();
        let [r, g, b] = (bounced * share * (0.3 + 0.7 * vertex.bulge)).to_array();
        vertex.light = [if sky > 0.0 { seen / sky } else { 0.0 }, r, g, b];
        vertex.around = (around * share).to_array();
    }
}

/// Depth of the tree from which on a node is halved instead of cut where it is best, so that the stack of a ray is
/// deep enough for any scene.
const CHOSEN: u32 = 36;
/// Intervals of an axis between which a node may be cut.
const BINS: usize = 12;

/// A box.
#[derive(Clone, Copy)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    const EMPTY: Self = Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    fn of(part: &[Triangle]) -> Self {
        part.iter().fold(Self::EMPTY, |all, t| all.with(t.bounds()))
    }

    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half the surface; 0 of nothing.
    fn area(self) -> f32 {
        let Vec3 { x, y, z } = (self.high - self.low).max(Vec3::ZERO);
        x * y + y * z + z * x
    }
}

/// Sorts triangles into two groups. The cost of a cut (surface area heuristic, MacDonald and Booth 1990) is the sum
/// over both groups of their number of triangles times the surface of their bounds; the cheapest cut is taken. Returns
/// how many triangles are in the first group; `None` if all centres are in one spot.
fn cut(part: &mut [Triangle]) -> Option<usize> {
    let low = part.iter().fold(Vec3::INFINITY, |low, t| low.min(t.centre()));
    let high = part.iter().fold(Vec3::NEG_INFINITY, |high, t| high.max(t.centre()));
    let scale = Vec3::splat(BINS as f32) / (high - low);
    let bin = |t: &Triangle, axis: usize| {
        (((t.centre() - low)[axis] * scale[axis]) as usize).min(BINS - 1)
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in (0..3).filter(|axis| high[*axis] > low[*axis]) {
        let mut bins = [(Bounds::EMPTY, 0); BINS];
        for t in &*part {
            let (bounds, count) = &mut bins[bin(t, axis)];
            *bounds = bounds.with(t.bounds());
            *count += 1;
        }
        let cost = |bins: &[(Bounds, usize)]| {
            let sum = |(all, n): (Bounds, usize), (bounds, count): &(Bounds, usize)| {
                (all.with(*bounds), n + count)
            };
            let (all, n) = bins.iter().fold((Bounds::EMPTY, 0), sum);
            if n == 0 { f32::INFINITY } else { n as f32 * all.area() }
        };
        for at in 1..BINS {
            let cost = cost(&bins[..at]) + cost(&bins[at..]);
            if cost.is_finite() && best.is_none_or(|(least, _, _)| cost < least) {
                best = Some((cost, axis, at));
            }
        }
    }
    let (_, axis, at) = best?;
    let mut count = 0;
    for i in 0..part.len() {
        if bin(&part[i], axis) < at {
            part.swap(i, count);
            count += 1;
        }
    }
    Some(count)
}

/// Sorts triangles into two halves along an axis. Returns how many are in the first half.
fn halve(part: &mut [Triangle], axis: usize) -> usize {
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| a.centre()[axis].total_cmp(&b.centre()[axis]));
    middle
}

impl Triangle {
    fn centre(&self) -> Vec3 {
        self.corner + (self.edges[0] + self.edges[1]) / 3.0
    }

    fn bounds(&self) -> Bounds {
        let [b, c] = self.edges.map(|edge| self.corner + edge);
        Bounds { low: self.corner.min(b).min(c), high: self.corner.max(b).max(c) }
    }

    /// Ray against triangle after Möller and Trumbore 1997.
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
    use super::super::bake::bake;
    use super::super::{Ground, Material, Mesh};
    use super::*;

    fn scene(meshes: Vec<Mesh>) -> Scene {
        Scene {
            meshes,
            ground: Some(Ground { y: 0.0, material: Material::default(), reach: None }),
            ..Scene::default()
        }
    }

    /// The tree finds the same nearest triangles as a search of all, also where many triangles coincide.
    #[test]
    fn the_tree_loses_no_triangle() {
        let mut state = 7_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0 - 0.5
        };
        let mut triangles: Vec<Triangle> = Vec::new();
        for i in 0..600 {
            let [corner, a, b] = std::array::from_fn(|_| Vec3::new(random(), random(), random()));
            // A third of them share their centre; some are large.
            let corner = if i % 3 == 0 { Vec3::splat(0.2) } else { corner };
            let size = if i % 50 == 0 { 2.0 } else { 0.1 };
            let edges =
                if i % 3 == 0 { [Vec3::X * 0.1, Vec3::Y * 0.1] } else { [a * size, b * size] };
            triangles.push(Triangle { corner, edges, normal: Vec3::Y, albedo: Vec3::ONE });
        }
        let mut tracer = Tracer::new(&Scene::default(), 1.0);
        tracer.triangles = triangles;
        tracer.nodes.truncate(1);
        tracer.build(0, 0, 0, tracer.triangles.len());
        let mut hits = 0;
        for _ in 0..500 {
            let [from, to] = std::array::from_fn(|_| Vec3::new(random(), random(), random()));
            let along = (to - 2.0 * from).normalize();
            let all = tracer.triangles.iter().filter_map(|t| t.hit(from, along));
            let expected = all.reduce(f32::min);
            assert_eq!(tracer.trace(from, along, false).map(|hit| hit.distance), expected);
            assert_eq!(tracer.trace(from, along, true).is_some(), expected.is_some());
            hits += u32::from(expected.is_some());
        }
        assert!((100..500).contains(&hits), "{hits}");
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

    #[test]
    fn sunlight_bounces_twice() {
        // The sun is overhead: it lights the ground, but not a very wide and high wall. The lit ground is half of
        // what the wall sees, and the wall is half of what the ground at its foot sees.
        let wall = Mesh::cuboid(
            [0.0, 500.0, -1.0],
            [1000.0, 500.0, 1.0],
            [0.0, 0.0, 0.0, 1.0],
            Material::default(),
        );
        let mut scene = scene(vec![wall]);
        scene.sun.direction = [0.0, 1.0, 0.0];
        let tracer = Tracer::new(&scene, 1.0);
        let mut foot =
            Vertex { position: [0.0, 0.0, 0.01], normal: [0.0, 1.0, 0.0], ..Vertex::default() };
        assert!(tracer.light_vertex(&mut foot, false));
        // Half of the 64 rays hit the wall. The second ray of each hits the ground with a probability of a
        // half: the tolerance is four standard deviations of the mean of these 32.
        let expected = 0.6 * 0.6 * 0.5 * 0.5;
        let deviation = 0.6 * 0.6 * (32.0_f32 * 0.25).sqrt() / 64.0;
        assert!((foot.light[1] - expected).abs() < 4.0 * deviation, "{:?}", foot.light);
        assert!(foot.light[1] > 0.5 * expected, "{:?}", foot.light);
    }
}
