//! Scenes with a sea: islands, a pool, a river of lava. Metres, y up.

use std::f32::consts::TAU;

use glam::{Mat4, Quat, Vec2, Vec3, vec2, vec3};
use whitewater::headless::scene::{Ground, Liquid, Material, Mesh, Motion, Pattern, Scene, Sea};

use super::strip::{self, Reach, Strip};
use super::terrain::{self, Lump, Patch, joined, number, octaves, rise, warped};

/// A scene with a sea, its camera, and the period of its animation.
pub struct ShoreScene {
    /// The scene, without its sunlight: that is set later, from an environment whose sun is in direction `sun`.
    pub scene: Scene,
    pub eye: [f32; 3],
    pub target: [f32; 3],
    /// Vertical field of view, degrees.
    pub fov: f32,
    /// Towards the sun.
    pub sun: [f32; 3],
    /// Exposure in stops, added to that for the sky and the sun.
    pub exposure: f32,
    /// Height of the sea.
    pub level: f32,
    /// Period of the animation in frames, from frame 1 on.
    pub frames: u64,
    /// Frames per second.
    pub fps: f32,
    /// Strip around the largest island.
    pub strip: Option<Strip>,
}

impl ShoreScene {
    /// Makes the motion repeat like the foam, for frames `first` to `last` at `fps` frames a second. The poses go by
    /// time: they are interpolated if this is not the scene's own rate.
    pub fn repeat(&mut self, first: u64, last: u64, fps: f32) {
        let period = self.frames;
        let speed = f64::from(self.fps) / f64::from(fps);
        // At least a whole period, so that the bounds do not depend on which frames are drawn. They take time for each
        // pose, so that a rate that no film has does not count.
        let whole = ((period as f64 / speed).ceil() as u64).min(10 * period);
        let end = last.saturating_add(1).max(first.saturating_add(whole));
        for motion in self.scene.motions.iter_mut().filter(|motion| !motion.poses.is_empty()) {
            let count = motion.poses.len();
            let pose = |number: u64| {
                let at = ((number as f64 - 1.0) * speed).rem_euclid(period as f64);
                let [before, after] = [0, 1].map(|next| motion.poses[(at as usize + next) % count]);
                let part = at.fract() as f32;
                before * (1.0 - part) + after * part
            };
            let poses: Vec<Mat4> = (first..end).map(pose).collect();
            (motion.first_frame, motion.poses) = (first, poses);
        }
    }
}

/// A ground material by name; the default one if there is none.
fn material(name: &str) -> Material {
    Material::named(name).unwrap_or_default()
}

fn colored(base_color: [f32; 3], roughness: f32) -> Material {
    Material { base_color, roughness, ..Material::default() }
}

/// An island: overlapping discs with an outline that is distorted by noise.
struct Isle {
    /// Centre and radius of each disc.
    discs: &'static [([f32; 2], f32)],
    /// Height of its hills.
    peak: f32,
    /// Slope of the beach at the shore line, metres down per metre outward.
    slope: f32,
    seed: u32,
}

/// Height of the sea's floor.
const FLOOR: f32 = -8.0;

const MAIN: Isle = Isle {
    discs: &[
        ([-6.0, 4.0], 30.0),
        ([24.0, -14.0], 26.0),
        ([-32.0, -14.0], 17.0),
        ([4.0, -26.0], 24.0),
    ],
    peak: 17.0,
    slope: 1.0 / 12.0,
    seed: 11,
};

const OTHERS: [Isle; 3] = [
    Isle {
        discs: &[([98.0, -62.0], 22.0), ([112.0, -78.0], 18.0)],
        peak: 11.0,
        slope: 0.1,
        seed: 23,
    },
    Isle {
        discs: &[([-96.0, -92.0], 24.0), ([-76.0, -104.0], 15.0)],
        peak: 13.0,
        slope: 0.1,
        seed: 37,
    },
    Isle { discs: &[([74.0, 30.0], 11.0), ([84.0, 22.0], 8.0)], peak: 3.5, slope: 0.11, seed: 41 },
];

/// The drifting island, around its own centre.
const DRIFTING: Isle = Isle { discs: &[([0.0, 0.0], 5.2)], peak: 2.6, slope: 0.22, seed: 53 };

/// Position that it drifts around.
const DRIFTS: Vec2 = vec2(24.0, 65.0);

