//! The stand-in scene: set up, and drawn into the images that the water is drawn over.

use std::sync::Arc;

use ash::vk;

use super::scene::bake::Baked;
use super::scene::{Scene, SceneFrame, SceneRenderer};
use super::{COLOR_FORMAT, DEPTH_FORMAT, Headless};
use crate::contract::{Camera, Slot};
use crate::error::Error;
use crate::gpu::descriptors::Descriptors;

/// The stand-in scene with the sets of its frame.
pub(super) struct Stage {
    pub renderer: SceneRenderer,
    descriptors: Descriptors,
}

impl Headless {
    /// The scene to stand behind the water, drawn by
    /// [`Background::Scene`](super::Background::Scene); `antialias`: four samples a pixel in its
    /// colour. Its light is baked: a new sun needs a new scene.
    ///
    /// # Errors
    /// No memory, and what Vulkan reports.
    pub fn scene(&mut self, scene: &Scene, antialias: bool) -> Result<(), Error> {
        self.set_up_scene(scene, antialias, None)
    }

    /// The scene that was handed in last, in another [`frame`](Scene::frame): its parts have moved,
    /// and nothing else has changed. What moves takes the baked light along; the sun's shadow is
    /// drawn anew.
    ///
    /// # Errors
    /// As [`scene`](Self::scene).
    pub fn scene_frame(&mut self, scene: &Scene, antialias: bool) -> Result<(), Error> {
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
        let gpu = &self.gpu;
        let (color, depth) = (COLOR_FORMAT, DEPTH_FORMAT);
        let made = match light {
            Some(light) => SceneRenderer::with_light(gpu, scene, &light, color, depth, antialias),
            None => SceneRenderer::new(gpu, scene, color, depth, antialias),
        };
        let made = made.and_then(|renderer| {
            Ok(Stage { descriptors: Descriptors::new(gpu, renderer.sets())?, renderer })
        });
        if made.is_err() {
            // Nothing was submitted with what was made before the failure.
            gpu.bury();
        }
        let mut stage = made?;
        self.run(|this, cmd| {
            stage.renderer.record_setup(&this.gpu, cmd);
            Ok(())
        })?;
        stage.renderer.finish_setup(&self.gpu);
        self.scene = Some(stage);
        Ok(())
    }

    /// Draws it into colour and depth.
    pub(super) fn draw_scene(
        &mut self,
        cmd: vk::CommandBuffer,
        camera: &Camera,
    ) -> Result<(), Error> {
        let Some(stage) = &mut self.scene else {
            return Err(Error::bad("Background::Scene", "no scene was handed in"));
        };
        stage.descriptors.reset(&self.gpu)?;
        let frame = SceneFrame {
            slot: Slot(0),
            descriptors: &stage.descriptors,
            camera,
            color: &self.color,
            depth: &self.depth,
            environment: self.renderer.environment_view(),
            sampler: self.gpu.samplers.linear,
        };
        stage.renderer.record(&self.gpu, cmd, &frame)
    }
}
