//! Twin of pass `shape` (Yu and Turk 2013, Sec. 4). For each particle i and its neighbours j within
//! the reach r, including i itself: `w_ij = 1 - (|x_i - x_j| / r)^3` (Eq. 10),
//! `x_i^w = sum w x / sum w`, `C = sum w (x - x^w)(x - x^w)^T / sum w` (Eq. 9), and from its
//! eigenvalues `max(sigma_k, sigma_1 / k_r)` (Eq. 15). With `m_i = x_i^w - x_i` the source's centre
//! is `x + lambda m` (Eq. 6). Here it is `x + lambda (m - b)`, with
//! `b_i = sum w |m_j| m_j / sum w |m_j|`, so that a body does not shrink (after Vollmer et al.
//! 1999).
//!
//! Also different from the source: lambda is multiplied by the fraction to which a particle is an
//! ellipsoid. The axes are divided by their geometric mean, so that the volume is the sphere's, and
//! raised to the power of that fraction, which follows from the sum of the neighbours' weights.
//! Spray has its own shape with another ratio, and takes it on with fewer neighbours. Offsets,
//! weights and products are rounded to 1/65536 of the reach, as on the GPU; where rounding may go
//! either way, the bounds include both.
//!
//! Unlike the GPU, which diagonalizes by rotations, the twin finds the eigenvalue farthest from the
//! others as a root of the characteristic polynomial (Smith 1961), its vector by a cross product,
//! and the other two in the plane across it.

use super::smoothstep;
use glam::{DMat3, DVec3};

/// Fixed-point step of the sums.
pub const STEP: f64 = 1.0 / 65536.0;

/// Settings of the shapes; lengths in scene units.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    pub reach: f64,
    pub ratio: f64,
    pub fewest: f64,
    pub lone: f64,
    pub centred: f64,
    /// k_r for spray.
    pub strand: f64,
}

/// Sums of the neighbours' weights between which spray takes on its shape.
const BESIDE_SPRAY: [f64; 2] = [0.1, 0.6];

/// In a film, water one layer thick, the smallest variance is at most 0.02 of the middle one, and
/// the middle one at least 0.3 of the largest; from 0.06 on and below 0.15 it is none. The sum of
/// weights is at least 2.5, and 4.5 in a whole film.
const FLAT: [f64; 2] = [0.02, 0.06];
const BROAD: [f64; 2] = [0.15, 0.3];
const SOME: [f64; 2] = [2.5, 4.5];
/// What a film has instead of the sum of its neighbours' weights.
const CROWDED: f64 = 64.0;

/// A particle's ellipsoid: its centre, and the matrix that transforms a ball of its radius to it.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    pub center: DVec3,
    pub axes: DMat3,
    /// The matrix for its spray.
    pub spray: DMat3,
    /// Sum of its neighbours' weights, up to 64 in a film.
    pub crowd: f64,
    /// Error bounds on the GPU: of the centre in scene units, of both matrices as norms, and of the
    /// sum.
    pub off: [f64; 4],
}

/// A vector rounded to steps, and for each component whether rounding may change it by a step.
fn stepped(v: DVec3) -> (DVec3, DVec3) {
    let steps = v / STEP;
    // Single precision has an error of 2^-24 of a number, which is 2^-8 of a step; some operations
    // multiply that.
    let loose = |s: f64| f64::from((s.fract().abs() - 0.5).abs() < 0.05);
    (steps.round() * STEP, DVec3::new(loose(steps.x), loose(steps.y), loose(steps.z)) * STEP)
}

/// The shapes of all particles.
pub fn shapes(positions: &[DVec3], settings: &Settings) -> Vec<Shape> {
    let all: Vec<_> = positions.iter().map(|own| shape(*own, positions, settings)).collect();
    let centered = |(own, of): (&DVec3, &Formed)| {
        let (center, off) = center((*own, of), (positions, &all), settings);
        let off = [off, of.axes_off, of.spray_off, of.crowd_off];
        Shape { center, axes: of.axes, spray: of.spray, crowd: of.crowd, off }
    };
    positions.iter().zip(&all).map(centered).collect()
}

/// A particle's axes, and the inputs of its centre.
struct Formed {
    axes: DMat3,
    axes_off: f64,
    spray: DMat3,
    spray_off: f64,
    /// Sum of its neighbours' weights, more in a film.
    crowd: f64,
    crowd_off: f64,
    /// m, in units of the reach.
    middle: DVec3,
    middle_off: f64,
    /// Fraction to which the particle is an ellipsoid.
    share: f64,
    share_off: f64,
}

