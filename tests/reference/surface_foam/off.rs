//! Vectors in single precision, each with a bound on the length of its error.

use super::super::View;
use crate::support::rounded::Rounded;
use crate::support::tolerance::U;
use glam::DVec3;
use std::f64::consts::SQRT_2;

/// A vector and the length of its error.
#[derive(Clone, Copy, Debug)]
pub struct Off {
    pub v: DVec3,
    pub e: f64,
}

impl Off {
    /// A point transformed by the view matrix: a product and three sums per axis, 4u of
    /// `|R| |p| + |t|`, with |p| <= |c| + |t|; as a vector, |R| is at most the root of 3.
    pub fn point(v: DVec3, view: &View) -> Self {
        let t = view.view.w_axis.truncate().length();
        let terms = 3.0_f64.sqrt() * (v.length() + t) + t;
        Self { v, e: 4.0 * U * terms }
    }

    /// A direction transformed by the view matrix, without t: 3u.
    pub fn direction(v: DVec3) -> Self {
        Self { v, e: 3.0 * 3.0_f64.sqrt() * U * v.length() }
    }

    /// This point of eye space transformed to the world. The matrix's entries err as its inverse
    /// does.
    pub fn to_world(self, view: &View) -> Self {
        let back = view.view.inverse();
        let terms = 3.0_f64.sqrt() * self.v.length() + back.w_axis.truncate().length();
        Self { v: back.transform_point3(self.v), e: self.e + 16.0 * U * terms }
    }

    /// The whole error may lie across the vector and rotate it. The sum of squares adds 3u/2, the
    /// root by `1 / inversesqrt` 9u, the quotient 5u.
    pub fn normalize(self) -> Self {
        let length = self.v.length();
        let turned = self.e / (length - self.e).max(f64::MIN_POSITIVE);
        Self { v: self.v / length, e: turned + 16.0 * U }
    }

    /// Two products and a difference, 2u of `|a_i b_j| + |a_j b_i|`: as a vector at most 2^(3/2) u
    /// |a| |b|.
    pub fn cross(self, other: Self) -> Self {
        let v = self.v.cross(other.v);
        let (a, b) = (self.v.length(), other.v.length());
        let from = a * other.e + b * self.e + self.e * other.e;
        Self { v, e: from + 2.0 * SQRT_2 * U * a * b }
    }

    /// A product and two sums, 3u.
    pub fn dot(self, other: Self) -> Rounded {
        let (a, b) = (self.v.length(), other.v.length());
        let from = a * other.e + b * self.e + self.e * other.e;
        Rounded { v: self.v.dot(other.v), e: from + 3.0 * U * (a + self.e) * (b + other.e) }
    }

    /// `a (1 - t) + b t` of unit vectors: 3u.
    pub(super) fn mix(self, other: Self, t: Rounded) -> Self {
        let v = self.v.lerp(other.v, t.v);
        let from = self.e * (1.0 - t.v + t.e) + other.e * (t.v + t.e);
        Self { v, e: from + (other.v - self.v).length() * t.e + 3.0 * U }
    }

    /// The length: 3u/2 of the squares, 9u of the root.
    pub fn length(self) -> Rounded {
        let v = self.v.length();
        Rounded { v, e: self.e + 11.0 * U * v }
    }
}

/// A pixel's ray as `pixel scale + offset`, with terms up to 2 / P00 and (1 + |P20|) / P00: two
/// rounded numbers, a product and a sum, 4u.
pub fn ray_off(view: &View, x: usize, y: usize) -> Off {
    let terms = (3.0 + view.shift().abs()) / view.focal().abs();
    Off { v: view.ray(x, y), e: 4.0 * U * terms.length() }
}
