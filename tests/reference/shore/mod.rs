//! Shoreline foam (*Semi-procedural foam shader*, an indie developer's blog) and contact foam (D. Lettier, *3D
//! Game Shaders For Beginners*): the definition, and how far single precision may be off it.
//!
//! Eye space looks down -z; r = (s_x, s_y, -1) is a pixel's ray, a depth z its multiple. The water's plane has
//! the height `H·P + h0 = 0`, its coordinates are `p = (E·P + e0, N·P + n0)` in metres:
//! ```text
//! z = -h0 / H·r    d' = d - (H·d)/(H·r) r    dp = z (E·d', N·d')    width = sqrt |det(dp/dx, dp/dy)|
//! ```
//! where d is the change of r from one pixel to the next. Numbers are [`Bounded`]; what a shader gets is exact,
//! or, where it was found in double precision, rounded once.
//!
//! What moves is found from the time in double precision, as parts of a turn.

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

/// Where the pixels of a view meet the water's level.
#[derive(Clone, Copy, Debug)]
pub struct Water {
    /// Slopes of a ray: scale and offset of a place in pixels.
    pub slope: [Bounded; 4],
    /// Rows from eye space: height over the level, and both coordinates of the plane.
    pub up: [Bounded; 4],
    /// The first coordinate.
    pub east: [Bounded; 4],
    /// The second coordinate.
    pub north: [Bounded; 4],
}

/// A point of the water.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// (s_x, s_y, -1).
    pub ray: [Bounded; 3],
    /// z; none is seen where it is not above 0.
    pub depth: Bounded,
    /// p, metres.
    pub place: [Bounded; 2],
    /// Its change from a pixel to the next, along x and along y.
    pub change: [[Bounded; 2]; 2],
    /// How wide a pixel is, metres.
    pub width: Bounded,
}

/// From what the shader gets.
pub fn water(slope: [f32; 4], up: [f32; 4], east: [f32; 4], north: [f32; 4]) -> Water {
    let all = [slope, up, east, north].map(|row| row.map(|v| exact(f64::from(v))));
    let [slope, up, east, north] = all;
    Water { slope, up, east, north }
}

fn along(row: &[Bounded; 4]) -> [Bounded; 3] {
    [row[0], row[1], row[2]]
}

impl Water {
    /// Through a place in pixels, centres at +0.5.
    pub fn ray(&self, pixel: [f64; 2]) -> [Bounded; 3] {
        let slope = |i: usize| exact(pixel[i]) * self.slope[i] + self.slope[i + 2];
        [slope(0), slope(1), exact(-1.0)]
    }

    /// At a place in pixels: of the level.
    pub fn at(&self, pixel: [f64; 2]) -> Point {
        let ray = self.ray(pixel);
        let depth = -self.up[3] / dot(along(&self.up), ray);
        self.at_depth(ray, depth)
    }

    /// At a depth, as if the surface were level there.
    pub fn at_depth(&self, ray: [Bounded; 3], depth: Bounded) -> Point {
        let [up, east, north] = [&self.up, &self.east, &self.north].map(along);
        let falls = dot(up, ray);
        // Both rows are multiplied with the ray before the depth.
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

/// Time, and after how long all repeats.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// Seconds.
    pub time: f64,
    /// Seconds; speeds are rounded to whole numbers of it.
    pub period: Option<f64>,
}

/// What of the waves goes with the time.
#[derive(Clone, Copy, Debug)]
pub struct Phases {
    /// Radians, [0, 2π).
    pub waves: Bounded,
    /// What the noise on their speed is multiplied by, seconds.
    pub local: Bounded,
}

impl Clock {
    /// Where something that goes round `rate` times a second is, [0, 1).
    pub fn turned(&self, rate: f64) -> f64 {
        let rate = self.period.map_or(rate, |period| (rate * period).round() / period);
        (rate * self.time).rem_euclid(1.0)
    }

