//! The public types that host and library exchange, in the order of use: configuration of a renderer ([`Host`],
//! [`EnabledFeatures`], [`Config`]); inputs of a frame ([`Frame`] and its parts [`HostImage`], [`Particles`],
//! [`Camera`], [`Previous`], [`Settings`]) and of a foam step ([`SurfaceFoamStep`]); results of a call of `record`
//! ([`Recorded`], [`Layer`], [`MemoryUse`]).
//!
//! The types only carry data: the module `check` validates a frame, and the module `frame` derives the shaders'
//! uniform values from it.

use std::sync::Arc;

use ash::vk;
use glam::{DVec3, Mat4, Vec3, Vec4};

use crate::bubbles::settings::{BubbleConfig, BubbleSettings};
use crate::diagnostics::Diagnostics;
use crate::error::Error;
use crate::frame::level_axes;
pub use crate::gpu::access::Access;
use crate::gpu::memory::Allocate;
use crate::shore::settings::{ShoreConfig, ShoreSettings};
use crate::water::panes::Pane;
use crate::water::settings::{
    DebugView, Exit, Kernels, Rule, Shading, ShadowFilter, Shadows, Smoothing, Splat,
    SpraySettings, SurfaceFoamSettings, SurfaceNoiseSettings, WaterSettings, WeberSettings,
};
use crate::whitewater::generate::settings::GeneratorSettings;
use crate::whitewater::settings::{WhitewaterConfig, WhitewaterSettings};

/// Adds `value.with(|it| it.field = ..)` to structs that may grow.
macro_rules! with {
    ($($name:ty),+ $(,)?) => {$(
        impl $name {
            /// Returns the value with a change applied. It replaces struct-update syntax (`..other`), which Rust does
            /// not allow for structs that may get more fields: `Config::new(..).with(|it| it.surface_foam = true)`.
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
    EnabledFeatures,
    Config,
    HostImage,
    Particles,
    WhitewaterParticles,
    Blobs,
    Shore,
    SurfaceFoamStep<'_>,
    GeneratorStep<'_>,
    Shadow,
    Frame<'_>,
    Settings,
    Light,
);

/// The host's Vulkan objects, for [`Context::new`](crate::Context::new). All have to outlive the context and
/// everything created from it. The library owns none of them.
#[non_exhaustive]
pub struct Host<'a> {
    /// The instance.
    pub instance: &'a ash::Instance,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// A device of Vulkan 1.2 or newer that meets [`requirements`](crate::requirements). Its instance was also
    /// created for Vulkan 1.2 or newer.
    pub device: &'a ash::Device,
    /// Allocator of device memory. It is called only in construction, `reconfigure`, `resize`, `collect`, `abandon`
    /// (which collects) and `destroy`. An allocator usually has to be dropped before the device is destroyed. `Host`
    /// and the context share it, so it can be dropped only after both, and the context lives on until everything made
    /// from it is destroyed. With `None` the context creates an allocator of its own, which is dropped together with
    /// the context.
    pub allocator: Option<Arc<dyn Allocate>>,
    /// Index of a queue family that supports graphics and compute. Every command buffer that the host hands in
    /// belongs to this family.
    pub queue_family: u32,
    /// Number of frames in flight, 1 to 8. Slots are the numbers from 0 to `frames_in_flight - 1`.
    pub frames_in_flight: u32,
    /// Optional features that the host enabled on the device.
    pub enabled: EnabledFeatures,
    /// A pipeline cache, or null.
    pub pipeline_cache: vk::PipelineCache,
}

impl<'a> Host<'a> {
    /// A host without optional features (see [`with_enabled`](Self::with_enabled)), without an allocator of its
    /// own (see [`with_allocator`](Self::with_allocator)) and without a pipeline cache (see
    /// [`with_pipeline_cache`](Self::with_pipeline_cache)).
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
            enabled: EnabledFeatures::default(),
            pipeline_cache: vk::PipelineCache::null(),
        }
    }

    /// Sets the optional features and extensions that are enabled on the device.
    #[must_use]
    pub fn with_enabled(self, enabled: EnabledFeatures) -> Self {
        Self { enabled, ..self }
    }

    /// Sets the host's allocator.
    #[must_use]
    pub fn with_allocator(self, allocator: Arc<dyn Allocate>) -> Self {
        Self { allocator: Some(allocator), ..self }
    }

    /// Sets a pipeline cache of the device.
    #[must_use]
    pub fn with_pipeline_cache(self, pipeline_cache: vk::PipelineCache) -> Self {
        Self { pipeline_cache, ..self }
    }
}

/// Optional Vulkan features and extensions that the host enabled on its device; by default none. Without one of them
/// an implementation or an option that needs it is unavailable. The picture stays correct.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct EnabledFeatures {
    /// `synchronization2` of Vulkan 1.3 or VK_KHR_synchronization2: each barrier has pipeline stages of its own.
    /// Without it the library records barriers of Vulkan 1.0, which wait for slightly more work; the picture is the
    /// same.
    pub synchronization2: bool,
    /// `shaderStorageImageWriteWithoutFormat`: shaders may write a storage image without declaring its format.
    /// [`Config::surface_foam`], [`Config::motion`], [`Shadows::Convolution`] and [`Shading::Compute`] need it, but
    /// only on a device created for Vulkan 1.2. In Vulkan 1.3 it depends on the format alone, not on this feature,
    /// whether such writes are supported.
    pub storage_image_write_without_format: bool,
    /// VK_EXT_debug_utils on the instance: names and labels.
    pub debug_utils: bool,
    /// VK_EXT_conditional_rendering with `conditionalRendering`.
    pub conditional_rendering: bool,
    /// Vulkan 1.2 `drawIndirectCount`.
    pub draw_indirect_count: bool,
    /// `largePoints`. Without it the raster splats draw quads only.
    pub large_points: bool,
    /// `occlusionQueryPrecise`, for `Smoothing::Query` (feature `diagnostics`). Without it an occlusion query only
    /// tells whether there are any samples. That is enough to decide when the smoothing ends, but the numbers in
    /// `Diagnostics::active_samples` are then not exact.
    pub precise_occlusion_queries: bool,
    /// Vulkan 1.2 `shaderBufferInt64Atomics`, with `shaderInt64`. Without them whitewater is drawn in two passes over
    /// its particles instead of one.
    pub buffer_int64_atomics: bool,
}

