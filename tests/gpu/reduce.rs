//! Pass `reduce`: occlusion by the scene, the nearest surface of each block, and the plan of the
//! smoothing.

use whitewater::water::Rule;

use crate::reference::smooth::{self, Params};
use crate::reference::{self, EMPTY, Image, View, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens};
use crate::support::tolerance::U;

/// A depth image as the twins take it.
pub fn wide(image: &Image<f32>) -> Image<f64> {
    image.map(|d| if *d < 1e9 { f64::from(*d) } else { EMPTY })
}

fn narrow(image: &Image<f64>) -> Image<f32> {
    image.map(|d| *d as f32)
}

/// Draws without smoothing, so that the surface is the reduced depth.
fn unsmoothed(rig: &mut Rig<'_>, shot: &Shot) -> Drawn {
    let mut shot = shot.clone();
    shot.settings.water.smoothing_width = 0.0;
    rig.draw(&shot)
}

/// A minimum rounds nothing, so the comparison is bit for bit.
#[test]
fn each_block_keeps_its_nearest_surface() {
    let gpu = Gpu::shared();
    for (width, height) in [(96, 64), (33, 17), (5, 3), (1, 7), (1, 1), (130, 2)] {
        for level in 0..3 {
            let size = extent(width, height);
            let config = config(size).with(|it| {
                it.smoothing_level = level;
                it.thickness_level = level;
            });
            let mut rig = Rig::new(&gpu, &config);
            let points = scenes::cloud(11, 300, 1.0, 9.0);
            let shot = Shot::new(size, Lens::Reversed, 0.12, &points);
            let drawn = unsmoothed(&mut rig, &shot);
            let expected = reference::reduce::reduce(&wide(&drawn.depth), level, shot.falloff());
            let name = format!("reduce-{width}x{height}-{level}");
            compare::same(&name, &drawn.surface, &narrow(&expected));
            assert!(
                drawn.plan.data.iter().all(|p| p & 511 == 0),
                "{name}: no width, no iterations"
            );
        }
    }
}

/// Where water and scene are as close as the scene's depth is rounded, a pixel may be hidden or
/// not.
#[test]
fn what_the_scene_hides_is_gone() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let points = scenes::cloud(5, 500, 1.0, 12.0);
    let mut rig = Rig::new(&gpu, &config(size).with(|it| it.smoothing_level = 1));
    for lens in LENSES {
        for depth_extent in [size, extent(192, 128), extent(50, 31), extent(1, 1)] {
            let mut shot = Shot::new(size, lens, 0.2, &points);
            shot.depth_extent = depth_extent;
            shot.scene_depth(|_, _| None);
            let open = unsmoothed(&mut rig, &shot);
            shot.scene_depth(|x, y| ((x / 7 + y / 5) % 3 != 0).then_some(2.0 + f64::from(x % 11)));
            let drawn = unsmoothed(&mut rig, &shot);
            let scene = shot.scene_at(size, 0);
            let name = format!("occlusion-{lens:?}-{}", depth_extent.width);
            let mut expected = reference::reduce::clip(&wide(&open.depth), Some(&scene));
            for (i, pixel) in expected.data.iter_mut().enumerate() {
                let (water, scene) = (f64::from(open.depth.data[i]), scene.data[i]);
                if (water - scene).abs() <= 8.0 * U * scene {
                    *pixel = wide(&drawn.depth).data[i];
                }
            }
            compare::same(&name, &drawn.depth, &narrow(&expected));
            let reduced = reference::reduce::reduce(&wide(&drawn.depth), 1, shot.falloff());
            compare::same(&format!("{name}-reduced"), &drawn.surface, &narrow(&reduced));
            let hidden = (open.depth.data.iter().zip(&drawn.depth.data))
                .filter(|(a, b)| a.to_bits() != b.to_bits())
                .count();
            assert!(hidden > 20 || depth_extent.width == 1, "{name}: {hidden} hidden");
        }
    }
}

/// Each rule, for the library and for the twin.
pub fn rules() -> [(Rule, smooth::Rule); 3] {
    [
        (Rule::ConstantWidth, smooth::Rule::ConstantWidth),
        (Rule::Source, smooth::Rule::Source),
        (Rule::Fixed(40), smooth::Rule::Fixed(40)),
    ]
}

