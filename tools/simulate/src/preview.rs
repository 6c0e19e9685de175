//! A simple picture of a frame, for judging a simulation: particles as shaded spheres between the solids, which sphere
//! tracing finds (Hart 1996).

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use glam::{Mat3, Vec3};
use rayon::prelude::*;

use crate::bgeo::Frame;
use crate::scene::{Scene, Solid};

/// Viewpoint. A field of view of zero means a parallel projection `width` metres wide.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Position of the camera.
    pub eye: Vec3,
    /// Point that it looks at.
    pub target: Vec3,
    /// The vertical field of view, degrees.
    pub fov: f32,
    /// The width of a parallel projection, metres.
    pub width: f32,
}

const WIDTH: usize = 1280;
const HEIGHT: usize = 800;

struct View {
    eye: Vec3,
    axes: Mat3,
    /// Pixels per metre: at unit depth, or at every depth in a parallel projection.
    scale: f32,
    parallel: bool,
}

impl View {
    fn new(camera: Camera) -> Self {
        let back = (camera.eye - camera.target).normalize();
        let up = if back.y.abs() > 0.99 { Vec3::NEG_Z } else { Vec3::Y };
        let right = up.cross(back).normalize();
        let parallel = camera.fov == 0.0;
        Self {
            eye: camera.eye,
            axes: Mat3::from_cols(right, back.cross(right), -back),
            scale: if parallel {
                WIDTH as f32 / camera.width
            } else {
                0.5 * HEIGHT as f32 / (0.5 * camera.fov.to_radians()).tan()
            },
            parallel,
        }
    }

    /// The ray through a pixel: origin, and direction scaled to unit depth.
    fn ray(&self, x: usize, y: usize) -> (Vec3, Vec3) {
        let u = (x as f32 + 0.5 - 0.5 * WIDTH as f32) / self.scale;
        let v = (0.5 * HEIGHT as f32 - y as f32 - 0.5) / self.scale;
        if self.parallel {
            (self.eye + self.axes * Vec3::new(u, v, 0.0), self.axes.z_axis)
        } else {
            (self.eye, self.axes * Vec3::new(u, v, 1.0))
        }
    }
}

fn colour(base: Vec3, normal: Vec3) -> [u8; 3] {
    let light = Vec3::new(0.35, 0.85, 0.40).normalize();
    let lit = base * (0.45 + 0.55 * (0.5 + 0.5 * normal.dot(light)));
    (lit.clamp(Vec3::ZERO, Vec3::ONE) * 255.0).to_array().map(|c| c as u8)
}

fn material(name: &str) -> Vec3 {
    match name {
        "timber" => Vec3::new(0.62, 0.48, 0.34),
        "steel" => Vec3::new(0.40, 0.42, 0.45),
        "bamboo" => Vec3::new(0.55, 0.60, 0.28),
        "stone" => Vec3::new(0.50, 0.46, 0.42),
        _ => Vec3::new(0.78, 0.77, 0.74),
    }
}

/// The solids (and the ground) along a ray: depth and colour.
fn trace(scene: &Scene, solids: &[Solid], origin: Vec3, direction: Vec3) -> (f32, [u8; 3]) {
    let length = direction.length();
    let mut depth = 0.1;
    for _ in 0..160 {
        let at = origin + direction * depth;
        let ground = (at.y - scene.ground, Vec3::Y, Vec3::new(0.55, 0.60, 0.50));
        let (d, normal, base) = solids.iter().fold(ground, |nearest, solid| {
            let (d, normal) = solid.distance(at);
            if d < nearest.0 { (d, normal, material(solid.material)) } else { nearest }
        });
        if d < 1e-3 {
            return (depth, colour(base, normal));
        }
        // Near a slanted cut the distance is only a bound, so shorten the step.
        depth += 0.9 * d / length;
        if depth > 40.0 {
            break;
        }
    }
    (f32::MAX, [214, 226, 238])
}

/// Draws a frame, with its moving solids turned by `turn`. Slow particles are blue, fast ones white.
///
/// # Errors
/// The picture cannot be written.
pub fn draw(
    scene: &Scene,
    turn: f32,
    frame: &Frame,
    spacing: f32,
    camera: Camera,
    path: &Path,
) -> io::Result<()> {
    let view = View::new(camera);
    let solids = scene.posed(turn);
    let mut pixels: Vec<(f32, [u8; 3])> = (0..WIDTH * HEIGHT)
        .into_par_iter()
        .map(|i| {
            let (origin, direction) = view.ray(i % WIDTH, i / WIDTH);
            trace(scene, &solids, origin, direction)
        })
        .collect();
    let turn = view.axes.transpose();
    for (at, velocity) in frame.positions.iter().zip(&frame.velocities) {
        let local = turn * (*at - view.eye);
        if local.z < 0.1 {
            continue;
        }
        let scale = if view.parallel { view.scale } else { view.scale / local.z };
        let radius = 0.5 * spacing * scale;
        let x = 0.5 * WIDTH as f32 + local.x * scale;
        let y = 0.5 * HEIGHT as f32 - local.y * scale;
        let fast = (velocity.length() / 4.0).min(1.0);
        let base = Vec3::new(0.10, 0.35, 0.70).lerp(Vec3::new(0.95, 0.98, 1.0), fast);
        let range = |centre: f32, end: usize| {
            let low = (centre - radius).floor().clamp(0.0, end as f32) as usize;
            low..(centre + radius).ceil().clamp(0.0, end as f32) as usize
        };
        for py in range(y, HEIGHT) {
            for px in range(x, WIDTH) {
                let u = (px as f32 + 0.5 - x) / radius;
                let v = (y - py as f32 - 0.5) / radius;
                let square = u * u + v * v;
                if square < 1.0 {
                    let front = (1.0 - square).sqrt();
                    let depth = local.z - front * 0.5 * spacing;
                    let pixel = &mut pixels[py * WIDTH + px];
                    if depth < pixel.0 {
                        *pixel = (depth, colour(base, view.axes * Vec3::new(u, v, -front)));
                    }
                }
            }
        }
    }
    let mut encoder =
        png::Encoder::new(BufWriter::new(File::create(path)?), WIDTH as u32, HEIGHT as u32);
    encoder.set_color(png::ColorType::Rgb);
    let bytes: Vec<u8> = pixels.iter().flat_map(|pixel| pixel.1).collect();
    let mut writer = encoder.write_header().map_err(io::Error::other)?;
    writer.write_image_data(&bytes).map_err(io::Error::other)
}
