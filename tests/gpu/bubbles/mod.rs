//! Bubble foam, against brute force and closed forms.

mod bad;
mod film;
mod heap;
mod impostor;
mod wall;
