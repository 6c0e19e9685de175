//! Compares the picture with surface foam with one computed from its layers.

use glam::{DVec2, DVec3};
use whitewater::Config;
use whitewater::water::{DebugView, Fresnel, Medium, Shading};

use super::{Foamy, foaming, of};
use crate::reference::surface_foam::{self, Pattern, Phase};
use crate::reference::{is_surface, smoothstep};
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, extent};
use crate::support::scenes::{self, Lens};
use crate::support::tolerance::U;

/// All layers at full resolution, and an output of 32-bit floats.
pub(super) fn whole(size: ash::vk::Extent2D, shading: Shading) -> Config {
    foaming(size).with(|it| {
        it.composite = Some(shading);
        it.output_format = ash::vk::Format::R32G32B32A32_SFLOAT;
        it.thickness_level = 0;
        it.smoothing_level = 0;
        it.coarsening = 0;
    })
}

/// Opaque foam in front of water has its own colour, whatever lies behind it. Foam alone covers the
/// scene by Beer's law. Both kinds of shading agree.
#[test]
fn foam_covers_what_is_behind_it() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for shading in [Shading::Raster, Shading::Compute] {
        let mut rig = Rig::lit(&gpu, &whole(size, shading), 1);
        let mut case = Foamy::new(size, Lens::Standard, 10.0);
        // A single foam particle before the eye, without other water.
        case.shot.positions = scenes::world(&case.shot.camera, &[[0.0, 0.0, 2.0]]);
        case.amounts = vec![[1.0, 0.0]];
        case.velocities = vec![[0.0; 3]];
        case.ids = None;
        let look = &mut case.shot.settings.surface_foam;
        (look.noise, look.pattern, look.normal_strength, look.min_thickness) =
            (0.0, 0.0, 0.0, 0.05);
        (look.extinction, look.front_extinction) = (3.0, 5.0);
        (look.back_color, look.front_color) = ([0.2, 0.4, 0.6], [0.9, 0.8, 0.7]);
        case.shot.settings.light.irradiance = [std::f32::consts::PI; 3];
        let drawn = case.draw(&mut rig);
        let found = of(&drawn);
        let mut seen = 0;
        for (i, [r, g, b, _]) in drawn.output.data.iter().enumerate() {
            let scene = case.shot.color[i];
            if found.depth.data[i] >= 1e9 {
                assert_eq!([*r, *g, *b], [scene[0], scene[1], scene[2]], "beside the foam");
                continue;
            }
            let [t, front] = found.thickness.data[i].map(f64::from);
            seen += usize::from(t > 0.01);
            let whole = smoothstep(0.0, f64::from(0.05_f32), t);
            let long = case.shot.view(size).ray(i % 97, i / 97).length();
            let (kept, back) = ((-3.0 * t * long * whole).exp(), (-5.0 * front * long).exp());
            for (c, found) in [r, g, b].into_iter().enumerate() {
                let (thin, thick) = ([0.2, 0.4, 0.6][c], [0.9, 0.8, 0.7][c]);
                let foam = thick + (thin - thick) * back;
                let expected = foam + (f64::from(scene[c]) - foam) * kept;
                // exp errs by 3 + 2|x| ulp; mixing and light add a few.
                let bound = 40.0 * U * (1.0 + expected);
                assert!((f64::from(*found) - expected).abs() <= bound, "{found} not {expected}");
            }
        }
        assert!(seen > 100, "{seen} pixels with foam");
        // Opaque foam before the whole view hides the scene.
        let mut wall = Foamy::new(size, Lens::Standard, 0.0);
        let block = scenes::block(3, 0.1, [40, 28, 3], [-2.0, -1.4, 2.0]);
        wall.shot.positions = scenes::world(&wall.shot.camera, &block);
        wall.amounts = vec![[1.0, 0.0]; block.len()];
        wall.velocities = vec![[0.0; 3]; block.len()];
        wall.ids = None;
        wall.shot.settings.surface_foam.normal_strength = 0.0;
        wall.shot.settings.surface_foam.extinction = 1.0e4;
        wall.shot.settings.surface_foam.front_extinction = 1.0e5;
        let over = wall.draw(&mut rig);
        wall.shot.color.fill([7.0; 4]);
        let other = wall.draw(&mut rig);
        let centre = 30 * 97 + 48;
        assert_eq!(over.output.data[centre], other.output.data[centre], "the scene shows through");
        let white = f64::from(wall.shot.settings.surface_foam.front_color[0])
            * f64::from(wall.shot.settings.light.irradiance[0])
            / std::f64::consts::PI;
        let found = f64::from(over.output.data[centre][0]);
        assert!((found - white).abs() < 1e-4, "{found} is not the front colour, {white}");
    }
}

