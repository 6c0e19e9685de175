//! Compares the light map's front depth and thickness with the CPU twin.

use whitewater::{Config, LightVolume};

use crate::reference::EMPTY;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig};
use crate::support::scenes::{self, Lens, Random};
use crate::surface_foam::Foamy;

use super::{SIZE, casting, maps, particles, toward, twin};

/// Checks that front depth and thickness are the twin's. Returns the number of texels with
/// particles.
fn check_maps(name: &str, case: &Foamy, config: &Config, drawn: &Drawn) -> usize {
    let (light, particles, maps) = (twin(&case.shot, config), particles(case), maps(drawn));
    let bounds = light.front(&particles);
    compare::between(&format!("{name}-front"), maps.front, &bounds);
    // Of texels that may have water.
    let pairs = || bounds.low.data.iter().zip(&bounds.high.data).filter(|(a, _)| **a < EMPTY);
    let close = pairs().filter(|(a, b)| **b - **a < 1e-3).count();
    println!("{name}: {close} of {} depths are known", pairs().count());
    assert!(close * 100 > 98 * pairs().count(), "{name}: idle bounds");
    for (i, bounds) in light.thickness(&particles).iter().enumerate() {
        let found = maps.thickness.map(|t| t[i]);
        compare::between(&format!("{name}-thickness-{i}"), &found, bounds);
        // Depth times thickness may be negative.
        let pairs = || {
            let pairs = bounds.low.data.iter().zip(&bounds.high.data);
            pairs.filter(|(a, b)| **a != 0.0 || **b != 0.0)
        };
        let same = pairs().filter(|(a, b)| a == b).count();
        println!("{name}: {same} of {} thicknesses of {i} are known", pairs().count());
        assert!(same * 100 > 80 * pairs().count(), "{name}: idle bounds of {i}");
    }
    maps.front.data.iter().filter(|d| **d < 1e9).count()
}

#[test]
fn the_maps_are_the_twins() {
    let gpu = Gpu::shared();
    let suns = [
        toward(0.4, 0.8, 0.4),
        [0.0, 1.0, 0.0],
        toward(0.1, 0.99, 0.02),
        toward(-0.7, 0.3, 0.2),
        toward(0.6, -0.1, -0.5),
        [0.0, -1.0, 0.0],
    ];
    for (spray, texels) in [(false, 64), (true, 64), (true, 16), (false, 112)] {
        let config = casting(texels).with(|it| it.spray = spray);
        let mut rig = Rig::new(&gpu, &config);
        for (i, sun) in suns.into_iter().enumerate() {
            let mut case = Foamy::new(SIZE, Lens::Standard, 10.0);
            let mut random = Random(i as u64);
            let n = case.shot.positions.len();
            case.shot.settings.light.direction = sun;
            // Some particles lie beside the region, before it and behind it, some outside the view.
            let center = scenes::world(&case.shot.camera, &[[0.3, -0.2, 5.0]])[0];
            case.shot.light_volume = Some(LightVolume { center, radius: [3.0, 12.0][i % 2] });
            if i > 0 {
                let density = |i| match i % 9 {
                    0 => [0.0, -3.0, f32::NAN][i % 3],
                    _ => random.between(250.0, 1000.0),
                };
                case.shot.densities = Some((0..n).map(density).collect());
            }
            case.shot.settings.spray.shade = [0.5, 0.125][i / 2 % 2];
            // A single droplet stands for all of a particle's spray. With several, fewer are drawn
            // the more of the particle is spray.
            case.shot.settings.spray.droplets = [16, 1, 2][i % 3];
            case.shot.settings.spray.scatter_radius = [1.5, 6.0][i % 2];
            case.amounts[7][0] = f32::NAN;
            case.amounts[8][0] = 3.0;
            case.shot.positions[3][1] = f32::NAN;
            case.shot.positions[4][0] = f32::INFINITY;
            case.shot.positions[5][2] = -1e19;
            let drawn = case.draw(&mut rig);
            let found = check_maps(&format!("light-{spray}-{texels}-{i}"), &case, &config, &drawn);
            assert!(found > 40, "{found} texels");
        }
    }
}
