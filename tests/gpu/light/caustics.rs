//! The caustics against the twin, and the closed form of a flat pool.

use whitewater::Region;

use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot};
use crate::support::scenes::Lens;
use crate::support::tolerance::U;

use super::{SIZE, casting, maps, pool, toward, twin, water};

/// Caustics of the maps that the device itself made. Each texel's light is in the bounds of where
/// it lands; all of it is kept, but for what the rounding of four parts each may take.
#[test]
fn the_caustics_are_the_twins() {
    let gpu = Gpu::shared();
    for (texels, wave, drops, width) in
        [(64, 0.06, 12, 1.5), (48, 0.1, 0, 1.0), (64, 0.06, 40, 0.0), (32, 0.2, 12, 6.0)]
    {
        let config = casting(texels);
        let mut rig = Rig::new(&gpu, &config);
        for sun in [toward(0.2, 1.0, 0.1), [0.0, 1.0, 0.0], toward(-0.6, 0.7, 0.3)] {
            let mut case = pool(sun, wave, drops);
            case.shot.settings.water.smoothing_width = width;
            let drawn = case.draw(&mut rig);
            let (light, maps) = (twin(&case.shot, &config), maps(&drawn));
            let name = format!("caustics-{texels}-{drops}-{}", sun[0]);
            let (bounds, units) = light.caustics(&maps);
            compare::between(&name, maps.caustics, &bounds);
            let wide = |b: &crate::support::tolerance::Between| {
                let each = b.low.data.iter().zip(&b.high.data).map(|(low, high)| high - low);
                each.sum::<f64>() / b.low.data.len() as f64
            };
            let brightest = maps.caustics.data.iter().fold(0.0, |a: f32, c| a.max(*c));
            if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
                eprintln!("{name}: {} wide, {} units, to {brightest}", wide(&bounds), wide(&units));
            }
            assert!(wide(&bounds) < 0.02 && brightest > 1.1, "{name}: {}, idle", wide(&bounds));
            // Nothing comes near the border: as much light as without water.
            let n = texels as usize;
            let inner = |i: usize| i > 2 && i + 3 < n;
            let landed: Vec<_> = light.landings(&maps).data.into_iter().flatten().collect();
            let wet = landed.len() as f64;
            let lost = landed
                .iter()
                .flatten()
                .any(|at| !inner(at.v.floor() as usize) || !inner(at.v.ceil() as usize));
            // Few large texels reach far.
            assert!(!lost || texels == 32, "{name}: light leaves the map");
            let all: f64 = maps.caustics.data.iter().map(|c| f64::from(*c) - 1.0).sum();
            let most = 2.0 * wet / 4096.0 + 40.0 * U * (n * n) as f64;
            assert!(
                all.abs() <= most,
                "{name}: {all} of the light is lost or won, of {wet} texels"
            );
        }
    }
}

/// A flat pool, each texel like the next, bends no light out of its place.
#[test]
fn a_flat_pool_lets_the_light_pass() {
    let gpu = Gpu::shared();
    let (texels, radius) = (64_i32, 1.0_f32);
    let mut rig = Rig::new(&gpu, &casting(texels as u32));
    let t = 2.0 * radius / texels as f32;
    for slope in [0.0, 0.5] {
        let at = |i: i32| t * (i as f32 + 0.5) - radius;
        let points = (12..52).flat_map(|i| (12..52).map(move |j| (at(i), at(j))));
        let mut shot = Shot::new(SIZE, Lens::Standard, 0.656 * 2.0 * t, &[]);
        shot.positions = points.map(|(x, z)| [x, slope * x, z]).collect();
        shot.settings.light.direction = [0.0, 1.0, 0.0];
        shot.sun.region = Some(Region { center: [0.0; 3], radius });
        let drawn = water(shot).draw(&mut rig);
        let found = drawn.caustics.expect("caustics");
        for (x, y) in (24..40).flat_map(|y| (24..40).map(move |x| (x, y))) {
            let light = f64::from(found.at(x, y));
            // Of a slope all parts move alike; four roundings of 1 / 4096 each.
            let most = if slope == 0.0 { 32.0 * U } else { 4.0 / 4096.0 };
            assert!((light - 1.0).abs() <= most, "{slope}: {light} at ({x}, {y})");
        }
    }
}
