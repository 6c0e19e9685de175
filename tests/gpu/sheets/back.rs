//! The depth of the back sheet and its smoothing against the twins, in the tiles near gaps.

use glam::{DVec2, DVec3};
use whitewater::water::Rule;
use whitewater::{SmoothingLevel, SmoothingLevels};

use crate::composite::{Sky, twin_settings};
use crate::harness::fails;
use crate::level::check_level;
use crate::reduce::{assert_planned, decoded_plan, params, rules, wide};
use crate::reference::composite::{self as twin};
use crate::reference::levels::Levels;
use crate::reference::reduce;
use crate::reference::sheets::{self, Boundaries};
use crate::reference::thickness::Amplitude;
use crate::reference::{EMPTY, Image, View, depth, is_surface, smooth};
use crate::smooth::forms;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Sheets, Shot, coarsening, extent};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::support::tolerance::{self, Sum, U};

use super::picture::Layers;
use super::thickness::{check_thickness, is_behind};
use super::{SPACING, drop_at, of, rule, shot, shot_of, some, spacing, two, unsmoothed, visible};

/// Asserts that the back sheet's first level is one coarser than the front sheet's, and has the
/// expected size and slopes. Returns the level.
pub fn back_level(name: &str, drawn: &Drawn, shot: &Shot) -> u32 {
    let back: &SmoothingLevel = &drawn.levels.level[4];
    let edge = back.texel[2];
    assert_eq!(edge, 2.0 * drawn.levels.level[0].texel[2], "{name}: one level coarser");
    let level = (edge as u32).ilog2();
    let view = shot.view(shot.size).reduced(level);
    assert_eq!(back.rect[2..], [view.width as i32, view.height as i32], "{name}: its size");
    // The slopes are computed from numbers that are rounded a few times, as in
    // `tolerance::ray_distance`.
    let slope = 4.0 * U * 3.0 * (1.0 + tolerance::reach(&view));
    for (x, y) in [(0, 0), (view.width - 1, view.height - 1)] {
        let [sx, sy, ox, oy] = back.slope.map(f64::from);
        let found = DVec2::new((x as f64 + 0.5) * sx + ox, (y as f64 + 0.5) * sy + oy);
        let off = (found - view.ray(x, y).truncate()).abs().max_element();
        assert!(off <= slope, "{name}: the ray of ({x}, {y}) is off by {off}");
    }
    for (found, expected) in [(back.texel[0], view.c_x()), (back.texel[1], view.c_y())] {
        assert!((f64::from(found) - expected).abs() <= 4.0 * U * expected, "{name}: {found}");
    }
    level
}

/// The texels with two sheets.
pub fn split(boundaries: &Boundaries<'_>, full: &View, level: u32) -> Image<bool> {
    let view = full.reduced(level);
    Image::from_fn(view.width, view.height, |x, y| {
        is_surface(sheets::boundary_at(boundaries, full, level, x, y))
    })
}

/// Asserts that the unsmoothed depth of the back sheet is the twin's, computed from the boundaries
/// and the depth that were read back. Returns the number of texels with water behind water, and of
/// texels in tiles that are not made.
pub fn check_back(
    name: &str,
    depth: &Image<f32>,
    sheets: &Sheets,
    shot: &Shot,
    thickness_level: u32,
    level: u32,
) -> (usize, usize) {
    let (full, depth) = (shot.view(shot.size), wide(depth));
    let (view, texels) = (full.reduced(level), wide(&sheets.boundaries));
    let boundaries = Boundaries { texels: &texels, level: thickness_level };
    let split = split(&boundaries, &full, level);
    let made = sheets::made(&boundaries, &full, level);
    let mut bounds = tolerance::depth_where(&visible(shot), &view, |x, y, sphere| {
        let boundary = sheets::boundary_at(&boundaries, &full, level, x, y);
        if split.at(x, y) { is_behind(sphere, boundary, &full) } else { (false, false) }
    });
    let mut water = 0;
    for (y, x) in (0..view.height).flat_map(|y| (0..view.width).map(move |x| (y, x))) {
        let exactly = if !made.at(x, y) {
            EMPTY
        } else if split.at(x, y) {
            water += usize::from(is_surface(f64::from(sheets.surface.at(x, y))));
            continue;
        } else {
            // A copied depth has no rounding error.
            let (px, py) = sheets::pixel_of_texel(&full, level, x, y);
            depth.at(px, py)
        };
        *bounds.low.at_mut(x, y) = exactly;
        *bounds.high.at_mut(x, y) = exactly;
    }
    compare::between(name, &sheets.surface, &bounds);
    (water, made.data.iter().filter(|made| !**made).count())
}

