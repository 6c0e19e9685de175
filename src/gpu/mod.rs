//! The base of all passes: the host's device with its enabled features, barriers, images, buffers, render passes,
//! pipelines, descriptor sets, queries, labels and the retire list. It holds no state of a frame.

pub mod access;
pub mod buffer;
pub mod descriptors;
pub mod features;
pub mod graveyard;
pub mod image;
pub mod limits;
pub mod loaded;
pub mod memory;
pub mod pass;
pub mod pipeline;
pub mod requirements;
pub mod retire;
pub mod scan;
pub mod shader;
mod specialize;
pub mod target;
pub mod timing;

use std::mem::ManuallyDrop;
use std::ops::Deref;
use std::sync::Arc;

use ash::vk;

use crate::context::{Context, Shared};
use crate::error::{Error, VkContext};
use graveyard::{Grave, Graveyard, Owned};

/// The device as one object, such as a renderer, uses it: the Vulkan objects that its context shares, and a deletion
/// queue for the Vulkan objects of its own.
pub struct Gpu {
    /// Number of slots, as in `Context::frames_in_flight`.
    pub slots: u32,
    graveyard: Graveyard,
    /// The context's shared objects. Only `destroy` releases this reference: if a renderer is dropped without
    /// `destroy`, the GPU may still use the renderer's objects and those of its context.
    shared: ManuallyDrop<Arc<Shared>>,
}

impl Deref for Gpu {
    type Target = Shared;

    fn deref(&self) -> &Shared {
        &self.shared
    }
}

impl Gpu {
    /// For one object of a context.
    pub fn new(context: &Context) -> Arc<Self> {
        Arc::new(Self {
            slots: context.slots,
            graveyard: Graveyard::default(),
            shared: ManuallyDrop::new(context.shared.clone()),
        })
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

    /// Opens a label in the command buffer.
    pub fn begin_label(&self, cmd: vk::CommandBuffer, name: &'static std::ffi::CStr) {
        if let Some(debug) = &self.debug {
            let info = vk::DebugUtilsLabelEXT::default().label_name(name);
            // SAFETY: cmd is recording.
            unsafe { debug.cmd_begin_debug_utils_label(cmd, &info) };
        }
    }

    /// Closes the last opened label.
    pub fn end_label(&self, cmd: vk::CommandBuffer) {
        if let Some(debug) = &self.debug {
            // SAFETY: cmd is recording and a label is open.
            unsafe { debug.cmd_end_debug_utils_label(cmd) };
        }
    }

    /// Whether this is a software device, where atomics are cheap and shared memory is expensive.
    pub fn is_cpu(&self) -> bool {
        self.kind == vk::PhysicalDeviceType::CPU
    }
}

impl Gpu {
    /// Frees everything in the deletion queue and releases the context. It must be the last call, and the GPU must
    /// have finished with everything.
    pub fn destroy(self: Arc<Self>) {
        self.bury();
        // There is no other owner, because all possible ones were dropped before.
        if let Ok(mut gpu) = Arc::try_unwrap(self) {
            // SAFETY: `gpu` ends here, and nothing reads it afterwards.
            unsafe { ManuallyDrop::drop(&mut gpu.shared) };
        }
    }
}
