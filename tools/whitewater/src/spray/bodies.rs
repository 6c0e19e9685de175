//! Detects loose bodies of water, jets and falls whose particles have moved apart: their density is as low as that of
//! torn water, but they are no spray. Detects also lone clusters, which are spray although they may be dense.

use glam::Vec3;

use crate::cells::Cells;
use crate::smoothstep::smoothstep;

/// Search radius, in spacings.
const REACH: f32 = 4.0;
/// Number of particles within `REACH` in water at rest: one per cubic spacing.
const FULL: f32 = 4.0 / 3.0 * std::f32::consts::PI * REACH * REACH * REACH;
/// Only particles below this density, as fraction of the rest density, can be part of a loose body.
const DENSE: f32 = 0.8;
/// Fractions of the volume within `REACH` that water fills: up to the first a particle keeps its density, from the
/// second on it is part of a body. Among the particles of less than 0.6 of the rest density the median is 0.28 in a
/// jet that fans out from a nozzle, and 0.12 in the splash of a dam break at a pillar.
const FILLED: [f32; 2] = [0.2, 0.35];
/// Length of the sum of the vectors to the neighbours over the sum of their lengths: up to the first a particle has
/// neighbours on all sides, from the second on it is a drop over water. At a plane surface it is 0.5.
const ASIDE: [f32; 2] = [0.4, 0.6];
/// Numbers of particles within `REACH`, with the particle itself: up to the first it is part of a lone cluster, from the
/// second on it keeps its density. A cluster of 8 is two spacings wide.
pub const LONE: [f32; 2] = [8.0, 16.0];
/// Density of a particle inside a body, as fraction of the rest density. Few neighbours lower the density
/// (`SpraySettings::few_neighbours`); it is so high that the particle stays water, unless it has the fewest.
const CERTAIN: f32 = 4.0;

