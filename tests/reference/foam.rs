//! Twin of the foam sprites: each particle of foam is an ellipse in a plane of its own through its
//! centre, drawn out along its velocity.
//!
//! With `w = (s_x, s_y, -1)` the pixel's ray, n the plane's normal and c the centre, `k w` with
//! `k = n.c / n.w` is the point of the plane that is seen, at the depth k; (x, y) is its place in
//! the ellipse, in half-axes. [`depth`] holds the least k where foam is, [`thickness`] the sum of
//! `A sqrt(1 - rho^2) exp(-2 rho^2)`, torn by a noise that is each particle's own.
//!
//! [`depth_bounds`] and [`thickness_bounds`] say between what single precision must lie. u is half
//! an ulp; what an operation may add is what Vulkan allows. A number is [`Rounded`], of a vector
//! the length of the error is kept. Roundings of an error are left out.

use super::classify::pcg;
use super::thickness::{J, kernel};
use super::{EMPTY, Image, View, is_surface, smoothstep};
use crate::support::rounded::{self, Rounded, exact, off};
use crate::support::tolerance::{Between, U};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, SQRT_2};

/// Drawn radius of a whole particle over the spacing.
const RADIUS: f64 = 0.656;
/// Half-axis of a sprite at rest, in radii; of the one that makes the depth as much of it as eight
/// times the foam is, at most all.
const AXIS: f64 = 2.0;

/// The part of the half-axis that the depth's has.
fn depth_part(foam: f64) -> f64 {
    (8.0 * foam).min(1.0)
}

/// Slower than this, in spacings a second, there is no direction of motion.
const STILL: f64 = 1e-6;
/// The sine below which two directions span no plane.
const PARALLEL: f64 = 1e-3;
/// Between these cosines of velocity and view the stretch ends.
const HEAD_ON: (f64, f64) = (0.9, 1.0);
/// A ray with |n.w| below this does not meet the plane.
const EDGE_ON: f64 = 1e-6;
/// The least |n_z| that the amplitude is divided by.
const LEAST_FACING: f64 = 0.2;
/// Cells of the noise to a half-axis.
const CELLS: f64 = 1.6;
/// Least half-axis of what makes the thickness, in texels.
const LEAST_AXIS: f64 = 1.5;
/// Texels of a cell between which its noise comes.
const TOLD_APART: (f64, f64) = (1.0, 2.0);
/// The noise of the particles begins within this many cells.
const SPREAD: f64 = 64.0;

/// A particle of foam, in eye space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sprite {
    /// Its centre, world units; z is negative before the camera.
    pub center: DVec3,
    /// How much of it is foam; none is drawn at 0, more than 1 counts as 1.
    pub foam: f64,
    /// Its velocity, world units a second.
    pub velocity: DVec3,
    /// Seconds since it was first seen.
    pub age: f64,
    /// What it is known by: the noise goes by it.
    pub id: u32,
    /// Share of the sun's light in its middle, at least and at most.
    pub sun: [f64; 2],
}

/// What foam is drawn by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Rest spacing of the particles, world units.
    pub spacing: f64,
    /// From this speed on, spacings a second, a sprite is twice as long as wide.
    pub motion_threshold: f64,
    /// Foam this far behind the nearest is before the water still, world units.
    pub front_depth: f64,
    /// g, how much the noise tears a sprite; 0 is not at all.
    pub noise: f64,
    /// Cells of the noise that pass in a second.
    pub noise_rate: f64,
    /// What a sprite adds is rounded to multiples of this, world units; 0: it is not. A power of two.
    pub step: f64,
}

impl Settings {
    /// The defaults for a spacing in world units.
    pub fn new(spacing: f64) -> Self {
        let (front_depth, noise) = (7.0 * spacing, 0.9);
        Self { spacing, motion_threshold: 21.0, front_depth, noise, noise_rate: 2.0, step: 0.0 }
    }

    /// What an addend may be rounded to, at least or at most by the sign. The quotient is rounded
    /// by u, which may pass a middle.
    fn in_steps(&self, addend: f64, sign: f64) -> f64 {
        if self.step == 0.0 {
            return addend;
        }
        let steps = addend / self.step;
        ((steps * (1.0 + sign * 2.0 * U) + 0.5 + sign * 2.0 * U).floor() * self.step).max(0.0)
    }

    /// How much of what lies so far behind the nearest foam counts to the front layer.
    fn within(&self, behind: f64) -> f64 {
        1.0 - smoothstep(self.front_depth, self.front_depth + self.spacing, behind)
    }

    /// r, the drawn radius of a whole particle, world units.
    /// How much of a sprite there still is so far before the scene: it sinks into it within half a
    /// spacing.
    fn sunk(&self, before: f64) -> f64 {
        (before / (0.5 * self.spacing)).clamp(0.0, 1.0)
    }

    fn radius(&self) -> f64 {
        RADIUS * self.spacing
    }
}

impl Sprite {
    /// f, which is in (0, 1], if it may be drawn at all.
    fn part(&self) -> Option<f64> {
        let finite = self.center.is_finite() && self.velocity.is_finite();
        (finite && self.foam > 0.0).then_some(self.foam.min(1.0))
    }

    /// The same if it lies beyond a depth.
    fn part_beyond(&self, near: f64) -> Option<f64> {
        self.part().filter(|_| -self.center.z > near)
    }

    /// Where its noise is looked up at (x, y) of its ellipse.
    fn place(&self, x: f64, y: f64, settings: &Settings) -> DVec3 {
        let own = origin(self.id);
        let p = DVec3::new(CELLS * x, CELLS * y, self.age * settings.noise_rate);
        p + own
    }
}

/// How an ellipse lies: unit vectors along its half-axes, at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// The long one.
    pub e1: DVec3,
    /// The short one.
    pub e2: DVec3,
    /// t, in 0..1: the long one is 1 + t times the short one.
    pub stretch: f64,
}

impl Axes {
    /// The normal of their plane.
    pub fn normal(&self) -> DVec3 {
        self.e1.cross(self.e2)
    }
}

/// The axes of a sprite: across the view at rest, along the velocity when fast. What comes straight
/// at the eye would be seen edge-on and stays round.
pub fn axes(sprite: &Sprite, settings: &Settings) -> Axes {
    let v = sprite.center.normalize();
    let speed = sprite.velocity.length() / settings.spacing;
    if speed > STILL {
        let dir = sprite.velocity.normalize();
        let across = dir.cross(v);
        if across.length() >= PARALLEL {
            let e2 = across.normalize();
            let p = e2.cross(v);
            let p = if p.dot(dir) < 0.0 { -p } else { p };
            let head_on = smoothstep(HEAD_ON.0, HEAD_ON.1, v.dot(dir).abs());
            let stretch = smoothstep(0.0, settings.motion_threshold, speed) * (1.0 - head_on);
            return Axes { e1: p.lerp(dir, stretch).normalize(), e2, stretch };
        }
    }
    let up = v.cross(DVec3::Y);
    let side = if up.length() < PARALLEL { v.cross(DVec3::X) } else { up };
    let e2 = side.normalize();
    Axes { e1: e2.cross(v), e2, stretch: 0.0 }
}

/// The ellipse of a sprite.
#[derive(Clone, Copy, Debug)]
struct Ellipse {
    center: DVec3,
    axes: Axes,
    /// a and b, world units.
    half: DVec2,
}

/// Where a ray meets an ellipse.
#[derive(Clone, Copy, Debug)]
struct Hit {
    /// The depth.
    k: f64,
    /// The place in half-axes.
    at: DVec2,
}

impl Ellipse {
    /// That of a sprite whose half-axis at rest is given, world units.
    fn new(sprite: &Sprite, settings: &Settings, half: f64) -> Self {
        let axes = axes(sprite, settings);
        let half = DVec2::new(half * (1.0 + axes.stretch), half);
        Self { center: sprite.center, axes, half }
    }

    /// Where a ray meets it, not before the near plane.
    fn meet(&self, ray: DVec3, near: f64) -> Option<Hit> {
        let n = self.axes.normal();
        let q = n.dot(ray);
        if q.abs() < EDGE_ON {
            return None;
        }
        let k = n.dot(self.center) / q;
        let p = ray * k - self.center;
        let at = DVec2::new(p.dot(self.axes.e1), p.dot(self.axes.e2)) / self.half;
        (k >= near && at.length_squared() <= 1.0).then_some(Hit { k, at })
    }

