//! Rounding bounds. u is half an ulp of single precision. A bound is a number of operations times u
//! times the magnitude of the operands.

use glam::{DVec3, DVec4};

use crate::reference::cull::frustum;
use crate::reference::depth::hit;
use crate::reference::sheets::Slack;
use crate::reference::smooth::{Params, Rule, derivatives, first_form, rate};
use crate::reference::thickness::{J, drawn_axis, kernel};
use crate::reference::{EMPTY, Image, Sphere, View};

/// Relative error of one rounded operation of single precision.
pub const U: f64 = 1.0 / (1u64 << 24) as f64;

/// Lower and upper bound of an image.
pub struct Between {
    pub low: Image<f64>,
    pub high: Image<f64>,
}

/// Length of the largest |slope| of the image's rays in x and y, to which a slope's rounding is
/// proportional.
pub fn reach(view: &View) -> f64 {
    let (right, last) = (view.width - 1, view.height - 1);
    let corners = [(0, 0), (right, 0), (0, last), (right, last)];
    let all = corners.map(|(x, y)| view.ray(x, y).truncate().length());
    all.into_iter().fold(0.0, f64::max)
}

/// Error of a centre's eye-space coordinate: the product with the view matrix takes 4 products and
/// 3 sums per axis, 7u of |p| + |t| (world and eye positions bound it).
pub fn eye_space(center: DVec3, view: &View) -> f64 {
    let eye = view.view.inverse().w_axis.truncate().length();
    7.0 * U * 2.0 * (center.length() + eye)
}

/// Error bounds for a sphere's depth and for the ends of its span in pixels. The depth comes from
/// the product with the view matrix and a few additions. The tangents have the slopes
/// `(x z +- r sqrt(x^2 + z^2 - r^2)) / (z^2 - r^2)`: the error of the centre changes a slope by at
/// most that error over z - r, and the operations add 16u of their terms and of the cancelled
/// denominator. The conversion to pixels adds 4u.
pub fn span(sphere: &Sphere, view: &View) -> Slack {
    let (c, r) = (sphere.center, sphere.radius);
    let z = -c.z;
    let from = eye_space(c, view);
    let left = (z * z - r * r).max(f64::MIN_POSITIVE);
    let across = c.x.abs().max(c.y.abs());
    let terms = (across * z.abs() + r * across.hypot(z)) / left;
    let slope = from / (z - r).max(1e-9) + 16.0 * U * terms * (z * z + r * r) / left;
    let step = view.slope_step().abs().min_element();
    let pixels = slope / step + 4.0 * U * (view.extent().max_element() + terms / step);
    Slack { depth: from + 8.0 * U * z.abs(), pixels: pixels.min(1e6) }
}

/// Error bound for the distance between a ray and a sphere's centre. The slope pixel·scale + offset
/// has two rounded operands and two operations: 4u of the image's reach plus its span, times the
/// depth. The terms w·c / w·w and c - w·along take 12 operations: 12u of |c| |w|.
pub fn ray_distance(center: DVec3, view: &View) -> f64 {
    let span = 3.0 * (1.0 + reach(view));
    let slope = 4.0 * span * center.z.abs() + 12.0 * (1.0 + reach(view)) * center.length();
    eye_space(center, view) + U * slope
}

/// Bounds of the depth splats: spheres enlarged and shrunk by the error of the distance to the ray.
/// The root and the difference add 8u of the depth.
pub fn depth(spheres: &[Sphere], view: &View) -> Between {
    depth_where(spheres, view, |_, _, _| (true, true))
}

