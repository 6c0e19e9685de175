//! The blob simulation on the CPU, as in the source, to compare its time with the GPU's. It has the same forces and
//! the same grid as the one on the GPU, and runs on all cores.

use std::num::NonZero;

use glam::{IVec3, Quat, Vec3};
use whitewater::bubbles::{BlobSimulationSettings, Solid};
use whitewater::headless::Bubble;

/// Reciprocal of the factor 2/5 in a ball's moment of inertia.
const ROUND: f32 = 2.5;
/// Limit of balls that are visited in a bucket, as on the GPU.
const MOST_IN_BUCKET: usize = 128;

#[derive(Clone, Copy)]
struct Ball {
    place: Vec3,
    radius: f32,
    speed: Vec3,
    spin: Vec3,
    turn: Quat,
    id: u32,
}

/// Blobs in motion.
pub struct CpuHeap {
    balls: Vec<Ball>,
    settings: BlobSimulationSettings,
    solids: Vec<Solid>,
    /// Grid cells per scene unit.
    cells: f32,
    threads: usize,
}

impl CpuHeap {
    /// Blobs at rest; all radii are above 0.
    pub fn new(blobs: &[Bubble], settings: &BlobSimulationSettings, solids: &[Solid]) -> Self {
        let ball = |blob: &Bubble| {
            let [x, y, z, radius] = blob.ball;
            Ball {
                place: Vec3::new(x, y, z),
                radius,
                speed: Vec3::ZERO,
                spin: Vec3::ZERO,
                turn: Quat::from_array(blob.turn),
                id: blob.id,
            }
        };
        let largest = blobs.iter().map(|b| b.ball[3]).fold(f32::MIN_POSITIVE, f32::max);
        Self {
            balls: blobs.iter().map(ball).collect(),
            settings: *settings,
            solids: solids.to_vec(),
            cells: 1.0 / (2.0 * largest * settings.reach),
            threads: std::thread::available_parallelism().map_or(1, NonZero::get),
        }
    }

    /// Advances the blobs by `dt` seconds.
    pub fn step(&mut self, dt: f32) {
        for _ in 0..self.settings.substeps {
            self.part(dt / self.settings.substeps as f32);
        }
    }

    /// Advances the blobs by one substep of `dt` seconds. The grid sorts the balls, so that those of a bucket are
    /// adjacent, in the order of their ids.
    fn part(&mut self, dt: f32) {
        let grid = Grid::new(&mut self.balls, self.cells);
        let mut moved = self.balls.clone();
        let share = moved.len().div_ceil(self.threads).max(1);
        let (this, grid) = (&*self, &grid);
        std::thread::scope(|scope| {
            for (chunk, own) in moved.chunks_mut(share).enumerate() {
                scope.spawn(move || {
                    for (i, ball) in own.iter_mut().enumerate() {
                        *ball = this.moved(grid, chunk * share + i, dt);
                    }
                });
            }
        });
        self.balls = moved;
    }

    fn moved(&self, grid: &Grid, index: usize, dt: f32) -> Ball {
        let s = &self.settings;
        let own = self.balls[index];
        let cell = grid.cell(own.place);
        let (mut push, mut twist) = (Vec3::ZERO, Vec3::ZERO);
        for i in 0..27 {
            let beside = cell + IVec3::new(i % 3, i / 3 % 3, i / 9) - 1;
            for j in grid.bucket(beside) {
                let other = &self.balls[j];
                // Several cells share a bucket.
                if j != index && grid.cell(other.place) == beside {
                    let (by, turned) = self.pushed_by(&own, other);
                    push += by;
                    twist += turned;
                }
            }
        }
        let level = s.water.unwrap_or(f32::MIN);
        let wet = ((level - own.place.y + own.radius) / (2.0 * own.radius)).clamp(0.0, 1.0);
        let pull = Vec3::from(s.gravity) * (1.0 - wet / s.density);
        let mut speed = own.speed + dt * (push + pull);
        speed /= 1.0 + dt * (s.drag + wet * (8.0 - s.drag));
        let mut spin = (own.spin + dt * twist) / (1.0 + dt * s.drag);
        for solid in &self.solids {
            let (out, distance) = solid_at(solid, own.place);
            self.touch((out, distance), own.radius, (&mut speed, &mut spin), dt);
        }
        speed *= (own.radius / dt / speed.length().max(1.0e-20)).min(1.0);
        let half = 0.5 * dt * spin;
        let turn = own.turn + Quat::from_xyzw(half.x, half.y, half.z, 0.0) * own.turn;
        Ball { place: own.place + dt * speed, speed, spin, turn: turn.normalize(), ..own }
    }

