//! Pass `soap` ray by ray: light that films, walls and cores of blobs send to the eye where the environment is even or
//! grows evenly to one side and there is no sun, and what they leave of the light behind.

use glam::{DQuat, DVec2, DVec3};

use super::film::{Face, spectral};
use super::impostor::into_blob;
use super::wall::{Wall, between};
use crate::reference::{Image, smoothstep};

/// Thickness of the table's last row in nanometres.
const THICKEST: f64 = 2000.0;

/// Where less than this is left of the light behind, nothing more is looked at.
const LEAST: f64 = 1.0 / 256.0;

/// How blobs look, and the light they are in.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Nanometres.
    pub film: f64,
    pub drainage: f64,
    pub core: [f64; 2],
    pub albedo: DVec3,
    pub roundness: f64,
    pub reflection: f64,
    pub walls: bool,
    pub plug: bool,
    /// Of the environment in the mean.
    pub radiance: DVec3,
    /// Towards what it grows, and by how much of the mean; at most 1 long.
    pub side: DVec3,
}

impl Look {
    /// More light than any part of a blob sends.
    fn most(&self) -> DVec3 {
        self.radiance * (1.0 + self.side.length()) * self.reflection.max(1.0)
    }

    /// What comes from a direction of the world.
    fn light(&self, direction: DVec3) -> DVec3 {
        self.radiance * (1.0 + self.side.dot(direction))
    }

    /// What a white surface of a normal sends of it: a mean of directions by their cosines, which is two thirds of the
    /// normal long.
    fn diffuse(&self, normal: DVec3) -> DVec3 {
        self.radiance * (1.0 + self.side.dot(normal) * 2.0 / 3.0)
    }
}

/// A film's reflectance, linear between cosines and thicknesses; of each value how far the GPU's may be off it.
pub struct Table {
    values: Image<[DVec3; 2]>,
    /// What a filter knows of a position, in texels.
    step: f64,
}

impl Table {
    /// `off`: of a value, and of the sum of its weights' sizes.
    pub fn new(
        (width, height): (usize, usize),
        index: f64,
        bits: u32,
        off: impl Fn(f64, f64) -> f64 + Sync,
    ) -> Self {
        let values = Image::from_fn(width, height, |x, y| {
            let cosine = x as f64 / (width - 1) as f64;
            let thickness = THICKEST * y as f64 / (height - 1) as f64;
            let (share, sizes) = spectral(cosine, index, thickness, Face::Exact);
            let share = share.map(|share| share.clamp(0.0, 1.0));
            [DVec3::from(share), DVec3::from([0, 1, 2].map(|c| off(share[c], sizes[c])))]
        });
        Self { values, step: 1.0 / f64::from(1 << bits) }
    }

    /// What is sent back, and how far that may be off.
    pub fn at(&self, cosine: f64, thickness: f64) -> (DVec3, DVec3) {
        let last = DVec2::new((self.values.width - 1) as f64, (self.values.height - 1) as f64);
        let at = DVec2::new(cosine, thickness / THICKEST).clamp(DVec2::ZERO, DVec2::ONE) * last;
        let texels = self.values.bilinear(at + 0.5);
        let four = texels.map(|(x, y, _)| self.values.clamped(x, y));
        let mean: DVec3 = texels.iter().zip(&four).map(|((_, _, w), [v, _])| *w * *v).sum();
        let own = four.iter().fold(DVec3::ZERO, |most, [_, off]| most.max(*off));
        let change = |a: usize, b: usize| (four[a][0] - four[b][0]).abs();
        let across = change(0, 1).max(change(2, 3)) + change(0, 2).max(change(1, 3));
        (mean, own + self.step * across)
    }
}

/// Bubbles of one blob in its own space, and the walls of each.
pub struct Template {
    bubbles: Vec<(DVec3, f64)>,
    walls: Vec<Vec<(usize, Wall)>>,
}

