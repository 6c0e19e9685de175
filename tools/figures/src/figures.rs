//! The figures of layered water, with their numbers in the thesis.

use std::path::{Path, PathBuf};

use serde_json::json;
use whitewater::io::picture::Layers;

use crate::Outcome;
use crate::bubbles;
use crate::curves::{self, Curve};
use crate::panels::{self, amount, depth, grid, iterations, normals, save};
use crate::shore;
use crate::tool::{SIZE, Timed, Tool, sequence};
use crate::whitewater_figures;

pub type Figure = fn(&Tool, &Path) -> Outcome<()>;

/// All figures by name.
pub const ALL: [(&str, Figure); 39] = [
    ("demo", demo),
    ("film", film),
    ("noise-foam", noise_foam),
    ("thesis", thesis),
    ("layers", layers),
    ("curvature", curvature),
    ("fixed-counts", fixed_counts),
    ("kernels", kernels),
    ("water-layers", water_layers),
    ("borders", borders),
    ("iterations", iteration_counts),
    ("thresholds", thresholds),
    ("shadows", shadows),
    ("bamboo", bamboo),
    ("foam", foam),
    ("pattern", pattern),
    ("sheets", sheets),
    ("zoom", zoom),
    ("flight-waterfall", |tool, docs| flight(tool, docs, "waterfall")),
    ("flight-corridor", |tool, docs| flight(tool, docs, "corridor")),
    ("flight-bamboo", |tool, docs| flight(tool, docs, "bamboo")),
    ("seas", whitewater_figures::seas),
    ("seas-ray-cast", whitewater_figures::ray_cast),
    ("whitewater-layers", whitewater_figures::layers),
    ("whitewater-shapes", whitewater_figures::shapes),
    ("whitewater-look", whitewater_figures::looks),
    ("whitewater-distances", whitewater_figures::distances),
    ("foam-near", bubbles::near),
    ("bubble-one", bubbles::one),
    ("bubble-films", bubbles::films),
    ("bubble-impostors", bubbles::impostors),
    ("bubble-error", bubbles::errors),
    ("bubble-foam", bubbles::dense),
    ("bubble-slope", bubbles::slope),
    ("bubble-box", bubbles::boxes),
    ("shore-steps", shore::steps),
    ("shore-ways", shore::ways),
    ("shore-islands", shore::islands),
    ("contact", shore::contact),
];

pub fn pictures(docs: &Path, name: &str) -> PathBuf {
    docs.join("pictures").join(name)
}

/// Radius at which the waterfall's particles are drawn: twice 0.656 of half their spacing of 0.04 m.
const RADIUS: f32 = 0.656 * 0.04;

/// The basin and the pillar of the waterfall at close range.
const NEAR: &str = "--eye 1.1,0.95,1.9 --target 0.1,0.3,0 --fov 40";

/// The README's picture, as `tools/demo` draws it.
fn demo(tool: &Tool, docs: &Path) -> Outcome<()> {
    save(&tool.demo()?, &pictures(docs, "waterfall.jpg"))
}

/// The README's animation: 24 frames of the waterfall, about a second.
fn film(tool: &Tool, docs: &Path) -> Outcome<()> {
    let view = "--eye 1.9,1.75,3.1 --target -0.3,0.48,0 --fov 34";
    tool.film("waterfall", [171, 240, 3], view, &pictures(docs, "waterfall.webp"))
}

/// Figure 1.1: the baseline's noise foam beside foam of particles.
fn noise_foam(tool: &Tool, docs: &Path) -> Outcome<()> {
    let noise = "--rule fixed:40 --surface-foam none --spray none --noise foam";
    let panels =
        [tool.frame("waterfall", 240, noise)?.picture, tool.frame("waterfall", 240, "")?.picture];
    grid(&panels, 2, &pictures(docs, "noise-foam.jpg"))
}

/// The thesis's whole look beside ours.
fn thesis(tool: &Tool, docs: &Path) -> Outcome<()> {
    let panels: Result<Vec<_>, _> = ["--look thesis", ""]
        .iter()
        .map(|more| {
            let picture = tool.frame("waterfall", 240, more)?.picture;
            // Crop most of the sky and the ground.
            Ok::<_, String>(image::imageops::crop_imm(&picture, 60, 10, 400, 225).to_image())
        })
        .collect();
    grid(&panels?, 2, &pictures(docs, "thesis.jpg"))
}

