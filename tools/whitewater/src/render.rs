//! `whitewater render`: particle files to pictures, one or a sequence.

use std::ops::Range;

use glam::{Quat, Vec3};
use whitewater::Settings;
use whitewater::headless::scene::Scene;
use whitewater::io::particles::sequence::{self, Frame};
use whitewater::io::particles::{self, Particles};
use whitewater::water::Medium;
use whitewater::water::{SpraySettings, SurfaceFoamSettings};

use crate::args::{Foaming, RenderArgs, SetArg, SprayArg, Turntable, Unit, Up, Whitewater};
use crate::bounds::{self, Bounds};
use crate::bubbles::{self, Blobs};
use crate::camera::{CameraFile, Turn};
use crate::environment::Environment;
use crate::failure::{Failure, Kind, Outcome};
use crate::fluids::{self, Fluids};
use crate::frames;
use crate::generate::Generate;
use crate::output;
use crate::placing::{self, Placing};
use crate::progress::Progress;
use crate::reader::{DEFAULT_FPS, Has, Reader};
use crate::session::{self, Look, Session};
use crate::settings::{FoamBy, SettingsFile};
use crate::shore::{self, Shores};
use crate::spouts;
use crate::stage;
use crate::surface_foam;
use crate::upright;
use crate::whitewater_source;

