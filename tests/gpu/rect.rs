//! Views that are a part of the host's images, and frames smaller than the renderer's extent.

use whitewater::Config;
use whitewater::water::{Gate, Shading, Smoothing, Splat};

use crate::invariants::same_sheets;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, coarsening, config, extent, is_around};
use crate::support::scenes::{self, Lens};
use crate::support::slow;

const SIZE: (u32, u32) = (61, 45);

fn shot(depth_extent: (u32, u32)) -> Shot {
    let mut points = scenes::block(3, 0.25, [14, 8, 4], [-1.8, -1.0, 4.0]);
    points.extend(scenes::cloud(4, 30, 1.5, 12.0));
    let mut shot = Shot::new(extent(SIZE.0, SIZE.1), Lens::Reversed, 0.2, &points);
    // Strong refraction looks beyond the view's edges.
    shot.settings.water.refraction = 2.0;
    shot.depth_extent = extent(depth_extent.0, depth_extent.1);
    shot.scene_depth(|x, y| ((x / 9 + y / 7) % 2 == 0).then_some(6.0 + f64::from(x % 5)));
    shot
}

/// Equal bit for bit except for the colour, because filter positions in the scene's colour round
/// differently in another image. Filter weights have at least four bits, and neighbouring texels of
/// the gradient differ by 1/256 along each axis.
fn assert_same(name: &str, found: &Drawn, expected: &Drawn) {
    compare::same(&format!("{name}-depth"), &found.depth, &expected.depth);
    compare::same(&format!("{name}-surface"), &found.surface, &expected.surface);
    compare::same(&format!("{name}-thickness"), &found.thickness, &expected.thickness);
    assert!(found.plan.data == expected.plan.data, "{name}: other plans");
    // Texels that no tile needs hold remains of other frames.
    let sizes = |drawn: &Drawn| -> Vec<_> {
        drawn.coarser.iter().map(|(surface, _)| (surface.width, surface.height)).collect()
    };
    assert_eq!(sizes(found), sizes(expected), "{name}: coarser levels");
    if let (Some(found), Some(expected)) = (&found.sheets, &expected.sheets) {
        same_sheets(name, found, expected);
    }
    let bound = 2.0 * 2.0_f32.powi(-4) / 256.0;
    for (i, (a, b)) in found.output.data.iter().zip(&expected.output.data).enumerate() {
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        let at = (i % found.output.width, i / found.output.width);
        assert!(off <= bound, "{name} at {at:?}: {a:?}, expected {b:?}");
    }
}

/// Configurations for every path that has images of its own size.
fn ways() -> Vec<(&'static str, Config)> {
    let base = config(extent(SIZE.0, SIZE.1));
    let sums = base.with(|it| it.thickness_level = 1);
    vec![
        ("tiles", base.with(|it| it.smoothing = Some(Smoothing::Tiles))),
        (
            "fused",
            base.with(|it| {
                it.smoothing = Some(Smoothing::Fused);
                it.smoothing_level = 0;
            }),
        ),
        ("query", sums.with(|it| it.smoothing = Some(Smoothing::Query(Gate::VertexCull)))),
        ("depth", sums.with(|it| it.depth_splat = Some(Splat::Raster))),
        ("stored", sums.with(|it| it.composite = Some(Shading::Compute))),
        ("coarser", coarsening(base).with(|it| it.max_iterations = 3)),
        ("sheets", base.with(|it| it.sheets = 2)),
    ]
}

/// The view is the same as in an image of its own; texels beside it are neither read nor written.
#[test]
fn a_view_may_be_a_part_of_the_images() {
    let gpu = Gpu::shared();
    for (turn, depth_extent) in (0..).zip([SIZE, (122, 90), (40, 33)]) {
        for (number, (way, config)) in (0..).zip(ways()) {
            for in_place in [true, false] {
                if !slow() && in_place != ((turn + number) % 2 == 0) {
                    continue;
                }
                let config = config.with(|it| it.in_place = in_place);
                let mut rig = Rig::lit(&gpu, &config, 1);
                let alone = rig.draw(&shot(depth_extent));
                assert!(way != "coarser" || !alone.coarser.is_empty(), "no coarser level");
                let part = Shot { margin: [13, 30, 7, 21], ..shot(depth_extent) };
                let found = rig.draw(&part);
                let name = format!("part-{way}-{in_place}-{}", depth_extent.0);
                assert_same(&name, &found, &alone);
                let (_, rect) = part.with_margin(part.size);
                for (i, texel) in found.whole.data.iter().enumerate() {
                    let (x, y) = ((i % found.whole.width) as i32, (i / found.whole.width) as i32);
                    let (dx, dy) = (x - rect.offset.x, y - rect.offset.y);
                    let inside =
                        (0..SIZE.0 as i32).contains(&dx) && (0..SIZE.1 as i32).contains(&dy);
                    assert!(inside || is_around(texel), "{name}: ({x}, {y}) was written");
                }
                let drawn = alone.output.data.iter().zip(&part.color).filter(|(a, b)| a != b);
                assert!(drawn.count() > 100, "{name}: no water");
            }
        }
    }
}

/// A renderer made for larger frames draws a smaller one like a renderer made for it, so a
/// resolution that changes from frame to frame needs no resize.
#[test]
fn a_frame_may_be_smaller_than_the_renderer_is_made_for() {
    let gpu = Gpu::shared();
    for (way, config) in ways() {
        let shot = shot(SIZE);
        let expected = Rig::lit(&gpu, &config, 1).draw(&shot);
        assert!(way != "coarser" || !expected.coarser.is_empty(), "no coarser level");
        let mut rig = Rig::lit(&gpu, &config.with(|it| it.extent = extent(150, 101)), 1);
        // A larger frame's remains in the images are not visible.
        let whole =
            Shot::new(extent(150, 101), Lens::Standard, 0.5, &scenes::cloud(1, 900, 1.0, 9.0));
        rig.draw(&whole);
        let found = rig.draw(&shot);
        assert_same(&format!("smaller-{way}"), &found, &expected);
    }
}