    /// The same as the thickness has it, in texels that are so wide at the depth of its centre; how
    /// much the noise tears it.
    fn wide(self, texel: f64, settings: &Settings) -> (Self, f64) {
        let cell = self.half.y / (CELLS * texel);
        let torn = settings.noise * smoothstep(TOLD_APART.0, TOLD_APART.1, cell);
        (Self { half: self.half.max(DVec2::splat(LEAST_AXIS * texel)), ..self }, torn)
    }

    /// The height along z at the middle of the thickness' sprite, world units: its integral is the
    /// particle's volume of foam. Flat ones would reach to any height.
    fn amplitude(&self, foam: f64, settings: &Settings) -> f64 {
        let facing = self.axes.normal().z.abs().max(LEAST_FACING);
        foam * settings.spacing.powi(3) / (PI * J * self.half.x * self.half.y * facing)
    }
}

/// How wide a texel is at the depth of a point.
fn texel(center: DVec3, view: &View) -> f64 {
    -center.z * view.slope_step().abs().max_element()
}

/// The pixels that may see anything within a distance of a point.
pub(super) fn pixels(
    view: &View,
    center: DVec3,
    reach: f64,
) -> impl Iterator<Item = (usize, usize)> {
    let (middle, half) = (center.truncate(), DVec2::splat(reach));
    let (columns, rows) = view.footprint(middle, half, -center.z - reach, -center.z + reach);
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

/// The pixel in which a texel's centre lies, of an image `2^level` times as fine: the last one
/// where the texel sticks out.
fn in_full<T: Clone>(image: &Image<T>, x: usize, y: usize, level: u32) -> T {
    // The middle of a block lies on the border of two pixels and counts to the latter.
    let middle = |i: usize| ((i << level) + (1 << level) / 2) as isize;
    image.clamped(middle(x), middle(y))
}

/// The scene's depth; what is no depth hides nothing.
pub(super) fn scene_depth(scene: f64) -> f64 {
    if scene > 0.0 { scene } else { f64::INFINITY }
}

/// The depth of the nearest foam in each pixel, world units. `scene`: the eye depth of what hides
/// it, as large as the view, infinite or [`EMPTY`] where there is nothing.
pub fn depth(
    sprites: &[Sprite],
    view: &View,
    settings: &Settings,
    scene: &Image<f64>,
) -> Image<f64> {
    let near = view.near();
    let mut depth = Image::new(view.width, view.height, EMPTY);
    for sprite in sprites {
        let Some(foam) = sprite.part_beyond(near) else { continue };
        let ellipse = Ellipse::new(sprite, settings, AXIS * settings.radius() * depth_part(foam));
        for (x, y) in pixels(view, sprite.center, ellipse.half.x) {
            let hit = ellipse.meet(view.ray(x, y), near);
            if let Some(hit) = hit.filter(|hit| hit.k < scene_depth(scene.at(x, y))) {
                let pixel = depth.at_mut(x, y);
                *pixel = pixel.min(hit.k);
            }
        }
    }
    depth
}

/// The thickness of foam along z in each texel, world units: of all, and of what lies no further
/// than [`Settings::front_depth`] behind `foam_depth`, which is that of [`depth`]. Texels are
/// blocks of `2^level` pixels a side of the view, which `scene` and `foam_depth` are as large as.
pub fn thickness(
    sprites: &[Sprite],
    view: &View,
    level: u32,
    settings: &Settings,
    scene: &Image<f64>,
    foam_depth: &Image<f64>,
) -> Image<[f64; 2]> {
    let (view, near) = (&view.reduced(level), view.near());
    let mut thickness = Image::new(view.width, view.height, [0.0; 2]);
    for sprite in sprites {
        let Some(foam) = sprite.part_beyond(near) else { continue };
        let ellipse = Ellipse::new(sprite, settings, AXIS * settings.radius());
        let (ellipse, torn) = ellipse.wide(texel(sprite.center, view), settings);
        let amplitude = ellipse.amplitude(foam, settings);
        for (x, y) in pixels(view, sprite.center, ellipse.half.x) {
            let hit = ellipse.meet(view.ray(x, y), near);
            let hidden = scene_depth(in_full(scene, x, y, level));
            let Some(hit) = hit.filter(|hit| hit.k < hidden) else { continue };
            let torn = 1.0 + torn * noise(sprite.place(hit.at.x, hit.at.y, settings));
            let value = amplitude * kernel(hit.at.length_squared()) * torn.max(0.0);
            let value = value * settings.sunk(hidden - hit.k);
            let nearest = in_full(foam_depth, x, y, level);
            let front = if is_surface(nearest) { settings.within(hit.k - nearest) } else { 0.0 };
            let texel = thickness.at_mut(x, y);
            texel[0] += value;
            texel[1] += value * front;
        }
    }
    thickness
}

/// Where the noise of an id begins, in cells.
pub fn origin(id: u32) -> DVec3 {
    let uniform = |i: u32| {
        let hash = pcg(id.wrapping_mul(3).wrapping_add(i));
        f64::from(hash >> 8) / 16_777_216.0
    };
    SPREAD * DVec3::new(uniform(0), uniform(1), uniform(2))
}

/// Perlin's gradient noise of a place in cells, about 0 and within the root of 1.5 of it.
pub fn noise(place: DVec3) -> f64 {
    let cell = place.floor();
    let fr = place - cell;
    let fade = fr * fr * fr * (fr * (6.0 * fr - 15.0) + 10.0);
    let corner = |i: i64, j: i64, k: i64| {
        let offset = fr - DVec3::new(i as f64, j as f64, k as f64);
        // To 32 bits by wrapping.
        let at = [cell.x as i64 + i, cell.y as i64 + j, cell.z as i64 + k].map(|c| c as u32);
        gradient(at, offset)
    };
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let along_x = |j, k| mix(corner(0, j, k), corner(1, j, k), fade.x);
    let along_y = |k| mix(along_x(0, k), along_x(1, k), fade.y);
    mix(along_y(0), along_y(1), fade.z)
}

/// The product of an offset with the gradient of a lattice point, one of twelve to the middle of a
/// cube's edges.
fn gradient([i, j, k]: [u32; 3], offset: DVec3) -> f64 {
    let h = pcg(i.wrapping_add(pcg(j.wrapping_add(pcg(k))))) & 15;
    let u = if h < 8 { offset.x } else { offset.y };
    let v = match h {
        0..4 => offset.y,
        12 | 14 => offset.x,
        _ => offset.z,
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// The most that [`noise`] is, by Jensen: a gradient is as long as the root of 2, and the squares
/// of an offset's parts are a quarter each at most in the mean by the fades,
/// `(1 - F) f^2 + F (1 - f)^2 <= f (1 - f)`, as `F <= f` up to the middle.
pub fn noise_reach() -> f64 {
    1.5_f64.sqrt()
}

/// The most that [`noise`] changes by a fade: the two ends along it are, by the same, `sqrt(2)
/// sqrt(f^2 + 1/2)` and that of 1 - f at most. The sum is convex, hence the largest at 0 and 1.
fn noise_by_fade() -> f64 {
    1.0 + 3.0_f64.sqrt()
}

/// The most that [`noise`] changes along an axis, to a cell: a part of a gradient is 1 at most, and
/// the slope of a fade `30 f^2 (1 - f)^2` is 15/8 at most. It is continuous from cell to cell.
pub fn noise_slope() -> f64 {
    1.0 + 15.0 / 8.0 * noise_by_fade()
}

/// What single precision adds to [`noise`] at a given place. The place in the cell and the product
/// with a gradient: 4u, of parts that are 1 at most. A fade: 15u, 9u and 1u of the sums, 3u of the
/// products. Three times a mix, 5u of numbers that are 2 at most.
pub(super) fn noise_rounding() -> f64 {
    U * (4.0 + 3.0 * 28.0 * noise_by_fade() + 3.0 * 10.0)
}

/// A vector and the length of the error that it may have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Off {
    pub(super) v: DVec3,
    pub(super) e: f64,
}

impl Off {
    /// A point by the product with the view's matrix: a product and three sums an axis, 4u of
    /// `|R| |p| + |t|`, with |p| <= |c| + |t|; as a vector |R| is no longer than the root of 3.
    pub(super) fn point(v: DVec3, view: &View) -> Self {
        let t = view.view.w_axis.truncate().length();
        let terms = 3.0_f64.sqrt() * (v.length() + t) + t;
        Self { v, e: 4.0 * U * terms }
    }

    /// A direction by the same without t: 3u.
    pub(super) fn direction(v: DVec3) -> Self {
        Self { v, e: 3.0 * 3.0_f64.sqrt() * U * v.length() }
    }

    /// The error lies across in whole and turns the vector. The sum of squares 3u/2, the root by `1
    /// / inversesqrt` 9u, the quotient 5u.
    pub(super) fn normalize(self) -> Self {
        let length = self.v.length();
        let turned = self.e / (length - self.e).max(f64::MIN_POSITIVE);
        Self { v: self.v / length, e: turned + 16.0 * U }
    }

    /// Two products and a sum, 2u of `|a_i b_j| + |a_j b_i|`: as a vector no longer than
    /// 2^(3/2) u |a| |b|.
    pub(super) fn cross(self, other: Self) -> Self {
        let v = self.v.cross(other.v);
        let (a, b) = (self.v.length(), other.v.length());
        let from = a * other.e + b * self.e + self.e * other.e;
        Self { v, e: from + 2.0 * SQRT_2 * U * a * b }
    }

    /// A product and two sums, 3u.
    pub(super) fn dot(self, other: Self) -> Rounded {
        let (a, b) = (self.v.length(), other.v.length());
        let from = a * other.e + b * self.e + self.e * other.e;
        Rounded { v: self.v.dot(other.v), e: from + 3.0 * U * (a + self.e) * (b + other.e) }
    }

    /// `a (1 - t) + b t` of unit vectors: 3u.
    fn mix(self, other: Self, t: Rounded) -> Self {
        let v = self.v.lerp(other.v, t.v);
        let from = self.e * (1.0 - t.v + t.e) + other.e * (t.v + t.e);
        Self { v, e: from + (other.v - self.v).length() * t.e + 3.0 * U }
    }

    /// The length: 3u/2 of the squares, 9u of the root.
    pub(super) fn length(self) -> Rounded {
        let v = self.v.length();
        Rounded { v, e: self.e + 11.0 * U * v }
    }
}

/// The ray of a pixel as `pixel scale + offset`, up to 2 / P00 and (1 + |P20|) / P00: two rounded
/// numbers, a product and a sum, 4u.
pub(super) fn ray_off(view: &View, x: usize, y: usize) -> Off {
    let terms = (3.0 + view.shift().abs()) / view.focal().abs();
    Off { v: view.ray(x, y), e: 4.0 * U * terms.length() }
}

/// Axes and their errors.
#[derive(Clone, Copy, Debug)]
struct LooseAxes {
    e1: Off,
    e2: Off,
    stretch: Rounded,
}

/// All axes that rounding may give a sprite: more than one where it decides by a threshold.
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
            // p = v x e2 = (dir - v (v.dir)) / |across|: on the side of dir, however rounded.
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
pub(super) struct LooseEllipse {
    pub(super) center: Off,
    pub(super) e1: Off,
    pub(super) e2: Off,
    pub(super) n: Off,
    pub(super) a: Rounded,
    pub(super) b: Rounded,
    /// The angle by which both axes may be turned in their plane, besides their errors.
    pub(super) turn: f64,
}

/// Where a ray may meet an ellipse.
#[derive(Clone, Copy, Debug)]
pub(super) struct LooseHit {
    /// The depth.
    pub(super) k: Rounded,
    /// The place in half-axes.
    x: Rounded,
    y: Rounded,
    /// The square of its distance from the centre.
    pub(super) rho_squared: Rounded,
    /// Whether it does meet it, before the scene.
    pub(super) sure: bool,
}

impl LooseEllipse {
    /// Those that rounding may make of a sprite, with the half-axis at rest in radii.
    pub(super) fn all(sprite: &Sprite, view: &View, settings: &Settings, half: f64) -> Vec<Self> {
        let center = Off::point(sprite.center, view);
        let axes = loose_axes(center, Off::direction(sprite.velocity), settings);
        let ellipse = |axes: LooseAxes| {
            let LooseAxes { e1, e2, stretch } = axes;
            // The radius is a rounded number times the spacing.
            let b = off(half * settings.radius(), 3.0);
            let a = b * (exact(1.0) + stretch);
            Self { center, e1, e2, n: e1.cross(e2), a, b, turn: 0.0 }
        };
        axes.into_iter().map(ellipse).collect()
    }

    /// The length in which all of it lies, by far more than its errors.
    pub(super) fn reach(&self) -> f64 {
        1.01 * (self.a.v + self.a.e) + 32.0 * (self.center.e + U * self.center.v.length())
    }

    /// See [`Ellipse::wide`]. A texel: the depth's error, 2u of the slope and a product.
    fn wide(self, view: &View, settings: &Settings) -> (Self, Rounded) {
        let z = Rounded { v: -self.center.v.z, e: self.center.e };
        let pixel = z * off(view.slope_step().abs().max_element(), 3.0);
        let cell = self.b / (off(CELLS, 1.0) * pixel);
        let (from, to) = TOLD_APART;
        let told = rounded::smoothstep(exact(from), exact(to), cell);
        let least = exact(LEAST_AXIS) * pixel;
        let (a, b) = (larger(self.a, least), larger(self.b, least));
        (Self { a, b, ..self }, off(settings.noise, 1.0) * told)
    }

    /// Whether and where a ray may meet it before the scene.
    ///
    /// k. The error of n counts by `n.(c - k w)` alone, which is 0 without it: by the distance p
    /// from the centre, not by the depth. Those of c and w count in whole, the two products by 3u,
    /// the quotient by 5u, all but the last over `n.w`.
    ///
    /// x. The error of k counts by `w.e1`, which is small where the plane faces the ray. That of e1
    /// counts by p, those of c and w in whole; u for `k w`, u for the difference, 3u for the
    /// product.
    pub(super) fn meet(&self, ray: Off, near: f64, scene: f64) -> Option<LooseHit> {
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
            // Anywhere.
            let any = Rounded { v: 0.0, e: f64::INFINITY };
            (any, any, any, any)
        };
        let (k, x, y, rho_squared) = hit;
        // The near plane and the scene's depth are made of the projection: 8u.
        let between = |near: f64, scene: f64, from: f64, to: f64| from >= near && to < scene;
        let (less, more) = (1.0 - 8.0 * U, 1.0 + 8.0 * U);
        let maybe = rho_squared.v - rho_squared.e <= 1.0
            && between(near * less, scene * more, k.v + k.e, k.v - k.e);
        let sure = rho_squared.v + rho_squared.e <= 1.0
            && least >= EDGE_ON * (1.0 + U)
            && between(near * more, scene * less, k.v - k.e, k.v + k.e);
        maybe.then_some(LooseHit { k, x, y, rho_squared, sure })
    }

    /// What the turn makes of the square of a distance in half-axes: its slope by the angle is no
    /// more than all that it ranges over, `d^2 (1/b^2 - 1/a^2)`. A circle may turn.
    fn turned(&self, distance_squared: f64) -> f64 {
        let (a, b) = (self.a.v + self.a.e, self.b.v - self.b.e);
        let range = distance_squared * (1.0 / (b * b) - 1.0 / (a * a)).max(0.0);
        if self.turn > 0.0 { self.turn.min(1.0) * range } else { 0.0 }
    }

    /// See [`Ellipse::amplitude`]. The volume 2u, pi J 3u, the least |n_z| u; a quotient more for
    /// those that divide twice.
    fn amplitude(&self, foam: f64, settings: &Settings) -> Rounded {
        let facing = Rounded { v: self.n.v.z.abs(), e: self.n.e };
        let facing = facing.clamp(LEAST_FACING, f64::INFINITY);
        let facing = Rounded { e: facing.e + U * LEAST_FACING, ..facing };
        let above = exact(foam) * off(settings.spacing.powi(3), 2.0 + 5.0);
        above / (off(PI * J, 3.0) * self.a * self.b * facing)
    }
}

/// The larger of two, of which either may be.
fn larger(a: Rounded, b: Rounded) -> Rounded {
    Rounded { v: a.v.max(b.v), e: if a.v - a.e > b.v + b.e { a.e } else { a.e.max(b.e) } }
}

/// The sprites that may be drawn, with their foam and whether they surely are: the near plane 8u.
fn maybe_drawn<'a>(
    sprites: &'a [Sprite],
    view: &'a View,
) -> impl Iterator<Item = (&'a Sprite, f64, bool)> {
    let near = view.near();
    sprites.iter().filter_map(move |sprite| {
        let (d, e) = (-sprite.center.z, Off::point(sprite.center, view).e);
        let foam = sprite.part().filter(|_| d + e > near * (1.0 - 8.0 * U))?;
        Some((sprite, foam, d - e > near * (1.0 + 8.0 * U)))
    })
}

