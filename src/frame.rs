//! Values derived once per frame and written to the slot's uniform buffer: depth linearisation, slopes of the
//! pixels' rays, frustum planes, settings in the shaders' units.

use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{DMat4, Mat4, Vec3, Vec4};

use crate::contract::{Camera, Config, Frame, Light, LightVolume, Settings};
use crate::error::Error;
use crate::gpu::shader;
use crate::water::panes::{self, MAX_PANES};
use crate::water::settings::{
    Amplitude, Bed, Compositing, Fresnel, GREATEST, Medium, Rule, SpraySettings,
    SurfaceFoamSettings, WATER_INDEX, WaterSettings, range,
};
use crate::water::wavelets::WAVELETS;
use crate::whitewater::settings::{OcclusionReach, ShadowMixing, Submerged};

/// Eye depth that marks an empty pixel. It is larger than that of any surface, so a MIN blend with a surface replaces
/// it.
pub const EMPTY: f32 = 1.0e10;

/// The block `Frame` of `glsl/include/frame.glsl`, whose comments describe each member.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
#[allow(missing_docs)] // documented once, in the shader
pub struct FrameUniforms {
    pub view: [[f32; 4]; 4],
    pub world: [[f32; 4]; 4],
    pub projection: [f32; 4],
    pub depth: [f32; 4],
    pub planes: [[f32; 4]; 6],
    pub extent: [f32; 4],
    pub thick_extent: [f32; 4],
    pub slope: [f32; 4],
    pub thick_slope: [f32; 4],
    pub texel: [f32; 4],
    pub scene_depth: [f32; 4],
    pub scene_color: [f32; 4],
    pub scene_origin: [f32; 4],
    pub target: [f32; 4],
    pub particle: [f32; 4],
    pub density: [f32; 4],
    pub smoothing: [f32; 4],
    pub medium_a: [f32; 4],
    pub medium_b: [f32; 4],
    pub fresnel: [f32; 4],
    pub surface: [f32; 4],
    pub sun_direction: [f32; 4],
    pub sun_color: [f32; 4],
    pub ambient: [f32; 4],
    pub foam: [f32; 4],
    pub foam_noise: [f32; 4],
    pub foam_pattern: [f32; 4],
    pub foam_lace: [f32; 4],
    pub foam_octaves: [f32; 4],
    pub foam_phases: [f32; 4],
    pub foam_back: [f32; 4],
    pub foam_front: [f32; 4],
    pub spray: [f32; 4],
    pub foam_aerated: [f32; 4],
    pub spray_color: [f32; 4],
    pub spray_cloud: [f32; 4],
    pub spray_mist: [f32; 4],
    pub spray_near: [f32; 4],
    pub shadow: [[f32; 4]; 4],
    pub to_light: [[f32; 4]; 4],
    pub shadow_map: [f32; 4],
    pub shadow_rect: [f32; 4],
    pub light_map: [f32; 4],
    pub shade: [f32; 4],
    pub lit_color: [f32; 4],
    pub lit_origin: [f32; 4],
    pub shadow_linear: [f32; 4],
    pub shadow_basis: [f32; 4],
    pub shadow_filter: [f32; 4],
    pub shadow_weight: [[f32; 4]; 4],
    pub before: [[f32; 4]; 4],
    pub before_lens: [f32; 4],
    pub lens_change: [f32; 4],
    pub motion: [f32; 4],
    pub noise: [f32; 4],
    pub noise_image: [f32; 4],
    pub noise_color: [f32; 4],
    pub whitewater: [f32; 4],
    pub whitewater_below: [f32; 4],
    pub whitewater_light: [f32; 4],
    pub whitewater_search: [f32; 4],
    pub whitewater_samples: [f32; 4],
    pub whitewater_opacity: [f32; 4],
    pub whitewater_shadow: [f32; 4],
    pub whitewater_color: [f32; 4],
    pub whitewater_shapes: [[f32; 4]; 3],
    pub whitewater_life: [f32; 4],
    pub whitewater_sun: [f32; 4],
    pub shore_color: [f32; 4],
    pub contact_color: [f32; 4],
    pub up: [f32; 4],
    pub bed: [f32; 4],
    pub bed_light: [f32; 4],
    pub wavelets: [[f32; 4]; WAVELETS],
    pub panes: [[f32; 4]; 3 * MAX_PANES],
}

