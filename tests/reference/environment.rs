//! Twin of the environment: the cube map of an equirectangular image and of the built-in sky, and
//! its mip levels. Cube faces are selected as in the Vulkan specification ("Cube Map Face
//! Selection"). The map's columns go around the horizon, from west to east as seen from the middle;
//! its rows go down from the zenith.

use super::{Image, smoothstep};
use crate::support::tolerance::U;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// For each face +x −x +y −y +z −z: its axis, and the directions of increasing s and t.
const FACES: [[DVec3; 3]; 6] = [
    [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
    [DVec3::NEG_X, DVec3::Z, DVec3::NEG_Y],
    [DVec3::Y, DVec3::X, DVec3::Z],
    [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z],
    [DVec3::Z, DVec3::X, DVec3::NEG_Y],
    [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y],
];

/// The direction through a position (0 to 1) on a face; not normalized.
pub fn direction(face: usize, st: DVec2) -> DVec3 {
    let [axis, s, t] = FACES[face];
    axis + s * (2.0 * st.x - 1.0) + t * (2.0 * st.y - 1.0)
}

/// The face that a direction meets, and the position on it.
pub fn face_of(d: DVec3) -> (usize, DVec2) {
    let face = (0..6).max_by(|a, b| FACES[*a][0].dot(d).total_cmp(&FACES[*b][0].dot(d)));
    let face = face.unwrap_or(0);
    let [axis, s, t] = FACES[face];
    (face, (DVec2::new(s.dot(d), t.dot(d)) / axis.dot(d) + 1.0) / 2.0)
}

/// Direction in a map's own space, with +y up, of one in a world whose axis `up` points up. For z up
/// the middle column looks along +y and the column at three quarters along +x, for x up along +z
/// and +y.
pub fn standing(d: DVec3, up: usize) -> DVec3 {
    match up {
        0 => DVec3::new(d.y, d.x, -d.z),
        1 => d,
        _ => DVec3::new(d.x, d.z, -d.y),
    }
}

/// Position of a direction in an equirectangular map, in texels: the middle column is −z, the
/// column at three quarters is +x. A positive turn moves the map from −z towards −x, like a
/// right-handed rotation about +y.
pub fn map_position(d: DVec3, turn: f64, width: usize, height: usize) -> DVec2 {
    let east = d.x.atan2(-d.z) + turn;
    let down = DVec2::new(d.x, d.z).length().atan2(d.y);
    DVec2::new((east / TAU + 0.5) * width as f64, down / PI * height as f64)
}

/// A map's values around a position.
pub struct Sample {
    /// Bilinear mean of four texels; the map wraps around horizontally.
    pub value: DVec3,
    /// Max change of the value per texel in x and in y.
    pub slope: [DVec3; 2],
}

/// Samples a map. `nudge`: error of the position in texels, which may select other texels.
pub fn sample(map: &Image<[f32; 4]>, at: DVec2, nudge: DVec2) -> Sample {
    let texel = |x: isize, y: isize| {
        let x = x.rem_euclid(map.width as isize);
        let y = y.clamp(0, map.height as isize - 1);
        let [r, g, b, _] = map.at(x as usize, y as usize).map(f64::from);
        DVec3::new(r, g, b)
    };
    let h = at - 0.5;
    let (i, f) = (h.floor(), h - h.floor());
    let (x, y) = (i.x as isize, i.y as isize);
    let top = texel(x, y).lerp(texel(x + 1, y), f.x);
    let bottom = texel(x, y + 1).lerp(texel(x + 1, y + 1), f.x);
    let (low, high) = ((h - nudge).floor(), (h + nudge).floor());
    let mut slope = [DVec3::ZERO; 2];
    for y in low.y as isize..=high.y as isize + 1 {
        for x in low.x as isize..=high.x as isize + 1 {
            slope[0] = slope[0].max((texel(x + 1, y) - texel(x, y)).abs());
            slope[1] = slope[1].max((texel(x, y + 1) - texel(x, y)).abs());
        }
    }
    Sample { value: top.lerp(bottom, f.y), slope }
}

/// The four positions on a face that are averaged for a texel of the cube: the centres of its
/// quarters.
pub fn quarters(x: usize, y: usize, size: usize) -> [DVec2; 4] {
    [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)]
        .map(|(dx, dy)| DVec2::new(x as f64 + dx, y as f64 + dy) / size as f64)
}

/// Constants of the air in km: scattering per km at sea level, extinction of the aerosol (0.11 more
/// than it scatters) and scale heights. Rayleigh: 13.5e-3 at 550 nm (Bruneton and Neyret 2008), by
/// the fourth power of the wavelength. Aerosol: an optical depth of 0.1 at 550 nm, by the power
/// 1.3. Wavelengths are 645, 553 and 443 nm.
const EARTH: f64 = 6360.0;
const TOP: f64 = 6420.0;
const RAYLEIGH: DVec3 = DVec3::new(7.14e-3, 13.21e-3, 32.08e-3);
const MIE: DVec3 = DVec3::new(67.7e-3, 82.7e-3, 110.4e-3);
const MIE_LOSS: f64 = 1.11;
const HEIGHTS: DVec2 = DVec2::new(8.0, 1.2);

