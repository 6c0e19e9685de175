//! Tests on a Vulkan device through the public API alone: every pass against its CPU twin, the
//! guarantees of the contract, and proof that each check can fail.
//!
//! `WHITEWATER_EXPECT_ADAPTER`: a part of the adapter's or driver's name, which is asserted.
//! `WHITEWATER_REQUIRE_VALIDATION=1`: the tests fail without the validation layer.
//! `WHITEWATER_SLOW=1`: also runs the slow tests. `WHITEWATER_WATCHDOG=SECONDS`: the longest wait
//! for the GPU, 60 by default.
#![allow(clippy::unwrap_used)] // a test may

mod reference;
mod support;

#[path = "gpu/backdrop.rs"]
mod backdrop;
#[path = "gpu/bubbles/mod.rs"]
mod bubbles;
#[path = "gpu/classify.rs"]
mod classify;
#[path = "gpu/composite.rs"]
mod composite;
#[path = "gpu/contract/mod.rs"]
mod contract;
#[path = "gpu/convolution.rs"]
mod convolution;
#[path = "gpu/depth.rs"]
mod depth;
#[path = "gpu/environment.rs"]
mod environment;
#[path = "gpu/far.rs"]
mod far;
#[path = "gpu/generate.rs"]
mod generate;
#[path = "gpu/harness.rs"]
mod harness;
#[path = "gpu/headless.rs"]
mod headless;
#[path = "gpu/hostile.rs"]
mod hostile;
#[path = "gpu/invariants.rs"]
mod invariants;
#[path = "gpu/level.rs"]
mod level;
#[path = "gpu/light/mod.rs"]
mod light;
#[path = "gpu/limits.rs"]
mod limits;
#[path = "gpu/motion.rs"]
mod motion;
#[path = "gpu/noise.rs"]
mod noise;
#[path = "gpu/panes.rs"]
mod panes;
#[path = "gpu/queries.rs"]
mod queries;
#[path = "gpu/rect.rs"]
mod rect;
#[path = "gpu/reduce.rs"]
mod reduce;
#[path = "gpu/sea.rs"]
mod sea;
#[path = "gpu/settings.rs"]
mod settings;
#[path = "gpu/shading.rs"]
mod shading;
#[path = "gpu/shape/mod.rs"]
mod shape;
#[path = "gpu/sheets/mod.rs"]
mod sheets;
#[path = "gpu/shore/mod.rs"]
mod shore;
#[path = "gpu/smooth.rs"]
mod smooth;
#[path = "gpu/spied.rs"]
mod spied;
#[path = "gpu/spray.rs"]
mod spray;
#[path = "gpu/surface_foam/mod.rs"]
mod surface_foam;
#[path = "gpu/temporal.rs"]
mod temporal;
#[path = "gpu/thickness.rs"]
mod thickness;
#[path = "gpu/up.rs"]
mod up;
#[path = "gpu/wavelets.rs"]
mod wavelets;
#[path = "gpu/whitewater/mod.rs"]
mod whitewater;
#[path = "gpu/whitewater_parts.rs"]
mod whitewater_parts;
#[path = "gpu/work.rs"]
mod work;