/// The twin's parameters for a shot.
pub fn params(shot: &Shot, cap: u32) -> Params {
    let water = &shot.settings.water;
    let radius = f64::from(water.radius());
    Params {
        radius,
        sigma_w: f64::from(water.smoothing_width * water.radius()),
        depth_falloff: f64::from(water.depth_falloff * water.radius()),
        cap,
    }
}

/// Largest step of a rule. The plan stores a step as a fraction of it in 23 bits.
fn most(rule: smooth::Rule, params: &Params) -> f64 {
    match rule {
        smooth::Rule::ConstantWidth => 0.25,
        _ => 0.053 * params.radius,
    }
}

/// Iterations and steps that the GPU planned.
pub fn decoded(drawn: &Drawn, rule: smooth::Rule, params: &Params) -> Image<(u32, f64)> {
    decoded_plan(&drawn.plan, rule, params)
}

/// Iterations and steps of a plan of any level.
pub fn decoded_plan(plan: &Image<u32>, rule: smooth::Rule, params: &Params) -> Image<(u32, f64)> {
    let most = most(rule, params);
    plan.map(|p| (p & 511, f64::from(p >> 9) / 8_388_607.0 * most))
}

/// Checks that a plan is the twin's. The step is stored as a 23-bit fraction of the largest step,
/// from numbers with an error of 16u. The count may be one more or less if its exact value is that
/// close to a whole number.
pub fn assert_planned(
    name: &str,
    found: &Image<(u32, f64)>,
    reduced: &Image<f64>,
    view: &View,
    twin: smooth::Rule,
    params: &Params,
) {
    let expected = smooth::plan(reduced, view, twin, params);
    let whole = Params { cap: u32::MAX, ..*params };
    let uncapped = smooth::plan(reduced, view, twin, &whole);
    for (i, (n, step)) in found.data.iter().enumerate() {
        let (want, want_step) = expected.data[i];
        let at = (i % view.width, i / view.width);
        let steps = f64::from(uncapped.data[i].0.max(1));
        // The exact value that is rounded up: 2 kappa N steps of it make sigma squared.
        let exact = match twin {
            smooth::Rule::ConstantWidth => {
                let s = view.ray(at.0, at.1).truncate();
                let shape = view.c_x() / view.c_y();
                let spread = 1.0 + s.x * s.x + (1.0 + s.y * s.y) * shape * shape;
                2.0 * want_step * steps * spread
            }
            _ if is_surface(reduced.data[i]) => {
                4.8 * params.radius / (view.c_x() * reduced.data[i])
            }
            _ => 0.5,
        };
        let near = (exact - exact.round()).abs() <= 32.0 * U * exact;
        assert!(*n == want || near, "{name} at {at:?}: {n} iterations, expected {want}");
        let share = most(twin, params) / 8_388_607.0 + 32.0 * U * want_step;
        // One iteration fewer makes each step larger by this.
        let fewer = want_step / (steps - 1.0).max(1.0);
        let share = if near { share + fewer } else { share };
        let off = (step - want_step).abs();
        assert!(
            off <= share,
            "{name} at {at:?}: step {step}, expected {want_step}; to be rounded up: {exact}"
        );
    }
}

#[test]
fn the_plan_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (level, radius, cap) in [(0, 0.1, 256), (1, 0.2, 256), (1, 0.3, 25), (2, 0.3, 256)] {
        for (rule, twin) in rules() {
            let config = config(size).with(|it| {
                it.smoothing_level = level;
                it.thickness_level = level;
                it.rule = rule;
                it.max_iterations = cap;
                it.coarsening = 0;
            });
            let mut rig = Rig::new(&gpu, &config);
            for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
                let shot = Shot::new(size, lens, radius, &scenes::cloud(9, 300, 1.0, 30.0));
                let drawn = rig.draw(&shot);
                let params = params(&shot, cap);
                let reduced = reference::reduce::reduce(&wide(&drawn.depth), level, shot.falloff());
                let view = shot.view(size).reduced(level);
                let found = decoded(&drawn, twin, &params);
                let name = format!("{rule:?} {lens:?} level {level}");
                assert_planned(&name, &found, &reduced, &view, twin, &params);
                let busy = found.data.iter().filter(|p| p.0 > 0).count();
                assert!(busy * 20 > found.data.len(), "{busy} pixels are planned");
            }
        }
    }
}
