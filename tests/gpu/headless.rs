//! The headless renderer and its stand-in scene behind a spy: whichever call fails, nothing leaks,
//! and the next attempt succeeds.

use std::sync::{Arc, Mutex};

use ash::vk;
use glam::{Mat4, Vec3};
use whitewater::headless::scene::{Material, Mesh, Scene, Texture};
use whitewater::headless::{Background, Device, Headless};
use whitewater::water::{Pane, WeberSettings};
use whitewater::{Camera, Error, Sky};

use crate::support::device::Gpu;
use crate::support::rig::{Shot, config, extent};
use crate::support::scenes::{self, Lens};
use crate::support::spy::{self, MAKERS};

const SIZE: vk::Extent2D = vk::Extent2D { width: 32, height: 16 };
const NO_MEMORY: vk::Result = vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;

/// A device with the spy in its function table. The test runs alone until its thread ends (turn.rs).
fn spied() -> (Gpu, Device) {
    let mut gpu = Gpu::own();
    let functions = spy::functions(&gpu);
    let allocator = gpu.make_allocator(&functions);
    let mut device = gpu.take_device();
    device.device = functions;
    device.allocator = Arc::new(Mutex::new(allocator));
    spy::reset();
    spy::forget();
    (gpu, device)
}

/// The numbers of some of a function's calls, including the first and the last.
fn chosen(calls: u32) -> Vec<u32> {
    let mut chosen: Vec<u32> = (0..calls.min(4)).map(|i| 1 + i * (calls - 1) / 3).collect();
    chosen.dedup();
    chosen
}

fn is_memory_error(error: &Error) -> bool {
    match error {
        Error::Vulkan { result, .. } => *result == NO_MEMORY,
        Error::Allocation { .. } => true,
        _ => false,
    }
}

/// A textured box on a plain sheet: two pipelines, two textures.
fn scene() -> Scene {
    let texture = Arc::new(Texture { width: 3, height: 2, data: vec![[200, 100, 50, 255]; 6] });
    let textured = Material { texture: Some(texture), ..Material::default() };
    let meshes = vec![
        Mesh::cuboid([0.0, 0.0, -4.0], [0.5; 3], [0.0, 0.0, 0.0, 1.0], textured),
        Mesh::plane([0.0, -0.5, -4.0], [2.0, 2.0], Material::default()),
    ];
    Scene { meshes, ..Scene::default() }
}

