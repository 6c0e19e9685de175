//! Twin of pass `soap`, ray by ray: light from films, walls and cores of blobs towards the eye, in
//! an environment that is uniform or has a gradient to one side, and of the sun, and the light that
//! they transmit from behind. In water the layers are composited from back to front.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3};

use super::core::Picture;
use super::film::{Face, spectral};
use super::impostor::into_blob;
use super::wall::{Wall, between};
use crate::reference::classify::pcg;
use crate::reference::surface_foam::{noise, noise_rounding, noise_slope};
use crate::reference::{Image, smoothstep};
use crate::support::tolerance::U;

/// Thinnest and thickest film in nanometres, as in the table's first and last rows.
const THINNEST: f64 = 1.0;
const THICKEST: f64 = 2000.0;

/// Where less than this fraction of the light behind is left, no further layers are evaluated.
const LEAST: f64 = 1.0 / 256.0;

/// Settings of the blobs, and their light.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Mean thickness in nanometres.
    pub film: f64,
    pub variation: f64,
    pub drainage: f64,
    pub core: [f64; 2],
    pub albedo: DVec3,
    pub pattern: f64,
    pub distortion: f64,
    pub roundness: f64,
    pub reflection: f64,
    pub walls: bool,
    pub plug: bool,
    /// Mean radiance of the environment.
    pub radiance: DVec3,
    /// Gradient of the radiance relative to the mean; at most 1 long.
    pub side: DVec3,
    pub sun: Sun,
}

/// The sun, as much of it as shines.
#[derive(Clone, Copy, Debug)]
pub struct Sun {
    /// Direction to it.
    pub to: DVec3,
    /// Irradiance of a surface that faces it.
    pub irradiance: DVec3,
    /// Radiance of its mirror image, and the exponent by which that fades aside.
    pub glint: DVec3,
    pub shininess: f64,
}

impl Look {
    /// Upper bound of the radiance of any part of a blob.
    fn most(&self) -> DVec3 {
        // A seam of the pattern is at most this much brighter than the rest.
        let seams = 1.0 + 0.8 * self.pattern;
        let sun = self.sun.glint + self.sun.irradiance / PI;
        (self.radiance * (1.0 + self.side.length()) + sun) * self.reflection.max(1.0) * seams
    }

    /// Thickness of a film: it varies by the bubble's number and by position, and is thinner on top
    /// (Sec. 3.1). Returns also its error.
    fn thickness(&self, number: u32, place: DVec3, high: f64) -> (f64, f64) {
        let part = |n: u32| f64::from(pcg(n) >> 8) / f64::from(1 << 24);
        let place = place + 64.0 * part(number.wrapping_add(1));
        let varied = 0.7 * (2.0 * part(number) - 1.0) + 0.6 * noise(place);
        let drained = 1.0 - self.drainage * high;
        // A position is the result of a few sums and products of numbers of that size.
        let moved = noise_rounding() + 3.0 * noise_slope() * 8.0 * U * place.abs().max_element();
        let off = self.film * drained.abs() * (self.variation * 0.6 * moved + 8.0 * U);
        (self.film * (1.0 + self.variation * varied) * drained, off)
    }

    /// Radiance from a direction in world space.
    fn light(&self, direction: DVec3) -> DVec3 {
        let sun = self.sun.glint * direction.dot(self.sun.to).max(0.0).powf(self.sun.shininess);
        self.radiance * (1.0 + self.side.dot(direction)) + sun
    }

    /// Light reflected by a white diffuse surface: the cosine-weighted mean of directions is two
    /// thirds of the normal. Foam scatters light, so that the sun reaches a little around it.
    fn whitewater(&self, normal: DVec3) -> DVec3 {
        let sun = self.sun.irradiance / PI * ((normal.dot(self.sun.to) + 0.4) / 1.4).max(0.0);
        self.radiance * (1.0 + self.side.dot(normal) * 2.0 / 3.0) + sun
    }
}

/// A film's reflectance, interpolated between cosines and thicknesses, and the GPU's max error of
/// each value.
pub struct Table {
    values: Image<[DVec3; 2]>,
    /// Error of a filter's position, in texels.
    step: f64,
}

impl Table {
    /// `off`: error of a value, by the value and the sum of its terms' absolute values.
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

