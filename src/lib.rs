//! `whitewater` draws water given as particles into a frame of your own Vulkan engine.
//!
//! It records into a command buffer that you hand in, and owns no device, queue, window or
//! swapchain. A frame is one function that lists its passes; every barrier is written where it is
//! needed; the GPU decides counts, culling and when the smoothing ends, and nothing waits for the
//! host. Each pass is checked against a CPU twin on a software device.
//!
//! # Embedding
//!
//! 1. Ask [`requirements`] and [`Offer::check`] before you make the device, and enable what you
//!    want of the optional features ([`Offer`] says which it supports). Tell the truth about them
//!    in [`Enabled`].
//! 2. [`Context::new`] with a [`Host`], once for a device; [`Renderer::new`] with it and a [`Config`]: all memory is
//!    made here, and all pipelines that no other object of the context has made.
//! 3. [`Renderer::record_setup`] once, [`Renderer::record_environment`] once per environment.
//! 4. Each frame, after the slot's fence: [`Renderer::collect`], then [`Renderer::record`] with a
//!    [`Frame`]. [`Renderer::timings`] says what each pass took.
//! 5. [`Renderer::resize`] or [`Renderer::reconfigure`] whenever you like; [`Renderer::destroy`]
//!    when the GPU is done.
//!
//! `tools/embed` is the smallest host.
//!
//! What a body of water remembers, its foam, is a [`State`] of its own, which views share:
//! [`State::record_step`] once per step of the simulation. Spray, foam and bubbles that are particles of their own can
//! be made of the water's by a [`foam::Generator`], and blobs of bubble foam moved by a [`bubbles::Heap`], likewise once
//! per step. How far shores are a [`shore::ShoreMap`] finds, where land has changed.
//!
//! # What `record` takes
//!
//! | input | what | needs | state |
//! |---|---|---|---|
//! | `output` | colour, linear, scene-referred; written where there is water | colour attachment, or storage for [`Shading::Compute`](water::Shading); `Config.output_format`; its `rect` is the frame, at most `Config.extent`; transfer source when it is also the scene | `before` → `after` |
//! | `scene_color` | the scene behind the water; may be `output` itself (`Config.in_place`) | sampled, linear filtering | `before` → `after` |
//! | `scene_depth` | device depth in the camera's convention; any size | sampled and depth attachment, a view of the depth aspect alone, single-sampled | `before` → `after` |
//! | `particles.positions` | 3×f32, world space; NaN, infinite and huge ones are dropped and counted | storage buffer, any stride and offset that are multiples of 4 | `before` → `after` |
//! | `particles.densities` | f32; 0 marks a particle just emitted | as above | as above |
//! | `particles.count` | from the CPU, or a `u32` in a buffer, clamped | storage buffer, aligned offset | as above |
//! | `particles.packets` | the host's own groups with bounding boxes, to cull by | storage buffer, aligned offset | as above |
//! | `particles.velocities` | 3×f32, world space, with `Config.foam`, `Config.spray` or `Config.motion` | as above | as above |
//! | `particles.ids` | u32 that follow the particles, likewise, and with `Config.noise` | as above | as above |
//! | `particles.foam` | with `Config.foam`: foam and age (2×f32, as [`State::foam`]) | as above | as above |
//! | `diffuse.positions` | with `Config.diffuse`: 3×f32, spray, foam and bubbles of their own; NaN, infinite and huge ones are not drawn | as above | as above |
//! | `diffuse.kinds`, `radii`, `ages`, `ids` | u32, f32, f32, u32 of each; none need be there | as above | as above |
//! | `diffuse.count` | as `particles.count` | as above | as above |
//! | `diffuse.packets` | as `particles.packets`, with `DiffuseConfig::packets` | as above | as above |
//! | `diffuse.fluid_depth` | depth of a fluid surface of your own, in the camera's convention; any size; need not be there | sampled and depth attachment, single-sampled | `before` → `after` |
//! | `bubbles.balls` | with `Config.bubbles`: 4×f32, centre and radius of blobs of soap foam, world space; those that are none are dropped | as above | as above |
//! | `bubbles.turns`, `ids` | 4×f32 (quaternions), u32 of each; neither need be there | as above | as above |
//! | `bubbles.count` | as `particles.count` | as above | as above |
//! | `shore.surface`, `mask` | with `Config.shore`: your water's level, or its depth in the camera's convention; what takes contact foam away, one channel; any size | sampled (a depth: and depth attachment), single-sampled | `before` → `after` |
//! | `shore.shoreline` | a strip: 3×f32 and v of vertices, u32 of triangles; or a [`shore::ShoreMap`]'s distances | storage buffers | as above |
//! | `sun.shadow` | with `Config.shadow`: a depth map of the sun's, with its matrix, of any size from frame to frame, or a mask of the view | sampled (a depth map: and depth attachment), single-sampled | `before` → `after` |
//! | `sun.region` | with `Config.cast`: the ball in which water and foam cast shadows and caustics | | |
//! | `previous` | with `Config.motion`: the camera of the frame before and the seconds since | | |
//! | `camera` | view and projection: perspective, standard or reversed, finite or infinite, off-axis, looking down −z or +z | | |
//!
//! # Motion vectors
//!
//! With [`Config::motion`] each record leaves a [`Layer`] `motion` that covers the frame: where what a
//! pixel shows is, less where it was in the frame before ([`Frame::previous`]), in pixels, y down. Of
//! water and foam it is the surface's own motion, by the velocities of the particles near it, not that of
//! what is seen through it; of the scene, which stands still for it, the camera's. An engine that has
//! vectors of its own moving things takes ours where there is water: where `water.depth` or
//! `water.foam` (which has the thickness' resolution) is less than 1e10.
//!
//! # Promises
//!
//! - `record` only records: it never submits, waits, creates pipelines or allocates device memory.
//! - One acquire and one release barrier for each host image (the output has more between them where it
//!   is copied first, and where the lit scene is drawn); silent under core and
//!   synchronization validation.
//! - Pixels outside the fluid are not touched; no particles change nothing. With `Config.cast` all of
//!   the view is written: the scene under the shadows and caustics.
//! - Every [`Error::BadInput`] is found before the first command. After any other error discard the
//!   command buffer, and tell with [`Renderer::abandon`].
//! - `resize` and `reconfigure` are legal with frames in flight; what they replace is freed by
//!   `collect` when every slot that used it has come back. Only construction, `resize`,
//!   `reconfigure`, `collect` and `destroy` lock the allocator.
//! - Equal inputs give equal pictures on one device, whatever the order of the particles, but for the
//!   additive blending of [`Splat::Raster`](water::Splat): other sums are of integers, or of steps
//!   that floats hold exactly (where the light's maps lie some hundred spacings from their region's
//!   middle, nearly). By [`foam::Splat::Raster`] sums beyond 256 are rounded, and of two diffuse particles at one depth
//!   the first is the frontmost.
//!
//! # Demands
//!
//! - Command buffers are primary, of the family in [`Host`], outside any render pass, with no
//!   active query and no conditional rendering; they are submitted to one queue in the order they
//!   were recorded. A recorded one that is never submitted is reported by [`Renderer::abandon`].
//! - One `record` per slot; two views are two renderers. The slot's earlier work is complete.
//! - Family ownership is acquired before, images are single-sampled.
//!
//! Up is +y unless [`Settings::up`] says otherwise, and for the environment [`Sky::up`] or [`Equirectangular::up`].
//!
//! The view may be a part of each image ([`HostImage::rect`]), so that several views share one, and
//! a resolution may change from frame to frame below [`Config::extent`] without a resize.
//!
//! Clobbered: bound pipelines, descriptor sets, push constants, viewport and scissor. Not done:
//! tone mapping, exposure, anti-aliasing, ownership transfers, multisampled or array images,
//! orthographic cameras.
//!
//! # Memory
//!
//! [`Renderer::memory`] says it exactly. With the defaults, for w × h pixels and n particles:
//!
//! | what | bytes | 1280×720 | 1920×1080 |
//! |---|---|---|---|
//! | depth | 4 w h | 3.5 MiB | 7.9 MiB |
//! | smoothing, two images, and the plan, at half resolution | 3 w h | 2.6 MiB | 5.9 MiB |
//! | the same coarser, for what is near (`coarsening`) | 1½ w h | 1.3 MiB | 3.0 MiB |
//! | the same of the farther sheet (`sheets`) | ¾ w h | 0.7 MiB | 1.5 MiB |
//! | thickness and its sums at quarter resolution | ¾ w h | 0.7 MiB | 1.5 MiB |
//! | two sheets: thickness of each, boundaries, depth of the farther (`sheets`) | 2½ w h | 2.2 MiB | 4.9 MiB |
//! | cells of the front pass | ¼ w h | 0.2 MiB | 0.5 MiB |
//! | copy of the scene (half float, `in_place`) | 8 w h | 7.0 MiB | 15.8 MiB |
//! | environment, 256² cube with mips | | 4.0 MiB | 4.0 MiB |
//! | the same without the sun (`DiffuseConfig::irradiance` of `Sampled`) | | 4.0 MiB | 4.0 MiB |
//! | foam: depth, thickness and its sums, what water is before it (`foam`) | 3¼ w h | 2.9 MiB | 6.4 MiB |
//! | foam: what of it the sun lights (`foam` with `cast` or a shadow map) | ¼ w h | 0.2 MiB | 0.5 MiB |
//! | foam: sprites and shares (`foam`) | 68 n | 4.3 MiB for 65 536 | 680 MB for 10 million |
//! | spray: optical depth, and what of it is lit (`spray`) | 8 w h | 7.0 MiB | 15.8 MiB |
//! | motion vectors, and sums at quarter resolution (`motion`) | 12½ w h | 11.0 MiB | 24.7 MiB |
//! | spray: sprites (`spray`) | 32 n | 2.0 MiB for 65 536 | 320 MB for 10 million |
//! | surface noise at half resolution (`noise`) | w h | 0.9 MiB | 2.0 MiB |
//! | surface noise: sprites (`noise`) | 16 n | 1.0 MiB for 65 536 | 160 MB for 10 million |
//! | diffuse particles: words, depths, thickness, normals, light, tiles (`diffuse`) | 88 w h | 77.4 MiB | 174.1 MiB |
//! | bubble foam: depth, colour, three layers and lists (`bubbles`) | 30½ w h | 26.8 MiB | 60.3 MiB |
//! | the same, blobs (`bubbles`) | 64 a blob | 0.3 MiB for 5000 | |
//! | those that diffuse foam becomes (`bubbles.hand_over`) | 36 a blob | 2.3 MiB for 65 536 | |
//! | the same as the sun sees them (`cast` = N with `bubbles`) | N² | 1 MiB for 1024 | |
//! | shoreline and contact foam (`shore`), and 8.7 MiB for the textures | 4 w h | 3.5 MiB | 7.9 MiB |
//! | sunlight: maps of `cast` = N texels a side | 36 N² | 36 MiB for 1024 | |
//! | the same of diffuse particles (`cast` with `diffuse`) | 24 N² | 24 MiB for 1024 | |
//! | shadow map of the host's, filtered (`Shadows::Convolution`): N texels a side, 16 terms of 8 bits | 48 N² | 48 MiB for 1024 | |
//! | sunlight: the lit scene, in place of the copy | 8 w h | 7.0 MiB | 15.8 MiB |
//! | which particles are in packets (`foam`, `spray`, `motion`, `noise` or `cast`) | n/8 | 8 KiB for 65 536 | 1.3 MB for 10 million |
//! | ellipsoids: grid, shapes, lists (`kernels`) | 92 to 96 n | 5.8 MiB for 65 536 | 960 MB for 10 million |
//! | spheres, all and front | 32 n | 2.0 MiB for 65 536 | 320 MB for 10 million |
//!
//! A [`State`] takes 68 bytes a particle, a [`foam::Generator`] 76 to 80 a particle of the fluid and 44 a diffuse one, a
//! [`shore::ShoreMap`] 16 a texel.
//!
//! # Where it differs from its sources
//!
//! Each pass says so at its head. The main points, against the thesis (Bagar 2010):
//!
//! - Depth is the ray's exact hit with the sphere, not a billboard's offset; only spheres that can
//!   show are drawn for it.
//! - The smoothing is mean curvature flow of the perspective surface itself
//!   ([`Rule::ConstantWidth`](water::Rule)); the thesis' formula leaves the ray's slope out and
//!   is right on the optical axis only. Its form is there as [`Rule::Source`](water::Rule).
//! - Where the cap of iterations would leave near water rough, it is smoothed a level coarser, each pixel by
//!   its own distance.
//! - Iterations are planned per pixel before the first, so that all forms do the same work; the
//!   occlusion query's decision stays on the GPU.
//! - Thickness is in metres of water: the integral of a sprite is the particle's volume.
//! - Refraction bends towards the normal, as light does (the thesis has the sign the other way), and
//!   looks no farther than a sixteenth of the picture's height: torn water would be a mosaic.
//! - There is no more water than there is room before the scene: it ends softly where it meets it.
//! - Where one body of water stands before another with air between, a drop before a pool say, each
//!   has its own thickness and surface ([`Config::sheets`]); the thesis takes both for one (its
//!   limitation, Fig. 5.13).
//! - A foam sprite turns from an ellipse along its motion into a disc smoothly, by speed and by angle;
//!   its depth is as wide as its thickness, which ends softly, before the scene too, and of its
//!   resolution; what is foam of a particle is no water of it, in metres. Water before the frontmost foam
//!   is told once a fragment, not once a particle. All of a pixel's foam is where its middle is, or its
//!   front where it hides what is behind, under the water before that; to the thesis it is at the
//!   frontmost's depth, and a thin veil brings up what lies deep, with its own outline (so it stays with
//!   [`water::Medium::Source`]).
//! - Foam is thick here and thin there by one noise in space that it carries along ([`water::FoamLook::pattern`]); in the
//!   thesis each sprite has a noise of its own, and many over each other are a mist. It is there as
//!   [`water::FoamLook::noise`], with a pattern of 0.
//! - Thin foam may be torn into threads with clear holes between them ([`water::FoamLook::lace`]), and lit by the shape of a
//!   whole splash ([`water::FoamLook::shape`]); the thesis' is a veil, and flat.
//! - The thickness of foam shades it as a relief, and where there is little it is less ([`water::FoamLook`]);
//!   the thesis' foam is flat. Shadows on it are those of its sprites, one look a particle; the thesis
//!   looks nine times a pixel, at depths that jump from sprite to sprite.
//! - Spray is water that turns into droplets as its density falls, laid over the picture; the thesis
//!   adds a sprite a particle ([`water::SprayLook::SOURCE`]).
//! - The baseline's surface noise (van der Laan et al. 2009) is a height in metres along the normal, the
//!   same at every distance and resolution, on the front sheet ([`Config::noise`]); the baseline adds the
//!   derivatives of the noise's image to the normal.
//! - Shadows: percentage-closer filtering of the host's map, or its mask, or convolution shadow maps, which
//!   the thesis takes; these span no more depth than there is in the map, and are damped so that few terms
//!   keep the light's height ([`Shadows::Convolution`](water::Shadows)). Water and foam cast coloured
//!   shadows and caustics, which the thesis leaves to the future. What share of the scene's light is the
//!   sun's is taken from level ground.
//! - At borders the derivatives of texels on the same surface are blended, and shaded once. Water seen along its
//!   surface has steps of more than the border's threshold from texel to texel: what goes straight on is no
//!   border, and a pixel that finds none of the four texels about it looks at those next to them. Else there are
//!   dark dashes.
//!
//! Against Akinci et al. (2013), whose foam of diffuse particles it is:
//!
//! - Particles smaller than a pixel and a half are widened, and their light is kept exactly, wherever between the
//!   pixels they lie: far foam does not sparkle. Their normal is not their spheres', of which a pixel's middle hits
//!   a place by chance, but where the occlusion's samples find the space about them open: the sum of λ (ω − hidden) s
//!   over all samples s of their spheres.
//! - What is behind the water's surface lies in the water, at its mean depth, and loses light as all in it does; the
//!   source's falloff is there as [`foam::Submerged::Falloff`].
//! - A sample is hidden by how far its occluder stands before the sample itself; the print has the fragment's depth.
//!   The reach is a radius of the search, not metres ([`foam::Reach`]).
//! - By default a pixel has a sixteenth of the samples ([`foam::Occlusion::Fast`]), in pairs that lie opposite each other:
//!   each pixel by itself finds half of a half space hidden. The blur is cut along rows and columns, and far from its
//!   middle takes some of the numbers ([`foam::DiffuseLook::blur`]).
//! - Light is scaled by what is in shadow ([`foam::Mixing`]); the source subtracts the shadow. The sun, which an
//!   environment does not hold, is added.
//! - Foam casts shadows (`Config.cast`), its future work: of the sun it takes what it covers of a picture from there,
//!   by the thickness that lies before a point, told by its mean and its variance along the light.
//!
//! Against Huszár and Szécsi (*GPU-supported bubble and foam rendering*), whose blobs of bubbles they are:
//!
//! - The phase between a film's two faces is of the ray inside it and halved, and by Airy's sum no more light comes back
//!   than there was; as printed, maxima lie at half their thickness and grazing light is reflected fourfold
//!   ([`bubbles::FilmFresnel::Source`] has the rest of that form). The whole spectrum is looked at.
//! - Walls are built as a curvature and an apex: nearly equal bubbles have no sphere that single precision holds. The
//!   print of their construction lost its roots and squares.
//! - What the search along a ray finds is looked up among the bubbles beside it: edges are where they are, not where
//!   the map's texels are, and no wall is missed.
//! - The wall in a bubble is the one that the ray crosses first, of all sixteen neighbours; the source's is that of the
//!   next bubble its search finds.
//! - Diffuse foam near the eye, which Akinci et al. give up, becomes blobs ([`bubbles::HandOver`]).
//! - A pixel goes through the blobs of its tile once and ends where nothing behind can be seen; drawn once a layer, the
//!   source's way, they are there as [`bubbles::BubbleSort::Peel`].
//!
//! Against the blog and the tutorial whose shoreline and contact foam it is:
//!
//! - A pixel is as much foam as it covers of it, and what is too fine for it counts as a variance; both clip or leave it to
//!   the textures ([`shore::Edge`]).
//! - Noise on a speed swings, and phases come from the host within one turn: nothing drifts apart or loses digits in time.
//! - No mesh is needed: distances come from a map in the world, or from the slope of what is below the water.
//! - The tutorial's colour is taken as sRGB, its distance as that of both points, as its program has it; its text takes
//!   the difference along the view ([`shore::Measure`]).
//!
//! Against Ihmsen et al. (2012), whose diffuse particles [`foam::Generator`] makes:
//!
//! - Sums over neighbours are of whole steps and random numbers belong to ids: the same particles in every run. Of
//!   each bucket of the grid 256 are looked at, thirty times what water has in a cell; which, where there are more,
//!   is the device's.
//! - A particle is at the surface where the middle of its neighbours, weighted, is 0.15 of their reach away.
//! - The class of a particle is told anew in each step; solids are not known, a box bounds where one may be.
//! - Energy is per mass, and the tool finds limits and rates by the data.
//! - They have sequences. Of a single frame [`foam::Generator::record_snapshot`] takes the flow to be steady: what the water
//!   at 15 moments of the longest life made, on its way to each particle, lies there, foam as old as that is long ago.

#![cfg_attr(docsrs, feature(doc_cfg))]

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
mod environment;
mod error;
pub mod foam;
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

pub use context::Context;
pub use contract::*;
pub use environment::{EnvironmentSource, Equirectangular, Sky};
pub use error::Error;
pub use gpu::features::DeviceFeatures;
pub use gpu::memory::{Allocate, Memory, MemoryLocation, MemoryRequest};
pub use gpu::requirements::{Limit, Need, Offer, Requirements, requirements};
pub use gpu::timing::Timing;
pub use renderer::Renderer;
pub use state::{State, StateConfig};
