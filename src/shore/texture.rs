//! Textures of shoreline foam: the distance from a pattern, a foam texture, noise. All are seamless.
//!
//! Shoreline foam is where a picture exceeds a threshold. If the picture holds the distance to the nearest line of a
//! pattern, lines become thinner and thicker as the threshold changes (*Semi-procedural foam shader*, Sec. V).
//! Filters of picture editors stop at the picture's border; these functions wrap around.
//!
//! The textures are computed without transcendental functions: a seed gives the same texture on every machine.

use crate::random::{Random, pcg};

/// Distance of a texel without any pattern.
const NOWHERE: i64 = i64::MAX;

/// Distance from each texel's centre to that of the nearest texel of the pattern, in texels, with the picture
/// repeating in both directions. Infinite everywhere if no texel belongs to the pattern.
///
/// This Euclidean distance transform is exact except for the rounding of the square root, in time linear in the
/// number of texels (Felzenszwalb, Huttenlocher, *Distance Transforms of Sampled Functions*, 2012). The first pass
/// runs along the columns of the pattern. The second finds, in each row, the lower envelope of one parabola per
/// column; the row is extended periodically by half its width on both sides, because the picture repeats.
///
/// `pattern` is `width` × `height` texels, row by row; `true` marks the texels of the pattern.
///
/// # Panics
/// If `pattern` has another length.
pub fn distance_transform(pattern: &[bool], width: usize, height: usize) -> Vec<f32> {
    squares(pattern, width, height).into_iter().map(root).collect()
}

/// The inverted distance, as shoreline foam uses it: 1 on the pattern, falling linearly to 0 at `reach` texels.
/// 0 everywhere if no texel belongs to the pattern; 1 on the pattern and 0 elsewhere if `reach` is not above 0.
///
/// # Panics
/// Those of [`distance_transform`].
pub fn from_pattern(pattern: &[bool], width: usize, height: usize, reach: f32) -> Vec<f32> {
    let near = |square: i64| match square {
        0 => 1.0,
        NOWHERE => 0.0,
        _ if reach > 0.0 => (1.0 - root(square) / reach).max(0.0),
        _ => 0.0,
    };
    squares(pattern, width, height).into_iter().map(near).collect()
}

fn root(square: i64) -> f32 {
    if square == NOWHERE { f32::INFINITY } else { (square as f64).sqrt() as f32 }
}

/// Squares of the distances, which are integers.
fn squares(pattern: &[bool], width: usize, height: usize) -> Vec<i64> {
    let texels = width.checked_mul(height);
    assert_eq!(texels, Some(pattern.len()), "texels of a pattern of {width}x{height}");
    if !pattern.contains(&true) {
        return vec![NOWHERE; pattern.len()];
    }
    // Along the columns, downwards and upwards, twice around the period.
    const NONE: u32 = u32::MAX / 2;
    let mut steps: Vec<u32> = pattern.iter().map(|on| if *on { 0 } else { NONE }).collect();
    let mut follow = |to: usize, from: usize| {
        let (to, from) = (to % height * width, from % height * width);
        for x in 0..width {
            steps[to + x] = steps[to + x].min(steps[from + x] + 1);
        }
    };
    for y in 1..2 * height {
        follow(y, y - 1);
    }
    for y in (1..2 * height).rev() {
        follow(y - 1, y);
    }
    // Along the rows. For each parabola of the envelope: the position of its apex, the height of its apex, and the
    // position from which on it is the lowest.
    let mut envelope: Vec<(i64, i64, i64)> = Vec::with_capacity(2 * width);
    let half = width / 2;
    let mut squares = Vec::with_capacity(pattern.len());
    for row in steps.chunks_exact(width) {
        envelope.clear();
        for unrolled in 0..width + 2 * half {
            let step = row[(unrolled + width - half) % width];
            if step >= NONE {
                continue;
            }
            let (apex, low) = (unrolled as i64 - half as i64, i64::from(step).pow(2));
            let mut from = i64::MIN;
            while let Some(&(before, height, since)) = envelope.last() {
                // The first position at which it is lower than the previous one.
                let over = (apex - before) * (apex + before) + low - height;
                let first = over.div_euclid(2 * (apex - before)) + 1;
                if first > since {
                    from = first;
                    break;
                }
                envelope.pop();
            }
            envelope.push((apex, low, from));
        }
        let mut parts = envelope.iter().peekable();
        let mut lowest = (0, 0);
        for x in 0..width as i64 {
            while let Some((apex, low, _)) = parts.next_if(|part| part.2 <= x) {
                lowest = (*apex, *low);
            }
            squares.push((x - lowest.0).pow(2) + lowest.1);
        }
    }
    squares
}

