//! The camera: from a file, from flags, or found from the particles.

use std::path::Path;

use glam::{Mat4, Quat, Vec2, Vec3, Vec4};
use serde::{Deserialize, Serialize};
use whitewater::Camera;

use crate::args::CameraArgs;
use crate::bounds::Bounds;
use crate::failure::{Failure, Outcome};

const DEFAULT_FOV: f32 = 40.0;
/// Vertical field of view in degrees of a camera that is found from the particles: neither
/// wide-angle nor telephoto.
const FOUND_FOV: f32 = 36.0;
/// Height of the horizon in the view of a camera that is found from the particles, from the picture's middle (0) to
/// its upper edge (1): the sky takes 15 % of the picture's height.
const HORIZON: f32 = 0.7;
/// Min and max angle of the camera's axis below the horizontal, radians, whatever the field of view is.
const LEAST_PITCH: f32 = 0.14;
const MOST_PITCH: f32 = 0.52;
/// Max angle below the horizontal, in degrees, of the line from the eye to the middle of the floor. If the camera's
/// axis points down by more than 21 degrees, the max is 6 degrees more than the axis instead.
const HIGHEST: f32 = 27.0;
/// Max distance of the framed points from the picture's middle, as a part of half its height (`FILLED`) and of half
/// its width (`WIDTH`).
const FILLED: f32 = 0.86;
const WIDTH: f32 = 0.73;

/// A camera as in its file: the first six values, or `view` and `projection`, or `keys` of an
/// animated camera. With `keys`, eye and target come from the keys; `up` and `fov_y_degrees` are the defaults of keys
/// without them, and `near` and `far` hold for all frames.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct CameraFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov_y_degrees: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub near: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub far: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<[f32; 16]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub projection: Option<[f32; 16]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keys: Vec<Key>,
    /// Orbit around the target.
    #[serde(skip)]
    pub turn: Option<Turn>,
}

/// An orbit around the target about the up direction, counter-clockwise as seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// The frame in which the camera is at its original position.
    pub first: u64,
    /// Frames of one orbit.
    pub frames: f32,
}

/// Key frame of an animated camera.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Key {
    pub frame: u64,
    pub eye: [f32; 3],
    pub target: [f32; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov_y_degrees: Option<f32>,
}

/// Eye, target and up, and the field of view in degrees.
type Pose = ([Vec3; 3], f32);

impl CameraFile {
    /// The camera at a frame, on its way along the keys and around the target. It does not depend on which other
    /// frames are drawn.
    pub fn at_frame(&self, frame: u64) -> Self {
        let camera = self.on_its_way(frame);
        match (self.turn, camera.eye, camera.target) {
            (Some(turn), Some(eye), Some(target)) => {
                let target = Vec3::from(target);
                let up = camera.up.map_or(Vec3::Y, Vec3::from).normalize_or(Vec3::Y);
                let parts = (frame as f64 - turn.first as f64) / f64::from(turn.frames);
                let angle = (std::f64::consts::TAU * parts.rem_euclid(1.0)) as f32;
                let turned = Quat::from_axis_angle(up, angle) * (Vec3::from(eye) - target);
                Self { eye: Some((target + turned).to_array()), turn: None, ..camera }
            }
            _ => Self { turn: None, ..camera },
        }
    }

    /// The same without the orbit.
    fn on_its_way(&self, frame: u64) -> Self {
        let (Some(first), Some(last)) = (self.keys.first(), self.keys.last()) else {
            return self.clone();
        };
        let frame = frame.clamp(first.frame, last.frame);
        // The segment that begins at the key before (or at) the frame.
        let next = self.keys.partition_point(|key| key.frame <= frame).min(self.keys.len() - 1);
        let before = next.saturating_sub(1);
        let (a, b) = (&self.keys[before], &self.keys[next]);
        let length = (b.frame - a.frame) as f32;
        let t = if length > 0.0 { (frame - a.frame) as f32 / length } else { 0.0 };
        // Cubic Hermite spline with Catmull-Rom slopes at inner keys and slope 0 at the first and
        // last key.
        let (t2, t3) = (t * t, t * t * t);
        let weights = [
            (2.0 * t3 - 3.0 * t2 + 1.0, self.pose(a)),
            (3.0 * t2 - 2.0 * t3, self.pose(b)),
            ((t3 - 2.0 * t2 + t) * length, self.slope(before)),
            ((t3 - t2) * length, self.slope(next)),
        ];
        let mut sum: Pose = ([Vec3::ZERO; 3], 0.0);
        for (weight, (vectors, fov)) in weights {
            for (sum, vector) in sum.0.iter_mut().zip(vectors) {
                *sum += weight * vector;
            }
            sum.1 += weight * fov;
        }
        let ([eye, target, up], fov) = sum;
        Self {
            eye: Some(eye.to_array()),
            target: Some(target.to_array()),
            up: Some(up.to_array()),
            fov_y_degrees: Some(fov),
            keys: Vec::new(),
            ..self.clone()
        }
    }

