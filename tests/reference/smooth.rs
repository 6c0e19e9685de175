//! Twin of the adaptive curvature flow (thesis Sec. 3.1, 4.7) on the positive eye depth z of the
//! reduced image.
//!
//! `Source`, `Fixed`: the thesis' form, without z_xy and without the ray's slope:
//! ```text
//! D   = C_y^2 z_x^2 + C_x^2 z_y^2 + C_x^2 C_y^2 z^2        2H = (C_y E_x + C_x E_y) / D^(3/2)
//! E_x = z_x D_x / 2 - z_xx D                               E_y = z_y D_y / 2 - z_yy D
//! z <- z - eps 2H
//! ```
//! `ConstantWidth`: mean curvature flow of the surface P = w z, with the ray w = (s_x, s_y, -1) and
//! g the slope's signed change per pixel, from its two fundamental forms:
//! ```text
//! P_x = (g_x z, 0, 0) + w z_x      E = P_x.P_x    L = z_xx - 2 z_x^2 / z      (times the normal's
//! P_y = (0, g_y z, 0) + w z_y      F = P_x.P_y    M = z_xy - 2 z_x z_y / z     own factor, which
//!                                  G = P_y.P_y    N = z_yy - 2 z_y^2 / z       cancels)
//! z <- z + kappa (C_x z)^2 (G L - 2 F M + E N) / (E G - F^2)
//! ```
//! A plane has L = M = N = 0 at any slant, because 1 / z is linear in pixels.

use super::{Image, View, is_surface};
use glam::{DVec2, DVec3};

/// How a pixel's number of iterations and step are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// As in the thesis: `N = floor(4.8 r / (C_x d)) + 1` steps of 2H.
    Source,
    /// Mean curvature flow to the standard deviation `sigma_w` along the surface.
    ConstantWidth,
    /// The source's step, with this number of iterations for every pixel.
    Fixed(u32),
}

/// Lengths of the smoothing in world units, and the max number of iterations.
#[derive(Clone, Copy, Debug)]
pub struct Params {
    /// r, the drawn radius.
    pub radius: f64,
    /// Wanted standard deviation along the surface.
    pub sigma_w: f64,
    /// Derivatives are not taken across larger differences of depth.
    pub depth_falloff: f64,
    /// Max number of iterations.
    pub cap: u32,
}

impl Params {
    /// The defaults for this drawn radius.
    pub fn new(radius: f64) -> Self {
        Self { radius, sigma_w: 1.5 * radius, depth_falloff: 5.3 * radius, cap: 256 }
    }
}

/// Additional iterations beyond the limit of stability, at which a checkerboard would not decay.
pub const MORE: f64 = 2.0;

/// N and the step of each pixel, from the depth before the smoothing: kappa in square pixels for
/// `ConstantWidth`, otherwise eps as a length. The cap limits N and does not change the step: kappa
/// stays below 1 / (2 (2 + s^2)), where z_xx and z_yy of a surface that faces the eye have the
/// factors 1 + s_x^2 and (1 + s_y^2) (C_x / C_y)^2. An empty pixel has N = 0.
pub fn plan(
    reduced: &Image<f64>,
    view_reduced: &View,
    rule: Rule,
    params: &Params,
) -> Image<(u32, f64)> {
    let (r, c_x) = (params.radius, view_reduced.c_x());
    Image::from_fn(reduced.width, reduced.height, |x, y| {
        let d = reduced.at(x, y);
        if !is_surface(d) {
            return (0, 0.0);
        }
        let source_step = (0.053 * r).min(c_x * d / 4.0);
        let (n, step) = match rule {
            Rule::Source => ((4.8 * r / (c_x * d)).floor() + 1.0, source_step),
            Rule::Fixed(n) => (f64::from(n), source_step),
            Rule::ConstantWidth => {
                let sigma_px = params.sigma_w / (c_x * d);
                let s = view_reduced.ray(x, y).truncate();
                let shape = c_x / view_reduced.c_y();
                let spread = 1.0 + s.x * s.x + (1.0 + s.y * s.y) * shape * shape;
                let least = (spread * sigma_px * sigma_px).ceil();
                let n = if sigma_px > 0.0 { least + MORE } else { 0.0 };
                (n, sigma_px * sigma_px / (2.0 * n.max(1.0)))
            }
        };
        (n.min(f64::from(params.cap)) as u32, step)
    })
}

