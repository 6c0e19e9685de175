//! Twin of the sunlight: the light maps, the caustics computed from them, and the light that
//! reaches the scene.
//!
//! The light's space is (u, v, d): position in the maps, which cover a ball's silhouette, and
//! distance along the light in scene units. Numbers are [`Rounded`], or bounds where single
//! precision decides something: the first particle of a texel, a multiple of a step, whether two
//! depths belong to one surface. Where rounding may change a decision, the bounds widen by the
//! effect of that decision only.

mod whitewater;

use super::thickness::{J, kernel};
use super::wavelets::Waves;
use super::whole_steps;
use super::{EMPTY, Image, is_surface};
use crate::support::rounded::{Rounded, dot, exact, normalize, off, smoothstep};
use crate::support::tolerance::{Between, U};
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::PI;

/// Drawn radius of a particle of full density, in spacings.
const RADIUS: f64 = 0.656;
/// The light of a texel is counted in this many units.
const UNITS: f64 = 4096.0;
/// Refractive index of air divided by that of water.
const ETA: f64 = 1.0 / 1.333;
/// Light is refracted by waves that are longer than this fraction of the water's thickness, up to
/// this number of texels.
const WAVES: (f64, f64) = (1.0 / 8.0, 8.0);

/// A particle that casts a shadow.
#[derive(Clone, Copy, Debug)]
pub struct Particle {
    pub position: DVec3,
    /// `None`: the rest density.
    pub density: Option<f64>,
    /// Amount of foam; NaN counts as none.
    pub foam: f64,
}

/// Inputs of the light maps.
#[derive(Clone, Debug)]
pub struct Light {
    /// Direction to the sun in world space.
    pub sun: DVec3,
    /// Centre of the ball that the maps cover.
    pub center: DVec3,
    pub radius: f64,
    /// Width of the maps in texels.
    pub texels: usize,
    pub spacing: f64,
    /// Density below which there is no water, from which all of a particle is water, and from which
    /// none is spray.
    pub densities: [f64; 3],
    /// Light that a particle's spray blocks, relative to as much foam.
    pub shade: f64,
    /// Whether a particle has several droplets, so that its spray blocks less the fewer are drawn.
    pub several: bool,
    /// Half-axis of the shadow of a particle that is only spray, if that is wider than water's.
    pub spread: f64,
    /// Width of the smoothing and falloff of its depth, in drawn radii.
    pub width: f64,
    pub falloff: f64,
    /// Extinction per scene unit of water and of foam.
    pub extinction: [f64; 3],
    pub foam_extinction: f64,
    /// Whitewater particles: thickness of half intensity, and exponent.
    pub intensity: [f64; 2],
    /// Small waves on level water.
    pub waves: Option<Waves>,
}

/// The maps of a frame.
#[derive(Clone, Debug)]
pub struct Maps<'a> {
    pub front: &'a Image<f32>,
    pub thickness: &'a Image<[f32; 4]>,
    pub caustics: &'a Image<f32>,
    /// Map of the whitewater particles, if they cast shadows.
    pub whitewater: Option<&'a Image<[f32; 4]>>,
}

/// The parts of a particle that are drawn.
struct Share {
    /// Fraction of the drawn radius.
    bulk: Rounded,
    /// Fraction that is spray.
    spray: Rounded,
    /// Fractions of water and of foam.
    parts: [Rounded; 2],
}

/// Result of a comparison; `Maybe` if rounding decides.
#[derive(Clone, Copy, PartialEq)]
enum Is {
    Yes,
    No,
    Maybe,
}

/// Whether a is at most b.
fn at_most(a: Rounded, b: Rounded) -> Is {
    match a.v - b.v {
        less if less < -(a.e + b.e) => Is::Yes,
        more if more > a.e + b.e => Is::No,
        _ => Is::Maybe,
    }
}

impl Light {
    fn r(&self) -> f64 {
        RADIUS * self.spacing
    }

    /// Width of a texel in scene units.
    pub fn texel(&self) -> f64 {
        2.0 * self.radius / self.texels as f64
    }

    /// The sums' fixed-point step.
    pub fn step(&self) -> f64 {
        self.spacing.log2().floor().exp2() / 2048.0
    }

