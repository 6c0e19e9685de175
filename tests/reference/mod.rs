//! CPU twins: each pass computed in plain `f64` from its equations, to check the GPU's images.
//!
//! Conventions. Eye space is right-handed, the camera looks along -z, and y is up. A depth is the
//! positive eye depth `d = -z`, or [`EMPTY`] where nothing is visible. Clip space is Vulkan's: row
//! 0 of an image is at ndc y = -1, and device depth lies in 0..1; the projection may reverse it or
//! have no far plane. Pixel centres are at +0.5.

use glam::{DMat4, DVec2, DVec3};
use std::fmt;
use std::ops::Range;

pub mod bubbles;
pub mod classify;
pub mod composite;
pub mod convolution;
pub mod cull;
pub mod depth;
pub mod environment;
pub mod generate;
pub mod levels;
pub mod light;
pub mod motion;
pub mod noise;
pub mod panes;
pub mod reduce;
pub mod shape;
pub mod sheets;
pub mod shore;
pub mod smooth;
pub mod spray;
pub mod surface;
pub mod surface_foam;
pub mod thickness;
pub mod wavelets;
pub mod whitewater;
pub mod whole_steps;

/// The depth of a pixel without a surface.
pub const EMPTY: f64 = 1e10;

/// Whether a depth belongs to a surface. [`EMPTY`] rounded to single precision does not.
pub fn is_surface(depth: f64) -> bool {
    depth < 1e9
}

/// A sphere in eye space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre; z is negative before the camera.
    pub center: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// A row-major image, row 0 at the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<T> {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` values.
    pub data: Vec<T>,
}

impl<T: Clone> Image<T> {
    /// An image of one value.
    pub fn new(width: usize, height: usize, value: T) -> Self {
        let data = vec![value; width * height];
        Self { width, height, data }
    }

    /// The image with these values, or None if their number is not `width * height`.
    pub fn from_vec(width: usize, height: usize, data: Vec<T>) -> Option<Self> {
        (data.len() == width * height).then_some(Self { width, height, data })
    }

    /// The value at (x, y) of the nearest pixel inside.
    pub fn clamped(&self, x: isize, y: isize) -> T {
        let x = x.clamp(0, self.width as isize - 1) as usize;
        let y = y.clamp(0, self.height as isize - 1) as usize;
        self.data[y * self.width + x].clone()
    }

    /// The value at (x, y), or None outside.
    pub fn checked(&self, x: isize, y: isize) -> Option<T> {
        let inside = x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height;
        inside.then(|| self.data[y as usize * self.width + x as usize].clone())
    }

    /// The value at (x, y), which must be inside.
    pub fn at(&self, x: usize, y: usize) -> T {
        assert!(x < self.width && y < self.height, "({x}, {y}) is outside the image");
        self.data[y * self.width + x].clone()
    }

    /// A mutable reference to the value at (x, y).
    pub fn at_mut(&mut self, x: usize, y: usize) -> &mut T {
        assert!(x < self.width && y < self.height, "({x}, {y}) is outside the image");
        &mut self.data[y * self.width + x]
    }

    /// The image of a function of each value, for example one channel.
    pub fn map<U>(&self, f: impl Fn(&T) -> U) -> Image<U> {
        Image { width: self.width, height: self.height, data: self.data.iter().map(f).collect() }
    }

    /// The four texels that bilinear filtering uses at a position in pixels, clamped to the image,
    /// in the order (0,0), (1,0), (0,1), (1,1), and their weights.
    pub fn bilinear(&self, position: DVec2) -> [(isize, isize, f64); 4] {
        let h = position - 0.5;
        let (i, f) = (h.floor(), h - h.floor());
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| {
            let x = (i.x as isize + dx).clamp(0, self.width as isize - 1);
            let y = (i.y as isize + dy).clamp(0, self.height as isize - 1);
            let weight_x = if dx == 0 { 1.0 - f.x } else { f.x };
            let weight_y = if dy == 0 { 1.0 - f.y } else { f.y };
            (x, y, weight_x * weight_y)
        })
    }
}

impl<T: Send> Image<T> {
    /// The image of a function of the pixel, computed by all cores.
    pub fn from_fn(width: usize, height: usize, f: impl Fn(usize, usize) -> T + Sync) -> Self {
        let rows = |rows: Range<usize>| -> Vec<T> {
            rows.flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| f(x, y)).collect()
        };
        let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
        if cores == 1 || width * height < 16384 {
            return Self { width, height, data: rows(0..height) };
        }
        let chunk = height.div_ceil(cores);
        let data = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..height)
                .step_by(chunk)
                .map(|y| {
                    let rows = &rows;
                    scope.spawn(move || rows(y..(y + chunk).min(height)))
                })
                .collect();
            workers
                .into_iter()
                .flat_map(|worker| {
                    worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
                })
                .collect()
        });
        Self { width, height, data }
    }
}

