//! Changes that must not affect the light: order of the particles, size of the frame.

use whitewater::LightVolume;
use whitewater::water::Shading;

use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, extent, is_around};
use crate::support::scenes::{Lens, Random};
use crate::support::slow;
use crate::support::tolerance::U;
use crate::surface_foam::Foamy;

use super::lit::is_nearly_half;
use super::{SIZE, casting, even, everything, maps, pool, toward};

/// The sums are in fixed point, so the order of the particles changes neither maps nor pictures by
/// a bit.
#[test]
fn the_order_of_particles_does_not_show_in_light() {
    let gpu = Gpu::shared();
    let mut case = Foamy::new(SIZE, Lens::Reversed, 30.0);
    let config = everything(&mut case);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let (_image, shadow) = even(&rig, 0.625);
    case.shot.shadow = Some(shadow);
    let expected = case.draw(&mut rig);
    for seed in 0..3 {
        let drawn = permuted(&case, seed).draw(&mut rig);
        let (a, b) = (maps(&drawn), maps(&expected));
        compare::same("order-front", a.front, b.front);
        compare::same_color("order-thickness", a.thickness, b.thickness);
        compare::same("order-caustics", a.caustics, b.caustics);
        let spray = |drawn: &Drawn| drawn.lit_spray.clone().expect("spray");
        compare::same("order-spray", &spray(&drawn), &spray(&expected));
        compare::same_color("order-output", &drawn.output, &expected.output);
    }
}

/// Far from the region's centre, a texel's thickness times distance has more digits than single
/// precision holds: it may differ by one rounding per term. The thickness itself is equal bit for
/// bit.
#[test]
fn the_order_of_particles_does_not_show_in_far_light() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &casting(64), 1);
    let mut case = pool(toward(0.2, 1.0, 0.1), 0.06, 12);
    case.shot.light_volume = Some(LightVolume { center: [0.0, 40.0, 0.0], radius: 45.0 });
    let expected = case.draw(&mut rig);
    for seed in 0..3 {
        let drawn = permuted(&case, seed).draw(&mut rig);
        let mut differ = 0;
        for (a, b) in maps(&drawn).thickness.data.iter().zip(&maps(&expected).thickness.data) {
            assert_eq!(a[..2], b[..2]);
            differ += usize::from(a != b);
            let most = U * case.shot.positions.len() as f64 * f64::from(b[2].abs());
            assert!(f64::from((a[2] - b[2]).abs()) <= most, "{a:?}, not {b:?}");
        }
        if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
            eprintln!("order-far: {differ} texels differ");
        }
    }
}

/// The same particles in another order.
fn permuted(case: &Foamy, seed: u64) -> Foamy {
    let order = Random(seed).order(case.shot.positions.len());
    fn turn<T: Copy>(all: &[T], order: &[usize]) -> Vec<T> {
        order.iter().map(|i| all[*i]).collect()
    }
    let mut other = case.clone();
    other.shot.positions = turn(&case.shot.positions, &order);
    other.shot.densities = case.shot.densities.as_ref().map(|d| turn(d, &order));
    other.amounts = turn(&case.amounts, &order);
    other.velocities = turn(&case.velocities, &order);
    other.ids = case.ids.as_ref().map(|ids| turn(ids, &order));
    other
}

/// Frames of one pixel, of odd sizes, and as a part of a larger image.
#[test]
fn light_on_frames_of_any_size() {
    let gpu = Gpu::shared();
    for (turn, (width, height)) in (0..).zip([(1, 1), (1, 7), (17, 33), (130, 9)]) {
        for (number, composite) in (0..).zip([Shading::Raster, Shading::Compute]) {
            if !slow() && (turn + number) % 2 == 1 {
                continue;
            }
            let size = extent(width, height);
            let mut case = Foamy::new(size, Lens::Reversed, 20.0);
            case.shot.margin = [3, 1, 2, 4];
            let config = everything(&mut case).with(|it| {
                it.extent = size;
                it.composite = Some(composite);
            });
            let mut rig = Rig::lit(&gpu, &config, 1);
            let (_image, shadow) = even(&rig, 0.5);
            case.shot.shadow = Some(shadow);
            case.draw(&mut rig);
            (case.shot.positions, case.amounts, case.velocities) = Default::default();
            (case.ids, case.shot.densities) = (None, None);
            let drawn = case.draw(&mut rig);
            for (found, scene) in drawn.output.data.iter().zip(&case.shot.color) {
                let near = scene.iter().zip(found).all(|(c, found)| is_nearly_half(*c, *found));
                assert!(near, "{found:?}, not {scene:?}");
            }
            assert!(drawn.whole.data.iter().filter(|c| is_around(c)).count() > 8);
        }
    }
}