#[test]
fn a_failed_headless_leaves_nothing() {
    let calls: Vec<u32> = {
        let (_gpu, device) = spied();
        let headless = Headless::new(device, &config(SIZE)).expect("headless");
        let calls = MAKERS.iter().map(|f| f.calls()).collect();
        drop(headless.finish().expect("finish"));
        assert_eq!(spy::live(), Vec::<String>::new());
        calls
    };
    let mut wrong = Vec::new();
    for (function, calls) in MAKERS.iter().zip(calls) {
        for k in chosen(calls) {
            let (_gpu, device) = spied();
            function.fail(k, NO_MEMORY);
            let name = format!("{} call {k}", function.name.to_string_lossy());
            match Headless::new(device, &config(SIZE)) {
                Err(error) if is_memory_error(&error) => {}
                Err(error) => wrong.push(format!("{name}: {error}")),
                Ok(_) => wrong.push(format!("{name}: no error")),
            }
            let live = spy::live();
            if !live.is_empty() {
                wrong.push(format!("{name}: left {}", live.join(", ")));
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn a_failed_scene_leaves_nothing() {
    let (_gpu, device) = spied();
    let mut headless = Headless::new(device, &config(SIZE)).expect("headless");
    let scene = scene();
    spy::reset();
    // The first scene creates what the context keeps. If it fails, the next one continues from
    // there.
    spy::CREATE_RENDER_PASS.fail(2, NO_MEMORY);
    assert!(headless.scene(&scene, true).is_err());
    headless.scene(&scene, true).expect("scene");
    assert!(spy::CREATE_RENDER_PASS.calls() >= 3, "it sees");
    spy::reset();
    headless.scene(&scene, true).expect("scene");
    let calls: Vec<u32> = MAKERS.iter().map(|f| f.calls()).collect();
    assert!(spy::CREATE_SAMPLER.calls() >= 2, "it sees");
    // A new scene destroys the old one first, so from here on there is none.
    spy::CREATE_SAMPLER.fail(1, NO_MEMORY);
    assert!(headless.scene(&scene, true).is_err());
    let mut wrong = Vec::new();
    for (function, calls) in MAKERS.iter().zip(calls) {
        for k in chosen(calls) {
            // The allocator has free blocks and does not ask for memory.
            if std::ptr::eq(*function, &spy::ALLOCATE_MEMORY) {
                continue;
            }
            spy::reset();
            spy::forget();
            let held = allocations(headless.device());
            function.fail(k, NO_MEMORY);
            let name = format!("{} call {k}", function.name.to_string_lossy());
            match headless.scene(&scene, true) {
                Err(error) if is_memory_error(&error) => {}
                Err(error) => wrong.push(format!("{name}: {error}")),
                Ok(()) => wrong.push(format!("{name}: no error")),
            }
            let live = spy::live();
            if !live.is_empty() {
                wrong.push(format!("{name}: left {}", live.join(", ")));
            }
            if allocations(headless.device()) != held {
                wrong.push(format!("{name}: left memory"));
            }
        }
    }
    spy::reset();
    headless.scene(&scene, true).expect("a scene after all");
    let device = headless.finish().expect("finish");
    wrong.extend(device.take_messages());
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

/// Number of live allocations.
fn allocations(device: &Device) -> usize {
    device.allocator.lock().unwrap().generate_report().allocations.len()
}

#[test]
fn a_failed_frame_of_a_scene_can_be_repeated() {
    let mut wrong = Vec::new();
    for antialias in [true, false] {
        let (_gpu, device) = spied();
        let mut headless = Headless::new(device, &config(SIZE)).expect("headless");
        let shot = Shot::new(
            extent(32, 16),
            Lens::Standard,
            0.2,
            &scenes::block(3, 0.25, [4, 4, 2], [-0.5, -0.5, 3.0]),
        );
        headless.particles(&shot.positions, None).expect("particles");
        headless.scene(&scene(), antialias).expect("scene");
        let draw = |headless: &mut Headless| {
            headless.render(&shot.camera, &shot.settings, &Background::Scene)
        };
        // Another camera, for which the kept image of the scene cannot be used.
        let aside = beside(&shot.camera);
        let draw_aside =
            |headless: &mut Headless| headless.render(&aside, &shot.settings, &Background::Scene);
        draw(&mut headless).expect("a frame");
        let expected = headless.color().expect("read back");
        let live = spy::live();
        for function in [&spy::CREATE_FRAMEBUFFER, &spy::ALLOCATE_SETS] {
            for k in 1..=3 {
                spy::reset();
                function.fail(k, NO_MEMORY);
                let name = format!("{antialias}, {} call {k}", function.name.to_string_lossy());
                match draw_aside(&mut headless) {
                    Err(error) if is_memory_error(&error) => {}
                    Err(error) => wrong.push(format!("{name}: {error}")),
                    Ok(()) => wrong.push(format!("{name}: no error")),
                }
                spy::reset();
                draw(&mut headless).expect("a frame after all");
                if headless.color().expect("read back") != expected {
                    wrong.push(format!("{name}: another picture afterwards"));
                }
                if spy::live() != live {
                    wrong.push(format!("{name}: left {:?}, not {live:?}", spy::live()));
                }
            }
        }
        let device = headless.finish().expect("finish");
        wrong.extend(device.take_messages());
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

/// The same camera a little to the side.
fn beside(camera: &Camera) -> Camera {
    Camera {
        view: (Mat4::from_translation(Vec3::X * 0.3) * camera.view_matrix()).to_cols_array_2d(),
        ..*camera
    }
}

/// While the camera rests the scene is drawn only once; it is drawn again after every change that
/// affects it.
#[test]
fn a_camera_that_rests_keeps_the_scene() {
    let (_gpu, device) = spied();
    let mut headless = Headless::new(device, &config(SIZE)).expect("headless");
    let camera = scenes::camera(Lens::Standard, SIZE);
    let settings = scenes::settings(0.2);
    let world = |points: &[[f32; 3]]| scenes::world(&camera, points);
    headless.scene(&scene(), false).expect("scene");
    let frame = |headless: &mut Headless, camera: &Camera, points: &[[f32; 3]]| {
        headless.particles(points, None).expect("particles");
        spy::reset();
        headless.render(camera, &settings, &Background::Scene).expect("a frame");
        // Framebuffers are created in each frame, so their number tells whether the scene was
        // drawn.
        let made = spy::CREATE_FRAMEBUFFER.calls();
        let depth = headless.scene_depth().expect("read back");
        (made, headless.color().expect("read back"), depth)
    };
    let few = world(&scenes::block(3, 0.25, [4, 4, 2], [-0.5, -0.5, 3.0]));
    let (first, color, depth) = frame(&mut headless, &camera, &few);
    let (second, with_more, _) = frame(&mut headless, &camera, &world(&[[0.0, 0.0, 3.0]]));
    assert!(second < first, "{second} framebuffers, {first}");
    assert_ne!(color, with_more, "other water");
    let (again, same, same_depth) = frame(&mut headless, &camera, &few);
    assert!(again == second && same == color && same_depth == depth);
    // Another view, and back again.
    let (moved, other, _) = frame(&mut headless, &beside(&camera), &few);
    let (back, same, _) = frame(&mut headless, &camera, &few);
    assert!([moved, back] == [first; 2] && other != color && same == color);
    // Another sky, then another scene.
    headless.sky(&Sky::default().with(|it| it.intensity = 5.0)).expect("sky");
    let (anew, hazy, _) = frame(&mut headless, &camera, &few);
    assert!(anew == first && hazy != color);
    let Scene { mut meshes, .. } = scene();
    meshes.truncate(1);
    headless.scene(&Scene { meshes, ..Scene::default() }, false).expect("scene");
    let (anew, _, other_depth) = frame(&mut headless, &camera, &few);
    assert!(anew == first && other_depth != depth);
    let device = headless.finish().expect("finish");
    assert_eq!(spy::live(), Vec::<String>::new());
    assert_eq!(device.take_messages(), Vec::<String>::new());
}

/// Water is flush with the panes of the scene, until another scene replaces it.
#[test]
fn panes_of_the_scene_flatten_the_water() {
    let size = extent(64, 48);
    let mut headless = Headless::new(Gpu::own().take_device(), &config(size)).expect("headless");
    let camera = scenes::camera(Lens::Standard, size);
    let settings = scenes::settings(0.2);
    let points = scenes::world(&camera, &scenes::block(3, 0.25, [14, 10, 3], [-1.8, -1.2, 4.0]));
    headless.particles(&points, None).expect("particles");
    let corners = [[-3.0, 3.0, 4.0], [-3.0, -3.0, 4.0], [3.0, 3.0, 4.0]];
    let corners = scenes::world(&camera, &corners).into_iter().map(Vec3::from);
    let [corner, a, b] = corners.collect::<Vec<_>>().try_into().expect("three");
    let mut edges = [a - corner, b - corner].map(|edge| edge.to_array());
    let eye = camera.view_matrix().inverse().transform_point3(Vec3::ZERO);
    if (a - corner).cross(b - corner).dot(eye - corner) < 0.0 {
        edges.swap(0, 1);
    }
    let panes = vec![Pane { corner: corner.to_array(), edges }];
    let mut drawn = |panes| {
        headless.scene(&Scene { panes, ..scene() }, false).expect("scene");
        headless.render(&camera, &settings, &Background::Scene).expect("a frame");
        headless.color().expect("read back")
    };
    let [bare, flat, again] = [Vec::new(), panes, Vec::new()].map(&mut drawn);
    let moved = flat.data.iter().zip(&bare.data).filter(|(a, b)| a != b).count();
    assert!(moved > 300 && again == bare, "{moved}");
    let bad = vec![Pane { corner: [0.0; 3], edges: [[0.0; 3]; 2] }];
    headless.scene(&Scene { panes: bad, ..scene() }, false).expect("scene");
    let error = headless.render(&camera, &settings, &Background::Scene);
    assert!(matches!(error, Err(Error::BadInput { field: "Frame.panes", .. })), "{error:?}");
    let device = headless.finish().expect("finish");
    assert_eq!(device.take_messages(), Vec::<String>::new());
}

/// A step of the foam state makes foam from velocities, ids and time. New particles have no foam
/// until the next step.
#[test]
fn a_step_makes_foam() {
    let mut gpu = Gpu::own();
    let device = gpu.take_device();
    let size = extent(64, 48);
    let config = config(size).with(|it| it.surface_foam = true);
    let mut headless = Headless::new(device, &config).expect("headless");
    let camera = scenes::camera(Lens::Standard, size);
    let points = scenes::world(&camera, &scenes::cloud(3, 200, 2.0, 6.0));
    let look = scenes::settings(0.2);
    let background = Background::Color([0.2; 3]);
    let foam = WeberSettings::reduced(look.water.spacing, 1.0);
    let fast = vec![[30.0 * look.water.spacing, 0.0, 0.0]; points.len()];
    let ids: Vec<u32> = (0..points.len() as u32).collect();
    let covered = |headless: &mut Headless, stepped: Option<(Option<&[u32]>, Option<f32>)>| {
        headless.particles(&points, None).expect("particles");
        if let Some((ids, dt)) = stepped {
            headless.motion(&fast, ids).expect("motion");
            headless.step(dt, &foam).expect("a step");
        }
        headless.render(&camera, &look, &background).expect("a frame");
        let depth = headless.layer("surface_foam").expect("read").expect("a layer");
        // The layer has a quarter of the resolution along each axis.
        16 * depth.data.iter().filter(|z| **z < 1e9).count()
    };
    assert_eq!(covered(&mut headless, None), 0, "no step");
    assert!(covered(&mut headless, Some((None, None))) > 500, "a frame for itself");
    assert!(covered(&mut headless, Some((Some(&ids), None))) > 500, "ids for the noise alone");
    // With phases, foam begins at the second step and is whole after half a second.
    assert_eq!(covered(&mut headless, Some((Some(&ids), Some(0.1)))), 0, "the first step");
    assert!(covered(&mut headless, Some((Some(&ids), Some(0.1)))) > 0, "the second");
    assert_eq!(covered(&mut headless, None), 0, "other particles");
    assert!(headless.step(None, &foam).is_err(), "no motion");
    assert!(headless.motion(&fast[1..], None).is_err(), "one is missing");
    assert!(headless.motion(&fast, Some(&ids[1..])).is_err(), "an id is missing");
    headless.finish().expect("finish");
}

/// A step that fails for lack of memory leaves the state unchanged, and the next step succeeds.
#[test]
fn a_failed_step_keeps_the_state() {
    let (_gpu, device) = spied();
    let config = config(SIZE).with(|it| it.surface_foam = true);
    let mut headless = Headless::new(device, &config).expect("headless");
    let points = [[0.0, 0.0, -3.0]; 8];
    let ids: Vec<u32> = (0..8).collect();
    let foam = WeberSettings::reduced(0.1, 1.0);
    headless.particles(&points, None).expect("particles");
    let step = |headless: &mut Headless| {
        headless.motion(&[[9.0, 0.0, 0.0]; 8], Some(&ids))?;
        headless.step(Some(0.1), &foam)
    };
    step(&mut headless).expect("a step");
    let held = allocations(headless.device());
    for k in 1..=2 {
        spy::reset();
        spy::CREATE_BUFFER.fail(k, NO_MEMORY);
        assert!(is_memory_error(&step(&mut headless).expect_err("no memory")), "buffer {k}");
    }
    spy::reset();
    step(&mut headless).expect("the next step");
    assert_eq!(allocations(headless.device()), held, "nothing is left behind");
    drop(headless.finish().expect("finish"));
}

/// Pictures with too few or too many values are refused: a copy from fewer would read past their end.
#[test]
fn pictures_that_are_no_whole_pictures_are_refused() {
    let mut gpu = Gpu::own();
    let mut headless = Headless::new(gpu.take_device(), &config(SIZE)).expect("headless");
    let camera = scenes::camera(Lens::Standard, SIZE);
    let settings = scenes::settings(0.2);
    let points = scenes::world(&camera, &[[0.0, 0.0, 3.0]]);
    headless.particles(&points, None).expect("particles");
    let all = (SIZE.width * SIZE.height) as usize;
    let mut drawn = |color: usize, depth: usize| {
        let (color, depth) = (vec![[0.5; 4]; color], vec![0.0; depth]);
        let pictures = Background::Images { color: &color, depth: &depth };
        headless.render(&camera, &settings, &pictures).map_err(|error| error.to_string())
    };
    assert_eq!(drawn(all, all), Ok(()));
    for (color, depth, field) in [(all - 1, all, "color"), (all, all + 1, "depth"), (0, 0, "color")]
    {
        let error = drawn(color, depth).expect_err("not a whole picture");
        assert!(
            error.contains(&format!("Background.{field}")) && error.contains("32x16"),
            "{error}"
        );
    }
    let mut around = |width: u32, texels: usize| {
        let picture = vec![[0.5; 4]; texels];
        let extent = vk::Extent2D { width, height: 4 };
        headless.equirectangular(extent, &picture, 1.0, 0.0).map_err(|error| error.to_string())
    };
    assert_eq!(around(8, 32), Ok(()));
    for (width, texels) in [(8, 31), (8, 33), (0, 0)] {
        let error = around(width, texels).expect_err("not a whole picture");
        assert!(error.contains("Equirectangular.image"), "{error}");
    }
    let device = headless.finish().expect("finish");
    assert_eq!(device.take_messages(), Vec::<String>::new());
}

/// The stand-in scene is drawn on a device of Vulkan 1.2 too, and looks the same.
#[test]
fn a_device_of_vulkan_1_2_draws_the_scene() {
    let camera = scenes::camera(Lens::Standard, SIZE);
    let settings = scenes::settings(0.2);
    let points = scenes::world(&camera, &scenes::block(3, 0.25, [4, 4, 2], [-0.5, -0.5, 3.0]));
    let [new, old] = [false, true].map(|vulkan_1_2| {
        let options = whitewater::headless::DeviceOptions { vulkan_1_2, ..Default::default() };
        let mut gpu = Gpu::own_with(&options);
        let mut headless = Headless::new(gpu.take_device(), &config(SIZE)).expect("headless");
        headless.particles(&points, None).expect("particles");
        headless.scene(&scene(), false).expect("scene");
        headless.render(&camera, &settings, &Background::Scene).expect("a frame");
        let color = headless.color().expect("read back");
        let device = headless.finish().expect("finish");
        assert_eq!(device.take_messages(), Vec::<String>::new());
        color
    });
    assert!(new == old, "another picture");
}

/// What the device cannot hold is refused before an image is made of it.
#[test]
fn images_that_the_device_cannot_hold_are_refused() {
    for (width, height) in [(0, 16), (1 << 20, 16)] {
        let mut gpu = Gpu::own();
        let refused = Headless::new(gpu.take_device(), &config(vk::Extent2D { width, height }));
        assert!(refused.is_err(), "{width}x{height}");
    }
    let mut gpu = Gpu::own();
    let mut headless = Headless::new(gpu.take_device(), &config(SIZE)).expect("headless");
    let error = headless.shore_mask([1 << 20, 1], &vec![1.0; 1 << 20]).expect_err("too wide");
    assert!(error.to_string().contains("at most"), "{error}");
    let device = headless.finish().expect("finish");
    assert_eq!(device.take_messages(), Vec::<String>::new());
}

/// A refused sky or map changes nothing; the sky may be set any number of times without a frame; a list of no blobs is
/// one.
#[test]
fn environments_and_blobs_of_any_number() {
    let mut gpu = Gpu::own();
    let bubbles = whitewater::bubbles::BubbleConfig::new(4).with(|it| {
        it.variants = 1;
        it.bubbles = 8;
        it.map_size = 16;
    });
    let config = config(SIZE).with(|it| it.bubbles = Some(bubbles));
    let mut headless = Headless::new(gpu.take_device(), &config).expect("headless");
    let camera = scenes::camera(Lens::Standard, SIZE);
    let settings = scenes::settings(0.2);
    headless.particles(&scenes::world(&camera, &[[0.0, 0.0, 3.0]]), None).expect("particles");
    headless.bubbles(&[]).expect("no blobs");
    headless.scene(&scene(), false).expect("scene");
    let drawn = |headless: &mut Headless| {
        headless.render(&camera, &settings, &Background::Scene).expect("a frame");
        headless.color().expect("read back")
    };
    for _ in 0..200 {
        headless.sky(&Sky::default()).expect("sky");
    }
    drawn(&mut headless);
    let size = vk::Extent2D { width: 8, height: 4 };
    let (sunny, grey) = (vec![[3.0; 4]; 32], vec![[0.5; 4]; 32]);
    headless.equirectangular_with_sun(size, &sunny, &grey, (1.0, 0.0)).expect("a map");
    let expected = drawn(&mut headless);
    headless.sky(&Sky::default().with(|it| it.intensity = f32::NAN)).expect_err("NaN");
    headless.equirectangular(size, &sunny[1..], 1.0, 0.0).expect_err("one is missing");
    headless.equirectangular_with_sun(size, &grey, &sunny, (f32::NAN, 0.0)).expect_err("NaN");
    assert!(drawn(&mut headless) == expected, "a refused environment shows");
    let device = headless.finish().expect("finish");
    assert_eq!(device.take_messages(), Vec::<String>::new());
}