pub fn run(args: &RenderArgs) -> Outcome<()> {
    if let Some(which) = &args.shore {
        return shore::run(args, which);
    }
    let foam = match &args.bubbles {
        Some(_) if args.inputs.is_empty() && args.turntable.is_some() => {
            let why = "--turntable: expected particle files, found --bubbles alone";
            return Err(Failure::usage(why));
        }
        Some(which) if args.inputs.is_empty() => return bubbles::run(args, which),
        Some(bubbles::Which::File(path)) => {
            let (blobs, moves) = bubbles::read(path)?;
            if moves {
                let why = "blobs that move are drawn without particles";
                return Err(Failure::input(format!("{}: {why}", path.display())));
            }
            Some(blobs)
        }
        Some(_) => {
            let why = "--bubbles: one, slope and box are scenes of their own: a file expected beside particles";
            return Err(Failure::usage(why));
        }
        None => None,
    };
    let range = args.frames.as_deref().map(sequence::parse_range).transpose()?;
    let mut all = frames::expand(&args.inputs, args.join)?;
    let (fluids, said_of_fluids) = Fluids::find(&args.fluids, &mut all)?;
    let frames = frames::within(&all, range)?;
    let frames: Vec<Frame> = frames.into_iter().step_by(args.every.get()).collect();
    // Of one file as many pictures as a turn has.
    let still = args.turntable.filter(|_| all.len() == 1 && !frames.is_empty());
    let frames = match still {
        Some(turntable) => stills(&all[0], turntable, args.fps.unwrap_or(DEFAULT_FPS))?,
        None => frames,
    };
    let checked = session::check(&args.draw, all.len() > 1 || still.is_some())?;
    let numbered = checked.0.iter().all(output::Target::is_numbered);
    let keep = args.write_whitewater.as_deref();
    let keep = keep.map(|file| output::Target::of_particles(file, all.len() > 1)).transpose()?;
    if keep.is_some() && args.whitewater != [Whitewater::Generate] {
        let why = "--write-whitewater: expected --whitewater generate as well, found none made";
        return Err(Failure::usage(why));
    }
    if let Some(file) =
        keep.iter().flat_map(|keep| all.iter().find(|f| keep.path(f.number) == f.path)).next()
    {
        let why = format!("--write-whitewater: {} is read; name another", file.path.display());
        return Err(Failure::usage(why));
    }
    let settings = SettingsFile::of_args(&args.draw)?;
    let environment = session::environment(&args.draw, None)?;
    let mut camera = CameraFile::from_args(&args.camera)?;
    let turning = Turning::new(args, &frames);
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
    let finished = |frame: &Frame| {
        let there = |path: std::path::PathBuf| std::fs::metadata(path).is_ok_and(|m| m.len() > 0);
        numbered
            && !args.draw.overwrite
            && checked.0.iter().all(|t| there(t.path(frame.number)))
            && keep.iter().all(|t| there(t.path(frame.number)))
    };
    let (done, left): (Vec<Frame>, Vec<Frame>) = frames.into_iter().partition(finished);
    let mut progress = Progress::new(left.len(), "frames");
    if !done.is_empty() {
        let count = done.len();
        progress
            .say(&format!("{count} finished frames are skipped (--overwrite draws them again)"));
    }
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
    let foams = args.draw.surface_foam.unwrap_or(foaming(args)) != Foaming::None;
    let moving = made || foams || sequence.motion;
    // Numbers may be those of steps: a second has so many numbers.
    let step = step_of(&all);
    let said = args.fps.map(|fps| fps * step);
    let fps = moving.then(|| said.unwrap_or(DEFAULT_FPS * step));
    let scale = args.unit.map(Unit::metres).or(args.scale).unwrap_or(1.0);
    // One that can't be read tells when its turn comes.
    let origin = |first: &Frame| match first.step {
        Some(step) => Ok(particles::read_step(&first.path, step, &[])?.origin),
        None => particles::find_origin(&first.path),
    };
    let origin = all.first().and_then(|first| origin(first).ok());
    let origin = origin.unwrap_or_default();
    let mut placing = Placing { up: args.up_axis.unwrap_or(Up::Y), scale, origin };
    let mut reader = Reader::new(&all, placing, (&args.conditions, &fluids), fps);
    if args.radius.is_some() {
        reader.alike();
    }
    let by_time = if args.fps.is_none() { reader.rate() } else { None };
    by_time.into_iter().for_each(|rate| reader.set_rate(rate));
    let mut probes = steps.during("reading", || Probes::read(&mut reader, &all, &left))?;
    probes.fps = probes.fps.or(by_time);
    let flat = upright::flat(&probes.frames);
    let z_is_up = match flat {
        // Of a plane of x and z.
        Some(1) => Some("they are two-dimensional, with z beside x"),
        Some(2) => None,
        _ => upright::is_z(&probes.frames),
    };
    if let (None, Some(why)) = (args.up_axis, z_is_up) {
        progress.say(&format!("z is up in the files: {why} (--up-axis y: not turned)"));
        placing.up = Up::Z;
        reader.turn(Up::Z);
        let turned = Placing { up: Up::Z, scale: 1.0, origin };
        probes.frames.iter_mut().for_each(|frame| turned.place(frame));
    }
    let sheet = upright::flat(&probes.frames).filter(|across| *across != 1);
    if sheet.is_some() {
        progress.say("the particles are two-dimensional: drawn as a sheet one spacing thick, seen from the front");
    }
    if args.unit.is_none() && args.scale.is_none() {
        probes.unit_hint().iter().for_each(|line| progress.say(line));
    }
    if reader.found_velocities && !probes.own.velocities {
        progress.say(
            "velocities are not in the files: found by where particles are from frame to frame",
        );
    }
    fluids.missing(&probes.frames).iter().for_each(|line| progress.say(line));
    if made || foams {
        probes.missing(all.len()).into_iter().for_each(|line| progress.say(&line));
    }
    reader.expected = probes.own;
    if let (None, Some(found)) = (args.fps, probes.fps) {
        reader.set_rate(found);
    }
    let settings_of_bubbles = settings.bubbles.config();
    let shores = Shores::of_particles(&settings)?;
    if settings_of_bubbles.crossfade && (foam.is_some() || args.whitewater.is_empty()) {
        let why = "--settings, [bubbles] crossfade: whitewater particles become blobs, so that --whitewater is expected, and no \
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
        progress.say("--eye and --target are taken where the files have them, far from the origin");
    }
    let found = Found { camera, spacing, files, sheet };
    // Those that are estimated are all in the unit of one rest density.
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
    let several = fluids.settings(&look.settings, &own_densities)?;
    let look = Look { fluids: several, bubbles: foam, shores, ..look };
    let mut session = Session::new(&args.draw, checked, look, steps)?;
    session.keep = keep;
    session.placing = placing;
    let mut failed: Vec<(u64, Failure)> = Vec::new();
    let mut warnings = Warnings::default();
    for frame in &left {
        match draw(&mut reader, &mut session, &all, frame, (&progress, &mut warnings)) {
            Ok(line) => progress.advance(&line),
            Err(failure) if failure.kind == Kind::Input => {
                progress.advance(&format!("frame {}: {}", frame.number, failure.message));
                failed.push((frame.number, failure));
            }
            Err(failure) => {
                progress.finish();
                // What was measured until here is kept, if it can be.
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

/// Where nothing is said: whitewater particles take the place of the water's own foam.
fn foaming(args: &RenderArgs) -> Foaming {
    if args.whitewater.is_empty() { Foaming::Auto } else { Foaming::None }
}

/// One frame from file to file.
fn draw(
    reader: &mut Reader<'_>,
    session: &mut Session<'_>,
    all: &[Frame],
    frame: &Frame,
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
        remember(reader, session, all, frame, particles.positions.len())?;
    }
    let before = all.iter().map(|f| f.number).filter(|n| *n < number).max();
    let before = before.filter(|_| all.len() > 1);
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

/// What was said of frames: once where it is the same but for its numbers.
#[derive(Default)]
struct Warnings(Vec<Warning>);

struct Warning {
    /// Without numbers.
    kind: String,
    file: String,
    text: String,
    frames: usize,
}

impl Warnings {
    /// The line to say; none where it was said of another frame.
    fn first(&mut self, file: &str, text: &str) -> Option<String> {
        let kind: String = text.chars().filter(|c| !c.is_ascii_digit()).collect();
        if let Some(known) = self.0.iter_mut().find(|known| known.kind == kind) {
            known.frames += 1;
            return None;
        }
        self.0.push(Warning { kind, file: file.into(), text: text.into(), frames: 1 });
        Some(format!("{file}: {text}"))
    }

    /// What was not said again, of how many frames.
    fn again(&self, total: usize) -> Vec<String> {
        let repeated = self.0.iter().filter(|warning| warning.frames > 1);
        let line = |Warning { file, text, frames, .. }: &Warning| {
            let start: Vec<_> = text.split(' ').take(8).collect();
            format!("{frames} of {total} frames as {file}: {} ...", start.join(" "))
        };
        repeated.map(line).collect()
    }
}

/// Lets foam come and go by the frames before one, from the first of the sequence on: how it is cut into
/// jobs does not show. Those that can't be read are left out.
fn remember(
    reader: &mut Reader<'_>,
    session: &mut Session<'_>,
    all: &[Frame],
    frame: &Frame,
    mut room: usize,
) -> Outcome<()> {
    loop {
        session.make_room(room)?;
        let next = |f: &&Frame| {
            f.number < frame.number && session.passed().is_none_or(|last| f.number > last)
        };
        let Some(next) = all.iter().find(next) else { return Ok(()) };
        match reader.read(next) {
            // With more room foam begins anew.
            Ok(particles) if particles.positions.len() > session.room() => {
                room = particles.positions.len();
            }
            Ok(particles) => session.pass(next.number, &particles)?,
            Err(_) => session.skip(next.number),
        }
    }
}

/// The end of a run in which all frames had their turn.
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

/// Frames of a sequence that are looked at: as water comes in and comes to rest, few are like the rest.
const PROBES: usize = 16;

/// A few frames of the whole sequence, from which its look is found: the same however it is cut into jobs.
struct Probes {
    frames: Vec<Particles>,
    numbers: Vec<u64>,
    /// Frames a second by two that follow each other.
    fps: Option<f32>,
    /// The number of the first of the sequence.
    first: u64,
    /// What any of the files has of its own.
    own: Has,
}

/// Pairs of frames that are asked how far they are apart: some may lack what tells it.
const PAIRS: usize = 6;

impl Probes {
    fn read(reader: &mut Reader<'_>, all: &[Frame], left: &[Frame]) -> Outcome<Self> {
        let mut picks: Vec<usize> =
            (0..PROBES).map(|i| i * (all.len() - 1) / (PROBES - 1)).collect();
        picks.dedup();
        let (mut frames, mut numbers) = (Vec::new(), Vec::new());
        let mut first_failure = None;
        for pick in picks {
            match reader.read(&all[pick]) {
                Ok(particles) => {
                    frames.push(particles);
                    numbers.push(all[pick].number);
                }
                Err(failure) => _ = first_failure.get_or_insert(failure),
            }
        }
        // All of them are bad: whichever can be read, or the reason why none can.
        if frames.is_empty() {
            let readable = left.iter().find_map(|frame| reader.read(frame).ok());
            match (readable, first_failure) {
                (Some(particles), _) => {
                    frames.push(particles);
                    numbers.push(0);
                }
                (None, Some(failure)) => return Err(failure),
                (None, None) => {}
            }
        }
        let own = reader.seen;
        // Of velocities that are found by it the rate is what they say: as the files have them.
        let apart = |pair: &[Frame]| {
            let [a, b] = pair else { return None };
            let (first, second) = (reader.as_it_is(a).ok()?, reader.as_it_is(b).ok()?);
            let seconds = surface_foam::seconds(&first, &second)?;
            Some((b.number - a.number) as f32 / seconds)
        };
        let middle = (all.len() - 1) / 2;
        let fps = all.windows(2).skip(middle).chain(all.windows(2).take(middle)).take(PAIRS);
        let fps = if own.velocities && own.ids { fps.filter_map(apart).next() } else { None };
        let first = all.first().map_or(0, |f| f.number);
        Ok(Self { frames, numbers, fps, first, own })
    }

    /// What to say of what none of the files of a sequence has, where foam is wanted.
    fn missing(&self, files: usize) -> Option<String> {
        let velocities = self.frames.iter().any(|frame| frame.velocities.is_some());
        let Has { velocities: own, ids, .. } = self.own;
        Some(match files {
            1 if !velocities => {
                let ids = if ids { "" } else { " and no ids" };
                format!(
                    "no velocities{ids}: no foam (of a sequence velocities are found, where particles have ids or keep \
                     their order)"
                )
            }
            _ if !velocities && !ids => {
                "no velocities and no ids, and particles do not keep their order: no foam".into()
            }
            _ if !velocities => {
                "no velocities, and ids that tell no particle from frame to frame: no foam".into()
            }
            2.. if own && !ids => {
                "no ids: foam is found anew in each frame (with ids it comes and goes with the particles)".into()
            }
            _ => return None,
        })
    }

    fn spacing(&self) -> Option<f32> {
        let each = |f: &Particles| particles::estimate_spacing(&bounds::together(&f.positions));
        self.frames.iter().find_map(each)
    }

    /// A word on what is no likely extent of water.
    fn unit_hint(&self) -> Option<String> {
        let extent = self.bounds()?.size().max_element();
        let fastest = self.frames.iter().filter_map(placing::fastest);
        placing::hint(extent, fastest.reduce(f32::max))
    }

    fn bounds(&self) -> Option<Bounds> {
        self.frames.iter().filter_map(|f| Bounds::of_bulk(&f.positions)).reduce(|a, b| a.union(&b))
    }

    /// In the unit of the file: 1000 where that fits, else what most of the particles have.
    fn rest_density(&self) -> Option<f32> {
        self.rest_density_of((0, 1))
    }

    /// The same of one of so many fluids.
    fn rest_density_of(&self, (fluid, count): (usize, usize)) -> Option<f32> {
        let part = |frame: &'_ Particles| {
            let Range { start, end } = fluids::ranges(frame, count).get(fluid)?.clone();
            frame.densities.as_ref()?.get(start as usize..end as usize).map(<[f32]>::to_vec)
        };
        let densities = self.frames.iter().filter_map(part).find(|part| !part.is_empty())?;
        let mut sorted: Vec<f32> =
            densities.iter().copied().filter(|d| d.is_finite() && *d > 0.0).collect();
        sorted.sort_unstable_by(f32::total_cmp);
        let median = *sorted.get(sorted.len() / 2)?;
        let high = *sorted.get(sorted.len() * 9 / 10)?;
        Some(if (600.0..1500.0).contains(&median) { 1000.0 } else { high })
    }
}

/// The speed at which water of a sequence meets things, m/s: that of its fastest particles, or, where that is more or
/// there are no velocities, of a fall from its highest particles to its lowest.
pub fn impact_speed(frames: &[Particles]) -> f32 {
    let fall = |frame: &Particles| {
        let heights: Vec<f32> =
            frame.positions.iter().map(|p| p[1]).filter(|y| y.is_finite()).collect();
        let [low, high] = [0.02, 0.998].map(|part| surface_foam::quantile(heights.clone(), part));
        Some((2.0 * 9.81 * (high? - low?)).sqrt())
    };
    let each = frames.iter().flat_map(|frame| [fall(frame), placing::fastest(frame)]);
    each.flatten().fold(0.0, f32::max)
}

/// Of spray in caches: what is alone, or nearly, is. Solvers' densities read low at every surface, in a sheet and a jet, so
/// that the library's 0.85 is met by most of a splash (of the highest tenth of two solid jets by 82 %, by these 23 %). One
/// neighbour at a spacing makes 0.40, a line of particles 0.48.
/// Sheets of one layer (0.70) hold; what is torn to less has droplets about it and is water still.
const SPRAY_DENSITIES: [f32; 3] = [0.42, 0.66, 0.7];

/// Puts the look of spray in caches over the library's: a particle is water that would fill some hundred drops. So fine ones
/// are many, as far apart as is no mark that repeats, and drawn out along their motion by what they differ in speed: a third
/// of the time of a fall through a spacing.
/// Mist is what fast water is torn to: its share goes with the Weber number, the square of the speed, up to 6 m/s.
pub fn spray_of_caches(spray: &mut SpraySettings, spacing: f32, speed: f32) {
    let mist = 0.14 * (speed / 6.0).min(1.0).powi(2);
    *spray = spray.with(|it| {
        [it.all_spray_density, it.full_water_density, it.no_spray_density] = SPRAY_DENSITIES;
        it.opacity = 0.95;
        it.droplets = 64;
        it.size = 0.2;
        it.scatter_radius = 4.5;
        it.stretch = (0.4 * (spacing / 9.81).sqrt()).min(1.0);
        it.mist = mist;
        it.mist_size = 2.0;
        it.mist_contrast = 2.0;
        it.exposure = 0.001;
        it.shade = 2.0;
    });
}

/// Puts the look of foam in caches over the library's: thin foam is lace, and as dim as the water under it, and all of
/// it is lit by the shape of the splash. (Of the library's whole relief, which is as large as a particle, it is gravel; of its
/// veil, a cloud.)
pub fn foam_of_caches(foam: &mut SurfaceFoamSettings, spacing: f32) {
    *foam = foam.with(|it| {
        it.extinction = 0.35 / spacing;
        it.front_extinction = 0.1 / spacing;
        it.min_thickness = 0.1 * spacing;
        it.normal_strength = 0.35;
        it.lace = 1.0;
        it.lace_size = 0.8;
        it.aeration = 0.6;
        it.shape = 0.8;
        it.back_color = [0.62, 0.68, 0.73];
        it.front_color = [0.97; 3];
    });
}

/// Metres across below which water is as clear as it is by nature: a glass or a tub, of which a pool's water is too blue.
const SMALL: f32 = 2.0;
/// The part of the colour of a pool's water that is the water's own, where its tiles are blue.
const BLUE_TILES: f32 = 0.45;
/// Metres across above which it is clearer than that, so that its ground is seen: by nature it is dark, and few solvers' units
/// are metres.
const LARGE: f32 = 10.0;

/// The rest spacing: as it is said, or found.
fn spacing(
    args: &RenderArgs,
    (probes, reader): (&Probes, &Reader<'_>),
    file: &SettingsFile,
    progress: &Progress,
) -> f32 {
    match (args.radius, file.water.spacing) {
        (Some(radius), _) => 2.0 * radius,
        (None, Some(spacing)) => spacing,
        (None, None) if reader.radii.is_some() => {
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
            progress
                .say(&format!("radius {} (of the files{differ}; --radius sets it)", round(radius)));
            2.0 * radius
        }
        (None, None) => match probes.spacing() {
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

/// What was found, or said, before the look.
struct Found {
    camera: Option<CameraFile>,
    spacing: f32,
    files: Option<whitewater_source::Files>,
    /// The axis across which the particles lie in one layer.
    sheet: Option<usize>,
}

/// What time is needed for.
#[derive(Clone, Copy)]
struct Sequence {
    /// There is more than one frame.
    is: bool,
    /// Motion vectors are wanted.
    motion: bool,
    /// A film is wanted, whose frames are so many numbers apart.
    film: Option<f32>,
    /// The camera goes round.
    turning: Option<Turning>,
    /// All pictures are of this frame.
    still: Option<u64>,
    /// Numbers a second, where it was said.
    said: Option<f32>,
    /// Numbers from a frame to the next.
    step: f32,
}

/// Numbers from one frame to the next, as they are for most.
fn step_of(all: &[Frame]) -> f32 {
    let apart: Vec<f32> =
        all.windows(2).map(|two| (two[1].number - two[0].number) as f32).collect();
    surface_foam::quantile(apart, 0.5).unwrap_or(1.0).max(1.0)
}

/// How the camera goes round.
#[derive(Clone, Copy)]
struct Turning {
    turntable: Turntable,
    /// Number of the first picture, and how many numbers on the first would come after the last.
    first: u64,
    span: f32,
}

impl Turning {
    fn new(args: &RenderArgs, frames: &[Frame]) -> Option<Self> {
        let turntable = args.turntable?;
        let (first, last) = (frames.first()?.number, frames.last()?.number);
        let apart = match frames.len() {
            1 => 1.0,
            many => (last - first) as f32 / (many - 1) as f32,
        };
        Some(Self { turntable, first, span: apart * frames.len() as f32 })
    }

    /// The turn, of so many frames a second.
    fn turn(&self, fps: f32) -> Turn {
        let frames = match self.turntable {
            Turntable::Auto => self.span,
            Turntable::Frames(frames) => frames as f32,
            Turntable::Seconds(seconds) => seconds * fps,
        };
        Turn { first: self.first, frames }
    }
}

/// Pictures of a turn round one frame, where nothing is said.
const STILLS: u32 = 96;

/// One frame as often as a turn has pictures, from 1 on.
fn stills(frame: &Frame, turntable: Turntable, fps: f32) -> Outcome<Vec<Frame>> {
    let count = match turntable {
        Turntable::Auto => STILLS,
        Turntable::Frames(frames) => frames,
        Turntable::Seconds(seconds) => (seconds * fps).round() as u32,
    };
    if !(2..=100_000).contains(&count) {
        let why =
            format!("--turntable: expected 2 to 100000 frames, found {count} at {fps} a second");
        return Err(Failure::usage(why));
    }
    Ok((1..=u64::from(count)).map(|number| Frame { number, ..frame.clone() }).collect())
}

/// Particles as they are seen from eight sides, so that a camera that sees all of them sees them all the way round; and
/// the box about them.
fn from_all_sides(frames: &[Particles], bounds: &Bounds) -> (Vec<Vec<[f32; 3]>>, Bounds) {
    let centre = bounds.center();
    let mut all = Vec::new();
    for positions in frames.iter().map(|frame| &frame.positions) {
        let step = positions.len().div_ceil(20_000).max(1);
        let inside = positions.iter().step_by(step).map(|p| Vec3::from(*p));
        let inside: Vec<Vec3> = inside.filter(|p| bounds.contains(*p)).collect();
        for side in 0..8_u8 {
            let turned = Quat::from_rotation_y(f32::from(side) * std::f32::consts::FRAC_PI_4);
            let at = |p: &Vec3| (centre + turned * (*p - centre)).to_array();
            all.push(inside.iter().map(at).collect());
        }
    }
    let reach = 0.5 * bounds.size().with_y(0.0).length();
    let reach = Vec3::new(reach, 0.5 * bounds.size().y, reach);
    (all, Bounds { min: centre - reach, max: centre + reach })
}

fn look(
    args: &RenderArgs,
    sequence: Sequence,
    probes: &mut Probes,
    found: Found,
    mut file: SettingsFile,
    environment: Environment,
    progress: &Progress,
) -> Outcome<Look> {
    let Found { camera, spacing, mut files, sheet } = found;
    let unit = Bounds { min: Vec3::splat(-1.0), max: Vec3::ONE };
    let bounds = probes.bounds().unwrap_or(unit).padded(0.5 * spacing);
    let mut settings = file.look(spacing, environment.light());
    if let Some(density) = probes.rest_density() {
        if density != settings.water.rest_density && file.water.rest_density.is_none() {
            progress
                .say(&format!("rest density {density} (estimated; water.rest_density sets it)"));
        }
        settings.water.rest_density = density;
    }
    settings.noise = session::noise(&args.draw);
    if !file.is_thesis() {
        spray_of_caches(&mut settings.spray, spacing, impact_speed(&probes.frames));
        foam_of_caches(&mut settings.surface_foam, spacing);
        let wide = bounds.size().x.max(bounds.size().z);
        if wide < SMALL {
            settings.water.medium = Medium::CLEAR;
        } else if args.scene.is_none() && args.set.unwrap_or_default() == SetArg::Pool {
            settings.water.medium = settings.water.medium.thinned(BLUE_TILES);
        }
        if wide > LARGE && file.water.medium.is_none() {
            settings.water.medium = settings.water.medium.thinned(LARGE / wide);
            let wide = round(wide);
            progress.say(&format!(
                "water {wide} metres wide is drawn as clear as a pool of {LARGE} (--unit, where lengths are no metres; \
                 table [water] medium)"
            ));
        }
    }
    file.apply(&mut settings);
    settings.water.spacing = spacing;
    if let Some(files) = &mut files {
        files.choose(&file, &mut settings);
        if let Some([foam, spray, bubbles]) =
            files.radii().filter(|_| file.whitewater.radii.is_none())
        {
            let copies = files.copies();
            if copies > 1 {
                progress
                    .say(&format!("each whitewater particle as {copies}, scattered: they are few"));
            }
            progress.say(&format!(
                "whitewater particles with radii of {}, {} and {} (foam, spray, bubbles) and half_intensity_thickness = {} (found; table \
                 [whitewater] sets them)",
                round(foam),
                round(spray),
                round(bubbles),
                round(settings.whitewater.half_intensity_thickness),
            ));
        }
        // What a picture was drawn with stands in it.
        file.whitewater.radii = files.radii();
        file.whitewater.copies = file.whitewater.radii.map(|_| files.copies());
    }

    let camera = camera.unwrap_or_else(|| {
        let (fov, size) = (args.camera.fov, args.draw.size);
        let camera = match sequence.turning {
            Some(_) => {
                let (frames, round) = from_all_sides(&probes.frames, &bounds);
                let frames: Vec<_> = frames.iter().map(|positions| &positions[..]).collect();
                CameraFile::of_particles(&frames, &round, fov, size).over(bounds.center())
            }
            None => {
                let frames: Vec<_> = probes.frames.iter().map(|f| &f.positions[..]).collect();
                match sheet {
                    Some(across) => CameraFile::of_sheet(across == 0, &frames, &bounds, fov, size),
                    None => CameraFile::of_particles(&frames, &bounds, fov, size),
                }
            }
        };
        progress.say(&format!("camera {} (found; --camera sets it)", camera.json()));
        camera
    });
    let mut environment = environment;
    let set = args.set.unwrap_or_default();
    let view = camera.at_frame(probes.first).camera(args.draw.size)?.view_matrix();
    let eye = view.inverse().transform_point3(Vec3::ZERO);
    // A sun that the walls of a basin don't keep out, and that shines through what flies.
    let own_sky = args.scene.is_none() && args.draw.environment == "sky";
    let sun = own_sky.then(|| stage::side_light(eye - bounds.center()));
    let mut scene = match &args.scene {
        None if set == SetArg::None => Scene::default(),
        Some(path) if path.as_os_str() == "ground" => stage::ground_under(&bounds, eye, set),
        Some(path) => stage::read(path)?,
        None => {
            let inside = |frame: &Particles| -> Vec<[f32; 3]> {
                let inside = frame.positions.iter().filter(|p| bounds.contains(Vec3::from(**p)));
                inside.copied().collect()
            };
            let frames: Vec<_> = probes.frames.iter().map(inside).collect();
            let frames: Vec<_> = frames.iter().map(|positions| &positions[..]).collect();
            let seen_from = (eye, sequence.turning.is_some());
            let jets = probes.frames.iter().find_map(|frame| {
                let velocities = frame.velocities.as_ref()?;
                let found = spouts::find(&frame.positions, velocities, spacing, bounds.min.y);
                (!found.is_empty()).then_some(found)
            });
            let jets = jets.unwrap_or_default();
            let basin = stage::basin_round(&frames, &bounds, spacing, seen_from, set, &jets);
            match basin.filter(|_| sheet.is_none()) {
                Some(basin) => {
                    progress
                        .say("a basin round the water, which a box holds (--scene ground: none)");
                    basin
                }
                None => stage::ground_under(&bounds, eye, set),
            }
        }
    };
    let plain = args.draw.environment == "sky" && args.draw.sun.is_none() && args.scene.is_none();
    let own = if plain { stage::light(set, eye - bounds.center())? } else { None };
    if sun.is_some() || own.is_some() {
        environment = match own {
            Some(own) => own,
            None => session::environment(&args.draw, sun)?,
        };
        settings.light = file.in_light(environment.light());
        file.light.put(&mut settings.light);
    }
    scene.sun = environment.sun_light();
    // Whitewater particles take the place of the water's own foam and spray.
    let has_whitewater = !args.whitewater.is_empty();
    let spray =
        args.draw.spray.unwrap_or(if has_whitewater { SprayArg::None } else { SprayArg::Auto });
    let spray = spray == SprayArg::Auto;
    // As `Session::frame` does it.
    for frame in probes.frames.iter_mut().filter(|frame| frame.densities.is_none()) {
        frame.densities = session::guessed_densities(spray, frame, &settings.water);
    }
    let fps = sequence.said.or(probes.fps).unwrap_or(DEFAULT_FPS * sequence.step);
    let camera = match sequence.turning {
        Some(turning) => camera.turned(turning.turn(fps))?,
        None => camera,
    };
    let seconds: Vec<f32> =
        probes.numbers.iter().map(|n| n.saturating_sub(probes.first) as f32 / fps).collect();
    let wanted = args.draw.surface_foam.unwrap_or(foaming(args));
    // In a sequence by speed: where air is trapped changes from frame to frame, three times as much as foam by speed does.
    let steady = sequence.is.then_some(FoamBy::Speed);
    let by = file
        .surface_foam
        .by
        .or(steady)
        .unwrap_or_else(|| file.surface_foam.by(wanted, file.is_thesis()));
    file.surface_foam.by = Some(by);
    let foam = surface_foam::settings(
        wanted,
        (&file.surface_foam, by),
        &probes.frames,
        &seconds,
        &settings,
    );
    if let Some(foam) = &foam {
        let of = match by {
            FoamBy::Air => "of trapped air ",
            FoamBy::Speed => "",
        };
        let number = round(foam.threshold);
        progress.say(&format!(
            "surface foam from Weber number {of}{number} on (--surface-foam sets it; none)"
        ));
    } else if wanted == Foaming::Auto && probes.frames.iter().any(|f| f.velocities.is_some()) {
        let onset = surface_foam::ONSET;
        progress.say(&format!(
            "no foam: the water is calm, or moves as a whole; it draws in air from {onset} metre a second on, by which it \
             moves past its surroundings (--surface-foam N sets a Weber number; --unit, where lengths are no metres)"
        ));
    }
    let moving = |f: &Particles| f.velocities.is_some() && f.ids.is_some();
    let made = args.whitewater == [Whitewater::Generate];
    if made && !probes.frames.iter().any(|frame| frame.velocities.is_some()) {
        let why = "--whitewater generate: expected velocities in the files, or a sequence whose particles have ids or \
             keep their order, found neither";
        return Err(Failure::input(why));
    }
    if made && file.generate.max_particles == Some(0) {
        let why = "[generate] max_particles: expected 1 or more, found 0";
        return Err(Failure::input(why));
    }
    let remembers = sequence.is && (made || foam.is_some() && probes.frames.iter().any(moving));
    let vectors = sequence.is && sequence.motion;
    let film = fps / sequence.film.unwrap_or(1.0);
    let fps = (remembers || vectors || sequence.is && sequence.film.is_some()).then(|| {
        if args.fps.is_none() {
            let found = if probes.fps.is_some() { "found; " } else { "" };
            let fps = round(fps / sequence.step);
            progress.say(&format!("{fps} frames a second ({found}--fps sets it)"));
        }
        fps
    });
    let region = bounds.region();
    let rate = fps.filter(|_| vectors);
    let fps = fps.filter(|_| remembers);
    let fullest = probes.frames.iter().map(|f| f.positions.len()).max().unwrap_or(0);
    let whitewater = match made {
        true => {
            let probes = std::mem::take(&mut probes.frames);
            let seconds = fps.map(|_| seconds.last().copied().unwrap_or(0.0));
            let table = file.generate.clone();
            let generate = Generate::new(table, spacing, &bounds, seconds, probes)?;
            Some(whitewater_source::WhitewaterSource::Made(Box::new(generate)))
        }
        false => files.map(whitewater_source::WhitewaterSource::Files),
    };
    let matte = set == SetArg::None;
    Ok(Look {
        camera,
        settings,
        fluids: Vec::new(),
        photograph: args.fluids.is_empty()
            && !(sequence.is || sequence.still.is_some() || matte || file.is_thesis()),
        file,
        environment,
        scene,
        matte,
        still: sequence.still,
        foam,
        whitewater,
        bubbles: None,
        shores: None,
        exposure: stage::exposure(set),
        spray,
        region,
        fps,
        rate,
        film,
        fullest,
    })
}

/// Four digits are enough to read.
pub fn round(value: f32) -> f32 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
