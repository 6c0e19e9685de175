//! The features that a host enables, as structures for device creation.

use std::ffi::CStr;

use ash::vk;

use crate::contract::EnabledFeatures;

/// Vulkan feature structures in which the features of an [`EnabledFeatures`] are enabled, to be chained into
/// `VkDeviceCreateInfo`. [`EnabledFeatures::device_features`] makes them.
pub struct DeviceFeatures {
    core: vk::PhysicalDeviceFeatures,
    vulkan12: vk::PhysicalDeviceVulkan12Features<'static>,
    synchronization2: vk::PhysicalDeviceSynchronization2Features<'static>,
    conditional_rendering: vk::PhysicalDeviceConditionalRenderingFeaturesEXT<'static>,
}

// SAFETY: `chain` borrows the structures mutably for as long as its result lives, and chains them anew, so no pointer of
// an earlier chain is ever read, on whichever thread.
unsafe impl Send for DeviceFeatures {}
// SAFETY: as above.
unsafe impl Sync for DeviceFeatures {}

impl DeviceFeatures {
    /// Adds everything that is enabled to the create info: `pEnabledFeatures`, and in the `pNext` chain
    /// VkPhysicalDeviceVulkan12Features and the structures of extensions. A host that chains one of these structures
    /// itself, or the single-feature structures that VkPhysicalDeviceVulkan12Features combines, does not call this.
    /// It fills its own structures with [`EnabledFeatures::set_core`] and the similar functions.
    pub fn chain<'a>(&'a mut self, info: vk::DeviceCreateInfo<'a>) -> vk::DeviceCreateInfo<'a> {
        // An earlier chain of these structures is no longer valid.
        self.vulkan12.p_next = std::ptr::null_mut();
        self.synchronization2.p_next = std::ptr::null_mut();
        self.conditional_rendering.p_next = std::ptr::null_mut();
        let mut info = info.enabled_features(&self.core).push_next(&mut self.vulkan12);
        if self.synchronization2.synchronization2 == vk::TRUE {
            info = info.push_next(&mut self.synchronization2);
        }
        if self.conditional_rendering.conditional_rendering == vk::TRUE {
            info = info.push_next(&mut self.conditional_rendering);
        }
        info
    }
}

impl EnabledFeatures {
    /// The structures that enable these features on a device, for example those in
    /// [`DeviceSupport::optional`](crate::DeviceSupport).
    ///
    /// ```
    /// use ash::vk;
    /// let enabled = whitewater::EnabledFeatures::default().with(|it| it.synchronization2 = true);
    /// let mut features = enabled.device_features();
    /// let names: Vec<_> =
    ///     enabled.device_extensions(vk::API_VERSION_1_3).iter().map(|name| name.as_ptr()).collect();
    /// let info = vk::DeviceCreateInfo::default().enabled_extension_names(&names);
    /// let info = features.chain(info); // and vkCreateDevice
    /// assert!(!info.p_next.is_null());
    /// ```
    pub fn device_features(&self) -> DeviceFeatures {
        let mut features = DeviceFeatures {
            core: vk::PhysicalDeviceFeatures::default(),
            vulkan12: vk::PhysicalDeviceVulkan12Features::default(),
            synchronization2: vk::PhysicalDeviceSynchronization2Features::default(),
            conditional_rendering: vk::PhysicalDeviceConditionalRenderingFeaturesEXT::default(),
        };
        self.set_core(&mut features.core);
        self.set_vulkan12(&mut features.vulkan12);
        self.set_synchronization2(&mut features.synchronization2);
        self.set_conditional_rendering(&mut features.conditional_rendering);
        features
    }

    /// Device extensions that these features need, on a device of this Vulkan version.
    pub fn device_extensions(&self, api_version: u32) -> Vec<&'static CStr> {
        let mut names = Vec::new();
        if self.conditional_rendering {
            names.push(ash::ext::conditional_rendering::NAME);
        }
        if self.synchronization2 && api_version < vk::API_VERSION_1_3 {
            names.push(ash::khr::synchronization2::NAME);
        }
        names
    }

    /// Enables these features in the host's own `VkPhysicalDeviceFeatures`. It disables none.
    pub fn set_core(&self, features: &mut vk::PhysicalDeviceFeatures) {
        for (wanted, feature) in [
            (self.large_points, &mut features.large_points),
            (self.precise_occlusion_queries, &mut features.occlusion_query_precise),
            (self.buffer_int64_atomics, &mut features.shader_int64),
            (
                self.storage_image_write_without_format,
                &mut features.shader_storage_image_write_without_format,
            ),
        ] {
            turn_on(wanted, feature);
        }
    }

    /// Enables these features in the host's own `VkPhysicalDeviceVulkan12Features`.
    pub fn set_vulkan12(&self, features: &mut vk::PhysicalDeviceVulkan12Features<'_>) {
        turn_on(self.draw_indirect_count, &mut features.draw_indirect_count);
        turn_on(self.buffer_int64_atomics, &mut features.shader_buffer_int64_atomics);
    }

    /// Enables these features in the host's own VkPhysicalDeviceVulkan13Features, for hosts that use it instead of
    /// the structures of its single features.
    pub fn set_vulkan13(&self, features: &mut vk::PhysicalDeviceVulkan13Features<'_>) {
        turn_on(self.synchronization2, &mut features.synchronization2);
    }

    /// Enables the feature synchronization2 in the host's own structure.
    pub fn set_synchronization2(
        &self,
        features: &mut vk::PhysicalDeviceSynchronization2Features<'_>,
    ) {
        turn_on(self.synchronization2, &mut features.synchronization2);
    }

    /// Enables the feature conditional rendering in the host's own structure.
    pub fn set_conditional_rendering(
        &self,
        features: &mut vk::PhysicalDeviceConditionalRenderingFeaturesEXT<'_>,
    ) {
        turn_on(self.conditional_rendering, &mut features.conditional_rendering);
    }
}

fn turn_on(wanted: bool, feature: &mut vk::Bool32) {
    if wanted {
        *feature = vk::TRUE;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A second chain of the same structures is as long as the first, and does not go round in circles.
    #[test]
    fn features_can_be_chained_again() {
        let enabled = EnabledFeatures::default().with(|it| {
            it.synchronization2 = true;
            it.conditional_rendering = true;
        });
        let mut features = enabled.device_features();
        for _ in 0..3 {
            let info = features.chain(vk::DeviceCreateInfo::default());
            let mut next = info.p_next.cast::<vk::BaseInStructure<'_>>();
            let mut kinds = Vec::new();
            while !next.is_null() && kinds.len() < 9 {
                // SAFETY: a chain of live structures.
                let structure = unsafe { &*next };
                kinds.push(structure.s_type);
                next = structure.p_next;
            }
            kinds.sort();
            let mut wanted = vec![
                vk::StructureType::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                vk::StructureType::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
                vk::StructureType::PHYSICAL_DEVICE_CONDITIONAL_RENDERING_FEATURES_EXT,
            ];
            wanted.sort();
            assert_eq!(kinds, wanted);
        }
    }
}
