//! Requirements of the library on a device, and checks of what a device supports.

use std::ffi::CStr;

use ash::vk;

use crate::bubbles::bytes_bound as bubble_bytes;
use crate::contract::EnabledFeatures;
use crate::error::Error;
use crate::gpu::{limits, loaded};
use crate::shore::bytes_bound as shore_bytes;
use crate::water::settings::{Gate, Shading, Smoothing, Splat};
use crate::water::{
    DEFAULT_SPLAT, foam_bytes, shape_bytes, smoothing_extent, thickness_bytes, water_bytes,
};
use crate::whitewater::WhitewaterSplat;
use crate::whitewater::splat::word_bytes;

pub use limits::Limit;

crate::contract::with!(DeviceSupport);

/// A feature or extension that the host must or may enable, and the reason.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Requirement {
    /// Feature or extension.
    pub what: &'static str,
    /// Its purpose; for optional ones, what happens without it.
    pub why: &'static str,
}

/// Requirements to check before a device is created.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Requirements {
    /// Vulkan version of the device.
    pub api_version: u32,
    /// Features that must be enabled.
    pub features: &'static [Requirement],
    /// Recommended features and extensions.
    pub optional: &'static [Requirement],
    /// Names of the optional device extensions.
    pub optional_extensions: &'static [&'static CStr],
}

/// Returns the Vulkan version, features and extensions that the library needs or can use. Call this function before
/// creating the device. The device limits that a configuration needs are returned by [`DeviceSupport::limits`].
pub fn requirements() -> Requirements {
    Requirements {
        api_version: vk::API_VERSION_1_2,
        features: &[],
        optional: &[
            Requirement {
                what: "synchronization2",
                why: "for precise barriers; without it those of Vulkan 1.0 are used",
            },
            Requirement {
                what: "shaderStorageImageWriteWithoutFormat",
                why: "needed only below Vulkan 1.3, for Config.surface_foam, Config.motion, Shadows::Convolution, \
                      Shading::Compute",
            },
            Requirement {
                what: "VK_EXT_conditional_rendering, conditionalRendering",
                why: "for Smoothing::Query(Gate::Predicate) of the feature diagnostics; without it the other gates work",
            },
            Requirement {
                what: "drawIndirectCount",
                why: "for Smoothing::Query(Gate::DrawCount) of the feature diagnostics; without it the other gates work",
            },
            Requirement {
                what: "occlusionQueryPrecise",
                why: "for exact sample counts; without it they are zero or non-zero, which is enough to stop",
            },
            Requirement {
                what: "largePoints",
                why: "for sprites as points; without it all sprites are quads",
            },
            Requirement {
                what: "shaderBufferInt64Atomics, shaderInt64",
                why: "for whitewater in one pass over its particles; without them it takes two",
            },
            Requirement {
                what: "VK_EXT_debug_utils",
                why: "for names and labels; without it there are none",
            },
        ],
        optional_extensions: &[
            ash::ext::conditional_rendering::NAME,
            ash::khr::synchronization2::NAME,
        ],
    }
}

/// What a device supports. A plain struct, so that tests can mock it.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DeviceSupport {
    /// Vulkan version of the device. On an instance of Vulkan 1.0 it is 1.0. An instance of 1.1 or 1.2 limits what the
    /// host may use to its own version, but most loaders do not tell it: pass the version of your instance to
    /// [`with_enabled`](Self::with_enabled), whatever this field says.
    pub api_version: u32,
    /// R32_SFLOAT and R32G32B32A32_SFLOAT support blending as colour attachments: needed by the raster splats.
    pub blend_floats: bool,
    /// Whether R32_SFLOAT, R32G32_SFLOAT and R32G32B32A32_SFLOAT support blending as colour attachments, and the last
    /// two also storing without a format qualifier: needed by surface foam.
    pub foam_floats: bool,
    /// First: whether the format R8G8B8A8_SNORM supports both storing without a format qualifier and linear
    /// filtering, which convolution shadow maps of 8 bits need. Second: the same of R16G16B16A16_SFLOAT for 16 bits.
    pub basis: [bool; 2],
    /// R32G32_SFLOAT supports storing without a format qualifier: needed by motion vectors.
    pub motion_floats: bool,
    /// The output format can be a colour attachment.
    pub output_attachment: bool,
    /// The output format supports storing without a format qualifier.
    pub output_storage: bool,
    /// Optional features that the device supports. A host that enables all of them passes this value as
    /// [`Host::enabled`](crate::Host::enabled). `debug_utils` is always false here, because it belongs to the instance:
    /// set it yourself.
    pub optional: EnabledFeatures,
    /// Limits.
    pub limits: vk::PhysicalDeviceLimits,
    /// Whether the device is used with Vulkan 1.2 and supports `shaderStorageImageWriteWithoutFormat`, but the host
    /// did not enable it; error messages then recommend enabling it.
    not_enabled: bool,
}

