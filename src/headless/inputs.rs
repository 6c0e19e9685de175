//! Particles of a frame, and steps of surface foam from their motion.

use std::ops::Range;
use std::sync::Arc;

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::{Pod, Zeroable};

use super::Headless;
use crate::contract::{
    Access, Blobs, Count, Packets, Particles, Slot, Stream, SurfaceFoamStep, WhitewaterParticles,
};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::COPY_WRITE;
use crate::gpu::buffer::Buffer;
use crate::gpu::graveyard::Destroy;
use crate::state::{SurfaceFoamState, SurfaceFoamStateConfig};
use crate::water::settings::WeberSettings;

/// State of surface foam.
pub(super) struct Foaming {
    pub state: SurfaceFoamState,
    /// Whether a step was made with the current particles.
    stepped: bool,
}

/// Whitewater particles of a frame, each attribute as long as `positions`, with the meaning of
/// [`WhitewaterParticles`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Whitewater<'a> {
    /// World-space centres.
    pub positions: &'a [[f32; 3]],
    /// Kinds: 0 foam, 1 spray, 2 bubble.
    pub kinds: Option<&'a [u32]>,
    /// Radii, scene units.
    pub radii: Option<&'a [f32]>,
    /// Relative ages, 0 to 1.
    pub ages: Option<&'a [f32]>,
    /// Numbers that identify a particle from frame to frame.
    pub ids: Option<&'a [u32]>,
}

/// Whitewater particles on the device.
pub(super) struct WhitewaterBuffers {
    count: u32,
    positions: Buffer,
    kinds: Option<Buffer>,
    radii: Option<Buffer>,
    ages: Option<Buffer>,
    ids: Option<Buffer>,
    packets: Option<Buffer>,
}

impl Whitewater<'_> {
    /// Which attributes exist besides positions.
    fn attributes(&self) -> [bool; 4] {
        self.words().map(|words| words.is_some())
    }

    /// Attributes of one word each: kinds, radii, ages, ids.
    fn words(&self) -> [Option<&[u8]>; 4] {
        [
            self.kinds.map(bytemuck::cast_slice),
            self.radii.map(bytemuck::cast_slice),
            self.ages.map(bytemuck::cast_slice),
            self.ids.map(bytemuck::cast_slice),
        ]
    }
}

impl WhitewaterBuffers {
    /// Allocates buffers for `count` particles.
    fn new(gpu: &Arc<Gpu>, count: u32, attributes: [bool; 4]) -> Result<Self, Error> {
        let room = |name, bytes: u64| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
            let size = (bytes * u64::from(count)).max(16);
            Buffer::new(gpu, name, size, usage, MemoryLocation::GpuOnly)
        };
        let some = |there: bool, name| there.then(|| room(name, 4)).transpose();
        let [kinds, radii, ages, ids] = attributes;
        Ok(Self {
            count,
            positions: room("headless/whitewater", 12)?,
            kinds: some(kinds, "headless/whitewater/kinds")?,
            radii: some(radii, "headless/whitewater/radii")?,
            ages: some(ages, "headless/whitewater/ages")?,
            ids: some(ids, "headless/whitewater/ids")?,
            packets: None,
        })
    }

    pub fn streams(&self) -> WhitewaterParticles {
        let words = |buffer: &Option<Buffer>| buffer.as_ref().map(|buffer| stream(buffer, 4));
        WhitewaterParticles {
            kinds: words(&self.kinds),
            radii: words(&self.radii),
            ages: words(&self.ages),
            ids: words(&self.ids),
            packets: self.packets.as_ref().map(|buffer| Packets {
                buffer: buffer.handle,
                offset: 0,
                count: self.count.div_ceil(packet_size(self.count)),
            }),
            before: COPY_WRITE,
            after: COPY_WRITE,
            ..WhitewaterParticles::new(stream(&self.positions, 12), Count::Cpu(self.count))
        }
    }

    /// Size of its buffers in bytes.
    fn size(&self) -> u64 {
        let words = [&self.kinds, &self.radii, &self.ages, &self.ids, &self.packets];
        let words = words.into_iter().flatten().map(|buffer| buffer.size).sum::<u64>();
        self.positions.size + words
    }
}

/// Number of particles per packet (a run of particles with a common bounding box): a multiple of 64, at least 256,
/// and so many that there are at most 65,535 packets.
fn packet_size(count: u32) -> u32 {
    count.div_ceil(65_535).next_multiple_of(64).max(256)
}

/// A bounding box, initially empty.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Packet {
    first: u32,
    count: u32,
    low: [f32; 3],
    high: [f32; 3],
}

