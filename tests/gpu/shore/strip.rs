//! Shoreline foam from the host's strip, and from the scene's depth alone.

use ash::vk;
use glam::DVec3;
use whitewater::shore::Edge;
use whitewater::{Shore, Shoreline, Strip, Triangles};

use super::shoreline::{amount, plain};
use super::{Tally, water, with_shore};
use crate::reference::shore::foam::Pixel;
use crate::reference::shore::{Bounded, U, exact};
use crate::support::device::Gpu;
use crate::support::host::HOST_WRITE;
use crate::support::rig::{Rig, Shot, extent, stream};
use crate::support::scenes::Lens;
use crate::support::spy::{self, By, Event};

/// v is linear in the strip's x and z: factors of x and z, and the constant.
const ACROSS: [f64; 3] = [0.125, -0.1875, -0.75];

fn v_at([x, z]: [f64; 2]) -> f64 {
    ACROSS[0] * x + ACROSS[1] * z + ACROSS[2]
}

/// A quad on the water level, made of two triangles: with and without indices, in a buffer with
/// other data, with invalid vertices and with indices beyond the vertices.
#[test]
fn a_strip_s_foam_is_the_twin_s() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let corners = [[4.0, -9.0], [11.0, -9.0], [4.0, -1.0], [11.0, -1.0]];
    let vertex = |i: usize| {
        let [x, z] = corners[i];
        [x as f32, 0.0, z as f32, v_at([x, z]) as f32]
    };
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    // Position and v of each vertex, after one word of other data.
    let mut words = vec![7.0_f32];
    words.extend((0..4).flat_map(vertex));
    words.extend([f32::NAN, 0.0, 0.0, 1.0]);
    let vertices = rig.stub.data(bytemuck::cast_slice(&words), usage);
    let order: [u32; 12] = [0, 1, 2, 2, 1, 3, 0, 1, 4, 0, 1, 99];
    let indices = rig.stub.data(bytemuck::cast_slice(&order), usage);
    let unrolled: Vec<_> = order[..6].iter().map(|i| vertex(*i as usize)).collect();
    let plainly = rig.stub.data(bytemuck::cast_slice(&unrolled), usage);
    let strip = |data, offset, count, indices| Strip {
        triangles: Triangles { positions: stream(data, offset, 16), vertices: count, indices },
        coordinates: stream(data, offset + 12, 16),
        before: HOST_WRITE,
        after: HOST_WRITE,
    };
    let bits = f64::from(1_u32 << gpu.limits().sub_pixel_precision_bits);
    for (name, lens, strip) in [
        ("indices", Lens::Standard, strip(&vertices, 4, 5, Some((stream(&indices, 0, 4), 12)))),
        ("plain", Lens::Reversed, strip(&plainly, 0, 6, None)),
        ("mirrored", Lens::Mirrored, strip(&vertices, 4, 5, Some((stream(&indices, 0, 4), 12)))),
        ("left", Lens::LeftHanded, strip(&plainly, 0, 6, None)),
    ] {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        shot.settings.shore = plain();
        let shoreline = Some(Shoreline::Strip(strip));
        shot.shore = Some(Shore::new(0.0).with(|it| {
            it.surface = None;
            it.shoreline = shoreline;
        }));
        let found = rig.draw(&shot).shore.expect("shoreline foam");
        let water = water(&shot, DVec3::Y, 0.0);
        let point = |x: usize, y: usize| water.at([x as f64 + 0.5, y as f64 + 0.5]);
        // The device snaps vertices to its sub-pixel grid, and interpolated values with them.
        let v = |x: usize, y: usize| {
            let point = point(x, y);
            let step =
                point.change.map(|way| (ACROSS[0] * way[0].value + ACROSS[1] * way[1].value).abs());
            let v = v_at(point.place.map(|p| p.value));
            exact(v).wider((step[0] + step[1]) / bits + 16.0 * U * 4.0)
        };
        let mut tally = Tally::default();
        for i in 0..found.data.len() {
            let (x, y) = (i % found.width, i / found.width);
            let own = point(x, y);
            let beside = |at: [f64; 2], by: f64| {
                let wide = own.change.map(|way| way[0].value.abs().max(way[1].value.abs()));
                let off = by * (wide[0] + wide[1]);
                at[0] > 4.0 - off && at[0] < 11.0 + off && at[1] > -9.0 - off && at[1] < -1.0 + off
            };
            let at = own.place.map(|p| p.value);
            if own.depth.low() <= 0.0 || !beside(at, 0.1) {
                tally.add((x, y), found.data[i][0], exact(0.0));
                continue;
            }
            let inner = |x: usize, y: usize| beside(point(x, y).place.map(|p| p.value), -0.1);
            // Only pixels of 2x2 blocks that the strip covers completely.
            let (x0, y0) = (x & !1, y & !1);
            if ![(0, 0), (1, 0), (0, 1), (1, 1)].iter().all(|(i, j)| inner(x0 + i, y0 + j)) {
                continue;
            }
            let dv = [v(x0 + 1, y) - v(x0, y), v(x, y0 + 1) - v(x, y0)];
            let moved = own.change.map(|way| way.map(|w| w.value.abs()));
            let place = [0, 1].map(|i| own.place[i].wider((moved[0][i] + moved[1][i]) / bits));
            let part = (moved[0][0] + moved[0][1] + moved[1][0] + moved[1][1]) / bits;
            let across = own.change.map(|way| way.map(|w: Bounded| w.wider(part * w.value.abs())));
            let pixel = Pixel { off: [0.0; 2], place, v: v(x, y), across, dv };
            if let Some(expected) = amount(&shot.settings.shore, Edge::Smooth, &pixel, [x, y]) {
                tally.add((x, y), found.data[i][0], expected);
            }
        }
        // A device with a coarser grid than 1/256 pixel has larger bounds.
        tally.check(&format!("strip-{name}"), 50, 0.08 * (256.0 / bits).max(1.0));
    }
}

