//! Pass `surface_foam`: depth and thickness of surface foam (thesis Sec. 3.2, 4.6.2 and 4.8).
//!
//! Particles with foam are drawn as sprites stretched along their motion. Slow sprites, and those that move along the
//! view, change smoothly to discs (the thesis switches between the two, which pops). The intersection of a ray with a
//! sprite's plane is exact. Thickness is in scene units, as that of the water: the fraction of a particle that is foam
//! is subtracted from its water.
//!
//! Nothing pops or flickers: the sprite of a particle in the depth image has its full size before its foam becomes
//! visible; no sprite is narrower than a texel can represent; noise finer than texels fades out; the front layer (the
//! foam right behind the frontmost foam) ends softly, and so do sprites that sink into the scene.
//!
//! Depth and thickness have the same resolution, by default a quarter of the frame's width and height (in the thesis
//! the depth has full resolution). What is visible of foam is its thickness; a finer depth would only have more
//! fragments, most of which fail the depth test. The outlines of foam are those of its thickness, which ends softly.
//! The outlines of the scene in front of foam are resolved per pixel (glsl/include/surface_foam_texels.glsl).
//!
//! There are two paths, as for the water's thickness: blended quads, and compute invocations with integer atomics.
//! The compute path saves time in three ways: it has no triangle set-up, which for sprites of few texels costs as
//! much as their fragments; it rejects a fragment behind the nearest depth by one read; and it sums foam behind the
//! front layer, of which there usually is none, separately. Both paths sum whole fixed-point steps, so the order does
//! not matter. The foam's velocity is summed in three coarse grids on the screen; it carries the lace pattern along.
//!
//! Spray is not foam: as a particle's density falls, its foam fades out and pass `spray` draws droplets instead.
//! Reads: the counts of `cull`, the host's particles, scene depth. Writes: foam depth, R32F, EMPTY where there is
//! none; foam thickness, RGBA32F, in scene units: the total, the front layer (right behind the frontmost foam), the
//! sunlit part of that layer (per sprite; a mask applies per pixel), and the total weighted by `d / (d + s)`, with s
//! one spacing and d the distance behind the point one spacing behind the frontmost foam.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::Recording;
use super::cull::{self, SphereList};
use super::depth::DEFAULT_SPLAT;
use super::settings::{Shadows, Splat};
use super::sprites::{Over, Sprites};
use crate::contract::{Config, Particles};
use crate::error::Error;
use crate::frame::{EMPTY, reduced};
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COLOR_ATTACHMENT, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED,
    COMPUTE_WRITE, COPY_READ, FRAGMENT_READ, FRAGMENT_SAMPLED, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;

/// Bytes of a sprite.
pub const SPRITE: u64 = 64;

/// Both images are read by compute (`reduce`) and by shading passes.
pub const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
/// Shading passes read the foam's velocity.
const DRIFT_READ: Access = COMPUTE_READ.and(FRAGMENT_READ);
/// Last uses of the images of foam depth and thickness in a frame, for which the next frame waits: those of
/// [`AFTER`], or a copy of the layer by the host.
const BEFORE: Access = AFTER.and(COPY_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    position_word: u32,
    position_stride: u32,
    amount_word: u32,
    amount_stride: u32,
    velocity_word: u32,
    velocity_stride: u32,
    id_word: u32,
    id_stride: u32,
    density_word: u32,
    density_stride: u32,
    chunk_first: u32,
    packets: u32,
}
shader::assert_layout!(
    shader::WATER_SURFACE_FOAM_LIST_COMP,
    "Push",
    Push {
        position_word,
        position_stride,
        amount_word,
        amount_stride,
        velocity_word,
        velocity_stride,
        id_word,
        id_stride,
        density_word,
        density_stride,
        chunk_first,
        packets,
    }
);

/// Content of an image.
#[derive(Clone, Copy)]
enum Kind {
    Depth,
    Thickness,
}

fn desc(config: &Config, kind: Kind) -> ImageDesc<'static> {
    let (name, format) = match kind {
        Kind::Depth => ("water/surface_foam/depth", vk::Format::R32_SFLOAT),
        Kind::Thickness => ("water/surface_foam/thickness", vk::Format::R32G32B32A32_SFLOAT),
    };
    let usage = vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::STORAGE
        | vk::ImageUsageFlags::COLOR_ATTACHMENT
        | vk::ImageUsageFlags::TRANSFER_SRC;
    ImageDesc::new(name, reduced(config.extent, config.thickness_level), format, usage)
}

/// An image and the pipeline that blends sprites into it.
struct Blended {
    target: Target,
    pipeline: Pipeline,
}