impl Isle {
    /// Approximate distance from the shore line in metres; negative on land.
    fn shore(&self, p: Vec2) -> f32 {
        let size = self.discs.iter().fold(0.0_f32, |most, (_, radius)| most.max(*radius));
        let q = warped(p, 0.32 * size, 0.9 * size, self.seed);
        let q = warped(q, 0.07 * size, 0.22 * size, self.seed + 7);
        let from = |(middle, radius): &([f32; 2], f32)| q.distance(Vec2::from(*middle)) - radius;
        let nearest = self.discs.iter().map(from).reduce(|a, b| -joined(-a, -b, 0.5 * size));
        nearest.unwrap_or(f32::MAX)
    }

    fn height(&self, p: Vec2) -> f32 {
        let shore = self.shore(p);
        let size = self.discs.iter().fold(0.0_f32, |most, (_, radius)| most.max(*radius));
        // A beach, and a shelf that falls off.
        let shelf = -1.9;
        let beach = -shore * self.slope;
        let fall = shelf + (beach - shelf) * 3.6;
        let low = -joined(-beach.min(0.35 * size * self.slope), -fall, 1.2);
        // Hills behind it.
        let inland = rise(0.26 * size, 1.15 * size, -shore);
        let hills = 0.66 + 0.6 * octaves(p / (0.75 * size), 4, self.seed + 100);
        let crags = (1.0 - 2.2 * octaves(p / (0.42 * size), 4, self.seed + 200).abs()).max(0.0);
        let dunes = 0.10 * octaves(p / 6.0, 3, self.seed + 300) * rise(0.0, 4.0, -shore);
        low + dunes + self.peak * inland * (hills.max(0.1) + 0.30 * crags)
    }
}

fn land(p: Vec2) -> f32 {
    let height =
        OTHERS.iter().map(|isle| isle.height(p)).fold(MAIN.height(p), |a, b| joined(a, b, 0.6));
    // The sea is deep where the island drifts, because the island slides over the floor.
    let channel = rise(6.0, 22.0, MAIN.shore(p)) * rise(36.0, 18.0, p.distance(DRIFTS));
    let height = height - 6.5 * channel;
    // The floor is uneven.
    let floor = FLOOR - 0.4 + 0.9 * octaves(p / 40.0, 3, 5);
    joined(height, floor, 3.0)
}

/// Extent of the islands' height field.
const SEA: Patch = Patch { low: Vec2::splat(-150.0), high: Vec2::splat(150.0), cell: 1.5 };

/// Strip around the largest island.
pub fn strip() -> Strip {
    let near = Patch { low: Vec2::splat(-80.0), high: Vec2::splat(80.0), cell: 1.5 };
    let loops = strip::contours(near, land);
    // Shores of other islands, and of ponds, are excluded.
    let own = loops.into_iter().filter(|points| points.iter().all(|p| MAIN.shore(*p).abs() < 8.0));
    let longest = own.max_by_key(Vec::len);
    strip::along(longest.as_slice(), 0.0, Reach { sea: 14.0, land: 4.0 }, |p| MAIN.shore(p))
}

/// Islands with beaches in a clear sea, one of which drifts.
pub fn archipelago() -> ShoreScene {
    let (frames, fps) = (240, 24.0);
    let island = material("island");
    let mut meshes = vec![terrain::field(SEA, FLOOR - 0.35, island.clone(), land)];
    meshes.push(rocks());
    meshes.push(bushes());

    let patch = Patch { low: Vec2::splat(-26.0), high: Vec2::splat(26.0), cell: 0.8 };
    let height = |p: Vec2| DRIFTING.height(p).max(-12.0);
    let place = vec3(DRIFTS.x, 0.0, DRIFTS.y);
    // The island keeps its orientation, so that its sand moves with it.
    let turn = Quat::from_rotation_y(0.8);
    let transform = Mat4::from_rotation_translation(turn, place);
    let first = meshes.len();
    meshes.push(Mesh { transform, ..terrain::field(patch, -9.5, island.clone(), height) });
    let palms: Vec<Lump> = (0..5)
        .map(|i| {
            let at = Vec2::from_angle(1.9 * i as f32) * (0.5 + 0.35 * i as f32);
            let size = 0.5 + 0.5 * number(i, 91);
            Lump {
                middle: vec3(at.x, height(at) + 0.35 * size, at.y),
                half: size * vec3(1.0, 0.8, 1.0),
                rough: 0.3,
                seed: 300 + i as u32,
            }
        })
        .collect();
    meshes.push(Mesh { transform, ..terrain::lumps(&palms, 10, foliage()) });
    let pose = |i: u64| {
        let angle = TAU * i as f32 / frames as f32;
        let (sin, cos) = angle.sin_cos();
        let off = vec3(9.0 * cos, 0.0, 5.0 * sin);
        let turn = Quat::from_rotation_y(0.25 * sin);
        Mat4::from_translation(place + off) * Mat4::from_quat(turn) * Mat4::from_translation(-place)
    };
    let motion = Motion {
        meshes: (first..meshes.len()).collect(),
        first_frame: 1,
        poses: (0..frames).map(pose).collect(),
    };
    let sea = Sea { period: Some(frames as f32 / fps), ..Sea::default() };
    ShoreScene {
        level: sea.level,
        scene: Scene {
            meshes,
            ground: Some(Ground { y: FLOOR - 0.2, material: island, reach: None }),
            motions: vec![motion],
            sea: Some(sea),
            ..Scene::default()
        },
        eye: [-34.0, 35.0, 116.0],
        target: [20.0, 0.0, 0.0],
        fov: 36.0,
        sun: [-0.75, 0.55, -0.1],
        exposure: 0.0,
        frames,
        fps,
        strip: Some(strip()),
    }
}

