//! Claims of the documentation, measured on a Vulkan device (`docs/smoothing.md`).
//!
//! `WHITEWATER_SLOW=1`: the whole table too, printed as Markdown (with `--nocapture`).
//! `WHITEWATER_PICTURE=FILE.jpg`: the picture too.
#![allow(clippy::unwrap_used)] // a test may

#[path = "claims/bed.rs"]
mod bed;
#[path = "claims/links.rs"]
mod links;
#[path = "claims/roughness.rs"]
mod roughness;
#[path = "support/skipped.rs"]
mod skipped;
#[path = "claims/smoothing.rs"]
mod smoothing;
