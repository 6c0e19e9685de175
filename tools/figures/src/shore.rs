//! The figures of shoreline and contact foam (*Semi-procedural foam shader*; D. Lettier, *3D Game Shaders For Beginners*).

use std::path::Path;

use crate::Outcome;
use crate::figures::pictures;
use crate::panels::{grid, share};
use crate::tool::Tool;

/// A beach on the main island.
const BEACH: &str = "--eye 8,9,52 --target 18,0,18 --fov 45";

/// The blog's first waves, without noise or web.
const PLAIN: &str = "texture_weight = 0.0\nwave_weight = 1.0\nfrequency_noise = [0.0, 0.0]\nspeed_noise = [0.0, 0.0]\n\
     threshold_noise = [0.0, 0.0]\nrise_noise = [0.0, 0.0]\nswing = 0.0\nspeed = 0.9\nfrequency = 19.0\nfade = 0.02\n";

fn look(tool: &Tool, look: &str) -> Outcome<String> {
    tool.settings(&format!("[contact]\nopacity = 0.0\n[shoreline]\n{look}"))
}

/// The blog's steps: waves; waves that thin out to sea; noise on the frequency; the web, by two thresholds; the mix.
pub fn steps(tool: &Tool, docs: &Path) -> Outcome<()> {
    let web = "wave_weight = 0.0\ntexture_weight = 1.0\nthreshold_noise = [0.0, 0.0]\nrise_noise = [0.0, 0.0]\nfade = 0.02\n\
               texture_slope = 0.9\ntexture_offset = -0.9\n";
    let looks = [
        format!("{PLAIN}floor = 0.0\nwave_slope = 0.0\nwave_offset = 0.0\nthreshold = 0.4\n"),
        format!("{PLAIN}wave_slope = 1.0\nwave_offset = 0.0\nthreshold = 1.25\n"),
        format!("{PLAIN}wave_slope = 1.0\nwave_offset = 0.0\nthreshold = 1.25\n")
            .replace("frequency_noise = [0.0, 0.0]", "frequency_noise = [9.0, 0.02]"),
        format!("{web}threshold = 0.85\n"),
        format!("{web}threshold = 0.5\n"),
        String::new(),
    ];
    let panel = |own: &String| -> Outcome<_> {
        let settings = look(tool, own)?;
        Ok(tool.shore("archipelago", 40, &format!("{BEACH} {settings}"))?.picture)
    };
    let panels: Result<Vec<_>, String> = looks.iter().map(panel).collect();
    grid(&panels?, 3, &pictures(docs, "shore-steps.jpg"))
}

/// The three ways to find the shore: by the map, by a strip, by screen-space depth.
pub fn ways(tool: &Tool, docs: &Path) -> Outcome<()> {
    let panel = |by: &&str| -> Outcome<_> {
        let settings = tool.settings(&format!("[shore]\nby = \"{by}\"\n"))?;
        share(&tool.shore("archipelago", 40, &settings)?.layers, "shore.amount")
    };
    let panels: Result<Vec<_>, String> = ["map", "strip", "screen"].iter().map(panel).collect();
    grid(&panels?, 3, &pictures(docs, "shore-ways.png"))
}

/// Four moments of the loop, in which one island drifts.
pub fn islands(tool: &Tool, docs: &Path) -> Outcome<()> {
    let panel = |frame: &u32| Ok(tool.shore("archipelago", *frame, "")?.picture);
    let panels: Outcome<Vec<_>> = [1, 61, 121, 181].iter().map(panel).collect();
    grid(&panels?, 2, &pictures(docs, "shore-islands.jpg"))
}

/// Contact foam in a pool, in lava and on particle water, and a pool without it.
pub fn contact(tool: &Tool, docs: &Path) -> Outcome<()> {
    let none = tool.settings("[contact]\nopacity = 0.0\n")?;
    let without = tool.shore("pool", 1, &none)?.picture;
    let pool = tool.shore("pool", 1, "")?.picture;
    let lava = tool.shore("lava", 1, "")?.picture;
    let on = tool.settings(
        "[contact]\nparticle_opacity = 1.0\nparticle_depth = 0.3\nmask_scale = 2.0\nmask = 0.6\n",
    )?;
    let water = tool.frame("waterfall", 200, &format!("{on} --surface-foam none"))?.picture;
    grid(&[without, pool, lava, water], 2, &pictures(docs, "contact.jpg"))
}
