//! `whitewater render`: particle files to pictures, one or a sequence.

use whitewater::Settings;
use whitewater::io::particles;
use whitewater::io::particles::sequence::{self, Frame};

use crate::args::{Foaming, Radius, RenderArgs, Unit, Up, Whitewater};
use crate::bubbles::{self, Blobs};
use crate::camera::{CameraFile, Turn};
use crate::failure::{Failure, Kind, Outcome};
use crate::fluids::Fluids;
use crate::frames;
use crate::looks::{Found, Sequence, look, round};
use crate::output;
use crate::placing::Placing;
use crate::probes::{self, Probes, step_of};
use crate::progress::Progress;
use crate::radii;
use crate::reader::{DEFAULT_FPS, Reader};
use crate::session::{self, Look, Session};
use crate::settings::SettingsFile;
use crate::shore::{self, Shores};
use crate::turntable::{Turning, stills, stills_fps};
use crate::upright::{self, Found as Upright};
use crate::whitewater_source;
use crate::written;

pub fn run(args: &RenderArgs) -> Outcome<()> {
    if args.inputs.is_empty() {
        refuse_options_of_particles(args)?;
    }
    let bubbles = match &args.bubbles {
        Some(bubbles::Which::File(path)) => Some(path.as_path()),
        _ => None,
    };
    let shore = match &args.shore {
        Some(shore::Which::File(path)) => Some(path.as_path()),
        _ => None,
    };
    let (camera, scene) = (args.camera.file.as_deref(), args.scene.as_deref());
    written::check_pictures(&args.draw, &[camera, scene, bubbles, shore])?;
    if let Some(which) = &args.shore {
        return shore::run(args, which);
    }
    let foam = match &args.bubbles {
        Some(which) if args.inputs.is_empty() => return bubbles::run(args, which),
        Some(bubbles::Which::File(path)) => {
            let (blobs, moves) = bubbles::read(path)?;
            if moves {
                let why = "a file of moving blobs cannot be drawn together with particles";
                return Err(Failure::input(format!("{}: {why}", path.display())));
            }
            Some(blobs)
        }
        Some(_) => {
            let why = "--bubbles: expected a file with particle inputs; one, slope and box are scenes of their own";
            return Err(Failure::usage(why));
        }
        None => None,
    };
    let range = args.frames.as_deref().map(sequence::parse_range).transpose()?;
    let mut all = frames::expand(&args.inputs, args.join)?;
    let (fluids, said_of_fluids) = Fluids::find(&args.fluids, &mut all)?;
    let frames = frames::within(&all, range)?;
    let frames: Vec<Frame> = frames.into_iter().step_by(args.every.get()).collect();
    // A turntable draws one file as often as an orbit has frames.
    let still = args.turntable.filter(|_| all.len() == 1 && !frames.is_empty());
    let frames = match still {
        Some(turntable) => stills(&all[0], turntable, stills_fps(args))?,
        None => frames,
    };
    let checked = session::check(&args.draw, all.len() > 1 || still.is_some())?;
    let keep = args.write_whitewater.as_deref();
    let keep = keep.map(|file| output::Target::of_particles(file, all.len() > 1)).transpose()?;
    if keep.is_some() && args.whitewater != [Whitewater::Generate] {
        let why = "--write-whitewater: expected --whitewater generate as well; nothing is emitted without it";
        return Err(Failure::usage(why));
    }
    keep_inputs(args, &all, keep.as_ref())?;
    let settings = SettingsFile::of_args(&args.draw)?;
    let environment = session::environment(&args.draw, None)?;
    let mut camera = CameraFile::from_args(&args.camera)?;
    let turning = Turning::new(args, &frames, still.is_some());
    if let Some(camera) = &camera {
        if turning.is_some() {
            camera.clone().turned(Turn { first: 0, frames: 1.0 })?;
        }
        camera.check(frames.iter().map(|f| f.number), args.draw.size)?;
    }
    let first = frames.first().map_or(0, |f| f.number);
    for path in checked.0.iter().map(|t| t.path(first)).chain(keep.iter().map(|t| t.path(first))) {
        output::probe(&path)?;
    }
    let drawn = if still.is_some() { &frames } else { &all };
    let numbers: Vec<u64> = drawn.iter().map(|frame| frame.number).collect();
    let finished = |frame: &Frame| {
        session::is_finished(&args.draw, &checked.0, frame.number)
            && keep.iter().all(|target| target.is_written(frame.number))
    };
    let (done, left): (Vec<Frame>, Vec<Frame>) = frames.into_iter().partition(finished);
    let mut progress = Progress::new(left.len(), "frames");
    progress.skipped(done.len());
    if left.is_empty() {
        return Ok(());
    }
    said_of_fluids.iter().for_each(|line| progress.say(line));
    let steps = progress.steps();
    let steps_of = |frames: &[Frame]| match frames {
        [first, .., last] => (last.number - first.number) as f32 / (frames.len() - 1) as f32,
        _ => 1.0,
    };
    let sequence = Sequence {
        is: all.len() > 1,
        motion: session::has_motion(&checked),
        film: session::has_film(&checked.0).then(|| steps_of(&left).max(1.0)),
        turning,
        still: still.and(all.first()).map(|frame| frame.number),
        said: args.fps.map(|fps| fps * step_of(&all)),
        step: step_of(&all),
    };
    let made = args.whitewater == [Whitewater::Generate];
    let foams = args.draw.surface_foam.unwrap_or(Foaming::Auto) != Foaming::None;
    let blurs = args.draw.shutter.is_some_and(|seconds| seconds > 0.0);
    let moving = made || foams || blurs || sequence.motion;
    // Frame numbers may be step numbers; the rate is in numbers per second.
    let step = step_of(&all);
    let said = args.fps.map(|fps| fps * step);
    let fps = moving.then(|| said.unwrap_or(DEFAULT_FPS * step));
    let scale = args.unit.map(Unit::metres).or(args.scale).unwrap_or(1.0);
    let up = args.up_axis.unwrap_or(Up::Y);
    let mut placing = Placing { up, scale, ..Placing::default() };
    let mut reader = Reader::new(&all, placing, (&args.conditions, &fluids), fps);
    match &args.radius {
        Some(Radius::Of(name)) => reader.take_radii(name),
        Some(Radius::Metres(_)) => reader.alike(),
        None => {}
    }
    let by_time = if args.fps.is_none() { probes::by_time(&reader, &all) } else { None };
    by_time.into_iter().for_each(|rate| reader.set_rate(rate));
    let mut probes = steps.during("reading", || Probes::read(&mut reader, &all, &left))?;
    placing.origin = reader.origin();
    let found = upright::find(&probes.frames, probes.extents());
    let particles = probes.frames.iter().any(|frame| frame.positions.len() > 1);
    // A user who gives a camera knows the up axis.
    if args.up_axis.is_none() && found.is_none() && camera.is_none() && particles {
        progress.say(
            "up is a guess: y, because neither where the water lies nor how it moves shows it (--up-axis z, -y etc. set it)",
        );
    }
    let found = found.filter(|found| found.up != Up::Y);
    if let (None, Some(Upright { up, why, .. })) = (args.up_axis, found) {
        progress.say(&format!(
            "{} is up in the files: {why} (--up-axis y keeps them unrotated)",
            up.name()
        ));
        placing.up = up;
        reader.turn(up);
        probes.place(Placing { up, scale: 1.0, origin: placing.origin });
    }
    let sheet = upright::flat(probes.extents()).filter(|across| *across != 1);
    if sheet.is_some() {
        progress.say("the particles are two-dimensional: drawn as a sheet one spacing thick, seen from the front");
    }
    if args.unit.is_none() && args.scale.is_none() {
        probes.unit_hint().iter().for_each(|line| progress.say(line));
    }
    if reader.found_velocities && !probes.own.velocities {
        progress.say(
            "velocities are not in the files; they are found from the positions in neighbouring frames",
        );
    }
    fluids.missing(&probes.frames).iter().for_each(|line| progress.say(line));
    if !probes.frames.is_empty() && probes.frames.iter().all(|frame| frame.positions.is_empty()) {
        progress.say("no particles in the probed frames: the scene is drawn without water");
    }
    if made || foams {
        probes.missing(all.len()).into_iter().for_each(|line| progress.say(&line));
    }
    reader.expected = probes.own;
    reader.usual = probes.usual();
    probes.in_another_unit(&left).iter().for_each(|line| progress.say(line));
    if let (None, Some(found)) = (args.fps, probes.fps) {
        reader.set_rate(found);
    }
    let settings_of_bubbles = settings.bubbles.config();
    let shores = Shores::of_particles(&settings)?;
    if settings_of_bubbles.crossfade && (foam.is_some() || args.whitewater.is_empty()) {
        let why = "--settings, [bubbles] crossfade turns whitewater particles into blobs: expected --whitewater and no \
                   --bubbles";
        return Err(Failure::usage(why));
    }
    let single = all.first().filter(|_| all.len() == 1).map(|frame| frame.number);
    let files = if made { &[][..] } else { &args.whitewater };
    let spacing = spacing(args, (&probes, &reader), &settings, &progress);
    let files = steps
        .during("reading", || whitewater_source::Files::find(files, placing, single, spacing))?;
    if let Some(files) = &files {
        let numbers: Vec<_> = all.iter().map(|f| f.number).collect();
        files.missing(&numbers)?.iter().for_each(|line| progress.say(line));
    }
    if let (Some(camera), true) = (&mut camera, args.camera.eye.is_some())
        && let Some(eye) = camera.eye.and_then(|eye| placing.moved(eye))
    {
        camera.eye = Some(eye);
        camera.target = camera.target.map(|target| placing.moved(target).unwrap_or(target));
        progress.say("--eye and --target are read in the files' coordinates, far from the origin");
    }
    let found = Found { camera, spacing, files, sheet };
    // Estimated densities use one rest density for all fluids.
    let told = probes.own.densities && settings.water.rest_density.is_none();
    let own_densities: Vec<Option<f32>> = (0..fluids.count())
        .map(|fluid| probes.rest_density_of((fluid, fluids.count())).filter(|_| told))
        .collect();
    let look = steps.during("finding camera and light", || {
        look(args, sequence, &mut probes, found, settings, environment, &progress)
    })?;
    let foam = match foam {
        None if settings_of_bubbles.crossfade => Some(Vec::new()),
        foam => foam,
    };
    let foam = foam.map(|blobs| (Blobs { blobs, motion: None }, settings_of_bubbles));
    let several = fluids.settings(&look.settings, &look.file, &own_densities)?;
    let mut look = Look { fluids: several, bubbles: foam, shores, ..look };
    if fluids.drawn() > 1 {
        // At the surface between two liquids light passes into the other liquid, not into air. With the refraction
        // and reflection of a surface to air, the other liquid would look as if seen through rough glass.
        look.file.water.leave_straight();
    }
    let mut session = Session::new(&args.draw, checked, look, steps)?;
    session.keep = keep;
    session.placing = placing;
    session.fluids = made.then_some((&fluids, own_densities));
    let mut failed: Vec<(u64, Failure)> = Vec::new();
    let mut warnings = Warnings::default();
    for frame in &left {
        let before = numbers.iter().copied().filter(|number| *number < frame.number).max();
        let said = (&progress, &mut warnings);
        match draw(&mut reader, &mut session, &all, (frame, before), said) {
            Ok(line) => progress.advance(&line),
            Err(failure) if failure.kind == Kind::Input => {
                progress.advance(&format!("frame {}: {}", frame.number, failure.message));
                failed.push((frame.number, failure));
            }
            Err(failure) => {
                progress.finish();
                // Measurements so far are kept if possible.
                let _ = session.finish();
                return Err(failure);
            }
        }
    }
    progress.finish();
    warnings.again(left.len()).iter().for_each(|line| progress.say(line));
    session.finish()?;
    report(left.len(), failed)
}

