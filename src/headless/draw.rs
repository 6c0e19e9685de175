//! Draws a frame: the background, then the water over it, submitted and waited for.

use ash::vk;

use super::generate::Generating;
use super::inputs::{Foamed, WhitewaterBuffers};
use super::submit::Parts;
use super::transfer::{check_texels, staging};
use super::{COLOR_REST, DEPTH_REST, Headless};
use crate::bubbles::BlobSimulation;
use crate::contract::{
    Access, Camera, Frame, HostImage, LightVolume, Particles, Previous, Settings, Slot,
};
use crate::error::Error;
use crate::frame::Lens;
use crate::gpu::access;
use crate::gpu::buffer::Buffer;
use crate::gpu::graveyard::Destroy;
use crate::gpu::image::{Image, aspect_of};
use crate::water::settings::Shadows;

/// The background behind the water.
pub enum Background<'a> {
    /// One colour, with the depth of the far plane.
    Color([f32; 3]),
    /// The scene that was set with [`Headless::scene`].
    Scene,
    /// Images from the CPU, row by row: linear RGBA and device depth.
    Images {
        /// width × height linear RGBA.
        color: &'a [[f32; 4]],
        /// width × height device depth.
        depth: &'a [f32],
    },
}

impl Headless {
    /// Sets the sphere in which water and foam cast shadows and caustics. Frames need it exactly if
    /// [`Config::light_map_size`](crate::Config::light_map_size) is set. The shadows that the scene casts on water and
    /// foam need no sphere: with [`Shadows::Map`] or [`Shadows::Convolution`] they come from the scene's shadow map.
    pub fn region(&mut self, region: LightVolume) {
        self.region = Some(region);
    }