/// Configuration of a renderer. It determines what memory and which pipelines are created.
/// [`reconfigure`](crate::Renderer::reconfigure) changes it between two calls of `record`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Config {
    /// Maximum width and height of a frame in pixels, each from 1 to the device's limit for 2D images, framebuffers
    /// and viewports. Images are allocated for this size; a frame may be smaller (the `rect` of the output,
    /// [`HostImage::rect`]).
    ///
    /// Large sizes can also exceed two other limits of a device;
    /// [`DeviceSupport::check`](crate::DeviceSupport::check) reports this. First, the smoothing has several
    /// resolutions, and one image holds all of them, beside or below each other. With a
    /// [`smoothing_level`](Self::smoothing_level) of 0 a square frame can therefore be at most two thirds of the
    /// image limit wide; a narrow one can be as long as the whole limit. Second, each of the following buffers is
    /// bound as a whole and has to fit in the storage-buffer range: with [`whitewater`](Self::whitewater) 32 bytes
    /// per pixel; with [`bubbles`](Self::bubbles) `4·layers + 4` bytes per pixel; for thickness 8 bytes per texel of
    /// its image, plus 8 with [`surface_foam`](Self::surface_foam), plus 16 with [`sheets`](Self::sheets) of 2; for
    /// surface foam itself up to 24 bytes per texel of its image.
    pub extent: vk::Extent2D,
    /// Format of the output, which is a colour attachment or a storage image, depending on
    /// [`composite`](Self::composite).
    pub output_format: vk::Format,
    /// Maximum number of particles per frame, at least 1.
    pub max_particles: u32,
    /// Maximum stride of the streams of [`Particles`] in bytes, a multiple of 4 (default 16). The device's
    /// storage-buffer range divided by this stride limits how many particles are processed at a time.
    pub max_stride: u32,
    /// Resolution of the smoothing: 0 full, 1 half (default), 2 quarter.
    pub smoothing_level: u32,
    /// Resolution of the images of water thickness and surface foam: 0 full, 1 half, 2 quarter (default), 3 eighth. A
    /// pixel interpolates the thickness only between those texels around it that show its own surface (between all
    /// four if none does), and foam only between texels whose foam the scene does not hide.
    pub thickness_level: u32,
    /// How the particles' depth is rasterized. With `None`: [`Splat::Compute`] on every device. With
    /// [`Splat::Raster`] the pass `depth` took 0.9 to 3.9 times as long as with [`Splat::Compute`] on lavapipe (a CPU
    /// driver); this ratio grows with the number of particles. On an H200 it took three times as long.
    #[cfg(feature = "diagnostics")]
    pub depth_splat: Option<Splat>,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) depth_splat: Option<Splat>,
    /// How the particles' thickness and surface foam are rasterized. With `None`: [`Splat::Compute`], independent of
    /// `depth_splat`.
    #[cfg(feature = "diagnostics")]
    pub thickness_splat: Option<Splat>,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) thickness_splat: Option<Splat>,
    /// Implementation of the smoothing. `None`: [`Smoothing::Tiles`] on CPUs, where it was measured fastest,
    /// [`Smoothing::Fused`] on GPUs (on an H200 it takes half the time of `Tiles`).
    #[cfg(feature = "diagnostics")]
    pub smoothing: Option<Smoothing>,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) smoothing: Option<Smoothing>,
    /// How water is shaded. With `None`: [`Shading::Raster`] on every device. GPUs built for computing rasterize
    /// slowly; on them [`Shading::Compute`] is faster (14 times on an H200). It writes the output as a storage image,
    /// so the output needs storage usage, and its format has to support storing without a format qualifier in the
    /// shader. R16G16B16A16_SFLOAT nearly always supports this, sRGB formats do not;
    /// [`DeviceSupport::output_storage`](crate::DeviceSupport) reports whether a format does.
    pub composite: Option<Shading>,
    /// Number of steps of the screen-space ray march that finds which part of the scene water reflects, 0 to 64,
    /// default 8. The first step is a 128th of the picture's height long. Each further step multiplies the distance
    /// from the ray's start by a factor that is constant along a ray, so that the last step ends where the ray leaves
    /// the picture, at the latest (8 steps across the whole width of a 16:9 picture: 2.2). A ray that hits nothing on
    /// the screen shows the environment. With 0 steps, as in the thesis, and with `Compositing::Source` (feature
    /// `diagnostics`), water reflects only the environment.
    pub mirror_steps: u32,
    /// How the view through water that has air behind it, such as a jet or a drop, is computed. Default
    /// [`Exit::TwoInterfaces`]. With [`Exit::Straight`] the pass `composite` is a fifth faster (lavapipe, a splash in
    /// a pool).
    pub exit: Exit,
    /// Shape that each particle is drawn as. Default [`Kernels::Spheres`]. [`Kernels::Ellipsoids`], which the pass
    /// `shape` fits, make thin water look like one body instead of separate balls. They take 108 to 112 more bytes
    /// per particle (the number of buckets of the neighbour grid is a power of two), plus 8 with `surface_foam`, plus
    /// 4 with `spray`. One buffer, of 40 bytes per particle, has to fit in the storage-buffer range. At 1280×720 with
    /// 27 000 particles (lavapipe) a frame of water alone takes 1.4 times as long as with spheres, one with surface
    /// foam, spray, shadows and caustics 1.15 times. With an [`Ellipsoids::reach`](crate::water::Ellipsoids) of 2 and
    /// [`Ellipsoids::centred`](crate::water::Ellipsoids) of 0 these factors are 1.2 and 1.0. They grow with the
    /// number of particles.
    pub kernels: Kernels,
    /// Iteration rule of the smoothing.
    #[cfg(feature = "diagnostics")]
    pub rule: Rule,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) rule: Rule,
    /// Maximum number of smoothing iterations, 1 to 256 (default 256, as in the thesis).
    pub max_iterations: u32,
    /// Number of additional smoothing resolutions (levels), each half of the one before, for water near the camera: 0
    /// to 3 (default 3). Near water needs more iterations than [`max_iterations`](Self::max_iterations) allows; at
    /// half the resolution it needs a quarter of them. Without levels, water nearer than a certain distance is smoothed
    /// too little. Each level halves this distance, so 3 levels reduce it to an eighth. Each pixel selects its level by
    /// the distance of its water, and blends between two levels. With another rule than constant width (the default)
    /// the levels have no effect. 0 saves up to a third of the smoothing's memory.
    pub coarsening: u32,
    /// Maximum number of layers of water (sheets) in a pixel: 1 as in the thesis, or 2 (default). With 2, water that
    /// stands in front of other water with air between, such as a drop in front of a pool, is a layer of its own.
    /// Each layer then has its own thickness, and the back layer has its own surface where the front layer covers it.
    /// Air more than 32 spacings behind the nearest water of a cell of 8×8 pixels is not found.
    /// With 1 the passes `gaps` and `back` do not exist.
    pub sheets: u32,
    /// Whether the pass `surface_foam` draws surface foam (default false). Particles of the water turn into this
    /// foam, each of them partly or wholly. The part of a particle that is foam no longer counts as water. Surface
    /// foam takes 68 more bytes of GPU memory per particle, and 52 per texel of its images (56 with a light map or a
    /// shadow map), whose resolution is [`thickness_level`](Self::thickness_level). The memory of a
    /// [`SurfaceFoamState`](crate::SurfaceFoamState) comes in addition.
    pub surface_foam: bool,
    /// Whether the pass `spray` draws particles of low density as droplets and mist (default false). A particle below
    /// [`SpraySettings::all_spray_density`] is only spray, one above
    /// [`no_spray_density`](SpraySettings::no_spray_density) is no spray; in between the share of spray falls
    /// gradually. For water and surface foam, [`all_spray_density`](SpraySettings::all_spray_density) then replaces
    /// [`WaterSettings::density_threshold`], and [`full_water_density`](SpraySettings::full_water_density) replaces
    /// [`density_full`](WaterSettings::density_full): between these two densities a particle's water shrinks and its
    /// surface foam fades out. Spray takes 48 more bytes of GPU memory per particle, and 8 per pixel.
    pub spray: bool,
    /// Whether whitewater is drawn (spray, foam and bubbles that are particles of their own, [`Frame::whitewater`]):
    /// the passes `splat`, `radiance`, `blur`. With `None`, the default, it is not drawn. It takes 88 more bytes of
    /// GPU memory per pixel of [`extent`](Self::extent).
    pub whitewater: Option<WhitewaterConfig>,
    /// Whether blobs of bubble foam (balls of soap bubbles) are drawn ([`Frame::bubbles`]): the passes `blobs`,
    /// `peel` and `soap`; also `cast` if [`light_map_size`](Self::light_map_size) is set, and `near` if the blobs are
    /// made from whitewater foam ([`BubbleConfig::crossfade`]). With `None`, the default, they are not drawn. Bubble
    /// foam takes `18½ + 4·layers` more bytes of GPU memory per pixel ([`BubbleConfig::layers`]), and 64 bytes, or
    /// 100 with `crossfade`, for each of the `max_blobs` blobs.
    pub bubbles: Option<BubbleConfig>,
    /// Whether shoreline and contact foam are drawn ([`Frame::shore`]): the passes `shore-tiles`, `shoreline` and
    /// `contact`. With `None`, the default, they are not drawn. They take 4 more bytes of GPU memory per pixel, and
    /// 8.7 MiB for the textures of the default size.
    pub shore: Option<ShoreConfig>,
    /// Resolution at which the pass `noise` draws ripples finer than the particles ([`Settings::noise`]): 0 full, 1
    /// half, 2 quarter, 3 eighth. With `None`, the default, there are no such ripples. They take 16 more bytes per
    /// particle, and 4 per texel at this resolution.
    pub noise: Option<u32>,
    /// Whether the host hands in a shadow map or mask ([`Frame::shadow`]), and how the map is filtered. With `None`,
    /// the default, the scene casts no shadow on water and foam.
    pub shadow: Option<Shadows>,
    /// Whether water and foam cast shadows and caustics on the scene, and foam casts shadows on itself: the passes
    /// `light`, `caustics` and `lit`. The value is the side length in texels of the light maps, which show
    /// [`Frame::light_volume`] as seen from the sun: a multiple of 16 from 16 to 4096. The maps take 36 bytes per
    /// texel, in addition to a lit copy of the scene. With [`whitewater`](Self::whitewater) whitewater also casts
    /// shadows on the scene, the water, foam and itself, in the pass `whitewater_light`, which takes 24 more bytes
    /// per texel. With [`bubbles`](Self::bubbles) blobs also cast shadows on the scene, on foam and on each other, in
    /// the pass `cast`, which takes one more byte per texel. A texel of half a particle spacing, so 4 · radius /
    /// spacing texels a side, shows all that the particles resolve. With `None`, the default, there are no shadows or
    /// caustics.
    pub light_map_size: Option<u32>,
    /// Whether motion vectors are rendered (default false): the pass `motion` and the layer `motion`, from
    /// [`Frame::previous`] and the particles' velocities. They take 12.5 more bytes per pixel with the default
    /// [`thickness_level`](Self::thickness_level) of 2 (48 with level 0, 26 with 1, 9.1 with 3).
    pub motion: bool,
    /// Side length of a face of the environment cube in texels, a power of two from 16 to 2048 (default 256).
    pub environment_size: u32,
    /// Whether the output may also be the image that holds the scene behind the water (default true). If it is, the
    /// library copies the scene before it writes the output, for which the output needs transfer-source usage. With
    /// [`light_map_size`](Self::light_map_size) the library samples the scene instead of copying it, for which the
    /// output needs sampled usage.
    pub in_place: bool,
    /// Whether the images of intermediate layers can be read by the host after `record` (default false).
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
            surface_foam: false,
            spray: false,
            whitewater: None,
            bubbles: None,
            shore: None,
            noise: None,
            shadow: None,
            light_map_size: None,
            motion: false,
            environment_size: 256,
            in_place: true,
            keep_layers: false,
        }
    }
}

