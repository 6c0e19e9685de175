//! Additional attributes: those that separate walls from water.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::Path;

use glam::Vec3;
use whitewater::io::particles::sequence::Frame;
use whitewater::io::particles::{self, AttributeType, Extra, Particles, same_name};

use crate::arrays;
use crate::failure::{Failure, Outcome};
use crate::fluids::{self, Fluids};
use crate::radii::{DIAMETERS, RADII, UNSURE};

/// Names of attributes that distinguish several fluids (phases), or walls from water.
const PHASES: [&str; 50] = [
    "type",
    "mk",
    "phase",
    "phase id",
    "fluid",
    "fluid id",
    "material",
    "object id",
    "boundary",
    "is boundary",
    "marker",
    "ptype",
    "zone",
    "material id",
    "mat",
    "mat id",
    "species",
    "color",
    "colour",
    "group",
    "group id",
    "body",
    "body id",
    "itype",
    "atype",
    "kind",
    "nature",
    "class",
    "component",
    "is fluid",
    "is solid",
    "boundary type",
    "particle kind",
    "fluid type",
    "wall",
    "is wall",
    "walls",
    "solid",
    "fixed",
    "is fixed",
    "static",
    "is static",
    "obstacle",
    "tag",
    "flag",
    "region",
    "state",
    "obj",
    "matname",
    "material name",
];
/// Max number of values of an attribute that distinguishes phases.
const MOST: usize = 16;
/// Share of duplicate positions from which on duplicates are dropped.
const DOUBLED: f64 = 0.05;

/// A comparison of an attribute with a number, such as `Type=3`, that selects the particles to draw (`--where`) or
/// those of a fluid (`--fluid`).
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    name: String,
    compare: Compare,
    value: f64,
    text: String,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Compare {
    Is,
    IsNot,
    Less,
    More,
    AtMost,
    AtLeast,
}

/// Parses `NAME=VALUE` and other comparisons.
pub fn condition(text: &str) -> Result<Condition, String> {
    let bad =
        || "expected a comparison such as Type=3, mk!=0 or z<1.5 (= != < > <= >=)".to_string();
    let at = text.find(['=', '!', '<', '>']).ok_or_else(bad)?;
    let (name, rest) = text.split_at(at);
    let forms = [
        ("==", Compare::Is),
        ("!=", Compare::IsNot),
        ("<=", Compare::AtMost),
        (">=", Compare::AtLeast),
        ("=", Compare::Is),
        ("<", Compare::Less),
        (">", Compare::More),
    ];
    let found =
        forms.into_iter().find_map(|(form, compare)| Some((rest.strip_prefix(form)?, compare)));
    let (value, compare) = found.ok_or_else(bad)?;
    let value: f64 = value.trim().parse().map_err(|_| bad())?;
    if name.trim().is_empty() || !value.is_finite() {
        return Err(bad());
    }
    Ok(Condition { name: name.trim().into(), compare, value, text: text.into() })
}

impl Condition {
    /// Name of the compared attribute.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The values of the compared attribute, one per particle. If the attribute is missing, `what` names the
    /// command-line argument in the error.
    pub fn values<'p>(
        &self,
        particles: &'p Particles,
        what: &str,
        path: &Path,
    ) -> Outcome<&'p [f64]> {
        if let Some(extra) = find(particles, &self.name) {
            return Ok(&extra.values);
        }
        let names = particles.attributes.iter().map(|a| a.name.as_str());
        let names: Vec<_> = names.take(24).collect();
        Err(Failure::input(format!(
            "{what}: {}: expected an attribute `{}` of one number for each particle, found {}",
            path.display(),
            self.name,
            names.join(", ")
        )))
    }

    /// For each particle whether its value satisfies the comparison; errors as [`values`](Self::values).
    pub fn holds(&self, particles: &Particles, what: &str, path: &Path) -> Outcome<Vec<bool>> {
        let values = self.values(particles, what, path)?;
        // In 32 bits 0.1 is another number than in 64, and what is compared is what the user has written there.
        let single = particles.attributes.iter().any(|attribute| {
            let base = self.name.rsplit_once(':').map_or(self.name.as_str(), |(base, _)| base);
            let same = same_name(&attribute.name, &self.name)
                || attribute.components > 1 && same_name(&attribute.name, base);
            same && attribute.ty == AttributeType::F32
        });
        let limit = if single { f64::from(self.value as f32) } else { self.value };
        let holds = |value: &f64| match self.compare {
            Compare::Is => *value == limit,
            Compare::IsNot => *value != limit,
            Compare::Less => *value < limit,
            Compare::More => *value > limit,
            Compare::AtMost => *value <= limit,
            Compare::AtLeast => *value >= limit,
        };
        Ok(values.iter().map(holds).collect())
    }
}

