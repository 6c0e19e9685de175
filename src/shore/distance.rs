//! Pass `map`: distance to the shore on a grid that is fixed in the world, for shores without a mesh of their
//! own. Not in the blog, whose author asks for it (*Semi-procedural foam shader*, Sec. II).
//!
//! The input is the height of the land seen from above, from the host's meshes or image. Texels where it crosses the
//! water's level are seeds, and jump flooding finds the nearest seed of each texel (Rong, Tan, *Jump Flooding in GPU
//! with Applications to Voronoi Diagram and Distance Transform*, 2006), with one extra jump of one texel at the end.
//! If only a part of the land has changed, only a rectangle of texels around it is updated.
//! Reads: the host's vertices or image. Writes: heights, seeds, distances (R32F, scene units, negative in the
//! water).

use std::sync::Arc;

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;
use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::check;
use crate::context::Context;
use crate::contract::{Access, HostImage, ShoreDistances, Slot, Triangles};
use crate::error::Error;
use crate::frame::level_axes;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ, DEPTH_ATTACHMENT,
    FRAGMENT_SAMPLED, NOTHING, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pass::{Attachment, Attachments, clear_depth};
use crate::gpu::pipeline::{Graphics, Pipeline};
use crate::gpu::shader;
use crate::gpu::timing::{Timer, Timing};
use crate::host_images::depth_layout;
use crate::water::Window;
use crate::water::settings::range;

crate::contract::with!(ShoreMapConfig, ShoreMapStep<'_>);

/// Access of frames and of the host to the distances.
const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
/// Maximum number of jumps, plus one.
const MOST_JUMPS: u32 = 14;
/// Distances are computed up to this many times [`Area::reach`], and this many texels more. Pass `shore-tiles`
/// (glsl/shore/tiles.comp) relies on both: where a distance is missing, it knows only that the shore is farther away,
/// so with a larger range it can leave out more tiles of the open sea.
const FARTHER: f32 = 1.25;
const SPARE: i32 = 8;

/// Configuration of a [`ShoreMap`]. It determines how much memory is allocated: 16 bytes per texel. Made by
/// `default()`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShoreMapConfig {
    /// Texels along each axis, a multiple of 16 from 16 to 4096, default 1024.
    pub size: u32,
    /// Maximum number of meshes per step, default 64.
    pub max_meshes: u32,
}

impl Default for ShoreMapConfig {
    fn default() -> Self {
        Self { size: 1024, max_meshes: 64 }
    }
}

/// The area that a map covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// World up direction, unit length, the same as a frame's [`Settings::up`](crate::Settings::up).
    pub up: [f32; 3],
    /// Centre of the map's area along the two horizontal [`axes`](Self::axes), scene units. The axes are x and z for y
    /// up, x and −y for z up, y and −z for x up. The area is snapped to whole texels: the content of a map that
    /// follows a camera does not flicker.
    pub center: [f32; 2],
    /// Side length in scene units, (0, 1e6].
    pub edge: f32,
    /// Height of the water along `up`, scene units, finite.
    pub level: f32,
    /// Maximum distance from the shore that is computed, scene units, (0, edge]. Shoreline foam needs the larger one of
    /// its widths [`sea_reach`](super::ShorelineSettings::sea_reach) and
    /// [`land_reach`](super::ShorelineSettings::land_reach).
    pub reach: f32,
}

/// Source of the land's heights.
#[derive(Clone, Copy, Debug)]
pub enum Heights<'a> {
    /// Meshes, rendered from above. Land is wherever any mesh is above the water, including overhangs.
    Meshes(&'a [MapMesh]),
    /// An image of the land's heights along [`Area::up`], in scene units, at the centres of its texels. It covers
    /// the snapped area ([`Area::corner`]); x runs along the first horizontal axis ([`Area::axes`]), y along the
    /// second. Its size is arbitrary, and it is only sampled.
    Image(HostImage),
}

/// A mesh of the land.
#[derive(Clone, Copy, Debug)]
pub struct MapMesh {
    /// Its triangles.
    pub triangles: Triangles,
    /// Transform to world space, four columns.
    pub transform: [[f32; 4]; 4],
}