#[test]
fn the_back_sheets_depth_is_the_twins() {
    let gpu = Gpu::shared();
    for (width, height) in [(97, 61), (192, 120)].into_iter().take(some(1)) {
        let size = extent(width, height);
        for (smoothing_level, thickness_level) in [(0, 2), (0, 0), (1, 2), (1, 3), (2, 1)] {
            let config = two(size).with(|it| {
                it.smoothing_level = smoothing_level;
                it.thickness_level = thickness_level;
                it.coarsening = 0;
            });
            let mut rig = Rig::new(&gpu, &config);
            let lenses = match (smoothing_level, thickness_level) {
                (0, 2) => &LENSES[..],
                _ => &[Lens::Standard, Lens::OffAxis],
            };
            for lens in lenses {
                let mut shot = unsmoothed(&shot(size, *lens));
                let name = format!("back-{smoothing_level}{thickness_level}-{lens:?}-{width}");
                let drawn = rig.draw(&shot);
                let level = back_level(&name, &drawn, &shot);
                let check = |name: &str, drawn: &Drawn, shot: &Shot| {
                    check_back(name, &drawn.depth, of(drawn), shot, thickness_level, level)
                };
                let (water, _) = check(&name, &drawn, &shot);
                // At least a twentieth of the picture.
                let texels = of(&drawn).surface.data.len();
                assert!(water * 20 > texels, "{name}: {water} of {texels} texels");
                // Depths of the front sheet behind the scene are removed; those of the back sheet
                // are kept.
                shot.scene_depth(|x, y| {
                    ((x / 9 + y / 5) % 2 == 0).then_some(2.0 + f64::from(y % 9))
                });
                check(&format!("{name}-cut"), &rig.draw(&shot), &shot);
            }
        }
    }
}

/// The back sheet's depth is empty in the tiles that are away from all gaps, and only there.
#[test]
fn tiles_are_made_near_gaps() {
    let gpu = Gpu::shared();
    let size = extent(320, 192);
    let mut points = drop_at(&mut Random(3), [-0.9, -0.45, 2.6]);
    points.extend(scenes::block(5, SPACING, [40, 24, 2], [-5.0, -3.0, 5.0]));
    for (smoothing_level, thickness_level) in [(0, 0), (0, 2), (1, 3)] {
        let config = two(size).with(|it| {
            it.smoothing_level = smoothing_level;
            it.thickness_level = thickness_level;
            it.coarsening = 0;
        });
        let mut rig = Rig::new(&gpu, &config);
        for lens in [Lens::Standard, Lens::OffAxis] {
            let shot = unsmoothed(&shot_of(size, lens, &points));
            let drawn = rig.draw(&shot);
            let name = format!("back-made-{smoothing_level}{thickness_level}-{lens:?}");
            let level = back_level(&name, &drawn, &shot);
            let (water, unmade) =
                check_back(&name, &drawn.depth, of(&drawn), &shot, thickness_level, level);
            let texels = of(&drawn).surface.data.len();
            assert!(water > 20 && unmade * 6 > texels, "{name}: {water}, {unmade} of {texels}");
        }
    }
}

