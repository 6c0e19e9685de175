//! Scenes from files: glTF binary, Wavefront OBJ, and the project's own JSON. A bad file is an
//! error that says what was expected and what was found; nothing in a file makes this panic.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Mat4, Vec3};
use serde::Deserialize;

use super::shapes::FACES;
use super::{Ground, Material, Mesh, Pattern, Scene, SunLight, Texture, Viewpoint};
use crate::environment::Sky;

/// A scene file that could not be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {why}", path.display())]
pub struct SceneError {
    /// The file.
    pub path: PathBuf,
    /// What was expected, what was found.
    pub why: String,
}

/// Vertices and triangles that a file may have.
const MOST: usize = 20_000_000;

impl Scene {
    /// Reads a scene by its file's extension: `.glb`, `.obj` or `.json`.
    ///
    /// # Errors
    /// Any other extension; and as the loader of the format.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "glb" | "gltf" => Self::load_glb(path),
            "obj" => Self::load_obj(path),
            "json" => Self::from_json(path),
            other => Err(SceneError {
                path: path.into(),
                why: format!("expected a scene as .glb, .gltf, .obj or .json, found '.{other}'"),
            }),
        }
    }

    /// Reads the default scene of a glTF file: triangles, base colours and base colour textures.
    ///
    /// # Errors
    /// The file cannot be read, is no glTF 2.0, or has what is not supported here: sparse or
    /// compressed data.
    pub fn load_glb(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|error| at(path, error.to_string()))?;
        Self::parse_glb(&bytes, path.parent()).map_err(|why| at(path, why))
    }

    /// Reads all faces of a Wavefront file as one mesh of the default material.
    ///
    /// # Errors
    /// The file cannot be read, or is no OBJ.
    pub fn load_obj(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|error| at(path, error.to_string()))?;
        Self::parse_obj(&bytes).map_err(|why| at(path, why))
    }

    /// Reads the project's own format: boxes, upright cylinders, spheres, a ground, a camera.
    /// Boxes whose names begin with `basin` form a basin: their faces that look into it are tiled,
    /// with a dark row at the pool's level.
    ///
    /// # Errors
    /// The file cannot be read, is no JSON of this form, or names an unknown material.
    pub fn from_json(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|error| at(path, error.to_string()))?;
        Self::parse_json(&bytes).map_err(|why| at(path, why))
    }
}

fn at(path: &Path, why: String) -> SceneError {
    SceneError { path: path.into(), why }
}

#[derive(Deserialize)]
struct File {
    #[serde(default)]
    boxes: Vec<FileBox>,
    #[serde(default)]
    cylinders: Vec<FileCylinder>,
    #[serde(default)]
    spheres: Vec<FileSphere>,
    ground: Option<FileGround>,
    camera: Option<FileCamera>,
    fluid: Option<FileFluid>,
    sun: Option<FileSun>,
}

#[derive(Deserialize)]
struct FileBox {
    #[serde(default)]
    name: String,
    material: String,
    centre: [f32; 3],
    half: [f32; 3],
    #[serde(default = "no_rotation")]
    rotation: [f32; 4],
}

#[derive(Deserialize)]
struct FileCylinder {
    #[serde(default)]
    name: String,
    material: String,
    centre: [f32; 3],
    radius: f32,
    height: f32,
}

#[derive(Deserialize)]
struct FileSphere {
    #[serde(default)]
    name: String,
    material: String,
    centre: [f32; 3],
    radius: f32,
}

#[derive(Deserialize)]
struct FileGround {
    y: f32,
    material: String,
}

#[derive(Deserialize)]
struct FileCamera {
    eye: [f32; 3],
    target: [f32; 3],
    #[serde(default = "y_up")]
    up: [f32; 3],
    fov_y_degrees: f32,
}

#[derive(Deserialize)]
struct FileFluid {
    pool_level: Option<f32>,
}

#[derive(Deserialize)]
struct FileSun {
    direction: [f32; 3],
    intensity: Option<f32>,
}

