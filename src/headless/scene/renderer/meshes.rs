//! Draws the opaque meshes, the ground and the backdrop. Each kind of surface has a pipeline of its own,
//! because a Vulkan device on the CPU executes both sides of every branch.
//! Reads: vertices, shadow map, environment, irradiance, textures, uniforms.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Quat, Vec3};

use super::super::bake::{Batch, Part};
use super::super::{Material, Pattern, Scene, Texture};
use super::opaque::{Opaque, set_depth_test};
use super::textures::Textures;
use super::{Recording, geometry, sea};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::descriptors::bind_set;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;

/// Push constants of `scene.frag`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    turn: [f32; 4],
    origin: [f32; 4],
    color: [f32; 4],
    pattern: [f32; 4],
}

shader::assert_layout!(shader::HEADLESS_SCENE_FRAG, "Push", Push { turn, origin, color, pattern });

/// Specialization of `scene.frag`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    pattern: u32,
    part: u32,
    textured: u32,
    sea: u32,
}

pub struct Meshes {
    pipelines: BTreeMap<Kind, Pipeline>,
    draws: Vec<Draw>,
}

struct Draw {
    kind: Kind,
    texture: usize,
    first: u32,
    count: u32,
    push: Push,
}

impl Meshes {
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        batches: &[Batch],
        textures: &mut Textures,
        pass: vk::RenderPass,
        samples: vk::SampleCountFlags,
    ) -> Result<Self, Error> {
        // A texture shared by several materials is uploaded once.
        let mut known: BTreeMap<*const Texture, usize> = BTreeMap::new();
        let mut pipelines = BTreeMap::new();
        let mut draws = Vec::new();
        for batch in batches {
            let (material, transform) = match (batch.part, &scene.ground) {
                (Part::Mesh(index), _) => {
                    let mesh = &scene.meshes[index];
                    (&mesh.material, (scene.pose(index), mesh.transform))
                }
                (Part::Backdrop(index), _) => {
                    let mesh = &scene.backdrop[index];
                    (&mesh.material, (None, mesh.transform))
                }
                (Part::Ground, Some(ground)) => (&ground.material, (None, Mat4::IDENTITY)),
                (Part::Ground, None) => continue,
            };
            let texture = match &material.texture {
                None => Textures::WHITE,
                Some(texture) => match known.entry(Arc::as_ptr(texture)) {
                    Entry::Occupied(entry) => *entry.get(),
                    Entry::Vacant(entry) => *entry.insert(textures.add(gpu, texture)?),
                },
            };
            let draw = Draw::new(batch, texture, transform, material, scene);
            if let Entry::Vacant(entry) = pipelines.entry(draw.kind) {
                entry.insert(pipeline(gpu, draw.kind, pass, samples)?);
            }
            draws.push(draw);
        }
        // Sorted by pipeline; within one, in the order of the scene.
        draws.sort_by_key(|draw| draw.kind);
        Ok(Self { pipelines, draws })
    }

    /// Number of descriptor sets that one call of `draw` needs: one for each different pair of pipeline and texture
    /// that its meshes use.
    pub fn sets(&self) -> u32 {
        let draws = self.draws.iter().map(|draw| (draw.kind, draw.texture));
        draws.collect::<BTreeSet<_>>().len() as u32
    }

    pub fn draw(&self, r: &Recording<'_>) -> Result<(), Error> {
        r.geometry.bind(r.gpu, r.cmd);
        set_depth_test(r.gpu, r.cmd, r.view.far);
        let mut sets: BTreeMap<(Kind, usize), vk::DescriptorSet> = BTreeMap::new();
        for draw in &self.draws {
            let Some(pipeline) = self.pipelines.get(&draw.kind) else { continue };
            let set = match sets.entry((draw.kind, draw.texture)) {
                Entry::Occupied(entry) => *entry.get(),
                Entry::Vacant(entry) => {
                    let resources = r.resources(draw.texture);
                    *entry.insert(r.descriptors.set(r.gpu, pipeline, &resources)?)
                }
            };
            pipeline.bind(r.gpu, r.cmd);
            bind_set(r.gpu, r.cmd, pipeline, set);
            pipeline.push(r.gpu, r.cmd, &draw.push);
            // SAFETY: inside a render pass; the indices are within the vertices.
            unsafe { r.gpu.device.cmd_draw_indexed(r.cmd, draw.count, 1, draw.first, 0, 0) };
        }
        Ok(())
    }
}