    /// Reflectance of a film with this uncertainty of its thickness, and its error.
    pub fn at(&self, cosine: f64, (thickness, unsure): (f64, f64)) -> (DVec3, DVec3) {
        let last = DVec2::new((self.values.width - 1) as f64, (self.values.height - 1) as f64);
        let thickness = thickness.clamp(THINNEST, THICKEST);
        let at = DVec2::new(cosine.clamp(0.0, 1.0), thickness / THICKEST) * last;
        let texels = self.values.bilinear(at + 0.5);
        let four = texels.map(|(x, y, _)| self.values.clamped(x, y));
        let mean: DVec3 = texels.iter().zip(&four).map(|((_, _, w), [v, _])| *w * *v).sum();
        let own = four.iter().fold(DVec3::ZERO, |most, [_, off]| most.max(*off));
        let change = |a: usize, b: usize| (four[a][0] - four[b][0]).abs();
        let down = change(0, 2).max(change(1, 3));
        let across = change(0, 1).max(change(2, 3)) + down;
        (mean, own + self.step * across + down * unsure / THICKEST * last.y)
    }
}

/// What water transmits, and the light that it emits or scatters itself.
#[derive(Clone, Copy, Debug)]
pub enum Medium {
    /// Extinction per scene unit, as exp(-x), and the light from a great thickness.
    Physical { extinction: DVec3, own: DVec3 },
    /// The source's: colour of thin water; falloffs of the colour and of what is behind (thesis,
    /// Eq. 3.5 to 3.7).
    Source { base: DVec3, falloff: [f64; 4] },
}

impl Medium {
    /// Transmittance and own light of water of this length.
    pub fn of(&self, metres: f64) -> (DVec3, DVec3) {
        match *self {
            Self::Physical { extinction, own } => {
                let left = (-extinction * metres).exp();
                (left, own * (1.0 - left))
            }
            Self::Source { base, falloff: [r, g, b, a] } => {
                let left = (-a * metres).exp();
                (DVec3::splat(left), base * (-DVec3::new(r, g, b) * metres).exp() * (1.0 - left))
            }
        }
    }

    /// Upper bound of the loss per scene unit.
    fn falls(&self) -> f64 {
        match *self {
            Self::Physical { extinction, .. } => extinction.max_element(),
            Self::Source { falloff, .. } => falloff.into_iter().fold(0.0, f64::max),
        }
    }
}

/// The water on a ray: its distance from the eye and its length in scene units, with air behind.
#[derive(Clone, Copy, Debug)]
pub struct Water {
    pub medium: Medium,
    pub from: f64,
    pub metres: f64,
}

impl Water {
    /// No water.
    pub fn none() -> Self {
        let medium = Medium::Physical { extinction: DVec3::ZERO, own: DVec3::ZERO };
        Self { medium, from: f64::INFINITY, metres: 0.0 }
    }

    /// Length of water nearer than this distance.
    fn before(&self, away: f64) -> f64 {
        (away - self.from).clamp(0.0, self.metres)
    }

    /// Light of layers, front to back, and of the water in front of what they hide. Only the rest
    /// of the water is behind them, and what they transmit of that is subtracted.
    fn over(&self, layers: &[Layer]) -> DVec3 {
        if let Medium::Source { .. } = self.medium {
            // The source's water is not additive in its length, so each layer is seen through the
            // whole length before it.
            let mut left = DVec3::ONE;
            let seen = |layer: &Layer| {
                let (kept, own) = self.medium.of(self.before(layer.away));
                let light =
                    left * (layer.gathered.light * kept + (1.0 - layer.gathered.through) * own);
                left *= layer.gathered.through;
                light
            };
            return layers.iter().map(seen).sum();
        }
        let through: DVec3 = layers.iter().map(|layer| layer.gathered.through).product();
        let mut behind = self.metres;
        let mut light = DVec3::ZERO;
        let steps = layers.iter().rev().map(|layer| (self.before(layer.away), Some(layer)));
        for (metres, layer) in steps.chain([(0.0, None)]) {
            let (kept, own) = self.medium.of(behind - metres);
            light = light * kept + own;
            if let Some(Layer { gathered, .. }) = layer {
                light = gathered.light + gathered.through * light;
            }
            behind = metres;
        }
        light - through * self.medium.of(self.metres).1
    }
}