impl Template {
    pub fn new(bubbles: &[[f32; 4]]) -> Self {
        let sphere = |b: &[f32; 4]| {
            let [x, y, z, r] = b.map(f64::from);
            (DVec3::new(x, y, z), r)
        };
        let bubbles: Vec<_> = bubbles.iter().map(sphere).collect();
        let beside = |i: usize| {
            let a = bubbles[i];
            let meets = |b: (DVec3, f64)| {
                let apart = a.0.distance(b.0);
                (a.1 - b.1).abs() < apart && apart < a.1 + b.1
            };
            let others = bubbles.iter().enumerate().filter(|(j, b)| i != *j && meets(**b));
            others
                .map(|(j, &b)| (j, if a.1 > b.1 { between(a, b) } else { between(b, a) }))
                .collect::<Vec<_>>()
        };
        let walls: Vec<_> = (0..bubbles.len()).map(beside).collect();
        let spheres = walls.iter().flatten().all(|(_, wall)| wall.radius.is_finite());
        assert!(spheres, "bubbles of one size have a plane between them, which is not known here");
        Self { bubbles, walls }
    }

    /// The least of its bubbles.
    pub fn least(&self) -> f64 {
        self.bubbles.iter().map(|b| b.1).fold(f64::INFINITY, f64::min)
    }