shader::assert_layout!(
    shader::WATER_CULL_COMP,
    "Frame",
    FrameUniforms {
        view,
        world,
        projection,
        depth,
        planes,
        extent,
        thick_extent,
        slope,
        thick_slope,
        texel,
        scene_depth,
        scene_color,
        scene_origin,
        target,
        particle,
        density,
        smoothing,
        medium_a,
        medium_b,
        fresnel,
        surface,
        sun_direction,
        sun_color,
        ambient,
        foam,
        foam_noise,
        foam_pattern,
        foam_lace,
        foam_octaves,
        foam_phases,
        foam_back,
        foam_front,
        spray,
        foam_aerated,
        spray_color,
        spray_cloud,
        spray_mist,
        spray_near,
        shadow,
        to_light,
        shadow_map,
        shadow_rect,
        light_map,
        shade,
        lit_color,
        lit_origin,
        shadow_linear,
        shadow_basis,
        shadow_filter,
        shadow_weight,
        before,
        before_lens,
        lens_change,
        motion,
        noise,
        noise_image,
        noise_color,
        whitewater,
        whitewater_below,
        whitewater_light,
        whitewater_search,
        whitewater_samples,
        whitewater_opacity,
        whitewater_shadow,
        whitewater_color,
        whitewater_shapes,
        whitewater_life,
        whitewater_sun,
        shore_color,
        contact_color,
        up,
        bed,
        bed_light,
        wavelets,
        panes,
    }
);

/// `∫₀¹ √(1−u)·e^(−2u) du`, the integral of the thickness kernel over ρ².
pub const KERNEL_INTEGRAL: f32 = 0.340_003;

/// Half-axis of a thickness sprite in drawn radii.
pub const THICKNESS_SCALE: f32 = 2.0;

/// Size of an image that is halved `level` times (rounded up).
pub fn reduced(extent: vk::Extent2D, level: u32) -> vk::Extent2D {
    let round = (1 << level) - 1;
    vk::Extent2D {
        width: (extent.width + round) >> level,
        height: (extent.height + round) >> level,
    }
}

/// A decomposed perspective projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// World to eye space, which looks down −z. If the host's eye space looks down +z, this is the host's view with z
    /// mirrored.
    pub view: Mat4,
    /// P₀₀, P₁₁, P₂₀, P₂₁ of the projection: `ndc.x = P₀₀·slope.x − P₂₀` and `ndc.y = P₁₁·slope.y − P₂₁`, with slope
    /// = xy / eye depth.
    pub p: Vec4,
    /// Device depth z to eye depth: `a / (z + b)`.
    pub linear: (f32, f32),
    /// Eye depth of the near plane.
    pub near: f32,
    /// Eye depth of the far plane; infinite if there is none.
    pub far: f32,
}

impl Lens {
    /// Decomposes a camera, or says why it cannot be drawn.
    pub fn new(camera: &Camera) -> Result<Self, Error> {
        let (field_view, field) = ("Frame.camera.view", "Frame.camera.projection");
        if !camera.view().is_finite() || camera.view().determinant().abs() < 1e-12 {
            return Err(Error::bad(field_view, "not finite, or singular"));
        }
        let m = camera.projection;
        if !camera.projection().is_finite() {
            return Err(Error::bad(field, "not finite"));
        }
        // m[column][row]; w_clip = m[2][3]·z + m[3][3].
        if m[2][3].abs() < 0.5 {
            return Err(Error::bad(
                field,
                "orthographic (row 3 is 0 0 0 1): only perspective projections are supported",
            ));
        }
        let mirror = if m[2][3] < 0.0 { 1.0 } else { -1.0 };
        let view = Mat4::from_diagonal(Vec4::new(1.0, 1.0, mirror, 1.0)) * camera.view();
        let scale = 1.0 / m[2][3].abs();
        let (p22, p32) = (mirror * m[2][2] * scale, m[3][2] * scale);
        let p = Vec4::new(m[0][0], m[1][1], mirror * m[2][0], mirror * m[2][1]) * scale;
        if p.x.abs() < 1e-6 || p.y.abs() < 1e-6 || p32.abs() < 1e-12 {
            return Err(Error::bad(field, "singular"));
        }
        let at = |z: f32| {
            let depth = p32 / (z + p22);
            if depth.is_finite() && depth > 0.0 { depth } else { f32::INFINITY }
        };
        let (near, far) = (at(0.0).min(at(1.0)), at(0.0).max(at(1.0)));
        if !near.is_finite() {
            return Err(Error::bad(field, "no near plane: is the depth range 0 to 1?"));
        }
        Ok(Self { view, p, linear: (p32, p22), near, far })
    }

    /// Scale (x, y) and offset (z, w) from the pixel coordinates of an image (centres at +0.5) to slopes of view rays
    /// (xy / eye depth). The image's texels are `scale` full-resolution pixels wide.
    pub fn slope(&self, full: vk::Extent2D, scale: f32) -> Vec4 {
        let x = 2.0 * scale / (full.width as f32 * self.p.x);
        let y = 2.0 * scale / (full.height as f32 * self.p.y);
        Vec4::new(x, y, (self.p.z - 1.0) / self.p.x, (self.p.w - 1.0) / self.p.y)
    }

    /// World size of a pixel per depth.
    pub fn pixel(&self, full: vk::Extent2D) -> [f32; 2] {
        let of = |texels: u32, p: f32| 2.0 / (texels as f32 * p.abs());
        [of(full.width, self.p.x), of(full.height, self.p.y)]
    }

    /// Device depth of the far plane.
    pub fn nothing(&self) -> f32 {
        // Eye depth of device depth 1; with reversed depth that is the near plane.
        let eye = self.linear.0 / (1.0 + self.linear.1);
        if eye > 0.0 && eye < 1.001 * self.near { 0.0 } else { 1.0 }
    }