/// Bounds of the depth splats where `counts` tells whether a sphere certainly counts at a pixel,
/// and whether it possibly does.
pub fn depth_where(
    spheres: &[Sphere],
    view: &View,
    counts: impl Fn(usize, usize, &Sphere) -> (bool, bool),
) -> Between {
    let near = view.near();
    let mut low = Image::new(view.width, view.height, EMPTY);
    let mut high = low.clone();
    for sphere in spheres {
        let d = ray_distance(sphere.center, view) + 4.0 * U * sphere.radius;
        let slack = 8.0 * U * (sphere.center.length() + sphere.radius) + d;
        let larger = Sphere { radius: sphere.radius + d, ..*sphere };
        let smaller = Sphere { radius: (sphere.radius - d).max(0.0), ..*sphere };
        let (center, r) = (sphere.center, sphere.radius + d);
        if -center.z + r < near {
            continue;
        }
        let half = glam::DVec2::splat(r);
        let (columns, rows) = view.footprint(center.truncate(), half, -center.z - r, -center.z + r);
        for y in rows {
            for x in columns.clone() {
                let (surely, maybe) = counts(x, y, sphere);
                if !maybe {
                    continue;
                }
                let ray = view.ray(x, y);
                let Some(nearest) = hit(ray, &larger).map(|t| t - slack) else { continue };
                let farthest = hit(ray, &smaller).map(|t| t + slack);
                // If no hit is certain, the ray may touch the sphere anywhere up to its silhouette.
                let latest =
                    farthest.unwrap_or_else(|| ray.dot(center) / ray.length_squared() + slack);
                if latest >= near * (1.0 - 8.0 * U) {
                    let pixel = low.at_mut(x, y);
                    *pixel = pixel.min(nearest.max(near * (1.0 - 8.0 * U)));
                }
                let certain = surely && nearest >= near * (1.0 + 8.0 * U);
                if let Some(farthest) = farthest.filter(|_| certain) {
                    let pixel = high.at_mut(x, y);
                    *pixel = pixel.min(farthest);
                }
            }
        }
    }
    Between { low, high }
}

/// Rounding error of one smoothing step at a pixel, plus the change of the step if a depth
/// difference close to the falloff is treated differently.
///
/// The new depth is rounded once. Depth differences within a surface are exact (Sterbenz's lemma),
/// except for the last addition of second differences. Each product and sum of the quadratic forms
/// adds u times the absolute values of its operands. The variables with the suffix `_abs` are those
/// sums of absolute values. The quotient's error is the numerator's error over the denominator,
/// plus the quotient times the relative error of the denominator.
fn smoothing_round(
    z: &Image<f64>,
    (x, y): (usize, usize),
    error: f64,
    step: f64,
    view: &View,
    rule: Rule,
    params: &Params,
) -> f64 {
    let here = z.at(x, y);
    let (px, py) = (x as isize, y as isize);
    let d = derivatives(z, px, py, params.depth_falloff);
    let (c_x, c_y) = (view.c_x(), view.c_y());
    let rounded = if rule == Rule::ConstantWidth {
        let (ray, g) = (view.ray(x, y), view.slope_step());
        let (e, f, gg) = first_form(ray, g, here, &d);
        let ww = ray.length_squared();
        let (gx, gy) = ((g.x * here).abs(), (g.y * here).abs());
        let (sx, sy, zx, zy) = (ray.x.abs(), ray.y.abs(), d.x.abs(), d.y.abs());
        let e_abs = ww * zx * zx + gx * (2.0 * sx * zx + gx);
        let g_abs = ww * zy * zy + gy * (2.0 * sy * zy + gy);
        let f_abs = ww * zx * zy + gx * sx * zy + gy * sy * zx;
        let l_abs = d.xx.abs() + 2.0 * zx * zx / here;
        let n_abs = d.yy.abs() + 2.0 * zy * zy / here;
        let m_abs = d.xy.map_or(0.0, |xy| xy.abs() + 2.0 * zx * zy / here);
        let below = e * gg - f * f;
        let below_error = 20.0 * U * (e_abs * g_abs + f_abs * f_abs) / below;
        let above = g_abs * l_abs + 2.0 * f_abs * m_abs + e_abs * n_abs;
        let scale = (c_x * here).powi(2) / below;
        scale * above * (20.0 * U + below_error)
    } else {
        let (c_x2, c_y2) = (c_x * c_x, c_y * c_y);
        let big = c_y2 * d.x * d.x + c_x2 * d.y * d.y + c_x2 * c_y2 * here * here;
        let half = |z_i: f64, z_ii: f64, c2: f64| {
            let inner = c2 * (z_i * z_ii).abs() + c_x2 * c_y2 * (here * z_i).abs();
            z_i.abs() * inner + z_ii.abs() * big
        };
        let above = c_y * half(d.x, d.xx, c_y2) + c_x * half(d.y, d.yy, c_x2);
        32.0 * U * above / (big * big.sqrt())
    };
    // Rounding may decide on which side of the falloff such a difference lies.
    let slack = 2.0 * error + 4.0 * U * here;
    let side =
        |falloff: f64| rate(z, px, py, view, rule, &Params { depth_falloff: falloff, ..*params });
    let near =
        (-1..=1_isize).flat_map(|dy| (-1..=1_isize).map(move |dx| (dx, dy))).any(|(dx, dy)| {
            let away =
                z.checked(px + dx, py + dy).map_or(f64::INFINITY, |there| (there - here).abs());
            (away - params.depth_falloff).abs() <= slack
        });
    let jump = match near {
        true => (side(params.depth_falloff + slack) - side(params.depth_falloff - slack)).abs(),
        false => 0.0,
    };
    U * here + step * (rounded + jump)
}

