//! Ambient occlusion of the frontmost foam: samples in spheres with several radii, each compared
//! with the picture's depths.

use super::super::surface_foam::ray_off;
use super::super::{Image, View, smoothstep};
use super::{Seen, TOLD, has_fluid};
use crate::support::rounded::Rounded;
use crate::support::tolerance::U;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Distance behind an occluder up to which it hides samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// In radii of the pass' sphere.
    Radii(f64),
    /// In scene units.
    Scene(f64),
}

/// Settings of the occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occlusion {
    /// P, the number of passes.
    pub passes: u32,
    /// Search radius in radii of the foam: of the first pass, and the increase per pass.
    pub radii: [f64; 2],
    /// Samples per cubic pixel.
    pub density: f64,
    /// Min and max number of samples per pass.
    pub counts: [f64; 2],
    /// Reach of the occluders.
    pub reach: Reach,
    /// Opacities of the fluid and of the scene.
    pub opacities: [f64; 2],
    /// Scale, power and offset of the shadow `(scale omega)^power + offset`.
    pub shadow: [f64; 3],
    /// Radius of the blur, in radii of the first pass' sphere.
    pub blur: f64,
    /// Min radius of the blur in pixels. The blur does not cross gaps in depth larger than twice
    /// its radius or a particle's diameter.
    pub least_blur: f64,
}

impl Default for Occlusion {
    fn default() -> Self {
        Self {
            passes: 3,
            radii: [1.0, 7.0],
            density: 0.5,
            counts: [16.0, 512.0],
            reach: Reach::Radii(1.0),
            opacities: [0.5, 1.0],
            shadow: [1.0, 1.5, -0.05],
            blur: 1.5,
            least_blur: 0.0,
        }
    }
}

/// The images that samples are compared with.
#[derive(Clone, Copy)]
pub struct Layers<'a> {
    /// The frontmost foam.
    pub front: &'a Image<Option<Seen>>,
    /// Opacity of all foam.
    pub opacity: &'a Image<f64>,
    /// Eye depth of the fluid's surface.
    pub fluid: &'a Image<f64>,
    /// Eye depth of the scene.
    pub solid: &'a Image<f64>,
}

/// Occluded fraction, 0 to 1, and its bounds in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Omega {
    /// Exact value of the definition.
    pub value: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// Direction in which the surroundings are open, in eye space, of any length, and its error.
    pub open: (DVec3, f64),
}

/// Weight of the direction to the eye, relative to the open directions.
const TO_EYE: f64 = 0.02;

impl Omega {
    /// The normal with which foam is lit, in world space: that of its sphere for large foam, the
    /// open direction for small foam, and a mixture between. Returns also its error.
    pub fn facing(&self, view: &View, h: f64, normal: (DVec3, f64)) -> (DVec3, f64) {
        let told = smoothstep(TOLD.0, TOLD.1, 0.5 * h * view.extent().y);
        let (open, open_e) = self.open;
        let length = open.length();
        let world = view.view.inverse().transform_vector3(open / length);
        let sum = world.lerp(normal.0, told);
        // If two vectors differ by e, their unit vectors differ by at most 2 e over the length.
        let e = (1.0 - told) * (2.0 * open_e / length).min(2.0) + told * normal.1 + 64.0 * U;
        (sum.normalize(), (2.0 * e / sum.length()).min(2.0))
    }
}

/// Value, lower bound, upper bound.
type Ends = [f64; 3];

impl Occlusion {
    /// h_p, the search radius of a pass, relative to half the height of the picture.
    pub fn search(&self, h: f64, pass: u32) -> f64 {
        h * (self.radii[0] + self.radii[1] * f64::from(pass))
    }

    /// Number of samples of a sphere with this radius in pixels, not rounded.
    fn wanted(&self, h_px: f64) -> f64 {
        let [fewest, most] = self.counts;
        (4.0 / 3.0 * PI * h_px.powi(3) * self.density).clamp(fewest, most)
    }

    /// Number of samples, with halves rounded up.
    pub fn samples(&self, h_px: f64) -> usize {
        (self.wanted(h_px) + 0.5).floor() as usize
    }

    /// Range of the number of samples in single precision: the radius errs by 8u, its cube and the
    /// rest by 8u more.
    fn samples_ends(&self, h_px: f64) -> [usize; 2] {
        let wanted = self.wanted(h_px);
        let e = if self.counts.contains(&wanted) { 0.0 } else { (3.0 * 8.0 + 8.0) * U * wanted };
        [wanted - e, wanted + e].map(|n| (n + 0.5).floor() as usize)
    }