/// Number of octaves of [`noise`], and number of cells per side of the first octave. Each further octave has twice as
/// many cells per side as the one before.
const OCTAVES: u32 = 4;
const NOISE_CELLS: usize = 4;

/// Four independent channels of smooth, seamless noise: gradient noise (Perlin, *Improving Noise*, 2002: its
/// second derivative is continuous) with 4, 8, 16 and 32 cells per side, each octave with half the amplitude of
/// the previous. `edge`² texels, row by row.
///
/// Each channel of the noise is normalised to mean 0 and maximum absolute value 1 (the only texel of `edge` 1 is 0).
/// Except for this normalisation, a seed gives the same noise at every size.
pub fn noise(edge: u32, seed: u32) -> Vec<[f32; 4]> {
    let mut random = Random::new(seed ^ 0x6e6f_6973);
    let octaves: Vec<Lattice<4>> =
        (0..OCTAVES).map(|i| Lattice::new(NOISE_CELLS << i, &mut random)).collect();
    let at = |x: f32, y: f32| {
        let (mut sum, mut gain) = ([0.0; 4], 1.0);
        for octave in &octaves {
            let values = octave.at(x, y);
            sum = [0, 1, 2, 3].map(|c| sum[c] + gain * values[c]);
            gain *= 0.5;
        }
        sum
    };
    let mut texels: Vec<[f32; 4]> = centers(edge).map(|[x, y]| at(x, y)).collect();
    for c in 0..4 {
        let sum: f64 = texels.iter().map(|t| f64::from(t[c])).sum();
        let mean = sum / texels.len().max(1) as f64;
        let most = texels.iter().map(|t| (f64::from(t[c]) - mean).abs()).fold(0.0, f64::max);
        for texel in &mut texels {
            let off = f64::from(texel[c]) - mean;
            texel[c] = if most > 0.0 { (off / most) as f32 } else { 0.0 };
        }
    }
    texels
}

/// Centres of all texels, row by row, in [0, 1).
fn centers(edge: u32) -> impl Iterator<Item = [f32; 2]> {
    let center = move |i: u32| (i as f32 + 0.5) / edge as f32;
    (0..edge).flat_map(move |y| (0..edge).map(move |x| [center(x), center(y)]))
}

/// Gradients of a noise of N channels at the corners of its cells, `cells` per side of the unit square, which is
/// periodic.
struct Lattice<const N: usize> {
    cells: usize,
    gradients: Vec<[[f32; 2]; N]>,
}

impl<const N: usize> Lattice<N> {
    fn new(cells: usize, random: &mut Random) -> Self {
        let mut direction = || loop {
            let [x, y] = [random.next(), random.next()].map(|v| 2.0 * v - 1.0);
            let square = x * x + y * y;
            if (0.01..1.0).contains(&square) {
                return [x, y].map(|v| (v / square.sqrt()) as f32);
            }
        };
        let gradients = (0..cells * cells).map(|_| [(); N].map(|()| direction())).collect();
        Self { cells, gradients }
    }

    /// The value at a point in [0, 1).
    fn at(&self, x: f32, y: f32) -> [f32; N] {
        let n = self.cells;
        let corners = |v: f32| {
            let v = v * n as f32;
            let first = (v as usize).min(n - 1);
            let t = v - first as f32;
            let fade = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
            [(first, t, 1.0 - fade), (if first + 1 == n { 0 } else { first + 1 }, t - 1.0, fade)]
        };
        let (across, down) = (corners(x), corners(y));
        let mut sum = [0.0; N];
        for (j, v, below) in down {
            for (i, u, beside) in across {
                let (u, v) = (below * beside * u, below * beside * v);
                let gradients = &self.gradients[j * n + i];
                for c in 0..N {
                    sum[c] += gradients[c][0] * u + gradients[c][1] * v;
                }
            }
        }
        sum
    }
}

/// A web with at most half this many texels per side is the average of a finer one with about this many texels per
/// side.
const FINE: u32 = 1024;

