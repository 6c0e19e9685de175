//! Twin of the water's composite (section 7, without foam): refraction, absorption along the ray,
//! Fresnel reflection and the highlight of the surface.
//! ```text
//! P = (s_x z, s_y z, -z)    n = P_x x P_y normalized, towards the eye    path = T |P| / z
//! Physical  C = background t + ambient (scattering / ext) (1 - t),    t = exp(-ext path)
//! Source    C = mix(base exp(-k path), background, exp(-k_a path))
//! C <- mix(C, env(R), w F) + w specular sun max(n.h, 0)^shininess,   w = smoothstep(0, r/4, T)
//! ```

use super::noise::Ripples;
use super::surface::{Surface, Surfaces};
use super::{Image, View, is_surface, smoothstep};
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
        // What is turned away from the eye grazes.
        let grazing = (1.0 - cosine).clamp(0.0, 1.0);
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
    /// The noise on the front surface, if there is any.
    pub noise: Option<Ripples<'a>>,
}

impl Inputs<'_> {
    /// The scene's depth at a pixel.
    pub fn scene(&self, x: usize, y: usize) -> f64 {
        let (scene, depth) = (self.scene_depth, self.depth);
        let texel = |i: usize, texels: usize, pixels: usize| {
            ((i as f64 + 0.5) * texels as f64 / pixels as f64) as usize
        };
        scene.at(texel(x, scene.width, depth.width), texel(y, scene.height, depth.height))
    }
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

/// By how many pixels a surface displaces the background. Light bends towards the water's normal, so
/// the look-up moves against it.
fn displacement(settings: &Settings, surface: &Surface, view: &View) -> DVec2 {
    // Pixels per length at z, signed as the image's axes run.
    let scale = 1.0 / (view.slope_step() * -surface.position.z);
    -surface.normal.truncate() * surface.lens * settings.refraction * scale
}

/// A displacement that tends to a sixteenth of the picture's height at most.
pub fn bent(by: DVec2, view: &View) -> DVec2 {
    let most = view.height as f64 / 16.0;
    by * most / by.length().hypot(most)
}

/// Where the background is looked up, in pixels: displaced by refraction.
pub fn look_up(settings: &Settings, surface: &Surface, view: &View, pixel: DVec2) -> DVec2 {
    pixel + bent(displacement(settings, surface, view), view)
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
    scene_at(inputs, q)
}

/// The scene's colour at a position.
pub fn scene_at(inputs: &Inputs<'_>, at: DVec2) -> DVec3 {
    let color = |t: &(isize, isize, f64)| {
        let [r, g, b, _] = inputs.scene_color.clamped(t.0, t.1);
        DVec3::new(r, g, b) * t.2
    };
    inputs.scene_color.bilinear(at).iter().map(color).sum()
}

/// The direction in the world in which a surface mirrors.
pub fn mirrored(surface: &Surface, view: &View) -> DVec3 {
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

/// What comes through water of a path from behind it, with what it scatters in.
pub fn through(medium: &Medium, behind: DVec3, path: f64) -> DVec3 {
    let exp = |k: DVec3| (-k * path).exp();
    match *medium {
        Medium::Physical { absorption, scattering, ambient } => {
            let scattering = DVec3::from(scattering);
            let ext = DVec3::from(absorption) + scattering;
            let albedo = DVec3::select(ext.cmpgt(DVec3::ZERO), scattering / ext, DVec3::ZERO);
            let t = exp(ext);
            behind * t + DVec3::from(ambient) * albedo * (1.0 - t)
        }
        Medium::Source { base, k: [r, g, b, a] } => {
            let water = DVec3::from(base) * exp(DVec3::new(r, g, b));
            water.lerp(behind, (-a * path).exp())
        }
    }
}

/// A surface before what is behind it: through the water, then what it mirrors and the highlight,
/// of which a part is there.
fn before(
    settings: &Settings,
    surface: &Surface,
    part: f64,
    behind: DVec3,
    env: impl Fn(DVec3) -> DVec3,
    view: &View,
) -> DVec3 {
    let Surface { position, normal: n, thickness, .. } = *surface;
    let v = -position.normalize();
    let path = thickness * position.length() / -position.z;
    let mut color = through(&settings.medium, behind, path);

    let w = part * smoothstep(0.0, settings.radius / 4.0, thickness);
    let reflected = mirrored(surface, view);
    // What is mirrored from below the horizon is more water, not the environment's ground.
    let sky = smoothstep(-0.3, 0.0, reflected.y);
    color = color.lerp(env(reflected), w * sky * settings.fresnel.reflectance(n.dot(v)));

    let h = (v + settings.sun_direction).normalize_or_zero();
    let highlight = n.dot(h).max(0.0).powf(settings.shininess);
    let shine = DVec3::from(settings.specular) * DVec3::from(settings.sun_color) * highlight;
    color + w * (shine + surface.ripple.foam)
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
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let behind = background(inputs, settings, &surface, view, pixel);
        before(settings, &surface, 1.0, behind, &env, view).extend(1.0).to_array()
    })
}

