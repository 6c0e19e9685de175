//! Twin of the water's composite (thesis Sec. 3.2.3, 4.9; without foam): refraction, absorption
//! along the ray, Fresnel reflection and the highlight.
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

/// The water's medium.
#[derive(Clone, Copy, Debug)]
pub enum Medium {
    /// Single scattering; lengths in scene units.
    Physical {
        /// Absorption per scene unit.
        absorption: [f64; 3],
        /// Scattering per scene unit.
        scattering: [f64; 3],
        /// Radiance that is scattered towards the eye.
        ambient: [f64; 3],
    },
    /// Multiple scattering; lengths in scene units.
    Turbid {
        /// Extinction per scene unit.
        extinction: [f64; 3],
        /// Radiance of an infinitely deep body with a level surface.
        own: [f64; 3],
        /// Fraction of the own radiance that is scattered and not emitted.
        share: f64,
        /// Fraction of the scattered light that also arrives in the shade.
        shade: [f64; 3],
    },
    /// The source's colours.
    Source {
        /// The water's own colour.
        base: [f64; 3],
        /// Falloffs per scene unit: of the base colour, and last of the background.
        k: [f64; 4],
    },
}

/// Reflectance of the surface.
#[derive(Clone, Copy, Debug)]
pub enum Fresnel {
    /// `f0 + (1 - f0) (1 - n.v)^5`.
    Schlick {
        /// Reflectance at normal incidence; 0.02 for water.
        f0: f64,
    },
    /// `bias + scale (1 - n.v)^power`, limited to 0 to 1.
    Source {
        /// Reflectance at normal incidence.
        bias: f64,
        /// Increase at grazing incidence.
        scale: f64,
        /// Exponent of the increase.
        power: f64,
    },
}

impl Fresnel {
    /// Reflectance at the cosine `n.v`.
    pub fn reflectance(&self, cosine: f64) -> f64 {
        // A surface that faces away from the eye counts as grazing.
        let grazing = (1.0 - cosine).clamp(0.0, 1.0);
        match *self {
            Self::Schlick { f0 } => f0 + (1.0 - f0) * grazing.powi(5),
            Self::Source { bias, scale, power } => {
                (bias + scale * grazing.powf(power)).clamp(0.0, 1.0)
            }
        }
    }
}

/// Images of a frame. Depths are eye depths.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// Depth of the water at full resolution, where the scene does not hide it.
    pub depth: &'a Image<f64>,
    /// Smoothed depth at its level.
    pub smoothed: &'a Image<f64>,
    /// Level of the smoothed depth: a texel is a block of `2^level` pixels.
    pub level: u32,
    /// Thickness along z.
    pub thickness: &'a Image<f64>,
    /// Level of the thickness.
    pub thickness_level: u32,
    /// Linear colour of the scene behind.
    pub scene_color: &'a Image<[f64; 4]>,
    /// Depth of the scene, with its own resolution.
    pub scene_depth: &'a Image<f64>,
    /// Noise on the front surface, if there is any.
    pub noise: Option<Ripples<'a>>,
}

impl Inputs<'_> {
    /// Depth of the scene at a pixel.
    pub fn scene(&self, x: usize, y: usize) -> f64 {
        let (scene, depth) = (self.scene_depth, self.depth);
        let texel = |i: usize, texels: usize, pixels: usize| {
            ((i as f64 + 0.5) * texels as f64 / pixels as f64) as usize
        };
        scene.at(texel(x, scene.width, depth.width), texel(y, scene.height, depth.height))
    }
}

/// Settings of the composite.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// r, the drawn radius: reflection fades out in water thinner than r / 4.
    pub radius: f64,
    /// Depths that differ by more than this, in radii, belong to different surfaces.
    pub falloff: f64,
    /// Beta: displacement of the background per thickness and slope.
    pub refraction: f64,
    /// The water's medium.
    pub medium: Medium,
    /// The surface's reflectance.
    pub fresnel: Fresnel,
    /// Strength of the highlight.
    pub specular: [f64; 3],
    /// Exponent of the highlight.
    pub shininess: f64,
    /// Normalized direction to the sun in eye space.
    pub sun_direction: DVec3,
    /// Colour of the sun.
    pub sun_color: [f64; 3],
    /// The bed under the water; without it the scene is only attenuated by the medium.
    pub bed: Option<Bed>,
    /// Steps of the march for the mirrored scene.
    pub mirror_steps: u32,
    /// Refractive index if light is refracted at both surfaces; otherwise the background is
    /// displaced.
    pub exit: Option<f64>,
}

