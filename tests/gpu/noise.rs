//! Compares pass `noise`, the baseline's surface noise, with its CPU twin, and checks the picture
//! with this noise.

use glam::{DVec3, Mat4, Vec3};
use whitewater::water::{Bed, Rule, Shading, SurfaceNoiseSettings};
use whitewater::{Camera, Config};

use crate::composite::{FLAT, SKY, Sky, check, check_told, on_bed};
use crate::harness::fails;
use crate::reduce::wide;
use crate::reference::Image;
use crate::reference::noise::{self, Particle};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent, stream};
use crate::support::scenes::{self, LENSES, Lens, Random};

const STORAGE: ash::vk::BufferUsageFlags = ash::vk::BufferUsageFlags::STORAGE_BUFFER;

fn noisy(size: ash::vk::Extent2D, level: u32) -> Config {
    config(size).with(|it| it.noise = Some(level))
}

/// A shot with particle ids.
#[derive(Clone)]
struct Noisy {
    shot: Shot,
    ids: Option<Vec<u32>>,
}

impl Noisy {
    /// A block, and drops before, beside and behind it. Some particles are spray.
    fn new(size: ash::vk::Extent2D, lens: Lens) -> Self {
        let mut points = scenes::block(3, 0.25, [14, 8, 4], [-1.8, -1.0, 4.0]);
        points.extend(scenes::cloud(4, 40, 0.05, 12.0));
        Self::of(Shot::new(size, lens, 0.2, &points))
    }

    fn of(mut shot: Shot) -> Self {
        let (mut random, count) = (Random(5), shot.positions.len());
        let density = |i: usize| [1000.0, 300.0, 0.0, 400.0, 900.0][i * 7 % 5];
        shot.densities = Some((0..count).map(density).collect());
        let ids = Some((0..count).map(|_| random.bits() as u32).collect());
        Self { shot, ids }
    }

    fn look(&mut self) -> &mut SurfaceNoiseSettings {
        &mut self.shot.settings.noise
    }

    fn draw(&self, rig: &mut Rig<'_>) -> Drawn {
        let cloud = rig.particles(&self.shot);
        let ids = self.ids.as_ref().map(|ids| rig.stub.data(bytemuck::cast_slice(ids), STORAGE));
        let ids = ids.as_ref().map(|ids| stream(ids, 0, 4));
        rig.draw_particles(&self.shot, &cloud.particles().with(|it| it.ids = ids))
    }

    /// The particles as the twin takes them.
    fn particles(&self) -> Vec<Particle> {
        let rest = f64::from(self.shot.settings.water.rest_density);
        let density = |i: usize| self.shot.densities.as_ref().map_or(0.0, |all| f64::from(all[i]));
        let particle = |(i, p): (usize, &[f32; 3])| Particle {
            position: DVec3::from(p.map(f64::from)),
            density: density(i) / rest,
            id: self.ids.as_ref().map_or(i as u32, |ids| ids[i]),
        };
        self.shot.positions.iter().enumerate().map(particle).collect()
    }

    fn settings(&self) -> noise::Settings {
        let (look, water) = (&self.shot.settings.noise, &self.shot.settings.water);
        noise::Settings {
            spacing: f64::from(water.spacing),
            threshold: f64::from(water.density_threshold),
            falloff: f64::from(look.falloff),
            size: f64::from(look.size),
            cells: f64::from(look.cells),
        }
    }

    /// Checks the noise against the twin. Returns how many texels have noise.
    fn check(&self, name: &str, level: u32, drawn: &Drawn) -> usize {
        self.check_other(name, level, drawn, &self.settings())
    }

    /// Checks the noise against a twin with other settings. Returns how many texels have noise.
    fn check_other(&self, name: &str, level: u32, drawn: &Drawn, by: &noise::Settings) -> usize {
        let view = self.shot.view(self.shot.size);
        let twin = noise::noise(&self.particles(), &view, by, &wide(&drawn.depth), level);
        compare::between(name, of(drawn), &twin.bounds);
        if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
            let (low, high) = (&twin.bounds.low.data, &twin.bounds.high.data);
            let mut widths: Vec<f64> = low.iter().zip(high).map(|(l, h)| h - l).collect();
            widths.retain(|w| *w > 0.0);
            widths.sort_by(f64::total_cmp);
            let at = |part: f64| widths.get((part * widths.len() as f64) as usize);
            let most = twin.count.data.iter().max();
            eprintln!("{name}: {:?} to {:?} wide, {most:?} addends", at(0.5), at(0.95));
        }
        of(drawn).data.iter().filter(|n| **n != 0.0).count()
    }
}

