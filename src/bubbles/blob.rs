//! A blob of foam: soap bubbles on a shell around a core (Huszár, Szécsi, Sec. 4.1), generated from a seed.
//!
//! The films of two neighbours A and B and the wall between them should meet at 120°. They do where the distance of
//! the centres is `|AB|² = r_A² + r_B² − r_A r_B`. A shell cannot be packed exactly so, only nearly: its area is that
//! of one hexagon of this spacing per bubble, and bubbles that are closer than that push each other apart along the
//! shell.
//!
//! The generation of a blob uses no transcendental function, so that a seed gives the same blob on every machine.

use glam::DVec3;

use crate::random::Random;

/// Minimum and maximum number of bubbles of a blob: the impostor's maps have eight bits for an index.
pub const BUBBLES: std::ops::RangeInclusive<u32> = 8..=256;

/// Number of candidates for a bubble's initial position; the one farthest from all other bubbles is taken.
const CANDIDATES: u32 = 8;
/// Iterations of the repulsion between bubbles.
const ROUNDS: u32 = 40;
/// Greatest deviation of a bubble's radius from the mean radius, as a part of it (`SPREAD`), and of a bubble's centre
/// from the shell, in radii of the bubble (`OFF_SHELL`).
const SPREAD: f64 = 0.3;
const OFF_SHELL: f64 = 0.15;

/// Maximum number of stored neighbours per bubble (glsl/include/blob.glsl).
pub(super) const NEIGHBOURS: usize = 16;

/// The bubbles of one blob in its own space, whose bounding sphere is the unit sphere around the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Blob {
    /// Centre and radius of each bubble.
    pub bubbles: Vec<[f32; 4]>,
}

/// A uniformly distributed direction.
fn direction(random: &mut Random) -> DVec3 {
    loop {
        let v = DVec3::from([random.next(), random.next(), random.next()].map(|x| 2.0 * x - 1.0));
        let square = v.length_squared();
        if (0.01..1.0).contains(&square) {
            return v / square.sqrt();
        }
    }
}

/// Distance of two bubbles whose films meet at 120°.
fn apart(a: f64, b: f64) -> f64 {
    (a * a + b * b - a * b).sqrt()
}

impl Blob {
    /// A blob with this many bubbles, clamped to 8 to 256.
    pub fn new(seed: u32, count: u32) -> Self {
        let count = count.clamp(*BUBBLES.start(), *BUBBLES.end());
        let mut random = Random::new(seed);
        // The sum of two random numbers, so that middle sizes are more frequent.
        let radii: Vec<f64> =
            (0..count).map(|_| 1.0 + SPREAD * (random.next() + random.next() - 1.0)).collect();
        // A hexagon of spacing s covers sqrt(3)/2 s^2; s equals r if all radii are equal.
        let area: f64 = radii.iter().map(|r| 0.75_f64.sqrt() * r * r).sum();
        let shell = (area / (4.0 * std::f64::consts::PI)).sqrt();
        let mut places: Vec<DVec3> = Vec::with_capacity(radii.len());
        for _ in 0..count {
            let nearest = |to: &DVec3| {
                places.iter().map(|p| p.distance_squared(*to)).fold(f64::INFINITY, f64::min)
            };
            let far = (0..CANDIDATES).map(|_| direction(&mut random));
            let best = far.max_by(|a, b| nearest(a).total_cmp(&nearest(b)));
            places.extend(best);
        }
        for _ in 0..ROUNDS {
            let moved = |i: usize| {
                let at = places[i];
                let push = |(j, other): (usize, &DVec3)| {
                    let away = at - *other;
                    let (length, wanted) = (shell * away.length(), apart(radii[i], radii[j]));
                    if i == j || length >= wanted || length == 0.0 {
                        return DVec3::ZERO;
                    }
                    away * (shell / length) * 0.5 * (wanted - length) / shell
                };
                let pushed: DVec3 = places.iter().enumerate().map(push).sum();
                (at + 0.5 * pushed).normalize()
            };
            places = (0..places.len()).map(moved).collect();
        }
        let spheres: Vec<(DVec3, f64)> = places
            .iter()
            .zip(&radii)
            .map(|(at, &r)| (*at * (shell + OFF_SHELL * r * (2.0 * random.next() - 1.0)), r))
            .collect();
        let most = spheres.iter().map(|(c, r)| c.length() + r).fold(0.0, f64::max);
        let bubbles =
            spheres.iter().map(|(c, r)| (c / most).extend(r / most).as_vec4().to_array()).collect();
        Self { bubbles }
    }

