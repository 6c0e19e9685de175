//! Every type that crosses the border between the host and the library, in the order of use: what fixes
//! a renderer ([`Host`], [`Enabled`], [`Config`]); what a frame takes ([`Frame`] and all in it:
//! [`HostImage`], [`Particles`], [`Camera`], [`Previous`], [`Sun`], [`Settings`]), and a step of the foam
//! ([`Step`]); what a record leaves behind ([`Recorded`], [`Layer`], [`MemoryUse`]).
//!
//! Types alone, and what follows from one of them: `check` says what is wrong with a frame, `frame` holds
//! the numbers derived from it.

use std::sync::Arc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, Vec3, Vec4};

use crate::bubbles::settings::{BubbleConfig, BubbleLook};
use crate::error::Error;
use crate::foam::generate::settings::GenerateSettings;
use crate::foam::settings::{DiffuseConfig, DiffuseLook};
use crate::frame::level_axes;
pub use crate::gpu::access::Access;
use crate::gpu::memory::Allocate;
use crate::shore::settings::{ShoreConfig, ShoreLook};
use crate::water::settings::{
    Exit, FoamLook, FoamSettings, Kernels, Ladder, NoiseLook, Rule, Shading, ShadowFilter, Shadows,
    Smoothing, Splat, SprayLook, WaterSettings,
};

/// `value.with(|it| it.field = ..)`, for structs that grow.
macro_rules! with {
    ($($name:ty),+ $(,)?) => {$(
        impl $name {
            /// The same value after a change: what struct-update syntax does where a struct may grow.
            /// `Config::new(..).with(|it| it.foam = true)`.
            #[must_use]
            pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
                change(&mut self);
                self
            }
        }
    )+};
}
pub(crate) use with;

with!(
    Host<'_>,
    Enabled,
    Config,
    HostImage,
    Particles,
    DiffuseParticles,
    Blobs,
    Shore,
    Step<'_>,
    GenerateStep<'_>,
    Sun,
    Shadow,
    Frame<'_>,
    Settings,
    Light,
);

/// The host's Vulkan objects, for [`Context::new`](crate::Context::new). All must outlive the context and what is made
/// from it; none is owned by it.
#[non_exhaustive]
pub struct Host<'a> {
    /// The instance.
    pub instance: &'a ash::Instance,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// A device of Vulkan 1.2 or newer, whose instance was made for as much.
    pub device: &'a ash::Device,
    /// Where memory comes from; called only in construction, `reconfigure`, `resize`, `collect` and `destroy`. `Host` and
    /// the context hold it: an allocator that must go before the device goes when these are dropped and what was made from
    /// the context is destroyed. `None`: the context makes one of its own, which goes with it.
    pub allocator: Option<Arc<dyn Allocate>>,
    /// One family with graphics and compute; every command buffer handed in is of it.
    pub queue_family: u32,
    /// Frames in flight, 1 to 8: slots are 0 .. frames_in_flight.
    pub frames_in_flight: u32,
    /// What the host really enabled on the device.
    pub enabled: Enabled,
    /// A pipeline cache, or null.
    pub pipeline_cache: vk::PipelineCache,
}

impl<'a> Host<'a> {
    /// A host that enabled no optional feature ([`with_enabled`](Self::with_enabled)), leaves memory to the library
    /// ([`with_allocator`](Self::with_allocator)) and has no pipeline cache
    /// ([`with_pipeline_cache`](Self::with_pipeline_cache)).
    pub fn new(
        instance: &'a ash::Instance,
        physical_device: vk::PhysicalDevice,
        device: &'a ash::Device,
        queue_family: u32,
        frames_in_flight: u32,
    ) -> Self {
        Self {
            instance,
            physical_device,
            device,
            allocator: None,
            queue_family,
            frames_in_flight,
            enabled: Enabled::default(),
            pipeline_cache: vk::PipelineCache::null(),
        }
    }

    /// With what of the optional features and extensions is really enabled.
    #[must_use]
    pub fn with_enabled(self, enabled: Enabled) -> Self {
        Self { enabled, ..self }
    }

    /// With an allocator of the host's: an `Arc` of what implements [`Allocate`].
    #[must_use]
    pub fn with_allocator(self, allocator: Arc<dyn Allocate>) -> Self {
        Self { allocator: Some(allocator), ..self }
    }

    /// With a pipeline cache of the device.
    #[must_use]
    pub fn with_pipeline_cache(self, pipeline_cache: vk::PipelineCache) -> Self {
        Self { pipeline_cache, ..self }
    }
}

/// Optional features and extensions the host enabled. False costs a path, never correctness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Enabled {
    /// `synchronization2`, of Vulkan 1.3 or VK_KHR_synchronization2: barriers that name one stage each. Without it
    /// those of Vulkan 1.0 are recorded, which wait for somewhat more; the picture is the same.
    pub synchronization2: bool,
    /// `shaderStorageImageWriteWithoutFormat`. Vulkan 1.3 allows it by format, so that only a device that was made for
    /// 1.2 needs it, for [`Config::foam`], [`Config::motion`], [`Shadows::Convolution`] and [`Shading::Compute`].
    pub storage_image_write_without_format: bool,
    /// VK_EXT_debug_utils on the instance: names and labels.
    pub debug_utils: bool,
    /// VK_EXT_conditional_rendering with `conditionalRendering`.
    pub conditional_rendering: bool,
    /// Vulkan 1.2 `drawIndirectCount`.
    pub draw_indirect_count: bool,
    /// `largePoints`: without it the raster splats draw quads alone.
    pub large_points: bool,
    /// `occlusionQueryPrecise`: without it a query only tells zero from non-zero, which is all
    /// the termination needs.
    pub precise_occlusion_queries: bool,
    /// Vulkan 1.2 `shaderBufferInt64Atomics`, with `shaderInt64`: without them diffuse particles are gone
    /// through twice ([`foam::Splat`](crate::foam::Splat)).
    pub buffer_int64_atomics: bool,
}

