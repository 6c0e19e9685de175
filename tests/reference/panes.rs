//! Twin of water that is flush with panes of glass (rules in src/water/panes.rs). A view ray's point
//! on a pane is the solution of a linear system.

use glam::{DMat3, DVec3};

use super::surface::Surface;

/// Distance in spacings up to which water is flush: of a surface at right angles to the pane and of
/// one that is parallel to it.
const NEAR: [f64; 2] = [0.5, 1.5];

/// A pane in eye space.
#[derive(Clone, Copy, Debug)]
pub struct Pane {
    pub corner: DVec3,
    pub edges: [DVec3; 2],
    /// Unit vector away from the water, at right angles to the edges.
    pub away: DVec3,
}

/// A surface that a pane has made flat.
#[derive(Clone, Copy, Debug)]
pub struct Flat {
    pub position: DVec3,
    /// Depth by which the surface moved towards the eye.
    pub gained: f64,
    pub normal: DVec3,
}

impl Pane {
    /// Coordinates of a point along the edges, and its distance from the plane.
    fn place(&self, point: DVec3) -> DVec3 {
        let [a, b] = self.edges;
        DMat3::from_cols(a, b, self.away).inverse() * (point - self.corner)
    }

    /// Where a ray from the eye passes through the plane.
    fn hit(&self, ray: DVec3) -> DVec3 {
        let [a, b] = self.edges;
        let k = DMat3::from_cols(ray, -a, -b).inverse() * self.corner;
        k.x * ray
    }
}

/// The flat surface, if the surface is near a pane, and the smallest distance of a decision to its
/// limit: lengths in spacings, positions on a pane in its edges.
pub fn flush(panes: &[Pane], surface: &Surface, spacing: f64) -> (Option<Flat>, f64) {
    let Surface { position, normal, .. } = *surface;
    let mut margin = f64::INFINITY;
    let mut on_pane = |at: DVec3| {
        let off = [at.x, 1.0 - at.x, at.y, 1.0 - at.y].into_iter().fold(f64::INFINITY, f64::min);
        margin = margin.min(off.abs());
        off >= 0.0
    };
    let mut found = None;
    let mut near = f64::INFINITY;
    for pane in panes.iter().filter(|pane| pane.away.dot(position) < 0.0) {
        let (hit, own) = (pane.hit(position), pane.place(position));
        let limit = NEAR[0] + (NEAR[1] - NEAR[0]) * pane.away.dot(normal).max(0.0);
        near = near.min((own.z.abs() / spacing - limit).abs());
        if hit.dot(position) <= 0.0 || own.z.abs() >= limit * spacing {
            continue;
        }
        let through = on_pane(pane.place(hit));
        if through || own.z > 0.0 && on_pane(own) {
            found = Some(*pane);
        }
    }
    let flat = found.map(|pane| {
        let at = pane.hit(position);
        Flat { position: at, gained: at.z - position.z, normal: pane.away }
    });
    (flat, margin.min(near))
}
