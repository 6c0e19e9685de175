//! An instance and a device for tools and tests, with optional validation.

use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex};

use ash::{khr, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};

use crate::contract::{EnabledFeatures, Host};
use crate::error::{Error, VkContext};
use crate::gpu::requirements::DeviceSupport;

/// Options for creating a [`Device`].
#[derive(Clone, Debug, Default)]
pub struct DeviceOptions {
    /// Part of the name of the device to use; case is ignored. `None`: any device. Of several that fit, a discrete GPU
    /// is preferred, then an integrated one, then a virtual one, then any other device.
    pub name: Option<String>,
    /// Whether core and synchronization validation are on. [`Device::new`] fails if they are and the validation
    /// layer is not installed. Default false.
    pub validation: bool,
    /// Whether to leave disabled the optional features for which the renderer has another code path, so that it works
    /// as on a device that lacks them. Default false.
    pub bare: bool,
    /// Whether to create instance and device for Vulkan 1.2 and without synchronization2, as with old drivers. Default
    /// false.
    pub vulkan_1_2: bool,
}

/// A device with one queue.
pub struct Device {
    /// Instance functions; keeps the loader alive.
    pub instance: ash::Instance,
    /// The physical device.
    pub physical: vk::PhysicalDevice,
    /// Device functions.
    pub device: ash::Device,
    /// Index of a queue family with graphics and compute.
    pub queue_family: u32,
    /// The first queue of that family.
    pub queue: vk::Queue,
    /// The allocator that the renderer shares.
    pub allocator: Arc<Mutex<Allocator>>,
    /// Optional features that are enabled.
    pub enabled: EnabledFeatures,
    /// Name of the adapter.
    pub adapter: String,
    /// Name and version of its driver.
    pub driver: String,
    messages: Option<Messages>,
    _entry: ash::Entry,
}

struct Messages {
    debug: ash::ext::debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    // A box with a stable address: the callback's user data.
    list: Box<Mutex<Vec<String>>>,
}

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

impl Device {
    /// Creates the instance and the device.
    ///
    /// # Errors
    /// There is no Vulkan loader, no driver or, if validation is asked for, no validation layer: the error says what to
    /// install. No device fits: the error names those that were found. No memory; Vulkan errors.
    pub fn new(options: &DeviceOptions) -> Result<Self, Error> {
        // SAFETY: loading the system's Vulkan loader runs its initialisers only.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| Error::Missing {
            what: format!("the Vulkan loader ({error})"),
            why: "install the package libvulkan1, and a driver such as mesa-vulkan-drivers".into(),
        })?;
        let list = Box::new(Mutex::new(Vec::new()));
        let (instance, debug_utils) = make_instance(&entry, options, &list)?;
        let messages = if options.validation {
            let debug = ash::ext::debug_utils::Instance::new(&entry, &instance);
            let info = messenger_info(&list);
            // SAFETY: the user data outlives the messenger (destroyed in drop, before the box).
            let messenger = unsafe { debug.create_debug_utils_messenger(&info, None) }
                .context(|| "vkCreateDebugUtilsMessengerEXT".into())?;
            Some(Messages { debug, messenger, list })
        } else {
            None
        };
        let (physical, queue_family) = choose(&instance, options)?;
        let mut properties12 = vk::PhysicalDeviceVulkan12Properties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut properties12);
        // SAFETY: well-formed chain, live handles.
        unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
        let text = |c: &[std::ffi::c_char]| {
            // SAFETY: Vulkan's fixed strings are nul-terminated.
            unsafe { CStr::from_ptr(c.as_ptr()) }.to_string_lossy().into_owned()
        };
        let adapter = text(&properties.properties.device_name);
        let driver =
            format!("{} {}", text(&properties12.driver_name), text(&properties12.driver_info));
        let (device, mut enabled) = make_device(&instance, physical, queue_family, options)?;
        enabled.debug_utils = debug_utils;
        // SAFETY: the queue was asked for.
        let queue = unsafe { device.get_device_queue(queue_family, 0) };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device: physical,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: Default::default(),
        })
        .map_err(|source| Error::Allocation {
            name: "allocator".into(),
            source: Box::new(source),
        })?;
        Ok(Self {
            instance,
            physical,
            device,
            queue_family,
            queue,
            allocator: Arc::new(Mutex::new(allocator)),
            enabled,
            adapter,
            driver,
            messages,
            _entry: entry,
        })
    }

    /// The [`Host`] for [`Context::new`](crate::Context::new).
    pub fn host(&self, frames_in_flight: u32) -> Host<'_> {
        let (instance, device) = (&self.instance, &self.device);
        Host::new(instance, self.physical, device, self.queue_family, frames_in_flight)
            .with_allocator(self.allocator.clone())
            .with_enabled(self.enabled)
    }

    /// Validation messages since the last call.
    pub fn take_messages(&self) -> Vec<String> {
        match &self.messages {
            Some(messages) => std::mem::take(
                &mut *messages.list.lock().unwrap_or_else(std::sync::PoisonError::into_inner),
            ),
            None => Vec::new(),
        }
    }

    /// Waits until the device is idle.
    ///
    /// # Errors
    /// Device loss.
    pub fn wait_idle(&self) -> Result<(), Error> {
        // SAFETY: live device; the queue is used by one thread.
        unsafe { self.device.device_wait_idle() }.context(|| "vkDeviceWaitIdle".into())
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // A renderer that was dropped without `destroy` still holds the allocator; the objects are then freed at the
        // end of the process.
        let Some(allocator) = Arc::get_mut(&mut self.allocator) else { return };
        let empty = Allocator::new(&AllocatorCreateDesc {
            instance: self.instance.clone(),
            device: self.device.clone(),
            physical_device: self.physical,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: Default::default(),
        });
        // The allocator's memory has to be freed before its device, so an empty allocator replaces it.
        let Ok(empty) = empty else { return };
        *allocator.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner) = empty;
        // SAFETY: all objects of the device are destroyed, except those that the user leaked.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.device.destroy_device(None);
            let messages = self.messages.take();
            if let Some(messages) = &messages {
                messages.debug.destroy_debug_utils_messenger(messages.messenger, None);
            }
            self.instance.destroy_instance(None);
            // The instance may report messages until its end.
            drop(messages);
        }
    }
}