/// A frame as the twins compute it, rounded to single precision.
pub fn twins_frame(shot: &Shot, smoothing_level: u32, thickness_level: u32) -> Drawn {
    let (spheres, full) = (visible(shot), shot.view(shot.size));
    let narrow = |image: &Image<f64>| image.map(|v| *v as f32);
    let cells = sheets::cells(&spheres, &full, spacing(shot));
    let depth = narrow(&depth::splat(&spheres, &full));
    let texels = sheets::of_texels(&cells, &wide(&depth), thickness_level, rule(shot));
    let mut texels = wide(&narrow(&texels));
    let volume = Amplitude::Volume { particle_volume: spacing(shot).powi(3) };
    let mut thickness =
        sheets::thickness(&spheres, &full, thickness_level, &texels, spacing(shot), volume);
    sheets::prune(&mut texels, &mut thickness);
    let (rule, params) = (smooth::Rule::ConstantWidth, params(shot, 256));
    let smoothed = |image: &Image<f64>, level: u32| {
        let view = full.reduced(level);
        let plan = smooth::plan(image, &view, rule, &params);
        narrow(&smooth::run(image, &plan, &view, rule, &params))
    };
    let back_level = smoothing_level + 1;
    let boundaries = Boundaries { texels: &texels, level: thickness_level };
    let back = sheets::back_depth(&spheres, &full, back_level, &boundaries, &wide(&depth));
    let mut levels: SmoothingLevels = bytemuck::Zeroable::zeroed();
    for (i, level, y) in [(0, smoothing_level, 0), (4, back_level, 1 << 12)] {
        let view = full.reduced(level);
        let (step, first) = (view.slope_step(), view.ray_at(DVec2::ZERO));
        levels.level[i] = SmoothingLevel {
            rect: [0, y, view.width as i32, view.height as i32],
            slope: [step.x, step.y, first.x, first.y].map(|v| v as f32),
            texel: [view.c_x() as f32, view.c_y() as f32, (1 << level) as f32, 0.0],
        };
    }
    let reduced = reduce::reduce(&wide(&depth), smoothing_level, shot.falloff());
    let sheets = Sheets {
        boundaries: narrow(&texels),
        found: narrow(&texels),
        thickness: thickness.map(|texel| texel.map(|t| t as f32)),
        surface: smoothed(&back, back_level),
        plan: Image::new(0, 0, 0),
        coarser: Vec::new(),
    };
    let mut drawn = Drawn {
        surface: smoothed(&reduced, smoothing_level),
        depth,
        levels,
        thickness: thickness.map(|[front, back, _]| (front + back) as f32),
        sheets: Some(sheets),
        ..Drawn::empty()
    };
    let layers = Layers::new(&drawn, shot);
    let sky = Sky::Even.radiance(DVec3::Y);
    let (inputs, behind) =
        (layers.inputs(smoothing_level, thickness_level), layers.behind(back_level));
    let picture = twin::shade_sheets(&inputs, &behind, &twin_settings(shot, &full), |_| sky, &full);
    drawn.output = picture.map(|c| c.map(|v| v as f32));
    drawn
}

