//! The contract: slots in flight, resize, retired objects, bad input, abandoned frames, and every
//! kind of host image.

use ash::vk;
use whitewater::water::{Convolution, Gate, Rule, Shading, Shadows, Smoothing, Splat};
use whitewater::{
    Access, Config, Count, Enabled, Error, Frame, HostImage, Packets, Previous, Recorded, Region,
    Renderer, Settings, Shadow, Slot, Stream,
};

use crate::reference::Image;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::{COLOR, Texture};
use crate::support::rig::{Cloud, Drawn, OUTPUT, Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens};
use crate::support::slow;
use crate::support::spy;

fn water(size: vk::Extent2D, lens: Lens) -> Shot {
    let points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    Shot::new(size, lens, 0.2, &points)
}

/// The sun's way as a rig's configuration asks for it, by the depth of a scene. It lies before the
/// water: a shot is in the shade where the map says so.
pub fn sunny(rig: &Rig<'_>, shot: &mut Shot) -> Option<Texture> {
    let center = scenes::world(&shot.camera, &[[0.0, 0.0, 5.0]])[0];
    shot.sun.region = rig.config.cast.map(|_| Region { center, radius: 4.0 });
    let kind = rig.config.shadow?;
    let (color, depth) = rig.scene(shot);
    let image = match kind {
        Shadows::Mask => color,
        Shadows::Map | Shadows::Convolution(_) => depth,
    };
    let view_projection = shot.camera.projection * shot.camera.view;
    shot.sun.shadow = Some(Shadow { image: image.host_image(), view_projection, bias: 0.1 });
    Some(image)
}

/// What a frame in flight needs to stay alive.
struct Flight {
    color: Texture,
    _depth: Texture,
    _cloud: Cloud,
    recorded: Recorded,
    expected: Drawn,
}

/// Records a shot into a slot and submits it without waiting.
fn launch(rig: &mut Rig<'_>, slot: u32, shot: &Shot, expected: Drawn) -> Flight {
    let (color, depth) = rig.scene(shot);
    let cloud = rig.particles(shot);
    let frame = Frame {
        slot: Slot(slot),
        ..shot.frame(color.host_image(), depth.host_image(), cloud.particles())
    };
    let cmd = rig.stub.begin(slot);
    // SAFETY: cmd is recording, the slot was waited for, the handles live in the flight.
    let recorded = unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    rig.stub.end(slot);
    Flight { color, _depth: depth, _cloud: cloud, recorded, expected }
}

fn output_of(rig: &Rig<'_>, flight: &Flight) -> Image<[f32; 4]> {
    let nothing = Recorded::default();
    rig.read(&flight.color.host_image(), &nothing).output
}

/// Three frames are submitted before the first is waited for, over and over, with a resize between.
#[test]
fn three_slots_in_flight_with_a_resize() {
    for composite in [Shading::Raster, Shading::Compute] {
        in_flight(composite);
    }
}

fn in_flight(composite: Shading) {
    let gpu = Gpu::shared();
    let noise = (composite == Shading::Compute).then_some(1);
    let config = |size| Config { composite: Some(composite), noise, ..config(size) };
    let sizes = [extent(96, 64), extent(61, 97), extent(128, 32), extent(33, 17)];
    let expected: Vec<Vec<Drawn>> = sizes
        .iter()
        .map(|size| {
            let mut rig = Rig::lit(&gpu, &config(*size), 1);
            LENSES[..3].iter().map(|lens| rig.draw(&water(*size, *lens))).collect()
        })
        .collect();
    let mut rig = Rig::lit(&gpu, &config(sizes[0]), 3);
    let mut flights: [Option<Flight>; 3] = [None, None, None];
    for frame in 0..24_usize {
        let slot = frame % 3;
        if let Some(flight) = flights[slot].take() {
            rig.stub.wait(slot as u32);
            rig.renderer().collect(Slot(slot as u32));
            let found = output_of(&rig, &flight);
            compare::same_color(&format!("flight-{frame}"), &found, &flight.expected.output);
        }
        // Twice in a row, and with frames of all slots in flight.
        if [4, 5, 11, 13].contains(&frame) {
            rig.resize(sizes[frame % sizes.len()]);
            assert!(rig.renderer().retired() > 0, "the old images wait for their frames");
        }
        let size = rig.config.extent;
        let which = sizes.iter().position(|s| *s == size).expect("one of them");
        let expected = expected[which][slot].clone();
        let flight = launch(&mut rig, slot as u32, &water(size, LENSES[slot]), expected);
        flights[slot] = Some(flight);
    }
    for (slot, flight) in flights.iter_mut().enumerate() {
        rig.stub.wait(slot as u32);
        rig.renderer().collect(Slot(slot as u32));
        if let Some(flight) = flight.take() {
            compare::same_color("flight-last", &output_of(&rig, &flight), &flight.expected.output);
        }
    }
    assert_eq!(rig.renderer().retired(), 0, "all slots are back");
}

/// The last frame's layers are those of its own record.
#[test]
fn layers_are_read_between_records() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::with_slots(&gpu, &config(size), 3);
    for slot in [0, 2, 1, 2] {
        let shot = water(size, LENSES[slot as usize]);
        let expected = Rig::new(&gpu, &config(size)).draw(&shot);
        let flight = launch(&mut rig, slot, &shot, expected);
        rig.stub.wait(slot);
        rig.renderer().collect(Slot(slot));
        let found = rig.read(&flight.color.host_image(), &flight.recorded);
        compare::same("layers-surface", &found.surface, &flight.expected.surface);
        compare::same("layers-thickness", &found.thickness, &flight.expected.thickness);
    }
}

