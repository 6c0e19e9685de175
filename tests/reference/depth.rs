//! Twin of the depth splats (thesis Sec. 4.6.1): the nearest intersection of a pixel's ray with any
//! sphere. With the ray `w = (s_x, s_y, -1)`, `t w` has the depth t, and the near root is
//! `t = (w.c - sqrt(w^2 (r^2 - |c - w (w.c) / w^2|^2))) / w^2`.

use super::{EMPTY, Image, Sphere, View};
use glam::{DVec2, DVec3};

/// Depth at which a ray enters a sphere, if it meets it; negative behind the eye.
pub fn hit(ray: DVec3, sphere: &Sphere) -> Option<f64> {
    let length_squared = ray.length_squared();
    let middle = ray.dot(sphere.center) / length_squared;
    let away = (sphere.center - ray * middle).length_squared();
    let inside = sphere.radius * sphere.radius - away;
    (inside >= 0.0).then(|| middle - (inside / length_squared).sqrt())
}

/// Depth of the nearest sphere in each pixel. A hit before the near plane is dropped, and not
/// replaced by the far root.
pub fn splat(spheres: &[Sphere], view: &View) -> Image<f64> {
    splat_where(spheres, view, |_, _, _| true)
}

/// Depth of the nearest sphere among those that count at a pixel.
pub fn splat_where(
    spheres: &[Sphere],
    view: &View,
    counts: impl Fn(usize, usize, &Sphere) -> bool,
) -> Image<f64> {
    let near = view.near();
    let mut depth = Image::new(view.width, view.height, EMPTY);
    for sphere in spheres {
        let (center, r) = (sphere.center, sphere.radius);
        if -center.z + r < near {
            continue;
        }
        let (nearest, farthest) = (-center.z - r, -center.z + r);
        let (columns, rows) = view.footprint(center.truncate(), DVec2::splat(r), nearest, farthest);
        for y in rows {
            for x in columns.clone().filter(|x| counts(*x, y, sphere)) {
                if let Some(t) = hit(view.ray(x, y), sphere).filter(|t| *t >= near) {
                    let pixel = depth.at_mut(x, y);
                    *pixel = pixel.min(t);
                }
            }
        }
    }
    depth
}

#[cfg(test)]
mod tests {
    use super::super::is_surface;
    use super::super::tests::view;
    use super::*;

    #[test]
    fn every_hit_is_on_the_sphere_and_the_silhouette_is_its_cone() {
        let view = view(DVec2::new(0.9, -1.2), DVec2::new(0.2, -0.1), 64, 48);
        for center in [DVec3::new(0.3, -0.2, -4.0), DVec3::new(2.4, 1.9, -3.0)] {
            let sphere = Sphere { center, radius: 0.8 };
            let depth = splat(&[sphere], &view);
            let mut covered = 0;
            for (x, y) in (0..48).flat_map(|y| (0..64).map(move |x| (x, y))) {
                let ray = view.ray(x, y);
                let sine = (sphere.radius / center.length()).asin();
                assert_eq!(is_surface(depth.at(x, y)), ray.angle_between(center) < sine);
                if is_surface(depth.at(x, y)) {
                    covered += 1;
                    let point = ray * depth.at(x, y);
                    assert!(((point - center).length() - 0.8).abs() < 1e-12);
                    assert!((point - center).dot(ray) < 0.0, "the near root");
                }
            }
            assert!(covered > 100);
        }
    }

    #[test]
    fn the_nearest_counts_and_what_is_before_the_near_plane_does_not() {
        let view = view(DVec2::ONE, DVec2::ZERO, 5, 5);
        let at = |d: f64| Sphere { center: DVec3::new(0.0, 0.0, -d), radius: 1.0 };
        assert!((splat(&[at(7.0), at(5.0), at(9.0)], &view).at(2, 2) - 4.0).abs() < 1e-12);
        // The eye is inside, the near root lies before the near plane (0.1), or the sphere is
        // behind the eye.
        for d in [0.5, 1.05, -3.0] {
            assert_eq!(splat(&[at(d)], &view).at(2, 2), EMPTY);
        }
        assert!((splat(&[at(1.2)], &view).at(2, 2) - 0.2).abs() < 1e-12);
    }

    #[test]
    fn the_discriminant_keeps_its_digits() {
        let ray = DVec3::new(0.6, -0.7, -1.0);
        let sphere = Sphere { center: ray * 1e6, radius: 1.0 };
        let t = hit(ray, &sphere).unwrap_or(0.0);
        assert!((t - (1e6 - 1.0 / ray.length())).abs() < 1e-8);
    }
}
