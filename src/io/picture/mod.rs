//! Pictures: writes multi-layer OpenEXR and tone-mapped PNG, reads EXR, PNG and Radiance HDR.
//!
//! A picture is a set of named channels of one size, see [`Layers`]. The rendered picture itself is in the
//! channels `R G B A`: linear, scene-referred, Rec. 709 primaries. The other channels are named after their pass
//! (`water.depth.Z`).
#![forbid(unsafe_code)]

mod exr;
mod normal;
mod png;
mod tone;

use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

pub use normal::normals;
pub use tone::{Tone, aces, agx, neutral, srgb_decode, srgb_encode};

/// Value of depth channels at pixels without a surface.
pub const EMPTY: f32 = 1.0e10;

/// Encoding of `R G B`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Linear light, unbounded.
    #[default]
    Linear,
    /// sRGB's curve, 0 to 1, as in a PNG.
    Srgb,
}

/// One channel, row by row, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name, such as `water.depth.Z`.
    pub name: String,
    /// One value per pixel.
    pub data: Vec<f32>,
}

/// Named channels of one size, with text attributes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Channels in any order, with unique names.
    pub channels: Vec<Channel>,
    /// Name and text of each attribute. EXR files store them as one JSON object in the attribute `whitewater`.
    pub attributes: Vec<(String, String)>,
    /// Encoding of `R G B`.
    pub encoding: Encoding,
}

impl Layers {
    /// A picture without channels.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, ..Self::default() }
    }

    /// Adds a channel, or replaces the one of that name. A channel at a reduced resolution (that of the picture halved
    /// up to 8 times, rounded up each time) is enlarged to the picture's size by repeating its texels.
    ///
    /// # Errors
    /// [`PictureError::Size`] if `data` has neither the picture's size nor a reduced one.
    pub fn push(
        &mut self,
        name: &str,
        width: usize,
        height: usize,
        data: Vec<f32>,
    ) -> Result<(), PictureError> {
        let size = || PictureError::Size {
            channel: name.into(),
            expected: (self.width, self.height),
            found: (width, height),
            values: data.len(),
        };
        if Some(data.len()) != width.checked_mul(height) {
            return Err(size());
        }
        let half = |full: usize, level: u32| full.div_ceil(1 << level);
        let level = (0..=8)
            .find(|l| half(self.width, *l) == width && half(self.height, *l) == height)
            .ok_or_else(size)?;
        let data = if level == 0 {
            data
        } else {
            let row = |y: usize| &data[(y >> level) * width..][..width];
            (0..self.height)
                .flat_map(|y| (0..self.width).map(move |x| row(y)[x >> level]))
                .collect()
        };
        self.channels.retain(|c| c.name != name);
        self.channels.push(Channel { name: name.into(), data });
        Ok(())
    }

    /// The channel with a name.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|c| c.name == name).map(|c| c.data.as_slice())
    }

    /// Red, green and blue of all pixels; `None` if the picture has no colour channels. A picture with only channel `Y`
    /// gives grey.
    pub fn rgb(&self) -> Option<Vec<[f32; 3]>> {
        let one = |name| self.channel(name);
        let (r, g, b) = match (one("R"), one("G"), one("B")) {
            (Some(r), Some(g), Some(b)) => (r, g, b),
            _ => one("Y").map(|y| (y, y, y))?,
        };
        Some(r.iter().zip(g).zip(b).map(|((r, g), b)| [*r, *g, *b]).collect())
    }

    /// The displayed colour, sRGB from 0 to 1. Linear light is multiplied by 2^`exposure` and tone mapped as in
    /// [`write_png`]; a picture that is in sRGB already is returned unchanged. `None` for a picture without colour.
    pub fn display(&self, exposure: f32) -> Option<Vec<[f32; 3]>> {
        self.shown(&Display { exposure, ..Display::default() })
    }

    /// The displayed colour with another tone map.
    pub fn shown(&self, display: &Display) -> Option<Vec<[f32; 3]>> {
        let mut rgb = self.rgb()?;
        let alpha = self.channel("A").filter(|_| display.alpha);
        if self.encoding == Encoding::Linear {
            for (i, c) in rgb.iter_mut().enumerate() {
                let share = alpha.as_ref().map_or(1.0, |alpha| alpha[i]);
                let whole = if share > 0.0 { share.recip() } else { 0.0 };
                let lit = c.map(|v| v * whole * display.exposure.exp2());
                *c = display.tone.map(lit).map(srgb_encode);
            }
        }
        Some(rgb)
    }
}

/// Display of linear light: exposure and tone map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// Exposure in stops, default 0.
    pub exposure: f32,
    /// Tone map, default [`Tone::Neutral`].
    pub tone: Tone,
    /// Whether channel `A` is the opacity by which the colours are premultiplied. If so, a PNG stores the opacity,
    /// and colours divided by it. Default false: the picture is opaque.
    pub alpha: bool,
}

