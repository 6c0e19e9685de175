//! Compares pass `composite` with its CPU twin, which shades the layers read back from the GPU.

use glam::{DVec2, DVec3};
use whitewater::Config;
use whitewater::water::{Bed, Exit, Fresnel, Medium, Shading, Splat};

use crate::harness::fails;
use crate::reduce::wide;
use crate::reference::composite::{self as twin, Inputs, cut_look_up, hidden, look_up};
use crate::reference::noise::{Look, Ripples};
use crate::reference::surface::{Case, Surface, Surfaces};
use crate::reference::{Image, View, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens};
use crate::support::shaded::{Filter, Shaded, shaded};
use crate::support::tolerance::U;

/// An environment whose radiance the test knows exactly, used for the picture and for its twin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sky {
    /// A constant that half precision represents exactly.
    Even,
    /// `0.5 + 0.25 d.y` and `0.5 + 0.25 d.x`; the third channel is constant.
    Slope,
}

/// Colour of a uniform scene. Filtering does not change it, so the bounds contain only arithmetic
/// errors.
pub const FLAT: [f32; 4] = [0.3, 0.5, 0.7, 0.75];
const CUBE: f64 = 64.0;
pub const SKY: (u32, u32) = (256, 128);

impl Sky {
    pub fn radiance(self, d: DVec3) -> DVec3 {
        match self {
            Self::Even => DVec3::new(0.5, 0.75, 1.25),
            Self::Slope => DVec3::new(0.5 + 0.25 * d.y, 0.5 + 0.25 * d.x, 0.5),
        }
    }

    /// Texels of the environment map: row 0 is up, the middle column looks along -z, the column at
    /// three quarters along +x.
    pub fn texels(self) -> Vec<[f32; 4]> {
        let (width, height) = (f64::from(SKY.0), f64::from(SKY.1));
        (0..SKY.1)
            .flat_map(|y| (0..SKY.0).map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5)))
            .map(|(x, y)| {
                let longitude = (x / width - 0.5) * std::f64::consts::TAU;
                let polar = y / height * std::f64::consts::PI;
                let d = DVec3::new(
                    polar.sin() * longitude.sin(),
                    polar.cos(),
                    -polar.sin() * longitude.cos(),
                );
                self.radiance(d).as_vec3().extend(1.0).to_array()
            })
            .collect()
    }

    /// Max change of a channel per unit of direction.
    fn slope(self) -> f64 {
        if self == Self::Even { 0.0 } else { 0.25 }
    }

    /// Error of the cube map. Linear interpolation in the cube and in the source image errs by h² /
    /// 8 of the second derivative (0.25) per axis; taking four samples per texel errs as much
    /// again. Half precision adds 2^-11 of 0.75, and filter weights of `bits` bits add that
    /// fraction of the difference between texels.
    pub fn error(self, bits: u32) -> f64 {
        if self == Self::Even {
            return 0.0;
        }
        let texel = std::f64::consts::FRAC_PI_2 / CUBE * 1.3;
        let from = std::f64::consts::PI / f64::from(SKY.1);
        let interpolation = 0.25 * (2.0 * texel * texel + from * from) / 4.0;
        interpolation + 0.75 / 2048.0 + 2.0 * 0.25 * texel / f64::from(1 << bits)
    }
}

pub fn twin_settings(shot: &Shot, view: &View) -> twin::Settings {
    let (water, light) = (&shot.settings.water, &shot.settings.light);
    let rgb = |c: [f32; 3]| c.map(f64::from);
    let fresnel = match water.fresnel {
        Fresnel::Schlick { f0 } => twin::Fresnel::Schlick { f0: f64::from(f0) },
        Fresnel::Source { bias, scale, power } => twin::Fresnel::Source {
            bias: f64::from(bias),
            scale: f64::from(scale),
            power: f64::from(power),
        },
    };
    let sun = DVec3::from(rgb(light.direction)).normalize();
    let bed = || twin::Bed::new(fresnel, sun.y, rgb(light.irradiance), rgb(light.shade));
    twin::Settings {
        radius: f64::from(water.radius()),
        falloff: f64::from(water.depth_falloff),
        refraction: f64::from(water.refraction),
        medium: match water.medium {
            Medium::Physical { absorption, scattering } => twin::Medium::Physical {
                absorption: rgb(absorption),
                scattering: rgb(scattering),
                ambient: rgb(light.ambient),
            },
            Medium::Turbid { absorption, scattering, emission } => twin::medium::turbid(
                [absorption, scattering, emission].map(rgb),
                (rgb(light.irradiance), rgb(light.shade)),
                fresnel,
            ),
            Medium::Source { base, falloff } => {
                twin::Medium::Source { base: rgb(base), k: falloff.map(f64::from) }
            }
        },
        fresnel,
        bed: (water.bed == Bed::Submerged).then(bed),
        mirror_steps: 0,
        exit: None,
        specular: [f64::from(water.specular); 3],
        shininess: f64::from(water.shininess),
        sun_direction: view.view.transform_vector3(rgb(light.direction).into()).normalize(),
        sun_color: rgb(light.color),
    }
}

