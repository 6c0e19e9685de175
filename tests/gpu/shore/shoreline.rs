//! Compares the amount of shore foam per pixel, from pass `shoreline`, with its CPU twin.

use ash::vk;
use glam::{DVec2, DVec3, Mat4, Vec3};
use whitewater::shore::{Area, Edge, Noise, ShoreSettings, ShorelineSettings, TextureLayer};
use whitewater::{Shore, Shoreline, Surface};

use super::{Mapped, Tally, is_shared, look_of, shared_at, textures, water, with_shore};
use crate::reference::Image;
use crate::reference::shore::foam::{Pixel, by_samples, clipped, coordinate, covered, shoreline};
use crate::reference::shore::map::Map;
use crate::reference::shore::{Bounded, U, Water, exact};
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::Lens;

/// Ground height relative to the water; 0 along a bent shore line.
fn land(at: DVec2) -> f64 {
    let to = at - DVec2::new(7.0, -5.0);
    let round = to.length() * (1.0 + 0.2 * (3.0 * to.y.atan2(to.x)).sin());
    0.4 * (4.0 - round)
}

/// Samples a height function at the texel centres of an area.
pub fn heights(area: &Area, size: u32, height: impl Fn(DVec2) -> f64) -> Image<f32> {
    let [x0, y0] = area.corner(size).map(f64::from);
    let texel = f64::from(area.edge) / f64::from(size);
    let mut image = Image::new(size as usize, size as usize, 0.0);
    for y in 0..size as usize {
        for x in 0..size as usize {
            let at = DVec2::new(x0, y0) + texel * DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            *image.at_mut(x, y) = height(at) as f32;
        }
    }
    image
}

/// The distance map of a bent shore line.
fn shore_distances(gpu: &Gpu) -> Mapped<'_> {
    let mut coasts = Mapped::new(gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, land), None);
    coasts
}

/// Only the foam texture, without noise and waves.
pub fn web_alone(reach: [f32; 2], layers: [TextureLayer; 4]) -> ShorelineSettings {
    ShorelineSettings::default().with(|it| {
        [it.sea_reach, it.land_reach] = reach;
        it.wave_weight = 0.0;
        it.texture_weight = 1.0;
        [it.texture_slope, it.texture_offset] = [0.0; 2];
        it.threshold = 0.5;
        it.threshold_noise = Noise::NONE;
        it.rise_noise = Noise::NONE;
        it.frequency_noise = Noise::NONE;
        it.speed_noise = Noise::NONE;
        it.texture_warp = Noise::NONE;
        it.layers = layers;
    })
}

pub const AREA: Area =
    Area { up: [0.0, 1.0, 0.0], center: [7.0, -5.0], edge: 32.0, level: 0.0, reach: 8.0 };

/// Two noise look-ups and two texture layers, which the simpler of the two pipelines can draw.
pub fn plain() -> ShoreSettings {
    let noise = |amplitude, scale| Noise { amplitude, scale };
    let layer = |weight, scale, angle, speed| TextureLayer { weight, scale, angle, speed };
    let shoreline = ShorelineSettings::default().with(|it| {
        [it.sea_reach, it.land_reach] = [3.0, 1.5];
        it.frequency = 9.0;
        it.frequency_noise = noise(2.0, 1.0 / 30.0);
        it.speed_noise = noise(0.35, 1.0 / 30.0);
        it.threshold_noise = noise(0.14, 1.0 / 30.0);
        it.rise_noise = noise(0.2, 1.0 / 30.0);
        it.texture_warp = noise(0.4, 1.0 / 17.0);
        it.layers = [
            layer(0.62, 1.0 / 6.0, 0.0, [0.12, 0.07]),
            layer(0.38, 1.0 / 3.7, 37.0, [-0.1, 0.13]),
            TextureLayer::NONE,
            TextureLayer::NONE,
        ];
    });
    ShoreSettings::default().with(|it| {
        it.time = 12.75;
        it.shoreline = shoreline;
    })
}

