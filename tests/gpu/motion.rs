//! Compares the motion vectors of pass `motion` with the CPU twin and with closed forms, and checks
//! their use: a vector leads to the same point in the frame before.

use ash::vk;
use glam::{DMat4, DVec2, DVec3, Mat4, Quat, Vec3};
use whitewater::{Camera, Config, Error, Previous};

use crate::level::smoothed;
use crate::reference::motion::{self, Particle, Settings, Shown, Vector};
use crate::reference::{Image, View, smoothstep};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent, stream};
use crate::support::scenes::{self, LENSES, Lens, Random};

const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;

fn moving(size: vk::Extent2D) -> Config {
    config(size).with(|it| it.motion = true)
}

/// A shot of moving particles.
#[derive(Clone)]
struct Moving {
    shot: Shot,
    /// Velocities in world space, metres per second.
    velocities: Option<Vec<[f32; 3]>>,
    /// Amount and age of surface foam.
    amounts: Option<Vec<[f32; 2]>>,
    /// Ids, which seed the noise in foam.
    ids: Option<Vec<u32>>,
}

impl Moving {
    /// Particles at all speeds up to `fastest` spacings per second along each axis. In the
    /// twentieth of a second since the frame before, the camera moved, turned and changed its lens.
    fn new(size: vk::Extent2D, lens: Lens, points: &[[f32; 3]], fastest: f32) -> Self {
        let mut shot = Shot::new(size, lens, 0.2, points);
        let most = fastest * shot.settings.water.spacing;
        let mut random = Random(5);
        let velocities = points.iter().map(|_| [0; 3].map(|_| random.between(-most, most)));
        let velocities = Some(velocities.collect());
        shot.previous = Some(Previous { camera: elsewhere(&shot.camera), dt: 0.05 });
        Self { shot, velocities, amounts: None, ids: None }
    }

    fn dt(&self) -> f64 {
        self.shot.previous.map_or(0.0, |p| f64::from(p.dt))
    }

    fn draw(&self, rig: &mut Rig<'_>) -> Drawn {
        let data = |bytes: &[u8]| rig.stub.data(bytes, STORAGE);
        let cloud = rig.particles(&self.shot);
        let velocities = self.velocities.as_ref().map(|all| data(bytemuck::cast_slice(all)));
        let amounts = self.amounts.as_ref().map(|all| data(bytemuck::cast_slice(all)));
        let ids = self.ids.as_ref().map(|all| data(bytemuck::cast_slice(all)));
        let particles = cloud.particles().with(|it| {
            it.ids = ids.as_ref().map(|data| stream(data, 0, 4));
            it.velocities = velocities.as_ref().map(|data| stream(data, 0, 12));
            it.surface_foam = amounts.as_ref().map(|data| stream(data, 0, 8));
        });
        rig.draw_particles(&self.shot, &particles)
    }

    /// The particles as the twin takes them.
    fn particles(&self) -> Vec<Particle> {
        let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));
        let shot = &self.shot;
        let rest = f64::from(shot.settings.water.rest_density);
        (0..shot.positions.len())
            .map(|i| Particle {
                position: wide(shot.positions[i]),
                velocity: self.velocities.as_ref().map_or(DVec3::ZERO, |all| wide(all[i])),
                density: shot.densities.as_ref().map(|all| f64::from(all[i]) / rest),
                foam: self.amounts.as_ref().map_or(0.0, |all| f64::from(all[i][0])),
            })
            .collect()
    }

    fn then(&self) -> View {
        let camera = self.shot.previous.map_or(self.shot.camera, |p| p.camera);
        scenes::twin(&camera, self.shot.size)
    }

    fn twin(&self, drawn: &Drawn, level: u32) -> Image<Vector> {
        let shot = &self.shot;
        let water = &shot.settings.water;
        let settings = Settings {
            spacing: f64::from(water.spacing),
            densities: [water.density_threshold, water.density_full].map(f64::from),
            motion_threshold: f64::from(shot.settings.surface_foam.motion_threshold),
            falloff: shot.falloff(),
            dt: self.dt(),
            level,
        };
        let foam = shown_foam(shot, drawn);
        let shown = Shown {
            depth: &drawn.depth,
            foam: foam.as_ref(),
            surface: smoothed(drawn, shot, 256),
            scene: &shot.scene_at(shot.size, 0),
        };
        motion::motion(&self.particles(), &shot.view(shot.size), &self.then(), &settings, &shown)
    }

    /// Checks the vectors against the twin. Returns the number of pixels with water.
    fn check(&self, name: &str, drawn: &Drawn, level: u32) -> usize {
        agree(name, of(drawn), &self.twin(drawn, level));
        drawn.depth.data.iter().filter(|z| **z < 1e9).count()
    }
}

