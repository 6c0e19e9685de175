//! The figures of screen-space foam, each by its number in the paper (Akinci et al. 2013).

use std::path::Path;

use crate::Outcome;
use crate::figures::pictures;
use crate::panels::{amount, depth, grid, light, normals, share};
use crate::tool::Tool;

/// Figures 1 and 8, upper row: the seas, each with as many particles as the source's.
pub fn seas(tool: &Tool, docs: &Path) -> Outcome<()> {
    let seas = [("wave", "820k"), ("ship", "9m"), ("lighthouse", "15m"), ("flood", "29m")];
    let panels: Result<Vec<_>, String> =
        seas.iter().map(|(sea, count)| tool.sea(sea, count, "640x480", "")).collect();
    grid(&panels?, 2, &pictures(docs, "seas.png"))
}

/// Figure 3: what each pass leaves.
pub fn layers(tool: &Tool, docs: &Path) -> Outcome<()> {
    let (sea, count, size) = ("wave", "820k", "480x360");
    let layers = &tool.sea_layers(sea, count, size)?;
    let panels = [
        depth(layers, "foam.Z")?,
        normals(layers, "foam.normal", "foam.Z")?,
        amount(layers, "foam.thickness", 6.0)?,
        share(layers, "foam.intensity")?,
        share(layers, "foam.shadow")?,
        light(layers, "foam.irradiance", 6.0)?,
        tool.sea(sea, count, size, "passes = 0")?,
        tool.sea(sea, count, size, "")?,
    ];
    grid(&panels, 2, &pictures(docs, "diffuse-layers.png"))
}

/// Figure 7: what the parameters do.
pub fn looks(tool: &Tool, docs: &Path) -> Outcome<()> {
    let looks = [
        "",
        "half = 0.5",
        "half = 20.0",
        "shadow = [1.0, 3.0, -0.05]",
        "shadow = [3.0, 1.0, 0.0]",
        "shadow_color = [0.6, 0.3, 0.0]",
    ];
    let panels: Result<Vec<_>, String> =
        looks.iter().map(|look| tool.sea("wave", "820k", "480x360", look)).collect();
    grid(&panels?, 3, &pictures(docs, "diffuse-look.png"))
}
