//! Changes that must not affect the picture: order, chunks, unit of length, size, an earlier frame,
//! a distant gap.

use ash::vk;
use whitewater::Config;
use whitewater::water::{Gate, Shading, Smoothing, Splat};

use crate::invariants::{exact, same_drawn, scaled};
use crate::reference::{EMPTY, Image, is_surface};
use crate::shading::close;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, OUTPUT, Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens, Random};
use crate::support::tolerance::Sum;

use super::back::{back_level, check_back};
use super::boundaries::check_boundaries;
use super::thickness::check_thickness;
use super::{
    SPACING, drop_at, gaps, of, pool, same_where, shot, shot_of, some, splatted, two, unsmoothed,
};

#[test]
fn one_sheet_is_the_default_where_there_is_no_gap() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    assert_eq!(Config::new(size, vk::Format::R16G16B16A16_SFLOAT, 1).sheets, 2);
    let points = scenes::block(3, 0.25, [14, 8, 4], [-1.8, -1.0, 4.0]);
    let levels = [(1, 2), (0, 0), (2, 1), (1, 1), (0, 3)];
    for (smoothing_level, thickness_level) in levels.into_iter().take(some(2)) {
        for way in [Shading::Raster, Shading::Compute] {
            let base = config(size).with(|it| {
                it.smoothing_level = smoothing_level;
                it.thickness_level = thickness_level;
                it.composite = Some(way);
            });
            let mut rigs =
                [1, 2].map(|sheets| Rig::lit(&gpu, &base.with(|it| it.sheets = sheets), 1));
            for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
                let shot = Shot::new(size, lens, 0.2, &points);
                let [one, two] = rigs.each_mut().map(|rig| {
                    // The second frame starts from the state that the first one left.
                    rig.draw(&shot);
                    rig.draw(&shot)
                });
                let name = format!("one-sheet-{smoothing_level}{thickness_level}-{way:?}-{lens:?}");
                let none = of(&two).boundaries.data.iter().all(|b| f64::from(*b) == EMPTY);
                assert!(none, "{name}: a gap");
                same_drawn(&name, &two, &one);
                let all = one.thickness.map(|t| [*t, 0.0, 1e6 * t, 1.0]);
                let found = of(&two).thickness.map(|[x, y, z]| [*x, *y, *z, 1.0]);
                compare::same_color(&format!("{name}-parts"), &found, &all);
                assert!(one.sheets.is_none(), "{name}: boundaries of one sheet");
                assert_eq!(one.levels.level[4].rect, [0; 4], "{name}: a back sheet in use");
            }
        }
    }
}

/// Particles at random places, as many caches have them, leave depths without water along many rays
/// through the body. Nearly all of these are narrower than 2.6 spacings, from centre to centre.
#[test]
fn water_of_random_particles_is_one_sheet() {
    let gpu = Gpu::shared();
    let (size, spacing) = (extent(320, 200), 0.5_f32);
    let mut random = Random(61);
    // One particle per cube of a spacing; the block is wider than the view.
    let (low, high) = ([-8.0, -6.0, 4.0], [8.0, 6.0, 12.0]);
    let count = low.iter().zip(high).map(|(low, high)| (high - low) / spacing).product::<f32>();
    let points: Vec<_> = (0..count as usize)
        .map(|_| std::array::from_fn(|i| random.between(low[i], high[i])))
        .collect();
    let shot = Shot::new(size, Lens::Standard, 0.656 * spacing, &points);
    let config = two(size).with(|it| it.max_particles = points.len() as u32);
    let drawn = Rig::new(&gpu, &config).draw(&shot);
    let all = of(&drawn).boundaries.data.len();
    assert!(drawn.depth.data.iter().all(|z| *z < 1e9), "the block does not fill the view");
    assert!(gaps(&drawn) * 50 < all, "{} of {all} texels have a gap", gaps(&drawn));
}

/// Distance in pixels within which smoothing of the front image can affect a pixel: one texel per
/// iteration, plus the texels from which the surface is reconstructed.
fn smoothing_reach(drawn: &Drawn) -> u32 {
    let most = drawn.plan.data.iter().map(|p| p & 511).max().unwrap_or(0);
    (most + 3) * drawn.levels.level[0].texel[2] as u32
}

/// The pixels that are more than 64 pixels away from all texels with two sheets.
fn far_from_gaps(boundaries: &Image<f32>, level: u32, width: usize, height: usize) -> Image<bool> {
    const FAR: usize = 64;
    let mut far = Image::new(width, height, true);
    for (i, boundary) in boundaries.data.iter().enumerate() {
        if !is_surface(f64::from(*boundary)) {
            continue;
        }
        let (x, y, edge) =
            ((i % boundaries.width) << level, (i / boundaries.width) << level, 1 << level);
        for row in y.saturating_sub(FAR)..(y + edge + FAR).min(height) {
            for column in x.saturating_sub(FAR)..(x + edge + FAR).min(width) {
                *far.at_mut(column, row) = false;
            }
        }
    }
    far
}

