//! Compares the cube maps that pass `environment` makes of a map and of the sky, and their mip
//! levels, with the CPU twins.

use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use whitewater::headless::Whitewater;
use whitewater::{EnvironmentSource, Sky, WhitewaterConfig};

use crate::reference::Image;
use crate::reference::environment as twin;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens, Random};
use crate::support::spy;
use crate::support::tolerance::U;

const FORMAT: ash::vk::Format = ash::vk::Format::R16G16B16A16_SFLOAT;

/// Error of a conversion to half precision, which may go to either neighbour: one step, at most
/// 2^-10 of the value and at least 2^-24.
fn half_step(value: f64) -> f64 {
    (value.abs() / 1024.0).max(1.0 / (1 << 24) as f64)
}

/// All faces of each mip level, below each other.
fn cube(rig: &Rig<'_>) -> Vec<Image<[f32; 4]>> {
    let size = rig.config.environment_size;
    let state = whitewater::Access::new(
        ash::vk::PipelineStageFlags2::FRAGMENT_SHADER
            | ash::vk::PipelineStageFlags2::COMPUTE_SHADER,
        ash::vk::AccessFlags2::SHADER_SAMPLED_READ,
        ash::vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    );
    let mips = rig.stub.download_cube(spy::cube(), FORMAT, size, state);
    let width = |mip: usize| (size >> mip) as usize;
    let image = |(mip, bytes): (usize, &Vec<u8>)| Image {
        width: width(mip),
        height: 6 * width(mip),
        data: bytes
            .chunks_exact(8)
            .map(bytemuck::pod_read_unaligned::<[u16; 4]>)
            .map(|c| c.map(|v| half::f16::from_bits(v).to_f32()))
            .collect(),
    };
    mips.iter().enumerate().map(image).collect()
}

/// Error of a position in a map, in texels. A direction's components err by 8u (pixel to 0..1,
/// normalization), which turns the angle by that over the distance from the axis. atan and acos may
/// err by 4096 ulp (8192u), acos also by the cancellation in 1 - y²; sums and quotients add 8u.
/// Filters know positions to 2^-bits.
fn nudge(d: DVec3, turn: f64, map: &Image<[f32; 4]>, bits: u32) -> DVec2 {
    let unit = d.normalize();
    let away = DVec2::new(unit.x, unit.z).length();
    let (east, down) = (unit.x.atan2(-unit.z), unit.y.acos());
    let east = U * (8.0 / away + 8192.0 * east.abs() + 8.0 * (east.abs() + turn.abs() + PI));
    let down = U * (12.0 / away + 8200.0 * down);
    let filter = 1.0 / f64::from(1 << bits);
    DVec2::new(east / TAU * map.width as f64, down / PI * map.height as f64) + filter
}

/// Compares a cube's first mip level with the twin, and each other level with means of the one
/// before.
fn check(name: &str, rig: &Rig<'_>, expected: impl Fn(usize, DVec2) -> (DVec3, DVec3) + Sync) {
    let mips = cube(rig);
    let size = mips[0].width;
    let both = Image::from_fn(size, 6 * size, |x, y| {
        expected(y / size, DVec2::new(x as f64, (y % size) as f64))
    });
    let value = both.map(|(value, _)| value.extend(1.0).to_array());
    let bound = both.map(|(_, bound)| bound.extend(0.0).to_array());
    let census = compare::close_color(name, &mips[0], &value, |x, y| bound.at(x, y));
    verbose(name, &census);
    for (mip, pair) in mips.windows(2).enumerate() {
        let mean = Image::from_fn(pair[1].width, pair[1].height, |x, y| {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)]
                .map(|(dx, dy)| pair[0].at(2 * x + dx, 2 * y + dy).map(f64::from));
            [0, 1, 2, 3].map(|i| four.iter().map(|c| c[i]).sum::<f64>() / 4.0)
        });
        let name = format!("{name}-mip-{}", mip + 1);
        let close = |x: usize, y: usize| mean.at(x, y).map(|v| 8.0 * U * v.abs() + half_step(v));
        let census = compare::close_color(&name, &pair[1], &mean, close);
        verbose(&name, &census);
    }
}

fn verbose(name: &str, census: &crate::reference::Census) {
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("{name}: {census}");
    }
}