/// Figures 4.7 to 4.20: the result of each pass.
fn layers(tool: &Tool, docs: &Path) -> Outcome<()> {
    let frame = tool.frame("waterfall", 240, "")?;
    let without = tool.frame("waterfall", 240, "--spray none")?;
    let radius = RADIUS;
    let layers = &frame.layers;
    let panels = [
        depth(layers, "water.depth.Z")?,
        depth(layers, "surface_foam.Z")?,
        depth(layers, "water.surface.Z")?,
        normals(layers, "water.normal", "water.surface.Z")?,
        iterations(layers)?,
        amount(layers, "water.thickness", 6.0 * radius)?,
        amount(layers, "surface_foam.thickness", radius)?,
        amount(layers, "surface_foam.front", radius)?,
        amount(layers, "water.spray", 0.5)?,
        tool.frame("waterfall", 240, "--surface-foam none --spray none")?.picture,
        without.picture,
        frame.picture,
    ];
    grid(&panels, 3, &pictures(docs, "layers.jpg"))
}

/// Prints the iteration counts in three scenes' views, by the thesis's rule and by ours.
fn iteration_counts(tool: &Tool, docs: &Path) -> Outcome<()> {
    let mut panels = Vec::new();
    for (scene, frame) in [("waterfall", 240), ("corridor", 110), ("bamboo", 112)] {
        for rule in ["source", "constant-width"] {
            let more = format!("--rule {rule} --supersample 1 --shadows none");
            let drawn = tool.frame(scene, frame, &more)?;
            let (least, most) = panels::range_of(&drawn.layers, "water.iterations")?;
            println!("iterations, {scene}, {rule}: {least} to {most}");
            panels.push(iterations(&drawn.layers)?);
        }
    }
    grid(&panels, 2, &pictures(docs, "iterations.png"))
}

/// Figure 5.3: foam at several thresholds, in the proportions of the thesis's 110, 90, 70 and 50.
fn thresholds(tool: &Tool, docs: &Path) -> Outcome<()> {
    let mut panels = Vec::new();
    let mut before = 0.0;
    // The threshold that the tool finds for the sequence corresponds to the thesis's 80. A threshold that is given is
    // one of the water's speed; by default the tool finds one of trapped air.
    let found = found_threshold(&tool.frame("waterfall", 240, "--look thesis")?.layers)?;
    println!("thresholds: found We {found:.1}");
    for source in [110.0, 90.0, 70.0, 50.0] {
        let threshold = found / 80.0 * source;
        let drawn = tool.frame("waterfall", 240, &format!("--surface-foam {threshold}"))?;
        let foam = panels::mean_of(&drawn.layers, "surface_foam.thickness")?;
        println!("thresholds, We {threshold:.0}: {foam:.6} m of foam a pixel");
        if foam <= before {
            return Err(format!("foam does not grow as the threshold falls to {threshold}"));
        }
        before = foam;
        panels.push(drawn.picture);
    }
    grid(&panels, 2, &pictures(docs, "thresholds.jpg"))
}

/// Weber number of a frame, from the settings that its file holds.
fn found_threshold(layers: &Layers) -> Outcome<f32> {
    let settings = layers.attributes.iter().find(|(name, _)| name == "settings");
    let lines = settings.into_iter().flat_map(|(_, text)| text.lines());
    let mut found = lines.filter_map(|line| line.strip_prefix("threshold = "));
    // Table [surface_foam] stands before [shoreline], which has a `threshold` too.
    let number = found.next().and_then(|number| number.parse().ok());
    number.ok_or_else(|| "the settings of the frame hold no Weber number".into())
}

/// Figures 4.7 and 4.11: curvature of the spheres and of the smoothed surface; the lower row is at close range.
fn curvature(tool: &Tool, docs: &Path) -> Outcome<()> {
    let mut panels = Vec::new();
    for more in ["", NEAR] {
        // One pixel of the layers is one pixel of the smoothing.
        let more = format!("{more} --surface-foam none --spray none --shadows none");
        let frame = tool.frame("waterfall", 240, &more)?;
        for name in ["water.depth.Z", "water.surface.Z"] {
            let (image, spread) = panels::curvature(&frame.layers, name, RADIUS)?;
            println!("curvature, {name}: {spread:.2} per drawn radius in the mean");
            panels.push(image);
        }
    }
    grid(&panels, 2, &pictures(docs, "curvature.png"))
}

