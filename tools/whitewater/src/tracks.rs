//! Whether the ids of two frames follow the particles, and their velocities the motion.

use std::collections::HashMap;

use glam::Vec3;
use whitewater::io::particles::{Particles, estimate_spacing};

use crate::odd::Size;
use crate::surface_foam::quantile;

/// What the motion between two frames says.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Particles with one id move as their velocities say; seconds between the frames.
    Seconds(f32),
    /// Ids are the numbers of the rows, and the rows hold other particles in the other frame.
    Rows,
    /// Velocities fit the motion only with these of their axes as x, y, z (such as `x z y`); seconds between the frames.
    Turned(&'static str, f32),
}

impl Motion {
    /// Warning for the user.
    pub fn warning(&self) -> Option<String> {
        match self {
            Self::Seconds(_) => None,
            Self::Rows => Some(
                "ids are dropped: they number the rows, and the rows hold other particles in the next frame, as the \
                 velocities show; write an id that stays with its particle"
                    .into(),
            ),
            Self::Turned(axes, _) => Some(format!(
                "velocities do not fit how the particles move from frame to frame; with the axes {axes} they do: write \
                 them in the axes of the positions"
            )),
        }
    }
}

/// Particles slower than this part of the root mean square speed show no direction.
const SLOW: f32 = 0.1;
/// A particle moves as its velocity says if its displacement is off by less than this part of it. Between two frames
/// the mean of both velocities replaces the path.
const OFF: f32 = 0.5;
/// If the ids follow the particles, at least this share of the moving ones moves as the velocities say.
const MOST: f32 = 0.5;
/// If velocities are in other axes, at least this share moves as they say in the right axes.
const CLEAR: f32 = 0.8;
/// If the rows are shuffled, at most `FEW` of the particles move as their velocities say, and at least `BACK` move backward,
/// against them: half of them do by chance, and few do between frames that are far apart in time.
const FEW: f32 = 0.3;
const BACK: f32 = 0.35;
/// If the rows are shuffled, two particles of one row are mostly at least this many spacings apart. The particles of still
/// water tremble by less, with velocities that say little about the way from frame to frame.
const APART: f32 = 1.0;
/// Max ratio of the extents of two frames that are compared.
const ALIKE: f32 = 3.0;
/// Min number of moving particles for a doubt about ids or velocities.
const ENOUGH: usize = 32;

/// A displacement, and the mean of the velocities at both ends.
type Step = (Vec3, Vec3);

/// Compares the displacements of particles with the same id with their velocities. `None` if the frames show nothing, or
/// if they are too far apart in time.
pub fn motion(first: &Particles, second: &Particles) -> Option<Motion> {
    let extent = |frame: &Particles| Some(Size::of(0, &frame.positions)?.extent);
    let ratio = extent(first)? / extent(second)?;
    // One of the frames is in another unit.
    if !(1.0 / ALIKE..=ALIKE).contains(&ratio) {
        return None;
    }
    let steps = steps(first, second)?;
    let own = fit(&steps, |v| v);
    if let Some((seconds, share)) = own
        && share >= MOST
    {
        return Some(Motion::Seconds(seconds));
    }
    if steps.len() < ENOUGH {
        return None;
    }
    let share = own.map_or(0.0, |(_, share)| share);
    let turned = AXES.iter().filter_map(|(name, turn)| Some((*name, fit(&steps, turn)?)));
    let best = turned.max_by(|a, b| a.1.1.total_cmp(&b.1.1));
    if let Some((name, (seconds, best))) = best
        && best >= CLEAR
    {
        return Some(Motion::Turned(name, seconds));
    }
    let back = steps.iter().filter(|(moved, v)| moved.dot(*v) < 0.0).count();
    let shuffled = back as f32 >= BACK * steps.len() as f32 && share <= FEW;
    (shuffled && rows(first) && rows(second) && far(first, &steps)?).then_some(Motion::Rows)
}

/// Whether most steps are as far as other particles are.
fn far(particles: &Particles, steps: &[Step]) -> Option<bool> {
    let median = quantile(steps.iter().map(|(moved, _)| moved.length()).collect(), 0.5)?;
    Some(median >= APART * estimate_spacing(&particles.positions)?)
}

