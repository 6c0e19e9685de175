//! The discs that rounding may make of a particle.

use super::super::View;
use super::super::surface_foam::Off;
use super::sprite::{all_pixels, pixels};
use super::{Attenuation, Kind, LEAST, Look, Particle, Settings, TOLD, falloff, has_fluid};
use crate::support::rounded::{self, Rounded, exact, off};
use crate::support::tolerance::U;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Error of a mean over the disc that is a sum of many steps, in u: a millionth.
const SUMMED: f64 = 1e-6 / U;

/// A particle's disc and its errors.
#[derive(Clone, Copy, Debug)]
pub(super) struct LooseSprite {
    kind: Kind,
    look: Look,
    /// Whether it is certainly drawn.
    pub(super) sure: bool,
    depth: Rounded,
    radius: Rounded,
    at: [Rounded; 2],
    half: [Rounded; 2],
    facing: DVec2,
    pub(super) h: Rounded,
    lifetime: Rounded,
    told: Rounded,
    even: Rounded,
}

/// A sphere in a pixel, with errors.
#[derive(Clone, Copy, Debug)]
pub(super) struct LooseFragment {
    pub(super) depth: Rounded,
    /// Normal in eye space.
    pub(super) normal: Off,
    /// Min and max of its contribution.
    pub(super) amount: [f64; 2],
    /// Whether the contribution is certain.
    pub(super) sure: bool,
}

impl LooseSprite {
    /// The disc of a particle, if it may be drawn. The near plane is computed from the projection,
    /// 8u.
    ///
    /// The centre's slope is a quotient. Its position in pixels is `slope scale + offset` or goes
    /// through clip space; either way it errs by at most 8u of the terms, in half extents. C is
    /// computed from the projection, 6u.
    pub(super) fn new(particle: &Particle, view: &View, settings: &Settings) -> Option<Self> {
        // A quotient and a part of it; the factor of a half is exact.
        let radius = off(particle.drawn_radius(settings)?, 5.0);
        let center = Off::point(view.view.transform_point3(particle.position), view);
        let depth = Rounded { v: -center.v.z, e: center.e };
        let near = view.near();
        if depth.v + depth.e <= near * (1.0 - 8.0 * U) {
            return None;
        }
        let (focal, shift, extent) = (view.focal(), view.shift(), view.extent());
        let place = view.project(center.v);
        let at = [0, 1].map(|i| {
            let slope = Rounded { v: center.v[i], e: center.e } / depth;
            let terms = (slope.v * focal[i]).abs() + shift[i].abs() + 1.0;
            let e = 0.5 * extent[i] * (focal[i].abs() * slope.e + 8.0 * U * terms);
            Rounded { v: place[i], e }
        });
        let own = [view.c_x(), view.c_y()].map(|c| radius / (depth * off(c, 6.0)));
        let widened = at_least(exact(LEAST) / least(own), exact(1.0));
        let half = own.map(|own| own * widened);
        let kind = particle.kind;
        let told = rounded::smoothstep(exact(TOLD.0), exact(TOLD.1), least(half));
        // At both ends the smoothstep is exact.
        let told = match least(half) {
            least if least.v + least.e <= TOLD.0 => exact(0.0),
            least if least.v - least.e >= TOLD.1 => exact(1.0),
            _ => told,
        };
        let summed = if settings.look.shapes[kind.index()][1] == 1.0 { 0.0 } else { SUMMED };
        let even = match told.v - told.e < 1.0 {
            true => {
                off(PI * settings.look.mean(kind), 3.0 + summed) * own[0] * own[1]
                    / weights(at, half)
            }
            false => exact(0.0),
        };
        let h = radius * off(focal.y.abs(), 1.0) / depth;
        let [n, m] = settings.look.life;
        let lifetime = loose_falloff(exact(particle.age), exact(1.0), n, m);
        let sure = depth.v - depth.e > near * (1.0 + 8.0 * U);
        let facing = focal.signum();
        let look = settings.look;
        Some(Self { kind, look, sure, depth, radius, at, half, facing, h, lifetime, told, even })
    }

    /// The pixels that the disc may cover.
    pub(super) fn pixels(&self, view: &View) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (at, reach) = reach(self.at, self.half);
        let (columns, rows) = pixels(at, reach, view);
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }

    /// The sphere in a pixel, before the scene, whose depth is computed from the projection, 8u.
    /// Within rounding of the rim or of the scene, it may be there completely or not at all.
    pub(super) fn meet(&self, x: usize, y: usize, scene: f64) -> Option<LooseFragment> {
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let [u, v] = place(pixel, self.at, self.half);
        let square = u * u + v * v;
        if square.v - square.e >= 1.0 {
            return None;
        }
        let q = (exact(1.0) - square).clamp(0.0, 1.0);
        let w = root(q);
        let depth = self.depth - w * self.radius;
        if depth.v - depth.e >= scene * (1.0 + 8.0 * U) {
            return None;
        }
        let sure =
            self.sure && square.v + square.e < 1.0 && depth.v + depth.e < scene * (1.0 - 8.0 * U);
        let normal = Off {
            v: (DVec2::new(u.v, v.v) * self.facing).extend(w.v),
            e: DVec3::new(u.e, v.e, w.e).length(),
        };
        let even = (exact(1.0) - self.told) * self.even * q;
        let shape = self.told * self.shape(square.clamp(0.0, 1.0));
        let amount = self.lifetime * (even + shape);
        let amount = [(amount.v - amount.e).max(0.0), amount.v + amount.e];
        Some(LooseFragment { depth, normal, amount, sure })
    }

    /// The sprite's shape by the squared distance: a root and a power.
    fn shape(&self, square: Rounded) -> Rounded {
        let [n, m] = self.look.shapes[self.kind.index()];
        let f = loose_falloff(root(square), exact(1.0), n, m);
        if self.kind == Kind::Bubble { exact(1.0) - f } else { f }
    }
}

