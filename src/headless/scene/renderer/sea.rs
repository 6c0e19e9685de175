//! Uniforms of the sea.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::super::sea::{Liquid, WAVES};
use super::super::{Scene, Sea as Described};
use crate::error::Error;
use crate::gpu::shader;

/// Id of the specialization constant for the kind of sea.
pub const CONSTANT: u32 = 3;

/// The kind as a number of `sea.glsl`; 0 without a sea.
pub fn kind(scene: &Scene) -> u32 {
    match scene.sea.as_ref().map(|sea| sea.liquid) {
        None => 0,
        Some(Liquid::Water) => 1,
        Some(Liquid::Lava { .. }) => 2,
    }
}

/// The sea's part of the uniform block `Scene`; the comments in `glsl/headless/scene.glsl` describe each member.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Sea {
    sea: [f32; 4],
    absorption: [f32; 4],
    scattering: [f32; 4],
    lava: [f32; 4],
    flow: [f32; 4],
    waves: [[f32; 4]; WAVES],
    shifts: [[f32; 4]; WAVES],
}

/// Offset of a member in the block.
const fn offset(member: &str) -> usize {
    shader::HEADLESS_SCENE_FRAG.offset("Scene", member)
        - shader::HEADLESS_SCENE_FRAG.offset("Scene", "sea")
}

const _: () = assert!(
    std::mem::offset_of!(Sea, absorption) == offset("absorption")
        && std::mem::offset_of!(Sea, scattering) == offset("scattering")
        && std::mem::offset_of!(Sea, lava) == offset("lava")
        && std::mem::offset_of!(Sea, flow) == offset("flow")
        && std::mem::offset_of!(Sea, waves) == offset("waves")
        && std::mem::offset_of!(Sea, shifts) == offset("shifts"),
    "the sea's part of the block differs from the shader's"
);

impl Sea {
    /// `to_sun` is the unit vector to the sun.
    ///
    /// # Errors
    /// An invalid sea or time.
    pub fn new(scene: &Scene, to_sun: Vec3) -> Result<Self, Error> {
        let Some(sea) = scene.checked_sea()? else { return Ok(Self::zeroed()) };
        let Described { level, absorption: [ar, ag, ab], scattering: [sr, sg, sb], .. } = *sea;
        let waves = sea.waves_at(scene.time);
        let shifts = Described::shifts_of(&waves);
        let variance = shifts[0][2];
        let radiance = match sea.liquid {
            Liquid::Water => [0.0; 3],
            Liquid::Lava { radiance, .. } => radiance,
        };
        let (drift, again) = sea.drift_at(scene.time);
        let [before, share] = again.unwrap_or_default();
        let loops = if again.is_some() { 1.0 } else { 0.0 };
        let [x, z] = sea.flow();
        // Refraction bends the sun's rays down.
        const REFRACTION: f32 = 1.333;
        let across = (1.0 - to_sun.y * to_sun.y) / (REFRACTION * REFRACTION);
        Ok(Self {
            sea: [level, sea.length, 0.0, 1.0 / (1.0 - across).sqrt()],
            absorption: [ar, ag, ab, variance],
            scattering: [sr, sg, sb, share],
            lava: Vec3::from(radiance).extend(loops).to_array(),
            flow: [x, z, drift, before],
            waves,
            shifts,
        })
    }
}
