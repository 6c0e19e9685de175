//! The environment that water reflects, as a cube map with mips.
//! [`record_environment`](crate::Renderer::record_environment) fills the cube from an equirectangular image of the
//! host or from the built-in sky, once for each environment.

use ash::vk;
use bytemuck::NoUninit;
use glam::Vec3;

use crate::check;
use crate::contract::{Config, HostImage};
use crate::error::Error;
use crate::frame::{check_up, level_axes};
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ, COPY_WRITE, FRAGMENT_SAMPLED,
};
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::graveyard::{Grave, Owned};
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::settings::{GREATEST, range};
use crate::whitewater::Irradiance;

crate::contract::with!(Sky, Equirectangular);

/// Source of the environment.
#[derive(Clone, Copy, Debug)]
pub enum EnvironmentSource {
    /// No environment: water reflects black.
    Black,
    /// The built-in clear sky.
    Sky(Sky),
    /// An image of the host, only sampled.
    Equirectangular(Equirectangular),
}

/// A clear sky: single scattering in air and thin haze (Nishita et al. 1993; optical depth of the haze 0.1), plus a
/// fitted term for multiple scattering. The single scattering is an integral, computed to an accuracy of 4 %. With
/// the sun 35° above the horizon the sky gives 23 % of the light (luminance) on level ground, the sun the rest. Below
/// the horizon grey ground fades in; in directions whose component along up is −0.12 or less only ground is seen. The
/// sun's disc is not included.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sky {
    /// World direction to the sun, any length except 0, default (1, 2, 1) normalised.
    pub sun: [f32; 3],
    /// World up direction, any length except 0, default +y, as [`Settings::up`](crate::Settings::up).
    pub up: [f32; 3],
    /// Irradiance of the sun outside the atmosphere in the unit of the output, [0, ∞), default 20.
    pub intensity: f32,
}

impl Default for Sky {
    fn default() -> Self {
        let (sun, up) = ([0.408_248_3, 0.816_496_6, 0.408_248_3], [0.0, 1.0, 0.0]);
        Self { sun, up, intensity: 20.0 }
    }
}

/// An equirectangular image. Row 0 is up. For +y up its middle column looks along world −z and the column at three
/// quarters of the width along +x; left and right edge meet along +z. For another up direction the image rotates with
/// it: for z up the middle column looks along +y and the one at three quarters still along +x; for x up the middle
/// column looks along +z and the one at three quarters along +y.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Equirectangular {
    /// Linear radiance; NaN and negative numbers count as 0, infinite ones as 65 000. The format has to support linear
    /// filtering. `rect` has to be the whole image.
    pub image: HostImage,
    /// The same picture without the sun. It is needed if `image` contains the sun that [`Light`](crate::Light)
    /// describes; `None`, the default, means that `image` does not. Diffuse light is gathered from the picture
    /// without the sun, because the light of the sun is added separately, with its shadows, and would otherwise count
    /// twice. Reflections show `image`.
    pub without_sun: Option<HostImage>,
    /// Factor on the image's radiance, [0, ∞), default 1. The scaled radiance is clamped to 65 000.
    pub scale: f32,
    /// Right-handed rotation of the image around up, radians, finite, default 0. For +y up, content along −z moves
    /// towards −x.
    pub turn: f32,
    /// World up direction, any length except 0, with the meaning of [`Settings::up`](crate::Settings::up).
    pub up: [f32; 3],
}

