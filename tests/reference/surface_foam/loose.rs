//! The ellipses that rounding may make of a sprite.

use super::super::View;
use super::super::thickness::J;
use super::off::Off;
use super::{
    CELLS, EDGE_ON, HEAD_ON, LEAST_AXIS, LEAST_FACING, PARALLEL, STILL, Settings, Sprite,
    TOLD_APART,
};
use crate::support::rounded::{self, Rounded, exact, off};
use crate::support::tolerance::U;
use glam::DVec3;
use std::f64::consts::PI;

/// Axes and their errors.
#[derive(Clone, Copy, Debug)]
struct LooseAxes {
    e1: Off,
    e2: Off,
    stretch: Rounded,
}

/// All axes that rounding may give a sprite: several if it decides at a threshold.
fn loose_axes(center: Off, velocity: Off, settings: &Settings) -> Vec<LooseAxes> {
    let mut all = Vec::new();
    let v = center.normalize();
    let speed = velocity.length() / exact(settings.spacing);
    let (mut moving, mut fallback) = (speed.v + speed.e > STILL, speed.v - speed.e <= STILL);
    if moving {
        let dir = velocity.normalize();
        let across = dir.cross(v);
        let sine = across.length();
        moving = sine.v + sine.e >= PARALLEL;
        fallback |= sine.v - sine.e < PARALLEL;
        if moving {
            // p = v x e2 = (dir - v (v.dir)) / |across| lies on the side of dir, whatever the
            // rounding.
            let e2 = across.normalize();
            let p = v.cross(e2);
            let facing = v.dot(dir);
            let facing = Rounded { v: facing.v.abs(), ..facing };
            let head_on = rounded::smoothstep(off(HEAD_ON.0, 1.0), exact(HEAD_ON.1), facing);
            let by_speed = rounded::smoothstep(exact(0.0), exact(settings.motion_threshold), speed);
            let stretch = by_speed * (exact(1.0) - head_on);
            all.push(LooseAxes { e1: p.mix(dir, stretch).normalize(), e2, stretch });
        }
    }
    if fallback {
        let with = |axis: DVec3| v.cross(Off { v: axis, e: 0.0 });
        let length = with(DVec3::Y).length();
        let mut push = |side: Off| {
            let e2 = side.normalize();
            all.push(LooseAxes { e1: e2.cross(v), e2, stretch: exact(0.0) });
        };
        if length.v + length.e >= PARALLEL {
            push(with(DVec3::Y));
        }
        if length.v - length.e < PARALLEL {
            push(with(DVec3::X));
        }
    }
    all
}

/// An ellipse and its errors.
#[derive(Clone, Copy, Debug)]
pub struct LooseEllipse {
    pub center: Off,
    pub e1: Off,
    pub e2: Off,
    pub n: Off,
    pub a: Rounded,
    pub b: Rounded,
    /// Additional rotation of both axes in their plane.
    pub turn: f64,
}

/// Where a ray may meet an ellipse.
#[derive(Clone, Copy, Debug)]
pub struct LooseHit {
    /// Depth.
    pub k: Rounded,
    /// Position in half-axes.
    pub x: Rounded,
    pub y: Rounded,
    /// Squared distance from the centre.
    pub rho_squared: Rounded,
    /// Whether the ray certainly meets the ellipse, before the scene.
    pub sure: bool,
}

impl LooseEllipse {
    /// The ellipses that rounding may make of a sprite; `half`: half-axis at rest, in radii.
    pub fn all(sprite: &Sprite, view: &View, settings: &Settings, half: f64) -> Vec<Self> {
        let center = Off::point(sprite.center, view);
        let axes = loose_axes(center, Off::direction(sprite.velocity), settings);
        let ellipse = |axes: LooseAxes| {
            let LooseAxes { e1, e2, stretch } = axes;
            // The radius is a rounded factor times the spacing.
            let b = off(half * settings.radius(), 3.0);
            let a = b * (exact(1.0) + stretch);
            Self { center, e1, e2, n: e1.cross(e2), a, b, turn: 0.0 }
        };
        axes.into_iter().map(ellipse).collect()
    }

    /// Distance from the centre within which the whole ellipse lies, with a margin much larger than
    /// its errors.
    pub fn reach(&self) -> f64 {
        1.01 * (self.a.v + self.a.e) + 32.0 * (self.center.e + U * self.center.v.length())
    }

    /// See [`Ellipse::wide`]. A texel has the depth's error, 2u of the slope and a product.
    pub(super) fn wide(self, view: &View, settings: &Settings) -> (Self, Rounded) {
        let pixel = self.texel(view);
        let cell = self.b / (off(CELLS, 1.0) * pixel);
        let (from, to) = TOLD_APART;
        let told = rounded::smoothstep(exact(from), exact(to), cell);
        let least = exact(LEAST_AXIS) * pixel;
        let (a, b) = (larger(self.a, least), larger(self.b, least));
        (Self { a, b, ..self }, off(settings.noise, 1.0) * told)
    }

