//! Compares pass `spray`, which draws droplets for particles of low density, with its CPU twin, and
//! checks the picture that contains them.

use std::cell::RefCell;
use std::collections::HashMap;

use glam::{DMat3, DVec3, Mat4, Vec3};
use whitewater::water::{Kernels, Shading, Shadows, SpraySettings};
use whitewater::{Config, Packets, Shadow};

use crate::harness::fails;
use crate::invariants::packet_bytes;
use crate::light::shadows;
use crate::reduce::wide;
use crate::reference::Image;
use crate::reference::light::ShadowMap;
use crate::reference::spray::{self, Particle, Relief, Sums};
use crate::shape::{askew, facing, lattice, of_spray};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::Data;
use crate::support::rig::{Drawn, Rig, Shot, config, extent, stream};
use crate::support::rounded::{exact, off};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::surface_foam::{nearly, pattern};

const STORAGE: ash::vk::BufferUsageFlags = ash::vk::BufferUsageFlags::STORAGE_BUFFER;

fn spraying(size: ash::vk::Extent2D) -> Config {
    config(size).with(|it| it.spray = true)
}

/// A shot with the attributes that spray uses.
#[derive(Clone)]
struct Sprayed {
    shot: Shot,
    /// Velocities in world space, metres per second.
    velocities: Option<Vec<[f32; 3]>>,
    ids: Option<Vec<u32>>,
    /// Amount and age of surface foam.
    amounts: Option<Vec<[f32; 2]>>,
    /// Whether each particle is handed over as a packet of its own.
    packets: bool,
}

impl Sprayed {
    /// Particles at all speeds up to `fastest` spacings per second. A quarter of them have the
    /// density of water.
    fn new(size: ash::vk::Extent2D, lens: Lens, fastest: f32) -> Self {
        Self::of(Shot::new(size, lens, 0.2, &scenes::cloud(31, 160, 2.0, 9.0)), fastest)
    }

    fn of(mut shot: Shot, fastest: f32) -> Self {
        let (mut random, count) = (Random(5), shot.positions.len());
        let most = fastest * shot.settings.water.spacing / 3.0_f32.sqrt();
        let velocities = (0..count).map(|_| [0; 3].map(|_| random.between(-most, most))).collect();
        let densities = (0..count).map(|i| match i % 4 {
            0 => 1000.0,
            1 => random.between(1.0, 600.0),
            _ => random.between(550.0, 900.0),
        });
        shot.densities = Some(densities.collect());
        // Both phases of the clumps have weight.
        let foam = &mut shot.settings.surface_foam;
        (foam.time, foam.pattern_period) = (0.3, 0.25);
        // Droplets are enlarged, because in this small picture default ones would cover too few
        // pixels.
        shot.settings.spray.size = 1.5;
        let ids = Some((0..count).map(|_| random.bits() as u32).collect());
        Self { shot, velocities: Some(velocities), ids, amounts: None, packets: false }
    }

    fn look(&mut self) -> &mut SpraySettings {
        &mut self.shot.settings.spray
    }

    fn draw(&self, rig: &mut Rig<'_>) -> Drawn {
        let data = |bytes: &[u8]| rig.stub.data(bytes, STORAGE);
        let cloud = rig.particles(&self.shot);
        let velocities = self.velocities.as_ref().map(|all| data(bytemuck::cast_slice(all)));
        let ids = self.ids.as_ref().map(|all| data(bytemuck::cast_slice(all)));
        let amounts = self.amounts.as_ref().map(|all| data(bytemuck::cast_slice(all)));
        let ranges: Vec<_> = (0..cloud.count).map(|first| (first, 1)).collect();
        let packets = data(&packet_bytes(&self.shot, &ranges));
        let packets = Packets { buffer: packets.buffer, offset: 0, count: cloud.count };
        let all = |data: &Option<Data>, stride| data.as_ref().map(|data| stream(data, 0, stride));
        let particles = cloud.particles().with(|it| {
            it.velocities = all(&velocities, 12);
            it.ids = all(&ids, 4);
            it.surface_foam = all(&amounts, 8);
            it.packets = self.packets.then_some(packets);
        });
        rig.draw_particles(&self.shot, &particles)
    }

