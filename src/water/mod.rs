//! Layered particle water (Bagar 2010; Bagar, Scherzer, Wimmer, EGSR 2010; on van der Laan, Green, Sainz, I3D
//! 2009). One pass per file; `Water::record` lists them in order.

mod back;
mod classify;
mod cull;
mod depth;
mod front;
mod gaps;
mod level;
mod motion;
mod noise;
pub(crate) mod panes;
mod reduce;
pub(crate) mod settings;
mod shape;
mod smooth;
mod smooth_query;
pub(crate) mod split;
mod spray;
mod sprites;
mod surface_foam;
mod thickness;
mod tiles;
pub(crate) mod wavelets;

use ash::vk;

use crate::bubbles::Bubbles;
use crate::contract::{Blobs, Config, Layer, MemoryUse, Particles, WhitewaterParticles};
use crate::diagnostics::{ParticleCounts, SmoothingLevels};
use crate::error::Error;
use crate::frame::{Lens, reduced};
use crate::gpu::Gpu;
use crate::gpu::access::{Access, COMPUTE_READ};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::image::Image;
use crate::gpu::retire::RetireList;
use crate::gpu::timing::{Scope, Timer};
use crate::light::{Light, Sunlight};
use crate::whitewater::Whitewater;

pub(crate) use classify::Classify;
pub(crate) use cull::{
    CAST, STREAM_USE, SphereList, Window, buffers_of, capacity, chunk_unit, chunks, each_once,
};
pub(crate) use depth::DEFAULT_SPLAT;
pub(crate) use level::{MOST_COARSENING, coarsening};
pub use panes::{MAX_PANES, Pane};
#[cfg(feature = "diagnostics")]
pub use settings::{Amplitude, Bed, Compositing, DebugView, Gate, Rule, Smoothing, Splat};
pub use settings::{
    Convolution, Ellipsoids, Exit, Fresnel, Kernels, Medium, Shading, ShadowFilter, Shadows,
    SpraySettings, SurfaceFoamSettings, SurfaceNoiseSettings, WaterSettings, Wavelets,
    WeberSettings,
};
pub(crate) use shape::{Crowd, bytes_bound as shape_bytes, sets as shape_sets};
pub(crate) use surface_foam::word_bytes as foam_bytes;
pub(crate) use thickness::sum_bytes as thickness_bytes;

/// Size of the image that holds all levels of the smoothing.
pub(crate) fn smoothing_extent(config: &Config, limits: &vk::PhysicalDeviceLimits) -> vk::Extent2D {
    level::Atlas::within(config, limits).extent
}

/// Bytes of the largest buffer that is bound as a whole, apart from the compute path's sums of thickness
/// ([`thickness_bytes`]) and its words of foam ([`foam_bytes`]).
pub(crate) fn water_bytes(config: &Config) -> u64 {
    let gaps = if config.sheets > 1 { gaps::bytes_bound(config) } else { 0 };
    gaps.max(front::cell_bytes(config.extent)).max(split::list_bytes(config))
}

/// Recording context of every pass.
pub(crate) struct Recording<'a> {
    pub gpu: &'a Gpu,
    pub cmd: vk::CommandBuffer,
    pub descriptors: &'a Descriptors,
    pub timer: &'a mut Timer,
    /// Size of the frame; images may be larger.
    pub extent: vk::Extent2D,
    /// The frame's uniform block.
    pub uniforms: Resource,
    /// The frame's [`SmoothingLevels`].
    pub levels: Resource,
    /// The uniforms of bubble foam.
    pub bubbles: Resource,
    /// The uniforms of shoreline and contact foam.
    pub shore: Resource,
    /// Whether whitewater needs the slower variant of its shaders: its shapes, sizes or fading with age are not the
    /// paper's, or particles behind the water's surface fade by the paper's falloff.
    pub shaped: bool,
    /// Distances of the cross-fade from whitewater sprites to blobs; `None` without it.
    pub crossfade: Option<Resource>,
    /// The scene's depth, sampled.
    pub scene_depth: Resource,
    /// Shadow resources of the sun.
    pub sunlight: Sunlight,
    /// Lets the host end the smoothing by reading the queries (headless only).
    pub read_back: Option<ReadBack<'a>>,
}

/// Submits a command buffer, waits for it, and reads one query of the pool. Returns a fresh command buffer and
/// whether any sample was counted.
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

