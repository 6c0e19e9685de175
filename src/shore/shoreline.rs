//! Pass `shoreline`: foam on the host's water surface, along shores (*Semi-procedural foam shader*) and round what stands in
//! it (Lettier, Foam).
//!
//! What a pixel's foam is comes of its place on the surface alone: it needs the scene's depth and no mesh. Tiles that may
//! have some are found first; a strip of the host's is drawn before them.
//! Reads: scene depth, the surface's, the map of distances, the strip, web, noise, mask. Writes: foam, RGBA8: along shores,
//! at contacts, what of the sun's light does not come there, 0 (`contact`'s).

use ash::vk;
use bytemuck::NoUninit;
use gpu_allocator::MemoryLocation;

use super::Given;
use super::settings::{Edge, ShoreConfig};
use super::textures::Textures;
use crate::contract::{Config, Strip};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COLOR_ATTACHMENT, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED,
    COPY_READ, COPY_WRITE, FRAGMENT_SAMPLED, INDIRECT, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;
use crate::water::{Recording, Window};

/// Read by what shades.
pub const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
/// Edge of a tile in pixels (glsl/shore/tiles.comp).
const TILE: u32 = 16;
/// Lists of tiles: with shoreline foam, with contact foam, with both, with any.
const LISTS: u32 = 4;
/// A quad's draw of no tiles; dispatches over none and how many they are.
const NO_TILES: [u32; 16] = [4, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0];
/// How the list and the arguments are read, here and by `composite`.
const READ: Access = COMPUTE_READ.and(VERTEX_READ).and(INDIRECT);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    position_word: u32,
    position_stride: u32,
    v_word: u32,
    v_stride: u32,
    index_word: u32,
    index_stride: u32,
    vertices: u32,
}
shader::assert_layout!(
    shader::SHORE_STRIP_VERT,
    "Push",
    Push { position_word, position_stride, v_word, v_stride, index_word, index_stride, vertices }
);

/// Tiles of an extent.
fn tiles(extent: vk::Extent2D) -> [u32; 2] {
    [extent.width.div_ceil(TILE), extent.height.div_ceil(TILE)]
}

/// Of each tile whether it may have foam; which have.
struct Lists {
    /// Tiles of a list.
    most: u32,
    marks: Buffer,
    list: Buffer,
}

impl Lists {
    fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let [x, y] = tiles(config.extent);
        let words = |name, each: u32| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
            let bytes = 4 * u64::from(each * x * y);
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        Ok(Self { most: x * y, marks: words("shore/marks", 1)?, list: words("shore/list", LISTS)? })
    }
}

fn desc(config: &Config) -> ImageDesc<'static> {
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT
        | vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::STORAGE
        | vk::ImageUsageFlags::TRANSFER_SRC
        | vk::ImageUsageFlags::TRANSFER_DST;
    // Every device stores to it.
    ImageDesc::new("shore/foam", config.extent, vk::Format::R8G8B8A8_UNORM, usage)
}

/// Pipelines for what a frame may have (glsl/include/shore.glsl).
struct Way {
    mark: Pipeline,
    /// Of each list.
    shade: [Pipeline; 3],
}

impl Way {
    fn new(gpu: &Gpu, constants: &[(u32, u32)], general: u32) -> Result<Self, Error> {
        let general = (3, general);
        let shade = |parts| {
            let own = [constants, &[(1, parts), general]].concat();
            Pipeline::compute(gpu, shader::SHORE_SHORELINE_COMP, &own)
        };
        Ok(Self {
            mark: Pipeline::compute(gpu, shader::SHORE_TILES_COMP, &[general])?,
            shade: [shade(1)?, shade(2)?, shade(3)?],
        })
    }
}

/// The pass.
pub struct Shore {
    gather: Pipeline,
    /// For what most frames have, and for all there is.
    ways: [Way; 2],
    strip: Pipeline,
    /// The dispatch over the tiles, and the draw of their quads.
    arguments: Buffer,
    lists: Lists,
    target: Target,
}

/// Specialisation of the edge.
pub fn edge_constant(shore: &ShoreConfig) -> (u32, u32) {
    let edge = match shore.edge {
        Edge::Clip => 0,
        Edge::Smooth => 1,
        Edge::Coverage => 2,
    };
    (0, edge)
}