#[test]
fn two_renderers_share_a_device_and_a_command_buffer() {
    let gpu = Gpu::shared();
    let (small, large) = (extent(48, 32), extent(96, 64));
    let shots = [water(small, Lens::Standard), water(large, Lens::OffAxis)];
    let mut first = Rig::new(&gpu, &config(small));
    let mut second = Rig::new(&gpu, &config(large));
    let expected = [first.draw(&shots[0]), second.draw(&shots[1])];
    let scenes = [first.scene(&shots[0]), second.scene(&shots[1])];
    let clouds = [first.particles(&shots[0]), second.particles(&shots[1])];
    let cmd = first.stub.begin(0);
    for (i, rig) in [&mut first, &mut second].into_iter().enumerate() {
        let frame = Frame {
            slot: Slot(0),
            output: scenes[i].0.host_image(),
            scene_color: scenes[i].0.host_image(),
            scene_depth: scenes[i].1.host_image(),
            particles: clouds[i].particles(),
            camera: shots[i].camera,
            sun: Default::default(),
            previous: None,
            settings: &shots[i].settings,
        };
        // SAFETY: cmd is recording; both renderers' slot 0 was waited for.
        unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    }
    first.stub.end(0);
    first.stub.wait(0);
    for (i, rig) in [&first, &second].into_iter().enumerate() {
        let found = rig.read(&scenes[i].0.host_image(), &Recorded::default());
        compare::same_color(&format!("two-{i}"), &found.output, &expected[i].output);
    }
}

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
    let config = |size| Config {
        cast: Some(32),
        shadow: Some(Shadows::Map),
        foam: true,
        noise: Some(1),
        ..config(size)
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

fn convolved(terms: u32, bits: u32) -> Option<Shadows> {
    Some(Shadows::Convolution(Convolution { terms, texels: 48, bits }))
}

/// Every part of the configuration changes while frames of the old one are in flight.
#[test]
fn reconfigure_gives_what_a_new_renderer_gives() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let base = config(size);
    let configs = [
        base,
        Config { smoothing_level: 0, thickness_level: 0, ..base },
        Config { depth_splat: Some(Splat::Raster), ..base },
        Config { in_place: true, extent: extent(33, 17), max_particles: 1000, ..base },
        Config { environment_size: 32, rule: Rule::Fixed(12), ..base },
        Config { output_format: vk::Format::R16G16B16A16_SFLOAT, ..base },
        Config { composite: Some(Shading::Compute), ..base },
        Config { smoothing: Some(Smoothing::Fused), max_iterations: 9, ..base },
        Config { sheets: 2, ..base },
        Config { sheets: 2, smoothing_level: 0, depth_splat: Some(Splat::Raster), ..base },
        Config { foam: true, sheets: 2, extent: extent(50, 40), ..base },
        Config { foam: true, depth_splat: Some(Splat::Raster), ..base },
        Config { spray: true, ..base },
        Config { spray: true, foam: true, composite: Some(Shading::Compute), ..base },
        Config { noise: Some(1), sheets: 2, ..base },
        Config { noise: Some(0), composite: Some(Shading::Compute), spray: true, ..base },
        Config { cast: Some(32), ..base },
        Config { cast: Some(64), shadow: Some(Shadows::Map), foam: true, spray: true, ..base },
        Config { cast: Some(64), composite: Some(Shading::Compute), sheets: 2, ..base },
        Config { shadow: Some(Shadows::Mask), extent: extent(50, 40), ..base },
        Config { shadow: convolved(4, 8), spray: true, foam: true, ..base },
        Config { shadow: convolved(16, 16), cast: Some(32), ..base },
        Config { shadow: convolved(8, 8), composite: Some(Shading::Compute), ..base },
        Config { motion: true, ..base },
        Config { motion: true, foam: true, thickness_level: 0, extent: extent(50, 40), ..base },
    ];
    let mut rig = Rig::lit(&gpu, &base, 2);
    let mut flight = None;
    // Each takes two renderers: every other one, and all in the long tests.
    let some = configs.into_iter().step_by(if slow() { 1 } else { 2 });
    for (i, config) in some.chain([base]).enumerate() {
        let anew = rig.renderer().reconfigure(&config).expect("reconfigure");
        assert_eq!(anew, rig.config.environment_size != config.environment_size);
        assert_eq!(*rig.renderer().config(), config);
        rig.config = config;
        if anew {
            rig.set_up();
            rig.light();
        }
        let mut shot = water(config.extent, Lens::Standard);
        let _shade = sunny(&rig, &mut shot);
        let expected = Rig::lit(&gpu, &config, 1).draw(&shot);
        let name = format!("reconfigure-{i}");
        let now = launch(&mut rig, i as u32 % 2, &shot, expected);
        // The frame before is still out when the configuration changes.
        rig.stub.wait(i as u32 % 2);
        compare::same_color(&name, &output_of(&rig, &now), &now.expected.output);
        drop(flight.replace(now));
        rig.renderer().collect(Slot((i as u32 + 1) % 2));
    }
    rig.renderer().collect(Slot(0));
    rig.renderer().collect(Slot(1));
    assert_eq!(rig.renderer().retired(), 0);
    let bad = Config { max_particles: 0, ..base };
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
        let frame = Frame {
            slot: Slot(slot),
            ..shot.frame(color.host_image(), depth.host_image(), cloud.particles())
        };
        let cmd = rig.stub.begin(slot);
        // SAFETY: cmd is recording; the slot's work is done.
        unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
        rig.stub.throw_away(slot);
        rig.renderer().resize(size).expect("resize");
        assert!(rig.renderer().retired() > 0);
        rig.renderer().abandon(Slot(slot));
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

/// The layer reports what is left at the end of the device; the allocator is empty.
#[test]
fn destroy_leaves_nothing() {
    let gpu = Gpu::own();
    for in_place in [true, false] {
        let size = extent(32, 16);
        let mut rig = Rig::with_slots(&gpu, &Config { in_place, ..config(size) }, 3);
        rig.draw(&water(size, Lens::Standard));
        rig.resize(extent(16, 8));
        rig.draw(&water(extent(16, 8), Lens::Standard));
        drop(rig);
        assert_eq!(gpu.allocations(), Vec::<String>::new());
    }
}

/// Every depth format there is, sizes that differ, and a device with nothing optional.
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
                eprintln!("skipped: {format:?} is not to be had here");
                continue;
            }
            shot.depth_format = format;
            // The wall is far from the water on both sides: its rounding is no matter.
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
        let make = |in_place| Config { in_place, output_format, composite, ..config(size) };
        let inside = Rig::lit(&gpu, &make(true), 1).draw(&shot);
        let apart = Rig::lit(&gpu, &make(false), 1).draw(&shot);
        compare::same_color("in-place", &inside.output, &apart.output);
        // A renderer for in-place frames draws others too.
        let mut rig = Rig::lit(&gpu, &make(true), 1);
        rig.config.in_place = false;
        compare::same_color("in-place-apart", &rig.draw(&shot).output, &apart.output);
    }
}

