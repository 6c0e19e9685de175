//! Every kind of host image: depth formats of the scene, output as scene or separate, any layout
//! and access.

use ash::vk;
use whitewater::shore::ShoreConfig;
use whitewater::water::{Kernels, Shading, Shadows};
use whitewater::{Access, Count, Particles, Recorded, Shore, Surface, WhitewaterParticles};
use whitewater::{WhitewaterConfig, WhitewaterSplat};

use crate::support::compare;
use crate::support::device::{Gpu, sees_storage};
use crate::support::host::{COLOR, DEPTH, HOST_WRITE, Texture};
use crate::support::rig::{OUTPUT, Rig, Shot, config, extent, stream};
use crate::support::scenes::{self, Lens};
use crate::support::skipped::skipped;

use super::{sunny, water};

/// Every depth format, and scene depths of other sizes than the frame.
#[test]
fn every_kind_of_scene_depth() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &config(size));
    let mut shot = water(size, Lens::Standard);
    let mut wall = |shot: &mut Shot, depth_extent: vk::Extent2D| {
        shot.depth_extent = depth_extent;
        let half = depth_extent.width / 2;
        shot.scene_depth(|x, _| Some(if x < half { 2.0 } else { 30.0 }));
        rig.draw(shot)
    };
    for depth_extent in [size, extent(48, 32), extent(192, 128)] {
        shot.depth_format = vk::Format::D32_SFLOAT;
        let expected = wall(&mut shot, depth_extent);
        for format in [
            vk::Format::D16_UNORM,
            vk::Format::X8_D24_UNORM_PACK32,
            vk::Format::D24_UNORM_S8_UINT,
            vk::Format::D32_SFLOAT_S8_UINT,
        ] {
            let needed = vk::FormatFeatureFlags::SAMPLED_IMAGE
                | vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT
                | vk::FormatFeatureFlags::TRANSFER_DST;
            if !gpu.format_features(format).contains(needed) {
                skipped(&format!("{format:?} is not to be had here"));
                continue;
            }
            shot.depth_format = format;
            // The wall is far from the water on both sides, so the format's rounding does not
            // matter.
            let found = wall(&mut shot, depth_extent);
            let name = format!("scene-depth-{}-{}", format.as_raw(), depth_extent.width);
            compare::same_color(&name, &found.output, &expected.output);
        }
    }
}

#[test]
fn in_place_and_apart_give_the_same_picture() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for (output_format, composite) in [
        (OUTPUT, Shading::Raster),
        (OUTPUT, Shading::Compute),
        (vk::Format::R16G16B16A16_SFLOAT, Shading::Raster),
        (vk::Format::R16G16B16A16_SFLOAT, Shading::Compute),
    ] {
        let shot = water(size, Lens::Reversed);
        let composite = Some(composite);
        let make = |in_place| {
            config(size).with(|it| {
                it.in_place = in_place;
                it.output_format = output_format;
                it.composite = composite;
            })
        };
        let inside = Rig::lit(&gpu, &make(true), 1).draw(&shot);
        let apart = Rig::lit(&gpu, &make(false), 1).draw(&shot);
        compare::same_color("in-place", &inside.output, &apart.output);
        // A renderer with `in_place` also draws frames whose scene is a separate image.
        let mut rig = Rig::lit(&gpu, &make(true), 1);
        rig.config.in_place = false;
        compare::same_color("in-place-apart", &rig.draw(&shot).output, &apart.output);
    }
}

/// The host hands over images in any layout and access, and gets them back in those that it asked
/// for: its barrier from there to the first state finds them so.
#[test]
fn images_are_taken_from_and_left_in_any_state() {
    for (composite, in_place) in [(Shading::Raster, true), (Shading::Compute, false)] {
        in_any_state(composite, in_place);
    }
}