/// Figure 4.10: several fixed counts and our rule, from far and from near.
fn fixed_counts(tool: &Tool, docs: &Path) -> Outcome<()> {
    let mut panels = Vec::new();
    let far = "--eye 2.6,2.6,5.6 --target -0.2,0.3,0 --fov 36";
    let near = "--eye 0.95,0.75,0.6 --target 0.2,0.15,0 --fov 45";
    for view in [far, near] {
        for rule in ["fixed:5", "fixed:40", "fixed:160", "constant-width"] {
            let more =
                format!("{view} --rule {rule} --surface-foam none --spray none --shadows none");
            let picture = tool.frame("waterfall", 240, &more)?.picture;
            let half = (SIZE.0 as u32 / 2, SIZE.1 as u32 / 2);
            let panel = match view == far {
                // From far, crop to the water at full resolution.
                true => image::imageops::crop_imm(&picture, 140, 60, half.0, half.1).to_image(),
                false => image::imageops::thumbnail(&picture, half.0, half.1),
            };
            panels.push(image::imageops::crop_imm(&panel, 8, 4, 224, 126).to_image());
        }
    }
    grid(&panels, 4, &pictures(docs, "fixed-counts.jpg"))
}

/// Figures 4.13 and 4.15: thickness of water and of foam from a single particle, and from many.
fn kernels(tool: &Tool, docs: &Path) -> Outcome<()> {
    let view = "--radius 0.05 --eye 0,0.8,0 --target 0,0,0 --up 0,0,-1 --fov 40 --spray none --shadows none";
    let water = tool.particles("x,y,z\n0,0,0\n", &format!("{view} --surface-foam none"))?;
    // A particle by itself has no foam by default.
    let own = "[surface_foam]\npattern = 0\nnoise = 1\nfew_neighbours = [0.0, 0.0]\n";
    let own = tool.settings(own)?;
    let moving = "x,y,z,vx,vy,vz\n0,0,0,1.5,0,1\n";
    let foam = tool.particles(moving, &format!("{view} --surface-foam 1e-6 {own}"))?;
    let near = tool.frame("waterfall", 240, &format!("{NEAR} --thickness-level 0"))?.layers;
    let square = |image: image::RgbImage| {
        let (side, width) = (SIZE.1 as u32, image.width());
        image::imageops::crop_imm(&image, (width - side.min(width)) / 2, 0, side, side).to_image()
    };
    let most = |layers: &Layers, name: &str| match panels::range_of(layers, name)?.1 {
        most if most > 0.0 => Ok(most),
        _ => Err(format!("{name} is 0 everywhere: there is no kernel to show")),
    };
    let part = |layers: &Layers, name: &str, scale: f32| {
        Ok::<_, String>(square(amount(layers, name, scale)?))
    };
    let panels = [
        part(&water, "water.thickness", 0.8 * most(&water, "water.thickness")?)?,
        part(&near, "water.thickness", 6.0 * RADIUS)?,
        part(&foam, "surface_foam.thickness", 0.8 * most(&foam, "surface_foam.thickness")?)?,
        part(&near, "surface_foam.thickness", RADIUS)?,
    ];
    grid(&panels, 4, &pictures(docs, "kernels.png"))
}

/// Figure 4.14: water behind the front layer of foam, and before it.
fn water_layers(tool: &Tool, docs: &Path) -> Outcome<()> {
    let layers = tool.frame("waterfall", 240, NEAR)?.layers;
    let panels = [
        amount(&layers, "water.thickness.back", 6.0 * RADIUS)?,
        amount(&layers, "water.thickness.front", 6.0 * RADIUS)?,
    ];
    grid(&panels, 2, &pictures(docs, "water-layers.png"))
}

/// Figure 4.18: red where the surface uses one-sided differences, yellow where derivatives are interpolated.
fn borders(tool: &Tool, docs: &Path) -> Outcome<()> {
    let mut panels = Vec::new();
    for view in ["", NEAR] {
        let more = format!("{view} --surface-foam none --spray none --shadows none");
        let frame = tool.frame("waterfall", 240, &more)?;
        panels.push(panels::borders(&frame.layers, "water.surface.Z", 5.3 * RADIUS)?);
    }
    grid(&panels, 2, &pictures(docs, "borders.png"))
}