/// Least and greatest of what the ellipses that rounding may make of a sprite are at a pixel, by
/// `of`, and whether all of them are there.
fn span<T, const N: usize>(
    ellipses: &[T],
    of: impl Fn(&T) -> Option<([f64; N], [f64; N], bool)>,
) -> Option<([f64; N], [f64; N], bool)> {
    let all: Vec<_> = ellipses.iter().map(of).collect();
    let sure = all.iter().all(|one| one.is_some_and(|(_, _, sure)| sure));
    let there = || all.iter().flatten();
    there().next()?;
    let low = std::array::from_fn(|i| there().map(|one| one.0[i]).fold(f64::INFINITY, f64::min));
    let high = std::array::from_fn(|i| there().map(|one| one.1[i]).fold(0.0, f64::max));
    Some((low, high, sure))
}

/// Bounds of [`depth`] for single precision: `low` is the nearest that any sprite may be, `high`
/// the nearest of those that are surely there.
pub fn depth_bounds(
    sprites: &[Sprite],
    view: &View,
    settings: &Settings,
    scene: &Image<f64>,
) -> Between {
    let near = view.near();
    let mut low = Image::new(view.width, view.height, EMPTY);
    let mut high = low.clone();
    for (sprite, foam, drawn) in maybe_drawn(sprites, view) {
        let ellipses = LooseEllipse::all(sprite, view, settings, AXIS * depth_part(foam));
        let reach = ellipses.iter().map(LooseEllipse::reach).fold(0.0, f64::max);
        for (x, y) in pixels(view, sprite.center, reach) {
            let (ray, scene) = (ray_off(view, x, y), scene_depth(scene.at(x, y)));
            let found = span(&ellipses, |ellipse| {
                let LooseHit { k, sure, .. } = ellipse.meet(ray, near, scene)?;
                Some(([(k.v - k.e).max(near * (1.0 - 8.0 * U))], [k.v + k.e], sure))
            });
            let Some(([least], [most], sure)) = found else { continue };
            let pixel = low.at_mut(x, y);
            *pixel = pixel.min(least);
            if sure && drawn {
                let pixel = high.at_mut(x, y);
                *pixel = pixel.min(most);
            }
        }
    }
    Between { low, high }
}

