//! Converts axes and units of files to those of the scene: y up, metres.

use std::ops::Neg;

use clap::ValueEnum;
use glam::Vec3;
use whitewater::io::particles::{LENGTH_UNITS, Meaning, Particles};

use crate::args::{Unit, Up};
use crate::surface_foam::quantile;

impl Up {
    /// The axis with this index; with `against`, its negative.
    pub fn along(axis: usize, against: bool) -> Self {
        match (axis, against) {
            (0, false) => Self::X,
            (0, true) => Self::MinusX,
            (2, false) => Self::Z,
            (2, true) => Self::MinusZ,
            (_, false) => Self::Y,
            (_, true) => Self::MinusY,
        }
    }

    /// Index of the axis.
    pub fn axis(self) -> usize {
        match self {
            Self::X | Self::MinusX => 0,
            Self::Y | Self::MinusY => 1,
            Self::Z | Self::MinusZ => 2,
        }
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::MinusX => "-x",
            Self::Y => "y",
            Self::MinusY => "-y",
            Self::Z => "z",
            Self::MinusZ => "-z",
        }
    }

    /// Rotates a vector of the files so that this axis becomes y. It is a pure rotation, without a reflection.
    pub fn turn<T: Neg<Output = T>>(self, [x, y, z]: [T; 3]) -> [T; 3] {
        match self {
            Self::Y => [x, y, z],
            Self::MinusY => [x, -y, -z],
            Self::Z => [x, z, -y],
            Self::MinusZ => [x, -z, y],
            Self::X => [-y, x, z],
            Self::MinusX => [y, -x, z],
        }
    }

    /// The inverse rotation.
    pub fn turn_back<T: Neg<Output = T>>(self, vector: [T; 3]) -> [T; 3] {
        let inverse = match self {
            Self::Z => Self::MinusZ,
            Self::MinusZ => Self::Z,
            Self::X => Self::MinusX,
            Self::MinusX => Self::X,
            same => same,
        };
        inverse.turn(vector)
    }
}

/// Transform from the files to the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    pub up: Up,
    /// Metres per unit of the files.
    pub scale: f32,
    /// Offset that is subtracted from positions far from the origin, in units of the files; one for all frames.
    pub origin: [f64; 3],
}

impl Default for Placing {
    fn default() -> Self {
        Self { up: Up::Y, scale: 1.0, origin: [0.0; 3] }
    }
}

impl Placing {
    pub fn place(&self, particles: &mut Particles) {
        particles.move_to(self.origin);
        let Particles { positions, velocities, .. } = particles;
        self.scale(positions.iter_mut().chain(velocities.iter_mut().flatten()));
        if self.up != Up::Y {
            let vectors = positions.iter_mut().chain(velocities.iter_mut().flatten());
            vectors.for_each(|v| *v = self.up.turn(*v));
        }
    }

    /// Subtracts the offset, turned and scaled like the particles, from a point near particles that lie far from the
    /// origin in the files. `None` if the unchanged point is nearer to the origin, where the water is after the move.
    pub fn moved(&self, point: [f32; 3]) -> Option<[f32; 3]> {
        let origin = self.up.turn(self.origin.map(|c| c * f64::from(self.scale)));
        let moved: [f64; 3] = std::array::from_fn(|i| f64::from(point[i]) - origin[i]);
        let length = |p: [f64; 3]| p.iter().map(|c| c * c).sum::<f64>();
        (length(moved) < length(point.map(f64::from))).then(|| moved.map(|c| c as f32))
    }

    fn scale<'a>(&self, vectors: impl IntoIterator<Item = &'a mut [f32; 3]>) {
        if self.scale != 1.0 {
            vectors.into_iter().flatten().for_each(|c| *c *= self.scale);
        }
    }

    /// The inverse transform, back to the files.
    pub fn back(&self, positions: &mut [[f32; 3]], velocities: &mut [[f32; 3]]) {
        if self.up != Up::Y {
            let vectors = positions.iter_mut().chain(velocities.iter_mut());
            vectors.for_each(|v| *v = self.up.turn_back(*v));
        }
        Self { scale: self.scale.recip(), ..*self }
            .scale(positions.iter_mut().chain(velocities.iter_mut()));
        let origin = self.origin;
        for p in positions.iter_mut().filter(|_| origin != [0.0; 3]) {
            *p = std::array::from_fn(|i| (f64::from(p[i]) + origin[i]) as f32);
        }
    }
}

