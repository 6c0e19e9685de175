//! Simulates the demo scene 'waterfall' and writes its particles and its geometry.
//!
//! ```text
//! whitewater-simulate waterfall --frames 1-240 --fps 60 --out DIR [--spacing 0.04] [--keep 240]
//! whitewater-simulate preview FILE.bgeo... [--eye X,Y,Z --target X,Y,Z --fov DEGREES | --ortho METRES]
//! whitewater-simulate statistics FILE.bgeo...
//! ```

mod bgeo;
mod kernel;
mod neighbours;
mod preview;
mod scene;
mod solver;

use std::error::Error;
use std::io::{IsTerminal, Write};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use glam::Vec3;

use bgeo::Frame;
use scene::Scene;
use solver::{REST_DENSITY, Simulation};

const USAGE: &str = "\
usage: whitewater-simulate waterfall --out DIR [options]
         --frames A-B      frames to write; all from 0 to B are simulated (1-240)
         --fps N           frames per second (60)
         --spacing METRES  distance of particles at rest (0.04)
         --keep A[-B]      write these frames only
         --seed N          of the random numbers (1)
         --threads N       0: one per core (0)
       whitewater-simulate preview FILE.bgeo... [options]
         draws FILE.png
         --eye X,Y,Z --target X,Y,Z --fov DEGREES
         --ortho METRES    parallel projection of this width
         --spacing METRES  (0.04)
         --suffix TEXT     draws FILETEXT.png
       whitewater-simulate statistics FILE.bgeo...";

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The command line: options with a value, and the rest.
struct Arguments {
    options: Vec<(String, String)>,
    files: Vec<PathBuf>,
}

impl Arguments {
    fn parse(mut words: impl Iterator<Item = String>, known: &[&str]) -> Result<Self> {
        let (mut options, mut files) = (Vec::new(), Vec::new());
        while let Some(word) = words.next() {
            if let Some(name) = word.strip_prefix("--") {
                if !known.contains(&name) {
                    return Err(format!("unknown option --{name}\n{USAGE}").into());
                }
                let value = words.next().ok_or_else(|| format!("--{name} needs a value"))?;
                options.push((name.to_owned(), value));
            } else {
                files.push(word.into());
            }
        }
        Ok(Self { options, files })
    }

    fn text(&self, name: &str) -> Option<&str> {
        let found = self.options.iter().rev().find(|(option, _)| option == name);
        found.map(|(_, value)| value.as_str())
    }

    fn number<T: std::str::FromStr>(&self, name: &str, default: T) -> Result<T> {
        match self.text(name) {
            None => Ok(default),
            Some(text) => {
                text.parse().map_err(|_| format!("--{name}: '{text}' is no such number").into())
            }
        }
    }

    fn range(&self, name: &str) -> Result<Option<RangeInclusive<u32>>> {
        let Some(text) = self.text(name) else {
            return Ok(None);
        };
        let (from, to) = text.split_once('-').unwrap_or((text, text));
        match (from.parse(), to.parse()) {
            (Ok(from), Ok(to)) if from <= to => Ok(Some(from..=to)),
            _ => Err(format!("--{name}: '{text}' is no range of frames").into()),
        }
    }

    fn vector(&self, name: &str, default: Vec3) -> Result<Vec3> {
        let Some(text) = self.text(name) else {
            return Ok(default);
        };
        let parts: Vec<f32> = text.split(',').filter_map(|part| part.parse().ok()).collect();
        match parts.as_slice() {
            &[x, y, z] => Ok(Vec3::new(x, y, z)),
            _ => Err(format!("--{name}: '{text}' is not X,Y,Z").into()),
        }
    }

    fn spacing(&self) -> Result<f32> {
        let spacing: f32 = self.number("spacing", 0.04)?;
        if (0.01..=0.1).contains(&spacing) {
            Ok(spacing)
        } else {
            Err("--spacing: from 0.01 to 0.1".into())
        }
    }
}

fn waterfall(arguments: &Arguments) -> Result<()> {
    let out = PathBuf::from(arguments.text("out").ok_or(USAGE)?);
    let frames = arguments.range("frames")?.unwrap_or(1..=240);
    let keep = arguments.range("keep")?.unwrap_or_else(|| frames.clone());
    let fps: f32 = arguments.number("fps", 60.0)?;
    let spacing = arguments.spacing()?;
    let seed = arguments.number("seed", 1)?;
    rayon::ThreadPoolBuilder::new().num_threads(arguments.number("threads", 0)?).build_global()?;
    if !(fps > 0.0 && fps.is_finite()) {
        return Err("--fps: must be above zero".into());
    }
    std::fs::create_dir_all(&out)?;

    let scene = Scene::waterfall();
    let mut json = serde_json::to_string_pretty(&scene.to_json(spacing, REST_DENSITY))?;
    json.push('\n');
    std::fs::write(out.join("scene.json"), json)?;

    let mut simulation = Simulation::new(scene, spacing, seed);
    let start = Instant::now();
    let terminal = std::io::stderr().is_terminal();
    let last = *frames.end();
    for number in 0..=last {
        let steps = simulation.advance_to(number as f32 / fps);
        if frames.contains(&number) && keep.contains(&number) {
            let frame = simulation.frame();
            frame.write(&out.join(format!("waterfall_{number:04}.bgeo")))?;
        }
        if terminal || number % 10 == 0 || number == last {
            let elapsed = start.elapsed().as_secs_f32();
            let left = elapsed * (last - number) as f32 / (number + 1) as f32;
            let report = simulation.report();
            let line = format!(
                "frame {number}/{last}: {}; {steps} steps, {} + {} iterations, {} lost; {elapsed:.0} s, {left:.0} s left",
                summary(&simulation.frame()),
                report.divergence_iterations,
                report.density_iterations,
                simulation.lost(),
            );
            if terminal {
                eprint!("\r\x1b[K{line}");
                std::io::stderr().flush()?;
            } else {
                eprintln!("{line}");
            }
        }
    }
    if terminal {
        eprintln!();
    }
    Ok(())
}