impl DeviceSupport {
    /// Queries a physical device.
    pub fn of(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        output_format: vk::Format,
    ) -> Self {
        if !loaded::of_instance(instance) {
            // SAFETY: the handles are alive and belong together.
            let properties = unsafe { instance.get_physical_device_properties(physical) };
            return Self::bare(properties.limits);
        }
        let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
        let mut second = vk::PhysicalDeviceSynchronization2Features::default();
        let mut conditional = vk::PhysicalDeviceConditionalRenderingFeaturesEXT::default();
        let mut features = vk::PhysicalDeviceFeatures2::default()
            .push_next(&mut v12)
            .push_next(&mut second)
            .push_next(&mut conditional);
        // SAFETY: the handles are alive and belong together; the chain is well formed.
        let properties = unsafe {
            instance.get_physical_device_features2(physical, &mut features);
            instance.get_physical_device_properties(physical)
        };
        let core = features.features;
        let api_version = loaded::api_version(instance, &properties);
        let stores = core.shader_storage_image_write_without_format == vk::TRUE;
        let offers = |format, features: vk::FormatFeatureFlags2| {
            if api_version < vk::API_VERSION_1_3 {
                let without_format = vk::FormatFeatureFlags2::STORAGE_WRITE_WITHOUT_FORMAT;
                // SAFETY: as above.
                let found =
                    unsafe { instance.get_physical_device_format_properties(physical, format) };
                let asked = (features & !without_format).as_raw() as u32;
                return found
                    .optimal_tiling_features
                    .contains(vk::FormatFeatureFlags::from_raw(asked))
                    && (stores || !features.contains(without_format));
            }
            let mut found = vk::FormatProperties3::default();
            let mut chain = vk::FormatProperties2::default().push_next(&mut found);
            // SAFETY: as above.
            unsafe {
                instance.get_physical_device_format_properties2(physical, format, &mut chain);
            }
            found.optimal_tiling_features.contains(features)
        };
        let blended = vk::FormatFeatureFlags2::COLOR_ATTACHMENT_BLEND;
        let stored = vk::FormatFeatureFlags2::STORAGE_IMAGE
            | vk::FormatFeatureFlags2::STORAGE_WRITE_WITHOUT_FORMAT;
        Self {
            optional: EnabledFeatures {
                synchronization2: second.synchronization2 == vk::TRUE,
                storage_image_write_without_format: stores,
                // It belongs to the instance, not to the device.
                debug_utils: false,
                // A device without the extension leaves the structure as it was.
                conditional_rendering: conditional.conditional_rendering == vk::TRUE,
                draw_indirect_count: v12.draw_indirect_count == vk::TRUE,
                large_points: core.large_points == vk::TRUE,
                precise_occlusion_queries: core.occlusion_query_precise == vk::TRUE,
                buffer_int64_atomics: core.shader_int64 == vk::TRUE
                    && v12.shader_buffer_int64_atomics == vk::TRUE,
            },
            api_version,
            blend_floats: offers(vk::Format::R32_SFLOAT, blended)
                && offers(vk::Format::R32G32B32A32_SFLOAT, blended),
            foam_floats: offers(vk::Format::R32_SFLOAT, blended)
                && offers(vk::Format::R32G32_SFLOAT, blended | stored)
                && offers(vk::Format::R32G32B32A32_SFLOAT, blended | stored),
            basis: [vk::Format::R8G8B8A8_SNORM, vk::Format::R16G16B16A16_SFLOAT].map(|format| {
                offers(format, stored | vk::FormatFeatureFlags2::SAMPLED_IMAGE_FILTER_LINEAR)
            }),
            motion_floats: offers(vk::Format::R32G32_SFLOAT, stored),
            output_attachment: offers(output_format, vk::FormatFeatureFlags2::COLOR_ATTACHMENT),
            output_storage: offers(output_format, stored),
            limits: properties.limits,
            not_enabled: false,
        }
    }

    /// Vulkan 1.0 without anything.
    fn bare(limits: vk::PhysicalDeviceLimits) -> Self {
        Self {
            api_version: vk::API_VERSION_1_0,
            blend_floats: false,
            foam_floats: false,
            basis: [false; 2],
            motion_floats: false,
            output_attachment: false,
            output_storage: false,
            optional: EnabledFeatures::default(),
            limits,
            not_enabled: false,
        }
    }