    /// The particles as the twin takes them, with the shapes that pass `shape` found in this frame.
    fn particles(&self, drawn: &Drawn) -> Vec<Particle> {
        let strands = drawn.shapes.as_ref().filter(|_| self.shot.settings.spray.strand_ratio > 1.0);
        let shapes = strands.map(|_| of_spray(drawn, &self.shot));
        let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));
        let densities = self.shot.densities.as_ref().expect("densities");
        (0..densities.len())
            .map(|i| Particle {
                position: wide(self.shot.positions[i]),
                velocity: self.velocities.as_ref().map_or(DVec3::ZERO, |all| wide(all[i])),
                density: f64::from(densities[i]),
                id: self.ids.as_ref().map_or(i as u32, |ids| ids[i]),
                shape: shapes.as_ref().map_or(spray::BALL, |all| all[i].0),
                crowd: shapes.as_ref().map_or(spray::CROWDED, |all| all[i].1),
            })
            .collect()
    }

    fn settings(&self) -> spray::Settings {
        let (look, water) = (&self.shot.settings.spray, &self.shot.settings.water);
        let [all, _, none] =
            [look.all_spray_density, look.full_water_density, look.no_spray_density].map(f64::from);
        spray::Settings {
            spacing: f64::from(water.spacing),
            rest_density: f64::from(water.rest_density),
            opacity: f64::from(look.opacity),
            size: f64::from(look.size),
            max_angle: f64::from(look.max_angle),
            droplets: look.droplets,
            spread: f64::from(look.scatter_radius),
            stretch: f64::from(look.stretch),
            mist: [f64::from(look.mist), f64::from(look.mist_size)],
            clumps: f64::from(look.clumps),
            pattern: pattern(&self.shot.settings.surface_foam),
            densities: [all, none],
            shutter: f64::from(look.exposure),
            scattering: f64::from(look.scattering),
            glints: f64::from(look.glints),
            sums: Sums::SINGLE,
        }
    }

    /// Checks the spray against the twin. Returns how many sprites may cover each pixel, and how
    /// many pixels have spray.
    fn check(&self, name: &str, drawn: &Drawn) -> (Image<u32>, usize) {
        self.check_behind(name, drawn, drawn)
    }

    /// Checks spray that the scene partly hides. The frame's water layer lacks what the scene
    /// hides, so the twin takes the water of `open`, a frame without the scene.
    fn check_behind(&self, name: &str, drawn: &Drawn, open: &Drawn) -> (Image<u32>, usize) {
        let (view, scene) = (self.shot.view(self.shot.size), self.shot.scene_at(self.shot.size, 0));
        let (water, settings) = (wide(&open.depth), self.settings());
        let twin = spray::spray(&self.particles(drawn), &view, &settings, &scene, &water);
        compare::between(name, of(drawn), &twin.bounds);
        (twin.count, of(drawn).data.iter().filter(|x| **x > 0.0).count())
    }

    /// Checks that the picture is the spray over `behind`, and equals `behind` bit for bit where
    /// there is no spray.
    fn check_over(&self, name: &str, drawn: &Drawn, behind: &[[f32; 4]]) {
        let (look, sun) = (&self.shot.settings.spray, &self.shot.settings.light);
        let toward = DVec3::from(sun.direction.map(f64::from));
        let relief = Relief::new(f64::from(look.relief), toward, &self.shot.view(self.shot.size));
        let lit = drawn.lit_spray.as_ref().expect("a frame with spray");
        let foam = drawn.foam.as_ref().map(|foam| foam.seen(&self.shot));
        for (i, (found, behind)) in drawn.output.data.iter().zip(behind).enumerate() {
            let x = of(drawn).data[i];
            let untouched = drawn.depth.data[i] >= 1e9
                && foam.as_ref().is_none_or(|seen| seen.data[i].0 >= 1e9)
                && x == 0.0;
            if untouched {
                assert_eq!(found.map(f32::to_bits), behind.map(f32::to_bits), "{name}: {i}");
                continue;
            }
            let place = (i % drawn.output.width, i / drawn.output.width);
            let part = if x > 0.0 { relief.lit(of(drawn), lit, place) } else { exact(1.0) };
            for c in 0..3 {
                let [dark, most] = [sun.shade[c], sun.irradiance[c]].map(f64::from);
                // Three products, and the rounding of their factors.
                let albedo = off(f64::from(look.color[c]) * most / std::f64::consts::PI, 4.0);
                let light = relief.light(part, dark / most) * albedo;
                let (wanted, bound) =
                    spray::over(f64::from(behind[c]), f64::from(x), light, look.additive);
                let error = (f64::from(found[c]) - wanted).abs();
                assert!(error <= bound, "{name}: {} not {wanted} in pixel {i}", found[c]);
            }
        }
    }
}

fn of(drawn: &Drawn) -> &Image<f32> {
    drawn.spray.as_ref().expect("a frame with spray")
}

#[test]
fn spray_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &spraying(size));
    let mut faded = 0;
    for lens in LENSES {
        for (droplets, moving) in [(1, true), (16, true), (1, false), (16, false)] {
            let mut case = Sprayed::new(size, lens, 40.0);
            case.look().droplets = droplets;
            if !moving {
                (case.velocities, case.ids) = (None, None);
            }
            let name = format!("spray-{lens:?}-{droplets}-{moving}");
            let whole = case.draw(&mut rig);
            let (_, covered) = case.check(&name, &whole);
            assert!(covered > 1000, "{name}: {covered} pixels");
            case.shot.scene_depth(|x, y| ((x / 9 + y / 5) % 2 == 0).then_some(4.0));
            let cut = case.draw(&mut rig);
            let (_, left) = case.check_behind(&format!("{name}-cut"), &cut, &whole);
            assert!(left * 10 < covered * 9, "{name}: {left} of {covered} pixels");
            // Water lies before some of the spray and fades it; without these particles more spray
            // shows.
            case.shot.positions.iter_mut().step_by(4).for_each(|p| *p = [f32::NAN; 3]);
            case.shot.scene_depth(|_, _| None);
            let dry = of(&case.draw(&mut rig)).clone();
            faded += dry.data.iter().zip(&of(&whole).data).filter(|(a, b)| **a > 1.1 * **b).count();
        }
    }
    // Water hides spray only where water spheres overlap, which is in few pixels.
    assert!(faded > 200, "{faded} pixels behind water");
}

