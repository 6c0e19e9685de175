//! Pass `composite`: combines the layers of all techniques and writes the output. (The only other pass that writes it
//! is `lit`.)
//!
//! Pass `composite` first draws the foam on the host's own water surface, in the tiles that may have it
//! (glsl/shore/coat.*). Then it shades the screen tiles with water, foam, spray, whitewater particles or bubble foam,
//! and in them only pixels that show one of these. Two paths shade alike: a render pass that draws one instance per
//! tile, and a compute shader that stores to the output. The shading follows the thesis, Sec. 3.2.3 and 4.9;
//! glsl/include/shade.glsl states the differences.

use ash::vk;

use crate::bubbles::Bubbles;
use crate::contract::Config;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_SAMPLED, COMPUTE_WRITE, FRAGMENT_SAMPLED,
};
use crate::gpu::descriptors::Resource;
use crate::gpu::graveyard::Owned;
use crate::gpu::pipeline::{Graphics, Pipeline, no_blend};
use crate::gpu::shader;
use crate::shore::{COAT_DISPATCH, Shore};
use crate::water::coarsening;
use crate::water::settings::{EXIT_STEPS, Exit, Shading};
use crate::water::split::{DISPATCHES, KINDS};
use crate::water::{Recording, WaterLayers};
use crate::whitewater::Whitewater;

/// The raster path is as fast as the compute path on lavapipe, and also works with outputs that do not support
/// storing. On an H200, which rasterizes slowly, the compute path takes a fourteenth of its time
/// (docs/performance.md).
const DEFAULT_SHADING: Shading = Shading::Raster;

/// The path that a configuration uses.
pub fn way(config: &Config) -> Shading {
    config.composite.unwrap_or(DEFAULT_SHADING)
}

/// Returns whether every device can blend this output format. For other formats the fragment shader reads the scene's
/// colour and blends itself.
fn blends(output: vk::Format) -> bool {
    use vk::Format as F;
    matches!(
        output,
        F::R8G8B8A8_UNORM
            | F::R8G8B8A8_SRGB
            | F::B8G8R8A8_UNORM
            | F::B8G8R8A8_SRGB
            | F::A8B8G8R8_UNORM_PACK32
            | F::A8B8G8R8_SRGB_PACK32
            | F::A2B10G10R10_UNORM_PACK32
            | F::R16G16B16A16_SFLOAT
    )
}

/// Blending by alpha; the output's alpha is kept.
fn over() -> vk::PipelineColorBlendAttachmentState {
    no_blend()
        .blend_enable(true)
        .src_color_blend_factor(vk::BlendFactor::ONE)
        .dst_color_blend_factor(vk::BlendFactor::SRC_ALPHA)
        .src_alpha_blend_factor(vk::BlendFactor::ZERO)
        .dst_alpha_blend_factor(vk::BlendFactor::ONE)
}

/// Inputs of the pass besides the layers.
pub struct Surroundings {
    /// View of the output, in the layout of [`Composite::output_use`].
    pub output: vk::ImageView,
    /// Its framebuffer, or null.
    pub target: vk::Framebuffer,
    /// The area of the view within it.
    pub area: vk::Rect2D,
    /// The scene behind the water, sampled linearly.
    pub scene_color: Resource,
    /// The environment cube.
    pub environment: Resource,
}

/// One pipeline for each kind of tile that pass `split` distinguishes (coarser smoothing levels or not, foam or not,
/// one or two layers of water), in the order of its indirect arguments. `None` for kinds that the configuration
/// excludes.
type Pipelines = [Option<Pipeline>; KINDS as usize];

enum Path {
    Raster { pass: vk::RenderPass, pipelines: Pipelines, coat: Option<Pipeline> },
    Compute { pipelines: Pipelines, coat: Option<Pipeline> },
}

/// The pass.
pub struct Composite {
    path: Path,
}

fn pipelines(
    config: &Config,
    make: impl Fn(&[(u32, u32)]) -> Result<Pipeline, Error>,
) -> Result<Pipelines, Error> {
    let thickness = match config.thickness_level {
        0 => 0,
        level if level == config.smoothing_level => 1,
        _ => 2,
    };
    let beside = [
        (10, u32::from(config.spray)),
        (14, u32::from(config.noise.is_some())),
        (20, u32::from(config.whitewater.is_some())),
        (22, u32::from(config.bubbles.is_some())),
        (24, u32::from(config.shore.is_some())),
        (25, config.mirror_steps),
        (26, if config.exit == Exit::TwoInterfaces { EXIT_STEPS } else { 0 }),
    ];
    let light = crate::light::constants(config);
    let mut all = Pipelines::default();
    for (i, pipeline) in (0..).zip(&mut all) {
        let (near, foam, sheets) = (i >> 2, i >> 1 & 1, 1 + (i & 1));
        let kept = near == 0 || coarsening(config) > 0;
        if kept && sheets <= config.sheets && foam <= u32::from(config.surface_foam) {
            let own = [(0, thickness), (2, near), (8, sheets), (9, foam)];
            *pipeline = Some(make(&[&own[..], &beside, &light].concat())?);
        }
    }
    Ok(all)
}

