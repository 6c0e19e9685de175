//! Foam that lies on water as an overlay: along shores (*Semi-procedural foam shader*, an indie developer's
//! blog) and around objects (D. Lettier, *3D Game Shaders For Beginners*, Foam). One pass per file.

mod contact;
mod distance;
pub(crate) mod settings;
mod shoreline;
pub mod texture;
mod textures;
mod tiles;

use std::sync::Arc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, Mat3, Vec3, Vec4};

use crate::contract::{
    Config, Frame, HostImage, Layer, Settings, ShoreDistances, Shoreline, Strip, Surface,
};
use crate::error::Error;
use crate::frame::{Lens, level_axes};
use crate::gpu::Gpu;
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::image::Image;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::host_images::depth_layout;
use crate::water::{Recording, WaterLayers};
pub use distance::{Area, Heights, MapMesh, ShoreMap, ShoreMapConfig, ShoreMapStep};
#[cfg(feature = "diagnostics")]
pub use settings::Edge;
pub use settings::{
    ContactSettings, Measure, Noise, ShoreConfig, ShoreSettings, ShorelineSettings, TextureLayer,
};
use textures::Textures;
pub(crate) use tiles::COAT_DISPATCH;
pub(crate) use tiles::list_bytes as bytes_bound;

/// The block `ShoreFrame` of `glsl/include/shore.glsl`, whose comments describe each member.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct ShoreUniforms {
    east: [f32; 4],
    north: [f32; 4],
    height: [f32; 4],
    surface: [f32; 4],
    surface_part: [f32; 4],
    map: [f32; 4],
    reach: [f32; 4],
    waves: [f32; 4],
    mixed: [f32; 4],
    web: [f32; 4],
    counts: [f32; 4],
    look: [[f32; 4]; 6],
    look_moved: [[f32; 4]; 6],
    noise: [[f32; 4]; 6],
    layer: [[f32; 4]; 4],
    layer_weight: [f32; 4],
    contact: [f32; 4],
    contact_mask: [f32; 4],
    mask: [f32; 4],
    mask_part: [f32; 4],
}
shader::assert_layout!(
    shader::SHORE_CONTACT_COMP,
    "ShoreFrame",
    ShoreUniforms {
        east,
        north,
        height,
        surface,
        surface_part,
        map,
        reach,
        waves,
        mixed,
        web,
        counts,
        look,
        look_moved,
        noise,
        layer,
        layer_weight,
        contact,
        contact_mask,
        mask,
        mask_part
    }
);

/// Mapping from a pixel to the texel of a host image: texels per pixel and size in texels, then the first texel.
fn texels(image: &HostImage, frame: vk::Extent2D) -> ([f32; 4], [f32; 2]) {
    let vk::Rect2D { offset, extent } = image.rect;
    let [w, h] = [extent.width as f32, extent.height as f32];
    let scale = [w / frame.width as f32, h / frame.height as f32, w, h];
    (scale, [offset.x as f32, offset.y as f32])
}

/// Displacement of a pattern, in its repetitions.
fn moved(look: &ShoreSettings, scale: f32, speed: [f32; 2]) -> [f32; 2] {
    speed.map(|speed| look.turned(f64::from(scale) * f64::from(speed)) as f32)
}

/// Noise look-ups, in order.
#[derive(Default)]
struct Looks {
    count: usize,
    own: [[f32; 4]; 6],
    moved: [[f32; 4]; 6],
    noise: [[f32; 4]; 6],
}

impl Looks {
    /// Adds a look-up with a number of repetitions per scene unit.
    fn add(&mut self, scale: f32) -> &mut [f32; 4] {
        let own = &mut self.own[self.count];
        self.count += 1;
        own[0] = scale;
        own
    }

    /// Adds a noise for each of the four channels, weighted by amplitude and a factor. Noises of equal scale share a
    /// look-up.
    fn add_noises(&mut self, noises: [(Noise, f32); 4]) {
        let first = self.count;
        for (channel, (noise, factor)) in noises.iter().enumerate() {
            if noise.amplitude == 0.0 {
                continue;
            }
            let known = self.own[first..self.count].iter().position(|own| own[0] == noise.scale);
            let at = known.map_or(self.count, |known| first + known);
            if at == self.count {
                self.add(noise.scale);
            }
            self.noise[at][channel] = noise.amplitude * factor;
        }
    }
}