/// Bounds of both channels of [`thickness`], and of what of the second the sun lights, for single
/// precision, of sums in any order. What may or
/// may not be there, by the ellipse's rim, the scene or the depth of the foam, is left out of `low`
/// and in `high`. `foam_depth`: that of [`depth_bounds`], or twice the image itself if it is known.
pub fn thickness_bounds(
    sprites: &[Sprite],
    view: &View,
    level: u32,
    settings: &Settings,
    scene: &Image<f64>,
    foam_depth: &Between,
) -> [Between; 3] {
    let (full, view, near) = (view, &view.reduced(level), view.near());
    let mut low = Image::new(view.width, view.height, [0.0; 3]);
    let mut high = low.clone();
    let mut count = Image::new(view.width, view.height, 0.0);
    for (sprite, foam, drawn) in maybe_drawn(sprites, full) {
        let [darkest, brightest] = [sprite.sun[0] * (1.0 - U), sprite.sun[1] * (1.0 + U)];
        let ellipses = LooseEllipse::all(sprite, full, settings, AXIS);
        let ellipses: Vec<_> = ellipses.into_iter().map(|e| e.wide(view, settings)).collect();
        let reach = ellipses.iter().map(|(e, _)| e.reach()).fold(0.0, f64::max);
        for (x, y) in pixels(view, sprite.center, reach) {
            let (ray, scene) = (ray_off(view, x, y), scene_depth(in_full(scene, x, y, level)));
            let nearest = in_full(&foam_depth.low, x, y, level);
            let farthest = in_full(&foam_depth.high, x, y, level);
            let found = span(&ellipses, |(ellipse, strength)| {
                let hit = ellipse.meet(ray, near, scene)?;
                let bounds = value_bounds(sprite, (ellipse, *strength), &hit, foam, settings);
                // The scene's depth is made of the projection, 8u; the difference, the product and the
                // quotient 4u.
                let sunk = |sign: f64| {
                    if scene.is_infinite() {
                        return 1.0;
                    }
                    let there = scene * (1.0 + sign * 8.0 * U) - (hit.k.v - sign * hit.k.e);
                    settings.sunk(there) * (1.0 + sign * 4.0 * U)
                };
                let (least, most) = (bounds.0 * sunk(-1.0), bounds.1 * sunk(1.0));
                // The end of the layer is rounded by 2u, the ramp by 16u; it falls by 1.5 a spacing.
                let share = |there: f64, k: f64, by: f64| {
                    let off = 4.0 * U * (k.abs() + there + settings.front_depth);
                    match is_surface(there) {
                        true => {
                            (settings.within(k - there - by * off) + by * 16.0 * U).clamp(0.0, 1.0)
                        }
                        false => 0.0,
                    }
                };
                let surely = match is_surface(farthest) {
                    true => share(nearest, hit.k.v + hit.k.e, -1.0),
                    false => 0.0,
                };
                let maybe = match is_surface(nearest) {
                    true if is_surface(farthest) => share(farthest, hit.k.v - hit.k.e, 1.0),
                    true => 1.0,
                    false => 0.0,
                };
                let front = [surely * least, maybe * most];
                let lit = [front[0] * darkest, front[1] * brightest];
                Some(([least, front[0], lit[0]], [most, front[1], lit[1]], hit.sure))
            });
            let Some((least, most, sure)) = found else { continue };
            for i in 0..3 {
                let least = if sure && drawn { least[i] } else { 0.0 };
                low.at_mut(x, y)[i] += settings.in_steps(least, -1.0);
                high.at_mut(x, y)[i] += settings.in_steps(most[i], 1.0);
            }
            *count.at_mut(x, y) += 1.0;
        }
    }
    [0, 1, 2].map(|i| {
        let sum = |sums: &Image<[f64; 3]>, sign: f64| Image {
            width: sums.width,
            height: sums.height,
            data: (sums.data.iter().zip(&count.data))
                .map(|(sum, n)| sum[i] * (1.0 + sign * n * U))
                .collect(),
        };
        Between { low: sum(&low, -1.0), high: sum(&high, 1.0) }
    })
}

/// Least and greatest that a sprite may add where a ray meets it. The kernel falls from the centre
/// on; what is under its root is rounded once, u/2, the root by 9u, the exponential by 7 ulp, the
/// three products by 3u.
fn value_bounds(
    sprite: &Sprite,
    (ellipse, strength): (&LooseEllipse, Rounded),
    hit: &LooseHit,
    foam: f64,
    settings: &Settings,
) -> (f64, f64) {
    let amplitude = ellipse.amplitude(foam, settings);
    let rho_squared = hit.rho_squared;
    let least = kernel((rho_squared.v + rho_squared.e).min(1.0));
    let most = kernel((rho_squared.v - rho_squared.e).max(0.0));
    let place = sprite.place(hit.x.v, hit.y.v, settings);
    // One sum an axis, and the product with the age.
    let sums = place.abs().element_sum() + (sprite.age * settings.noise_rate).abs();
    let moved = CELLS * (hit.x.e + hit.y.e) + U * sums;
    let (here, error) = (noise(place), noise_slope() * moved + noise_rounding());
    let torn = |noise: f64, sign: f64| {
        let noise = noise.clamp(-noise_reach(), noise_reach());
        let part = strength.v * noise;
        let rounding = strength.e * noise.abs() + U * (part.abs() + (1.0 + part).abs());
        (1.0 + part + sign * rounding).max(0.0)
    };
    let rounding = U * (0.5 + 9.0 + 14.0 + 3.0);
    let low = (amplitude.v - amplitude.e) * least * torn(here - error, -1.0);
    let high = (amplitude.v + amplitude.e) * most * torn(here + error, 1.0);
    (low.max(0.0) * (1.0 - rounding), high * (1.0 + rounding))
}

