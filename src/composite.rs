//! Pass `composite`: the only one that writes the output; takes the layers of all techniques.
//!
//! Drawn over the tiles that hold water alone, one instance each: pixels outside the fluid are not
//! touched. Thesis Sec. 3.3 and 4.10; see glsl/composite.frag for what differs.

use ash::vk;

use crate::contract::Config;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::descriptors::Resource;
use crate::gpu::graveyard::Owned;
use crate::gpu::pipeline::{Graphics, Pipeline, no_blend};
use crate::gpu::shader;
use crate::water::settings::Fresnel;
use crate::water::{COMPOSITE_DRAWS, Recording, WaterLayers};

/// What the pass takes beside the layers.
pub struct Surroundings {
    /// Framebuffer of the output, in COLOR_ATTACHMENT_OPTIMAL.
    pub target: vk::Framebuffer,
    /// The part of it that is the view.
    pub area: vk::Rect2D,
    /// The scene behind the water, sampled linearly.
    pub scene_color: Resource,
    /// What it reflects, a cube.
    pub environment: Resource,
    /// Chooses the pipeline.
    pub fresnel: Fresnel,
}

/// The pass.
pub struct Composite {
    pass: Owned<vk::RenderPass>,
    /// [Fresnel::Schlick, Fresnel::Source]: of the configured level, of any other.
    pipelines: [[Pipeline; 2]; 2],
}

impl Composite {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let pass = gpu.color_pass("composite", config.output_format, vk::AttachmentLoadOp::LOAD)?;
        let thickness = match config.thickness_level {
            0 => 0,
            level if level == config.smoothing_level => 1,
            _ => 2,
        };
        let make = |schlick, configured| {
            Pipeline::graphics(
                gpu,
                &Graphics {
                    vertex: shader::COMPOSITE_VERT,
                    fragment: shader::COMPOSITE_FRAG,
                    topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                    pass: pass.handle,
                    blend: no_blend(),
                    constants: &[(0, thickness), (1, schlick), (2, configured)],
                },
            )
        };
        let pipelines = [[make(1, 1)?, make(1, 0)?], [make(0, 1)?, make(0, 0)?]];
        Ok(Self { pass, pipelines })
    }

    /// A framebuffer for the host's output; it lives as long as the slot's frame.
    pub fn framebuffer(
        &self,
        gpu: &Gpu,
        view: vk::ImageView,
        extent: vk::Extent2D,
    ) -> Result<Owned<vk::Framebuffer>, Error> {
        gpu.framebuffer("composite/output", self.pass.handle, view, extent)
    }

    /// All layers are sampled by fragments.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        around: &Surroundings,
        layers: &WaterLayers<'_>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"composite");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let pipelines = match around.fresnel {
            Fresnel::Schlick { .. } => &self.pipelines[0],
            Fresnel::Source { .. } => &self.pipelines[1],
        };
        gpu.begin_pass(cmd, self.pass.handle, around.target, around.area, [0.0; 4]);
        let nearest = gpu.samplers.nearest;
        // Their bindings are the same; one of the draws is empty.
        for (pipeline, draw) in pipelines.iter().zip(COMPOSITE_DRAWS) {
            r.descriptors.bind(
                gpu,
                cmd,
                pipeline,
                &[
                    (0, r.uniforms),
                    (1, Resource::Sampled(layers.smoothed.view, nearest)),
                    (2, Resource::Sampled(layers.depth.view, nearest)),
                    (3, Resource::Sampled(layers.thickness.view, nearest)),
                    (4, around.scene_color),
                    (5, r.scene_depth),
                    (6, around.environment),
                    (7, layers.level.resource()),
                    (9, Resource::buffer(&layers.tiles.list)),
                ],
            )?;
            pipeline.push(gpu, cmd, &layers.tiles.atlas.columns);
            let arguments = layers.tiles.arguments.handle;
            // SAFETY: inside the render pass; the arguments are visible since `tiles`.
            unsafe { gpu.device.cmd_draw_indirect(cmd, arguments, draw, 1, 16) };
        }
        // SAFETY: a pass was begun.
        unsafe { gpu.device.cmd_end_render_pass(cmd) };
        r.end(scope);
        Ok(())
    }
}
