//! Neighbour search: a uniform grid with cells as wide as the kernel's support, and particles sorted by cell. The
//! order, and with it every sum over neighbours, depends on the particles alone, never on the number of threads.

use glam::{IVec3, Vec3};
use rayon::prelude::*;

use crate::kernel::Kernel;

/// Particles that one task handles together; sums are formed per block too.
pub const BLOCK: usize = 256;

/// The grid over an axis-aligned box.
pub struct Grid {
    min: Vec3,
    size: IVec3,
    cell: f32,
    /// First particle of each cell, and the number of particles at the end.
    starts: Vec<u32>,
}

/// The neighbours of one block of particles.
#[derive(Default)]
pub struct NeighbourBlock {
    starts: Vec<u32>,
    indices: Vec<u32>,
    /// `m ∇W` of each pair.
    gradients: Vec<Vec3>,
}

impl NeighbourBlock {
    /// The neighbours of the block's particle `local`: index and `m ∇W`.
    pub fn of(&self, local: usize) -> impl Iterator<Item = (usize, Vec3)> {
        let range = self.starts[local] as usize..self.starts[local + 1] as usize;
        let indices = self.indices[range.clone()].iter().map(|&j| j as usize);
        indices.zip(self.gradients[range].iter().copied())
    }

    /// How many neighbours the block's particle `local` has.
    pub fn count(&self, local: usize) -> usize {
        (self.starts[local + 1] - self.starts[local]) as usize
    }
}

impl Grid {
    /// A grid over the box from `min` to `max`.
    pub fn new(min: Vec3, max: Vec3, cell: f32) -> Self {
        Self {
            min,
            size: ((max - min) / cell).ceil().as_ivec3().max(IVec3::ONE),
            cell,
            starts: Vec::new(),
        }
    }

    fn cell_of(&self, at: Vec3) -> IVec3 {
        ((at - self.min) / self.cell).floor().as_ivec3().clamp(IVec3::ZERO, self.size - 1)
    }

    fn index(&self, cell: IVec3) -> usize {
        ((cell.z * self.size.y + cell.y) * self.size.x + cell.x) as usize
    }

    /// Sorts by cell, stably. Returns the order in which to arrange the particles.
    pub fn sort(&mut self, positions: &[Vec3]) -> Vec<u32> {
        let cells: Vec<u32> =
            positions.par_iter().map(|&at| self.index(self.cell_of(at)) as u32).collect();
        self.starts.clear();
        self.starts.resize((self.size.x * self.size.y * self.size.z) as usize + 1, 0);
        for &cell in &cells {
            self.starts[cell as usize + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        let mut next = self.starts.clone();
        let mut order = vec![0; positions.len()];
        for (i, &cell) in cells.iter().enumerate() {
            order[next[cell as usize] as usize] = i as u32;
            next[cell as usize] += 1;
        }
        order
    }

    /// Neighbours of all particles, which must be in the order of the last `sort`.
    pub fn neighbours(
        &self,
        positions: &[Vec3],
        kernel: &Kernel,
        mass: f32,
    ) -> Vec<NeighbourBlock> {
        let blocks = positions.len().div_ceil(BLOCK);
        let reach = kernel.support() * kernel.support();
        (0..blocks)
            .into_par_iter()
            .map(|block| {
                let mut out = NeighbourBlock::default();
                out.starts.push(0);
                for i in block * BLOCK..positions.len().min((block + 1) * BLOCK) {
                    let at = positions[i];
                    let cell = self.cell_of(at);
                    let low = (cell - 1).max(IVec3::ZERO);
                    let high = (cell + 1).min(self.size - 1);
                    for z in low.z..=high.z {
                        for y in low.y..=high.y {
                            // Cells along x are neighbours in memory too.
                            let from = self.starts[self.index(IVec3::new(low.x, y, z))];
                            let to = self.starts[self.index(IVec3::new(high.x, y, z)) + 1];
                            for j in from..to {
                                let offset = at - positions[j as usize];
                                let square = offset.length_squared();
                                if square < reach && j as usize != i {
                                    out.indices.push(j);
                                    out.gradients
                                        .push(mass * kernel.gradient(offset, square.sqrt()));
                                }
                            }
                        }
                    }
                    out.starts.push(out.indices.len() as u32);
                }
                out
            })
            .collect()
    }
}
