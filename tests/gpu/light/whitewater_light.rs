//! Compares the light map of whitewater particles with its CPU twin, and checks the sunlight that
//! they block on the scene, on water and on each other.

use ash::vk;
use glam::Vec3;
use whitewater::headless::Whitewater;
use whitewater::{Config, Count, LightVolume, Packets, Stream, WhitewaterParticles};
use whitewater::{Occlusion, Submerged, WhitewaterConfig};

use crate::reference::Image;
use crate::reference::whitewater::{Kind, Particle, Settings, intensity};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::HOST_WRITE;
use crate::support::limits::{Claims, claim};
use crate::support::rig::{Drawn, Rig, Shot, attenuation, config, extent, stream, twins};
use crate::support::scenes::{self, Lens, Random};
use crate::support::slow;
use crate::support::spy;
use crate::surface_foam::Foamy;
use crate::whitewater::packets::boxes;
use crate::whitewater::ways::lists;

use super::lit::{check_lit, grounded, seen};
use super::{SIZE, casting, everything, maps, toward, twin, water, wide};

/// `config` with room for `most` whitewater particles.
fn whitewater_config(config: Config, most: u32) -> Config {
    let whitewater = WhitewaterConfig::new(most).with(|it| it.occlusion = Occlusion::Reference);
    config.with(|it| it.whitewater = Some(whitewater))
}

/// A shot with whitewater particles.
#[derive(Clone)]
struct Cloud {
    case: Foamy,
    positions: Vec<[f32; 3]>,
    kinds: Vec<u32>,
    radii: Vec<f32>,
    ages: Vec<f32>,
    ids: Vec<u32>,
}

impl Cloud {
    /// New foam particles of one radius.
    fn of(case: Foamy, positions: Vec<[f32; 3]>, radius: f32) -> Self {
        let n = positions.len();
        let (kinds, ages, ids) = (vec![0; n], vec![0.0; n], vec![0; n]);
        Self { case, positions, kinds, radii: vec![radius; n], ages, ids }
    }

    /// Particles of all kinds and ages, with radii from a hundredth of `size` to three times
    /// `size`.
    fn mixed(case: Foamy, positions: Vec<[f32; 3]>, size: f32) -> Self {
        let mut random = Random(3);
        let mut cloud = Self::of(case, positions, size);
        for i in 0..cloud.positions.len() {
            cloud.kinds[i] = i as u32 % 4;
            cloud.ages[i] = [random.between(-0.1, 0.95), random.between(0.9, 0.95), 1.0][i % 7 % 3];
            cloud.ids[i] = random.bits() as u32;
            let ends = if i % 3 == 0 { (0.01, 0.3) } else { (0.3, 3.0) };
            cloud.radii[i] = size * random.between(ends.0, ends.1);
        }
        cloud
    }

    fn input(&self) -> Whitewater<'_> {
        Whitewater {
            positions: &self.positions,
            kinds: Some(&self.kinds),
            radii: Some(&self.radii),
            ages: Some(&self.ages),
            ids: Some(&self.ids),
        }
    }

    fn draw(&self, rig: &mut Rig<'_>) -> Drawn {
        let cloud = rig.whitewater(&self.input());
        self.draw_with(rig, Some(cloud.particles()))
    }

    /// Draws these whitewater particles instead of the shot's own.
    fn draw_with(&self, rig: &mut Rig<'_>, particles: Option<WhitewaterParticles>) -> Drawn {
        let amounts = rig
            .stub
            .data(bytemuck::cast_slice(&self.case.amounts), vk::BufferUsageFlags::STORAGE_BUFFER);
        let fluid = rig.particles(&self.case.shot);
        let foam = self.case.amounts.iter().any(|amount| amount[0] > 0.0);
        let fluid =
            fluid.particles().with(|it| it.surface_foam = foam.then(|| stream(&amounts, 0, 8)));
        rig.draw_whitewater(&self.case.shot, &fluid, particles)
    }

    fn particles(&self) -> Vec<Particle> {
        twins(&self.input())
    }

    fn twin_settings(&self) -> Settings {
        let (look, water) = (&self.case.shot.settings.whitewater, &self.case.shot.settings.water);
        let attenuation = attenuation(look.submerged);
        Settings { attenuation, ..Settings::new(f64::from(water.spacing)) }
    }
}

fn map_of(drawn: &Drawn) -> &Image<[f32; 4]> {
    drawn.light_whitewater.as_ref().expect("a map of whitewater particles")
}

