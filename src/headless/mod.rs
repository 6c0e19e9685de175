//! The library without a host: an own device, a scene to stand in, submits and read-back. For the
//! tool and for tests; an engine that embeds the library does not compile it.

mod device;
mod readback;
pub mod scene;

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;

pub use device::{Device, DeviceOptions};
pub use readback::Picture;
use scene::{Scene, SceneFrame, SceneRenderer};

use crate::contract::{
    Access, Camera, Config, Count, Frame, HostImage, Layer, ParticleCounts, Particles, Settings,
    Slot, Stream,
};
use crate::environment::{EnvironmentSource, Equirectangular, Sky};
use crate::error::{Error, VkContext};
use crate::gpu::Gpu;
use crate::gpu::access::{self, COPY_READ, COPY_WRITE};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Descriptors;
use crate::gpu::graveyard::Destroy;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::timing::Timing;
use crate::renderer::Renderer;

/// Output format: linear, scene-referred.
pub const COLOR_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
/// Depth of the stand-in scene.
pub const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// The scene's colour image between its own passes.
const COLOR_REST: Access = access::COLOR_ATTACHMENT;
/// The scene's depth image between its own passes.
const DEPTH_REST: Access = Access::new(
    vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::EARLY_FRAGMENT_TESTS.as_raw()
            | vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS.as_raw(),
    ),
    vk::AccessFlags2::from_raw(
        vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
);

/// Mapped memory read by the host.
const HOST_READ: Access = Access::new(
    vk::PipelineStageFlags2::HOST,
    vk::AccessFlags2::HOST_READ,
    vk::ImageLayout::GENERAL,
);

/// What became of the particles of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// On the screen.
    pub visible: u32,
    /// Of those, the ones that can show.
    pub front: u32,
    /// Dropped for NaN, infinite or huge positions.
    pub dropped: u32,
    /// Set aside as spray.
    pub spray: u32,
}

/// What stands behind the water.
pub enum Background<'a> {
    /// One colour, nothing in front of the far plane.
    Color([f32; 3]),
    /// The scene handed to [`Headless::scene`].
    Scene,
    /// Pictures from the CPU, row by row: linear RGBA and device depth.
    Images {
        /// width × height linear RGBA.
        color: &'a [[f32; 4]],
        /// width × height device depth.
        depth: &'a [f32],
    },
}

/// A renderer with everything a host would have, one frame at a time.
pub struct Headless {
    gpu: Arc<Gpu>,
    renderer: Renderer,
    color: Image,
    depth: Image,
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
    /// Command buffers for the parts of a frame that the host reads back in between.
    parts: Vec<vk::CommandBuffer>,
    positions: Option<Buffer>,
    densities: Option<Buffer>,
    count: u32,
    layers: Vec<Layer>,
    counts: Option<ParticleCounts>,
    scene: Option<Stage>,
    device: Device,
}

impl Headless {
    /// Makes the renderer. The output format and `in_place` of the configuration are replaced.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn new(device: Device, config: &Config) -> Result<Self, Error> {
        let config =
            Config { output_format: COLOR_FORMAT, in_place: true, keep_layers: true, ..*config };
        let host = device.host(1);
        let gpu = Gpu::new(&host)?;
        // SAFETY: the device is ours and outlives the renderer (field order, `drop`).
        let renderer = unsafe { Renderer::new(&host, &config) }?;
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(device.queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: valid create infos on a live device, here and below.
        let pool = unsafe { gpu.device.create_command_pool(&pool, None) }
            .context(|| "vkCreateCommandPool".into())?;
        let info =
            vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        // SAFETY: as above.
        let cmd = unsafe { gpu.device.allocate_command_buffers(&info) }
            .context(|| "vkAllocateCommandBuffers".into())?[0];
        // SAFETY: as above.
        let fence = unsafe { gpu.device.create_fence(&vk::FenceCreateInfo::default(), None) }
            .context(|| "vkCreateFence".into())?;
        let (color, depth) = Self::images(&gpu, config.extent)?;
        let mut headless = Self {
            gpu,
            renderer,
            color,
            depth,
            pool,
            cmd,
            fence,
            parts: Vec::new(),
            positions: None,
            densities: None,
            count: 0,
            layers: Vec::new(),
            counts: None,
            scene: None,
            device,
        };
        headless.run(|this, cmd| {
            // SAFETY: cmd is recording and submitted before any record.
            unsafe { this.renderer.record_setup(cmd) };
            this.gpu.barriers(
                cmd,
                &[
                    access::image(&this.color, access::NOTHING, COLOR_REST),
                    access::image(&this.depth, access::NOTHING, DEPTH_REST),
                ],
                &[],
            );
            Ok(())
        })?;
        headless.sky(&Sky::default())?;
        Ok(headless)
    }