impl Blended {
    fn new(gpu: &Gpu, config: &Config, kind: Kind) -> Result<Self, Error> {
        let (fragment, thick, op) = match kind {
            Kind::Depth => (shader::WATER_SURFACE_FOAM_DEPTH_FRAG, 0, vk::BlendOp::MIN),
            Kind::Thickness => (shader::WATER_SURFACE_FOAM_THICKNESS_FRAG, 1, vk::BlendOp::ADD),
        };
        let target = Target::new(gpu, &desc(config, kind), vk::AttachmentLoadOp::CLEAR)?;
        let pipeline = Pipeline::graphics(
            gpu,
            &Graphics {
                vertex: shader::WATER_SURFACE_FOAM_VERT,
                fragment,
                topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                pass: target.pass,
                blend: &[blend(op)],
                constants: &[(0, thick)],
            },
        )?;
        Ok(Self { target, pipeline })
    }

    /// Clears the image, and blends all sprites into it, if there are any.
    fn record(
        &self,
        r: &mut Recording<'_>,
        foam: &Foam,
        list: &SphereList,
        clear: f32,
        any: bool,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let to = COLOR_ATTACHMENT;
        gpu.barriers(cmd, &[access::image(&self.target.image, BEFORE.discarded(), to)], &[]);
        let area = reduced(r.extent, foam.level).into();
        let clear = [clear, 0.0, 0.0, 0.0];
        self.target.begin(gpu, cmd, area, clear);
        if any {
            let more = [
                (2, r.scene_depth),
                (3, Resource::Sampled(foam.depth().view, gpu.samplers.nearest)),
            ];
            foam.sprites.draw(r, list, &self.pipeline, cull::FOAM, &more)?;
        }
        gpu.end_pass(cmd);
        gpu.barriers(cmd, &[access::image(&self.target.image, COLOR_ATTACHMENT, AFTER)], &[]);
        Ok(())
    }
}

/// Whether each foam sprite stores how much of the sun it sees: with a light map or the host's shadow map. A shadow
/// mask over the screen does not need this, because it is applied per pixel.
fn lit(config: &Config) -> bool {
    config.light_map_size.is_some() || !matches!(config.shadow, None | Some(Shadows::Mask))
}

/// Number of words per texel of the compute path. The first word is the depth of the frontmost foam, or of the scene
/// if no foam is in front of it; the second is the depth of the scene (both as the bits of a float). The others are
/// sums.
pub fn words_of(config: &Config) -> u32 {
    if lit(config) { 6 } else { 5 }
}

/// Bytes of all words.
pub fn word_bytes(config: &Config) -> u64 {
    let size = reduced(config.extent, config.thickness_level);
    4 * u64::from(words_of(config)) * u64::from(size.width) * u64::from(size.height)
}

/// State of the compute path.
struct Splats {
    /// Pipelines of depth and thickness.
    each: [Pipeline; 2],
    begin: Pipeline,
    resolve: Pipeline,
    depth: Image,
    thickness: Image,
    /// Depths of foam and scene and fixed-point sums of all thicknesses, per texel.
    words: Buffer,
}

