//! Twin of the water's composite (section 7, without foam): refraction, absorption along the ray,
//! Fresnel reflection and the highlight of the surface.
//! ```text
//! P = (s_x z, s_y z, -z)    n = P_x x P_y normalized, towards the eye    path = T |P| / z
//! Physical  C = background t + ambient (scattering / ext) (1 - t),    t = exp(-ext path)
//! Source    C = mix(base exp(-k path), background, exp(-k_a path))
//! C <- mix(C, env(R), w F) + w specular sun max(n.h, 0)^shininess,   w = smoothstep(0, r/4, T)
//! ```

use super::surface::{Surface, Surfaces};
use super::{Image, View, smoothstep};
use glam::{DVec2, DVec3};

/// What light meets inside the water.
#[derive(Clone, Copy, Debug)]
pub enum Medium {
    /// Metres and radiance.
    Physical {
        /// Per metre.
        absorption: [f64; 3],
        /// Per metre.
        scattering: [f64; 3],
        /// The radiance that is scattered in.
        ambient: [f64; 3],
    },
    /// The source's colours.
    Source {
        /// The water's own colour.
        base: [f64; 3],
        /// Per metre: of the base colour, and last of the background.
        k: [f64; 4],
    },
}

/// How much of the light is reflected.
#[derive(Clone, Copy, Debug)]
pub enum Fresnel {
    /// `f0 + (1 - f0) (1 - n.v)^5`.
    Schlick {
        /// Facing the surface; 0.02 for water.
        f0: f64,
    },
    /// `bias + scale (1 - n.v)^power`, between 0 and 1.
    Source {
        /// Facing the surface.
        bias: f64,
        /// What grazing adds.
        scale: f64,
        /// How late it does.
        power: f64,
    },
}

impl Fresnel {
    /// The reflected part at the cosine `n.v`.
    pub fn reflectance(&self, cosine: f64) -> f64 {
        let grazing = (1.0 - cosine).max(0.0);
        match *self {
            Self::Schlick { f0 } => f0 + (1.0 - f0) * grazing.powi(5),
            Self::Source { bias, scale, power } => {
                (bias + scale * grazing.powf(power)).clamp(0.0, 1.0)
            }
        }
    }
}

/// The images. Depths are eye depths.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// The water's depth at full resolution, clipped by the scene.
    pub depth: &'a Image<f64>,
    /// Its smoothed depth at the level.
    pub smoothed: &'a Image<f64>,
    /// The level of the smoothed depth: its pixel is a block of `2^level`.
    pub level: u32,
    /// The thickness along z.
    pub thickness: &'a Image<f64>,
    /// The level of the thickness.
    pub thickness_level: u32,
    /// The scene behind, linear.
    pub scene_color: &'a Image<[f64; 4]>,
    /// The scene's depth, of its own extent.
    pub scene_depth: &'a Image<f64>,
}

/// The look.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// r, the drawn radius: water thinner than r / 4 fades out of reflection.
    pub radius: f64,
    /// Depths that differ by more radii are on different surfaces.
    pub falloff: f64,
    /// Beta: by how much of the thickness a slope displaces the background.
    pub refraction: f64,
    /// The water.
    pub medium: Medium,
    /// The reflection's strength.
    pub fresnel: Fresnel,
    /// The highlight's strength.
    pub specular: [f64; 3],
    /// Its exponent.
    pub shininess: f64,
    /// The unit vector to the sun in eye space.
    pub sun_direction: DVec3,
    /// The sun's colour.
    pub sun_color: [f64; 3],
}

/// Where the background is looked up, in pixels: displaced by refraction. Light bends towards the
/// water's normal, so the look-up moves against it.
pub fn look_up(settings: &Settings, surface: &Surface, view: &View, pixel: DVec2) -> DVec2 {
    // Pixels per length at z, signed as the image's axes run.
    let scale = 1.0 / (view.slope_step() * -surface.position.z);
    let offset = -surface.normal.truncate() * surface.thickness * settings.refraction * scale;
    pixel + offset
}

/// Whether a position is beyond the view, or any of the four texels of the scene's depth round it
/// stands before the water;
/// where its size is another than the colour's, round the four corners of the pixel there.
pub fn hidden(inputs: &Inputs<'_>, z: f64, at: DVec2) -> bool {
    let extent = |width: usize, height: usize| DVec2::new(width as f64, height as f64);
    let (scene, color) = (inputs.scene_depth, inputs.scene_color);
    let ratio = extent(scene.width, scene.height) / extent(color.width, color.height);
    let edge = extent(color.width, color.height) - 0.5;
    if at.cmplt(DVec2::splat(0.5)).any() || at.cmpgt(edge).any() {
        return true;
    }
    let before = |at: DVec2| scene.bilinear(at * ratio).iter().any(|t| scene.clamped(t.0, t.1) < z);
    if ratio == DVec2::ONE {
        return before(at);
    }
    [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)]
        .iter()
        .any(|&(x, y)| before(at + DVec2::new(x, y)))
}