impl Composite {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let path = match way(config) {
            Shading::Raster => {
                let format = config.output_format;
                let pass = gpu.color_pass("composite", &[format], vk::AttachmentLoadOp::LOAD)?;
                let pipelines = pipelines(config, |constants| {
                    Pipeline::graphics(
                        gpu,
                        &Graphics {
                            vertex: shader::COMPOSITE_VERT,
                            fragment: shader::COMPOSITE_FRAG,
                            topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                            pass,
                            blend: &[no_blend()],
                            constants,
                        },
                    )
                })?;
                let coat = |_| {
                    let blended = blends(format);
                    Pipeline::graphics(
                        gpu,
                        &Graphics {
                            vertex: shader::SHORE_COAT_VERT,
                            fragment: shader::SHORE_COAT_FRAG,
                            topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                            pass,
                            blend: &[if blended { over() } else { no_blend() }],
                            constants: &[(0, u32::from(blended)), (24, 1)],
                        },
                    )
                };
                let coat = config.shore.map(coat).transpose()?;
                Path::Raster { pass, pipelines, coat }
            }
            Shading::Compute => Path::Compute {
                coat: config
                    .shore
                    .map(|_| Pipeline::compute(gpu, shader::SHORE_COAT_COMP, &[(24, 1)]))
                    .transpose()?,
                pipelines: pipelines(config, |constants| {
                    Pipeline::compute(gpu, shader::COMPOSITE_COMP, constants)
                })?,
            },
        };
        Ok(Self { path })
    }

    /// Access to the output.
    pub fn output_use(&self) -> Access {
        match self.path {
            Path::Raster { .. } => COLOR_ATTACHMENT,
            Path::Compute { .. } => COMPUTE_WRITE,
        }
    }

    /// Access to the scene's colour.
    pub fn scene_use(&self) -> Access {
        match self.path {
            Path::Raster { .. } => FRAGMENT_SAMPLED,
            Path::Compute { .. } => COMPUTE_SAMPLED,
        }
    }

    /// Returns a framebuffer for the host's output; `None` on the compute path, which needs none. The renderer keeps
    /// it until the same slot is recorded again.
    pub fn framebuffer(
        &self,
        gpu: &Gpu,
        view: vk::ImageView,
        extent: vk::Extent2D,
    ) -> Result<Option<Owned<vk::Framebuffer>>, Error> {
        match &self.path {
            Path::Raster { pass, .. } => {
                gpu.framebuffer("composite/output", *pass, view, extent).map(Some)
            }
            Path::Compute { .. } => Ok(None),
        }
    }

    /// Records pass `composite`. The images in `layers` must be in the state in which fragment shaders sample them, the
    /// layers of `whitewater`, `bubbles` and `shore` in the state in which fragment and compute shaders do. After the
    /// pass all are in the same state.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        around: &Surroundings,
        layers: &WaterLayers<'_>,
        whitewater: Option<&Whitewater>,
        bubbles: Option<&Bubbles>,
        shore: Option<&Shore>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"composite");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let nearest = gpu.samplers.nearest;
        // With one layer of water they are not read, so any buffer can be bound.
        let boundaries = Resource::buffer(layers.boundaries.unwrap_or(&layers.split.lists));
        let foam = layers.foam.unwrap_or([layers.thickness; 2]);
        let whitewater = whitewater.map_or([layers.thickness; 3], Whitewater::layers);
        let [whitewater, whitewater_thickness, whitewater_light] =
            whitewater.map(|image| Resource::Sampled(image.view, nearest));
        let soap = bubbles.map_or([layers.thickness; 2], |own| [own.depth(), own.image()]);
        let soap = soap.map(|image| Resource::Sampled(image.view, nearest));
        let coat = shore.map_or(layers.thickness, Shore::image);
        let coat = Resource::Sampled(coat.view, gpu.samplers.linear);
        let [shadow, light_thickness, basis, span, light_whitewater, light_soap] =
            r.sunlight.resources();
        let resources = [
            (0, r.uniforms),
            (1, Resource::Sampled(layers.smoothed.view, nearest)),
            (2, Resource::Sampled(layers.depth.view, nearest)),
            (3, Resource::Sampled(layers.thickness.view, nearest)),
            (4, around.scene_color),
            (5, r.scene_depth),
            (6, around.environment),
            (7, r.levels),
            (8, Resource::Storage(around.output)),
            (9, Resource::buffer(&layers.split.lists)),
            (10, Resource::buffer(&layers.split.arguments)),
            (11, boundaries),
            (12, Resource::Sampled(layers.sheets.unwrap_or(layers.thickness).view, nearest)),
            (13, Resource::Sampled(foam[0].view, nearest)),
            (14, Resource::Sampled(foam[1].view, nearest)),
            (15, Resource::Sampled(layers.spray.unwrap_or(layers.thickness).view, nearest)),
            shadow,
            light_thickness,
            basis,
            span,
            (20, Resource::Sampled(layers.noise.unwrap_or(layers.thickness).view, nearest)),
            (21, whitewater),
            (22, whitewater_thickness),
            (23, whitewater_light),
            light_whitewater,
            light_soap,
            (25, soap[0]),
            (26, soap[1]),
            (31, coat),
            (33, Resource::buffer(layers.drift.unwrap_or(&layers.split.lists))),
        ];
        let arguments = layers.split.arguments.handle;
        let first = |i: u32| layers.split.most * i;
        match &self.path {
            Path::Raster { pass, pipelines, coat } => {
                gpu.begin_pass(cmd, *pass, around.target, around.area, [0.0; 4]);
                if let (Some(pipeline), Some(shore)) = (coat, shore) {
                    let (list, arguments, places) = shore.tiles(r.extent);
                    let resources = [&resources[..], &[(32, Resource::buffer(list))]].concat();
                    r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
                    pipeline.push(gpu, cmd, &places);
                    // SAFETY: inside the render pass; the arguments are visible since `shoreline`.
                    unsafe { gpu.device.cmd_draw_indirect(cmd, arguments.handle, 0, 1, 16) };
                }
                for (i, pipeline) in (0..).zip(pipelines) {
                    let Some(pipeline) = pipeline else { continue };
                    r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
                    pipeline.push(gpu, cmd, &first(i));
                    let draw = 16 * u64::from(i);
                    // SAFETY: inside the render pass; the arguments are visible since `split`.
                    unsafe { gpu.device.cmd_draw_indirect(cmd, arguments, draw, 1, 16) };
                }
                gpu.end_pass(cmd);
            }
            Path::Compute { pipelines, coat } => {
                let images = [layers.smoothed, layers.depth, layers.thickness];
                let foam = layers.foam.into_iter().flatten();
                let images: Vec<_> = images
                    .into_iter()
                    .chain(layers.sheets)
                    .chain(foam)
                    .chain(layers.spray)
                    .chain(layers.noise)
                    .collect();
                let hand = |from, to| -> Vec<_> {
                    images.iter().map(|image| access::image(image, from, to)).collect()
                };
                gpu.barriers(cmd, &hand(FRAGMENT_SAMPLED, COMPUTE_SAMPLED), &[]);
                let written = [vk::MemoryBarrier2::default()
                    .src_stage_mask(COMPUTE_WRITE.stage)
                    .src_access_mask(COMPUTE_WRITE.access)
                    .dst_stage_mask(COMPUTE_WRITE.stage)
                    .dst_access_mask(COMPUTE_WRITE.access)];
                let written = vk::DependencyInfo::default().memory_barriers(&written);
                if let (Some(pipeline), Some(shore)) = (coat, shore) {
                    let (list, arguments, places) = shore.tiles(r.extent);
                    let lists = [(32, Resource::buffer(list)), (33, Resource::buffer(arguments))];
                    r.descriptors.bind(gpu, cmd, pipeline, &[&resources[..], &lists].concat())?;
                    pipeline.push(gpu, cmd, &places);
                    let (arguments, at) = (arguments.handle, COAT_DISPATCH);
                    // SAFETY: outside a render pass; the arguments are visible since `shoreline`.
                    unsafe { gpu.device.cmd_dispatch_indirect(cmd, arguments, at) };
                }
                for (i, pipeline) in (0..).zip(pipelines) {
                    let Some(pipeline) = pipeline else { continue };
                    r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
                    pipeline.push(gpu, cmd, &first(i));
                    let dispatch = DISPATCHES + 16 * u64::from(i);
                    // SAFETY: outside a render pass; the arguments are visible since `split`.
                    unsafe {
                        if i > 0 || coat.is_some() {
                            // Water is shaded over the coat. The dispatches for water write disjoint tiles; between
                            // them the barrier only silences synchronization validation.
                            gpu.dependency(cmd, &written);
                        }
                        gpu.device.cmd_dispatch_indirect(cmd, arguments, dispatch);
                    }
                }
                gpu.barriers(cmd, &hand(COMPUTE_SAMPLED, FRAGMENT_SAMPLED), &[]);
            }
        }
        r.end(scope);
        Ok(())
    }
}