fn of(drawn: &Drawn) -> &Image<f32> {
    drawn.noise.as_ref().expect("a frame with noise")
}

#[test]
fn noise_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for level in 0..4 {
        let mut rig = Rig::new(&gpu, &noisy(size, level));
        for lens in LENSES {
            let mut case = Noisy::new(size, lens);
            if lens == Lens::Infinite {
                case.ids = None;
            }
            let name = format!("noise-{lens:?}-{level}");
            let drawn = case.draw(&mut rig);
            let covered = case.check(&name, level, &drawn);
            assert!(covered << (2 * level) > 1500, "{name}: {covered} texels");
            // Where the scene hides the water there is no noise.
            case.shot.scene_depth(|x, y| ((x / 9 + y / 5) % 2 == 0).then_some(4.0));
            let cut = case.draw(&mut rig);
            let left = case.check(&format!("{name}-cut"), level, &cut);
            assert!(left < covered, "{name}: {left} of {covered} texels");
        }
    }
}

type Change = (&'static str, fn(&mut SurfaceNoiseSettings));

const CHANGES: [Change; 8] = [
    ("falloff-0", |look| look.falloff = 0.0),
    ("falloff-half", |look| look.falloff = 0.5),
    ("falloff-64", |look| look.falloff = 64.0),
    ("size-1", |look| look.size = 1.0),
    ("size-8", |look| look.size = 8.0),
    ("cells-least", |look| look.cells = 1e-3),
    ("cells-16", |look| look.cells = 16.0),
    ("size-least", |look| look.size = 1e-3),
];

/// Every setting at both ends of its range, particles around the eye and at invalid positions, a
/// deep block, and several chunks.
#[test]
fn noise_of_all_settings_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &noisy(size, 1).with(|it| it.max_stride = 1 << 20));
    for (name, change) in CHANGES {
        for deep in [false, true] {
            let mut case = Noisy::new(size, Lens::OffAxis);
            if deep {
                let points = scenes::block(9, 0.24, [12, 8, 9], [-1.4, -0.9, 2.0]);
                case = Noisy::of(Shot::new(size, Lens::Standard, 0.16, &points));
                case.shot.densities = None;
            }
            case.shot.positions[1][0] = f32::NAN;
            case.shot.positions[5][2] = -2e18;
            change(case.look());
            let drawn = case.draw(&mut rig);
            let covered = case.check(&format!("noise-{name}-{deep}"), 1, &drawn);
            assert_eq!(covered > 100, name != "size-least", "{name}: {covered} texels");
        }
    }
}

/// The comparison with the twin detects a change of each number by a hundredth.
#[test]
fn a_hundredth_of_the_noise_is_seen() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &noisy(size, 1));
    let case = Noisy::new(size, Lens::Standard);
    let drawn = case.draw(&mut rig);
    let settings = case.settings();
    type Fault = fn(&mut noise::Settings);
    let faults: [(&str, Fault); 4] = [
        ("falloff", |s| s.falloff *= 1.01),
        ("size", |s| s.size *= 1.01),
        ("cells", |s| s.cells *= 1.01),
        ("spacing", |s| s.spacing *= 1.01),
    ];
    for (name, fault) in faults {
        let mut wrong = settings;
        fault(&mut wrong);
        let seen = fails(|| {
            case.check_other("planted-noise", 1, &drawn, &wrong);
        });
        assert!(seen, "{name} off by a hundredth");
    }
    let others = Noisy { ids: None, ..case.clone() };
    let seen = fails(|| {
        others.check("planted-noise", 1, &drawn);
    });
    assert!(seen, "other ids");
}

fn pick<T: Copy>(all: &[T], order: &[usize]) -> Vec<T> {
    order.iter().map(|i| all[*i]).collect()
}

/// With the particles in another order and in a part of a larger image, noise and picture are the
/// same, bit for bit.
#[test]
fn noise_goes_by_ids_not_by_places() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::lit(&gpu, &config(size).with(|it| it.noise = Some(1)), 1);
    let mut case = Noisy::new(size, Lens::Standard);
    *case.look() = SurfaceNoiseSettings::SOURCE;
    let first = case.draw(&mut rig);
    let order = Random(9).order(case.shot.positions.len());
    let mut mixed = case.clone();
    mixed.shot.margin = [13, 30, 7, 21];
    mixed.shot.positions = pick(&case.shot.positions, &order);
    mixed.shot.densities = case.shot.densities.as_ref().map(|all| pick(all, &order));
    mixed.ids = case.ids.as_ref().map(|all| pick(all, &order));
    let second = mixed.draw(&mut rig);
    compare::same("noise-order", of(&second), of(&first));
    let plain = Noisy { shot: Shot { margin: [0; 4], ..mixed.shot.clone() }, ..mixed };
    let third = plain.draw(&mut rig);
    compare::same_color("noise-order-picture", &third.output, &first.output);
}

