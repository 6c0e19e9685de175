//! Compares the sprites of pass `surface_foam` with the CPU twin, and checks that foam is not drawn
//! as water.

pub mod picture;
mod source;

use glam::DVec3;
use whitewater::water::{Shading, Splat, SurfaceFoamSettings};
use whitewater::{Config, Particles};

use crate::depth::spheres;
use crate::reference::surface_foam::{self, Pattern, Sprite};
use crate::reference::{EMPTY, Image, is_surface, smoothstep};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::Data;
use crate::support::rig::{Cloud, Drawn, Foaming, Rig, Shot, config, extent, stream};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::support::tolerance::{self, Between, Sum, U};

const STORAGE: ash::vk::BufferUsageFlags = ash::vk::BufferUsageFlags::STORAGE_BUFFER;

fn foaming(size: ash::vk::Extent2D) -> Config {
    config(size).with(|it| it.surface_foam = true)
}

/// A shot with foam.
#[derive(Clone)]
pub struct Foamy {
    pub shot: Shot,
    /// Amount and age of foam per particle.
    pub amounts: Vec<[f32; 2]>,
    /// Velocities in world space, metres per second.
    pub velocities: Vec<[f32; 3]>,
    pub ids: Option<Vec<u32>>,
}

/// The buffers of a shot's attributes.
pub struct Streams {
    cloud: Cloud,
    amounts: Data,
    velocities: Data,
    ids: Option<Data>,
}

impl Streams {
    pub fn particles(&self) -> Particles {
        self.cloud.particles().with(|it| {
            it.surface_foam = Some(stream(&self.amounts, 0, 8));
            it.velocities = Some(stream(&self.velocities, 0, 12));
            it.ids = self.ids.as_ref().map(|ids| stream(ids, 0, 4));
        })
    }
}

impl Foamy {
    /// Particles with all amounts of foam, at all speeds up to `fastest` spacings per second.
    pub fn new(size: ash::vk::Extent2D, lens: Lens, fastest: f32) -> Self {
        let mut shot = Shot::new(size, lens, 0.2, &scenes::cloud(31, 160, 2.0, 9.0));
        // At this time both phases of the pattern have weight.
        shot.settings.surface_foam.time = 1.13;
        let mut random = Random(5);
        let most = fastest * shot.settings.water.spacing / 3.0_f32.sqrt();
        let count = shot.positions.len();
        let velocities = (0..count).map(|_| [0; 3].map(|_| random.between(-most, most))).collect();
        let amounts = (0..count)
            .map(|i| match i % 8 {
                0 => [0.0, 0.0],
                1 => [1.0, random.between(0.0, 9.0)],
                _ => [random.between(0.0, 1.0), random.between(0.0, 3.0)],
            })
            .collect();
        let ids = Some((0..count).map(|_| random.bits() as u32).collect());
        Self { shot, amounts, velocities, ids }
    }

    pub fn streams(&self, rig: &Rig<'_>) -> Streams {
        let data = |bytes: &[u8]| rig.stub.data(bytes, STORAGE);
        Streams {
            cloud: rig.particles(&self.shot),
            amounts: data(bytemuck::cast_slice(&self.amounts)),
            velocities: data(bytemuck::cast_slice(&self.velocities)),
            ids: self.ids.as_ref().map(|ids| data(bytemuck::cast_slice(ids))),
        }
    }

    pub fn draw(&self, rig: &mut Rig<'_>) -> Drawn {
        let streams = self.streams(rig);
        rig.draw_particles(&self.shot, &streams.particles())
    }

    /// Gives the particles densities from spray to water; those of some are invalid. The
    /// ramp is a power of two wide and has eight steps, and amounts are short binary fractions, so
    /// that the products with the amounts are exact.
    fn torn(&mut self) {
        let water = &mut self.shot.settings.water;
        (water.rest_density, water.density_threshold, water.density_full) = (1024.0, 0.25, 0.75);
        let density = |i: usize| match i % 11 {
            9 => f32::NAN,
            10 => 0.0,
            k => 256.0 + 64.0 * k as f32,
        };
        self.shot.densities = Some((0..self.amounts.len()).map(density).collect());
        self.amounts.iter_mut().for_each(|a| a[0] = (1024.0 * a[0]).round() / 1024.0);
    }