    fn pose(&self, key: &Key) -> Pose {
        let up = key.up.or(self.up).map_or(Vec3::Y, Vec3::from);
        let fov = key.fov_y_degrees.or(self.fov_y_degrees).unwrap_or(DEFAULT_FOV);
        ([key.eye.into(), key.target.into(), up], fov)
    }

    /// Slope at a key, per frame: (next key - previous key) / (frames between these two). It is 0 at the first and at
    /// the last key.
    fn slope(&self, key: usize) -> Pose {
        let around = (key.checked_sub(1).and_then(|k| self.keys.get(k)), self.keys.get(key + 1));
        let (Some(a), Some(b)) = around else { return ([Vec3::ZERO; 3], 0.0) };
        let per_frame = ((b.frame - a.frame) as f32).recip();
        let ((from, from_fov), (to, to_fov)) = (self.pose(a), self.pose(b));
        let slopes = [0, 1, 2].map(|i| (to[i] - from[i]) * per_frame);
        (slopes, (to_fov - from_fov) * per_frame)
    }

    /// Adds an orbit. Fails if the camera is animated or has no target.
    pub fn turned(self, turn: Turn) -> Outcome<Self> {
        if self.eye.is_none() || self.target.is_none() {
            let why = "--turntable: expected a camera with eye and target that stands still, found keys or matrices";
            return Err(Failure::input(why));
        }
        Ok(Self { turn: Some(turn), ..self })
    }

    /// Fails if the camera of any of these frames cannot be drawn.
    pub fn check(&self, frames: impl IntoIterator<Item = u64>, size: (u32, u32)) -> Outcome<()> {
        let bad = |what: String| Err(Failure::input(format!("camera: {what}")));
        if self.keys.windows(2).any(|pair| pair[0].frame >= pair[1].frame) {
            return bad("expected keys in the order of their frames; sort them".into());
        }
        if !self.keys.is_empty() {
            if self.eye.is_some() || self.target.is_some() || self.view.is_some() {
                return bad("expected either keys or one view, found both; leave one out".into());
            }
            for frame in frames {
                let camera = self.at_frame(frame).camera(size);
                if let Err(failure) = camera.and_then(|camera| Lens::new(&camera)) {
                    return bad(format!("frame {frame}: {}", failure.message));
                }
            }
            return Ok(());
        }
        Lens::new(&self.camera(size)?).map(drop)
    }

    /// The camera of the flags or of a file; `None` without either.
    pub fn from_args(args: &CameraArgs) -> Outcome<Option<Self>> {
        if let Some(path) = &args.file {
            let text = std::fs::read_to_string(path).map_err(|e| Failure::reading(path, &e))?;
            return Self::parse(&text, path).map(Some);
        }
        Ok(args.eye.map(|eye| Self {
            eye: Some(eye),
            target: args.target,
            up: args.up,
            fov_y_degrees: args.fov,
            ..Self::default()
        }))
    }

    fn parse(text: &str, path: &Path) -> Outcome<Self> {
        serde_json::from_str(text).map_err(|e| {
            Failure::input(format!(
                "{}: expected a camera such as {{\"eye\":[1,1,3],\"target\":[0,0,0],\"fov_y_degrees\":40}}, \
                 or its keys {{\"keys\":[{{\"frame\":1,\"eye\":..,\"target\":..}},..]}}, found {e}; mend the file",
                path.display()
            ))
        })
    }

    /// Distance from the eye to the target.
    pub fn distance(&self) -> Option<f32> {
        Some(Vec3::from(self.eye?).distance(self.target?.into()))
    }