/// The previous camera: beside `camera`, turned, with a wider and shifted lens.
fn elsewhere(camera: &Camera) -> Camera {
    let turn = Quat::from_scaled_axis(Vec3::new(0.02, -0.03, 0.015));
    let moved = Mat4::from_rotation_translation(turn, Vec3::new(0.11, -0.07, 0.2));
    let mut projection = camera.projection_matrix();
    projection.x_axis.x *= 0.97;
    projection.y_axis.y *= 0.98;
    projection.z_axis.x += 0.01;
    projection.z_axis.y -= 0.007;
    Camera::of(moved * camera.view_matrix(), projection)
}

fn of(drawn: &Drawn) -> &Image<[f32; 2]> {
    drawn.motion.as_ref().expect("a frame with motion")
}

/// Depth of the foam where it hides at least half of what is behind it, by the formula of
/// `composite`.
pub(crate) fn shown_foam(shot: &Shot, drawn: &Drawn) -> Option<Image<f32>> {
    let seen = drawn.foam.as_ref()?.seen(shot);
    let look = &shot.settings.surface_foam;
    Some(seen.map(|(depth, [t, _])| {
        let whole = smoothstep(0.0, f64::from(look.min_thickness).max(1e-6), *t);
        let kept = (-f64::from(look.extinction) * t * whole).exp();
        if kept <= 0.5 { *depth as f32 } else { 1e10 }
    }))
}

/// Checks that each vector differs from the twin's by at most its bound. Pixels where rounding
/// decides have an infinite bound, those with little weight a large one; those with a bound above
/// half a pixel must be few.
fn agree(name: &str, found: &Image<[f32; 2]>, twin: &Image<Vector>) {
    assert_eq!((found.width, found.height), (twin.width, twin.height), "{name}");
    let (mut failed, mut unsure, width) = (Vec::new(), 0, found.width);
    for (i, (found, twin)) in found.data.iter().zip(&twin.data).enumerate() {
        let error = (DVec2::from(found.map(f64::from)) - twin.v).abs();
        unsure += usize::from(twin.e.max_element() > 0.5);
        // Written so that NaN fails.
        if !(error.x <= twin.e.x && error.y <= twin.e.y) {
            failed.push((i, *found, *twin));
        }
    }
    if let Some((i, found, twin)) = failed.first() {
        let (x, y) = (i % width, i / width);
        panic!("{name}: {}, first at ({x}, {y}): {found:?}, expected {twin:?}", failed.len());
    }
    assert!(unsure * 200 < found.data.len().max(400), "{name}: {unsure} pixels unsure");
}

fn same(name: &str, a: &Drawn, b: &Drawn) {
    let part = |drawn: &Drawn, i: usize| of(drawn).map(|v| v[i]);
    for i in 0..2 {
        compare::same(&format!("{name}-{i}"), &part(a, i), &part(b, i));
    }
}

#[test]
fn vectors_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for foam in [false, true] {
        let mut rig = Rig::new(&gpu, &moving(size).with(|it| it.surface_foam = foam));
        for lens in LENSES {
            for (kind, points) in [
                ("cloud", scenes::cloud(31, 160, 2.0, 9.0)),
                ("near", scenes::cloud(7, 60, 0.15, 1.5)),
                ("far", scenes::cloud(7, 400, 30.0, 60.0)),
                ("block", scenes::block(3, 0.3, [12, 8, 4], [-1.6, -1.0, 4.0])),
            ] {
                let mut case = Moving::new(size, lens, &points, 30.0);
                let mut random = Random(8);
                let densities = points.iter().map(|_| random.between(250.0, 1000.0));
                case.shot.densities = Some(densities.collect());
                let part = |i: usize| [(i % 5) as f32 / 4.0, 0.0];
                case.amounts = foam.then(|| (0..points.len()).map(part).collect());
                case.shot.scene_depth(|x, y| ((x / 9 + y / 5) % 2 == 0).then_some(6.0));
                let name = format!("motion-{lens:?}-{foam}-{kind}");
                let drawn = case.draw(&mut rig);
                let covered = case.check(&name, &drawn, 2);
                assert!(covered > 250 || kind == "far", "{name}: {covered} pixels");
            }
        }
    }
}