/// Velocities in other axes: names of those that are x, y and z.
#[expect(clippy::type_complexity, reason = "a table")]
const AXES: [(&str, fn(Vec3) -> Vec3); 8] = [
    ("x z y", |v| Vec3::new(v.x, v.z, v.y)),
    ("x z -y", |v| Vec3::new(v.x, v.z, -v.y)),
    ("x -z y", |v| Vec3::new(v.x, -v.z, v.y)),
    ("y x z", |v| Vec3::new(v.y, v.x, v.z)),
    ("z y x", |v| Vec3::new(v.z, v.y, v.x)),
    ("y z x", |v| Vec3::new(v.y, v.z, v.x)),
    ("z x y", |v| Vec3::new(v.z, v.x, v.y)),
    ("-x -y -z", |v| -v),
];

/// The steps of the particles that move.
fn steps(first: &Particles, second: &Particles) -> Option<Vec<Step>> {
    let (ids, velocities) = (first.ids.as_ref()?, first.velocities.as_ref()?);
    let later = second.ids.as_ref()?.iter().zip(&second.positions);
    let later = later.zip(second.velocities.as_ref()?);
    let later: HashMap<u32, (Vec3, Vec3)> =
        later.map(|((id, p), v)| (*id, (Vec3::from(*p), Vec3::from(*v)))).collect();
    let now = ids.iter().zip(&first.positions).zip(velocities);
    let step = |((id, p), v): ((&u32, &[f32; 3]), &[f32; 3])| {
        let (position, velocity) = later.get(id)?;
        let step = (*position - Vec3::from(*p), 0.5 * (Vec3::from(*v) + *velocity));
        (step.0.is_finite() && step.1.is_finite()).then_some(step)
    };
    let mut steps: Vec<Step> = now.filter_map(step).collect();
    let squares: f64 = steps.iter().map(|(_, v)| f64::from(v.length_squared())).sum();
    let slow = SLOW * (squares / steps.len().max(1) as f64).sqrt() as f32;
    steps.retain(|(_, v)| v.length() > slow);
    Some(steps)
}

/// The seconds between the frames, as the median of the displacements along the velocities over the speeds, and the
/// share of particles that move as these say. `None` if nothing moves forward.
fn fit(steps: &[Step], turn: impl Fn(Vec3) -> Vec3) -> Option<(f32, f32)> {
    let each = steps.iter().map(|(moved, v)| moved.dot(turn(*v)) / v.length_squared());
    let seconds = quantile(each.filter(|s| s.is_finite() && *s > 0.0).collect(), 0.5)?;
    let agrees = |(moved, v): &&Step| {
        let way = seconds * turn(*v);
        moved.distance(way) <= OFF * way.length()
    };
    let share = steps.iter().filter(agrees).count() as f32 / steps.len().max(1) as f32;
    Some((seconds, share))
}

