//! The geometry of the scene 'waterfall', in one place: what the solver collides with is what
//! `scene.json` tells a renderer to draw.
//!
//! Metres, y up, right-handed. The inside of the basin floor is y = 0; x runs along the basin, from
//! the chute to the far end; z points to the viewer.

use glam::{Quat, Vec3};
use serde_json::{Value, json};

/// What a solid looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Half extents along the own axes, turned by `angle` (radians) about z.
    Box,
    /// An upright cylinder: `half` is (radius, half height, radius).
    Cylinder,
}

/// A solid that water collides with.
#[derive(Clone, Debug)]
pub struct Solid {
    /// What it is.
    pub name: &'static str,
    /// What it is made of.
    pub material: &'static str,
    /// Its shape.
    pub shape: Shape,
    /// Its centre.
    pub centre: Vec3,
    /// Its half extents.
    pub half: Vec3,
    /// Its rotation about +z, radians, counter-clockwise seen from +z.
    pub angle: f32,
}

impl Solid {
    fn spanning(name: &'static str, material: &'static str, min: [f32; 3], max: [f32; 3]) -> Self {
        let (min, max) = (Vec3::from(min), Vec3::from(max));
        Self {
            name,
            material,
            shape: Shape::Box,
            centre: rounded(0.5 * (min + max)),
            half: rounded(0.5 * (max - min)),
            angle: 0.0,
        }
    }

    fn standing(
        name: &'static str,
        material: &'static str,
        foot: [f32; 3],
        radius: f32,
        height: f32,
    ) -> Self {
        Self {
            name,
            material,
            shape: Shape::Cylinder,
            centre: rounded(Vec3::from(foot) + Vec3::Y * (0.5 * height)),
            half: rounded(Vec3::new(radius, 0.5 * height, radius)),
            angle: 0.0,
        }
    }

    /// The signed distance to the solid (negative inside) and the direction in which it grows.
    pub fn distance(&self, at: Vec3) -> (f32, Vec3) {
        let offset = at - self.centre;
        match self.shape {
            Shape::Box => {
                let (sin, cos) = self.angle.sin_cos();
                let local = Vec3::new(
                    cos * offset.x + sin * offset.y,
                    cos * offset.y - sin * offset.x,
                    offset.z,
                );
                let (d, n) = box_distance(local, self.half);
                let normal = Vec3::new(cos * n.x - sin * n.y, sin * n.x + cos * n.y, n.z);
                (d, normal)
            }
            Shape::Cylinder => {
                let radial = Vec3::new(offset.x, 0.0, offset.z);
                let length = radial.length();
                let outward = if length > 1e-6 { radial / length } else { Vec3::X };
                let flat = Vec3::new(length, offset.y, 0.0);
                // In the plane through the axis the cylinder is a rectangle.
                let (d, n) = box_distance(flat, Vec3::new(self.half.x, self.half.y, 1e6));
                (d, outward * n.x + Vec3::Y * n.y)
            }
        }
    }
}

/// Signed distance to an axis-aligned box about the origin, and its gradient.
fn box_distance(at: Vec3, half: Vec3) -> (f32, Vec3) {
    let sign = Vec3::ONE.copysign(at);
    let q = at.abs() - half;
    let outside = q.max(Vec3::ZERO);
    let length = outside.length();
    if length > 0.0 {
        (length, outside / length * sign)
    } else {
        let d = q.max_element();
        let axis = if q.x == d {
            Vec3::X
        } else if q.y == d {
            Vec3::Y
        } else {
            Vec3::Z
        };
        (d, axis * sign)
    }
}

/// To a hundredth of a millimetre, so that `scene.json` says exactly what was simulated.
fn rounded(v: Vec3) -> Vec3 {
    (v * 1e5).round() / 1e5
}

/// Half the inner length (x) and width (z) of the basin.
pub const BASIN_HALF: [f32; 2] = [1.5, 0.9];
/// The thickness of the basin's walls and floor.
pub const WALL: f32 = 0.1;
/// The height of the near and the far wall above the basin floor.
pub const LOW_WALL: f32 = 0.5;
/// The height of the wall under the chute and of the back wall above the basin floor.
pub const HIGH_WALL: f32 = 0.76;
/// The depth of the pool at rest.
pub const POOL_DEPTH: f32 = 0.24;
/// The top of the ground.
pub const GROUND: f32 = -WALL;

/// The end of the chute's bed, in the plane z = 0.
pub const LIP: Vec3 = Vec3::new(-0.95, 0.68, 0.0);
/// How steeply the chute falls, degrees.
pub const CHUTE_ANGLE: f32 = 12.0;
/// The length of the chute's bed.
pub const CHUTE_LENGTH: f32 = 1.9;
/// Half the clear width of the chute.
pub const CHUTE_HALF_WIDTH: f32 = 0.3;
/// Where along the chute (from its lip, upstream) the water enters: inside the headworks.
pub const INLET: f32 = 1.7;
/// How deep the water enters.
pub const INLET_DEPTH: f32 = 0.2;
/// How fast the water enters, m/s.
pub const INLET_SPEED: f32 = 3.0;
/// When the sluice opens, seconds.
pub const INLET_OPENS: f32 = 2.0;

/// The scene: solids and the ground.
pub struct Scene {
    /// What the water collides with.
    pub solids: Vec<Solid>,
}

/// The chute's own frame: `along` downstream, `up` off its bed, z across; origin at the lip.
pub struct ChuteFrame {
    /// Downstream along the bed.
    pub along: Vec3,
    /// Off the bed.
    pub up: Vec3,
}

