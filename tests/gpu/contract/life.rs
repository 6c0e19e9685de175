//! Lifetime of a renderer: resize, reconfigure, an abandoned frame, a plain drop and `destroy`.

use ash::vk;
use whitewater::bubbles::BubbleConfig;
use whitewater::water::{Convolution, Rule, Shading, Shadows, Smoothing, Splat};
use whitewater::{Error, Slot};

use crate::support::device::Gpu;
use crate::support::host::Texture;
use crate::support::rig::{Rig, config, extent};
use crate::support::scenes::Lens;
use crate::support::{compare, slow};

use super::flight::{Flight, launch, output_of};
use super::{sunny, water};

#[test]
fn resize_gives_what_a_new_renderer_gives() {
    let gpu = Gpu::shared();
    let mut rig = Rig::new(&gpu, &config(extent(96, 64)));
    for size in [extent(33, 17), extent(1, 1), extent(200, 3), extent(96, 64)] {
        rig.resize(size);
        assert_eq!(rig.renderer().config().extent, size);
        assert_eq!(rig.renderer().retired(), 0, "no frame is out");
        let shot = water(size, Lens::Standard);
        let expected = Rig::new(&gpu, &config(size)).draw(&shot);
        let name = format!("resize-{}", size.width);
        compare::same_color(&name, &rig.draw(&shot).output, &expected.output);
    }
    let config = |size| {
        config(size).with(|it| {
            it.light_map_size = Some(32);
            it.shadow = Some(Shadows::Map);
            it.surface_foam = true;
            it.noise = Some(1);
        })
    };
    let mut rig = Rig::lit(&gpu, &config(extent(96, 64)), 1);
    for size in [extent(33, 17), extent(1, 1), extent(96, 64)] {
        rig.resize(size);
        let mut shot = water(size, Lens::Standard);
        let _shade = sunny(&rig, &mut shot);
        let expected = Rig::lit(&gpu, &config(size), 1).draw(&shot);
        let name = format!("resize-sun-{}", size.width);
        compare::same_color(&name, &rig.draw(&shot).output, &expected.output);
    }
}

pub fn convolved(terms: u32, bits: u32) -> Option<Shadows> {
    Some(Shadows::Convolution(Convolution { terms, texels: 48, bits }))
}

/// Waits for a frame, which must show what is expected of it.
fn land(rig: &mut Rig<'_>, number: u32, (flight, _shade): (Flight, Option<Texture>)) {
    rig.stub.wait(number % 2);
    let name = format!("reconfigure-{number}");
    compare::same_color(&name, &output_of(rig, &flight), &flight.expected.output);
    rig.collect(Slot(number % 2));
}

