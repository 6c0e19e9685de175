//! Passes `light`, `caustics` and `lit`: the light's maps against the twin, and the picture against
//! what the maps say.

use ash::vk;
use glam::{DVec3, Mat4, Vec3};
use whitewater::water::{Medium, Shading, Shadows};
use whitewater::{Access, Config, Region, Shadow};

use crate::foam::Foamy;
use crate::reference::Image;
use crate::reference::light::{Light, Maps, Particle, ShadowMap, lit};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::{DEPTH, Texture};
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::rounded::{Rounded, exact, off};
use crate::support::scenes::{self, Lens, Random};
use crate::support::tolerance::U;

pub const SIZE: vk::Extent2D = vk::Extent2D { width: 97, height: 61 };

pub fn casting(texels: u32) -> Config {
    Config { cast: Some(texels), foam: true, ..config(SIZE) }
}

fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

/// The numbers of half precision next to those from one to another: which of the two a store takes
/// is the device's choice.
fn halves(low: f64, high: f64) -> [f64; 2] {
    [(low, false), (high, true)].map(|(v, up)| {
        let near = half::f16::from_f64(v);
        let off = match up {
            true => near.to_f64() < v,
            false => near.to_f64() > v,
        };
        // Positive ones are as their bits in order.
        let bits = i32::from(near.to_bits()) + i32::from(off) * if up { 1 } else { -1 };
        half::f16::from_bits(bits.max(0) as u16).to_f64()
    })
}

/// A direction that single precision holds.
fn toward(x: f32, y: f32, z: f32) -> [f32; 3] {
    Vec3::new(x, y, z).normalize().to_array()
}

/// What the twin takes of a shot.
fn twin(shot: &Shot, config: &Config) -> Light {
    let (water, region) = (&shot.settings.water, shot.sun.region.expect("a region"));
    let [first, second, third] = match config.spray {
        true => shot.settings.spray.densities,
        false => [water.density_threshold, water.density_full, water.density_threshold],
    };
    let density = |part: f32| f64::from(part) * f64::from(water.rest_density);
    Light {
        sun: wide(shot.settings.light.direction),
        center: wide(region.center),
        radius: f64::from(region.radius),
        texels: config.cast.expect("maps") as usize,
        spacing: f64::from(water.spacing),
        densities: [density(first), density(second), density(third)],
        width: f64::from(water.smoothing_width),
        falloff: f64::from(water.depth_falloff),
        extinction: match water.medium {
            Medium::Physical { absorption, scattering } => {
                [0, 1, 2].map(|i| f64::from(absorption[i]) + f64::from(scattering[i]))
            }
            Medium::Source { falloff, .. } => [0, 1, 2].map(|i| f64::from(falloff[i])),
        },
        foam_extinction: f64::from(shot.settings.foam.shadow),
    }
}

fn particles(case: &Foamy) -> Vec<Particle> {
    (0..case.shot.positions.len())
        .map(|i| Particle {
            position: wide(case.shot.positions[i]),
            density: case.shot.densities.as_ref().map(|d| f64::from(d[i])),
            foam: f64::from(case.amounts[i][0]),
        })
        .collect()
}

fn maps(drawn: &Drawn) -> Maps<'_> {
    Maps {
        front: drawn.light_front.as_ref().expect("a front"),
        thickness: drawn.light_thickness.as_ref().expect("a thickness"),
        caustics: drawn.caustics.as_ref().expect("caustics"),
    }
}

/// Water alone.
fn water(shot: Shot) -> Foamy {
    let n = shot.positions.len();
    Foamy { shot, amounts: vec![[0.0; 2]; n], velocities: vec![[0.0; 3]; n], ids: None }
}

