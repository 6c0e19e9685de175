//! Tells spray from water by how the particles lie.

mod bodies;
mod films;

use whitewater::Settings;

/// Adjusts the densities, by which particles are drawn as spray or as water: raises those of films and of loose bodies
/// of water, and lowers those of lone clusters of particles.
pub fn adjust_densities(positions: &[[f32; 3]], densities: &mut [f32], settings: &Settings) {
    let (spacing, rest) = (settings.water.spacing, settings.water.rest_density);
    let limits = &settings.spray;
    films::hold(positions, densities, spacing, limits.no_spray_density * rest);
    bodies::adjust_densities(
        positions,
        densities,
        spacing,
        (limits.all_spray_density * rest, rest),
    );
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;
    use whitewater::water::SpraySettings;

    use super::bodies;
    use crate::args::Cli;
    use crate::looks;

    /// The numbers in the help of --spray are those of the code.
    #[test]
    fn the_help_states_the_limits_of_spray() {
        let command = Cli::command();
        let render = command.find_subcommand("render").unwrap();
        let spray = render.get_arguments().find(|arg| arg.get_id() == "spray").unwrap();
        let help = spray
            .get_long_help()
            .unwrap()
            .to_string()
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        let mut limits = SpraySettings::default();
        looks::spray_of_caches(&mut limits, 0.05, 1.0);
        let [few, many] = limits.few_neighbours;
        let [all, full, none] =
            [limits.all_spray_density, limits.full_water_density, limits.no_spray_density];
        for said in [
            format!("few_neighbours = [FEW, MANY] [default: {few}, {many}]"),
            format!("as fractions of the rest density [default: {all}, {full}, {none}]"),
            format!("A cluster of up to {} particles", bodies::LONE[0]),
        ] {
            assert!(help.contains(&said), "{said}: {help}");
        }
    }
}
