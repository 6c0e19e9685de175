//! Transfers data to the device and back; each call waits for its end.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::levels::{self, BACK, FRONT};
use super::{COLOR_FORMAT, COLOR_REST, Counts, DEPTH_FORMAT, DEPTH_REST, Headless, Picture};
use crate::contract::{Access, Layer};
use crate::diagnostics::SmoothingLevels;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COPY_READ, COPY_WRITE};
use crate::gpu::buffer::Buffer;
use crate::gpu::graveyard::Destroy;
use crate::gpu::image::{Image, aspect_of};

/// Mapped memory read by the host.
const HOST_READ: Access = Access::new(
    vk::PipelineStageFlags2::HOST,
    vk::AccessFlags2::HOST_READ,
    vk::ImageLayout::GENERAL,
);

/// Fails unless a picture of this extent has this number of texels, because a copy from fewer would read past their end,
/// and the device can hold it.
pub fn check_texels(
    gpu: &Gpu,
    field: &'static str,
    extent: vk::Extent2D,
    found: usize,
) -> Result<(), Error> {
    let (width, height) = (extent.width, extent.height);
    let most = gpu.limits.max_image_dimension2_d;
    if width > most || height > most {
        let why =
            format!("expected at most {most}x{most} texels on this device, found {width}x{height}");
        return Err(Error::bad(field, why));
    }
    if width == 0 || height == 0 || found as u64 != u64::from(width) * u64::from(height) {
        let why = format!("expected one value for each of {width}x{height} texels, found {found}");
        return Err(Error::bad(field, why));
    }
    Ok(())
}

/// A mapped staging buffer with these bytes.
pub fn staging(gpu: &Gpu, bytes: &[u8]) -> Result<Buffer, Error> {
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let size = bytes.len() as u64;
    let mut buffer = Buffer::new(gpu, "headless/staging", size, usage, MemoryLocation::CpuToGpu)?;
    buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
    Ok(buffer)
}

/// Copies an image to another of the same size and format. Both return to their previous layout.
pub fn copy(gpu: &Gpu, cmd: vk::CommandBuffer, from: (&Image, Access), to: (&Image, Access)) {
    let ((from, from_rest), (to, to_rest)) = (from, to);
    let before = [
        access::image(from, from_rest, COPY_READ),
        access::image(to, to_rest.discarded(), COPY_WRITE),
    ];
    gpu.barriers(cmd, &before, &[]);
    let layers = vk::ImageSubresourceLayers {
        aspect_mask: aspect_of(from.format),
        mip_level: 0,
        base_array_layer: 0,
        layer_count: 1,
    };
    let region = vk::ImageCopy::default()
        .src_subresource(layers)
        .dst_subresource(layers)
        .extent(from.extent.into());
    // SAFETY: both images are in their transfer layouts, of one format and size.
    unsafe {
        gpu.device.cmd_copy_image(
            cmd,
            from.handle,
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            to.handle,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
            &[region],
        );
    }
    let after = [access::image(from, COPY_READ, from_rest), access::image(to, COPY_WRITE, to_rest)];
    gpu.barriers(cmd, &after, &[]);
}