fn in_any_state(composite: Shading, in_place: bool) {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let config = config(size).with(|it| {
        it.composite = Some(composite);
        it.in_place = in_place;
        it.shadow = Some(Shadows::Map);
        it.whitewater = Some(WhitewaterConfig::new(100));
        it.shore = Some(ShoreConfig::default());
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut shot = water(size, Lens::Standard);
    let mut shadow = sunny(&rig, &mut shot).expect("a shadow map");
    // The whitewater's sea, the shore's surface and its mask are images of their own.
    let [(_, mut sea), (mut mask, mut surface)] = [rig.scene(&shot), rig.scene(&shot)];
    let points = scenes::world(&shot.camera, &scenes::cloud(5, 40, 2.0, 5.0));
    let foam = rig
        .whitewater(&whitewater::headless::Whitewater { positions: &points, ..Default::default() });
    let lent = |image: &Texture, after| image.host_image().with(|it| it.after = after);
    let shore = |surface, mask| {
        Shore::new(0.0).with(|it| {
            it.surface = Some(Surface::Depth(surface));
            it.mask = Some(mask);
        })
    };
    let expected = {
        shot.shore = Some(shore(surface.host_image(), mask.host_image()));
        let foam = foam.particles().with(|it| it.fluid_depth = Some(sea.host_image()));
        let cloud = rig.particles(&shot);
        rig.draw_whitewater(&shot, &cloud.particles(), Some(foam))
    };
    let sampled = Access::new(
        vk::PipelineStageFlags2::FRAGMENT_SHADER,
        vk::AccessFlags2::SHADER_SAMPLED_READ,
        vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    );
    let general = Access::new(
        vk::PipelineStageFlags2::ALL_COMMANDS,
        vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE,
        vk::ImageLayout::GENERAL,
    );
    let read_only = Access { layout: vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL, ..sampled };
    let states = [(COLOR, DEPTH), (sampled, read_only), (general, general)];
    for (i, (color_state, depth_state)) in states.into_iter().enumerate() {
        let (color_after, depth_after) = states[(i + 1) % 3];
        let (mut color, mut depth) = rig.scene(&shot);
        let (mut apart, _) = rig.scene(&shot);
        let mut colors = [&mut color, &mut apart, &mut mask].map(|image| (image, color_state));
        let mut depths =
            [&mut depth, &mut shadow, &mut sea, &mut surface].map(|image| (image, depth_state));
        rig.stub.run(|cmd| {
            for (image, to) in colors.iter_mut().chain(&mut depths) {
                rig.stub.barrier(cmd, image.image, image.aspect, image.state, *to);
                image.state = *to;
            }
        });
        let cloud = rig.particles(&shot);
        let output = lent(if in_place { &color } else { &apart }, color_after);
        shot.shore = Some(shore(lent(&surface, depth_after), lent(&mask, color_after)));
        shot.shadow = shot.shadow.map(|it| it.with(|it| it.image = lent(&shadow, depth_after)));
        let foam = foam.particles().with(|it| it.fluid_depth = Some(lent(&sea, depth_after)));
        let frame = shot.frame(output, lent(&depth, depth_after), cloud.particles()).with(|it| {
            it.whitewater = Some(foam);
            it.scene_color = lent(&color, color_after);
        });
        let cmd = rig.stub.begin(0);
        // SAFETY: cmd is recording, and all handles live until the end of this function.
        unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
        let lent_colors = [&color, &mask].map(|image| (image, color_after));
        let lent_depths = [&depth, &shadow, &sea, &surface].map(|image| (image, depth_after));
        for (image, after) in lent_colors.into_iter().chain(lent_depths) {
            // The read-back below is the output's use.
            if image.image != output.image {
                rig.stub.barrier(cmd, image.image, image.aspect, after, image.state);
            }
        }
        rig.stub.end(0);
        rig.stub.wait(0);
        let found = rig.read(&output, &Recorded::default());
        compare::same_color("states", &found.output, &expected.output);
    }
}

/// The device writes the particles, which are elsewhere until then, before the frame, and overwrites
/// them after it. All passes that read them, in all stages, must come between, so the picture equals
/// that of particles from the CPU.
#[test]
fn particles_that_the_device_writes_are_waited_for() {
    const COPIED: Access = Access::new(
        vk::PipelineStageFlags2::ALL_TRANSFER,
        vk::AccessFlags2::TRANSFER_WRITE,
        vk::ImageLayout::GENERAL,
    );
    let gpu = Gpu::shared();
    if !sees_storage() {
        // A device that runs passes in order draws the right picture without barriers, too.
        skipped("the validation layer does not look for missing barriers of particles");
    }
    let size = extent(64, 48);
    let plain = config(size);
    let light = plain.with(|it| it.light_map_size = Some(64));
    let whitewater = |splat| {
        light.with(|it| {
            it.whitewater = Some(WhitewaterConfig::new(500).with(|it| it.splat = Some(splat)))
        })
    };
    for config in [
        plain,
        light,
        light.with(|it| it.kernels = Kernels::Ellipsoids),
        whitewater(WhitewaterSplat::Compute),
        whitewater(WhitewaterSplat::Raster),
    ] {
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut shot = water(size, Lens::Standard);
        let densities = vec![1000.0_f32; shot.positions.len()];
        shot.densities = Some(densities.clone());
        let _shadow = sunny(&rig, &mut shot);
        let points: Vec<_> = shot.positions.iter().map(|[x, y, z]| [*x, *y + 0.2, *z]).collect();
        let count = Count::Cpu(points.len().min(500) as u32);
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let all = [
            bytemuck::cast_slice(&shot.positions),
            bytemuck::cast_slice::<_, u8>(&densities),
            bytemuck::cast_slice(&points),
        ];
        // Zeros before the frame, no numbers after it.
        let [unset, spoilt] = [0, 0xff].map(|byte| all.map(|bytes| vec![byte; bytes.len()]));
        let buffers = unset.each_ref().map(|bytes| rig.stub.data(bytes, usage));
        let [positions, dense, places] = &buffers;
        let whitewater = config.whitewater.map(|_| {
            WhitewaterParticles::new(stream(places, 0, 12), count).with(|it| {
                it.before = HOST_WRITE;
                it.after = HOST_WRITE;
            })
        });
        let expected = {
            let cloud = rig.particles(&shot);
            let data = rig.stub.data(all[2], usage);
            let whitewater = whitewater.map(|it| it.with(|it| it.positions = stream(&data, 0, 12)));
            rig.draw_whitewater(&shot, &cloud.particles(), whitewater)
        };
        let written = |rig: &Rig<'_>, cmd, all: [&[u8]; 3]| {
            for (data, bytes) in buffers.iter().zip(all).take(2 + usize::from(whitewater.is_some()))
            {
                for (at, part) in (0_u64..).step_by(65536).zip(bytes.chunks(65536)) {
                    // SAFETY: cmd is recording outside a render pass, and the buffer may be copied
                    // to.
                    unsafe { rig.stub.functions().cmd_update_buffer(cmd, data.buffer, at, part) };
                }
            }
        };
        let particles =
            Particles::new(stream(positions, 0, 12), Count::Cpu(densities.len() as u32)).with(
                |it| {
                    it.densities = Some(stream(dense, 0, 4));
                    it.before = COPIED;
                    it.after = COPIED;
                },
            );
        let (color, depth) = rig.scene(&shot);
        let output = color.host_image().with(|it| {
            it.before = COLOR;
            it.after = COLOR;
        });
        let mut frame = shot.frame(output, depth.host_image(), particles);
        frame.whitewater = whitewater.map(|host| {
            host.with(|it| {
                it.before = COPIED;
                it.after = COPIED;
            })
        });
        let cmd = rig.stub.begin(0);
        written(&rig, cmd, all);
        // SAFETY: cmd is recording, the slot's work is done, and everything in the frame outlives
        // it.
        let recorded = unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
        written(&rig, cmd, spoilt.each_ref().map(Vec::as_slice));
        rig.stub.end(0);
        rig.stub.wait(0);
        let found = rig.read(&frame.output, &recorded);
        compare::same_color("written-by-device", &found.output, &expected.output);
    }
}

/// The depth of the host's sea serves whitewater and the shore at once: the image changes its layout once.
#[test]
fn one_image_may_be_two_inputs() {
    let gpu = Gpu::shared();
    let size = extent(48, 32);
    let config = config(size).with(|it| {
        it.whitewater = Some(WhitewaterConfig::new(500));
        it.shore = Some(ShoreConfig::default());
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut shot = water(size, Lens::Standard);
    let (_, sea) = rig.scene(&shot);
    let state = Access::new(
        vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS,
        vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE,
        vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
    );
    rig.stub.run(|cmd| rig.stub.barrier(cmd, sea.image, sea.aspect, sea.state, state));
    let mut image = sea.host_image();
    (image.before, image.after) = (state, state);
    let points = scenes::world(&shot.camera, &scenes::cloud(5, 40, 2.0, 5.0));
    let foam = rig
        .whitewater(&whitewater::headless::Whitewater { positions: &points, ..Default::default() });
    let foam = foam.particles().with(|it| it.fluid_depth = Some(image));
    let shore = |image| Shore::new(0.0).with(|it| it.surface = Some(Surface::Depth(image)));
    shot.shore = Some(shore(image));
    let cloud = rig.particles(&shot);
    rig.draw_whitewater(&shot, &cloud.particles(), Some(foam));
    let other = Access { stage: vk::PipelineStageFlags2::ALL_COMMANDS, ..state };
    shot.shore = Some(shore(image.with(|it| it.after = other)));
    let error = rig.refused(&shot, Some(foam));
    assert!(error.contains("Frame.shore.surface.after"), "{error}");
}