    /// Planes of the frustum in eye space, with inward normals: a point p is inside where xyz·p + w ≥ 0. If there is
    /// no far plane, its entry accepts every point.
    fn planes(&self) -> [[f32; 4]; 6] {
        let side = |x: f32, y: f32, z: f32| {
            let n = glam::Vec3::new(x, y, z).normalize();
            [n.x, n.y, n.z, 0.0]
        };
        // ±ndc·w ≥ −w: (1 ± (P₀₀ s − P₂₀)) ≥ 0, times the eye depth −z.
        let [px, py, ox, oy] = self.p.to_array();
        let far =
            if self.far.is_finite() { [0.0, 0.0, 1.0, self.far] } else { [0.0, 0.0, 0.0, 1.0] };
        [
            side(px, 0.0, -(1.0 - ox)),
            side(-px, 0.0, -(1.0 + ox)),
            side(0.0, py, -(1.0 - oy)),
            side(0.0, -py, -(1.0 + oy)),
            [0.0, 0.0, -1.0, -self.near],
            far,
        ]
    }
}

impl FrameUniforms {
    /// Fills the block for a frame.
    pub fn new(lens: &Lens, frame: &Frame<'_>, config: &Config) -> Self {
        let full = frame.output.rect.extent;
        let small = reduced(full, config.smoothing_level);
        let thick = reduced(full, config.thickness_level);
        let water = &frame.settings.water;
        let light = &frame.settings.light;
        let (wet, bed_light) = bed(water, light, frame.settings.upward());
        let [shore_color, contact_color] =
            crate::shore::colors(frame.settings).map(|c| c.to_array());
        let radius = water.radius();
        let axis = THICKNESS_SCALE * radius;
        let amplitude = match water.amplitude {
            Amplitude::Volume => {
                water.spacing.powi(3) / (std::f32::consts::PI * KERNEL_INTEGRAL * axis * axis)
            }
            Amplitude::Source => 0.8 * 2.0 * axis,
        };
        let [c_x, c_y] = lens.pixel(full);
        let ratio = |part: vk::Rect2D| {
            let (x, y) = (part.extent.width as f32, part.extent.height as f32);
            [x / full.width as f32, y / full.height as f32, x, y]
        };
        // The copy of an output that is also the scene has the view at its origin, and so has the lit scene.
        let own = frame.in_place() || config.light_map_size.is_some();
        let scene_color = if own { full.into() } else { frame.scene_color.rect };
        let to_world = lens.view.inverse();
        let shadow = frame.shadow.as_ref();
        let region = frame.light_volume.unwrap_or(LightVolume { center: [0.0; 3], radius: 1.0 });
        let edge = config.light_map_size.unwrap_or(1) as f32;
        let convolved = crate::light::Convolved::new(frame, config).unwrap_or_default();
        let lit = frame.scene_color.rect;
        let [depth_at, color_at, target_at] =
            [frame.scene_depth.rect, scene_color, frame.output.rect]
                .map(|part| [part.offset.x as f32, part.offset.y as f32]);
        let fixed = match config.rule {
            Rule::Fixed(count) => count as f32,
            _ => 0.0,
        };
        let (medium_a, medium_b, ambient) = medium(water, light);
        let look = &frame.settings.surface_foam;
        let (parts, carried, began) = pattern_phases(look);
        let ripples = &frame.settings.noise;
        let whitewater = &frame.settings.whitewater;
        let over = config.bubbles.filter(|bubbles| bubbles.crossfade);
        let over = over.map(|_| frame.settings.bubbles.crossfade);
        let [near, far] = over.map_or([0.0; 2], |over| [over.near, over.far]);
        let falloff = match whitewater.submerged {
            Submerged::Water => None,
            Submerged::Falloff { depth, n, m } => Some([depth, n, m, 0.0]),
        };
        // The thesis has no panes.
        let panes = if water.compositing == Compositing::Source { &[] } else { frame.panes };
        let noise_level = config.noise.unwrap_or(0);
        let noisy = reduced(full, noise_level);
        let sun = lens.view.transform_vector3(light.toward()).normalize_or_zero();
        let since = Since::new(lens, frame);
        let mut shapes = [whitewater.foam_shape, whitewater.spray_shape, whitewater.bubble_shape]
            .map(|[n, m]| [n, m, falloff_mean(n, m), 0.0]);
        // Bubbles are hollow.
        shapes[2][2] = 1.0 - shapes[2][2];
        Self {
            view: lens.view.to_cols_array_2d(),
            world: lens.view.inverse().to_cols_array_2d(),
            projection: lens.p.to_array(),
            depth: [lens.linear.0, lens.linear.1, lens.near, lens.far.min(EMPTY)],
            planes: lens.planes(),
            extent: [
                full.width as f32,
                full.height as f32,
                small.width as f32,
                small.height as f32,
            ],
            thick_extent: [
                thick.width as f32,
                thick.height as f32,
                (1 << config.thickness_level) as f32,
                0.0,
            ],
            slope: lens.slope(full, 1.0).to_array(),
            thick_slope: lens.slope(full, (1 << config.thickness_level) as f32).to_array(),
            texel: [c_x, c_y, water.wavelets.amplitude(), panes.len() as f32],
            scene_depth: ratio(frame.scene_depth.rect),
            scene_color: ratio(scene_color),
            scene_origin: [depth_at[0], depth_at[1], color_at[0], color_at[1]],
            target: [target_at[0], target_at[1], f32::from(frame.settings.debug_view as u8), 0.0],
            particle: [radius, water.spacing, axis, amplitude],
            density: densities(frame.settings, config),
            smoothing: [
                water.smoothing_width * radius,
                water.depth_falloff * radius,
                config.max_iterations as f32,
                fixed,
            ],
            medium_a,
            medium_b,
            fresnel: match water.fresnel {
                Fresnel::Schlick { f0 } => [f0, 1.0 - f0, 5.0, 0.0],
                Fresnel::Source { bias, scale, power } => [bias, scale, power, 0.0],
            },
            surface: [
                water.refraction,
                water.specular,
                water.shininess,
                water.depth_falloff * radius,
            ],
            sun_direction: sun.extend(0.0).to_array(),
            sun_color: light_vector(light.color),
            ambient: with(
                light_vector(ambient),
                f32::from(u8::from(water.compositing == Compositing::Source)),
            ),
            foam: [look.extinction, look.front_extinction, look.motion_threshold, look.front_depth],
            foam_noise: [
                look.noise,
                look.noise_rate,
                look.normal_strength,
                look.min_thickness.max(1.0e-6),
            ],
            foam_pattern: [
                3.0 * look.pattern,
                look.lace,
                look.lace_size * water.spacing,
                0.5 * look.pattern_period,
            ],
            foam_lace: [look.lace_shade, 0.0, 0.0, 0.0],
            foam_octaves: [look.pattern_size, began[0], began[1], look.shape],
            foam_phases: [parts[0], parts[1], carried[0], carried[1]],
            foam_back: with(foam_color(look.back_color, light), foam_step(water.spacing)),
            foam_front: with(foam_color(look.front_color, light), look.front_power),
            spray: spray_shape(&frame.settings.spray, water),
            foam_aerated: with(foam_color(look.aerated_color, light), look.aeration),
            spray_color: spray_color(&frame.settings.spray, light),
            spray_cloud: spray_cloud(&frame.settings.spray, water),
            spray_mist: spray_mist(&frame.settings.spray, config),
            spray_near: [frame.settings.spray.max_angle, 0.0, 0.0, 0.0],
            shadow: shadow
                .map_or(Mat4::ZERO, |s| TO_PLACE * s.clip() * to_world)
                .to_cols_array_2d(),
            to_light: (region.to_map(light, frame.settings.upward()) * to_world).to_cols_array_2d(),
            shadow_map: shadow.map_or([0.0; 4], |s| [s.bias, s.nearer(light), 0.0, 0.0]),
            shadow_rect: shadow.map_or([0.0; 4], |s| {
                let part = s.image.rect;
                [
                    part.offset.x as f32,
                    part.offset.y as f32,
                    part.extent.width as f32,
                    part.extent.height as f32,
                ]
            }),
            light_map: [edge, 2.0 * region.radius / edge, water.smoothing_width * radius, 0.0],
            shade: shade(light, look),
            lit_color: ratio(lit),
            lit_origin: [lit.offset.x as f32, lit.offset.y as f32, 0.0, 0.0],
            shadow_linear: convolved.linear,
            shadow_basis: convolved.basis,
            shadow_filter: convolved.filter,
            shadow_weight: convolved.weight,
            before: since.eye,
            before_lens: [since.lens.p.x, since.lens.p.y, since.lens.near, lens.nothing()],
            lens_change: since.lens_change,
            motion: [since.dt / water.spacing, water.spacing, 0.0, 0.0],
            noise: [
                ripples.weight * radius,
                ripples.foam,
                ripples.falloff / radius,
                ripples.size * radius,
            ],
            noise_image: [
                noisy.width as f32,
                noisy.height as f32,
                (1 << noise_level) as f32,
                ripples.cells / radius,
            ],
            noise_color: {
                let [r, g, b, _] = foam_color(ripples.color, light);
                [r, g, b, ripples.airborne]
            },
            whitewater: [whitewater.radius, near, far, f32::from(u8::from(falloff.is_some()))],
            whitewater_below: falloff.unwrap_or([1.0; 4]),
            whitewater_light: [
                whitewater.half_intensity_thickness.log2(),
                whitewater.exponent,
                f32::from(u8::from(whitewater.mixing == ShadowMixing::Source)),
                over.map_or(0.0, |over| over.size),
            ],
            whitewater_search: [
                whitewater.search_radius,
                whitewater.search_radius_step,
                whitewater.passes as f32,
                whitewater.sample_density,
            ],
            whitewater_samples: [
                whitewater.min_samples as f32,
                whitewater.max_samples as f32,
                match whitewater.reach {
                    OcclusionReach::Radii(radii) => radii,
                    OcclusionReach::Metres(metres) => -metres,
                },
                0.0,
            ],
            whitewater_opacity: [
                whitewater.fluid_opacity,
                whitewater.scene_opacity,
                whitewater.shadow_scale,
                whitewater.shadow_exponent,
            ],
            whitewater_shadow: with(
                light_vector(whitewater.shadow_color.map(|c| 1.0 - c)),
                whitewater.shadow_offset,
            ),
            whitewater_color: with(
                light_vector(whitewater.albedo.map(|c| 2.0 * whitewater.scale * c)),
                whitewater.blur,
            ),
            whitewater_shapes: shapes,
            whitewater_life: [
                whitewater.life[0],
                whitewater.life[1],
                whitewater.sizes as f32,
                whitewater.bubble_size,
            ],
            whitewater_sun: sun_on(frame.settings),
            shore_color,
            contact_color,
            up: frame.settings.upward().extend(index(water).recip()).to_array(),
            bed: wet,
            bed_light,
            wavelets: water.wavelets.sines(frame.settings.upward()),
            panes: panes::rows(panes, lens.view),
        }
    }
}

