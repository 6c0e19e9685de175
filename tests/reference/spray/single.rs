//! Spray in single precision on the CPU, with each operation rounded, to check the bounds.

use super::super::surface_foam::noise;
use super::super::tests::view;
use super::tests::{settings, shaped};
use super::*;
use crate::reference::EMPTY;
use crate::support::scenes::Random;
use glam::{Mat3, Mat4, Vec2, Vec3};

/// Covariance in space of a ball with half-axis h, transformed by a matrix, plus half a streak.
fn covariance(map: &Mat3, h: f32, streak: Vec3) -> Mat3 {
    let scaled = h * *map;
    let outer = Mat3::from_cols(streak * streak.x, streak * streak.y, streak * streak.z);
    scaled * scaled.transpose() + outer
}

/// The definition in single precision, with every operation rounded and the sum in half
/// precision.
fn single(
    particle: &Particle,
    view: &View,
    settings: &Settings,
    (scene, water): (&Image<f64>, &Image<f64>),
) -> Image<half::f16> {
    let mut sum = Image::new(view.width, view.height, half::f16::ZERO);
    let to_eye = view.view.as_mat4();
    let (s, n, near) = (settings.spacing as f32, settings.droplets, view.near() as f32);
    let step = |low: f32, high: f32, x: f32| {
        let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let (spread, rest) = (settings.spread as f32 * s, settings.rest_density as f32);
    let [all, none] = settings.densities.map(|d| d as f32 * rest);
    let scale = view.slope_step().as_vec2();
    let first = ((view.shift() - 1.0) / view.focal()).as_vec2();
    let share = 1.0 - step(all, none.max(all * 1.000001 + 1e-6), particle.density as f32);
    let c = to_eye.transform_point3(particle.position.as_vec3());
    let v = to_eye.transform_vector3(particle.velocity.as_vec3());
    if share <= 0.0 || -c.z <= near.max(spread) {
        return sum;
    }
    let torn = if n > 1 { (4.0 - 4.0 * share).clamp(0.3, 1.0) } else { 1.0 };
    let shape = particle.shape.as_mat3();
    let squares: f32 = shape.to_cols_array().into_iter().map(|x| x * x).sum();
    for k in 0..n {
        let random = |j| classify::random(SEED, j, particle.id);
        let u = [0, 1, 2, 3, 4].map(|j| random(5 * k + j));
        let way = |a: f32, b: f32| {
            let (level, turn) = (2.0 * a - 1.0, std::f32::consts::TAU * b);
            let ring = (1.0 - level * level).max(0.0).sqrt();
            Vec3::new(ring * turn.cos(), ring * turn.sin(), level)
        };
        let mut far = spread * u[2].powf(1.0 / 3.0) * way(u[0], u[1]);
        if n > 1 {
            let axis = way(random(4096), random(4097));
            let wide = (1.0 + 5.0 * random(4098)) / 6.0;
            let thin = wide * (0.4 * far + 0.6 * far.dot(axis) * axis);
            far = thin.lerp(0.7 / squares.sqrt() * (shape * far), step(3.0, 3.6, squares));
            if k as f32 >= 0.5 + torn * (0.2 + 0.8 * random(4099)) * n as f32 {
                continue;
            }
        }
        let p =
            c + to_eye.transform_vector3(far) + (2.0 * u[4] - 1.0) * settings.stretch as f32 * v;
        let normal = p / p.length();
        let m = v - v.dot(normal) * normal;
        let speed = m.length();
        let side = if normal.y.abs() < 0.9 { Vec3::Y } else { Vec3::X };
        let e1 = if speed > (1e-6 * s).max(1e-3 * v.length()) { m } else { side.cross(normal) };
        // For motion straight at the eye, e1 is a random direction.
        let e2 = (e1 / e1.length()).cross(normal);
        let e2 = if e2.length() > 1e-3 { e2 } else { side.cross(normal).cross(normal) };
        let e2 = e2 / e2.length();
        let mut e1 = normal.cross(e2);
        let many = if n > 1 { 0.6 * 0.513 * n as f32 } else { 1.0 };
        let [least, range] = SIZES.map(|size| size as f32);
        let g = if n > 1 { (least + range * u[3].powi(6)) / torn.sqrt() } else { 1.0 };
        let mist = n > 1 && k == 0;
        let h = g * settings.size as f32 * 0.656 * s / many.sqrt();
        let h = if n > 1 { h.min(settings.max_angle as f32 * -p.z) } else { h };
        let [taken, wide] = settings.mist.map(|v| v as f32);
        let (h, taken) = if mist { (wide * s, taken) } else { (h, settings.opacity as f32) };
        let pixel = -p.z * scale.abs().max_element();
        let (mut a, mut b) = (h + 0.5 * speed * settings.shutter as f32, h);
        if mist {
            let c = covariance(
                &(Mat3::from_mat4(to_eye) * shape),
                h,
                0.5 * settings.shutter as f32 * m,
            );
            let plane =
                [side.cross(normal).normalize(), normal.cross(side.cross(normal)).normalize()];
            let of = |i: usize, j: usize| plane[i].dot(c * plane[j]);
            let (xx, xy, yy) = (of(0, 0), of(0, 1), of(1, 1));
            let (middle, apart) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
            if apart > 1e-3 * middle {
                // The longer column of C minus its smaller eigenvalue.
                let least = middle - apart;
                let (first, second) = (Vec2::new(xx - least, xy), Vec2::new(xy, yy - least));
                let long = if xx > yy { first } else { second }.normalize();
                e1 = plane[0] * long.x + plane[1] * long.y;
            }
            (a, b) = ((middle + apart).sqrt(), (middle - apart).max(0.0).sqrt());
        }
        let e2 = e1.cross(normal);
        let (a, b) = (a.max(0.7 * pixel), b.max(0.7 * pixel));
        let crowd = step(1.0, 6.0, particle.crowd as f32);
        let misty = if mist { torn * torn * torn * crowd } else { 1.0 };
        let amount = share * misty * -(1.0 - taken).ln() * h * h / (a * b);
        let back = to_eye.inverse();
        let centre = back.transform_point3(c);
        let drift = back.transform_vector3(v);
        let clumps = |at: Vec3, octaves: u32, pixel: f32| {
            if settings.clumps == 0.0 || n == 1 {
                return 1.0;
            }
            let wide = 3.0 * s;
            let on = if drift == Vec3::ZERO { drift } else { drift / drift.length() };
            let far = back.transform_point3(at) - centre;
            let mut sum = 0.0_f32;
            for phase in settings.pattern.phases() {
                let begun = centre / wide - drift * phase.carried as f32 / wide;
                let block = 8.0 * ((begun / 8.0).floor() + 0.5);
                let off = begun - block + far / wide;
                let way = drift.length() * settings.stretch as f32;
                let rim = 0.25 * (begun - block).abs().max_element();
                let mut longer = 1.0 + (4.0 * way / wide).min(3.0) * (1.0 - step(0.8, 1.0, rim));
                let mut finer = 1.0_f32;
                let mut amplitude = settings.clumps as f32;
                for _ in 0..octaves {
                    let told = step(1.0, 2.0, wide / finer / pixel);
                    let height = amplitude * phase.part as f32 * told;
                    let round = off + off.dot(on) * (1.0 / longer - 1.0) * on;
                    let at = finer * (round + block + phase.began as f32);
                    let noise = noise(at.as_dvec3()) as f32;
                    sum += height * (noise - height * (0.5 * 0.073 - 1.0e-4 * height * height));
                    finer *= 2.03;
                    amplitude = (1.4 * amplitude).min(4.0);
                    longer = 1.0 + 0.75 * (longer - 1.0);
                }
            }
            sum.min(8.0).exp()
        };
        let density = if mist { 1.0 } else { clumps(p, 3, pixel) };
        let fade = ((density - random(12288 + k)) / 0.2 + 0.5).clamp(0.0, 1.0);
        let clumpy = settings.clumps > 0.0 && n > 1 && !mist;
        let amount = if clumpy { amount * density.max(1.0) * fade } else { amount };
        if -p.z <= (2.0 * (a + pixel)).max(near) {
            continue;
        }
        for (x, y) in (0..view.height).flat_map(|y| (0..view.width).map(move |x| (x, y))) {
            let w = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) * scale + first;
            let w = w.extend(-1.0);
            let t = normal.dot(p) / normal.dot(w);
            let at = w * t - p;
            let q = Vec2::new(at.dot(e1) / a, at.dot(e2) / b).length_squared();
            let hidden = f64::from(t) >= scene.at(x, y) && scene.at(x, y) > 0.0;
            if normal.dot(w).abs() < 1e-6 || t < near || q > 1.0 || hidden {
                continue;
            }
            let radii = 1.5 * (0.656 * s) / pixel + 0.5;
            let water = body(water, (x, y), (radii as isize).clamp(1, 64)) as f32;
            let before = 1.0 - step(0.0, 1.5 * s, t - water);
            let pixel = t * scale.abs().max_element();
            let dense = if mist { clumps(w * t, 7, pixel) } else { 1.0 };
            let value = before * amount * dense * (1.0 - q).max(0.0).sqrt() * (-2.0 * q).exp();
            let pixel = sum.at_mut(x, y);
            *pixel = half::f16::from_f32(pixel.to_f32() + value);
        }
    }
    sum
}

