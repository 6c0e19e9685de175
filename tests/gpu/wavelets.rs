//! Small waves on level water, in the picture and in the caustics, compared with the CPU twin.

use glam::DVec3;
use whitewater::water::{Fresnel, Medium, Wavelets};

use crate::composite::{Layers, SKY, Sky, twin_settings};
use crate::harness::fails;
use crate::reference::composite::mirrored;
use crate::reference::surface::{Surface, Surfaces};
use crate::reference::wavelets::Waves;
use crate::reference::{Image, is_surface, smoothstep};
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens};
use crate::support::tolerance::U;

const SLOPE: f32 = 0.08;
const LENGTH: f32 = 1.1;
const TIME: f64 = 3.7;
/// Not the default, as in a scene whose unit is 0.1 m.
const GRAVITY: f32 = 98.1;

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
    water.wavelets.gravity = GRAVITY;
    shot
}

/// Turns the up vector away from the eye by this angle in degrees.
fn tilt(shot: &mut Shot, angle: f64) {
    let (sin, cos) = angle.to_radians().sin_cos();
    let up = shot.view(shot.size).view.inverse().transform_vector3(DVec3::new(0.0, sin, cos));
    shot.settings.up = up.as_vec3().to_array();
}

/// Lets the bed rise into the water, so that this becomes a wedge from 0 to about 3 spacings.
fn wedge(shot: &mut Shot) {
    shot.scene_depth(|x, _| Some(3.7 + 0.012 * f64::from(x)));
}

fn waves(shot: &Shot) -> Waves {
    let up = DVec3::from(shot.settings.up.map(f64::from));
    Waves::new(f64::from(SLOPE), f64::from(LENGTH), (TIME, f64::from(GRAVITY)), up)
}

/// The water without waves by the twin, where it has a depth.
fn still(rig: &Rig<'_>, shot: &Shot, drawn: &Drawn) -> Image<Option<Surface>> {
    let (size, level) = (rig.config.extent, rig.config.smoothing_level);
    let view = shot.view(size);
    let settings = twin_settings(shot, &view);
    let layers = Layers::new(drawn, shot);
    let inputs = layers.inputs(level, rig.config.thickness_level);
    let surfaces = Surfaces::new(&inputs, &settings, &view);
    Image::from_fn(layers.depth.width, layers.depth.height, |x, y| {
        is_surface(layers.depth.at(x, y)).then(|| surfaces.at(x, y).expect("a surface"))
    })
}

