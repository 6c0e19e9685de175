//! VTKHDF: the group `VTKHDF` holds the points and their data; parts and steps are stored in sequence, and the group
//! `Steps` says where a step begins.

use std::ops::Range;

use hdf5_reader::Dataset;
use hdf5_reader::group::Group;

use super::{Array, Frame, GROUPS, Part, ReadError, Rows, failed, leaf, list, numbers, type_of};
use crate::io::particles::error::Place;
use crate::io::particles::vtk_xml::{is_point, mesh_warning};
use crate::io::particles::{cells, names};

/// The frames of a VTKHDF file.
pub(super) fn frames(grid: &Group, limit: usize) -> Result<Vec<Frame>, ReadError> {
    let kind = |group: &Group| {
        let attribute = group.attribute("Type").ok();
        attribute.and_then(|a| a.read_string().ok()).unwrap_or_default()
    };
    let own = kind(grid);
    let own = own.trim_end_matches('\0');
    let blocks: Vec<Group> = match own {
        "PolyData" | "UnstructuredGrid" => vec![grid.clone()],
        "MultiBlockDataSet" | "PartitionedDataSetCollection" => {
            let groups = grid.groups().map_err(failed)?;
            groups.into_iter().filter(|group| group.dataset("Points").is_ok()).collect()
        }
        _ => {
            return Err(ReadError::Unsupported {
                what: format!("VTKHDF of type {own}"),
                advice: "particles are PolyData or UnstructuredGrid: save one of these",
            });
        }
    };
    let mut frames: Vec<Frame> = Vec::new();
    for block in &blocks {
        let steps = block.group("Steps").or_else(|_| grid.group("Steps")).ok();
        let counts = list(block, "NumberOfPoints", limit)?;
        let steps = steps.as_ref().map(|steps| Steps::of(steps, block, limit)).transpose()?;
        let (on_cells, told) = of_cells(block, &counts, limit)?;
        let total = steps.as_ref().map_or(1, |steps| steps.values.len()).max(1);
        if total > GROUPS {
            return Err(ReadError::malformed("some steps", total.to_string(), Place::Unknown));
        }
        for step in 0..total {
            let (first, parts) = match &steps {
                Some(steps) => steps.at(step),
                None => (0, 0..counts.len() as u64),
            };
            let some = parts.start as usize..parts.end as usize;
            let points = counts.get(some).unwrap_or_default();
            let points = points.iter().fold(0_u64, |sum, n| sum.saturating_add(*n));
            let rows = |first: u64| Rows::Some(first..first.saturating_add(points));
            let dataset = block.dataset("Points").map_err(failed)?;
            let mut arrays = vec![Array::new("Points", dataset, rows(first))];
            let data = block.group("PointData").ok().map(|data| data.datasets());
            for dataset in data.transpose().map_err(failed)?.unwrap_or_default() {
                let name = leaf(dataset.name());
                let offsets = steps.as_ref().and_then(|steps| steps.offset(&name, step));
                arrays.push(Array::new(&name, dataset, rows(offsets.unwrap_or(first))));
            }
            for (name, dataset) in &on_cells {
                let offset = steps.as_ref().and_then(|steps| steps.offset_of_cells(name, step));
                let name = cells::column_name(name);
                arrays.push(Array::new(&name, dataset.clone(), rows(offset.unwrap_or(first))));
            }
            let part = Part {
                name: leaf(block.name()),
                arrays,
                warnings: mesh(block, limit).into_iter().chain(told.clone()).collect(),
            };
            if frames.len() <= step {
                let time = steps.as_ref().and_then(|steps| steps.values.get(step).copied());
                frames.push(Frame { time, parts: Vec::new(), pieces: false });
            }
            if let Some(frame) = frames.get_mut(step) {
                frame.parts.push(part);
            }
        }
    }
    if frames.is_empty() {
        return Err(ReadError::malformed("blocks of points", "none", Place::Unknown));
    }
    Ok(frames)
}

/// A dataset and its name.
type NamedSet = (String, Dataset);

/// The attributes of the cells of a VTKHDF block, if each cell is the point of the same index, and warnings about
/// cell attributes that are not used. `points` has the number of points of each part.
fn of_cells(
    block: &Group,
    points: &[u64],
    limit: usize,
) -> Result<(Vec<NamedSet>, Vec<String>), ReadError> {
    let datasets = |name: &str| {
        let data = block.group(name).ok().map(|data| data.datasets());
        let all = data.transpose().map_err(failed)?.unwrap_or_default();
        Ok::<Vec<_>, ReadError>(all.into_iter().map(|set| (leaf(set.name()), set)).collect())
    };
    let some = |(_, set): &NamedSet| set.shape().first().is_some_and(|rows| *rows > 0);
    let of_points = datasets("PointData")?;
    let plain: Vec<String> = of_points.iter().map(|(name, _)| names::plain(name)).collect();
    let (double, found): (Vec<NamedSet>, Vec<NamedSet>) = datasets("CellData")?
        .into_iter()
        .filter(some)
        .partition(|(name, _)| plain.contains(&names::plain(name)));
    let double = double.into_iter().map(|(name, _)| name);
    let double: Vec<String> = double.filter(|name| !names::is_ghost(name)).collect();
    let mut told: Vec<String> = cells::unused(&double, cells::DOUBLED).into_iter().collect();
    if let (false, Some(why)) = (found.is_empty(), no_vertices(block, points, limit)) {
        let names: Vec<String> = found.into_iter().map(|(name, _)| name).collect();
        told.extend(cells::unused(&names, &cells::no_particles(&why)));
        return Ok((Vec::new(), told));
    }
    Ok((found, told))
}

