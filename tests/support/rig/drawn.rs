//! Results of a frame: the picture and every kept layer, read back.

use ash::vk;
use whitewater::{HostImage, Layer, Recorded, SmoothingLevel, SmoothingLevels};

use super::{Rig, Shot, Soaped};
use crate::reference::{Image, surface_foam};
use crate::support::host;

/// Results of a frame.
#[derive(Clone)]
pub struct Drawn {
    pub output: Image<[f32; 4]>,
    /// The output image, including its margin around the view.
    pub whole: Image<[f32; 4]>,
    pub depth: Image<f32>,
    /// Surface at the configured level.
    pub surface: Image<f32>,
    pub plan: Image<u32>,
    /// Surfaces and plans of the front sheet's coarser levels, in order.
    pub coarser: Vec<(Image<f32>, Image<u32>)>,
    pub levels: SmoothingLevels,
    /// Thickness of all water.
    pub thickness: Image<f32>,
    /// Set with two sheets.
    pub sheets: Option<Sheets>,
    /// Set with foam.
    pub foam: Option<Foaming>,
    /// Optical depth of spray; set with spray.
    pub spray: Option<Image<f32>>,
    /// Part of the optical depth of spray that the sun reaches; set with spray.
    pub lit_spray: Option<Image<f32>>,
    /// Set with motion vectors.
    pub motion: Option<Image<[f32; 2]>>,
    /// Height of the surface noise, if it is drawn.
    pub noise: Option<Image<f32>>,
    /// Map of the light: distance along the light to the nearest fluid, in scene units.
    pub light_front: Option<Image<f32>>,
    /// Map of the light: thickness of water and of foam in scene units, and each of them times its
    /// position along the light.
    pub light_thickness: Option<Image<[f32; 4]>>,
    /// Map of the light for whitewater particles: thickness, and mean and standard deviation of
    /// their position along the light in scene units.
    pub light_whitewater: Option<Image<[f32; 4]>>,
    /// Map of the light: irradiance relative to that without water.
    pub caustics: Option<Image<f32>>,
    /// Set with whitewater particles.
    pub whitewater: Option<DrawnWhitewater>,
    /// Set with bubble foam.
    pub soap: Option<Soaped>,
    /// Set with shoreline and contact foam: foam along shores, contact foam on the host's surface,
    /// lost fraction of sunlight, contact foam on particle water.
    pub shore: Option<Image<[u8; 4]>>,
    /// All pages of the host's shadow map as a Fourier basis.
    pub shadow_basis: Option<Image<[f32; 4]>>,
    /// Words of the buffer of particles and their ellipsoids.
    pub shapes: Option<Vec<u32>>,
    pub work: Work,
}

impl Drawn {
    /// Empty results, of a frame from which nothing was read.
    pub fn empty() -> Self {
        let empty = || Image::new(0, 0, 0.0);
        Self {
            output: Image::new(0, 0, [0.0; 4]),
            whole: Image::new(0, 0, [0.0; 4]),
            depth: empty(),
            surface: empty(),
            plan: Image::new(0, 0, 0),
            coarser: Vec::new(),
            levels: bytemuck::Zeroable::zeroed(),
            thickness: empty(),
            sheets: None,
            foam: None,
            spray: None,
            lit_spray: None,
            motion: None,
            noise: None,
            light_front: None,
            light_thickness: None,
            light_whitewater: None,
            caustics: None,
            whitewater: None,
            soap: None,
            shore: None,
            shadow_basis: None,
            shapes: None,
            work: Work::default(),
        }
    }
}

/// Amount of work in a frame.
#[derive(Clone, Debug, Default)]
pub struct Work {
    /// Number of particles on the screen, and of those that can be visible.
    pub visible: u32,
    pub front: u32,
    /// Number of particles dropped for their positions, and of those classified as spray.
    pub dropped: u32,
    pub set_aside: u32,
    /// Number of tiles with water, then of tiles in iteration 1, 2, …
    pub tiles: Vec<u32>,
}

/// Additional results of a frame with foam.
#[derive(Clone)]
pub struct Foaming {
    pub depth: Image<f32>,
    /// Thickness of all foam, and of the foam close behind the frontmost foam.
    pub thickness: Image<[f32; 2]>,
    /// Sunlit part of the foam close behind the frontmost foam.
    pub lit: Image<f32>,
    /// Thickness of all foam times its mean distance behind the frontmost.
    pub far: Image<f32>,
    /// Thickness of the water before the frontmost foam.
    pub before: Image<f32>,
    /// Level of the foam images: each is halved this many times.
    pub level: u32,
}