    /// Part of a particle that is not spray, in a frame without spray. Densities that are not above
    /// 0 are no densities.
    fn bulk(&self, particle: usize) -> f64 {
        let water = &self.shot.settings.water;
        let ends = [water.density_threshold, water.density_full]
            .map(|part| f64::from(part) * f64::from(water.rest_density));
        let density = self.shot.densities.as_ref().map(|d| f64::from(d[particle]));
        density.filter(|d| *d > 0.0).map_or(1.0, |d| smoothstep(ends[0], ends[1], d))
    }

    /// The sprites as the twin takes them, in a frame without spray.
    pub fn sprites(&self) -> Vec<Sprite> {
        let view = self.shot.camera_view();
        let wide = |v: &[f32; 3]| DVec3::from(v.map(f64::from));
        (0..self.amounts.len())
            .map(|i| Sprite {
                center: view.transform_point3(wide(&self.shot.positions[i])),
                foam: f64::from(self.amounts[i][0]).clamp(0.0, 1.0) * self.bulk(i),
                velocity: view.transform_vector3(wide(&self.velocities[i])),
                age: f64::from(self.amounts[i][1]),
                id: self.ids.as_ref().map_or(i as u32, |ids| ids[i]),
                sun: [1.0; 2],
            })
            .collect()
    }

    pub fn settings(&self) -> surface_foam::Settings {
        let (look, spacing) = (&self.shot.settings.surface_foam, self.shot.settings.water.spacing);
        surface_foam::Settings {
            spacing: f64::from(spacing),
            motion_threshold: f64::from(look.motion_threshold),
            front_depth: f64::from(look.front_depth),
            noise: f64::from(look.noise),
            noise_rate: f64::from(look.noise_rate),
            pattern: (look.pattern > 0.0).then(|| pattern(look)),
            step: f64::from(spacing).log2().floor().exp2() / 2048.0,
        }
    }
}

/// The pattern that moves with the foam, as the twin takes it.
pub fn pattern(look: &SurfaceFoamSettings) -> Pattern {
    Pattern {
        strength: f64::from(look.pattern),
        size: f64::from(look.pattern_size),
        period: f64::from(look.pattern_period),
        time: look.time,
    }
}

fn of(drawn: &Drawn) -> &Foaming {
    drawn.foam.as_ref().expect("a frame with foam")
}

fn wide(image: &Image<f32>) -> Image<f64> {
    image.map(|d| if *d < 1e9 { f64::from(*d) } else { EMPTY })
}

/// Checks that a frame's depth and thicknesses are the twin's.
fn check(name: &str, case: &Foamy, drawn: &Drawn, level: u32) {
    check_sprites(name, case, &case.sprites(), drawn, level);
}

/// Checks that a frame's depth and thicknesses are the twin's for these sprites, which include
/// their sunlight.
pub fn check_sprites(name: &str, case: &Foamy, sprites: &[Sprite], drawn: &Drawn, level: u32) {
    let (shot, found) = (&case.shot, of(drawn));
    let (view, settings) = (shot.view(shot.size), case.settings());
    let scene = shot.scene_at(shot.size, 0);
    let bounds = surface_foam::depth_bounds(sprites, &view, level, &settings, &scene);
    compare::between(&format!("{name}-depth"), &found.depth, &bounds);
    let depth = Between { low: wide(&found.depth), high: wide(&found.depth) };
    let [all, front, lit, far] =
        surface_foam::thickness_bounds(sprites, &view, level, &settings, &scene, &depth);
    for (i, bounds) in [all, front].iter().enumerate() {
        let found = found.thickness.map(|t| t[i]);
        compare::between(&format!("{name}-thickness-{i}"), &found, bounds);
    }
    compare::between(&format!("{name}-lit"), &found.lit, &lit);
    compare::between(&format!("{name}-far"), &found.far, &far);
}

