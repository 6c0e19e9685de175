//! Twin of the light map of whitewater particles: bounds for single precision and fixed-point sums.
//!
//! Each particle is a disc in the map, as on the screen, with the far end of its sphere as its
//! position along the light, rounded to a whole number of texels k. For each texel the particles
//! contribute amounts `a` with their k; each contribution is known as a range of both. The map
//! contains the mean of `a`, and the mean and the deviation of k weighted by `a`, over 3x3 texels.
//! Positions are in units of a power of two, [`Light::whitewater_unit`].

use super::super::Image;
use super::super::whitewater::{Attenuation, Kind, Particle, Settings};
use super::Light;
use crate::support::rounded::{Rounded, exact, off, smoothstep};
use crate::support::tolerance::{Between, U};
use std::f64::consts::PI;

/// Fixed-point steps of a thickness of 1.
const STEPS: f64 = 65536.0;
/// Min half-axis of a disc, in texels.
const LEAST: f64 = 0.75;
/// Relative error of a rounding to half precision in either direction.
const HALF: f64 = 1.0 / 1024.0;

/// Contribution of a particle to a texel.
#[derive(Clone, Copy, Debug)]
struct Addend {
    /// Min and max number of steps.
    steps: [f64; 2],
    /// Min and max position along the light.
    place: [f64; 2],
}

/// A particle's disc in the map.
struct Disc {
    kind: Kind,
    at: [Rounded; 2],
    reach: Rounded,
    radius: Rounded,
    depth: Rounded,
    life: Rounded,
    told: Rounded,
    even: Rounded,
    /// Min and max position, and whether it certainly casts a shadow.
    place: [f64; 2],
    sure: bool,
}

/// `(1 - (x/b)^n)^m`.
fn falloff(x: Rounded, b: f64, n: f64, m: f64) -> Rounded {
    if x.v - x.e >= b {
        return exact(0.0);
    }
    let rest = exact(1.0) - (x.clamp(0.0, b) / off(b, 1.0)).pow(off(n, 1.0));
    rest.clamp(0.0, 1.0).pow(off(m, 1.0))
}

