//! A flood comes down a street of plain houses towards the eye, over dry paving. Its front tumbles; it piles up before
//! obstacles and leaves wakes behind them.

use std::sync::OnceLock;

use glam::{Vec2, Vec3, vec2, vec3};
use whitewater::headless::scene::{Material, Mesh, Pattern};

use crate::noise::{laces, octaves, smooth, value};
use crate::random::{Field, Random};
use crate::surface::{Spot, Table, grid};
use crate::throw::Clump;
use crate::{BUBBLE, FOAM, Particle, Plan};

pub const PLAN: Plan = Plan {
    draw: [foam, spray, bubble],
    shares: [0.66, 0.22, 0.12],
    bounds: [vec3(-40.0, -1.0, -85.0), vec3(40.0, 16.0, 40.0)],
    radius: 0.052,
    eye: vec3(4.5, 12.5, 43.0),
    target: vec3(-0.6, 1.0, 0.0),
    fov: 44.0,
    sun: vec3(0.60, 0.70, 0.38),
};

const LOW: Vec2 = vec2(-34.0, -80.0);
const HIGH: Vec2 = vec2(34.0, 22.0);

/// Houses: middle, half extents, height.
const HOUSES: [(Vec2, Vec2, f32); 10] = [
    (vec2(-17.0, 12.0), vec2(7.0, 9.0), 9.0),
    (vec2(-18.0, -14.0), vec2(8.0, 10.0), 14.0),
    (vec2(-17.5, -45.0), vec2(7.5, 12.0), 11.0),
    (vec2(18.0, 16.0), vec2(7.5, 8.0), 7.0),
    (vec2(18.0, -10.0), vec2(8.0, 11.0), 17.0),
    (vec2(18.0, -42.0), vec2(8.0, 13.0), 12.0),
    (vec2(0.0, -88.0), vec2(20.0, 8.0), 15.0),
    (vec2(-28.0, -86.0), vec2(8.0, 9.0), 10.0),
    (vec2(28.0, -86.0), vec2(8.0, 9.0), 12.0),
    (vec2(-32.0, -30.0), vec2(5.0, 40.0), 16.0),
];

/// Obstacles in the street: middle, half extents, height.
const BLOCKS: [(Vec2, Vec2, f32); 7] = [
    (vec2(-4.2, 1.5), vec2(0.95, 2.2), 2.6),
    (vec2(4.6, -4.0), vec2(1.3, 2.8), 3.6),
    (vec2(-6.4, -14.0), vec2(0.95, 2.2), 3.2),
    (vec2(1.0, -17.0), vec2(0.6, 0.6), 7.5),
    (vec2(6.6, -24.0), vec2(1.0, 2.3), 3.4),
    (vec2(-3.0, -32.0), vec2(1.4, 1.4), 4.4),
    (vec2(6.2, 8.4), vec2(0.95, 2.1), 1.7),
];

fn inside(p: Vec2) -> bool {
    HOUSES.iter().chain(&BLOCKS).any(|(middle, half, _)| (p - *middle).abs().cmplt(*half).all())
}

/// Distance from a box, and distance down its wake.
fn beside(p: Vec2, middle: Vec2, half: Vec2) -> (f32, f32) {
    let away = ((p - middle).abs() - half).max(Vec2::ZERO).length();
    (away, p.y - middle.y - half.y)
}

/// Position of the front along the street. It lags near the walls.
fn front(x: f32) -> f32 {
    let ragged = 4.5 * (octaves(vec2(0.16 * x, 3.7), 4) - 0.5)
        + 1.2 * (octaves(vec2(0.9 * x, 9.0), 3) - 0.5);
    13.0 + ragged - 0.030 * x * x
}

fn surface(p: Vec2) -> Vec3 {
    let s = front(p.x) - p.y;
    // A steep bore, and a slow rise behind it.
    let rise = smooth(-0.2, 2.6, s);
    let high = rise * (1.15 + 1.35 * smooth(0.0, 40.0, s));
    let flow = vec2(0.5 * p.x, 0.28 * p.y);
    let rough = 0.75 * (octaves(flow, 4) - 0.5) + 0.25 * (octaves(1.6 * p, 3) - 0.5);
    let mut y = high + rise * rough * (0.5 + 0.7 * smooth(16.0, 2.0, s));
    y += 0.55 * smooth(0.3, 1.6, s) * smooth(4.5, 1.6, s) * octaves(0.9 * p, 3);
    for (middle, half, _) in BLOCKS {
        let (away, down) = beside(p, middle, half);
        // The water piles up before an obstacle and is hollow behind it.
        y += rise * 0.9 * smooth(1.6, 0.0, away) * smooth(0.4, -1.0, down + 2.0 * half.y);
        y -= rise
            * 0.5
            * smooth(half.x + 0.6, 0.0, (p.x - middle.x).abs())
            * smooth(-0.2, 0.6, down)
            * smooth(5.0, 0.5, down);
    }
    vec3(p.x, if s < -0.2 { -0.12 } else { y - 0.1 * (1.0 - rise) }, p.y)
}

