//! The wall between two bubbles by the source's construction, with the centre corrected as in
//! `layered`.

use glam::DVec3;

/// A spherical wall. Bubbles of equal radius have a plane wall, which this type cannot describe.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    pub center: DVec3,
    pub radius: f64,
}

/// Angle between the radii of two bubbles at a point of the circle in which their spheres
/// intersect.
pub fn angle(a: f64, b: f64, apart: f64) -> f64 {
    ((a * a + b * b - apart * apart) / (2.0 * a * b)).acos()
}

/// The wall between two intersecting spheres; the first is the larger one.
pub fn between((a, r_a): (DVec3, f64), (b, r_b): (DVec3, f64)) -> Wall {
    let apart = a.distance(b);
    let delta = angle(r_a, r_b, apart);
    let m_d = r_b * (2.0 - 2.0 * delta.cos()).sqrt();
    let radius = r_a * m_d / (r_a - r_b);
    let way = (r_a * r_a + radius * radius
        - 2.0 * r_a * radius * ((delta + std::f64::consts::PI) / 2.0).cos())
    .sqrt();
    Wall { center: a + (b - a) / apart * way, radius }
}

/// A point of the circle in which the two spheres intersect; `turn` is its angle about their axis.
pub fn common((a, r_a): (DVec3, f64), (b, r_b): (DVec3, f64), turn: f64) -> DVec3 {
    let apart = a.distance(b);
    let along = (r_a * r_a - r_b * r_b + apart * apart) / (2.0 * apart);
    let out = (r_a * r_a - along * along).sqrt();
    let axis = (b - a) / apart;
    let side = axis.any_orthonormal_vector();
    a + axis * along + out * (side * turn.cos() + axis.cross(side) * turn.sin())
}
