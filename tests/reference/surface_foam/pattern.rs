//! Twin of the pattern that moves with the foam.
//!
//! It is a noise in space, evaluated where foam with constant velocity would be in the middle of a
//! period: for a phase of which the fraction p of its period T has passed, at `x - v (p - 1/2) T`.
//! Two phases are half a period apart. A phase has the weight `1 - |2p - 1|` over the root of the
//! sum of both squares, and begins at another place of the noise in each period. A sprite's factor
//! is e to the power of two octaves at its centre, their slope from there, and a third octave at
//! each of its points, which uses only one phase, selected by the id's hash. Half of each height
//! squared times the noise's mean square is subtracted.
//!
//! [`Pattern::logarithm`] includes the error bound of single precision.

use super::super::View;
use super::super::classify::pcg;
use super::loose::{LooseEllipse, LooseHit};
use super::noise::{noise, noise_reach, noise_rounding, noise_slope};
use super::off::Off;
use super::{Settings, Sprite, TOLD_APART};
use crate::support::rounded::{self, Rounded, exact, off};
use crate::support::tolerance::U;
use glam::{DMat3, DVec3};

/// Cell widths and heights of the octaves, relative to the first.
const OCTAVES: [(f64, f64); 3] = [(1.0, 1.0), (0.53, 0.7), (0.23, 1.1)];
/// Mean square of the noise.
pub const VARIANCE: f64 = 0.073;
/// Max logarithm at the centre, and max change from there to the rim along each axis.
const MOST: f64 = 1.0;
/// Max change of any slope of the noise per cell along any axis. Fades have a slope of at most 15/8
/// and a curvature of at most 5.78, gradients have components of 1, and the ends differ by 1 +
/// sqrt(3): along one axis `2 15/8 2 + 5.78 (1 + sqrt(3)) < 24`, across
/// `15/8 2 + 15/8 (2 + 15/8 2 (1 + sqrt(3))) < 27`.
const CURVATURE: f64 = 27.0;
/// Error of a slope in single precision, for eight corners: components of gradients, 5u of a sum of
/// 1; products with fades, 20u of a sum of 6.5; their sums, 16u.
const SLOPE_ROUNDING: f64 = 256.0 * U;
/// Positions repeat after this many widths of the first octave, centred at the origin.
pub const WRAP: f64 = 65_536.0;

/// Settings of the pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    /// Strength.
    pub strength: f64,
    /// Cell width of the first octave, in spacings.
    pub size: f64,
    /// Period in seconds.
    pub period: f64,
    /// Time of the frame, in seconds.
    pub time: f64,
}

/// One of the two phases at a time.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// Weight; the squares of both weights sum to 1.
    pub part: f64,
    /// Seconds by which positions are moved along the velocity.
    pub carried: f64,
    /// Where in the noise the phase begins, in cells of the first octave.
    pub began: f64,
}

/// A position in cells, and its error.
#[derive(Clone, Copy)]
struct Place {
    v: DVec3,
    e: f64,
}

impl Pattern {
    /// The two phases at the pattern's time.
    pub fn phases(&self) -> [Phase; 2] {
        let gone = |late: f64| (self.time / self.period + late).rem_euclid(1.0);
        let weight = |late| 1.0 - (2.0 * gone(late) - 1.0).abs();
        let whole = f64::hypot(weight(0.0), weight(0.5));
        [(0.0, 0.0), (0.5, 1.0)].map(|(late, other)| {
            let begun = (self.time / self.period + late).floor();
            Phase {
                part: weight(late) / whole,
                carried: (gone(late) - 0.5) * self.period,
                began: (17.0 * (2.0 * begun + other)).rem_euclid(256.0),
            }
        })
    }

    /// A point of the world that moves. Width and quotient err by 6u of the position; subtracting a
    /// multiple of `WRAP` is exact; the displacement errs by 8u, the sums by 3u of their terms, the
    /// quotient by the octave's width by 5u.
    fn place(
        &self,
        point: Off,
        velocity: Off,
        phase: &Phase,
        octave: usize,
        spacing: f64,
    ) -> Place {
        let width = spacing * self.size;
        let far = point.v / width;
        let wrapped = far - WRAP * (far / WRAP + 0.5).floor();
        let way = velocity.v * (phase.carried / width);
        let v = wrapped - way + phase.began;
        let terms = wrapped.length() + way.length() + 2.0 * phase.began;
        let e = point.e / width
            + 6.0 * U * far.length()
            + velocity.e * phase.carried.abs() / width
            + U * (8.0 * way.length() + 3.0 * terms);
        let cell = OCTAVES[octave].0;
        Place { v: v / cell, e: (e + 6.0 * U * v.length()) / cell }
    }