impl Splats {
    fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let lit = (1, u32::from(lit(config)));
        let each =
            |thick| Pipeline::compute(gpu, shader::WATER_SURFACE_FOAM_COMP, &[(0, thick), lit]);
        let (depth, thickness, words) = Self::sized(gpu, config)?;
        Ok(Self {
            each: [each(0)?, each(1)?],
            begin: Pipeline::compute(gpu, shader::WATER_SURFACE_FOAM_BEGIN_COMP, &[lit])?,
            resolve: Pipeline::compute(gpu, shader::WATER_SURFACE_FOAM_RESOLVE_COMP, &[lit])?,
            depth,
            thickness,
            words,
        })
    }

    fn sized(gpu: &Gpu, config: &Config) -> Result<(Image, Image, Buffer), Error> {
        let image = |kind| Image::new(gpu, &desc(config, kind));
        let (depth, thickness) = (image(Kind::Depth)?, image(Kind::Thickness)?);
        let (bytes, usage) = (word_bytes(config), vk::BufferUsageFlags::STORAGE_BUFFER);
        let words =
            Buffer::new(gpu, "water/surface_foam/words", bytes, usage, MemoryLocation::GpuOnly)?;
        Ok((depth, thickness, words))
    }

    fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let (depth, thickness, words) = Self::sized(gpu, config)?;
        retired.replace(&mut self.depth, depth);
        retired.replace(&mut self.thickness, thickness);
        retired.replace(&mut self.words, words);
        Ok(())
    }

    fn record(
        &self,
        r: &mut Recording<'_>,
        foam: &Foam,
        list: &SphereList,
        any: bool,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (depth, thickness, words) = (&self.depth, &self.thickness, self.words.handle);
        let extent = reduced(r.extent, foam.level);
        gpu.barriers(cmd, &[], &[buffer(words, COMPUTE_READ, COMPUTE_WRITE)]);
        let resources = [(0, r.uniforms), (1, Resource::buffer(&self.words)), (2, r.scene_depth)];
        r.descriptors.bind(gpu, cmd, &self.begin, &resources)?;
        r.dispatch_over(extent, self.begin.local_size);
        let both = COMPUTE_READ_WRITE;
        if any {
            gpu.barriers(cmd, &[], &[buffer(words, COMPUTE_WRITE, both)]);
            let [each_depth, each_thickness] = &self.each;
            let more = [(5, Resource::buffer(&self.words))];
            foam.sprites.splat(r, list, each_depth, cull::FOAM_GROUPS, &more)?;
            gpu.barriers(cmd, &[], &[buffer(words, both, both)]);
            foam.sprites.splat(r, list, each_thickness, cull::FOAM_GROUPS, &more)?;
        }
        let images = [depth, thickness];
        gpu.barriers(
            cmd,
            &images.map(|image| access::image(image, BEFORE.discarded(), COMPUTE_WRITE)),
            &[buffer(words, both, COMPUTE_READ)],
        );
        let resources = [
            (0, r.uniforms),
            (1, Resource::buffer(&self.words)),
            (2, Resource::storage(thickness)),
            (3, Resource::storage(depth)),
        ];
        r.descriptors.bind(gpu, cmd, &self.resolve, &resources)?;
        r.dispatch_over(extent, self.resolve.local_size);
        gpu.barriers(cmd, &images.map(|image| access::image(image, COMPUTE_WRITE, AFTER)), &[]);
        Ok(())
    }
}

enum Path {
    /// Depth and thickness.
    Raster(Box<[Blended; 2]>),
    Compute(Box<Splats>),
}

/// Pixels between the nodes of each velocity grid, and words per node (glsl/include/surface_foam_drift.glsl).
const DRIFT_CELLS: [u32; 3] = [16, 64, 256];
const DRIFT_WORDS: u64 = 4;

/// The velocity grids for an extent, finest first.
fn drift(gpu: &Gpu, config: &Config) -> Result<Buffer, Error> {
    let vk::Extent2D { width, height } = config.extent;
    let nodes = |cell| [width, height].map(|pixels| u64::from(pixels.div_ceil(cell) + 1));
    let all = DRIFT_CELLS.map(|cell| nodes(cell).iter().product::<u64>());
    let bytes = 4 * DRIFT_WORDS * all.iter().sum::<u64>();
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
    Buffer::new(gpu, "water/surface_foam/drift", bytes, usage, MemoryLocation::GpuOnly)
}

/// The pass.
pub struct Foam {
    sprites: Sprites,
    drifting: Pipeline,
    drift: Buffer,
    path: Path,
    /// Number of halvings of the resolution of both images.
    pub level: u32,
}

