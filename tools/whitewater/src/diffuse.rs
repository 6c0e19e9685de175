//! Diffuse particles that lie beside the fluid's: files of the same frames.

use std::collections::BTreeMap;
use std::path::PathBuf;

use whitewater::headless::{self, Headless};
use whitewater::io::particles::{Particles, Parts, sequence};

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

/// The diffuse particles of a frame, in files that are open. Nothing needs all of them at once: of the frames before
/// nothing is known of them, camera and light are found by the water. So no more than a part is in memory.
pub struct Reading {
    files: Vec<(Parts<'static>, Option<u32>)>,
    up: Up,
    life: Option<f32>,
}

/// A part of them, as it is uploaded.
struct Part {
    positions: Vec<[f32; 3]>,
    kinds: Vec<u32>,
    ages: Vec<f32>,
    ids: Option<Vec<u32>>,
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
            let mut most: Option<f32> = None;
            let read = Parts::open_with(path, Parts::USUAL, |part| {
                let lifetimes = part.lifetimes.iter().flatten().copied();
                most = lifetimes.filter(|l| l.is_finite()).chain(most).reduce(f32::max);
            });
            // One that can't be read is said when its frame is drawn.
            if read.is_ok() {
                longest = most.into_iter().chain(longest).reduce(f32::max);
            }
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

    /// Opens those of a frame; none where there is no file of its number.
    pub fn open(&self, frame: u64) -> Outcome<Reading> {
        let named = self.frames.get(&frame).into_iter().flatten();
        let open =
            |(path, kind): &(PathBuf, _)| Outcome::Ok((Parts::open(path, Parts::USUAL)?, *kind));
        let files = named.map(open).collect::<Outcome<_>>()?;
        Ok(Reading { files, up: self.up, life: self.life })
    }
}

impl Reading {
    /// Particles of all files.
    pub fn total(&self) -> usize {
        self.files.iter().map(|(parts, _)| parts.total()).sum()
    }

    /// Reads them and makes them those of the frames to come.
    pub fn upload(self, headless: &mut Headless) -> Outcome<()> {
        let mut upload = headless.diffuse_parts(self.total())?;
        // All files have them, or they are of no use.
        let identified = self.files.iter().all(|(parts, _)| parts.about().ids.is_some());
        for (parts, kind) in self.files {
            for part in parts {
                let part = Part::new(part?, kind, self.up, self.life);
                upload.push(&headless::Diffuse {
                    positions: &part.positions,
                    kinds: Some(&part.kinds),
                    radii: None,
                    ages: Some(&part.ages),
                    ids: part.ids.as_deref().filter(|_| identified),
                })?;
            }
        }
        Ok(upload.finish()?)
    }
}

impl Part {
    fn new(mut read: Particles, kind: Option<u32>, up: Up, life: Option<f32>) -> Self {
        if up == Up::Z {
            layers::turn_up(read.positions.iter_mut());
        }
        let count = read.positions.len();
        let kinds = kind.map(|kind| vec![kind; count]).or(read.kinds);
        let age = |left: f32| match life {
            // What is left is less than nothing: gone.
            Some(life) if left > 0.0 => (1.0 - left / life).max(0.0),
            _ => 1.0,
        };
        let ages = read.lifetimes.map(|left| left.into_iter().map(age).collect());
        Self {
            positions: read.positions,
            kinds: kinds.unwrap_or_else(|| vec![0; count]),
            ages: ages.unwrap_or_else(|| vec![0.0; count]),
            ids: read.ids,
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
