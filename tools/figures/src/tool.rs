//! Runs the command-line tool and reads its output.

use std::path::{Path, PathBuf};
use std::process::Command;

use image::RgbImage;
use whitewater::io::picture::{self, Layers};

use crate::Outcome;

/// The program that draws the foam of seas by volume ray-casting.
const CASTER: &str = "whitewater-raycast";

/// Size of a panel's picture.
pub const SIZE: (usize, usize) = (480, 270);

/// Direction to the sun in the pictures of own scenes ([`Tool::frame`]): from the side.
const SUN: &str = "-0.75,0.62,0.3";

/// The command-line tool, and the folder of scenes.
pub struct Tool {
    program: PathBuf,
    caches: PathBuf,
    folder: tempfile::TempDir,
}

/// A drawn frame.
pub struct Frame {
    /// Its layers, including the linear picture.
    pub layers: Layers,
    /// The displayed picture.
    pub picture: RgbImage,
}

/// ffmpeg options for an animated WebP.
const WEBP: &str = "-c:v libwebp_anim -quality 75 -compression_level 6 -loop 0";

/// Draws of a frame whose passes are timed.
const REPEATS: u32 = 8;

/// Milliseconds of the passes of a draw, or of a step before it, in order.
pub type Times = Vec<(String, f64)>;

/// Times of a frame.
#[derive(Clone, Default)]
pub struct Timed {
    /// Times of each step before the frame is drawn.
    pub steps: Vec<Times>,
    /// Times of each draw.
    pub draws: Vec<Times>,
}

impl Timed {
    /// Milliseconds of the frame: the median of its draws, each the sum of its passes, plus the median of its steps.
    pub fn median(&self) -> f64 {
        [&self.steps, &self.draws].map(|all| median(all.iter().map(total).collect())).iter().sum()
    }
}

/// The median, or 0 if there are no values.
fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

impl Tool {
    /// `program` is the tool to run; the default is the one beside this program.
    pub fn new(program: Option<&Path>, caches: &Path) -> Outcome<Self> {
        let beside =
            || Ok::<_, std::io::Error>(std::env::current_exe()?.with_file_name("whitewater"));
        let program = match program {
            Some(program) => program.to_owned(),
            None => beside().map_err(|error| format!("cannot find whitewater: {error}"))?,
        };
        if !program.exists() {
            return Err(format!("{} is not there; build it", program.display()));
        }
        let folder =
            tempfile::tempdir().map_err(|error| format!("no temporary folder: {error}"))?;
        // Further arguments are one text, split at spaces.
        if folder.path().display().to_string().contains(char::is_whitespace) {
            return Err(format!("{}: TMPDIR must have no spaces", folder.path().display()));
        }
        Ok(Self { program, caches: caches.to_owned(), folder })
    }

    /// Path of a file that is deleted when this program ends.
    pub fn temporary(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &[String]) -> Outcome<()> {
        run(&self.program, arguments)
    }

    /// Folder of a scene's simulated files; simulates them if they are missing.
    pub fn scene(&self, name: &str) -> Outcome<PathBuf> {
        let folder = self.caches.join(name);
        if !folder.join(format!("{name}_0240.bgeo")).exists() {
            eprintln!("figures: simulating {name}");
            let folder = folder.display().to_string();
            self.run(&["simulate".into(), name.into(), "--out".into(), folder])?;
        }
        Ok(folder)
    }

    /// A frame of a scene's sequence, with the foam that earlier frames left. `more` are further arguments.
    pub fn frame(&self, scene: &str, frame: u32, more: &str) -> Outcome<Frame> {
        let folder = self.scene(scene)?;
        let [exr, png] =
            ["exr", "png"].map(|kind| self.temporary(&format!("frame_{frame:04}.{kind}")));
        let mut arguments = vec![
            "render".to_owned(),
            sequence(&folder, scene),
            format!("--frames={frame}"),
            format!("--scene={}", folder.join("scene.json").display()),
            format!("--size={}x{}", SIZE.0, SIZE.1),
            format!("--sun={SUN}"),
            format!("--output={}", self.temporary("frame_%04d.exr").display()),
            format!("--output={}", self.temporary("frame_%04d.png").display()),
            "--overwrite".to_owned(),
        ];
        if !more.contains("--eye") {
            arguments.push(format!("--camera={}", folder.join("camera.json").display()));
        }
        arguments.extend(more.split_whitespace().map(str::to_owned));
        self.run(&arguments)?;
        let layers = picture::read(&exr).map_err(|error| error.to_string())?;
        let picture = image::open(&png).map_err(|error| error.to_string())?.into_rgb8();
        Ok(Frame { layers, picture })
    }