/// How the twin applies the noise image to the surface of a shot.
pub fn noise_look(shot: &Shot, image: &Image<f32>) -> Look {
    let look = &shot.settings.noise;
    let light = shot.settings.light.irradiance;
    Look {
        level: (0..4)
            .find(|l| shot.size.width.div_ceil(1 << l) as usize == image.width)
            .expect("a level"),
        height: f64::from(look.weight) * f64::from(shot.settings.water.radius()),
        airborne: match shot.settings.water.bed {
            Bed::Submerged => f64::from(look.airborne),
            Bed::Source => 0.0,
        },
        foam: f64::from(look.foam),
        color: [0, 1, 2]
            .map(|c| f64::from(look.color[c]) * f64::from(light[c]) * std::f64::consts::FRAC_1_PI),
    }
}

/// Number of pixels in which each rule of the surface decided.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cases {
    whole: usize,
    border: usize,
    part_rim: usize,
    rim: usize,
    steep_rim: usize,
    beside: usize,
    alone: usize,
    drop: usize,
    part_drop: usize,
    borrowed: usize,
    mirrored: usize,
    /// Refracted rays that leave the water beside the scene that it touches.
    missed: usize,
}

impl Cases {
    fn count(&mut self, surface: &Surface) {
        let parts = &surface.parts;
        *match parts.case {
            Case::Whole => &mut self.whole,
            Case::Border => &mut self.border,
            Case::PartRim => &mut self.part_rim,
            Case::Rim => &mut self.rim,
            Case::SteepRim => &mut self.steep_rim,
            Case::Beside => &mut self.beside,
            Case::Alone => &mut self.alone,
        } += 1;
        self.drop += usize::from(parts.drop == 1.0);
        self.part_drop += usize::from(parts.drop > 0.0 && parts.drop < 1.0);
        self.borrowed += usize::from(parts.borrowed);
    }
}

impl std::ops::AddAssign for Cases {
    fn add_assign(&mut self, other: Self) {
        self.whole += other.whole;
        self.border += other.border;
        self.part_rim += other.part_rim;
        self.rim += other.rim;
        self.steep_rim += other.steep_rim;
        self.beside += other.beside;
        self.alone += other.alone;
        self.drop += other.drop;
        self.part_drop += other.part_drop;
        self.borrowed += other.borrowed;
        self.mirrored += other.mirrored;
        self.missed += other.missed;
    }
}

/// Inputs of the twin, read back from a drawn frame.
pub struct Layers {
    pub depth: Image<f64>,
    smoothed: Image<f64>,
    pub thickness: Image<f64>,
    color: Image<[f64; 4]>,
    scene: Image<f64>,
    noise: Option<(Image<f64>, Look)>,
}

impl Layers {
    pub fn new(drawn: &Drawn, shot: &Shot) -> Self {
        let (width, height) = (shot.size.width as usize, shot.size.height as usize);
        let color = shot.color.iter().map(|c| c.map(f64::from)).collect();
        Self {
            depth: wide(&drawn.depth),
            smoothed: wide(&drawn.surface),
            thickness: drawn.thickness.map(|t| f64::from(*t)),
            color: Image::from_vec(width, height, color).expect("the output's size"),
            scene: shot.scene_eye(),
            noise: drawn.noise.as_ref().map(|image| (wide(image), noise_look(shot, image))),
        }
    }

    pub fn inputs(&self, level: u32, thickness_level: u32) -> Inputs<'_> {
        Inputs {
            depth: &self.depth,
            smoothed: &self.smoothed,
            level,
            thickness: &self.thickness,
            thickness_level,
            scene_color: &self.color,
            scene_depth: &self.scene,
            noise: self.noise.as_ref().map(|(image, look)| Ripples { image, look: *look }),
        }
    }
}

pub fn check(name: &str, rig: &mut Rig<'_>, shot: &Shot, sky: Sky) -> Cases {
    check_other(name, rig, shot, sky, |_| ())
}

/// Compares with a twin whose settings `other` has changed.
fn check_other(
    name: &str,
    rig: &mut Rig<'_>,
    shot: &Shot,
    sky: Sky,
    other: impl Fn(&mut twin::Settings),
) -> Cases {
    check_told(name, rig, shot, shot, sky, other)
}

