//! Shores: scenes with a sea, strips around their islands, and foam.

mod draw;
mod own;
mod scenes;
pub mod strip;
pub mod terrain;

pub use draw::{Shores, Which, changed, named, run, scene_of, transforms};
pub use scenes::ShoreScene;