/// All noises and texture layers, which need the general pipeline.
fn rich() -> ShoreSettings {
    let mut look = plain();
    let noise = |amplitude, scale| Noise { amplitude, scale };
    let s = &mut look.shoreline;
    s.warp = noise(0.9, 1.0 / 11.0);
    s.frequency_noise = noise(2.0, 1.0 / 23.0);
    s.threshold_noise = noise(0.2, 1.0 / 8.0);
    s.rise_noise = noise(0.2, 1.0 / 13.0);
    s.floor = Some(-0.3);
    s.layers[2] = TextureLayer { weight: 0.3, scale: 0.5, angle: -110.0, speed: [0.3, 0.0] };
    s.layers[3] = TextureLayer { weight: 0.2, scale: 0.9, angle: 200.0, speed: [0.0, 0.2] };
    look
}

/// Shore coordinate v at a place, from the four texels of the map around it, and its change per
/// pixel. v may lie outside 0 to 2. None if rounding decides which texels these are.
fn v_by_map(
    (map, area): (&Map, &Area),
    look: &ShorelineSettings,
    place: [Bounded; 2],
    across: [[Bounded; 2]; 2],
) -> Option<(Bounded, [Bounded; 2])> {
    let size = map.width as u32;
    let edge = f64::from(area.edge) / f64::from(size);
    let texels = Map::texels(place, area.corner(size).map(f64::from), edge);
    if !map.inside(texels)? {
        return Some((exact(0.0), [exact(0.0); 2]));
    }
    let reach = [look.sea_reach, look.land_reach].map(f64::from);
    let distance = map.at(texels, false);
    let v = coordinate(distance, reach);
    let slope = map.slope(texels).map(|s| s / edge);
    let parts = reach.map(|r| 1.0 / r);
    let own = if distance.value < 0.0 { parts[0] } else { parts[1] };
    let either = distance.low() < 0.0 && distance.high() >= 0.0;
    let part = if either {
        Bounded::between(parts[0].min(parts[1]), own, parts[0].max(parts[1]))
    } else {
        exact(own).wider(U * own)
    };
    let dv = across.map(|way| (slope[0] * way[0] + slope[1] * way[1]) * part);
    Some((v, dv))
}

/// What a pixel sees of the water level with a map. None if the pixel does not see the level, or if
/// rounding decides that.
pub fn pixel_by_map(
    shot: &Shot,
    water: &Water,
    of: (&Map, &Area),
    at: [usize; 2],
) -> Option<Pixel> {
    let (place, off) = shared_at(is_shared(shot), at);
    let point = water.at(place);
    if point.depth.low() <= 0.0 {
        return None;
    }
    let (v, dv) = v_by_map(of, &shot.settings.shore.shoreline, point.place, point.change)?;
    Some(Pixel { off, place: point.place, v, across: point.change, dv })
}

/// Amount of foam in a pixel by the twin. None if rounding decides.
pub fn amount(look: &ShoreSettings, edge: Edge, pixel: &Pixel, at: [usize; 2]) -> Option<Bounded> {
    let [noise, web] = textures();
    let v = pixel.own_v();
    if v.high() <= 0.0 || v.low() >= 2.0 {
        return Some(exact(0.0));
    }
    let foam = shoreline(&look_of(look), noise, web, pixel);
    let part = match edge {
        Edge::Clip => exact(f64::from(u8::from(clipped(foam.over)?))),
        Edge::Smooth => covered(foam.over, foam.variance, foam.change),
        Edge::Coverage => by_samples(covered(foam.over, foam.variance, foam.change), at),
    };
    let ends = v.low() <= 0.0 || v.high() >= 2.0;
    Some(if ends { Bounded::between(0.0, part.value, part.high()) } else { part })
}

/// Gives the shot the water level and its distance map.
fn with_map(coasts: &Mapped<'_>, shot: &mut Shot, look: &ShoreSettings) {
    let line = Some(Shoreline::Map(coasts.shore_distances()));
    shot.shore = Some(Shore::new(AREA.level).with(|it| it.shoreline = line));
    shot.settings.shore = *look;
}