    /// The shadow of an occluded fraction.
    pub fn zeta(&self, omega: f64) -> f64 {
        let [scale, power, offset] = self.shadow;
        ((omega.max(0.0) * scale).powf(power) + offset).clamp(0.0, 1.0)
    }

    /// Weight of an occluder at this distance in front of a sample.
    fn falls(&self, behind: f64, radius: f64) -> f64 {
        let reach = match self.reach {
            Reach::Radii(radii) => radii * radius,
            Reach::Scene(reach) => reach,
        };
        (1.0 - behind / reach).max(0.0).powi(2)
    }

    /// How much of a sample at a depth with this error is hidden by what a pixel shows, with the
    /// limited reach and with an unlimited one.
    fn hidden(
        &self,
        layers: &Layers<'_>,
        at: (usize, usize),
        d: (f64, f64),
        radius: f64,
    ) -> [Ends; 2] {
        let (x, y) = at;
        let foam = layers.front.at(x, y).map(|seen| (seen.depth, layers.opacity.at(x, y)));
        let [fluid, solid] = [layers.fluid, layers.solid].map(|image| image.at(x, y));
        let [fluid_opacity, solid_opacity] = self.opacities;
        let fluid = has_fluid(fluid).then_some((fluid, fluid_opacity));
        let (mut sums, mut blocked) = ([0.0; 3], [0.0; 3]);
        for (depth, opacity) in [foam, fluid, Some((solid, solid_opacity))].into_iter().flatten() {
            // Depths come from the projection with 8u. The radius 16u, the quotient, the difference
            // and the square give less than 48u of at most 1.
            let (behind, e) = (d.0 - depth, d.1 + 8.0 * U * depth + U * (d.0 - depth).abs());
            let [near, far] = [behind - e, behind + e];
            let part = |behind: f64| self.falls(behind, radius) * opacity;
            let own = 48.0 * U * opacity;
            sums[0] += if behind > 0.0 { part(behind) } else { 0.0 };
            sums[1] += if near > 0.0 { (part(far) - own).max(0.0) } else { 0.0 };
            sums[2] += if far > 0.0 { part(near.max(0.0)) + own } else { 0.0 };
            let e = 2.0 * U * opacity;
            blocked[0] += if behind > 0.0 { opacity } else { 0.0 };
            blocked[1] += if near > 0.0 { opacity - e } else { 0.0 };
            blocked[2] += if far > 0.0 { opacity + e } else { 0.0 };
        }
        [sums, blocked].map(|sums| sums.map(|sum| sum.min(1.0)))
    }

    /// A sample's contribution to three sums: hidden within reach, hidden at any distance, and the
    /// weight of all.
    fn sample(&self, layers: &Layers<'_>, view: &View, s: &Sample) -> [Ends; 3] {
        let (near, d) = (view.near(), -s.at.z);
        if d + s.e <= near * (1.0 - 8.0 * U) {
            return [[0.0; 3]; 3];
        }
        let sure = d - s.e > near * (1.0 + 8.0 * U);
        let place = view.project(s.at);
        let e = pixels_off(view, s);
        let inside = |at: DVec2| {
            let within = at.cmpge(DVec2::ZERO).all() && at.cmplt(view.extent()).all();
            within.then_some((at.x as usize, at.y as usize))
        };
        let lambdas @ [lambda, ..] = s.lambdas;

        let mut hidden = [[0.0, f64::INFINITY, 0.0]; 2];
        let mut counted = [0.0, if sure { lambdas[1] } else { 0.0 }, 0.0];
        let (low, high) = ((place - e).floor(), (place + e).floor());
        for y in low.y as i64..=high.y as i64 {
            for x in low.x as i64..=high.x as i64 {
                let Some(at) = inside(DVec2::new(x as f64, y as f64)) else {
                    hidden.iter_mut().for_each(|hidden| hidden[1] = 0.0);
                    counted[1] = 0.0;
                    continue;
                };
                let found = self.hidden(layers, at, (d, s.e), s.radius);
                for (hidden, found) in hidden.iter_mut().zip(found) {
                    hidden[1] = hidden[1].min(found[1] * lambdas[1]);
                    hidden[2] = hidden[2].max(found[2] * lambdas[2]);
                }
                counted[2] = lambdas[2];
            }
        }
        if let Some(at) = inside(place).filter(|_| d > near) {
            let found = self.hidden(layers, at, (d, 0.0), s.radius);
            hidden.iter_mut().zip(found).for_each(|(hidden, found)| hidden[0] = lambda * found[0]);
            counted[0] = lambda;
        }
        if !sure {
            hidden.iter_mut().for_each(|hidden| hidden[1] = 0.0);
        }
        let [hidden, blocked] = hidden;
        [hidden, blocked, counted]
    }