#[test]
fn a_device_with_nothing_optional_draws_the_same() {
    let size = extent(64, 48);
    let shot = water(size, Lens::Standard);
    let expected = {
        let gpu = Gpu::shared();
        Rig::new(&gpu, &config(size)).draw(&shot)
    };
    let options = whitewater::headless::DeviceOptions { bare: true, ..Default::default() };
    let mut gpu = Gpu::own_with(&options);
    gpu.leaks = false;
    let found = Rig::new(&gpu, &config(size)).draw(&shot);
    compare::same_color("bare", &found.output, &expected.output);
}

/// A good frame to spoil.
struct Good<'a> {
    frame: Frame<'a>,
    settings: Settings,
}

type Spoil = (&'static str, &'static str, fn(&mut Good<'_>));

/// Every way a frame can be wrong, with the field that the error names.
fn spoils() -> Vec<Spoil> {
    vec![
        ("slot", "Frame.slot", |g| g.frame.slot = Slot(3)),
        ("too large", "Frame.output.rect", |g| {
            g.frame.output.extent.width += 1;
            g.frame.output.rect.extent.width += 1;
        }),
        ("beyond", "HostImage.rect", |g| g.frame.output.rect.offset.x = 1),
        ("before", "HostImage.rect", |g| g.frame.scene_depth.rect.offset.y = -1),
        ("no part", "HostImage.rect", |g| g.frame.scene_color.rect.extent.width = 0),
        ("format", "Frame.output.format", |g| g.frame.output.format = vk::Format::R8G8B8A8_UNORM),
        ("lost output", "Frame.output.before", |g| {
            g.frame.output.before.layout = vk::ImageLayout::UNDEFINED;
        }),
        ("lost colour", "Frame.scene_color.before", |g| {
            g.frame.scene_color.before.layout = vk::ImageLayout::UNDEFINED;
        }),
        ("lost depth", "Frame.scene_depth.before", |g| {
            g.frame.scene_depth.before.layout = vk::ImageLayout::UNDEFINED;
        }),
        ("left undefined", "HostImage.after", |g| {
            g.frame.output.after.layout = vk::ImageLayout::UNDEFINED;
        }),
        ("left preinitialized", "HostImage.after", |g| {
            g.frame.scene_depth.after.layout = vk::ImageLayout::PREINITIALIZED;
        }),
        ("no extent", "HostImage.rect", |g| g.frame.scene_depth.extent.height = 0),
        ("no width", "HostImage.rect", |g| g.frame.scene_color.extent.width = 0),
        ("too many", "Frame.particles.count", |g| g.frame.particles.count = Count::Cpu(4097)),
        ("short buffer", "Frame.particles.positions", |g| {
            g.frame.particles.count = Count::Cpu(4000);
        }),
        ("stride of 8", "Frame.particles.positions", |g| g.frame.particles.positions.stride = 8),
        ("stride of 13", "Frame.particles.positions", |g| g.frame.particles.positions.stride = 13),
        ("stride of 0", "Frame.particles.positions", |g| g.frame.particles.positions.stride = 0),
        ("offset of 2", "Frame.particles.positions", |g| g.frame.particles.positions.offset = 2),
        ("long stride", "Frame.particles.positions", |g| g.frame.particles.positions.stride = 20),
        ("offset beyond", "Frame.particles.positions", |g| {
            g.frame.particles.positions.offset = 1 << 40;
        }),
        ("offset overflow", "Frame.particles.positions", |g| {
            g.frame.particles.positions.offset = u64::MAX - 3;
        }),
        ("density stride", "Frame.particles.densities", |g| {
            let positions = g.frame.particles.positions;
            g.frame.particles.densities = Some(Stream { stride: 2, ..positions });
        }),
        ("density buffer", "Frame.particles.densities", |g| {
            let positions = g.frame.particles.positions;
            g.frame.particles.densities = Some(Stream { size: 8, ..positions });
        }),
        ("count offset", "Frame.particles.count.offset", |g| {
            let buffer = g.frame.particles.positions.buffer;
            g.frame.particles.count = Count::Gpu { buffer, offset: 6 };
        }),
        ("packet offset", "Frame.particles.packets.offset", |g| {
            let buffer = g.frame.particles.positions.buffer;
            g.frame.particles.packets = Some(Packets { buffer, offset: 6, count: 1 });
        }),
        ("many packets", "Frame.particles.packets.count", |g| {
            let buffer = g.frame.particles.positions.buffer;
            g.frame.particles.packets = Some(Packets { buffer, offset: 0, count: 65_536 });
        }),
        ("view", "Frame.camera.view", |g| g.frame.camera.view = glam::Mat4::ZERO),
        ("view of NaN", "Frame.camera.view", |g| g.frame.camera.view.x_axis.y = f32::NAN),
        ("no projection", "Frame.camera.projection", |g| {
            g.frame.camera.projection = glam::Mat4::ZERO;
        }),
        ("infinite projection", "Frame.camera.projection", |g| {
            g.frame.camera.projection.x_axis.x = f32::INFINITY;
        }),
        ("orthographic", "Frame.camera.projection", |g| {
            g.frame.camera.projection =
                glam::Mat4::orthographic_rh(-1.0, 1.0, -1.0, 1.0, 0.1, 10.0);
        }),
        ("flat projection", "Frame.camera.projection", |g| {
            g.frame.camera.projection.y_axis.y = 0.0;
        }),
        ("spacing", "Settings.water.spacing", |g| g.settings.water.spacing = 0.0),
        ("spacing of NaN", "Settings.water.spacing", |g| g.settings.water.spacing = f32::NAN),
        ("rest density", "Settings.water.rest_density", |g| g.settings.water.rest_density = -1.0),
        ("threshold", "Settings.water.density_threshold", |g| {
            g.settings.water.density_threshold = -0.1;
        }),
        ("full density", "Settings.water.density_full", |g| {
            g.settings.water.density_full = 0.1;
        }),
        ("width", "Settings.water.smoothing_width", |g| {
            g.settings.water.smoothing_width = f32::INFINITY;
        }),
        ("falloff", "Settings.water.depth_falloff", |g| g.settings.water.depth_falloff = -1.0),
        ("refraction", "Settings.water.refraction", |g| g.settings.water.refraction = f32::NAN),
        ("specular", "Settings.water.specular", |g| g.settings.water.specular = -1.0),
        ("shininess", "Settings.water.shininess", |g| g.settings.water.shininess = 0.0),
        ("medium", "Settings.water.medium", |g| {
            g.settings.water.medium = whitewater::water::Medium::Physical {
                absorption: [0.0, f32::NAN, 0.0],
                scattering: [0.0; 3],
            };
        }),
        ("fresnel", "Settings.water.fresnel", |g| {
            g.settings.water.fresnel = whitewater::water::Fresnel::Schlick { f0: f32::NAN };
        }),
        ("fresnel power", "Settings.water.fresnel", |g| {
            g.settings.water.fresnel =
                whitewater::water::Fresnel::Source { bias: 0.1, scale: 0.4, power: -2.0 };
        }),
        ("sun", "Settings.light", |g| g.settings.light.direction[0] = f32::NAN),
        ("light", "Settings.light", |g| g.settings.light.color[1] = -1.0),
        ("ambient", "Settings.light", |g| g.settings.light.ambient[2] = f32::INFINITY),
        ("irradiance", "Settings.light", |g| g.settings.light.irradiance[0] = f32::NAN),
        ("foam", "Frame.particles.foam", |g| {
            g.frame.particles.foam = Some(g.frame.particles.positions);
        }),
        ("foam stride", "Frame.particles.foam", |g| {
            g.frame.particles.foam = Some(Stream { stride: 4, ..g.frame.particles.positions });
        }),
        ("velocities", "Frame.particles.velocities", |g| {
            let velocities = Stream { stride: 8, ..g.frame.particles.positions };
            g.frame.particles.velocities = Some(velocities);
        }),
        ("ids", "Frame.particles.ids", |g| {
            g.frame.particles.ids = Some(Stream { offset: 1 << 40, ..g.frame.particles.positions });
        }),
        ("opacity", "Settings.spray.opacity", |g| g.settings.spray.opacity = 1.0),
        ("size", "Settings.spray.size", |g| g.settings.spray.size = 0.0),
        ("droplets", "Settings.spray.droplets", |g| g.settings.spray.droplets = 65),
        ("densities", "Settings.spray.densities", |g| g.settings.spray.densities[1] = 0.1),
        ("spread", "Settings.spray.spread", |g| g.settings.spray.spread = f32::NAN),
        ("shutter", "Settings.spray.shutter", |g| g.settings.spray.shutter = -1.0),
        ("weight", "Settings.noise.weight", |g| g.settings.noise.weight = f32::NAN),
        ("falloff of noise", "Settings.noise.falloff", |g| g.settings.noise.falloff = -1.0),
        ("size of noise", "Settings.noise.size", |g| g.settings.noise.size = 0.0),
        ("cells", "Settings.noise.cells", |g| g.settings.noise.cells = 17.0),
        ("grey", "Settings.noise.foam", |g| g.settings.noise.foam = -0.1),
        ("grey's color", "Settings.noise.color", |g| g.settings.noise.color[0] = 1.5),
        ("drops", "Settings.spray.color", |g| g.settings.spray.color[2] = 2.0),
        ("extinction", "Settings.foam.extinction", |g| g.settings.foam.extinction = f32::NAN),
        ("noise", "Settings.foam.noise", |g| g.settings.foam.noise = 1.5),
        ("threshold", "Settings.foam.motion_threshold", |g| {
            g.settings.foam.motion_threshold = 0.0;
        }),
        ("white", "Settings.foam.front_color", |g| g.settings.foam.front_color[1] = 1.1),
        ("foam's shadow", "Settings.foam.shadow", |g| g.settings.foam.shadow = f32::NAN),
        ("shade", "Settings.light", |g| g.settings.light.shade[0] = -1.0),
        ("region", "Frame.sun.region", |g| {
            g.frame.sun.region = Some(Region { center: [0.0; 3], radius: 1.0 });
        }),
        ("shadow", "Frame.sun.shadow", |g| g.frame.sun.shadow = Some(shadow(&g.frame))),
        ("box", "Settings.shadow.width", |g| g.settings.shadow.width = -1.0),
        ("damping", "Settings.shadow.damping", |g| g.settings.shadow.damping = f32::NAN),
        ("offset", "Settings.shadow.offset", |g| g.settings.shadow.offset = 1.5),
        ("scale", "Settings.shadow.scale", |g| g.settings.shadow.scale = 0.5),
        ("previous", "Frame.previous", |g| {
            g.frame.previous = Some(Previous { camera: g.frame.camera, dt: 0.1 });
        }),
    ]
}

/// The scene's depth as it were the light's.
fn shadow(frame: &Frame<'_>) -> Shadow {
    Shadow { image: frame.scene_depth, view_projection: glam::Mat4::IDENTITY, bias: 0.0 }
}

/// The sun's way where the configuration has it.
fn sunny_spoils() -> Vec<Spoil> {
    fn shadow_of<'a>(g: &'a mut Good<'_>) -> &'a mut Shadow {
        g.frame.sun.shadow.as_mut().expect("a good one")
    }
    fn region_of<'a>(g: &'a mut Good<'_>) -> &'a mut Region {
        g.frame.sun.region.as_mut().expect("a good one")
    }
    vec![
        ("no shadow", "Frame.sun.shadow", |g| g.frame.sun.shadow = None),
        ("no region", "Frame.sun.region", |g| g.frame.sun.region = None),
        ("radius", "Frame.sun.region", |g| region_of(g).radius = 0.0),
        ("radius of NaN", "Frame.sun.region", |g| region_of(g).radius = f32::NAN),
        ("center", "Frame.sun.region", |g| region_of(g).center[1] = f32::INFINITY),
        ("bias", "Frame.sun.shadow.bias", |g| shadow_of(g).bias = f32::NAN),
        ("matrix", "Frame.sun.shadow.view_projection", |g| {
            shadow_of(g).view_projection = glam::Mat4::ZERO;
        }),
        ("part", "HostImage.rect", |g| shadow_of(g).image.rect.offset.x = 1),
        ("lost shadow", "Frame.sun.shadow.image.before", |g| {
            shadow_of(g).image.before.layout = vk::ImageLayout::UNDEFINED;
        }),
    ]
}

#[test]
fn bad_frames_in_the_sun_are_errors_before_any_command() {
    for kind in [Shadows::Map, Shadows::Convolution(Convolution::default())] {
        bad_frames_in_the_sun(kind);
    }
}

fn bad_frames_in_the_sun(kind: Shadows) {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let gpu = gpu;
    let size = extent(32, 16);
    let config = Config { shadow: Some(kind), cast: Some(16), ..config(size) };
    let mut rig = Rig::with_slots(&gpu, &config, 1);
    let mut shot = water(size, Lens::Standard);
    shot.sun.region = Some(Region { center: [0.0; 3], radius: 4.0 });
    let ((color, depth), (_, map)) = (rig.scene(&shot), rig.scene(&shot));
    let cloud = rig.particles(&shot);
    shot.sun.shadow =
        Some(Shadow { image: map.host_image(), view_projection: glam::Mat4::IDENTITY, bias: 0.0 });
    let cmd = rig.stub.begin(0);
    let good = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    for (name, field, spoil) in sunny_spoils() {
        let mut bad = Good { frame: good, settings: shot.settings.clone() };
        spoil(&mut bad);
        let Good { frame, settings } = bad;
        spy::reset();
        // SAFETY: nothing of a bad frame may be used.
        let result = unsafe { rig.renderer().record(cmd, &Frame { settings: &settings, ..frame }) };
        let commands: u32 = spy::COMMANDS.iter().map(|f| f.calls()).sum();
        match result {
            Err(Error::BadInput { field: found, why }) => {
                assert!(
                    found == field && !why.is_empty() && commands == 0,
                    "{name}: {found}, {why}"
                );
            }
            other => panic!("{name}: {:?}", other.map(|_| "no error")),
        }
    }
    // SAFETY: a good frame.
    unsafe { rig.renderer().record(cmd, &good) }.expect("record");
    rig.stub.end(0);
    rig.stub.wait(0);
}

/// Each is found before the first command; the command buffer is still good for the next record.
#[test]
fn bad_frames_are_errors_before_any_command() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let gpu = gpu;
    let size = extent(32, 16);
    let mut rig = Rig::with_slots(&gpu, &config(size), 3);
    let shot = water(size, Lens::Standard);
    let expected = rig.draw(&shot);
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let mut cmd = rig.stub.begin(1);
    let good = Frame {
        slot: Slot(1),
        ..shot.frame(color.host_image(), depth.host_image(), cloud.particles())
    };
    let mut wrong = Vec::new();
    for (name, field, spoil) in spoils() {
        let mut bad = Good { frame: good, settings: shot.settings.clone() };
        spoil(&mut bad);
        let Good { frame, settings } = bad;
        let frame = Frame { settings: &settings, ..frame };
        spy::reset();
        let renderer = rig.renderer();
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            // SAFETY: nothing of a bad frame may be used.
            unsafe { renderer.record(cmd, &frame) }
        }));
        let commands: u32 = spy::COMMANDS.iter().map(|f| f.calls()).sum();
        match result {
            Ok(Err(Error::BadInput { field: found, why })) => {
                if found != field || why.is_empty() || commands > 0 {
                    wrong.push(format!("{name}: {found} ({why}), {commands} commands"));
                }
            }
            Ok(other) => {
                let found = other.map(|_| "no error");
                wrong.push(format!("{name}: {found:?} with {commands} commands"));
                rig.stub.throw_away(1);
                rig.renderer().abandon(Slot(1));
                cmd = rig.stub.begin(1);
            }
            Err(_) => wrong.push(format!("{name}: a panic")),
        }
    }
    rig.stub.throw_away(1);
    let cmd = rig.stub.begin(1);
    // SAFETY: a good frame.
    unsafe { rig.renderer().record(cmd, &good) }.expect("record");
    rig.stub.end(1);
    rig.stub.wait(1);
    let found = rig.read(&color.host_image(), &Recorded::default());
    compare::same_color("after-bad-input", &found.output, &expected.output);
    assert!(wrong.is_empty(), "not found as they should be:\n{}", wrong.join("\n"));
}