/// The web: a foam texture as the sea leaves it on a shore. Filaments run between round cells of very different
/// sizes; they are thicker where they meet, and some are torn. The result is `edge`² texels, row by row, seamless,
/// the same picture at every size. It is meant to cover 5 to 15 m: the largest cells are a fifth of the side length
/// wide, filaments a five-hundredth.
///
/// The web's values are an exact [`distance_transform`] of the filaments, inverted: 1 on filaments, which are a
/// seventh of the area, and 0 farthest from them. In between, values are remapped so that each is equally frequent.
/// The effect of a threshold t is thus known: of the area outside the filaments, the fraction 1 − t is at t or above.
/// Texels partly on filaments hold the mean. At 512 texels per side, neighbouring texels differ by less than 0.2, at
/// larger sizes by less.
pub fn web(edge: u32, seed: u32) -> Vec<f32> {
    let share = (FINE / edge.max(1)).max(1) as usize;
    let fine = edge as usize * share;
    let texels = by_area(&squares(&Cells::new(seed).pattern(fine), fine, fine));
    if share == 1 || edge == 0 {
        return texels;
    }
    let weight = 1.0 / (share * share) as f32;
    let mut means = Vec::with_capacity(edge as usize * edge as usize);
    for rows in texels.chunks_exact(fine * share) {
        for x in (0..fine).step_by(share) {
            let sum: f32 = rows.chunks_exact(fine).flat_map(|row| &row[x..x + share]).sum();
            means.push(sum * weight);
        }
    }
    means
}

/// Maps squared distances to 0 to 1: 1 where the distance is 0. Elsewhere the value is the share of larger distances
/// among all distances above 0, where equal ones count by half, rescaled so that the largest distance gets 0.
fn by_area(squares: &[i64]) -> Vec<f32> {
    let most = squares.iter().copied().max().filter(|most| *most != NOWHERE).unwrap_or(0);
    let mut counts = vec![0_u32; most as usize + 1];
    for square in squares {
        if let Some(count) = counts.get_mut(*square as usize) {
            *count += 1;
        }
    }
    let mut nearer = 0.0;
    let mut ranks: Vec<f64> = vec![0.0];
    ranks.extend(counts.iter().skip(1).map(|count| {
        let before = nearer;
        nearer += f64::from(*count);
        0.5 * (before + nearer)
    }));
    let last = ranks.last().copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
    let values: Vec<f32> = ranks.iter().map(|rank| (1.0 - rank / last) as f32).collect();
    squares.iter().map(|square| values.get(*square as usize).copied().unwrap_or(0.0)).collect()
}

/// Radii of the cores, the discs around which cells form, relative to the texture's side length: the largest, the
/// smallest, and the ratio of successive ones.
const LARGEST: f32 = 0.09;
const SMALLEST: f32 = 0.006;
const NEXT: f32 = 0.95;
/// Number of attempts to place a core of the largest radius. Smaller radii get more attempts, because there is room
/// for more of them.
const TRIES: f32 = 3.0;
/// Maximum overlap of a core with a larger one, relative to its radius.
const OVERLAP: f32 = 0.3;
/// Cells per side of the noise that bends filaments, and its amplitude relative to the side length: coarse and fine.
const BENDS: [(usize, f32); 2] = [(6, 0.06), (20, 0.01)];
/// Width of a filament, and its variation.
const WIDTH: f32 = 0.0022;
const WIDTH_VARIES: f32 = 0.6;
/// Filaments thicken where the third-nearest core is less than this farther away than the second-nearest, relative to
/// the nearest core's radius.
const FILLET: f32 = 0.8;
/// TORN: share of filaments that are torn if the smaller one of their two cells' cores has at least the radius
/// TORN_RADIUS (below, the share falls in proportion to the radius). TORN_LENGTH: distance from a junction at which a
/// torn filament ends, relative to the smaller radius.
const TORN: f32 = 0.35;
const TORN_RADIUS: f32 = 0.03;
const TORN_LENGTH: f32 = 0.8;
/// Distance from a junction within which a filament's properties blend with those of the filaments that meet there.
/// BLEND: relative to the radius of the cell's core. BLEND_MOST: its maximum, relative to the texture's side length.
const BLEND: f32 = 0.5;
const BLEND_MOST: f32 = 0.015;
/// Tiles per side, each with a list of the cores that affect it.
const TILES: usize = 64;
/// Upper bound of the gradient of [`Cells::within`], per side length: the distances to cores contribute 2 or 3, the
/// warp the rest.
const STEEP: f32 = 5.0;

