//! Twin of shoreline foam (*Semi-procedural foam shader*, an indie developer's blog) and contact
//! foam (D. Lettier, *3D Game Shaders For Beginners*): the definition, and its errors in single
//! precision.
//!
//! The camera looks along -z in eye space; r = (s_x, s_y, -1) is a pixel's ray, and points on it
//! are z r with a depth z. The water's plane is `H·P + h0 = 0`, and its coordinates are
//! `p = (E·P + e0, N·P + n0)` in scene units:
//! ```text
//! z = -h0 / H·r    d' = d - (H·d)/(H·r) r    dp = z (E·d', N·d')    width = sqrt |det(dp/dx, dp/dy)|
//! ```
//! where d is the change of r per pixel. Numbers are [`Bounded`]; the shader's inputs are exact, or
//! rounded once if they were computed in double precision.
//!
//! Everything that moves is computed from the time in double precision, as a fraction of a period.

use std::f64::consts::TAU;

mod bounded;
pub mod foam;
pub mod map;
pub mod texture;

#[cfg(test)]
mod single;
#[cfg(test)]
mod tests;

use bounded::beside;
pub use bounded::{Bounded, U, dot, exact, held, length, mix};
use texture::Texture;

/// The water level as a pixel's ray meets it.
#[derive(Clone, Copy, Debug)]
pub struct Water {
    /// Slopes of a ray: scale and offset for a position in pixels.
    pub slope: [Bounded; 4],
    /// Row of the transform from eye space: height above the level.
    pub up: [Bounded; 4],
    /// Row for the first coordinate of the plane.
    pub east: [Bounded; 4],
    /// Row for the second coordinate of the plane.
    pub north: [Bounded; 4],
}

/// A point of the water.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// (s_x, s_y, -1).
    pub ray: [Bounded; 3],
    /// z; the point is visible if it is positive.
    pub depth: Bounded,
    /// p in scene units.
    pub place: [Bounded; 2],
    /// Change of p per pixel, along x and along y.
    pub change: [[Bounded; 2]; 2],
    /// Width of a pixel in scene units.
    pub width: Bounded,
}

/// From the shader's inputs.
pub fn water(slope: [f32; 4], up: [f32; 4], east: [f32; 4], north: [f32; 4]) -> Water {
    let all = [slope, up, east, north].map(|row| row.map(|v| exact(f64::from(v))));
    let [slope, up, east, north] = all;
    Water { slope, up, east, north }
}

fn along(row: &[Bounded; 4]) -> [Bounded; 3] {
    [row[0], row[1], row[2]]
}

impl Water {
    /// The ray through a position in pixels, whose centres are at +0.5.
    pub fn ray(&self, pixel: [f64; 2]) -> [Bounded; 3] {
        let slope = |i: usize| exact(pixel[i]) * self.slope[i] + self.slope[i + 2];
        [slope(0), slope(1), exact(-1.0)]
    }

    /// The point of the level at a position in pixels.
    pub fn at(&self, pixel: [f64; 2]) -> Point {
        let ray = self.ray(pixel);
        let depth = -self.up[3] / dot(along(&self.up), ray);
        self.at_depth(ray, depth)
    }

    /// The point at a depth, as if the surface were level there.
    pub fn at_depth(&self, ray: [Bounded; 3], depth: Bounded) -> Point {
        let [up, east, north] = [&self.up, &self.east, &self.north].map(along);
        let falls = dot(up, ray);
        // Both rows are multiplied by the ray first, then by the depth.
        let place = [(east, &self.east), (north, &self.north)]
            .map(|(row, whole)| dot(row, ray) * depth + whole[3]);
        let change = [0, 1].map(|i| {
            let mut d = [exact(0.0); 3];
            d[i] = self.slope[i];
            let part = dot(up, d) / falls;
            let along: [_; 3] = std::array::from_fn(|k| d[k] - part * ray[k]);
            [depth * dot(east, along), depth * dot(north, along)]
        });
        let [[ax, ay], [bx, by]] = change;
        let width = (ax * by - bx * ay).abs().sqrt();
        Point { ray, depth, place, change, width }
    }
}

/// Time, and the period after which everything repeats.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// Seconds.
    pub time: f64,
    /// Seconds; frequencies are rounded so that a whole number of cycles fits.
    pub period: Option<f64>,
}

/// Phases of the waves at this time.
#[derive(Clone, Copy, Debug)]
pub struct Phases {
    /// Radians, [0, 2π).
    pub waves: Bounded,
    /// Factor of the noise on the speed, in seconds.
    pub local: Bounded,
}

impl Clock {
    /// Phase of something with this frequency per second, [0, 1).
    pub fn turned(&self, rate: f64) -> f64 {
        let rate = self.period.map_or(rate, |period| (rate * period).round() / period);
        (rate * self.time).rem_euclid(1.0)
    }

    /// `speed` in radians per second; the fraction `swing` of it oscillates with an amplitude in
    /// radians and a period in seconds (`swing_by`). `speed_period`: period in seconds of the noise
    /// on the speed.
    pub fn phases(&self, speed: f32, swing: f32, swing_by: [f32; 2], speed_period: f32) -> Phases {
        let [speed, swing, period] = [speed, swing, speed_period].map(f64::from);
        let [by, seconds] = swing_by.map(f64::from);
        let straight = TAU * self.turned((1.0 - swing) * speed / TAU);
        let swung = swing * by * (TAU * self.turned(1.0 / seconds)).sin();
        let local = period / TAU * (TAU * self.turned(1.0 / period)).sin();
        Phases { waves: held((straight + swung).rem_euclid(TAU)), local: held(local) }
    }

