//! Deletion queue. A dropped object is not freed at once, because the GPU may still use it: its handles go to the
//! graveyard, and [`Gpu::bury`] frees them when the caller knows that the GPU is done. So a constructor that fails
//! half-way leaks nothing. A renderer that is dropped without `destroy` leaks its objects together with the
//! graveyard, which is safe.

use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

use super::Gpu;
use super::memory::Memory;

/// Handles whose owner was dropped.
pub enum Grave {
    /// An image with its views and memory.
    Image(vk::Image, [vk::ImageView; 2], Option<Memory>),
    /// A buffer with its memory.
    Buffer(vk::Buffer, Option<Memory>),
    /// A pipeline with its layouts, if the context does not own it.
    Pipeline(vk::Pipeline, vk::PipelineLayout, vk::DescriptorSetLayout),
    /// A framebuffer.
    Framebuffer(vk::Framebuffer),
    /// A view of an image that is owned elsewhere.
    View(vk::ImageView),
    /// A query pool.
    QueryPool(vk::QueryPool),
    /// A descriptor pool.
    DescriptorPool(vk::DescriptorPool),
    /// A sampler.
    Sampler(vk::Sampler),
    /// A command pool.
    #[cfg(feature = "headless")]
    CommandPool(vk::CommandPool),
    /// A fence.
    #[cfg(feature = "headless")]
    Fence(vk::Fence),
}

/// The shared deletion queue.
#[derive(Clone, Default)]
pub struct Graveyard(Arc<Mutex<Vec<Grave>>>);

impl Graveyard {
    /// Queues handles for deletion.
    pub fn push(&self, grave: Grave) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(grave);
    }

    fn take(&self) -> Vec<Grave> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// A handle that is queued for deletion when dropped.
pub struct Owned<T: Copy> {
    /// The handle.
    pub handle: T,
    grave: fn(T) -> Grave,
    yard: Graveyard,
}

impl<T: Copy> Owned<T> {
    /// Takes a handle into ownership.
    pub fn new(handle: T, grave: fn(T) -> Grave, yard: &Graveyard) -> Self {
        Self { handle, grave, yard: yard.clone() }
    }
}

impl<T: Copy> Drop for Owned<T> {
    fn drop(&mut self) {
        self.yard.push((self.grave)(self.handle));
    }
}

/// Frees an object and everything queued, at once.
#[cfg(feature = "headless")]
pub trait Destroy: Sized {
    /// Drops the object and empties the deletion queue. The GPU must have finished with the object and with
    /// everything in the queue.
    fn destroy(self, gpu: &Gpu) {
        drop(self);
        gpu.bury();
    }
}

#[cfg(feature = "headless")]
impl Destroy for super::image::Image {}
#[cfg(feature = "headless")]
impl Destroy for super::buffer::Buffer {}

impl Gpu {
    /// Takes a handle into ownership.
    pub fn own<T: Copy>(&self, handle: T, grave: fn(T) -> Grave) -> Owned<T> {
        Owned::new(handle, grave, &self.graveyard)
    }

    /// Frees everything in the queue. The GPU must have finished with it.
    pub fn bury(&self) {
        let graves = self.graveyard.take();
        if graves.is_empty() {
            return;
        }
        // Called only when there is memory to free: `record` never calls the allocator.
        let allocator = self.allocator();
        let device = &self.device;
        for grave in graves {
            // SAFETY: each handle was owned by one object, which is gone; the caller guarantees
            // that the GPU is done. Null handles are allowed.
            unsafe {
                match grave {
                    Grave::Image(image, views, memory) => {
                        device.destroy_image_view(views[0], None);
                        device.destroy_image_view(views[1], None);
                        device.destroy_image(image, None);
                        if let Some(memory) = memory {
                            allocator.free(memory);
                        }
                    }
                    Grave::Buffer(buffer, memory) => {
                        device.destroy_buffer(buffer, None);
                        if let Some(memory) = memory {
                            allocator.free(memory);
                        }
                    }
                    Grave::Pipeline(pipeline, layout, set_layout) => {
                        device.destroy_pipeline(pipeline, None);
                        device.destroy_pipeline_layout(layout, None);
                        device.destroy_descriptor_set_layout(set_layout, None);
                    }
                    Grave::Framebuffer(handle) => device.destroy_framebuffer(handle, None),
                    Grave::View(handle) => device.destroy_image_view(handle, None),
                    Grave::QueryPool(handle) => device.destroy_query_pool(handle, None),
                    Grave::DescriptorPool(handle) => device.destroy_descriptor_pool(handle, None),
                    Grave::Sampler(handle) => device.destroy_sampler(handle, None),
                    #[cfg(feature = "headless")]
                    Grave::CommandPool(handle) => device.destroy_command_pool(handle, None),
                    #[cfg(feature = "headless")]
                    Grave::Fence(handle) => device.destroy_fence(handle, None),
                }
            }
        }
    }
}
