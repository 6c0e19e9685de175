//! Compares pass `smooth`, curvature flow, with the CPU twin on the same input and plan, and
//! compares all its forms with each other.

use whitewater::water::{Gate, Rule, Smoothing};

use crate::reduce::{decoded, params, rules, wide};
use crate::reference;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens};
use crate::support::tolerance;

/// A block of particles, and single ones before and behind it.
fn water(size: ash::vk::Extent2D, lens: Lens) -> Shot {
    let mut points = scenes::block(3, 0.25, [14, 8, 4], [-1.8, -1.0, 4.0]);
    points.extend(scenes::cloud(4, 12, 1.5, 12.0));
    Shot::new(size, lens, 0.2, &points)
}

#[test]
fn the_surface_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for level in 0..3 {
        for (rule, twin) in rules() {
            let config = config(size).with(|it| {
                it.smoothing_level = level;
                it.thickness_level = 0;
                it.rule = rule;
            });
            let mut rig = Rig::new(&gpu, &config);
            let lenses: &[Lens] = match (level, rule) {
                (1, Rule::ConstantWidth) => &LENSES,
                _ => &[Lens::Standard, Lens::OffAxis],
            };
            for lens in lenses {
                let shot = water(size, *lens);
                let drawn = rig.draw(&shot);
                let params = params(&shot, config.max_iterations);
                let view = shot.view(size).reduced(level);
                let reduced = reference::reduce::reduce(&wide(&drawn.depth), level, shot.falloff());
                let plan = decoded(&drawn, twin, &params);
                let (expected, error) = tolerance::smoothing(&reduced, &plan, &view, twin, &params);
                let name = format!("smooth-{rule:?}-{level}-{lens:?}").replace(['(', ')'], "");
                let census =
                    compare::close(&name, &drawn.surface, &expected, 0, |x, y, _| error.at(x, y));
                // The bound must be much smaller than the effect of the smoothing.
                let mut errors: Vec<f64> =
                    error.data.iter().copied().filter(|e| *e > 0.0).collect();
                errors.sort_by(f64::total_cmp);
                let median = errors[errors.len() / 2];
                let moved: f64 = (reduced.data.iter().zip(&expected.data))
                    .filter(|(a, _)| **a < 1e9)
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, f64::max);
                assert!(median < 0.02 * params.radius, "{name}: a bound of {median} shows nothing");
                assert!(moved > 0.1 * params.radius, "{name}: nothing was smoothed");
                if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
                    eprintln!("{name}: median bound {median:.2e}, {census}");
                }
            }
        }
    }
}

/// Every form of the smoothing that the device can run.
pub fn forms(gpu: &Gpu) -> Vec<Smoothing> {
    let mut forms = vec![Smoothing::Tiles, Smoothing::Fused, Smoothing::Query(Gate::VertexCull)];
    if gpu.enabled.draw_indirect_count {
        forms.push(Smoothing::Query(Gate::DrawCount));
    }
    if gpu.enabled.conditional_rendering {
        forms.push(Smoothing::Query(Gate::Predicate));
    }
    forms
}

/// All forms do the same arithmetic, so surfaces are equal bit for bit.
#[test]
fn all_forms_give_the_same_surface() {
    let gpu = Gpu::shared();
    let forms = forms(&gpu);
    for (size, cap) in [(extent(97, 61), 256), (extent(130, 35), 7), (extent(3, 5), 40)] {
        for (rule, _) in rules() {
            let mut first = None;
            for form in &forms {
                let config = config(size).with(|it| {
                    it.smoothing_level = 0;
                    it.thickness_level = 0;
                    it.smoothing = Some(*form);
                    it.max_iterations = cap;
                    it.rule = rule;
                });
                let mut rig = Rig::new(&gpu, &config);
                let shot = water(size, Lens::OffAxis);
                // The second frame finds the first one's contents in the images.
                rig.draw(&shot);
                let surface = rig.draw(&shot).surface;
                let first = first.get_or_insert_with(|| surface.clone());
                let name = format!("forms-{form:?}-{rule:?}-{}", size.width);
                compare::same(&name.replace(['(', ')'], ""), &surface, first);
            }
        }
    }
}