/// The output as its own scene needs a renderer that copies it.
#[test]
fn the_output_as_scene_needs_in_place() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let mut rig = Rig::new(&gpu, &Config { in_place: false, ..config(size) });
    let shot = water(size, Lens::Standard);
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    let cmd = rig.stub.begin(0);
    // SAFETY: cmd is recording.
    let result = unsafe { rig.renderer().record(cmd, &frame) };
    rig.stub.end(0);
    rig.stub.wait(0);
    assert!(matches!(result, Err(Error::BadInput { field: "Frame.scene_color", .. })));
}

#[test]
fn bad_configurations_are_errors() {
    let gpu = Gpu::shared();
    let of_texels =
        |texels| Some(Shadows::Convolution(Convolution { texels, ..Convolution::default() }));
    let size = extent(32, 16);
    let good = config(size);
    let most = gpu.limits().max_image_dimension2_d;
    let bad = [
        ("Config.extent", Config { extent: extent(0, 4), ..good }),
        ("Config.extent", Config { extent: extent(4, 0), ..good }),
        ("Config.extent", Config { extent: extent(most + 1, 1), ..good }),
        ("Config.max_particles", Config { max_particles: 0, ..good }),
        ("Config.max_stride", Config { max_stride: 0, ..good }),
        ("Config.max_stride", Config { max_stride: 18, ..good }),
        ("Config.smoothing_level", Config { smoothing_level: 3, thickness_level: 0, ..good }),
        ("Config.thickness_level", Config { thickness_level: 4, ..good }),
        ("Config.max_iterations", Config { max_iterations: 0, ..good }),
        ("Config.max_iterations", Config { max_iterations: 257, ..good }),
        ("Config.coarsening", Config { coarsening: 4, ..good }),
        ("Config.sheets", Config { sheets: 0, ..good }),
        ("Config.sheets", Config { sheets: 3, ..good }),
        ("Config.noise", Config { noise: Some(4), ..good }),
        ("Config.cast", Config { cast: Some(0), ..good }),
        ("Config.cast", Config { cast: Some(24), ..good }),
        ("Config.cast", Config { cast: Some(4112), ..good }),
        ("Config.shadow", Config { shadow: convolved(5, 8), ..good }),
        ("Config.shadow", Config { shadow: convolved(8, 12), ..good }),
        ("Config.shadow", Config { shadow: of_texels(15), ..good }),
        ("Config.shadow", Config { shadow: of_texels(4097), ..good }),
        ("Config.environment_size", Config { environment_size: 8, ..good }),
        ("Config.environment_size", Config { environment_size: 100, ..good }),
        ("Config.environment_size", Config { environment_size: 4096, ..good }),
    ];
    for (field, bad) in bad {
        match Rig::try_new(&gpu, &bad, 1) {
            Err(Error::BadInput { field: found, .. }) => assert_eq!(found, field),
            Err(other) => panic!("{field}: {other}"),
            Ok(_) => panic!("{field}: no error for {bad:?}"),
        }
    }
    for slots in [0, 9] {
        let host = gpu.host(slots);
        // SAFETY: live handles.
        let result = unsafe { Renderer::new(&host, &good) };
        assert!(matches!(result, Err(Error::BadInput { field: "Host.frames_in_flight", .. })));
    }
    let host = whitewater::Host { queue_family: 77, ..gpu.host(1) };
    // SAFETY: live handles; the family is only looked up.
    let result = unsafe { Renderer::new(&host, &good) };
    assert!(matches!(result, Err(Error::BadInput { field: "Host.queue_family", .. })));
    let depth = Config { output_format: vk::Format::D32_SFLOAT, ..good };
    assert!(matches!(Rig::try_new(&gpu, &depth, 1), Err(Error::Missing { .. })));
    let srgb = vk::Format::R8G8B8A8_SRGB;
    let stored = Config { output_format: srgb, composite: Some(Shading::Compute), ..good };
    let storage = vk::FormatFeatureFlags::STORAGE_IMAGE;
    if !gpu.format_features(srgb).contains(storage) {
        assert!(matches!(Rig::try_new(&gpu, &stored, 1), Err(Error::Missing { .. })));
        let mut rig = Rig::new(&gpu, &good);
        assert!(matches!(rig.renderer().reconfigure(&stored), Err(Error::Missing { .. })));
    }

    let mut rig = Rig::new(&gpu, &good);
    for size in [extent(0, 4), extent(most + 1, 4)] {
        let result = rig.renderer().resize(size);
        assert!(matches!(result, Err(Error::BadInput { field: "Config.extent", .. })));
    }
    // As it was.
    let shot = water(size, Lens::Standard);
    let expected = Rig::new(&gpu, &good).draw(&shot);
    compare::same_color("after-bad-resize", &rig.draw(&shot).output, &expected.output);
}

