//! `whitewater-raycast`: draws foam by volume ray-casting, and compares its cost with `whitewater`'s.
//!
//! ```sh
//! whitewater-raycast --particles 800000 --method grid --step 1 -o foam.png --timings
//! whitewater-raycast compare --particles 800000
//! ```

mod compare;
mod picture;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use whitewater::headless::{Device, DeviceOptions};
use whitewater::{Error, Timing};
use whitewater_raycast::{Caster, Method, Settings};
use whitewater_seas::Sea;

/// Result of everything here: an error is a line for the user.
type Outcome<T> = Result<T, String>;

/// Draws foam by volume ray-casting (emission and absorption only)
#[derive(Parser)]
#[command(version)]
struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    /// Sea whose foam is drawn
    #[arg(long, value_name = "SEA", default_value = "wave", value_parser = sea, global = true)]
    sea: Sea,
    /// Number of particles
    #[arg(long, value_name = "N", default_value_t = 100_000, global = true)]
    particles: u32,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "800x600", value_parser = size, global = true)]
    size: [u32; 2],
    /// Part of the name of the GPU to use
    #[arg(long, value_name = "NAME", global = true)]
    device: Option<String>,
    /// Edge of a tile in pixels: 4, 8 or 16 [default: the fastest measured]
    #[arg(long, value_name = "PIXELS", global = true)]
    tile: Option<u32>,
    /// Edge of a cell of the plain ray-caster in radii, 1 to 16 [default: the fastest measured]
    #[arg(long, value_name = "RADII", global = true)]
    cell: Option<f32>,
    /// Number of frames to time; the median is printed
    #[arg(long, value_name = "N", default_value_t = 5, global = true,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,
    /// Ray-casting method [default: kernel]
    #[arg(long, value_enum)]
    method: Option<MethodArg>,
    /// Distance between a ray's samples in particle radii [default: 0.5]
    #[arg(long, value_name = "RADII")]
    step: Option<f32>,
    /// Align all samples, instead of shifting them from pixel to pixel
    #[arg(long, global = true)]
    even: bool,
    /// Write the intensity as a grey picture
    #[arg(short, long, value_name = "OUT.png")]
    output: Option<PathBuf>,
    /// Print the time of each pass
    #[arg(long)]
    timings: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Time all ray-casters and whitewater, at the coarsest steps that look converged, and at those as near to
    /// convergence as whitewater
    Compare(compare::CompareArgs),
}

#[derive(Clone, Copy, ValueEnum)]
enum MethodArg {
    /// Sum kernels at each sample, found by screen-space lists
    Kernel,
    /// March through a density grid that is aligned with the view
    Grid,
    /// Sum kernels at each sample, found by searching the surrounding cells
    Plain,
}

fn sea(text: &str) -> Result<Sea, String> {
    let names = Sea::ALL.map(Sea::name).join(", ");
    Sea::from_name(text).ok_or_else(|| format!("expected one of {names}"))
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    match parsed {
        Some([w, h]) if w > 0 && h > 0 => Ok([w, h]),
        _ => Err("expected width and height as in 800x600".into()),
    }
}