    /// Occluded fraction around the frontmost foam of a pixel, if there is any. `points`: at least
    /// as many of [`points`] as there may be samples.
    pub fn omega(
        &self,
        layers: &Layers<'_>,
        view: &View,
        points: &[DVec3],
        at: (usize, usize),
    ) -> Option<Omega> {
        let weigh = |unit: DVec3| {
            let length = unit.length();
            let lambda = (1.0 - length).powi(2);
            let own = U * (32.0 * (1.0 - length) + 8.0 * lambda);
            [lambda, (lambda - own).max(0.0), lambda + own]
        };
        self.omega_by(layers, view, &|_| points, &weigh, at)
    }

    /// Occluded fraction with given points for each pass, and a function for their weights.
    fn omega_by<'a>(
        &self,
        layers: &Layers<'_>,
        view: &View,
        points: &dyn Fn(u32) -> &'a [DVec3],
        weigh: &dyn Fn(DVec3) -> Ends,
        (x, y): (usize, usize),
    ) -> Option<Omega> {
        let seen = layers.front.at(x, y)?;
        let focal = view.focal().y.abs();
        let ray = ray_off(view, x, y);
        let (at, at_e) = (ray.v * seen.depth, (ray.e + U * ray.v.length()) * seen.depth);
        let ([mut hidden, mut blocked, mut counted], mut terms) = ([[0.0; 3]; 3], 0.0);
        // Sums of the points with the second and with the third of their weights, and the lengths
        // of the sums' errors.
        let (mut dark, mut whole) = ((DVec3::ZERO, 0.0), (DVec3::ZERO, 0.0));
        for pass in 1..=self.passes {
            let h = self.search(seen.h, pass);
            let h_px = 0.5 * h * view.extent().y;
            let radius = h * seen.depth / focal;
            let count = self.samples(h_px);
            let ends = self.samples_ends(h_px);
            for (i, unit) in points(pass).iter().take(ends[1]).enumerate() {
                // The radius errs by 16u, a point by u per coordinate, and the product and the sum
                // by u each.
                let moved = radius * *unit;
                let e = at_e + U * (19.0 * moved.length() + at.length());
                let sample = Sample { lambdas: weigh(*unit), radius, at: at + moved, e };
                let here = [i < count, i < ends[0], true];
                let all = self.sample(layers, view, &sample);
                let [h, b, c] =
                    all.map(|ends| [0, 1, 2].map(|j| if here[j] { ends[j] } else { 0.0 }));
                for (sums, ends) in [(&mut hidden, h), (&mut blocked, b), (&mut counted, c)] {
                    sums.iter_mut().zip(ends).for_each(|(sum, end)| *sum += end);
                }
                let add = |sum: &mut (DVec3, f64), ends: Ends| {
                    sum.0 += ends[0] * *unit;
                    sum.1 += (ends[2] - ends[0]).max(ends[0] - ends[1]) * unit.length();
                };
                add(&mut dark, b);
                add(&mut whole, c);
                terms += 1.0;
            }
        }
        // Two sums with this number of terms, and a quotient.
        let rounding = (2.0 * terms + 5.0) * U;
        let over = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        let share = |sums: Ends| -> Ends {
            let high = match counted[1] > 0.0 {
                true => (sums[2] / counted[1] * (1.0 + rounding)).min(1.0 + rounding),
                false if counted[2] > 0.0 => 1.0,
                false => 0.0,
            };
            [over(sums[0], counted[0]), over(sums[1], counted[2]) * (1.0 - rounding), high]
        };
        let off = |[value, low, high]: Ends| (high - value).max(value - low);
        let [value, low, high] = share(hidden);
        // Hidden samples lie on one side, so the mean direction of the others is the opposite of
        // theirs.
        let part = share(blocked);
        let open = part[0] * whole.0 - dark.0 + (TO_EYE * counted[0]).max(1e-6) * DVec3::Z;
        let e = part[0] * whole.1
            + off(part) * (whole.0.length() + whole.1)
            + dark.1
            + TO_EYE * off(counted);
        // None of the sums is larger than this.
        let e = e + rounding * (blocked[0] + part[0] * counted[0]);
        Some(Omega { value, low, high, open: (open, e) })
    }
}