    /// Displacement of a pattern in repetitions; speed in scene units per second along the
    /// pattern's axes.
    pub fn offset(&self, scale: f32, speed: [f64; 2]) -> [Bounded; 2] {
        speed.map(|speed| held(self.turned(f64::from(scale) * speed)))
    }

    /// Displacement of a pattern in scene units; 0 for a pattern without detail.
    pub fn moved(&self, scale: f32, speed: [f32; 2]) -> [Bounded; 2] {
        let scale = f64::from(scale);
        speed.map(|speed| match scale {
            0.0 => exact(0.0),
            _ => held(self.turned(scale * f64::from(speed)) / scale),
        })
    }
}

/// How the distance behind the surface is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Distance between both points.
    Distance,
    /// Difference of their depths.
    View,
    /// Difference of their heights.
    Vertical,
}

/// A distance at which there is no foam.
const FAR: f64 = 1.0e9;

/// Distance between the surface and the scene along a ray, from their depths; `up` gives heights
/// along the ray. For heights, a ray that does not go down has the result FAR.
pub fn measure(
    kind: Measure,
    [surface, scene]: [Bounded; 2],
    ray: [Bounded; 3],
    up: [Bounded; 3],
) -> Bounded {
    let behind = scene - surface;
    match kind {
        Measure::Distance => behind * length(ray),
        Measure::View => behind,
        Measure::Vertical => {
            let down = -dot(up, ray);
            if down.low() > 0.0 {
                behind * down
            } else if down.high() <= 0.0 {
                exact(FAR)
            } else {
                // For a nearly level ray rounding decides.
                let value = if down.value > 0.0 { (behind * down).value } else { FAR };
                Bounded::between((behind * down).low().min(0.0), value, FAR)
            }
        }
    }
}

/// `1 - t` behind the surface and up to the depth, otherwise 0.
pub fn ramp(t: Bounded) -> Bounded {
    let part = (exact(1.0) - t).clamp(0.0, 1.0);
    if t.low() >= 0.0 {
        part
    } else if t.high() < 0.0 {
        exact(0.0)
    } else {
        // If rounding decides whether the point is before or behind the surface, both are within
        // the bounds.
        let value = if t.value < 0.0 { 0.0 } else { part.value };
        Bounded::between(0.0, value, part.high())
    }
}

/// `x² / (2 (x² - x) + 1)`, x in [0, 1]. The denominator is at least a half. Its terms round by u
/// of x², of twice x² - x, and of the sum; for a quotient of at most 1 this adds 4u, and the square
/// and the quotient add 6u.
pub fn ease(x: Bounded) -> Bounded {
    let eased = |x: f64| x * x / (2.0 * (x * x - x) + 1.0);
    let moved = x.rising(|x| eased(x.clamp(0.0, 1.0)));
    let roundings = moved.value * (6.0 + 2.0 * (2.0 * x.value * x.value + 0.5 + 1.0));
    moved.wider(U * roundings)
}

/// Settings of contact foam.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Distance in scene units at which foam ends.
    pub depth: f64,
    /// How that distance is measured.
    pub measure: Measure,
    /// Strength of the mask.
    pub mask: f64,
    /// Repetitions of the mask per scene unit.
    pub mask_scale: f64,
    /// Displacement of the mask in repetitions.
    pub mask_offset: [Bounded; 2],
    /// Opacity, 0 to 1.
    pub opacity: f64,
}

impl Contact {
    /// From numbers of the settings.
    pub fn new(
        clock: Clock,
        measure: Measure,
        [depth, mask, mask_scale, opacity]: [f32; 4],
        mask_speed: [f32; 2],
    ) -> Self {
        let mask_offset = clock.offset(mask_scale, mask_speed.map(f64::from));
        let [depth, mask, mask_scale, opacity] = [depth, mask, mask_scale, opacity].map(f64::from);
        Self { depth, measure, mask, mask_scale, mask_offset, opacity }
    }

    /// t, from both depths.
    pub fn part(&self, depths: [Bounded; 2], ray: [Bounded; 3], up: [Bounded; 3]) -> Bounded {
        measure(self.measure, depths, ray, up) / self.depth
    }

    /// The mask at an offset in pixels from the point where its pattern and slope are evaluated.
    pub fn masked(&self, web: &Texture<4>, point: &Point, off: [f64; 2]) -> Bounded {
        let uv = [0, 1].map(|i| point.place[i] * self.mask_scale + self.mask_offset[i]);
        let detail = web.detail(point.width, self.mask_scale);
        let (pattern, _, slope) = web.spread(uv, detail);
        let change = point.change.map(|way| dot(slope, way.map(|w| w * self.mask_scale)));
        self.mask_of(beside(pattern, change, off))
    }

    /// The mask from its pattern.
    pub fn mask_of(&self, pattern: Bounded) -> Bounded {
        mix(exact(1.0), pattern.clamp(0.0, 1.0), exact(self.mask))
    }

    /// Amount of foam from t and the mask.
    pub fn amount(&self, t: Bounded, mask: Bounded) -> Bounded {
        ease(ramp(t) * mask) * self.opacity
    }
}
