//! State shared by the renderers, foam states, blob simulations, generators and shore maps of one device: the host's
//! Vulkan objects, and pipelines, render passes and samplers, each of which is created for the first object that
//! needs it and then serves all.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};

use crate::contract::{EnabledFeatures, Host};
use crate::error::{Error, VkContext};
use crate::gpu::access::Synchronization;
use crate::gpu::loaded;
use crate::gpu::memory::Allocate;
use crate::gpu::pass::Attachments;
use crate::gpu::pipeline::{self, Made};
use crate::gpu::requirements::DeviceSupport;

/// State shared by all objects of one device: [`Renderer`](crate::Renderer)s, a
/// [`SurfaceFoamState`](crate::SurfaceFoamState) and so on are created from a context. Each pipeline is created once,
/// serves all of them, and is kept for later use, for example when [`reconfigure`](crate::Renderer::reconfigure)
/// switches back and forth.
///
/// All clones are the same context. Its Vulkan objects are freed once the last clone is dropped and everything
/// created from the context is destroyed. Both have to happen before the host destroys its device.
#[derive(Clone)]
pub struct Context {
    pub(crate) shared: Arc<Shared>,
    pub(crate) slots: u32,
}

impl Context {
    /// Creates a context from the host's objects. The only Vulkan objects that it creates are three samplers.
    ///
    /// # Errors
    /// [`Error::BadInput`] for a queue family without graphics and compute, or a number of frames in flight
    /// outside 1 to 8; [`Error::Missing`] for a function that the instance or the device lacks;
    /// [`Error::Allocation`] if [`Host::allocator`] is `None` and no allocator can be created; Vulkan errors.
    ///
    /// # Safety
    /// The host's handles are alive, belong together, and outlive the context and everything created from it. The
    /// device has the version and the enabled features that [`requirements`](crate::requirements) demands, and every
    /// feature that is set in [`Host::enabled`] is enabled.
    pub unsafe fn new(host: &Host<'_>) -> Result<Self, Error> {
        check_slots(host.frames_in_flight)?;
        let shared = Arc::new(Shared::new(host)?);
        Ok(Self { shared, slots: host.frames_in_flight })
    }

    /// A clone of this context with another number of frames in flight, 1 to 8. It applies to objects that are
    /// created from the clone; those created from this context keep their number.
    ///
    /// # Errors
    /// [`Error::BadInput`] for a number outside 1 to 8.
    pub fn with_frames_in_flight(&self, frames_in_flight: u32) -> Result<Self, Error> {
        check_slots(frames_in_flight)?;
        Ok(Self { shared: self.shared.clone(), slots: frames_in_flight })
    }

    /// Number of frames in flight, for objects created from this context. Slots are the numbers from 0 to one less.
    pub fn frames_in_flight(&self) -> u32 {
        self.slots
    }
}

/// The allocator for a host without one.
fn own_allocator(host: &Host<'_>) -> Result<Arc<dyn Allocate>, Error> {
    let made = Allocator::new(&AllocatorCreateDesc {
        instance: host.instance.clone(),
        device: host.device.clone(),
        physical_device: host.physical_device,
        debug_settings: Default::default(),
        buffer_device_address: false,
        allocation_sizes: Default::default(),
    });
    match made {
        Ok(allocator) => Ok(Arc::new(Mutex::new(allocator))),
        Err(source) => {
            Err(Error::Allocation { name: "the context".into(), source: Box::new(source) })
        }
    }
}

fn check_slots(slots: u32) -> Result<(), Error> {
    if (1..=8).contains(&slots) {
        return Ok(());
    }
    Err(Error::bad("Host.frames_in_flight", format!("expected 1 to 8, found {slots}")))
}

/// The samplers; they clamp to the edge unless stated otherwise.
#[derive(Default)]
pub struct Samplers {
    /// Nearest texel, first mip.
    pub nearest: vk::Sampler,
    /// Trilinear.
    pub linear: vk::Sampler,
    /// Trilinear, repeating from left to right, for maps over all directions.
    pub around: vk::Sampler,
}

/// State shared by the clones of a context.
pub struct Shared {
    /// Device functions.
    pub device: ash::Device,
    /// Optional features that the host enabled.
    pub enabled: EnabledFeatures,
    /// Limits of the physical device.
    pub limits: vk::PhysicalDeviceLimits,
    /// Maximum size of a buffer, bytes.
    pub max_buffer_size: u64,
    /// Type of the device, on which the default paths depend.
    pub kind: vk::PhysicalDeviceType,
    /// Valid bits of the queue family's timestamps; 0 if it has none.
    pub timestamp_bits: u32,
    /// Whether R32G32_SFLOAT can be a blended colour attachment. Most devices support it; Vulkan does not require it.
    pub blends_pairs: bool,
    /// How barriers and timestamps are recorded.
    pub synchronization: Synchronization,
    /// Sets the comparison of the depth test, which the stand-in scene needs.
    #[cfg(feature = "headless")]
    pub depth_compare: Option<vk::PFN_vkCmdSetDepthCompareOp>,
    /// Conditional rendering, if enabled.
    pub conditional: Option<ash::ext::conditional_rendering::Device>,
    /// Names and labels, if enabled.
    pub debug: Option<ash::ext::debug_utils::Device>,
    /// Samplers of all passes.
    pub samplers: Samplers,
    /// The host's pipeline cache, or null.
    pub pipeline_cache: vk::PipelineCache,
    /// Pipelines created so far.
    pub pipelines: Store<pipeline::Key, Arc<Made>>,
    /// Render passes created so far, by name and attachments.
    pub passes: Store<(String, Attachments), vk::RenderPass>,
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    allocator: Arc<dyn Allocate>,
}

