//! Draws particle water, foam, spray and bubbles into the frame of your own Vulkan engine.
//!
//! The library records into your command buffer. It owns no device, queue, window or swapchain. Barriers are
//! explicit. The GPU itself decides counts, culling and when the smoothing ends, so nothing waits for the host. Each
//! pass is tested on a software device against a twin of it that runs on the CPU.
//!
//! # Embedding
//!
//! 1. Before you create the device (Vulkan 1.2 or newer; no feature is required), ask [`requirements`] and
//!    [`DeviceSupport::check`], and enable the optional features that you want: [`DeviceSupport::optional`] is what
//!    the device supports, [`EnabledFeatures::device_features`] builds the structures for `vkCreateDevice`, and
//!    [`DeviceSupport::with_enabled`] returns what is supported if only some of them are enabled. Report truthfully
//!    in [`EnabledFeatures`] what you enabled. On a Vulkan 1.2 device surface foam, motion vectors,
//!    [`Shadows::Convolution`](water::Shadows) and [`Shading::Compute`](water::Shading) need
//!    [`EnabledFeatures::storage_image_write_without_format`].
//! 2. Create one [`Context`] per device from a [`Host`], then a [`Renderer`] from the context and a [`Config`]. This
//!    allocates all memory, and creates all pipelines that the context does not have yet.
//! 3. Record [`Renderer::record_setup`] once, and [`Renderer::record_environment`] once per environment. Before both
//!    are recorded, `record` refuses frames. [`Settings::new`] derives all looks from the spacing and the scale of
//!    your scene, [`Light::of`] the light from a sky.
//! 4. Each frame uses a slot, the index of a frame in flight. Wait for the slot's fence, then call
//!    [`Renderer::collect`] and then [`Renderer::record`] with a [`Frame`]. [`Renderer::timings`] returns the time of
//!    each pass.
//! 5. Call [`Renderer::resize`] or [`Renderer::reconfigure`] at any time between records, and [`Renderer::destroy`]
//!    when the GPU is done.
//!
//! `tools/embed` in the repository is a complete small host.
//!
//! State that outlives a frame is kept in separate objects, which several views can share. The first three of this
//! list are updated once per simulation step:
//!
//! - [`SurfaceFoamState`] holds amount and age of the foam on each water particle
//!   ([`SurfaceFoamState::record_step`]).
//! - [`Generator`] emits, moves and ages whitewater: spray, foam and bubbles that are particles of their own.
//! - [`bubbles::BlobSimulation`] simulates blobs of bubble foam.
//! - [`shore::ShoreMap`] holds the distance to the shore. It is updated only when, and where, the land has changed.
//!
//! # What `record` takes
//!
//! State "`before` → `after`" means: `record` waits for the use named in `before` and leaves the resource ready for
//! the use named in `after`.
//!
//! | input | what | needs | state |
//! |---|---|---|---|
//! | `output` | colour, linear, scene-referred; written where there is water | colour attachment, or storage for [`Shading::Compute`](water::Shading); format `Config.output_format`; its `rect` is the frame, at most `Config.extent`; if it is also the scene, transfer source, or with `Config.light_map_size` sampled | `before` → `after` |
//! | `scene_color` | the scene behind the water; may be `output` itself (`Config.in_place`) | sampled, linear filtering | `before` → `after` |
//! | `scene_depth` | device depth in the camera's convention; any size | sampled and depth attachment, a view of the depth aspect alone, single-sampled | `before` → `after` |
//! | `particles.positions` | 3×f32, world space; NaN, infinite and huge ones are dropped and counted | storage buffer; any stride and offset that are multiples of 4 | `before` → `after` |
//! | `particles.densities` | f32; 0 marks a particle that was just emitted | as above | as above |
//! | `particles.count` | from the CPU, or a `u32` in a buffer, clamped | storage buffer, aligned offset | as above |
//! | `particles.packets` | the host's own groups with bounding boxes, for culling | storage buffer, aligned offset | as above |
//! | `particles.velocities` | 3×f32, world space; with `Config.surface_foam`, `Config.spray` or `Config.motion` | as `particles.positions` | as above |
//! | `particles.ids` | u32, the same for a particle in every frame; as velocities, and with [`Config::noise`] | as above | as above |
//! | `particles.surface_foam` | with `Config.surface_foam`: foam amount and age (2×f32, as [`SurfaceFoamState::foam`]) | as above | as above |
//! | `whitewater.positions` | with `Config.whitewater`: 3×f32, whitewater particles; NaN, infinite and huge ones are not drawn | as above | as above |
//! | `whitewater.kinds`, `radii`, `ages`, `ids` | u32, f32, f32, u32 per particle; all optional | as above | as above |
//! | `whitewater.count` | as `particles.count` | as `particles.count` | as above |
//! | `whitewater.packets` | as `particles.packets`, with `WhitewaterConfig::packets` | as `particles.packets` | as above |
//! | `whitewater.fluid_depth` | depth of a fluid surface of your own, in the camera's convention; any size; optional | sampled and depth attachment, single-sampled | `before` → `after` |
//! | `bubbles.spheres` | with `Config.bubbles`: 4×f32, centre and radius of soap-foam blobs, world space; entries with a non-finite or huge number or a radius ≤ 0 are ignored | storage buffer; any offset and stride that are multiples of 4 | as above |
//! | `bubbles.rotations`, `ids` | orientation quaternions (4×f32) and ids (u32) per blob; both optional | as above | as above |
//! | `bubbles.count` | as `particles.count` | as `particles.count` | as above |
//! | `shore.surface`, `mask` | with `Config.shore`: the height of your water, or its depth in the camera's convention; a single-channel mask that suppresses contact foam; any size | sampled (a depth: and depth attachment), single-sampled | `before` → `after` |
//! | `shore.shoreline` | a mesh strip: 3×f32 position and f32 shore coordinate per vertex, u32 indices; or the distances of a [`shore::ShoreMap`] | storage buffers | as above |
//! | `shadow` | with `Config.shadow`: the sun's depth map with its matrix, any size in any frame, or a mask over the view | sampled (a depth map: and depth attachment), single-sampled | `before` → `after` |
//! | `light_volume` | with `Config.light_map_size`: the sphere in which water and foam cast shadows and caustics | | |
//! | `previous` | with `Config.motion`: the camera of the previous frame and the seconds since | | |
//! | `panes` | panes of glass that the water stands against ([`water::Pane`]), up to 8; optional | | |
//! | `camera` | view and projection: perspective, standard or reversed depth, finite or infinite, off-axis, looking down −z or +z | | |
//!
//! # Motion vectors
//!
//! With [`Config::motion`] each record leaves a [`Layer`] `motion` that covers the frame. A vector is the position of
//! a surface point in this frame minus its position in the previous frame ([`Frame::previous`]), in pixels, y down.
//! Water and foam have the motion of their own surface, from the velocities of the particles near it, not the motion
//! of the scene behind it. The scene is taken as static, so its vectors come from the camera alone. An engine with
//! motion vectors of its own takes these where there is water: where the layer `water.depth` or `surface_foam`
//! ([`Config::keep_layers`]) is less than 1e10. (`surface_foam` has the resolution of the thickness.)
//!
//! # Promises
//!
//! - `record` only records: it never submits, waits, creates pipelines or allocates device memory.
//! - Each host image gets one acquire and one release barrier. The output gets more barriers in between if it is
//!   copied first, or if the lit scene is drawn to it. Core and synchronization validation report nothing.
//! - Pixels outside the fluid are unchanged, and zero particles change nothing. With `Config.light_map_size` the
//!   whole view is written: the scene with shadows and caustics.
//! - Every [`Error::BadInput`] and [`Error::NotRecorded`] is found before the first command. After any other error
//!   discard the command buffer and call [`Renderer::abandon`].
//! - `resize` and `reconfigure` are legal with frames in flight. `collect` frees the objects that they replaced as
//!   soon as every slot that used them has finished. Only construction, `resize`, `reconfigure`, `collect`, `abandon`
//!   and `destroy` call the allocator.
//! - Equal inputs give equal pictures on one device, whatever the order of the particles, because sums add integers,
//!   or multiples of a step that floats represent exactly. The order can matter in four cases: particles without ids,
//!   whose indices then stand for ids; splats that a raster path adds by blending; light maps some hundred spacings
//!   from the centre of [`Frame::light_volume`], where sums are only nearly exact; and whitewater by raster, which
//!   rounds sums beyond 256 and shows the first of two particles at the same depth.
//!
//! # Demands
//!
//! - Command buffers are primary, of the family in [`Host`], outside any render pass, without an active query or
//!   conditional rendering. They are submitted to one queue in the order in which they were recorded. Report a
//!   recorded command buffer that is never submitted with [`Renderer::abandon`], and a step in it with
//!   [`SurfaceFoamState::abandon`], [`Generator::abandon`] or [`shore::ShoreMap::abandon`].
//! - Before a slot is recorded again, its earlier GPU work is complete. Each view has a renderer of its own.
//! - The host acquires queue family ownership of its resources beforehand. Its images are single-sampled.
//!
//! Up is +y unless [`Settings::up`], and for the environment [`Sky::up`] or [`Equirectangular::up`], say otherwise.
//! Three more objects have an up direction: a [`Generator`] ([`GeneratorSettings::with_gravity`]), a blob simulation
//! ([`bubbles::BlobSimulationSettings::with_gravity`]) and a shore map ([`shore::Area::up`]).
//!
//! The view may be a part of each image ([`HostImage::rect`]). Several views can then share an image, and the
//! resolution can change from frame to frame, up to [`Config::extent`], without a resize.
//!
//! `record` clobbers the bound pipelines, descriptor sets, push constants, viewport and scissor. It does no tone
//! mapping, exposure, anti-aliasing or ownership transfers, and takes no multisampled images, array images or
//! orthographic cameras.
//!
//! # Memory
//!
//! [`Renderer::memory`] returns the exact number of bytes in use. With default values, each part takes, for w × h
//! pixels and n particles:
//!
//! | what | bytes | 1280×720 | 1920×1080 |
//! |---|---|---|---|
//! | depth | 4 w h | 3.5 MiB | 7.9 MiB |
//! | smoothing: two images and the iteration counts, at half resolution | 3 w h | 2.6 MiB | 5.9 MiB |
//! | smoothing: coarser levels for near water (`coarsening`) | 1½ w h | 1.3 MiB | 3.0 MiB |
//! | smoothing: the farther layer (`sheets`) | ¾ w h | 0.7 MiB | 1.5 MiB |
//! | thickness and its sums at quarter resolution | ¾ w h | 0.7 MiB | 1.5 MiB |
//! | two layers of water: thickness of each, cells, boundaries, depth of the farther (`sheets`) | 3½ w h | 3.1 MiB | 6.9 MiB |
//! | cells of pass `front` | ¼ w h | 0.2 MiB | 0.5 MiB |
//! | copy of the scene (half float, `in_place`) | 8 w h | 7.0 MiB | 15.8 MiB |
//! | environment, 256² cube with mips | | 4.0 MiB | 4.0 MiB |
//! | environment without the sun (`WhitewaterConfig::irradiance` of `Sampled`) | | 4.0 MiB | 4.0 MiB |
//! | foam: depth, thickness and its sums, water in front of it (`surface_foam`) | 3¼ w h | 2.9 MiB | 6.4 MiB |
//! | foam: its sunlit part (`surface_foam` with `light_map_size` or a shadow map) | ¼ w h | 0.2 MiB | 0.5 MiB |
//! | foam: sprites and shares (`surface_foam`) | 68 n | 4.3 MiB for 65 536 | 680 MB for 10 million |
//! | spray: optical depth, and the same weighted by sunlight (`spray`) | 8 w h | 7.0 MiB | 15.8 MiB |
//! | motion vectors, and sums at quarter resolution (`motion`) | 12½ w h | 11.0 MiB | 24.7 MiB |
//! | spray: sprites (`spray`) | 48 n | 3.0 MiB for 65 536 | 480 MB for 10 million |
//! | surface noise at half resolution (`noise`) | w h | 0.9 MiB | 2.0 MiB |
//! | surface noise: sprites (`noise`) | 16 n | 1.0 MiB for 65 536 | 160 MB for 10 million |
//! | whitewater: words, depths, thickness, normals, light, tiles (`whitewater`) | 88 w h | 77.4 MiB | 174.1 MiB |
//! | bubble foam: depth, colour, three layers and lists (`bubbles`) | 30½ w h | 26.8 MiB | 60.3 MiB |
//! | bubble foam: blobs (`bubbles`) | 64 per blob | 0.3 MiB for 5000 | |
//! | bubble foam: blobs made of whitewater foam (`bubbles.crossfade`) | 36 per blob | 2.3 MiB for 65 536 | |
//! | bubble foam: shadow map of N texels a side (`light_map_size` = N with `bubbles`) | N² | 1 MiB for 1024 | |
//! | shoreline and contact foam (`shore`), and 8.7 MiB for the textures | 4 w h | 3.5 MiB | 7.9 MiB |
//! | sunlight: maps of `light_map_size` = N texels a side | 36 N² | 36 MiB for 1024 | |
//! | sunlight: map of whitewater (`light_map_size` with `whitewater`) | 24 N² | 24 MiB for 1024 | |
//! | filtered host shadow map (`Shadows::Convolution`), N texels a side, 16 terms of 8 bits | 48 N² | 48 MiB for 1024 | |
//! | sunlight: the lit scene, instead of the copy | 8 w h | 7.0 MiB | 15.8 MiB |
//! | which particles are in a packet (`surface_foam`, `spray`, `motion`, `noise` or `light_map_size`) | n/8 | 8 KiB for 65 536 | 1.3 MB for 10 million |
//! | ellipsoids: grid, shapes, lists (`kernels`); with `surface_foam` 8 n more, with `spray` 4 n | 108 to 124 n | 6.8 to 7.5 MiB for 65 536 | 1.1 to 1.2 GB for 10 million |
//! | spheres: all, and the visible ones | 32 n | 2.0 MiB for 65 536 | 320 MB for 10 million |
//!
//! A [`SurfaceFoamState`] takes 68 bytes per particle. A [`Generator`] takes 76 to 80 bytes per particle of the fluid
//! and 44 per whitewater particle. A [`shore::ShoreMap`] takes 16 bytes per texel.
//!
//! # Where it differs from its sources
//!
//! The header of each pass states its differences; `docs/differences.md` in the repository collects the main ones.
//! Module `water` follows Bagar 2010. Whitewater particles ([`WhitewaterSettings`]) are drawn after Akinci et al.
//! 2013 and emitted after Ihmsen et al. 2012. `bubbles` follows Huszár and Szécsi, `shore` a blog and a tutorial.