/// The centre and its error.
fn center(
    (own, of): (DVec3, &Formed),
    (positions, all): (&[DVec3], &[Formed]),
    settings: &Settings,
) -> (DVec3, f64) {
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    let (mut sum_off, mut weights_off) = (0.0, 0.0);
    for (other, formed) in positions.iter().zip(all) {
        let distance = (*other - own).length() / settings.reach;
        if distance >= 1.0 {
            continue;
        }
        let length = formed.middle.length();
        let weight = 1.0 - distance.powi(3);
        sum += formed.middle * length * weight;
        weights += length * weight;
        // Each component may be rounded either way.
        sum_off += 2.0 * weight * length * formed.middle_off + STEP;
        weights_off += weight * formed.middle_off + STEP;
    }
    let mean = if weights > 0.0 { sum / weights } else { DVec3::ZERO };
    let longest = all.iter().map(|formed| formed.middle.length()).fold(0.0, f64::max);
    let quotient = (sum_off + mean.length() * weights_off) / (weights - weights_off).max(1.0e-9);
    let off = (of.middle - mean) * settings.centred * settings.reach;
    let mean_off = quotient.min(2.0 * longest);
    let moved = settings.centred
        * settings.reach
        * ((of.middle_off + mean_off) * of.share + (of.middle - mean).length() * of.share_off);
    let rounded = own.abs().max_element() * 4.0 / f64::from(1 << 24);
    (own + off * of.share, moved + rounded)
}

fn shape(own: DVec3, positions: &[DVec3], settings: &Settings) -> Formed {
    let Settings { reach, ratio, fewest, lone, centred: _, strand } = *settings;
    let mut all = 0.0;
    let (mut first, mut diagonal, mut mixed) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    let (mut loose, mut loose_weight) = ([DVec3::ZERO; 3], 0.0);
    for other in positions {
        let to = (*other - own) / reach;
        let distance = to.length();
        if distance >= 1.0 {
            continue;
        }
        let weight = 1.0 - distance.powi(3);
        let (w, w_loose) = stepped(DVec3::splat(weight));
        all += w.x;
        loose_weight += w_loose.x;
        let products = [to, to * to, DVec3::new(to.y * to.z, to.x * to.z, to.x * to.y)];
        for ((sum, loose), product) in
            [&mut first, &mut diagonal, &mut mixed].into_iter().zip(&mut loose).zip(products)
        {
            let (steps, unsure) = stepped(product * weight);
            *sum += steps;
            *loose += unsure;
        }
    }
    let middle = first / all;
    let (xx, yz) = (diagonal / all, mixed / all);
    let moments = DMat3::from_cols(
        DVec3::new(xx.x, yz.z, yz.y),
        DVec3::new(yz.z, xx.y, yz.x),
        DVec3::new(yz.y, yz.x, xx.z),
    );
    let outer = DMat3::from_cols(middle * middle.x, middle * middle.y, middle * middle.z);
    let covariance = moments - outer;

    let decomposed = eigen(covariance);
    let beside = all - 1.0;

    // Error of the covariance: a quotient's error is that of its terms over the sum of the weights,
    // which is at least 1; single precision adds a few u.
    let relative = loose_weight / all;
    let middle_off = loose[0].length() / all + middle.length() * relative + 1.0e-6;
    let entries = loose[1].length_squared() + 2.0 * loose[2].length_squared();
    let covariance_off = entries.sqrt() / all
        + norm(&moments) * relative
        + 2.0 * middle.length() * middle_off
        + 2.0e-6;
    // Steps of the weights, single precision, and the slope of 1.5 over the span.
    let beside_off = loose_weight + 2.0e-6;
    let shared = |from: f64, to: f64| {
        let changes = beside + beside_off > from && beside - beside_off < to;
        let off = if changes { (1.5 * beside_off / (to - from)).min(1.0) } else { 0.0 };
        (smoothstep(from, to, beside), off)
    };
    let (share, share_off) = shared(0.5 * fewest, fewest.max(1.0e-6));
    // With two particles a sum is at most 1, with three at most 2.
    let (full, full_off) = shared(1.5, 2.5);
    let scale = lone + (1.0 - lone) * full;
    let (drawn, off) = drawn(&decomposed, covariance_off, ratio, (share, share_off));
    let axes_off = scale * off + (1.0 - lone) * full_off * norm(&drawn) + PACKED;
    let (film, film_off) = film((decomposed.0, covariance_off), shared(SOME[0], SOME[1]));
    let crowd = beside + (CROWDED - beside) * film;
    let crowd_off = (1.0 - film) * beside_off + CROWDED * film_off;
    let strands = shared(BESIDE_SPRAY[0], BESIDE_SPRAY[1]);
    let (spray, spray_off) = self::drawn(&decomposed, covariance_off, strand, strands);
    let spray_off = spray_off + PACKED;
    Formed {
        axes: drawn * scale,
        axes_off,
        spray,
        spray_off,
        crowd,
        crowd_off,
        middle,
        middle_off,
        share,
        share_off,
    }
}

