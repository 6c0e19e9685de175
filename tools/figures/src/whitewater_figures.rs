//! The figures of screen-space foam, with their numbers in the paper (Akinci et al. 2013).

use std::path::Path;

use image::{Rgb, RgbImage};
use plotters::prelude::SeriesLabelPosition;
use whitewater::io::picture::srgb_encode;

use crate::Outcome;
use crate::curves::{Function, functions};
use crate::figures::pictures;
use crate::panels::{amount, channel, depth, grid, light, normals, share};
use crate::tool::{Tool, linear};

/// Figures 1 and 8, upper row: the seas, with the paper's particle counts.
pub fn seas(tool: &Tool, docs: &Path) -> Outcome<()> {
    let seas = [("wave", "820k"), ("ship", "9m"), ("lighthouse", "15m"), ("flood", "29m")];
    let panels: Result<Vec<_>, String> =
        seas.iter().map(|(sea, count)| tool.sea(sea, count, "640x480", "")).collect();
    grid(&panels?, 2, &pictures(docs, "seas.jpg"))
}

/// The same foam from several distances in metres.
pub fn distances(tool: &Tool, docs: &Path) -> Outcome<()> {
    let panels: Result<Vec<_>, String> = [5.0, 20.0, 60.0, 200.0]
        .iter()
        .map(|metres| tool.sea_from(*metres, "flood", "29m", "640x480"))
        .collect();
    grid(&panels?, 2, &pictures(docs, "whitewater-distances.jpg"))
}

/// Figure 8: our foam above, and below it the same foam by volume ray-casting. Ray-casting has only emission and
/// absorption, so it is given the mean brightness of ours.
pub fn ray_cast(tool: &Tool, docs: &Path) -> Outcome<()> {
    let size = "480x360";
    let seas = [("wave", 820_000), ("lighthouse", 15_000_000), ("ship", 9_000_000)];
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for (sea, count) in seas {
        let picture = tool.sea(sea, &count.to_string(), size, "")?;
        let layers = tool.sea_layers(sea, &count.to_string(), size, "")?;
        // A sea needs at least one particle, and this one is invisible.
        let bare = tool.sea(sea, "1", size, "half_intensity_thickness = 1000000.0")?;
        let covered = tool.sea_ray_cast(sea, count, size)?;
        let shine = mean_of_dense(&picture, channel(&layers, "whitewater.intensity")?);
        let mut cast = bare;
        for (pixel, part) in cast.pixels_mut().zip(&covered) {
            let over = |c: usize| part * shine[c] + (1.0 - part) * linear(pixel[c]);
            *pixel = Rgb([0, 1, 2].map(|c| (255.0 * srgb_encode(over(c))).round() as u8));
        }
        ours.push(picture);
        theirs.push(cast);
    }
    grid(&[ours, theirs].concat(), 3, &pictures(docs, "seas-ray-cast.jpg"))
}

/// Mean linear colour of the pixels that foam covers almost fully.
fn mean_of_dense(picture: &RgbImage, intensity: &[f32]) -> [f32; 3] {
    let dense = || picture.pixels().zip(intensity).filter(|(_, part)| **part > 0.9);
    let count = dense().count().max(1) as f32;
    [0, 1, 2].map(|c| dense().map(|(pixel, _)| linear(pixel[c])).sum::<f32>() / count)
}

/// Figure 3: the result of each pass.
pub fn layers(tool: &Tool, docs: &Path) -> Outcome<()> {
    let (sea, count, size) = ("wave", "820k", "480x360");
    let layers = &tool.sea_layers(sea, count, size, "")?;
    let panels = [
        depth(layers, "whitewater.Z")?,
        normals(layers, "whitewater.normal", "whitewater.Z")?,
        amount(layers, "whitewater.thickness", 6.0)?,
        share(layers, "whitewater.intensity")?,
        share(layers, "whitewater.shadow")?,
        light(layers, "whitewater.irradiance", 6.0)?,
        tool.sea(sea, count, size, "passes = 0")?,
        tool.sea(sea, count, size, "")?,
    ];
    grid(&panels, 2, &pictures(docs, "whitewater-layers.jpg"))
}

