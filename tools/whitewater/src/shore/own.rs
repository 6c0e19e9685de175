//! A user's strip of shore foam: a mesh whose second texture coordinate is the shore coordinate v.

use std::path::Path;

use whitewater::headless::scene::{Mesh, Scene};

use super::strip::Strip;
use crate::failure::{Failure, Outcome};
use crate::stage;

/// Expectation in errors about v.
const EXPECTED: &str = "expected v as the second texture coordinate of each vertex (TEXCOORD_0 of glTF, vt of OBJ): 0 at the \
                        sea's edge, 1 at the shore line, 2 on the land";

/// Tolerance at the ends of v's range, for rounding.
const SLACK: f32 = 0.01;

/// All meshes of a file as one strip.
pub fn read(path: &Path) -> Outcome<Strip> {
    let scene = stage::read(path)?;
    joined(path, &scene.meshes.iter().collect::<Vec<_>>())
}

/// Removes the meshes whose name contains `strip` from a scene, because they are no land, and returns them as one
/// strip.
pub fn taken(path: &Path, scene: &mut Scene) -> Outcome<Option<Strip>> {
    let is_strip = |mesh: &Mesh| mesh.name.to_lowercase().contains("strip");
    let (own, land): (Vec<_>, Vec<_>) =
        std::mem::take(&mut scene.meshes).into_iter().partition(is_strip);
    scene.meshes = land;
    if own.is_empty() {
        return Ok(None);
    }
    if scene.meshes.is_empty() {
        let why = "nothing but a strip: its land is missing";
        return Err(Failure::input(format!("{}: {why}", path.display())));
    }
    joined(path, &own.iter().collect::<Vec<_>>()).map(Some)
}

/// One strip of all meshes, in world space.
fn joined(path: &Path, meshes: &[&Mesh]) -> Outcome<Strip> {
    let mut strip = Strip::default();
    for mesh in meshes {
        let own = of(mesh, is_obj(path)).map_err(|why| {
            let name = &mesh.name;
            Failure::input(format!("{}: '{name}' {why}; {EXPECTED}", path.display()))
        })?;
        let first = strip.positions.len() as u32;
        strip.positions.extend(own.positions);
        strip.v.extend(own.v);
        strip.indices.extend(own.indices.iter().map(|i| first + i));
    }
    Ok(strip)
}

/// Whether the file's extension is OBJ. For these files the reader turns v to 1 - v, as pictures need it; a strip
/// needs the original v.
fn is_obj(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"))
}

/// Converts a mesh to a strip, or says what is wrong with it.
fn of(mesh: &Mesh, upward: bool) -> Result<Strip, String> {
    if mesh.uvs.len() != mesh.positions.len() {
        return Err("has no texture coordinates".into());
    }
    let along = |uv: &[f32; 2]| if upward { 1.0 - uv[1] } else { uv[1] };
    let mut v: Vec<f32> = mesh.uvs.iter().map(along).collect();
    if v.iter().any(|v| !v.is_finite()) {
        return Err("has a v that is no number".into());
    }
    let (low, high) = v
        .iter()
        .fold((f32::INFINITY, -f32::INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    // glTF counts v from the top of a picture. So exporters such as Blender write 1 - v, which is -1 at the strip's
    // inland edge.
    let turned = (-1.0 - SLACK..-SLACK).contains(&low) && high <= 1.0 + SLACK;
    if turned {
        v.iter_mut().for_each(|v| *v = 1.0 - *v);
    } else if low < -SLACK || high > 2.0 + SLACK {
        return Err(format!("has v from {low} to {high}"));
    }
    if high - low < SLACK {
        return Err(format!("has v of {low} everywhere"));
    }
    let place = |p: &[f32; 3]| mesh.transform.transform_point3((*p).into()).to_array();
    Ok(Strip {
        positions: mesh.positions.iter().map(place).collect(),
        v: v.into_iter().map(|v| v.clamp(0.0, 2.0)).collect(),
        indices: mesh.indices.clone(),
    })
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec3};

    use super::*;

    /// A sheet whose corners have these coordinates.
    fn sheet(name: &str, v: [f32; 4]) -> Mesh {
        Mesh {
            name: name.into(),
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]],
            uvs: v.map(|v| [7.0, v]).to_vec(),
            indices: vec![0, 1, 2, 0, 2, 3],
            transform: Mat4::from_translation(Vec3::new(0.0, 3.0, 0.0)),
            ..Mesh::default()
        }
    }

    #[test]
    fn v_is_what_the_mesh_says_either_way_up() {
        for (upward, v) in [
            (false, [0.0, 1.0, 2.0, 0.5]),
            // With v flipped, as exporters do.
            (false, [1.0, 0.0, -1.0, 0.5]),
            // With v flipped by the OBJ reader.
            (true, [1.0, 0.0, -1.0, 0.5]),
        ] {
            let strip = of(&sheet("s", v), upward).expect("a strip");
            assert_eq!(strip.v, [0.0, 1.0, 2.0, 0.5], "{v:?}");
            assert_eq!(strip.positions[2], [1.0, 3.0, 1.0], "where it is in the world");
        }
    }

    #[test]
    fn a_mesh_without_v_says_so() {
        let none = Mesh { uvs: Vec::new(), ..sheet("s", [0.0; 4]) };
        for (mesh, found) in [
            (none, "has no texture coordinates"),
            (sheet("s", [0.0, 3.0, 1.0, 2.0]), "has v from 0 to 3"),
            (sheet("s", [-1.0, 2.0, 1.0, 0.0]), "has v from -1 to 2"),
            (sheet("s", [1.0; 4]), "has v of 1 everywhere"),
            (sheet("s", [f32::NAN; 4]), "no number"),
        ] {
            let why = of(&mesh, false).expect_err("no strip");
            assert!(why.contains(found), "{why}");
        }
    }

    #[test]
    fn a_strip_of_a_scene_is_no_land() {
        let path = Path::new("island.glb");
        let meshes = vec![sheet("land", [0.0; 4]), sheet("Foam strip", [0.0, 0.0, 2.0, 2.0])];
        let mut scene = Scene { meshes, ..Scene::default() };
        let strip = taken(path, &mut scene).ok().flatten().expect("a strip");
        assert_eq!((strip.v.len(), scene.meshes.len()), (4, 1));
        assert!(taken(path, &mut scene).ok().flatten().is_none(), "it is out of it");
        scene.meshes = vec![sheet("strip", [0.0, 0.0, 2.0, 2.0])];
        assert!(taken(path, &mut scene).is_err(), "there is no land");
    }
}