    /// Restricts this support to what remains if the host creates its instance for the Vulkan version `api_version`
    /// and enables exactly the features `enabled`. Below Vulkan 1.3 no format supports storing without a qualifier
    /// unless [`storage_image_write_without_format`](EnabledFeatures::storage_image_write_without_format) is enabled.
    #[must_use]
    pub fn with_enabled(mut self, api_version: u32, enabled: EnabledFeatures) -> Self {
        self.api_version = self.api_version.min(api_version);
        if self.api_version < vk::API_VERSION_1_3 {
            self = self.before_1_3(&enabled);
        }
        self.optional = enabled;
        self
    }

    /// Support on a device of Vulkan 1.2 whose host enables these features.
    pub(crate) fn before_1_3(mut self, enabled: &EnabledFeatures) -> Self {
        if !enabled.storage_image_write_without_format {
            self.not_enabled = self.optional.storage_image_write_without_format;
            self.foam_floats = false;
            self.basis = [false; 2];
            self.motion_floats = false;
            self.output_storage = false;
        }
        self
    }

    /// The device limits that a configuration needs: descriptors, workgroups, attachments, push constants.
    pub fn limits(&self, config: &crate::contract::Config) -> Vec<Limit> {
        limits::of(config, self.optional.buffer_int64_atomics)
    }

    /// Checks the device against a configuration.
    ///
    /// # Errors
    /// [`Error::Missing`], which says what is missing and what to do.
    pub fn check(&self, config: &crate::contract::Config) -> Result<(), Error> {
        let missing = |what: String, why: &str| {
            let mut why = why.to_owned();
            if self.not_enabled && what.contains("storage use") {
                why += "; or enable shaderStorageImageWriteWithoutFormat \
                        (EnabledFeatures::storage_image_write_without_format), which the device supports";
            }
            Err(Error::Missing { what, why })
        };
        if self.api_version < vk::API_VERSION_1_2 {
            return missing(
                format!(
                    "Vulkan 1.2 (the device, or the instance, has {}.{})",
                    vk::api_version_major(self.api_version),
                    vk::api_version_minor(self.api_version)
                ),
                "the library is written for it; choose another device or a newer driver",
            );
        }
        limits::check_config(config, self.optional.buffer_int64_atomics, &self.limits)?;
        match crate::composite::way(config) {
            Shading::Raster if !self.output_attachment => {
                return missing(
                    format!(
                        "colour attachment use of the output format {:?}",
                        config.output_format
                    ),
                    "the composite is drawn into it; choose another format",
                );
            }
            Shading::Compute if !self.output_storage => {
                return missing(
                    format!("storage use of the output format {:?}", config.output_format),
                    "Shading::Compute stores to it; choose Shading::Raster, leave it to the \
                     library, or choose another format, such as R16G16B16A16_SFLOAT (no sRGB)",
                );
            }
            _ => {}
        }
        let raster = Some(Splat::Raster);
        if !self.blend_floats && (config.depth_splat == raster || config.thickness_splat == raster)
        {
            return missing(
                "blending of R32_SFLOAT and R32G32B32A32_SFLOAT".into(),
                "the raster splat paths need it; choose Splat::Compute or leave it to the library",
            );
        }
        match config.whitewater.and_then(|whitewater| whitewater.splat) {
            Some(WhitewaterSplat::Raster) if !self.blend_floats => {
                return missing(
                    "blending of R32G32B32A32_SFLOAT".into(),
                    "WhitewaterSplat::Raster needs it; choose Compute or leave it to the library",
                );
            }
            Some(WhitewaterSplat::Compute64) if !self.optional.buffer_int64_atomics => {
                return missing(
                    "shaderBufferInt64Atomics and shaderInt64".into(),
                    "WhitewaterSplat::Compute64 needs them; choose Compute or leave it to the library",
                );
            }
            _ => {}
        }
        if !self.blend_floats && config.light_map_size.is_some() {
            return missing(
                "blending of R32_SFLOAT and R32G32B32A32_SFLOAT".into(),
                "Config.light_map_size needs it; leave it off",
            );
        }
        if !self.blend_floats && !self.foam_floats && config.noise.is_some() {
            return missing("blending of R32_SFLOAT".into(), "Config.noise needs it; leave it off");
        }
        if !self.foam_floats && config.surface_foam {
            return missing(
                "blending of R32_SFLOAT, R32G32_SFLOAT and R32G32B32A32_SFLOAT, and storage use of the \
                 latter two"
                    .into(),
                "Config.surface_foam needs it; leave it off",
            );
        }
        if let Some(convolution) = crate::light::convolution(config) {
            if !self.basis[usize::from(convolution.bits == 16)] {
                return missing(
                    format!("storage use and linear filtering of {:?}", convolution.format()),
                    "Shadows::Convolution needs it; choose other bits, or Shadows::Map",
                );
            }
            let (vk::Extent2D { width, height }, most) =
                (convolution.extent(), self.limits.max_image_dimension2_d);
            if width.max(height) > most {
                let why = format!(
                    "an image of {width}x{height} is larger than the device's limit of {most}; choose fewer texels or \
                     terms"
                );
                return Err(Error::bad("Config.shadow", why));
            }
        }
        if !self.motion_floats && config.motion {
            return missing(
                "storage use of R32G32_SFLOAT".into(),
                "Config.motion needs it; leave it off",
            );
        }
        match config.smoothing {
            Some(Smoothing::Query(Gate::DrawCount)) if !self.optional.draw_indirect_count => {
                return missing(
                    "drawIndirectCount".into(),
                    "Gate::DrawCount needs it; choose another gate",
                );
            }
            Some(Smoothing::Query(Gate::Predicate)) if !self.optional.conditional_rendering => {
                return missing(
                    "VK_EXT_conditional_rendering".into(),
                    "Gate::Predicate needs it; choose another gate",
                );
            }
            _ => {}
        }
        let range = u64::from(self.limits.max_storage_buffer_range).saturating_sub(256);
        let least = crate::water::chunk_unit(config);
        if u64::from(least) * u64::from(config.max_stride) > range {
            return Err(Error::bad(
                "Config.max_stride",
                format!(
                    "{}: {least} particles exceed the device's limit for a buffer",
                    config.max_stride
                ),
            ));
        }
        let range = u64::from(self.limits.max_storage_buffer_range);
        for (field, bytes, instead) in bound_whole(config) {
            if bytes > range {
                let why = format!(
                    "{} takes {bytes} bytes, more than the device's limit of {range} for a buffer; choose {instead}",
                    named(config.extent)
                );
                return Err(Error::bad(field, why));
            }
        }
        let shapes = shape_bytes(config);
        if shapes > range {
            let why = format!(
                "the ellipsoids of {} particles take {shapes} bytes, more than the device's limit of {range} for a \
                 buffer; choose fewer particles or Kernels::Spheres",
                config.max_particles
            );
            return Err(Error::bad("Config.max_particles", why));
        }
        let most = self.largest();
        let over = |extent: vk::Extent2D| extent.width > most.width || extent.height > most.height;
        if over(config.extent) {
            let why = format!(
                "{} is larger than the device's limit for images ({})",
                named(config.extent),
                named(most)
            );
            return Err(Error::bad("Config.extent", why));
        }
        let levels = smoothing_extent(config, &self.limits);
        if over(levels) {
            let why = format!(
                "{} needs an image of {} for its smoothing levels, larger than the device's limit ({}); choose a \
                 smaller extent, a higher Config.smoothing_level, or a coarsening of 0 and one sheet",
                named(config.extent),
                named(levels),
                named(most)
            );
            return Err(Error::bad("Config.extent", why));
        }
        Ok(())
    }

