//! Radii of particles in files. The renderer draws all particles with one radius: if radii differ much, each large
//! particle is replaced by several small ones.

use std::f32::consts::PI;

use std::path::Path;

use glam::{DVec3, Quat, Vec3};
use whitewater::io::particles::{Particles, estimate_spacing, same_name};

use crate::extras::find;
use crate::failure::{Failure, Outcome};
use crate::fluids::reorder;
use crate::looks::round;
use crate::surface_foam::quantile;

/// Attribute names of radii.
pub const RADII: [&str; 4] = ["radius", "radii", "particle radius", "pscale"];
/// Attribute names of diameters: LAMMPS, and OpenFOAM's clouds.
pub const DIAMETERS: [&str; 3] = ["diameter", "diam", "d"];

/// A name of radii, and of distances from an axis or a point.
pub const UNSURE: &str = "r";
/// Values of an attribute called `r` are taken as radii if their median, in particle spacings, is in this range.
/// Particles that touch have a radius of 0.5; smoothing lengths and loose particles are near that, distances are not.
const FITTING: [f64; 2] = [0.2, 1.1];
/// If more than this share of the values equal the particles' distances from a point or an axis, within this relative
/// tolerance, the attribute holds distances.
const DISTANCES: (f64, f64) = (0.9, 1.0e-3);

/// Ratio of radii below which particles are drawn alike: twice the volume.
const ALIKE: f32 = 1.26;
/// Quantile of the radii that becomes the common radius. If splitting larger particles to it would multiply their
/// number by more than [`MOST`], the common radius is larger.
const BASE: f64 = 0.05;
const MOST: usize = 8;
/// A particle stands for the water in a cube whose edge is twice the particle's radius. A ball with the cube's volume
/// has this many times the particle's radius.
const BALL: f32 = 1.2407;

/// Whether an attribute is taken as radii.
pub fn is_radius(name: &str) -> bool {
    RADII.iter().chain(&DIAMETERS).any(|radius| same_name(radius, name))
}

/// Radii of the particles, in the unit of the file.
fn of(particles: &Particles) -> Option<Vec<f32>> {
    let radius = RADII.iter().find_map(|name| Some((find(particles, name)?, 1.0)));
    let diameter = || DIAMETERS.iter().find_map(|name| Some((find(particles, name)?, 0.5)));
    let (extra, of) = radius.or_else(diameter)?;
    Some(extra.values.iter().map(|r| (of * *r) as f32).collect())
}

