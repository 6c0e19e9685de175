//! What stands behind the water where no scene is given: a tiled ground to the horizon, and boxes and upright
//! cylinders, ray traced on the CPU.

use std::f32::consts::PI;
use std::path::Path;

use glam::{Quat, Vec3};
use serde::Deserialize;
use whitewater::Camera;

use crate::bounds::Bounds;
use crate::camera::{CameraFile, Lens};
use crate::environment::Environment;
use crate::failure::{Failure, Outcome};

/// A scene of simple solids; the fields of its JSON that only a solver needs are passed over.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Backdrop {
    #[serde(default)]
    boxes: Vec<BoxSolid>,
    #[serde(default)]
    cylinders: Vec<Cylinder>,
    ground: Option<Ground>,
    /// Suggested.
    pub camera: Option<CameraFile>,
    /// What the particles are.
    pub fluid: Option<Fluid>,
}

#[derive(Clone, Debug, Deserialize)]
pub struct Fluid {
    pub spacing: f32,
}

#[derive(Clone, Debug, Deserialize)]
struct BoxSolid {
    centre: Vec3,
    half: Vec3,
    #[serde(default)]
    rotation: Quat,
    #[serde(default)]
    material: String,
}

#[derive(Clone, Debug, Deserialize)]
struct Cylinder {
    centre: Vec3,
    radius: f32,
    height: f32,
    #[serde(default)]
    material: String,
}

#[derive(Clone, Debug, Deserialize)]
struct Ground {
    y: f32,
    #[serde(default)]
    material: String,
    /// Edge of its tiles; 0: none.
    #[serde(default)]
    tile: f32,
}

struct Hit<'a> {
    /// In units of the ray's direction.
    t: f32,
    normal: Vec3,
    material: &'a str,
    /// Where on the solid, in its own frame.
    local: Vec3,
}

/// Colour and device depth of every pixel.
pub type Images = (Vec<[f32; 4]>, Vec<f32>);

impl Backdrop {
    /// From JSON: `boxes`, `cylinders`, `ground`, `camera`, `fluid`.
    pub fn parse(text: &str) -> Result<Self, String> {
        serde_json::from_str(text)
            .map_err(|e| format!("expected a scene of boxes and cylinders, found {e}"))
    }

    /// From a file.
    pub fn read(path: &Path) -> Outcome<Self> {
        let text = std::fs::read_to_string(path).map_err(|e| Failure::reading(path, &e))?;
        Self::parse(&text)
            .map_err(|why| Failure::input(format!("{}: {why}; mend the file", path.display())))
    }

    /// A tiled ground under the bulk of the water.
    pub fn under(bounds: &Bounds, spacing: f32) -> Self {
        let size = bounds.size().max_element().max(spacing);
        // Tiles of a size that people lay: 1, 2 or 5 by a power of ten, about ten along the water.
        let rough = size / 10.0;
        let power = 10.0_f32.powf(rough.log10().floor());
        let tile = [1.0, 2.0, 5.0, 10.0]
            .map(|n| n * power)
            .into_iter()
            .find(|t| *t >= 0.75 * rough)
            .unwrap_or(rough);
        let ground = Ground { y: bounds.min.y - 0.5 * spacing, material: "tiles".into(), tile };
        Self { ground: Some(ground), ..Self::default() }
    }

