//! Levels of the smoothing: near water is smoothed and drawn at coarser levels, each pixel by its
//! own distance.

use whitewater::Config;
use whitewater::water::{Fresnel, Gate, Rule, Shading, Smoothing};

use crate::reduce::{assert_planned, decoded_plan, params, wide};
use crate::reference::levels::{Levels, Smoothed};
use crate::reference::{EMPTY, Image, is_surface, reduce, smooth};
use crate::shading::close;
use crate::smooth::forms;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, coarsening, config, extent};
use crate::support::scenes::{self, Lens};
use crate::support::slow;
use crate::support::tolerance;

/// Odd numbers, which no level divides.
const SIZE: (u32, u32) = (97, 61);

/// A pool seen along its surface, from so near that all levels are drawn.
fn pool() -> Shot {
    let mut points = scenes::block(3, 0.1, [40, 3, 60], [-2.0, -0.9, 0.8]);
    points.extend(scenes::block(4, 0.1, [6, 6, 2], [0.3, -0.2, 2.6]));
    let mut shot = Shot::new(extent(SIZE.0, SIZE.1), Lens::OffAxis, 0.08, &points);
    shot.settings.water.smoothing_width = 2.0;
    shot
}

fn at(level: u32, coarsening: u32, cap: u32) -> Config {
    config(extent(SIZE.0, SIZE.1)).with(|it| {
        it.smoothing_level = level;
        it.thickness_level = 3;
        it.coarsening = coarsening;
        it.max_iterations = cap;
        it.max_particles = 10_000;
    })
}

fn draw(gpu: &Gpu, config: &Config, shot: &Shot) -> Drawn {
    let mut rig = Rig::lit(gpu, config, 1);
    // The second frame finds the first one's contents in the images.
    rig.draw(shot);
    let mut drawn = rig.draw(shot);
    drawn.coarser = coarser(&drawn, shot, config.max_iterations);
    drawn
}

/// Surface and plan of each coarser level, without the texels that this frame did not write.
pub fn coarser(drawn: &Drawn, shot: &Shot, cap: u32) -> Vec<(Image<f32>, Image<u32>)> {
    let levels = levels(drawn, shot, cap);
    let needed = levels.needed(&wide(&drawn.depth));
    let own = |((surface, plan), level): (&(_, _), u32)| {
        let surface = levels.made(&needed, level, surface, EMPTY as f32);
        (surface, levels.made(&needed, level, plan, 0))
    };
    drawn.coarser.iter().zip(1..).map(own).collect()
}

/// The twin of a frame's levels.
fn levels(drawn: &Drawn, shot: &Shot, cap: u32) -> Levels {
    Levels {
        view: shot.view(shot.size),
        first: (drawn.levels.level[0].texel[2] as u32).ilog2(),
        coarser: drawn.coarser.len() as u32,
        params: params(shot, cap),
    }
}

/// A frame's smoothed surfaces, as the twin takes them.
pub fn smoothed<'a>(drawn: &'a Drawn, shot: &Shot, cap: u32) -> Smoothed<'a> {
    let coarser = drawn.coarser.iter().map(|(surface, _)| surface);
    let surfaces = std::iter::once(&drawn.surface).chain(coarser).collect();
    Smoothed { levels: levels(drawn, shot, cap), surfaces }
}

/// Checks that a level's plan is the twin's at texels that are `wanted` and 0 elsewhere, and that
/// its surface is what the twin computes from the plan. Returns how many texels are smoothed, and
/// how many with water are not.
pub fn check_level(
    name: &str,
    (surface, plan): (&Image<f32>, &Image<u32>),
    reduced: &Image<f64>,
    levels: &Levels,
    level: u32,
    wanted: impl Fn(f64) -> bool,
) -> (usize, usize) {
    let (view, params) = (levels.view.reduced(levels.first + level), &levels.params);
    let rule = smooth::Rule::ConstantWidth;
    let found = decoded_plan(plan, rule, params);
    let twin = smooth::plan(reduced, &view, rule, params);
    let (mut compared, mut smoothed, mut left) = (twin.clone(), 0, 0);
    for (x, y) in (0..view.height).flat_map(|y| (0..view.width).map(move |x| (x, y))) {
        let z = reduced.at(x, y);
        if !is_surface(z) {
            continue;
        }
        let near = levels.nearness(view.ray(x, y).truncate(), z);
        // The nearness is rounded a few times.
        let either = [1.0 - 1e-5, 1.0 + 1e-5].map(|off| wanted(near * off));
        if either[0] && either[1] || either[0] != either[1] && plan.at(x, y) != 0 {
            *compared.at_mut(x, y) = found.at(x, y);
            smoothed += 1;
        } else {
            assert_eq!(plan.at(x, y), 0, "{name}: ({x}, {y}) at {z} is not wanted");
            left += 1;
        }
    }
    assert_planned(name, &compared, reduced, &view, rule, params);
    let (expected, error) = tolerance::smoothing(reduced, &found, &view, rule, params);
    compare::close(name, surface, &expected, 0, |x, y, _| error.at(x, y));
    (smoothed, left)
}

