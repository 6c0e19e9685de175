//! `whitewater simulate`: simulates the particles of a scene.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use whitewater::io::particles::sequence;
use whitewater_simulate::{REST_DENSITY, Scene, Simulation, scene};

use crate::args::SimulateArgs;
use crate::failure::{Failure, Kind, Outcome};
use crate::output;
use crate::progress::Progress;

pub fn run(args: &SimulateArgs) -> Outcome<()> {
    let range = |text: &str| -> Outcome<_> {
        let range = sequence::parse_range(text)?;
        match (u32::try_from(*range.start()), u32::try_from(*range.end())) {
            (Ok(first), Ok(last)) => Ok(first..=last),
            _ => Err(Failure::usage(format!("expected frames below 2^32, found {text}"))),
        }
    };
    let frames = range(&args.frames)?;
    let keep = args.keep.as_deref().map(range).transpose()?.unwrap_or_else(|| frames.clone());
    if frames.start().max(keep.start()) > frames.end().min(keep.end()) {
        let kept = args.keep.as_deref().unwrap_or_default();
        return Err(Failure::usage(format!(
            "--keep: expected some of the frames {}, found {kept}",
            args.frames
        )));
    }
    let scene = Scene::named(&args.scene)
        .ok_or_else(|| Failure::usage(format!("no scene is named {}", args.scene)))?;
    let spacing = args.spacing.unwrap_or(scene.spacing);
    let [least, most] = scene.spacings;
    if !(least..=most).contains(&spacing) {
        return Err(Failure::usage(format!(
            "expected a --spacing from {least} to {most} for {}, found {spacing}",
            scene.name
        )));
    }
    let threads = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build();
    let threads = threads.map_err(|error| {
        Failure::new(Kind::Usage, format!("cannot start threads: {error}; try fewer --threads"))
    })?;
    std::fs::create_dir_all(&args.out).map_err(|error| Failure::writing(&args.out, &error))?;

    let (first, last) = (*frames.start(), *frames.end());
    let camera = scene.camera_json(first, last);
    text(&args.out.join("camera.json"), &scene::text(&camera))?;
    let name = scene.name;
    threads.install(|| {
        let mut simulation = Simulation::new(scene, spacing, args.seed);
        let mut turns = Vec::new();
        let mut progress = Progress::new(last as usize + 1, "frames");
        for number in 0..=last {
            let began = Instant::now();
            simulation.advance_to(number as f32 / args.fps);
            turns.push(simulation.turn());
            let frame = simulation.frame();
            if frames.contains(&number) && keep.contains(&number) {
                // Moving parts have a pose for every frame of the scene, even if the run ends earlier.
                let json = simulation.scene().to_json(spacing, REST_DENSITY, &turns);
                text(&args.out.join("scene.json"), &scene::text(&json))?;
                let path = args.out.join(format!("{name}_{number:04}.bgeo"));
                output::write(&path, |to| frame.write(to))?;
            }
            progress.advance(&format!(
                "frame {number}: {}, {} lost, {:.2} s",
                frame.summary(),
                simulation.lost(),
                began.elapsed().as_secs_f32()
            ));
        }
        progress.finish();
        Ok(())
    })
}

fn text(path: &Path, content: &str) -> Outcome<()> {
    output::write(path, |to| to.write_all(content.as_bytes()))
}
