//! Computes the light of the built-in sky on the CPU, for [`Light::of`](crate::Light::of) and for the host's own
//! scene.
//!
//! It computes the same integral as `glsl/include/atmosphere.glsl`, whose comments explain it.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use crate::contract::Light;
use crate::environment::{Sky, axes};

const EARTH: f32 = 6360.0;
const TOP: f32 = 6420.0;
const RAYLEIGH: Vec3 = Vec3::new(7.14e-3, 13.21e-3, 32.08e-3);
const MIE: Vec3 = Vec3::new(67.7e-3, 82.7e-3, 110.4e-3);
const MIE_LOSS: f32 = 1.11;
const SCALE_HEIGHTS: Vec2 = Vec2::new(8.0, 1.2);
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// Columns and rows of the directions over which the sky's light is summed.
const DIRECTIONS: (usize, usize) = (64, 32);

/// Radiance of the sun's highlight on water if the sun's irradiance at the ground is, in its brightest channel, as
/// large as the default [`Sky::intensity`], the irradiance outside the atmosphere.
const HIGHLIGHT: Vec3 = Vec3::new(4.0, 3.8, 3.4);

impl Sky {
    /// A sky with the sun in this direction (any length except 0).
    pub fn toward(sun: [f32; 3]) -> Self {
        let sun = Vec3::from(sun).normalize_or(Vec3::Y).to_array();
        Self { sun, ..Self::default() }
    }

    /// Irradiance of the sun on a surface that faces it, linear RGB, in the unit of [`intensity`](Self::intensity):
    /// dimmed and reddened by the atmosphere, 0 below the horizon.
    pub fn sun_irradiance(&self) -> [f32; 3] {
        // Optical depth of the zenith: coefficients times scale heights; air mass after Kasten and Young 1989.
        const RAYLEIGH: Vec3 = Vec3::new(7.14e-3 * 8.0, 13.21e-3 * 8.0, 32.08e-3 * 8.0);
        const MIE: Vec3 = Vec3::new(67.7e-3 * 1.332, 82.7e-3 * 1.332, 110.4e-3 * 1.332);
        let sine = Vec3::from(self.sun).normalize_or(Vec3::Y).dot(axes(self.up)[1]);
        let height = sine.clamp(0.0, 1.0);
        let degrees = height.asin().to_degrees();
        let mass = 1.0 / (height + 0.50572 * (degrees + 6.07995).powf(-1.6364));
        let risen = (sine / 0.01).clamp(0.0, 1.0);
        ((-(RAYLEIGH + MIE) * mass).exp() * self.intensity * risen).to_array()
    }

    /// Irradiance that level ground receives from the sky without the sun, linear RGB, in the unit of
    /// [`intensity`](Self::intensity). It sums over the 1024 directions above the horizon of a grid of 2048, which
    /// takes some milliseconds.
    pub fn sky_irradiance(&self) -> [f32; 3] {
        let sun = self.local_sun();
        let (width, height) = DIRECTIONS;
        let angle = |y: usize| (y as f32 + 0.5) / height as f32 * PI;
        let mut sum = Vec3::ZERO;
        for y in (0..height).filter(|&y| angle(y).cos() > 0.0) {
            let row: Vec3 = (0..width)
                .map(|x| {
                    let longitude = ((x as f32 + 0.5) / width as f32 - 0.5) * TAU;
                    let (sine, up) = (angle(y).sin(), angle(y).cos());
                    let d = Vec3::new(sine * longitude.sin(), up, -sine * longitude.cos());
                    self.intensity * radiance(d, sun)
                })
                .sum();
            let solid_angle = angle(y).sin() * (TAU / width as f32) * (PI / height as f32);
            sum += solid_angle * angle(y).cos() * row;
        }
        sum.to_array()
    }

    /// Radiance from a direction above the horizon (unit vector), without the sun's disc.
    pub fn radiance(&self, direction: [f32; 3]) -> [f32; 3] {
        let direction = Vec3::from(direction);
        let local = Vec3::from(axes(self.up).map(|axis| direction.dot(axis)));
        (self.intensity * radiance(local, self.local_sun())).to_array()
    }

    /// Direction to the sun in axes east, up, north.
    fn local_sun(&self) -> Vec3 {
        let sun = Vec3::from(self.sun);
        let unit = (sun.length_squared() - 1.0).abs() < 1.0e-5;
        let sun = if unit { sun } else { sun.normalize_or(Vec3::Y) };
        Vec3::from(axes(self.up).map(|axis| sun.dot(axis)))
    }
}

impl Light {
    /// The light of the built-in sky for water, foam and spray. Use it together with an environment of the same
    /// [`Sky`]. It takes some milliseconds, once per sky. With the default sky, white foam in the sun has a radiance
    /// of about 5: expose by about 0.2, or lower [`Sky::intensity`].
    pub fn of(sky: &Sky) -> Self {
        let (sun, above) = (Vec3::from(sky.sun_irradiance()), Vec3::from(sky.sky_irradiance()));
        let height = sky.local_sun().y.max(0.0);
        let reference = Sky::default().intensity;
        // Irradiance in the shade: light of the sky, light that sunlit ground reflects, and light that the
        // surrounding foam scatters, which has lost its colour.
        let grey = 0.5 * (above + above.dot(LUMINANCE));
        Self {
            direction: sky.sun,
            color: (HIGHLIGHT * sun.max_element() / reference).to_array(),
            // Mean radiance over all directions; the water above absorbs half of the sun's part.
            ambient: ((above + 0.5 * sun) / (4.0 * PI)).to_array(),
            irradiance: (above + sun * height).to_array(),
            shade: (grey + 0.15 * sun * height).to_array(),
        }
    }
}

