//! Twin of the surface that `composite` shades: the smoothed depth of the reduced image,
//! reconstructed in each pixel of the full image by the rules at the head of
//! glsl/include/surface.glsl. Where water is thinner than 0.9 spacings, its slope blends to that of
//! the unsmoothed depth, limited to 1.5 along an axis; below 0.6 spacings only that remains: a
//! drop.
//!
//! With the ray s = (s_x, s_y, -1) and the depth d(s_x, s_y), P = s d, and P_x x P_y is d times
//! `(d_x, d_y, d + s_x d_x + s_y d_y)`: the normal, which points away from P.

use super::composite::{Inputs, Settings};
use super::noise::Ripple;
use super::{EMPTY, Image, View, is_surface, smoothstep};
use glam::{DVec2, DVec3};

/// Weight of a texel at the rim in the slope, where other texels exist.
const RIM: f64 = 1.0 / 64.0;
/// Max slope of a rim and of a drop: depth per width.
const STEEPEST: f64 = 1.5;

/// The water's surface in a pixel, in eye space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The visible point.
    pub position: DVec3,
    /// The normal, towards the eye.
    pub normal: DVec3,
    /// Thickness along z, at most the distance to the scene.
    pub thickness: f64,
    /// Distance to the scene along z.
    pub room: f64,
    /// Slope in depth per pixel.
    pub slope: DVec2,
    /// Thickness that refracts; at most two spacings where the surface is torn.
    pub lens: f64,
    /// Noise that has tilted the normal.
    pub ripple: Ripple,
    /// Intermediate results of the surface.
    pub parts: Parts,
}

/// Intermediate results of a surface. Slopes are in depth per texel of the smoothed image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    pub case: Case,
    /// Slope of the smoothed depth, and the weighted mean of the absolute differences that the
    /// slope consists of.
    pub smooth: [DVec2; 2],
    /// Slope of the unsmoothed depth, and the mean of the absolute differences.
    pub sphere: [DVec2; 2],
    /// Thickness before it is limited by the scene.
    pub full: f64,
    /// Fraction to which the surface is a drop, by that thickness.
    pub drop: f64,
    /// Whether the thickness comes from texels on other surfaces.
    pub borrowed: bool,
    /// Weight of texels whose neighbours are all on the surface.
    pub found: f64,
    /// Fraction from the back sheet's image, because the front image shows another surface here.
    pub mixed: f64,
    /// Smallest difference to the falloff in any decision; rounding may change decisions within it.
    pub margin: f64,
}

/// Which texels a pixel uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// Four texels on its surface, none at the rim.
    Whole,
    /// Fewer texels on its surface, none at the rim.
    Border,
    /// Some texels at the rim.
    PartRim,
    /// Almost only texels at the rim; the slope is unchanged (`Rim`) or limited (`SteepRim`).
    Rim,
    SteepRim,
    /// No texel on its surface, but one next to the four.
    Beside,
    /// Not even that.
    Alone,
}

/// The smoothed surface in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Smooth {
    pub z: f64,
    /// Slope in depth per texel, and the same mean of the absolute differences.
    pub slope: [DVec2; 2],
    pub case: Case,
    /// Weight of texels on the surface that are not at the rim.
    pub found: f64,
    /// Whether the one texel next to the four is not at the rim.
    pub whole: bool,
}

/// Slope of a texel's own surface.
#[derive(Clone, Copy)]
struct Texel {
    /// Slope in depth per texel, and the same mean of the absolute differences.
    slope: [DVec2; 2],
    /// Whether the texel is not at the rim.
    whole: bool,
    /// See [`Parts`].
    margin: f64,
}