/// The twin's cube map of a map that is scaled and turned, and its bounds. `size`: edge of a face.
/// `bits`: precision of filtered positions. `up`: number of the world's axis that points up.
fn cube_of(
    map: &Image<[f32; 4]>,
    (size, bits): (u32, u32),
    (scale, turn): (f64, f64),
    up: usize,
) -> impl Fn(usize, DVec2) -> (DVec3, DVec3) + Sync {
    move |face: usize, at: DVec2| {
        let (x, y) = (at.x as usize, at.y as usize);
        let (mut value, mut bound) = (DVec3::ZERO, DVec3::ZERO);
        for st in twin::quarters(x, y, size as usize) {
            let d = twin::standing(twin::direction(face, st), up);
            let nudge = nudge(d, turn, map, bits);
            let position = twin::map_position(d, turn, map.width, map.height);
            let found = twin::sample(map, position, nudge);
            value += found.value * scale / 4.0;
            bound += (found.slope[0] * nudge.x + found.slope[1] * nudge.y) * scale / 4.0;
        }
        let rounding = value.to_array().map(|v| 8.0 * U * v + half_step(v));
        (value, bound + DVec3::from(rounding))
    }
}

/// The texels are random, so that none can stand for another. Up is each of the world's axes.
#[test]
fn a_map_becomes_the_twins_cube() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let gpu = gpu;
    let bits = gpu.limits().sub_texel_precision_bits;
    let mut random = Random(11);
    for (size, width, height) in [(16, 64, 32), (64, 33, 17), (32, 256, 128), (16, 1, 1)] {
        let config = config(extent(16, 8)).with(|it| it.environment_size = size);
        let mut rig = Rig::new(&gpu, &config);
        let texels: Vec<[f32; 4]> = (0..width * height)
            .map(|_| [0, 1, 2].map(|i| random.between(0.0, [1.0, 4.0, 0.1][i])))
            .map(|[r, g, b]| [r, g, b, 0.5])
            .collect();
        let map = Image { width, height, data: texels.clone() };
        for (scale, turn) in [(1.0_f32, 0.0_f32), (2.5, 0.7), (1.0, -2.5), (0.5, 7.0)] {
            let map_extent = extent(width as u32, height as u32);
            for up in [1, 0, 2] {
                let mut upward = [0.0; 3];
                upward[up] = 2.0;
                rig.turned_environment(map_extent, &texels, (scale, turn, upward));
                let of = (f64::from(scale), f64::from(turn));
                let expected = cube_of(&map, (size, bits), of, up);
                let name = format!("environment-{width}x{height}-{size}-{turn:.1}-{up}");
                check(&name, &rig, expected);
            }
        }
    }
}

/// A map with three bad numbers, and the map that it counts as.
fn spoilt() -> [Image<[f32; 4]>; 2] {
    let mut random = Random(12);
    let (width, height) = (32, 16);
    let texel = |_| [0, 1, 2, 3].map(|_| random.between(0.0, 1.0));
    let mended = Image { width, height, data: (0..width * height).map(texel).collect() };
    let mut maps = [mended.clone(), mended];
    // The first one is at the edge, where columns wrap around.
    for (x, y, c, bad, good) in
        [(0, 5, 0, f32::NAN, 0.0), (9, 8, 1, -1.0, 0.0), (20, 10, 2, f32::INFINITY, 65_000.0)]
    {
        for (map, value) in maps.iter_mut().zip([bad, good]) {
            map.at_mut(x, y)[c] = value;
        }
    }
    maps
}

/// Texels that are NaN or negative count as 0, infinite ones as 65 000.
#[test]
fn what_is_no_radiance_is_mended() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let gpu = gpu;
    let bits = gpu.limits().sub_texel_precision_bits;
    let size = 16;
    let mut rig = Rig::new(&gpu, &config(extent(16, 8)).with(|it| it.environment_size = size));
    let [bad, mended] = spoilt();
    for (scale, turn) in [(1.0_f32, 0.0_f32), (0.5, 0.7)] {
        rig.turned_environment(extent(32, 16), &bad.data, (scale, turn, [0.0, 1.0, 0.0]));
        let expected = cube_of(&mended, (size, bits), (scale.into(), turn.into()), 1);
        check(&format!("environment-spoilt-{turn:.1}"), &rig, expected);
    }
    // A factor of 0 leaves nothing, not even of radiance that is too large for the sum of samples.
    rig.turned_environment(extent(2, 1), &[[f32::MAX; 4]; 2], (0.0, 0.0, [0.0, 1.0, 0.0]));
    check("environment-none", &rig, |_, _| (DVec3::ZERO, DVec3::splat(half_step(0.0))));
}