/// Every part of the configuration changes while a frame of the old one is in flight.
#[test]
fn reconfigure_gives_what_a_new_renderer_gives() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let base = config(size);
    let configs = [
        base,
        base.with(|it| {
            it.smoothing_level = 0;
            it.thickness_level = 0;
        }),
        base.with(|it| it.depth_splat = Some(Splat::Raster)),
        base.with(|it| {
            it.in_place = true;
            it.extent = extent(33, 17);
            it.max_particles = 1000;
        }),
        base.with(|it| {
            it.environment_size = 32;
            it.rule = Rule::Fixed(12);
        }),
        base.with(|it| it.output_format = vk::Format::R16G16B16A16_SFLOAT),
        base.with(|it| it.composite = Some(Shading::Compute)),
        base.with(|it| {
            it.smoothing = Some(Smoothing::Fused);
            it.max_iterations = 9;
        }),
        base.with(|it| it.sheets = 2),
        base.with(|it| {
            it.sheets = 2;
            it.smoothing_level = 0;
            it.depth_splat = Some(Splat::Raster);
        }),
        base.with(|it| {
            it.surface_foam = true;
            it.sheets = 2;
            it.extent = extent(50, 40);
        }),
        base.with(|it| {
            it.surface_foam = true;
            it.depth_splat = Some(Splat::Raster);
        }),
        base.with(|it| it.spray = true),
        base.with(|it| {
            it.spray = true;
            it.surface_foam = true;
            it.composite = Some(Shading::Compute);
        }),
        base.with(|it| {
            it.noise = Some(1);
            it.sheets = 2;
        }),
        base.with(|it| {
            it.noise = Some(0);
            it.composite = Some(Shading::Compute);
            it.spray = true;
        }),
        base.with(|it| it.light_map_size = Some(32)),
        base.with(|it| {
            it.light_map_size = Some(64);
            it.shadow = Some(Shadows::Map);
            it.surface_foam = true;
            it.spray = true;
        }),
        base.with(|it| {
            it.light_map_size = Some(64);
            it.composite = Some(Shading::Compute);
            it.sheets = 2;
        }),
        base.with(|it| {
            it.shadow = Some(Shadows::Mask);
            it.extent = extent(50, 40);
        }),
        base.with(|it| {
            it.shadow = convolved(4, 8);
            it.spray = true;
            it.surface_foam = true;
        }),
        base.with(|it| {
            it.shadow = convolved(16, 16);
            it.light_map_size = Some(32);
        }),
        base.with(|it| {
            it.shadow = convolved(8, 8);
            it.composite = Some(Shading::Compute);
        }),
        base.with(|it| it.motion = true),
        base.with(|it| {
            it.motion = true;
            it.surface_foam = true;
            it.thickness_level = 0;
            it.extent = extent(50, 40);
        }),
    ];
    let mut rig = Rig::lit(&gpu, &base, 2);
    // The frame in flight, with its number.
    let mut flight = None;
    // Each configuration needs two renderers, so the normal test takes every third one.
    let some = configs.into_iter().step_by(if slow() { 1 } else { 3 });
    for (i, config) in (0..).zip(some.chain([base])) {
        let anew = rig.renderer().reconfigure(&config).expect("reconfigure");
        assert_eq!(anew, rig.config.environment_size != config.environment_size);
        assert_eq!(*rig.renderer().config(), config);
        if let Some((last, flight)) = flight.take() {
            assert!(rig.renderer().retired() > 0, "{i}: the old objects wait for their frame");
            land(&mut rig, last, flight);
        }
        rig.config = config;
        if anew {
            rig.set_up();
            rig.light();
        }
        let mut shot = water(config.extent, Lens::Standard);
        let shade = sunny(&rig, &mut shot);
        let expected = Rig::lit(&gpu, &config, 1).draw(&shot);
        let now = launch(&mut rig, i % 2, &shot, expected);
        flight = Some((i, (now, shade)));
    }
    if let Some((last, flight)) = flight {
        land(&mut rig, last, flight);
    }
    assert_eq!(rig.renderer().retired(), 0);
    let bad = base.with(|it| it.max_particles = 0);
    assert!(matches!(rig.renderer().reconfigure(&bad), Err(Error::BadInput { .. })));
    assert_eq!(*rig.renderer().config(), base, "as it was");
}

#[test]
fn an_abandoned_frame_does_no_harm() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::with_slots(&gpu, &config(size), 2);
    let shot = water(size, Lens::Standard);
    let expected = rig.draw(&shot);
    for slot in [1, 0, 1] {
        let (color, depth) = rig.scene(&shot);
        let cloud = rig.particles(&shot);
        let frame = shot
            .frame(color.host_image(), depth.host_image(), cloud.particles())
            .with(|it| it.slot = Slot(slot));
        let cmd = rig.stub.begin(slot);
        // SAFETY: cmd is recording, and the slot's work is done.
        unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
        rig.stub.throw_away(slot);
        rig.renderer().resize(size).expect("resize");
        assert!(rig.renderer().retired() > 0);
        rig.abandon(Slot(slot));
        assert_eq!(rig.renderer().retired(), 0);
        assert!(rig.renderer().timings(Slot(slot)).len() < 64, "and its timings do not wait");
        compare::same_color("abandoned", &rig.draw(&shot).output, &expected.output);
    }
}

#[test]
fn a_plain_drop_is_safe() {
    let mut gpu = Gpu::own();
    gpu.leaks = true;
    let size = extent(32, 16);
    let mut rig = Rig::new(&gpu, &config(size));
    rig.draw(&water(size, Lens::Standard));
    rig.leak();
    let mut rig = Rig::new(&gpu, &config(size));
    rig.draw(&water(size, Lens::Standard));
}

