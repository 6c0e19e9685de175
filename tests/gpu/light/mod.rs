//! Passes `light`, `caustics` and `lit`: the light maps are compared with the twin, and the picture
//! with the maps. This module has the scenes and the twin's input.

mod caustics;
mod lit;
mod maps;
mod shade;
mod spray;
mod unchanged;
mod whitewater_light;

use ash::vk;
use glam::{DVec3, Vec3};
use whitewater::water::{Medium, Shadows};
use whitewater::{Config, LightVolume};

use crate::reference::light::{Light, Maps, Particle};
use crate::support::rig::{Drawn, Shot, config};
use crate::support::scenes::{self, Lens, Random};
use crate::surface_foam::Foamy;

pub use shade::{check_foam, even, light_views, middle, shadows, wall};

pub const SIZE: vk::Extent2D = vk::Extent2D { width: 97, height: 61 };

pub fn casting(texels: u32) -> Config {
    config(SIZE).with(|it| {
        it.light_map_size = Some(texels);
        it.surface_foam = true;
    })
}

fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

/// The numbers in half precision around an interval. A store may round to either neighbour.
fn halves(low: f64, high: f64) -> [f64; 2] {
    [(low, false), (high, true)].map(|(v, up)| {
        let near = half::f16::from_f64(v);
        let off = match up {
            true => near.to_f64() < v,
            false => near.to_f64() > v,
        };
        // For positive numbers, the order of the bits is the order of the values.
        let bits = i32::from(near.to_bits()) + i32::from(off) * if up { 1 } else { -1 };
        half::f16::from_bits(bits.max(0) as u16).to_f64()
    })
}

/// A normalized direction in single precision.
fn toward(x: f32, y: f32, z: f32) -> [f32; 3] {
    Vec3::new(x, y, z).normalize().to_array()
}

/// The twin's light for a shot.
fn twin(shot: &Shot, config: &Config) -> Light {
    let (water, region) = (&shot.settings.water, shot.light_volume.expect("a region"));
    let [first, second, third] = match config.spray {
        true => [
            shot.settings.spray.all_spray_density,
            shot.settings.spray.full_water_density,
            shot.settings.spray.no_spray_density,
        ],
        false => [water.density_threshold, water.density_full, water.density_threshold],
    };
    let density = |part: f32| f64::from(part) * f64::from(water.rest_density);
    Light {
        sun: wide(shot.settings.light.direction),
        center: wide(region.center),
        radius: f64::from(region.radius),
        texels: config.light_map_size.expect("maps") as usize,
        spacing: f64::from(water.spacing),
        densities: [density(first), density(second), density(third)],
        // What is not drawn casts no shadow.
        shade: if config.spray { f64::from(shot.settings.spray.shade) } else { 0.0 },
        several: shot.settings.spray.droplets > 1,
        spread: 0.6 * f64::from(shot.settings.spray.scatter_radius * shot.settings.water.spacing),
        width: f64::from(water.smoothing_width),
        falloff: f64::from(water.depth_falloff),
        extinction: match water.medium {
            Medium::Physical { absorption, scattering }
            | Medium::Turbid { absorption, scattering, .. } => {
                [0, 1, 2].map(|i| f64::from(absorption[i]) + f64::from(scattering[i]))
            }
            Medium::Source { falloff, .. } => [0, 1, 2].map(|i| f64::from(falloff[i])),
        },
        foam_extinction: f64::from(shot.settings.surface_foam.shadow),
        intensity: [
            shot.settings.whitewater.half_intensity_thickness,
            shot.settings.whitewater.exponent,
        ]
        .map(f64::from),
        waves: None,
    }
}

fn particles(case: &Foamy) -> Vec<Particle> {
    (0..case.shot.positions.len())
        .map(|i| Particle {
            position: wide(case.shot.positions[i]),
            density: case.shot.densities.as_ref().map(|d| f64::from(d[i])),
            foam: f64::from(case.amounts[i][0]),
        })
        .collect()
}

fn maps(drawn: &Drawn) -> Maps<'_> {
    Maps {
        front: drawn.light_front.as_ref().expect("a front"),
        thickness: drawn.light_thickness.as_ref().expect("a thickness"),
        caustics: drawn.caustics.as_ref().expect("caustics"),
        whitewater: drawn.light_whitewater.as_ref(),
    }
}

/// A shot without foam.
fn water(shot: Shot) -> Foamy {
    let n = shot.positions.len();
    Foamy { shot, amounts: vec![[0.0; 2]; n], velocities: vec![[0.0; 3]; n], ids: None }
}

/// A pool with waves, and drops above it, around the world's origin.
fn pool(sun: [f32; 3], wave: f32, drops: usize) -> Foamy {
    let s = 0.1_f32;
    let mut random = Random(3);
    let mut points = Vec::new();
    for (i, j, k) in (0..20).flat_map(|i| (0..20).flat_map(move |j| (0..4).map(move |k| (i, j, k))))
    {
        let at = |i: i32, random: &mut Random| s * (i as f32 - 9.5 + random.between(-0.2, 0.2));
        let (x, z) = (at(i, &mut random), at(j, &mut random));
        points.push([x, wave * (4.0 * x + 2.0 * z).sin() - s * k as f32, z]);
    }
    for _ in 0..drops {
        let mut at = |low, high| random.between(low, high);
        points.push([at(-0.9, 0.9), at(0.3, 0.9), at(-0.9, 0.9)]);
    }
    let mut shot = Shot::new(SIZE, Lens::Standard, 0.656 * s, &[]);
    shot.positions = points;
    shot.settings.light.direction = sun;
    shot.light_volume = Some(LightVolume { center: [0.0, 0.1, 0.0], radius: 1.6 });
    water(shot)
}

/// A configuration with everything that the sun lights, and particles of all kinds.
pub fn everything(case: &mut Foamy) -> Config {
    let n = case.shot.positions.len();
    let mut random = Random(12);
    case.shot.densities = Some((0..n).map(|_| random.between(300.0, 1000.0)).collect());
    let center = scenes::world(&case.shot.camera, &[[0.0, 0.0, 5.0]])[0];
    case.shot.light_volume = Some(LightVolume { center, radius: 6.0 });
    casting(64).with(|it| {
        it.spray = true;
        it.shadow = Some(Shadows::Mask);
        it.sheets = 2;
    })
}
