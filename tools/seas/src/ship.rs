//! A ship under way at 10 m/s towards +x, with the water that its bow throws aside, the arms of its wake, and the white
//! band behind its propellers.

use std::sync::OnceLock;

use glam::{Vec2, Vec3, vec2, vec3};
use whitewater::headless::scene::{Material, Mesh};

use crate::noise::{laces, octaves, smooth};
use crate::random::{Field, Random};
use crate::surface::{Spot, Table, Waves, grid};
use crate::throw::Clump;
use crate::{BUBBLE, DEEP, FOAM, OPEN_SEA, Particle, Plan, aerated};

pub const PLAN: Plan = Plan {
    draw: [foam, spray, bubble],
    shares: [0.74, 0.20, 0.06],
    bounds: [vec3(-240.0, -8.0, -170.0), vec3(115.0, 24.0, 120.0)],
    radius: 0.078,
    eye: vec3(-82.0, 19.0, 74.0),
    target: vec3(-19.0, 0.0, 4.0),
    fov: 38.0,
    sun: vec3(-0.55, 0.66, 0.50),
};

const LOW: Vec2 = vec2(-230.0, -160.0);
const HIGH: Vec2 = vec2(110.0, 80.0);

const BOW: f32 = 40.0;
const STERN: f32 = -40.0;

/// Half of the hull's breadth at a position along it and a height.
fn half_beam(x: f32, y: f32) -> f32 {
    if !(STERN..=BOW).contains(&x) {
        return 0.0;
    }
    let t = (x - 8.0) / (BOW - 8.0);
    let fore = if t > 0.0 { 1.0 - t.powf(2.2) } else { 1.0 };
    let aft = 1.0 - 0.22 * smooth(-24.0, STERN, x);
    // Narrow at the waterline, flared above it.
    let flare =
        1.0 + 0.10 * smooth(0.0, 7.0, y) - 0.25 * smooth(0.0, 1.0, t) * smooth(6.0, -1.0, y);
    7.0 * fore.max(0.0) * aft * flare
}

fn waves() -> &'static Waves {
    static WAVES: OnceLock<Waves> = OnceLock::new();
    WAVES.get_or_init(|| Waves::new(vec2(-0.8, -0.6), 46.0, 2.2, 0.030))
}

/// Distance outwards from the crest of the bow wave, and distance along it from the bow.
fn arm(p: Vec2) -> (f32, f32) {
    let along = BOW - p.x;
    (p.y.abs() - (1.2 + 0.36 * along + 2.5 * smooth(0.0, 14.0, along)), along)
}

fn surface(p: Vec2) -> Vec3 {
    let (out, along) = arm(p);
    let mut y = waves().height(p);
    if along > -4.0 {
        let wide = 1.8 + 0.045 * along.max(0.0);
        let high = 2.9 * smooth(-4.0, 5.0, along) * (-along.max(0.0) / 75.0).exp();
        let side = if out > 0.0 { out / (0.8 * wide) } else { out / (1.8 * wide) };
        y += high * (-side * side).exp();
        // Further crests of the wake lie inside the first, each shorter.
        let inside = smooth(0.0, -6.0, out) * smooth(20.0, 60.0, along) * (-along / 130.0).exp();
        y += 0.55 * inside * (0.42 * (p.y.abs() * 1.35 - 0.45 * along)).sin();
        // Transverse waves behind the stern.
        let across = smooth(30.0, 90.0, along) * smooth(2.0, -10.0, out) * (-along / 160.0).exp();
        y += 0.5 * across * (0.098 * along * 1.5).cos();
    }
    let band = behind(p);
    y += 0.7 * band * (octaves(0.5 * p, 4) - 0.5);
    let edge = smooth(0.0, 60.0, p.x - LOW.x)
        * smooth(0.0, 40.0, HIGH.x - p.x)
        * smooth(0.0, 50.0, p.y - LOW.y)
        * smooth(0.0, 20.0, HIGH.y - p.y);
    let floor = OPEN_SEA - 0.05;
    vec3(p.x, floor + edge * (y - floor), p.y)
}

/// Strength of the band behind the propellers, 0 to 1.
fn behind(p: Vec2) -> f32 {
    let away = STERN - p.x;
    if away < -3.0 {
        return 0.0;
    }
    let wide = 5.5
        + 0.055 * away.max(0.0)
        + 1.4 * (octaves(vec2(0.05 * p.x, 3.0 * p.y.signum()), 3) - 0.5);
    smooth(wide + 1.2, wide - 2.0, p.y.abs()) * smooth(-3.0, 1.0, away)
}

