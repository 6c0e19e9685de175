//! Tests of the twin of pass `spray`.

use super::super::tests::view;
use super::super::thickness::J;
use super::*;
use crate::reference::EMPTY;

pub(super) fn settings() -> Settings {
    Settings {
        spacing: 0.5,
        rest_density: 1000.0,
        opacity: 0.5,
        size: 0.5,
        max_angle: 1.0,
        droplets: 1,
        spread: 0.0,
        stretch: 0.0,
        mist: [0.1, 0.4],
        clumps: 0.0,
        pattern: Pattern { strength: 0.0, size: 1.0, period: 0.25, time: 0.3 },
        densities: [0.6, 0.85],
        shutter: 1.0 / 60.0,
        scattering: 0.0,
        glints: 0.0,
        sums: Sums { step: 0.0, ..Sums::HALF },
    }
}

pub(super) fn particle(position: [f64; 3]) -> Particle {
    let position = DVec3::from(position);
    Particle { position, velocity: DVec3::ZERO, density: 500.0, id: 7, shape: BALL, crowd: CROWDED }
}

fn open(view: &View) -> Image<f64> {
    Image::new(view.width, view.height, EMPTY)
}

fn total(particles: &[Particle], view: &View, settings: &Settings) -> f64 {
    let none = open(view);
    spray(particles, view, settings, &none, &none).depth.data.iter().sum()
}

#[test]
fn the_amount_is_the_integral_and_no_motion_changes_it() {
    let (settings, view) = (settings(), view(DVec2::splat(3.0), DVec2::ZERO, 401, 301));
    let (at, d) = ([0.0, 0.0, -9.0], 9.0);
    let area = view.c_x() * view.c_y() * d * d;
    let h = 0.5 * RADIUS * 0.5;
    let expected = 2.0_f64.ln() * h * h * PI * J;
    for (density, share) in [(500.0, 1.0), (725.0, 0.5)] {
        for velocity in [DVec3::ZERO, 20.0 * DVec3::X, DVec3::new(-9.0, 30.0, 0.0)] {
            let found = total(&[Particle { density, velocity, ..particle(at) }], &view, &settings);
            let ratio = found * area / (share * expected);
            assert!((ratio - 1.0).abs() < 3e-3, "{density}, {velocity}: {ratio}");
        }
        // Motion straight towards the eye is not visible.
        let towards = Particle { velocity: 30.0 * DVec3::Z, ..particle(at) };
        assert_eq!(total(&[towards], &view, &settings), total(&[particle(at)], &view, &settings));
    }
    // Many droplets have the same sum in the mean, plus the mist, which is the first. For 400
    // particles the drawn fraction, uniform from a fifth to 1, averages to within 2 %, and the
    // sizes to within 1 %.
    let mist = 0.3_f64.powi(3) * (0.9_f64.ln() / 0.5_f64.ln()) * (0.4 * 0.5 / h).powi(2);
    let many = Settings { droplets: 64, spread: 1.5, stretch: 0.02, ..settings };
    let velocity = DVec3::new(5.0, 0.0, 2.0);
    let all: Vec<_> = (0..400).map(|id| Particle { id, velocity, ..particle(at) }).collect();
    let ratio = total(&all, &view, &many) * area / (400.0 * expected * (1.0 + mist));
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
}

/// Whatever the mist's shape and streak, the sum over the picture only depends on its
/// half-axis. Pixels sample the kernel of an ellipse at least two pixels wide to within a
/// hundredth.
#[test]
fn mist_keeps_its_amount_in_every_shape() {
    let view = view(DVec2::splat(3.0), DVec2::ZERO, 401, 301);
    let look = Settings { droplets: 2, opacity: 0.0, mist: [0.4, 1.0], ..settings() };
    let area = view.c_x() * view.c_y() * 81.0;
    // The particle is half spray, and has all of its mist.
    let expected = 0.5 * -(0.6_f64.ln()) * (1.0 * 0.5_f64).powi(2) * PI * J;
    let strand = shaped([4.0, 0.5, 0.5], DVec3::new(1.0, 2.0, 0.5), 1.1);
    for shape in [BALL, shaped([2.0, 2.0, 0.25], DVec3::Y, 1.2), strand] {
        for velocity in [DVec3::ZERO, DVec3::new(30.0, 60.0, -9.0)] {
            let one = Particle { density: 725.0, velocity, shape, ..particle([0.0, 0.0, -9.0]) };
            let ratio = total(&[one], &view, &look) * area / expected;
            assert!((ratio - 1.0).abs() < 0.01, "{shape}, {velocity}: {ratio}");
        }
    }
}

