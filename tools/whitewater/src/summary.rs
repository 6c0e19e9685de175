//! What `whitewater info` says of a sequence as a whole, below its frames.

use glam::Vec3;
use whitewater::io::particles::Particles;
use whitewater::io::particles::sequence::Frame;

use crate::args::Up;
use crate::extras;
use crate::fluids::Fluids;
use crate::looks::round;
use crate::placing::Placing;
use crate::probes;
use crate::reader::{DEFAULT_FPS, Has, Reader};

/// Properties of the frames that were added.
#[derive(Default)]
pub struct Summary {
    /// Number of frames that were added: those that can be read.
    count: usize,
    fewest: usize,
    most: usize,
    own: Has,
    /// Number and root mean square speed of the frame whose water is fastest. Walls do not count.
    liveliest: Option<(u64, f32)>,
}

impl Summary {
    pub fn add(&mut self, number: u64, particles: &Particles) {
        let count = particles.positions.len();
        self.fewest = if self.count == 0 { count } else { self.fewest.min(count) };
        self.most = self.most.max(count);
        self.count += 1;
        self.own = self.own.or(Has::of(particles));
        let walls = extras::walls(particles);
        let each = particles.velocities.iter().flatten().zip(walls);
        let squares: Vec<f64> = each
            .filter(|(_, wall)| !wall)
            .map(|(v, _)| f64::from(Vec3::from(*v).length_squared()))
            .filter(|square| square.is_finite())
            .collect();
        let speed = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() as f32;
        if speed > self.liveliest.map_or(0.0, |(_, speed)| speed) {
            self.liveliest = Some((number, speed));
        }
    }

    /// The summary; `None` if `all` is not one sequence, or if fewer than two of its frames can be read.
    pub fn text(&self, all: &[Frame]) -> Option<String> {
        if self.count < 2 {
            return None;
        }
        let ([first, .., last], true) = (all, all.is_sorted_by(|a, b| a.number < b.number)) else {
            return None;
        };
        let placing = Placing { up: Up::Y, scale: 1.0, origin: [0.0; 3] };
        let fluids = Fluids::default();
        let reader = Reader::new(all, placing, (&[], &fluids), None);
        let found = probes::rate(&reader, all, self.own);
        let found = found.map(|(rate, how)| (rate / probes::step_of(all), how));
        let (rate, how) = found.unwrap_or((DEFAULT_FPS, "assumed; --fps of render sets it"));
        let rate = round(rate);
        let readable = match self.count {
            count if count < all.len() => format!(" ({count} readable)"),
            _ => String::new(),
        };
        let mut text = format!(
            "{} frames{readable}, {} to {}\n  particles   {} to {}\n  rate        {rate} frames a second ({how})\n",
            all.len(),
            first.number,
            last.number,
            self.fewest,
            self.most,
        );
        if let Some((number, speed)) = self.liveliest {
            text += &format!(
                "  liveliest   frame {number}, with a root mean square speed of {speed:.3} in the files' unit of speed\n"
            );
        }
        Some(text)
    }
}
