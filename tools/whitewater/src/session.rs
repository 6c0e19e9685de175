//! A session draws the frames of one run. It holds the device, the look and the targets; `render` and `demo` feed it
//! frames.

pub mod room;

use std::borrow::Cow;
use std::path::PathBuf;

use whitewater::GeneratorSettings;
use whitewater::bubbles::BubbleConfig;
use whitewater::headless::scene::Scene;
use whitewater::headless::{Background, Device, DeviceOptions, Headless, Stepped};
use whitewater::io::particles::{self, Particles, WriteFormat};
use whitewater::io::picture::{self, Display, Layers};
use whitewater::water::{SurfaceNoiseSettings, WaterSettings, WeberSettings};
use whitewater::{LightVolume, Previous, Settings};

use crate::args::{DrawArgs, NoiseArg};
use crate::blur::{self, Blur};
use crate::bubbles::{self, Blobs};
use crate::camera::{self, CameraFile, Lens};
use crate::environment::Environment;
use crate::failure::{Failure, Kind, Outcome};
use crate::film::{self, Reel};
use crate::fluids::{self, Fluids, Liquids};
use crate::layers;
use crate::output::{self, Output, PictureFormat, Target};
use crate::placing::Placing;
use crate::progress::{Progress, Steps};
use crate::settings::{FoamBy, Found, SettingsFile};
use crate::shore::Shores;
use crate::spray;
use crate::surface_foam;
use crate::timings::Times;
use crate::whitewater_source::{self, WhitewaterSource};

/// Everything that is the same in all frames.
pub struct Look {
    pub camera: CameraFile,
    pub settings: Settings,
    /// Settings of each fluid if there are several; otherwise empty or one.
    pub fluids: Vec<Settings>,
    /// The settings file; some of its values determine passes.
    pub file: SettingsFile,
    pub environment: Environment,
    pub scene: Scene,
    /// Whether only water, foam and spray are drawn, over transparency.
    pub matte: bool,
    /// If set, all pictures show the particles of this frame, each from the camera of the picture's own frame number.
    pub still: Option<u64>,
    /// Settings of foam formation; `None` if no water foams.
    pub foam: Option<WeberSettings>,
    /// Whitewater particles in addition to the water.
    pub whitewater: Option<WhitewaterSource>,
    /// Bubble foam and its configuration.
    pub bubbles: Option<(Blobs, BubbleConfig)>,
    /// Shoreline and contact foam.
    pub shores: Option<Shores>,
    /// Whether motion blur and depth of field have a camera's values by default.
    pub photograph: bool,
    /// Exposure in stops, added to the environment's.
    pub exposure: f32,
    /// Whether particles of low density are drawn as spray.
    pub spray: bool,
    /// Region in which water and foam cast shadows.
    pub region: LightVolume,
    /// Frames per second of the foam simulation; `None` if each frame is independent.
    pub fps: Option<f32>,
    /// Frames per second by which the sea, small waves and the pattern of foam move; `None` if they stand still.
    pub clock: Option<f32>,
    /// Frames per second for motion vectors; `None` if nothing moves.
    pub rate: Option<f32>,
    /// Frames per second of a film, unless `--film-fps` sets it.
    pub film: f32,
    /// Number of particles of the probed frame that has the most; the first renderer has room for that many.
    pub fullest: usize,
}

/// Numbers of the frames that each simulation has reached.
#[derive(Clone, Copy, Default)]
struct Memory {
    passed: Option<u64>,
    stepped: Option<u64>,
    /// Last frame of the emission of whitewater.
    made: Option<u64>,
    /// Last frame of the blob simulation.
    heaped: u64,
}