/// Lace tears thin foam into threads with clear holes between them. The pattern is fixed to the
/// foam's position in the world and moves with it; aerated water shows in the holes. Where a cell
/// is less than two pixels wide, foam looks as without lace.
#[test]
fn thin_foam_is_torn_into_lace() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for shading in [Shading::Raster, Shading::Compute] {
        let mut rig = Rig::lit(&gpu, &whole(size, shading), 1);
        // Near the eye, a few sprites are wider than two cells of the finest grid of velocities.
        let far = (160, [2.0, 1.4, 2.0, 2.6], 3.0, 50);
        let near = (3, [0.03, 0.03, 0.4, 0.42], 0.5, 10);
        let lenses = [Lens::Standard, Lens::OffAxis, Lens::LeftHanded].map(|lens| (lens, far));
        for (lens, (count, [x, y, low, high], wide, least)) in
            lenses.into_iter().chain([(Lens::Standard, near)])
        {
            let mut case = Foamy::new(size, lens, 0.0);
            let mut random = scenes::Random(7);
            let mut at =
                || [random.between(-x, x), random.between(-y, y), random.between(low, high)];
            let points: Vec<_> = (0..count).map(|_| at()).collect();
            case.shot.positions = scenes::world(&case.shot.camera, &points);
            case.amounts = vec![[1.0, 0.0]; points.len()];
            let spacing = case.shot.settings.water.spacing;
            // The pattern's velocities are whole steps.
            let velocity = [3.0, -1.5, 0.5].map(|v| v * spacing);
            case.velocities = vec![velocity; points.len()];
            case.ids = None;
            let look = &mut case.shot.settings.surface_foam;
            (look.noise, look.pattern, look.normal_strength, look.min_thickness) =
                (0.0, 0.0, 0.0, 0.0);
            (look.extinction, look.front_extinction) = (4.0, 5.0);
            (look.back_color, look.front_color) = ([0.2, 0.4, 0.6], [0.9, 0.8, 0.7]);
            case.shot.settings.light.irradiance = [std::f32::consts::PI; 3];
            let smooth = case.draw(&mut rig);
            case.shot.settings.surface_foam.lace = 0.8;
            case.shot.settings.surface_foam.lace_size = 0.01;
            // The difference of two values, each 1 minus another.
            let fine = case.draw(&mut rig);
            let both = smooth.output.data.iter().flatten().zip(fine.output.data.iter().flatten());
            for (a, b) in both {
                let apart = f64::from(a - b).abs();
                assert!(
                    apart <= 16.0 * U * (1.0 + f64::from(a.abs())),
                    "{a}, with small cells {b}"
                );
            }
            case.shot.settings.surface_foam.lace_size = wide;
            case.shot.settings.surface_foam.aerated_color = [0.1, 0.5, 0.3];
            for aeration in [0.0, 0.6] {
                case.shot.settings.surface_foam.aeration = aeration;
                let drawn = case.draw(&mut rig);
                let (found, view) = (of(&drawn), case.shot.view(size));
                let to_world = view.view.inverse();
                let cell = f64::from(wide * spacing);
                let drift = DVec3::from(velocity.map(f64::from)) / cell;
                let look = &case.shot.settings.surface_foam;
                let (size, period) = (f64::from(look.pattern_size), f64::from(look.pattern_period));
                let phases = Pattern { strength: 0.0, size, period, time: look.time }.phases();
                assert!(phases.iter().all(|phase| phase.part > 0.1 && phase.carried.abs() > 0.05));
                let (mut threads, mut holes, mut offs) = (0, 0, Vec::new());
                for (i, color) in drawn.output.data.iter().enumerate() {
                    let z = f64::from(found.depth.data[i]);
                    if z >= 1e9 {
                        continue;
                    }
                    let [t, front] = found.thickness.data[i].map(f64::from);
                    let ray = view.ray(i % 97, i / 97);
                    let long = ray.length();
                    let hidden = 1.0 - (-4.0 * t * long).exp();
                    let at = to_world.transform_point3(ray * z) / cell;
                    let pixels = cell / (view.slope_step().x * z).abs();
                    let covered = surface_foam::covered(hidden, at, (drift, &phases), pixels);
                    let told = 0.8 * smoothstep(2.0, 6.0, pixels);
                    threads += usize::from(covered > 0.95 && hidden < 0.7);
                    holes += usize::from(covered < 0.05 && hidden > 0.3);
                    let much = 1.0 + told * (covered / hidden.max(0.05) - 1.0);
                    let back = (-5.0 * front * long * much).exp();
                    let seen = hidden + told * (covered - hidden);
                    let origin = to_world.w_axis.truncate().length() / cell;
                    let closed = told * closing_error((at, origin), &phases, pixels);
                    for c in 0..3 {
                        let (thin, thick) = ([0.2, 0.4, 0.6][c], [0.9, 0.8, 0.7][c]);
                        let foam = thick + (thin - thick) * back;
                        let scene = f64::from(case.shot.color[i][c]);
                        // Behind thin foam the water is aerated, in proportion to what smooth foam
                        // would hide.
                        let bubbly = [0.1, 0.5, 0.3][c];
                        let scene = scene + (bubbly - scene) * f64::from(aeration) * hidden;
                        let expected = scene + (foam - scene) * seen;
                        let by_color =
                            (thin - thick).abs() * back * 5.0 * front * long / hidden.max(0.05);
                        let by_share = (scene - foam).abs();
                        let bound =
                            400.0 * U * (1.0 + expected) + closed * (by_share + seen * by_color);
                        let off = (f64::from(color[c]) - expected).abs();
                        assert!(off <= bound, "{lens:?} {i} {c}: {}, not {expected}", color[c]);
                        offs.push(off);
                    }
                }
                // The bound holds for the worst position; most pixels must be much closer.
                let mean = offs.iter().sum::<f64>() / offs.len() as f64;
                assert!(mean < 1.0e-4, "{lens:?}: {mean} in the mean");
                assert!(
                    threads > least && holes > least,
                    "{lens:?}: {threads} in threads, {holes} in holes"
                );
            }
        }
    }
}