    /// Acceleration and angular acceleration that a ball receives from another one.
    fn pushed_by(&self, own: &Ball, other: &Ball) -> (Vec3, Vec3) {
        let s = &self.settings;
        let to = other.place - own.place;
        let sum = own.radius + other.radius;
        let (far, rest, reach) = (to.length(), s.rest * sum, s.reach * sum);
        if far >= reach {
            return (Vec3::ZERO, Vec3::ZERO);
        }
        let up = if own.id < other.id { -Vec3::Y } else { Vec3::Y };
        let n = if far > 1.0e-6 * sum { to / far } else { up };
        let part = (reach - far) / (reach - rest);
        let along = if far < rest {
            s.stiffness * (far - rest)
        } else {
            4.0 * part * (1.0 - part) * s.cohesion
        };
        let slip = other.speed
            - own.speed
            - other.spin.cross(other.radius * n)
            - own.spin.cross(own.radius * n);
        let (parting, near) = (slip.dot(n), part.min(1.0));
        let across = s.tangential_damping * near * (slip - parting * n);
        // The forces on the two balls are equal and opposite, with the factor 2ab / (a + b) of their masses a (own)
        // and b. `share` is this factor divided by the own mass.
        let [a, b] = [own.radius, other.radius].map(|r| r * r * r);
        let share = 2.0 * b / (a + b);
        let push = (along + s.normal_damping * near * parting) * n + across;
        (share * push, share * ROUND / own.radius * n.cross(across))
    }

    /// Applies the contact with a solid (direction out of it, distance) to the speed and spin of a ball: a penalty
    /// force along the normal, and friction at most in proportion to that force.
    fn touch(
        &self,
        (n, distance): (Vec3, f32),
        radius: f32,
        (speed, spin): (&mut Vec3, &mut Vec3),
        dt: f32,
    ) {
        let s = &self.settings;
        let deep = s.contact * radius - distance;
        if deep <= 0.0 {
            return;
        }
        let parting = speed.dot(n);
        let gained = (dt * (s.solidity * deep - s.solid_damping * parting)).max(0.0);
        *speed += gained * n;
        let slip = *speed - speed.dot(n) * n + spin.cross(-radius * n);
        let slip = slip - slip.dot(n) * n;
        let fast = slip.length();
        // Friction changes the speed at most so far that the ball stops sliding at the contact; then it rolls.
        let held = (s.friction * gained).min(fast / (1.0 + ROUND));
        let change = if fast > 0.0 { -held / fast * slip } else { Vec3::ZERO };
        *speed += change;
        *spin += ROUND / radius * (-n).cross(change);
    }

    /// Positions in the order of the ids.
    #[cfg(test)]
    pub fn places(&self) -> Vec<Vec3> {
        let mut all: Vec<_> = self.balls.iter().map(|ball| (ball.id, ball.place)).collect();
        all.sort_by_key(|(id, _)| *id);
        all.into_iter().map(|(_, place)| place).collect()
    }
}

/// Hash table of grid cells.
struct Grid {
    cells: f32,
    /// Index of the first ball behind each bucket.
    ends: Vec<usize>,
}