/// A sample in eye space.
struct Sample {
    /// Its weight.
    lambdas: Ends,
    /// Radius of its pass' sphere in world units.
    radius: f64,
    /// Its position and the error's length.
    at: DVec3,
    e: f64,
}

/// Error of a sample's pixel position: its slope is a quotient, the rest adds 8u of its terms.
fn pixels_off(view: &View, s: &Sample) -> DVec2 {
    let [x, y] = [0, 1].map(|i| {
        let slope = Rounded { v: s.at[i], e: s.e } / Rounded { v: -s.at.z, e: s.e };
        let (focal, shift) = (view.focal()[i].abs(), view.shift()[i].abs());
        let e = focal * slope.e + 8.0 * U * (focal * slope.v.abs() + shift + 1.0);
        0.5 * view.extent()[i] * e
    });
    DVec2::new(x, y)
}

/// Occluded fraction in each pixel with foam.
pub fn occlusion(layers: &Layers<'_>, view: &View, settings: &Occlusion) -> Image<Option<Omega>> {
    let points = points(settings.counts[1].ceil() as usize + 1);
    Image::from_fn(view.width, view.height, |x, y| settings.omega(layers, view, &points, (x, y)))
}

/// Occluded fraction with fewer points per pixel, spread over blocks of 4x4 pixels: each pixel uses
/// a run of [`pairs`] from a total of `most`, and another run in each pass.
pub fn shared_occlusion(
    layers: &Layers<'_>,
    view: &View,
    settings: &Occlusion,
    most: usize,
) -> Image<Option<Omega>> {
    let length = most / 32 * 2;
    let points: Vec<_> = pairs(8 * length).into_iter().flat_map(|s| [s, -s]).collect();
    let settings = Occlusion { counts: [length as f64; 2], ..*settings };
    Image::from_fn(view.width, view.height, |x, y| {
        let run = |pass: u32| (bayer(x, y) + 5 * pass as usize) % 16 * length;
        settings.omega_by(layers, view, &|pass| &points[run(pass)..], &|_| [1.0; 3], (x, y))
    })
}

/// A pixel's number in a 4x4 Bayer matrix.
fn bayer(x: usize, y: usize) -> usize {
    let digit = |i: usize| [(x ^ y) >> i & 1, y >> i & 1];
    let [[a, b], [c, d]] = [digit(0), digit(1)];
    8 * a + 4 * b + 2 * c + d
}

/// One point of each pair of opposite points: a lattice by the powers of the root of x^4 = x + 1,
/// mapped from the cube to half of the unit sphere. Its density is `lambda`.
pub fn pairs(count: usize) -> Vec<DVec3> {
    // x = (1 + x)^(1/4) converges to the root.
    let root = (0..64).fold(1.0_f64, |x, _| (1.0 + x).powf(0.25));
    let pair = |i: usize| {
        let [turn, radius, height] = [1, 2, 3].map(|power| i as f64 / root.powi(power) % 1.0);
        let across = (1.0 - height * height).sqrt();
        let (sin, cos) = (2.0 * PI * turn).sin_cos();
        within(radius) * DVec3::new(across * cos, across * sin, height)
    };
    (1..=count).map(pair).collect()
}

/// Radius of the sphere that contains this fraction of `lambda`, `30 int r^2 (1-r)^2 dr`, by
/// Newton's method from the steepest point.
fn within(share: f64) -> f64 {
    (0..100).fold(0.5, |r: f64, _| {
        let all = 30.0 * (r.powi(3) / 3.0 - r.powi(4) / 2.0 + r.powi(5) / 5.0);
        let slope = 30.0 * (r * (1.0 - r)).powi(2);
        r - (all - share) / slope.max(1e-12)
    })
}

/// The first points of the Halton sequence that lie in the unit sphere.
pub fn points(count: usize) -> Vec<DVec3> {
    (1..).map(halton).filter(|s| s.length() < 1.0).take(count).collect()
}

/// A point of the Halton sequence with bases 2, 3, 5, in the cube from -1 to 1.
pub fn halton(index: u32) -> DVec3 {
    DVec3::from([2, 3, 5].map(|base| 2.0 * inverse(index, base) - 1.0))
}

/// The radical inverse of a number.
fn inverse(mut index: u32, base: u32) -> f64 {
    let (mut sum, mut place) = (0.0, 1.0);
    while index > 0 {
        place /= f64::from(base);
        sum += place * f64::from(index % base);
        index /= base;
    }
    sum
}
