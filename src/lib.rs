//! placeholder, replaced below

pub use ash;
pub use gpu_allocator;

mod composite;
pub mod contract;
mod environment;
pub mod error;
mod frame;
mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
#[cfg(feature = "io")]
pub mod io;
mod renderer;
pub mod water;

pub use contract::*;
pub use environment::{EnvironmentSource, Equirectangular, Sky};
pub use error::Error;
pub use gpu::requirements::{Need, Offer, Requirements, requirements};
pub use gpu::timing::Timing;
pub use renderer::Renderer;
