//! Spray in sunlight and in shadow.

use crate::reference::spray::Sums;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::Rig;
use crate::support::scenes::Lens;
use crate::surface_foam::Foamy;

use super::{SIZE, even, everything};

/// Fixed-point step of the spray's optical depth.
const STEP: f32 = Sums::SINGLE.step as f32;

/// With a uniform mask the lit part of the spray is all of it, nothing, or the same fraction of
/// each droplet.
#[test]
fn spray_is_lit_by_the_sun_that_comes() {
    let gpu = Gpu::shared();
    let mut case = Foamy::new(SIZE, Lens::Standard, 10.0);
    let config = everything(&mut case).with(|it| it.light_map_size = None);
    case.shot.light_volume = None;
    // With one droplet per particle, two rarely share a pixel.
    case.shot.settings.spray.droplets = 1;
    let mut rig = Rig::lit(&gpu, &config, 1);
    let draw = |case: &mut Foamy, rig: &mut Rig<'_>, sun| {
        let (_image, shadow) = even(rig, sun);
        case.shot.shadow = Some(shadow);
        let drawn = case.draw(rig);
        (drawn.spray.expect("spray"), drawn.lit_spray.expect("spray"), drawn.output)
    };
    let (all, lit, bright) = draw(&mut case, &mut rig, 1.0);
    compare::same("spray-in-the-sun", &lit, &all);
    let (same, lit, dark) = draw(&mut case, &mut rig, 0.0);
    compare::same("spray", &same, &all);
    assert!(lit.data.iter().all(|l| *l == 0.0), "spray in the shade is lit");
    let darker = dark.data.iter().zip(&bright.data).filter(|(d, b)| d[0] < b[0]).count();
    assert!(darker > 50, "{darker} pixels are darker in the shade");
    let (_, lit, _) = draw(&mut case, &mut rig, 0.25);
    let mut some = 0;
    for (lit, all) in lit.data.iter().zip(&all.data) {
        // Each droplet rounds to a neighbouring step, in the lit sum and in the whole; at most ten
        // share a pixel.
        assert!((lit - 0.25 * all).abs() <= 10.0 * 1.25 * STEP, "{lit} of {all}");
        some += usize::from(*lit > 0.02);
    }
    assert!(some > 50, "{some} pixels with spray");
}