/// Ellipses computed by hand: a sheet of mist seen edge-on, with streaks along it and across
/// it.
#[test]
fn mist_is_seen_as_its_ellipsoid_and_its_streak() {
    let view = view(DVec2::splat(3.0), DVec2::ZERO, 101, 101);
    let look = Settings { droplets: 2, mist: [0.4, 1.0], shutter: 0.5, spread: 0.0, ..settings() };
    let sheet = shaped([2.0, 0.25, 2.0], DVec3::X, 0.0);
    // The half-axis is 0.5, so the sheet has 1 and 0.125 across the view; half of a streak of 2
    // m over half a second is added.
    for (velocity, wide) in [
        (DVec3::ZERO, [1.0, 0.125]),
        (2.0 * DVec3::X, [1.25_f64.sqrt(), 0.125]),
        (2.0 * DVec3::Y, [1.0, 0.265_625_f64.sqrt()]),
        (2.0 * DVec3::Z, [1.0, 0.125]),
        (4.0 * DVec3::Y, [1.0, 1.015_625_f64.sqrt()]),
    ] {
        let one = Particle { velocity, shape: sheet, ..particle([0.0, 0.0, -9.0]) };
        let mist = droplets(&one, &view, &look)[0];
        let LooseEllipse { a, b, e1, .. } = mist.ellipse;
        let upright = wide[1] > wide[0];
        let [long, short] = if upright { [wide[1], wide[0]] } else { wide };
        assert!((a.v - long).abs() < 1e-3 && (b.v - short).abs() < 1e-3, "{velocity}: {a:?} {b:?}");
        let along = if upright { e1.v.y } else { e1.v.x };
        assert!(along.abs() > 0.999, "{velocity}: {}", e1.v);
    }
}

/// Droplets of a strand lie in it. Droplets of a ball lie in the spindle, as without shapes.
#[test]
fn droplets_fill_their_shape() {
    let view = view(DVec2::splat(3.0), DVec2::ZERO, 101, 101);
    let look = Settings { droplets: 64, spread: 1.5, ..settings() };
    let at = DVec3::new(0.0, 0.0, -9.0);
    let strand = shaped([4.0, 0.5, 0.5], DVec3::Z, 0.6);
    let along = DVec3::new(0.6_f64.cos(), 0.6_f64.sin(), 0.0);
    let (mut squares, mut count) = ([0.0, 0.0], 0.0);
    for id in 0..60 {
        let one = Particle { id, density: 725.0, ..particle(at.to_array()) };
        let of = |shape| droplets(&Particle { shape, ..one }, &view, &look);
        for droplet in of(strand) {
            let off = droplet.ellipse.center.v - at;
            squares[0] += off.dot(along).powi(2);
            squares[1] += off.length_squared() - off.dot(along).powi(2);
            count += 1.0;
        }
        for (k, droplet) in of(BALL).iter().enumerate() {
            let random = |n| f64::from(classify::random(SEED, n, id));
            let ball = direction(random(5 * k as u32), random(5 * k as u32 + 1)).v
                * (0.75 * random(5 * k as u32 + 2).cbrt());
            let axis = direction(random(SPINDLE), random(SPINDLE + 1)).v;
            let wide = (1.0 + 5.0 * random(SPINDLE + 2)) / 6.0;
            let thin = wide * (0.4 * ball + 0.6 * ball.dot(axis) * axis);
            assert!((droplet.ellipse.center.v - at - thin).length() < 1e-6, "{id} {k}");
        }
    }
    // A ball with r = 0.75 has a variance of r^2/5 per axis; the squared factors are 0.49/16.5
    // times 16, and 1/4 for each of the other two axes.
    let of_ball = 0.75 * 0.75 / 5.0 * 0.49 / 16.5;
    let [long, wide] = squares.map(|sum| sum / count / of_ball);
    // Sampling error of about a thousand droplets.
    assert!((long / 16.0 - 1.0).abs() < 0.1 && (wide / 0.5 - 1.0).abs() < 0.1, "{long} {wide}");
}

