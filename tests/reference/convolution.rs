//! Twin of pass `convolution`: the Fourier basis of a shadow map, and its reconstruction (Annen et
//! al. 2007, with the differences that the pass's header lists).

use std::f64::consts::PI;
use std::sync::OnceLock;

use glam::{DMat4, DVec3};

use super::Image;
use crate::support::rounded::{Rounded, exact, off};
use crate::support::tolerance::U;

/// Error that Vulkan permits for sine and cosine.
const WAVE: f64 = 1.0 / 2048.0;

/// How the basis is computed and evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Filter {
    pub terms: usize,
    pub texels: usize,
    pub bits: usize,
    pub width: f64,
    pub damping: f64,
    pub offset: f64,
    pub scale: f64,
}

/// A host's shadow map, only the part that is used.
pub struct Convolved<'a> {
    pub depth: &'a Image<f32>,
    pub view_projection: DMat4,
    pub bias: f64,
    /// Direction to the sun.
    pub sun: DVec3,
    pub reversed: bool,
    pub filter: Filter,
    /// Ramp and span, computed once.
    pub found: OnceLock<(f64, Option<[Rounded; 2]>)>,
}

/// The basis as read back, all pages side by side.
pub type Pages = Image<[f32; 4]>;

impl Filter {
    fn c(k: usize) -> f64 {
        (2 * k - 1) as f64 * PI
    }

    /// Weight of term k, counted from 1.
    fn weight(&self, k: usize) -> f64 {
        let part = (k as f64 - 0.5) / self.terms as f64;
        2.0 / Self::c(k) * (-self.damping * part * part).exp()
    }

    /// The step function at a distance t from the contact.
    pub fn step(&self, t: f64) -> f64 {
        let sum: f64 = (1..=self.terms).map(|k| self.weight(k) * (Self::c(k) * t).sin()).sum();
        0.5 + self.scale * sum
    }

    /// Where the step first reaches 1, or its first max, within the range that the pass searches.
    fn ramp(&self) -> f64 {
        let most = 0.85 / self.terms as f64;
        let at = |i: usize| self.step(most * i as f64 / 256.0);
        let first = (1..=256).find(|i| at(*i) >= 1.0 || at(*i) < at(i - 1));
        most * first.unwrap_or(256) as f64 / 256.0
    }
}