/// Front and thickness are the twin's; how many texels have something.
fn check_maps(name: &str, case: &Foamy, config: &Config, drawn: &Drawn) -> usize {
    let (light, particles, maps) = (twin(&case.shot, config), particles(case), maps(drawn));
    let bounds = light.front(&particles);
    compare::between(&format!("{name}-front"), maps.front, &bounds);
    let close = bounds.low.data.iter().zip(&bounds.high.data).filter(|(a, b)| **b - **a < 1e-3);
    assert!(close.count() * 100 > 98 * bounds.low.data.len(), "{name}: idle bounds");
    for (i, bounds) in light.thickness(&particles).iter().enumerate() {
        let found = maps.thickness.map(|t| t[i]);
        compare::between(&format!("{name}-thickness-{i}"), &found, bounds);
        let same = bounds.low.data.iter().zip(&bounds.high.data).filter(|(a, b)| a == b);
        assert!(same.count() * 100 > 90 * bounds.low.data.len(), "{name}: idle bounds of {i}");
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
        let config = Config { spray, ..casting(texels) };
        let mut rig = Rig::new(&gpu, &config);
        for (i, sun) in suns.into_iter().enumerate() {
            let mut case = Foamy::new(SIZE, Lens::Standard, 10.0);
            let mut random = Random(i as u64);
            let n = case.shot.positions.len();
            case.shot.settings.light.direction = sun;
            // Of the particles some are beside it, before it and behind it, some out of the view.
            let center = scenes::world(&case.shot.camera, &[[0.3, -0.2, 5.0]])[0];
            case.shot.sun.region = Some(Region { center, radius: [3.0, 12.0][i % 2] });
            if i > 0 {
                let density = |i| match i % 9 {
                    0 => [0.0, -3.0, f32::NAN][i % 3],
                    _ => random.between(250.0, 1000.0),
                };
                case.shot.densities = Some((0..n).map(density).collect());
            }
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

/// A pool of the world with waves in it, as the sun sees it.
fn pool(sun: [f32; 3], wave: f32, drops: usize) -> Foamy {
    let s = 0.1_f32;
    let mut random = Random(3);
    let mut points = Vec::new();
    for (i, j, k) in (0..20).flat_map(|i| (0..20).flat_map(move |j| (0..4).map(move |k| (i, j, k))))
    {
        let at = |i: i32, random: &mut Random| s * (i as f32 - 9.5 + random.between(-0.2, 0.2));
        let (x, z) = (at(i, &mut random), at(j, &mut random));
        points.push([x, wave * (4.0 * x + 2.0 * z).sin() - s * k as f32, z]);
    }
    for _ in 0..drops {
        let mut at = |low, high| random.between(low, high);
        points.push([at(-0.9, 0.9), at(0.3, 0.9), at(-0.9, 0.9)]);
    }
    let mut shot = Shot::new(SIZE, Lens::Standard, 0.656 * s, &[]);
    shot.positions = points;
    shot.settings.light.direction = sun;
    shot.sun.region = Some(Region { center: [0.0, 0.1, 0.0], radius: 1.6 });
    water(shot)
}

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

/// Particles about a tilted ground of the world at a height; they are at 0.8 to 1.2.
fn grounded(lens: Lens, height: f64) -> Foamy {
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
    shot.settings.foam.shadow = 8.0;
    // Half precision does not hold these.
    shot.color.iter_mut().for_each(|c| *c = c.map(|v| v * 1.0309));
    shot.sun.region = Some(Region { center: [2.9, 0.7, 0.1], radius: 1.3 });
    let mut case = water(shot);
    for amount in case.amounts.iter_mut().step_by(3) {
        amount[0] = random.between(0.0, 1.0);
    }
    case
}

/// The scene's point in a pixel, and metres that it may be off: by the depth's quotient, whose
/// divisor is a difference, and by the way to the world.
pub fn seen(shot: &Shot, depth: f64, (x, y): (usize, usize)) -> (DVec3, f64) {
    let view = shot.view(SIZE);
    let back = view.view.inverse();
    let p = back.transform_point3(view.ray(x, y) * depth);
    let eye = back.w_axis.truncate().length();
    (p, U * (8.0 * depth + 2.0 * depth * depth / view.near() + 24.0 * (p.length() + 2.0 * eye)))
}

/// Pixels without fluid are the scene in the light that the maps leave, to half precision.
fn check_lit(name: &str, case: &Foamy, config: &Config, drawn: &Drawn, past: &Past<'_>) {
    let (shot, light, maps) = (&case.shot, twin(&case.shot, config), maps(drawn));
    let scene = shot.scene_eye();
    let foam = drawn.foam.as_ref().map(|foam| foam.seen(shot));
    let sun = &shot.settings.light;
    let (mut outside, mut darker, mut lighter, mut wrong) = (0, 0, 0, String::new());
    for (i, found) in drawn.output.data.iter().enumerate() {
        let (x, y) = (i % drawn.output.width, i / drawn.output.width);
        if drawn.depth.data[i] < 1e9 || foam.as_ref().is_some_and(|seen| seen.data[i].0 < 1e9) {
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
}

/// A number in half precision.
fn is_half(scene: f32, found: f32) -> bool {
    halves(f64::from(scene), f64::from(scene)).contains(&f64::from(found))
}

/// Where nothing casts within the maps the light is a mean of ones, whose weights are rounded.
fn is_nearly_half(scene: f32, found: f32) -> bool {
    let scene = f64::from(scene);
    let [low, high] = halves(scene * (1.0 - 16.0 * U), scene * (1.0 + 16.0 * U));
    (low..=high).contains(&f64::from(found))
}

/// The sun past the scene at a point, and in a pixel.
type Past<'a> = dyn Fn(DVec3, f64, (usize, usize)) -> Rounded + 'a;

#[test]
fn the_lit_scene_is_what_the_maps_say() {
    let gpu = Gpu::shared();
    for shading in [Shading::Raster, Shading::Compute] {
        for in_place in [true, false] {
            // No foam is seen beside its sprites.
            let config =
                Config { composite: Some(shading), in_place, thickness_level: 0, ..casting(64) };
            let mut rig = Rig::lit(&gpu, &config, 1);
            for (lens, height) in [
                (Lens::Standard, 0.4),
                (Lens::OffAxis, 0.4),
                (Lens::LeftHanded, 0.4),
                // What shows lies in the midst of what casts.
                (Lens::Standard, 1.0),
                (Lens::Infinite, 0.9),
            ] {
                let mut case = grounded(lens, height);
                // So dark that it shows, in one channel more than in the others.
                case.shot.settings.light.shade = [0.0, 0.875, 5.0];
                let drawn = case.draw(&mut rig);
                let name = format!("lit-{shading:?}-{in_place}-{lens:?}-{height}");
                check_lit(&name, &case, &config, &drawn, &|_, _, _| exact(1.0));
            }
            // Nothing casts: the scene, to half precision.
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

const SAMPLED: Access = Access::new(
    vk::PipelineStageFlags2::FRAGMENT_SHADER,
    vk::AccessFlags2::SHADER_SAMPLED_READ,
    vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
);

/// A host's shadows, as a mask or as a map.
pub fn shadows(rig: &Rig<'_>, kind: Shadows, texels: &Image<f32>) -> Texture {
    let size = extent(texels.width as u32, texels.height as u32);
    let bytes = bytemuck::cast_slice(&texels.data);
    let sampled = vk::ImageUsageFlags::SAMPLED;
    match kind {
        Shadows::Mask => rig.stub.uploaded(vk::Format::R32_SFLOAT, size, sampled, bytes, SAMPLED),
        Shadows::Map | Shadows::Convolution(_) => {
            let usage = sampled | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
            rig.stub.uploaded(vk::Format::D32_SFLOAT, size, usage, bytes, DEPTH)
        }
    }
}

/// A wall of foam that nothing shows through, of one colour in the sun.
pub fn wall(lens: Lens) -> Foamy {
    let block = scenes::block(3, 0.1, [44, 30, 3], [-2.2, -1.5, 2.0]);
    let mut case = water(Shot::new(SIZE, lens, 0.0656, &block));
    case.amounts.fill([1.0, 0.0]);
    let settings = &mut case.shot.settings;
    (settings.foam.relief, settings.foam.noise, settings.foam.veil) = (0.0, 0.0, 0.0);
    (settings.foam.extinction, settings.foam.front_extinction) = (1e5, 1e6);
    settings.foam.front_color = [0.9, 0.8, 0.7];
    settings.light.irradiance = [std::f32::consts::PI; 3];
    settings.light.shade = [0.0, 0.25 * std::f32::consts::PI, 0.5 * std::f32::consts::PI];
    case
}

/// The mean of the frontmost foam's nine depths a radius apart that lie on the surface of a pixel, and how
/// far off that makes a point; none where rounding decides which those are.
pub fn mean_depth(case: &Foamy, foam: &Image<f32>, (x, y): (usize, usize)) -> Option<(f64, f64)> {
    let (view, shot) = (case.shot.view(SIZE), &case.shot);
    let here = f64::from(foam.at(x, y));
    let step = f64::from(shot.settings.water.radius()) / (view.c_x() * here);
    let step = step.clamp(1.0, 32.0);
    let falloff = f64::from(shot.falloff());
    let (mut sum, mut count) = (0.0, 0.0);
    for i in 0..9_i32 {
        let mut at = [x, y];
        for (axis, by) in [(0, i % 3 - 1), (1, i / 3 - 1)] {
            let place = at[axis] as f64 + 0.5 + step * f64::from(by);
            if (place - place.round()).abs() < 32.0 * U * (1.0 + place.abs()) {
                return None;
            }
            let last = [foam.width, foam.height][axis] - 1;
            at[axis] = (place.max(0.0) as usize).min(last);
        }
        let off = f64::from(foam.at(at[0], at[1])) - here;
        if (off.abs() - falloff).abs() < 8.0 * U * (here + falloff) {
            return None;
        }
        if off.abs() < falloff {
            (sum, count) = (sum + off, count + 1.0);
        }
    }
    // Differences, their sums, a quotient and a sum; a ray is no longer than two of its depths here.
    Some((here + sum / count, 2.0 * 24.0 * U * (here + falloff)))
}

/// Opaque foam is as light as the sun on it; what part of the pixels is neither lit nor dark.
pub fn check_foam(
    name: &str,
    case: &Foamy,
    drawn: &Drawn,
    sun: impl Fn(DVec3, f64, (usize, usize)) -> [Rounded; 3],
) {
    let (settings, foam) = (&case.shot.settings, drawn.foam.as_ref().expect("foam"));
    let (mut seen_foam, mut kinds, mut wrong) = (0, [0; 3], String::new());
    for (i, found) in drawn.output.data.iter().enumerate() {
        let (x, y) = (i % drawn.output.width, i / drawn.output.width);
        let depth = f64::from(foam.depth.data[i]);
        if depth >= 1e9 || foam.thickness.data[i][1] < 1e-3 {
            continue;
        }
        // Which nine they are rounding may turn.
        let Some((depth, off_by)) = mean_depth(case, &foam.depth, (x, y)) else { continue };
        seen_foam += 1;
        let (p, by) = seen(&case.shot, depth, (x, y));
        let by = by + off_by;
        let sun = sun(p, by, (x, y));
        kinds[if sun[0].v < 0.05 { 0 } else { 1 + usize::from(sun[0].v > 0.95) }] += 1;
        for c in 0..3 {
            let (shade, most) = (settings.light.shade[c], settings.light.irradiance[c]);
            let white =
                f64::from(settings.foam.front_color[c]) * f64::from(most) / std::f64::consts::PI;
            let dark = off(f64::from(shade) / f64::from(most), 5.0);
            let expected = off(white, 40.0) * (dark + (exact(1.0) - dark) * sun[c]);
            let v = f64::from(found[c]);
            if (v - expected.v).abs() > expected.e + 40.0 * U {
                wrong += &format!("({x}, {y}) {c}: {v}, not {expected:?}, sun {:?}\n", sun[c]);
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{name}: {} lines\n{}",
        wrong.lines().count(),
        &wrong[..wrong.len().min(900)]
    );
    assert!(seen_foam > 3000 && kinds.iter().all(|n| *n > 40), "{name}: {seen_foam}, {kinds:?}");
}

#[test]
fn foam_is_in_the_shade_of_a_mask() {
    let gpu = Gpu::shared();
    for composite in [Shading::Raster, Shading::Compute] {
        let config = Config {
            cast: None,
            shadow: Some(Shadows::Mask),
            thickness_level: 0,
            composite: Some(composite),
            ..casting(16)
        };
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut random = Random(2);
        for (width, height) in [(97, 61), (13, 7), (200, 99)] {
            let mut case = wall(Lens::OffAxis);
            let mut whole = Image::new(width + 5, height + 3, 0.5_f32);
            whole.data.iter_mut().for_each(|v| *v = random.between(-0.5, 1.5));
            let image = shadows(&rig, Shadows::Mask, &whole);
            // A part of the image is meant.
            let mut host = image.host_image();
            host.rect.offset = vk::Offset2D { x: 2, y: 1 };
            host.rect.extent = extent(width as u32, height as u32);
            case.shot.sun.shadow =
                Some(Shadow { image: host, view_projection: Mat4::NAN, bias: f32::NAN });
            let drawn = case.draw(&mut rig);
            check_foam(&format!("mask-{composite:?}-{width}"), &case, &drawn, |_, _, (x, y)| {
                let part = |i: usize, texels: usize, pixels: u32| {
                    ((i as f64 + 0.5) / f64::from(pixels) * texels as f64).floor() as usize
                };
                let at = (part(x, width, SIZE.width), part(y, height, SIZE.height));
                let v = f64::from(whole.at(at.0 + 2, at.1 + 1)).clamp(0.0, 1.0);
                [exact(v); 3]
            });
        }
    }
}

/// Views of a light: parallel and not, standard depth and reversed.
pub fn light_views(sun: Vec3, at: Vec3) -> [(&'static str, Mat4, bool); 4] {
    let view = Mat4::look_at_rh(at + 6.0 * sun, at, Vec3::Y);
    let fov = 0.25_f32;
    [
        ("parallel", Mat4::orthographic_rh(-0.9, 0.9, -0.7, 0.7, 1.0, 11.0) * view, false),
        ("parallel-reversed", Mat4::orthographic_rh(-0.9, 0.9, -0.7, 0.7, 11.0, 1.0) * view, true),
        ("spot", Mat4::perspective_rh(fov, 1.2, 1.0, 11.0) * view, false),
        ("spot-reversed", Mat4::perspective_infinite_reverse_rh(fov, 1.2, 1.0) * view, true),
    ]
}

#[test]
fn foam_is_in_the_shade_of_a_map() {
    let gpu = Gpu::shared();
    let config =
        Config { cast: None, shadow: Some(Shadows::Map), thickness_level: 0, ..casting(16) };
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut case = wall(Lens::Standard);
    let at = Vec3::from(scenes::world(&case.shot.camera, &[[0.1, 0.1, 2.0]])[0]);
    // From behind the eye's shoulder.
    let from = Vec3::from(scenes::world(&case.shot.camera, &[[0.5, 0.7, 0.5]])[0]);
    let sun = (from - at).normalize();
    case.shot.settings.light.direction = sun.to_array();
    for (name, view_projection, reversed) in light_views(sun, at) {
        for bias in [0.0, 0.15_f32] {
            let depth = |along: f32| view_projection.project_point3(at + along * sun).z;
            let (before, behind) = (depth(0.6), depth(-0.6));
            let mut random = Random(4);
            let mut texels = Image::new(23, 17, 0.0_f32);
            // Blocks of shade and of sun, and texels about the wall itself.
            for (i, texel) in texels.data.iter_mut().enumerate() {
                let (x, y) = (i % 23 / 6, i / 23 / 5);
                *texel = match (x + y) % 3 {
                    0 => before,
                    1 => behind,
                    _ => random.between(before.min(behind), before.max(behind)),
                };
            }
            let image = shadows(&rig, Shadows::Map, &texels);
            let mut host = image.host_image();
            host.rect.offset = vk::Offset2D { x: 1, y: 2 };
            host.rect.extent = extent(21, 14);
            case.shot.sun.shadow = Some(Shadow { image: host, view_projection, bias });
            let part = Image::from_fn(21, 14, |x, y| texels.at(x + 1, y + 2));
            let map = ShadowMap {
                depth: &part,
                view_projection: view_projection.as_dmat4(),
                bias: f64::from(bias),
                sun: sun.as_dvec3(),
                reversed,
            };
            let drawn = case.draw(&mut rig);
            let name = format!("map-{name}-{bias}");
            check_foam(&name, &case, &drawn, |p, by, _| [map.past(p, by); 3]);
        }
    }
}

/// Foam in its own shadow and in that of water, by the light's maps, past a mask too.
#[test]
fn foam_is_in_its_own_shade() {
    let gpu = Gpu::shared();
    for shadow in [None, Some(Shadows::Mask)] {
        let config = Config { shadow, thickness_level: 0, sheets: 2, ..casting(64) };
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut case = wall(Lens::Standard);
        let texels = Image::from_vec(2, 1, vec![1.0, 0.25]).expect("two");
        let image = shadows(&rig, Shadows::Mask, &texels);
        let none = Shadow { image: image.host_image(), view_projection: Mat4::ZERO, bias: 0.0 };
        case.shot.sun.shadow = shadow.map(|_| none);
        // A lump between the wall and the sun, which is to the left of the view.
        let (at, from) = ([0.2, 0.0, 2.0], [-1.8, 0.6, 1.2]);
        let [at, from] = [at, from].map(|p| Vec3::from(scenes::world(&case.shot.camera, &[p])[0]));
        case.shot.settings.light.direction = (from - at).normalize().to_array();
        let lump = scenes::block(6, 0.1, [5, 5, 5], [-2.0, 0.3, 1.1]);
        let n = lump.len();
        case.shot.positions.extend(scenes::world(&case.shot.camera, &lump));
        case.amounts.extend((0..n).map(|i| [(i % 2) as f32, 0.0]));
        case.velocities.resize(case.shot.positions.len(), [0.0; 3]);
        case.shot.settings.foam.shadow = 6.0;
        case.shot.settings.water.medium =
            Medium::Physical { absorption: [9.0, 1.0, 0.5], scattering: [0.5, 0.25, 0.0] };
        let center = at.to_array();
        case.shot.sun.region = Some(Region { center, radius: 2.0 });
        let drawn = case.draw(&mut rig);
        let (light, maps) = (twin(&case.shot, &config), maps(&drawn));
        check_foam(&format!("own-{shadow:?}"), &case, &drawn, |p, by, (x, _)| {
            let past = if shadow.is_some() && 2 * x + 1 >= 97 { 0.25 } else { 1.0 };
            light.at(&maps, p, by).0.map(|v| exact(past) * v)
        });
    }
}

/// A mask and a map over what the fluid casts: where the scene is in shade nothing is darker.
#[test]
fn the_lit_scene_is_past_the_scene() {
    let gpu = Gpu::shared();
    for kind in [Shadows::Mask, Shadows::Map] {
        let config = Config { shadow: Some(kind), ..casting(64) };
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut case = grounded(Lens::Reversed, 0.4);
        case.shot.settings.light.shade = [0.0, 0.875, 5.0];
        let sun = Vec3::from(case.shot.settings.light.direction);
        let (name, view_projection, reversed) = light_views(sun, Vec3::new(2.7, 0.4, 0.0))[1];
        let texels = Image::from_fn(8, 8, |x, y| ((x * 5 + y * 3) % 7) as f32 / 6.0);
        let image = shadows(&rig, kind, &texels);
        let bias = 0.05;
        case.shot.sun.shadow = Some(Shadow { image: image.host_image(), view_projection, bias });
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

/// Everything that the sun does, of particles of all kinds.
pub fn everything(case: &mut Foamy) -> Config {
    let n = case.shot.positions.len();
    let mut random = Random(12);
    case.shot.densities = Some((0..n).map(|_| random.between(300.0, 1000.0)).collect());
    let center = scenes::world(&case.shot.camera, &[[0.0, 0.0, 5.0]])[0];
    case.shot.sun.region = Some(Region { center, radius: 6.0 });
    Config { spray: true, shadow: Some(Shadows::Mask), sheets: 2, ..casting(64) }
}

/// A mask that is the same all over.
pub fn even(rig: &Rig<'_>, sun: f32) -> (Texture, Shadow) {
    let image = shadows(rig, Shadows::Mask, &Image::new(3, 2, sun));
    let shadow = Shadow { image: image.host_image(), view_projection: Mat4::ZERO, bias: 0.0 };
    (image, shadow)
}

/// Sums in whole steps: neither maps nor pictures go by the order of the particles, bit for bit.
#[test]
fn the_order_of_particles_does_not_show_in_light() {
    let gpu = Gpu::shared();
    let mut case = Foamy::new(SIZE, Lens::Reversed, 30.0);
    let config = everything(&mut case);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let (_image, shadow) = even(&rig, 0.625);
    case.shot.sun.shadow = Some(shadow);
    let expected = case.draw(&mut rig);
    for seed in 0..3 {
        let drawn = permuted(&case, seed).draw(&mut rig);
        let (a, b) = (maps(&drawn), maps(&expected));
        compare::same("order-front", a.front, b.front);
        compare::same_color("order-thickness", a.thickness, b.thickness);
        compare::same("order-caustics", a.caustics, b.caustics);
        let spray = |drawn: &Drawn| drawn.lit_spray.clone().expect("spray");
        compare::same("order-spray", &spray(&drawn), &spray(&expected));
        compare::same_color("order-output", &drawn.output, &expected.output);
    }
}

/// Far from the region's middle what a texel holds times its distance has more digits than single
/// precision: it is what it is to a rounding an addend, the thickness itself bit for bit.
#[test]
fn the_order_of_particles_does_not_show_in_far_light() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &casting(64), 1);
    let mut case = pool(toward(0.2, 1.0, 0.1), 0.06, 12);
    case.shot.sun.region = Some(Region { center: [0.0, 40.0, 0.0], radius: 45.0 });
    let expected = case.draw(&mut rig);
    for seed in 0..3 {
        let drawn = permuted(&case, seed).draw(&mut rig);
        let mut differ = 0;
        for (a, b) in maps(&drawn).thickness.data.iter().zip(&maps(&expected).thickness.data) {
            assert_eq!(a[..2], b[..2]);
            differ += usize::from(a != b);
            let most = U * case.shot.positions.len() as f64 * f64::from(b[2].abs());
            assert!(f64::from((a[2] - b[2]).abs()) <= most, "{a:?}, not {b:?}");
        }
        if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
            eprintln!("order-far: {differ} texels differ");
        }
    }
}

/// The same particles in another order.
fn permuted(case: &Foamy, seed: u64) -> Foamy {
    let order = Random(seed).order(case.shot.positions.len());
    fn turn<T: Copy>(all: &[T], order: &[usize]) -> Vec<T> {
        order.iter().map(|i| all[*i]).collect()
    }
    let mut other = case.clone();
    other.shot.positions = turn(&case.shot.positions, &order);
    other.shot.densities = case.shot.densities.as_ref().map(|d| turn(d, &order));
    other.amounts = turn(&case.amounts, &order);
    other.velocities = turn(&case.velocities, &order);
    other.ids = case.ids.as_ref().map(|ids| turn(ids, &order));
    other
}

/// What of the spray the sun lights: all of it, nothing, or of each droplet the same part.
#[test]
fn spray_is_lit_by_the_sun_that_comes() {
    let gpu = Gpu::shared();
    let mut case = Foamy::new(SIZE, Lens::Standard, 10.0);
    let config = Config { cast: None, ..everything(&mut case) };
    case.shot.sun.region = None;
    // So few that no two droplets share a pixel often.
    case.shot.settings.spray.droplets = 1;
    let mut rig = Rig::lit(&gpu, &config, 1);
    let draw = |case: &mut Foamy, rig: &mut Rig<'_>, sun| {
        let (_image, shadow) = even(rig, sun);
        case.shot.sun.shadow = Some(shadow);
        let drawn = case.draw(rig);
        (drawn.spray.expect("spray"), drawn.lit_spray.expect("spray"), drawn.output)
    };
    let (all, lit, bright) = draw(&mut case, &mut rig, 1.0);
    compare::same("spray-in-the-sun", &lit, &all);
    let (same, lit, dark) = draw(&mut case, &mut rig, 0.0);
    compare::same("spray", &same, &all);
    assert!(lit.data.iter().all(|l| *l == 0.0), "spray in the shade is lit");
    let darker = dark.data.iter().zip(&bright.data).filter(|(d, b)| d[0] < b[0]).count();
    assert!(darker > 50, "{darker} pixels are darker in the shade");
    let (_, lit, _) = draw(&mut case, &mut rig, 0.25);
    let mut some = 0;
    for (lit, all) in lit.data.iter().zip(&all.data) {
        // Each droplet to the nearest step, of which ten at most share a pixel.
        assert!((lit - 0.25 * all).abs() <= 10.0 * 0.75 / 512.0, "{lit} of {all}");
        some += usize::from(*lit > 0.02);
    }
    assert!(some > 50, "{some} pixels with spray");
}

/// Frames of one pixel, of odd sizes and within a wider image.
#[test]
fn light_on_frames_of_any_size() {
    let gpu = Gpu::shared();
    for (width, height) in [(1, 1), (1, 7), (17, 33), (130, 9)] {
        for composite in [Shading::Raster, Shading::Compute] {
            let size = extent(width, height);
            let mut case = Foamy::new(size, Lens::Reversed, 20.0);
            case.shot.margin = [3, 1, 2, 4];
            let config =
                Config { extent: size, composite: Some(composite), ..everything(&mut case) };
            let mut rig = Rig::lit(&gpu, &config, 1);
            let (_image, shadow) = even(&rig, 0.5);
            case.shot.sun.shadow = Some(shadow);
            case.draw(&mut rig);
            (case.shot.positions, case.amounts, case.velocities) = Default::default();
            (case.ids, case.shot.densities) = (None, None);
            let drawn = case.draw(&mut rig);
            for (found, scene) in drawn.output.data.iter().zip(&case.shot.color) {
                let near = scene.iter().zip(found).all(|(c, found)| is_nearly_half(*c, *found));
                assert!(near, "{found:?}, not {scene:?}");
            }
            let around = crate::support::rig::AROUND;
            assert!(drawn.whole.data.iter().filter(|c| **c == around).count() > 8);
        }
    }
}

/// Where the sun does not come, neither its highlight on water nor the relief of foam is seen.
#[test]
fn highlights_and_relief_are_the_suns() {
    let gpu = Gpu::shared();
    let config = Config { shadow: Some(Shadows::Mask), foam: true, sheets: 2, ..config(SIZE) };
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut case = Foamy::new(SIZE, Lens::Standard, 0.0);
    // A pane behind them all: the farther sheet shines too.
    let pane = scenes::block(3, 0.3, [40, 28, 3], [-6.0, -4.2, 12.0]);
    case.shot.positions.extend(scenes::world(&case.shot.camera, &pane));
    case.amounts.resize(case.shot.positions.len(), [0.0; 2]);
    case.velocities.resize(case.shot.positions.len(), [0.0; 3]);
    case.ids = None;
    case.amounts.iter_mut().step_by(2).for_each(|amount| amount[0] = 0.0);
    let view = case.shot.camera_view().inverse();
    // From behind the eye: the spheres shine in their middle.
    let sun = view.transform_vector3(DVec3::new(0.1, 0.2, 1.0)).normalize();
    case.shot.settings.light.direction = sun.as_vec3().to_array();
    for (lit, seen) in [(1.0, true), (0.0, false)] {
        let (_texture, shadow) = even(&rig, lit);
        case.shot.sun.shadow = Some(shadow);
        let mut drawn = |specular: f32, relief: f32| {
            case.shot.settings.water.specular = specular;
            case.shot.settings.foam.relief = relief;
            case.draw(&mut rig).output.data
        };
        let [plain, shining, raised] = [drawn(0.0, 0.0), drawn(1.0, 0.0), drawn(0.0, 0.6)];
        assert_eq!(plain != shining, seen, "highlights, sun {lit}");
        assert_eq!(plain != raised, seen, "relief, sun {lit}");
    }
}
