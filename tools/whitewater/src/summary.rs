//! What `whitewater info` says of a sequence as a whole, below its frames.

use glam::Vec3;
use serde_json::{Value, json};
use whitewater::io::particles::Particles;
use whitewater::io::particles::sequence::Frame;

use crate::args::Up;
use crate::extras;
use crate::fluids::Fluids;
use crate::looks::round;
use crate::odd::{self, Size};
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
    /// Sizes of the frames, and the particles' spacing in them.
    sizes: Vec<(Size, Option<f32>)>,
    /// Number and root mean square speed of the frame whose water is fastest. Walls do not count.
    liveliest: Option<(u64, f32)>,
}

impl Summary {
    /// `spacing` is the particles' spacing.
    pub fn add(&mut self, number: u64, particles: &Particles, spacing: Option<f32>) {
        let size = Size::of(number, &particles.positions);
        self.sizes.extend(size.map(|size| (size, spacing)));
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
    pub fn value(&self, all: &[Frame]) -> Option<Value> {
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
        let usual = Size::usual(self.sizes.iter().map(|(size, _)| *size).collect());
        let of = |number: u64| self.sizes.iter().find(|(size, _)| size.number == number)?.1;
        let told = |(size, spacing): &(Size, Option<f32>)| {
            let usual = usual?;
            size.told(&usual, || [*spacing, of(usual.number)])
        };
        let units = odd::together(self.sizes.iter().filter_map(told));
        let warnings: Vec<String> = reader.doubted().into_iter().chain(units).collect();
        let liveliest = self
            .liveliest
            .map(|(frame, speed)| json!({"frame": frame, "root_mean_square_speed": speed}));
        Some(json!({
            "frames": all.len(),
            "readable": self.count,
            "first": first.number,
            "last": last.number,
            "particles": {"min": self.fewest, "max": self.most},
            "rate": {"frames_per_second": round(rate), "how": how},
            "liveliest": liveliest,
            "warnings": warnings,
        }))
    }
}

/// The summary as text.
pub fn text(value: &Value) -> String {
    let readable = match &value["readable"] {
        all if *all == value["frames"] => String::new(),
        some => format!(" ({some} readable)"),
    };
    let (particles, rate) = (&value["particles"], &value["rate"]);
    let mut text = format!(
        "{} frames{readable}, {} to {}\n  particles   {} to {}\n  rate        {} frames a second ({})\n",
        value["frames"],
        value["first"],
        value["last"],
        particles["min"],
        particles["max"],
        rate["frames_per_second"].as_f64().unwrap_or_default() as f32,
        rate["how"].as_str().unwrap_or_default(),
    );
    let liveliest = &value["liveliest"];
    if let Some(speed) = liveliest["root_mean_square_speed"].as_f64() {
        let frame = &liveliest["frame"];
        text += &format!(
            "  liveliest   frame {frame}, with a root mean square speed of {speed:.3} in the files' unit of speed\n"
        );
    }
    for warning in value["warnings"].as_array().map(Vec::as_slice).unwrap_or_default() {
        text += &format!("  warning     {}\n", warning.as_str().unwrap_or_default());
    }
    text
}