/// The twin's smoothing, and a bound of its difference from single precision. A stable step is a
/// weighted mean of its stencil, so a pixel's error is at most the largest error of the stencil
/// plus the rounding of the step. `plan`: number of iterations and step size of each pixel.
pub fn smoothing(
    reduced: &Image<f64>,
    plan: &Image<(u32, f64)>,
    view: &View,
    rule: Rule,
    params: &Params,
) -> (Image<f64>, Image<f64>) {
    let last = plan.data.iter().map(|p| p.0).max().unwrap_or(0);
    let mut z = reduced.clone();
    let mut error = reduced.map(|_| 0.0);
    for i in 1..=last {
        let next = Image::from_fn(z.width, z.height, |x, y| {
            let (n, step) = plan.at(x, y);
            if i > n {
                return (z.at(x, y), error.at(x, y));
            }
            let (px, py) = (x as isize, y as isize);
            let spread = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)]
                .map(|(dx, dy)| error.clamped(px + dx, py + dy))
                .into_iter()
                .fold(0.0, f64::max);
            let moved = z.at(x, y) + step * rate(&z, px, py, view, rule, params);
            let local = smoothing_round(&z, (x, y), spread, step, view, rule, params);
            (moved, spread + local)
        });
        z = next.map(|p| p.0);
        error = next.map(|p| p.1);
    }
    (z, error)
}

/// Steps of the fixed-point sums per amplitude of a whole particle.
pub const UNITS: f64 = 16_777_216.0;

/// How the thickness is summed.
#[derive(Clone, Copy, PartialEq)]
pub enum Sum {
    /// In floating point: each addition rounds the sum.
    Float,
    /// In fixed point: each addend is rounded to a multiple of 2^-24 of a whole particle's
    /// amplitude; the sum is converted once.
    Fixed,
    /// Difference of two fixed-point sums.
    FixedRest,
}

impl Sum {
    /// Rounding error of an addend in half units.
    fn halves(self) -> f64 {
        match self {
            Self::Float => 0.0,
            Self::Fixed => 1.0,
            Self::FixedRest => 2.0,
        }
    }
}

/// Input of a thickness image.
pub struct Splats<'a> {
    /// Spheres in eye space.
    pub spheres: &'a [Sphere],
    /// View of the output, whose frustum culls with a margin of two radii.
    pub full: View,
    /// Number of times that the image is halved.
    pub level: u32,
    /// Eye depth of the scene at the image's resolution, with an error of 8u.
    pub scene: Image<f64>,
    /// Volume of a whole particle, and its drawn radius, in world units.
    pub volume: f64,
    pub radius: f64,
    /// How the sums are formed.
    pub sum: Sum,
}