fn leave_sphere(height: f32, cosine: f32, radius: f32) -> f32 {
    let b = height * cosine;
    -b + (b * b - height * height + radius * radius).max(0.0).sqrt()
}

fn density(altitude: f32) -> Vec2 {
    (Vec2::splat(-altitude.max(0.0)) / SCALE_HEIGHTS).exp()
}

fn optical_depth(height: f32, cosine: f32) -> Vec2 {
    let span = leave_sphere(height, cosine, TOP) / 144.0;
    let mut sum = Vec2::ZERO;
    for i in 0..12 {
        let t = ((i * i + i) as f32 + 0.5) * span;
        let r = (height * height + t * t + 2.0 * height * t * cosine).sqrt();
        sum += density(r - EARTH) * (2 * i + 1) as f32 * span;
    }
    sum
}

fn transmittance(depth: Vec2) -> Vec3 {
    (-(RAYLEIGH * depth.x + MIE_LOSS * MIE * depth.y)).exp()
}

/// Radiance that arrives from a direction, for a direction to the sun and an intensity of 1. Both directions are in
/// the axes east, up, north.
fn radiance(direction: Vec3, sun: Vec3) -> Vec3 {
    let eye = EARTH + 0.05;
    let d = Vec3::new(direction.x, direction.y.max(0.003), direction.z).normalize();
    let span = leave_sphere(eye, d.y, TOP);
    let (mut along, mut rayleigh, mut mie) = (Vec2::ZERO, Vec3::ZERO, Vec3::ZERO);
    let mut before = 0.0;
    for i in 0..24 {
        let after = span * ((i + 1) as f32 / 24.0).powi(2);
        let (t, size) = (0.5 * (before + after), after - before);
        before = after;
        let r = (eye * eye + t * t + 2.0 * eye * t * d.y).sqrt();
        let here = density(r - EARTH) * size;
        let cosine = (eye * sun.y + t * d.dot(sun)) / r;
        let reach = transmittance(along + 0.5 * here + optical_depth(r, cosine.max(-0.05)));
        along += here;
        rayleigh += here.x * reach;
        mie += here.y * reach;
    }
    let mu = d.dot(sun);
    let g = 0.76_f32;
    let phase_r = 3.0 / (16.0 * PI) * (1.0 + mu * mu);
    let phase_m = 3.0 / (8.0 * PI) * (1.0 - g * g) * (1.0 + mu * mu)
        / ((2.0 + g * g) * (1.0 + g * g - 2.0 * g * mu).powf(1.5));
    let height = sun.y.max(0.0);
    let often = 0.072 * height / (height + 0.12);
    let thick = RAYLEIGH * along.x;
    rayleigh * RAYLEIGH * phase_r + mie * MIE * phase_m + often * (Vec3::ONE - (-thick).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same sky turned on its side gives the same light.
    #[test]
    fn light_does_not_depend_on_which_axis_is_up() {
        let [x, y, z] = Sky::default().sun;
        let upright = Light::of(&Sky::default());
        // x stays, y becomes z, z becomes -y.
        let tilted = Sky { sun: [x, -z, y], up: [0.0, 0.0, 1.0], ..Sky::default() };
        let tilted = Light::of(&tilted);
        for (a, b) in [
            (upright.color, tilted.color),
            (upright.ambient, tilted.ambient),
            (upright.irradiance, tilted.irradiance),
            (upright.shade, tilted.shade),
        ] {
            // The azimuth differs relative to the sampled directions, of which there are 64 columns.
            let apart = (Vec3::from(a) - Vec3::from(b)).abs().max_element();
            assert!(apart < 0.02 * Vec3::from(a).max_element(), "{a:?} {b:?}");
        }
    }

    /// `Light::default` equals the light of the default sky, to the 24 bits of a float minus those lost in a sum of
    /// 1024 terms.
    #[test]
    fn the_default_light_is_that_of_the_default_sky() {
        let (own, of) = (Light::default(), Light::of(&Sky::default()));
        assert_eq!(own.direction, of.direction);
        for (a, b) in [
            (own.color, of.color),
            (own.ambient, of.ambient),
            (own.irradiance, of.irradiance),
            (own.shade, of.shade),
        ] {
            for (a, b) in a.into_iter().zip(b) {
                assert!((a - b).abs() <= 1.0e-4 * b, "{own:?} {of:?}");
            }
        }
    }

    /// Below the horizon the sun gives no light, and a lower sun gives less.
    #[test]
    fn a_low_sun_gives_less() {
        let of = |sine: f32| {
            let sun = [(1.0 - sine * sine).sqrt(), sine, 0.0];
            Vec3::from(Light::of(&Sky { sun, ..Sky::default() }).irradiance)
        };
        assert!(of(0.9).cmpgt(of(0.3)).all() && of(0.3).cmpgt(of(0.05)).all());
        let night = Sky { sun: [0.8, -0.6, 0.0], ..Sky::default() };
        assert_eq!(night.sun_irradiance(), [0.0; 3]);
    }
}