/// Figure 5.4: no shadows; shadows of the scene; shadows of water and foam, with caustics.
fn shadows(tool: &Tool, docs: &Path) -> Outcome<()> {
    let panels: Result<Vec<_>, _> = ["none", "scene", "all"]
        .iter()
        .map(|what| {
            let more = format!("{NEAR} --shadows {what}");
            Ok::<_, String>(tool.frame("waterfall", 240, &more)?.picture)
        })
        .collect();
    grid(&panels?, 3, &pictures(docs, "shadows.jpg"))
}

/// Figures 5.5 and 5.6: the bamboo fills, tips and is empty; and the pouring at close range.
fn bamboo(tool: &Tool, docs: &Path) -> Outcome<()> {
    let near = "--eye 1.0,0.75,1.05 --target 0.45,0.3,0 --fov 36";
    let panels = [
        tool.frame("bamboo", 80, "")?.picture,
        tool.frame("bamboo", 112, "")?.picture,
        tool.frame("bamboo", 112, near)?.picture,
        tool.frame("bamboo", 112, &format!("{near} --surface-foam none --spray none"))?.picture,
    ];
    grid(&panels, 2, &pictures(docs, "bamboo-foam.jpg"))
}

/// Figure 5.7, without and with foam; below it Figure 5.8's foam under the surface, and a map of the foam.
fn foam(tool: &Tool, docs: &Path) -> Outcome<()> {
    let wave = "--eye 0.6,0.85,0.3 --target -1.4,0.15,-0.1 --fov 50";
    let under = "--eye 0.75,0.75,1.35 --target -0.05,0.1,0.1 --fov 40";
    let panels = [
        tool.frame("corridor", 110, &format!("{wave} --surface-foam none --spray none"))?.picture,
        tool.frame("corridor", 110, wave)?.picture,
        tool.frame("waterfall", 240, under)?.picture,
        amount(&tool.frame("waterfall", 240, under)?.layers, "surface_foam.thickness", 0.05)?,
    ];
    grid(&panels, 2, &pictures(docs, "foam.jpg"))
}

/// Foam by a noise of each sprite's own, and by a noise that all sprites share.
fn pattern(tool: &Tool, docs: &Path) -> Outcome<()> {
    let wave = "--eye 0.6,0.85,0.3 --target -1.4,0.15,-0.1 --fov 50";
    let own = tool.settings("[surface_foam]\npattern = 0\nnoise = 1\n")?;
    let panels = [
        tool.frame("waterfall", 195, &own)?.picture,
        tool.frame("waterfall", 195, "")?.picture,
        tool.frame("corridor", 233, &format!("{wave} {own}"))?.picture,
        tool.frame("corridor", 233, wave)?.picture,
    ];
    grid(&panels, 2, &pictures(docs, "foam-pattern.jpg"))
}

/// Figure 5.13: one sheet of water, whose thickness includes water behind an air gap, and two sheets.
fn sheets(tool: &Tool, docs: &Path) -> Outcome<()> {
    let panels: Result<Vec<_>, _> = ["1", "2"]
        .iter()
        .map(|sheets| {
            let more =
                format!("{NEAR} --surface-foam none --spray none --shadows none --sheets {sheets}");
            let frame = tool.frame("waterfall", 240, &more)?;
            Ok::<_, String>(frame.picture)
        })
        .collect();
    grid(&panels?, 2, &pictures(docs, "sheets.jpg"))
}

/// The ways of drawing that the thesis compares, and ours. All see straight through water, as in the thesis, because
/// the cost of a second refraction is no question of smoothing or foam.
const WAYS: [(&str, &str); 4] = [
    ("baseline: 40 iterations", "--sheets 1 --surface-foam none --rule fixed:40"),
    ("source, without foam", "--sheets 1 --surface-foam none --rule source"),
    ("source, with foam", "--sheets 1 --surface-foam auto --rule source"),
    ("default: constant width, two sheets, foam", "--surface-foam auto"),
];

/// Largest allowed cost of each way relative to the baseline, without and with foam (the thesis's Table 5.1 has up to
/// 1.10 and 1.42).
const LIMITS: [Option<f64>; WAYS.len()] = [None, Some(1.1), Some(1.45), None];

/// Runs of each way, interleaved, so that other load on the machine spreads over all ways.
const ROUNDS: usize = 3;