/// Gravity, m/s².
const GRAVITY: f32 = 9.81;
/// Max plausible squared Froude number, v² / (g · extent), with the speed v of fast water and the water's extent.
/// Water after a fall through its own height has 2, a jet under pressure a few times as much. If the unit of the file
/// is really a centimetre or a millimetre, the number is far larger.
const FASTEST: f32 = 40.0;
/// If the speed of the water gives no hint of the unit, the user is asked for it if the water's extent, read in
/// metres, is above `LARGE` or below `TINY`.
const LARGE: f32 = 200.0;
const TINY: f32 = 0.005;

/// The 0.99 quantile of the speeds; `None` without velocities.
pub fn fastest(particles: &Particles) -> Option<f32> {
    let speeds = particles.velocities.as_ref()?.iter().map(|v| Vec3::from(*v).length());
    quantile(speeds.filter(|speed| speed.is_finite()).collect(), 0.99)
}

/// The unit of length that stands in brackets after the names of the position attributes, or in a row of units below
/// them: its name, metres per unit, and the first of the attributes' names.
fn named(particles: &Particles) -> Option<(&'static str, f64, &str)> {
    let (unit, name) = bracketed(particles, Meaning::Position)?;
    let (unit, metres) = length(unit)?;
    Some((unit, metres, name))
}

/// What stands in brackets behind the names of all attributes with this meaning, and the first of these names.
fn bracketed(particles: &Particles, meaning: Meaning) -> Option<(&str, &str)> {
    let (_, names) = particles.meanings.iter().find(|(m, _)| *m == meaning)?;
    fn unit(name: &str) -> Option<&str> {
        let (before, unit) = name.rsplit_once(['[', '('])?;
        (!before.trim().is_empty()).then(|| unit.trim_end().trim_end_matches([']', ')']).trim())
    }
    let first = names.first()?;
    let all = names.iter().map(|name| unit(name));
    let mut units = all.collect::<Option<Vec<_>>>()?.into_iter();
    let of_first = unit(first)?;
    units.all(|unit| unit == of_first).then_some((of_first, first))
}

fn length(unit: &str) -> Option<(&'static str, f64)> {
    LENGTH_UNITS.into_iter().find(|(known, _)| *known == unit)
}

/// Metres per second in a unit of speed, such as `mm/s`, `m s^-1`, `m.s-1` or `km/h`.
fn speed(unit: &str) -> Option<f64> {
    const TIMES: [(&str, f64); 6] =
        [("s", 1.0), ("sec", 1.0), ("ms", 1.0e-3), ("min", 60.0), ("h", 3600.0), ("hr", 3600.0)];
    let end = unit.find(|c: char| !c.is_alphabetic())?;
    let (metres, rest) = (length(&unit[..end])?.1, unit[end..].trim_start());
    let time = match rest.strip_prefix('/') {
        Some(time) => time.trim(),
        None => {
            let time = rest.trim_start_matches(['.', '*', '\u{b7}', '\u{22c5}']).trim();
            let of = ["^-1", "^(-1)", "^{-1}", "**-1", "-1", "\u{207b}\u{b9}"];
            of.iter().find_map(|power| time.strip_suffix(power))?.trim_end()
        }
    };
    let (_, seconds) = TIMES.into_iter().find(|(known, _)| *known == time)?;
    Some(metres / seconds)
}

/// Velocities whose names say their unit are converted to the unit of the positions, if this is another one. `scale` is the
/// metres per unit of length that the user gave; without (1), the names of the positions count. Returns a message.
pub fn agree(particles: &mut Particles, scale: f32) -> Option<String> {
    let metres = match named(particles) {
        Some((_, metres, _)) if scale == 1.0 => metres,
        _ => f64::from(scale),
    };
    let (unit, name) = bracketed(particles, Meaning::Velocity)?;
    let factor = (speed(unit)? / metres) as f32;
    if (factor - 1.0).abs() < 1.0e-5 {
        return None;
    }
    let told = format!(
        "velocities are read in {unit}, as their names say (`{name}`), and converted to the unit of the positions"
    );
    let all = particles.velocities.as_mut()?;
    all.as_flattened_mut().iter_mut().for_each(|c| *c *= factor);
    Some(told)
}