    /// Draws it.
    pub fn draw(
        &self,
        camera: &Camera,
        size: (u32, u32),
        environment: &Environment,
    ) -> Outcome<Images> {
        let lens = Lens::new(camera)?;
        let (width, height) = (size.0 as usize, size.1 as usize);
        let mut color = vec![[0.0; 4]; width * height];
        let mut depth = vec![lens.far; width * height];
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let rows = height.div_ceil(4 * threads).max(1);
        let world = lens.view.inverse();
        let eye = world.w_axis.truncate();
        let slope = lens.slope(size, 1.0);
        let ray = |x: f32, y: f32| {
            world.transform_vector3(Vec3::new(
                slope[0] * x + slope[2],
                slope[1] * y + slope[3],
                -1.0,
            ))
        };
        let jobs = std::sync::Mutex::new(
            color.chunks_mut(rows * width).zip(depth.chunks_mut(rows * width)).enumerate(),
        );
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    loop {
                        let job =
                            jobs.lock().unwrap_or_else(std::sync::PoisonError::into_inner).next();
                        let Some((band, (color, depth))) = job else { break };
                        for (i, (color, depth)) in color.iter_mut().zip(depth).enumerate() {
                            let (x, y) = ((i % width) as f32, (band * rows + i / width) as f32);
                            if let Some(hit) = self.hit(eye, ray(x + 0.5, y + 0.5)) {
                                *depth = lens.device_depth(hit.t);
                            }
                            let mut sum = Vec3::ZERO;
                            for (dx, dy) in
                                [(0.375, 0.125), (0.875, 0.375), (0.625, 0.875), (0.125, 0.625)]
                            {
                                let d = ray(x + dx, y + dy);
                                sum += self.radiance(eye, d, slope[1].abs(), environment);
                            }
                            *color = (0.25 * sum).extend(1.0).to_array();
                        }
                    }
                });
            }
        });
        Ok((color, depth))
    }

    fn radiance(&self, eye: Vec3, d: Vec3, pixel: f32, environment: &Environment) -> Vec3 {
        let Some(hit) = self.hit(eye, d) else {
            return environment.panorama.sample(d.normalize());
        };
        let at = eye + d * hit.t;
        let facing = hit.normal.dot(d.normalize()).abs().max(0.02);
        let albedo = self.albedo(&hit, hit.t * pixel / facing);
        let sun = environment.sun;
        let mut light =
            environment.sky_irradiance * (0.5 + 0.5 * hit.normal.y) * self.openness(at, hit.normal);
        // What the ground throws back.
        light += 0.2
            * (environment.sky_irradiance + environment.sun_irradiance * sun.y.max(0.0))
            * (0.5 - 0.5 * hit.normal.y);
        let cosine = hit.normal.dot(sun);
        let lift = 1.0e-4 * hit.t.max(1.0e-3);
        if cosine > 0.0 && self.hit(at + hit.normal * lift, sun).is_none() {
            light += environment.sun_irradiance * cosine;
        }
        let surface = albedo * light / PI;
        // The far ground goes over into the sky.
        let Some(ground) = &self.ground else { return surface };
        let reach = 30.0 * (eye.y - ground.y).abs().max(1.0e-6);
        let away = hit.t * d.length() / reach;
        let haze = 1.0 - (-away * away).exp();
        let flat = Vec3::new(d.x, 0.0, d.z).normalize_or(Vec3::X);
        surface.lerp(environment.panorama.sample(flat), haze)
    }

    /// Share of the sky that a point sees past the solids, by a few rays.
    fn openness(&self, at: Vec3, normal: Vec3) -> f32 {
        if self.boxes.is_empty() && self.cylinders.is_empty() {
            return 1.0;
        }
        let side = normal.any_orthonormal_vector();
        let other = normal.cross(side);
        let mut open = 0.0;
        for i in 0..8 {
            let turn = i as f32 * PI / 4.0;
            let d = normal + 0.9 * (side * turn.cos() + other * turn.sin());
            open += f32::from(self.solid(at + normal * 1.0e-3, d).is_none());
        }
        open / 8.0
    }

    fn hit(&self, origin: Vec3, d: Vec3) -> Option<Hit<'_>> {
        let mut nearest = self.solid(origin, d);
        if let Some(ground) = &self.ground {
            let t = (ground.y - origin.y) / d.y;
            let far = 400.0 * (origin.y - ground.y).abs().max(1.0e-6);
            if t > 0.0 && t * d.length() < far && nearest.as_ref().is_none_or(|h| t < h.t) {
                let local = origin + d * t;
                nearest = Some(Hit { t, normal: Vec3::Y, material: &ground.material, local });
            }
        }
        nearest
    }

    fn solid(&self, origin: Vec3, d: Vec3) -> Option<Hit<'_>> {
        let boxes = self.boxes.iter().filter_map(|b| b.hit(origin, d));
        let cylinders = self.cylinders.iter().filter_map(|c| c.hit(origin, d));
        boxes.chain(cylinders).min_by(|a, b| a.t.total_cmp(&b.t))
    }

    fn albedo(&self, hit: &Hit<'_>, footprint: f32) -> Vec3 {
        let p = hit.local;
        // Fades out where a pixel is wider than the grain.
        let grain = |scale: Vec3| {
            let wide = footprint * scale.max_element();
            1.0 + (noise(p * scale) - 0.5) * 0.3 * (1.0 - wide).clamp(0.0, 1.0)
        };
        match hit.material {
            "tiles" => {
                let tile = self.ground.as_ref().map_or(1.0, |g| g.tile.max(1.0e-6));
                let (u, v, wide) = (p.x / tile, p.z / tile, footprint / tile);
                let grout = 1.0 - (1.0 - line(u, wide)) * (1.0 - line(v, wide));
                let each = hash(u.floor() as i64, v.floor() as i64, 0) - 0.5;
                let each = 1.0 + 0.14 * each * (1.0 - wide).clamp(0.0, 1.0);
                (Vec3::new(0.2, 0.19, 0.175) * each).lerp(Vec3::new(0.1, 0.095, 0.09), grout)
            }
            "timber" => Vec3::new(0.24, 0.15, 0.085) * grain(Vec3::new(3.0, 60.0, 60.0)),
            "steel" => Vec3::splat(0.2),
            "stone" => Vec3::new(0.2, 0.185, 0.17) * grain(Vec3::splat(25.0)),
            "ground" => Vec3::new(0.19, 0.175, 0.13) * grain(Vec3::splat(7.0)),
            _ => Vec3::new(0.29, 0.285, 0.27) * grain(Vec3::splat(14.0)),
        }
    }
}