    /// Position in texels, whose centres are at +0.5, and distance along the light.
    pub fn place(&self, p: DVec3) -> (DVec2, f64) {
        let sun = self.sun.normalize();
        let up = if sun.y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
        let right = up.cross(sun).normalize();
        let side = sun.cross(right);
        let from = p - self.center;
        let across = DVec2::new(right.dot(from), side.dot(from)) / (2.0 * self.radius);
        ((across + 0.5) * self.texels as f64, -sun.dot(from))
    }

    /// The world position at a place of the maps and a distance along the light.
    pub fn point(&self, at: DVec2, depth: f64) -> DVec3 {
        let sun = self.sun.normalize();
        let up = if sun.y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
        let right = up.cross(sun).normalize();
        let across = (at / self.texels as f64 - 0.5) * 2.0 * self.radius;
        self.center + right * across.x + sun.cross(right) * across.y - sun * depth
    }

    /// Error of a coordinate in scene units. The axes are unit vectors whose components err by 16u,
    /// 28u as vectors, and are scaled with two roundings; this error grows with the distance from
    /// the centre. The offset is a sum of four terms, like the product with a point: 8u of the
    /// terms that cancel, 4u of the map's coordinate.
    pub fn off(&self, p: DVec3) -> f64 {
        let from = p - self.center;
        U * (36.0 * from.length() + 8.0 * (p.length() + self.center.length()) + 8.0 * self.radius)
    }

    /// None if nothing of the particle is drawn.
    fn shares(&self, particle: &Particle) -> Option<Share> {
        if !particle.position.to_array().iter().all(|c| c.abs() < 1e18) {
            return None;
        }
        let foam = exact(if particle.foam > 0.0 { particle.foam.min(1.0) } else { 0.0 });
        let density = particle.density.filter(|d| *d > 0.0);
        let (bulk, spray) = match density {
            None => (exact(1.0), exact(0.0)),
            Some(density) => {
                let [all, full, none] = self.densities.map(|d| off(d, 1.0));
                // A ramp narrower than this is a step.
                let step = |end: Rounded| match end.v > all.v + 1e-6 {
                    true => smoothstep(all, end, exact(density)),
                    false => exact(f64::from(u8::from(density > all.v))),
                };
                let bulk = exact(0.5) + exact(0.5) * step(full);
                let bulk = if density < all.v { exact(0.0) } else { bulk };
                (bulk, exact(1.0) - step(none))
            }
        };
        let own = bulk * foam;
        let water = bulk * (exact(1.0) - foam);
        // Proportional to the drawn fraction of the droplets, which is at least 0.3, and to their
        // enlarged size.
        let torn = match self.several {
            true => (exact(4.0) * (exact(1.0) - spray)).clamp(f64::from(0.3_f32), 1.0),
            false => exact(1.0),
        };
        let foam = own + exact(self.shade) * spray * torn * torn * (exact(1.0) - own);
        (water.v > 0.0 || foam.v > 0.0).then_some(Share { bulk, spray, parts: [water, foam] })
    }

    /// The texels whose centres lie within `reach` of a place, with their distances; both in scene
    /// units.
    fn within(&self, at: DVec2, reach: f64) -> impl Iterator<Item = (usize, usize, f64)> {
        let (n, t) = (self.texels, self.texel());
        let range = move |at: f64| {
            let (low, high) = (at - reach / t - 1.0, at + reach / t + 1.0);
            (low.max(0.0) as usize).min(n)..(high.max(0.0) as usize).min(n)
        };
        let columns = range(at.x);
        range(at.y).flat_map(move |y| columns.clone().map(move |x| (x, y))).filter_map(
            move |(x, y)| {
                let away = (DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - at).length() * t;
                (away <= reach).then_some((x, y, away))
            },
        )
    }