    /// Matrices for a picture of this size.
    pub fn camera(&self, size: (u32, u32)) -> Outcome<Camera> {
        let bad = |what: &str| Err(Failure::input(format!("camera: {what}")));
        if let (Some(view), Some(projection)) = (self.view, self.projection) {
            if self.eye.is_some() || self.target.is_some() || self.fov_y_degrees.is_some() {
                return bad(
                    "expected either eye and target or view and projection, found both; leave one out",
                );
            }
            let camera =
                Camera::of(Mat4::from_cols_array(&view), Mat4::from_cols_array(&projection));
            return Ok(camera);
        }
        let (Some(eye), Some(target)) = (self.eye, self.target) else {
            return bad("expected eye and target, or view and projection; add what is missing");
        };
        let (eye, target) = (Vec3::from(eye), Vec3::from(target));
        let up = self.up.map_or(Vec3::Y, Vec3::from);
        let forward = target - eye;
        if !forward.is_finite() || forward.length() <= 0.0 {
            return bad("expected eye and target at different places; move one");
        }
        if forward.normalize().cross(up.normalize_or_zero()).length() < 1.0e-4 {
            return bad("expected up to differ from the direction of view; choose another up");
        }
        let fov = self.fov_y_degrees.unwrap_or(DEFAULT_FOV);
        if !(0.1..=170.0).contains(&fov) {
            return bad(&format!("expected fov_y_degrees from 0.1 to 170, found {fov}"));
        }
        let near = self.near.unwrap_or(0.01 * forward.length());
        if !(near.is_finite() && near > 0.0 && self.far.is_none_or(|far| far > near)) {
            return bad("expected 0 < near < far; mend them");
        }
        let aspect = size.0 as f32 / size.1 as f32;
        // Reversed depth: a 32-bit float then has the same precision near and far.
        let mut projection = match self.far {
            Some(far) => Mat4::perspective_rh(fov.to_radians(), aspect, far, near),
            None => Mat4::perspective_infinite_reverse_rh(fov.to_radians(), aspect, near),
        };
        projection.y_axis *= -1.0; // Vulkan: row 0 on top
        Ok(Camera::of(Mat4::look_at_rh(eye, target, up), projection))
    }

    /// A three-quarter view: the horizon is below the upper edge by 15 % of the picture's height, and the water is in
    /// the lower part. The camera is as near as it can be while the bulk of the water of every frame is in the
    /// picture.
    pub fn of_particles(
        frames: &[&[[f32; 3]]],
        bounds: &Bounds,
        fov: Option<f32>,
        size: (u32, u32),
    ) -> Self {
        // The longer side faces the camera.
        let turn = if bounds.size().x >= bounds.size().z { 28.0_f32 } else { 62.0 };
        Self::turned_to(turn, frames, bounds, fov, size)
    }

    /// A front view of a sheet, that is, of particles that all lie in one plane: from +z, or from +x if the sheet is
    /// perpendicular to x.
    pub fn of_sheet(
        across_x: bool,
        frames: &[&[[f32; 3]]],
        bounds: &Bounds,
        fov: Option<f32>,
        size: (u32, u32),
    ) -> Self {
        Self::turned_to(if across_x { 90.0 } else { 0.0 }, frames, bounds, fov, size)
    }