impl Shore {
    pub fn new(gpu: &Gpu, config: &Config, shore: &ShoreConfig) -> Result<Self, Error> {
        let target = Target::new(gpu, &desc(config), vk::AttachmentLoadOp::LOAD)?;
        let constants = [&[edge_constant(shore)][..], &crate::light::constants(config)].concat();
        // Of strips over each other the most.
        let most = [blend(vk::BlendOp::MAX)];
        let strip = Graphics {
            vertex: shader::SHORE_STRIP_VERT,
            fragment: shader::SHORE_STRIP_FRAG,
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            pass: target.pass.handle,
            blend: &most,
            constants: &constants,
        };
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::TRANSFER_DST;
        let name = "shore/arguments";
        Ok(Self {
            gather: Pipeline::compute(gpu, shader::SHORE_TILES_LIST_COMP, &[])?,
            ways: [Way::new(gpu, &constants, 0)?, Way::new(gpu, &constants, 1)?],
            strip: Pipeline::graphics(gpu, &strip)?,
            arguments: Buffer::new(gpu, name, 64, usage, MemoryLocation::GpuOnly)?,
            lists: Lists::new(gpu, config)?,
            target,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let new = Lists::new(gpu, config)?;
        self.lists.most = new.most;
        retired.replace(&mut self.lists.marks, new.marks);
        retired.replace(&mut self.lists.list, new.list);
        self.target.resize(gpu, &desc(config), retired)
    }

    /// Which tiles may have foam on the host's surface, the draw of their quads; how many there are in a row of a frame, and
    /// where in the list they begin.
    pub fn tiles(&self, extent: vk::Extent2D) -> (&Buffer, &Buffer, [u32; 2]) {
        (&self.lists.list, &self.arguments, [tiles(extent)[0], 3 * self.lists.most])
    }

    /// The foam.
    pub fn image(&self) -> &Image {
        &self.target.image
    }

    /// `general`: the frame has more than most have.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        (given, general): (&Given<'_>, bool),
        textures: &Textures,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let way = &self.ways[usize::from(general)];
        let image = self.image();
        let arguments = self.arguments.handle;
        gpu.barriers(
            cmd,
            &[access::image(image, AFTER.and(COPY_READ).discarded(), CLEAR)],
            &[
                buffer(self.lists.marks.handle, COMPUTE_READ_WRITE, COPY_WRITE),
                buffer(arguments, READ, COPY_WRITE),
                buffer(self.lists.list.handle, READ, COMPUTE_READ_WRITE),
            ],
        );
        gpu.clear_color(cmd, image, [0.0; 4]);
        // SAFETY: outside a render pass; the frame before has read both (barrier).
        unsafe {
            gpu.device.cmd_fill_buffer(cmd, self.lists.marks.handle, 0, vk::WHOLE_SIZE, 0);
            gpu.device.cmd_update_buffer(cmd, arguments, 0, bytemuck::bytes_of(&NO_TILES));
        }
        let own = [
            (0, r.uniforms),
            (1, r.shore),
            (2, r.scene_depth),
            // What a frame does not have is not read.
            (3, given.surface.unwrap_or(r.scene_depth)),
            (6, given.map(gpu).unwrap_or(r.scene_depth)),
            (28, textures.noise()),
            (29, textures.web()),
            (30, given.mask.unwrap_or(r.scene_depth)),
        ];
        let resources = [&own[..], &r.sunlight.resources()].concat();
        match given.strip() {
            Some(strip) => {
                gpu.barriers(cmd, &[access::image(image, CLEAR, COLOR_ATTACHMENT)], &[]);
                self.record_strip(r, strip, &resources)?;
                gpu.barriers(
                    cmd,
                    &[access::image(image, COLOR_ATTACHMENT, COMPUTE_READ_WRITE)],
                    &[],
                );
            }
            None => gpu.barriers(cmd, &[access::image(image, CLEAR, COMPUTE_READ_WRITE)], &[]),
        }
        let filled = [
            buffer(self.lists.marks.handle, COPY_WRITE, COMPUTE_READ_WRITE),
            buffer(arguments, COPY_WRITE, COMPUTE_READ_WRITE),
        ];
        gpu.barriers(cmd, &[], &filled);
        if given.shore.is_some() {
            self.record_tiles(r, &own, &way.mark)?;
        }
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.lists.list.handle, COMPUTE_READ_WRITE, READ),
                buffer(arguments, COMPUTE_READ_WRITE, READ),
            ],
        );
        if given.shore.is_some_and(|shore| shore.surface.is_some()) {
            let lists = [
                (8, Resource::storage(image)),
                (9, Resource::buffer(&self.lists.list)),
                (10, Resource::buffer(&self.arguments)),
            ];
            let resources = [&resources[..], &lists].concat();
            for (i, pipeline) in (1..).zip(&way.shade) {
                r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
                pipeline.push(gpu, cmd, &[tiles(r.extent)[0], self.lists.most]);
                if i > 1 {
                    // Each tile is in one list; all may write all for what a validation layer knows.
                    let both = COMPUTE_READ_WRITE;
                    gpu.barriers(cmd, &[access::image(image, both, both)], &[]);
                }
                // SAFETY: outside a render pass, pipeline and set are bound; the arguments are visible (barrier).
                unsafe { gpu.device.cmd_dispatch_indirect(cmd, arguments, 16 * i) };
            }
        }
        gpu.barriers(cmd, &[access::image(image, COMPUTE_READ_WRITE, AFTER)], &[]);
        Ok(())
    }

    /// Which tiles may have foam on the host's surface.
    fn record_tiles(
        &self,
        r: &Recording<'_>,
        own: &[(u32, Resource)],
        mark: &Pipeline,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let Lists { marks, list, .. } = &self.lists;
        let [x, y] = tiles(r.extent);
        let marked = [own, &[(8, Resource::buffer(marks))]].concat();
        r.descriptors.bind(gpu, cmd, mark, &marked)?;
        mark.push(gpu, cmd, &x);
        // Sixteen pixels at a time.
        let vk::Extent2D { width, height } = r.extent;
        let blocks = vk::Extent2D { width: width.div_ceil(4), height: height.div_ceil(4) };
        r.dispatch_over(blocks, mark.local_size);
        let both = COMPUTE_READ_WRITE;
        gpu.barriers(cmd, &[], &[buffer(marks.handle, both, both)]);
        let listed = [
            (0, Resource::buffer(marks)),
            (1, Resource::buffer(list)),
            (2, Resource::buffer(&self.arguments)),
        ];
        r.descriptors.bind(gpu, cmd, &self.gather, &listed)?;
        self.gather.push(gpu, cmd, &[x * y, self.lists.most]);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, (x * y).div_ceil(64), 1, 1) };
        Ok(())
    }

    /// The host's strip.
    fn record_strip(
        &self,
        r: &Recording<'_>,
        strip: &Strip,
        resources: &[(u32, Resource)],
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let hosts: Vec<_> = super::buffers_of(strip).collect();
        let taken = hosts.iter().map(|handle| buffer(*handle, strip.before, VERTEX_READ));
        gpu.barriers(cmd, &[], &taken.collect::<Vec<_>>());
        let indices = strip.triangles.indices.map(|(stream, _)| stream);
        let others = [&Some(strip.v), &indices];
        let windows = Window::all(gpu, &strip.triangles.positions, others, 0);
        if let Some((positions, [across, indices])) = windows {
            self.target.begin(gpu, cmd, r.extent.into(), [0.0; 4]);
            let streams = [(8, positions), (9, across), (10, indices)];
            let streams = streams.map(|(binding, window)| (binding, window.resource));
            r.descriptors.bind(gpu, cmd, &self.strip, &[resources, &streams].concat())?;
            let push = Push {
                position_word: positions.word,
                position_stride: positions.stride,
                v_word: across.word,
                v_stride: across.stride,
                index_word: indices.word,
                index_stride: indices.stride,
                vertices: strip.triangles.vertices,
            };
            self.strip.push(gpu, cmd, &push);
            // SAFETY: inside the render pass, pipeline and set are bound; the shader reads no vertex that is not there.
            unsafe { gpu.device.cmd_draw(cmd, strip.triangles.drawn(), 1, 0, 0) };
            gpu.end_pass(cmd);
        }
        let back = hosts.iter().map(|handle| buffer(*handle, VERTEX_READ, strip.after));
        gpu.barriers(cmd, &[], &back.collect::<Vec<_>>());
        Ok(())
    }

    /// Bytes of images and of buffers.
    pub fn memory(&self) -> (u64, u64) {
        let Lists { marks, list, .. } = &self.lists;
        (self.image().size, marks.size + list.size + self.arguments.size)
    }
}
