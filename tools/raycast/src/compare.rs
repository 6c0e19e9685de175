//! `whitewater-raycast compare`: Table 1 and Fig. 8 of Akinci et al. 2013 for one sea.

use std::path::PathBuf;

use clap::Args as ClapArgs;
use whitewater::ash::vk;
use whitewater::headless::{Background, COLOR_FORMAT, Device, Headless, Picture, Whitewater};
use whitewater::{Camera, Config, Settings as Look};
use whitewater::{Occlusion, WhitewaterConfig};
use whitewater_raycast::{Caster, Input, Method, SceneDepth};
use whitewater_seas::{Foam, Sea};

use crate::picture::{self, mean_flip};
use crate::{Args, Outcome, by_name, line, measure, median, settings};

/// Largest mean FLIP from the converged picture that a chosen step may have.
const TOLERANCE: f32 = 0.02;
/// A picture is converged if halving the step changes it by no more than this mean FLIP.
const CONVERGED: f32 = 0.002;
/// The finest step.
const FINEST: f32 = 1.0 / 32.0;
/// Candidate steps, in radii.
const STEPS: [f32; 14] =
    [16.0, 12.0, 8.0, 6.0, 4.0, 3.0, 2.0, 1.5, 1.0, 0.75, 0.5, 0.25, 0.125, 0.0625];

/// Options of the comparison.
#[derive(ClapArgs)]
pub struct CompareArgs {
    /// Folder for the pictures: whitewater's, the one of each ray-caster at the chosen step, and the converged ones
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
}

/// Foam of a sea, with a view of it.
pub struct Shot {
    sea: Sea,
    foam: Foam,
    radius: f32,
    camera: Camera,
    size: [u32; 2],
}

impl Shot {
    pub fn new(args: &Args) -> Self {
        let Args { sea, particles, size, .. } = *args;
        let [width, height] = size;
        Self {
            sea,
            foam: sea.foam(0..particles, particles),
            radius: sea.radius(particles),
            camera: sea.camera(width as f32 / height as f32),
            size,
        }
    }

    /// Input for the ray-casters.
    pub fn input<'a>(&'a self, scene: &'a SceneDepth) -> Input<'a> {
        Input {
            foam: &self.foam,
            radius: self.radius,
            camera: &self.camera,
            size: self.size,
            scene,
        }
    }

    fn extent(&self) -> vk::Extent2D {
        let [width, height] = self.size;
        vk::Extent2D { width, height }
    }
}

/// Depth of the sea without its foam.
pub fn scene_depth(device: Device, shot: &Shot) -> Outcome<(Device, SceneDepth)> {
    let config = Config::new(shot.extent(), COLOR_FORMAT, 1);
    let mut headless = Headless::new(device, &config).map_err(line)?;
    let mut draw = || {
        headless.particles(&[], None)?;
        headless.scene(&shot.sea.scene(), false)?;
        headless.render(&shot.camera, &Look::default(), &Background::Scene)?;
        SceneDepth::of_device(&shot.camera, &headless.scene_depth()?.data)
    };
    let drawn = draw().map_err(line);
    let device = headless.finish().map_err(line)?;
    Ok((device, drawn?))
}

