//! What all draws of the scene share: pipelines for triangles with a depth test, whose direction follows the
//! camera's depth convention, and the draw of depth alone.

use ash::vk;
use glam::Mat4;

use super::geometry::{self, Geometry};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::pipeline::{Pipeline, no_blend};
use crate::gpu::shader::{self, Shader};

/// The differences between the pipelines of the scene.
pub struct Opaque<'a> {
    pub vertex: Shader,
    /// `None` draws only depth.
    pub fragment: Option<Shader>,
    /// Vertex attributes; may be empty.
    pub attributes: &'a [vk::VertexInputAttributeDescription],
    pub pass: vk::RenderPass,
    /// Whether the pass has a colour attachment.
    pub colored: bool,
    pub samples: vk::SampleCountFlags,
    /// Slope factor of the depth bias; 0 for none.
    pub bias: f32,
    /// Specialization constants: id, value.
    pub constants: &'a [(u32, u32)],
}

impl Opaque<'_> {
    pub fn pipeline(&self, gpu: &Gpu) -> Result<Pipeline, Error> {
        let mut stages = vec![(self.vertex, vk::ShaderStageFlags::VERTEX)];
        stages.extend(self.fragment.map(|shader| (shader, vk::ShaderStageFlags::FRAGMENT)));
        let mut input = vk::PipelineVertexInputStateCreateInfo::default();
        if !self.attributes.is_empty() {
            input = input
                .vertex_binding_descriptions(&geometry::BINDINGS)
                .vertex_attribute_descriptions(self.attributes);
        }
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport =
            vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        // Both sides are drawn, also in the shadow map, because the winding is not reliable.
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .cull_mode(vk::CullModeFlags::NONE)
            .depth_bias_enable(self.bias != 0.0)
            .depth_bias_slope_factor(self.bias)
            .line_width(1.0);
        let multisample =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(self.samples);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(true);
        // Without a fragment shader no colour is written.
        let mask = match self.fragment {
            Some(_) => vk::ColorComponentFlags::RGBA,
            None => vk::ColorComponentFlags::empty(),
        };
        let attachments = [no_blend().color_write_mask(mask)];
        let attachments = if self.colored { &attachments[..] } else { &[] };
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(attachments);
        let dynamic = [
            vk::DynamicState::VIEWPORT,
            vk::DynamicState::SCISSOR,
            vk::DynamicState::DEPTH_COMPARE_OP,
        ];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let state = vk::GraphicsPipelineCreateInfo::default()
            .vertex_input_state(&input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .render_pass(self.pass);
        Pipeline::from_state(gpu, &stages, self.constants, state)
    }
}

/// Sets the direction of the depth test. `far` is the cleared value of the device depth.
pub fn set_depth_test(gpu: &Gpu, cmd: vk::CommandBuffer, far: f32) {
    let nearer =
        if far == 0.0 { vk::CompareOp::GREATER_OR_EQUAL } else { vk::CompareOp::LESS_OR_EQUAL };
    if let Some(set) = gpu.depth_compare {
        // SAFETY: cmd is recording; dynamic in every pipeline of the scene.
        unsafe { set(cmd, nearer) };
    }
}

/// Draws depth only.
pub struct DepthOnly(Pipeline);

/// A camera or a light.
#[derive(Clone, Copy)]
pub struct View {
    /// World to clip space.
    pub clip: Mat4,
    /// Cleared value of the device depth.
    pub far: f32,
}

impl DepthOnly {
    /// For a pass without a colour attachment.
    pub fn new(gpu: &Gpu, pass: vk::RenderPass, bias: f32) -> Result<Self, Error> {
        let samples = vk::SampleCountFlags::TYPE_1;
        Self::opaque(pass, false, samples, bias).pipeline(gpu).map(Self)
    }

    /// For a pass with a colour attachment, which is not written.
    pub fn colored(
        gpu: &Gpu,
        pass: vk::RenderPass,
        samples: vk::SampleCountFlags,
    ) -> Result<Self, Error> {
        Self::opaque(pass, true, samples, 0.0).pipeline(gpu).map(Self)
    }

    fn opaque(
        pass: vk::RenderPass,
        colored: bool,
        samples: vk::SampleCountFlags,
        bias: f32,
    ) -> Opaque<'static> {
        Opaque {
            vertex: shader::HEADLESS_DEPTH_VERT,
            fragment: None,
            attributes: &geometry::POSITIONS,
            pass,
            colored,
            samples,
            bias,
            constants: &[],
        }
    }

    /// Draws the first `count` indices.
    pub fn draw(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        geometry: &Geometry,
        view: View,
        count: u32,
    ) {
        if count == 0 {
            return;
        }
        self.0.bind(gpu, cmd);
        geometry.bind(gpu, cmd);
        set_depth_test(gpu, cmd, view.far);
        self.0.push(gpu, cmd, &view.clip.to_cols_array());
        // SAFETY: inside a render pass; the indices are within the vertices.
        unsafe { gpu.device.cmd_draw_indexed(cmd, count, 1, 0, 0, 0) };
    }
}