/// Bound of the error of a pixel's coverage by lace, from rounding, at a point in cells of the pattern; `origin`: the
/// camera's distance from the world's origin, in cells.
pub fn closing_error((at, origin): (DVec3, f64), phases: &[Phase; 2], pixels: f64) -> f64 {
    // A position errs by 16u of its distance from the origin in cells, and by 5u of the phase's offset. The gradient
    // of `closes` is at most `steepest`, the product of three factors: 2 * 2 r / r^2 for a bubble, the sum of weight /
    // width over the three sizes of bubbles, and 1 + 0.3 * 27 / 2.6 for the displacement by the noise. A smoothstep is
    // at most 1.5 / width steep; here the width is twice `ends`.
    let steepest = 5.8 * (0.42 + 0.34 / 0.4 + 0.24 / 0.16) * (1.0 + 0.3 * 27.0 / 2.6);
    let begun = phases.iter().map(|phase| phase.began).fold(0.0, f64::max);
    let place = U * (16.0 * (at.length() + origin) + 5.0 * (begun + at.length()));
    (place * steepest + 32.0 * U) * 0.75 / surface_foam::ends(pixels)
}

/// Expected amount of lace in pixels of a picture, from the foam's velocity at each pixel: returns how many were
/// compared. `foam` gives the velocity in scene units per second, or `None` where it is not compared.
fn check_lace(
    name: &str,
    case: &Foamy,
    drawn: &Drawn,
    foam: impl Fn(usize, usize) -> Option<DVec3>,
) -> usize {
    let (found, size) = (of(drawn), case.shot.size);
    let view = case.shot.view(size);
    let to_world = view.view.inverse();
    let look = &case.shot.settings.surface_foam;
    let cell = f64::from(look.lace_size * case.shot.settings.water.spacing);
    let (tile, period) = (f64::from(look.pattern_size), f64::from(look.pattern_period));
    let phases = Pattern { strength: 0.0, size: tile, period, time: look.time }.phases();
    let (mut compared, mut moved) = (0, 0);
    for (i, color) in drawn.output.data.iter().enumerate() {
        let (x, y) = (i % size.width as usize, i / size.width as usize);
        let z = f64::from(found.depth.data[i]);
        // A particle with little foam is also drawn as water, in the middle of its foam.
        let alone = z < 1e9 && drawn.depth.data[i] >= 1e9;
        let Some(velocity) = foam(x, y).filter(|_| alone) else { continue };
        let ray = view.ray(x, y);
        let extinction = f64::from(look.extinction);
        let hidden =
            1.0 - (-extinction * f64::from(found.thickness.data[i][0]) * ray.length()).exp();
        let at = to_world.transform_point3(ray * z) / cell;
        let pixels = cell / (view.slope_step().x * z).abs();
        let covered = |velocity: DVec3| {
            let covered = surface_foam::covered(hidden, at, (velocity / cell, &phases), pixels);
            hidden + f64::from(look.lace) * smoothstep(2.0, 6.0, pixels) * (covered - hidden)
        };
        // Holes are darker and threads brighter.
        let light = |velocity: DVec3| {
            let told = f64::from(look.lace) * smoothstep(2.0, 6.0, pixels);
            let pore = told * surface_foam::pore(at, (velocity / cell, &phases), pixels);
            (1.0 - f64::from(look.lace_shade) * pore).clamp(0.5, 1.2)
        };
        // Back and front colour are the same.
        let scene = f64::from(case.shot.color[i][0]);
        let color_of = |velocity| scene + (0.9 * light(velocity) - scene) * covered(velocity);
        let (expected, still) = (color_of(velocity), color_of(DVec3::ZERO));
        let origin = to_world.w_axis.truncate().length() / cell;
        let closing = closing_error((at, origin), &phases, pixels);
        // The smoothstep in `closing` divides by the width of a thread's end.
        let shading = closing * surface_foam::ends(pixels) / 0.75 * f64::from(look.lace_shade);
        let bound = closing * (0.9 * light(velocity) - scene).abs() + 0.9 * shading + 400.0 * U;
        let found = f64::from(color[0]);
        assert!(
            (found - expected).abs() <= bound,
            "{name} ({x}, {y}): {found}, not {expected}; at rest it would be {still}"
        );
        compared += 1;
        moved += usize::from((expected - still).abs() > 2.0 * bound);
    }
    assert!(5 * moved > compared, "{name}: only {moved} of {compared} pixels tell the velocity");
    compared
}

