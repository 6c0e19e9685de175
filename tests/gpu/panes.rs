//! Water that stands against panes of glass, compared with the CPU twin.

use glam::{DMat3, DVec2, DVec3};
use whitewater::water::{Bed, Compositing, Exit, Fresnel, Medium, Pane, Shading, Wavelets};

use crate::composite::{Layers, SKY, Sky, twin_settings};
use crate::reference::composite::{self as twin, exit_about, scene_at};
use crate::reference::panes::{self, Flat};
use crate::reference::surface::Surfaces;
use crate::reference::surface_foam::{self, Pattern};
use crate::reference::{Image, View, is_surface, smoothstep};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::support::tolerance::U;
use crate::surface_foam::Foamy;
use crate::surface_foam::picture::closing_error;

const SPACING: f64 = 0.2 / 0.656;
/// Sides of the box of water in spacings.
const BOX: [f64; 3] = [14.0, 8.0, 12.0];
/// Absorption per scene unit.
const ABSORBED: [f32; 3] = [0.6, 0.3, 0.1];

/// The three axes of the box in the twin's eye space: two level ones, which point towards the eye's
/// side, and up; and the middle of the box.
fn axes() -> (DMat3, DVec3) {
    let turned = DMat3::from_rotation_x(0.5) * DMat3::from_rotation_y(-0.7);
    (turned, DVec3::new(0.1, -0.2, -6.5))
}

/// Eye-space x, y and depth of a point.
fn seen(p: DVec3) -> [f32; 3] {
    [p.x, p.y, -p.z].map(|x| x as f32)
}

/// A box of water behind two panes that meet in an edge towards the eye. The particles' outermost
/// layers lie about the panes, so some of their spheres stick out. The level top is free.
fn tank(lens: Lens) -> Shot {
    let size = extent(97, 61);
    let (axes, middle) = axes();
    let mut random = Random(5);
    let half = DVec3::from(BOX) * 0.5 * SPACING;
    let mut points = Vec::new();
    let count = BOX.map(|n| n as usize);
    for x in 0..=count[0] {
        for y in 0..=count[1] {
            for z in 0..=count[2] {
                let mut jitter = || f64::from(random.between(-0.2, 0.2)) * SPACING;
                let at = DVec3::new(x as f64, y as f64, z as f64) * SPACING - half;
                let at = at + DVec3::new(jitter(), jitter(), jitter());
                points.push(seen(middle + axes * at));
            }
        }
    }
    let mut shot = Shot::new(size, lens, 0.2, &points);
    let water = &mut shot.settings.water;
    water.medium = Medium::Physical { absorption: ABSORBED, scattering: [0.0; 3] };
    water.bed = Bed::Source;
    let corner = |x: f64, y: f64, z: f64| middle + axes * (half * DVec3::new(x, y, z));
    // They end a spacing above the water.
    let top = 1.0 + SPACING / half.y;
    let panes = [
        [corner(1.0, -1.0, 1.0), corner(1.0, -1.0, -1.0), corner(1.0, top, 1.0)],
        [corner(-1.0, -1.0, 1.0), corner(1.0, -1.0, 1.0), corner(-1.0, top, 1.0)],
    ];
    shot.panes = panes.map(|corners| pane(&shot, corners)).to_vec();
    shot
}

/// A pane from three corners in eye space, with the water on the far side of it.
fn pane(shot: &Shot, corners: [DVec3; 3]) -> Pane {
    let points = scenes::world(&shot.camera, &corners.map(seen));
    let [corner, a, b] = [0, 1, 2].map(|i| DVec3::from(points[i].map(f64::from)));
    let eye = shot.view(shot.size).view.inverse().transform_point3(DVec3::ZERO);
    let edges = [a - corner, b - corner];
    let towards = edges[0].cross(edges[1]).dot(eye - corner) > 0.0;
    let edges = if towards { edges } else { [edges[1], edges[0]] };
    Pane { corner: points[0], edges: edges.map(|edge| edge.as_vec3().to_array()) }
}

/// The panes of a shot for the twin.
fn of_twin(shot: &Shot, view: &View) -> Vec<panes::Pane> {
    let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let eye = |pane: &Pane| {
        let edges = pane.edges.map(wide);
        panes::Pane {
            corner: view.view.transform_point3(wide(pane.corner)),
            edges: edges.map(|edge| view.view.transform_vector3(edge)),
            away: view.view.transform_vector3(edges[0].cross(edges[1])).normalize(),
        }
    };
    shot.panes.iter().map(eye).collect()
}