fn foliage() -> Material {
    Material {
        base_color: [0.085, 0.125, 0.030],
        roughness: 0.8,
        pattern: Pattern::Leaves,
        texture: None,
    }
}

/// Stones on the shores and in the sea.
fn rocks() -> Mesh {
    // Clusters: centre, number of stones and size.
    const GROUPS: [([f32; 2], usize, f32); 7] = [
        ([-8.0, 42.0], 7, 1.5),
        ([45.0, 12.0], 8, 1.8),
        ([52.0, -34.0], 5, 1.6),
        ([-52.0, 2.0], 7, 1.8),
        ([-20.0, 66.0], 3, 2.6),
        ([88.0, 22.0], 4, 2.8),
        ([-40.0, -62.0], 5, 2.2),
    ];
    let mut lumps = Vec::new();
    for (group, (middle, count, size)) in GROUPS.into_iter().enumerate() {
        for i in 0..count {
            let n = 20 * group + i;
            let away = 5.5 * number(n, 61).sqrt();
            let at = Vec2::from(middle) + Vec2::from_angle(TAU * number(n, 62)) * away;
            let size = size * (0.35 + 0.95 * number(n, 63).powi(2));
            let half = size * vec3(1.0 + 0.6 * number(n, 64), 0.75 + 0.4 * number(n, 65), 1.0);
            // The stone is high enough to show above the sea or lie on the land.
            let y = land(at).max(-0.45 * half.y);
            lumps.push(Lump {
                middle: vec3(at.x, y, at.y),
                half,
                rough: 0.32,
                seed: 500 + n as u32,
            });
        }
    }
    terrain::lumps(&lumps, 16, material("rock"))
}

/// Bushes where there is grass.
fn bushes() -> Mesh {
    let mut lumps = Vec::new();
    let cells = (0..100).flat_map(|j| (0..100).map(move |i| (i, j)));
    for (n, (i, j)) in cells.enumerate() {
        let jitter = vec2(number(n, 71), number(n, 72));
        let at = SEA.low + 3.0 * (vec2(i as f32, j as f32) + jitter);
        let y = land(at);
        let thick = 0.8 + 1.4 * octaves(at / 18.0, 3, 77);
        let steep = (land(at + vec2(1.0, 0.0)) - y).hypot(land(at + vec2(0.0, 1.0)) - y);
        if y < 2.4 || steep > 1.0 || number(n, 73) > thick {
            continue;
        }
        let size = 0.6 + 1.2 * number(n, 74) * thick.min(1.0);
        let half = size * vec3(1.0, 0.85, 1.0);
        lumps.push(Lump {
            middle: vec3(at.x, y + 0.4 * half.y, at.y),
            half,
            rough: 0.35,
            seed: 900 + n as u32,
        });
    }
    terrain::lumps(&lumps, 8, foliage())
}

/// A box from corner to corner.
fn block(low: [f32; 3], high: [f32; 3], material: &Material) -> Mesh {
    terrain::block(low.into(), high.into(), 0.6, material.clone())
}

fn ball(middle: Vec3, radius: f32, material: Material) -> Mesh {
    let lump = Lump { middle, half: Vec3::splat(radius), rough: 0.0, seed: 0 };
    terrain::lumps(&[lump], 28, material)
}

