//! The cubic spline kernel and its integral over a half-space.
//!
//! The kernel is the one of Monaghan, "Smoothed Particle Hydrodynamics" (1992), written with its
//! support radius `R`. The half-space integral serves walls: Koschier & Bender, "Density Maps for
//! Improved SPH Boundary Handling" (2017), tabulate the integral of the kernel over the solid; for
//! a wall that is flat at the scale of the kernel it depends on the distance to the wall alone.

use glam::Vec3;

/// Samples of the half-space tables over `[0, R]`.
const SAMPLES: usize = 512;

/// A cubic spline kernel of one support radius, with its half-space tables.
pub struct Kernel {
    support: f32,
    sigma: f32,
    /// `∫_d^R area(t) dt` for `d` in `[0, R]`: fraction of the kernel behind a wall at distance d.
    behind: Vec<f32>,
    /// `2π ∫_d^R W(r) r dr`: the kernel integrated over the plane at distance d.
    area: Vec<f32>,
}

fn spline(q: f64) -> f64 {
    if q >= 1.0 {
        0.0
    } else if q > 0.5 {
        2.0 * (1.0 - q).powi(3)
    } else {
        6.0 * (q * q * q - q * q) + 1.0
    }
}

impl Kernel {
    /// The kernel with support radius `support`.
    pub fn new(support: f32) -> Self {
        let radius = f64::from(support);
        let sigma = 8.0 / (std::f64::consts::PI * radius.powi(3));
        // Both integrals from the outside inwards, by the trapezoidal rule on a finer grid.
        const FINE: usize = 16;
        let step = radius / (SAMPLES * FINE) as f64;
        let integrand = |r: f64| 2.0 * std::f64::consts::PI * sigma * spline(r / radius) * r;
        let mut behind = vec![0.0; SAMPLES + 1];
        let mut area = vec![0.0; SAMPLES + 1];
        let (mut area_sum, mut behind_sum) = (0.0, 0.0);
        for fine in (0..SAMPLES * FINE).rev() {
            let r = fine as f64 * step;
            let last_area = area_sum;
            area_sum += 0.5 * step * (integrand(r) + integrand(r + step));
            behind_sum += 0.5 * step * (last_area + area_sum);
            if fine % FINE == 0 {
                area[fine / FINE] = area_sum as f32;
                behind[fine / FINE] = behind_sum as f32;
            }
        }
        Self { support, sigma: sigma as f32, behind, area }
    }

    /// The support radius.
    pub fn support(&self) -> f32 {
        self.support
    }

    /// `W(r)`.
    pub fn value(&self, r: f32) -> f32 {
        let q = r / self.support;
        if q >= 1.0 {
            0.0
        } else if q > 0.5 {
            self.sigma * 2.0 * (1.0 - q).powi(3)
        } else {
            self.sigma * (6.0 * (q * q * q - q * q) + 1.0)
        }
    }

    /// `∇W` for the offset `x = x_i − x_j` of length `r`, with respect to `x_i`.
    pub fn gradient(&self, x: Vec3, r: f32) -> Vec3 {
        let q = r / self.support;
        if q >= 1.0 || r < 1e-9 {
            return Vec3::ZERO;
        }
        let slope = if q > 0.5 { -6.0 * (1.0 - q) * (1.0 - q) } else { 6.0 * q * (3.0 * q - 2.0) };
        x * (self.sigma * slope / (self.support * r))
    }

    /// Fraction of the kernel behind a flat wall at signed distance `d`, and its rate of decrease with distance
    /// (positive).
    pub fn half_space(&self, d: f32) -> (f32, f32) {
        let at = (d.abs() / self.support).min(1.0) * SAMPLES as f32;
        let low = (at as usize).min(SAMPLES - 1);
        let t = at - low as f32;
        let lerp = |table: &[f32]| table[low] + t * (table[low + 1] - table[low]);
        let behind = lerp(&self.behind);
        (if d < 0.0 { 1.0 - behind } else { behind }, lerp(&self.area))
    }

    /// The sum of `W` over a cubic lattice of this spacing, including the particle itself.
    pub fn lattice_sum(&self, spacing: f32) -> f32 {
        let n = (self.support / spacing).ceil() as i32;
        let mut sum = 0.0;
        for x in -n..=n {
            for y in -n..=n {
                for z in -n..=n {
                    let at = Vec3::new(x as f32, y as f32, z as f32) * spacing;
                    sum += self.value(at.length());
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_half_space_at_the_wall_is_one_half() {
        let kernel = Kernel::new(0.08);
        assert!((kernel.half_space(0.0).0 - 0.5).abs() < 1e-4);
        assert!(kernel.half_space(0.08).0.abs() < 1e-6);
        assert!((kernel.half_space(-0.08).0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_slope_is_the_derivative() {
        let kernel = Kernel::new(0.08);
        for d in [-0.05_f32, -0.01, 0.013, 0.04, 0.07] {
            let step = 1e-3;
            let numeric =
                (kernel.half_space(d - step).0 - kernel.half_space(d + step).0) / (2.0 * step);
            let slope = kernel.half_space(d).1;
            assert!((numeric - slope).abs() < 0.02 * slope.abs() + 0.02, "{d}");
        }
    }

    #[test]
    fn a_lattice_of_half_the_support_sums_to_about_one_particle_volume() {
        let spacing = 0.04_f32;
        let sum = Kernel::new(2.0 * spacing).lattice_sum(spacing) * spacing.powi(3);
        assert!((sum - 1.0).abs() < 0.05, "{sum}");
    }
}