impl Foaming {
    /// Foam that each pixel shows: its depth, and both thicknesses.
    pub fn seen(&self, shot: &Shot) -> Image<(f64, [f64; 2])> {
        let (scene, layers) = (shot.scene_at(shot.size, 0), (&self.depth, &self.thickness));
        let spacing = f64::from(shot.settings.water.spacing);
        Image::from_fn(scene.width, scene.height, |x, y| {
            surface_foam::seen(layers, (x, y), self.level, scene.at(x, y), spacing)
        })
    }
}

/// Additional results of a frame with whitewater particles.
#[derive(Clone)]
pub struct DrawnWhitewater {
    /// Depth of the frontmost particle, intensity of all, depths of fluid and scene.
    pub occluders: Image<[f32; 4]>,
    /// Thickness before the fluid, thickness behind it, and the latter times its distance.
    pub thickness: Image<[f32; 4]>,
    /// World-space normal of the frontmost particle, and its search radius.
    pub normal: Image<[f32; 4]>,
    /// Gathered light, and shadow.
    pub light: Image<[f32; 4]>,
}

/// Additional results of a frame with two sheets.
#[derive(Clone)]
pub struct Sheets {
    /// Depth between the sheets, for each texel of the thickness.
    pub boundaries: Image<f32>,
    /// The same before those were removed where all water is of one sheet.
    pub found: Image<f32>,
    /// Thicknesses of the front sheet, of the back sheet and of the window between them.
    pub thickness: Image<[f32; 3]>,
    /// Surface and plan of the back sheet, at its first level and the coarser ones.
    pub surface: Image<f32>,
    pub plan: Image<u32>,
    pub coarser: Vec<(Image<f32>, Image<u32>)>,
}

