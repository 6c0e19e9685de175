//! Finds the part of a picture that shoreline foam can cover, from the scene's meshes and the picture's depth.

use std::collections::HashMap;

use glam::{IVec2, Mat4, Vec2, Vec3};
use whitewater::Camera;
use whitewater::headless::Picture;
use whitewater::headless::scene::Scene;

use crate::camera::Lens;
use crate::failure::Outcome;
use crate::shore::transforms;

/// Segments of the waterline, where meshes cross the sea's level. They are kept in a grid, whose cells list the
/// segments within reach.
pub struct Waterline {
    reach: f32,
    cells: HashMap<IVec2, Vec<[Vec2; 2]>>,
}

impl Waterline {
    /// The waterline of a scene's frame: where its meshes cross the height `level`. Segments inside other meshes of
    /// land are kept. They change nothing, because every point of the water is nearer to the shore of the outer mesh
    /// than to them.
    pub fn new(scene: &Scene, level: f32, reach: f32) -> Self {
        let mut line = Self { reach, cells: HashMap::new() };
        for (mesh, at) in scene.meshes.iter().zip(transforms(scene, scene.frame)) {
            for corners in mesh.indices.chunks_exact(3) {
                let place = |i: u32| at.transform_point3(mesh.positions[i as usize].into());
                let [a, b, c] = [0, 1, 2].map(|k| place(corners[k]));
                let crossed = [(a, b), (b, c), (c, a)].map(|(a, b)| crossing(a, b, level));
                let mut ends = crossed.into_iter().flatten();
                if let (Some(from), Some(to)) = (ends.next(), ends.next()) {
                    line.add([from, to]);
                }
            }
        }
        line
    }

    fn add(&mut self, piece: [Vec2; 2]) {
        let [a, b] = piece;
        let (low, high) = (a.min(b) - self.reach, a.max(b) + self.reach);
        let (low, high) = (self.cell(low), self.cell(high));
        for (x, y) in (low.y..=high.y).flat_map(|y| (low.x..=high.x).map(move |x| (x, y))) {
            self.cells.entry(IVec2::new(x, y)).or_default().push(piece);
        }
    }

    fn cell(&self, p: Vec2) -> IVec2 {
        (p / self.reach).floor().as_ivec2()
    }

    /// Whether a place is within `reach` of a shore.
    fn is_near(&self, p: Vec2) -> bool {
        let pieces = self.cells.get(&self.cell(p)).map_or(&[][..], |pieces| pieces);
        let near = |[a, b]: &[Vec2; 2]| {
            let along = *b - *a;
            let t = (p - *a).dot(along) / along.length_squared().max(1e-12);
            p.distance_squared(*a + t.clamp(0.0, 1.0) * along) <= self.reach * self.reach
        };
        pieces.iter().any(near)
    }
}

/// Point where an edge crosses the water's level.
fn crossing(a: Vec3, b: Vec3, level: f32) -> Option<Vec2> {
    let (above, below) = (a.y - level, b.y - level);
    ((above >= 0.0) != (below >= 0.0)).then(|| {
        let p = a.lerp(b, above / (above - below));
        Vec2::new(p.x, p.z)
    })
}

/// The rays of a camera.
pub struct Rays {
    eye: Vec3,
    inverse: Mat4,
    view: Mat4,
}

impl Rays {
    pub fn new(camera: &Camera) -> Self {
        let eye = camera.view_matrix().inverse().transform_point3(Vec3::ZERO);
        let inverse = (camera.projection_matrix() * camera.view_matrix()).inverse();
        Self { eye, inverse, view: camera.view_matrix() }
    }

    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// Point where the ray through a place in the picture meets the level plane at height `level`; `None` if it does
    /// not. `at` is the place, from (0, 0) at the first pixel's corner to (1, 1) at the opposite corner.
    pub fn meets(&self, at: Vec2, level: f32) -> Option<Vec3> {
        let ndc = 2.0 * at - 1.0;
        let through = self.inverse.project_point3(ndc.extend(0.5));
        let along = through - self.eye;
        let t = (level - self.eye.y) / along.y;
        (t > 0.0 && t.is_finite()).then(|| self.eye + t * along)
    }
}

/// Share of the picture that shows water with a shore coordinate v from 0 to 2, that is, water within reach of a
/// shore. `depth` is the picture's device depth.
pub fn band(depth: &Picture<f32>, camera: &Camera, level: f32, line: &Waterline) -> Outcome<f64> {
    let (rays, lens) = (Rays::new(camera), Lens::new(camera)?);
    let size = Vec2::new(depth.width as f32, depth.height as f32);
    let is_in = |(i, device): (usize, &f32)| {
        let at = Vec2::new((i % depth.width) as f32, (i / depth.width) as f32) + 0.5;
        let Some(place) = rays.meets(at / size, level) else { return false };
        let away = rays.view.transform_point3(place).z.abs();
        away < lens.eye_depth(*device) && line.is_near(Vec2::new(place.x, place.z))
    };
    let count = depth.data.iter().enumerate().filter(|pixel| is_in(*pixel)).count();
    Ok(count as f64 / depth.data.len() as f64)
}

#[cfg(test)]
mod tests {
    use whitewater::headless::scene::{Material, Mesh};

    use super::*;
    use crate::camera::CameraFile;

    /// A ball that is half in the water, seen from straight above: the water near its shore is a ring.
    #[test]
    fn a_ring_round_a_ball() {
        let ball = Mesh::sphere([0.5, 2.0, -1.0], 3.0, Material::default());
        let scene = Scene { meshes: vec![ball], ..Scene::default() };
        let line = Waterline::new(&scene, 2.0, 1.5);
        for (away, near) in [(3.1, true), (4.4, true), (4.6, false), (9.0, false), (1.4, false)] {
            for i in 0..12 {
                let at = Vec2::new(0.5, -1.0) + away * Vec2::from_angle(0.5 * i as f32);
                assert_eq!(line.is_near(at), near, "{away}");
            }
        }
        let camera = CameraFile {
            eye: Some([0.5, 22.0, -1.0]),
            target: Some([0.5, 2.0, -1.0]),
            up: Some([0.0, 0.0, -1.0]),
            fov_y_degrees: Some(60.0),
            ..CameraFile::default()
        };
        let (width, height) = (200, 100);
        let camera = camera.camera((200, 100)).unwrap();
        let rays = Rays::new(&camera);
        // Depth is reversed: 0 is the far end; half of the picture has a lid at depth 1.
        let pixel = |i: usize| if i % width < width / 2 { 1.0 } else { 0.0 };
        let data = (0..width * height).map(pixel).collect();
        let depth = Picture { width, height, data };
        let share = band(&depth, &camera, 2.0, &line).unwrap();
        let across = 2.0 * 20.0 * 30.0_f64.to_radians().tan();
        let ring = std::f64::consts::PI * (4.5_f64.powi(2) - 1.5_f64.powi(2));
        let expected = 0.5 * ring / (2.0 * across * across);
        assert!((share / expected - 1.0).abs() < 0.03, "{share}, {expected} expected");
        assert!(rays.meets(Vec2::new(0.5, 0.5), 30.0).is_none(), "above the eye");
    }
}