/// Every resolution, and several chunks of particles.
#[test]
fn vectors_of_every_resolution_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (thickness_level, smoothing_level, coarsening, max_stride) in
        [(0, 0, 3, 16), (1, 1, 0, 16), (2, 2, 3, 1 << 20), (3, 1, 3, 16), (0, 2, 3, 1 << 20)]
    {
        let levels = moving(size).with(|it| {
            it.thickness_level = thickness_level;
            it.smoothing_level = smoothing_level;
            it.coarsening = coarsening;
        });
        let mut rig = Rig::new(&gpu, &levels.with(|it| it.max_stride = max_stride));
        for (radius, points) in [
            (0.2, scenes::cloud(31, 160, 2.0, 9.0)),
            (0.05, scenes::block(3, 0.08, [30, 20, 4], [-1.6, -1.0, 3.0])),
        ] {
            let mut case = Moving::new(size, Lens::OffAxis, &points, 30.0);
            case.shot.settings = scenes::settings(radius);
            let name = format!("motion-{thickness_level}-{smoothing_level}-{radius}");
            let drawn = case.draw(&mut rig);
            case.check(&name, &drawn, thickness_level);
        }
    }
}

/// Particles with invalid positions and velocities, and faster than a thousand spacings per frame,
/// to which motion is limited.
#[test]
fn strange_particles_move_as_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &moving(size));
    let points = scenes::cloud(31, 160, 2.0, 9.0);
    let mut case = Moving::new(size, Lens::Reversed, &points, 10.0);
    // Towards the right, down and towards the eye, so the particle was farther away before.
    let fast = |row: usize| case.shot.camera.view_matrix().row(row).truncate() * 1e9;
    let fast = (fast(0) - fast(1) + fast(2)).to_array();
    let velocities = case.velocities.as_mut().expect("velocities");
    for (i, v) in velocities.iter_mut().enumerate() {
        match i % 8 {
            0 => *v = [f32::NAN, 0.0, 0.0],
            1 => *v = [0.0, f32::INFINITY, 0.0],
            2 => *v = [0.0, 0.0, -3e18],
            3 => *v = fast,
            _ => {}
        }
    }
    case.shot.positions[4] = [f32::NAN; 3];
    let drawn = case.draw(&mut rig);
    assert!(of(&drawn).data.iter().flatten().all(|v| v.is_finite()));
    case.velocities.iter_mut().flatten().for_each(|v| {
        // The pass drops these particles, so the twin gets invalid ones.
        if v.iter().any(|c| c.abs() >= 1e18) {
            *v = [f32::NAN; 3];
        }
    });
    case.check("motion-strange", &drawn, 2);
}

/// Without motion, however the frame says so, all vectors of water, foam, scene and sky are exactly
/// 0.
#[test]
fn what_is_still_has_no_motion() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for lens in LENSES {
        let mut rig = Rig::new(&gpu, &moving(size).with(|it| it.surface_foam = true));
        let points = scenes::block(3, 0.3, [12, 8, 4], [-1.6, -1.0, 4.0]);
        let mut case = Moving::new(size, lens, &points, 30.0);
        case.amounts = Some((0..points.len()).map(|i| [(i % 3) as f32 / 2.0, 0.0]).collect());
        case.shot.scene_depth(|x, _| (x < 40).then_some(6.0));
        assert!(of(&case.draw(&mut rig)).data.iter().any(|v| v[0] != 0.0));
        let still = Previous { camera: case.shot.camera, dt: 0.05 };
        let at_rest = Some(vec![[0.0; 3]; points.len()]);
        for (name, previous, velocities) in [
            ("no frame before", None, case.velocities.clone()),
            ("no time", Some(Previous { dt: 0.0, ..still }), case.velocities.clone()),
            ("at rest", Some(still), at_rest),
            ("no velocities", Some(still), None),
        ] {
            case.shot.previous = previous;
            let of_name = Moving { velocities, ..case.clone() };
            let drawn = of_name.draw(&mut rig);
            assert!(of(&drawn).data.iter().flatten().all(|v| *v == 0.0), "{lens:?}, {name}");
        }
    }
}