    /// For each bubble, the indices of the bubbles that it intersects, one byte each, the deepest intersections
    /// first. If there are fewer than [`NEIGHBOURS`], the bubble's own index fills the rest.
    pub(super) fn neighbours(&self) -> Vec<[u8; NEIGHBOURS]> {
        let depth = |a: &[f32; 4], b: &[f32; 4]| {
            let apart = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f32>().sqrt();
            a[3] + b[3] - apart
        };
        let own = |(i, bubble): (usize, &[f32; 4])| {
            let others = self.bubbles.iter().enumerate().filter(|(j, _)| i != *j);
            let mut deep: Vec<(f32, u8)> = others
                .map(|(j, other)| (depth(bubble, other), j as u8))
                .filter(|(deep, _)| *deep > 0.0)
                .collect();
            deep.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let mut nearest = [i as u8; NEIGHBOURS];
            for (to, (_, from)) in nearest.iter_mut().zip(deep) {
                *to = from;
            }
            nearest
        };
        self.bubbles.iter().enumerate().map(own).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of adjacent bubbles of a blob. Two bubbles are adjacent if no third bubble's centre is nearer to the
    /// midpoint between their centres than they are.
    fn neighbours(blob: &Blob) -> Vec<(usize, usize)> {
        let at = |i: usize| DVec3::from([0, 1, 2].map(|k| f64::from(blob.bubbles[i][k])));
        let n = blob.bubbles.len();
        let mut found = Vec::new();
        for i in 0..n {
            for j in i + 1..n {
                let (middle, half) = ((at(i) + at(j)) / 2.0, at(i).distance(at(j)) / 2.0);
                if (0..n).all(|k| k == i || k == j || at(k).distance(middle) > half) {
                    found.push((i, j));
                }
            }
        }
        found
    }

    #[test]
    fn a_seed_gives_one_blob_and_another_another() {
        assert_eq!(Blob::new(7, 227), Blob::new(7, 227));
        assert_ne!(Blob::new(7, 227), Blob::new(8, 227));
        // Equal to the last bit on every machine.
        let first = Blob::new(1, 64).bubbles[0].map(f32::to_bits);
        assert_eq!(first, FIRST);
    }

    const FIRST: [u32; 4] = [3_186_815_588, 1_053_716_087, 1_054_842_924, 1_051_978_301];

    #[test]
    fn films_meet_near_120_degrees() {
        for (seed, count) in [(1, 64), (2, 128), (3, 227), (4, 256)] {
            let blob = Blob::new(seed, count);
            assert_eq!(blob.bubbles.len(), count as usize);
            let most = blob.bubbles.iter().map(|[x, y, z, r]| (x * x + y * y + z * z).sqrt() + r);
            let most = most.fold(0.0, f32::max);
            assert!((most - 1.0).abs() < 1.0e-5, "bounding ball of {most}");
            let pairs = neighbours(&blob);
            let angle = |&(i, j): &(usize, usize)| {
                let (a, b) = (blob.bubbles[i].map(f64::from), blob.bubbles[j].map(f64::from));
                let square: f64 = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum();
                let cosine = (a[3] * a[3] + b[3] * b[3] - square) / (2.0 * a[3] * b[3]);
                cosine.clamp(-1.0, 1.0).acos().to_degrees()
            };
            // Angle between the radii: it is 60° where the films meet at 120°.
            let angles: Vec<f64> = pairs.iter().map(angle).collect();
            let mean = angles.iter().sum::<f64>() / angles.len() as f64;
            let spread = (angles.iter().map(|a| (a - mean).powi(2)).sum::<f64>()
                / angles.len() as f64)
                .sqrt();
            let error = angles.iter().map(|a| (a - 60.0).abs()).sum::<f64>() / angles.len() as f64;
            println!("{count}: {mean:.1} degrees, spread {spread:.1}, mean error {error:.2}");
            // docs/bubble-foam.md gives this number.
            assert!(error < 6.0, "{count} bubbles: a mean error of {error} degrees");
            assert!(spread < 20.0, "{count} bubbles: {spread} degrees of spread");
        }
    }
}