fn compared(name: &str, rig: &mut Rig<'_>, shot: &Shot, map: &Map, edge: Edge) -> Tally {
    let found = rig.draw(shot).shore.expect("shoreline foam");
    let water = water(shot, DVec3::Y, f64::from(AREA.level));
    let look = &shot.settings.shore;
    let expected = Image::from_fn(found.width, found.height, |x, y| {
        let point = water.at([x as f64 + 0.5, y as f64 + 0.5]);
        if point.depth.low() <= 0.0 {
            return (point.depth.high() < 0.0).then_some(exact(0.0));
        }
        amount(look, edge, &pixel_by_map(shot, &water, (map, &AREA), [x, y])?, [x, y])
    });
    let mut tally = Tally::default();
    for y in 0..found.height {
        for x in 0..found.width {
            if let Some(expected) = expected.at(x, y) {
                tally.add((x, y), found.at(x, y)[0], expected);
            }
        }
    }
    println!("{name}: {} of {} pixels are told", tally.compared, found.data.len());
    tally
}

/// The distances that the GPU found; the tests of pass `map` check them.
pub fn twin_map(coasts: &Mapped<'_>) -> Map {
    let found = coasts.distances();
    let values = found.data.iter().map(|v| exact(f64::from(*v))).collect();
    Map { width: found.width, height: found.height, values }
}

#[test]
fn a_level_s_foam_is_the_twin_s() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let coasts = shore_distances(&gpu);
    let map = twin_map(&coasts);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    for (name, lens, look) in [
        ("plain", Lens::Standard, plain()),
        ("rich", Lens::Reversed, rich()),
        ("plain-infinite", Lens::ReversedInfinite, plain()),
        ("rich-left", Lens::LeftHanded, rich()),
        ("plain-off", Lens::OffAxis, plain()),
    ] {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        with_map(&coasts, &mut shot, &look);
        compared(name, &mut rig, &shot, &map, Edge::Smooth).check(name, 100, 0.05);
    }
}

/// The same frame drawn by the general pipeline, which a scene depth of another size selects.
fn generally(shot: &Shot) -> Shot {
    let mut other = shot.clone();
    let vk::Extent2D { width, height } = shot.size;
    other.depth_extent = extent(width / 2, height / 2);
    other.scene_depth(|_, _| None);
    other
}

/// Mean and max difference between the foam of two pictures, in steps of 1/255.
fn apart(a: &Image<[u8; 4]>, b: &Image<[u8; 4]>) -> (f64, u8) {
    let steps = || a.data.iter().zip(&b.data).map(|(a, b)| a[0].abs_diff(b[0]));
    (steps().map(f64::from).sum::<f64>() / a.data.len() as f64, steps().max().unwrap_or(0))
}

/// The simpler pipeline shades pixels in pairs and shares values that change linearly. Seen
/// straight from above, with a straight shore and no noise, this is exact, so both pipelines give
/// the same foam.
#[test]
fn both_pipelines_draw_the_same() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut coasts = Mapped::new(&gpu, 64);
    // The line lies between two columns of the map, so all distances are exact numbers.
    coasts.image_step(&AREA, &heights(&AREA, 64, |at| 0.4 * (at.x - 7.0)), None);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let mut shot = Shot::new(size, Lens::ReversedInfinite, 0.1, &[]);
    shot.camera.view =
        Mat4::look_to_rh(Vec3::new(7.0, 20.0, -5.0), Vec3::NEG_Y, Vec3::Z).to_cols_array_2d();
    let mut look = plain();
    let s = &mut look.shoreline;
    for noise in [
        &mut s.frequency_noise,
        &mut s.speed_noise,
        &mut s.threshold_noise,
        &mut s.rise_noise,
        &mut s.texture_warp,
    ] {
        *noise = Noise::NONE;
    }
    // v is linear through the shore line if both reaches are equal.
    [s.sea_reach, s.land_reach] = [4.0; 2];
    with_map(&coasts, &mut shot, &look);
    let together = rig.draw(&shot).shore.expect("shoreline foam");
    let alone = rig.draw(&generally(&shot)).shore.expect("shoreline foam");
    let partial = together.data.iter().filter(|c| (3..252).contains(&c[0])).count();
    let (mean, most) = apart(&together, &alone);
    println!("{partial} pixels in between: {mean:.5} steps in the mean, {most} at most");
    assert!(partial > 300, "{partial} pixels in between");
    // The two ways round differently, by much less than a step; a value may still round to the next
    // one.
    assert!(most <= 1, "{most} steps");
}