/// A frame in flight: an index below `frames_in_flight`. By passing a slot to an object, the host promises that the GPU
/// work which this object recorded earlier with the same slot is complete. Each object has slots of its own: a step and
/// the frame that shows it may have the same slot and command buffer. Two steps of one object in a command buffer need
/// two slots, so a host with n steps per frame asks for n times as many
/// ([`Context::with_frames_in_flight`](crate::Context::with_frames_in_flight)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot(pub u32);

/// An image of the host, with two states that the host chooses: the one in which it hands the image to `record`, and
/// the one in which the recorded commands leave the image.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct HostImage {
    /// The image: single-sampled and 2D. An image that is read needs sampled usage; a depth image also needs
    /// attachment usage, because its read-only layout requires it. An output needs colour-attachment usage, or storage
    /// usage with `Shading::Compute`. An output that is also the scene ([`Config::in_place`]) needs transfer-source
    /// usage in addition, or, with [`Config::light_map_size`], sampled usage.
    pub image: vk::Image,
    /// A 2D view of its first mip and layer; for depth-stencil images a view of only the depth aspect.
    pub view: vk::ImageView,
    /// Format of the view.
    pub format: vk::Format,
    /// All aspects of the image (barriers cover them all).
    pub aspect: vk::ImageAspectFlags,
    /// Size in texels.
    pub extent: vk::Extent2D,
    /// The part of the image that is used: the whole image, the part of one view in an image of several views, or a
    /// part whose size changes from frame to frame. Barriers cover the whole image.
    pub rect: vk::Rect2D,
    /// The host's last use of the image before the commands that `record` records: the stages and accesses to wait
    /// for, and the layout that the image then has. The layout `UNDEFINED` is refused.
    pub before: Access,
    /// First use after `record`, with the layout in which `record` leaves the image.
    pub after: Access,
}

impl HostImage {
    /// An image that is used at its full size ([`rect`](Self::rect)) and returned in the state in which it was
    /// passed. The aspects follow from the format.
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

    /// Restricts the view to a part of the image.
    #[must_use]
    pub fn with_rect(self, rect: vk::Rect2D) -> Self {
        Self { rect, ..self }
    }

    /// Sets the state in which the image is returned.
    #[must_use]
    pub fn with_after(self, after: Access) -> Self {
        Self { after, ..self }
    }
}

/// The aspects of a format.
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

/// One attribute of all particles in a buffer: the value of particle i begins at byte `offset + i·stride`. Several
/// streams may share a buffer (interleaved) or have one each. Components are little-endian 32-bit values, aligned to
/// 4 bytes.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    /// A buffer with storage usage.
    pub buffer: vk::Buffer,
    /// Size of the whole buffer in bytes.
    pub size: u64,
    /// Byte offset of the first particle's value, a multiple of 4.
    pub offset: u64,
    /// Bytes from one particle's value to the next, a multiple of 4. For [`Particles`] the maximum is
    /// [`Config::max_stride`]. For [`WhitewaterParticles`], [`SurfaceFoamStep`] and [`GeneratorStep`] it is the
    /// `max_stride` of their own configuration. For [`Blobs`], [`Triangles`] and [`Strip`] there is no such maximum,
    /// but the device must be able to bind the whole stream (of blobs, one with as many values as the configured
    /// maximum).
    pub stride: u32,
}

impl Stream {
    /// Validates the stream for values of `bytes` bytes.
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
                "expected multiples of 4 and a stride of at least {bytes}, found stride {stride} and offset {offset}"
            );
            return Err(Error::bad(field, why));
        }
        if stride > max_stride {
            return Err(Error::bad(
                field,
                format!("stride {stride} is more than {most}, {max_stride}"),
            ));
        }
        // The last particle needs only its value, not a full stride.
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

