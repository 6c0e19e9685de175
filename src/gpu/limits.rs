//! Device limits that the shaders need, counted from their SPIR-V. Some needs exceed the values that every Vulkan
//! device guarantees.

use ash::vk::{self, DescriptorType as Kind};

use super::shader::{ALL, Shader};
use crate::contract::Config;
use crate::error::Error;
use crate::water::coarsening;
use crate::water::settings::{Kernels, Shading, Smoothing};
use crate::whitewater::WhitewaterSplat;

/// A limit that a configuration needs.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Limit {
    /// Its name in `VkPhysicalDeviceLimits`.
    pub name: &'static str,
    /// Min value that suffices.
    pub needed: u32,
    /// The first shader that needs this value: its file under `glsl/`.
    pub shader: &'static str,
    offered: fn(&vk::PhysicalDeviceLimits) -> u32,
}

impl Limit {
    /// The device's value of the limit.
    pub fn of(&self, limits: &vk::PhysicalDeviceLimits) -> u32 {
        (self.offered)(limits)
    }

    fn check(&self, limits: &vk::PhysicalDeviceLimits) -> Result<(), Error> {
        let (Self { name, needed, shader, .. }, offered) = (self, self.of(limits));
        if *needed <= offered {
            return Ok(());
        }
        Err(Error::Missing {
            what: format!("{name} of {needed} (the device has {offered})"),
            why: format!(
                "the shader {shader} needs it; choose another device, or a configuration without this shader"
            ),
        })
    }
}

/// The limits that one shader needs. Limits for a whole descriptor set are not counted: each pipeline has one set,
/// and its shaders together do not come near them.
fn needs(shader: &Shader) -> [Limit; 14] {
    let count = |kind| shader.bindings.iter().filter(|(_, own)| *own == kind).count() as u32;
    let (samplers, buffers) = (count(Kind::COMBINED_IMAGE_SAMPLER), count(Kind::STORAGE_BUFFER));
    let (uniforms, images) = (count(Kind::UNIFORM_BUFFER), count(Kind::STORAGE_IMAGE));
    let fragment = shader.name.ends_with(".frag");
    let attachments = if fragment { shader.outputs } else { 0 };
    let [x, y, z] = shader.local_size;
    let limit = |name, needed, offered| Limit { name, needed, shader: shader.name, offered };
    [
        limit("maxPerStageDescriptorSamplers", samplers, |l| l.max_per_stage_descriptor_samplers),
        limit("maxPerStageDescriptorSampledImages", samplers, |l| {
            l.max_per_stage_descriptor_sampled_images
        }),
        limit("maxPerStageDescriptorStorageBuffers", buffers, |l| {
            l.max_per_stage_descriptor_storage_buffers
        }),
        limit("maxPerStageDescriptorUniformBuffers", uniforms, |l| {
            l.max_per_stage_descriptor_uniform_buffers
        }),
        limit("maxPerStageDescriptorStorageImages", images, |l| {
            l.max_per_stage_descriptor_storage_images
        }),
        limit("maxPerStageResources", samplers + buffers + uniforms + images + attachments, |l| {
            l.max_per_stage_resources
        }),
        limit("maxFragmentOutputAttachments", attachments, |l| l.max_fragment_output_attachments),
        limit(
            "maxFragmentCombinedOutputResources",
            if fragment { buffers + images + attachments } else { 0 },
            |l| l.max_fragment_combined_output_resources,
        ),
        limit("maxPushConstantsSize", shader.push_size, |l| l.max_push_constants_size),
        limit("maxComputeWorkGroupInvocations", x * y * z, |l| {
            l.max_compute_work_group_invocations
        }),
        limit("maxComputeWorkGroupSize[0]", x, |l| l.max_compute_work_group_size[0]),
        limit("maxComputeWorkGroupSize[1]", y, |l| l.max_compute_work_group_size[1]),
        limit("maxComputeWorkGroupSize[2]", z, |l| l.max_compute_work_group_size[2]),
        limit("maxComputeSharedMemorySize", shader.shared, |l| l.max_compute_shared_memory_size),
    ]
}

/// Checks that a device can create a shader's pipeline.
pub fn check(shader: &Shader, limits: &vk::PhysicalDeviceLimits) -> Result<(), Error> {
    needs(shader).iter().try_for_each(|limit| limit.check(limits))
}