impl Disc {
    fn new(light: &Light, particle: &Particle, settings: &Settings) -> Option<Self> {
        let there = particle.age < 1.0
            && particle.position.to_array().iter().all(|c| c.is_finite() && c.abs() < 1e10);
        if !there {
            return None;
        }
        let part = if particle.kind == Kind::Bubble { 0.5 } else { 1.0 };
        let whole = particle.radius.unwrap_or(settings.radius);
        // A quotient, and another by the texel, which is rounded twice.
        let radius = off(part * whole / f64::from(particle.id % 5 + 1), 5.0);
        let texel = off(light.texel(), 2.0);
        let n = light.texels as f64;
        let (at, depth) = light.place(particle.position);
        let by = light.off(particle.position);
        let at =
            [at.x, at.y].map(|v| Rounded { v, e: by / light.texel() + 4.0 * U * (v.abs() + n) });
        let own = radius / texel;
        let reach = if own.v < LEAST { own * (exact(LEAST) / own) } else { own };
        let told = smoothstep(exact(1.0), exact(2.0), reach);
        let told = if reach.v + reach.e <= 1.0 { exact(0.0) } else { told };
        let depth = Rounded { v: depth, e: by };
        let place = (depth + radius) / texel + exact(0.5 * n) + exact(0.5);
        let ends = [-1.0, 1.0].map(|sign| place.v + sign * place.e);
        if ends[0] >= n {
            return None;
        }
        let mut disc = Self {
            kind: particle.kind,
            at,
            reach,
            radius,
            depth,
            life: falloff(exact(particle.age), 1.0, 2.0, 0.4),
            told,
            even: exact(0.0),
            place: ends.map(|v| v.max(0.0).floor()),
            sure: ends[1] < n,
        };
        if told.v - told.e < 1.0 {
            let mut sum = exact(0.0);
            let (columns, rows) = (disc.range(0), disc.range(1));
            for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
                sum = sum + (exact(1.0) - disc.square(x, y)).clamp(0.0, 2.0);
            }
            let energy = off(PI * particle.kind.mean(), 3.0) * own * own;
            disc.even = (exact(1.0) - told) * energy / sum;
        }
        Some(disc)
    }

    /// Columns or rows that the disc may cover, also outside the map.
    fn range(&self, axis: usize) -> std::ops::Range<i64> {
        let (at, reach) = (self.at[axis], self.reach.v + self.reach.e + self.at[axis].e + 1.0);
        (at.v - reach).floor() as i64..(at.v + reach).ceil() as i64
    }

    /// Squared distance of a texel from the centre, relative to the rim's.
    fn square(&self, x: i64, y: i64) -> Rounded {
        let [x, y] =
            [(0, x), (1, y)].map(|(axis, i)| (exact(i as f64 + 0.5) - self.at[axis]) / self.reach);
        x * x + y * y
    }

    /// Contribution to a texel, if there may be one. `front`: distance to the first water there, in
    /// scene units.
    fn addend(&self, x: i64, y: i64, front: f64, settings: &Settings) -> Option<Addend> {
        let square = self.square(x, y);
        if square.v - square.e >= 1.0 {
            return None;
        }
        let inside = square.clamp(0.0, 1.0);
        let even = self.even * (exact(1.0) - inside);
        let power = match self.kind {
            Kind::Foam => 2.25,
            Kind::Spray => 1.5,
            Kind::Bubble => 2.0,
        };
        let grown = inside.sqrt().pow(exact(power));
        let shape =
            if self.kind == Kind::Bubble { grown } else { (exact(1.0) - grown).clamp(0.0, 1.0) };
        let mut amount = self.life * (even + self.told * shape);
        if let Attenuation::Falloff { max, n, m } = settings.attenuation
            && front < 1e9
        {
            let near = self.depth - (exact(1.0) - inside).sqrt() * self.radius;
            amount = amount * falloff(near - exact(front), max, n, m);
        }
        let sure = self.sure && square.v + square.e < 1.0;
        let least = if sure { (amount.v - amount.e).max(0.0) } else { 0.0 };
        let in_steps = |v: f64, sign: f64| (v * STEPS * (1.0 + sign * 2.0 * U) + 0.5).floor();
        let steps = [in_steps(least, -1.0), in_steps(amount.v + amount.e, 1.0)];
        (steps[1] > 0.0).then_some(Addend { steps, place: self.place })
    }
}

impl Light {
    /// Unit of positions in the map, in scene units: the largest power of two that is no longer
    /// than a texel, which is rounded to single precision.
    pub fn whitewater_unit(&self) -> f64 {
        let texel = f64::from(self.texel() as f32);
        let near = texel.log2().round().exp2();
        if near > texel { 0.5 * near } else { near }
    }

    /// The three channels of the map, with and without their rounding to half precision. `front`:
    /// map of the first water.
    pub fn whitewater(
        &self,
        particles: &[Particle],
        settings: &Settings,
        front: &Image<f32>,
    ) -> [Between; 3] {
        let n = self.texels;
        let mut texels = Image::new(n, n, Vec::<Addend>::new());
        for disc in particles.iter().filter_map(|p| Disc::new(self, p, settings)) {
            let inside = |range: std::ops::Range<i64>| {
                range.start.clamp(0, n as i64)..range.end.clamp(0, n as i64)
            };
            let columns = inside(disc.range(0));
            for y in inside(disc.range(1)) {
                for x in columns.clone() {
                    let (i, j) = (x as usize, y as usize);
                    let front = f64::from(front.at(i, j));
                    if let Some(addend) = disc.addend(x, y, front, settings) {
                        texels.at_mut(i, j).push(addend);
                    }
                }
            }
        }
        let all = Image::from_fn(n, n, |x, y| {
            let mut near = Vec::new();
            for (dx, dy) in (-1..=1_isize).flat_map(|y| (-1..=1_isize).map(move |x| (x, y))) {
                let weight = f64::from(((2 - dx.abs()) * (2 - dy.abs())) as i32);
                let there = texels.clamped(x as isize + dx, y as isize + dy);
                near.extend(there.iter().map(|a| (weight, *a)));
            }
            self.moments(&near)
        });
        [0, 1, 2]
            .map(|i| Between { low: all.map(|ends| ends[i][0]), high: all.map(|ends| ends[i][1]) })
    }

