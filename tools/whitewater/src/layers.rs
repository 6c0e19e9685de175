//! Converts the renderer's images to named channels.

use whitewater::headless::{Background, Headless, Picture};
use whitewater::io::picture::{EMPTY, Layers, normals};
use whitewater::water::DebugView;
use whitewater::{Camera, Settings};

use crate::camera::Lens;
use crate::failure::{Failure, Outcome};
use crate::fluids::Liquids;

/// Names that `--layers` accepts.
const GROUPS: [&str; 30] = [
    "water.depth",
    "water.surface",
    "water.iterations",
    "water.normal",
    "water.back",
    "water.thickness",
    "water.thickness.front",
    "water.thickness.back",
    "water.sheet.front",
    "water.sheet.back",
    "surface_foam",
    "surface_foam.thickness",
    "surface_foam.front",
    "water.spray",
    "water.noise",
    "whitewater",
    "whitewater.thickness",
    "whitewater.submerged",
    "whitewater.intensity",
    "whitewater.radius",
    "whitewater.normal",
    "whitewater.shadow",
    "whitewater.irradiance",
    "bubbles",
    "bubbles.layers",
    "shore.amount",
    "contact.amount",
    "scene",
    MOTION,
    DEBUG_VIEW,
];

/// Layer of motion vectors in pixels: each leads from where the content of a pixel was in the previous frame to the
/// pixel.
pub const MOTION: &str = "motion";

/// Debug views: unfinished composites, in each of which a further part of the picture is drawn; three channels each.
pub const DEBUG_VIEW: &str = "debug_view";

const VIEWS: [(&str, DebugView); 4] = [
    ("background", DebugView::Background),
    ("back_water", DebugView::BackWater),
    ("surface_foam", DebugView::SurfaceFoam),
    ("front_water", DebugView::FrontWater),
];

/// The new name of a renamed layer.
fn renamed(name: &str) -> Option<String> {
    let of = |old: &str, new: &str| name.strip_prefix(old).map(|rest| format!("{new}{rest}"));
    of("water.foam", "surface_foam")
        .or_else(|| of("foam", "whitewater"))
        .or_else(|| of("ladder", DEBUG_VIEW))
}

/// Parses `--layers`. `all` does not include the debug views, because the frame has to be drawn again for each.
pub fn wanted(text: &str) -> Outcome<Vec<&'static str>> {
    match text {
        "all" => return Ok(GROUPS.into_iter().filter(|name| *name != DEBUG_VIEW).collect()),
        "none" => return Ok(Vec::new()),
        _ => {}
    }
    text.split(',')
        .map(|name| {
            let name = name.trim();
            // `water.depth.Z` and `water.depth` mean the same.
            GROUPS
                .into_iter()
                .find(|g| *g == name || name.strip_prefix(g).is_some_and(|rest| rest.len() == 2))
                .ok_or_else(|| {
                    if let Some(new) = renamed(name) {
                        return Failure::usage(format!(
                            "--layers: {name} was renamed: use {new}"
                        ));
                    }
                    Failure::usage(format!(
                        "--layers: expected all, none or names of {}, found '{name}'; mend the name",
                        GROUPS.join(", ")
                    ))
                })
        })
        .collect()
}

/// How the samples of a pixel become one value.
#[derive(Clone, Copy)]
enum Merge {
    Mean,
    /// For depths: the nearest.
    Nearest,
    Most,
}

impl Merge {
    fn of(self, samples: impl Iterator<Item = f32>, count: usize) -> f32 {
        match self {
            Self::Mean => samples.sum::<f32>() / count as f32,
            Self::Nearest => samples.fold(EMPTY, f32::min),
            Self::Most => samples.fold(0.0, f32::max),
        }
    }
}

/// Downsamples a picture to `width`: each square of its pixels becomes one. The picture's width has to be a whole
/// multiple of `width`; a picture that is narrower than twice `width` stays as it is.
fn merged(picture: &Picture<f32>, width: usize, merge: Merge) -> Picture<f32> {
    let n = (picture.width / width).max(1);
    let row = |y: usize, x: usize| &picture.data[y * picture.width + x * n..][..n];
    let pixel = |x: usize, y: usize| {
        merge.of((y * n..(y + 1) * n).flat_map(|y| row(y, x).iter().copied()), n * n)
    };
    let (width, height) = (picture.width / n, picture.height / n);
    let data = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    Picture { width, height, data: data.map(|(x, y)| pixel(x, y)).collect() }
}

/// For each square of pixels that [`merged`] combines, the index of the pixel with the least depth; of the first one
/// if several are equal.
fn nearest(depths: &Picture<f32>, width: usize) -> Picture<usize> {
    let n = (depths.width / width).max(1);
    let (width, height) = (depths.width / n, depths.height / n);
    let pixel = |x: usize, y: usize| {
        let all = (0..n * n).map(|i| (y * n + i / n) * depths.width + x * n + i % n);
        all.min_by(|a, b| depths.data[*a].total_cmp(&depths.data[*b])).unwrap_or(0)
    };
    let data = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    Picture { width, height, data: data.map(|(x, y)| pixel(x, y)).collect() }
}

