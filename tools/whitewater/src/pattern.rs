//! `whitewater pattern`: textures of shoreline foam, from a picture or a seed.

use std::path::{Path, PathBuf};

use whitewater::io::picture::{self, Encoding, Layers};
use whitewater::shore::texture;

use crate::args::PatternArgs;
use crate::failure::{Failure, Outcome};
use crate::out;
use crate::output::{self, PictureFormat, Target};
use crate::written;

/// Default luminance from which a pixel is white.
const THRESHOLD: f32 = 0.5;
/// Default side length in texels.
const SIZE: u32 = 512;

/// Source of a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A picture.
    File(PathBuf),
    /// The built-in web with this seed.
    Web(u32),
    /// The noise with this seed.
    Noise(u32),
}

/// Parses a source from the command line.
pub fn named(text: &str) -> Result<Source, String> {
    let seed = |name: &str, seed: &str| {
        let bad = |_| format!("{name}: expected a seed from 0 to {}, as in {name}:1", u32::MAX);
        seed.parse().map_err(bad)
    };
    match text.split_once(':') {
        Some(("web", number)) => seed("web", number).map(Source::Web),
        Some(("noise", number)) => seed("noise", number).map(Source::Noise),
        _ if text.is_empty() => Err("expected a picture, web:SEED or noise:SEED".into()),
        _ => Ok(Source::File(text.into())),
    }
}

pub fn run(args: &PatternArgs) -> Outcome<()> {
    let format = Target::new(&args.output, false)?.format;
    let of_pictures = args.reach.is_some() || args.invert || args.threshold.is_some();
    if let Source::File(path) = &args.input {
        written::check([("--output", args.output.clone())], [path.as_path()])?;
    }
    match &args.input {
        Source::File(_) if args.size.is_some() => {
            return Err(Failure::usage(
                "--size is for web:SEED and noise:SEED; a picture has its own",
            ));
        }
        Source::Web(_) | Source::Noise(_) if of_pictures => {
            return Err(Failure::usage(
                "--reach, --invert and --threshold are for pictures; web:SEED and noise:SEED take --size",
            ));
        }
        _ => {}
    }
    output::probe(&args.output)?;
    let size = args.size.unwrap_or(SIZE);
    let layers = match &args.input {
        Source::File(path) => of_picture(path, args)?,
        Source::Web(seed) => {
            let mut layers = Layers::new(size as usize, size as usize);
            layers.push("Y", layers.width, layers.height, texture::web(size, *seed))?;
            layers
        }
        Source::Noise(seed) => of_noise(size, *seed, format)?,
    };
    output::write(&args.output, |to| match format {
        PictureFormat::Exr => picture::write_exr(&layers, to),
        PictureFormat::Png => picture::write_png_values(&layers, to),
    })
}

fn of_noise(size: u32, seed: u32, format: PictureFormat) -> Outcome<Layers> {
    let noise = texture::noise(size, seed);
    let mut layers = Layers::new(size as usize, size as usize);
    for (c, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        let value = |v: f32| match format {
            PictureFormat::Exr => v,
            PictureFormat::Png => 0.5 + 0.5 * v,
        };
        let data = noise.iter().map(|texel| value(texel[c])).collect();
        layers.push(name, layers.width, layers.height, data)?;
    }
    Ok(layers)
}

fn of_picture(path: &Path, args: &PatternArgs) -> Outcome<Layers> {
    let picture = picture::read(path)?;
    let (width, height) = (picture.width, picture.height);
    let threshold = args.threshold.unwrap_or(THRESHOLD);
    // Transparent pixels and NaN count as background, not as lines.
    let ground = if args.invert { threshold.max(1.0) } else { 0.0 };
    let light = over(&picture, ground);
    let line = |v: &f32| if args.invert { *v < threshold } else { *v >= threshold };
    let pattern: Vec<bool> = light.iter().map(line).collect();
    let lines = pattern.iter().filter(|line| **line).count();
    if lines == 0 || lines == pattern.len() {
        let least = light.iter().copied().fold(f32::INFINITY, f32::min);
        let most = light.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let (what, other) = if args.invert { ("black", "without") } else { ("white", "with") };
        let found = if lines == 0 { "nothing" } else { "all of it" };
        return Err(Failure::input(format!(
            "{}: expected {what} lines, found {found} {what} (luminance {least} to {most}, told apart at {threshold}); \
             give another --threshold, or do it {other} --invert",
            path.display()
        )));
    }
    let distances = texture::distance_transform(&pattern, width, height);
    let farthest = distances.iter().copied().fold(0.0, f32::max);
    let reach = args.reach.unwrap_or(farthest);
    let mut layers = Layers::new(width, height);
    layers.push("Y", width, height, texture::from_pattern(&pattern, width, height, reach))?;
    let share = 100.0 * lines as f64 / pattern.len() as f64;
    out::print(format_args!(
        "{width}x{height} texels, {share:.1} % of them lines; the farthest is {farthest:.2} texels from one; 0 from \
         {reach:.2} on\n"
    ))?;
    Ok(layers)
}

/// Reads a texture from a user's picture. Returns the picture's size in pixels, and the luminance of each pixel,
/// computed from the stored values (not linearized); 0 where the picture is transparent.
pub fn values(path: &Path) -> Outcome<([u32; 2], Vec<f32>)> {
    let picture = picture::read(path)?;
    let size = [picture.width as u32, picture.height as u32];
    Ok((size, over(&picture, 0.0)))
}

/// Luminance of the unchanged values, composited over `ground`.
fn over(picture: &Layers, ground: f32) -> Vec<f32> {
    let light = luminance(picture);
    let Some(alpha) = picture.channel("A") else { return light };
    // Colours in EXR files are premultiplied by alpha.
    let straight = picture.encoding == Encoding::Srgb;
    let one = |(v, a): (f32, &f32)| if straight { v * a } else { v } + (1.0 - a) * ground;
    light.into_iter().zip(alpha).map(one).collect()
}

/// Luminance from the channels that the picture has: red, green and blue, otherwise `Y`, otherwise the mean of all
/// channels except alpha.
fn luminance(picture: &Layers) -> Vec<f32> {
    let color = |name: &str| match name {
        "R" => 0.2126,
        "G" => 0.7152,
        "B" => 0.0722,
        _ => 0.0,
    };
    let grey = |name: &str| f32::from(name == "Y");
    let any = |name: &str| f32::from(name != "A");
    let of = |name: &str, kind: usize| [color(name), grey(name), any(name)][kind];
    let names = || picture.channels.iter().map(|channel| channel.name.as_str());
    let kind = (0..3).find(|kind| names().any(|name| of(name, *kind) > 0.0)).unwrap_or(0);
    let all: f32 = names().map(|name| of(name, kind)).sum();
    let mut light = vec![0.0; picture.width * picture.height];
    for channel in &picture.channels {
        let weight = of(&channel.name, kind) / all;
        // Channels with weight 0 may hold NaN.
        if weight > 0.0 {
            light.iter_mut().zip(&channel.data).for_each(|(light, v)| *light += weight * v);
        }
    }
    light
}