fn no_rotation() -> [f32; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

fn y_up() -> [f32; 3] {
    [0.0, 1.0, 0.0]
}

impl Scene {
    fn parse_json(bytes: &[u8]) -> Result<Self, String> {
        let file: File = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        let material = |name: &str, of: &str| {
            Material::named(name).ok_or_else(|| {
                format!(
                    "material of '{of}': expected one of {}, found '{name}'",
                    Material::NAMES.join(", ")
                )
            })
        };
        let positive = |value: f32, what: &str, of: &str| {
            // JSON numbers beyond the range of f32 become infinite.
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(format!("{what} of '{of}': expected more than 0, found {value}"))
            }
        };
        let mut scene = Self::default();
        let basin: Vec<&FileBox> =
            file.boxes.iter().filter(|b| b.name.starts_with("basin")).collect();
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for part in &basin {
            low = low.min(Vec3::from(part.centre) - Vec3::from(part.half));
            high = high.max(Vec3::from(part.centre) + Vec3::from(part.half));
        }
        let mut tiles = Material::named("tiles").unwrap_or_default();
        if let Pattern::Tiles { band, .. } = &mut tiles.pattern {
            *band = file.fluid.and_then(|fluid| fluid.pool_level);
        }
        for part in &file.boxes {
            for (half, what) in part.half.into_iter().zip(["half[0]", "half[1]", "half[2]"]) {
                positive(half, what, &part.name)?;
            }
            let outside = material(&part.material, &part.name)?;
            let (centre, half) = (Vec3::from(part.centre), Vec3::from(part.half));
            // A face looks into the basin when it lies within its bounds and faces their middle.
            let inner = |face: usize| {
                let normal = FACES[face];
                let at = centre + normal * half;
                let (a, b) = (at.dot(normal.abs()), (low.dot(normal.abs()), high.dot(normal.abs())));
                let margin = 1e-3 * (b.1 - b.0);
                part.name.starts_with("basin")
                    && basin.len() > 1
                    && part.rotation == no_rotation()
                    && a > b.0 + margin
                    && a < b.1 - margin
                    && (0.5 * (low + high) - at).dot(normal) > 0.0
            };
            let shape = |material, wanted: &dyn Fn(usize) -> bool| Mesh {
                name: part.name.clone(),
                ..Mesh::cuboid_faces(part.centre, part.half, part.rotation, material, wanted)
            };
            if (0..6).any(inner) {
                scene.meshes.push(shape(tiles.clone(), &inner));
            }
            scene.meshes.push(shape(outside, &|face| !inner(face)));
        }
        for part in file.cylinders {
            positive(part.radius, "radius", &part.name)?;
            positive(part.height, "height", &part.name)?;
            let material = material(&part.material, &part.name)?;
            scene.meshes.push(Mesh {
                name: part.name,
                ..Mesh::cylinder(part.centre, part.radius, part.height, material)
            });
        }
        for part in file.spheres {
            positive(part.radius, "radius", &part.name)?;
            let material = material(&part.material, &part.name)?;
            scene.meshes.push(Mesh {
                name: part.name,
                ..Mesh::sphere(part.centre, part.radius, material)
            });
        }
        if let Some(ground) = file.ground {
            let material = material(&ground.material, "ground")?;
            scene.ground = Some(Ground { y: ground.y, material });
        }
        scene.camera = file.camera.map(|camera| Viewpoint {
            eye: camera.eye,
            target: camera.target,
            up: camera.up,
            fov_y_degrees: camera.fov_y_degrees,
        });
        if let Some(sun) = file.sun {
            let Some(direction) = Vec3::from(sun.direction).try_normalize() else {
                return Err(format!(
                    "sun.direction: expected any length but 0, found {:?}",
                    sun.direction
                ));
            };
            let intensity = sun.intensity.unwrap_or(Sky::default().intensity);
            scene.sun = SunLight::of(&Sky { sun: direction.to_array(), intensity });
        }
        Ok(scene)
    }

    fn parse_obj(bytes: &[u8]) -> Result<Self, String> {
        let text = String::from_utf8_lossy(bytes);
        let (mut points, mut normals, mut uvs) = (Vec::new(), Vec::new(), Vec::new());
        let mut mesh = Mesh { name: "obj".into(), ..Mesh::default() };
        let mut known: HashMap<[usize; 3], u32> = HashMap::new();
        let mut lacks_normals = false;
        for (number, line) in text.lines().enumerate() {
            let number = number + 1;
            let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
            match words.next() {
                Some("v") => points.push(numbers::<3>(words, number)?),
                Some("vn") => normals.push(numbers::<3>(words, number)?),
                Some("vt") => uvs.push(numbers::<2>(words, number)?),
                Some("f") => {
                    let mut corners = Vec::new();
                    for word in words {
                        let key = corner(word, [points.len(), uvs.len(), normals.len()])
                            .map_err(|why| format!("line {number}: {why}"))?;
                        lacks_normals |= key[2] == 0;
                        let next = mesh.positions.len() as u32;
                        corners.push(*known.entry(key).or_insert_with(|| {
                            // Indices begin at 1; 0 says there is none.
                            mesh.positions.push(points[key[0] - 1]);
                            let uv: [f32; 2] =
                                if key[1] > 0 { uvs[key[1] - 1] } else { [0.0; 2] };
                            mesh.uvs.push([uv[0], 1.0 - uv[1]]);
                            mesh.normals.push(if key[2] > 0 {
                                let n: [f32; 3] = normals[key[2] - 1];
                                Vec3::from(n).normalize_or_zero().to_array()
                            } else {
                                [0.0; 3]
                            });
                            next
                        }));
                    }
                    if corners.len() < 3 {
                        return Err(format!(
                            "line {number}: expected a face of 3 or more corners, found {}",
                            corners.len()
                        ));
                    }
                    for pair in corners[1..].windows(2) {
                        mesh.indices.extend([corners[0], pair[0], pair[1]]);
                    }
                }
                // Groups, materials, lines and what else there may be are not drawn.
                _ => {}
            }
            if mesh.indices.len() > 3 * MOST || points.len() > MOST {
                return Err(format!("line {number}: more than {MOST} vertices or triangles"));
            }
        }
        if mesh.indices.is_empty() {
            return Err("expected faces (lines that begin with 'f'), found none".into());
        }
        if lacks_normals {
            make_normals(&mut mesh);
        }
        Ok(Self { meshes: vec![mesh], ..Self::default() })
    }
}