/// The number of particles or blobs. Its maximum is in the configuration of the object that reads them, for example
/// [`Config::max_particles`].
#[derive(Clone, Copy, Debug)]
pub enum Count {
    /// Known to the host. A number above the maximum is an error.
    Cpu(u32),
    /// A `u32` in a buffer with storage usage, read on the GPU and clamped to the maximum.
    Gpu {
        /// The buffer.
        buffer: vk::Buffer,
        /// Byte offset, a multiple of the device's minStorageBufferOffsetAlignment.
        offset: u64,
    },
}

/// Packets: the host's own groups of consecutive particles, each culled as a whole. The buffer holds `count` records
/// of 32 bytes: first particle (u32), number of particles (u32), minimum and maximum corner of the box around the
/// particles' centres (3×f32 each, world space). A particle may be in at most one packet. Particles in no packet are
/// not drawn and cast no shadow. Packets outside the view are not drawn, but their particles still cast shadows into
/// it.
#[derive(Clone, Copy, Debug)]
pub struct Packets {
    /// A buffer with storage usage.
    pub buffer: vk::Buffer,
    /// Byte offset, a multiple of the device's minStorageBufferOffsetAlignment.
    pub offset: u64,
    /// Number of packets, at most 65 535.
    pub count: u32,
}

/// The particles of one frame. The library only reads them.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Particles {
    /// World-space centres (3×f32, scene units). Particles with a coordinate that is NaN, infinite or at least 1e18
    /// in magnitude are dropped and counted.
    pub positions: Stream,
    /// SPH densities (f32), (0, ∞). 0, negative values and NaN mean that no density is known yet, as for a particle
    /// that was just emitted: such a particle is full water or foam, and not spray. With `None` this applies to all
    /// particles.
    pub densities: Option<Stream>,
    /// World velocities (3×f32, scene units per second), along which foam and spray are stretched, and for motion
    /// vectors. Read only with [`Config::surface_foam`], [`Config::spray`] or [`Config::motion`]. With `None` the
    /// particles are at rest.
    pub velocities: Option<Stream>,
    /// Ids that identify particles from frame to frame (u32), for the noise in foam and the droplets of spray. Read
    /// only with [`Config::surface_foam`] or [`Config::spray`], and with [`Config::noise`] for
    /// the surface noise. With `None` the index is used.
    pub ids: Option<Stream>,
    /// Number of particles.
    pub count: Count,
    /// Groups that are culled as a whole before their particles are culled one by one. `None`: no groups.
    pub packets: Option<Packets>,
    /// Foam amount (0 water to 1 foam; NaN: water) and age (seconds) of each particle, 2×f32, as
    /// [`SurfaceFoamState::foam`](crate::SurfaceFoamState::foam) returns them. Without [`Config::surface_foam`] it has
    /// to be `None`. With `None` there is no foam.
    pub surface_foam: Option<Stream>,
    /// Last use of the buffers of these water particles on the GPU, before the commands that `record` records. One
    /// value holds for all of these buffers; its layout is ignored. Use [`access::NOTHING`](crate::access::NOTHING)
    /// for buffers that the CPU wrote before the submission.
    pub before: Access,
    /// First use of these buffers after `record` (layout ignored).
    pub after: Access,
}

impl Particles {
    /// Particles with only positions, in buffers that the CPU wrote before the submission. `record` then waits for no
    /// earlier use of them on the GPU, and makes no later use wait.
    pub fn new(positions: Stream, count: Count) -> Self {
        Self {
            positions,
            densities: None,
            velocities: None,
            ids: None,
            count,
            packets: None,
            surface_foam: None,
            before: crate::gpu::access::NOTHING,
            after: crate::gpu::access::NOTHING,
        }
    }

    /// Adds densities.
    #[must_use]
    pub fn with_densities(self, densities: Stream) -> Self {
        Self { densities: Some(densities), ..self }
    }

    /// Adds velocities.
    #[must_use]
    pub fn with_velocities(self, velocities: Stream) -> Self {
        Self { velocities: Some(velocities), ..self }
    }

    /// Adds ids that identify particles from frame to frame.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// Adds packets for culling.
    #[must_use]
    pub fn with_packets(self, packets: Packets) -> Self {
        Self { packets: Some(packets), ..self }
    }

    /// Adds foam amount and age of each particle, as [`SurfaceFoamState::foam`](crate::SurfaceFoamState::foam) returns
    /// them.
    #[must_use]
    pub fn with_surface_foam(self, foam: Stream) -> Self {
        Self { surface_foam: Some(foam), ..self }
    }

    /// Sets the last use of the water particles' buffers before `record`, and their first use after it.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// The whitewater particles of one frame: spray, foam on the surface and bubbles below it (Ihmsen et al. 2012). The
/// library only reads them.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct WhitewaterParticles {
    /// World-space centres (3×f32, scene units). NaN, infinite and huge ones are not drawn.
    pub positions: Stream,
    /// Kind of each particle (u32): 0 foam, 1 spray, 2 bubble. `None`: all are foam.
    pub kinds: Option<Stream>,
    /// Radii of the whitewater particles (f32, scene units, (0, ∞)), before [`WhitewaterSettings::sizes`] and
    /// [`bubble_size`](WhitewaterSettings::bubble_size) reduce them. With `None`, and for radii that are 0, negative or
    /// not finite, [`WhitewaterSettings::radius`] is used.
    pub radii: Option<Stream>,
    /// Relative age (f32), 0 new to 1 gone. Particles of 1 or more are not drawn. `None`: all are new.
    pub ages: Option<Stream>,
    /// Ids that identify whitewater particles from frame to frame (u32), for the variation of sizes. With `None` the
    /// index is used.
    pub ids: Option<Stream>,
    /// Number of particles.
    pub count: Count,
    /// Packets (groups with bounding boxes) of these particles; they need
    /// [`WhitewaterConfig::packets`](crate::whitewater::WhitewaterConfig::packets). Particles of a packet outside the
    /// view are not read, nor, for shadows, those of a packet outside the light's maps. If the particles have
    /// [`radii`](Self::radii), the boxes have to enclose the spheres, otherwise the centres. `WhitewaterSplat::Raster`
    /// (feature `diagnostics`) and [`BubbleConfig::crossfade`] ignore the packets: they read, and draw, particles
    /// whether they are in a packet or not. With `None` each particle is culled on its own.
    pub packets: Option<Packets>,
    /// Depth image of a fluid surface of the host, such as a sea, in the camera's depth convention. The water surface
    /// of a pixel is then the nearer of this one and the particles' water. The image may have any size and is sampled
    /// by compute shaders only; it must not be the image of the scene's depth. Whitewater behind this surface is
    /// visible only with [`Submerged::Falloff`](crate::whitewater::Submerged::Falloff), because the library does not
    /// know how much light the host's water absorbs. With `None` the particles' water is the only surface.
    pub fluid_depth: Option<HostImage>,
    /// Last use of all these buffers before `record` (layout ignored).
    pub before: Access,
    /// First use of these buffers after `record` (layout ignored).
    pub after: Access,
}

impl WhitewaterParticles {
    /// Whitewater particles that are all foam, with only positions, in buffers that the CPU wrote before the
    /// submission.
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

