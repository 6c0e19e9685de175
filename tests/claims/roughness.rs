//! World-space roughness of the smoothed surface: its pixels are back-projected and a plane is fitted by least squares;
//! the roughness is the RMS of the residuals along the plane's normal.

use glam::{DMat3, DMat4, DVec3, DVec4};
use whitewater::Camera;
use whitewater::headless::Picture;

/// Depth beyond which there is no surface.
const EMPTY: f32 = 1.0e9;

/// A rectangle around the middle of the plane z = 0, by half of its sides.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    pub x: f64,
    pub y: f64,
}

/// Results in a window.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// Mean square of the distances from the fitted plane.
    pub variance: f64,
    /// Mean of the planned iterations.
    pub iterations: f64,
}

/// Measures a layer of eye depths that covers the whole image.
///
/// Pixels count by the area of the plane they see, so that the near part of a slanted view weighs
/// no less than the far one.
pub fn measure(
    camera: &Camera,
    surface: &Picture<f32>,
    plan: &Picture<f32>,
    window: Window,
) -> Found {
    let (view, projection) =
        (camera.view_matrix().as_dmat4(), camera.projection_matrix().as_dmat4());
    let world = view.inverse();
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
        let corner = DVec3::new(x * window.x, y * window.y, 0.0);
        let ndc = (projection * view).project_point3(corner).truncate().abs();
        assert!(ndc.max_element() < 1.0, "the window is larger than the image: {ndc}");
    }
    let mut points = Vec::new();
    let (mut empty, mut iterations) = (0, 0.0);
    for y in 0..surface.height {
        for x in 0..surface.width {
            let ray = ray(&projection, surface, x, y);
            // The window is cut out of the ideal plane, not of the rough surface.
            let (eye, along) = (world.w_axis.truncate(), world.transform_vector3(ray));
            let t = -eye.z / along.z;
            let q = eye + t * along;
            if t <= 0.0 || q.x.abs() > window.x || q.y.abs() > window.y {
                continue;
            }
            let depth = *surface.at(x, y);
            if depth >= EMPTY {
                empty += 1;
                continue;
            }
            points.push((world.transform_point3(f64::from(depth) * ray), t.powi(3)));
            iterations += f64::from(*plan.at(x, y));
        }
    }
    assert!(points.len() > 64, "{} pixels in the window", points.len());
    // A hole is a silhouette, but only the bed is to be measured.
    assert!(empty * 50 < points.len(), "{empty} of {} pixels are empty", points.len());
    let iterations = iterations / points.len() as f64;
    Found { variance: detrended(&points), iterations }
}

/// Eye-space ray through the centre of a pixel, of unit depth.
pub fn ray(projection: &DMat4, image: &Picture<f32>, x: usize, y: usize) -> DVec3 {
    let ndc = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
    let clip = DVec4::new(ndc(x, image.width), ndc(y, image.height), 0.5, 1.0);
    let eye = projection.inverse() * clip;
    eye.truncate() / -eye.z
}

/// Mean square distance from the weighted least-squares plane z = a + b x + c y along its normal.
fn detrended(points: &[(DVec3, f64)]) -> f64 {
    let total: f64 = points.iter().map(|(_, w)| w).sum();
    let mean = points.iter().map(|(p, w)| *p * *w).sum::<DVec3>() / total;
    let mut normal = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for (p, w) in points {
        let row = DVec3::new(1.0, p.x - mean.x, p.y - mean.y);
        normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z) * *w;
        right += row * (p.z - mean.z) * *w;
    }
    let plane = normal.inverse() * right;
    let squares: f64 = points
        .iter()
        .map(|(p, w)| {
            let row = DVec3::new(1.0, p.x - mean.x, p.y - mean.y);
            (p.z - mean.z - plane.dot(row)).powi(2) * w
        })
        .sum();
    squares / total / (1.0 + plane.y.powi(2) + plane.z.powi(2))
}

/// A value with its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub value: f64,
    pub error: f64,
}

/// A function of sums over beds, with its standard error by leaving out each bed in turn (jackknife). It is also valid
/// for ratios between views of the same beds.
pub fn jackknife(beds: usize, of: impl Fn(&dyn Fn(usize) -> bool) -> f64) -> Estimate {
    let value = of(&|_| true);
    let left: Vec<f64> = (0..beds).map(|out| of(&|bed| bed != out)).collect();
    let mean = left.iter().sum::<f64>() / beds as f64;
    let spread: f64 = left.iter().map(|v| (v - mean).powi(2)).sum();
    Estimate { value, error: (spread * (beds as f64 - 1.0) / beds as f64).sqrt() }
}

/// A tilted plane with a known wave, as a camera would see it.
#[test]
fn the_measure_finds_a_known_roughness() {
    use super::bed;
    let extent = ash::vk::Extent2D { width: 256, height: 192 };
    let projection = bed::projection(30.0, extent);
    for slant in [0.0, 60.0] {
        let camera = bed::camera(2.0, slant, projection);
        let world = camera.view_matrix().as_dmat4().inverse();
        let eye = world.w_axis.truncate();
        let height = |p: DVec3| 0.01 * p.x + 0.003 * (40.0 * p.x).sin() * (40.0 * p.y).cos();
        let mut surface = Picture { width: 256, height: 192, data: vec![0.0; 256 * 192] };
        for y in 0..192 {
            for x in 0..256 {
                let along = world.transform_vector3(ray(
                    &camera.projection_matrix().as_dmat4(),
                    &surface,
                    x,
                    y,
                ));
                let mut t = -eye.z / along.z;
                for _ in 0..40 {
                    t = (height(eye + t * along) - eye.z) / along.z;
                }
                surface.data[y * 256 + x] = t as f32;
            }
        }
        // The window holds whole periods of the wave.
        let side = 2.0 * std::f64::consts::PI / 40.0;
        let found = measure(&camera, &surface, &surface, Window { x: side, y: side });
        let rms = found.variance.sqrt();
        assert!((rms / 0.0015 - 1.0).abs() < 0.02, "slant {slant}: {rms}");
    }
}