/// With a bent shore and noise, each pipeline agrees with its own definition, and their mean
/// difference is small: at borders of foam the shared values miss what is not linear in noise and
/// distance.
#[test]
fn what_is_shared_changes_little() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let coasts = shore_distances(&gpu);
    let map = twin_map(&coasts);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    with_map(&coasts, &mut shot, &plain());
    let other = generally(&shot);
    compared("together", &mut rig, &shot, &map, Edge::Smooth).check("together", 100, 0.05);
    compared("alone", &mut rig, &other, &map, Edge::Smooth).check("alone", 100, 0.05);
    let few = rig.draw(&shot).shore.expect("shoreline foam");
    let all = rig.draw(&other).shore.expect("shoreline foam");
    let covers =
        few.data.iter().map(|c| f64::from(c[0])).sum::<f64>() / (255.0 * few.data.len() as f64);
    let foamy = few.data.iter().filter(|c| c[0] > 0).count();
    let (mean, most) = apart(&few, &all);
    let worst = few.data.iter().zip(&all.data).position(|(a, b)| a[0].abs_diff(b[0]) == most);
    let at = worst.map(|i| (i % few.width, i / few.width));
    println!(
        "of {covers:.4} covered {:.5} in the mean, {most} steps at most, {at:?}",
        mean / 255.0
    );
    assert!(foamy > 500, "{foamy}");
    assert!(mean / 255.0 < 0.1 * covers, "{mean} steps of {covers}");
}

/// Objects in front of the water's surface hide its foam, objects behind do not.
#[test]
fn what_stands_before_the_surface_hides_its_foam() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let coasts = shore_distances(&gpu);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    with_map(&coasts, &mut shot, &plain());
    let few = rig.draw(&shot).shore.expect("shoreline foam");
    for (at, seen) in [(0.3, false), (1.0e3, true)] {
        shot.scene_depth(|_, _| Some(at));
        let found = rig.draw(&shot).shore.expect("shoreline foam");
        let some = found.data.iter().any(|c| c[0] > 0);
        assert_eq!(some, seen, "a wall at {at}");
    }
    let water = water(&shot, DVec3::Y, 0.0);
    let mut half = shot.clone();
    half.scene_depth(|x, _| (x < 48).then_some(0.3));
    let found = rig.draw(&half).shore.expect("shoreline foam");
    for (i, (own, whole)) in found.data.iter().zip(&few.data).enumerate() {
        let hidden = i % 96 < 48
            && water.at([(i % 96) as f64 + 0.5, (i / 96) as f64 + 0.5]).depth.value > 0.3;
        assert_eq!(own[0], if hidden { 0 } else { whole[0] }, "{i}");
    }
}

/// With `Clip` a pixel is foam or not; with `Coverage` it has a multiple of a quarter.
#[test]
fn edges_are_clipped_or_of_quarters() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let coasts = shore_distances(&gpu);
    let map = twin_map(&coasts);
    for edge in [Edge::Clip, Edge::Coverage] {
        let mut rig = Rig::new(&gpu, &with_shore(size, edge));
        for look in [plain(), rich()] {
            let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
            with_map(&coasts, &mut shot, &look);
            let name = format!("{edge:?}");
            let tally = compared(&name, &mut rig, &shot, &map, edge);
            assert!(tally.compared > 5800, "{name}: {} pixels are told", tally.compared);
            tally.check(&name, if edge == Edge::Clip { 0 } else { 300 }, 0.1);
            let found = rig.draw(&shot).shore.expect("shoreline foam");
            let values = found.data.iter().map(|c| c[0]);
            let steps: &[u8] =
                if edge == Edge::Clip { &[0, 255] } else { &[0, 64, 127, 128, 191, 255] }; // half of 255 either way
            assert!(values.into_iter().all(|v| steps.contains(&v)), "{name}");
        }
    }
}

