//! What every pass stands on: the host's device with what it enabled, barriers, images, buffers,
//! render passes, pipelines, descriptor sets, queries, labels and the retire list. No state of a frame.

pub mod access;
pub mod buffer;
pub mod descriptors;
pub mod graveyard;
pub mod image;
pub mod limits;
mod loaded;
pub mod pass;
pub mod pipeline;
pub mod requirements;
pub mod retire;
pub mod scan;
pub mod shader;
pub mod target;
pub mod timing;

use std::ffi::CString;
use std::sync::{Arc, Mutex, MutexGuard};

use ash::vk;
use gpu_allocator::vulkan::Allocator;

use crate::contract::{Enabled, Host};
use crate::error::{Error, VkContext};
use graveyard::{Grave, Graveyard, Owned};

/// The host's device and what is known of it. Shared by everything a renderer owns.
pub struct Gpu {
    /// Device functions.
    pub device: ash::Device,
    /// What the host enabled.
    pub enabled: Enabled,
    /// Slots, as `Host.frames_in_flight`.
    pub slots: u32,
    /// Limits of the physical device.
    pub limits: vk::PhysicalDeviceLimits,
    /// Bytes of a buffer at most.
    pub max_buffer_size: u64,
    /// What kind of device it is: the defaults of the paths depend on it.
    pub kind: vk::PhysicalDeviceType,
    /// Timestamps that the queue family writes; 0 for none.
    pub timestamp_bits: u32,
    /// R32G32_SFLOAT can be a blended colour attachment: most devices can, none has to.
    pub blends_pairs: bool,
    /// Conditional rendering, when enabled.
    pub conditional: Option<ash::ext::conditional_rendering::Device>,
    /// Samplers shared by all passes.
    pub samplers: Samplers,
    pipeline_cache: vk::PipelineCache,
    debug: Option<ash::ext::debug_utils::Device>,
    allocator: Arc<Mutex<Allocator>>,
    graveyard: Graveyard,
    own_samplers: Vec<Owned<vk::Sampler>>,
}

/// The samplers there are; they clamp to the edge unless said.
#[derive(Default)]
pub struct Samplers {
    /// Nearest texel, first mip.
    pub nearest: vk::Sampler,
    /// Linear in the texels and between the mips.
    pub linear: vk::Sampler,
    /// The same, closed on itself from left to right: for maps of all directions.
    pub around: vk::Sampler,
}

impl Gpu {
    /// Takes over what the host hands in.
    pub fn new(host: &Host<'_>) -> Result<Arc<Self>, Error> {
        loaded::check(host)?;
        // SAFETY: the host guarantees that its handles are alive and belong together.
        let (properties, families, pairs) = unsafe {
            let (instance, physical) = (host.instance, host.physical_device);
            let pairs = vk::Format::R32G32_SFLOAT;
            (
                instance.get_physical_device_properties(physical),
                instance.get_physical_device_queue_family_properties(physical),
                instance.get_physical_device_format_properties(physical, pairs),
            )
        };
        let blended = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        let mut maintenance = vk::PhysicalDeviceMaintenance4Properties::default();
        let mut chain = vk::PhysicalDeviceProperties2::default().push_next(&mut maintenance);
        // SAFETY: as above; the chain is well formed.
        unsafe {
            host.instance.get_physical_device_properties2(host.physical_device, &mut chain);
        }
        let family = families.get(host.queue_family as usize).ok_or_else(|| {
            Error::bad(
                "Host.queue_family",
                format!("{} of only {} families", host.queue_family, families.len()),
            )
        })?;
        let needed = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        if !family.queue_flags.contains(needed) {
            return Err(Error::bad(
                "Host.queue_family",
                format!("needs graphics and compute, has {:?}", family.queue_flags),
            ));
        }
        if !(1..=8).contains(&host.frames_in_flight) {
            return Err(Error::bad(
                "Host.frames_in_flight",
                format!("expected 1 to 8, found {}", host.frames_in_flight),
            ));
        }
        let mut gpu = Self {
            device: host.device.clone(),
            enabled: host.enabled,
            slots: host.frames_in_flight,
            limits: properties.limits,
            max_buffer_size: maintenance.max_buffer_size,
            kind: properties.device_type,
            timestamp_bits: family.timestamp_valid_bits,
            blends_pairs: pairs.optimal_tiling_features.contains(blended),
            conditional: host
                .enabled
                .conditional_rendering
                .then(|| ash::ext::conditional_rendering::Device::new(host.instance, host.device)),
            samplers: Samplers::default(),
            pipeline_cache: host.pipeline_cache,
            debug: host
                .enabled
                .debug_utils
                .then(|| ash::ext::debug_utils::Device::new(host.instance, host.device)),
            allocator: host.allocator.clone(),
            graveyard: Graveyard::default(),
            own_samplers: Vec::new(),
        };
        match gpu.make_samplers() {
            Ok(()) => Ok(Arc::new(gpu)),
            Err(error) => {
                gpu.own_samplers.clear();
                gpu.bury();
                Err(error)
            }
        }
    }