/// Largest difference of neighbouring texels of the scene.
fn change(shot: &Shot) -> f64 {
    let wide = shot.size.width as usize;
    let texels = shot.color.iter().enumerate().filter(|(i, _)| (i + 1) % wide > 0);
    let next =
        texels.filter_map(|(i, c)| Some((c, shot.color.get(i + 1)?, shot.color.get(i + wide)?)));
    let most = |(c, right, below): (&[f32; 4], &[f32; 4], &[f32; 4])| {
        (0..3).map(|k| (right[k] - c[k]).abs().max((below[k] - c[k]).abs())).fold(0.0, f32::max)
    };
    f64::from(next.map(most).fold(0.0, f32::max))
}

/// What a pixel became.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Empty,
    Free,
    Undecided,
    Flush,
}

/// Compares the pixels that are flush with a pane with the twin's, and all others with the picture
/// without panes. Returns what each pixel is, and the number of flush pixels before and behind their
/// pane.
fn check(name: &str, rig: &mut Rig<'_>, shot: &Shot) -> (Image<Kind>, [usize; 2]) {
    let drawn: Drawn = rig.draw(shot);
    let mut bare = shot.clone();
    bare.panes.clear();
    let free = rig.draw(&bare);
    let (view, level) = (shot.view(shot.size), rig.config.smoothing_level);
    let mut settings = twin_settings(shot, &view);
    let Fresnel::Schlick { f0 } = shot.settings.water.fresnel else { panic!("{name}: no index") };
    let root = f64::from(f0).sqrt();
    settings.exit = (rig.config.exit == Exit::TwoInterfaces).then_some((1.0 + root) / (1.0 - root));
    let (width, height) = (shot.size.width as usize, shot.size.height as usize);
    let layers = Layers::new(&drawn, shot);
    let inputs = layers.inputs(level, rig.config.thickness_level);
    let bits = rig.gpu.limits().sub_texel_precision_bits;
    let texel = 1.0 / f64::from(1 << bits);
    let change = change(shot);
    let own = of_twin(shot, &view);
    let surfaces = Surfaces::new(&inputs, &settings, &view);
    let mut sides = [0; 2];
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let kinds = pixels.map(|(x, y)| {
        let out = drawn.output.at(x, y).map(f64::from);
        if !is_surface(layers.depth.at(x, y)) {
            assert_eq!(drawn.output.at(x, y), free.output.at(x, y), "{name}: dry ({x}, {y})");
            return Kind::Empty;
        }
        let mut found = surfaces.at(x, y).expect("a surface");
        let (flat, margin) = panes::flush(&own, &found, SPACING);
        let undecided = 16.0 * U * (settings.falloff * settings.radius - found.position.z);
        // Normals are quotients of differences of depths, whose error is that of the depth over the
        // width of a pixel.
        let pixel_wide = view.slope_step().abs().min_element() * -found.position.z;
        let rough = 64.0 * U * (1.0 - found.position.z / pixel_wide);
        if found.parts.margin <= undecided || margin < rough {
            return Kind::Undecided;
        }
        let Some(Flat { position, gained, normal }) = flat else {
            assert_eq!(drawn.output.at(x, y), free.output.at(x, y), "{name}: free ({x}, {y})");
            return Kind::Free;
        };
        sides[usize::from(gained > 0.0)] += 1;
        let full = (found.parts.full + gained).max(0.0);
        let torn = full.min(2.0 * SPACING);
        found.lens = torn + (full - torn) * found.parts.found;
        // The slope stays that of the particles, from which the far surface's slope is found.
        (found.position, found.normal) = (position, normal);
        found.room = (inputs.scene(x, y) + position.z).max(0.0);
        found.thickness = full.min(found.room);
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let at = twin::look_up(&inputs, &settings, &found, &view, pixel);
        let (at, _) = twin::cut_look_up(&inputs, -position.z, pixel, at);
        let behind = scene_at(&inputs, at);
        // Thickness and both depths have errors of a few roundings of the depth.
        let error = 64.0 * U * (full - position.z);
        let share = (error / full.max(error)).min(0.5);
        let turned = rough + 64.0 * U * (found.parts.full + settings.radius) / pixel_wide;
        let env = |_| Sky::Even.radiance(DVec3::Y);
        let (exit, light, path, sure) =
            exit_about(&inputs, &settings, &found, &view, (x, y), behind, env, (turned, share));
        if !sure {
            return Kind::Undecided;
        }
        let expected = twin::through(&settings.medium, exit.light, exit.path);
        let moved = texel + share * at.distance(pixel) + 64.0 * U * width as f64;
        for i in 0..3 {
            let along = position.length() / -position.z;
            let length = path + error * along + 64.0 * U * exit.path;
            let bound = light[i]
                + 4.0 * change * (moved + 2.0 * texel)
                + f64::from(ABSORBED[i]) * exit.light[i] * length
                + 64.0 * U * (1.0 + exit.light[i]);
            let off = (out[i] - expected[i]).abs();
            assert!(
                off <= bound,
                "{name}: ({x}, {y}) {i}: {} for {}, {bound}",
                out[i],
                expected[i]
            );
        }
        Kind::Flush
    });
    let kinds = Image::from_vec(width, height, kinds.collect()).expect("the size");
    (kinds, sides)
}

