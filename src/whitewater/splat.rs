//! Pass `splat`: depth and normal of the frontmost whitewater particle, and the thickness of all (Akinci et al.
//! 2013, Sec. 2.1 to 2.3; passes 3 to 5).
//!
//! The compute paths of pass `splat` run one invocation per particle and use integer atomics: depths are compared as
//! bits and sums use fixed-point steps, so the order of the particles does not matter. Depth and thickness are
//! written in one pass, so that a particle is read once for both. With 64-bit atomics, the attributes of the
//! frontmost particle are the low bits of a word whose high bits are its depth; with 32-bit atomics, a second pass
//! writes them. No list of projected particles is stored: for millions of particles it would take most of the memory.
//! `quads` is the alternative path, which rasterizes quads.
//! Reads: the host's streams, depths of water and scene. Writes: three images of the frame's size.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use crate::contract::{Config, WhitewaterParticles};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED,
    COMPUTE_WRITE, COPY_READ, FRAGMENT_READ, FRAGMENT_SAMPLED, INDIRECT, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::host_images::depth_layout;
use crate::water::Recording;
use crate::whitewater::quads::Quads;
use crate::whitewater::settings::{WhitewaterConfig, WhitewaterSplat};
use crate::whitewater::streams::{Chunks, Counting, Covering, buffers_of};

/// Bytes of a pixel's words (glsl/include/whitewater_words.glsl).
const WORDS: u64 = 32;

/// Bytes of all pixels' words.
pub fn word_bytes(extent: vk::Extent2D) -> u64 {
    WORDS * u64::from(extent.width) * u64::from(extent.height)
}

/// State of the images between frames, and after the pass.
pub const AFTER: Access = COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct BeginPush {
    fluid_at: [f32; 4],
    fluid_end: [i32; 2],
    counting: Counting,
}
shader::assert_layout!(shader::WHITEWATER_BEGIN_COMP, "Push", BeginPush { fluid_at, fluid_end });
const _: () = assert!(
    std::mem::offset_of!(BeginPush, counting)
        == shader::WHITEWATER_BEGIN_COMP.offset("Push", "count")
);

/// Size-dependent state.
struct Targets {
    words: Buffer,
    /// Foam depth, total intensity, depths of fluid and scene.
    occluders: Image,
    /// Image with three channels: foam thickness in front of the fluid's surface, behind it, and the latter weighted
    /// by `d / (d + spacing)` at the distance d behind the surface.
    thickness: Image,
    /// World normal of the frontmost particle, search radius.
    normal: Image,
}

impl Targets {
    fn new(gpu: &Gpu, config: &Config, way: WhitewaterSplat) -> Result<Self, Error> {
        use vk::ImageUsageFlags as Usage;
        let extent = config.extent;
        let image = |name, format, usage| {
            let usage = usage | Usage::SAMPLED | Usage::TRANSFER_SRC;
            Image::new(gpu, &ImageDesc::new(name, extent, format, usage))
        };
        let blended = way == WhitewaterSplat::Raster;
        let sums = if blended { Usage::COLOR_ATTACHMENT } else { Usage::STORAGE };
        let bytes = word_bytes(extent);
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let (full, half) = (vk::Format::R32G32B32A32_SFLOAT, vk::Format::R16G16B16A16_SFLOAT);
        Ok(Self {
            words: Buffer::new(
                gpu,
                "whitewater/splat/words",
                bytes,
                usage,
                MemoryLocation::GpuOnly,
            )?,
            occluders: image("whitewater/splat/occluders", full, Usage::STORAGE)?,
            thickness: image("whitewater/splat/thickness", full, sums)?,
            normal: image("whitewater/splat/normal", half, Usage::STORAGE)?,
        })
    }
}

/// Path of the splats.
enum Way {
    /// Dispatches over all particles, one after the other.
    Compute(Vec<Covering>),
    Quads(Box<Quads>),
}

