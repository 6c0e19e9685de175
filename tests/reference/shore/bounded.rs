//! Running error analysis: a number with a bound of its error in single precision. u is at most
//! half an ulp; operations are as accurate as Vulkan requires ("Precision of Individual
//! Operations"). Denormal numbers may be flushed to 0.

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Relative error of one rounding to single precision.
pub const U: f64 = 1.0 / (1_u64 << 24) as f64;

/// Absolute error of the sine in [-π, π]. There is no guarantee outside, so arguments are reduced
/// first.
pub const SINE: f64 = 1.0 / 2048.0;

/// A number and the bound of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded {
    /// Value in exact arithmetic.
    pub value: f64,
    /// Max error in single precision.
    pub error: f64,
}

/// A number that is exact in single precision.
pub fn exact(value: f64) -> Bounded {
    Bounded { value, error: 0.0 }
}

/// A number computed in double precision and rounded to single.
pub fn held(value: f64) -> Bounded {
    Bounded { value, error: U * value.abs() }
}

/// A value with this error, rounded by this many u of itself.
fn rounded(value: f64, error: f64, units: f64) -> Bounded {
    let error = error + units * U * (value.abs() + error);
    Bounded { value, error: if error.is_nan() { f64::INFINITY } else { error } }
}

impl From<f64> for Bounded {
    fn from(value: f64) -> Self {
        exact(value)
    }
}

impl<B: Into<Bounded>> Add<B> for Bounded {
    type Output = Self;
    fn add(self, other: B) -> Self {
        let other = other.into();
        rounded(self.value + other.value, self.error + other.error, 1.0)
    }
}

impl<B: Into<Bounded>> Sub<B> for Bounded {
    type Output = Self;
    fn sub(self, other: B) -> Self {
        self + -other.into()
    }
}

impl Neg for Bounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl<B: Into<Bounded>> Mul<B> for Bounded {
    type Output = Self;
    fn mul(self, other: B) -> Self {
        let other = other.into();
        rounded(self.value * other.value, self.product_error(other), 1.0)
    }
}

/// Division errs by 2.5 ulp.
impl<B: Into<Bounded>> Div<B> for Bounded {
    type Output = Self;
    fn div(self, other: B) -> Self {
        let other = other.into();
        let value = self.value / other.value;
        let least = (other.value.abs() - other.error).max(0.0);
        let moved = self.error + value.abs() * other.error;
        rounded(value, if moved == 0.0 { 0.0 } else { moved / least }, 5.0)
    }
}

impl Bounded {
    /// A number known to lie between two others.
    pub fn between(low: f64, value: f64, high: f64) -> Self {
        let error = (high - value).max(value - low);
        Self { value, error: if error.is_nan() { f64::INFINITY } else { error } }
    }

    /// Lower bound.
    pub fn low(self) -> f64 {
        self.value - self.error
    }

    /// Upper bound.
    pub fn high(self) -> f64 {
        self.value + self.error
    }

    /// Whether a number computed in single precision is within the bound.
    pub fn holds(self, found: f64) -> bool {
        (found - self.value).abs() <= self.error
    }

    /// The same value with a larger error.
    pub fn wider(self, by: f64) -> Self {
        Self { error: self.error + by, ..self }
    }

    /// Error of a product from its factors' errors.
    fn product_error(self, other: Self) -> f64 {
        self.value.abs() * other.error + (other.value.abs() + other.error) * self.error
    }