/// With a plane as seabed, the shore line is where it meets the level, wherever on the screen. A steep plane is a wall.
#[test]
fn by_the_depth_alone_a_plane_s_shore_is_as_far_as_it_is() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    for (lens, tangent) in
        [(Lens::Standard, 0.25), (Lens::ReversedInfinite, 0.6), (Lens::Standard, 500.0)]
    {
        let mut shot = Shot::new(size, lens, 0.1, &[]);
        shot.settings.shore = plain();
        let shoreline = Some(Shoreline::Screen);
        shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = shoreline));
        let water = water(&shot, DVec3::Y, 0.0);
        let view = shot.view(size);
        let back = view.view.inverse();
        let eye = back.w_axis.truncate();
        let at = |x: u32, y: u32| back.transform_vector3(view.ray(x as usize, y as usize));
        // The seabed rises towards the line z = -6 and beyond.
        let (normal, line) = (DVec3::new(0.0, 1.0, tangent), -6.0);
        shot.scene_depth(|x, y| {
            let z = -(normal.dot(eye) - tangent * line) / normal.dot(at(x, y));
            (z > 0.0 && z < 80.0).then_some(z)
        });
        let found = rig.draw(&shot).shore.expect("shoreline foam");
        let scene = shot.scene_eye();
        let mut tally = Tally::default();
        for i in 0..found.data.len() {
            let (x, y) = (i % found.width, i / found.width);
            let own = water.at([x as f64 + 0.5, y as f64 + 0.5]);
            let behind = scene.data[i];
            if own.depth.low() <= 0.0 || own.depth.value > 30.0 || behind > 60.0 {
                continue;
            }
            let bottom = eye + behind * at(x as u32, y as u32);
            // The water's surface is visible where the seabed is below it.
            let off = 4.0 * U * behind * behind / view.near();
            if bottom.y.abs() < 8.0 * off {
                continue;
            }
            if bottom.y > 0.0 {
                tally.add((x, y), found.data[i][0], exact(0.0));
                continue;
            }
            let reach = f64::from(shot.settings.shore.shoreline.sea_reach);
            // From the point on the water to the line at which the seabed meets the level.
            let point = eye + own.depth.value * at(x as u32, y as u32);
            let far = (point.z - line) / reach;
            // Three depths, each with the rounding of its device depth, over the seabed's length in
            // a pixel, turn the seabed's plane, which moves the line at which it meets the level.
            let turned = 6.0 * off / (behind * view.c_x().min(view.c_y()));
            let sine = tangent / tangent.hypot(1.0);
            let v = exact(1.0 - far).wider((turned * -bottom.y / sine + off) / (sine * reach));
            let v = v.clamp(0.0, 2.0);
            let dv = [exact(0.0); 2];
            let (place, across) = (own.place, own.change);
            let pixel = Pixel { off: [0.0; 2], place, v, across, dv };
            if let Some(expected) = amount(&shot.settings.shore, Edge::Smooth, &pixel, [x, y]) {
                tally.add((x, y), found.data[i][0], expected);
            }
        }
        tally.check(&format!("screen-{lens:?}"), 50, 0.2);
    }
}

