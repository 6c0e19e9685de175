//! The scenes.

mod bamboo;
mod corridor;
mod waterfall;

pub use bamboo::bamboo;
pub use corridor::corridor;
pub use waterfall::waterfall;
