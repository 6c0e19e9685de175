//! Many particles on one spot, such as dead ones parked at the origin: their sums saturate, the
//! frame ends, and other particles are not affected.

use whitewater::{WhitewaterConfig, WhitewaterSplat};

use super::{SIZE, Whitewater, ways, whitewater_config};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot};
use crate::support::scenes::{self, Lens};

#[test]
fn many_on_one_spot_are_as_many_as_there_is_room_for() {
    let gpu = Gpu::shared();
    let whitewater = WhitewaterConfig::new(200_000);
    let mut rig =
        Rig::lit(&gpu, &whitewater_config(SIZE).with(|it| it.whitewater = Some(whitewater)), 1);
    let mut cloud = Whitewater::new(Lens::Standard);
    let count = 200_000;
    cloud.positions = scenes::world(&cloud.shot.camera, &vec![[0.0, 0.0, 4.0]; count]);
    cloud.shot.positions.clear();
    (cloud.kinds, cloud.ages) = (vec![0; count], vec![0.0; count]);
    (cloud.radii, cloud.ids) = (Some(vec![1.0; count]), Some(vec![0; count]));
    let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
    let most = foam.thickness.data.iter().map(|t| t[0]).fold(0.0, f32::max);
    assert!((32_768.0..32_770.0).contains(&most), "half a word of 16.16: {most}");
}

/// A particle well under water contributes nothing to the sum before the surface, which is already
/// saturated there. Adding 0 to it must end, and must not keep the particle from the other sums, in
/// either order of the particles.
#[test]
fn a_heap_before_the_water_hides_nothing_under_it() {
    let gpu = Gpu::shared();
    let mut shot = Shot::new(SIZE, Lens::Standard, 0.0656, &[]);
    let spacing = shot.settings.water.spacing;
    let side = (2.0 / spacing) as usize;
    let slab = scenes::block(5, spacing, [side, side, 8], [-1.0, -1.0, 5.0]);
    shot.positions = scenes::world(&shot.camera, &slab);
    let heap = vec![[0.0, 0.0, 4.0]; 40_000];
    let radius = 0.5;
    let under = [[0.0, 0.0, 5.0 + radius + 4.0 * spacing]];
    let count = heap.len() + 1;
    let cloud = |points: [&[[f32; 3]]; 2]| Whitewater {
        positions: scenes::world(&shot.camera, &points.concat()),
        kinds: vec![0; count],
        ages: vec![0.0; count],
        radii: Some(vec![radius; count]),
        ids: Some(vec![0; count]),
        fluid: None,
        shot: shot.clone(),
    };
    for way in ways(&gpu).into_iter().filter(|way| *way != WhitewaterSplat::Raster) {
        let whitewater = WhitewaterConfig::new(count as u32).with(|it| it.splat = Some(way));
        let config = whitewater_config(SIZE).with(|it| it.whitewater = Some(whitewater));
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut thickness =
            |points| cloud(points).draw(&mut rig).whitewater.expect("foam").thickness;
        let (first, last) = (thickness([&under, &heap]), thickness([&heap, &under]));
        let [before, behind, ..] = first.at(SIZE.width as usize / 2, SIZE.height as usize / 2);
        assert!(before >= 32_768.0, "{way:?}: the heap's sum is {before}, not full");
        assert!(behind > 0.5, "{way:?}: {behind} of the particle under water");
        compare::same_color(&format!("whitewater-heaped-{way:?}"), &last, &first);
    }
}
