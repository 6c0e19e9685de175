//! What shines on the scene: a picture, or the built-in sky, whose irradiance is worked out here.

use std::f32::consts::{PI, TAU};
use std::path::Path;

use glam::{Vec2, Vec3};
use whitewater::headless::scene::SunLight;
use whitewater::io::picture::{self, Encoding};
use whitewater::{Light, Sky};

use crate::failure::{Failure, Outcome};

/// Towards the sun where nothing is said.
const SUN: [f32; 3] = [-0.7, 0.55, -0.35];

/// An equirectangular picture: row 0 up, its middle column along -z.
#[derive(Clone, Debug)]
pub struct Panorama {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<Vec3>,
}

/// Where the light comes from.
#[derive(Clone, Debug)]
pub enum Source {
    Sky(Sky),
    Picture(Panorama),
}

/// The light of a scene.
#[derive(Clone, Debug)]
pub struct Environment {
    pub source: Source,
    /// Towards the sun, or the brightest spot.
    pub sun: Vec3,
    /// Of the sun alone, on a plane that faces it.
    pub sun_irradiance: Vec3,
    /// On a level plane from all but the sun.
    pub sky_irradiance: Vec3,
}

impl Environment {
    /// The built-in sky.
    pub fn sky(sun: Option<[f32; 3]>) -> Outcome<Self> {
        // Behind the water for the views found here: there it glitters.
        let sun = unit(sun.unwrap_or(SUN))?;
        let sky = Sky { sun: sun.to_array(), ..Sky::default() };
        let sun_irradiance = Vec3::from(SunLight::of(&sky).color);
        let above = Panorama::build(64, 32, |d| match d.y > 0.0 {
            true => sky.intensity * sky_radiance(d, sun),
            false => Vec3::ZERO,
        });
        let sky_irradiance = above.irradiance();
        Ok(Self { source: Source::Sky(sky), sun, sun_irradiance, sky_irradiance })
    }

    /// A picture.
    pub fn read(path: &Path, sun: Option<[f32; 3]>) -> Outcome<Self> {
        let layers = picture::read(path)?;
        let bad = |what: String| Failure::input(format!("{}: {what}", path.display()));
        let (width, height) = (layers.width, layers.height);
        let rgb = layers.rgb().ok_or_else(|| {
            bad("expected channels R, G and B, found others; use a picture with colour".into())
        })?;
        if width != 2 * height {
            return Err(bad(format!(
                "expected an equirectangular picture twice as wide as high, found {width}x{height}; \
                 convert it"
            )));
        }
        let linear = |v: f32| match layers.encoding {
            Encoding::Linear => v,
            Encoding::Srgb => picture::srgb_decode(v),
        };
        // Half floats on the device: no infinities, no negative light.
        let clean = |v: f32| if v.is_nan() { 0.0 } else { linear(v).clamp(0.0, 65000.0) };
        let pixels = rgb.iter().map(|c| Vec3::from(c.map(clean))).collect();
        let panorama = Panorama { width, height, pixels };
        let (brightest, sun_irradiance) = panorama.sun();
        let sun = match sun {
            Some(sun) => unit(sun)?,
            None => brightest,
        };
        let level = sun_irradiance * sun.y.max(0.0);
        let sky_irradiance = (panorama.irradiance() - level).max(Vec3::ZERO);
        Ok(Self { source: Source::Picture(panorama), sun, sun_irradiance, sky_irradiance })
    }

    /// The renderer's light for this environment.
    pub fn light(&self) -> Light {
        let default = Light::default();
        let reference = Sky::default().intensity;
        Light {
            direction: self.sun.to_array(),
            // The highlight of a sun that is in the picture comes with its reflection.
            color: match self.source {
                Source::Sky(_) => (Vec3::from(default.color) * self.sun_irradiance.max_element()
                    / reference)
                    .to_array(),
                Source::Picture(_) => [0.0; 3],
            },
            // The mean over all directions, half of the sun's taken off by the water above.
            ambient: ((self.sky_irradiance + 0.5 * self.sun_irradiance) / (4.0 * PI)).to_array(),
            irradiance: (self.sky_irradiance + self.sun_irradiance * self.sun.y.max(0.0))
                .to_array(),
            shade: self.shade().to_array(),
        }
    }