/// The pass.
pub struct Sprites {
    begin: Pipeline,
    way: Way,
    resolve: Pipeline,
    arguments: Buffer,
    targets: Targets,
    chunks: Chunks,
}

/// The path that a configuration uses.
pub fn way(gpu: &Gpu, whitewater: &WhitewaterConfig) -> WhitewaterSplat {
    let fastest = if gpu.enabled.buffer_int64_atomics {
        WhitewaterSplat::Compute64
    } else {
        WhitewaterSplat::Compute
    };
    whitewater.splat.unwrap_or(fastest)
}

impl Sprites {
    pub fn new(gpu: &Gpu, config: &Config, whitewater: &WhitewaterConfig) -> Result<Self, Error> {
        let chunks = Chunks::new(&gpu.limits, whitewater);
        let chosen = way(gpu, whitewater);
        if chosen == WhitewaterSplat::Compute64 && !gpu.enabled.buffer_int64_atomics {
            return Err(Error::Missing {
                what: "shaderBufferInt64Atomics and shaderInt64".into(),
                why: "WhitewaterSplat::Compute64 needs them enabled; choose Compute".into(),
            });
        }
        let targets = Targets::new(gpu, config, chosen)?;
        let covering = |shader, constants: &[(u32, u32)]| {
            Covering::new(gpu, "whitewater/splat/large", shader, constants, whitewater)
        };
        let (way, resolve) = match chosen {
            WhitewaterSplat::Raster => {
                let quads = Quads::new(gpu, &targets.thickness)?;
                (Way::Quads(Box::new(quads)), shader::WHITEWATER_RESOLVE_QUADS_COMP)
            }
            WhitewaterSplat::Compute => {
                let [all, frontmost] =
                    [0, 1].map(|which| covering(shader::WHITEWATER_SPLAT_COMP, &[(0, which)]));
                (Way::Compute(vec![all?, frontmost?]), shader::WHITEWATER_RESOLVE_COMP)
            }
            WhitewaterSplat::Compute64 => {
                let all = covering(shader::WHITEWATER_SPLAT64_COMP, &[])?;
                (Way::Compute(vec![all]), shader::WHITEWATER_RESOLVE_COMP)
            }
        };
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::INDIRECT_BUFFER;
        let (name, bytes) = ("whitewater/splat/arguments", chunks.arguments());
        Ok(Self {
            begin: Pipeline::compute(gpu, shader::WHITEWATER_BEGIN_COMP, &[])?,
            way,
            resolve: Pipeline::compute(gpu, resolve, &[])?,
            arguments: Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)?,
            targets,
            chunks,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let way = match self.way {
            Way::Quads(_) => WhitewaterSplat::Raster,
            Way::Compute(_) => WhitewaterSplat::Compute,
        };
        let new = Targets::new(gpu, config, way)?;
        if let Way::Quads(quads) = &mut self.way {
            quads.resize(gpu, &new.thickness, retired)?;
        }
        let old = &mut self.targets;
        retired.replace(&mut old.words, new.words);
        retired.replace(&mut old.occluders, new.occluders);
        retired.replace(&mut old.thickness, new.thickness);
        retired.replace(&mut old.normal, new.normal);
        Ok(())
    }

    /// Foam depth, its intensity, depths of fluid and scene.
    pub fn occluders(&self) -> &Image {
        &self.targets.occluders
    }

    /// Returns the image with three channels: foam thickness in front of the fluid's surface, behind it, and the
    /// latter weighted by `d / (d + spacing)` at the distance d behind the surface.
    pub fn thickness(&self) -> &Image {
        &self.targets.thickness
    }

    /// Image: xyz is the world normal of the frontmost particle, w the search radius of its ambient occlusion.
    pub fn normal(&self) -> &Image {
        &self.targets.normal
    }

    /// Access to the host's streams.
    pub fn reading(&self) -> Access {
        match self.way {
            Way::Compute(_) => COMPUTE_READ,
            // Compute shaders read the count.
            Way::Quads(_) => COMPUTE_READ.and(VERTEX_READ),
        }
    }

    /// Records pass `splat`. `water` is the depth image of the water's frontmost spheres. It must be in the state in
    /// which pass `depth` leaves it, and is in the same state after pass `splat`.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: Option<&WhitewaterParticles>,
        water: &Image,
    ) -> Result<(), Error> {
        let scope = r.begin(c"splat");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (words, arguments) = (self.targets.words.handle, self.arguments.handle);
        // The compute path uses the buffer as dispatch arguments, and its shaders read the number of particles from
        // it.
        let (words_used, arguments_used) = match self.way {
            Way::Compute(_) => (COMPUTE_READ_WRITE, INDIRECT.and(COMPUTE_READ)),
            Way::Quads(_) => (FRAGMENT_READ.and(COMPUTE_READ), INDIRECT),
        };
        let mut before = vec![
            buffer(words, words_used, COMPUTE_WRITE),
            buffer(arguments, arguments_used, COMPUTE_WRITE),
        ];
        if let Some(particles) = particles {
            let host = buffers_of(particles).into_iter();
            before.extend(host.map(|handle| buffer(handle, particles.before, self.reading())));
        }
        let both = COMPUTE_READ_WRITE;
        gpu.barriers(cmd, &[access::image(water, both, COMPUTE_SAMPLED)], &before);
        self.record_begin(r, particles, water)?;
        gpu.barriers(
            cmd,
            &[access::image(water, COMPUTE_SAMPLED, both)],
            &[
                buffer(words, COMPUTE_WRITE, words_used),
                buffer(arguments, COMPUTE_WRITE, arguments_used),
            ],
        );
        match &self.way {
            Way::Compute(goes) => self.record_compute(r, goes, particles)?,
            Way::Quads(quads) => self.record_quads(r, quads, particles)?,
        }
        r.end(scope);
        Ok(())
    }

