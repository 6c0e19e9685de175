//! Neighbour search: particles in grid cells as wide as the search radius.

use std::num::NonZeroUsize;

use glam::Vec3;

/// Bits per axis of a cell's key.
const BITS: u32 = 21;
/// Number of particles from which threads pay off.
const MANY: usize = 4096;

/// A particle and the key of its cell.
#[derive(Clone, Copy)]
struct Placed {
    key: u64,
    index: u32,
    position: Vec3,
}

/// Particles with finite positions, sorted by cell. 24 bytes each.
pub struct Cells {
    placed: Vec<Placed>,
    reach: f32,
}

impl Cells {
    /// The particles that `wanted` selects.
    pub fn new(positions: &[[f32; 3]], reach: f32, wanted: impl Fn(usize) -> bool) -> Self {
        let all = (0_u32..).zip(positions).map(|(index, p)| (index, Vec3::from(*p)));
        let mut placed: Vec<Placed> = all
            .filter(|(index, p)| p.is_finite() && wanted(*index as usize))
            .map(|(index, position)| Placed { key: key(cell(position, reach)), index, position })
            .collect();
        placed.sort_unstable_by_key(|one| (one.key, one.index));
        Self { placed, reach }
    }

    /// Calls `of` for each particle that `asked` selects, with the particle's index, its position, and all particles
    /// in its cell and the neighbouring cells. Among these are all particles within reach, and the particle itself.
    /// Runs on all cores.
    pub fn map<T: Send>(
        &self,
        asked: impl Fn(usize) -> bool + Sync,
        of: impl Fn(usize, Vec3, &mut dyn Iterator<Item = (usize, Vec3)>) -> T + Sync,
    ) -> Vec<(usize, T)> {
        let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        let all = self.placed.len();
        let share = if all < MANY { all } else { all.div_ceil(threads) };
        let (asked, of) = (&asked, &of);
        std::thread::scope(|scope| {
            let parts = self.placed.chunks(share.max(1));
            let parts: Vec<_> =
                parts.map(|part| scope.spawn(move || self.of_part(part, asked, of))).collect();
            // A thread that panicked contributes no results.
            parts.into_iter().filter_map(|part| part.join().ok()).flatten().collect()
        })
    }

    fn of_part<T>(
        &self,
        part: &[Placed],
        asked: impl Fn(usize) -> bool,
        of: impl Fn(usize, Vec3, &mut dyn Iterator<Item = (usize, Vec3)>) -> T,
    ) -> Vec<(usize, T)> {
        let all = &self.placed;
        let mut found = Vec::new();
        for same in part.chunk_by(|a, b| a.key == b.key) {
            let wanted = same.iter().filter(|one| asked(one.index as usize));
            let mut wanted = wanted.peekable();
            if wanted.peek().is_none() {
                continue;
            }
            let [x, y, z] = cell(same[0].position, self.reach);
            // Cells that are adjacent along x are adjacent in the sorted list. The particle's own row is the first, so
            // that a caller which needs only some neighbours finds them soon.
            let rows = [0, -1, 1].map(|dz| {
                [0, -1, 1].map(|dy| {
                    let [first, last] = [-1, 1].map(|dx| key([x + dx, y + dy, z + dz]));
                    let from = all.partition_point(|other| other.key < first);
                    let past = all.partition_point(|other| other.key <= last);
                    &all[from..past.max(from)]
                })
            });
            for one in wanted {
                let others = rows.iter().flatten().copied().flatten();
                let mut others = others.map(|other| (other.index as usize, other.position));
                let index = one.index as usize;
                found.push((index, of(index, one.position, &mut others)));
            }
        }
        found
    }
}

/// The cell of a position. The outermost cells also hold everything beyond them. That gives no wrong neighbours,
/// because callers compare the positions themselves.
fn cell(position: Vec3, reach: f32) -> [i64; 3] {
    let most = (1_i64 << (BITS - 1)) - 2;
    position.to_array().map(|c| ((c / reach).floor() as i64).clamp(-most, most))
}

fn key([x, y, z]: [i64; 3]) -> u64 {
    let part = |c: i64| (c + (1 << (BITS - 1))) as u64;
    part(z) << (2 * BITS) | part(y) << BITS | part(x)
}
