//! Pass `shoreline`: foam on the host's water surface, along shores (*Semi-procedural foam shader*) and around
//! objects (Lettier, Foam).
//!
//! A pixel's foam depends only on its position on the surface: the pass needs the scene's depth and no mesh. If the
//! host gives a strip (a mesh along the shore, with the shore coordinate at its vertices), it is drawn first. Then
//! the tiles that may contain foam (`shore-tiles`) are processed, 2×2 pixels at a time. For `composite`, the tiles
//! that have foam are merged into runs.
//! Reads: tiles, scene depth, depth of the host's water surface, map of shore distances, strip, foam texture, noise,
//! mask. Writes: foam, RGBA8 (shoreline foam, contact foam, blocked share of sunlight, 0 for pass `contact`); the
//! runs and the arguments of their draw.

use ash::vk;
use bytemuck::NoUninit;

use super::Given;
use super::settings::{Edge, ShoreConfig};
use super::textures::Textures;
use super::tiles::{Tiles, extent_in_tiles};
use crate::contract::{Config, Strip};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COLOR_ATTACHMENT, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COPY_READ,
    FRAGMENT_SAMPLED, VERTEX_READ, buffer,
};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;
use crate::water::{Recording, Window};

/// Access by shading passes.
pub const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
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

fn desc(config: &Config) -> ImageDesc<'static> {
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT
        | vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::STORAGE
        | vk::ImageUsageFlags::TRANSFER_SRC
        | vk::ImageUsageFlags::TRANSFER_DST;
    // Every device can store to this format.
    ImageDesc::new("shore/foam", config.extent, vk::Format::R8G8B8A8_UNORM, usage)
}

/// The pass.
pub struct Shore {
    /// Compute pipelines of the foam: three for the usual case of most frames, and three for the general case
    /// (glsl/include/shore.glsl), one per list of tiles.
    shade: [[Pipeline; 3]; 2],
    strip: Pipeline,
    strip_tiles: Pipeline,
    target: Target,
}

/// Specialization constant of the edge.
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
        // Where strips overlap, the max value counts.
        let most = [blend(vk::BlendOp::MAX)];
        let strip = Graphics {
            vertex: shader::SHORE_STRIP_VERT,
            fragment: shader::SHORE_STRIP_FRAG,
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            pass: target.pass,
            blend: &most,
            constants: &constants,
        };
        let shade = |parts, general| {
            let own = [&constants[..], &[(1, parts), (3, general)]].concat();
            Pipeline::compute(gpu, shader::SHORE_SHORELINE_COMP, &own)
        };
        let way = |general| Ok([shade(1, general)?, shade(2, general)?, shade(3, general)?]);
        Ok(Self {
            shade: [way(0)?, way(1)?],
            strip: Pipeline::graphics(gpu, &strip)?,
            strip_tiles: Pipeline::compute(gpu, shader::SHORE_STRIP_TILES_COMP, &[])?,
            target,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.target.resize(gpu, &desc(config), retired)
    }

    /// The foam.
    pub fn image(&self) -> &Image {
        &self.target.image
    }

    /// `general` selects the pipelines without the limits of the usual case (glsl/include/shore.glsl).
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        (given, general): (&Given<'_>, bool),
        tiles: &Tiles,
        textures: &Textures,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let image = self.image();
        gpu.barriers(cmd, &[access::image(image, AFTER.and(COPY_READ).discarded(), CLEAR)], &[]);
        gpu.clear_color(cmd, image, [0.0; 4]);
        let own = [
            (0, r.uniforms),
            (1, r.shore),
            (2, r.scene_depth),
            // Missing inputs are bound but not read.
            (3, given.surface.unwrap_or(r.scene_depth)),
            (6, given.map(gpu).unwrap_or(r.scene_depth)),
            (28, textures.noise()),
            (29, textures.web()),
            (30, given.mask.unwrap_or(r.scene_depth)),
        ];
        let resources = [&own[..], &r.sunlight.resources()].concat();
        let [list, arguments, marks] = tiles.buffers();
        let lists = [
            (9, Resource::buffer(list)),
            (10, Resource::buffer(arguments)),
            (11, Resource::buffer(marks)),
        ];
        let both = COMPUTE_READ_WRITE;
        let marked = [buffer(marks.handle, both, both)];
        match given.strip() {
            Some(strip) => {
                gpu.barriers(cmd, &[access::image(image, CLEAR, COLOR_ATTACHMENT)], &[]);
                self.record_strip(r, strip, &resources)?;
                let drawn = access::image(image, COLOR_ATTACHMENT, COMPUTE_SAMPLED);
                gpu.barriers(cmd, &[drawn], &[]);
                let sampled = (8, Resource::Sampled(image.view, gpu.samplers.nearest));
                let pipeline = &self.strip_tiles;
                let own = [(11, Resource::buffer(marks)), sampled];
                r.descriptors.bind(gpu, cmd, pipeline, &own)?;
                let in_tiles = extent_in_tiles(r.extent);
                pipeline.push(gpu, cmd, &[in_tiles.width, in_tiles.height]);
                r.dispatch_over(in_tiles, pipeline.local_size);
                gpu.barriers(cmd, &[access::image(image, COMPUTE_SAMPLED, both)], &marked);
            }
            None => gpu.barriers(cmd, &[access::image(image, CLEAR, both)], &[]),
        }
        if given.shore.is_some_and(|shore| shore.surface.is_some()) {
            let resources = [&resources[..], &lists, &[(8, Resource::storage(image))]].concat();
            for (i, pipeline) in (1..).zip(&self.shade[usize::from(general)]) {
                r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
                pipeline.push(gpu, cmd, &tiles.places(r.extent));
                if i > 1 {
                    // Each tile is in one list, but a validation layer assumes that all dispatches write all tiles.
                    gpu.barriers(cmd, &[access::image(image, both, both)], &marked);
                }
                // SAFETY: outside a render pass, pipeline and set are bound; the arguments are visible (barrier).
                unsafe { gpu.device.cmd_dispatch_indirect(cmd, arguments.handle, 16 * i) };
            }
        }
        gpu.barriers(cmd, &[access::image(image, both, AFTER)], &[]);
        tiles.record_runs(r)
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
        let others = [&Some(strip.coordinates), &indices];
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
            // SAFETY: inside the render pass, pipeline and set are bound; the shader reads no vertex that is not
            // there.
            unsafe { gpu.device.cmd_draw(cmd, strip.triangles.drawn(), 1, 0, 0) };
            gpu.end_pass(cmd);
        }
        let back = hosts.iter().map(|handle| buffer(*handle, VERTEX_READ, strip.after));
        gpu.barriers(cmd, &[], &back.collect::<Vec<_>>());
        Ok(())
    }

    /// Bytes of images.
    pub fn memory(&self) -> u64 {
        self.image().size
    }
}