impl ShoreUniforms {
    /// Whether a frame needs the general pipeline (glsl/include/shore.glsl).
    pub fn is_general(&self, scene_depth: vk::Extent2D, frame: vk::Extent2D) -> bool {
        let [looks, layers, ..] = self.counts;
        let [_, _, kind, _] = self.surface_part;
        let [.., mask] = self.contact_mask;
        let [_, _, _, way] = self.reach;
        looks > 2.0 || layers > 2.0 || kind > 1.5 || mask > 0.5 || way > 2.5 || scene_depth != frame
    }

    /// The uniform block of a frame. `edges` are the side lengths of foam texture and noise in texels. Without
    /// [`Frame::shore`] the values have no effect, because nothing that reads them is recorded.
    pub fn new(frame: &Frame<'_>, lens: &Lens, edges: [f32; 2]) -> Self {
        let Settings { shore: look, water, .. } = frame.settings;
        let own = frame.shore.unwrap_or(crate::contract::Shore::new(0.0));
        let extent = frame.output.rect.extent;
        let (s, c) = (&look.shoreline, &look.contact);

        // Rows of the eye-space matrix for rows of the world-space one.
        let world = lens.view.inverse();
        let turn = Mat3::from_mat4(world);
        let eye = world.transform_point3(Vec3::ZERO);
        let row = |axis: Vec3, less: f32| {
            (turn.transpose() * axis).extend(axis.dot(eye) - less).to_array()
        };
        let up = frame.settings.upward();
        let [east, north] = level_axes(up);
        let (kind, level, depth) = match &own.surface {
            Some(Surface::Level(level)) => (1.0, *level, None),
            Some(Surface::Depth(image)) => (2.0, 0.0, Some(image)),
            None => (0.0, 0.0, None),
        };
        let (surface, [x, y]) = depth.map_or_else(Default::default, |image| texels(image, extent));
        let (way, map) = match &own.shoreline {
            None => (0.0, [0.0; 4]),
            Some(Shoreline::Strip(_)) => (1.0, [0.0; 4]),
            Some(Shoreline::Map(ShoreDistances { corner, edge, size, .. })) => {
                (2.0, [corner[0], corner[1], *size as f32 / edge, *size as f32])
            }
            Some(Shoreline::Screen) => (3.0, [0.0; 4]),
        };

        let [phase, local] = look.phases();
        let (mut looks, texture_warp) = (Looks::default(), s.texture_warp);
        if s.warp.amplitude != 0.0 {
            looks.add(s.warp.scale)[1] = s.warp.amplitude;
        }
        looks.add_noises([
            (s.frequency_noise, 1.0),
            (s.speed_noise, local),
            (s.rise_noise, 1.0),
            (s.threshold_noise, 1.0),
        ]);
        if texture_warp.amplitude != 0.0 {
            looks.add(texture_warp.scale)[2] = texture_warp.amplitude;
            // The displacement, in scene units instead of repetitions.
            let [u, v] = moved(look, texture_warp.scale, s.texture_warp_velocity);
            let metres = 1.0 / texture_warp.scale.max(1.0e-9);
            looks.moved[looks.count - 1] = [u * metres, v * metres, 0.0, 0.0];
        }
        let (mut layer, mut weight, mut layers) = ([[0.0; 4]; 4], [0.0; 4], 0);
        for own in s.layers.iter().filter(|own| own.weight > 0.0) {
            let turn = DVec2::from_angle(f64::from(own.angle).to_radians());
            let [x, y] = (turn * f64::from(own.scale)).as_vec2().to_array();
            // Rotated with the layer.
            let speed = turn.as_vec2().rotate(own.speed.into());
            let [u, v] = moved(look, own.scale, speed.to_array());
            layer[layers] = [x, y, u, v];
            weight[layers] = own.weight;
            layers += 1;
        }
        let [mask_u, mask_v] = moved(look, c.mask_scale, c.mask_speed);
        let (mask, [mask_x, mask_y]) =
            own.mask.as_ref().map_or_else(Default::default, |image| texels(image, extent));
        let spacing = water.spacing;
        Self {
            east: row(east, 0.0),
            north: row(north, 0.0),
            height: row(up, level),
            surface,
            surface_part: [x, y, kind, own.bias],
            map,
            reach: [1.0 / s.sea_reach, 1.0 / s.land_reach, s.fade, way],
            waves: [s.frequency, phase, s.wave_slope, s.wave_offset],
            mixed: [s.floor.unwrap_or(-1.0e9), s.wave_weight, s.texture_weight, s.threshold],
            web: [s.texture_slope, s.texture_offset, edges[0], edges[1]],
            counts: [looks.count as f32, layers as f32, 0.0, 0.0],
            look: looks.own,
            look_moved: looks.moved,
            noise: looks.noise,
            layer,
            layer_weight: weight,
            contact: [
                1.0 / c.depth,
                1.0 / c.particle_depth.unwrap_or(4.0 * spacing),
                c.mask,
                match c.measure {
                    Measure::Distance => 0.0,
                    Measure::View => 1.0,
                    Measure::Vertical => 2.0,
                },
            ],
            contact_mask: [c.mask_scale, mask_u, mask_v, f32::from(u8::from(own.mask.is_some()))],
            mask,
            mask_part: [mask_x, mask_y, c.opacity, c.particle_opacity],
        }
    }
}

