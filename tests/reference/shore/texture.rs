//! A square periodic texture with mip levels in half precision, filtered bilinearly within the
//! nearest level.
//!
//! A filter knows position and level to 1/256: half a step is 2^-9 of the differences between the
//! texels involved. A position error adds the number of texels times the largest difference of
//! neighbours that it may pass, and the result stays in the level's range. If two levels are
//! equally near, the bounds include both.

use super::bounded::{Bounded, U, exact};

/// Half a step of the filter's weights.
pub const STEP: f64 = 1.0 / 512.0;

/// Position and level are computed in single precision, from at least this many texels per pixel.
const LEAST: f64 = 1e-6;

/// Roundings of a filter in single precision: two linear interpolations with three operations each.
const ROUNDINGS: f64 = 6.0;

/// Longer runs of texels are bounded by the level's range and not texel by texel.
const MANY: i64 = 16;

/// Half precision, rounded to nearest with ties to even; infinite if too large.
pub fn half(value: f64) -> f64 {
    let power = value.abs().max(f64::MIN_POSITIVE).log2().floor() as i32;
    // The logarithm of a number just below a power of two may be rounded up.
    let power = if value.abs() < 2.0_f64.powi(power) { power - 1 } else { power };
    let step = 2.0_f64.powi(power.max(-14) - 10);
    let rounded = (value / step).round_ties_even() * step;
    if rounded.abs() > 65504.0 { f64::INFINITY.copysign(value) } else { rounded }
}

/// All mip levels of a texture.
#[derive(Clone, Debug)]
pub struct Texture<const C: usize> {
    size: usize,
    levels: Vec<Vec<[f64; C]>>,
    /// Max minus min of each level.
    ranges: Vec<[f64; C]>,
    /// Largest absolute value of all levels.
    most: [f64; C],
    /// Relative error of filtered values from the filter's precision, in units of the largest
    /// texel.
    rounding: f64,
}

impl<const C: usize> Texture<C> {
    /// From level 0, row by row: values are rounded, and each texel of the next level is the
    /// rounded mean of four. The size is a power of two.
    pub fn new(size: usize, texels: &[[f32; C]]) -> Self {
        assert!(
            size.is_power_of_two() && texels.len() == size * size,
            "a square of a power of two"
        );
        let first: Vec<_> = texels.iter().map(|t| t.map(|v| half(f64::from(v)))).collect();
        let mut levels = vec![first];
        let mut edge = size;
        while edge > 1 {
            levels.push(coarser(&levels[levels.len() - 1], edge));
            edge /= 2;
        }
        Self::from_levels(size, levels)
    }

    /// From given levels.
    pub fn from_levels(size: usize, levels: Vec<Vec<[f64; C]>>) -> Self {
        for (level, texels) in levels.iter().enumerate() {
            assert_eq!(texels.len(), (size >> level).pow(2), "texels of level {level}");
        }
        let range = |texels: &Vec<[f64; C]>| {
            std::array::from_fn(|c| {
                let all = texels.iter().map(|t| t[c]);
                let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                    (v.min(low), v.max(high))
                });
                high - low
            })
        };
        let ranges = levels.iter().map(range).collect();
        let sizes = |c: usize| levels.iter().flatten().map(move |t| t[c].abs());
        let most = std::array::from_fn(|c| sizes(c).fold(0.0, f64::max));
        Self { size, levels, ranges, most, rounding: 0.0 }
    }

    /// Whether the filter works in half precision, which Vulkan leaves open for 16-bit floats: it
    /// is then off by one ulp in either direction. Otherwise it works in single precision.
    pub fn filtered_in_halves(self, yes: bool) -> Self {
        Self { rounding: if yes { 1.0 / 2048.0 } else { 0.0 }, ..self }
    }

    /// Size of level 0 in texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Texels of a level, row by row.
    pub fn level(&self, level: usize) -> &[[f64; C]] {
        &self.levels[level]
    }

    /// The coarsest level.
    pub fn last(&self) -> usize {
        self.levels.len() - 1
    }

    /// Level of detail for a pixel `width` scene units wide, not clamped; `scale` in repetitions
    /// per scene unit.
    pub fn detail(&self, width: Bounded, scale: f64) -> Bounded {
        (width * scale * self.size as f64).max(LEAST).log2()
    }

    /// The texture at a place in scene units.
    pub fn at(&self, place: [Bounded; 2], scale: f64, width: Bounded) -> [Bounded; C] {
        let uv = place.map(|p| p * scale);
        self.nearest(self.detail(width, scale), |level| self.sample(uv, level))
    }

    /// The value of the level nearest to the level of detail; if two are equally near, bounds of
    /// both.
    fn nearest<const D: usize>(
        &self,
        detail: Bounded,
        of: impl Fn(usize) -> [Bounded; D],
    ) -> [Bounded; D] {
        let detail = detail.wider(STEP).clamp(0.0, self.last() as f64);
        let (low, high) = ((detail.low() - 0.5).ceil(), (detail.high() + 0.5).floor());
        let (low, high) = (low.max(0.0) as usize, (high as usize).min(self.last()));
        let own = of(detail.value.round() as usize);
        let all: Vec<_> = (low..=high).map(of).collect();
        std::array::from_fn(|c| {
            let ends = all.iter().fold((own[c].low(), own[c].high()), |(low, high), other| {
                (other[c].low().min(low), other[c].high().max(high))
            });
            Bounded::between(ends.0, own[c].value, ends.1)
        })
    }

    /// The texture at a position in repetitions.
    pub fn sample(&self, uv: [Bounded; 2], level: usize) -> [Bounded; C] {
        let moved = self.filtered(level, uv, &|t| *t, &|range| *range);
        std::array::from_fn(|c| moved[c].wider((ROUNDINGS * U + self.rounding) * self.most[c]))
    }

    /// Bounds of a filter's result for numbers computed from texels, with an uncertain position and
    /// without roundings. `ranges`: ranges of these numbers from those of the texels.
    fn filtered<const D: usize>(
        &self,
        level: usize,
        uv: [Bounded; 2],
        of: &impl Fn(&[f64; C]) -> [f64; D],
        ranges: &impl Fn(&[f64; C]) -> [f64; D],
    ) -> [Bounded; D] {
        let edge = (self.size >> level) as i64;
        let texels = &self.levels[level];
        let get =
            |x: i64, y: i64| of(&texels[(y.rem_euclid(edge) * edge + x.rem_euclid(edge)) as usize]);
        // u·N - ½ in single precision, and a step of the filter.
        let place = uv.map(|uv| {
            let texels = uv.value * edge as f64;
            let error = uv.error * edge as f64;
            (texels - 0.5, error + U * (texels.abs() + error + 0.5) + STEP)
        });
        let [x, y] = place.map(|(at, _)| at.floor() as i64);
        let [fx, fy] = place.map(|(at, _)| at - at.floor());
        let four = [get(x, y), get(x + 1, y), get(x, y + 1), get(x + 1, y + 1)];
        let weights = [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy];
        let value = |c: usize| four.iter().zip(weights).map(|(t, w)| t[c] * w).sum::<f64>();

        let ranges = ranges(&self.ranges[level]);
        let [(left, right), (top, bottom)] = place.map(|(at, off)| {
            let [low, high] = [at - off, at + off].map(|v| v.clamp(-1e15, 1e15).floor() as i64);
            (low, high + 1)
        });
        if (right - left).max(bottom - top) > MANY {
            return std::array::from_fn(|c| exact(value(c)).wider(ranges[c]));
        }
        let mut steps = [[0.0_f64; 2]; D];
        let most = |step: &mut f64, a: f64, b: f64| *step = step.max((a - b).abs());
        for y in top..=bottom {
            for x in left..=right {
                let here = get(x, y);
                if x < right {
                    let beside = get(x + 1, y);
                    (0..D).for_each(|c| most(&mut steps[c][0], beside[c], here[c]));
                }
                if y < bottom {
                    let below = get(x, y + 1);
                    (0..D).for_each(|c| most(&mut steps[c][1], below[c], here[c]));
                }
            }
        }
        std::array::from_fn(|c| {
            let moved = steps[c][0] * place[0].1 + steps[c][1] * place[1].1;
            exact(value(c)).wider(moved.min(ranges[c]))
        })
    }
}

