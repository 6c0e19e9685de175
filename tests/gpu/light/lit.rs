//! The light that the maps transmit reaches the scene behind the water and the highlights on the
//! water.

use glam::{DVec3, Mat4, Vec3};
use whitewater::water::{Medium, Shading, Shadows};
use whitewater::{Camera, Config, LightVolume, Shadow};

use crate::reference::Image;
use crate::reference::light::{ShadowMap, lit};
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config};
use crate::support::rounded::{Rounded, exact};
use crate::support::scenes::{self, Lens, Random};
use crate::support::tolerance::U;
use crate::surface_foam::Foamy;

use super::shade::{light_views, shadows};
use super::{SIZE, casting, even, halves, maps, pool, toward, twin, water};

/// Particles at heights of 0.8 to 1.2 over a tilted ground that is at `height` in the middle.
pub fn grounded(lens: Lens, height: f64) -> Foamy {
    let mut shot = Shot::new(SIZE, lens, 0.06, &[]);
    let mut random = Random(8);
    shot.positions = (0..90)
        .map(|_| {
            let mut at = |middle: f32, by: f32| middle + random.between(-by, by);
            [at(3.1, 0.6), at(1.0, 0.2), at(0.2, 0.6)]
        })
        .collect();
    let view = shot.view(SIZE);
    let back = view.view.inverse();
    let (eye, n) = (back.w_axis.truncate(), DVec3::new(0.1, 1.0, 0.05).normalize());
    shot.scene_depth(|x, y| {
        let along = back.transform_vector3(view.ray(x as usize, y as usize));
        let depth = n.dot(DVec3::new(3.1, height, 0.2) - eye) / n.dot(along);
        (depth > 0.0 && depth < 60.0).then_some(depth)
    });
    shot.settings.surface_foam.shadow = 8.0;
    // These colours are not exact in half precision.
    shot.color.iter_mut().for_each(|c| *c = c.map(|v| v * 1.0309));
    shot.light_volume = Some(LightVolume { center: [2.9, 0.7, 0.1], radius: 1.3 });
    let mut case = water(shot);
    for amount in case.amounts.iter_mut().step_by(3) {
        amount[0] = random.between(0.0, 1.0);
    }
    case
}

/// The scene's position in a pixel, and its error in metres: from the depth's quotient, whose
/// divisor is a difference, and from the transform to the world.
pub fn seen(shot: &Shot, depth: f64, (x, y): (usize, usize)) -> (DVec3, f64) {
    let view = shot.view(SIZE);
    let back = view.view.inverse();
    let p = back.transform_point3(view.ray(x, y) * depth);
    let eye = back.w_axis.truncate().length();
    (p, U * (8.0 * depth + 2.0 * depth * depth / view.near() + 24.0 * (p.length() + 2.0 * eye)))
}

/// A floor under a deep pool with waves, which focus light on it. The eye is below the water, so that
/// the floor shows.
fn focused(sun: [f32; 3], wave: f32) -> Foamy {
    let mut case = pool(sun, wave, 0);
    let shot = &mut case.shot;
    let lower: Vec<_> = shot.positions.iter().map(|[x, y, z]| [*x, y - 0.4, *z]).collect();
    shot.positions.extend(lower);
    shot.light_volume = Some(LightVolume { center: [0.0, -0.3, 0.0], radius: 2.0 });
    let (eye, forward) = (Vec3::new(0.9, -1.1, 0.0), Vec3::new(-1.0, -0.35, 0.0));
    let view = Mat4::look_to_rh(eye, forward.normalize(), Vec3::Y);
    shot.camera = Camera::of(view, scenes::projection(Lens::Standard, SIZE));
    let twin = shot.view(SIZE);
    let back = twin.view.inverse();
    shot.scene_depth(|x, y| {
        let along = back.transform_vector3(twin.ray(x as usize, y as usize));
        let depth = (-1.5 - f64::from(eye.y)) / along.y;
        (depth > 0.0 && depth < 60.0).then_some(depth)
    });
    water(case.shot)
}

