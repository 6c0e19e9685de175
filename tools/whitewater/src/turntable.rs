//! A camera that goes round the water.

use whitewater::io::particles::sequence::Frame;

use crate::args::{RenderArgs, Turntable};
use crate::camera::Turn;
use crate::failure::{Failure, Outcome};

/// How the camera goes round.
#[derive(Clone, Copy)]
pub struct Turning {
    turntable: Turntable,
    /// Number of the first picture, and how many numbers on the first would come after the last.
    first: u64,
    span: f32,
}

impl Turning {
    pub fn new(args: &RenderArgs, frames: &[Frame]) -> Option<Self> {
        let turntable = args.turntable?;
        let (first, last) = (frames.first()?.number, frames.last()?.number);
        let apart = match frames.len() {
            1 => 1.0,
            many => (last - first) as f32 / (many - 1) as f32,
        };
        Some(Self { turntable, first, span: apart * frames.len() as f32 })
    }

    /// The turn, of so many frames a second.
    pub fn turn(&self, fps: f32) -> Turn {
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
