//! Diffuse particles that lie beside the fluid's: files of the same frames.

use std::collections::BTreeMap;
use std::path::PathBuf;

use whitewater::headless;
use whitewater::io::particles::{self, sequence};

use crate::args::{Up, Whitewater};
use crate::failure::{Failure, Outcome};
use crate::generate::Generate;
use crate::layers;

/// Frames in which the longest life is looked for.
const PROBES: usize = 16;

/// Where the diffuse particles come from.
pub enum Diffusing {
    Files(Files),
    Made(Box<Generate>),
}

/// The files of a sequence, by frame.
pub struct Files {
    frames: BTreeMap<u64, Vec<(PathBuf, Option<u32>)>>,
    up: Up,
    /// The longest life: none where no file says how long they live.
    life: Option<f32>,
}

/// The diffuse particles of a frame.
#[derive(Default)]
pub struct Diffuse {
    positions: Vec<[f32; 3]>,
    kinds: Vec<u32>,
    ages: Vec<f32>,
    ids: Vec<u32>,
    /// All files had ids.
    identified: bool,
}

impl Files {
    /// Finds them; none where none are named. `single`: one frame is drawn, whose file may have any number.
    pub fn find(named: &[Whitewater], up: Up, single: Option<u64>) -> Outcome<Option<Self>> {
        if named.is_empty() {
            return Ok(None);
        }
        let mut frames: BTreeMap<u64, Vec<_>> = BTreeMap::new();
        for named in named {
            let Whitewater::Files { kind, files } = named else {
                let why =
                    "--whitewater: expected 'generate' or files, found both or one of it twice";
                return Err(Failure::usage(why));
            };
            let found = sequence::expand(std::slice::from_ref(files), None)?;
            let alone = single.filter(|_| found.len() == 1);
            for frame in found {
                let number = alone.unwrap_or(frame.number);
                frames.entry(number).or_default().push((frame.path, *kind));
            }
        }
        let mut files = Self { frames, up, life: None };
        files.life = files.longest_life();
        Ok(Some(files))
    }

    /// Of some frames of the whole sequence, so that it is the same however it is cut into jobs.
    fn longest_life(&self) -> Option<f32> {
        let all: Vec<_> = self.frames.values().flatten().collect();
        let step = all.len().div_ceil(PROBES).max(1);
        let mut longest: Option<f32> = None;
        for (path, _) in all.into_iter().step_by(step) {
            // One that can't be read is said when its frame is drawn.
            let Ok(read) = particles::read(path) else { continue };
            let lifetimes = read.lifetimes.unwrap_or_default();
            let most = lifetimes.into_iter().filter(|l| l.is_finite()).reduce(f32::max);
            longest = most.into_iter().chain(longest).reduce(f32::max);
        }
        longest.filter(|life| *life > 0.0)
    }

    /// What to say where some of the frames have no file of their number.
    pub fn missing(&self, frames: impl Iterator<Item = u64>) -> Option<String> {
        let without: Vec<_> = frames.filter(|frame| !self.frames.contains_key(frame)).collect();
        let first = without.first()?;
        Some(format!(
            "--whitewater: {} frames, from {first} on, have no file of their number and are drawn without diffuse particles",
            without.len()
        ))
    }

    /// Those of a frame; none where there is no file of its number.
    pub fn read(&self, frame: u64) -> Outcome<Diffuse> {
        let mut all = Diffuse { identified: true, ..Diffuse::default() };
        for (path, kind) in self.frames.get(&frame).into_iter().flatten() {
            let mut read = particles::read(path)?;
            if self.up == Up::Z {
                layers::turn_up(read.positions.iter_mut());
            }
            let count = read.positions.len();
            let kinds = kind.map(|kind| vec![kind; count]).or(read.kinds);
            all.kinds.extend(kinds.unwrap_or_else(|| vec![0; count]));
            let age = |left: f32| match self.life {
                // What is left is less than nothing: gone.
                Some(life) if left > 0.0 => (1.0 - left / life).max(0.0),
                _ => 1.0,
            };
            let ages = read.lifetimes.map(|left| left.into_iter().map(age).collect());
            all.ages.extend(ages.unwrap_or_else(|| vec![0.0; count]));
            all.identified &= read.ids.is_some();
            all.ids.extend(read.ids.unwrap_or_else(|| vec![0; count]));
            all.positions.extend(read.positions);
        }
        Ok(all)
    }
}

impl Diffuse {
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    pub fn input(&self) -> headless::Diffuse<'_> {
        headless::Diffuse {
            positions: &self.positions,
            kinds: Some(&self.kinds),
            radii: None,
            ages: Some(&self.ages),
            ids: self.identified.then_some(&self.ids[..]),
        }
    }
}

/// `generate` or `[KIND=]FILES`.
pub fn named(text: &str) -> Result<Whitewater, String> {
    if text == "generate" {
        return Ok(Whitewater::Generate);
    }
    let kinds = [("foam=", 0), ("spray=", 1), ("bubble=", 2)];
    let found = kinds.into_iter().find_map(|(name, kind)| Some((text.strip_prefix(name)?, kind)));
    let (files, kind) = match found {
        Some((files, kind)) => (files, Some(kind)),
        None => (text, None),
    };
    if files.is_empty() {
        return Err("expected files, as in whitewater_%04d.bgeo or bubble=bubbles_*.bgeo".into());
    }
    Ok(Whitewater::Files { kind, files: files.into() })
}

/// Their number, where it is one that the renderer takes.
pub fn counted(count: usize) -> Outcome<u32> {
    u32::try_from(count)
        .map_err(|_| Failure::input("expected fewer than 2^32 diffuse particles, found more"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_without_a_file_are_told() {
        let frames = [2, 4].map(|frame| (frame, vec![(PathBuf::new(), None)])).into();
        let files = Files { frames, up: Up::Y, life: None };
        assert_eq!(files.missing([2, 4].into_iter()), None);
        let said = files.missing(2..=5).expect("a warning");
        assert!(said.contains("2 frames, from 3 on"), "{said}");
    }

    #[test]
    fn files_are_named_with_their_kind() {
        let of = |kind, files: &str| Ok(Whitewater::Files { kind, files: files.into() });
        assert_eq!(named("a_%d.bgeo"), of(None, "a_%d.bgeo"));
        assert_eq!(named("bubble=b*.ply"), of(Some(2), "b*.ply"));
        assert_eq!(named("oil=b.ply"), of(None, "oil=b.ply"));
        assert_eq!(named("generate"), Ok(Whitewater::Generate));
        assert_eq!(named("./generate"), of(None, "./generate"));
        assert!(named("spray=").is_err() && named("").is_err());
    }
}