/// A tiled pool with steps at one end and a ramp at the other, and objects that stand and float in it.
pub fn pool() -> ShoreScene {
    let (frames, fps) = (180, 30.0);
    let level = -0.14;
    let (x, z, deep) = (4.0, 2.5, -1.5);
    let tile = Pattern::Tiles { size: 0.15, band: Some(level + 0.02) };
    let tiles =
        Material { base_color: [0.56, 0.68, 0.70], roughness: 0.25, pattern: tile, texture: None };
    let plain = Material {
        pattern: Pattern::Tiles { size: 0.15, band: None },
        base_color: [0.64, 0.72, 0.72],
        ..tiles.clone()
    };
    let deck = Material { base_color: [0.47, 0.43, 0.37], ..material("paving") };
    let rim = Material {
        base_color: [0.62, 0.59, 0.53],
        roughness: 0.8,
        pattern: Pattern::Concrete,
        texture: None,
    };
    let stone = material("stone");
    let thick = 0.3;
    let mut meshes = vec![
        // The basin: floor and walls.
        block([-x, deep - thick, -z], [x, deep, z], &tiles),
        block([-x - thick, deep - thick, -z - thick], [x + thick, -0.04, -z], &tiles),
        block([-x - thick, deep - thick, z], [x + thick, -0.04, z + thick], &tiles),
        block([-x - thick, deep - thick, -z], [-x, -0.04, z], &tiles),
        block([x, deep - thick, -z], [x + thick, -0.04, z], &tiles),
    ];
    // The rim, and the deck around it.
    let (out_x, out_z) = (x + 0.35, z + 0.35);
    for side in [-1.0_f32, 1.0] {
        let (a, b) = ((side * z).min(side * out_z), (side * z).max(side * out_z));
        meshes.push(block([-out_x, -0.06, a], [out_x, 0.03, b], &rim));
        let (a, b) = ((side * x).min(side * out_x), (side * x).max(side * out_x));
        meshes.push(block([a, -0.06, -z], [b, 0.03, z], &rim));
        let (a, b) = ((side * out_z).min(side * 7.5), (side * out_z).max(side * 7.5));
        meshes.push(block([-9.0, -0.3, a], [9.0, 0.0, b], &deck));
        let (a, b) = ((side * out_x).min(side * 9.0), (side * out_x).max(side * 9.0));
        meshes.push(block([a, -0.3, -out_z], [b, 0.0, out_z], &deck));
    }
    // Walls behind it, with plants in front.
    meshes.push(block([-9.0, 0.0, -5.4], [7.4, 3.0, -5.0], &stone));
    meshes.push(block([7.0, 0.0, -5.0], [7.4, 3.0, 7.5], &stone));
    meshes.push(block([-8.0, 0.0, -5.0], [5.8, 0.30, -4.25], &rim));
    meshes.push(block([-7.95, 0.30, -4.93], [5.75, 0.85, -4.32], &foliage()));
    let balls: Vec<Lump> = (0..8)
        .map(|i| {
            let middle = vec3(-7.2 + 1.8 * i as f32, 0.98, -4.62);
            Lump { middle, half: Vec3::splat(0.36), rough: 0.06, seed: 40 + i as u32 }
        })
        .collect();
    meshes.push(terrain::lumps(&balls, 14, foliage()));
    // Steps at one end.
    for i in 0..4 {
        let (top, end) = (-0.30 - 0.30 * i as f32, -x + 0.34 * (i + 1) as f32);
        meshes.push(block([-x, deep, -z], [end, top, 0.4], &plain));
    }
    // A ramp at the other end; its upper face is as wide as the pool.
    let (foot, head, top) = (0.6, x, 0.0);
    let turn = f32::atan2(top - deep, head - foot);
    let length = vec2(head - foot, top - deep).length();
    let rotation = Quat::from_rotation_z(turn);
    let middle =
        vec3(0.5 * (foot + head), 0.5 * (deep + top), 0.0) - rotation * vec3(0.0, 0.2, 0.0);
    meshes.push(Mesh::cuboid(
        middle.to_array(),
        [0.5 * length, 0.2, z],
        rotation.to_array(),
        plain.clone(),
    ));
    // Objects that stand in it.
    let concrete = material("concrete");
    meshes.push(Mesh::cylinder([0.2, -0.35, -1.35], 0.27, 2.3, rim.clone()));
    meshes.push(block([-1.9, deep, -1.9], [-1.2, 0.22, -1.2], &concrete));
    let slanted = Quat::from_rotation_y(0.5).to_array();
    meshes.push(Mesh::cuboid([1.7, -0.35, -0.5], [0.34, 0.5, 0.34], slanted, material("timber")));
    // Objects that float.
    meshes.push(ball(vec3(-0.45, level + 0.12, 0.75), 0.34, colored([0.62, 0.05, 0.035], 0.3)));
    meshes.push(ball(vec3(-1.9, level + 0.06, 0.1), 0.22, colored([0.75, 0.52, 0.06], 0.3)));
    meshes.push(ball(vec3(1.1, level + 0.1, 1.5), 0.26, colored([0.75, 0.73, 0.68], 0.3)));
    meshes.push(terrain::ring(
        vec3(0.9, level + 0.03, 0.35),
        [0.42, 0.13],
        colored([0.03, 0.22, 0.42], 0.3),
    ));
    let sea = Sea {
        level,
        absorption: [0.30, 0.045, 0.030],
        scattering: [0.004, 0.010, 0.012],
        waves: 0.027,
        length: 1.3,
        towards: [0.7, 0.7],
        period: Some(frames as f32 / fps),
        ..Sea::default()
    };
    ShoreScene {
        scene: Scene { meshes, sea: Some(sea), ..Scene::default() },
        eye: [-4.6, 3.1, 5.0],
        target: [0.25, -0.45, -0.55],
        fov: 44.0,
        sun: [-0.55, 0.75, 0.12],
        exposure: 0.0,
        level,
        frames,
        fps,
        strip: None,
    }
}

