//! Only necessary work is done: particles off the screen, hidden spheres and tiles without water
//! are skipped. Pictures are the same without that, so the tests check counts.

use whitewater::Packets;

use super::invariants::packet_bytes;
use crate::reference::Image;
use crate::reference::cull::{CullParams, cull};
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, coarsening, config, extent};
use crate::support::scenes::{self, LENSES, Lens};

/// Size of a tile of the smoothing, in its texels.
const TILE: usize = 16;

/// At least two thirds of a cloud lie beside, behind or before the frustum.
#[test]
fn particles_off_the_screen_are_culled() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let mut rig = Rig::new(&gpu, &config(size));
    for lens in LENSES {
        let shot =
            Shot::new(size, lens, 0.05, &scenes::block(7, 0.6, [14, 14, 14], [-4.2, -4.2, -2.0]));
        let drawn = rig.draw(&shot);
        // In single precision, spheres that touch a plane of the frustum may count as inside or
        // outside.
        let count = |slack: f64| {
            let mut params = CullParams::new(f64::from(shot.settings.water.radius()), 1000.0);
            params.bound += slack;
            cull(&shot.positions, None, &params, &shot.view(size)).visible.len() as u32
        };
        let expected = count(-1.0e-4)..=count(1.0e-4);
        assert!(
            expected.contains(&drawn.work.visible),
            "{lens:?}: {} of {expected:?}",
            drawn.work.visible
        );
        let all = shot.positions.len() as u32;
        assert!(
            drawn.work.visible > 0 && 3 * drawn.work.visible < all,
            "{lens:?}: {} of {all}",
            drawn.work.visible
        );
    }
}

/// Culling trusts a packet's box: particles of a packet off the screen are not tested.
#[test]
fn packets_off_the_screen_are_culled() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let mut rig = Rig::new(&gpu, &config(size));
    let shot =
        Shot::new(size, Lens::Standard, 0.1, &scenes::block(2, 0.2, [6, 6, 6], [-0.5, -0.5, 4.0]));
    let mut beside = shot.clone();
    let right = shot.camera_view().inverse().transform_vector3(glam::DVec3::X * 20.0);
    for p in &mut beside.positions {
        *p = (glam::DVec3::from(p.map(f64::from)) + right).as_vec3().to_array();
    }
    let half = shot.positions.len() as u32 / 2;
    let mut bytes = packet_bytes(&shot, &[(0, half)]);
    bytes.extend(packet_bytes(&beside, &[(half, half)]));
    let cloud = rig.particles(&shot);
    let boxes = rig.stub.data(&bytes, ash::vk::BufferUsageFlags::STORAGE_BUFFER);
    let packets = Some(Packets { buffer: boxes.buffer, offset: 0, count: 2 });
    let drawn = rig.draw_particles(&shot, &cloud.particles().with(|it| it.packets = packets));
    assert_eq!(drawn.work.visible, half);
}

/// In a block ten layers deep, the inner spheres are hidden, and those on its sides are drawn.
#[test]
fn spheres_that_cannot_show_are_left_out() {
    let gpu = Gpu::shared();
    let size = extent(160, 120);
    let mut rig = Rig::new(&gpu, &config(size));
    let shot = Shot::new(
        size,
        Lens::Standard,
        0.2,
        &scenes::block(3, 0.25, [14, 10, 10], [-1.7, -1.2, 4.0]),
    );
    let drawn = rig.draw(&shot);
    assert!(
        drawn.work.front > 0 && 5 * drawn.work.front < 4 * drawn.work.visible,
        "{} of {}",
        drawn.work.front,
        drawn.work.visible
    );
}

/// Only tiles with water are listed, at coarser levels only those that are smoothed. Iteration i
/// runs over all tiles that need i - 1 or more iterations; the additional one leaves the result in
/// both images.
#[test]
fn tiles_without_work_are_not_listed() {
    let gpu = Gpu::shared();
    // Six by four tiles, and a rest.
    let size = extent(2 * 16 * 6 + 6, 2 * 16 * 4 + 10);
    let mut rig = Rig::new(&gpu, &coarsening(config(size)));
    // Near and far drops, so that tiles need different numbers of iterations.
    let mut points = scenes::block(5, 0.3, [3, 3, 2], [-2.2, -1.4, 6.0]);
    points.extend(scenes::block(6, 0.3, [3, 3, 2], [1.0, 0.6, 3.0]));
    let shot = Shot::new(size, Lens::Standard, 0.2, &points);
    let drawn = rig.draw(&shot);
    let most = |plan: &Image<u32>, listed: &dyn Fn(usize, u32) -> bool| {
        let (columns, rows) = (plan.width.div_ceil(TILE), plan.height.div_ceil(TILE));
        let mut most = vec![None; columns * rows];
        for (i, n) in plan.data.iter().map(|n| n & 511).enumerate() {
            if listed(i, n) {
                let tile = &mut most[i / plan.width / TILE * columns + i % plan.width / TILE];
                *tile = Some(tile.map_or(n, |before: u32| before.max(n)));
            }
        }
        most
    };
    let first = most(&drawn.plan, &|i, _| drawn.surface.data[i] < 1.0e10);
    let mut wet: Vec<u32> = first.iter().copied().flatten().collect();
    assert!(wet.len() > 3 && 2 * wet.len() < first.len(), "{} tiles", wet.len());
    let before = wet.len();
    for (_, plan) in crate::level::coarser(&drawn, &shot, config(size).max_iterations) {
        wet.extend(most(&plan, &|_, n| n > 0).into_iter().flatten());
    }
    assert!(wet.len() > before, "no tile of a coarser level");
    assert_eq!(drawn.work.tiles[0], wet.len() as u32);
    for (i, listed) in (1u32..).zip(&drawn.work.tiles[1..]) {
        let wanted = wet.iter().filter(|n| **n + 1 >= i.max(2)).count();
        assert_eq!(*listed, wanted as u32, "iteration {i}");
    }
    assert!(drawn.work.tiles[200] == 0 && drawn.work.tiles[2] > 0);
}