    /// The picture that `render` writes with these arguments.
    pub fn draw(&self, arguments: &[String], png: &Path) -> Outcome<RgbImage> {
        let mut all = vec!["render".to_owned()];
        all.extend_from_slice(arguments);
        // For a sequence, the tool puts the frame's number into the name.
        let pattern = png.with_file_name("gallery_%04d.png");
        let numbered = arguments.iter().any(|a| a.starts_with("--frames="));
        let to = if numbered { &pattern } else { png };
        all.extend(["--overwrite".to_owned(), format!("--output={}", to.display())]);
        self.run(&all)?;
        let frame = arguments.iter().find_map(|a| a.strip_prefix("--frames="));
        let written = match frame.and_then(|frame| frame.parse::<u32>().ok()) {
            Some(frame) => png.with_file_name(format!("gallery_{frame:04}.png")),
            None => png.to_owned(),
        };
        Ok(image::open(&written).map_err(|error| error.to_string())?.into_rgb8())
    }

    /// The picture that `tools/demo` writes, from the same options.
    pub fn demo(&self) -> Outcome<RgbImage> {
        let png = self.temporary("demo.png");
        let to = format!("--output={}", png.display());
        self.run(&["demo", "--shutter=1/200", "--aperture=0.0066", &to].map(str::to_owned))?;
        Ok(image::open(&png).map_err(|error| error.to_string())?.into_rgb8())
    }

    /// Frames `[first, last, step]` of a scene's sequence at 20 a second as an animated WebP. `more` are further
    /// arguments. Needs `ffmpeg` with libwebp: no Rust crate writes lossy WebP.
    pub fn film(
        &self,
        scene: &str,
        [first, last, step]: [u32; 3],
        more: &str,
        to: &Path,
    ) -> Outcome<()> {
        let folder = self.scene(scene)?;
        let mut arguments = vec![
            "render".to_owned(),
            sequence(&folder, scene),
            format!("--frames={first}-{last}"),
            format!("--every={step}"),
            format!("--scene={}", folder.join("scene.json").display()),
            format!("--size={}x{}", SIZE.0, SIZE.1),
            "--set=pool".to_owned(),
            format!("--output={}", self.temporary("film_%04d.png").display()),
            "--overwrite".to_owned(),
        ];
        arguments.extend(more.split_whitespace().map(str::to_owned));
        self.run(&arguments)?;
        // ffmpeg's pattern needs consecutive numbers.
        for (i, frame) in (first..=last).step_by(step as usize).enumerate() {
            let [from, to] = [format!("film_{frame:04}.png"), format!("webp_{i:04}.png")]
                .map(|name| self.temporary(&name));
            std::fs::rename(&from, to).map_err(|error| format!("{}: {error}", from.display()))?;
        }
        let frames = self.temporary("webp_%04d.png").display().to_string();
        let mut arguments: Vec<String> =
            format!("-loglevel error -y -framerate 20 -i {frames} {WEBP}")
                .split_whitespace()
                .map(str::to_owned)
                .collect();
        arguments.push(to.display().to_string());
        run(Path::new("ffmpeg"), &arguments)
    }

    /// A frame of bubble foam. `more` are further arguments.
    pub fn bubbles(&self, which: &str, frame: u32, more: &str) -> Outcome<Frame> {
        self.alone(&format!("--bubbles={which}"), frame, more)
    }

    /// A frame of shoreline and contact foam. `more` are further arguments.
    pub fn shore(&self, which: &str, frame: u32, more: &str) -> Outcome<Frame> {
        self.alone(&format!("--shore={which}"), frame, more)
    }

    /// A frame without particles.
    fn alone(&self, what: &str, frame: u32, more: &str) -> Outcome<Frame> {
        let [exr, png] = ["alone.exr", "alone.png"].map(|name| self.temporary(name));
        let mut arguments = vec![
            "render".to_owned(),
            what.to_owned(),
            format!("--frames={frame}"),
            format!("--size={}x{}", SIZE.0, SIZE.1),
            format!("--output={}", exr.display()),
            format!("--output={}", png.display()),
            "--overwrite".to_owned(),
        ];
        arguments.extend(more.split_whitespace().map(str::to_owned));
        self.run(&arguments)?;
        let layers = picture::read(&exr).map_err(|error| error.to_string())?;
        let picture = image::open(&png).map_err(|error| error.to_string())?.into_rgb8();
        Ok(Frame { layers, picture })
    }

    /// The argument that draws with these settings (TOML).
    pub fn settings(&self, text: &str) -> Outcome<String> {
        let path = self.temporary("settings.toml");
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(format!("--settings {}", path.display()))
    }

    /// A picture of a sea with `whitewater` particles. `look` is the table `[whitewater]`.
    pub fn sea(&self, sea: &str, whitewater: &str, size: &str, look: &str) -> Outcome<RgbImage> {
        let png = self.draw_sea("png", [sea, whitewater, size, look], None)?;
        Ok(image::open(&png).map_err(|error| error.to_string())?.into_rgb8())
    }

