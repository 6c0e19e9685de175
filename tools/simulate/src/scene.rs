//! The definition of a scene, in one place: the solver collides with the same solids that `scene.json` tells a renderer
//! to draw.
//!
//! Metres, y up, right-handed. Solids are turned about z alone.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3};
use serde_json::{Value, json};

use crate::hinge::Hinge;

/// Shape of a solid in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A box; `half` are its half extents.
    Box,
    /// A cylinder about y; `half` is (radius, half height, radius).
    Cylinder,
    /// A cylinder about y with a hole along its axis.
    Tube {
        /// The radius of the hole.
        bore: f32,
        /// How steeply the top is cut: it lies at half the height plus `slope` times x.
        slope: f32,
    },
}

/// A solid.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Name of the solid.
    pub name: &'static str,
    /// Name of its material.
    pub material: &'static str,
    /// Its shape.
    pub shape: Shape,
    /// Its centre.
    pub centre: Vec3,
    /// Its half extents.
    pub half: Vec3,
    /// Its rotation about +z, radians, counter-clockwise seen from +z.
    pub angle: f32,
    /// Whether water collides with it; otherwise it is only drawn.
    pub collides: bool,
    /// Whether it turns with the scene's hinge.
    pub moves: bool,
}

impl Solid {
    /// A box from corner to corner.
    pub fn spanning(
        name: &'static str,
        material: &'static str,
        min: [f32; 3],
        max: [f32; 3],
    ) -> Self {
        let (min, max) = (Vec3::from(min), Vec3::from(max));
        Self::new(name, material, Shape::Box, 0.5 * (min + max), 0.5 * (max - min), 0.0)
    }

    /// An upright cylinder, by its foot.
    pub fn standing(
        name: &'static str,
        material: &'static str,
        foot: [f32; 3],
        radius: f32,
        height: f32,
    ) -> Self {
        let centre = Vec3::from(foot) + Vec3::Y * (0.5 * height);
        let half = Vec3::new(radius, 0.5 * height, radius);
        Self::new(name, material, Shape::Cylinder, centre, half, 0.0)
    }

    /// Any solid, in its position at rest.
    pub fn new(
        name: &'static str,
        material: &'static str,
        shape: Shape,
        centre: Vec3,
        half: Vec3,
        angle: f32,
    ) -> Self {
        let (centre, half) = (rounded(centre), rounded(half));
        Self { name, material, shape, centre, half, angle, collides: true, moves: false }
    }

    /// The same solid, drawn but without collision.
    pub fn drawn_only(self) -> Self {
        Self { collides: false, ..self }
    }

    /// The same solid, turned about an axis along z through `axle`.
    pub fn turned(&self, axle: Vec3, by: f32) -> Self {
        let arm = Quat::from_rotation_z(by) * (self.centre - axle);
        Self { centre: axle + arm, angle: self.angle + by, ..self.clone() }
    }

    /// Radius of a ball about its centre that contains it.
    pub fn reach(&self) -> f32 {
        let longer = match self.shape {
            Shape::Tube { slope, .. } => Vec3::Y * (slope.abs() * self.half.x),
            _ => Vec3::ZERO,
        };
        (self.half + longer).length()
    }

    /// Whether a point lies in its bore.
    pub fn holds(&self, at: Vec3) -> bool {
        let Shape::Tube { bore, slope } = self.shape else {
            return false;
        };
        let local = Quat::from_rotation_z(-self.angle) * (at - self.centre);
        let top = self.half.y + slope * local.x;
        local.x.hypot(local.z) < bore && (-self.half.y..top).contains(&local.y)
    }

    /// The signed distance to the solid (negative inside) and the direction in which it grows.
    pub fn distance(&self, at: Vec3) -> (f32, Vec3) {
        let offset = at - self.centre;
        let (sin, cos) = self.angle.sin_cos();
        let local =
            Vec3::new(cos * offset.x + sin * offset.y, cos * offset.y - sin * offset.x, offset.z);
        let (d, n) = match self.shape {
            Shape::Box => box_distance(local, self.half),
            Shape::Cylinder => {
                let (length, outward) = radial(local);
                let flat = Vec3::new(length, local.y, 0.0);
                // In the plane through the axis the cylinder is a rectangle.
                let (d, n) = box_distance(flat, Vec3::new(self.half.x, self.half.y, 1e6));
                (d, outward * n.x + Vec3::Y * n.y)
            }
            Shape::Tube { bore, slope } => self.tube_distance(local, bore, slope),
        };
        (d, Vec3::new(cos * n.x - sin * n.y, sin * n.x + cos * n.y, n.z))
    }