/// A camera and the size of its image.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// World to eye space.
    pub view: DMat4,
    /// Eye to Vulkan clip space, a perspective one.
    pub projection: DMat4,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl View {
    /// A view, or an error for a projection that is not supported.
    ///
    /// # Errors
    /// The projection is orthographic, skewed or not finite, or the image is empty.
    pub fn new(
        view: DMat4,
        projection: DMat4,
        width: usize,
        height: usize,
    ) -> Result<Self, String> {
        let p = projection;
        let w = p.row(3).to_array();
        if w != [0.0, 0.0, -1.0, 0.0] {
            return Err(format!("a perspective projection has w = -z, found the row {w:?}"));
        }
        let skew = [p.x_axis.y, p.y_axis.x, p.w_axis.x, p.w_axis.y, p.x_axis.z, p.y_axis.z];
        if skew != [0.0; 6] || p.x_axis.x == 0.0 || p.y_axis.y == 0.0 || p.w_axis.z == 0.0 {
            return Err(format!("expected a perspective projection without skew, found {p}"));
        }
        if !p.is_finite() || !view.is_finite() || width == 0 || height == 0 {
            return Err("expected finite matrices and an image of one pixel at least".into());
        }
        Ok(Self { view, projection, width, height })
    }

    /// The extent in pixels.
    pub fn extent(&self) -> DVec2 {
        DVec2::new(self.width as f64, self.height as f64)
    }

    /// P00 and P11, with their signs.
    pub(crate) fn focal(&self) -> DVec2 {
        DVec2::new(self.projection.x_axis.x, self.projection.y_axis.y)
    }

    /// P20 and P21: the off-axis shift.
    pub(crate) fn shift(&self) -> DVec2 {
        DVec2::new(self.projection.z_axis.x, self.projection.z_axis.y)
    }

    /// The eye ray through the centre of a pixel, see [`View::ray_at`].
    pub fn ray(&self, x: usize, y: usize) -> DVec3 {
        self.ray_at(DVec2::new(x as f64 + 0.5, y as f64 + 0.5))
    }

    /// The eye ray (s_x, s_y, -1) through a position in pixels. Multiplied by a depth d it is the
    /// point seen there: `ndc = (P00 x + P20 z) / -z = P00 s_x - P20`, hence
    /// `s_x = (ndc + P20) / P00`.
    pub fn ray_at(&self, position: DVec2) -> DVec3 {
        let ndc = 2.0 * position / self.extent() - 1.0;
        ((ndc + self.shift()) / self.focal()).extend(-1.0)
    }

    /// The position in pixels of a slope (x/d, y/d): the inverse of [`View::ray_at`].
    pub fn pixel_of_slope(&self, slope: DVec2) -> DVec2 {
        (slope * self.focal() - self.shift() + 1.0) * 0.5 * self.extent()
    }

    /// The position in pixels of an eye-space point in front of the camera.
    pub fn project(&self, point: DVec3) -> DVec2 {
        self.pixel_of_slope(point.truncate() / -point.z)
    }

    /// The signed change of a ray's slope per pixel, along x and along y.
    pub fn slope_step(&self) -> DVec2 {
        2.0 / (self.extent() * self.focal())
    }

    /// The eye depth of a device depth: `z = (P22 z_eye + P32) / d = -P22 + P32 / d`.
    pub fn eye_depth(&self, device_depth: f64) -> f64 {
        self.projection.w_axis.z / (device_depth + self.projection.z_axis.z)
    }

    /// The device depth of an eye depth.
    pub fn device_depth(&self, eye_depth: f64) -> f64 {
        self.projection.w_axis.z / eye_depth - self.projection.z_axis.z
    }

    /// Eye depth of the near plane, also for reversed depth: the nearer of the planes with device
    /// depth 0 and 1 (an infinite far plane gives infinity or a negative number).
    pub fn near(&self) -> f64 {
        let planes = [self.eye_depth(0.0), self.eye_depth(1.0)];
        planes.into_iter().filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min)
    }

    /// Eye depth of the far plane, or None if it is at infinity (or beyond).
    pub fn far(&self) -> Option<f64> {
        let (a, b) = (self.eye_depth(0.0), self.eye_depth(1.0));
        (a.is_finite() && b.is_finite() && a > 0.0 && b > 0.0).then(|| a.max(b))
    }

    /// C_x: world width of a pixel at depth 1.
    pub fn c_x(&self) -> f64 {
        self.slope_step().x.abs()
    }

    /// C_y: world height of a pixel at depth 1.
    pub fn c_y(&self) -> f64 {
        self.slope_step().y.abs()
    }

    /// The view of an image whose pixels are blocks of `2^level` pixels of this one. For an odd
    /// extent the last blocks extend beyond it, and the projection is wider by
    /// `k = ceil(w / 2^level) 2^level / w`. So its rays pass through the blocks' centres,
    /// `ndc = 2 (i + 0.5) 2^level / w - 1 = k ndc' + k - 1`, and its C is `2 2^level / (w |P00|)`.
    pub fn reduced(&self, level: u32) -> Self {
        let block = 1_usize << level;
        let (width, height) = (self.width.div_ceil(block), self.height.div_ceil(block));
        let k = DVec2::new((width * block) as f64, (height * block) as f64) / self.extent();
        let (focal, shift) = (self.focal() / k, (self.shift() + k - 1.0) / k);
        let mut projection = self.projection;
        projection.x_axis.x = focal.x;
        projection.y_axis.y = focal.y;
        projection.z_axis.x = shift.x;
        projection.z_axis.y = shift.y;
        Self { view: self.view, projection, width, height }
    }

    /// The pixels that may see a part of a box in eye space, given by its centre and half extent in
    /// x and y and its nearest and farthest depth. All pixels if the box comes near the eye's
    /// plane.
    pub fn footprint(
        &self,
        middle: DVec2,
        half: DVec2,
        nearest: f64,
        farthest: f64,
    ) -> (Range<usize>, Range<usize>) {
        if nearest <= 1e-6 * farthest.abs() {
            return (0..self.width, 0..self.height);
        }
        let corners = [(middle - half) / nearest, (middle - half) / farthest];
        let others = [(middle + half) / nearest, (middle + half) / farthest];
        let a = self.pixel_of_slope(corners[0].min(corners[1]));
        let b = self.pixel_of_slope(others[0].max(others[1]));
        // One pixel is added; a negative focal length swaps the two corners. The casts saturate.
        let (low, high) = (a.min(b) - 1.5, a.max(b) + 1.5);
        let range = |low: f64, high: f64, extent: usize| {
            let start = (low.max(0.0) as usize).min(extent);
            start..(high.max(0.0).ceil() as usize).clamp(start, extent)
        };
        (range(low.x, high.x, self.width), range(low.y, high.y, self.height))
    }
}