/// Bubbles of a blob in its own space, and the walls of each.
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

    /// Radius of the smallest bubble.
    pub fn least(&self) -> f64 {
        self.bubbles.iter().map(|b| b.1).fold(f64::INFINITY, f64::min)
    }

    /// The wall that a ray crosses inside a bubble: distance, normal, and index of the bubble on
    /// the other side.
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

/// A blob: its ball, its rotation and its template.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    pub ball: [f32; 4],
    pub turn: [f32; 4],
    pub id: u32,
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

    /// Distances at which the ray meets a sphere.
    fn meets(self, center: DVec3, radius: f64) -> Option<[f64; 2]> {
        let to = center - self.origin;
        let along = to.dot(self.direction);
        let left = radius * radius - (to - along * self.direction).length_squared();
        (left >= 0.0).then(|| [along - left.sqrt(), along + left.sqrt()])
    }

    /// Distances at which the ray meets a sphere. If rounding makes the ray miss the sphere, it
    /// touches the sphere.
    fn touches(self, center: DVec3, radius: f64) -> [f64; 2] {
        let along = (center - self.origin).dot(self.direction);
        self.meets(center, radius).unwrap_or([along; 2])
    }
}

/// Light that a ray has gathered.
struct Gathered {
    light: DVec3,
    /// Transmittance for light from behind.
    through: DVec3,
    /// Error of the light and the transmittance, from the films.
    off: DVec3,
}

impl Gathered {
    /// Adds a film and its reflection.
    fn film(&mut self, (share, off): (DVec3, DVec3), mirrored: DVec3) {
        self.light += self.through * share * mirrored;
        self.off += self.through * off;
        self.through *= 1.0 - share;
    }
}

/// One blob in a pixel.
struct Layer {
    /// Distance from the eye.
    away: f64,
    gathered: Gathered,
    core: DVec3,
    /// Error of the core's brightness, relative to its albedo.
    unsure: f64,
    wall: bool,
    /// Opacity of the core behind the first bubble, and where the ray ends.
    told: f64,
    opaque: f64,
}

fn mix(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    a * (1.0 - t) + b * t
}

fn layer(
    look: &Look,
    (films, picture): (&Table, &Picture),
    blob: &Placed<'_>,
    (eye, along): (DVec3, DVec3),
    bubble: usize,
) -> Layer {
    let (origin, direction) = into_blob(blob.ball, blob.turn, eye, along);
    let ray = Ray { origin, direction };
    let turn = DQuat::from_array(blob.turn.map(f64::from)).normalize();
    let high = |normal: DVec3| (turn * normal).y;
    let reflected = |normal: DVec3| direction - 2.0 * direction.dot(normal) * normal;
    let (mut middle, radius) = blob.template.bubbles[bubble];
    let [into, mut out] = ray.touches(middle, radius);
    let first = ray.at(into);
    let front = (first - middle) / radius;
    let round = first.normalize();
    let number = pcg(blob.id.wrapping_mul(977).wrapping_add(bubble as u32));
    let film = |number: u32, normal: DVec3, place: DVec3, high: f64| {
        let thickness = look.thickness(number, 2.5 * place / radius, high);
        films.at(direction.dot(normal).abs(), thickness)
    };

    let opacity = |t: f64| 1.0 - smoothstep(look.core[0], look.core[1], ray.at(t).length());
    let crease = 0.77 + 0.3 * smoothstep(0.6, 1.0, ray.at(out).length());
    // Position in the pattern behind the surface, distorted by the normal (Sec. 4.4).
    let inside = mix(ray.at(out).normalize(), -front, look.distortion).normalize();
    let (pattern, unsure) = picture.at(inside);
    let facing = mix(front, round, look.roundness) + look.pattern * pattern.lean;
    let bright = 1.0 + look.pattern * (pattern.brightness - 1.0);
    let core = look.albedo * look.whitewater(turn * facing.normalize()) * bright * crease;
    // Directions that foam blocks reflect foam of this brightness.
    let mirrored = |normal: DVec3, open: f64| {
        look.reflection * mix(core, look.light(turn * reflected(normal)), open)
    };

    let mut gathered = Gathered { light: DVec3::ZERO, through: DVec3::ONE, off: DVec3::ZERO };
    let open = smoothstep(-0.35, 0.45, reflected(front).dot(round));
    gathered.film(film(number, front, first, high(front)), mirrored(front, open));

    let told = opacity(out);
    let wall = look.walls.then(|| blob.template.wall(ray, bubble, (into, out))).flatten();
    if let Some((at, normal, other)) = wall {
        let between = film(number ^ other as u32, normal, ray.at(at), 0.0);
        gathered.film(between, mirrored(normal, 0.4));
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
    gathered.film(film(number, back, last, high(back)), mirrored(back, 0.5));
    let away = into * f64::from(blob.ball[3]);
    let unsure = look.pattern * unsure;
    Layer { away, gathered, core, unsure, wall: wall.is_some(), told, opaque }
}

/// The colour of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Premultiplied colour and opacity.
    pub color: [f64; 4],
    /// Error of the colour, from the table and from where a ray may end.
    pub off: [f64; 4],
    /// Number of evaluated layers, and of those in which a wall was crossed.
    pub layers: usize,
    pub walls: usize,
    /// Number of layers with water in front of them.
    pub wet: usize,
    /// Opacity added by the plug.
    pub plugged: f64,
}

