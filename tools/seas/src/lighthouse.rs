//! A lighthouse on a rock. A wave has just hit it from -x: a sheet of water stands up over the rock, earlier water runs
//! off it, and the sea around it is white near the rock and laced farther out.

use std::sync::OnceLock;

use glam::{Vec2, Vec3, vec2, vec3};
use whitewater::headless::scene::{Material, Mesh};

use crate::noise::{laces, octaves, smooth, value};
use crate::random::{Field, Random};
use crate::surface::{Spot, Table, Waves, grid};
use crate::throw::Clump;
use crate::{BUBBLE, DEEP, FOAM, OPEN_SEA, Particle, Plan, aerated};

pub const PLAN: Plan = Plan {
    draw: [foam, spray, bubble],
    shares: [0.58, 0.34, 0.08],
    bounds: [vec3(-120.0, -8.0, -140.0), vec3(120.0, 40.0, 80.0)],
    radius: 0.078,
    eye: vec3(16.0, 10.0, 68.0),
    target: vec3(-3.0, 8.5, 0.0),
    fov: 36.0,
    sun: vec3(0.62, 0.55, 0.56),
};

const LOW: Vec2 = vec2(-110.0, -130.0);
const HIGH: Vec2 = vec2(110.0, 62.0);

/// Height of the rock over the sea's mean; it falls to deep water far away.
fn rock(p: Vec2) -> f32 {
    let q = p * vec2(1.0, 1.25);
    let ragged = 5.0 * (octaves(0.16 * p + 40.0, 4) - 0.5);
    let away = q.length() + ragged;
    let body = 7.0 * smooth(17.0, 3.0, away) - 3.2 * smooth(9.0, 22.0, away);
    // Ledges.
    let ledge = body + 2.2 * (octaves(0.33 * p, 4) - 0.5);
    let steps = 1.3 * (ledge / 1.3).floor() + 1.3 * smooth(0.55, 1.0, (ledge / 1.3).fract());
    let top = smooth(5.5, 3.0, p.length());
    let rough = 0.65 * steps + 0.35 * ledge + 0.5 * (octaves(1.1 * p, 3) - 0.5);
    // The rock is level under the tower.
    rough + top * (6.2 - rough)
}

fn waves() -> &'static Waves {
    static WAVES: OnceLock<Waves> = OnceLock::new();
    WAVES.get_or_init(|| Waves::new(vec2(1.0, 0.45), 38.0, 1.8, 0.042))
}

/// Approximate distance from the rock's edge, out in the water.
fn offshore(p: Vec2) -> f32 {
    let q = p * vec2(1.0, 1.25);
    q.length() + 5.0 * (octaves(0.16 * p + 40.0, 4) - 0.5) - 13.2
}

/// Height of the wave that has run up the rock, 0 to 1.
fn mound(p: Vec2) -> f32 {
    let q = (p - vec2(-17.5, 3.0)) / vec2(7.0, 13.0);
    (-q.length_squared()).exp()
}

fn surface(p: Vec2) -> Vec3 {
    let mut y = waves().height(p) * (0.35 + 0.65 * smooth(0.0, 16.0, offshore(p)));
    y += 2.6 * mound(p);
    let white = smooth(10.0, 0.0, offshore(p));
    y += 1.6 * (white + mound(p)).min(1.0) * (octaves(0.5 * p, 4) - 0.5);
    let edge = smooth(0.0, 25.0, p.x - LOW.x)
        * smooth(0.0, 25.0, HIGH.x - p.x)
        * smooth(0.0, 40.0, p.y - LOW.y)
        * smooth(0.0, 12.0, HIGH.y - p.y);
    let floor = OPEN_SEA - 0.05;
    vec3(p.x, floor + edge * (y - floor), p.y)
}

fn cover(p: Vec2) -> (f32, f32, f32) {
    let away = offshore(p);
    let patch = octaves(0.07 * p + 11.0, 3);
    let (mut amount, mut age) = (0.0_f32, 0.2);
    let mut take = |more: f32, old: f32| {
        if more > amount {
            (amount, age) = (more, old);
        }
    };
    // Surf reaches farther out on the side where waves arrive; behind the rock lies older foam.
    let lee = smooth(-10.0, 20.0, p.x);
    let surf = smooth(7.0 + 7.0 * patch, 1.0, away + 3.0 * (octaves(0.3 * p, 3) - 0.5));
    take(1.0 * surf, 0.15 + 0.2 * lee);
    take(1.05 * smooth(0.25, 0.7, mound(p) + 0.25 * (octaves(0.4 * p, 3) - 0.5)), 0.1);
    let left = smooth(40.0 + 16.0 * lee, 6.0, away) * smooth(0.40, 0.56, patch + 0.05 * lee);
    take(0.62 * left, 0.35 + 0.4 * smooth(8.0, 40.0, away));
    // Wind streaks.
    let streak = octaves(vec2(0.035 * (p.x + 0.45 * p.y), 0.16 * (p.y - 0.45 * p.x)) + 7.0, 4);
    take(0.36 * smooth(0.64, 0.70, streak), 0.7);
    let cap = octaves(vec2(0.10 * (p.x + 0.45 * p.y), 0.05 * (p.y - 0.45 * p.x)) + 90.0, 4);
    take(0.85 * smooth(0.66, 0.76, cap) * smooth(0.1, 1.2, waves().height(p)), 0.3);
    (amount, 1.5 + 1.6 * smooth(0.7, 0.1, amount), age)
}