/// Min and max of each of [`Settings::shares`]. The fluid's depth is computed from the projection,
/// 8u.
pub(super) fn loose_shares(settings: &Settings, depth: Rounded, fluid: f64) -> [[f64; 2]; 3] {
    if !has_fluid(fluid) {
        return [[1.0; 2], [0.0; 2], [0.0; 2]];
    }
    let behind = depth - off(fluid, 8.0);
    let span = |r: Rounded| [(r.v - r.e).max(0.0), (r.v + r.e).min(1.0)];
    match settings.attenuation {
        Attenuation::Water => {
            let spacing = off(settings.spacing, 1.0);
            let below = rounded::smoothstep(exact(0.0), exact(1.0), behind / spacing);
            let y = behind.clamp(0.0, f64::INFINITY);
            let far = below * (y / (y + spacing));
            [exact(1.0) - below, below, far].map(span)
        }
        Attenuation::Falloff { max, n, m } => {
            let f = loose_falloff(behind, off(max, 1.0), n, m);
            [span(f), [0.0; 2], [0.0; 2]]
        }
    }
}

/// [`falloff`] of an uncertain distance. The function decreases, so the ends of the distance's
/// range bound it; errors of quotient and powers are added at the ends. Exact where no power is
/// evaluated.
fn loose_falloff(x: Rounded, b: Rounded, n: f64, m: f64) -> Rounded {
    let v = falloff(x.v, b.v, n, m);
    if x.v + x.e < 0.0 || x.v - x.e > b.v + b.e {
        return exact(v);
    }
    let end = |x: f64, sign: f64| {
        if x <= 0.0 {
            return 1.0;
        }
        let part = exact(x) / b;
        let base = (exact(1.0) - power(part, n)).clamp(0.0, 1.0);
        let f = power(base, m);
        (f.v + sign * f.e).clamp(0.0, 1.0)
    };
    let (low, high) = (end(x.v + x.e, -1.0), end(x.v - x.e, 1.0));
    Rounded { v, e: (v - low).max(high - v).max(0.0) }
}

/// A power of a non-negative number; the first power is exact.
fn power(x: Rounded, y: f64) -> Rounded {
    if y == 1.0 { x } else { x.pow(off(y, 1.0)) }
}

/// A root; near 0 only its range is known.
fn root(x: Rounded) -> Rounded {
    let [low, v, high] = [-1.0, 0.0, 1.0].map(|sign| (x.v + sign * x.e).max(0.0).sqrt());
    Rounded { v, e: (v - low).max(high - v) + 9.0 * U * high }
}

/// Position of a pixel's centre in the disc, in half-axes.
fn place(pixel: DVec2, at: [Rounded; 2], half: [Rounded; 2]) -> [Rounded; 2] {
    [0, 1].map(|i| (exact(pixel[i]) - at[i]) / half[i])
}

/// Centre of a disc, and its max half-axes.
fn reach(at: [Rounded; 2], half: [Rounded; 2]) -> (DVec2, DVec2) {
    let reach = |i: usize| half[i].v + half[i].e + at[i].e;
    (DVec2::new(at[0].v, at[1].v), DVec2::new(reach(0), reach(1)))
}

/// See [`weights`](super::sprite): a sum whose terms err by u each.
fn weights(at: [Rounded; 2], half: [Rounded; 2]) -> Rounded {
    let (middle, reach) = reach(at, half);
    let (mut sums, mut count) = ([0.0; 3], 0.0);
    for pixel in all_pixels(middle, reach) {
        let [x, y] = place(pixel, at, half);
        let q = exact(1.0) - (x * x + y * y);
        for (sum, sign) in sums.iter_mut().zip([-1.0, 0.0, 1.0]) {
            *sum += (q.v + sign * q.e).max(0.0);
        }
        count += if q.v + q.e > 0.0 { 1.0 } else { 0.0 };
    }
    let [low, v, high] = sums;
    Rounded { v, e: (v - low).max(high - v) + count * U * high }
}

fn least([a, b]: [Rounded; 2]) -> Rounded {
    Rounded { v: a.v.min(b.v), e: a.e.max(b.e) }
}

fn at_least(a: Rounded, b: Rounded) -> Rounded {
    Rounded { v: a.v.max(b.v), e: if a.v + a.e < b.v - b.e { b.e } else { a.e.max(b.e) } }
}

#[cfg(test)]
mod tests {
    use super::super::super::smoothstep;
    use super::*;

    #[test]
    fn a_falloff_holds_its_own_and_single_precision() {
        let mut random = crate::support::scenes::Random(3);
        for (n, m) in [(2.0, 0.4), (2.25, 1.0), (1.5, 1.0), (2.0, 4.0)] {
            for i in 0..4000 {
                let x = if i % 4 == 0 {
                    1.0 - 1e-5 * random.between(0.0, 1.0)
                } else {
                    random.between(-0.1, 1.1)
                };
                let loose = loose_falloff(exact(f64::from(x)), exact(1.0), n, m);
                let single = match x {
                    x if x < 0.0 => 1.0,
                    x if x <= 1.0 => (1.0 - x.powf(n as f32)).powf(m as f32),
                    _ => 0.0,
                };
                assert!((f64::from(single) - loose.v).abs() <= loose.e, "{n} {m} {x} {loose:?}");
                let near = smoothstep(0.9, 1.0, f64::from(x));
                assert!(loose.e <= 4e-6 + 0.1 * near, "{n} {m} {x} {loose:?}");
            }
        }
    }
}