/// What fixes memory and pipelines. Changed between records by
/// [`reconfigure`](crate::Renderer::reconfigure).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Config {
    /// Largest size of the output's part in pixels, 1 to the device's limit of 2D images, framebuffers and viewports.
    /// Images are made for it; a frame may be smaller ([`HostImage::rect`]). Some sizes are too much for a device
    /// all the same, which [`Offer::check`](crate::Offer::check) says: at a [`smoothing_level`](Self::smoothing_level)
    /// of 0 all levels of the smoothing have to find room in one image, beside or below each other (of a square, up to
    /// two thirds of the limit; of a narrow one, any length), and what is bound at once has to be within the device's
    /// storage-buffer range: with [`diffuse`](Self::diffuse) 32 bytes a pixel, with [`bubbles`](Self::bubbles) 4 for
    /// each layer and one besides, and a texel of thickness 8, 16 with [`foam`](Self::foam), with two
    /// [`sheets`](Self::sheets) 16 more.
    pub extent: vk::Extent2D,
    /// Format of the output: a colour attachment, or a storage image as
    /// [`composite`](Self::composite) says.
    pub output_format: vk::Format,
    /// Most particles a frame may have.
    pub max_particles: u32,
    /// Longest stride of the particle streams in bytes, a multiple of 4 (default 16): with the
    /// device's storage-buffer range it decides how many particles are processed at a time.
    pub max_stride: u32,
    /// Resolution of the smoothing: 0 full, 1 half (default), 2 quarter.
    pub smoothing_level: u32,
    /// Resolution of the thickness, and of all of foam: 0 full, 1 half, 2 quarter (default), 3 eighth.
    /// Upsampled with the weights of texels on the same surface, of foam where the scene does not hide
    /// it.
    pub thickness_level: u32,
    /// How depth is splatted; `None`: [`Splat::Compute`] on every device and at every size, which is
    /// faster at all that were measured (lavapipe, H200).
    pub depth_splat: Option<Splat>,
    /// How thickness, and all of foam, is splatted; `None`: as depth.
    pub thickness_splat: Option<Splat>,
    /// Form of the smoothing; `None`: [`Smoothing::Tiles`] on a CPU, where it was measured to be the
    /// fastest, [`Smoothing::Fused`] on GPUs (on an H200 half the time of tiles).
    pub smoothing: Option<Smoothing>,
    /// How the water is shaded; `None`: [`Shading::Raster`] on every device. GPUs made for computing rasterize slowly: there
    /// [`Shading::Compute`] is faster (an H200: 14 times). It writes the output as a storage image: its usage must allow that, and
    /// its format be one that the device stores to without being told which; R16G16B16A16_SFLOAT
    /// is nearly everywhere, those of sRGB are not. [`Offer`](crate::Offer) knows.
    pub composite: Option<Shading>,
    /// Steps of the screen-space reflection of the scene on water, 0 to 64, default 8. The first is a 128th of the picture's
    /// height long, and each is longer than the one before by the same factor (2.2 on a wide picture), so that the last ends
    /// at the picture's edge. A ray that meets nothing on the screen shows the environment; 0, as in the thesis, and
    /// [`Compositing::Source`](crate::water::Compositing) show the environment alone.
    pub mirror_steps: u32,
    /// What is seen through water with air behind it. Default [`Exit::TwoInterfaces`]; with [`Exit::Straight`] the pass
    /// `composite` is a fifth faster (lavapipe, a splash in a pool).
    pub exit: Exit,
    /// What of each particle is drawn. Default [`Kernels::Spheres`]. [`Kernels::Ellipsoids`] draw thin water as one body, by
    /// the pass `shape`: 92 to 96 bytes a particle more, of which the device has to bind 24 at once, and a frame of 1280×720
    /// takes 1.1 times as long with 28 000 particles, 1.5 times with 140 000 (lavapipe); 1.0 and 1.2 times with an
    /// [`Ellipsoids::reach`](crate::water::Ellipsoids) of 2 and `centred` of 0.
    pub kernels: Kernels,
    /// Iteration rule of the smoothing.
    pub rule: Rule,
    /// Most iterations of the smoothing, 1 to 256 (default 256, as the source).
    pub max_iterations: u32,
    /// Levels coarser than [`smoothing_level`](Self::smoothing_level) that water is smoothed at where it is so
    /// near that it would pass the most iterations: 0 to 3 (default 3: it is smooth to an eighth of the
    /// distance). Each pixel shows the level that its distance asks for, or between two of them something of
    /// both. For [`Rule::ConstantWidth`] alone; 0 saves up to a third of the memory of the smoothing.
    pub coarsening: u32,
    /// Sheets of water that are told apart where one stands before another with air between, as a
    /// drop before a pool: 1 as the source, or 2 (default). Each has its own thickness, the farther
    /// one its own surface where the nearer covers it. 1 saves the passes `gaps` and `back`.
    pub sheets: u32,
    /// Foam is drawn (default: not): the passes `foam`, and the particles' water shrinks by what of
    /// them is foam. 68 bytes a particle more.
    pub foam: bool,
    /// Spray is drawn (default: not): the pass `spray`, of particles as [`SprayLook::densities`] say,
    /// which count for water and foam too. 32 bytes a particle more.
    pub spray: bool,
    /// Diffuse particles are drawn (spray, foam and bubbles of their own, [`Frame::diffuse`]): the passes
    /// `splat`, `radiance`, `blur`. `None` (default): they are not. 88 bytes a pixel more.
    pub diffuse: Option<DiffuseConfig>,
    /// Blobs of bubble foam are drawn ([`Frame::bubbles`]): the passes `blobs`, `peel`, `soap`, and before them `near` where they are
    /// diffuse foam's ([`BubbleConfig::hand_over`]). `None` (default): they
    /// are not. 14½ bytes a pixel more, 4 for each layer and one besides, 64 a blob.
    pub bubbles: Option<BubbleConfig>,
    /// Shoreline and contact foam are drawn ([`Frame::shore`]): the passes `shoreline` and `contact`. `None` (default): they
    /// are not. 4 bytes a pixel more, and 8.7 MiB for the textures.
    pub shore: Option<ShoreConfig>,
    /// The baseline's surface noise is drawn, for comparison: the pass `noise`, at a resolution of 0
    /// full, 1 half, 2 quarter, 3 eighth. `None` (default): it is not. 16 bytes a particle more, and 4
    /// a texel.
    pub noise: Option<u32>,
    /// Where the sun does not reach the fluid: the host's shadow map or mask, [`Sun::shadow`], and how
    /// the map is filtered; `None` (default): it is everywhere.
    pub shadow: Option<Shadows>,
    /// Water and foam cast shadows and caustics on the scene and foam on itself: the passes `light`,
    /// `caustics` and `lit`, with maps of so many texels a side over [`Sun::region`], a multiple of
    /// 16 from 16 to 4096. 36 bytes a texel, and a lit copy of the scene. With
    /// [`diffuse`](Self::diffuse) its particles cast shadows too, on the scene, the water, foam and each
    /// other: the pass `diffuse`, 24 bytes a texel more. `None` (default): they do not.
    pub cast: Option<u32>,
    /// Motion vectors are made (default: not): the pass `motion` and the layer `motion`, of
    /// [`Frame::previous`] and the particles' velocities. 12.5 bytes a pixel more (at other
    /// [`thickness_level`](Self::thickness_level)s 48, 26, 12.5, 9.1).
    pub motion: bool,
    /// Edge of the environment cube in texels, a power of two from 16 to 2048 (default 256).
    pub environment_size: u32,
    /// The output is the scene's colour image itself (default): it is copied before it is written
    /// and needs transfer-source usage.
    pub in_place: bool,
    /// Keep the images of the intermediate layers readable after `record`.
    pub keep_layers: bool,
}

