//! Layers as coloured panels, grids of panels, and their files.

use std::path::Path;

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{Rgb, RgbImage};
use whitewater::io::picture::Layers;

use crate::Outcome;

/// A depth layer as grey; near is bright.
pub fn depth(layers: &Layers, name: &str) -> Outcome<RgbImage> {
    let z = channel(layers, name)?;
    let there = |v: &&f32| **v < 1.0e9;
    let near = z.iter().filter(there).copied().fold(f32::INFINITY, f32::min);
    let far = z.iter().filter(there).copied().fold(near, f32::max);
    let range = (far - near).max(1.0e-6);
    Ok(picture(layers, |i| match z[i] < 1.0e9 {
        true => [1.0 - 0.85 * (z[i] - near) / range; 3],
        false => [0.0; 3],
    }))
}

/// An amount as grey, `1 - exp(-amount / scale)`, so that a large amount is white.
pub fn amount(layers: &Layers, name: &str, scale: f32) -> Outcome<RgbImage> {
    let all = channel(layers, name)?;
    Ok(picture(layers, |i| [1.0 - (-all[i] / scale).exp(); 3]))
}

/// Normals as colours, where there is a depth.
pub fn normals(layers: &Layers, name: &str, depth: &str) -> Outcome<RgbImage> {
    let [x, y, z] = ["X", "Y", "Z"].map(|axis| channel(layers, &format!("{name}.{axis}")));
    let (x, y, z) = (x?, y?, z?);
    let depth = channel(layers, depth)?;
    Ok(picture(layers, |i| match depth[i] < 1.0e9 {
        true => [x[i], y[i], z[i]].map(|v| 0.5 + 0.5 * v),
        false => [0.0; 3],
    }))
}

/// A fraction as grey.
pub fn share(layers: &Layers, name: &str) -> Outcome<RgbImage> {
    let all = channel(layers, name)?;
    Ok(picture(layers, |i| [all[i]; 3]))
}

/// Light as a picture; `most` is the brightest value.
pub fn light(layers: &Layers, name: &str, most: f32) -> Outcome<RgbImage> {
    let [r, g, b] = ["R", "G", "B"].map(|part| channel(layers, &format!("{name}.{part}")));
    let (r, g, b) = (r?, g?, b?);
    Ok(picture(layers, |i| [r[i], g[i], b[i]].map(|v| (v / most).powf(1.0 / 2.2))))
}

/// Iterations from yellow (few) to red (the most), with the thesis's colours.
pub fn iterations(layers: &Layers) -> Outcome<RgbImage> {
    let all = channel(layers, "water.iterations")?;
    let (_, most) = range_of(layers, "water.iterations")?;
    Ok(picture(layers, |i| match all[i] > 0.0 {
        true => [1.0, 1.0 - all[i] / most, 0.0],
        false => [0.0; 3],
    }))
}

/// World-space width and height of a pixel at a distance of one metre, from the layer's size and the camera's field of
/// view.
fn pixel_sizes(layers: &Layers) -> Outcome<[f32; 2]> {
    let camera = layers.attributes.iter().find(|(name, _)| name == "camera");
    let camera = camera.ok_or("the frame has no camera")?;
    let camera: serde_json::Value =
        serde_json::from_str(&camera.1).map_err(|error| error.to_string())?;
    let degrees = camera["fov_y_degrees"].as_f64().unwrap_or(40.0);
    let size = 2.0 * (0.5 * degrees.to_radians()).tan() / layers.height as f64;
    Ok([size as f32; 2])
}

