//! CPU twin of all ray-casters: every particle at every sample of every ray, in double precision, without cells, tiles
//! or bricks. It also bounds the error of single precision.

use glam::{DMat4, DVec2, DVec3, Mat4, Vec3};
use whitewater::Camera;
use whitewater_raycast::{ABEL, EMPTY, Foam, LEAST_REACH, PROFILES, SceneDepth, Settings};

/// Half a unit in the last place of single precision.
pub const U: f64 = 1.0 / (1 << 24) as f64;

/// A particle as a ray meets it.
pub struct Ball {
    pub centre: DVec3,
    pub radius: f64,
    /// Coefficients A, B, C of its thickness.
    pub profile: [f64; 3],
    /// Error bounds of single precision: absolute for the centre, relative for the profile.
    centre_error: DVec3,
    profile_error: f64,
}

/// All balls and settings of a picture.
pub struct Twin {
    pub size: [u32; 2],
    pub balls: Vec<Ball>,
    slope: [DVec2; 2],
    growth: f64,
    radius: f64,
    step: f64,
    samples: u32,
    shifted: bool,
    scene: SceneDepth,
}

/// A value with a bound on the GPU's error.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bound {
    pub value: f64,
    pub error: f64,
    /// Number of samples that lie in some particle.
    pub hits: u32,
    /// Number of particles that the ray meets.
    pub met: u32,
}

/// A camera at the origin that looks down −z.
pub fn camera(aspect: f32) -> Camera {
    let flip = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
    let lens = Mat4::perspective_infinite_reverse_rh(60_f32.to_radians(), aspect, 0.1);
    Camera::of(Mat4::IDENTITY, flip * lens)
}

impl Twin {
    pub fn new(
        foam: &Foam,
        radius: f32,
        size: [u32; 2],
        scene: &SceneDepth,
        settings: &Settings,
        samples: u32,
    ) -> Self {
        let camera = camera(size[0] as f32 / size[1] as f32);
        let view = DMat4::from_cols_array(&camera.view_matrix().to_cols_array().map(f64::from));
        let m = camera.projection_matrix().to_cols_array_2d();
        let p = DVec2::new(m[0][0].into(), m[1][1].into());
        let full = DVec2::new(size[0].into(), size[1].into());
        let slope = [2.0 / (full * p), -1.0 / p];
        let pixel = slope[0].abs();
        let radius = f64::from(radius);
        let growth = f64::from(LEAST_REACH) * pixel.max_element();
        let mut twin = Self {
            size,
            balls: Vec::new(),
            slope,
            growth,
            radius,
            step: settings.step.into(),
            samples,
            shifted: settings.shifted,
            scene: scene.clone(),
        };
        for i in 0..foam.positions.len() {
            let position = Vec3::from(foam.positions[i]).as_dvec3();
            let eye = view.transform_point3(position);
            let age = f64::from(foam.ages[i]);
            let drawn = eye.is_finite() && age < 1.0 && -eye.z > 0.1;
            if !drawn {
                continue;
            }
            let ball = twin.ball(DVec3::new(eye.x, eye.y, -eye.z), foam.kinds[i], age, foam.ids[i]);
            twin.balls.push(ball);
        }
        twin
    }

