//! Solids besides those of a step: a distance field on a grid.

use glam::Vec3;

use crate::error::Error;
use crate::water::settings::GREATEST;

/// Signed distances from a solid of any shape, negative inside, at the points of a grid, interpolated linearly in
/// between. Outside the grid there is no solid.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceField {
    /// Points along each axis, 2 to 1024; x varies fastest.
    pub points: [u32; 3],
    /// Position of the first point, scene units, each component [-1e12, 1e12].
    pub corner: [f32; 3],
    /// Distance between neighbouring points, scene units, [1e-12, 1e12].
    pub edge: f32,
    /// Distances, one per point, scene units, [-1e12, ∞), finite.
    pub distances: Vec<f32>,
}

impl DistanceField {
    pub(super) fn check(&self) -> Result<(), Error> {
        let bad = |why: String| Err(Error::bad("DistanceField", why));
        if !self.points.iter().all(|n| (2..=1024).contains(n)) {
            return bad(format!("expected 2 to 1024 points per axis, found {:?}", self.points));
        }
        let count = self.points.iter().map(|n| *n as usize).product::<usize>();
        if self.distances.len() != count {
            return bad(format!("expected {count} distances, found {}", self.distances.len()));
        }
        // Beyond this, products in the shader may overflow. Comparisons with NaN are false.
        let near = self.corner.iter().all(|v| v.abs() <= GREATEST);
        let good = self.distances.iter().all(|v| v.is_finite() && *v >= -GREATEST);
        if !near || !good || !(1.0e-12..=GREATEST).contains(&self.edge) {
            let why = "expected a corner within ±1e12, an edge of 1e-12 to 1e12, \
                       and finite distances from -1e12 on";
            return bad(why.into());
        }
        Ok(())
    }

    /// Checks that the field fits in one binding of `most` bytes.
    pub(super) fn check_binding(&self, most: u32) -> Result<(), Error> {
        let bytes = size_of_val(&self.distances[..]);
        if bytes as u64 <= u64::from(most) {
            return Ok(());
        }
        let why = format!(
            "{:?} points take {bytes} bytes, more than the device's limit of {most}; choose a longer edge",
            self.points
        );
        Err(Error::bad("DistanceField", why))
    }

    /// The field of a mesh (three corners per triangle), on a grid with points `edge` apart and a margin of `margin`
    /// around the mesh. The winding number of a point decides whether it is inside (Jacobson, Kavan, Sorkine-Hornung,
    /// Robust Inside-Outside Segmentation using Generalized Winding Numbers, 2013), so the mesh may have holes and
    /// intersect itself. The time is proportional to the number of points times the number of triangles.
    ///
    /// # Errors
    /// No triangles, corners that are not finite, an `edge` that is not above 0, a negative `margin`, or more than
    /// 1024 grid points along an axis.
    pub fn of_mesh(triangles: &[[[f32; 3]; 3]], edge: f32, margin: f32) -> Result<Self, Error> {
        let bad = |why: &str| Err(Error::bad("DistanceField", why));
        let corners = || triangles.iter().flatten().map(|c| Vec3::from(*c));
        if triangles.is_empty() || !corners().all(|c| c.is_finite()) {
            return bad("expected triangles with finite corners");
        }
        if !(edge.is_finite() && edge > 0.0 && margin.is_finite() && margin >= 0.0) {
            return bad("expected an edge above 0 and a margin of at least 0");
        }
        let low = corners().reduce(Vec3::min).unwrap_or_default() - margin;
        let high = corners().reduce(Vec3::max).unwrap_or_default() + margin;
        let span = ((high - low) / edge).ceil();
        if span.max_element() > 1022.0 {
            return bad("more than 1024 points along an axis; choose a longer edge");
        }
        let points = span.to_array().map(|n| n as u32 + 2);
        let mut distances = Vec::with_capacity(points.iter().map(|n| *n as usize).product());
        for z in 0..points[2] {
            for y in 0..points[1] {
                for x in 0..points[0] {
                    let at = low + edge * Vec3::new(x as f32, y as f32, z as f32);
                    let (mut nearest, mut winds) = (f32::INFINITY, 0.0);
                    for triangle in triangles {
                        let [a, b, c] = triangle.map(Vec3::from);
                        nearest = nearest.min(to_triangle(at, [a, b, c]));
                        winds += solid_angle([a - at, b - at, c - at]);
                    }
                    let inside = winds.abs() > 2.0 * std::f32::consts::PI;
                    distances.push(if inside { -nearest } else { nearest });
                }
            }
        }
        Ok(Self { points, corner: low.to_array(), edge, distances })
    }
}

/// Distance of a point from a triangle (Ericson, Real-Time Collision Detection, 2004, Sec. 5.1.5).
fn to_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> f32 {
    let along = |from: Vec3, to: Vec3| {
        let way = to - from;
        let t = ((p - from).dot(way) / way.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        p.distance(from + t * way)
    };
    let normal = (b - a).cross(c - a);
    let over = |from: Vec3, to: Vec3| (to - from).cross(p - from).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && over(a, b) && over(b, c) && over(c, a) {
        return (p - a).dot(normal.normalize()).abs();
    }
    along(a, b).min(along(b, c)).min(along(c, a))
}

/// Solid angle of a triangle seen from the origin (Van Oosterom, Strackee 1983).
fn solid_angle([a, b, c]: [Vec3; 3]) -> f32 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * a.dot(b.cross(c)).atan2(below)
}
