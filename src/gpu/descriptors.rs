//! Descriptor sets, per slot: each slot has a pool that is reset when its next frame begins. They are ordinary sets
//! and not push descriptors, because not every device has those, and GPU-assisted validation reports false errors on
//! them.

use ash::vk;

use super::Gpu;
use super::graveyard::{Grave, Owned};
use super::image::Image;
use super::pipeline::Pipeline;
use crate::error::{Error, VkContext};

/// Resource of one binding.
#[derive(Clone, Copy)]
pub enum Resource {
    /// Uniform or storage buffer, depending on the shader: (buffer, offset, range).
    Buffer(vk::Buffer, u64, u64),
    /// Storage image in GENERAL.
    Storage(vk::ImageView),
    /// Sampled image in SHADER_READ_ONLY_OPTIMAL.
    Sampled(vk::ImageView, vk::Sampler),
    /// Sampled image in another layout.
    SampledIn(vk::ImageView, vk::Sampler, vk::ImageLayout),
}

impl Resource {
    /// A whole buffer.
    pub fn buffer(buffer: &super::buffer::Buffer) -> Self {
        Self::Buffer(buffer.handle, 0, vk::WHOLE_SIZE)
    }

    /// One of our images as a storage image.
    pub fn storage(image: &Image) -> Self {
        Self::Storage(image.view)
    }
}

/// Average number of descriptors of each type per set.
const EACH: [(vk::DescriptorType, u32); 4] = [
    (vk::DescriptorType::UNIFORM_BUFFER, 2),
    (vk::DescriptorType::STORAGE_BUFFER, 7),
    (vk::DescriptorType::STORAGE_IMAGE, 4),
    (vk::DescriptorType::COMBINED_IMAGE_SAMPLER, 7),
];

/// One slot's pool.
pub struct Descriptors {
    pool: Owned<vk::DescriptorPool>,
    /// Capacity of the pool in sets, and the numbers of sets and of descriptors of each type taken so far. They are
    /// counted because drivers may allocate beyond the capacity and validation layers do not report that.
    #[cfg(debug_assertions)]
    taken: (u32, [std::sync::atomic::AtomicU32; 1 + EACH.len()]),
}

impl Descriptors {
    /// A pool with room for `sets` sets, which together have at most `sets` times the descriptors of [`EACH`].
    pub fn new(gpu: &Gpu, sets: u32) -> Result<Self, Error> {
        let sizes =
            EACH.map(|(ty, each)| vk::DescriptorPoolSize { ty, descriptor_count: sets * each });
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(sets).pool_sizes(&sizes);
        // SAFETY: valid create info.
        let pool = unsafe { gpu.device.create_descriptor_pool(&info, None) }
            .context(|| "vkCreateDescriptorPool".into())?;
        gpu.name(pool, "slot/descriptors");
        Ok(Self {
            pool: gpu.own(pool, Grave::DescriptorPool),
            #[cfg(debug_assertions)]
            taken: (sets, Default::default()),
        })
    }

    /// Panics in debug builds if the pool's capacity is exceeded.
    #[cfg(debug_assertions)]
    fn take(&self, pipeline: &Pipeline) {
        use std::sync::atomic::Ordering::Relaxed;
        let (sets, [taken, of_types @ ..]) = &self.taken;
        assert!(taken.fetch_add(1, Relaxed) < *sets, "{}: one set more than {sets}", pipeline.name);
        for ((ty, each), taken) in EACH.iter().zip(of_types) {
            let count = pipeline.bindings.values().filter(|bound| *bound == ty).count() as u32;
            let taken = taken.fetch_add(count, Relaxed) + count;
            assert!(taken <= sets * each, "{}: {taken} of {ty:?} in {sets} sets", pipeline.name);
        }
    }

    /// Frees all sets. The slot's earlier work has to be complete.
    pub fn reset(&self, gpu: &Gpu) -> Result<(), Error> {
        #[cfg(debug_assertions)]
        for taken in &self.taken.1 {
            taken.store(0, std::sync::atomic::Ordering::Relaxed);
        }
        // SAFETY: the contract says that the slot's earlier work is done.
        unsafe {
            gpu.device
                .reset_descriptor_pool(self.pool.handle, vk::DescriptorPoolResetFlags::empty())
        }
        .context(|| "vkResetDescriptorPool".into())
    }

    /// Creates a set for a pipeline.
    pub fn set(
        &self,
        gpu: &Gpu,
        pipeline: &Pipeline,
        resources: &[(u32, Resource)],
    ) -> Result<vk::DescriptorSet, Error> {
        debug_assert!(
            pipeline.bindings.keys().all(|b| resources.iter().any(|r| r.0 == *b)),
            "{} is not given all of {:?}",
            pipeline.name,
            pipeline.bindings
        );
        #[cfg(debug_assertions)]
        self.take(pipeline);
        let layouts = [pipeline.set_layout];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(self.pool.handle)
            .set_layouts(&layouts);
        // SAFETY: only this slot uses the pool.
        let set = unsafe { gpu.device.allocate_descriptor_sets(&info) }
            .context(|| format!("vkAllocateDescriptorSets {}", pipeline.name))?[0];
        for &(binding, resource) in resources {
            // A pass may use one list for several pipelines that each use a part of it.
            let Some(&kind) = pipeline.bindings.get(&binding) else { continue };
            let (mut buffers, mut images) =
                ([vk::DescriptorBufferInfo::default()], [vk::DescriptorImageInfo::default()]);
            let write = vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding)
                .descriptor_type(kind);
            let write = match resource {
                Resource::Buffer(buffer, offset, range) => {
                    buffers[0] = vk::DescriptorBufferInfo { buffer, offset, range };
                    write.buffer_info(&buffers)
                }
                Resource::Storage(image_view) => {
                    images[0] = vk::DescriptorImageInfo {
                        sampler: vk::Sampler::null(),
                        image_view,
                        image_layout: vk::ImageLayout::GENERAL,
                    };
                    write.image_info(&images)
                }
                Resource::Sampled(image_view, sampler) => {
                    images[0] = vk::DescriptorImageInfo {
                        sampler,
                        image_view,
                        image_layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
                    };
                    write.image_info(&images)
                }
                Resource::SampledIn(image_view, sampler, image_layout) => {
                    images[0] = vk::DescriptorImageInfo { sampler, image_view, image_layout };
                    write.image_info(&images)
                }
            };
            // SAFETY: the set is fresh, the resources are alive until the slot comes back.
            unsafe { gpu.device.update_descriptor_sets(&[write], &[]) };
        }
        Ok(set)
    }

    /// Binds a pipeline with a fresh set.
    pub fn bind(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        pipeline: &Pipeline,
        resources: &[(u32, Resource)],
    ) -> Result<(), Error> {
        let set = self.set(gpu, pipeline, resources)?;
        pipeline.bind(gpu, cmd);
        bind_set(gpu, cmd, pipeline, set);
        Ok(())
    }
}

/// Binds a set that was created earlier in the frame.
pub fn bind_set(gpu: &Gpu, cmd: vk::CommandBuffer, pipeline: &Pipeline, set: vk::DescriptorSet) {
    // SAFETY: cmd is recording; the set was made for this pipeline's layout.
    unsafe {
        gpu.device.cmd_bind_descriptor_sets(cmd, pipeline.point, pipeline.layout, 0, &[set], &[]);
    }
}