/// What a frame with two sheets has besides the [`Inputs`], whose thickness is that of all water.
#[derive(Clone, Copy, Debug)]
pub struct Behind<'a> {
    /// The depth between the sheets, for each texel of the thickness.
    pub boundaries: &'a Image<f64>,
    /// Thickness of the front sheet, of the back one and of the window between them.
    pub thickness: &'a Image<[f64; 3]>,
    /// The smoothed depth of the back sheet at its level.
    pub smoothed: &'a Image<f64>,
    /// That level.
    pub level: u32,
}

/// The sheet behind the surface of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Back {
    /// Its thickness is T2.
    pub surface: Surface,
    /// How much of the pixel it is found in, whole, and how much air there is before it.
    pub covered: f64,
    pub apart: f64,
    /// Depth of the nearest of the four texels round the pixel.
    pub nearest: f64,
}

impl Back {
    /// How much of its mirror image and highlight shows.
    pub fn part(&self) -> f64 {
        self.covered * self.apart
    }
}

/// What a pixel shows.
#[derive(Clone, Debug)]
pub struct Shown {
    pub front: Surface,
    pub back: Option<Back>,
    /// The texels that its thickness is of, with their weights.
    pub texels: Vec<(usize, usize, f64)>,
    /// Thickness by sheets: not of all water alone.
    pub parted: bool,
    /// What lies in the window, but neither is no water nor tells the sheets apart, decides.
    pub barely: bool,
}

/// How much of the water in the window is air.
pub fn air(window: f64, spacing: f64) -> f64 {
    1.0 - smoothstep(0.1 * spacing, 0.6 * spacing, window)
}

/// How much of the air between two sheets so far apart is left to tell them apart.
pub fn open(gap: f64, spacing: f64) -> f64 {
    smoothstep(1.0, 4.0, gap / spacing)
}

/// The two images of surfaces of a frame with two sheets, ready to be asked pixel by pixel.
pub struct Two<'a> {
    inputs: Inputs<'a>,
    behind: Behind<'a>,
    spacing: f64,
    fronts: Surfaces<'a>,
    backs: Surfaces<'a>,
}

impl<'a> Two<'a> {
    pub fn new(
        inputs: &Inputs<'a>,
        behind: &Behind<'a>,
        settings: &Settings,
        view: &'a View,
    ) -> Self {
        let Behind { smoothed, level, .. } = *behind;
        Self {
            inputs: *inputs,
            behind: *behind,
            spacing: settings.radius / 0.656,
            fronts: Surfaces::new(inputs, settings, view),
            backs: Surfaces::new(
                &Inputs { smoothed, level, noise: None, ..*inputs },
                settings,
                view,
            ),
        }
    }

