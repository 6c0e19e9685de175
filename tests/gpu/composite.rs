//! Pass `composite`: against the twin, on the layers read back.

use glam::{DVec2, DVec3};
use whitewater::Config;
use whitewater::water::{Fresnel, Medium, Splat};

use crate::reduce::wide;
use crate::reference::composite::{self as twin, Inputs, hidden, look_up, surface};
use crate::reference::{Image, View, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens};
use crate::support::tolerance::{U, reach};

/// What the environment is, for the picture and its twin.
#[derive(Clone, Copy, PartialEq)]
enum Sky {
    /// A constant that half precision holds.
    Even,
    /// `0.5 + 0.25 d.y` and `0.5 + 0.25 d.x`, the third channel even.
    Slope,
}

const CUBE: f64 = 64.0;
const SKY: (u32, u32) = (256, 128);

impl Sky {
    fn radiance(self, d: DVec3) -> DVec3 {
        match self {
            Self::Even => DVec3::new(0.5, 0.75, 1.25),
            Self::Slope => DVec3::new(0.5 + 0.25 * d.y, 0.5 + 0.25 * d.x, 0.5),
        }
    }

    /// Row 0 is up, the middle column looks along -z, the right quarter along +x.
    fn texels(self) -> Vec<[f32; 4]> {
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

    /// Error of the cube: linear interpolation in it and in the image that it is made of misses
    /// h² / 8 of the second derivative (0.25) an axis, four samples a texel as much again; half
    /// precision keeps 2^-11 of 0.75; the weights are of `bits` bits of a texel's difference.
    fn error(self, bits: u32) -> f64 {
        if self == Self::Even {
            return 0.0;
        }
        let texel = std::f64::consts::FRAC_PI_2 / CUBE * 1.3;
        let from = std::f64::consts::PI / f64::from(SKY.1);
        let interpolation = 0.25 * (2.0 * texel * texel + from * from) / 4.0;
        interpolation + 0.75 / 2048.0 + 2.0 * 0.25 * texel / f64::from(1 << bits)
    }
}

fn twin_settings(shot: &Shot, view: &View) -> twin::Settings {
    let (water, light) = (&shot.settings.water, &shot.settings.light);
    let rgb = |c: [f32; 3]| c.map(f64::from);
    twin::Settings {
        radius: f64::from(water.radius()),
        refraction: f64::from(water.refraction),
        medium: match water.medium {
            Medium::Physical { absorption, scattering } => twin::Medium::Physical {
                absorption: rgb(absorption),
                scattering: rgb(scattering),
                ambient: rgb(light.ambient),
            },
            Medium::Source { base, falloff } => {
                twin::Medium::Source { base: rgb(base), k: falloff.map(f64::from) }
            }
        },
        fresnel: match water.fresnel {
            Fresnel::Schlick { f0 } => twin::Fresnel::Schlick { f0: f64::from(f0) },
            Fresnel::Source { bias, scale, power } => twin::Fresnel::Source {
                bias: f64::from(bias),
                scale: f64::from(scale),
                power: f64::from(power),
            },
        },
        specular: [f64::from(water.specular); 3],
        shininess: f64::from(water.shininess),
        sun_direction: view.view.transform_vector3(rgb(light.direction).into()).normalize(),
        sun_color: rgb(light.color),
    }
}

/// Whether a difference of the surface round a pixel is so near to the border threshold that
/// rounding decides.
fn undecided(inputs: &Inputs<'_>, threshold: f64, x: usize, y: usize) -> bool {
    let front = inputs.depth.at(x, y);
    let block = f64::from(1 << inputs.level);
    let base = (DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / block - 0.5).floor();
    let near =
        |difference: f64, z: f64| (difference.abs() - threshold).abs() <= 8.0 * U * z.min(front);
    let at = |x: isize, y: isize| inputs.smoothed.clamped(x, y);
    (-1..3_isize).flat_map(|dy| (-1..3_isize).map(move |dx| (dx, dy))).any(|(dx, dy)| {
        let (x, y) = (base.x as isize + dx, base.y as isize + dy);
        let here = at(x, y);
        near(here - front, front)
            || near(here - at(x + 1, y), here)
            || near(here - at(x, y + 1), here)
    })
}

/// How far the picture may be off, from u and the numbers of the pixel:
/// the normal by 32u times the condition of its tangents, the colour's slope times what that moves
/// the look-up (and a texel's difference times the filter's weight step); absorption by 16u of the
/// exponent; Fresnel and highlight by their slopes times the normal, and pow's own error; the
/// environment by its own.
fn tolerance(
    shot: &Shot,
    settings: &twin::Settings,
    surface: &twin::Surface,
    view: &View,
    sky: Sky,
    bits: u32,
) -> ([f64; 4], f64) {
    let z = -surface.position.z;
    let normal = 32.0 * U * surface.condition * (1.0 + reach(view));
    let path = surface.thickness * surface.position.length() / z;
    let pixels = surface.thickness * settings.refraction / (view.c_x().min(view.c_y()) * z);
    let moved = pixels * (normal + 16.0 * U) + 8.0 * U * view.extent().max_element();
    // The scene's colour: see `gradient`.
    let slope = 1.0 / 256.0;
    let behind = slope * (2.0 * moved + 2.0 / f64::from(1 << bits));
    let light = |i: usize| f64::from(shot.settings.light.ambient[i]) + 1.0;
    let extinction = match settings.medium {
        twin::Medium::Physical { absorption, scattering, .. } => {
            [0, 1, 2].map(|i| absorption[i] + scattering[i])
        }
        twin::Medium::Source { k, .. } => [0, 1, 2].map(|i| k[i] + k[3]),
    };
    let v = -surface.position.normalize();
    // pow(x, y) = exp2(y log2 x); near 1 log2 has an absolute error of 2^-21.
    let power_of = |x: f64, y: f64| {
        let x = (x + 2.0 * normal + 8.0 * U).clamp(0.0, 1.0);
        y * x.powf(y - 1.0) * (2.0 * normal + 8.0 * U + x / f64::from(1 << 21))
    };
    let grazing = 1.0 - surface.normal.dot(v);
    let fresnel = match settings.fresnel {
        twin::Fresnel::Source { scale, power, .. } => scale * power_of(grazing, power),
        twin::Fresnel::Schlick { .. } => power_of(grazing, 5.0),
    };
    let half = (v + settings.sun_direction).normalize_or_zero();
    let shine = power_of(surface.normal.dot(half).max(0.0), settings.shininess);
    let mut tolerance = [0.0; 4];
    for (i, t) in tolerance.iter_mut().take(3).enumerate() {
        let absorbed = (16.0 * extinction[i] * path * U + 16.0 * U) * light(i);
        let sun = settings.specular[i] * settings.sun_color[i];
        *t = behind
            + absorbed
            + 2.0 * (fresnel + 32.0 * U)
            + sky.error(bits)
            + sun * (shine + 32.0 * U);
    }
    (tolerance, moved)
}

fn check(name: &str, rig: &mut Rig<'_>, shot: &Shot, sky: Sky) {
    let (size, level) = (rig.config.extent, rig.config.smoothing_level);
    let drawn: Drawn = rig.draw(shot);
    let view = shot.view(size);
    let settings = twin_settings(shot, &view);
    let (width, height) = (size.width as usize, size.height as usize);
    let color = shot.color.iter().map(|c| c.map(f64::from)).collect();
    let color = Image::from_vec(width, height, color).expect("the output's size");
    let (depth, smoothed) = (wide(&drawn.depth), wide(&drawn.surface));
    let (thickness, scene) = (drawn.thickness.map(|t| f64::from(*t)), shot.scene_eye());
    let inputs = Inputs {
        depth: &depth,
        smoothed: &smoothed,
        level,
        thickness: &thickness,
        thickness_level: rig.config.thickness_level,
        scene_color: &color,
        scene_depth: &scene,
    };
    let mut expected = twin::shade(&inputs, &settings, |d| sky.radiance(d), &view);
    let bits = rig.gpu.limits().sub_texel_precision_bits;
    let (mut water, mut skipped) = (0, 0);
    let mut bounds = Image::new(width, height, [0.0; 4]);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        if !is_surface(depth.at(x, y)) {
            continue;
        }
        water += 1;
        let found = surface(&inputs, settings.radius, &view, x, y).expect("a surface");
        let (bound, moved) = tolerance(shot, &settings, &found, &view, sky, bits);
        // A look-up as near to the next texel as it is uncertain may meet another scene.
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let q = look_up(&settings, &found, &view, pixel);
        let z = -found.position.z;
        let sides = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        // Gathers go by coordinates of as many bits as filters.
        let texel = size.width as f64 / shot.depth_extent.width.min(size.width) as f64;
        let moved = moved + 2.0 * texel / f64::from(1 << bits);
        let either = sides.map(|(dx, dy)| hidden(&inputs, z, q + DVec2::new(dx, dy) * moved));
        if undecided(&inputs, 5.3 * settings.radius, x, y) || either.iter().any(|h| *h != either[0])
        {
            skipped += 1;
            *expected.at_mut(x, y) = drawn.output.at(x, y).map(f64::from);
        }
        *bounds.at_mut(x, y) = bound;
    }
    let census = compare::close_color(name, &drawn.output, &expected, |x, y| bounds.at(x, y));
    assert!(water > 300 && skipped * 50 <= water, "{name}: {skipped} of {water} undecided");
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("{name}: {skipped} of {water} undecided, {census}");
    }
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
        for sky in [Sky::Even, Sky::Slope] {
            let config = Config {
                smoothing_level: level,
                thickness_level,
                environment_size: CUBE as u32,
                coarsening: 0,
                ..config(size)
            };
            let mut rig = Rig::new(&gpu, &config);
            rig.environment(extent(SKY.0, SKY.1), &sky.texels());
            let lenses: &[Lens] = match (level, thickness_level) {
                (1, 1) => &LENSES,
                _ => &[Lens::Standard, Lens::OffAxis],
            };
            for lens in lenses {
                let name = format!("composite-{level}{thickness_level}-{lens:?}-{}", sky as u8);
                check(&name, &mut rig, &shot(size, *lens), sky);
            }
        }
    }
}

