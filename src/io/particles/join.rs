//! Joins particles of several files that are one frame.

use std::collections::HashSet;

use super::columns::Extra;
use super::{Meaning, Particles};

/// Appends the particles of another file.
pub(super) fn append(to: &mut Particles, mut other: Particles) {
    let (first, second) = (to.positions.len(), other.positions.len());
    // A process without particles writes a file without any, which does not say which attributes particles
    // have.
    if second == 0 || first == 0 {
        let mut warnings = std::mem::take(&mut to.warnings);
        if first == 0 {
            std::mem::swap(to, &mut other);
        }
        warnings.append(&mut to.warnings);
        to.warnings = warnings;
        return;
    }
    other.move_to(to.origin);
    let mut missing = Vec::new();
    both(&mut to.velocities, other.velocities, Meaning::Velocity, &mut missing);
    both(&mut to.densities, other.densities, Meaning::Density, &mut missing);
    both(&mut to.lifetimes, other.lifetimes, Meaning::Lifetime, &mut missing);
    both(&mut to.kinds, other.kinds, Meaning::Kind, &mut missing);
    let had_ids = to.ids.is_some();
    both(&mut to.ids, other.ids, Meaning::Id, &mut missing);
    let repeats = to.ids.as_ref().is_some_and(|ids| {
        let own: HashSet<u32> = ids.iter().take(first).copied().collect();
        ids.iter().skip(first).any(|id| own.contains(id))
    });
    if had_ids && repeats {
        to.ids = None;
        to.warnings.push(
            "ids are dropped: different particles of the joined files have the same ids".into(),
        );
    }
    for meaning in missing {
        to.warnings.push(format!("{meaning} is dropped: not all of the joined files have it"));
    }
    let fill = |count: usize| vec![f64::NAN; count];
    for extra in &mut to.extras {
        let more = other.extras.iter().position(|other| other.name == extra.name);
        let more = more.map(|i| other.extras.swap_remove(i).values);
        extra.values.extend(more.unwrap_or_else(|| fill(second)));
    }
    for Extra { name, values } in other.extras {
        let mut all = fill(first);
        all.extend(values);
        to.extras.push(Extra { name, values: all });
    }
    to.positions.append(&mut other.positions);
    for attribute in other.attributes {
        if !to.attributes.iter().any(|known| known.name == attribute.name) {
            to.attributes.push(attribute);
        }
    }
    for warning in other.warnings {
        if !to.warnings.contains(&warning) {
            to.warnings.push(warning);
        }
    }
}

/// Appends one attribute of the other file to that of the first. If only one of the two files has the
/// attribute, it is dropped, and named in `missing`.
fn both<T>(
    to: &mut Option<Vec<T>>,
    other: Option<Vec<T>>,
    what: Meaning,
    missing: &mut Vec<Meaning>,
) {
    match (&mut *to, other) {
        (Some(list), Some(mut more)) => list.append(&mut more),
        (None, None) => {}
        _ => {
            *to = None;
            missing.push(what);
        }
    }
}