    /// The wall that a ray crosses on its way through a bubble: where, its normal, and whose the other side is.
    fn wall(&self, ray: Ray, bubble: usize, (from, to): (f64, f64)) -> Option<(f64, DVec3, usize)> {
        let crossed = self.walls[bubble].iter().filter_map(|(other, wall)| {
            let (center, radius) = self.bubbles[*other];
            let both = |t: &f64| from < *t && *t < to && ray.at(*t).distance(center) < radius;
            let at = ray.meets(wall.center, wall.radius)?.into_iter().find(both)?;
            Some((at, (ray.at(at) - wall.center) / wall.radius, *other))
        });
        crossed.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// A blob: its ball, its turn, and what it is made of.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    pub ball: [f32; 4],
    pub turn: [f32; 4],
    pub template: &'a Template,
}

/// A ray in a blob's space.
#[derive(Clone, Copy)]
struct Ray {
    origin: DVec3,
    direction: DVec3,
}

impl Ray {
    fn at(self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// Where it meets a sphere.
    fn meets(self, center: DVec3, radius: f64) -> Option<[f64; 2]> {
        let to = center - self.origin;
        let along = to.dot(self.direction);
        let left = radius * radius - (to - along * self.direction).length_squared();
        (left >= 0.0).then(|| [along - left.sqrt(), along + left.sqrt()])
    }

    /// The same; a sphere that it passes by rounding, it touches.
    fn touches(self, center: DVec3, radius: f64) -> [f64; 2] {
        let along = (center - self.origin).dot(self.direction);
        self.meets(center, radius).unwrap_or([along; 2])
    }
}

/// What a ray has gathered on its way.
struct Gathered {
    light: DVec3,
    /// What of the light from farther comes through.
    through: DVec3,
    /// How far that may be off, for what the films are.
    off: DVec3,
}

impl Gathered {
    /// A film and what it mirrors.
    fn film(&mut self, (share, off): (DVec3, DVec3), mirrored: DVec3) {
        self.light += self.through * share * mirrored;
        self.off += self.through * off;
        self.through *= 1.0 - share;
    }
}

/// One blob in a pixel.
struct Layer {
    gathered: Gathered,
    core: DVec3,
    wall: bool,
    /// Opacity of the core behind the bubble that is met first, and where the ray ends.
    told: f64,
    opaque: f64,
}

fn mix(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    a * (1.0 - t) + b * t
}

fn layer(
    look: &Look,
    films: &Table,
    blob: &Placed<'_>,
    (eye, along): (DVec3, DVec3),
    bubble: usize,
) -> Layer {
    let (origin, direction) = into_blob(blob.ball, blob.turn, eye, along);
    let ray = Ray { origin, direction };
    let turn = DQuat::from_array(blob.turn.map(f64::from)).normalize();
    let film = |normal: DVec3, high: f64| {
        let thickness = look.film * (1.0 - look.drainage * high);
        films.at(direction.dot(normal).abs(), thickness)
    };
    let high = |normal: DVec3| (turn * normal).y;
    let reflected = |normal: DVec3| direction - 2.0 * direction.dot(normal) * normal;
    let (mut middle, radius) = blob.template.bubbles[bubble];
    let [into, mut out] = ray.touches(middle, radius);
    let first = ray.at(into);
    let front = (first - middle) / radius;
    let round = first.normalize();

    let opacity = |t: f64| 1.0 - smoothstep(look.core[0], look.core[1], ray.at(t).length());
    let crease = 0.72 + 0.28 * smoothstep(0.6, 1.0, ray.at(out).length());
    let facing = (front * (1.0 - look.roundness) + round * look.roundness).normalize();
    let core = look.albedo * look.diffuse(turn * facing) * crease;
    // What is not open to the environment is foam, as bright as this.
    let mirrored = |normal: DVec3, open: f64| {
        look.reflection * mix(core, look.light(turn * reflected(normal)), open)
    };

    let mut gathered = Gathered { light: DVec3::ZERO, through: DVec3::ONE, off: DVec3::ZERO };
    let open = smoothstep(-0.35, 0.45, reflected(front).dot(round));
    gathered.film(film(front, high(front)), mirrored(front, open));

    let told = opacity(out);
    let wall = look.walls.then(|| blob.template.wall(ray, bubble, (into, out))).flatten();
    if let Some((_, normal, other)) = wall {
        gathered.film(film(normal, 0.0), mirrored(normal, 0.4));
        let (center, radius) = blob.template.bubbles[other];
        let [_, leaves] = ray.touches(center, radius);
        if leaves > out {
            (middle, out) = (center, leaves);
        }
    }

    let last = ray.at(out);
    let opaque = opacity(out);
    gathered.light += gathered.through * opaque * core;
    gathered.through *= 1.0 - opaque;

    let back = (last - middle).normalize();
    gathered.film(film(back, high(back)), mirrored(back, 0.5));
    Layer { gathered, core, wall: wall.is_some(), told, opaque }
}

/// What a pixel shows.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Premultiplied, and how much it covers.
    pub color: [f64; 4],
    /// How far that may be off, for what the table is and for where a ray may end.
    pub off: [f64; 4],
    /// Layers that were looked at, and of how many a wall was crossed.
    pub layers: usize,
    pub walls: usize,
    /// What was plugged.
    pub plugged: f64,
}

/// A pixel's blobs and the bubbles of them that are met first, front to back, and the most opacity of all that are there.
pub fn pixel(
    look: &Look,
    films: &Table,
    blobs: &[Placed<'_>],
    ray: (DVec3, DVec3),
    met: &[(usize, usize)],
    most: f64,
) -> Pixel {
    let (mut color, mut left) = (DVec3::ZERO, DVec3::ONE);
    let (mut off, mut unsure) = (DVec3::ZERO, 0.0);
    let mut body = None;
    let (mut layers, mut walls) = (0, 0);
    let (mut all_told, mut held, mut behind) = (0.0_f64, 0.0_f64, 1.0);
    for &(blob, bubble) in met {
        let Layer { gathered, core, wall, told, opaque } =
            layer(look, films, &blobs[blob], ray, bubble);
        (all_told, held) = (all_told.max(told), held.max(opaque));
        behind *= 1.0 - told;
        color += left * gathered.light;
        off += left * gathered.off;
        left *= gathered.through;
        body = Some(body.map_or(core, |body: DVec3| (body + core) / 2.0));
        (layers, walls) = (layers + 1, walls + usize::from(wall));
        // Rounding may end it here or not.
        if (left.max_element() - LEAST).abs() <= off.max_element() + 1e-6 {
            unsure = 1.0;
        }
        if left.max_element() <= LEAST {
            break;
        }
    }
    let covered = 1.0 - left.element_sum() / 3.0;
    // What is drawn is as opaque as it turned out; else it is a blob farther off. Half precision tells no more.
    let most = if most > all_told + 1.0 / 1024.0 && behind >= LEAST { most } else { held };
    let extra = if look.plug { (most - covered).max(0.0) } else { 0.0 };
    color += extra * body.unwrap_or(DVec3::ZERO);
    let alpha = (covered + extra).min(1.0);
    let dim = off.element_sum() / 3.0;
    let ended = unsure * (LEAST + extra);
    let off = (off + dim + ended) * look.most();
    Pixel {
        color: color.extend(alpha).to_array(),
        off: off.extend(dim + ended).to_array(),
        layers,
        walls,
        plugged: extra,
    }
}