/// After a period the foam is the same again. After a long time it is as sharp and moves as fast as
/// at the start.
#[test]
fn time_goes_round_and_nothing_grows() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let coasts = shore_distances(&gpu);
    let map = twin_map(&coasts);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    let mut at = |time: f64, period: Option<f32>| {
        with_map(
            &coasts,
            &mut shot,
            &plain().with(|it| {
                it.time = time;
                it.period = period;
            }),
        );
        compared(&format!("at {time}"), &mut rig, &shot, &map, Edge::Smooth)
            .check("time", 100, 0.05);
        rig.draw(&shot).shore.expect("shoreline foam")
    };
    let [first, half, again, long] =
        [(2.25, 8.0), (6.25, 8.0), (10.25, 8.0), (8.0e6 + 2.25, 8.0)].map(|(t, p)| at(t, Some(p)));
    assert_eq!(first.data, again.data);
    assert_eq!(first.data, long.data);
    let differ = |a: &Image<[u8; 4]>, b: &Image<[u8; 4]>| {
        let off = a.data.iter().zip(&b.data).map(|(a, b)| f64::from(a[0].abs_diff(b[0])));
        off.sum::<f64>() / (255.0 * a.data.len() as f64)
    };
    assert!(differ(&first, &half) > 0.01, "half a period on it is another");
    // Mean change in a sixtieth of a second, over eight times of a wave's swing, from three start
    // times.
    let mut drawn = |time: f64| {
        with_map(&coasts, &mut shot, &plain().with(|it| it.time = time));
        rig.draw(&shot).shore.expect("shoreline foam")
    };
    let [early, late, latest] = [0.0, 1.0e3, 1.0e7].map(|from| {
        let changes = (0..8).map(|i| {
            let time = from + 1.3 * f64::from(i);
            differ(&drawn(time), &drawn(time + 1.0 / 60.0)) / 8.0
        });
        changes.sum::<f64>()
    });
    println!("a sixtieth of a second changes {early:.5}, {late:.5}, {latest:.5}");
    // The eight times are other phases of the swing for each start.
    assert!([late, latest].iter().all(|c| (0.4..2.5).contains(&(c / early))));
}

/// A surface of any shape that is given by its depth per pixel, and a world whose up axis is z.
#[test]
fn a_shaped_surface_s_foam_is_the_twin_s() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let coasts = shore_distances(&gpu);
    let map = twin_map(&coasts);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    for lens in [Lens::Standard, Lens::ReversedInfinite] {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        // The level with waves.
        let view = shot.view(size);
        let level = water(&shot, DVec3::Y, 0.0);
        let mut other = shot.clone();
        other.scene_depth(|x, y| {
            let at = [f64::from(x) + 0.5, f64::from(y) + 0.5];
            let z = level.at(at).depth.value;
            (z > 0.0 && z < 60.0).then(|| z * (1.0 + 0.02 * (0.3 * at[0]).sin()))
        });
        let (_color, depth) = rig.scene(&other);
        let line = Some(Shoreline::Map(coasts.shore_distances()));
        let surface = Some(Surface::Depth(depth.host_image()));
        shot.shore = Some(Shore::new(0.0).with(|it| {
            it.surface = surface;
            it.shoreline = line;
        }));
        shot.settings.shore = plain();
        let found = rig.draw(&shot).shore.expect("shoreline foam");
        let mut tally = Tally::default();
        let numbers = [view.projection.w_axis.z, view.projection.z_axis.z];
        for y in 0..found.height {
            for x in 0..found.width {
                let device = f64::from(other.depth[y * found.width + x]);
                let z = exact(numbers[0]) / (exact(device) + numbers[1]);
                if !(z.low() > 0.0 && z.high() < 90.0) {
                    continue;
                }
                let point = level.at_depth(level.ray([x as f64 + 0.5, y as f64 + 0.5]), z);
                let look = &shot.settings.shore;
                let of = (&map, &AREA);
                let Some((v, dv)) = v_by_map(of, &look.shoreline, point.place, point.change) else {
                    continue;
                };
                let (place, across) = (point.place, point.change);
                let pixel = Pixel { off: [0.0; 2], place, v, across, dv };
                if let Some(expected) = amount(look, Edge::Smooth, &pixel, [x, y]) {
                    tally.add((x, y), found.at(x, y)[0], expected);
                }
            }
        }
        tally.check(&format!("shaped-{lens:?}"), 100, 0.05);
    }
}