/// Lace moves with the foam at a pixel: faint foam at its own speed, a sprite whose centre lies far outside the picture
/// where its rim shows, foam of two velocities each with its own, and foam that lies in one place with the mean.
#[test]
fn lace_moves_with_the_foam_at_each_pixel() {
    let gpu = Gpu::shared();
    let size = extent(640, 400);
    let mut rig = Rig::lit(&gpu, &whole(size, Shading::Raster), 1);
    let spacing = Foamy::new(size, Lens::Standard, 0.0).shot.settings.water.spacing;
    let [one, other] = [[3.0, -1.5, 0.5], [-2.5, 2.0, -1.0]].map(|v| v.map(|v| v * spacing));
    // Points (x, y, depth), amounts and velocities.
    type Foam = ([f32; 3], f32, [f32; 3]);
    let draw_with = |foam: &[Foam], dense: f32, shade: f32, rig: &mut Rig<'_>| {
        let mut case = Foamy::new(size, Lens::Standard, 0.0);
        let points: Vec<_> = foam.iter().map(|(at, _, _)| *at).collect();
        case.shot.positions = scenes::world(&case.shot.camera, &points);
        case.amounts = foam.iter().map(|(_, amount, _)| [*amount, 0.0]).collect();
        case.velocities = foam.iter().map(|(_, _, velocity)| *velocity).collect();
        case.ids = None;
        let look = &mut case.shot.settings.surface_foam;
        (look.noise, look.pattern, look.normal_strength, look.min_thickness) = (0.0, 0.0, 0.0, 0.0);
        // Faint foam covers as much as other foam.
        (look.extinction, look.front_extinction) = (dense / foam[0].1, 5.0);
        (look.back_color, look.front_color) = ([0.9; 3], [0.9; 3]);
        (look.lace, look.lace_size, look.aeration) = (1.0, 1.0, 0.0);
        look.lace_shade = shade;
        // The water around faint foam is as clear as air.
        case.shot.settings.water.medium =
            Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] };
        case.shot.settings.light.irradiance = [std::f32::consts::PI; 3];
        let drawn = case.draw(rig);
        (case, drawn)
    };
    let draw = |foam: &[Foam], rig: &mut Rig<'_>| draw_with(foam, 8.0, 0.0, rig);
    let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));

    for amount in [1.0, 0.3, 0.1] {
        let (case, drawn) = draw(&[([0.1, -0.2, 3.0], amount, one)], &mut rig);
        let count = check_lace(&format!("alone {amount}"), &case, &drawn, |_, _| Some(wide(one)));
        assert!(count > 500, "{count} pixels of {amount}");
    }
    // Shaded lace: thin foam, and foam so thick that all holes are closed, which only the shading shows.
    for (dense, shade) in [(8.0, 1.0), (400.0, 0.5), (400.0, 2.0)] {
        let (case, drawn) = draw_with(&[([0.1, -0.2, 3.0], 1.0, one)], dense, shade, &mut rig);
        let name = format!("density {dense}, shade {shade}");
        let count = check_lace(&name, &case, &drawn, |_, _| Some(wide(one)));
        assert!(count > 500, "{name}: {count} pixels");
    }
    // The picture ends 0.577 depths from its middle in x; the nearest node is more than half a coarse cell away.
    let (case, drawn) = draw(&[([-0.86, 0.1, 0.6], 1.0, one)], &mut rig);
    let count = check_lace("outside", &case, &drawn, |_, _| Some(wide(one)));
    assert!(count > 100, "{count} pixels of the sprite outside");
    // Farther apart than two coarse cells.
    let apart = [([-2.5, 0.3, 3.0], 0.5, one), ([2.5, -0.3, 3.0], 0.5, other)];
    let (case, drawn) = draw(&apart, &mut rig);
    let count =
        check_lace("apart", &case, &drawn, |x, _| Some(wide(if x < 320 { one } else { other })));
    assert!(count > 1000, "{count} pixels of two sprites");
    // Exactly at a node of the two finer grids, so that the weights are whole steps: 63 and 21. The sprites are too
    // narrow for the coarsest grid. The node is at pixel (320, 192), eight above the middle of the picture.
    let step = Foamy::new(size, Lens::Standard, 0.0).shot.view(size).slope_step().y.abs() as f32;
    let place = [0.0, 8.0 * step * 10.0, 10.0];
    let (case, drawn) = draw(&[(place, 1.0, one), (place, 1.0 / 3.0, other)], &mut rig);
    let mean = 0.75 * wide(one) + 0.25 * wide(other);
    let count = check_lace("mean", &case, &drawn, |_, _| Some(mean));
    assert!(count > 300, "{count} pixels of the mean");
}