/// Checks that the picture mirrors the sky by the twin's waves. Returns the number of compared
/// pixels, and the mean change of the mirrored radiance by the waves.
fn check(rig: &Rig<'_>, shot: &Shot, drawn: &Drawn, waves: &Waves) -> (usize, f64) {
    let (view, surfaces) = (shot.view(shot.size), still(rig, shot, drawn));
    let to_world = view.view.inverse();
    let spacing = f64::from(shot.settings.water.spacing);
    let (mut count, mut moved) = (0, 0.0);
    for (i, still) in surfaces.data.iter().enumerate() {
        let (x, y) = (i % surfaces.width, i / surfaces.width);
        // Only pixels inside the block, whose normal comes from the smoothed surface alone, and
        // whose reflection is whole.
        let Some(still) = still.filter(|it| {
            it.parts.found == 1.0 && it.parts.drop == 0.0 && it.thickness > 0.5 * spacing
        }) else {
            continue;
        };
        let (n, p) = (still.normal, still.position);
        let facing = (-n.dot(p.normalize())).max(0.05);
        let pixel = (view.slope_step().y * p.z).abs() / facing;
        let normal = to_world.transform_vector3(n);
        let place = to_world.transform_point3(p);
        let turned = waves.turn(normal, place, pixel, still.thickness / spacing);
        let mut surface = still;
        surface.normal = view.view.transform_vector3(turned);
        // A mirrored ray that points below the horizon finds water, and the bed is black.
        let open = |to: DVec3| smoothstep(-0.3, 0.0, to.dot(waves.up()));
        let [seen, unmoved] = [&surface, &still].map(|surface| {
            let to = mirrored(surface, &view);
            open(to) * Sky::Slope.radiance(to)
        });
        // Thickness and normal decide on the share of the waves, with smoothsteps over a spacing
        // and over half a unit, whose slopes are 1.5 and 3. The scene's depth is a quotient whose
        // divisor is a difference.
        let (z, slope) = (-p.z, waves.slope(place, pixel).length());
        let thick = U * (16.0 * z + 4.0 * z * z / view.near());
        let share = slope * (1.5 * thick / spacing + 3.0 * 1.0e-5);
        // The mirrored direction turns by twice the normal's angle, and the radiance changes by
        // 0.25 per unit; the cube's error is added. Near the horizon the radiance, at most 0.75,
        // fades by a smoothstep of slope 5.
        let shown = open(mirrored(&surface, &view));
        let steep = if shown < 1.0 { 0.25 + 5.0 * 0.75 } else { 0.25 };
        let bound = steep * 2.0 * (waves.error(place) + share + 1.0e-5) + 2.0 * Sky::Slope.error(8);
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
        let gravity = f64::from(GRAVITY);
        for other in [
            Waves::new(slope, length, (TIME + 0.006, gravity), up),
            Waves::new(1.05 * slope, length, (TIME, gravity), up),
            Waves::new(0.0, length, (TIME, gravity), up),
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

/// The steeper the water, and the thinner, the fewer waves it has.
#[test]
fn steep_and_thin_water_has_the_twins_share_of_waves() {
    let gpu = Gpu::shared();
    let config = config(extent(97, 61)).with(|it| it.environment_size = 64);
    let mut rig = Rig::new(&gpu, &config);
    rig.environment(extent(SKY.0, SKY.1), &Sky::Slope.texels());
    for (angle, thin) in [(45.0, false), (60.0, false), (72.0, false), (80.0, false), (0.0, true)] {
        let mut shot = pool(Lens::Standard);
        tilt(&mut shot, angle);
        if thin {
            wedge(&mut shot);
        }
        let drawn = rig.draw(&shot);
        let (count, moved) = check(&rig, &shot, &drawn, &waves(&shot));
        let surfaces = still(&rig, &shot, &drawn);
        let spacing = f64::from(shot.settings.water.spacing);
        let ramp = surfaces.data.iter().flatten().filter(|it| {
            let up = shot.view(shot.size).view.transform_vector3(waves(&shot).up());
            let (level, thick) = (it.normal.dot(up), it.thickness / spacing);
            thick > 1.05 && level > 0.22 && (thick < 1.95 || level < 0.68)
        });
        let ramp = ramp.count();
        println!("{angle}, thin {thin}: {count} pixels, {ramp} of the ramp, moved by {moved}");
        assert!(count > 500, "{angle}, thin {thin}: {count} pixels");
        assert!(ramp > 150 || angle == 80.0, "{angle}, thin {thin}: {ramp} pixels");
    }
}

/// Steep water, thin water and waves of slope 0 give the same bits as without waves.
#[test]
fn only_level_water_has_waves() {
    let gpu = Gpu::shared();
    let config = config(extent(97, 61)).with(|it| it.environment_size = 64);
    let mut rig = Rig::new(&gpu, &config);
    rig.environment(extent(SKY.0, SKY.1), &Sky::Slope.texels());
    for thin in [false, true] {
        let mut shot = pool(Lens::Standard);
        if thin {
            wedge(&mut shot);
        } else {
            // The visible face is vertical.
            tilt(&mut shot, 90.0);
        }
        let mut calm = shot.clone();
        calm.settings.water.wavelets.slope = 0.0;
        let [with, without] = [&shot, &calm].map(|shot| rig.draw(shot));
        let surfaces = still(&rig, &shot, &with);
        let up = shot.view(shot.size).view.transform_vector3(waves(&shot).up());
        let least = f64::from(shot.settings.water.spacing);
        let (mut none, mut changed) = (0, 0);
        for (i, surface) in surfaces.data.iter().enumerate() {
            let Some(surface) = surface else { continue };
            let differs = with.output.data[i] != without.output.data[i];
            // Rounding changes neither number by a hundredth.
            if surface.normal.dot(up) < 0.19 || surface.thickness < 0.99 * least {
                assert!(!differs, "thin {thin}, {i}: {surface:?}");
                none += 1;
            }
            changed += usize::from(differs);
        }
        println!("thin {thin}: {none} pixels without waves, {changed} with");
        // Only the upper edge of the vertical face can have waves.
        assert!(none > if thin { 400 } else { 1500 }, "thin {thin}: {none} pixels without waves");
        assert!(if thin { changed > 400 } else { changed * 10 < none }, "thin {thin}: {changed}");
    }
    let mut level = pool(Lens::Standard);
    level.settings.water.wavelets.slope = 0.0;
    let calm = rig.draw(&level);
    level.settings.water.wavelets.time = 100.0;
    assert_eq!(calm.output.data, rig.draw(&level).output.data, "waves of no slope");
}
