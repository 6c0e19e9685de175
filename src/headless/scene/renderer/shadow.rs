//! The sun's shadow map: depth of everything that casts a shadow, seen along the sun's light.
//! Drawn once, in the set-up: a scene that moves is set up again.
//! Reads: vertices. Writes: shadow map.

use ash::vk;
use glam::{Mat4, Vec2, Vec3};

use super::super::Scene;
use super::geometry::Geometry;
use super::opaque::{DepthOnly, View};
use crate::contract::HostImage;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, DEPTH_ATTACHMENT, FRAGMENT_SAMPLED, NOTHING};
use crate::gpu::descriptors::Resource;
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pass::{Attachment, Attachments, clear_depth};

/// Edge of the map in texels.
pub const SIZE: u32 = 2048;
const FORMAT: vk::Format = vk::Format::D32_SFLOAT;
/// Slope factor of the depth bias in texels, against self-shadowing of lit slopes.
const BIAS: f32 = 1.5;

pub struct Shadow {
    map: Image,
    sampler: Owned<vk::Sampler>,
    /// Without comparison.
    reader: Owned<vk::Sampler>,
    pass: vk::RenderPass,
    framebuffer: Owned<vk::Framebuffer>,
    pipeline: DepthOnly,
    /// The view of the map.
    pub sun: SunView,
}

impl Shadow {
    /// `direction` is the unit vector to the sun.
    pub fn new(gpu: &Gpu, scene: &Scene, direction: Vec3) -> Result<Self, Error> {
        let map = Image::new(
            gpu,
            &ImageDesc::new(
                "scene/shadow",
                vk::Extent2D { width: SIZE, height: SIZE },
                FORMAT,
                vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
            ),
        )?;
        // The sampler compares depths; outside of the map everything is lit.
        let border = vk::SamplerAddressMode::CLAMP_TO_BORDER;
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(vk::Filter::LINEAR)
            .min_filter(vk::Filter::LINEAR)
            .address_mode_u(border)
            .address_mode_v(border)
            .address_mode_w(border)
            .border_color(vk::BorderColor::FLOAT_OPAQUE_WHITE)
            .compare_enable(true)
            .compare_op(vk::CompareOp::LESS_OR_EQUAL);
        let depth = Attachment {
            format: FORMAT,
            samples: vk::SampleCountFlags::TYPE_1,
            load: vk::AttachmentLoadOp::CLEAR,
            store: vk::AttachmentStoreOp::STORE,
        };
        let attachments = Attachments { depth: Some(depth), ..Attachments::default() };
        let pass = gpu.render_pass("scene/shadow", &attachments)?;
        Ok(Self {
            sampler: gpu.sampler("scene/shadow", &info)?,
            reader: gpu.sampler("scene/shadow depths", &vk::SamplerCreateInfo::default())?,
            framebuffer: gpu.framebuffer("scene/shadow", pass, map.view, map.extent)?,
            pipeline: DepthOnly::new(gpu, pass, BIAS)?,
            sun: SunView::new(scene, direction),
            pass,
            map,
        })
    }

    /// Draws the map. The geometry must be uploaded.
    pub fn record(&self, gpu: &Gpu, cmd: vk::CommandBuffer, geometry: &Geometry) {
        let area = self.map.extent.into();
        let view = View { clip: self.sun.clip, far: 1.0 };
        gpu.barriers(cmd, &[access::image(&self.map, NOTHING, DEPTH_ATTACHMENT)], &[]);
        let (pass, framebuffer) = (self.pass, self.framebuffer.handle);
        gpu.begin_pass_with(cmd, pass, framebuffer, area, &[clear_depth(view.far)]);
        self.pipeline.draw(gpu, cmd, geometry, view, geometry.casters);
        gpu.end_pass(cmd);
        gpu.barriers(cmd, &[access::image(&self.map, DEPTH_ATTACHMENT, FRAGMENT_SAMPLED)], &[]);
    }

    /// The map in the form that a host passes.
    pub fn handed_over(&self, bias: f32) -> crate::contract::Shadow {
        let Image { handle, view, format, extent, .. } = self.map;
        let image = HostImage {
            image: handle,
            view,
            format,
            aspect: vk::ImageAspectFlags::DEPTH,
            extent,
            rect: extent.into(),
            before: FRAGMENT_SAMPLED,
            after: FRAGMENT_SAMPLED,
        };
        let (view_projection, bias) = (self.sun.clip, bias + self.sun.texel);
        crate::contract::Shadow { image, view_projection: view_projection.to_cols_array_2d(), bias }
    }

    pub fn resource(&self) -> Resource {
        Resource::Sampled(self.map.view, self.sampler.handle)
    }

    /// Its depths, texel by texel.
    pub fn depths(&self) -> Resource {
        Resource::Sampled(self.map.view, self.reader.handle)
    }
}

/// The sun's orthographic view of everything that casts a shadow.
#[derive(Clone, Copy)]
pub struct SunView {
    /// World to clip space.
    pub clip: Mat4,
    /// World size of a texel.
    pub texel: f32,
}

impl SunView {
    fn new(scene: &Scene, direction: Vec3) -> Self {
        let up = if direction.y.abs() > 0.99 { Vec3::X } else { Vec3::Y };
        let view = Mat4::look_to_rh(Vec3::ZERO, -direction, up);
        let (low, high) = scene.bounds_in(view).unwrap_or((Vec3::splat(-1.0), Vec3::ONE));
        // Texels are square. A margin around the scene stays empty, and thus lit, for the filter at the border.
        let size = (high - low).truncate().max_element().max(1e-4);
        let half = Vec2::splat(0.5 * size * (1.0 + 16.0 / SIZE as f32));
        let centre = (0.5 * (low + high)).truncate();
        let margin = 0.01 * (high - low).length().max(1e-4);
        let clip = Mat4::orthographic_rh(
            centre.x - half.x,
            centre.x + half.x,
            centre.y - half.y,
            centre.y + half.y,
            -high.z - margin,
            -low.z + margin,
        ) * view;
        Self { clip, texel: 2.0 * half.x / SIZE as f32 }
    }
}
