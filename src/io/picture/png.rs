//! Reads and writes PNG, reads Radiance HDR.

use std::io::{self, Cursor, Read as _, Write};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError, ImageFormat, ImageReader};

use super::{Display, Encoding, Layers};

pub fn write(layers: &Layers, display: &Display, to: impl Write) -> io::Result<()> {
    let rgb = layers
        .shown(display)
        .ok_or_else(|| io::Error::other("the picture has no channels R, G and B"))?;
    let alpha = layers.channel("A").filter(|_| display.alpha);
    let mut bytes = Vec::with_capacity(4 * rgb.len());
    for (i, pixel) in rgb.iter().enumerate() {
        let (x, y) = (i % layers.width.max(1), i / layers.width.max(1));
        for (c, value) in pixel.iter().enumerate() {
            bytes.push((value * 255.0 + dither(x, y, c)) as u8);
        }
        // Alpha is not dithered, so that 0 and 1 stay exact.
        bytes.extend(alpha.as_ref().map(|alpha| (alpha[i] * 255.0 + 0.5) as u8));
    }
    let kind = if alpha.is_some() { ExtendedColorType::Rgba8 } else { ExtendedColorType::Rgb8 };
    encode(layers, &bytes, kind, to)
}

fn encode(
    layers: &Layers,
    bytes: &[u8],
    kind: ExtendedColorType,
    to: impl Write,
) -> io::Result<()> {
    let wide = |n: usize| u32::try_from(n).map_err(|_| io::Error::other("too large for a PNG"));
    PngEncoder::new_with_quality(to, CompressionType::Default, FilterType::Adaptive)
        .write_image(bytes, wide(layers.width)?, wide(layers.height)?, kind)
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other.to_string()),
        })
}

pub fn write_values(layers: &Layers, to: impl Write) -> io::Result<()> {
    let all = |names: &[&str]| names.iter().map(|name| layers.channel(name)).collect();
    let grey: Option<Vec<_>> = all(&["Y"]);
    let (channels, kind) = match grey.or_else(|| all(&["R", "G", "B", "A"])) {
        Some(channels) if channels.len() == 1 => (channels, ExtendedColorType::L16),
        Some(channels) => (channels, ExtendedColorType::Rgba16),
        None => return Err(io::Error::other("the picture has no channel Y, nor R, G, B and A")),
    };
    let mut bytes = Vec::with_capacity(2 * channels.len() * layers.width * layers.height);
    for i in 0..layers.width * layers.height {
        for channel in &channels {
            // NaN becomes 0.
            let step = (channel[i] * 65535.0).round() as u16;
            bytes.extend(step.to_ne_bytes());
        }
    }
    encode(layers, &bytes, kind, to)
}

/// Interleaved gradient noise (Jimenez 2014) in [0, 1), shifted for each channel so that the noise is not grey.
fn dither(x: usize, y: usize, channel: usize) -> f32 {
    let (x, y) = (x as f32 + 47.0 * channel as f32, y as f32 + 17.0 * channel as f32);
    (52.982_918 * (0.067_110_56 * x + 0.005_837_15 * y).fract()).fract()
}