/// A mocked offer: what this device has may not be there elsewhere.
#[test]
fn what_a_device_lacks_is_named() {
    let gpu = Gpu::shared();
    let config = config(extent(32, 16));
    let offer = whitewater::Offer::of(&gpu.instance, gpu.physical, config.output_format);
    offer.check(&config).expect("this device will do");
    let raster = Config { depth_splat: Some(whitewater::water::Splat::Raster), ..config };
    let foam = Config { foam: true, ..config };
    let convolving = |bits| Config { shadow: convolved(8, bits), ..config };
    let motion = Config { motion: true, ..config };
    let noise = Config { noise: Some(1), ..config };
    let unsummed = whitewater::Offer { blend_floats: false, foam_floats: false, ..offer };
    let bare = whitewater::Offer { optional: Enabled::default(), ..offer };
    let gate = |gate| Config { smoothing: Some(Smoothing::Query(gate)), ..config };
    let drawn = Config { composite: Some(Shading::Raster), ..config };
    let stored = Config { composite: Some(Shading::Compute), ..config };
    let lacking = [
        (whitewater::Offer { api_version: vk::API_VERSION_1_2, ..offer }, config, "Vulkan 1.3"),
        (whitewater::Offer { synchronization2: false, ..offer }, config, "synchronization2"),
        (
            whitewater::Offer { output_attachment: false, ..offer },
            drawn,
            "attachment use of the output",
        ),
        (whitewater::Offer { output_storage: false, ..offer }, stored, "storage use of the output"),
        (whitewater::Offer { blend_floats: false, ..offer }, raster, "R32_SFLOAT"),
        (whitewater::Offer { foam_floats: false, ..offer }, foam, "R32G32_SFLOAT"),
        (whitewater::Offer { basis: [false, true], ..offer }, convolving(8), "R8G8B8A8_SNORM"),
        (
            whitewater::Offer { basis: [true, false], ..offer },
            convolving(16),
            "R16G16B16A16_SFLOAT",
        ),
        (whitewater::Offer { motion_floats: false, ..offer }, motion, "R32G32_SFLOAT"),
        (unsummed, noise, "R32_SFLOAT"),
        (bare, gate(Gate::DrawCount), "drawIndirectCount"),
        (bare, gate(Gate::Predicate), "VK_EXT_conditional_rendering"),
    ];
    for (offer, config, needle) in lacking {
        match offer.check(&config) {
            Err(Error::Missing { what, why }) => {
                assert!(what.contains(needle) && !why.is_empty(), "{what}: {why}");
            }
            other => panic!("{needle}: {other:?}"),
        }
    }
    let unblended = whitewater::Offer { blend_floats: false, ..offer };
    unblended.check(&config).expect("the compute paths need no blending");
    let unfoamed = whitewater::Offer { foam_floats: false, ..offer };
    unfoamed.check(&raster).expect("water needs nothing of foam's");
    let other = whitewater::Offer { basis: [true, false], ..offer };
    other.check(&convolving(8)).expect("eight bits are there");
    let mut small = offer;
    small.limits.max_image_dimension2_d = 99;
    let shown = Config { extent: extent(32, 16), ..convolving(8) };
    assert!(matches!(small.check(&shown), Err(Error::BadInput { field: "Config.shadow", .. })));
    unfoamed.check(&noise).expect("what the raster splats blend is enough for noise");
    // Foam's chunks are 64 particles at least.
    let mut narrow = offer;
    narrow.limits.max_storage_buffer_range = (1 << 20) + 256;
    let wide = |foam| Config { foam, max_stride: 1 << 16, ..config };
    narrow.check(&wide(false)).expect("sixteen particles are bound at once");
    assert!(matches!(narrow.check(&wide(true)), Err(Error::BadInput { .. })));
    let unattached = whitewater::Offer { output_attachment: false, ..offer };
    unattached.check(&stored).expect("nothing is drawn into the output");
    let unstored = whitewater::Offer { output_storage: false, ..offer };
    unstored.check(&drawn).expect("nothing is stored to the output");
}

