//! Every tile with foam is shaded, wherever the camera is and whatever stands in the water.

use glam::{DVec3, Mat4, Vec3};
use whitewater::shore::{Area, Edge, Measure, TextureLayer};
use whitewater::{Shore, Shoreline};

use super::contact::{scene_of, twins};
use super::shoreline::{AREA, amount, heights, pixel_by_map, plain, twin_map};
use super::{Mapped, Tally, is_shared, shared_at, textures, water, with_shore};
use crate::reference::shore::{Bounded, exact};
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::Lens;

/// Name, position of the eye, view direction, up vector.
type View = (&'static str, Vec3, Vec3, Vec3);

const VIEWS: [View; 5] = [
    ("low", Vec3::new(4.0, 0.6, 6.0), Vec3::new(0.3, -0.08, -1.0), Vec3::Y),
    ("down", Vec3::new(7.0, 9.0, -5.0), Vec3::NEG_Y, Vec3::Z),
    ("from below", Vec3::new(5.0, -2.5, 2.0), Vec3::new(0.2, 0.5, -1.0), Vec3::Y),
    ("rolled", Vec3::new(3.0, 3.0, 4.0), Vec3::new(0.4, -0.5, -1.0), Vec3::new(0.866, 0.5, 0.0)),
    ("steep", Vec3::new(6.0, 5.0, -1.0), Vec3::new(0.1, -1.0, -0.4), Vec3::Y),
];

/// Distance of a post behind the surface, in units of the contact foam's depth; at 1 no foam is
/// left.
const BEHIND: [f64; 5] = [0.02, 0.9, 0.5, 0.93, 0.7];

/// Posts one pixel wide stand in the water, about one per tile, before nothing or before a seabed
/// too deep for foam; a wall hides some. Every pixel has the twin's foam, so no tile with foam is
/// skipped, also in the corner of a tile or of the picture, whose size is not a multiple of a tile.
#[test]
fn no_tile_with_foam_is_left_out() {
    let gpu = Gpu::shared();
    let size = extent(99, 61);
    let mut coasts = Mapped::new(&gpu, 64);
    let land = |at: glam::DVec2| 0.4 * (3.0 - (at - glam::DVec2::new(7.0, -5.0)).length());
    coasts.image_step(&AREA, &heights(&AREA, 64, land), None);
    let map = twin_map(&coasts);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let lenses = [
        [Lens::Standard, Lens::ReversedInfinite],
        [Lens::Infinite, Lens::Reversed],
        [Lens::OffAxis, Lens::Standard],
        [Lens::Mirrored, Lens::OffAxis],
        [Lens::LeftHanded, Lens::ReversedInfinite],
    ];
    for ((view, eye, along, up), lenses) in VIEWS.into_iter().zip(lenses) {
        for (k, lens) in lenses.into_iter().enumerate() {
            let measure = [Measure::Distance, Measure::View, Measure::Vertical];
            let measure = measure[(k + view.len()) % 3];
            // Seen from below, nothing lies vertically behind the surface.
            let measure = if view == "from below" { Measure::View } else { measure };
            let name = format!("{view}, {lens:?}, {measure:?}");
            let mut shot = Shot::new(size, lens, 0.1, &[]);
            shot.camera.view = (match lens {
                Lens::LeftHanded => Mat4::look_to_lh(eye, along, up),
                _ => Mat4::look_to_rh(eye, along, up),
            })
            .to_cols_array_2d();
            let mut look = plain();
            look.contact = look.contact.with(|it| {
                it.depth = 0.4;
                it.measure = measure;
                it.mask = 0.0;
            });
            if k == 1 {
                // A third texture layer selects the general pipeline.
                look.shoreline.layers[2] =
                    TextureLayer { weight: 0.05, ..look.shoreline.layers[0] };
            }
            shot.settings.shore = look;
            let line = Some(Shoreline::Map(coasts.shore_distances()));
            shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = line));
            let level = water(&shot, DVec3::Y, 0.0);
            let up_row = [level.up[0], level.up[1], level.up[2]];
            let point = |x: u32, y: u32| level.at([f64::from(x) + 0.5, f64::from(y) + 0.5]);
            let is_post = |x: u32, y: u32| (7 * x + 3 * y).is_multiple_of(61);
            shot.scene_depth(|x, y| {
                let point = point(x, y);
                let z = point.depth.value;
                if x > 80 && y < 40 {
                    return Some(0.2);
                }
                if !(z > 0.0 && z < 60.0) {
                    return None;
                }
                // Fraction of the contact depth per metre of depth, by this measure.
                let part = twins(&look, 0.1)[0].part([exact(z), exact(z + 1.0)], point.ray, up_row);
                let part = part.value;
                let behind = BEHIND[(x + y) as usize % 5];
                match is_post(x, y) {
                    true => Some(z + behind / part),
                    false => (x % 2 == 0).then_some(z + 20.0 / part),
                }
            });
            let found = rig.draw(&shot).shore.expect("foam");
            let [twin, _] = twins(&look, shot.settings.water.spacing);
            let [_, web] = textures();
            let (mut lines, mut contacts) = (Tally::default(), Tally::default());
            let mut sure = [0; 2];
            for (i, texel) in found.data.iter().enumerate() {
                let at @ [x, y] = [i % found.width, i / found.width];
                let point = point(x as u32, y as u32);
                let z = point.depth;
                if z.high() < 0.0 || (x > 80 && y < 40) {
                    assert_eq!(texel[..2], [0, 0], "{name}: {at:?} has no surface, or hidden");
                    continue;
                }
                let scene = scene_of(&shot, i);
                // At greater distances depths are too inaccurate.
                if z.low() <= 0.0 || z.high() > 60.0 {
                    continue;
                }
                let mut check = |c: usize, tally: &mut Tally, expected: Bounded| {
                    tally.add((x, y), texel[c], expected);
                    if expected.low() > 1.0 / 255.0 {
                        sure[c] += 1;
                        assert!(texel[c] > 0, "{name}: {at:?} has {expected:?} of {c}");
                    }
                };
                let hides = scene.is_some_and(|scene| scene.low() < z.high());
                let pixel = pixel_by_map(&shot, &level, (&map, &AREA), at);
                let line = pixel.and_then(|pixel| amount(&look, Edge::Smooth, &pixel, at));
                if let Some(line) = line.filter(|_| !hides) {
                    check(0, &mut lines, line);
                }
                let (place, off) = shared_at(is_shared(&shot), at);
                let middle = level.at(place);
                let Some(scene) = scene else {
                    check(1, &mut contacts, exact(0.0));
                    continue;
                };
                if middle.depth.low() > 0.0 {
                    let t = twin.part([z, scene], point.ray, up_row);
                    check(1, &mut contacts, twin.amount(t, twin.masked(web, &middle, off)));
                }
            }
            println!(
                "{name}: {} and {} compared, {sure:?} have some",
                lines.compared, contacts.compared
            );
            for tally in [&lines, &contacts] {
                assert_eq!(tally.beyond, 0, "{name}: {:?}", tally.first);
            }
            assert!(sure[0] > 50 && sure[1] > 15, "{name}: {sure:?}");
        }
    }
}