/// Light of an environment on foam without sunlight, for each pixel that shows foam.
fn on_foam(rig: &mut Rig<'_>, map: &Image<[f32; 4]>) -> Vec<[f32; 4]> {
    rig.environment(extent(map.width as u32, map.height as u32), &map.data);
    let mut shot = Shot::new(rig.config.extent, Lens::Standard, 0.1, &[]);
    shot.settings.whitewater.radius = 0.5;
    shot.settings.light.shade = shot.settings.light.irradiance;
    let positions = scenes::world(&shot.camera, &scenes::cloud(3, 60, 2.0, 4.0));
    let input =
        Whitewater { positions: &positions, kinds: None, radii: None, ages: None, ids: None };
    let (water, foam) = (rig.particles(&shot), rig.whitewater(&input));
    let drawn = rig.draw_whitewater(&shot, &water.particles(), Some(foam.particles()));
    let drawn = drawn.whitewater.expect("foam");
    let pixels = drawn.light.data.iter().zip(&drawn.occluders.data);
    pixels.filter(|(_, texel)| texel[0] < 1e9).map(|(light, _)| *light).collect()
}

/// No bad texel reaches the irradiance, which is a sum over all of the environment. Filters know
/// their weights to 2^-bits, and a texel takes part in samples of an area of four texels, with a
/// mean weight of a quarter: its sum errs by eight times that, in x and y together. The irradiance
/// and the light are rounded to half precision.
#[test]
fn what_is_no_radiance_lights_nothing() {
    let gpu = Gpu::shared();
    let foam = config(extent(48, 32)).with(|it| it.whitewater = Some(WhitewaterConfig::new(64)));
    let mut rig = Rig::new(&gpu, &foam);
    let [found, expected] = spoilt().map(|map| on_foam(&mut rig, &map));
    let lit = expected.iter().filter(|light| light[0] > 0.0).count();
    assert!(lit > 100 && found.len() == expected.len(), "{lit} of {}", expected.len());
    let bits = gpu.limits().sub_texel_precision_bits;
    let by = 8.0 / f64::from(1 << bits) + 4.0 / 1024.0;
    for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
        for c in 0..3 {
            let [found, expected] = [found, expected].map(|light| f64::from(light[c]));
            let off = (found - expected).abs();
            assert!(off <= by * expected, "{i} {c}: {found}, not {expected}");
        }
    }
}

/// From noon to after sunset, and a sun direction that is not of unit length.
#[test]
fn the_sky_becomes_the_twins_cube() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let gpu = gpu;
    let size = 32;
    let mut rig = Rig::new(&gpu, &config(extent(16, 8)).with(|it| it.environment_size = size));
    for (sun, intensity) in [
        (Sky::default().sun, 20.0),
        ([0.0, 3.0, 0.0], 1.0),
        ([0.9, 0.03, -0.4], 20.0),
        ([-0.5, -0.1, 0.5], 5.0),
    ] {
        rig.any_environment(&EnvironmentSource::Sky(Sky::default().with(|it| {
            it.sun = sun;
            it.intensity = intensity;
        })));
        let to = DVec3::from(sun.map(f64::from)).normalize();
        let expected = |face: usize, at: DVec2| {
            let d = twin::direction(face, (at + 0.5) / f64::from(size)).normalize();
            let found = twin::sky(d, to, twin::SKY_STEPS);
            let (value, error) = (found.value, found.error);
            let value = value * f64::from(intensity);
            let bound = error * f64::from(intensity) + DVec3::from(value.to_array().map(half_step));
            (value, bound)
        };
        check(&format!("environment-sky-{:.2}", sun[1]), &rig, expected);
    }
}

/// Radiance is limited to the range of half precision, so all mip levels are finite.
#[test]
fn radiance_over_half_precision_is_cut() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let gpu = gpu;
    let mut rig = Rig::new(&gpu, &config(extent(16, 8)));
    let bright = [[1.0, 30.0, 1e30, 1.0]; 2];
    rig.turned_environment(extent(2, 1), &bright, (2500.0, 0.0, [0.0, 1.0, 0.0]));
    check("environment-bright", &rig, |_, _| {
        let value = DVec3::new(2500.0, 65_000.0, 65_000.0);
        (value, DVec3::from(value.to_array().map(half_step)))
    });
}
