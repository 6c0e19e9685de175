//! Thrown water: it flies in clumps, which tear into threads behind their heads.

use glam::Vec3;

use crate::random::Random;
use crate::{Particle, SPRAY};

/// A clump of spray.
pub struct Clump {
    /// Position where it left the water.
    pub from: Vec3,
    /// Velocity when it left the water, metres per second.
    pub velocity: Vec3,
    /// Seconds since the clump's head left; its tail left later.
    pub time: f32,
    /// Speed at which the clump spreads, metres per second.
    pub spread: f32,
    /// Acceleration by the wind, metres per second squared.
    pub wind: Vec3,
}

impl Clump {
    /// Position of water that left `time` seconds ago.
    pub fn at(&self, time: f32) -> Vec3 {
        let fall = self.wind - 9.81 * Vec3::Y;
        self.from + time * self.velocity + 0.5 * time * time * fall
    }

    /// Draws a particle of the clump. One that would be under `floor` lies on it.
    pub fn draw(&self, random: &mut Random, floor: f32) -> Particle {
        // The clump is densest at its head.
        let part = 1.0 - random.unit() * random.unit();
        let time = self.time * part;
        let mut position = self.at(time) + (0.05 + self.spread * time) * random.ball();
        position.y = position.y.max(floor);
        Particle { position, kind: SPRAY, age: 0.15 + 0.5 * random.unit() * part }
    }
}