/// The checks of thickness and depth accept the twins' own results, and detect small faults.
#[test]
fn a_planted_fault_is_seen() {
    let (size, level) = (extent(97, 61), 1);
    let shot = unsmoothed(&shot(size, Lens::OffAxis));
    let view = shot.view(size);
    for thickness_level in [0, 2] {
        let Drawn { depth, thickness: all, sheets, .. } = twins_frame(&shot, 0, thickness_level);
        let good = sheets.expect("two sheets");
        let thick = |all: &Image<f32>, sheets: &Sheets| {
            check_thickness("planted-thickness", all, sheets, &shot, thickness_level, Sum::Float)
        };
        let back = |sheets: &Sheets| {
            check_back("planted-back", &depth, sheets, &shot, thickness_level, level).0
        };
        assert!(thick(&all, &good) > 90 && back(&good) > 100);
        let unseen = |of: &dyn Fn(&Sheets) -> usize, other: &Sheets| {
            !fails(|| {
                of(other);
            })
        };
        let thick_of = |sheets: &Sheets| thick(&all, sheets);
        let swapped = good.thickness.map(|[x, y, z]| [*y, *x, *z]);
        assert!(!unseen(&thick_of, &Sheets { thickness: swapped, ..good.clone() }));
        let both = |i: &usize| good.thickness.data[*i].iter().all(|t| *t > 0.01);
        let texel = (0..all.data.len()).find(both).expect("both sheets");
        let mut other = good.clone();
        other.boundaries.data[texel] = EMPTY as f32;
        assert!(!unseen(&thick_of, &other));
        // A moved boundary: other water is behind it.
        let mut other = good.clone();
        other.boundaries.data.iter_mut().filter(|b| **b < 1e9).for_each(|b| *b += 1.0);
        assert!(!unseen(&thick_of, &other) && !unseen(&back, &other));
        let texels = (0..good.surface.data.len()).filter(|i| good.surface.data[*i] < 1e9);
        for i in texels.step_by(97) {
            let mut other = good.clone();
            other.surface.data[i] *= 1.0001;
            assert!(!unseen(&back, &other), "texel {i}");
        }
        let texels = wide(&good.boundaries);
        let boundaries = Boundaries { texels: &texels, level: thickness_level };
        let made = sheets::made(&boundaries, &view, level);
        if let Some(i) = made.data.iter().position(|made| !made) {
            let mut other = good.clone();
            other.surface.data[i] = 3.0;
            assert!(!unseen(&back, &other), "texel {i}");
        }
        for i in (0..all.data.len()).filter(|i| all.data[*i] > 0.0).step_by(397 >> thickness_level)
        {
            let mut other = all.clone();
            other.data[i] *= 1.001;
            assert!(fails(|| {
                thick(&other, &good);
            }));
            for part in (0..3).filter(|part| good.thickness.data[i][*part] > 0.0) {
                let mut other = good.clone();
                other.thickness.data[i][part] *= 1.001;
                assert!(!unseen(&thick_of, &other), "texel {i}, {part}");
            }
        }
    }
}

#[test]
fn the_back_surface_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(193, 121);
    for smoothing_level in 0..3 {
        // This configuration draws the unsmoothed depth. Only this rule has a width, which is set
        // to 0.
        let config = two(size).with(|it| {
            it.smoothing_level = smoothing_level;
            it.rule = Rule::ConstantWidth;
            it.coarsening = 0;
            it.thickness_level = 0;
        });
        let mut flat_rig = Rig::new(&gpu, &config);
        for (rule, twin) in rules() {
            let mut rig = Rig::new(&gpu, &config.with(|it| it.rule = rule));
            let lenses: &[Lens] = match (smoothing_level, rule) {
                (0, Rule::ConstantWidth) => &LENSES,
                _ => &[Lens::OffAxis],
            };
            for lens in lenses {
                let shot = shot(size, *lens);
                let flat = flat_rig.draw(&unsmoothed(&shot));
                let drawn = rig.draw(&shot);
                let name = format!("back-smooth-{rule:?}-{smoothing_level}-{lens:?}");
                let name = name.replace(['(', ')'], "");
                compare::same(&name, &of(&drawn).boundaries, &of(&flat).boundaries);
                let level = back_level(&name, &drawn, &shot);
                let full = shot.view(size);
                let (view, params) = (full.reduced(level), params(&shot, config.max_iterations));
                let reduced = wide(&of(&flat).surface);
                let plan = decoded_plan(&of(&drawn).plan, twin, &params);
                assert_planned(&name, &plan, &reduced, &view, twin, &params);
                let (expected, error) = tolerance::smoothing(&reduced, &plan, &view, twin, &params);
                let surface = &of(&drawn).surface;
                compare::close(&name, surface, &expected, 0, |x, y, _| error.at(x, y));
                // Only the texels that the picture uses.
                let texels = wide(&of(&drawn).boundaries);
                let boundaries = Boundaries { texels: &texels, level: 0 };
                let split = split(&boundaries, &full, level);
                let shown = || (0..split.data.len()).filter(|i| split.data[*i]);
                let water = || shown().filter(|i| is_surface(reduced.data[*i]));
                let mut errors: Vec<f64> = water().map(|i| error.data[i]).collect();
                errors.sort_by(f64::total_cmp);
                let median = errors[errors.len() / 2];
                let moved = water().map(|i| (expected.data[i] - reduced.data[i]).abs());
                let moved = moved.fold(0.0, f64::max);
                assert!(median < 0.02 * params.radius, "{name}: a bound of {median} shows nothing");
                assert!(moved > 0.05 * params.radius, "{name}: {moved}: nothing was smoothed");
            }
        }
    }
}