/// Course of the lava river: x of its middle at z.
fn river(z: f32) -> f32 {
    2.6 * (0.23 * z).sin() + 0.035 * (z + 6.0).min(0.0).powi(2)
}

/// A bed of rock with walls on both sides.
fn canyon(p: Vec2) -> f32 {
    let q = warped(p, 1.1, 4.5, 7);
    let off = (q.x - river(q.y)).abs();
    let wide = 3.9 + 0.9 * octaves(vec2(0.5 * q.y / 3.0, 3.0), 2, 9);
    let bank = off - wide;
    let wall = 7.5 * rise(0.6, 7.5, bank) + 0.40 * bank.max(-2.5);
    // Ledges.
    let ledges = wall + 0.9 * octaves(q / 3.5, 3, 13);
    let step = 1.5;
    let stepped = step * ((ledges / step).floor() + rise(0.35, 0.85, (ledges / step).fract()));
    let rough = 0.75 * octaves(p / 1.3, 4, 17) + 0.35 * (1.0 - 2.0 * octaves(p / 2.4, 3, 21).abs());
    let rock =
        ledges + 0.55 * (stepped - ledges) * rise(0.0, 1.5, bank) + rough * rise(-0.8, 1.0, bank);
    // No puddles outside the river.
    joined(rock, -3.0 + 3.5 * rise(0.2, 1.2, bank), 0.3)
}

