//! Files: reads particle caches, writes pictures.

pub mod particles;
pub mod picture;