/// Compares with a twin whose settings `other` has changed and whose noise settings are those of
/// `told`.
pub fn check_told(
    name: &str,
    rig: &mut Rig<'_>,
    shot: &Shot,
    told: &Shot,
    sky: Sky,
    other: impl Fn(&mut twin::Settings),
) -> Cases {
    let (size, level) = (rig.config.extent, rig.config.smoothing_level);
    let drawn: Drawn = rig.draw(shot);
    let view = shot.view(size);
    let mut settings = twin_settings(shot, &view);
    settings.mirror_steps = rig.config.mirror_steps;
    // The refractive index of the bed, or of water where there is no bed.
    let index = settings.bed.map_or(1.333, |bed| bed.index);
    settings.exit = (rig.config.exit == Exit::TwoInterfaces).then_some(index);
    other(&mut settings);
    let (width, height) = (size.width as usize, size.height as usize);
    let mut layers = Layers::new(&drawn, shot);
    if let (Some((_, look)), Some(image)) = (&mut layers.noise, &drawn.noise) {
        *look = noise_look(told, image);
    }
    let depth = &layers.depth;
    let inputs = layers.inputs(level, rig.config.thickness_level);
    let mut expected = twin::shade(&inputs, &settings, |d| sky.radiance(d), &view);
    let bits = rig.gpu.limits().sub_texel_precision_bits;
    let (sky_slope, sky_error) = (sky.slope(), sky.error(bits));
    let filter = Filter { bits, sky_slope, sky_error };
    let surfaces = Surfaces::new(&inputs, &settings, &view);
    let (mut water, mut skipped) = (0, 0);
    let mut cases = Cases::default();
    let mut bounds = Image::new(width, height, [0.0; 4]);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        if !is_surface(depth.at(x, y)) {
            continue;
        }
        water += 1;
        let found = surfaces.at(x, y).expect("a surface");
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let seen = twin::seen(&inputs, &settings, &found, |d| sky.radiance(d), &view, pixel);
        let Shaded { color, moved, met, sure } =
            shaded(&inputs, &settings, &found, &view, (x, y), seen, &filter);
        for (i, c) in color.iter().enumerate() {
            let twin = expected.at(x, y)[i];
            // The twin and the bounds evaluate the colour in different orders; the view matrix is a
            // rotation only to single precision.
            assert!(
                (c.v - twin).abs() <= 8.0 * U * (1.0 + twin),
                "{name}: two orders, two colours"
            );
        }
        cases.count(&found);
        cases.mirrored += usize::from(met.share == 1.0);
        let touching = twin::Under::of(&settings, &found, &view).wet;
        let under = twin::Under::met(&inputs, &settings, &found, &view, pixel).wet;
        cases.missed += usize::from(under < 0.5 * touching);
        // If the look-up's uncertainty reaches a neighbouring texel, the GPU may read another texel
        // of the scene.
        let q = look_up(&inputs, &settings, &found, &view, pixel);
        let z = -found.position.z;
        let sides = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        // A gather rounds its coordinates to the same number of bits as a filter.
        let texel = size.width as f64 / shot.depth_extent.width.min(size.width) as f64;
        let moved = moved + 2.0 * texel / f64::from(1 << bits);
        let (_, asked) = cut_look_up(&inputs, z, pixel, q);
        let unsure = |q: &DVec2| {
            let either = sides.map(|(dx, dy)| hidden(&inputs, z, *q + DVec2::new(dx, dy) * moved));
            either.iter().any(|h| *h != either[0])
        };
        // Depths are means with an error of 13u; the falloff is a product.
        let undecided = 16.0 * U * (z + settings.falloff * settings.radius);
        if found.parts.margin <= undecided || !sure || asked.iter().any(unsure) {
            skipped += 1;
            *expected.at_mut(x, y) = drawn.output.at(x, y).map(f64::from);
        }
        *bounds.at_mut(x, y) = [color[0].e, color[1].e, color[2].e, 0.0];
    }
    let census = compare::close_color(name, &drawn.output, &expected, |x, y| bounds.at(x, y));
    // Marched rays and look-ups near edges of the scene are undecided in few pixels.
    assert!(water > 300 && skipped * 25 <= water, "{name}: {skipped} of {water} undecided");
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("{name}: {skipped} of {water} undecided, {cases:?}, {census}");
    }
    cases
}

fn shot(size: ash::vk::Extent2D, lens: Lens) -> Shot {
    let mut points = scenes::block(3, 0.25, [14, 8, 4], [-1.8, -1.0, 4.0]);
    points.extend(scenes::cloud(4, 20, 1.5, 12.0));
    let mut shot = Shot::new(size, lens, 0.2, &points);
    shot.settings.water.shininess = 20.0;
    shot
}

#[test]
fn the_picture_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (level, thickness_level) in [(0, 0), (1, 0), (1, 1), (2, 2), (0, 2), (1, 2), (2, 1), (1, 3)]
    {
        for (sky, flat) in [(Sky::Even, true), (Sky::Even, false), (Sky::Slope, false)] {
            let config = config(size).with(|it| {
                it.smoothing_level = level;
                it.thickness_level = thickness_level;
                it.environment_size = CUBE as u32;
                it.coarsening = 0;
            });
            let mut rig = Rig::new(&gpu, &config);
            rig.environment(extent(SKY.0, SKY.1), &sky.texels());
            let lenses: &[Lens] = match (level, thickness_level) {
                (1, 1) => &LENSES,
                _ => &[Lens::Standard, Lens::OffAxis],
            };
            for lens in lenses {
                let mut shot = shot(size, *lens);
                if flat {
                    shot.color.fill(FLAT);
                }
                let name = format!("composite-{level}{thickness_level}-{lens:?}-{sky:?}-{flat}");
                check(&name, &mut rig, &shot, sky);
            }
        }
    }
}

