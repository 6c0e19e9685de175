//! Compares caustics with the CPU twin, and with the closed form for a flat pool.

use glam::{DVec2, DVec3, Vec3};
use whitewater::water::Shadows;
use whitewater::{LightVolume, Shadow};

use crate::harness::fails;
use crate::reference::light::{Light, Maps, ShadowMap};
use crate::reference::wavelets::Waves;
use crate::reference::{Image, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot};
use crate::support::rounded::{Rounded, exact};
use crate::support::scenes::Lens;
use crate::support::tolerance::U;

use super::shade::{light_views, shadows};
use super::{SIZE, casting, maps, pool, toward, twin, water};

/// Caustics of the maps that the device made. The light of each texel lies within the bounds of its
/// landing place, and the total is kept except for the rounding of four parts per texel.
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
            let (bounds, units) = light.caustics(&maps, &|_, _| exact(1.0));
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
            // No light lands near the border, so the total equals that without water.
            let n = texels as usize;
            let inner = |i: usize| i > 2 && i + 3 < n;
            let landed: Vec<_> = light.landings(&maps).data.into_iter().flatten().collect();
            let wet = landed.len() as f64;
            let lost = landed
                .iter()
                .flatten()
                .any(|at| !inner(at.v.floor() as usize) || !inner(at.v.ceil() as usize));
            // With only 32 texels, refracted light travels far and may leave the map.
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

/// Small waves on a level pool focus light like the twin's, and keep the total.
#[test]
fn small_waves_focus_light() {
    let gpu = Gpu::shared();
    let config = casting(128);
    let mut rig = Rig::new(&gpu, &config);
    for sun in [[0.0, 1.0, 0.0], toward(-0.6, 0.7, 0.3)] {
        let mut case = pool(sun, 0.0, 0);
        case.shot.settings.water.wavelets.slope = 0.06;
        case.shot.settings.water.wavelets.length = 0.5;
        case.shot.settings.water.wavelets.time = 1.3;
        let drawn = case.draw(&mut rig);
        let maps = maps(&drawn);
        let waves = |slope| Some(Waves::new(slope, 0.5, (1.3, 9.81), DVec3::Y));
        let twin = |slope| Light { waves: waves(slope), ..twin(&case.shot, &config) };
        let (bounds, _) = twin(f64::from(0.06_f32)).caustics(&maps, &|_, _| exact(1.0));
        compare::between(&format!("wavelets-{}", sun[0]), maps.caustics, &bounds);
        let (other, _) = twin(0.066).caustics(&maps, &|_, _| exact(1.0));
        let seen = fails(|| compare::between("wavelets-planted", maps.caustics, &other));
        assert!(seen, "a tenth more slope is not seen");
        let all: f64 = maps.caustics.data.iter().map(|c| f64::from(*c) - 1.0).sum();
        assert!(all.abs() < 2.0e-3 * maps.caustics.data.len() as f64, "{all} lost or won");
    }
}

/// Water in the shadow of the host's scene refracts no sunlight. The result lies within the twin's
/// bounds with the shadow map; if the map shades everything, only light beside the water remains.
#[test]
fn water_in_the_scenes_shade_bends_no_light() {
    let gpu = Gpu::shared();
    let config = casting(64).with(|it| it.shadow = Some(Shadows::Map));
    let mut rig = Rig::lit(&gpu, &config, 1);
    let sun = toward(-0.6, 0.7, 0.3);
    let mut case = pool(sun, 0.1, 0);
    let at = Vec3::new(0.0, -0.1, 0.0);
    let direction = Vec3::from(sun);
    for (name, view_projection, reversed) in light_views(direction, at) {
        let depth = |along: f32| view_projection.project_point3(at + along * direction).z;
        let (before, behind) = (depth(0.8), depth(-0.8));
        // Blocks of shade and of sun, then shade everywhere.
        for all in [false, true] {
            let texels = Image::from_fn(16, 16, |x, y| {
                if all || (x / 4 + y / 4) % 2 == 0 { before } else { behind }
            });
            let image = shadows(&rig, Shadows::Map, &texels);
            let host = image.host_image();
            case.shot.shadow = Some(
                Shadow::new(host, view_projection.to_cols_array_2d()).with(|it| it.bias = 0.05),
            );
            let map = ShadowMap {
                depth: &texels,
                view_projection: view_projection.as_dmat4(),
                bias: f64::from(0.05_f32),
                sun: direction.as_dvec3(),
                reversed,
            };
            let drawn = case.draw(&mut rig);
            let (light, maps) = (twin(&case.shot, &config), maps(&drawn));
            let (bounds, _) = light.caustics(&maps, &|p, by| map.past(p, by));
            compare::between(&format!("caustics-{name}-{all}"), maps.caustics, &bounds);
            let wet = || maps.front.data.iter().map(|d| f64::from(*d)).zip(&maps.caustics.data);
            let light_of = |wet: &mut dyn Iterator<Item = f32>| wet.fold(0.0_f32, f32::max);
            let most = light_of(&mut wet().filter(|(d, _)| is_surface(*d)).map(|(_, c)| *c));
            // The map does not cover the whole pool.
            assert!(all || most > 1.0, "{name}: {most}, idle");
            let shaded = landed(&light, &maps, &map);
            assert!(shaded > 0, "{name}: nothing is in the shade");
        }
    }
}

/// Number of texels of water that lie in the map's shade.
fn landed(light: &Light, maps: &Maps<'_>, map: &ShadowMap<'_>) -> usize {
    let landings = light.landings(maps);
    let n = light.texels;
    let shaded = |(i, landing): (usize, &Option<[Rounded; 2]>)| {
        let depth = f64::from(maps.front.at(i % n, i / n));
        let middle = DVec2::new((i % n) as f64, (i / n) as f64) + 0.5;
        landing.is_some() && map.past(light.point(middle, depth), 0.0).v == 0.0
    };
    landings.data.iter().enumerate().filter(|of| shaded(*of)).count()
}

/// On a flat pool all texels refract alike, so the light stays uniform.
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
        shot.light_volume = Some(LightVolume { center: [0.0; 3], radius });
        let drawn = water(shot).draw(&mut rig);
        let found = drawn.caustics.expect("caustics");
        for (x, y) in (24..40).flat_map(|y| (24..40).map(move |x| (x, y))) {
            let light = f64::from(found.at(x, y));
            // On a slope all four parts of a texel move alike, with a rounding of 1/4096 each.
            let most = if slope == 0.0 { 32.0 * U } else { 4.0 / 4096.0 };
            assert!((light - 1.0).abs() <= most, "{slope}: {light} at ({x}, {y})");
        }
    }
}