/// Displacement of the background in pixels. Light is refracted towards the normal, so the look-up
/// moves against the normal.
fn displacement(settings: &Settings, surface: &Surface, view: &View) -> DVec2 {
    // Pixels per length at depth z, with the signs of the image's axes.
    let scale = 1.0 / (view.slope_step() * -surface.position.z);
    -surface.normal.truncate() * surface.lens * settings.refraction * scale
}

/// Limits a displacement smoothly to a sixteenth of the picture's height.
pub fn bent(by: DVec2, view: &View) -> DVec2 {
    let most = view.height as f64 / 16.0;
    by * most / by.length().hypot(most)
}

/// Position in pixels at which the background is looked up, displaced by refraction.
pub fn look_up(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    pixel: DVec2,
) -> DVec2 {
    let by = bent(displacement(settings, surface, view), view);
    let wet = Under::met(inputs, settings, surface, view, pixel).wet;
    pixel
        + match settings.exit.filter(|_| wet > 0.0) {
            Some(index) => {
                let by_index = (index, settings.radius / 0.656, &Off::default());
                by.lerp(bed_offset(inputs, surface, view, pixel, by_index).0, wet)
            }
            None => by,
        }
}

/// Whether a position is outside the view, or any of the four texels of the scene's depth around it
/// lies before the water. If the depth has another resolution than the colour, the corners of the
/// pixel are tested.
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

/// Width in picture heights of objects that are looked past.
const THIN: f64 = 1.0 / 60.0;

/// The look-up, at most half the way to an object before the water that is not thin. The search tests
/// up to twice the displacement, bisects to half a pixel, and subtracts a pixel and a half. A look-up on a
/// thin object goes to the end of the object, found by bisection, and a pixel and a half farther. Returns
/// also all tested positions.
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
    let (thin, margin) =
        (THIN * inputs.scene_color.height as f64 / far.max(1.0), 1.5 / far.max(1.0));
    let first = ask(1.0);
    let (mut free, mut blocked) = match (first && ask(1.0 + thin), far < 0.25) {
        (true, _) => (0.0, 1.0),
        // A displacement this small keeps its whole length if its end is free.
        (false, true) => (1.0, 3.0),
        (false, false) if ask(2.0) && ask(2.0 + thin) => (1.0, 2.0),
        (false, false) if first => {
            let (mut inside, mut clear) = (1.0, 1.0 + thin);
            while (clear - inside) * far >= 1.0 {
                let middle = 0.5 * (inside + clear);
                if ask(middle) {
                    inside = middle;
                } else {
                    clear = middle;
                }
            }
            return (at(clear + margin), asked);
        }
        (false, false) => return (displaced, asked),
    };
    while (blocked - free) * far >= 0.5 {
        let middle = 0.5 * (free + blocked);
        if ask(middle) && ask(middle + thin) {
            blocked = middle;
        } else {
            free = middle;
        }
    }
    (at((0.5 * (free - margin)).clamp(0.0, 1.0)), asked)
}

/// Colour of the scene behind a surface, displaced, and never that of an object before the water.
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

/// Colour of the scene at a position.
pub fn scene_at(inputs: &Inputs<'_>, at: DVec2) -> DVec3 {
    let color = |t: &(isize, isize, f64)| {
        let [r, g, b, _] = inputs.scene_color.clamped(t.0, t.1);
        DVec3::new(r, g, b) * t.2
    };
    inputs.scene_color.bilinear(at).iter().map(color).sum()
}

/// Fraction of the reflection that meets the scene, and the colour there.
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

/// Direction of the mirrored ray in world space.
pub fn mirrored(surface: &Surface, view: &View) -> DVec3 {
    let (n, v) = (surface.normal, -surface.position.normalize());
    view.view.inverse().transform_vector3(2.0 * n.dot(v) * n - v).normalize()
}

/// The scene behind a surface, and the environment that it mirrors.
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

/// Light after a path through water from behind, with the light that the water adds.
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

/// The medium under a surface with this normal. A turbid one is brighter where it faces the sun.
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

/// A surface in front of what is behind: attenuation by the water, then reflection and highlight,
/// of which a fraction `part` is present. A fraction of the reflection is the scene, with its own
/// colour.
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
    // Rays mirrored below the horizon meet more water, and not the environment's ground.
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

/// The picture from the colour of each pixel's centre: water over the scene with alpha 1, elsewhere
/// the unchanged scene.
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

/// The picture of one sheet. `env`: the environment's radiance from a direction in world space.
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
        let behind =
            under_water(settings, &Under::met(inputs, settings, &surface, view, pixel), behind);
        let mirrored = of_scene(inputs, None, settings, &surface, view, &env);
        let off = Off::default();
        let seen = exit(inputs, settings, &surface, view, (x, y), behind, &env, &off);
        Some(before(settings, &surface, 1.0, seen.light, &env, mirrored, seen.path, view))
    })
}
