//! A camera that orbits the water.

use whitewater::io::particles::sequence::Frame;

use crate::args::{RenderArgs, Turntable};
use crate::camera::Turn;
use crate::failure::{Failure, Outcome};

/// Orbit of the camera.
#[derive(Clone, Copy)]
pub struct Turning {
    turntable: Turntable,
    /// `first`: number of the first frame. `span`: duration of a full orbit of the camera if the user gives none, in
    /// frame numbers, from the first frame to one step after the last one.
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

    /// The orbit, at this frame rate.
    pub fn turn(&self, fps: f32) -> Turn {
        let frames = match self.turntable {
            Turntable::Auto => self.span,
            Turntable::Frames(frames) => frames as f32,
            Turntable::Seconds(seconds) => seconds * fps,
        };
        Turn { first: self.first, frames }
    }
}

/// Default number of pictures for an orbit around one frame.
const STILLS: u32 = 96;

/// The same frame repeated for each picture of an orbit, numbered from 1.
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
