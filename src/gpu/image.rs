//! An image: handle, memory and one or two views.

use ash::vk;

use super::Gpu;
use super::graveyard::{Grave, Graveyard};
use super::memory::{self, Memory, MemoryLocation, MemoryRequest};
use crate::error::{Error, VkContext};

/// Description of an image.
#[derive(Clone, Copy)]
pub struct ImageDesc<'a> {
    /// `technique/stem/what`.
    pub name: &'a str,
    /// Size in texels.
    pub extent: vk::Extent2D,
    /// Format of the image and its view.
    pub format: vk::Format,
    /// Format of an optional second view of the image, of the same compatibility class as the
    /// first: for example `R32_UINT`, for atomics on an `R32_SFLOAT` image.
    pub alias: Option<vk::Format>,
    /// Usage.
    pub usage: vk::ImageUsageFlags,
    /// Mip levels.
    pub mips: u32,
    /// Array layers; 6 makes a cube.
    pub layers: u32,
    /// Samples per texel.
    pub samples: vk::SampleCountFlags,
}

impl<'a> ImageDesc<'a> {
    /// A plain 2D image: one mip, one layer, one sample.
    pub fn new(
        name: &'a str,
        extent: vk::Extent2D,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
    ) -> Self {
        let samples = vk::SampleCountFlags::TYPE_1;
        Self { name, extent, format, alias: None, usage, mips: 1, layers: 1, samples }
    }
}

/// An image with its memory.
pub struct Image {
    /// The image.
    pub handle: vk::Image,
    /// View of the whole image in its own format (a cube view for six layers).
    pub view: vk::ImageView,
    /// View in the alias format, otherwise null.
    pub alias_view: vk::ImageView,
    /// Size in texels.
    pub extent: vk::Extent2D,
    /// Format.
    pub format: vk::Format,
    /// Bytes of device memory.
    pub size: u64,
    /// `Some` until drop.
    memory: Option<Memory>,
    yard: Graveyard,
}

impl Image {
    /// Creates the image, its memory and its views.
    pub fn new(gpu: &Gpu, desc: &ImageDesc<'_>) -> Result<Self, Error> {
        let name = desc.name;
        let mut flags = vk::ImageCreateFlags::empty();
        if desc.alias.is_some() {
            flags |= vk::ImageCreateFlags::MUTABLE_FORMAT;
        }
        if desc.layers == 6 {
            flags |= vk::ImageCreateFlags::CUBE_COMPATIBLE;
        }
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(vk::ImageType::TYPE_2D)
            .format(desc.format)
            .extent(desc.extent.into())
            .mip_levels(desc.mips)
            .array_layers(desc.layers)
            .samples(desc.samples)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(desc.usage)
            .initial_layout(vk::ImageLayout::UNDEFINED);
        // SAFETY: valid create info; extents are checked by the caller against the limits.
        let handle = unsafe { gpu.device.create_image(&info, None) }
            .context(|| format!("vkCreateImage {name}"))?;
        // SAFETY: the handle was just created.
        let requirements = unsafe { gpu.device.get_image_memory_requirements(handle) };
        let request =
            MemoryRequest { name, requirements, location: MemoryLocation::GpuOnly, linear: false };
        let memory = match memory::allocate(gpu.allocator(), &request) {
            Ok(memory) => memory,
            Err(error) => {
                // SAFETY: nothing uses the image yet.
                unsafe { gpu.device.destroy_image(handle, None) };
                return Err(error);
            }
        };
        let place = (memory.memory(), memory.offset());
        let mut image = Self {
            handle,
            view: vk::ImageView::null(),
            alias_view: vk::ImageView::null(),
            extent: desc.extent,
            format: desc.format,
            size: requirements.size,
            memory: Some(memory),
            yard: gpu.graveyard.clone(),
        };
        image.bind(gpu, desc, place)?;
        Ok(image)
    }

    fn bind(
        &mut self,
        gpu: &Gpu,
        desc: &ImageDesc<'_>,
        (memory, offset): (vk::DeviceMemory, u64),
    ) -> Result<(), Error> {
        let name = desc.name;
        // SAFETY: the memory meets the image's requirements and is bound once.
        unsafe { gpu.device.bind_image_memory(self.handle, memory, offset) }
            .context(|| format!("vkBindImageMemory {name}"))?;
        gpu.name(self.handle, name);
        let kind = match desc.layers {
            1 => vk::ImageViewType::TYPE_2D,
            6 => vk::ImageViewType::CUBE,
            _ => vk::ImageViewType::TYPE_2D_ARRAY,
        };
        let view = |format| gpu.view(self.handle, format, kind, desc.layers, desc.mips, name);
        self.view = view(desc.format)?;
        if let Some(alias) = desc.alias {
            self.alias_view = view(alias)?;
        }
        Ok(())
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        let memory = self.memory.take();
        self.yard.push(Grave::Image(self.handle, [self.view, self.alias_view], memory));
    }
}

/// The aspect of a format (no stencil formats are used here).
pub fn aspect_of(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D32_SFLOAT | vk::Format::D16_UNORM => vk::ImageAspectFlags::DEPTH,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

impl Gpu {
    /// A view of all layers and the first mips.
    pub fn view(
        &self,
        image: vk::Image,
        format: vk::Format,
        kind: vk::ImageViewType,
        layers: u32,
        mips: u32,
        name: &str,
    ) -> Result<vk::ImageView, Error> {
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(kind)
            .format(format)
            .subresource_range(vk::ImageSubresourceRange {
                aspect_mask: aspect_of(format),
                base_mip_level: 0,
                level_count: mips,
                base_array_layer: 0,
                layer_count: layers,
            });
        // SAFETY: the image is alive and was created with these formats and layers.
        let view = unsafe { self.device.create_image_view(&info, None) }
            .context(|| format!("vkCreateImageView {name}"))?;
        self.name(view, name);
        Ok(view)
    }
}