/// Amplitude of a sprite that holds a volume.
fn amplitude(volume: f64, half: f64) -> f64 {
    volume / (std::f64::consts::PI * J * half * half)
}

impl Splats<'_> {
    /// A step of the fixed-point sums.
    pub fn unit(&self) -> f64 {
        amplitude(self.volume, 2.0 * self.radius) / UNITS
    }
}

/// Bounds of the thickness splats. The position of a sprite's centre has the same error as its
/// distance from the ray. Kernel and amplitude add 40u: exp 3 + 2·2 ulp, square root and quotients
/// 2.5 ulp each. Rounding of the sum depends on its [`Sum`].
pub fn thickness(splats: &Splats<'_>) -> Between {
    thickness_where(splats, |_, _, _| (1.0, 1.0))
}

/// Bounds of the thickness splats where each sphere counts with a share at a texel, given as lower
/// and upper bound. A share of zero adds nothing.
pub fn thickness_where(
    splats: &Splats<'_>,
    share: impl Fn(usize, usize, &Sphere) -> (f64, f64),
) -> Between {
    let &Splats { spheres, ref full, level, ref scene, volume, sum, .. } = splats;
    let view = &full.reduced(level);
    let planes = frustum(full);
    let near = view.near();
    let mut low = Image::new(view.width, view.height, 0.0);
    let mut high = low.clone();
    let mut count = Image::new(view.width, view.height, 0_u32);
    let unit = splats.unit();
    for sphere in spheres {
        let (center, d) = (sphere.center.truncate(), -sphere.center.z);
        let whole = 2.0 * sphere.radius;
        let half = drawn_axis(whole, d, view);
        let uncertain = ray_distance(sphere.center, view) + 4.0 * U * half;
        if d < near * (1.0 - 8.0 * U) - uncertain {
            continue;
        }
        // Distance to the inner side of the frustum's planes.
        let inside = |p: &DVec4| p.dot(sphere.center.extend(1.0)) + whole;
        let inside = planes.iter().map(inside).fold(f64::INFINITY, f64::min);
        if inside < -uncertain {
            continue;
        }
        let amplitude = amplitude(volume, half);
        let reach = glam::DVec2::splat(half + uncertain);
        let (columns, rows) = view.footprint(center, reach, d, d);
        for y in rows {
            for x in columns.clone() {
                let (least_share, most_share) = share(x, y, sphere);
                let away = (view.ray(x, y).truncate() * d - center).length();
                if most_share == 0.0 || away > half + uncertain {
                    continue;
                }
                let at = |off: f64| kernel((off / half).powi(2).min(1.0)) * amplitude;
                let slack = 8.0 * U * scene.at(x, y) + uncertain;
                let (least, most) = (at(away + uncertain), at((away - uncertain).max(0.0)));
                let sure = inside > uncertain
                    && d < scene.at(x, y) - slack
                    && d > near * (1.0 + 8.0 * U) + uncertain;
                let rounding = sum.halves() * 0.5 * unit * most_share.max(1.0);
                if sure {
                    let least = least * least_share * (1.0 - 40.0 * U);
                    *low.at_mut(x, y) += (least - rounding).max(0.0);
                }
                if sure || d < scene.at(x, y) + slack {
                    *high.at_mut(x, y) += most * most_share * (1.0 + 40.0 * U) + rounding;
                    *count.at_mut(x, y) += 1;
                }
            }
        }
    }
    for i in 0..low.data.len() {
        let n = if sum == Sum::Float { f64::from(count.data[i]) + 4.0 } else { 4.0 };
        low.data[i] *= 1.0 - n * U;
        high.data[i] *= 1.0 + n * U;
    }
    Between { low, high }
}