/// A rigid body moves with one velocity under a camera at rest. Every pixel of it, up to its
/// outline, has the perspective motion of its own point; all other pixels have none.
#[test]
fn a_rigid_body_moves_as_its_points() {
    let gpu = Gpu::shared();
    let size = extent(193, 121);
    let mut rig = Rig::new(&gpu, &moving(size));
    for lens in LENSES {
        let points = scenes::block(3, 0.3, [12, 8, 4], [-1.6, -1.0, 4.0]);
        let mut case = Moving::new(size, lens, &points, 0.0);
        let velocity = [3.0, -1.5, 4.0];
        case.velocities = Some(vec![velocity; points.len()]);
        case.shot.previous = Some(Previous { camera: case.shot.camera, dt: 0.1 });
        let drawn = case.draw(&mut rig);
        let view = case.shot.view(size);
        let moved = view.view.transform_vector3(DVec3::from(velocity.map(f64::from))) * 0.1;
        // The depth is that of the smoothed surface, which the falloff keeps close to the frontmost
        // sphere.
        let slack = f64::from(case.shot.falloff());
        let (mut covered, mut longest) = (0, 0.0_f64);
        for (i, found) in of(&drawn).data.iter().enumerate() {
            let (x, y) = (i % 193, i / 193);
            let found = DVec2::from(found.map(f64::from));
            let z = f64::from(drawn.depth.data[i]);
            if z >= 1e9 {
                assert_eq!(found, DVec2::ZERO, "{lens:?}: still at ({x}, {y})");
                continue;
            }
            covered += 1;
            longest = longest.max(found.length());
            let at = |z: f64| {
                let here = view.ray(x, y) * z;
                view.project(here) - view.project(here - moved)
            };
            // The vector belongs to some depth of the surface, so the test takes the min error over
            // these depths.
            let near = (0..=200).map(|n| at(z + slack * (f64::from(n) / 100.0 - 1.0)));
            let off = near.map(|v| (v - found).length()).fold(f64::INFINITY, f64::min);
            let between = (at(z + 0.01 * slack) - at(z)).length();
            assert!(off <= between + 1e-3, "{lens:?}: {off} off at ({x}, {y})");
        }
        assert!(covered > 3000 && longest > 5.0, "{lens:?}: {covered} pixels, {longest}");
    }
}

/// The camera moves and everything else rests: motion follows from the depth, and for the sky from
/// the rotation alone.
#[test]
fn what_rests_moves_by_the_camera() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &moving(size));
    for lens in LENSES {
        let points = scenes::block(3, 0.3, [12, 8, 4], [-1.6, -1.0, 4.0]);
        let mut case = Moving::new(size, lens, &points, 0.0);
        case.velocities = None;
        case.shot.scene_depth(|x, y| (y > 30).then_some(2.0 + f64::from(x) / 9.0));
        let drawn = case.draw(&mut rig);
        case.check(&format!("motion-camera-{lens:?}"), &drawn, 2);
        let (view, then) = (case.shot.view(size), case.then());
        let scene = case.shot.scene_at(size, 0);
        let turn = then.view * view.view.inverse();
        let (mut skies, mut walls) = (0, 0);
        for (i, found) in of(&drawn).data.iter().enumerate() {
            let (x, y) = (i % 97, i / 97);
            let found = DVec2::from(found.map(f64::from));
            if drawn.depth.data[i] < 1e9 {
                continue;
            }
            let now = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let expected = if y > 30 {
                walls += 1;
                now - then.project(turn.transform_point3(view.ray(x, y) * scene.at(x, y)))
            } else {
                skies += 1;
                now - then.project(turn.transform_vector3(view.ray(x, y)))
            };
            assert!((found - expected).length() < 1e-3, "{lens:?}: {found} not {expected}");
        }
        assert!(skies > 1000 && walls > 500, "{lens:?}: {skies}, {walls}");
    }
}

