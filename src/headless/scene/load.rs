//! Reads scene files: glTF binary, Wavefront OBJ, and the project's own JSON. A bad file gives an error that
//! says what was expected and what was found; no file makes the reader panic.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::{Mat4, Vec3};
use serde::Deserialize;
use serde::de::IgnoredAny;

use super::shapes::{FACES, quaternion};
use super::{Ground, Material, Mesh, Motion, Pattern, Scene, SunLight, Viewpoint};
use crate::environment::Sky;
use crate::water::{MAX_PANES, Pane};

/// A scene file that could not be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {why}", path.display())]
pub struct SceneError {
    /// The file.
    pub path: PathBuf,
    /// What was expected and what was found.
    pub why: String,
}

/// Max number of vertices, and of triangles, in a file.
pub(super) const MOST: usize = 20_000_000;

impl Scene {
    /// Reads a scene by its file's extension: `.glb`, `.gltf`, `.obj` or `.json`.
    ///
    /// # Errors
    /// Another extension, or an error of the format's loader.
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

    /// Reads the default scene of a glTF file (`.glb`, or `.gltf` with the files that it names): triangles, base
    /// colours, base colour textures and roughness. If the file names no default scene, it is the first one.
    ///
    /// # Errors
    /// The file cannot be read, is no glTF 2.0, has no triangles, requires an unsupported extension, or uses an
    /// unsupported feature: sparse, compressed or base64 data.
    pub fn load_glb(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|error| at(path, error.to_string()))?;
        super::gltf::parse(&bytes, path.parent()).map_err(|why| at(path, why))
    }

    /// Reads a glTF scene from memory, without other files.
    ///
    /// # Errors
    /// Those of [`load_glb`](Self::load_glb), and references to other files.
    pub fn parse_glb(bytes: &[u8]) -> Result<Self, String> {
        super::gltf::parse(bytes, None)
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

    /// Reads a Wavefront file from memory.
    ///
    /// # Errors
    /// The text is no valid Wavefront OBJ, or has no faces: the error says what was expected, what was found, and for a
    /// bad line its number.
    pub fn parse_obj(bytes: &[u8]) -> Result<Self, String> {
        super::obj::parse(bytes)
    }

    /// Reads the project's own format: boxes, cylinders and tubes, which may be rotated, spheres, a ground, a camera
    /// and a sun. Each entry of `motion` lists the names of shapes that move together, and gives one pose for each
    /// frame. Two or more boxes whose names begin with `basin` form a basin: the faces that look into it are tiled,
    /// except those of rotated boxes. If `fluid` has a `pool_level`, there is a row of darker tiles at this height.
    /// `panes` lists panes of glass that hold the water ([`Pane`]: `corner` and `edges`).
    ///
    /// # Errors
    /// The file cannot be read, is no JSON of this form, has an unknown key or another unit than metres, has neither
    /// shapes nor a ground, names an unknown material or part, has a value out of range, such as a radius of 0, or
    /// more than [`MAX_PANES`] panes.
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
#[serde(deny_unknown_fields)]
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
    #[serde(default)]
    motion: Vec<FileMotion>,
    #[serde(default)]
    panes: Vec<FilePane>,
    /// Begins with "metres".
    units: Option<String>,
    // For people who read the file.
    #[serde(rename = "name")]
    _name: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
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
#[serde(deny_unknown_fields)]
struct FileCylinder {
    #[serde(default)]
    name: String,
    material: String,
    centre: [f32; 3],
    radius: f32,
    height: f32,
    #[serde(default = "no_rotation")]
    rotation: [f32; 4],
    bore: Option<f32>,
    #[serde(default)]
    slope: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileSphere {
    #[serde(default)]
    name: String,
    material: String,
    centre: [f32; 3],
    radius: f32,
}

/// Parts that move together. Each frame has a pose: the position of the body's origin (x y z) and the rotation
/// about it (quaternion x y z w). A pose is applied to the parts as they are listed, not to the previous pose.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileMotion {
    parts: Vec<String>,
    origin: [f32; 3],
    #[serde(default)]
    first_frame: u64,
    poses: Vec<[f32; 7]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FilePane {
    corner: [f32; 3],
    edges: [[f32; 3]; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileGround {
    y: f32,
    material: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileCamera {
    eye: [f32; 3],
    target: [f32; 3],
    #[serde(default = "y_up")]
    up: [f32; 3],
    fov_y_degrees: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileFluid {
    pool_level: Option<f32>,
    // Of the solver.
    #[serde(rename = "rest_density")]
    _rest_density: Option<IgnoredAny>,
    #[serde(rename = "spacing")]
    _spacing: Option<IgnoredAny>,
    #[serde(rename = "support")]
    _support: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
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
    /// The same as [`from_json`](Self::from_json) from memory.
    ///
    /// # Errors
    /// The error says what was expected and what was found.
    pub fn parse_json(bytes: &[u8]) -> Result<Self, String> {
        let file: File = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        if let Some(units) = file.units.filter(|units| !units.starts_with("metres")) {
            return Err(format!("units: expected \"metres\", found \"{units}\""));
        }
        let shapes = file.boxes.len() + file.cylinders.len() + file.spheres.len();
        if shapes == 0 && file.ground.is_none() {
            return Err("expected boxes, cylinders, spheres or a ground, found none".into());
        }
        let material = |name: &str, of: &str| {
            Material::named(name).ok_or_else(|| {
                format!(
                    "material of '{of}': expected one of {}, found '{name}'",
                    Material::NAMES.join(", ")
                )
            })
        };
        let positive = |value: f32, what: &str, of: &str| {
            // A JSON number beyond the range of f32 becomes infinite.
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
        // Numbers beyond single precision are read as infinite.
        let finite = |values: &[f32], what: &str, name: &str| {
            let fine = values.iter().all(|v| v.is_finite());
            fine.then_some(())
                .ok_or(format!("{what} of '{name}': expected finite numbers, found {values:?}"))
        };
        for part in &file.boxes {
            for (half, what) in part.half.into_iter().zip(["half[0]", "half[1]", "half[2]"]) {
                positive(half, what, &part.name)?;
            }
            finite(&part.centre, "centre", &part.name)?;
            finite(&part.rotation, "rotation", &part.name)?;
            let outside = material(&part.material, &part.name)?;
            let (centre, half) = (Vec3::from(part.centre), Vec3::from(part.half));
            // A face belongs to the inside of the basin if it lies within the basin's bounds and faces the
            // centre of these bounds.
            let inner = |face: usize| {
                let normal = FACES[face];
                let at = centre + normal * half;
                let (a, b) =
                    (at.dot(normal.abs()), (low.dot(normal.abs()), high.dot(normal.abs())));
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
        if file.panes.len() > MAX_PANES {
            return Err(format!("panes: expected {MAX_PANES} at most, found {}", file.panes.len()));
        }
        for (i, FilePane { corner, edges }) in file.panes.into_iter().enumerate() {
            let pane = Pane { corner, edges };
            pane.check().map_err(|found| {
                format!("panes[{i}]: expected finite numbers and edges that are not parallel, found {found}")
            })?;
            scene.panes.push(pane);
        }
        for part in file.cylinders {
            positive(part.radius, "radius", &part.name)?;
            positive(part.height, "height", &part.name)?;
            finite(&part.centre, "centre", &part.name)?;
            finite(&part.rotation, "rotation", &part.name)?;
            let material = material(&part.material, &part.name)?;
            let mesh = match part.bore {
                Some(bore) if !(bore > 0.0 && bore < part.radius) => {
                    return Err(format!(
                        "bore of '{}': expected more than 0 and less than the radius, found {bore}",
                        part.name
                    ));
                }
                Some(bore) => {
                    let radii = [part.radius, bore];
                    Mesh::tube(part.centre, radii, part.height, part.slope, material)
                }
                None => Mesh::cylinder(part.centre, part.radius, part.height, material),
            };
            let transform = mesh.transform * Mat4::from_quat(quaternion(part.rotation));
            scene.meshes.push(Mesh { name: part.name, transform, ..mesh });
        }
        for part in file.spheres {
            positive(part.radius, "radius", &part.name)?;
            finite(&part.centre, "centre", &part.name)?;
            let material = material(&part.material, &part.name)?;
            scene
                .meshes
                .push(Mesh { name: part.name, ..Mesh::sphere(part.centre, part.radius, material) });
        }
        for motion in file.motion {
            let mut meshes = Vec::new();
            for part in &motion.parts {
                let named = (0..scene.meshes.len()).filter(|i| scene.meshes[*i].name == *part);
                let before = meshes.len();
                meshes.extend(named);
                if meshes.len() == before {
                    return Err(format!("motion: expected the name of a part, found '{part}'"));
                }
            }
            let origin = Mat4::from_translation(-Vec3::from(motion.origin));
            let pose = |[x, y, z, turn @ ..]: &[f32; 7]| {
                let at = Vec3::new(*x, *y, *z);
                let pose = Mat4::from_rotation_translation(quaternion(*turn), at) * origin;
                let fine = pose.is_finite();
                fine.then_some(pose).ok_or("motion: expected poses of numbers, found infinite ones")
            };
            let poses = motion.poses.iter().map(pose).collect::<Result<_, _>>()?;
            scene.motions.push(Motion { meshes, first_frame: motion.first_frame, poses });
        }
        if let Some(ground) = file.ground {
            finite(&[ground.y], "y", "ground")?;
            let material = material(&ground.material, "ground")?;
            scene.ground = Some(Ground { y: ground.y, material, reach: None });
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
            scene.sun =
                SunLight::of(&Sky { sun: direction.to_array(), intensity, ..Sky::default() });
        }
        Ok(scene)
    }
}

/// Makes normals for a mesh that has none: smooth where the normals of two faces differ by less than 40
/// degrees, sharp elsewhere.
pub(super) fn make_normals(mesh: &mut Mesh) {
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
                // At most 64 faces count at a vertex, so that the time stays bounded; a vertex with more lies
                // on no smooth surface.
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

#[cfg(test)]
mod tests {
    use super::*;

    const JSON: &str = r#"{"boxes":[
        {"name":"basin floor","material":"concrete","centre":[0,-0.05,0],"half":[1,0.05,1]},
        {"name":"basin wall","material":"concrete","centre":[0.95,0.3,0],"half":[0.05,0.3,1]}],
        "cylinders":[{"material":"stone","centre":[0,1,0],"radius":0.2,"height":1}],
        "ground":{"y":-0.1,"material":"ground"},"fluid":{"pool_level":0.2}}"#;

    #[test]
    fn json_lists_panes() {
        let one = r#"{"corner":[1,2,3],"edges":[[1,0,0],[0,2,0.5]]}"#;
        let with = |n: usize| {
            let list = vec![one; n].join(",");
            JSON.replacen("{\"boxes\"", &format!("{{\"panes\":[{list}],\"boxes\""), 1)
        };
        let scene = Scene::parse_json(with(1).as_bytes()).expect("good");
        let edges = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.5]];
        assert_eq!(scene.panes, [Pane { corner: [1.0, 2.0, 3.0], edges }]);
        let scene = Scene::parse_json(with(MAX_PANES).as_bytes()).expect("good");
        assert_eq!(scene.panes.len(), MAX_PANES);
        let why = Scene::parse_json(with(MAX_PANES + 1).as_bytes()).expect_err("too many");
        assert!(why.contains("8 at most, found 9"), "{why}");
    }

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
    fn parts_move_from_frame_to_frame() {
        let json = r#"{"cylinders":[
            {"name":"pipe","material":"bamboo","centre":[2,0,0],"radius":0.2,"bore":0.1,"height":1,
             "slope":0.5,"rotation":[0,0,0.70710678,0.70710678]},
            {"name":"post","material":"timber","centre":[0,0,0],"radius":0.2,"height":1}],
            "motion":[{"parts":["pipe"],"origin":[1,0,0],"first_frame":5,"poses":[
                [1,0,0,0,0,0,1],[1,3,0,0,0,0.70710678,0.70710678]]}]}"#;
        let mut scene = Scene::parse_json(json.as_bytes()).expect("good");
        let mut middle = |frame| {
            scene.frame = frame;
            [0, 1].map(|mesh| {
                let pose = scene.pose(mesh).unwrap_or_default();
                pose.transform_point3(scene.meshes[mesh].transform.transform_point3(Vec3::ZERO))
            })
        };
        let near = |a: [Vec3; 2], b: [[f32; 3]; 2]| {
            assert!(a.iter().zip(b).all(|(a, b)| a.distance(b.into()) < 1e-5), "{a:?} {b:?}");
        };
        // Before the first and after the last pose these stay constant.
        near(middle(0), [[2.0, 0.0, 0.0], [0.0; 3]]);
        near(middle(5), [[2.0, 0.0, 0.0], [0.0; 3]]);
        near(middle(6), [[1.0, 4.0, 0.0], [0.0; 3]]);
        near(middle(99), [[1.0, 4.0, 0.0], [0.0; 3]]);
        assert!(scene.rests_between(0, 5) && !scene.rests_between(5, 6));
        let (low, high) = scene.bounds();
        assert!(low.x < -0.19 && high.x > 2.2 && high.y > 4.4, "of all frames: {low} {high}");
    }

    #[test]
    fn bad_json_says_what_is_wrong() {
        for (from, to, says) in [
            ("\"stone\"", "\"cheese\"", "'cheese'"),
            ("\"radius\":0.2", "\"radius\":-1", "more than 0"),
            ("\"half\":[1,0.05,1]", "\"half\":[1,0.05]", "length 2"),
            ("\"y\":-0.1", "\"y\":\"low\"", "string"),
            (
                "\"radius\":0.2",
                "\"radius\":0.2,\"color\":1",
                "unknown field `color`, expected one of",
            ),
            ("{\"boxes\"", "{\"parts\":[],\"boxes\"", "unknown field `parts`"),
            ("{\"boxes\"", "{\"units\":\"mm\",\"boxes\"", "found \"mm\""),
            ("\"radius\":0.2", "\"radius\":0.2,\"bore\":0.3", "less than the radius"),
            (
                "{\"boxes\"",
                "{\"motion\":[{\"parts\":[\"x\"],\"origin\":[0,0,0],\"poses\":[]}],\"boxes\"",
                "'x'",
            ),
            (
                "{\"boxes\"",
                "{\"panes\":[{\"corner\":[0,0,0],\"edges\":[[1,0,0],[2,0,0]]}],\"boxes\"",
                "panes[0]: expected finite numbers and edges that are not parallel, found edges without",
            ),
        ] {
            let why = Scene::parse_json(JSON.replacen(from, to, 1).as_bytes()).expect_err(from);
            assert!(why.contains(says), "{why}");
        }
        let why = Scene::parse_json(b"{\"name\":\"nothing\"}").expect_err("empty");
        assert!(why.contains("expected boxes, cylinders, spheres or a ground"), "{why}");
    }
}
