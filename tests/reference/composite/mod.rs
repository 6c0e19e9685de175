//! Twin of the water's composite (thesis Sec. 3.2.3, 4.9; without foam): refraction, absorption along the ray,
//! Fresnel reflection and the highlight of the surface.
//! ```text
//! P = (s_x z, s_y z, -z)    n = P_x x P_y normalized, towards the eye    path = T |P| / z
//! Physical  C = background t + ambient (scattering / ext) (1 - t),    t = exp(-ext path)
//! Turbid    C = background t + own (1 - t),    own = emission + R E / pi, R of medium.rs
//! Source    C = mix(base exp(-k path), background, exp(-k_a path))
//! C <- mix(C, env(R), w F) + w specular sun max(n.h, 0)^shininess,   w = smoothstep(0, r/4, T)
//! ```

mod bed;
mod exit;
pub mod medium;
mod met_water;
mod mirror;
mod sheets;
pub mod source;
#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

use super::noise::Ripples;
use super::surface::{Surface, Surfaces};
use super::{Image, View, smoothstep};

pub use bed::{Bed, Under, under_water};
pub use exit::{Off, bed_about, bed_offset, exit, exit_about};
pub use met_water::met_scene;
pub use mirror::{Met, direction, met, met_about};
pub use sheets::{Behind, Shown, Two, look_up_both, shade_sheets};

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
    /// As it scatters many times: metres and radiance.
    Turbid {
        /// Per metre.
        extinction: [f64; 3],
        /// The radiance of an endless body with a level surface.
        own: [f64; 3],
        /// Share of it that is scattered.
        share: f64,
        /// Share of its light that comes where the sun does not.
        shade: [f64; 3],
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
    /// What water does to the scene under it; without: nothing but what the medium takes straight on.
    pub bed: Option<Bed>,
    /// Steps of the march for what of the scene is mirrored.
    pub mirror_steps: u32,
    /// The index of refraction where light comes through both surfaces; without: what is behind, displaced.
    pub exit: Option<f64>,
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
pub fn look_up(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    pixel: DVec2,
) -> DVec2 {
    let by = bent(displacement(settings, surface, view), view);
    let wet = Under::of(settings, surface, view).wet;
    pixel
        + match settings.exit.filter(|_| wet > 0.0) {
            Some(index) => {
                by.lerp(bed_offset(inputs, surface, view, pixel, (index, &Off::default())), wet)
            }
            None => by,
        }
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
    let q = look_up(inputs, settings, surface, view, pixel);
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

/// How much of the scene a surface mirrors, and the colour there.
fn of_scene(
    inputs: &Inputs<'_>,
    behind: Option<&Behind<'_>>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    env: impl Fn(DVec3) -> DVec3,
) -> (f64, DVec3) {
    let Met { at, share } = met(inputs, settings, surface, view);
    if share == 0.0 {
        return (0.0, DVec3::ZERO);
    }
    (share, met_scene(inputs, behind, settings, view, (at, direction(surface)), env))
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
        Medium::Turbid { extinction, own, .. } => {
            let t = exp(DVec3::from(extinction));
            behind * t + DVec3::from(own) * (1.0 - t)
        }
        Medium::Source { base, k: [r, g, b, a] } => {
            let water = DVec3::from(base) * exp(DVec3::new(r, g, b));
            water.lerp(behind, (-a * path).exp())
        }
    }
}

/// The medium under a surface of a normal: a turbid one is as bright as it faces the sun.
fn lit_medium(settings: &Settings, n: DVec3, view: &View) -> Medium {
    match settings.medium {
        Medium::Turbid { extinction, own, share, shade } => {
            let level = settings.sun_direction.dot(view.view.transform_vector3(DVec3::Y));
            let facing = n.dot(settings.sun_direction);
            let own = [0, 1, 2].map(|i| own[i] * medium::lit(share, shade[i], facing, level));
            Medium::Turbid { extinction, own, share, shade }
        }
        other => other,
    }
}

/// A surface before what is behind it: through the water, then what it mirrors and the highlight,
/// of which a part is there. Of what it mirrors, the scene has a share, with its colour.
#[allow(clippy::too_many_arguments)] // each is one thing that a pixel goes by
fn before(
    settings: &Settings,
    surface: &Surface,
    part: f64,
    behind: DVec3,
    env: impl Fn(DVec3) -> DVec3,
    (met, scene): (f64, DVec3),
    path: f64,
    view: &View,
) -> DVec3 {
    let Surface { position, normal: n, thickness, .. } = *surface;
    let v = -position.normalize();
    let mut color = through(&lit_medium(settings, n, view), behind, path);

    let w = part * smoothstep(0.0, settings.radius / 4.0, thickness);
    let reflected = mirrored(surface, view);
    // What is mirrored from below the horizon is more water, not the environment's ground.
    let sky = smoothstep(-0.3, 0.0, reflected.y);
    let reflectance = w * settings.fresnel.reflectance(n.dot(v));
    let free = sky * (1.0 - met);
    color = color * (1.0 - reflectance * (free + met))
        + reflectance * (free * env(reflected) + met * scene);

    let h = (v + settings.sun_direction).normalize_or_zero();
    let highlight = n.dot(h).max(0.0).powf(settings.shininess);
    let shine = DVec3::from(settings.specular) * DVec3::from(settings.sun_color) * highlight;
    color + w * (shine + surface.ripple.foam)
}

/// The picture by what each pixel shows, at its middle, where there is water: that over the scene with
/// alpha 1, the scene as it is elsewhere.
fn over_scene(
    inputs: &Inputs<'_>,
    view: &View,
    water: impl Fn(usize, usize, DVec2) -> Option<DVec3> + Sync,
) -> Image<[f64; 4]> {
    Image::from_fn(view.width, view.height, |x, y| {
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let color = water(x, y, pixel).map(|color| color.extend(1.0).to_array());
        color.unwrap_or_else(|| inputs.scene_color.at(x, y))
    })
}

/// The picture of one sheet. `env` gives the environment's radiance from a direction in the world.
pub fn shade(
    inputs: &Inputs<'_>,
    settings: &Settings,
    env: impl Fn(DVec3) -> DVec3 + Sync,
    view: &View,
) -> Image<[f64; 4]> {
    let surfaces = Surfaces::new(inputs, settings, view);
    over_scene(inputs, view, |x, y, pixel| {
        let surface = surfaces.at(x, y)?;
        let behind = background(inputs, settings, &surface, view, pixel);
        let behind = under_water(settings, &Under::of(settings, &surface, view), behind);
        let mirrored = of_scene(inputs, None, settings, &surface, view, &env);
        let off = Off::default();
        let seen = exit(inputs, settings, &surface, view, (x, y), behind, &env, &off);
        Some(before(settings, &surface, 1.0, seen.light, &env, mirrored, seen.path, view))
    })
}