/// Radiance of shoreline foam and of contact foam in full light, for `composite`: RGB, and as fourth component the
/// opacity of shoreline foam, or the lit share of contact foam.
pub(crate) fn colors(settings: &Settings) -> [Vec4; 2] {
    let (s, c) = (&settings.shore.shoreline, &settings.shore.contact);
    let light = Vec3::from(settings.light.irradiance) / std::f32::consts::PI;
    let shoreline = Vec3::from(s.color) * light;
    let contact = Vec3::from(c.color) * Vec3::ONE.lerp(light, c.lit);
    [shoreline.extend(s.opacity), contact.extend(c.lit)]
}

/// Inputs of a frame.
pub(crate) struct Given<'a> {
    pub shore: Option<&'a crate::contract::Shore>,
    /// The host's images, as sampled resources.
    pub surface: Option<Resource>,
    pub mask: Option<Resource>,
}

impl<'a> Given<'a> {
    pub fn new(shore: Option<&'a crate::contract::Shore>, gpu: &Gpu) -> Self {
        let sampled = |image: &HostImage| {
            Resource::SampledIn(image.view, gpu.samplers.nearest, depth_layout(image))
        };
        Self {
            shore,
            surface: shore.and_then(surface_of).map(sampled),
            mask: shore.and_then(|shore| shore.mask.as_ref()).map(sampled),
        }
    }

    /// The host's strip.
    pub fn strip(&self) -> Option<&'a Strip> {
        match &self.shore?.shoreline {
            Some(Shoreline::Strip(strip)) => Some(strip),
            _ => None,
        }
    }

    /// The map of distances.
    pub fn map(&self, gpu: &Gpu) -> Option<Resource> {
        match &self.shore?.shoreline {
            Some(Shoreline::Map(map)) => Some(Resource::Sampled(map.view, gpu.samplers.nearest)),
            _ => None,
        }
    }
}

/// The host's buffers, each once.
fn buffers_of(strip: &Strip) -> impl Iterator<Item = vk::Buffer> + use<> {
    let indices = strip.triangles.indices.map(|(stream, _)| stream.buffer);
    let own = [strip.triangles.positions.buffer, strip.coordinates.buffer];
    let mut all: Vec<_> = own.into_iter().chain(indices).collect();
    all.sort_by_key(|handle| vk::Handle::as_raw(*handle));
    all.dedup();
    all.into_iter()
}

/// The depth of the host's surface, if it has one.
pub(crate) fn surface_of(shore: &crate::contract::Shore) -> Option<&HostImage> {
    match &shore.surface {
        Some(Surface::Depth(image)) => Some(image),
        _ => None,
    }
}