#[test]
fn foam_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let both = [Splat::Compute, Splat::Raster];
    for (level, splat) in [1, 0, 2].into_iter().flat_map(|level| both.map(|splat| (level, splat))) {
        let thickness_splat = Some(splat);
        let config = foaming(size).with(|it| {
            it.thickness_level = level;
            it.thickness_splat = thickness_splat;
        });
        let mut rig = Rig::new(&gpu, &config);
        let lenses = if level == 1 { &LENSES[..] } else { &[Lens::OffAxis] };
        for lens in lenses {
            for (fastest, pattern) in [(0.0, 1.0), (40.0, 1.0), (40.0, 0.0)] {
                let mut case = Foamy::new(size, *lens, fastest);
                // The case without the pattern has noise instead.
                let look = &mut case.shot.settings.surface_foam;
                (look.pattern, look.noise) = (pattern, 1.0 - pattern);
                if fastest == 0.0 {
                    case.torn();
                }
                let name = format!("foam-{level}-{splat:?}-{lens:?}-{fastest}-{pattern}");
                let drawn = case.draw(&mut rig);
                check(&name, &case, &drawn, level);
                let covered = of(&drawn).depth.data.iter().filter(|z| **z < 1e9).count();
                assert!(covered * 4 > of(&drawn).depth.data.len(), "{name}: {covered} texels");
                case.shot.scene_depth(|x, y| ((x / 9 + y / 5) % 2 == 0).then_some(4.0));
                let drawn = case.draw(&mut rig);
                check(&format!("{name}-cut"), &case, &drawn, level);
            }
        }
    }
}

/// The compute path draws the sprites of a group together; none may be lost where their sizes
/// differ.
#[test]
fn near_sprites_of_all_sizes_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let config = foaming(size).with(|it| it.thickness_level = 0);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut case = Foamy::new(size, Lens::Standard, 0.0);
    // Each sprite is a little smaller than the one before, at varying positions within a texel.
    let eye: Vec<_> = (0..512)
        .map(|i| (0.3 + 0.005 * i as f32, 0.0031 * (i % 7) as f32, 0.0037 * (i % 5) as f32))
        .map(|(z, x, y)| [z * x, z * y, z])
        .collect();
    case.shot.positions = scenes::world(&case.shot.camera, &eye);
    case.amounts = vec![[1.0, 0.5]; eye.len()];
    case.velocities = vec![[0.0; 3]; eye.len()];
    case.ids = None;
    let drawn = case.draw(&mut rig);
    check("near sprites", &case, &drawn, 0);
}