    /// Sum, mean and deviation (in units of the map) of weighted contributions.
    ///
    /// If the contributions err by e, a mean changes by `sum e |k - mean| / sum a`. The variance
    /// changes likewise, minus the square of the mean's change. Quotients in single precision add a
    /// few u of the positions relative to the first one; the integers are exact.
    fn moments(&self, all: &[(f64, Addend)]) -> [[f64; 2]; 3] {
        let total = |of: &dyn Fn(&Addend) -> f64| all.iter().map(|(w, a)| w * of(a)).sum::<f64>();
        let (least, most) = (total(&|a| a.steps[0]), total(&|a| a.steps[1]));
        let half = |low: f64, high: f64| {
            let step = |v: f64| HALF * v.abs() + 1e-7;
            [low - step(low), high + step(high)]
        };
        let sum = [least * (1.0 - 16.0 * U), most * (1.0 + 16.0 * U)].map(|v| v / (16.0 * STEPS));
        let sum = half(sum[0], sum[1]);
        if most == 0.0 {
            return [[0.0; 2]; 3];
        }
        let (t, n) = (self.texel() / self.whitewater_unit(), self.texels as f64);
        if least == 0.0 {
            // There may be no contribution at all.
            let ends =
                |f: fn(f64, f64) -> f64| all.iter().map(|(_, a)| a.place[0]).fold(f64::NAN, f);
            let (low, high) = (ends(f64::min), ends(f64::max) + 1.0);
            let mean = half(((low - 0.5 * n) * t).min(0.0), ((high - 0.5 * n) * t).max(0.0));
            return [sum, mean, half(0.0, (high - low) * t)];
        }
        let middle = |a: &Addend| [a.steps, a.place].map(|[low, high]| 0.5 * (low + high));
        let open = |a: &Addend| [a.steps, a.place].map(|[low, high]| 0.5 * (high - low));
        let whole = total(&|a| middle(a)[0]);
        let mean = total(&|a| middle(a)[0] * middle(a)[1]) / whole;
        let square = total(&|a| middle(a)[0] * (middle(a)[1] - mean).powi(2)) / whole;
        let reach = all.iter().map(|(_, a)| (a.place[0] - mean).abs() + 1.0).fold(0.0, f64::max);
        let moved = total(&|a| open(a)[0] * (middle(a)[1] - mean).abs() + a.steps[1] * open(a)[1])
            / least
            + 16.0 * U * reach;
        let stretched = total(&|a| {
            let away = (middle(a)[1] - mean).abs();
            let by = open(a)[1];
            open(a)[0] * (away * away - square).abs() + a.steps[1] * by * (2.0 * away + by)
        }) / least
            + moved * moved
            + 32.0 * U * reach * reach;
        let place = |v: f64, sign: f64| (v - 0.5 * n + sign * (moved + 4.0 * U * n)) * t;
        let deviation = |sign: f64| (square + sign * stretched).max(0.0).sqrt() * t;
        [
            sum,
            half(place(mean, -1.0), place(mean, 1.0)),
            half(deviation(-1.0) * (1.0 - 8.0 * U), deviation(1.0) * (1.0 + 8.0 * U)),
        ]
    }

    /// Fraction of sunlight that whitewater particles block at a distance along the light, from a
    /// texel of their map.
    pub(super) fn covered(&self, [rho, mean, spread, _]: [f32; 4], d: Rounded) -> Rounded {
        let unit = self.whitewater_unit();
        let [mean, spread] = [mean, spread].map(|v| unit * f64::from(v));
        let [rho, mean, spread] = [f64::from(rho), mean, spread].map(exact);
        let reach = off(0.5 * self.spacing, 2.0) + off(1.5 * self.texel(), 4.0);
        let behind = (d - mean - reach).clamp(0.0, f64::INFINITY);
        let square = behind * behind;
        let all = square + spread * spread + reach * reach / exact(9.0);
        let part = (off(4.0 / 3.0, 2.0) * square / all).clamp(0.0, 1.0);
        let [half, exponent] = self.intensity;
        let thickness = part * rho;
        let power = match thickness.v + thickness.e > 0.0 {
            true => thickness.pow(off(exponent, 1.0)),
            false => exact(0.0),
        };
        power / (off(half, 1.0) + power)
    }
}