    fn record_compute(
        &self,
        r: &Recording<'_>,
        goes: &[Covering],
        particles: Option<&WhitewaterParticles>,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let Targets { words, occluders, thickness, normal } = &self.targets;
        let both = COMPUTE_READ_WRITE;
        if let Some(particles) = particles {
            for (i, go) in goes.iter().enumerate() {
                if i > 0 {
                    gpu.barriers(cmd, &[], &[buffer(words.handle, both, both)]);
                }
                let own = [(6, Resource::buffer(words)), (7, Resource::buffer(&self.arguments))];
                let arguments = self.arguments.handle;
                go.record(r, &self.chunks, &own, particles, arguments, |places| places)?;
            }
        }
        let images = [occluders, thickness, normal];
        let hand = |from: Access, to| images.map(|image| access::image(image, from, to));
        gpu.barriers(
            cmd,
            &hand(AFTER.and(COPY_READ).discarded(), COMPUTE_WRITE),
            &[buffer(words.handle, both, COMPUTE_READ)],
        );
        let resources = [
            (0, r.uniforms),
            (1, Resource::buffer(words)),
            (2, Resource::storage(occluders)),
            (3, Resource::storage(thickness)),
            (4, Resource::storage(normal)),
        ];
        r.descriptors.bind(gpu, cmd, &self.resolve, &resources)?;
        r.dispatch_over(r.extent, self.resolve.local_size);
        gpu.barriers(cmd, &hand(COMPUTE_WRITE, AFTER), &[]);
        Ok(())
    }

