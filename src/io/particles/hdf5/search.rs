//! Finds the particles of a file that is not VTKHDF: by its arrays, and by the names and times of its groups.

use std::collections::{BTreeMap, HashMap};

use hdf5_reader::group::Group;
use hdf5_reader::{Datatype, Hdf5File};

use super::groups::{self, Order};
use super::{
    Array, DEEP, Frame, GROUPS, Part, ReadError, Rows, failed, leaf, links, listed, number,
    numbers, type_of,
};
use crate::io::particles::names;

/// Frames of positions with an additional dimension, and their times.
fn stacked(arrays: &[Array], limit: usize) -> Result<Option<Frames>, ReadError> {
    let names: Vec<&str> = arrays.iter().map(|array| array.name.as_str()).collect();
    let apart = names::have_positions(&names);
    let count = arrays.iter().find_map(|array| match array.dataset.shape() {
        [count, _, 2 | 3] if names::is_position(&array.name) => Some(*count),
        [count, particles] if apart && names::is_component(&array.name) && *particles > 3 => {
            Some(*count)
        }
        _ => None,
    });
    let Some(count) = count else { return Ok(None) };
    let of = |array: &Array| array.dataset.shape().first() == Some(&count);
    // A time in seconds is preferred to a step number.
    let times = arrays
        .iter()
        .filter(|array| array.dataset.ndim() == 1 && of(array))
        .filter_map(|array| Some((names::time_rank(&array.name)?, array)))
        .min_by_key(|(rank, _)| *rank)
        .map(|(_, array)| array);
    let times =
        times.map(|array| numbers(&array.dataset, type_of(&array.dataset), &Rows::All, limit));
    let times = times.transpose()?;
    let frames = (0..count.min(GROUPS as u64)).map(|frame| {
        let own = arrays.iter().filter(|array| !names::is_time(&array.name)).map(|array| {
            let rows = if of(array) { Rows::Frame(frame) } else { Rows::All };
            Array::new(&array.name, array.dataset.clone(), rows)
        });
        (times.as_ref().and_then(|times| times.f64(frame as usize)), own.collect())
    });
    Ok(Some(frames.collect()))
}

/// The time of each frame, and its attributes.
type Frames = Vec<(Option<f64>, Vec<Array>)>;

/// A group with positions.
struct Found {
    path: String,
    frames: Frames,
    /// Whether the group has nothing but x, y and z, which may be those of a vector of the group around it.
    bare: bool,
}

impl Found {
    /// The dataset of the positions, which differs between groups unless one is a link to the other.
    fn address(&self) -> u64 {
        let mut arrays = self.frames.iter().flat_map(|(_, arrays)| arrays);
        let position =
            |array: &&Array| names::is_position(&array.name) || names::is_component(&array.name);
        arrays.find(position).map_or(u64::MAX, |array| array.dataset.address())
    }

    /// Number of values of the first array, in all frames together.
    fn values(&self) -> Option<u64> {
        let mut arrays = self.frames.iter().flat_map(|(_, arrays)| arrays);
        arrays.next().map(|array| product(array.dataset.shape()))
    }

    /// The time, unless there are several.
    fn time(&self) -> Option<f64> {
        match self.frames.as_slice() {
            [(time, _)] => *time,
            _ => None,
        }
    }
}