#[test]
fn every_medium_and_reflectance() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &Config { depth_splat: Some(Splat::Raster), ..config(size) });
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    let media = [
        ("clear", Medium::CLEAR),
        ("milk", Medium::MILK),
        ("source", Medium::source(0.3)),
        ("none", Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] }),
    ];
    let fresnels = [
        ("schlick", Fresnel::Schlick { f0: 0.02 }),
        ("source", Fresnel::Source { bias: 0.1, scale: 0.4, power: 2.0 }),
    ];
    for (medium_name, medium) in media {
        for (fresnel_name, fresnel) in fresnels {
            let mut shot = shot(size, Lens::Standard);
            shot.settings.water.medium = medium;
            shot.settings.water.fresnel = fresnel;
            check(&format!("composite-{medium_name}-{fresnel_name}"), &mut rig, &shot, Sky::Even);
        }
    }
}

/// Refraction never looks at what stands before the water; the scene's depth may be of another size.
#[test]
fn what_stands_before_the_water_is_not_refracted() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::new(&gpu, &config(size));
    rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
    for depth_extent in [size, extent(192, 128), extent(50, 31)] {
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            let mut shot = shot(size, lens);
            shot.settings.water.refraction = 1.5;
            shot.depth_extent = depth_extent;
            let step = depth_extent.width / 8;
            shot.scene_depth(|x, _| Some(if x / step % 2 == 0 { 1.2 } else { 30.0 }));
            let name = format!("composite-front-{lens:?}-{}", depth_extent.width);
            check(&name, &mut rig, &shot, Sky::Even);
        }
    }
}