/// Other techniques whose passes are interleaved with the water's.
#[derive(Clone, Copy)]
pub(crate) struct Beside<'a> {
    /// The maps rendered from the sun, which use the counts of `cull`.
    pub light: Option<&'a Light>,
    /// Whitewater (spray, foam and bubbles as particles of their own), if there is any. Whitewater and the blobs
    /// of bubble foam have to be drawn before the pass `reduce`, so that the tiles in which they appear are shaded
    /// too.
    pub whitewater: Option<(&'a Whitewater, Option<&'a WhitewaterParticles>)>,
    pub bubbles: Option<(&'a Bubbles, Option<&'a Blobs>)>,
    /// [`SpraySettings::strand_ratio`].
    pub strand_ratio: f32,
    pub crowd: Crowd,
}

/// The images that `composite` reads, and the tiles that it draws.
pub(crate) struct WaterLayers<'a> {
    pub smoothed: &'a Image,
    pub depth: &'a Image,
    pub thickness: &'a Image,
    pub split: &'a split::Split,
    /// Thickness of two layers, and the depth between them; `None` with one layer.
    pub sheets: Option<&'a Image>,
    pub boundaries: Option<&'a Buffer>,
    /// Depth and thickness of the foam, if enabled.
    pub foam: Option<[&'a Image; 2]>,
    /// The foam's velocity grids, read by compute and fragment shaders.
    pub drift: Option<&'a Buffer>,
    /// Spray, if enabled.
    pub spray: Option<&'a Image>,
    /// Height of the surface noise, if enabled.
    pub noise: Option<&'a Image>,
}

/// The passes that separate two layers.
struct Sheets {
    gaps: gaps::Gaps,
    back: back::Back,
}

impl Sheets {
    fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        Ok(Self { gaps: gaps::Gaps::new(gpu, config)?, back: back::Back::new(gpu, config)? })
    }

    /// Bytes of images and of buffers.
    fn memory(&self) -> (u64, u64) {
        let (image, blocks) = self.back.memory();
        (image, self.gaps.memory() + blocks)
    }
}

/// The technique: its passes in the order of the frame.
pub(crate) struct Water {
    shape: Option<shape::Shape>,
    cull: cull::Cull,
    front: front::Front,
    depth: depth::Depth,
    foam: Option<surface_foam::Foam>,
    spray: Option<spray::Spray>,
    motion: Option<motion::Motion>,
    reduce: reduce::Reduce,
    level: level::Level,
    sheets: Option<Sheets>,
    tiles: tiles::Tiles,
    smooth: smooth::Smooth,
    thickness: thickness::Thickness,
    split: split::Split,
    noise: Option<noise::Noise>,
}