/// Raises the densities of particles in loose bodies of water, and lowers those of particles in lone clusters to `spray`.
/// `rest` is the rest density.
pub fn adjust_densities(
    positions: &[[f32; 3]],
    densities: &mut [f32],
    spacing: f32,
    (spray, rest): (f32, f32),
) {
    let reach = REACH * spacing;
    let cells = Cells::new(positions, reach, |_| true);
    let is_loose = |i: usize| densities[i] > 0.0 && densities[i] < DENSE * rest;
    let in_body = cells.map(is_loose, |_, p, others| {
        let (mut count, mut sum, mut lengths) = (0.0, Vec3::ZERO, 0.0);
        for off in others.map(|(_, other)| other - p) {
            let length = off.length();
            if length < reach {
                count += 1.0;
                sum += off;
                lengths += length;
            }
        }
        let aside = if lengths > 0.0 { sum.length() / lengths } else { 1.0 };
        smoothstep(FILLED, count / FULL) * (1.0 - smoothstep(ASIDE, aside))
    });
    let is_water = |i: usize| densities[i] > spray && densities[i].is_finite();
    let in_company = cells.map(is_water, |_, p, others| {
        let near = others.filter(|(_, other)| (*other - p).length_squared() < reach * reach);
        smoothstep(LONE, near.take(LONE[1] as usize).count() as f32)
    });
    for (index, share) in in_body {
        densities[index] += share * (CERTAIN * rest - densities[index]);
    }
    for (index, share) in in_company {
        densities[index] = spray + share * (densities[index] - spray);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bubbles::Random;

    const SPACING: f32 = 0.1;
    const REST: f32 = 1000.0;
    const SPRAY: f32 = 400.0;

    /// Densities of `positions`, all half the rest density before.
    fn classified(positions: &[[f32; 3]]) -> Vec<f32> {
        let mut densities = vec![0.5 * REST; positions.len()];
        adjust_densities(positions, &mut densities, SPACING, (SPRAY, REST));
        densities
    }

    /// Particles at random places in a box, as many as fill `filled` of its volume. `size` is in spacings.
    fn cloud(size: Vec3, filled: f32) -> Vec<[f32; 3]> {
        let mut random = Random(3);
        let mut next = || random.next();
        let count = (filled * size.x * size.y * size.z) as usize;
        (0..count)
            .map(|_| (SPACING * size * Vec3::new(next(), next(), next())).to_array())
            .collect()
    }

    /// Whether a position is at least one reach from the sides of the box.
    fn is_inside(size: Vec3, p: &[f32; 3]) -> bool {
        let p = Vec3::from(*p) / SPACING;
        p.min_element() > REACH && (size - p).min_element() > REACH
    }

    #[test]
    fn loose_jets_are_water_and_clouds_of_drops_are_not() {
        let size = Vec3::new(24.0, 16.0, 16.0);
        let of = |filled: f32| {
            let cloud = cloud(size, filled);
            let inside = cloud.iter().zip(classified(&cloud)).filter(|(p, _)| is_inside(size, p));
            let densities: Vec<f32> = inside.map(|(_, density)| density / REST).collect();
            assert!(densities.len() > 50, "{filled}");
            densities
        };
        // A random number of neighbours has a standard deviation of 0.043 of the volume or less.
        assert!(of(0.5).iter().all(|density| *density > 0.99 * CERTAIN));
        assert!(of(0.1).iter().all(|density| *density < 0.6));
        let between: f32 = of(0.275).iter().sum::<f32>() / of(0.275).len() as f32;
        assert!((1.0..CERTAIN - 0.5).contains(&between), "{between}");
    }

    #[test]
    fn drops_over_water_are_not_part_of_it() {
        let pool = |i: u16| [i % 16, i / 16 % 16, i / 256].map(|i| SPACING * (f32::from(i) + 0.5));
        let mut positions: Vec<[f32; 3]> = (0..2048).map(pool).collect();
        let drop = |height: f32| [0.8, 0.8, SPACING * (8.0 + height)];
        positions.extend([drop(1.0), drop(2.5)]);
        let densities = classified(&positions);
        assert_eq!(densities[2048..], [0.5 * REST; 2]);
        // Particles inside the pool are part of it.
        let deep = positions
            .iter()
            .position(|p| (Vec3::from(*p) - Vec3::new(0.8, 0.8, 0.4)).length() < 0.1);
        assert!(densities[deep.unwrap()] > 0.99 * CERTAIN * REST);
    }

    #[test]
    fn lone_clusters_are_spray_and_streams_and_sheets_are_not() {
        // Columns of the cross-section times lengths, in spacings.
        let block = |[x, y, z]: [u16; 3]| {
            let all = (0..x * y * z).map(|i| [i % x, i / x % y, i / (x * y)].map(f32::from));
            all.map(|p| p.map(|c| SPACING * c)).collect::<Vec<_>>()
        };
        for (size, spray) in
            [([2, 2, 2], true), ([1, 1, 2], true), ([2, 2, 9], false), ([9, 9, 1], false)]
        {
            let positions = block(size);
            let mut densities = vec![REST; positions.len()];
            adjust_densities(&positions, &mut densities, SPACING, (SPRAY, REST));
            // The ends of a stream and the corners of a sheet have fewer neighbours.
            let middle = densities[densities.len() / 2];
            assert_eq!(middle, if spray { SPRAY } else { REST }, "{size:?}");
        }
        // A cluster that flies past a pool.
        let mut both = block([8, 8, 8]);
        both.extend(block([2, 2, 1]).iter().map(|[x, y, z]| [*x, *y, z + 12.0 * SPACING]));
        let mut densities = vec![REST; both.len()];
        adjust_densities(&both, &mut densities, SPACING, (SPRAY, REST));
        assert!(densities[..512].iter().all(|d| *d == REST) && densities[512..] == [SPRAY; 4]);
    }

    #[test]
    fn dense_and_invalid_particles_keep_their_densities() {
        let odd = [[f32::NAN; 3], [0.0; 3], [f32::INFINITY; 3]];
        assert_eq!(classified(&odd), [0.5 * REST, SPRAY, 0.5 * REST]);
        let cloud = cloud(Vec3::splat(12.0), 0.6);
        for density in [0.0, DENSE * REST, REST, f32::NAN, f32::INFINITY] {
            let mut densities = vec![density; cloud.len()];
            adjust_densities(&cloud, &mut densities, SPACING, (SPRAY, REST));
            assert!(densities.iter().all(|d| d.to_bits() == density.to_bits()), "{density}");
        }
        adjust_densities(&[], &mut [], SPACING, (SPRAY, REST));
    }
}
