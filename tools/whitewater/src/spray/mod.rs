//! Tells spray from water by how the particles lie.

mod bodies;
mod films;

use whitewater::Settings;

/// Adjusts the densities, by which particles are drawn as spray or as water: raises those of films and of loose bodies
/// of water, and lowers those of lone clusters of particles.
pub fn sort(positions: &[[f32; 3]], densities: &mut [f32], settings: &Settings) {
    let (spacing, rest) = (settings.water.spacing, settings.water.rest_density);
    let limits = &settings.spray;
    films::hold(positions, densities, spacing, limits.no_spray_density * rest);
    bodies::sort(positions, densities, spacing, (limits.all_spray_density * rest, rest));
}
