//! Pipelines. Descriptor layout, push range and workgroup size come from the shaders themselves.

use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::Arc;

use ash::vk;

use super::Gpu;
use super::graveyard::{Grave, Graveyard};
use super::limits;
use super::shader::Shader;
use super::specialize::specialized;
use crate::error::{Error, VkContext};

/// A pipeline, shared through its context or owned by one object.
pub struct Pipeline(Arc<Made>);

impl Deref for Pipeline {
    type Target = Made;

    fn deref(&self) -> &Made {
        &self.0
    }
}

/// A pipeline with its layouts.
pub struct Made {
    /// The pipeline.
    pub handle: vk::Pipeline,
    /// Its layout.
    pub layout: vk::PipelineLayout,
    /// Layout of its only descriptor set.
    pub set_layout: vk::DescriptorSetLayout,
    /// The bindings of that set.
    pub bindings: BTreeMap<u32, vk::DescriptorType>,
    /// Graphics or compute.
    pub point: vk::PipelineBindPoint,
    /// Workgroup size (compute).
    pub local_size: [u32; 3],
    /// The first shader's file, for messages.
    pub name: &'static str,
    stages: vk::ShaderStageFlags,
    push_size: u32,
    /// Queue to which a pipeline with a single owner hands its handles for destruction when it is dropped; `None` if
    /// the pipeline is shared and the context destroys it.
    yard: Option<Graveyard>,
}

/// All parameters that distinguish two pipelines of one kind.
#[derive(PartialEq, Eq, Hash)]
pub struct Key {
    shaders: Vec<&'static str>,
    constants: Vec<(u32, u32)>,
    graphics: Option<GraphicsKey>,
}

#[derive(PartialEq, Eq, Hash)]
struct GraphicsKey {
    topology: vk::PrimitiveTopology,
    pass: vk::RenderPass,
    blend: Vec<[u32; 8]>,
    passes: Option<vk::CompareOp>,
}

impl GraphicsKey {
    fn new(desc: &Graphics<'_>, passes: Option<vk::CompareOp>) -> Self {
        let word = |b: &vk::PipelineColorBlendAttachmentState| {
            [
                b.blend_enable,
                b.src_color_blend_factor.as_raw() as u32,
                b.dst_color_blend_factor.as_raw() as u32,
                b.color_blend_op.as_raw() as u32,
                b.src_alpha_blend_factor.as_raw() as u32,
                b.dst_alpha_blend_factor.as_raw() as u32,
                b.alpha_blend_op.as_raw() as u32,
                b.color_write_mask.as_raw(),
            ]
        };
        let blend = desc.blend.iter().map(word).collect();
        Self { topology: desc.topology, pass: desc.pass, blend, passes }
    }
}

/// Parameters of a graphics pipeline. These pipelines read no vertex buffers, their viewport and scissor are dynamic,
/// and only [`Pipeline::tested`] can give them a depth test.
pub struct Graphics<'a> {
    /// Vertex shader.
    pub vertex: Shader,
    /// Fragment shader.
    pub fragment: Shader,
    /// Points or triangle strip.
    pub topology: vk::PrimitiveTopology,
    /// Render pass it is used in (or a compatible one).
    pub pass: vk::RenderPass,
    /// Blend state of the one attachment.
    pub blend: &'a [vk::PipelineColorBlendAttachmentState],
    /// Specialization constants (id, value).
    pub constants: &'a [(u32, u32)],
}

/// No blending.
pub fn no_blend() -> vk::PipelineColorBlendAttachmentState {
    vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA)
}

/// One blend operation with factors ONE and ONE (MIN ignores them).
pub fn blend(op: vk::BlendOp) -> vk::PipelineColorBlendAttachmentState {
    no_blend()
        .blend_enable(true)
        .src_color_blend_factor(vk::BlendFactor::ONE)
        .dst_color_blend_factor(vk::BlendFactor::ONE)
        .color_blend_op(op)
        .src_alpha_blend_factor(vk::BlendFactor::ONE)
        .dst_alpha_blend_factor(vk::BlendFactor::ONE)
        .alpha_blend_op(op)
}

/// A shader module that lives while its pipeline is created.
struct Module<'a>(vk::ShaderModule, &'a Gpu);

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: no pipeline is being created from it any more; the GPU never uses modules.
        unsafe { self.1.device.destroy_shader_module(self.0, None) };
    }
}

impl Pipeline {
    /// A compute pipeline, owned by the context.
    pub fn compute(gpu: &Gpu, shader: Shader, constants: &[(u32, u32)]) -> Result<Self, Error> {
        Self::shared(gpu, &[shader], constants, None, || Made::compute(gpu, shader, constants))
    }