/// A drop flies before a pool that flows in the opposite direction. On both sides of the outline
/// each pixel has the motion of the visible body.
#[test]
fn outlines_keep_both_sides() {
    let gpu = Gpu::shared();
    let size = extent(193, 121);
    for (thickness_level, foam) in [(0, false), (2, false), (3, false), (2, true)] {
        let mut rig = Rig::new(
            &gpu,
            &moving(size).with(|it| {
                it.thickness_level = thickness_level;
                it.surface_foam = foam;
            }),
        );
        let pool = scenes::block(3, 0.3, [30, 20, 3], [-4.5, -3.0, 8.0]);
        let drop = scenes::block(4, 0.3, [3, 3, 3], [-0.3, -0.3, 4.0]);
        let points = [drop.clone(), pool].concat();
        let mut case = Moving::new(size, Lens::Standard, &points, 0.0);
        // World-space velocities across the view.
        let right = case.shot.camera.view_matrix().row(0).truncate();
        let of_drop = (right * 6.0).to_array();
        let of_pool = (right * -4.0).to_array();
        let velocity = |i: usize| if i < drop.len() { of_drop } else { of_pool };
        case.velocities = Some((0..points.len()).map(velocity).collect());
        // With foam, the drop is foam.
        let amount = |i: usize| [if i < drop.len() { 1.0 } else { 0.0 }, 0.0];
        case.amounts = foam.then(|| (0..points.len()).map(amount).collect());
        case.shot.previous = Some(Previous { camera: case.shot.camera, dt: 0.05 });
        let drawn = case.draw(&mut rig);
        let shown = shown_foam(&case.shot, &drawn);
        let front = |i: usize| {
            let foam = shown.as_ref().map_or(1e10, |foam| foam.data[i]);
            drawn.depth.data[i].min(foam)
        };
        let (mut drops, mut pools, mut wrong) = (0, 0, 0);
        for (i, found) in of(&drawn).data.iter().enumerate() {
            let z = front(i);
            if z >= 1e9 {
                continue;
            }
            let is_drop = z < 6.0;
            drops += usize::from(is_drop);
            pools += usize::from(!is_drop);
            let speed = if is_drop { 6.0 } else { -4.0 };
            // The view is 60 degrees high over 121 pixels.
            let expected = speed * 0.05 * 60.5 / 30.0_f32.to_radians().tan() / z;
            let off = (found[0] - expected).abs().max(found[1].abs());
            // In gaps between spheres the smoothed surface may be nearer, by at most the falloff.
            let slack = case.shot.falloff();
            wrong += usize::from(off > slack / (z - slack) * expected.abs());
        }
        let name = format!("level {thickness_level}, foam {foam}");
        assert!(drops > 300 && pools > 3000, "{name}: {drops}, {pools}");
        assert!(wrong == 0, "{name}: {wrong} of {drops} and {pools} pixels");
    }
}

/// The order of the particles and the number of chunks do not change a bit.
#[test]
fn the_order_of_particles_does_not_show() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for foam in [false, true] {
        let make = |max_stride| {
            moving(size).with(|it| {
                it.surface_foam = foam;
                it.max_stride = max_stride;
            })
        };
        let mut rig = Rig::new(&gpu, &make(16));
        let points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 2.0]);
        let mut case = Moving::new(size, Lens::Infinite, &points, 30.0);
        case.amounts =
            foam.then(|| (0..points.len()).map(|i| [(i % 4) as f32 / 3.0, 0.0]).collect());
        case.ids = Some((0..points.len() as u32).collect());
        let first = case.draw(&mut rig);
        let order = Random(9).order(points.len());
        let mut mixed = case.clone();
        mixed.shot.positions = order.iter().map(|i| case.shot.positions[*i]).collect();
        mixed.ids = Some(order.iter().map(|i| *i as u32).collect());
        let pick = |all: &Vec<[f32; 3]>| order.iter().map(|i| all[*i]).collect();
        mixed.velocities = case.velocities.as_ref().map(pick);
        mixed.amounts = case.amounts.as_ref().map(|all| order.iter().map(|i| all[*i]).collect());
        same("motion-order", &mixed.draw(&mut rig), &first);
        let mut chunked = Rig::new(&gpu, &make(1 << 20));
        same("motion-chunks", &mixed.draw(&mut chunked), &first);
    }
}