    /// Height of an octave for this texel width.
    fn height(&self, octave: usize, texel: Rounded, spacing: f64) -> Rounded {
        let (cell, height) = OCTAVES[octave];
        let width = off(cell * self.size * spacing, 3.0);
        let (from, to) = TOLD_APART;
        let told = rounded::smoothstep(exact(from), exact(to), width / texel);
        off(3.0 * self.strength * height, 3.0) * told
    }

    /// Logarithm of a sprite's factor where a ray meets it.
    pub(super) fn logarithm(
        &self,
        sprite: &Sprite,
        view: &View,
        (ellipse, texel): (&LooseEllipse, Rounded),
        hit: &LooseHit,
        settings: &Settings,
    ) -> Rounded {
        let spacing = settings.spacing;
        let to_world = view.view.inverse();
        let turn = DMat3::from_mat4(to_world);
        let (point, velocity) = (to_world.transform_point3(sprite.center), turn * sprite.velocity);
        let phases = self.phases();

        // At the centre these are the host's exact numbers.
        let told = |v| Off { v, e: 0.0 };
        let mut centre = exact(0.0);
        let mut slope = Off { v: DVec3::ZERO, e: 0.0 };
        for (octave, (scale, _)) in OCTAVES.iter().enumerate().take(2) {
            let height = self.height(octave, texel, spacing);
            for phase in &phases {
                let place = self.place(told(point), told(velocity), phase, octave, spacing);
                let apart = 3.0_f64.sqrt() * place.e;
                let here = Rounded {
                    v: noise(place.v),
                    e: noise_slope() * apart + noise_rounding() + SLOPE_ROUNDING,
                };
                let part = height * off(phase.part, 2.0);
                centre = centre + part * here;
                let cell = scale * self.size * spacing;
                // The slope by central differences, unlike in the shader.
                let step = 1.0e-5;
                let along = |axis: DVec3| {
                    (noise(place.v + step * axis) - noise(place.v - step * axis)) / (2.0 * step)
                };
                let v = DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z));
                let e = 3.0_f64.sqrt() * (CURVATURE * apart + SLOPE_ROUNDING + 1.0e-8);
                slope.v += v * (part.v / cell);
                slope.e += (e * part.v + v.length() * (part.e + 16.0 * U * part.v)) / cell;
            }
            centre = centre - exact(0.5 * VARIANCE) * height * height;
        }
        let most = |v: Rounded| v.clamp(-MOST, MOST);
        let centre = Rounded { v: centre.v.min(MOST), ..centre };

        // Rotation to eye space: three products per component.
        let turned = 4.0 * 3.0_f64.sqrt() * U;
        let slope = Off { v: turn.transpose() * slope.v, e: slope.e + turned * slope.v.length() };
        let rise = most(slope.dot(ellipse.e1) * ellipse.a) * hit.x
            + most(slope.dot(ellipse.e2) * ellipse.b) * hit.y;

        // The finest octave, at the hit. Its centre is transformed to eye space and back.
        let which = usize::try_from(pcg(sprite.id) >> 31).expect("a bit");
        let from = Off { v: sprite.center, e: ellipse.center.e }.to_world(view);
        let moved = Off { v: velocity, e: 3.0 * turned * velocity.length() };
        let place = self.place(from, moved, &phases[which], 2, spacing);
        let cell = OCTAVES[2].0 * self.size * spacing;
        let axis = |axis: Off, half: Rounded, at: Rounded| {
            let length = half / exact(cell);
            let v = turn * axis.v * (length.v * at.v);
            let by_axis = (axis.e + turned + 4.0 * U) * length.v;
            let e = (by_axis + length.e) * at.v.abs() + (length.v + length.e) * at.e;
            (v, e + 2.0 * U * length.v)
        };
        let (u, v) = (axis(ellipse.e1, ellipse.a, hit.x), axis(ellipse.e2, ellipse.b, hit.y));
        let at = place.v + u.0 + v.0;
        let apart =
            place.e + u.1 + v.1 + 2.0 * U * (place.v.length() + u.0.length() + v.0.length());
        let error = noise_slope() * 3.0_f64.sqrt() * apart + noise_rounding();
        let here = Rounded { v: noise(at), e: error.min(2.0 * noise_reach()) };
        let height = self.height(2, texel, spacing) * off(phases[which].part, 2.0);
        let centre = centre - exact(0.5 * VARIANCE) * height * height;
        centre + rise + height * here
    }
}
