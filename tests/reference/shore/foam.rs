//! Shoreline foam:
//! ```text
//! waves = max(k sin((f + n) v + phase + n) + a v + b + n, floor)         k = exp(-(f + n)² |dv|² / 24)
//! web   = Σ w m(q) + a' v + b' + n                                       fine = Σ w² (m₂(q) - m(q)²)
//! over  = r waves + r' web - threshold - n - 2 (1 - ends(v))             variance = r² (1 - k²)/2 + r'² fine
//! ```
//! Foam is where `over` is at least 0. k is what is left of a wave's mean over a pixel, m and m₂ are the web's
//! mean and mean square: `variance` is of what is finer than a pixel. With the change of `over` across a pixel, by
//! the slopes of the waves and of the web, as if it were even, it has the width `w = sqrt(|change|² + 12 variance)`, and `over / w + 1/2` of the pixel is
//! foam.
//!
//! Pixels that share it have the noises, k, the web's levels, v and its change, and where the web is, of a point between
//! them: v is that at the point and the change on the way, the web where the way leads. Their waves, their web and all that
//! is made of it are their own.

use super::bounded::{Bounded, U, beside, dot, exact, held, sum};
use super::texture::Texture;
use super::{Clock, Phases};

/// The least w.
const LEAST: f64 = 1e-6;

/// Seamless noise.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    /// 0: none.
    pub amplitude: f64,
    /// Repetitions a metre.
    pub scale: f64,
}

/// None.
pub const NONE: Noise = Noise { amplitude: 0.0, scale: 0.0 };

/// From the settings' numbers.
pub fn noise(amplitude: f32, scale: f32) -> Noise {
    Noise { amplitude: f64::from(amplitude), scale: f64::from(scale) }
}

/// A layer of the web.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// 0: none.
    pub weight: f64,
    /// Repetitions a metre.
    pub scale: f64,
    /// Cosine and sine of its turn.
    pub turn: [Bounded; 2],
    /// Repetitions by which it has moved, along its own axes.
    pub offset: [Bounded; 2],
}

/// From the settings' numbers: degrees, metres a second.
pub fn layer(clock: Clock, weight: f32, scale: f32, angle: f32, speed: [f32; 2]) -> Layer {
    let (sine, cosine) = f64::from(angle).to_radians().sin_cos();
    // Turned in single precision: what is rounded is a speed, the same at all times.
    let ([x, y], [c, n]) = (speed, [cosine as f32, sine as f32]);
    let offset = clock.offset(scale, [c * x - n * y, n * x + c * y].map(f64::from));
    let turn = [held(cosine), held(sine)];
    Layer { weight: f64::from(weight), scale: f64::from(scale), turn, offset }
}

impl Layer {
    /// Repetitions at a place. The matrix may be rounded once more where its product is.
    fn uv(&self, place: [Bounded; 2]) -> [Bounded; 2] {
        let [u, v] = self.turned(place);
        [u + self.offset[0], v + self.offset[1]]
    }

    /// Repetitions of a way.
    fn turned(&self, way: [Bounded; 2]) -> [Bounded; 2] {
        let [c, s] = self.turn.map(|t| t * self.scale);
        [dot([c, -s], way), dot([s, c], way)]
    }
}

/// How shoreline foam looks.
#[derive(Clone, Debug)]
pub struct Shoreline {
    /// f, radians per v.
    pub frequency: f64,
    /// Of the time.
    pub phases: Phases,
    /// On f.
    pub frequency_noise: Noise,
    /// On the speed.
    pub speed_noise: Noise,
    /// a and b.
    pub wave_rise: [f64; 2],
    /// Waves are no less.
    pub floor: Option<f64>,
    /// r.
    pub wave_weight: f64,
    /// r'.
    pub texture_weight: f64,
    /// a' and b'.
    pub web_rise: [f64; 2],
    /// Of the web.
    pub layers: Vec<Layer>,
    /// Bends the web, metres.
    pub texture_warp: Noise,
    /// By how many metres that has moved.
    pub web_warp_moved: [Bounded; 2],
    /// Foam is from here on.
    pub threshold: f64,
    /// On it.
    pub threshold_noise: Noise,
    /// On b and b'.
    pub rise_noise: Noise,
    /// Bends all but v, metres.
    pub warp: Noise,
    /// Within so much v of both edges foam ends.
    pub fade: f64,
}