fn is_size(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

/// Whether an attribute that is called only `r` holds radii (`Ok`), or why not (`Err`). `None` if there is no such
/// attribute, or if another one holds the radii.
pub fn unsure(particles: &Particles) -> Option<Result<(), String>> {
    let extra = find(particles, UNSURE)?;
    if of(particles).is_some() {
        return None;
    }
    let values = &extra.values;
    if !values.iter().all(|value| is_size(*value)) {
        return Some(Err("not all values are above 0".into()));
    }
    let origin = DVec3::from(particles.origin);
    for (mask, from) in [
        (DVec3::ONE, "the origin"),
        (DVec3::new(1.0, 1.0, 0.0), "the z axis"),
        (DVec3::new(1.0, 0.0, 1.0), "the y axis"),
        (DVec3::new(0.0, 1.0, 1.0), "the x axis"),
    ] {
        let (share, tolerance) = DISTANCES;
        let all = particles.positions.iter().zip(values);
        let same = all.filter(|(position, value)| {
            let away = (mask * (Vec3::from(**position).as_dvec3() + origin)).length();
            (away - **value).abs() <= tolerance * away
        });
        if same.count() as f64 > share * values.len() as f64 {
            return Some(Err(format!("it is the distance from {from}")));
        }
    }
    let mut sorted = values.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let middle = sorted.get(sorted.len() / 2).copied()?;
    let Some(spacing) = estimate_spacing(&particles.positions).map(f64::from) else {
        return Some(Err("there are too few particles to tell".into()));
    };
    let [least, most] = FITTING;
    Some(match (least * spacing..=most * spacing).contains(&middle) {
        true => Ok(()),
        false => {
            Err(format!("its median {middle:.3e} does not fit the particle spacing {spacing:.3e}"))
        }
    })
}

/// Warning about such an attribute that is not used.
pub fn unused(why: &str) -> String {
    format!(
        "attribute `{UNSURE}` is not taken as radii: {why}; --radius {UNSURE} takes it as radii"
    )
}

/// Takes an attribute as radii by its name. Names of diameters stay such.
pub fn take(particles: &mut Particles, name: &str, path: &Path) -> Outcome<()> {
    let bad = |found: String| {
        let path = path.display();
        Failure::input(format!(
            "--radius {name}: {path}: expected an attribute `{name}` of one positive number for each particle, found {found}"
        ))
    };
    let names =
        || particles.attributes.iter().map(|a| a.name.as_str()).take(24).collect::<Vec<_>>();
    let Some(extra) = find(particles, name) else { return Err(bad(names().join(", "))) };
    if !extra.values.is_empty() && !extra.values.iter().any(|value| is_size(*value)) {
        return Err(bad("none above 0".into()));
    }
    let diameter = DIAMETERS.iter().any(|diameter| same_name(diameter, name));
    let own = |other: &str| same_name(other, name);
    particles.extras.retain(|extra| own(&extra.name) || !is_radius(&extra.name));
    for extra in particles.extras.iter_mut().filter(|extra| own(&extra.name) && !diameter) {
        extra.name = RADII[0].into();
    }
    Ok(())
}

/// Min, median and max radius of the particles, in the unit of the file.
pub fn radii(particles: &Particles) -> Option<[f32; 3]> {
    let mut radii = of(particles)?;
    radii.retain(|radius| radius.is_finite() && *radius > 0.0);
    radii.sort_unstable_by(f32::total_cmp);
    Some([*radii.first()?, *radii.get(radii.len() / 2)?, *radii.last()?])
}

/// Radii of the files are doubted if their median, in particle spacings, is outside this range. Drops may lie far from
/// each other, and smoothing lengths are sometimes called radii.
const DOUBTED: [f32; 2] = [0.1, 2.0];

/// Warning about radii of the files that do not fit the particles' spacing. Both are in one unit.
pub fn misfit(radius: f32, spacing: f32) -> Option<String> {
    let [least, most] = DOUBTED.map(|share| share * spacing);
    let half = 0.5 * spacing;
    (!(least..=most).contains(&radius)).then(|| {
        format!(
            "the radii of the files do not fit the particles' spacing: their median is {radius:.4e}, and half of the \
             spacing is {half:.4e} (another unit? --radius {} sets the radius)",
            round(half)
        )
    })
}

/// How large particles are split, in all frames alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    /// The common radius, in the unit of the file.
    pub base: f32,
    /// Max number of particles that replace one.
    most: u32,
}

impl Split {
    /// From the particles of a frame; `None` if their radii are alike.
    pub fn of(particles: &Particles) -> Option<Self> {
        let mut radii = of(particles)?;
        radii.retain(|radius| radius.is_finite() && *radius > 0.0);
        let [low, high] = [BASE, 1.0 - BASE].map(|part| quantile(radii.clone(), part));
        let (mut base, high) = (low?, high?);
        if high <= ALIKE * base {
            return None;
        }
        let largest = radii.iter().copied().fold(high, f32::max);
        let count =
            |base: f32| radii.iter().map(|radius| copies(*radius, base) as usize).sum::<usize>();
        while count(base) > MOST * radii.len() {
            base *= 1.1;
        }
        // Particles that are larger in later frames are not split more finely.
        let most = copies(largest, base).max(2);
        Some(Self { base, most })
    }

    /// Splits the large particles of a frame, and numbers the ids anew, alike in all frames. Returns the number of
    /// particles before the split; `None` if none was split.
    pub fn apply(&self, particles: &mut Particles) -> Option<usize> {
        let count = particles.positions.len();
        // In a frame without radii none is large.
        let radii = of(particles).unwrap_or_else(|| vec![self.base; count]);
        let copies = |radius: &f32| copies(*radius, self.base).min(self.most);
        let order: Vec<usize> =
            radii.iter().enumerate().flat_map(|(i, r)| (0..copies(r)).map(move |_| i)).collect();
        let ids = particles.ids.take();
        let splits = order.len() > count;
        if splits {
            reorder(particles, &order);
        }
        let mut at = 0;
        let mut own = ids.as_ref().map(|_| Vec::with_capacity(order.len()));
        for (i, radius) in radii.iter().enumerate() {
            let n = copies(radius);
            let id = ids.as_ref().and_then(|ids| ids.get(i).copied());
            let turn = (n > 1).then(|| turn(id.unwrap_or(i as u32)));
            for k in 0..n {
                if let Some(turn) = turn
                    && let Some(position) = particles.positions.get_mut(at)
                {
                    let away = turn * (radius * BALL * even(k, n));
                    *position = (Vec3::from(*position) + away).to_array();
                }
                at += 1;
                // If the ids run out, the particle has none of its own.
                let id = id.and_then(|id| id.checked_mul(self.most)?.checked_add(k));
                own = own.zip(id).map(|(mut own, id)| {
                    own.push(id);
                    own
                });
            }
        }
        particles.ids = own;
        splits.then_some(count)
    }
}