impl Grid {
    /// Sorts the balls by bucket, then by id.
    fn new(balls: &mut [Ball], cells: f32) -> Self {
        let mut grid = Self { cells, ends: vec![0; balls.len().next_power_of_two()] };
        balls.sort_by_cached_key(|ball| (grid.number(grid.cell(ball.place)), ball.id));
        for ball in balls.iter() {
            let number = grid.number(grid.cell(ball.place));
            grid.ends[number] += 1;
        }
        let mut sum = 0;
        for end in &mut grid.ends {
            sum += *end;
            *end = sum;
        }
        grid
    }

    fn cell(&self, place: Vec3) -> IVec3 {
        (place * self.cells).floor().as_ivec3()
    }

    fn number(&self, cell: IVec3) -> usize {
        let mix = |h: u32, v: i32| (h ^ v as u32).wrapping_mul(0x9e37_79b1).rotate_left(15);
        mix(mix(mix(0, cell.x), cell.y), cell.z) as usize & (self.ends.len() - 1)
    }

    fn bucket(&self, cell: IVec3) -> std::ops::Range<usize> {
        let number = self.number(cell);
        let begin = if number > 0 { self.ends[number - 1] } else { 0 };
        begin..self.ends[number].min(begin + MOST_IN_BUCKET)
    }
}

/// The direction out of a solid, and the distance from it.
fn solid_at(solid: &Solid, place: Vec3) -> (Vec3, f32) {
    match *solid {
        Solid::Plane { normal, distance } => {
            let n = Vec3::from(normal);
            (n, n.dot(place) - distance)
        }
        Solid::Box { center, half_extents: half, rotation: turn } => {
            let turn = Quat::from_array(turn);
            let q = turn.inverse() * (place - Vec3::from(center));
            let d = q.abs() - Vec3::from(half);
            let out = d.max(Vec3::ZERO);
            let (beside, most) = (out.length(), d.max_element());
            let face = Vec3::AXES[d.max_position()];
            let n = q.signum() * if beside > 0.0 { out / beside } else { face };
            (turn * n, if beside > 0.0 { beside } else { most })
        }
    }
}

#[cfg(test)]
mod tests {
    use whitewater::ash::vk;
    use whitewater::bubbles::BubbleConfig;
    use whitewater::headless::{COLOR_FORMAT, Device, DeviceOptions, Headless};
    use whitewater::{Config, Error};

    use super::*;
    use crate::bubbles::{Motion, Which, set};

    /// The CPU simulation equals the GPU's: after a tenth of a second of sliding, positions agree to a hundredth of a
    /// radius, while the farthest blob has moved by more than 0.3 radii. (Errors grow with each contact.)
    #[test]
    fn it_is_the_heap_of_the_gpu() -> Result<(), Error> {
        let blobs = set(&Which::Slope(200)).unwrap().blobs;
        let Motion { settings, solids, .. } = blobs.motion.unwrap();
        let extent = vk::Extent2D { width: 16, height: 16 };
        let own = BubbleConfig::new(200).with(|it| {
            it.variants = 1;
            it.bubbles = 8;
        });
        let config = Config::new(extent, COLOR_FORMAT, 64).with(|it| it.bubbles = Some(own));
        let mut headless = Headless::new(Device::new(&DeviceOptions::default())?, &config)?;
        headless.heap(&blobs.blobs, None, 0)?;
        let mut heap = CpuHeap::new(&blobs.blobs, &settings, &solids);
        for _ in 0..6 {
            headless.heap_step(1.0 / 60.0, &settings, &solids)?;
            heap.step(1.0 / 60.0);
        }
        let found = headless.heap_blobs()?;
        let places = heap.places();
        let (mut worst, mut moved) = (0.0_f32, 0.0_f32);
        for (blob, before) in found.iter().zip(&blobs.blobs) {
            let [at, then] = [blob, before].map(|b| Vec3::from_slice(&b.ball[..3]));
            worst = worst.max(at.distance(places[blob.id as usize]) / blob.ball[3]);
            moved = moved.max(at.distance(then) / blob.ball[3]);
        }
        headless.finish()?;
        assert!(worst < 0.01 && moved > 0.3, "{worst} and {moved} radii");
        Ok(())
    }
}