/// A message about that unit, if it is not the metre.
pub fn named_hint(particles: &Particles) -> Option<String> {
    let (unit, metres, name) = named(particles).filter(|(_, metres, _)| *metres != 1.0)?;
    let flag = match Unit::from_str(unit, false) {
        Ok(_) => format!("--unit {unit}"),
        Err(_) if metres < 1.0e-3 => format!("--scale {metres:e}"),
        Err(_) => format!("--scale {metres}"),
    };
    Some(format!(
        "the names of the positions say {unit}, but they are read as metres; {flag} converts them (the name is `{name}`; \
         a row of units below the names counts)"
    ))
}

/// A message that this unit is the metre.
pub fn named_metres(particles: &Particles) -> Option<String> {
    let (.., name) = named(particles).filter(|(_, metres, _)| *metres == 1.0)?;
    Some(format!(
        "m, as the names of the positions say (`{name}`; a row of units below the names counts)"
    ))
}

/// A message if the water's extent in metres is implausible. `fastest` is the speed that nearly all particles stay
/// below, if it is known.
pub fn hint(extent: f32, fastest: Option<f32>) -> Option<String> {
    let spans = format!("the water spans {} metres", crate::looks::round(extent));
    let froude = fastest.map(|speed| speed * speed / (GRAVITY * extent));
    match froude {
        Some(number) if number.is_finite() && number > FASTEST => {
            // Read in a unit of this many metres, the squared Froude number is multiplied by this number of metres.
            let off = |unit: &Unit| (number * unit.metres()).ln().abs();
            let units = [Unit::Mm, Unit::Cm];
            let unit = units.into_iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
            Some(format!(
                "{spans}, and moves at up to {}: too fast for gravity if the files are in metres (--unit {} fits)",
                crate::looks::round(fastest?),
                unit.name()
            ))
        }
        // The speed is plausible for this extent.
        Some(number) if number > 0.02 => None,
        // A single particle has no extent.
        _ if extent.is_finite() && extent > 0.0 && !(TINY..=LARGE).contains(&extent) => {
            Some(format!("{spans}: if the files are in another unit, set --unit mm, cm or km"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hints on the unit of a dam of 1.3 metres, in metres, millimetres and centimetres; of a lake, a cup, a jet, and
    /// water at rest.
    #[test]
    fn units_that_cannot_be_are_told() {
        assert_eq!(hint(1.3, Some(3.5)), None);
        assert!(hint(1347.0, Some(3535.0)).unwrap().contains("--unit mm fits"));
        assert!(hint(134.7, Some(353.5)).unwrap().contains("--unit cm fits"));
        assert_eq!(hint(1347.0, Some(111.0)), None, "a lake");
        assert_eq!(hint(0.027, Some(0.5)), None, "a cup");
        assert_eq!(hint(2.0, Some(20.0)), None, "a jet under pressure");
        assert!(hint(1347.0, None).unwrap().contains("1347 metres: if"));
        assert!(hint(1347.0, Some(0.001)).is_some(), "at rest");
        assert_eq!(hint(80.0, None), None);
        assert_eq!(hint(f32::NAN, None), None);
    }

    /// If frames have different offsets, their positions relative to each other are kept.
    #[test]
    fn frames_have_one_origin() {
        let placing = Placing { origin: [4096.0, 0.0, -64.0], ..Placing::default() };
        let mut all = [[4096.0, 0.0, -64.0], [4224.0, 0.0, 0.0], [0.0; 3]].map(|origin| {
            let mut particles = Particles::from_positions(vec![[1.5, 2.0, -3.0]]);
            particles.origin = origin;
            particles
        });
        all.iter_mut().for_each(|particles| placing.place(particles));
        let found = all.map(|particles| particles.positions[0]);
        assert_eq!(found, [[1.5, 2.0, -3.0], [129.5, 2.0, 61.0], [-4094.5, 2.0, 61.0]]);
    }

    /// If the particles are far from the origin, a camera position near them may be given in the files' coordinates
    /// or in those of the moved particles.
    #[test]
    fn a_point_far_out_is_moved_with_the_particles() {
        let far = Placing { up: Up::Z, scale: 0.5, origin: [4096.0, 1024.0, 64.0] };
        assert_eq!(far.moved([2050.0, 33.0, -512.0]), Some([2.0, 1.0, 0.0]));
        assert_eq!(far.moved([2.0, 1.0, 0.0]), None);
        assert_eq!(Placing::default().moved([9.0, 1.0, 0.0]), None);
    }

    /// Each up axis becomes y by a rotation, which can be inverted.
    #[test]
    fn every_axis_is_turned_to_y() {
        for axis in 0..3 {
            for against in [false, true] {
                let up = Up::along(axis, against);
                assert_eq!(up.axis(), axis);
                let mut points_up = [0.0_f32; 3];
                points_up[axis] = if against { -1.0 } else { 1.0 };
                assert_eq!(up.turn(points_up), [0.0, 1.0, 0.0], "{}", up.name());
                let [x, y, z] =
                    [Vec3::X, Vec3::Y, Vec3::Z].map(|v| Vec3::from(up.turn(v.to_array())));
                assert_eq!(x.cross(y).dot(z), 1.0, "{} mirrors", up.name());
                assert_eq!(
                    up.turn_back(up.turn([1.0, 2.0, 3.0])),
                    [1.0, 2.0, 3.0],
                    "{}",
                    up.name()
                );
            }
        }
    }

    #[test]
    fn units_in_names_are_told() {
        let of = |name: &str| {
            let mut particles = Particles::from_positions(vec![[0.0; 3]]);
            particles.meanings = vec![(Meaning::Position, vec![name.into(); 3])];
            particles
        };
        for (name, flag) in [
            (
                "x [mm]",
                "say mm, but they are read as metres; --unit mm converts them (the name is `x [mm]`",
            ),
            ("Pos.x (cm)", "--unit cm converts"),
            ("x [in]", "--scale 0.0254 converts"),
            ("x [\u{b5}m]", "--scale 1e-6 converts"),
        ] {
            let told = named_hint(&of(name)).unwrap();
            assert!(told.contains(flag), "{told}");
            assert_eq!(named_metres(&of(name)), None);
        }
        assert!(named_metres(&of("x [m]")).unwrap().starts_with("m, as"));
        for name in ["x [m]", "x", "x [furlong]"] {
            assert_eq!(named_hint(&of(name)), None, "{name}");
        }
    }

    /// Positions and velocities may be in different units, whichever is named and whatever the user says.
    #[test]
    fn velocities_keep_their_own_unit() {
        // Names, scale given by the user, and metres per second that a component of 3 becomes.
        for (position, velocity, scale, expected) in [
            ("x [mm]", "vx [m/s]", 0.001, Some(3.0)),
            ("x", "vx [m/s]", 0.001, Some(3.0)),
            ("x [mm]", "vx [mm/s]", 0.001, None),
            // Positions in millimetres are read as metres, and so are the velocities.
            ("x [mm]", "vx [mm/s]", 1.0, None),
            ("x [mm]", "vx [m/s]", 1.0, Some(3000.0)),
            ("x [m]", "vx [mm/s]", 1.0, Some(0.003)),
            ("x", "Vel.x (cm.s-1)", 1.0, Some(0.03)),
            ("x", "vx [km/h]", 1.0, Some(3.0 / 3.6)),
            ("x", "vx [m s^-1]", 1.0, None),
            ("x", "vx [m/s^2]", 0.001, None),
            ("x", "vx", 0.001, None),
        ] {
            let mut particles = Particles::from_positions(vec![[0.0; 3]]);
            particles.velocities = Some(vec![[3.0; 3]]);
            particles.meanings = vec![
                (Meaning::Position, vec![position.into(); 3]),
                (Meaning::Velocity, vec![velocity.into(); 3]),
            ];
            let told = agree(&mut particles, scale);
            Placing { scale, ..Placing::default() }.place(&mut particles);
            let found = particles.velocities.unwrap()[0][0];
            let expected_speed = expected.unwrap_or(3.0 * scale);
            assert!((found / expected_speed - 1.0).abs() < 1.0e-5, "{velocity}: {found}");
            assert_eq!(told.is_some(), expected.is_some(), "{velocity}: {told:?}");
        }
    }

    #[test]
    fn what_is_placed_comes_back() {
        let mut particles = Particles::from_positions(vec![[1000.0, 2000.0, 3000.0]]);
        particles.velocities = Some(vec![[10.0, 20.0, 30.0]]);
        let mut other = particles.clone();
        let placing = Placing { up: Up::Z, scale: 0.001, ..Placing::default() };
        placing.place(&mut other);
        let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1.0e-5);
        assert!(near(other.positions[0], [1.0, 3.0, -2.0]), "{:?}", other.positions);
        let mut velocities = other.velocities.unwrap();
        assert!(near(velocities[0], [0.01, 0.03, -0.02]), "{velocities:?}");
        placing.back(&mut other.positions, &mut velocities);
        assert!(near(other.positions[0].map(|c| 0.001 * c), [1.0, 2.0, 3.0]));
        assert!(near(velocities[0], [10.0, 20.0, 30.0]));
    }
}
