//! Up directions other than +y: a scene that is rotated together with all of its directions gives
//! the same picture.

use glam::{Mat4, Quat, Vec3};
use whitewater::WhitewaterConfig;
use whitewater::bubbles::BubbleConfig;
use whitewater::headless::{Bubble, Whitewater};
use whitewater::shore::ShoreConfig;
use whitewater::{Config, EnvironmentSource, Error, LightVolume, Settings, Shore, Sky, Slot};

use crate::reference::Image;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent, stream};
use crate::support::scenes::{self, Lens, Random};

/// A scene and everything that is drawn in it.
#[derive(Clone)]
struct World {
    shot: Shot,
    sky: Sky,
    velocities: Vec<[f32; 3]>,
    foam: Vec<[f32; 2]>,
    whitewater: Vec<[f32; 3]>,
}

impl World {
    /// Water with foam and spray, whitewater particles and blobs in front of it, a shore and a low
    /// sun.
    fn new() -> Self {
        let size = extent(96, 64);
        let mut points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.2, 4.0]);
        points.extend(scenes::cloud(4, 40, 0.2, 12.0));
        let mut shot = Shot::new(size, Lens::Standard, 0.2, &points);
        let mut random = Random(21);
        let count = shot.positions.len();
        shot.densities = Some((0..count).map(|_| random.between(300.0, 1000.0)).collect());
        let velocities: Vec<_> =
            (0..count).map(|_| [0; 3].map(|_| random.between(-2.0, 2.0))).collect();
        let foam: Vec<_> =
            (0..count).map(|_| [(2.0 * random.between(0.0, 1.0) - 1.0).max(0.0), 0.5]).collect();
        let around: Vec<_> = (0..60).map(|_| [0; 3].map(|_| random.between(-0.5, 0.5))).collect();
        let front: Vec<_> =
            around.iter().map(|[x, y, z]| [2.0 * x - 0.5, 1.4 * y, 3.6 + z]).collect();
        let whitewater = scenes::world(&shot.camera, &front);
        let balls = scenes::world(&shot.camera, &[[0.8, 0.6, 4.0], [1.2, 0.2, 4.4]]);
        shot.blobs = (1..)
            .zip(balls)
            .map(|(id, [x, y, z])| Bubble {
                ball: [x, y, z, 0.45],
                turn: Quat::from_rotation_z(0.7 * id as f32).to_array(),
                id,
            })
            .collect();
        // Ground that rises out of the water, and the water's level.
        shot.scene_depth(|x, y| Some(5.0 + 0.05 * f64::from(x) - 0.02 * f64::from(y)));
        shot.shore = Some(Shore::new(0.6));
        let settings = &mut shot.settings;
        settings.light.direction = Vec3::new(0.5, 0.4, 0.6).normalize().to_array();
        // Patterns and noise depend on world positions and do not rotate with the scene, so they
        // are off.
        (
            settings.surface_foam.pattern,
            settings.surface_foam.noise,
            settings.surface_foam.normal_strength,
        ) = (0.0, 0.0, 0.0);
        (settings.spray.droplets, settings.spray.scatter_radius) = (1, 0.0);
        settings.shore.contact.particle_opacity = 1.0;
        let [x, y, z] = shot.positions[0];
        shot.light_volume = Some(LightVolume { center: [x, y, z], radius: 4.0 });
        let sky = Sky::default().with(|it| it.sun = shot.settings.light.direction);
        Self { shot, sky, velocities, foam, whitewater }
    }

    /// The scene rotated from y up to z up: exact, except for the order of sums.
    fn z_up(&self) -> Self {
        let turned = |[x, y, z]: [f32; 3]| [x, -z, y];
        let all = |list: &[[f32; 3]]| list.iter().map(|p| turned(*p)).collect::<Vec<_>>();
        let mut other = self.clone();
        let shot = &mut other.shot;
        let back =
            Mat4::from_mat3(glam::Mat3::from_cols(Vec3::X, Vec3::Z, Vec3::NEG_Y)).transpose();
        shot.camera.view = (shot.camera.view_matrix() * back).to_cols_array_2d();
        shot.positions = all(&shot.positions);
        let quarter = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
        for blob in &mut shot.blobs {
            let [x, y, z, radius] = blob.ball;
            let [x, y, z] = turned([x, y, z]);
            blob.ball = [x, y, z, radius];
            blob.turn = (quarter * Quat::from_array(blob.turn)).to_array();
        }
        if let Some(region) = &mut shot.light_volume {
            region.center = turned(region.center);
        }
        let settings = &mut shot.settings;
        settings.light.direction = turned(settings.light.direction);
        // The up vector may have any length.
        settings.up = [0.0, 0.0, 2.5];
        other.sky = self.sky.with(|it| {
            it.sun = turned(self.sky.sun);
            it.up = [0.0, 0.0, 0.5];
        });
        other.velocities = all(&self.velocities);
        other.whitewater = all(&self.whitewater);
        other
    }

    fn draw(&self, gpu: &Gpu, config: &Config) -> Image<[f32; 4]> {
        let mut rig = Rig::new(gpu, config);
        rig.any_environment(&EnvironmentSource::Sky(self.sky));
        let usage = ash::vk::BufferUsageFlags::STORAGE_BUFFER;
        let cloud = rig.particles(&self.shot);
        let velocities = rig.stub.data(bytemuck::cast_slice(&self.velocities), usage);
        let foam = rig.stub.data(bytemuck::cast_slice(&self.foam), usage);
        let particles = cloud.particles().with(|it| {
            it.velocities = Some(stream(&velocities, 0, 12));
            it.surface_foam = config.surface_foam.then(|| stream(&foam, 0, 8));
        });
        let whitewater =
            rig.whitewater(&Whitewater { positions: &self.whitewater, ..Whitewater::default() });
        let some = config.whitewater.is_some().then(|| whitewater.particles());
        let mut shot = self.shot.clone();
        shot.shore = shot.shore.filter(|_| config.shore.is_some());
        shot.light_volume = shot.light_volume.filter(|_| config.light_map_size.is_some());
        rig.draw_whitewater(&shot, &particles, some).output
    }
}