    /// A graphics pipeline with one colour attachment, owned by the context.
    pub fn graphics(gpu: &Gpu, desc: &Graphics<'_>) -> Result<Self, Error> {
        Self::tested(gpu, desc, None)
    }

    /// A graphics pipeline, owned by the context. If `passes` gives a comparison, it tests depth with this comparison
    /// and writes depth; otherwise it does neither.
    pub fn tested(
        gpu: &Gpu,
        desc: &Graphics<'_>,
        passes: Option<vk::CompareOp>,
    ) -> Result<Self, Error> {
        let graphics = GraphicsKey::new(desc, passes);
        Self::shared(gpu, &[desc.vertex, desc.fragment], desc.constants, Some(graphics), || {
            Made::graphics(gpu, desc, passes)
        })
    }

    /// A graphics pipeline with any state. It is owned by the caller, not by the context. Shader stages and layout of
    /// `state` are filled in here.
    #[cfg(feature = "headless")]
    pub fn from_state(
        gpu: &Gpu,
        stages: &[(Shader, vk::ShaderStageFlags)],
        constants: &[(u32, u32)],
        state: vk::GraphicsPipelineCreateInfo<'_>,
    ) -> Result<Self, Error> {
        Ok(Self(Arc::new(Made::from_state(gpu, stages, constants, state)?)))
    }

    fn shared(
        gpu: &Gpu,
        shaders: &[Shader],
        constants: &[(u32, u32)],
        graphics: Option<GraphicsKey>,
        make: impl FnOnce() -> Result<Made, Error>,
    ) -> Result<Self, Error> {
        let shaders = shaders.iter().map(|shader| shader.name).collect();
        let key = Key { shaders, constants: constants.to_vec(), graphics };
        let made = gpu.pipelines.get(key, || {
            let mut made = make()?;
            made.yard = None;
            Ok(Arc::new(made))
        })?;
        Ok(Self(made))
    }
}

impl Made {
    fn compute(gpu: &Gpu, shader: Shader, constants: &[(u32, u32)]) -> Result<Self, Error> {
        let mut pipeline = Self::layouts(
            gpu,
            &[(shader, vk::ShaderStageFlags::COMPUTE)],
            vk::PipelineBindPoint::COMPUTE,
        )?;
        let module = gpu.module(&shader, constants)?;
        let info = vk::ComputePipelineCreateInfo::default()
            .stage(
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(vk::ShaderStageFlags::COMPUTE)
                    .module(module.0)
                    .name(c"main"),
            )
            .layout(pipeline.layout);
        // SAFETY: module and layout come from the same shader.
        let made =
            unsafe { gpu.device.create_compute_pipelines(gpu.pipeline_cache, &[info], None) };
        pipeline.handle = pipeline.finish(gpu, made, "vkCreateComputePipelines")?;
        Ok(pipeline)
    }

