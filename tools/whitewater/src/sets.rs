//! Surroundings of the water, near and far: a terrace over the sea, a studio, a shore, a laboratory. All sizes are
//! relative to the width of the water, so a beaker and a lake get the same picture. A length that is called metres
//! here is a sixth of the water's longer side.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3, vec2, vec3};
use whitewater::headless::scene::{Ground, Material, Mesh, Pattern, Scene, Sea};

use crate::args::SetArg;
use crate::masonry;
use crate::shore::terrain::{Lump, block, lumps, number, octaves, rise, smooth_normals};

/// Where the water is.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Centre of its floor.
    pub middle: Vec3,
    /// Half of its size with its walls, along x and z.
    pub half: Vec2,
    /// Position of the camera.
    pub eye: Vec3,
}

impl Place {
    /// The longer side, to which a set's size is relative.
    pub fn wide(&self) -> f32 {
        (2.0 * self.half.max_element()).max(f32::MIN_POSITIVE)
    }

    /// Signs of x and z of the direction away from the camera.
    fn away(&self) -> Vec2 {
        let d = self.middle - self.eye;
        let sign = |v: f32| if v > 0.0 { 1.0 } else { -1.0 };
        vec2(sign(d.x), sign(d.z))
    }
}

/// Length in metres that surroundings and procedural surfaces assume for the longer side of the water.
const METRES: f32 = 6.0;

pub fn material(base_color: [f32; 3], roughness: f32, pattern: Pattern) -> Material {
    Material { base_color, roughness, pattern, texture: None }
}

/// Adds ground and surroundings to a scene.
pub fn furnish(scene: &mut Scene, set: SetArg, ground: Material, place: &Place) {
    let wide = place.wide();
    scene.metre = Some(wide / METRES);
    scene.ground = Some(Ground { y: place.middle.y, material: ground, reach: None });
    match set {
        SetArg::Pool => terrace(scene, place),
        SetArg::Studio => studio(scene, place),
        SetArg::Beach => beach(scene, place),
        SetArg::Lab => laboratory(scene, place),
        SetArg::None => {}
    }
}

/// Builds meshes from coordinates relative to the water: the origin is the centre of its floor, the unit is its
/// longer side, and x and z increase away from the camera.
struct Builder {
    meshes: Vec<Mesh>,
    middle: Vec3,
    wide: f32,
    away: Vec2,
}

impl Builder {
    fn new(place: &Place) -> Self {
        let (middle, wide, away) = (place.middle, place.wide(), place.away());
        Self { meshes: Vec::new(), middle, wide, away }
    }

    fn push(&mut self, name: &str, mut mesh: Mesh) {
        let turned = self.away.x * self.away.y < 0.0;
        let axes = vec3(self.away.x, 1.0, self.away.y);
        for position in &mut mesh.positions {
            *position = (self.middle + self.wide * axes * Vec3::from(*position)).to_array();
        }
        for normal in &mut mesh.normals {
            *normal = (axes * Vec3::from(*normal)).to_array();
        }
        if turned {
            mesh.indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
        }
        mesh.name = name.into();
        self.meshes.push(mesh);
    }
}

/// In metres: height of the terrace above the sea, distance by which it extends beyond the basin, and height of its
/// parapet.
const CLIFF: f32 = 11.0;
const REACH: f32 = 3.6;
const PARAPET: f32 = 0.46;