impl Config {
    /// The defaults for an output.
    pub fn new(extent: vk::Extent2D, output_format: vk::Format, max_particles: u32) -> Self {
        Self {
            extent,
            output_format,
            max_particles,
            max_stride: 16,
            smoothing_level: 1,
            thickness_level: 2,
            depth_splat: None,
            thickness_splat: None,
            smoothing: None,
            composite: None,
            mirror_steps: 8,
            exit: Exit::TwoInterfaces,
            kernels: Kernels::Spheres,
            rule: Rule::ConstantWidth,
            max_iterations: 256,
            coarsening: 3,
            sheets: 2,
            foam: false,
            spray: false,
            diffuse: None,
            bubbles: None,
            shore: None,
            noise: None,
            shadow: None,
            cast: None,
            motion: false,
            environment_size: 256,
            in_place: true,
            keep_layers: false,
        }
    }
}

/// A frame in flight: an index below `frames_in_flight`. Handing a slot in says that all GPU work
/// recorded with it before is complete.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot(pub u32);

/// An image of the host's, with its state when `record` takes it over and when it hands it back.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct HostImage {
    /// The image: single-sampled, 2D, with sampled usage; a depth image also with attachment usage
    /// (its read-only layout asks for it), an output as [`Config::in_place`] and
    /// [`Config::composite`] say.
    pub image: vk::Image,
    /// A 2D view of its first mip and layer; of depth-stencil images of the depth aspect alone.
    pub view: vk::ImageView,
    /// Format of the view.
    pub format: vk::Format,
    /// All aspects of the image (barriers cover them all).
    pub aspect: vk::ImageAspectFlags,
    /// Size in texels.
    pub extent: vk::Extent2D,
    /// The part of the image that is the view: all of it, or a window of it for one of several
    /// views, or for a resolution that changes from frame to frame. Barriers cover the whole image.
    pub rect: vk::Rect2D,
    /// Last use before `record`: stages and accesses to wait for, current layout.
    pub before: Access,
    /// First use after `record`, and the layout to leave the image in.
    pub after: Access,
}

impl HostImage {
    /// All of an image, which is handed back in the state in which it comes. The aspects are those of the format.
    pub fn new(
        image: vk::Image,
        view: vk::ImageView,
        format: vk::Format,
        extent: vk::Extent2D,
        state: Access,
    ) -> Self {
        let (rect, aspect) = (extent.into(), aspects_of(format));
        Self { image, view, format, aspect, extent, rect, before: state, after: state }
    }

    /// A part of it as the view.
    #[must_use]
    pub fn with_rect(self, rect: vk::Rect2D) -> Self {
        Self { rect, ..self }
    }

    /// Handed back for another use.
    #[must_use]
    pub fn with_after(self, after: Access) -> Self {
        Self { after, ..self }
    }
}

/// All aspects of a format.
fn aspects_of(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D32_SFLOAT => {
            vk::ImageAspectFlags::DEPTH
        }
        vk::Format::D16_UNORM_S8_UINT
        | vk::Format::D24_UNORM_S8_UINT
        | vk::Format::D32_SFLOAT_S8_UINT => {
            vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
        }
        vk::Format::S8_UINT => vk::ImageAspectFlags::STENCIL,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

/// One attribute of the particles: `stride` bytes apart from `offset` on. Streams may share a
/// buffer (interleaved) or not. Little-endian 32-bit values, 4-byte aligned.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    /// A buffer with storage usage.
    pub buffer: vk::Buffer,
    /// Its whole size in bytes.
    pub size: u64,
    /// Byte offset of the first particle's value, a multiple of 4.
    pub offset: u64,
    /// Bytes from one particle's value to the next, a multiple of 4, at most
    /// [`Config::max_stride`].
    pub stride: u32,
}

impl Stream {
    /// What is wrong with it, for values of so many bytes.
    pub(crate) fn check(
        &self,
        field: &'static str,
        bytes: u64,
        count: u32,
        (most, max_stride): (&str, u32),
    ) -> Result<(), Error> {
        let Self { size, offset, stride, .. } = *self;
        if !stride.is_multiple_of(4) || u64::from(stride) < bytes || !offset.is_multiple_of(4) {
            let why = format!(
                "stride {stride} and offset {offset}: multiples of 4 expected, stride at least {bytes}"
            );
            return Err(Error::bad(field, why));
        }
        if stride > max_stride {
            return Err(Error::bad(
                field,
                format!("stride {stride} is more than {most}, {max_stride}"),
            ));
        }
        // Of the last particle only the value itself has to be there.
        let used = match u64::from(count) {
            0 => 0,
            count => (count - 1) * u64::from(stride) + bytes,
        };
        let end = offset.saturating_add(used);
        if end > size {
            let why = format!("{count} particles need {end} bytes, the buffer has {size}");
            return Err(Error::bad(field, why));
        }
        Ok(())
    }
}

/// How many particles there are.
#[derive(Clone, Copy, Debug)]
pub enum Count {
    /// Known to the host; at most [`Config::max_particles`].
    Cpu(u32),
    /// A `u32` in a buffer with storage usage, read on the GPU and clamped to
    /// [`Config::max_particles`].
    Gpu {
        /// The buffer.
        buffer: vk::Buffer,
        /// Byte offset, a multiple of the device's minStorageBufferOffsetAlignment.
        offset: u64,
    },
}

/// The host's own groups of particles for culling: `count` records of 32 bytes: first particle
/// (u32), number of particles (u32), minimum corner (3×f32), maximum corner (3×f32) of the
/// centres, in world space. Particles in no packet are nowhere: they are not drawn and cast no shadow. Those in packets
/// outside the view are not drawn, and cast what of their shadow falls into it. A particle may be in one packet only.
#[derive(Clone, Copy, Debug)]
pub struct Packets {
    /// A buffer with storage usage.
    pub buffer: vk::Buffer,
    /// Byte offset, a multiple of the device's minStorageBufferOffsetAlignment.
    pub offset: u64,
    /// Number of packets, at most 65 535.
    pub count: u32,
}

/// The particles of one frame. Only read.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Particles {
    /// World-space centres (3×f32, metres or the scene's unit). NaN and infinite ones are dropped
    /// and counted.
    pub positions: Stream,
    /// SPH densities (f32), (0, ∞). 0, a negative number and NaN mean that there is no sum yet, as of a particle that was
    /// just emitted: the rest density, so that it is whole water or foam and no spray. `None`: all have that.
    pub densities: Option<Stream>,
    /// World velocities (3×f32, scene units a second), along which foam and spray are drawn, and for
    /// motion vectors; read with [`Config::foam`], [`Config::spray`] or [`Config::motion`] alone.
    /// `None`: at rest.
    pub velocities: Option<Stream>,
    /// Numbers that follow the particles from frame to frame (u32), for the noise in foam and the
    /// droplets of spray; read as the velocities, and with [`Config::noise`] for the noise on the
    /// surface. `None`: their place.
    pub ids: Option<Stream>,
    /// How many.
    pub count: Count,
    /// Groups to cull by instead of each particle.
    pub packets: Option<Packets>,
    /// Share of each that is foam (0 water to 1 foam, NaN: water) and its age (seconds), 2×f32: what
    /// [`State::foam`](crate::State::foam) holds, at a stride of 8. With [`Config::foam`]; `None`:
    /// nothing is.
    pub foam: Option<Stream>,
    /// Last use of all these buffers before `record`; the layout is ignored. For buffers that the
    /// CPU wrote before the submit, [`access::NOTHING`](crate::access::NOTHING).
    pub before: Access,
    /// First use of them after `record` (layout ignored).
    pub after: Access,
}