#[cfg(test)]
mod tests {
    use super::super::tests::view;
    use super::*;
    use crate::support::scenes::Random;
    use glam::{Mat4, Vec2, Vec3};

    const SPACING: f64 = 0.5;

    fn settings() -> Settings {
        Settings { noise: 0.0, ..Settings::new(SPACING) }
    }

    /// A whole one at rest.
    fn sprite(center: [f64; 3]) -> Sprite {
        let center = DVec3::from(center);
        Sprite { center, foam: 1.0, velocity: DVec3::ZERO, age: 0.0, id: 7, sun: [1.0; 2] }
    }

    fn moving(center: [f64; 3], velocity: [f64; 3]) -> Sprite {
        Sprite { velocity: DVec3::from(velocity), ..sprite(center) }
    }

    fn nothing(view: &View) -> Image<f64> {
        Image::new(view.width, view.height, f64::INFINITY)
    }

    /// The sum of a thickness' channels.
    fn total(thickness: &Image<[f64; 2]>) -> DVec2 {
        thickness.data.iter().map(|t| DVec2::from(*t)).sum()
    }

    fn random(random: &mut Random, low: f64, high: f64) -> f64 {
        f64::from(random.between(low as f32, high as f32))
    }

    /// Numbers that single precision holds: sprites before and round the eye, of all speeds, some
    /// straight at it or across it, some just at a threshold.
    fn cloud(seed: u64, count: usize, far: f64, settings: &Settings) -> Vec<Sprite> {
        let mut r = Random(seed);
        let cloud = (0..count).map(|i| {
            let d = random(&mut r, 0.05, far);
            let center = DVec3::new(random(&mut r, -d, d), random(&mut r, -d, d), -d);
            let any = DVec3::from([0; 3].map(|_| random(&mut r, -1.0, 1.0)));
            let across = any.cross(center).normalize();
            let speed = 20.0 * settings.spacing;
            let velocity = match i % 8 {
                0 => DVec3::ZERO,
                1 => center + random(&mut r, 0.0, 0.5) * any,
                2 => speed * (center.normalize() + PARALLEL * across),
                3 => STILL * settings.spacing * any.normalize(),
                _ => 2.0 * speed * any,
            };
            let held = |v: DVec3| v.as_vec3().as_dvec3();
            let (foam, age) = (random(&mut r, 0.0, 1.1), random(&mut r, 0.0, 60.0).powi(2));
            let id = r.bits() as u32;
            Sprite { center: held(center), foam, velocity: held(velocity), age, id, sun: [1.0; 2] }
        });
        cloud.collect()
    }

    #[test]
    fn a_sprite_holds_its_particles_volume() {
        let settings = settings();
        let across = [40.0 * SPACING, 5.0 * SPACING, 0.0];
        let tilted = [20.0 * SPACING, 0.0, 18.0 * SPACING];
        for (at, velocity, foam) in [
            ([0.0, 0.0, -20.0], [0.0; 3], 1.0),
            ([0.0, 0.0, -20.0], across, 0.3),
            ([0.0, 0.0, -20.0], tilted, 1.0),
            ([3.0, -2.0, -20.0], tilted, 0.6),
        ] {
            let view = view(DVec2::new(3.0, -4.0), DVec2::new(0.1, -0.1), 401, 301);
            let sprite = Sprite { foam, ..moving(at, velocity) };
            let empty = Image::new(401, 301, EMPTY);
            let drawn = thickness(&[sprite], &view, 0, &settings, &nothing(&view), &empty);
            let ellipse = Ellipse::new(&sprite, &settings, 1e3);
            let n = ellipse.axes.normal();
            let mut sums = DVec2::ZERO;
            for (x, y) in (0..301).flat_map(|y| (0..401).map(move |x| (x, y))) {
                // A pixel of the plane at depth k, seen along z and along the ray.
                let ray = view.ray(x, y);
                let k = n.dot(sprite.center) / n.dot(ray);
                let area = drawn.at(x, y)[0] * k * k * view.c_x() * view.c_y();
                sums += area * DVec2::new(1.0, (n.z / n.dot(ray)).abs());
            }
            let expected = foam * SPACING.powi(3);
            assert!((sums.y / expected - 1.0).abs() < 3e-3, "{at:?}, {velocity:?}: {sums}");
            // Along the axis both are one.
            let on_axis = at[0] == 0.0;
            assert!(!on_axis || (sums.x / expected - 1.0).abs() < 1e-2, "{velocity:?}: {sums}");
            assert_eq!(total(&drawn).y, 0.0, "no depth of foam");
        }
    }

    #[test]
    fn the_axes_follow_the_motion() {
        let settings = settings();
        let mut r = Random(3);
        let mut kinds = [0; 3];
        for sprite in cloud(9, 4000, 20.0, &settings) {
            let found = axes(&sprite, &settings);
            let (v, n) = (sprite.center.normalize(), found.normal());
            assert!((found.e1.length() - 1.0).abs() < 1e-12 && (n.length() - 1.0).abs() < 1e-9);
            assert!(found.e2.dot(v).abs() < 1e-9, "the short one lies across the view");
            assert!(n.dot(v).abs() > 0.43, "never edge-on");
            let speed = sprite.velocity.length() / SPACING;
            let dir = sprite.velocity.normalize_or_zero();
            if found.stretch == 0.0 {
                assert!(n.dot(v).abs() > 1.0 - 1e-12, "across the view");
            }
            if speed > settings.motion_threshold && dir.dot(v).abs() < HEAD_ON.0 {
                assert!(found.stretch == 1.0 && (found.e1 - dir).length() < 1e-12);
                kinds[0] += 1;
            } else if speed > 1e-3 && dir.cross(v).length() > 2e-3 {
                assert!(found.e1.dot(dir) > 0.0);
                kinds[1] += 1;
            } else if speed < 0.9e-6 {
                let turned = Sprite { velocity: sprite.velocity * 0.1, ..sprite };
                assert_eq!(found, axes(&turned, &settings));
                kinds[2] += 1;
            }
        }
        assert!(kinds.into_iter().all(|n| n > 400), "{kinds:?}");
        // Half of the threshold is half of the stretch.
        let half = moving([0.0, 0.0, -9.0], [0.5 * 21.0 * SPACING, 0.0, 0.0]);
        assert!((axes(&half, &settings).stretch - 0.5).abs() < 1e-12);
        // At rest: level, but where straight up and the view are one.
        let level = axes(&sprite([0.3, 2.0, -5.0]), &settings);
        assert!(level.e2.y.abs() < 1e-12 && level.e1.y.abs() > 0.9);
        let steep = axes(&sprite([1e-5, random(&mut r, 4.0, 5.0), -1e-5]), &settings);
        assert!(steep.e2.is_finite() && steep.e2.x.abs() < 1e-3 && steep.e2.z.abs() > 0.99);
    }

    /// Pixels of the image of the depth with a surface, and their extents.
    fn extents(drawn: &Image<f64>) -> (usize, usize, usize) {
        let seen = |x: usize, y: usize| is_surface(drawn.at(x, y));
        let column = |x: &usize| (0..drawn.height).any(|y| seen(*x, y));
        let row = |y: &usize| (0..drawn.width).any(|x| seen(x, *y));
        let (columns, rows) = ((0..drawn.width).filter(column), (0..drawn.height).filter(row));
        let count = drawn.data.iter().filter(|d| is_surface(**d)).count();
        (count, columns.count(), rows.count())
    }