/// The look-up, no farther than half the way to what stands before the water: that is asked for as
/// far as twice the way, then found by halving to half a pixel, less a pixel and a half. And every
/// place that was asked about.
pub fn cut_look_up(
    inputs: &Inputs<'_>,
    z: f64,
    pixel: DVec2,
    displaced: DVec2,
) -> (DVec2, Vec<DVec2>) {
    let (at, far) = (|part: f64| pixel + (displaced - pixel) * part, pixel.distance(displaced));
    let mut asked = Vec::new();
    let mut ask = |part: f64| {
        asked.push(at(part));
        hidden(inputs, z, at(part))
    };
    let (mut free, mut blocked) = match (ask(1.0), far < 0.25) {
        (true, _) => (0.0, 1.0),
        // Too near to matter: what is free stays.
        (false, true) => (1.0, 3.0),
        (false, false) if ask(2.0) => (1.0, 2.0),
        (false, false) => return (displaced, asked),
    };
    while (blocked - free) * far >= 0.5 {
        let middle = 0.5 * (free + blocked);
        if ask(middle) {
            blocked = middle;
        } else {
            free = middle;
        }
    }
    (at((0.5 * (free - 1.5 / far.max(1.0))).clamp(0.0, 1.0)), asked)
}

/// The scene's colour behind a surface, displaced but never onto what stands before the water.
fn background(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    pixel: DVec2,
) -> DVec3 {
    let q = look_up(settings, surface, view, pixel);
    let (q, _) = cut_look_up(inputs, -surface.position.z, pixel, q);
    let color = |t: &(isize, isize, f64)| {
        let [r, g, b, _] = inputs.scene_color.clamped(t.0, t.1);
        DVec3::new(r, g, b) * t.2
    };
    inputs.scene_color.bilinear(q).iter().map(color).sum()
}

/// The direction in the world in which a surface mirrors.
fn mirrored(surface: &Surface, view: &View) -> DVec3 {
    let (n, v) = (surface.normal, -surface.position.normalize());
    view.view.inverse().transform_vector3(2.0 * n.dot(v) * n - v).normalize()
}

/// What a surface shows: the scene behind it and the environment it mirrors.
pub fn seen(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    env: impl Fn(DVec3) -> DVec3,
    view: &View,
    pixel: DVec2,
) -> (DVec3, DVec3) {
    (background(inputs, settings, surface, view, pixel), env(mirrored(surface, view)))
}

/// The picture: water over the scene with alpha 1, the scene as it is elsewhere. `env` gives the
/// environment's radiance from a direction in the world.
pub fn shade(
    inputs: &Inputs<'_>,
    settings: &Settings,
    env: impl Fn(DVec3) -> DVec3 + Sync,
    view: &View,
) -> Image<[f64; 4]> {
    let surfaces = Surfaces::new(inputs, settings, view);
    Image::from_fn(view.width, view.height, |x, y| {
        let Some(surface) = surfaces.at(x, y) else {
            return inputs.scene_color.at(x, y);
        };
        let Surface { position, normal: n, thickness, .. } = surface;
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let v = -position.normalize();
        let path = thickness * position.length() / -position.z;

        let (background, mirrored_sky) = seen(inputs, settings, &surface, &env, view, pixel);
        let exp = |k: DVec3| (-k * path).exp();
        let mut color = match settings.medium {
            Medium::Physical { absorption, scattering, ambient } => {
                let scattering = DVec3::from(scattering);
                let ext = DVec3::from(absorption) + scattering;
                let albedo = DVec3::select(ext.cmpgt(DVec3::ZERO), scattering / ext, DVec3::ZERO);
                let t = exp(ext);
                background * t + DVec3::from(ambient) * albedo * (1.0 - t)
            }
            Medium::Source { base, k: [r, g, b, a] } => {
                let water = DVec3::from(base) * exp(DVec3::new(r, g, b));
                water.lerp(background, (-a * path).exp())
            }
        };

        let w = smoothstep(0.0, settings.radius / 4.0, thickness);
        let reflected = mirrored(&surface, view);
        // What is mirrored from below the horizon is more water, not the environment's ground.
        let sky = smoothstep(-0.3, 0.0, reflected.y);
        color = color.lerp(mirrored_sky, w * sky * settings.fresnel.reflectance(n.dot(v)));

        let h = (v + settings.sun_direction).normalize_or_zero();
        let highlight = n.dot(h).max(0.0).powf(settings.shininess);
        color += DVec3::from(settings.specular) * DVec3::from(settings.sun_color) * (w * highlight);
        color.extend(1.0).to_array()
    })
}