/// Particles that are a quarter foam have three quarters of the water, in spheres of three quarters
/// of the radius.
#[test]
fn what_is_foam_is_no_water() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for splat in [Splat::Raster, Splat::Compute] {
        let config = foaming(size).with(|it| {
            it.thickness_splat = Some(splat);
            it.depth_splat = Some(splat);
            it.sheets = 1;
            it.thickness_level = 1;
        });
        let mut rig = Rig::new(&gpu, &config);
        let mut case = Foamy::new(size, Lens::Reversed, 10.0);
        case.shot.settings.water.smoothing_width = 0.0;
        case.amounts.fill([0.25, 0.0]);
        let (shot, view) = (case.shot.clone(), case.shot.view(size));
        let drawn = case.draw(&mut rig);
        let mut small = spheres(&shot);
        small.iter_mut().for_each(|s| s.radius *= 0.75);
        let name = format!("foam-water-{splat:?}");
        compare::between(&format!("{name}-depth"), &drawn.depth, &tolerance::depth(&small, &view));

        let spacing = f64::from(shot.settings.water.spacing);
        let sum = if splat == Splat::Raster { Sum::Float } else { Sum::Fixed };
        let front = wide(&of(&drawn).depth);
        let spheres = spheres(&shot);
        let splats = shot.splats(&spheres, 1, sum);
        let bounds = |share: &dyn Fn(usize, usize, f64) -> (f64, f64)| {
            tolerance::thickness_where(&splats, |x, y, sphere| share(x, y, -sphere.center.z))
        };
        // The fraction is a difference and a quotient, multiplied back.
        let whole = (0.75 * (1.0 - 4.0 * U), 0.75 * (1.0 + 4.0 * U));
        compare::between(&format!("{name}-all"), &drawn.thickness, &bounds(&|_, _, _| whole));
        let before = bounds(&|x, y, z| {
            let foam = front.at(x, y);
            if !is_surface(foam) {
                return whole;
            }
            // Centres err by 16u of the depth; the ramp's slope is 1.5 per spacing.
            let share = |z: f64| 1.0 - smoothstep(-0.5 * spacing, 0.5 * spacing, z - foam);
            let slack = 32.0 * U * z;
            let (low, high) = (share(z + slack), share(z - slack));
            (whole.0 * (low - 16.0 * U).max(0.0), whole.1 * (high + 16.0 * U).min(1.0))
        });
        compare::between(&format!("{name}-before"), &of(&drawn).before, &before);
        let parted = drawn.thickness.data.iter().zip(&of(&drawn).before.data);
        let parted =
            parted.filter(|(all, before)| **before > 0.01 * **all && **before < 0.99 * **all);
        assert!(parted.count() > 50, "{name}: foam in the midst of water");
    }
}

/// Asserts that two pictures differ only by the rounding of another shader: composite with foam
/// splits the water in two parts, one of which is empty here. This adds an exponential and a few
/// products.
pub(crate) fn nearly(drawn: &Drawn, expected: &Drawn, name: &str) {
    for (i, (found, wanted)) in drawn.output.data.iter().zip(&expected.output.data).enumerate() {
        let near = found
            .iter()
            .zip(wanted)
            .all(|(a, b)| f64::from((a - b).abs()) <= 16.0 * U * (1.0 + f64::from(b.abs())));
        assert!(near, "{name}: {found:?}, not {wanted:?}, in pixel {i}");
    }
}

/// Whole foam is not drawn as water. Without foam, with NaN or without the stream the picture is
/// that of a renderer without the pass.
#[test]
fn without_foam_nothing_changes() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut plain = Rig::lit(&gpu, &config(size), 1);
    let mut rig = Rig::lit(&gpu, &foaming(size), 1);
    let mut case = Foamy::new(size, Lens::Standard, 10.0);
    let expected = plain.draw(&case.shot);
    for none in [0.0, -1.0, f32::NAN] {
        case.amounts.fill([none, 1.0]);
        let drawn = case.draw(&mut rig);
        nearly(&drawn, &expected, &format!("foam-none-{none}"));
        compare::same("foam-none-depth", &drawn.depth, &expected.depth);
        assert!(of(&drawn).depth.data.iter().all(|z| *z >= 1e9));
    }
    let drawn = rig.draw(&case.shot);
    nearly(&drawn, &expected, "foam-no-stream");
    case.amounts.fill([2.0, 1.0]);
    let drawn = case.draw(&mut rig);
    assert!(drawn.depth.data.iter().all(|z| *z >= 1e9), "more than whole foam is no water");
    assert!(of(&drawn).depth.data.iter().any(|z| *z < 1e9));
    // Foam with an invalid velocity is not drawn.
    case.amounts.fill([0.5, 1.0]);
    case.velocities.fill([f32::NAN, 0.0, 0.0]);
    let drawn = case.draw(&mut rig);
    assert!(of(&drawn).depth.data.iter().all(|z| *z >= 1e9));
}