fn numbers<'a, const N: usize>(
    mut words: impl Iterator<Item = &'a str>,
    line: usize,
) -> Result<[f32; N], String> {
    let mut out = [0.0; N];
    for value in &mut out {
        let word = words.next().unwrap_or_default();
        *value = word
            .parse()
            .ok()
            .filter(|v: &f32| v.is_finite())
            .ok_or_else(|| format!("line {line}: expected {N} numbers, found '{word}'"))?;
    }
    Ok(out)
}

/// `p`, `p/t`, `p//n` or `p/t/n`, from 1, or backwards from −1; as indices from 1, 0 for none.
fn corner(word: &str, counts: [usize; 3]) -> Result<[usize; 3], String> {
    let mut key = [0; 3];
    for (k, part) in word.split('/').enumerate() {
        let Some(slot) = key.get_mut(k) else {
            return Err(format!("expected a corner like 1/2/3, found '{word}'"));
        };
        if part.is_empty() && k > 0 {
            continue;
        }
        let count = counts[k] as i64;
        let index: i64 =
            part.parse().map_err(|_| format!("expected a corner like 1/2/3, found '{word}'"))?;
        let index = if index < 0 { count.saturating_add(index).saturating_add(1) } else { index };
        if index < 1 || index > count {
            return Err(format!("expected an index from 1 to {count}, found '{word}'"));
        }
        *slot = index as usize;
    }
    Ok(key)
}

