//! Inspects the output of `whitewater simulate` without a GPU.
//!
//! ```text
//! whitewater-simulate preview FILE.bgeo... [--eye X,Y,Z --target X,Y,Z --fov DEGREES | --ortho METRES]
//! whitewater-simulate statistics FILE.bgeo...
//! ```

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use glam::Vec3;
use whitewater_simulate::{Frame, Scene, preview};

const USAGE: &str = "\
usage: whitewater-simulate preview FILE.bgeo... [options]
         draws FILE.png; a scene with moving parts needs its scene.json beside it
         --eye X,Y,Z --target X,Y,Z --fov DEGREES
         --ortho METRES    parallel projection of this width
         --spacing METRES  of the particles, unless the scene's own
         --suffix TEXT     draws FILETEXT.png
       whitewater-simulate statistics FILE.bgeo...";

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The command line: options with a value, and the other arguments.
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
        if files.is_empty() {
            return Err(format!("no file given\n{USAGE}").into());
        }
        Ok(Self { options, files })
    }

    /// A number above 0, or none if the option is not given.
    fn positive(&self, name: &str) -> Result<Option<f32>> {
        match self.text(name).map(str::parse::<f32>) {
            None => Ok(None),
            Some(Ok(value)) if value > 0.0 && value.is_finite() => Ok(Some(value)),
            Some(_) => Err(format!("--{name}: a number above 0 expected").into()),
        }
    }

    fn text(&self, name: &str) -> Option<&str> {
        let found = self.options.iter().rev().find(|(option, _)| option == name);
        found.map(|(_, value)| value.as_str())
    }

    fn vector(&self, name: &str, default: Vec3) -> Result<Vec3> {
        let Some(text) = self.text(name) else {
            return Ok(default);
        };
        let parts: Option<Vec<f32>> = text.split(',').map(|part| part.parse().ok()).collect();
        match parts.as_deref() {
            Some(&[x, y, z]) => Ok(Vec3::new(x, y, z)),
            _ => Err(format!("--{name}: '{text}' is not X,Y,Z").into()),
        }
    }
}

/// Scene of a file, by its name, and angle of its moving solids, from the `scene.json` beside it.
fn scene_of(path: &Path) -> Result<(Scene, f32)> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (name, number) = stem.rsplit_once('_').unwrap_or((&stem, ""));
    let Some(scene) = Scene::named(name) else {
        let known = Scene::NAMES.join(", ");
        return Err(format!("expected a file of {known}, found {}", path.display()).into());
    };
    if scene.hinge.is_none() {
        return Ok((scene, 0.0));
    }
    let json: serde_json::Value =
        serde_json::from_reader(std::fs::File::open(path.with_file_name("scene.json"))?)?;
    let pose = &json["motion"][0]["poses"][number.parse::<usize>()?];
    match (pose[5].as_f64(), pose[6].as_f64()) {
        (Some(sin), Some(cos)) => Ok((scene, 2.0 * sin.atan2(cos) as f32)),
        _ => Err(format!("{}: its frame has no pose in scene.json", path.display()).into()),
    }
}

fn statistics(path: &Path, out: &mut impl Write) -> Result<()> {
    let frame = Frame::read(path)?;
    let (scene, turn) = scene_of(path)?;
    let solids: Vec<_> = scene.posed(turn).into_iter().filter(|s| s.collides).collect();
    writeln!(out, "{}: {}", path.display(), frame.summary())?;
    let bounds = frame
        .positions
        .iter()
        .fold((Vec3::MAX, Vec3::MIN), |(low, high), &at| (low.min(at), high.max(at)));
    writeln!(out, "  from {:.3} to {:.3}", bounds.0, bounds.1)?;
    let mut nearest: Vec<f32> = Vec::new();
    for &at in &frame.positions {
        let distances = solids.iter().map(|solid| solid.distance(at).0);
        nearest.push(distances.fold(f32::MAX, f32::min));
    }
    let inside = nearest.iter().filter(|&&d| d < 0.0).count();
    let lost = frame.positions.iter().filter(|&&at| scene.lost(at)).count();
    let closest = nearest.iter().copied().fold(f32::MAX, f32::min);
    writeln!(out, "  {inside} in solids (closest {closest:.4} m), {lost} outside")?;
    let mut dense = frame.densities.clone();
    dense.sort_by(f32::total_cmp);
    if let Some(last) = dense.len().checked_sub(1) {
        let at = |part: f32| dense[(part * last as f32) as usize];
        let percentiles = [0.01, 0.05, 0.5, 0.95, 0.99, 1.0].map(at);
        writeln!(out, "  density at 1, 5, 50, 95, 99, 100 %: {percentiles:.1?}")?;
    }
    Ok(())
}

fn draw(arguments: &Arguments) -> Result<()> {
    let parallel = arguments.positive("ortho")?;
    let fov = arguments.positive("fov")?;
    if fov.is_some_and(|degrees| degrees >= 180.0) {
        return Err("--fov: less than 180 degrees expected".into());
    }
    for path in &arguments.files {
        let (scene, turn) = scene_of(path)?;
        let camera = preview::Camera {
            eye: arguments.vector("eye", scene.view.eye)?,
            target: arguments.vector("target", scene.view.target)?,
            fov: if parallel.is_some() { 0.0 } else { fov.unwrap_or(scene.fov) },
            width: parallel.unwrap_or(0.0),
        };
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let suffix = arguments.text("suffix").unwrap_or_default();
        let picture = path.with_file_name(format!("{stem}{suffix}.png"));
        let spacing = arguments.positive("spacing")?.unwrap_or(scene.spacing);
        preview::draw(&scene, turn, &Frame::read(path)?, spacing, camera, &picture)?;
        println!("{}", picture.display());
    }
    Ok(())
}

fn run() -> Result<()> {
    let mut words = std::env::args().skip(1);
    match words.next().as_deref() {
        Some("preview") => {
            let known = ["eye", "target", "fov", "ortho", "spacing", "suffix"];
            draw(&Arguments::parse(words, &known)?)
        }
        Some("statistics") => {
            let arguments = Arguments::parse(words, &[])?;
            arguments.files.iter().try_for_each(|path| statistics(path, &mut std::io::stdout()))
        }
        Some("-h" | "--help") => {
            println!("{USAGE}");
            Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(words: &str) -> Result<Arguments> {
        Arguments::parse(words.split(' ').map(str::to_owned), &["eye", "fov"])
    }

    #[test]
    fn what_is_no_number_is_refused() {
        let eye = |text: &str| parse(&format!("a.bgeo --eye {text}"))?.vector("eye", Vec3::ZERO);
        assert_eq!(eye("1,2,3").expect("a vector"), Vec3::new(1.0, 2.0, 3.0));
        for text in ["1,abc,2,3", "1,2", "1,2,3,4", ""] {
            assert!(eye(text).is_err(), "{text}");
        }
        let fov = |text: &str| parse(&format!("a.bgeo --fov {text}"))?.positive("fov");
        assert_eq!(fov("40").expect("a number"), Some(40.0));
        for text in ["0", "-1", "NaN", "inf", "x"] {
            assert!(fov(text).is_err(), "{text}");
        }
        assert!(parse("--fov 40").is_err(), "no file");
    }
}