#[test]
fn single_precision_stays_in_the_bounds() {
    let full = view(DVec2::new(0.9, -1.2), DVec2::new(0.2, -0.1), 37, 26);
    let turned = Mat4::from_rotation_y(0.7) * Mat4::from_rotation_x(0.4);
    let scene = Image::from_fn(37, 26, |x, y| if (x / 9 + y / 5) % 2 == 0 { 7.0 } else { EMPTY });
    let water = Image::from_fn(37, 26, |x, _| if x < 12 { 5.0 } else { EMPTY });
    // Without clumps, and with them.
    let (mut sure, mut seen, mut widths) = (0, 0, [Vec::new(), Vec::new()]);
    for (eye, droplets, size, shutter) in [
        (2.0, 1, 2.0, 0.02),
        (50.0, 16, 4.0, 0.02),
        (0.0, 5, 0.5, 0.2),
        (1.0, 64, 8.0, 0.0),
        (2.0, 17, 4.0, 0.02),
    ] {
        let eye = Mat4::from_translation(eye * Vec3::new(1.0, -0.7, 0.3));
        let view = View { view: (turned * eye).as_dmat4(), ..full };
        let back = view.view.inverse();
        let spread = f64::from(0.7_f32) * f64::from(u8::from(droplets > 1));
        let stretch = f64::from(0.02_f32);
        let [opacity, size, shutter] = [0.9_f32, size, shutter].map(f64::from);
        let [all, none] = [0.6_f32, 0.85].map(f64::from);
        let densities = [all, none];
        let settings = Settings {
            droplets,
            size,
            spread,
            stretch,
            opacity,
            shutter,
            densities,
            clumps: f64::from(u8::from(droplets == 17)),
            max_angle: f64::from([1.0, 0.05_f32][usize::from(droplets == 16)]),
            ..settings()
        };
        let mut r = Random(u64::from(droplets));
        let mut random = |low: f32, high: f32| f64::from(r.between(low, high));
        for i in 0..80 {
            let d = random(0.1, 12.0);
            let at = DVec3::new(random(-1.0, 1.0) * d, random(-1.0, 1.0) * d, -d);
            let any = 20.0 * DVec3::new(random(-1.0, 1.0), random(-1.0, 1.0), random(-1.0, 1.0));
            // Any motion, none, hardly any, or straight at the eye.
            let v = [any, DVec3::ZERO, 1e-7 * any, at][i % 5 % 4];
            let held = |v: DVec3| v.as_vec3().as_dvec3();
            let about = DVec3::new(random(-1.0, 1.0), random(-1.0, 1.0), 0.3);
            let shape = match i % 3 {
                0 => BALL,
                1 => shaped([2.0, 2.0, 0.25], about, random(0.0, 3.0)),
                _ => shaped([3.0, 0.6, 1.0 / 1.8], about, random(0.0, 3.0)),
            };
            let particle = Particle {
                shape,
                crowd: [CROWDED, random(0.0, 8.0)][i % 2],
                position: held(back.transform_point3(at)),
                velocity: held(back.transform_vector3(v)),
                density: random(400.0, 900.0),
                id: i as u32,
            };
            let twin = spray(&[particle], &view, &settings, &scene, &water);
            let single = single(&particle, &view, &settings, (&scene, &water));
            for (i, n) in twin.count.data.iter().enumerate() {
                let (low, high) = (twin.bounds.low.data[i], twin.bounds.high.data[i]);
                for value in [twin.depth.data[i], single.data[i].to_f64()] {
                    assert!(low <= value && value <= high, "{low} {value} {high}, {n} times");
                }
                seen += usize::from(single.data[i].to_f32() > 0.0);
                if low > 0.0 {
                    sure += 1;
                    widths[usize::from(droplets == 17)]
                        .push((high - low) / (high + low) / f64::from(*n));
                }
            }
        }
    }
    widths.iter_mut().for_each(|all| all.sort_by(f64::total_cmp));
    let [even, clumpy] = widths.map(|all| all[all.len() / 2]);
    assert!(sure > 4000 && seen < sure + sure / 10, "{sure} of {seen} pixels are sure");
    assert!(even < 2e-3 && clumpy < 2e-2, "{even} {clumpy}");
}
