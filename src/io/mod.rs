//! Files: particle caches in, pictures out.

pub mod particles;