/// The frames of a file that is not VTKHDF, found by its arrays and by the names of its groups.
pub(super) fn frames(file: &Hdf5File, root: &Group, limit: usize) -> Result<Vec<Frame>, ReadError> {
    let mut search =
        Search { file, limit, looked: 0, found: vec![], seen: vec![], links: vec![], told: vec![] };
    search.group(root, ("", 0), None)?;
    let Search { mut found, seen, links, mut told, .. } = search;
    if found.is_empty() && !links.is_empty() {
        let links = listed(links.iter().map(String::as_str));
        return Err(ReadError::Unsupported {
            what: format!("an HDF5 file that has no positions but links to other files ({links})"),
            advice: "give the file that a link leads to, or copy its data into this one",
        });
    }
    if found.is_empty() {
        let names: Vec<_> = seen.into_iter().take(24).collect();
        let found = if names.is_empty() { "no arrays at all".into() } else { names.join(", ") };
        return Err(ReadError::NoPositions { expected: names::POSITION_NAMES, found });
    }
    if !links.is_empty() {
        let links = listed(links.iter().map(String::as_str));
        told.push(format!("links to other files are not followed: {links}"));
    }
    // Several links may lead to the same positions. The group with the most arrays is read; of equal ones, one with a
    // number in its path.
    let worth = |found: &Found| {
        let arrays = found.frames.first().map_or(0, |(_, arrays)| arrays.len());
        (arrays, found.path.contains(|c: char| c.is_ascii_digit()))
    };
    let mut best = HashMap::new();
    for found in &found {
        let best = best.entry(found.address()).or_insert((worth(found), found.path.clone()));
        if worth(found) > best.0 {
            *best = (worth(found), found.path.clone());
        }
    }
    found.retain(|found| best.get(&found.address()).is_some_and(|(_, path)| *path == found.path));
    // Groups with other names beside the fluid hold walls. Gadget calls gas `PartType0`.
    let gas = |found: &Found| found.path.to_lowercase().split('/').any(|name| name == "parttype0");
    let fluid = |found: &Found| {
        let path = found.path.to_lowercase();
        ["fluid", "water", "liquid"].iter().any(|name| path.contains(name))
    };
    let mut keep = |kept: &dyn Fn(&Found) -> bool| {
        if !found.iter().any(kept) {
            return;
        }
        let (fluids, passed): (Vec<_>, Vec<_>) = found.drain(..).partition(kept);
        if !passed.is_empty() {
            let passed = listed(passed.iter().map(|found| found.path.as_str()));
            told.push(format!("groups that are not fluid are not read: {passed}"));
        }
        found = fluids;
    };
    keep(&gas);
    keep(&fluid);
    let groups: Vec<_> = found.iter().map(|found| (found.path.as_str(), found.time())).collect();
    let mut frames = match groups::order(&groups) {
        Order::Unsure if found.iter().all(|found| found.frames.len() < 2) => {
            let groups = listed(groups.iter().map(|(path, _)| *path));
            return Err(ReadError::Unsupported {
                what: format!(
                    "an HDF5 file of several groups whose names do not say what they are ({groups})"
                ),
                advice: "rename them, in h5py with h.move('OLD', 'NEW'): `water` is read alone, `step_1` and \
                         `step_2` are frames, `rank_1` and `rank_2` are pieces of one frame",
            });
        }
        Order::Frames(of) => {
            let (mut all, mut beside) = (BTreeMap::<usize, Vec<Found>>::new(), Vec::new());
            for (found, frame) in found.into_iter().zip(of) {
                match frame {
                    Some(frame) => all.entry(frame).or_default().push(found),
                    None => beside.push(found.path),
                }
            }
            if !beside.is_empty() {
                let beside = listed(beside.iter().map(String::as_str));
                told.push(format!("groups beside the frames are not read: {beside}"));
            }
            all.into_values().flat_map(merged).collect()
        }
        Order::Together | Order::Unsure => merged(found),
    };
    let parts = frames.iter_mut().filter_map(|frame| frame.parts.first_mut());
    parts.for_each(|part| part.warnings.extend(told.clone()));
    Ok(frames)
}

/// Joins groups frame by frame.
fn merged(found: Vec<Found>) -> Vec<Frame> {
    let paths: Vec<_> = found.iter().map(|found| found.path.as_str()).collect();
    let pieces = groups::are_pieces(&paths);
    let mut frames: Vec<Frame> = Vec::new();
    for Found { path, frames: own, .. } in found {
        for (i, (time, arrays)) in own.into_iter().enumerate() {
            if frames.len() <= i {
                frames.push(Frame { time, parts: Vec::new(), pieces });
            }
            if let Some(frame) = frames.get_mut(i) {
                frame.parts.push(Part { name: path.clone(), arrays, warnings: Vec::new() });
            }
        }
    }
    frames
}

fn product(shape: &[u64]) -> u64 {
    shape.iter().fold(1, |all, n| all.saturating_mul(*n))
}

/// Whether these are the components of a vector, of two or three dimensions.
fn are_components(arrays: &[Array]) -> bool {
    let shape = arrays.first().map(|array| array.dataset.shape());
    let component = |array: &Array| {
        let plain = names::plain(&array.name);
        ["x", "y", "z"].contains(&plain.as_str()) && Some(array.dataset.shape()) == shape
    };
    matches!(arrays.len(), 2 | 3) && arrays.iter().all(component)
}

/// A search for positions.
struct Search<'a> {
    file: &'a Hdf5File,
    limit: usize,
    /// Number of groups that were searched.
    looked: usize,
    found: Vec<Found>,
    /// Arrays, for messages.
    seen: Vec<String>,
    /// Links to other files, for messages.
    links: Vec<String>,
    /// Warnings.
    told: Vec<String>,
}