/// Changes since the previous frame.
struct Since {
    /// The previous lens.
    lens: Lens,
    /// Eye space to the previous eye space, minus the identity.
    eye: [[f32; 4]; 4],
    /// Change of P₀₀, P₁₁, P₂₀, P₂₁.
    lens_change: [f32; 4],
    /// Seconds.
    dt: f32,
}

impl Since {
    /// The changes of camera and lens since the previous frame; 0 if there is none. The previous frame's camera is
    /// already checked.
    fn new(lens: &Lens, frame: &Frame<'_>) -> Self {
        let before = frame.previous.and_then(|p| Some((Lens::new(&p.camera).ok()?, p.dt)));
        let (then, dt) = before.unwrap_or((*lens, 0.0));
        // With an unchanged view the difference is exactly 0, without rounding errors.
        let eye = if then.view == lens.view {
            Mat4::ZERO
        } else {
            let to_then = then.view.as_dmat4() * lens.view.as_dmat4().inverse();
            (to_then - DMat4::IDENTITY).as_mat4()
        };
        let lens_change = (lens.p - then.p).to_array();
        Self { lens: then, eye: eye.to_cols_array_2d(), lens_change, dt }
    }
}

/// Radiance of foam with this albedo, lit by the irradiance of level ground (albedo / π of it): bubbles of foam face
/// all directions, and on average receive as much light as level ground.
fn foam_color(albedo: [f32; 3], light: &Light) -> [f32; 4] {
    let [r, g, b] = light.irradiance.map(|c| c * std::f32::consts::FRAC_1_PI);
    [albedo[0] * r, albedo[1] * g, albedo[2] * b, 0.0]
}