impl Shoreline {
    /// Waves alone, of a height of 1.
    pub fn waves(frequency: f64, phases: Phases, fade: f64) -> Self {
        Self {
            frequency,
            phases,
            frequency_noise: NONE,
            speed_noise: NONE,
            wave_rise: [0.0; 2],
            floor: None,
            wave_weight: 1.0,
            texture_weight: 0.0,
            web_rise: [0.0; 2],
            layers: Vec::new(),
            texture_warp: NONE,
            web_warp_moved: [exact(0.0); 2],
            threshold: 0.0,
            threshold_noise: NONE,
            rise_noise: NONE,
            warp: NONE,
            fade,
        }
    }
}

/// What of the water a pixel sees.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Pixels from the point that the rest is of.
    pub off: [f64; 2],
    /// Metres.
    pub place: [Bounded; 2],
    /// 0 at the sea's edge, 1 at the shore, 2 inland.
    pub v: Bounded,
    /// Change of the place from a pixel to the next, along x and along y.
    pub across: [[Bounded; 2]; 2],
    /// Change of v from a pixel to the next, along x and along y.
    pub dv: [Bounded; 2],
}

impl Pixel {
    /// Its own v. What is beyond an end has none, nor do those that share it.
    pub fn own_v(&self) -> Bounded {
        let moved = beside(self.v, self.dv, self.off);
        match (self.v.low() > 0.0, self.v.high() > 0.0) {
            (true, _) => moved,
            (false, true) => {
                let [low, high] = [self.v.low().min(moved.low()), self.v.high().max(moved.high())];
                Bounded::between(low, moved.value, high)
            }
            (false, false) => self.v,
        }
    }
}

/// What there is of foam.
#[derive(Clone, Copy, Debug)]
pub struct Foam {
    /// The mix over the threshold.
    pub over: Bounded,
    /// Of it, finer than the pixel.
    pub variance: Bounded,
    /// What is left of a wave's height.
    pub kept: Bounded,
    /// The waves.
    pub waves: Bounded,
    /// The web.
    pub web: Bounded,
    /// Of the mix from a pixel to the next, along x and along y.
    pub change: [Bounded; 2],
}