impl BoxSolid {
    fn hit(&self, origin: Vec3, d: Vec3) -> Option<Hit<'_>> {
        let back = self.rotation.inverse();
        let (o, d) = (back * (origin - self.centre), back * d);
        let (a, b) = ((-self.half - o) / d, (self.half - o) / d);
        let (near, far) = (a.min(b), a.max(b));
        let t = near.max_element();
        if !(t > 0.0 && t <= far.min_element()) {
            return None;
        }
        let axis = [Vec3::X, Vec3::Y, Vec3::Z][near.max_position()];
        let normal = self.rotation * (axis * -d.dot(axis).signum());
        Some(Hit { t, normal, material: &self.material, local: o + d * t })
    }
}

impl Cylinder {
    fn hit(&self, origin: Vec3, d: Vec3) -> Option<Hit<'_>> {
        let o = origin - self.centre;
        let half = 0.5 * self.height;
        let make = |t: f32, normal| {
            (t > 0.0).then(|| Hit { t, normal, material: &self.material, local: o + d * t })
        };
        let a = d.x * d.x + d.z * d.z;
        let b = o.x * d.x + o.z * d.z;
        let c = o.x * o.x + o.z * o.z - self.radius * self.radius;
        let root = b * b - a * c;
        if root >= 0.0 && a > 0.0 {
            let t = (-b - root.sqrt()) / a;
            let p = o + d * t;
            if p.y.abs() <= half {
                return make(t, Vec3::new(p.x, 0.0, p.z) / self.radius);
            }
        }
        let t = (half * -d.y.signum() - o.y) / d.y;
        let p = o + d * t;
        let inside = p.x * p.x + p.z * p.z <= self.radius * self.radius;
        if inside { make(t, Vec3::Y * -d.y.signum()) } else { None }
    }
}

/// Share of lines at whole numbers in a window.
fn line(x: f32, wide: f32) -> f32 {
    const WIDTH: f32 = 0.03;
    let wide = wide.max(1.0e-3);
    let integral = |x: f32| x.floor() * WIDTH + (x - x.floor()).min(WIDTH);
    let x = x + 0.5 * WIDTH;
    (integral(x + 0.5 * wide) - integral(x - 0.5 * wide)) / wide
}

fn hash(x: i64, y: i64, z: i64) -> f32 {
    let mut h = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)
        ^ (z as u64).wrapping_mul(0x1656_67b1_9e37_79f9);
    h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((h >> 40) as f32) / ((1_u64 << 24) as f32)
}

/// Value noise of two octaves, 0 to 1.
fn noise(p: Vec3) -> f32 {
    let octave = |p: Vec3| {
        let (base, f) = (p.floor(), p - p.floor());
        let f = f * f * (3.0 - 2.0 * f);
        let at =
            |x: i64, y: i64, z: i64| hash(base.x as i64 + x, base.y as i64 + y, base.z as i64 + z);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let row = |y, z| mix(at(0, y, z), at(1, y, z), f.x);
        mix(mix(row(0, 0), row(1, 0), f.y), mix(row(0, 1), row(1, 1), f.y), f.z)
    };
    0.65 * octave(p) + 0.35 * octave(2.3 * p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_meet_solids_where_they_are() {
        let text = r#"{"boxes":[{"centre":[0,0,0],"half":[1,2,3],"rotation":[0,0,0,1]}],
            "cylinders":[{"centre":[5,0,0],"radius":1,"height":2}],"ground":{"y":-4},"name":"x"}"#;
        let scene: Backdrop = serde_json::from_str(text).unwrap();
        let hit = |origin: [f32; 3], d: [f32; 3]| {
            scene.hit(origin.into(), d.into()).map(|h| (h.t, h.normal.to_array()))
        };
        assert_eq!(hit([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]), Some((2.0, [-1.0, 0.0, 0.0])));
        assert_eq!(hit([0.0, 8.0, 0.0], [0.0, -2.0, 0.0]), Some((3.0, [0.0, 1.0, 0.0])));
        assert_eq!(hit([9.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), Some((3.0, [1.0, 0.0, 0.0])));
        assert_eq!(hit([5.0, 3.0, 0.0], [0.0, -1.0, 0.0]), Some((2.0, [0.0, 1.0, 0.0])));
        assert_eq!(hit([9.0, 3.0, 0.0], [0.0, -1.0, 0.0]), Some((7.0, [0.0, 1.0, 0.0])));
        assert_eq!(hit([0.0, 9.0, 0.0], [0.0, 1.0, 0.0]), None);
    }
}