/// Thickness of the water that lies behind the frontmost foam and before the middle of the visible
/// foam, in metres, from the layers of a frame at full resolution. `long`: metres along the ray per
/// metre of depth; `after`: thickness of all water behind the frontmost foam. The foam's extinction
/// is 2.
fn between(drawn: &Drawn, (x, y): (usize, usize), (spacing, long): (f64, f64), after: f64) -> f64 {
    let found = of(drawn);
    let [all, _] = found.thickness.at(x, y).map(f64::from);
    let [far, frontmost, surface] =
        [&found.far, &found.depth, &drawn.surface].map(|image| f64::from(image.at(x, y)));
    if all == 0.0 || after <= 0.0 {
        return 0.0;
    }
    let far = far / all;
    let middle = spacing * far * (1.0 + 1.0 / (1.0 - far));
    let behind = (middle - all * (1.0 - (-2.0 * all * long).exp())).max(0.0);
    let wet = (behind - (surface - frontmost - 4.0 * spacing).max(0.0)).max(0.0);
    wet.min(after)
}

/// A pool that faces the eye, with foam deep inside, and a thin veil of other foam that covers a
/// part of the pool.
pub(super) fn veiled(size: ash::vk::Extent2D) -> Foamy {
    let mut case = Foamy::new(size, Lens::Standard, 0.0);
    let mut points = scenes::block(3, 0.2, [22, 16, 14], [-2.1, -1.5, 2.6]);
    let pool = points.len();
    let deep = scenes::block(3, 0.25, [10, 6, 1], [-1.2, -0.6, 4.6]);
    points.extend(&deep);
    points.extend((0..12).map(|i| [-0.5 + 0.11 * i as f32, -0.1, 2.45]));
    case.shot.positions = scenes::world(&case.shot.camera, &points);
    case.amounts = vec![[0.0; 2]; pool];
    case.amounts.extend(vec![[1.0, 0.0]; deep.len()]);
    case.amounts.extend([[0.13, 0.0]; 12]);
    case.velocities = vec![[0.0; 3]; points.len()];
    case.ids = None;
    let water = &mut case.shot.settings.water;
    (water.refraction, water.specular) = (0.0, 0.0);
    water.fresnel = Fresnel::Source { bias: 0.0, scale: 0.0, power: 1.0 };
    water.medium = Medium::Physical { absorption: [0.9, 0.4, 0.2], scattering: [0.1, 0.2, 0.3] };
    let look = &mut case.shot.settings.surface_foam;
    (look.noise, look.pattern, look.normal_strength, look.min_thickness) = (0.0, 0.0, 0.0, 0.0);
    (look.extinction, look.front_extinction, look.front_depth) = (2.0, 5.0, 1.0);
    (look.back_color, look.front_color) = ([0.7, 0.6, 0.5], [0.9, 0.8, 0.7]);
    case.shot.settings.light.irradiance = [std::f32::consts::PI; 3];
    case
}