type Change = (&'static str, fn(&mut SpraySettings));

/// Checks every setting at both ends of its range, with particles around the eye and particles with
/// invalid positions and velocities.
#[test]
fn spray_of_all_settings_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &spraying(size));
    let changes: [Change; 22] = [
        ("default", |look| *look = SpraySettings::default()),
        ("source", |look| *look = SpraySettings::SOURCE),
        ("spread-0", |look| look.scatter_radius = 0.0),
        // Droplets may lie beyond the near plane although their particle's centre lies before it.
        ("spread-small", |look| look.scatter_radius = 0.3),
        ("spread-8", |look| look.scatter_radius = 8.0),
        ("stretch-0.05", |look| look.stretch = 0.05),
        ("stretch-1", |look| look.stretch = 1.0),
        ("no mist", |look| look.mist = 0.0),
        ("mist-0.9", |look| (look.mist, look.mist_size) = (0.9, 2.0)),
        ("clumps", |look| (look.mist, look.clumps) = (0.5, 1.0)),
        ("clumps-3", |look| (look.mist, look.mist_size, look.clumps) = (0.3, 8.0, 3.0)),
        ("strands", |look| {
            (look.mist, look.mist_size, look.clumps) = (0.9, 3.0, 2.0);
            (look.exposure, look.stretch) = (0.3, 0.2);
        }),
        ("shutter-0", |look| look.exposure = 0.0),
        ("shutter-1", |look| look.exposure = 1.0),
        ("opacity-99", |look| look.opacity = 0.99),
        ("opacity-most", |look| look.opacity = 1.0 - f32::EPSILON),
        ("opacity-least", |look| look.opacity = 1e-4),
        ("size-8", |look| (look.size, look.droplets) = (8.0, 1)),
        ("size-least", |look| look.size = 1e-6),
        ("droplets-64", |look| look.droplets = 64),
        ("densities-same", |look| {
            [look.all_spray_density, look.full_water_density, look.no_spray_density] = [0.6; 3]
        }),
        ("densities-0", |look| {
            [look.all_spray_density, look.full_water_density, look.no_spray_density] =
                [0.0, 0.0, 3.0]
        }),
    ];
    for (name, change) in changes {
        for (i, near) in [false, true].into_iter().enumerate() {
            let (from, to, radius) = if near { (0.01, 1.2, 0.05) } else { (1.5, 6.0, 0.2) };
            let mut look = SpraySettings::default().with(|it| it.size = 1.5);
            change(&mut look);
            let mut points = scenes::cloud(8, 90, from, to);
            // Particles just before and just behind the two distances at which spray begins.
            for limit in [scenes::NEAR, 2.0 * look.scatter_radius * radius / 0.656] {
                points.extend([0.97, 0.99, 1.01, 1.03].map(|d| [0.0, 0.0, d * limit.max(0.01)]));
            }
            let mut case = Sprayed::of(Shot::new(size, Lens::OffAxis, radius, &points), 20.0);
            *case.look() = look;
            // Pixels are twice as wide as they are high.
            case.shot.camera = scenes::camera(Lens::OffAxis, extent(194, 61));
            case.shot.positions[1][i] = f32::NAN;
            case.shot.positions[5][i] = -2e18;
            let velocities = case.velocities.as_mut().expect("velocities");
            (velocities[2], velocities[3]) = ([f32::INFINITY; 3], [0.0, -2e18, 0.0]);
            let strange = [0.0, -1.0, f32::NAN, f32::INFINITY, 600.0, 350.0, 850.0];
            let densities = case.shot.densities.as_mut().expect("densities");
            densities[6..13].copy_from_slice(&strange);
            densities[90..].fill(300.0);
            let drawn = case.draw(&mut rig);
            let (_, covered) = case.check(&format!("spray-{name}-{near}"), &drawn);
            if case.look().clumps > 0.0 {
                let mut even = case.clone();
                even.look().clumps = 0.0;
                let other = fails(|| {
                    even.check("planted-even", &drawn);
                });
                assert!(other, "{name}: as if spray were even");
            }
            // Even at the smallest droplet size, mist is drawn.
            assert!(covered > 0, "{name}");
        }
    }
}

/// There are more particles than one binding holds. Without ids, a particle's number continues from
/// chunk to chunk. Packets are culled by boxes around the particles' centres; this must not remove
/// any spray that shows.
#[test]
fn chunks_and_packets_of_spray_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let torn = torn(size, Lens::OffAxis, 20.0);
    for (config, mut case) in
        [(spraying(size), Sprayed::new(size, Lens::OffAxis, 20.0)), (shaped(size), torn)]
    {
        let mut rig = Rig::new(&gpu, &config.with(|it| it.max_stride = 1 << 20));
        (case.look().exposure, case.look().scatter_radius) = (0.2, 2.0);
        for (ids, packets) in [(true, false), (false, false), (false, true)] {
            case.ids = case.ids.filter(|_| ids);
            case.packets = packets;
            let drawn = case.draw(&mut rig);
            case.check(&format!("spray-chunks-{:?}-{ids}-{packets}", config.kernels), &drawn);
        }
    }
}

/// Spray alone lies over the scene, without water.
#[test]
fn spray_lies_over_the_scene() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for shading in [Shading::Raster, Shading::Compute] {
        let mut rig = Rig::lit(&gpu, &spraying(size).with(|it| it.composite = Some(shading)), 1);
        let mut case = Sprayed::new(size, Lens::Mirrored, 40.0);
        case.shot.densities.as_mut().expect("densities").fill(100.0);
        case.look().color = [0.9, 0.5, 0.0];
        case.shot.color[7] = [f32::from_bits(1), -0.0, 1e30, -3.0];
        case.shot.settings.light.shade = [0.0, 0.875, 1.5];
        for (opacity, additive, relief) in [
            (0.5, false, 0.0),
            (0.5, true, 0.0),
            (0.99, false, 0.0),
            (0.0, false, 4.0),
            (0.5, false, 1.5),
            (0.99, true, 4.0),
        ] {
            (case.look().opacity, case.look().additive) = (opacity, additive);
            (case.look().relief, case.look().glints) = (relief, 8.0 * relief);
            case.look().mist = 0.1 * opacity;
            let drawn = case.draw(&mut rig);
            let name = format!("spray-over-{shading:?}-{opacity}-{additive}-{relief}");
            case.check_over(&name, &drawn, &case.shot.color);
            let covered = of(&drawn).data.iter().filter(|x| **x > 0.0).count();
            assert!(drawn.depth.data.iter().all(|z| *z >= 1e9), "{name}: water");
            assert!(covered < 5000 && (covered > 1000) == (opacity > 0.0), "{name}: {covered}");
        }
    }
}