/// Every level is planned and smoothed where it is drawn and a little around, from the depth of the
/// tiles that need it. All forms of the smoothing give the same bits.
#[test]
fn levels_are_the_twins() {
    let gpu = Gpu::shared();
    let (shot, forms) = (pool(), forms(&gpu));
    for (first, coarsening, cap) in [(0, 3, 40), (1, 2, 12), (0, 1, 256), (0, 2, 3)] {
        let mut before: Option<Drawn> = None;
        for form in &forms {
            let name =
                format!("levels-{first}-{coarsening}-{cap}-{form:?}").replace(['(', ')'], "");
            let config = at(first, coarsening, cap).with(|it| it.smoothing = Some(*form));
            let drawn = draw(&gpu, &config, &shot);
            assert_eq!(drawn.coarser.len(), coarsening as usize, "{name}");
            if let Some(before) = &before {
                compare::same(&name, &drawn.surface, &before.surface);
                for (a, b) in drawn.coarser.iter().zip(&before.coarser) {
                    compare::same(&name, &a.0, &b.0);
                    assert!(a.1 == b.1, "{name}: other plans");
                }
                assert!(drawn.output.data == before.output.data, "{name}: other pictures");
                continue;
            }
            let levels = levels(&drawn, &shot, cap);
            let depth = wide(&drawn.depth);
            let needed = levels.needed(&depth);
            for level in 0..=coarsening {
                let mut reduced = reduce::reduce(&depth, first + level, shot.falloff());
                if level > 0 {
                    reduced = Image::from_fn(reduced.width, reduced.height, |x, y| {
                        let made = levels.is_made(&needed, level, (x / 16, y / 16));
                        if made { reduced.at(x, y) } else { EMPTY }
                    });
                }
                let images = match level {
                    0 => (&drawn.surface, &drawn.plan),
                    _ => {
                        (&drawn.coarser[level as usize - 1].0, &drawn.coarser[level as usize - 1].1)
                    }
                };
                let (finest, coarsest) = (level == 0, level == coarsening);
                let wanted = |near| levels.is_wanted(near, level, finest, coarsest);
                let name = format!("{name}-{level}");
                let (smoothed, left) = check_level(&name, images, &reduced, &levels, level, wanted);
                // With the smallest cap, the first levels are hardly drawn.
                assert!(
                    smoothed > 10 || cap == 3 && level < coarsening,
                    "{name}: {smoothed} texels"
                );
                let ends = cap == 40 && level < coarsening;
                assert!(!ends || left > 10, "{name}: all of {smoothed} texels are wanted");
            }
            before = Some(drawn);
        }
    }
}

/// So large that no iterations are missing.
const CAP: u32 = 200;

/// Water at nearly one depth, with the smoothing width that gives this nearness to the finest level
/// (see `Levels`).
fn cloud(nearness: f64, cap: u32) -> Shot {
    let points = scenes::block(3, 0.25, [14, 8, 2], [-1.8, -1.0, 4.0]);
    let mut shot = Shot::new(extent(SIZE.0, SIZE.1), Lens::Standard, 0.2, &points);
    shot.settings.water.smoothing_width = 1.0;
    let levels =
        Levels { view: shot.view(shot.size), first: 0, coarser: 3, params: params(&shot, cap) };
    let one = levels.nearness(glam::DVec2::ZERO, 4.1);
    shot.settings.water.smoothing_width = (nearness / one).sqrt() as f32;
    shot
}

/// Min and max nearness of the water in a frame.
fn range(drawn: &Drawn, levels: &Levels) -> [f64; 2] {
    let depth = wide(&drawn.depth);
    let all = (0..depth.data.len())
        .filter(|i| is_surface(depth.data[*i]))
        .map(|i| levels.nearness_at((i % depth.width, i / depth.width), depth.data[i]));
    all.fold([f64::INFINITY, 0.0], |[low, high], near| [low.min(near), high.max(near)])
}