    #[test]
    fn motion_across_doubles_and_towards_the_eye_does_not() {
        let settings = settings();
        let view = view(DVec2::splat(2.0), DVec2::ZERO, 240, 240);
        let (at, fast) = ([0.0, 0.0, -6.0], 30.0 * SPACING);
        let of = |s: Sprite| extents(&depth(&[s], &view, &settings, &nothing(&view)));
        let rest = of(sprite(at));
        // 2 r over 6, in pixels of 1/120 of depth.
        let expected = 2.0 * 2.0 * 0.656 * SPACING / 6.0 * 240.0;
        assert!((rest.1 as f64 - expected).abs() < 2.0 && rest.1 == rest.2, "{rest:?}");
        for (velocity, by) in [
            ([fast, 0.0, 0.0], (2.0, 1.0)),
            ([0.0, -fast, 0.0], (1.0, 2.0)),
            ([0.0, 0.0, fast], (1.0, 1.0)),
            ([0.0, 0.0, -fast], (1.0, 1.0)),
            ([0.05 * fast, 0.0, fast], (1.0, 1.0)),
        ] {
            let found = of(moving(at, velocity));
            let near = |a: usize, b: f64| (a as f64 - b).abs() <= 2.0;
            let (width, height) = (rest.1 as f64 * by.0, rest.2 as f64 * by.1);
            assert!(near(found.1, width) && near(found.2, height), "{velocity:?}: {found:?}");
            let grown = found.0 as f64 / rest.0 as f64 / (by.0 * by.1);
            assert!((grown - 1.0).abs() < 0.02, "{velocity:?}: {grown}");
        }
        let quarter = of(Sprite { foam: 0.0625, ..sprite(at) });
        assert!((quarter.0 as f64 / rest.0 as f64 - 0.25).abs() < 0.01);
        assert_eq!(of(Sprite { foam: 0.125, ..sprite(at) }), rest);
        assert_eq!(of(Sprite { foam: 3.0, ..sprite(at) }), rest, "no more than whole");
    }

    #[test]
    fn depth_is_that_of_the_nearest_plane() {
        let settings = settings();
        let view = view(DVec2::new(1.5, -2.0), DVec2::new(0.1, 0.2), 64, 48);
        let sprites = cloud(4, 200, 9.0, &settings);
        let all = depth(&sprites, &view, &settings, &nothing(&view));
        let single: Vec<_> =
            sprites.iter().map(|s| depth(&[*s], &view, &settings, &nothing(&view))).collect();
        for i in 0..all.data.len() {
            let least = single.iter().map(|one| one.data[i]).fold(EMPTY, f64::min);
            assert_eq!(all.data[i], least);
        }
        assert!(extents(&all).0 > 500);
        // Every point lies in the plane and in the ellipse; all pixels were looked at.
        for (sprite, drawn) in sprites.iter().zip(&single).take(60) {
            let foam = sprite.foam.min(1.0);
            let ellipse =
                Ellipse::new(sprite, &settings, AXIS * settings.radius() * depth_part(foam));
            for (x, y) in (0..48).flat_map(|y| (0..64).map(move |x| (x, y))) {
                let hit = ellipse.meet(view.ray(x, y), view.near());
                let hit = hit.filter(|_| foam > 0.0 && -sprite.center.z > view.near());
                assert_eq!(drawn.at(x, y), hit.map_or(EMPTY, |hit| hit.k));
                if let Some(hit) = hit {
                    let p = view.ray(x, y) * hit.k - sprite.center;
                    assert!(p.dot(ellipse.axes.normal()).abs() < 1e-9);
                    assert!(p.length() <= ellipse.half.x * (1.0 + 1e-9));
                }
            }
        }
    }

    #[test]
    fn what_takes_no_part() {
        let settings = settings();
        let view = view(DVec2::ONE, DVec2::ZERO, 16, 16);
        let good = sprite([0.0, 0.0, -3.0]);
        let with = |change: fn(&mut Sprite)| {
            let mut sprite = good;
            change(&mut sprite);
            sprite
        };
        let none = [
            with(|s| s.foam = 0.0),
            with(|s| s.foam = -1.0),
            with(|s| s.foam = f64::NAN),
            with(|s| s.center.x = f64::NAN),
            with(|s| s.velocity.y = f64::INFINITY),
            with(|s| s.center.z = -0.09),
            with(|s| s.center.z = 3.0),
        ];
        let scene = nothing(&view);
        let empty = Image::new(16, 16, EMPTY);
        let count = |sprites: &[Sprite]| {
            let sum = total(&thickness(sprites, &view, 0, &settings, &scene, &empty)).x;
            (extents(&depth(sprites, &view, &settings, &scene)).0, sum)
        };
        assert_eq!(count(&none), (0, 0.0));
        let (pixels, sum) = count(&[good]);
        assert!(pixels > 10 && sum > 0.0);
    }

    #[test]
    fn the_scene_hides_by_the_planes_depth() {
        let settings = settings();
        let view = view(DVec2::splat(2.0), DVec2::ZERO, 120, 120);
        // Nearer on the right: half of it is before the scene.
        let tilted = [moving([0.0, 0.0, -6.0], [20.0 * SPACING, 0.0, 18.0 * SPACING])];
        let wall = Image::new(120, 120, 6.0);
        let open = depth(&tilted, &view, &settings, &nothing(&view));
        let cut = depth(&tilted, &view, &settings, &wall);
        for (open, cut) in open.data.iter().zip(&cut.data) {
            assert_eq!(*cut, if *open < 6.0 { *open } else { EMPTY });
        }
        let ratio = extents(&cut).0 as f64 / extents(&open).0 as f64;
        assert!((0.4..0.7).contains(&ratio), "{ratio}");
        // What is no depth hides nothing.
        for none in [0.0, -4.0, f64::NAN, EMPTY] {
            assert_eq!(depth(&tilted, &view, &settings, &Image::new(120, 120, none)), open);
        }
        let sum = |scene: &Image<f64>, level: u32| {
            total(&thickness(&tilted, &view, level, &settings, scene, &open))
                * f64::from(1 << (2 * level))
        };
        let (all, half) = (sum(&nothing(&view), 0).x, sum(&wall, 0).x);
        assert!((0.4..0.7).contains(&(half / all)));
        assert!((sum(&wall, 2).x / half - 1.0).abs() < 0.05);
        // The texel goes by the pixel after its middle.
        let stripes = Image::from_fn(120, 120, |x, _| if x % 4 == 2 { 99.0 } else { 1.0 });
        assert!((sum(&stripes, 2).x / all - 1.0).abs() < 0.05);
        assert!(sum(&stripes, 0).x < 0.3 * all);
        let stripes = Image::from_fn(120, 120, |x, _| if x % 4 == 2 { 1.0 } else { 99.0 });
        assert_eq!(sum(&stripes, 2).x, 0.0);
    }

    #[test]
    fn the_window_behind_the_nearest_foam() {
        let settings = settings();
        let view = view(DVec2::splat(2.0), DVec2::ZERO, 61, 61);
        let [at_4, at_7, at_8] = [4.0, 7.4, 8.1].map(|d| sprite([0.0, 0.0, -d]));
        let none = nothing(&view);
        let of = |sprites: &[Sprite], foam: &Image<f64>| {
            thickness(sprites, &view, 0, &settings, &none, foam)
        };
        let foam = depth(&[at_4, at_7, at_8], &view, &settings, &none);
        assert!((foam.at(30, 30) - 4.0).abs() < 1e-9);
        let (all, near) = (of(&[at_4, at_7, at_8], &foam), of(&[at_4, at_7], &foam));
        for (x, y) in (0..61).flat_map(|y| (0..61).map(move |x| (x, y))) {
            // 7 spacings are 3.5, and one more. Nothing where the depth has nothing, though there is some.
            let expected = if is_surface(foam.at(x, y)) { near.at(x, y)[0] } else { 0.0 };
            assert!((all.at(x, y)[1] - expected).abs() < 1e-12);
            assert!(all.at(x, y)[1] <= all.at(x, y)[0]);
        }
        // Of little foam the depth is smaller than the thickness.
        let little = [Sprite { foam: 0.0625, ..at_4 }];
        let rim = of(&little, &depth(&little, &view, &settings, &none));
        assert!(rim.data.iter().any(|t| t[0] > 0.0 && t[1] == 0.0));
        assert!(total(&all).y > 0.5 * total(&all).x);
        let all_in = Settings { front_depth: 4.2, ..settings };
        let all_in = thickness(&[at_4, at_7, at_8], &view, 0, &all_in, &none, &foam);
        assert_eq!(all_in.at(30, 30)[0], all_in.at(30, 30)[1]);
    }