/// Normals for a mesh without: smooth over edges of less than 40 degrees, sharp elsewhere.
fn make_normals(mesh: &mut Mesh) {
    let crease = 40_f32.to_radians().cos();
    let place = |mesh: &Mesh, i: u32| mesh.positions[i as usize].map(f32::to_bits);
    let faces: Vec<Vec3> = mesh
        .indices
        .chunks_exact(3)
        .map(|t| {
            let [a, b, c] = [0, 1, 2].map(|k| Vec3::from(mesh.positions[t[k] as usize]));
            (b - a).cross(c - a)
        })
        .collect();
    let mut at: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
    for (face, t) in mesh.indices.chunks_exact(3).enumerate() {
        for &i in t {
            at.entry(place(mesh, i)).or_default().push(face);
        }
    }
    let old = std::mem::take(&mut mesh.indices);
    let mut made = Mesh::default();
    for (face, t) in old.chunks_exact(3).enumerate() {
        let own = faces[face].normalize_or_zero();
        for &i in t {
            let sum: Vec3 = at[&place(mesh, i)]
                .iter()
                // A vertex of very many faces is no smooth surface: enough is enough.
                .take(64)
                .map(|&other| faces[other])
                .filter(|other| other.normalize_or_zero().dot(own) > crease)
                .sum();
            made.indices.push(made.positions.len() as u32);
            made.positions.push(mesh.positions[i as usize]);
            made.normals.push(sum.normalize_or(own).to_array());
            made.uvs.push(mesh.uvs.get(i as usize).copied().unwrap_or_default());
        }
    }
    (mesh.positions, mesh.normals, mesh.uvs, mesh.indices) =
        (made.positions, made.normals, made.uvs, made.indices);
}

impl Scene {
    fn parse_glb(bytes: &[u8], folder: Option<&Path>) -> Result<Self, String> {
        let gltf::Gltf { document, blob } =
            gltf::Gltf::from_slice(bytes).map_err(|error| error.to_string())?;
        // The crate takes URIs apart with unwrap where they hold encoded bytes.
        let uris = document.buffers().filter_map(|b| match b.source() {
            gltf::buffer::Source::Uri(uri) => Some(uri),
            gltf::buffer::Source::Bin => None,
        });
        let images = document.images().filter_map(|i| match i.source() {
            gltf::image::Source::Uri { uri, .. } => Some(uri),
            gltf::image::Source::View { .. } => None,
        });
        if let Some(uri) = uris.chain(images).find(|u| !u.starts_with("data:") && u.contains('%')) {
            return Err(format!("expected a file name without escapes, found '{uri}'"));
        }
        let buffers = gltf::import_buffers(&document, folder, blob).map_err(|e| e.to_string())?;
        for view in document.views() {
            let end = view.offset().checked_add(view.length());
            if end.is_none_or(|end| end > buffers[view.buffer().index()].len()) {
                return Err(format!(
                    "buffer view {}: {} bytes from {} on are outside of its buffer",
                    view.index(),
                    view.length(),
                    view.offset()
                ));
            }
        }
        let mut textures: HashMap<usize, Arc<Texture>> = HashMap::new();
        let mut scene = Self::default();
        let nodes: Vec<_> = match document.default_scene().or_else(|| document.scenes().next()) {
            Some(scene) => scene.nodes().collect(),
            None => document.nodes().collect(),
        };
        let mut stack: Vec<_> = nodes.into_iter().map(|n| (n, Mat4::IDENTITY, 0)).collect();
        let mut triangles = 0;
        while let Some((node, parent, depth)) = stack.pop() {
            if depth > 256 {
                return Err("nodes are nested more than 256 deep, or are their own parents".into());
            }
            let transform = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
            stack.extend(node.children().map(|child| (child, transform, depth + 1)));
            let Some(mesh) = node.mesh() else { continue };
            for primitive in mesh.primitives() {
                if primitive.mode() != gltf::mesh::Mode::Triangles {
                    continue;
                }
                let name = node.name().or(mesh.name()).unwrap_or("mesh").to_owned();
                let material = gltf_material(&primitive.material(), folder, &buffers, &mut textures)
                    .map_err(|why| format!("mesh '{name}': {why}"))?;
                let read = gltf_mesh(&primitive, &buffers)
                    .map_err(|why| format!("mesh '{name}': {why}"))?;
                triangles += read.indices.len() / 3;
                if triangles > MOST || scene.meshes.len() > MOST {
                    return Err(format!("more than {MOST} triangles or meshes"));
                }
                scene.meshes.push(Mesh { name, material, transform, ..read });
            }
        }
        if scene.meshes.is_empty() {
            return Err("expected a mesh of triangles, found none".into());
        }
        Ok(scene)
    }
}