/// A disc, relative to the side length.
#[derive(Clone, Copy)]
struct Core {
    center: [f32; 2],
    radius: f32,
}

impl Core {
    /// Distance of a point in [0, 1) from the disc's rim, periodic; negative inside.
    fn distance(&self, [x, y]: [f32; 2]) -> f32 {
        let across = |a: f32, b: f32| {
            let d = (a - b).abs();
            d.min(1.0 - d)
        };
        let (u, v) = (across(x, self.center[0]), across(y, self.center[1]));
        (u * u + v * v).sqrt() - self.radius
    }
}

/// Foam cells over the periodic unit square: each point belongs to the core whose rim is nearest (the Voronoi
/// diagram of discs, whose borders are hyperbolas). Discs are placed at random where there is room, the largest
/// first, so that small ones fill the gaps of large ones, as bubbles do.
struct Cells {
    cores: Vec<Core>,
    /// Core indices of each tile.
    tiles: Vec<Vec<u16>>,
    bends: [Lattice<2>; 2],
    seed: u32,
}

impl Cells {
    fn new(seed: u32) -> Self {
        let mut random = Random::new(seed ^ 0x666f_616d);
        let mut cores: Vec<Core> = Vec::new();
        let mut radius = LARGEST;
        while radius > SMALLEST {
            let smaller = LARGEST / radius;
            for _ in 0..(TRIES * smaller * smaller) as u32 {
                let center = [random.next(), random.next()].map(|v| v as f32);
                // Larger cores have already been placed.
                if cores.iter().all(|core| core.distance(center) > (1.0 - OVERLAP) * radius) {
                    cores.push(Core { center, radius });
                }
            }
            radius *= NEXT;
        }
        let bends = BENDS.map(|(cells, _)| Lattice::new(cells, &mut random));
        let tiles = centers(TILES as u32).map(|center| of_tile(&cores, center)).collect();
        Self { cores, tiles, bends, seed: pcg(seed) }
    }

    /// The filaments, on `edge`² texels.
    fn pattern(&self, edge: usize) -> Vec<bool> {
        let center = |i: usize| (i as f32 + 0.5) / edge as f32;
        let mut pattern = vec![false; edge * edge];
        for (y, row) in pattern.chunks_exact_mut(edge.max(1)).enumerate() {
            let mut x = 0;
            while x < edge {
                let within = self.within(center(x), center(y));
                row[x] = within < 0.0;
                // No filament is nearer than that.
                x += 1 + (within.max(0.0) / STEEP * edge as f32) as usize;
            }
        }
        pattern
    }

    /// Negative if a point of the unit square is on a filament of its cell. Otherwise no filament is nearer than the
    /// value divided by `STEEP`.
    fn within(&self, x: f32, y: f32) -> f32 {
        let bends = [self.bends[0].at(x, y), self.bends[1].at(x, y)];
        let bent = |v: f32, i: usize| {
            let v = v + BENDS[0].1 * bends[0][i] + BENDS[1].1 * bends[1][i];
            if v < 0.0 {
                v + 1.0
            } else if v < 1.0 {
                v
            } else {
                v - 1.0
            }
        };
        let at = [bent(x, 0), bent(y, 1)];
        let tile = at.map(|v| ((v * TILES as f32) as usize).min(TILES - 1));
        let near = &self.tiles[tile[1] * TILES + tile[0]];
        let distance = |i: &u16| self.cores[*i as usize].distance(at);
        let mut own = 0;
        let mut nearest = [f32::INFINITY; 3];
        for i in near {
            let d = distance(i);
            if d < nearest[0] {
                nearest = [d, nearest[0], nearest[1]];
                own = *i;
            } else if d < nearest[1] {
                nearest = [nearest[0], d, nearest[1]];
            } else if d < nearest[2] {
                nearest[2] = d;
            }
        }
        // Distances from the border to the second-nearest cell and to the third-nearest.
        let (second, third) = (nearest[1] - nearest[0], nearest[2] - nearest[0]);
        let radius = self.cores[own as usize].radius;
        let width = WIDTH * (1.0 + WIDTH_VARIES * bends[0][0]);
        // A smooth minimum of both.
        let rounded = |reach: f32| {
            let corner = (1.0 - (third - second) / reach).max(0.0);
            second - 0.25 * reach * corner * corner
        };
        let bound = rounded(FILLET * radius) - width;
        if bound > 0.0 {
            return bound;
        }
        // A filament belongs to a pair of cells: this one and the next. Near a third cell, its properties blend with
        // those of the filament to the third cell.
        let reach = BLEND_MOST.min(BLEND * radius);
        let (mut torn, mut smaller, mut all) = (0.0, 0.0, 0.0);
        for i in near.iter().filter(|i| **i != own) {
            let near = 1.0 - (distance(i) - nearest[1]) / reach;
            if near > 0.0 {
                let size = radius.min(self.cores[*i as usize].radius);
                let chance = TORN * (size / TORN_RADIUS).min(1.0);
                let weight = near * near;
                all += weight;
                smaller += weight * size;
                torn += if self.chance(own, *i) < chance { weight } else { 0.0 };
            }
        }
        let (torn, smaller) = (torn / all, smaller / all);
        // A torn filament looks the same from both of its cells, so that no edge shows.
        let fillet = FILLET * (radius + (smaller - radius) * torn);
        rounded(fillet) - width * (1.0 - torn * third / (TORN_LENGTH * smaller))
    }