/// Percentage of pixels that differ by more than a thousandth of the brightest value.
fn apart(a: &Image<[f32; 4]>, b: &Image<[f32; 4]>) -> f64 {
    let most = a.data.iter().flat_map(|c| c[..3].to_vec()).fold(0.0, f32::max);
    // Written so that NaN counts as different.
    let near = |a: f32, b: f32| (a - b).abs() <= 1.0e-3 * most;
    let differs = |(a, b): &(&[f32; 4], &[f32; 4])| (0..3).any(|i| !near(a[i], b[i]));
    100.0 * a.data.iter().zip(&b.data).filter(differs).count() as f64 / a.data.len() as f64
}

#[test]
fn a_turned_world_looks_the_same() {
    let gpu = Gpu::shared();
    let base = config(extent(96, 64));
    let whitewater = Some(WhitewaterConfig::new(64));
    let bubbles = Some(BubbleConfig::new(8).with(|it| {
        it.variants = 1;
        it.bubbles = 12;
    }));
    let (world, z_up) = (World::new(), World::new().z_up());
    let mut unsaid = z_up.clone();
    unsaid.shot.settings.up = Settings::default().up;
    unsaid.sky.up = Sky::default().up;
    let mut wrong = Vec::new();
    for (name, config) in [
        ("water", base),
        ("foam", base.with(|it| it.surface_foam = true)),
        ("spray", base.with(|it| it.spray = true)),
        ("whitewater", base.with(|it| it.whitewater = whitewater)),
        ("bubbles", base.with(|it| it.bubbles = bubbles)),
        ("shore", base.with(|it| it.shore = Some(ShoreConfig::default()))),
        ("cast", base.with(|it| it.light_map_size = Some(64))),
    ] {
        let expected = world.draw(&gpu, &config);
        let (same, other) = (z_up.draw(&gpu, &config), unsaid.draw(&gpu, &config));
        let (same, other) = (apart(&same, &expected), apart(&other, &expected));
        // Rounding may move an outline to another pixel.
        if same >= 0.5 || other <= 5.0 {
            wrong.push(format!("{name}: {same:.2} % are apart, {other:.1} % where up is not said"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn up_is_a_direction() {
    let gpu = Gpu::shared();
    let mut rig = Rig::new(&gpu, &config(extent(16, 16)));
    for up in [[0.0; 3], [f32::NAN, 1.0, 0.0], [0.0, f32::INFINITY, 0.0]] {
        let mut shot = Shot::new(extent(16, 16), Lens::Standard, 0.1, &[]);
        shot.settings.up = up;
        let error = rig.refused(&shot, None);
        assert!(error.starts_with("Settings.up: "), "{error}");
        let sky = EnvironmentSource::Sky(Sky::default().with(|it| it.up = up));
        let cmd = rig.stub.begin(0);
        // SAFETY: cmd is recording, and a refused call records nothing.
        let result = unsafe { rig.renderer().record_environment(cmd, Slot(0), &sky) };
        rig.stub.throw_away(0);
        assert!(matches!(result, Err(Error::BadInput { field: "Sky.up", .. })), "{result:?}");
    }
}
