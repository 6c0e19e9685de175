//! Reads XDMF: XML that says which arrays (in HDF5 files or inline) are points and attributes of which frame.
//!
//! A `Grid` has a `Geometry` with points, and `Attribute`s at nodes. The grids of a temporal collection are
//! frames, those of a spatial one are parts of a frame. A grid without points takes those of the first grid,
//! because writers of time series omit them. A `DataItem` holds its values inline, in an array of an HDF5
//! file beside it (`file.h5:/path`), or refers to another item by a path of elements. Attributes of cells are read if
//! the cells are the points, see `cells`.

use std::path::Path;

use roxmltree::{Document, Node};

use super::asked::Asked;
use super::cells::{self, Cells};
use super::columns::{Attribute, AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::hdf5::{File, listed};
use super::index;
use super::{Format, Particles};

/// Max number of grids in a file.
const GRIDS: usize = 1 << 16;
/// Max number of references from one item to the next.
const REFERENCES: usize = 16;

/// The text of a file, by its extension; `None` for any other file.
fn text(path: &Path) -> Option<String> {
    index::text(path, &["xdmf", "xmf", "xdmf2", "xdmf3"])
}

/// Times of the frames of a file; `None` for another format.
pub(super) fn times(path: &Path) -> Option<Result<Vec<Option<f64>>, ReadError>> {
    let text = text(path)?;
    Some(parse(&text).and_then(|document| {
        let frames = frames(&document)?;
        Ok(frames.iter().map(|frame| frame.time).collect())
    }))
}

/// The particles of a file; `None` for another format.
pub(super) fn read(path: &Path, asked: &Asked) -> Option<Result<Particles, ReadError>> {
    let text = text(path)?;
    Some(parse(&text).and_then(|document| of_document(&document, path, asked)))
}

fn parse(text: &str) -> Result<Document<'_>, ReadError> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    Document::parse_with_options(text, options).map_err(|e| {
        let rest = text.trim_end();
        let end = rest.rfind("</").and_then(|at| rest.get(at..)).unwrap_or_default();
        if !end.eq_ignore_ascii_case("</xdmf>") {
            let what = "the XML of an XDMF file, up to `</Xdmf>`,";
            return ReadError::truncated(what, text.len(), 1, 0);
        }
        ReadError::malformed("XML", e.to_string(), Place::Line(e.pos().row.into()))
    })
}

/// The grids of a frame.
struct Frame<'d, 'i> {
    time: Option<f64>,
    grids: Vec<Node<'d, 'i>>,
}

fn is(node: &Node<'_, '_>, name: &str) -> bool {
    node.tag_name().name() == name
}

fn child<'d, 'i>(node: &Node<'d, 'i>, name: &str) -> Option<Node<'d, 'i>> {
    node.children().find(|node| is(node, name))
}

/// The time of a grid.
fn time(grid: &Node<'_, '_>) -> Option<f64> {
    child(grid, "Time")?.attribute("Value")?.trim().parse().ok()
}

/// The times that a collection lists for its grids: numbers, or the first one, their distance and their count.
fn times_of(collection: &Node<'_, '_>) -> Vec<f64> {
    let Some(time) = child(collection, "Time") else { return Vec::new() };
    let kind = time.attribute("TimeType").or_else(|| time.attribute("Type")).unwrap_or_default();
    let item = child(&time, "DataItem").filter(|item| {
        matches!(item.attribute("Format"), None | Some("XML"))
            && item.attribute("Reference").is_none()
    });
    let text = item.and_then(|item| item.text()).unwrap_or_default();
    let numbers = text.split_whitespace().map(|word| word.parse::<f64>().ok());
    let numbers: Vec<f64> = numbers.collect::<Option<_>>().unwrap_or_default();
    if kind == "List" {
        return numbers;
    }
    let [first, step, count] = numbers.as_slice() else { return Vec::new() };
    let count = if kind == "HyperSlab" { (*count as usize).min(GRIDS) } else { 0 };
    (0..count).map(|i| first + step * i as f64).collect()
}

/// Whether the grids are parts of one thing, as its writer said.
fn are_parts(grids: &[Node<'_, '_>]) -> bool {
    grids.iter().all(|grid| {
        let around = grid.parent().filter(|around| is(around, "Grid"));
        around.is_some_and(|around| {
            around.attribute("GridType") == Some("Collection")
                && matches!(around.attribute("CollectionType"), None | Some("Spatial"))
        })
    })
}