/// Why a picture could not be read or assembled.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The file is missing or may not be read.
    #[error("cannot read {}: {reason}; check the name and the permissions", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's error.
        reason: std::io::Error,
    },
    /// The content of the file is invalid.
    #[error("{}: expected {expected}, found {found}; write the file again", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What was expected.
        expected: &'static str,
        /// What was found.
        found: String,
    },
    /// A channel of another size.
    #[error(
        "channel {channel}: expected {}x{} values or a halved size, found {}x{} with {values} values",
        expected.0, expected.1, found.0, found.1
    )]
    Size {
        /// The channel.
        channel: String,
        /// Size of the picture.
        expected: (usize, usize),
        /// Size of the channel.
        found: (usize, usize),
        /// Number of values in `data`.
        values: usize,
    },
}

/// Reads an EXR (first layer, all channels), a PNG or a Radiance HDR, recognised by content.
///
/// # Errors
/// The error says what was expected and what was found.
pub fn read(path: &Path) -> Result<Layers, PictureError> {
    let io = |reason| PictureError::Io { path: path.to_path_buf(), reason };
    let bytes = std::fs::read(path).map_err(io)?;
    let content = |expected, found| PictureError::Content { path: path.into(), expected, found };
    if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        exr::read(&bytes).map_err(|found| content("an OpenEXR picture", found))
    } else if bytes.starts_with(b"\x89PNG") {
        png::read_png(&bytes).map_err(|found| content("a PNG", found))
    } else if bytes.starts_with(b"#?") {
        png::read_hdr(&bytes).map_err(|found| content("a Radiance HDR", found))
    } else {
        let found = match bytes.len() {
            0 => "an empty file".to_string(),
            _ => "none of their first bytes".to_string(),
        };
        Err(content("an EXR, PNG or HDR", found))
    }
}

/// Writes all channels and attributes as one OpenEXR layer: 32-bit float, ZIP.
///
/// # Errors
/// Errors of the writer.
pub fn write_exr(layers: &Layers, to: impl Write + Seek) -> std::io::Result<()> {
    exr::write(layers, to)
}

/// Writes the colour as an 8-bit sRGB PNG. Linear light gets `exposure`, in stops, and the tone map [`neutral`]; a
/// picture that is in sRGB already keeps its values. A dither of up to half a step in either direction, the same in
/// every run, prevents banding. A picture without colour is an error.
///
/// # Errors
/// Errors of the writer.
pub fn write_png(layers: &Layers, exposure: f32, to: impl Write) -> std::io::Result<()> {
    write_png_as(layers, &Display { exposure, ..Display::default() }, to)
}

/// Writes the colour as a PNG with another tone map.
///
/// # Errors
/// Those of [`write_png`].
pub fn write_png_as(layers: &Layers, display: &Display, to: impl Write) -> std::io::Result<()> {
    png::write(layers, display, to)
}