    fn images(gpu: &Gpu, extent: vk::Extent2D) -> Result<(Image, Image), Error> {
        let usage = vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        let color = usage | vk::ImageUsageFlags::COLOR_ATTACHMENT;
        let depth = usage | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        Ok((
            Image::new(gpu, &ImageDesc::new("headless/color", extent, COLOR_FORMAT, color))?,
            Image::new(gpu, &ImageDesc::new("headless/depth", extent, DEPTH_FORMAT, depth))?,
        ))
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The renderer.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Fills a fresh command buffer, submits it and waits. `record` says which command buffer it
    /// ended with.
    fn run_parts(
        &mut self,
        record: impl FnOnce(&mut Self, vk::CommandBuffer) -> Result<vk::CommandBuffer, Error>,
    ) -> Result<(), Error> {
        // SAFETY: no command buffer of the pool is in use: every run waits for its end.
        unsafe {
            self.gpu
                .device
                .reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty())
                .context(|| "vkResetCommandPool".into())?;
        }
        begin(&self.gpu, self.cmd)?;
        let last = record(self, self.cmd)?;
        submit(&self.gpu, self.device.queue, last, self.fence)
    }

    /// The same for one command buffer.
    fn run(
        &mut self,
        record: impl FnOnce(&mut Self, vk::CommandBuffer) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.run_parts(|this, cmd| record(this, cmd).map(|()| cmd))
    }

    /// The built-in sky as environment.
    ///
    /// # Errors
    /// What Vulkan reports.
    pub fn sky(&mut self, sky: &Sky) -> Result<(), Error> {
        let source = EnvironmentSource::Sky(*sky);
        self.run(|this, cmd| {
            // SAFETY: cmd is recording; the slot's earlier work is done (every run waits).
            unsafe { this.renderer.record_environment(cmd, Slot(0), &source) }
        })
    }

    /// An equirectangular picture as environment: linear RGBA, row 0 up.
    ///
    /// # Errors
    /// No memory, and what Vulkan reports.
    pub fn equirectangular(
        &mut self,
        extent: vk::Extent2D,
        pixels: &[[f32; 4]],
        scale: f32,
        turn: f32,
    ) -> Result<(), Error> {
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let image =
            Image::new(&self.gpu, &ImageDesc::new("headless/equirect", extent, format, usage))?;
        let staging = self.staging(bytemuck::cast_slice(pixels))?;
        let result = self.run(|this, cmd| {
            this.upload(cmd, &staging, &image, access::NOTHING, COPY_WRITE);
            let host = HostImage {
                image: image.handle,
                view: image.view,
                format,
                aspect: vk::ImageAspectFlags::COLOR,
                extent,
                before: COPY_WRITE,
                after: access::COMPUTE_SAMPLED,
            };
            let source =
                EnvironmentSource::Equirectangular(Equirectangular { image: host, scale, turn });
            // SAFETY: as in `sky`.
            unsafe { this.renderer.record_environment(cmd, Slot(0), &source) }
        });
        staging.destroy(&self.gpu);
        image.destroy(&self.gpu);
        result
    }