impl Particles {
    /// Positions alone, in buffers that the CPU wrote before the submit and only shaders read
    /// otherwise.
    pub fn new(positions: Stream, count: Count) -> Self {
        Self {
            positions,
            densities: None,
            velocities: None,
            ids: None,
            count,
            packets: None,
            foam: None,
            before: crate::gpu::access::NOTHING,
            after: crate::gpu::access::NOTHING,
        }
    }

    /// With densities of their own.
    #[must_use]
    pub fn with_densities(self, densities: Stream) -> Self {
        Self { densities: Some(densities), ..self }
    }

    /// With velocities.
    #[must_use]
    pub fn with_velocities(self, velocities: Stream) -> Self {
        Self { velocities: Some(velocities), ..self }
    }

    /// With numbers that follow the particles.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// With groups to cull by.
    #[must_use]
    pub fn with_packets(self, packets: Packets) -> Self {
        Self { packets: Some(packets), ..self }
    }

    /// With how much of each is foam, as [`State::foam`](crate::State::foam) has it.
    #[must_use]
    pub fn with_foam(self, foam: Stream) -> Self {
        Self { foam: Some(foam), ..self }
    }

    /// Last used as `before` says, and next as `after`.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// The diffuse particles of one frame: spray, foam on the surface and bubbles under it, each by itself (Ihmsen et
/// al. 2012). Only read.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DiffuseParticles {
    /// World-space centres (3×f32, metres or the scene's unit). NaN and infinite ones are not drawn.
    pub positions: Stream,
    /// What each is (u32): 0 foam, 1 spray, 2 bubble; `None`: all are foam.
    pub kinds: Option<Stream>,
    /// Their radii (f32, scene units, (0, ∞)); `None`, and of 0 or less, [`DiffuseLook::radius`].
    pub radii: Option<Stream>,
    /// What of its life has passed (f32, 0 new to 1 gone); `None`: all are new. Those of 1 or more are not
    /// drawn.
    pub ages: Option<Stream>,
    /// Numbers that follow them from frame to frame (u32), for their sizes; `None`: their place.
    pub ids: Option<Stream>,
    /// How many.
    pub count: Count,
    /// Packets of them, with [`DiffuseConfig::packets`](crate::foam::DiffuseConfig::packets): those outside the view,
    /// for shadows outside the light's region, are not read. Of particles with [`radii`](Self::radii) of their own the
    /// boxes hold the whole, not the centres. [`Splat::Raster`](crate::foam::Splat::Raster) reads all of them. `None`:
    /// each by itself.
    pub packets: Option<Packets>,
    /// Depth of a fluid surface of the host's own, a sea say, in the camera's convention; the nearer of it and the
    /// water's counts. Any size, only sampled by compute, another image than the scene's depth. What lies behind it is
    /// seen with [`Submerged::Falloff`](crate::foam::Submerged::Falloff) alone: of the host's water nothing is known.
    /// `None`: the water's surface is the only one.
    pub fluid_depth: Option<HostImage>,
    /// Last use of all these buffers before `record` (layout ignored).
    pub before: Access,
    /// First use of them after `record` (layout ignored).
    pub after: Access,
}

impl DiffuseParticles {
    /// Foam at positions alone, in buffers that the CPU wrote before the submit.
    pub fn new(positions: Stream, count: Count) -> Self {
        Self {
            positions,
            kinds: None,
            radii: None,
            ages: None,
            ids: None,
            count,
            packets: None,
            fluid_depth: None,
            before: crate::gpu::access::NOTHING,
            after: crate::gpu::access::NOTHING,
        }
    }

    /// With what each is.
    #[must_use]
    pub fn with_kinds(self, kinds: Stream) -> Self {
        Self { kinds: Some(kinds), ..self }
    }

    /// With radii of their own.
    #[must_use]
    pub fn with_radii(self, radii: Stream) -> Self {
        Self { radii: Some(radii), ..self }
    }

    /// With what of their lives has passed.
    #[must_use]
    pub fn with_ages(self, ages: Stream) -> Self {
        Self { ages: Some(ages), ..self }
    }

    /// With numbers that follow them.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// Last used as `before` says, and next as `after`.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// Blobs of bubble foam of one frame (Huszár, Szécsi): balls of soap bubbles round a white core. Only read.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Blobs {
    /// Centre (world space) and radius of each (4×f32). NaN, infinite and huge ones, and radii of 0 or less, are not
    /// drawn.
    pub balls: Stream,
    /// How each is turned, from its own space to the world: quaternions (4×f32, the real part last) of any length; of
    /// none it is not turned. `None`: none is.
    pub turns: Option<Stream>,
    /// Numbers that follow them from frame to frame (u32), for which of the different blobs one is and for its films;
    /// `None`: their place.
    pub ids: Option<Stream>,
    /// How many.
    pub count: Count,
    /// Last use of all these buffers before `record` (layout ignored).
    pub before: Access,
    /// First use of them after `record` (layout ignored).
    pub after: Access,
}

impl Blobs {
    /// Balls alone, in buffers that the CPU wrote before the submit.
    pub fn new(balls: Stream, count: Count) -> Self {
        Self {
            balls,
            turns: None,
            ids: None,
            count,
            before: crate::gpu::access::NOTHING,
            after: crate::gpu::access::NOTHING,
        }
    }

    /// With how each is turned.
    #[must_use]
    pub fn with_turns(self, turns: Stream) -> Self {
        Self { turns: Some(turns), ..self }
    }

    /// With numbers that follow them.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// Last used as `before` says, and next as `after`.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// Shoreline and contact foam of one frame, a coat on water. Only read.
///
/// The scene's depth is that of what is in and under the water; where the surface itself is in it,
/// [`bias`](Self::bias) says so.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Shore {
    /// The host's water surface, which its scene shows. `None`: there is none but the strip and the particles' water.
    pub surface: Option<Surface>,
    /// Where shores are; `None`: no shoreline foam. What is no [`Shoreline::Strip`] needs a surface.
    pub shoreline: Option<Shoreline>,
    /// What takes contact foam away, over the view: one channel, 0 all to 1 nothing, any size (the source's mask); only
    /// sampled. `None`: the web, by places in the world.
    pub mask: Option<HostImage>,
    /// Metres, [0, 1000], by which what the scene's depth has may stand before the surface and count as behind it, default
    /// 0: more where the surface is in that depth.
    pub bias: f32,
}

impl Shore {
    /// Contact foam on a level surface of the host's.
    pub fn new(level: f32) -> Self {
        Self { surface: Some(Surface::Level(level)), shoreline: None, mask: None, bias: 0.0 }
    }

    /// With a shoreline.
    #[must_use]
    pub fn with_shoreline(self, shoreline: Shoreline) -> Self {
        Self { shoreline: Some(shoreline), ..self }
    }
}