/// Sums of glints above the largest half float, which a device that blends half floats cannot hold,
/// count as that number.
#[test]
fn spray_with_too_many_glints_is_finite() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::lit(&gpu, &spraying(size), 1);
    let mut case = Sprayed::new(size, Lens::Standard, 0.0);
    case.shot.densities.as_mut().expect("densities").fill(100.0);
    let place = scenes::world(&case.shot.camera, &[[0.0, 0.0, 4.0]])[0];
    case.shot.positions.fill(place);
    let look = case.look();
    (look.droplets, look.scatter_radius, look.size) = (64, 0.1, 4.0);
    (look.opacity, look.glints) = (1.0 - f32::EPSILON, 64.0);
    for relief in [0.0, 1.5] {
        case.look().relief = relief;
        let drawn = case.draw(&mut rig);
        let lit = drawn.lit_spray.as_ref().expect("a frame with spray");
        let most = lit.data.iter().fold(0.0_f32, |a, b| a.max(*b));
        assert!(most > 70_000.0, "{most}");
        case.check_over(&format!("spray-glints-{relief}"), &drawn, &case.shot.color);
    }
}

/// Spray of opacity 0 is invisible. The test draws it over water and foam, and then checks that
/// visible spray lies over that picture.
#[test]
fn spray_lies_over_water_and_foam() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (shading, foam) in
        [(Shading::Raster, true), (Shading::Compute, true), (Shading::Raster, false)]
    {
        let config = spraying(size).with(|it| {
            it.composite = Some(shading);
            it.surface_foam = foam;
            it.sheets = 2;
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut case = Sprayed::new(size, Lens::Reversed, 10.0);
        case.amounts = foam.then(|| vec![[0.4, 0.3]; case.shot.positions.len()]);
        (case.look().opacity, case.look().mist) = (0.0, 0.0);
        let none = case.draw(&mut rig);
        assert!(of(&none).data.iter().all(|x| *x == 0.0));
        (case.look().opacity, case.look().mist) = (0.9, 0.05);
        for additive in [false, true] {
            case.look().additive = additive;
            let drawn = case.draw(&mut rig);
            let name = format!("spray-water-{shading:?}-{foam}-{additive}");
            compare::same(&name, &drawn.depth, &none.depth);
            case.check_over(&name, &drawn, &none.output.data);
            let both = drawn.depth.data.iter().zip(&of(&drawn).data);
            assert!(both.filter(|(z, x)| **z < 1e9 && **x > 0.1).count() > 100, "{name}");
        }
    }
}

#[test]
fn without_spray_nothing_changes() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut plain = Rig::lit(&gpu, &config(size), 1);
    let mut rig = Rig::lit(&gpu, &spraying(size), 1);
    let mut case = Sprayed::new(size, Lens::Standard, 10.0);
    case.draw(&mut rig);
    // A frame without spray shows nothing of the spray in the frame before.
    for densities in [None, Some(vec![851.0; case.shot.positions.len()])] {
        case.shot.densities = densities;
        let (drawn, expected) = (case.draw(&mut rig), case.draw(&mut plain));
        assert!(of(&drawn).data.iter().all(|x| *x == 0.0) && expected.spray.is_none());
        compare::same("spray-none-depth", &drawn.depth, &expected.depth);
        nearly(&drawn, &expected, "spray-none");
    }
    // In a renderer without spray, no spray setting changes the picture.
    let mut case = Sprayed::new(size, Lens::Standard, 10.0);
    let expected = case.draw(&mut plain);
    *case.look() = SpraySettings::SOURCE.with(|it| {
        [it.all_spray_density, it.full_water_density, it.no_spray_density] = [0.9, 0.95, 1.2]
    });
    let drawn = case.draw(&mut plain);
    compare::same_color("spray-off", &drawn.output, &expected.output);
    compare::same("spray-off-depth", &drawn.depth, &expected.depth);
}

fn pick<T: Copy>(all: &[T], order: &[usize]) -> Vec<T> {
    order.iter().map(|i| all[*i]).collect()
}