/// Steps of the quadrature: along a ray, and from there to the sun. Their lengths grow like odd
/// numbers.
#[derive(Clone, Copy)]
pub struct Steps {
    pub along: usize,
    pub sun: usize,
}

/// The steps of the built-in sky.
pub const SKY_STEPS: Steps = Steps { along: 24, sun: 12 };

/// A value and its error in single precision.
#[derive(Clone, Copy)]
pub struct Rounded<T> {
    pub value: T,
    pub error: T,
}

/// Distance from a point in the air to the air's end. The root's argument is a difference of
/// squared radii with three roundings; the root errs by 10u.
fn air_ends(p: DVec3, d: DVec3) -> Rounded<f64> {
    let b = p.dot(d);
    let square = b * b - p.length_squared() + TOP * TOP;
    let root = square.max(0.0).sqrt();
    let error = U * (3.0 * TOP * TOP / root.max(1.0) + 12.0 * (root + b.abs()));
    Rounded { value: root - b, error }
}

/// Density of Rayleigh and Mie scattering at distance t along a ray, where t errs by `uncertain`.
/// The height is the root (10u) of a sum of squares (5u before the root), minus the earth's radius;
/// the cosine errs by 10u. An exponential errs by (6 + 4 |x|) u.
fn density(p: DVec3, t: f64, uncertain: f64) -> Rounded<DVec2> {
    let height = (p.length() - EARTH).max(0.0) / HEIGHTS;
    let off = (U * (12.5 * p.length() + 10.0 * t) + uncertain) / HEIGHTS;
    let value = (-height).exp();
    Rounded { value, error: value * (off + U * (6.0 + 4.0 * height)) }
}

/// Density times length from a point to the end of the air, by midpoints.
fn optical_depth(p: DVec3, d: DVec3, steps: usize) -> Rounded<DVec2> {
    let end = air_ends(p, d);
    let mut sum = Rounded { value: DVec2::ZERO, error: DVec2::ZERO };
    for i in 0..steps {
        let [from, to] = [i, i + 1].map(|i| end.value * (i as f64 / steps as f64).powi(2));
        let (t, size) = ((from + to) / 2.0, to - from);
        let found = density(p + d * t, t, end.error);
        sum.value += found.value * size;
        sum.error += (found.error + found.value * (end.error / end.value + 20.0 * U)) * size;
    }
    sum
}

fn extinction(depth: DVec2) -> DVec3 {
    RAYLEIGH * depth.x + MIE_LOSS * MIE * depth.y
}

fn transmittance(depth: Rounded<DVec2>) -> Rounded<DVec3> {
    let exponent = extinction(depth.value);
    let value = (-exponent).exp();
    let error = value * (extinction(depth.error) + U * (6.0 + 8.0 * exponent));
    Rounded { value, error }
}