/// A water surface of the host's.
#[derive(Clone, Copy, Debug)]
pub enum Surface {
    /// Level, at this height along [`Settings::up`].
    Level(f32),
    /// Of any shape: its depth in the camera's convention, any size, another image than the scene's depth, only sampled.
    /// Foam lies on it as if it were level about each point.
    Depth(HostImage),
}

/// What tells shoreline foam how far from the shore a place is, as v: 0 at the sea's edge, 1 at the shore, 2 inland.
#[derive(Clone, Copy, Debug)]
pub enum Shoreline {
    /// A mesh of the host's.
    Strip(Strip),
    /// Distances in the world, for islands that move or change.
    Map(Coast),
    /// The scene's depth alone: how deep the water is, over the slope of what is below. Shores that are hidden or not on the
    /// screen are missing.
    Screen,
}

/// Triangles of the host's, three vertices each.
#[derive(Clone, Copy, Debug)]
pub struct Triangles {
    /// Vertices (3×f32).
    pub positions: Stream,
    /// How many there are.
    pub vertices: u32,
    /// Which of them are the triangles' (u32), and how many these are, a multiple of three; `None`: all, in their order.
    pub indices: Option<(Stream, u32)>,
}

impl Triangles {
    /// Corners that are drawn.
    pub(crate) fn drawn(&self) -> u32 {
        self.indices.map_or(self.vertices, |(_, count)| count)
    }

    /// What is wrong with them, by the names of their vertices, indices and counts.
    pub(crate) fn check(
        &self,
        [positions, indices, count]: [&'static str; 3],
        limits: &vk::PhysicalDeviceLimits,
    ) -> Result<(), Error> {
        // Bound in one piece.
        let most =
            |count: u32| ("what the device binds", limits.max_storage_buffer_range / count.max(1));
        self.positions.check(positions, 12, self.vertices, most(self.vertices))?;
        if let Some((stream, n)) = &self.indices {
            stream.check(indices, 4, *n, most(*n))?;
        }
        if !self.drawn().is_multiple_of(3) {
            let why = format!("{}: three for each triangle expected", self.drawn());
            return Err(Error::bad(count, why));
        }
        Ok(())
    }
}

/// A mesh round islands that foam is drawn on (*Semi-procedural foam shader*, Sec. IV).
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    /// World space.
    pub triangles: Triangles,
    /// Of each vertex (f32).
    pub v: Stream,
    /// Last use of these buffers before `record` (layout ignored).
    pub before: Access,
    /// First use of them after it (layout ignored).
    pub after: Access,
}

/// Distances to the shore, as [`ShoreMap::coast`](crate::shore::ShoreMap::coast) hands them out.
#[derive(Clone, Copy, Debug)]
pub struct Coast {
    pub(crate) view: vk::ImageView,
    /// Corner, edge in metres, texels each way.
    pub(crate) corner: [f32; 2],
    pub(crate) edge: f32,
    pub(crate) size: u32,
}

/// One step of the simulation, for [`State::record_step`](crate::State::record_step): the particles
/// as they are after it, in any order. Only read.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Step<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// World-space velocities (3×f32, scene units per second).
    pub velocities: Stream,
    /// SPH densities (f32), (0, ∞). 0, a negative number and NaN mean that there is no sum yet, as of a particle that was
    /// just emitted: [`FoamSettings::rest_density`]. `None`: all have that.
    pub densities: Option<Stream>,
    /// Ids (u32), unique among the particles of a step and the same from step to step; not dense.
    /// Of two with the same id the first to come keeps the state; 0xffff_ffff is never foam. `None`:
    /// no phases, foam is a ramp of the Weber number from half the threshold to one and a half.
    pub ids: Option<Stream>,
    /// How many; at most [`StateConfig::max_particles`](crate::StateConfig).
    pub count: Count,
    /// Seconds since the step before, [0, ∞).
    pub dt: f32,
    /// Uniform settings.
    pub settings: &'a FoamSettings,
    /// Last use of all these buffers before the step (layout ignored).
    pub before: Access,
    /// First use of them after it (layout ignored).
    pub after: Access,
}

impl<'a> Step<'a> {
    /// Velocities alone, in buffers that the CPU wrote before the submit.
    pub fn new(
        slot: Slot,
        velocities: Stream,
        count: Count,
        dt: f32,
        settings: &'a FoamSettings,
    ) -> Self {
        let (before, after) = (crate::gpu::access::NOTHING, crate::gpu::access::NOTHING);
        Self { slot, velocities, densities: None, ids: None, count, dt, settings, before, after }
    }

    /// With densities of their own.
    #[must_use]
    pub fn with_densities(self, densities: Stream) -> Self {
        Self { densities: Some(densities), ..self }
    }

    /// With ids, without which there are no phases.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// Last used as `before` says, and next as `after`.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// One step of the fluid, for [`Generator::record_step`](crate::foam::Generator::record_step): its particles as they
/// are after it, in any order. Only read.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct GenerateStep<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// World-space centres (3×f32, scene units). Those that are not finite take no part.
    pub positions: Stream,
    /// World-space velocities (3×f32, scene units per second).
    pub velocities: Stream,
    /// Ids (u32), the same from step to step, for the random numbers; `None`: their place.
    pub ids: Option<Stream>,
    /// How many; at most [`GenerateConfig::max_fluid`](crate::foam::GenerateConfig).
    pub count: Count,
    /// Seconds since the step before, [0, ∞).
    pub dt: f32,
    /// The step's number in the sequence, for the random numbers.
    pub number: u32,
    /// Uniform settings.
    pub settings: &'a GenerateSettings,
    /// Last use of all these buffers before the step (layout ignored).
    pub before: Access,
    /// First use of them after it (layout ignored).
    pub after: Access,
}

impl<'a> GenerateStep<'a> {
    /// The first step of particles without ids, in buffers that the CPU wrote before the submit.
    pub fn new(
        slot: Slot,
        [positions, velocities]: [Stream; 2],
        count: Count,
        dt: f32,
        settings: &'a GenerateSettings,
    ) -> Self {
        let (before, after) = (crate::gpu::access::NOTHING, crate::gpu::access::NOTHING);
        Self {
            slot,
            positions,
            velocities,
            ids: None,
            count,
            dt,
            number: 0,
            settings,
            before,
            after,
        }
    }

    /// With numbers that follow the particles.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// With the step's number in the sequence.
    #[must_use]
    pub fn with_number(self, number: u32) -> Self {
        Self { number, ..self }
    }

    /// Last used as `before` says, and next as `after`.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// The view. The projection is the host's own, as used with a positive-height viewport whose row 0
/// is the top of the image: a host that flips by a negative height negates row 1 first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World to eye space, four columns.
    pub view: [[f32; 4]; 4],
    /// Eye to clip space, depth 0 to 1: perspective; finite or infinite, standard or reversed
    /// depth, off-axis allowed; looking down −z (right-handed) or +z.
    pub projection: [[f32; 4]; 4],
}