/// With the particles in another order and in a part of a larger image, spray is the same except
/// for the order of the sums.
#[test]
fn spray_goes_by_ids_not_by_places() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &spraying(size));
    let case = Sprayed::new(size, Lens::Infinite, 40.0);
    let first = case.draw(&mut rig);
    let (count, _) = case.check("spray-order", &first);
    let order = Random(9).order(case.shot.positions.len());
    let mut mixed = case.clone();
    mixed.shot.margin = [13, 30, 7, 21];
    mixed.shot.positions = pick(&case.shot.positions, &order);
    mixed.shot.densities = case.shot.densities.as_ref().map(|all| pick(all, &order));
    mixed.velocities = case.velocities.as_ref().map(|all| pick(all, &order));
    mixed.ids = case.ids.as_ref().map(|all| pick(all, &order));
    let second = mixed.draw(&mut rig);
    compare::same("spray-order-depth", &second.depth, &first.depth);
    for (i, n) in count.data.iter().enumerate() {
        let [a, b] = [&first, &second].map(|drawn| f64::from(of(drawn).data[i]));
        let [least, most] = Sums::SINGLE.again(a, *n);
        assert!(least <= b && b <= most, "{b} for {a} of {n} in pixel {i}");
        assert!(*n != 1 || a == b, "{b} for {a} in pixel {i}");
    }
    let others = Sprayed { ids: None, ..case.clone() }.draw(&mut rig);
    assert_ne!(of(&others).data, of(&first).data, "the ids show");
    let still = Sprayed { velocities: None, ..case }.draw(&mut rig);
    assert_ne!(of(&still).data, of(&first).data, "the velocities show");
}

/// Frames of odd sizes, as a part of a larger image and smaller than the renderer's extent; also a
/// frame without particles, and one whose particles all lie behind the eye.
#[test]
fn spray_of_any_size() {
    let gpu = Gpu::shared();
    let mut large = Rig::lit(&gpu, &spraying(extent(140, 70)), 1);
    Sprayed::new(extent(140, 70), Lens::Standard, 20.0).draw(&mut large);
    for (width, height) in [(1, 1), (1, 7), (3, 5), (17, 33), (130, 9)] {
        let size = extent(width, height);
        let mut rig = Rig::lit(&gpu, &spraying(size), 1);
        let mut case = Sprayed::new(size, Lens::Reversed, 20.0);
        case.shot.margin = [3, 1, 2, 4];
        for (i, rig) in [&mut rig, &mut large].into_iter().enumerate() {
            let drawn = case.draw(rig);
            case.check(&format!("spray-{width}x{height}-{i}"), &drawn);
        }
        case.shot.densities.as_mut().expect("densities").fill(1.0);
        let drawn = case.draw(&mut rig);
        case.check_over(&format!("spray-{width}x{height}"), &drawn, &case.shot.color);
        // With so few rows a pixel covers a quarter of the view or more, and all particles are too
        // near to be drawn.
        assert!(of(&drawn).data.iter().any(|x| *x > 0.0) == (height > 3), "{width}x{height}");
        let back = vec![[0.0, 0.0, -3.0]; case.shot.positions.len()];
        case.shot.positions = scenes::world(&case.shot.camera, &back);
        let drawn = case.draw(&mut rig);
        assert!(of(&drawn).data.iter().all(|x| *x == 0.0));
        assert_eq!(drawn.output.data, case.shot.color, "{width}x{height}");
        let none = Shot { positions: Vec::new(), densities: Some(Vec::new()), ..case.shot.clone() };
        let none = Sprayed { shot: none, velocities: None, ids: None, ..case };
        assert_eq!(none.draw(&mut rig).output.data, none.shot.color, "{width}x{height}");
    }
}

/// Few droplets in the corners and the middle, with nothing else in their tiles. They are drawn
/// completely at all smoothing levels, and also where near water uses a coarser level.
#[test]
fn tiles_with_spray_alone_are_drawn() {
    let gpu = Gpu::shared();
    let size = extent(263, 150);
    for (shading, smoothing_level, coarsening) in
        [(Shading::Raster, 0, 3), (Shading::Compute, 1, 2), (Shading::Raster, 2, 0)]
    {
        let levels = spraying(size).with(|it| {
            it.smoothing_level = smoothing_level;
            it.coarsening = coarsening;
            it.max_iterations = 3;
        });
        let mut rig = Rig::lit(&gpu, &levels.with(|it| it.composite = Some(shading)), 1);
        let row: Vec<_> = (-30_i8..=30).map(|x| [f32::from(x) / 4.0, 0.9, 2.0]).collect();
        let mut points = row.clone();
        // Droplet positions are given in halves of the view.
        let high = 2.0 * 30.0_f32.to_radians().tan();
        let droplets = [(-0.995, -0.98), (0.995, -0.98), (0.1, -0.5), (-0.6, -0.2), (0.7, -0.7)];
        points.extend(droplets.map(|(x, y)| [x * high * 263.0 / 150.0, y * high, 2.0]));
        let mut case = Sprayed::of(Shot::new(size, Lens::Reversed, 0.4, &points), 0.0);
        let densities = (0..points.len()).map(|i| if i < row.len() { 1000.0 } else { 1.0 });
        case.shot.densities = Some(densities.collect());
        case.shot.settings.water.smoothing_width = 40.0;
        (case.look().size, case.look().scatter_radius, case.look().droplets) = (0.1, 0.1, 4);
        (case.look().opacity, case.look().mist) = (0.0, 0.0);
        let none = case.draw(&mut rig);
        (case.look().opacity, case.look().mist) = (0.9, 0.05);
        let drawn = case.draw(&mut rig);
        let name = format!("spray-tiles-{smoothing_level}-{coarsening}");
        case.check(&name, &drawn);
        case.check_over(&name, &drawn, &none.output.data);
        let (shown, fade) = drawn.levels.shown(2.0, [0.0; 2]);
        assert_eq!((shown as u32, fade), (coarsening, 0.0), "{name}");
        let alone = |i: &usize| drawn.depth.data[*i] >= 1e9 && of(&drawn).data[*i] > 0.01;
        let alone = (0..drawn.depth.data.len()).filter(alone);
        let seen = alone.filter(|i| drawn.output.data[*i] != case.shot.color[*i]).count();
        assert!(seen > 20, "{name}: {seen} pixels");
    }
}