    /// Irradiance without the sun: of the sky, of what sunlit ground throws back, and of what the foam round
    /// it scatters, which has lost its colour.
    fn shade(&self) -> Vec3 {
        let sky = 0.5 * (self.sky_irradiance + self.sky_irradiance.dot(LUMINANCE));
        sky + 0.15 * self.sun_irradiance * self.sun.y.max(0.0)
    }

    /// The same sun for the scene behind the water.
    pub fn sun_light(&self) -> SunLight {
        SunLight { direction: self.sun.to_array(), color: self.sun_irradiance.to_array() }
    }

    /// Stops that make a sunlit mid-grey surface fit a screen.
    pub fn exposure(&self) -> f32 {
        let level = self.sky_irradiance + self.sun_irradiance * self.sun.y.max(0.0);
        let white = level.dot(LUMINANCE) / PI;
        if white > 0.0 { (1.1 / white).log2().clamp(-20.0, 20.0) } else { 0.0 }
    }
}

const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

fn unit(v: [f32; 3]) -> Outcome<Vec3> {
    Vec3::from(v)
        .try_normalize()
        .ok_or_else(|| Failure::usage("--sun: expected a direction, found 0,0,0; give another"))
}

impl Panorama {
    fn build(width: usize, height: usize, radiance: impl Fn(Vec3) -> Vec3) -> Self {
        let mut panorama = Self { width, height, pixels: Vec::with_capacity(width * height) };
        for i in 0..width * height {
            panorama.pixels.push(radiance(panorama.direction(i % width, i / width)));
        }
        panorama
    }

    fn direction(&self, x: usize, y: usize) -> Vec3 {
        let longitude = ((x as f32 + 0.5) / self.width as f32 - 0.5) * TAU;
        let angle = (y as f32 + 0.5) / self.height as f32 * PI;
        Vec3::new(angle.sin() * longitude.sin(), angle.cos(), -angle.sin() * longitude.cos())
    }

    /// Solid angle of a texel of a row.
    fn solid_angle(&self, y: usize) -> f32 {
        let (w, h) = (self.width as f32, self.height as f32);
        ((y as f32 + 0.5) / h * PI).sin() * (TAU / w) * (PI / h)
    }

    /// On a level plane.
    fn irradiance(&self) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for y in 0..self.height {
            let weight = self.solid_angle(y) * self.direction(0, y).y.max(0.0);
            let row = &self.pixels[y * self.width..][..self.width];
            sum += weight * row.iter().sum::<Vec3>();
        }
        sum
    }

    /// The brightest spot: its middle, and the irradiance that comes from it.
    fn sun(&self) -> (Vec3, Vec3) {
        let brightness = |c: &Vec3| c.dot(LUMINANCE);
        let peak = self.pixels.iter().map(brightness).fold(0.0, f32::max);
        let Some(at) = self.pixels.iter().position(|c| brightness(c) >= peak) else {
            return (Vec3::Y, Vec3::ZERO);
        };
        let center = self.direction(at % self.width.max(1), at / self.width.max(1));
        let (mut middle, mut irradiance) = (Vec3::ZERO, Vec3::ZERO);
        for (i, c) in self.pixels.iter().enumerate() {
            let (x, y) = (i % self.width, i / self.width);
            let d = self.direction(x, y);
            // Within 10 degrees, and bright.
            if d.dot(center) > 0.985 && brightness(c) > 0.1 * peak {
                irradiance += *c * self.solid_angle(y);
                middle += d * brightness(c) * self.solid_angle(y);
            }
        }
        (middle.try_normalize().unwrap_or(Vec3::Y), irradiance)
    }
}