/// Spheres of many pixels with steep rims, single drops and thin layers, cut by narrow and wide
/// falloffs. Each rule of the surface decides in some pixels.
#[test]
fn every_rule_of_the_surface() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut all = Cases::default();
    for (level, thickness_level) in [(0, 0), (1, 2), (2, 1), (2, 3), (1, 1)] {
        // The twin knows one level; the tests of pass `level` compare the other levels with it.
        let config = config(size).with(|it| {
            it.smoothing_level = level;
            it.thickness_level = thickness_level;
            it.coarsening = 0;
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        for (falloff, width) in [(5.3, 1.5), (1.0, 0.0), (0.3, 0.0), (0.1, 0.5)] {
            let mut points = vec![[-1.2, 0.3, 5.0]; 5];
            points.extend([[1.6, -0.9, 6.0]; 3]);
            points.extend([[1.0, 1.2, 7.0], [0.4, -0.5, 4.0], [0.6, -0.3, 4.2]]);
            points.extend(scenes::cloud(9, 60, 5.0, 20.0));
            let mut shot = Shot::new(size, Lens::Standard, 0.6, &points);
            shot.color.fill(FLAT);
            let water = &mut shot.settings.water;
            water.shininess = 20.0;
            (water.depth_falloff, water.smoothing_width) = (falloff, width);
            let name = format!("composite-rules-{level}{thickness_level}-{falloff}");
            all += check(&name, &mut rig, &shot, Sky::Even);
        }
    }
    let Cases {
        whole,
        border,
        part_rim,
        rim,
        steep_rim,
        beside,
        alone,
        drop,
        part_drop,
        borrowed,
        // Rules of the rays, which other tests use.
        mirrored: _,
        missed: _,
    } = all;
    let least = [whole, border, part_rim, rim, steep_rim, beside, alone, drop, part_drop, borrowed];
    assert!(least.iter().all(|pixels| *pixels >= 20), "{all:?}");
}

#[test]
fn every_medium_and_reflectance() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let make = |composite| {
        let depth_splat = Some(Splat::Raster);
        let config = config(size).with(|it| {
            it.depth_splat = depth_splat;
            it.coarsening = 0;
            it.composite = Some(composite);
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        rig
    };
    let mut rigs = [make(Shading::Raster), make(Shading::Compute)];
    let media = [
        ("pool", Medium::POOL),
        ("river", Medium::RIVER),
        ("lava", Medium::LAVA.thinned(1.0e-3)),
        ("source", Medium::source(0.3)),
        ("none", Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] }),
    ];
    let fresnels = [
        ("schlick", Fresnel::Schlick { f0: 0.02 }),
        ("source", Fresnel::Source { bias: 0.1, scale: 0.4, power: 2.0 }),
    ];
    for (medium_name, medium) in media {
        for (fresnel_name, fresnel) in fresnels {
            for flat in [true, false] {
                let mut shot = shot(size, Lens::Standard);
                shot.settings.water.medium = medium;
                shot.settings.water.fresnel = fresnel;
                if flat {
                    shot.color.fill(FLAT);
                }
                for (rig, way) in rigs.iter_mut().zip(["raster", "compute"]) {
                    let name = format!("composite-{medium_name}-{fresnel_name}-{flat}-{way}");
                    check(&name, rig, &shot, Sky::Even);
                }
            }
        }
    }
}