/// Particles beside the picture whose largest droplets reach into it: the list must keep them.
#[test]
fn large_droplets_reach_into_the_picture() {
    let gpu = Gpu::shared();
    let size = extent(120, 90);
    let mut rig = Rig::new(&gpu, &spraying(size));
    let (spacing, depth) = (0.4, 2.0);
    // The mean half-axis of a droplet, and the angle to the left plane of the view. The largest
    // half-axis is less than half of the depth, because larger droplets would not be drawn.
    let mean = 3.0 * 0.656 * spacing / (0.6 * 0.513 * 64.0_f32).sqrt();
    let edge = (30.0_f32.to_radians().tan() * 120.0 / 90.0).atan();
    let beside = |i: u16| {
        // From 2.5 mean half-axes to nearly the largest half-axis, (0.36 + 1.661) / √0.3 = 3.69.
        let (row, away) = (f32::from(i % 10), 2.5 + 0.1 * f32::from(i / 10));
        [-depth * edge.tan() - mean * away / edge.cos(), 0.2 * (row - 4.5), depth]
    };
    let points: Vec<_> = (0..120).map(beside).collect();
    let mut case = Sprayed::of(Shot::new(size, Lens::Standard, spacing * 0.656, &points), 0.0);
    case.shot.densities.as_mut().expect("densities").fill(1.0);
    (case.look().size, case.look().scatter_radius, case.look().droplets) = (3.0, 0.0, 64);
    case.look().mist = 0.0;
    let drawn = case.draw(&mut rig);
    let (_, covered) = case.check("spray-beside", &drawn);
    assert!(covered > 100, "{covered} pixels");
}

/// With a limit, droplets near the eye are smaller. The particles are at distances of 2 to 9.
#[test]
fn droplets_near_the_eye_are_limited() {
    let gpu = Gpu::shared();
    let size = extent(120, 90);
    let mut rig = Rig::new(&gpu, &spraying(size));
    let points: Vec<_> = (0..8_u8)
        .map(|i| {
            let (side, depth) = (f32::from(i % 4) - 1.5, 2.0 + f32::from(i));
            [0.3 * side * depth, 0.2 * (f32::from(i / 4) - 0.5) * depth, depth]
        })
        .collect();
    let mut case = Sprayed::of(Shot::new(size, Lens::Standard, 0.3, &points), 0.0);
    (case.look().size, case.look().droplets, case.look().mist) = (1.0, 16, 0.0);
    let covered = |case: &mut Sprayed, rig: &mut Rig, max_angle: f32| {
        case.look().max_angle = max_angle;
        let drawn = case.draw(rig);
        case.check(&format!("spray-angle-{max_angle}"), &drawn).1
    };
    let [free, limited] = [1.0, 0.02].map(|angle| covered(&mut case, &mut rig, angle));
    assert!(limited > 100 && free > limited + limited / 4, "{free} pixels, limited {limited}");
}

/// A particle that flies straight at the eye is drawn as if at rest, at any speed: its motion
/// across the view is only rounding error and must not become a direction.
#[test]
fn straight_at_the_eye_spray_is_round() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &spraying(size));
    let mut random = Random(3);
    for i in 0..12 {
        let d = random.between(2.0, 9.0);
        let at = [random.between(-0.7, 0.7) * d, random.between(-0.4, 0.4) * d, d];
        let mut case = Sprayed::of(Shot::new(size, Lens::Standard, 0.2, &[at]), 0.0);
        case.shot.densities = Some(vec![1.0]);
        (case.look().size, case.look().droplets, case.look().scatter_radius) = (2.0, 1, 0.0);
        let eye = case.shot.camera_view().inverse().w_axis.truncate();
        let away = eye - DVec3::from(case.shot.positions[0].map(f64::from));
        for speed in [0.0, 0.1, 1.0, 10.0] {
            case.velocities = Some(vec![(speed * away).as_vec3().to_array()]);
            let drawn = case.draw(&mut rig);
            case.check(&format!("spray-straight-{i}-{speed}"), &drawn);
        }
    }
}

