//! Reads files that only list other files: the pieces of a frame (PVTU, PVTP, VTM) or the frames of a
//! sequence (PVD, `.series`).

use std::path::{Path, PathBuf};

use roxmltree::Document;

use super::asked::Asked;
use super::error::{Place, ReadError};
use super::plan::Plan;
use super::source::{Content, Input};
use super::vtk_xml;

/// Largest size of such a list in bytes.
const LONGEST: u64 = 64 << 20;

/// The pieces of one frame.
pub(super) struct Pieces {
    files: Vec<PathBuf>,
    /// Names of the blocks, if there are several.
    blocks: Vec<String>,
}

/// Path of a listed file; on Windows it may contain backslashes.
pub(super) fn beside(folder: &Path, file: &str) -> PathBuf {
    let path = folder.join(file);
    if file.contains('\\') && !path.exists() { folder.join(file.replace('\\', "/")) } else { path }
}

/// Returns the text of a short file whose name has one of the extensions; `None` for any other file.
pub(super) fn text(path: &Path, extensions: &[&str]) -> Option<String> {
    let extension = path.extension()?.to_string_lossy().to_lowercase();
    let short = std::fs::metadata(path).is_ok_and(|meta| meta.len() <= LONGEST);
    if !extensions.contains(&extension.as_str()) || !short {
        return None;
    }
    std::fs::read_to_string(path).ok()
}

impl Pieces {
    /// The pieces listed in a file; `None` for a file that holds particles itself.
    pub(super) fn of(path: &Path) -> Result<Option<Self>, ReadError> {
        const EXTENSIONS: [&str; 6] = ["pvtu", "pvtp", "vtm", "vtmb", "vtpc", "xml"];
        let Some(text) = text(path, &EXTENSIONS) else { return Ok(None) };
        let Ok(document) = Document::parse(&text) else { return Ok(None) };
        let root = document.root_element();
        let (element, attribute) = match root.attribute("type").unwrap_or_default() {
            "PUnstructuredGrid" | "PPolyData" => ("Piece", "Source"),
            "vtkMultiBlockDataSet"
            | "vtkPartitionedDataSet"
            | "vtkPartitionedDataSetCollection" => ("DataSet", "file"),
            _ => return Ok(None),
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let (mut files, mut blocks) = (Vec::new(), Vec::new());
        for node in root.descendants().filter(|node| node.has_tag_name(element)) {
            let Some(file) = node.attribute(attribute).filter(|file| !file.is_empty()) else {
                continue;
            };
            files.push(beside(folder, file));
            if element == "DataSet" {
                let above = node.parent().and_then(|parent| parent.attribute("name"));
                let name = node.attribute("name").or(above).unwrap_or(file);
                blocks.push(name.to_string());
            }
        }
        if files.is_empty() {
            return Err(ReadError::malformed("files in the list", "none", Place::Unknown));
        }
        Ok(Some(Self { files, blocks }))
    }

    /// Plans to read the particles of all pieces in sequence.
    pub(super) fn plan(&self, asked: &Asked) -> Result<Plan<'static>, ReadError> {
        let mut contents = Vec::new();
        for file in &self.files {
            let named = |error| match error {
                ReadError::Io { reason, .. } => ReadError::Io { path: file.clone(), reason },
                error => ReadError::File { path: file.clone(), reason: Box::new(error) },
            };
            let io = |reason| ReadError::Io { path: file.clone(), reason };
            let input = Input::new(std::fs::File::open(file).map_err(io)?).map_err(named)?;
            contents.push((file.as_path(), Content::new(&input, false).map_err(named)?));
        }
        let mut warnings = Vec::new();
        if self.blocks.len() > 1 {
            warnings.push(format!(
                "{} blocks are joined: {}; if some of them are walls, name the file of the water alone",
                self.blocks.len(),
                self.blocks.join(", ")
            ));
        }
        vtk_xml::plan_files(&contents, warnings, asked)
    }

    /// Attributes an error to a piece, if that piece alone causes it.
    pub(super) fn fault(&self, error: ReadError) -> ReadError {
        if matches!(error, ReadError::File { .. } | ReadError::Io { .. }) {
            return error;
        }
        let faults = self.files.iter().find_map(|file| super::read(file).err());
        faults.unwrap_or(error)
    }
}

/// The index (PVTU or PVTP) in the same folder that lists this file as a piece of a frame, if there is one.
pub(super) fn lists(file: &Path) -> Option<PathBuf> {
    let extension = file.extension()?.to_string_lossy().to_lowercase();
    if !matches!(extension.as_str(), "vtu" | "vtp") {
        return None;
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let name = file.file_name()?.to_str()?;
    let mut indices: Vec<PathBuf> = std::fs::read_dir(folder)
        .ok()?
        .flatten()
        .map(|entry| file.with_file_name(entry.file_name()))
        .filter(|path| path.extension().is_some_and(|e| e == "pvtu" || e == "pvtp"))
        .collect();
    indices.sort();
    // A text search suffices: the files are short and contain little else.
    let named = format!("\"{name}\"");
    indices.into_iter().find(|path| {
        text(path, &["pvtu", "pvtp"])
            .is_some_and(|t| t.contains(&named) || t.contains(&format!("/{name}\"")))
    })
}

/// A file, and its time if the list has it.
pub(super) type Timed = (PathBuf, Option<f64>);

/// Returns the frames that a PVD or `.series` file lists, with their times; `None` for a file of another kind.
///
/// # Errors
/// A description of the expected form.
pub(super) fn frames(path: &Path) -> Result<Option<Vec<Timed>>, String> {
    let Some(text) = text(path, &["pvd", "series"]) else { return Ok(None) };
    let bad = |found: String| format!("{found}; it was cut off or is damaged: write it again");
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut frames: Vec<Timed> = Vec::new();
    if text.trim_start().starts_with('{') {
        let list: serde_json::Value =
            serde_json::from_str(&text).map_err(|e| bad(e.to_string()))?;
        for file in list.get("files").and_then(|files| files.as_array()).into_iter().flatten() {
            let name = file.get("name").and_then(|name| name.as_str());
            let time = file.get("time").and_then(serde_json::Value::as_f64);
            frames.extend(name.map(|name| (beside(folder, name), time)));
        }
    } else {
        let document = Document::parse(&text).map_err(|e| bad(e.to_string()))?;
        for node in document.root_element().descendants().filter(|n| n.has_tag_name("DataSet")) {
            let time = node.attribute("timestep").and_then(|time| time.trim().parse().ok());
            frames.extend(node.attribute("file").map(|file| (beside(folder, file), time)));
        }
    }
    if frames.is_empty() {
        return Err("files in it, found none; write it again".into());
    }
    Ok(Some(frames))
}
