//! Pass `thickness`: thickness of the water along z in scene units, per pixel (thesis Sec. 3.2.2, Eq. 3.4 as in
//! Listing A.15).
//!
//! The amplitude is such that a sprite's integral over its plane is the particle's volume (the thesis' unit is
//! arbitrary). Absorption is then per scene unit, and the look does not depend on how many particles resolve the same
//! water. The image has by default a quarter of the frame's width and height; `composite` upsamples it with the
//! weights with which it interpolates the surface. There are two paths: additive sprites, and fixed-point atomic
//! sums, which do not depend on the order of the particles.
//!
//! Where `gaps` has found a boundary between two layers of water, a second image holds the thickness of each layer,
//! and the thickness of the water in a window of depths, up to 1.5 spacings before and behind the boundary: water in
//! the window means that the layers are connected. Where all water belongs to one layer, the boundary is removed.
//!
//! With foam the image has a second channel: the thickness of the water in front of the frontmost foam. Whether water
//! is in front of the foam is decided per fragment (in the thesis per particle, Listing A.14).
//! Reads: the list of `cull`, scene depth, boundaries, foam depth or the words of `surface_foam`. Writes: thickness,
//! R32F or RG32F; sheets, RGBA32F (front, back, window, boundary as found); boundaries.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::cull::SphereList;
use super::depth::{DEFAULT_SPLAT, dispatch_sprites, draw_sprites, sprites};
use super::gaps::{self, Gaps};
use super::surface_foam::{self, Foam};
use super::{Recording, shape};
use crate::contract::Config;
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COLOR_ATTACHMENT, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED,
    COMPUTE_WRITE, COPY_READ, FRAGMENT_SAMPLED, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::settings::Splat;

/// Last uses of the thickness image in a frame, for which the next frame waits: sampling by `composite`, or a copy of
/// the layer by the host.
const BEFORE: Access = FRAGMENT_SAMPLED.and(COPY_READ);

enum Path {
    Raster {
        points: Pipeline,
        quads: Pipeline,
        pass: vk::RenderPass,
        framebuffer: Owned<vk::Framebuffer>,
        prune: Option<Pipeline>,
    },
    Compute {
        small: Pipeline,
        large: Pipeline,
        apart: Option<Box<Apart>>,
        resolve: Pipeline,
        sums: Buffer,
    },
}

/// Compute pipelines for two layers of water: they add up the thickness of the front layer, and that of the water in
/// a window of depths around the boundary between the layers.
struct Apart {
    small: Pipeline,
    large: Pipeline,
    resolve: Pipeline,
}

/// Bytes of the compute path's sums. Each sum has two words per texel: one sum of all water, with foam one of the
/// water in front of the foam, and with two layers one of the front layer and one of the window around the boundary.
pub fn sum_bytes(config: &Config) -> u64 {
    let size = reduced(config.extent, config.thickness_level);
    let sums = u64::from(config.surface_foam) + if config.sheets > 1 { 3 } else { 1 };
    8 * sums * u64::from(size.width) * u64::from(size.height)
}

/// The pass.
pub struct Thickness {
    path: Path,
    /// Thickness along z of all water.
    pub image: Image,
    /// Thickness of each of two layers.
    pub sheets: Option<Image>,
    /// Number of halvings of its resolution.
    pub level: u32,
}