fn cover(p: Vec2) -> (f32, f32, f32) {
    let s = front(p.x) - p.y;
    if s < -0.1 {
        return (0.0, 1.0, 0.0);
    }
    let patch = octaves(vec2(0.16, 0.08) * p + 31.0, 3);
    let (mut amount, mut age) = (0.0_f32, 0.2);
    let mut take = |more: f32, old: f32| {
        if more > amount {
            (amount, age) = (more, old);
        }
    };
    take(1.1 * smooth(9.0, 2.5, s + 6.0 * (octaves(0.25 * p, 3) - 0.5)), 0.1);
    take(
        (0.30 + 0.32 * smooth(30.0, 6.0, s)) * smooth(0.34, 0.60, patch),
        0.3 + 0.4 * smooth(8.0, 60.0, s),
    );
    for (middle, half, _) in BLOCKS {
        let (away, down) = beside(p, middle, half);
        let across = (p.x - middle.x).abs();
        take(1.0 * smooth(1.3, 0.2, away + 0.8 * (octaves(1.2 * p, 2) - 0.5)), 0.15);
        // Two lines of foam leave the obstacle's sides.
        let line = (across - half.x - 0.10 * down.max(0.0)).abs();
        let wide = 0.5 + 0.05 * down.max(0.0);
        take(
            0.9 * smooth(wide, 0.2 * wide, line)
                * smooth(-2.0 * half.y, 0.0, down)
                * smooth(16.0, 3.0, down),
            0.2 + 0.03 * down.max(0.0),
        );
        let wake = smooth(half.x + 0.10 * down.max(0.0), 0.0, across)
            * smooth(-0.1, 0.4, down)
            * smooth(12.0, 1.0, down);
        take(0.75 * wake, 0.3);
    }
    for (middle, half, _) in HOUSES {
        let (away, _) = beside(p, middle, half);
        take(0.85 * smooth(2.2, 0.2, away + 1.6 * (octaves(0.5 * p, 3) - 0.5)), 0.3);
    }
    (amount, 0.9 + 0.9 * smooth(0.7, 0.1, amount), age)
}

/// Surface and foam, tabulated.
fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(|| Table::new(LOW, HIGH, surface, cover))
}

/// Density of the foam.
fn density(p: Vec2) -> f32 {
    let Spot { amount, cell, .. } = table().at(p);
    if amount <= 0.01 || inside(p) {
        return 0.0;
    }
    // The stream stretches the foam.
    let q = vec2(p.x, 0.55 * p.y + 0.5 * value(0.3 * p));
    laces(q, amount, cell) * (0.25 + 0.75 * smooth(0.3, 1.0, amount))
}

fn foam(random: &mut Random) -> Particle {
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p = FIELD.get_or_init(|| Field::new(LOW, HIGH, density)).draw(random);
    let Spot { mut position, amount, age, .. } = table().at(p);
    let heap = 0.03 + 0.5 * smooth(0.85, 1.1, amount) * octaves(1.2 * p, 2);
    position.y += heap * random.unit().powf(1.5) + 0.02;
    position += 0.03 * random.ball();
    position.y = position.y.max(0.02);
    Particle { position, kind: FOAM, age: age + 0.15 * random.unit() }
}

fn bubble(random: &mut Random) -> Particle {
    let under = |p: Vec2| -> f32 {
        let amount = table().at(p).amount;
        if inside(p) { 0.0 } else { smooth(0.2, 1.0, amount) * (0.3 + 0.7 * octaves(0.7 * p, 2)) }
    };
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p = FIELD.get_or_init(|| Field::new(LOW, HIGH, under)).draw(random);
    let mut position = table().at(p).position - Vec3::Y * random.decay(0.12).min(1.0);
    position.y = position.y.max(0.02);
    Particle { position, kind: BUBBLE, age: 0.6 * random.unit() }
}