/// Reads the particles of a frame with these additional attributes: those that the comparisons of `--where`
/// (`conditions`) and of `--fluid` (`fluids`) use, those whose names mean phases or radii, and the one named
/// `radius`.
pub fn read(
    frame: &Frame,
    conditions: &[Condition],
    fluids: &Fluids,
    radius: Option<&str>,
) -> Outcome<Particles> {
    let asked = conditions.iter().map(Condition::name).chain(fluids.names()).chain(radius);
    let radii = RADII.into_iter().chain(DIAMETERS).chain([UNSURE]);
    let names: Vec<&str> = PHASES.into_iter().chain(radii).chain(asked).collect();
    if let Some(step) = frame.step {
        let mut all = particles::read_step(&frame.path, step, &names)?;
        arrays::add(&mut all, &frame.path, Some(step));
        fluids.mark(&frame.path, &mut all);
        return Ok(all);
    }
    let read = |path: &Path| -> Outcome<Particles> {
        let mut part = particles::read_with(path, &names)?;
        arrays::add(&mut part, path, None);
        fluids.mark(path, &mut part);
        Ok(part)
    };
    // Velocity files beside position files are not particles of their own.
    let beside: Vec<_> = frame.paths().filter_map(arrays::velocities_beside).collect();
    let mut paths = frame.paths().filter(|path| !beside.iter().any(|other| other == path));
    let mut all = read(paths.next().unwrap_or(&frame.path))?;
    for path in paths {
        all.append(read(path)?);
    }
    Ok(all)
}

/// Keeps the particles for which all conditions hold. A condition is not applied to the files of a `--fluid` that lack
/// its attribute. If no particle is left, the result says why.
pub fn select(
    particles: &mut Particles,
    conditions: &[Condition],
    path: &Path,
) -> Outcome<Option<String>> {
    let count = particles.positions.len();
    let (mut kept, mut none) = (vec![true; count], None);
    for condition in conditions {
        let what = format!("--where '{}'", condition.text);
        let others = fluids::by_file(particles).is_some_and(|fluids| !fluids.contains(&0.0));
        if others && find(particles, &condition.name).is_none() {
            continue;
        }
        let values = condition.values(particles, &what, path)?;
        let lacks = lacking(particles, values);
        let holds = condition.holds(particles, &what, path)?;
        let each = kept.iter_mut().zip(holds).enumerate();
        each.for_each(|(i, (kept, holds))| *kept &= holds || lacks(i));
        if count > 0 && none.is_none() && !kept.contains(&true) {
            let found = whole(values).map_or(String::new(), |values| {
                format!(", whose values are {}", list(values.keys().map(|v| number(*v))))
            });
            none =
                Some(format!("{what}: expected some of the {count} particles, found none{found}"));
        }
    }
    if kept.contains(&false) {
        particles.retain(&kept);
    }
    Ok(none)
}

/// Tells by a particle's index whether it is from files that lack the attribute with these values, which are then NaN.
/// Without files of a `--fluid` none is.
fn lacking<'p>(particles: &'p Particles, values: &'p [f64]) -> impl Fn(usize) -> bool + 'p {
    let fluids = fluids::by_file(particles);
    let both = fluids.into_iter().flatten().zip(values);
    let have: HashSet<u64> =
        both.filter(|(_, value)| !value.is_nan()).map(|(fluid, _)| *fluid as u64).collect();
    move |i| fluids.is_some_and(|fluids| !have.contains(&(fluids[i] as u64)))
}

/// An attribute that was requested by name.
pub fn find<'a>(particles: &'a Particles, name: &str) -> Option<&'a Extra> {
    particles.extras.iter().find(|extra| same_name(&extra.name, name))
}

/// The different values as integers, and the number of particles with each; `None` if any value is not an integer, or
/// if there are more than [`MOST`] different ones.
fn whole(values: &[f64]) -> Option<BTreeMap<i64, usize>> {
    let mut counts = BTreeMap::new();
    for value in values {
        if value.fract() != 0.0 || value.abs() > 1.0e9 {
            return None;
        }
        *counts.entry(*value as i64).or_default() += 1;
        if counts.len() > MOST {
            return None;
        }
    }
    Some(counts)
}

fn number(value: i64) -> String {
    value.to_string()
}