/// What a ray meets: the blobs and the first bubble in each, front to back, and the max opacity of
/// all blobs on it.
pub struct Met<'a> {
    pub blobs: &'a [Placed<'a>],
    pub first: &'a [(usize, usize)],
    pub most: f64,
}

/// A pixel with blobs in water. `turned`: max rotation of the ray by rounding.
pub fn pixel(
    look: &Look,
    made: (&Table, &Picture),
    ray: (DVec3, DVec3),
    met: &Met<'_>,
    (water, turned): (&Water, f64),
) -> Pixel {
    let mut left = DVec3::ONE;
    let (mut off, mut unsure, mut dull) = (DVec3::ZERO, 0.0, 0.0_f64);
    let mut body = None;
    let mut seen = Vec::new();
    let (mut all_told, mut held, mut behind) = (0.0_f64, 0.0_f64, 1.0);
    for &(blob, bubble) in met.first {
        let layer = layer(look, made, &met.blobs[blob], ray, bubble);
        (all_told, held) = (all_told.max(layer.told), held.max(layer.opaque));
        behind *= 1.0 - layer.told;
        off += left * layer.gathered.off;
        dull = dull.max(layer.unsure);
        // The length of the water before the layer depends on the ray.
        let lost = if water.before(layer.away) > 0.0 { water.medium.falls() } else { 0.0 };
        off += left * (1.0 - layer.gathered.through) * lost * turned * layer.away;
        left *= layer.gathered.through;
        body = Some(body.map_or(layer.core, |body: DVec3| (body + layer.core) / 2.0));
        seen.push(layer);
        // Rounding may decide whether the ray ends here.
        if (left.max_element() - LEAST).abs() <= off.max_element() + 1e-6 {
            unsure = 1.0;
        }
        if left.max_element() <= LEAST {
            break;
        }
    }
    let covered = 1.0 - left.element_sum() / 3.0;
    // An evaluated blob is as opaque as it turned out; otherwise the max opacity belongs to a
    // farther blob. Half precision cannot distinguish more.
    let most = if met.most > all_told + 1.0 / 1024.0 && behind >= LEAST { met.most } else { held };
    let extra = if look.plug { (most - covered).max(0.0) } else { 0.0 };
    let last = seen.last().map_or(0.0, |layer| water.before(layer.away));
    let (kept, own) = water.medium.of(last);
    let color = water.over(&seen) + extra * (body.unwrap_or(DVec3::ZERO) * kept + own);
    let alpha = (covered + extra).min(1.0);
    let dim = off.element_sum() / 3.0;
    let ended = unsure * (LEAST + extra);
    let off = (off + dim + ended + dull) * look.most();
    Pixel {
        color: color.extend(alpha).to_array(),
        off: off.extend(dim + ended).to_array(),
        layers: seen.len(),
        walls: seen.iter().filter(|layer| layer.wall).count(),
        wet: seen.iter().filter(|layer| water.before(layer.away) > 0.0).count(),
        plugged: extra,
    }
}