/// A part of larger images, a frame smaller than the renderer's extent, and a resized renderer give
/// the same bits.
#[test]
fn motion_of_any_size() {
    let gpu = Gpu::shared();
    let points = scenes::cloud(31, 160, 2.0, 9.0);
    let mut large = Rig::new(&gpu, &moving(extent(140, 70)));
    Moving::new(extent(140, 70), Lens::Standard, &points, 30.0).draw(&mut large);
    let mut resized = Rig::new(&gpu, &moving(extent(50, 90)));
    for (width, height) in [(1, 1), (1, 7), (3, 5), (17, 33), (130, 9)] {
        let size = extent(width, height);
        let name = format!("motion-{width}x{height}");
        let mut case = Moving::new(size, Lens::Reversed, &points, 30.0);
        let expected = case.draw(&mut Rig::new(&gpu, &moving(size)));
        case.check(&name, &expected, 2);
        same(&name, &case.draw(&mut large), &expected);
        resized.resize(size);
        same(&name, &case.draw(&mut resized), &expected);
        case.shot.margin = [3, 1, 2, 4];
        same(&name, &case.draw(&mut large), &expected);
        // Without particles only the scene's vectors remain.
        case.shot.positions.clear();
        case.velocities = Some(Vec::new());
        let drawn = case.draw(&mut large);
        assert_eq!(case.check(&format!("{name}-none"), &drawn, 2), 0);
    }
}

/// Without `motion` there is no layer and no memory for it; with it, the host gets the vectors even
/// if other layers are not kept.
#[test]
fn motion_is_a_layer_of_its_own() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let points = scenes::cloud(31, 160, 2.0, 9.0);
    let mut case = Moving::new(size, Lens::Standard, &points, 30.0);
    let mut rig = Rig::new(&gpu, &moving(size).with(|it| it.keep_layers = false));
    let with = rig.renderer().memory();
    let drawn = case.draw(&mut rig);
    assert_eq!(drawn.depth.data.len(), 0, "no other layer");
    let kept = case.draw(&mut Rig::new(&gpu, &moving(size)));
    same("motion-alone", &drawn, &kept);

    let mut rig = Rig::new(&gpu, &config(size));
    let without = rig.renderer().memory();
    assert!(without.images < with.images && without.buffers < with.buffers);
    case.shot.previous = None;
    assert!(case.draw(&mut rig).motion.is_none());
    // The picture is the same with and without `motion`.
    let drawn = case.draw(&mut rig);
    compare::same_color("motion-off", &drawn.output, &kept.output);
}

/// Points that were behind the previous eye, a cut to the opposite direction, and views without a
/// common point: all vectors are finite.
#[test]
fn cuts_have_finite_vectors() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &moving(size));
    let points = scenes::block(3, 0.3, [12, 8, 4], [-1.6, -1.0, 4.0]);
    for lens in [Lens::Standard, Lens::ReversedInfinite, Lens::LeftHanded] {
        for (angle, forward) in [(3.1, 0.0), (1.57, 0.0), (0.0, 5.0), (0.0, -1e6), (2.0, 4.0)] {
            let mut case = Moving::new(size, lens, &points, 30.0);
            case.shot.scene_depth(|x, _| (x < 40).then_some(6.0));
            let moved = Mat4::from_translation(Vec3::new(0.0, 0.0, forward));
            let view = moved * Mat4::from_rotation_y(angle) * case.shot.camera.view_matrix();
            let camera = Camera { view: view.to_cols_array_2d(), ..case.shot.camera };
            case.shot.previous = Some(Previous { camera, dt: 0.05 });
            let drawn = case.draw(&mut rig);
            assert!(of(&drawn).data.iter().flatten().all(|v| v.is_finite()), "{lens:?} {angle}");
        }
    }
}

