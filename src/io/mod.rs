//! Files: particle caches in, pictures out.

pub mod particles;
pub mod picture;