    /// Adds the kind of each particle.
    #[must_use]
    pub fn with_kinds(self, kinds: Stream) -> Self {
        Self { kinds: Some(kinds), ..self }
    }

    /// Adds radii.
    #[must_use]
    pub fn with_radii(self, radii: Stream) -> Self {
        Self { radii: Some(radii), ..self }
    }

    /// Adds relative ages.
    #[must_use]
    pub fn with_ages(self, ages: Stream) -> Self {
        Self { ages: Some(ages), ..self }
    }

    /// Adds ids that identify them from frame to frame.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// Sets the last use of the whitewater particles' buffers before `record`, and their first use after it.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// The blobs of bubble foam of one frame: balls of soap bubbles around a white core (Huszár, Szécsi). The library
/// only reads them.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Blobs {
    /// Centre (world space) and radius of each blob (4×f32). Entries with a number that is not finite or huge, or with
    /// a radius ≤ 0, are ignored.
    pub spheres: Stream,
    /// Orientation of each blob, from its own space to the world: quaternions (4×f32, the real part last), of any
    /// length from 1e-6 to 1e6. Others, such as zero, mean the identity. `None`: all are the identity.
    pub rotations: Option<Stream>,
    /// Ids that identify blobs from frame to frame (u32). A blob's id selects one of the precomputed variants and its
    /// soap films. With `None` the index is used.
    pub ids: Option<Stream>,
    /// Number of blobs.
    pub count: Count,
    /// Last use of all these buffers before `record` (layout ignored).
    pub before: Access,
    /// First use of these buffers after `record` (layout ignored).
    pub after: Access,
}

impl Blobs {
    /// Only spheres, in buffers that the CPU wrote before the submission.
    pub fn new(spheres: Stream, count: Count) -> Self {
        Self {
            spheres,
            rotations: None,
            ids: None,
            count,
            before: crate::gpu::access::NOTHING,
            after: crate::gpu::access::NOTHING,
        }
    }

    /// Adds rotations.
    #[must_use]
    pub fn with_rotations(self, rotations: Stream) -> Self {
        Self { rotations: Some(rotations), ..self }
    }

    /// Adds ids that identify them from frame to frame.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// Sets the last use of the blobs' buffers before `record`, and their first use after it.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// Shoreline and contact foam of one frame, an overlay on water. The library only reads it.
///
/// For shoreline and contact foam, the scene's depth image ([`Frame::scene_depth`]) should contain everything in and
/// below the water, but not the water's surface. If it contains the surface too, set [`bias`](Self::bias).
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Shore {
    /// The host's own water surface, which its scene already shows. With `None` foam is drawn only on the mesh of
    /// [`Shoreline::Strip`] and on the particles' water.
    pub surface: Option<Surface>,
    /// Where shores are. `None`: no shoreline foam. [`Shoreline::Map`] and [`Shoreline::Screen`] need a
    /// surface.
    pub shoreline: Option<Shoreline>,
    /// A single-channel mask over the view that suppresses contact foam: where it is 1 not at all, where it is 0 as
    /// strongly as [`ContactSettings::mask`](crate::shore::ContactSettings::mask) says. It may have any size and is
    /// only sampled. With `None` the foam texture, tiled over the world, takes its place.
    pub mask: Option<HostImage>,
    /// Depth bias in scene units, [0, 1000], default 0: scene geometry that lies at most this far in front of the
    /// host's water surface or strip does not hide shoreline foam. Increase it if the scene's depth contains the
    /// water's surface. Contact foam appears only where the geometry is not in front of the surface, whatever the bias.
    pub bias: f32,
}

impl Shore {
    /// Contact foam on a level water surface of the host.
    pub fn new(level: f32) -> Self {
        Self { surface: Some(Surface::Level(level)), shoreline: None, mask: None, bias: 0.0 }
    }

    /// Adds a shoreline.
    #[must_use]
    pub fn with_shoreline(self, shoreline: Shoreline) -> Self {
        Self { shoreline: Some(shoreline), ..self }
    }
}

/// A water surface of the host.
#[derive(Clone, Copy, Debug)]
pub enum Surface {
    /// A level surface at this height along [`Settings::up`].
    Level(f32),
    /// A water surface of any shape, as a depth image in the camera's depth convention. The image may have any size,
    /// is only sampled, and must not be the image of the scene's depth. Shoreline and contact foam treat the surface
    /// as locally level.
    Depth(HostImage),
}

/// Source of the shore coordinate v: 0 at the foam's seaward edge, 1 at the shore line, 2 at the foam's inland edge.
#[derive(Clone, Copy, Debug)]
pub enum Shoreline {
    /// A mesh of the host with v per vertex.
    Strip(Strip),
    /// Distances in the world, for islands that move or change.
    Map(ShoreDistances),
    /// An estimate from the depth images: the horizontal distance from the water's surface to the plane of the ground
    /// that is seen behind it. Shores that are hidden or off the screen have no foam.
    Screen,
}

/// Triangles of the host, three vertices each.
#[derive(Clone, Copy, Debug)]
pub struct Triangles {
    /// Vertices (3×f32).
    pub positions: Stream,
    /// Number of vertices.
    pub vertices: u32,
    /// Vertex indices (u32), and how many indices there are: a multiple of three. `None`: all vertices in order,
    /// three per triangle.
    pub indices: Option<(Stream, u32)>,
}

impl Triangles {
    /// Number of corners that are drawn.
    pub(crate) fn drawn(&self) -> u32 {
        self.indices.map_or(self.vertices, |(_, count)| count)
    }

    /// Validates that the buffers hold the vertices and indices, and that the number of corners is a multiple of
    /// three. For the error, the three names are those of the host's fields of vertices, indices and counts.
    pub(crate) fn check(
        &self,
        [positions, indices, count]: [&'static str; 3],
        limits: &vk::PhysicalDeviceLimits,
    ) -> Result<(), Error> {
        // Bound as a whole.
        let most =
            |count: u32| ("the device's limit", limits.max_storage_buffer_range / count.max(1));
        self.positions.check(positions, 12, self.vertices, most(self.vertices))?;
        if let Some((stream, n)) = &self.indices {
            stream.check(indices, 4, *n, most(*n))?;
        }
        if !self.drawn().is_multiple_of(3) {
            let why = format!("expected three for each triangle, found {}", self.drawn());
            return Err(Error::bad(count, why));
        }
        Ok(())
    }
}

/// A mesh of the host around islands, on which shoreline foam is drawn (*Semi-procedural foam shader*, Sec. IV).
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    /// The mesh, in world space.
    pub triangles: Triangles,
    /// Shore coordinate of each vertex (f32).
    pub coordinates: Stream,
    /// Last use of these buffers before `record` (layout ignored).
    pub before: Access,
    /// First use of these buffers after `record` (layout ignored).
    pub after: Access,
}

/// Distances to the shore, as returned by [`ShoreMap::shore_distances`](crate::shore::ShoreMap::shore_distances).
#[derive(Clone, Copy, Debug)]
pub struct ShoreDistances {
    pub(crate) view: vk::ImageView,
    /// The map of distances to the shore: its minimum corner and side length in scene units, and its number of texels
    /// along each axis.
    pub(crate) corner: [f32; 2],
    pub(crate) edge: f32,
    pub(crate) size: u32,
}

/// One simulation step, for [`SurfaceFoamState::record_step`](crate::SurfaceFoamState::record_step): the particles as
/// they are after the step, in any order. The library only reads them.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct SurfaceFoamStep<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// World-space velocities (3×f32, scene units per second).
    pub velocities: Stream,
    /// SPH densities (f32), (0, ∞). 0, negative values and NaN mean that no density is known yet, as for a particle
    /// that was just emitted: [`WeberSettings::rest_density`] is used. With `None` this applies to all particles.
    pub densities: Option<Stream>,
    /// Ids (u32), unique within a step and constant from step to step; gaps between them are allowed. If two
    /// particles share an id, only one (unspecified) keeps its state. A particle with the id 0xffff_ffff is never
    /// foam. With `None` no state is kept: the foam amount rises linearly with the Weber number, from 0 at half the
    /// threshold to 1 at one and a half times the threshold.
    pub ids: Option<Stream>,
    /// Number of particles, at most [`SurfaceFoamStateConfig::max_particles`](crate::SurfaceFoamStateConfig).
    pub count: Count,
    /// Seconds since the previous step, [0, ∞).
    pub dt: f32,
    /// Uniform settings.
    pub settings: &'a WeberSettings,
    /// Last use of all these buffers before the step (layout ignored).
    pub before: Access,
    /// First use of these buffers after the step (layout ignored).
    pub after: Access,
}

