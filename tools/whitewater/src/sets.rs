//! Surroundings of the water, near and far: a terrace in a garden, a studio, a shore, a laboratory. All sizes
//! are relative to the width of the water, so a beaker and a lake get the same picture; nothing is metric.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3, vec2, vec3};
use whitewater::headless::scene::{Ground, Material, Mesh, Pattern, Scene, Sea};

use crate::args::SetArg;
use crate::shore::terrain::{Lump, block, lumps, number, octaves, rise, smooth_normals};

/// Where the water is.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The middle of its floor.
    pub middle: Vec3,
    /// Half of what it takes with its walls, along x and z.
    pub half: Vec2,
    /// From where it is looked at.
    pub eye: Vec3,
}

impl Place {
    /// The longer side, by which a set is as large as it is.
    pub fn wide(&self) -> f32 {
        (2.0 * self.half.max_element()).max(f32::MIN_POSITIVE)
    }

    /// A direction of the level plane as the eye sees it: away along the axis of the world that it looks along more,
    /// and beside that away as well.
    fn away(&self) -> Vec2 {
        let d = self.middle - self.eye;
        let sign = |v: f32| if v > 0.0 { 1.0 } else { -1.0 };
        vec2(sign(d.x), sign(d.z))
    }
}

/// How many metres the longer side of the water has to procedural surfaces.
const METRES: f32 = 6.0;

pub fn material(base_color: [f32; 3], roughness: f32, pattern: Pattern) -> Material {
    Material { base_color, roughness, pattern, texture: None }
}

/// Sets ground and surroundings.
pub fn furnish(scene: &mut Scene, set: SetArg, ground: Material, place: &Place) {
    let wide = place.wide();
    scene.metre = Some(wide / METRES);
    scene.ground = Some(Ground { y: place.middle.y, material: ground, reach: None });
    match set {
        SetArg::Pool => garden(scene, place),
        SetArg::Studio => studio(scene, place),
        SetArg::Beach => beach(scene, place),
        SetArg::Lab => laboratory(scene, place),
        SetArg::None => {}
    }
}

/// Meshes in units of the water's width, from the middle of its floor; x and z away from the eye.
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

/// Lawn and hills; level round the middle.
fn land(p: Vec2) -> f32 {
    let far = rise(3.0, 16.0, p.length());
    0.012
        + far * 0.55 * octaves(p / 9.0, 3, 5)
        + 2.6 * rise(22.0, 60.0, p.length()) * (0.55 + octaves(p / 19.0, 4, 21))
}