/// Why the cells of a VTKHDF block are not its points in the same order; `None` if each cell is one point.
fn no_vertices(block: &Group, points: &[u64], limit: usize) -> Option<String> {
    let vertices = block.group("Vertices").ok();
    let group = vertices.as_ref().unwrap_or(block);
    let all = |group: &Group, name: &str| {
        list(group, name, limit).map_err(|error| format!("`{name}` cannot be read ({error})"))
    };
    let sum = |list: &[u64]| list.iter().fold(0_u64, |sum, n| sum.saturating_add(*n));
    let others = ["Lines", "Polygons", "Strips"].into_iter().filter_map(|name| {
        let group = block.group(name).ok()?;
        Some(sum(&list(&group, "NumberOfCells", limit).ok()?))
    });
    let others = others.fold(0, u64::saturating_add);
    if others > 0 {
        return Some(format!("{others} of the cells are lines or faces"));
    }
    let lists = ["NumberOfCells", "Offsets", "Connectivity"].map(|name| all(group, name));
    let [Ok(counts), Ok(offsets), Ok(connectivity)] = lists else {
        return lists.into_iter().find_map(Result::err);
    };
    if counts != points {
        let (cells, points) = (sum(&counts), sum(points));
        return Some(format!("there are {cells} cells for {points} points"));
    }
    // Steps may share their cells.
    let counted = |from: &mut std::slice::Iter<'_, u64>, count: u64| {
        (0..count).all(|i| from.next() == Some(&i))
    };
    let (mut offsets, mut connectivity) = (offsets.iter(), connectivity.iter());
    let in_order = points.iter().all(|n| {
        (offsets.len() == 0 || counted(&mut offsets, n.saturating_add(1)))
            && (connectivity.len() == 0 || counted(&mut connectivity, *n))
    });
    let read = offsets.len() == 0 && connectivity.len() == 0;
    (!in_order || !read).then(|| "the cells are not the points in their order".to_string())
}

/// Where the particles of each step begin.
struct Steps {
    values: Vec<f64>,
    points: Vec<u64>,
    parts: Vec<u64>,
    counts: Vec<u64>,
    /// Names of the arrays that have an offset of their own for each step, with these offsets: arrays of points, and
    /// arrays of cells.
    arrays: [Vec<(String, Vec<u64>)>; 2],
}

impl Steps {
    fn of(steps: &Group, block: &Group, limit: usize) -> Result<Self, ReadError> {
        let dataset = steps.dataset("Values").map_err(failed)?;
        let data = numbers(&dataset, type_of(&dataset), &Rows::All, limit)?;
        let values: Vec<f64> = (0..data.len()).filter_map(|i| data.f64(i)).collect();
        // In a collection each block has its own steps.
        let own = block.group("Steps").unwrap_or_else(|_| steps.clone());
        let mut arrays = [const { Vec::new() }; 2];
        for (to, name) in arrays.iter_mut().zip(["PointDataOffsets", "CellDataOffsets"]) {
            let Ok(group) = own.group(name) else { continue };
            for dataset in group.datasets().map_err(failed)? {
                let name = leaf(dataset.name());
                let offsets = list(&group, &name, limit)?;
                to.push((name, offsets));
            }
        }
        let points = list(&own, "PointOffsets", limit)?;
        let or = |name: &str, each: u64| match own.dataset(name) {
            Ok(_) => list(&own, name, limit),
            Err(_) => Ok(vec![each; values.len()]),
        };
        let (parts, counts) = (or("PartOffsets", 0)?, or("NumberOfParts", 1)?);
        Ok(Self { values, points, parts, counts, arrays })
    }

    /// The first point of a step, and its parts.
    fn at(&self, step: usize) -> (u64, Range<u64>) {
        let of = |list: &[u64]| list.get(step).copied().unwrap_or(0);
        let part = of(&self.parts);
        (of(&self.points), part..part.saturating_add(of(&self.counts)))
    }

    fn offset(&self, name: &str, step: usize) -> Option<u64> {
        let [arrays, _] = &self.arrays;
        let (_, offsets) = arrays.iter().find(|(array, _)| array == name)?;
        offsets.get(step).copied()
    }

    fn offset_of_cells(&self, name: &str, step: usize) -> Option<u64> {
        let [_, arrays] = &self.arrays;
        let (_, offsets) = arrays.iter().find(|(array, _)| array == name)?;
        offsets.get(step).copied()
    }
}

/// Warning about the vertices of a mesh.
fn mesh(block: &Group, limit: usize) -> Option<String> {
    let cells = |name: &str| {
        let group = block.group(name).ok()?;
        Some(
            list(&group, "NumberOfCells", limit)
                .ok()?
                .iter()
                .fold(0_u64, |sum, n| sum.saturating_add(*n)),
        )
    };
    let polygons = cells("Polygons").unwrap_or(0).saturating_add(cells("Strips").unwrap_or(0));
    if polygons > 0 && cells("Vertices").unwrap_or(0) == 0 {
        return Some(mesh_warning(polygons, "polygons"));
    }
    let types = list(block, "Types", limit).unwrap_or_default();
    let more = types.iter().filter(|ty| !is_point(**ty as f64)).count();
    (2 * more > types.len()).then(|| mesh_warning(types.len() as u64, "cells"))
}
