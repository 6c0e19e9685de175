//! The uniform block of all shaders of the scene.

use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};

use super::super::bake::GROUND_FADE;
use super::super::{Scene, SunLight};
use super::sea::Sea;
use super::shadow::{self, SunView};
use crate::contract::Camera;
use crate::error::Error;
use crate::frame::Lens;
use crate::gpu::shader;

/// Radiance of the sun's disc divided by the sun's irradiance: 1 / (solid angle of the disc, in steradians).
const DISC: f32 = 1.0 / 6.8e-5;
/// Maximum radiance of the sun's disc in each channel, so that a half float does not overflow. Under a brighter
/// sun the ratio of radiance to irradiance is smaller than [`DISC`].
const DISC_MOST: f32 = 3.0e4;
/// Height of a missing ground, far from all objects.
const NO_GROUND: f32 = -1e9;

/// The block `Scene` of `glsl/headless/scene.glsl`; its comments say what each member holds.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Uniforms {
    clip: [[f32; 4]; 4],
    shadow: [[f32; 4]; 4],
    eye: [f32; 4],
    ray_x: [f32; 4],
    ray_y: [f32; 4],
    ray_z: [f32; 4],
    sun_direction: [f32; 4],
    sun_color: [f32; 4],
    shadow_texel: [f32; 4],
    ground: [f32; 4],
    air: [f32; 4],
    splashed: [f32; 4],
    sea: Sea,
}

shader::assert_layout!(
    shader::HEADLESS_SCENE_FRAG,
    "Scene",
    Uniforms {
        clip,
        shadow,
        eye,
        ray_x,
        ray_y,
        ray_z,
        sun_direction,
        sun_color,
        shadow_texel,
        ground,
        air,
        splashed,
        sea
    }
);

/// The part of the block that is the same in every frame.
pub struct Surroundings {
    /// Unit vector to the sun.
    pub to_sun: Vec3,
    sun_color: Vec3,
    ground: Option<f32>,
    /// Whether there is a backdrop; below the horizon it replaces the sky.
    backdrop: bool,
    air: [f32; 4],
    /// Centre x and z of the ground, and the distances at which it begins and ends to fade.
    fade: [f32; 4],
    splashed: [f32; 4],
    sea: Sea,
}

impl Surroundings {
    /// # Errors
    /// The scene has a sun with an invalid direction or colour, a `haze` or `metre` that is not above 0,
    /// `clouds` outside [0, 1], a `splashed` that is not finite, or an invalid sea.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let SunLight { direction, color } = scene.sun;
        let Some(to_sun) = Vec3::from(direction).try_normalize() else {
            return Err(Error::bad("Scene.sun.direction", "not finite, or of no length"));
        };
        if !color.iter().all(|c| c.is_finite() && *c >= 0.0) {
            return Err(Error::bad("Scene.sun.color", "expected finite values of at least 0"));
        }
        for (field, length) in [("Scene.haze", scene.haze), ("Scene.metre", scene.metre)] {
            if let Some(length) = length.filter(|l| !(l.is_finite() && *l > 0.0)) {
                return Err(Error::bad(field, format!("expected above 0, found {length}")));
            }
        }
        if !(0.0..=1.0).contains(&scene.clouds) {
            let why = format!("expected 0 to 1, found {}", scene.clouds);
            return Err(Error::bad("Scene.clouds", why));
        }
        let splashed =
            scene.splashed.map_or([1.0, 1.0, -1.0, -1.0], |[[a, b], [c, d]]| [a, b, c, d]);
        if !splashed.iter().all(|v| v.is_finite()) {
            return Err(Error::bad(
                "Scene.splashed",
                format!("expected finite places, found {splashed:?}"),
            ));
        }
        let (low, high) = scene.bounds();
        let (centre, size) = (0.5 * (low + high), (high - low).length());
        let [begin, end] = GROUND_FADE;
        Ok(Self {
            to_sun,
            sun_color: color.into(),
            ground: scene.ground.as_ref().map(|g| g.y),
            backdrop: !scene.backdrop.is_empty(),
            air: [scene.haze.map_or(0.0, f32::recip), scene.metres_per_unit(), scene.clouds, 0.0],
            fade: [centre.x, centre.z, begin * size, end * size],
            splashed,
            sea: Sea::new(scene, to_sun)?,
        })
    }

    /// The sea at the scene's time.
    ///
    /// # Errors
    /// An invalid time or sea.
    pub fn move_sea(&mut self, scene: &Scene) -> Result<(), Error> {
        self.sea = Sea::new(scene, self.to_sun)?;
        Ok(())
    }
}

impl Uniforms {
    /// Returns the block for one picture. `far` is the value of the depth buffer at the far plane (0 or 1), `extent`
    /// the size of the picture in pixels.
    pub fn new(
        surroundings: &Surroundings,
        sun: &SunView,
        camera: &Camera,
        lens: &Lens,
        far: f32,
        extent: vk::Extent2D,
    ) -> Self {
        let Surroundings { to_sun, sun_color, ground, backdrop, air, fade, splashed, sea } =
            *surroundings;
        let world = lens.view.inverse();
        let turn = |v: Vec3, w: f32| world.transform_vector3(v).extend(w).to_array();
        let p = lens.p;
        // The sun's clip space runs from -1 to 1; its y points down in the map, like that of texture
        // coordinates.
        let to_uv = Mat4::from_translation(Vec3::new(0.5, 0.5, 0.0))
            * Mat4::from_scale(Vec3::new(0.5, 0.5, 1.0));
        let disc = DISC.min(DISC_MOST / sun_color.max_element().max(1e-6));
        let texel = 1.0 / shadow::SIZE as f32;
        let shows = if ground.is_some() || backdrop { 1.0 } else { 0.0 };
        Self {
            clip: (camera.projection() * camera.view()).to_cols_array_2d(),
            shadow: (to_uv * sun.clip).to_cols_array_2d(),
            eye: world.transform_point3(Vec3::ZERO).extend(far).to_array(),
            ray_x: turn(Vec3::X / p.x, 2.0 / extent.width.max(1) as f32),
            ray_y: turn(Vec3::Y / p.y, 2.0 / extent.height.max(1) as f32),
            ray_z: turn(Vec3::new(p.z / p.x, p.w / p.y, -1.0), 0.0),
            sun_direction: to_sun.extend(shows).to_array(),
            sun_color: sun_color.extend(disc).to_array(),
            shadow_texel: [texel, texel, sun.texel, ground.unwrap_or(NO_GROUND)],
            ground: fade,
            air,
            splashed,
            sea,
        }
    }

    /// Hides disc and glow of the sun, because the environment contains them.
    pub fn hide_sun(&mut self) {
        self.sun_color[3] = 0.0;
    }
}
