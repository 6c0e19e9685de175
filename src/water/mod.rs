//! Layered particle water (Bagar 2010; Bagar, Scherzer, Wimmer, EGSR 2010; on van der Laan, Green,
//! Sainz, I3D 2009). A pass a file; `Water::record` lists them in order.

mod classify;
mod cull;
mod depth;
mod front;
mod level;
mod reduce;
pub mod settings;
mod smooth;
mod smooth_query;
mod thickness;
mod tiles;

use ash::vk;

use crate::contract::{Config, Layer, MemoryUse, ParticleCounts, Particles};
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::Access;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::image::Image;
use crate::gpu::retire::RetireList;
use crate::gpu::timing::{Scope, Timer};

pub(crate) use classify::{Classify, ROW};
pub(crate) use cull::chunks;
pub(crate) use level::MOST_COARSENING;
pub use settings::{
    Amplitude, FoamSettings, Fresnel, Gate, Medium, Rule, Shading, Smoothing, Splat, WaterSettings,
};
pub(crate) use tiles::{COMPOSITE_DISPATCHES, COMPOSITE_DRAWS};

/// What every pass records with.
pub(crate) struct Recording<'a> {
    pub gpu: &'a Gpu,
    pub cmd: vk::CommandBuffer,
    pub descriptors: &'a Descriptors,
    pub timer: &'a mut Timer,
    /// Size of the frame; images may be larger.
    pub extent: vk::Extent2D,
    /// The frame's uniform block.
    pub uniforms: Resource,
    /// The scene's depth, sampled.
    pub scene_depth: Resource,
    /// Ends the smoothing by the host's own look at the queries (headless only).
    pub read_back: Option<ReadBack<'a>>,
}

/// Submits a command buffer, waits for it, looks at one query of the pool; hands back a fresh
/// command buffer to go on with, and whether any sample was counted.
pub(crate) type ReadBack<'a> = &'a mut dyn FnMut(
    vk::CommandBuffer,
    vk::QueryPool,
    u32,
) -> Result<(vk::CommandBuffer, bool), Error>;

impl Recording<'_> {
    pub fn begin(&mut self, stem: &'static std::ffi::CStr) -> Scope {
        self.timer.begin(self.gpu, self.cmd, stem)
    }

    pub fn end(&mut self, scope: Scope) {
        self.timer.end(self.gpu, self.cmd, scope);
    }

    /// Dispatches groups that cover an image by `local_size`.
    pub fn dispatch_over(&self, extent: vk::Extent2D, local_size: [u32; 3]) {
        let groups = [extent.width.div_ceil(local_size[0]), extent.height.div_ceil(local_size[1])];
        // SAFETY: cmd is recording outside a render pass with a compute pipeline and its set bound.
        unsafe { self.gpu.device.cmd_dispatch(self.cmd, groups[0], groups[1], 1) };
    }
}

/// The images that `composite` reads, with the tiles that it draws.
pub(crate) struct WaterLayers<'a> {
    pub smoothed: &'a Image,
    pub depth: &'a Image,
    pub thickness: &'a Image,
    pub tiles: &'a tiles::Tiles,
    pub level: &'a level::Level,
}

/// The technique: its passes in the order of the frame.
pub(crate) struct Water {
    cull: cull::Cull,
    front: front::Front,
    depth: depth::Depth,
    reduce: reduce::Reduce,
    level: level::Level,
    tiles: tiles::Tiles,
    smooth: smooth::Smooth,
    thickness: thickness::Thickness,
}

impl Water {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        Ok(Self {
            cull: cull::Cull::new(gpu, config)?,
            front: front::Front::new(gpu, config)?,
            depth: depth::Depth::new(gpu, config)?,
            reduce: reduce::Reduce::new(gpu, config)?,
            level: level::Level::new(gpu, config)?,
            tiles: tiles::Tiles::new(gpu, config)?,
            smooth: smooth::Smooth::new(gpu, config)?,
            thickness: thickness::Thickness::new(gpu, config)?,
        })
    }

    /// Replaces what depends on the extent.
    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.front.resize(gpu, config, retired)?;
        self.depth.resize(gpu, config, retired)?;
        self.reduce.resize(gpu, config, retired)?;
        self.tiles.resize(gpu, config, retired)?;
        self.smooth.resize(gpu, config, retired)?;
        self.thickness.resize(gpu, config, retired)
    }

    /// The passes of a frame.
    pub fn record(&self, r: &mut Recording<'_>, particles: &Particles) -> Result<(), Error> {
        self.cull.record(r, particles, self.depth.point_limit(r.gpu), self.depth.uses_points())?;
        self.front.record(r, &self.cull)?;
        self.depth.record(r, &self.front.list)?;
        self.reduce.record(r, &self.depth.image, &self.smooth, &self.tiles, &self.level)?;
        self.level.record(r, &self.depth.image, &self.reduce, &self.smooth, &self.tiles)?;
        self.tiles.record(r, &self.level)?;
        let (plan, tiles, level) = (&self.reduce.plan, &self.tiles, &self.level);
        self.smooth.record(r, &smooth::Work { plan, tiles, level })?;
        self.thickness.record(r, &self.cull.list)
    }

    /// What `composite` reads.
    pub fn layers(&self) -> WaterLayers<'_> {
        WaterLayers {
            smoothed: &self.smooth.a,
            depth: &self.depth.image,
            thickness: &self.thickness.image,
            tiles: &self.tiles,
            level: &self.level,
        }
    }

    /// Counts of all spheres and of those that can show, 256 bytes a chunk.
    pub fn counts(&self) -> ParticleCounts {
        ParticleCounts {
            all: self.cull.list.counts.handle,
            front: self.front.list.counts.handle,
            chunks: self.cull.list.chunks,
        }
    }

    /// The resolutions of the smoothing.
    pub fn levels(&self) -> vk::Buffer {
        self.level.levels.handle
    }

    /// Samples counted by the smoothing's queries, when it has them.
    pub fn query_results(&self) -> Option<(vk::Buffer, u32)> {
        self.smooth.query_results()
    }

    /// The layers of a frame of a size for the host, in the state `composite` left them in.
    pub fn kept(&self, frame: vk::Extent2D, access: Access) -> Vec<Layer> {
        let layer = |name, image: &Image, level, access| Layer {
            name,
            image: image.handle,
            view: image.view,
            format: image.format,
            extent: reduced(frame, level),
            access,
        };
        let (smoothing, plan) = (self.reduce.level, reduce::PLAN_AFTER);
        vec![
            layer("water.depth", &self.depth.image, 0, access),
            layer("water.surface", &self.smooth.a, smoothing, access),
            layer("water.iterations", &self.reduce.plan, smoothing, plan),
            layer("water.thickness.front", &self.thickness.image, self.thickness.level, access),
        ]
    }

    pub fn memory(&self) -> MemoryUse {
        let images = [
            &self.depth.image,
            &self.smooth.a,
            &self.smooth.b,
            &self.reduce.plan,
            &self.thickness.image,
        ];
        MemoryUse {
            images: images.iter().map(|image| image.size).sum(),
            buffers: self.cull.list.memory()
                + self.front.memory()
                + self.level.memory()
                + self.tiles.memory()
                + self.smooth.memory()
                + self.thickness.memory(),
        }
    }
}
