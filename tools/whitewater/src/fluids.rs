//! Several fluids, each with its own look: which particles belong to which fluid, and how the
//! pictures are combined.
//!
//! The renderer draws one liquid at a time. So for each fluid a picture is made in which it is drawn over the picture
//! of all others, and each pixel of the result is taken from the picture of the fluid whose surface is nearest there.
//! The fluids behind it are refracted and absorbed by it. They reflect nothing, because a surface between two liquids
//! hardly reflects. A fluid casts no shadow on another one. Whitewater is drawn only together with the fluid in
//! front, not into the pictures that lie behind it, so each pixel shows it once.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::Vec3;
use whitewater::headless::{Background, Headless, Picture};
use whitewater::io::particles::sequence::Frame;
use whitewater::io::particles::{Extra, Particles};
use whitewater::io::picture::EMPTY;
use whitewater::water::{Fresnel, SurfaceNoiseSettings};
use whitewater::{Camera, Settings};

use crate::bounds::Bounds;
use crate::extras::{self, Condition};
use crate::failure::{Failure, Outcome};
use crate::frames;
use crate::looks;
use crate::settings::{MediumName, SettingsFile, take_back};

/// Attribute with the index of each particle's fluid. No file can contain this name.
const FLUID: &str = "\0fluid";
/// Attribute with 1 for each particle of the fluid that emits whitewater, 0 for the others.
const EMITS: &str = "\0emits";

/// `WHICH:LIQUID`.
#[derive(Clone, Debug, PartialEq)]
pub struct FluidArg {
    which: Which,
    look: Look,
    text: String,
}

#[derive(Clone, Debug, PartialEq)]
enum Which {
    /// Particles of the inputs that satisfy a comparison.
    Where(Condition),
    /// Other files of the same frames.
    Files(String),
}

#[derive(Clone, Debug, PartialEq)]
enum Look {
    /// The look without `--fluid`.
    Water,
    Named(MediumName),
    /// A settings file, applied over all other settings.
    File(PathBuf),
}

/// Parses `WHICH:LIQUID` for clap.
pub fn fluid(text: &str) -> Result<FluidArg, String> {
    let bad = |why: String| {
        format!(
            "expected WHICH:LIQUID, such as Type=2:honey, 'oil_*.vtk:beer' or phase=1:oil.toml, with water, a name of --medium \
             or a settings file as LIQUID{why}"
        )
    };
    // A file name may contain a colon, and so does a liquid with a share, so every colon is tried.
    let mut why = String::new();
    for (at, _) in text.match_indices(':') {
        let (which, look) = (text[..at].trim(), text[at + 1..].trim());
        let look = match look {
            "water" => Ok(Look::Water),
            file if file.ends_with(".toml") => Ok(Look::File(file.into())),
            name => name.parse().map(Look::Named),
        };
        match look {
            Ok(_) if which.is_empty() => break,
            Ok(look) => {
                let which = match extras::condition(which) {
                    Ok(condition) => Which::Where(condition),
                    Err(_) => Which::Files(which.into()),
                };
                return Ok(FluidArg { which, look, text: text.into() });
            }
            // The error about the share of a known liquid is kept, because it helps more than one about an unknown
            // liquid.
            Err(_) if why.contains("share") => {}
            Err(error) => why = format!("; {}: {error}", &text[at + 1..]),
        }
    }
    Err(bad(why))
}

/// The fluids of a run; empty without `--fluid`.
#[derive(Default)]
pub struct Fluids {
    args: Vec<FluidArg>,
    /// For each file that `--fluid` names, the index of its fluid: 1 for the first argument. Fluid 0 is the inputs.
    files: HashMap<PathBuf, usize>,
}