impl Shared {
    fn new(host: &Host<'_>) -> Result<Self, Error> {
        let synchronization = loaded::check(host)?;
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
        // The fourth is part of Vulkan 1.3; older devices report the max size of an allocation, which also limits a
        // buffer.
        let newer = loaded::is_1_3(host.device);
        let mut third = vk::PhysicalDeviceMaintenance3Properties::default();
        let mut fourth = vk::PhysicalDeviceMaintenance4Properties::default();
        let mut chain = vk::PhysicalDeviceProperties2::default().push_next(&mut third);
        if newer {
            chain = chain.push_next(&mut fourth);
        }
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
        let allocator = match &host.allocator {
            Some(allocator) => allocator.clone(),
            None => own_allocator(host)?,
        };
        let mut shared = Self {
            device: host.device.clone(),
            enabled: host.enabled,
            limits: properties.limits,
            max_buffer_size: match newer {
                true => fourth.max_buffer_size,
                false => third.max_memory_allocation_size,
            },
            kind: properties.device_type,
            timestamp_bits: family.timestamp_valid_bits,
            blends_pairs: pairs.optimal_tiling_features.contains(blended),
            synchronization,
            #[cfg(feature = "headless")]
            depth_compare: loaded::depth_compare(host),
            conditional: host
                .enabled
                .conditional_rendering
                .then(|| ash::ext::conditional_rendering::Device::new(host.instance, host.device)),
            debug: host
                .enabled
                .debug_utils
                .then(|| ash::ext::debug_utils::Device::new(host.instance, host.device)),
            samplers: Samplers::default(),
            pipeline_cache: host.pipeline_cache,
            pipelines: Store::default(),
            passes: Store::default(),
            instance: host.instance.clone(),
            physical_device: host.physical_device,
            allocator,
        };
        // Objects that were created before a failure are freed with `shared`.
        shared.make_samplers()?;
        Ok(shared)
    }

    fn make_samplers(&mut self) -> Result<(), Error> {
        let clamp = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let (nearest, linear) = (vk::Filter::NEAREST, vk::Filter::LINEAR);
        let make = |shared: &Self, name: &str, filter, mip, max_lod, across| {
            let info = vk::SamplerCreateInfo::default()
                .mag_filter(filter)
                .min_filter(filter)
                .mipmap_mode(mip)
                .max_lod(max_lod)
                .address_mode_u(across)
                .address_mode_v(clamp)
                .address_mode_w(clamp);
            // SAFETY: valid create info.
            let sampler = unsafe { shared.device.create_sampler(&info, None) }
                .context(|| format!("vkCreateSampler {name}"))?;
            shared.name(sampler, name);
            Ok::<_, Error>(sampler)
        };
        let (mips, all) = (vk::SamplerMipmapMode::LINEAR, vk::LOD_CLAMP_NONE);
        let repeat = vk::SamplerAddressMode::REPEAT;
        self.samplers.nearest =
            make(self, "nearest", nearest, vk::SamplerMipmapMode::NEAREST, 0.0, clamp)?;
        self.samplers.linear = make(self, "linear", linear, mips, all, clamp)?;
        self.samplers.around = make(self, "around", linear, mips, all, repeat)?;
        Ok(())
    }

    /// Support of the device for an output format, with the host's enabled features.
    pub fn offer(&self, output: vk::Format) -> DeviceSupport {
        let offer = DeviceSupport::of(&self.instance, self.physical_device, output);
        match loaded::is_1_3(&self.device) {
            true => offer,
            false => offer.before_1_3(&self.enabled),
        }
    }

    /// Source of memory.
    pub fn allocator(&self) -> &dyn Allocate {
        &*self.allocator
    }

    /// Names an object for debuggers and validation messages.
    pub fn name<T: vk::Handle>(&self, handle: T, name: &str) {
        let (Some(debug), Ok(name)) = (&self.debug, std::ffi::CString::new(name)) else { return };
        let info =
            vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle is alive. A name that could not be set is no error.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: all users of these objects are destroyed, so the GPU has finished with them (an object that is only
        // dropped keeps its context alive); the device is alive, as `Context::new` requires. Null handles are
        // allowed.
        unsafe {
            for made in self.pipelines.take() {
                self.device.destroy_pipeline(made.handle, None);
                self.device.destroy_pipeline_layout(made.layout, None);
                self.device.destroy_descriptor_set_layout(made.set_layout, None);
            }
            for pass in self.passes.take() {
                self.device.destroy_render_pass(pass, None);
            }
            for sampler in [self.samplers.nearest, self.samplers.linear, self.samplers.around] {
                self.device.destroy_sampler(sampler, None);
            }
        }
    }
}

/// A cache of objects by key.
pub struct Store<K, V>(Mutex<HashMap<K, V>>);

impl<K, V> Default for Store<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Eq + Hash, V: Clone> Store<K, V> {
    /// Returns the value of a key; if there is none yet, `make` creates it. The lock is held meanwhile, so that no
    /// key gets two values.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn get(&self, key: K, make: impl FnOnce() -> Result<V, Error>) -> Result<V, Error> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(value) = all.get(&key) {
            return Ok(value.clone());
        }
        let value = make()?;
        all.insert(key, value.clone());
        Ok(value)
    }

    fn take(&self) -> Vec<V> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.drain().map(|(_, value)| value).collect()
    }
}