fn frames<'d>(document: &'d Document<'_>) -> Result<Vec<Frame<'d, 'd>>, ReadError> {
    let root = document.root_element();
    if !is(&root, "Xdmf") {
        return Err(ReadError::malformed("XDMF", root.tag_name().name(), Place::Unknown));
    }
    let uniform = |grid: &Node<'_, '_>| {
        is(grid, "Grid") && matches!(grid.attribute("GridType"), None | Some("Uniform"))
    };
    let temporal = root.descendants().find(|grid| {
        is(grid, "Grid")
            && grid.attribute("GridType") == Some("Collection")
            && grid.attribute("CollectionType") == Some("Temporal")
    });
    let mut frames = Vec::new();
    match temporal {
        Some(all) => {
            let listed = times_of(&all);
            let own = all.children().filter(|node| is(node, "Grid")).take(GRIDS);
            for (i, grid) in own.enumerate() {
                let grids = grid.descendants().filter(uniform).collect();
                let time = time(&grid).or_else(|| listed.get(i).copied());
                frames.push(Frame { time, grids });
            }
        }
        None => {
            let grids: Vec<_> = root.descendants().filter(uniform).take(GRIDS).collect();
            let time = grids.iter().find_map(time);
            frames.push(Frame { time, grids });
        }
    }
    if frames.iter().all(|frame| frame.grids.is_empty()) {
        return Err(ReadError::malformed("a Grid with a Geometry", "none", Place::Unknown));
    }
    Ok(frames)
}

fn of_document(
    document: &Document<'_>,
    path: &Path,
    asked: &Asked,
) -> Result<Particles, ReadError> {
    let mut frames = frames(document)?;
    let count = frames.len();
    let index = match asked.step() {
        Some(step) => step.index.min(count - 1),
        None if count > 1 => {
            return Err(ReadError::Unsupported {
                what: format!("an XDMF file of {count} frames, of which none is named,"),
                advice: "write one file per frame, with the frame's number in its name",
            });
        }
        None => 0,
    };
    let frame = frames.swap_remove(index);
    let mut table = Table::new(asked);
    table.time = frame.time;
    let mut reader = Reader { document, path, open: None };
    let geometry = |grid: &Node<'_, '_>| child(grid, "Geometry").is_some();
    // A time series may store its geometry once.
    let shared = document.descendants().find(|node| is(node, "Geometry"));
    let mut all: Vec<(String, usize, Data, usize)> = Vec::new();
    let grids: Vec<_> = match frame.grids.iter().any(geometry) {
        true => frame.grids.into_iter().filter(geometry).collect(),
        false => frame.grids,
    };
    let count = grids.len();
    if count > 1 && !are_parts(&grids) {
        let names = grids.iter().map(|grid| grid.attribute("Name").unwrap_or("unnamed"));
        table.warnings.push(format!(
            "{count} grids are joined: {}; if some of them are walls, give the file of the water alone",
            listed(names)
        ));
    }
    let (mut cells, mut on_cells) = (Cells::default(), Vec::new());
    for (i, grid) in grids.iter().enumerate() {
        let Some(points) = child(grid, "Geometry").or(shared) else {
            return Err(ReadError::malformed("a Geometry in the Grid", "none", Place::Unknown));
        };
        let mut rows = 0;
        for (name, components, data) in reader.points(&points)? {
            rows = data.len() / components.max(1);
            if i == 0 {
                table.list(&name, components, AttributeType::Number);
            }
            put(&mut all, i, &name, components, data);
        }
        for attribute in grid.children().filter(|node| is(node, "Attribute")) {
            let name = attribute.attribute("Name").unwrap_or("unnamed");
            let Some(item) = child(&attribute, "DataItem") else { continue };
            match attribute.attribute("Center") {
                None | Some("Node") => {}
                Some("Cell") => {
                    on_cells.push((i, name, item));
                    continue;
                }
                Some(center) => {
                    let why = format!("they belong to `Center=\"{center}\"`");
                    let told = cells::unused(&[name.to_string()], &cells::no_particles(&why));
                    table.warnings.extend(told.filter(|_| i == 0));
                    continue;
                }
            }
            let shape = dimensions(&reader.referred(item)?);
            let components = components(&shape);
            let known = table.attributes.iter().any(|a| a.name == name);
            let wanted = match known {
                true => asked.wants(name),
                false => table.list(name, components, AttributeType::Number),
            };
            if wanted {
                let (shape, data) = reader.item(item)?;
                put(&mut all, i, name, self::components(&shape), data);
            }
        }
        match on_cells.last() {
            Some((of, ..)) if *of == i => reader.cells(grid, rows as u64, &mut cells),
            _ => cells.skip(rows as u64),
        }
    }
    reader.of_cells(cells, on_cells, &mut table, &mut all)?;
    for (name, components, data, grids) in all {
        if grids == count {
            table.push(&name, components, data);
        } else {
            table.warnings.push(format!("attribute `{name}` is dropped: not all grids have it"));
        }
    }
    table.assemble(Format::Xdmf)
}