    /// What a pixel shows, if there is water.
    pub fn at(&self, x: usize, y: usize) -> Option<Shown> {
        let Behind { boundaries, thickness, .. } = self.behind;
        let Self { inputs, fronts, backs, .. } = self;
        let one = fronts.at(x, y)?;
        let (f, mut margin) = (inputs.depth.at(x, y), one.parts.margin);
        let mut smooth = fronts.smooth(x, y, f, &mut margin);
        let (texels, borrowed) = fronts.texels_of_thickness(x, y, smooth.z, &mut margin);
        let level = inputs.thickness_level;
        let boundary = boundaries.at(x >> level, y >> level);
        let parted = is_surface(boundary);
        let (mut t, mut apart, mut t2, mut barely) = (one.parts.full, 0.0, 0.0, false);
        if parted {
            t = 0.0;
            for (i, j, weight) in texels.iter().copied() {
                let [front, back, window] = thickness.at(i, j);
                let air = air(window, self.spacing);
                let before = f < boundaries.at(i, j);
                let (own, other) = if before { (front, back) } else { (back, front) };
                t += weight * (own + (1.0 - air) * other);
                apart += weight * air;
                t2 += weight * air * back;
                barely |= air > 0.0 && air < 1e-4;
            }
        }
        let mut back = None;
        let mut mixed = 0.0;
        if parted && f < boundary && t2 > 0.0 {
            let nearest = backs.nearest(x, y);
            let there = is_surface(nearest);
            let own = if there { nearest } else { f };
            let found = backs.smooth(x, y, own, &mut margin);
            // As the air between closes they become one.
            let open = if there { open(found.z - smooth.z - t, self.spacing) } else { 1.0 };
            t += (1.0 - open) * t2;
            (t2, apart) = (open * t2, open * apart);
            let mut surface = backs.made_of((x, y), &found, t2, None, f64::INFINITY);
            // Without a depth of its own it has all the room.
            surface.thickness = if there { surface.thickness } else { t2 };
            let hidden = found.z >= inputs.scene(x, y);
            let covered = if there && !hidden { found.found } else { 0.0 };
            back = Some(Back { surface, covered, apart, nearest });
        } else if fronts.is_covered(x, y, f, &mut margin) {
            let behind = backs.smooth(x, y, f, &mut margin);
            mixed = (1.0 - smooth.found) * behind.found;
            // Slopes per texel of the front image.
            let finer = 0.5_f64.powi(self.behind.level as i32 - inputs.level as i32);
            let slopes = behind.slope.map(|slope| slope * finer);
            smooth.found += mixed;
            smooth.z += mixed * (behind.z - smooth.z);
            let [slope, rises] = smooth.slope;
            let turned = slopes[0] - slope;
            smooth.slope = [slope + mixed * turned, rises.lerp(slopes[1], mixed) + turned.abs()];
            barely |= mixed > 0.0 && parted && t2 > 0.0 && t2 < 1e-6 * self.spacing;
        }
        let mut front = fronts.made_of((x, y), &smooth, t, Some(f), margin);
        (front.parts.borrowed, front.parts.mixed) = (borrowed, mixed);
        Some(Shown { front, back, texels, parted, barely })
    }
}

/// Where the scene is looked up through both sheets, before it is cut, and the depth that nothing may
/// stand before.
pub fn look_up_both(settings: &Settings, shown: &Shown, view: &View, pixel: DVec2) -> (DVec2, f64) {
    let (mut by, mut z) = (displacement(settings, &shown.front, view), -shown.front.position.z);
    // What hides it at the pixel hides all of it.
    if let Some(back) = shown.back.filter(|back| is_surface(back.nearest)) {
        by += back.covered * displacement(settings, &back.surface, view);
        z = z.max(z + (-back.surface.position.z - z) * back.apart);
    }
    (pixel + bent(by, view), z)
}

/// The colour of a pixel that shows water: the front sheet over the back one over the scene, which is
/// looked up once, by the sum of both offsets. The back sheet is no drop.
pub fn shade_shown(
    inputs: &Inputs<'_>,
    shown: &Shown,
    settings: &Settings,
    env: impl Fn(DVec3) -> DVec3,
    view: &View,
    pixel: DVec2,
) -> DVec3 {
    let (displaced, z) = look_up_both(settings, shown, view, pixel);
    let (q, _) = cut_look_up(inputs, z, pixel, displaced);
    let mut color = scene_at(inputs, q);
    if let Some(back) = &shown.back {
        color = before(settings, &back.surface, back.part(), color, &env, view);
    }
    before(settings, &shown.front, 1.0, color, &env, view)
}