fn pipeline(
    gpu: &Gpu,
    kind: Kind,
    pass: vk::RenderPass,
    samples: vk::SampleCountFlags,
) -> Result<Pipeline, Error> {
    let opaque = Opaque {
        vertex: shader::HEADLESS_SCENE_VERT,
        fragment: Some(shader::HEADLESS_SCENE_FRAG),
        attributes: &geometry::VERTICES,
        pass,
        colored: true,
        samples,
        bias: 0.0,
        constants: &[
            (0, kind.pattern),
            (1, kind.part),
            (2, kind.textured),
            (sea::CONSTANT, kind.sea),
        ],
    };
    opaque.pipeline(gpu)
}

impl Draw {
    fn new(
        batch: &Batch,
        texture: usize,
        (pose, transform): (Option<Mat4>, Mat4),
        material: &Material,
        scene: &Scene,
    ) -> Self {
        let (mut turn, mut origin) = (Quat::IDENTITY, Vec3::ZERO);
        let (_, rotation, translation) = transform.to_scale_rotation_translation();
        // A mesh without rotation uses the world's frame, so that tiles continue around corners.
        if rotation.is_finite() && !rotation.is_near_identity() {
            (turn, origin) = (rotation.normalize(), translation);
        }
        // The pattern moves with its mesh.
        if let Some(pose) = pose.filter(Mat4::is_finite) {
            let (_, rotation, _) = pose.to_scale_rotation_translation();
            (turn, origin) = ((rotation * turn).normalize(), pose.transform_point3(origin));
        }
        // The same numbers as in `scene.frag`.
        let (pattern, size, band) = match material.pattern {
            Pattern::Plain => (0, 1.0, None),
            Pattern::Tiles { size, band } => (1, size, band),
            Pattern::Planks { width } => (2, width, None),
            Pattern::Concrete => (3, 1.0, None),
            Pattern::Stone { course } | Pattern::Blocks { course } => (4, course, None),
            Pattern::Sand => (5, 1.0, None),
            Pattern::Paving { size } => (6, size, None),
            Pattern::Island { beach } => (7, beach, None),
            Pattern::Rock => (8, 1.0, None),
            Pattern::Leaves => (9, 1.0, None),
            Pattern::Foliage => (10, 1.0, None),
            Pattern::Lawn { stripe } => (11, stripe, None),
            Pattern::Ripples { length } => (12, length, None),
        };
        let metres = scene.metres_per_unit();
        // A push constant instead of a pipeline of its own: pipelines are expensive to create.
        let backdrop = if matches!(batch.part, Part::Backdrop(_)) { 1.0 } else { 0.0 };
        let [r, g, b] = material.base_color;
        Self {
            kind: Kind {
                pattern,
                part: match batch.part {
                    Part::Mesh(_) | Part::Backdrop(_) => 0,
                    Part::Ground => 1,
                },
                textured: material.texture.is_some().into(),
                sea: sea::kind(scene),
            },
            texture,
            first: batch.first,
            count: batch.count,
            push: Push {
                turn: turn.to_array(),
                origin: origin.extend(0.0).to_array(),
                color: [r, g, b, material.roughness.clamp(0.05, 1.0)],
                pattern: [
                    (size * metres).max(1e-4),
                    band.map_or(-1e6, |y| y * metres),
                    backdrop,
                    if matches!(material.pattern, Pattern::Blocks { .. }) { 1.0 } else { 0.0 },
                ],
            },
        }
    }
}