    /// Exact for a straight cut. Beyond the edge of a slanted cut it is a lower bound of the distance.
    fn tube_distance(&self, local: Vec3, bore: f32, slope: f32) -> (f32, Vec3) {
        let (length, outward) = radial(local);
        let middle = 0.5 * (self.half.x + bore);
        let across = (length - middle).abs() - 0.5 * (self.half.x - bore);
        let aside = if length < middle { -outward } else { outward };
        let cut = Vec3::new(-slope, 1.0, 0.0) / (1.0 + slope * slope).sqrt();
        let top = cut.dot(local - Vec3::Y * self.half.y);
        let bottom = -self.half.y - local.y;
        let (end, along) = if top > bottom { (top, cut) } else { (bottom, Vec3::NEG_Y) };
        let outside = Vec2::new(across, end).max(Vec2::ZERO);
        if outside == Vec2::ZERO {
            return if across > end { (across, aside) } else { (end, along) };
        }
        let gradient = aside * outside.x + along * outside.y;
        (outside.length(), gradient.normalize_or(along))
    }

    fn to_json(&self) -> Value {
        let mut value = json!({
            "name": self.name,
            "material": self.material,
            "centre": vector(self.centre),
        });
        let q = Quat::from_rotation_z(self.angle);
        let rotation = json!([0.0, 0.0, f64::from(q.z), f64::from(q.w)]);
        if self.shape == Shape::Box {
            value["half"] = vector(self.half);
            value["rotation"] = rotation;
            return value;
        }
        value["radius"] = number(self.half.x);
        value["height"] = number(2.0 * self.half.y);
        if self.angle != 0.0 {
            value["rotation"] = rotation;
        }
        if let Shape::Tube { bore, slope } = self.shape {
            value["bore"] = number(bore);
            if slope != 0.0 {
                value["slope"] = number(slope);
            }
        }
        value
    }
}