/// Stripes of shade fall on spray. Each droplet is lit at its own position, so one particle has
/// dark and bright droplets.
#[test]
fn each_droplet_has_its_own_sun() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let config = spraying(size).with(|it| it.shadow = Some(Shadows::Map));
    let mut rig = Rig::lit(&gpu, &config, 1);
    for (lens, droplets, scattering) in
        [(Lens::Standard, 16, 0.0), (Lens::OffAxis, 40, 0.6), (Lens::Reversed, 1, 1.0)]
    {
        let mut case = Sprayed::new(size, lens, 20.0);
        (case.look().scattering, case.look().glints) = (scattering, 24.0);
        (case.look().droplets, case.look().scatter_radius) = (droplets, 8.0);
        let middle = Vec3::from(scenes::world(&case.shot.camera, &[[0.0, 0.0, 5.0]])[0]);
        let sun = Vec3::new(0.5, 0.8, 0.3).normalize();
        let light = Mat4::look_at_rh(middle + 20.0 * sun, middle, Vec3::Y);
        let view_projection = Mat4::orthographic_rh(-9.0, 9.0, -9.0, 9.0, 1.0, 40.0) * light;
        // A stripe is wider than the comparison's filter, and narrower than the distance between a
        // particle's droplets.
        let map = Image::from_fn(96, 96, |x, y| f32::from(u8::from((x + y / 2) / 5 % 2 == 0)));
        let image = shadows(&rig, Shadows::Map, &map);
        case.shot.settings.light.direction = sun.to_array();
        case.shot.shadow = Some(
            Shadow::new(image.host_image(), view_projection.to_cols_array_2d())
                .with(|it| it.bias = 0.05),
        );
        let drawn = case.draw(&mut rig);
        let found = drawn.lit_spray.as_ref().expect("spray in the sun");

        let (view, scene) = (case.shot.view(size), case.shot.scene_at(size, 0));
        let shade = ShadowMap {
            depth: &map,
            view_projection: view_projection.as_dmat4(),
            bias: f64::from(0.05_f32),
            sun: sun.as_dvec3(),
            reversed: false,
        };
        let spray = |sun: &spray::Sun<'_>| {
            let (particles, water) = (case.particles(&drawn), wide(&drawn.depth));
            spray::spray_in_sun(&particles, &view, &case.settings(), &scene, &water, sun)
        };
        let kinds = RefCell::new(HashMap::<u32, [u32; 2]>::new());
        let twin = spray(&|particle, p, by| {
            let past = shade.past(p, by);
            let mut kinds = kinds.borrow_mut();
            let kinds = kinds.entry(particle.id).or_default();
            kinds[0] += u32::from(past.v < 0.1);
            kinds[1] += u32::from(past.v > 0.9);
            past
        });
        let name = format!("own-sun-{lens:?}-{droplets}");
        compare::between(&name, of(&drawn), &twin.bounds);
        compare::between(&name, found, &twin.lit);
        let mixed = kinds.into_inner().into_values().filter(|n| n.iter().all(|n| *n > 0)).count();
        // About a hundred particles have spray.
        assert!(mixed > 30 || droplets == 1, "{name}: {mixed} particles in sun and shade");
        let by_particle = spray(&|particle, _, by| shade.past(particle.position, by));
        let other = fails(|| compare::between("planted-own-sun", found, &by_particle.lit));
        assert!(other, "{name}: as if all droplets of a particle were lit alike");
    }
}

/// Torn water: a cloud, a sheet seen edge-on, a sheet seen from the front, a strand, a pair and
/// single particles.
fn torn(size: ash::vk::Extent2D, lens: Lens, fastest: f32) -> Sprayed {
    let mut shot = Shot::new(size, lens, 0.1, &scenes::cloud(31, 60, 2.0, 9.0));
    let before = facing(&shot);
    let edge = before * DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2);
    for (middle, turn, steps) in [
        ([-1.1, 0.6, 4.0], edge, [4, 4, 0]),
        ([0.9, -0.7, 4.0], before, [4, 3, 0]),
        ([0.7, 0.7, 3.5], askew(), [8, 0, 0]),
        ([-0.9, -0.9, 5.0], askew(), [0, 1, 0]),
    ] {
        shot.positions.extend(lattice(&shot, middle, turn, steps));
    }
    let mut case = Sprayed::of(shot, fastest);
    let look = case.look();
    (look.droplets, look.strand_ratio, look.scatter_radius) = (16, 6.0, 1.5);
    (look.mist, look.mist_size) = (0.6, 2.0);
    case
}

fn shaped(size: ash::vk::Extent2D) -> Config {
    spraying(size).with(|it| it.kernels = Kernels::Ellipsoids)
}

/// Droplets fill the ellipsoids that pass `shape` found, and mist is the ellipsoids' projection. A
/// particle with a single droplet is drawn as without shapes.
#[test]
fn shaped_spray_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &shaped(size));
    for lens in LENSES {
        for (droplets, fastest, strand_ratio, clumps) in
            [(16, 30.0, 6.0, 0.0), (16, 0.0, 8.0, 2.0), (24, 90.0, 2.0, 1.0), (1, 30.0, 6.0, 0.0)]
        {
            let mut case = torn(size, lens, fastest);
            let look = case.look();
            (look.droplets, look.strand_ratio) = (droplets, strand_ratio);
            (look.clumps, look.exposure) = (clumps, 0.02);
            let name = format!("spray-shaped-{lens:?}-{droplets}-{fastest}");
            let drawn = case.draw(&mut rig);
            let (_, covered) = case.check(&name, &drawn);
            assert!(covered > 800, "{name}: {covered} pixels");
            // Spray drawn as balls differs.
            let balls = Drawn { shapes: None, ..drawn };
            let other = fails(|| {
                case.check("planted-balls", &balls);
            });
            assert_eq!(other, droplets > 1, "{name}: as if all were balls");
        }
    }
}

/// A strand ratio of 1, and spheres with any ratio, give the spray of a renderer without shapes, to
/// the bit.
#[test]
fn round_spray_is_as_without_shapes() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut ellipsoids = Rig::new(&gpu, &shaped(size));
    let mut spheres = Rig::new(&gpu, &spraying(size));
    let mut case = torn(size, Lens::Standard, 20.0);
    // No particle is dense enough to be water, because water's ellipsoids would hide other spray
    // than its spheres do.
    let mut random = Random(2);
    let densities = case.shot.densities.as_mut().expect("densities");
    densities.iter_mut().for_each(|d| *d = random.between(1.0, 600.0));
    case.look().clumps = 1.0;
    let long = case.draw(&mut ellipsoids);
    let round = case.draw(&mut spheres);
    assert!(of(&long).data != of(&round).data, "strands show");
    case.look().strand_ratio = 1.0;
    let found = case.draw(&mut ellipsoids);
    compare::same("spray-round", of(&found), of(&round));
    compare::same("spray-round-spheres", of(&case.draw(&mut spheres)), of(&round));
}

