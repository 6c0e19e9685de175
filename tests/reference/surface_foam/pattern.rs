//! Twin of the pattern that moves with the foam.
//!
//! A noise in space, looked up where foam would be halfway through a period if it went on as it goes: for a phase with
//! the part p of its period gone, at `x - v (p - 1/2) T`. Of two phases half a period apart each has the weight
//! `1 - |2p - 1|` over the root of the sum of both squares, and begins elsewhere in the noise each period. What a
//! sprite has more of foam is e to the power of two octaves at its centre, of their slope from there, and of a third
//! octave at each place of it, of one phase, by the id's hash. Half the square of each height times the noise's mean
//! square is taken off.
//!
//! [`Pattern::logarithm`] comes with the bound of what single precision makes of it.

use super::super::View;
use super::super::classify::pcg;
use super::loose::{LooseEllipse, LooseHit};
use super::noise::{noise, noise_reach, noise_rounding, noise_slope};
use super::off::Off;
use super::{Settings, Sprite, TOLD_APART};
use crate::support::rounded::{self, Rounded, exact, off};
use crate::support::tolerance::U;
use glam::{DMat3, DVec3};

/// Width of the octaves' cells and their heights, of the first's.
const OCTAVES: [(f64, f64); 3] = [(1.0, 1.0), (0.53, 0.7), (0.23, 1.1)];
/// Mean of the square of the noise.
pub const VARIANCE: f64 = 0.073;
/// Most of the logarithm at the centre, and more on the way to the rim along each axis.
const MOST: f64 = 1.0;
/// The most by which any slope of the noise changes a cell, along any axis: with fades of slope 15/8 and curvature
/// 5.78 at most, gradients whose parts are 1, and ends that differ by 1 + sqrt(3), along one axis
/// `2 15/8 2 + 5.78 (1 + sqrt(3)) < 24`, across `15/8 2 + 15/8 (2 + 15/8 2 (1 + sqrt(3))) < 27`.
const CURVATURE: f64 = 27.0;
/// What single precision adds to a slope: of eight corners the gradients' parts, 5u of a sum of 1, and the products
/// with fades, 20u of a sum of 6.5; 16u of their sums.
const SLOPE_ROUNDING: f64 = 256.0 * U;
/// Widths of the first octave, half of them to each side of the origin, after which places begin again.
const WRAP: f64 = 65_536.0;

/// What a pattern goes by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    /// How much it shows.
    pub strength: f64,
    /// Width of the first octave's cells, spacings.
    pub size: f64,
    /// Seconds.
    pub period: f64,
    /// Of the frame, seconds.
    pub time: f64,
}

/// One of the two at a time.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// Of both squares the sum is 1.
    pub part: f64,
    /// Seconds by which places are carried.
    pub carried: f64,
    /// Where in the noise it begins, in cells of the first octave.
    pub began: f64,
}

/// A place in cells, and how far it may be off.
#[derive(Clone, Copy)]
struct Place {
    v: DVec3,
    e: f64,
}

impl Pattern {
    /// Both.
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

    /// A point of the world, moving. Width and quotient 6u of the place, what is taken off a number of `WRAP`s none;
    /// the way 8u, the sums 3u of their terms, the quotient by the octave 5u.
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

    /// Height of an octave where texels are so wide.
    fn height(&self, octave: usize, texel: Rounded, spacing: f64) -> Rounded {
        let (cell, height) = OCTAVES[octave];
        let width = off(cell * self.size * spacing, 3.0);
        let (from, to) = TOLD_APART;
        let told = rounded::smoothstep(exact(from), exact(to), width / texel);
        off(3.0 * self.strength * height, 3.0) * told
    }

    /// The logarithm of how much more there is of a sprite where a ray meets it.
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

        // The host's own numbers, at the centre.
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
                // By differences: not as the shader does.
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

        // Turned to the eye: three products a part.
        let turned = 4.0 * 3.0_f64.sqrt() * U;
        let slope = Off { v: turn.transpose() * slope.v, e: slope.e + turned * slope.v.length() };
        let rise = most(slope.dot(ellipse.e1) * ellipse.a) * hit.x
            + most(slope.dot(ellipse.e2) * ellipse.b) * hit.y;

        // The finest, at the hit. Its centre goes to eye space and back.
        let which = usize::try_from(pcg(sprite.id) >> 31).expect("a bit");
        let away = to_world.w_axis.truncate().length();
        let back = 16.0 * U * (3.0_f64.sqrt() * sprite.center.length() + away);
        let from = Off { v: point, e: ellipse.center.e + back };
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
