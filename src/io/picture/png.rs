//! PNG out and in, Radiance HDR in.

use std::io::{self, Cursor, Write};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageFormat};

use super::{Encoding, Layers};

pub fn write(layers: &Layers, exposure: f32, to: impl Write) -> io::Result<()> {
    let rgb = layers
        .display(exposure)
        .ok_or_else(|| io::Error::other("the picture has no channels R, G and B"))?;
    let mut bytes = Vec::with_capacity(3 * rgb.len());
    for (i, pixel) in rgb.iter().enumerate() {
        let (x, y) = (i % layers.width.max(1), i / layers.width.max(1));
        for (c, value) in pixel.iter().enumerate() {
            bytes.push((value * 255.0 + dither(x, y, c)) as u8);
        }
    }
    let wide = |n: usize| u32::try_from(n).map_err(|_| io::Error::other("too large for a PNG"));
    PngEncoder::new_with_quality(to, CompressionType::Default, FilterType::Adaptive)
        .write_image(&bytes, wide(layers.width)?, wide(layers.height)?, ExtendedColorType::Rgb8)
        .map_err(|error| match error {
            image::ImageError::IoError(error) => error,
            other => io::Error::other(other.to_string()),
        })
}

/// Interleaved gradient noise (Jimenez 2014) in [0, 1), shifted for each channel so that the noise is not grey.
fn dither(x: usize, y: usize, channel: usize) -> f32 {
    let (x, y) = (x as f32 + 47.0 * channel as f32, y as f32 + 17.0 * channel as f32);
    (52.982_918 * (0.067_110_56 * x + 0.005_837_15 * y).fract()).fract()
}

pub fn read_png(bytes: &[u8]) -> Result<Layers, String> {
    let image =
        image::load_from_memory_with_format(bytes, ImageFormat::Png).map_err(|e| e.to_string())?;
    let image = image.into_rgba16();
    let mut layers = Layers::new(image.width() as usize, image.height() as usize);
    layers.encoding = Encoding::Srgb;
    for (c, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        let data = image.pixels().map(|p| f32::from(p.0[c]) / 65535.0).collect();
        let (width, height) = (layers.width, layers.height);
        layers.push(name, width, height, data).map_err(|e| e.to_string())?;
    }
    Ok(layers)
}

pub fn read_hdr(bytes: &[u8]) -> Result<Layers, String> {
    let decoder =
        image::codecs::hdr::HdrDecoder::new(Cursor::new(bytes)).map_err(|e| e.to_string())?;
    let image = image::DynamicImage::from_decoder(decoder).map_err(|e| e.to_string())?;
    let image = image.into_rgb32f();
    let mut layers = Layers::new(image.width() as usize, image.height() as usize);
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        let data = image.pixels().map(|p| p.0[c]).collect();
        let (width, height) = (layers.width, layers.height);
        layers.push(name, width, height, data).map_err(|e| e.to_string())?;
    }
    Ok(layers)
}
