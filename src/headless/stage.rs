//! Sets up a scene, which stands in for that of a host engine, and draws it into the images that the water is
//! drawn over.

use std::sync::Arc;

use ash::vk;

use super::scene::bake::Baked;
use super::scene::{Scene, SceneFrame, SceneRenderer};
use super::{COLOR_FORMAT, COLOR_REST, DEPTH_FORMAT, DEPTH_REST, Headless, transfer};
use crate::contract::{Access, Camera, Slot};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access;
use crate::gpu::descriptors::Descriptors;
use crate::gpu::image::{Image, ImageDesc};

/// The stand-in scene with the descriptor sets for drawing it.
pub(super) struct Stage {
    pub renderer: SceneRenderer,
    descriptors: Descriptors,
    /// Frame of the scene at the last set-up, and whether edges are smoothed.
    drawn: (u64, bool),
    /// The last picture of the scene, reused while the camera is at rest.
    kept: Option<Kept>,
}

/// Colour and depth of the scene from a camera, without the water.
struct Kept {
    color: Image,
    depth: Image,
    /// `None` if nothing is kept yet, or a frame failed.
    camera: Option<Camera>,
}

/// State of the kept images between frames.
const KEPT_REST: Access = access::COPY_READ;

impl Kept {
    fn new(gpu: &Gpu, extent: vk::Extent2D) -> Result<Self, Error> {
        let image = |name, format| {
            let usage = vk::ImageUsageFlags::SAMPLED
                | vk::ImageUsageFlags::TRANSFER_SRC
                | vk::ImageUsageFlags::TRANSFER_DST;
            Image::new(gpu, &ImageDesc::new(name, extent, format, usage))
        };
        Ok(Self {
            color: image("headless/kept/color", COLOR_FORMAT)?,
            depth: image("headless/kept/depth", DEPTH_FORMAT)?,
            camera: None,
        })
    }
}

impl Headless {
    /// Sets the scene behind the water, drawn by [`Background::Scene`](super::Background::Scene). `antialias` draws its
    /// colour with four samples per pixel, if the device supports that. The light of the scene is baked here, so a
    /// change of its sun needs another call.
    ///
    /// # Errors
    /// Those of [`SceneRenderer::new`]. After an error there is no scene.
    pub fn scene(&mut self, scene: &Scene, antialias: bool) -> Result<(), Error> {
        self.set_up_scene(scene, antialias, None)
    }

    /// Moves the current scene to another [`frame`](Scene::frame) and [`time`](Scene::time): `scene` is the current
    /// scene with other values of these two. Only meshes in [`Scene::motions`] and the sea may move. Moving meshes keep
    /// their baked light, and the sun's shadow map is redrawn. If only the sea moves, nothing is uploaded or redrawn
    /// here. Without a current scene, `scene` becomes the current one, as with [`Headless::scene`].
    ///
    /// # Errors
    /// Those of [`SceneRenderer::new`], and an invalid time.
    pub fn scene_frame(&mut self, scene: &Scene, antialias: bool) -> Result<(), Error> {
        if let Some(stage) = &mut self.scene {
            let (frame, smoothed) = stage.drawn;
            if scene.sea.is_some()
                && smoothed == antialias
                && scene.solids_rest_between(frame, scene.frame)
            {
                stage.renderer.sea_at(scene)?;
                self.forget_scene();
                return Ok(());
            }
        }
        let light = self.scene.as_ref().map(|stage| Arc::clone(&stage.renderer.baked));
        self.set_up_scene(scene, antialias, light)
    }

    fn set_up_scene(
        &mut self,
        scene: &Scene,
        antialias: bool,
        light: Option<Arc<Baked>>,
    ) -> Result<(), Error> {
        if let Some(old) = self.scene.take() {
            old.renderer.destroy(&self.gpu);
        }
        self.panes.clear();
        let gpu = &self.gpu;
        let (color, depth) = (COLOR_FORMAT, DEPTH_FORMAT);
        let made = match light {
            Some(light) => SceneRenderer::with_light(gpu, scene, &light, color, depth, antialias),
            None => SceneRenderer::new(gpu, scene, color, depth, antialias),
        };
        let made = made.and_then(|renderer| {
            let descriptors = Descriptors::new(gpu, renderer.sets())?;
            let drawn = (scene.frame, antialias);
            Ok(Stage { descriptors, renderer, drawn, kept: None })
        });
        if made.is_err() {
            // Nothing was submitted with the objects created before the failure.
            gpu.bury();
        }
        let mut stage = made?;
        self.run(|this, cmd| {
            stage.renderer.record_setup(&this.gpu, cmd);
            Ok(())
        })?;
        stage.renderer.finish_setup(&self.gpu);
        self.scene = Some(stage);
        self.panes.clone_from(&scene.panes);
        Ok(())
    }

    /// Discards the kept picture: the sky has changed, or a frame failed.
    pub(super) fn forget_scene(&mut self) {
        if let Some(kept) = self.scene.as_mut().and_then(|stage| stage.kept.as_mut()) {
            kept.camera = None;
        }
    }

    /// Draws the scene into colour and depth, or copies the kept picture if the camera is the same.
    pub(super) fn draw_scene(
        &mut self,
        cmd: vk::CommandBuffer,
        camera: &Camera,
    ) -> Result<(), Error> {
        let Some(stage) = &mut self.scene else {
            return Err(Error::bad("Background::Scene", "no scene was handed in"));
        };
        let gpu = &self.gpu;
        let kept = match &mut stage.kept {
            Some(kept) => kept,
            kept => kept.insert(Kept::new(gpu, self.color.extent)?),
        };
        if kept.camera == Some(*camera) {
            transfer::copy(gpu, cmd, (&kept.color, KEPT_REST), (&self.color, COLOR_REST));
            transfer::copy(gpu, cmd, (&kept.depth, KEPT_REST), (&self.depth, DEPTH_REST));
            return Ok(());
        }
        stage.descriptors.reset(gpu)?;
        let frame = SceneFrame {
            slot: Slot(0),
            descriptors: &stage.descriptors,
            camera,
            color: &self.color,
            depth: &self.depth,
            environment: self.renderer.environment_view(),
            without_sun: self.without_sun.as_ref().map(|own| own.cube.view),
            sampler: gpu.samplers.linear,
        };
        stage.renderer.record(gpu, cmd, &frame)?;
        transfer::copy(gpu, cmd, (&self.color, COLOR_REST), (&kept.color, KEPT_REST));
        transfer::copy(gpu, cmd, (&self.depth, DEPTH_REST), (&kept.depth, KEPT_REST));
        kept.camera = Some(*camera);
        Ok(())
    }
}