impl Search<'_> {
    /// Searches this group and those below it. `time` is that of the groups around it.
    fn group(
        &mut self,
        group: &Group,
        (path, depth): (&str, usize),
        time: Option<f64>,
    ) -> Result<(), ReadError> {
        self.looked += 1;
        if self.looked > GROUPS || depth > DEEP {
            return Ok(());
        }
        let (groups, datasets) = group.members().map_err(failed)?;
        self.links.extend(links::external(self.file, group, path).map_err(failed)?);
        let mut arrays: Vec<Array> = datasets
            .into_iter()
            .map(|dataset| Array::new(&leaf(dataset.name()), dataset, Rows::All).with_unit())
            .collect();
        let time = number(group, &["TimeValue", "time", "Time", "t"])
            .or_else(|| self.time(&arrays))
            .or(time);
        self.seen.extend(arrays.iter().map(|array| match array.dataset.dtype() {
            Datatype::Compound { .. } => format!(
                "{path}/{} (a table: save each of its columns as a dataset, h[name] = table[name] in h5py)",
                array.name
            ),
            _ => format!("{path}/{}", array.name),
        }));
        let bare = groups.is_empty() && are_components(&arrays);
        let first = self.found.len();
        if let Some(frames) = self.h5md(&groups) {
            self.found.push(Found { path: path.into(), frames, bare: false });
        } else {
            for inner in &groups {
                let path = format!("{path}/{}", leaf(inner.name()));
                self.group(inner, (&path, depth + 1), time)?;
            }
            self.take_vectors(path, first, &mut arrays);
        }
        let names: Vec<&str> = arrays.iter().map(|array| array.name.as_str()).collect();
        if names::may_have_positions(&names) {
            let frames = stacked(&arrays, self.limit)?.unwrap_or_else(|| vec![(time, arrays)]);
            self.found.insert(first, Found { path: path.into(), frames, bare });
        }
        Ok(())
    }

    /// H5MD: one group per property, with its values in one dataset.
    fn h5md(&self, groups: &[Group]) -> Option<Frames> {
        let value = |group: &Group| {
            let dataset = group.dataset("value").ok()?;
            let frames = dataset.shape().first().copied().filter(|_| dataset.ndim() >= 2)?;
            Some((leaf(group.name()), dataset, frames))
        };
        let position = groups.iter().find(|group| leaf(group.name()) == "position")?;
        let (_, _, frames) = value(position).filter(|(_, dataset, _)| dataset.ndim() == 3)?;
        let all: Vec<_> = groups.iter().filter_map(value).collect();
        let times = position
            .dataset("time")
            .ok()
            .and_then(|dataset| numbers(&dataset, type_of(&dataset), &Rows::All, self.limit).ok());
        let frames = (0..frames.min(GROUPS as u64)).map(|frame| {
            let own = all.iter().filter(|(_, _, count)| *count > frame);
            let arrays = own.map(|(name, dataset, _)| {
                Array::new(name, dataset.clone(), Rows::Frame(frame)).with_unit()
            });
            (times.as_ref().and_then(|times| times.f64(frame as usize)), arrays.collect())
        });
        Some(frames.collect())
    }

    /// Adds vectors to the arrays of a group, if each is a group of its components. Such groups are vectors if one of
    /// them has the name of positions, or, if the group itself has positions, the name of velocities; otherwise they
    /// may be particles of several kinds. `first` is the index of the first group that was found inside this one.
    fn take_vectors(&mut self, path: &str, first: usize, arrays: &mut Vec<Array>) {
        let inside = self.found.get(first..).unwrap_or_default();
        let bare = |found: &Found| {
            let around = found.path.rsplit_once('/').map(|(around, _)| around);
            found.bare && around == Some(path)
        };
        let is_position = |found: &&Found| bare(found) && names::is_position(&leaf(&found.path));
        let names: Vec<&str> = arrays.iter().map(|array| array.name.as_str()).collect();
        let vector = |array: &Array| {
            array.dataset.ndim() > 1 && matches!(array.dataset.shape().last(), Some(2 | 3))
        };
        let whole =
            |array: &&Array| names::is_position(&array.name) && (vector(array) || array.turned());
        let own = match arrays.iter().find(whole) {
            None if names::have_positions(&names) => {
                arrays.iter().find(|array| names::is_component(&array.name))
            }
            whole => whole,
        };
        // Number of values of a component, in all frames together.
        let values = match (own, inside.iter().find(is_position)) {
            (Some(own), _) if own.turned() => Some(own.shape().0),
            (Some(own), _) if vector(own) => {
                own.dataset.shape().split_last().map(|(_, shape)| product(shape))
            }
            (Some(own), _) => Some(product(own.dataset.shape())),
            (None, Some(position)) => position.values(),
            (None, None) => return,
        };
        let has_own = own.is_some();
        let velocity = |name: &str| names::is_vector(name) && !names::is_position(name);
        let mut passed = Vec::new();
        let mut at = first;
        while let Some(found) = self.found.get(at) {
            let name = leaf(&found.path);
            if !bare(found) || (has_own && !velocity(&name)) {
                at += 1;
                continue;
            }
            let found = self.found.remove(at);
            if found.values() != values {
                passed.push(found.path);
                continue;
            }
            if names::plain(&name) == "positionoffset" {
                let told = format!("`{}` is not added to the positions", found.path);
                self.told.push(told);
            }
            let components = found.frames.into_iter().take(1).flat_map(|(_, arrays)| arrays);
            arrays.extend(components.map(|array| {
                let name = format!("{name}_{}", array.name);
                Array::new(&name, array.dataset, Rows::All)
            }));
        }
        if !passed.is_empty() {
            let passed = listed(passed.iter().map(String::as_str));
            self.told.push(format!(
                "not read, because their number of values is not that of the positions beside them: {passed}"
            ));
        }
    }

    /// The time in a dataset of one value.
    fn time(&self, arrays: &[Array]) -> Option<f64> {
        let time = arrays.iter().find(|array| {
            let one = array.dataset.shape().iter().all(|n| *n == 1);
            one && ["time", "times", "timevalue", "t"].contains(&names::plain(&array.name).as_str())
        })?;
        numbers(&time.dataset, type_of(&time.dataset), &Rows::All, self.limit).ok()?.f64(0)
    }
}
