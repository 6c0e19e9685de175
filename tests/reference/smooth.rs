//! Twin of the adaptive curvature flow (section 5), on the positive eye depth z of the reduced
//! image:
//! ```text
//! D   = C_y^2 z_x^2 + C_x^2 z_y^2 + C_x^2 C_y^2 z^2        2H = (C_y E_x + C_x E_y) / D^(3/2)
//! E_x = z_x D_x / 2 - z_xx D                               E_y = z_y D_y / 2 - z_yy D
//! Source, Fixed:  z <- z - eps 2H                          without z_xy
//! ConstantWidth:  z <- z - kappa (C_y E_x + C_x E_y) / (D C_y)
//! ```
//! (the latter is the specification's `eps (..) / (D C_x C_y d)` with `eps = kappa C_x d`).

use super::{Image, View, is_surface};

/// How far and how often a pixel is smoothed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// As in the thesis: `N = floor(4.8 r / (C_x d)) + 1` steps of 2H.
    Source,
    /// Mean curvature flow to the width `sigma_w` along the surface.
    ConstantWidth,
    /// The source's step, this often for every pixel.
    Fixed(u32),
}

/// The smoothing's lengths, in world units, and the limit of its iterations.
#[derive(Clone, Copy, Debug)]
pub struct Params {
    /// r, the drawn radius.
    pub radius: f64,
    /// The wanted width along the surface.
    pub sigma_w: f64,
    /// No derivative across a larger difference of depth.
    pub depth_falloff: f64,
    /// No pixel is smoothed more often.
    pub cap: u32,
}

impl Params {
    /// The defaults for a drawn radius.
    pub fn new(radius: f64) -> Self {
        Self {
            radius,
            sigma_w: 1.5 * radius,
            depth_falloff: 5.3 * radius,
            cap: 256,
        }
    }
}

/// N and the step of each pixel, from the depth before the smoothing: kappa in pixels squared for
/// `ConstantWidth`, else eps as a length. The cap bounds N and leaves the step as it is, so that
/// kappa never exceeds 1/4. An empty pixel has N = 0.
pub fn plan(
    reduced: &Image<f64>,
    view_reduced: &View,
    rule: Rule,
    params: &Params,
) -> Image<(u32, f64)> {
    let (r, c_x) = (params.radius, view_reduced.c_x());
    reduced.map(|d| {
        if !is_surface(*d) {
            return (0, 0.0);
        }
        let source_step = (0.053 * r).min(c_x * d / 4.0);
        let (n, step) = match rule {
            Rule::Source => ((4.8 * r / (c_x * d)).floor() + 1.0, source_step),
            Rule::Fixed(n) => (f64::from(n), source_step),
            Rule::ConstantWidth => {
                let sigma_px = params.sigma_w / (c_x * d);
                let n = (2.0 * sigma_px * sigma_px).ceil();
                (
                    n,
                    if n > 0.0 {
                        sigma_px * sigma_px / (2.0 * n)
                    } else {
                        0.0
                    },
                )
            }
        };
        (n.min(f64::from(params.cap)) as u32, step)
    })
}

/// Runs the flow: iteration i = 1, 2, .. acts on the pixels with i <= N, on all at once.
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
    let (c_x, c_y) = (view_reduced.c_x(), view_reduced.c_y());
    let last = plan.data.iter().map(|(n, _)| *n).max().unwrap_or(0);
    let mut z = depth.clone();
    for i in 1..=last {
        z = Image::from_fn(z.width, z.height, |x, y| {
            let (n, step) = plan.at(x, y);
            let here = z.at(x, y);
            if i <= n {
                here - change(&z, x as isize, y as isize, (c_x, c_y), step, rule, params)
            } else {
                here
            }
        });
    }
    z
}

