//! Cameras of every convention, and particles that are the same in every run.

use ash::vk;
use glam::{DMat4, DVec4, Mat4, Vec3, vec3};
use whitewater::{Camera, Settings};

use crate::reference::View;

/// A kind of projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lens {
    Standard,
    Reversed,
    Infinite,
    ReversedInfinite,
    OffAxis,
    Mirrored,
    LeftHanded,
}

/// All lenses.
pub const LENSES: [Lens; 7] = [
    Lens::Standard,
    Lens::Reversed,
    Lens::Infinite,
    Lens::ReversedInfinite,
    Lens::OffAxis,
    Lens::Mirrored,
    Lens::LeftHanded,
];

/// Eye depth of the near plane of every lens.
pub const NEAR: f32 = 0.1;
/// Eye depth of the far plane, for lenses with one.
pub const FAR: f32 = 100.0;

fn extent_f(extent: vk::Extent2D) -> (f32, f32) {
    (extent.width as f32, extent.height as f32)
}

/// Projection of a lens with a field of view of 60 degrees and square pixels.
pub fn projection(lens: Lens, extent: vk::Extent2D) -> Mat4 {
    let (width, height) = extent_f(extent);
    let (fov, aspect) = (60.0_f32.to_radians(), width / height);
    // Row 0 is the top of the image.
    let down = Mat4::from_scale(vec3(1.0, -1.0, 1.0));
    down * match lens {
        Lens::Standard => Mat4::perspective_rh(fov, aspect, NEAR, FAR),
        Lens::Reversed => Mat4::perspective_rh(fov, aspect, FAR, NEAR),
        Lens::Infinite => Mat4::perspective_infinite_rh(fov, aspect, NEAR),
        Lens::ReversedInfinite => Mat4::perspective_infinite_reverse_rh(fov, aspect, NEAR),
        Lens::OffAxis => {
            let mut p = Mat4::perspective_infinite_reverse_rh(fov, aspect, NEAR);
            p.z_axis.x = 0.45;
            p.z_axis.y = -0.3;
            p
        }
        Lens::Mirrored => {
            Mat4::from_scale(vec3(-1.0, -1.0, 1.0)) * Mat4::perspective_rh(fov, aspect, NEAR, FAR)
        }
        Lens::LeftHanded => Mat4::perspective_lh(fov, aspect, NEAR, FAR),
    }
}

/// A camera that looks along world (0.6, -0.2, -0.8) from (1, 2, 3).
pub fn camera(lens: Lens, extent: vk::Extent2D) -> Camera {
    let eye = vec3(1.0, 2.0, 3.0);
    let forward = vec3(0.6, -0.2, -0.8).normalize();
    let view = match lens {
        Lens::LeftHanded => Mat4::look_to_lh(eye, forward, Vec3::Y),
        _ => Mat4::look_to_rh(eye, forward, Vec3::Y),
    };
    Camera::of(view, projection(lens, extent))
}

/// The camera as a view of the twins, which look along -z.
pub fn twin(camera: &Camera, extent: vk::Extent2D) -> View {
    let (mut view, mut projection) =
        (camera.view_matrix().as_dmat4(), camera.projection_matrix().as_dmat4());
    if projection.z_axis.w > 0.0 {
        let mirror = DMat4::from_diagonal(DVec4::new(1.0, 1.0, -1.0, 1.0));
        view = mirror * view;
        projection *= mirror;
    }
    View::new(view, projection, extent.width as usize, extent.height as usize)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Transforms eye-space points (x, y, depth) to world space.
pub fn world(camera: &Camera, points: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let forward = if camera.projection_matrix().z_axis.w > 0.0 { 1.0 } else { -1.0 };
    let back = camera.view_matrix().as_dmat4().inverse();
    points
        .iter()
        .map(|p| {
            let eye = glam::DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(forward * p[2]));
            back.transform_point3(eye).as_vec3().to_array()
        })
        .collect()
}

/// Pseudo-random numbers (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number in low..high.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * ((self.bits() >> 40) as f32 / (1u64 << 24) as f32)
    }

    /// A permutation of 0..n.
    pub fn order(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, (self.bits() % (i as u64 + 1)) as usize);
        }
        order
    }
}

/// Points in the view: (x, y, depth) with depths in a range; some lie beyond the view's edges.
pub fn cloud(seed: u64, count: usize, near: f32, far: f32) -> Vec<[f32; 3]> {
    let mut random = Random(seed);
    (0..count)
        .map(|_| {
            let d = random.between(near, far);
            [random.between(-1.0, 1.0) * d, random.between(-0.7, 0.7) * d, d]
        })
        .collect()
}

/// A block of particles on a jittered lattice, as in a fluid: eye-space (x, y, depth).
pub fn block(seed: u64, spacing: f32, size: [usize; 3], corner: [f32; 3]) -> Vec<[f32; 3]> {
    let mut random = Random(seed);
    let mut points = Vec::new();
    for z in 0..size[2] {
        for y in 0..size[1] {
            for x in 0..size[0] {
                let mut at = |i: usize, corner: f32| {
                    corner + spacing * (i as f32 + random.between(-0.25, 0.25))
                };
                points.push([at(x, corner[0]), at(y, corner[1]), at(z, corner[2])]);
            }
        }
    }
    points
}

/// Settings for a drawn radius. The light is such that all colours are near 1.
pub fn settings(radius: f32) -> Settings {
    let mut settings = Settings::default();
    settings.water.spacing = radius / 0.656;
    settings.light.color = [4.0, 3.8, 3.4];
    settings.light.ambient = [0.35, 0.45, 0.6];
    settings.light.irradiance = [3.6, 3.5, 3.4];
    settings.light.shade = [0.6, 0.8, 1.1];
    settings
}