/// Figures 4 to 6: the kinds' shapes and the intensity, as formulas and as drawn.
pub fn shapes(tool: &Tool, docs: &Path) -> Outcome<()> {
    const SIZE: u32 = 240;
    const RADIUS: f64 = 112.0;
    let (mut discs, mut all) = (Vec::new(), Vec::new());
    let kinds = [
        ("spray", 1.5, "spray, f(x, 1, 1.5, 1)"),
        ("foam", 2.25, "foam, f(x, 1, 2.25, 1)"),
        ("bubble", 2.0, "bubble, 1 - f(x, 1, 2, 1)"),
    ];
    for (kind, power, name) in kinds {
        let layers = tool.particle(kind, SIZE, RADIUS)?;
        discs.push(share(&layers, "whitewater.thickness")?);
        let shape = |x: f64| if kind == "bubble" { x.powf(power) } else { 1.0 - x.powf(power) };
        let line = (0..=100).map(|i| f64::from(i) / 100.0).map(|x| (x, shape(x))).collect();
        // The row next to the middle, every eighth pixel.
        let (row, values) = (SIZE / 2, channel(&layers, "whitewater.thickness")?);
        let dot = |x: u32| {
            let away = (f64::from(x - row) + 0.5).hypot(0.5) / RADIUS;
            (away, f64::from(values[(row * SIZE + x) as usize]))
        };
        let dots = (row..SIZE).step_by(8).map(dot).filter(|(x, _)| *x < 1.0).collect();
        all.push(Function { name: name.to_owned(), line, dots });
    }
    grid(&discs, 3, &pictures(docs, "whitewater-kinds.png"))?;
    let axes = ["distance from the middle, radii", "thickness"];
    let title = ("Shapes", SeriesLabelPosition::MiddleLeft);
    functions(title, axes, [1.0, 1.05], &all, &pictures(docs, "whitewater-shapes.svg"))?;

    let mut all = Vec::new();
    for (half, exponent) in [(1.0_f64, 1.25_f64), (3.0, 1.25), (3.0, 3.0)] {
        let look = format!("half_intensity_thickness = {half:.1}\nexponent = {exponent:.2}");
        let layers = tool.sea_layers("wave", "200k", "320x240", &look)?;
        let (thickness, intensity) =
            (channel(&layers, "whitewater.thickness")?, channel(&layers, "whitewater.intensity")?);
        let sigmoid = |rho: f64| rho.powf(exponent) / (half + rho.powf(exponent));
        let line = (0..=120).map(|i| f64::from(i) / 10.0).map(|x| (x, sigmoid(x))).collect();
        // The pixel whose thickness is nearest to each multiple of 0.5.
        let near = |rho: f32| {
            let off = |i: &usize| (thickness[*i] - rho).abs();
            (0..thickness.len()).min_by(|a, b| off(a).total_cmp(&off(b)))
        };
        let dot = |i: usize| (f64::from(thickness[i]), f64::from(intensity[i]));
        let dots = (1..24_u8).filter_map(|i| near(0.5 * f32::from(i))).map(dot).collect();
        all.push(Function { name: format!("{half}, {exponent}"), line, dots });
    }
    let axes = ["thickness", "intensity"];
    let title = ("Intensity", SeriesLabelPosition::LowerRight);
    functions(title, axes, [12.0, 1.0], &all, &pictures(docs, "whitewater-intensity.svg"))
}

/// Figure 7: the effect of the parameters.
pub fn looks(tool: &Tool, docs: &Path) -> Outcome<()> {
    let looks = [
        "",
        "half_intensity_thickness = 1.0",
        "half_intensity_thickness = 5.0",
        "shadow_scale = 0.1",
        "shadow_scale = 2.0",
        "shadow_color = [0.6, 0.3, 0.0]",
    ];
    let panels: Result<Vec<_>, String> =
        looks.iter().map(|look| tool.sea("wave", "820k", "480x360", look)).collect();
    grid(&panels?, 3, &pictures(docs, "whitewater-look.jpg"))
}
