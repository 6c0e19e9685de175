//! Round islands on a level sea, by a formula. They are scaled so that their foam covers the requested part of the
//! picture.

use glam::{Vec2, Vec3, vec2};
use whitewater::headless::scene::{Ground, Material, Scene, Sea};

use super::covered::Rays;
use crate::camera::CameraFile;
use crate::failure::{Failure, Outcome};
use crate::shore::ShoreScene;
use crate::shore::strip::{self, Reach};
use crate::shore::terrain::{self, Patch, number};

/// Camera position in metres at scale 1: the picture shows nothing but sea and islands.
const EYE: Vec3 = Vec3::new(0.0, 46.0, 62.0);
const TARGET: Vec3 = Vec3::new(0.0, 0.0, -22.0);
const FOV: f32 = 36.0;
/// Spacing of the islands' lattice.
const SPACING: f32 = 60.0;
const LOW: Vec2 = Vec2::new(-170.0, -210.0);
const HIGH: Vec2 = Vec2::new(220.0, 60.0);
const FLOOR: f32 = -4.0;

/// Centre and radius of each island at scale 1.
fn islands() -> Vec<(Vec2, f32)> {
    let rows = ((HIGH.y - LOW.y) / (0.866 * SPACING)) as usize;
    let columns = ((HIGH.x - LOW.x) / SPACING) as usize;
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let island = |(n, (i, j)): (usize, (usize, usize))| {
        let at = vec2(i as f32 + 0.5 * (j % 2) as f32 + 0.5, 0.866 * (j as f32 + 0.5));
        let jitter = 0.25 * (vec2(number(n, 1), number(n, 2)) - 0.5);
        (LOW + SPACING * (at + jitter), 7.0 + 8.0 * number(n, 3))
    };
    cells.enumerate().map(island).collect()
}

/// Metres inland of the nearest shore; negative at sea.
fn inland(islands: &[(Vec2, f32)], p: Vec2) -> f32 {
    let of = |(middle, radius): &(Vec2, f32)| radius - p.distance(*middle);
    islands.iter().map(of).fold(f32::MIN, f32::max)
}

/// Height of the ground: floor, beach and a hill behind it.
fn height(inland: f32) -> f32 {
    (0.1 * inland + 0.25 * (inland - 3.0).max(0.0)).max(FLOOR)
}

/// Whether land hides `place` from the eye.
fn is_hidden(islands: &[(Vec2, f32)], place: Vec3, eye: Vec3) -> bool {
    const HIGHEST: f32 = 5.0;
    const STEPS: usize = 48;
    let end = HIGHEST / eye.y;
    (1..=STEPS).any(|step| {
        let p = place.lerp(eye, end * step as f32 / STEPS as f32);
        height(inland(islands, vec2(p.x, p.z))) > p.y
    })
}

fn camera(scale: f32) -> CameraFile {
    CameraFile {
        eye: Some((scale * EYE).to_array()),
        target: Some((scale * TARGET).to_array()),
        fov_y_degrees: Some(FOV),
        ..CameraFile::default()
    }
}

/// Scale of islands and camera at which water within `reach` of a shore fills the share `cover` of the picture.
fn scale(islands: &[(Vec2, f32)], size: (u32, u32), cover: f64, reach: f32) -> Outcome<f32> {
    /// Number of rays along x and along y.
    const RAYS: usize = 256;
    let rays = Rays::new(&camera(1.0).camera(size)?);
    let at = |i: usize| vec2((i % RAYS) as f32 + 0.5, (i / RAYS) as f32 + 0.5) / RAYS as f32;
    // Distance from the shore of each ray that hits water.
    let away: Vec<f32> = (0..RAYS * RAYS)
        .filter_map(|i| {
            let place = rays.meets(at(i), 0.0)?;
            let away = -inland(islands, vec2(place.x, place.z));
            (away > 0.0 && !is_hidden(islands, place, rays.eye())).then_some(away)
        })
        .collect();
    let covered = |scale: f32| {
        let near = away.iter().filter(|away| scale * **away <= reach).count();
        near as f64 / (RAYS * RAYS) as f64
    };
    // Bisection: the larger the scale, the less water is within reach.
    let (mut low, mut high) = (0.05_f32, 500.0_f32);
    let most = covered(low);
    if cover > most {
        return Err(Failure::usage(format!(
            "--cover: expected at most {most:.2}, the rest is land, found {cover}"
        )));
    }
    for _ in 0..40 {
        let middle = (low * high).sqrt();
        match covered(middle) > cover {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok(high)
}

/// The scene, and the min and max x and z of one of its islands.
pub fn isles(
    size: (u32, u32),
    cover: f64,
    reach: [f32; 2],
) -> Outcome<(ShoreScene, [[f32; 2]; 2])> {
    let islands = islands();
    let scale = scale(&islands, size, cover, reach[0])?;
    let land = |p: Vec2| scale * height(inland(&islands, p / scale));
    let patch = Patch { low: scale * LOW, high: scale * HIGH, cell: scale * 2.2 };
    let sand = Material::named("island").unwrap_or_default();
    let floor = scale * FLOOR;
    let meshes = vec![terrain::field(patch, 0.999 * floor, sand.clone(), land)];
    let near = |p: Vec2| -scale * inland(&islands, p / scale);
    let reach = Reach { sea: reach[0], land: reach[1] };
    let strip = strip::along(&strip::contours(patch, land), 0.0, reach, near);
    let (middle, radius) = islands[islands.len() / 2];
    let one = [-radius, radius].map(|r| (scale * (middle + r)).to_array());
    let camera = camera(scale);
    let shown = ShoreScene {
        scene: Scene {
            meshes,
            ground: Some(Ground { y: floor, material: sand, reach: None }),
            sea: Some(Sea::default()),
            ..Scene::default()
        },
        eye: camera.eye.unwrap_or_default(),
        target: camera.target.unwrap_or_default(),
        fov: FOV,
        sun: [-0.75, 0.55, -0.1],
        exposure: 0.0,
        level: 0.0,
        frames: 1,
        fps: 24.0,
        strip: Some(strip),
    };
    Ok((shown, one))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_larger_they_are_the_less_they_foam() {
        let islands = islands();
        let of = |cover| scale(&islands, (320, 180), cover, 12.0);
        let (some, more) = (of(0.1).unwrap(), of(0.4).unwrap());
        assert!(some > more && more > 0.3, "{some} and {more}");
        // All lengths scale by one factor.
        let twice = scale(&islands, (320, 180), 0.1, 24.0).unwrap();
        assert!((twice / some - 2.0).abs() < 1e-3, "{some} and {twice}");
        let failure = of(0.99).unwrap_err();
        assert!(failure.message.contains("--cover"), "{}", failure.message);
    }

    #[test]
    fn islands_lie_apart_in_a_sea() {
        let (shown, one) = isles((320, 180), 0.2, [12.0, 3.0]).unwrap();
        let strip = shown.strip.unwrap();
        let shores = strip.v.iter().filter(|v| **v == 1.0).count();
        assert!(shores > 400, "{shores} points of shore lines");
        assert!(one[0][0] < one[1][0] && one[0][1] < one[1][1], "{one:?}");
        let (low, high) = shown.scene.bounds();
        assert!(low.y < 0.0 && high.y > 0.0 && high.x - low.x > 200.0);
    }
}