/// Six numbers of 16 bits, signed fractions of 4: half a step in each of nine entries. Then
/// rotations, powers and products in single precision.
const PACKED: f64 = 3.0 * 0.5 * 4.0 / 32767.0 + 64.0 / (1 << 24) as f64;

/// The matrix whose half-axes have the proportions of a covariance's eigenvalues, limited to a
/// ratio, with volume 1, to a power; and its error.
fn drawn(
    (values, vectors): &(DVec3, DMat3),
    covariance_off: f64,
    ratio: f64,
    (share, share_off): (f64, f64),
) -> (DMat3, f64) {
    let most = values.max_element();
    let mut axes = DVec3::ONE;
    if most > 1.0e-6 {
        axes = (*values / most).max(DVec3::splat(1.0 / ratio));
        axes /= (axes.x * axes.y * axes.z).cbrt();
    }
    // Eigenvalues b are divided by the largest, and the others are at least 1/k. `axes` = b/g with
    // g^3 = det b. The derivative is at most 1/g across the eigenvectors, and along them
    // additionally s_i/3 sum 1/b_j.
    let b = (*values / most.max(1.0e-6)).max(DVec3::splat(1.0 / ratio));
    let g = (b.x * b.y * b.z).cbrt();
    let b_off = covariance_off / most.max(1.0e-6) * (1.0 + b.length() + 3.0_f64.sqrt() / ratio);
    let s_off = b_off * (1.0 / g + axes.length() / 3.0 * (1.0 / b.x + 1.0 / b.y + 1.0 / b.z));
    // Error of a power s^p: by p, the logarithm times p's error; by s, p s^(p - 1).
    let logarithm = axes.to_array().into_iter().map(|a| a.ln().abs()).fold(0.0, f64::max);
    let drawn = DVec3::from(axes.to_array().map(|a| a.powf(share)));
    let flat =
        if most > 1.0e-6 { s_off * share * axes.min_element().powf(share - 1.0) } else { 0.0 };
    let matrix = *vectors * DMat3::from_diagonal(drawn) * vectors.transpose();
    (matrix, flat + drawn.length() * logarithm * share_off)
}

/// How much a particle belongs to a film, from its variances and their error, and from how many
/// neighbours it has; and the error.
fn film((values, off): (DVec3, f64), (some, some_off): (f64, f64)) -> (f64, f64) {
    let mut sorted = values.to_array();
    sorted.sort_by(f64::total_cmp);
    let [least, middle, most] = sorted.map(|v| v.max(0.0));
    let ratio = |a: f64, b: f64, [from, to]: [f64; 2]| {
        let b = b.max(1.0e-6);
        let (share, error) = (a / b, (off * (1.0 + a / b) / b).min(1.0e3));
        let changes = share + error > from && share - error < to;
        let error = if changes { (1.5 * error / (to - from)).min(1.0) } else { 0.0 };
        (smoothstep(from, to, share), error)
    };
    let ((thick, thick_off), (broad, broad_off)) =
        (ratio(least, middle, FLAT), ratio(middle, most, BROAD));
    let film = (1.0 - thick) * broad * some;
    (film, thick_off + broad_off + some_off)
}