/// The chute's frame.
pub fn chute_frame() -> ChuteFrame {
    let (sin, cos) = CHUTE_ANGLE.to_radians().sin_cos();
    ChuteFrame { along: Vec3::new(cos, -sin, 0.0), up: Vec3::new(sin, cos, 0.0) }
}

impl Scene {
    /// The scene 'waterfall'.
    pub fn waterfall() -> Self {
        let [x, z] = BASIN_HALF;
        let (ox, oz) = (x + WALL, z + WALL);
        let frame = chute_frame();
        // A box in the chute's frame: upstream to downstream, off the bed, across.
        let on_chute = |name, material, u: [f32; 2], v: [f32; 2], w: [f32; 2]| {
            let mid = |r: [f32; 2]| 0.5 * (r[0] + r[1]);
            let half = |r: [f32; 2]| 0.5 * (r[1] - r[0]);
            Solid {
                name,
                material,
                shape: Shape::Box,
                centre: rounded(LIP + frame.along * mid(u) + frame.up * mid(v) + Vec3::Z * mid(w)),
                half: rounded(Vec3::new(half(u), half(v), half(w))),
                angle: -CHUTE_ANGLE.to_radians(),
            }
        };
        let (w, l) = (CHUTE_HALF_WIDTH, CHUTE_LENGTH);
        let post = |name, z| Solid::standing(name, "steel", [-2.45, GROUND, z], 0.045, 1.05);
        let solids = vec![
            Solid::spanning("basin floor", "concrete", [-ox, GROUND, -oz], [ox, 0.0, oz]),
            Solid::spanning(
                "basin wall, chute end",
                "concrete",
                [-ox, 0.0, -z],
                [-x, HIGH_WALL, z],
            ),
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
        Self { solids }
    }

    /// Whether water here has left the scene: it is beyond the outer faces of the walls, and not
    /// on its way down the chute.
    pub fn lost(&self, at: Vec3) -> bool {
        let [x, z] = BASIN_HALF;
        let over = at.x.abs() > x + WALL || at.z.abs() > z + WALL;
        let on_chute = at.x < 0.0 && at.y > HIGH_WALL - 0.1 && at.z.abs() < CHUTE_HALF_WIDTH + 0.06;
        over && !on_chute || at.y < GROUND
    }

    /// The scene for a renderer: what to draw, the ground, a camera.
    pub fn to_json(&self, spacing: f32, rest_density: f32) -> Value {
        let number = |v: f32| (f64::from(v) * 1e5).round() / 1e5;
        let vector = |v: Vec3| json!([number(v.x), number(v.y), number(v.z)]);
        let of = |shape| self.solids.iter().filter(move |solid| solid.shape == shape);
        let boxes: Vec<Value> = of(Shape::Box)
            .map(|solid| {
                let q = Quat::from_rotation_z(solid.angle);
                json!({
                    "name": solid.name,
                    "material": solid.material,
                    "centre": vector(solid.centre),
                    "half": vector(solid.half),
                    "rotation": [0.0, 0.0, f64::from(q.z), f64::from(q.w)],
                })
            })
            .collect();
        let cylinders: Vec<Value> = of(Shape::Cylinder)
            .map(|solid| {
                json!({
                    "name": solid.name,
                    "material": solid.material,
                    "centre": vector(solid.centre),
                    "radius": number(solid.half.x),
                    "height": number(2.0 * solid.half.y),
                })
            })
            .collect();
        json!({
            "name": "waterfall",
            "units": "metres; y up, right-handed; rotation is a quaternion x y z w; cylinders are upright, centre at half height",
            "ground": { "y": number(GROUND), "material": "ground" },
            "boxes": boxes,
            "cylinders": cylinders,
            "camera": {
                "eye": vector(CAMERA_EYE),
                "target": vector(CAMERA_TARGET),
                "up": [0.0, 1.0, 0.0],
                "fov_y_degrees": number(CAMERA_FOV),
            },
            "fluid": {
                "spacing": number(spacing),
                "support": number(2.0 * spacing),
                "rest_density": number(rest_density),
                "pool_level": number(POOL_DEPTH),
            },
        })
    }
}

/// Where the suggested camera stands.
pub const CAMERA_EYE: Vec3 = Vec3::new(0.6, 2.4, 4.3);
/// What the suggested camera looks at.
pub const CAMERA_TARGET: Vec3 = Vec3::new(-0.45, 0.37, 0.0);
/// The suggested camera's vertical field of view, degrees.
pub const CAMERA_FOV: f32 = 38.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_is_signed_and_its_gradient_has_unit_length() {
        let scene = Scene::waterfall();
        for solid in &scene.solids {
            assert!(solid.distance(solid.centre).0 < 0.0, "{}", solid.name);
            let far = solid.centre + Vec3::new(0.9, 1.3, 2.1);
            let (d, n) = solid.distance(far);
            assert!(d > 0.0 && (n.length() - 1.0).abs() < 1e-4, "{}", solid.name);
            let closer = solid.distance(far - n * (0.5 * d)).0;
            assert!((closer - 0.5 * d).abs() < 1e-4, "{}", solid.name);
        }
    }

    #[test]
    fn the_inlet_is_clear() {
        let frame = chute_frame();
        let scene = Scene::waterfall();
        for across in [-0.28_f32, 0.0, 0.28] {
            for up in [0.02_f32, 0.1, 0.18] {
                let at = LIP - frame.along * INLET + frame.up * up + Vec3::Z * across;
                let nearest = scene.solids.iter().map(|s| s.distance(at).0).fold(1.0, f32::min);
                assert!(nearest > 0.015, "{at}: {nearest}");
            }
        }
    }
}