/// Noise moves with the particles and the camera when both move alike, because the lattice is in
/// the particles' space. All are moved by exact floats, so eye-space positions differ only by
/// rounding.
#[test]
fn noise_moves_with_its_particles() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &noisy(size, 1));
    let mut case = Noisy::new(size, Lens::Standard);
    // Positions are rounded to 1/8192, so that the sum with the offset is exact.
    let round = |v: f32| (v * 8192.0).round() / 8192.0;
    case.shot.positions.iter_mut().for_each(|p| *p = p.map(round));
    let first = case.draw(&mut rig);
    let mut moved = case.clone();
    let by = Vec3::new(3.25, -1.5, 2.75);
    moved.shot.positions.iter_mut().for_each(|p| *p = (Vec3::from(*p) + by).to_array());
    let view = case.shot.camera.view_matrix() * Mat4::from_translation(-by);
    moved.shot.camera = Camera { view: view.to_cols_array_2d(), ..case.shot.camera };
    let second = moved.draw(&mut rig);
    // Both pictures lie within their bounds, and where the surface is the same they differ only by
    // rounding.
    moved.check("noise-moved", 1, &second);
    let pairs = of(&first).data.iter().zip(&of(&second).data);
    let (mut same, mut some) = (0, 0);
    for (a, b) in pairs.filter(|(a, b)| **a != 0.0 || **b != 0.0) {
        some += 1;
        same += usize::from((a - b).abs() < 2e-3);
    }
    // At a sphere's rim, rounding may move the edge to another pixel.
    assert!(some > 300 && same * 50 > some * 49, "{same} of {some} texels");
    // If only the particles move, the camera sees another part of the pattern.
    let mut left = moved.clone();
    left.shot.camera = case.shot.camera;
    let third = left.draw(&mut rig);
    assert_ne!(of(&third).data, of(&first).data);
}

/// Normals and foam are the twin's, with one sheet, at every level and with both kinds of shading.
/// (The sky is uniform, because steep ripples also mirror the cube's edges, where lavapipe filters
/// within one face only.)
#[test]
fn the_picture_with_noise_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (level, smoothing_level) in [(1, 1), (0, 1), (2, 0), (3, 1), (1, 2)] {
        for (shading, flat) in [(Shading::Raster, true), (Shading::Compute, false)] {
            let config = noisy(size, level).with(|it| {
                it.composite = Some(shading);
                it.smoothing_level = smoothing_level;
                it.coarsening = 0;
            });
            let mut rig = Rig::new(&gpu, &config);
            rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
            for (lens, weight, foam) in [
                (Lens::Standard, 0.336, 0.0),
                (Lens::OffAxis, 0.336, 3.0),
                (Lens::Mirrored, 2.0, 0.0),
                (Lens::LeftHanded, 0.0, 64.0),
            ] {
                let mut case = Noisy::new(size, lens);
                case.shot.settings.water.shininess = 20.0;
                if flat {
                    case.shot.color.fill(FLAT);
                }
                *case.look() = SurfaceNoiseSettings::default().with(|it| {
                    it.weight = weight;
                    it.foam = foam;
                    it.color = [0.5, 0.4, 0.3];
                });
                let name = format!("noise-picture-{level}-{smoothing_level}-{lens:?}");
                check(&name, &mut rig, &case.shot, Sky::Even);
            }
        }
    }
}

/// Noise that water on the scene lacks, over a bed that slopes away, with one sheet.
#[test]
fn noise_in_the_air_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &noisy(size, 1).with(|it| it.coarsening = 0));
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    let of = |lens: Lens, airborne: f32| {
        let mut case = Noisy::of(on_bed(size, lens));
        *case.look() = SurfaceNoiseSettings::default().with(|it| it.airborne = airborne);
        case
    };
    for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
        let pictures = [0.0, 0.6, 1.0].map(|airborne| {
            let case = of(lens, airborne);
            check(&format!("noise-air-{lens:?}-{airborne}"), &mut rig, &case.shot, Sky::Even);
            case.draw(&mut rig).output.data
        });
        assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2], "{lens:?}");
        // A bed that is never under water takes nothing away.
        let mut dry = |airborne: f32| {
            let mut case = of(lens, airborne);
            case.shot.settings.water.bed = Bed::Source;
            case.draw(&mut rig).output.data
        };
        assert_eq!(dry(0.0), dry(1.0), "{lens:?}");
    }
    // The comparison detects a change by a hundredth.
    let case = of(Lens::Standard, 0.5);
    let mut told = case.clone();
    told.look().airborne *= 1.01;
    let seen = fails(|| {
        check_told("planted-noise-air", &mut rig, &case.shot, &told.shot, Sky::Even, |_| ());
    });
    assert!(seen, "airborne off by a hundredth");
}