/// The input of [`ShoreMap::record_step`], which updates the map. A step is needed only when land or water has changed.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ShoreMapStep<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// The covered area.
    pub area: Area,
    /// All of the land, including the parts that have not changed.
    pub heights: Heights<'a>,
    /// Rectangle in which the land has changed since the last step: its minimum and maximum corner along the
    /// horizontal axes ([`Area::axes`]), scene units. Around land that has moved, it encloses the old and the new
    /// position. With `None`, or if `area` is not that of the last step, the whole map is computed again.
    pub changed: Option<[[f32; 2]; 2]>,
    /// Last use of the meshes' buffers before the step (layout ignored).
    pub before: Access,
    /// First use of these buffers after the step (layout ignored).
    pub after: Access,
}

impl<'a> ShoreMapStep<'a> {
    /// A step that computes the map of all of `area`, not only of a changed part. It is for meshes whose buffers the
    /// CPU wrote before the submission: the step waits for no earlier use of them on the GPU, and makes no later use
    /// wait.
    pub fn new(slot: Slot, area: Area, heights: Heights<'a>) -> Self {
        let (before, after) = (NOTHING, NOTHING);
        Self { slot, area, heights, changed: None, before, after }
    }
}

impl Area {
    fn texel(&self, size: u32) -> f32 {
        self.edge / size as f32
    }

    /// The two horizontal axes, unit vectors in world space. A point p of the world lies at (p · first, p · second) on
    /// the map.
    pub fn axes(&self) -> [[f32; 3]; 2] {
        level_axes(Vec3::from(self.up)).map(|axis| axis.to_array())
    }

    /// The minimum corner of the snapped area, in scene units along the two horizontal axes ([`axes`](Self::axes)), for
    /// a map with `size` texels along each axis.
    pub fn corner(&self, size: u32) -> [f32; 2] {
        let texel = f64::from(self.edge) / f64::from(size);
        self.center.map(|c| {
            let least = f64::from(c) - 0.5 * f64::from(self.edge);
            ((least / texel).round() * texel) as f32
        })
    }

    fn check(&self) -> Result<(), Error> {
        let up = Vec3::from(self.up);
        if !up.is_finite() || (up.length() - 1.0).abs() > 1.0e-3 {
            return Err(Error::bad("Area.up", "expected a direction of unit length"));
        }
        range("Area.center[0]", self.center[0], -1.0e9, 1.0e9)?;
        range("Area.center[1]", self.center[1], -1.0e9, 1.0e9)?;
        range("Area.edge", self.edge, 1.0e-6, 1.0e6)?;
        range("Area.level", self.level, -1.0e9, 1.0e9)?;
        range("Area.reach", self.reach, 1.0e-9, self.edge)
    }
}

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct HeightPush {
    east: [f32; 4],
    north: [f32; 4],
    height: [f32; 4],
    position_word: u32,
    position_stride: u32,
    index_word: u32,
    index_stride: u32,
    vertices: u32,
}
shader::assert_layout!(
    shader::SHORE_MAP_HEIGHT_VERT,
    "Push",
    HeightPush {
        east,
        north,
        height,
        position_word,
        position_stride,
        index_word,
        index_stride,
        vertices
    }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    window: [i32; 4],
    size: i32,
    jump: i32,
    texel: f32,
    level: f32,
    part: [f32; 4],
}
shader::assert_layout!(
    shader::SHORE_MAP_DISTANCE_COMP,
    "Push",
    Push { window, size, jump, texel, level, part }
);

struct Pipelines {
    height: Pipeline,
    /// Pipelines for rendered heights and for the host's.
    seed: [Pipeline; 2],
    jump: Pipeline,
    distance: [Pipeline; 2],
}

struct MapSlot {
    descriptors: Descriptors,
    timer: Timer,
}

/// The images and their passes.
struct Grid {
    pass: vk::RenderPass,
    framebuffer: Owned<vk::Framebuffer>,
    pipelines: Pipelines,
    heights: Image,
    seeds: [Buffer; 2],
    distances: Image,
}

