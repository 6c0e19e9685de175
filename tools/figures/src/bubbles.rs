//! The figures of bubble foam, with their numbers in the paper (Huszár, Szécsi).

use std::path::Path;

use plotters::prelude::SeriesLabelPosition;
use whitewater::io::picture::EMPTY;

use crate::Outcome;
use crate::curves::{Function, functions};
use crate::figures::pictures;
use crate::panels::{channel, depth, grid};
use crate::tool::Tool;

/// The upper half of a blob at close range, with sky behind its films.
const FILMS: &str = "--eye 0.2,1.9,2.3 --target 0.05,1.45,0";

/// Whitewater foam at close range: sprites, and the blobs that replace them.
pub fn near(tool: &Tool, docs: &Path) -> Outcome<()> {
    let kept = tool.temporary("kept_%04d.bgeo");
    let kept = kept.display();
    let frame = 240;
    tool.frame("waterfall", frame, &format!("--whitewater generate --write-whitewater {kept}"))?;
    let look = tool.settings("[bubbles]\ncrossfade = [0.5, 1.0]\n")?;
    let view = "--eye 1.1,0.6,0.75 --target 1.0,0.22,0.2 --fov 45";
    let panels = ["", &look].map(|look| {
        let more = format!("--whitewater {kept} {view} {look} --surface-foam none --spray none");
        tool.frame("waterfall", frame, &more).map(|frame| frame.picture)
    });
    let [sprites, blobs] = panels;
    grid(&[sprites?, blobs?], 2, &pictures(docs, "foam-near.jpg"))
}

/// Figure 6: a single blob, in full and at close range.
pub fn one(tool: &Tool, docs: &Path) -> Outcome<()> {
    let near = "--eye 0.3,1.3,1.6 --target 0,1.1,0";
    let panels = [tool.bubbles("one", 1, "")?, tool.bubbles("one", 1, near)?];
    grid(&panels.map(|frame| frame.picture), 2, &pictures(docs, "bubble-one.jpg"))
}

/// Films: thin and thick, with the full spectrum and with three wavelengths, and with the source's reflectance.
pub fn films(tool: &Tool, docs: &Path) -> Outcome<()> {
    let looks = [
        "film = 120.0\ncore_opaque_radius = 0.4\ncore_outer_radius = 0.7",
        "core_opaque_radius = 0.4\ncore_outer_radius = 0.7",
        "film = 900.0\ncore_opaque_radius = 0.4\ncore_outer_radius = 0.7",
        "drainage = 0.0\nvariation = 0.0\ncore_opaque_radius = 0.4\ncore_outer_radius = 0.7",
        "spectrum = \"three\"\ncore_opaque_radius = 0.4\ncore_outer_radius = 0.7",
        "spectrum = \"three\"\nfresnel = \"source\"\ncore_opaque_radius = 0.4\ncore_outer_radius = 0.7",
    ];
    let panel = |look: &&str| -> Outcome<_> {
        let settings = tool.settings(&format!("[bubbles]\n{look}\n"))?;
        Ok(tool.bubbles("one", 1, &format!("{FILMS} {settings}"))?.picture)
    };
    let panels: Result<Vec<_>, String> = looks.iter().map(panel).collect();
    grid(&panels?, 3, &pictures(docs, "bubble-films.jpg"))
}

/// Accuracy of an impostor by map size and steps: the share of a blob's pixels whose depth is off by more than a
/// hundredth of its radius. The reference is the finest impostor by bubble ids, which a test shows equal to drawing all
/// bubbles.
pub fn errors(tool: &Tool, docs: &Path) -> Outcome<()> {
    let depths = |look: &str| -> Outcome<Vec<f32>> {
        let settings = tool.settings(&format!("[bubbles]\n{look}\n"))?;
        Ok(channel(&tool.bubbles("one", 1, &settings)?.layers, "bubbles.Z")?.to_vec())
    };
    let exact = depths("map_size = 512\nsteps = 64")?;
    let there = |z: f32| z < EMPTY;
    let off = |look: &str| -> Outcome<f64> {
        let (mut bad, mut all) = (0, 0);
        for (a, b) in depths(look)?.iter().zip(&exact) {
            let either = there(*a) || there(*b);
            all += u32::from(either);
            bad += u32::from(either && (there(*a) != there(*b) || (a - b).abs() > 0.01));
        }
        Ok(100.0 * f64::from(bad) / f64::from(all.max(1)))
    };
    let kinds = [
        ("ids", "By bubble ids", [1, 2, 3, 4, 6, 8, 10, 13, 16]),
        ("distance", "By distances", [8, 10, 12, 14, 16, 18, 20, 22, 24]),
    ];
    for (impostor, title, steps) in kinds {
        let mut all = Vec::new();
        for map in [32, 64, 128] {
            let at = |n: &u32| -> Outcome<(f64, f64)> {
                let look = format!("impostor = \"{impostor}\"\nmap_size = {map}\nsteps = {n}");
                Ok((f64::from(*n), off(&look)?))
            };
            let line: Vec<_> = steps.iter().map(at).collect::<Outcome<_>>()?;
            let last = line.last().map_or(0.0, |(_, y)| *y);
            all.push(Function {
                name: format!("{map}² texels, {last:.1} % at last"),
                dots: line.clone(),
                line,
            });
        }
        let most = all.iter().flat_map(|f| &f.line).map(|(_, y)| *y).fold(1.0, f64::max);
        let far = f64::from(steps[steps.len() - 1]);
        functions(
            (title, SeriesLabelPosition::UpperRight),
            ["steps", "% of the pixels"],
            [far, 1.1 * most],
            &all,
            &pictures(docs, &format!("bubble-error-{impostor}.svg")),
        )?;
    }
    Ok(())
}

/// Both impostors, and foam without inner walls.
pub fn impostors(tool: &Tool, docs: &Path) -> Outcome<()> {
    let looks = ["", "walls = false", "impostor = \"distance\""];
    let near = "--eye 0.3,1.3,1.6 --target 0,1.1,0";
    let panel = |look: &&str| -> Outcome<_> {
        let settings = tool.settings(&format!("[bubbles]\n{look}\n"))?;
        Ok(tool.bubbles("one", 1, &format!("{near} {settings}"))?.picture)
    };
    let panels: Result<Vec<_>, String> = looks.iter().map(panel).collect();
    grid(&panels?, 3, &pictures(docs, "bubble-impostors.jpg"))
}

/// Figure 7: dense foam, and its depth.
pub fn dense(tool: &Tool, docs: &Path) -> Outcome<()> {
    let near = "--eye 2.6,0.7,1.3 --target 1.2,0.12,0";
    let frame = tool.bubbles("slope:200", 150, near)?;
    let panels = [depth(&frame.layers, "bubbles.Z")?, frame.picture];
    grid(&panels, 2, &pictures(docs, "bubble-foam.jpg"))
}

/// Figure 8: foam that slides down a slope.
pub fn slope(tool: &Tool, docs: &Path) -> Outcome<()> {
    let panels: Result<Vec<_>, String> = [1, 45, 90, 240]
        .iter()
        .map(|number| Ok(tool.bubbles("slope", *number, "")?.picture))
        .collect();
    grid(&panels?, 2, &pictures(docs, "bubble-slope.jpg"))
}

/// Figure 9: a box of 5000 blobs, and one of a hundred.
pub fn boxes(tool: &Tool, docs: &Path) -> Outcome<()> {
    let panels = [tool.bubbles("box", 1, "")?, tool.bubbles("box:100", 1, "")?];
    grid(&panels.map(|frame| frame.picture), 2, &pictures(docs, "bubble-box.jpg"))
}
