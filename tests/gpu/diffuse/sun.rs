//! The sun of a map, which the light tells of as well.

use super::*;

/// Foam gathers what the map without the sun gives, to the last bit, though the map shows it: in both ways.
#[test]
fn the_sun_of_a_map_is_not_gathered() {
    let gpu = Gpu::shared();
    for irradiance in [Irradiance::Prefiltered, Irradiance::Sampled] {
        let diffuse = Some(DiffuseConfig { irradiance, ..DiffuseConfig::new(4096) });
        let mut rig = Rig::new(&gpu, &Config { diffuse, ..diffusing(SIZE) });
        let mut cloud = Diffuse::new(Lens::Standard);
        // The light's own sun apart.
        cloud.shot.settings.light.shade = cloud.shot.settings.light.irradiance;
        let gathered = |rig: &mut Rig<'_>| {
            let light = cloud.draw(rig).diffuse.expect("diffuse particles").light;
            light.data.iter().map(|texel| texel.map(f32::to_bits)).collect::<Vec<_>>()
        };
        let size = extent(16, 8);
        let grey = [[0.7, 0.6, 0.5, 1.0]; 128];
        let mut sunny = grey;
        sunny[2 * 16 + 5] = [400.0, 300.0, 200.0, 1.0];
        rig.environment(size, &grey);
        let without = gathered(&mut rig);
        rig.environment(size, &sunny);
        let with = gathered(&mut rig);
        assert_ne!(without, with, "{irradiance:?}: the sun adds something");
        rig.environment_with_sun(size, [&sunny, &grey]);
        assert!(without == gathered(&mut rig), "{irradiance:?}: the sun of the map is gathered");
    }
}