/// The picture of two sheets.
pub fn shade_sheets(
    inputs: &Inputs<'_>,
    behind: &Behind<'_>,
    settings: &Settings,
    env: impl Fn(DVec3) -> DVec3 + Sync,
    view: &View,
) -> Image<[f64; 4]> {
    let two = Two::new(inputs, behind, settings, view);
    Image::from_fn(view.width, view.height, |x, y| {
        let Some(shown) = two.at(x, y) else {
            return inputs.scene_color.at(x, y);
        };
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        shade_shown(inputs, &shown, settings, &env, view, pixel).extend(1.0).to_array()
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
                noise: None,
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
        let by = DVec2::new(-n.x, n.y) * shift;
        // Four pixels of 65 are the most: this comes to 0.97 of what it would be.
        let expected = 32.0 + by / (1.0 + by.length_squared() * (16.0_f64 / 65.0).powi(2)).sqrt();
        for axis in [0, 1] {
            assert!((found[axis] / fresnel(n.z) - expected[axis]).abs() < 0.02, "{found:?}");
        }
        *scene.scene.at_mut(31, 33) = 5.0;
        let found = shade(&scene.inputs(0), &settings, BLACK, &view).at(32, 32);
        assert!((found[0] / fresnel(n.z) - 32.0).abs() < 1e-3, "{found:?}");
    }

    /// Two planes that face the eye at depths 10 and 20, of thicknesses x and y, with water in the
    /// window between them.
    fn two(
        view: &View,
        [x, y, window]: [f64; 3],
        settings: &Settings,
        boundary: f64,
        back: impl Fn(usize, usize) -> f64 + Sync,
    ) -> Image<[f64; 4]> {
        let front = Scene::new(view, 0, x + y, |_| 10.0);
        let reduced = view.reduced(1);
        let behind = Behind {
            boundaries: &Image::new(view.width, view.height, boundary),
            thickness: &Image::new(view.width, view.height, [x, y, window]),
            smoothed: &Image::from_fn(reduced.width, reduced.height, back),
            level: 1,
        };
        let env = |_| DVec3::new(0.5, 2.0, 1.0);
        shade_sheets(&front.inputs(0), &behind, settings, env, view)
    }

    #[test]
    fn the_front_sheet_lies_over_the_back_one() {
        let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 33, 33);
        let mirror = Fresnel::Source { bias: 0.25, scale: 0.0, power: 1.0 };
        let mut settings = Settings { fresnel: mirror, ..PLAIN };
        let source = Medium::Source { base: [0.3, 0.5, 0.9], k: [0.4, 0.3, 0.2, 0.1] };
        for (medium, sheet) in [
            (PLAIN.medium, [(0.6, 2.0 * 0.1 / 0.6), (0.2, 0.0), (0.0, 0.0)].map(Some)),
            (source, [None; 3]),
        ] {
            settings.medium = medium;
            let spacing = settings.radius / 0.656;
            // Only air between, and as much water as air; there is a back sheet, one in half of the
            // columns, and none.
            let cases = [(0.0, 1.0), (0.35, 0.5)]
                .map(|(window, air)| [0.0, 0.5, 1.0].map(|e| (window, air, e)));
            for (window, air, empty) in cases.into_iter().flatten() {
                let back =
                    |i: usize, _| if i as f64 >= 17.0 * (1.0 - empty) { EMPTY } else { 20.0 };
                let found = two(&view, [1.0, 3.0, window * spacing], &settings, 15.0, back);
                for (x, y) in [(16, 16), (30, 4)] {
                    let slant = view.ray(x, y).length();
                    let over = |behind: DVec3, path: f64, part: f64| {
                        let of = |c: usize| match sheet[c] {
                            Some((k, glow)) => {
                                let t = (-k * path * slant).exp();
                                behind[c] * t + glow * (1.0 - t)
                            }
                            None => {
                                let a = (-0.1 * path * slant).exp();
                                let k = [0.4, 0.3, 0.2][c];
                                [0.3, 0.5, 0.9][c] * (-k * path * slant).exp() * (1.0 - a)
                                    + behind[c] * a
                            }
                        };
                        // A quarter is mirrored.
                        let mirrored = 0.25 * part;
                        DVec3::new(of(0), of(1), of(2)) * (1.0 - mirrored)
                            + DVec3::new(0.5, 2.0, 1.0) * mirrored
                    };
                    let scene = DVec3::new(x as f64, y as f64, 1.0);
                    // Pixel 16 lies at 8.25 texels, a quarter of 7 and three of 8; from 9 on there are
                    // none, and 8 is a rim.
                    let covered = match (empty == 0.0, empty == 1.0, x) {
                        (true, _, _) => 1.0,
                        (_, true, _) => 0.0,
                        (_, _, 16) => 0.25,
                        _ => 0.0,
                    };
                    let expected =
                        over(over(scene, air * 3.0, covered * air), 1.0 + (1.0 - air) * 3.0, 1.0);
                    let found = DVec3::from_slice(&found.at(x, y)[..3]);
                    assert!((found - expected).length() < 1e-9, "{found}, not {expected}");
                    assert!((over(over(scene, 1.0, 1.0), 3.0, 1.0) - expected).length() > 1e-3);
                }
            }
        }
        // One sheet of all the water: no boundary, or no air.
        let spacing = settings.radius / 0.656;
        let env = |_| DVec3::new(0.5, 2.0, 1.0);
        let front = Scene::new(&view, 0, 4.0, |_| 10.0);
        let one = shade(&front.inputs(0), &settings, env, &view);
        assert_eq!(two(&view, [1.0, 3.0, 0.0], &settings, EMPTY, |_, _| 20.0), one);
        assert_eq!(two(&view, [1.0, 3.0, 0.6 * spacing], &settings, 15.0, |_, _| 20.0), one);
        // What is seen is the back sheet: of its own thickness, and none of what is before it.
        let back = two(&view, [1.0, 3.0, 0.0], &settings, 8.0, |_, _| 20.0);
        let front = Scene::new(&view, 0, 3.0, |_| 10.0);
        assert_eq!(back, shade(&front.inputs(0), &settings, env, &view));
    }

    #[test]
    fn the_scene_hides_the_back_sheet() {
        let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 32, 32);
        let mut front = Scene::new(&view, 1, 4.0, |_| 10.0);
        let boundaries = Image::new(32, 32, 15.0);
        let thickness = Image::new(32, 32, [1.0, 3.0, 0.0]);
        // Pixel 16 lies at 4.125 texels: three eighths of the fourth, a rim, and five of the fifth.
        let smoothed = Image::from_fn(8, 8, |i, _| if i < 3 { EMPTY } else { 20.0 });
        let behind = Behind {
            boundaries: &boundaries,
            thickness: &thickness,
            smoothed: &smoothed,
            level: 2,
        };
        let back = |front: &Scene, x| {
            let two = Two::new(&front.inputs(1), &behind, &PLAIN, &view);
            two.at(x, 16).expect("water").back.expect("a back sheet")
        };
        let found = back(&front, 16);
        assert_eq!((found.covered, found.apart), (0.625, 1.0));
        assert_eq!(found.surface.thickness, 3.0);
        assert_eq!(back(&front, 22).covered, 1.0);
        assert_eq!(back(&front, 2).covered, 0.0);
        *front.scene.at_mut(16, 16) = 20.0;
        assert_eq!(back(&front, 16).covered, 0.0);
        assert_eq!(back(&front, 22).covered, 1.0);
    }

    #[test]
    fn what_the_front_image_covers_is_of_the_back_one() {
        let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 64, 64);
        let n = DVec3::new(0.3, 0.1, 1.0).normalize();
        let plane = |ray: DVec3| -n.z * 20.0 / ray.dot(n);
        let mut front = Scene::new(&view, 1, 4.0, plane);
        // Something nearer in the first 17 columns, a pixel farther than it is seen.
        for (x, y) in (0..32).flat_map(|y| (0..17).map(move |x| (x, y))) {
            *front.smoothed.at_mut(x, y) = 5.0;
        }
        let reduced = view.reduced(2);
        let smoothed =
            Image::from_fn(reduced.width, reduced.height, |x, y| plane(reduced.ray(x, y)));
        let at = |smoothed: &Image<f64>, x: usize| {
            let boundaries = Image::new(64, 64, EMPTY);
            let thickness = Image::new(64, 64, [4.0, 0.0, 4e6]);
            let behind =
                Behind { boundaries: &boundaries, thickness: &thickness, smoothed, level: 2 };
            Two::new(&front.inputs(1), &behind, &PLAIN, &view).at(x, 30).expect("water").front
        };
        // Pixel 33 sees three quarters of the cover, and a quarter of a texel on its rim: nothing.
        let found = at(&smoothed, 33);
        assert_eq!(found.parts.mixed, 1.0);
        assert!((found.normal - n).length() < 0.02, "{found:?}");
        assert!((-found.position.z - plane(view.ray(33, 30))).abs() < 0.05, "{found:?}");
        // Of pixel 36, at 18.25 texels, all texels are on its surface.
        assert_eq!(at(&smoothed, 36).parts.mixed, 0.0);
        // The back image has no surface there, or half of it.
        let empty = Image::new(16, 16, EMPTY);
        assert_eq!(at(&empty, 33).parts.mixed, 0.0);
        let half = Image::from_fn(16, 16, |x, y| if x < 8 { smoothed.at(x, y) } else { EMPTY });
        let found = at(&half, 33).parts.mixed;
        assert_eq!(found, 0.0, "texels on a rim are not found");
    }

    #[test]
    fn the_offsets_of_both_sheets_add_up() {
        let settings = Settings {
            medium: Medium::Physical {
                absorption: [0.0; 3],
                scattering: [0.0; 3],
                ambient: [0.0; 3],
            },
            fresnel: Fresnel::Source { bias: 0.0, scale: 0.0, power: 1.0 },
            ..PLAIN
        };
        let view = view(DVec2::new(2.0, -2.0), DVec2::ZERO, 65, 65);
        let normals = [(0.2, 0.1), (-0.05, 0.3)].map(|(x, y)| DVec3::new(x, y, 1.0).normalize());
        let plane = |n: DVec3, z: f64| move |ray: DVec3| -n.z * z / ray.dot(n);
        let front = Scene::new(&view, 0, 10.0, plane(normals[0], 10.0));
        let at = plane(normals[1], 20.0);
        let reduced = view.reduced(1);
        let back = Image::from_fn(reduced.width, reduced.height, |x, y| at(reduced.ray(x, y)));
        let behind = Behind {
            boundaries: &Image::new(65, 65, 15.0),
            thickness: &Image::new(65, 65, [2.0, 8.0, 0.0]),
            smoothed: &back,
            level: 1,
        };
        let found = shade_sheets(&front.inputs(0), &behind, &settings, BLACK, &view).at(32, 32);
        // Pixels per length at depth 1.
        let scale = 65.0;
        let by = |n: DVec3, t: f64, z: f64| DVec2::new(-n.x, n.y) * t * 0.25 * scale / z;
        let both = by(normals[0], 2.0, 10.0) + by(normals[1], 8.0, 20.0);
        let share = both.length() * 16.0 / 65.0;
        let expected = 32.0 + both / share.hypot(1.0);
        let found = DVec2::new(found[0], found[1]);
        assert!((found - expected).length() < 0.02, "{found}, not {expected}");
        assert!((expected - 32.0 - by(normals[0], 2.0, 10.0)).length() > 1.0, "one of them only");
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
