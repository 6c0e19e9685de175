//! Panes of glass that water stands against.

use glam::{DMat4, DVec3, DVec4, Mat4};

use crate::error::Error;
use crate::water::settings::GREATEST;

/// Largest number of panes in a frame.
pub const MAX_PANES: usize = 8;

/// A flat pane of glass, or another clear flat wall, that water stands against and is seen through: a parallelogram.
/// The front surface of the water near a pane is drawn flat, in the pane's plane. (Without the pane it would be a
/// relief of particles.) "Near" means within 1.5 spacings, and within half a spacing where the water's surface is at
/// right angles to the pane. Foam behind the pane shows only a third of its lace, because it is a cloud of bubbles there
/// and no layer on a surface. If a ray meets water that is near two panes, the last one counts.
///
/// The renderer does not draw the glass. Water at a pane has neither reflection nor highlight, because the front of
/// the glass reflects instead. Only the picture is flush: layers such as `water.depth`, motion vectors, shadows and
/// caustics keep the particles' surface, and so does the back one of two layers of water. With the thesis' way of
/// compositing, panes have no effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pane {
    /// A corner, world space, finite.
    pub corner: [f32; 3],
    /// The two edges from this corner, world space, finite, not parallel. `edges[0] × edges[1]` points away from the
    /// water. From the water's side the pane has no effect.
    pub edges: [[f32; 3]; 2],
}

impl Pane {
    /// Checks the numbers. The error says what was found.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        let numbers = self.edges.as_flattened().iter().chain(&self.corner);
        if !numbers.copied().all(|x| x.abs() <= GREATEST) {
            return Err("a number that is not finite, or beyond ±1e12");
        }
        let [a, b] = self.edges.map(|edge| DVec3::from(edge.map(f64::from)));
        let area = a.cross(b).length();
        // Parallel up to rounding of single-precision edges.
        if area > 1.0e-6 * a.length() * b.length() && area > 0.0 {
            return Ok(());
        }
        Err("edges without an area between them")
    }

    /// Three rows that are multiplied with a point of eye space (x, y, z, 1): its distance before the plane, on the
    /// side away from the water, and its two coordinates along the edges, which are 0 to 1 on the pane.
    fn rows(&self, to_world: DMat4) -> [[f32; 4]; 3] {
        let at = |v: [f32; 3]| DVec3::from(v.map(f64::from));
        let corner = at(self.corner);
        let [a, b] = self.edges.map(at);
        let normal = a.cross(b);
        let row = |axis: DVec3| axis.extend(-axis.dot(corner));
        let rows = [
            row(normal.normalize()),
            row(b.cross(normal) / normal.length_squared()),
            row(normal.cross(a) / normal.length_squared()),
        ];
        rows.map(|row: DVec4| (to_world.transpose() * row).as_vec4().to_array())
    }
}

/// The rows of all panes in the eye space of `view`; those of absent panes are 0.
pub(crate) fn rows(panes: &[Pane], view: Mat4) -> [[f32; 4]; 3 * MAX_PANES] {
    // In double precision, because the origin may be far away.
    let to_world = view.as_dmat4().inverse();
    let mut all = [[0.0; 4]; 3 * MAX_PANES];
    for (pane, rows) in panes.iter().zip(all.as_chunks_mut().0) {
        *rows = pane.rows(to_world);
    }
    all
}

/// Validates the panes of a frame.
pub(crate) fn check(panes: &[Pane]) -> Result<(), Error> {
    if panes.len() > MAX_PANES {
        let why = format!("{} panes, at most {MAX_PANES} are possible", panes.len());
        return Err(Error::bad("Frame.panes", why));
    }
    for (i, pane) in panes.iter().enumerate() {
        pane.check().map_err(|why| Error::bad("Frame.panes", format!("pane {i}: {why}")))?;
    }
    Ok(())
}
