//! Pass `shoreline`: how much foam a pixel has along shores, against the twin.

use glam::{DVec2, DVec3};
use whitewater::shore::{Area, Edge, Noise, ShoreLook, ShorelineLook, WebLayer};
use whitewater::{Shore, Shoreline, Surface};

use super::{Mapped, Tally, look_of, textures, water, with_shore};
use crate::reference::Image;
use crate::reference::shore::foam::{Pixel, by_samples, clipped, coordinate, covered, shoreline};
use crate::reference::shore::map::Map;
use crate::reference::shore::{Bounded, U, exact};
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::Lens;

/// A height that is 0 along a bent line.
fn land(at: DVec2) -> f64 {
    let to = at - DVec2::new(7.0, -5.0);
    let round = to.length() * (1.0 + 0.2 * (3.0 * to.y.atan2(to.x)).sin());
    0.4 * (4.0 - round)
}

/// Heights over an area, one a texel.
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

pub const AREA: Area =
    Area { up: [0.0, 1.0, 0.0], center: [7.0, -5.0], edge: 32.0, level: 0.0, reach: 8.0 };

/// Two looks into the noise, two layers: what a frame of the less general kind has.
pub fn plain() -> ShoreLook {
    let noise = |amplitude, scale| Noise { amplitude, scale };
    let layer = |weight, scale, angle, speed| WebLayer { weight, scale, angle, speed };
    let shoreline = ShorelineLook {
        reach: [3.0, 1.5],
        frequency: 9.0,
        frequency_noise: noise(2.0, 1.0 / 30.0),
        speed_noise: noise(0.35, 1.0 / 30.0),
        threshold_noise: noise(0.14, 1.0 / 30.0),
        rise_noise: noise(0.2, 1.0 / 30.0),
        web_warp: noise(0.4, 1.0 / 17.0),
        layers: [
            layer(0.62, 1.0 / 6.0, 0.0, [0.12, 0.07]),
            layer(0.38, 1.0 / 3.7, 37.0, [-0.1, 0.13]),
            WebLayer::NONE,
            WebLayer::NONE,
        ],
        ..ShorelineLook::default()
    };
    ShoreLook { time: 12.75, shoreline, ..ShoreLook::default() }
}

/// All there is.
fn rich() -> ShoreLook {
    let mut look = plain();
    let noise = |amplitude, scale| Noise { amplitude, scale };
    let s = &mut look.shoreline;
    s.warp = noise(0.9, 1.0 / 11.0);
    s.frequency_noise = noise(2.0, 1.0 / 23.0);
    s.threshold_noise = noise(0.2, 1.0 / 8.0);
    s.rise_noise = noise(0.2, 1.0 / 13.0);
    s.floor = Some(-0.3);
    s.layers[2] = WebLayer { weight: 0.3, scale: 0.5, angle: -110.0, speed: [0.3, 0.0] };
    s.layers[3] = WebLayer { weight: 0.2, scale: 0.9, angle: 200.0, speed: [0.0, 0.2] };
    look
}

/// The four texels of the map about a place as v, and its change a pixel.
fn v_by_map(
    (map, area, size): (&Map, &Area, u32),
    look: &ShorelineLook,
    place: [Bounded; 2],
    across: [[Bounded; 2]; 2],
) -> Option<(Bounded, [Bounded; 2])> {
    let edge = f64::from(area.edge) / f64::from(size);
    let texels = Map::texels(place, area.corner(size).map(f64::from), edge);
    if !map.inside(texels)? {
        return Some((exact(0.0), [exact(0.0); 2]));
    }
    let reach = look.reach.map(f64::from);
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
    Some((v.clamp(0.0, 2.0), dv))
}

/// How much of a pixel is foam by the twin; none where rounding decides.
pub fn amount(look: &ShoreLook, edge: Edge, pixel: &Pixel, at: [usize; 2]) -> Option<Bounded> {
    let [noise, web] = textures();
    if pixel.v.high() <= 0.0 || pixel.v.low() >= 2.0 {
        return Some(exact(0.0));
    }
    let foam = shoreline(&look_of(look), noise, web, pixel);
    let part = match edge {
        Edge::Clip => exact(f64::from(u8::from(clipped(foam.over)?))),
        Edge::Smooth => covered(foam.over, foam.variance, foam.change),
        Edge::Coverage => by_samples(covered(foam.over, foam.variance, foam.change), at),
    };
    let ends = pixel.v.low() <= 0.0 || pixel.v.high() >= 2.0;
    Some(if ends { Bounded::between(0.0, part.value, part.high()) } else { part })
}

/// A shot of the level with the map.
fn with_map(coasts: &Mapped<'_>, shot: &mut Shot, look: &ShoreLook) {
    let line = Some(Shoreline::Map(coasts.coast()));
    shot.shore = Some(Shore { shoreline: line, ..Shore::new(AREA.level) });
    shot.settings.shore = *look;
}

fn compared(name: &str, rig: &mut Rig<'_>, shot: &Shot, map: &Map, edge: Edge) -> Tally {
    let found = rig.draw(shot).shore.expect("shoreline foam");
    let water = water(shot, DVec3::Y, f64::from(AREA.level));
    let look = &shot.settings.shore;
    let expected = Image::from_fn(found.width, found.height, |x, y| {
        let point = water.at([x as f64 + 0.5, y as f64 + 0.5]);
        if point.depth.value <= 0.0 {
            return (point.depth.high() < 0.0).then_some(exact(0.0));
        }
        let size = map.width as u32;
        let (v, dv) = v_by_map((map, &AREA, size), &look.shoreline, point.place, point.change)?;
        let pixel = Pixel { place: point.place, v, across: point.change, dv };
        amount(look, edge, &pixel, [x, y])
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

/// The distances as they were found: what they are is the map's test.
fn twin_map(coasts: &Mapped<'_>) -> Map {
    let found = coasts.distances();
    let values = found.data.iter().map(|v| exact(f64::from(*v))).collect();
    Map { width: found.width, height: found.height, values }
}

#[test]
fn a_level_s_foam_is_the_twin_s() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, land), None);
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