/// Mist of a sheet seen edge-on is as much wider than high as its ellipsoid. With ratio r the
/// half-axes are 1 : 1 : 1/r; the test measures the image's variances, which are proportional to
/// their squares.
#[test]
fn mist_of_a_sheet_is_flat() {
    let gpu = Gpu::shared();
    let size = extent(160, 120);
    let mut rig = Rig::new(&gpu, &shaped(size));
    let mut shot = Shot::new(size, Lens::Standard, 0.2, &[]);
    let edge = facing(&shot) * DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2);
    shot.positions = lattice(&shot, [0.0, 0.0, 3.0], edge, [4, 4, 0]);
    let middle = shot.positions.len() / 2;
    let mut case = Sprayed::of(shot, 0.0);
    // The other particles are water, too thin to hide the mist.
    let densities = case.shot.densities.as_mut().expect("densities");
    densities.fill(0.0);
    densities[middle] = 100.0;
    let look = case.look();
    (look.droplets, look.opacity, look.scatter_radius) = (2, 0.0, 0.0);
    (look.mist, look.mist_size) = (0.9, 2.0);
    for (ratio, expected) in [(1.0, 1.0), (4.0, 4.0), (8.0, 8.0)] {
        case.look().strand_ratio = ratio;
        let drawn = case.draw(&mut rig);
        let image = of(&drawn);
        let mut sums = [0.0; 5];
        for (i, x) in image.data.iter().enumerate() {
            let (at, amount) = ([i % 160, i / 160].map(|n| n as f64), f64::from(*x));
            sums[0] += amount;
            for k in 0..2 {
                sums[1 + k] += amount * at[k];
                sums[3 + k] += amount * at[k] * at[k];
            }
        }
        let variance = |k: usize| sums[3 + k] / sums[0] - (sums[1 + k] / sums[0]).powi(2);
        let found = (variance(0) / variance(1)).sqrt();
        assert!((found / expected - 1.0).abs() < 0.03, "{ratio}: {found}");
    }
}

/// A dense strip of spray lies in thin spray. Relief darkens the thin spray on the side of the
/// strip away from the sun, and not on the side towards the sun. Without relief, and in even spray,
/// nothing changes.
#[test]
fn relief_shades_the_side_away_from_the_sun() {
    let gpu = Gpu::shared();
    let size = extent(200, 180);
    for shading in [Shading::Raster, Shading::Compute] {
        let config = spraying(size).with(|it| {
            it.composite = Some(shading);
            it.max_particles = 1 << 15;
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut shot = Shot::new(size, Lens::Standard, 0.05, &[]);
        shot.color.fill([0.0, 0.0, 0.0, 1.0]);
        // Each particle has one droplet of many pixels, so the spray is even except for the strip.
        let grid = |x: std::ops::RangeInclusive<i16>, step: f32| {
            let row = move |y: i16| {
                x.clone().map(move |x| [f32::from(x) * step, f32::from(y) * step, 6.0])
            };
            (-60..=60).flat_map(row).collect::<Vec<_>>()
        };
        let (even, strip) = (grid(-70..=70, 0.1), grid(-4..=4, 0.04));
        for (sun, side) in [([1.0_f32, 0.3, 0.2], 1.0), ([-1.0, 0.3, 0.2], -1.0)] {
            let mut light = |points: &[[f32; 3]], relief: f32| {
                let mut case = shot.clone();
                case.positions = scenes::world(&case.camera, points);
                case.densities = Some(vec![1.0; points.len()]);
                let eye = case.camera_view().inverse();
                let sun = eye.transform_vector3(DVec3::from(sun.map(f64::from)));
                case.settings.light.direction = sun.normalize().as_vec3().to_array();
                let look = &mut case.settings.spray;
                (look.droplets, look.size, look.opacity) = (1, 6.0, 0.03);
                (look.scatter_radius, look.relief) = (0.0, relief);
                let cloud = rig.particles(&case);
                let drawn = rig.draw_particles(&case, &cloud.particles());
                // Radiance of the spray: mean over the middle rows.
                let row = |x: usize| {
                    let all = (80..100).map(|y| {
                        let kept = (-of(&drawn).at(x, y)).exp();
                        drawn.output.at(x, y)[0] / (1.0 - kept)
                    });
                    all.sum::<f32>() / 20.0
                };
                (0..200).map(row).collect::<Vec<f32>>()
            };
            let all: Vec<_> = even.iter().chain(&strip).copied().collect();
            let (without, with) = (light(&all, 0.0), light(&all, 1.5));
            let smooth = (light(&even, 0.0), light(&even, 1.5));
            let name = format!("{shading:?} {side}");
            // Column at a distance from the strip's middle, positive away from the sun. This lens
            // does not mirror the picture.
            let at = |all: &[f32], away: f32| all[(99.5 - side * away) as usize];
            let lost = |away| at(&with, away) / at(&without, away);
            let sides = [6.0, 8.0, 10.0, 12.0, 14.0].map(|d| [lost(d), lost(-d)]);
            assert!(sides.iter().all(|[_, toward]| *toward > 0.99), "{name}: {sides:?}");
            let least = sides.iter().map(|[away, _]| *away).fold(1.0, f32::min);
            assert!(least < 0.8, "{name}: {sides:?}");
            let worst = smooth.0.iter().zip(&smooth.1).skip(40).take(120);
            let worst = worst.map(|(a, b)| (b / a - 1.0).abs()).fold(0.0, f32::max);
            assert!(worst < 0.03, "{name}: even spray changes by {worst}");
        }
    }
}
