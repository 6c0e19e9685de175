//! Twin of moving blobs: forces between pairs and from solids, the order of a substep, and the
//! energy.

use glam::{DQuat, DVec3};
use whitewater::bubbles::BlobSimulationSettings;

/// A blob.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob {
    pub place: DVec3,
    pub radius: f64,
    pub speed: DVec3,
    pub spin: DVec3,
    /// Rotation to the world.
    pub turn: DQuat,
    pub id: u32,
}

impl Blob {
    fn mass(&self) -> f64 {
        self.radius.powi(3)
    }
}

/// A plane: its normal and its distance from the origin.
pub type Plane = (DVec3, f64);

/// A box: its centre, half its edges, and its rotation to the world.
#[derive(Clone, Copy, Debug)]
pub struct Cuboid {
    pub center: DVec3,
    pub half: DVec3,
    pub turn: DQuat,
}

impl Cuboid {
    /// Direction out of the box at a place, and the place's distance from it. Inside, the distance
    /// is negative, and the direction is that of the nearest face: of two opposite ones that are
    /// equally near, the positive one; of several axes, the first.
    pub fn out_of(&self, place: DVec3) -> (DVec3, f64) {
        let own = self.turn.conjugate() * (place - self.center);
        let nearest = own.clamp(-self.half, self.half);
        if nearest != own {
            let off = own - nearest;
            return (self.turn * (off / off.length()), off.length());
        }
        let inside = self.half - own.abs();
        let axis = match inside {
            v if v.x <= v.y.min(v.z) => 0,
            v if v.y <= v.z => 1,
            _ => 2,
        };
        let face = if own[axis] < 0.0 { -DVec3::AXES[axis] } else { DVec3::AXES[axis] };
        (self.turn * face, -inside[axis])
    }
}

/// Factor of a ball's inverse moment of inertia.
const ROUND: f64 = 2.5;

/// Effect of `other` on `own`: changes of velocity and spin per second.
fn pair(own: &Blob, other: &Blob, s: &BlobSimulationSettings) -> Option<(DVec3, DVec3)> {
    let [rest, reach] = [s.rest, s.reach].map(|v| f64::from(v) * (own.radius + other.radius));
    let to = other.place - own.place;
    let far = to.length();
    if far >= reach {
        return None;
    }
    let n = to / far;
    let part = (reach - far) / (reach - rest);
    let along = if far < rest {
        f64::from(s.stiffness) * (far - rest)
    } else {
        4.0 * part * (1.0 - part) * f64::from(s.cohesion)
    };
    let at = |blob: &Blob, n: DVec3| blob.speed + blob.spin.cross(blob.radius * n);
    let slip = at(other, -n) - at(own, n);
    let parting = slip.dot(n);
    let near = part.min(1.0);
    let [d_along, d_across] = [s.normal_damping, s.tangential_damping].map(f64::from);
    let across = d_across * near * (slip - parting * n);
    let share = 2.0 * other.mass() / (own.mass() + other.mass());
    let speed = share * ((along + d_along * near * parting) * n + across);
    Some((speed, share * ROUND / own.radius * n.cross(across)))
}

/// One substep among planes.
pub fn part(blobs: &[Blob], planes: &[Plane], s: &BlobSimulationSettings, dt: f64) -> Vec<Blob> {
    let solids = |place: DVec3| -> Vec<(DVec3, f64)> {
        planes.iter().map(|(n, distance)| (*n, n.dot(place) - distance)).collect()
    };
    part_among(blobs, &solids, s, dt)
}

/// One substep. `solids` returns, for a place, the direction out of each solid and the distance
/// from it.
pub fn part_among(
    blobs: &[Blob],
    solids: &dyn Fn(DVec3) -> Vec<(DVec3, f64)>,
    s: &BlobSimulationSettings,
    dt: f64,
) -> Vec<Blob> {
    let gravity = glam::Vec3::from(s.gravity).as_dvec3();
    let one = |(i, own): (usize, &Blob)| {
        let (mut speed, mut spin) = (DVec3::ZERO, DVec3::ZERO);
        for (j, other) in blobs.iter().enumerate() {
            if let Some((a, b)) = (i != j).then(|| pair(own, other, s)).flatten() {
                speed += a;
                spin += b;
            }
        }
        // Water carries the part of a blob that is under it, in proportion to the displaced mass, and
        // brakes it by 8 1/s.
        let height = -own.place.dot(gravity.normalize_or_zero());
        let under = s.water.map_or(0.0, |level| {
            ((f64::from(level) - height + own.radius) / (2.0 * own.radius)).clamp(0.0, 1.0)
        });
        let pull = gravity * (1.0 - under / f64::from(s.density));
        let drag = 1.0 + dt * f64::from(s.drag);
        let slowed = 1.0 + dt * (f64::from(s.drag) * (1.0 - under) + 8.0 * under);
        let mut new = *own;
        new.speed = (own.speed + dt * (speed + pull)) / slowed;
        new.spin = (own.spin + dt * spin) / drag;
        for (n, away) in solids(own.place) {
            let deep = f64::from(s.contact) * own.radius - away;
            if deep <= 0.0 {
                continue;
            }
            let parting = new.speed.dot(n);
            let press = f64::from(s.solidity) * deep - f64::from(s.solid_damping) * parting;
            let gained = (dt * press).max(0.0);
            new.speed += gained * n;
            let mut slip = new.speed + new.spin.cross(-own.radius * n);
            slip -= slip.dot(n) * n;
            let fast = slip.length();
            let held = (f64::from(s.friction) * gained).min(fast / (1.0 + ROUND));
            let change = if fast > 0.0 { -held / fast * slip } else { DVec3::ZERO };
            new.speed += change;
            new.spin += ROUND / own.radius * (-n).cross(change);
        }
        let most = own.radius / dt;
        new.speed *= (most / new.speed.length().max(1e-20)).min(1.0);
        new.place += dt * new.speed;
        new.turn = DQuat::from_scaled_axis(dt * new.spin) * own.turn;
        new
    };
    blobs.iter().enumerate().map(one).collect()
}

/// Energy of motion, height, compression and attraction. The attraction has the potential of its
/// force from the distance where it begins; a mass is a cubed radius.
pub fn energy(blobs: &[Blob], planes: &[Plane], s: &BlobSimulationSettings) -> f64 {
    let gravity = glam::Vec3::from(s.gravity).as_dvec3();
    let mut sum = 0.0;
    for (i, a) in blobs.iter().enumerate() {
        let turning = 0.4 * a.radius * a.radius * a.spin.length_squared();
        sum += a.mass() * (0.5 * (a.speed.length_squared() + turning) - gravity.dot(a.place));
        for (n, distance) in planes {
            let deep = f64::from(s.contact) * a.radius - (n.dot(a.place) - distance);
            sum += 0.5 * a.mass() * f64::from(s.solidity) * deep.max(0.0).powi(2);
        }
        for b in &blobs[i + 1..] {
            let [rest, reach] = [s.rest, s.reach].map(|v| f64::from(v) * (a.radius + b.radius));
            let far = a.place.distance(b.place);
            if far >= reach {
                continue;
            }
            // The force times the harmonic mean of the masses.
            let mass = 2.0 * a.mass() * b.mass() / (a.mass() + b.mass());
            let width = reach - rest;
            let part = ((reach - far) / width).min(1.0);
            let pull =
                -4.0 * f64::from(s.cohesion) * width * (part.powi(2) / 2.0 - part.powi(3) / 3.0);
            let push = 0.5 * f64::from(s.stiffness) * (rest - far).max(0.0).powi(2);
            sum += mass * (pull + push);
        }
    }
    sum
}