/// The slopes of all texels of an image.
fn texels(z: &Image<f64>, threshold: f64) -> Image<Texel> {
    Image::from_fn(z.width, z.height, |x, y| {
        let all =
            |dx: isize, dy: isize| Some(z.checked(x as isize + dx, y as isize + dy)? - z.at(x, y));
        let near = |by: f64| by.abs() <= threshold;
        // A neighbour is on the surface if its difference is small, or if it continues straight
        // from the opposite neighbour, which is on the surface.
        let both = |dx: isize, dy: isize| {
            let sides = [all(-dx, -dy).map(|r| -r), all(dx, dy)];
            let straight = sides[0].zip(sides[1]).is_some_and(|(a, b)| near(b - a));
            let on = |own: usize| {
                let other = sides[1 - own].is_some_and(near);
                sides[own].filter(|rise| near(*rise) || straight && other)
            };
            ([on(0), on(1)], sides)
        };
        let ((x_axis, x_sides), (y_axis, y_sides)) = (both(1, 0), both(0, 1));
        let turns = [x_sides, y_sides].map(|s| s[0].zip(s[1]).map(|(a, b)| b - a));
        let rises = x_sides.into_iter().chain(y_sides).chain(turns).flatten();
        let margins = rises.map(|rise| (rise.abs() - threshold).abs());
        let axes = [x_axis, y_axis];
        let mean = |sides: [Option<f64>; 2], of: fn(f64) -> f64| {
            let there: Vec<f64> = sides.into_iter().flatten().map(of).collect();
            there.iter().sum::<f64>() / there.len().max(1) as f64
        };
        let slope = |of| DVec2::from(axes.map(|axis| mean(axis, of)));
        Texel {
            slope: [slope(|rise| rise), slope(f64::abs)],
            whole: axes.iter().flatten().all(Option::is_some),
            margin: margins.fold(f64::INFINITY, f64::min),
        }
    })
}

/// The texels under a tent filter at a position in texels, with their weights.
fn tent(width: usize, height: usize, at: DVec2) -> Vec<(usize, usize, f64)> {
    let along = |at: f64, texels: usize| {
        (-1..=texels as isize).filter_map(move |i| {
            let weight = 1.0 - (i as f64 + 0.5 - at).abs();
            (weight > 0.0).then_some((i.clamp(0, texels as isize - 1) as usize, weight))
        })
    };
    along(at.y, height)
        .flat_map(|(y, of_row)| along(at.x, width).map(move |(x, w)| (x, y, w * of_row)))
        .collect()
}

/// The images, prepared for queries per pixel.
pub struct Surfaces<'a> {
    inputs: Inputs<'a>,
    view: &'a View,
    radius: f64,
    /// Depths with a larger difference belong to different surfaces.
    threshold: f64,
    smoothed: Image<Texel>,
    raw: Image<Texel>,
}

impl<'a> Surfaces<'a> {
    pub fn new(inputs: &Inputs<'a>, settings: &Settings, view: &'a View) -> Self {
        let (radius, threshold) = (settings.radius, settings.falloff * settings.radius);
        let (smoothed, raw) = (texels(inputs.smoothed, threshold), texels(inputs.depth, threshold));
        Self { inputs: *inputs, view, radius, threshold, smoothed, raw }
    }

    fn near(&self, a: f64, b: f64, margin: &mut f64) -> bool {
        *margin = margin.min(((a - b).abs() - self.threshold).abs());
        (a - b).abs() <= self.threshold
    }

    /// The texels of the smoothed image around a pixel, with weights that sum to 1.
    fn round(&self, x: usize, y: usize) -> Vec<(usize, usize, f64)> {
        let z = self.inputs.smoothed;
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / f64::from(1 << self.inputs.level);
        tent(z.width, z.height, at)
    }