/// Runs the flow: iteration i = 1, 2, .. changes all pixels with i <= N at the same time.
pub fn run(
    depth: &Image<f64>,
    plan: &Image<(u32, f64)>,
    view_reduced: &View,
    rule: Rule,
    params: &Params,
) -> Image<f64> {
    let extent = (view_reduced.width, view_reduced.height);
    assert_eq!((depth.width, depth.height), extent, "extents");
    assert_eq!((plan.width, plan.height), extent, "extents");
    let last = plan.data.iter().map(|(n, _)| *n).max().unwrap_or(0);
    let mut z = depth.clone();
    for i in 1..=last {
        z = Image::from_fn(z.width, z.height, |x, y| {
            let (n, step) = plan.at(x, y);
            let here = z.at(x, y);
            if i <= n {
                here + step * rate(&z, x as isize, y as isize, view_reduced, rule, params)
            } else {
                here
            }
        });
    }
    z
}

/// Derivatives of the depth at a pixel; 0 across a cut.
#[derive(Clone, Copy, Debug, Default)]
pub struct Derivatives {
    /// First derivative along x.
    pub x: f64,
    /// First derivative along y.
    pub y: f64,
    /// Second derivative along x.
    pub xx: f64,
    /// Second derivative along y.
    pub yy: f64,
    /// Mixed derivative; None if an axis or a corner is cut.
    pub xy: Option<f64>,
}

/// Central differences. An axis is cut if one of its two differences exceeds the falloff or lies
/// outside the image; the mixed derivative is cut if an axis or a corner is.
pub fn derivatives(z: &Image<f64>, x: isize, y: isize, falloff: f64) -> Derivatives {
    let here = z.clamped(x, y);
    let at = |dx, dy| z.checked(x + dx, y + dy).filter(|there| (there - here).abs() <= falloff);
    let axis = |dx: isize, dy: isize| {
        let (a, b) = (at(-dx, -dy)?, at(dx, dy)?);
        Some(((b - a) / 2.0, a - 2.0 * here + b))
    };
    let mixed = || Some((at(1, 1)? - at(1, -1)? - at(-1, 1)? + at(-1, -1)?) / 4.0);
    let (along_x, along_y) = (axis(1, 0), axis(0, 1));
    let both = along_x.is_some() && along_y.is_some();
    let xy = if both { mixed() } else { None };
    let ((x, xx), (y, yy)) = (along_x.unwrap_or_default(), along_y.unwrap_or_default());
    Derivatives { x, y, xx, yy, xy }
}

/// E, F, G of the surface `w z`.
pub fn first_form(ray: DVec3, g: DVec2, z: f64, d: &Derivatives) -> (f64, f64, f64) {
    let p_x = DVec3::new(g.x * z, 0.0, 0.0) + ray * d.x;
    let p_y = DVec3::new(0.0, g.y * z, 0.0) + ray * d.y;
    (p_x.length_squared(), p_x.dot(p_y), p_y.length_squared())
}