fn messenger_info(list: &Mutex<Vec<String>>) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(
            vk::DebugUtilsMessageSeverityFlagsEXT::ERROR
                | vk::DebugUtilsMessageSeverityFlagsEXT::WARNING,
        )
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
        .pfn_user_callback(Some(on_message))
        .user_data(std::ptr::from_ref(list).cast_mut().cast())
}

unsafe extern "system" fn on_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan hands in valid data; the user data is the list of `Messages`.
    unsafe {
        let text = CStr::from_ptr((*data).p_message).to_string_lossy().into_owned();
        let list = &*user.cast::<Mutex<Vec<String>>>();
        list.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(text);
    }
    vk::FALSE
}

fn make_instance(
    entry: &ash::Entry,
    options: &DeviceOptions,
    list: &Mutex<Vec<String>>,
) -> Result<(ash::Instance, bool), Error> {
    // SAFETY: plain enumeration.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }
        .context(|| "vkEnumerateInstanceLayerProperties".into())?;
    let has_layer = layers.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION));
    if options.validation && !has_layer {
        return Err(Error::Missing {
            what: "VK_LAYER_KHRONOS_validation".into(),
            why: "install the package vulkan-validationlayers, or run without validation".into(),
        });
    }
    // SAFETY: as above.
    let extensions = unsafe { entry.enumerate_instance_extension_properties(None) }
        .context(|| "vkEnumerateInstanceExtensionProperties".into())?;
    let debug_utils = options.validation
        || extensions
            .iter()
            .any(|e| e.extension_name_as_c_str() == Ok(ash::ext::debug_utils::NAME));
    let mut names = Vec::new();
    if debug_utils {
        names.push(ash::ext::debug_utils::NAME.as_ptr());
    }
    let layers = [VALIDATION.as_ptr()];
    let application = vk::ApplicationInfo::default()
        .application_name(c"whitewater")
        .api_version(if options.vulkan_1_2 { vk::API_VERSION_1_2 } else { vk::API_VERSION_1_3 });
    let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enables);
    let mut messenger = messenger_info(list);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_extension_names(&names);
    if options.validation {
        info = info.enabled_layer_names(&layers).push_next(&mut features).push_next(&mut messenger);
    }
    // SAFETY: valid create info with live pointers.
    let instance =
        unsafe { entry.create_instance(&info, None) }.context(|| "vkCreateInstance".into())?;
    Ok((instance, debug_utils))
}

