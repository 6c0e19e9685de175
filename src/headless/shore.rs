//! Inputs of shoreline and contact foam that a host engine would provide: its water surface and its shores.

use std::sync::Arc;

use ash::vk;
use glam::Mat4;

use super::Headless;
use super::inputs::{HOST_WRITE, input, stream};
use super::transfer::{check_texels, staging};
use crate::contract::{Shore, Shoreline, Slot, Strip, Triangles};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{COMPUTE_SAMPLED, NOTHING};
use crate::gpu::buffer::Buffer;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::timing::Timing;
use crate::shore::{Area, Heights, MapMesh, ShoreMap, ShoreMapConfig, ShoreMapStep};

/// Triangles of a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShoreMesh<'a> {
    /// Positions of the vertices.
    pub positions: &'a [[f32; 3]],
    /// Vertex indices, three per triangle.
    pub indices: &'a [u32],
}

/// A mesh on the device.
struct Meshed {
    positions: Buffer,
    indices: Buffer,
    counts: [u32; 2],
}

impl Meshed {
    fn new(gpu: &Arc<Gpu>, mesh: &ShoreMesh<'_>) -> Result<Self, Error> {
        Ok(Self {
            positions: input(gpu, "headless/shore", bytemuck::cast_slice(mesh.positions))?,
            indices: input(gpu, "headless/shore", bytemuck::cast_slice(mesh.indices))?,
            counts: [mesh.positions.len() as u32, mesh.indices.len() as u32],
        })
    }

    fn triangles(&self) -> Triangles {
        let [vertices, indices] = self.counts;
        Triangles {
            positions: stream(&self.positions, 12),
            vertices,
            indices: Some((stream(&self.indices, 4), indices)),
        }
    }
}

/// Shoreline and contact foam of the stand-in host.
#[derive(Default)]
pub(super) struct Shores {
    /// Shore of the frames; a strip or a map below replaces its shoreline.
    shore: Option<Shore>,
    strip: Option<(Meshed, Buffer)>,
    map: Option<(ShoreMap, Vec<Meshed>)>,
    /// Replaces the mask of `shore`.
    mask: Option<Image>,
}

impl Shores {
    /// Times of the last step of the map.
    pub fn map_timings(&mut self, slot: Slot) -> Option<&[Timing]> {
        self.map.as_mut().map(|(map, _)| map.timings(slot))
    }

    /// The shore for a frame.
    pub fn shore(&self) -> Option<Shore> {
        let strip = self.strip.as_ref().map(|(mesh, v)| {
            let v = stream(v, 4);
            let strip = Strip {
                triangles: mesh.triangles(),
                coordinates: v,
                before: HOST_WRITE,
                after: HOST_WRITE,
            };
            Shoreline::Strip(strip)
        });
        let map = self.map.as_ref().and_then(|(map, _)| map.shore_distances()).map(Shoreline::Map);
        let mask = self.mask.as_ref().map(|mask| super::draw::host_image(mask, COMPUTE_SAMPLED));
        self.shore.map(|shore| Shore {
            shoreline: strip.or(map).or(shore.shoreline),
            mask: mask.or(shore.mask),
            ..shore
        })
    }
}

impl Headless {
    /// Sets the water surface, shoreline, mask and bias of shoreline and contact foam for the frames that follow; with
    /// `None` they have no such foam. `Some` needs [`Config::shore`](crate::Config::shore). What
    /// [`shore_strip`](Self::shore_strip), [`shore_map`](Self::shore_map) and [`shore_mask`](Self::shore_mask) set
    /// replaces the shoreline and the mask given here.
    pub fn shore(&mut self, shore: Option<Shore>) {
        self.shores.shore = shore;
    }

    /// Sets a strip, a mesh around islands that foam is drawn on, with the shore coordinate v of each vertex. It
    /// replaces an earlier strip. While there is a strip, frames use no map ([`shore_map`](Self::shore_map)).
    ///
    /// # Errors
    /// The numbers of vertices and of values of v differ; no memory; Vulkan errors.
    pub fn shore_strip(&mut self, mesh: &ShoreMesh<'_>, v: &[f32]) -> Result<(), Error> {
        self.shores.strip = None;
        self.gpu.bury();
        if v.len() != mesh.positions.len() {
            let why = format!("{} of {} vertices", v.len(), mesh.positions.len());
            return Err(Error::bad("v", why));
        }
        let own = Meshed::new(&self.gpu, mesh)?;
        let v = input(&self.gpu, "headless/shore/v", bytemuck::cast_slice(v))?;
        self.shores.strip = Some((own, v));
        Ok(())
    }

