//! Detects films: water one layer thick on a floor or a wall. Its density is as low as that of torn
//! water, but it is no spray.

use glam::{Mat3, Vec3};

use crate::cells::Cells;

/// Min number of neighbours of a particle in a film.
const NEIGHBOURS: usize = 6;
/// In a film the ratio of the smallest to the middle variance of the neighbours' positions is below this. Flying sheets
/// are rarely so flat: of the particles with 0.4 to 0.65 of the rest density, 2 % are below it in a splash crown and in
/// jets, and 64 % in a film that runs over a floor.
const FLAT: f32 = 0.02;
/// Min ratio of the middle to the largest variance of the neighbours' positions; with a lower ratio the neighbours
/// form a thread, not a film.
const BROAD: f32 = 0.25;

/// If the water is higher than this, in spacings, its topmost particles are assumed to touch the lid of a box.
const LID: f32 = 8.0;

/// Raises the densities of particles in films to at least `limit`, so that a film is not drawn as spray. A particle
/// is in a film if it and its neighbours within two spacings lie in one plane.
pub fn hold(positions: &[[f32; 3]], densities: &mut [f32], spacing: f32, limit: f32) {
    let reach = 2.0 * spacing;
    let cells = Cells::new(positions, reach, |_| true);
    let heights = || positions.iter().map(|p| p[1]).filter(|y| y.is_finite());
    let (low, high) = (heights().fold(f32::MAX, f32::min), heights().fold(f32::MIN, f32::max));
    // The topmost layer is left out: a flat layer above all other water has hit the lid of the solver's box, and
    // falls in drops.
    let lid = if high - low > LID * spacing { high - spacing } else { f32::MAX };
    let few = |i: usize| densities[i] > 0.0 && densities[i] < limit && positions[i][1] < lid;
    let flat = cells.map(few, |_, p, others| {
        let others = others.map(|(_, other)| other - p);
        let near: Vec<Vec3> = others.filter(|off| off.length_squared() < reach * reach).collect();
        near.len() > NEIGHBOURS && is_flat(&near)
    });
    for (index, _) in flat.into_iter().filter(|(_, flat)| *flat) {
        densities[index] = limit;
    }
}

fn is_flat(all: &[Vec3]) -> bool {
    let mean = all.iter().sum::<Vec3>() / all.len() as f32;
    let outer = |v: Vec3| Mat3::from_cols(v * v.x, v * v.y, v * v.z);
    let sum = all.iter().fold(Mat3::ZERO, |sum, p| sum + outer(*p - mean));
    let [least, middle, most] = eigenvalues(sum * (all.len() as f32).recip());
    least < FLAT * middle && middle > BROAD * most
}

/// Eigenvalues of a symmetric matrix in ascending order (Smith 1961).
fn eigenvalues(m: Mat3) -> [f32; 3] {
    let mean = (m.x_axis.x + m.y_axis.y + m.z_axis.z) / 3.0;
    let off = m - Mat3::from_diagonal(Vec3::splat(mean));
    let squares = off.to_cols_array().iter().map(|v| v * v).sum::<f32>();
    let p = (squares / 6.0).sqrt();
    if p <= 1.0e-6 * mean.abs() {
        return [mean; 3];
    }
    let angle = (0.5 * (off * p.recip()).determinant()).clamp(-1.0, 1.0).acos() / 3.0;
    let turn = std::f32::consts::TAU / 3.0;
    let most = mean + 2.0 * p * angle.cos();
    let least = mean + 2.0 * p * (angle + turn).cos();
    [least.max(0.0), 3.0 * mean - most - least, most]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bubbles::Random;

    const SPACING: f32 = 0.1;

    fn held(positions: &[[f32; 3]]) -> usize {
        let mut densities = vec![0.5; positions.len()];
        hold(positions, &mut densities, SPACING, 0.65);
        densities.iter().filter(|d| **d > 0.6).count()
    }

    /// 400 particles in a plane that is tilted by `tilt` radians. They are displaced randomly in the plane (`anyhow`)
    /// and off it (`off`); both are the width of the displacements' range in spacings.
    fn plane(tilt: f32, anyhow: f32, off: f32) -> Vec<[f32; 3]> {
        let mut random = Random(7);
        let mut noise = || random.next() - 0.5;
        let turn = Mat3::from_rotation_x(tilt);
        let mut at = |i: u32| {
            let grid = [
                (i % 20) as f32 + anyhow * noise(),
                off * noise(),
                (i / 20) as f32 + anyhow * noise(),
            ];
            (turn * (SPACING * Vec3::from(grid))).to_array()
        };
        (0..400).map(&mut at).collect()
    }

    #[test]
    fn films_hold_on_any_slope_and_torn_water_does_not() {
        for tilt in [0.0, 0.6, 1.57] {
            // Some of the 76 particles at the border lie on a line.
            assert!(held(&plane(tilt, 0.4, 0.05)) > 324, "{tilt}");
            assert!(held(&plane(tilt, 0.4, 0.9)) < 40, "{tilt}: {}", held(&plane(tilt, 0.4, 0.9)));
        }
        // A plane far above other water.
        let lid = Vec3::new(0.0, 12.0 * SPACING, 0.0);
        let above = plane(0.0, 0.4, 0.05).into_iter().map(|p| (Vec3::from(p) + lid).to_array());
        let both: Vec<_> = above.chain(plane(0.0, 0.4, 0.05)).collect();
        let mut densities = vec![0.5; both.len()];
        hold(&both, &mut densities, SPACING, 0.65);
        let [upper, lower] = [0, 400].map(|i| &densities[i..i + 400]);
        assert!(upper.iter().all(|d| *d < 0.6) && lower.iter().any(|d| *d > 0.6));
        let thread: Vec<_> = (0..50_u8).map(|i| [0.5 * SPACING * f32::from(i), 0.0, 0.0]).collect();
        assert_eq!(held(&thread), 0);
        let alone: Vec<_> = (0..50_u8).map(|i| [3.0 * SPACING * f32::from(i), 0.0, 0.0]).collect();
        assert_eq!(held(&alone), 0);
        let odd = [[f32::NAN; 3], [0.0; 3], [f32::INFINITY; 3]];
        assert_eq!(held(&odd), 0);
    }

    #[test]
    fn eigenvalues_are_those_of_a_turned_diagonal() {
        for wanted in [[1.0, 2.0, 3.0], [0.0, 0.5, 0.5], [2.0; 3], [0.0, 0.0, 4.0]] {
            let turn = Mat3::from_rotation_y(0.7) * Mat3::from_rotation_x(-1.1);
            let found = eigenvalues(turn * Mat3::from_diagonal(wanted.into()) * turn.transpose());
            let near = found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 3.0e-3);
            assert!(near, "{found:?} {wanted:?}");
        }
    }
}
