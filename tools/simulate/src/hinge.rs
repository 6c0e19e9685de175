//! A rigid body on a fixed axle: one angle, driven by its own weight and by the water's pressure.
//!
//! One degree of freedom needs no engine for rigid bodies, whose contacts and joints would be
//! solved only approximately; here the axle cannot drift, and every run gives the same numbers.

use glam::Vec3;

/// Gravity, m/s².
pub const GRAVITY: Vec3 = Vec3::new(0.0, -9.81, 0.0);

/// The body and its motion.
#[derive(Clone, Debug)]
pub struct Hinge {
    /// A point on the axle, which is parallel to z.
    pub axle: Vec3,
    /// The mass, kilograms.
    pub mass: f32,
    /// From the axle to the centre of mass, at rest.
    pub lever: Vec3,
    /// The moment of inertia about the axle, kg m².
    pub inertia: f32,
    /// The friction of the axle, N m per rad/s.
    pub friction: f32,
    /// The least and the largest turn from rest, radians about +z.
    pub range: [f32; 2],
    /// Fraction of the speed that is kept when the body bounces off an end of its range.
    pub bounce: f32,
    /// Angle from rest, radians.
    pub turn: f32,
    /// Angular speed, rad/s.
    pub speed: f32,
    /// Angular acceleration of the last step, rad/s².
    pub acceleration: f32,
}

/// Speed below which it comes to rest at an end of its range, rad/s.
const QUIET: f32 = 0.4;

impl Hinge {
    /// Velocity of the body at a point.
    pub fn velocity(&self, at: Vec3) -> Vec3 {
        let arm = at - self.axle;
        self.speed * Vec3::new(-arm.y, arm.x, 0.0)
    }

    /// Arm of a force about the axle: the factor that gives the torque about z.
    pub fn torque(&self, at: Vec3, force: Vec3) -> f32 {
        let arm = at - self.axle;
        arm.x * force.y - arm.y * force.x
    }

    /// Advances the angle by the speed.
    pub fn advance(&mut self, dt: f32) {
        let [low, high] = self.range;
        self.turn = (self.turn + self.speed * dt).clamp(low, high);
    }

    /// Changes the speed by `impulse`, the water's angular impulse during `dt`, and by the body's own weight. `carried`
    /// is the moment of inertia of the water that moves with the body. The impulse contains that water's resistance to
    /// the last step's acceleration instead of this one's. That does no harm while the water is lighter than the body,
    /// but with heavier water each step would overshoot. So the carried water is moved to the body's side of the
    /// equation.
    pub fn accelerate(&mut self, impulse: f32, carried: f32, dt: f32) {
        let arm = glam::Quat::from_rotation_z(self.turn) * self.lever;
        let weight = self.torque(self.axle + arm, self.mass * GRAVITY);
        let torque = impulse / dt + weight - self.friction * self.speed;
        self.acceleration = (torque + carried * self.acceleration) / (self.inertia + carried);
        self.speed += self.acceleration * dt;
        let [low, high] = self.range;
        let outward = if self.turn <= low {
            -self.speed
        } else if self.turn >= high {
            self.speed
        } else {
            0.0
        };
        if outward > 0.0 {
            self.speed = if outward > QUIET { -self.bounce * self.speed } else { 0.0 };
            self.acceleration = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pendulum() -> Hinge {
        Hinge {
            axle: Vec3::new(1.0, 2.0, 0.0),
            mass: 3.0,
            lever: Vec3::new(0.5, 0.0, 0.0),
            inertia: 3.0 * 0.25,
            friction: 0.0,
            range: [-4.0, 1.0],
            bounce: 0.0,
            turn: 0.0,
            speed: 0.0,
            acceleration: 0.0,
        }
    }

    #[test]
    fn it_keeps_its_energy() {
        let mut hinge = pendulum();
        let energy =
            |h: &Hinge| 0.5 * h.inertia * h.speed * h.speed + h.mass * 9.81 * 0.5 * h.turn.sin();
        for _ in 0..2000 {
            hinge.accelerate(0.0, 0.0, 5e-4);
            hinge.advance(5e-4);
            assert!(energy(&hinge).abs() < 0.05, "{}", energy(&hinge));
        }
        assert!(hinge.turn < -1.0);
    }

    #[test]
    fn it_stops_at_the_ends_of_its_range() {
        let mut hinge = Hinge { range: [-0.5, 0.5], ..pendulum() };
        for _ in 0..4000 {
            hinge.accelerate(0.0, 0.0, 5e-4);
            hinge.advance(5e-4);
        }
        assert_eq!((hinge.turn, hinge.speed), (-0.5, 0.0));
    }

    #[test]
    fn carried_water_resists_without_overshooting() {
        // The water is three times as heavy as the body, and its resistance is felt one step late.
        let mut hinge = pendulum();
        let carried = 3.0 * hinge.inertia;
        let dt = 1e-3;
        for _ in 0..50 {
            let late = -carried * hinge.acceleration * dt;
            hinge.accelerate(late, carried, dt);
        }
        let weight = 3.0 * 9.81 * 0.5;
        let expected = -weight / (hinge.inertia + carried);
        assert!((hinge.acceleration / expected - 1.0).abs() < 0.02, "{}", hinge.acceleration);
    }
}
