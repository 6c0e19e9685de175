//! Motion of a whitewater particle in a step.

use super::water::{Fluid, Near, near};
use super::{BUBBLE, MOST_STEPS, Particle, SPRAY, STEP, Settings, kind_of, uniform_of, unit};
use glam::DVec3;

/// Relative error within which rounding decides whether a coordinate is in the bounds, and whether
/// an age is over.
const ROUNDING: f64 = 1e-6;

/// The fluid around a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// N, the number of fluid particles there, which is the number of terms of the sums.
    pub neighbours: u32,
    /// Sum of K.
    pub weight: f64,
    /// vt, their mean velocity weighted by K, in scene units per second; 0 without any.
    pub velocity: DVec3,
    /// Error of its components from fixed-point steps; infinite if the steps' weights may be 0.
    pub off: f64,
    /// Whether rounding may decide on a neighbour.
    pub loose: bool,
}

/// The fluid around a position.
pub fn carried(position: DVec3, fluid: &Fluid, settings: &Settings) -> Carried {
    let spacing = settings.spacing;
    carried_by(near(position, spacing, fluid.parts(spacing)), settings)
}

/// The fluid around a position, from particles that are or may be neighbours. Products saturate as
/// on the GPU.
pub(super) fn carried_by(all: impl Iterator<Item = Near>, settings: &Settings) -> Carried {
    let unit = unit(settings);
    let most = DVec3::splat(MOST_STEPS * unit);
    let (mut neighbours, mut maybe, mut loose) = (0, 0, false);
    let (mut weight, mut sum) = (0.0, DVec3::ZERO);
    for near in all {
        maybe += 1;
        loose |= near.loose();
        if near.counts() {
            let k = kernel(near.q);
            neighbours += 1;
            weight += k;
            sum += (near.part.velocity * k).clamp(-most, most);
        }
    }
    let velocity = if weight > 0.0 { sum / weight } else { DVec3::ZERO };
    let half_steps = 0.5 * f64::from(maybe);
    let (weight_off, sum_off) = (half_steps * STEP, half_steps * unit);
    let fastest = velocity.abs().max_element();
    let off = match weight - weight_off {
        _ if maybe == 0 => 0.0,
        least if least > 0.0 => (sum_off + fastest * weight_off) / least,
        _ => f64::INFINITY,
    };
    Carried { neighbours, weight, velocity, off, loose }
}

/// K, the cubic spline; q in supports from 0 to 1.
pub(super) fn kernel(q: f64) -> f64 {
    if q <= 0.5 { 6.0 * (q.powi(3) - q.powi(2)) + 1.0 } else { 2.0 * (1.0 - q).powi(3) }
}

/// A particle after a step of dt seconds, and whether rounding may decide on a neighbour, on
/// whether the weights are 0, on the bounds or on its death. A dead particle has age 1.
pub fn moved(particle: &Particle, fluid: &Fluid, settings: &Settings, dt: f32) -> (Particle, bool) {
    let water = carried(particle.position, fluid, settings);
    moved_in(particle, &water, settings, dt)
}

/// Result of [`moved`] in the given fluid.
pub(super) fn moved_in(
    particle: &Particle,
    water: &Carried,
    settings: &Settings,
    dt: f32,
) -> (Particle, bool) {
    if gone(particle, settings) {
        return (Particle { age: 1.0, ..*particle }, false);
    }
    let dt = f64::from(dt);
    let gravity = DVec3::from(settings.gravity.map(f64::from));
    let mut after = Particle { kind: kind_of(water.neighbours), ..*particle };
    let off = match after.kind {
        SPRAY => {
            after.velocity += gravity * dt;
            0.0
        }
        BUBBLE => {
            let drag = f64::from(settings.drag);
            after.velocity += -f64::from(settings.buoyancy) * gravity * dt
                + drag * (water.velocity - particle.velocity);
            drag * water.off
        }
        _ => {
            after.velocity = water.velocity;
            after.age += dt / lifetime(particle.id, settings);
            water.off
        }
    };
    after.position += after.velocity * dt;
    // If the weights may be 0, the motion is unknown.
    let loose = water.loose
        || !off.is_finite()
        || (after.age - 1.0).abs() <= ROUNDING
        || at_bounds(particle.position, after.position, off * dt, settings);
    if gone(&after, settings) {
        after.age = 1.0;
    }
    (after, loose)
}

/// L, the lifetime as foam in seconds.
fn lifetime(id: u32, settings: &Settings) -> f64 {
    let [low, high] = settings.lifetime.map(f64::from);
    low + (high - low) * uniform_of(settings.seed, id, 0)
}

/// Whether the particle is too old or outside of the bounds.
fn gone(particle: &Particle, settings: &Settings) -> bool {
    let outside = settings.bounds.is_some_and(|bounds| {
        let [low, high] = bounds.map(|corner| DVec3::from(corner.map(f64::from)));
        particle.position.cmplt(low).any() || particle.position.cmpgt(high).any()
    });
    // Finite in single precision; a NaN age counts as too old.
    let alive = particle.age < 1.0 && particle.position.as_vec3().is_finite();
    !alive || outside
}

/// Whether a particle at `to`, with this error, may be at the bounds.
fn at_bounds(from: DVec3, to: DVec3, off: f64, settings: &Settings) -> bool {
    let at = |corner: [f32; 3]| {
        let corner = DVec3::from(corner.map(f64::from));
        // The way to there is at most as long as both together.
        let rounding = ROUNDING * corner.abs().max(from.abs());
        (to - corner).abs().cmple(rounding + off).any()
    };
    settings.bounds.is_some_and(|bounds| bounds.into_iter().any(at))
}