fn count(kinds: &Image<Kind>, kind: Kind) -> usize {
    kinds.data.iter().filter(|found| **found == kind).count()
}

/// Two panes that meet in an edge, through every lens; with both ways of shading, each with refraction
/// at the front surface alone and at both.
#[test]
fn water_behind_panes_is_the_twins() {
    let gpu = Gpu::shared();
    let both =
        [(Lens::Standard, 0, Exit::TwoInterfaces), (Lens::LeftHanded, 2, Exit::TwoInterfaces)];
    let all = LENSES.map(|lens| (lens, 1, Exit::Straight)).into_iter().chain(both);
    for (turn, (lens, level, exit)) in all.enumerate() {
        let name = format!("panes-{lens:?}-{level}");
        let shot = tank(lens);
        let config = config(shot.size).with(|it| {
            it.smoothing_level = level;
            it.exit = exit;
            it.composite = Some([Shading::Compute, Shading::Raster][turn % 2]);
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        let (kinds, sides) = check(&name, &mut rig, &shot);
        let [free, undecided, flush] =
            [Kind::Free, Kind::Undecided, Kind::Flush].map(|kind| count(&kinds, kind));
        if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
            eprintln!("{name}: {free} free, {undecided} undecided, {flush} flush, {sides:?}");
        }
        assert!(free > 100 && flush > 300 && sides.iter().all(|n| *n > 50), "{name}: {sides:?}");
        assert!(25 * undecided <= free + flush, "{name}: {undecided} undecided");
    }
}

/// Panes seen from the water's side change nothing, and neither does a pane behind the eye that water
/// before the eye is near to. The thesis has no panes.
#[test]
fn panes_of_no_water_change_nothing() {
    let gpu = Gpu::shared();
    let mut shot = tank(Lens::Standard);
    let mut rig = Rig::new(&gpu, &config(shot.size));
    let with = rig.draw(&shot);
    for pane in &mut shot.panes {
        pane.edges.swap(0, 1);
    }
    let turned = rig.draw(&shot);
    shot.panes.clear();
    let without = rig.draw(&shot);
    compare::same_color("panes-turned", &turned.output, &without.output);
    assert!(with.output.data != without.output.data);

    let points: Vec<_> =
        (0..40).map(|i| [0.1 * (i % 8) as f32 - 0.35, 0.1 * (i / 8) as f32, 0.4]).collect();
    let mut near = Shot::new(shot.size, Lens::Standard, 0.2, &points);
    let without = rig.draw(&near);
    assert!(without.depth.data.iter().any(|z| *z < 0.25), "within reach");
    // It faces the eye, and its plane lies behind the eye.
    let corners = [[-9.0, -9.0, 0.02], [9.0, -9.0, 0.02], [-9.0, 9.0, 0.02]].map(DVec3::from);
    near.panes.push(pane(&near, corners));
    for turn in 0..2 {
        compare::same_color(
            &format!("panes-behind-{turn}"),
            &rig.draw(&near).output,
            &without.output,
        );
        near.panes[0].edges.swap(0, 1);
    }

    let mut thesis = tank(Lens::Standard);
    thesis.settings.water.compositing = Compositing::Source;
    let with = rig.draw(&thesis);
    thesis.panes.clear();
    compare::same_color("panes-thesis", &with.output, &rig.draw(&thesis).output);
}

/// Water that is flush with a pane has neither surface noise nor small waves.
#[test]
fn water_at_panes_has_no_waves() {
    let gpu = Gpu::shared();
    let mut shot = tank(Lens::Standard);
    let still = config(shot.size).with(|it| it.noise = Some(1));
    let mut rig = Rig::new(&gpu, &still);
    // Up is towards the eye, so waves would run over the panes.
    let up = shot.view(shot.size).view.inverse().transform_vector3(axes().0 * DVec3::ONE);
    shot.settings.up = up.as_vec3().to_array();
    shot.settings.water.wavelets.slope = 0.0;
    shot.settings.noise.weight = 0.0;
    shot.settings.noise.foam = 0.0;
    let (kinds, _) = check("panes-still", &mut rig, &shot);
    let calm = rig.draw(&shot);
    shot.settings.water.wavelets = Wavelets::default();
    shot.settings.water.wavelets.slope = 0.1;
    shot.settings.noise.weight = 0.5;
    shot.settings.noise.foam = 0.5;
    let rough = rig.draw(&shot);
    let mut moved = 0;
    for (i, kind) in kinds.data.iter().enumerate() {
        let same = calm.output.data[i] == rough.output.data[i];
        assert!(same || *kind != Kind::Flush, "pixel {i}");
        moved += usize::from(!same);
    }
    assert!(count(&kinds, Kind::Flush) > 300 && moved > 100, "{moved} moved");
}

/// Foam before the glass is not tinted by the water that fills the gap between the glass and the
/// particles, and has its whole lace.
#[test]
fn foam_before_panes_is_not_under_water() {
    let gpu = Gpu::shared();
    let mut tank = tank(Lens::Standard);
    let mut rig = Rig::new(&gpu, &config(tank.size).with(|it| it.surface_foam = true));
    let look = &mut tank.settings.surface_foam;
    (look.extinction, look.pattern, look.lace, look.aeration) = (1.0e3, 0.0, 1.0, 0.0);
    look.lace_shade = 1.0;
    let water = tank.positions.len();
    let wall = scenes::block(7, 0.1, [14, 10, 1], [-0.7, -0.5, 1.5]);
    let wall = scenes::world(&tank.camera, &wall);
    let mut draw = |foam: bool, panes: bool| {
        let mut case = Foamy::new(tank.size, Lens::Standard, 0.0);
        case.shot = tank.clone();
        if !panes {
            case.shot.panes.clear();
        }
        case.amounts = vec![[0.0; 2]; water];
        if foam {
            case.shot.positions.extend(&wall);
            case.amounts.resize(water + wall.len(), [1.0, 1.0]);
        }
        case.velocities = vec![[0.0; 3]; case.amounts.len()];
        case.ids = None;
        case.draw(&mut rig).output
    };
    let [bare, at_panes, foam, foam_at_panes] =
        [(false, false), (false, true), (true, false), (true, true)].map(|(a, b)| draw(a, b));
    let mut flush = 0;
    // Pixels before which the wall certainly is: it reaches 24 pixels to the sides of the middle.
    for (x, y) in (18..43).flat_map(|y| (33..64).map(move |x| (x, y))) {
        flush += usize::from(bare.at(x, y) != at_panes.at(x, y));
        let (a, b) = (foam.at(x, y), foam_at_panes.at(x, y));
        // The wall's transmittance is below e^-10.
        let off = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
        assert!(off < 1.0e-4, "({x}, {y}): {a:?}, {b:?}");
    }
    assert!(flush > 300, "{flush}");
}

/// Foam behind a pane has 0.35 of the lace's strength, and the lace lies in the pane's plane.
#[test]
fn foam_behind_panes_has_little_lace() {
    let gpu = Gpu::shared();
    let mut case = Foamy::new(extent(97, 61), Lens::Standard, 0.0);
    case.shot = tank(Lens::Standard);
    case.shot.color.fill([0.1, 0.1, 0.1, 1.0]);
    case.amounts = vec![[0.7, 0.0]; case.shot.positions.len()];
    case.velocities = vec![[0.0; 3]; case.amounts.len()];
    case.ids = None;
    let water = &mut case.shot.settings.water;
    water.medium = Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] };
    let look = &mut case.shot.settings.surface_foam;
    (look.noise, look.pattern, look.normal_strength, look.min_thickness) = (0.0, 0.0, 0.0, 0.0);
    (look.aeration, look.lace_shade, look.shape, look.lace_size) = (0.0, 0.0, 0.0, 2.0);
    (look.back_color, look.front_color) = ([0.9; 3], [0.9; 3]);
    let config = config(case.shot.size).with(|it| {
        it.surface_foam = true;
        it.exit = Exit::Straight;
    });
    let mut rig = Rig::new(&gpu, &config);
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    let mut draw = |lace: f32, extinction: f32| {
        let look = &mut case.shot.settings.surface_foam;
        (look.lace, look.extinction, look.front_extinction) = (lace, extinction, 5.0);
        case.draw(&mut rig)
    };
    let [opaque, laced, smooth] = [(0.0, 1.0e4), (1.0, 0.5), (0.0, 0.5)].map(|(a, b)| draw(a, b));

    let view = case.shot.view(case.shot.size);
    let settings = twin_settings(&case.shot, &view);
    let layers = Layers::new(&smooth, &case.shot);
    let inputs = layers.inputs(config.smoothing_level, config.thickness_level);
    let (surfaces, own) = (Surfaces::new(&inputs, &settings, &view), of_twin(&case.shot, &view));
    let look = &case.shot.settings.surface_foam;
    let cell = f64::from(look.lace_size) * f64::from(case.shot.settings.water.spacing);
    let (size, period) = (f64::from(look.pattern_size), f64::from(look.pattern_period));
    let phases = Pattern { strength: 0.0, size, period, time: look.time }.phases();
    let to_world = view.view.inverse();
    let origin = to_world.w_axis.truncate().length() / cell;
    let foam = smooth.foam.as_ref().expect("foam");
    let (mut compared, mut told) = (0, 0);
    for (x, y) in (0..61).flat_map(|y| (0..97).map(move |x| (x, y))) {
        let Some(found) = surfaces.at(x, y) else { continue };
        let (Some(flat), margin) = panes::flush(&own, &found, SPACING) else { continue };
        if margin < 1.0e-3 {
            continue;
        }
        // Foam more than 1.5 spacings before the pane has its whole lace.
        let (depth, level) = (&foam.depth, config.thickness_level);
        let edge = f64::from(1 << level);
        let texel = |at: usize, by: f64| ((at as f64 + 0.5) / edge - 0.5 + by).floor().max(0.0);
        let across = flat.normal.dot(view.ray(x, y)).abs();
        let before = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(i, j)| {
            let (i, j) = (texel(x, i) as usize, texel(y, j) as usize);
            let z = depth.at(i.min(depth.width - 1), j.min(depth.height - 1));
            (-flat.position.z - f64::from(z)) * across / SPACING
        });
        if before.iter().any(|by| *by > 1.49) {
            continue;
        }
        // How much of the scene the foam hides.
        let of = |drawn: &Drawn| f64::from(drawn.output.at(x, y)[0]) - 0.1;
        let full = of(&opaque);
        assert!(full > 0.2, "({x}, {y}): {full}");
        let [hidden, covered] = [&smooth, &laced].map(|drawn| of(drawn) / full);
        let at = to_world.transform_point3(flat.position) / cell;
        let pixels = cell / (view.slope_step().x * flat.position.z).abs();
        let threads = surface_foam::covered(hidden, at, (DVec3::ZERO, &phases), pixels);
        let expected = hidden + 0.35 * smoothstep(2.0, 6.0, pixels) * (threads - hidden);
        let bound = closing_error((at, origin), &phases, pixels) + 64.0 * U / full;
        assert!(
            (covered - expected).abs() < bound,
            "({x}, {y}): {covered}, not {expected} of {hidden}, {bound}"
        );
        compared += 1;
        told += usize::from((expected - hidden).abs() > 2.0 * bound);
    }
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("{told} of {compared}");
    }
    assert!(compared > 300 && 2 * told > compared, "{told} of {compared}");
}

/// Where a second layer of water makes no difference, it makes none at panes.
#[test]
fn two_layers_are_flush_as_one_is() {
    let gpu = Gpu::shared();
    let mut shot = tank(Lens::Standard);
    // Drops before the water, so that its tiles are shaded for two layers.
    let drops = [[-0.4, 0.1, 2.0], [0.4, 0.1, 2.0], [0.0, -0.4, 2.0]];
    shot.positions.extend(scenes::world(&shot.camera, &drops));
    let mut bare = shot.clone();
    bare.panes.clear();
    for exit in [Exit::Straight, Exit::TwoInterfaces] {
        let [one, two] = [1, 2].map(|sheets| {
            let config = config(shot.size).with(|it| {
                it.sheets = sheets;
                it.exit = exit;
            });
            let mut rig = Rig::new(&gpu, &config);
            [&bare, &shot].map(|shot| rig.draw(shot).output.data)
        });
        let mut flush = 0;
        for i in 0..one[0].len() {
            if one[0][i] == two[0][i] {
                assert_eq!(one[1][i], two[1][i], "{exit:?}: pixel {i}");
                flush += usize::from(one[0][i] != one[1][i]);
            }
        }
        assert!(flush > 500, "{exit:?}: {flush}");
    }
}
