//! Shores: scenes with a sea, what goes round their islands, and the foam on it.

mod draw;
mod scenes;
mod strip;
mod terrain;

pub use draw::{Shores, Which, named, run};