impl<'a> SurfaceFoamStep<'a> {
    /// A foam step without densities and ids: only velocities, in a buffer that the CPU wrote before the submission.
    pub fn new(
        slot: Slot,
        velocities: Stream,
        count: Count,
        dt: f32,
        settings: &'a WeberSettings,
    ) -> Self {
        let (before, after) = (crate::gpu::access::NOTHING, crate::gpu::access::NOTHING);
        Self { slot, velocities, densities: None, ids: None, count, dt, settings, before, after }
    }

    /// Adds densities.
    #[must_use]
    pub fn with_densities(self, densities: Stream) -> Self {
        Self { densities: Some(densities), ..self }
    }

    /// Adds ids, without which there are no foam phases.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// Sets the last use of the particles' buffers before the foam step, and their first use after it.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// One fluid step, for [`Generator::record_step`](crate::whitewater::Generator::record_step): the fluid's particles
/// as they are after the step, in any order. The library only reads them.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct GeneratorStep<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// World-space centres (3×f32, scene units). A particle with a non-finite or huge position or velocity is ignored.
    pub positions: Stream,
    /// World-space velocities (3×f32, scene units per second).
    pub velocities: Stream,
    /// Ids of the fluid's particles (u32), constant from step to step, for the random numbers. `None`: the index is
    /// used.
    pub ids: Option<Stream>,
    /// Number of particles, at most [`GeneratorConfig::max_fluid`](crate::whitewater::GeneratorConfig).
    pub count: Count,
    /// Seconds since the previous step, [0, ∞).
    pub dt: f32,
    /// Number of the step in the sequence, for the random numbers: any value, different in each step.
    pub number: u32,
    /// Uniform settings.
    pub settings: &'a GeneratorSettings,
    /// Last use of all these buffers before the step (layout ignored).
    pub before: Access,
    /// First use of these buffers after the step (layout ignored).
    pub after: Access,
}

impl<'a> GeneratorStep<'a> {
    /// A generation step with number 0, for fluid particles without ids, in buffers that the CPU wrote before the
    /// submission.
    pub fn new(
        slot: Slot,
        [positions, velocities]: [Stream; 2],
        count: Count,
        dt: f32,
        settings: &'a GeneratorSettings,
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

    /// Adds ids that identify particles from frame to frame.
    #[must_use]
    pub fn with_ids(self, ids: Stream) -> Self {
        Self { ids: Some(ids), ..self }
    }

    /// Sets the step's number in the sequence.
    #[must_use]
    pub fn with_number(self, number: u32) -> Self {
        Self { number, ..self }
    }

    /// Sets the last use of the fluid particles' buffers before the generation step, and their first use after it.
    #[must_use]
    pub fn with_access(self, before: Access, after: Access) -> Self {
        Self { before, after, ..self }
    }
}

/// The camera of a frame. The projection is the host's own for a viewport of positive height: y in clip space points
/// down in the image. A host whose viewport has a negative height first changes the sign of the second row (that of
/// y) of its projection matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World to eye space, four columns.
    pub view: [[f32; 4]; 4],
    /// Eye to clip space, depth 0 to 1: perspective; finite or infinite, standard or reversed
    /// depth, off-axis allowed; looking down −z (right-handed) or +z.
    pub projection: [[f32; 4]; 4],
}

impl Camera {
    /// A camera from a view matrix and a projection matrix, each given as four columns of four numbers or as a type
    /// that converts to them. Matrices of cgmath, nalgebra and mint convert; those of glam do with
    /// `to_cols_array_2d`.
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

/// Functions for tools that use the same version of glam.
#[cfg(feature = "headless")]
impl Camera {
    /// Like [`new`](Self::new).
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

/// The previous frame, which motion vectors refer to. With [`Config::motion`] the vectors are in the layer `motion`,
/// as two 32-bit floats per pixel.
///
/// A vector is the position of the visible point in this frame (the pixel's centre) minus its position in the
/// previous frame, in pixels of this frame, x to the right and y down. To reproject, sample the previous frame at
/// `uv − vector / size`. A surface point of water or foam was previously at its position minus `dt` times the mean
/// velocity of the particles around it. The scene is taken as static. Both projections are used as given, so
/// sub-pixel jitter in a projection also appears in the vectors. If the two frames differ in size, the previous one
/// is treated as if it had the size of this one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Previous {
    /// The camera of the previous frame. It may have another projection, near plane or depth convention.
    pub camera: Camera,
    /// Seconds from the previous frame to this one, [0, ∞). Along each axis of eye space, a particle's motion in this
    /// time is clamped to a thousand particle spacings.
    pub dt: f32,
}

/// The host's shadow map or mask, which is only sampled.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Shadow {
    /// The shadow map or mask. With [`Shadows::Map`] and [`Shadows::Convolution`] it is the scene's depth from the
    /// light, of any size; points outside the map are lit. With [`Shadows::Mask`] it has one channel over the view, 1
    /// where the sun shines on the fluid and 0 where it does not. `rect` is the part that is used.
    pub image: HostImage,
    /// View-projection matrix of the shadow map, from world space to Vulkan's clip space: four columns, orthographic or
    /// perspective, standard or reversed depth. Not read if `image` is a mask.
    pub view_projection: [[f32; 4]; 4],
    /// Shadow bias in scene units, finite, default 0: points are moved towards the sun by this distance before they
    /// are compared with the map. Recommended: about a particle spacing plus the width of a texel of the map. Not
    /// read if `image` is a mask.
    pub bias: f32,
}

impl Shadow {
    /// A shadow map with the light's view-projection matrix, or, with [`Shadows::Mask`](crate::water::Shadows::Mask),
    /// a mask over the view, for which the matrix is not read. The bias is 0.
    pub fn new(image: HostImage, view_projection: impl Into<[[f32; 4]; 4]>) -> Self {
        Self { image, view_projection: view_projection.into(), bias: 0.0 }
    }

    pub(crate) fn clip(&self) -> Mat4 {
        Mat4::from_cols_array_2d(&self.view_projection)
    }

