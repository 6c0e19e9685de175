//! Shoreline foam.

pub mod texture;
