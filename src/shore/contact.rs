//! Pass `contact`: foam on the particles' water around objects in it (Lettier, Foam). It runs after the smoothing,
//! because it needs the smoothed surface. Foam on the host's own water surface is part of pass `shoreline`.
//!
//! Reads: the water's depth, smoothed depth, scene depth, web, mask. Writes: tiles that may contain contact foam,
//! contact foam of their pixels.

use super::Given;
use super::settings::ShoreConfig;
use super::shoreline::{AFTER, Shore, edge_constant};
use super::textures::Textures;
use super::tiles::{CONTACT_DISPATCH, Tiles};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, FRAGMENT_SAMPLED};
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::{Recording, WaterLayers};

/// The pass.
pub struct Contact {
    pipeline: Pipeline,
}

impl Contact {
    pub fn new(gpu: &Gpu, shore: &ShoreConfig) -> Result<Self, Error> {
        let constants = [edge_constant(shore)];
        Ok(Self { pipeline: Pipeline::compute(gpu, shader::SHORE_CONTACT_COMP, &constants)? })
    }

    /// Records pass `contact`. The images of the water's depth, unsmoothed and smoothed, must be in the
    /// fragment-sampled state, and are in the same state after the pass.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        (shore, tiles): (&Shore, &Tiles),
        (given, general): (&Given<'_>, bool),
        textures: &Textures,
        water: &WaterLayers<'_>,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let foam = shore.image();
        let layers = [water.depth, water.smoothed];
        let hand = |from, to| layers.map(|image| access::image(image, from, to));
        let to = [
            &hand(FRAGMENT_SAMPLED, COMPUTE_SAMPLED)[..],
            &[access::image(foam, AFTER, COMPUTE_READ_WRITE)],
        ];
        gpu.barriers(cmd, &to.concat(), &[]);
        let sampled =
            |image: &crate::gpu::image::Image| Resource::Sampled(image.view, gpu.samplers.nearest);
        tiles.record_on_particles(r, sampled(water.depth), general)?;
        let [list, arguments, _] = tiles.buffers();
        let resources = [
            (0, r.uniforms),
            (1, r.shore),
            (2, r.scene_depth),
            (3, sampled(water.depth)),
            (28, textures.noise()),
            (5, sampled(water.smoothed)),
            (29, textures.web()),
            (30, given.mask.unwrap_or(r.scene_depth)),
            (7, r.levels),
            (8, Resource::storage(foam)),
            (9, Resource::buffer(list)),
            (10, Resource::buffer(arguments)),
        ];
        r.descriptors.bind(gpu, cmd, &self.pipeline, &resources)?;
        self.pipeline.push(gpu, cmd, &tiles.places(r.extent));
        // SAFETY: outside a render pass, pipeline and set are bound; the arguments are visible
        // (`record_on_particles`).
        unsafe { gpu.device.cmd_dispatch_indirect(cmd, arguments.handle, CONTACT_DISPATCH) };
        let back = [
            &hand(COMPUTE_SAMPLED, FRAGMENT_SAMPLED)[..],
            &[access::image(foam, COMPUTE_READ_WRITE, AFTER)],
        ];
        gpu.barriers(cmd, &back.concat(), &[]);
        Ok(())
    }
}