    /// A view from `turn` degrees to the right of +z.
    fn turned_to(
        turn: f32,
        frames: &[&[[f32; 3]]],
        bounds: &Bounds,
        fov: Option<f32>,
        size: (u32, u32),
    ) -> Self {
        let fov = fov.unwrap_or(FOUND_FOV);
        let size3 = bounds.size();
        let turn = turn.to_radians();
        let towards = Vec3::new(turn.sin(), 0.0, turn.cos());
        let right = Vec3::Y.cross(towards);
        let foot = Vec3::new(bounds.center().x, bounds.min.y, bounds.center().z);
        let points = outline(frames, bounds, |p| {
            let d = p - foot;
            Vec3::new(d.dot(right), d.y, d.dot(towards))
        });
        let tan_y = (0.5 * fov.to_radians()).tan();
        let tan_x = tan_y * size.0 as f32 / size.1 as f32;
        let pitch = (HORIZON * tan_y).atan().clamp(LEAST_PITCH, MOST_PITCH);
        let (sin, cos) = pitch.sin_cos();
        let framing = Framing { points, tan: Vec2::new(tan_x, tan_y), sin, cos };
        // The eye is as high as it can be with all points above the lower edge of the picture, so that near walls
        // hide little of the water, but at an angle above the floor of at least `low`.
        let low = pitch + 2.0_f32.to_radians();
        let high = HIGHEST.to_radians().max(pitch + 6.0_f32.to_radians());
        let eye_at = |distance: f32| {
            let eye = |rise: f32| distance * Vec3::new(0.0, rise.sin(), rise.cos());
            let stands = |rise: f32| framing.seen(eye(rise)).is_some_and(|s| s.low.y >= -FILLED);
            let mut rise = (low, high);
            if !stands(high) {
                for _ in 0..12 {
                    let middle = 0.5 * (rise.0 + rise.1);
                    if stands(middle) {
                        rise.0 = middle;
                    } else {
                        rise.1 = middle;
                    }
                }
            } else {
                rise.0 = high;
            }
            let mut eye = eye(rise.0);
            for _ in 0..4 {
                if let Some(seen) = framing.seen(eye) {
                    eye.x += 0.5 * (seen.low.x + seen.high.x) * tan_x * distance;
                }
            }
            eye
        };
        let fits = |distance: f32| {
            framing.seen(eye_at(distance)).is_some_and(|s| {
                s.low.y >= -FILLED && s.high.y <= FILLED && s.high.x.max(-s.low.x) <= WIDTH
            })
        };
        let longest = size3.max_element().max(f32::MIN_POSITIVE);
        let mut distances = (0.5 * longest, longest);
        for _ in 0..24 {
            if fits(distances.1) {
                break;
            }
            distances = (distances.1, 1.5 * distances.1);
        }
        for _ in 0..16 {
            let middle = 0.5 * (distances.0 + distances.1);
            if fits(middle) {
                distances.1 = middle;
            } else {
                distances.0 = middle;
            }
        }
        let eye = eye_at(distances.1);
        let target = eye - distances.1 * Vec3::new(0.0, sin, cos);
        let world = |p: Vec3| (foot + right * p.x + Vec3::Y * p.y + towards * p.z).to_array();
        Self {
            eye: Some(world(eye)),
            target: Some(world(target)),
            up: Some([0.0, 1.0, 0.0]),
            fov_y_degrees: Some(fov),
            ..Self::default()
        }
    }

    /// The camera moved horizontally so that its target is straight above or below `point`. An orbit around the
    /// target then keeps an object that stands around `point` in the middle of the picture.
    pub fn over(mut self, point: Vec3) -> Self {
        if let (Some(eye), Some(target)) = (&mut self.eye, &mut self.target) {
            for axis in [0, 2] {
                eye[axis] += point[axis] - target[axis];
                target[axis] = point[axis];
            }
        }
        self
    }