/// Draws the frames of a run.
pub struct Session<'a> {
    args: &'a DrawArgs,
    targets: Vec<Target<Output>>,
    wanted: Vec<&'static str>,
    /// Whether motion vectors are rendered.
    motion: bool,
    look: Look,
    /// The frame whose scene is on the device.
    staged: u64,
    /// The device while it has no renderer. Either this or `headless` (a device with a renderer) is set; after an
    /// error neither is.
    device: Option<Device>,
    headless: Option<Headless>,
    memory: Memory,
    /// Settings of the whitewater emission, and the max number of particles.
    making: Option<(GeneratorSettings, u32)>,
    /// Whitewater files that are open, of this frame.
    opened: Option<(u64, whitewater_source::Reading)>,
    /// Number of whitewater particles in the files of the last drawn frame; `None` if none are read.
    pub read: Option<usize>,
    /// Whether the warning about lack of room has been printed.
    full: bool,
    /// Whether the warning about missing velocities has been printed.
    unmoved: bool,
    /// Output files of emitted whitewater.
    pub keep: Option<Target<WriteFormat>>,
    /// Axes and unit of the emitted whitewater's files.
    pub placing: Placing,
    /// The fluids and their rest densities, if their settings follow from the emitted whitewater.
    pub fluids: Option<(&'a Fluids, Vec<Option<f32>>)>,
    /// The film, if one is written.
    reel: Option<Reel>,
    pub times: Times,
}

/// Checks arguments before anything is read.
pub fn check(args: &DrawArgs, sequence: bool) -> Outcome<(Vec<Target<Output>>, Vec<&'static str>)> {
    let targets: Vec<Target<Output>> =
        args.outputs.iter().map(|o| Target::of_frames(o, sequence)).collect::<Outcome<_>>()?;
    if has_film(&targets) {
        film::check_size(args.size)?;
    } else if args.film_fps.is_some() {
        return Err(Failure::usage("--film-fps: expected an output that ends in .mp4, found none"));
    }
    let wanted = layers::wanted(&args.layers)?;
    if let Some(path) = &args.timings {
        Times::check(path, false)?;
    }
    if let Some(path) = &args.trace {
        Times::check(path, true)?;
    }
    Ok((targets, wanted))
}

/// Whether all pictures of a frame exist and are not to be drawn again. A film is always drawn as a whole.
pub fn is_finished(args: &DrawArgs, targets: &[Target<Output>], frame: u64) -> bool {
    let written = |target: &Target<Output>| target.is_numbered() && target.is_written(frame);
    !args.overwrite && targets.iter().all(written)
}

/// The frames that are to be drawn of a scene that has no particles, and progress over these. Finished frames are
/// skipped.
pub fn unfinished(
    args: &DrawArgs,
    targets: &[Target<Output>],
    mut frames: Vec<u64>,
) -> (Vec<u64>, Progress) {
    let total = frames.len();
    frames.retain(|frame| !is_finished(args, targets, *frame));
    let progress = Progress::new(frames.len(), "frames");
    progress.skipped(total - frames.len());
    (frames, progress)
}

/// Whether any output is a film.
pub fn has_film(targets: &[Target<Output>]) -> bool {
    targets.iter().any(|target| target.format == Output::Film)
}