    /// Sets a map of distances to the shores of meshes, with `size` texels along each axis. It replaces an earlier map.
    /// Frames use it after [`shore_map_step`](Self::shore_map_step) has filled it, unless a strip
    /// ([`shore_strip`](Self::shore_strip)) was set.
    ///
    /// # Errors
    /// Those of [`ShoreMap::new`].
    pub fn shore_map(&mut self, size: u32, meshes: &[ShoreMesh<'_>]) -> Result<(), Error> {
        self.drop_shores();
        let own = meshes.iter().map(|mesh| Meshed::new(&self.gpu, mesh));
        let own = own.collect::<Result<Vec<_>, _>>()?;
        let config = ShoreMapConfig { size, max_meshes: meshes.len().max(1) as u32 };
        let map = ShoreMap::new(&self.context, &config)?;
        self.shores.map = Some((map, own));
        Ok(())
    }

    /// Brings the map up to date after the land has changed; the map is complete when this returns. `transforms` has
    /// one transform for each mesh of [`shore_map`](Self::shore_map). `changed` is the rectangle in which the land
    /// has changed ([`ShoreMapStep::changed`]), or `None` for the whole map.
    ///
    /// # Errors
    /// No map; more or fewer transforms than meshes; the errors of [`ShoreMap::record_step`].
    pub fn shore_map_step(
        &mut self,
        area: &Area,
        transforms: &[Mat4],
        changed: Option<[[f32; 2]; 2]>,
    ) -> Result<(), Error> {
        let Some((mut map, meshes)) = self.shores.map.take() else {
            return Err(Error::bad("shore_map", "none: call shore_map first"));
        };
        let result = if transforms.len() == meshes.len() {
            let all: Vec<_> = meshes
                .iter()
                .zip(transforms)
                .map(|(mesh, transform)| MapMesh {
                    triangles: mesh.triangles(),
                    transform: transform.to_cols_array_2d(),
                })
                .collect();
            let heights = Heights::Meshes(&all);
            let (before, after) = (HOST_WRITE, HOST_WRITE);
            let step = ShoreMapStep { slot: Slot(0), area: *area, heights, changed, before, after };
            // SAFETY: submitted at once, and waited for.
            let result = self.run(|_, cmd| unsafe { map.record_step(cmd, &step) });
            if result.is_err() {
                map.abandon(Slot(0));
            }
            result
        } else {
            let why = format!("{} of {} meshes", transforms.len(), meshes.len());
            Err(Error::bad("transforms", why))
        };
        self.shores.map = Some((map, meshes));
        result
    }

    /// GPU time of the last step of the map of shore distances in nanoseconds; `None` before the first.
    pub fn shore_map_time(&mut self) -> Option<f64> {
        let (map, _) = self.shores.map.as_mut()?;
        map.timings(Slot(0)).first().map(|timing| timing.nanoseconds)
    }

    /// Sets the foam texture of the frames that follow, instead of the built-in one: 1 where foam appears first, 0
    /// where it appears last. `size` is the number of texels along x and y.
    ///
    /// # Errors
    /// The number of texels differs from `size`; no [`Config::shore`](crate::Config::shore); no memory; Vulkan
    /// errors.
    pub fn shore_web(&mut self, size: [u32; 2], texels: &[f32]) -> Result<(), Error> {
        let (image, staged) = self.values("web", size, texels)?;
        // SAFETY: every run waits for its end.
        unsafe { self.renderer.collect(Slot(0)) };
        self.run(|this, cmd| {
            this.upload(cmd, &staged, &image, NOTHING, COMPUTE_SAMPLED);
            let host = super::draw::host_image(&image, COMPUTE_SAMPLED);
            // SAFETY: submitted at once, and waited for.
            unsafe { this.renderer.record_foam_texture(cmd, Slot(0), &host) }
        })
    }

    /// Sets a mask over the whole picture for the contact foam of the frames that follow, instead of an earlier mask: 0
    /// suppresses the foam completely, 1 not at all. `size` is the number of texels along x and y.
    ///
    /// # Errors
    /// The number of texels differs from `size`; no memory; Vulkan errors.
    pub fn shore_mask(&mut self, size: [u32; 2], texels: &[f32]) -> Result<(), Error> {
        self.shores.mask = None;
        self.gpu.bury();
        let (image, staged) = self.values("mask", size, texels)?;
        self.run(|this, cmd| {
            this.upload(cmd, &staged, &image, NOTHING, COMPUTE_SAMPLED);
            Ok(())
        })?;
        self.shores.mask = Some(image);
        Ok(())
    }

    /// Creates an image of one channel, and a buffer with its contents.
    fn values(
        &self,
        field: &'static str,
        [width, height]: [u32; 2],
        texels: &[f32],
    ) -> Result<(Image, Buffer), Error> {
        let extent = vk::Extent2D { width, height };
        check_texels(&self.gpu, field, extent, texels.len())?;
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc::new("headless/shore", extent, vk::Format::R32_SFLOAT, usage);
        let image = Image::new(&self.gpu, &desc)?;
        Ok((image, staging(&self.gpu, bytemuck::cast_slice(texels))?))
    }

    pub(super) fn drop_shores(&mut self) {
        if let Some((map, _)) = self.shores.map.take() {
            // SAFETY: every run waits for its end.
            unsafe { map.destroy() };
        }
        self.gpu.bury();
    }
}