/// The cubic step of GLSL and HLSL.
pub fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Upper ends of the bins of [`Census::histogram`], in multiples of the tolerance; the last bin
/// holds the rest.
pub const BINS: [f64; 7] = [0.01, 0.1, 0.25, 0.5, 1.0, 2.0, 10.0];

/// Result of [`compare`].
#[derive(Clone, Debug)]
pub struct Census {
    /// Pixels with a value in both images.
    pub compared: usize,
    /// Pixels whose error exceeds the tolerance or is NaN.
    pub failed: usize,
    /// Pixels that are empty in only one image; a few of them at outlines are normal.
    pub coverage_mismatch: usize,
    /// Pixels empty in both images.
    pub empty: usize,
    /// The largest error in multiples of its tolerance; infinite for a NaN.
    pub worst: f64,
    /// The pixel with that error, its actual and its expected value.
    pub worst_at: Option<(usize, usize, f64, f64)>,
    /// The first pixel that is empty in only one image.
    pub mismatch_at: Option<(usize, usize, f64, f64)>,
    /// The mean absolute error of the compared pixels that are numbers.
    pub mean_abs: f64,
    /// Pixels by error in multiples of the tolerance, see [`BINS`].
    pub histogram: [usize; BINS.len() + 1],
}

impl Census {
    /// Whether no compared pixel failed, and at most `coverage_mismatch` pixels are empty in only
    /// one image.
    pub fn passes(&self, coverage_mismatch: usize) -> bool {
        self.failed == 0 && self.coverage_mismatch <= coverage_mismatch
    }
}

