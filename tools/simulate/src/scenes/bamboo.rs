//! A shishi-odoshi: water runs from a spout into a bamboo pipe on an axle, which tips when it is
//! full, empties into a stone bowl, and falls back on a stone.
//!
//! The inside of the bowl's floor is y = 0; x runs from the pipe's tail to the bowl, and the axle
//! is parallel to z.

use std::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec3};

use crate::hinge::Hinge;
use crate::scene::{Fill, Inlet, Key, Scene, Section, Shape, Solid};

/// The axle.
const AXLE: Vec3 = Vec3::new(0.0, 0.72, 0.0);
/// Angle of the pipe's mouth: upwards at rest, and downwards when it has tipped, degrees.
const REST: f32 = 30.0;
const TIPPED: f32 = -26.0;
/// Outer and inner radius of the pipe; its wall is one particle thick.
const RADII: [f32; 2] = [0.125, 0.1];
/// Start and end of the pipe, along its axis from the axle, and slope of its cut mouth.
const PIPE: [f32; 2] = [-0.5, 0.675];
const SLANT: f32 = 1.0;
/// Nodes that close the pipe: one below the water, one at the tail.
const NODES: [[f32; 2]; 2] = [[-0.2, -0.16], [-0.5, -0.46]];
/// The bowl: the middle of its floor, its inner radius, its wall, the height of its rim.
const BOWL: Vec3 = Vec3::new(0.88, 0.0, 0.0);
const BOWL_RADIUS: f32 = 0.62;
const BOWL_WALL: f32 = 0.1;
const BOWL_HEIGHT: f32 = 0.27;
/// Depth of the water in the bowl.
const DEPTH: f32 = 0.17;
/// The top of the ground.
const GROUND: f32 = -0.07;
/// End of the spout, its slope (degrees), outer and inner radius, and length.
const SPOUT: Vec3 = Vec3::new(0.16, 1.42, 0.0);
const SPOUT_SLOPE: f32 = 5.0;
const SPOUT_RADII: [f32; 2] = [0.075, 0.05];
const SPOUT_LENGTH: f32 = 0.95;