/// The next level: rounded means of four texels.
fn coarser<const C: usize>(texels: &[[f64; C]], edge: usize) -> Vec<[f64; C]> {
    let next = edge / 2;
    let texel = |i: usize| {
        let first = i / next * 2 * edge + i % next * 2;
        let four = [first, first + 1, first + edge, first + edge + 1];
        std::array::from_fn(|c| half(four.iter().map(|i| texels[*i][c]).sum::<f64>() / 4.0))
    };
    (0..next * next).map(texel).collect()
}

impl Texture<4> {
    /// A foam texture: its value, its square, and its slopes per repetition.
    pub fn web(size: usize, values: &[f32]) -> Self {
        let at = |x: usize, y: usize| values[y % size * size + x % size];
        let half = 0.5 * size as f32;
        let texel = |i: usize| {
            let (x, y, w) = (i % size, i / size, values[i]);
            let across = at(x + 1, y) - at(x + size - 1, y);
            let down = at(x, y + 1) - at(x, y + size - 1);
            [w, w * w, half * across, half * down]
        };
        Self::new(size, &(0..size * size).map(texel).collect::<Vec<_>>())
    }

    /// Mean m at a position in repetitions, variance (mean square s minus m², at least 0), and
    /// slopes.
    ///
    /// Both channels have the same weights. If the position errs, the variance changes like
    /// `s - 2 m t` with m fixed, by the differences of that, and at most by e² if m errs by e.
    /// Roundings are those of s, of twice m times m, of the square and of the difference.
    pub fn spread(&self, uv: [Bounded; 2], detail: Bounded) -> (Bounded, Bounded, [Bounded; 2]) {
        let of = |level| {
            let [mean, square, across, down] = self.sample(uv, level);
            let m = mean.value;
            let of = |t: &[f64; 4]| [t[1] - 2.0 * m * t[0]];
            let ranges = |range: &[f64; 4]| [range[1] + 2.0 * m.abs() * range[0]];
            let [held] = self.filtered(level, uv, &of, &ranges);
            let sizes = ROUNDINGS * (self.most[1] + 2.0 * m.abs() * self.most[0])
                + m * m
                + (square.value - m * m).abs();
            // Both the mean square and the mean are rounded before the subtraction.
            let rounded = self.rounding * (square.value + 2.0 * m * m);
            let moved = held.error + mean.error * mean.error + rounded;
            let variance = exact(square.value - m * m).wider(moved + 2.0 * U * sizes);
            [mean, variance.max(0.0), across, down]
        };
        let [mean, variance, across, down] = self.nearest(detail, of);
        (mean, variance, [across, down])
    }
}