/// Checks that a device can create the pipelines of a configuration.
pub fn check_config(
    config: &Config,
    int64_atomics: bool,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<(), Error> {
    of(config, int64_atomics).iter().try_for_each(|limit| limit.check(limits))
}

/// The limits that a configuration needs.
pub fn of(config: &Config, int64_atomics: bool) -> Vec<Limit> {
    let mut most: Vec<Limit> = Vec::new();
    for shader in ALL.iter().filter(|shader| uses(config, int64_atomics, shader.name)) {
        for own in needs(shader) {
            match most.iter_mut().find(|limit| limit.name == own.name) {
                Some(limit) if limit.needed < own.needed => *limit = own,
                Some(_) => {}
                None => most.push(own),
            }
        }
    }
    most
}

/// Whether a renderer with the configuration `config` may use the shader whose path under `glsl/` is `file`.
/// Shaders that only other objects use, such as a `Generator`, do not count.
fn uses(config: &Config, int64_atomics: bool, file: &str) -> bool {
    let Some((folder, name)) = file.split_once('/') else {
        // The path of the composite.
        let stored = crate::composite::way(config) == Shading::Compute;
        return file.ends_with(".comp") == stored;
    };
    let of = |parts: &[&str]| parts.iter().any(|part| name.starts_with(part));
    let whitewater = config.whitewater;
    match folder {
        "water" if of(&["classify"]) => false, // a `SurfaceFoamState`'s
        "water" if of(&["surface_foam"]) => config.surface_foam,
        "water" if of(&["spray"]) => config.spray,
        "water" if of(&["noise"]) => config.noise.is_some(),
        "water" if of(&["motion"]) => config.motion,
        "water" if of(&["back", "gaps"]) => config.sheets > 1,
        "water" if of(&["shape"]) => config.kernels == Kernels::Ellipsoids,
        "water" if of(&["level"]) => coarsening(config) > 0,
        "water" if of(&["smooth_fused"]) => {
            matches!(config.smoothing, None | Some(Smoothing::Fused))
        }
        "light" if of(&["convolution"]) => crate::light::convolution(config).is_some(),
        "light" if of(&["whitewater"]) => whitewater.is_some(),
        "light" => config.light_map_size.is_some(),
        "whitewater" if of(&["splat64"]) => match whitewater.map(|own| own.splat) {
            Some(None) => int64_atomics,
            Some(Some(way)) => way == WhitewaterSplat::Compute64,
            None => false,
        },
        "whitewater" => whitewater.is_some(),
        "bubbles" if of(&["heap"]) => false, // a `BlobSimulation`'s
        "bubbles" if of(&["near"]) => config.bubbles.is_some_and(|own| own.crossfade),
        "bubbles" => config.bubbles.is_some(),
        "gpu" => config.bubbles.is_some() || config.kernels == Kernels::Ellipsoids,
        "shore" if of(&["map"]) => false, // a `ShoreMap`'s
        "shore" => config.shore.is_some(),
        // Used by a `Generator` and by the stand-in scene.
        "generate" | "headless" => false,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected values, counted by hand in the shaders' sources.
    #[test]
    fn the_numbers_are_the_shaders() {
        let extent = vk::Extent2D { width: 8, height: 8 };
        let config = Config::new(extent, vk::Format::R16G16B16A16_SFLOAT, 1);
        let needed = |config: &Config, name: &str| {
            let all = of(config, true);
            all.iter().find(|limit| limit.name == name).map_or(0, |limit| limit.needed)
        };
        assert_eq!(needed(&config, "maxPerStageDescriptorSamplers"), 22);
        assert_eq!(needed(&config, "maxPerStageDescriptorSampledImages"), 22);
        assert_eq!(needed(&config, "maxPerStageDescriptorStorageBuffers"), 8);
        assert_eq!(needed(&config, "maxComputeWorkGroupInvocations"), 256);
        // smooth_fused.comp: two arrays of 32 x 32 words.
        assert_eq!(needed(&config, "maxComputeSharedMemorySize"), 8192);
        let whitewater = crate::whitewater::WhitewaterConfig::new(1);
        let whitewater = Config { whitewater: Some(whitewater), ..config };
        assert_eq!(needed(&whitewater, "maxPerStageDescriptorStorageBuffers"), 10);
    }
}