/// The distance from the y axis, and the direction away from it.
fn radial(at: Vec3) -> (f32, Vec3) {
    let away = Vec3::new(at.x, 0.0, at.z);
    let length = away.length();
    (length, if length > 1e-6 { away / length } else { Vec3::X })
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

/// Rounds to a hundredth of a millimetre, so that `scene.json` has exactly the simulated numbers.
pub fn rounded(v: Vec3) -> Vec3 {
    (v * 1e5).round() / 1e5
}

fn number(v: f32) -> Value {
    json!((f64::from(v) * 1e5).round() / 1e5)
}

fn vector(v: Vec3) -> Value {
    Value::Array(v.to_array().map(number).to_vec())
}

/// Water that exists from the beginning.
#[derive(Clone, Copy, Debug)]
pub enum Fill {
    /// Water between the floor and the walls of a basin, up to `max.y`.
    Basin {
        /// The corner at the floor.
        min: Vec3,
        /// The opposite corner, at the surface.
        max: Vec3,
    },
    /// Water in a round vessel or a bore.
    Bore {
        /// The middle of its floor.
        foot: Vec3,
        /// Rotation of its axis (y) about +z.
        angle: f32,
        /// Its inner radius.
        radius: f32,
        /// Its length.
        length: f32,
        /// The height up to which it is filled.
        level: f32,
    },
}

/// Cross-section of an inlet.
#[derive(Clone, Copy, Debug)]
pub enum Section {
    /// A channel with walls on both sides and a bed below.
    Channel {
        /// Half the width along z.
        half_width: f32,
        /// Depth of the water that enters.
        depth: f32,
    },
    /// A pipe about the inlet's axis.
    Pipe {
        /// Its inner radius.
        radius: f32,
    },
}

/// A place where water enters.
#[derive(Clone, Debug)]
pub struct Inlet {
    /// A point on the bed, or on the pipe's axis.
    pub origin: Vec3,
    /// Direction downstream, unit length.
    pub along: Vec3,
    /// Normal of the bed, unit length; z is across.
    pub up: Vec3,
    /// Position where water enters, along the inlet from its origin.
    pub start: f32,
    /// Its cross-section.
    pub section: Section,
    /// The mean speed, m/s.
    pub speed: f32,
    /// When it opens, seconds.
    pub opens: f32,
    /// When it closes, seconds.
    pub closes: f32,
}

impl Inlet {
    /// Whether water enters now.
    pub fn is_open(&self, time: f32) -> bool {
        (self.opens..self.closes).contains(&time)
    }

    /// Speed at which water enters; it swells a little.
    pub fn speed_at(&self, time: f32) -> f32 {
        let t = time - self.opens;
        self.speed * (1.0 + 0.06 * (TAU * 1.7 * t).sin() + 0.04 * (TAU * 3.9 * t + 1.0).sin())
    }

    /// Whether a particle belongs to the newest layers, which have none behind them yet.
    pub fn has_just_entered(&self, at: Vec3, spacing: f32) -> bool {
        let entered = at - self.origin;
        let (aside, up) = match self.section {
            Section::Channel { half_width, depth } => (half_width, 2.0 * depth),
            Section::Pipe { radius } => (radius, radius),
        };
        entered.dot(self.along) < 2.0 * spacing + self.start
            && entered.dot(self.up).abs() < up
            && entered.z.abs() < aside
    }
}

/// A key of the moving camera.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Time of the key as a fraction of the sequence, 0 to 1.
    pub at: f32,
    /// Position of the camera.
    pub eye: Vec3,
    /// Point that it looks at.
    pub target: Vec3,
}

/// A scene.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Its name on the command line and in files.
    pub name: &'static str,
    /// Everything except water, at rest.
    pub solids: Vec<Solid>,
    /// The top of the ground.
    pub ground: f32,
    /// Material of the ground.
    pub ground_material: &'static str,
    /// Water at the beginning.
    pub fills: Vec<Fill>,
    /// Water that comes in.
    pub inlets: Vec<Inlet>,
    /// Hinge of the moving solids.
    pub hinge: Option<Hinge>,
    /// Half extents and depth of the pool about the origin in which waves are started.
    pub waves: Option<Vec3>,
    /// The depth of a tiled pool at rest.
    pub pool_level: Option<f32>,
    /// Corners of boxes. Water outside all of them has left the scene.
    pub kept: Vec<[Vec3; 2]>,
    /// Corners of a box round most of the water, in which neighbours are found fastest.
    pub bounds: [Vec3; 2],
    /// How long the scene runs, after its water has settled, before frame 0.
    pub lead: f32,
    /// The distance of particles at rest unless another is asked for, metres.
    pub spacing: f32,
    /// The distances that its solids allow.
    pub spacings: [f32; 2],
    /// The suggested camera, at rest.
    pub view: Key,
    /// The suggested camera, moving.
    pub keys: Vec<Key>,
    /// Its vertical field of view, degrees.
    pub fov: f32,
}

/// Frames that a sequence has unless others are asked for, from 1 on.
pub const FRAMES: u32 = 240;
/// Their number per second.
pub const FPS: f32 = 60.0;

impl Scene {
    /// The names that [`Scene::named`] knows.
    pub const NAMES: [&str; 3] = ["waterfall", "corridor", "bamboo"];