// The sky of glsl/include/atmosphere.glsl, whose comments say what stands here.
const EARTH: f32 = 6360.0;
const TOP: f32 = 6420.0;
const RAYLEIGH: Vec3 = Vec3::new(5.8e-3, 13.5e-3, 33.1e-3);
const MIE: f32 = 4.0e-3;
const MIE_ABSORPTION: f32 = 4.4e-4;
const SCALE_HEIGHTS: Vec2 = Vec2::new(8.0, 1.2);

fn leave_sphere(height: f32, cosine: f32, radius: f32) -> f32 {
    let b = height * cosine;
    -b + (b * b - height * height + radius * radius).max(0.0).sqrt()
}

fn density(altitude: f32) -> Vec2 {
    (Vec2::splat(-altitude.max(0.0)) / SCALE_HEIGHTS).exp()
}

fn optical_depth(height: f32, cosine: f32) -> Vec2 {
    let span = leave_sphere(height, cosine, TOP) / 8.0;
    let mut sum = Vec2::ZERO;
    for i in 0..8 {
        let t = (i as f32 + 0.5) * span;
        let r = (height * height + t * t + 2.0 * height * t * cosine).sqrt();
        sum += density(r - EARTH) * span;
    }
    sum
}

fn transmittance(depth: Vec2) -> Vec3 {
    (-(RAYLEIGH * depth.x + (MIE + MIE_ABSORPTION) * depth.y)).exp()
}

fn sky_radiance(direction: Vec3, sun: Vec3) -> Vec3 {
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
    let often = 0.13 * sun.y.max(0.0);
    let thick = RAYLEIGH * along.x + 2.0 * MIE * along.y;
    rayleigh * RAYLEIGH * phase_r + mie * MIE * phase_m + often * (Vec3::ONE - (-thick).exp())
}

#[cfg(test)]
mod tests {
    use glam::Mat4;
    use whitewater::ash::vk;
    use whitewater::headless::scene::Scene;
    use whitewater::headless::{Background, COLOR_FORMAT, Device, DeviceOptions, Headless};
    use whitewater::{Camera, Config, Settings};

    use super::*;

    #[test]
    fn a_white_panorama_gives_pi() {
        let white = Panorama::build(64, 32, |_| Vec3::ONE);
        assert!((white.irradiance() - PI).abs().max_element() < 0.02);
        let mut one = Panorama::build(64, 32, |_| Vec3::ZERO);
        one.pixels[10 * 64 + 48] = Vec3::ONE;
        let (sun, irradiance) = one.sun();
        // The middle column looks along -z, the one right of it by a quarter along +x.
        assert!(sun.x > 0.8 && sun.y > 0.4 && irradiance.x > 0.0, "{sun}");
    }

    #[test]
    fn the_sky_is_blue_above_and_lit() {
        let sky = Environment::sky(None).unwrap();
        let light = sky.sky_irradiance;
        assert!(light.z > 1.2 * light.x && light.x > 0.0, "{light}");
        assert!(sky.exposure().abs() < 6.0);
        assert!(Environment::sky(Some([0.0; 3])).is_err());
    }

    /// Texels along an edge of the cube, and pixels along an edge of its pictures.
    const SIZE: u32 = 64;

    /// World direction of a pixel and its steps to the next one right and below, for a camera of
    /// 90 degrees: the pixels of a face are the texels of the cube.
    fn ray(view: Mat4, pixel: usize) -> [Vec3; 3] {
        let size = SIZE as usize;
        let at = |i: usize| (2.0 * i as f32 + 1.0) / size as f32 - 1.0;
        let step = 2.0 / size as f32;
        let eye = Vec3::new(at(pixel % size), -at(pixel / size), -1.0);
        [eye, step * Vec3::X, step * Vec3::NEG_Y].map(|v| view.inverse().transform_vector3(v))
    }

