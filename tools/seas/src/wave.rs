//! A wave that breaks from one end to the other, seen from the front: white water where it has broken, a clean face
//! where it has not, and a falling lip between them.

use std::sync::OnceLock;

use glam::{Vec2, Vec3, vec2, vec3};
use whitewater::headless::scene::Mesh;

use crate::noise::{laces, octaves, smooth, value};
use crate::random::{Field, Random};
use crate::surface::{Spot, Table, Waves, grid};
use crate::throw::Clump;
use crate::{BUBBLE, DEEP, FOAM, OPEN_SEA, Particle, Plan, aerated};

pub const PLAN: Plan = Plan {
    draw: [foam, spray, bubble],
    shares: [0.68, 0.25, 0.07],
    bounds: [vec3(-80.0, -6.0, -110.0), vec3(60.0, 14.0, 70.0)],
    radius: 0.042,
    eye: vec3(29.0, 5.6, 26.5),
    target: vec3(0.0, 0.9, -6.0),
    fov: 29.0,
    sun: vec3(0.55, 0.62, 0.56),
};

/// The meshed part, which carries foam.
const LOW: Vec2 = vec2(-62.0, -95.0);
const HIGH: Vec2 = vec2(34.0, 40.0);

/// State of the wave at a position along its crest: how far the lip is thrown, 0 to 1, and how much of the wave is
/// white water, 0 to 1.
fn stage(z: f32) -> (f32, f32) {
    let broken = smooth(-2.0, -13.0, z);
    (smooth(9.0, -1.0, z) * (1.0 - broken), broken)
}

fn height_of_crest(z: f32) -> f32 {
    let shoulder = 1.0 - 0.62 * smooth(2.0, 30.0, z);
    let white = 1.0 - 0.34 * smooth(-4.0, -22.0, z);
    3.3 * shoulder * white * (1.0 - 0.8 * smooth(-45.0, -80.0, z))
}

/// Position of the crest.
fn crest(z: f32) -> f32 {
    0.9 * (0.11 * z + 0.4).sin() + 0.0016 * z * z + 3.0 * smooth(-4.0, -20.0, z)
}

/// Profile of the wave over the distance in front of its crest.
fn form(s: f32) -> f32 {
    if s > 0.0 { (1.0 + (s / 2.3).powi(2)).powf(-1.5) } else { 1.0 / (1.0 + (s / 7.5).powi(2)) }
}

fn waves() -> &'static Waves {
    static WAVES: OnceLock<Waves> = OnceLock::new();
    WAVES.get_or_init(|| Waves::new(vec2(1.0, 0.35), 22.0, 1.1, 0.030))
}

/// The surface. It overhangs at the lip, so `p` is where the point would lie without the overhang.
fn surface(p: Vec2) -> Vec3 {
    let (lip, broken) = stage(p.y);
    let s = p.x - crest(p.y);
    let g = form(s);
    let high = height_of_crest(p.y);
    let before = smooth(-1.5, 3.0, s);
    // The lip moves forward and bends down.
    let top = smooth(0.45, 1.0, g) * (0.35 + 0.65 * before.max(smooth(-2.5, 0.3, s)));
    let ahead = 2.3 * lip * top;
    let trough = 0.55 * (-((s - 6.0) / 3.2).powi(2)).exp();
    // White water is rough.
    let rough = broken * g.max(0.25 * smooth(-14.0, 0.0, s) * (1.0 - before));
    let tumble = rough * 2.4 * (octaves(0.55 * p, 4) - 0.42);
    let edge = smooth(0.0, 14.0, p.x - LOW.x)
        * smooth(0.0, 14.0, HIGH.x - p.x)
        * smooth(0.0, 20.0, p.y - LOW.y)
        * smooth(0.0, 12.0, HIGH.y - p.y);
    let y = high * g - trough - 0.22 * lip * top * before
        + tumble
        + waves().height(p) * (1.0 - 0.5 * g);
    let floor = OPEN_SEA - 0.05;
    vec3(p.x + ahead, floor + edge * (y - floor), p.y)
}