/// Whether any output holds motion vectors.
pub fn has_motion((targets, wanted): &(Vec<Target<Output>>, Vec<&'static str>)) -> bool {
    let exr = |target: &Target<Output>| target.format == Output::Picture(PictureFormat::Exr);
    wanted.contains(&layers::MOTION) && targets.iter().any(exr)
}

/// The environment that the arguments ask for. `sun` is the direction to the sky's sun if they give none.
pub fn environment(args: &DrawArgs, sun: Option<[f32; 3]>) -> Outcome<Environment> {
    match args.environment.as_str() {
        "sky" => Environment::sky(args.sun.or(sun)),
        file => Environment::read(file.as_ref(), args.sun),
    }
}

/// The surface noise that the arguments ask for.
pub fn noise_of(args: &DrawArgs, file: &SettingsFile) -> NoiseArg {
    args.noise.unwrap_or(if file.is_thesis() { NoiseArg::None } else { NoiseArg::Air })
}

/// Default settings of the surface noise.
pub fn noise(args: &DrawArgs, file: &SettingsFile) -> SurfaceNoiseSettings {
    match noise_of(args, file) {
        NoiseArg::Foam => SurfaceNoiseSettings::SOURCE,
        NoiseArg::None | NoiseArg::Surface => SurfaceNoiseSettings::default(),
        NoiseArg::Air => SurfaceNoiseSettings::AIRBORNE,
    }
}

/// Warm-up of surface foam: number and length (in seconds) of simulation steps with the first frame of a sequence,
/// before that frame is drawn. Together these steps are longer than foam takes to form.
const WARM_UP: u32 = 8;
const WARM_STEP: f32 = 0.1;
/// Warm-up of emitted whitewater: number and length (in seconds) of simulation steps with the first frame. The
/// warm-up is short, because meanwhile the wave stands still and spray would fly out of it.
const PRE_ROLL: u32 = 8;
const PRE_STEP: f32 = 1.0 / 30.0;
pub const PRE_ROLLED: f32 = PRE_ROLL as f32 * PRE_STEP;

/// Estimated densities, in the unit of the rest density. `None` if the file has densities, or if no spray is drawn.
pub fn guessed_densities(
    spray: bool,
    particles: &Particles,
    water: &WaterSettings,
) -> Option<Vec<f32>> {
    let wanted = spray && particles.densities.is_none();
    wanted.then(|| {
        let shares = particles::estimate_densities(&particles.positions, water.spacing);
        shares.into_iter().map(|share| share * water.rest_density).collect()
    })
}

impl<'a> Session<'a> {
    /// Checks the outputs and opens the device. `steps` reports progress.
    pub fn new(
        args: &'a DrawArgs,
        checked: (Vec<Target<Output>>, Vec<&'static str>),
        look: Look,
        steps: Steps,
    ) -> Outcome<Self> {
        let motion = has_motion(&checked);
        let (targets, wanted) = checked;
        let png = |target: &Target<Output>| target.format == Output::Picture(PictureFormat::Png);
        let look = Look { photograph: look.photograph && targets.iter().all(png), ..look };
        for path in [&args.timings, &args.trace].into_iter().flatten() {
            output::probe(path)?;
        }
        let options = DeviceOptions {
            name: args.device.clone(),
            validation: args.validate,
            ..DeviceOptions::default()
        };
        let device = Device::new(&options)?;
        let times = Times::new(steps, &device.adapter, &device.driver);
        let (last, timings, trace) = (times.clone(), args.timings.clone(), args.trace.clone());
        let films = targets.iter().filter(|target| target.format == Output::Film);
        let films = films.map(|target| target.path(0)).collect();
        let reel = Reel::new(films, args.size, args.film_fps.unwrap_or(look.film))?;
        // After an interruption the film holds the frames drawn so far.
        let filmed = reel.clone();
        output::at_interrupt(move || {
            filmed.map_or(Ok(()), |reel| reel.write())?;
            timings.map_or(Ok(()), |path| last.write(&path))?;
            trace.map_or(Ok(()), |path| last.write_trace(&path))
        });
        Ok(Self {
            args,
            targets,
            wanted,
            motion,
            look,
            staged: 0,
            device: Some(device),
            headless: None,
            memory: Memory::default(),
            making: None,
            opened: None,
            read: None,
            full: false,
            unmoved: false,
            keep: None,
            placing: Placing::default(),
            fluids: None,
            reel,
            times,
        })
    }

    /// Factor by which the rendered width and height exceed the output's.
    fn supersample(&self) -> u32 {
        let averaged = Blur::of(self.args, self.look.photograph, 1.0).is_some();
        self.args.supersample.unwrap_or(if averaged { 1 } else { 2 })
    }

    /// Output files of a frame.
    pub fn paths(&self, frame: u64) -> Vec<PathBuf> {
        self.targets.iter().map(|t| t.path(frame)).collect()
    }

    /// Draws one frame and writes its pictures. `before` is the number of the previous frame in the sequence.
    pub fn frame(
        &mut self,
        number: u64,
        before: Option<u64>,
        source: &str,
        particles: &Particles,
    ) -> Outcome<()> {
        let content = self.look.still.unwrap_or(number);
        let time = self.time(content);
        (self.look.scene.frame, self.look.scene.time) = (content, time);
        let count = self.open_whitewater(number)?;
        let whitewater = self.opened.take().map(|(_, reading)| reading);
        self.read = whitewater.as_ref().map(whitewater_source::Reading::read);
        self.make_room(particles.positions.len(), count)?;
        let previous = match (before.filter(|_| self.motion), self.look.rate) {
            (Some(before), Some(rate)) => {
                let camera = self.look.camera.at_frame(before).camera(self.args.size)?;
                // Around a still, only the camera moves.
                let moving = self.look.still.is_none();
                let dt = if moving { number.saturating_sub(before) as f32 / rate } else { 0.0 };
                Some(Previous { camera, dt })
            }
            _ => None,
        };
        if let Some(headless) = &mut self.headless {
            headless.previous(previous);
            if let Some(whitewater) = whitewater {
                self.times.step("upload", number, || whitewater.upload(headless, 0.0))?;
            }
        }
        self.step(number, source, particles, true)
    }

    /// Opens the whitewater files of a frame, unless they are open. Returns the number of particles that are drawn of
    /// them.
    pub fn open_whitewater(&mut self, number: u64) -> Outcome<usize> {
        let Some(WhitewaterSource::Files(files)) = &self.look.whitewater else { return Ok(0) };
        let content = self.look.still.unwrap_or(number);
        let reading = match self.opened.take() {
            Some((open, reading)) if open == content => reading,
            _ => self.times.step("read", number, || files.open(content))?,
        };
        let count = reading.total();
        self.opened = Some((content, reading));
        Ok(count)
    }

    /// Time of a frame in seconds; 0 in a still.
    fn time(&self, number: u64) -> f64 {
        number as f64 / f64::from(self.look.clock.unwrap_or(f32::INFINITY))
    }

    /// Draws frames of a scene that has no particles. For each frame the progress line shows `word`, then the seconds it
    /// took.
    pub fn frames_without_particles(
        &mut self,
        frames: &[u64],
        (source, word): (&str, &str),
        progress: &mut Progress,
    ) -> Outcome<()> {
        let none = Particles::from_positions(Vec::new());
        for &number in frames {
            let began = std::time::Instant::now();
            self.frame(number, number.checked_sub(1), source, &none)?;
            let paths: Vec<_> =
                self.paths(number).iter().map(|p| p.display().to_string()).collect();
            let (seconds, paths) = (began.elapsed().as_secs_f32(), paths.join(" and "));
            progress.advance(&format!("frame {number}: {word}{seconds:.2} s, {paths}"));
        }
        Ok(())
    }

    /// Advances the foam simulation to a frame that is not drawn. [`make_room`](Self::make_room) has to be called
    /// before it.
    pub fn pass(&mut self, number: u64, particles: &Particles) -> Outcome<()> {
        self.step(number, "", particles, false)
    }

    /// Number of emitted whitewater particles in the last drawn frame; `None` if whitewater is not emitted by the
    /// program. Warns once if particles were lost for lack of room.
    pub fn made(&mut self) -> Outcome<Option<u32>> {
        let (Some((_, most)), Some(headless)) = (&self.making, &mut self.headless) else {
            return Ok(None);
        };
        let (made, lost) = headless.generated_count()?;
        if lost > 0 && !std::mem::replace(&mut self.full, true) {
            self.times.say(&format!(
                "there is room for {most} whitewater particles; {lost} more were not emitted: raise max_particles of \
                 table [generate], or lower its rates"
            ));
        }
        Ok(Some(made))
    }

    /// Skips a frame that cannot be read.
    pub fn skip(&mut self, number: u64) {
        self.memory.passed = Some(number);
    }

    /// Whether foam depends on earlier frames.
    pub fn remembers(&self) -> bool {
        let made = matches!(self.look.whitewater, Some(WhitewaterSource::Made(_)));
        (self.look.foam.is_some() || made) && self.look.fps.is_some()
    }

    /// Number of the last frame that the foam simulation has passed, simulated or skipped; `None` if it has just
    /// started.
    pub fn passed(&self) -> Option<u64> {
        self.memory.passed
    }

    /// Number of particles that the renderer has room for.
    pub fn room(&self) -> usize {
        self.headless.as_ref().map_or(0, |h| h.renderer().config().max_particles as usize)
    }

    fn step(
        &mut self,
        number: u64,
        source: &str,
        particles: &Particles,
        drawn: bool,
    ) -> Outcome<()> {
        let supersample = self.supersample();
        let content = self.look.still.unwrap_or(number);
        let (times, time) = (self.times.clone(), self.time(content));
        let Some(headless) = self.headless.as_mut() else {
            return Err(Failure::new(Kind::Device, "no renderer; run again"));
        };
        if let Some(WhitewaterSource::Made(made)) = &mut self.look.whitewater {
            let (settings, line) = times.step("limits", number, || made.settings(headless))?;
            if let Some(line) = line {
                self.times.say(&line);
                if let Some(line) = made.choose(&self.look.file, &mut self.look.settings) {
                    self.times.say(&line);
                }
                if let Some((fluids, densities)) = &self.fluids {
                    self.look.fluids =
                        fluids.settings(&self.look.settings, &self.look.file, densities)?;
                }
            }
            self.making = Some((settings, made.max_particles()));
        }
        // Spray is chosen by adjusted densities. The Weber number of surface foam takes the densities as they are.
        let foam = self.look.foam.as_ref().filter(|_| particles.velocities.is_some());
        let water = &self.look.settings.water;
        let (densities, adjusted) = times.step("densities", number, || {
            let guessed = guessed_densities(self.look.spray, particles, water).map(Cow::Owned);
            let all = guessed.or(particles.densities.as_deref().map(Cow::Borrowed));
            let by_density = self.look.spray && !self.look.file.is_thesis();
            let adjusted = all.as_deref().filter(|_| by_density).map(|all| {
                let mut all = all.to_vec();
                spray::adjust_densities(&particles.positions, &mut all, &self.look.settings);
                all
            });
            (all, adjusted)
        });
        times.step("upload", number, || {
            let first = adjusted.as_deref().filter(|_| foam.is_none()).or(densities.as_deref());
            headless.particles(&particles.positions, first)?;
            match &particles.velocities {
                Some(velocities) => headless.motion(velocities, particles.ids.as_deref()),
                None => Ok(()),
            }
        })?;
        if let Some(settings) = foam {
            let fps = self.look.fps.filter(|_| particles.ids.is_some());
            let (ids, spacing) = (particles.ids.as_deref(), self.look.settings.water.spacing);
            let by_air = self.look.file.surface_foam.by == Some(FoamBy::Air);
            let turbulence = self.look.file.surface_foam.turbulence.unwrap_or(0.0);
            let drive = by_air.then(|| {
                times.step("trapped air", number, || {
                    surface_foam::drive(particles, spacing, turbulence)
                })
            });
            times.step("surface_foam", number, || {
                let drive = drive.flatten();
                if let Some(drive) = &drive {
                    headless.motion(drive, ids)?;
                }
                match (fps, self.memory.stepped) {
                    (None, _) => headless.step(None, settings),
                    (Some(fps), Some(last)) => {
                        headless.step(Some(number.saturating_sub(last) as f32 / fps), settings)
                    }
                    // Warm-up: the first frame is held until foam is in a steady state.
                    (Some(_), None) => {
                        (0..WARM_UP).try_for_each(|_| headless.step(Some(WARM_STEP), settings))
                    }
                }?;
                if let Some(adjusted) = &adjusted {
                    headless.replace_densities(adjusted)?;
                }
                // Foam moves with the water's own velocities.
                match (&particles.velocities, drive) {
                    (Some(velocities), Some(_)) => headless.motion(velocities, ids),
                    _ => Ok(()),
                }
            })?;
            self.memory.stepped = Some(number);
            if drawn {
                times.passes(number, headless.step_timings(Stepped::Foam));
            }
        }
        // With several fluids, one emits whitewater.
        headless.show(fluids::emitting(particles));
        if let (Some((settings, most)), Some(_)) = (&self.making, &particles.velocities) {
            times.step("generate", number, || match (self.look.fps, self.memory.made) {
                (Some(fps), Some(last)) => {
                    let dt = number.saturating_sub(last) as f32 / fps;
                    headless.generate(dt, content as u32, settings, *most)
                }
                // Warm-up: the simulation runs for a short time while the water stays in this frame. For a single
                // frame, the whitewater of a whole lifetime is emitted first.
                (fps, _) => {
                    if fps.is_none() {
                        headless.generate_snapshot(content as u32, settings, *most)?;
                    }
                    (0..PRE_ROLL).try_for_each(|step| {
                        headless.generate(PRE_STEP, u32::MAX - step, settings, *most)
                    })
                }
            })?;
            self.memory.made = Some(number);
            if drawn {
                times.passes(number, headless.step_timings(Stepped::Generate));
            }
        } else {
            // Without velocities nothing is emitted, and the whitewater of the previous frame does not belong to this
            // one.
            headless.hide_generated();
        }
        if let Some((Blobs { motion: Some(motion), .. }, _)) = &self.look.bubbles {
            let dt = 1.0 / self.look.fps.unwrap_or(bubbles::FPS);
            times.step("heap", number, || {
                (self.memory.heaped..number)
                    .try_for_each(|_| headless.heap_step(dt, &motion.settings, &motion.solids))
            })?;
            if drawn && self.memory.heaped < number {
                times.passes(number, headless.step_timings(Stepped::BlobSimulation));
            }
            self.memory.heaped = self.memory.heaped.max(number);
        }
        self.memory.passed = Some(number);
        if !drawn {
            return Ok(());
        }
        let camera_file = self.look.camera.at_frame(number);
        let camera = camera_file.camera(self.args.size)?;
        let lens = Lens::new(&camera)?;
        if !self.look.scene.rests_between(self.staged, content) {
            times.step("scene", number, || {
                headless.scene_frame(&self.look.scene, supersample == 1)
            })?;
            if let Some(shores) = &self.look.shores {
                times.step("shore", number, || {
                    shores.moved(headless, &self.look.scene, self.staged)
                })?;
                times.passes(number, headless.step_timings(Stepped::ShoreMap));
            }
            self.staged = content;
        }
        self.look.settings.surface_foam.time = time;
        self.look.settings.shore.time = time;
        self.look.settings.water.wavelets.time = time;
        let background =
            if self.look.matte { Background::Color([0.0; 3]) } else { Background::Scene };
        let liquids = Liquids::new(&self.look.settings, &self.look.fluids, particles);
        let mut picture = None;
        for _ in 0..self.args.repeat.get() {
            picture =
                times.step("draw", number, || liquids.draw(headless, &camera, &background))?;
            times.passes(number, headless.timings());
        }
        let layers = times.step("read back", number, || {
            let mut layers = layers::collect(headless, self.args.size, &self.wanted, &lens)?;
            picture.iter().for_each(|picture| layers::show(&mut layers, picture));
            if self.look.matte {
                layers::matte(headless, &camera, &liquids, &mut layers)?;
            }
            if self.wanted.contains(&layers::DEBUG_VIEW) {
                layers::debug_views(headless, &camera, &self.look.settings, &mut layers)?;
            }
            Outcome::Ok(layers)
        })?;
        let mut layers = layers;
        // A camera of matrices has no target: it focuses on the middle of the water.
        let middle = || camera::depth(&camera, self.look.region.center);
        let focus =
            self.args.focus.or_else(|| camera_file.distance()).or_else(middle).unwrap_or(1.0);
        if let Some(blur) = Blur::of(self.args, self.look.photograph, focus) {
            let source = self.look.whitewater.as_ref().filter(|_| blur.seconds > 0.0);
            let still = particles.velocities.is_none();
            let still = still && !source.map_or(Ok(false), |source| source.moves(content))?;
            if still && self.args.shutter.is_some() && !std::mem::replace(&mut self.unmoved, true) {
                self.times.say("--shutter blurs nothing: there are no velocities");
            }
            let shown = times.step("samples", number, || {
                blur.draw(headless, particles, |headless, sample| {
                    if let Some(source) = source {
                        source.show(headless, content, sample.time)?;
                    }
                    let view = blur::through(&camera, sample, focus, self.args.size);
                    let picture = liquids.draw(headless, &view, &background)?;
                    let mut drawn = layers::collect(headless, self.args.size, &[], &lens)?;
                    picture.iter().for_each(|picture| layers::show(&mut drawn, picture));
                    if self.look.matte {
                        layers::matte(headless, &view, &liquids, &mut drawn)?;
                    }
                    Ok(drawn)
                })
            })?;
            shown.put(&mut layers);
            if let Some(source) = source {
                source.show(headless, content, 0.0)?;
            }
        }
        let messages = headless.device().take_messages();
        if let Some(first) = messages.first() {
            let first = first.split_whitespace().collect::<Vec<_>>().join(" ");
            return Err(Failure::new(
                Kind::Device,
                format!("expected no validation messages, found {}: {first}", messages.len()),
            ));
        }
        let layers = self.with_attributes(layers, source, &camera_file)?;
        // Written before the pictures, because a frame counts as finished when its pictures exist.
        self.write_made(number)?;
        times.step("write", number, || self.write(number, &layers))
    }

    /// Writes the emitted whitewater particles. Remaining lifetimes are written relative to the longest lifetime, so
    /// that a program that reads the file finds the same ages.
    fn write_made(&mut self, number: u64) -> Outcome<()> {
        let times = self.times.clone();
        let (Some(keep), Some((settings, _)), Some(headless)) =
            (&self.keep, &self.making, &mut self.headless)
        else {
            return Ok(());
        };
        let mut made = times.step("read back", number, || headless.generated())?;
        self.placing.back(&mut made.positions, &mut made.velocities);
        let particles = Particles {
            velocities: Some(made.velocities),
            ids: Some(made.ids),
            kinds: Some(made.kinds),
            lifetimes: Some(
                made.ages.iter().map(|age| (1.0 - age) * settings.max_lifetime).collect(),
            ),
            ..Particles::from_positions(made.positions)
        };
        times.step("write", number, || {
            output::write(&keep.path(number), |to| particles::write_to(to, &particles, keep.format))
        })
    }

    /// Writes the picture of a frame to all its files.
    fn write(&self, number: u64, layers: &Layers) -> Outcome<()> {
        let look = &self.look;
        let exposure = look.environment.exposure() + look.exposure + self.args.exposure;
        let display = Display { exposure, tone: self.args.tone.into(), alpha: look.matte };
        for target in &self.targets {
            let path = target.path(number);
            match target.format {
                Output::Picture(PictureFormat::Exr) => {
                    output::write(&path, |to| picture::write_exr(layers, to))?;
                }
                Output::Picture(PictureFormat::Png) => {
                    output::write(&path, |to| picture::write_png_as(layers, &display, to))?;
                }
                // Films are written at the end.
                Output::Film => {}
            }
        }
        self.reel.as_ref().map_or(Ok(()), |reel| {
            // A film has no alpha; the picture is composited over black.
            let display = Display { alpha: false, ..display };
            reel.push(&layers.shown(&display).unwrap_or_default())
        })
    }

    fn with_attributes(
        &self,
        mut layers: Layers,
        source: &str,
        camera: &CameraFile,
    ) -> Outcome<Layers> {
        let found = Found {
            foam: self.look.foam.as_ref(),
            generate: self.making.as_ref(),
            matte: self.look.matte,
        };
        let settings = self.look.file.all(&self.look.settings, found).text();
        let settings = settings.map_err(Failure::input)?;
        let mut note = |name: &str, value: String| {
            layers.attributes.push((name.into(), value));
        };
        note("version", env!("CARGO_PKG_VERSION").into());
        note("input", source.into());
        note("camera", camera.json());
        note("settings", settings);
        note("environment", self.args.environment.clone());
        if let Some(headless) = &self.headless {
            note("adapter", headless.device().adapter.clone());
            note("driver", headless.device().driver.clone());
            note("config", format!("{:?}", headless.renderer().config()));
        }
        Ok(layers)
    }

    /// Writes the timings and returns the device.
    pub fn finish(mut self) -> Outcome<()> {
        let gone = match self.headless.take() {
            Some(headless) => headless.finish().map(drop),
            None => Ok(()),
        };
        let written = output::at_end();
        gone?;
        written
    }
}