    /// How far two computations of the sky in single precision may lie apart, as a part of it.
    ///
    /// Altitude is a difference of numbers near 6400 km, whose ulp is 2^-11 km: their squares take
    /// three roundings of half an ulp of 4 (as much as 3 * 2 / (2 * 6400) km), the root half an
    /// ulp on the CPU and 5 on a device (Vulkan: 2 of the inverse root and 2.5 of the division).
    /// The density of the thinner layer, Mie's, changes by that over its scale height. In-scattered
    /// light follows it, and falls by its share in the optical depth: a mean of 1 along the view
    /// where that is thick (of a depth with density exp(-x)), and the depth towards the sun, whose
    /// altitudes begin with the error of those along the view.
    fn precision(sun: Vec3) -> f32 {
        let ulp = 2.0_f32.powi(-11);
        let altitude = 2.0 * 6.0 / (2.0 * EARTH) + (0.5 + 5.0) * ulp;
        let depth = -transmittance(optical_depth(EARTH + 0.05, sun.y)).min_element().ln();
        altitude / SCALE_HEIGHTS.y * (1.0 + 1.0 + 2.0 * depth)
    }

    /// The sky here is the one that is drawn: the cube's faces, photographed texel by texel in a
    /// scene of nothing, against it.
    #[test]
    fn the_sky_is_the_one_that_is_drawn() {
        let validation =
            std::env::var_os("WHITEWATER_REQUIRE_VALIDATION").is_some_and(|v| v == "1");
        let options = DeviceOptions { validation, ..DeviceOptions::default() };
        let device = Device::new(&options).unwrap();
        let extent = vk::Extent2D { width: SIZE, height: SIZE };
        let config = Config { environment_size: SIZE, ..Config::new(extent, COLOR_FORMAT, 1024) };
        let mut headless = Headless::new(device, &config).unwrap();
        // A sun without light has neither disc nor glow.
        let dark = SunLight { color: [0.0; 3], ..SunLight::default() };
        headless.scene(&Scene { sun: dark, ..Scene::default() }, false).unwrap();
        headless.particles(&[[0.0; 3]], None).unwrap();
        let projection = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0))
            * Mat4::perspective_rh(PI / 2.0, 1.0, 1.0, 10.0);
        for sun in [SUN, [0.0, 1.0, 0.0], [0.9, 0.1, 0.3]] {
            let sun = Vec3::from(sun).normalize();
            let sky = Sky { sun: sun.to_array(), ..Sky::default() };
            headless.sky(&sky).unwrap();
            let precision = precision(sun);
            assert!(precision < 0.03, "{sun}: {precision}");
            let here = |d: Vec3| sky.intensity * sky_radiance(d.normalize(), sun);
            let mut compared = 0;
            for (axis, up) in [
                (Vec3::X, Vec3::Y),
                (Vec3::NEG_X, Vec3::Y),
                (Vec3::Y, Vec3::Z),
                (Vec3::Z, Vec3::Y),
                (Vec3::NEG_Z, Vec3::Y),
            ] {
                // The one particle, at the origin, is behind.
                let view = Mat4::look_to_rh(100.0 * (axis + Vec3::Y), axis, up);
                let camera = Camera { view, projection };
                headless.render(&camera, &Settings::default(), &Background::Scene).unwrap();
                let drawn = headless.color().unwrap();
                for (i, &[r, g, b, _]) in drawn.data.iter().enumerate() {
                    let [d, right, down] = ray(view, i);
                    let around = [d + right, d - right, d + down, d - down];
                    // Below the horizon there is ground in the cube.
                    if d.y < 0.0 || around.iter().any(|d| d.y < 0.0) {
                        continue;
                    }
                    let expected = here(d);
                    // Filter weights have 8 bits; cube and picture are of half floats.
                    let filter: Vec3 = around.iter().map(|&d| (here(d) - expected).abs()).sum();
                    let bound = expected * (precision + 2.0_f32.powi(-10)) + filter / 256.0;
                    let off = (Vec3::new(r, g, b) - expected).abs();
                    assert!(
                        off.cmple(bound).all(),
                        "sun {sun}, towards {}: {r} {g} {b}, not {expected} within {bound}",
                        d.normalize()
                    );
                    compared += 1;
                }
            }
            // All of the face above and nearly half of four others.
            assert!(compared > 2 * (SIZE * SIZE), "{compared}");
        }
        let messages = headless.finish().unwrap().take_messages();
        assert!(messages.is_empty(), "{messages:?}");
    }
}