/// The technique: its passes in the order of the frame.
pub(crate) struct Shore {
    /// Foam texture and noise. After a `reconfigure` those of the previous renderer are kept, if they fit the new
    /// configuration.
    textures: Arc<Textures>,
    tiles: tiles::Tiles,
    shoreline: shoreline::Shore,
    contact: contact::Contact,
}

impl Shore {
    /// `before` is the previous state.
    pub fn new(
        gpu: &Gpu,
        config: &Config,
        shore: &ShoreConfig,
        before: Option<&Self>,
    ) -> Result<Self, Error> {
        let kept = before.map(|before| &before.textures).filter(|kept| kept.fits(shore));
        Ok(Self {
            textures: match kept {
                Some(kept) => kept.clone(),
                None => Arc::new(Textures::new(gpu, shore)?),
            },
            tiles: tiles::Tiles::new(gpu, config)?,
            shoreline: shoreline::Shore::new(gpu, config, shore)?,
            contact: contact::Contact::new(gpu, shore)?,
        })
    }

    /// Recreates the size-dependent state.
    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.tiles.resize(gpu, config, retired)?;
        self.shoreline.resize(gpu, config, retired)
    }

    /// Whether the precomputed data is that of `other`.
    pub fn is_set_up_as(&self, other: Option<&Self>) -> bool {
        other.is_some_and(|other| Arc::ptr_eq(&self.textures, &other.textures))
    }

    pub fn record_setup(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        self.textures.record_setup(gpu, cmd);
    }

    pub fn record_foam_texture(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        image: &HostImage,
    ) -> Result<(), Error> {
        self.textures.record_foam_texture(gpu, cmd, descriptors, image)
    }

    /// Side lengths of foam texture and noise, in texels.
    pub fn edges(&self) -> [f32; 2] {
        self.textures.edges()
    }

    /// Passes `shore-tiles` and `shoreline`. `general` selects the pipelines without the limits of the usual case
    /// (glsl/include/shore.glsl).
    pub fn record_shoreline(
        &self,
        r: &mut Recording<'_>,
        given: &Given<'_>,
        general: bool,
    ) -> Result<(), Error> {
        let scope = r.begin(c"shore-tiles");
        self.tiles.record(r, (given, general))?;
        r.end(scope);
        let scope = r.begin(c"shoreline");
        self.shoreline.record(r, (given, general), &self.tiles, &self.textures)?;
        r.end(scope);
        Ok(())
    }

    /// Pass `contact`. `general` selects the general pipeline.
    pub fn record_contact(
        &self,
        r: &mut Recording<'_>,
        (given, general): (&Given<'_>, bool),
        water: &WaterLayers<'_>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"contact");
        let (into, what) = ((&self.shoreline, &self.tiles), (given, general));
        self.contact.record(r, into, what, &self.textures, water)?;
        r.end(scope);
        Ok(())
    }

    /// The foam image, with four channels: shoreline foam, contact foam on the host's surface, the fraction of
    /// sunlight that is missing there, contact foam on the particles' water.
    pub fn image(&self) -> &Image {
        self.shoreline.image()
    }

    /// For `composite`, which draws the tiles with foam on the host's surface as runs (neighbouring tiles of a row):
    /// the buffer of tile lists, the buffer with the arguments of that draw, and two numbers: tiles per row of the
    /// frame, and the index in the first buffer at which the runs begin.
    pub fn tiles(&self, extent: vk::Extent2D) -> (&Buffer, &Buffer, [u32; 2]) {
        let [list, arguments, _] = self.tiles.buffers();
        let [across, most] = self.tiles.places(extent);
        (list, arguments, [across, 3 * most])
    }

    /// The layer of a frame of this size, for the host.
    pub fn kept(&self, extent: vk::Extent2D) -> Layer {
        let image = self.image();
        Layer {
            name: "shore",
            image: image.handle,
            view: image.view,
            format: image.format,
            extent,
            access: shoreline::AFTER,
        }
    }

    /// Bytes of images and of buffers.
    pub fn memory(&self) -> (u64, u64) {
        let (images, buffers) = self.textures.memory();
        (images + self.shoreline.memory(), buffers + self.tiles.memory())
    }
}