/// The map agrees with the twin's for suns and regions of all kinds. Some particles lie beside the
/// region, some before it, behind it and behind the eye.
#[test]
fn the_map_of_whitewater_particles_is_the_twins() {
    let gpu = Gpu::shared();
    let suns =
        [toward(0.4, 0.8, 0.4), [0.0, 1.0, 0.0], toward(-0.7, 0.3, 0.2), toward(0.6, -0.1, -0.5)];
    for texels in [64, 16, 112] {
        let config = whitewater_config(casting(texels), 4096);
        let mut rig = Rig::lit(&gpu, &config, 1);
        for (i, sun) in suns.into_iter().enumerate() {
            let mut shot = Shot::new(SIZE, Lens::Standard, 0.2, &scenes::cloud(31, 60, 3.0, 7.0));
            shot.settings.light.direction = sun;
            let center = scenes::world(&shot.camera, &[[0.3, -0.2, 3.0]])[0];
            let radius = [3.0, 7.0][i % 2];
            shot.light_volume = Some(LightVolume { center, radius });
            if i % 2 == 1 {
                let most = 0.9;
                shot.settings.whitewater.submerged =
                    Submerged::Falloff { depth: most, n: 2.0, m: 4.0 };
            }
            let mut points = scenes::cloud(7 + i as u64, 260, 0.2, 9.0);
            let behind = scenes::cloud(9, 60, 0.5, 2.0);
            points.extend(behind.iter().map(|[x, y, z]| [*x, *y, -z]));
            let positions = scenes::world(&shot.camera, &points);
            let mut cloud = Cloud::mixed(water(shot), positions, 0.3);
            cloud.positions[3][1] = f32::NAN;
            cloud.positions[4][0] = f32::INFINITY;
            cloud.positions[5][2] = -1e11;
            cloud.ages[6] = f32::NAN;
            let drawn = cloud.draw(&mut rig);
            let found = map_of(&drawn);
            let light = twin(&cloud.case.shot, &config);
            let front = maps(&drawn).front;
            let bounds = light.whitewater(&cloud.particles(), &cloud.twin_settings(), front);
            for (c, bounds) in bounds.iter().enumerate() {
                let name = format!("light-whitewater-{texels}-{i}-{c}");
                compare::between(&name, &found.map(|t| t[c]), bounds);
                // The bounds may be as far apart as the rounding to half precision and a hundredth
                // of a texel allow.
                let unit = light.whitewater_unit();
                let close = bounds.low.data.iter().zip(&bounds.high.data).filter(|(a, b)| {
                    **b - **a < 4e-3 * b.abs() + [2e-3, 0.01 * light.texel() / unit, 0.1 / unit][c]
                });
                let (close, all) = (close.count(), bounds.low.data.len());
                assert!(close * 100 > 95 * all, "{name}: {close} of {all}, idle bounds");
            }
            let some = found.data.iter().filter(|t| t[0] > 0.01).count();
            assert!(some * 8 > found.data.len(), "{texels}-{i}: {some} texels have something");
        }
    }
}

/// Positions that half precision does not reach in scene units, as in a scene in millimetres: the
/// map is still the twin's.
#[test]
fn the_map_of_a_wide_region_is_the_twins() {
    let gpu = Gpu::shared();
    let config = whitewater_config(casting(64), 4096);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut shot = Shot::new(SIZE, Lens::Standard, 0.2, &[]);
    shot.settings.light.direction = [0.0, 1.0, 0.0];
    shot.light_volume = Some(LightVolume { center: [0.0; 3], radius: 4.0e5 });
    let mut random = Random(6);
    let positions = (0..200).map(|_| [0; 3].map(|_| random.between(-3.0e5, 3.0e5))).collect();
    let cloud = Cloud::mixed(water(shot), positions, 3.0e4);
    let drawn = cloud.draw(&mut rig);
    let light = twin(&cloud.case.shot, &config);
    let front = maps(&drawn).front;
    let bounds = light.whitewater(&cloud.particles(), &cloud.twin_settings(), front);
    for (c, bounds) in bounds.iter().enumerate() {
        let name = format!("light-whitewater-wide-{c}");
        compare::between(&name, &map_of(&drawn).map(|t| t[c]), bounds);
    }
    let far = map_of(&drawn).data.iter().map(|t| f64::from(t[1].abs()) * light.whitewater_unit());
    let far = far.filter(|far| far.is_finite() && *far > 65_504.0).count();
    assert!(far > 300, "{far} texels have whitewater so far off");
}

/// The scene under spray has the light that the maps say, with and without water and its surface
/// foam.
#[test]
fn the_scene_is_in_the_shade_of_whitewater_particles() {
    let gpu = Gpu::shared();
    for (lens, wet) in [(Lens::Standard, false), (Lens::Reversed, true), (Lens::LeftHanded, true)] {
        let config = whitewater_config(casting(64).with(|it| it.thickness_level = 0), 4096);
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut case = grounded(lens, 0.4);
        case.shot.settings.light.shade = [0.0, 0.875, 1.5];
        (
            case.shot.settings.whitewater.half_intensity_thickness,
            case.shot.settings.whitewater.exponent,
        ) = (0.7, 1.3);
        if !wet {
            (case.shot.positions, case.amounts, case.velocities) = Default::default();
        }
        let mut random = Random(5);
        let mut at = |middle: f32, by: f32| middle + random.between(-by, by);
        let positions = (0..300).map(|_| [at(2.7, 0.8), at(1.1, 0.4), at(0.3, 0.8)]).collect();
        let cloud = Cloud::mixed(case, positions, 0.08);
        let drawn = cloud.draw(&mut rig);
        let one = crate::support::rounded::exact(1.0);
        check_lit(&format!("lit-whitewater-{wet}"), &cloud.case, &config, &drawn, &|_, _, _| one);
    }
}