    fn make_samplers(&mut self) -> Result<(), Error> {
        let clamp = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let mut make = |name, filter, mip, max_lod, across| -> Result<vk::Sampler, Error> {
            let info = vk::SamplerCreateInfo::default()
                .mag_filter(filter)
                .min_filter(filter)
                .mipmap_mode(mip)
                .max_lod(max_lod)
                .address_mode_u(across)
                .address_mode_v(clamp)
                .address_mode_w(clamp);
            let sampler = self.sampler(name, &info)?;
            let handle = sampler.handle;
            self.own_samplers.push(sampler);
            Ok(handle)
        };
        let (nearest, linear) = (vk::Filter::NEAREST, vk::Filter::LINEAR);
        let (mips, all) = (vk::SamplerMipmapMode::LINEAR, vk::LOD_CLAMP_NONE);
        self.samplers = Samplers {
            nearest: make("nearest", nearest, vk::SamplerMipmapMode::NEAREST, 0.0, clamp)?,
            linear: make("linear", linear, mips, all, clamp)?,
            around: make("around", linear, mips, all, vk::SamplerAddressMode::REPEAT)?,
        };
        Ok(())
    }

    /// A sampler.
    pub fn sampler(
        &self,
        name: &str,
        info: &vk::SamplerCreateInfo<'_>,
    ) -> Result<Owned<vk::Sampler>, Error> {
        // SAFETY: valid create info.
        let sampler = unsafe { self.device.create_sampler(info, None) }
            .context(|| format!("vkCreateSampler {name}"))?;
        self.name(sampler, name);
        Ok(self.own(sampler, Grave::Sampler))
    }

    /// The host's allocator. A poisoned lock is taken all the same: the allocator's own state is
    /// not ours to judge.
    pub fn lock_allocator(&self) -> MutexGuard<'_, Allocator> {
        self.allocator.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Names an object for debuggers and validation messages.
    pub fn name<T: vk::Handle>(&self, handle: T, name: &str) {
        let (Some(debug), Ok(name)) = (&self.debug, CString::new(name)) else { return };
        let info =
            vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle is alive. A name that could not be set is no error.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    /// Opens a label in the command buffer.
    pub fn begin_label(&self, cmd: vk::CommandBuffer, name: &'static std::ffi::CStr) {
        if let Some(debug) = &self.debug {
            let info = vk::DebugUtilsLabelEXT::default().label_name(name);
            // SAFETY: cmd is recording.
            unsafe { debug.cmd_begin_debug_utils_label(cmd, &info) };
        }
    }

    /// Closes the label opened last.
    pub fn end_label(&self, cmd: vk::CommandBuffer) {
        if let Some(debug) = &self.debug {
            // SAFETY: cmd is recording and a label is open.
            unsafe { debug.cmd_end_debug_utils_label(cmd) };
        }
    }

    /// Whether this is a software device, where atomics are cheap and shared memory is dear.
    pub fn is_cpu(&self) -> bool {
        self.kind == vk::PhysicalDeviceType::CPU
    }
}

impl Gpu {
    /// Frees the shared objects too: the last call. The GPU must be done with everything.
    pub fn destroy(self: Arc<Self>) {
        self.bury();
        // Only the samplers are left, and nobody else holds the device's state.
        if let Ok(mut gpu) = Arc::try_unwrap(self) {
            let samplers = std::mem::take(&mut gpu.own_samplers);
            drop(samplers);
            gpu.bury();
        }
    }
}
