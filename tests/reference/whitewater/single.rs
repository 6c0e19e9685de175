//! Foam in single precision on the CPU, with each operation rounded, to check the bounds.

use super::super::{Image, View, is_surface};
use super::{
    Attenuation, Candidate, Kind, Layers, Occlusion, Omega, Particle, Reach, Seen, Settings, foam,
    foam_bounds, occlusion, points,
};
use crate::reference::EMPTY;
use crate::reference::tests::view;
use crate::support::scenes::Random;
use glam::{DVec2, DVec3, Mat4, Vec2, Vec3, Vec4Swizzles};

/// The frontmost particle in a pixel: index, depth, search radius and normal.
type Nearest = Option<(usize, f32, f32, Vec3)>;

fn shape(kind: Kind, x: f32) -> f32 {
    match kind {
        Kind::Foam => 1.0 - x.powf(2.25),
        Kind::Spray => 1.0 - x.powf(1.5),
        Kind::Bubble => x * x,
    }
}

fn step(x: f32) -> f32 {
    let t = x.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The definition in single precision, with sums in fixed-point steps. `clip`: centres are
/// projected through clip space.
fn single(
    particles: &[Particle],
    view: &View,
    settings: &Settings,
    (scene, fluid): (&Image<f64>, &Image<f64>),
    clip: bool,
) -> (Image<Nearest>, Image<[u64; 3]>) {
    let mut front = Image::new(view.width, view.height, None);
    let mut sums = Image::new(view.width, view.height, [0; 3]);
    let (to_eye, projection) = (view.view.as_mat4(), view.projection.as_mat4());
    let (focal, shift) = (view.focal().as_vec2(), view.shift().as_vec2());
    let extent = view.extent().as_vec2();
    let pixel = 2.0 / (extent * focal.abs());
    let spacing = settings.spacing as f32;
    for (index, particle) in particles.iter().enumerate() {
        let age = particle.age as f32;
        let whole = particle.radius.unwrap_or(settings.radius) as f32;
        let kind = particle.kind;
        let part = if kind == Kind::Bubble { 0.5 } else { 1.0 };
        let r = part * whole / (particle.id % 5 + 1) as f32;
        let c = to_eye.transform_point3(particle.position.as_vec3());
        let d = -c.z;
        if !age.is_finite() || age >= 1.0 || d <= view.near() as f32 {
            continue;
        }
        let at = if clip {
            let clip = projection * c.extend(1.0);
            (clip.xy() / clip.w + 1.0) * 0.5 * extent
        } else {
            (c.truncate() / d * focal - shift + 1.0) * (0.5 * extent)
        };
        let own = r / (d * pixel);
        let half = own * (0.75 / own.min_element()).max(1.0);
        let told = step(half.min_element() - 1.0);
        let square = |x: i64, y: i64| {
            ((Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - at) / half).length_squared()
        };
        let (low, high) = ((at - half).floor(), (at + half).ceil());
        let (columns, rows) = (low.x as i64..=high.x as i64, low.y as i64..=high.y as i64);
        let all = || rows.clone().flat_map(|y| columns.clone().map(move |x| (x, y)));
        let weights: f32 = all().map(|(x, y)| (1.0 - square(x, y)).max(0.0)).sum();
        let mean = kind.mean() as f32;
        let even = std::f32::consts::PI * own.x * own.y * mean / weights;
        let life = if age > 0.0 { (1.0 - age * age).powf(0.4) } else { 1.0 };
        let inside = |x: i64, y: i64| {
            (0..view.width as i64).contains(&x) && (0..view.height as i64).contains(&y)
        };
        for (x, y) in all().filter(|(x, y)| inside(*x, *y)) {
            let square = square(x, y);
            let (x, y) = (x as usize, y as usize);
            if square >= 1.0 {
                continue;
            }
            let w = (1.0 - square).sqrt();
            let depth = d - w * r;
            if depth >= scene.at(x, y) as f32 {
                continue;
            }
            let nearest: &mut Nearest = front.at_mut(x, y);
            if nearest.is_none_or(|(_, there, _, _)| depth < there) {
                let uv = (Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - at) / half;
                let normal = (uv * focal.signum()).extend(w);
                let normal = to_eye.inverse().transform_vector3(normal);
                *nearest = Some((index, depth, r * focal.y.abs() / d, normal));
            }
            let amount =
                life * ((1.0 - told) * even * (1.0 - square) + told * shape(kind, square.sqrt()));
            let fluid = fluid.at(x, y) as f32;
            let behind = depth - fluid;
            let shares = match settings.attenuation {
                _ if fluid >= 1e10 => [1.0, 0.0, 0.0],
                Attenuation::Water => {
                    let (below, y) = (step(behind / spacing), behind.max(0.0));
                    [1.0 - below, below, below * (y / (y + spacing))]
                }
                Attenuation::Falloff { max, n, m } => {
                    let x = (behind / max as f32).clamp(0.0, 1.0);
                    [(1.0 - x.powf(n as f32)).powf(m as f32), 0.0, 0.0]
                }
            };
            for (sum, share) in sums.at_mut(x, y).iter_mut().zip(shares) {
                *sum += (amount * share * 65536.0 + 0.5) as u64;
            }
        }
    }
    (front, sums)
}

/// A rotated view whose matrix is exact in single precision.
fn turned(base: &View, by: f32, eye: Vec3) -> View {
    let turn = Mat4::from_rotation_y(by) * Mat4::from_rotation_x(0.6 * by);
    View { view: (turn * Mat4::from_translation(eye)).as_dmat4(), ..*base }
}

/// Particles over a range of depths, from specks to a width of ten pixels.
fn particles(view: &View, random: &mut Random, count: usize) -> Vec<Particle> {
    let back = view.view.inverse();
    let mut between = |low: f32, high: f32| f64::from(random.between(low, high));
    (0..count)
        .map(|i| {
            let d = between(0.05, 12.0);
            let at = DVec3::new(between(-1.2, 1.2) * d, between(-1.0, 1.0) * d, -d);
            let size = between(0.0, 1.0);
            Particle {
                position: back.transform_point3(at).as_vec3().as_dvec3(),
                kind: Kind::of(i as u32 % 4),
                radius: (i % 7 != 0).then_some(f64::from((0.3 * size * size + 1e-3) as f32)),
                age: [0.0, between(-0.2, 1.05), f64::from(0.999_999_f32), 0.25][i % 4],
                id: i as u32,
            }
        })
        .collect()
}

#[test]
fn single_precision_stays_in_the_bounds() {
    let mut random = Random(11);
    let (mut pixels, mut alone, mut widths) = (0, 0, Vec::new());
    for (i, eye) in [0.0_f32, 2.0, 40.0, 1.0].into_iter().enumerate() {
        let focal = [DVec2::new(0.9, -1.2), DVec2::new(-1.1, 1.6)][i % 2];
        let base = view(focal, DVec2::new(0.2, -0.1), 41, 30);
        let view = turned(&base, 0.7 * i as f32, eye * Vec3::new(1.0, -0.7, 0.3));
        let scene =
            Image::from_fn(41, 30, |x, y| if (x / 9 + y / 5) % 2 == 0 { 7.0 } else { EMPTY });
        let fluid = Image::from_fn(41, 30, |x, _| if x < 28 { 4.0 } else { EMPTY });
        let new = Settings::new(0.5);
        let attenuation = match i {
            0..=2 => Attenuation::Water,
            _ => Attenuation::Falloff { max: 3.0, n: 2.0, m: 4.0 },
        };
        let settings = Settings { radius: f64::from(new.radius as f32), attenuation, ..new };
        let particles = particles(&view, &mut random, 600);
        let twin = foam(&particles, &view, &settings, &scene, &fluid);
        let bounds = foam_bounds(&particles, &view, &settings, &scene, &fluid);
        let (front, sums) = single(&particles, &view, &settings, (&scene, &fluid), i % 2 == 1);
        for (x, y) in (0..30).flat_map(|y| (0..41).map(move |x| (x, y))) {
            for k in 0..3 {
                let (low, high) = (bounds.sums[k].low.at(x, y), bounds.sums[k].high.at(x, y));
                let value = sums.at(x, y)[k] as f64 / 65536.0;
                assert!(low <= value && value <= high, "sum {k}: {low} {value} {high}");
                let slack = f64::from(bounds.count.at(x, y)) / 131_072.0;
                let value = twin.sums.at(x, y)[k];
                assert!(low - slack <= value && value <= high + slack, "{low} {value} {high}");
                if low > 0.0 {
                    widths.push((high - low) / (high + low));
                }
            }
            let (low, high) = (bounds.depth.low.at(x, y), bounds.depth.high.at(x, y));
            let candidates = bounds.candidates.at(x, y);
            let found = twin.front.at(x, y).map(|seen| (seen.depth, seen.h, seen.normal));
            let of_single = front
                .at(x, y)
                .map(|(_, depth, h, normal)| (f64::from(depth), f64::from(h), normal.as_dvec3()));
            for found in [found, of_single] {
                let Some((depth, h, normal)) = found else {
                    assert!(!is_surface(high), "{high}");
                    continue;
                };
                assert!(low <= depth && depth <= high, "{low} {depth} {high}");
                let is = candidates.iter().any(|one: &Candidate| {
                    (one.depth.v - depth).abs() <= one.depth.e
                        && (one.h.v - h).abs() <= one.h.e
                        && (one.normal.v - normal).length() <= one.normal.e
                });
                assert!(is, "{depth} {h} {normal} {candidates:?}");
            }
            if let Some((index, ..)) = front.at(x, y) {
                assert!(candidates.iter().any(|one| one.particle == index));
                pixels += 1;
                alone += usize::from(candidates.len() == 1);
            }
        }
    }
    widths.sort_by(f64::total_cmp);
    let n = widths.len();
    assert!(alone * 100 > pixels * 98 && pixels > 2000, "{alone} of {pixels}");
    assert!(n > 3000 && widths[n / 2] < 1e-3, "{n} sums, {}", widths[n / 2]);
}

/// Occluded fraction in single precision.
fn single_omega(
    layers: &Layers<'_>,
    view: &View,
    settings: &Occlusion,
    points: &[DVec3],
    (x, y): (usize, usize),
) -> Option<f32> {
    let seen = layers.front.at(x, y)?;
    let (depth, focal, shift) = (seen.depth as f32, view.focal().as_vec2(), view.shift().as_vec2());
    let extent = view.extent().as_vec2();
    let ndc = 2.0 * Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / extent - 1.0;
    let at = ((ndc + shift) / focal).extend(-1.0) * depth;
    let (mut hidden, mut counted) = (0.0_f32, 0.0_f32);
    for pass in 1..=settings.passes {
        let [first, more] = settings.radii.map(|r| r as f32);
        let h = seen.h as f32 * (first + more * pass as f32);
        let h_px = 0.5 * h * extent.y;
        let radius = h * depth / focal.y.abs();
        let wanted = 4.0 / 3.0 * std::f32::consts::PI * h_px.powi(3) * settings.density as f32;
        let count =
            (wanted.clamp(settings.counts[0] as f32, settings.counts[1] as f32) + 0.5) as usize;
        for s in &points[..count] {
            let s = s.as_vec3();
            let place = at + radius * s;
            let d = -place.z;
            let pixel = (place.truncate() / d * focal - shift + 1.0) * 0.5 * extent;
            let pixel = pixel.floor();
            if d <= view.near() as f32 || pixel.cmplt(Vec2::ZERO).any() || pixel.cmpge(extent).any()
            {
                continue;
            }
            let (x, y) = (pixel.x as usize, pixel.y as usize);
            let reach = match settings.reach {
                Reach::Radii(radii) => radii as f32 * radius,
                Reach::Scene(reach) => reach as f32,
            };
            let part = |depth: f32, opacity: f32| match d > depth {
                true => (1.0 - (d - depth) / reach).max(0.0).powi(2) * opacity,
                false => 0.0,
            };
            let foam = layers
                .front
                .at(x, y)
                .map_or(0.0, |seen| part(seen.depth as f32, layers.opacity.at(x, y) as f32));
            let [fluid, solid] = settings.opacities.map(|a| a as f32);
            let all = foam
                + part(layers.fluid.at(x, y) as f32, fluid)
                + part(layers.solid.at(x, y) as f32, solid);
            let lambda = (1.0 - s.length()).powi(2);
            hidden += lambda * all.min(1.0);
            counted += lambda;
        }
    }
    Some(if counted > 0.0 { hidden / counted } else { 0.0 })
}

#[test]
fn occlusion_in_single_precision_stays_in_the_bounds() {
    let mut random = Random(5);
    let points = points(513);
    let mut widths = Vec::new();
    for reach in [Reach::Radii(1.0), Reach::Scene(5.0)] {
        let view = view(DVec2::new(0.9, -1.2), DVec2::new(0.2, -0.1), 41, 30);
        let mut number = |low, high| f64::from(random.between(low, high));
        let mut front = Image::new(41, 30, None);
        for pixel in &mut front.data {
            let seen = Seen { depth: number(2.0, 4.0), h: number(0.001, 0.04), normal: DVec3::Z };
            *pixel = (number(0.0, 1.0) < 0.8).then_some(seen);
        }
        let mut image = |part: f64, low: f32, high: f32| {
            let mut image = Image::new(41, 30, EMPTY);
            for pixel in &mut image.data {
                if number(0.0, 1.0) < part {
                    *pixel = number(low, high);
                }
            }
            image
        };
        let opacity = image(1.0, 0.0, 1.0);
        let (fluid, solid) = (image(0.5, 2.0, 4.0), image(0.3, 2.0, 4.0));
        let layers = Layers { front: &front, opacity: &opacity, fluid: &fluid, solid: &solid };
        let settings = Occlusion { reach, ..Occlusion::default() };
        let twin: Image<Option<Omega>> = occlusion(&layers, &view, &settings);
        for (x, y) in (0..30).flat_map(|y| (0..41).map(move |x| (x, y))) {
            let single = single_omega(&layers, &view, &settings, &points, (x, y)).map(f64::from);
            let (Some(omega), Some(single)) = (twin.at(x, y), single) else {
                assert!(twin.at(x, y).is_none() && single.is_none());
                continue;
            };
            for value in [omega.value, single] {
                assert!(omega.low <= value && value <= omega.high, "{value} {omega:?}");
            }
            widths.push(omega.high - omega.low);
        }
    }
    widths.sort_by(f64::total_cmp);
    let n = widths.len();
    assert!(n > 1900 && widths[n / 2] < 1e-3, "{n} pixels, {}", widths[n / 2]);
}
