//! Passes `film`, `impostor` and `core`: data that is precomputed once per renderer (Huszár, Szécsi, Sec. 3.1, 4.2 to
//! 4.4).
//!
//! Reads: in `impostor`, the bubbles of the blobs. Writes: in `film`, the table of the film's reflectance; in
//! `impostor`, the cube maps of the blobs (distance of the surface from the centre, or index of the bubble there); in
//! `core`, the texture of small bubbles on the blob's core.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::blob::Blob;
use super::settings::{BubbleConfig, FilmFresnel, Impostor, MOST_FILM, Spectrum};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COMPUTE_READ, COMPUTE_SAMPLED, COMPUTE_WRITE, FRAGMENT_READ, FRAGMENT_SAMPLED,
    buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource, bind_set};
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::random::pcg;

/// Size of the film's table: cosines by thicknesses.
const FILM: vk::Extent2D = vk::Extent2D { width: 64, height: 256 };
/// Side length of the core's texture without its border.
const CORE: u32 = 256;
/// Side length of the impostor map that is not used.
const UNUSED: u32 = 8;
/// Access of the later passes to the buffer of ids.
const READ: Access = COMPUTE_READ.and(FRAGMENT_READ);
/// Access of the later passes to the images.
const AFTER: Access = COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct FilmPush {
    index: f32,
    most: f32,
}
shader::assert_layout!(shader::BUBBLES_FILM_COMP, "Push", FilmPush { index, most });

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct ImpostorPush {
    count: u32,
    size: u32,
}
shader::assert_layout!(shader::BUBBLES_IMPOSTOR_COMP, "Push", ImpostorPush { count, size });

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct CorePush {
    size: u32,
    seed: u32,
}
shader::assert_layout!(shader::BUBBLES_CORE_COMP, "Push", CorePush { size, seed });

/// Precomputed data of the blobs.
pub struct Templates {
    film: Pipeline,
    impostors: [Pipeline; 2],
    core: Pipeline,
    config: BubbleConfig,
    /// Descriptor sets of the four pipelines, in the order of their dispatches. `_descriptors` owns their pool.
    sets: [vk::DescriptorSet; 4],
    _descriptors: Descriptors,
    /// Reflectance by cosine and thickness.
    pub table: Image,
    /// Centre and radius of each bubble of each blob.
    bubbles: Buffer,
    /// Neighbours that each bubble intersects.
    neighbours: Buffer,
    /// Impostor maps, of which one is used: the distance of the surface from the blob's centre, or the index of the
    /// outermost bubble, one byte per texel.
    distances: Image,
    ids: Buffer,
    /// Texture of small bubbles on the core.
    pub picture: Image,
}