pub fn read_png(bytes: &[u8]) -> Result<Layers, String> {
    let reader = || ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
    let image = reader().decode().map_err(|error| match (error, reader().into_dimensions()) {
        // The limit of the `image` crate.
        (ImageError::Limits(_), Ok((width, height))) => format!(
            "one of {width}x{height} pixels, which unpack to more than 512 MiB: make it smaller"
        ),
        (error, _) => error.to_string(),
    })?;
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

/// Both signatures of a Radiance HDR; the decoder accepts only the first.
const SIGNATURES: [&[u8]; 2] = [b"#?RADIANCE", b"#?RGBE"];

pub fn read_hdr(bytes: &[u8]) -> Result<Layers, String> {
    let body = match SIGNATURES.iter().find_map(|signature| bytes.strip_prefix(*signature)) {
        Some(body) => body,
        None => return Err("neither #?RADIANCE nor #?RGBE".into()),
    };
    let file = SIGNATURES[0].chain(body);
    let decoder = image::codecs::hdr::HdrDecoder::new(file).map_err(|e| e.to_string())?;
    // The decoder only reads what the pixels were multiplied with.
    let about = decoder.metadata();
    let (r, g, b) = about.color_correction.unwrap_or((1.0, 1.0, 1.0));
    let factors = [r, g, b].map(|factor| factor * about.exposure.unwrap_or(1.0));
    if factors.iter().any(|factor| !factor.is_finite() || *factor <= 0.0) {
        return Err("one whose EXPOSURE or COLORCORR is not a positive number".into());
    }
    let image = image::DynamicImage::from_decoder(decoder).map_err(|e| e.to_string())?;
    let image = image.into_rgb32f();
    let mut layers = Layers::new(image.width() as usize, image.height() as usize);
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        let data = image.pixels().map(|p| p.0[c] / factors[c]).collect();
        let (width, height) = (layers.width, layers.height);
        layers.push(name, width, height, data).map_err(|e| e.to_string())?;
    }
    Ok(layers)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test may

    use super::*;

    /// A PNG that declares a size, with only the beginning of its pixels.
    fn png(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
        let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
        header.extend([8, 2, 0, 0, 0]);
        for (kind, data) in [(b"IHDR", &header[..]), (b"IDAT", &[0x78, 0x01][..])] {
            let mut crc = flate2::Crc::new();
            crc.update(kind);
            crc.update(data);
            bytes.extend((data.len() as u32).to_be_bytes());
            bytes.extend(kind);
            bytes.extend(data);
            bytes.extend(crc.sum().to_be_bytes());
        }
        bytes
    }

    #[test]
    fn a_png_that_is_too_large_says_so() {
        let why = read_png(&png(20_000, 10_000)).unwrap_err();
        assert!(why.contains("20000x10000") && why.contains("512 MiB"), "{why}");
        let why = read_png(&png(200, 100)).unwrap_err();
        assert!(!why.contains("200x100"), "{why}");
    }

    /// Two pixels, with each of the two signatures of Radiance pictures.
    #[test]
    fn both_signatures_of_radiance_are_read() {
        let read = |signature: &str| {
            let header = format!("{signature}\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n");
            // A mantissa of 128 is a half, times 2 to the exponent minus 128.
            let pixels = [128, 64, 32, 129, 64, 128, 0, 130];
            read_hdr(&[header.as_bytes(), &pixels].concat())
        };
        for signature in ["#?RADIANCE", "#?RGBE"] {
            let picture = read(signature).unwrap();
            let rgb = picture.rgb().unwrap();
            assert_eq!(rgb, [[1.0, 0.5, 0.25], [1.0, 2.0, 0.0]], "{signature}");
        }
        assert!(read("#?XYZE").unwrap_err().contains("#?RGBE"));
    }

    /// Pixels are divided by all exposures and colour corrections of the header.
    #[test]
    fn exposure_of_radiance_is_divided_out() {
        let read = |lines: &str| {
            let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{lines}\n-Y 1 +X 2\n");
            let pixels = [128, 64, 32, 129, 64, 128, 0, 130];
            read_hdr(&[header.as_bytes(), &pixels].concat())
        };
        for (lines, expected) in [
            ("EXPOSURE=4.0\n", [[0.25, 0.125, 0.0625], [0.25, 0.5, 0.0]]),
            ("EXPOSURE=2\nEXPOSURE= 0.25\n", [[2.0, 1.0, 0.5], [2.0, 4.0, 0.0]]),
            ("EXPOSURE=2\nCOLORCORR=1 2 4\n", [[0.5, 0.125, 0.03125], [0.5, 0.5, 0.0]]),
        ] {
            assert_eq!(read(lines).unwrap().rgb().unwrap(), expected, "{lines}");
        }
        for lines in ["EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=nan\n"] {
            assert!(read(lines).unwrap_err().contains("EXPOSURE"), "{lines}");
        }
    }
}