    /// Depth of the first water. Each disc is enlarged and shrunk by the error of its position.
    pub fn front(&self, particles: &[Particle]) -> Between {
        let (n, t, r) = (self.texels, self.texel(), self.r());
        let mut low = Image::new(n, n, EMPTY);
        let mut high = low.clone();
        for particle in particles {
            let Some(Share { bulk, .. }) = self.shares(particle) else { continue };
            let (at, d) = self.place(particle.position);
            let a = (r * bulk.v.max(0.5)).max(t);
            let a_off = r * bulk.e + 4.0 * U * a;
            let from = self.off(particle.position) + a_off + 4.0 * U * a;
            let slack = from + 8.0 * U * (d.abs() + a);
            for (x, y, away) in self.within(at, a + from) {
                let at = |away: f64| d - a.min(r) * (1.0 - (away / a).powi(2)).max(0.0).sqrt();
                let pixel = low.at_mut(x, y);
                *pixel = pixel.min(at((away - from).max(0.0)) - slack);
                if away + from <= a {
                    let pixel = high.at_mut(x, y);
                    *pixel = pixel.min(at(away + from) + slack);
                }
            }
        }
        Between { low, high }
    }

    /// The thicknesses, channel by channel. Kernel and amplitude add 40u. A contribution becomes a
    /// neighbouring multiple of the step, chosen by a random number of the particle and the texel,
    /// whose sum is rounded by 2u. Sums of steps are exact up to 2^24.
    pub fn thickness(&self, particles: &[Particle]) -> [Between; 4] {
        let (n, step) = (self.texels, self.step());
        let empty = || Between { low: Image::new(n, n, 0.0), high: Image::new(n, n, 0.0) };
        let mut sums = [0; 4].map(|_| empty());
        let mut most = Image::new(n, n, [0.0, 0.0]);
        let narrow = 2.0 * self.r();
        let slab = 512.0 * step;
        for particle in particles {
            let Some(Share { parts, spray, .. }) = self.shares(particle) else { continue };
            let (at, d) = self.place(particle.position);
            let off = self.off(particle.position);
            let wider = (self.spread - narrow).max(0.0);
            let a = (narrow + wider * spray.v).max(self.texel());
            let a_off = wider * spray.e / a;
            let from = off + (8.0 * U + a_off) * a;
            let chance = whole_steps::of_place(particle.position.as_vec3());
            let nearest = |v: f64, unit: f64| (v / unit + 0.5).floor() * unit;
            let ends = [-1.0, 1.0].map(|s| nearest(d + s * (off + 4.0 * U * d.abs()), slab));
            for (x, y, away) in self.within(at, a + from) {
                let at = |away: f64| kernel((away / a).min(1.0).powi(2));
                let (least, greatest) = (at(away + from), at((away - from).max(0.0)));
                let up = whole_steps::rounding_up(chance, x, y);
                let whole = |h: f64, by: f64| (h / step + up + by * 2.0 * U).floor() * step;
                for (i, part) in parts.iter().enumerate() {
                    let height = self.spacing.powi(3) / (PI * J * a * a);
                    let q = [
                        whole(
                            (part.v - part.e).max(0.0)
                                * height
                                * least
                                * (1.0 - 40.0 * U - 2.0 * a_off),
                            -1.0,
                        ),
                        whole(
                            (part.v + part.e) * height * greatest * (1.0 + 40.0 * U + 3.0 * a_off),
                            1.0,
                        ),
                    ];
                    *sums[i].low.at_mut(x, y) += q[0];
                    *sums[i].high.at_mut(x, y) += q[1];
                    let all = [q[0] * ends[0], q[0] * ends[1], q[1] * ends[0], q[1] * ends[1]];
                    *sums[i + 2].low.at_mut(x, y) += all.into_iter().fold(f64::INFINITY, f64::min);
                    *sums[i + 2].high.at_mut(x, y) +=
                        all.into_iter().fold(f64::NEG_INFINITY, f64::max);
                    most.at_mut(x, y)[i] += q[1] * ends[0].abs().max(ends[1].abs());
                }
            }
        }
        for (i, sum) in sums[2..].iter_mut().enumerate() {
            for (at, most) in most.data.iter().enumerate() {
                // Beyond the exact range, one ulp for each contribution.
                let exact = most[i] < 16_777_216.0 * step * slab;
                let slack = if exact { 0.0 } else { particles.len() as f64 * U * most[i] };
                sum.low.data[at] -= slack;
                sum.high.data[at] += slack;
            }
        }
        sums
    }

