//! Twin of bubble foam (Huszár, Szécsi): film, walls and blobs by their equations and by brute
//! force.

pub mod core;
pub mod film;
pub mod heap;
pub mod impostor;
pub mod merge;
pub mod soap;
pub mod wall;