/// Writes values from 0 to 1 that are not colours, such as a texture of distances, as a 16-bit PNG: channel `Y`
/// as a grey PNG, otherwise channels `R G B A`. Values are linear, undithered and clamped.
///
/// # Errors
/// Errors of the writer, and a picture without those channels.
pub fn write_png_values(layers: &Layers, to: impl Write) -> std::io::Result<()> {
    png::write_values(layers, to)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test may
mod tests {
    use super::*;

    #[test]
    fn reduced_channels_are_repeated() {
        let mut layers = Layers::new(5, 3);
        layers.push("half", 3, 2, vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        let expected = [0.0, 0.0, 1.0, 1.0, 2.0, 0.0, 0.0, 1.0, 1.0, 2.0, 3.0, 3.0, 4.0, 4.0, 5.0];
        assert_eq!(layers.channel("half").unwrap(), expected);
        layers.push("quarter", 2, 1, vec![7.0, 8.0]).unwrap();
        assert_eq!(layers.channel("quarter").unwrap()[..5], [7.0, 7.0, 7.0, 7.0, 8.0]);
        for (width, height, values) in [(4, 3, 12), (5, 3, 14), (0, 0, 0)] {
            assert!(matches!(
                layers.push("bad", width, height, vec![0.0; values]),
                Err(PictureError::Size { .. })
            ));
        }
    }

    #[test]
    fn exr_comes_back_as_it_went() {
        let mut layers = Layers::new(7, 5);
        for (i, name) in
            ["R", "G", "B", "A", "water.depth.Z", "water.iterations"].iter().enumerate()
        {
            let data =
                (0..35).map(|p| if p == 3 { EMPTY } else { (p * (i + 1)) as f32 * 0.37 }).collect();
            layers.push(name, 7, 5, data).unwrap();
        }
        layers.attributes.push(("adapter".into(), "llvmpipe, \"8\" bits µ 🌊\n".into()));
        layers.attributes.push(("version".into(), "1".into()));
        let mut bytes = std::io::Cursor::new(Vec::new());
        write_exr(&layers, &mut bytes).unwrap();
        let back = exr::read(bytes.get_ref()).unwrap();
        assert_eq!((back.width, back.height), (7, 5));
        for channel in &layers.channels {
            assert_eq!(back.channel(&channel.name).unwrap(), channel.data, "{}", channel.name);
        }
        assert_eq!(back.attributes, layers.attributes);
        for cut in [5, 100, bytes.get_ref().len() - 9] {
            assert!(exr::read(&bytes.get_ref()[..cut]).is_err(), "{cut}");
        }
    }

    #[test]
    fn png_is_the_tone_mapped_colour_within_a_step() {
        let mut layers = Layers::new(16, 4);
        for (i, name) in ["R", "G", "B"].iter().enumerate() {
            let data = (0..64).map(|p| p as f32 * 0.02 * (i + 1) as f32).collect();
            layers.push(name, 16, 4, data).unwrap();
        }
        let mut bytes = Vec::new();
        write_png(&layers, -0.5, &mut bytes).unwrap();
        let back = png::read_png(&bytes).unwrap();
        assert_eq!(back.encoding, Encoding::Srgb);
        let (expected, found) = (layers.display(-0.5).unwrap(), back.display(0.0).unwrap());
        for (e, f) in expected.iter().flatten().zip(found.iter().flatten()) {
            assert!((e - f).abs() <= 1.0 / 255.0, "{e} {f}");
        }
    }

    /// Each stop doubles the light: light of 0.25 that is raised by a stop has the code of 0.5, which is 0.7354.
    #[test]
    fn stops_double_the_light() {
        let mut layers = Layers::new(1, 1);
        for name in ["R", "G", "B"] {
            layers.push(name, 1, 1, vec![0.25]).unwrap();
        }
        for (exposure, code) in [(1.0, 0.735_357), (0.0, 0.537_099), (-1.0, 0.388_573)] {
            let shown = layers.shown(&Display { exposure, tone: Tone::Linear, alpha: false });
            let [found, ..] = shown.unwrap()[0];
            assert!((found - code).abs() < 1.0e-5, "{exposure}: {found}");
        }
    }

    /// A PNG with alpha stores, for a pixel that a colour covers by half, this colour undarkened and an opacity of a
    /// half.
    #[test]
    fn a_png_keeps_the_share_that_is_covered() {
        let mut layers = Layers::new(2, 1);
        for (name, data) in
            [("R", [0.1, 0.0]), ("G", [0.2, 0.0]), ("B", [0.3, 0.0]), ("A", [0.5, 0.0])]
        {
            layers.push(name, 2, 1, data.to_vec()).unwrap();
        }
        let mut bytes = Vec::new();
        let display = Display { alpha: true, tone: Tone::Linear, ..Display::default() };
        write_png_as(&layers, &display, &mut bytes).unwrap();
        let back = png::read_png(&bytes).unwrap();
        for (name, expected) in
            [("R", srgb_encode(0.2)), ("G", srgb_encode(0.4)), ("B", srgb_encode(0.6)), ("A", 0.5)]
        {
            let found = back.channel(name).unwrap();
            assert!((found[0] - expected).abs() <= 1.0 / 255.0, "{name} {found:?} {expected}");
        }
        assert_eq!(back.channel("A").unwrap()[1], 0.0);
        write_png_as(&layers, &Display::default(), &mut bytes).unwrap();
    }

    #[test]
    fn numbers_come_back_from_a_png_within_half_a_step() {
        let values: Vec<f32> = (0..35).map(|i| i as f32 / 34.0).collect();
        let mut layers = Layers::new(7, 5);
        let read = |layers: &Layers| {
            let mut bytes = Vec::new();
            write_png_values(layers, &mut bytes).unwrap();
            png::read_png(&bytes).unwrap()
        };
        let same = |found: &[f32], expected: &[f32]| {
            let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(found.len() == 35 && off <= 0.51 / 65535.0, "{off}");
        };
        assert!(write_png_values(&layers, &mut Vec::new()).is_err());
        let names = ["R", "G", "B", "A"];
        for (power, name) in (1..).zip(names) {
            layers.push(name, 7, 5, values.iter().map(|v| v.powi(power)).collect()).unwrap();
        }
        let back = read(&layers);
        for name in names {
            same(back.channel(name).unwrap(), layers.channel(name).unwrap());
        }
        layers.push("Y", 7, 5, values.clone()).unwrap();
        let back = read(&layers);
        for name in ["R", "G", "B"] {
            same(back.channel(name).unwrap(), &values);
        }
        let beyond = [-1.0, 2.0, f32::NAN, f32::INFINITY];
        layers
            .push("Y", 7, 5, beyond.into_iter().chain(values.clone()).take(35).collect())
            .unwrap();
        assert_eq!(read(&layers).channel("R").unwrap()[..4], [0.0, 1.0, 0.0, 1.0]);
    }
}