/// Looking up the frame before by the vectors gives this frame: a block flies past and the camera
/// moves too. Compared are its colour, and its depth in the previous camera.
#[test]
fn vectors_find_the_frame_before() {
    let gpu = Gpu::shared();
    let size = extent(320, 200);
    let mut rig = Rig::lit(&gpu, &moving(size), 1);
    let points = scenes::block(3, 0.2, [16, 10, 4], [-1.6, -1.0, 4.0]);
    let mut case = Moving::new(size, Lens::Standard, &points, 0.0);
    let dt = 0.1_f32;
    let velocity = Vec3::new(1.5, -0.6, 1.0);
    let turn = Mat4::from_rotation_y(0.03) * Mat4::from_translation(Vec3::new(0.05, 0.02, 0.1));
    let before = Camera {
        view: (turn * case.shot.camera.view_matrix()).to_cols_array_2d(),
        ..case.shot.camera
    };
    let mut first = case.clone();
    first.shot.camera = before;
    first.shot.previous = None;
    let drawn_before = first.draw(&mut rig);
    for p in &mut case.shot.positions {
        *p = (Vec3::from(*p) + velocity * dt).to_array();
    }
    case.velocities = Some(vec![velocity.to_array(); points.len()]);
    case.shot.previous = Some(Previous { camera: before, dt });
    let drawn = case.draw(&mut rig);

    let (view, then) = (case.shot.view(size), first.shot.view(size));
    let to_then: DMat4 = then.view * view.view.inverse();
    let moved = view.view.transform_vector3(velocity.as_dvec3()) * f64::from(dt);
    let mut errors = [[0.0_f64; 2]; 2];
    let mut count = 0.0_f64;
    for (i, vector) in of(&drawn).data.iter().enumerate() {
        let (x, y) = (i % 320, i / 320);
        let z = f64::from(drawn.depth.data[i]);
        if z >= 1e9 {
            continue;
        }
        let now = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        // The point's depth in the frame before.
        let depth = -to_then.transform_point3(view.ray(x, y) * z - moved).z;
        let places = [now - DVec2::from(vector.map(f64::from)), now];
        let looked = places.map(|place| {
            let four = drawn_before.depth.bilinear(place);
            let all = |of: &dyn Fn(isize, isize) -> f64| {
                four.iter().map(|(x, y, w)| w * of(*x, *y)).sum::<f64>()
            };
            let covered = four.iter().all(|(x, y, _)| drawn_before.depth.clamped(*x, *y) < 1e9);
            covered.then(|| {
                let depth = all(&|x, y| f64::from(drawn_before.depth.clamped(x, y)));
                let color = all(&|x, y| f64::from(drawn_before.output.clamped(x, y)[1]));
                (depth, color)
            })
        });
        let [Some(by_vector), Some(by_place)] = looked else { continue };
        count += 1.0;
        let color = f64::from(drawn.output.data[i][1]);
        for (error, (d, c)) in errors.iter_mut().zip([by_vector, by_place]) {
            error[0] += (d - depth).abs();
            error[1] += (c - color).abs();
        }
    }
    let [by_vector, by_place] = errors.map(|e| e.map(|sum| sum / count));
    let better = [by_place[0] / by_vector[0], by_place[1] / by_vector[1]];
    eprintln!("{count} pixels; depth {by_place:?} to {by_vector:?}: {better:?} times better");
    assert!(count > 5000.0, "{count} pixels");
    assert!(better[0] > 8.0 && better[1] > 2.0, "{better:?}");
}

/// A good frame with motion, in which one input is made invalid.
#[test]
fn bad_frames_before_are_errors() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    let points = scenes::cloud(31, 10, 2.0, 9.0);
    let good = Moving::new(size, Lens::Standard, &points, 1.0).shot;
    let camera = good.previous.expect("one").camera;
    let with = |previous: Previous| Shot { previous: Some(previous), ..good.clone() };
    let view = |view: Mat4| {
        with(Previous { camera: Camera { view: view.to_cols_array_2d(), ..camera }, dt: 0.1 })
    };
    let lens = |projection: Mat4| {
        with(Previous {
            camera: Camera { projection: projection.to_cols_array_2d(), ..camera },
            dt: 0.1,
        })
    };
    let flat = Mat4::orthographic_rh(-1.0, 1.0, -1.0, 1.0, 0.1, 10.0);
    let cases = [
        (true, with(Previous { camera, dt: -0.1 }), "Frame.previous.dt"),
        (true, with(Previous { camera, dt: f32::NAN }), "Frame.previous.dt"),
        (true, with(Previous { camera, dt: f32::INFINITY }), "Frame.previous.dt"),
        (true, view(Mat4::ZERO), "Frame.previous.camera.view"),
        (true, view(Mat4::NAN), "Frame.previous.camera.view"),
        (true, lens(Mat4::ZERO), "Frame.previous.camera.projection"),
        (true, lens(flat), "Frame.previous.camera.projection"),
        (false, good.clone(), "Frame.previous"),
    ];
    for (on, shot, wanted) in cases {
        let mut rig = Rig::new(&gpu, &config(size).with(|it| it.motion = on));
        let (color, depth) = rig.scene(&shot);
        let cloud = rig.particles(&shot);
        let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
        let cmd = rig.stub.begin(0);
        // SAFETY: cmd is recording, and all handles live until the end of this function.
        let result = unsafe { rig.renderer().record(cmd, &frame) };
        rig.stub.throw_away(0);
        match result {
            Err(Error::BadInput { field, .. }) => assert_eq!(field, wanted),
            other => panic!("{wanted}: {other:?}"),
        }
    }
}