/// The scene 'bamboo'.
pub fn bamboo() -> Scene {
    // A cylinder's own axis is y.
    let angle = REST.to_radians() - FRAC_PI_2;
    let along = Quat::from_rotation_z(angle) * Vec3::Y;
    let on_pipe = |name, material, shape, u: [f32; 2], radius: f32| {
        let centre = AXLE + along * (0.5 * (u[0] + u[1]));
        let half = Vec3::new(radius, 0.5 * (u[1] - u[0]), radius);
        Solid { moves: true, ..Solid::new(name, material, shape, centre, half, angle) }
    };
    let [outer, inner] = RADII;
    let ring = |name, u: f32| {
        let shape = Shape::Tube { bore: outer - 0.01, slope: 0.0 };
        on_pipe(name, "bamboo", shape, [u - 0.014, u + 0.014], outer + 0.007).drawn_only()
    };
    let stub = |name, side: f32| {
        let centre = AXLE + Vec3::Z * (side * 0.18);
        let half = Vec3::new(0.014, 0.014, 0.06);
        Solid { moves: true, ..Solid::new(name, "steel", Shape::Box, centre, half, angle) }
    };
    let plug = |name, u| on_pipe(name, "bamboo", Shape::Cylinder, u, inner);
    let mut solids = vec![
        on_pipe("pipe", "bamboo", Shape::Tube { bore: inner, slope: SLANT }, PIPE, outer),
        plug("pipe, node", NODES[0]),
        plug("pipe, tail", NODES[1]),
        ring("pipe, ring at the tail", -0.44),
        ring("pipe, ring at the node", -0.18),
        ring("pipe, ring in the middle", 0.14),
        ring("pipe, ring at the mouth", 0.44),
        stub("axle, back", -1.0),
        stub("axle, front", 1.0),
    ];
    let post = |name, z: f32| {
        let (low, high) = ([-0.035, GROUND, z - 0.03], [0.035, AXLE.y + 0.09, z + 0.03]);
        Solid::spanning(name, "timber", low, high)
    };
    let bowl =
        Vec3::new(BOWL_RADIUS + BOWL_WALL, 0.5 * (BOWL_HEIGHT - GROUND), BOWL_RADIUS + BOWL_WALL);
    let foot = BOWL + Vec3::Y * GROUND;
    let bowl_shape = Shape::Tube { bore: BOWL_RADIUS, slope: 0.0 };
    // The floor ends inside the wall, so that their faces do not coincide.
    let floor = BOWL_RADIUS + 0.5 * BOWL_WALL;
    solids.extend([
        post("post, back", -0.2),
        post("post, front", 0.2),
        Solid::new("bowl", "stone", bowl_shape, foot + Vec3::Y * bowl.y, bowl, 0.0),
        Solid::standing("bowl, floor", "stone", foot.to_array(), floor, -GROUND),
        Solid::standing("striking stone", "stone", [-0.35, GROUND, 0.0], 0.13, 0.43),
    ]);
    let spout_angle = -SPOUT_SLOPE.to_radians() - FRAC_PI_2;
    let downstream = Quat::from_rotation_z(spout_angle) * Vec3::Y;
    let on_spout = |name, bore: f32, radius: f32, u: [f32; 2]| {
        let centre = SPOUT + downstream * (0.5 * (u[0] + u[1]));
        let half = Vec3::new(radius, 0.5 * (u[1] - u[0]), radius);
        Solid::new(name, "bamboo", Shape::Tube { bore, slope: 0.0 }, centre, half, spout_angle)
    };
    let [around, within] = SPOUT_RADII;
    let spout_ring = |u: f32| {
        on_spout("spout, ring", around - 0.01, around + 0.006, [u - 0.012, u + 0.012]).drawn_only()
    };
    let rock = |x: f32, z: f32, radius: f32, height: f32| {
        Solid::standing("rock", "stone", [x, GROUND, z], radius, height).drawn_only()
    };
    solids.extend([
        on_spout("spout", within, around, [-SPOUT_LENGTH, 0.0]),
        spout_ring(-0.12),
        spout_ring(-0.5),
        Solid::standing("spout, post", "bamboo", [-0.72, GROUND, 0.0], 0.07, 1.86),
        rock(-0.35, -0.75, 0.22, 0.2),
        rock(-0.8, -0.5, 0.16, 0.3),
        rock(1.75, -0.55, 0.18, 0.16),
    ]);
    let key = |at, eye, target| Key { at, eye: Vec3::from(eye), target: Vec3::from(target) };
    let deg = f32::to_radians;
    Scene {
        name: "bamboo",
        solids,
        ground: GROUND,
        ground_material: "sand",
        fills: vec![
            Fill::Bore { foot: BOWL, angle: 0.0, radius: BOWL_RADIUS, length: DEPTH, level: DEPTH },
            Fill::Bore {
                foot: AXLE + along * NODES[0][1],
                angle,
                radius: inner,
                length: PIPE[1] - NODES[0][1],
                level: AXLE.y + 0.1,
            },
        ],
        inlets: vec![Inlet {
            origin: SPOUT,
            along: downstream,
            up: Vec3::Z.cross(downstream),
            start: -0.3,
            section: Section::Pipe { radius: within },
            speed: 1.1,
            opens: -0.5,
            closes: f32::INFINITY,
        }],
        hinge: Some(Hinge {
            axle: AXLE,
            mass: 9.0,
            lever: -0.28 * along,
            inertia: 2.0,
            friction: 2.0,
            range: [deg(TIPPED - REST), 0.0],
            bounce: 0.2,
            turn: 0.0,
            speed: 0.0,
            acceleration: 0.0,
        }),
        waves: None,
        pool_level: None,
        kept: vec![[Vec3::new(-1.2, GROUND, -1.1), Vec3::new(1.9, f32::INFINITY, 1.1)]],
        bounds: [Vec3::new(-0.6, -0.07, -0.64), Vec3::new(1.52, 1.5, 0.64)],
        lead: 0.6,
        spacing: 0.02,
        spacings: [0.01, 0.022],
        view: key(0.0, [1.5, 1.45, 2.5], [0.35, 0.62, 0.0]),
        keys: vec![
            key(0.0, [1.1, 1.5, 3.2], [0.3, 0.7, 0.0]),
            key(0.5, [2.0, 1.45, 2.7], [0.35, 0.7, 0.0]),
            key(1.0, [2.7, 1.3, 1.8], [0.38, 0.68, 0.0]),
        ],
        fov: 38.0,
    }
}