/// A paved terrace above the sea, with a low parapet and coping; hazy headlands.
fn terrace(scene: &mut Scene, place: &Place) {
    let mut b = Builder::new(place);
    let m = b.wide / METRES;
    let half = place.half * METRES / b.wide;
    // The ground is centred on all objects that stand on it.
    let (low, high) = scene.bounds();
    let middle = 0.5 * (low + high) - b.middle;
    let middle = vec2(middle.x, middle.z) * b.away / m;
    let reach = half.max_element() + REACH;
    if let Some(ground) = &mut scene.ground {
        ground.reach = Some(reach * m);
    }
    // The terrace has the same pattern of slabs as the basin, because each further pattern costs a pipeline.
    let slabs = Pattern::Stone { course: b.wide };
    let blocks = Pattern::Blocks { course: 0.155 * m };
    let wall = material([0.45, 0.41, 0.345], 0.9, blocks);
    let coping = material([0.50, 0.455, 0.385], 0.8, slabs);
    let paving = scene.ground.as_ref().map(|ground| ground.material.clone()).unwrap_or_default();

    // The terrace continues towards the camera.
    let (far, near) = (middle + reach, -26.0_f32);
    let metres = |v: Vec3| v / METRES;
    let put =
        |b: &mut Builder, name: &str, from: Vec3, to: Vec3, cell: f32, material: &Material| {
            b.push(name, block(metres(from), metres(to), cell / METRES, material.clone()));
        };
    let back = middle - reach;
    put(&mut b, "terrace", vec3(near, -0.1, near), vec3(far.x, 0.0, back.y), 2.0, &paving);
    put(&mut b, "terrace", vec3(near, -0.1, back.y), vec3(back.x, 0.0, far.y), 2.0, &paving);
    let (thick, over, slab) = (0.34, 0.035, 0.07);
    let inner = far - 0.06;
    // The inner faces are made of small cells, because under the coping and at the foot the light, which is found for
    // each vertex, falls off quickly.
    let face = inner + 0.02;
    put(&mut b, "parapet", vec3(near, -0.1, inner.y), vec3(face.x, PARAPET, face.y), 0.15, &wall);
    put(&mut b, "parapet", vec3(inner.x, -0.1, near), vec3(face.x, PARAPET, inner.y), 0.15, &wall);
    let (foot, outer) = (-CLIFF - 2.0, inner + thick);
    put(&mut b, "cliff", vec3(near, foot, face.y), vec3(outer.x, PARAPET, outer.y), 2.0, &wall);
    put(&mut b, "cliff", vec3(face.x, foot, near), vec3(outer.x, PARAPET, face.y), 2.0, &wall);
    let (from, to) = (PARAPET, PARAPET + slab);
    let corner = inner - over;
    let outer = inner + thick + over;
    for (low, high, axis) in [
        (vec3(near, from, corner.y), vec3(corner.x, to, outer.y), 0),
        (vec3(corner.x, from, near), vec3(outer.x, to, outer.y), 2),
    ] {
        for mesh in masonry::row(
            (metres(low), metres(high)),
            axis,
            1.0 / METRES,
            0.012 / METRES,
            &coping,
            60,
        ) {
            b.push("coping", mesh);
        }
    }
    // Each headland: its two ends in degrees to the right of the line of sight, its distance and
    // height in metres, and the seed of its shape.
    let sight =
        vec2(place.middle.x - place.eye.x, place.middle.z - place.eye.z).normalize_or(Vec2::NEG_Y);
    let land = material([0.052, 0.052, 0.042], 0.95, slabs);
    for (from, to, away, height, seed) in
        [(-80.0, -7.0, 1900.0, 105.0, 3_u32), (4.0, 80.0, 5200.0, 190.0, 8)]
    {
        let way = |degrees: f32| {
            let turned = Vec2::from_angle(f32::to_radians(degrees)).rotate(sight);
            turned * b.away
        };
        b.push("headland", headland([from, to], way, away, height, seed, land.clone()));
    }
    scene.backdrop.append(&mut b.meshes);
    scene.haze = Some(2600.0 * m);
    scene.clouds = 1.0;
    let calm = Sea::default();
    scene.sea = Some(Sea {
        level: b.middle.y - CLIFF * m,
        // Water near a coast is less clear than far from land: greener, and lighter.
        absorption: [0.42, 0.070, 0.045].map(|a: f32| a / m),
        scattering: [0.004, 0.014, 0.015].map(|s: f32| s / m),
        waves: 0.07 * m,
        length: 5.0 * m,
        // The waves run obliquely to the line of sight, so that crests do not form
        // lines parallel to the horizon.
        towards: Vec2::from_angle(1.0).rotate(sight).to_array(),
        ..calm
    });
}

