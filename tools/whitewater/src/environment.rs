//! The environment: a picture, or the built-in sky, and its irradiance.

use std::f32::consts::{PI, TAU};
use std::path::Path;

use glam::Vec3;
use whitewater::headless::scene::{Scene, SunLight};
use whitewater::io::picture::{self, Encoding};
use whitewater::{Light, Sky};

use crate::failure::{Failure, Outcome};

/// Default direction to the sun.
const SUN: [f32; 3] = [-0.7, 0.55, -0.35];

/// An equirectangular picture: row 0 up, its middle column along -z.
#[derive(Clone, Debug)]
pub struct Panorama {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<Vec3>,
}

/// Source of the light.
#[derive(Clone, Debug)]
pub enum Source {
    Sky(Sky),
    Picture {
        /// The whole picture.
        shown: Panorama,
        /// The picture without the sun.
        without_sun: Panorama,
    },
}

/// The light of a scene.
#[derive(Clone, Debug)]
pub struct Environment {
    pub source: Source,
    /// Direction to the sun, or to the brightest spot.
    pub sun: Vec3,
    /// Irradiance of the sun alone on a plane that faces it.
    pub sun_irradiance: Vec3,
    /// Irradiance of everything but the sun on a level plane.
    pub sky_irradiance: Vec3,
}

impl Environment {
    /// The built-in sky.
    pub fn sky(sun: Option<[f32; 3]>) -> Outcome<Self> {
        // In the views that the program finds by itself, the default sun is behind the water, so that the water
        // glitters.
        let sun = unit(sun.unwrap_or(SUN))?;
        let sky = Sky::default().with(|it| it.sun = sun.to_array());
        let sun_irradiance = Vec3::from(sky.sun_irradiance());
        let sky_irradiance = Vec3::from(sky.sky_irradiance());
        Ok(Self { source: Source::Sky(sky), sun, sun_irradiance, sky_irradiance })
    }

    /// An artificial environment. `room` gives the radiance from each direction without the key light. The key light
    /// is a square around the direction `to_key`; `key` is its radiance and its angular width in radians.
    pub fn lit(room: impl Fn(Vec3) -> Vec3, to_key: [f32; 3], key: (Vec3, f32)) -> Outcome<Self> {
        let sun = unit(to_key)?;
        let (radiance, half) = (key.0, (0.5 * key.1).tan());
        let right = Vec3::Y.cross(sun).try_normalize().unwrap_or(Vec3::X);
        let up = sun.cross(right);
        let in_box = |d: Vec3| {
            let ahead = d.dot(sun).max(1.0e-6);
            let inside = |v: f32| ((half - (v / ahead).abs()) / (0.1 * half)).clamp(0.0, 1.0);
            if d.dot(sun) > 0.0 { inside(d.dot(right)) * inside(d.dot(up)) } else { 0.0 }
        };
        let without_sun = Panorama::build(256, 128, &room);
        let shown = Panorama::build(256, 128, |d| room(d) + radiance * in_box(d));
        let texels = (0..shown.pixels.len()).map(|i| (i % 256, i / 256));
        let sun_irradiance = texels
            .map(|(x, y)| {
                let d = shown.direction(x, y);
                radiance * in_box(d) * d.dot(sun).max(0.0) * shown.solid_angle(y)
            })
            .sum();
        let sky_irradiance = without_sun.irradiance();
        let source = Source::Picture { shown, without_sun };
        Ok(Self { source, sun, sun_irradiance, sky_irradiance })
    }