/// The host's images come back in the state that was asked for, from any they were in.
#[test]
fn images_are_taken_from_and_left_in_any_state() {
    for composite in [Shading::Raster, Shading::Compute] {
        in_any_state(composite);
    }
}

fn in_any_state(composite: Shading) {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let config = Config { composite: Some(composite), ..config(size) };
    let mut rig = Rig::lit(&gpu, &config, 1);
    let shot = water(size, Lens::Standard);
    let expected = rig.draw(&shot);
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
    for (before, after) in [(COLOR, sampled), (sampled, general), (general, COLOR)] {
        let (mut color, mut depth) = rig.scene(&shot);
        rig.stub.run(|cmd| {
            rig.stub.barrier(cmd, color.image, color.aspect, color.state, before);
            let to = if before == COLOR { depth.state } else { read_only };
            rig.stub.barrier(cmd, depth.image, depth.aspect, depth.state, to);
            depth.state = to;
        });
        color.state = before;
        let cloud = rig.particles(&shot);
        let output = HostImage { after, ..color.host_image() };
        let scene_depth = HostImage { after: general, ..depth.host_image() };
        let frame = shot.frame(output, scene_depth, cloud.particles());
        let cmd = rig.stub.begin(0);
        // SAFETY: cmd is recording; the handles live to the end of this.
        unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
        rig.stub.end(0);
        rig.stub.wait(0);
        let found = rig.read(&output, &Recorded::default());
        compare::same_color("states", &found.output, &expected.output);
    }
}

