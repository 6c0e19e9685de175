//! A jittered bed of particles, and cameras that look at the middle of its surface.

use ash::vk;
use glam::{Mat4, Vec3};
use whitewater::Camera;

/// Spacing of the particles.
pub const SPACING: f32 = 0.05;
/// Layers of the bed.
const LAYERS: i32 = 4;
/// Height of the visible surface over the centres of the top layer, in spacings.
const SURFACE: f32 = 0.5;

/// Arrangement of a bed's particles.
#[derive(Clone, Copy, Debug)]
pub struct Bed {
    /// Length of its sides, in spacings.
    pub side: f32,
    /// Largest displacement of a particle along each axis, in spacings.
    pub jitter: f32,
    /// Whether particles stand right above each other; otherwise every other layer is shifted by half a spacing. In an
    /// upright bed gaps between four particles extend downwards.
    pub upright: bool,
    /// Degrees between the lattice and the rows of the image; random if `None`.
    pub turn: Option<f32>,
}

impl Bed {
    /// The particles: a jittered lattice, randomly shifted and rotated against the pixels. Its surface is the plane z =
    /// 0, seen from +z.
    pub fn particles(&self, seed: u64) -> Vec<[f32; 3]> {
        let mut random = Random(seed);
        let half = (self.side / 2.0).ceil() as i32;
        let moved = 0.5 * Vec3::new(random.symmetric(), random.symmetric(), 0.0);
        let chance = 180.0 * random.symmetric();
        let turned = Mat4::from_rotation_z(self.turn.unwrap_or(chance).to_radians());
        let mut positions = Vec::new();
        for layer in 0..LAYERS {
            let stagger = if self.upright { 0.0 } else { 0.5 * (layer % 2) as f32 };
            for row in -half..=half {
                for column in -half..=half {
                    let place = Vec3::new(column as f32 + stagger, row as f32 + stagger, 0.0);
                    let jitter = Vec3::from_array([(); 3].map(|()| random.symmetric()));
                    let at = turned.transform_vector3(place + moved + self.jitter * jitter);
                    let down = Vec3::Z * (layer as f32 + SURFACE);
                    positions.push((SPACING * (at - down)).to_array());
                }
            }
        }
        positions
    }
}

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    /// Uniform in [−1, 1).
    fn symmetric(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 40) as f32) / (1 << 23) as f32 - 1.0
    }
}

/// A projection with a vertical field of view in degrees.
pub fn projection(field: f32, extent: vk::Extent2D) -> Mat4 {
    let aspect = extent.width as f32 / extent.height as f32;
    let lens = Mat4::perspective_infinite_reverse_rh(field.to_radians(), aspect, 0.01);
    // Row 0 on top.
    Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * lens
}

/// A camera at a distance from the middle of the surface, `slant` degrees off its normal.
pub fn camera(distance: f32, slant: f32, projection: Mat4) -> Camera {
    let (sin, cos) = slant.to_radians().sin_cos();
    let eye = distance * Vec3::new(0.0, -sin, cos);
    Camera::of(Mat4::look_at_rh(eye, Vec3::ZERO, Vec3::Y), projection)
}