/// Results of `whitewater`.
struct Ours {
    times: Vec<(&'static str, f64)>,
    intensity: Picture<f32>,
    scene: SceneDepth,
}

/// Limit of a ray-caster's picture as its step shrinks.
struct Converged {
    step: f32,
    picture: Picture<f32>,
    /// Mean FLIP between `whitewater`'s picture and this one.
    ours: f32,
}

/// Results of a ray-caster at one step.
struct Cast {
    step: f32,
    /// Mean FLIP from the converged picture.
    flip: f32,
    picture: Picture<f32>,
    times: Vec<(&'static str, f64)>,
    memory: u64,
    chunks: usize,
}

/// Suffixes of the two rows per ray-caster: within [`TOLERANCE`] of its converged picture, and as near to it as
/// `whitewater`'s picture.
const NEARNESSES: [&str; 2] = ["", ", equal"];

pub fn run(args: &Args, how: &CompareArgs) -> Outcome<()> {
    let [width, height] = args.size;
    let shot = Shot::new(args);
    let (device, ours) = draw_ours(crate::device(args)?, &shot, args.repeat)?;
    println!(
        "{}: {}, {} particles, {width}x{height}",
        device.adapter,
        args.sea.name(),
        args.particles
    );
    println!(
        "{:<32} {:>6} {:>10} {:>9} {:>9} {:>7} {:>9}  passes, ms",
        "", "step", "ms", "intensity", "total", "FLIP", "MiB"
    );
    if let Some(folder) = &how.pictures {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        picture::write(&folder.join("ours.png"), &ours.intensity)?;
    }
    let of = |names: &[&str]| -> Vec<_> {
        ours.times.iter().filter(|(name, _)| names.contains(name)).copied().collect()
    };
    let (intensity, total) = (of(&["splat"]), of(&["splat", "radiance", "blur", "composite"]));
    let sums = [sum(&intensity), sum(&total)];
    // The plain ray-caster has the same samples as the kernel one, so its pictures and steps are the same.
    let mut steps = [0.0; 2];
    let mut apart = Vec::new();
    for method in Method::ALL {
        let casting = Casting { device: &device, method, shot: &shot, scene: &ours.scene, args };
        let casts = if method == Method::Plain {
            let (_, Converged { picture, .. }) = apart.first().ok_or("no kernels")?;
            steps.map(|step| casting.at(step, picture))
        } else {
            let converged = casting.converged(&ours.intensity)?;
            // The second limit is `whitewater`'s own distance, but no less than the distance at which pictures count as
            // converged.
            let most = [TOLERANCE, converged.ours.max(CONVERGED)];
            let casts = most.map(|most| casting.coarsest(most, &converged.picture));
            apart.push((method, converged));
            casts
        };
        for (i, (cast, nearness)) in casts.into_iter().zip(NEARNESSES).enumerate() {
            let cast = cast?;
            let chunks = if cast.chunks > 1 { format!(" x{}", cast.chunks) } else { String::new() };
            let name = format!("ray-casting, {}{nearness}{chunks}", method.name());
            row(&name, Some(&cast), &cast.times, sums);
            if method == Method::Kernel {
                steps[i] = cast.step;
            }
            if let (Some(folder), 0) = (&how.pictures, i) {
                picture::write(&folder.join(format!("{}-step.png", method.name())), &cast.picture)?;
            }
        }
    }
    row("ours, intensity only", None, &intensity, sums);
    row("ours, total (fast shadow)", None, &total, sums);
    for (method, Converged { step, picture, ours }) in &apart {
        println!("ours and {} at its finest (step {step}): mean FLIP {ours:.4}", method.name());
        if let Some(folder) = &how.pictures {
            picture::write(&folder.join(format!("{}-converged.png", method.name())), picture)?;
        }
    }
    Ok(())
}

fn sum(times: &[(&'static str, f64)]) -> f64 {
    times.iter().map(|(_, ms)| ms).sum()
}

/// Prints a row of the table, with the ratios to the time of `whitewater`'s intensity alone and of its whole foam.
fn row(name: &str, cast: Option<&Cast>, times: &[(&'static str, f64)], ours: [f64; 2]) {
    let all = sum(times);
    let [intensity, total] = ours.map(|ms| all / ms);
    let passes: Vec<_> = times.iter().map(|(name, ms)| format!("{name} {ms:.1}")).collect();
    let [step, flip, memory] = match cast {
        Some(cast) => [
            format!("{}", cast.step),
            format!("{:.4}", cast.flip),
            format!("{:.1}", cast.memory as f64 / f64::from(1 << 20)),
        ],
        None => [const { String::new() }; 3],
    };
    println!(
        "{name:<32} {step:>6} {all:>10.2} {intensity:>8.2}x {total:>8.2}x {flip:>7} {memory:>9}  {}",
        passes.join(", ")
    );
}

fn draw_ours(device: Device, shot: &Shot, repeat: u32) -> Outcome<(Device, Ours)> {
    let count = shot.foam.positions.len() as u32;
    let whitewater = WhitewaterConfig::new(count.max(1)).with(|it| it.occlusion = Occlusion::Fast);
    let config =
        Config::new(shot.extent(), COLOR_FORMAT, 1024).with(|it| it.whitewater = Some(whitewater));
    let mut headless = Headless::new(device, &config).map_err(line)?;
    let mut draw = || {
        headless.particles(&[], None)?;
        headless.scene(&shot.sea.scene(), false)?;
        headless.whitewater(Some(&Whitewater {
            positions: &shot.foam.positions,
            kinds: Some(&shot.foam.kinds),
            radii: None,
            ages: Some(&shot.foam.ages),
            ids: Some(&shot.foam.ids),
        }))?;
        let mut look = Look::default();
        look.whitewater.radius = shot.radius;
        let mut frames = Vec::new();
        for frame in 0..=repeat {
            headless.render(&shot.camera, &look, &Background::Scene)?;
            if frame > 0 {
                frames.push(by_name(&headless.timings()));
            }
        }
        let intensity = headless.layer("whitewater.intensity")?;
        let depth = headless.scene_depth()?;
        Ok((frames, intensity, SceneDepth::of_device(&shot.camera, &depth.data)?))
    };
    let drawn = draw().map_err(line);
    let device = headless.finish().map_err(line)?;
    let (frames, intensity, scene) = drawn?;
    let intensity = intensity.ok_or("whitewater kept no layer whitewater.intensity")?;
    Ok((device, Ours { times: median(frames), intensity, scene }))
}

/// A ray-caster of one sea, at any step.
struct Casting<'a> {
    device: &'a Device,
    method: Method,
    shot: &'a Shot,
    scene: &'a SceneDepth,
    args: &'a Args,
}

impl Casting<'_> {
    fn make(&self, step: f32) -> Outcome<Caster<'_>> {
        let settings = settings(self.args, step);
        Caster::new(self.device, self.method, &self.shot.input(self.scene), &settings).map_err(line)
    }

    fn draw(&self, step: f32) -> Outcome<Picture<f32>> {
        let caster = self.make(step)?;
        caster.draw().map_err(line)?;
        caster.intensity().map_err(line)
    }

    fn converged(&self, ours: &Picture<f32>) -> Outcome<Converged> {
        let mut step = 0.5;
        let mut finer = self.draw(step)?;
        loop {
            step *= 0.5;
            let coarser = std::mem::replace(&mut finer, self.draw(step)?);
            let change = mean_flip(&coarser, &finer);
            if change <= CONVERGED {
                break;
            }
            if step <= FINEST {
                let name = self.method.name();
                println!("{name}: not converged; its last halving changed it by FLIP {change:.4}");
                break;
            }
        }
        Ok(Converged { step, ours: mean_flip(ours, &finer), picture: finer })
    }

    /// Measures the coarsest step whose picture is within a mean FLIP of `most` from the converged one.
    fn coarsest(&self, most: f32, converged: &Picture<f32>) -> Outcome<Cast> {
        for step in STEPS {
            if mean_flip(&self.draw(step)?, converged) <= most {
                return self.at(step, converged);
            }
        }
        Err(format!(
            "{}: no step is within FLIP {most} of the converged picture",
            self.method.name()
        ))
    }

    fn at(&self, step: f32, converged: &Picture<f32>) -> Outcome<Cast> {
        let caster = self.make(step)?;
        let times = measure(&caster, self.args.repeat)?;
        let picture = caster.intensity().map_err(line)?;
        Ok(Cast {
            step,
            flip: mean_flip(&picture, converged),
            picture,
            times,
            memory: caster.memory(),
            chunks: caster.chunk_count(),
        })
    }
}