/// Covered fraction, 0 to 1, size of the holes, and age of the foam.
fn cover(p: Vec2) -> (f32, f32, f32) {
    let (lip, broken) = stage(p.y);
    let s = p.x - crest(p.y);
    let g = form(s);
    let patch = octaves(0.10 * p + 1.0, 3);
    // White water, and the foam that it leaves behind.
    let front = smooth(4.6, 2.6, s + 1.6 * (octaves(0.5 * p, 3) - 0.5));
    let bore = broken * front * smooth(-22.0, -1.0, s).max(0.0);
    let behind = smooth(3.0, -16.0, p.y) * smooth(1.0, -3.0, s) * smooth(-46.0, -6.0, s);
    let mut amount = 1.05 * bore;
    let mut age = 0.1;
    let left = 0.55 * behind * smooth(0.30, 0.62, patch);
    if left > amount {
        (amount, age) = (left, 0.3 + 0.5 * smooth(-4.0, -30.0, s));
    }
    // Foam on the lip.
    let thrown = (0.55 + 0.4 * lip) * lip * smooth(-1.6, -0.2, s) * smooth(1.5, 0.5, s);
    let crested = 0.45
        * smooth(26.0, 4.0, p.y)
        * smooth(-1.0, 0.0, s)
        * smooth(0.9, 0.2, s)
        * smooth(0.35, 0.6, octaves(0.4 * p, 2));
    amount = amount.max(thrown).max(crested * (1.0 - broken));
    // Old foam in front of the wave, drawn up its face.
    let old = 0.46
        * smooth(0.47, 0.55, patch)
        * smooth(14.0, 8.0, s)
        * smooth(-0.2, 1.5, s)
        * (1.0 - 0.5 * g);
    if old > amount {
        (amount, age) = (old, 0.55 + 0.3 * patch);
    }
    // White caps far behind the wave.
    let caps =
        0.5 * smooth(-6.0, -14.0, s) * smooth(0.72, 0.86, octaves(vec2(0.16, 0.07) * p + 60.0, 3));
    (amount.max(caps), 1.1 + 1.1 * smooth(0.6, 0.1, amount), age)
}

/// Surface and foam, tabulated.
fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(|| Table::new(LOW, HIGH, surface, cover))
}

/// Density of the foam.
fn density(p: Vec2) -> f32 {
    let Spot { amount, cell, .. } = table().at(p);
    let s = p.x - crest(p.y);
    // The rising face draws foam into streaks.
    let drawn = smooth(7.0, 1.0, s) * smooth(-0.5, 0.5, s);
    let q = vec2(p.x * (1.0 - 0.6 * drawn), p.y * (1.0 + 0.35 * drawn));
    let thick = 0.45 + 0.55 * smooth(0.3, 0.95, amount);
    // Little is visible behind the wave.
    let seen = 1.0 - 0.7 * smooth(-2.0, -5.0, s);
    seen * laces(q, amount, cell) * thick
}

fn foam(random: &mut Random) -> Particle {
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p = FIELD.get_or_init(|| Field::new(LOW + 14.0, HIGH - 8.0, density)).draw(random);
    let Spot { mut position, amount, age, .. } = table().at(p);
    // White water is a thick, rough layer.
    let (_, broken) = stage(p.y);
    let heap = 0.04 + 0.9 * broken * smooth(0.7, 1.0, amount) * octaves(1.3 * p, 2);
    position.y += heap * random.unit().powf(1.5) + 0.02;
    position += 0.03 * random.ball();
    Particle { position, kind: FOAM, age: age + 0.15 * random.unit() }
}

fn bubble(random: &mut Random) -> Particle {
    let under = |p: Vec2| -> f32 {
        let amount = table().at(p).amount;
        smooth(0.2, 0.9, amount) * (0.3 + 0.7 * octaves(0.9 * p, 2))
    };
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p = FIELD.get_or_init(|| Field::new(LOW + 14.0, HIGH - 8.0, under)).draw(random);
    let position = table().at(p).position - Vec3::Y * random.decay(0.12).min(1.5);
    Particle { position, kind: BUBBLE, age: 0.6 * random.unit() }
}

/// Random numbers of a clump, shared by all its particles.
fn lots(clump: u32, salt: u32) -> Random {
    Random::new(clump, 1000 + salt)
}

