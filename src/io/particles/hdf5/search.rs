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
    let times = arrays
        .iter()
        .find(|array| names::is_time(&array.name) && array.dataset.ndim() == 1 && of(array));
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
}

impl Found {
    /// The dataset of the positions, which differs between groups unless one is a link to the other.
    fn address(&self) -> u64 {
        let mut arrays = self.frames.iter().flat_map(|(_, arrays)| arrays);
        let position =
            |array: &&Array| names::is_position(&array.name) || names::is_component(&array.name);
        arrays.find(position).map_or(u64::MAX, |array| array.dataset.address())
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
    let mut search = Search { file, limit, looked: 0, found: vec![], seen: vec![], links: vec![] };
    search.group(root, ("", 0), None)?;
    let Search { mut found, seen, links, .. } = search;
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
    let mut told = Vec::new();
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
    for Found { path, frames: own } in found {
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
        let arrays: Vec<Array> = datasets
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
        let names: Vec<&str> = arrays.iter().map(|array| array.name.as_str()).collect();
        if names::may_have_positions(&names) {
            let frames = stacked(&arrays, self.limit)?.unwrap_or_else(|| vec![(time, arrays)]);
            self.found.push(Found { path: path.into(), frames });
        }
        // H5MD: one group per property, with its values in one dataset.
        let value = |group: &Group| {
            let dataset = group.dataset("value").ok()?;
            let frames = dataset.shape().first().copied().filter(|_| dataset.ndim() >= 2)?;
            Some((leaf(group.name()), dataset, frames))
        };
        let position = groups.iter().find(|group| leaf(group.name()) == "position");
        if let Some((_, _, frames)) = position.and_then(value).filter(|(_, d, _)| d.ndim() == 3) {
            let all: Vec<_> = groups.iter().filter_map(value).collect();
            let times = position.and_then(|position| {
                let dataset = position.dataset("time").ok()?;
                numbers(&dataset, type_of(&dataset), &Rows::All, self.limit).ok()
            });
            let frames = (0..frames.min(GROUPS as u64)).map(|frame| {
                let own = all.iter().filter(|(_, _, count)| *count > frame);
                let arrays = own.map(|(name, dataset, _)| {
                    Array::new(name, dataset.clone(), Rows::Frame(frame)).with_unit()
                });
                (times.as_ref().and_then(|times| times.f64(frame as usize)), arrays.collect())
            });
            self.found.push(Found { path: path.into(), frames: frames.collect() });
            return Ok(());
        }
        for inner in &groups {
            let path = format!("{path}/{}", leaf(inner.name()));
            self.group(inner, (&path, depth + 1), time)?;
        }
        Ok(())
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