    /// The camera as JSON, as in its file.
    pub fn json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Depth of a point along the direction of view; `None` if it is not in front of the eye.
pub fn depth(camera: &Camera, point: [f32; 3]) -> Option<f32> {
    // 1 or -1: whether depth grows along the view-space z axis.
    let along = camera.projection_matrix().z_axis.w.signum();
    let depth = along * camera.view_matrix().transform_point3(point.into()).z;
    (depth.is_finite() && depth > 0.0).then_some(depth)
}

/// Projects points for a camera whose horizon is level.
struct Framing {
    /// Points to the right, up, and towards the eye.
    points: Vec<Vec3>,
    /// Tangents of half the angles of view.
    tan: Vec2,
    /// Sine and cosine of the pitch.
    sin: f32,
    cos: f32,
}

/// Bounding rectangle of the projected points. -1 is the picture's left or lower edge, 1 the right or upper one.
struct Seen {
    low: Vec2,
    high: Vec2,
}

impl Framing {
    /// `None` if a point is behind the eye.
    fn seen(&self, eye: Vec3) -> Option<Seen> {
        let mut seen = Seen { low: Vec2::INFINITY, high: Vec2::NEG_INFINITY };
        for point in &self.points {
            let d = *point - eye;
            let depth = -d.y * self.sin - d.z * self.cos;
            if depth <= 0.0 {
                return None;
            }
            let at = Vec2::new(d.x, d.y * self.cos - d.z * self.sin) / (depth * self.tan);
            seen = Seen { low: seen.low.min(at), high: seen.high.max(at) };
        }
        Some(seen)
    }
}

/// Points that the picture has to contain: the highest and the lowest point, over all frames, in each cell of a
/// horizontal grid, without the farthest drops; and the corners of the floor. `along` converts a position to
/// coordinates to the right, upwards, and towards the eye.
fn outline(frames: &[&[[f32; 3]]], bounds: &Bounds, along: impl Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    const CELLS: usize = 24;
    let size = bounds.size();
    let floor = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
        .map(|[x, z]| along(bounds.min + size * Vec3::new(x, 0.0, z)));
    let low = floor.into_iter().fold(floor[0], Vec3::min);
    let high = floor.into_iter().fold(floor[0], Vec3::max);
    let step = ((high - low) / CELLS as f32).max(Vec3::splat(f32::MIN_POSITIVE));
    let mut cells = vec![(None::<Vec3>, None::<Vec3>); CELLS * CELLS];
    for positions in frames {
        // The limits without the farthest drops are found for each frame by itself, so that a brief splash does not
        // count as a stray of the whole sequence.
        let step_of = positions.len().div_ceil(20_000).max(1);
        let points: Vec<Vec3> = positions
            .iter()
            .step_by(step_of)
            .map(|p| Vec3::from(*p))
            .filter(|p| bounds.contains(*p))
            .map(&along)
            .collect();
        if points.is_empty() {
            continue;
        }
        let of = |get: &dyn Fn(&Vec3) -> f32| most(points.iter().map(get).collect());
        let end = Vec3::new(of(&|p| p.x), of(&|p| p.y), of(&|p| p.z));
        let start = -Vec3::new(of(&|p| -p.x), of(&|p| -p.y), of(&|p| -p.z));
        for point in &points {
            let point = point.clamp(start.min(end), end);
            let at = ((point - low) / step).clamp(Vec3::ZERO, Vec3::splat(CELLS as f32 - 1.0));
            let (top, bottom) = &mut cells[at.x as usize * CELLS + at.z as usize];
            if top.is_none_or(|t| t.y < point.y) {
                *top = Some(point);
            }
            if bottom.is_none_or(|b| b.y > point.y) {
                *bottom = Some(point);
            }
        }
    }
    let cells = cells.into_iter().flat_map(|(top, bottom)| [top, bottom]).flatten();
    cells.chain(floor).collect()
}

/// Upper limit of the values of a frame: the 0.995 quantile plus 0.35 of its distance from the median, or the max if
/// that is smaller. So the picture may lose one particle in two hundred, the farthest drops.
fn most(mut values: Vec<f32>) -> f32 {
    values.sort_unstable_by(f32::total_cmp);
    let Some(last) = values.last() else { return 0.0 };
    let bulk = values[values.len() - 1 - values.len() / 200];
    let middle = values[values.len() / 2];
    last.min(bulk + 0.35 * (bulk - middle).abs())
}

/// The parameters of a perspective camera, for computations on the CPU.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// Entries P00, P11, P20, P21 of the projection matrix.
    p: Vec4,
    /// Device depth to eye depth: `.0 / (device + .1)`.
    linear: (f32, f32),
    /// Device depth of the far plane.
    far: f32,
}

impl Lens {
    /// For a camera that the renderer accepts.
    pub fn new(camera: &Camera) -> Outcome<Self> {
        let m = camera.projection_matrix().to_cols_array_2d();
        if !camera.projection_matrix().is_finite()
            || !camera.view_matrix().is_finite()
            || m[2][3].abs() < 0.5
        {
            return Err(Failure::input(
                "camera: expected a finite perspective projection, found another; orthographic \
                 cameras cannot be drawn",
            ));
        }
        let mirror = if m[2][3] < 0.0 { 1.0 } else { -1.0 };
        let scale = 1.0 / m[2][3].abs();
        let p = Vec4::new(m[0][0], m[1][1], mirror * m[2][0], mirror * m[2][1]) * scale;
        let linear = (m[3][2] * scale, mirror * m[2][2] * scale);
        // Of the planes at device depth 0 and 1, the one with the larger eye depth is the far plane. A plane at
        // infinity may give a depth of zero or a negative one.
        let depth = |z: f32| {
            let depth = linear.0 / (z + linear.1);
            if depth.is_finite() && depth > 0.0 { depth } else { f32::INFINITY }
        };
        let far = if depth(0.0) > depth(1.0) { 0.0 } else { 1.0 };
        Ok(Self { p, linear, far })
    }