    /// Result of a non-decreasing function, without its own rounding.
    pub fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        Self::between(f(self.low()), f(self.value), f(self.high()))
    }

    /// Absolute value; exact.
    pub fn abs(self) -> Self {
        Self { value: self.value.abs(), ..self }
    }

    /// Max with a number; exact.
    pub fn max(self, least: f64) -> Self {
        self.rising(|v| v.max(least))
    }

    /// Clamped between two numbers; exact.
    pub fn clamp(self, low: f64, high: f64) -> Self {
        self.rising(|v| v.clamp(low, high))
    }

    /// Vulkan's square root is `1 / inversesqrt`: 2 ulp, and 2.5 of the quotient.
    pub fn sqrt(self) -> Self {
        let root = self.rising(|v| v.max(0.0).sqrt());
        rounded(root.value, root.error, 9.0)
    }

    /// Errs by 3 + 2 |x| ulp.
    pub fn exp(self) -> Self {
        let most = self.value.abs() + self.error;
        let power = self.rising(f64::exp);
        rounded(power.value, power.error, 6.0 + 4.0 * most).wider(f64::from(f32::MIN_POSITIVE))
    }

    /// 2 to the power of the value.
    pub fn exp2(self) -> Self {
        let most = self.value.abs() + self.error;
        let power = self.rising(f64::exp2);
        rounded(power.value, power.error, 6.0 + 4.0 * most).wider(f64::from(f32::MIN_POSITIVE))
    }

    /// Errs by 2^-21 from a half to 2, otherwise by 3 ulp.
    pub fn log2(self) -> Self {
        let log = self.rising(|v| v.max(0.0).log2());
        log.wider(U * (6.0 * (log.value.abs() + log.error)).max(8.0))
    }

    /// With the reduction `x - 2π round(x / 2π)`, or the same in turns: 2π or its inverse is
    /// rounded, then a product of about x, then the remainder of at most π twice: 3u of |x| + π.
    /// Then the error [`SINE`]; the slope is the cosine.
    pub fn sine(self) -> Self {
        let off = self.error + 3.0 * U * (self.value.abs() + self.error + PI);
        let moved = (self.value.cos().abs() * off + 0.5 * off * off).min(2.0);
        Self { value: self.value.sin(), error: moved + SINE }
    }

    /// Like the sine.
    pub fn cosine(self) -> Self {
        let off = self.error + 3.0 * U * (self.value.abs() + self.error + PI);
        let moved = (self.value.sin().abs() * off + 0.5 * off * off).min(2.0);
        Self { value: self.value.cos(), error: moved + SINE }
    }

    /// GLSL's smoothstep from 0 to `high`: the quotient, and three roundings of `t·t·(3 - 2t)`.
    pub fn smoothstep(self, high: f64) -> Self {
        let step = (self / high).rising(|t| smoothstep(t.clamp(0.0, 1.0)));
        rounded(step.value, step.error, 3.0)
    }
}

fn smoothstep(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// A sum in any order: each partial sum is at most the sum of absolute values.
pub fn sum(terms: &[Bounded]) -> Bounded {
    let value = terms.iter().map(|t| t.value).sum();
    let error: f64 = terms.iter().map(|t| t.error).sum();
    let sizes: f64 = terms.iter().map(|t| t.value.abs()).sum();
    let roundings = terms.len().saturating_sub(1) as f64;
    Bounded { value, error: error + roundings * U * (sizes + error) }
}

/// A dot product in any order, with or without fused operations.
pub fn dot<const N: usize>(a: [Bounded; N], b: [Bounded; N]) -> Bounded {
    sum(&std::array::from_fn::<_, N, _>(|i| a[i] * b[i]))
}

/// `sqrt(dot(v, v))`; also for a single number.
pub fn length<const N: usize>(v: [Bounded; N]) -> Bounded {
    dot(v, v).sqrt()
}

/// GLSL's `a (1 - t) + b t`: both weights have the same error.
pub fn mix(a: Bounded, b: Bounded, t: Bounded) -> Bounded {
    let value = a.value * (1.0 - t.value) + b.value * t.value;
    let weights = [1.0 - t.value, t.value].map(f64::abs);
    let apart = (b.value - a.value).abs() + a.error + b.error;
    let error = a.error * weights[0] + b.error * weights[1] + apart * t.error;
    let sizes = a.value.abs() * weights[0] + b.value.abs() * weights[1] + error;
    Bounded { value, error: error + 3.0 * U * (sizes + a.value.abs() * t.error) }
}

/// A linearly changing value, at an offset in pixels from where it is known.
pub fn beside(at: Bounded, change: [Bounded; 2], off: [f64; 2]) -> Bounded {
    match off {
        [0.0, 0.0] => at,
        [x, y] => sum(&[at, change[0] * x, change[1] * y]),
    }
}
