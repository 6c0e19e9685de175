//! Motion of each particle's neighbours relative to it: the air that they trap between them, and how they differ.

use glam::Vec3;

use crate::cells::Cells;

/// Sum of the weights of a particle's neighbours inside a body of water: the integral of 1 - q/2 over the ball of
/// radius 2, where q is the distance in particle spacings.
const WHOLE: f32 = 8.0 * std::f32::consts::PI / 3.0;

/// How a particle's neighbours move relative to it, in scene units a second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relative {
    /// Trapped-air potential (Ihmsen et al. 2012, Eq. 2): the weighted mean of the neighbours' relative speeds,
    /// counted twice for a neighbour that approaches head-on, once for one that passes, and not for one that recedes.
    /// It is `Σ |v_ij| (1 - v_ij·x_ij) (1 - |x_ij| / h)`, with unit vectors in the scalar product and h of two
    /// spacings, over the sum of the weights inside a body of water. So it is 0 in water that rests or moves as a
    /// whole without turning, and for lone particles.
    pub trapped: f32,
    /// Root mean square of the neighbours' relative speeds with the same weights, over the sum of the weights of the
    /// neighbours there are. It is 0 for lone particles.
    pub spread: f32,
}

/// Returns the relative motion round each particle. Particles with a non-finite position or velocity have 0 and are no
/// one's neighbour.
pub fn relative(positions: &[[f32; 3]], velocities: &[[f32; 3]], spacing: f32) -> Vec<Relative> {
    let reach = 2.0 * spacing;
    let velocity = |i: usize| Vec3::from(velocities[i]);
    let cells = Cells::new(positions, reach, |i| i < velocities.len() && velocity(i).is_finite());
    let found = cells.map(
        |_| true,
        |index, p, others| {
            let own = velocity(index);
            let (mut trapped, mut squares, mut weights) = (0.0, 0.0, 0.0);
            for (other, there) in others {
                let (apart, relative) = (p - there, own - velocity(other));
                let distance = apart.length();
                // The particle itself is among the neighbours.
                if distance > 0.0 && distance < reach {
                    let weight = 1.0 - distance / reach;
                    trapped += approach(apart / distance, relative) * weight;
                    squares += relative.length_squared() * weight;
                    weights += weight;
                }
            }
            let spread = if weights > 0.0 { (squares / weights).sqrt() } else { 0.0 };
            Relative { trapped: trapped / WHOLE, spread }
        },
    );
    let mut all = vec![Relative::default(); positions.len()];
    for (index, one) in found {
        all[index] = one;
    }
    all
}