impl Equirectangular {
    /// An image without rotation, +y up.
    pub fn new(image: HostImage) -> Self {
        Self { image, without_sun: None, scale: 1.0, turn: 0.0, up: [0.0, 1.0, 0.0] }
    }
}

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct SkyPush {
    sun: [f32; 4],
    east: [f32; 4],
    up: [f32; 4],
    size: u32,
}
shader::assert_layout!(shader::ENVIRONMENT_SKY_COMP, "Push", SkyPush { sun, east, up, size });

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct EquirectPush {
    east: [f32; 4],
    up: [f32; 4],
    size: u32,
    scale: f32,
    turn: f32,
}
shader::assert_layout!(
    shader::ENVIRONMENT_EQUIRECT_COMP,
    "Push",
    EquirectPush { east, up, size, scale, turn }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct IrradiancePush {
    size: u32,
    coarse: u32,
    mip: f32,
}
shader::assert_layout!(
    shader::ENVIRONMENT_IRRADIANCE_COMP,
    "Push",
    IrradiancePush { size, coarse, mip }
);

/// East, up and north.
pub(crate) fn axes(up: [f32; 3]) -> [Vec3; 3] {
    let up = Vec3::from(up).normalize_or(Vec3::Y);
    let [east, north] = level_axes(up);
    [east, up, north]
}

/// Validates an image that is used as a whole.
fn whole(fields: [&'static str; 3], image: &HostImage) -> Result<(), Error> {
    check::image(fields, image)?;
    if image.rect == image.extent.into() {
        return Ok(());
    }
    Err(Error::bad(fields[2], format!("expected the whole image, found {:?}", image.rect)))
}

impl EnvironmentSource {
    /// Validates the source.
    pub(crate) fn check(&self) -> Result<(), Error> {
        match self {
            Self::Black => Ok(()),
            Self::Sky(sky) => {
                check_up("Sky.sun", sky.sun)?;
                range("Sky.intensity", sky.intensity, 0.0, f32::MAX)?;
                check_up("Sky.up", sky.up)
            }
            Self::Equirectangular(own) => {
                whole(check::fields!("Equirectangular.image"), &own.image)?;
                if let Some(image) = &own.without_sun {
                    whole(check::fields!("Equirectangular.without_sun"), image)?;
                }
                range("Equirectangular.scale", own.scale, 0.0, f32::MAX)?;
                range("Equirectangular.turn", own.turn, -GREATEST, GREATEST)?;
                check_up("Equirectangular.up", own.up)
            }
        }
    }
}

/// Side length of the irradiance map without its border.
const IRRADIANCE: u32 = 32;
/// Maximum side length of the faces that irradiance is gathered from.
const COARSE: u32 = 16;

/// State of the cube between its passes: any shader may read it.
const SAMPLED: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);

/// The cube map and its passes.
pub struct Environment {
    sky: Pipeline,
    equirect: Pipeline,
    /// RGBA16F, six faces, all mips.
    pub cube: Image,
    faces: Owned<vk::ImageView>,
    /// The cube without the sun, and a view of its faces, for [`Irradiance::Sampled`]. Only its first mip is sampled.
    /// The cube has further mips only for SwiftShader: it fills the seams of a cube map (the texels around each face,
    /// which filters read at its edges) when mips are blitted, but not when a compute shader writes the cube.
    sunless: Option<(Image, Owned<vk::ImageView>)>,
    /// Whether the host gave a separate picture without the sun for the environment that was recorded last.
    apart: bool,
    /// View of the cube for look-ups at explicit mip levels. It has all mips but the last: SwiftShader never fills the
    /// seams of that mip (the texels around each face), but reads them when it filters at a face's edges.
    pub levels: Owned<vk::ImageView>,
    mips: u32,
    gather: Pipeline,
    /// Irradiance divided by 2π: RGBA16F, octahedral with a border of one texel.
    pub irradiance: Image,
}

impl Environment {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let size = config.environment_size;
        let mips = size.ilog2() + 1;
        let written = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let of_size = |name, mips, usage| {
            let extent = vk::Extent2D { width: size, height: size };
            let format = vk::Format::R16G16B16A16_SFLOAT;
            let desc = ImageDesc::new(name, extent, format, written | usage);
            Image::new(gpu, &ImageDesc { mips, layers: 6, ..desc })
        };
        let made = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_SRC;
        let cube = of_size("environment", mips, made)?;
        let array = vk::ImageViewType::TYPE_2D_ARRAY;
        let faces = gpu.view(cube.handle, cube.format, array, 6, 1, "environment/faces")?;
        let faces = gpu.own(faces, Grave::View);
        let sunless = Self::is_sampled(config).then(|| {
            let own = of_size("environment/sunless", mips, made)?;
            let faces =
                gpu.view(own.handle, own.format, array, 6, 1, "environment/sunless-faces")?;
            Ok((own, gpu.own(faces, Grave::View)))
        });
        let sunless = sunless.transpose()?;
        let of_cube = vk::ImageViewType::CUBE;
        let levels =
            gpu.view(cube.handle, cube.format, of_cube, 6, mips - 1, "environment/levels")?;
        let levels = gpu.own(levels, Grave::View);
        let irradiance = Image::new(
            gpu,
            &ImageDesc::new(
                "environment/irradiance",
                vk::Extent2D { width: IRRADIANCE + 2, height: IRRADIANCE + 2 },
                cube.format,
                written | vk::ImageUsageFlags::STORAGE,
            ),
        )?;
        Ok(Self {
            sky: Pipeline::compute(gpu, shader::ENVIRONMENT_SKY_COMP, &[])?,
            equirect: Pipeline::compute(gpu, shader::ENVIRONMENT_EQUIRECT_COMP, &[])?,
            cube,
            sunless,
            apart: false,
            faces,
            levels,
            mips,
            gather: Pipeline::compute(gpu, shader::ENVIRONMENT_IRRADIANCE_COMP, &[])?,
            irradiance,
        })
    }

    /// Whether foam samples the environment in the directions of its occlusion samples.
    pub fn is_sampled(config: &Config) -> bool {
        config.whitewater.is_some_and(|foam| foam.irradiance == Irradiance::Sampled)
    }

    /// Records a black environment, so that frames can sample it. Frames in flight may still sample the one before.
    pub fn record_setup(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        self.record_black(gpu, cmd);
    }

    fn record_black(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        let change = |from, to| {
            let barriers: Vec<_> =
                self.images().map(|image| access::image(image, from, to)).collect();
            gpu.barriers(cmd, &barriers, &[]);
        };
        change(SAMPLED.discarded(), access::CLEAR);
        for image in self.images() {
            gpu.clear_color(cmd, image, [0.0, 0.0, 0.0, 1.0]);
        }
        change(access::CLEAR, SAMPLED);
    }

    fn images(&self) -> impl Iterator<Item = &Image> {
        let sunless = self.sunless.iter().map(|(image, _)| image);
        [&self.cube, &self.irradiance].into_iter().chain(sunless)
    }

    /// Bytes of its images.
    pub fn memory(&self) -> u64 {
        self.images().map(|image| image.size).sum()
    }

    /// The cube that foam samples.
    pub fn gathered(&self) -> &Image {
        match &self.sunless {
            Some((image, _)) if self.apart => image,
            _ => &self.cube,
        }
    }

    pub fn record(
        &mut self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        source: &EnvironmentSource,
    ) -> Result<(), Error> {
        gpu.begin_label(cmd, c"environment");
        self.apart =
            matches!(source, EnvironmentSource::Equirectangular(map) if map.without_sun.is_some());
        let recorded = match source {
            EnvironmentSource::Black => {
                self.record_black(gpu, cmd);
                Ok(())
            }
            EnvironmentSource::Sky(sky) => self
                .record_sky(gpu, cmd, descriptors, sky)
                .and_then(|()| self.record_irradiance(gpu, cmd, descriptors)),
            EnvironmentSource::Equirectangular(map) => {
                let gathered = map.without_sun.as_ref().unwrap_or(&map.image);
                let other = map.without_sun.as_ref();
                let other = other.filter(|other| other.image != map.image.image);
                let images = || [Some(&map.image), other].into_iter().flatten();
                let change = |from: fn(&HostImage) -> Access, to: fn(&HostImage) -> Access| {
                    let barrier = |image: &HostImage| {
                        access::raw_image(image.image, image.aspect, from(image), to(image))
                    };
                    gpu.barriers(cmd, &images().map(barrier).collect::<Vec<_>>(), &[]);
                };
                change(|image| image.before, |_| COMPUTE_SAMPLED);
                let recorded = self
                    .record_map(gpu, cmd, descriptors, (gathered, map))
                    .and_then(|()| self.record_irradiance(gpu, cmd, descriptors))
                    .and_then(|()| match map.without_sun {
                        Some(_) => {
                            self.record_sunless(gpu, cmd, descriptors, (gathered, map)).and_then(
                                |()| self.record_map(gpu, cmd, descriptors, (&map.image, map)),
                            )
                        }
                        None => Ok(()),
                    });
                change(|_| COMPUTE_SAMPLED, |image| image.after);
                recorded
            }
        };
        gpu.end_label(cmd);
        recorded
    }

    /// Cube and mips of the built-in sky.
    fn record_sky(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        sky: &Sky,
    ) -> Result<(), Error> {
        let size = self.cube.extent.width;
        let target = self.begin_cube(gpu, cmd);
        descriptors.bind(gpu, cmd, &self.sky, &[target])?;
        let [east, up, north] = axes(sky.up);
        let sun = Vec3::from(sky.sun).normalize_or_zero();
        let sun = Vec3::new(sun.dot(east), sun.dot(up), sun.dot(north));
        let [east, up] = [east, up].map(|axis| axis.extend(0.0).to_array());
        let sun = sun.extend(sky.intensity).to_array();
        self.sky.push(gpu, cmd, &SkyPush { sun, east, up, size });
        self.fill_cube(gpu, cmd);
        self.record_mips(gpu, cmd, &self.cube);
        Ok(())
    }

    /// Cube and mips of an image, scaled and rotated.
    fn record_map(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        (image, map): (&HostImage, &Equirectangular),
    ) -> Result<(), Error> {
        let target = self.begin_cube(gpu, cmd);
        self.fill_with(gpu, cmd, descriptors, target, (image, map))?;
        self.record_mips(gpu, cmd, &self.cube);
        Ok(())
    }

    /// Cube of an image without the sun, if foam samples it.
    fn record_sunless(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        (image, map): (&HostImage, &Equirectangular),
    ) -> Result<(), Error> {
        let Some((own, faces)) = &self.sunless else { return Ok(()) };
        gpu.barriers(cmd, &[access::image(own, SAMPLED.discarded(), COMPUTE_WRITE)], &[]);
        let target = (0, Resource::Storage(faces.handle));
        self.fill_with(gpu, cmd, descriptors, target, (image, map))?;
        self.record_mips(gpu, cmd, own);
        Ok(())
    }

    /// Fills the faces from an image of the host, which compute shaders may sample.
    fn fill_with(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        target: (u32, Resource),
        (image, map): (&HostImage, &Equirectangular),
    ) -> Result<(), Error> {
        let size = self.cube.extent.width;
        let source = (1, Resource::Sampled(image.view, gpu.samplers.around));
        descriptors.bind(gpu, cmd, &self.equirect, &[target, source])?;
        let [east, up, _] = axes(map.up).map(|axis| axis.extend(0.0).to_array());
        let Equirectangular { scale, turn, .. } = *map;
        self.equirect.push(gpu, cmd, &EquirectPush { east, up, size, scale, turn });
        self.fill_cube(gpu, cmd);
        Ok(())
    }

    /// Discards the cube's contents; its faces are written next.
    fn begin_cube(&self, gpu: &Gpu, cmd: vk::CommandBuffer) -> (u32, Resource) {
        gpu.barriers(cmd, &[access::image(&self.cube, SAMPLED.discarded(), COMPUTE_WRITE)], &[]);
        (0, Resource::Storage(self.faces.handle))
    }

    fn fill_cube(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        let groups = self.cube.extent.width.div_ceil(8);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, groups, groups, 6) };
    }

    fn record_irradiance(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
    ) -> Result<(), Error> {
        let image = &self.irradiance;
        gpu.barriers(cmd, &[access::image(image, SAMPLED.discarded(), COMPUTE_WRITE)], &[]);
        let resources = [
            (0, Resource::storage(image)),
            (1, Resource::Sampled(self.cube.view, gpu.samplers.linear)),
        ];
        descriptors.bind(gpu, cmd, &self.gather, &resources)?;
        let size = self.cube.extent.width;
        let coarse = size.min(COARSE);
        let mip = (size / coarse).ilog2() as f32;
        self.gather.push(gpu, cmd, &IrradiancePush { size: IRRADIANCE, coarse, mip });
        let groups = (IRRADIANCE + 2).div_ceil(self.gather.local_size[0]);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, groups, groups, 1) };
        gpu.barriers(cmd, &[access::image(image, COMPUTE_WRITE, SAMPLED)], &[]);
        Ok(())
    }

    /// Blits each mip from the previous one.
    fn record_mips(&self, gpu: &Gpu, cmd: vk::CommandBuffer, cube: &Image) {
        let mip_barrier = |mip: u32, count: u32, before, after| {
            let mut barrier = access::image(cube, before, after);
            barrier.subresource_range.base_mip_level = mip;
            barrier.subresource_range.level_count = count;
            barrier
        };
        let mut size = cube.extent.width as i32;
        gpu.barriers(
            cmd,
            &[
                mip_barrier(0, 1, COMPUTE_WRITE, COPY_READ),
                mip_barrier(1, self.mips - 1, COMPUTE_WRITE, COPY_WRITE),
            ],
            &[],
        );
        for mip in 1..self.mips {
            let layers = |mip_level| vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                mip_level,
                base_array_layer: 0,
                layer_count: 6,
            };
            let corner = |size| vk::Offset3D { x: size, y: size, z: 1 };
            let blit = vk::ImageBlit::default()
                .src_subresource(layers(mip - 1))
                .src_offsets([vk::Offset3D::default(), corner(size)])
                .dst_subresource(layers(mip))
                .dst_offsets([vk::Offset3D::default(), corner(size / 2)]);
            // SAFETY: both mips are in their transfer layouts.
            unsafe {
                gpu.device.cmd_blit_image(
                    cmd,
                    cube.handle,
                    vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                    cube.handle,
                    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                    &[blit],
                    vk::Filter::LINEAR,
                );
            }
            gpu.barriers(cmd, &[mip_barrier(mip, 1, COPY_WRITE, COPY_READ)], &[]);
            size /= 2;
        }
        gpu.barriers(cmd, &[access::image(cube, COPY_READ, SAMPLED)], &[]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(source: EnvironmentSource) -> Option<&'static str> {
        match source.check() {
            Err(Error::BadInput { field, .. }) => Some(field),
            _ => None,
        }
    }

    #[test]
    fn bad_sources_name_their_field() {
        let sky = Sky::default();
        let state = COMPUTE_SAMPLED;
        let (image, view) = (vk::Image::null(), vk::ImageView::null());
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let extent = vk::Extent2D { width: 2, height: 1 };
        let map = Equirectangular::new(HostImage::new(image, view, format, extent, state));
        assert_eq!(field(EnvironmentSource::Sky(sky)), None);
        assert_eq!(field(EnvironmentSource::Equirectangular(map)), None);
        for (bad, name) in [
            (sky.with(|it| it.sun = [0.0; 3]), "Sky.sun"),
            (sky.with(|it| it.intensity = -1.0), "Sky.intensity"),
            (sky.with(|it| it.intensity = f32::NAN), "Sky.intensity"),
            (sky.with(|it| it.up = [f32::NAN; 3]), "Sky.up"),
        ] {
            assert_eq!(field(EnvironmentSource::Sky(bad)), Some(name));
        }
        for (bad, name) in [
            (map.with(|it| it.scale = f32::INFINITY), "Equirectangular.scale"),
            (map.with(|it| it.turn = f32::NAN), "Equirectangular.turn"),
            (map.with(|it| it.up = [0.0; 3]), "Equirectangular.up"),
        ] {
            assert_eq!(field(EnvironmentSource::Equirectangular(bad)), Some(name));
        }
    }
}