    /// A scene by its name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "waterfall" => Some(crate::scenes::waterfall()),
            "corridor" => Some(crate::scenes::corridor()),
            "bamboo" => Some(crate::scenes::bamboo()),
            _ => None,
        }
    }

    /// Whether water here has left the scene.
    pub fn lost(&self, at: Vec3) -> bool {
        !self.kept.iter().any(|[min, max]| at.cmpge(*min).all() && at.cmple(*max).all())
    }

    /// The solids when the moving ones have turned by so much since they were at rest.
    pub fn posed(&self, turn: f32) -> Vec<Solid> {
        let pose = |solid: &Solid| match &self.hinge {
            Some(hinge) if solid.moves => solid.turned(hinge.axle, turn),
            _ => solid.clone(),
        };
        self.solids.iter().map(pose).collect()
    }

    /// The scene as a renderer reads it: solids, ground, camera and moving parts. `turns` holds the hinge's angle in
    /// frame 0 and each frame after it.
    pub fn to_json(&self, spacing: f32, rest_density: f32, turns: &[f32]) -> Value {
        let of = |boxes: bool| -> Vec<Value> {
            let of = self.solids.iter().filter(|solid| (solid.shape == Shape::Box) == boxes);
            of.map(Solid::to_json).collect()
        };
        let mut fluid = json!({
            "spacing": number(spacing),
            "support": number(2.0 * spacing),
            "rest_density": number(rest_density),
        });
        if let Some(level) = self.pool_level {
            fluid["pool_level"] = number(level);
        }
        let mut scene = json!({
            "name": self.name,
            "units": "metres; y up, right-handed; rotation is a quaternion x y z w; cylinders are upright, centre at half height",
            "ground": { "y": number(self.ground), "material": self.ground_material },
            "boxes": of(true),
            "cylinders": of(false),
            "camera": {
                "eye": vector(self.view.eye),
                "target": vector(self.view.target),
                "up": [0.0, 1.0, 0.0],
                "fov_y_degrees": number(self.fov),
            },
            "fluid": fluid,
        });
        if let Some(hinge) = &self.hinge {
            let parts = self.solids.iter().filter(|solid| solid.moves).map(|solid| solid.name);
            let pose = |turn: &f32| {
                let q = Quat::from_rotation_z(*turn);
                let [x, y, z] = hinge.axle.to_array().map(number);
                json!([x, y, z, 0.0, 0.0, number(q.z), number(q.w)])
            };
            scene["motion"] = json!([{
                "parts": parts.collect::<Vec<_>>(),
                "origin": vector(hinge.axle),
                "first_frame": 0,
                "poses": turns.iter().map(pose).collect::<Vec<_>>(),
            }]);
        }
        scene
    }

    /// The moving camera over these frames, as `whitewater render --camera` reads it.
    pub fn camera_json(&self, first: u32, last: u32) -> Value {
        let key = |key: &Key| {
            let frame = first as f32 + key.at * last.saturating_sub(first) as f32;
            json!({
                "frame": frame.round() as u32,
                "eye": vector(key.eye),
                "target": vector(key.target),
            })
        };
        let mut keys: Vec<Value> = self.keys.iter().map(key).collect();
        // Short sequences have fewer frames than keys.
        keys.dedup_by_key(|key| key["frame"].as_u64());
        json!({ "fov_y_degrees": number(self.fov), "keys": keys })
    }
}

/// JSON that people can read too: short arrays of numbers stay on one line.
pub fn text(value: &Value) -> String {
    let mut out = String::new();
    print(value, 0, &mut out);
    out.push('\n');
    out
}