impl Thickness {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let image = Self::image(gpu, config)?;
        let sheets = Self::sheets(gpu, config)?;
        let foam = u32::from(config.surface_foam);
        let compute = |shader, large, apart| {
            let words = (10, surface_foam::words_of(config));
            let constants = [(0, large), (1, apart), (9, foam), words, shape::constant(config)];
            Pipeline::compute(gpu, shader, &constants)
        };
        let path = match config.thickness_splat.unwrap_or(DEFAULT_SPLAT) {
            Splat::Raster => {
                let formats: Vec<_> = [Some(&image), sheets.as_ref()]
                    .into_iter()
                    .flatten()
                    .map(|i| i.format)
                    .collect();
                let pass =
                    gpu.color_pass("water/thickness", &formats, vk::AttachmentLoadOp::CLEAR)?;
                let (points, quads) = sprites(
                    gpu,
                    shader::WATER_THICKNESS_VERT,
                    if sheets.is_some() {
                        shader::WATER_THICKNESS_APART_FRAG
                    } else {
                        shader::WATER_THICKNESS_FRAG
                    },
                    pass,
                    &vec![blend(vk::BlendOp::ADD); formats.len()],
                    config,
                )?;
                let framebuffer = Self::framebuffer(gpu, pass, &image, sheets.as_ref())?;
                let prune = (config.sheets > 1)
                    .then(|| Pipeline::compute(gpu, shader::WATER_THICKNESS_PRUNE_COMP, &[]))
                    .transpose()?;
                Path::Raster { points, quads, pass, framebuffer, prune }
            }
            Splat::Compute => Path::Compute {
                small: compute(shader::WATER_THICKNESS_COMP, 0, 0)?,
                large: compute(shader::WATER_THICKNESS_COMP, 1, 0)?,
                apart: (config.sheets > 1)
                    .then(|| {
                        Ok::<_, Error>(Box::new(Apart {
                            small: compute(shader::WATER_THICKNESS_COMP, 0, 1)?,
                            large: compute(shader::WATER_THICKNESS_COMP, 1, 1)?,
                            resolve: Pipeline::compute(
                                gpu,
                                shader::WATER_THICKNESS_APART_COMP,
                                &[(9, foam)],
                            )?,
                        }))
                    })
                    .transpose()?,
                resolve: Pipeline::compute(
                    gpu,
                    if config.surface_foam {
                        shader::WATER_THICKNESS_BEFORE_COMP
                    } else {
                        shader::WATER_THICKNESS_RESOLVE_COMP
                    },
                    &[],
                )?,
                sums: Self::sums(gpu, config)?,
            },
        };
        Ok(Self { path, image, sheets, level: config.thickness_level })
    }

    fn image(gpu: &Gpu, config: &Config) -> Result<Image, Error> {
        let one = vk::Format::R32_SFLOAT;
        let format = if config.surface_foam { vk::Format::R32G32_SFLOAT } else { one };
        Self::image_of(gpu, config, "water/thickness", format)
    }

    fn sheets(gpu: &Gpu, config: &Config) -> Result<Option<Image>, Error> {
        let format = vk::Format::R32G32B32A32_SFLOAT;
        (config.sheets > 1)
            .then(|| Self::image_of(gpu, config, "water/thickness/sheets", format))
            .transpose()
    }

    fn image_of(
        gpu: &Gpu,
        config: &Config,
        name: &str,
        format: vk::Format,
    ) -> Result<Image, Error> {
        Image::new(
            gpu,
            &ImageDesc::new(
                name,
                reduced(config.extent, config.thickness_level),
                format,
                vk::ImageUsageFlags::STORAGE
                    | vk::ImageUsageFlags::SAMPLED
                    | vk::ImageUsageFlags::COLOR_ATTACHMENT
                    | vk::ImageUsageFlags::TRANSFER_SRC,
            ),
        )
    }

    fn framebuffer(
        gpu: &Gpu,
        pass: vk::RenderPass,
        image: &Image,
        sheets: Option<&Image>,
    ) -> Result<Owned<vk::Framebuffer>, Error> {
        let views: Vec<_> = [Some(image), sheets].into_iter().flatten().map(|i| i.view).collect();
        gpu.framebuffer_of("water/thickness", pass, &views, image.extent)
    }

    fn sums(gpu: &Gpu, config: &Config) -> Result<Buffer, Error> {
        Buffer::new(
            gpu,
            "water/thickness/sums",
            sum_bytes(config),
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
        let sheets = Self::sheets(gpu, config)?;
        match &mut self.path {
            Path::Raster { pass, framebuffer, .. } => {
                let new = Self::framebuffer(gpu, *pass, &image, sheets.as_ref())?;
                retired.replace(framebuffer, new);
            }
            Path::Compute { sums, .. } => {
                let new = Self::sums(gpu, config)?;
                retired.replace(sums, new);
            }
        }
        retired.replace(&mut self.image, image);
        retired.replace(&mut self.sheets, sheets);
        Ok(())
    }

    /// Without boundaries there is one layer.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        list: &SphereList,
        gaps: Option<&Gaps>,
        foam: Option<&Foam>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"thickness");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let images: Vec<_> =
            [Some(&self.image), self.sheets.as_ref()].into_iter().flatten().collect();
        let hand = |from, to| -> Vec<_> {
            images.iter().map(|image| access::image(image, from, to)).collect()
        };
        // Without boundaries or foam these are not read, so any buffer or image can be bound.
        let boundaries =
            gaps.map_or(Resource::buffer(&list.counts), |gaps| Resource::buffer(&gaps.boundaries));
        // `surface_foam` uses the same path as this pass, so on the compute path it has words.
        let words = foam.and_then(Foam::words);
        let words = words.map_or(Resource::buffer(&list.counts), Resource::buffer);
        let foam = foam.map_or(r.scene_depth, |foam| {
            Resource::Sampled(foam.depth().view, gpu.samplers.nearest)
        });
        match &self.path {
            Path::Raster { points, quads, pass, framebuffer, prune } => {
                gpu.barriers(cmd, &hand(BEFORE.discarded(), COLOR_ATTACHMENT), &[]);
                let area = reduced(r.extent, self.level).into();
                gpu.begin_pass(cmd, *pass, framebuffer.handle, area, [0.0; 4]);
                draw_sprites(r, list, points, quads, &[(7, foam), (11, boundaries)])?;
                gpu.end_pass(cmd);
                if let (Some(prune), Some(sheets), Some(gaps)) = (prune, &self.sheets, gaps) {
                    gpu.barriers(
                        cmd,
                        &[
                            access::image(&self.image, COLOR_ATTACHMENT, COMPUTE_SAMPLED),
                            access::image(sheets, COLOR_ATTACHMENT, COMPUTE_READ_WRITE),
                        ],
                        &[],
                    );
                    let all = Resource::Sampled(self.image.view, gpu.samplers.nearest);
                    self.finish_sheets(r, prune, sheets, gaps, (4, all))?;
                    // The image is only read again; its barrier makes the next frame, which waits for fragment
                    // shaders, wait for this dispatch too.
                    gpu.barriers(
                        cmd,
                        &[
                            access::image(&self.image, COMPUTE_SAMPLED, FRAGMENT_SAMPLED),
                            access::image(sheets, COMPUTE_READ_WRITE, FRAGMENT_SAMPLED),
                        ],
                        &[],
                    );
                } else {
                    gpu.barriers(cmd, &hand(COLOR_ATTACHMENT, FRAGMENT_SAMPLED), &[]);
                }
            }
            Path::Compute { small, large, apart, resolve, sums } => {
                gpu.barriers(
                    cmd,
                    &hand(BEFORE.discarded(), COMPUTE_WRITE),
                    &[buffer(sums.handle, COMPUTE_READ, CLEAR)],
                );
                // SAFETY: cmd is recording outside a render pass.
                unsafe { gpu.device.cmd_fill_buffer(cmd, sums.handle, 0, vk::WHOLE_SIZE, 0) };
                gpu.barriers(cmd, &[], &[buffer(sums.handle, CLEAR, COMPUTE_READ_WRITE)]);
                let blocks = gaps.map_or(boundaries, |gaps| Resource::buffer(&gaps.blocks));
                let bound = [
                    (3, r.scene_depth),
                    (4, Resource::buffer(sums)),
                    (5, blocks),
                    (8, words),
                    (11, boundaries),
                ];
                dispatch_sprites(r, list, small, large, &bound)?;
                if let Some(apart) = apart {
                    let Apart { small, large, .. } = &**apart;
                    // These write sums of their own, so no barrier is needed.
                    dispatch_sprites(r, list, small, large, &bound)?;
                }
                gpu.barriers(cmd, &[], &[buffer(sums.handle, COMPUTE_READ_WRITE, COMPUTE_READ)]);
                r.descriptors.bind(
                    gpu,
                    cmd,
                    resolve,
                    &[
                        (0, r.uniforms),
                        (1, Resource::buffer(sums)),
                        (2, Resource::storage(&self.image)),
                        (7, foam),
                    ],
                )?;
                r.dispatch_over(reduced(r.extent, self.level), resolve.local_size);
                if let (Some(apart), Some(sheets), Some(gaps)) = (apart, &self.sheets, gaps) {
                    let sums = (1, Resource::buffer(sums));
                    self.finish_sheets(r, &apart.resolve, sheets, gaps, sums)?;
                }
                gpu.barriers(cmd, &hand(COMPUTE_WRITE, FRAGMENT_SAMPLED), &[]);
            }
        }
        r.end(scope);
        Ok(())
    }

    /// Completes the thickness of each layer from `input`, a binding and what it reads, and removes the boundaries in
    /// texels whose water is all of one layer.
    fn finish_sheets(
        &self,
        r: &mut Recording<'_>,
        pipeline: &Pipeline,
        sheets: &Image,
        gaps: &Gaps,
        input: (u32, Resource),
    ) -> Result<(), Error> {
        let (gpu, cmd, boundaries) = (r.gpu, r.cmd, gaps.boundaries.handle);
        gpu.barriers(cmd, &[], &[buffer(boundaries, gaps::READ, COMPUTE_READ_WRITE)]);
        let bound = [
            (0, r.uniforms),
            (2, Resource::storage(sheets)),
            (3, r.scene_depth),
            (11, Resource::buffer(&gaps.boundaries)),
            input,
        ];
        r.descriptors.bind(gpu, cmd, pipeline, &bound)?;
        r.dispatch_over(reduced(r.extent, self.level), pipeline.local_size);
        gpu.barriers(cmd, &[], &[buffer(boundaries, COMPUTE_READ_WRITE, gaps::READ)]);
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        match &self.path {
            Path::Raster { .. } => 0,
            Path::Compute { sums, .. } => sums.size,
        }
    }
}
