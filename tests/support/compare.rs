//! Comparisons. A failing comparison writes the actual and expected image and their difference as
//! EXR files, and statistics, to `test-output/`. Then it reports how many pixels fail, by how much,
//! and where.

use std::path::PathBuf;

use super::tolerance::{Between, U};
use crate::reference::{self, Census, Image};

fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("test-output");
    std::fs::create_dir_all(&folder).expect("test-output can be made");
    folder
}

fn write(name: &str, image: &Image<[f32; 4]>) {
    let file = folder().join(format!("{name}.exr"));
    let written = exr::prelude::write_rgba_file(&file, image.width, image.height, |x, y| {
        let [r, g, b, a] = image.at(x, y);
        (r, g, b, a)
    });
    if let Err(error) = written {
        eprintln!("{}: {error}", file.display());
    }
}

/// Writes the three images of a failed comparison, and returns their path.
fn triple(
    name: &str,
    actual: &Image<[f32; 4]>,
    expected: &Image<[f32; 4]>,
    census: &str,
) -> String {
    let difference = Image {
        width: actual.width,
        height: actual.height,
        data: (actual.data.iter().zip(&expected.data))
            .map(|(a, b)| [0, 1, 2, 3].map(|i| a[i] - b[i]))
            .collect(),
    };
    write(&format!("{name}-actual"), actual);
    write(&format!("{name}-expected"), expected);
    write(&format!("{name}-difference"), &difference);
    let _ = std::fs::write(folder().join(format!("{name}.txt")), census);
    folder().join(format!("{name}-*.exr")).display().to_string()
}

fn grey(image: &Image<f32>) -> Image<[f32; 4]> {
    image.map(|v| [*v, *v, *v, 1.0])
}

/// Asserts that no pixel differs from the twin's by more than its tolerance, and that at most
/// `coverage` pixels are empty in only one of the images.
pub fn close(
    name: &str,
    actual: &Image<f32>,
    expected: &Image<f64>,
    coverage: usize,
    tolerance: impl Fn(usize, usize, f64) -> f64,
) -> Census {
    let census = reference::compare(actual, expected, tolerance);
    if !census.passes(coverage) {
        let expected = expected.map(|v| *v as f32);
        let files = triple(name, &grey(actual), &grey(&expected), &census.to_string());
        panic!("{name}: {census}\nsee {files}");
    }
    census
}

/// Asserts that every pixel lies within its bounds.
pub fn between(name: &str, actual: &Image<f32>, bounds: &Between) {
    assert_eq!((actual.width, actual.height), (bounds.low.width, bounds.low.height), "{name}");
    let mut census = String::new();
    let mut failed = 0;
    let mut surfaces = 0;
    for (i, value) in actual.data.iter().enumerate() {
        let (low, high) = (bounds.low.data[i], bounds.high.data[i]);
        let value = f64::from(*value);
        surfaces += usize::from(value < 1e9);
        // EMPTY is rounded to single precision.
        if !(value >= low.min(1e10) && value <= high.max(low)) {
            failed += 1;
            if failed <= 8 {
                let (x, y) = (i % actual.width, i / actual.width);
                census += &format!("({x}, {y}): {value:e}, expected {low:e} to {high:e}\n");
            }
        }
    }
    if failed > 0 {
        let census =
            format!("{failed} of {} pixels, {surfaces} surfaces\n{census}", actual.data.len());
        let expected = bounds.low.map(|v| *v as f32);
        let files = triple(name, &grey(actual), &grey(&expected), &census);
        panic!("{name}: {census}see {files}");
    }
}

/// Asserts that two images are equal bit for bit.
pub fn same(name: &str, actual: &Image<f32>, expected: &Image<f32>) {
    same_color(name, &grey(actual), &grey(expected));
}

/// Asserts that two pictures are equal bit for bit.
pub fn same_color(name: &str, actual: &Image<[f32; 4]>, expected: &Image<[f32; 4]>) {
    assert_eq!((actual.width, actual.height), (expected.width, expected.height), "{name}");
    let bits = |c: &[f32; 4]| c.map(f32::to_bits);
    let differ: Vec<usize> = (0..actual.data.len())
        .filter(|i| bits(&actual.data[*i]) != bits(&expected.data[*i]))
        .collect();
    if let Some(first) = differ.first() {
        let census = format!(
            "{} of {} pixels differ, first at ({}, {}): {:?}, expected {:?}",
            differ.len(),
            actual.data.len(),
            first % actual.width,
            first / actual.width,
            actual.data[*first],
            expected.data[*first]
        );
        let files = triple(name, actual, expected, &census);
        panic!("{name}: {census}\nsee {files}");
    }
}

/// Asserts that two pictures are equal up to rounding: compilers may contract sums of products
/// differently in two pipelines. The bound is that of the twins of the shading, 400u of 1 plus the
/// channel's value. For pictures of a single pipeline use [`same_color`].
pub fn same_but_rounded(name: &str, actual: &Image<[f32; 4]>, expected: &Image<[f32; 4]>) {
    assert_eq!((actual.width, actual.height), (expected.width, expected.height), "{name}");
    let off = |i: usize| {
        let parts = actual.data[i].iter().zip(&expected.data[i]);
        // NaN equals NaN.
        parts.fold(0.0_f64, |most, (a, b)| match a.to_bits() == b.to_bits() {
            true => most,
            false => {
                let [a, b] = [f64::from(*a), f64::from(*b)];
                let part = (a - b).abs() / (400.0 * U * (1.0 + b.abs()));
                most.max(if part.is_nan() { f64::INFINITY } else { part })
            }
        })
    };
    let worst = (0..actual.data.len()).map(|i| (i, off(i))).max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((i, part)) = worst.filter(|(_, part)| *part > 1.0) {
        let (x, y) = (i % actual.width, i / actual.width);
        let (own, other) = (actual.data[i], expected.data[i]);
        let census =
            format!("({x}, {y}) is off by {part:.1} times the bound: {own:?}, expected {other:?}");
        let files = triple(name, actual, expected, &census);
        panic!("{name}: {census}\nsee {files}");
    }
}

/// Asserts that pictures agree within a tolerance per pixel and channel.
pub fn close_color(
    name: &str,
    actual: &Image<[f32; 4]>,
    expected: &Image<[f64; 4]>,
    tolerance: impl Fn(usize, usize) -> [f64; 4],
) -> Census {
    let mut worst: Option<Census> = None;
    for channel in 0..4 {
        let census = reference::compare(
            &actual.map(|c| c[channel]),
            &expected.map(|c| c[channel]),
            |x, y, _| tolerance(x, y)[channel],
        );
        if !census.passes(0) {
            let expected = expected.map(|c| c.map(|v| v as f32));
            let files = triple(name, actual, &expected, &census.to_string());
            panic!("{name}, channel {channel}: {census}\nsee {files}");
        }
        if worst.as_ref().is_none_or(|w| census.worst > w.worst) {
            worst = Some(census);
        }
    }
    worst.expect("four channels")
}
