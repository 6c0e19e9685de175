//! A camera that orbits the water.

use whitewater::io::particles::sequence::Frame;

use crate::args::{RenderArgs, Turntable};
use crate::camera::Turn;
use crate::failure::{Failure, Outcome};
use crate::reader::DEFAULT_FPS;

/// Orbit of the camera.
#[derive(Clone, Copy)]
pub struct Turning {
    /// Number of the first frame.
    first: u64,
    length: Length,
}

/// Duration of a full orbit.
#[derive(Clone, Copy)]
enum Length {
    /// In frame numbers.
    Numbers(f32),
    /// In seconds of a film in real time.
    Seconds(f32),
}

impl Turning {
    /// The orbit during the drawn frames. `still`: whether these are the pictures of one orbit around one frame.
    pub fn new(args: &RenderArgs, frames: &[Frame], still: bool) -> Option<Self> {
        let turntable = args.turntable?;
        let (first, last) = (frames.first()?.number, frames.last()?.number);
        let apart = match frames.len() {
            1 => 1.0,
            many => (last - first) as f32 / (many - 1) as f32,
        };
        // From the first frame to one step after the last one.
        let span = apart * frames.len() as f32;
        let length = match (turntable, args.draw.film_fps) {
            _ if still => Length::Numbers(span),
            (Turntable::Auto, _) => Length::Numbers(span),
            (Turntable::Frames(frames), _) => Length::Numbers(frames as f32 * apart),
            (Turntable::Seconds(seconds), Some(fps)) => Length::Numbers(seconds * fps * apart),
            (Turntable::Seconds(seconds), None) => Length::Seconds(seconds),
        };
        Some(Self { first, length })
    }

    /// The orbit. `fps`: frame numbers per second of the sequence.
    pub fn turn(&self, fps: f32) -> Turn {
        let frames = match self.length {
            Length::Numbers(frames) => frames,
            Length::Seconds(seconds) => seconds * fps,
        };
        Turn { first: self.first, frames }
    }
}

/// Default number of pictures for an orbit around one frame.
const STILLS: u32 = 96;

/// Pictures per second of a film that orbits one frame.
pub fn stills_fps(args: &RenderArgs) -> f32 {
    args.draw.film_fps.or(args.fps).unwrap_or(DEFAULT_FPS)
}

/// The same frame repeated for each picture of an orbit, numbered from 1. `fps`: pictures per second.
pub fn stills(frame: &Frame, turntable: Turntable, fps: f32) -> Outcome<Vec<Frame>> {
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

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use clap::Parser;

    use super::*;
    use crate::args::{Cli, Command};

    fn frame(number: u64) -> Frame {
        let path = PathBuf::from("f.ply");
        Frame { number, time: None, in_seconds: false, path, also: Vec::new(), step: None }
    }

    fn arguments(more: &str) -> Box<RenderArgs> {
        let line = format!("whitewater render f.ply -o o.mp4 {more}");
        let Command::Render(args) = Cli::try_parse_from(line.split_whitespace()).unwrap().command
        else {
            panic!("{more}")
        };
        args
    }

    /// Seconds are those of the film, in real time or not.
    #[test]
    fn an_orbit_lasts_the_seconds_of_the_film() {
        // Every second frame of a sequence whose numbers are 5 apart, with 500 numbers a second.
        let frames: Vec<Frame> = (0..100).map(|i| frame(10 * i)).collect();
        let numbers =
            |more: &str| Turning::new(&arguments(more), &frames, false).unwrap().turn(500.0).frames;
        assert_eq!(numbers("--turntable=0.5s"), 250.0);
        // 0.5 seconds of the film are 12 pictures, which are 10 numbers apart.
        assert_eq!(numbers("--turntable=0.5s --film-fps 24"), 120.0);
        assert_eq!(numbers("--turntable=8 --film-fps 24"), 80.0);
        assert_eq!(numbers("--turntable --film-fps 24"), 1000.0);
    }

    #[test]
    fn pictures_of_a_still_are_one_orbit() {
        for (more, count) in [
            ("--turntable", 96),
            ("--turntable=8 --film-fps 25", 8),
            ("--turntable=0.5s", 15),
            ("--turntable=0.5s --fps 24", 12),
            ("--turntable=0.5s --film-fps 25", 13),
            ("--turntable=0.5s --fps 24 --film-fps 8", 4),
        ] {
            let args = arguments(more);
            let pictures = stills(&frame(46), args.turntable.unwrap(), stills_fps(&args)).unwrap();
            assert_eq!(pictures.len(), count, "{more}");
            let turn = Turning::new(&args, &pictures, true).unwrap().turn(30.0);
            assert_eq!((turn.first, turn.frames), (1, count as f32), "{more}");
        }
    }
}