/// Each preset medium has its liquid's colour in the twin: very deep, over white, and in a glass.
#[test]
fn liquids_look_like_themselves() {
    let size = extent(33, 33);
    let view = shot(size, Lens::Standard).view(size);
    let seen = |medium: Medium, metres: f64, behind: f64| {
        let mut shot = shot(size, Lens::Standard);
        shot.settings.water.medium = medium;
        shot.settings.light.irradiance = [std::f32::consts::PI; 3];
        let settings = twin_settings(&shot, &view);
        twin::through(&settings.medium, DVec3::splat(behind), metres).to_array()
    };
    let deep = |medium| seen(medium, 1.0e4, 0.0);
    // Clear water is colourless in a glass, and blue over white at a depth of ten metres.
    let [r, g, b] = seen(Medium::CLEAR, 0.1, 1.0);
    assert!(r > 0.97 && g > 0.99 && b > 0.99, "{r} {g} {b}");
    let [r, g, b] = seen(Medium::CLEAR, 10.0, 1.0);
    assert!(b > 0.85 && g > 0.5 && r < 0.1, "{r} {g} {b}");
    // Clear ocean is deep blue and reflects a few hundredths of the light; a lake is green and
    // darker.
    let [r, g, b] = deep(Medium::OCEAN);
    assert!(b > 3.0 * g && g > 3.0 * r && (0.01..0.05).contains(&b), "{r} {g} {b}");
    let [r, g, b] = deep(Medium::LAKE);
    assert!(g > 1.5 * r && g > 1.5 * b && g < 0.03, "{r} {g} {b}");
    // Silt is tan and hides the bed at a depth of two metres; rock flour is bright turquoise.
    let [r, g, b] = deep(Medium::RIVER);
    assert!(r > 1.2 * g && g > 2.0 * b && r > 0.1, "{r} {g} {b}");
    assert!(
        seen(Medium::RIVER, 2.0, 1.0)
            .iter()
            .zip(deep(Medium::RIVER))
            .all(|(a, b)| (a - b).abs() < 0.01)
    );
    let [r, g, b] = deep(Medium::GLACIER);
    assert!(b > g && g > 1.8 * r && b > 0.3, "{r} {g} {b}");
    // Milk a few millimetres deep is white with a touch of yellow.
    let [r, g, b] = seen(Medium::MILK, 0.003, 0.0);
    assert!(r > 0.88 && g > 0.85 && (0.7..0.8).contains(&b), "{r} {g} {b}");
    // Seven centimetres of beer and two of honey are amber; deep blood is red.
    let [r, g, b] = seen(Medium::BEER, 0.07, 1.0);
    assert!((0.3..0.6).contains(&r) && r > 2.0 * g && g > 5.0 * b, "{r} {g} {b}");
    let [r, g, b] = seen(Medium::HONEY, 0.02, 1.0);
    assert!((0.3..0.6).contains(&r) && r > 2.0 * g && g > 5.0 * b, "{r} {g} {b}");
    let [r, g, b] = deep(Medium::BLOOD);
    assert!((0.05..0.2).contains(&r) && r > 10.0 * g.max(b), "{r} {g} {b}");
    // Lava emits light, so its colour does not depend on the illumination.
    let [r, g, b] = deep(Medium::LAVA);
    assert!(r > 3.0 * g && g > 10.0 * b && (r - 0.497).abs() < 1.0e-6, "{r} {g} {b}");
}

/// A change of one of these settings by a hundredth, or of the sun's direction by a degree, is
/// detected as another picture.
#[test]
fn a_hundredth_is_seen() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &config(size).with(|it| it.coarsening = 0));
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    let shot = shot(size, Lens::Standard);
    let mut flat = shot.clone();
    flat.color.fill(FLAT);
    fn medium(settings: &mut twin::Settings, absorbs: f64, scatters: f64) {
        if let twin::Medium::Physical { absorption, scattering, .. } = &mut settings.medium {
            *absorption = absorption.map(|k| k * absorbs);
            *scattering = scattering.map(|k| k * scatters);
        }
    }
    fn turned(direction: DVec3) -> DVec3 {
        glam::DQuat::from_rotation_y(1.0_f64.to_radians()) * direction
    }
    type Fault = fn(&mut twin::Settings);
    let faults: [(&str, &Shot, Fault); 10] = [
        ("absorption", &flat, |s| medium(s, 1.01, 1.0)),
        ("scattering", &flat, |s| medium(s, 1.0, 1.01)),
        ("fresnel", &flat, |s| s.fresnel = twin::Fresnel::Schlick { f0: 0.0202 }),
        ("specular", &flat, |s| s.specular = s.specular.map(|k| k * 1.01)),
        ("shininess", &flat, |s| s.shininess *= 1.01),
        ("radius", &flat, |s| s.radius *= 1.01),
        ("refraction", &shot, |s| s.refraction *= 1.01),
        ("sun colour", &flat, |s| s.sun_color = s.sun_color.map(|k| k * 1.01)),
        ("sun direction", &flat, |s| s.sun_direction = turned(s.sun_direction)),
        ("ambient", &flat, |s| {
            if let twin::Medium::Physical { ambient, .. } = &mut s.medium {
                *ambient = ambient.map(|k| k * 1.01);
            }
        }),
    ];
    for (name, shot, fault) in faults {
        check("planted-look", &mut rig, shot, Sky::Even);
        let seen = fails(|| {
            check_other("planted-look", &mut rig, shot, Sky::Even, fault);
        });
        assert!(seen, "{name} off by a hundredth");
    }
}

/// A change of a turbid medium by two hundredths is detected as another picture.
#[test]
fn turbid_media_are_exact() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &config(size).with(|it| it.coarsening = 0));
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    let mut shot = shot(size, Lens::Standard);
    shot.color.fill(FLAT);
    let medium = |absorbs: f32, scatters: f32, shines: f32| Medium::Turbid {
        absorption: [0.3, 0.8, 0.05].map(|k| absorbs * k),
        scattering: [0.5, 0.1, 1.5].map(|k| scatters * k),
        emission: [0.4, 0.1, 0.02].map(|k| shines * k),
    };
    shot.settings.water.medium = medium(1.0, 1.0, 1.0);
    check("turbid", &mut rig, &shot, Sky::Even);
    for (name, other) in [
        ("absorption", medium(1.02, 1.0, 1.0)),
        ("scattering", medium(1.0, 1.02, 1.0)),
        ("emission", medium(1.0, 1.0, 1.02)),
    ] {
        let mut wrong = shot.clone();
        wrong.settings.water.medium = other;
        let view = wrong.view(size);
        let planted = twin_settings(&wrong, &view).medium;
        let seen = fails(|| {
            check_other("planted-turbid", &mut rig, &shot, Sky::Even, |s| s.medium = planted);
        });
        assert!(seen, "{name} off by two hundredths");
    }
    // Without any light the medium still shows its emission.
    let dark = &mut shot.settings.light;
    (dark.ambient, dark.irradiance, dark.shade) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    check("turbid-dark", &mut rig, &shot, Sky::Even);
}

