//! A corridor between high walls is flooded through a gate: pillars, crates, a fallen slab and a sill
//! stand in the way, and the far end throws the water back.
//!
//! The floor is y = 0; x runs along the corridor, from the gate to the closed end.

use glam::Vec3;

use crate::scene::{Inlet, Key, Scene, Section, Shape, Solid};

/// Half of the inner length, and half of the width.
const HALF: [f32; 2] = [3.6, 0.8];
/// The thickness of the walls and the floor.
const WALL: f32 = 0.14;
/// The height of the walls.
const HEIGHT: f32 = 1.3;
/// The gate: half of its width, its height, and the depth of its opening in the wall.
const GATE: [f32; 3] = [0.5, 0.44, 0.5];
/// Depth and speed of the water that enters.
const INFLOW: [f32; 2] = [0.4, 3.0];
/// When the gate closes, seconds.
const CLOSES: f32 = 3.4;

/// The scene 'corridor'.
pub fn corridor() -> Scene {
    let [x, z] = HALF;
    let (oz, far) = (z + WALL, x + WALL);
    let [gate, lintel, deep] = GATE;
    let near = -x - deep;
    let block = |name, material, min, max| Solid::spanning(name, material, min, max);
    let pillar = |x, z| Solid::standing("pillar", "stone", [x, 0.0, z], 0.15, HEIGHT);
    // A crate, by the middle of its foot and half of its size.
    let crate_at = |x: f32, z: f32, half: f32| {
        let (low, high) = ([x - half, 0.0, z - half], [x + half, 2.0 * half, z + half]);
        Solid::spanning("crate", "timber", low, high)
    };
    let beam = |x: f32| {
        let (low, high) = ([x - 0.06, HEIGHT, -oz - 0.05], [x + 0.06, HEIGHT + 0.14, oz + 0.05]);
        Solid::spanning("beam", "timber", low, high).drawn_only()
    };
    let mut solids = vec![
        block("floor", "concrete", [near - WALL, -WALL, -oz], [far, 0.0, oz]),
        block("wall, back", "concrete", [near - WALL, 0.0, -oz], [far, HEIGHT, -z]),
        block("wall, front", "concrete", [near - WALL, 0.0, z], [far, HEIGHT, oz]),
        block("wall, far end", "concrete", [x, 0.0, -z], [far, HEIGHT, z]),
        block("gate, back", "stone", [near, 0.0, -z], [-x, HEIGHT, -gate]),
        block("gate, front", "stone", [near, 0.0, gate], [-x, HEIGHT, z]),
        block("gate, lintel", "stone", [near, lintel, -gate], [-x, HEIGHT, gate]),
        block("gate, door", "steel", [near - WALL, 0.0, -z], [near, HEIGHT, z]),
        block("sill", "stone", [0.5, 0.0, -z], [0.66, 0.12, z]),
        Solid::new(
            "slab",
            "stone",
            Shape::Box,
            Vec3::new(2.75, 0.12, 0.45),
            Vec3::new(0.5, 0.05, 0.35),
            0.3,
        ),
    ];
    solids.extend([
        pillar(-2.3, 0.32),
        pillar(-1.35, -0.38),
        pillar(-0.35, 0.28),
        pillar(1.3, -0.3),
        pillar(2.3, -0.54),
    ]);
    solids.extend([
        crate_at(-2.75, -0.5, 0.18),
        crate_at(-0.75, 0.6, 0.2),
        crate_at(0.0, -0.52, 0.17),
        crate_at(1.1, 0.56, 0.2),
        crate_at(1.9, 0.42, 0.15),
    ]);
    solids.extend([-2.9, -1.7, -0.5, 0.7, 1.9].map(beam));
    let key = |at, eye, target| Key { at, eye: Vec3::from(eye), target: Vec3::from(target) };
    Scene {
        name: "corridor",
        solids,
        ground: -WALL,
        ground_material: "ground",
        fills: Vec::new(),
        inlets: vec![Inlet {
            origin: Vec3::new(-x, 0.0, 0.0),
            along: Vec3::X,
            up: Vec3::Y,
            start: 0.12 - deep,
            section: Section::Channel { half_width: gate, depth: INFLOW[0] },
            speed: INFLOW[1],
            opens: 0.0,
            closes: CLOSES,
        }],
        hinge: None,
        waves: None,
        pool_level: None,
        kept: vec![[Vec3::new(near - WALL, -WALL, -oz), Vec3::new(far, f32::INFINITY, oz)]],
        bounds: [Vec3::new(-4.2, 0.0, -0.8), Vec3::new(3.6, 1.6, 0.8)],
        lead: 0.0,
        spacing: 0.04,
        spacings: [0.02, 0.1],
        view: key(0.0, [3.4, 1.15, 0.25], [0.0, 0.1, -0.12]),
        keys: vec![
            key(0.0, [3.4, 1.15, 0.25], [0.0, 0.1, -0.12]),
            key(0.5, [2.8, 0.95, 0.3], [-0.8, 0.2, -0.15]),
            key(1.0, [1.7, 1.0, 0.35], [-1.8, 0.2, -0.15]),
        ],
        fov: 55.0,
    }
}