/// How much one step takes off the depth of a pixel.
fn change(
    z: &Image<f64>,
    x: isize,
    y: isize,
    (c_x, c_y): (f64, f64),
    step: f64,
    rule: Rule,
    params: &Params,
) -> f64 {
    let here = z.clamped(x, y);
    // A neighbour on the same surface.
    let at = |dx, dy| {
        z.checked(x + dx, y + dy)
            .filter(|there| (there - here).abs() <= params.depth_falloff)
    };
    // First and second central difference of an axis, nothing where it is cut.
    let axis = |dx: isize, dy: isize| {
        let (a, b) = (at(-dx, -dy)?, at(dx, dy)?);
        Some(((b - a) / 2.0, a - 2.0 * here + b))
    };
    let mixed = || Some((at(1, 1)? - at(1, -1)? - at(-1, 1)? + at(-1, -1)?) / 4.0);

    let (along_x, along_y) = (axis(1, 0), axis(0, 1));
    let z_xy = match rule {
        Rule::ConstantWidth if along_x.is_some() && along_y.is_some() => mixed().unwrap_or(0.0),
        _ => 0.0,
    };
    let (z_x, z_xx) = along_x.unwrap_or_default();
    let (z_y, z_yy) = along_y.unwrap_or_default();

    let (c_x2, c_y2) = (c_x * c_x, c_y * c_y);
    let d = c_y2 * z_x * z_x + c_x2 * z_y * z_y + c_x2 * c_y2 * here * here;
    let d_x = 2.0 * (c_y2 * z_x * z_xx + c_x2 * z_y * z_xy + c_x2 * c_y2 * here * z_x);
    let d_y = 2.0 * (c_y2 * z_x * z_xy + c_x2 * z_y * z_yy + c_x2 * c_y2 * here * z_y);
    let e_x = 0.5 * z_x * d_x - z_xx * d;
    let e_y = 0.5 * z_y * d_y - z_yy * d;
    let numerator = c_y * e_x + c_x * e_y;
    match rule {
        Rule::ConstantWidth => step * numerator / (d * c_y),
        Rule::Source | Rule::Fixed(_) => step * numerator / (d * d.sqrt()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::EMPTY;
    use super::super::tests::view;
    use super::*;
    use glam::{DVec2, DVec3};
    use std::f64::consts::PI;

    /// The depth of the plane through (0, 0, -d), tilted by an angle about the eye's z and away.
    fn plane(view: &View, d: f64, tilt: f64, towards: f64) -> Image<f64> {
        Image::from_fn(view.width, view.height, |x, y| {
            let s = view.ray(x, y).truncate().dot(DVec2::from_angle(towards));
            d / (1.0 - tilt.tan() * s)
        })
    }

    fn smoothed(depth: &Image<f64>, view: &View, rule: Rule) -> Image<f64> {
        let params = Params {
            cap: 100_000,
            ..Params::new(1.0)
        };
        run(
            depth,
            &plan(depth, view, rule, &params),
            view,
            rule,
            &params,
        )
    }

    #[test]
    fn the_plan_is_the_closed_form() {
        let view = view(DVec2::new(1.5, -1.5), DVec2::ZERO, 96, 96);
        let params = Params::new(0.3);
        for d in [2.0, 9.0, 60.0] {
            let depth = Image::new(96, 96, d);
            let (n, kappa) = plan(&depth, &view, Rule::ConstantWidth, &params).at(1, 1);
            let whole = Params {
                cap: u32::MAX,
                ..params
            };
            let (uncapped, _) = plan(&depth, &view, Rule::ConstantWidth, &whole).at(1, 1);
            let sigma = 0.45 / (d * 2.0 / (96.0 * 1.5));
            assert_eq!(n, uncapped.min(256));
            assert!(
                kappa <= 0.25
                    && (2.0 * kappa * f64::from(uncapped) / (sigma * sigma) - 1.0).abs() < 1e-12
            );
            let (n, eps) = plan(&depth, &view, Rule::Source, &params).at(1, 1);
            let r_s = 1.44 / (d * 2.0 / (96.0 * 1.5));
            assert!(f64::from(n) > r_s && f64::from(n) <= r_s + 1.0);
            assert!((eps - 0.0159_f64.min(d * 2.0 / (96.0 * 1.5) / 4.0)).abs() < 1e-15);
            assert_eq!(
                plan(&depth, &view, Rule::Fixed(40), &params).at(1, 1),
                (40, eps)
            );
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

    /// D's derivative holds half of what perspective bends a plane's depth by (z_xx = 2 z_x^2 / z),
    /// hence a slanted plane recedes by sigma_w^2 sin^2(tilt) / (2 d): little, and from nothing
    /// to the edge of the image where it is held.
    #[test]
    fn a_slanted_plane_recedes_no_more_than_the_closed_form() {
        let view = view(DVec2::new(2.0, -2.0), DVec2::ZERO, 193, 7);
        for (d, tilt) in [(20.0, 30.0_f64), (20.0, 60.0), (40.0, 45.0)] {
            let tilt = tilt.to_radians();
            let depth = plane(&view, d, tilt, 0.0);
            let after = smoothed(&depth, &view, Rule::ConstantWidth);
            let drift = after.at(96, 3) - depth.at(96, 3);
            let expected = 2.25 * tilt.sin().powi(2) / (2.0 * d);
            assert!(
                (drift / expected - 1.0).abs() < 0.03,
                "{drift} for {expected}"
            );
        }
    }

    /// What is left of a small wave of `k sigma_w = 1`: the response of the smoothed depth at the
    /// wave's own number, under a window in the middle.
    fn remains(
        d: f64,
        tilt: f64,
        towards: f64,
        along: f64,
        extent: (usize, usize),
        rule: Rule,
        k: f64,
    ) -> f64 {
        let view = view(
            DVec2::splat(5120.0 / extent.0 as f64 * 2.0)
                * DVec2::new(1.0, -1.0)
                * DVec2::new(1.0, extent.0 as f64 / extent.1 as f64),
            DVec2::ZERO,
            extent.0,
            extent.1,
        );
        let base = plane(&view, d, tilt, towards);
        let down = DVec2::from_angle(towards);
        let slope = (down * tilt.cos()).extend(-tilt.sin());
        let level = down.perp().extend(0.0);
        let direction = slope * along.cos() + level * along.sin();
        let phase = |x: usize, y: usize| {
            let point: DVec3 = view.ray(x, y) * base.at(x, y);
            k * (point + DVec3::Z * d).dot(direction)
        };
        let waves = Image::from_fn(extent.0, extent.1, |x, y| {
            base.at(x, y) + 1e-3 * phase(x, y).cos()
        });
        let (flat, wavy) = (smoothed(&base, &view, rule), smoothed(&waves, &view, rule));
        let hann = |i: usize, n: usize| {
            let t = (i as f64 + 0.5) / n as f64 * 2.0 - 0.5;
            if (0.0..1.0).contains(&t) {
                (PI * t).sin().powi(2)
            } else {
                0.0
            }
        };
        let (mut before, mut after) = (0.0, 0.0);
        for (x, y) in (0..extent.1).flat_map(|y| (0..extent.0).map(move |x| (x, y))) {
            let window = if extent.1 > 16 {
                hann(y, extent.1)
            } else {
                1.0
            };
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
                let left = remains(
                    d,
                    tilt.to_radians(),
                    0.0,
                    0.0,
                    (256, 5),
                    Rule::ConstantWidth,
                    1.0 / 1.5,
                );
                assert!(
                    (left / expected - 1.0).abs() < 0.03,
                    "{left} at {d}, {tilt} degrees"
                );
            }
        }
    }

    #[test]
    fn a_wave_decays_alike_along_across_and_aslant() {
        let expected = (-0.5_f64).exp();
        for towards in [0.0, PI / 4.0, PI / 2.0] {
            for along in [0.0, PI / 4.0, PI / 2.0] {
                let left = remains(
                    1500.0,
                    1.0,
                    towards,
                    along,
                    (128, 128),
                    Rule::ConstantWidth,
                    1.0 / 1.5,
                );
                assert!(
                    (left / expected - 1.0).abs() < 0.04,
                    "{left} at {towards}, {along}"
                );
            }
        }
    }

    #[test]
    fn the_source_diffuses_by_its_step() {
        for d in [500.0, 2000.0] {
            let pixel = d * 2.0 / (10240.0);
            let left = remains(d, 0.0, 0.0, 0.0, (256, 5), Rule::Source, 1.5);
            let n = (4.8 / pixel).floor() + 1.0;
            let kappa = (0.053 / pixel).min(0.25);
            let expected = (1.0 - 4.0 * kappa * (0.75 * pixel).sin().powi(2)).powf(n);
            assert!(
                (left / expected - 1.0).abs() < 0.02,
                "{left} for {expected} at {d}"
            );
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