/// Far away a tile spans more water than the map computes distances for: the middle of the tile may
/// be in the open sea, beyond all distances of the map, while its far end has foam.
///
/// In a level view from a height of 10 m, row 359.5 + k sees the water at 6235 m / k. The shore lines
/// are such that of one tile only the farthest rows have foam.
#[test]
fn no_far_tile_with_foam_is_left_out() {
    let gpu = Gpu::shared();
    let size = extent(64, 720);
    let mut coasts = Mapped::new(&gpu, 256);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    // A third texture layer selects the general pipeline. By the other one, foam a single row high
    // is not drawn where pixels of two rows share a point that has none.
    for (shore, layers) in
        [(160.0, 2), (160.0, 3), (260.0, 2), (260.0, 3), (377.0, 2), (377.0, 3), (740.0, 3)]
    {
        let name = format!("{shore} m, {layers} layers");
        let area = Area { center: [0.0, 40.0 - shore], edge: 256.0, reach: 12.0, ..AREA };
        let land = |at: glam::DVec2| -0.3 * (at.y + f64::from(shore));
        coasts.image_step(&area, &heights(&area, 256, land), None);
        let map = twin_map(&coasts);
        let mut shot = Shot::new(size, Lens::ReversedInfinite, 0.1, &[]);
        let eye = Vec3::new(0.0, 10.0, 0.0);
        shot.camera.view = Mat4::look_to_rh(eye, Vec3::NEG_Z, Vec3::Y).to_cols_array_2d();
        let mut look = plain();
        let s = &mut look.shoreline;
        [s.sea_reach, s.land_reach] = [12.0, 3.0];
        // Foam everywhere but at the ends of v.
        (s.threshold, s.fade) = (-50.0, 0.05);
        if layers == 3 {
            s.layers[2] = TextureLayer { weight: 0.05, ..s.layers[0] };
        }
        shot.settings.shore = look;
        let line = Some(Shoreline::Map(coasts.shore_distances()));
        shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = line));
        let found = rig.draw(&shot).shore.expect("foam");
        let level = water(&shot, DVec3::Y, 0.0);
        let mut sure = 0;
        for (i, texel) in found.data.iter().enumerate() {
            let at @ [x, y] = [i % found.width, i / found.width];
            let point = level.at([x as f64 + 0.5, y as f64 + 0.5]);
            // Only near the shore line, because the twin takes long.
            let off = point.place[1].value + f64::from(shore);
            if point.depth.low() <= 0.0 || off.abs() > 30.0 {
                continue;
            }
            let pixel = pixel_by_map(&shot, &level, (&map, &area), at);
            let Some(v) = pixel.map(|pixel| pixel.own_v()) else { continue };
            if v.low() > 0.06 && v.high() < 1.94 {
                sure += 1;
                assert_eq!(texel[0], 255, "{name}: {at:?}, {off:.1} m from the shore line, {v:?}");
            }
        }
        println!("{name}: {sure} pixels have foam");
        assert!(sure >= 64, "{name}: {sure} pixels have foam");
    }
}