/// The pass reads velocities and ids: they change the sprites.
#[test]
fn motion_and_ids_show() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(&gpu, &foaming(size));
    let still = Foamy::new(size, Lens::Standard, 0.0);
    let moving =
        Foamy { velocities: Foamy::new(size, Lens::Standard, 60.0).velocities, ..still.clone() };
    let others = Foamy { ids: None, ..still.clone() };
    let [still, moving, others] = [still, moving, others].map(|case| case.draw(&mut rig));
    assert_ne!(of(&still).depth.data, of(&moving).depth.data);
    assert_eq!(of(&still).depth.data, of(&others).depth.data);
    assert_ne!(of(&still).thickness.data, of(&others).thickness.data);
}

/// Sums in fixed point are exact, so the order of the particles does not change a bit, nor does the
/// kind of splat.
#[test]
fn the_order_of_particles_does_not_show_in_foam() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let config = foaming(size).with(|it| it.spray = true);
    let blended = config.with(|it| it.depth_splat = Some(Splat::Raster));
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut blending =
        Rig::lit(&gpu, &blended.with(|it| it.thickness_splat = Some(Splat::Raster)), 1);
    let mut case = Foamy::new(size, Lens::Reversed, 30.0);
    let n = case.shot.positions.len();
    case.shot.densities = Some((0..n).map(|i| 1000.0 * (i % 7) as f32 / 6.0).collect());
    let expected = case.draw(&mut rig);
    let turned = |i: usize| (i * 37 + 11) % n;
    let mut other = case.clone();
    other.shot.positions = (0..n).map(|i| case.shot.positions[turned(i)]).collect();
    other.shot.densities =
        case.shot.densities.as_ref().map(|d| (0..n).map(|i| d[turned(i)]).collect());
    other.amounts = (0..n).map(|i| case.amounts[turned(i)]).collect();
    other.velocities = (0..n).map(|i| case.velocities[turned(i)]).collect();
    other.ids = case.ids.as_ref().map(|ids| (0..n).map(|i| ids[turned(i)]).collect());
    assert_eq!(n, 160, "37 and 160 have no common factor: a permutation");
    let [one, two] = [&case, &other].map(|case| case.draw(&mut blending));
    assert!(of(&one).thickness.data == of(&two).thickness.data, "blended");
    assert!(of(&one).depth.data == of(&two).depth.data, "blended");
    for _ in 0..3 {
        let drawn = other.draw(&mut rig);
        let (a, b) = (of(&drawn), of(&expected));
        assert!(a.thickness.data == b.thickness.data && a.depth.data == b.depth.data);
        assert_eq!(
            drawn.spray.as_ref().expect("spray").data,
            expected.spray.as_ref().expect("spray").data
        );
        assert!(drawn.output.data == expected.output.data);
    }
    let most = expected.spray.iter().flat_map(|s| &s.data).fold(0.0, |a: f32, b| a.max(*b));
    assert!(most > 0.2 && most < 4.0, "spray, of sums that are exact: {most}");
}

/// More particles than one binding holds, with ids and without. Without ids, a particle's number
/// continues from chunk to chunk.
#[test]
fn chunks_of_foam_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::new(
        &gpu,
        &foaming(size).with(|it| {
            it.max_stride = 1 << 20;
            it.thickness_level = 1;
        }),
    );
    let mut case = Foamy::new(size, Lens::OffAxis, 20.0);
    for _ in 0..2 {
        let drawn = case.draw(&mut rig);
        check("foam-chunks", &case, &drawn, 1);
        case.ids = None;
    }
}