    /// 1 if depth grows away from the light, -1 if it falls.
    pub(crate) fn nearer(&self, light: &Light) -> f32 {
        let clip = self.clip();
        let inverse = clip.inverse();
        let middle = inverse.project_point3(Vec3::new(0.0, 0.0, 0.5));
        let step = light.toward() * 1.0e-3 * (1.0 + middle.length());
        let depth = |p| clip.project_point3(p).z;
        if depth(middle + step) <= depth(middle) { 1.0 } else { -1.0 }
    }
}

/// A sphere in the world. The light's maps cover the square that encloses it as seen from the sun. Water and foam
/// beside this square cast no shadows, and points beside it receive none. Water and foam between the sun and the square
/// cast shadows even if they are outside the sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightVolume {
    /// Centre, world space, finite.
    pub center: [f32; 3],
    /// Radius, scene units, (0, ∞).
    pub radius: f32,
}

impl LightVolume {
    /// Matrix from world space to the light's maps: x and y are the position in the map, 0 to 1, and z is the
    /// distance along the light from the sphere's centre, in scene units.
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

/// Everything that one `record` draws.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct Frame<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// The output, with linear, scene-referred colour. It is written where there is water and foam, and unchanged
    /// elsewhere; with [`Config::light_map_size`] all of its `rect` is written. The size of its `rect` is the frame's
    /// size, at most [`Config::extent`].
    pub output: HostImage,
    /// The scene behind the water, with linear colour, only sampled. With [`Config::in_place`] it may be the image of
    /// `output`. Then the `rect` of `output` is copied first, for which the image needs transfer-source usage; with
    /// [`Config::light_map_size`] it is sampled instead of copied. A separate image may have another size than the
    /// output.
    pub scene_color: HostImage,
    /// Depth image of the scene in the camera's convention, only sampled. It may have another size than the output.
    pub scene_depth: HostImage,
    /// The particles.
    pub particles: Particles,
    /// Whitewater particles, with [`Config::whitewater`]. `None`: there are none.
    pub whitewater: Option<WhitewaterParticles>,
    /// Blobs of bubble foam, with [`Config::bubbles`]. With `None` the host hands in no blobs in this frame. It has
    /// to be `None` if [`BubbleConfig::crossfade`] is set, because then the renderer itself makes the blobs from
    /// whitewater foam.
    pub bubbles: Option<Blobs>,
    /// Shoreline and contact foam, with [`Config::shore`]; `None`: there is none.
    pub shore: Option<Shore>,
    /// The camera.
    pub camera: Camera,
    /// The shadow that the host's scene casts on water and foam. It has to be given if [`Config::shadow`] is set, and
    /// has to be `None` (default) otherwise.
    pub shadow: Option<Shadow>,
    /// The sphere that contains the water and foam that cast shadows and the part of the scene that receives them.
    /// It has to be given if [`Config::light_map_size`] is set, and has to be `None` (default) otherwise.
    pub light_volume: Option<LightVolume>,
    /// The previous frame, for motion vectors. Without [`Config::motion`] it has to be `None`. With `None`, as in a
    /// first frame, all vectors are zero.
    pub previous: Option<Previous>,
    /// Panes of glass in front of the water. At most [`MAX_PANES`](crate::water::MAX_PANES) are possible. By default
    /// there are none.
    pub panes: &'a [Pane],
    /// Settings that are uniforms.
    pub settings: &'a Settings,
}

impl<'a> Frame<'a> {
    /// A frame without optional inputs: water over the scene that `output` already holds. This needs
    /// [`Config::in_place`]; without it add a separate scene image ([`with_scene_color`](Self::with_scene_color)).
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
            whitewater: None,
            bubbles: None,
            shore: None,
            camera,
            shadow: None,
            light_volume: None,
            previous: None,
            panes: &[],
            settings,
        }
    }

    /// Sets a separate image with the scene's colour.
    #[must_use]
    pub fn with_scene_color(self, scene_color: HostImage) -> Self {
        Self { scene_color, ..self }
    }

    /// Adds whitewater particles, for [`Config::whitewater`].
    #[must_use]
    pub fn with_whitewater(self, whitewater: WhitewaterParticles) -> Self {
        Self { whitewater: Some(whitewater), ..self }
    }

    /// Adds blobs of bubble foam, for [`Config::bubbles`].
    #[must_use]
    pub fn with_bubbles(self, bubbles: Blobs) -> Self {
        Self { bubbles: Some(bubbles), ..self }
    }

    /// Adds shoreline and contact foam, for [`Config::shore`].
    #[must_use]
    pub fn with_shore(self, shore: Shore) -> Self {
        Self { shore: Some(shore), ..self }
    }

    /// Adds the host's shadows, for [`Config::shadow`].
    #[must_use]
    pub fn with_shadow(self, shadow: Shadow) -> Self {
        Self { shadow: Some(shadow), ..self }
    }

    /// Adds the sphere in which water and foam cast shadows, for [`Config::light_map_size`].
    #[must_use]
    pub fn with_light_volume(self, light_volume: LightVolume) -> Self {
        Self { light_volume: Some(light_volume), ..self }
    }

    /// Adds the previous frame, for [`Config::motion`].
    #[must_use]
    pub fn with_previous(self, previous: Previous) -> Self {
        Self { previous: Some(previous), ..self }
    }

    /// Adds panes of glass that the water stands against.
    #[must_use]
    pub fn with_panes(self, panes: &'a [Pane]) -> Self {
        Self { panes, ..self }
    }

    /// Whether the output is its own scene.
    pub(crate) fn in_place(&self) -> bool {
        self.scene_color.image == self.output.image
    }
}

/// All settings that may change from frame to frame at no cost. Where the range of one of these settings is documented
/// as ending at ∞, the largest accepted value is 1e12, so that a product of a few values stays finite.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Settings {
    /// World up direction, any length except 0, default +y. It defines the horizon (rays that water reflects below it
    /// meet more water), what is level (the ground of [`Light::irradiance`], the water of
    /// [`Wavelets`](crate::water::Wavelets), the surfaces of shores), the depth of water above the scene, and the
    /// direction in which soap films drain. Environments have an up direction of their own ([`Sky::up`](crate::Sky),
    /// [`Equirectangular::up`](crate::Equirectangular)), and simulations have their gravity.
    pub up: [f32; 3],
    /// Layered water.
    pub water: WaterSettings,
    /// Surface foam.
    pub surface_foam: SurfaceFoamSettings,
    /// Spray of the water's particles.
    pub spray: SpraySettings,
    /// Whitewater.
    pub whitewater: WhitewaterSettings,
    /// Bubble foam.
    pub bubbles: BubbleSettings,
    /// Shoreline and contact foam.
    pub shore: ShoreSettings,
    /// Filter of the host's shadow map, with [`Shadows::Convolution`].
    pub shadow: ShadowFilter,
    /// Surface noise: ripples finer than the particles.
    pub noise: SurfaceNoiseSettings,
    /// Sun and sky light.
    pub light: Light,
    /// Which parts of the picture the composite contains, for debug views. Default: all.
    #[cfg(feature = "diagnostics")]
    pub debug_view: DebugView,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) debug_view: DebugView,
}