/// A wide sheet of foam a metre above the ground, with the sun above it. Its lattice is so dense
/// that its thickness is nearly uniform. Returns the min and max thickness.
fn sheet(texels: u32) -> (Cloud, Config, [f64; 2]) {
    let mut case = grounded(Lens::Standard, 0.2);
    (case.shot.positions, case.amounts, case.velocities) = Default::default();
    case.shot.settings.light.direction = [0.0, 1.0, 0.0];
    case.shot.settings.light.shade = [0.0; 3];
    let (step, radius) = (0.0625_f32, 0.15_f32);
    let place = |i: i32| step * i as f32;
    let lattice = (34..68).flat_map(|i| (-14..20).map(move |j| [place(i), 1.2, place(j)]));
    let cloud = Cloud::of(case, lattice.collect(), radius);
    // Thickness over one cell of the lattice.
    let thickness = |x: f64, z: f64| -> f64 {
        let (step, radius) = (f64::from(step), f64::from(radius));
        let near = (-4..=4).flat_map(|i| (-4..=4).map(move |j| (f64::from(i), f64::from(j))));
        near.map(|(i, j)| (x - i * step).hypot(z - j * step) / radius)
            .map(|far| if far < 1.0 { Kind::Foam.shape(far) } else { 0.0 })
            .sum()
    };
    let cell = (0..64).map(|i| thickness(f64::from(i % 8) / 128.0, f64::from(i / 8) / 128.0));
    let ends = cell.fold([f64::MAX, 0.0_f64], |[low, high], v| [low.min(v), high.max(v)]);
    (cloud, whitewater_config(casting(texels), 4096), ends)
}

/// The ground under a sheet of known thickness loses the fraction of sunlight that the sheet
/// covers, at every resolution of the map.
#[test]
fn a_sheet_takes_of_the_sun_what_it_covers() {
    let gpu = Gpu::shared();
    for texels in [64, 128, 256] {
        let (cloud, config, [least, most]) = sheet(texels);
        let mut rig = Rig::lit(&gpu, &config, 1);
        let drawn = cloud.draw(&mut rig);
        let (shot, look) = (&cloud.case.shot, &cloud.case.shot.settings.whitewater);
        let (half, exponent) = (f64::from(look.half_intensity_thickness), f64::from(look.exponent));
        let covered = [least, most].map(|rho| intensity(rho, half, exponent));
        assert!(covered[0] > 0.5 && covered[1] - covered[0] < 0.02, "{covered:?}");
        let (foam, scene) = (drawn.whitewater.as_ref().expect("foam"), shot.scene_eye());
        let mut under = 0;
        for (i, found) in drawn.output.data.iter().enumerate() {
            let (x, y) = (i % drawn.output.width, i / drawn.output.width);
            if scene.data[i] > 90.0 || foam.occluders.data[i][0] < 1e9 {
                continue;
            }
            let (p, _) = seen(shot, scene.data[i], (x, y));
            if !((2.4..3.9).contains(&p.x) && (-0.6..0.9).contains(&p.z)) {
                continue;
            }
            under += 1;
            for (c, (found, open)) in found.iter().zip(&shot.color[i]).take(3).enumerate() {
                let lost = 1.0 - f64::from(*found) / f64::from(*open);
                // The map, the picture, the fixed-point steps and the picture's original values
                // each round to half precision.
                let by = 4.0 / 1024.0;
                let inside = covered[0] - by..covered[1] + by;
                assert!(inside.contains(&lost), "{texels} ({x}, {y}) {c}: {lost}, not {covered:?}");
            }
        }
        assert!(under > 150, "{under} pixels lie under it");
    }
}

/// For each pixel where foam faces the sun: its direct sunlight over that without shadows. Also
/// returns the depths.
fn sun_on_foam(gpu: &Gpu, cloud: &Cloud, config: &Config) -> (Vec<Option<f32>>, Vec<f32>) {
    let mut open = cloud.clone();
    open.case.shot.light_volume = None;
    let mut dark = open.clone();
    let light = &mut dark.case.shot.settings.light;
    light.shade = light.irradiance;
    let none = config.with(|it| it.light_map_size = None);
    let of = |cloud: &Cloud, config: &Config| {
        let drawn = cloud.draw(&mut Rig::lit(gpu, config, 1)).whitewater.expect("foam");
        (drawn.light.map(|light| light[0]).data, drawn.occluders.map(|texel| texel[0]).data)
    };
    let ((shaded, depth), (open, _), (dark, _)) =
        (of(cloud, config), of(&open, &none), of(&dark, &none));
    let part = |i: usize| {
        let whole = open[i] - dark[i];
        (depth[i] < 1e9 && whole > 0.05).then(|| (shaded[i] - dark[i]) / whole)
    };
    ((0..depth.len()).map(part).collect(), depth)
}