#[cfg(test)]
mod tests {
    use super::super::EMPTY;
    use super::super::tests::{Depth, projection, view};
    use super::*;
    use glam::DMat4;

    const PLAIN: Settings = Settings {
        radius: 0.5,
        falloff: 5.3,
        refraction: 0.25,
        medium: Medium::Physical {
            absorption: [0.5, 0.2, 0.0],
            scattering: [0.1, 0.0, 0.0],
            ambient: [2.0, 2.0, 2.0],
        },
        fresnel: Fresnel::Schlick { f0: 0.0 },
        specular: [0.0; 3],
        shininess: 80.0,
        sun_direction: DVec3::Z,
        sun_color: [1.0; 3],
    };

    /// The images of one water surface before a scene at depth 50.
    struct Scene {
        depth: Image<f64>,
        smoothed: Image<f64>,
        thickness: Image<f64>,
        color: Image<[f64; 4]>,
        scene: Image<f64>,
    }

    impl Scene {
        fn new(view: &View, level: u32, thickness: f64, z: impl Fn(DVec3) -> f64 + Sync) -> Self {
            let (w, h, reduced) = (view.width, view.height, view.reduced(level));
            let image =
                |view: &View| Image::from_fn(view.width, view.height, |x, y| z(view.ray(x, y)));
            Self {
                depth: image(view),
                smoothed: image(&reduced),
                thickness: Image::new(w, h, thickness),
                color: Image::from_fn(w, h, |x, y| [x as f64, y as f64, 1.0, 0.5]),
                scene: Image::new(w, h, 50.0),
            }
        }

