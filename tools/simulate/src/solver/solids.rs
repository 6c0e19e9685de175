//! Solids: the fraction of the water's kernel that they cover, and the reaction of the water on moving ones.

use glam::Vec3;

use super::{Simulation, WALL_OFFSET};
use crate::scene::Solid;

/// A solid that water collides with, in its present position.
pub(super) struct Obstacle {
    pub solid: Solid,
    pub reach: f32,
}

impl Obstacle {
    /// Distance and the direction in which it grows, if the distance is less than `limit`.
    pub fn within(&self, at: Vec3, limit: f32) -> Option<(f32, Vec3)> {
        let far = self.reach + limit;
        if (at - self.solid.centre).length_squared() > far * far {
            return None;
        }
        Some(self.solid.distance(at)).filter(|(d, _)| *d < limit)
    }
}

impl Simulation {
    /// Turns the moving solids to the hinge's angle.
    pub(super) fn pose(&mut self) {
        let solids = self.scene.posed(self.scene.hinge.as_ref().map_or(0.0, |hinge| hinge.turn));
        let solids = solids.into_iter().filter(|solid| solid.collides);
        self.obstacles = solids.map(|solid| Obstacle { reach: solid.reach(), solid }).collect();
    }

    /// Distance of the nearest solid, at most one support radius.
    pub(super) fn nearest_solid(&self, at: Vec3) -> f32 {
        self.nearest(at).map_or(self.kernel.support(), |(d, _)| d)
    }

    /// Distance of the nearest solid within a support radius, and whether it moves.
    pub(super) fn nearest(&self, at: Vec3) -> Option<(f32, bool)> {
        let limit = self.kernel.support();
        let near = self.obstacles.iter().filter_map(|obstacle| {
            obstacle.within(at, limit).map(|(d, _)| (d, obstacle.solid.moves))
        });
        near.reduce(|a, b| if b.0 < a.0 { b } else { a })
    }

    /// Fraction of the kernel at `at` that solids cover, its gradient, and the moving solids' part of the gradient.
    /// Where solids meet, their covers overlap: the free fraction is taken to be the product of the free fractions of
    /// each, which is exact in the corner of perpendicular walls.
    pub(super) fn covered(&self, at: Vec3) -> (f32, Vec3, Vec3) {
        let mut free = 1.0;
        let (mut gradient, mut moving) = (Vec3::ZERO, Vec3::ZERO);
        let offset = WALL_OFFSET * self.spacing;
        for obstacle in &self.obstacles {
            if let Some((d, normal)) = obstacle.within(at, self.kernel.support() + offset) {
                let (part, slope) = self.kernel.half_space(d - offset);
                let own = normal * (slope * free);
                gradient = gradient * (1.0 - part) - own;
                moving *= 1.0 - part;
                if obstacle.solid.moves {
                    moving -= own;
                }
                free *= 1.0 - part;
            }
        }
        (1.0 - free, gradient, moving)
    }

    /// Part of `Dρ/Dt` that comes from the motion of solids.
    pub(super) fn solids_rate(&self) -> Vec<f32> {
        match &self.scene.hinge {
            Some(hinge) => {
                let walls = self.moving_wall.iter().zip(&self.position);
                walls.map(|(wall, at)| -wall.dot(hinge.velocity(*at))).collect()
            }
            None => vec![0.0; self.position.len()],
        }
    }

    /// Angular impulse on the hinge from the water's impulses `strength`.
    pub(super) fn reaction(&self, strength: &[f32]) -> f64 {
        let Some(hinge) = &self.scene.hinge else {
            return 0.0;
        };
        // Summed in the order of the particles, independent of threads.
        let walls = self.moving_wall.iter().zip(&self.position).zip(strength);
        let impulses = walls.map(|((wall, at), strength)| {
            f64::from(hinge.torque(*at, *wall * (self.mass * strength)))
        });
        impulses.sum()
    }

    /// Moment of inertia of the water that moves with the solids: water against them or in a bore.
    pub(super) fn carried(&self, axle: Vec3) -> f32 {
        let moving: Vec<&Solid> =
            self.obstacles.iter().map(|o| &o.solid).filter(|solid| solid.moves).collect();
        let inertia = |at: &Vec3| {
            let arm = (*at - axle).truncate().length_squared();
            let held = moving.iter().any(|solid| solid.holds(*at));
            if held { f64::from(self.mass * arm) } else { 0.0 }
        };
        self.position.iter().map(inertia).sum::<f64>() as f32
    }
}