    /// Random number of a pair of cells, in [0, 1).
    fn chance(&self, a: u16, b: u16) -> f32 {
        let pair = u32::from(a.min(b)) << 16 | u32::from(a.max(b));
        (pcg(self.seed ^ pcg(pair)) >> 8) as f32 / (1 << 24) as f32
    }
}

/// Indices of the cores that, for any point of the tile with this centre, are among the three nearest or hardly
/// farther away than the second-nearest.
fn of_tile(cores: &[Core], center: [f32; 2]) -> Vec<u16> {
    let distances: Vec<f32> = cores.iter().map(|core| core.distance(center)).collect();
    let mut nearest = [f32::INFINITY; 3];
    for d in &distances {
        let [first, second, third] = nearest;
        nearest = [first.min(*d), second.min(first.max(*d)), third.min(second.max(*d))];
    }
    // Max distance of the tile's points from its centre. A distance to a core changes by no more than that.
    let half = std::f32::consts::FRAC_1_SQRT_2 / TILES as f32;
    let most = nearest[2].max(nearest[1] + BLEND_MOST) + 2.0 * half;
    (0..).zip(&distances).filter(|(_, d)| **d <= most).map(|(i, _)| i).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test may
mod tests {
    use super::*;

    /// Squared distance of every texel from the nearest texel of the pattern, with periodic borders, by brute force.
    fn brute(pattern: &[bool], width: usize, height: usize) -> Vec<i64> {
        let round = |a: usize, b: usize, n: usize| a.abs_diff(b).min(n - a.abs_diff(b)) as i64;
        let texels = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let to = |x: usize, y: usize| {
            let on = texels().filter(|(i, j)| pattern[j * width + i]);
            on.map(|(i, j)| round(x, i, width).pow(2) + round(y, j, height).pow(2)).min()
        };
        texels().map(|(x, y)| to(x, y).unwrap_or(NOWHERE)).collect()
    }

    /// A random pattern with about this many of a thousand texels.
    fn scattered(width: usize, height: usize, thousandths: u32, seed: u32) -> Vec<bool> {
        let mut random = Random::new(seed);
        let share = f64::from(thousandths) / 1000.0;
        (0..width * height).map(|_| random.next() < share).collect()
    }

    fn shifted<T: Copy>(texels: &[T], width: usize, height: usize, by: (usize, usize)) -> Vec<T> {
        let from = |x: usize, y: usize| (y + by.1) % height * width + (x + by.0) % width;
        let texel = |i: usize| texels[from(i % width, i / width)];
        (0..width * height).map(texel).collect()
    }

    #[test]
    fn distances_are_exact_on_every_torus() {
        let sizes =
            [(1, 1), (1, 2), (2, 1), (1, 9), (9, 1), (2, 2), (2, 5), (3, 3), (4, 3), (7, 6)];
        let larger = [(8, 8), (16, 9), (9, 16), (64, 3), (3, 64), (33, 17), (24, 31)];
        for (width, height) in sizes.into_iter().chain(larger) {
            let mut patterns: Vec<Vec<bool>> = (0..)
                .zip([0, 5, 20, 100, 300, 500, 900, 1000])
                .flat_map(|(seed, share)| [seed, seed + 100].map(|seed| (seed, share)))
                .map(|(seed, share)| scattered(width, height, share, seed))
                .collect();
            // A single texel, in each corner and in the middle.
            for at in [0, width - 1, (height - 1) * width, width * height - 1, width * height / 2] {
                patterns.push((0..width * height).map(|i| i == at).collect());
            }
            for pattern in patterns {
                let expected = brute(&pattern, width, height);
                assert_eq!(
                    squares(&pattern, width, height),
                    expected,
                    "{width}x{height} {pattern:?}"
                );
                let distances = distance_transform(&pattern, width, height);
                for (d, square) in distances.iter().zip(expected) {
                    let root =
                        if square == NOWHERE { f64::INFINITY } else { (square as f64).sqrt() };
                    assert_eq!(*d, root as f32);
                }
            }
        }
        assert!(
            distance_transform(&[], 0, 7).is_empty() && distance_transform(&[], 7, 0).is_empty()
        );
    }

    #[test]
    fn a_pattern_that_is_shifted_shifts_its_distances() {
        for (width, height) in [(37, 22), (64, 64), (5, 48)] {
            let pattern = scattered(width, height, 15, 3);
            assert!(pattern.contains(&true));
            let distances = distance_transform(&pattern, width, height);
            for by in [(1, 0), (0, 1), (width / 2, height / 3), (width - 1, height - 1)] {
                let moved = shifted(&pattern, width, height, by);
                let expected = shifted(&distances, width, height, by);
                assert_eq!(distance_transform(&moved, width, height), expected, "{by:?}");
            }
        }
    }

    #[test]
    fn inverted_distances_fall_to_0_at_their_reach() {
        let mut pattern = vec![false; 80];
        pattern[1] = true;
        let row = |reach| from_pattern(&pattern, 8, 10, reach)[..8].to_vec();
        assert_eq!(row(4.0), [0.75, 1.0, 0.75, 0.5, 0.25, 0.0, 0.25, 0.5]);
        assert_eq!(row(2.0), [0.5, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(row(f32::INFINITY), [1.0; 8]);
        for none in [0.0, -1.0, f32::NAN] {
            assert_eq!(row(none), [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], "{none}");
        }
        for reach in [1.0, f32::INFINITY] {
            assert_eq!(from_pattern(&[false; 6], 3, 2, reach), [0.0; 6]);
            assert_eq!(from_pattern(&[true; 6], 3, 2, reach), [1.0; 6]);
        }
    }

    #[test]
    #[should_panic(expected = "3x2")]
    fn a_pattern_of_another_size_is_refused() {
        distance_transform(&[true; 5], 3, 2);
    }

    /// Max difference of neighbours across the borders, and of all others.
    fn jumps(texels: &[f32], edge: usize) -> (f32, f32) {
        let (mut across, mut within) = (0.0_f32, 0.0_f32);
        for (i, texel) in texels.iter().enumerate() {
            let (x, y) = (i % edge, i / edge);
            for (next, last) in
                [(y * edge + (x + 1) % edge, x + 1), ((y + 1) % edge * edge + x, y + 1)]
            {
                let to = if last == edge { &mut across } else { &mut within };
                *to = to.max((texels[next] - texel).abs());
            }
        }
        (across, within)
    }

    #[test]
    fn web_and_noise_have_no_seam() {
        for seed in 0..4 {
            let (across, within) = jumps(&web(512, seed), 512);
            assert!(across <= within, "web {seed}: {across} across the borders, {within} within");
            assert!(within < 0.2, "web {seed}: {within}");
            for edge in [200, 256] {
                let noise = noise(edge, seed);
                for c in 0..4 {
                    let channel: Vec<f32> = noise.iter().map(|t| t[c]).collect();
                    let (across, within) = jumps(&channel, edge as usize);
                    assert!(across <= within, "noise {seed} {c}: {across}, {within}");
                }
            }
        }
    }

    /// The pattern continues across the borders: rows and columns on both sides match.
    #[test]
    fn filaments_go_on_across_the_borders() {
        for seed in 0..4 {
            let n = 1024;
            let pattern = Cells::new(seed).pattern(n);
            // Number of places where the pattern begins or ends between a column, or row, and the next.
            let ends = |at: &dyn Fn(usize, usize) -> usize, from: usize| {
                let to = (from + 1) % n;
                let count = (0..n).filter(|i| pattern[at(from, *i)] != pattern[at(to, *i)]).count();
                count as f64
            };
            for at in [&(|i, j| j * n + i) as &dyn Fn(usize, usize) -> usize, &|i, j| i * n + j] {
                let inside = (0..n - 1).map(|i| ends(at, i)).fold(0.0, f64::max);
                let border = ends(at, n - 1);
                assert!(
                    border <= inside,
                    "{border} ends at the border, {inside} elsewhere at most"
                );
            }
        }
    }

    #[test]
    fn a_web_falls_with_the_distance_from_its_filaments() {
        let n = 1024;
        for seed in [1, 2] {
            let web = web(n as u32, seed);
            let filaments: Vec<bool> = web.iter().map(|v| *v == 1.0).collect();
            let squares = squares(&filaments, n, n);
            let mut sorted: Vec<(i64, f32)> = squares.into_iter().zip(web).collect();
            sorted.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
            for two in sorted.windows(2) {
                let [(near, more), (far, less)] = [two[0], two[1]];
                assert!(if near == far { more == less } else { more > less }, "{two:?}");
            }
            assert_eq!(sorted.last().unwrap().1, 0.0);
            assert!(sorted.iter().all(|(_, v)| (0.0..=1.0).contains(v)));
        }
    }

    #[test]
    fn a_threshold_cuts_out_of_a_web_what_it_says() {
        for (edge, seed) in [(1024, 1), (1024, 5), (512, 2), (512, 3)] {
            let pattern = Cells::new(seed).pattern(FINE as usize);
            let share = |n: usize, of: usize| n as f64 / of as f64;
            let filaments = share(pattern.iter().filter(|on| **on).count(), pattern.len());
            assert!((0.12..0.18).contains(&filaments), "{filaments}");
            let web = web(edge, seed);
            // Texels partly on a filament are means, some of which fall on the other side of a threshold.
            let tolerance = if edge == FINE { 0.04 } else { 0.05 };
            for t in [0.05, 0.1, 0.25, 0.5, 0.75, 0.9] {
                let found = share(web.iter().filter(|v| f64::from(**v) >= t).count(), web.len());
                let expected = filaments + (1.0 - filaments) * (1.0 - t);
                let off = (found - expected).abs();
                // All texels next to a filament have the same distance, so they pass the same thresholds.
                assert!(
                    off < if t < 0.7 { 0.01 } else { tolerance },
                    "{edge} {t}: {found}, {expected}"
                );
            }
        }
    }

    #[test]
    fn a_web_is_the_same_at_every_size() {
        for seed in [1, 9] {
            let large = web(512, seed);
            // Means of the same finer web.
            let small = web(256, seed);
            let mean = |x: usize, y: usize| {
                let at = |i: usize, j: usize| large[(2 * y + j) * 512 + 2 * x + i];
                0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1))
            };
            for (i, v) in small.iter().enumerate() {
                assert!((v - mean(i % 256, i / 256)).abs() < 1.0e-5);
            }
            // Another size, 640 texels: nearly the same values at the same points.
            let other = web(640, seed);
            let sample = |v: usize| v * 640 / 512;
            let off = |i: usize| other[sample(i / 512) * 640 + sample(i % 512)] - large[i];
            let square = (0..512 * 512).map(|i| f64::from(off(i)).powi(2)).sum::<f64>();
            let rms = (square / (512.0 * 512.0)).sqrt();
            assert!(rms < 0.05, "{rms}");
        }
    }

    #[test]
    fn no_filament_is_left_out_for_speed() {
        for seed in [1, 4] {
            let cells = Cells::new(seed);
            let all = Cells {
                tiles: vec![(0..).take(cells.cores.len()).collect(); TILES * TILES],
                ..Cells::new(seed)
            };
            let n = 512;
            let pattern = cells.pattern(n);
            for (on, [x, y]) in pattern.iter().zip(centers(n as u32)) {
                let within = cells.within(x, y);
                assert_eq!(*on, within < 0.0, "{x} {y}");
            }
            for [x, y] in centers(100) {
                assert_eq!(cells.within(x, y), all.within(x, y), "{x} {y}");
            }
        }
    }

    /// Hash of the bits of all values (FNV).
    fn hash(values: impl Iterator<Item = f32>) -> u64 {
        let one = |hash: u64, v: f32| (hash ^ u64::from(v.to_bits())).wrapping_mul(0x100_0000_01b3);
        values.fold(0xcbf2_9ce4_8422_2325, one)
    }

    #[test]
    fn a_seed_gives_one_texture_and_another_another() {
        let [web, noise] = [hash(web(64, 1).into_iter()), hash(noise(64, 1).into_iter().flatten())];
        assert_eq!(hash(super::web(64, 1).into_iter()), web);
        assert_ne!(hash(super::web(64, 2).into_iter()), web);
        assert_ne!(hash(super::noise(64, 2).into_iter().flatten()), noise);
        // Equal to the last bit on every machine.
        assert_eq!([web, noise], [10_425_592_817_350_839_320, 10_374_132_684_964_779_970]);
    }

    #[test]
    fn small_textures_are_sound() {
        assert!(web(0, 1).is_empty() && noise(0, 1).is_empty());
        assert_eq!(noise(1, 1), [[0.0; 4]]);
        for edge in [1, 2, 3, 7] {
            let web = web(edge, 1);
            assert_eq!(web.len(), (edge * edge) as usize);
            assert!(web.iter().all(|v| (0.0..=1.0).contains(v)));
            assert_eq!(noise(edge, 1).len(), (edge * edge) as usize);
        }
    }

    #[test]
    fn noise_is_about_0_and_within_1() {
        for (edge, seed) in [(5, 1), (64, 1), (100, 2), (256, 3)] {
            let noise = noise(edge, seed);
            for c in 0..4 {
                let channel = || noise.iter().map(|t| t[c]);
                let mean = channel().map(f64::from).sum::<f64>() / f64::from(edge * edge);
                // Bound of the rounding error of each value.
                assert!(mean.abs() <= f64::from(f32::EPSILON) / 4.0, "{edge} {c}: {mean}");
                assert_eq!(channel().map(f32::abs).fold(0.0, f32::max), 1.0);
            }
        }
    }

    #[test]
    fn channels_of_noise_are_independent() {
        // The expected correlation of two independent channels is 0. Its expected square is the sum over octaves of
        // s² / (2 n²), with s the octave's share of the variance and n its number of cells per side.
        let octaves = (0..OCTAVES).map(|i| (0.25_f64.powi(i as i32), NOISE_CELLS << i));
        let variance: f64 = octaves.clone().map(|(share, _)| share).sum();
        let expected: f64 =
            octaves.map(|(share, n)| (share / variance).powi(2) / (2 * n * n) as f64).sum();
        let (mut sum, mut squares, mut pairs) = (0.0, 0.0, 0.0);
        for seed in 0..24 {
            let noise = noise(48, seed);
            let of = |a: usize, b: usize| {
                noise.iter().map(|t| f64::from(t[a]) * f64::from(t[b])).sum::<f64>()
            };
            for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                let correlation = of(a, b) / (of(a, a) * of(b, b)).sqrt();
                sum += correlation;
                squares += correlation * correlation;
                pairs += 1.0;
            }
        }
        let (mean, square): (f64, f64) = (sum / pairs, squares / pairs);
        println!(
            "{mean} in the mean, {} of {} by root mean square",
            square.sqrt(),
            expected.sqrt()
        );
        assert!(mean.abs() < 4.0 * (expected / pairs).sqrt(), "{mean}");
        // The gradients have unequal weights, so the tolerance is twice the expected square.
        assert!(square < 2.0 * expected, "{square}, {expected}");
    }

    #[test]
    fn the_second_derivative_of_noise_is_continuous() {
        let lattice: Lattice<4> = Lattice::new(4, &mut Random::new(5));
        // Steps from a border between cells to either side.
        let step = 1.0 / 64.0;
        let mut largest = 0.0_f32;
        for y in 0..40 {
            let at = |k: i32| lattice.at((2.0 + k as f32 * step) / 4.0, (y as f32 + 0.3) / 40.0);
            let (middle, near, far) = (at(0), [at(-1), at(1)], [at(-2), at(2)]);
            let second = |side: usize, c: usize| {
                (far[side][c] - 2.0 * near[side][c] + middle[c]) / (step * step)
            };
            for c in 0..4 {
                largest = largest.max((second(1, c) - second(0, c)).abs());
            }
        }
        // The third derivative of the weights is at most 60, and gradients differ by at most 2; the bound is for two
        // steps.
        assert!(largest < 2.0 * step * 60.0 * 2.0, "{largest}");
    }
}