    /// Width of a texel at the ellipse's centre.
    pub(super) fn texel(&self, view: &View) -> Rounded {
        let z = Rounded { v: -self.center.v.z, e: self.center.e };
        z * off(view.slope_step().abs().max_element(), 3.0)
    }

    /// Whether and where a ray may meet the ellipse before the scene.
    ///
    /// k: n's error only counts in `n.(c - k w)`, which would be 0 without it, so it counts with
    /// the distance p from the centre and not with the depth. Errors of c and w count in full, the
    /// two products add 3u, the quotient 5u; all but the last are divided by `n.w`.
    ///
    /// x: k's error counts with `w.e1`, which is small if the plane faces the ray. e1's error
    /// counts with p, those of c and w in full; u for `k w`, u for the difference, 3u for the
    /// product.
    pub fn meet(&self, ray: Off, near: f64, scene: f64) -> Option<LooseHit> {
        let (n, c, w) = (self.n, self.center, ray);
        let q = n.dot(w);
        if q.v.abs() + q.e < EDGE_ON * (1.0 - U) {
            return None;
        }
        let least = q.v.abs() - q.e;
        let hit = if least > 0.0 {
            let k = n.v.dot(c.v) / q.v;
            let p = w.v * k - c.v;
            let (far, ray_length) = (c.v.length(), w.v.length());
            let from = (1.0 + n.e) * (c.e + k.abs() * w.e) + n.e * p.length();
            let products = 3.0 * U * (1.0 + n.e) * (far + k.abs() * ray_length);
            let k_e = (from + products) / least;
            let k_e = k_e + 5.0 * U * (k.abs() + k_e);
            let most = k.abs() + k_e;
            let along = |e: Off, half: Rounded| {
                let by_k = k_e * (w.v.dot(e.v).abs() + ray_length * e.e);
                let point = most * w.e + c.e + U * most * ray_length;
                let length = p.length() + k_e * ray_length;
                let error = length * (e.e + 4.0 * U) + by_k + (1.0 + e.e) * point;
                Rounded { v: p.dot(e.v), e: error } / half
            };
            let (x, y) = (along(self.e1, self.a), along(self.e2, self.b));
            let mut rho_squared = x * x + y * y;
            rho_squared.e += self.turned(p.length_squared());
            (Rounded { v: k, e: k_e }, x, y, rho_squared)
        } else {
            // The ray may meet the ellipse anywhere.
            let any = Rounded { v: 0.0, e: f64::INFINITY };
            (any, any, any, any)
        };
        let (k, x, y, rho_squared) = hit;
        // The near plane and the scene's depth are computed from the projection: 8u.
        let between = |near: f64, scene: f64, from: f64, to: f64| from >= near && to < scene;
        let (less, more) = (1.0 - 8.0 * U, 1.0 + 8.0 * U);
        let maybe = rho_squared.v - rho_squared.e <= 1.0
            && between(near * less, scene * more, k.v + k.e, k.v - k.e);
        let sure = rho_squared.v + rho_squared.e <= 1.0
            && least >= EDGE_ON * (1.0 + U)
            && between(near * more, scene * less, k.v - k.e, k.v + k.e);
        maybe.then_some(LooseHit { k, x, y, rho_squared, sure })
    }

    /// Change of a squared distance in half-axes by the rotation: its derivative by the angle is at
    /// most its range, `d^2 (1/b^2 - 1/a^2)`. A circle does not change.
    fn turned(&self, distance_squared: f64) -> f64 {
        let (a, b) = (self.a.v + self.a.e, self.b.v - self.b.e);
        let range = distance_squared * (1.0 / (b * b) - 1.0 / (a * a)).max(0.0);
        if self.turn > 0.0 { self.turn.min(1.0) * range } else { 0.0 }
    }

    /// See [`Ellipse::amplitude`]. The volume errs by 2u, pi J by 3u, the min of facing by u; GPUs
    /// that divide twice have one more quotient.
    pub(super) fn amplitude(&self, foam: f64, settings: &Settings) -> Rounded {
        let z = Rounded { v: self.center.v.z, e: self.center.e };
        let facing = self.n.dot(self.center) / z;
        let facing = Rounded { v: facing.v.abs(), ..facing };
        let facing = facing.clamp(LEAST_FACING, f64::INFINITY);
        let facing = Rounded { e: facing.e + U * LEAST_FACING, ..facing };
        let above = exact(foam) * off(settings.spacing.powi(3), 2.0 + 5.0);
        above / (off(PI * J, 3.0) * self.a * self.b * facing)
    }
}

/// The larger of two uncertain numbers.
fn larger(a: Rounded, b: Rounded) -> Rounded {
    Rounded { v: a.v.max(b.v), e: if a.v - a.e > b.v + b.e { a.e } else { a.e.max(b.e) } }
}