/// Water before a part of the pool changes nothing elsewhere.
#[test]
fn a_drop_before_a_pool_leaves_the_rest_as_it_is() {
    let gpu = Gpu::shared();
    let size = extent(320, 192);
    let (mut drop, pool) = (drop_at(&mut Random(3), [-0.9, -0.45, 2.6]), pool(0.0));
    drop.extend(&pool);
    for way in [Shading::Raster, Shading::Compute] {
        let config = two(size).with(|it| {
            // The compute splat sums integers. Blended sums would depend on the order of the
            // particles.
            it.thickness_splat = Some(Splat::Compute);
            it.composite = Some(way);
            it.coarsening = 0;
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let [without, with] = [&pool, &drop].map(|points| {
            let mut shot = shot_of(size, Lens::Standard, points);
            shot.settings.water.smoothing_width = 0.5;
            let drawn = rig.draw(&shot);
            let reach = smoothing_reach(&drawn);
            assert!(reach <= 64, "the smoothing reaches {reach} pixels");
            drawn
        });
        let name = format!("drop-{way:?}");
        let far = |drawn: &Drawn| far_from_gaps(&of(drawn).boundaries, 2, 320, 192);
        let (before, after) = (far(&without), far(&with));
        let fewer = before.data.iter().filter(|far| **far).count();
        let more = after.data.iter().filter(|far| **far).count();
        assert!(fewer > more, "{name}: no gap at the drop");
        let both = Image::from_fn(320, 192, |x, y| before.at(x, y) && after.at(x, y));
        let water = (0..both.data.len())
            .filter(|i| both.data[*i] && is_surface(f64::from(with.depth.data[*i])))
            .count();
        assert!(water > 4000, "{name}: {water} pixels of the pool are away from it");
        same_where(&name, &with.depth, &without.depth, &both);
        for channel in 0..4 {
            let of = |drawn: &Drawn| drawn.output.map(|c| c[channel]);
            same_where(&name, &of(&with), &of(&without), &both);
        }
        let near = with.output.data.iter().zip(&without.output.data).filter(|(a, b)| a != b);
        assert!(near.count() > 100, "{name}: the drop is not seen");
    }
}

/// A drop far before a torn slanted sheet and a pool changes the pixels that it covers and those
/// that smoothing and refraction reach from there, but no whole cells of boundaries.
#[test]
fn a_drop_far_before_a_sheet_leaves_no_square() {
    /// Distance in pixels from the covered ones that may change: a texel of the back sheet and its
    /// neighbours, and the march through the thickness.
    const REACH: usize = 8;
    let gpu = Gpu::shared();
    let (width, height) = (320, 192);
    let size = extent(width, height);
    let mut random = Random(5);
    let mut behind = Vec::new();
    for (x, y) in (0..28).flat_map(|x| (0..18).map(move |y| (x as f32, y as f32))) {
        for layer in 0..2 {
            let at = [0.25 * (x - 14.0), 0.25 * (y - 9.0), 6.0 + 0.05 * x + 0.25 * layer as f32];
            behind.push(super::jittered(&mut random, at, 0.3));
        }
    }
    behind.extend(scenes::block(9, SPACING, [70, 44, 4], [-8.7, -5.4, 9.5]));
    for thickness_level in [1, 2] {
        let config = two(size).with(|it| {
            it.thickness_splat = Some(Splat::Compute);
            it.thickness_level = thickness_level;
            it.coarsening = 0;
            it.max_particles = 20_000;
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut draw = |drop: &[[f32; 3]]| {
            let points: Vec<_> = drop.iter().chain(&behind).copied().collect();
            rig.draw(&unsmoothed(&shot_of(size, Lens::Standard, &points)))
        };
        let (with, without) = (draw(&[[0.1, 0.12, 1.6]]), draw(&[]));
        // Pixels that the drop's sphere or splat covers.
        let mut covered = Image::from_fn(width as usize, height as usize, |x, y| {
            let texel = (x >> thickness_level, y >> thickness_level);
            with.depth.at(x, y) != without.depth.at(x, y)
                || with.thickness.at(texel.0, texel.1) != without.thickness.at(texel.0, texel.1)
        });
        let count = covered.data.iter().filter(|covered| **covered).count();
        assert!(count > 200 && count < 4000, "{count} pixels");
        let own = covered.clone();
        for (y, x) in (0..own.height).flat_map(|y| (0..own.width).map(move |x| (y, x))) {
            if own.at(x, y) {
                for row in y.saturating_sub(REACH)..(y + REACH + 1).min(own.height) {
                    let columns = x.saturating_sub(REACH)..(x + REACH + 1).min(own.width);
                    columns.for_each(|column| *covered.at_mut(column, row) = true);
                }
            }
        }
        let beside = covered.map(|covered| !covered);
        let texels =
            Image::from_fn(of(&with).thickness.width, of(&with).thickness.height, |x, y| {
                beside.at(x << thickness_level, y << thickness_level)
            });
        for part in 0..2 {
            let of = |drawn: &Drawn| of(drawn).thickness.map(|t| t[part]);
            let name = format!("square-{thickness_level}-part-{part}");
            same_where(&name, &of(&with), &of(&without), &texels);
        }
        assert!(gaps(&with) > 1000 && gaps(&without) > 1000);
        for channel in 0..4 {
            let of = |drawn: &Drawn| drawn.output.map(|c| c[channel]);
            let name = format!("square-{thickness_level}-{channel}");
            same_where(&name, &of(&with), &of(&without), &beside);
        }
    }
}

#[test]
fn the_order_of_the_particles_is_no_matter() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let shot = shot(size, Lens::OffAxis);
    let order = Random(99).order(shot.positions.len());
    let positions = order.iter().map(|i| shot.positions[*i]).collect();
    let mixed = Shot { positions, ..shot.clone() };
    let mut rig = Rig::lit(&gpu, &exact(size).with(|it| it.sheets = 2), 1);
    let (first, second) = (rig.draw(&shot), rig.draw(&mixed));
    same_drawn("sheets-permutation", &second, &first);
}

/// `max_stride` limits how many particles are processed at a time.
#[test]
fn chunks_do_not_show() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let shot = shot(size, Lens::OffAxis);
    let mut few = shot.clone();
    few.positions.truncate(100);
    for splat in [Splat::Compute, Splat::Raster] {
        let config = exact(size).with(|it| {
            it.depth_splat = Some(splat);
            it.sheets = 2;
        });
        for max_stride in [1 << 17, 1 << 19] {
            let [whole, chunks] =
                [config, config.with(|it| it.max_stride = max_stride)].map(|config| {
                    let mut rig = Rig::lit(&gpu, &config, 1);
                    [rig.draw(&shot), rig.draw(&few), rig.draw(&shot)]
                });
            for (i, (found, expected)) in chunks.iter().zip(&whole).enumerate() {
                let name = format!("sheets-chunks-{splat:?}-{max_stride}-{i}");
                same_drawn(&name, found, expected);
            }
        }
    }
}

const TINY: [(u32, u32); 6] = [(96, 64), (1, 1), (1, 7), (3, 5), (17, 33), (8, 8)];

#[test]
fn no_particles_are_no_sheet() {
    let gpu = Gpu::shared();
    for (width, height) in TINY {
        let size = extent(width, height);
        for way in [Shading::Raster, Shading::Compute] {
            let mut rig = Rig::lit(&gpu, &two(size).with(|it| it.composite = Some(way)), 1);
            let mut none = shot(size, Lens::Standard);
            none.positions.clear();
            // The water of the earlier frame must not appear.
            rig.draw(&shot(size, Lens::Standard));
            let drawn = rig.draw(&none);
            let (width, height) = (width as usize, height as usize);
            let scene = Image { width, height, data: none.color.clone() };
            compare::same_color(&format!("sheets-zero-{width}-{way:?}"), &drawn.output, &scene);
            assert!(of(&drawn).boundaries.data.iter().all(|b| f64::from(*b) == EMPTY));
            assert!(of(&drawn).thickness.data.iter().all(|t| *t == [0.0; 3]));
            assert!(of(&drawn).surface.data.iter().all(|z| f64::from(*z) == EMPTY));
        }
    }
}

#[test]
fn small_images_have_sheets_too() {
    let gpu = Gpu::shared();
    for (width, height) in TINY {
        let size = extent(width, height);
        let levels = [(1, 2), (0, 0), (2, 3)];
        for (smoothing_level, thickness_level) in levels.into_iter().take(some(1)) {
            let config = splatted(size, Splat::Raster, thickness_level)
                .with(|it| it.smoothing_level = smoothing_level);
            let mut rig = Rig::lit(&gpu, &config, 1);
            // A drop before a wall.
            let mut points = scenes::block(5, SPACING, [24, 16, 2], [-3.0, -2.0, 5.0]);
            points.extend(drop_at(&mut Random(8), [0.05, 0.0, 2.0]));
            let shot = unsmoothed(&shot_of(size, Lens::Reversed, &points));
            let drawn = rig.draw(&shot);
            let name = format!("tiny-{width}x{height}-{smoothing_level}{thickness_level}");
            check_boundaries(&name, &of(&drawn).found, &drawn.depth, &shot, thickness_level);
            assert!(gaps(&drawn) > 0, "{name}: no gap");
            let (all, level) = (&drawn.thickness, back_level(&name, &drawn, &shot));
            check_thickness(&name, all, of(&drawn), &shot, thickness_level, Sum::Float);
            check_back(&name, &drawn.depth, of(&drawn), &shot, thickness_level, level);
            for (color, depth) in drawn.output.data.iter().zip(&drawn.depth.data) {
                let sound =
                    color.iter().all(|v| v.is_finite()) && (*depth >= 1e9 || color[3] == 1.0);
                assert!(sound, "{name}: {color:?}");
            }
        }
    }
}

/// A frame looks the same whatever was drawn before it.
#[test]
fn what_an_earlier_frame_left_is_not_seen() {
    let gpu = Gpu::shared();
    let size = extent(320, 192);
    let mut points = drop_at(&mut Random(3), [-0.9, -0.45, 2.6]);
    points.extend(pool(0.0));
    // The earlier frame has two sheets everywhere, at other depths.
    let mut other = scenes::block(1, 0.4, [16, 10, 1], [-3.0, -2.0, 2.0]);
    other.extend(scenes::block(2, 0.4, [40, 26, 1], [-8.0, -5.0, 7.0]));
    let other = Shot::new(size, Lens::OffAxis, 0.3, &other);
    for (smoothing, smoothing_width) in [
        (Smoothing::Tiles, 0.5),
        (Smoothing::Tiles, 2.0),
        (Smoothing::Fused, 2.0),
        (Smoothing::Query(Gate::VertexCull), 2.0),
    ] {
        let config = two(size).with(|it| {
            it.smoothing = Some(smoothing);
            it.smoothing_level = 0;
            it.coarsening = 0;
        });
        let mut shot = shot_of(size, Lens::Standard, &points);
        shot.settings.water.smoothing_width = smoothing_width;
        let fresh = Rig::lit(&gpu, &config, 1).draw(&shot);
        let mut rig = Rig::lit(&gpu, &config, 1);
        rig.draw(&other);
        let drawn = rig.draw(&shot);
        let name = format!("earlier-{smoothing:?}-{smoothing_width}").replace(['(', ')'], "");
        assert!(gaps(&drawn) > 10, "{name}: no gap");
        let undrawn = of(&drawn).surface.data.iter().filter(|z| f64::from(**z) == EMPTY);
        assert!(undrawn.count() > 500, "{name}: sheets everywhere");
        same_drawn(&name, &drawn, &fresh);
    }
}

/// Scaling by a power of two rounds nothing.
#[test]
fn the_unit_of_length_does_not_show() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::lit(&gpu, &exact(size).with(|it| it.sheets = 2), 1);
    let shot = shot(size, Lens::Standard);
    let expected = rig.draw(&shot);
    assert!(gaps(&expected) > 10);
    for scale in [1024.0, 1.0 / 1024.0] {
        let drawn = rig.draw(&scaled(&shot, scale));
        let same = |a: &f32, b: &f32| *a == *b * scale || (*a >= 1e9 && *b >= 1e9);
        let [found, wanted] = [&drawn, &expected].map(|drawn| &of(drawn).boundaries.data);
        assert!(found.iter().zip(wanted).all(|(a, b)| same(a, b)), "boundaries at {scale}");
        compare::same_color(&format!("sheets-unit-{scale}"), &drawn.output, &expected.output);
    }
}

#[test]
fn both_ways_of_shading_give_the_same_picture() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let levels = [(0, 2), (1, 1), (0, 0), (2, 3)];
    for (smoothing_level, thickness_level) in levels.into_iter().take(some(2)) {
        let mut rigs = [Shading::Raster, Shading::Compute].map(|way| {
            let levels = two(size).with(|it| {
                it.smoothing_level = smoothing_level;
                it.thickness_level = thickness_level;
            });
            Rig::lit(&gpu, &levels.with(|it| it.composite = Some(way)), 1)
        });
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            let shot = shot(size, lens);
            let [drawn, stored] = rigs.each_mut().map(|rig| rig.draw(&shot));
            let name = format!("sheets-ways-{smoothing_level}{thickness_level}-{lens:?}");
            close(&name, OUTPUT, &stored, &drawn);
            assert!(gaps(&drawn) > 10, "{name}: no gaps");
        }
    }
}