/// Appends the values of a grid to those of earlier grids.
fn put(
    all: &mut Vec<(String, usize, Data, usize)>,
    i: usize,
    name: &str,
    components: usize,
    data: Data,
) {
    match all.iter_mut().find(|(known, ..)| known == name) {
        Some((_, before, to, grids)) if *before == components && *grids == i => {
            *grids += usize::from(to.append(data));
        }
        None if i == 0 => all.push((name.into(), components, data, 1)),
        _ => {}
    }
}

/// Number of values per particle.
fn components(shape: &[u64]) -> usize {
    let rest = shape.get(1..).unwrap_or_default().iter();
    usize::try_from(rest.fold(1_u64, |n, d| n.saturating_mul(*d))).unwrap_or(usize::MAX)
}

/// Dimensions of an item.
fn dimensions(item: &Node<'_, '_>) -> Vec<u64> {
    let text = item.attribute("Dimensions").unwrap_or_default();
    text.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

/// Reads items.
struct Reader<'d, 'i, 'p> {
    document: &'d Document<'i>,
    path: &'p Path,
    /// The file that was read last.
    open: Option<(String, File)>,
}

impl<'d> Reader<'d, '_, '_> {
    /// The points of a geometry: with two or three components, or one array per component.
    fn points(&mut self, geometry: &Node<'d, 'd>) -> Result<Vec<(String, usize, Data)>, ReadError> {
        let kind = geometry.attribute("GeometryType").or_else(|| geometry.attribute("Type"));
        let items = geometry.children().filter(|node| is(node, "DataItem"));
        let read: Vec<_> = items.map(|item| self.item(item)).collect::<Result<_, _>>()?;
        let kind = kind.unwrap_or("XYZ").to_ascii_uppercase();
        let unsupported = || ReadError::Unsupported {
            what: format!("an XDMF geometry of type {kind}"),
            advice: "write points as XYZ, XY or X_Y_Z",
        };
        let components = match kind.as_str() {
            "XYZ" => 3,
            "XY" => 2,
            "X_Y_Z" | "X_Y" => {
                let names = ["x", "y", "z"].into_iter();
                let all = names.zip(read).map(|(name, (_, data))| (name.to_string(), 1, data));
                return Ok(all.collect());
            }
            _ => return Err(unsupported()),
        };
        let (_, data) = read.into_iter().next().ok_or_else(unsupported)?;
        Ok(vec![("position".into(), components, data)])
    }

    /// Finds whether the cells of a grid are its points.
    fn cells(&mut self, grid: &Node<'d, 'd>, points: u64, cells: &mut Cells) {
        let shared = self.document.descendants().find(|node| is(node, "Topology"));
        let topology = child(grid, "Topology").or(shared);
        let kind = topology.and_then(|topology| {
            topology.attribute("TopologyType").or_else(|| topology.attribute("Type"))
        });
        let kind = kind.unwrap_or("no type");
        let size = topology.and_then(|topology| topology.attribute("NodesPerElement"));
        if !kind.eq_ignore_ascii_case("Polyvertex") || !matches!(size, None | Some("1")) {
            cells.refuse(match size {
                Some(size) => format!("the cells are {kind} of {size} points"),
                None => format!("the cells are {kind}"),
            });
            return;
        }
        let list = topology.and_then(|topology| child(&topology, "DataItem"));
        match list.map(|list| self.item(list)).transpose() {
            Ok(list) => cells.add_list(points, list.as_ref().map(|(_, list)| list)),
            Err(error) => cells.refuse(format!("their list cannot be read ({error})")),
        }
    }