    /// Max difference between two depths of one surface.
    fn apart(&self) -> Rounded {
        off(self.falloff * self.r(), 2.0)
    }

    /// The front depth smoothed along rows or columns. Sums of n weights and products err by 2 (n +
    /// 3) u of the depth. A weight errs by its exponent, 48u, in proportion to the differences
    /// between depths.
    fn smoothed(&self, front: &Image<Rounded>, along: (isize, isize)) -> Image<Rounded> {
        let sigma = (self.width * self.r() / self.texel()).max(1e-3);
        let reach = (2.5 * sigma).ceil().min(64.0) as isize;
        Image::from_fn(front.width, front.height, |x, y| {
            let here = front.at(x, y);
            if !is_surface(here.v) {
                return exact(EMPTY);
            }
            let (mut sum, mut weights, mut errors, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
            let mut taps = Vec::new();
            let mut maybe = 0.0;
            for i in -reach..=reach {
                let tap = front.clamped(x as isize + i * along.0, y as isize + i * along.1);
                let weight = (-0.5 * (i as f64 / sigma).powi(2)).exp();
                let away = tap - here;
                let same = match i {
                    0 => Is::Yes,
                    _ => at_most(Rounded { v: away.v.abs(), ..away }, self.apart()),
                };
                if same == Is::Maybe {
                    maybe += weight;
                } else if same == Is::Yes {
                    sum += weight * tap.v;
                    weights += weight;
                    errors += weight * tap.e;
                    largest = largest.max(tap.v.abs());
                    taps.push((weight, tap.v));
                }
            }
            let v = sum / weights;
            let spread: f64 = taps.iter().map(|(w, tap)| w * (tap - v).abs()).sum();
            let n = (2 * reach + 1) as f64;
            let rounding = U * (2.0 * (n + 3.0) * largest + 48.0 * spread / weights);
            Rounded { v, e: errors / weights + rounding + maybe / weights * self.apart().v * 1.01 }
        })
    }

    /// The front depth smoothed along both axes.
    fn surface(&self, maps: &Maps<'_>) -> Image<Rounded> {
        let front = maps.front.map(|d| exact(f64::from(*d)));
        self.smoothed(&self.smoothed(&front, (1, 0)), (0, 1))
    }

    /// Adds small waves to a normal.
    fn with_waves(
        &self,
        waves: &Waves,
        n: [Rounded; 3],
        (x, y): (usize, usize),
        depth: Rounded,
    ) -> [Rounded; 3] {
        let sun = self.sun.normalize();
        let up = if sun.y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
        let right = up.cross(sun).normalize();
        let axes = [right, sun.cross(right), -sun];
        let place = self.point(DVec2::new(x as f64, y as f64) + 0.5, depth.v);
        // The slope's error, and its change within the error of the position.
        let off = depth.e + self.off(place);
        let slope = waves.slope(place, 0.0);
        let error = waves.error(place) + waves.steepest() * off;
        let slope = axes.map(|axis| Rounded { v: axis.dot(slope), e: error + 16.0 * U });
        let normal: DVec3 = axes.iter().zip(&n).map(|(axis, n)| *axis * n.v).sum();
        let loose = n.iter().map(|n| n.e).sum::<f64>() + 16.0 * U;
        // A smoothstep over 0.5 has a slope of at most 1.5 / 0.5.
        let level = Rounded { v: waves.level(normal), e: 1.5 / 0.5 * loose + 8.0 * U };
        let along = dot(slope, n);
        normalize([0, 1, 2].map(|i| n[i] - level * (slope[i] - along * n[i])))
    }

    /// Where the light of each texel with water lands, in texels from the centre of the first
    /// texel.
    pub fn landings(&self, maps: &Maps<'_>) -> Image<Option<[Rounded; 2]>> {
        let front = self.surface(maps);
        let (t, s) = (off(self.texel(), 2.0), self.spacing);
        Image::from_fn(self.texels, self.texels, |x, y| {
            let here = front.at(x, y);
            if !is_surface(here.v) {
                return None;
            }
            let [x_water, foam, ..] = maps.thickness.at(x, y).map(|v| exact(f64::from(v)));
            let sides = 0.5 * WAVES.0 * x_water.v / self.texel();
            // If rounding decides, the reach is one of two numbers of texels.
            let reaches = [1.0 - 8.0 * U, 1.0 + 8.0 * U]
                .map(|e| (sides * e).round().clamp(1.0, WAVES.1) as isize);
            let rise = [(1, 0), (0, 1)].map(|(dx, dy)| {
                let [low, high] = reaches.map(|reach| {
                    let [after, before] = [reach, -reach].map(|go| {
                        let there = front.clamped(x as isize + go * dx, y as isize + go * dy);
                        let away = there - here;
                        match at_most(Rounded { v: away.v.abs(), ..away }, self.apart()) {
                            Is::Yes => there,
                            Is::No => here,
                            Is::Maybe => Rounded { v: here.v, e: here.e + away.v.abs() + away.e },
                        }
                    });
                    (after - before) / (exact(2.0 * reach as f64) * t)
                });
                let (v, apart) = (0.5 * (low.v + high.v), 0.5 * (low.v - high.v).abs());
                Rounded { v, e: apart + low.e.max(high.e) }
            });
            let n = normalize([rise[0], rise[1], exact(-1.0)]);
            let n = match &self.waves {
                Some(waves) => self.with_waves(waves, n, (x, y), here),
                None => n,
            };
            let eta = off(ETA, 2.0);
            // refract((0, 0, 1), n, eta)
            let cosine = dot(n, [exact(0.0), exact(0.0), exact(1.0)]);
            let k = exact(1.0) - eta * eta * (exact(1.0) - cosine * cosine);
            let bend = eta * cosine + k.sqrt();
            let b = [-(bend * n[0]), -(bend * n[1]), eta - bend * n[2]];
            let scattered = (-(off(4.0 * self.foam_extinction, 1.0) * foam)).exp();
            let thick = smoothstep(off(s, 1.0), off(4.0 * s, 2.0), x_water);
            let lens = x_water * thick * scattered;
            let down = b[2].clamp(0.2, 2.0);
            let index = [x, y].map(|i| exact(i as f64));
            Some([0, 1].map(|i| index[i] + b[i] / down * lens / t))
        })
    }

    /// Light relative to that without water, and the units that each texel holds. `past`: fraction
    /// of sunlight that the host's scene lets through at a point with this error in scene units.
    pub fn caustics(
        &self,
        maps: &Maps<'_>,
        past: &dyn Fn(DVec3, f64) -> Rounded,
    ) -> (Between, Between) {
        let n = self.texels;
        let mut low = Image::new(n, n, 0.0);
        let mut high = low.clone();
        let front = self.surface(maps);
        for (from, landing) in self.landings(maps).data.into_iter().enumerate() {
            let (Some(landing), depth) = (landing, front.data[from]) else { continue };
            let middle = DVec2::new((from % n) as f64, (from / n) as f64) + 0.5;
            let p = self.point(middle, depth.v);
            let sun = past(p, depth.e + self.off(p));
            // A texel's light is divided linearly between the four texels around its landing place.
            let hat = |at: Rounded, i: isize| {
                let part = 1.0 - (at.v - i as f64).abs();
                [(part - at.e).max(0.0), (part + at.e).clamp(0.0, 1.0)]
            };
            let around = |at: Rounded| {
                let ends = [(at.v - at.e).floor(), (at.v + at.e).ceil()];
                ends.map(|v| v.clamp(-1.0, n as f64) as isize)
            };
            let ([x0, x1], [y0, y1]) = (around(landing[0]), around(landing[1]));
            for (x, y) in (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| (x, y))) {
                if x < 0 || y < 0 || x >= n as isize || y >= n as isize {
                    continue;
                }
                let (wx, wy) = (hat(landing[0], x), hat(landing[1], y));
                let suns = [(sun.v - sun.e).max(0.0), (sun.v + sun.e).min(1.0)];
                let units = [0, 1]
                    .map(|i| UNITS * wx[i] * wy[i] * suns[i] * [1.0 - 5.0 * U, 1.0 + 5.0 * U][i]);
                *low.at_mut(x as usize, y as usize) += (units[0] - 0.5).ceil().max(0.0);
                *high.at_mut(x as usize, y as usize) += (units[1] + 0.5).floor();
            }
        }
        let resolved = |units: &Image<f64>, sign: f64| {
            Image::from_fn(n, n, |x, y| {
                let mut sum = 0.0;
                for (dx, dy) in (-2..=2_isize).flat_map(|y| (-2..=2_isize).map(move |x| (x, y))) {
                    let (i, j) = (x as isize + dx, y as isize + dy);
                    let dry = !is_surface(f64::from(maps.front.clamped(i, j)));
                    let weight = f64::from(((3 - dx.abs()) * (3 - dy.abs())) as i32) / 81.0;
                    sum += weight * (units.clamped(i, j) / UNITS + f64::from(u8::from(dry)));
                }
                sum * (1.0 + sign * 32.0 * U)
            })
        };
        let sums = Between { low: resolved(&low, -1.0), high: resolved(&high, 1.0) };
        (sums, Between { low, high })
    }

