//! Pass `level`: near views are smoothed a level coarser, by the GPU's own choice.

use whitewater::Config;
use whitewater::water::{Gate, Rule, Shading, Smoothing};

use crate::reduce::{params, wide};
use crate::reference::{self, smooth};
use crate::shading::close;
use crate::smooth::forms;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens};

/// Odd, so that no level divides it.
const SIZE: (u32, u32) = (97, 61);

fn shot() -> Shot {
    let points = scenes::block(3, 0.25, [14, 8, 4], [-1.8, -1.0, 4.0]);
    let mut shot = Shot::new(extent(SIZE.0, SIZE.1), Lens::OffAxis, 0.2, &points);
    // Counts of a hundred and more, so that one more of them is a small step.
    shot.settings.water.smoothing_width = 3.2;
    shot
}

fn at(level: u32, coarsening: u32, cap: u32) -> Config {
    Config {
        smoothing_level: level,
        thickness_level: 3,
        coarsening,
        max_iterations: cap,
        ..config(extent(SIZE.0, SIZE.1))
    }
}

fn draw(gpu: &Gpu, config: &Config) -> Drawn {
    let mut rig = Rig::lit(gpu, config, 1);
    let shot = shot();
    // The second frame starts from what the first one left.
    rig.draw(&shot);
    rig.draw(&shot)
}

/// Iterations of all pixels of a level without a cap, most first.
fn wanted(drawn: &Drawn, level: u32) -> Vec<u32> {
    let shot = shot();
    let reduced = reference::reduce::reduce(&wide(&drawn.depth), level, shot.falloff());
    let view = shot.view(extent(SIZE.0, SIZE.1)).reduced(level);
    let uncapped = params(&shot, u32::MAX);
    let plan = smooth::plan(&reduced, &view, smooth::Rule::ConstantWidth, &uncapped);
    let mut counts: Vec<u32> = plan.data.iter().map(|p| p.0).collect();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    counts
}

/// A cap that `share` of the picture's pixels would pass at a level so much coarser.
fn cap(counts: &[u32], share: f64, coarser: u32) -> u32 {
    let n = counts[(share * counts.len() as f64) as usize];
    (n - 2) / 4_u32.pow(coarser) + 2
}

/// How far the choice goes, by the definition: a sum of fades, one a level.
fn choice(counts: &[u32], cap: u32, coarsening: u32) -> f64 {
    (0..coarsening)
        .map(|k| {
            let limit = (f64::from(cap) - 2.0) * f64::from(4_u32.pow(k)) + 2.0;
            let capped = counts.iter().filter(|n| f64::from(**n) > limit).count();
            let t = (capped as f64 / counts.len() as f64 * 16.0 - 0.25) / 0.75;
            let t = t.clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        })
        .sum()
}

/// Bit for bit what a renderer gives that is configured so coarse: in every form of the smoothing.
#[test]
fn a_coarser_level_is_the_configured_one() {
    let gpu = Gpu::shared();
    let free = draw(&gpu, &at(0, 0, 256));
    let forms = forms(&gpu);
    for (level, coarser) in [(0, 1), (0, 2), (1, 1)] {
        let counts = wanted(&free, level);
        // Most of the water would be over the cap one level finer.
        let cap = cap(&counts, 0.15, coarser - 1) - 1;
        assert!((choice(&counts, cap, 3) - f64::from(coarser)).abs() < 1e-6, "not the case meant");
        for form in &forms {
            let name = format!("level-{level}-{coarser}-{form:?}").replace(['(', ')'], "");
            let config = Config { smoothing: Some(*form), ..at(level, 3, cap) };
            let chosen = draw(&gpu, &config);
            let same = Config { smoothing_level: level + coarser, coarsening: 0, ..config };
            let expected = draw(&gpu, &same);
            assert_eq!(chosen.levels.finer().texel[2], f32::from(1_u8 << (level + coarser)));
            assert_eq!(chosen.levels.finer().texel[3], 1.0, "{name}: not alone");
            assert!(chosen.plan.data == expected.plan.data, "{name}: other plans");
            compare::same(&name, &chosen.surface, &expected.surface);
            assert!(chosen.output.data == expected.output.data, "{name}: other pictures");
        }
    }
}