    /// The texels of the smoothed image that a pixel with this depth uses, with weights that sum to
    /// 1, and the case. If none of the four is on its surface, it is the one next to them that is,
    /// or the nearest in depth. Returns also the weight on the surface before normalization.
    fn seen(
        &self,
        x: usize,
        y: usize,
        depth: f64,
        margin: &mut f64,
    ) -> (Vec<(usize, usize, f64)>, Case, f64) {
        let z = self.inputs.smoothed;
        let all = self.round(x, y);
        let mut own: Vec<_> =
            all.iter().copied().filter(|t| self.near(z.at(t.0, t.1), depth, margin)).collect();
        let sum: f64 = own.iter().map(|t| t.2).sum();
        if !own.is_empty() {
            own.iter_mut().for_each(|t| t.2 /= sum);
            let case = if own.len() == all.len() { Case::Whole } else { Case::Border };
            return (own, case, sum);
        }
        let away = |t: &&(usize, usize, f64)| (z.at(t.0, t.1) - depth).abs();
        if let Some((i, j)) = self.beside(x, y, depth, margin) {
            return (vec![(i, j, 1.0)], Case::Beside, 0.0);
        }
        let nearest = all.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        let (i, j, _) = *nearest.expect("a tent touches a texel");
        (vec![(i, j, 1.0)], Case::Alone, 0.0)
    }

    /// The texels up to half a texel outside the tent filter along one axis, and inside it along
    /// the other. None at full resolution.
    fn next(&self, x: usize, y: usize) -> Vec<(usize, usize)> {
        let (z, level) = (self.inputs.smoothed, self.inputs.level);
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / f64::from(1 << level);
        let about = |at: f64, n: usize| (at as usize).saturating_sub(2)..n.min(at as usize + 3);
        let rows = about(at.y, z.height).filter(|_| level > 0);
        let all = rows.flat_map(|j| about(at.x, z.width).map(move |i| (i, j)));
        all.filter(|(i, j)| {
            let off = (DVec2::new(*i as f64 + 0.5, *j as f64 + 0.5) - at).abs();
            let next = |a: f64, b: f64| a < 1.0 && b > 1.0 && b < 1.5;
            next(off.x, off.y) || next(off.y, off.x)
        })
        .collect()
    }

    /// The texel nearest in depth of those next to a pixel's four that are on its surface.
    fn beside(&self, x: usize, y: usize, depth: f64, margin: &mut f64) -> Option<(usize, usize)> {
        let z = self.inputs.smoothed;
        let mut best: Option<(f64, (usize, usize))> = None;
        for (i, j) in self.next(x, y) {
            let away = (z.at(i, j) - depth).abs();
            if !self.near(z.at(i, j), depth, margin) {
                continue;
            }
            if let Some((least, _)) = best {
                *margin = margin.min((away - least).abs());
            }
            if best.is_none_or(|(least, _)| away < least) {
                best = Some((away, (i, j)));
            }
        }
        best.map(|(_, texel)| texel)
    }

    /// The smoothed surface in a pixel with this depth.
    pub fn smooth(&self, x: usize, y: usize, depth: f64, margin: &mut f64) -> Smooth {
        let (seen, mut case, covered) = self.seen(x, y, depth, margin);
        if case == Case::Alone {
            let slope = [DVec2::ZERO; 2];
            return Smooth { z: depth, slope, case, found: 0.0, whole: false };
        }
        if case == Case::Beside {
            let texel = self.smoothed.at(seen[0].0, seen[0].1);
            *margin = margin.min(texel.margin);
            let mut slope = texel.slope;
            if !texel.whole {
                slope[0] = self.not_steep(slope[0], depth, self.inputs.level);
            }
            return Smooth { z: depth, slope, case, found: 0.0, whole: texel.whole };
        }
        let z: f64 = seen.iter().map(|t| t.2 * self.inputs.smoothed.at(t.0, t.1)).sum();
        let (mut slope, mut trust, mut whole) = ([DVec2::ZERO; 2], 0.0, 0.0);
        for (i, j, weight) in seen {
            let texel = self.smoothed.at(i, j);
            *margin = margin.min(texel.margin);
            let trusted = if texel.whole { weight } else { weight * RIM };
            slope = [0, 1].map(|k| slope[k] + texel.slope[k] * trusted);
            trust += trusted;
            whole += if texel.whole { weight } else { 0.0 };
        }
        let mut slope = slope.map(|s| s / trust);
        if whole < 1.0 - 1e-9 {
            case = Case::PartRim;
        }
        if (whole - 1.0 / 63.0).abs() < 1e-6 {
            *margin = 0.0;
        }
        if whole <= 1.0 / 63.0 {
            let cut = self.not_steep(slope[0], z, self.inputs.level);
            case = if cut == slope[0] { Case::Rim } else { Case::SteepRim };
            slope[0] = cut;
        }
        Smooth { z, slope, case, found: whole * covered, whole: false }
    }