/// Covered fraction, size of the holes, and age of the foam.
fn cover(p: Vec2) -> (f32, f32, f32) {
    let (out, along) = arm(p);
    let patch = octaves(0.06 * p, 3);
    let beam = half_beam(p.x, 0.3);
    let (mut amount, mut age) = (0.0_f32, 0.2);
    let mut take = |more: f32, old: f32| {
        if more > amount {
            (amount, age) = (more, old);
        }
    };
    if along > -1.5 {
        let fresh = (-along.max(0.0) / 34.0).exp();
        // The sheet of foam between hull and crest.
        let sheet = smooth(1.6 + 0.6 * patch, -0.6, out)
            * smooth(-beam - 0.6, -beam + 0.4, -2.0 * beam + p.y.abs());
        let near = smooth(42.0, 12.0, along + 10.0 * (octaves(0.22 * p, 3) - 0.5));
        take(
            sheet * (0.35 + 0.7 * near) * smooth(95.0, 30.0, along),
            0.1 + 0.4 * smooth(10.0, 60.0, along),
        );
        // The crest breaks in pieces, fewer with distance from the bow.
        let piece = octaves(vec2(0.20 * along, 0.32 * out) + 21.0, 3);
        let crest = smooth(-4.2 - 0.06 * along, -0.8, out) * smooth(1.7, 0.2, out);
        take(
            crest * (1.1 * fresh + 0.9 * smooth(0.40, 0.58, piece) * smooth(190.0, 40.0, along)),
            0.15 + 0.3 * (1.0 - fresh),
        );
        // Foam along the hull's side.
        let skirt = smooth(3.4, 0.3, p.y.abs() - beam) * f32::from(p.x > STERN - 2.0);
        take(skirt * (0.55 + 0.4 * patch), 0.3);
        // Foam that the arms leave inside the wake.
        let inside = smooth(0.0, -4.0, out) * smooth(150.0, 30.0, along) * smooth(8.0, 20.0, along);
        take(0.45 * inside * smooth(0.44, 0.56, patch), 0.5 + 0.25 * patch);
    }
    let away = (STERN - p.x).max(0.0);
    let band = behind(p);
    let rim = 0.8 + 0.3 * smooth(0.5, 0.1, (band - 0.4).abs());
    take(band * rim * (0.5 + 0.6 * (-away / 50.0).exp()), 0.15 + 0.6 * smooth(10.0, 150.0, away));
    // White caps.
    let cap = octaves(vec2(0.05 * (p.x + p.y), 0.11 * (p.x - p.y)) + 80.0, 4);
    let high = smooth(-0.2, 0.9, waves().height(p));
    take(0.8 * smooth(0.63, 0.74, cap) * high, 0.35);
    (amount, 1.6 + 1.6 * smooth(0.7, 0.1, amount), age)
}

/// Surface and foam, tabulated.
fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(|| Table::new(LOW, HIGH, surface, cover))
}

/// Density of the foam.
fn density(p: Vec2) -> f32 {
    let Spot { amount, cell, .. } = table().at(p);
    if amount <= 0.01 || p.y.abs() < half_beam(p.x, 0.5) - 0.3 {
        return 0.0;
    }
    let q = vec2(0.6 * p.x, p.y);
    laces(q, amount, cell) * (0.25 + 0.75 * smooth(0.3, 1.0, amount))
}

fn foam(random: &mut Random) -> Particle {
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p =
        FIELD.get_or_init(|| Field::new(LOW + 45.0 * Vec2::X, HIGH - 4.0, density)).draw(random);
    let Spot { mut position, amount, age, .. } = table().at(p);
    position.y +=
        (0.05 + 0.35 * smooth(0.8, 1.1, amount) * octaves(0.9 * p, 2)) * random.unit() + 0.03;
    position += 0.05 * random.ball();
    Particle { position, kind: FOAM, age: age + 0.15 * random.unit() }
}

fn bubble(random: &mut Random) -> Particle {
    let under = |p: Vec2| -> f32 {
        let amount = table().at(p).amount;
        smooth(0.3, 1.0, amount) * (0.3 + 0.7 * octaves(0.5 * p, 2))
    };
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p = FIELD.get_or_init(|| Field::new(LOW + 45.0 * Vec2::X, HIGH - 4.0, under)).draw(random);
    let position = table().at(p).position - Vec3::Y * random.decay(0.25).min(2.5);
    Particle { position, kind: BUBBLE, age: 0.6 * random.unit() }
}

/// Spray: the bow throws a sheet to both sides, which the ship leaves behind; farther back the crests throw less.
fn spray(random: &mut Random) -> Particle {
    const CLUMPS: u32 = 900;
    let mut lots = Random::new(random.below(CLUMPS), 2000);
    let side = if lots.unit() < 0.5 { -1.0 } else { 1.0 };
    let along = 1.0 + 26.0 * lots.unit() * lots.unit();
    let strong = (-along / 20.0).exp() * (0.55 + 0.45 * lots.unit());
    let x = BOW - along;
    let z = side * (half_beam(x, 0.5).max(0.4) + 0.3 + 0.12 * along * lots.unit());
    let from = table().at(vec2(x, z)).position + 0.2 * Vec3::Y;
    let clump = Clump {
        from,
        velocity: vec3(
            lots.between(-6.0, 0.0),
            lots.between(3.5, 11.0) * strong,
            side * lots.between(2.0, 7.0) * (0.3 + 0.7 * strong),
        ),
        time: lots.between(0.3, 0.5 + 0.9 * strong),
        spread: lots.between(0.3, 1.0),
        wind: vec3(-2.5, 0.0, -1.0),
    };
    clump.draw(random, from.y - 0.5)
}

