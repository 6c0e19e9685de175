//! Checks that the host's function tables contain every function that the library calls. For functions that the
//! loader does not know, such as all of Vulkan 1.3 on a 1.2 instance, ash puts stand-ins into the tables, which
//! panic.

use std::ffi::{CStr, c_void};
use std::ptr::null;

use ash::vk;

use crate::contract::Host;
use crate::error::Error;
use crate::gpu::access::Synchronization;

/// Returns an error that names the first missing function, or else the functions with which barriers and timestamps
/// are recorded. Functions of Vulkan 1.0 are not checked, because a device without all of them is invalid.
pub fn check(host: &Host<'_>) -> Result<Synchronization, Error> {
    let (device, enabled) = (host.device, host.enabled);
    if !of_instance(host.instance) {
        return missing("vkGetPhysicalDeviceProperties2");
    }
    // The stand-in that ash uses for each missing function.
    let (no_1_2, no_1_3) =
        (ash::DeviceFnV1_2::load(|_| null()), ash::DeviceFnV1_3::load(|_| null()));
    let (v1_2, v1_3) = (device.fp_v1_2(), device.fp_v1_3());
    // Not called, but every device of Vulkan 1.2 has it, and the shaders need that version.
    if v1_2.reset_query_pool as usize == no_1_2.reset_query_pool as usize {
        return missing("vkResetQueryPool");
    }
    let synchronization = match enabled.synchronization2 {
        false => Synchronization::First,
        true => {
            let extension = ash::khr::synchronization2::DeviceFn::load(|name| find(host, name));
            let none = ash::khr::synchronization2::DeviceFn::load(|_| null());
            let (mut barrier, mut timestamp) =
                (v1_3.cmd_pipeline_barrier2, v1_3.cmd_write_timestamp2);
            if barrier as usize == no_1_3.cmd_pipeline_barrier2 as usize {
                barrier = extension.cmd_pipeline_barrier2_khr;
                if barrier as usize == none.cmd_pipeline_barrier2_khr as usize {
                    return missing("vkCmdPipelineBarrier2");
                }
            }
            if timestamp as usize == no_1_3.cmd_write_timestamp2 as usize {
                timestamp = extension.cmd_write_timestamp2_khr;
                if timestamp as usize == none.cmd_write_timestamp2_khr as usize {
                    return missing("vkCmdWriteTimestamp2");
                }
            }
            Synchronization::Second { barrier, timestamp }
        }
    };
    let counted = v1_2.cmd_draw_indirect_count as usize != no_1_2.cmd_draw_indirect_count as usize;
    if enabled.draw_indirect_count && !counted {
        return missing("vkCmdDrawIndirectCount");
    }
    let has = |name| !find(host, name).is_null();
    if enabled.conditional_rendering && !has(c"vkCmdBeginConditionalRenderingEXT") {
        return missing("vkCmdBeginConditionalRenderingEXT");
    }
    if enabled.debug_utils && !has(c"vkSetDebugUtilsObjectNameEXT") {
        return missing("vkSetDebugUtilsObjectNameEXT");
    }
    Ok(synchronization)
}

/// The function that sets the comparison of the depth test: of Vulkan 1.3, or of VK_EXT_extended_dynamic_state.
#[cfg(feature = "headless")]
pub fn depth_compare(host: &Host<'_>) -> Option<vk::PFN_vkCmdSetDepthCompareOp> {
    let own = host.device.fp_v1_3().cmd_set_depth_compare_op;
    let none = ash::DeviceFnV1_3::load(|_| null()).cmd_set_depth_compare_op;
    if own as usize != none as usize {
        return Some(own);
    }
    use ash::ext::extended_dynamic_state::DeviceFn;
    let own = DeviceFn::load(|name| find(host, name)).cmd_set_depth_compare_op_ext;
    let none = DeviceFn::load(|_| null()).cmd_set_depth_compare_op_ext;
    (own as usize != none as usize).then_some(own)
}

/// A function of the device, or null.
fn find(host: &Host<'_>, name: &CStr) -> *const c_void {
    // SAFETY: the device is alive; the name ends with a nul.
    let found = unsafe { host.instance.get_device_proc_addr(host.device.handle(), name.as_ptr()) };
    found.map_or(null(), |function| function as *const c_void)
}

/// The Vulkan version that a device can be created for: that of the physical device, but at most 1.2 if the instance
/// was created for a version below 1.3.
pub fn api_version(instance: &ash::Instance, properties: &vk::PhysicalDeviceProperties) -> u32 {
    let none = ash::InstanceFnV1_3::load(|_| null());
    let own = instance.fp_v1_3();
    let loaded = own.get_physical_device_tool_properties as usize
        != none.get_physical_device_tool_properties as usize;
    match loaded {
        true => properties.api_version,
        false => properties.api_version.min(vk::API_VERSION_1_2),
    }
}

/// Whether the device was created for Vulkan 1.3, as far as that can be detected: some drivers provide the functions
/// of their own version with any instance.
pub fn is_1_3(device: &ash::Device) -> bool {
    let none = ash::DeviceFnV1_3::load(|_| null());
    device.fp_v1_3().get_device_buffer_memory_requirements as usize
        != none.get_device_buffer_memory_requirements as usize
}

/// Whether an instance has the functions to query features and properties of Vulkan 1.1 and later.
pub fn of_instance(instance: &ash::Instance) -> bool {
    let none = ash::InstanceFnV1_1::load(|_| null());
    let own = instance.fp_v1_1();
    own.get_physical_device_features2 as usize != none.get_physical_device_features2 as usize
        && own.get_physical_device_properties2 as usize
            != none.get_physical_device_properties2 as usize
}

fn missing<T>(function: &str) -> Result<T, Error> {
    Err(Error::Missing {
        what: format!("the function {function}"),
        why: "Host.instance and Host.device do not have it: create the instance for Vulkan 1.2 or newer \
              (VkApplicationInfo::apiVersion), and enable on the device the features that Host.enabled states"
            .into(),
    })
}
