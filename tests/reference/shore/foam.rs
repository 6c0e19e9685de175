//! Shoreline foam:
//! ```text
//! waves = max(k sin((f + n) v + phase + n) + a v + b + n, floor)         k = exp(-(f + n)² |dv|² / 24)
//! web   = Σ w m(q) + a' v + b' + n                                       fine = Σ w² (m₂(q) - m(q)²)
//! over  = r waves + r' web - threshold - n - 2 (1 - ends(v))             variance = r² (1 - k²)/2 + r'² fine
//! ```
//! There is foam where `over` is at least 0. k is the amplitude that remains of a wave's mean over
//! a pixel; m and m₂ are the mean and the mean square of the foam texture, so `variance` is that of
//! details finer than a pixel. With the change of `over` per pixel, from the slopes of waves and
//! texture, `over` is treated as uniformly distributed with the width
//! `w = sqrt(|change|² + 12 variance)`, and `over / w + 1/2` of the pixel is foam.
//!
//! Pixels that share values take the noises, k, the texture's levels, and v and the texture's
//! position with their changes, from a point between them; each pixel then moves v and the
//! texture's position to its own place. Waves, texture and everything computed from them are its
//! own.

use super::bounded::{Bounded, U, beside, dot, exact, held, sum};
use super::texture::Texture;
use super::{Clock, Phases};

/// The min of w.
const LEAST: f64 = 1e-6;

/// Periodic noise.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    /// Amplitude; 0 means none.
    pub amplitude: f64,
    /// Repetitions per scene unit.
    pub scale: f64,
}

/// No noise.
pub const NONE: Noise = Noise { amplitude: 0.0, scale: 0.0 };

/// From numbers of the settings.
pub fn noise(amplitude: f32, scale: f32) -> Noise {
    Noise { amplitude: f64::from(amplitude), scale: f64::from(scale) }
}

/// A layer of the foam texture.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// Weight; 0 means none.
    pub weight: f64,
    /// Repetitions per scene unit.
    pub scale: f64,
    /// Cosine and sine of its rotation.
    pub turn: [Bounded; 2],
    /// Displacement in repetitions, along its own axes.
    pub offset: [Bounded; 2],
}

/// From numbers of the settings: degrees, scene units per second.
pub fn layer(clock: Clock, weight: f32, scale: f32, angle: f32, speed: [f32; 2]) -> Layer {
    let (sine, cosine) = f64::from(angle).to_radians().sin_cos();
    // The speed is rotated in single precision. Its rounding is that of a constant speed, so it is
    // exact at all times.
    let ([x, y], [c, n]) = (speed, [cosine as f32, sine as f32]);
    let offset = clock.offset(scale, [c * x - n * y, n * x + c * y].map(f64::from));
    let turn = [held(cosine), held(sine)];
    Layer { weight: f64::from(weight), scale: f64::from(scale), turn, offset }
}

impl Layer {
    /// Texture coordinates of a place, in repetitions. The matrix may be rounded once more before
    /// its product.
    fn uv(&self, place: [Bounded; 2]) -> [Bounded; 2] {
        let [u, v] = self.turned(place);
        [u + self.offset[0], v + self.offset[1]]
    }

    /// A displacement in repetitions.
    fn turned(&self, way: [Bounded; 2]) -> [Bounded; 2] {
        let [c, s] = self.turn.map(|t| t * self.scale);
        [dot([c, -s], way), dot([s, c], way)]
    }
}

/// Settings of shoreline foam.
#[derive(Clone, Debug)]
pub struct Shoreline {
    /// f, radians per unit of v.
    pub frequency: f64,
    /// Phases of the waves at this time.
    pub phases: Phases,
    /// Noise on f.
    pub frequency_noise: Noise,
    /// Noise on the speed.
    pub speed_noise: Noise,
    /// a and b.
    pub wave_rise: [f64; 2],
    /// Min value of the waves.
    pub floor: Option<f64>,
    /// r.
    pub wave_weight: f64,
    /// r'.
    pub texture_weight: f64,
    /// a' and b'.
    pub web_rise: [f64; 2],
    /// Layers of the foam texture.
    pub layers: Vec<Layer>,
    /// Noise that displaces the texture, in scene units.
    pub texture_warp: Noise,
    /// Displacement of that noise in scene units.
    pub web_warp_moved: [Bounded; 2],
    /// There is foam from this value on.
    pub threshold: f64,
    /// Noise on the threshold.
    pub threshold_noise: Noise,
    /// Noise on b and b'.
    pub rise_noise: Noise,
    /// Noise that displaces everything except v, in scene units.
    pub warp: Noise,
    /// Foam ends within this range of v at both ends.
    pub fade: f64,
}

impl Shoreline {
    /// Only waves, with an amplitude of 1.
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

/// What a pixel sees of the water.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Offset in pixels from the point that the other values belong to.
    pub off: [f64; 2],
    /// Place in scene units.
    pub place: [Bounded; 2],
    /// 0 at the sea's end, 1 at the shore line, 2 inland.
    pub v: Bounded,
    /// Change of the place per pixel, along x and along y.
    pub across: [[Bounded; 2]; 2],
    /// Change of v per pixel, along x and along y.
    pub dv: [Bounded; 2],
}

impl Pixel {
    /// The pixel's own v. Beyond an end there is no foam, nor in the pixels that share values from
    /// there.
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

/// Foam in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Foam {
    /// The mixture of waves and texture minus the threshold.
    pub over: Bounded,
    /// Variance of its details that are finer than the pixel.
    pub variance: Bounded,
    /// Amplitude of a wave that remains.
    pub kept: Bounded,
    /// Value of the waves.
    pub waves: Bounded,
    /// Value of the texture.
    pub web: Bounded,
    /// Change of the mixture per pixel, along x and along y.
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
    // If rounding decides whether the floor applies, the bounds include both slopes.
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

/// Fraction of a pixel that is foam, by the change of `over` per pixel along x and y. The
/// quotient's bounds follow from the ends of both operands. It rounds by 2.5 ulp of at most a half,
/// and the sum rounds once more.
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

/// Whether a pixel is foam, without partial coverage. None if rounding decides.
pub fn clipped(over: Bounded) -> Option<bool> {
    (over.value.abs() > over.error).then_some(over.value >= 0.0)
}

/// Coverage by four samples: a multiple of a quarter, rounded by the pixel's position in a 2x2
/// block.
pub fn by_samples(part: Bounded, [x, y]: [usize; 2]) -> Bounded {
    let order = [[0.125, 0.625], [0.875, 0.375]][y % 2][x % 2];
    part.wider(2.0 * U).rising(|part| (4.0 * part.clamp(0.0, 1.0) + order).floor() / 4.0)
}

/// v from a signed distance, which is negative in water. `reach`: extent of the foam to sea and
/// to land, in scene units.
pub fn coordinate(distance: Bounded, reach: [f64; 2]) -> Bounded {
    let quotient = |s: f64| s / if s < 0.0 { reach[0] } else { reach[1] };
    let part = distance.rising(quotient);
    // The inverse rounds once, the product again.
    let rounded = part.wider(6.0 * U * (part.value.abs() + part.error));
    rounded + 1.0
}