    /// Depth of the nearest texel of the smoothed image around a pixel that is not before `from`,
    /// or else of those next to them.
    pub fn nearest(&self, x: usize, y: usize, from: f64) -> f64 {
        let z = self.inputs.smoothed;
        let least = |texels: &mut dyn Iterator<Item = (usize, usize)>| {
            let depths = texels.map(|(i, j)| z.at(i, j)).filter(|z| *z >= from);
            depths.fold(EMPTY, f64::min)
        };
        let round = least(&mut self.round(x, y).into_iter().map(|t| (t.0, t.1)));
        if is_surface(round) { round } else { least(&mut self.next(x, y).into_iter()) }
    }

    /// Whether one of the four texels around a pixel lies before its surface. At full resolution
    /// these are its own texel and the next ones, whatever their weights.
    pub fn is_covered(&self, x: usize, y: usize, depth: f64, margin: &mut f64) -> bool {
        let z = self.inputs.smoothed;
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / f64::from(1 << self.inputs.level);
        let four = z.bilinear(at).map(|(i, j, _)| z.clamped(i, j));
        let before = depth - four.into_iter().fold(f64::INFINITY, f64::min);
        *margin = margin.min((before - self.threshold).abs());
        before > self.threshold
    }

    /// Limits a slope to a multiple of a texel's width at this depth.
    fn not_steep(&self, slope: DVec2, depth: f64, level: u32) -> DVec2 {
        let wide = DVec2::new(self.view.c_x(), self.view.c_y()) * f64::from(1 << level);
        let most = STEEPEST * depth * wide;
        slope.max(-most).min(most)
    }

    /// The texels of the thickness that a pixel uses, with weights: its own; or those on its
    /// surface in the smoothed image; or those over whose centres its surface lies (if their weight
    /// is at least 1/1000); or all. Of those only the texels with water, if there are any. Returns
    /// also whether they are on other surfaces.
    pub fn texels_of_thickness(
        &self,
        x: usize,
        y: usize,
        surface: f64,
        margin: &mut f64,
    ) -> (Vec<(usize, usize, f64)>, bool) {
        let (texels, borrowed) = self.texels_near(x, y, surface, margin);
        let thickness = self.inputs.thickness;
        let mut wet: Vec<_> =
            texels.iter().copied().filter(|t| thickness.at(t.0, t.1) > 0.0).collect();
        let sum: f64 = wet.iter().map(|t| t.2).sum();
        if wet.is_empty() {
            return (texels, borrowed);
        }
        wet.iter_mut().for_each(|t| t.2 /= sum);
        (wet, borrowed)
    }

    fn texels_near(
        &self,
        x: usize,
        y: usize,
        surface: f64,
        margin: &mut f64,
    ) -> (Vec<(usize, usize, f64)>, bool) {
        let Inputs { thickness, thickness_level, smoothed, level, .. } = self.inputs;
        if thickness_level == 0 {
            return (vec![(x, y, 1.0)], false);
        }
        if thickness_level == level {
            let (seen, case, _) = self.seen(x, y, self.inputs.depth.at(x, y), margin);
            return (seen, case == Case::Alone);
        }
        let size = f64::from(1 << thickness_level);
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / size;
        let mut mean = |own: bool| {
            let mut texels = Vec::new();
            // Tent weights computed directly: a texel centre beyond the edge stays there and is not
            // clamped to the edge.
            for j in -1..=thickness.height as isize {
                for i in -1..=thickness.width as isize {
                    let middle = DVec2::new(i as f64 + 0.5, j as f64 + 0.5);
                    let tent = (1.0 - (middle - at).abs()).max(DVec2::ZERO);
                    let over = middle * size / f64::from(1 << level);
                    let z = smoothed.clamped(over.x.floor() as isize, over.y.floor() as isize);
                    if tent.x * tent.y > 0.0 && (!own || self.near(z, surface, margin)) {
                        let inside = |i: isize, n: usize| i.clamp(0, n as isize - 1) as usize;
                        let (i, j) = (inside(i, thickness.width), inside(j, thickness.height));
                        texels.push((i, j, tent.x * tent.y));
                    }
                }
            }
            let sum: f64 = texels.iter().map(|t| t.2).sum();
            texels.iter_mut().for_each(|t| t.2 /= sum);
            (sum > if own { 1e-3 } else { 0.0 }).then_some(texels)
        };
        match mean(true) {
            Some(own) => (own, false),
            None => (mean(false).expect("a tent touches a texel"), true),
        }
    }