    #[test]
    fn the_noise_is_even_continuous_and_does_not_repeat() {
        let mut r = Random(11);
        let mut place = |size: f64| DVec3::from([0; 3].map(|_| random(&mut r, -size, size)));
        let n = 400_000;
        let (mut sum, mut squares, mut most, mut steepest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for i in 0..n {
            let at = place(1000.0);
            let value = noise(at);
            sum += value;
            squares += value * value;
            most = most.max(value.abs());
            // Every second across the border of cells.
            let at = if i % 2 == 0 { at } else { DVec3::new(at.x.round() - 5e-7, at.y, at.z) };
            let axis = [DVec3::X, DVec3::Y, DVec3::Z][i / 2 % 3];
            let step = if i % 2 == 0 { 1e-6 * axis } else { 1e-6 * DVec3::X };
            steepest = steepest.max((noise(at + step) - noise(at)).abs() / 1e-6);
        }
        let (mean, deviation) = (sum / n as f64, (squares / n as f64).sqrt());
        // Neighbours of a sample are none of it: the samples are independent.
        assert!(mean.abs() < 4.0 * deviation / (n as f64).sqrt(), "{mean}");
        assert!(deviation > 0.2 && most > 0.8 && most <= noise_reach(), "{deviation}, {most}");
        assert!(steepest > 1.5 && steepest <= noise_slope(), "{steepest}");
        for corner in [DVec3::ZERO, DVec3::new(-3.0, 5.0, 64.0), DVec3::splat(-1.0)] {
            assert_eq!(noise(corner), 0.0);
        }
        // No shift along an axis brings it back.
        let sample: Vec<DVec3> = (0..3000).map(|_| place(100.0)).collect();
        let values: Vec<f64> = sample.iter().map(|at| noise(*at)).collect();
        let norm: f64 = values.iter().map(|v| v * v).sum();
        for shift in (1..=128).chain([192, 256, 512, 1024, 4096, 65536]) {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let moved = |at: &DVec3| noise(*at + f64::from(shift) * axis);
                let product: f64 = sample.iter().zip(&values).map(|(at, v)| moved(at) * v).sum();
                assert!((product / norm).abs() < 0.15, "{shift} along {axis}: {}", product / norm);
            }
        }
    }