/// A ridge that runs out into the sea between two directions, at this distance and of this height in metres.
fn headland(
    [from, to]: [f32; 2],
    way: impl Fn(f32) -> Vec2,
    away: f32,
    height: f32,
    seed: u32,
    material: Material,
) -> Mesh {
    const ALONG: usize = 330;
    const UP: usize = 22;
    let mut mesh = Mesh { material, ..Mesh::default() };
    let wide = (to - from).to_radians() * away;
    for i in 0..=ALONG {
        let t = i as f32 / ALONG as f32;
        // The ridge is high where it leaves the picture and low where it ends in the sea.
        let inland = if from.abs() > to.abs() { 1.0 - t } else { t };
        let s = t * wide / height;
        let ridge = height
            * rise(0.0, 0.43, inland).powf(0.7)
            * (1.0 - rise(0.75, 1.0, inland))
            * (0.75
                + 0.9 * octaves(vec2(0.35 * s, 0.0), 5, seed)
                + 0.35 * (inland / 0.43).min(1.0));
        for k in 0..=UP {
            let u = k as f32 / UP as f32;
            let spur = octaves(vec2(1.3 * s, 1.5 * u), 4, seed + 20);
            let y = (ridge * rise(0.0, 1.0, u) * (1.0 + 0.25 * spur)) - 6.0 * (1.0 - u);
            let out = away + height * (3.0 * u + 1.2 * spur);
            let at = out * way(from + t * (to - from)) / METRES;
            mesh.positions.push([at.x, (y - CLIFF) / METRES, at.y]);
            if i < ALONG && k < UP {
                let a = (i * (UP + 1) + k) as u32;
                let b = a + UP as u32 + 1;
                mesh.indices.extend([a, a + 1, b + 1, a, b + 1, b]);
            }
        }
    }
    mesh.normals = smooth_normals(&mesh.positions, &mesh.indices);
    if mesh.normals.iter().map(|n| n[1]).sum::<f32>() < 0.0 {
        mesh.normals.iter_mut().flatten().for_each(|v| *v = -*v);
        mesh.indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
    }
    mesh
}

/// A floor that haze fades into the backdrop without a seam, as in a photographer's studio (a cyclorama).
fn studio(scene: &mut Scene, place: &Place) {
    scene.haze = Some(4.5 * place.wide());
}

/// Sand that slopes to the sea, stones on it, a headland.
fn beach(scene: &mut Scene, place: &Place) {
    let mut b = Builder::new(place);
    let metre = b.wide / METRES;
    let reach = 1.3;
    if let Some(ground) = &mut scene.ground {
        ground.reach = Some(reach * b.wide);
    }
    let ripples = Pattern::Ripples { length: 0.03 * b.wide };
    let sand = material([0.50, 0.41, 0.29], 0.95, ripples);
    // Downhill away from the eye.
    let shore = |p: Vec2| {
        let t = p.dot(vec2(0.62, 0.78)) + 0.5 * octaves(p / 3.0, 3, 8);
        let level = p.abs().max_element() < reach + 0.4;
        let rough = if level { 0.0 } else { 0.05 * octaves(p / 1.4, 3, 3) };
        let dune = 0.55 * rise(3.0, 14.0, -t) * (0.7 + octaves(p / 5.0, 3, 4));
        rough + dune - 0.30 * rise(1.7, 5.0, t) - 2.5 * rise(4.0, 16.0, t)
    };
    let hole = Vec2::splat(reach);
    b.push("sand", ring_of_cells(-hole, hole, 50.0, sand, shore));
    let rock = material([0.24, 0.215, 0.19], 0.85, Pattern::Rock);
    let mut stones = Vec::new();
    for i in 0..26 {
        let n = |seed| number(i, seed);
        let group = [vec2(-1.6, 2.9), vec2(3.2, 0.4), vec2(0.9, 3.4)][i % 3];
        let at = group + 0.9 * n(51).sqrt() * Vec2::from_angle(TAU * n(52));
        let size = 0.03 + 0.16 * n(53).powi(3);
        let half = size * vec3(1.0 + 0.7 * n(54), 0.7, 1.0);
        let middle = vec3(at.x, shore(at) + 0.35 * half.y, at.y);
        stones.push(Lump { middle, half, rough: 0.35, seed: 300 + 3 * i as u32 });
    }
    b.push("stones", lumps(&stones, 10, rock.clone()));
    let mut heads = Vec::new();
    for i in 0..18 {
        let n = |seed| number(i, seed);
        let at = vec2(-30.0 + 1.9 * i as f32, 34.0 + 5.0 * n(62));
        let half = vec3(3.0, 1.1 + 1.6 * n(63), 3.0) * (1.15 - i as f32 / 20.0);
        heads.push(Lump {
            middle: vec3(at.x, -0.4, at.y),
            half,
            rough: 0.35,
            seed: 500 + i as u32,
        });
    }
    b.push("headland", lumps(&heads, 12, rock));
    scene.backdrop.append(&mut b.meshes);
    scene.haze = Some(110.0 * b.wide);
    let calm = Sea::default();
    scene.sea = Some(Sea {
        level: b.middle.y - 0.075 * b.wide,
        absorption: calm.absorption.map(|a| a / metre),
        scattering: calm.scattering.map(|s| s / metre),
        waves: 0.5 * calm.waves * metre,
        length: 0.6 * calm.length * metre,
        ..calm
    });
}