/// Between two levels both are smoothed, each as if alone, and the picture goes from one to the
/// other.
#[test]
fn the_coarser_level_fades_in() {
    let gpu = Gpu::shared();
    let free = draw(&gpu, &at(0, 0, 256));
    let counts = wanted(&free, 0);
    let mut caps = counts.clone();
    caps.dedup();
    let (mut last, mut faded) = (0.0, 0);
    for cap in caps {
        let expected = choice(&counts, cap, 3);
        let fade = expected.fract();
        if !(0.02..0.98).contains(&fade) || expected > 1.0 {
            continue;
        }
        let drawn = draw(&gpu, &at(0, 3, cap));
        let fine = draw(&gpu, &at(0, 0, cap));
        let coarse = draw(&gpu, &at(1, 0, cap));
        let [_, second, _] = &drawn.levels.level;
        faded += 1;
        // The share is a quotient of whole numbers, the fade a cubic of it: a few roundings.
        assert!(
            (f64::from(second.texel[3]) - fade).abs() < 1e-5,
            "cap {cap}: a fade of {}, expected {fade}",
            second.texel[3]
        );
        let name = format!("fade-{cap}");
        let (surface, plan) = drawn.coarser.as_ref().expect("a second level");
        compare::same(&name, &drawn.surface, &fine.surface);
        compare::same(&format!("{name}-coarser"), surface, &coarse.surface);
        assert!(plan.data == coarse.plan.data, "{name}: other plans");
        let stored = Config { composite: Some(Shading::Compute), ..at(0, 3, cap) };
        close(&name, stored.output_format, &draw(&gpu, &stored), &drawn);
        let from_fine = difference(&drawn, &fine);
        let way = from_fine / (from_fine + difference(&drawn, &coarse));
        assert!(way > last, "{name}: {way} of the way after {last}");
        assert!((way - fade).abs() < 0.25, "{name}: {way} of the way at a fade of {fade}");
        last = way;
    }
    assert!(faded >= 3, "{faded} fades tested");
}

/// Mean difference of two pictures.
fn difference(a: &Drawn, b: &Drawn) -> f64 {
    let texels = a.output.data.iter().zip(&b.output.data);
    texels.map(|(a, b)| f64::from((a[0] - b[0]).abs())).sum::<f64>() / a.output.data.len() as f64
}

/// A drop before the lens is capped; it does not cost the picture its resolution.
#[test]
fn a_drop_before_the_lens_changes_no_level() {
    let gpu = Gpu::shared();
    let mut shot = shot();
    let counts = wanted(&draw(&gpu, &at(0, 0, 256)), 0);
    // In the middle of the view, much nearer than the block.
    shot.positions.push([2.5, 1.5, 1.0]);
    let mut rig = Rig::new(&gpu, &at(0, 3, counts[0]));
    let drawn = rig.draw(&shot);
    let capped = drawn.plan.data.iter().filter(|p| **p & 511 == counts[0]).count();
    assert!(capped > 10, "the drop is not near enough to be capped: {capped} pixels");
    assert_eq!(drawn.levels.finer().texel[2], 1.0);
    assert!(drawn.coarser.is_none());
}

/// The source's rules keep the source's cap, and nothing makes a fixed count more.
#[test]
fn other_rules_stay() {
    let gpu = Gpu::shared();
    for rule in [Rule::Source, Rule::Fixed(40)] {
        let drawn = draw(&gpu, &Config { rule, ..at(0, 3, 2) });
        assert_eq!(drawn.levels.finer().texel[2], 1.0, "{rule:?}");
        assert!(drawn.coarser.is_none(), "{rule:?}");
    }
}

/// Nothing is too small to go coarser, and the second level fits below the first at any size.
#[test]
fn small_images_go_coarser_too() {
    let gpu = Gpu::shared();
    for (width, height) in [(1, 1), (2, 1), (1, 7), (5, 3), (16, 16), (17, 33), (70, 19)] {
        for level in 0..3 {
            for smoothing in
                [Smoothing::Tiles, Smoothing::Fused, Smoothing::Query(Gate::VertexCull)]
            {
                let size = extent(width, height);
                let config = Config {
                    smoothing_level: level,
                    max_iterations: 3,
                    smoothing: Some(smoothing),
                    ..config(size)
                };
                let mut rig = Rig::new(&gpu, &config);
                let mut shot = Shot::new(size, Lens::Reversed, 1.0, &[[0.0, 0.0, 2.0]]);
                shot.settings.water.smoothing_width = 40.0;
                let drawn = rig.draw(&shot);
                let finer = drawn.levels.finer();
                let edge = finer.texel[2] as u32;
                assert_eq!(
                    finer.rect[2..].iter().map(|v| *v as u32).collect::<Vec<_>>(),
                    [width.div_ceil(edge), height.div_ceil(edge)]
                );
                let expected =
                    reference::reduce::reduce(&wide(&drawn.depth), edge.ilog2(), shot.falloff());
                let covered = |image: &[f64]| image.iter().filter(|z| **z < 1e9).count();
                let surface = wide(&drawn.surface);
                assert!(edge > 1 << level, "{width}x{height} at {level}: {edge}");
                assert!(covered(&surface.data) > 0, "{width}x{height}: no water");
                assert_eq!(covered(&surface.data), covered(&expected.data), "{width}x{height}");
            }
        }
    }
}
