//! What stands behind the water: a scene from a file, or a paved ground under it.

use std::path::Path;

use whitewater::headless::scene::{Ground, Material, Mesh, Pattern, Scene};

use crate::bounds::Bounds;
use crate::failure::{Failure, Outcome};

/// Reads a scene.
pub fn read(path: &Path) -> Outcome<Scene> {
    Scene::load(path).map_err(|error| Failure::input(format!("{error}; mend the file")))
}

/// A paved ground under the bulk of the water.
pub fn ground_under(bounds: &Bounds) -> Scene {
    let size = bounds.size();
    let longest = size.max_element().max(f32::MIN_POSITIVE);
    let material = Material {
        base_color: [0.36, 0.34, 0.31],
        roughness: 0.9,
        pattern: Pattern::Paving { size: round_length(longest / 10.0) },
        texture: None,
    };
    // A sheet just under the ground, which hides it: it tells how large the scene is.
    let y = bounds.min.y - 1.0e-3 * longest;
    let corner = |x: f32, z: f32| {
        let at = bounds.center() + longest * glam::Vec3::new(x, 0.0, z);
        [at.x, y, at.z]
    };
    let sheet = Mesh {
        name: "extent".into(),
        positions: vec![corner(-0.5, -0.5), corner(-0.5, 0.5), corner(0.5, 0.5), corner(0.5, -0.5)],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        material: material.clone(),
        ..Mesh::default()
    };
    Scene {
        meshes: vec![sheet],
        ground: Some(Ground { y: bounds.min.y, material }),
        ..Scene::default()
    }
}

/// 1, 2 or 5 by a power of ten, as people cut slabs.
fn round_length(rough: f32) -> f32 {
    let power = 10.0_f32.powf(rough.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|n| n * power);
    steps.into_iter().find(|t| *t >= 0.75 * rough).unwrap_or(rough)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slabs_have_round_sizes() {
        for (rough, expected) in
            [(0.3, 0.5), (0.12, 0.1), (1.1, 1.0), (7.9, 10.0), (2.0e-5, 2.0e-5)]
        {
            assert!((round_length(rough) / expected - 1.0).abs() < 1.0e-4, "{rough}");
        }
    }
}