impl Headless {
    /// Copies a staging buffer over a whole image.
    pub(super) fn upload(
        &self,
        cmd: vk::CommandBuffer,
        from: &Buffer,
        to: &Image,
        before: Access,
        after: Access,
    ) {
        let discarded = before.discarded();
        self.gpu.barriers(cmd, &[access::image(to, discarded, COPY_WRITE)], &[]);
        let region = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: aspect_of(to.format),
                mip_level: 0,
                base_array_layer: 0,
                layer_count: 1,
            })
            .image_extent(to.extent.into());
        // SAFETY: the image is in TRANSFER_DST_OPTIMAL; the buffer holds all of its texels.
        unsafe {
            self.gpu.device.cmd_copy_buffer_to_image(
                cmd,
                from.handle,
                to.handle,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &[region],
            );
        }
        if after != COPY_WRITE {
            self.gpu.barriers(cmd, &[access::image(to, COPY_WRITE, after)], &[]);
        }
    }

    /// Particle statistics of the last frame.
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn counts(&mut self) -> Result<Counts, Error> {
        let mut sum = Counts::default();
        let Some(counts) = self.counts else { return Ok(sum) };
        for (buffer, front) in [(counts.all, false), (counts.front, true)] {
            let words = self.read_buffer(buffer, 256 * u64::from(counts.chunks))?;
            for chunk in words.chunks_exact(64) {
                let drawn = chunk[0] + chunk[5];
                if front {
                    sum.front += drawn;
                } else {
                    sum.visible += drawn;
                    sum.dropped += chunk[18];
                    sum.spray += chunk[19];
                }
            }
        }
        Ok(sum)
    }

    /// Numbers of samples that the occlusion queries of the smoothing counted in the last frame, in iterations
    /// 5, 10, …: 0 for a block of five iterations that was skipped. The last block is not counted. Empty if the
    /// smoothing uses no queries, and after [`render_with_read_back`](Self::render_with_read_back).
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn active_samples(&mut self) -> Result<Vec<u32>, Error> {
        match self.active_samples {
            Some((buffer, blocks)) => self.read_buffer(buffer, 4 * u64::from(blocks)),
            None => Ok(Vec::new()),
        }
    }

    pub(super) fn read_buffer(&mut self, from: vk::Buffer, size: u64) -> Result<Vec<u32>, Error> {
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let name = "headless/readback";
        let buffer = Buffer::new(&self.gpu, name, size, usage, MemoryLocation::GpuToCpu)?;
        let result = self.run(|this, cmd| {
            let used = access::COMPUTE_WRITE.and(access::INDIRECT).and(COPY_WRITE);
            this.gpu.barriers(cmd, &[], &[access::buffer(from, used, COPY_READ)]);
            let region = vk::BufferCopy { src_offset: 0, dst_offset: 0, size };
            // SAFETY: both buffers are large enough.
            unsafe { this.gpu.device.cmd_copy_buffer(cmd, from, buffer.handle, &[region]) };
            this.gpu.barriers(
                cmd,
                &[],
                &[
                    access::buffer(buffer.handle, COPY_WRITE, HOST_READ),
                    access::buffer(from, COPY_READ, access::COMPUTE_WRITE),
                ],
            );
            Ok(())
        });
        let words = buffer.mapped()[..size as usize]
            .chunks_exact(4)
            .map(bytemuck::pod_read_unaligned)
            .collect();
        buffer.destroy(&self.gpu);
        result.map(|()| words)
    }

    /// The output of the last frame: linear RGBA.
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn color(&mut self) -> Result<Picture<[f32; 4]>, Error> {
        let texels: Picture<[u16; 4]> =
            self.read(self.color.handle, COLOR_FORMAT, self.color.extent.into(), COLOR_REST)?;
        Ok(texels.map(|c| c.map(|v| half::f16::from_bits(v).to_f32())))
    }

    /// Device depth of the scene.
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn scene_depth(&mut self) -> Result<Picture<f32>, Error> {
        self.read(self.depth.handle, DEPTH_FORMAT, self.depth.extent.into(), DEPTH_REST)
    }

    /// Resolutions at which the last frame was smoothed.
    pub fn levels(&self) -> Option<SmoothingLevels> {
        self.levels
    }

    /// A layer of the last frame by its name; `None` if no layer has that name.
    ///
    /// - `water.surface` (the smoothed depth of the front layer of water) and `water.iterations` have the resolution
    ///   that is configured for the smoothing; each texel is taken from the smoothing level that is shown there.
    ///   `water.back` is the smoothed depth of the back layer.
    /// - `water.thickness.front` and `.back` are the parts of `water.thickness` in front of and behind the
    ///   frontmost foam (T_wf and T_wb of the thesis; without foam everything is in front).
    /// - `water.sheet.front` and `.back` are the thicknesses of the front and the back layer of water, channels
    ///   of `water.thickness.sheets`.
    /// - `surface_foam.front` is the thickness of the front foam layer, a channel of `surface_foam.thickness`.
    /// - `motion.X` and `motion.Y` are channels of `motion`.
    /// - Whitewater has `whitewater` (depth), `whitewater.intensity`, `whitewater.thickness`, `whitewater.submerged`
    ///   (the part of the thickness behind the water's surface), `whitewater.normal.X`, `.Y`, `.Z`,
    ///   `whitewater.radius` (search radius), `whitewater.irradiance.R`, `.G`, `.B` and `whitewater.shadow`.
    /// - Bubble foam has `bubbles` (depth) and `bubbles.layers` (number of composited blobs).
    /// - Shores have `shore.amount` and `contact.amount`.
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn layer(&mut self, name: &str) -> Result<Option<Picture<f32>>, Error> {
        if name == "bubbles.layers" {
            return self.bubble_layers();
        }
        if name == "water.thickness.front" || name == "water.thickness.back" {
            return self.about_foam(name == "water.thickness.front");
        }
        let image = match name {
            "water.back" => "water.surface",
            "water.sheet.front" | "water.sheet.back" => "water.thickness.sheets",
            "surface_foam.front" => "surface_foam.thickness",
            "motion.X" | "motion.Y" => "motion",
            "whitewater.intensity" => "whitewater",
            "whitewater.submerged" => "whitewater.thickness",
            "whitewater.normal.X"
            | "whitewater.normal.Y"
            | "whitewater.normal.Z"
            | "whitewater.radius" => "whitewater.normal",
            "whitewater.irradiance.R"
            | "whitewater.irradiance.G"
            | "whitewater.irradiance.B"
            | "whitewater.shadow" => "whitewater.irradiance",
            "shore.amount" | "contact.amount" => "shore",
            name => name,
        };
        let Some(layer) = self.layers.iter().find(|layer| layer.name == image).copied() else {
            return Ok(None);
        };
        if ["water.surface", "water.iterations"].contains(&image) {
            return self.smoothing(name, layer);
        }
        let area = vk::Rect2D::from(layer.extent);
        let channel = match name {
            "water.sheet.back" | "surface_foam.front" | "motion.Y" => 1,
            "whitewater.intensity"
            | "whitewater.submerged"
            | "whitewater.normal.Y"
            | "whitewater.irradiance.G" => 1,
            "whitewater.normal.Z" | "whitewater.irradiance.B" => 2,
            "whitewater.radius" | "whitewater.shadow" => 3,
            _ => 0,
        };
        if layer.format == vk::Format::R8G8B8A8_UNORM {
            let all: Picture<[u8; 4]> = self.read(layer.image, layer.format, area, layer.access)?;
            // Contact foam on the host's surface, or on the particles' water in front of it.
            let contact = name == "contact.amount";
            let part = |all: &[u8; 4]| if contact { all[1].max(all[3]) } else { all[0] };
            return Ok(Some(all.map(|all| f32::from(part(all)) / 255.0)));
        }
        if layer.format == vk::Format::R32G32B32A32_SFLOAT {
            let all: Picture<[f32; 4]> =
                self.read(layer.image, layer.format, area, layer.access)?;
            return Ok(Some(all.map(|all| all[channel])));
        }
        if layer.format == vk::Format::R16G16B16A16_SFLOAT {
            let half: Picture<[u16; 4]> =
                self.read(layer.image, layer.format, area, layer.access)?;
            return Ok(Some(half.map(|all| half::f16::from_bits(all[channel]).to_f32())));
        }
        if layer.format == vk::Format::R32G32_SFLOAT {
            let both: Picture<[f32; 2]> =
                self.read(layer.image, layer.format, area, layer.access)?;
            return Ok(Some(both.map(|both| both[channel])));
        }
        // The spray layer, on devices that cannot blend other formats.
        if layer.format == vk::Format::R16G16_SFLOAT {
            let half: Picture<[u16; 2]> =
                self.read(layer.image, layer.format, area, layer.access)?;
            return Ok(Some(half.map(|both| half::f16::from_bits(both[0]).to_f32())));
        }
        self.read(layer.image, layer.format, area, layer.access).map(Some)
    }

    /// Thickness of the water in front of the frontmost foam, or behind it.
    fn about_foam(&mut self, front: bool) -> Result<Option<Picture<f32>>, Error> {
        let Some(all) = self.layer("water.thickness")? else { return Ok(None) };
        let image = self.layers.iter().find(|layer| layer.name == "water.thickness").copied();
        let foam = image.filter(|layer| layer.format == vk::Format::R32G32_SFLOAT);
        let Some(layer) = foam else {
            return Ok(Some(if front { all } else { all.map(|_| 0.0) }));
        };
        let area = vk::Rect2D::from(layer.extent);
        let both: Picture<[f32; 2]> = self.read(layer.image, layer.format, area, layer.access)?;
        // Both are sums in single precision, so the part may exceed the whole by an ulp.
        let part = |both: &[f32; 2]| if front { both[1] } else { (both[0] - both[1]).max(0.0) };
        Ok(Some(both.map(part)))
    }

    /// Number of blobs that each pixel shows.
    fn bubble_layers(&mut self) -> Result<Option<Picture<f32>>, Error> {
        let Some((buffer, words)) = self.bubble_words else { return Ok(None) };
        let vk::Extent2D { width, height } = self.color.extent;
        let size = 4 * u64::from(width) * u64::from(height) * u64::from(words);
        let all = self.read_buffer(buffer, size)?;
        // After the layers comes the max opacity.
        let drawn = |pixel: &[u32]| {
            let layers = &pixel[..pixel.len() - 1];
            layers.iter().filter(|layer| **layer != u32::MAX).count() as f32
        };
        let data = all.chunks_exact(words as usize).map(drawn).collect();
        Ok(Some(Picture { width: width as usize, height: height as usize, data }))
    }

    /// A smoothing layer, from all its levels.
    fn smoothing(&mut self, name: &str, layer: Layer) -> Result<Option<Picture<f32>>, Error> {
        let Some(levels) = self.levels else { return Ok(None) };
        let sheet = if name == "water.back" { BACK } else { FRONT };
        let surface = self.layers.iter().find(|layer| layer.name == "water.surface").copied();
        let Some(surface) = surface.filter(|_| sheet.is_in(&levels)) else { return Ok(None) };
        let [width, height] = [levels.atlas[0], levels.atlas[1]].map(|v| v as u32);
        let area = vk::Rect2D::from(vk::Extent2D { width, height });
        let depth = self.read(surface.image, surface.format, area, surface.access)?;
        if layer.format != vk::Format::R32_UINT {
            return Ok(Some(levels::surface(&levels, &depth, sheet)));
        }
        let plan: Picture<u32> = self.read(layer.image, layer.format, area, layer.access)?;
        // Iterations are the low nine bits of the plan.
        let plan = plan.map(|p| (p & 511) as f32);
        Ok(Some(levels::iterations(&levels, &depth, &plan)))
    }

    /// Copies a part of an image to the CPU; the image returns to its layout afterwards.
    fn read<T: bytemuck::AnyBitPattern>(
        &mut self,
        image: vk::Image,
        format: vk::Format,
        area: vk::Rect2D,
        state: Access,
    ) -> Result<Picture<T>, Error> {
        let extent = area.extent;
        let texels = u64::from(extent.width) * u64::from(extent.height);
        let buffer = Buffer::new(
            &self.gpu,
            "headless/readback",
            texels * size_of::<T>() as u64,
            vk::BufferUsageFlags::TRANSFER_DST,
            MemoryLocation::GpuToCpu,
        )?;
        let aspect = aspect_of(format);
        let result = self.run(|this, cmd| {
            let there = access::raw_image(image, aspect, state, COPY_READ);
            this.gpu.barriers(cmd, &[there], &[]);
            let region = vk::BufferImageCopy::default()
                .image_subresource(vk::ImageSubresourceLayers {
                    aspect_mask: aspect,
                    mip_level: 0,
                    base_array_layer: 0,
                    layer_count: 1,
                })
                .image_offset(vk::Offset3D { x: area.offset.x, y: area.offset.y, z: 0 })
                .image_extent(extent.into());
            // SAFETY: the image is in TRANSFER_SRC_OPTIMAL; the buffer has room for its texels.
            unsafe {
                this.gpu.device.cmd_copy_image_to_buffer(
                    cmd,
                    image,
                    vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                    buffer.handle,
                    &[region],
                );
            }
            this.gpu.barriers(
                cmd,
                &[access::raw_image(image, aspect, COPY_READ, state)],
                &[access::buffer(buffer.handle, COPY_WRITE, HOST_READ)],
            );
            Ok(())
        });
        let bytes = &buffer.mapped()[..texels as usize * size_of::<T>()];
        let data = bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect();
        buffer.destroy(&self.gpu);
        result?;
        Ok(Picture { width: extent.width as usize, height: extent.height as usize, data })
    }
}