/// Builds packets of particles that arrive in parts.
struct Packing {
    size: u32,
    all: Vec<Packet>,
}

impl Packing {
    fn add(&mut self, mut first: u32, part: &Whitewater<'_>) {
        for (i, position) in part.positions.iter().enumerate() {
            if first.is_multiple_of(self.size) {
                let (low, high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
                self.all.push(Packet { first, count: self.size, low, high });
            }
            first += 1;
            let Some(packet) = self.all.last_mut() else { continue };
            let radius = part.radii.map_or(0.0, |radii| radii[i].max(0.0));
            // Non-finite particles are not drawn, and min and max would ignore NaN.
            if position.iter().all(|v| v.is_finite()) {
                for (k, v) in position.iter().enumerate() {
                    packet.low[k] = packet.low[k].min(v - radius);
                    packet.high[k] = packet.high[k].max(v + radius);
                }
            }
        }
    }
}

/// Size of the staging buffer in bytes.
const STAGING: usize = 4 << 20;

/// An upload of whitewater particles in parts, from [`Headless::whitewater_parts`]. If it is dropped before
/// [`finish`](Self::finish), there are no whitewater particles.
pub struct WhitewaterParts<'a> {
    headless: &'a mut Headless,
    count: u32,
    written: u32,
    /// Set by the first part, which determines the attributes.
    made: Option<(WhitewaterBuffers, Buffer)>,
    packing: Option<Packing>,
}

impl WhitewaterParts<'_> {
    /// Uploads the next particles. The slices need not outlive the call. Before [`finish`](Self::finish) all
    /// announced particles have to be uploaded.
    ///
    /// # Errors
    /// An attribute is not as long as the positions; the part has other attributes than the previous part; there are
    /// more whitewater particles than [`Headless::whitewater_parts`] announced; no memory; Vulkan errors. The failed
    /// part is ignored: the upload may go on with another one.
    pub fn push(&mut self, part: &Whitewater<'_>) -> Result<(), Error> {
        let length = part.positions.len();
        if part.words().into_iter().flatten().any(|words| words.len() != 4 * length) {
            return Err(Error::bad("whitewater", "an attribute is not as long as positions"));
        }
        let left = self.count - self.written;
        let Some(length) = u32::try_from(length).ok().filter(|length| *length <= left) else {
            let why = format!("expected at most {left} more particles, found a part of {length}");
            return Err(Error::bad("whitewater", why));
        };
        let (buffers, staging) = match &mut self.made {
            Some(made) => made,
            made => {
                let gpu = &self.headless.gpu;
                let new = WhitewaterBuffers::new(gpu, self.count, part.attributes())?;
                // No larger than all the data, which is often small.
                let least = size_of::<Packet>() as u64;
                let size = (12 * u64::from(self.count)).clamp(least, STAGING as u64);
                let usage = vk::BufferUsageFlags::TRANSFER_SRC;
                let location = MemoryLocation::CpuToGpu;
                let staging =
                    Buffer::new(gpu, "headless/whitewater/staging", size, usage, location)?;
                made.insert((new, staging))
            }
        };
        let to = [&buffers.kinds, &buffers.radii, &buffers.ages, &buffers.ids];
        if to.map(Option::is_some) != part.attributes() {
            return Err(Error::bad(
                "whitewater",
                "its attributes differ from those of the previous part",
            ));
        }
        let first = u64::from(self.written);
        let positions = bytemuck::cast_slice(part.positions);
        self.headless.copy(staging, positions, &buffers.positions, 12 * first)?;
        for (to, words) in to.into_iter().zip(part.words()) {
            if let (Some(to), Some(words)) = (to, words) {
                self.headless.copy(staging, words, to, 4 * first)?;
            }
        }
        if let Some(packing) = &mut self.packing {
            packing.add(self.written, part);
        }
        self.written += length;
        Ok(())
    }

    /// Ends the upload. The following frames show these whitewater particles.
    ///
    /// # Errors
    /// Fewer whitewater particles in all parts than announced, or no memory. After an error there are no whitewater
    /// particles.
    pub fn finish(mut self) -> Result<(), Error> {
        if self.written < self.count {
            let why = format!("expected {} particles, found {}", self.count, self.written);
            return Err(Error::bad("whitewater", why));
        }
        self.headless.whitewater = match self.made.take() {
            Some((mut buffers, mut staging)) => {
                if let Some(packing) = &self.packing {
                    let bytes: &[u8] = bytemuck::cast_slice(&packing.all);
                    let usage =
                        vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
                    let (name, place) = ("headless/whitewater/packets", MemoryLocation::GpuOnly);
                    let size = bytes.len() as u64;
                    let buffer = Buffer::new(&self.headless.gpu, name, size, usage, place)?;
                    self.headless.copy(&mut staging, bytes, &buffer, 0)?;
                    buffers.packets = Some(buffer);
                }
                Some(buffers)
            }
            None => Some(WhitewaterBuffers::new(&self.headless.gpu, 0, [false; 4])?),
        };
        Ok(())
    }
}

