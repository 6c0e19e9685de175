//! Shores: scenes with a sea, what goes round their islands, and the foam on it.

mod draw;
mod own;
mod scenes;
pub mod strip;
pub mod terrain;

pub use draw::{Shores, Which, changed, named, run, scene_of, transforms};
pub use scenes::ShoreScene;