    /// An environment from a picture.
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
        // Half floats on the device do not hold infinities; negative light is removed.
        let clean = |v: f32| if v.is_nan() { 0.0 } else { linear(v).clamp(0.0, 65000.0) };
        let pixels = rgb.iter().map(|c| Vec3::from(c.map(clean))).collect();
        let shown = Panorama { width, height, pixels };
        let mut without_sun = shown.clone();
        let (brightest, sun_irradiance) = without_sun.take_sun();
        let sun = match sun {
            Some(sun) => unit(sun)?,
            None => brightest,
        };
        let sky_irradiance = without_sun.irradiance();
        let source = Source::Picture { shown, without_sun };
        Ok(Self { source, sun, sun_irradiance, sky_irradiance })
    }

    /// The renderer's light for this environment.
    pub fn light(&self) -> Light {
        if let Source::Sky(sky) = &self.source {
            return Light::of(sky).with(|it| it.shade = self.shade().to_array());
        }
        Light::default().with(|it| {
            it.direction = self.sun.to_array();
            // The picture contains the sun, so its highlight is part of the reflection.
            it.color = [0.0; 3];
            // Mean radiance over all directions. The sun's part is halved, because the water above absorbs half of
            // it.
            it.ambient =
                ((self.sky_irradiance + 0.5 * self.sun_irradiance) / (4.0 * PI)).to_array();
            it.irradiance =
                (self.sky_irradiance + self.sun_irradiance * self.sun.y.max(0.0)).to_array();
            it.shade = self.shade().to_array();
        })
    }

    /// Irradiance in the shade: skylight, and sunlight that sunlit water and ground reflect. Half of the skylight is
    /// grey, because the surrounding foam has scattered it and taken its colour.
    fn shade(&self) -> Vec3 {
        let sky = 0.5 * (self.sky_irradiance + self.sky_irradiance.dot(LUMINANCE));
        sky + THROWN_BACK * self.sun_irradiance * self.sun.y.max(0.0)
    }

    /// Sets the sun of a scene. If the environment is a picture, the scene's own clouds are removed.
    pub fn light_scene(&self, scene: &mut Scene) {
        scene.sun = self.sun_light();
        if !matches!(self.source, Source::Sky(_)) {
            scene.clouds = 0.0;
        }
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

/// Fraction of the sunlight that sunlit water and ground reflect into the shade, for red, green and blue; a pool
/// reflects more green and blue than red.
const THROWN_BACK: Vec3 = Vec3::new(0.24, 0.3, 0.31);
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

    /// Its pixels with alpha.
    pub fn texels(&self) -> Vec<[f32; 4]> {
        self.pixels.iter().map(|c| c.extend(1.0).to_array()).collect()
    }

    /// Irradiance of a level plane.
    fn irradiance(&self) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for y in 0..self.height {
            let weight = self.solid_angle(y) * self.direction(0, y).y.max(0.0);
            let row = &self.pixels[y * self.width..][..self.width];
            sum += weight * row.iter().sum::<Vec3>();
        }
        sum
    }

    /// Removes the brightest spot by filling it with the colour around it. Returns its direction
    /// and the irradiance that it gave on a plane facing it.
    fn take_sun(&mut self) -> (Vec3, Vec3) {
        let brightness = |c: &Vec3| c.dot(LUMINANCE);
        let peak = self.pixels.iter().map(brightness).fold(0.0, f32::max);
        let Some(at) = self.pixels.iter().position(|c| brightness(c) >= peak) else {
            return (Vec3::Y, Vec3::ZERO);
        };
        let center = self.direction(at % self.width.max(1), at / self.width.max(1));
        // The sun is made of the texels within 10 degrees of the brightest one that have more than a tenth of its
        // brightness. The mean colour of the ring from 10 to 14 degrees replaces what is brighter than it.
        let cosine = |p: &Self, i: usize| p.direction(i % p.width, i / p.width).dot(center);
        let (mut around, mut angle) = (Vec3::ZERO, 0.0);
        for i in (0..self.pixels.len()).filter(|&i| (0.97..=0.985).contains(&cosine(self, i))) {
            around += self.pixels[i] * self.solid_angle(i / self.width);
            angle += self.solid_angle(i / self.width);
        }
        let around = if angle > 0.0 { around / angle } else { Vec3::ZERO };
        let (mut middle, mut irradiance) = (Vec3::ZERO, Vec3::ZERO);
        for i in 0..self.pixels.len() {
            let c = self.pixels[i];
            if cosine(self, i) > 0.985 && brightness(&c) > 0.1 * peak {
                let (x, y) = (i % self.width, i / self.width);
                let kept = c.min(around);
                irradiance += (c - kept) * self.solid_angle(y);
                middle += self.direction(x, y) * brightness(&c) * self.solid_angle(y);
                self.pixels[i] = kept;
            }
        }
        (middle.try_normalize().unwrap_or(Vec3::Y), irradiance)
    }
}