/// A map of the distances to the shore over an area of the world. Several views can share one map.
pub struct ShoreMap {
    gpu: Arc<Gpu>,
    config: ShoreMapConfig,
    grid: Grid,
    slots: Vec<MapSlot>,
    /// Area of the last step.
    area: Option<Area>,
    /// Whether its heights came from meshes.
    drawn: bool,
    /// Slot of the step recorded last, and the values of `area` and `drawn` before it, which `abandon` brings back.
    /// `None` if there is no step to take back: none was recorded since the last `abandon`.
    last: Option<(Slot, Option<Area>, bool)>,
}

/// A window of the map in texels: first, and one past the last.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    first: [i32; 2],
    end: [i32; 2],
}

impl Part {
    fn whole(size: u32) -> Self {
        Self { first: [0; 2], end: [size as i32; 2] }
    }

    /// The window grown on all sides, clamped to the map.
    fn grown(self, by: i32, size: u32) -> Self {
        if self.is_empty() {
            return self;
        }
        Self {
            first: self.first.map(|v| v.saturating_sub(by).clamp(0, size as i32)),
            end: self.end.map(|v| v.saturating_add(by).clamp(0, size as i32)),
        }
    }

    fn size(self) -> [i32; 2] {
        std::array::from_fn(|i| (self.end[i] - self.first[i]).max(0))
    }

    fn window(self) -> [i32; 4] {
        let ([x, y], [w, h]) = (self.first, self.size());
        [x, y, w, h]
    }

    fn is_empty(self) -> bool {
        self.size().contains(&0)
    }
}

impl ShoreMap {
    /// Creates pipelines and allocates memory.
    ///
    /// # Errors
    /// Bad configuration; no memory; Vulkan errors.
    pub fn new(context: &Context, config: &ShoreMapConfig) -> Result<Self, Error> {
        let size = config.size;
        if !size.is_multiple_of(16) || !(16..=4096).contains(&size) {
            let why = format!("expected a multiple of 16 from 16 to 4096, found {size}");
            return Err(Error::bad("ShoreMapConfig.size", why));
        }
        if config.max_meshes > 65_536 {
            let why = format!("expected 0 to 65536, found {}", config.max_meshes);
            return Err(Error::bad("ShoreMapConfig.max_meshes", why));
        }
        let gpu = Gpu::new(context);
        match Self::made(&gpu, config) {
            Ok(map) => Ok(map),
            Err(error) => {
                // Nothing was submitted with the objects created before the failure.
                gpu.destroy();
                Err(error)
            }
        }
    }