/// Foam behind the sheet of foam loses the fraction of sunlight that the sheet covers.
#[test]
fn foam_is_in_the_shade_of_foam() {
    let gpu = Gpu::shared();
    let (mut cloud, config, [least, most]) = sheet(128);
    cloud.case.shot.settings.light.irradiance = [3.0; 3];
    let look = cloud.case.shot.settings.whitewater;
    let left =
        |rho: f64| 1.0 - intensity(rho, look.half_intensity_thickness.into(), look.exponent.into());
    let mut random = Random(9);
    let mut at = |middle: f32, by: f32| middle + random.between(-by, by);
    let few: Vec<_> = (0..120).map(|_| [at(3.1, 0.4), at(0.5, 0.1), at(0.2, 0.4)]).collect();
    let alone = Cloud::of(cloud.case.clone(), few, 0.03);
    let both = [alone.positions.clone(), cloud.positions.clone()].concat();
    let mut both = Cloud::of(cloud.case.clone(), both, 0.15);
    both.radii[..120].fill(0.03);
    let (open, low) = sun_on_foam(&gpu, &alone, &config);
    let (shaded, depth) = sun_on_foam(&gpu, &both, &config);
    let mut seen = 0;
    // Pixels that show the 120 particles beside the sheet. At most two of these particles overlap.
    for i in (0..depth.len()).filter(|i| depth[*i] == low[*i] && open[*i].is_some()) {
        let Some(part) = shaded[i] else { continue };
        seen += 1;
        // Three values in half precision, two of which are nearly as large as their difference.
        let by = 0.01;
        let (part, ends) = (f64::from(part), left(most + 2.0) - by..left(least) + by);
        assert!(ends.contains(&part), "{part}, not {ends:?}");
        assert!(open[i].is_some_and(|open| open > 0.8), "{:?} by itself", open[i]);
    }
    assert!(seen > 30, "{seen} pixels");
}

/// One particle does not shade itself, whatever its size and the sun's direction: the light is
/// equal to the bit.
#[test]
fn a_particle_does_not_shade_itself() {
    let gpu = Gpu::shared();
    let config = whitewater_config(casting(64), 16);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let none = config.with(|it| it.light_map_size = None);
    let mut open_rig = Rig::lit(&gpu, &none, 1);
    let suns =
        [[0.0, 1.0, 0.0], toward(0.9, 0.1, 0.1), toward(-0.5, 0.3, -0.8), toward(0.1, 0.2, 1.0)];
    for (sun, radius) in suns.iter().flat_map(|sun| [0.004_f32, 0.06, 0.5].map(|r| (*sun, r))) {
        let mut shot = Shot::new(SIZE, Lens::Standard, 0.06, &[]);
        shot.settings.light.direction = sun;
        shot.settings.whitewater.half_intensity_thickness = 0.01;
        let at = scenes::world(&shot.camera, &[[0.1, 0.05, 2.0]])[0];
        shot.light_volume = Some(LightVolume { center: at.map(|c| c + 0.07), radius: 1.0 });
        let cloud = Cloud::of(water(shot), vec![at], radius);
        let shaded = cloud.draw(&mut rig).whitewater.expect("foam");
        let mut open = cloud.clone();
        open.case.shot.light_volume = None;
        let open = open.draw(&mut open_rig).whitewater.expect("foam");
        assert!(open.light.data.iter().any(|light| light[0] > 0.1));
        compare::same_color(&format!("alone-{radius}"), &shaded.light, &open.light);
    }
}

/// A level sheet of foam shades itself only a little, down to a grazing sun.
#[test]
fn a_sheet_hardly_shades_itself() {
    let gpu = Gpu::shared();
    for texels in [64, 256] {
        for height in [1.0_f32, 0.5, 0.2] {
            if !slow() && (texels == 64) != (height == 0.5) {
                continue;
            }
            let mut shot = Shot::new(SIZE, Lens::Standard, 0.06, &[]);
            let mut random = Random(4);
            let positions = (0..3000)
                .map(|_| {
                    let mut at = |middle: f32, by: f32| middle + random.between(-by, by);
                    [at(3.1, 0.7), at(0.9, 0.01), at(0.2, 0.7)]
                })
                .collect();
            let along = (1.0 - height * height).sqrt();
            // The sun stands behind the eye, because small foam faces the eye.
            shot.settings.light.direction = toward(-0.8 * along, height, 0.6 * along);
            shot.settings.light.irradiance = [3.0 * height.max(0.1); 3];
            shot.settings.light.shade = [0.0; 3];
            shot.light_volume = Some(LightVolume { center: [3.1, 0.9, 0.2], radius: 1.2 });
            let cloud = Cloud::of(water(shot), positions, 0.04);
            let (parts, _) = sun_on_foam(&gpu, &cloud, &whitewater_config(casting(texels), 4096));
            let parts: Vec<f32> = parts.into_iter().flatten().collect();
            let mean = parts.iter().sum::<f32>() / parts.len() as f32;
            let least = parts.iter().fold(1.0_f32, |a, b| a.min(*b));
            if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
                eprintln!("sheet {texels} {height}: mean {mean}, least {least} of {}", parts.len());
            }
            assert!(parts.len() > 100, "{}", parts.len());
            assert!(mean > 0.97 && least > 0.85, "{texels} {height}: {mean}, {least}");
        }
    }
}

