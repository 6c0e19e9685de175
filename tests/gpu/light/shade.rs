//! Foam in shadow: of the host's mask, of the host's map, and of foam and water.

use ash::vk;
use glam::{DVec3, Mat4, Vec3};
use whitewater::water::{Medium, Shading, Shadows};
use whitewater::{Access, LightVolume, Shadow};

use crate::reference::Image;
use crate::reference::light::ShadowMap;
use crate::support::device::Gpu;
use crate::support::host::{DEPTH, Texture};
use crate::support::rig::{Drawn, Rig, Shot, extent};
use crate::support::rounded::{Rounded, exact, off};
use crate::support::scenes::{self, Lens, Random};
use crate::support::tolerance::U;
use crate::surface_foam::Foamy;

use super::{SIZE, casting, maps, twin, water, wide};

const SAMPLED: Access = Access::new(
    vk::PipelineStageFlags2::FRAGMENT_SHADER,
    vk::AccessFlags2::SHADER_SAMPLED_READ,
    vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
);

/// A host's shadow image, as a mask or as a map.
pub fn shadows(rig: &Rig<'_>, kind: Shadows, texels: &Image<f32>) -> Texture {
    let size = extent(texels.width as u32, texels.height as u32);
    let bytes = bytemuck::cast_slice(&texels.data);
    let sampled = vk::ImageUsageFlags::SAMPLED;
    match kind {
        Shadows::Mask => rig.stub.uploaded(vk::Format::R32_SFLOAT, size, sampled, bytes, SAMPLED),
        Shadows::Map | Shadows::Convolution(_) => {
            let usage = sampled | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
            rig.stub.uploaded(vk::Format::D32_SFLOAT, size, usage, bytes, DEPTH)
        }
    }
}

/// A uniform mask.
pub fn even(rig: &Rig<'_>, sun: f32) -> (Texture, Shadow) {
    let image = shadows(rig, Shadows::Mask, &Image::new(3, 2, sun));
    let shadow = Shadow::new(image.host_image(), Mat4::ZERO.to_cols_array_2d());
    (image, shadow)
}

/// An opaque wall of foam, of one colour where the sun shines.
pub fn wall(lens: Lens) -> Foamy {
    let block = scenes::block(3, 0.1, [44, 30, 3], [-2.2, -1.5, 2.0]);
    let mut case = water(Shot::new(SIZE, lens, 0.0656, &block));
    case.amounts.fill([1.0, 0.0]);
    let settings = &mut case.shot.settings;
    (
        settings.surface_foam.normal_strength,
        settings.surface_foam.noise,
        settings.surface_foam.min_thickness,
    ) = (0.0, 0.0, 0.0);
    settings.surface_foam.pattern = 0.0;
    (settings.surface_foam.extinction, settings.surface_foam.front_extinction) = (1e5, 1e6);
    settings.surface_foam.front_color = [0.9, 0.8, 0.7];
    settings.light.irradiance = [std::f32::consts::PI; 3];
    settings.light.shade = [0.0, 0.25 * std::f32::consts::PI, 0.5 * std::f32::consts::PI];
    case
}

/// A particle's position in the world, and the error that single precision adds to it.
pub fn middle(shot: &Shot, position: [f32; 3]) -> (DVec3, f64) {
    let view = shot.view(SIZE).view;
    let (p, eye) = (wide(position), view.inverse().w_axis.truncate().length());
    // The position is transformed to eye space and back, by a matrix that is itself rounded.
    (p, U * (8.0 * view.transform_point3(p).length() + 24.0 * (p.length() + 2.0 * eye)))
}