impl Water {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let shape = shape::is_on(config).then(|| shape::Shape::new(gpu, config)).transpose()?;
        Ok(Self {
            shape,
            cull: cull::Cull::new(gpu, config)?,
            front: front::Front::new(gpu, config)?,
            depth: depth::Depth::new(gpu, config)?,
            foam: config.surface_foam.then(|| surface_foam::Foam::new(gpu, config)).transpose()?,
            spray: config.spray.then(|| spray::Spray::new(gpu, config)).transpose()?,
            motion: config.motion.then(|| motion::Motion::new(gpu, config)).transpose()?,
            reduce: reduce::Reduce::new(gpu, config)?,
            level: level::Level::new(gpu, config)?,
            sheets: (config.sheets > 1).then(|| Sheets::new(gpu, config)).transpose()?,
            tiles: tiles::Tiles::new(gpu, config)?,
            smooth: smooth::Smooth::new(gpu, config)?,
            thickness: thickness::Thickness::new(gpu, config)?,
            split: split::Split::new(gpu, config)?,
            noise: config.noise.map(|level| noise::Noise::new(gpu, config, level)).transpose()?,
        })
    }

    /// Recreates the size-dependent state.
    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.front.resize(gpu, config, retired)?;
        self.depth.resize(gpu, config, retired)?;
        if let Some(foam) = &mut self.foam {
            foam.resize(gpu, config, retired)?;
        }
        if let Some(spray) = &mut self.spray {
            spray.resize(gpu, config, retired)?;
        }
        if let Some(motion) = &mut self.motion {
            motion.resize(gpu, config, retired)?;
        }
        self.reduce.resize(gpu, config, retired)?;
        if let Some(Sheets { gaps, back }) = &mut self.sheets {
            gaps.resize(gpu, config, retired)?;
            back.resize(gpu, config, retired)?;
        }
        self.tiles.resize(gpu, config, retired)?;
        self.smooth.resize(gpu, config, retired)?;
        self.thickness.resize(gpu, config, retired)?;
        if let Some(noise) = &mut self.noise {
            noise.resize(gpu, config, retired)?;
        }
        self.split.resize(gpu, config, retired)
    }

    /// The passes of a frame.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        settings: &WaterSettings,
        beside: &Beside<'_>,
    ) -> Result<(), Error> {
        let Beside { light, whitewater, bubbles, strand_ratio, crowd } = *beside;
        let mut whitewater = whitewater.map(|(foam, particles)| (foam, particles.copied()));
        if let Some((bubbles, blobs)) = bubbles {
            if let Some((_, particles)) = &mut whitewater {
                let taken_over = bubbles.record_near(r, particles.as_ref())?;
                if let (Some(particles), true) = (particles, taken_over) {
                    particles.before = COMPUTE_READ;
                }
            }
            bubbles.record_lists(r, blobs)?;
        }
        let look = shape::ShapeSettings {
            ellipsoids: &settings.ellipsoids,
            strand: strand_ratio,
            crowd,
            spacing: settings.spacing,
        };
        let shaped = self.shape.as_ref().map(|own| own.record(r, particles, &look)).transpose()?;
        let drawn = shaped.as_ref().unwrap_or(particles);
        // The host's particles, with the surface foam and densities that `shape` has changed.
        let Particles { surface_foam, densities, .. } = *drawn;
        let particles = &Particles { surface_foam, densities, ..*particles };
        self.cull.record(r, drawn, self.depth.point_limit(r.gpu), self.depth.uses_points())?;
        if let Some(light) = light {
            let whitewater = whitewater.as_ref().and_then(|(_, particles)| particles.as_ref());
            light.record_maps(r, particles, &self.cull.list, whitewater)?;
        }
        self.front.record(r, &self.cull)?;
        self.depth.record(r, &self.front.list)?;
        if let Some(foam) = &self.foam {
            foam.record(r, particles, &self.cull.list)?;
        }
        if let Some(spray) = &self.spray {
            let strands = shaped.as_ref().filter(|_| strand_ratio > 1.0);
            let shapes = strands.map(shape::Shape::of_spray);
            spray.record(r, particles, &shapes, &self.cull.list, &self.depth.image)?;
        }
        if let Some((foam, mut particles)) = whitewater {
            // The light's maps have already acquired their buffers.
            if let (Some(particles), Some(_)) = (&mut particles, light) {
                particles.before = COMPUTE_READ;
            }
            foam.record_splat(r, particles.as_ref(), &self.depth.image)?;
        }
        if let Some((bubbles, blobs)) = bubbles {
            bubbles.record_peel(r, blobs)?;
        }
        let gaps = self.sheets.as_ref().map(|sheets| &sheets.gaps);
        if let Some(gaps) = gaps {
            gaps.record(r, &self.front.list, &self.cull.list, &self.depth.image)?;
        }
        self.thickness.record(r, &self.cull.list, gaps, self.foam.as_ref())?;
        let foam = self.foam.as_ref().map(surface_foam::Foam::depth);
        let spray = self.spray.as_ref().map(spray::Spray::image);
        let whitewater = whitewater.map(|(foam, _)| foam.layers()[0]);
        let bubbles = bubbles.map(|(bubbles, _)| bubbles.depth());
        let depths = reduce::Depths { water: &self.depth.image, foam, spray, whitewater, bubbles };
        self.reduce.record(r, &depths, &self.smooth, &self.tiles, &self.level)?;
        self.level.record(r, &depths, &self.reduce, &self.smooth, &self.tiles)?;
        let (plan, tiles) = (&self.reduce.plan, &self.tiles);
        if let Some(Sheets { gaps, back }) = &self.sheets {
            let depth = &self.depth.image;
            let into = back::Into { smooth: &self.smooth, plan, tiles, level: &self.level };
            back.record(r, depth, &self.cull.list, &gaps.boundaries, &into)?;
        }
        self.tiles.record(r)?;
        self.smooth.record(r, &smooth::Work { plan, tiles })?;
        self.split.record(r, tiles, gaps, self.foam.as_ref())?;
        if let Some(motion) = &self.motion {
            let depth = &self.depth.image;
            let from = motion::Surfaces {
                depth,
                foam: self.foam.as_ref().map(|foam| [foam.depth(), foam.thickness()]),
                smoothed: &self.smooth.a,
            };
            motion.record(r, particles, &self.cull.list, &from)?;
        }
        if let Some(noise) = &self.noise {
            noise.record(r, particles, &self.cull.list, &self.depth.image)?;
        }
        Ok(())
    }

    /// Layout of the smoothing levels of a frame of this size.
    pub fn smoothing_levels(
        &self,
        config: &Config,
        lens: &Lens,
        frame: vk::Extent2D,
        settings: &WaterSettings,
    ) -> SmoothingLevels {
        SmoothingLevels::new(config, lens, frame, settings, &self.tiles.atlas)
    }

    /// Layers that `composite` reads.
    pub fn layers(&self) -> WaterLayers<'_> {
        WaterLayers {
            smoothed: &self.smooth.a,
            depth: &self.depth.image,
            thickness: &self.thickness.image,
            split: &self.split,
            sheets: self.thickness.sheets.as_ref(),
            boundaries: self.sheets.as_ref().map(|sheets| &sheets.gaps.boundaries),
            foam: self.foam.as_ref().map(|foam| [foam.depth(), foam.thickness()]),
            drift: self.foam.as_ref().map(surface_foam::Foam::drift),
            spray: self.spray.as_ref().map(spray::Spray::image),
            noise: self.noise.as_ref().map(noise::Noise::image),
        }
    }

    /// Depth between the two layers of each thickness texel.
    pub fn boundaries(&self) -> Option<vk::Buffer> {
        self.sheets.as_ref().map(|sheets| sheets.gaps.boundaries.handle)
    }

    /// Counts of all spheres and of the visible ones, 256 bytes per chunk.
    pub fn counts(&self) -> ParticleCounts {
        ParticleCounts {
            all: self.cull.list.counts.handle,
            front: self.front.list.counts.handle,
            chunks: self.cull.list.chunks,
        }
    }

    /// Particles with their shapes, if they are ellipsoids.
    pub fn shaped(&self) -> Option<vk::Buffer> {
        self.shape.as_ref().map(|own| own.shaped.handle)
    }

    /// Tiles on which the smoothing works.
    pub fn tiles(&self) -> vk::Buffer {
        self.tiles.arguments.handle
    }

    /// Samples counted by the smoothing's queries, if it has them.
    pub fn query_results(&self) -> Option<(vk::Buffer, u32)> {
        self.smooth.query_results()
    }

    /// Motion vectors of a frame of this size.
    pub fn motion(&self, frame: vk::Extent2D) -> Option<Layer> {
        self.motion.as_ref().map(|motion| motion.layer(frame))
    }

    /// Lists the images of the water passes that the host can read as named layers: those of a frame of the size
    /// `frame`, in the state in which the pass `composite` left them.
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
        let mut layers = vec![
            layer("water.depth", &self.depth.image, 0, access),
            layer("water.surface", &self.smooth.a, smoothing, access),
            layer("water.iterations", &self.reduce.plan, smoothing, plan),
            layer("water.thickness", &self.thickness.image, self.thickness.level, access),
        ];
        if let Some(sheets) = &self.thickness.sheets {
            layers.push(layer("water.thickness.sheets", sheets, self.thickness.level, access));
        }
        if let Some(foam) = &self.foam {
            layers.push(layer("surface_foam", foam.depth(), foam.level, surface_foam::AFTER));
            layers.push(layer(
                "surface_foam.thickness",
                foam.thickness(),
                foam.level,
                surface_foam::AFTER,
            ));
        }
        if let Some(spray) = &self.spray {
            layers.push(layer("water.spray", spray.image(), 0, spray::AFTER));
        }
        if let Some(noise) = &self.noise {
            layers.push(layer("water.noise", noise.image(), noise.level, access));
        }
        layers
    }

    pub fn memory(&self) -> MemoryUse {
        let images = [
            &self.depth.image,
            &self.smooth.a,
            &self.smooth.b,
            &self.reduce.plan,
            &self.thickness.image,
        ];
        let (back, gaps) = self.sheets.as_ref().map_or((0, 0), Sheets::memory);
        let sheets = self.thickness.sheets.as_ref().map_or(0, |image| image.size);
        let (foam, sprites) = self.foam.as_ref().map_or((0, 0), surface_foam::Foam::memory);
        let (spray, droplets) = self.spray.as_ref().map_or((0, 0), spray::Spray::memory);
        let (motion, sums) = self.motion.as_ref().map_or((0, 0), motion::Motion::memory);
        let (noise, ripples) = self.noise.as_ref().map_or((0, 0), noise::Noise::memory);
        MemoryUse {
            images: images.iter().map(|image| image.size).sum::<u64>()
                + back
                + sheets
                + foam
                + spray
                + motion
                + noise,
            buffers: gaps
                + sprites
                + droplets
                + sums
                + ripples
                + self.shape.as_ref().map_or(0, shape::Shape::memory)
                + self.cull.list.memory()
                + self.front.memory()
                + self.level.memory()
                + self.tiles.memory()
                + self.smooth.memory()
                + self.thickness.memory()
                + self.split.memory(),
        }
    }
}