    /// The same from a distance in metres.
    pub fn sea_from(
        &self,
        metres: f32,
        sea: &str,
        whitewater: &str,
        size: &str,
    ) -> Outcome<RgbImage> {
        let png = self.draw_sea("png", [sea, whitewater, size, ""], Some(metres))?;
        Ok(image::open(&png).map_err(|error| error.to_string())?.into_rgb8())
    }

    /// The layers of the sea's foam.
    pub fn sea_layers(
        &self,
        sea: &str,
        whitewater: &str,
        size: &str,
        look: &str,
    ) -> Outcome<Layers> {
        let exr = self.draw_sea("exr", [sea, whitewater, size, look], None)?;
        picture::read(&exr).map_err(|error| error.to_string())
    }

    fn draw_sea(
        &self,
        kind: &str,
        [sea, whitewater, size, look]: [&str; 4],
        away: Option<f32>,
    ) -> Outcome<PathBuf> {
        let (to, toml) = (self.temporary(&format!("sea.{kind}")), self.temporary("sea.toml"));
        std::fs::write(&toml, format!("[whitewater]\n{look}\n"))
            .map_err(|error| format!("cannot write {}: {error}", toml.display()))?;
        let mut arguments = vec![
            "bench".to_owned(),
            format!("--sea={sea}"),
            format!("--whitewater={whitewater}"),
            format!("--size={size}"),
            "--frames=1".to_owned(),
            "--warmup=0".to_owned(),
            format!("--settings={}", toml.display()),
            format!("--picture={}", to.display()),
        ];
        arguments.extend(away.map(|metres| format!("--away={metres}")));
        self.run(&arguments)?;
        Ok(to)
    }

    /// Intensity of a sea's foam in each pixel by volume ray-casting, 0 to 1.
    pub fn sea_ray_cast(&self, sea: &str, whitewater: u32, size: &str) -> Outcome<Vec<f32>> {
        let (program, png) = (self.program.with_file_name(CASTER), self.temporary("cast.png"));
        if !program.exists() {
            return Err(format!("{} is not there; build {CASTER}", program.display()));
        }
        run(
            &program,
            &[
                format!("--sea={sea}"),
                format!("--particles={whitewater}"),
                format!("--size={size}"),
                "--method=grid".to_owned(),
                "--step=1".to_owned(),
                format!("--output={}", png.display()),
            ],
        )?;
        let grey = image::open(&png).map_err(|error| error.to_string())?.into_luma8();
        Ok(grey.iter().map(|v| linear(*v)).collect())
    }

    /// The layers of a single whitewater particle of a kind, whose disc has a radius of `pixels` in the middle of a
    /// picture `size` pixels wide.
    pub fn particle(&self, kind: &str, size: u32, pixels: f64) -> Outcome<Layers> {
        // The depth at which the particle, with a radius of 1, has a radius of `pixels`.
        let depth = f64::from(size) / (2.0 * pixels) / 30.0_f64.to_radians().tan();
        let radius = if kind == "bubble" { 2.0 } else { 1.0 };
        let files = [
            ("water.csv", "x,y,z\n0,-9,0\n".to_owned()),
            ("one.csv", "x,y,z\n0,0,0\n".to_owned()),
            ("one.toml", format!("[whitewater]\nradius = {radius:.1}\n")),
        ];
        for (name, text) in &files {
            let file = self.temporary(name);
            std::fs::write(&file, text).map_err(|e| format!("cannot write {name}: {e}"))?;
        }
        let path = |name: &str| self.temporary(name).display().to_string();
        self.run(&[
            "render".to_owned(),
            path("water.csv"),
            format!("--whitewater={kind}={}", path("one.csv")),
            format!("--settings={}", path("one.toml")),
            format!("--eye=0,0,{depth}"),
            "--target=0,0,0".to_owned(),
            "--fov=60".to_owned(),
            format!("--size={size}x{size}"),
            "--supersample=1".to_owned(),
            format!("--output={}", path("one.exr")),
            "--overwrite".to_owned(),
        ])?;
        picture::read(&self.temporary("one.exr")).map_err(|error| error.to_string())
    }

    /// The layers of a frame of our own particles, `x,y,z...` as CSV, without surroundings. `more` are further arguments.
    pub fn particles(&self, csv: &str, more: &str) -> Outcome<Layers> {
        let [from, exr] = ["own.csv", "own.exr"].map(|name| self.temporary(name));
        std::fs::write(&from, csv).map_err(|error| format!("{}: {error}", from.display()))?;
        let mut arguments = vec![
            "render".to_owned(),
            from.display().to_string(),
            "--set=none".to_owned(),
            "--supersample=1".to_owned(),
            "--thickness-level=0".to_owned(),
            format!("--size={}x{}", SIZE.1, SIZE.1),
            format!("--output={}", exr.display()),
            "--overwrite".to_owned(),
        ];
        arguments.extend(more.split_whitespace().map(str::to_owned));
        self.run(&arguments)?;
        picture::read(&exr).map_err(|error| error.to_string())
    }

