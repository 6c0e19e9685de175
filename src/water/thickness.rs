//! Pass `thickness`: metres of water along z at each pixel (thesis Sec. 3.2.2, Eq. 3.4 as its
//! Listing A.15 has it).
//!
//! The amplitude is such that a sprite's integral over its plane is the particle's volume (the
//! source's unit is arbitrary): absorption is per metre, and the look does not depend on how many
//! particles resolve the same water. At half resolution by default, upsampled by `composite` with
//! the weights of the surface. Two ways: additive sprites, and fixed-point atomic sums, whose
//! order is no matter.
//! Reads: the list of `cull`, scene depth. Writes: thickness, R32F.

use ash::vk;
use gpu_allocator::MemoryLocation;

use super::Recording;
use super::cull::SphereList;
use super::depth::{DEFAULT_SPLAT, dispatch_sprites, draw_sprites, sprites};
use crate::contract::Config;
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COLOR_ATTACHMENT, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE,
    COPY_READ, FRAGMENT_SAMPLED, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::settings::Splat;

/// Last uses of the image in a frame: `composite`, or the host's copy of the layer.
const BEFORE: Access = FRAGMENT_SAMPLED.and(COPY_READ);

enum Path {
    Raster {
        points: Pipeline,
        quads: Pipeline,
        pass: Owned<vk::RenderPass>,
        framebuffer: Owned<vk::Framebuffer>,
    },
    Compute {
        small: Pipeline,
        large: Pipeline,
        resolve: Pipeline,
        sums: Buffer,
    },
}

/// The pass.
pub struct Thickness {
    path: Path,
    /// Thickness along z.
    pub image: Image,
    /// Times halved.
    pub level: u32,
}

impl Thickness {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let image = Self::image(gpu, config)?;
        let path = match config.thickness_splat.unwrap_or(DEFAULT_SPLAT) {
            Splat::Raster => {
                let pass =
                    gpu.color_pass("water/thickness", image.format, vk::AttachmentLoadOp::CLEAR)?;
                let (points, quads) = sprites(
                    gpu,
                    shader::WATER_THICKNESS_VERT,
                    shader::WATER_THICKNESS_FRAG,
                    pass.handle,
                    vk::BlendOp::ADD,
                )?;
                let framebuffer =
                    gpu.framebuffer("water/thickness", pass.handle, image.view, image.extent)?;
                Path::Raster { points, quads, pass, framebuffer }
            }
            Splat::Compute => Path::Compute {
                small: Pipeline::compute(gpu, shader::WATER_THICKNESS_COMP, &[(0, 0)])?,
                large: Pipeline::compute(gpu, shader::WATER_THICKNESS_COMP, &[(0, 1)])?,
                resolve: Pipeline::compute(gpu, shader::WATER_THICKNESS_RESOLVE_COMP, &[])?,
                sums: Self::sums(gpu, &image)?,
            },
        };
        Ok(Self { path, image, level: config.thickness_level })
    }

    fn image(gpu: &Gpu, config: &Config) -> Result<Image, Error> {
        Image::new(
            gpu,
            &ImageDesc::new(
                "water/thickness",
                reduced(config.extent, config.thickness_level),
                vk::Format::R32_SFLOAT,
                vk::ImageUsageFlags::STORAGE
                    | vk::ImageUsageFlags::SAMPLED
                    | vk::ImageUsageFlags::COLOR_ATTACHMENT
                    | vk::ImageUsageFlags::TRANSFER_SRC,
            ),
        )
    }

    /// Two words a pixel.
    fn sums(gpu: &Gpu, image: &Image) -> Result<Buffer, Error> {
        Buffer::new(
            gpu,
            "water/thickness/sums",
            8 * u64::from(image.extent.width) * u64::from(image.extent.height),
            vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST,
            MemoryLocation::GpuOnly,
        )
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let image = Self::image(gpu, config)?;
        match &mut self.path {
            Path::Raster { pass, framebuffer, .. } => {
                let new =
                    gpu.framebuffer("water/thickness", pass.handle, image.view, image.extent)?;
                retired.retire(std::mem::replace(framebuffer, new));
            }
            Path::Compute { sums, .. } => {
                let new = Self::sums(gpu, &image)?;
                retired.retire(std::mem::replace(sums, new));
            }
        }
        retired.retire(std::mem::replace(&mut self.image, image));
        Ok(())
    }

    pub fn record(&self, r: &mut Recording<'_>, list: &SphereList) -> Result<(), Error> {
        let scope = r.begin(c"thickness");
        let (gpu, cmd) = (r.gpu, r.cmd);
        match &self.path {
            Path::Raster { points, quads, pass, framebuffer } => {
                gpu.barriers(
                    cmd,
                    &[access::image(&self.image, BEFORE.discarded(), COLOR_ATTACHMENT)],
                    &[],
                );
                let area = reduced(r.extent, self.level).into();
                gpu.begin_pass(cmd, pass.handle, framebuffer.handle, area, [0.0; 4]);
                draw_sprites(r, list, points, quads)?;
                gpu.end_pass(cmd);
                gpu.barriers(
                    cmd,
                    &[access::image(&self.image, COLOR_ATTACHMENT, FRAGMENT_SAMPLED)],
                    &[],
                );
            }
            Path::Compute { small, large, resolve, sums } => {
                gpu.barriers(
                    cmd,
                    &[access::image(&self.image, BEFORE.discarded(), COMPUTE_WRITE)],
                    &[buffer(sums.handle, COMPUTE_READ, CLEAR)],
                );
                // SAFETY: cmd is recording outside a render pass.
                unsafe { gpu.device.cmd_fill_buffer(cmd, sums.handle, 0, vk::WHOLE_SIZE, 0) };
                gpu.barriers(cmd, &[], &[buffer(sums.handle, CLEAR, COMPUTE_READ_WRITE)]);
                dispatch_sprites(
                    r,
                    list,
                    small,
                    large,
                    &[(3, r.scene_depth), (4, Resource::buffer(sums))],
                )?;
                gpu.barriers(cmd, &[], &[buffer(sums.handle, COMPUTE_READ_WRITE, COMPUTE_READ)]);
                r.descriptors.bind(
                    gpu,
                    cmd,
                    resolve,
                    &[
                        (0, r.uniforms),
                        (1, Resource::buffer(sums)),
                        (2, Resource::storage(&self.image)),
                    ],
                )?;
                r.dispatch_over(reduced(r.extent, self.level), resolve.local_size);
                gpu.barriers(
                    cmd,
                    &[access::image(&self.image, COMPUTE_WRITE, FRAGMENT_SAMPLED)],
                    &[],
                );
            }
        }
        r.end(scope);
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        match &self.path {
            Path::Raster { .. } => 0,
            Path::Compute { sums, .. } => sums.size,
        }
    }
}