/// Surface and foam, tabulated.
fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(|| Table::new(LOW, HIGH, surface, cover))
}

/// Density of the foam.
fn density(p: Vec2) -> f32 {
    if rock(p) > table().at(p).position.y + 0.3 {
        return 0.0;
    }
    let Spot { amount, cell, .. } = table().at(p);
    laces(p, amount, cell) * (0.25 + 0.75 * smooth(0.3, 1.0, amount))
}

fn foam(random: &mut Random) -> Particle {
    if random.unit() < 0.14 {
        return running(random);
    }
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p = FIELD.get_or_init(|| Field::new(LOW + 25.0, HIGH - 6.0, density)).draw(random);
    let Spot { mut position, amount, age, .. } = table().at(p);
    let heap = 0.05 + 0.6 * smooth(0.8, 1.0, amount) * octaves(0.8 * p, 2);
    position.y += heap * random.unit().powf(1.5) + 0.03;
    position += 0.05 * random.ball();
    Particle { position, kind: FOAM, age: age + 0.15 * random.unit() }
}

/// Foam that runs off the rock along its hollows.
fn running(random: &mut Random) -> Particle {
    let wet = |p: Vec2| -> f32 {
        let y = rock(p);
        if !(-0.5..=6.0).contains(&y) || p.length() < 4.5 {
            return 0.0;
        }
        let hollow = octaves(0.33 * p, 4) - octaves(0.9 * p + 3.0, 3);
        let outwards = p.normalize_or_zero();
        let around = p.length() * outwards.angle_to(Vec2::X);
        let thread = octaves(vec2(0.12 * p.length(), 0.9 * around), 3);
        let low = smooth(6.0, 1.0, y);
        let hit = 0.55 + 0.45 * smooth(8.0, -10.0, p.x);
        hit * (low * low * 0.9 + 0.5 * smooth(-0.05, -0.25, hollow)) * smooth(0.42, 0.66, thread)
    };
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p =
        FIELD.get_or_init(|| Field::new(vec2(-19.0, -15.0), vec2(19.0, 15.0), wet)).draw(random);
    let position = vec3(p.x, rock(p) + 0.04 + 0.10 * random.unit(), p.y);
    Particle { position, kind: FOAM, age: 0.2 + 0.4 * random.unit() }
}

fn bubble(random: &mut Random) -> Particle {
    let under = |p: Vec2| -> f32 {
        let amount = table().at(p).amount;
        smooth(0.3, 1.0, amount) * (0.3 + 0.7 * octaves(0.5 * p, 2))
    };
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p = FIELD.get_or_init(|| Field::new(LOW + 25.0, HIGH - 6.0, under)).draw(random);
    let position = table().at(p).position - Vec3::Y * random.decay(0.25).min(2.5);
    Particle { position, kind: BUBBLE, age: 0.6 * random.unit() }
}

/// Spray: the sheet over the rock, mist that the wind takes from it, and small splashes along the surf.
fn spray(random: &mut Random) -> Particle {
    let which = random.unit();
    let (count, salt) = if which < 0.72 { (850, 0) } else { (520, 1) };
    let mut lots = Random::new(random.below(count), 3000 + salt);
    if salt == 0 {
        // Fingers rise from where the wave hit, the highest in the middle.
        let along = lots.between(-1.0, 1.0);
        let middle = (-(2.1 * along).powi(2)).exp();
        let place = vec2(-13.5 + 3.0 * along * along + lots.between(-1.5, 1.5), 2.5 + 11.0 * along);
        let from = vec3(place.x, surface(place).y.max(rock(place)) - 0.3, place.y);
        let finger = 0.45 + 0.55 * value(vec2(3.3 * along + 20.0, 0.5));
        let up = (5.0 + 15.0 * middle * finger) * (1.0 - 0.6 * lots.unit() * lots.unit());
        let clump = Clump {
            from,
            velocity: vec3(lots.between(-3.6, 3.2), up, 4.0 * along + lots.between(-1.8, 1.8)),
            time: up / 9.81 * lots.between(0.75, 1.25),
            spread: lots.between(0.25, 1.0),
            wind: vec3(2.2, 0.0, 0.6),
        };
        return clump.draw(random, from.y - 0.5);
    }
    let turn = std::f32::consts::TAU * lots.unit();
    let mut place = Vec2::from_angle(turn) * 12.0;
    // Steps outwards to the edge of the rock.
    for _ in 0..12 {
        place *= if offshore(place) < 0.4 { 1.04 } else { 1.0 };
    }
    let from = table().at(place).position;
    let out = 0.4 + 0.6 * smooth(10.0, -12.0, place.x);
    let clump = Clump {
        from,
        velocity: vec3(
            lots.between(-2.0, 2.0),
            lots.between(1.5, 6.5) * out,
            lots.between(-2.0, 2.0),
        ),
        time: lots.between(0.2, 0.7),
        spread: lots.between(0.4, 1.0),
        wind: vec3(1.0, 0.0, 0.3),
    };
    clump.draw(random, from.y - 0.4)
}