    /// Eye depth of a device depth; `EMPTY` at the far plane.
    pub fn eye_depth(&self, device: f32) -> f32 {
        let depth = self.linear.0 / (device + self.linear.1);
        if device != self.far && depth.is_finite() && depth > 0.0 {
            depth
        } else {
            whitewater::io::picture::EMPTY
        }
    }

    /// Scale (first two values) and offset (last two) that convert texel coordinates, with centres at +0.5, to x /
    /// depth and y / depth in view space. A texel is `texel` pixels wide.
    pub fn slope(&self, size: (u32, u32), texel: f32) -> [f32; 4] {
        let x = 2.0 * texel / (size.0 as f32 * self.p.x);
        let y = 2.0 * texel / (size.1 as f32 * self.p.y);
        [x, y, (self.p.z - 1.0) / self.p.x, (self.p.w - 1.0) / self.p.y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Position in the picture, -1 to 1 from the left and top, of a point in front of the eye.
    fn shown(file: &CameraFile, size: (u32, u32), p: Vec3) -> Vec2 {
        let camera = file.camera(size).unwrap();
        let clip = camera.projection_matrix() * camera.view_matrix() * p.extend(1.0);
        assert!(clip.w > 0.0, "{p} is behind the eye");
        Vec2::new(clip.x, clip.y) / clip.w
    }

    #[test]
    fn the_found_camera_sees_every_particle() {
        let positions: Vec<[f32; 3]> = (0..4096)
            .map(|i| {
                [(i % 16) as f32 * 0.3 + 5.0, (i / 16 % 16) as f32 * 0.1, (i / 256) as f32 * 0.2]
            })
            .collect();
        let bounds = Bounds::of_bulk(&positions).unwrap();
        for (fov, size) in [
            (None, (1280, 720)),
            (None, (300, 900)),
            (None, (1, 1)),
            (Some(10.0), (1280, 720)),
            (Some(90.0), (1280, 720)),
        ] {
            let file = CameraFile::of_particles(&[&positions], &bounds, fov, size);
            let mut most = Vec2::ZERO;
            for p in &positions {
                most = most.max(shown(&file, size, Vec3::from(*p)).abs());
            }
            // The points fill the width or the height.
            assert!(most.x < WIDTH + 0.01 && most.y < FILLED + 0.01, "{fov:?} {size:?}: {most}");
            assert!(most.x > WIDTH - 0.05 || most.y > FILLED - 0.05, "{fov:?} {size:?}: {most}");
        }
    }

    /// For every shape of the water the horizon is below the upper edge by 15 % of the picture's height, and the
    /// camera looks down on the water so steeply that near walls hide little.
    #[test]
    fn the_horizon_is_in_the_picture() {
        let box_of = |size: [usize; 3]| -> Vec<[f32; 3]> {
            let [nx, ny, nz] = size;
            (0..nx * ny * nz)
                .map(|i| [i % nx, i / nx % ny, i / nx / ny].map(|n| 0.1 * n as f32))
                .collect()
        };
        for form in [[40, 3, 20], [20, 3, 40], [30, 4, 30], [12, 30, 12], [60, 12, 6]] {
            let positions = box_of(form);
            let bounds = Bounds::of_bulk(&positions).unwrap();
            let size = (1280, 720);
            let file = CameraFile::of_particles(&[&positions], &bounds, None, size);
            let eye = Vec3::from(file.eye.unwrap());
            let level = Vec3::new(bounds.center().x - eye.x, 0.0, bounds.center().z - eye.z);
            let horizon = shown(&file, size, eye + level);
            assert!((horizon.y + HORIZON).abs() < 0.01, "{form:?}: {horizon}");
            let foot = Vec3::new(bounds.center().x, bounds.min.y, bounds.center().z);
            let down = ((eye.y - foot.y) / level.length()).atan().to_degrees();
            assert!((13.0..=HIGHEST + 0.01).contains(&down), "{form:?}: {down} degrees down");
            assert!((0.1..FILLED).contains(&shown(&file, size, foot).y), "{form:?}");
        }
    }

    #[test]
    fn a_few_high_drops_do_not_push_the_camera_back() {
        let mut positions: Vec<[f32; 3]> = (0..4096)
            .map(|i| [(i % 16) as f32 * 0.1, (i / 16 % 16) as f32 * 0.05, (i / 256) as f32 * 0.1])
            .collect();
        let still = Bounds::of_bulk(&positions).unwrap();
        let seen = |file: &CameraFile| {
            let at = |p| shown(file, (1280, 720), p);
            (at(still.max).y - at(still.min).y).abs()
        };
        let alone = CameraFile::of_particles(&[&positions], &still, None, (1280, 720));
        // One in two hundred, spread over three times the height.
        positions.extend((0..20).map(|i| [0.8, 0.8 + 0.1 * i as f32, 0.8]));
        let bounds = Bounds::of_bulk(&positions).unwrap();
        let splash = CameraFile::of_particles(&[&positions], &bounds, None, (1280, 720));
        assert!(seen(&splash) > 0.7 * seen(&alone), "{} of {}", seen(&splash), seen(&alone));
    }

    /// One of sixteen frames has a splash, of a twentieth of that frame's particles, which is less than one in two
    /// hundred of the particles of all frames. The splash is in the picture, with room above it.
    #[test]
    fn a_moments_splash_is_in_the_picture() {
        let pool: Vec<[f32; 3]> = (0..4096)
            .map(|i| [(i % 16) as f32 * 0.1, (i / 16 % 16) as f32 * 0.03, (i / 256) as f32 * 0.1])
            .collect();
        let mut splash = pool.clone();
        let drops = 4096 / 20;
        splash.truncate(4096 - drops);
        splash.extend((0..drops).map(|i| [0.8, 0.5 + 1.5 * i as f32 / drops as f32, 0.8]));
        let mut frames = vec![&pool[..]; 15];
        frames.push(&splash);
        let bounds = frames.iter().filter_map(|f| Bounds::of_bulk(f)).reduce(|a, b| a.union(&b));
        let file = CameraFile::of_particles(&frames, &bounds.unwrap(), None, (1280, 720));
        let top = shown(&file, (1280, 720), Vec3::new(0.8, 2.0, 0.8)).y;
        assert!((-0.9..-0.5).contains(&top), "{top}");
    }

    #[test]
    fn lens_undoes_the_projection() {
        for far in [None, Some(100.0)] {
            let file = CameraFile {
                eye: Some([1.0, 2.0, 3.0]),
                target: Some([0.0; 3]),
                far,
                ..CameraFile::default()
            };
            let camera = file.camera((300, 200)).unwrap();
            let lens = Lens::new(&camera).unwrap();
            assert_eq!(lens.far, 0.0, "reversed");
            let clip =
                camera.projection_matrix() * camera.view_matrix() * Vec4::new(0.1, 0.2, 0.3, 1.0);
            let eye = -(camera.view_matrix() * Vec4::new(0.1, 0.2, 0.3, 1.0)).z;
            assert!((lens.eye_depth(clip.z / clip.w) - eye).abs() < 1e-4 * eye);
            assert_eq!(lens.eye_depth(0.0), whitewater::io::picture::EMPTY);
        }
    }

    #[test]
    fn depth_is_along_the_view() {
        let file = CameraFile {
            eye: Some([1.0, 2.0, 3.0]),
            target: Some([1.0, 2.0, -1.0]),
            ..CameraFile::default()
        };
        let right = file.camera((300, 200)).unwrap();
        // The same view, with depth along z.
        let view = Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0)) * right.view_matrix();
        let left = Camera::of(view, Mat4::perspective_lh(0.7, 1.5, 0.1, 100.0));
        for camera in [right, left] {
            assert_eq!(depth(&camera, [7.0, 5.0, -1.0]), Some(4.0));
            assert_eq!(depth(&camera, [1.0, 2.0, 5.0]), None, "behind the eye");
        }
    }