/// For each way, the mean over all frames of the median time of a frame's draws.
fn measure(tool: &Tool, scene: &str, frames: &[String], camera: &Path) -> Outcome<Vec<Curve>> {
    let straight = tool.settings("[water]\nexit = 'straight'\n")?;
    let mut timed: [Vec<Timed>; WAYS.len()] = Default::default();
    for _ in 0..ROUNDS {
        for (all, (_, more)) in timed.iter_mut().zip(WAYS) {
            let round = tool.times(scene, frames, camera, &format!("{more} {straight}"))?;
            all.resize_with(round.len(), Timed::default);
            for (all, frame) in all.iter_mut().zip(round) {
                all.steps.extend(frame.steps);
                all.draws.extend(frame.draws);
            }
        }
    }
    let mut curves: Vec<Curve> = Vec::new();
    for (((name, _), frames), limit) in WAYS.into_iter().zip(timed).zip(LIMITS) {
        let medians: Vec<f64> = frames.iter().map(Timed::median).collect();
        let mean = medians.iter().sum::<f64>() / medians.len().max(1) as f64;
        let first = curves.first().map_or(mean, |(_, ms)| ms.iter().sum::<f64>() / ms.len() as f64);
        let ratio = mean / first;
        print!("{scene}, {name}: {mean:.1} ms, {ratio:.2} of the baseline");
        if let Some(limit) = limit {
            print!(" ({} the limit of {limit})", if ratio <= limit { "within" } else { "OVER" });
        }
        print!(";");
        for (pass, share) in shares(&frames) {
            print!(" {pass} {:.0} %", 100.0 * share);
        }
        println!();
        curves.push((name, medians));
    }
    Ok(curves)
}

/// Share of each pass in the frames' time, which is the mean of a step plus the mean of a draw.
fn shares(frames: &[Timed]) -> Vec<(String, f64)> {
    let mut sums: Vec<(String, f64)> = Vec::new();
    for all in frames.iter().flat_map(|frame| [&frame.steps, &frame.draws]) {
        for (pass, ms) in all.iter().flatten() {
            let ms = ms / all.len() as f64;
            match sums.iter_mut().find(|(name, _)| name == pass) {
                Some((_, sum)) => *sum += ms,
                None => sums.push((pass.clone(), ms)),
            }
        }
    }
    let whole: f64 = sums.iter().map(|(_, sum)| sum).sum();
    sums.into_iter().map(|(pass, sum)| (pass, sum / whole)).collect()
}

/// Figure 5.9: a zoom to the waterfall's basin in a single frame.
fn zoom(tool: &Tool, docs: &Path) -> Outcome<()> {
    const STEPS: u32 = 16;
    // Frames before the first, in which foam accumulates.
    const LEAD: u32 = 60;
    let still = tool.scene("waterfall")?.join("waterfall_0240.bgeo");
    for frame in 1..=LEAD + STEPS {
        let file = tool.temporary(&format!("zoom_{frame:04}.bgeo"));
        std::fs::copy(&still, &file).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    // From ten metres to one; the distance shrinks by the same factor in each step.
    let keys: Vec<_> = (1..=STEPS)
        .map(|step| {
            let away = 10.0_f64.powf(1.0 - f64::from(step - 1) / f64::from(STEPS - 1));
            let eye = [-0.1 + 0.35 * away, 0.15 + 0.45 * away, 0.82 * away];
            json!({"frame": LEAD + step, "eye": eye, "target": [-0.1, 0.15, 0.0]})
        })
        .collect();
    let camera = tool.temporary("zoom.json");
    std::fs::write(&camera, json!({"fov_y_degrees": 38.0, "keys": keys}).to_string())
        .map_err(|error| format!("{}: {error}", camera.display()))?;
    let frames = [
        tool.temporary("zoom_%04d.bgeo").display().to_string(),
        format!("--frames={}-{}", LEAD + 1, LEAD + STEPS),
    ];
    let curves = measure(tool, "waterfall", &frames, &camera)?;
    curves::plot("Zoom, waterfall", "from 10 m to 1 m", &curves, &pictures(docs, "cost-zoom.svg"))
}

/// Figures 5.10 to 5.12: a scene's own camera path, every fifteenth frame.
fn flight(tool: &Tool, docs: &Path, scene: &str) -> Outcome<()> {
    let folder = tool.scene(scene)?;
    let more = ["--frames=15-240", "--every=15"].map(str::to_owned);
    let frames = [&[sequence(&folder, scene)][..], &more].concat();
    let curves = measure(tool, scene, &frames, &folder.join("camera.json"))?;
    let to = pictures(docs, &format!("cost-{scene}.svg"));
    curves::plot(&format!("Fly-through, {scene}"), "frame / 15 - 1", &curves, &to)
}