impl Fluids {
    /// Adds the files that `--fluid` names to the frames of the inputs with the same numbers. Returns the fluids, and
    /// messages about frames without such a file.
    pub fn find(args: &[FluidArg], frames: &mut [Frame]) -> Outcome<(Self, Vec<String>)> {
        let (mut files, mut said) = (HashMap::new(), Vec::new());
        for (i, arg) in args.iter().enumerate() {
            let Which::Files(pattern) = &arg.which else { continue };
            if frames.iter().any(|frame| frame.step.is_some()) {
                let why = "expected one input file per frame, found one file with all frames";
                return Err(Failure::usage(format!("--fluid '{}': {why}", arg.text)));
            }
            let own = frames::files(std::slice::from_ref(pattern), true)?;
            let single = frames.len() == 1 && own.len() == 1;
            let mut missing = 0;
            for frame in frames.iter_mut() {
                let found = own.iter().filter(|other| single || other.number == frame.number);
                let mut any = false;
                for other in found {
                    any = true;
                    for path in other.paths() {
                        files.insert(path.to_path_buf(), i + 1);
                        frame.also.push(path.to_path_buf());
                    }
                }
                missing += usize::from(!any);
            }
            if missing == frames.len() {
                return Err(Failure::input(format!(
                    "--fluid '{}': expected files of the frames {}, found those of {}: the last number in the name is the frame",
                    arg.text,
                    range(frames),
                    range(&own)
                )));
            }
            if missing > 0 {
                said.push(format!(
                    "--fluid '{}': {missing} of {} frames have no file with their number and are drawn without this fluid",
                    arg.text,
                    frames.len()
                ));
            }
        }
        Ok((Self { args: args.to_vec(), files }, said))
    }

    /// Number of fluids, including the inputs; 1 without `--fluid`.
    pub fn count(&self) -> usize {
        if self.args.is_empty() { 1 } else { self.args.len() + 1 }
    }

    /// Number of fluids that are drawn: one for each `--fluid`, and one for all other particles of the inputs. If a
    /// `--fluid` is a comparison (`Type=2:honey`), the other particles are not drawn and do not count.
    pub fn drawn(&self) -> usize {
        self.args.len() + usize::from(self.conditions().next().is_none())
    }