/// Reads the picture (R, G, B, A) and the wanted layers back from the device. `size` is the size of the output; the
/// frame was drawn at 1, 2 or 4 times this size, and its pixels are merged to it.
pub fn collect(
    headless: &mut Headless,
    size: (u32, u32),
    wanted: &[&str],
    lens: &Lens,
) -> Outcome<Layers> {
    let (width, height) = (size.0 as usize, size.1 as usize);
    let mut layers = Layers::new(width, height);
    let mut push = |name: &str, picture: &Picture<f32>, merge| -> Outcome<()> {
        let picture = merged(picture, width, merge);
        Ok(layers.push(name, picture.width, picture.height, picture.data)?)
    };
    let color = headless.color()?;
    for (c, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        push(name, &color.map(|v| v[c]), Merge::Mean)?;
    }
    let depth = |picture: Picture<f32>| picture.map(|z| if *z < EMPTY { *z } else { EMPTY });
    for name in ["water.depth", "water.back", "surface_foam", "whitewater", "bubbles"] {
        if wanted.contains(&name)
            && let Some(picture) = headless.layer(name)?
        {
            push(&format!("{name}.Z"), &depth(picture), Merge::Nearest)?;
        }
    }
    for (name, merge) in [
        ("water.iterations", Merge::Most),
        ("water.thickness", Merge::Mean),
        ("water.thickness.front", Merge::Mean),
        ("water.thickness.back", Merge::Mean),
        ("water.sheet.front", Merge::Mean),
        ("water.sheet.back", Merge::Mean),
        ("surface_foam.thickness", Merge::Mean),
        ("surface_foam.front", Merge::Mean),
        ("water.spray", Merge::Mean),
        ("water.noise", Merge::Mean),
        ("whitewater.thickness", Merge::Mean),
        ("whitewater.submerged", Merge::Mean),
        ("whitewater.intensity", Merge::Mean),
        ("whitewater.radius", Merge::Most),
        ("whitewater.shadow", Merge::Mean),
        ("bubbles.layers", Merge::Most),
        ("shore.amount", Merge::Mean),
        ("contact.amount", Merge::Mean),
    ] {
        if wanted.contains(&name)
            && let Some(picture) = headless.layer(name)?
        {
            push(name, &picture, merge)?;
        }
    }
    for (name, axes) in
        [("whitewater.normal", ["X", "Y", "Z"]), ("whitewater.irradiance", ["R", "G", "B"])]
    {
        for name in
            axes.map(|axis| format!("{name}.{axis}")).iter().filter(|_| wanted.contains(&name))
        {
            if let Some(picture) = headless.layer(name)? {
                push(name, &picture, Merge::Mean)?;
            }
        }
    }
    let (surface, normal) = (wanted.contains(&"water.surface"), wanted.contains(&"water.normal"));
    if (surface || normal)
        && let Some(picture) = headless.layer("water.surface")?
    {
        let picture = merged(&depth(picture), width, Merge::Nearest);
        if normal {
            // A texel of a surface at reduced resolution covers a square of pixels whose edge is a power of two.
            let texel = width.div_ceil(picture.width).next_power_of_two() as f32;
            let slope = lens.slope(size, texel);
            let xyz = normals(&picture.data, picture.width, picture.height, slope);
            for (axis, data) in ["X", "Y", "Z"].into_iter().zip(xyz) {
                let (width, height) = (picture.width, picture.height);
                push(
                    &format!("water.normal.{axis}"),
                    &Picture { width, height, data },
                    Merge::Mean,
                )?;
            }
        }
        if surface {
            push("water.surface.Z", &picture, Merge::Nearest)?;
        }
    }
    if wanted.contains(&"scene") {
        let depth = headless.scene_depth()?.map(|z| lens.eye_depth(*z));
        push("scene.Z", &depth, Merge::Nearest)?;
    }
    if wanted.contains(&MOTION)
        && let (Some(x), Some(y)) = (headless.layer("motion.X")?, headless.layer("motion.Y")?)
    {
        // Motion vectors are not averaged: across an outline the mean would be the motion of no object. The sample
        // with the least depth counts.
        let mut depths = headless.scene_depth()?.map(|z| lens.eye_depth(*z));
        for name in ["water.depth", "surface_foam"] {
            if let Some(layer) = headless.layer(name)? {
                // A texel of a layer at reduced resolution covers a square of pixels whose edge is a power of two.
                let texel = depths.width.div_ceil(layer.width).next_power_of_two();
                for (i, z) in depths.data.iter_mut().enumerate() {
                    let (x, y) = (i % depths.width / texel, i / depths.width / texel);
                    *z = z.min(layer.data[y * layer.width + x]);
                }
            }
        }
        let samples = nearest(&depths, width);
        // Converts to pixels of the output.
        let scale = samples.width as f32 / x.width as f32;
        for (name, picture) in [("motion.X", x), ("motion.Y", y)] {
            let picture = samples.map(|i| picture.data[*i] * scale);
            push(name, &picture, Merge::Mean)?;
        }
    }
    Ok(layers)
}

