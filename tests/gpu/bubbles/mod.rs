//! Bubble foam, against brute force and closed forms.

mod bad;
mod film;
mod impostor;
mod wall;
