//! Reads glTF 2.0: triangles, base colours and base-colour textures. The reader is our own, because the gltf
//! crate (1.4) panics on some damaged files, for example on a component type that does not fit its use, and
//! does not report data that lie outside their buffer. The `image` crate decodes images.

use std::collections::{HashMap, HashSet};
use std::path::{Component, Path};
use std::sync::Arc;

use glam::{Mat4, Quat, Vec3};
use serde::Deserialize;

use super::load::{MOST, make_normals};
use super::{Material, Mesh, Pattern, Scene, Texture};

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
#[derive(Default)]
struct Document {
    scene: Option<usize>,
    scenes: Vec<Root>,
    nodes: Vec<Node>,
    meshes: Vec<GltfMesh>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<View>,
    buffers: Vec<GltfBuffer>,
    materials: Vec<GltfMaterial>,
    textures: Vec<GltfTexture>,
    images: Vec<GltfImage>,
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
struct Root {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
struct Node {
    name: Option<String>,
    mesh: Option<usize>,
    #[serde(default)]
    children: Vec<usize>,
    matrix: Option<[f32; 16]>,
    translation: Option<[f32; 3]>,
    rotation: Option<[f32; 4]>,
    scale: Option<[f32; 3]>,
}

#[derive(Deserialize)]
struct GltfMesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: HashMap<String, usize>,
    indices: Option<usize>,
    material: Option<usize>,
    mode: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    normalized: bool,
    sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct View {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

#[derive(Deserialize)]
struct GltfBuffer {
    uri: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct GltfMaterial {
    pbr_metallic_roughness: Option<Pbr>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Pbr {
    base_color_factor: Option<[f32; 4]>,
    base_color_texture: Option<TextureInfo>,
    roughness_factor: Option<f32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct TextureInfo {
    index: usize,
    #[serde(default)]
    tex_coord: u32,
}

#[derive(Deserialize)]
struct GltfTexture {
    source: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct GltfImage {
    uri: Option<String>,
    buffer_view: Option<usize>,
}

/// Extensions that do not affect what is read here.
const HARMLESS: &[&str] = &["KHR_materials_unlit", "KHR_materials_specular", "KHR_materials_ior"];

pub fn parse(bytes: &[u8], folder: Option<&Path>) -> Result<Scene, String> {
    let (json, blob) = chunks(bytes)?;
    let document: Document =
        serde_json::from_slice(json).map_err(|error| format!("glTF: {error}"))?;
    if let Some(other) =
        document.extensions_required.iter().find(|e| !HARMLESS.contains(&e.as_str()))
    {
        return Err(format!("needs the extension {other}, which is not supported"));
    }
    let mut buffers = Vec::new();
    for (index, buffer) in document.buffers.iter().enumerate() {
        buffers.push(match (&buffer.uri, blob) {
            (None, Some(blob)) if index == 0 => blob.to_vec(),
            (None, _) => {
                return Err(format!("buffer {index}: expected data in the file's BIN chunk"));
            }
            (Some(uri), _) => file(folder, uri).map_err(|e| format!("buffer {index}: {e}"))?,
        });
    }
    let reader = Reader { document: &document, buffers, folder };
    let mut scene = Scene::default();
    let roots: Vec<usize> = match at(&document.scenes, document.scene.unwrap_or(0), "scene") {
        Ok(scene) => scene.nodes.clone(),
        Err(_) if document.scenes.is_empty() => {
            let children: HashSet<usize> =
                document.nodes.iter().flat_map(|node| node.children.iter().copied()).collect();
            (0..document.nodes.len()).filter(|node| !children.contains(node)).collect()
        }
        Err(error) => return Err(error),
    };
    let mut images = HashMap::new();
    let mut stack: Vec<_> = roots.into_iter().map(|node| (node, Mat4::IDENTITY, 0)).collect();
    let (mut visited, mut size) = (0, 0);
    while let Some((index, parent, depth)) = stack.pop() {
        visited += 1;
        let node = at(&document.nodes, index, "node")?;
        let transform = parent * node.transform();
        // A graph that is not a tree would be walked without end; in a tree each node is visited once.
        let waiting = stack.len() + node.children.len();
        if depth > 256 || visited + waiting > document.nodes.len() {
            return Err("nodes are nested more than 256 deep, or have more than one parent".into());
        }
        stack.extend(node.children.iter().map(|&child| (child, transform, depth + 1)));
        let Some(mesh) = node.mesh else { continue };
        for primitive in &at(&document.meshes, mesh, "mesh")?.primitives {
            // Mode 4 is a list of triangles.
            if primitive.mode.unwrap_or(4) != 4 {
                continue;
            }
            let name = node.name.clone().unwrap_or_else(|| format!("mesh {mesh}"));
            let mesh =
                reader.mesh(primitive, &mut images).map_err(|why| format!("'{name}': {why}"))?;
            size += mesh.positions.len() + mesh.indices.len() / 3;
            if size > MOST {
                return Err(format!("more than {MOST} vertices and triangles"));
            }
            scene.meshes.push(Mesh { name, transform, ..mesh });
        }
    }
    if scene.meshes.is_empty() {
        return Err("expected a mesh of triangles, found none".into());
    }
    Ok(scene)
}

/// The JSON chunk and the BIN chunk of a `.glb`; a `.gltf` file is JSON only.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else { return Ok((bytes, None)) };
    let word = |bytes: &[u8]| -> Option<usize> {
        Some(u32::from_le_bytes(bytes.get(..4)?.try_into().ok()?) as usize)
    };
    match word(rest) {
        Some(2) => {}
        Some(version) => return Err(format!("expected glTF version 2, found {version}")),
        None => return Err("expected a header of 12 bytes, found the end of the file".into()),
    }
    let mut rest = rest.get(8..).unwrap_or_default();
    let (mut json, mut blob) = (None, None);
    while let Some(length) = word(rest) {
        let (Some(kind), Some(data)) =
            (rest.get(4..8), rest.get(8..).and_then(|r| r.get(..length)))
        else {
            return Err(format!("expected a chunk of {length} bytes, found the end of the file"));
        };
        match kind {
            b"JSON" if json.is_none() => json = Some(data),
            b"BIN\0" if blob.is_none() => blob = Some(data),
            _ => {}
        }
        rest = &rest[8 + length..];
    }
    Ok((json.ok_or("expected a JSON chunk, found none")?, blob))
}

fn at<'a, T>(list: &'a [T], index: usize, what: &str) -> Result<&'a T, String> {
    list.get(index).ok_or_else(|| format!("expected a {what} below {}, found {index}", list.len()))
}

/// Reads a file in the scene's folder.
fn file(folder: Option<&Path>, uri: &str) -> Result<Vec<u8>, String> {
    let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if uri.contains(':') || uri.contains('%') || !Path::new(uri).components().all(inside) {
        let start: String = uri.chars().take(24).collect();
        return Err(format!(
            "expected the plain name of a file in the scene's folder, found '{start}'"
        ));
    }
    let folder = folder.ok_or_else(|| format!("expected all in one file, found '{uri}'"))?;
    let path = folder.join(uri);
    std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
}

impl Node {
    fn transform(&self) -> Mat4 {
        if let Some(matrix) = &self.matrix {
            return Mat4::from_cols_array(matrix);
        }
        let rotation = Quat::from_array(self.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
        let unit = (rotation.length_squared() - 1.0).abs() < 0.1;
        Mat4::from_scale_rotation_translation(
            self.scale.unwrap_or([1.0; 3]).into(),
            if unit { rotation.normalize() } else { Quat::IDENTITY },
            self.translation.unwrap_or_default().into(),
        )
    }
}

struct Reader<'a> {
    document: &'a Document,
    buffers: Vec<Vec<u8>>,
    folder: Option<&'a Path>,
}

impl Reader<'_> {
    /// The bytes of a buffer view, and its stride if it has one.
    fn view(&self, index: usize) -> Result<(&[u8], Option<usize>), String> {
        let view = at(&self.document.buffer_views, index, "buffer view")?;
        let buffer = at(&self.buffers, view.buffer, "buffer")?;
        let bytes = buffer.get(view.byte_offset..).and_then(|rest| rest.get(..view.byte_length));
        let bytes = bytes.ok_or_else(|| {
            format!(
                "buffer view {index}: {} bytes from {} on, in a buffer of {}",
                view.byte_length,
                view.byte_offset,
                buffer.len()
            )
        })?;
        Ok((bytes, view.byte_stride))
    }

    /// Reads the elements of an accessor, which have `N` components each. `convert` gets the component type, whether it
    /// is normalized, and the bytes of one component; it returns `None` if the type is not allowed.
    fn read<T: Copy + Default, const N: usize>(
        &self,
        index: usize,
        kind: &str,
        convert: impl Fn(u32, bool, &[u8]) -> Option<T>,
    ) -> Result<Vec<[T; N]>, String> {
        let accessor = at(&self.document.accessors, index, "accessor")?;
        if accessor.kind != kind {
            return Err(format!("accessor {index}: expected {kind}, found {}", accessor.kind));
        }
        let size = match accessor.component_type {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            other => return Err(format!("accessor {index}: unknown component type {other}")),
        };
        if accessor.sparse.is_some() {
            return Err(format!("accessor {index}: sparse data is not supported"));
        }
        let view = accessor.buffer_view.ok_or_else(|| {
            format!("accessor {index}: has no data (compressed meshes are not supported)")
        })?;
        let (bytes, stride) = self.view(view)?;
        let stride = stride.unwrap_or(N * size);
        let last = accessor.count.checked_sub(1).and_then(|n| n.checked_mul(stride));
        let end = last
            .and_then(|last| last.checked_add(accessor.byte_offset))
            .and_then(|start| start.checked_add(N * size));
        // With stride 0, a few bytes could give any number of elements.
        if stride < N * size || end.is_none_or(|end| end > bytes.len()) {
            return Err(format!(
                "accessor {index}: {} elements, {stride} bytes apart, in {} bytes",
                accessor.count,
                bytes.len()
            ));
        }
        let mut out = Vec::with_capacity(accessor.count);
        for element in 0..accessor.count {
            let start = accessor.byte_offset + element * stride;
            let mut value = [T::default(); N];
            for (k, component) in value.iter_mut().enumerate() {
                let raw = &bytes[start + k * size..start + (k + 1) * size];
                *component = convert(accessor.component_type, accessor.normalized, raw)
                    .ok_or_else(|| {
                        format!(
                            "accessor {index}: component type {} is not allowed here",
                            accessor.component_type
                        )
                    })?;
            }
            out.push(value);
        }
        Ok(out)
    }

    fn mesh(
        &self,
        primitive: &Primitive,
        images: &mut HashMap<usize, Arc<Texture>>,
    ) -> Result<Mesh, String> {
        let (material, set) = match primitive.material {
            Some(index) => {
                self.material(at(&self.document.materials, index, "material")?, images)?
            }
            None => (Material::default(), 0),
        };
        let position = primitive.attributes.get("POSITION").ok_or("has no positions")?;
        let mut mesh =
            Mesh { positions: self.read(*position, "VEC3", float)?, material, ..Mesh::default() };
        let count = mesh.positions.len();
        if let Some(&normals) = primitive.attributes.get("NORMAL") {
            mesh.normals = self.read(normals, "VEC3", float)?;
            for normal in &mut mesh.normals {
                *normal = Vec3::from(*normal).normalize_or(Vec3::Y).to_array();
            }
        }
        if let Some(&uvs) = primitive.attributes.get(&format!("TEXCOORD_{set}")) {
            mesh.uvs = self.read(uvs, "VEC2", float)?;
        }
        for (found, what) in [(mesh.normals.len(), "normals"), (mesh.uvs.len(), "coordinates")] {
            if found != 0 && found != count {
                return Err(format!("expected {count} {what}, found {found}"));
            }
        }
        mesh.indices = match primitive.indices {
            Some(index) => {
                let indices: Vec<[u32; 1]> = self.read(index, "SCALAR", integer)?;
                indices.into_iter().map(|[i]| i).collect()
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

    /// The material, and the index of the texture coordinates that it uses.
    fn material(
        &self,
        material: &GltfMaterial,
        images: &mut HashMap<usize, Arc<Texture>>,
    ) -> Result<(Material, u32), String> {
        let Some(pbr) = &material.pbr_metallic_roughness else {
            return Ok((Material::new([1.0; 3], 1.0, Pattern::Plain), 0));
        };
        let [r, g, b, _] = pbr.base_color_factor.unwrap_or([1.0; 4]);
        let roughness = pbr.roughness_factor.unwrap_or(1.0);
        let mut made = Material::new([r, g, b], roughness, Pattern::Plain);
        let Some(info) = &pbr.base_color_texture else { return Ok((made, 0)) };
        let texture = at(&self.document.textures, info.index, "texture")?;
        // A texture without a source belongs to an optional extension.
        if let Some(source) = texture.source {
            if let std::collections::hash_map::Entry::Vacant(entry) = images.entry(source) {
                let image = at(&self.document.images, source, "image")?;
                let read = self.image(image).map_err(|e| format!("image {source}: {e}"))?;
                entry.insert(Arc::new(read));
            }
            made.texture = images.get(&source).cloned();
        }
        Ok((made, info.tex_coord))
    }

    fn image(&self, image: &GltfImage) -> Result<Texture, String> {
        let read;
        let bytes = match (&image.uri, image.buffer_view) {
            (_, Some(view)) => self.view(view)?.0,
            (Some(uri), None) => {
                read = file(self.folder, uri)?;
                &read
            }
            (None, None) => return Err("has neither data nor a file".into()),
        };
        let picture = image::load_from_memory(bytes).map_err(|error| error.to_string())?.to_rgba8();
        Ok(Texture {
            width: picture.width(),
            height: picture.height(),
            data: picture.pixels().map(|p| p.0).collect(),
        })
    }
}

fn float(kind: u32, normalized: bool, raw: &[u8]) -> Option<f32> {
    match (kind, raw) {
        (5126, &[a, b, c, d]) => Some(f32::from_le_bytes([a, b, c, d])),
        (5121, &[a]) if normalized => Some(f32::from(a) / 255.0),
        (5123, &[a, b]) if normalized => Some(f32::from(u16::from_le_bytes([a, b])) / 65535.0),
        _ => None,
    }
}

fn integer(kind: u32, _: bool, raw: &[u8]) -> Option<u32> {
    match (kind, raw) {
        (5121, &[a]) => Some(a.into()),
        (5123, &[a, b]) => Some(u16::from_le_bytes([a, b]).into()),
        (5125, &[a, b, c, d]) => Some(u32::from_le_bytes([a, b, c, d])),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with one triangle, in which each byte is replaced in turn, gives an error or a mesh, never a
    /// panic.
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
        let scene = parse(&glb, None).expect("good");
        assert_eq!(scene.meshes[0].indices, [0, 1, 2]);
        assert_eq!(scene.meshes[0].normals[0], [0.0, 0.0, 1.0]);
        for i in 0..glb.len() {
            for value in [0, 1, b'0', b'9', b'-', b'"', 0x7f, 0xff] {
                let mut broken = glb.clone();
                broken[i] = value;
                let _ = parse(&broken, None);
            }
            let _ = parse(&glb[..i], None);
        }
    }
}