    fn moving() -> CameraFile {
        let text = r#"{"fov_y_degrees":50,"keys":[
            {"frame":10,"eye":[0,0,5],"target":[0,0,0]},
            {"frame":20,"eye":[1,0,5],"target":[0,1,0]},
            {"frame":50,"eye":[4,0,5],"target":[0,1,0],"fov_y_degrees":30}]}"#;
        CameraFile::parse(text, Path::new("c.json")).unwrap()
    }

    #[test]
    fn keys_are_met_and_what_is_between_is_smooth() {
        let camera = moving();
        let eye = |frame| Vec3::from(camera.at_frame(frame).eye.unwrap());
        for (frame, x) in [(0, 0.0), (10, 0.0), (20, 1.0), (50, 4.0), (70, 4.0)] {
            assert!((eye(frame).x - x).abs() < 1e-5, "{frame}: {}", eye(frame));
        }
        assert_eq!(camera.at_frame(20).fov_y_degrees, Some(50.0));
        assert_eq!(camera.at_frame(60).fov_y_degrees, Some(30.0));
        // The eye's path has no step and no kink, and the eye is at rest at both ends.
        let steps: Vec<f32> = (5..55).map(|f| eye(f + 1).x - eye(f).x).collect();
        assert!(steps.iter().all(|s| (-1e-6..0.2).contains(s)), "{steps:?}");
        assert!(steps.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.04), "{steps:?}");
        assert!(camera.check(0..100, (4, 4)).is_ok());
        // A camera with one key or none stands still.
        let one = CameraFile { keys: camera.keys[..1].to_vec(), ..CameraFile::default() };
        assert_eq!(one.at_frame(3), one.at_frame(30));
        assert_eq!(one.at_frame(3).eye, Some([0.0, 0.0, 5.0]));
    }

    #[test]
    fn a_turn_goes_once_round() {
        let still = CameraFile {
            eye: Some([3.0, 2.0, 4.0]),
            target: Some([1.0, 1.0, 1.0]),
            ..CameraFile::default()
        };
        let camera = still.clone().turned(Turn { first: 10, frames: 96.0 }).unwrap();
        let eye = |frame| Vec3::from(camera.at_frame(frame).eye.unwrap());
        let near = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1.0e-5, "{a} {b}");
        near(eye(10), Vec3::new(3.0, 2.0, 4.0));
        // A quarter of the orbit, counter-clockwise: from +z to +x.
        near(eye(34), Vec3::new(4.0, 2.0, -1.0));
        near(eye(58), Vec3::new(-1.0, 2.0, -2.0));
        near(eye(106), eye(10));
        near(eye(0), eye(96));
        let away = |f| eye(f).distance(Vec3::ONE);
        assert!((10..106).all(|f| (away(f) - away(10)).abs() < 1.0e-5));
        let steps = (10..106).map(|f| eye(f).distance(eye(f + 1)));
        let (least, most) = steps.fold((f32::MAX, 0.0_f32), |(a, b), d| (a.min(d), b.max(d)));
        assert!(most - least < 1.0e-4, "evenly: {least} to {most}");
        // The JSON holds the camera at its position in this frame.
        let shown = camera.at_frame(34);
        assert_eq!((shown.target, shown.turn), (still.target, None));
        let turn = Turn { first: 0, frames: 8.0 };
        assert!(moving().turned(turn).is_err() && CameraFile::default().turned(turn).is_err());
    }

    #[test]
    fn bad_keys_are_refused() {
        let bad = |change: fn(&mut CameraFile)| {
            let mut camera = moving();
            change(&mut camera);
            assert!(camera.check([10, 15, 20], (4, 4)).is_err(), "{camera:?}");
        };
        bad(|c| c.keys[1].frame = 10);
        bad(|c| c.eye = Some([0.0; 3]));
        bad(|c| c.keys[1].eye = [0.0, 1.0, 0.0]);
        bad(|c| c.keys[1].fov_y_degrees = Some(-80.0));
    }

    #[test]
    fn bad_cameras_are_refused() {
        let parse =
            |text| CameraFile::parse(text, Path::new("c.json")).and_then(|c| c.camera((4, 4)));
        for text in [
            "{}",
            "{\"eye\":[0,0,0]}",
            "{\"eye\":[0,0,0],\"target\":[0,0,0]}",
            "{\"eye\":[0,0,0],\"target\":[0,1,0]}",
            "{\"eye\":[0,0,0],\"target\":[0,0,1],\"fov\":3}",
            "{\"eye\":[0,0,0],\"target\":[0,0,1],\"near\":3,\"far\":1}",
            "[",
        ] {
            let failure = parse(text).unwrap_err();
            assert!(!failure.message.contains('\n'), "{}", failure.message);
        }
    }
}