impl Rig<'_> {
    /// Reads back the output and the kept layers.
    pub fn read(&self, output: &HostImage, recorded: &Recorded) -> Drawn {
        let bytes = self.stub.download(
            output.image,
            output.format,
            output.aspect,
            output.extent.into(),
            output.after,
        );
        let own = recorded.diagnostics();
        let levels = own.levels.unwrap_or_else(bytemuck::Zeroable::zeroed);
        let whole = picture(output.format, output.extent, &bytes);
        let empty = || Image::new(0, 0, 0.0);
        let rect = crop(&whole, output.rect);
        let mut drawn = Drawn { output: rect, whole, levels, ..Drawn::empty() };
        if let Some(counts) = &own.counts {
            let size = 256 * u64::from(counts.chunks);
            let back = self.stub.sized(size, vk::BufferUsageFlags::TRANSFER_DST);
            self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, counts.all, &back));
            for chunk in back.bytes().chunks_exact(256) {
                let words: Vec<u32> = words(chunk).collect();
                drawn.work.visible += words[0] + words[5];
                drawn.work.dropped += words[18];
                drawn.work.set_aside += words[19];
            }
            self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, counts.front, &back));
            for chunk in back.bytes().chunks_exact(256) {
                let words: Vec<u32> = words(chunk).collect();
                drawn.work.front += words[0] + words[5];
            }
        }
        // Ten words a particle.
        let count = 10 * self.config.max_particles;
        drawn.shapes = own.shapes.map(|buffer| self.words_of(buffer, count));
        if let Some(tiles) = own.tiles {
            let back = self.stub.sized(16 * 259, vk::BufferUsageFlags::TRANSFER_DST);
            self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, tiles, &back));
            let words: Vec<u32> = words(back.bytes()).collect();
            drawn.work.tiles = words.chunks_exact(4).skip(1).take(257).map(|w| w[3]).collect();
            drawn.work.tiles.insert(0, words[1]);
        }
        let of = |range: std::ops::Range<usize>| {
            range.map(|i| &levels.level[i]).filter(|level| level.rect[2] > 0)
        };
        let none = |_: &SmoothingLevel| (empty(), Image::new(0, 0, 0));
        drawn.coarser = of(1..4).map(none).collect();
        let mut sheets = own.sheets.map(|buffer| Sheets {
            boundaries: self.boundaries(buffer, output.rect.extent),
            found: Image::new(0, 0, 0.0),
            thickness: Image::new(0, 0, [0.0; 3]),
            surface: empty(),
            plan: Image::new(0, 0, 0),
            coarser: of(5..7).map(none).collect(),
        });
        let mut foam = Foaming {
            depth: empty(),
            thickness: Image::new(0, 0, [0.0; 2]),
            lit: empty(),
            far: empty(),
            before: empty(),
            level: self.config.thickness_level,
        };
        let mut foams = false;
        let four = || Image::new(0, 0, [0.0; 4]);
        let mut whitewater =
            DrawnWhitewater { occluders: four(), thickness: four(), normal: four(), light: four() };
        let mut has_whitewater = false;
        let mut soap = own.bubbles.map(|layers| Soaped {
            depth: empty(),
            color: four(),
            film: four(),
            layers: self.soap_layers(layers, output.rect.extent),
            range: own
                .blobs
                .map(|buffer| self.words_of(buffer, 5))
                .and_then(|words| words.try_into().ok())
                .expect("with blobs what became of them"),
        });
        for layer in &recorded.layers {
            let whole = layer.extent.into();
            match layer.name {
                "water.depth" => drawn.depth = self.floats(layer, whole),
                "water.thickness" if layer.format == vk::Format::R32G32_SFLOAT => {
                    let both = self.pairs(layer, whole);
                    drawn.thickness = both.map(|t| t[0]);
                    foam.before = both.map(|t| t[1]);
                }
                "water.thickness" => drawn.thickness = self.floats(layer, whole),
                "surface_foam" => (foam.depth, foams) = (self.floats(layer, whole), true),
                "water.spray" => {
                    let both = match layer.format {
                        vk::Format::R16G16_SFLOAT => self.halves(layer, whole),
                        _ => self.pairs(layer, whole),
                    };
                    drawn.spray = Some(both.map(|s| s[0]));
                    drawn.lit_spray = Some(both.map(|s| s[1]));
                }
                "motion" => drawn.motion = Some(self.pairs(layer, whole)),
                "water.noise" => drawn.noise = Some(self.floats(layer, whole)),
                "light.front" => drawn.light_front = Some(self.floats(layer, whole)),
                "light.thickness" => {
                    let bytes = self.bytes(layer, whole);
                    drawn.light_thickness = Some(picture(layer.format, layer.extent, &bytes));
                }
                "light.shadow" => {
                    let bytes = self.bytes(layer, whole);
                    drawn.shadow_basis = Some(picture(layer.format, layer.extent, &bytes));
                }
                "light.whitewater" => drawn.light_whitewater = Some(self.fours(layer)),
                "light.caustics" => drawn.caustics = Some(self.floats(layer, whole)),
                "surface_foam.thickness" => {
                    let four: Image<[f32; 4]> =
                        picture(layer.format, layer.extent, &self.bytes(layer, whole));
                    foam.thickness = four.map(|t| [t[0], t[1]]);
                    foam.lit = four.map(|t| t[2]);
                    foam.far = four.map(|t| t[3]);
                }
                "water.thickness.sheets" => {
                    let sheets = sheets.as_mut().expect("boundaries of two sheets");
                    assert_eq!(layer.format, vk::Format::R32G32B32A32_SFLOAT);
                    let texels: Image<[f32; 4]> =
                        picture(layer.format, whole.extent, &self.bytes(layer, whole));
                    sheets.thickness =
                        texels.map(|[front, back, window, _]| [*front, *back, *window]);
                    sheets.found = texels.map(|texel| texel[3]);
                }
                "water.surface" => {
                    let read = |level| self.floats(layer, area(level));
                    drawn.surface = read(&levels.level[0]);
                    drawn.coarser.iter_mut().zip(of(1..4)).for_each(|(to, l)| to.0 = read(l));
                    if let Some(sheets) = &mut sheets {
                        sheets.surface = read(&levels.level[4]);
                        sheets.coarser.iter_mut().zip(of(5..7)).for_each(|(to, l)| to.0 = read(l));
                    }
                }
                "water.iterations" => {
                    assert_eq!(layer.format, vk::Format::R32_UINT);
                    let read = |level| self.texels(layer, area(level));
                    drawn.plan = read(&levels.level[0]);
                    drawn.coarser.iter_mut().zip(of(1..4)).for_each(|(to, l)| to.1 = read(l));
                    if let Some(sheets) = &mut sheets {
                        sheets.plan = read(&levels.level[4]);
                        sheets.coarser.iter_mut().zip(of(5..7)).for_each(|(to, l)| to.1 = read(l));
                    }
                }
                "whitewater" => (whitewater.occluders, has_whitewater) = (self.fours(layer), true),
                "whitewater.thickness" => whitewater.thickness = self.fours(layer),
                "whitewater.normal" => whitewater.normal = self.fours(layer),
                "whitewater.irradiance" => whitewater.light = self.fours(layer),
                "bubbles" => {
                    soap.as_mut().expect("layers").depth = self.floats(layer, whole);
                }
                "bubbles.color" => soap.as_mut().expect("layers").color = self.fours(layer),
                "bubbles.film" => soap.as_mut().expect("layers").film = self.fours(layer),
                "shore" => {
                    assert_eq!(layer.format, vk::Format::R8G8B8A8_UNORM);
                    let bytes = self.bytes(layer, whole);
                    let data = bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
                    let (width, height) =
                        (layer.extent.width as usize, layer.extent.height as usize);
                    drawn.shore = Some(Image { width, height, data });
                }
                other => panic!("an unknown layer {other}"),
            }
        }
        drawn.sheets = sheets;
        drawn.foam = foams.then_some(foam);
        drawn.whitewater = has_whitewater.then_some(whitewater);
        drawn.soap = soap;
        drawn
    }

    /// Boundary of each thickness texel in a frame.
    fn boundaries(&self, buffer: vk::Buffer, frame: vk::Extent2D) -> Image<f32> {
        let texels = |pixels: u32| pixels.div_ceil(1 << self.config.thickness_level) as usize;
        let (width, height) = (texels(frame.width), texels(frame.height));
        let size = 4 * (width * height) as u64;
        let back = self.stub.sized(size, vk::BufferUsageFlags::TRANSFER_DST);
        self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, buffer, &back));
        Image { width, height, data: words(back.bytes()).map(f32::from_bits).collect() }
    }

    fn bytes(&self, layer: &Layer, area: vk::Rect2D) -> Vec<u8> {
        let color = vk::ImageAspectFlags::COLOR;
        self.stub.download(layer.image, layer.format, color, area, layer.access)
    }

    fn texels(&self, layer: &Layer, area: vk::Rect2D) -> Image<u32> {
        let (width, height) = (area.extent.width as usize, area.extent.height as usize);
        Image { width, height, data: words(&self.bytes(layer, area)).collect() }
    }

    fn fours(&self, layer: &Layer) -> Image<[f32; 4]> {
        picture(layer.format, layer.extent, &self.bytes(layer, layer.extent.into()))
    }

    fn pairs(&self, layer: &Layer, area: vk::Rect2D) -> Image<[f32; 2]> {
        assert_eq!(layer.format, vk::Format::R32G32_SFLOAT);
        let bytes = self.bytes(layer, area);
        let pairs = bytes.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
        let (width, height) = (area.extent.width as usize, area.extent.height as usize);
        Image { width, height, data: pairs }
    }

    fn halves(&self, layer: &Layer, area: vk::Rect2D) -> Image<[f32; 2]> {
        assert_eq!(layer.format, vk::Format::R16G16_SFLOAT);
        let bytes = self.bytes(layer, area);
        let half = |low, high| half::f16::from_le_bytes([low, high]).to_f32();
        let both = |b: &[u8]| [half(b[0], b[1]), half(b[2], b[3])];
        let (width, height) = (area.extent.width as usize, area.extent.height as usize);
        Image { width, height, data: bytes.chunks_exact(4).map(both).collect() }
    }

    fn floats(&self, layer: &Layer, area: vk::Rect2D) -> Image<f32> {
        self.texels(layer, area).map(|bits| f32::from_bits(*bits))
    }
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u32> + '_ {
    bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned)
}