/// Seen from under water, everything above the level is no shore.
#[test]
fn by_the_depth_alone_nothing_above_the_level_is_a_shore() {
    let gpu = Gpu::shared();
    let mut rig = Rig::new(&gpu, &with_shore(extent(96, 64), Edge::Smooth));
    let mut shot = Shot::new(extent(96, 64), Lens::Standard, 0.1, &[]);
    shot.settings.shore = plain();
    shot.scene_depth(|_, _| Some(20.0));
    let eye = shot.view(shot.size).view.inverse().w_axis.y as f32;
    // Seen from above there is foam, which shows that the settings produce some.
    for (level, seen) in [(eye - 0.5, true), (eye + 0.5, false)] {
        let mut shore = Shore::new(level).with(|it| it.shoreline = Some(Shoreline::Screen));
        shore.bias = 0.0;
        shot.shore = Some(shore);
        let shoreline = &mut shot.settings.shore.shoreline;
        (shoreline.sea_reach, shoreline.land_reach) = (100.0, 1.0);
        let found = rig.draw(&shot).shore.expect("shoreline foam");
        let foam = found.data.iter().filter(|texel| texel[0] > 0).count();
        println!("level {level}: {foam} pixels with foam");
        assert_eq!(foam > 0, seen, "level {level}: {foam} pixels with foam");
    }
}

/// Which pixels show a scene.
type Shows = fn(u32, u32) -> bool;

/// A pixel tells the plane of the seabed only together with a neighbour on each screen axis. Without
/// them it has no foam, whatever its depth.
#[test]
fn by_the_depth_alone_lone_pixels_have_no_shore() {
    let gpu = Gpu::shared();
    let mut rig = Rig::new(&gpu, &with_shore(extent(96, 64), Edge::Smooth));
    let mut shot = Shot::new(extent(96, 64), Lens::Standard, 0.1, &[]);
    shot.settings.shore = plain();
    let shoreline = &mut shot.settings.shore.shoreline;
    (shoreline.sea_reach, shoreline.threshold) = (100.0, -50.0);
    shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = Some(Shoreline::Screen)));
    let cases: [(&str, Shows, bool); 4] = [
        ("everywhere", |_, _| true, true),
        ("points", |x, y| x % 3 == 1 && y % 3 == 1, false),
        ("columns", |x, _| x % 3 == 1, false),
        ("rows", |_, y| y % 3 == 1, false),
    ];
    for (name, shows, foams) in cases {
        shot.scene_depth(|x, y| shows(x, y).then_some(20.0));
        let found = rig.draw(&shot).shore.expect("shoreline foam");
        let foam = found.data.iter().filter(|texel| texel[0] > 0).count();
        println!("{name}: {foam} pixels with foam");
        assert_eq!(foam > 0, foams, "{name}: {foam} pixels with foam");
    }
}

/// Where foam reaches the bottom row of the image, all tiles with foam are marked, and nothing behind
/// them. In a frame that is narrower than the image, rows of tiles below the frame would still be in
/// the buffer of marks, where they show.
#[test]
fn marks_end_with_the_frame() {
    const TILES: [u32; 2] = [25, 17];
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let most = extent(8 * TILES[0], 8 * TILES[1]);
    let mut rig = Rig::new(&gpu, &with_shore(most, Edge::Smooth));
    // From the feet of the camera to far away, and v is 1.
    let [a, b, c, d] = [[-60.0_f32, -60.0], [60.0, -60.0], [-60.0, 60.0], [60.0, 60.0]]
        .map(|[x, z]| [x, 0.0, z, 1.0]);
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let vertices = rig.stub.data(bytemuck::cast_slice(&[a, b, c, c, b, d]), usage);
    let strip = Strip {
        triangles: Triangles { positions: stream(&vertices, 0, 16), vertices: 6, indices: None },
        coordinates: stream(&vertices, 12, 16),
        before: HOST_WRITE,
        after: HOST_WRITE,
    };
    for width in [96, most.width] {
        let mut shot = Shot::new(extent(width, most.height), Lens::ReversedInfinite, 0.1, &[]);
        shot.settings.shore = plain();
        // Foam everywhere.
        shot.settings.shore.shoreline.threshold = -50.0;
        shot.shore = Some(Shore::new(0.0).with(|it| {
            it.surface = None;
            it.shoreline = Some(Shoreline::Strip(strip));
        }));
        spy::watch();
        let found = rig.draw(&shot).shore.expect("shoreline foam");
        let events = spy::take_events();
        let bottom = &found.data[found.width * (found.height - 1)..];
        assert!(bottom.iter().all(|texel| texel[0] > 0), "{width}: foam in all of the last row");
        let sized = spy::buffers_of_size(4 * u64::from(TILES[0] * TILES[1]));
        let marks = events.iter().find_map(|event| match *event {
            Event::Use { buffer, by: By::Transfer } if sized.contains(&buffer) => Some(buffer),
            _ => None,
        });
        let marks = rig.words_of(marks.expect("the marks are filled"), TILES[0] * TILES[1]);
        let mut expected = vec![0_u32; marks.len()];
        for (i, texel) in found.data.iter().enumerate() {
            let (x, y) = (i % found.width, i / found.width);
            if texel[0] > 0 {
                expected[y / 8 * found.width.div_ceil(8) + x / 8] = 1;
            }
        }
        assert_eq!(marks, expected, "{width} pixels wide");
    }
}