/// Foam under a veil is seen through the water in front of it. The expected colour is computed from
/// the layers.
#[test]
fn foam_under_a_veil_lies_under_water() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for shading in [Shading::Raster, Shading::Compute] {
        let config = whole(size, shading).with(|it| {
            it.sheets = 1;
            it.max_particles = 6000;
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let case = veiled(size);
        let drawn = case.draw(&mut rig);
        let (found, water) = (of(&drawn), &case.shot.settings.water);
        let view = case.shot.view(size);
        let Medium::Physical { absorption, scattering } = water.medium else { unreachable!() };
        let ambient = case.shot.settings.light.ambient.map(f64::from);
        let mut deep = 0;
        for (i, color) in drawn.output.data.iter().enumerate() {
            let (x, y) = (i % 97, i / 97);
            if drawn.depth.data[i] >= 1e9 || found.depth.data[i] >= 1e9 {
                continue;
            }
            let [all, layer] = found.thickness.data[i].map(f64::from);
            let t = f64::from(drawn.thickness.data[i]);
            let before = f64::from(found.before.data[i]).min(t);
            let long = view.ray(x, y).length();
            let between = between(&drawn, (x, y), (case.settings().spacing, long), t - before);
            deep += usize::from(all > 0.01 && between > 0.5 && before < 0.1);
            let back = (-5.0 * layer * long).exp();
            for c in 0..3 {
                let extinction = f64::from(absorption[c]) + f64::from(scattering[c]);
                let through = |color: f64, metres: f64| {
                    let kept = (-extinction * metres * long).exp();
                    let albedo = f64::from(scattering[c]) / extinction;
                    color * kept + ambient[c] * albedo * (1.0 - kept)
                };
                let over = |color: f64, metres: f64| {
                    let foam = [0.9, 0.8, 0.7][c] + [-0.2, -0.2, -0.2][c] * back;
                    foam + (color - foam) * (-2.0 * metres * long).exp()
                };
                let scene = f64::from(case.shot.color[i][c]);
                let behind = through(scene, t - before - between);
                let expected = through(over(behind, all), before + between);
                // Exponents of a few units, with metres from a mean distance, which is a quotient
                // of a difference.
                let bound = 400.0 * U * (1.0 + expected);
                let found = f64::from(color[c]);
                assert!((found - expected).abs() <= bound, "({x}, {y}) {c}: {found}, {expected}");
            }
        }
        assert!(deep > 100, "{deep} pixels with foam under a veil");
    }
}

/// Thin foam before water: its thickness sprite is larger than its depth sprite, and shows also in
/// tiles that have no foam depth.
#[test]
fn the_last_of_foam_shows_in_every_tile() {
    const TILE: usize = 16;
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for shading in [Shading::Raster, Shading::Compute] {
        let mut rig = Rig::lit(&gpu, &whole(size, shading), 1);
        let mut case = Foamy::new(size, Lens::Standard, 0.0);
        let mut block = scenes::block(3, 0.1, [40, 28, 3], [-2.0, -1.4, 2.0]);
        block.push([0.0, 0.0, 0.6]);
        case.shot.positions = scenes::world(&case.shot.camera, &block);
        case.amounts = vec![[0.0; 2]; block.len()];
        *case.amounts.last_mut().expect("a particle") = [0.06, 0.0];
        case.velocities = vec![[0.0; 3]; block.len()];
        case.ids = None;
        let look = &mut case.shot.settings.surface_foam;
        (look.noise, look.pattern, look.min_thickness, look.extinction) = (0.0, 0.0, 0.0, 1.0e4);
        let [white, black] = [0.9, 0.0].map(|albedo| {
            let look = &mut case.shot.settings.surface_foam;
            (look.back_color, look.front_color) = ([albedo; 3], [albedo; 3]);
            case.draw(&mut rig)
        });
        let found = of(&white);
        let (width, height) = (size.width as usize, size.height as usize);
        let in_tile = |x: usize, y: usize| {
            let around = |c: usize, end: usize| {
                (c / TILE * TILE).saturating_sub(1)..(c / TILE * TILE + TILE + 1).min(end)
            };
            around(y, height)
                .any(|y| around(x, width).any(|x| found.depth.data[y * width + x] < 1e9))
        };
        let mut alone = 0;
        for (i, [t, _]) in found.thickness.data.iter().enumerate() {
            // The foam is thick enough to hide everything behind it.
            if 1.0e4 * t > 10.0 {
                let apart = white.output.data[i][1] - black.output.data[i][1];
                assert!(apart > 0.05, "{shading:?}: no foam in pixel {i}: {apart}");
                alone += usize::from(!in_tile(i % width, i / width));
            }
        }
        assert!(alone > 20, "{alone} pixels in tiles without the foam's depth");
    }
}

/// Foam that faces the sun is lighter. Its normal follows from the slope of its front layer between
/// texels.
#[test]
fn the_relief_of_foam_follows_the_sun() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let config = foaming(size).with(|it| {
        it.output_format = ash::vk::Format::R32G32B32A32_SFLOAT;
        it.thickness_level = 0;
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
        let mut case = Foamy::new(size, lens, 0.0);
        case.shot.positions = scenes::world(&case.shot.camera, &[[0.1, 0.0, 2.0]]);
        (case.amounts, case.velocities, case.ids) = (vec![[1.0, 0.0]], vec![[0.0; 3]], None);
        // The foam is opaque at any thickness.
        (
            case.shot.settings.surface_foam.extinction,
            case.shot.settings.surface_foam.min_thickness,
        ) = (1.0e6, 0.0);
        let view = case.shot.view(size);
        let sun = DVec3::new(-0.6, 0.48, 0.64);
        let world = case.shot.camera_view().inverse().transform_vector3(sun);
        case.shot.settings.light.direction = world.as_vec3().to_array();
        case.shot.settings.surface_foam.normal_strength = 0.0;
        let flat = case.draw(&mut rig);
        case.shot.settings.surface_foam.normal_strength = 0.6;
        let drawn = case.draw(&mut rig);
        let found = of(&drawn);
        let height = |x: usize, y: usize, i: isize, j: isize| {
            f64::from(found.thickness.clamped(x as isize + i, y as isize + j)[1])
        };
        let (mut lighter, mut darker) = (0, 0);
        for (x, y) in (0..61).flat_map(|y| (0..97).map(move |x| (x, y))) {
            let z = f64::from(found.depth.at(x, y));
            if z >= 1e9 || height(x, y, 0, 0) < 1e-4 {
                continue;
            }
            // The slope in the middle of a texel: central differences, weighted over three rows.
            let at = |i: isize, j: isize| height(x, y, i, j);
            let three = |of: &dyn Fn(isize) -> f64| 0.125 * (of(-1) + 6.0 * of(0) + of(1));
            let rise = DVec2::new(
                three(&|j| 0.5 * (at(1, j) - at(-1, j))),
                three(&|i| 0.5 * (at(i, 1) - at(i, -1))),
            );
            let wide = view.slope_step() * z;
            let slope = rise / wide;
            let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
            let factor = (1.0 + 0.6 * (normal.dot(sun) - sun.z)).clamp(0.3, 1.3);
            let expected = factor * f64::from(flat.output.at(x, y)[0]);
            let found = f64::from(drawn.output.at(x, y)[0]);
            // The rise is a difference of two sums; quotients and normalizing add a few u.
            let bound = U * (40.0 + 16.0 * height(x, y, 0, 0) / wide.abs().min_element());
            assert!(
                (found - expected).abs() <= bound * (1.0 + expected),
                "{found}, not {expected}"
            );
            lighter += usize::from(factor > 1.02);
            darker += usize::from(factor < 0.98);
        }
        assert!(lighter > 30 && darker > 30, "{lens:?}: {lighter} lighter, {darker} darker");
    }
}

/// Foam around a pixel, six spacings away in eight directions, shades its foam: foam that faces
/// away from the sun only has the light of shade, and foam in hollows less of all light.
#[test]
fn the_shape_of_a_splash_lights_its_foam() {
    const AROUND: f64 = 6.0;
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let config = foaming(size).with(|it| {
        it.output_format = ash::vk::Format::R32G32B32A32_SFLOAT;
        it.thickness_level = 0;
        it.max_particles = 600;
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
        let mut case = Foamy::new(size, lens, 0.0);
        // A steep hill of foam on a plain.
        let mut random = scenes::Random(9);
        let mut at = || {
            let [x, y] = [0; 2].map(|_| random.between(-2.0, 2.0));
            [x, y, 4.5 - 2.5 * (-2.0 * (x * x + y * y)).exp() + random.between(0.0, 0.1)]
        };
        let points: Vec<_> = (0..600).map(|_| at()).collect();
        case.shot.positions = scenes::world(&case.shot.camera, &points);
        (case.amounts, case.ids) = (vec![[1.0, 0.0]; 600], None);
        case.velocities = vec![[0.0; 3]; 600];
        let look = &mut case.shot.settings.surface_foam;
        (look.extinction, look.min_thickness, look.normal_strength) = (1.0e6, 0.0, 0.0);
        let sun = DVec3::new(-0.9, 0.3, 0.1_f64.sqrt());
        let view = case.shot.view(size);
        let world = case.shot.camera_view().inverse().transform_vector3(sun);
        case.shot.settings.light.direction = world.as_vec3().to_array();
        case.shot.settings.light.irradiance = [2.0; 3];
        case.shot.settings.light.shade = [0.5; 3];
        let flat = case.draw(&mut rig);
        case.shot.settings.surface_foam.shape = 0.8;
        let drawn = case.draw(&mut rig);
        let found = of(&drawn);
        let reach = AROUND * case.settings().spacing;
        let beyond = |at: DVec2, z: f64| -> f64 {
            let at = at.clamp(DVec2::splat(0.5), DVec2::new(96.5, 60.5));
            let one = |&(x, y, weight): &(isize, isize, f64)| {
                let there = f64::from(found.depth.clamped(x, y));
                weight * (if is_surface(there) { there - z } else { reach }).clamp(-reach, reach)
            };
            found.depth.bilinear(at).iter().map(one).sum()
        };
        let (mut shaded, mut lit, mut hollow) = (0, 0, 0);
        for (x, y) in (0..61).flat_map(|y| (0..97).map(move |x| (x, y))) {
            let z = f64::from(found.depth.at(x, y));
            if z >= 1e9 || found.thickness.at(x, y)[0] < 1e-4 {
                continue;
            }
            let wide = view.slope_step() * z;
            let texels = (reach / wide.abs()).min(DVec2::splat(32.0));
            let middle = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let (mut slope, mut before) = (DVec2::ZERO, 0.0);
            for way in (0..8).map(|i| DVec2::from_angle(f64::from(i) * std::f64::consts::FRAC_PI_4))
            {
                let there = beyond(middle + way * texels, z);
                slope += way * there;
                before += (-there).max(0.0);
            }
            let slope = 0.25 * slope / (texels * wide);
            let normal = DVec3::new(slope.x, slope.y, 1.0).normalize();
            let turned = smoothstep(-0.5, 0.6, normal.dot(sun));
            let sky = 1.0 - 0.6 * before / (8.0 * reach);
            let of_sun = 1.0 + 0.8 * (turned - 1.0);
            let factor = (0.25 + 0.75 * of_sun) * (1.0 + 0.8 * (sky - 1.0));
            let expected = factor * f64::from(flat.output.at(x, y)[0]);
            let found = f64::from(drawn.output.at(x, y)[0]);
            // A position up to 32 texels away errs by 64u, between depths up to two reaches apart.
            // The angle is a sum of eight of these over four reaches, and smoothstep's slope is at
            // most 1.5 / 1.1.
            let bound = 1.4 * 8.0 * (2.0 * 64.0 + 16.0 * z / reach) / 4.0 * U + 100.0 * U;
            assert!((found - expected).abs() <= bound * expected, "{found}, not {expected}");
            shaded += usize::from(turned < 0.5);
            lit += usize::from(turned > 0.9);
            hollow += usize::from(sky < 0.9);
        }
        let all = [shaded, lit, hollow];
        assert!(all.iter().all(|count| *count > 30), "{lens:?}: {all:?}");
    }
}

/// The picture adds one layer after another: water behind the frontmost foam, foam by both rules of
/// its colour, water before it, then reflected light. Each partial picture is compared with its
/// layers.
#[test]
fn each_debug_view_adds_a_layer() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let config = foaming(size).with(|it| {
        it.output_format = ash::vk::Format::R32G32B32A32_SFLOAT;
        it.thickness_level = 0;
        it.smoothing_level = 0;
        it.sheets = 1;
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut case = Foamy::new(size, Lens::OffAxis, 10.0);
    case.shot.settings.water.refraction = 0.0;
    let absorption = [1.5, 0.6, 0.2];
    case.shot.settings.water.medium = Medium::Physical { absorption, scattering: [0.0; 3] };
    let look = &mut case.shot.settings.surface_foam;
    (look.normal_strength, look.min_thickness, look.extinction, look.front_extinction) =
        (0.0, 0.0, 2.0, 3.0);
    (look.pattern, look.noise) = (0.0, 1.0);
    (look.front_depth, look.back_color, look.front_color) = (1.5, [0.2, 0.3, 0.4], [0.9, 0.8, 0.7]);
    case.shot.settings.light.irradiance = [std::f32::consts::PI; 3];
    let view = case.shot.view(size);
    for power in [0.0, 1.0, 2.5] {
        case.shot.settings.surface_foam.front_power = power;
        let [scene, back, foam, front, whole] = [
            DebugView::Background,
            DebugView::BackWater,
            DebugView::SurfaceFoam,
            DebugView::FrontWater,
            DebugView::Whole,
        ]
        .map(|view| {
            case.shot.settings.debug_view = view;
            case.draw(&mut rig)
        });
        let found = of(&whole);
        let (mut parted, mut shone, mut deep) = (0, 0, 0);
        for (x, y) in (0..61).flat_map(|y| (0..97).map(move |x| (x, y))) {
            if whole.depth.at(x, y) >= 1e9 {
                continue;
            }
            let [all, before] = [&whole.thickness, &found.before].map(|t| f64::from(t.at(x, y)));
            let before = before.min(all);
            let [t, layer] = found.thickness.at(x, y).map(f64::from);
            let long = view.ray(x, y).length();
            let kept = (-2.0 * t * long).exp();
            let much = match power {
                0.0 => 1.0 - (-3.0 * layer * long).exp(),
                p => (layer / 1.5).clamp(1e-6, 1.0).powf(f64::from(p)),
            };
            let spacing = case.settings().spacing;
            let between = between(&whole, (x, y), (spacing, long), all - before);
            deep += usize::from(t > 0.01 && between > 0.02);
            let before = before + between;
            parted += usize::from(before > 0.02 && all - before > 0.02 && kept < 0.9);
            for i in 0..3 {
                let thin = f64::from([0.2_f32, 0.3, 0.4][i]);
                let color = thin + (f64::from([0.9_f32, 0.8, 0.7][i]) - thin) * much;
                let of = |drawn: &Drawn| f64::from(drawn.output.at(x, y)[i]);
                let lost = |c: f64, t: f64| c * (-f64::from(absorption[i]) * t * long).exp();
                let c0 = f64::from(case.shot.color[y * 97 + x][i]);
                let c1 = lost(c0, all - before);
                let c2 = color + (c1 - color) * kept;
                let c3 = lost(c2, before);
                // Exponents of at most a few, 3 + 2|x| ulp each; the power errs by its exponent
                // times 16 ulp of a logarithm; quotients and mixes add a few.
                let bound = 400.0 * U * (1.0 + c0);
                for (name, drawn, expected) in [
                    ("scene", &scene, c0),
                    ("back", &back, c1),
                    ("foam", &foam, c2),
                    ("front", &front, c3),
                ] {
                    let off = (of(drawn) - expected).abs();
                    assert!(off <= bound, "{name} {power} {x} {y}: {} not {expected}", of(drawn));
                }
                shone += usize::from(of(&whole) > of(&front) + 1e-3);
            }
        }
        assert!(
            parted > 50 && shone > 100 && deep > 20,
            "{power}: {parted} parted, {shone} lit, {deep} deep"
        );
    }
}