    /// Times of a scene's frames along a moving camera. `frames` are the arguments that name the files and the frames.
    pub fn times(
        &self,
        scene: &str,
        frames: &[String],
        camera: &Path,
        more: &str,
    ) -> Outcome<Vec<Timed>> {
        let csv = self.temporary("times.csv");
        let mut arguments = vec!["render".to_owned()];
        arguments.extend_from_slice(frames);
        arguments.extend([
            format!("--scene={}", self.scene(scene)?.join("scene.json").display()),
            format!("--camera={}", camera.display()),
            "--size=1280x720".to_owned(),
            "--supersample=1".to_owned(),
            "--shadows=none".to_owned(),
            "--spray=none".to_owned(),
            "--thickness-level=2".to_owned(),
            format!("--output={}", self.temporary("times_%04d.png").display()),
            "--overwrite".to_owned(),
            format!("--timings={}", csv.display()),
            format!("--repeat={REPEATS}"),
        ]);
        arguments.extend(more.split_whitespace().map(str::to_owned));
        self.run(&arguments)?;
        read_times(&csv)
    }
}

fn run(program: &Path, arguments: &[String]) -> Outcome<()> {
    let status = Command::new(program)
        .args(arguments)
        .status()
        .map_err(|error| format!("cannot run {}: {error}", program.display()))?;
    if status.success() {
        return Ok(());
    }
    Err(format!("{} {} ended with {status}", program.display(), arguments.join(" ")))
}

/// Linear light of an sRGB byte.
pub fn linear(byte: u8) -> f32 {
    picture::srgb_decode(f32::from(byte) / 255.0)
}

/// Pattern of a scene's files.
pub fn sequence(folder: &Path, scene: &str) -> String {
    folder.join(format!("{scene}_%04d.bgeo")).display().to_string()
}

/// Total milliseconds of the passes.
fn total(times: &Times) -> f64 {
    times.iter().map(|(_, ms)| ms).sum()
}

/// Parses the rows of `--timings`: frame, pass, start, nanoseconds. A start of 0 begins a new submission.
fn read_times(csv: &Path) -> Outcome<Vec<Timed>> {
    let text =
        std::fs::read_to_string(csv).map_err(|error| format!("{}: {error}", csv.display()))?;
    let mut frames: Vec<(&str, Vec<Times>)> = Vec::new();
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [frame, pass, start, nanoseconds] = cells[..] else {
            return Err(format!("expected four columns, found {line:?}"));
        };
        let number = |text: &str| text.parse::<f64>().map_err(|_| format!("no number in {line:?}"));
        let (start, ms) = (number(start)?, number(nanoseconds)? * 1.0e-6);
        if frames.last().is_none_or(|(last, _)| *last != frame) {
            frames.push((frame, Vec::new()));
        }
        if let Some((_, submitted)) = frames.last_mut() {
            if start == 0.0 || submitted.is_empty() {
                submitted.push(Vec::new());
            }
            submitted.last_mut().into_iter().for_each(|times| times.push((pass.to_owned(), ms)));
        }
    }
    let is_draw = |times: &Times| times.iter().any(|(pass, _)| pass == "composite");
    let timed = |(_, submitted): (_, Vec<Times>)| {
        let (draws, steps) = submitted.into_iter().partition(is_draw);
        Timed { steps, draws }
    };
    Ok(frames.into_iter().map(timed).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame has the median of its draws' totals, not the sum of the best passes.
    #[test]
    fn a_frame_takes_the_median_of_its_draws() {
        let folder = tempfile::tempdir().expect("a folder");
        let csv = folder.path().join("t.csv");
        let mut text = String::from("frame,pass,start,nanoseconds\n");
        for frame in [1, 2] {
            text += &format!("{frame},classify,0,500000\n");
            for (depth, composite) in [(9, 1), (4, 3), (1, 8)] {
                text += &format!(
                    "{frame},depth,0,{depth}000000\n{frame},composite,7,{composite}000000\n"
                );
            }
        }
        std::fs::write(&csv, text).expect("written");
        let frames = read_times(&csv).expect("read");
        assert_eq!(frames.len(), 2);
        for frame in frames {
            assert_eq!((frame.steps.len(), frame.draws.len()), (1, 3));
            // The totals are 10, 7 and 9; the sum of the best passes would be 2.
            assert_eq!(frame.median(), 9.0 + 0.5);
        }
    }
}