    fn graphics(
        gpu: &Gpu,
        desc: &Graphics<'_>,
        passes: Option<vk::CompareOp>,
    ) -> Result<Self, Error> {
        let stages = [
            (desc.vertex, vk::ShaderStageFlags::VERTEX),
            (desc.fragment, vk::ShaderStageFlags::FRAGMENT),
        ];
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(desc.topology);
        let viewport =
            vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .cull_mode(vk::CullModeFlags::NONE)
            .line_width(1.0);
        let multisample = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(passes.is_some())
            .depth_write_enable(passes.is_some())
            .depth_compare_op(passes.unwrap_or(vk::CompareOp::ALWAYS));
        let color = vk::PipelineColorBlendStateCreateInfo::default().attachments(desc.blend);
        let dynamic_states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);
        let state = vk::GraphicsPipelineCreateInfo::default()
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&color)
            .dynamic_state(&dynamic)
            .render_pass(desc.pass);
        Self::from_state(gpu, &stages, desc.constants, state)
    }

    fn from_state(
        gpu: &Gpu,
        stages: &[(Shader, vk::ShaderStageFlags)],
        constants: &[(u32, u32)],
        state: vk::GraphicsPipelineCreateInfo<'_>,
    ) -> Result<Self, Error> {
        let mut pipeline = Self::layouts(gpu, stages, vk::PipelineBindPoint::GRAPHICS)?;
        let modules: Vec<Module<'_>> = stages
            .iter()
            .map(|(shader, _)| gpu.module(shader, constants))
            .collect::<Result<_, _>>()?;
        let infos: Vec<_> = stages
            .iter()
            .zip(&modules)
            .map(|((_, stage), module)| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(*stage)
                    .module(module.0)
                    .name(c"main")
            })
            .collect();
        let info = state.stages(&infos).layout(pipeline.layout);
        // SAFETY: modules and layout fit each other; the caller guarantees the rest.
        let made =
            unsafe { gpu.device.create_graphics_pipelines(gpu.pipeline_cache, &[info], None) };
        pipeline.handle = pipeline.finish(gpu, made, "vkCreateGraphicsPipelines")?;
        Ok(pipeline)
    }

    fn layouts(
        gpu: &Gpu,
        shaders: &[(Shader, vk::ShaderStageFlags)],
        point: vk::PipelineBindPoint,
    ) -> Result<Self, Error> {
        let mut bindings = BTreeMap::new();
        let mut visible: BTreeMap<u32, vk::ShaderStageFlags> = BTreeMap::new();
        for (shader, stage) in shaders {
            limits::check(shader, &gpu.limits)?;
            for &(binding, kind) in shader.bindings {
                let earlier = *bindings.entry(binding).or_insert(kind);
                debug_assert_eq!(earlier, kind, "{} binding {binding}", shader.name);
                *visible.entry(binding).or_default() |= *stage;
            }
        }
        let stages = shaders
            .iter()
            .filter(|(shader, _)| shader.push_size > 0)
            .fold(vk::ShaderStageFlags::empty(), |all, (_, stage)| all | *stage);
        let push_size = shaders.iter().map(|(shader, _)| shader.push_size).max().unwrap_or(0);
        let infos: Vec<_> = bindings
            .iter()
            .map(|(&binding, &kind)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding)
                    .descriptor_type(kind)
                    .descriptor_count(1)
                    .stage_flags(visible[&binding])
            })
            .collect();
        let name = shaders[0].0.name;
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&infos);
        // SAFETY: valid create info.
        let set_layout = unsafe { gpu.device.create_descriptor_set_layout(&info, None) }
            .context(|| format!("vkCreateDescriptorSetLayout {name}"))?;
        let sets = [set_layout];
        let ranges = [vk::PushConstantRange::default().stage_flags(stages).size(push_size)];
        let mut info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        if push_size > 0 {
            info = info.push_constant_ranges(&ranges);
        }
        // SAFETY: valid create info; the set layout is alive.
        let layout = match unsafe { gpu.device.create_pipeline_layout(&info, None) } {
            Ok(layout) => layout,
            Err(result) => {
                // SAFETY: created above, not used by anything.
                unsafe { gpu.device.destroy_descriptor_set_layout(set_layout, None) };
                return Err(Error::Vulkan {
                    call: format!("vkCreatePipelineLayout {name}"),
                    result,
                });
            }
        };
        Ok(Self {
            handle: vk::Pipeline::null(),
            layout,
            set_layout,
            bindings,
            point,
            local_size: shaders[0].0.local_size,
            name,
            stages,
            push_size,
            yard: Some(gpu.graveyard.clone()),
        })
    }

    fn finish(
        &self,
        gpu: &Gpu,
        made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
        call: &str,
    ) -> Result<vk::Pipeline, Error> {
        match made {
            Ok(pipelines) => {
                gpu.name(pipelines[0], self.name);
                gpu.name(self.layout, self.name);
                gpu.name(self.set_layout, self.name);
                Ok(pipelines[0])
            }
            Err((_, result)) => {
                Err(Error::Vulkan { call: format!("{call} {}", self.name), result })
            }
        }
    }

    /// Binds the pipeline.
    pub fn bind(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        // SAFETY: cmd is recording; the pipeline is alive.
        unsafe { gpu.device.cmd_bind_pipeline(cmd, self.point, self.handle) };
    }

    /// Sets all of its push constants.
    pub fn push<T: bytemuck::NoUninit>(&self, gpu: &Gpu, cmd: vk::CommandBuffer, value: &T) {
        let bytes = bytemuck::bytes_of(value);
        debug_assert_eq!(bytes.len(), self.push_size as usize, "push constants of {}", self.name);
        // SAFETY: cmd is recording; size and stages are those of the layout.
        unsafe { gpu.device.cmd_push_constants(cmd, self.layout, self.stages, 0, bytes) };
    }
}

impl Drop for Made {
    fn drop(&mut self) {
        if let Some(yard) = &self.yard {
            yard.push(Grave::Pipeline(self.handle, self.layout, self.set_layout));
        }
    }
}

impl Gpu {
    fn module(&self, shader: &Shader, constants: &[(u32, u32)]) -> Result<Module<'_>, Error> {
        let words = specialized(bytemuck::cast_slice(shader.code), constants);
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: SPIR-V from our own build.
        let module = unsafe { self.device.create_shader_module(&info, None) }
            .context(|| format!("vkCreateShaderModule {}", shader.name))?;
        Ok(Module(module, self))
    }
}