/// Fails if measurements or whitewater would be written over particle files.
fn keep_inputs(
    args: &RenderArgs,
    all: &[Frame],
    keep: Option<&output::Target<particles::WriteFormat>>,
) -> Outcome<()> {
    let of = |keep: &output::Target<_>| all.iter().map(|f| keep.path(f.number)).collect::<Vec<_>>();
    let made = keep.map(of).unwrap_or_default().into_iter();
    let made = made.map(|path| ("--write-whitewater", path));
    let mut frames = all.to_vec();
    for named in &args.whitewater {
        if let Whitewater::Files { files, .. } = named {
            frames.extend(frames::files(std::slice::from_ref(files), false)?);
        }
    }
    let read = frames.iter().flat_map(|frame| frame.paths());
    written::check(made.chain(written::measured(&args.draw)), read)
}

/// Fails if options are given that a scene without particles would ignore.
fn refuse_options_of_particles(args: &RenderArgs) -> Outcome<()> {
    let found = if args.shore.is_some() { "--shore" } else { "--bubbles" };
    let given = [
        ("--turntable", args.turntable.is_some()),
        ("--radius", args.radius.is_some()),
        ("--whitewater", !args.whitewater.is_empty()),
        ("--write-whitewater", args.write_whitewater.is_some()),
        ("--join", args.join),
        ("--up-axis", args.up_axis.is_some()),
        ("--where", !args.conditions.is_empty()),
        ("--unit", args.unit.is_some()),
        ("--scale", args.scale.is_some()),
        ("--set", args.set.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some((flag, _)) => {
            Err(Failure::usage(format!("{flag}: expected particle files, found {found} alone")))
        }
        None => Ok(()),
    }
}

/// Reads one frame, draws it and writes its files. `before` is the number of the frame before it.
fn draw(
    reader: &mut Reader<'_>,
    session: &mut Session<'_>,
    all: &[Frame],
    (frame, before): (&Frame, Option<u64>),
    (progress, warnings): (&Progress, &mut Warnings),
) -> Outcome<String> {
    let began = std::time::Instant::now();
    let number = frame.number;
    let particles = session.times.step("read", number, || reader.read(frame))?;
    for warning in &particles.warnings {
        if let Some(line) = warnings.first(&frame.path.display().to_string(), warning) {
            progress.say(&line);
        }
    }
    if session.remembers() {
        let whitewater = session.open_whitewater(number)?;
        remember(reader, session, all, frame, (particles.positions.len(), whitewater))?;
    }
    session.frame(number, before, &frame.path.display().to_string(), &particles)?;
    let paths: Vec<_> = session.paths(number).iter().map(|p| p.display().to_string()).collect();
    let made = session.made()?.map(|made| made as usize).or(session.read);
    let made = made.map_or(String::new(), |made| format!(", {made} whitewater particles"));
    Ok(format!(
        "frame {number}: {} particles{made}, {:.2} s, {}",
        particles.positions.len(),
        began.elapsed().as_secs_f32(),
        paths.join(" and ")
    ))
}

/// Warnings about frames. Of warnings that differ only in their numbers, the first is printed.
#[derive(Default)]
struct Warnings(Vec<Warning>);

struct Warning {
    /// The text without its numbers.
    kind: String,
    file: String,
    text: String,
    frames: usize,
}

impl Warnings {
    /// The line to print; `None` if it was printed for another frame.
    fn first(&mut self, file: &str, text: &str) -> Option<String> {
        let kind: String = text.chars().filter(|c| !c.is_ascii_digit()).collect();
        if let Some(known) = self.0.iter_mut().find(|known| known.kind == kind) {
            known.frames += 1;
            return None;
        }
        self.0.push(Warning { kind, file: file.into(), text: text.into(), frames: 1 });
        Some(format!("{file}: {text}"))
    }

    /// One line for each warning that came up in several frames, with the number of these frames.
    fn again(&self, total: usize) -> Vec<String> {
        let repeated = self.0.iter().filter(|warning| warning.frames > 1);
        let line = |Warning { file, text, frames, .. }: &Warning| {
            let start: Vec<_> = text.split(' ').take(8).collect();
            format!(
                "warning in {frames} of {total} frames, first in {file}: {} ...",
                start.join(" ")
            )
        };
        repeated.map(line).collect()
    }
}

/// Runs the foam simulation over all frames of the sequence that are before `frame` and that it has not simulated
/// yet, so that the result does not depend on which range of frames is drawn. Frames that cannot be read are skipped.
/// `room` and `whitewater` are the numbers of particles that `frame` needs room for, of water and of whitewater files.
fn remember(
    reader: &mut Reader<'_>,
    session: &mut Session<'_>,
    all: &[Frame],
    frame: &Frame,
    (mut room, whitewater): (usize, usize),
) -> Outcome<()> {
    loop {
        if session.make_room(room, whitewater)? {
            session.times.say(&format!(
                "frame {}: the earlier frames are stepped through again, because this frame or one of them has many \
                 more particles than the probed frames",
                frame.number
            ));
        }
        let next = |f: &&Frame| {
            f.number < frame.number && session.passed().is_none_or(|last| f.number > last)
        };
        let Some(next) = all.iter().find(next) else { return Ok(()) };
        match reader.read(next) {
            // A new renderer with more room starts without foam.
            Ok(particles) if particles.positions.len() > session.room() => {
                room = particles.positions.len();
            }
            Ok(particles) => session.pass(next.number, &particles)?,
            Err(_) => session.skip(next.number),
        }
    }
}

/// The result of a run in which all frames were processed.
fn report(total: usize, failed: Vec<(u64, Failure)>) -> Outcome<()> {
    match failed.as_slice() {
        [] => Ok(()),
        [(_, only)] if total == 1 => Err(only.clone()),
        [(_, first), ..] if failed.len() == total => Err(Failure::new(
            first.kind,
            format!("none of {total} frames could be drawn; the first: {}", first.message),
        )),
        some => {
            let list: Vec<_> = some.iter().map(|(n, f)| format!("{n} ({})", f.message)).collect();
            Err(Failure::new(
                Kind::Partly,
                format!("{} of {total} frames failed: {}", some.len(), list.join("; ")),
            ))
        }
    }
}

/// The rest spacing: given by the user, or found.
fn spacing(
    args: &RenderArgs,
    (probes, reader): (&Probes, &Reader<'_>),
    file: &SettingsFile,
    progress: &Progress,
) -> f32 {
    match (&args.radius, file.water.spacing) {
        (Some(Radius::Metres(radius)), _) => 2.0 * radius,
        (None, Some(spacing)) => spacing,
        _ if reader.radii.is_some() => {
            let [least, middle, most] = reader.radii.unwrap_or_default();
            let radius = reader.base().unwrap_or(middle);
            let differ = if most > 1.1 * least {
                let how = match reader.base() {
                    Some(_) => "larger particles are drawn as several of this radius",
                    None => "all are drawn alike",
                };
                format!("; they go from {} to {}, and {how}", round(least), round(most))
            } else {
                String::new()
            };
            let of = match (&args.radius, reader.radii_name()) {
                (Some(Radius::Of(name)), _) => format!("attribute `{name}` of the files"),
                (_, Some(name)) => {
                    format!("attribute `{name}` of the files, which fits their spacing")
                }
                _ => "of the files".into(),
            };
            progress.say(&format!("radius {} ({of}{differ}; --radius sets it)", round(radius)));
            let misfit = probes.spacing().and_then(|spacing| radii::misfit(middle, spacing));
            misfit.iter().for_each(|told| progress.say(told));
            2.0 * radius
        }
        _ => match probes.spacing() {
            Some(spacing) => {
                progress
                    .say(&format!("radius {} (estimated; --radius sets it)", round(0.5 * spacing)));
                spacing
            }
            None => {
                let spacing = Settings::default().water.spacing;
                progress.say(&format!(
                    "radius {} (too few particles to estimate it; --radius sets it)",
                    0.5 * spacing
                ));
                spacing
            }
        },
    }
}