    fn record_quads(
        &self,
        r: &Recording<'_>,
        quads: &Quads,
        particles: Option<&WhitewaterParticles>,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let Targets { words, occluders, thickness, normal } = &self.targets;
        let last = AFTER.and(COPY_READ).discarded();
        quads.record(r, access::image(thickness, last, COLOR_ATTACHMENT), |pipeline| {
            let Some(particles) = particles else { return Ok(()) };
            let own = [(6, Resource::buffer(words))];
            self.chunks.each(
                r,
                pipeline,
                &own,
                particles,
                |places| places,
                |chunk| {
                    let arguments = self.arguments.handle;
                    // SAFETY: inside a render pass; the arguments are visible since `begin`.
                    unsafe { gpu.device.cmd_draw_indirect(cmd, arguments, 16 * chunk, 1, 16) };
                },
            )
        })?;
        let written = [occluders, normal];
        let hand = |from: Access, to| written.map(|image| access::image(image, from, to));
        let drawn = [
            access::image(thickness, COLOR_ATTACHMENT, AFTER),
            access::image(quads.fronts(), COLOR_ATTACHMENT, COMPUTE_SAMPLED),
        ];
        gpu.barriers(cmd, &[&hand(last, COMPUTE_WRITE)[..], &drawn].concat(), &[]);
        let sampled = |image: &Image| Resource::Sampled(image.view, gpu.samplers.nearest);
        let resources = [
            (0, r.uniforms),
            (1, Resource::buffer(words)),
            (2, Resource::storage(occluders)),
            (3, sampled(thickness)),
            (4, Resource::storage(normal)),
            (5, sampled(quads.fronts())),
        ];
        r.descriptors.bind(gpu, cmd, &self.resolve, &resources)?;
        r.dispatch_over(r.extent, self.resolve.local_size);
        gpu.barriers(cmd, &hand(COMPUTE_WRITE, AFTER), &[]);
        Ok(())
    }

    fn record_begin(
        &self,
        r: &Recording<'_>,
        particles: Option<&WhitewaterParticles>,
        water: &Image,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let group_size = match &self.way {
            Way::Compute(goes) => goes[0].group_size(),
            Way::Quads(_) => 0,
        };
        let unread = Resource::buffer(&self.targets.words);
        let (counting, host_count) = self.chunks.counting(particles, group_size, unread);
        let fluid = particles.and_then(|particles| particles.fluid_depth.as_ref());
        let fluid_at = fluid.map_or([0.0; 4], |image| {
            let vk::Rect2D { offset, extent } = image.rect;
            let width = extent.width as f32 / r.extent.width as f32;
            let height = extent.height as f32 / r.extent.height as f32;
            [width, height, offset.x as f32, offset.y as f32]
        });
        let fluid_end = fluid.map_or([0; 2], |image| {
            let vk::Rect2D { offset, extent } = image.rect;
            [offset.x + extent.width as i32, offset.y + extent.height as i32]
        });
        let resources = [
            (0, r.uniforms),
            (1, Resource::buffer(&self.targets.words)),
            (2, r.scene_depth),
            (3, Resource::Sampled(water.view, gpu.samplers.nearest)),
            (4, host_count),
            (5, Resource::buffer(&self.arguments)),
            // Without water this is not read.
            (
                6,
                fluid.map_or(r.scene_depth, |image| {
                    let layout = depth_layout(image);
                    Resource::SampledIn(image.view, gpu.samplers.nearest, layout)
                }),
            ),
        ];
        r.descriptors.bind(gpu, cmd, &self.begin, &resources)?;
        self.begin.push(gpu, cmd, &BeginPush { fluid_at, fluid_end, counting });
        // At least one invocation per chunk.
        let extent = vk::Extent2D { width: r.extent.width.max(self.chunks.count), ..r.extent };
        r.dispatch_over(extent, self.begin.local_size);
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        let Targets { words, occluders, thickness, normal } = &self.targets;
        let mut images = [occluders, thickness, normal].map(|image| image.size).iter().sum();
        let mut buffers = words.size + self.arguments.size;
        match &self.way {
            Way::Quads(quads) => images += quads.memory(),
            Way::Compute(goes) => buffers += goes.iter().map(Covering::memory).sum::<u64>(),
        }
        (images, buffers)
    }
}