/// One neighbour's term of the trapped-air potential without its weight: the unit vector x_ij is `apart`, which points
/// from the neighbour to the particle, v_ij is `relative`, the particle's velocity less the neighbour's.
fn approach(apart: Vec3, relative: Vec3) -> f32 {
    relative.length() - relative.dot(apart)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: f32 = 0.05;

    type Flow = fn(Vec3) -> Vec3;

    /// Returns the positions of a block of 20 layers of 20 by 20 particles, and the motion round them if they move with
    /// `velocity`, which is a function of the position.
    fn moving(velocity: impl Fn(Vec3) -> Vec3) -> (Vec<[f32; 3]>, Vec<Relative>) {
        let at = |i: u16| [i % 20, i / 20 % 20, i / 400].map(|i| SPACING * (f32::from(i) - 9.5));
        let positions: Vec<_> = (0..8000).map(at).collect();
        let velocities: Vec<_> =
            positions.iter().map(|p| velocity((*p).into()).to_array()).collect();
        let found = relative(&positions, &velocities, SPACING);
        (positions, found)
    }

    /// As `moving`, with the trapped-air potentials alone.
    fn block(velocity: impl Fn(Vec3) -> Vec3) -> (Vec<[f32; 3]>, Vec<f32>) {
        let (positions, found) = moving(velocity);
        (positions, found.into_iter().map(|one| one.trapped).collect())
    }

    #[test]
    fn water_that_rests_flows_turns_or_falls_traps_none() {
        let flows: [(&str, Flow); 3] = [
            ("rests", |_| Vec3::ZERO),
            ("flows", |_| Vec3::new(7.0, -3.0, 2.0)),
            ("stretches as a falling jet", |p| Vec3::new(0.0, 2.0 * p.y, 0.0)),
        ];
        for (what, flow) in flows {
            let most = block(flow).1.into_iter().fold(0.0, f32::max);
            assert!(most < 0.15, "{what}: {most}");
        }
    }

    /// Two layers of particles that collide at 2 scene units a second trap air where they meet; layers that part trap
    /// much less. The expected potential is the sum over the neighbours on the particles' lattice.
    #[test]
    fn layers_that_meet_trap_air_where_they_meet() {
        let towards = |sign: f32| move |p: Vec3| Vec3::new(0.0, -sign * p.y.signum(), 0.0);
        let (positions, meet) = block(towards(1.0));
        let (_, part) = block(towards(-1.0));
        let middle = |p: &[f32; 3]| p[0].abs() < 0.3 && p[2].abs() < 0.3;
        let layer = |speeds: &[f32], y: f32| {
            let all =
                positions.iter().zip(speeds).filter(|(p, _)| middle(p) && (p[1] - y).abs() < 0.01);
            all.map(|(_, speed)| *speed).fold(0.0, f32::max)
        };
        let mut expected = 0.0;
        for (x, y, z) in
            (-2..=2).flat_map(|x| (1..=2).flat_map(move |y| (-2..=2).map(move |z| (x, y, z))))
        {
            let distance = Vec3::new(x as f32, y as f32, z as f32).length();
            expected += 2.0 * (1.0 + y as f32 / distance) * (1.0 - 0.5 * distance).max(0.0) / WHOLE;
        }
        // Each value is the same for every particle in the middle, wherever in its grid cell it lies.
        for (p, speed) in positions.iter().zip(&meet).filter(|(p, _)| middle(p)) {
            let there = if p[1].abs() < SPACING { expected } else { 0.0 };
            let off = (speed - there).abs();
            assert!(p[1].abs() < 2.0 * SPACING || off == 0.0, "{p:?}: {speed}");
            assert!(p[1].abs() > SPACING || off < 1.0e-3 * expected, "{p:?}: {speed} {expected}");
        }
        assert_eq!(layer(&meet, 0.175), 0.0, "out of reach");
        assert!(layer(&part, 0.025) < 0.35 * layer(&meet, 0.025));
    }

    /// In a flow with a gradient G the neighbours' relative speeds are G times their distances. The expected spread is
    /// the sum over the neighbours on the particles' lattice, of which none is beyond one spacing and its diagonals.
    #[test]
    fn neighbours_of_a_sheared_flow_spread_by_its_gradient() {
        let (positions, sheared) = moving(|p| Vec3::new(3.0 * p.y - 5.0, 0.0, 0.0));
        let (mut squares, mut weights) = (0.0, 0.0);
        for (x, y, z) in
            (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| (x, y, z))))
        {
            let distance = Vec3::new(x as f32, y as f32, z as f32).length();
            let weight = if distance > 0.0 { 1.0 - 0.5 * distance } else { 0.0 };
            squares += weight * (3.0 * SPACING * y as f32).powi(2);
            weights += weight;
        }
        let wanted = (squares / weights).sqrt();
        let inside = |p: &[f32; 3]| p.iter().all(|c| c.abs() < 8.0 * SPACING);
        let found = positions.iter().zip(&sheared).filter(|(p, _)| inside(p));
        assert!(found.clone().count() > 1000);
        for (p, one) in found {
            assert!(
                (one.spread - wanted).abs() < 1.0e-3 * wanted,
                "{p:?}: {} {wanted}",
                one.spread
            );
        }
        let (_, flows) = moving(|_| Vec3::new(7.0, -3.0, 2.0));
        assert!(flows.iter().all(|one| *one == Relative::default()));
    }

    /// The motion round valid particles changes neither with the order of the particles nor if invalid ones (NaN,
    /// infinite or far away) are among them.
    #[test]
    fn odd_particles_change_nothing() {
        let flow = |p: Vec3| Vec3::new((40.0 * p.y).sin(), (30.0 * p.z).cos(), p.x);
        let (mut positions, whole) = moving(flow);
        let mut velocities: Vec<_> =
            positions.iter().map(|p| flow((*p).into()).to_array()).collect();
        for odd in [[f32::NAN; 3], [1.0e30, 0.0, 0.0], [0.0, -f32::INFINITY, 0.0], [-1.0e12; 3]] {
            positions.push(odd);
            velocities.push([1.0; 3]);
        }
        positions.push([0.0; 3]);
        velocities.push([0.0, f32::NAN, 0.0]);
        positions.reverse();
        velocities.reverse();
        let mut found = relative(&positions, &velocities, SPACING);
        assert!(found[..5].iter().all(|one| *one == Relative::default()), "{:?}", &found[..5]);
        found.reverse();
        let near = |a: f32, b: f32| (a - b).abs() <= 1.0e-4 * b.max(0.01);
        for (a, b) in found.iter().zip(&whole) {
            assert!(near(a.trapped, b.trapped) && near(a.spread, b.spread), "{a:?} {b:?}");
        }
        assert!(whole.iter().any(|one| one.trapped > 0.1 && one.spread > 0.1));
        assert!(relative(&[], &[], SPACING).is_empty());
    }
}