/// Water over a bed that slopes away behind it; the fraction to which the bed is under water goes
/// from 1 to 0.
pub fn on_bed(size: ash::vk::Extent2D, lens: Lens) -> Shot {
    let mut shot = shot(size, lens);
    shot.scene_depth(|x, _| Some(4.6 + 0.02 * f64::from(x)));
    shot
}

#[test]
fn the_bed_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for way in [Shading::Raster, Shading::Compute] {
        let config = config(size).with(|it| {
            it.coarsening = 0;
            it.composite = Some(way);
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            for (medium_name, medium) in [("pool", Medium::POOL), ("source", Medium::source(0.3))] {
                for flat in [true, false] {
                    let mut shot = on_bed(size, lens);
                    shot.settings.water.medium = medium;
                    if medium == Medium::POOL && flat {
                        let fresnel = Fresnel::Source { bias: 0.1, scale: 0.4, power: 2.0 };
                        shot.settings.water.fresnel = fresnel;
                    }
                    if flat {
                        shot.color.fill(FLAT);
                    }
                    let name = format!("composite-bed-{lens:?}-{medium_name}-{flat}-{way:?}");
                    check(&name, &mut rig, &shot, Sky::Even);
                    // The same scene with a dry bed.
                    shot.settings.water.bed = Bed::Source;
                    check(&format!("{name}-dry"), &mut rig, &shot, Sky::Even);
                }
            }
        }
    }
    // The comparison detects a change of each of the bed's numbers by a hundredth.
    let mut rig = Rig::new(&gpu, &config(size).with(|it| it.coarsening = 0));
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    let mut shot = on_bed(size, Lens::Standard);
    shot.settings.water.medium =
        Medium::Physical { absorption: [2.4, 0.75, 0.55], scattering: [0.12, 0.3, 0.34] };
    shot.color.fill(FLAT);
    type Fault = fn(&mut twin::Bed);
    let faults: [(&str, Fault); 7] = [
        ("index", |bed| bed.index *= 1.01),
        ("what comes in", |bed| bed.comes_in *= 0.99),
        ("the sky's way", |bed| bed.sky_way *= 1.01),
        ("the sun's way", |bed| bed.sun_way *= 1.01),
        ("what of the sun comes in", |bed| bed.sun *= 0.99),
        ("the irradiance", |bed| bed.irradiance = bed.irradiance.map(|e| e * 1.01)),
        ("the shade", |bed| bed.shade = bed.shade.map(|e| e * 1.01)),
    ];
    for (name, fault) in faults {
        let seen = fails(|| {
            check_other("planted-bed", &mut rig, &shot, Sky::Even, |settings| {
                fault(settings.bed.as_mut().expect("a bed"));
            });
        });
        assert!(seen, "{name} off by a hundredth");
    }
}

