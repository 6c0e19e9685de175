//! Estimates of rest spacing and densities in cases with a known answer.

use whitewater::io::particles::{estimate_densities, estimate_spacing};

/// A cubic lattice whose points are displaced by pseudo-random numbers.
fn grid(n: usize, spacing: f32, noise: f32) -> Vec<[f32; 3]> {
    let mut seed = 1_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    (0..n * n * n)
        .map(|i| [i % n, i / n % n, i / n / n].map(|c| spacing * (c as f32 + noise * random())))
        .collect()
}

fn close(found: Option<f32>, expected: f32, tolerance: f32) {
    let error = found.unwrap_or(f32::NAN) / expected - 1.0;
    assert!(error.abs() <= tolerance, "{found:?} for {expected}: {:+.1} %", 100.0 * error);
}

#[test]
fn grids() {
    for spacing in [1e-6, 0.025, 1.0, 3e4] {
        close(estimate_spacing(&grid(12, spacing, 0.0)), spacing, 1e-3);
        close(estimate_spacing(&grid(12, spacing, 0.2)), spacing, 0.05);
    }
}

#[test]
fn strays_doubles_and_no_numbers() {
    let mut points = grid(20, 0.05, 0.0);
    points.extend([
        [1e6, 0.0, 0.0],
        [-3e8, 1.0, 1.0],
        [0.0, 1e30, 0.0],
        [f32::MAX; 3],
        [f32::NAN; 3],
        [f32::INFINITY, 0.0, 0.0],
    ]);
    points.extend_from_within(..500);
    close(estimate_spacing(&points), 0.05, 1e-3);
    assert_eq!(estimate_spacing(&points), estimate_spacing(&points));
}

#[test]
fn thin_and_few() {
    let sheet: Vec<_> = grid(30, 0.1, 0.0).into_iter().filter(|p| p[1] == 0.0).collect();
    close(estimate_spacing(&sheet), 0.1, 1e-3);
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    close(estimate_spacing(&square), std::f32::consts::SQRT_2, 1e-3);
    close(estimate_spacing(&square[..2]), 1.0, 1e-6);
    assert_eq!(estimate_spacing(&square[..1]), None);
    assert_eq!(estimate_spacing(&[]), None);
    assert_eq!(estimate_spacing(&[[1.0; 3]; 10]), None);
    assert_eq!(estimate_spacing(&[[f32::NAN; 3]; 10]), None);
}

#[test]
fn a_million() {
    let points = grid(100, 0.025, 0.3);
    let start = std::time::Instant::now();
    let spacing = estimate_spacing(&points);
    let took = start.elapsed();
    println!("{} particles: {spacing:?} in {took:?}", points.len());
    close(spacing, 0.025, 0.1);
    // A generous limit: test machines are shared, and this build is not optimised.
    assert!(took.as_secs_f32() < 20.0, "{took:?}");
}

/// Values of the cubic spline by hand: W(0) = 1/π, W(1) = 1/4π, W(√2) = 0.25 (2 - √2)³ / π.
#[test]
fn densities_of_few_and_of_many() {
    let pi = std::f64::consts::PI;
    let close = |found: f32, expected: f64| {
        assert!((f64::from(found) - expected).abs() < 2e-5, "{found} for {expected}");
    };
    for spacing in [1e-3_f32, 0.05, 40.0] {
        let at = |x: f32, y: f32, z: f32| [x * spacing, y * spacing, z * spacing];
        let isolated = [at(7.0, 3.0, -9.0), [f32::NAN; 3], [1e30; 3], [f32::INFINITY, 0.0, 0.0]];
        let found = estimate_densities(&isolated, spacing);
        close(found[0], 1.0 / pi);
        assert_eq!([found[1], found[3]], [0.0; 2], "no positions");
        close(found[2], 1.0 / pi);
        let line: Vec<_> = (-9..9).map(|i| at(i as f32, 0.0, 0.0)).collect();
        close(estimate_densities(&line, spacing)[9], 1.5 / pi);
        let sheet: Vec<_> = (0..81).map(|i| at((i % 9) as f32, 0.0, (i / 9) as f32)).collect();
        let corner = 0.25 * (2.0 - 2.0_f64.sqrt()).powi(3);
        close(estimate_densities(&sheet, spacing)[40], (2.0 + 4.0 * corner) / pi);
        let full = estimate_densities(&grid(9, spacing, 0.0), spacing)[4 * 91];
        assert!((0.98..1.02).contains(&full), "{full}");
    }
    assert!(estimate_densities(&[], 1.0).is_empty());
}

/// Pieces that repeat all particles: each position occurs four times.
#[test]
fn copies_are_no_neighbours() {
    let block: Vec<_> =
        (0..4096).map(|i| [i % 16, i / 16 % 16, i / 256].map(|c| 0.04 * c as f32)).collect();
    let found = estimate_spacing(&block.repeat(4)).unwrap();
    assert!((found / 0.04 - 1.0).abs() < 1e-3, "{found}");
    assert_eq!(found, estimate_spacing(&block).unwrap());
}