    /// Names of the attributes that distinguish the fluids.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.conditions().map(|(_, condition)| condition.name())
    }

    fn conditions(&self) -> impl Iterator<Item = (usize, &Condition)> {
        self.args.iter().enumerate().filter_map(|(i, arg)| match &arg.which {
            Which::Where(condition) => Some((i + 1, condition)),
            Which::Files(_) => None,
        })
    }

    /// Stores the index of the fluid that the file `path` belongs to as an attribute of its particles, and makes
    /// their ids unique among the fluids, before the frame's files are joined.
    pub fn mark(&self, path: &Path, particles: &mut Particles) {
        if self.args.is_empty() {
            return;
        }
        let fluid = self.files.get(path).copied().unwrap_or(0);
        let count = self.count() as u32;
        if !self.files.is_empty()
            && let Some(ids) = &mut particles.ids
        {
            // Each fluid numbers its particles independently, so the ids are made unique.
            match ids.iter().map(|id| id.checked_mul(count)?.checked_add(fluid as u32)).collect() {
                Some(own) => *ids = own,
                None => particles.ids = None,
            }
        }
        let values = vec![fluid as f64; particles.positions.len()];
        particles.extras.push(Extra { name: FLUID.into(), values });
    }

    /// Sorts the particles by fluid and drops those that belong to none.
    pub fn divide(&self, particles: &mut Particles, path: &Path) -> Outcome<()> {
        if self.args.is_empty() {
            return Ok(());
        }
        let own = particles.extras.iter().position(|extra| extra.name == FLUID);
        let mut fluids = match own {
            Some(own) => particles.extras.swap_remove(own).values,
            None => vec![0.0; particles.positions.len()],
        };
        for (fluid, condition) in self.conditions() {
            let what = format!("--fluid '{}'", self.args[fluid - 1].text);
            let holds = condition.holds(particles, &what, path)?;
            for (of, holds) in fluids.iter_mut().zip(holds) {
                if *of == 0.0 && holds {
                    *of = fluid as f64;
                }
            }
        }
        let kept: Vec<bool> = match self.conditions().next() {
            Some(_) => fluids.iter().map(|fluid| *fluid > 0.0).collect(),
            None => vec![true; fluids.len()],
        };
        let lost = kept.iter().filter(|kept| !**kept).count();
        let mut order: Vec<usize> = (0..kept.len()).filter(|i| kept[*i]).collect();
        order.sort_by(|a, b| fluids[*a].total_cmp(&fluids[*b]));
        reorder(particles, &order);
        let values: Vec<f64> = order.iter().map(|i| fluids[*i]).collect();
        // The same fluid in all frames, also where it has no particles.
        let emits = usize::from(self.conditions().next().is_some()) as f64;
        let emits = values.iter().map(|fluid| f64::from(*fluid == emits)).collect();
        particles.extras.push(Extra { name: FLUID.into(), values });
        particles.extras.push(Extra { name: EMITS.into(), values: emits });
        if lost > 0 {
            particles.warnings.push(format!(
                "{lost} of {} particles belong to no --fluid and are not drawn",
                kept.len()
            ));
        }
        Ok(())
    }

    /// Messages about fluids without particles.
    pub fn missing(&self, frames: &[Particles]) -> Vec<String> {
        let empty = |fluid: &usize| {
            frames.iter().all(|frame| ranges(frame, self.count())[*fluid].is_empty())
        };
        let first = usize::from(self.conditions().next().is_some());
        let line = |fluid: usize| match fluid {
            0 => "all particles of the inputs belong to a --fluid".to_string(),
            fluid => format!(
                "--fluid '{}': no particles in the probed frames",
                self.args[fluid - 1].text
            ),
        };
        (first..self.count()).filter(|_| self.count() > 1).filter(empty).map(line).collect()
    }

    /// Returns the settings of each fluid, that of the inputs first; empty without `--fluid`. `all` is the look of
    /// the inputs, which each `--fluid` modifies, and `file` the settings file that it is from; `densities` are the
    /// rest densities of the fluids, if the files have them.
    pub fn settings(
        &self,
        all: &Settings,
        file: &SettingsFile,
        densities: &[Option<f32>],
    ) -> Outcome<Vec<Settings>> {
        let rest = |fluid: usize| {
            let mut own = all.clone();
            let density = densities.get(fluid).copied().flatten();
            own.water.rest_density = density.unwrap_or(own.water.rest_density);
            own
        };
        if self.args.is_empty() {
            return Ok(Vec::new());
        }
        let bare = without_liquid(all, file);
        let mut settings = vec![rest(0)];
        for (i, arg) in self.args.iter().enumerate() {
            let mut own = rest(i + 1);
            match &arg.look {
                Look::Water => {}
                Look::Named(name) => {
                    take_back(&mut own, &bare);
                    name.liquid().put(&mut own);
                    own.water.medium = name.medium(own.water.spacing);
                }
                Look::File(path) => {
                    let spacing = own.water.spacing;
                    let file = SettingsFile::read(path)?;
                    if file.water.liquid().is_some() {
                        take_back(&mut own, &bare);
                    }
                    file.apply(&mut own);
                    own.water.spacing = spacing;
                }
            }
            settings.push(own);
        }
        Ok(settings)
    }
}

/// The look of the inputs without the foam and the surface of their own liquid, which another liquid does not inherit.
/// Only the values that a liquid sets are right.
fn without_liquid(all: &Settings, file: &SettingsFile) -> Settings {
    if file.water.liquid().is_none() {
        return all.clone();
    }
    let mut bare = file.look(all.water.spacing, all.light);
    if !file.is_thesis() {
        let any = Bounds { min: Vec3::ZERO, max: Vec3::ONE };
        looks::foam_of_caches(&mut bare.surface_foam, all.water.spacing);
        looks::waves_of_caches(&mut bare.water, all.water.spacing, &any);
    }
    // A thick liquid takes all noise away only if the noise is that of water in the air.
    bare.noise = all.noise;
    if bare.noise.weight == 0.0 {
        bare.noise.weight = SurfaceNoiseSettings::AIRBORNE.weight;
    }
    let mut file = file.clone();
    file.water.medium = None;
    file.apply(&mut bare);
    bare
}