/// The water's rims mirror a wall with a colour gradient, which stands behind and beside the water.
#[test]
fn what_of_the_scene_is_mirrored_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut mirrored = 0;
    for (way, steps) in [(Shading::Raster, 10), (Shading::Compute, 10), (Shading::Raster, 2)] {
        let config = config(size).with(|it| {
            it.coarsening = 0;
            it.composite = Some(way);
            it.mirror_steps = steps;
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        for lens in [Lens::Standard, Lens::OffAxis, Lens::Reversed, Lens::LeftHanded] {
            let mut shot = Shot::new(size, lens, 0.6, &[[-0.9, 0.2, 5.0], [0.9, -0.4, 5.5]]);
            shot.scene_depth(|x, _| Some(6.2 + 0.01 * f64::from(x)));
            shot.settings.water.fresnel = Fresnel::Source { bias: 0.5, scale: 0.4, power: 2.0 };
            shot.settings.water.spacing = 1.6;
            let name = format!("composite-mirror-{steps}-{lens:?}-{way:?}");
            mirrored += check(&name, &mut rig, &shot, Sky::Even).mirrored;
            shot.color.fill(FLAT);
            check(&format!("{name}-flat"), &mut rig, &shot, Sky::Even);
            // Without mirror steps the picture differs.
            if steps == 10 && lens == Lens::Standard {
                let other = fails(|| {
                    check_other(&name, &mut rig, &shot, Sky::Even, |s| s.mirror_steps = 0);
                });
                assert!(other, "the environment alone is another picture");
            }
        }
    }
    assert!(mirrored > 500, "{mirrored} pixels mirror the wall alone");
}

/// Drops and a block of water with air behind them. Through them one sees a distant wall, or only
/// the environment, or a wall close behind the water.
#[test]
fn what_comes_through_both_surfaces_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (way, thickness_level) in
        [(Shading::Raster, 2), (Shading::Compute, 0), (Shading::Raster, 1)]
    {
        let config = config(size).with(|it| {
            it.coarsening = 0;
            it.composite = Some(way);
            it.exit = Exit::TwoInterfaces;
            it.mirror_steps = if thickness_level == 1 { 10 } else { 0 };
            it.thickness_level = thickness_level;
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            for wall in [Some(12.0), Some(5.1), None] {
                let mut drops = Shot::new(size, lens, 0.6, &[[-0.9, 0.2, 5.0], [0.9, -0.4, 5.5]]);
                drops.settings.water.spacing = 1.6;
                let shots = [("drops", drops), ("block", shot(size, lens))];
                for (kind, mut shot) in shots {
                    if let Some(wall) = wall {
                        shot.scene_depth(|x, _| Some(wall + 0.005 * f64::from(x)));
                    }
                    let name = format!("composite-exit-{kind}-{lens:?}-{way:?}-{wall:?}");
                    check(&name, &mut rig, &shot, Sky::Even);
                    let other = fails(|| {
                        check_other(&name, &mut rig, &shot, Sky::Even, |s| s.exit = None);
                    });
                    assert!(other, "{name}: the front alone shows another picture");
                    // Against the even environment alone the index hardly shows.
                    let other = wall.is_none()
                        || fails(|| {
                            check_other(&name, &mut rig, &shot, Sky::Even, |s| {
                                s.exit = s.exit.map(|index| index * 1.01);
                            });
                        });
                    assert!(other, "{name}: another index shows another picture");
                }
            }
        }
    }
}

/// A body of water before the edge of a box that it touches: rays that are refracted past the edge leave the water.
#[test]
fn water_does_not_touch_what_a_ray_meets_far_behind_it() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut missed = 0;
    for way in [Shading::Raster, Shading::Compute] {
        let config = config(size).with(|it| {
            it.coarsening = 0;
            it.composite = Some(way);
            it.exit = Exit::TwoInterfaces;
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            for edge in (30..68).step_by(6) {
                let mut shot = shot(size, lens);
                shot.scene_depth(|x, _| Some(if x < edge { 4.7 } else { 14.0 }));
                let name = format!("composite-edge-{lens:?}-{way:?}-{edge}");
                missed += check(&name, &mut rig, &shot, Sky::Even).missed;
            }
        }
    }
    assert!(missed > 200, "{missed} rays");
}

/// A body of water before other water refracts as it does alone. The clear pane of water far behind
/// changes the picture only by its own reflection, at most twice a fiftieth of the radiance, and by
/// the offset from its own thickness. Over the scene's stripes that is less than half of what the
/// refraction itself changes.
#[test]
fn water_before_water_bends_as_it_does_alone() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let clear = Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] };
    let drawn = |pane: bool, exit: Exit| {
        let config = config(size).with(|it| {
            it.coarsening = 0;
            it.sheets = 2;
            it.exit = exit;
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        let mut points = scenes::block(9, 0.25, [10, 7, 4], [-1.2, -0.9, 4.0]);
        if pane {
            points.extend(scenes::block(3, 0.3, [50, 36, 2], [-7.5, -5.4, 9.0]));
        }
        let mut shot = Shot::new(size, Lens::Standard, 0.2, &points);
        shot.scene_depth(|x, _| Some(14.0 + 0.02 * f64::from(x)));
        for (i, color) in shot.color.iter_mut().enumerate() {
            color[1] = 0.5 + 0.5 * (0.4 * (i % 97) as f32).sin();
        }
        shot.settings.water.medium = clear;
        shot.settings.water.specular = 0.0;
        let drawn = rig.draw(&shot);
        (drawn.output, drawn.depth)
    };
    let (alone, depth) = drawn(false, Exit::TwoInterfaces);
    let apart = |(other, _): (Image<[f32; 4]>, _)| {
        let front = (0..depth.data.len()).filter(|i| depth.data[*i] < 6.0);
        let off = front.map(|i| f64::from((alone.data[i][1] - other.data[i][1]).abs()));
        let all: Vec<_> = off.collect();
        assert!(all.len() > 300, "{} pixels", all.len());
        all.iter().sum::<f64>() / all.len() as f64
    };
    let before = apart(drawn(true, Exit::TwoInterfaces));
    let straight = apart(drawn(false, Exit::Straight));
    let both = apart(drawn(true, Exit::Straight));
    assert!(2.0 * before < straight, "{before}, without refraction {straight}");
    assert!(2.0 * both > straight, "{both}, although the water before water does not bend");
}

/// White furnace: clear water over a white bed in an even environment is invisible, because
/// transmitted and mirrored light add up to all of the light. Over a grey bed the picture is
/// darker, over a black bed black.
#[test]
fn clear_water_in_a_white_furnace_is_not_seen() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (mirror_steps, exit) in
        [(0, Exit::Straight), (10, Exit::Straight), (10, Exit::TwoInterfaces)]
    {
        furnace(
            &gpu,
            config(size).with(|it| {
                it.coarsening = 0;
                it.mirror_steps = mirror_steps;
                it.exit = exit;
            }),
        );
    }
}