/// Number of particles of the base radius with the volume of one particle.
fn copies(radius: f32, base: f32) -> u32 {
    let times = radius / base;
    if times.is_finite() && times > ALIKE {
        times.powi(3).round().clamp(1.0, 4096.0) as u32
    } else {
        1
    }
}

/// Point `k` of `count` points that fill the unit ball evenly. They spiral around the axis by the golden angle.
fn even(k: u32, count: u32) -> Vec3 {
    let part = (k as f32 + 0.5) / count as f32;
    // The height has an irrational step that is unrelated to the distance, so that each shell has all directions.
    let height = 1.0 - 2.0 * (0.5 + k as f32 * 0.754_877_7).fract();
    let around = k as f32 * PI * (3.0 - 5.0_f32.sqrt());
    let level = (1.0 - height * height).max(0.0).sqrt();
    // The factor moves each point towards the middle of the part of the ball that it stands for, so the copies do not
    // extend beyond the particle.
    part.cbrt() * 0.85 * Vec3::new(level * around.cos(), height, level * around.sin())
}

/// A random rotation for each particle, so that the copies form no pattern.
fn turn(id: u32) -> Quat {
    let hash = |salt: u32| {
        let mixed = (id ^ salt).wrapping_mul(0x9e37_79b9);
        (mixed ^ mixed >> 15).wrapping_mul(0x85eb_ca6b) as f32 / 2.0_f32.powi(32)
    };
    let axis = Vec3::new(hash(1) - 0.5, hash(2) - 0.5, hash(3) - 0.5).normalize_or(Vec3::Y);
    Quat::from_axis_angle(axis, 2.0 * PI * hash(4))
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitewater::io::particles::Extra;

    #[test]
    fn radii_in_another_unit_are_told() {
        for radius in [0.025, 0.05, 0.006, 0.09] {
            assert_eq!(misfit(radius, 0.05), None, "{radius}");
        }
        for radius in [25.0, 0.0025, 0.11] {
            let told = misfit(radius, 0.05).unwrap();
            assert!(told.contains("--radius 0.025 "), "{told}");
        }
    }

    fn particles(radii: &[f32]) -> Particles {
        let at = |i: usize| [i as f32, 0.0, 0.0];
        let mut particles = Particles::from_positions((0..radii.len()).map(at).collect());
        particles.ids = Some((0..radii.len() as u32).collect());
        let values = radii.iter().map(|r| f64::from(*r)).collect();
        particles.extras = vec![Extra { name: "Radius".into(), values }];
        particles
    }

    #[test]
    fn alike_particles_stay() {
        assert_eq!(Split::of(&Particles::from_positions(vec![[0.0; 3]])), None);
        let radii: Vec<f32> = (0..100).map(|i| 0.1 + 0.0002 * i as f32).collect();
        assert_eq!(Split::of(&particles(&radii)), None);
        assert_eq!(super::radii(&particles(&radii)).unwrap()[0], 0.1);
    }

    /// A block of 1000 particles, 0.1 apart, with values called `r`.
    fn called_r(value: impl Fn(Vec3) -> f32) -> Particles {
        let at = |i: usize| [i % 10, i / 10 % 10, i / 100].map(|c| 0.1 * c as f32 + 0.4);
        let positions: Vec<_> = (0..1000).map(at).collect();
        let values = positions.iter().map(|p| f64::from(value(Vec3::from(*p)))).collect();
        let mut particles = Particles::from_positions(positions);
        particles.extras = vec![Extra { name: "R [m]".into(), values }];
        particles
    }

    #[test]
    fn a_column_r_is_radii_or_it_is_told_why_not() {
        let told = |value: &dyn Fn(Vec3) -> f32| unsure(&called_r(value)).unwrap();
        assert_eq!(told(&|_| 0.05), Ok(()));
        assert_eq!(told(&|p| if p.x < 0.6 { 0.03 } else { 0.06 }), Ok(()));
        assert_eq!(told(&|_| 0.1), Ok(()), "a spacing");
        for (value, why) in [
            (&(|p: Vec3| p.length()) as &dyn Fn(Vec3) -> f32, "the distance from the origin"),
            (&|p| p.truncate().length(), "the distance from the z axis"),
            (&|p| Vec3::new(p.x, 0.0, p.z).length(), "the distance from the y axis"),
            (&|p| Vec3::new(0.0, p.y, p.z).length(), "the distance from the x axis"),
            (&|p| (p - 0.85).length(), "does not fit the particle spacing"),
            (&|_| 0.001, "does not fit the particle spacing"),
            (&|p| p.x - 0.4, "not all values are above 0"),
            (&|_| f32::NAN, "not all values are above 0"),
        ] {
            assert!(told(value).unwrap_err().contains(why), "{why}");
        }
        let mut few = called_r(|_| 0.05);
        few.positions.truncate(1);
        few.extras[0].values.truncate(1);
        assert!(unsure(&few).unwrap().unwrap_err().contains("too few"));
        // A name that says what it is comes first.
        let mut both = called_r(|_| 0.05);
        both.extras.push(Extra { name: "radius".into(), values: vec![0.04; 1000] });
        assert_eq!(unsure(&both), None);
        assert_eq!(unsure(&particles(&[0.1])), None);
    }

    #[test]
    fn an_attribute_is_named_as_radii() {
        let path = Path::new("a.csv");
        let mut particles = called_r(|p| p.x);
        particles.extras.push(Extra { name: "radius".into(), values: vec![0.04; 1000] });
        take(&mut particles, "r", path).unwrap();
        assert_eq!(super::radii(&particles).unwrap()[0], 0.4);
        let mut particles = called_r(|_| 0.05);
        particles.extras.push(Extra { name: "Diameter".into(), values: vec![0.08; 1000] });
        take(&mut particles, "diameter", path).unwrap();
        assert_eq!(super::radii(&particles).unwrap()[0], 0.04);
        let told = take(&mut called_r(|_| 0.05), "size", path).unwrap_err().message;
        assert!(told.contains("--radius size: a.csv: expected an attribute `size`"), "{told}");
        let told = take(&mut called_r(|_| 0.0), "r", path).unwrap_err().message;
        assert!(told.contains("found none above 0"), "{told}");
    }

    /// A particle of twice the common radius becomes eight that have its volume together. Their offsets are the same
    /// in every frame.
    #[test]
    fn large_particles_become_several() {
        let radii: Vec<f32> = (0..100).map(|i| if i % 10 == 9 { 0.2 } else { 0.1 }).collect();
        let mut all = particles(&radii);
        let split = Split::of(&all).unwrap();
        assert_eq!(split, Split { base: 0.1, most: 8 });
        assert_eq!(split.apply(&mut all), Some(100));
        assert_eq!(all.positions.len(), 90 + 10 * 8);
        let ids = all.ids.clone().unwrap();
        assert_eq!(ids[..10], [0, 8, 16, 24, 32, 40, 48, 56, 64, 72]);
        assert_eq!(ids[10..17], [73, 74, 75, 76, 77, 78, 79]);
        assert_eq!(all.positions[3], [3.0, 0.0, 0.0]);
        let mean = all.positions[9..17].iter().map(|p| Vec3::from(*p)).sum::<Vec3>() / 8.0;
        assert!(mean.distance(Vec3::new(9.0, 0.0, 0.0)) < 0.05, "{mean}");
        let mut again = particles(&radii);
        split.apply(&mut again);
        assert_eq!(again.positions, all.positions);
        // Ids are numbered alike in frames in which none is large, or which have no radii.
        for lacks in [false, true] {
            let mut small = particles(&[0.1; 100]);
            if lacks {
                small.extras.clear();
            }
            assert_eq!(split.apply(&mut small), None);
            assert_eq!(small.ids.unwrap()[..3], [0, 8, 16]);
            assert_eq!(small.positions.len(), 100);
        }
        // The number of particles grows by a factor of eight at most.
        let radii: Vec<f32> = (0..1000).map(|i| if i < 100 { 0.01 } else { 0.2 }).collect();
        let mut many = particles(&radii);
        let split = Split::of(&many).unwrap();
        split.apply(&mut many);
        assert!((2000..=8000).contains(&many.positions.len()), "{}", many.positions.len());
    }

    /// The points fill the ball evenly: an eighth of them lie within half its radius, and half of them on either side
    /// of a plane through its centre.
    #[test]
    fn copies_are_even() {
        let all: Vec<Vec3> = (0..512).map(|k| even(k, 512) / 0.85).collect();
        let share =
            |test: &dyn Fn(&Vec3) -> bool| all.iter().filter(|p| test(p)).count() as f32 / 512.0;
        assert!((share(&|p| p.length() < 0.5) - 0.125).abs() < 0.01);
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE.normalize()] {
            assert!((share(&|p| p.dot(axis) > 0.0) - 0.5).abs() < 0.03, "{axis}");
        }
    }
}