/// The range of frame numbers in words.
fn range(frames: &[Frame]) -> String {
    match frames {
        [] => "none".into(),
        [only] => only.number.to_string(),
        [first, .., last] => format!("{} to {}", first.number, last.number),
    }
}

/// Rearranges all arrays of the particles: place i gets the particle with the index `order[i]`. A particle whose
/// index is missing in `order` is dropped, and one whose index is repeated is duplicated.
pub fn reorder(particles: &mut Particles, order: &[usize]) {
    fn of<T: Copy>(list: &mut Vec<T>, order: &[usize]) {
        *list = order.iter().map(|i| list[*i]).collect();
    }
    of(&mut particles.positions, order);
    particles.velocities.iter_mut().for_each(|list| of(list, order));
    particles.densities.iter_mut().for_each(|list| of(list, order));
    particles.ids.iter_mut().for_each(|list| of(list, order));
    particles.lifetimes.iter_mut().for_each(|list| of(list, order));
    particles.kinds.iter_mut().for_each(|list| of(list, order));
    particles.extras.iter_mut().for_each(|extra| of(&mut extra.values, order));
}

/// Range of the particles of each fluid, after [`Fluids::divide`].
pub fn ranges(particles: &Particles, count: usize) -> Vec<Range<u32>> {
    let all = particles.positions.len() as u32;
    let Some(own) = particles.extras.iter().find(|extra| extra.name == FLUID) else {
        return (0..count).map(|fluid| if fluid == 0 { 0..all } else { all..all }).collect();
    };
    let at = |fluid: usize| own.values.partition_point(|of| *of < fluid as f64) as u32;
    (0..count).map(|fluid| at(fluid)..at(fluid + 1)).collect()
}

/// Index range of the particles of the fluid that emits whitewater, after [`Fluids::divide`]: the inputs, or the first
/// `--fluid` if any is a comparison. Empty if that fluid has none in this frame; `None` without `--fluid`.
pub fn emitting(particles: &Particles) -> Option<Range<u32>> {
    let own = particles.extras.iter().find(|extra| extra.name == EMITS)?;
    // The fluids lie one after the other.
    let start = own.values.iter().position(|emits| *emits > 0.0).unwrap_or(0);
    let count = own.values.iter().filter(|emits| **emits > 0.0).count();
    Some(start as u32..(start + count) as u32)
}

/// The fluid of each particle by its file, before [`Fluids::divide`]; `None` if all particles are of the inputs.
pub fn by_file(particles: &Particles) -> Option<&[f64]> {
    let own = particles.extras.iter().find(|extra| extra.name == FLUID)?;
    own.values.iter().any(|fluid| *fluid > 0.0).then_some(own.values.as_slice())
}

/// The liquids of a frame.
pub struct Liquids<'a> {
    all: Vec<(Cow<'a, Settings>, Range<u32>)>,
}

impl<'a> Liquids<'a> {
    /// The liquids to draw: if `several` has fewer than two settings, all particles with the settings `one`;
    /// otherwise each of `several` with the range of its particles. All get the animation times of foam and waves
    /// from `one`.
    pub fn new(one: &'a Settings, several: &[Settings], particles: &Particles) -> Self {
        if several.len() < 2 {
            let all = 0..particles.positions.len() as u32;
            return Self { all: vec![(Cow::Borrowed(one), all)] };
        }
        let timed = |settings: &Settings| {
            let mut settings = settings.clone();
            settings.surface_foam.time = one.surface_foam.time;
            settings.shore.time = one.shore.time;
            settings.water.wavelets.time = one.water.wavelets.time;
            Cow::Owned(settings)
        };
        let all = several.iter().map(timed).zip(ranges(particles, several.len()));
        let all: Vec<_> = all.filter(|(_, range)| !range.is_empty()).collect();
        if all.is_empty() { Self { all: vec![(Cow::Borrowed(one), 0..0)] } } else { Self { all } }
    }