fn gltf_material(
    material: &gltf::Material<'_>,
    folder: Option<&Path>,
    buffers: &[gltf::buffer::Data],
    textures: &mut HashMap<usize, Arc<Texture>>,
) -> Result<Material, String> {
    let pbr = material.pbr_metallic_roughness();
    let [r, g, b, _] = pbr.base_color_factor();
    let mut made = Material::new([r, g, b], pbr.roughness_factor(), Pattern::Plain);
    if let Some(info) = pbr.base_color_texture() {
        let image = info.texture().source();
        let index = image.index();
        let texture = match textures.get(&index) {
            Some(texture) => texture.clone(),
            None => {
                let data = gltf::image::Data::from_source(image.source(), folder, buffers)
                    .map_err(|error| format!("image {index}: {error}"))?;
                let texture = Arc::new(rgba8(data).map_err(|e| format!("image {index}: {e}"))?);
                textures.insert(index, texture.clone());
                texture
            }
        };
        made.texture = Some(texture);
    }
    Ok(made)
}

fn rgba8(data: gltf::image::Data) -> Result<Texture, String> {
    use gltf::image::Format;
    let p = &data.pixels;
    let data8 = match data.format {
        Format::R8 => p.iter().map(|&v| [v, v, v, 255]).collect(),
        Format::R8G8 => p.chunks_exact(2).map(|c| [c[0], c[0], c[0], c[1]]).collect(),
        Format::R8G8B8 => p.chunks_exact(3).map(|c| [c[0], c[1], c[2], 255]).collect(),
        Format::R8G8B8A8 => p.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect(),
        // The high bytes of little-endian 16-bit values.
        Format::R16G16B16 => p.chunks_exact(6).map(|c| [c[1], c[3], c[5], 255]).collect(),
        Format::R16G16B16A16 => p.chunks_exact(8).map(|c| [c[1], c[3], c[5], c[7]]).collect(),
        other => return Err(format!("expected 8 or 16 bits of RGB or RGBA, found {other:?}")),
    };
    let texture = Texture { width: data.width, height: data.height, data: data8 };
    let texels = u64::from(texture.width) * u64::from(texture.height);
    if texels == 0 || texture.data.len() as u64 != texels {
        return Err(format!("expected {texels} texels, found {}", texture.data.len()));
    }
    Ok(texture)
}

/// The crate's readers trust the types and may overflow: all that is checked before.
fn check_accessor(
    accessor: &gltf::Accessor<'_>,
    what: &str,
    dimensions: gltf::accessor::Dimensions,
    types: &[gltf::accessor::DataType],
) -> Result<(), String> {
    if accessor.dimensions() != dimensions || !types.contains(&accessor.data_type()) {
        return Err(format!(
            "{what}: expected {dimensions:?} of {types:?}, found {:?} of {:?}",
            accessor.dimensions(),
            accessor.data_type()
        ));
    }
    if accessor.sparse().is_some() {
        return Err(format!("{what}: sparse accessors are not supported"));
    }
    let Some(view) = accessor.view() else {
        return Err(format!("{what}: has no data (compressed meshes are not supported)"));
    };
    let size = accessor.size();
    let stride = view.stride().unwrap_or(size);
    let end = accessor
        .count()
        .checked_sub(1)
        .and_then(|last| last.checked_mul(stride))
        .and_then(|bytes| bytes.checked_add(size))
        .and_then(|bytes| bytes.checked_add(accessor.offset()));
    if stride < size || end.is_none_or(|end| end > view.length()) {
        return Err(format!(
            "{what}: {} elements {stride} bytes apart do not fit in {} bytes",
            accessor.count(),
            view.length()
        ));
    }
    Ok(())
}

