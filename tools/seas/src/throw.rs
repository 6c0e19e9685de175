//! Water that is thrown: it flies in clumps, which tear into threads behind their heads.

use glam::Vec3;

use crate::random::Random;
use crate::{Particle, SPRAY};

/// A clump of spray.
pub struct Clump {
    /// Where it left the water.
    pub from: Vec3,
    /// Metres per second, then.
    pub velocity: Vec3,
    /// Seconds since its head left; its tail follows.
    pub time: f32,
    /// How fast it comes apart, metres per second.
    pub spread: f32,
    /// What the air gives it, metres per second squared.
    pub wind: Vec3,
}

impl Clump {
    /// Where what left so many seconds ago is.
    pub fn at(&self, time: f32) -> Vec3 {
        let fall = self.wind - 9.81 * Vec3::Y;
        self.from + time * self.velocity + 0.5 * time * time * fall
    }

    /// A particle of it; those that would be under `floor` lie on it.
    pub fn draw(&self, random: &mut Random, floor: f32) -> Particle {
        // Densest at the head.
        let part = 1.0 - random.unit() * random.unit();
        let time = self.time * part;
        let mut position = self.at(time) + (0.05 + self.spread * time) * random.ball();
        position.y = position.y.max(floor);
        Particle { position, kind: SPRAY, age: 0.15 + 0.5 * random.unit() * part }
    }
}