        fn inputs(&self, level: u32) -> Inputs<'_> {
            Inputs {
                depth: &self.depth,
                smoothed: &self.smoothed,
                level,
                thickness: &self.thickness,
                thickness_level: 0,
                scene_color: &self.color,
                scene_depth: &self.scene,
            }
        }
    }

    const BLACK: fn(DVec3) -> DVec3 = |_| DVec3::ZERO;

    #[test]
    fn the_normal_of_a_plane_is_its_own_at_every_level() {
        for focal in [DVec2::new(1.2, -1.5), DVec2::new(-1.2, 1.5)] {
            let view = view(focal, DVec2::new(0.2, -0.1), 163, 121);
            let n = DVec3::new(0.3, 0.5, 0.8).normalize();
            for level in 0..3 {
                let scene = Scene::new(&view, level, 1.0, |ray| -n.z * 20.0 / ray.dot(n));
                for (x, y) in [(81, 60), (30, 20), (140, 100)] {
                    let found =
                        Surfaces::new(&scene.inputs(level), &PLAIN, &view).at(x, y).expect("water");
                    assert!((found.normal - n).length() < 2e-3, "{found:?}");
                    assert!(
                        (found.position - view.ray(x, y) * scene.depth.at(x, y)).length() < 5e-2
                    );
                }
            }
        }
    }

    #[test]
    fn borders_are_one_sided_and_islets_face_the_eye() {
        let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 64, 64);
        let n = DVec3::new(0.3, 0.0, 1.0).normalize();
        let mut scene = Scene::new(&view, 1, 1.0, |ray| -n.z * 20.0 / ray.dot(n));
        for (x, y) in (0..32).flat_map(|y| (16..32).map(move |x| (x, y))) {
            *scene.smoothed.at_mut(x, y) = if x < 20 { 40.0 } else { EMPTY };
        }
        let at = |x| Surfaces::new(&scene.inputs(1), &PLAIN, &view).at(x, 30).expect("water");
        assert!((at(31).normal - n).length() < 0.02, "{:?}", at(31));
        // Water without a smoothed surface near it.
        let islet = at(50);
        assert_eq!(-islet.position.z, scene.depth.at(50, 30));
        assert!((islet.normal - DVec3::Z).length() < 1e-12);
    }

    #[test]
    fn light_is_absorbed_along_the_ray() {
        let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 33, 33);
        let scene = Scene::new(&view, 0, 2.0, |_| 10.0);
        let picture = shade(&scene.inputs(0), &PLAIN, BLACK, &view);
        for (x, y) in [(16, 16), (32, 0)] {
            let path = 2.0 * view.ray(x, y).length();
            let fresnel = 1.0 - (1.0 - 1.0 / view.ray(x, y).length()).powi(5);
            let t = (-0.6 * path).exp();
            let expected =
                [x as f64 * t + 2.0 * (0.1 / 0.6) * (1.0 - t), y as f64 * (-0.2 * path).exp(), 1.0];
            for (found, expected) in picture.at(x, y).iter().zip(expected) {
                assert!((found - expected * fresnel).abs() < 1e-9);
            }
            assert_eq!(picture.at(x, y)[3], 1.0);
        }
        let source = Medium::Source { base: [0.3, 0.5, 0.9], k: [0.4, 0.3, 0.2, 0.1] };
        let picture = shade(&scene.inputs(0), &Settings { medium: source, ..PLAIN }, BLACK, &view);
        let a = (-0.2_f64).exp();
        let expected = 0.5 * (-0.6_f64).exp() * (1.0 - a) + 16.0 * a;
        assert!((picture.at(16, 16)[1] - expected).abs() < 1e-9);
    }

    #[test]
    fn pixels_without_water_are_the_scene() {
        let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 9, 9);
        let mut scene = Scene::new(&view, 1, 2.0, |_| 10.0);
        scene.depth = Image::new(9, 9, EMPTY);
        assert_eq!(shade(&scene.inputs(1), &PLAIN, BLACK, &view), scene.color);
    }

    #[test]
    fn the_background_is_displaced_in_pixels_but_not_onto_what_is_in_front() {
        let clear =
            Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3], ambient: [0.0; 3] };
        let settings = Settings { medium: clear, ..PLAIN };
        let view = view(DVec2::new(2.0, -2.0), DVec2::ZERO, 65, 65);
        let n = DVec3::new(0.2, 0.1, 1.0).normalize();
        let mut scene = Scene::new(&view, 0, 3.0, |ray| -n.z * 10.0 / ray.dot(n));
        let fresnel = |c: f64| 1.0 - (1.0 - c).powi(5);
        let found = shade(&scene.inputs(0), &settings, BLACK, &view).at(32, 32);
        // Left and, as the image runs down, down: -beta T n / (C z).
        let shift = 3.0 * 0.25 / (10.0 * 2.0 / (65.0 * 2.0));
        let expected = [32.0 - n.x * shift, 32.0 + n.y * shift];
        for axis in [0, 1] {
            assert!((found[axis] / fresnel(n.z) - expected[axis]).abs() < 0.02, "{found:?}");
        }
        *scene.scene.at_mut(31, 33) = 5.0;
        let found = shade(&scene.inputs(0), &settings, BLACK, &view).at(32, 32);
        assert!((found[0] / fresnel(n.z) - 32.0).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn the_reflection_is_looked_up_in_the_world() {
        // A level pool seen from above at 30 degrees: the mirror image of the ray.
        let eye = DVec3::new(0.0, 5.0, 0.0);
        let forward = DVec3::new(0.0, -0.5, -(0.75_f64.sqrt()));
        let pitch = DMat4::from_rotation_x(30.0_f64.to_radians());
        let world_to_eye = pitch * DMat4::from_translation(-eye);
        assert!((world_to_eye.transform_vector3(forward) + DVec3::Z).length() < 1e-12);
        let p = projection(DVec2::new(1.2, -1.2), DVec2::ZERO, Depth::Standard);
        let view = View::new(world_to_eye, p, 65, 65).expect("a valid view");
        let up = world_to_eye.transform_vector3(DVec3::Y);
        let scene = Scene::new(&view, 0, 5.0, |ray| -5.0 / ray.dot(up));
        let mirror =
            Settings { fresnel: Fresnel::Source { bias: 2.0, scale: 0.0, power: 1.0 }, ..PLAIN };
        let picture = shade(&scene.inputs(0), &mirror, |direction| direction, &view);
        let found = DVec3::from_slice(&picture.at(32, 32)[..3]);
        assert!((found - DVec3::new(0.0, 0.5, forward.z)).length() < 2e-3, "{found}");

        // The sun where the ray goes: the whole highlight; thin water has none.
        let sun = world_to_eye.transform_vector3(found.normalize());
        let lit = Settings { specular: [0.5; 3], sun_direction: sun, ..mirror };
        let glint = shade(&scene.inputs(0), &lit, |direction| direction, &view).at(32, 32);
        assert!((glint[0] - picture.at(32, 32)[0] - 0.5).abs() < 1e-3, "{glint:?}");
        let dry = Scene::new(&view, 0, 0.0, |ray| -5.0 / ray.dot(up));
        let found = shade(&dry.inputs(0), &lit, |direction| direction, &view).at(32, 32);
        assert!((found[0] - 32.0).abs() < 1e-9, "{found:?}");
    }
}