fn gltf_mesh(
    primitive: &gltf::Primitive<'_>,
    buffers: &[gltf::buffer::Data],
) -> Result<Mesh, String> {
    use gltf::Semantic;
    use gltf::accessor::{DataType, Dimensions};
    let check = |semantic, what, dimensions, types: &[DataType]| match primitive.get(&semantic) {
        Some(accessor) => check_accessor(&accessor, what, dimensions, types).map(|()| true),
        None => Ok(false),
    };
    if !check(Semantic::Positions, "POSITION", Dimensions::Vec3, &[DataType::F32])? {
        return Err("has no positions".into());
    }
    let has_normals = check(Semantic::Normals, "NORMAL", Dimensions::Vec3, &[DataType::F32])?;
    let types = [DataType::F32, DataType::U8, DataType::U16];
    let set = primitive.material().pbr_metallic_roughness().base_color_texture();
    let set = set.map_or(0, |info| info.tex_coord());
    let has_uvs = check(Semantic::TexCoords(set), "TEXCOORD", Dimensions::Vec2, &types)?;
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| &data.0[..]));
    let mut mesh = Mesh {
        positions: reader.read_positions().ok_or("positions cannot be read")?.collect(),
        ..Mesh::default()
    };
    let count = mesh.positions.len();
    if let (true, Some(normals)) = (has_normals, reader.read_normals()) {
        mesh.normals = normals.collect();
    }
    if let (true, Some(uvs)) = (has_uvs, reader.read_tex_coords(set)) {
        mesh.uvs = uvs.into_f32().collect();
    }
    for (found, what) in [(mesh.normals.len(), "normals"), (mesh.uvs.len(), "coordinates")] {
        if found != 0 && found != count {
            return Err(format!("expected {count} {what}, found {found}"));
        }
    }
    mesh.indices = match primitive.indices() {
        Some(accessor) => {
            let types = [DataType::U8, DataType::U16, DataType::U32];
            check_accessor(&accessor, "indices", Dimensions::Scalar, &types)?;
            reader.read_indices().ok_or("indices cannot be read")?.into_u32().collect()
        }
        None => (0..u32::try_from(count).map_err(|_| "more than 2^32 vertices")?).collect(),
    };
    if let Some(bad) = mesh.indices.iter().find(|&&i| i as usize >= count) {
        return Err(format!("expected indices below {count}, found {bad}"));
    }
    mesh.indices.truncate(mesh.indices.len() / 3 * 3);
    if mesh.normals.is_empty() {
        make_normals(&mut mesh);
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    const JSON: &str = r#"{"boxes":[
        {"name":"basin floor","material":"concrete","centre":[0,-0.05,0],"half":[1,0.05,1]},
        {"name":"basin wall","material":"concrete","centre":[0.95,0.3,0],"half":[0.05,0.3,1]}],
        "cylinders":[{"material":"stone","centre":[0,1,0],"radius":0.2,"height":1}],
        "ground":{"y":-0.1,"material":"ground"},"fluid":{"pool_level":0.2}}"#;

    #[test]
    fn json_lines_the_basin() {
        let scene = Scene::parse_json(JSON.as_bytes()).expect("good");
        let lined: Vec<_> = scene
            .meshes
            .iter()
            .filter(|m| matches!(m.material.pattern, Pattern::Tiles { band: Some(_), .. }))
            .flat_map(|m| &m.normals)
            .collect();
        // The floor's top and the wall's inner face, four vertices each.
        assert_eq!(lined.len(), 8);
        assert!(lined.contains(&&[0.0, 1.0, 0.0]) && lined.contains(&&[-1.0, 0.0, 0.0]));
    }

    #[test]
    fn bad_json_says_what_is_wrong() {
        for (from, to, says) in [
            ("\"stone\"", "\"cheese\"", "'cheese'"),
            ("\"radius\":0.2", "\"radius\":-1", "more than 0"),
            ("\"half\":[1,0.05,1]", "\"half\":[1,0.05]", "length 2"),
            ("\"y\":-0.1", "\"y\":\"low\"", "string"),
        ] {
            let why = Scene::parse_json(JSON.replacen(from, to, 1).as_bytes()).expect_err(from);
            assert!(why.contains(says), "{why}");
        }
    }

    #[test]
    fn obj_reads_all_kinds_of_corners() {
        let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\
                   f 1/1/1 2/1/1 3//1 -1//-1 # a quad\n";
        let scene = Scene::parse_obj(obj.as_bytes()).expect("good");
        assert_eq!(scene.meshes[0].indices, [0, 1, 2, 0, 2, 3]);
        assert!(scene.meshes[0].normals.iter().all(|n| *n == [0.0, 0.0, 1.0]));
        let bare = Scene::parse_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").expect("good");
        assert!(bare.meshes[0].normals.iter().all(|n| *n == [0.0, 0.0, 1.0]));
    }

    #[test]
    fn bad_obj_says_which_line() {
        for bad in [
            "v 0 0\n",
            "v 0 0 nan\n",
            "v 0 0 0\nf 1 1 2\n",
            "v 0 0 0\nf 0 1 1\n",
            "v 0 0 0\nf 1 1 -2\n",
            "v 0 0 0\nf 1 1 1/\u{fe}\n",
            "v 0 0 0\nf 1/1/1/1 1 1\n",
            "v 0 0 0\nf 1 1\n",
            "v 0 0 0\nf -9223372036854775808 1 1\n",
        ] {
            let why = Scene::parse_obj(bad.as_bytes()).expect_err(bad);
            assert!(why.starts_with("line "), "{why}");
        }
        assert!(Scene::parse_obj(b"\xff\xfe\x00").is_err());
    }

    /// A triangle with every byte broken in turn: errors or meshes, never a panic.
    #[test]
    fn broken_glb_is_an_error() {
        let json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
            "nodes":[{"mesh":0,"children":[1]},{"translation":[1,2,3]}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
            "min":[0,0,0],"max":[1,1,0]},
            {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
            "bufferViews":[{"buffer":0,"byteLength":36},
            {"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[{"byteLength":44}]}"#;
        let mut text = json.as_bytes().to_vec();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut data = Vec::new();
        for v in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
            data.extend(v.to_le_bytes());
        }
        data.extend([0, 0, 1, 0, 2, 0, 0, 0]);
        let mut glb = b"glTF".to_vec();
        glb.extend(2_u32.to_le_bytes());
        glb.extend((28 + text.len() as u32 + data.len() as u32).to_le_bytes());
        glb.extend((text.len() as u32).to_le_bytes());
        glb.extend(b"JSON");
        glb.extend(&text);
        glb.extend((data.len() as u32).to_le_bytes());
        glb.extend(b"BIN\0");
        glb.extend(&data);
        let scene = Scene::parse_glb(&glb, None).expect("good");
        assert_eq!(scene.meshes[0].indices, [0, 1, 2]);
        assert_eq!(scene.meshes[0].normals[0], [0.0, 0.0, 1.0]);
        for i in 0..glb.len() {
            for value in [0, 1, b'0', b'9', b'-', b'"', 0x7f, 0xff] {
                let mut broken = glb.clone();
                broken[i] = value;
                let _ = Scene::parse_glb(&broken, None);
            }
            let _ = Scene::parse_glb(&glb[..i], None);
        }
    }
}
