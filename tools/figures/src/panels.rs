//! Layers as colours, and pictures side by side.

use std::path::Path;

use image::{Rgb, RgbImage};
use whitewater::io::picture::Layers;

use crate::Outcome;

/// A depth: near is bright.
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

/// An amount, white where it is all there is: `1 - exp(-amount / scale)`.
pub fn amount(layers: &Layers, name: &str, scale: f32) -> Outcome<RgbImage> {
    let all = channel(layers, name)?;
    Ok(picture(layers, |i| [1.0 - (-all[i] / scale).exp(); 3]))
}

/// Normals, where there is a depth.
pub fn normals(layers: &Layers, name: &str, depth: &str) -> Outcome<RgbImage> {
    let [x, y, z] = ["X", "Y", "Z"].map(|axis| channel(layers, &format!("{name}.{axis}")));
    let (x, y, z) = (x?, y?, z?);
    let depth = channel(layers, depth)?;
    Ok(picture(layers, |i| match depth[i] < 1.0e9 {
        true => [x[i], y[i], z[i]].map(|v| 0.5 + 0.5 * v),
        false => [0.0; 3],
    }))
}

/// A share as grey.
pub fn share(layers: &Layers, name: &str) -> Outcome<RgbImage> {
    let all = channel(layers, name)?;
    Ok(picture(layers, |i| [all[i]; 3]))
}

/// Light, brightest what is `most`.
pub fn light(layers: &Layers, name: &str, most: f32) -> Outcome<RgbImage> {
    let [r, g, b] = ["R", "G", "B"].map(|part| channel(layers, &format!("{name}.{part}")));
    let (r, g, b) = (r?, g?, b?);
    Ok(picture(layers, |i| [r[i], g[i], b[i]].map(|v| (v / most).powf(1.0 / 2.2))))
}

/// Iterations from yellow (few) to red (the most), as the thesis has them.
pub fn iterations(layers: &Layers) -> Outcome<RgbImage> {
    let all = channel(layers, "water.iterations")?;
    let (_, most) = range_of(layers, "water.iterations")?;
    Ok(picture(layers, |i| match all[i] > 0.0 {
        true => [1.0, 1.0 - all[i] / most, 0.0],
        false => [0.0; 3],
    }))
}

/// The least and the most of a channel's values over 0.
pub fn range_of(layers: &Layers, name: &str) -> Outcome<(f32, f32)> {
    let all = channel(layers, name)?;
    let some = || all.iter().copied().filter(|v| *v > 0.0);
    Ok((some().fold(f32::INFINITY, f32::min), some().fold(0.0, f32::max)))
}

/// The mean of a channel.
pub fn mean_of(layers: &Layers, name: &str) -> Outcome<f64> {
    let all = channel(layers, name)?;
    Ok(all.iter().map(|v| f64::from(*v)).sum::<f64>() / all.len().max(1) as f64)
}

/// A layer's values.
pub fn channel<'a>(layers: &'a Layers, name: &str) -> Outcome<&'a [f32]> {
    layers.channel(name).ok_or_else(|| format!("the frame has no layer {name}"))
}

fn picture(layers: &Layers, color: impl Fn(usize) -> [f32; 3]) -> RgbImage {
    RgbImage::from_fn(layers.width as u32, layers.height as u32, |x, y| {
        let c = color(y as usize * layers.width + x as usize);
        Rgb(c.map(|v| (v * 255.0).round().clamp(0.0, 255.0) as u8))
    })
}

/// Pictures of one size, row by row, with a gap between them.
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
    all.save(to).map_err(|error| format!("cannot write {}: {error}", to.display()))
}
