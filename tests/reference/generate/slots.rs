//! Storage slots of the particles.

use super::motion::{carried_by, moved_in};
use super::water::{Fluid, Grid};
use super::{Particle, Settings, count, newborn, potentials, wanted};

/// All whitewater particles. A particle that has died leaves a free slot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slots {
    /// All slots used so far. A slot whose particle has an age of 1 or more is free.
    pub particles: Vec<Particle>,
    /// Max number of slots.
    pub most: usize,
    /// Number of new particles that were discarded because no slot was left.
    pub lost: u64,
}

impl Slots {
    /// Advances by dt seconds: existing particles move, then new particles take the free slots in
    /// ascending order, and new slots after them.
    pub fn step(&mut self, fluid: &Fluid, settings: &Settings, dt: f32, number: u32) {
        let grid = Grid::new(fluid, settings.spacing);
        for particle in &mut self.particles {
            let water = carried_by(grid.near(particle.position), settings);
            (*particle, _) = moved_in(particle, &water, settings, dt);
        }
        let high = self.particles.len();
        let mut free =
            (0..high).filter(|slot| self.particles[*slot].age >= 1.0).collect::<Vec<_>>();
        free.reverse();
        for (i, p) in potentials(fluid, settings).iter().enumerate() {
            let Some(p) = p else { continue };
            for k in 0..count(wanted(p, settings, dt), settings, fluid.ids[i], number) {
                let particle = newborn(fluid, i, p, k, settings, dt, number);
                match free.pop() {
                    Some(slot) => self.particles[slot] = particle,
                    None if self.particles.len() < self.most => self.particles.push(particle),
                    None => self.lost += 1,
                }
            }
        }
    }
}