/// Radiance of the sky under a sun of unit irradiance, seen 50 m above the sea. A ray has the light
/// of single scattering; rays lower than 0.003 have that of 0.003. Multiple scattering adds 0.072 h
/// / (h + 0.12), with h the sun's height, where the air without its aerosol is thick. Below the
/// horizon, the ground with an albedo of 0.22 in the light of sun and sky fades in, completely at
/// -0.12.
pub fn sky(direction: DVec3, sun: DVec3, steps: Steps) -> Rounded<DVec3> {
    let eye = DVec3::Y * (EARTH + 0.05);
    let d = direction.with_y(direction.y.max(0.003)).normalize();
    let end = air_ends(eye, d);
    let n = steps.along as f64;
    let mut passed = Rounded { value: DVec2::ZERO, error: DVec2::ZERO };
    let mut sum = [DVec3::ZERO; 2];
    let mut error = [DVec3::ZERO; 2];
    for i in 0..steps.along {
        let [from, to] = [i, i + 1].map(|i| end.value * (i as f64 / n).powi(2));
        // The square is computed by pow: log2(1/24) errs by 3 ulp, exp2 by twice that.
        let uncertain = end.error + 100.0 * U * to;
        let (t, size) = ((from + to) / 2.0, to - from);
        let p = eye + d * t;
        let here = density(p, t, uncertain);
        let off = here.error * size + here.value * 2.0 * uncertain;
        let here = here.value * size;

        // The sun is taken at most 0.05 below the point's own horizon.
        let up = p.normalize();
        let cosine = up.dot(sun);
        let level = (sun - up * cosine).normalize_or_zero();
        let lowest = up * -0.05 + level * (1.0_f64 - 0.05 * 0.05).sqrt();
        let away = optical_depth(p, if cosine < -0.05 { lowest } else { sun }, steps.sun);
        let through = transmittance(Rounded {
            value: passed.value + here / 2.0 + away.value,
            error: passed.error + off / 2.0 + away.error,
        });
        passed.value += here;
        passed.error += off;
        for kind in [0, 1] {
            sum[kind] += here[kind] * through.value;
            error[kind] += off[kind] * through.value + here[kind] * through.error;
        }
    }
    let mu = d.dot(sun);
    let g = 0.76_f64;
    let beyond = 1.0 + g * g - 2.0 * g * mu;
    let rayleigh = RAYLEIGH * (3.0 / (16.0 * PI) * (1.0 + mu * mu));
    let mie = MIE * 3.0 / (8.0 * PI) * (1.0 - g * g) * (1.0 + mu * mu)
        / ((2.0 + g * g) * beyond.powf(1.5));
    // pow: log2 errs by 2^-21 near 1, or 3 ulp of at most 4.1; the cosine errs by 10u.
    let phase = U * (40.0 + 3.0 * g * 10.0 / beyond);
    let once = sum[0] * rayleigh + sum[1] * mie;
    let thick = (-(RAYLEIGH * passed.value.x)).exp();
    let thick_off = thick * (RAYLEIGH * passed.error.x + 40.0 * U);
    let high = sun.y.max(0.0);
    let often = 0.072 * high / (high + 0.12);
    let air = Rounded {
        value: once + often * (1.0 - thick),
        error: error[0] * rayleigh + error[1] * mie + once * (phase + 60.0 * U) + often * thick_off,
    };
    let daylight = transmittance(optical_depth(eye, sun, steps.sun));
    let lit = sun.y.max(0.0) / PI;
    let ground = Rounded {
        value: 0.22
            * (lit * daylight.value + high / (high + 0.12) / PI * DVec3::new(0.15, 0.20, 0.29)),
        error: 0.22 * lit * daylight.error + 20.0 * U,
    };
    let below = 1.0 - smoothstep(-0.12, 0.0, direction.y);
    // The max slope of the smoothstep is 1.5 over 0.12.
    let mixing = (ground.value - air.value).abs() * (1.5 / 0.12 * 8.0 + 8.0) * U;
    Rounded {
        value: air.value.lerp(ground.value, below),
        error: air.error.lerp(ground.error, below) + mixing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_has_its_axis_in_the_middle_and_neighbours_meet() {
        for (face, [axis, s, t]) in FACES.into_iter().enumerate() {
            assert_eq!(direction(face, DVec2::splat(0.5)), axis);
            for st in [DVec2::new(0.1, 0.7), DVec2::new(0.9, 0.95), DVec2::new(0.3, 0.2)] {
                let (found, at) = face_of(direction(face, st) * 3.0);
                assert!(found == face && (at - st).length() < 1e-12);
            }
            // s × t points inwards on every face, so no face is mirrored.
            assert_eq!(s.cross(t), -axis);
        }
    }

    #[test]
    fn the_map_is_where_it_is_said_to_be() {
        let at = |d: DVec3, turn: f64| map_position(d, turn, 400, 200);
        for (d, expected) in [
            (DVec3::NEG_Z, DVec2::new(200.0, 100.0)),
            (DVec3::X, DVec2::new(300.0, 100.0)),
            (DVec3::NEG_X, DVec2::new(100.0, 100.0)),
            (DVec3::new(1.0, 1.0, 0.0), DVec2::new(300.0, 50.0)),
            (DVec3::new(0.0, -1.0, -1.0), DVec2::new(200.0, 150.0)),
        ] {
            assert!((at(d, 0.0) - expected).length() < 1e-9, "{d}: {}", at(d, 0.0));
        }
        let turn = 0.4;
        let turned = glam::DMat3::from_rotation_y(turn) * DVec3::NEG_Z;
        assert!((at(turned, turn) - DVec2::new(200.0, 100.0)).length() < 1e-9);
    }

    /// The error of the built-in sky's quadrature is a few hundredths.
    #[test]
    fn the_skys_steps_are_enough() {
        let fine = Steps { along: 400, sun: 200 };
        let mut worst: f64 = 0.0;
        for elevation in [0.05_f64, 0.3, 0.8, 1.5] {
            let sun = DVec3::new(elevation.cos(), elevation.sin(), 0.0);
            for (height, turn) in [(0.005, 0.3), (0.05, 3.0), (0.3, 1.0), (0.7, 2.0), (1.5, 0.0)] {
                let (height, turn): (f64, f64) = (height, turn);
                let across = DVec2::from_angle(turn) * height.cos();
                let d = DVec3::new(across.x, height.sin(), across.y);
                let (coarse, exact) = (sky(d, sun, SKY_STEPS).value, sky(d, sun, fine).value);
                worst = worst.max(((coarse - exact) / exact).abs().max_element());
            }
        }
        assert!(worst > 1e-4 && worst < 0.04, "{worst}");
    }

    /// Uniform random numbers from 0 to 1 (splitmix64).
    struct Dice(u64);

    impl Dice {
        fn roll(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 * 0.5_f64.powi(53)
        }
    }

    /// Fraction of sunlight that reaches level ground with an albedo of 0.2 after any number of
    /// scatterings: photons in plane layers of air and aerosol.
    fn scattered(channel: usize, height: f64, photons: usize) -> f64 {
        let mut dice = Dice(7 + channel as u64);
        let sea = [RAYLEIGH[channel], MIE_LOSS * MIE[channel]];
        let above = |z: f64| [0, 1].map(|i| sea[i] * HEIGHTS[i] * (-z / HEIGHTS[i]).exp());
        let whole: f64 = above(0.0).iter().sum();
        // Height at an optical depth from the top, by bisection.
        let height_of = |depth: f64| {
            let (mut low, mut high) = (0.0, 200.0);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                let deeper = above(middle).iter().sum::<f64>() > depth;
                *(if deeper { &mut low } else { &mut high }) = middle;
            }
            low
        };
        let mut down = 0.0;
        for _ in 0..photons {
            let level = (1.0 - height * height).sqrt();
            let (mut ray, mut depth, mut weight) = (DVec3::new(level, -height, 0.0), 0.0, 1.0);
            for order in 0..60 {
                depth -= ray.y * -(1.0 - dice.roll()).ln();
                if depth < 0.0 {
                    break;
                }
                let turn = DVec2::from_angle(TAU * dice.roll());
                if depth >= whole {
                    down += if order > 0 { weight } else { 0.0 };
                    // Diffuse reflection by the ground.
                    let square = dice.roll();
                    let across = turn * square.sqrt();
                    ray = DVec3::new(across.x, (1.0 - square).sqrt(), across.y);
                    (weight, depth) = (0.2 * weight, whole);
                    continue;
                }
                let z = height_of(depth);
                let here = [0, 1].map(|i| sea[i] * (-z / HEIGHTS[i]).exp());
                let cosine = if dice.roll() * (here[0] + here[1]) < here[0] {
                    // Rayleigh's 3/8 (1 + c^2), sampled by its inverse.
                    let q = 4.0 * dice.roll() - 2.0;
                    let root = (q + (q * q + 1.0).sqrt()).cbrt();
                    root - root.recip()
                } else {
                    weight /= MIE_LOSS;
                    // Henyey-Greenstein: its mean cosine differs from that of the sky's phase
                    // function by a hundredth.
                    let g = 0.76_f64;
                    let part = (1.0 - g * g) / (1.0 - g + 2.0 * g * dice.roll());
                    (1.0 + g * g - part * part) / (2.0 * g)
                };
                let side = ray.any_orthonormal_vector();
                let across = side * turn.x + ray.cross(side) * turn.y;
                ray = (ray * cosine + across * (1.0 - cosine * cosine).max(0.0).sqrt()).normalize();
            }
        }
        height * down / photons as f64
    }

    /// With the term for multiple scattering the sky is as bright as it should be: its light on
    /// level ground is within 6 % of a Monte Carlo solution, plus three standard errors of that.
    #[test]
    fn the_sky_is_as_bright_as_air_makes_it() {
        for degrees in [35.0_f64, 53.0, 90.0] {
            let height = degrees.to_radians().sin();
            let sun = DVec3::new((1.0 - height * height).max(0.0).sqrt(), height, 0.0);
            let (rings, turns) = (12, 24);
            let mut light = DVec3::ZERO;
            for (i, j) in (0..rings).flat_map(|i| (0..turns).map(move |j| (i, j))) {
                // Uniform in the squared cosine, which weights directions by the cosine.
                let square = (f64::from(i) + 0.5) / f64::from(rings);
                let turn = DVec2::from_angle(TAU * (f64::from(j) + 0.5) / f64::from(turns));
                let across = turn * (1.0 - square).sqrt();
                let d = DVec3::new(across.x, square.sqrt(), across.y);
                light += sky(d, sun, SKY_STEPS).value * PI / f64::from(rings * turns);
            }
            let photons = 60_000;
            for channel in 0..3 {
                let found = scattered(channel, height, photons);
                let error = 3.0 * (found * height / photons as f64).sqrt();
                let off = (light[channel] - found).abs();
                assert!(
                    off < 0.06 * found + error,
                    "sun at {degrees}, channel {channel}: {}, not {found} within {error}",
                    light[channel]
                );
            }
        }
    }
}