/// The layer reports objects that still exist at the device's end, and the allocator must be empty.
#[test]
fn destroy_leaves_nothing() {
    let gpu = Gpu::own();
    for in_place in [true, false] {
        let size = extent(32, 16);
        let mut rig = Rig::with_slots(&gpu, &config(size).with(|it| it.in_place = in_place), 3);
        rig.draw(&water(size, Lens::Standard));
        rig.resize(extent(16, 8));
        rig.draw(&water(extent(16, 8), Lens::Standard));
        drop(rig);
        assert_eq!(gpu.allocations(), Vec::<String>::new());
    }
}

/// A frame that would read contents nobody recorded is refused, with the name of the missing call.
#[test]
fn what_was_not_recorded_is_named() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let mut rig = Rig::new(&gpu, &config(size));
    let shot = water(size, Lens::Standard);
    let expected = rig.draw(&shot).output;
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    let context = gpu.context(1);
    let mut fresh = whitewater::Renderer::new(&context, &config(size)).expect("a renderer");
    let black = whitewater::EnvironmentSource::Black;
    let call = |error| match error {
        Some(Error::NotRecorded { call }) => call,
        other => panic!("{other:?}"),
    };
    let cmd = rig.stub.begin(0);
    // SAFETY: refused calls record nothing; the rest is submitted once, in this order.
    unsafe {
        let none = fresh.record(cmd, &frame).err();
        assert_eq!(call(none), "Renderer::record_setup");
        let early = fresh.record_environment(cmd, Slot(0), &black).err();
        assert_eq!(call(early), "Renderer::record_setup");
        fresh.record_setup(cmd);
        let half = fresh.record(cmd, &frame).err();
        assert_eq!(call(half), "Renderer::record_environment");
        fresh.record_environment(cmd, Slot(0), &black).expect("black");
        fresh.record(cmd, &frame).expect("a frame");
    }
    rig.stub.throw_away(0);
    let cmd = rig.stub.begin(0);
    // SAFETY: the first command buffer is never submitted, the second is, once.
    unsafe {
        fresh.abandon(Slot(0));
        let lost = fresh.record(cmd, &frame).err();
        assert_eq!(call(lost), "Renderer::record_environment", "it was thrown away");
        fresh.record_setup(cmd);
        fresh.record_environment(cmd, Slot(0), &black).expect("black");
        fresh.record(cmd, &frame).expect("a frame");
    }
    rig.stub.end(0);
    rig.stub.wait(0);
    let nothing = whitewater::Recorded::default();
    let found = rig.read(&color.host_image(), &nothing).output;
    crate::support::compare::same_color("recorded", &found, &expected);
    // SAFETY: the slot was waited for.
    unsafe { fresh.destroy() };
}

/// The set-up that a reconfiguration makes due clears the environment only when the frame in flight has sampled it.
#[test]
fn a_set_up_waits_for_the_frame_in_flight() {
    let gpu = Gpu::shared();
    let shot = water(extent(64, 48), Lens::Standard);
    let plain = config(shot.size);
    let bubbles = plain.with(|it| {
        it.bubbles = Some(BubbleConfig::new(64).with(|it| {
            it.variants = 2;
            it.bubbles = 32;
            it.map_size = 32;
        }));
    });
    let mut rig = Rig::lit(&gpu, &plain, 2);
    let expected = rig.draw(&shot);
    let flight = launch(&mut rig, 0, &shot, expected);
    assert!(rig.renderer().reconfigure(&bubbles).expect("reconfigure"), "a set-up is due");
    rig.config = bubbles;
    let cmd = rig.stub.begin(1);
    // SAFETY: submitted at once, before every later frame.
    unsafe { rig.renderer().record_setup(cmd) };
    rig.stub.end(1);
    rig.stub.wait(0);
    rig.stub.wait(1);
    compare::same_color("set-up", &output_of(&rig, &flight), &flight.expected.output);
    rig.collect(Slot(0));
    rig.collect(Slot(1));
}
