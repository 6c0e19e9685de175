//! From the renderer's images to named channels.

use glam::Vec3;
use whitewater::headless::{Headless, Picture};
use whitewater::io::picture::{EMPTY, Layers, normals};

use crate::camera::Lens;
use crate::failure::{Failure, Outcome};

/// What can be asked for beside the beauty.
const GROUPS: [&str; 9] = [
    "water.depth",
    "water.surface",
    "water.iterations",
    "water.normal",
    "water.back",
    "water.thickness",
    "water.thickness.front",
    "water.thickness.back",
    "scene",
];

/// Understands `--layers`.
pub fn wanted(text: &str) -> Outcome<Vec<&'static str>> {
    match text {
        "all" => return Ok(GROUPS.to_vec()),
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
                    Failure::usage(format!(
                        "--layers: expected all, none or names of {}, found '{name}'; mend the name",
                        GROUPS.join(", ")
                    ))
                })
        })
        .collect()
}

/// Reads the beauty and the layers that are wanted back from the device.
pub fn collect(headless: &mut Headless, wanted: &[&str], lens: &Lens) -> Outcome<Layers> {
    let color = headless.color()?;
    let size = (color.width as u32, color.height as u32);
    let mut layers = Layers::new(color.width, color.height);
    for (c, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        push(&mut layers, name, &color.map(|v| v[c]))?;
    }
    let depth = |picture: Picture<f32>| picture.map(|z| if *z < EMPTY { *z } else { EMPTY });
    for name in ["water.depth", "water.back"] {
        if wanted.contains(&name)
            && let Some(picture) = headless.layer(name)?
        {
            push(&mut layers, &format!("{name}.Z"), &depth(picture))?;
        }
    }
    for name in
        ["water.iterations", "water.thickness", "water.thickness.front", "water.thickness.back"]
    {
        if wanted.contains(&name)
            && let Some(picture) = headless.layer(name)?
        {
            push(&mut layers, name, &picture)?;
        }
    }
    let (surface, normal) = (wanted.contains(&"water.surface"), wanted.contains(&"water.normal"));
    if (surface || normal)
        && let Some(picture) = headless.layer("water.surface")?
    {
        let picture = depth(picture);
        if normal {
            // Texels of a reduced surface are a power of two pixels wide.
            let texel = (size.0 as usize).div_ceil(picture.width).next_power_of_two() as f32;
            let slope = lens.slope(size, texel);
            let xyz = normals(&picture.data, picture.width, picture.height, slope);
            for (axis, data) in ["X", "Y", "Z"].into_iter().zip(xyz) {
                let name = format!("water.normal.{axis}");
                layers.push(&name, picture.width, picture.height, data)?;
            }
        }
        if surface {
            push(&mut layers, "water.surface.Z", &picture)?;
        }
    }
    if wanted.contains(&"scene") {
        push(&mut layers, "scene.Z", &headless.scene_depth()?.map(|z| lens.eye_depth(*z)))?;
    }
    Ok(layers)
}

fn push(layers: &mut Layers, name: &str, picture: &Picture<f32>) -> Outcome<()> {
    Ok(layers.push(name, picture.width, picture.height, picture.data.clone())?)
}

/// Particles of a z-up world, turned to y up.
pub fn turn_up(positions: &mut [[f32; 3]]) {
    for p in positions {
        let [x, y, z] = *p;
        *p = Vec3::new(x, z, -y).to_array();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layer_names_are_understood() {
        assert_eq!(wanted("all").unwrap().len(), GROUPS.len());
        assert_eq!(wanted("water.depth.Z, scene").unwrap(), ["water.depth", "scene"]);
        assert!(wanted("water").is_err() && wanted("").is_err());
        assert!(wanted("none").unwrap().is_empty());
    }
}