/// 64 bytes of device memory a particle beside the input is the promise.
#[test]
fn ten_million_particles_have_room() {
    let gpu = Gpu::shared();
    let count = 10_000_000;
    let config = Config { max_particles: count, ..config(extent(64, 48)) };
    // SAFETY: live handles.
    let renderer = unsafe { whitewater::Renderer::new(&gpu.host(1), &config) }.expect("room");
    let memory = renderer.memory();
    // SAFETY: nothing was recorded.
    unsafe { renderer.destroy() };
    assert!(memory.buffers > 32 * u64::from(count), "{memory:?} holds no spheres");
    assert!(memory.buffers < 64 * u64::from(count), "{memory:?}");
}

/// The memory table of the crate's documentation: bytes a pixel and a particle. Images are padded
/// and aligned as the driver likes; that is a hundredth, and some KiB an object.
#[test]
fn memory_is_as_documented() {
    let gpu = Gpu::shared();
    let needed = |width: u32, height: u32, count: u32, (sheets, coarsening, foam, spray)| {
        let format = vk::Format::R16G16B16A16_SFLOAT;
        let size = extent(width, height);
        let config = Config { sheets, coarsening, foam, spray, ..Config::new(size, format, count) };
        // SAFETY: live handles.
        let renderer = unsafe { Renderer::new(&gpu.host(1), &config) }.expect("a renderer");
        let memory = renderer.memory();
        // SAFETY: nothing was recorded.
        unsafe { renderer.destroy() };
        (memory.images + memory.buffers) as f64
    };
    for (width, height, count) in [(1280, 720, 65_536), (1920, 1080, 1 << 20)] {
        // Of the larger size a part, and all in the long tests.
        let whole = slow() || width == 1280;
        let (pixels, n) = (f64::from(width * height), f64::from(count));
        let cube = 6.0 * 8.0 * 4.0 / 3.0 * 256.0 * 256.0;
        // The light's maps, and a lit scene in place of the copied one, which is of half precision
        // too.
        for cast in [None, Some(256), Some(1024)].into_iter().filter(|_| whole) {
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let config = Config { cast, ..Config::new(extent(width, height), format, count) };
            // SAFETY: live handles.
            let renderer = unsafe { Renderer::new(&gpu.host(1), &config) }.expect("a renderer");
            let memory = renderer.memory();
            // SAFETY: nothing was recorded.
            unsafe { renderer.destroy() };
            let maps = cast.map_or(0.0, |n| 36.0 * f64::from(n * n));
            let found = (memory.images + memory.buffers) as f64;
            let said = needed(width, height, count, (2, 3, false, false)) + maps;
            let off = (found - said).abs();
            assert!(off < 0.01 * said + 512.0 * 1024.0, "{cast:?}: {found}, said {said}");
        }
        // Motion: a vector; of a texel of 16 pixels 64 bytes of sums and two depths.
        for (thickness_level, said) in
            [(0, 48.0), (1, 26.0), (2, 12.5), (3, 9.125)].into_iter().filter(|_| whole)
        {
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let of = |motion| {
                let size = extent(width, height);
                let config = Config { motion, thickness_level, ..Config::new(size, format, count) };
                // SAFETY: live handles.
                let renderer = unsafe { Renderer::new(&gpu.host(1), &config) }.expect("a renderer");
                let memory = renderer.memory();
                // SAFETY: nothing was recorded.
                unsafe { renderer.destroy() };
                (memory.images + memory.buffers) as f64
            };
            let found = of(true) - of(false);
            let off = (found - said * pixels).abs();
            assert!(off < 0.01 * said * pixels + 512.0 * 1024.0, "{thickness_level}: {found}");
        }
        // Noise: a number a texel of its own, and its sprites.
        for level in (0..4).filter(|_| whole) {
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let config =
                Config { noise: Some(level), ..Config::new(extent(width, height), format, count) };
            // SAFETY: live handles.
            let renderer = unsafe { Renderer::new(&gpu.host(1), &config) }.expect("a renderer");
            let memory = renderer.memory();
            // SAFETY: nothing was recorded.
            unsafe { renderer.destroy() };
            let texels = f64::from(width.div_ceil(1 << level) * height.div_ceil(1 << level));
            let found = (memory.images + memory.buffers) as f64;
            let plain = needed(width, height, count, (2, 3, false, false));
            let (more, said) = (found - plain, 4.0 * texels + 16.0 * n);
            assert!(
                (more - said).abs() < 0.01 * said + 64.0 * 1024.0,
                "{level}: {more}, said {said}"
            );
        }
        // Of two sheets, a texel of 16 pixels has 16 bytes of thickness, 16 more of sums and a
        // boundary, a cell of 64 four numbers; the back sheet is where the coarser level would be.
        // Foam: of a texel 4 bytes of depth, 8 of thickness, 4 of water before it, sums of 8 each.
        for (sheets, coarsening, foam, spray, smoothing, more) in [
            (1, 3, false, false, 4.5, 0.0),
            (1, 0, false, false, 3.0, 0.0),
            (2, 3, false, false, 4.5, 2.5),
            (2, 0, false, false, 4.5, 2.5),
            (1, 3, true, false, 4.5, 2.0),
            (2, 3, true, false, 4.5, 4.5),
            (1, 3, false, true, 4.5, 4.0),
            (2, 3, true, true, 4.5, 8.5),
        ]
        .into_iter()
        .step_by(if whole { 1 } else { 7 })
        {
            let each = 32.0 + if foam { 52.0 } else { 0.0 } + if spray { 32.0 } else { 0.0 };
            let said = pixels * (4.0 + smoothing + 0.5 + 0.25 + 8.0 + more) + each * n + cube;
            let found = needed(width, height, count, (sheets, coarsening, foam, spray));
            let off = (found - said).abs();
            let name = format!("{width}x{height}, {sheets} sheets, foam {foam}, spray {spray}");
            assert!(off < 0.01 * said + 512.0 * 1024.0, "{name}: {found}, said {said}");
        }
    }
}