/// A plume of particles, most of them far smaller than a texel. The ground loses nearly as much
/// light with a map of 512 texels as with 1024.
#[test]
fn shadows_do_not_change_with_the_maps_resolution() {
    let gpu = Gpu::shared();
    let mut case = grounded(Lens::Standard, 0.3);
    (case.shot.positions, case.amounts, case.velocities) = Default::default();
    case.shot.settings.light.shade = [0.0; 3];
    let mut random = Random(6);
    let mut at = |middle: f32| middle + (0..4).map(|_| random.between(-0.16, 0.16)).sum::<f32>();
    let positions: Vec<_> = (0..30_000).map(|_| [at(3.0), at(1.1), at(0.2)]).collect();
    let mut cloud = Cloud::of(case, positions, 0.002);
    cloud.radii.iter_mut().step_by(9).for_each(|radius| *radius = 0.02);
    cloud.case.shot.settings.whitewater.half_intensity_thickness = 0.3;
    let lost = |texels: u32| {
        let mut rig = Rig::lit(&gpu, &whitewater_config(casting(texels), 30_000), 1);
        let drawn = cloud.draw(&mut rig);
        let foam = drawn.whitewater.expect("foam").occluders;
        let color = &cloud.case.shot.color;
        let lost = |i: usize| 1.0 - f64::from(drawn.output.data[i][1]) / f64::from(color[i][1]);
        let open = (0..color.len()).filter(|i| foam.data[*i][0] > 1e9);
        open.map(|i| (i, lost(i))).collect::<Vec<_>>()
    };
    let (coarse, fine) = (lost(512), lost(1024));
    let all: f64 = fine.iter().map(|(_, lost)| lost.abs()).sum();
    let off: f64 = coarse.iter().zip(&fine).map(|((_, a), (_, b))| (a - b).abs()).sum();
    let sum: f64 = coarse.iter().zip(&fine).map(|((_, a), (_, b))| a - b).sum();
    let most = fine.iter().map(|(_, lost)| *lost).fold(0.0, f64::max);
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("resolution: {} off, {} in all, most {most}", off / all, sum / all);
    }
    assert!(most > 0.3, "{most} is the darkest");
    assert!(off < 0.06 * all && sum.abs() < 0.03 * all, "{} and {} of it", off / all, sum / all);
}

/// A scene with particles of all kinds, and with everything that the sun lights.
fn all_kinds(cast: u32) -> (Cloud, Config) {
    all_kinds_of(SIZE, cast)
}

fn all_kinds_of(size: vk::Extent2D, cast: u32) -> (Cloud, Config) {
    let mut case = Foamy::new(size, Lens::Reversed, 30.0);
    let config = everything(&mut case).with(|it| {
        it.extent = size;
        it.shadow = None;
        it.light_map_size = Some(cast);
    });
    case.shot.settings.whitewater.half_intensity_thickness = 0.1;
    let positions = scenes::world(&case.shot.camera, &scenes::cloud(17, 700, 1.0, 8.0));
    (Cloud::mixed(case, positions, 0.1), whitewater_config(config, 700))
}

/// The sums are in fixed point, so the order of the particles changes neither map nor picture by a
/// bit.
#[test]
fn the_order_of_whitewater_particles_does_not_show() {
    let gpu = Gpu::shared();
    let (cloud, config) = all_kinds(64);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let expected = cloud.draw(&mut rig);
    for seed in 0..3 {
        let order = Random(seed).order(cloud.positions.len());
        let mut other = cloud.clone();
        for (to, from) in order.into_iter().enumerate() {
            other.positions[to] = cloud.positions[from];
            other.kinds[to] = cloud.kinds[from];
            other.radii[to] = cloud.radii[from];
            other.ages[to] = cloud.ages[from];
            other.ids[to] = cloud.ids[from];
        }
        let drawn = other.draw(&mut rig);
        compare::same_color("order-whitewater", map_of(&drawn), map_of(&expected));
        compare::same_color("order-whitewater-output", &drawn.output, &expected.output);
    }
}