    /// The largest image that can be rendered to.
    fn largest(&self) -> vk::Extent2D {
        let limits = &self.limits;
        let (image, view) = (limits.max_image_dimension2_d, limits.max_viewport_dimensions);
        vk::Extent2D {
            width: image.min(limits.max_framebuffer_width).min(view[0]),
            height: image.min(limits.max_framebuffer_height).min(view[1]),
        }
    }
}

fn named(extent: vk::Extent2D) -> String {
    format!("{}x{}", extent.width, extent.height)
}

/// The buffers whose size grows with the picture's extent and that are bound as a whole, to be compared with the
/// device's limit for a binding. For each: the field of the configuration that it belongs to, its size in bytes, and
/// the remedy for the error message. Lists of tiles are omitted: with one word per tile they stay below the limit in
/// images of any size.
fn bound_whole(config: &crate::contract::Config) -> Vec<(&'static str, u64, &'static str)> {
    let fewer = "a smaller extent, or a higher Config.thickness_level";
    let sums = (config.thickness_splat.unwrap_or(DEFAULT_SPLAT) == Splat::Compute)
        .then(|| ("Config.extent", thickness_bytes(config), fewer));
    let words =
        sums.filter(|_| config.surface_foam).map(|_| ("Config.extent", foam_bytes(config), fewer));
    let whitewater = config
        .whitewater
        .map(|_| ("Config.whitewater", word_bytes(config.extent), "a smaller extent"));
    let water = [("Config.extent", water_bytes(config), fewer)];
    let shore =
        config.shore.map(|_| ("Config.shore", shore_bytes(config.extent), "a smaller extent"));
    let bubbles = config.bubbles.iter().flat_map(|bubbles| {
        let (layers, lists) = bubble_bytes(config.extent, bubbles);
        [
            ("Config.bubbles.layers", layers, "fewer layers, or a smaller extent"),
            ("Config.bubbles.max_blobs", lists, "fewer blobs, or a smaller extent"),
        ]
    });
    sums.into_iter()
        .chain(words)
        .chain(whitewater)
        .chain(water)
        .chain(shore)
        .chain(bubbles)
        .collect()
}