/// A Vulkan 1.2 device with a queue family for graphics and compute, whose name contains `options.name` if that
/// is given. Discrete GPUs are preferred, then integrated ones, then virtual ones, then other devices.
fn choose(
    instance: &ash::Instance,
    options: &DeviceOptions,
) -> Result<(vk::PhysicalDevice, u32), Error> {
    // SAFETY: live instance.
    let devices = unsafe { instance.enumerate_physical_devices() }
        .context(|| "vkEnumeratePhysicalDevices".into())?;
    let mut found = Vec::new();
    let mut names = Vec::new();
    for physical in devices {
        // SAFETY: live handles.
        let (properties, families) = unsafe {
            (
                instance.get_physical_device_properties(physical),
                instance.get_physical_device_queue_family_properties(physical),
            )
        };
        let name =
            properties.device_name_as_c_str().unwrap_or_default().to_string_lossy().into_owned();
        let wanted = options
            .name
            .as_ref()
            .is_none_or(|want| name.to_lowercase().contains(&want.to_lowercase()));
        names.push(name);
        let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let family = families.iter().position(|f| f.queue_flags.contains(both));
        let rank = match properties.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => 0,
            vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
            vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
            _ => 3,
        };
        if let (true, Some(family), true) =
            (wanted, family, properties.api_version >= vk::API_VERSION_1_2)
        {
            found.push((rank, physical, family as u32));
        }
    }
    found.sort_by_key(|(rank, ..)| *rank);
    found.first().map(|&(_, physical, family)| (physical, family)).ok_or_else(|| Error::Missing {
        what: match &options.name {
            Some(name) => format!("a Vulkan 1.2 device named like '{name}'"),
            None => "a Vulkan 1.2 device".into(),
        },
        why: if names.is_empty() {
            "no Vulkan driver was found; mesa-vulkan-drivers has one that runs on the CPU".into()
        } else {
            format!("there is: {}", names.join(", "))
        },
    })
}

fn make_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    queue_family: u32,
    options: &DeviceOptions,
) -> Result<(ash::Device, EnabledFeatures), Error> {
    let offer = DeviceSupport::of(instance, physical, super::COLOR_FORMAT);
    // SAFETY: live handles.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }
        .context(|| "vkEnumerateDeviceExtensionProperties".into())?;
    let has = |name: &CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
    let mut enabled = offer.optional;
    if options.bare {
        // Features that do not select a path of their own stay enabled.
        enabled = EnabledFeatures {
            synchronization2: enabled.synchronization2,
            storage_image_write_without_format: (options.vulkan_1_2
                || offer.api_version < vk::API_VERSION_1_3)
                && enabled.storage_image_write_without_format,
            ..EnabledFeatures::default()
        };
    }
    let synchronization2 =
        offer.api_version >= vk::API_VERSION_1_3 || has(khr::synchronization2::NAME);
    enabled.synchronization2 &= synchronization2 && !options.vulkan_1_2;
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(queue_family)
        .queue_priorities(&priorities)];
    let mut names: Vec<_> =
        enabled.device_extensions(offer.api_version).into_iter().map(CStr::as_ptr).collect();
    if has(khr::portability_subset::NAME) {
        names.push(khr::portability_subset::NAME.as_ptr());
    }
    let mut features = enabled.device_features();
    // For the stand-in scene; part of Vulkan 1.3.
    let mut dynamic =
        vk::PhysicalDeviceExtendedDynamicStateFeaturesEXT::default().extended_dynamic_state(true);
    let dynamic_state = ash::ext::extended_dynamic_state::NAME;
    let older = options.vulkan_1_2 || offer.api_version < vk::API_VERSION_1_3;
    let extended = older && has(dynamic_state);
    if extended {
        names.push(dynamic_state.as_ptr());
    }
    let info =
        vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&names);
    let mut info = features.chain(info);
    if extended {
        info = info.push_next(&mut dynamic);
    }
    // SAFETY: valid create info with live pointers.
    let device = unsafe { instance.create_device(physical, &info, None) }
        .context(|| "vkCreateDevice".into())?;
    Ok((device, enabled))
}