    /// Draws a frame. With one liquid the picture stays on the device, and `None` is returned. With several liquids
    /// the combined picture is returned, while the layers (depth, thickness and so on) on the device are those of the
    /// first liquid.
    pub fn draw(
        &self,
        headless: &mut Headless,
        camera: &Camera,
        background: &Background<'_>,
    ) -> Outcome<Option<Picture<[f32; 4]>>> {
        let render = |headless: &mut Headless,
                      fluid: usize,
                      settings: &Settings,
                      background: &Background<'_>| {
            headless.show(Some(self.all[fluid].1.clone()));
            headless.render(camera, settings, background)
        };
        headless.show_whitewater(true);
        if self.all.len() == 1 {
            render(headless, 0, &self.all[0].0, background)?;
            return Ok(None);
        }
        let wetted: Vec<Settings> = self.all.iter().map(|(settings, _)| wetted(settings)).collect();
        headless.show_whitewater(false);
        headless.show(Some(0..0));
        headless.render(camera, &self.all[0].0, background)?;
        let (scene, depth) = (headless.color()?, headless.scene_depth()?);
        // Each fluid alone, and the depth of its surface.
        let (mut alone, mut fronts) = (Vec::new(), Vec::new());
        for (fluid, wetted) in wetted.iter().enumerate() {
            render(headless, fluid, wetted, background)?;
            alone.push(headless.color()?);
            let front = headless.layer("water.depth")?;
            let none = || vec![EMPTY; scene.data.len()];
            fronts.push(front.map_or_else(none, |front| full(&front, &scene)));
        }
        // Sorted by mean depth, farthest first.
        let means: Vec<f64> = fronts.iter().map(|front| mean(front)).collect();
        let mut far: Vec<usize> = (0..self.all.len()).collect();
        far.sort_by(|a, b| means[*b].total_cmp(&means[*a]));
        let over = |headless: &mut Headless,
                    fluid,
                    settings: &Settings,
                    color: &Picture<[f32; 4]>|
         -> Outcome<_> {
            let under = Background::Images { color: &color.data, depth: &depth.data };
            render(headless, fluid, settings, &under)?;
            Ok(headless.color()?)
        };
        // Draws each fluid over the picture of the others. The first fluid is drawn last, so that its layers stay on
        // the device.
        let mut pictures = Vec::new();
        for fluid in (0..self.all.len()).rev() {
            let mut others = far.iter().copied().filter(|other| *other != fluid);
            let mut under = Cow::Borrowed(&alone[others.next().unwrap_or(fluid)].data);
            for other in others {
                let picture = Picture { data: under.into_owned(), ..empty(&scene) };
                headless.show_whitewater(false);
                under = Cow::Owned(over(headless, other, &wetted[other], &picture)?.data);
            }
            let picture = Picture { data: under.into_owned(), ..empty(&scene) };
            headless.show_whitewater(true);
            pictures.push(over(headless, fluid, &self.all[fluid].0, &picture)?);
        }
        pictures.reverse();
        let last = far.last().copied().unwrap_or(0);
        let data = (0..scene.data.len()).map(|i| {
            let front = (0..fronts.len()).filter(|fluid| fronts[*fluid][i] < EMPTY);
            let front = front.min_by(|a, b| fronts[*a][i].total_cmp(&fronts[*b][i]));
            pictures[front.unwrap_or(last)].data[i]
        });
        Ok(Some(Picture { data: data.collect(), ..empty(&scene) }))
    }
}

