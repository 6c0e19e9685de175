//! The guess at the rest spacing where the answer is known.

use whitewater::io::particles::estimate_spacing;

/// A cubic grid, moved a little by a hash.
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
    // Generous: test machines are shared, and this build is not optimised.
    assert!(took.as_secs_f32() < 20.0, "{took:?}");
}