/// Whether ids number the rows, from 0 or 1.
fn rows(particles: &Particles) -> bool {
    let Some(ids) = &particles.ids else { return false };
    let first = ids.first().copied().unwrap_or(2);
    first < 2 && ids.iter().zip(first..).all(|(id, row)| *id == row)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A vortex of 400 particles, and the same `seconds` later.
    fn vortex(seconds: f32) -> [Particles; 2] {
        let frame = |angle: f32| {
            let at = |i: usize| {
                let (radius, turn) = (0.1 + 0.002 * (i % 20) as f32, 0.7 * i as f32 + angle);
                Vec3::new(radius * turn.cos(), 0.01 * (i / 20) as f32, radius * turn.sin())
            };
            let positions: Vec<Vec3> = (0..400).map(at).collect();
            // One turn takes 2π seconds; all rise by a tenth of a metre a second.
            let speed = |p: &Vec3| [-p.z, 0.1, p.x];
            let up = Vec3::Y * 0.1 * angle;
            let mut particles =
                Particles::from_positions(positions.iter().map(|p| (*p + up).to_array()).collect());
            particles.velocities = Some(positions.iter().map(speed).collect());
            particles.ids = Some((0..400).collect());
            particles
        };
        [frame(0.0), frame(seconds)]
    }

    /// Reorders the particles, and their ids with `ids`.
    fn shuffled(particles: &mut Particles, ids: bool) {
        let order: Vec<usize> = (0..400).map(|i| (i * 61 + 31) % 400).collect();
        for list in std::iter::once(&mut particles.positions).chain(&mut particles.velocities) {
            *list = order.iter().map(|i| list[*i]).collect();
        }
        if ids {
            particles.ids = Some(order.iter().map(|i| *i as u32).collect());
        }
    }

    #[test]
    fn time_is_found_by_how_far_they_went() {
        for expected in [0.001, 0.04, 0.5] {
            let [first, mut second] = vortex(expected);
            shuffled(&mut second, true);
            let Some(Motion::Seconds(found)) = motion(&first, &second) else { panic!() };
            assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
        }
        let [first, mut second] = vortex(0.04);
        assert_eq!(motion(&first, &first), None, "nothing moved");
        second.ids = Some((1000..1400).collect());
        assert_eq!(motion(&first, &second), None, "others");
        second.ids = None;
        assert_eq!(motion(&first, &second), None, "no ids");
        // After half a turn each particle has moved against its mean velocity.
        let [first, second] = vortex(3.0);
        assert!(!matches!(motion(&first, &second), Some(Motion::Rows)), "far apart in time");
    }

    #[test]
    fn numbers_of_rows_are_no_ids() {
        for from in [0, 1] {
            let [mut first, mut second] = vortex(0.04);
            shuffled(&mut second, false);
            for frame in [&mut first, &mut second] {
                frame.ids = Some((from..from + 400).collect());
            }
            assert_eq!(motion(&first, &second), Some(Motion::Rows));
            // Rows that keep their order have ids.
            shuffled(&mut first, false);
            assert!(matches!(motion(&first, &second), Some(Motion::Seconds(_))));
        }
        // Other ids are trusted, although they give no time.
        let [mut first, mut second] = vortex(0.04);
        shuffled(&mut second, false);
        for frame in [&mut first, &mut second] {
            frame.ids = Some((7..407).collect());
        }
        assert_eq!(motion(&first, &second), None);
    }

    /// Particles that tremble about their places have velocities that say nothing about the way between two frames.
    #[test]
    fn numbers_of_rows_of_still_water_are_ids() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0 - 0.5
        };
        let mut still = || {
            let place = |i: usize| [i % 10, i / 10 % 10, i / 100].map(|c| 0.02 * c as f32);
            let places = (0..1000).map(|i| place(i).map(|c| c + 0.01 * random()));
            let mut particles = Particles::from_positions(places.collect());
            particles.velocities = Some((0..1000).map(|_| [0.0; 3].map(|_| random())).collect());
            particles.ids = Some((0..1000).collect());
            particles
        };
        let [first, mut second] = [still(), still()];
        assert_eq!(motion(&first, &second), None);
        // The same with its rows in another order.
        second.positions.rotate_left(367);
        assert_eq!(motion(&first, &second), Some(Motion::Rows));
    }

    #[test]
    fn velocities_in_other_axes_are_told() {
        for (name, turn) in [
            ("x z y", (|[x, y, z]| [x, z, y]) as fn([f32; 3]) -> [f32; 3]),
            ("y x z", |[x, y, z]| [y, x, z]),
            ("-x -y -z", |v| v.map(|c| -c)),
        ] {
            let [mut first, mut second] = vortex(0.04);
            for frame in [&mut first, &mut second] {
                frame.velocities.iter_mut().flatten().for_each(|v| *v = turn(*v));
            }
            let Some(Motion::Turned(found, seconds)) = motion(&first, &second) else { panic!() };
            assert_eq!(found, name);
            assert!((seconds - 0.04).abs() < 0.002, "{seconds}");
        }
        // A fall along one axis looks alike in most axes: nothing is said.
        let [mut first, mut second] = vortex(0.0);
        for (frame, way) in [(&mut first, 0.0), (&mut second, -0.1)] {
            frame.positions.iter_mut().for_each(|p| p[1] += way);
            frame.velocities = Some(vec![[0.0, -2.5, 0.0]; 400]);
        }
        assert_eq!(motion(&first, &second), Some(Motion::Seconds(0.04)));
    }
}