    #[test]
    fn the_gradients_are_the_twelve_edges() {
        let mut found = std::collections::HashMap::new();
        for i in 0..4096_u32 {
            let at = [i & 15, (i >> 4 & 15).wrapping_sub(8), i >> 8];
            let g = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| gradient(at, axis) as i32);
            assert_eq!(g.iter().filter(|part| **part == 0).count(), 1);
            assert_eq!(g.iter().map(|part| part.abs()).sum::<i32>(), 2);
            *found.entry(g).or_insert(0) += 1;
        }
        assert_eq!(found.len(), 12);
        // Four of them of two hashes.
        for (g, count) in found {
            let twice = [[1, 1, 0], [-1, 1, 0], [0, -1, 1], [0, -1, -1]].contains(&g);
            let expected = if twice { 512.0 } else { 256.0 };
            assert!((f64::from(count) - expected).abs() < 5.0 * expected.sqrt(), "{g:?}: {count}");
        }
    }

    #[test]
    fn the_noise_is_each_particles_own_and_keeps_the_volume() {
        let view = view(DVec2::splat(2.0), DVec2::ZERO, 61, 61);
        let settings = Settings::new(SPACING);
        let (none, empty) = (nothing(&view), Image::new(61, 61, EMPTY));
        let whole = sprite([0.0, 0.0, -5.0]);
        let of = |s: Sprite, by: &Settings| thickness(&[s], &view, 0, by, &none, &empty);
        let smooth = of(whole, &Settings { noise: 0.0, ..settings });
        let by_id = |id: u32| of(Sprite { id, ..whole }, &settings);
        assert!(by_id(1) != by_id(2) && by_id(1) == by_id(1));
        let later = of(Sprite { age: 0.1, id: 1, ..whole }, &settings);
        assert_ne!(later, by_id(1));
        let still = Settings { noise_rate: 0.0, ..settings };
        assert_eq!(of(Sprite { age: 0.1, id: 1, ..whole }, &still), by_id(1));
        // Torn to nothing nowhere, as 0.9 of the noise is more than -1 nearly always: the mean is
        // that without.
        let mean = (0..600).map(|id| total(&by_id(id)).x).sum::<f64>() / 600.0;
        assert!((mean / total(&smooth).x - 1.0).abs() < 0.02, "{mean}");
        let torn = Settings { noise: 4.0, ..settings };
        assert!(
            (0..9).all(|id| { of(Sprite { id, ..whole }, &torn).data.iter().all(|t| t[0] >= 0.0) })
        );
        // An origin is in its range and a hash of its own.
        let origins: Vec<DVec3> = (0..4000).map(origin).collect();
        assert!(origins.iter().all(|o| o.min_element() >= 0.0 && o.max_element() < SPREAD));
        let mean = origins.iter().sum::<DVec3>() / 4000.0;
        assert!((mean - SPREAD / 2.0).abs().max_element() < 2.0, "{mean}");
        assert!(origin(u32::MAX).is_finite(), "three times an id wraps");
    }

    /// The definition in single precision, each operation rounded.
    struct Single {
        center: Vec3,
        e1: Vec3,
        e2: Vec3,
        half: Vec2,
        amplitude: f32,
        torn: f32,
    }

    impl Single {
        /// `texels`: those of the thickness.
        fn new(world: &Sprite, view: &View, settings: &Settings, texels: Option<&View>) -> Self {
            let thickness = texels.is_some();
            let to_eye = view.view.as_mat4();
            let c = to_eye.transform_point3(world.center.as_vec3());
            let u = to_eye.transform_vector3(world.velocity.as_vec3());
            let (spacing, foam) = (settings.spacing as f32, (world.foam as f32).min(1.0));
            let step = |low: f32, high: f32, x: f32| {
                let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            };
            let (v, speed) = (c / c.length(), u.length() / spacing);
            let dir = if speed > 1e-6 { u / u.length() } else { Vec3::ZERO };
            let across = dir.cross(v);
            let (e1, e2, t) = if speed <= 1e-6 || across.length() < 1e-3 {
                let up = v.cross(Vec3::Y);
                let side = if up.length() < 1e-3 { v.cross(Vec3::X) } else { up };
                let e2 = side / side.length();
                (e2.cross(v), e2, 0.0)
            } else {
                let e2 = across / across.length();
                let p = e2.cross(v);
                let p = if p.dot(dir) < 0.0 { -p } else { p };
                let t = step(0.0, settings.motion_threshold as f32, speed)
                    * (1.0 - step(0.9, 1.0, v.dot(dir).abs()));
                let e1 = p * (1.0 - t) + dir * t;
                (e1 / e1.length(), e2, t)
            };
            let r = 0.656_f32 * spacing;
            let b = 2.0 * r * if thickness { 1.0 } else { (8.0 * foam).min(1.0) };
            let (mut half, mut torn) = (Vec2::new(b * (1.0 + t), b), 0.0);
            if let Some(texels) = texels {
                let texel = -c.z * texels.slope_step().as_vec2().abs().max_element();
                torn = settings.noise as f32 * step(1.0, 2.0, b / (1.6 * texel));
                half = half.max(Vec2::splat(1.5 * texel));
            }
            let facing = e1.cross(e2).z.abs().max(0.2);
            let below = std::f32::consts::PI * 0.340003 * half.x * half.y * facing;
            let amplitude = foam * (spacing * spacing * spacing) / below;
            Self { center: c, e1, e2, half, amplitude, torn }
        }

        fn meet(&self, view: &View, x: usize, y: usize, scene: f64) -> Option<(f32, Vec2)> {
            let scale = view.slope_step().as_vec2();
            let offset = ((view.shift() - 1.0) / view.focal()).as_vec2();
            let w = (Vec2::new(x as f32 + 0.5, y as f32 + 0.5) * scale + offset).extend(-1.0);
            let n = self.e1.cross(self.e2);
            let q = n.dot(w);
            let k = n.dot(self.center) / q;
            let p = k * w - self.center;
            let at = Vec2::new(p.dot(self.e1) / self.half.x, p.dot(self.e2) / self.half.y);
            let drawn = -self.center.z > view.near() as f32 && q.abs() >= 1e-6;
            let between = k >= view.near() as f32 && (scene as f32) > k;
            (drawn && between && at.x * at.x + at.y * at.y <= 1.0).then_some((k, at))
        }

        fn value(&self, sprite: &Sprite, at: Vec2, settings: &Settings) -> f32 {
            let own = origin(sprite.id).as_vec3();
            let z = sprite.age as f32 * settings.noise_rate as f32 + own.z;
            let place = Vec3::new(1.6 * at.x + own.x, 1.6 * at.y + own.y, z);
            let (cell, fr) = (place.floor(), place - place.floor());
            let fade = fr * fr * fr * (fr * (6.0 * fr - 15.0) + 10.0);
            let mut sums = [0.0_f32; 8];
            for (i, sum) in sums.iter_mut().enumerate() {
                let corner = Vec3::from([i & 1, i >> 1 & 1, i >> 2].map(|c| c as f32));
                let lattice = (cell + corner).to_array().map(|c| c as i32 as u32);
                // The sum of two is rounded as single precision does it.
                *sum = gradient(lattice, (fr - corner).as_dvec3()) as f32;
            }
            let mix = |a: f32, b: f32, t: f32| a * (1.0 - t) + b * t;
            let x = [0, 2, 4, 6].map(|i| mix(sums[i], sums[i + 1], fade.x));
            let y = [0, 2].map(|i| mix(x[i], x[i + 1], fade.y));
            let torn = 1.0 + self.torn * mix(y[0], y[1], fade.z);
            let rho_squared = at.x * at.x + at.y * at.y;
            let kernel = (1.0 - rho_squared).max(0.0).sqrt() * (-2.0 * rho_squared).exp();
            self.amplitude * kernel * torn.max(0.0)
        }

        /// The depth and both channels of the thickness.
        fn draw(
            world: &[Sprite],
            view: &View,
            level: u32,
            settings: &Settings,
            scene: &Image<f64>,
        ) -> [Image<f32>; 3] {
            let all = |texels: Option<&View>| -> Vec<Self> {
                world.iter().map(|s| Self::new(s, view, settings, texels)).collect()
            };
            let reduced = view.reduced(level);
            let (flat, thick) = (all(None), all(Some(&reduced)));
            let depth = Image::from_fn(view.width, view.height, |x, y| {
                let hits = flat.iter().filter_map(|s| s.meet(view, x, y, scene.at(x, y)));
                hits.map(|hit| hit.0).fold(1e10, f32::min)
            });
            let mut sums = [0, 1].map(|_| Image::new(reduced.width, reduced.height, 0.0_f32));
            for (x, y) in (0..reduced.height).flat_map(|y| (0..reduced.width).map(move |x| (x, y)))
            {
                let nearest = in_full(&depth, x, y, level);
                for (single, sprite) in thick.iter().zip(world) {
                    let scene = in_full(scene, x, y, level);
                    let Some((k, at)) = single.meet(&reduced, x, y, scene) else { continue };
                    let before = (scene_depth(scene) as f32 - k) / (0.5 * settings.spacing as f32);
                    let value = single.value(sprite, at, settings) * before.min(1.0);
                    *sums[0].at_mut(x, y) += value;
                    if nearest < 1e9 {
                        let end = settings.front_depth as f32;
                        let t = ((k - nearest - end) / settings.spacing as f32).clamp(0.0, 1.0);
                        *sums[1].at_mut(x, y) += value * (1.0 - t * t * (3.0 - 2.0 * t));
                    }
                }
            }
            let [all, front] = sums;
            [depth, all, front]
        }
    }

    /// How much of their bounds single precision makes use of, and how wide they are.
    #[derive(Default)]
    struct Use {
        worst: [f64; 3],
        widths: [Vec<f64>; 3],
        open: [usize; 2],
    }

    impl Use {
        /// Holds both the twin and single precision against the bounds of some sprites, which are
        /// given in the world.
        fn check(
            &mut self,
            world: &[Sprite],
            view: &View,
            level: u32,
            settings: &Settings,
            scene: &Image<f64>,
        ) {
            let to_eye = |s: &Sprite| Sprite {
                center: view.view.transform_point3(s.center),
                velocity: view.view.transform_vector3(s.velocity),
                ..*s
            };
            let sprites: Vec<Sprite> = world.iter().map(to_eye).collect();
            let twin = depth(&sprites, view, settings, scene);
            let sums = thickness(&sprites, view, level, settings, scene, &twin);
            let [all, front] = [0, 1].map(|i| sums.map(|t| t[i]));
            let bounds = depth_bounds(&sprites, view, settings, scene);
            let [a, b, _] = thickness_bounds(&sprites, view, level, settings, scene, &bounds);
            let single = Single::draw(world, view, level, settings, scene);
            let images = [twin, all, front].into_iter().zip(single).zip([bounds, a, b]);
            for (i, ((twin, single), bounds)) in images.enumerate() {
                for (at, (low, high)) in bounds.low.data.iter().zip(&bounds.high.data).enumerate() {
                    let found = f64::from(single.data[at]);
                    for value in [twin.data[at], found] {
                        assert!(*low <= value && value <= *high, "{i}: {low} {value} {high}");
                    }
                    let there = if i == 0 { is_surface(*low) } else { *high > 0.0 };
                    let sure = if i == 0 { is_surface(*high) } else { *low > 0.0 };
                    self.open[usize::from(sure)] += usize::from(there);
                    if sure && high > low {
                        let off = (2.0 * found - low - high).abs() / (high - low);
                        self.worst[i] = self.worst[i].max(off);
                        self.widths[i].push((high - low) / (high + low));
                    }
                }
            }
        }
    }

    #[test]
    fn single_precision_stays_in_the_bounds() {
        let full = view(DVec2::new(0.9, -1.2), DVec2::new(0.2, -0.1), 37, 26);
        let turned = Mat4::from_rotation_y(0.7) * Mat4::from_rotation_x(0.4);
        let scene =
            Image::from_fn(37, 26, |x, y| if (x / 9 + y / 5) % 2 == 0 { 3.0 } else { 99.0 });
        let (mut usual, mut special) = (Use::default(), Use::default());
        for (spacing, far, eye) in
            [(0.5, 20.0, 2.0), (0.05, 20.0, 1.0), (0.05, 2.0, 50.0), (2.0, 9.0, 0.0)]
        {
            let settings = Settings::new(f64::from(spacing as f32));
            let eye = Mat4::from_translation(eye * Vec3::new(1.0, -0.7, 0.3));
            let view = View { view: (turned * eye).as_dmat4(), ..full };
            let back = view.view.inverse();
            let mut sprites = cloud(5, 240, far, &settings);
            for sprite in &mut sprites {
                sprite.center = back.transform_point3(sprite.center).as_vec3().as_dvec3();
                sprite.velocity = back.transform_vector3(sprite.velocity).as_vec3().as_dvec3();
            }
            for (i, sprite) in sprites.iter().enumerate() {
                let used = if (1..4).contains(&(i % 8)) { &mut special } else { &mut usual };
                used.check(&[*sprite], &view, i as u32 % 3, &settings, &scene);
            }
            for level in 0..2 {
                Use::default().check(&sprites, &view, level, &settings, &scene);
            }
        }
        for widths in &mut usual.widths {
            widths.sort_by(f64::total_cmp);
        }
        let middle = usual.widths.each_ref().map(|w| w[w.len() / 2]);
        assert!(middle[0] < 2e-5 && middle[1] < 3e-3 && middle[2] < 3e-3, "{middle:?}");
        assert!(usual.open[0] * 50 < usual.open[1], "{:?}", usual.open);
        // The host rounds each operation to half an ulp, which is a tenth of what Vulkan asks for.
        assert!(usual.worst.iter().all(|worst| *worst > 0.05), "{:?}", usual.worst);
        // At a threshold of the axes both ways are gone.
        assert!(special.worst[1] > 0.9, "{:?}", special.worst);
    }
}