    /// Reads the attributes of cells, if the cells are the points.
    fn of_cells(
        &mut self,
        cells: Cells,
        on_cells: Vec<(usize, &str, Node<'d, 'd>)>,
        table: &mut Table,
        all: &mut Vec<(String, usize, Data, usize)>,
    ) -> Result<(), ReadError> {
        let mut listed: Vec<Attribute> = Vec::new();
        for (_, name, item) in &on_cells {
            if !listed.iter().any(|a| a.name == *name) {
                let components = components(&dimensions(&self.referred(*item)?));
                table.asked.list(&mut listed, name, components, AttributeType::Number);
            }
        }
        let doubled = cells::doubled(&mut listed, &table.attributes);
        table.warnings.extend(cells::unused(&doubled, cells::DOUBLED));
        let order = match cells.finish() {
            Ok(order) => order,
            Err(why) => {
                let names: Vec<String> = listed.into_iter().map(|a| a.name).collect();
                table.warnings.extend(cells::unused(&names, &cells::no_particles(&why)));
                return Ok(());
            }
        };
        let first = all.len();
        for (i, name, item) in on_cells {
            if listed.iter().any(|a| a.name == name) && table.asked.wants(name) {
                let (shape, data) = self.item(item)?;
                put(all, i, &cells::column_name(name), components(&shape), data);
            }
        }
        for (_, components, data, _) in all.iter_mut().skip(first) {
            if let Some(order) = &order {
                *data = data.picked(*components, order);
            }
        }
        table.attributes.append(&mut listed);
        Ok(())
    }

    /// The item that this one refers to, or itself.
    fn referred(&self, item: Node<'d, 'd>) -> Result<Node<'d, 'd>, ReadError> {
        let mut item = item;
        for _ in 0..REFERENCES {
            let Some(path) = item.attribute("Reference") else { return Ok(item) };
            let path = if path == "XML" { item.text().unwrap_or_default() } else { path };
            item = self.at(item, path.trim())?;
        }
        Err(ReadError::malformed(
            "a DataItem with values behind a reference",
            "ever more references",
            Place::Unknown,
        ))
    }

    /// The item that a path leads to, such as `/Xdmf/Domain/Grid[2]/Geometry/DataItem[@Name="p"]`.
    fn at(&self, from: Node<'d, 'd>, path: &str) -> Result<Node<'d, 'd>, ReadError> {
        let root: Node<'d, 'd> = self.document.root();
        let mut found = follow(root, from, path).unwrap_or_default();
        found.retain(|node| is(node, "DataItem"));
        // Where the path has other steps than those, a name suffices if only one item has it.
        let name = path.split(['"', '\'']).rev().nth(1);
        if let (true, Some(name)) = (found.is_empty(), name) {
            let items = root.descendants().filter(|node| is(node, "DataItem"));
            found = items.filter(|node| node.attribute("Name") == Some(name)).collect();
            found.retain(|node| node.attribute("Reference").is_none());
        }
        match found.as_slice() {
            [item] => Ok(*item),
            _ => Err(ReadError::malformed(
                "one DataItem that another one refers to",
                format!("{} by `{path}`", found.len()),
                Place::Unknown,
            )),
        }
    }

    /// Dimensions and values of an item.
    fn item(&mut self, item: Node<'d, 'd>) -> Result<(Vec<u64>, Data), ReadError> {
        let item = self.referred(item)?;
        let text = item.text().unwrap_or_default();
        if !matches!(item.attribute("ItemType"), None | Some("Uniform")) {
            return Err(ReadError::Unsupported {
                what: format!("an XDMF item of type {}", item.attribute("ItemType").unwrap_or("")),
                advice: "write whole arrays, one for each frame",
            });
        }
        let expected = dimensions(&item);
        let (shape, data) = match item.attribute("Format").unwrap_or("XML") {
            "XML" => {
                let mut data = Data::F64(Vec::new());
                for word in text.split_ascii_whitespace() {
                    if !data.push_text(word.as_bytes()) {
                        return Err(ReadError::malformed("a number", word, Place::Unknown));
                    }
                }
                (expected.clone(), data)
            }
            "HDF" => self.array(text.trim())?,
            other => {
                return Err(ReadError::Unsupported {
                    what: format!("an XDMF item of format {other}"),
                    advice: "write its arrays as HDF, or in the text (XML)",
                });
            }
        };
        let product = |shape: &[u64]| shape.iter().fold(1_u64, |n, d| n.saturating_mul(*d));
        let shape = if expected.is_empty() { shape } else { expected };
        if product(&shape) != data.len() as u64 {
            return Err(ReadError::Length {
                attribute: text.trim().chars().take(64).collect(),
                expected: product(&shape),
                found: data.len() as u64,
            });
        }
        Ok((shape, data))
    }