    /// Fraction of sunlight that water and foam let through at a point with this error in scene
    /// units, for each channel, and the factor by which caustics change it.
    pub fn at(&self, maps: &Maps<'_>, p: DVec3, by: f64) -> ([Rounded; 3], Rounded) {
        let (at, d) = self.place(p);
        let (at, n) = (at - 0.5, self.texels as f64);
        let by = by + self.off(p);
        let moved = by / self.texel() + 2.0 * U * n;
        let one = exact(1.0);
        let inside = |edge: f64| {
            at.cmpgt(DVec2::splat(-edge)).all() && at.cmplt(DVec2::splat(n - 1.0 + edge)).all()
        };
        if !inside(moved) {
            return ([one; 3], one);
        }
        let d = Rounded { v: d, e: by };
        let base = at.floor();
        let texel = |i: isize, j: isize| {
            let [x, y, z, w] = maps.thickness.clamped(i, j).map(|v| exact(f64::from(v)));
            let before = |x: Rounded, z: Rounded, off: Rounded| {
                let mean = z / if x.v > 1e-9 { x } else { exact(1e-9) };
                (d - off - mean + exact(0.5) * x).clamp(0.0, x.v)
            };
            let half = self::off(0.5 * self.spacing, 2.0);
            let lost = exact(self.foam_extinction) * before(y, w, half);
            let water = before(x, z, half);
            let kept = self.extinction.map(|k| (-(self::off(k, 1.0) * water) - lost).exp());
            let covered = maps.whitewater.map(|map| self.covered(map.clamped(i, j), d));
            let covered = covered.unwrap_or(exact(0.0));
            let below = before(x, z, exact(0.0)) / if x.v > 1e-9 { x } else { exact(1e-9) };
            let caustics = exact(f64::from(maps.caustics.clamped(i, j)));
            let mean = z / if x.v > 1e-9 { x } else { exact(1e-9) };
            let far = (d - mean - exact(0.5) * x).clamp(0.0, f64::INFINITY);
            // Far behind the water caustics are blurred out.
            let sharp = one / (one + far / self::off(8.0 * self.spacing, 1.0));
            [kept[0], kept[1], kept[2], below * sharp, caustics, covered]
        };
        let (i, j) = (base.x as isize, base.y as isize);
        let mean = |c: usize| {
            let (mut sum, mut least, mut most) = (exact(0.0), f64::INFINITY, f64::NEG_INFINITY);
            // If the place is near a texel's border, the cells on both sides are possible, three
            // along each axis.
            for (dx, dy) in (-1..3).flat_map(|y| (-1..3).map(move |x| (x, y))) {
                let value = texel(i + dx, j + dy)[c];
                (least, most) = (least.min(value.v), most.max(value.v));
                let hat = |at: f64, i: isize| (1.0 - (at - i as f64).abs()).max(0.0);
                let weight = hat(at.x, i + dx) * hat(at.y, j + dy);
                if weight > 0.0 {
                    sum = sum + self::off(weight, 4.0) * value;
                }
            }
            Rounded { e: sum.e + 2.0 * moved * (most - least), ..sum }
        };
        let focus = mean(4).clamp(0.0, 3.0);
        let gain = one + (focus - one) * mean(3);
        let kept = [0, 1, 2].map(mean);
        // The light lost to whitewater particles is a mean of its own.
        let left = one - mean(5);
        let kept = if maps.whitewater.is_some() { kept.map(|kept| kept * left) } else { kept };
        // The place may also lie outside the maps.
        let open = |v: Rounded| Rounded { e: v.e + (1.0 - v.v).abs(), ..v };
        if inside(-moved) { (kept, gain) } else { (kept.map(open), open(gain)) }
    }
}