/// Every pass has a scope; starts never fall, nothing is negative. Durations are no matter.
#[test]
fn timings_name_every_pass() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let config =
        Config { sheets: 2, foam: true, spray: true, motion: true, noise: Some(1), ..config(size) };
    let mut rig = Rig::with_slots(&gpu, &config, 2);
    let mut shot = water(size, Lens::Standard);
    assert!(rig.renderer().timings(Slot(0)).is_empty(), "before the first frame");
    assert!(rig.renderer().timings(Slot(9)).is_empty(), "no such slot");
    for _ in 0..3 {
        rig.draw(&shot);
        let timings = rig.renderer().timings(Slot(0)).to_vec();
        let names: Vec<&str> = timings.iter().map(|t| t.name).collect();
        let wanted = [
            "cull",
            "front",
            "depth",
            "foam",
            "spray",
            "gaps",
            "thickness",
            "reduce",
            "level",
            "back",
            "tiles",
            "smooth",
            "split",
            "motion",
            "noise",
            "scene",
            "composite",
        ];
        assert_eq!(names, wanted);
        for t in &timings {
            assert!(t.start >= 0.0 && t.nanoseconds >= 0.0 && t.nanoseconds < 6e10, "{t:?}");
        }
        let falls = timings.windows(2).any(|w| w[1].start < w[0].start);
        assert!(!falls, "{timings:?}");
    }
    assert!(rig.renderer().timings(Slot(1)).is_empty(), "a slot without a frame");
    let mut rig = Rig::new(&gpu, &Config { cast: Some(16), ..config });
    sunny(&rig, &mut shot);
    rig.draw(&shot);
    let names: Vec<&str> = rig.renderer().timings(Slot(0)).iter().map(|t| t.name).collect();
    let at = |name| names.iter().position(|n| *n == name);
    let (light, caustics, lit) = (at("light"), at("caustics"), at("lit"));
    assert!(light.is_some() && light < caustics && caustics < lit, "{names:?}");
    assert!(lit < at("composite"), "{names:?}");
}