/// Mean of `(1 − x^n)^m` over the unit disc, where x is the distance from the centre: `∫₀¹ 2x (1 − x^n)^m dx`. For
/// m = 1 it is 1 − 2/(n + 2). Otherwise it is summed numerically over s, with x = 1 − s³, because the integrand is
/// smooth in s.
fn falloff_mean(n: f32, m: f32) -> f32 {
    let (n, m) = (f64::from(n), f64::from(m));
    if m == 1.0 {
        return (1.0 - 2.0 / (n + 2.0)) as f32;
    }
    let steps = 2048;
    let sum: f64 = (0..steps)
        .map(|i| {
            let s = (f64::from(i) + 0.5) / f64::from(steps);
            let x = 1.0 - s.powi(3);
            2.0 * x * (1.0 - x.powf(n)).powf(m) * 3.0 * s * s
        })
        .sum();
    (sum / f64::from(steps)) as f32
}

/// The sun's irradiance on a surface that faces it, divided by 2π. This irradiance is that of level ground minus that
/// of level ground in the shade, divided by the sine of the sun's elevation; a sine below 0.1 counts as 0.1.
pub fn sun_on(settings: &Settings) -> [f32; 4] {
    let light = &settings.light;
    let height = settings.upward().dot(light.toward()).max(0.1);
    let part = |i: usize| (light.irradiance[i] - light.shade[i]).max(0.0) / height;
    light_vector([part(0), part(1), part(2)].map(|e| e * 0.5 * std::f32::consts::FRAC_1_PI))
}

/// The two level axes for an up direction; for +y they are x and z.
pub fn level_axes(up: Vec3) -> [Vec3; 2] {
    let first = if up.x.abs() < 0.9 { Vec3::X } else { Vec3::Y };
    let east = (first - up * up.dot(first)).normalize();
    [east, east.cross(up)]
}

/// Validates an up direction.
pub fn check_up(field: &'static str, up: [f32; 3]) -> Result<(), Error> {
    match Vec3::from(up).try_normalize() {
        Some(_) => Ok(()),
        None => Err(Error::bad(field, format!("{up:?}: no direction"))),
    }
}