#[cfg(test)]
mod tests {
    use glam::Mat4;
    use whitewater::ash::vk;
    use whitewater::headless::scene::{Ground, Material, Mesh, Scene};
    use whitewater::headless::{Background, COLOR_FORMAT, Headless};
    use whitewater::{Camera, Config, Settings};

    use super::*;
    use crate::testing::device;

    // The atmosphere of glsl/include/atmosphere.glsl.
    const EARTH: f32 = 6360.0;
    const TOP: f32 = 6420.0;
    const SCALE_HEIGHTS: [f32; 2] = [8.0, 1.2];

    /// Optical depth of the atmosphere from just above the ground, for the colour with the largest one, along a ray
    /// with this cosine to the vertical.
    fn depth_of_air(cosine: f32) -> f32 {
        let height = EARTH + 0.05;
        let b = height * cosine;
        let span = (-b + (b * b - height * height + TOP * TOP).max(0.0).sqrt()) / 144.0;
        let along = SCALE_HEIGHTS.map(|scale| {
            let step = |i: u32| {
                let t = ((i * i + i) as f32 + 0.5) * span;
                let r = (height * height + t * t + 2.0 * height * t * cosine).sqrt();
                (-(r - EARTH).max(0.0) / scale).exp() * (2 * i + 1) as f32 * span
            };
            (0..12).map(step).sum::<f32>()
        });
        32.08e-3 * along[0] + 1.11 * 110.4e-3 * along[1]
    }

    #[test]
    fn a_white_panorama_gives_pi() {
        let white = Panorama::build(64, 32, |_| Vec3::ONE);
        assert!((white.irradiance() - PI).abs().max_element() < 0.02);
        let mut one = Panorama::build(64, 32, |_| Vec3::ZERO);
        one.pixels[10 * 64 + 48] = Vec3::ONE;
        let (sun, irradiance) = one.take_sun();
        // The middle column looks along -z; the column a quarter of the width to its right looks
        // along +x.
        assert!(sun.x > 0.8 && sun.y > 0.4 && irradiance.x > 0.0, "{sun}");
    }