/// The foam of a pixel.
pub fn shoreline(look: &Shoreline, noise: &Texture<4>, texels: &Texture<4>, pixel: &Pixel) -> Foam {
    let Pixel { off, place, across, dv, .. } = *pixel;
    let v = pixel.own_v().clamp(0.0, 2.0);
    let [[ax, ay], [bx, by]] = across;
    let width = (ax * by - bx * ay).abs().sqrt();
    let moved = |p: [Bounded; 2], by: Noise, [x, y]: [Bounded; 2]| {
        [p[0] + x * by.amplitude, p[1] + y * by.amplitude]
    };
    let mut p = place;
    if look.warp.amplitude != 0.0 {
        let [x, y, ..] = noise.at(p, look.warp.scale, width);
        p = moved(p, look.warp, [x, y]);
    }
    let add = |by: Noise, channel: usize| match by.amplitude {
        0.0 => exact(0.0),
        _ => noise.at(p, by.scale, width)[channel] * by.amplitude,
    };
    let faster = add(look.frequency_noise, 0);
    let ahead = add(look.speed_noise, 1) * look.phases.local;
    let rise = add(look.rise_noise, 2);
    let dearer = add(look.threshold_noise, 3);

    let frequency = faster + look.frequency;
    let kept = (-(frequency * frequency * dot(dv, dv)) / 24.0).exp();
    let phase = sum(&[frequency * v, look.phases.waves, ahead]);
    let sine = phase.sine();
    let [a, b] = look.wave_rise;
    let waves = sum(&[kept * sine, v * a, exact(b), rise]);
    let steep = kept * frequency * phase.cosine() + a;
    let flat = look.floor.map_or(0.0, |floor| {
        if waves.low() > floor {
            0.0
        } else if waves.high() <= floor {
            2.0
        } else {
            1.0
        }
    });
    let floored = look.floor.is_some_and(|floor| waves.value <= floor);
    let own = if floored { exact(0.0) } else { steep };
    // Where single precision may find either it is any in between.
    let steep = if flat == 1.0 {
        Bounded::between(steep.low().min(0.0), own.value, steep.high().max(0.0))
    } else {
        own
    };
    let waves = look.floor.map_or(waves, |floor| waves.max(floor));

    let mut q = p;
    if look.texture_warp.amplitude != 0.0 {
        let at = [0, 1].map(|i| p[i] + look.web_warp_moved[i]);
        let [_, _, x, y] = noise.at(at, look.texture_warp.scale, width);
        q = moved(q, look.texture_warp, [x, y]);
    }
    let q = [0, 1].map(|i| beside(q[i], across.map(|way| way[i]), off));
    let [a, b] = look.web_rise;
    let (mut means, mut fine) = (vec![v * a, exact(b), rise], Vec::new());
    let mut changes = dv.map(|dv| vec![dv * a]);
    for layer in look.layers.iter().filter(|layer| layer.weight != 0.0) {
        let detail = texels.detail(width, layer.scale);
        let (mean, variance, slope) = texels.spread(layer.uv(q), detail);
        means.push(mean * layer.weight);
        for (changes, across) in changes.iter_mut().zip(across) {
            changes.push(dot(slope, layer.turned(across)) * layer.weight);
        }
        fine.push(exact(layer.weight) * layer.weight * variance);
    }
    let (web, fine) = (sum(&means), sum(&fine));
    let change =
        [0, 1].map(|i| steep * dv[i] * look.wave_weight + sum(&changes[i]) * look.texture_weight);

    let ends = v.smoothstep(look.fade) * (exact(2.0) - v).smoothstep(look.fade);
    let over = sum(&[
        waves * look.wave_weight,
        web * look.texture_weight,
        exact(-look.threshold),
        -dearer,
        (exact(1.0) - ends) * -2.0,
    ]);
    let [wave_weight, texture_weight] =
        [look.wave_weight, look.texture_weight].map(|r| exact(r) * r);
    let variance = wave_weight * ((exact(1.0) - kept * kept) * 0.5) + texture_weight * fine;
    Foam { over, variance, kept, waves, web, change }
}

/// How much of a pixel is foam, by the change of `over` to the next pixel along x and y. The quotient is what its
/// ends are at the ends of both; its rounding is 2.5 ulp of what counts, at most a half, and that of the sum.
pub fn covered(over: Bounded, variance: Bounded, change: [Bounded; 2]) -> Bounded {
    let square = dot(change, change) + variance.max(0.0) * 12.0;
    let wide = square.sqrt().max(LEAST);
    let part = |over: f64, wide: f64| (over / wide + 0.5).clamp(0.0, 1.0);
    let ends = [wide.low().max(LEAST), wide.high()];
    let least = ends.map(|w| part(over.low(), w)).into_iter().fold(1.0, f64::min);
    let most = ends.map(|w| part(over.high(), w)).into_iter().fold(0.0, f64::max);
    let part = Bounded::between(least, part(over.value, wide.value), most);
    if part.error == 0.0 && (part.value == 0.0 || part.value == 1.0) {
        return part;
    }
    part.wider(4.0 * U)
}

/// Whether a pixel is foam where it is so or not; nothing where single precision may find either.
pub fn clipped(over: Bounded) -> Option<bool> {
    (over.value.abs() > over.error).then_some(over.value >= 0.0)
}

/// The same by four samples: quarters of it, which of them by the pixel, as a block of two by two has them.
pub fn by_samples(part: Bounded, [x, y]: [usize; 2]) -> Bounded {
    let order = [[0.125, 0.625], [0.875, 0.375]][y % 2][x % 2];
    part.wider(2.0 * U).rising(|part| (4.0 * part.clamp(0.0, 1.0) + order).floor() / 4.0)
}

/// v of a signed distance, negative in water; metres of foam to sea and to land.
pub fn coordinate(distance: Bounded, reach: [f64; 2]) -> Bounded {
    let quotient = |s: f64| s / if s < 0.0 { reach[0] } else { reach[1] };
    let part = distance.rising(quotient);
    // The inverse is rounded once, the product again.
    let rounded = part.wider(6.0 * U * (part.value.abs() + part.error));
    rounded + 1.0
}