    fn ball(&self, centre: DVec3, kind: u32, age: f64, id: u32) -> Ball {
        let kind = if kind < 3 { kind as usize } else { 0 };
        let own_radius = self.radius / f64::from(id % 5 + 1) * [1.0, 1.0, 0.5][kind];
        let pixel = self.slope[0].abs() * centre.z;
        let own_reach = own_radius / pixel;
        let wider = (f64::from(LEAST_REACH) / own_reach.min_element()).max(1.0);
        let (radius, reach) = (own_radius * wider, own_reach * wider);
        let x = (reach.min_element() - 1.0).clamp(0.0, 1.0);
        let own = x * x * (3.0 - 2.0 * x);
        // pow is the exp2 of a product with a log2: 3 ulp and 2^-21 for large values, and a dozen roundings.
        let mut profile_error = 4.0e-6 + 24.0 * U;
        let mut even = 0.0;
        if own < 1.0 {
            let middle = (centre.truncate() / centre.z - self.slope[1]) / self.slope[0];
            // Rounding of coordinates up to twice the picture's size, and of the size itself.
            let error = 16.0 * U * (2.0 * middle.abs().max_element() + f64::from(self.size[0]));
            let (mut sum, mut sum_error) = (0.0, 0.0);
            let (first, last) = ((middle - reach - 0.5).ceil(), (middle + reach - 0.5).floor());
            for y in first.y as i64 - 1..=last.y as i64 + 1 {
                for x in first.x as i64 - 1..=last.x as i64 + 1 {
                    let place = (DVec2::new(x as f64, y as f64) + 0.5 - middle) / reach;
                    let q = 1.0 - place.length_squared();
                    sum += q.max(0.0);
                    if q > -0.01 {
                        sum_error += 2.0 * error / reach.min_element() * place.length() + 8.0 * U;
                    }
                }
            }
            let mean = [1.0 - 2.0 / 4.25, 1.0 - 2.0 / 3.5, 0.5][kind];
            even = (1.0 - own) * std::f64::consts::PI * own_reach.x * own_reach.y * mean / sum;
            // The weight `own` changes by up to 1.5 per pixel of reach.
            profile_error += sum_error / sum + 1.5 * 16.0 * U / (1.0 - own).max(1.0e-3);
        }
        let life = (1.0 - age.max(0.0).powi(2)).powf(0.4);
        let mut profile = PROFILES[kind].map(|v| life * own * v);
        profile[0] += life * even;
        let centre_error = 8.0 * U * DVec3::splat(centre.abs().max_element());
        Ball { centre, radius, profile, centre_error, profile_error }
    }

    /// Slope of the ray through a pixel.
    fn ray(&self, x: u32, y: u32) -> DVec2 {
        let pixel = DVec2::new(x.into(), y.into()) + 0.5;
        pixel * self.slope[0] + self.slope[1]
    }

    fn end(&self, x: u32, y: u32) -> f64 {
        match &self.scene {
            SceneDepth::Nothing => EMPTY.into(),
            SceneDepth::Depths(depths) => depths[(y * self.size[0] + x) as usize].into(),
        }
    }

    /// Depth at `u` radii from the eye, where a slab begins, with its error bound in single precision.
    fn depth(&self, u: f64) -> (f64, f64) {
        let grown = u * self.growth;
        let depth = match grown <= 1.0 {
            true => u * self.radius,
            false => self.radius / self.growth * (grown - 1.0).exp(),
        };
        // exp has an error of 3 + 2 |x| ulp, and its argument is a rounded product.
        (depth, depth * U * (16.0 + 16.0 * grown.max(1.0)))
    }