/// Density limits of water and spray, and the number of droplets per particle.
fn densities(settings: &Settings, config: &Config) -> [f32; 4] {
    let (water, spray) = (&settings.water, &settings.spray);
    let own = [water.density_threshold, water.density_full, water.density_threshold];
    let [all, full, none] = if config.spray {
        [spray.all_spray_density, spray.full_water_density, spray.no_spray_density]
    } else {
        own
    }
    .map(|part| part * water.rest_density);
    [all, full, none, spray.droplets as f32]
}

fn spray_shape(spray: &SpraySettings, water: &WaterSettings) -> [f32; 4] {
    let optical_depth = -(1.0 - spray.opacity).ln();
    // A particle's droplets together cover as much as its undivided sprite would: the mean of their squared relative
    // sizes is 0.513, and 0.6 of the droplets are drawn (spray.vert).
    let many = if spray.droplets > 1 { 0.513 * 0.6 * spray.droplets as f32 } else { 1.0 };
    let half_axis = spray.size * water.radius() / many.sqrt();
    [optical_depth, half_axis, spray.scatter_radius * water.spacing, spray.exposure]
}

fn spray_cloud(spray: &SpraySettings, water: &WaterSettings) -> [f32; 4] {
    [-(1.0 - spray.mist).ln(), spray.mist_size * water.spacing, spray.stretch, spray.glints]
}

fn spray_mist(spray: &SpraySettings, config: &Config) -> [f32; 4] {
    // Without spray, particles that are too few for water are not drawn, so they cast no shadow.
    let shade = if config.spray { spray.shade } else { 0.0 };
    [spray.clumps, shade, spray.scattering, spray.relief]
}

fn spray_color(spray: &SpraySettings, light: &Light) -> [f32; 4] {
    let [r, g, b, _] = foam_color(spray.color, light);
    [r, g, b, f32::from(u8::from(spray.additive))]
}

/// Step in scene units to which a sprite's foam thickness is rounded. It is a power of two, so that sums in 32-bit
/// floats are exact up to 4096 spacings.
pub fn foam_step(spacing: f32) -> f32 {
    spacing.log2().floor().exp2() / 2048.0
}

fn with([x, y, z, _]: [f32; 4], w: f32) -> [f32; 4] {
    [x, y, z, w]
}

/// Clip space to image coordinates.
const TO_PLACE: Mat4 = Mat4::from_cols_array(&[
    0.5, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.5, 0.0, 1.0,
]);

/// The noise pattern of surface foam is the weighted sum of two phases, each of which drifts with the foam for one
/// period and then starts anew, half a period apart. Returns for both phases: their weights, such that the variance
/// of the sum is constant; their displacement in units of the drift in half a period, -1 to 1; and their origin in
/// the noise, which is a new one in each period.
fn pattern_phases(look: &SurfaceFoamSettings) -> ([f32; 2], [f32; 2], [f32; 2]) {
    let cycles = look.time / f64::from(look.pattern_period);
    let [one, other] = [0.0, 0.5].map(|late| {
        let at = cycles + late;
        let carried = 2.0 * (at - at.floor()) - 1.0;
        // The origins are far apart in the noise for successive periods of a phase, and for the two phases.
        let began = 2.0 * at.floor() + if late > 0.0 { 1.0 } else { 0.0 };
        (1.0 - carried.abs(), carried, (17.0 * began).rem_euclid(256.0))
    });
    let whole = one.0.hypot(other.0);
    (
        [(one.0 / whole) as f32, (other.0 / whole) as f32],
        [one.1 as f32, other.1 as f32],
        [one.2 as f32, other.2 as f32],
    )
}

/// Ratio of shade to sunlight; foam's extinction of sunlight.
fn shade(light: &Light, foam: &SurfaceFoamSettings) -> [f32; 4] {
    let part = |i: usize| {
        let whole = light.irradiance[i];
        if whole > 0.0 { (light.shade[i] / whole).clamp(0.0, 1.0) } else { 1.0 }
    };
    [part(0), part(1), part(2), foam.shadow]
}

/// Index of refraction n of the water. With Schlick's form it follows from the reflectance at normal incidence, which
/// is ((n - 1)/(n + 1))^2.
fn index(water: &WaterSettings) -> f32 {
    match water.fresnel {
        Fresnel::Schlick { f0 } => {
            let root = f0.clamp(0.0, 1.0).sqrt();
            (1.0 + root) / (1.0 - root).max(1.0e-3)
        }
        Fresnel::Source { .. } => WATER_INDEX,
    }
}

/// Share of the light of a uniform sky that passes into the water: 1 minus the mean reflectance of the surface. The
/// mean of Schlick's reflectance is F0 + (1 - F0)/21. The mean of the thesis' form, with power p, is bias + 2
/// scale/((p + 1)(p + 2)).
fn comes_in(water: &WaterSettings) -> f32 {
    let mean = match water.fresnel {
        Fresnel::Schlick { f0 } => f0 + (1.0 - f0) / 21.0,
        Fresnel::Source { bias, scale, power } => {
            bias + 2.0 * scale / ((power + 1.0) * (power + 2.0))
        }
    };
    (1.0 - mean).clamp(1.0e-3, 1.0)
}