/// A paved terrace in a lawn, a clipped hedge behind it, trees, and hills.
fn garden(scene: &mut Scene, place: &Place) {
    let mut b = Builder::new(place);
    let half = place.half / b.wide;
    let lawn = material([0.068, 0.112, 0.022], 0.9, Pattern::Lawn { stripe: 0.13 * b.wide });
    let [hedge_green, oak, ash] =
        [[0.036, 0.064, 0.016], [0.050, 0.082, 0.018], [0.078, 0.108, 0.026]]
            .map(|green| material(green, 0.85, Pattern::Foliage));
    // As the basin's: each pattern costs a pipeline.
    let slabs = Pattern::Stone { course: b.wide };
    let [stone, bark] =
        [[0.52, 0.48, 0.42], [0.10, 0.075, 0.055]].map(|c| material(c, 0.85, slabs));

    // The terrace: less of it behind than before.
    let (low, high) = (-half - vec2(0.95, 0.95), half + vec2(0.5, 0.5));
    let (kerb, proud) = (0.055, 0.016);
    for (name, from, to) in [
        ("kerb", vec2(low.x - kerb, low.y - kerb), vec2(low.x, high.y + kerb)),
        ("kerb", vec2(high.x, low.y - kerb), vec2(high.x + kerb, high.y + kerb)),
        ("kerb", vec2(low.x, low.y - kerb), vec2(high.x, low.y)),
        ("kerb", vec2(low.x, high.y), vec2(high.x, high.y + kerb)),
    ] {
        let (from, to) = (vec3(from.x, -0.02, from.y), vec3(to.x, proud, to.y));
        b.push(name, block(from, to, 0.25, stone.clone()));
    }
    b.push("lawn", ring_of_cells(low - 0.6 * kerb, high + 0.6 * kerb, 60.0, lawn, land));

    // A hedge round the far corner.
    let corner = high + vec2(1.25, 1.05);
    let profile = [0.24, 0.33];
    let line = [vec2(corner.x, low.y - 2.5), corner, vec2(low.x - 3.5, corner.y)];
    b.push("hedge", hedge(&line, profile, 0.07, hedge_green.clone()));

    // Trees behind it, and bushes at its foot.
    let (mut crowns, mut wood) = ([Vec::new(), Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
    let mut trunks = Mesh::default();
    const TREES: usize = 22;
    for i in 0..TREES {
        let n = |seed| number(i, seed);
        // From the left of the far corner to its right, crown by crown: dark and even behind what is white.
        let part = (i as f32 + 0.7 * (n(31) - 0.5)) / (TREES - 1) as f32;
        let around = PI * (1.3 * part - 0.15) - 0.25 * PI;
        let away = 4.6 + 2.2 * n(32);
        let at = away * Vec2::from_angle(around);
        let height = (1.35 + 0.75 * n(33)) * (0.7 + 0.06 * away);
        tree(at, height, i, &mut crowns[(3.0 * n(34)) as usize % 3], &mut trunks);
    }
    // A wood before the hills, all round.
    for i in 0..320 {
        let n = |seed| number(i, seed);
        let at = (16.0 + 9.0 * n(41)) * Vec2::from_angle(TAU * (i as f32 + n(42)) / 320.0);
        let size = 0.35 + 0.55 * n(43);
        let half = size * vec3(1.0, 0.8 + 0.3 * n(44), 1.0);
        let middle = vec3(at.x, land(at) + (0.4 + 1.1 * n(45)) * half.y, at.y);
        wood[i % 2].push(Lump { middle, half, rough: 0.3, seed: 900 + 3 * i as u32 });
    }
    let greens = [hedge_green, oak.clone(), ash.clone(), oak, ash];
    for (i, (crowns, green)) in crowns.iter().chain(&wood).zip(greens).enumerate() {
        let mut mesh = lumps(crowns, if i < 3 { 4 } else { 7 }, green);
        sprays(&mut mesh, crowns, i as u32);
        b.push("leaves", mesh);
    }
    trunks.material = bark;
    trunks.normals = smooth_normals(&trunks.positions, &trunks.indices);
    b.push("trunks", trunks);
    if let Some(ground) = &mut scene.ground {
        ground.reach = Some((half.max_element() + 1.1) * b.wide);
    }
    scene.backdrop = b.meshes;
    scene.haze = Some(130.0 * b.wide);
}

/// A floor that passes into the backdrop without a seam, as a cyclorama's does: by haze.
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
    scene.backdrop = b.meshes;
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

/// A hall: a floor of resin, a tiled wall with a plain one above it.
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
    scene.backdrop = b.meshes;
}

/// A height field round a rectangle, out to a distance, ever coarser.
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

/// A clipped hedge along a line, so thick and so high, in steps; its ends are round.
fn hedge(line: &[Vec2], [thick, high]: [f32; 2], step: f32, material: Material) -> Mesh {
    const ACROSS: usize = 13;
    let mut mesh = Mesh { material, ..Mesh::default() };
    let mut along = Vec::new();
    for pair in line.windows(2) {
        let count = (pair[0].distance(pair[1]) / step).ceil() as usize;
        along.extend((0..count).map(|i| pair[0].lerp(pair[1], i as f32 / count as f32)));
    }
    along.extend(line.last());
    let last = along.len() - 1;
    for (i, at) in along.iter().enumerate() {
        let way = (along[(i + 1).min(last)] - along[i.saturating_sub(1)]).normalize_or(Vec2::X);
        let side = vec2(-way.y, way.x);
        let end = 1.0 - (1.0 - i.min(last - i) as f32 / 2.0).clamp(0.0, 1.0).powi(2);
        for k in 0..ACROSS {
            // Up one side, over the top, down the other: a rectangle with round edges.
            let t = k as f32 / (ACROSS - 1) as f32;
            let angle = PI * t;
            let (c, s) = (angle.cos(), angle.sin());
            let square = |v: f32| v.signum() * v.abs().powf(0.28);
            let dent = 0.022 * octaves(vec2(11.0 * i as f32 * step, 7.0 * t), 3, 77)
                + 0.012 * octaves(vec2(2.0 * i as f32 * step, 2.0 * t), 2, 78);
            let across = (0.5 * thick * end + dent) * square(c);
            let y = (high * (0.25 + 0.75 * end) + dent) * square(s);
            let p = *at + side * across;
            mesh.positions.push([p.x, y, p.y]);
            if i < last && k + 1 < ACROSS {
                let a = (i * ACROSS + k) as u32;
                let b = a + ACROSS as u32;
                mesh.indices.extend([a, a + 1, b + 1, a, b + 1, b]);
            }
        }
    }
    mesh.normals = smooth_normals(&mesh.positions, &mesh.indices);
    // Outside is away from the line.
    let outside = |p: &[f32; 3], n: &[f32; 3]| p[1] < 0.5 * high || n[1] > 0.0;
    let wrong = mesh.positions.iter().zip(&mesh.normals).filter(|(p, n)| !outside(p, n)).count();
    if 2 * wrong > mesh.positions.len() / 3 {
        mesh.normals.iter_mut().flatten().for_each(|v| *v = -*v);
        mesh.indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
    }
    mesh
}

/// Leaves that stand out of lumps, so that their outlines are ragged: triangles, lit as the lump is.
fn sprays(mesh: &mut Mesh, lumps: &[Lump], seed: u32) {
    const EACH: usize = 40;
    for (i, lump) in lumps.iter().enumerate() {
        for k in 0..EACH {
            let n = |of: u32| number(EACH * i + k, 10 * seed + 400 + of);
            let around = TAU * n(0);
            let up = 1.0 - 1.6 * n(1);
            let level = (1.0 - up * up).max(0.0).sqrt();
            let out = vec3(level * around.cos(), up, level * around.sin());
            let at = lump.middle + lump.half * out * (0.80 + 0.25 * n(2));
            let size = lump.half.min_element().min(0.2) * (0.14 + 0.22 * n(3));
            let (a, b) = (TAU * n(4), PI * n(5));
            let along = vec3(a.cos() * b.sin(), b.cos(), a.sin() * b.sin());
            let across = along.cross(out).normalize_or(Vec3::X);
            let first = mesh.positions.len() as u32;
            for corner in [
                size * along,
                size * (0.5 * across - 0.6 * along),
                -size * (0.7 * across + 0.3 * along),
            ] {
                mesh.positions.push((at + corner).to_array());
                mesh.normals.push(out.to_array());
            }
            mesh.indices.extend([first, first + 1, first + 2]);
        }
    }
}

/// A crown of lumps on a trunk.
fn tree(at: Vec2, height: f32, seed: usize, crown: &mut Vec<Lump>, wood: &mut Mesh) {
    const LUMPS: usize = 38;
    const SIDES: usize = 7;
    let ground = land(at);
    let n = |i: usize, of: u32| number(40 * seed + i, 70 + of);
    let reach = height * vec3(0.30 + 0.1 * n(0, 0), 0.36, 0.30 + 0.1 * n(0, 1));
    let middle = vec3(at.x, ground + 0.60 * height, at.y);
    crown.push(Lump { middle, half: 0.66 * reach, rough: 0.3, seed: 7 * seed as u32 });
    for i in 0..LUMPS {
        // Over the sphere by the golden angle, less of it below.
        let up = 1.0 - 1.75 * (i as f32 + 0.5) / LUMPS as f32;
        let around = 2.399_963_1 * (i as f32 + n(i, 2));
        let level = (1.0 - up * up).max(0.0).sqrt();
        let out = vec3(level * around.cos(), up, level * around.sin());
        let size = height * (0.055 + 0.065 * n(i, 3));
        crown.push(Lump {
            middle: middle + reach * out * (0.60 + 0.36 * n(i, 4)),
            half: size * vec3(1.0, 0.72, 1.0),
            rough: 0.35,
            seed: 31 * (seed * LUMPS + i) as u32,
        });
    }
    let first = wood.positions.len() as u32;
    for (ring, (y, radius)) in [(-0.02, 0.032), (0.1, 0.022), (0.45, 0.015)].into_iter().enumerate()
    {
        for side in 0..SIDES {
            let out = Vec2::from_angle(TAU * side as f32 / SIDES as f32) * radius * height;
            wood.positions.push([at.x + out.x, ground + y * height, at.y + out.y]);
            if ring < 2 {
                let up = |i: usize| first + (ring * SIDES + i % SIDES) as u32;
                let (a, b) = (up(side), up(side + 1));
                let (c, d) = (a + SIDES as u32, b + SIDES as u32);
                wood.indices.extend([a, c, d, a, d, b]);
            }
        }
    }
}