/// If one coarser level is drawn everywhere, the result is that of a renderer configured for this
/// level: the surface bit for bit, the picture except for rounding.
#[test]
fn a_coarser_level_is_the_configured_one() {
    let gpu = Gpu::shared();
    for (first, coarser, shading) in [
        (0, 1, Shading::Raster),
        (0, 2, Shading::Compute),
        (1, 1, Shading::Compute),
        (0, 2, Shading::Raster),
    ] {
        let shot = cloud(2.6 * 4.0_f64.powi((first + coarser) as i32 - 1), CAP);
        let config = at(first, 2, CAP).with(|it| it.composite = Some(shading));
        let drawn = draw(&gpu, &config, &shot);
        let name = format!("level-{first}-{coarser}");
        let [low, high] = range(&drawn, &levels(&drawn, &shot, CAP));
        let own = 4.0_f64.powi(coarser as i32);
        assert!(low > 0.5 * own && high < own, "{name}: {low} to {high}, not the case meant");
        let same = config.with(|it| {
            it.smoothing_level = first + coarser;
            it.coarsening = 0;
        });
        let expected = draw(&gpu, &same, &shot);
        let (surface, plan) = &drawn.coarser[coarser as usize - 1];
        assert!(plan.data == expected.plan.data, "{name}: other plans");
        compare::same(&name, surface, &expected.surface);
        // Another shader may add in another order.
        close(&name, config.output_format, &drawn, &expected);
    }
}

/// Between two levels each pixel is a mixture by its own distance. Only the slope is interpolated
/// linearly, the colour nearly so, against a scene with even gradients. Each pixel gives (found -
/// fine) / (coarse - fine); the test compares their mean, weighted by the squared differences, with
/// that of the fades. Only pixels inside the water count, because at rims the thickness follows the
/// finer level.
#[test]
fn the_next_level_fades_in() {
    let gpu = Gpu::shared();
    // With so few iterations the levels are rough and differ clearly.
    let cap = 6;
    let mut last = 0.0;
    for nearness in [0.85, 1.0, 1.15, 1.3, 1.45] {
        let mut shot = cloud(nearness, cap);
        for (i, color) in shot.color.iter_mut().enumerate() {
            let (x, y) = (i % SIZE.0 as usize, i / SIZE.0 as usize);
            *color = [x as f32 / 97.0, y as f32 / 61.0, 0.5, 1.0];
        }
        let water = &mut shot.settings.water;
        (water.fresnel, water.specular) =
            (Fresnel::Source { bias: 0.0, scale: 0.0, power: 1.0 }, 0.0);
        let drawn = draw(&gpu, &at(0, 3, cap), &shot);
        let levels = levels(&drawn, &shot, cap);
        let fine = draw(&gpu, &at(0, 0, cap), &shot);
        let coarse = draw(&gpu, &at(1, 0, cap), &shot);
        let name = format!("fade-{nearness}");
        compare::same(&name, &drawn.surface, &fine.surface);
        compare::same(&format!("{name}-coarser"), &drawn.coarser[0].0, &coarse.surface);
        let stored = at(0, 3, cap).with(|it| it.composite = Some(Shading::Compute));
        close(&name, stored.output_format, &draw(&gpu, &stored, &shot), &drawn);
        let [mut way, mut fades, mut weights] = [0.0; 3];
        let inside = |i: &usize| {
            let (x, y) = (i % SIZE.0 as usize, i / SIZE.0 as usize);
            let wet =
                |i: isize| drawn.depth.clamped(x as isize + i % 13 - 6, y as isize + i / 13 - 6);
            (0..169).all(|i| wet(i) < 1e9)
        };
        for i in (0..drawn.depth.data.len()).filter(inside) {
            let at = (i % SIZE.0 as usize, i / SIZE.0 as usize);
            let near = levels.nearness_at(at, f64::from(drawn.depth.data[i]));
            let (level, fade) = levels.shown(near);
            assert_eq!(level, 0, "{name}: not the case meant");
            for channel in 0..3 {
                let [found, a, b] =
                    [&drawn, &fine, &coarse].map(|d| f64::from(d.output.data[i][channel]));
                way += (found - a) * (b - a);
                fades += fade * (b - a).powi(2);
                weights += (b - a).powi(2);
            }
        }
        let [way, fade] = [way, fades].map(|sum| sum / weights);
        eprintln!("{name}: {way} of the way at a fade of {fade}");
        assert!((way - fade).abs() < 0.05, "{name}: {way} of the way at a fade of {fade}");
        assert!(way > last, "{name}: {way} of the way after {last}");
        last = way;
    }
    assert!(last > 0.7, "{last} of the way at last");
}