fn picture(format: vk::Format, extent: vk::Extent2D, bytes: &[u8]) -> Image<[f32; 4]> {
    let data: Vec<[f32; 4]> = match host::texel_size(format) {
        16 => bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect(),
        4 if format == vk::Format::R8G8B8A8_UNORM => bytes
            .chunks_exact(4)
            .map(|c| [c[0], c[1], c[2], c[3]].map(|v| f32::from(v) / 255.0))
            .collect(),
        4 => {
            assert_eq!(format, vk::Format::R8G8B8A8_SNORM);
            let part = |v: u8| (f32::from(v.cast_signed()) / 127.0).max(-1.0);
            bytes.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]].map(part)).collect()
        }
        _ => bytes
            .chunks_exact(8)
            .map(|c| {
                let half: [u16; 4] = bytemuck::pod_read_unaligned(c);
                half.map(|v| half::f16::from_bits(v).to_f32())
            })
            .collect(),
    };
    Image { width: extent.width as usize, height: extent.height as usize, data }
}

fn crop(whole: &Image<[f32; 4]>, part: vk::Rect2D) -> Image<[f32; 4]> {
    let (width, height) = (part.extent.width as usize, part.extent.height as usize);
    let (x, y) = (part.offset.x as usize, part.offset.y as usize);
    let rows = whole.data.chunks_exact(whole.width).skip(y).take(height);
    Image { width, height, data: rows.flat_map(|row| row[x..x + width].to_vec()).collect() }
}

/// Rectangle of a level.
fn area(level: &SmoothingLevel) -> vk::Rect2D {
    let [x, y, width, height] = level.rect;
    let extent = vk::Extent2D { width: width as u32, height: height as u32 };
    vk::Rect2D { offset: vk::Offset2D { x, y }, extent }
}