/// Scattering takes the fourth root; without direct light there is none.
#[test]
fn scattering_brightens_the_shade() {
    for (direct, scattering, expected) in
        [(1.0, 0.7, 1.0), (0.0, 1.0, 0.0), (1.0 / 16.0, 1.0, 0.5), (1.0 / 16.0, 0.0, 1.0 / 16.0)]
    {
        assert!((scattered(exact(direct), scattering).v - expected).abs() < 1e-12);
    }
}

/// Spray that hardly moves is the same for every direction of motion, so a direction that
/// changes between frames does not make it flicker.
#[test]
fn clumps_do_not_turn_with_the_motion() {
    let base = settings();
    let look = Settings { droplets: 64, stretch: 0.02, mist: [0.9, 2.0], clumps: 2.0, ..base };
    let view = view(DVec2::splat(3.0), DVec2::ZERO, 101, 101);
    let image = |velocity: DVec3| {
        let one = Particle { velocity, density: 700.0, ..particle([0.2, -0.1, -9.0]) };
        let none = open(&view);
        spray(&[one], &view, &look, &none, &none).depth.data
    };
    let ways = [DVec3::X, DVec3::Y, DVec3::new(-0.6, 0.8, 0.0), DVec3::ZERO];
    let images = ways.map(|way| image(1.0e-4 * way));
    let sum: f64 = images[3].iter().sum();
    assert!(sum > 1.0, "{sum}");
    for (way, other) in ways.iter().zip(&images) {
        let apart: f64 = other.iter().zip(&images[3]).map(|(a, b)| (a - b).abs()).sum();
        assert!(apart < 1.0e-3 * sum, "{way}: {apart} of {sum}");
    }
}

#[test]
fn what_takes_no_part() {
    let (settings, view) = (settings(), view(DVec2::ONE, DVec2::ZERO, 17, 17));
    let good = particle([0.0, 0.0, -3.0]);
    for density in [850.0, 1000.0, f64::INFINITY, 0.0, -1.0, f64::NAN] {
        let none = total(&[Particle { density, ..good }], &view, &settings);
        assert_eq!(none, 0.0, "{density}");
    }
    assert!(total(&[Particle { density: 849.0, ..good }], &view, &settings) > 0.0);
    let (nan, far) = (DVec3::new(0.0, f64::NAN, 0.0), DVec3::new(-2e18, 0.0, 0.0));
    for bad in [
        Particle { position: nan, ..good },
        Particle { velocity: nan, ..good },
        Particle { velocity: far, ..good },
        particle([0.0, 0.0, -0.09]),
        particle([0.0, 0.0, 3.0]),
        // Nearer than twice the droplet's half-axis.
        particle([0.0, 0.0, -0.3]),
    ] {
        assert_eq!(total(&[bad], &view, &settings), 0.0, "{bad:?}");
    }
    let spread = Settings { spread: 6.1, ..settings };
    assert_eq!(total(&[good], &view, &spread), 0.0, "nearer than the spread");
    // Spray behind water fades completely, spray before it is unchanged.
    let none = open(&view);
    let of = |scene: f64, water: f64| {
        spray(&[good], &view, &settings, &none.map(|_| scene), &none.map(|_| water)).depth.data
    };
    assert_eq!(of(EMPTY, 3.0), of(EMPTY, EMPTY));
    assert!(of(EMPTY, 2.2).iter().chain(&of(2.9, EMPTY)).all(|v| *v == 0.0));
}

/// A matrix rounded to 16 bits.
fn held_shape(m: DMat3) -> DMat3 {
    DMat3::from_cols_array(&m.to_cols_array().map(|x| (x / 4.0 * 32767.0).round() * 4.0 / 32767.0))
}

/// A shape with these half-axes, rotated about an axis.
pub(super) fn shaped(axes: [f64; 3], about: DVec3, angle: f64) -> DMat3 {
    let r = DMat3::from_axis_angle(about.normalize(), angle);
    held_shape(r * DMat3::from_diagonal(axes.into()) * r.transpose())
}