/// Checks that the foam layer's light is that of its sprites, by the sun's visible fraction at each
/// centre. Opaque foam must have the colour that this light and the mask give. The test needs
/// pixels in sun, in shade and between.
pub fn check_foam(
    name: &str,
    case: &Foamy,
    drawn: &Drawn,
    sun: Option<&dyn Fn(DVec3, f64) -> [Rounded; 3]>,
    mask: impl Fn((usize, usize)) -> f64,
) {
    let (settings, foam) = (&case.shot.settings, drawn.foam.as_ref().expect("foam"));
    let mut sprites = case.sprites();
    let mut sharp = 0;
    for (sprite, position) in sprites.iter_mut().zip(&case.shot.positions) {
        let Some(sun) = sun else { break };
        let (p, by) = middle(&case.shot, *position);
        let [r, g, b] = sun(p, by);
        let share = off(1.0 / 3.0, 1.0) * (r + g + b);
        sprite.sun = [-1.0, 1.0].map(|sign| (share.v + sign * share.e).clamp(0.0, 1.0));
        sharp += usize::from(sprite.sun[1] - sprite.sun[0] < 0.01);
    }
    if sun.is_some() {
        let (few, all) = (sprites.len() - sharp, sprites.len());
        assert!(few * 4 < all, "{name}: of {all} sprites the light of {few} is open");
    }
    crate::surface_foam::check_sprites(name, case, &sprites, drawn, 0);

    let (mut seen_foam, mut kinds, mut wrong) = (0, [0; 3], String::new());
    for (i, found) in drawn.output.data.iter().enumerate() {
        let (x, y) = (i % drawn.output.width, i / drawn.output.width);
        let [_, front] = foam.thickness.data[i];
        if foam.depth.data[i] >= 1e9 || front < 1e-3 {
            continue;
        }
        seen_foam += 1;
        let lit = foam.lit.data[i];
        let sun = exact(mask((x, y))) * off(f64::from(lit) / f64::from(front), 4.0);
        let sun = sun.clamp(0.0, 1.0);
        kinds[((3.0 * sun.v) as usize).min(2)] += 1;
        for (c, v) in found.iter().take(3).enumerate() {
            let (shade, most) = (settings.light.shade[c], settings.light.irradiance[c]);
            let white = f64::from(settings.surface_foam.front_color[c]) * f64::from(most)
                / std::f64::consts::PI;
            let dark = off(f64::from(shade) / f64::from(most), 5.0);
            let expected = off(white, 40.0) * (dark + (exact(1.0) - dark) * sun);
            let v = f64::from(*v);
            if (v - expected.v).abs() > expected.e + 40.0 * U {
                wrong += &format!("({x}, {y}) {c}: {v}, not {expected:?}, sun {sun:?}\n");
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{name}: {} lines\n{}",
        wrong.lines().count(),
        &wrong[..wrong.len().min(900)]
    );
    assert!(seen_foam > 3000 && kinds.iter().all(|n| *n > 40), "{name}: {seen_foam}, {kinds:?}");
}

#[test]
fn foam_is_in_the_shade_of_a_mask() {
    let gpu = Gpu::shared();
    for composite in [Shading::Raster, Shading::Compute] {
        let config = casting(16).with(|it| {
            it.light_map_size = None;
            it.shadow = Some(Shadows::Mask);
            it.thickness_level = 0;
            it.composite = Some(composite);
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut random = Random(2);
        for (width, height) in [(97, 61), (13, 7), (200, 99)] {
            let mut case = wall(Lens::OffAxis);
            let mut whole = Image::new(width + 5, height + 3, 0.5_f32);
            whole.data.iter_mut().for_each(|v| *v = random.between(-0.5, 1.5));
            let image = shadows(&rig, Shadows::Mask, &whole);
            // Only a part of the image is the mask.
            let mut host = image.host_image();
            host.rect.offset = vk::Offset2D { x: 2, y: 1 };
            host.rect.extent = extent(width as u32, height as u32);
            case.shot.shadow =
                Some(Shadow::new(host, Mat4::NAN.to_cols_array_2d()).with(|it| it.bias = f32::NAN));
            let drawn = case.draw(&mut rig);
            check_foam(&format!("mask-{composite:?}-{width}"), &case, &drawn, None, |(x, y)| {
                let part = |i: usize, texels: usize, pixels: u32| {
                    ((i as f64 + 0.5) / f64::from(pixels) * texels as f64).floor() as usize
                };
                let at = (part(x, width, SIZE.width), part(y, height, SIZE.height));
                f64::from(whole.at(at.0 + 2, at.1 + 1)).clamp(0.0, 1.0)
            });
        }
    }
}

/// Views of a light: parallel and perspective, with standard and reversed depth.
pub fn light_views(sun: Vec3, at: Vec3) -> [(&'static str, Mat4, bool); 4] {
    let view = Mat4::look_at_rh(at + 6.0 * sun, at, Vec3::Y);
    let fov = 0.25_f32;
    [
        ("parallel", Mat4::orthographic_rh(-0.9, 0.9, -0.7, 0.7, 1.0, 11.0) * view, false),
        ("parallel-reversed", Mat4::orthographic_rh(-0.9, 0.9, -0.7, 0.7, 11.0, 1.0) * view, true),
        ("spot", Mat4::perspective_rh(fov, 1.2, 1.0, 11.0) * view, false),
        ("spot-reversed", Mat4::perspective_infinite_reverse_rh(fov, 1.2, 1.0) * view, true),
    ]
}

#[test]
fn foam_is_in_the_shade_of_a_map() {
    let gpu = Gpu::shared();
    let config = casting(16).with(|it| {
        it.light_map_size = None;
        it.shadow = Some(Shadows::Map);
        it.thickness_level = 0;
    });
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut case = wall(Lens::Standard);
    let at = Vec3::from(scenes::world(&case.shot.camera, &[[0.1, 0.1, 2.0]])[0]);
    // The light comes from behind the eye and from its side.
    let from = Vec3::from(scenes::world(&case.shot.camera, &[[0.5, 0.7, 0.5]])[0]);
    let sun = (from - at).normalize();
    case.shot.settings.light.direction = sun.to_array();
    for (name, view_projection, reversed) in light_views(sun, at) {
        for bias in [0.0, 0.15_f32] {
            let depth = |along: f32| view_projection.project_point3(at + along * sun).z;
            let (before, behind) = (depth(0.6), depth(-0.6));
            let mut random = Random(4);
            let mut texels = Image::new(23, 17, 0.0_f32);
            // Blocks of shade and of sun, and random depths around the wall.
            for (i, texel) in texels.data.iter_mut().enumerate() {
                let (x, y) = (i % 23 / 6, i / 23 / 5);
                *texel = match (x + y) % 3 {
                    0 => before,
                    1 => behind,
                    _ => random.between(before.min(behind), before.max(behind)),
                };
            }
            let image = shadows(&rig, Shadows::Map, &texels);
            let mut host = image.host_image();
            host.rect.offset = vk::Offset2D { x: 1, y: 2 };
            host.rect.extent = extent(21, 14);
            case.shot.shadow = Some(
                Shadow::new(host, view_projection.to_cols_array_2d()).with(|it| it.bias = bias),
            );
            let part = Image::from_fn(21, 14, |x, y| texels.at(x + 1, y + 2));
            let map = ShadowMap {
                depth: &part,
                view_projection: view_projection.as_dmat4(),
                bias: f64::from(bias),
                sun: sun.as_dvec3(),
                reversed,
            };
            let drawn = case.draw(&mut rig);
            let name = format!("map-{name}-{bias}");
            check_foam(&name, &case, &drawn, Some(&|p, by| [map.past(p, by); 3]), |_| 1.0);
        }
    }
}

/// Foam in its own shadow and in that of water with either kind of medium, by the light maps, also
/// together with a mask.
#[test]
fn foam_is_in_its_own_shade() {
    let gpu = Gpu::shared();
    // The source's medium has no scattering, and its falloff of the background does not block
    // sunlight.
    let media = [
        Medium::Physical { absorption: [9.0, 1.0, 0.5], scattering: [0.5, 0.25, 0.0] },
        Medium::Source { base: [0.3, 0.9, 0.6], falloff: [7.0, 0.25, 2.0, 20.0] },
    ];
    let cases = [(None, media[0]), (Some(Shadows::Mask), media[0]), (None, media[1])];
    for (i, (shadow, medium)) in cases.into_iter().enumerate() {
        let config = casting(64).with(|it| {
            it.shadow = shadow;
            it.thickness_level = 0;
            it.sheets = 2;
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut case = wall(Lens::Standard);
        let texels = Image::from_vec(2, 1, vec![0.25, 1.0]).expect("two");
        let image = shadows(&rig, Shadows::Mask, &texels);
        let none = Shadow::new(image.host_image(), Mat4::ZERO.to_cols_array_2d());
        case.shot.shadow = shadow.map(|_| none);
        // A lump between the wall and the sun, which is to the left of the view.
        let (at, from) = ([0.2, 0.0, 2.0], [-1.8, 0.6, 1.2]);
        let [at, from] = [at, from].map(|p| Vec3::from(scenes::world(&case.shot.camera, &[p])[0]));
        case.shot.settings.light.direction = (from - at).normalize().to_array();
        let lump = scenes::block(6, 0.1, [5, 5, 5], [-2.0, 0.3, 1.1]);
        let n = lump.len();
        case.shot.positions.extend(scenes::world(&case.shot.camera, &lump));
        case.amounts.extend((0..n).map(|i| [(i % 2) as f32, 0.0]));
        case.velocities.resize(case.shot.positions.len(), [0.0; 3]);
        case.shot.settings.surface_foam.shadow = 2.0;
        // Some of the wall lies partly or entirely behind the front layer.
        case.shot.settings.surface_foam.front_depth = 0.15;
        case.shot.settings.water.medium = medium;
        let center = at.to_array();
        case.shot.light_volume = Some(LightVolume { center, radius: 2.0 });
        let drawn = case.draw(&mut rig);
        let (light, maps) = (twin(&case.shot, &config), maps(&drawn));
        let sun = |p: DVec3, by: f64| light.at(&maps, p, by).0;
        check_foam(&format!("own-{i}"), &case, &drawn, Some(&sun), |(x, _)| {
            if shadow.is_some() && 2 * x + 1 < 97 { 0.25 } else { 1.0 }
        });
    }
}