impl Templates {
    pub fn new(gpu: &Gpu, config: &BubbleConfig) -> Result<Self, Error> {
        let blobs = (0..config.variants).map(|i| Blob::new(config.seed ^ pcg(i), config.bubbles));
        let blobs: Vec<Blob> = blobs.collect();
        let neighbours: Vec<_> = blobs.iter().flat_map(Blob::neighbours).collect();
        let bubbles: Vec<[f32; 4]> = blobs.into_iter().flat_map(|blob| blob.bubbles).collect();
        let filled = |name, bytes: &[u8]| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            let location = MemoryLocation::CpuToGpu;
            let mut buffer = Buffer::new(gpu, name, bytes.len() as u64, usage, location)?;
            buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
            Ok::<_, Error>(buffer)
        };
        let usage = vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC;
        let half = vk::Format::R16G16B16A16_SFLOAT;
        let [distances, ids] = Self::edges(config);
        let bytes = 6 * u64::from(config.variants) * u64::from(ids).pow(2);
        let extent = vk::Extent2D { width: distances, height: distances };
        // At least two variants, because an image with exactly six layers would become a cube map instead of an
        // array.
        let layers = 6 * config.variants.max(2);
        let name = "bubbles/distances";
        let map = ImageDesc::new(name, extent, vk::Format::R32_SFLOAT, usage);
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let kind = match config.film.fresnel {
            FilmFresnel::Exact => 0,
            FilmFresnel::Schlick => 1,
            FilmFresnel::Source => 2,
        };
        let spectral = u32::from(config.film.spectrum == Spectrum::Whole);
        let film = [(0, spectral), (1, kind)];
        let impostor =
            |ids| Pipeline::compute(gpu, shader::BUBBLES_IMPOSTOR_COMP, &[(0, u32::from(ids))]);
        let edge = vk::Extent2D { width: CORE + 2, height: CORE + 2 };
        let film = Pipeline::compute(gpu, shader::BUBBLES_FILM_COMP, &film)?;
        let impostors = [impostor(false)?, impostor(true)?];
        let core = Pipeline::compute(gpu, shader::BUBBLES_CORE_COMP, &[])?;
        let table = Image::new(gpu, &ImageDesc::new("bubbles/film", FILM, half, usage))?;
        let bubbles = filled("bubbles/bubbles", bytemuck::cast_slice(&bubbles))?;
        let distances = Image::new(gpu, &ImageDesc { layers, ..map })?;
        let ids = Buffer::new(gpu, "bubbles/ids", bytes, storage, MemoryLocation::GpuOnly)?;
        let picture = Image::new(gpu, &ImageDesc::new("bubbles/core", edge, half, usage))?;
        let descriptors = Descriptors::new(gpu, 4)?;
        let maps = [
            (0, Resource::storage(&distances)),
            (1, Resource::buffer(&ids)),
            (2, Resource::buffer(&bubbles)),
        ];
        let sets = [
            descriptors.set(gpu, &film, &[(0, Resource::storage(&table))])?,
            descriptors.set(gpu, &impostors[0], &maps)?,
            descriptors.set(gpu, &impostors[1], &maps)?,
            descriptors.set(gpu, &core, &[(0, Resource::storage(&picture))])?,
        ];
        Ok(Self {
            film,
            impostors,
            core,
            config: *config,
            sets,
            _descriptors: descriptors,
            table,
            bubbles,
            neighbours: filled("bubbles/neighbours", bytemuck::cast_slice(&neighbours))?,
            distances,
            ids,
            picture,
        })
    }

    /// Whether the data also fits another configuration.
    pub fn fits(&self, config: &BubbleConfig) -> bool {
        let BubbleConfig { max_blobs, layers, sort, steps, crossfade, .. } = *config;
        BubbleConfig { max_blobs, layers, sort, steps, crossfade, ..self.config } == *config
    }

    /// Side lengths of the faces of both maps.
    fn edges(config: &BubbleConfig) -> [u32; 2] {
        match config.impostor {
            Impostor::Distance => [config.map_size, UNUSED],
            Impostor::Ids => [UNUSED, config.map_size],
        }
    }

    /// Records the computation of all data, once.
    pub fn record_setup(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        gpu.begin_label(cmd, c"bubbles");
        let images = [&self.table, &self.distances, &self.picture];
        // If the data is computed again, earlier frames may have read it with the accesses AFTER and READ.
        let first = images.map(|image| access::image(image, AFTER.discarded(), COMPUTE_WRITE));
        gpu.barriers(cmd, &first, &[buffer(self.ids.handle, READ, COMPUTE_WRITE)]);
        let begin = |pipeline: &Pipeline, set: usize| {
            pipeline.bind(gpu, cmd);
            bind_set(gpu, cmd, pipeline, self.sets[set]);
        };
        let dispatch = |pipeline: &Pipeline, [width, height, layers]: [u32; 3]| {
            let [x, y, _] = pipeline.local_size;
            // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
            unsafe {
                gpu.device.cmd_dispatch(cmd, width.div_ceil(x), height.div_ceil(y), layers);
            }
        };
        begin(&self.film, 0);
        self.film.push(gpu, cmd, &FilmPush { index: self.config.film.index, most: MOST_FILM });
        dispatch(&self.film, [FILM.width, FILM.height, 1]);
        let edges = Self::edges(&self.config);
        for (i, (pipeline, size)) in self.impostors.iter().zip(edges).enumerate() {
            if i > 0 {
                // Each dispatch binds both maps and writes one of them.
                let maps = access::image(&self.distances, COMPUTE_WRITE, COMPUTE_WRITE);
                let ids = buffer(self.ids.handle, COMPUTE_WRITE, COMPUTE_WRITE);
                gpu.barriers(cmd, &[maps], &[ids]);
            }
            begin(pipeline, 1 + i);
            pipeline.push(gpu, cmd, &ImpostorPush { count: self.config.bubbles, size });
            dispatch(pipeline, [size, size, 6 * self.config.variants]);
        }
        begin(&self.core, 3);
        self.core.push(gpu, cmd, &CorePush { size: CORE, seed: self.config.seed });
        dispatch(&self.core, [CORE + 2, CORE + 2, 1]);
        let after = images.map(|image| access::image(image, COMPUTE_WRITE, AFTER));
        gpu.barriers(cmd, &after, &[buffer(self.ids.handle, COMPUTE_WRITE, READ)]);
        gpu.end_label(cmd);
    }

    /// Resources and constants of glsl/include/blob.glsl.
    pub fn resources(&self, gpu: &Gpu) -> [(u32, Resource); 4] {
        let distances = Resource::Sampled(self.distances.view, gpu.samplers.nearest);
        let [bubbles, ids, neighbours] =
            [&self.bubbles, &self.ids, &self.neighbours].map(Resource::buffer);
        [(8, bubbles), (9, distances), (10, ids), (13, neighbours)]
    }

    pub fn constants(config: &BubbleConfig) -> [(u32, u32); 4] {
        let by_id = u32::from(config.impostor == Impostor::Ids);
        [(30, by_id), (31, config.steps), (32, config.bubbles), (33, Self::edges(config)[1])]
    }

    /// Bytes of images and of buffers.
    pub fn memory(&self) -> (u64, u64) {
        let images = self.table.size + self.distances.size + self.picture.size;
        (images, self.bubbles.size + self.neighbours.size + self.ids.size)
    }
}
