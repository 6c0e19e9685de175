//! Compares bubble foam with brute force and closed forms.

mod bad;
mod cast;
mod far;
mod film;
mod heap;
mod impostor;
mod life;
mod near;
mod soap;
mod tear;
mod wall;
mod water;
