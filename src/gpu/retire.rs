//! Objects that were replaced while frames that use them may still be in flight. Each waits until
//! every slot that was recorded before it was retired has come back.

use ash::vk;

use super::Gpu;
use super::buffer::Buffer;
use super::image::Image;

/// Something to free later.
pub enum Retired {
    /// An image.
    Image(Image),
    /// A buffer.
    Buffer(Buffer),
    /// A framebuffer.
    Framebuffer(vk::Framebuffer),
    /// A render pass.
    RenderPass(vk::RenderPass),
    /// A query pool.
    QueryPool(vk::QueryPool),
    /// A whole technique, by the function that frees it.
    Whole(Box<dyn FnOnce(&Gpu) + Send>),
}

impl Retired {
    /// Frees it. The GPU must be done with it.
    pub fn destroy(self, gpu: &Gpu) {
        match self {
            Self::Image(image) => image.destroy(gpu),
            Self::Buffer(buffer) => buffer.destroy(gpu),
            // SAFETY (all of these): the caller guarantees that the GPU is done.
            Self::Framebuffer(handle) => unsafe { gpu.device.destroy_framebuffer(handle, None) },
            // SAFETY: as above.
            Self::RenderPass(handle) => unsafe { gpu.device.destroy_render_pass(handle, None) },
            // SAFETY: as above.
            Self::QueryPool(handle) => unsafe { gpu.device.destroy_query_pool(handle, None) },
            Self::Whole(free) => free(gpu),
        }
    }
}

/// The retire list with the slots that are out.
#[derive(Default)]
pub struct RetireList {
    /// Bit per slot: recorded, not yet come back.
    out: u32,
    waiting: Vec<(u32, Retired)>,
}

impl RetireList {
    /// A slot was recorded.
    pub fn recorded(&mut self, slot: u32) {
        self.out |= 1 << slot;
    }

    /// Frees the object now if no slot is out, else when those that are have come back.
    pub fn retire(&mut self, gpu: &Gpu, object: Retired) {
        if self.out == 0 {
            object.destroy(gpu);
        } else {
            self.waiting.push((self.out, object));
        }
    }

    /// A slot has come back: its work is done, or it was never submitted.
    pub fn collect(&mut self, gpu: &Gpu, slot: u32) {
        self.out &= !(1 << slot);
        for (mask, _) in &mut self.waiting {
            *mask &= !(1 << slot);
        }
        for index in (0..self.waiting.len()).rev() {
            if self.waiting[index].0 == 0 {
                self.waiting.swap_remove(index).1.destroy(gpu);
            }
        }
    }

    /// How many objects wait.
    pub fn len(&self) -> usize {
        self.waiting.len()
    }

    /// Frees everything. The GPU must be done with all recorded work.
    pub fn destroy(&mut self, gpu: &Gpu) {
        for (_, object) in self.waiting.drain(..) {
            object.destroy(gpu);
        }
    }
}
