//! Shore foam in single precision, as in a shader, to check the bounds: filter weights are rounded
//! to 1/256, and the sine has the largest permitted error.

use std::f32::consts::TAU;

use super::foam::{Noise, Shoreline};
use super::map::{Heights, Seed};
use super::texture::Texture;
use super::{Bounded, Water};

fn f([a, b]: [Bounded; 2]) -> [f32; 2] {
    [a.value as f32, b.value as f32]
}

/// Sine of x, reduced to around 0; `by` from -1 to 1 scales its error.
pub fn sine(x: f32, by: f32) -> f32 {
    let x = x - TAU * (x / TAU).round();
    x.sin() + by * 0.99 / 2048.0
}

pub fn smoothstep(high: f32, x: f32) -> f32 {
    let t = (x / high).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn weight(part: f32) -> f32 {
    (part * 256.0).round() / 256.0
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + t * (b - a)
}

fn bilinear<const C: usize>(texture: &Texture<C>, level: usize, uv: [f32; 2]) -> [f32; C] {
    let edge = (texture.size() >> level) as i64;
    let at = uv.map(|v| v * edge as f32 - 0.5);
    let [x, y] = at.map(|v| v.floor() as i64);
    let [fx, fy] = at.map(|v| weight(v - v.floor()));
    let get = |x: i64, y: i64| {
        let i = y.rem_euclid(edge) * edge + x.rem_euclid(edge);
        texture.level(level)[i as usize].map(|v| v as f32)
    };
    let [a, b, c, d] = [get(x, y), get(x + 1, y), get(x, y + 1), get(x + 1, y + 1)];
    std::array::from_fn(|i| lerp(lerp(a[i], b[i], fx), lerp(c[i], d[i], fx), fy))
}

/// The value of the level nearest to the level of detail.
pub fn sample<const C: usize>(texture: &Texture<C>, uv: [f32; 2], detail: f32) -> [f32; C] {
    let level = detail.round().clamp(0.0, texture.last() as f32);
    bilinear(texture, level as usize, uv)
}

pub fn detail<const C: usize>(texture: &Texture<C>, width: f32, scale: f32) -> f32 {
    (width * scale * texture.size() as f32).max(1e-6).log2()
}

/// Depth, place and width.
pub fn water(water: &Water, pixel: [f32; 2]) -> (f32, [f32; 2], f32) {
    let [slope, up, east, north] =
        [water.slope, water.up, water.east, water.north].map(|row| row.map(|v| v.value as f32));
    let dot = |a: &[f32; 4], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let ray = [pixel[0] * slope[0] + slope[2], pixel[1] * slope[1] + slope[3], -1.0];
    let falls = dot(&up, ray);
    let z = -up[3] / falls;
    let p = ray.map(|r| z * r);
    let place = [dot(&east, p) + east[3], dot(&north, p) + north[3]];
    let change = [[slope[0], 0.0, 0.0], [0.0, slope[1], 0.0]].map(|d| {
        let part = dot(&up, d) / falls;
        let d = [d[0] - part * ray[0], d[1] - part * ray[1], d[2] - part * ray[2]];
        [z * dot(&east, d), z * dot(&north, d)]
    });
    let [[ax, ay], [bx, by]] = change;
    (z, place, (ax * by - ay * bx).abs().sqrt())
}

/// A pixel with exact inputs.
pub struct Pixel {
    pub off: [f32; 2],
    pub place: [f32; 2],
    pub v: f32,
    pub across: [[f32; 2]; 2],
    pub dv: [f32; 2],
}

/// Mixture, variance and change; `by` scales the sine's error.
pub fn shoreline(
    look: &Shoreline,
    noise: &Texture<4>,
    web: &Texture<4>,
    pixel: &Pixel,
    by: f32,
) -> (f32, f32, [f32; 2]) {
    let &Pixel { off, place, v, across, dv } = pixel;
    let v = if v > 0.0 { v + (dv[0] * off[0] + dv[1] * off[1]) } else { v };
    let v = v.clamp(0.0, 2.0);
    let [[ax, ay], [bx, by_]] = across;
    let width = (ax * by_ - bx * ay).abs().sqrt();
    let at = |p: [f32; 2], by: Noise| {
        let scale = by.scale as f32;
        sample(noise, p.map(|p| p * scale), detail(noise, width, scale))
            .map(|n| n * by.amplitude as f32)
    };
    let mut p = place;
    if look.warp.amplitude != 0.0 {
        let n = at(p, look.warp);
        p = [p[0] + n[0], p[1] + n[1]];
    }
    let phase = look.phases.waves.value as f32;
    let ahead = at(p, look.speed_noise)[1] * look.phases.local.value as f32;
    let rise = at(p, look.rise_noise)[2];
    let frequency = look.frequency as f32 + at(p, look.frequency_noise)[0];
    let square = dv[0] * dv[0] + dv[1] * dv[1];
    let kept = (-frequency * frequency * square / 24.0).exp();
    let [a, b] = look.wave_rise.map(|v| v as f32);
    let along = frequency * v + phase + ahead;
    let mut waves = kept * sine(along, by) + a * v + b + rise;
    let mut steep = kept * frequency * sine(along + TAU / 4.0, by) + a;
    if let Some(floor) = look.floor {
        steep = if waves > floor as f32 { steep } else { 0.0 };
        waves = waves.max(floor as f32);
    }
    let mut q = p;
    if look.texture_warp.amplitude != 0.0 {
        let moved = f(look.web_warp_moved);
        let n = at([p[0] + moved[0], p[1] + moved[1]], look.texture_warp);
        q = [q[0] + n[2], q[1] + n[3]];
    }
    let q = [0, 1].map(|i| q[i] + (across[0][i] * off[0] + across[1][i] * off[1]));
    let [a, b] = look.web_rise.map(|v| v as f32);
    let (mut mean, mut fine, mut change) = (a * v + b + rise, 0.0, dv.map(|dv| a * dv));
    for layer in &look.layers {
        let (scale, weight) = (layer.scale as f32, layer.weight as f32);
        let ([c, s], [x, y]) = (f(layer.turn).map(|t| t * scale), f(layer.offset));
        let uv = [c * q[0] - s * q[1] + x, s * q[0] + c * q[1] + y];
        let [m, square, x, y] = sample(web, uv, detail(web, width, scale));
        for (change, way) in change.iter_mut().zip(across) {
            let turned = [c * way[0] - s * way[1], s * way[0] + c * way[1]];
            *change += weight * (x * turned[0] + y * turned[1]);
        }
        mean += weight * m;
        fine += weight * weight * (square - m * m).max(0.0);
    }
    let fade = look.fade as f32;
    let ends = smoothstep(fade, v) * smoothstep(fade, 2.0 - v);
    let [r, s] = [look.wave_weight, look.texture_weight].map(|r| r as f32);
    let dearer = at(p, look.threshold_noise)[3];
    let over = r * waves + s * mean - look.threshold as f32 - dearer - 2.0 * (1.0 - ends);
    let change = [0, 1].map(|i| r * steep * dv[i] + s * change[i]);
    (over, r * r * 0.5 * (1.0 - kept * kept) + s * s * fine, change)
}

pub fn covered(over: f32, variance: f32, change: [f32; 2]) -> f32 {
    let square = change[0] * change[0] + change[1] * change[1] + 12.0 * variance;
    (over / square.sqrt().max(1e-6) + 0.5).clamp(0.0, 1.0)
}

pub fn ramp(t: f32) -> f32 {
    if t < 0.0 { 0.0 } else { (1.0 - t).clamp(0.0, 1.0) }
}

pub fn ease(x: f32) -> f32 {
    x * x / (2.0 * (x * x - x) + 1.0)
}

/// The seed of a texel; `by`: relative error of the fraction of the way.
pub fn seed(heights: &Heights, x: usize, y: usize, by: f32) -> Option<Seed> {
    let (px, py) = (x as isize, y as isize);
    let here = heights.at(px, py) as f32;
    let mut found = None;
    let mut least = f32::INFINITY;
    for [dx, dy] in [[0, -1], [0, 1], [-1, 0], [1, 0]] {
        let there = heights.at(px + dx, py + dy) as f32;
        let part = here / (here - there) * (1.0 + by);
        if (here > 0.0) != (there > 0.0) && part < least {
            least = part;
            let place = [x as f32 + 0.5 + dx as f32 * part, y as f32 + 0.5 + dy as f32 * part];
            found = Some(place.map(|v| (v * 16.0 + 0.5).floor() as i64));
        }
    }
    found
}

/// Distance of a texel's centre from a seed's segment.
pub fn apart(heights: &Heights, x: usize, y: usize, seed: Seed) -> f32 {
    let at = seed.map(|v| v as f32 / 16.0);
    let to = [x as f32 + 0.5 - at[0], y as f32 + 0.5 - at[1]];
    let lasts = [heights.width, heights.height].map(|n| n as f32 - 2.0);
    let [i, j] = [0, 1].map(|k| (at[k] - 0.5).floor().min(lasts[k]));
    let part = [at[0] - 0.5 - i, at[1] - 0.5 - j];
    let h = |dx: isize, dy: isize| heights.at(i as isize + dx, j as isize + dy) as f32;
    let g = [
        lerp(h(1, 0) - h(0, 0), h(1, 1) - h(0, 1), part[1]),
        lerp(h(0, 1) - h(0, 0), h(1, 1) - h(1, 0), part[0]),
    ];
    let length = (g[0] * g[0] + g[1] * g[1]).sqrt();
    if length == 0.0 {
        return (to[0] * to[0] + to[1] * to[1]).sqrt();
    }
    let g = g.map(|v| v / length);
    let off = to[0] * g[0] + to[1] * g[1];
    let past = ((to[0] * g[1] - to[1] * g[0]).abs() - 0.5).max(0.0);
    (off * off + past * past).sqrt()
}