/// A blob of bubble foam, with the meaning of [`Blobs`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Bubble {
    /// World-space centre and radius.
    pub ball: [f32; 4],
    /// Orientation: a quaternion, the real part last.
    pub turn: [f32; 4],
    /// A number that identifies the blob from frame to frame.
    pub id: u32,
}

/// Blobs on the device.
pub(super) struct Foamed {
    count: u32,
    blobs: Buffer,
}

impl Foamed {
    pub fn new(gpu: &Arc<Gpu>, blobs: &[Bubble]) -> Result<Self, Error> {
        let count =
            u32::try_from(blobs.len()).map_err(|_| Error::bad("bubbles", "2^32 blobs or more"))?;
        // Also without blobs all attributes lie within the buffer.
        let none = [Bubble::zeroed()];
        let bytes = if blobs.is_empty() { &none[..] } else { blobs };
        let blobs = input(gpu, "headless/bubbles", bytemuck::cast_slice(bytes))?;
        Ok(Self { count, blobs })
    }

    pub fn streams(&self) -> Blobs {
        let all = stream(&self.blobs, size_of::<Bubble>() as u32);
        Blobs {
            rotations: Some(Stream { offset: 16, ..all }),
            ids: Some(Stream { offset: 32, ..all }),
            before: HOST_WRITE,
            after: HOST_WRITE,
            ..Blobs::new(all, Count::Cpu(self.count))
        }
    }
}

/// Writes of the CPU before the submission.
pub(super) const HOST_WRITE: Access = Access::new(
    vk::PipelineStageFlags2::HOST,
    vk::AccessFlags2::HOST_WRITE,
    vk::ImageLayout::GENERAL,
);

/// A storage buffer with contents.
pub(super) fn input(gpu: &Arc<Gpu>, name: &str, bytes: &[u8]) -> Result<Buffer, Error> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let size = bytes.len().max(16) as u64;
    let mut buffer = Buffer::new(gpu, name, size, usage, MemoryLocation::CpuToGpu)?;
    buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
    Ok(buffer)
}

pub(super) fn stream(buffer: &Buffer, stride: u32) -> Stream {
    Stream { buffer: buffer.handle, size: buffer.size, offset: 0, stride }
}

impl Headless {
    /// Uploads the particles of a frame. Densities, velocities and ids that were uploaded before are discarded.
    ///
    /// # Errors
    /// Another number of densities than of positions; no memory. More particles than
    /// [`Config::max_particles`](crate::Config::max_particles) are refused only by the calls that use them, such as
    /// [`render`](Self::render).
    pub fn particles(
        &mut self,
        positions: &[[f32; 3]],
        densities: Option<&[f32]>,
    ) -> Result<(), Error> {
        if densities.is_some_and(|d| d.len() != positions.len()) {
            return Err(Error::bad("densities", "not as many as positions"));
        }
        if let Some(foam) = &mut self.foam {
            foam.stepped = false;
        }
        self.count = u32::try_from(positions.len())
            .map_err(|_| Error::bad("positions", "more than 2^32"))?;
        let old = [&mut self.positions, &mut self.densities, &mut self.velocities, &mut self.ids];
        for old in old.into_iter().filter_map(Option::take) {
            old.destroy(&self.gpu);
        }
        let make = |name, bytes: &[u8]| input(&self.gpu, name, bytes);
        self.positions = Some(make("headless/positions", bytemuck::cast_slice(positions))?);
        if let Some(densities) = densities {
            self.densities = Some(make("headless/densities", bytemuck::cast_slice(densities))?);
        }
        Ok(())
    }

    /// Replaces the densities of the particles that were uploaded last. A caller can thus advance surface foam with the
    /// densities of a file, and then draw the frame, whose spray follows from densities, with other values.
    ///
    /// # Errors
    /// The number of densities differs from the number of particles, or the particles were uploaded without densities.
    pub fn replace_densities(&mut self, densities: &[f32]) -> Result<(), Error> {
        match &mut self.densities {
            Some(buffer) if densities.len() == self.count as usize => {
                let bytes = bytemuck::cast_slice(densities);
                buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
                Ok(())
            }
            _ => Err(Error::bad("densities", "not as many as were uploaded")),
        }
    }