/// A list in words, with commas and a conjunction before the last.
fn list(words: impl Iterator<Item = String>) -> String {
    let words: Vec<_> = words.collect();
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// Attributes with one of the names [`PHASES`] and at most [`MOST`] different values, all integers: their names, their
/// values, and the number of particles with each.
pub fn phases(particles: &Particles) -> Vec<(&str, BTreeMap<i64, usize>)> {
    let phase = |extra: &&Extra| PHASES.iter().any(|name| same_name(&extra.name, name));
    let all = particles.extras.iter().filter(phase);
    all.filter_map(|extra| Some((extra.name.as_str(), whole(&extra.values)?))).collect()
}

/// The values of a phase attribute whose particles are all at rest while others move: probably walls.
pub fn at_rest(particles: &Particles, name: &str) -> BTreeSet<i64> {
    let (Some(velocities), Some(extra)) = (&particles.velocities, find(particles, name)) else {
        return BTreeSet::new();
    };
    let both = velocities.iter().zip(&extra.values);
    let moving: BTreeSet<i64> =
        both.filter(|(v, _)| **v != [0.0; 3]).map(|(_, value)| *value as i64).collect();
    let resting = extra.values.iter().map(|value| *value as i64).filter(|v| !moving.contains(v));
    if moving.is_empty() { BTreeSet::new() } else { resting.collect() }
}

/// For each particle whether it has one of the values that [`at_rest`] finds: probably it is part of a wall.
pub fn walls(particles: &Particles) -> Vec<bool> {
    let mut walls = vec![false; particles.positions.len()];
    for (name, _) in phases(particles) {
        let resting = at_rest(particles, name);
        let values = find(particles, name).map_or(&[][..], |extra| &extra.values);
        let each = walls.iter_mut().zip(values);
        each.for_each(|(wall, value)| *wall |= resting.contains(&(*value as i64)));
    }
    walls
}

/// Messages about attributes that distinguish phases but are used by no `--where` and no `--fluid`, or hold words
/// instead of numbers, so that all phases are drawn as one water.
pub fn told(particles: &Particles, conditions: &[Condition], fluids: &Fluids) -> Vec<String> {
    let mut known = conditions.iter().map(Condition::name).chain(fluids.names());
    let mut asked = |name: &str| known.any(|known| same_name(known, name));
    let several = phases(particles).into_iter();
    let several = several.filter(|(name, values)| values.len() > 1 && !asked(name));
    let line = |(name, values): (&str, BTreeMap<i64, usize>)| {
        let each = values.iter().map(|(value, count)| format!("{value} ({count} particles)"));
        let liquid = liquid(particles, name, &values);
        format!(
            "attribute `{name}` has the values {}, all drawn as one water, walls and other phases included; \
             --where '{name}={liquid}' (or another value) draws one of them, and --fluid '{name}={liquid}:water' etc. give each \
             fluid its own look",
            list(each)
        )
    };
    let text = |extra: &&Extra| {
        let phase = PHASES.iter().any(|name| same_name(&extra.name, name));
        phase && !extra.values.is_empty() && extra.values.iter().all(|value| value.is_nan())
    };
    let text = particles.extras.iter().filter(text).map(|extra| {
        let name = &extra.name;
        format!(
            "attribute `{name}` holds words, which are not supported: all particles are drawn as one water (--where \
             compares numbers)"
        )
    });
    several.map(line).chain(text).collect()
}

/// The value of a phase attribute that probably means the liquid: that of the phase with the greatest mean squared
/// speed, or, without velocities, that of the phase with the most particles.
fn liquid(particles: &Particles, name: &str, values: &BTreeMap<i64, usize>) -> i64 {
    let speed = |value: i64| -> f32 {
        let (Some(velocities), Some(extra)) = (&particles.velocities, find(particles, name)) else {
            return 0.0;
        };
        let of = velocities.iter().zip(&extra.values).filter(|(_, v)| **v as i64 == value);
        let squares: Vec<f32> =
            of.map(|(v, _)| Vec3::from(*v).length_squared()).filter(|s| s.is_finite()).collect();
        squares.iter().sum::<f32>() / squares.len().max(1) as f32
    };
    let most = values.iter().map(|(value, count)| (speed(*value), *count, *value));
    let most = most.max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    most.map_or(0, |(_, _, value)| value)
}

/// If more than 5 % of the particles are at the position of an earlier one, drops these. Returns the number of
/// dropped particles.
pub fn without_copies(particles: &mut Particles) -> usize {
    let mut known = HashSet::with_capacity(particles.positions.len());
    // 0 and -0 are the same position.
    let place = |p: &[f32; 3]| p.map(|c| (c + 0.0).to_bits());
    let first = |p: &[f32; 3]| !p.iter().all(|c| c.is_finite()) || known.insert(place(p));
    let kept: Vec<bool> = particles.positions.iter().map(first).collect();
    let copies = kept.iter().filter(|kept| !**kept).count();
    if copies as f64 <= DOUBLED * kept.len() as f64 {
        return 0;
    }
    particles.retain(&kept);
    copies
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitewater::io::particles::Attribute;

    #[test]
    fn conditions_are_parsed() {
        let of = |text: &str| condition(text).map(|c| (c.name, c.compare, c.value));
        assert_eq!(of("Type=3"), Ok(("Type".into(), Compare::Is, 3.0)));
        assert_eq!(of("mk == 3"), Ok(("mk".into(), Compare::Is, 3.0)));
        assert_eq!(of("Points:2<=-1.5e0"), Ok(("Points:2".into(), Compare::AtMost, -1.5)));
        assert_eq!(of("h!=0"), Ok(("h".into(), Compare::IsNot, 0.0)));
        assert_eq!(of("h >= 1"), Ok(("h".into(), Compare::AtLeast, 1.0)));
        for bad in ["Type", "=3", "Type=", "Type=water", "Type=nan", "Type=>3", "Type!3", ""] {
            assert!(condition(bad).is_err(), "{bad}");
        }
    }

    fn walls() -> Particles {
        let mut particles =
            Particles::from_positions((0..10).map(|i| [i as f32, 0.0, 0.0]).collect());
        let speed = |i: usize| if i < 7 { [0.0; 3] } else { [1.0, 0.0, 0.0] };
        particles.velocities = Some((0..10).map(speed).collect());
        let values = (0..10).map(|i| if i < 7 { 0.0 } else { 3.0 }).collect();
        particles.extras = vec![Extra { name: "Type".into(), values }];
        particles
    }

    #[test]
    fn walls_are_told_and_left_out() {
        let particles = walls();
        let told_of = |conditions: &[Condition]| told(&particles, conditions, &Fluids::default());
        let [line] = &told_of(&[])[..] else { panic!("{:?}", told_of(&[])) };
        for part in ["`Type` has the values 0 (7 particles) and 3 (3 particles)", "'Type=3'"] {
            assert!(line.contains(part), "{line}");
        }
        let path = Path::new("a.csv");
        let select = |text: &str| {
            let mut particles = walls();
            let conditions: Vec<_> = text.split(' ').map(|text| condition(text).unwrap()).collect();
            assert!(told_of(&conditions).is_empty() || !text.contains("type"));
            let left = select(&mut particles, &conditions, path).map(|told| {
                assert_eq!(told.is_some(), particles.positions.is_empty());
                assert!(told.is_none_or(|told| told.contains("values are 0 and 3")));
            });
            left.map(|()| particles.positions.len())
        };
        assert_eq!(select("type=3").unwrap(), 3);
        assert_eq!(select("type!=3").unwrap(), 7);
        assert_eq!(select("type=9").unwrap(), 0);
        assert_eq!(select("type=9 type=3").unwrap(), 0);
        assert!(select("mk=1").unwrap_err().message.contains("attribute `mk`"));
    }

    /// A number is compared as the attribute stores it.
    #[test]
    fn numbers_of_32_bits_equal_decimals() {
        let count = |text: &str, ty: AttributeType| {
            let mut particles = walls();
            particles.extras[0].values = vec![f64::from(0.1_f32); 10];
            particles.attributes = vec![Attribute { name: "type".into(), components: 1, ty }];
            select(&mut particles, &[condition(text).unwrap()], Path::new("a.ply")).unwrap();
            particles.positions.len()
        };
        for (text, left) in [("type=0.1", 10), ("type<=0.1", 10), ("type>0.1", 0)] {
            assert_eq!(count(text, AttributeType::F32), left, "{text}");
        }
        assert_eq!(count("type=0.1", AttributeType::F64), 0);
    }

    /// The files of a fluid need not have the attribute that selects particles of the inputs.
    #[test]
    fn fluids_without_the_attribute_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(at("water_1.csv"), "x,y,z,Type\n0,0,0,1\n1,0,0,2\n").unwrap();
        std::fs::write(at("oil_1.csv"), "x,y,z\n0,1,0\n").unwrap();
        let arg = fluids::fluid(&format!("{}:honey", at("oil_*.csv"))).unwrap();
        let mut frames = crate::frames::expand(&[at("water_1.csv")], false).unwrap();
        let (fluids, _) = Fluids::find(&[arg], &mut frames).unwrap();
        let conditions = [condition("Type=1").unwrap()];
        let mut all = read(&frames[0], &conditions, &fluids, None).unwrap();
        assert_eq!(select(&mut all, &conditions, Path::new("water_1.csv")).unwrap(), None);
        assert_eq!(all.positions, [[0.0; 3], [0.0, 1.0, 0.0]]);
    }

    #[test]
    fn copies_are_left_out() {
        let mut particles =
            Particles::from_positions(vec![[0.0; 3], [1.0; 3], [0.0; 3], [-0.0; 3], [f32::NAN; 3]]);
        assert_eq!(without_copies(&mut particles), 2);
        assert_eq!(particles.positions.len(), 3);
        assert_eq!(without_copies(&mut particles), 0);
    }
}