fn paint(color: [f32; 3]) -> Material {
    Material { base_color: color, roughness: 0.5, ..Material::default() }
}

/// A part of the ship from stem to stern. `at` gives the point at a position along the ship and a fraction across the
/// part.
fn strip(color: [f32; 3], rows: u32, at: impl Fn(f32, f32) -> Vec3) -> Mesh {
    const STATIONS: u32 = 72;
    let mut mesh = Mesh { name: "hull".into(), material: paint(color), ..Mesh::default() };
    for i in 0..=STATIONS {
        let x = STERN + (BOW - STERN) * i as f32 / STATIONS as f32;
        for j in 0..=rows {
            let t = j as f32 / rows as f32;
            let along = at((x + 0.3).min(BOW), t) - at((x - 0.3).max(STERN), t);
            let up = at(x, (t + 0.03).min(1.0)) - at(x, (t - 0.03).max(0.0));
            mesh.positions.push(at(x, t).to_array());
            mesh.normals.push(along.cross(up).normalize_or(Vec3::X).to_array());
            if i < STATIONS && j < rows {
                let a = i * (rows + 1) + j;
                let b = a + rows + 1;
                mesh.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
            }
        }
    }
    mesh
}

/// The sides in two colours, and the deck.
fn hull() -> Vec<Mesh> {
    let deck = |x: f32| 5.4 + 3.0 * smooth(10.0, BOW, x) + 0.5 * smooth(-20.0, STERN, x);
    // The stem leans forward.
    let at = |x: f32, y: f32, part: f32| {
        let ahead = 0.42 * y.max(0.0) * smooth(28.0, BOW, x);
        vec3(x + ahead, y, part * half_beam(x, y).max(0.05))
    };
    let mut parts = Vec::new();
    for side in [-1.0, 1.0] {
        parts.push(strip([0.30, 0.045, 0.035], 6, |x, t| at(x, -2.0 + 3.4 * t, side)));
        parts.push(strip([0.035, 0.05, 0.085], 8, |x, t| at(x, 1.4 + (deck(x) - 1.4) * t, side)));
    }
    parts.push(strip([0.20, 0.25, 0.21], 2, |x, t| at(x, deck(x) - 0.9, 2.0 * t - 1.0)));
    parts
}

pub fn meshes() -> Vec<Mesh> {
    let place = |uv: Vec2| {
        let along = uv.x;
        let away = 1.0 - uv.y;
        vec2(
            LOW.x + (HIGH.x - LOW.x) * along,
            HIGH.y + (LOW.y - HIGH.y) * away * (0.55 + 0.45 * away),
        )
    };
    let tint = |p: Vec2| {
        let (amount, _, _) = cover(p);
        aerated(DEEP, amount)
    };
    let mut meshes = vec![grid("sea", [250, 230], place, surface, tint, 0.16)];
    meshes.extend(hull());
    let white = || paint([0.78, 0.77, 0.74]);
    let mut block = |centre: [f32; 3], half: [f32; 3], material: Material| {
        meshes.push(Mesh::cuboid(centre, half, [0.0, 0.0, 0.0, 1.0], material));
    };
    // The transom closes the stern.
    block([STERN, 1.9, 0.0], [0.25, 4.0, 5.4], paint([0.035, 0.05, 0.085]));
    block([-24.0, 7.6, 0.0], [10.0, 2.6, 5.6], white());
    block([-22.0, 11.8, 0.0], [6.0, 1.8, 5.0], white());
    block([-17.5, 14.6, 0.0], [2.6, 1.2, 6.4], white());
    block([-14.85, 14.7, 0.0], [0.08, 0.6, 5.6], paint([0.02, 0.03, 0.04]));
    block([-28.0, 15.0, 0.0], [2.0, 2.6, 1.6], paint([0.75, 0.22, 0.04]));
    // Holds and a crane stand on the deck.
    for x in [-6.0, 6.0, 18.0] {
        block([x, 5.4, 0.0], [4.2, 0.9, 4.2], paint([0.34, 0.36, 0.36]));
    }
    block([0.0, 9.0, 0.0], [0.45, 5.0, 0.45], paint([0.75, 0.60, 0.10]));
    block([6.0, 13.0, 0.0], [7.0, 0.3, 0.3], paint([0.75, 0.60, 0.10]));
    block([31.0, 9.4, 0.0], [0.25, 4.0, 0.25], white());
    meshes
}