    /// Replaces the positions of the particles that were uploaded last; their densities, velocities, ids and surface
    /// foam stay.
    ///
    /// # Errors
    /// The number of positions differs from the number of particles uploaded.
    pub fn move_particles(&mut self, positions: &[[f32; 3]]) -> Result<(), Error> {
        match &mut self.positions {
            Some(buffer) if positions.len() == self.count as usize => {
                let bytes = bytemuck::cast_slice(positions);
                buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
                Ok(())
            }
            _ => Err(Error::bad("positions", "not as many as were uploaded")),
        }
    }

    /// Uploads the velocities, and optionally the ids, of the particles whose positions were uploaded last.
    /// Velocities are used for foam, whitewater, spray and motion vectors. Ids identify particles from frame to
    /// frame, so that foam, its noise and the droplets of spray stay attached to their particles.
    ///
    /// # Errors
    /// A number of velocities or ids that differs from that of positions; no memory.
    pub fn motion(&mut self, velocities: &[[f32; 3]], ids: Option<&[u32]>) -> Result<(), Error> {
        let all = |length: usize| length == self.count as usize;
        if !all(velocities.len()) || ids.is_some_and(|ids| !all(ids.len())) {
            return Err(Error::bad("velocities", "not as many as positions, or as ids"));
        }
        for old in [self.velocities.take(), self.ids.take()].into_iter().flatten() {
            old.destroy(&self.gpu);
        }
        let make = |name, bytes: &[u8]| input(&self.gpu, name, bytes);
        self.velocities = Some(make("headless/velocities", bytemuck::cast_slice(velocities))?);
        if let Some(ids) = ids {
            self.ids = Some(make("headless/ids", bytemuck::cast_slice(ids))?);
        }
        Ok(())
    }

    /// Uploads the blobs of bubble foam of a frame, with [`Config::bubbles`](crate::Config::bubbles). It ends a
    /// simulation that [`heap`](Self::heap) has started.
    ///
    /// # Errors
    /// More than [`BubbleConfig::max_blobs`](crate::bubbles::BubbleConfig::max_blobs), no memory. After an error there
    /// are no blobs.
    pub fn bubbles(&mut self, blobs: &[Bubble]) -> Result<(), Error> {
        self.bubbles = None;
        self.drop_heap();
        self.gpu.bury();
        let most = self.renderer.config().bubbles.map_or(u32::MAX, |config| config.max_blobs);
        if blobs.len() > most as usize {
            let why = format!("{} is more than Config.bubbles.max_blobs, {most}", blobs.len());
            return Err(Error::bad("bubbles", why));
        }
        self.bubbles = Some(Foamed::new(&self.gpu, blobs)?);
        Ok(())
    }

    /// Uploads the whitewater particles of a frame, with [`Config::whitewater`](crate::Config::whitewater). `None`
    /// removes them.
    ///
    /// # Errors
    /// Those of [`whitewater_parts`](Self::whitewater_parts) and [`WhitewaterParts::push`]. After an error there are no
    /// whitewater particles.
    pub fn whitewater(&mut self, whitewater: Option<&Whitewater<'_>>) -> Result<(), Error> {
        let mut parts = self.whitewater_parts(whitewater.map_or(0, |all| all.positions.len()))?;
        match whitewater {
            Some(all) => {
                parts.push(all)?;
                parts.finish()
            }
            None => Ok(()),
        }
    }

