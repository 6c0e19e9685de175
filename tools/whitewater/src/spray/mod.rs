//! Decides which particles with low densities are water, not spray.

mod bodies;
mod films;

use whitewater::Settings;

/// Raises the densities of particles that are part of a film or of a loose body of water, so that they are not drawn
/// as spray.
pub fn keep_water(positions: &[[f32; 3]], densities: &mut [f32], settings: &Settings) {
    let (spacing, rest) = (settings.water.spacing, settings.water.rest_density);
    films::hold(positions, densities, spacing, settings.spray.no_spray_density * rest);
    bodies::hold(positions, densities, spacing, rest);
}