/// Spray at the front, and where the stream hits obstacles.
fn spray(random: &mut Random) -> Particle {
    if random.unit() < 0.66 {
        const CLUMPS: u32 = 700;
        let mut lots = Random::new(random.below(CLUMPS), 4000);
        let x = lots.between(-9.5, 10.0);
        let p = vec2(x, front(x) - lots.between(0.2, 3.5));
        let from = table().at(p).position;
        let strong = 0.3 + 0.7 * value(vec2(0.5 * x, 60.0));
        let clump = Clump {
            from,
            velocity: vec3(
                lots.between(-1.6, 1.6),
                lots.between(1.0, 5.5) * strong,
                lots.between(0.0, 3.6),
            ),
            time: lots.between(0.15, 0.65),
            spread: lots.between(0.3, 0.8),
            wind: Vec3::ZERO,
        };
        return clump.draw(random, 0.03);
    }
    const CLUMPS: u32 = 420;
    let mut lots = Random::new(random.below(CLUMPS), 4001);
    let (middle, half, _) = BLOCKS[lots.below(6) as usize];
    let x = middle.x + half.x * lots.between(-1.1, 1.1);
    let p = vec2(x, middle.y - half.y - 0.15);
    let from = table().at(p).position;
    let clump = Clump {
        from,
        velocity: vec3(
            1.4 * (x - middle.x) + lots.between(-0.8, 0.8),
            lots.between(2.0, 6.2),
            lots.between(-1.4, 1.6),
        ),
        time: lots.between(0.2, 0.75),
        spread: lots.between(0.25, 0.7),
        wind: Vec3::ZERO,
    };
    clump.draw(random, from.y - 0.3)
}

/// Dry paving.
pub fn ground() -> Material {
    let pattern = Pattern::Paving { size: 1.2 };
    Material { base_color: [0.30, 0.28, 0.25], roughness: 0.9, pattern, texture: None }
}

pub fn meshes() -> Vec<Mesh> {
    let place = |uv: Vec2| {
        let away = 1.0 - uv.y;
        vec2(LOW.x + (HIGH.x - LOW.x) * uv.x, HIGH.y + (LOW.y - HIGH.y) * away * (0.5 + 0.5 * away))
    };
    let (brown, milky) = (vec3(0.075, 0.070, 0.045), vec3(0.30, 0.29, 0.22));
    let tint = |p: Vec2| {
        let (amount, _, _) = cover(p);
        brown.lerp(milky, 0.8 * smooth(0.2, 1.0, amount))
    };
    let mut meshes = vec![grid("flood", [230, 260], place, surface, tint, 0.16)];
    let walls = [
        [0.52, 0.40, 0.28],
        [0.58, 0.53, 0.44],
        [0.44, 0.27, 0.20],
        [0.50, 0.48, 0.43],
        [0.55, 0.46, 0.34],
    ];
    for (i, (middle, half, high)) in HOUSES.into_iter().enumerate() {
        let wall =
            Material { base_color: walls[i % walls.len()], roughness: 0.85, ..Material::default() };
        let mut add = |centre: Vec3, half: Vec3, material: Material| {
            let turn = [0.0, 0.0, 0.0, 1.0];
            meshes.push(Mesh::cuboid(centre.to_array(), half.to_array(), turn, material));
        };
        let at = |y: f32| vec3(middle.x, y, middle.y);
        add(at(0.5 * high), vec3(half.x, 0.5 * high, half.y), wall.clone());
        let roof =
            Material { base_color: [0.16, 0.10, 0.08], roughness: 0.8, ..Material::default() };
        add(at(high + 0.15), vec3(half.x + 0.4, 0.2, half.y + 0.4), roof);
        // Windows that face the street.
        let glass =
            || Material { base_color: [0.03, 0.04, 0.05], roughness: 0.12, ..Material::default() };
        let side = -middle.x.signum();
        let rows = (high / 3.2) as u32;
        let columns = (2.0 * half.y / 3.0) as u32;
        if half.y < 20.0 && middle.y > -80.0 {
            for row in 1..rows {
                for column in 0..columns {
                    let z =
                        middle.y - half.y + (column as f32 + 0.5) * 2.0 * half.y / columns as f32;
                    let centre = vec3(middle.x + side * half.x, 3.2 * row as f32 + 1.4, z);
                    add(centre, vec3(0.06, 0.8, 0.55), glass());
                }
            }
        }
    }
    let colors = [
        [0.10, 0.16, 0.30],
        [0.55, 0.52, 0.46],
        [0.42, 0.06, 0.05],
        [0.20, 0.21, 0.20],
        [0.60, 0.45, 0.06],
        [0.32, 0.33, 0.33],
        [0.45, 0.46, 0.48],
    ];
    for ((middle, half, high), color) in BLOCKS.into_iter().zip(colors) {
        let material = Material { base_color: color, roughness: 0.35, ..Material::default() };
        let centre = [middle.x, 0.5 * high, middle.y];
        meshes.push(Mesh::cuboid(
            centre,
            [half.x, 0.5 * high, half.y],
            [0.0, 0.0, 0.0, 1.0],
            material,
        ));
    }
    meshes
}