/// The look of a fluid behind another liquid: the surface between two liquids reflects almost
/// nothing (0.3 % between water and honey) and refracts less than a surface to air.
fn wetted(settings: &Settings) -> Settings {
    let mut settings = settings.clone();
    settings.water.fresnel = Fresnel::Source { bias: 0.0, scale: 0.0, power: 1.0 };
    settings.water.specular = 0.0;
    settings.water.refraction *= 0.3;
    settings
}

/// An empty picture of the same size.
fn empty<T>(like: &Picture<T>) -> Picture<T> {
    Picture { width: like.width, height: like.height, data: Vec::new() }
}

/// Mean depth of the non-empty texels.
fn mean(front: &[f32]) -> f64 {
    let there = front.iter().filter(|z| **z < EMPTY).map(|z| f64::from(*z));
    let (sum, count) = there.fold((0.0, 0_u32), |(sum, count), z| (sum + z, count + 1));
    if count == 0 { f64::MAX } else { sum / f64::from(count) }
}

/// A layer, enlarged to the size of the picture.
fn full(layer: &Picture<f32>, picture: &Picture<[f32; 4]>) -> Vec<f32> {
    let (width, height) = (picture.width, picture.height);
    let at = |x: usize, y: usize| *layer.at(x * layer.width / width, y * layer.height / height);
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fluids_are_parsed() {
        let of = |text: &str| fluid(text).map(|arg| (arg.which, arg.look));
        let condition = |text: &str| Which::Where(extras::condition(text).unwrap());
        let named = |text: &str| Look::Named(text.parse().unwrap());
        assert_eq!(of("Type=2:honey"), Ok((condition("Type=2"), named("honey"))));
        assert_eq!(of("mk>=10 : beer:0.05"), Ok((condition("mk>=10"), named("beer:0.05"))));
        assert_eq!(of("Points:0<1:water"), Ok((condition("Points:0<1"), Look::Water)));
        assert_eq!(
            of("oil_*.vtk:oil.toml"),
            Ok((Which::Files("oil_*.vtk".into()), Look::File("oil.toml".into())))
        );
        for (bad, says) in [
            ("Type=2", "WHICH:LIQUID"),
            ("Type=2:oil", "one of clear"),
            (":honey", "WHICH"),
            ("a:b:beer:x", "share"),
        ] {
            let message = fluid(bad).unwrap_err();
            assert!(message.contains(says), "{bad}: {message}");
        }
    }

    fn particles() -> Particles {
        let mut particles =
            Particles::from_positions((0..6).map(|i| [i as f32, 0.0, 0.0]).collect());
        particles.ids = Some((0..6).collect());
        particles.extras =
            vec![Extra { name: "Type".into(), values: vec![3.0, 1.0, 0.0, 3.0, 1.0, f64::NAN] }];
        particles
    }

    #[test]
    fn particles_of_a_fluid_are_put_beside_each_other() {
        let args = ["type=1:water", "type=3:honey", "type=9:milk"].map(|text| fluid(text).unwrap());
        let (fluids, said) = Fluids::find(&args, &mut []).unwrap();
        assert!(said.is_empty() && fluids.count() == 4 && fluids.drawn() == 3);
        let mut all = particles();
        fluids.divide(&mut all, Path::new("a.csv")).unwrap();
        assert_eq!(all.ids, Some(vec![1, 4, 0, 3]));
        assert_eq!(ranges(&all, 4), [0..0, 0..2, 2..4, 4..4]);
        assert!(
            all.warnings[0].starts_with("2 of 6 particles belong to no --fluid"),
            "{:?}",
            all.warnings
        );
        let missing = fluids.missing(&[all]);
        assert!(missing.len() == 1 && missing[0].contains("type=9"), "{missing:?}");
        let none = fluid("phase=1:milk").unwrap();
        let (fluids, _) = Fluids::find(&[none], &mut []).unwrap();
        let error = fluids.divide(&mut particles(), Path::new("a.csv")).unwrap_err();
        assert!(
            error.message.contains("--fluid 'phase=1:milk'") && error.message.contains("`phase`"),
            "{}",
            error.message
        );
        // Without fluids nothing changes.
        let mut all = particles();
        Fluids::default().divide(&mut all, Path::new("a.csv")).unwrap();
        let none = Fluids::default();
        assert_eq!((all.ids.unwrap().len(), none.count(), none.drawn()), (6, 1, 1));
    }

    /// A named liquid has its own foam and surface, not those of the inputs' liquid, but keeps what the file sets.
    #[test]
    fn a_liquid_inherits_no_other_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("honey.toml");
        let tables = "[water]\nmedium = \"honey\"\n[surface_foam]\nback_color = [0.1, 0.2, 0.3]\n";
        std::fs::write(&path, tables).unwrap();
        let file = SettingsFile::read(&path).unwrap();
        let mut plain = file.look(0.1, Settings::default().light);
        plain.noise = SurfaceNoiseSettings::AIRBORNE;
        looks::foam_of_caches(&mut plain.surface_foam, 0.1);
        plain.water.wavelets.slope = 0.08;
        let mut all = plain.clone();
        file.apply(&mut all);
        let args = ["T=1:water", "T=2:clear", "T=3:beer"].map(|text| fluid(text).unwrap());
        let (fluids, _) = Fluids::find(&args, &mut []).unwrap();
        let found = fluids.settings(&all, &file, &[]).unwrap();
        assert_eq!(found[1], all);
        let [clear, beer] = [&found[2], &found[3]];
        assert_eq!(clear.water.fresnel, plain.water.fresnel);
        assert_eq!(clear.surface_foam.front_color, plain.surface_foam.front_color);
        assert_eq!(clear.surface_foam.back_color, [0.1, 0.2, 0.3]);
        assert_eq!((clear.spray.color, clear.noise), (plain.spray.color, plain.noise));
        assert_eq!(clear.water.wavelets.slope, 0.08);
        assert_ne!(beer.surface_foam.front_color, all.surface_foam.front_color);
        assert_eq!(beer.water.wavelets.slope, 0.08);
    }

    #[test]
    fn files_of_other_fluids_belong_to_the_frames() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        for name in ["water_1.csv", "water_2.csv", "oil_1.csv"] {
            std::fs::write(at(name), "x,y,z,id\n0,0,0,7\n").unwrap();
        }
        let args = [fluid(&format!("{}:honey", at("oil_*.csv"))).unwrap()];
        let mut frames = frames::expand(&[at("water_*.csv")], false).unwrap();
        let (fluids, said) = Fluids::find(&args, &mut frames).unwrap();
        assert!(said.len() == 1 && said[0].contains("1 of 2 frames"), "{said:?}");
        let mut all = extras::read(&frames[0], &[], &fluids, None).unwrap();
        fluids.divide(&mut all, Path::new("water_1.csv")).unwrap();
        assert_eq!((fluids.drawn(), emitting(&all)), (2, Some(0..1)));
        // A frame without particles in the inputs emits nothing: the other fluid does not take their place.
        let mut oil = extras::read(&frames[0], &[], &fluids, None).unwrap();
        oil.retain(&[false, true]);
        fluids.divide(&mut oil, Path::new("water_1.csv")).unwrap();
        assert_eq!((oil.positions.len(), emitting(&oil)), (1, Some(0..0)));
        assert_eq!((all.ids.clone(), ranges(&all, 2)), (Some(vec![14, 15]), vec![0..1, 1..2]));
        let args = [fluid(&format!("{}:honey", at("water_2.csv"))).unwrap()];
        let mut frames = frames::expand(&[at("oil_*.csv"), at("water_1.csv")], true).unwrap();
        frames.push(Frame { number: 5, ..frames[0].clone() });
        assert!(
            Fluids::find(&args, &mut frames)
                .is_err_and(|error| error.message.contains("frames 1 to 5"))
        );
    }
}