/// Default settings, for a particle spacing of 0.05 scene units and scene units of one metre, under the default
/// [`Sky`](crate::Sky).
impl Default for Settings {
    fn default() -> Self {
        Self {
            up: [0.0, 1.0, 0.0],
            water: WaterSettings::default(),
            surface_foam: SurfaceFoamSettings::default(),
            spray: SpraySettings::default(),
            whitewater: WhitewaterSettings::default(),
            bubbles: BubbleSettings::default(),
            shore: ShoreSettings::default(),
            shadow: ShadowFilter::default(),
            noise: SurfaceNoiseSettings::default(),
            light: Light::default(),
            debug_view: DebugView::default(),
        }
    }
}

impl Settings {
    /// The defaults for a particle spacing in scene units (twice the solver's particle radius, (0, ∞)) and a number
    /// of scene units per metre (1 for metres, 100 for centimetres, (0, ∞)), under the default [`Sky`](crate::Sky)
    /// with +y up. All lengths, speeds and optical densities of these settings follow from the two numbers; those of
    /// `shore` follow from `units_per_metre` alone. For another sky see [`with_light`](Self::with_light).
    ///
    /// The settings of a frame's input or of a simulation are not among these settings, and the host sets them: radii
    /// of whitewater particles, [`Shore::bias`], [`Shadow::bias`], `BlobSimulationSettings`
    /// ([`in_units`](crate::bubbles::BlobSimulationSettings::in_units)), [`GeneratorSettings`]
    /// ([`with_gravity`](GeneratorSettings::with_gravity)) and the Weber number's scale
    /// ([`WeberSettings::weber_in`]).
    pub fn new(spacing: f32, units_per_metre: f32) -> Self {
        let mut settings = Self::default();
        settings.water.spacing = spacing;
        settings.water.medium = settings.water.medium.thinned(1.0 / units_per_metre);
        settings.water.wavelets.length *= units_per_metre;
        settings.water.wavelets.gravity *= units_per_metre;
        settings.surface_foam = SurfaceFoamSettings::of_spacing(spacing);
        settings.whitewater = WhitewaterSettings::of_spacing(spacing);
        settings.bubbles.crossfade.near *= units_per_metre;
        settings.bubbles.crossfade.far *= units_per_metre;
        settings.shore = settings.shore.in_units(units_per_metre);
        settings
    }

    /// Replaces the light, by that of a sky ([`Light::of`]) or by the host's own.
    #[must_use]
    pub fn with_light(self, light: Light) -> Self {
        Self { light, ..self }
    }

    /// Replaces the up direction, of any length except 0. The environment has to be given the same up direction.
    #[must_use]
    pub fn with_up(self, up: [f32; 3]) -> Self {
        Self { up, ..self }
    }

    /// The look of the thesis' demo (Bagar 2010) for a particle spacing: its composite, colours, unit of thickness,
    /// foam, spray and light on foam. It is meant for a configuration with `Rule::Source` as `Config.rule` (both with
    /// the feature `diagnostics` only), [`Config::sheets`] of 1, [`Config::mirror_steps`] of 0, [`Config::exit`] of
    /// [`Exit::Straight`], [`Config::kernels`] of [`Kernels::Spheres`], [`Config::light_map_size`] of `None` and
    /// [`Config::shadow`] of [`Shadows::Convolution`](crate::water::Shadows).
    pub fn thesis(spacing: f32) -> Self {
        Self {
            water: WaterSettings::thesis(spacing),
            surface_foam: SurfaceFoamSettings::thesis(spacing),
            spray: SpraySettings::SOURCE,
            whitewater: WhitewaterSettings::of_spacing(spacing),
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
    /// This light with [`shade`](Self::shade) as in the thesis: 0.6 of the irradiance in the sun (Listing A.20).
    pub fn thesis(self) -> Self {
        Self { shade: self.irradiance.map(|c| 0.6 * c), ..self }
    }
}

/// Light of sun and sky. The default is the light of the default [`Sky`](crate::Sky); [`Light::of`] computes that of
/// another sky.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Light {
    /// World direction to the sun, any length except 0.
    pub direction: [f32; 3],
    /// Radiance of the sun's highlight, linear RGB, [0, ∞).
    pub color: [f32; 3],
    /// Mean radiance of the environment, linear RGB, [0, ∞). Water scatters this light, except water of
    /// [`Medium::Turbid`](crate::water::Medium), which scatters `irradiance`.
    pub ambient: [f32; 3],
    /// Irradiance of level ground under sun and sky, linear RGB, [0, ∞). It is also the light on foam and spray that
    /// are in the sun.
    pub irradiance: [f32; 3],
    /// Irradiance of level ground in the sun's shadow, linear RGB, [0, ∞): light of the sky, and light that sunlit
    /// surroundings reflect.
    pub shade: [f32; 3],
}

/// The light of the default [`Sky`](crate::Sky), from [`Light::of`].
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
    /// Unit vector to the sun. It is correct even if the squared length of `direction` overflows single precision.
    pub(crate) fn toward(&self) -> Vec3 {
        Vec3::from(self.direction).as_dvec3().normalize_or(DVec3::Y).as_vec3()
    }
}

/// An intermediate image of `record` that the host may read. The renderer's next `record` expects it in the layout of
/// [`access`](Self::access) and may overwrite it. So after its commands that read the image the host records a
/// barrier from its own use to `access`. If it reads the image on another queue than that of `record`, it also makes
/// the submission of the next `record` wait for these commands, with a semaphore for example.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Layer {
    /// Name. The tool's EXR files append a channel to it: the layer `water.depth` is the channel `water.depth.Z`, the
    /// layer `motion` the channels `motion.X` and `motion.Y`. With [`Config::surface_foam`] `water.thickness` has a
    /// second channel: thickness of the water in front of the frontmost foam. With [`Config::sheets`] of 2 there is a
    /// layer `water.thickness.sheets` with four channels: thickness of the front layer of water, thickness of the
    /// back layer, thickness of the water within about a spacing of the boundary between them (with water there the
    /// two are drawn as one), and the eye depth of this boundary as it was first found. A texel of `water.iterations`
    /// has 32 bits: the low nine are the number of smoothing iterations planned for it, the other 23 the size of its
    /// steps relative to the largest step.
    pub name: &'static str,
    /// The image; transfer source usage.
    pub image: vk::Image,
    /// A view of it.
    pub view: vk::ImageView,
    /// Its format.
    pub format: vk::Format,
    /// The layer's size in texels; some layers have a lower resolution than the picture. For `water.surface` and
    /// `water.iterations` it is the size at [`Config::smoothing_level`]. The images of these two can be larger: they
    /// also hold the coarser levels ([`Config::coarsening`]), at which near water is smoothed, and the back layer
    /// ([`Config::sheets`]). `Diagnostics::levels` (feature `diagnostics`) tells where.
    pub extent: vk::Extent2D,
    /// Its state after `record`.
    pub access: Access,
}

/// Results of a record.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Recorded {
    /// The layers that were kept: all of them with [`Config::keep_layers`], `motion` with [`Config::motion`].
    pub layers: Vec<Layer>,
    #[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // then nobody reads it
    pub(crate) diagnostics: Diagnostics,
}

#[cfg(feature = "diagnostics")]
impl Recorded {
    /// The renderer's own buffers, for tests and tools. Their layout follows the shaders and may change in any
    /// version.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }
}

/// Device memory in use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MemoryUse {
    /// Bytes of images; depends on the extent, the levels, and the sizes of environment and light maps.
    pub images: u64,
    /// Bytes of buffers; depends on the maximum number of particles and on the extent.
    pub buffers: u64,
}
