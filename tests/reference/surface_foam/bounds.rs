//! Bounds of the foam images in single precision.

use super::super::thickness::kernel;
use super::super::{EMPTY, Image, View, is_surface};
use super::loose::{LooseEllipse, LooseHit};
use super::noise::{noise, noise_reach, noise_rounding, noise_slope};
use super::off::{Off, ray_off};
use super::texels::{in_full, pixels, scene_depth};
use super::{AXIS, CELLS, Settings, Sprite, depth_part};
use crate::support::rounded::{Rounded, exact};
use crate::support::tolerance::{Between, U};

/// Sprites that may be drawn, with their amount of foam and whether they are certainly drawn: the
/// near plane errs by 8u.
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

/// Min and max of `of` over the ellipses that rounding may make of a sprite, and whether all of
/// them cover the pixel.
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

/// Bounds of [`depth`] in single precision: `low` is the nearest that any sprite may be, `high` the
/// nearest of those that certainly are there.
pub fn depth_bounds(
    sprites: &[Sprite],
    view: &View,
    level: u32,
    settings: &Settings,
    scene: &Image<f64>,
) -> Between {
    let (full, view, near) = (view, &view.reduced(level), view.near());
    let mut low = Image::new(view.width, view.height, EMPTY);
    let mut high = low.clone();
    for (sprite, foam, drawn) in maybe_drawn(sprites, full) {
        let ellipses = LooseEllipse::all(sprite, full, settings, AXIS);
        let deep = |ellipse: LooseEllipse| {
            let (thick, _) = ellipse.wide(view, settings);
            let part = exact(depth_part(foam));
            LooseEllipse { a: thick.a * part, b: thick.b * part, ..thick }
        };
        let ellipses: Vec<_> = ellipses.into_iter().map(deep).collect();
        let reach = ellipses.iter().map(LooseEllipse::reach).fold(0.0, f64::max);
        for (x, y) in pixels(view, sprite.center, reach) {
            let (ray, scene) = (ray_off(view, x, y), scene_depth(in_full(scene, x, y, level)));
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

/// Bounds in single precision, with sums in any order, of four parts of [`thickness`]: all foam,
/// the front layer, its sunlit part, and all foam weighted by its distance behind the frontmost.
/// Contributions that rounding may drop, at the ellipse's rim, at the scene or at the foam's depth,
/// are only in `high`. `foam_depth`: from [`depth_bounds`], or the image itself for both bounds if
/// it is known.
pub fn thickness_bounds(
    sprites: &[Sprite],
    view: &View,
    level: u32,
    settings: &Settings,
    scene: &Image<f64>,
    foam_depth: &Between,
) -> [Between; 4] {
    let (full, view, near) = (view, &view.reduced(level), view.near());
    let mut low = Image::new(view.width, view.height, [0.0; 4]);
    let mut high = low.clone();
    let mut count = Image::new(view.width, view.height, 0.0);
    for (sprite, foam, drawn) in maybe_drawn(sprites, full) {
        let [darkest, brightest] = [sprite.sun[0] * (1.0 - U), sprite.sun[1] * (1.0 + U)];
        let ellipses = LooseEllipse::all(sprite, full, settings, AXIS);
        let ellipses: Vec<_> = ellipses.into_iter().map(|e| e.wide(view, settings)).collect();
        let reach = ellipses.iter().map(|(e, _)| e.reach()).fold(0.0, f64::max);
        for (x, y) in pixels(view, sprite.center, reach) {
            let (ray, scene) = (ray_off(view, x, y), scene_depth(in_full(scene, x, y, level)));
            let nearest = foam_depth.low.at(x, y);
            let farthest = foam_depth.high.at(x, y);
            let found = span(&ellipses, |(ellipse, strength)| {
                let hit = ellipse.meet(ray, near, scene)?;
                let bounds =
                    value_bounds((sprite, view), (ellipse, *strength), &hit, foam, settings);
                // The scene's depth is computed from the projection, 8u; difference, product and
                // quotient add 4u.
                let sunk = |sign: f64| {
                    if scene.is_infinite() {
                        return 1.0;
                    }
                    let there = scene * (1.0 + sign * 8.0 * U) - (hit.k.v - sign * hit.k.e);
                    settings.sunk(there) * (1.0 + sign * 4.0 * U)
                };
                let (least, most) = (bounds.0 * sunk(-1.0), bounds.1 * sunk(1.0));
                // The layer's end is rounded by 2u, the ramp by 16u; its slope is 1.5 per spacing.
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
                // The differences round by 4u of their operands; sum, quotient and product by 5u.
                let far = |sign: f64, there: f64| {
                    let off = hit.k.e + 4.0 * U * (hit.k.v.abs() + there + settings.spacing);
                    let behind = if is_surface(there) { hit.k.v - there + sign * off } else { 0.0 };
                    settings.far(behind) * (1.0 + sign * 5.0 * U)
                };
                let far = [far(-1.0, farthest) * least, far(1.0, nearest) * most];
                let least = [least, front[0], lit[0], far[0]];
                let most = [most, front[1], lit[1], far[1]];
                Some((least, most, hit.sure))
            });
            let Some((least, most, sure)) = found else { continue };
            for i in 0..4 {
                let least = if sure && drawn { least[i] } else { 0.0 };
                low.at_mut(x, y)[i] += settings.in_steps(least, -1.0);
                high.at_mut(x, y)[i] += settings.in_steps(most[i], 1.0);
            }
            *count.at_mut(x, y) += 1.0;
        }
    }
    [0, 1, 2, 3].map(|i| {
        let sum = |sums: &Image<[f64; 4]>, sign: f64| Image {
            width: sums.width,
            height: sums.height,
            data: (sums.data.iter().zip(&count.data))
                .map(|(sum, n)| sum[i] * (1.0 + sign * n * U))
                .collect(),
        };
        Between { low: sum(&low, -1.0), high: sum(&high, 1.0) }
    })
}

/// Min and max contribution of a sprite where a ray meets it. The kernel decreases from the centre.
/// The root's argument is rounded once, u/2, the root errs by 9u, the exponential by 7 ulp, and
/// three products by 3u.
fn value_bounds(
    (sprite, view): (&Sprite, &View),
    (ellipse, strength): (&LooseEllipse, Rounded),
    hit: &LooseHit,
    foam: f64,
    settings: &Settings,
) -> (f64, f64) {
    let amplitude = ellipse.amplitude(foam, settings);
    let rho_squared = hit.rho_squared;
    let least = kernel((rho_squared.v + rho_squared.e).min(1.0));
    let most = kernel((rho_squared.v - rho_squared.e).max(0.0));
    let rounding = U * (0.5 + 9.0 + 14.0 + 3.0);
    if let Some(pattern) = &settings.pattern {
        let texel = ellipse.texel(view);
        let more = pattern.logarithm(sprite, view, (ellipse, texel), hit, settings).exp();
        let low = (amplitude.v - amplitude.e) * least * (more.v - more.e);
        let high = (amplitude.v + amplitude.e) * most * (more.v + more.e);
        return (low.max(0.0) * (1.0 - rounding), high * (1.0 + rounding));
    }
    let place = sprite.place(hit.x.v, hit.y.v, settings);
    // Roundings of the position: one sum per axis, and the product with the age.
    let sums = place.abs().element_sum() + (sprite.age * settings.noise_rate).abs();
    let moved = CELLS * (hit.x.e + hit.y.e) + U * sums;
    let (here, error) = (noise(place), noise_slope() * moved + noise_rounding());
    let torn = |noise: f64, sign: f64| {
        let noise = noise.clamp(-noise_reach(), noise_reach());
        let part = strength.v * noise;
        let rounding = strength.e * noise.abs() + U * (part.abs() + (1.0 + part).abs());
        (1.0 + part + sign * rounding).max(0.0)
    };
    let low = (amplitude.v - amplitude.e) * least * torn(here - error, -1.0);
    let high = (amplitude.v + amplitude.e) * most * torn(here + error, 1.0);
    (low.max(0.0) * (1.0 - rounding), high * (1.0 + rounding))
}
