//! The textures of the materials with their mips, uploaded once.

use ash::vk;
use glam::Vec3;

use super::super::Texture;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COPY_WRITE, FRAGMENT_SAMPLED, NOTHING};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::headless::transfer::staging;

pub struct Textures {
    images: Vec<Image>,
    sampler: Owned<vk::Sampler>,
    /// Source buffers of the images, in the same order; empty after the upload.
    staging: Vec<(Buffer, Vec<Level>)>,
}

/// One mip in the staging buffer.
struct Level {
    extent: vk::Extent2D,
    offset: u64,
}

impl Textures {
    /// Index of the texture for materials without one.
    pub const WHITE: usize = 0;

    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        // Repeats, as textures in scene files do.
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(vk::Filter::LINEAR)
            .min_filter(vk::Filter::LINEAR)
            .mipmap_mode(vk::SamplerMipmapMode::LINEAR)
            .max_lod(vk::LOD_CLAMP_NONE);
        let sampler = gpu.sampler("scene/texture", &info)?;
        let mut textures = Self { images: Vec::new(), sampler, staging: Vec::new() };
        textures.add(gpu, &Texture { width: 1, height: 1, data: vec![[255; 4]] })?;
        Ok(textures)
    }

    /// Adds a texture and returns its index.
    pub fn add(&mut self, gpu: &Gpu, texture: &Texture) -> Result<usize, Error> {
        let (width, height) = (texture.width.max(1), texture.height.max(1));
        let most = gpu.limits.max_image_dimension2_d;
        if width > most || height > most || texture.data.len() != width as usize * height as usize {
            return Err(Error::bad(
                "Material.texture",
                format!("{width}x{height} with {} texels", texture.data.len()),
            ));
        }
        let (bytes, levels) = mips(vk::Extent2D { width, height }, &texture.data);
        let image = Image::new(
            gpu,
            &ImageDesc {
                mips: levels.len() as u32,
                ..ImageDesc::new(
                    "scene/texture",
                    vk::Extent2D { width, height },
                    vk::Format::R8G8B8A8_SRGB,
                    vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
                )
            },
        )?;
        self.staging.push((staging(gpu, &bytes)?, levels));
        self.images.push(image);
        Ok(self.images.len() - 1)
    }

    /// Copies all mips of all textures to the device.
    pub fn record_upload(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        for (image, (from, levels)) in self.images.iter().zip(&self.staging) {
            gpu.barriers(cmd, &[access::image(image, NOTHING, COPY_WRITE)], &[]);
            let region = |(mip, level): (usize, &Level)| {
                vk::BufferImageCopy::default()
                    .buffer_offset(level.offset)
                    .image_subresource(vk::ImageSubresourceLayers {
                        aspect_mask: vk::ImageAspectFlags::COLOR,
                        mip_level: mip as u32,
                        base_array_layer: 0,
                        layer_count: 1,
                    })
                    .image_extent(level.extent.into())
            };
            let regions: Vec<_> = levels.iter().enumerate().map(region).collect();
            // SAFETY: the image is in TRANSFER_DST_OPTIMAL; the buffer holds all mips.
            unsafe {
                gpu.device.cmd_copy_buffer_to_image(
                    cmd,
                    from.handle,
                    image.handle,
                    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                    &regions,
                );
            }
            gpu.barriers(cmd, &[access::image(image, COPY_WRITE, FRAGMENT_SAMPLED)], &[]);
        }
    }

    /// Drops the staging buffers.
    pub fn uploaded(&mut self) {
        self.staging.clear();
    }

    pub fn resource(&self, index: usize) -> Resource {
        Resource::Sampled(self.images[index].view, self.sampler.handle)
    }
}

/// All mips of a picture, one after the other: box-filtered in linear light.
fn mips(extent: vk::Extent2D, texels: &[[u8; 4]]) -> (Vec<u8>, Vec<Level>) {
    let to_linear = |v: u8| (f32::from(v) / 255.0).powf(2.2);
    let to_byte = |v: f32| (v.powf(1.0 / 2.2) * 255.0 + 0.5) as u8;
    let mut bytes: Vec<u8> = bytemuck::cast_slice(texels).to_vec();
    let mut levels = vec![Level { extent, offset: 0 }];
    let mut level: Vec<Vec3> = texels
        .iter()
        .map(|c| Vec3::new(to_linear(c[0]), to_linear(c[1]), to_linear(c[2])))
        .collect();
    let (mut w, mut h) = (extent.width as usize, extent.height as usize);
    while w > 1 || h > 1 {
        let (nw, nh) = ((w / 2).max(1), (h / 2).max(1));
        let at = |x: usize, y: usize| level[y.min(h - 1) * w + x.min(w - 1)];
        let mut next = Vec::with_capacity(nw * nh);
        for y in 0..nh {
            for x in 0..nw {
                let sum = at(2 * x, 2 * y)
                    + at(2 * x + 1, 2 * y)
                    + at(2 * x, 2 * y + 1)
                    + at(2 * x + 1, 2 * y + 1);
                next.push(sum * 0.25);
            }
        }
        let extent = vk::Extent2D { width: nw as u32, height: nh as u32 };
        levels.push(Level { extent, offset: bytes.len() as u64 });
        bytes.extend(next.iter().flat_map(|c| [to_byte(c.x), to_byte(c.y), to_byte(c.z), 255]));
        (level, w, h) = (next, nw, nh);
    }
    (bytes, levels)
}