    fn staging(&self, bytes: &[u8]) -> Result<Buffer, Error> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let size = bytes.len() as u64;
        let mut buffer =
            Buffer::new(&self.gpu, "headless/staging", size, usage, MemoryLocation::CpuToGpu)?;
        buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
        Ok(buffer)
    }

    /// Copies a staging buffer over a whole image.
    fn upload(
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
                aspect_mask: crate::gpu::image::aspect_of(to.format),
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

    /// The scene to stand behind the water, drawn by [`Background::Scene`]; `antialias`: four
    /// samples a pixel in its colour. Its light is baked: a new sun needs a new scene.
    ///
    /// # Errors
    /// No memory, and what Vulkan reports.
    pub fn scene(&mut self, scene: &Scene, antialias: bool) -> Result<(), Error> {
        if let Some(old) = self.scene.take() {
            old.renderer.destroy(&self.gpu);
        }
        let renderer = SceneRenderer::new(&self.gpu, scene, COLOR_FORMAT, DEPTH_FORMAT, antialias)?;
        let descriptors = Descriptors::new(&self.gpu, renderer.sets())?;
        self.scene = Some(Stage { renderer, descriptors });
        self.run(|this, cmd| {
            if let Some(stage) = &this.scene {
                stage.renderer.record_setup(&this.gpu, cmd);
            }
            Ok(())
        })?;
        if let Some(stage) = &mut self.scene {
            stage.renderer.finish_setup(&self.gpu);
        }
        Ok(())
    }

    fn draw_scene(&mut self, cmd: vk::CommandBuffer, camera: &Camera) -> Result<(), Error> {
        let Some(stage) = &mut self.scene else {
            return Err(Error::bad("Background::Scene", "no scene was handed in"));
        };
        stage.descriptors.reset(&self.gpu)?;
        let frame = SceneFrame {
            slot: Slot(0),
            descriptors: &stage.descriptors,
            camera,
            color: &self.color,
            depth: &self.depth,
            environment: self.renderer.environment_view(),
            sampler: self.gpu.samplers.linear,
        };
        stage.renderer.record(&self.gpu, cmd, &frame)
    }

    /// Uploads the particles of a frame.
    ///
    /// # Errors
    /// More than [`Config::max_particles`], densities of another length, no memory.
    pub fn particles(
        &mut self,
        positions: &[[f32; 3]],
        densities: Option<&[f32]>,
    ) -> Result<(), Error> {
        if densities.is_some_and(|d| d.len() != positions.len()) {
            return Err(Error::bad("densities", "not as many as positions"));
        }
        self.count = u32::try_from(positions.len())
            .map_err(|_| Error::bad("positions", "more than 2^32"))?;
        for old in [self.positions.take(), self.densities.take()].into_iter().flatten() {
            old.destroy(&self.gpu);
        }
        let make = |name, bytes: &[u8]| -> Result<Buffer, Error> {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            let size = bytes.len().max(16) as u64;
            let mut buffer = Buffer::new(&self.gpu, name, size, usage, MemoryLocation::CpuToGpu)?;
            buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
            Ok(buffer)
        };
        self.positions = Some(make("headless/positions", bytemuck::cast_slice(positions))?);
        if let Some(densities) = densities {
            self.densities = Some(make("headless/densities", bytemuck::cast_slice(densities))?);
        }
        Ok(())
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// As [`Renderer::record`].
    pub fn render(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
    ) -> Result<(), Error> {
        self.render_frame(camera, settings, background, false)
    }

    /// The same, with the smoothing ended by the host: it submits block by block and reads each
    /// query back, as the source does. For comparison only; needs
    /// [`Smoothing::Query`](crate::water::Smoothing::Query).
    ///
    /// # Errors
    /// As [`Renderer::record`].
    pub fn render_with_read_back(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
    ) -> Result<(), Error> {
        self.render_frame(camera, settings, background, true)
    }

    fn render_frame(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
        read_back: bool,
    ) -> Result<(), Error> {
        let Some(positions) = &self.positions else {
            return Err(Error::bad("particles", "none uploaded"));
        };
        let stream = |buffer: &Buffer, stride| Stream {
            buffer: buffer.handle,
            size: buffer.size,
            offset: 0,
            stride,
        };
        let host_write = Access::new(
            vk::PipelineStageFlags2::HOST,
            vk::AccessFlags2::HOST_WRITE,
            vk::ImageLayout::GENERAL,
        );
        let particles = Particles {
            positions: stream(positions, 12),
            densities: self.densities.as_ref().map(|buffer| stream(buffer, 4)),
            count: Count::Cpu(self.count),
            packets: None,
            before: host_write,
            after: host_write,
        };
        let image = |image: &Image, rest| HostImage {
            image: image.handle,
            view: image.view,
            format: image.format,
            aspect: crate::gpu::image::aspect_of(image.format),
            extent: image.extent,
            before: rest,
            after: rest,
        };
        let output = image(&self.color, COLOR_REST);
        let depth = image(&self.depth, DEPTH_REST);
        let staging = match background {
            Background::Images { color, depth } => {
                let half: Vec<[u16; 4]> =
                    color.iter().map(|c| c.map(|v| half::f16::from_f32(v).to_bits())).collect();
                Some((
                    self.staging(bytemuck::cast_slice(&half))?,
                    self.staging(bytemuck::cast_slice(depth))?,
                ))
            }
            Background::Color(_) | Background::Scene => None,
        };
        let result = self.run_parts(|this, cmd| {
            match (background, &staging) {
                (_, Some((color, depth))) => {
                    this.upload(cmd, color, &this.color, COLOR_REST, COLOR_REST);
                    this.upload(cmd, depth, &this.depth, DEPTH_REST, DEPTH_REST);
                }
                (Background::Color(color), None) => this.clear(cmd, *color, camera),
                (Background::Scene, None) => this.draw_scene(cmd, camera)?,
                _ => {}
            }
            let frame = Frame {
                slot: Slot(0),
                output,
                scene_color: output,
                scene_depth: depth,
                particles,
                camera: *camera,
                settings,
            };
            let mut parts = Parts {
                gpu: this.gpu.clone(),
                queue: this.device.queue,
                fence: this.fence,
                pool: this.pool,
                spare: std::mem::take(&mut this.parts),
                used: 0,
            };
            let mut stop = |cmd, pool, query| parts.read_back(cmd, pool, query);
            let stop: Option<crate::water::ReadBack<'_>> =
                if read_back { Some(&mut stop) } else { None };
            // SAFETY: cmd is recording outside a render pass; the slot's work is done.
            let result = unsafe { this.renderer.record_frame(cmd, &frame, stop) };
            this.parts = parts.spare;
            let (recorded, last) = result?;
            this.layers = recorded.layers;
            this.counts = recorded.counts;
            Ok(last)
        });
        if let Some((color, depth)) = staging {
            color.destroy(&self.gpu);
            depth.destroy(&self.gpu);
        }
        self.renderer.collect(Slot(0));
        result
    }

    fn clear(&self, cmd: vk::CommandBuffer, color: [f32; 3], camera: &Camera) {
        // The far plane's depth, whichever the convention: that which is farther from the near.
        let far = match crate::frame::Lens::new(camera) {
            Ok(lens)
                if lens.linear.0 / (1.0 + lens.linear.1) < 2.0 * lens.near
                    && lens.linear.0 / (1.0 + lens.linear.1) > 0.0 =>
            {
                0.0
            }
            _ => 1.0,
        };
        let range = |image: &Image| vk::ImageSubresourceRange {
            aspect_mask: crate::gpu::image::aspect_of(image.format),
            level_count: 1,
            layer_count: 1,
            ..Default::default()
        };
        let [r, g, b] = color;
        self.gpu.barriers(
            cmd,
            &[
                access::image(&self.color, COLOR_REST.discarded(), access::CLEAR),
                access::image(&self.depth, DEPTH_REST.discarded(), access::CLEAR),
            ],
            &[],
        );
        // SAFETY: both images are in TRANSFER_DST_OPTIMAL.
        unsafe {
            self.gpu.device.cmd_clear_color_image(
                cmd,
                self.color.handle,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &vk::ClearColorValue { float32: [r, g, b, 1.0] },
                &[range(&self.color)],
            );
            self.gpu.device.cmd_clear_depth_stencil_image(
                cmd,
                self.depth.handle,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &vk::ClearDepthStencilValue { depth: far, stencil: 0 },
                &[range(&self.depth)],
            );
        }
        self.gpu.barriers(
            cmd,
            &[
                access::image(&self.color, access::CLEAR, COLOR_REST),
                access::image(&self.depth, access::CLEAR, DEPTH_REST),
            ],
            &[],
        );
    }

    /// What became of the particles of the last frame.
    ///
    /// # Errors
    /// No memory, and what Vulkan reports.
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

    fn read_buffer(&mut self, from: vk::Buffer, size: u64) -> Result<Vec<u32>, Error> {
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let name = "headless/readback";
        let buffer = Buffer::new(&self.gpu, name, size, usage, MemoryLocation::GpuToCpu)?;
        let result = self.run(|this, cmd| {
            let used = access::COMPUTE_WRITE.and(access::INDIRECT);
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

    /// Times of the last frame, pass by pass.
    pub fn timings(&mut self) -> Vec<Timing> {
        self.renderer.timings(Slot(0)).to_vec()
    }

    /// The output of the last frame: linear RGBA.
    ///
    /// # Errors
    /// No memory, and what Vulkan reports.
    pub fn color(&mut self) -> Result<Picture<[f32; 4]>, Error> {
        let texels: Picture<[u16; 4]> =
            self.read(self.color.handle, COLOR_FORMAT, self.color.extent, COLOR_REST)?;
        Ok(texels.map(|c| c.map(|v| half::f16::from_bits(v).to_f32())))
    }

    /// Device depth of the scene.
    ///
    /// # Errors
    /// No memory, and what Vulkan reports.
    pub fn scene_depth(&mut self) -> Result<Picture<f32>, Error> {
        self.read(self.depth.handle, DEPTH_FORMAT, self.depth.extent, DEPTH_REST)
    }

    /// A layer of the last frame by its name; `None` when there is none of that name.
    ///
    /// # Errors
    /// No memory, and what Vulkan reports.
    pub fn layer(&mut self, name: &str) -> Result<Option<Picture<f32>>, Error> {
        let Some(layer) = self.layers.iter().find(|layer| layer.name == name).copied() else {
            return Ok(None);
        };
        if layer.format == vk::Format::R32_UINT {
            let plan: Picture<u32> =
                self.read(layer.image, layer.format, layer.extent, layer.access)?;
            // Iterations are the low nine bits of the plan.
            return Ok(Some(plan.map(|p| (p & 511) as f32)));
        }
        self.read(layer.image, layer.format, layer.extent, layer.access).map(Some)
    }

    /// Copies an image to the CPU; it is back in its state afterwards.
    fn read<T: bytemuck::AnyBitPattern>(
        &mut self,
        image: vk::Image,
        format: vk::Format,
        extent: vk::Extent2D,
        state: Access,
    ) -> Result<Picture<T>, Error> {
        let texels = u64::from(extent.width) * u64::from(extent.height);
        let buffer = Buffer::new(
            &self.gpu,
            "headless/readback",
            texels * size_of::<T>() as u64,
            vk::BufferUsageFlags::TRANSFER_DST,
            MemoryLocation::GpuToCpu,
        )?;
        let aspect = crate::gpu::image::aspect_of(format);
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

    /// Frees everything and gives the device back.
    ///
    /// # Errors
    /// Device loss.
    pub fn finish(self) -> Result<Device, Error> {
        let idle = self.device.wait_idle();
        let Self { gpu, renderer, color, depth, pool, fence, positions, densities, .. } = self;
        // SAFETY: the device is idle, or lost.
        unsafe {
            gpu.device.destroy_fence(fence, None);
            gpu.device.destroy_command_pool(pool, None);
            renderer.destroy();
        }
        drop((color, depth, positions, densities));
        if let Some(scene) = self.scene {
            scene.renderer.destroy(&gpu);
        }
        gpu.destroy();
        idle.map(|()| self.device)
    }
}

/// The stand-in scene with the sets of its frame.
struct Stage {
    renderer: SceneRenderer,
    descriptors: Descriptors,
}

fn begin(gpu: &Gpu, cmd: vk::CommandBuffer) -> Result<(), Error> {
    let info =
        vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
    // SAFETY: the command buffer is in its initial state.
    unsafe { gpu.device.begin_command_buffer(cmd, &info) }.context(|| "vkBeginCommandBuffer".into())
}

/// Ends a command buffer, submits it and waits for it.
fn submit(
    gpu: &Gpu,
    queue: vk::Queue,
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
) -> Result<(), Error> {
    let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(cmd)];
    let submits = [vk::SubmitInfo2::default().command_buffer_infos(&buffers)];
    let fences = [fence];
    let device = &gpu.device;
    // SAFETY: the command buffer is recording; the queue and the fence are used by one thread.
    unsafe {
        device.end_command_buffer(cmd).context(|| "vkEndCommandBuffer".into())?;
        device.queue_submit2(queue, &submits, fence).context(|| "vkQueueSubmit2".into())?;
        device.wait_for_fences(&fences, true, u64::MAX).context(|| "vkWaitForFences".into())?;
        device.reset_fences(&fences).context(|| "vkResetFences".into())
    }
}

/// The parts of a frame between which the host reads queries back.
struct Parts {
    gpu: Arc<Gpu>,
    queue: vk::Queue,
    fence: vk::Fence,
    pool: vk::CommandPool,
    spare: Vec<vk::CommandBuffer>,
    used: usize,
}

impl Parts {
    fn read_back(
        &mut self,
        cmd: vk::CommandBuffer,
        pool: vk::QueryPool,
        query: u32,
    ) -> Result<(vk::CommandBuffer, bool), Error> {
        submit(&self.gpu, self.queue, cmd, self.fence)?;
        let mut samples = [0u32];
        // SAFETY: the query was ended in the work that was just waited for.
        unsafe {
            self.gpu.device.get_query_pool_results(
                pool,
                query,
                &mut samples,
                vk::QueryResultFlags::WAIT,
            )
        }
        .context(|| "vkGetQueryPoolResults".into())?;
        if self.used == self.spare.len() {
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(self.pool)
                .command_buffer_count(1);
            // SAFETY: valid create info on a live device.
            let more = unsafe { self.gpu.device.allocate_command_buffers(&info) }
                .context(|| "vkAllocateCommandBuffers".into())?;
            self.spare.extend(more);
        }
        let next = self.spare[self.used];
        self.used += 1;
        begin(&self.gpu, next)?;
        Ok((next, samples[0] > 0))
    }
}