/// Far water is equal to the bit whether or not a drop hangs close before the camera.
#[test]
fn a_drop_before_the_lens_changes_nothing_else() {
    let gpu = Gpu::shared();
    for sheets in [1, 2] {
        let mut shot = cloud(0.5, CAP);
        // A drop in the middle of the view, much nearer than the block.
        shot.positions.push([2.5, 1.5, 1.0]);
        let config = at(0, 3, CAP).with(|it| it.sheets = sheets);
        let drawn = draw(&gpu, &config, &shot);
        let expected = draw(&gpu, &config.with(|it| it.coarsening = 0), &shot);
        let levels = levels(&drawn, &shot, CAP);
        let (mut near, mut far, mut other) = (0, 0, 0);
        for i in 0..drawn.depth.data.len() {
            let z = f64::from(drawn.depth.data[i]);
            let at = (i % SIZE.0 as usize, i / SIZE.0 as usize);
            let same = drawn.output.data[i] == expected.output.data[i];
            if is_surface(z) && levels.nearness_at(at, z) >= 1.0 {
                near += 1;
                other += usize::from(!same);
                continue;
            }
            far += usize::from(is_surface(z));
            assert!(
                same,
                "{at:?} at {z}: {:?}, {:?}",
                drawn.output.data[i], expected.output.data[i]
            );
        }
        assert!(near > 50 && far > 500 && other > 10, "{near} near, {other} other, {far} far");
    }
}

/// The source's rules keep their cap, and a fixed iteration count is never exceeded, so there are
/// no coarser levels.
#[test]
fn other_rules_stay() {
    let gpu = Gpu::shared();
    for rule in [Rule::Source, Rule::Fixed(40)] {
        let config = at(0, 3, 2).with(|it| it.rule = rule);
        let drawn = draw(&gpu, &config, &pool());
        assert!(drawn.coarser.is_empty(), "{rule:?}");
        let none = draw(&gpu, &config.with(|it| it.coarsening = 0), &pool());
        assert!(drawn.output.data == none.output.data, "{rule:?}");
    }
}

/// Images of any size have coarser levels; in memory the levels are whole tiles apart.
#[test]
fn small_images_go_coarser_too() {
    let gpu = Gpu::shared();
    let sizes = [(1, 1), (2, 1), (1, 7), (5, 3), (16, 16), (17, 33), (70, 19)];
    for (turn, (width, height)) in (0..).zip(sizes) {
        for level in 0..3 {
            let forms = [Smoothing::Tiles, Smoothing::Fused, Smoothing::Query(Gate::VertexCull)];
            for (form, smoothing) in (0..).zip(forms) {
                // Each size and each level with each form, but not all combinations.
                if !slow() && form != (turn + level) % 3 {
                    continue;
                }
                let size = extent(width, height);
                let config = coarsening(config(size)).with(|it| {
                    it.smoothing_level = level;
                    it.max_iterations = 3;
                    it.smoothing = Some(smoothing);
                    it.sheets = 1 + level % 2;
                });
                let mut rig = Rig::new(&gpu, &config);
                let mut shot = Shot::new(size, Lens::Reversed, 1.0, &[[0.0, 0.0, 2.0]]);
                shot.settings.water.smoothing_width = 40.0;
                let drawn = rig.draw(&shot);
                let name = format!("{width}x{height} at {level}");
                let used = drawn.levels.level.iter().filter(|level| level.rect[2] > 0);
                let used: Vec<_> = used.map(|level| (level.rect, level.texel[2] as u32)).collect();
                assert_eq!(used.len(), if config.sheets > 1 { 7 } else { 4 }, "{name}");
                for (i, (rect, edge)) in used.iter().enumerate() {
                    let [x, y, w, h] = *rect;
                    let texels = [width, height].map(|pixels| pixels.div_ceil(*edge) as i32);
                    assert_eq!([w, h], texels, "{name}");
                    assert!(x % 16 == 0 && y % 16 == 0, "{name}: {rect:?}");
                    let [across, down, ..] = drawn.levels.atlas;
                    assert!(x + w <= across && y + h <= down, "{name}: {rect:?}");
                    for (other, _) in &used[..i] {
                        let tiles = |v: i32| (v + 15) / 16 * 16;
                        let apart = |k: usize| {
                            rect[k] >= other[k] + tiles(other[k + 2])
                                || other[k] >= rect[k] + tiles(rect[k + 2])
                        };
                        assert!(apart(0) || apart(1), "{name}: {rect:?} in {other:?}");
                    }
                }
                let (surface, _) = drawn.coarser.last().expect("three coarser levels");
                let expected = reduce::reduce(&wide(&drawn.depth), level + 3, shot.falloff());
                let covered = |image: &[f64]| image.iter().filter(|z| **z < 1e9).count();
                assert!(covered(&expected.data) > 0, "{name}: no water");
                assert_eq!(covered(&wide(surface).data), covered(&expected.data), "{name}");
            }
        }
    }
}
