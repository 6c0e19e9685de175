//! Pass `thickness`: metres of water along z, against the twin.

use whitewater::Config;
use whitewater::water::Splat;

use crate::depth::spheres;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens};
use crate::support::tolerance::{self, Sum};

const PATHS: [(Splat, Sum); 2] = [(Splat::Raster, Sum::Float), (Splat::Compute, Sum::Fixed)];

fn check(name: &str, rig: &mut Rig<'_>, shot: &Shot, sum: Sum) {
    let (size, level) = (rig.config.extent, rig.config.thickness_level);
    let drawn = rig.draw(shot);
    let view = shot.view(size);
    let water = &shot.settings.water;
    let bounds = tolerance::thickness(
        &spheres(shot),
        &view,
        level,
        &shot.scene_at(size, level),
        f64::from(water.spacing).powi(3),
        f64::from(water.radius()),
        sum,
    );
    compare::between(name, &drawn.thickness, &bounds);
    assert!(drawn.thickness.data.iter().any(|t| *t > 0.0), "{name}: there is water");
}

#[test]
fn it_is_the_twins_through_every_lens() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let points = scenes::cloud(17, 500, 0.4, 15.0);
    for (splat, sum) in PATHS {
        for level in [0, 1] {
            let config =
                Config { thickness_splat: Some(splat), thickness_level: level, ..config(size) };
            let mut rig = Rig::new(&gpu, &config);
            for lens in LENSES {
                let mut shot = Shot::new(size, lens, 0.15, &points);
                check(&format!("thickness-{splat:?}-{level}-{lens:?}"), &mut rig, &shot, sum);
                shot.scene_depth(|x, y| ((x / 9 + y / 5) % 2 == 0).then_some(3.0 + f64::from(y)));
                check(&format!("thickness-{splat:?}-{level}-{lens:?}-cut"), &mut rig, &shot, sum);
            }
        }
    }
}

/// Many layers, large sprites, sprites before the near plane, odd sizes, quarter resolution.
#[test]
fn sums_of_many_and_of_large_sprites() {
    let gpu = Gpu::shared();
    for (splat, sum) in PATHS {
        for (width, height, level) in [(33, 17, 1), (97, 61, 2), (5, 3, 1), (1, 7, 0)] {
            let size = extent(width, height);
            let config = Config {
                thickness_splat: Some(splat),
                smoothing_level: level,
                thickness_level: level,
                ..config(size)
            };
            let mut rig = Rig::new(&gpu, &config);
            let cases: [(&str, f32, Vec<[f32; 3]>); 3] = [
                ("many", 0.3, scenes::cloud(1, 2000, 2.0, 6.0)),
                ("large", 2.0, scenes::cloud(2, 30, 0.5, 6.0)),
                ("near", 0.2, scenes::cloud(3, 60, 0.0, 0.4)),
            ];
            for (name, radius, points) in cases {
                let shot = Shot::new(size, Lens::Infinite, radius, &points);
                check(&format!("thickness-{name}-{splat:?}-{width}"), &mut rig, &shot, sum);
            }
        }
    }
}
