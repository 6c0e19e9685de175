//! Small waves on level water, in the picture and in the caustics, compared with the CPU twin.

use glam::DVec3;
use whitewater::water::{Fresnel, Medium, Wavelets};

use crate::composite::{SKY, Sky, twin_settings};
use crate::harness::fails;
use crate::reduce::wide;
use crate::reference::composite::{Inputs, mirrored};
use crate::reference::surface::Surfaces;
use crate::reference::wavelets::Waves;
use crate::reference::{Image, is_surface};
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens};

const SLOPE: f32 = 0.08;
const LENGTH: f32 = 1.1;
const TIME: f64 = 3.7;

/// A block of water over a black bed, whose up vector points at the eye. The water mirrors all
/// light.
fn pool(lens: Lens) -> Shot {
    let size = extent(97, 61);
    let points = scenes::block(3, 0.25, [20, 14, 4], [-2.4, -1.6, 4.0]);
    let mut shot = Shot::new(size, lens, 0.2, &points);
    shot.scene_depth(|_, _| Some(4.9));
    shot.color.fill([0.0, 0.0, 0.0, 1.0]);
    let up = shot.view(size).view.inverse().transform_vector3(DVec3::Z);
    shot.settings.up = up.as_vec3().to_array();
    let water = &mut shot.settings.water;
    water.specular = 0.0;
    water.fresnel = Fresnel::Source { bias: 1.0, scale: 0.0, power: 1.0 };
    water.medium = Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] };
    water.wavelets = Wavelets::default();
    water.wavelets.slope = SLOPE;
    water.wavelets.length = LENGTH;
    water.wavelets.time = TIME;
    shot
}

fn waves(shot: &Shot) -> Waves {
    let up = DVec3::from(shot.settings.up.map(f64::from));
    Waves::new(f64::from(SLOPE), f64::from(LENGTH), (TIME, 9.81), up)
}

/// Checks that the picture mirrors the sky by the twin's waves. Returns the number of compared
/// pixels, and the mean change of the mirrored radiance by the waves.
fn check(rig: &Rig<'_>, shot: &Shot, drawn: &Drawn, waves: &Waves) -> (usize, f64) {
    let (size, level) = (rig.config.extent, rig.config.smoothing_level);
    let view = shot.view(size);
    let settings = twin_settings(shot, &view);
    let color = Image::new(size.width as usize, size.height as usize, [0.0; 4]);
    let (depth, smoothed) = (wide(&drawn.depth), wide(&drawn.surface));
    let (thickness, scene) = (drawn.thickness.map(|t| f64::from(*t)), shot.scene_eye());
    let inputs = Inputs {
        depth: &depth,
        smoothed: &smoothed,
        level,
        thickness: &thickness,
        thickness_level: rig.config.thickness_level,
        scene_color: &color,
        scene_depth: &scene,
        noise: None,
    };
    let surfaces = Surfaces::new(&inputs, &settings, &view);
    let to_world = view.view.inverse();
    let spacing = f64::from(shot.settings.water.spacing);
    let (mut count, mut moved) = (0, 0.0);
    for (x, y) in (0..color.height).flat_map(|y| (0..color.width).map(move |x| (x, y))) {
        if !is_surface(depth.at(x, y)) {
            continue;
        }
        let still = surfaces.at(x, y).expect("a surface");
        // Only pixels inside the block with its full thickness, whose normal comes from the
        // smoothed surface alone.
        if still.parts.found < 1.0 || still.parts.drop > 0.0 || still.thickness < 2.5 * spacing {
            continue;
        }
        let (n, p) = (still.normal, still.position);
        let facing = (-n.dot(p.normalize())).max(0.05);
        let pixel = (view.slope_step().y * p.z).abs() / facing;
        let normal = to_world.transform_vector3(n);
        let place = to_world.transform_point3(p);
        let turned = waves.turn(normal, place, pixel, still.thickness / spacing);
        let mut surface = still;
        surface.normal = view.view.transform_vector3(turned);
        let [seen, unmoved] =
            [&surface, &still].map(|surface| Sky::Slope.radiance(mirrored(surface, &view)));
        // The mirrored direction turns by twice the normal's angle, and the radiance changes by
        // 0.25 per unit; the cube's error is added.
        let bound = 0.25 * 2.0 * (waves.error(place) + 1.0e-5) + 2.0 * Sky::Slope.error(8);
        for i in 0..3 {
            let found = f64::from(drawn.output.at(x, y)[i]);
            assert!((found - seen[i]).abs() <= bound, "({x}, {y}): {found}, not {}", seen[i]);
        }
        count += 1;
        moved += (seen - unmoved).length();
    }
    (count, moved / count as f64)
}

#[test]
fn level_water_mirrors_by_the_twins_waves() {
    let gpu = Gpu::shared();
    let config = config(extent(97, 61)).with(|it| it.environment_size = 64);
    let mut rig = Rig::new(&gpu, &config);
    rig.environment(extent(SKY.0, SKY.1), &Sky::Slope.texels());
    for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
        let shot = pool(lens);
        let drawn = rig.draw(&shot);
        let (count, moved) = check(&rig, &shot, &drawn, &waves(&shot));
        assert!(count > 500 && moved > 0.01, "{lens:?}: {count} pixels, moved by {moved}");
        // Waves at another time, of another slope, and none.
        let up = DVec3::from(shot.settings.up.map(f64::from));
        let (slope, length) = (f64::from(SLOPE), f64::from(LENGTH));
        for other in [
            Waves::new(slope, length, (TIME + 0.02, 9.81), up),
            Waves::new(1.05 * slope, length, (TIME, 9.81), up),
            Waves::new(0.0, length, (TIME, 9.81), up),
        ] {
            assert!(
                fails(|| {
                    check(&rig, &shot, &drawn, &other);
                }),
                "{lens:?}: not seen"
            );
        }
    }
}

/// Steep water, thin water and waves of slope 0 give the same bits as without waves.
#[test]
fn only_level_water_has_waves() {
    let gpu = Gpu::shared();
    let config = config(extent(97, 61));
    let mut rig = Rig::new(&gpu, &config);
    let mut shot = pool(Lens::Standard);
    // The visible face is vertical.
    let up = shot.view(shot.size).view.inverse().transform_vector3(DVec3::Y);
    shot.settings.up = up.as_vec3().to_array();
    // Only its upper edge can have waves.
    let mut still = shot.clone();
    still.settings.water.wavelets.slope = 0.0;
    let [with, without] = [&shot, &still].map(|shot| rig.draw(shot));
    let changed = with.output.data.iter().zip(&without.output.data).filter(|(a, b)| a != b).count();
    let wet = with.depth.data.iter().filter(|z| is_surface(f64::from(**z))).count();
    assert!(wet > 1500 && changed * 10 < wet, "{changed} of {wet} pixels changed");
    let mut level = pool(Lens::Standard);
    level.settings.water.wavelets.slope = 0.0;
    let still = rig.draw(&level);
    level.settings.water.wavelets.time = 100.0;
    assert_eq!(still.output.data, rig.draw(&level).output.data, "waves of no slope");
}