    /// Sets the camera of the previous frame and the time from that frame to the next one drawn. Motion vectors are
    /// computed from them ([`Config::motion`](crate::Config::motion)). Camera and time apply to all frames until the
    /// next call. With `None`, as initially, the vectors are zero.
    pub fn previous(&mut self, previous: Option<Previous>) {
        self.previous = previous;
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// No particles uploaded, no scene for [`Background::Scene`], no memory, and the errors of
    /// [`Renderer::record`](crate::Renderer::record).
    pub fn render(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
    ) -> Result<(), Error> {
        self.render_frame(camera, settings, background, false)
    }

    /// Like [`render`](Self::render), but the CPU decides when the smoothing of the water's depth ends: it submits
    /// blocks of iterations one by one and reads each block's occlusion query back, as in the thesis of F. Bagar
    /// (2010). For comparison only. Without [`Smoothing::Query`](crate::water::Smoothing::Query) it does what `render`
    /// does.
    ///
    /// # Errors
    /// Those of [`render`](Self::render).
    pub fn render_with_read_back(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
    ) -> Result<(), Error> {
        self.render_frame(camera, settings, background, true)
    }

    fn render_frame(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
        read_back: bool,
    ) -> Result<(), Error> {
        let particles = self.streams()?;
        let pictures = self.staged(background)?;
        let result = self.run_parts(|this, cmd| {
            match background {
                Background::Color(color) => this.clear(cmd, *color, camera),
                Background::Scene => this.draw_scene(cmd, camera)?,
                Background::Images { .. } => {
                    if let Some([color, depth]) = &pictures {
                        this.upload(cmd, color, &this.color, COLOR_REST, COLOR_REST);
                        this.upload(cmd, depth, &this.depth, DEPTH_REST, DEPTH_REST);
                    }
                }
            }
            this.record_water(cmd, camera, settings, particles, read_back)
        });
        for picture in pictures.into_iter().flatten() {
            picture.destroy(&self.gpu);
        }
        // SAFETY: every run waits for its end.
        unsafe { self.renderer.collect(Slot(0)) };
        self.gpu.bury();
        if result.is_err() {
            self.forget_scene();
        }
        result
    }

    /// Staging buffers with colour and depth of a background from the CPU.
    fn staged(&self, background: &Background<'_>) -> Result<Option<[Buffer; 2]>, Error> {
        let Background::Images { color, depth } = background else { return Ok(None) };
        check_texels(&self.gpu, "Background.color", self.color.extent, color.len())?;
        check_texels(&self.gpu, "Background.depth", self.depth.extent, depth.len())?;
        let half: Vec<[u16; 4]> =
            color.iter().map(|c| c.map(|v| half::f16::from_f32(v).to_bits())).collect();
        let color = staging(&self.gpu, bytemuck::cast_slice(&half))?;
        Ok(Some([color, staging(&self.gpu, bytemuck::cast_slice(depth))?]))
    }

    /// Records the water over the background in the colour and depth images. Returns the command buffer in which the
    /// recording ended. What is needed to read the frame's layers and counts back is kept in `self`.
    fn record_water(
        &mut self,
        cmd: vk::CommandBuffer,
        camera: &Camera,
        settings: &Settings,
        particles: Particles,
        read_back: bool,
    ) -> Result<vk::CommandBuffer, Error> {
        let output = host_image(&self.color, COLOR_REST);
        let maps = |kind| matches!(kind, Shadows::Map | Shadows::Convolution(_));
        let shadowed = self.renderer.config().shadow.is_some_and(maps);
        let stage = self.scene.as_ref().filter(|_| shadowed);
        let shadow = stage.map(|stage| stage.renderer.shadow(settings.water.spacing));
        let made = self
            .generating
            .as_ref()
            .filter(|made| made.shown && self.renderer.config().whitewater.is_some());
        let whitewater = made.map(Generating::particles);
        let whitewater =
            whitewater.or_else(|| self.whitewater.as_ref().map(WhitewaterBuffers::streams));
        let whitewater = whitewater.filter(|_| self.whitewater_shown);
        let drawn = self.renderer.config().bubbles.is_some();
        let heap = self.heap.as_ref().filter(|_| drawn).map(BlobSimulation::blobs);
        let bubbles = heap.or_else(|| self.bubbles.as_ref().map(Foamed::streams));
        let frame = Frame {
            slot: Slot(0),
            output,
            scene_color: output,
            scene_depth: host_image(&self.depth, DEPTH_REST),
            particles,
            whitewater,
            bubbles,
            shore: self.shores.shore(),
            camera: *camera,
            shadow,
            light_volume: self.region,
            previous: self.previous,
            panes: &self.panes,
            settings,
        };
        let mut parts = Parts {
            gpu: self.gpu.clone(),
            queue: self.device.queue,
            fence: self.commands.fence.handle,
            pool: self.commands.pool.handle,
            spare: std::mem::take(&mut self.parts),
            used: 0,
        };
        let mut stop = |cmd, pool, query| parts.read_back(cmd, pool, query);
        let stop: Option<crate::water::ReadBack<'_>> =
            if read_back { Some(&mut stop) } else { None };
        // SAFETY: cmd is recording outside a render pass; the slot's work is done.
        let result = unsafe { self.renderer.record_frame(cmd, &frame, stop) };
        self.parts = parts.spare;
        let (recorded, last) = result?;
        self.layers = recorded.layers;
        self.counts = recorded.diagnostics.counts;
        self.levels = recorded.diagnostics.levels;
        // Where the CPU reads the queries, no command copies their results.
        self.active_samples = recorded.diagnostics.active_samples.filter(|_| !read_back);
        self.bubble_words = recorded.diagnostics.bubbles;
        Ok(last)
    }

    /// Clears to one colour, and the depth to the far plane.
    fn clear(&self, cmd: vk::CommandBuffer, color: [f32; 3], camera: &Camera) {
        let far = Lens::new(camera).map_or(1.0, |lens| lens.nothing());
        let [r, g, b] = color;
        self.gpu.barriers(
            cmd,
            &[
                access::image(&self.color, COLOR_REST.discarded(), access::CLEAR),
                access::image(&self.depth, DEPTH_REST.discarded(), access::CLEAR),
            ],
            &[],
        );
        self.gpu.clear_color(cmd, &self.color, [r, g, b, 1.0]);
        // SAFETY: the image is in TRANSFER_DST_OPTIMAL.
        unsafe {
            self.gpu.device.cmd_clear_depth_stencil_image(
                cmd,
                self.depth.handle,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &vk::ClearDepthStencilValue { depth: far, stencil: 0 },
                &[access::whole(aspect_of(self.depth.format))],
            );
        }
        self.gpu.barriers(
            cmd,
            &[
                access::image(&self.color, access::CLEAR, COLOR_REST),
                access::image(&self.depth, access::CLEAR, DEPTH_REST),
            ],
            &[],
        );
    }
}

/// An image of this module, in the form that a host passes.
pub(super) fn host_image(image: &Image, rest: Access) -> HostImage {
    HostImage {
        image: image.handle,
        view: image.view,
        format: image.format,
        aspect: aspect_of(image.format),
        extent: image.extent,
        rect: image.extent.into(),
        before: rest,
        after: rest,
    }
}
