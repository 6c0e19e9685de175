//! Running error analysis: a number with a bound on the error of single precision, carried through
//! a shader's operations. Each operation adds the error that Vulkan allows ("Precision of
//! Individual Operations"). u is half an ulp.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::tolerance::U;

/// A number and the bound on its error.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    pub v: f64,
    pub e: f64,
}

/// A number that single precision represents exactly.
pub fn exact(v: f64) -> Rounded {
    Rounded { v, e: 0.0 }
}

/// A number after `count` roundings.
pub fn off(v: f64, count: f64) -> Rounded {
    Rounded { v, e: count * U * v.abs() }
}

impl Add for Rounded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let v = self.v + other.v;
        Self { v, e: self.e + other.e + U * v.abs() }
    }
}

impl Sub for Rounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Rounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { v: -self.v, e: self.e }
    }
}

impl Mul for Rounded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let v = self.v * other.v;
        let e = self.v.abs() * other.e + other.v.abs() * self.e + self.e * other.e;
        Self { v, e: e + U * v.abs() }
    }
}

/// Error: 2.5 ulp.
impl Div for Rounded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let v = self.v / other.v;
        let least = (other.v.abs() - other.e).max(0.0);
        Self { v, e: (self.e + v.abs() * other.e) / least + 5.0 * U * v.abs() }
    }
}

impl Rounded {
    /// Error: 3 + 2 |x| ulp.
    pub fn exp(self) -> Self {
        let v = self.v.exp();
        Self { v, e: v * (self.e.exp_m1() + U * (6.0 + 4.0 * self.v.abs())) }
    }

    /// Base-2 exponential. Error: 3 + 2 |x| ulp.
    pub fn exp2(self) -> Self {
        let v = self.v.exp2();
        let from = self.e * std::f64::consts::LN_2;
        Self { v, e: v * (from.exp_m1() + U * (6.0 + 4.0 * self.v.abs())) }
    }

    /// Error: 2^-21 for x from 0.5 to 2, 3 ulp elsewhere.
    pub fn log2(self) -> Self {
        let v = self.v.log2();
        let least = (self.v - self.e).max(f64::MIN_POSITIVE);
        let own = if (0.5..=2.0).contains(&self.v) { 8.0 } else { 6.0 * v.abs() };
        Self { v, e: self.e / least / std::f64::consts::LN_2 + own * U }
    }

    /// Computed as `exp2(y log2 x)`, for y above 0. The error is limited to the result for the
    /// largest possible x.
    pub fn pow(self, y: Self) -> Self {
        let v = self.v.max(0.0).powf(y.v);
        let most = (self.v + self.e).max(0.0).powf(y.v) * 1.01;
        let e = if self.v > self.e { (y * self.log2()).exp2().e } else { most };
        Self { v, e: if e < most { e } else { most } }
    }

    /// Computed as `1 / inversesqrt`. Error: 2 ulp, plus 2.5 ulp for the quotient.
    pub fn sqrt(self) -> Self {
        let v = self.v.sqrt();
        let least = (self.v - self.e).max(0.0).sqrt();
        Self { v, e: self.e / (v + least) + 9.0 * U * v }
    }

    pub fn clamp(self, low: f64, high: f64) -> Self {
        let v = self.v.clamp(low, high);
        // A value farther outside than its error is clamped exactly.
        let e = if self.v + self.e < low || self.v - self.e > high { 0.0 } else { self.e };
        Self { v, e }
    }
}

pub fn dot(a: [Rounded; 3], b: [Rounded; 3]) -> Rounded {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: [Rounded; 3], b: [Rounded; 3]) -> [Rounded; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

/// `v / length(v)`. The error of the direction is at most the length of the vector's error over its
/// length. The sum of squares, the root and the quotient add 16u.
pub fn normalize(v: [Rounded; 3]) -> [Rounded; 3] {
    let length = v.iter().map(|c| c.v * c.v).sum::<f64>().sqrt();
    let error = v.iter().map(|c| c.e * c.e).sum::<f64>().sqrt();
    let turned = error / (length - error).max(f64::MIN_POSITIVE);
    v.map(|c| Rounded { v: c.v / length, e: turned + 16.0 * U * (c.v / length).abs() })
}

/// `a (1 - t) + b t`. The error of t counts times the difference of a and b.
pub fn mix(a: Rounded, b: Rounded, t: Rounded) -> Rounded {
    let v = a.v + (b.v - a.v) * t.v;
    let from = a.e * (1.0 - t.v).abs() + b.e * t.v.abs() + (b.v - a.v).abs() * t.e;
    Rounded { v, e: from + U * (3.0 * a.v.abs() * (1.0 - t.v).abs() + 2.0 * (b.v * t.v).abs()) }
}

/// `t² (3 - 2 t)`. Its derivative 6 t (1 - t) scales the error of t.
pub fn smoothstep(low: Rounded, high: Rounded, x: Rounded) -> Rounded {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    let v = t.v * t.v * (3.0 - 2.0 * t.v);
    let slope = 6.0 * (t.v * (1.0 - t.v) + t.e);
    Rounded { v, e: slope * t.e + 5.0 * U * v }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors of single precision stay within the bounds for numbers of all sizes, and reach a
    /// noticeable fraction of them.
    #[test]
    fn the_bounds_hold_and_are_not_idle() {
        let mut random = crate::support::scenes::Random(5);
        let mut worst = [0.0_f64; 4];
        for _ in 0..20_000 {
            let [a, b, c] = [0; 3].map(|_| random.between(-2.0, 2.0));
            let r = |x: f32| exact(f64::from(x));
            let cases: [(f32, Rounded); 4] = [
                (a * b + c, r(a) * r(b) + r(c)),
                (
                    a.abs().sqrt() / (b.abs() + 0.5),
                    exact(f64::from(a.abs())).sqrt() / (exact(f64::from(b.abs())) + exact(0.5)),
                ),
                ((a * b).exp(), (r(a) * r(b)).exp()),
                (
                    (b.abs() + 0.1).powf(c.abs()),
                    (exact(f64::from(b.abs())) + off(0.1, 1.0)).pow(exact(f64::from(c.abs()))),
                ),
            ];
            for (worst, (found, expected)) in worst.iter_mut().zip(cases) {
                let error = (f64::from(found) - expected.v).abs();
                *worst = worst.max(if error == 0.0 { 0.0 } else { error / expected.e });
            }
        }
        // The host's maths library is more precise than Vulkan requires, so most errors reach only
        // a small fraction of the bounds.
        let least = [0.5, 0.03, 0.1, 0.02];
        for (worst, least) in worst.into_iter().zip(least) {
            assert!(worst <= 1.0 && worst > least, "{worst}");
        }
    }
}