/// The host's packets, whatever their size, do not change the light. Particles in boxes beside the
/// light's region cast no shadow.
#[test]
fn packets_cast_as_single_particles() {
    let gpu = Gpu::shared();
    let (mut cloud, config) = all_kinds(64);
    // Every particle has its own radius. The default radius is small, because packets are grown by
    // it.
    cloud.case.shot.settings.whitewater.radius = 1.0e-3;
    // The region has particles on all sides.
    let middle =
        cloud.positions.iter().map(|p| Vec3::from(*p)).sum::<Vec3>() / cloud.positions.len() as f32;
    cloud.case.shot.light_volume = Some(LightVolume { center: middle.to_array(), radius: 1.5 });
    let whitewater = config.whitewater.map(|whitewater| whitewater.with(|it| it.packets = true));
    let mut rig = Rig::lit(&gpu, &config.with(|it| it.whitewater = whitewater), 1);
    let expected = cloud.draw(&mut rig);
    let n = cloud.positions.len() as u32;
    let draw = |rig: &mut Rig<'_>, positions: &[[f32; 3]], size: u32| {
        let ranges: Vec<_> = (0..n).step_by(size as usize).map(|i| (i, size)).collect();
        let bytes = boxes(positions, Some(&cloud.radii), &ranges);
        let data = rig.stub.data(&bytes, vk::BufferUsageFlags::STORAGE_BUFFER);
        let count = ranges.len() as u32;
        let packets = Some(Packets { buffer: data.buffer, offset: 0, count });
        let particles = rig.whitewater(&cloud.input());
        cloud.draw_with(rig, Some(particles.particles().with(|it| it.packets = packets)))
    };
    for size in [1, 2, 50] {
        let drawn = draw(&mut rig, &cloud.positions, size);
        compare::same_color("packets-cast", map_of(&drawn), map_of(&expected));
        compare::same_color("packets-cast-output", &drawn.output, &expected.output);
    }
    // Moved along the light's own axes: beside the region and behind it.
    let sun = Vec3::from(cloud.case.shot.settings.light.direction).normalize();
    let across = sun.any_orthonormal_vector();
    for offset in [across, -across, sun.cross(across), -sun] {
        let moved = |p: &[f32; 3]| (Vec3::from(*p) + 1.0e4 * offset).to_array();
        let beside: Vec<_> = cloud.positions.iter().map(moved).collect();
        let map =
            draw(&mut rig, &beside, 50).light_whitewater.expect("a map of whitewater particles");
        assert!(map.data.iter().all(|texel| texel[0] == 0.0), "{offset}: something casts");
    }
}

/// The device binds only small ranges, so particles and map are processed in pieces. This does not
/// change the result. The particles come as interleaved records, with a count on the GPU or
/// on the CPU.
#[test]
fn pieces_do_not_show() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    // Buffers with one entry per pixel are bound whole; they hold 32 bytes per pixel.
    let (cloud, config) = all_kinds_of(extent(13, 12), 64);
    let expected = cloud.draw(&mut Rig::lit(&gpu, &config, 1));
    // The first range holds 5 rows of the map or 256 particle records; the second holds 19 rows and
    // all particles.
    for range in [5 * 1024 + 100, 19 * 1024] {
        claim(&mut gpu, Claims { max_storage_buffer_range: Some(range), ..Claims::default() });
        let count = cloud.positions.len();
        let mut bytes = vec![0xa5_u8; 20 + 28 * count];
        for (i, record) in bytes[20..].chunks_exact_mut(28).enumerate() {
            record[..12].copy_from_slice(bytemuck::bytes_of(&cloud.positions[i]));
            record[12..16].copy_from_slice(&cloud.kinds[i].to_ne_bytes());
            record[16..20].copy_from_slice(&cloud.radii[i].to_ne_bytes());
            record[20..24].copy_from_slice(&cloud.ages[i].to_ne_bytes());
            record[24..28].copy_from_slice(&cloud.ids[i].to_ne_bytes());
        }
        let whitewater =
            config.whitewater.map(|whitewater| whitewater.with(|it| it.max_stride = 28));
        let mut rig = Rig::lit(&gpu, &config.with(|it| it.whitewater = whitewater), 1);
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let (data, number) = (rig.stub.data(&bytes, usage), (count as u32).to_ne_bytes());
        let number = rig.stub.data(&number, usage);
        let at = |offset: u64| -> Option<Stream> { Some(stream(&data, 20 + offset, 28)) };
        let counts = [Count::Gpu { buffer: number.buffer, offset: 0 }, Count::Cpu(count as u32)];
        for counted in counts {
            let particles = WhitewaterParticles::new(stream(&data, 20, 28), counted).with(|it| {
                it.kinds = at(12);
                it.radii = at(16);
                it.ages = at(20);
                it.ids = at(24);
                it.before = HOST_WRITE;
                it.after = HOST_WRITE;
            });
            drop(spy::take_bound());
            let drawn = cloud.draw_with(&mut rig, Some(particles));
            let bound = spy::take_bound();
            assert!(bound.iter().any(|bound| bound.offset > 0), "all is in one piece");
            // 16 bytes per texel of the map.
            let words = spy::buffers_of_size(16 * 64 * 64);
            assert!(!words.is_empty());
            let whole = |b: &&spy::Bound| b.range == vk::WHOLE_SIZE && words.contains(&b.buffer);
            assert!(!bound.iter().any(|b| whole(&b)), "the map's words are bound as a whole");
            compare::same_color(&format!("pieces-{range}"), map_of(&drawn), map_of(&expected));
            compare::same_color(&format!("pieces-{range}-output"), &drawn.output, &expected.output);
        }
    }
}