/// Checks that pixels without water, foam and spray are the scene in the light of the maps, to half
/// precision. Returns the number of values that are lighter than the scene.
pub fn check_lit(
    name: &str,
    case: &Foamy,
    config: &Config,
    drawn: &Drawn,
    past: &Past<'_>,
) -> usize {
    let (shot, light, maps) = (&case.shot, twin(&case.shot, config), maps(drawn));
    let scene = shot.scene_eye();
    let foam = drawn.foam.as_ref().map(|foam| foam.seen(shot));
    let whitewater = drawn.whitewater.as_ref().map(|whitewater| &whitewater.occluders);
    let sun = &shot.settings.light;
    let (mut outside, mut darker, mut lighter, mut wrong) = (0, 0, 0, String::new());
    for (i, found) in drawn.output.data.iter().enumerate() {
        let (x, y) = (i % drawn.output.width, i / drawn.output.width);
        let foamy = foam.as_ref().is_some_and(|seen| seen.data[i].0 < 1e9)
            || whitewater.is_some_and(|seen| seen.data[i][0] < 1e9);
        if drawn.depth.data[i] < 1e9 || foamy {
            continue;
        }
        let color = shot.color[i];
        let (p, by) = seen(shot, scene.data[i].min(1e6), (x, y));
        let (through, gain) = match scene.data[i] {
            depth if depth < 99.0 => light.at(&maps, p, by),
            _ => ([exact(1.0); 3], exact(1.0)),
        };
        if through.iter().chain([&gain]).all(|v| v.v == 1.0 && v.e == 0.0) {
            outside += 1;
            if color.iter().zip(found).any(|(c, found)| !is_half(*c, *found)) {
                wrong += &format!("({x}, {y}) outside: {found:?}, not {color:?}\n");
            }
            continue;
        }
        for c in 0..3 {
            let shade = f64::from(sun.shade[c]) / f64::from(sun.irradiance[c]);
            let past = past(p, by, (x, y));
            let end = lit(f64::from(color[c]), shade, past, through[c], gain);
            let v = f64::from(found[c]);
            let [low, high] = halves(end.v - end.e, end.v + end.e);
            darker += usize::from(v < 0.97 * f64::from(color[c]));
            lighter += usize::from(v > 1.01 * f64::from(color[c]));
            if v < low || v > high {
                wrong += &format!("({x}, {y}) {c}: {v}, not {end:?}\n");
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{name}: {} lines\n{}",
        wrong.lines().count(),
        &wrong[..wrong.len().min(900)]
    );
    assert!(
        outside > 500 && darker >= 10,
        "{name}: {outside} outside, {darker} darker, {lighter} lighter"
    );
    lighter
}

/// Whether a value in half precision is the rounded scene colour.
fn is_half(scene: f32, found: f32) -> bool {
    halves(f64::from(scene), f64::from(scene)).contains(&f64::from(found))
}

/// If nothing casts a shadow in the maps, the light is a mean of ones with rounded weights.
pub fn is_nearly_half(scene: f32, found: f32) -> bool {
    let scene = f64::from(scene);
    let [low, high] = halves(scene * (1.0 - 16.0 * U), scene * (1.0 + 16.0 * U));
    (low..=high).contains(&f64::from(found))
}

/// Fraction of sunlight that the host's scene lets through, at a point and in a pixel.
type Past<'a> = dyn Fn(DVec3, f64, (usize, usize)) -> Rounded + 'a;

#[test]
fn the_lit_scene_is_what_the_maps_say() {
    let gpu = Gpu::shared();
    for shading in [Shading::Raster, Shading::Compute] {
        for in_place in [true, false] {
            // At thickness level 0 no foam shows beside its sprites.
            let config = casting(64).with(|it| {
                it.composite = Some(shading);
                it.in_place = in_place;
                it.thickness_level = 0;
            });
            let mut rig = Rig::lit(&gpu, &config, 1);
            for (lens, height) in [
                (Lens::Standard, 0.4),
                (Lens::OffAxis, 0.4),
                (Lens::LeftHanded, 0.4),
                // The visible ground lies among the particles that cast shadows.
                (Lens::Standard, 1.0),
                (Lens::Infinite, 0.9),
            ] {
                let mut case = grounded(lens, height);
                // With this strong shade the ambient part shows, and differently in each channel.
                case.shot.settings.light.shade = [0.0, 0.875, 5.0];
                if lens == Lens::OffAxis {
                    case.shot.settings.water.medium = Medium::source(0.1);
                }
                let drawn = case.draw(&mut rig);
                let name = format!("lit-{shading:?}-{in_place}-{lens:?}-{height}");
                check_lit(&name, &case, &config, &drawn, &|_, _, _| exact(1.0));
            }
            // Without particles nothing casts a shadow: the scene is unchanged, to half precision.
            let mut none = grounded(Lens::Standard, 0.4);
            (none.shot.positions, none.amounts, none.velocities) = Default::default();
            let drawn = none.draw(&mut rig);
            for (found, scene) in drawn.output.data.iter().zip(&none.shot.color) {
                let near = scene.iter().zip(found).all(|(c, found)| is_nearly_half(*c, *found));
                assert!(near, "{found:?}, not {scene:?}");
            }
        }
    }
}

/// Waves focus light on a floor as the maps say, at most threefold, and less the farther the floor is
/// behind them.
#[test]
fn focused_light_is_what_the_maps_say() {
    let gpu = Gpu::shared();
    for shading in [Shading::Raster, Shading::Compute] {
        let config = casting(128).with(|it| it.composite = Some(shading));
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut all = 0;
        for (sun, wave) in [([0.0, 1.0, 0.0], 0.2), (toward(0.3, 0.9, 0.1), 0.24)] {
            let mut case = focused(sun, wave);
            case.shot.settings.light.shade = [0.0, 0.875, 5.0];
            let drawn = case.draw(&mut rig);
            let name = format!("focused-{shading:?}-{wave}");
            let lighter = check_lit(&name, &case, &config, &drawn, &|_, _, _| exact(1.0));
            let (light, maps, scene) =
                (twin(&case.shot, &config), maps(&drawn), case.shot.scene_eye());
            let gathered = (0..scene.data.len()).filter(|i| {
                let (x, y) = (i % scene.width, i / scene.width);
                let depth = scene.data[*i];
                if depth > 99.0 || drawn.depth.data[*i] < 1e9 {
                    return false;
                }
                let at = light.place(seen(&case.shot, depth, (x, y)).0).0 - 0.5;
                let around =
                    |k: isize| maps.caustics.clamped(at.x as isize + k % 2, at.y as isize + k / 2);
                (0..4).all(|k| around(k) > 3.0)
            });
            let gathered = gathered.count();
            let most = maps.caustics.data.iter().fold(0.0_f32, |a, c| a.max(*c));
            println!("{name}: {lighter} values are lighter, {gathered} pixels at the most, {most}");
            assert!(lighter > 200, "{name}: {lighter}");
            all += gathered;
        }
        assert!(all > 20, "{shading:?}: the light of {all} pixels is limited");
    }
}

/// A mask and a map of the host combined with the water's shadow: what is already in the scene's
/// shadow does not get darker.
#[test]
fn the_lit_scene_is_past_the_scene() {
    let gpu = Gpu::shared();
    for kind in [Shadows::Mask, Shadows::Map] {
        let config = casting(64).with(|it| it.shadow = Some(kind));
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut case = grounded(Lens::Reversed, 0.4);
        case.shot.settings.light.shade = [0.0, 0.875, 5.0];
        let sun = Vec3::from(case.shot.settings.light.direction);
        let (name, view_projection, reversed) = light_views(sun, Vec3::new(2.7, 0.4, 0.0))[1];
        let texels = Image::from_fn(8, 8, |x, y| ((x * 5 + y * 3) % 7) as f32 / 6.0);
        let image = shadows(&rig, kind, &texels);
        let bias = 0.05;
        case.shot.shadow = Some(
            Shadow::new(image.host_image(), view_projection.to_cols_array_2d())
                .with(|it| it.bias = bias),
        );
        let drawn = case.draw(&mut rig);
        let map = ShadowMap {
            depth: &texels,
            view_projection: view_projection.as_dmat4(),
            bias: f64::from(bias),
            sun: sun.as_dvec3(),
            reversed,
        };
        let past = |p: DVec3, by: f64, (x, y): (usize, usize)| match kind {
            Shadows::Mask => {
                exact(f64::from(texels.at((2 * x + 1) * 8 / 194, (2 * y + 1) * 8 / 122)))
            }
            Shadows::Map | Shadows::Convolution(_) => map.past(p, by),
        };
        check_lit(&format!("lit-{kind:?}-{name}"), &case, &config, &drawn, &past);
    }
}

/// Where no sun reaches the water, it has no highlight and foam has no relief.
#[test]
fn highlights_and_relief_are_the_suns() {
    let gpu = Gpu::shared();
    let config = config(SIZE).with(|it| {
        it.shadow = Some(Shadows::Mask);
        it.surface_foam = true;
        it.sheets = 2;
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut case = Foamy::new(SIZE, Lens::Standard, 0.0);
    // A pane of water behind everything, so that the back sheet has highlights too.
    let pane = scenes::block(3, 0.3, [40, 28, 3], [-6.0, -4.2, 12.0]);
    case.shot.positions.extend(scenes::world(&case.shot.camera, &pane));
    case.amounts.resize(case.shot.positions.len(), [0.0; 2]);
    case.velocities.resize(case.shot.positions.len(), [0.0; 3]);
    case.ids = None;
    case.amounts.iter_mut().step_by(2).for_each(|amount| amount[0] = 0.0);
    let view = case.shot.camera_view().inverse();
    // The sun is behind the eye, so that spheres have their highlight in the middle.
    let sun = view.transform_vector3(DVec3::new(0.1, 0.2, 1.0)).normalize();
    case.shot.settings.light.direction = sun.as_vec3().to_array();
    for (lit, seen) in [(1.0, true), (0.0, false)] {
        let (_texture, shadow) = even(&rig, lit);
        case.shot.shadow = Some(shadow);
        let mut drawn = |specular: f32, relief: f32| {
            case.shot.settings.water.specular = specular;
            case.shot.settings.surface_foam.normal_strength = relief;
            case.draw(&mut rig).output.data
        };
        let [plain, shining, raised] = [drawn(0.0, 0.0), drawn(1.0, 0.0), drawn(0.0, 0.6)];
        assert_eq!(plain != shining, seen, "highlights, sun {lit}");
        assert_eq!(plain != raised, seen, "relief, sun {lit}");
    }
}

/// A back sheet seen through a front sheet has a highlight of its own, where the sun reaches it.
#[test]
fn back_sheets_have_highlights_in_the_sun() {
    let gpu = Gpu::shared();
    // The front sheet leans so far that it mirrors the sun elsewhere.
    let (sin, cos) = 25.0_f32.to_radians().sin_cos();
    let mut points = scenes::block(3, 0.3, [28, 22, 2], [-4.2, -3.3, 0.0]);
    points
        .iter_mut()
        .for_each(|[x, _, z]| (*x, *z) = (*x * cos - *z * sin, 5.0 + *x * sin + *z * cos));
    points.extend(scenes::block(3, 0.3, [40, 28, 2], [-6.0, -4.2, 12.0]));
    let mut shot = Shot::new(SIZE, Lens::Standard, 0.2, &points);
    let sun = shot.camera_view().inverse().transform_vector3(DVec3::new(0.1, 0.2, 1.0));
    shot.settings.light.direction = sun.normalize().as_vec3().to_array();
    let mut shining = |sheets: u32, sun: f32| {
        let config = config(SIZE).with(|it| {
            it.shadow = Some(Shadows::Mask);
            it.sheets = sheets;
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let (_texture, shadow) = even(&rig, sun);
        shot.shadow = Some(shadow);
        let [dull, bright] = [0.0, 1.0].map(|specular| {
            shot.settings.water.specular = specular;
            rig.draw(&shot)
        });
        let both = dull.output.data.iter().zip(&bright.output.data).zip(&dull.depth.data);
        // Pixels of the front sheet; the pane behind is at 12.
        both.filter(|((a, b), z)| **z < 8.0 && b[0] > a[0] + 0.01).count()
    };
    let [front, both, dark] = [(1, 1.0), (2, 1.0), (2, 0.0)].map(|(n, sun)| shining(n, sun));
    println!("{front} pixels shine with one sheet, {both} with two, {dark} without a sun");
    assert!(both > front + 20 && dark == 0, "{front}, {both}, {dark}");
}