impl Camera {
    /// Of two matrices, as four columns of four or anything that turns into them: those of cgmath, nalgebra and mint do,
    /// and glam's by `to_cols_array_2d`.
    pub fn new(view: impl Into<[[f32; 4]; 4]>, projection: impl Into<[[f32; 4]; 4]>) -> Self {
        Self { view: view.into(), projection: projection.into() }
    }

    pub(crate) fn view(&self) -> Mat4 {
        Mat4::from_cols_array_2d(&self.view)
    }

    pub(crate) fn projection(&self) -> Mat4 {
        Mat4::from_cols_array_2d(&self.projection)
    }
}

/// For tools that have this crate's glam.
#[cfg(feature = "headless")]
impl Camera {
    /// As [`new`](Self::new).
    pub fn of(view: Mat4, projection: Mat4) -> Self {
        Self::new(view.to_cols_array_2d(), projection.to_cols_array_2d())
    }

    /// World to eye space.
    pub fn view_matrix(&self) -> Mat4 {
        self.view()
    }

    /// Eye to clip space.
    pub fn projection_matrix(&self) -> Mat4 {
        self.projection()
    }
}

/// The frame before, for motion vectors: the layer `motion`, two 32-bit floats a pixel, with
/// [`Config::motion`].
///
/// Each vector is where what the pixel shows is now (the pixel's centre) less where it was in the
/// frame before, in pixels of this frame, x to the right and y down: to reproject, look the frame
/// before up at `uv − vector / size`. A surface point of water or foam was at its place less `dt`
/// times the mean velocity of the particles round it; the scene stands still. Both projections are
/// taken as they are given: jittered ones give jittered vectors. Of two frames of different sizes both
/// count as of this one's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Previous {
    /// Its camera; may be of another projection, near plane or depth convention.
    pub camera: Camera,
    /// Seconds from it to this one, [0, ∞). Particles count as no faster than a thousand spacings in
    /// that time along each axis of the eye's.
    pub dt: f32,
}

/// What is known of the sun's way to the fluid.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct Sun {
    /// With [`Config::shadow`].
    pub shadow: Option<Shadow>,
    /// With [`Config::cast`]: where there is fluid that casts, and scene that it falls on.
    pub region: Option<Region>,
}

/// The host's shadows, only sampled.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Shadow {
    /// [`Shadows::Map`], [`Shadows::Convolution`]: depth as the light sees the scene, of any size.
    /// [`Shadows::Mask`]: one channel that covers the view, 1 where the sun shines on the fluid, 0
    /// where not. Its `rect` is the part that is meant.
    pub image: HostImage,
    /// World to the clip space of the map, four columns, standard or reversed depth (mask: not read).
    pub view_projection: [[f32; 4]; 4],
    /// Metres towards the sun by which points are moved before they are compared (mask: not read);
    /// about a spacing and a texel of the map.
    pub bias: f32,
}

impl Shadow {
    /// A map with world to its clip space, compared without a bias; of a mask the matrix is not read.
    pub fn new(image: HostImage, view_projection: impl Into<[[f32; 4]; 4]>) -> Self {
        Self { image, view_projection: view_projection.into(), bias: 0.0 }
    }

    pub(crate) fn clip(&self) -> Mat4 {
        Mat4::from_cols_array_2d(&self.view_projection)
    }

    /// 1 where depth grows away from the light, -1 where it falls.
    pub(crate) fn nearer(&self, light: &Light) -> f32 {
        let clip = self.clip();
        let inverse = clip.inverse();
        let middle = inverse.project_point3(Vec3::new(0.0, 0.0, 0.5));
        let step = light.toward() * 1.0e-3 * (1.0 + middle.length());
        let depth = |p| clip.project_point3(p).z;
        if depth(middle + step) <= depth(middle) { 1.0 } else { -1.0 }
    }
}

/// A ball of the world. The light's maps show its silhouette; beside it nothing is cast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Its middle.
    pub center: [f32; 3],
    /// Metres.
    pub radius: f32,
}

impl Region {
    /// World to the light's maps: place 0 to 1, metres along the light.
    pub(crate) fn to_map(self, light: &Light, up: Vec3) -> Mat4 {
        let sun = light.toward();
        let aside = if sun.dot(up).abs() > 0.99 { level_axes(up)[0] } else { up };
        let right = aside.cross(sun).normalize();
        let side = sun.cross(right);
        let scale = 0.5 / self.radius;
        let center = Vec3::from(self.center);
        let row = |axis: Vec3, offset: f32| axis.extend(offset - axis.dot(center));
        let (x, y) = (row(right * scale, 0.5), row(side * scale, 0.5));
        Mat4::from_cols(x, y, row(-sun, 0.0), Vec4::W).transpose()
    }
}

/// Everything one `record` draws.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct Frame<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// Written where there is water, unchanged elsewhere. Linear, scene-referred. Its `rect` is the
    /// frame's size, at most [`Config::extent`].
    pub output: HostImage,
    /// The scene behind the water, linear, only sampled. May be the image of `output`: then it is
    /// copied first (both need transfer usage), the `rect` of `output`. Else its size may differ.
    pub scene_color: HostImage,
    /// Depth of the scene in the camera's convention, only sampled. Its size may differ.
    pub scene_depth: HostImage,
    /// The particles.
    pub particles: Particles,
    /// Diffuse particles, with [`Config::diffuse`]; `None`: there are none.
    pub diffuse: Option<DiffuseParticles>,
    /// Blobs of bubble foam, with [`Config::bubbles`]; `None`: there are none but those that diffuse foam becomes
    /// ([`BubbleConfig::hand_over`]), with which it has to be `None`.
    pub bubbles: Option<Blobs>,
    /// Shoreline and contact foam, with [`Config::shore`]; `None`: there is none.
    pub shore: Option<Shore>,
    /// The view.
    pub camera: Camera,
    /// The sun's way, with [`Config::shadow`] and [`Config::cast`].
    pub sun: Sun,
    /// The frame before, with [`Config::motion`]; `None`, as for the first: nothing moved.
    pub previous: Option<Previous>,
    /// Uniform settings.
    pub settings: &'a Settings,
}

impl<'a> Frame<'a> {
    /// Water over the scene that is in `output` (with [`Config::in_place`]; else
    /// [`with_scene_color`](Self::with_scene_color) is needed), without anything optional.
    pub fn new(
        slot: Slot,
        output: HostImage,
        scene_depth: HostImage,
        particles: Particles,
        camera: Camera,
        settings: &'a Settings,
    ) -> Self {
        Self {
            slot,
            output,
            scene_color: output,
            scene_depth,
            particles,
            diffuse: None,
            bubbles: None,
            shore: None,
            camera,
            sun: Sun::default(),
            previous: None,
            settings,
        }
    }

    /// With the scene's colour in an image of its own.
    #[must_use]
    pub fn with_scene_color(self, scene_color: HostImage) -> Self {
        Self { scene_color, ..self }
    }

    /// With diffuse particles, as [`Config::diffuse`] asks for.
    #[must_use]
    pub fn with_diffuse(self, diffuse: DiffuseParticles) -> Self {
        Self { diffuse: Some(diffuse), ..self }
    }

