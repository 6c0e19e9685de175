//! Checks that the host's function tables contain every function that is called: ash fills functions that a
//! loader does not know, such as all of Vulkan 1.3 on a 1.2 instance, with ones that panic.

use std::ptr::null;

use crate::contract::Host;
use crate::error::Error;

/// An error for the first function above Vulkan 1.0 that would panic. A device that lacks one of 1.0 is none.
pub fn check(host: &Host<'_>) -> Result<(), Error> {
    let (device, enabled) = (host.device, host.enabled);
    if !of_instance(host.instance) {
        return missing("vkGetPhysicalDeviceProperties2");
    }
    // What ash puts in the place of each.
    let (no_1_2, no_1_3) =
        (ash::DeviceFnV1_2::load(|_| null()), ash::DeviceFnV1_3::load(|_| null()));
    let (v1_2, v1_3) = (device.fp_v1_2(), device.fp_v1_3());
    if v1_3.cmd_pipeline_barrier2 as usize == no_1_3.cmd_pipeline_barrier2 as usize {
        return missing("vkCmdPipelineBarrier2");
    }
    if v1_3.cmd_write_timestamp2 as usize == no_1_3.cmd_write_timestamp2 as usize {
        return missing("vkCmdWriteTimestamp2");
    }
    let counted = v1_2.cmd_draw_indirect_count as usize != no_1_2.cmd_draw_indirect_count as usize;
    if enabled.draw_indirect_count && !counted {
        return missing("vkCmdDrawIndirectCount");
    }
    let has = |name| {
        // SAFETY: the device is alive; the name ends with a nul.
        let found = unsafe { host.instance.get_device_proc_addr(device.handle(), name) };
        found.is_some()
    };
    if enabled.conditional_rendering && !has(c"vkCmdBeginConditionalRenderingEXT".as_ptr()) {
        return missing("vkCmdBeginConditionalRenderingEXT");
    }
    if enabled.debug_utils && !has(c"vkSetDebugUtilsObjectNameEXT".as_ptr()) {
        return missing("vkSetDebugUtilsObjectNameEXT");
    }
    Ok(())
}

/// Whether an instance can be asked for features and properties of Vulkan 1.1 and later.
pub fn of_instance(instance: &ash::Instance) -> bool {
    let none = ash::InstanceFnV1_1::load(|_| null());
    let own = instance.fp_v1_1();
    own.get_physical_device_features2 as usize != none.get_physical_device_features2 as usize
        && own.get_physical_device_properties2 as usize
            != none.get_physical_device_properties2 as usize
}

fn missing(function: &str) -> Result<(), Error> {
    Err(Error::Missing {
        what: format!("the function {function}"),
        why: "Host.instance and Host.device do not hold it: make the instance for Vulkan 1.3 \
              (VkApplicationInfo::apiVersion), and enable on the device what Host.enabled says"
            .into(),
    })
}
