//! Bad frames and configurations give an error that names the field, before any command is
//! recorded.

use ash::vk;
use whitewater::water::{Convolution, MAX_PANES, Pane, Shading, Shadows};
use whitewater::{
    Context, Count, EnvironmentSource, Equirectangular, Error, Frame, LightVolume, Packets,
    Previous, Recorded, Settings, Shadow, Slot, Stream,
};

use crate::support::device::Gpu;
use crate::support::rig::{Rig, config, extent};
use crate::support::scenes::Lens;
use crate::support::{compare, spy};

use super::life::convolved;
use super::water;

/// A good frame, in which one input is made invalid.
struct Good<'a> {
    frame: Frame<'a>,
    settings: Settings,
}

type Spoil = (&'static str, &'static str, fn(&mut Good<'_>));

/// Every way a frame can be invalid, with the field that the error names.
fn spoils() -> Vec<Spoil> {
    vec![
        ("slot", "Frame.slot", |g| g.frame.slot = Slot(3)),
        ("too large", "Frame.output.rect", |g| {
            g.frame.output.extent.width += 1;
            g.frame.output.rect.extent.width += 1;
        }),
        ("beyond", "Frame.output.rect", |g| g.frame.output.rect.offset.x = 1),
        ("before", "Frame.scene_depth.rect", |g| g.frame.scene_depth.rect.offset.y = -1),
        ("no part", "Frame.scene_color.rect", |g| g.frame.scene_color.rect.extent.width = 0),
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
        ("left undefined", "Frame.output.after", |g| {
            g.frame.output.after.layout = vk::ImageLayout::UNDEFINED;
        }),
        ("left preinitialized", "Frame.scene_depth.after", |g| {
            g.frame.scene_depth.after.layout = vk::ImageLayout::PREINITIALIZED;
        }),
        ("no extent", "Frame.scene_depth.rect", |g| g.frame.scene_depth.extent.height = 0),
        ("no width", "Frame.scene_color.rect", |g| g.frame.scene_color.extent.width = 0),
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
        ("view", "Frame.camera.view", |g| g.frame.camera.view = [[0.0; 4]; 4]),
        ("view of NaN", "Frame.camera.view", |g| g.frame.camera.view[0][1] = f32::NAN),
        ("no projection", "Frame.camera.projection", |g| {
            g.frame.camera.projection = [[0.0; 4]; 4];
        }),
        ("infinite projection", "Frame.camera.projection", |g| {
            g.frame.camera.projection[0][0] = f32::INFINITY;
        }),
        ("orthographic", "Frame.camera.projection", |g| {
            g.frame.camera.projection =
                glam::Mat4::orthographic_rh(-1.0, 1.0, -1.0, 1.0, 0.1, 10.0).to_cols_array_2d();
        }),
        ("flat projection", "Frame.camera.projection", |g| {
            g.frame.camera.projection[1][1] = 0.0;
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
        ("waves too steep", "Settings.water.wavelets.slope", |g| {
            g.settings.water.wavelets.slope = 0.6;
        }),
        ("waves of no length", "Settings.water.wavelets.length", |g| {
            g.settings.water.wavelets.length = 0.0;
        }),
        ("waves at no time", "Settings.water.wavelets.time", |g| {
            g.settings.water.wavelets.time = f64::NAN;
        }),
        ("waves of no gravity", "Settings.water.wavelets.gravity", |g| {
            g.settings.water.wavelets.gravity = -9.81;
        }),
        ("refraction", "Settings.water.refraction", |g| g.settings.water.refraction = f32::NAN),
        ("specular", "Settings.water.specular", |g| g.settings.water.specular = -1.0),
        ("shininess", "Settings.water.shininess", |g| g.settings.water.shininess = 0.0),
        ("medium", "Settings.water.medium", |g| {
            g.settings.water.medium = whitewater::water::Medium::Physical {
                absorption: [0.0, f32::NAN, 0.0],
                scattering: [0.0; 3],
            };
        }),
        ("fresnel", "Settings.water.fresnel.f0", |g| {
            g.settings.water.fresnel = whitewater::water::Fresnel::Schlick { f0: f32::NAN };
        }),
        ("reflectance", "Settings.water.fresnel.f0", |g| {
            g.settings.water.fresnel = whitewater::water::Fresnel::Schlick { f0: 1.1 };
        }),
        ("base", "Settings.water.medium.base", |g| {
            let (base, falloff) = ([0.1, 1.1, 0.3], [1.0; 4]);
            g.settings.water.medium = whitewater::water::Medium::Source { base, falloff };
        }),
        ("fresnel power", "Settings.water.fresnel", |g| {
            g.settings.water.fresnel =
                whitewater::water::Fresnel::Source { bias: 0.1, scale: 0.4, power: -2.0 };
        }),
        ("sun", "Settings.light", |g| g.settings.light.direction[0] = f32::NAN),
        ("light", "Settings.light", |g| g.settings.light.color[1] = -1.0),
        ("ambient", "Settings.light", |g| g.settings.light.ambient[2] = f32::INFINITY),
        ("irradiance", "Settings.light", |g| g.settings.light.irradiance[0] = f32::NAN),
        ("foam", "Frame.particles.surface_foam", |g| {
            g.frame.particles.surface_foam = Some(g.frame.particles.positions);
        }),
        ("foam stride", "Frame.particles.surface_foam", |g| {
            g.frame.particles.surface_foam =
                Some(Stream { stride: 4, ..g.frame.particles.positions });
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
        ("angle", "Settings.spray.max_angle", |g| g.settings.spray.max_angle = 0.0),
        ("droplets", "Settings.spray.droplets", |g| g.settings.spray.droplets = 65),
        ("lace", "Settings.surface_foam.lace_shade", |g| g.settings.surface_foam.lace_shade = 2.5),
        ("densities", "Settings.spray.full_water_density", |g| {
            g.settings.spray.full_water_density = 0.1
        }),
        ("spread", "Settings.spray.scatter_radius", |g| g.settings.spray.scatter_radius = f32::NAN),
        ("strand", "Settings.spray.strand_ratio", |g| g.settings.spray.strand_ratio = 8.5),
        ("few neighbours", "Settings.spray.few_neighbours", |g| {
            g.settings.spray.few_neighbours = [0.0, 65.0]
        }),
        ("few neighbours, reversed", "Settings.spray.few_neighbours", |g| {
            g.settings.spray.few_neighbours = [3.0, 2.0]
        }),
        ("few neighbours of foam", "Settings.surface_foam.few_neighbours", |g| {
            g.settings.surface_foam.few_neighbours = [-1.0, 2.0]
        }),
        ("no strand", "Settings.spray.strand_ratio", |g| g.settings.spray.strand_ratio = 0.9),
        ("scattering", "Settings.spray.scattering", |g| g.settings.spray.scattering = 1.1),
        ("no scattering", "Settings.spray.scattering", |g| g.settings.spray.scattering = f32::NAN),
        ("relief", "Settings.spray.relief", |g| g.settings.spray.relief = 4.5),
        ("clumps", "Settings.spray.clumps", |g| g.settings.spray.clumps = 3.5),
        ("glints", "Settings.spray.glints", |g| g.settings.spray.glints = -1.0),
        ("no relief", "Settings.spray.relief", |g| g.settings.spray.relief = -0.1),
        ("shutter", "Settings.spray.exposure", |g| g.settings.spray.exposure = -1.0),
        ("weight", "Settings.noise.weight", |g| g.settings.noise.weight = f32::NAN),
        ("falloff of noise", "Settings.noise.falloff", |g| g.settings.noise.falloff = -1.0),
        ("size of noise", "Settings.noise.size", |g| g.settings.noise.size = 0.0),
        ("cells", "Settings.noise.cells", |g| g.settings.noise.cells = 17.0),
        ("noise in the air", "Settings.noise.airborne", |g| g.settings.noise.airborne = 1.5),
        ("grey", "Settings.noise.foam", |g| g.settings.noise.foam = -0.1),
        ("grey's color", "Settings.noise.color", |g| g.settings.noise.color[0] = 1.5),
        ("drops", "Settings.spray.color", |g| g.settings.spray.color[2] = 2.0),
        ("extinction", "Settings.surface_foam.extinction", |g| {
            g.settings.surface_foam.extinction = f32::NAN
        }),
        ("noise", "Settings.surface_foam.noise", |g| g.settings.surface_foam.noise = 1.5),
        ("noise beside a pattern", "Settings.surface_foam.noise", |g| {
            g.settings.surface_foam.noise = 0.1
        }),
        ("pattern", "Settings.surface_foam.pattern", |g| g.settings.surface_foam.pattern = -0.5),
        ("pattern size", "Settings.surface_foam.pattern_size", |g| {
            g.settings.surface_foam.pattern_size = 0.0
        }),
        ("pattern period", "Settings.surface_foam.pattern_period", |g| {
            g.settings.surface_foam.pattern_period = 0.0
        }),
        ("time", "Settings.surface_foam.time", |g| g.settings.surface_foam.time = f64::INFINITY),
        ("threshold", "Settings.surface_foam.motion_threshold", |g| {
            g.settings.surface_foam.motion_threshold = 0.0;
        }),
        ("white", "Settings.surface_foam.front_color", |g| {
            g.settings.surface_foam.front_color[1] = 1.1
        }),
        ("foam's shadow", "Settings.surface_foam.shadow", |g| {
            g.settings.surface_foam.shadow = f32::NAN
        }),
        ("shade", "Settings.light", |g| g.settings.light.shade[0] = -1.0),
        ("region", "Frame.light_volume", |g| {
            g.frame.light_volume = Some(LightVolume { center: [0.0; 3], radius: 1.0 });
        }),
        ("shadow", "Frame.shadow", |g| g.frame.shadow = Some(shadow(&g.frame))),
        ("panes", "Frame.panes", |g| g.frame.panes = &[PANE; MAX_PANES + 1]),
        ("a line for a pane", "Frame.panes", |g| {
            const LINE: Pane = Pane { edges: [[1.0, 2.0, 0.0], [2.0, 4.0, 0.0]], ..PANE };
            g.frame.panes = &[PANE, LINE];
        }),
        ("a point for a pane", "Frame.panes", |g| {
            g.frame.panes = &[Pane { edges: [[0.0; 3]; 2], ..PANE }];
        }),
        ("nowhere's pane", "Frame.panes", |g| {
            g.frame.panes = &[Pane { corner: [0.0, f32::NAN, 0.0], ..PANE }];
        }),
        ("an endless pane", "Frame.panes", |g| {
            g.frame.panes = &[Pane { edges: [[1.0, 0.0, 0.0], [0.0, f32::INFINITY, 0.0]], ..PANE }];
        }),
        ("box", "Settings.shadow.width", |g| g.settings.shadow.width = -1.0),
        ("damping", "Settings.shadow.damping", |g| g.settings.shadow.damping = f32::NAN),
        ("offset", "Settings.shadow.offset", |g| g.settings.shadow.offset = 1.5),
        ("scale", "Settings.shadow.scale", |g| g.settings.shadow.scale = 0.5),
        ("previous", "Frame.previous", |g| {
            g.frame.previous = Some(Previous { camera: g.frame.camera, dt: 0.1 });
        }),
    ]
}

/// A pane that is right.
const PANE: Pane = Pane { corner: [0.0; 3], edges: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] };

/// A shadow map: the scene's depth image stands in for the light's.
fn shadow(frame: &Frame<'_>) -> Shadow {
    Shadow::new(frame.scene_depth, glam::Mat4::IDENTITY.to_cols_array_2d())
}

/// The ways in which the light's inputs can be invalid.
fn sunny_spoils() -> Vec<Spoil> {
    fn shadow_of<'a>(g: &'a mut Good<'_>) -> &'a mut Shadow {
        g.frame.shadow.as_mut().expect("a good one")
    }
    fn region_of<'a>(g: &'a mut Good<'_>) -> &'a mut LightVolume {
        g.frame.light_volume.as_mut().expect("a good one")
    }
    vec![
        ("no shadow", "Frame.shadow", |g| g.frame.shadow = None),
        ("no region", "Frame.light_volume", |g| g.frame.light_volume = None),
        ("radius", "Frame.light_volume", |g| region_of(g).radius = 0.0),
        ("radius of NaN", "Frame.light_volume", |g| region_of(g).radius = f32::NAN),
        ("center", "Frame.light_volume", |g| region_of(g).center[1] = f32::INFINITY),
        ("bias", "Frame.shadow.bias", |g| shadow_of(g).bias = f32::NAN),
        ("matrix", "Frame.shadow.view_projection", |g| {
            shadow_of(g).view_projection = [[0.0; 4]; 4];
        }),
        ("part", "Frame.shadow.image.rect", |g| shadow_of(g).image.rect.offset.x = 1),
        ("lost shadow", "Frame.shadow.image.before", |g| {
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
    let config = config(size).with(|it| {
        it.shadow = Some(kind);
        it.light_map_size = Some(16);
    });
    let mut rig = Rig::with_slots(&gpu, &config, 1);
    let mut shot = water(size, Lens::Standard);
    shot.light_volume = Some(LightVolume { center: [0.0; 3], radius: 4.0 });
    let ((color, depth), (_, map)) = (rig.scene(&shot), rig.scene(&shot));
    let cloud = rig.particles(&shot);
    shot.shadow = Some(Shadow::new(map.host_image(), glam::Mat4::IDENTITY.to_cols_array_2d()));
    let cmd = rig.stub.begin(0);
    let good = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    for (name, field, spoil) in sunny_spoils() {
        let mut bad = Good { frame: good, settings: shot.settings.clone() };
        spoil(&mut bad);
        let Good { frame, settings } = bad;
        spy::reset();
        // SAFETY: a frame with bad input uses no handle.
        let result =
            unsafe { rig.renderer().record(cmd, &frame.with(|it| it.settings = &settings)) };
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
    // SAFETY: the frame is good.
    unsafe { rig.renderer().record(cmd, &good) }.expect("record");
    rig.stub.end(0);
    rig.stub.wait(0);
}

/// Each error is found before the first command, so the command buffer can be used for the next
/// record.
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
    let good = shot
        .frame(color.host_image(), depth.host_image(), cloud.particles())
        .with(|it| it.slot = Slot(1));
    let mut wrong = Vec::new();
    for (name, field, spoil) in spoils() {
        let mut bad = Good { frame: good, settings: shot.settings.clone() };
        spoil(&mut bad);
        let Good { frame, settings } = bad;
        let frame = frame.with(|it| it.settings = &settings);
        spy::reset();
        let renderer = rig.renderer();
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            // SAFETY: a frame with bad input uses no handle.
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
                rig.abandon(Slot(1));
                cmd = rig.stub.begin(1);
            }
            Err(_) => wrong.push(format!("{name}: a panic")),
        }
    }
    rig.stub.throw_away(1);
    let cmd = rig.stub.begin(1);
    // SAFETY: the frame is good.
    unsafe { rig.renderer().record(cmd, &good) }.expect("record");
    rig.stub.end(1);
    rig.stub.wait(1);
    let found = rig.read(&color.host_image(), &Recorded::default());
    compare::same_color("after-bad-input", &found.output, &expected.output);
    assert!(wrong.is_empty(), "not found as they should be:\n{}", wrong.join("\n"));
}

/// Using the output as its own scene needs a renderer that copies it (`in_place`).
#[test]
fn the_output_as_scene_needs_in_place() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let mut rig = Rig::new(&gpu, &config(size).with(|it| it.in_place = false));
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
        ("Config.extent", good.with(|it| it.extent = extent(0, 4))),
        ("Config.extent", good.with(|it| it.extent = extent(4, 0))),
        ("Config.extent", good.with(|it| it.extent = extent(most + 1, 1))),
        ("Config.max_particles", good.with(|it| it.max_particles = 0)),
        ("Config.max_stride", good.with(|it| it.max_stride = 0)),
        ("Config.max_stride", good.with(|it| it.max_stride = 18)),
        (
            "Config.smoothing_level",
            good.with(|it| {
                it.smoothing_level = 3;
                it.thickness_level = 0;
            }),
        ),
        ("Config.thickness_level", good.with(|it| it.thickness_level = 4)),
        ("Config.max_iterations", good.with(|it| it.max_iterations = 0)),
        ("Config.max_iterations", good.with(|it| it.max_iterations = 257)),
        ("Config.coarsening", good.with(|it| it.coarsening = 4)),
        ("Config.mirror_steps", good.with(|it| it.mirror_steps = 65)),
        ("Config.mirror_steps", good.with(|it| it.mirror_steps = u32::MAX)),
        ("Config.sheets", good.with(|it| it.sheets = 0)),
        ("Config.sheets", good.with(|it| it.sheets = 3)),
        ("Config.noise", good.with(|it| it.noise = Some(4))),
        ("Config.light_map_size", good.with(|it| it.light_map_size = Some(0))),
        ("Config.light_map_size", good.with(|it| it.light_map_size = Some(24))),
        ("Config.light_map_size", good.with(|it| it.light_map_size = Some(4112))),
        ("Config.shadow", good.with(|it| it.shadow = convolved(5, 8))),
        ("Config.shadow", good.with(|it| it.shadow = convolved(8, 12))),
        ("Config.shadow", good.with(|it| it.shadow = of_texels(15))),
        ("Config.shadow", good.with(|it| it.shadow = of_texels(4097))),
        ("Config.environment_size", good.with(|it| it.environment_size = 8)),
        ("Config.environment_size", good.with(|it| it.environment_size = 100)),
        ("Config.environment_size", good.with(|it| it.environment_size = 4096)),
    ];
    for (field, bad) in bad {
        match Rig::try_new(&gpu, &bad, 1) {
            Err(Error::BadInput { field: found, .. }) => assert_eq!(found, field),
            Err(other) => panic!("{field}: {other}"),
            Ok(_) => panic!("{field}: no error for {bad:?}"),
        }
    }
    for slots in [0, 9] {
        // SAFETY: live handles.
        let result = unsafe { Context::new(&gpu.host(slots)) }.map(|_| ());
        assert!(matches!(result, Err(Error::BadInput { field: "Host.frames_in_flight", .. })));
        let result = gpu.context(1).with_frames_in_flight(slots).map(|_| ());
        assert!(matches!(result, Err(Error::BadInput { field: "Host.frames_in_flight", .. })));
    }
    let host = gpu.host(1).with(|it| it.queue_family = 77);
    // SAFETY: the handles are live, and the family is only looked up.
    let result = unsafe { Context::new(&host) }.map(|_| ());
    assert!(matches!(result, Err(Error::BadInput { field: "Host.queue_family", .. })));
    let depth = good.with(|it| it.output_format = vk::Format::D32_SFLOAT);
    assert!(matches!(Rig::try_new(&gpu, &depth, 1), Err(Error::Missing { .. })));
    let srgb = vk::Format::R8G8B8A8_SRGB;
    let stored = good.with(|it| {
        it.output_format = srgb;
        it.composite = Some(Shading::Compute);
    });
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
    // The failed calls leave the renderer as it was.
    let shot = water(size, Lens::Standard);
    let expected = Rig::new(&gpu, &good).draw(&shot);
    compare::same_color("after-bad-resize", &rig.draw(&shot).output, &expected.output);
}

/// A bad image of the environment is named before any command.
#[test]
fn bad_environments_are_errors() {
    let gpu = Gpu::shared();
    let size = extent(8, 4);
    let mut rig = Rig::new(&gpu, &config(extent(16, 16)));
    let map = rig.map(size, &[[0.5; 4]; 32]);
    let good = map.host_image();
    let part = vk::Rect2D { extent: extent(4, 4), ..Default::default() };
    let mut unknown = good;
    unknown.before.layout = vk::ImageLayout::UNDEFINED;
    let of = |image, without_sun| {
        let mut map = Equirectangular::new(image);
        map.without_sun = without_sun;
        map
    };
    let cases = [
        (of(unknown, None), "Equirectangular.image.before"),
        (of(good.with_rect(part), None), "Equirectangular.image.rect"),
        (of(good, Some(unknown)), "Equirectangular.without_sun.before"),
        (of(good, Some(good.with_rect(part))), "Equirectangular.without_sun.rect"),
    ];
    for (source, named) in cases {
        let cmd = rig.stub.begin(0);
        let source = EnvironmentSource::Equirectangular(source);
        // SAFETY: cmd is recording; it is never submitted.
        let result = unsafe { rig.renderer().record_environment(cmd, Slot(0), &source) };
        rig.stub.throw_away(0);
        let Err(Error::BadInput { field, .. }) = result else { panic!("{named}: {result:?}") };
        assert_eq!(field, named);
    }
}