    /// The surface in a pixel, if there is water.
    pub fn at(&self, x: usize, y: usize) -> Option<Surface> {
        let depth = self.inputs.depth.at(x, y);
        if !is_surface(depth) {
            return None;
        }
        let mut margin = self.raw.at(x, y).margin;
        let smooth = self.smooth(x, y, depth, &mut margin);
        let (texels, borrowed) = self.texels_of_thickness(x, y, smooth.z, &mut margin);
        let of = |t: &(usize, usize, f64)| t.2 * self.inputs.thickness.at(t.0, t.1);
        let thickness = texels.iter().map(of).sum();
        let mut surface = self.made_of((x, y), &smooth, thickness, Some(depth), margin);
        surface.parts.borrowed = borrowed;
        Some(surface)
    }

    /// The surface in a pixel from its smoothed surface; a drop if it is thin and has an unsmoothed
    /// depth.
    pub fn made_of(
        &self,
        (x, y): (usize, usize),
        smooth: &Smooth,
        full: f64,
        depth: Option<f64>,
        mut margin: f64,
    ) -> Surface {
        let texel = f64::from(1 << self.inputs.level);
        let spacing = self.radius / 0.656;
        let mut sphere = [DVec2::ZERO; 2];
        let mut drop = 0.0;
        if let Some(depth) = depth {
            sphere = self.raw.at(x, y).slope;
            sphere[0] = self.not_steep(sphere[0], depth, 0);
            sphere = sphere.map(|s| s * texel);
            drop = 1.0 - smoothstep(0.6 * spacing, 0.9 * spacing, full);
        }
        let Smooth { z, slope: smooth, case, found, .. } = *smooth;
        let slope = smooth[0].lerp(sphere[0], drop);
        let ray = self.view.ray(x, y);
        let d = slope / (self.view.slope_step() * texel);
        let normal = DVec3::new(d.x, d.y, z + ray.x * d.x + ray.y * d.y).normalize();
        let room = (self.inputs.scene(x, y) - z).max(0.0);
        let thickness = full.min(room);
        let mut ripple = Ripple::default();
        let mut turned = normal;
        if let (Some(depth), Some(noise)) = (depth, &self.inputs.noise) {
            let raw = self.inputs.depth;
            ripple = noise.at(raw, (x, y), depth, self.threshold, &mut margin);
            let along = |step: DVec3, slope: f64| step * z + ray * slope / texel;
            let step = self.view.slope_step();
            let tangents = [along(DVec3::X * step.x, slope.x), along(DVec3::Y * step.y, slope.y)];
            let wet = if room > 0.0 { smoothstep(0.5, 0.7, thickness / room) } else { 0.0 };
            turned = ripple.turn(1.0 - noise.look.airborne * wet, normal, tangents);
        }
        let parts =
            Parts { case, smooth, sphere, full, drop, borrowed: false, found, mixed: 0.0, margin };
        let torn = thickness.min(2.0 * spacing);
        let lens = torn + (thickness - torn) * found;
        let slope = slope / texel;
        Surface { position: ray * z, normal: turned, thickness, room, slope, lens, ripple, parts }
    }
}
