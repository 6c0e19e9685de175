//! What an engine has before it adds whitewater: instance, device, queue, allocator, images and buffers, and a scene of
//! just two clears.

use std::error::Error;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use whitewater::ash::{Device, Entry, Instance, ext::debug_utils, vk};
use whitewater::gpu_allocator::{AllocationSizes, MemoryLocation, vulkan as memory};
use whitewater::{Access, Config, DeviceSupport, EnabledFeatures, HostImage};

/// Access with which this host writes its images.
pub const CLEAR: Access = Access::new(
    vk::PipelineStageFlags2::ALL_TRANSFER,
    vk::AccessFlags2::TRANSFER_WRITE,
    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
);
/// Access with which this host reads its images.
pub const COPY: Access = Access::new(
    vk::PipelineStageFlags2::ALL_TRANSFER,
    vk::AccessFlags2::TRANSFER_READ,
    vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
);

static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Messages of validation since the last call.
pub fn take_messages() -> Vec<String> {
    std::mem::take(&mut *MESSAGES.lock().unwrap_or_else(PoisonError::into_inner))
}

/// The device and all that depends on it. Dropping leaks it; [`Gpu::destroy`] frees it.
pub struct Gpu {
    pub instance: Instance,
    pub physical_device: vk::PhysicalDevice,
    pub device: Device,
    pub queue_family: u32,
    pub queue: vk::Queue,
    pub enabled: EnabledFeatures,
    pub allocator: Arc<Mutex<memory::Allocator>>,
    messenger: Option<(debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    _entry: Entry, // holds the loader
}

impl Gpu {
    /// Makes a device that can run whitewater with this configuration.
    pub fn new(validate: bool, config: &Config) -> Result<Self, Box<dyn Error>> {
        let application = vk::ApplicationInfo::default()
            .application_name(c"whitewater-embed")
            .api_version(vk::API_VERSION_1_3);
        let layers = [c"VK_LAYER_KHRONOS_validation".as_ptr()];
        let extensions = [debug_utils::NAME.as_ptr()];
        let synchronization = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut checks =
            vk::ValidationFeaturesEXT::default().enabled_validation_features(&synchronization);
        let mut info = vk::InstanceCreateInfo::default().application_info(&application);
        if validate {
            info = info.enabled_layer_names(&layers).enabled_extension_names(&extensions);
            info = info.push_next(&mut checks);
        }
        // SAFETY: nothing else loads or unloads Vulkan; valid create infos.
        let (entry, instance) = unsafe {
            let entry = Entry::load()?;
            let instance = entry.create_instance(&info, None)?;
            (entry, instance)
        };
        let messenger = if validate {
            let debug = debug_utils::Instance::new(&entry, &instance);
            let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                .message_severity(
                    vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                        | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
                )
                .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
                .pfn_user_callback(Some(on_message));
            // SAFETY: valid create info; the callback uses no data of ours.
            let messenger = unsafe { debug.create_debug_utils_messenger(&info, None)? };
            Some((debug, messenger))
        } else {
            None
        };
        let (physical_device, queue_family) = choose(&instance, config)?;
        // Enable every feature that whitewater can use, and report them with `Host::with_enabled`. Whitewater needs
        // none of them; this host itself needs synchronization2.
        let offer = DeviceSupport::of(&instance, physical_device, config.output_format);
        let enabled = offer.optional.with(|it| it.debug_utils = validate);
        let mut features = enabled.device_features();
        let names = enabled.device_extensions(offer.api_version);
        let names: Vec<_> = names.into_iter().map(CStr::as_ptr).collect();
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(queue_family)
            .queue_priorities(&[1.0])];
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&names);
        let info = features.chain(info);
        // SAFETY: the device offers these features; the queue is one of those created.
        let (device, queue) = unsafe {
            let device = instance.create_device(physical_device, &info, None)?;
            let queue = device.get_device_queue(queue_family, 0);
            (device, queue)
        };
        let allocator = memory::Allocator::new(&memory::AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: AllocationSizes::default(),
        })?;
        let allocator = Arc::new(Mutex::new(allocator));
        Ok(Self {
            instance,
            physical_device,
            device,
            queue_family,
            queue,
            enabled,
            allocator,
            messenger,
            _entry: entry,
        })
    }

    /// An image that is cleared at the start of a frame and is in access `after` at its end.
    pub fn image(
        &self,
        format: vk::Format,
        extent: vk::Extent2D,
        aspect: vk::ImageAspectFlags,
        usage: vk::ImageUsageFlags,
        after: Access,
    ) -> Result<(HostImage, memory::Allocation), Box<dyn Error>> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(extent.into())
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage | vk::ImageUsageFlags::TRANSFER_DST);
        // SAFETY: valid create info; the memory fits and is bound once.
        let (image, memory) = unsafe {
            let image = self.device.create_image(&info, None)?;
            let requirements = self.device.get_image_memory_requirements(image);
            let memory = self.allocate(requirements, MemoryLocation::GpuOnly, false)?;
            self.device.bind_image_memory(image, memory.memory(), memory.offset())?;
            (image, memory)
        };
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(range(aspect));
        // SAFETY: the image is bound.
        let view = unsafe { self.device.create_image_view(&info, None)? };
        Ok((HostImage::new(image, view, format, extent, CLEAR).with_after(after), memory))
    }

    pub fn buffer(
        &self,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<(vk::Buffer, memory::Allocation), Box<dyn Error>> {
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: valid create info; the memory fits and is bound once.
        unsafe {
            let buffer = self.device.create_buffer(&info, None)?;
            let requirements = self.device.get_buffer_memory_requirements(buffer);
            let memory = self.allocate(requirements, location, true)?;
            self.device.bind_buffer_memory(buffer, memory.memory(), memory.offset())?;
            Ok((buffer, memory))
        }
    }

    fn allocate(
        &self,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<memory::Allocation, Box<dyn Error>> {
        let mut allocator = self.allocator.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(allocator.allocate(&memory::AllocationCreateDesc {
            name: "embed",
            requirements,
            location,
            linear,
            allocation_scheme: memory::AllocationScheme::GpuAllocatorManaged,
        })?)
    }

    /// Draws the scene: one colour at infinite depth.
    ///
    /// # Safety
    /// `cmd` is recording outside a render pass; the images live until it has been executed.
    pub unsafe fn clear(&self, cmd: vk::CommandBuffer, color: &HostImage, depth: &HostImage) {
        let backdrop = vk::ClearColorValue { float32: [0.06, 0.08, 0.1, 1.0] };
        let far = vk::ClearDepthStencilValue { depth: 0.0, stencil: 0 }; // reversed depth
        let (layout, color_range, depth_range) =
            (CLEAR.layout, range(color.aspect), range(depth.aspect));
        // SAFETY: the caller guarantees it; the barriers bring the images into the layout for clears.
        unsafe {
            for image in [color, depth] {
                // Waits for the previous frame, whose contents are discarded.
                self.barrier(cmd, image, image.after.discarded(), CLEAR);
            }
            self.device.cmd_clear_color_image(cmd, color.image, layout, &backdrop, &[color_range]);
            self.device.cmd_clear_depth_stencil_image(
                cmd,
                depth.image,
                layout,
                &far,
                &[depth_range],
            );
        }
    }

    /// Copies an image, in the access that the water leaves it in, to a buffer that the CPU reads after the fence.
    ///
    /// # Safety
    /// As [`Gpu::clear`]; the image is in COPY's layout and the buffer is large enough.
    pub unsafe fn copy(&self, cmd: vk::CommandBuffer, image: &HostImage, buffer: vk::Buffer) {
        let region = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: image.aspect,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(image.extent.into());
        let to_host = [vk::MemoryBarrier2::default()
            .src_stage_mask(CLEAR.stage)
            .src_access_mask(CLEAR.access)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ)];
        let to_host = vk::DependencyInfo::default().memory_barriers(&to_host);
        // SAFETY: the caller guarantees it.
        unsafe {
            let device = &self.device;
            device.cmd_copy_image_to_buffer(cmd, image.image, COPY.layout, buffer, &[region]);
            device.cmd_pipeline_barrier2(cmd, &to_host);
        }
    }

    /// # Safety
    /// As [`Gpu::clear`].
    unsafe fn barrier(&self, cmd: vk::CommandBuffer, image: &HostImage, from: Access, to: Access) {
        let barrier = [vk::ImageMemoryBarrier2::default()
            .image(image.image)
            .subresource_range(range(image.aspect))
            .src_stage_mask(from.stage)
            .src_access_mask(from.access)
            .old_layout(from.layout)
            .dst_stage_mask(to.stage)
            .dst_access_mask(to.access)
            .new_layout(to.layout)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: the caller guarantees it.
        unsafe { self.device.cmd_pipeline_barrier2(cmd, &info) };
    }

    /// Frees memory, device and instance.
    ///
    /// # Safety
    /// The GPU is idle; everything made from the device has been destroyed.
    pub unsafe fn destroy(
        self,
        memory: impl IntoIterator<Item = memory::Allocation>,
    ) -> Result<(), Box<dyn Error>> {
        let allocator = Arc::into_inner(self.allocator).ok_or("the allocator is still shared")?;
        let mut allocator = allocator.into_inner().unwrap_or_else(PoisonError::into_inner);
        for memory in memory {
            allocator.free(memory)?;
        }
        drop(allocator); // before its device
        // SAFETY: the caller guarantees it.
        unsafe {
            self.device.destroy_device(None);
            if let Some((debug, messenger)) = self.messenger {
                debug.destroy_debug_utils_messenger(messenger, None);
            }
            self.instance.destroy_instance(None);
        }
        Ok(())
    }
}

/// The first device that meets the configuration, and its first queue family with both graphics and compute; or the
/// reason why the last device was refused.
fn choose(
    instance: &Instance,
    config: &Config,
) -> Result<(vk::PhysicalDevice, u32), Box<dyn Error>> {
    let mut refused: Box<dyn Error> = "no Vulkan device".into();
    let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    // SAFETY: a live instance.
    let devices = unsafe { instance.enumerate_physical_devices()? };
    for physical in devices {
        // SAFETY: a live instance, and a device of it.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        let family = families.iter().position(|family| family.queue_flags.contains(both));
        let offer = DeviceSupport::of(instance, physical, config.output_format);
        let own = offer.api_version >= vk::API_VERSION_1_3 && offer.optional.synchronization2;
        match (offer.check(config), family) {
            (Ok(()), Some(_)) if !own => refused = "no synchronization2".into(),
            (Ok(()), Some(family)) => return Ok((physical, family as u32)),
            (Err(error), _) => refused = error.into(),
            (_, None) => refused = "no queue family with graphics and compute".into(),
        }
    }
    Err(refused)
}

fn range(aspect_mask: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange { aspect_mask, level_count: 1, layer_count: 1, ..Default::default() }
}

unsafe extern "system" fn on_message(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    _: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes a message that lives during the call.
    let text = unsafe { CStr::from_ptr((*data).p_message) };
    let mut messages = MESSAGES.lock().unwrap_or_else(PoisonError::into_inner);
    messages.push(text.to_string_lossy().into_owned());
    vk::FALSE
}