/// Share of diffuse light inside the water that leaves it.
fn leaves(water: &WaterSettings) -> f32 {
    let n = index(water);
    (comes_in(water) / (n * n)).max(1.0e-3)
}

/// Computes the uniforms `bed` and `bed_light`: how the water's surface changes the light that passes down to the
/// ground below and back up from it.
fn bed(water: &WaterSettings, light: &Light, up: Vec3) -> ([f32; 4], [f32; 4]) {
    let per_light = |e: f32| std::f32::consts::PI / e.max(1.0e-9);
    let [r, g, b] = light.irradiance.map(per_light);
    if water.bed == Bed::Source {
        return ([1.0, 0.0, 0.0, 0.0], [r, g, b, 1.0]);
    }
    let n = index(water);
    let comes_in = comes_in(water);
    let leaves = leaves(water);
    // Path of an even sky's light per unit of depth: the mean of 1/cos of the angle inside, over sin^2 of the angle
    // outside, is 2 n^2 (1 - sqrt(1 - 1/n^2)); this form has no cancellation.
    let sky = 2.0 / (1.0 + (1.0 - 1.0 / (n * n)).max(0.0).sqrt());
    let cosine = light.toward().dot(up).clamp(0.0, 1.0);
    let inside = (1.0 - (1.0 - cosine * cosine) / (n * n)).max(1.0e-6).sqrt();
    let reflected = match water.fresnel {
        Fresnel::Schlick { f0 } => f0 + (1.0 - f0) * (1.0 - cosine).powi(5),
        Fresnel::Source { bias, scale, power } => bias + scale * (1.0 - cosine).powf(power),
    };
    let sun = (1.0 - reflected).clamp(0.0, 1.0) / comes_in;
    ([leaves, sky, inside.recip(), n.recip()], [r, g, b, sun])
}

fn light_vector(c: [f32; 3]) -> [f32; 4] {
    [c[0], c[1], c[2], 0.0]
}

/// Uniforms `medium_a`, `medium_b` and `ambient`. The shaders compute absorption and single scattering of a given
/// ambient light. A turbid medium is passed as one that only scatters, with the radiance of an infinitely deep body
/// of it in place of the ambient light. The last component of `medium_b` is then the share of this radiance that is
/// scattered light, which depends on the sun and the slope of the surface; the rest is emission.
fn medium(water: &WaterSettings, light: &Light) -> ([f32; 4], [f32; 4], [f32; 3]) {
    match water.medium {
        Medium::Physical { absorption: a, scattering: s } => {
            ([a[0], a[1], a[2], 0.0], [s[0], s[1], s[2], 0.0], light.ambient)
        }
        Medium::Turbid { absorption: a, scattering: s, emission } => {
            let leaves = leaves(water);
            let scattered = [0, 1, 2].map(|i| {
                let white = light.irradiance[i] * std::f32::consts::FRAC_1_PI;
                white * reflectance(a[i], s[i], leaves)
            });
            let own = [0, 1, 2].map(|i| scattered[i] + emission[i]);
            let whole = own[0] + own[1] + own[2];
            let share = if whole > 0.0 { scattered.iter().sum::<f32>() / whole } else { 0.0 };
            ([0.0; 4], [a[0] + s[0], a[1] + s[1], a[2] + s[2], share], own)
        }
        Medium::Source { base, falloff } => {
            ([base[0], base[1], base[2], 1.0], falloff, light.ambient)
        }
    }
}

/// Diffuse reflectance of a half space with this absorption and scattering per scene unit (van de Hulst 1980). The
/// surface above it lets the share `leaves` of the light from below out; its own reflection is not included.
fn reflectance(absorption: f32, scattering: f32, leaves: f32) -> f32 {
    let extinction = absorption + scattering;
    if extinction <= 0.0 {
        return 0.0;
    }
    let s = (absorption / extinction).sqrt();
    let bare = (1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s);
    leaves * bare / (1.0 - (1.0 - leaves) * bare)
}