impl Convolved<'_> {
    fn open(&self, depth: f32) -> bool {
        if self.reversed { depth <= 0.0 } else { depth >= 1.0 }
    }

    /// Linear distance along the light, for a device depth with an error.
    fn along(&self, z: Rounded) -> Rounded {
        let rows = self.view_projection.transpose();
        let (depth, w) = (rows.z_axis, rows.w_axis);
        if w.truncate().length() == 0.0 {
            return if self.reversed { -z } else { z };
        }
        // The plane with that depth, by its distance from the light.
        let from = depth.truncate().dot(w.truncate()) / w.truncate().length_squared();
        let by = depth.w - from * w.w;
        let by = Rounded { v: by, e: 12.0 * U * (depth.w.abs() + (from * w.w).abs()) };
        by / (z - off(from, 12.0))
    }

    /// Distance from the contact at which the step is complete.
    pub fn ramp(&self) -> f64 {
        self.found.get_or_init(|| (self.filter.ramp(), self.find_span())).0
    }

    /// Nearest and farthest depth in the map.
    fn span(&self) -> Option<[Rounded; 2]> {
        self.found.get_or_init(|| (self.filter.ramp(), self.find_span())).1
    }

    fn find_span(&self) -> Option<[Rounded; 2]> {
        let there = self.depth.data.iter().filter(|d| !self.open(**d));
        let even = there.map(|d| self.along(exact(f64::from(*d))));
        even.fold(None, |span: Option<[Rounded; 2]>, v| {
            let Some([a, b]) = span else { return Some([v, v]) };
            Some([if v.v < a.v { v } else { a }, if v.v > b.v { v } else { b }])
        })
    }

    /// Position of a linear depth in the span.
    fn place(&self, [near, far]: [Rounded; 2], even: Rounded) -> Rounded {
        let least = 1e-5 * near.v.abs().max(far.v.abs()) + 1e-30;
        let length = far - near;
        let length = if length.v < least { off(least, 8.0) } else { length };
        (even - near) / length * off(1.0 - 4.0 * self.ramp(), 64.0)
    }

    /// Distance of a texel's depth behind another depth, in units of the span.
    pub fn behind(&self, texel: f32, z: f64) -> f64 {
        let (Some(span), false) = (self.span(), self.open(texel)) else { return 1.0 };
        let place = |z: f64| self.place(span, self.along(exact(z))).v;
        place(f64::from(texel)) - place(z)
    }

    /// Width in texels of the map that a texel of the basis covers, and the size of the basis.
    pub fn size(&self) -> (usize, [usize; 2]) {
        let [w, h] = [self.depth.width, self.depth.height];
        let edge = w.max(h).div_ceil(self.filter.texels);
        (edge, [w.div_ceil(edge), h.div_ceil(edge)])
    }

    /// Half of the filter's width, in texels of the basis.
    fn reach(&self) -> f64 {
        (0.5 * self.filter.width / self.size().0 as f64).max(0.5)
    }

    fn boxed(&self, image: &Image<[f64; 2]>, step: [isize; 2]) -> Image<[f64; 2]> {
        let reach = self.reach();
        let most = reach.ceil() as isize;
        Image::from_fn(image.width, image.height, |x, y| {
            let mut sum = [0.0; 2];
            for i in -most..=most {
                // Fraction of the texel inside the box.
                let weight = (reach + 0.5 - (i as f64).abs()).clamp(0.0, 1.0) / (2.0 * reach);
                let at = image.clamped(x as isize + i * step[0], y as isize + i * step[1]);
                sum = [sum[0] + weight * at[0], sum[1] + weight * at[1]];
            }
            sum
        })
    }

    /// Cosine and sine of term k, filtered.
    pub fn basis(&self, k: usize) -> Image<[f64; 2]> {
        let (edge, [width, height]) = self.size();
        let (ramp, span) = (self.ramp(), self.span());
        let blocks = Image::from_fn(width, height, |x, y| {
            let (mut sum, mut count) = ([0.0; 2], 0.0);
            for j in y * edge..(y * edge + edge).min(self.depth.height) {
                for i in x * edge..(x * edge + edge).min(self.depth.width) {
                    let depth = self.depth.at(i, j);
                    let place = match span {
                        Some(span) if !self.open(depth) => {
                            self.place(span, self.along(exact(f64::from(depth)))).v
                        }
                        _ => 1.0 - 2.0 * ramp,
                    };
                    let (sin, cos) = (Filter::c(k) * place).sin_cos();
                    sum = [sum[0] + cos, sum[1] + sin];
                    count += 1.0;
                }
            }
            sum.map(|v| v / count)
        });
        self.boxed(&self.boxed(&blocks, [1, 0]), [0, 1])
    }

    /// Error of a number of the basis.
    pub fn basis_error(&self, k: usize) -> f64 {
        // The error of a texel's position is multiplied by c_k; then half an ulp of the number of
        // turns, and one of the angle.
        let there = self.depth.data.iter().filter(|d| !self.open(**d));
        let places = self.span().into_iter().flat_map(|span| {
            there.clone().map(move |d| self.place(span, self.along(exact(f64::from(*d)))).e)
        });
        let place = places.fold(64.0 * U, f64::max);
        let turned = Filter::c(k) * place + 8.0 * U * Filter::c(k);
        // Pages are stored in half precision twice, which may truncate; then the sums.
        let (edge, taps) = (self.size().0 as f64, 2.0 * self.reach() + 3.0);
        let sums = U * (edge * edge + 2.0 * taps + 8.0);
        let stored = match self.filter.bits {
            8 => 0.5 / 127.0,
            _ => 1.0 / 2048.0,
        };
        WAVE + turned + 2.0 / 2048.0 + sums + stored
    }

    /// First texel of a page.
    pub fn corner(&self, page: usize) -> [usize; 2] {
        [page / 2, page % 2].map(|i| i * (self.filter.texels + 2) + 1)
    }

    /// Fraction of sunlight at a point with this error in scene units, from the basis as read back.
    /// A filter keeps `bits` bits of the position between texels.
    pub fn past(&self, pages: &Pages, p: DVec3, by: f64, bits: u32) -> Rounded {
        let Some(place) = self.seen(p, by) else { return exact(1.0) };
        let Some(span) = self.span() else { return exact(1.0) };
        let (at, z, unsure) = place;
        let filter = &self.filter;
        let (edge, size) = self.size();
        let ramp = self.ramp();
        let d = self.place(span, self.along(z)) - off(filter.offset * ramp, 64.0);
        let d = d.clamp(-ramp, 1.0 - 3.0 * ramp);
        let texels = [self.depth.width, self.depth.height];
        let at = [0, 1].map(|i| {
            let n = size[i] as f64;
            let at = at[i] * exact(texels[i] as f64) / exact(edge as f64);
            at.clamp(0.5, n - 0.5) - exact(0.5)
        });
        let rebuilt = |x: usize, y: usize| {
            let mut sum = exact(0.5);
            for k in 1..=filter.terms {
                let [left, top] = self.corner((k - 1) / 2);
                let v = pages.at(left + x, top + y);
                let i = 2 * ((k - 1) % 2);
                let (sin, cos) = (Filter::c(k) * d.v).sin_cos();
                let off = WAVE + Filter::c(k) * (d.e + 8.0 * U);
                let [c, s] = [v[i], v[i + 1]].map(|v| exact(f64::from(v)));
                let [sin, cos] = [sin, cos].map(|v| Rounded { v, e: off });
                let weight = self::off(filter.scale * filter.weight(k), 32.0);
                sum = sum + weight * (s * cos - c * sin);
            }
            sum
        };
        let base = at.map(|v| v.v.floor() as isize);
        let (mut sum, mut low, mut high) = (exact(0.0), f64::INFINITY, f64::NEG_INFINITY);
        for (i, j) in (-1..3).flat_map(|j| (-1..3).map(move |i| (i, j))) {
            let texel = [base[0] + i, base[1] + j];
            let [x, y] = [0, 1].map(|a| texel[a].clamp(0, size[a] as isize - 1) as usize);
            let v = rebuilt(x, y);
            (low, high) = (low.min(v.v), high.max(v.v));
            let hat = |a: usize| (1.0 - (at[a].v - texel[a] as f64).abs()).max(0.0);
            if hat(0) * hat(1) > 0.0 {
                sum = sum + off(hat(0) * hat(1), 4.0) * v;
            }
        }
        let moved = at[0].e + at[1].e + 2.0 * f64::powi(2.0, -(bits as i32));
        // Error of the position in the whole image, which is a few hundred texels wide.
        let moved = moved + 4.0 * U * pages.width.max(pages.height) as f64;
        let lit = Rounded { v: sum.v, e: sum.e + moved * (high - low) }.clamp(0.0, 1.0);
        if unsure { Rounded { v: lit.v, e: lit.e + 1.0 - lit.v } } else { lit }
    }

    /// Position in the map, 0 to 1, and depth of a point, and whether it may be outside. None if it
    /// is outside.
    pub fn seen(&self, p: DVec3, by: f64) -> Option<([Rounded; 2], Rounded, bool)> {
        let p = p + self.bias * self.sun.normalize();
        let rows = self.view_projection.transpose();
        let clip = self.view_projection * p.extend(1.0);
        // Four products and sums per row, and two roundings of the point.
        let row = |v: f64, row: glam::DVec4| {
            let length = row.truncate().length();
            let e = length * (by + 2.0 * U * p.length())
                + 4.0 * U * (length * p.length() + row.w.abs());
            Rounded { v, e }
        };
        let w = row(clip.w, rows.w_axis);
        if clip.w <= -w.e {
            return None;
        }
        let ndc = |v, r| row(v, r) / w;
        let uv = [ndc(clip.x, rows.x_axis), ndc(clip.y, rows.y_axis)];
        let uv = uv.map(|v| exact(0.5) + exact(0.5) * v);
        let z = ndc(clip.z, rows.z_axis);
        let inside = |sign: f64| {
            [uv[0], uv[1], z].iter().all(|v| v.v >= -sign * v.e && v.v <= 1.0 + sign * v.e)
        };
        inside(1.0).then_some((uv, z, !(inside(-1.0) && clip.w > w.e)))
    }
}