/// Colour of the scene in this light. `shade`: light in shade relative to that in the sun; `past`:
/// fraction of sunlight that the host's scene lets through.
pub fn lit(color: f64, shade: f64, past: Rounded, through: Rounded, gain: Rounded) -> Rounded {
    let sun = exact(1.0) - off(shade, 5.0).clamp(0.0, 1.0);
    off(color, 1.0) * (exact(1.0) + sun * past * (through * gain - exact(1.0)))
}

/// A host's shadow map.
pub struct ShadowMap<'a> {
    pub depth: &'a Image<f32>,
    pub view_projection: DMat4,
    pub bias: f64,
    /// Direction to the sun.
    pub sun: DVec3,
    /// Whether depth decreases away from the light.
    pub reversed: bool,
}

impl ShadowMap<'_> {
    /// Fraction of sunlight at a point with this error in scene units: a mean of comparisons. A
    /// comparison that rounding may change counts a half, with an error of a half.
    pub fn past(&self, p: DVec3, by: f64) -> Rounded {
        let p = p + self.bias * self.sun.normalize();
        let clip = self.view_projection * p.extend(1.0);
        // Four products and sums per row, and two roundings of the point.
        let rows = self.view_projection.transpose();
        let error = |row: glam::DVec4| {
            let most = row.truncate().length() * (by + 2.0 * U * p.length());
            most + 4.0 * U * (row.truncate().length() * p.length() + row.w.abs())
        };
        let w = Rounded { v: clip.w, e: error(rows.w_axis) };
        if clip.w <= -w.e {
            return exact(1.0);
        }
        let ndc = |v: f64, row| Rounded { v, e: error(row) } / w;
        let (x, y, z) =
            (ndc(clip.x, rows.x_axis), ndc(clip.y, rows.y_axis), ndc(clip.z, rows.z_axis));
        let uv = [x, y].map(|v| exact(0.5) + exact(0.5) * v);
        let side = |v: Rounded, e: f64| v.v >= -e && v.v <= 1.0 + e;
        let inside = |sign: f64| [uv[0], uv[1], z].iter().all(|v| side(*v, sign * v.e));
        if !inside(1.0) {
            return exact(1.0);
        }
        let size = [self.depth.width, self.depth.height].map(|n| n as f64);
        let at = [0, 1].map(|i| uv[i] * exact(size[i]) - exact(0.5));
        let base = at.map(|v| v.v.floor());
        let weight = |axis: usize, i: isize| {
            let f = at[axis].v - base[axis];
            [1.0 - f, 1.0, 1.0, f][(i + 1) as usize] / 3.0
        };
        let mut share = Rounded { v: 0.0, e: 2.0 * (at[0].e + at[1].e) + 24.0 * U };
        for (i, j) in (-1..3).flat_map(|j| (-1..3).map(move |i| (i, j))) {
            let texel = self.depth.clamped(base[0] as isize + i, base[1] as isize + j);
            let weight = weight(0, i) * weight(1, j);
            let past = f64::from(texel) - z.v;
            let past = if self.reversed { -past } else { past };
            let unsure = past.abs() <= z.e + U;
            share.v += weight * if unsure { 0.5 } else { f64::from(u8::from(past >= 0.0)) };
            share.e += if unsure { 0.5 * weight } else { 0.0 };
        }
        let open = Rounded { v: share.v, e: share.e + 1.0 - share.v };
        if inside(-1.0) && clip.w > w.e { share } else { open }
    }
}