/// A hall with a resin floor and a wall that is tiled below and plain above.
fn laboratory(scene: &mut Scene, place: &Place) {
    let mut b = Builder::new(place);
    let tiles = Pattern::Tiles { size: 0.05 * b.wide, band: None };
    let tiled = material([0.62, 0.63, 0.61], 0.3, tiles);
    let plain = material([0.62, 0.62, 0.60], 0.9, Pattern::Plain);
    let dark = material([0.08, 0.085, 0.09], 0.5, Pattern::Plain);
    let far = 2.4;
    let (low, mid, high, near) = (0.07, 0.62, 4.0, -9.0);
    for (name, from, to, cell, what) in [
        ("skirting", -0.01, low, 0.5, &dark),
        ("tiles", low, mid, 0.25, &tiled),
        ("rail", mid, mid + 0.03, 0.5, &dark),
        ("wall", mid + 0.03, high, 0.4, &plain),
    ] {
        let (behind, beside) = (vec3(near, from, far), vec3(far + 0.2, to, far + 0.2));
        b.push(name, block(behind, beside, cell, what.clone()));
        let (behind, beside) = (vec3(far, from, near), vec3(far + 0.2, to, far));
        b.push(name, block(behind, beside, cell, what.clone()));
    }
    scene.backdrop.append(&mut b.meshes);
}

/// A height field around a rectangle, with cells that grow with distance.
fn ring_of_cells(
    low: Vec2,
    high: Vec2,
    reach: f32,
    material: Material,
    height: impl Fn(Vec2) -> f32,
) -> Mesh {
    let axis = |low: f32, high: f32| {
        let mut steps = Vec::new();
        let (mut at, mut step) = (0.0, 0.17);
        while at < reach {
            at += step;
            steps.push(at);
            step *= if at < 2.6 { 1.0 } else { 1.24 };
        }
        let inner = ((high - low) / 0.25).ceil();
        let inside = (0..=inner as u32).map(|i| low + (high - low) * i as f32 / inner);
        let before = steps.iter().rev().map(|d| low - d);
        before.chain(inside).chain(steps.iter().map(|d| high + d)).collect::<Vec<_>>()
    };
    let (xs, zs) = (axis(low.x, high.x), axis(low.y, high.y));
    let mut mesh = Mesh { material, ..Mesh::default() };
    for (j, &z) in zs.iter().enumerate() {
        for (i, &x) in xs.iter().enumerate() {
            let p = vec2(x, z);
            let step = 0.05 + 0.02 * p.length();
            let slope = |d: Vec2| (height(p + d) - height(p - d)) / (2.0 * step);
            let normal = vec3(-slope(vec2(step, 0.0)), 1.0, -slope(vec2(0.0, step)));
            mesh.positions.push([x, height(p), z]);
            mesh.normals.push(normal.normalize().to_array());
            let last = i + 1 >= xs.len() || j + 1 >= zs.len();
            let hole = x > low.x - 1.0e-4
                && x < high.x - 1.0e-4
                && z > low.y - 1.0e-4
                && z < high.y - 1.0e-4;
            if !last && !hole {
                let a = (j * xs.len() + i) as u32;
                let b = a + xs.len() as u32;
                mesh.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
            }
        }
    }
    mesh
}
