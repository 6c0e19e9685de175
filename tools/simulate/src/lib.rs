//! The demonstration scenes of whitewater, and the SPH solver that fills them with water.

pub mod bgeo;
pub mod hinge;
mod kernel;
mod neighbours;
pub mod preview;
pub mod scene;
mod scenes;
mod solver;

pub use bgeo::Frame;
pub use scene::{FPS, FRAMES, Scene};
pub use solver::{REST_DENSITY, Simulation, StepReport};