    /// With blobs of bubble foam, as [`Config::bubbles`] asks for.
    #[must_use]
    pub fn with_bubbles(self, bubbles: Blobs) -> Self {
        Self { bubbles: Some(bubbles), ..self }
    }

    /// With shoreline and contact foam, as [`Config::shore`] asks for.
    #[must_use]
    pub fn with_shore(self, shore: Shore) -> Self {
        Self { shore: Some(shore), ..self }
    }

    /// With the host's shadows, as [`Config::shadow`] asks for.
    #[must_use]
    pub fn with_shadow(self, shadow: Shadow) -> Self {
        Self { sun: Sun { shadow: Some(shadow), ..self.sun }, ..self }
    }

    /// With the ball in which water and foam cast, as [`Config::cast`] asks for.
    #[must_use]
    pub fn with_region(self, region: Region) -> Self {
        Self { sun: Sun { region: Some(region), ..self.sun }, ..self }
    }

    /// With the frame before, as [`Config::motion`] asks for.
    #[must_use]
    pub fn with_previous(self, previous: Previous) -> Self {
        Self { previous: Some(previous), ..self }
    }

    /// The output is its own scene.
    pub(crate) fn in_place(&self) -> bool {
        self.scene_color.image == self.output.image
    }
}

/// All settings that cost nothing to change from frame to frame. Where a range has no end (∞) that is 1e12, so that products
/// of a few are numbers.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Settings {
    /// World direction up, of any length but 0, default +y: of the horizon under which water mirrors more water, of the
    /// level ground that [`Light::irradiance`] is of, down which soap drains, and of shores. Environments have their own
    /// ([`Sky::up`](crate::Sky), [`Equirectangular::up`](crate::Equirectangular)), what moves its gravity.
    pub up: [f32; 3],
    /// Layered water.
    pub water: WaterSettings,
    /// Foam in it.
    pub foam: FoamLook,
    /// Drops too small for the particles.
    pub spray: SprayLook,
    /// Foam of diffuse particles.
    pub diffuse: DiffuseLook,
    /// Bubble foam.
    pub bubbles: BubbleLook,
    /// Shoreline and contact foam.
    pub shore: ShoreLook,
    /// Filter of the host's shadow map, with [`Shadows::Convolution`].
    pub shadow: ShadowFilter,
    /// Noise on its surface.
    pub noise: NoiseLook,
    /// Light on it.
    pub light: Light,
    /// How many of the composite's layers are drawn, for a look at each; default all.
    pub ladder: Ladder,
}

/// For particles of a spacing of 0.05 metres in a world in metres, under the default [`Sky`](crate::Sky).
impl Default for Settings {
    fn default() -> Self {
        Self {
            up: [0.0, 1.0, 0.0],
            water: WaterSettings::default(),
            foam: FoamLook::default(),
            spray: SprayLook::default(),
            diffuse: DiffuseLook::default(),
            bubbles: BubbleLook::default(),
            shore: ShoreLook::default(),
            shadow: ShadowFilter::default(),
            noise: NoiseLook::default(),
            light: Light::default(),
            ladder: Ladder::default(),
        }
    }
}

impl Settings {
    /// The defaults for particles of a spacing in scene units (twice the solver's particle radius, (0, ∞)), in a world of so
    /// many units a metre (1 for metres, 100 for centimetres, (0, ∞)), under the default [`Sky`](crate::Sky) with +y up:
    /// all lengths, speeds and optical densities of all looks follow from the two. Another sky:
    /// [`with_light`](Self::with_light).
    ///
    /// What is given per frame or step is the host's: radii of diffuse particles, [`Shore::bias`], gravity of
    /// [`HeapSettings`](crate::bubbles::HeapSettings) and [`GenerateSettings`], and
    /// [`FoamSettings::weber_in`].
    pub fn new(spacing: f32, units_per_metre: f32) -> Self {
        let mut settings = Self::default();
        settings.water.spacing = spacing;
        settings.water.medium = settings.water.medium.thinned(1.0 / units_per_metre);
        settings.foam = FoamLook::of_spacing(spacing);
        settings.diffuse = DiffuseLook::of_spacing(spacing);
        settings.bubbles.hand_over.near *= units_per_metre;
        settings.bubbles.hand_over.far *= units_per_metre;
        settings.shore = settings.shore.in_units(units_per_metre);
        settings
    }

    /// With another light: [`Light::of`] the sky, or what the host reckons of its own.
    #[must_use]
    pub fn with_light(self, light: Light) -> Self {
        Self { light, ..self }
    }

    /// With another direction up, of any length but 0; its environment's says the same.
    #[must_use]
    pub fn with_up(self, up: [f32; 3]) -> Self {
        Self { up, ..self }
    }

    /// The look of the thesis' demo (Bagar 2010) for particles of a spacing: its composite, colours, unit of the
    /// thickness, foam, spray and light on foam. With it go [`Rule::Source`](crate::water::Rule) of [`Config::rule`],
    /// [`Config::sheets`] of 1, [`Config::mirror_steps`] of 0, [`Config::exit`] of [`Exit::Straight`],
    /// [`Config::kernels`] of [`Kernels::Spheres`], [`Config::cast`] of `None` and [`Shadows::Convolution`](crate::water::Shadows).
    pub fn thesis(spacing: f32) -> Self {
        Self {
            water: WaterSettings::thesis(spacing),
            foam: FoamLook::thesis(spacing),
            spray: SprayLook::SOURCE,
            diffuse: DiffuseLook::of_spacing(spacing),
            light: Light::default().thesis(),
            ..Self::default()
        }
    }

    /// [`up`](Self::up) at unit length.
    pub(crate) fn upward(&self) -> Vec3 {
        Vec3::from(self.up).normalize_or(Vec3::Y)
    }
}

impl Light {
    /// The same with shade as the thesis has it on foam, 0.6 of the light in the sun (Listing A.20).
    pub fn thesis(self) -> Self {
        Self { shade: self.irradiance.map(|c| 0.6 * c), ..self }
    }
}

/// The sun, and the light of the sky as the water's scattering sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Light {
    /// World direction to the sun, of any length but 0.
    pub direction: [f32; 3],
    /// Radiance factor of its highlight, linear RGB, [0, ∞).
    pub color: [f32; 3],
    /// Mean radiance of the environment, linear RGB, [0, ∞): lights what the water scatters.
    pub ambient: [f32; 3],
    /// Irradiance of level ground under sun and sky, linear RGB, [0, ∞): lights foam and spray.
    pub irradiance: [f32; 3],
    /// The same where the sun does not come, linear RGB, [0, ∞).
    pub shade: [f32; 3],
}

/// That of the default [`Sky`](crate::Sky), as [`Light::of`] reckons it.
impl Default for Light {
    fn default() -> Self {
        Self {
            direction: [0.408_248_3, 0.816_496_6, 0.408_248_3],
            color: [3.340_192, 3.173_182_4, 2.839_163_2],
            ambient: [0.822_677_5, 0.823_987_4, 0.802_816],
            irradiance: [15.623_868, 15.215_034, 13.950_685],
            shade: [4.351_36, 4.530_953, 4.800_174],
        }
    }
}