fn furnace(gpu: &Gpu, config: Config) {
    let size = config.extent;
    let mut rig = Rig::new(gpu, &config);
    let radiance = 0.5_f32;
    rig.environment(extent(4, 2), &[[radiance, radiance, radiance, 1.0]; 8]);
    let mut shot = shot(size, Lens::Standard);
    shot.scene_depth(|_, _| Some(4.6));
    let settings = &mut shot.settings;
    settings.water.medium = Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] };
    settings.water.specular = 0.0;
    let even = [std::f32::consts::PI * radiance; 3];
    (settings.light.irradiance, settings.light.shade) = (even, even);
    let mut middle = |reflectance: f32| {
        let bed = reflectance * radiance;
        shot.color.fill([bed, bed, bed, 1.0]);
        let drawn = rig.draw(&shot);
        let water = (0..size.height as usize)
            .flat_map(|y| (0..size.width as usize).map(move |x| (x, y)))
            .filter(|&(x, y)| is_surface(f64::from(drawn.depth.at(x, y))));
        let found: Vec<_> = water.map(|(x, y)| drawn.output.at(x, y)[0]).collect();
        assert!(found.len() > 300, "{} pixels", found.len());
        let (low, high) =
            found.iter().fold((f32::MAX, 0.0_f32), |(low, high), c| (low.min(*c), high.max(*c)));
        [low / radiance, high / radiance]
    };
    // The bound is 64 roundings, as many as the twin's.
    let [low, high] = middle(1.0);
    let off = 64.0 * U as f32;
    assert!(low > 1.0 - off && high < 1.0 + off, "{low} to {high} of the radiance");
    // The picture lies between a fully wet bed at normal incidence and a dry bed or a full
    // reflection.
    let q = (1.0 - (0.02 + 0.98 / 21.0)) / (1.141_421_4_f32 / 0.858_578_6).powi(2);
    let wet = 0.4 * q / (1.0 - 0.4 * (1.0 - q));
    let [low, high] = middle(0.4);
    assert!((low - wet).abs() < 64.0 * off && high < 1.0 + off, "{low} to {high}, not from {wet}");
    let [low, high] = middle(0.0);
    assert!(low == 0.0 && high < 1.0 + off, "{low} to {high} of a black bed");
}

/// Refraction never looks up the scene in front of the water, also where the scene's depth has
/// another resolution.
#[test]
fn what_stands_before_the_water_is_not_refracted() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &config(size).with(|it| it.coarsening = 0));
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    for depth_extent in [size, extent(192, 128), extent(50, 31)] {
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            let mut shot = shot(size, lens);
            shot.settings.water.refraction = 1.5;
            shot.depth_extent = depth_extent;
            let step = depth_extent.width / 4;
            shot.scene_depth(|x, _| Some(if x / step % 2 == 0 { 1.2 } else { 30.0 }));
            let name = format!("composite-front-{lens:?}-{}", depth_extent.width);
            check(&name, &mut rig, &shot, Sky::Even);
        }
    }
}

/// Upright rails, one to three pixels wide, before the water. Pictures this high look past up to five pixels.
#[test]
fn the_scene_is_seen_past_thin_objects() {
    let gpu = Gpu::shared();
    let size = extent(320, 300);
    let mut rig = Rig::new(&gpu, &config(size).with(|it| it.coarsening = 0));
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    let mut shot = shot(size, Lens::OffAxis);
    shot.settings.water.refraction = 1.5;
    shot.scene_depth(|x, _| Some(if x % 37 < 1 + x / 37 % 3 { 1.2 } else { 30.0 }));
    check("composite-rails", &mut rig, &shot, Sky::Even);
    let drawn = rig.draw(&shot);
    let layers = Layers::new(&drawn, &shot);
    let inputs = layers.inputs(rig.config.smoothing_level, rig.config.thickness_level);
    let view = shot.view(size);
    let settings = twin_settings(&shot, &view);
    let surfaces = Surfaces::new(&inputs, &settings, &view);
    let (mut past, mut whole, mut shorter) = (0, 0, 0);
    for (x, y) in (0..300).flat_map(|y| (0..320).map(move |x| (x, y))) {
        let Some(found) = surfaces.at(x, y) else { continue };
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let displaced = look_up(&inputs, &settings, &found, &view, pixel);
        let (at, _) = cut_look_up(&inputs, -found.position.z, pixel, displaced);
        let longer = pixel.distance(at) - pixel.distance(displaced);
        *match longer {
            l if l > 0.0 => &mut past,
            0.0 => &mut whole,
            _ => &mut shorter,
        } += 1;
    }
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("{past} past rails, {whole} whole, {shorter} shorter");
    }
    assert!(past > 500 && shorter > 500, "{past} past, {whole} whole, {shorter} shorter");
}