fn print(value: &Value, depth: usize, out: &mut String) {
    let items: Vec<(Option<&String>, &Value)> = match value {
        Value::Array(items) if !items.iter().all(Value::is_number) => {
            items.iter().map(|item| (None, item)).collect()
        }
        Value::Object(items) => items.iter().map(|(name, item)| (Some(name), item)).collect(),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(Value::to_string).collect();
            return out.push_str(&format!("[{}]", items.join(", ")));
        }
        _ => return out.push_str(&value.to_string()),
    };
    let brackets = if value.is_array() { ['[', ']'] } else { ['{', '}'] };
    out.push(brackets[0]);
    for (index, (name, item)) in items.iter().enumerate() {
        out.push_str(if index > 0 { ",\n" } else { "\n" });
        out.push_str(&"  ".repeat(depth + 1));
        if let Some(name) = name {
            out.push_str(&format!("{}: ", Value::String(name.to_string())));
        }
        print(item, depth + 1, out);
    }
    out.push('\n');
    out.push_str(&"  ".repeat(depth));
    out.push(brackets[1]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> impl Iterator<Item = Scene> {
        Scene::NAMES.into_iter().map(|name| Scene::named(name).expect("known"))
    }

    #[test]
    fn distance_is_signed_and_its_gradient_has_unit_length() {
        for scene in all() {
            for solid in &scene.solids {
                // The centre of a tube is empty; the centre of its wall is not.
                let wall = match solid.shape {
                    Shape::Tube { bore, .. } => Vec3::Z * (0.5 * (bore + solid.half.x)),
                    _ => Vec3::ZERO,
                };
                assert!(solid.distance(solid.centre + wall).0 < 0.0, "{}", solid.name);
                let far = solid.centre + Vec3::new(0.9, 3.3, 2.1);
                let (d, n) = solid.distance(far);
                assert!(d > 0.0 && (n.length() - 1.0).abs() < 1e-4, "{}", solid.name);
                let closer = solid.distance(far - n * (0.5 * d)).0;
                // Beyond the edge of a slanted cut the distance is only a bound.
                let slack = match solid.shape {
                    Shape::Tube { slope, .. } if slope != 0.0 => 0.3 * d,
                    _ => 1e-4,
                };
                assert!((closer - 0.5 * d).abs() < slack, "{}", solid.name);
                assert!(solid.reach() + d >= (far - solid.centre).length() - 1e-4);
            }
        }
    }

    #[test]
    fn a_tube_is_hollow_and_its_cut_is_slanted() {
        let shape = Shape::Tube { bore: 0.1, slope: 1.0 };
        let half = Vec3::new(0.125, 0.5, 0.125);
        let tube = Solid::new("tube", "plain", shape, Vec3::ZERO, half, 0.0);
        let (d, n) = tube.distance(Vec3::new(0.0, 0.1, 0.06));
        assert!((d - 0.04).abs() < 1e-5 && n.distance(Vec3::NEG_Z) < 1e-5, "{d} {n}");
        let (d, n) = tube.distance(Vec3::new(0.0, 0.1, -0.2));
        assert!((d - 0.075).abs() < 1e-5 && n.distance(Vec3::NEG_Z) < 1e-5, "{d} {n}");
        // The lip is higher at +x than at -x.
        assert!(tube.distance(Vec3::new(0.112, 0.58, 0.0)).0 < 0.0);
        assert!(tube.distance(Vec3::new(-0.112, 0.42, 0.0)).0 > 0.0);
        let turned = tube.turned(Vec3::X, 0.7);
        let arm = Quat::from_rotation_z(0.7) * (Vec3::new(0.0, 0.1, 0.06) - Vec3::X);
        assert!((turned.distance(Vec3::X + arm).0 - 0.04).abs() < 1e-5);
    }

    #[test]
    fn inlets_are_clear() {
        for scene in all() {
            for inlet in &scene.inlets {
                let (aside, up) = match inlet.section {
                    Section::Channel { half_width, depth } => {
                        let aside = [0.02 - half_width, 0.0, half_width - 0.02];
                        (aside, [0.02, 0.5 * depth, depth - 0.02])
                    }
                    Section::Pipe { radius } => ([0.0; 3], [0.02 - radius, 0.0, radius - 0.02]),
                };
                for (aside, up) in aside.into_iter().flat_map(|a| up.map(|u| (a, u))) {
                    let at = inlet.origin + inlet.along * inlet.start + inlet.up * up;
                    let at = at + Vec3::Z * aside;
                    let solids = scene.solids.iter().filter(|s| s.collides);
                    let nearest = solids.map(|s| s.distance(at).0).fold(1.0, f32::min);
                    assert!(nearest > 0.015, "{}, {at}: {nearest}", scene.name);
                    assert!(!scene.lost(at), "{}", scene.name);
                }
            }
        }
    }

    #[test]
    fn numbers_that_belong_together_stand_in_a_line() {
        let value = json!({"a": [1.0, 2.0], "b": [{"c": "d"}, [3]], "e": {}});
        let text = text(&value);
        assert!(text.contains("\"a\": [1.0, 2.0],\n"), "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).expect("sound"), value);
    }
}