fn spray(random: &mut Random) -> Particle {
    let which = random.unit();
    if which < 0.34 {
        falling(random)
    } else if which < 0.76 {
        splash(random)
    } else {
        spindrift(random)
    }
}

/// Spray of the lip, which falls as a torn sheet.
fn falling(random: &mut Random) -> Particle {
    let torn = |p: Vec2| -> f32 {
        let (lip, _) = stage(p.x);
        // p.y is the time of fall in seconds.
        let threads = octaves(vec2(2.6 * p.x, 1.1 * p.y + 0.4 * p.x), 3);
        lip * smooth(0.34 + 0.2 * p.y, 0.62 + 0.2 * p.y, threads)
    };
    static FIELD: OnceLock<Field> = OnceLock::new();
    let p = FIELD.get_or_init(|| Field::new(vec2(-13.0, 0.0), vec2(8.0, 0.75), torn)).draw(random);
    let (z, t) = (p.x, p.y);
    let from = table().at(vec2(crest(z) + 0.55, z)).position;
    let mut position =
        from + vec3((2.2 + 0.8 * value(vec2(z, 7.0))) * t, 0.1 - 4.4 * t * t, 0.25 * t);
    position += (0.06 + 0.35 * t) * random.ball();
    position.y = position.y.max(-0.6);
    Particle { position, kind: crate::SPRAY, age: 0.1 + 0.4 * t * random.unit() }
}

/// Spray that is thrown up where the lip lands and where white water tumbles.
fn splash(random: &mut Random) -> Particle {
    const CLUMPS: u32 = 460;
    let mut lots = lots(random.below(CLUMPS), 1);
    let far = lots.unit();
    let z = 3.0 - 36.0 * far * (0.35 + 0.65 * far);
    let strong = smooth(-34.0, -3.0, z) * (0.35 + 0.65 * lots.unit());
    let s = 2.7 + lots.between(-2.2, 0.7);
    let from = table().at(vec2(crest(z) + s, z)).position;
    let clump = Clump {
        from: from - 0.2 * Vec3::Y,
        velocity: vec3(lots.between(1.0, 4.5), lots.between(2.0, 7.6), lots.between(-2.2, 2.2))
            * strong,
        time: lots.between(0.25, 0.8),
        spread: lots.between(0.25, 0.9),
        wind: vec3(-1.5, 0.0, 0.3),
    };
    clump.draw(random, from.y - 0.4)
}

/// Spray that the wind blows backwards off the crest.
fn spindrift(random: &mut Random) -> Particle {
    const CLUMPS: u32 = 300;
    let mut lots = lots(random.below(CLUMPS), 2);
    let z = lots.between(-26.0, 12.0);
    let from = table().at(vec2(crest(z) + lots.between(-0.4, 0.7), z)).position;
    let clump = Clump {
        from,
        velocity: vec3(lots.between(-3.5, -0.5), lots.between(0.8, 3.4), lots.between(-0.6, 0.6)),
        time: lots.between(0.15, 0.75),
        spread: lots.between(0.3, 0.8),
        wind: vec3(-4.0, 3.0, 0.5),
    };
    clump.draw(random, from.y - 0.6)
}

pub fn meshes() -> Vec<Mesh> {
    let place = |uv: Vec2| {
        // The mesh is finest at the crest and near the eye.
        let squeeze = |t: f32, at: f32, low: f32, high: f32| {
            let side = if t < at { (at - t) / at } else { (t - at) / (1.0 - at) };
            let away = side * (0.35 + 0.65 * side);
            let end = if t < at { low } else { high };
            away * end
        };
        vec2(2.0 + squeeze(uv.x, 0.6, LOW.x - 2.0, HIGH.x - 2.0), squeeze(uv.y, 0.6, LOW.y, HIGH.y))
    };
    let tint = |p: Vec2| {
        let (amount, _, _) = cover(p);
        let s = p.x - crest(p.y);
        // Light shines through the thin top of the wave.
        let thin = smooth(0.35, 1.0, form(s)) * smooth(-1.0, 0.6, s);
        let clear = DEEP.lerp(vec3(0.03, 0.22, 0.20), 0.7 * thin);
        aerated(clear, amount)
    };
    vec![grid("sea", [230, 250], place, surface, tint, 0.14)]
}
