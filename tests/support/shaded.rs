//! How far `composite` may be off its twin: running error analysis of the shader's operations, pixel
//! by pixel, from the surface and the background that the twin found.

use glam::{DVec2, DVec3};

use super::rounded::{Rounded, cross, dot, exact, mix, normalize, off, smoothstep};
use super::tolerance::U;
use crate::reference::View;
use crate::reference::composite::{Fresnel, Inputs, Medium, Settings, cut_look_up, look_up};
use crate::reference::surface::{Case, Surface};

/// What filtering may do to what is looked up.
#[derive(Clone, Copy)]
pub struct Filter {
    /// Positions in a texel are known to 2^-bits.
    pub bits: u32,
    /// Of the environment: the most that a channel changes per unit of direction.
    pub sky_slope: f64,
    /// And what its texels and the interpolation between them are off.
    pub sky_error: f64,
}

/// A pixel's colour in the shader's order of operations, with its bounds.
pub struct Shaded {
    pub color: [Rounded; 3],
    /// By how many pixels the look-up of the background may be off.
    pub moved: f64,
}

/// The most that a channel of the scene changes from texel to texel round a position, x and y.
fn changes(inputs: &Inputs<'_>, at: DVec2) -> [[f64; 3]; 2] {
    let base = (at - 0.5).floor();
    let (x, y) = (base.x as isize, base.y as isize);
    let texel = |x: isize, y: isize| inputs.scene_color.clamped(x, y);
    let from = |at: [f64; 4], here: [f64; 4]| [0, 1, 2].map(|c| (at[c] - here[c]).abs());
    let mut most = [[0.0_f64; 3]; 2];
    for (i, j) in (-1..3).flat_map(|j| (-1..3).map(move |i| (x + i, y + j))) {
        let here = texel(i, j);
        let there = [from(texel(i + 1, j), here), from(texel(i, j + 1), here)];
        most = [0, 1].map(|axis| [0, 1, 2].map(|c| most[axis][c].max(there[axis][c])));
    }
    most
}

/// The slope per texel of the smoothed image. Rises are differences of two numbers, and their mean
/// one more; the weighted mean of the smoothed one is four products and three sums, the weights are
/// quotients of sums (9u), and so is the mean (5u and the sum below it, 4u).
fn slope(surface: &Surface, axis: usize, drop: Rounded) -> Rounded {
    let parts = &surface.parts;
    let [smooth, rises] = parts.smooth.map(|s| s[axis]);
    let smooth = Rounded { v: smooth, e: U * (15.0 * rises + 9.0 * smooth.abs()) };
    let [sphere, rises] = parts.sphere.map(|s| s[axis]);
    let sphere = Rounded { v: sphere, e: U * (2.0 * rises + 4.0 * sphere.abs()) };
    mix(smooth, sphere, drop)
}