/// Draws the frame again for each debug view, and adds the pictures as layers.
pub fn debug_views(
    headless: &mut Headless,
    camera: &Camera,
    settings: &Settings,
    layers: &mut Layers,
) -> Outcome<()> {
    for (name, view) in VIEWS {
        headless.render(
            camera,
            &settings.clone().with(|it| it.debug_view = view),
            &Background::Scene,
        )?;
        let color = headless.color()?;
        for (c, axis) in ["R", "G", "B"].into_iter().enumerate() {
            let picture = merged(&color.map(|v| v[c]), layers.width, Merge::Mean);
            let name = format!("{DEBUG_VIEW}.{name}.{axis}");
            layers.push(&name, picture.width, picture.height, picture.data)?;
        }
    }
    Ok(())
}

/// Replaces the beauty by another picture.
pub fn show(layers: &mut Layers, picture: &Picture<[f32; 4]>) {
    for (c, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        let merged = merged(&picture.map(|v| v[c]), layers.width, Merge::Mean);
        let channel = layers.channels.iter_mut().find(|channel| channel.name == name);
        channel.into_iter().for_each(|channel| channel.data.clone_from(&merged.data));
    }
}

/// Computes alpha from two backgrounds (Smith and Blinn 1996): the frame was drawn over black and is drawn again over
/// white. The difference is the transmittance, and channel A is 1 minus its mean over red, green and blue, which
/// water transmits differently.
pub fn matte(
    headless: &mut Headless,
    camera: &Camera,
    liquids: &Liquids<'_>,
    layers: &mut Layers,
) -> Outcome<()> {
    let color = match liquids.draw(headless, camera, &Background::Color([1.0; 3]))? {
        Some(picture) => picture,
        None => headless.color()?,
    };
    let white = [0, 1, 2].map(|c| merged(&color.map(|v| v[c]), layers.width, Merge::Mean).data);
    let Some(black) = layers.rgb() else { return Ok(()) };
    if let Some(alpha) = layers.channels.iter_mut().find(|channel| channel.name == "A") {
        alpha.data = hidden(&black, &white);
    }
    Ok(())
}

/// Opacity of each pixel, from its colours over black and over white.
fn hidden(black: &[[f32; 3]], white: &[Vec<f32>; 3]) -> Vec<f32> {
    let through = |i: usize| (0..3).map(|c| white[c][i] - black[i][c]).sum::<f32>() / 3.0;
    (0..black.len()).map(|i| (1.0 - through(i)).clamp(0.0, 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_become_pixels() {
        let picture =
            Picture { width: 4, height: 2, data: vec![1.0, 2.0, EMPTY, 4.0, 3.0, 6.0, 7.0, 8.0] };
        let of = |merge| merged(&picture, 2, merge).data;
        assert_eq!(of(Merge::Nearest), [1.0, 4.0]);
        assert_eq!(of(Merge::Most), [6.0, EMPTY]);
        assert_eq!(of(Merge::Mean)[0], 3.0);
        // A smaller picture stays as it is.
        assert_eq!(merged(&picture, 4, Merge::Mean), picture);
        assert_eq!(merged(&picture, 9, Merge::Mean), picture);
    }

    /// Clear, black, and blue water that lets 0.1 of red, 0.5 of green and 0.9 of blue through.
    #[test]
    fn opacity_is_the_mean_of_what_is_hidden() {
        let black = [[0.0; 3], [0.0; 3], [0.1, 0.2, 0.05]];
        let white = [vec![1.0, 0.0, 0.2], vec![1.0, 0.0, 0.7], vec![1.0, 0.0, 0.95]];
        let found = hidden(&black, &white);
        assert!(found[0] == 0.0 && found[1] == 1.0 && (found[2] - 0.5).abs() < 1.0e-6, "{found:?}");
    }

    #[test]
    fn the_nearest_sample_is_found() {
        let data = vec![1.0, 2.0, EMPTY, 4.0, 3.0, 0.5, 7.0, 4.0];
        let picture = Picture { width: 4, height: 2, data };
        assert_eq!(nearest(&picture, 2).data, [5, 3]);
        assert_eq!(nearest(&picture, 4).data, [0, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn layer_names_are_understood() {
        let all = wanted("all").unwrap();
        assert!(all.len() == GROUPS.len() - 1 && !all.contains(&DEBUG_VIEW));
        assert_eq!(wanted("debug_view").unwrap(), [DEBUG_VIEW]);
        let old = wanted("ladder").unwrap_err().message;
        assert!(old.contains("ladder was renamed: use debug_view"), "{old}");
        assert_eq!(wanted("water.depth.Z, scene").unwrap(), ["water.depth", "scene"]);
        assert_eq!(wanted("motion").unwrap(), [MOTION]);
        assert!(wanted("water").is_err() && wanted("").is_err());
        assert!(wanted("none").unwrap().is_empty());
        for (old, new) in [
            ("water.foam.thickness", "surface_foam.thickness"),
            ("foam.normal.X", "whitewater.normal.X"),
        ] {
            let message = wanted(old).unwrap_err().message;
            assert!(message.contains(&format!("use {new}")), "{message}");
        }
    }
}
