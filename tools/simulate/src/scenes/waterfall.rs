//! A chute pours into a basin, past a pillar.
//!
//! The inside of the basin floor is y = 0; x runs along the basin, from the chute to the far end; z
//! points to the viewer.

use glam::Vec3;

use crate::scene::{Fill, Inlet, Key, Scene, Section, Shape, Solid};

/// Half the inner length (x) and width (z) of the basin.
const BASIN_HALF: [f32; 2] = [1.5, 0.9];
/// The thickness of the basin's walls and floor.
const WALL: f32 = 0.1;
/// The height of the near and the far wall above the basin floor.
const LOW_WALL: f32 = 0.5;
/// The height of the wall under the chute and of the back wall above the basin floor.
const HIGH_WALL: f32 = 0.76;
/// The depth of the pool at rest.
const POOL_DEPTH: f32 = 0.24;
/// The top of the ground.
const GROUND: f32 = -WALL;

/// The end of the chute's bed, in the plane z = 0.
const LIP: Vec3 = Vec3::new(-0.95, 0.68, 0.0);
/// Slope of the chute, degrees.
const CHUTE_ANGLE: f32 = 12.0;
/// The length of the chute's bed.
const CHUTE_LENGTH: f32 = 1.9;
/// Half the clear width of the chute.
const CHUTE_HALF_WIDTH: f32 = 0.3;
/// Position where water enters, upstream from the chute's lip: inside the headworks.
const INLET: f32 = 1.7;
/// Depth of the water that enters.
const INLET_DEPTH: f32 = 0.2;
/// Speed of the water that enters, m/s.
const INLET_SPEED: f32 = 3.0;
/// When the sluice opens, seconds.
const INLET_OPENS: f32 = 2.0;

/// The scene 'waterfall'.
pub fn waterfall() -> Scene {
    let [x, z] = BASIN_HALF;
    let (ox, oz) = (x + WALL, z + WALL);
    let (sin, cos) = CHUTE_ANGLE.to_radians().sin_cos();
    // Direction downstream along the bed, and normal of the bed.
    let (along, up) = (Vec3::new(cos, -sin, 0.0), Vec3::new(sin, cos, 0.0));
    // A box in the chute's frame: from upstream to downstream, away from the bed, across.
    let on_chute = |name, material, u: [f32; 2], v: [f32; 2], w: [f32; 2]| {
        let mid = |r: [f32; 2]| 0.5 * (r[0] + r[1]);
        let half = |r: [f32; 2]| 0.5 * (r[1] - r[0]);
        let centre = LIP + along * mid(u) + up * mid(v) + Vec3::Z * mid(w);
        let half = Vec3::new(half(u), half(v), half(w));
        Solid::new(name, material, Shape::Box, centre, half, -CHUTE_ANGLE.to_radians())
    };
    let (w, l) = (CHUTE_HALF_WIDTH, CHUTE_LENGTH);
    let post = |name, z| Solid::standing(name, "steel", [-2.45, GROUND, z], 0.045, 1.05);
    let solids = vec![
        Solid::spanning("basin floor", "concrete", [-ox, GROUND, -oz], [ox, 0.0, oz]),
        Solid::spanning("basin wall, chute end", "concrete", [-ox, 0.0, -z], [-x, HIGH_WALL, z]),
        Solid::spanning("basin wall, far end", "concrete", [x, 0.0, -z], [ox, LOW_WALL, z]),
        Solid::spanning("basin wall, back", "concrete", [-ox, 0.0, -oz], [ox, HIGH_WALL, -z]),
        Solid::spanning("basin wall, front", "concrete", [-ox, 0.0, z], [ox, LOW_WALL, oz]),
        Solid::standing("pillar", "stone", [-0.16, 0.0, 0.03], 0.28, 0.85),
        on_chute("chute bed", "timber", [-l, 0.0], [-0.07, 0.0], [-w - 0.06, w + 0.06]),
        on_chute("chute side, back", "timber", [-l, 0.0], [0.0, 0.28], [-w - 0.06, -w]),
        on_chute("chute side, front", "timber", [-l, 0.0], [0.0, 0.28], [w, w + 0.06]),
        on_chute(
            "headworks, lintel",
            "concrete",
            [-l - 0.06, 0.42 - l],
            [0.24, 0.48],
            [-w - 0.10, w + 0.10],
        ),
        on_chute(
            "headworks, back",
            "concrete",
            [-l - 0.06, -l + 0.04],
            [-0.12, 0.25],
            [-w - 0.10, w + 0.10],
        ),
        post("post, back", -0.27),
        post("post, front", 0.27),
    ];
    let view = Key { at: 0.0, eye: Vec3::new(0.6, 2.4, 4.3), target: Vec3::new(-0.45, 0.37, 0.0) };
    let key = |at, eye, target| Key { at, eye: Vec3::from(eye), target: Vec3::from(target) };
    Scene {
        name: "waterfall",
        solids,
        ground: GROUND,
        ground_material: "ground",
        fills: vec![Fill::Basin { min: Vec3::new(-x, 0.0, -z), max: Vec3::new(x, POOL_DEPTH, z) }],
        inlets: vec![Inlet {
            origin: LIP,
            along,
            up,
            start: -INLET,
            section: Section::Channel { half_width: CHUTE_HALF_WIDTH, depth: INLET_DEPTH },
            speed: INLET_SPEED,
            opens: INLET_OPENS,
            closes: f32::INFINITY,
        }],
        hinge: None,
        waves: Some(Vec3::new(x, POOL_DEPTH, z)),
        pool_level: Some(POOL_DEPTH),
        kept: vec![
            [Vec3::new(-ox, GROUND, -oz), Vec3::new(ox, f32::INFINITY, oz)],
            // This position is on the way down the chute.
            [
                Vec3::new(f32::NEG_INFINITY, HIGH_WALL - 0.1, -w - 0.06),
                Vec3::new(0.0, f32::INFINITY, w + 0.06),
            ],
        ],
        bounds: [Vec3::new(-2.9, -0.2, -1.5), Vec3::new(2.1, 2.6, 1.5)],
        lead: 0.0,
        spacing: 0.04,
        spacings: [0.01, 0.1],
        view,
        keys: vec![
            key(0.0, [2.9, 1.9, 3.3], [-0.3, 0.35, 0.0]),
            key(0.5, [0.9, 2.1, 3.9], [-0.45, 0.4, 0.0]),
            key(1.0, [1.9, 1.2, 2.4], [-0.4, 0.45, 0.0]),
        ],
        fov: 38.0,
    }
}