/// An upright part of the tower that narrows upwards. `radius` holds the radii below and above.
fn ring(y: [f32; 2], radius: [f32; 2], material: Material) -> Mesh {
    const SIDES: u32 = 48;
    let mut mesh = Mesh { name: "tower".into(), material, ..Mesh::default() };
    let slope = (radius[0] - radius[1]) / (y[1] - y[0]).max(0.01);
    for i in 0..=SIDES {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / SIDES as f32).sin_cos();
        let normal = vec3(cos, slope, -sin).normalize();
        for k in 0..2 {
            mesh.positions.push([radius[k] * cos, y[k], -radius[k] * sin]);
            mesh.normals.push(normal.to_array());
        }
        if i < SIDES {
            mesh.indices.extend([0, 2, 3, 0, 3, 1].map(|k| 2 * i + k));
        }
    }
    mesh
}

pub fn meshes() -> Vec<Mesh> {
    let place = |uv: Vec2| {
        let squeeze = |t: f32, at: f32, low: f32, high: f32| {
            let side = if t < at { (at - t) / at } else { (t - at) / (1.0 - at) };
            side * (0.45 + 0.55 * side) * if t < at { low } else { high }
        };
        vec2(squeeze(uv.x, 0.5, LOW.x, HIGH.x), squeeze(uv.y, 0.6, LOW.y, HIGH.y))
    };
    let tint = |p: Vec2| {
        let (amount, _, _) = cover(p);
        aerated(DEEP, amount)
    };
    let mut meshes = vec![grid("sea", [240, 240], place, surface, tint, 0.15)];
    let stony = |p: Vec2| {
        let wet = smooth(4.5, 1.0, rock(p));
        let tone = 0.6 + 0.8 * octaves(0.9 * p, 4);
        tone * vec3(0.15, 0.125, 0.10).lerp(vec3(0.045, 0.04, 0.036), wet)
    };
    let over = |uv: Vec2| 44.0 * (uv - 0.5);
    let stone = |p: Vec2| vec3(p.x, rock(p), p.y);
    meshes.push(grid("rock", [150, 150], over, stone, stony, 0.6));
    let paint = |color: [f32; 3], roughness: f32| Material {
        base_color: color,
        roughness,
        ..Material::default()
    };
    let (white, red, dark) = ([0.80, 0.79, 0.75], [0.50, 0.05, 0.035], [0.05, 0.055, 0.06]);
    let radius = |t: f32| 2.9 - 1.1 * t + 0.35 * (-9.0 * t).exp();
    for band in 0..5 {
        let (low, high) = (band as f32 / 5.0, (band + 1) as f32 / 5.0);
        let color = if band % 2 == 0 { white } else { red };
        let y = |t: f32| 5.6 + 17.0 * t;
        meshes.push(ring([y(low), y(high)], [radius(low), radius(high)], paint(color, 0.55)));
    }
    meshes.push(Mesh::cylinder([0.0, 22.8, 0.0], 2.6, 0.4, paint(dark, 0.6)));
    meshes.push(Mesh::tube([0.0, 23.5, 0.0], [2.55, 2.45], 1.0, 0.0, paint(white, 0.5)));
    meshes.push(Mesh::cylinder([0.0, 24.3, 0.0], 1.35, 2.6, paint([0.30, 0.36, 0.36], 0.1)));
    meshes.push(ring([25.6, 27.2], [1.75, 0.1], paint(red, 0.5)));
    meshes.push(Mesh::cuboid(
        [-5.5, 6.9, -2.5],
        [2.2, 1.3, 1.8],
        [0.0, 0.13, 0.0, 0.99],
        paint(white, 0.6),
    ));
    meshes
}