/// The pixel at (x, y), in the order of glsl/composite.frag. `background` and `env` are the twin's.
pub fn shaded(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    (x, y): (usize, usize),
    (background, env): (DVec3, DVec3),
    filter: &Filter,
) -> Shaded {
    let texel = f64::from(1 << inputs.level);
    let radius = off(settings.radius, 2.0);
    let spacing = off(settings.radius / 0.656, 1.0);
    // Weighted means: four products, three sums, weights of 9u.
    let means = if surface.parts.case == Case::Whole { 4.0 } else { 13.0 };
    let z = off(-surface.position.z, means);
    let t = off(surface.thickness, if inputs.thickness_level == 0 { 0.0 } else { 13.0 });
    let (low, high) = (off(0.6, 1.0) * spacing, off(0.9, 1.0) * spacing);
    let drop = exact(1.0) - smoothstep(low, high, t);
    let (dx, dy) = (slope(surface, 0, drop), slope(surface, 1, drop));

    // Scale and offset of the slopes are quotients of rounded numbers.
    let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let step = view.slope_step();
    let (first, ray) = (view.ray_at(DVec2::ZERO), view.ray(x, y));
    let along = |pixel: f64, step: f64, first: f64, slope: f64| {
        let sum = exact(pixel) * off(step, 2.0) + off(first, 2.0);
        Rounded { v: slope, e: sum.e }
    };
    let sx = along(pixel.x, step.x, first.x, ray.x);
    let sy = along(pixel.y, step.y, first.y, ray.y);
    let px = [off(step.x * texel, 2.0) * z + sx * dx, sy * dx, -dx];
    let py = [sx * dy, off(step.y * texel, 2.0) * z + sy * dy, -dy];
    let mut n = normalize(cross(px, py));
    let position = [sx * z, sy * z, -z];
    if dot(n, position).v > 0.0 {
        n = n.map(|c| -c);
    }
    let away = dot(position, position).sqrt();
    let v = position.map(|c| -c / away);
    let path = t * away / z;

    // Where the background is looked up, and what it may be there.
    let scale = |wide: f64| t * exact(settings.refraction) / (off(wide, 2.0) * z);
    let offset = [n[0] * scale(step.x.abs()), n[1] * scale(step.y.abs())];
    let rounding = 8.0 * U * view.extent().max_element();
    let moved = offset[0].e.max(offset[1].e) + rounding;
    let q = look_up(settings, surface, view, pixel);
    let (q, _) = cut_look_up(inputs, -surface.position.z, pixel, q);
    let by = moved + 1.0 / f64::from(1 << filter.bits);
    let changes = changes(inputs, q);
    let behind = [0, 1, 2].map(|i| {
        let e = by * (changes[0][i] + changes[1][i]) + 4.0 * U * background[i].abs();
        Rounded { v: background[i], e }
    });
    let medium = |i: usize| match settings.medium {
        Medium::Physical { absorption, scattering, ambient } => {
            let extinction = exact(absorption[i]) + exact(scattering[i]);
            let kept = (-extinction * path).exp();
            let least = Rounded { v: extinction.v.max(1e-9), e: extinction.e };
            let albedo = exact(scattering[i]) / least;
            behind[i] * kept + exact(ambient[i]) * albedo * (exact(1.0) - kept)
        }
        Medium::Source { base, k } => {
            let tint = exact(base[i]) * (-exact(k[i]) * path).exp();
            mix(tint, behind[i], (-exact(k[3]) * path).exp())
        }
    };

    let w = smoothstep(exact(0.0), exact(0.25) * radius, t);
    let cosine = dot(n, v);
    let twice = exact(2.0) * cosine;
    let reflected = [0, 1, 2].map(|i| twice * n[i] - v[i]);
    // The inverse of the view: 16u of its entries, at most 1.
    let world = view.view.inverse();
    let world = |row: usize| [0, 1, 2].map(|i| Rounded { v: world.col(i)[row], e: 16.0 * U });
    let reflected = [0, 1, 2].map(|row| dot(world(row), reflected));
    let sky = smoothstep(off(-0.3, 1.0), exact(0.0), reflected[1]);
    let grazing = (exact(1.0) - cosine).clamp(0.0, 1.0);
    let fresnel = match settings.fresnel {
        Fresnel::Schlick { f0 } => {
            let square = grazing * grazing;
            exact(f0) + off(1.0 - f0, 1.0) * square * square * grazing
        }
        Fresnel::Source { bias, scale, power } => {
            (exact(bias) + exact(scale) * grazing.pow(exact(power))).clamp(0.0, 1.0)
        }
    };
    let turned = reflected.iter().map(|c| c.e).fold(0.0, f64::max);
    let share = w * sky * fresnel;

    let sun = settings.sun_direction.to_array().map(|v| Rounded { v, e: 16.0 * U });
    let half = normalize([0, 1, 2].map(|i| v[i] + sun[i]));
    let facing = dot(n, half);
    // The shader cuts at 2^-100.
    let shine = facing.pow(exact(settings.shininess)) + Rounded { v: 0.0, e: 0.5_f64.powi(100) };
    let color = [0, 1, 2].map(|i| {
        let seen = filter.sky_slope * turned + filter.sky_error + 4.0 * U * env[i];
        let c = mix(medium(i), Rounded { v: env[i], e: seen }, share);
        c + w * exact(settings.specular[i]) * shine * exact(settings.sun_color[i])
    });
    Shaded { color, moved }
}