    fn made(gpu: &Arc<Gpu>, config: &ShoreMapConfig) -> Result<Self, Error> {
        use vk::{AttachmentLoadOp as Load, AttachmentStoreOp as Store, ImageUsageFlags as Usage};
        let extent = vk::Extent2D { width: config.size, height: config.size };
        let format = vk::Format::D32_SFLOAT;
        let usage = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED;
        let heights = Image::new(gpu, &ImageDesc::new("shore/heights", extent, format, usage))?;
        let samples = vk::SampleCountFlags::TYPE_1;
        let depth = Attachment { format, samples, load: Load::CLEAR, store: Store::STORE };
        let attachments = Attachments { depth: Some(depth), ..Attachments::default() };
        let pass = gpu.render_pass("shore/heights", &attachments)?;
        let framebuffer = gpu.framebuffer("shore/heights", pass, heights.view, extent)?;
        let height = Pipeline::tested(
            gpu,
            &Graphics {
                vertex: shader::SHORE_MAP_HEIGHT_VERT,
                fragment: shader::SHORE_MAP_HEIGHT_FRAG,
                topology: vk::PrimitiveTopology::TRIANGLE_LIST,
                pass,
                blend: &[],
                constants: &[],
            },
            Some(vk::CompareOp::GREATER_OR_EQUAL),
        )?;
        let both = |shader| -> Result<_, Error> {
            Ok([
                Pipeline::compute(gpu, shader, &[(0, 0)])?,
                Pipeline::compute(gpu, shader, &[(0, 1)])?,
            ])
        };
        let seeds = |name| {
            let bytes = 4 * u64::from(config.size).pow(2);
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        let usage = Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC;
        let format = vk::Format::R32_SFLOAT;
        let slot = |_| {
            Ok(MapSlot {
                descriptors: Descriptors::new(gpu, config.max_meshes + MOST_JUMPS + 3)?,
                timer: Timer::new(gpu)?,
            })
        };
        let grid = Grid {
            pass,
            framebuffer,
            pipelines: Pipelines {
                height,
                seed: both(shader::SHORE_MAP_SEED_COMP)?,
                jump: Pipeline::compute(gpu, shader::SHORE_MAP_JUMP_COMP, &[])?,
                distance: both(shader::SHORE_MAP_DISTANCE_COMP)?,
            },
            heights,
            seeds: [seeds("shore/seeds/a")?, seeds("shore/seeds/b")?],
            distances: Image::new(gpu, &ImageDesc::new("shore/distances", extent, format, usage))?,
        };
        Ok(Self {
            gpu: gpu.clone(),
            config: *config,
            grid,
            slots: (0..gpu.slots).map(slot).collect::<Result<_, Error>>()?,
            area: None,
            drawn: false,
            last: None,
        })
    }

    /// Records an update of the map of distances, after land or water have changed. It never submits, waits or
    /// allocates device memory.
    ///
    /// # Errors
    /// [`Error::BadInput`], which names the field, before the first command is recorded. After any other error,
    /// discard the command buffer and call [`abandon`](Self::abandon).
    ///
    /// # Safety
    /// The conditions of [`Renderer::record`](crate::Renderer::record) hold. Steps are submitted in the order in
    /// which they were recorded, before the frames that show them.
    pub unsafe fn record_step(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &ShoreMapStep<'_>,
    ) -> Result<(), Error> {
        // Earlier work of the slot is complete, so it cannot be taken back. A step in another slot still can, if this
        // one is refused.
        self.last.take_if(|(slot, ..)| *slot == step.slot);
        self.check(step)?;
        let size = self.config.size;
        let area = step.area;
        let corner = area.corner(size);
        let texel = area.texel(size);
        let reach = (FARTHER * area.reach / texel).ceil() as i32 + SPARE;
        // The centre may move within a texel.
        let same = |before: Area| Area { center: area.center, ..before } == area;
        let known = self.area.is_some_and(|before| same(before) && before.corner(size) == corner);
        let drawn = matches!(step.heights, Heights::Image(_)) || self.drawn;
        let changed = match step.changed.filter(|_| known && drawn) {
            Some([least, most]) => {
                let at =
                    |place: [f32; 2], i: usize| ((place[i] - corner[i]) / texel).floor() as i32;
                let first = std::array::from_fn(|i| at(least, i));
                let end = std::array::from_fn(|i| at(most, i).saturating_add(1));
                Part { first, end }.grown(1, size)
            }
            None => Part::whole(size),
        };
        // A changed height affects the distances of texels within the reach. The nearest seed of such a texel may be
        // as far away from it, so seeds are needed within twice the reach.
        let told = changed.grown(reach, size);
        let asked = told.grown(reach, size);
        let first_time = self.area.is_none();
        self.last = Some((step.slot, self.area, self.drawn));
        // Unknown after a failure, until `abandon`.
        self.area = None;
        let drawn = std::mem::take(&mut self.drawn);

        let (gpu, grid) = (&*self.gpu, &self.grid);
        let slot = &mut self.slots[step.slot.0 as usize];
        slot.descriptors.reset(gpu)?;
        slot.timer.reset(gpu, cmd);
        gpu.begin_label(cmd, c"whitewater/map");
        let scope = slot.timer.begin(gpu, cmd, c"map");
        let descriptors = &slot.descriptors;
        let (own, part, heights) = match &step.heights {
            Heights::Meshes(meshes) => {
                let own = Drawn { area: &area, corner, changed, meshes, before: drawn, size };
                grid.record_heights(gpu, cmd, descriptors, step, &own)?;
                let part = [2.0 * area.edge, -area.edge, 0.0, 0.0];
                let nearest = gpu.samplers.nearest;
                (0, part, Resource::Sampled(grid.heights.view, nearest))
            }
            Heights::Image(image) => {
                let used = Access { layout: depth_layout(image), ..COMPUTE_SAMPLED };
                let to = access::raw_image(image.image, image.aspect, image.before, used);
                gpu.barriers(cmd, &[to], &[]);
                let vk::Rect2D { offset, extent } = image.rect;
                let part =
                    [offset.x as f32, offset.y as f32, extent.width as f32, extent.height as f32];
                (1, part, Resource::SampledIn(image.view, gpu.samplers.nearest, used.layout))
            }
        };
        let push = |window: Part, jump| Push {
            window: window.window(),
            size: size as i32,
            jump,
            texel,
            level: area.level,
            part,
        };
        let dispatch = |window: Part| {
            let [w, h] = window.size().map(|v| (v as u32).div_ceil(16));
            // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
            unsafe { gpu.device.cmd_dispatch(cmd, w, h, 1) };
        };
        let both = COMPUTE_READ_WRITE;
        let [a, b] = &grid.seeds;
        let wait = |which: &Buffer| gpu.barriers(cmd, &[], &[buffer(which.handle, both, both)]);
        gpu.barriers(cmd, &[], &[a, b].map(|seeds| buffer(seeds.handle, both, both)));
        if !asked.is_empty() {
            let pipeline = &grid.pipelines.seed[own];
            descriptors.bind(gpu, cmd, pipeline, &[(0, heights), (1, Resource::buffer(a))])?;
            pipeline.push(gpu, cmd, &push(asked, 0));
            dispatch(asked);
        }
        // Jumps halve down to one texel, and all together cover the reach; one more jump of a texel follows.
        let farthest = (reach as u32 + 1).next_power_of_two() as i32 / 2;
        let jumps = std::iter::successors(Some(farthest.min(size as i32)), |jump| Some(jump / 2));
        let jumps: Vec<_> = jumps.take_while(|jump| *jump > 0).chain([1]).collect();
        let (mut from, mut to) = (a, b);
        for jump in jumps.into_iter().filter(|_| !asked.is_empty()) {
            wait(from);
            let resources = [(0, Resource::buffer(from)), (1, Resource::buffer(to))];
            descriptors.bind(gpu, cmd, &grid.pipelines.jump, &resources)?;
            grid.pipelines.jump.push(gpu, cmd, &push(asked, jump));
            dispatch(asked);
            std::mem::swap(&mut from, &mut to);
            wait(to);
        }
        wait(from);
        let before = AFTER.and(COPY_READ);
        let before = if first_time { before.discarded() } else { before };
        gpu.barriers(cmd, &[access::image(&grid.distances, before, COMPUTE_WRITE)], &[]);
        if !told.is_empty() {
            let pipeline = &grid.pipelines.distance[own];
            let target = Resource::storage(&grid.distances);
            let resources = [(0, heights), (1, Resource::buffer(from)), (2, target)];
            descriptors.bind(gpu, cmd, pipeline, &resources)?;
            pipeline.push(gpu, cmd, &push(told, 0));
            dispatch(told);
        }
        let mut back = vec![access::image(&grid.distances, COMPUTE_WRITE, AFTER)];
        if let Heights::Image(image) = &step.heights {
            let used = Access { layout: depth_layout(image), ..COMPUTE_SAMPLED };
            back.push(access::raw_image(image.image, image.aspect, used, image.after));
        }
        gpu.barriers(cmd, &back, &[]);
        slot.timer.end(gpu, cmd, scope);
        gpu.end_label(cmd);
        self.area = Some(area);
        self.drawn = own == 0;
        Ok(())
    }

    fn check(&self, step: &ShoreMapStep<'_>) -> Result<(), Error> {
        let fields = ["ShoreMapStep.slot", "ShoreMapStep.dt"];
        check::step(fields, step.slot, self.slots.len(), 0.0)?;
        step.area.check()?;
        if let Some([least, most]) = step.changed
            && !least.iter().zip(&most).all(|(a, b)| a.is_finite() && b.is_finite() && a <= b)
        {
            let why =
                format!("expected the least and the greatest corner, found {least:?} to {most:?}");
            return Err(Error::bad("ShoreMapStep.changed", why));
        }
        match &step.heights {
            Heights::Image(image) => check::image(check::fields!("ShoreMapStep.heights"), image),
            Heights::Meshes(meshes) => {
                if meshes.len() > self.config.max_meshes as usize {
                    let most = self.config.max_meshes;
                    let why =
                        format!("{} meshes, ShoreMapConfig.max_meshes is {most}", meshes.len());
                    return Err(Error::bad("ShoreMapStep.heights", why));
                }
                let fields = [
                    "MapMesh.triangles.positions",
                    "MapMesh.triangles.indices",
                    "MapMesh.triangles",
                ];
                meshes.iter().try_for_each(|mesh| {
                    mesh.triangles.check(fields, &self.gpu.limits)?;
                    if mesh.transform.as_flattened().iter().all(|v| v.is_finite()) {
                        return Ok(());
                    }
                    Err(Error::bad("MapMesh.transform", "not finite"))
                })
            }
        }
    }

    /// The map of the last step, for [`Shoreline::Map`](crate::Shoreline::Map). `None` before the first step, and after
    /// a step that failed with another error than [`Error::BadInput`], until [`abandon`](Self::abandon).
    pub fn shore_distances(&self) -> Option<ShoreDistances> {
        let area = self.area?;
        let size = self.config.size;
        Some(ShoreDistances {
            view: self.grid.distances.view,
            corner: area.corner(size),
            edge: area.edge,
            size,
        })
    }

    /// Distance to the shore at each texel's centre, scene units, negative in the water, R32F. Where the shore is
    /// farther away than [`Area::reach`], the value may not be the distance: only its sign is right, and its absolute
    /// value is larger than the reach. Each step ends with a barrier, after which fragment and compute shaders may
    /// sample the image. It also has transfer-source usage; a copy needs a barrier of your own.
    pub fn distances(&self) -> vk::Image {
        self.grid.distances.handle
    }

    /// Times of the slot's last finished step, in the form of [`Renderer::timings`](crate::Renderer::timings).
    pub fn timings(&mut self, slot: Slot) -> &[Timing] {
        match self.slots.get_mut(slot.0 as usize) {
            Some(state) => state.timer.timings(&self.gpu),
            None => &[],
        }
    }

    /// Takes back the last recorded step, if it was recorded with this slot: the map is again what it was before that
    /// step. Otherwise the map stays. Call it if the step's command buffer was discarded instead of submitted, also
    /// if the step failed with another error than [`Error::BadInput`]. A step that was refused with that error
    /// recorded nothing, so an earlier step in another slot can still be taken back. Other earlier steps cannot. The
    /// call frees nothing, so it is safe even while GPU work is pending.
    pub fn abandon(&mut self, slot: Slot) {
        if let Some(state) = self.slots.get_mut(slot.0 as usize) {
            state.timer.abandon();
        }
        if let Some((_, area, drawn)) = self.last.take_if(|(last, ..)| *last == slot) {
            (self.area, self.drawn) = (area, drawn);
        }
    }

    /// Bytes of device memory in use.
    pub fn memory(&self) -> u64 {
        let grid = &self.grid;
        grid.heights.size + grid.distances.size + grid.seeds.iter().map(|b| b.size).sum::<u64>()
    }

    /// Frees everything. A plain drop is safe, but leaks.
    ///
    /// # Safety
    /// All recorded work is complete, or will never be submitted.
    pub unsafe fn destroy(self) {
        let gpu = self.gpu.clone();
        drop(self);
        gpu.destroy();
    }
}

impl Grid {
    /// Renders the meshes from above, over the changed window.
    fn record_heights(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        step: &ShoreMapStep<'_>,
        drawn: &Drawn<'_>,
    ) -> Result<(), Error> {
        let Drawn { area, corner, changed, meshes, before, size } = *drawn;
        let used: Vec<_> = meshes.iter().flat_map(buffers_of).collect();
        let hosts = |from, to| -> Vec<_> {
            let mut used = used.clone();
            used.sort_by_key(|handle| vk::Handle::as_raw(*handle));
            used.dedup();
            used.into_iter().map(|handle| buffer(handle, from, to)).collect()
        };
        let sampled = COMPUTE_SAMPLED;
        // If it was not rendered before, it is cleared as a whole.
        let before = if before { sampled } else { sampled.discarded() };
        gpu.barriers(
            cmd,
            &[access::image(&self.heights, before, DEPTH_ATTACHMENT)],
            &hosts(step.before, VERTEX_READ),
        );
        if !changed.is_empty() {
            let ([x, y], [w, h]) = (changed.first, changed.size());
            let rect = vk::Rect2D {
                offset: vk::Offset2D { x, y },
                extent: vk::Extent2D { width: w as u32, height: h as u32 },
            };
            let (pass, target) = (self.pass, self.framebuffer.handle);
            gpu.begin_pass_with(cmd, pass, target, rect, &[clear_depth(0.0)]);
            let size = size as f32;
            let viewport = vk::Viewport {
                x: 0.0,
                y: 0.0,
                width: size,
                height: size,
                min_depth: 0.0,
                max_depth: 1.0,
            };
            // SAFETY: cmd is recording.
            unsafe { gpu.device.cmd_set_viewport(cmd, 0, &[viewport]) };
            let up = Vec3::from(area.up);
            let [east, north] = level_axes(up);
            let scale = 2.0 / area.edge;
            let corner = Vec2::from(corner);
            // Depths 0 to 1 represent heights from one width of the area below the water to one width above it.
            let rows = [
                (east * scale).extend(-corner.x * scale - 1.0),
                (north * scale).extend(-corner.y * scale - 1.0),
                (up * 0.5 / area.edge).extend(0.5 - 0.5 * area.level / area.edge),
            ];
            for mesh in meshes {
                let Triangles { positions, vertices, indices } = mesh.triangles;
                let stream = indices.map(|(stream, _)| stream);
                let windows = Window::all(gpu, &positions, [&stream], 0);
                let Some((positions, [indices])) = windows else { continue };
                let row = |row: Vec4| {
                    (Mat4::from_cols_array_2d(&mesh.transform).transpose() * row).to_array()
                };
                let resources = [(0, positions.resource), (1, indices.resource)];
                descriptors.bind(gpu, cmd, &self.pipelines.height, &resources)?;
                let push = HeightPush {
                    east: row(rows[0]),
                    north: row(rows[1]),
                    height: row(rows[2]),
                    position_word: positions.word,
                    position_stride: positions.stride,
                    index_word: indices.word,
                    index_stride: indices.stride,
                    vertices,
                };
                self.pipelines.height.push(gpu, cmd, &push);
                // SAFETY: inside the render pass; the shader reads no vertex that is not there.
                unsafe { gpu.device.cmd_draw(cmd, mesh.triangles.drawn(), 1, 0, 0) };
            }
            gpu.end_pass(cmd);
        }
        gpu.barriers(
            cmd,
            &[access::image(&self.heights, DEPTH_ATTACHMENT, sampled)],
            &hosts(VERTEX_READ, step.after),
        );
        Ok(())
    }
}

/// The draw of the meshes.
struct Drawn<'a> {
    area: &'a Area,
    corner: [f32; 2],
    changed: Part,
    meshes: &'a [MapMesh],
    /// Whether the previous step also drew meshes.
    before: bool,
    /// Texels of the map along each axis.
    size: u32,
}

fn buffers_of(mesh: &MapMesh) -> impl Iterator<Item = vk::Buffer> {
    let indices = mesh.triangles.indices.map(|(stream, _)| stream.buffer);
    [mesh.triangles.positions.buffer].into_iter().chain(indices)
}

#[cfg(test)]
mod tests {
    use super::Area;

    #[test]
    fn the_horizontal_axes_are_the_documented_ones() {
        let axes = |up| Area { up, center: [0.0; 2], edge: 1.0, level: 0.0, reach: 1.0 }.axes();
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(axes(y), [x, z]);
        assert_eq!(axes(z), [x, [0.0, -1.0, 0.0]]);
        assert_eq!(axes(x), [y, [0.0, 0.0, -1.0]]);
    }
}
