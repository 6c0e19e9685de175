//! Potentials that emit whitewater particles: trapped air, wave crests and energy.

use super::water::{Fluid, Grid, Near, Part};
use super::{MOST_STEPS, STEP, Settings, support, unit};
use glam::DVec3;
use std::f64::consts::SQRT_2;

/// A particle is at the surface if m is longer than this many w.
const ASKEW: f64 = 0.15;
/// Min cosine between a crest's velocity and its normal.
const ALONG: f64 = 0.6;
/// Within this, single precision may decide either way: lengths in w, cosines, and distances from a
/// plane in supports.
const ROUNDING: f64 = 1e-4;
/// A term of the crest smaller than this may be added or not.
const SLIGHT: f64 = 1e-3;
/// Min rounding error of a normal's components.
const FLOAT: f64 = 1e-6;

/// Potentials of a fluid particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Potentials {
    /// Sum of `|v_ij| (1 - cos) W`, in scene units per second, with the angle between relative
    /// velocity and relative position.
    pub trapped_air: f64,
    /// Sum of `(1 - n_i . n_j) W`.
    pub wave_crest: f64,
    /// `|v|^2 / 2`, in scene units squared per second squared.
    pub energy: f64,
    /// N, the number of neighbours, which is the number of terms of all sums except the crest's.
    pub neighbours: u32,
    /// Outward unit normal, if the particle is at the surface.
    pub normal: Option<DVec3>,
    /// Number of terms of the crest.
    pub crest_terms: u32,
    /// Error of the crest besides half a [`STEP`] per term: from normals made of fixed-point steps,
    /// and from small terms that rounding may add or not.
    pub crest_off: f64,
    /// Whether rounding may decide on a neighbour, on the surface, or on a term of the crest.
    pub loose: bool,
}

/// A particle's position relative to the fluid's surface.
#[derive(Clone, Copy, Debug, Default)]
struct Surface {
    normal: Option<DVec3>,
    /// Error of a normal made of fixed-point steps.
    off: f64,
    /// Whether rounding decides if there is one.
    loose: bool,
}

/// A wave crest.
#[derive(Clone, Copy, Debug, Default)]
struct Crest {
    sum: f64,
    terms: u32,
    /// Rounding error, as in [`Potentials`].
    off: f64,
    /// Whether rounding may decide more than that.
    loose: bool,
}

/// Potentials of each particle of a fluid; None for invalid ones.
pub fn potentials(fluid: &Fluid, settings: &Settings) -> Vec<Option<Potentials>> {
    let spacing = settings.spacing;
    let grid = Grid::new(fluid, spacing);
    let others = |part: Part| -> Vec<Near> {
        grid.near(part.position).filter(|near| near.part.index != part.index).collect()
    };
    let mut surfaces = vec![Surface::default(); fluid.positions.len()];
    for part in fluid.parts(spacing) {
        surfaces[part.index] = surface(&others(part), spacing);
    }
    let mut potentials = vec![None; fluid.positions.len()];
    for part in fluid.parts(spacing) {
        potentials[part.index] = Some(of(part, &others(part), &surfaces, settings));
    }
    potentials
}

fn surface(others: &[Near], spacing: f32) -> Surface {
    let (mut m, mut w) = (DVec3::ZERO, 0.0);
    for near in others.iter().filter(|near| near.counts()) {
        m += near.offset / support(spacing) * near.weight();
        w += near.weight();
    }
    // Each component of m and w may err by half a step per term.
    let half_steps = 0.5 * STEP * others.len() as f64;
    let m_off = 3.0_f64.sqrt() * half_steps;
    let length = m.length();
    Surface {
        normal: (w > 0.0 && length > ASKEW * w).then(|| m / length),
        // Chord over sine, for angles up to 90 degrees.
        off: (SQRT_2 * m_off / length + FLOAT).min(2.0),
        // Strictly less, because a lone particle certainly is not at the surface.
        loose: (length - ASKEW * w).abs() < ROUNDING * w + m_off + ASKEW * half_steps,
    }
}

/// Potentials of one particle, from the others near it and all particles' surfaces.
fn of(part: Part, others: &[Near], surfaces: &[Surface], settings: &Settings) -> Potentials {
    let neighbours = others.iter().filter(|near| near.counts());
    let own = surfaces[part.index];
    let crest = crest(part, others, surfaces, settings.spacing);
    Potentials {
        trapped_air: neighbours.clone().map(|near| trapped(part.velocity, near, settings)).sum(),
        wave_crest: crest.sum,
        energy: 0.5 * part.velocity.length_squared(),
        neighbours: neighbours.count() as u32,
        normal: own.normal,
        crest_terms: crest.terms,
        crest_off: crest.off,
        loose: crest.loose || own.loose || others.iter().any(Near::loose),
    }
}

/// Air that a particle with this velocity traps with a neighbour. It saturates like on the GPU.
fn trapped(velocity: DVec3, near: &Near, settings: &Settings) -> f64 {
    let apart = velocity - near.part.velocity;
    if near.offset == DVec3::ZERO || apart == DVec3::ZERO {
        return 0.0;
    }
    let cosine = apart.normalize().dot(near.offset.normalize());
    let term = apart.length() * (1.0 - cosine) * near.weight();
    term.min(MOST_STEPS * unit(settings))
}

fn crest(part: Part, others: &[Near], surfaces: &[Surface], spacing: f32) -> Crest {
    let own = surfaces[part.index];
    let mut crest = Crest::default();
    let Some(normal) = own.normal else { return crest };
    if part.velocity == DVec3::ZERO {
        return crest;
    }
    let along = part.velocity.normalize().dot(normal) - ALONG;
    crest.loose = along.abs() <= ROUNDING + own.off;
    if along < 0.0 {
        return crest;
    }
    for near in others.iter().filter(|near| near.counts()) {
        let other = surfaces[near.part.index];
        crest.loose |= other.loose;
        let Some(others_normal) = other.normal else { continue };
        let term = (1.0 - normal.dot(others_normal)) * near.weight();
        // In supports; the offset points from the other particle.
        let above = -near.offset.dot(normal) / support(spacing);
        let either = above.abs() <= ROUNDING + own.off * near.q;
        if above < 0.0 {
            crest.sum += term;
            crest.terms += 1;
        }
        if above < 0.0 || either {
            crest.off += near.weight() * (own.off + other.off);
        }
        if either {
            crest.off += term;
            crest.loose |= term >= SLIGHT;
        }
    }
    crest
}