/// Any number of sprites may overlap: a sum saturates at 2^24 steps and does not wrap around.
#[test]
fn sums_of_foam_end_where_they_are_full() {
    let gpu = Gpu::shared();
    let size = extent(41, 31);
    let config = foaming(size).with(|it| {
        it.thickness_level = 1;
        it.max_particles = 1 << 14;
    });
    let mut rig = Rig::new(&gpu, &config);
    let mut case = Foamy::new(size, Lens::Standard, 0.0);
    (case.shot.settings.surface_foam.noise, case.shot.settings.surface_foam.pattern) = (0.0, 0.0);
    let spot = scenes::world(&case.shot.camera, &[[0.0, 0.0, 2.0]])[0];
    let most = case.settings().step * f64::from(1 << 24);
    let mut full = 0;
    for count in [1, 1 << 14] {
        case.shot.positions = vec![spot; count];
        (case.amounts, case.velocities) = (vec![[1.0, 0.0]; count], vec![[0.0; 3]; count]);
        case.ids = None;
        let drawn = case.draw(&mut rig);
        let found = of(&drawn).thickness.data.iter().map(|t| f64::from(t[0]));
        let found: Vec<f64> = found.collect();
        assert!(found.iter().all(|t| *t <= most), "{count}");
        full += found.iter().filter(|t| **t == most).count();
        assert!((full > 0) == (count > 1), "{count}: {full}");
    }
}

/// The outline of an object before the foam is exact to the pixel, also in texels that contain
/// both: no foam on the object, foam beside it.
#[test]
fn the_scenes_outline_in_foam_is_sharp() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for shading in [Shading::Raster, Shading::Compute] {
        let mut rig = Rig::lit(&gpu, &foaming(size).with(|it| it.composite = Some(shading)), 1);
        let mut wall = Foamy::new(size, Lens::Standard, 0.0);
        let block = scenes::block(3, 0.1, [44, 30, 3], [-2.2, -1.5, 2.0]);
        wall.shot.positions = scenes::world(&wall.shot.camera, &block);
        (wall.amounts, wall.velocities) =
            (vec![[1.0, 0.0]; block.len()], vec![[0.0; 3]; block.len()]);
        wall.ids = None;
        let before = |x: u32| (x / 7).is_multiple_of(2);
        // The object is more than a spacing before the foam.
        wall.shot.scene_depth(|x, _| before(x).then_some(1.0));
        let drawn = wall.draw(&mut rig);
        let mut foamy = 0;
        for (i, (found, scene)) in drawn.output.data.iter().zip(&wall.shot.color).enumerate() {
            let same = found.map(f32::to_bits) == scene.map(f32::to_bits);
            assert_eq!(same, before(i as u32 % 97), "{shading:?}, pixel ({}, {})", i % 97, i / 97);
            foamy += usize::from(!same);
        }
        assert!(foamy > 2000, "{foamy}");
    }
}

/// Frames of odd sizes as a part of a larger image; frames without particles, and with all
/// particles behind the eye.
#[test]
fn foam_of_any_size() {
    let gpu = Gpu::shared();
    for (width, height) in [(1, 1), (1, 7), (3, 5), (17, 33), (130, 9)] {
        let size = extent(width, height);
        // At full resolution, because the centre of a larger texel may lie outside the view, where
        // sprites are culled.
        let config = foaming(size).with(|it| it.thickness_level = 0);
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut case = Foamy::new(size, Lens::Reversed, 20.0);
        case.shot.margin = [3, 1, 2, 4];
        let drawn = case.draw(&mut rig);
        check(&format!("foam-{width}x{height}"), &case, &drawn, rig.config.thickness_level);
        let behind = case.shot.positions.len();
        let back = scenes::world(&case.shot.camera, &vec![[0.0, 0.0, -3.0]; behind]);
        for positions in [back, Vec::new()] {
            let mut none = case.clone();
            (none.amounts, none.velocities) = (
                none.amounts[..positions.len()].to_vec(),
                none.velocities[..positions.len()].to_vec(),
            );
            none.ids = None;
            none.shot.positions = positions;
            let drawn = none.draw(&mut rig);
            assert!(of(&drawn).depth.data.iter().all(|z| *z >= 1e9));
            assert_eq!(drawn.output.data, none.shot.color, "{width}x{height}");
        }
    }
}