    /// Reads an array by its file's name and its path.
    fn array(&mut self, name: &str) -> Result<(Vec<u64>, Data), ReadError> {
        let bad = || ReadError::malformed("file.h5:/path of an array", name, Place::Unknown);
        let (file, path) = name.rsplit_once(':').ok_or_else(bad)?;
        let beside = index::beside(self.path.parent().unwrap_or(Path::new("")), file);
        let known = self.open.as_ref().is_some_and(|(open, _)| open == file);
        if !known {
            let open = File::open(&beside).map_err(|error| super::parts::named(&beside, error))?;
            self.open = Some((file.to_string(), open));
        }
        let (_, open) = self.open.as_ref().ok_or_else(bad)?;
        open.numbers(path).map_err(|error| super::parts::named(&beside, error))
    }
}

/// The elements that a path leads to, from an item. `None` if it has other steps than names, numbers and attributes.
fn follow<'d>(root: Node<'d, 'd>, from: Node<'d, 'd>, path: &str) -> Option<Vec<Node<'d, 'd>>> {
    let (start, path) = match (path.strip_prefix("//"), path.strip_prefix('/')) {
        (Some(path), _) => (root.descendants().collect::<Vec<_>>(), path),
        (None, Some(path)) => (vec![root], path),
        (None, None) => (vec![from], path),
    };
    let mut nodes: Vec<Node<'d, 'd>> = start;
    // A name may have slashes.
    let mut quote = None;
    let steps = path.split(|c: char| {
        match quote {
            Some(open) if c == open => quote = None,
            None if matches!(c, '"' | '\'') => quote = Some(c),
            _ => {}
        }
        c == '/' && quote.is_none()
    });
    for step in steps {
        let step = step.trim();
        let at = step.find('[').unwrap_or(step.len());
        let (name, conditions) = step.split_at_checked(at)?;
        let name = name.trim();
        let plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
        if name != "*" && (name.is_empty() || !name.chars().all(plain)) {
            return None;
        }
        let mut next = Vec::new();
        for node in nodes {
            match name {
                "." => next.push(node),
                ".." => next.extend(node.parent()),
                _ => {
                    let inner = node
                        .children()
                        .filter(|inner| inner.is_element() && (name == "*" || is(inner, name)));
                    next.append(&mut kept(inner.collect(), conditions)?);
                }
            }
        }
        nodes = next;
    }
    Some(nodes)
}

/// The elements that fulfil conditions, such as `[2]` or `[@Name="p"]`; `None` for conditions of other kinds.
fn kept<'d>(mut nodes: Vec<Node<'d, 'd>>, conditions: &str) -> Option<Vec<Node<'d, 'd>>> {
    let mut rest = conditions.trim();
    while !rest.is_empty() {
        let inner = rest.strip_prefix('[')?.trim_start();
        let behind = match inner.strip_prefix('@') {
            Some(attribute) => {
                let (name, value) = attribute.split_once('=')?;
                let value = value.trim_start();
                let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
                let (value, behind) = value.strip_prefix(quote)?.split_once(quote)?;
                nodes.retain(|node| node.attribute(name.trim()) == Some(value));
                behind
            }
            None => {
                let end = inner.find(']')?;
                let (number, behind) = inner.split_at_checked(end)?;
                // Counted from 1.
                let index = number.trim().parse::<usize>().ok()?.checked_sub(1)?;
                nodes = nodes.get(index).copied().into_iter().collect();
                behind
            }
        };
        rest = behind.trim_start().strip_prefix(']')?.trim_start();
    }
    Some(nodes)
}