#![cfg_attr(docsrs, feature(doc_cfg))]

/// The code of the README, compiled as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Named uses of images and buffers, for [`HostImage`] and [`Particles`].
pub mod access {
    pub use crate::gpu::access::{
        CLEAR, COLOR_ATTACHMENT, COMPUTE_READ, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ,
        COPY_WRITE, DEPTH_ATTACHMENT, FRAGMENT_SAMPLED, NOTHING,
    };
}

pub use ash;
pub use gpu_allocator;

pub mod bubbles;
mod check;
mod composite;
mod context;
mod contract;
mod diagnostics;
mod environment;
mod error;
mod frame;
mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
mod host_images;
#[cfg(feature = "io")]
pub mod io;
mod light;
mod random;
mod renderer;
pub mod shore;
mod sky;
mod state;
pub mod water;
mod whitewater;

pub use context::Context;
pub use contract::*;
#[cfg(feature = "diagnostics")]
pub use diagnostics::{Diagnostics, ParticleCounts, SmoothingLevel, SmoothingLevels};
pub use environment::{EnvironmentSource, Equirectangular, Sky};
pub use error::Error;
pub use gpu::features::DeviceFeatures;
pub use gpu::memory::{Allocate, Memory, MemoryLocation, MemoryRequest};
pub use gpu::requirements::{DeviceSupport, Limit, Requirement, Requirements, requirements};
pub use gpu::timing::Timing;
pub use renderer::Renderer;
pub use state::{SurfaceFoamState, SurfaceFoamStateConfig};
pub use whitewater::{
    Generator, GeneratorConfig, GeneratorSettings, PotentialRange, Submerged, WhitewaterConfig,
    WhitewaterSettings,
};
#[cfg(feature = "diagnostics")]
pub use whitewater::{Irradiance, Occlusion, OcclusionReach, ShadowMixing, WhitewaterSplat};