fn main() -> ExitCode {
    let args = Args::parse();
    let result = match &args.command {
        Some(Command::Compare(how)) => {
            if args.method.is_some() || args.step.is_some() || args.output.is_some() || args.timings
            {
                let message = "compare takes no --method, --step, --output or --timings\n";
                Args::command().error(ErrorKind::ArgumentConflict, message).exit();
            }
            compare::run(&args, how)
        }
        None => draw(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("raycast: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Line for the user. A bad value on the command line instead ends the program with exit code 2, as clap does.
fn line(error: Error) -> String {
    let option = |field: &str| match field {
        "Settings.step" => Some("--step"),
        "Settings.tile" => Some("--tile"),
        "Settings.cell" => Some("--cell"),
        "Input.size" | "Config.extent" => Some("--size"),
        _ => None,
    };
    match &error {
        Error::BadInput { field, why } => match option(field) {
            Some(option) => {
                let message = format!("{option}: {why}\n");
                Args::command().error(ErrorKind::ValueValidation, message).exit()
            }
            None => error.to_string(),
        },
        error => error.to_string(),
    }
}

fn device(args: &Args) -> Outcome<Device> {
    let options = DeviceOptions { name: args.device.clone(), ..DeviceOptions::default() };
    Device::new(&options).map_err(line)
}

fn settings(args: &Args, step: f32) -> Settings {
    let Args { even, tile, cell, .. } = *args;
    Settings { step, shifted: !even, tile, cell, ..Settings::default() }
}

fn draw(args: &Args) -> Outcome<()> {
    if args.output.is_none() && !args.timings {
        let message = "nothing to do: give -o OUT.png, or --timings, or both\n";
        Args::command().error(ErrorKind::MissingRequiredArgument, message).exit();
    }
    let method = match args.method.unwrap_or(MethodArg::Kernel) {
        MethodArg::Kernel => Method::Kernel,
        MethodArg::Grid => Method::Grid,
        MethodArg::Plain => Method::Plain,
    };
    let [width, height] = args.size;
    let step = args.step.unwrap_or(0.5);
    let settings = settings(args, step);
    let shot = compare::Shot::new(args);
    let (device, scene) = compare::scene_depth(device(args)?, &shot)?;
    let input = shot.input(&scene);
    let caster = Caster::new(&device, method, &input, &settings).map_err(line)?;
    let times = measure(&caster, if args.timings { args.repeat } else { 1 })?;
    if args.timings {
        println!(
            "{}: {}, {} particles, {width}x{height}",
            device.adapter,
            args.sea.name(),
            args.particles
        );
        println!("{} at a step of {step} radii:", method.name());
        for (name, ms) in &times {
            println!("{name:<12} {ms:>10.3} ms");
        }
        let all: f64 = times.iter().map(|(_, ms)| ms).sum();
        println!("{:<12} {all:>10.3} ms", "all");
        let mebibytes = caster.memory() as f64 / f64::from(1 << 20);
        println!("{:<12} {mebibytes:>10.1} MiB in {} chunk(s)", "memory", caster.chunk_count());
    }
    if let Some(path) = &args.output {
        let intensity = caster.intensity().map_err(line)?;
        picture::write(path, &intensity)?;
    }
    Ok(())
}

/// Times of a frame's passes in milliseconds, by name and in their order. Draws `repeat` frames after a warm-up frame,
/// and returns those of the median frame.
fn measure(caster: &Caster<'_>, repeat: u32) -> Outcome<Vec<(&'static str, f64)>> {
    caster.draw().map_err(line)?;
    let mut frames = Vec::new();
    for _ in 0..repeat {
        frames.push(by_name(&caster.draw().map_err(line)?));
    }
    Ok(median(frames))
}

/// Sums the times of each pass.
fn by_name(timings: &[Timing]) -> Vec<(&'static str, f64)> {
    let mut sums: Vec<(&'static str, f64)> = Vec::new();
    for timing in timings {
        let ms = timing.nanoseconds * 1.0e-6;
        match sums.iter_mut().find(|(name, _)| *name == timing.name) {
            Some((_, sum)) => *sum += ms,
            None => sums.push((timing.name, ms)),
        }
    }
    sums
}

/// The frame with the median of the total times.
fn median(mut frames: Vec<Vec<(&'static str, f64)>>) -> Vec<(&'static str, f64)> {
    let sum = |frame: &[(&str, f64)]| frame.iter().map(|(_, ms)| ms).sum::<f64>();
    frames.sort_by(|a, b| sum(a).total_cmp(&sum(b)));
    let middle = frames.len() / 2;
    frames.into_iter().nth(middle).unwrap_or_default()
}