/// Validates the settings; the message names the field.
pub fn check_settings(water: &WaterSettings, light: &Light) -> Result<(), Error> {
    let at_least = |field, value: f32, least: f32| {
        if value >= least && value <= GREATEST {
            Ok(())
        } else {
            let why = format!("expected at least {least}, at most {GREATEST}, found {value}");
            Err(Error::bad(field, why))
        }
    };
    at_least("Settings.water.spacing", water.spacing, 1e-6)?;
    at_least("Settings.water.rest_density", water.rest_density, 1e-6)?;
    at_least("Settings.water.density_threshold", water.density_threshold, 0.0)?;
    at_least("Settings.water.density_full", water.density_full, water.density_threshold)?;
    at_least("Settings.water.smoothing_width", water.smoothing_width, 0.0)?;
    at_least("Settings.water.depth_falloff", water.depth_falloff, 0.0)?;
    water.ellipsoids.check()?;
    water.wavelets.check()?;
    at_least("Settings.water.refraction", water.refraction, 0.0)?;
    at_least("Settings.water.specular", water.specular, 0.0)?;
    at_least("Settings.water.shininess", water.shininess, 1.0)?;
    let numbers: &[f32] = match &water.medium {
        Medium::Physical { absorption: a, scattering: s } => &[*a, *s].concat(),
        Medium::Turbid { absorption: a, scattering: s, emission: e } => &[*a, *s, *e].concat(),
        Medium::Source { base, falloff } => {
            for value in base {
                range("Settings.water.medium.base", *value, 0.0, 1.0)?;
            }
            falloff
        }
    };
    for value in numbers {
        at_least("Settings.water.medium", *value, 0.0)?;
    }
    match water.fresnel {
        Fresnel::Schlick { f0 } => range("Settings.water.fresnel.f0", f0, 0.0, 1.0)?,
        Fresnel::Source { bias, scale, power } => {
            for value in [bias, scale, power] {
                at_least("Settings.water.fresnel", value, 0.0)?;
            }
        }
    }
    let direction = glam::Vec3::from(light.direction);
    if !direction.is_finite() || direction == glam::Vec3::ZERO {
        return Err(Error::bad("Settings.light", format!("direction {direction}: no direction")));
    }
    for value in
        light.color.into_iter().chain(light.ambient).chain(light.irradiance).chain(light.shade)
    {
        at_least("Settings.light", value, 0.0)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares `falloff_mean(n, m)` with its closed form `(2/n) B(2/n, m + 1)`, B being the beta function: 1/(m + 1)
    /// for n = 2 and 2/((m + 1)(m + 2)) for n = 1.
    #[test]
    fn the_mean_of_a_falloff_is_its_integral() {
        for m in [0.1_f32, 0.4, 1.0, 2.5, 16.0] {
            assert!((falloff_mean(2.0, m) - 1.0 / (m + 1.0)).abs() < 1.0e-5, "{m}");
            let linear = 2.0 / ((m + 1.0) * (m + 2.0));
            assert!((falloff_mean(1.0, m) - linear).abs() < 1.0e-5, "{m}");
        }
        assert_eq!(falloff_mean(1.5, 1.0), (1.0 - 2.0 / 3.5_f64) as f32);
    }

    fn camera(projection: Mat4) -> Camera {
        seen(Mat4::IDENTITY, projection)
    }

    fn seen(view: Mat4, projection: Mat4) -> Camera {
        Camera::new(view.to_cols_array_2d(), projection.to_cols_array_2d())
    }

    /// A `Lens` recovers the depth and the slope of a point from the point's projection, for every convention of
    /// projections.
    #[test]
    fn lens_inverts_every_projection() {
        let mut off_axis = Mat4::perspective_rh(0.8, 1.5, 0.1, 50.0);
        off_axis.z_axis.x = 0.3;
        off_axis.z_axis.y = -0.2;
        let left_handed = Mat4::perspective_lh(0.8, 1.5, 0.1, 50.0);
        for (projection, far) in [
            (Mat4::perspective_rh(0.8, 1.5, 0.1, 50.0), 50.0),
            (Mat4::perspective_infinite_rh(0.8, 1.5, 0.1), f32::INFINITY),
            (Mat4::perspective_infinite_reverse_rh(0.8, 1.5, 0.1), f32::INFINITY),
            (off_axis, 50.0),
            (left_handed, 50.0),
        ] {
            let lens = Lens::new(&camera(projection)).expect("valid");
            assert!((lens.near - 0.1).abs() < 1e-6);
            assert!(far.is_infinite() && lens.far > 1e4 || (lens.far - far).abs() < 0.01 * far);
            let forward = if projection == left_handed { 1.0 } else { -1.0 };
            let point = Vec3::new(0.4, -0.7, forward * 3.0);
            let clip = projection * point.extend(1.0);
            let ndc = clip / clip.w;
            let depth = lens.linear.0 / (ndc.z + lens.linear.1);
            assert!((depth - 3.0).abs() < 1e-4, "{depth} {projection}");
            let full = vk::Extent2D { width: 300, height: 200 };
            let slope = lens.slope(full, 1.0);
            let pixel = (ndc * 0.5 + 0.5) * Vec4::new(300.0, 200.0, 1.0, 1.0);
            assert!((pixel.x * slope.x + slope.z - point.x / 3.0).abs() < 1e-5);
            assert!((pixel.y * slope.y + slope.w - point.y / 3.0).abs() < 1e-5);
        }
    }

    #[test]
    fn lens_refuses_what_it_cannot_draw() {
        let flat = Mat4::orthographic_rh(-1.0, 1.0, -1.0, 1.0, 0.1, 10.0);
        for bad in [flat, Mat4::ZERO, Mat4::NAN] {
            assert!(matches!(Lens::new(&camera(bad)), Err(Error::BadInput { .. })));
        }
        let singular = seen(Mat4::ZERO, Mat4::perspective_rh(1.0, 1.0, 0.1, 9.0));
        assert!(matches!(Lens::new(&singular), Err(Error::BadInput { .. })));
    }
}