    /// `speed` in radians a second, of which the part `swing` comes and goes by so many radians in so many
    /// seconds; seconds of the noise on the speed.
    pub fn phases(&self, speed: f32, swing: f32, swing_by: [f32; 2], speed_period: f32) -> Phases {
        let [speed, swing, period] = [speed, swing, speed_period].map(f64::from);
        let [by, seconds] = swing_by.map(f64::from);
        let straight = TAU * self.turned((1.0 - swing) * speed / TAU);
        let swung = swing * by * (TAU * self.turned(1.0 / seconds)).sin();
        let local = period / TAU * (TAU * self.turned(1.0 / period)).sin();
        Phases { waves: held((straight + swung).rem_euclid(TAU)), local: held(local) }
    }

    /// By how many repetitions a pattern has moved; metres a second along the pattern's own axes.
    pub fn offset(&self, scale: f32, speed: [f64; 2]) -> [Bounded; 2] {
        speed.map(|speed| held(self.turned(f64::from(scale) * speed)))
    }

    /// The same in metres; none of a pattern that is everywhere the same.
    pub fn moved(&self, scale: f32, speed: [f32; 2]) -> [Bounded; 2] {
        let scale = f64::from(scale);
        speed.map(|speed| match scale {
            0.0 => exact(0.0),
            _ => held(self.turned(scale * f64::from(speed)) / scale),
        })
    }
}

/// How far what is behind the surface is from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Between both points.
    Distance,
    /// Of their depths.
    View,
    /// Of their heights.
    Vertical,
}

/// Farther than any foam is deep.
const FAR: f64 = 1.0e9;

/// From the surface's depth to the scene's, along a ray whose heights are `up`'s; finite. By heights what is not below the
/// surface, as on a ray that does not go down, is far.
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
                // Level: rounding may find either.
                let value = if down.value > 0.0 { (behind * down).value } else { FAR };
                Bounded::between((behind * down).low().min(0.0), value, FAR)
            }
        }
    }
}

/// `1 - t` of what is behind the surface and not beyond the depth.
pub fn ramp(t: Bounded) -> Bounded {
    let part = (exact(1.0) - t).clamp(0.0, 1.0);
    if t.low() >= 0.0 {
        part
    } else if t.high() < 0.0 {
        exact(0.0)
    } else {
        // Before the surface or behind it: single precision may find either.
        let value = if t.value < 0.0 { 0.0 } else { part.value };
        Bounded::between(0.0, value, part.high())
    }
}

/// `x² / (2 (x² - x) + 1)`, x in [0, 1]. Below the line is at least a half; of what is added there, u of x², of
/// x² - x, twice that, and u of the sum: a quotient of at most 1 is off by 4u for it, the square and the quotient
/// add 6u.
pub fn ease(x: Bounded) -> Bounded {
    let eased = |x: f64| x * x / (2.0 * (x * x - x) + 1.0);
    let moved = x.rising(|x| eased(x.clamp(0.0, 1.0)));
    let roundings = moved.value * (6.0 + 2.0 * (2.0 * x.value * x.value + 0.5 + 1.0));
    moved.wider(U * roundings)
}

/// How contact foam looks.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Metres at which none is left.
    pub depth: f64,
    /// What those metres are.
    pub measure: Measure,
    /// How much the mask takes away.
    pub mask: f64,
    /// Repetitions of the mask a metre.
    pub mask_scale: f64,
    /// By how many it has moved.
    pub mask_offset: [Bounded; 2],
    /// 0 to 1.
    pub opacity: f64,
}

impl Contact {
    /// From the settings' numbers.
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

    /// The mask so many pixels from where its pattern and the change of that are found.
    pub fn masked(&self, web: &Texture<4>, point: &Point, off: [f64; 2]) -> Bounded {
        let uv = [0, 1].map(|i| point.place[i] * self.mask_scale + self.mask_offset[i]);
        let detail = web.detail(point.width, self.mask_scale);
        let (pattern, _, slope) = web.spread(uv, detail);
        let change = point.change.map(|way| dot(slope, way.map(|w| w * self.mask_scale)));
        self.mask_of(beside(pattern, change, off))
    }

    /// The mask of a pattern.
    pub fn mask_of(&self, pattern: Bounded) -> Bounded {
        mix(exact(1.0), pattern.clamp(0.0, 1.0), exact(self.mask))
    }

    /// How much foam there is: t, the mask.
    pub fn amount(&self, t: Bounded, mask: Bounded) -> Bounded {
        ease(ramp(t) * mask) * self.opacity
    }
}