/// Change of a pixel's depth per unit step.
pub fn rate(
    image: &Image<f64>,
    x: isize,
    y: isize,
    view: &View,
    rule: Rule,
    params: &Params,
) -> f64 {
    let z = image.clamped(x, y);
    let d = derivatives(image, x, y, params.depth_falloff);
    let (c_x, c_y) = (view.c_x(), view.c_y());
    if rule == Rule::ConstantWidth {
        let ray = view.ray(x as usize, y as usize);
        let (e, f, g) = first_form(ray, view.slope_step(), z, &d);
        let l = d.xx - 2.0 * d.x * d.x / z;
        // Without z_xy the whole of M is dropped, because one of its terms alone would bend a
        // plane.
        let m = d.xy.map_or(0.0, |xy| xy - 2.0 * d.x * d.y / z);
        let n = d.yy - 2.0 * d.y * d.y / z;
        return (c_x * z).powi(2) * (g * l - 2.0 * f * m + e * n) / (e * g - f * f);
    }
    let (c_x2, c_y2) = (c_x * c_x, c_y * c_y);
    let big = c_y2 * d.x * d.x + c_x2 * d.y * d.y + c_x2 * c_y2 * z * z;
    let half_x = c_y2 * d.x * d.xx + c_x2 * c_y2 * z * d.x;
    let half_y = c_x2 * d.y * d.yy + c_x2 * c_y2 * z * d.y;
    let e_x = d.x * half_x - d.xx * big;
    let e_y = d.y * half_y - d.yy * big;
    -(c_y * e_x + c_x * e_y) / (big * big.sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::EMPTY;
    use super::super::tests::view;
    use super::*;
    use glam::{DVec2, DVec3};
    use std::f64::consts::PI;

    /// Depth of the plane through (0, 0, -d), tilted by `tilt` towards the direction `towards` in
    /// the image.
    fn plane(view: &View, d: f64, tilt: f64, towards: f64) -> Image<f64> {
        Image::from_fn(view.width, view.height, |x, y| {
            let s = view.ray(x, y).truncate().dot(DVec2::from_angle(towards));
            d / (1.0 - tilt.tan() * s)
        })
    }

    fn smoothed(depth: &Image<f64>, view: &View, rule: Rule) -> Image<f64> {
        let params = Params { cap: 100_000, ..Params::new(1.0) };
        run(depth, &plan(depth, view, rule, &params), view, rule, &params)
    }

    #[test]
    fn the_plan_is_the_closed_form() {
        let view = view(DVec2::new(1.5, -1.5), DVec2::ZERO, 96, 96);
        let params = Params::new(0.3);
        for d in [2.0, 9.0, 60.0] {
            let depth = Image::new(96, 96, d);
            let (n, kappa) = plan(&depth, &view, Rule::ConstantWidth, &params).at(1, 1);
            let s = view.ray(1, 1).truncate().length_squared();
            let whole = Params { cap: u32::MAX, ..params };
            let (uncapped, _) = plan(&depth, &view, Rule::ConstantWidth, &whole).at(1, 1);
            let sigma = 0.45 / (d * 2.0 / (96.0 * 1.5));
            assert_eq!(
                (n, uncapped),
                (uncapped.min(256), ((2.0 + s) * sigma * sigma).ceil() as u32 + 2)
            );
            assert!(
                kappa <= 0.5 / (2.0 + s)
                    && (2.0 * kappa * f64::from(uncapped) / (sigma * sigma) - 1.0).abs() < 1e-12
            );
            let (n, eps) = plan(&depth, &view, Rule::Source, &params).at(1, 1);
            let r_s = 1.44 / (d * 2.0 / (96.0 * 1.5));
            assert!(f64::from(n) > r_s && f64::from(n) <= r_s + 1.0);
            assert!((eps - 0.0159_f64.min(d * 2.0 / (96.0 * 1.5) / 4.0)).abs() < 1e-15);
            assert_eq!(plan(&depth, &view, Rule::Fixed(40), &params).at(1, 1), (40, eps));
        }
        let empty = plan(&Image::new(96, 96, EMPTY), &view, Rule::Source, &params);
        assert!(empty.data.iter().all(|(n, _)| *n == 0));
    }

    #[test]
    fn a_plane_that_faces_the_eye_stays_put() {
        let view = view(DVec2::new(2.0, -2.0), DVec2::new(0.3, 0.0), 33, 17);
        for rule in [Rule::Source, Rule::ConstantWidth, Rule::Fixed(40)] {
            let depth = Image::new(33, 17, 20.0);
            assert_eq!(smoothed(&depth, &view, rule), depth);
        }
    }

    /// Pixels at the image's edges are excluded, because their differences are cut.
    #[test]
    fn planes_stay_put_on_and_off_the_axis() {
        for shift in [DVec2::ZERO, DVec2::new(1.0, -0.6)] {
            let view = view(DVec2::new(2.0, -2.0), shift, 65, 65);
            for (d, tilt, towards) in [(20.0, 30.0_f64, 0.0), (20.0, 40.0, 2.0), (40.0, 45.0, 4.0)]
            {
                let tilt = tilt.to_radians();
                let depth = plane(&view, d, tilt, towards);
                let params = Params::new(1.0);
                for (x, y) in (1..64).flat_map(|y| (1..64).map(move |x| (x, y))) {
                    // The central differences of 1 / (1 - e i) miss the derivatives by 2 e^4 z per
                    // axis.
                    let (here, ray) = (depth.at(x, y), view.ray(x, y));
                    let e = view.c_x() * tilt.tan() * here / d;
                    let lattice = 4.0 * e.powi(4) * here * ray.length_squared();
                    let (x, y) = (x as isize, y as isize);
                    let creep = rate(&depth, x, y, &view, Rule::ConstantWidth, &params);
                    assert!(creep.abs() <= lattice, "{creep} of {here} at ({x}, {y}): {lattice}");
                }
                let after = smoothed(&depth, &view, Rule::ConstantWidth);
                let drift = (after.at(32, 32) - depth.at(32, 32)).abs();
                assert!(drift < 1e-4 * d, "{drift} at {d}, {tilt}");
            }
        }
    }

    /// A checkerboard, the least stable pattern, must not grow for any slope and any shape of
    /// pixels.
    #[test]
    fn the_step_is_stable_off_the_axis() {
        for (sx, sy, aspect) in
            [(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (-0.6, 1.0, 1.5), (1.0, 1.0, 3.0)]
        {
            let roughness = checkerboard_after_smoothing(DVec2::new(sx, sy), aspect);
            assert!(roughness < 1.0, "{roughness} left at ({sx}, {sy}), C_y / C_x {aspect}");
        }
    }

    /// In pixels wider than high z_yy has the factor (1 + s_y^2) (C_x / C_y)^2.
    #[test]
    fn the_step_is_stable_in_flat_pixels() {
        for aspect in [0.9, 0.8, 0.5] {
            let roughness = checkerboard_after_smoothing(DVec2::ZERO, aspect);
            assert!(roughness < 1.0, "{roughness} left at C_y / C_x {aspect}");
        }
    }

    /// What remains of a checkerboard with amplitude 1.
    fn checkerboard_after_smoothing(slope: DVec2, aspect: f64) -> f64 {
        let focal = DVec2::new(40.0, -40.0 / aspect);
        let view = view(focal, slope * focal, 48, 48);
        let depth =
            Image::from_fn(48, 48, |x, y| 500.0 + if (x + y) % 2 == 0 { 1e-3 } else { -1e-3 });
        let after = smoothed(&depth, &view, Rule::ConstantWidth);
        let middle = (16..32).flat_map(|y| (16..32).map(move |x| (x, y)));
        middle.map(|(x, y)| (after.at(x, y) - 500.0).abs() / 1e-3).fold(0.0, f64::max)
    }

    /// A small wave on a plane of water.
    struct Wave {
        /// Slope of the view direction off the axis.
        middle: DVec2,
        /// C_y / C_x of the pixels.
        aspect: f64,
        /// Depth of the plane, its tilt and the direction of the tilt.
        d: f64,
        tilt: f64,
        towards: f64,
        /// Direction of the wave, relative to the direction down the plane.
        along: f64,
        extent: (usize, usize),
        rule: Rule,
        /// Wave number.
        k: f64,
    }

    /// A wave with `k sigma_w = 1` on the axis; each test changes what it needs.
    const WAVE: Wave = Wave {
        middle: DVec2::ZERO,
        aspect: 1.0,
        d: 1500.0,
        tilt: 0.0,
        towards: 0.0,
        along: 0.0,
        extent: (128, 128),
        rule: Rule::ConstantWidth,
        k: 1.0 / 1.5,
    };

    /// What remains of a wave: the response of the smoothed depth at the wave's number, under a
    /// window in the middle.
    fn remains(wave: Wave) -> f64 {
        let Wave { middle, aspect, d, tilt, towards, along, extent, rule, k } = wave;
        let focal = DVec2::splat(5120.0 / extent.0 as f64 * 2.0)
            * DVec2::new(1.0, -1.0)
            * DVec2::new(1.0, extent.0 as f64 / (extent.1 as f64 * aspect));
        let view = view(focal, middle * focal, extent.0, extent.1);
        let base = plane(&view, d, tilt, towards);
        let down = DVec2::from_angle(towards);
        let slope = (down * tilt.cos()).extend(-tilt.sin());
        let level = down.perp().extend(0.0);
        let direction = slope * along.cos() + level * along.sin();
        let phase = |x: usize, y: usize| {
            let point: DVec3 = view.ray(x, y) * base.at(x, y);
            k * (point + DVec3::Z * d).dot(direction)
        };
        let waves =
            Image::from_fn(extent.0, extent.1, |x, y| base.at(x, y) + 1e-3 * phase(x, y).cos());
        let (flat, wavy) = (smoothed(&base, &view, rule), smoothed(&waves, &view, rule));
        let hann = |i: usize, n: usize| {
            let t = (i as f64 + 0.5) / n as f64 * 2.0 - 0.5;
            if (0.0..1.0).contains(&t) { (PI * t).sin().powi(2) } else { 0.0 }
        };
        let (mut before, mut after) = (0.0, 0.0);
        for (x, y) in (0..extent.1).flat_map(|y| (0..extent.0).map(move |x| (x, y))) {
            let window = if extent.1 > 16 { hann(y, extent.1) } else { 1.0 };
            let weight = hann(x, extent.0) * window * phase(x, y).cos();
            before += weight * (waves.at(x, y) - base.at(x, y));
            after += weight * (wavy.at(x, y) - flat.at(x, y));
        }
        after / before
    }

    #[test]
    fn a_wave_decays_by_the_gaussian_at_every_distance_and_slant() {
        let expected = (-0.5_f64).exp();
        for d in [500.0, 1000.0, 2000.0] {
            for tilt in [0.0, 45.0_f64, 60.0] {
                let tilted = Wave { d, tilt: tilt.to_radians(), extent: (256, 5), ..WAVE };
                let left = remains(tilted);
                assert!((left / expected - 1.0).abs() < 0.03, "{left} at {d}, {tilt} degrees");
            }
        }
    }

    #[test]
    fn a_wave_decays_alike_along_across_and_aslant() {
        let expected = (-0.5_f64).exp();
        for towards in [0.0, PI / 4.0, PI / 2.0] {
            for along in [0.0, PI / 4.0, PI / 2.0] {
                let left = remains(Wave { tilt: 1.0, towards, along, ..WAVE });
                assert!((left / expected - 1.0).abs() < 0.04, "{left} at {towards}, {along}");
            }
        }
    }

    #[test]
    fn a_wave_decays_alike_off_the_axis_and_in_oblong_pixels() {
        let expected = (-0.5_f64).exp();
        for middle in [DVec2::new(1.0, 0.0), DVec2::new(-0.5, 0.8), DVec2::new(1.0, 1.0)] {
            for aspect in [1.0, 1.4] {
                for (tilt, along) in [(0.0, 0.0), (0.0, PI / 2.0), (0.3, PI / 4.0)] {
                    let left = remains(Wave { middle, aspect, tilt, along, ..WAVE });
                    assert!(
                        (left / expected - 1.0).abs() < 0.04,
                        "{left} at {middle}, {aspect}, {tilt}, {along}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_source_diffuses_by_its_step() {
        for d in [500.0, 2000.0] {
            let pixel = d * 2.0 / (10240.0);
            let source = Wave { d, extent: (256, 5), rule: Rule::Source, k: 1.5, ..WAVE };
            let left = remains(source);
            let n = (4.8 / pixel).floor() + 1.0;
            let kappa = (0.053 / pixel).min(0.25);
            let expected = (1.0 - 4.0 * kappa * (0.75 * pixel).sin().powi(2)).powf(n);
            assert!((left / expected - 1.0).abs() < 0.02, "{left} for {expected} at {d}");
        }
    }

    #[test]
    fn a_step_beyond_the_falloff_keeps_its_sides() {
        let view = view(DVec2::new(8.0, -8.0), DVec2::ZERO, 48, 32);
        let noise = |x: usize, y: usize| 0.2 * ((x * 7 + y * 13) % 11) as f64 / 11.0;
        let depth = Image::from_fn(48, 32, |x, y| match x {
            0..20 => 50.0 + noise(x, y),
            20..40 => 56.0,
            _ => EMPTY,
        });
        for rule in [Rule::Source, Rule::ConstantWidth, Rule::Fixed(40)] {
            let after = smoothed(&depth, &view, rule);
            let mut left = (f64::INFINITY, 0.0_f64);
            for (x, y) in (0..32).flat_map(|y| (0..48).map(move |x| (x, y))) {
                let z = after.at(x, y);
                match x {
                    0..20 => left = (left.0.min(z), left.1.max(z)),
                    _ => assert_eq!(z, depth.at(x, y)),
                }
            }
            assert!(left.0 >= 50.0 && left.1 <= 50.2, "{left:?}");
            let rough = |z: &Image<f64>| (z.at(8, 16) - z.at(9, 16)).abs();
            assert!(rough(&after) < 0.2 * rough(&depth), "{rule:?}");
        }
    }
}