/// All forms do the same arithmetic, so their results are equal bit for bit.
#[test]
fn all_forms_give_the_same_back_surface() {
    let gpu = Gpu::shared();
    let forms = forms(&gpu);
    let sizes = [(extent(193, 121), 256), (extent(3, 5), 40), (extent(130, 35), 7)];
    for (size, cap) in sizes.into_iter().take(some(1)) {
        for (rule, _) in rules() {
            let mut first: Option<Drawn> = None;
            for form in &forms {
                let config = two(size).with(|it| {
                    it.smoothing_level = 0;
                    it.smoothing = Some(*form);
                    it.max_iterations = cap;
                    it.coarsening = 0;
                    it.rule = rule;
                });
                let mut rig = Rig::lit(&gpu, &config, 1);
                let shot = shot(size, Lens::OffAxis);
                // The second frame starts from the state that the first one left.
                rig.draw(&shot);
                let drawn = rig.draw(&shot);
                let name = format!("back-forms-{form:?}-{rule:?}-{}", size.width);
                let name = name.replace(['(', ')'], "");
                let first = first.get_or_insert_with(|| drawn.clone());
                let (found, expected) = (of(&drawn), of(first));
                compare::same(&name, &found.boundaries, &expected.boundaries);
                compare::same(&name, &found.surface, &expected.surface);
                assert!(found.plan == expected.plan, "{name}: the plans differ");
            }
        }
    }
}

/// A texel of a coarser level of the back sheet is the nearest of the first level's texels that it
/// covers. Texels are planned and smoothed where they are visible, and a little around.
#[test]
fn coarser_back_sheets_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(193, 121);
    let mut shot = shot(size, Lens::OffAxis);
    shot.settings.water.smoothing_width = 1.0;
    let mut wanted_of = [0; 3];
    for cap in [4, 9, 30] {
        let config = coarsening(two(size)).with(|it| {
            it.smoothing_level = 0;
            it.thickness_level = 0;
            it.max_iterations = cap;
        });
        let flat = Rig::new(&gpu, &config).draw(&unsmoothed(&shot));
        let mut rig = Rig::new(&gpu, &config);
        // The second frame starts from the state that the first one left.
        rig.draw(&shot);
        let drawn = rig.draw(&shot);
        let name = format!("back-levels-{cap}");
        let levels =
            Levels { view: shot.view(size), first: 0, coarser: 3, params: params(&shot, cap) };
        let needed = levels.needed(&wide(&drawn.depth)).data.into_iter().max().unwrap_or(0);
        let first = wide(&of(&flat).surface);
        let (surface, plan) = (&of(&drawn).surface, &of(&drawn).plan);
        let wanted = |near| levels.is_wanted(near, 1, true, false);
        let (smoothed, _) = check_level(&name, (surface, plan), &first, &levels, 1, wanted);
        wanted_of[0] += smoothed;
        for (i, (surface, plan)) in of(&drawn).coarser.iter().enumerate() {
            let level = i as u32 + 2;
            if level > needed {
                continue;
            }
            // The nearest texel is taken even if the texels belong to different surfaces.
            let reduced = reduce::nearest(&first, level - 1);
            let wanted = |near| levels.is_wanted(near, level, false, level == 3);
            let name = format!("{name}-{level}");
            let (smoothed, _) =
                check_level(&name, (surface, plan), &reduced, &levels, level, wanted);
            wanted_of[i + 1] += smoothed;
        }
    }
    assert!(wanted_of.iter().all(|texels| *texels > 50), "{wanted_of:?} texels");
}