    /// Uploads the whitewater particles of a frame in parts, so that only one part is in the host's memory at a time,
    /// for example from a file that is being read. `count` is the total number. No whitewater particles are drawn
    /// until [`WhitewaterParts::finish`].
    ///
    /// # Errors
    /// More than [`WhitewaterConfig::max_particles`](crate::whitewater::WhitewaterConfig::max_particles).
    pub fn whitewater_parts(&mut self, count: usize) -> Result<WhitewaterParts<'_>, Error> {
        self.whitewater = None;
        self.hide_generated();
        self.gpu.bury();
        let most =
            self.renderer.config().whitewater.map_or(u32::MAX, |config| config.max_particles);
        let Some(count) = u32::try_from(count).ok().filter(|count| *count <= most) else {
            let why = format!("{count} is more than Config.whitewater.max_particles, {most}");
            return Err(Error::bad("whitewater", why));
        };
        let packets = self.renderer.config().whitewater.is_some_and(|config| config.packets);
        let packing = packets.then(|| Packing { size: packet_size(count), all: Vec::new() });
        Ok(WhitewaterParts { headless: self, count, written: 0, made: None, packing })
    }

    /// Size in bytes of the buffers of uploaded whitewater particles.
    pub fn whitewater_memory(&self) -> u64 {
        self.whitewater.as_ref().map_or(0, WhitewaterBuffers::size)
    }

    /// Copies bytes to an offset in a buffer, in pieces of the staging buffer's size.
    fn copy(
        &mut self,
        staging: &mut Buffer,
        bytes: &[u8],
        to: &Buffer,
        mut at: u64,
    ) -> Result<(), Error> {
        for bytes in bytes.chunks(staging.mapped().len().max(1)) {
            staging.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
            let size = bytes.len() as u64;
            let region = vk::BufferCopy { src_offset: 0, dst_offset: at, size };
            self.run(|this, cmd| {
                // SAFETY: cmd is recording; both ranges lie in their buffers; every earlier run has ended.
                unsafe {
                    let device = &this.gpu.device;
                    device.cmd_copy_buffer(cmd, staging.handle, to.handle, &[region]);
                }
                Ok(())
            })?;
            at += size;
        }
        Ok(())
    }

    /// Advances surface foam, with [`Config::surface_foam`](crate::Config::surface_foam): one step of a
    /// [`SurfaceFoamState`] from the particles' [`motion`](Self::motion). `dt` is the time since the previous step in
    /// seconds. If `dt` is `None`, or the motion has no ids, earlier steps do not count: the foam of a particle
    /// follows from its present Weber number alone.
    ///
    /// # Errors
    /// No motion uploaded, no memory, and the errors of [`SurfaceFoamState::record_step`].
    pub fn step(&mut self, dt: Option<f32>, settings: &WeberSettings) -> Result<(), Error> {
        let Some(velocities) = &self.velocities else {
            return Err(Error::bad("velocities", "none uploaded"));
        };
        let velocities = stream(velocities, 12);
        // Creating the state is the last operation that can return early before it is stored again: if it were
        // dropped, its objects would leak.
        let mut state = match self.foam.take() {
            Some(old) => old.state,
            None => {
                let config = SurfaceFoamStateConfig::new(self.renderer.config().max_particles);
                SurfaceFoamState::new(&self.context, &config)?
            }
        };
        let step = SurfaceFoamStep {
            slot: Slot(0),
            velocities,
            densities: self.densities.as_ref().map(|buffer| stream(buffer, 4)),
            ids: self.ids.as_ref().filter(|_| dt.is_some()).map(|ids| stream(ids, 4)),
            count: Count::Cpu(self.count),
            dt: dt.unwrap_or(0.0),
            settings,
            before: HOST_WRITE,
            after: HOST_WRITE,
        };
        // SAFETY: cmd is recording outside a render pass; every run waits for its end.
        let result = self.run(|_, cmd| unsafe { state.record_step(cmd, &step) });
        if result.is_err() {
            state.abandon(Slot(0));
        }
        self.foam = Some(Foaming { state, stepped: result.is_ok() });
        result
    }

    /// Draws only a range of the uploaded particles, by index; `None` draws all. Only the drawn particles emit
    /// whitewater, whereas steps of surface foam use all particles.
    pub fn show(&mut self, some: Option<Range<u32>>) {
        self.shown = some;
    }

    /// Shows or hides all whitewater, uploaded or emitted ([`generate`](Self::generate)), in the frames that follow;
    /// initially it is shown. Hidden whitewater is kept.
    pub fn show_whitewater(&mut self, shown: bool) {
        self.whitewater_shown = shown;
    }

    /// The particles in the form of a frame's input.
    pub(super) fn streams(&self) -> Result<Particles, Error> {
        let Some(positions) = &self.positions else {
            return Err(Error::bad("particles", "none uploaded"));
        };
        let Range { start, end } = self.shown.clone().unwrap_or(0..self.count);
        let first = start.min(self.count);
        let count = end.min(self.count).saturating_sub(first);
        let some = |all: Stream| Stream { offset: u64::from(first) * u64::from(all.stride), ..all };
        let of = |buffer: &Buffer, stride| some(stream(buffer, stride));
        let stepped = self.foam.as_ref().filter(|foam| foam.stepped);
        let foam = stepped.map(|foam| some(foam.state.foam()));
        Ok(Particles {
            densities: self.densities.as_ref().map(|buffer| of(buffer, 4)),
            velocities: self.velocities.as_ref().map(|buffer| of(buffer, 12)),
            ids: self.ids.as_ref().map(|buffer| of(buffer, 4)),
            surface_foam: foam,
            before: HOST_WRITE,
            after: HOST_WRITE,
            ..Particles::new(of(positions, 12), Count::Cpu(count))
        })
    }
}