/// Without whitewater particles the light equals that of a renderer without them, to the bit. This
/// also holds after a frame with particles, and when all particles are too old. Spray and foam may
/// differ by rounding, because there another shader runs.
#[test]
fn no_whitewater_particles_take_no_light() {
    let gpu = Gpu::shared();
    let (cloud, config) = all_kinds(64);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let plain =
        cloud.draw_with(&mut Rig::lit(&gpu, &config.with(|it| it.whitewater = None), 1), None);
    let first = cloud.draw_with(&mut rig, None);
    let some = cloud.draw(&mut rig);
    let lost = some.output.data.iter().zip(&first.output.data);
    let darker = lost.filter(|(a, b)| a[0] < 0.97 * b[0]).count();
    assert!(darker > 50, "{darker} pixels are darker");
    let [mut none, mut gone] = [cloud.clone(), cloud.clone()];
    none.positions.clear();
    gone.ages.fill(1.0);
    let later = cloud.draw_with(&mut rig, None);
    let all = [first, later, none.draw(&mut rig), gone.draw(&mut rig)];
    let lit = |drawn: &Drawn| {
        [drawn.lit_spray.clone().expect("spray"), drawn.foam.clone().expect("foam").lit]
    };
    for (i, drawn) in all.iter().enumerate() {
        assert!(map_of(drawn).data.iter().all(|texel| *texel == [0.0; 4]), "{i}");
        compare::same_color(&format!("no-whitewater-{i}"), &drawn.output, &all[0].output);
        for (found, expected) in lit(drawn).iter().zip(&lit(&plain)) {
            let [found, expected] = [found, expected].map(|lit| lit.map(|v| [*v, *v, *v, 1.0]));
            compare::same_but_rounded(&format!("no-whitewater-lit-{i}"), &found, &expected);
        }
    }
    let (foam, spray) = (plain.foam.as_ref().expect("foam"), plain.spray.as_ref().expect("spray"));
    let foam = foam.seen(&cloud.case.shot);
    let mut scene = 0;
    for (i, expected) in plain.output.data.iter().enumerate() {
        if plain.depth.data[i] > 1e9 && foam.data[i].0 > 1e9 && spray.data[i] == 0.0 {
            assert_eq!(all[0].output.data[i], *expected, "pixel {i}");
            scene += 1;
        }
    }
    assert!(scene > 500, "{scene} pixels of the scene");
}

/// Whitewater particles that the eye does not see shade the sun's highlight on water, and surface
/// foam.
#[test]
fn water_is_in_the_shade_of_foam() {
    let gpu = Gpu::shared();
    let block = scenes::block(3, 0.1, [40, 28, 3], [-2.0, -1.4, 2.6]);
    for foamy in [false, true] {
        let mut case = water(Shot::new(SIZE, Lens::Standard, 0.0656, &block));
        case.shot.settings.water.specular = if foamy { 0.0 } else { 1.0 };
        if foamy {
            case.amounts.fill([1.0, 0.0]);
            case.shot.settings.surface_foam.shadow = 0.0;
        }
        let dull = {
            let mut dull = case.clone();
            dull.shot.settings.water.specular = 0.0;
            dull.amounts.fill([0.0; 2]);
            dull
        };
        // The sun and the whitewater particles are behind the eye.
        let [at, from] = [[0.0, 0.0, 2.6], [0.1, 0.2, 0.0]]
            .map(|p| Vec3::from(scenes::world(&case.shot.camera, &[p])[0]));
        let mut random = Random(8);
        let points: Vec<_> = (0..400)
            .map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0), -0.6])
            .collect();
        let points = scenes::world(&case.shot.camera, &points);
        let config = whitewater_config(
            casting(64).with(|it| {
                it.surface_foam = foamy;
                it.thickness_level = 0;
            }),
            4096,
        );
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut light = |case: &Foamy, some: bool| {
            let mut case = case.clone();
            case.shot.settings.light.direction = (from - at).normalize().to_array();
            case.shot.settings.light.shade = [0.0; 3];
            case.shot.light_volume = Some(LightVolume { center: at.to_array(), radius: 4.0 });
            let cloud = Cloud::of(case, points.clone(), 0.25);
            let drawn = if some { cloud.draw(&mut rig) } else { cloud.draw_with(&mut rig, None) };
            let seen = drawn.whitewater.as_ref().expect("foam");
            assert!(seen.occluders.data.iter().all(|texel| texel[0] > 1e9), "it is seen");
            drawn.output.data
        };
        let [open, shaded, dull] = [light(&case, false), light(&case, true), light(&dull, true)];
        let (mut middle, mut beside) = ([0.0; 2], 0);
        for (i, ((open, shaded), dull)) in open.iter().zip(&shaded).zip(&dull).enumerate() {
            let (x, y) = (i % 97, i / 97);
            if (30..67).contains(&x) && (15..46).contains(&y) {
                let own = if foamy { 0.0 } else { dull[1] };
                middle[0] += open[1] - own;
                middle[1] += shaded[1] - own;
            } else if (9..13).contains(&x) && open != dull {
                assert_eq!(open, shaded, "({x}, {y}) is beside the shade");
                beside += 1;
            }
        }
        let [open, shaded] = middle;
        assert!(open > 0.5 && shaded < 0.6 * open, "{foamy}: {shaded} of {open}");
        // Beside the shade only foam is lit; the highlight does not reach there.
        assert!(beside > 50 || !foamy, "{beside} pixels are beside it");
    }
}

