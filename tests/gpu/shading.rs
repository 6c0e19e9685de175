//! Pass `composite`: the compute shader and the render pass give the same picture.
//!
//! Both are compiled from the same source. On SwiftShader they give the same bits, and on lavapipe
//! they do except for the look-up in the environment, which rounds differently. (Both pictures must
//! also lie within the twin's bounds; tests of `composite` check this.)

use ash::vk;
use whitewater::water::{Fresnel, Shading};
use whitewater::{Access, Config, Layer, Recorded};

use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host;
use crate::support::rig::{Drawn, OUTPUT, Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens};
use crate::support::slow;

fn water(size: vk::Extent2D, lens: Lens) -> Shot {
    let mut points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    points.extend(scenes::cloud(4, 40, 0.2, 12.0));
    Shot::new(size, lens, 0.2, &points)
}

/// A position on a cube face of 16 texels errs by a few roundings, 4 of 16 / 2^24, on both axes.
/// Two texels differ by at most 1, all of which may be reflected. A few roundings of the colour and
/// that of the output's format are added.
pub fn close(name: &str, format: vk::Format, stored: &Drawn, drawn: &Drawn) {
    let expected = drawn.output.map(|c| c.map(f64::from));
    let rounding = if format == OUTPUT { 2_f64.powi(-22) } else { 2_f64.powi(-10) };
    compare::close_color(name, &stored.output, &expected, |x, y| {
        expected.at(x, y).map(|c| 2.0 * 4.0 * 16.0 * 2_f64.powi(-24) + rounding * c.abs())
    });
}

/// Draws shots with both kinds of shading, one after the other, so that each finds the contents of
/// the one before.
fn same(gpu: &Gpu, name: &str, config: &Config, shots: &[&Shot]) -> Vec<Drawn> {
    let [mut drawn, mut stored] = [Shading::Raster, Shading::Compute].map(|way| {
        let config = config.with(|it| it.composite = Some(way));
        Rig::lit(gpu, &config, 1)
    });
    shots
        .iter()
        .map(|shot| {
            let (drawn, stored) = (drawn.draw(shot), stored.draw(shot));
            close(name, config.output_format, &stored, &drawn);
            drawn
        })
        .collect()
}

/// Number of pixels that differ from the scene.
fn written(drawn: &Drawn, shot: &Shot) -> usize {
    drawn.output.data.iter().zip(&shot.color).filter(|(found, scene)| found != scene).count()
}

#[test]
fn both_ways_give_the_same_picture() {
    let gpu = Gpu::shared();
    let half = vk::Format::R16G16B16A16_SFLOAT;
    let kinds = [
        (0, 2, false, OUTPUT),
        (1, 1, true, half),
        (0, 0, true, OUTPUT),
        (1, 2, false, half),
        (2, 0, true, OUTPUT),
        (2, 3, false, OUTPUT),
    ];
    for (width, height) in [(97, 61), (1, 1), (1, 7), (3, 5), (17, 33), (130, 9)] {
        let size = extent(width, height);
        let few = if width == 97 { &kinds[..] } else { &kinds[..if slow() { 2 } else { 1 }] };
        for &(smoothing_level, thickness_level, in_place, output_format) in few {
            let levels = config(size).with(|it| {
                it.smoothing_level = smoothing_level;
                it.thickness_level = thickness_level;
            });
            let config = levels.with(|it| {
                it.in_place = in_place;
                it.output_format = output_format;
            });
            let (first, mut second) = (water(size, Lens::OffAxis), water(size, Lens::Reversed));
            second.settings.water.fresnel = Fresnel::Source { bias: 0.1, scale: 0.4, power: 2.0 };
            let mut none = first.clone();
            none.positions.clear();
            let name = format!("ways-{width}-{smoothing_level}{thickness_level}-{in_place}");
            let drawn = same(&gpu, &name, &config, &[&first, &second, &none, &first]);
            if (width, output_format) == (97, OUTPUT) {
                let [first, second, none] =
                    [(0, &first), (1, &second), (2, &none)].map(|(i, s)| written(&drawn[i], s));
                assert!(first > 500 && second > 500 && none == 0, "{first}, {second}, {none}");
            }
        }
    }
}

/// Tiles are up to eight groups wide and may extend beyond the picture. At the finest level there
/// are many, 99 for 530x33 pixels, more than a row of the dispatch. All levels are tested.
#[test]
fn tiles_of_every_level_are_shaded_whole() {
    let gpu = Gpu::shared();
    let sizes = [(97, 61), (530, 33), (19, 300), (1, 1)];
    for (turn, (width, height)) in (0..).zip(sizes) {
        let size = extent(width, height);
        let levels = [(0, 0), (0, 3), (1, 2), (2, 1), (2, 2), (2, 3)];
        for (number, (smoothing_level, coarsening)) in (0..).zip(levels) {
            if !slow() && (turn + number) % 2 == 1 {
                continue;
            }
            let config = config(size).with(|it| {
                it.smoothing_level = smoothing_level;
                it.coarsening = coarsening;
                it.max_iterations = 3;
            });
            let row: Vec<_> = (-30_i8..=30).map(|x| [f32::from(x), 0.0, 2.0]).collect();
            let mut shot = Shot::new(size, Lens::Reversed, 1.0, &row);
            shot.settings.water.smoothing_width = 40.0;
            let name = format!("levels-{width}-{smoothing_level}{coarsening}");
            let drawn = same(&gpu, &name, &config, &[&shot]);
            let (shown, fade) = drawn[0].levels.shown(2.0, [0.0; 2]);
            assert_eq!((shown as u32, fade), (coarsening, 0.0), "{name}");
            assert!(written(&drawn[0], &shot) > 0, "{name}: no water");
        }
    }
}

/// An output that is stored to need not be a colour attachment, nor in a layout for one. The layers
/// can be read right after the record, in the layout and access that it returns.
#[test]
fn a_stored_output_need_not_be_an_attachment() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let config = config(size).with(|it| it.composite = Some(Shading::Compute));
    let mut rig = Rig::lit(&gpu, &config, 1);
    let shot = water(size, Lens::Standard);
    let expected = rig.draw(&shot);
    let written = Access::new(
        vk::PipelineStageFlags2::COMPUTE_SHADER,
        vk::AccessFlags2::SHADER_STORAGE_WRITE,
        vk::ImageLayout::GENERAL,
    );
    let (_, depth) = rig.scene(&shot);
    let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED;
    let texels = bytemuck::cast_slice(&shot.color);
    let color = rig.stub.uploaded(OUTPUT, size, usage, texels, written);
    let cloud = rig.particles(&shot);
    let output = color.host_image().with(|it| it.after = written);
    let frame = shot.frame(output, depth.host_image(), cloud.particles());
    let cmd = rig.stub.begin(0);
    // SAFETY: cmd is recording, and all handles live until the end of this function.
    let recorded = unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    let backs: Vec<_> = recorded
        .layers
        .iter()
        .map(|layer| {
            let (Layer { image, extent, format, access, .. }, aspect) = (*layer, color.aspect);
            let bytes = host::texel_size(format) * u64::from(extent.width * extent.height);
            let back = rig.stub.sized(bytes, vk::BufferUsageFlags::TRANSFER_DST);
            rig.stub.record_download(cmd, image, aspect, extent.into(), access, &back);
            back
        })
        .collect();
    assert_eq!(backs.len(), 4);
    rig.stub.end(0);
    rig.stub.wait(0);
    let found = rig.read(&output, &Recorded::default());
    compare::same_color("stored", &found.output, &expected.output);
}
