//! Spray in the picture: screen-space self-shadowing (relief), and spray over what is behind it.

use super::super::{Image, View};
use super::at_least;
use crate::support::rounded::{self, Rounded, exact, off};
use crate::support::tolerance::U;
use glam::{DVec2, DVec3};

/// Relief: the nearest distance in picture heights, the number of distances, and the optical depth
/// that counts as thin.
const RELIEF: (f64, u32, f64) = (1.0 / 360.0, 5, 0.3);
/// Fraction by which relief reduces the sky's light.
const RELIEF_OF_SKY: f64 = 0.19;
/// Sums count up to the largest half float, because infinite ones would give no number.
const MOST_HALF: f64 = 65_504.0;

/// Logarithm of a positive number: errs by 2^-21 from 1/2 to 2, elsewhere by 3 ulp.
fn ln(x: Rounded) -> Rounded {
    let v = x.v.ln();
    let own = if (0.49..=2.01).contains(&x.v) { 8.0 } else { 6.0 * v.abs() };
    Rounded { v, e: x.e / (x.v - x.e) + own * U }
}

/// Relief of spray: its strength, and the direction to the sun in pixels of the screen, or 0.
#[derive(Clone, Copy, Debug)]
pub struct Relief {
    pub strength: f64,
    pub toward: DVec2,
}

impl Relief {
    /// `sun`: direction to the sun in world space.
    pub fn new(strength: f64, sun: DVec3, view: &View) -> Self {
        let toward = view.view.transform_vector3(sun.normalize()).truncate() / view.slope_step();
        Self { strength, toward: toward.normalize_or_zero() }
    }

    /// Fraction of sunlight in the spray of a pixel with relief, from the optical depths of all
    /// spray and of its lit part.
    pub fn lit(&self, all: &Image<f32>, lit: &Image<f32>, (x, y): (usize, usize)) -> Rounded {
        let of = |image: &Image<f32>, x, y| f64::from(image.clamped(x, y)).min(MOST_HALF);
        let own = of(all, x as isize, y as isize);
        let part = exact(of(lit, x as isize, y as isize)) / exact(own);
        if self.strength == 0.0 {
            return part;
        }
        let (near, octaves, thin) = RELIEF;
        let thin = off(thin, 1.0);
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let mut sum = exact(0.0);
        for i in 0..octaves {
            let away = self.toward * near * all.height as f64 * f64::from(1 << i);
            let there = at + away;
            // Position rounding may select a neighbouring texel, in columns and in rows.
            let loose = 16.0 * U * (there.abs().max_element() + away.length() + 1.0) + 1.0e-4;
            let mut logs = [-1.0, 1.0].into_iter().flat_map(|i| {
                [-1.0, 1.0].map(|j| {
                    let place = (there + DVec2::new(i, j) * loose).floor();
                    ln(thin + exact(of(all, place.x as isize, place.y as isize)))
                })
            });
            let first = logs.next().expect("four");
            let [mut low, mut high] = [first.v - first.e, first.v + first.e];
            for log in logs {
                (low, high) = (low.min(log.v - log.e), high.max(log.v + log.e));
            }
            sum = sum + Rounded { v: 0.5 * (low + high), e: 0.5 * (high - low) };
        }
        let denser = sum / exact(f64::from(octaves)) - ln(thin + exact(own));
        let factor = (-(off(self.strength, 1.0) * denser)).exp();
        let (lit, most) = (part * factor, at_least(part, exact(1.0)));
        // Far enough above its maximum, the value is the maximum.
        let above = lit.v - lit.e > most.v + most.e;
        let e = if above { most.e } else { lit.e.max(most.e) };
        Rounded { v: lit.v.min(most.v), e }
    }

    /// Light with relief, divided by the sun's; `sky`: the sky's light divided by the sun's.
    pub fn light(&self, lit: Rounded, sky: f64) -> Rounded {
        let sky = off(sky, 5.0);
        let under = rounded::mix(sky, exact(1.0), lit);
        let dull = off(RELIEF_OF_SKY, 1.0) * off(self.strength, 1.0);
        under * (exact(1.0) - dull * (exact(1.0) - lit).clamp(0.0, 1.0))
    }
}

/// A colour channel behind spray of this optical depth and light, and its error in single
/// precision: exp errs by 3 + 2x ulp, a difference and five products are added, for each of the two
/// terms.
pub fn over(behind: f64, spray: f64, light: Rounded, additive: bool) -> (f64, f64) {
    let k = (-spray).exp();
    let v = behind * if additive { 1.0 } else { k } + light.v * (1.0 - k);
    (v, light.e * (1.0 - k) + U * (12.0 + 4.0 * spray) * (behind.abs() + light.v))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A dense strip shades the spray behind it, seen from the sun, and its own side facing the sun
    /// is brighter. Uniform spray has no relief.
    #[test]
    fn relief_is_on_the_side_away_from_the_sun() {
        let strip =
            Image::from_fn(90, 80, |x, _| if (40..48).contains(&x) { 2.0_f32 } else { 0.2 });
        let lit = strip.map(|x| 0.5 * x);
        let of = |image: &Image<f32>, lit: &Image<f32>, x| {
            let relief = Relief { strength: 1.0, toward: DVec2::X };
            relief.lit(image, lit, (x, 40)).v
        };
        // The farthest sample is 3.6 texels away.
        assert!(of(&strip, &lit, 38) < 0.35 && (of(&strip, &lit, 50) - 0.5).abs() < 1e-9);
        assert!(of(&strip, &lit, 46) > 0.6 && (of(&strip, &lit, 42) - 0.5).abs() < 1e-9);
        let even = strip.map(|_| 0.7);
        assert!((of(&even, &even.map(|x| 0.25 * x), 3) - 0.25).abs() < 1e-7);
    }
}