/// The Frobenius norm.
pub fn norm(m: &DMat3) -> f64 {
    m.to_cols_array().into_iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Eigenvalues and eigenvectors of a symmetric matrix.
pub fn eigen(m: DMat3) -> (DVec3, DMat3) {
    let mean = (m.x_axis.x + m.y_axis.y + m.z_axis.z) / 3.0;
    let rest = m - DMat3::from_diagonal(DVec3::splat(mean));
    let spread = norm(&rest) / 6.0_f64.sqrt();
    if spread < 1.0e-14 {
        return (DVec3::splat(mean), DMat3::IDENTITY);
    }
    // The roots are mean + 2 spread cos(angle + 2 pi k / 3).
    let half = ((rest * (1.0 / spread)).determinant() / 2.0).clamp(-1.0, 1.0);
    let angle = half.acos() / 3.0;
    let root = |turn: f64| mean + 2.0 * spread * (angle + turn).cos();
    let third = std::f64::consts::TAU / 3.0;
    // The first root is the largest, the second the smallest; this takes the one that is far from
    // both others.
    let alone = if half > 0.0 { root(0.0) } else { root(third) };
    let off = m - DMat3::from_diagonal(DVec3::splat(alone));
    let rows = [off.x_axis, off.y_axis, off.z_axis];
    let crosses = [rows[0].cross(rows[1]), rows[1].cross(rows[2]), rows[2].cross(rows[0])];
    let first = crosses.into_iter().max_by(|a, b| a.length().total_cmp(&b.length()));
    let first = first.map_or(DVec3::X, DVec3::normalize);
    let (p, q) = first.any_orthonormal_pair();
    let (pp, qq, pq) = (p.dot(m * p), q.dot(m * q), p.dot(m * q));
    let turn = 0.5 * (2.0 * pq).atan2(pp - qq);
    let second = p * turn.cos() + q * turn.sin();
    let last = q * turn.cos() - p * turn.sin();
    let values = DVec3::new(alone, second.dot(m * second), last.dot(m * last));
    (values, DMat3::from_cols(first, second, last))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Settings =
        Settings { reach: 2.0, ratio: 4.0, fewest: 1.5, lone: 0.5, centred: 1.0, strand: 8.0 };

    fn sorted(m: DMat3) -> [f64; 3] {
        let mut values = eigen(m).0.to_array();
        values.sort_by(f64::total_cmp);
        values
    }

    fn turned() -> DMat3 {
        DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.7)
    }

    #[test]
    fn a_decomposition_is_the_matrix() {
        let r = turned();
        for values in
            [[3.0, 2.0, 1.0], [1.0, 1.0, 0.1], [1.0, 0.1, 0.1], [2.0, 2.0, 2.0], [1.0, 0.0, 0.0]]
        {
            let m = r * DMat3::from_diagonal(values.into()) * r.transpose();
            let (found, vectors) = eigen(m);
            let again = vectors * DMat3::from_diagonal(found) * vectors.transpose();
            assert!(norm(&(again - m)) < 1.0e-12, "{values:?}");
            let mut expected = values;
            expected.sort_by(f64::total_cmp);
            assert!(sorted(m).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1.0e-12));
        }
    }

    /// By hand: a square lattice has a variance of 0 across it, so its axes are 1 : 1 : 1/4 over
    /// their geometric mean; a line has 1 : 1/4 : 1/4; in a cubic lattice all are equal.
    #[test]
    fn sheets_are_flat_lines_are_long_and_the_inside_is_round() {
        let r = turned();
        let range = || -3..=3;
        let lattice = |keep: fn(i32, i32, i32) -> bool| -> Vec<DVec3> {
            let all =
                range().flat_map(|z| range().flat_map(move |y| range().map(move |x| (x, y, z))));
            let kept = all.filter(|(x, y, z)| keep(*x, *y, *z));
            kept.map(|(x, y, z)| r * DVec3::new(x.into(), y.into(), z.into())).collect()
        };
        let of = |points: &[DVec3]| {
            let own = points.iter().position(|p| p.length() < 1.0e-9).unwrap();
            shapes(points, &PLAIN)[own]
        };
        let of_ratio = |k: f64| {
            let flat = DVec3::new(1.0, 1.0, k) / k.cbrt();
            [flat, DVec3::new(1.0, k, k) / (k * k).cbrt(), DVec3::ONE]
        };
        let [waters, sprays] = [of_ratio(0.25), of_ratio(0.125)];
        let points = [
            lattice(|_, _, z| z == 0),
            lattice(|_, y, z| y == 0 && z == 0),
            lattice(|_, _, _| true),
        ];
        let mut expected: Vec<_> = points.into_iter().zip(waters.into_iter().zip(sprays)).collect();
        // A line's two neighbours in reach have a weight of 1.75: a quarter of the way from half
        // the size to the whole size.
        expected[1].1.0 *= 0.5 + 0.5 * (3.0 / 16.0 - 2.0 / 64.0);
        // A lone particle is a sphere of half the size; its spray keeps the whole size.
        expected.push((vec![DVec3::ZERO], (DVec3::splat(0.5), DVec3::ONE)));
        // With one neighbour of weight 7/8, spray is a strand. Water begins at 0.75 and is complete
        // at 1.5, so it has 2/27 of the shape.
        let pair = vec![DVec3::ZERO, r * DVec3::X];
        let (power, strand) = (2.0 / 27.0, of_ratio(0.125)[1]);
        let little = DVec3::from(of_ratio(0.25)[1].to_array().map(|a| a.powf(power)));
        expected.push((pair, (little * 0.5, strand)));
        for (points, both) in expected {
            let turned = |axes: DVec3| r * DMat3::from_diagonal(axes) * r.transpose();
            let Shape { center, axes, spray, crowd: _, off: [_, slack, loose, _] } = of(&points);
            let m = turned(both.0);
            assert!(norm(&(axes - m)) < slack, "{axes} for {m}, {slack}");
            let m = turned(both.1);
            assert!(norm(&(spray - m)) < loose, "spray: {spray} for {m}, {loose}");
            assert!(loose < 0.05, "{loose}");
            let slack = if points.len() == 2 { 0.0 } else { slack };
            let center = if points.len() == 2 { DVec3::ZERO } else { center };
            assert!(slack < 0.05 && center.length() < 1.0e-4, "{slack} {center}");
        }
    }
}