impl fmt::Display for Census {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            out,
            "{} of {} pixels failed, {} differ in coverage, {} are empty; mean error {:.3e}",
            self.failed, self.compared, self.coverage_mismatch, self.empty, self.mean_abs
        )?;
        if let Some((x, y, actual, expected)) = self.worst_at {
            writeln!(
                out,
                "worst: {:.3} tolerances at ({x}, {y}): {actual:e}, expected {expected:e}",
                self.worst
            )?;
        }
        if let Some((x, y, actual, expected)) = self.mismatch_at {
            writeln!(out, "coverage: first at ({x}, {y}): {actual:e}, expected {expected:e}")?;
        }
        write!(out, "errors in tolerances:")?;
        for (bin, count) in self.histogram.iter().enumerate() {
            match BINS.get(bin) {
                Some(end) => write!(out, "  <={end}: {count}")?,
                None => write!(out, "  more: {count}")?,
            }
        }
        Ok(())
    }
}

/// Compares an image with its twin. `tolerance(x, y, expected)` is the max error of a pixel. Values
/// of 1e9 or more are empty. Both images must have the same size.
pub fn compare(
    actual: &Image<f32>,
    expected: &Image<f64>,
    tolerance: impl Fn(usize, usize, f64) -> f64,
) -> Census {
    assert_eq!((actual.width, actual.height), (expected.width, expected.height), "extents");
    let mut census = Census {
        compared: 0,
        failed: 0,
        coverage_mismatch: 0,
        empty: 0,
        worst: 0.0,
        worst_at: None,
        mismatch_at: None,
        mean_abs: 0.0,
        histogram: [0; BINS.len() + 1],
    };
    let mut sum = 0.0;
    let mut numbers = 0_usize;
    for y in 0..actual.height {
        for x in 0..actual.width {
            let (a, e) = (f64::from(actual.at(x, y)), expected.at(x, y));
            match (a >= 1e9, e >= 1e9) {
                (true, true) => census.empty += 1,
                (false, false) => {
                    let error = (a - e).abs();
                    let ratio = match error / tolerance(x, y, e) {
                        _ if error == 0.0 => 0.0,
                        ratio if ratio.is_nan() => f64::INFINITY,
                        ratio => ratio,
                    };
                    census.compared += 1;
                    census.failed += usize::from(ratio > 1.0);
                    let bin = BINS.iter().position(|end| ratio <= *end).unwrap_or(BINS.len());
                    census.histogram[bin] += 1;
                    if error.is_finite() {
                        sum += error;
                        numbers += 1;
                    }
                    if ratio > census.worst || census.worst_at.is_none() {
                        census.worst = ratio;
                        census.worst_at = Some((x, y, a, e));
                    }
                }
                _ => {
                    census.coverage_mismatch += 1;
                    census.mismatch_at.get_or_insert((x, y, a, e));
                }
            }
        }
    }
    census.mean_abs = sum / numbers.max(1) as f64;
    census
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use glam::DVec4;

    /// Kind of device depth of a test projection.
    #[derive(Clone, Copy, PartialEq)]
    pub(crate) enum Depth {
        Standard,
        Reversed,
        StandardInfinite,
        ReversedInfinite,
    }

    /// A projection with near plane 0.1 and far plane 1000.
    pub(crate) fn projection(focal: DVec2, shift: DVec2, depth: Depth) -> DMat4 {
        let (n, f) = (0.1, 1000.0);
        let (p22, p32) = match depth {
            Depth::Standard => (f / (n - f), n * f / (n - f)),
            Depth::Reversed => (n / (f - n), n * f / (f - n)),
            Depth::StandardInfinite => (-1.0, -n),
            Depth::ReversedInfinite => (0.0, n),
        };
        DMat4::from_cols(
            DVec4::new(focal.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, focal.y, 0.0, 0.0),
            DVec4::new(shift.x, shift.y, p22, -1.0),
            DVec4::new(0.0, 0.0, p32, 0.0),
        )
    }

    /// A view along -z of the world.
    pub(crate) fn view(focal: DVec2, shift: DVec2, width: usize, height: usize) -> View {
        let projection = projection(focal, shift, Depth::ReversedInfinite);
        View::new(DMat4::IDENTITY, projection, width, height).expect("a valid view")
    }

    const DEPTHS: [Depth; 4] =
        [Depth::Standard, Depth::Reversed, Depth::StandardInfinite, Depth::ReversedInfinite];

    #[test]
    fn rays_project_back_to_their_pixels() {
        for depth in DEPTHS {
            for focal in [DVec2::new(1.3, -1.9), DVec2::new(-0.7, 2.0)] {
                let p = projection(focal, DVec2::new(0.31, -0.17), depth);
                let view = View::new(DMat4::IDENTITY, p, 37, 21).expect("a valid view");
                for (x, y, d) in [(0, 0, 0.5), (36, 20, 3.0), (11, 19, 700.0)] {
                    let point = view.ray(x, y) * d;
                    let clip = p * point.extend(1.0);
                    assert!((clip.w - d).abs() < 1e-12 * d);
                    let pixel = (clip.truncate() / clip.w).truncate() * 0.5 + 0.5;
                    let pixel = pixel * view.extent();
                    assert!((pixel - DVec2::new(x as f64 + 0.5, y as f64 + 0.5)).length() < 1e-9);
                    assert!((view.project(point) - pixel).length() < 1e-9);
                    assert!((view.eye_depth(clip.z / clip.w) / d - 1.0).abs() < 1e-7);
                    assert!((view.device_depth(d) - clip.z / clip.w).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn near_and_far_follow_the_projection() {
        for depth in DEPTHS {
            let p = projection(DVec2::ONE, DVec2::ZERO, depth);
            let view = View::new(DMat4::IDENTITY, p, 4, 4).expect("a valid view");
            assert!((view.near() - 0.1).abs() < 1e-12);
            match depth {
                Depth::Standard | Depth::Reversed => {
                    assert!(view.far().is_some_and(|far| (far - 1000.0).abs() < 1e-6));
                }
                _ => assert!(view.far().is_none()),
            }
        }
        // A far plane slightly beyond infinity.
        let mut p = projection(DVec2::ONE, DVec2::ZERO, Depth::StandardInfinite);
        p.z_axis.z += 1e-6;
        let view = View::new(DMat4::IDENTITY, p, 4, 4).expect("a valid view");
        assert!((view.near() - 0.1).abs() < 1e-6 && view.far().is_none());
    }

    #[test]
    fn a_reduced_pixel_looks_through_the_middle_of_its_block() {
        let full = view(DVec2::new(1.3, -1.9), DVec2::new(0.31, -0.17), 37, 21);
        for level in 0..4 {
            let reduced = full.reduced(level);
            let block = f64::from(1 << level);
            assert_eq!(reduced.width, 37_usize.div_ceil(1 << level));
            assert!((reduced.c_x() - 2.0 * block / (37.0 * 1.3)).abs() < 1e-12);
            assert!((reduced.c_y() - 2.0 * block / (21.0 * 1.9)).abs() < 1e-12);
            for (x, y) in [(0, 0), (reduced.width - 1, reduced.height - 1)] {
                let middle = DVec2::new((x as f64 + 0.5) * block, (y as f64 + 0.5) * block);
                assert!((reduced.ray(x, y) - full.ray_at(middle)).length() < 1e-12);
            }
            let step = (reduced.ray(1, 1) - reduced.ray(0, 0)).truncate();
            assert!((step - reduced.slope_step()).length() < 1e-12);
        }
    }

    #[test]
    fn other_projections_are_refused() {
        let orthographic = DMat4::from_scale(DVec3::new(1.0, 1.0, -0.1));
        assert!(View::new(DMat4::IDENTITY, orthographic, 4, 4).is_err());
        let p = projection(DVec2::ONE, DVec2::ZERO, Depth::Reversed);
        assert!(View::new(DMat4::IDENTITY, p, 0, 4).is_err());
    }

    #[test]
    fn a_census_counts() {
        let expected = Image::from_vec(3, 2, vec![1.0, 2.0, EMPTY, EMPTY, 5.0, 6.0]);
        let actual = Image::from_vec(3, 2, vec![1.0_f32, 2.5, 1e10, 4.0, f32::NAN, 6.125]);
        let (expected, actual) = (expected.expect("6 values"), actual.expect("6 values"));
        let census = compare(&actual, &expected, |_, _, _| 0.25);
        assert_eq!((census.compared, census.failed, census.empty), (4, 2, 1));
        assert_eq!(
            (census.coverage_mismatch, census.worst_at.map(|w| (w.0, w.1))),
            (1, Some((1, 1)))
        );
        assert!((census.mean_abs - 0.625 / 3.0).abs() < 1e-12);
        assert_eq!(census.histogram, [1, 0, 0, 1, 0, 1, 0, 1]);
        assert!(census.worst.is_infinite() && !census.passes(9));
        assert!(census.to_string().contains("2 of 4 pixels failed"));
    }
}
