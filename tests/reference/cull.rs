//! Twin of the culling (thesis Sec. 4.3): bounding spheres against the frustum, spray selected by
//! density, and the radius of thin water,
//! `r (0.5 + 0.5 smoothstep(threshold, full, density / rest))`.

use super::{Sphere, View, smoothstep};
use glam::{DVec3, DVec4};

/// Settings of the culling.
#[derive(Clone, Copy, Debug)]
pub struct CullParams {
    /// Drawn radius of a whole particle.
    pub radius: f64,
    /// Rest density of water.
    pub rest_density: f64,
    /// Fraction of the rest density below which a particle is spray.
    pub density_threshold: f64,
    /// Fraction from which on a particle has its whole radius.
    pub density_full: f64,
    /// Radius of the bounding sphere in (density-scaled) drawn radii: 2 contains everything that
    /// adds to the thickness.
    pub bound: f64,
}

impl CullParams {
    /// The defaults for a drawn radius and a rest density.
    pub fn new(radius: f64, rest_density: f64) -> Self {
        Self { radius, rest_density, density_threshold: 0.35, density_full: 0.45, bound: 2.0 }
    }
}

/// The remaining particles, in their order.
#[derive(Clone, Debug, Default)]
pub struct Culled {
    /// Water in the frustum.
    pub visible: Vec<Sphere>,
    /// The particle of each sphere in `visible`.
    pub visible_index: Vec<usize>,
    /// Spray in the frustum, with the whole radius.
    pub spray: Vec<Sphere>,
    /// The particle of each sphere in `spray`.
    pub spray_index: Vec<usize>,
    /// Number of particles whose position or density is not finite.
    pub dropped: usize,
}

/// The planes of the frustum in eye space, pointing inwards: sums and differences of the
/// projection's rows that are not negative inside, `-w <= x, y <= w` and `0 <= z <= w`. A far plane
/// at infinity has no direction and is omitted.
pub fn frustum(view: &View) -> Vec<DVec4> {
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| view.projection.row(row));
    [w + x, w - x, w + y, w - y, z, w - z]
        .into_iter()
        .filter(|plane| plane.truncate().length() > 1e-9)
        .map(|plane| plane / plane.truncate().length())
        .collect()
}

/// Culls the particles. Without densities all are water at rest; so is a particle whose density is
/// 0 or less, because the host has not computed it yet.
pub fn cull(
    positions: &[[f32; 3]],
    densities: Option<&[f32]>,
    params: &CullParams,
    view: &View,
) -> Culled {
    let planes = frustum(view);
    let mut culled = Culled::default();
    for (index, position) in positions.iter().enumerate() {
        let density = densities.and_then(|all| all.get(index)).map_or(0.0, |d| f64::from(*d));
        if !position.iter().all(|x| x.is_finite()) || !density.is_finite() {
            culled.dropped += 1;
            continue;
        }
        let fraction = if density <= 0.0 { 1.0 } else { density / params.rest_density };
        let spray = fraction < params.density_threshold;
        let scale = match spray {
            true => 1.0,
            false => {
                0.5 + 0.5 * smoothstep(params.density_threshold, params.density_full, fraction)
            }
        };
        let radius = params.radius * scale;
        let center = view.view.transform_point3(DVec3::from(position.map(f64::from)));
        let seen = planes.iter().all(|p| p.dot(center.extend(1.0)) >= -params.bound * radius);
        if seen && spray {
            culled.spray.push(Sphere { center, radius });
            culled.spray_index.push(index);
        } else if seen {
            culled.visible.push(Sphere { center, radius });
            culled.visible_index.push(index);
        }
    }
    culled
}

#[cfg(test)]
mod tests {
    use super::super::tests::{Depth, projection, view};
    use super::*;
    use glam::{DMat4, DVec2};

    #[test]
    fn strays_are_counted_and_spray_is_apart() {
        let view = view(DVec2::ONE, DVec2::ZERO, 8, 8);
        let mut positions = vec![[0.0, 0.0, -5.0]; 7];
        positions[1][2] = f32::NAN;
        positions[2][0] = f32::INFINITY;
        let densities = [1000.0, 1000.0, 1000.0, 349.0, 400.0, 0.0, 351.0];
        let params = CullParams::new(2.0, 1000.0);
        let culled = cull(&positions, Some(&densities), &params, &view);
        assert_eq!((culled.dropped, culled.spray_index), (2, vec![3]));
        assert_eq!(culled.visible_index, [0, 4, 5, 6]);
        let radii: Vec<f64> = culled.visible.iter().map(|s| s.radius).collect();
        assert!((radii[0] - 2.0).abs() < 1e-12 && (radii[2] - 2.0).abs() < 1e-12);
        assert!((radii[1] - 1.5).abs() < 1e-12, "half way up the step");
        assert!(radii[3] > 1.0 && radii[3] < 1.001);
        assert_eq!(cull(&positions, None, &params, &view).visible.len(), 5);
    }

    #[test]
    fn a_sphere_goes_when_it_is_wholly_outside() {
        for depth in
            [Depth::Standard, Depth::Reversed, Depth::StandardInfinite, Depth::ReversedInfinite]
        {
            // A half angle of 45 degrees: the side planes are x = d and the like.
            let p = projection(DVec2::new(1.0, -1.0), DVec2::ZERO, depth);
            let eye = DMat4::from_translation(DVec3::new(-3.0, 0.0, 0.0));
            let view = View::new(eye, p, 8, 8).expect("a valid view");
            // The bounding sphere has twice the drawn radius.
            let params = CullParams::new(0.5, 1000.0);
            let seen = |x: f64, y: f64, z: f64| {
                let position = [x + 3.0, y, z].map(|x| x as f32);
                cull(&[position], None, &params, &view).visible.len() == 1
            };
            let far = 2.0_f64.sqrt();
            for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                assert!(seen(x * (10.0 + 0.99 * far), y * (10.0 + 0.99 * far), -10.0));
                assert!(!seen(x * (10.0 + 1.01 * far), y * (10.0 + 1.01 * far), -10.0));
            }
            assert!(seen(0.0, 0.0, 0.89) && !seen(0.0, 0.0, 0.91));
            let finite = matches!(depth, Depth::Standard | Depth::Reversed);
            assert!(seen(0.0, 0.0, -1000.9));
            assert_eq!(seen(0.0, 0.0, -1001.1), !finite);
        }
    }
}