/// Rotates the world so that `up` is its up axis. Returns the rotation too.
fn turned(shot: &Shot, up: DVec3) -> (Shot, glam::DQuat) {
    let turn = glam::DQuat::from_rotation_arc(DVec3::Y, up);
    let mut other = shot.clone();
    let view = shot.camera.view_matrix().as_dmat4() * glam::DMat4::from_quat(turn.inverse());
    other.camera.view = view.as_mat4().to_cols_array_2d();
    (other, turn)
}

#[test]
fn up_may_be_any_axis() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut coasts = Mapped::new(&gpu, 64);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    for up in [DVec3::Z, DVec3::X, DVec3::new(0.36, 0.48, 0.8)] {
        let up = up.normalize();
        let (mut shot, _) = turned(&Shot::new(size, Lens::Standard, 0.1, &[]), up);
        let water = water(&shot, up, 0.0);
        // The area is centred where the camera looks.
        let middle = water.at([48.0, 40.0]).place.map(|p| p.value as f32);
        let area = Area { up: up.as_vec3().to_array(), center: middle, ..AREA };
        let [x, y] = middle.map(f64::from);
        let round = |at: DVec2| 0.4 * (3.0 - (at - DVec2::new(x, y)).length());
        coasts.image_step(&area, &heights(&area, 64, round), None);
        let map = twin_map(&coasts);
        let line = Some(Shoreline::Map(coasts.shore_distances()));
        shot.settings.up = area.up;
        shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = line));
        shot.settings.shore = plain();
        let found = rig.draw(&shot).shore.expect("shoreline foam");
        let look = &shot.settings.shore;
        let mut tally = Tally::default();
        for i in 0..found.data.len() {
            let (x, y) = (i % found.width, i / found.width);
            let point = water.at([x as f64 + 0.5, y as f64 + 0.5]);
            if point.depth.low() <= 0.0 {
                continue;
            }
            let told = pixel_by_map(&shot, &water, (&map, &area), [x, y]);
            let Some(pixel) = told else { continue };
            if let Some(expected) = amount(look, Edge::Smooth, &pixel, [x, y]) {
                tally.add((x, y), found.data[i][0], expected);
            }
        }
        tally.check(&format!("up {up}"), 100, 0.05);
    }
}

/// Foam more than a kilometre away is the same in metres and in about millimetres. A power of two as
/// the ratio of the units scales all lengths without rounding.
#[test]
fn far_foam_is_the_same_in_millimetres() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut coasts = Mapped::new(&gpu, 64);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let drawn = |units: f32| {
        let [far, edge, reach] = [1300.0, 900.0, 400.0].map(|metres| metres * units);
        let area = Area { center: [0.0, -far], edge, reach, ..AREA };
        let land = |at: DVec2| -0.3 * (at.y + f64::from(far));
        coasts.image_step(&area, &heights(&area, 64, land), None);
        let mut shot = Shot::new(size, Lens::ReversedInfinite, 0.1, &[]);
        let (eye, along) = (Vec3::new(0.0, 300.0 * units, 0.0), Vec3::new(0.0, -0.2, -1.0));
        shot.camera.view = Mat4::look_to_rh(eye, along.normalize(), Vec3::Y).to_cols_array_2d();
        let mut look = plain();
        let s = &mut look.shoreline;
        ([s.sea_reach, s.land_reach], s.threshold) = ([400.0; 2], -0.3);
        with_map(&coasts, &mut shot, &look.in_units(units));
        rig.draw(&shot).shore.expect("shoreline foam")
    };
    let [metres, millimetres] = [1.0, 1024.0].map(drawn);
    let foam = metres.data.iter().filter(|texel| texel[0] > 0).count();
    let (mean, most) = apart(&metres, &millimetres);
    println!("{foam} pixels with foam: {mean:.5} steps in the mean, {most} at most");
    assert!(foam > 100, "{foam} pixels with foam");
    assert!(most <= 1, "{most} steps");
}