/// A change of the look by a hundredth is detected in the picture.
#[test]
fn a_hundredth_of_the_ripples_is_seen() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &noisy(size, 1).with(|it| it.coarsening = 0));
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    let mut case = Noisy::new(size, Lens::Standard);
    case.shot.settings.water.shininess = 20.0;
    case.shot.color.fill(FLAT);
    *case.look() = SurfaceNoiseSettings::default().with(|it| it.foam = 1.0);
    check("planted-ripples", &mut rig, &case.shot, Sky::Even);
    type Fault = fn(&mut SurfaceNoiseSettings);
    let faults: [(&str, Fault); 3] = [
        ("weight", |look| look.weight *= 1.01),
        ("foam", |look| look.foam *= 1.01),
        ("color", |look| look.color[1] *= 1.01),
    ];
    for (name, fault) in faults {
        let mut told = case.clone();
        fault(told.look());
        let seen = fails(|| {
            check_told("planted-ripples", &mut rig, &case.shot, &told.shot, Sky::Even, |_| ());
        });
        assert!(seen, "{name} off by a hundredth");
    }
}

/// With weight 0 and foam 0 the picture is that without the pass, bit for bit. In a renderer
/// without the pass, no setting matters.
#[test]
fn without_weight_nothing_changes() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (shading, sheets) in [(Shading::Raster, 1), (Shading::Compute, 2)] {
        let plain = config(size).with(|it| {
            it.composite = Some(shading);
            it.sheets = sheets;
            it.rule = Rule::Fixed(40);
        });
        let mut off = Rig::lit(&gpu, &plain, 1);
        let mut on = Rig::lit(&gpu, &plain.with(|it| it.noise = Some(1)), 1);
        let mut case = Noisy::new(size, Lens::Standard);
        *case.look() = SurfaceNoiseSettings::SOURCE;
        let expected = case.draw(&mut off);
        assert!(expected.noise.is_none());
        let drawn = case.draw(&mut on);
        assert_ne!(drawn.output.data, expected.output.data, "the noise shows");
        compare::same("noise-off-depth", &drawn.depth, &expected.depth);
        (case.look().weight, case.look().foam) = (0.0, 0.0);
        let name = format!("noise-off-{shading:?}-{sheets}");
        compare::same_color(&name, &case.draw(&mut on).output, &expected.output);
        compare::same_color(&name, &case.draw(&mut off).output, &expected.output);
    }
}

/// Frames of odd sizes, as a part of a larger image and smaller than the renderer's extent; frames
/// without particles, and with all particles behind the eye.
#[test]
fn noise_of_any_size() {
    let gpu = Gpu::shared();
    let mut large = Rig::lit(&gpu, &noisy(extent(140, 70), 1), 1);
    Noisy::new(extent(140, 70), Lens::Standard).draw(&mut large);
    for (width, height) in [(1, 1), (1, 7), (3, 5), (17, 33), (130, 9)] {
        let size = extent(width, height);
        let mut rig = Rig::lit(&gpu, &noisy(size, 1), 1);
        let mut case = Noisy::new(size, Lens::Reversed);
        case.shot.margin = [3, 1, 2, 4];
        for (i, rig) in [&mut rig, &mut large].into_iter().enumerate() {
            let drawn = case.draw(rig);
            case.check(&format!("noise-{width}x{height}-{i}"), 1, &drawn);
        }
        let back = vec![[0.0, 0.0, -3.0]; case.shot.positions.len()];
        case.shot.positions = scenes::world(&case.shot.camera, &back);
        let drawn = case.draw(&mut rig);
        assert!(of(&drawn).data.iter().all(|n| *n == 0.0));
        assert_eq!(drawn.output.data, case.shot.color, "{width}x{height}");
        let none = Shot { positions: Vec::new(), densities: None, ..case.shot.clone() };
        let none = Noisy { shot: none, ids: None };
        assert_eq!(none.draw(&mut rig).output.data, none.shot.color, "{width}x{height}");
    }
}
