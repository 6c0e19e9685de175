//! Foam in single precision on the CPU, with each operation rounded, to check the bounds.

use super::super::{Image, View, is_surface};
use super::noise::gradient;
use super::texels::{in_full, scene_depth};
use super::{Settings, Sprite, depth, depth_bounds, origin, thickness, thickness_bounds};
use glam::{Vec2, Vec3};

/// The definition in single precision, with each operation rounded.
struct Single {
    center: Vec3,
    e1: Vec3,
    e2: Vec3,
    half: Vec2,
    amplitude: f32,
    torn: f32,
}

impl Single {
    /// The sprite of the depth, or of the thickness, for these texels.
    fn new(
        world: &Sprite,
        view: &View,
        settings: &Settings,
        texels: &View,
        thickness: bool,
    ) -> Self {
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
        let b = 2.0 * r;
        let texel = -c.z * texels.slope_step().as_vec2().abs().max_element();
        let torn = settings.noise as f32 * step(1.0, 2.0, b / (1.6 * texel));
        let part = if thickness { 1.0 } else { (8.0 * foam).min(1.0) };
        let half = Vec2::new(b * (1.0 + t), b).max(Vec2::splat(1.5 * texel)) * part;
        let facing = (e1.cross(e2).dot(c) / c.z).abs().max(0.2);
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
            // The sum of two terms is rounded as in single precision.
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

    /// The depth and the channels of the thickness.
    fn draw(
        world: &[Sprite],
        view: &View,
        level: u32,
        settings: &Settings,
        scene: &Image<f64>,
    ) -> [Image<f32>; 4] {
        let reduced = view.reduced(level);
        let all = |thickness: bool| -> Vec<Self> {
            world.iter().map(|s| Self::new(s, view, settings, &reduced, thickness)).collect()
        };
        let (flat, thick) = (all(false), all(true));
        let depth = Image::from_fn(reduced.width, reduced.height, |x, y| {
            let scene = in_full(scene, x, y, level);
            let hits = flat.iter().filter_map(|s| s.meet(&reduced, x, y, scene));
            hits.map(|hit| hit.0).fold(1e10, f32::min)
        });
        let mut sums = [0, 1, 2].map(|_| Image::new(reduced.width, reduced.height, 0.0_f32));
        for (x, y) in (0..reduced.height).flat_map(|y| (0..reduced.width).map(move |x| (x, y))) {
            let nearest = depth.at(x, y);
            for (single, sprite) in thick.iter().zip(world) {
                let scene = in_full(scene, x, y, level);
                let Some((k, at)) = single.meet(&reduced, x, y, scene) else { continue };
                let before = (scene_depth(scene) as f32 - k) / (0.5 * settings.spacing as f32);
                let value = single.value(sprite, at, settings) * before.min(1.0);
                *sums[0].at_mut(x, y) += value;
                let (end, spacing) = (settings.front_depth as f32, settings.spacing as f32);
                let t = ((k - nearest - end) / spacing).clamp(0.0, 1.0);
                let front = if nearest < 1e9 { 1.0 - t * t * (3.0 - 2.0 * t) } else { 0.0 };
                *sums[1].at_mut(x, y) += value * front;
                let past = (k - nearest - spacing).max(0.0);
                *sums[2].at_mut(x, y) += value * (past / (past + spacing));
            }
        }
        let [all, front, far] = sums;
        [depth, all, front, far]
    }
}

/// Fraction of the bounds that single precision uses, and their widths.
#[derive(Default)]
pub(super) struct Use {
    pub(super) worst: [f64; 4],
    pub(super) widths: [Vec<f64>; 4],
    pub(super) open: [usize; 2],
}

impl Use {
    /// Compares the twin and single precision with the bounds of sprites that are given in world
    /// space.
    pub(super) fn check(
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
        let twin = depth(&sprites, view, level, settings, scene);
        let sums = thickness(&sprites, view, level, settings, scene, &twin);
        let [all, front, far] = [0, 1, 2].map(|i| sums.map(|t| t[i]));
        let bounds = depth_bounds(&sprites, view, level, settings, scene);
        let [a, b, _, c] = thickness_bounds(&sprites, view, level, settings, scene, &bounds);
        let single = Single::draw(world, view, level, settings, scene);
        let images = [twin, all, front, far].into_iter().zip(single).zip([bounds, a, b, c]);
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