/// So many particles on one spot that the fixed-point sum reaches its max. They block all sunlight,
/// and the map's depth is still right.
#[test]
fn many_on_one_spot_take_all_the_sun() {
    let gpu = Gpu::shared();
    let (mut cloud, _, _) = sheet(64);
    let count = 200_000;
    cloud.positions = vec![[3.1, 1.2, 0.2]; count];
    cloud = Cloud::of(cloud.case, cloud.positions, 0.3);
    let mut rig = Rig::lit(&gpu, &whitewater_config(casting(64), count as u32), 1);
    let drawn = cloud.draw(&mut rig);
    let most = map_of(&drawn).data.iter().map(|t| t[0]).fold(0.0, f32::max);
    assert!((4095.0..4200.0).contains(&most), "where 4096 are all: {most}");
    let light = twin(&cloud.case.shot, &casting(64));
    let far = light.place(wide([3.1, 1.2, 0.2])).1 + 0.3;
    for [_, middle, spread, _] in map_of(&drawn).data.iter().filter(|t| t[0] > 0.0) {
        let [middle, spread] = [middle, spread].map(|v| f64::from(*v) * light.whitewater_unit());
        // The farthest surface is rounded to steps of a texel, and to half precision.
        let off = (middle - far).abs();
        assert!(off < 0.51 * light.texel() + far.abs() / 1024.0, "{middle}, not {far}");
        assert!(spread < 0.01 * light.texel(), "{spread} about one spot");
    }
}

/// The memory per texel and per particle is as documented.
#[test]
fn memory_is_by_the_texel() {
    let gpu = Gpu::shared();
    let of = |cast: Option<u32>, most: u32| {
        let plain = config(SIZE).with(|it| it.light_map_size = cast);
        let config = if most > 0 { whitewater_config(plain, most) } else { plain };
        let renderer = whitewater::Renderer::new(&gpu.context(1), &config);
        let renderer = renderer.expect("a renderer");
        let memory = renderer.memory();
        // SAFETY: nothing was recorded.
        unsafe { renderer.destroy() };
        (memory.images + memory.buffers) as f64
    };
    for most in [1, 30_000_000] {
        let more = |cast: Option<u32>| of(cast, most) - of(cast, 0);
        let (found, said) = (more(Some(1024)) - more(None), 24.0 * 1024.0 * 1024.0);
        let said = said + lists(&gpu, most);
        assert!((found - said).abs() < 0.01 * said + 4096.0, "{most}: {found}, said {said}");
    }
}

/// A block of water before the eye, with whitewater particles 0.1 behind its front.
fn in_water(foam_at: Option<f32>) -> (Cloud, Config) {
    let size = extent(48, 32);
    let mut shot = Shot::new(size, Lens::Standard, 0.0656, &[]);
    let eye = scenes::block(7, 0.1, [22, 15, 12], [-1.05, -0.7, 2.0]);
    shot.positions = scenes::world(&shot.camera, &eye);
    let mut case = water(shot);
    let near = |z: f32, at: f32| (z - at).abs() < 0.06;
    if let Some(at) = foam_at {
        for (amount, [.., z]) in case.amounts.iter_mut().zip(&eye) {
            amount[0] = if near(*z, at) { 1.0 } else { 0.0 };
        }
    }
    let mut random = Random(5);
    let mut inside = || [random.between(-0.8, 0.8), random.between(-0.5, 0.5), 2.1];
    let inside: Vec<_> = (0..400).map(|_| inside()).collect();
    let positions = scenes::world(&case.shot.camera, &inside);
    let cloud = Cloud::of(case, positions, 0.04);
    (cloud, config(size))
}

/// Submerged whitewater is as deep in the water whether or not the water's particles may foam, and surface foam whether
/// or not there may be whitewater.
#[test]
fn foam_in_water_is_as_deep_beside_other_foam() {
    let gpu = Gpu::shared();
    let draw = |cloud: &Cloud, config: Config, with: bool| {
        let mut rig = Rig::lit(&gpu, &config, 1);
        let particles = with.then(|| rig.whitewater(&cloud.input()));
        cloud.draw_with(&mut rig, particles.as_ref().map(|own| own.particles())).output
    };
    for sheets in [1, 2] {
        let (cloud, config) = in_water(None);
        let config = whitewater_config(config.with(|it| it.sheets = sheets), 400);
        let alone = draw(&cloud, config, true);
        assert!(alone != draw(&cloud, config, false), "it shows");
        let beside = draw(&cloud, config.with(|it| it.surface_foam = true), true);
        compare::same_but_rounded(&format!("sunk-{sheets}"), &beside, &alone);
        let (cloud, config) = in_water(Some(2.3));
        let config = config.with(|it| (it.sheets, it.surface_foam) = (sheets, true));
        let alone = draw(&cloud, config, false);
        let beside = draw(&cloud, whitewater_config(config, 400), false);
        compare::same_but_rounded(&format!("deep-{sheets}"), &beside, &alone);
    }
}