/// Mean curvature of a depth layer, times a radius: red where it bulges to the eye, blue where it is hollow, white
/// where it is flat; black at silhouettes, where neighbouring depths differ by more than five radii. Also returns its
/// mean magnitude.
///
/// `2H = (C_y E_x + C_x E_y) / D^(3/2)`, `D = C_y² z_x² + C_x² z_y² + C_x² C_y² z²`, `E_x = z_x D_x / 2 - z_xx D` (van
/// der Laan et al. 2009), by central differences over pixels of size `C z`.
pub fn curvature(layers: &Layers, name: &str, radius: f32) -> Outcome<(RgbImage, f32)> {
    let z = channel(layers, name)?;
    let [c_x, c_y] = pixel_sizes(layers)?;
    let (width, height) = (layers.width, layers.height);
    let at = |x: isize, y: isize| {
        let inside = (0..width as isize).contains(&x) && (0..height as isize).contains(&y);
        if inside { z[y as usize * width + x as usize] } else { f32::INFINITY }
    };
    let curved = |i: usize| -> Option<f32> {
        let (x, y) = ((i % width) as isize, (i / width) as isize);
        let middle = at(x, y);
        let around = |dx: isize, dy: isize| {
            let found = at(x + dx, y + dy);
            ((found - middle).abs() < 5.0 * radius).then_some(found)
        };
        let ([left, right], [up, down]) =
            ([around(-1, 0)?, around(1, 0)?], [around(0, -1)?, around(0, 1)?]);
        let corners = [around(-1, -1)?, around(1, -1)?, around(-1, 1)?, around(1, 1)?];
        let (z_x, z_y) = (0.5 * (right - left), 0.5 * (down - up));
        let (z_xx, z_yy) = (left + right - 2.0 * middle, up + down - 2.0 * middle);
        let z_xy = 0.25 * (corners[3] - corners[2] - corners[1] + corners[0]);
        let [x2, y2] = [c_x * c_x, c_y * c_y];
        let d = y2 * z_x * z_x + x2 * z_y * z_y + x2 * y2 * middle * middle;
        let d_x = 2.0 * (y2 * z_x * z_xx + x2 * z_y * z_xy + x2 * y2 * middle * z_x);
        let d_y = 2.0 * (y2 * z_x * z_xy + x2 * z_y * z_yy + x2 * y2 * middle * z_y);
        let (e_x, e_y) = (0.5 * z_x * d_x - z_xx * d, 0.5 * z_y * d_y - z_yy * d);
        let a_pixel = 0.5 * (c_y * e_x + c_x * e_y) / d.powf(1.5);
        Some(a_pixel / (c_y * middle) * radius)
    };
    let all: Vec<Option<f32>> =
        (0..z.len()).map(|i| if z[i] < 1.0e9 { curved(i) } else { None }).collect();
    let there = || all.iter().flatten();
    let mean = there().map(|h| h.abs()).sum::<f32>() / there().count().max(1) as f32;
    let image = picture(layers, |i| match all[i] {
        Some(h) => {
            let much = 1.0 - (-h.abs()).exp();
            if h < 0.0 { [1.0, 1.0 - much, 1.0 - much] } else { [1.0 - much, 1.0 - much, 1.0] }
        }
        None => [0.0; 3],
    });
    Ok((image, mean))
}

/// Red at a border of a depth layer; yellow inside, where a second difference along an axis or along an edge of the 3 x
/// 3 block exceeds a threshold.
pub fn borders(layers: &Layers, name: &str, threshold: f32) -> Outcome<RgbImage> {
    let z = channel(layers, name)?;
    let (width, height) = (layers.width, layers.height);
    let at = |x: usize, y: usize, d: [isize; 2]| {
        let x = x.saturating_add_signed(d[0]).min(width - 1);
        let y = y.saturating_add_signed(d[1]).min(height - 1);
        z[y * width + x]
    };
    const LINES: [[[isize; 2]; 3]; 6] = [
        [[-1, 0], [0, 0], [1, 0]],
        [[0, -1], [0, 0], [0, 1]],
        [[-1, -1], [0, -1], [1, -1]],
        [[-1, 1], [0, 1], [1, 1]],
        [[-1, -1], [-1, 0], [-1, 1]],
        [[1, -1], [1, 0], [1, 1]],
    ];
    Ok(picture(layers, |i| {
        if z[i] >= 1.0e9 {
            return [0.0; 3];
        }
        let (x, y) = (i % width, i / width);
        let bends = |line: &[[isize; 2]; 3]| {
            let [a, b, c] = line.map(|d| at(x, y, d));
            (a - 2.0 * b + c).abs() > threshold
        };
        if LINES.iter().any(bends) { [0.9, 0.1, 0.05] } else { [1.0, 0.85, 0.1] }
    }))
}

/// Smallest and largest positive value of a channel.
pub fn range_of(layers: &Layers, name: &str) -> Outcome<(f32, f32)> {
    let all = channel(layers, name)?;
    let some = || all.iter().copied().filter(|v| *v > 0.0);
    Ok((some().fold(f32::INFINITY, f32::min), some().fold(0.0, f32::max)))
}

/// Mean of a channel.
pub fn mean_of(layers: &Layers, name: &str) -> Outcome<f64> {
    let all = channel(layers, name)?;
    Ok(all.iter().map(|v| f64::from(*v)).sum::<f64>() / all.len().max(1) as f64)
}