    fn place(&self, x: u32, y: u32) -> f64 {
        if !self.shifted {
            return 0.5;
        }
        const BAYER: [[u32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
        (f64::from(BAYER[(y & 3) as usize][(x & 3) as usize]) + 0.5) / 16.0
    }

    /// Sum over all samples of a ray, with its bound.
    pub fn thickness(&self, x: u32, y: u32) -> Bound {
        let (ray, end, place) = (self.ray(x, y), self.end(x, y), self.place(x, y));
        let slab = f64::from(self.samples) * self.step;
        let mut bound = Bound::default();
        for ball in &self.balls {
            let d = (ray * ball.centre.z - ball.centre.truncate()) / ball.radius;
            let slope_error = 4.0 * U * (self.slope[1].abs().max_element() * 3.0);
            let d_error = (slope_error * ball.centre.z
                + ray.abs().max_element() * ball.centre_error.z
                + 4.0 * U * ball.centre.abs().max_element()
                + ball.centre_error.x)
                / ball.radius
                + 8.0 * U * d.length();
            let l = d.length_squared();
            let l_error = 4.0 * d.length() * d_error + 2.0 * d_error * d_error;
            if l > 1.0 + l_error {
                continue;
            }
            bound.met += 1;
            // Begin one slab before the ball.
            let front = (ball.centre.z - ball.radius).max(0.0);
            let radii = |z: f64| match z * self.growth <= self.radius {
                true => z / self.radius,
                false => (1.0 + (z * self.growth / self.radius).ln()) / self.growth,
            };
            let first = ((radii(front) / slab).floor() as i64 - 1).max(0);
            let last = (radii(ball.centre.z + ball.radius) / slab).floor() as i64 + 1;
            for j in first..=last {
                let (near, near_error) = self.depth(j as f64 * slab);
                let (far, far_error) = self.depth((j + 1) as f64 * slab);
                let dz = (far - near) / f64::from(self.samples);
                let dz_error = (near_error + far_error) / f64::from(self.samples) + U * dz;
                // Samples in the ball, and a few around it.
                let [front, back] = [-1.0, 1.0].map(|side| {
                    (ball.centre.z + side * ball.radius - near) / dz - place + 3.0 * side
                });
                for k in front.max(0.0) as u32..(back.max(0.0) as u32).min(self.samples) {
                    let z = near + (f64::from(k) + place) * dz;
                    let z_error = near_error + far_error + 4.0 * U * z;
                    let t = (z - ball.centre.z) / ball.radius;
                    let t_error =
                        2.0 * (z_error + ball.centre_error.z) / ball.radius + 8.0 * U * t.abs();
                    let y = 1.0 - l - t * t;
                    let error = l_error + 2.0 * t.abs() * t_error + t_error * t_error + 4.0 * U;
                    if y < -error {
                        continue;
                    }
                    bound.hits += 1;
                    let (kernel, kernel_error) = kernel(ball, y, error);
                    let width = dz / ball.radius;
                    let width_error = dz_error / ball.radius + 8.0 * U * width;
                    let all = width * kernel_error + width_error * (kernel.abs() + kernel_error);
                    if z < end {
                        bound.value += width * kernel;
                    }
                    // `told` is false if rounding decides whether the sample lies before the scene.
                    let told = (z - end).abs() > z_error + 4.0 * U * end.min(1.0e3);
                    bound.error += if told { all } else { all + width * kernel.abs() };
                }
            }
        }
        // The sum may be formed in any order.
        bound.error += f64::from(bound.hits) * U * bound.value;
        bound
    }

    /// Integral of all kernels along the whole ray.
    pub fn integral(&self, x: u32, y: u32) -> f64 {
        let ray = self.ray(x, y);
        let profile = |ball: &Ball| {
            let d = (ray * ball.centre.z - ball.centre.truncate()) / ball.radius;
            let y = (1.0 - d.length_squared()).max(0.0);
            let [a, b, c] = ball.profile;
            y * (a + y * (b + y * c))
        };
        self.balls.iter().map(profile).sum()
    }

    pub fn pixels(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let [width, height] = self.size;
        (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
    }
}

/// Kernel at `y`, with its error if `y` has an error of `error`.
fn kernel(ball: &Ball, y: f64, error: f64) -> (f64, f64) {
    let [a, b, c] = [0, 1, 2].map(|i| ABEL[i] * ball.profile[i]);
    let most = a.abs() + b.abs() + c.abs();
    let (low, high) = ((y - error).max(0.0), (y + error).max(0.0));
    let y = y.max(0.0);
    let value = y.sqrt() * (a + y * (b + y * c));
    let moved =
        (high.sqrt() - low.sqrt()) * most + high.sqrt() * (b.abs() + 2.0 * c.abs()) * 2.0 * error;
    (value, moved + high.sqrt() * most * (ball.profile_error + 16.0 * U))
}