impl Foam {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let list = (shader::WATER_SURFACE_FOAM_LIST_COMP, &crate::light::constants(config)[..]);
        let sprites =
            |read| Sprites::new(gpu, config, "water/surface_foam/sprites", SPRITE, list, read);
        let (sprites, path) = match config.thickness_splat.unwrap_or(DEFAULT_SPLAT) {
            Splat::Raster => {
                let depth = Blended::new(gpu, config, Kind::Depth)?;
                let thickness = Blended::new(gpu, config, Kind::Thickness)?;
                (
                    sprites(VERTEX_READ.and(COMPUTE_READ))?,
                    Path::Raster(Box::new([depth, thickness])),
                )
            }
            Splat::Compute => {
                let splats = Box::new(Splats::new(gpu, config)?);
                (sprites(COMPUTE_READ)?, Path::Compute(splats))
            }
        };
        let drifting = Pipeline::compute(gpu, shader::WATER_SURFACE_FOAM_DRIFT_COMP, &[])?;
        let drift = drift(gpu, config)?;
        Ok(Self { sprites, drifting, drift, path, level: config.thickness_level })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        retired.replace(&mut self.drift, drift(gpu, config)?);
        match &mut self.path {
            Path::Raster(both) => {
                let [depth, thickness] = &mut **both;
                depth.target.resize(gpu, &desc(config, Kind::Depth), retired)?;
                thickness.target.resize(gpu, &desc(config, Kind::Thickness), retired)
            }
            Path::Compute(splats) => splats.resize(gpu, config, retired),
        }
    }

    /// Eye depth of the frontmost foam.
    pub fn depth(&self) -> &Image {
        match &self.path {
            Path::Raster(both) => &both[0].target.image,
            Path::Compute(splats) => &splats.depth,
        }
    }

    /// The buffer with [`words_of`] words per texel, which compute shaders can read after the pass; `None` on the
    /// raster path.
    pub fn words(&self) -> Option<&Buffer> {
        match &self.path {
            Path::Raster(_) => None,
            Path::Compute(splats) => Some(&splats.words),
        }
    }

    /// Velocity grids, in the state [`DRIFT_READ`] after the pass.
    pub fn drift(&self) -> &Buffer {
        &self.drift
    }

    /// Thickness of the foam along z, in scene units.
    pub fn thickness(&self) -> &Image {
        match &self.path {
            Path::Raster(both) => &both[1].target.image,
            Path::Compute(splats) => &splats.thickness,
        }
    }

    /// `list` is the one of `cull`, read for its counts.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
    ) -> Result<(), Error> {
        let scope = r.begin(c"surface_foam");
        let any = particles.surface_foam.is_some();
        if any {
            let streams = [
                &particles.surface_foam,
                &particles.velocities,
                &particles.ids,
                &particles.densities,
            ];
            let over = Over { particles, streams, binding: 1 };
            let sunlight = r.sunlight.resources();
            self.sprites.record(r, list, &over, &sunlight, |chunk_first, positions, streams| {
                let [amounts, velocities, ids, densities] = streams;
                Push {
                    position_word: positions.word,
                    position_stride: positions.stride,
                    amount_word: amounts.word,
                    amount_stride: amounts.stride,
                    velocity_word: velocities.word,
                    velocity_stride: velocities.stride,
                    id_word: ids.word,
                    id_stride: ids.stride,
                    density_word: densities.word,
                    density_stride: densities.stride,
                    chunk_first,
                    packets: u32::from(particles.packets.is_some()),
                }
            })?;
        }
        self.record_drift(r, list, any)?;
        match &self.path {
            Path::Raster(both) => {
                let [depth, thickness] = &**both;
                depth.record(r, self, list, EMPTY, any)?;
                thickness.record(r, self, list, 0.0, any)?;
            }
            Path::Compute(splats) => splats.record(r, self, list, any)?,
        }
        r.end(scope);
        Ok(())
    }

    fn record_drift(
        &self,
        r: &mut Recording<'_>,
        list: &SphereList,
        any: bool,
    ) -> Result<(), Error> {
        let (gpu, cmd, drift) = (r.gpu, r.cmd, self.drift.handle);
        gpu.barriers(cmd, &[], &[buffer(drift, DRIFT_READ, CLEAR)]);
        // SAFETY: a buffer that may be copied to, outside a render pass.
        unsafe { gpu.device.cmd_fill_buffer(cmd, drift, 0, vk::WHOLE_SIZE, 0) };
        if any {
            gpu.barriers(cmd, &[], &[buffer(drift, CLEAR, COMPUTE_READ_WRITE)]);
            let more = [(5, Resource::buffer(&self.drift))];
            self.sprites.splat(r, list, &self.drifting, cull::FOAM_GROUPS, &more)?;
        }
        let last = if any { COMPUTE_READ_WRITE } else { CLEAR };
        gpu.barriers(cmd, &[], &[buffer(drift, last, DRIFT_READ)]);
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        let words = match &self.path {
            Path::Raster(_) => 0,
            Path::Compute(splats) => splats.words.size,
        };
        (self.depth().size + self.thickness().size, self.sprites.memory() + self.drift.size + words)
    }
}

#[cfg(test)]
mod tests {
    use super::DRIFT_CELLS;

    #[test]
    fn the_velocity_grids_are_those_of_the_shaders() {
        let shader = include_str!("../../glsl/include/surface_foam_drift.glsl");
        let number = |name: &str| {
            let (_, after) = shader.split_once(&format!("{name} = ")).expect(name);
            let (number, _) = after.split_once(';').expect(name);
            number.parse::<f32>().expect(name)
        };
        let [cell, ratio] = ["DRIFT_CELL", "DRIFT_RATIO"].map(number);
        let grids = number("DRIFT_GRIDS") as i32;
        let cells: Vec<u32> = (0..grids).map(|k| (cell * ratio.powi(k)) as u32).collect();
        assert_eq!(cells, DRIFT_CELLS);
    }
}