/// Values of a layer's channel.
pub fn channel<'a>(layers: &'a Layers, name: &str) -> Outcome<&'a [f32]> {
    layers.channel(name).ok_or_else(|| format!("the frame has no layer {name}"))
}

fn picture(layers: &Layers, color: impl Fn(usize) -> [f32; 3]) -> RgbImage {
    RgbImage::from_fn(layers.width as u32, layers.height as u32, |x, y| {
        let c = color(y as usize * layers.width + x as usize);
        Rgb(c.map(|v| (v * 255.0).round().clamp(0.0, 255.0) as u8))
    })
}

/// Arranges pictures of equal size row by row, with a gap between them.
pub fn grid(pictures: &[RgbImage], columns: u32, to: &Path) -> Outcome<()> {
    const GAP: u32 = 4;
    let first = pictures.first().ok_or("no pictures")?;
    let (width, height) = first.dimensions();
    let rows = (pictures.len() as u32).div_ceil(columns);
    let size = (columns * (width + GAP) - GAP, rows * (height + GAP) - GAP);
    let mut all = RgbImage::from_pixel(size.0, size.1, Rgb([255; 3]));
    for (i, picture) in (0..).zip(pictures) {
        let (x, y) = (i % columns * (width + GAP), i / columns * (height + GAP));
        image::imageops::replace(&mut all, picture, x.into(), y.into());
    }
    save(&all, to)
}

/// Size limit of a picture in the documents, in bytes: a page with ten of them loads in a second.
pub const MAX_BYTES: usize = 250_000;

/// Writes a picture for the documents: `.jpg` at the highest quality that fits in [`MAX_BYTES`], or `.png` (flat colours).
///
/// # Errors
/// The picture does not fit, or the file cannot be written.
pub fn save(picture: &RgbImage, to: &Path) -> Outcome<()> {
    let bytes = match to.extension().is_some_and(|extension| extension == "png") {
        true => png(picture),
        false => jpeg(picture),
    };
    let bytes = bytes.map_err(|error| format!("{}: {error}", to.display()))?;
    std::fs::write(to, bytes).map_err(|error| format!("cannot write {}: {error}", to.display()))
}

fn jpeg(picture: &RgbImage) -> Outcome<Vec<u8>> {
    for quality in [94, 90, 86, 82, 78, 72, 66, 60, 50, 40, 30] {
        let mut bytes = Vec::new();
        let encoder = JpegEncoder::new_with_quality(&mut bytes, quality);
        picture.write_with_encoder(encoder).map_err(|error| error.to_string())?;
        if bytes.len() <= MAX_BYTES {
            return Ok(bytes);
        }
    }
    Err(format!("{}x{} pixels need more than {MAX_BYTES} bytes", picture.width(), picture.height()))
}

fn png(picture: &RgbImage) -> Outcome<Vec<u8>> {
    let mut bytes = Vec::new();
    let encoder =
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    picture.write_with_encoder(encoder).map_err(|error| error.to_string())?;
    match bytes.len() <= MAX_BYTES {
        true => Ok(bytes),
        false => Err(format!("{} bytes, over {MAX_BYTES}: make it a .jpg", bytes.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform noise, the worst case of any codec.
    fn noise() -> RgbImage {
        let mut state = 1_u32;
        RgbImage::from_fn(1280, 720, |_, _| {
            image::Rgb([(); 3].map(|()| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as u8 / 4
            }))
        })
    }

    #[test]
    fn pictures_are_small_enough() {
        let bytes = jpeg(&noise()).expect("small enough");
        assert!(bytes.len() <= MAX_BYTES && bytes.starts_with(&[0xff, 0xd8]), "{}", bytes.len());
        let grey = jpeg(&RgbImage::new(64, 64)).expect("small enough");
        assert!(grey.len() < bytes.len());
    }

    #[test]
    fn the_ending_says_the_format() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let [small, large] = ["a.png", "b.png"].map(|name| folder.path().join(name));
        save(&RgbImage::new(8, 8), &small).expect("small enough");
        assert!(std::fs::read(small).expect("is there").starts_with(b"\x89PNG"));
        let error = save(&noise(), &large).expect_err("too large for a PNG");
        assert!(error.contains("make it a .jpg") && !large.exists(), "{error}");
    }
}