    /// A uniform grey PNG of 0.5 is light of 0.2140 (IEC 61966-2-1), whose irradiance is pi times that.
    #[test]
    fn a_png_is_decoded_and_misfits_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, width: usize, channel: &str| {
            let path = folder.path().join(name);
            let mut layers = picture::Layers::new(width, 32);
            layers.push(channel, width, 32, vec![0.5; 32 * width]).unwrap();
            let file = std::fs::File::create(&path).unwrap();
            if name.ends_with(".png") {
                picture::write_png_values(&layers, file).unwrap();
            } else {
                picture::write_exr(&layers, file).unwrap();
            }
            Environment::read(&path, None)
        };
        let found = write("sky.png", 64, "Y").ok().unwrap().sky_irradiance;
        let expected = PI * 0.214_041;
        assert!((found - expected).abs().max_element() < 0.02 * expected, "{found}");
        for (name, width, channel, says) in [
            ("square.png", 32, "Y", "twice as wide as high, found 32x32"),
            ("depth.exr", 64, "Z", "expected channels R, G and B"),
        ] {
            let failure = write(name, width, channel).err().unwrap();
            assert!(failure.message.contains(says), "{}", failure.message);
            assert_eq!(failure.kind, crate::failure::Kind::Input);
        }
    }

    #[test]
    fn the_sky_is_blue_above_and_lit() {
        let sky = Environment::sky(None).unwrap();
        let light = sky.sky_irradiance;
        assert!(light.z > 1.2 * light.x && light.x > 0.0, "{light}");
        assert!(sky.exposure().abs() < 6.0);
        assert!(Environment::sky(Some([0.0; 3])).is_err());
    }

    /// A sky of constant radiance, and in it a sun: a disc five degrees wide at an elevation of 45 degrees. `sun` is
    /// the disc's irradiance on a plane that faces it.
    fn with_disc(sky: Vec3, sun: Vec3) -> Panorama {
        let to = Vec3::new(0.0, 1.0, -1.0).normalize();
        let mut panorama = Panorama::build(512, 256, |_| Vec3::ZERO);
        let inside = |i: usize, p: &Panorama| {
            p.direction(i % p.width, i / p.width).dot(to) > 2.5_f32.to_radians().cos()
        };
        let of_disc = (0..panorama.pixels.len()).filter(|&i| inside(i, &panorama));
        let angle: f32 = of_disc.map(|i| panorama.solid_angle(i / panorama.width)).sum();
        for i in 0..panorama.pixels.len() {
            let disc = if inside(i, &panorama) { sun / angle } else { Vec3::ZERO };
            panorama.pixels[i] = sky + disc;
        }
        panorama
    }

    fn file_of(panorama: &Panorama, folder: &Path) -> std::path::PathBuf {
        let (width, height) = (panorama.width, panorama.height);
        let mut layers = picture::Layers::new(width, height);
        for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
            let data = panorama.pixels.iter().map(|p| p[c]).collect();
            layers.push(name, width, height, data).unwrap();
        }
        let path = folder.join("sky.exr");
        picture::write_exr(&layers, std::fs::File::create(&path).unwrap()).unwrap();
        path
    }

    /// Radiance of a diffuse ground of this albedo, seen from above.
    fn ground(environment: &Environment, albedo: f32) -> Vec3 {
        let (_alone, device) = device();
        let extent = vk::Extent2D { width: 16, height: 16 };
        let config = Config::new(extent, COLOR_FORMAT, 1024).with(|it| it.environment_size = 64);
        let mut headless = Headless::new(device, &config).unwrap();
        match &environment.source {
            Source::Sky(sky) => headless.sky(sky).unwrap(),
            Source::Picture { shown, without_sun } => {
                let (width, height) = (shown.width as u32, shown.height as u32);
                let [shown, without_sun] = [shown, without_sun].map(Panorama::texels);
                let extent = vk::Extent2D { width, height };
                headless
                    .equirectangular_with_sun(extent, &shown, &without_sun, (1.0, 0.0))
                    .unwrap();
            }
        }
        let matt = Material { base_color: [albedo; 3], roughness: 1.0, ..Material::default() };
        let plate = Mesh::plane([0.0, 0.0, 0.0], [40.0, 40.0], matt.clone());
        let ground = Some(Ground { y: -0.01, material: matt, reach: None });
        let sun = environment.sun_light();
        let scene = Scene { meshes: vec![plate], ground, sun, ..Scene::default() };
        headless.scene(&scene, false).unwrap();
        headless.particles(&[[0.0, 30.0, 0.0]], None).unwrap();
        let projection = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0))
            * Mat4::perspective_rh(0.2, 1.0, 1.0, 100.0);
        let view = Mat4::look_to_rh(Vec3::new(0.0, 10.0, 0.0), Vec3::NEG_Y, Vec3::Z);
        let camera = Camera::of(view, projection);
        headless.render(&camera, &Settings::default(), &Background::Scene).unwrap();
        let drawn = headless.color().unwrap();
        let sum: Vec3 = drawn.data.iter().map(|&[r, g, b, _]| Vec3::new(r, g, b)).sum();
        let messages = headless.finish().unwrap().take_messages();
        assert!(messages.is_empty(), "{messages:?}");
        sum / drawn.data.len() as f32
    }

    /// Checks the drawn radiance of a diffuse ground: by Lambert's law, with albedo a and irradiance E, it is a E /
    /// π. It may be brighter by two specular reflections. The sky's is 0.04 · (1 - ½), the share of `scene.frag` at
    /// roughness 1. The sun's is 0.04 plus at most 1e-3 by Schlick, times a distribution of 1/π and a visibility of
    /// at most ½ / (n·l). The irradiance has two numerical errors: the edge of the hemisphere, which is softened over
    /// a tenth, costs a thousandth, and sums over 8² texels a face are within a hundredth of the integral (second
    /// differences of the cosine over a texel of a quarter, (1/4)²/24, and of the sky's radiance).
    #[test]
    fn ground_under_a_sun_is_lambert() {
        let folder = tempfile::tempdir().unwrap();
        let albedo = 0.5;
        let check = |name: &str, environment: &Environment, light: Vec3, glossy_sky: Vec3| {
            let lambert = albedo * light / PI;
            let height = environment.sun.y.max(0.1);
            let facing = environment.sun_irradiance * height;
            let shine = 0.02 * glossy_sky + facing * 0.041 / PI * 0.5 / height;
            let found = ground(environment, albedo);
            let (low, high) = (0.985 * lambert, 1.015 * lambert + shine);
            assert!(
                found.cmpge(low).all() && found.cmple(high).all(),
                "{name}: {found}, not {lambert} (from {low} to {high})"
            );
        };
        for (sky, sun) in [
            (Vec3::new(0.5, 1.0, 2.0), Vec3::ZERO),
            (Vec3::new(0.5, 1.0, 2.0), Vec3::new(4.0, 3.5, 3.0)),
            (Vec3::splat(1.0e-3), Vec3::new(4.0, 3.5, 3.0)),
        ] {
            let path = file_of(&with_disc(sky, sun), folder.path());
            let environment = Environment::read(&path, None).unwrap();
            // The disc stands at an elevation of 45 degrees.
            let light = PI * sky + sun * 0.5_f32.sqrt();
            check(&format!("a picture of {sky} and {sun}"), &environment, light, sky);
        }
        for sun in [[0.0, 1.0, 0.0], SUN, [0.8, 0.3, 0.2]] {
            let environment = Environment::sky(Some(sun)).unwrap();
            let height = environment.sun.y.max(0.0);
            let light = environment.sky_irradiance + environment.sun_irradiance * height;
            check("the sky", &environment, light, environment.sky_irradiance / PI * 4.0);
        }
    }

    /// Scene, foam and water are lit by one consistent light: the picture without its sun, plus the sun that is
    /// removed from it, give the original light, for every direction of `--sun`.
    #[test]
    fn the_sun_is_taken_out_of_a_picture_once() {
        let folder = tempfile::tempdir().unwrap();
        let (sky, sun) = (Vec3::new(0.5, 1.0, 2.0), Vec3::new(4.0, 3.5, 3.0));
        let path = file_of(&with_disc(sky, sun), folder.path());
        for moved in [None, Some([0.0, 1.0, 0.0])] {
            let environment = Environment::read(&path, moved).unwrap();
            // The tolerance covers the error of taking the cosine at the middle of each texel, which is 180/256
            // degrees wide.
            let close = |a: Vec3, b: Vec3| (a - b).abs().cmple(2.0e-3 * b).all();
            assert!(close(environment.sky_irradiance, PI * sky), "{}", environment.sky_irradiance);
            assert!(close(environment.sun_irradiance, sun), "{}", environment.sun_irradiance);
            let height = moved.map_or(0.5_f32.sqrt(), |_| 1.0);
            let all = Vec3::from(environment.light().irradiance);
            assert!(close(all, PI * sky + height * sun), "{all}");
        }
    }

    /// Texels along an edge of the cube map, and pixels along an edge of the pictures that are drawn of it.
    const SIZE: u32 = 64;

    /// World direction of a pixel, and the steps to the directions of the next pixel to the right and below. The
    /// camera's field of view is 90 degrees, so its pixels are the texels of a face of the cube.
    fn ray(view: Mat4, pixel: usize) -> [Vec3; 3] {
        let size = SIZE as usize;
        let at = |i: usize| (2.0 * i as f32 + 1.0) / size as f32 - 1.0;
        let step = 2.0 / size as f32;
        let eye = Vec3::new(at(pixel % size), -at(pixel / size), -1.0);
        [eye, step * Vec3::X, step * Vec3::NEG_Y].map(|v| view.inverse().transform_vector3(v))
    }

    /// Max relative difference between two computations of the sky in single precision.
    ///
    /// The altitude along a ray is a root (the distance from the earth's centre) minus the earth's radius: both are
    /// near 6400 km, where an ulp is 2^-11 km. Its error has two parts. The squares under the root have an ulp of 4
    /// km²; three roundings by half of that move the root by 3 * 2 / (2 * 6400) km in each of the two computations
    /// (CPU, device). The root itself is off by half an ulp on the CPU and by 5 on a device (Vulkan: 2 for the
    /// inverse root and 2.5 for the division).
    ///
    /// The altitude's error divided by the scale height is the relative error of the air's density, largest in the
    /// thinner layer, Mie's. The light changes by this error three times: in proportion to the density that scatters
    /// it; by the optical depth along the view ray, where the factor has a mean of 1 if the ray is thick (for a
    /// density exp(-x)); and by the optical depth towards the sun, counted twice, because the altitudes towards the
    /// sun start with the error of those along the view ray.
    fn precision(sun: Vec3) -> f32 {
        let ulp = 2.0_f32.powi(-11);
        let altitude = 2.0 * 6.0 / (2.0 * EARTH) + (0.5 + 5.0) * ulp;
        let depth = depth_of_air(sun.y);
        altitude / SCALE_HEIGHTS[1] * (1.0 + 1.0 + 2.0 * depth)
    }

    /// The sky that the CPU computes equals the drawn sky: the faces of the cube map, drawn as pictures of an empty
    /// scene, are compared with it texel by texel.
    #[test]
    fn the_sky_is_the_one_that_is_drawn() {
        let (_alone, device) = device();
        let extent = vk::Extent2D { width: SIZE, height: SIZE };
        let config = Config::new(extent, COLOR_FORMAT, 1024).with(|it| it.environment_size = SIZE);
        let mut headless = Headless::new(device, &config).unwrap();
        // A sun without light has no disc and no glow.
        let dark = SunLight { color: [0.0; 3], ..SunLight::default() };
        headless.scene(&Scene { sun: dark, ..Scene::default() }, false).unwrap();
        headless.particles(&[[0.0; 3]], None).unwrap();
        let projection = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0))
            * Mat4::perspective_rh(PI / 2.0, 1.0, 1.0, 10.0);
        for sun in [SUN, [0.0, 1.0, 0.0], [0.9, 0.1, 0.3]] {
            let sun = Vec3::from(sun).normalize();
            let sky = Sky::default().with(|it| it.sun = sun.to_array());
            headless.sky(&sky).unwrap();
            let precision = precision(sun);
            assert!(precision < 0.03, "{sun}: {precision}");
            let here = |d: Vec3| Vec3::from(sky.radiance(d.normalize().to_array()));
            let mut compared = 0;
            for (axis, up) in [
                (Vec3::X, Vec3::Y),
                (Vec3::NEG_X, Vec3::Y),
                (Vec3::Y, Vec3::Z),
                (Vec3::Z, Vec3::Y),
                (Vec3::NEG_Z, Vec3::Y),
            ] {
                // The only particle, at the origin, is behind the camera.
                let view = Mat4::look_to_rh(100.0 * (axis + Vec3::Y), axis, up);
                let camera = Camera::of(view, projection);
                headless.render(&camera, &Settings::default(), &Background::Scene).unwrap();
                let drawn = headless.color().unwrap();
                for (i, &[r, g, b, _]) in drawn.data.iter().enumerate() {
                    let [d, right, down] = ray(view, i);
                    let around = [d + right, d - right, d + down, d - down];
                    // Texels below the horizon show ground in the cube map.
                    if d.y < 0.0 || around.iter().any(|d| d.y < 0.0) {
                        continue;
                    }
                    let expected = here(d);
                    // Filter weights have 8 bits; cube map and picture are half floats.
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
