//! Twin of the thickness splats (thesis Sec. 3.2.2, 4.8.1): the sum over all particles of
//! `amplitude sqrt(1 - rho^2) exp(-2 rho^2)`. rho is the distance from the centre of the pixel
//! ray's point at the centre's depth, in half-axes of two radii.

use super::{Image, Sphere, View};
use glam::DVec2;
use std::f64::consts::PI;

/// J, the integral of `sqrt(1 - u) exp(-2 u)` over u = 0..1; a splat's integral is pi J a b.
pub const J: f64 = 0.3400030;

/// Amplitude of a splat.
#[derive(Clone, Copy, Debug)]
pub enum Amplitude {
    /// Its integral over the plane is the particle's volume, so the thickness is a length of water
    /// in scene units.
    Volume {
        /// Mass over density, or the cubed spacing.
        particle_volume: f64,
    },
    /// As in the source, `0.8 * 2 a`, in its arbitrary unit.
    Source {
        /// a, the half-axis of a whole particle's splat.
        particle_size: f64,
    },
}

/// The kernel at a distance in half-axes.
pub fn kernel(rho_squared: f64) -> f64 {
    (1.0 - rho_squared).max(0.0).sqrt() * (-2.0 * rho_squared).exp()
}

/// The drawn half-axis: a sprite narrower than a pixel is widened to a pixel and keeps its volume.
pub fn drawn_axis(half: f64, depth: f64, view: &View) -> f64 {
    half.max(depth * view.c_x().max(view.c_y()))
}

/// The thickness along z in each pixel. A particle counts if its centre lies behind the near plane
/// and before the scene (given at the image's resolution).
pub fn splat(
    spheres: &[Sphere],
    view_of_the_image: &View,
    scene: Option<&Image<f64>>,
    amplitude: Amplitude,
) -> Image<f64> {
    splat_where(spheres, view_of_the_image, scene, amplitude, |_, _, _| 1.0)
}

/// Thickness of spheres of which only a fraction counts at a pixel.
pub fn splat_where(
    spheres: &[Sphere],
    view_of_the_image: &View,
    scene: Option<&Image<f64>>,
    amplitude: Amplitude,
    share: impl Fn(usize, usize, &Sphere) -> f64,
) -> Image<f64> {
    let view = view_of_the_image;
    let near = view.near();
    let mut thickness = Image::new(view.width, view.height, 0.0);
    for sphere in spheres {
        let (center, depth) = (sphere.center.truncate(), -sphere.center.z);
        let whole = 2.0 * sphere.radius;
        if depth < near || whole <= 0.0 {
            continue;
        }
        let half = drawn_axis(whole, depth, view);
        let amplitude = match amplitude {
            Amplitude::Volume { particle_volume } => particle_volume / (PI * J * half * half),
            Amplitude::Source { particle_size } => {
                0.8 * 2.0 * particle_size * (whole / half).powi(2)
            }
        };
        let (columns, rows) = view.footprint(center, DVec2::splat(half), depth, depth);
        for y in rows {
            for x in columns.clone() {
                if scene.is_some_and(|scene| scene.at(x, y) <= depth) {
                    continue;
                }
                let q = view.ray(x, y).truncate() * depth;
                let rho_squared = (q - center).length_squared() / (half * half);
                if rho_squared <= 1.0 {
                    let splat = amplitude * kernel(rho_squared);
                    *thickness.at_mut(x, y) += splat * share(x, y, sphere);
                }
            }
        }
    }
    thickness
}

#[cfg(test)]
mod tests {
    use super::super::tests::view;
    use super::*;
    use glam::DVec3;

    #[test]
    fn j_is_the_integral_of_the_kernel() {
        // The substitution u = 1 - v^2 removes the root's singular end.
        let n = 10_000;
        let sum: f64 = (0..n)
            .map(|i| (f64::from(i) + 0.5) / f64::from(n))
            .map(|v| 2.0 * v * v * (-2.0 * (1.0 - v * v)).exp())
            .sum();
        assert!((sum / f64::from(n) - J).abs() < 1e-7);
    }

    #[test]
    fn the_integral_over_the_plane_is_the_volume() {
        let view = view(DVec2::new(1.1, -1.4), DVec2::new(0.2, -0.1), 301, 203);
        for (x, y, d) in [(0.3, -0.2, 4.0), (1.5, 1.2, 6.0)] {
            let sphere = Sphere { center: DVec3::new(x, y, -d), radius: 0.5 };
            let volume = Amplitude::Volume { particle_volume: 0.3 };
            let thickness = splat(&[sphere, sphere], &view, None, volume);
            let pixel = view.c_x() * view.c_y() * d * d;
            let integral = thickness.data.iter().sum::<f64>() * pixel;
            assert!((integral / 0.6 - 1.0).abs() < 2e-3, "{integral}");
            let peak = thickness.data.iter().copied().fold(0.0, f64::max);
            assert!((peak / (0.6 / (PI * J)) - 1.0).abs() < 1e-3, "{peak}");
        }
    }

    #[test]
    fn a_source_splat_holds_about_four_particles() {
        let view = view(DVec2::new(1.1, -1.1), DVec2::ZERO, 301, 301);
        let sphere = Sphere { center: DVec3::new(0.0, 0.0, -6.0), radius: 0.656 };
        let source = Amplitude::Source { particle_size: 2.0 * 0.656 };
        let thickness = splat(&[sphere], &view, None, source);
        let integral = thickness.data.iter().sum::<f64>() * view.c_x() * view.c_y() * 36.0;
        assert!((integral - 3.86).abs() < 0.02, "{integral}");
    }

    #[test]
    fn the_centre_is_tested_against_the_scene() {
        let view = view(DVec2::ONE, DVec2::ZERO, 32, 32);
        let sphere = Sphere { center: DVec3::new(0.0, 0.0, -4.0), radius: 1.0 };
        let scene = Image::from_fn(32, 32, |x, _| if x < 16 { 3.9 } else { 4.1 });
        let unit = Amplitude::Source { particle_size: 1.0 };
        let (cut, whole) =
            (splat(&[sphere], &view, Some(&scene), unit), splat(&[sphere], &view, None, unit));
        for (x, y) in (0..32).flat_map(|y| (0..32).map(move |x| (x, y))) {
            assert_eq!(cut.at(x, y), if x < 16 { 0.0 } else { whole.at(x, y) });
        }
        assert!(cut.at(16, 16) > 1.5);
        let behind = Sphere { center: DVec3::new(0.0, 0.0, 1.0), radius: 2.0 };
        assert!(splat(&[behind], &view, None, unit).data.iter().all(|t| *t == 0.0));
    }
}
