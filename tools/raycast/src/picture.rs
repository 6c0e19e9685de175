//! Displayed intensities: picture files, and the difference between two pictures.

use std::path::Path;

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool, flip};
use whitewater::headless::Picture;

use crate::Outcome;

/// 8-bit values of all pixels, by the transfer function of sRGB (IEC 61966-2-1).
fn grey(picture: &Picture<f32>) -> Vec<u8> {
    let encode = |v: &f32| {
        let v = v.clamp(0.0, 1.0);
        let shown = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        (255.0 * shown).round() as u8
    };
    picture.data.iter().map(encode).collect()
}

/// Writes a PNG.
pub fn write(path: &Path, picture: &Picture<f32>) -> Outcome<()> {
    let (width, height) = (picture.width as u32, picture.height as u32);
    let image = image::GrayImage::from_raw(width, height, grey(picture))
        .ok_or("a picture without pixels")?;
    image.save(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Mean FLIP of two pictures of equal size (Andersson et al. 2020), at FLIP's default viewing distance.
pub fn mean_flip(a: &Picture<f32>, b: &Picture<f32>) -> f32 {
    let image = |picture: &Picture<f32>| {
        let bytes: Vec<u8> = grey(picture).into_iter().flat_map(|v| [v; 3]).collect();
        FlipImageRgb8::with_data(picture.width as u32, picture.height as u32, &bytes)
    };
    let error = flip(image(a), image(b), DEFAULT_PIXELS_PER_DEGREE);
    FlipPool::from_image(&error).mean()
}