/// Count, fastest particle, mean and worst compression, in a line.
fn summary(frame: &Frame) -> String {
    let count = frame.ids.len().max(1) as f32;
    let fastest = frame.velocities.iter().map(|v| v.length()).fold(0.0, f32::max);
    let compression = |d: f32| (d / REST_DENSITY - 1.0).max(0.0);
    let mean: f32 = frame.densities.iter().map(|&d| compression(d)).sum::<f32>() / count;
    let worst = frame.densities.iter().map(|&d| compression(d)).fold(0.0, f32::max);
    format!(
        "{} particles, {fastest:.2} m/s, compression {:.2} % (at most {:.1} %)",
        frame.ids.len(),
        100.0 * mean,
        100.0 * worst
    )
}

fn statistics(path: &Path, out: &mut impl Write) -> Result<()> {
    let frame = Frame::read(path)?;
    let scene = Scene::waterfall();
    writeln!(out, "{}: {}", path.display(), summary(&frame))?;
    let bounds = frame
        .positions
        .iter()
        .fold((Vec3::MAX, Vec3::MIN), |(low, high), &at| (low.min(at), high.max(at)));
    writeln!(out, "  from {:.3} to {:.3}", bounds.0, bounds.1)?;
    let mut nearest: Vec<f32> = Vec::new();
    for &at in &frame.positions {
        let distances = scene.solids.iter().map(|solid| solid.distance(at).0);
        nearest.push(distances.fold(f32::MAX, f32::min));
    }
    let inside = nearest.iter().filter(|&&d| d < 0.0).count();
    let lost = frame.positions.iter().filter(|&&at| scene.lost(at)).count();
    let closest = nearest.iter().copied().fold(f32::MAX, f32::min);
    writeln!(out, "  {inside} in solids (closest {closest:.4} m), {lost} outside")?;
    let mut pool: Vec<f32> = Vec::new();
    for (at, &density) in frame.positions.iter().zip(&frame.densities) {
        if at.y < 0.75 * scene::POOL_DEPTH && at.x.abs() < scene::BASIN_HALF[0] {
            pool.push(density);
        }
    }
    pool.sort_by(f32::total_cmp);
    if let Some(last) = pool.len().checked_sub(1) {
        let at = |part: f32| pool[(part * last as f32) as usize];
        let percentiles = [0.01, 0.05, 0.5, 0.95, 0.99, 1.0].map(at);
        writeln!(out, "  pool density at 1, 5, 50, 95, 99, 100 %: {percentiles:.1?}")?;
    }
    // Layers would show as peaks of the number of particles over the height.
    let mut heights = [0usize; 24];
    for at in &frame.positions {
        if at.x > 0.4 && at.y < 0.48 {
            heights[((at.y / 0.02).max(0.0) as usize).min(23)] += 1;
        }
    }
    writeln!(out, "  far half, particles per 2 cm of height: {heights:?}")?;
    Ok(())
}

fn preview(arguments: &Arguments) -> Result<()> {
    let parallel: f32 = arguments.number("ortho", 0.0)?;
    let camera = preview::Camera {
        eye: arguments.vector("eye", scene::CAMERA_EYE)?,
        target: arguments.vector("target", scene::CAMERA_TARGET)?,
        fov: if parallel > 0.0 { 0.0 } else { arguments.number("fov", scene::CAMERA_FOV)? },
        width: parallel,
    };
    for path in &arguments.files {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let suffix = arguments.text("suffix").unwrap_or_default();
        let picture = path.with_file_name(format!("{stem}{suffix}.png"));
        preview::draw(
            &Scene::waterfall(),
            &Frame::read(path)?,
            arguments.spacing()?,
            camera,
            &picture,
        )?;
        println!("{}", picture.display());
    }
    Ok(())
}

fn run() -> Result<()> {
    let mut words = std::env::args().skip(1);
    match words.next().as_deref() {
        Some("waterfall") => {
            let known = ["frames", "fps", "out", "spacing", "keep", "seed", "threads"];
            let arguments = Arguments::parse(words, &known)?;
            if let Some(file) = arguments.files.first() {
                return Err(format!("unexpected '{}'\n{USAGE}", file.display()).into());
            }
            waterfall(&arguments)
        }
        Some("preview") => {
            let known = ["eye", "target", "fov", "ortho", "spacing", "suffix"];
            preview(&Arguments::parse(words, &known)?)
        }
        Some("statistics") => {
            let arguments = Arguments::parse(words, &[])?;
            arguments.files.iter().try_for_each(|path| statistics(path, &mut std::io::stdout()))
        }
        _ => Err(USAGE.into()),
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