impl Light {
    /// The direction to the sun, of unit length: also of one whose square is beyond single precision.
    pub(crate) fn toward(&self) -> Vec3 {
        Vec3::from(self.direction).as_dvec3().normalize_or(DVec3::Y).as_vec3()
    }
}

/// An intermediate image after a record; the host may read it until the next record.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Layer {
    /// Name as in the EXR files of the tool, `water.depth` for `water.depth.Z`, `motion` for
    /// `motion.X` and `motion.Y`. `water.thickness` has a second channel with [`Config::foam`]: what of it is before the
    /// frontmost foam. With [`Config::sheets`] of 2 there is `water.thickness.sheets`: of
    /// the front sheet, of the back sheet, of the window between them. A texel of `water.iterations` is 32 bits: the
    /// iterations planned for it are the low nine, the size of their steps the other 23, in parts of the largest there
    /// is.
    pub name: &'static str,
    /// The image; transfer source usage.
    pub image: vk::Image,
    /// A view of it.
    pub view: vk::ImageView,
    /// Its format.
    pub format: vk::Format,
    /// Its size; may be a reduced one. `water.surface` and `water.iterations`: of the configured
    /// level; what is near is smoothed coarser, there and for the back sheet [`Recorded::levels`] says
    /// what lies where.
    pub extent: vk::Extent2D,
    /// Its state after `record`.
    pub access: Access,
}

/// What a record left behind.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Recorded {
    /// The kept layers: all of them with [`Config::keep_layers`], `motion` with [`Config::motion`].
    pub layers: Vec<Layer>,
    /// With [`Smoothing::Query`]: a buffer of that many `u32`, the samples still active in
    /// iterations 5, 10, …, for blocks that ran (0 for others; the last block is not counted).
    /// Transfer source; last written by a transfer.
    pub active_samples: Option<(vk::Buffer, u32)>,
    /// What became of the particles.
    pub counts: Option<ParticleCounts>,
    /// At which resolutions the frame was smoothed.
    pub levels: Option<SmoothingLevels>,
    /// A buffer of 259 times four `u32`, the work of the smoothing: in the first the second word is
    /// how many 16×16 tiles (of its texels, of all levels) hold water; the fourth word of
    /// number i, 1 to 257, how many iteration i runs over. Transfer source; last written by a compute
    /// shader, read as indirect arguments.
    pub tiles: Option<vk::Buffer>,
    /// With [`Config::sheets`] of 2: a buffer of one `f32` for each texel of the frame's thickness,
    /// row by row, the eye depth between the two sheets; 1e10 where there is but one. Transfer
    /// source; last written by a compute shader, read by compute and fragment shaders.
    pub sheets: Option<vk::Buffer>,
    /// With [`Kernels::Ellipsoids`]: a buffer of 24 bytes for each particle of the frame: where it is drawn (3×f32, world), and
    /// the symmetric matrix that takes a ball of its radius to its ellipsoid, six numbers as signed fractions of 4 in 16
    /// bits: xx, yy, zz, yz, xz, xy. Transfer source; last written by a compute shader, read by one.
    pub shapes: Option<vk::Buffer>,
    /// With [`Config::bubbles`]: a buffer of that many `u32` for each pixel of the frame, row by row: of each layer from
    /// the front on 256 times the blob's place in the streams and its bubble, 0xffff_ffff of none; then the bits of the
    /// most opacity (f32). Transfer source; last written by a compute shader, read by one.
    pub bubbles: Option<(vk::Buffer, u32)>,
    /// With [`Config::bubbles`]: a buffer of five `u32`, what became of the blobs: bits of the eye depth at which the
    /// first begins and of that at which the last does (f32), how many are on the screen, how many are no balls (not
    /// finite, no radius) and left out, how many places the tiles' lists take
    /// ([`BubbleSort::Tiles`](crate::bubbles::BubbleSort::Tiles)). Transfer source; last written by a compute shader,
    /// read by compute shaders.
    pub blobs: Option<vk::Buffer>,
}

/// Where the levels of the smoothing lie in the images `water.surface` and `water.iterations`, and how near
/// what each shows is.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SmoothingLevels {
    /// Four of the front sheet, each half of the one before, then three of the back sheet from the second on; of
    /// those that are not used all is 0. A texel of a coarser one holds something where its level shows near by,
    /// round that it is empty (1e10), farther away it may be of a frame before.
    pub level: [SmoothingLevel; 7],
    /// Size of the images, tiles a row, levels coarser than the first.
    pub atlas: [i32; 4],
    /// Iterations of the first level at depth 1 on the axis over a quarter of the cap; what a pixel is wide by what it
    /// is high, squared; most difference of depth on one surface in metres; 0.
    pub near: [f32; 4],
}

/// Where one of them lies, and what its texels are.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SmoothingLevel {
    /// First texel (x, y) and size, in texels.
    pub rect: [i32; 4],
    /// From a point of the level (texel centres at +0.5) to the slope of its ray: scale, offset.
    pub slope: [f32; 4],
    /// World size of a texel per depth in x and y; its edge in pixels of the output; 0.
    pub texel: [f32; 4],
}

impl SmoothingLevels {
    /// Which of the front sheet's levels a point at an eye depth and with the slope of its ray shows, and
    /// how far the next one has faded in, 0 to 1. The back sheet shows the same, at least the second.
    pub fn shown(&self, depth: f32, slope: [f32; 2]) -> (usize, f32) {
        let [iterations, shape, ..] = self.near;
        let foreshortened = 1.0 + slope[0].powi(2) + (1.0 + slope[1].powi(2)) * shape;
        let doubled = (iterations * foreshortened / (depth * depth)).max(1.0).log2();
        let level = (0.5 * doubled).floor();
        let part = (doubled - 2.0 * level).min(1.0);
        let coarsest = self.atlas[3] as usize;
        match part * part * (3.0 - 2.0 * part) {
            _ if level as usize >= coarsest => (coarsest, 0.0),
            1.0 => (level as usize + 1, 0.0),
            fade => (level as usize, fade),
        }
    }
}

/// Buffers that say what became of the particles, 256 bytes for each of `chunks`: word 0 and 5 are
/// the small and the large sprites, word 18 the particles dropped for NaN or infinite positions,
/// word 19 those set aside as spray (0 in `front`). Transfer source; last written by a compute
/// shader, read as indirect arguments.
#[derive(Clone, Copy, Debug)]
pub struct ParticleCounts {
    /// Particles on the screen.
    pub all: vk::Buffer,
    /// Those that can show; depth was splatted from them.
    pub front: vk::Buffer,
    /// Number of chunks.
    pub chunks: u32,
}

/// Device memory in use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MemoryUse {
    /// Bytes of images; depends on the extent and the levels.
    pub images: u64,
    /// Bytes of buffers; depends on the most particles.
    pub buffers: u64,
}