/// A river of lava in a canyon, at dusk.
pub fn lava() -> ShoreScene {
    let (frames, fps) = (240, 24.0);
    let rock = Material { base_color: [0.115, 0.10, 0.092], ..material("rock") };
    let patch = Patch { low: vec2(-16.0, -26.0), high: vec2(24.0, 11.0), cell: 0.22 };
    let mut meshes = vec![terrain::field(patch, -9.0, rock.clone(), canyon)];
    // Stones in the river: position along it, position across it, size.
    const STONES: [(f32, f32, f32); 9] = [
        (4.6, -1.3, 0.75),
        (2.6, 1.5, 0.55),
        (0.8, -0.3, 0.95),
        (-1.6, 1.9, 0.6),
        (-3.2, -1.6, 0.8),
        (-5.5, 0.6, 0.7),
        (-7.0, -1.9, 0.5),
        (-9.0, 1.4, 0.9),
        (5.4, 1.1, 0.35),
    ];
    let lumps: Vec<Lump> = STONES
        .iter()
        .enumerate()
        .map(|(i, &(z, aside, size))| Lump {
            middle: vec3(river(z) + aside, -0.2 * size, z),
            half: size * vec3(1.0 + 0.3 * number(i, 3), 1.0 + 0.6 * number(i, 4), 0.9),
            rough: 0.34,
            seed: 700 + i as u32,
        })
        .collect();
    meshes.push(terrain::lumps(&lumps, 22, rock));
    let sea = Sea {
        waves: 0.0,
        length: 1.5,
        towards: [0.1, 1.0],
        period: Some(frames as f32 / fps),
        liquid: Liquid::LAVA,
        ..Sea::default()
    };
    ShoreScene {
        level: sea.level,
        scene: Scene { meshes, sea: Some(sea), ..Scene::default() },
        eye: [1.2, 5.2, 12.5],
        target: [0.6, -0.4, -2.5],
        fov: 44.0,
        sun: [-0.80, 0.15, -0.10],
        exposure: -0.8,
        frames,
        fps,
        strip: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strip_goes_round_the_island() {
        let strip = strip();
        assert!(strip.positions.len() > 1000 && strip.positions.len() == strip.v.len());
        assert!(strip.v.iter().all(|v| (0.0..=2.0).contains(v)));
        let mut line = 0;
        for (p, v) in strip.positions.iter().zip(&strip.v) {
            let at = vec2(p[0], p[2]);
            assert_eq!(p[1], 0.0);
            // The sea is on one side of the shore line, the land on the other.
            match *v {
                1.0 => {
                    line += 1;
                    assert!(land(at).abs() < 0.01, "{at}: {}", land(at));
                }
                v if v < 0.6 => assert!(land(at) < 0.0, "{at} at {v}: {}", land(at)),
                v if v > 1.5 => assert!(land(at) > -0.05, "{at} at {v}: {}", land(at)),
                _ => {}
            }
        }
        assert!(line > 150, "{line} points of the shore line");
        // The strip is closed: an edge on a rim (v is 0 or 2 at both ends) belongs to one triangle, all other edges
        // to two.
        let mut edges = std::collections::HashMap::new();
        for t in strip.indices.chunks_exact(3) {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                *edges.entry((a.min(b), a.max(b))).or_insert(0) += 1;
            }
        }
        for ((a, b), count) in edges {
            let [v, w] = [a, b].map(|i| strip.v[i as usize]);
            let rim = v == w && (v == 0.0 || v == 2.0);
            assert_eq!(count, if rim { 1 } else { 2 }, "{v} {w}");
        }
    }

    #[test]
    fn islands_pierce_the_sea_and_one_of_them_drifts() {
        let shore = archipelago();
        let highest = (-40..40).map(|x| land(vec2(x as f32, -14.0))).fold(f32::MIN, f32::max);
        assert!(highest > 8.0 && land(vec2(140.0, 140.0)) < -6.0, "{highest}");
        let at = |pose: Mat4| pose.transform_point3(vec3(DRIFTS.x, 0.0, DRIFTS.y));
        let near = |a: Mat4, b: Mat4| at(a).distance(at(b)) < 0.5;
        let motion = &shore.scene.motions[0];
        assert_eq!(motion.poses.len() as u64, shore.frames);
        assert!(near(motion.pose(1), motion.pose(shore.frames)), "a closed way");
        assert!(!near(motion.pose(1), motion.pose(shore.frames / 2)));
        assert!(!shore.scene.rests_between(1, 2));
    }

    /// The motion repeats with the foam, at any rate, wherever a run begins.
    #[test]
    fn a_scene_repeats() {
        let mut shore = archipelago();
        let own = shore.scene.motions[0].clone();
        let mut pose = |first: u64, last: u64, fps: f32, number: u64| {
            shore.scene.motions = vec![own.clone()];
            shore.repeat(first, last, fps);
            shore.scene.motions[0].pose(number)
        };
        for number in [1, 121, 240] {
            assert_eq!(pose(1, 1, 24.0, number), own.pose(number));
            assert_eq!(pose(361, 720, 24.0, number + 480), own.pose(number));
        }
        for (number, expected) in [(301, 121), (601, 1), (4, 2)] {
            let off = pose(1, 700, 60.0, number) - own.pose(expected);
            // A fifth of the way from one pose to the next.
            let most = if number == 4 { 0.3 } else { 1.0e-3 };
            assert!(off.to_cols_array().iter().all(|c| c.abs() < most), "{number}: {off}");
        }
    }

    #[test]
    fn scenes_can_be_drawn() {
        for shore in [archipelago(), pool(), lava()] {
            for mesh in &shore.scene.meshes {
                assert_eq!(mesh.positions.len(), mesh.normals.len(), "{}", mesh.name);
                let count = mesh.positions.len() as u32;
                assert!(mesh.indices.iter().all(|i| *i < count), "{}", mesh.name);
                assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()), "{}", mesh.name);
            }
            let sea = shore.scene.sea.as_ref().expect("a sea");
            assert_eq!(sea.level, shore.level);
            assert!(shore.eye[1] > shore.level);
            assert_eq!(sea.period, Some(shore.frames as f32 / shore.fps));
        }
    }
}
