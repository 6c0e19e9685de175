//! Bounds of the foam images in single precision, with fixed-point sums.

use super::super::surface_foam::Off;
use super::super::{EMPTY, Image, View};
use super::loose::{LooseSprite, loose_shares};
use super::{Particle, STEP, Settings};
use crate::support::rounded::Rounded;
use crate::support::tolerance::{Between, U};

/// A particle that may be the frontmost foam in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Index of the particle.
    pub particle: usize,
    /// Depth.
    pub depth: Rounded,
    /// Search radius relative to half the picture's height.
    pub h: Rounded,
    /// Normal in world space, with the length of its error.
    pub normal: Off,
}

/// Bounds of [`foam`](super::foam). Fragments that rounding may drop, at the disc's rim, at the
/// scene or at the near plane, are only in the upper bounds.
pub struct Bounds {
    /// Depth of the frontmost foam: `low` of any that may be there, `high` of those that certainly
    /// are.
    pub depth: Between,
    /// Particles that may be the frontmost; if `depth.high` is [`EMPTY`] there may be none.
    pub candidates: Image<Vec<Candidate>>,
    /// The three sums. Each contribution lies between the fixed-point steps to which its ends are
    /// rounded, so rounding adds at most n/2 [`STEP`]s to a sum's error.
    pub sums: [Between; 3],
    /// n, the number of fragments that may be there.
    pub count: Image<u32>,
}

/// Bounds of the images of some particles; `scene` and `fluid` as in [`foam`](super::foam).
pub fn foam_bounds(
    particles: &[Particle],
    view: &View,
    settings: &Settings,
    scene: &Image<f64>,
    fluid: &Image<f64>,
) -> Bounds {
    let (width, height) = (view.width, view.height);
    let none = Image::new(width, height, EMPTY);
    let mut depth = Between { low: none.clone(), high: none };
    let mut candidates = Image::new(width, height, Vec::new());
    let mut ends = Image::new(width, height, [[0.0; 2]; 3]);
    let mut count = Image::new(width, height, 0);
    let back = view.view.inverse();
    for (particle, one) in particles.iter().enumerate() {
        let Some(sprite) = LooseSprite::new(one, view, settings) else { continue };
        for (x, y) in sprite.pixels(view) {
            let Some(fragment) = sprite.meet(x, y, scene.at(x, y)) else { continue };
            let k = fragment.depth;
            let nearest = depth.low.at_mut(x, y);
            *nearest = nearest.min(k.v - k.e);
            if fragment.sure {
                let nearest = depth.high.at_mut(x, y);
                *nearest = nearest.min(k.v + k.e);
            }
            // Three products and their sums.
            let normal = Off {
                v: back.transform_vector3(fragment.normal.v),
                e: fragment.normal.e + 3.0 * 3.0_f64.sqrt() * U,
            };
            let candidate = Candidate { particle, depth: k, h: sprite.h, normal };
            candidates.at_mut(x, y).push(candidate);
            let shares = loose_shares(settings, k, fluid.at(x, y));
            for (sum, share) in ends.at_mut(x, y).iter_mut().zip(shares) {
                let [least, most] = fragment.amount;
                if fragment.sure {
                    sum[0] += in_steps(least * share[0] * (1.0 - U), -1.0);
                }
                sum[1] += in_steps(most * share[1] * (1.0 + U), 1.0);
            }
            *count.at_mut(x, y) += 1;
        }
    }
    for (all, nearest) in candidates.data.iter_mut().zip(&depth.high.data) {
        all.retain(|one: &Candidate| one.depth.v - one.depth.e <= *nearest);
    }
    // The integer sum is converted to single precision.
    let sums = [0, 1, 2].map(|i| Between {
        low: ends.map(|sum| sum[i][0] * (1.0 - U)),
        high: ends.map(|sum| sum[i][1] * (1.0 + U)),
    });
    Bounds { depth, candidates, sums, count }
}

/// Contribution rounded to a step: down for a negative sign, up for a positive one. A half is added
/// before truncation, with or without single precision.
fn in_steps(addend: f64, sign: f64) -> f64 {
    let steps = addend / STEP * (1.0 + sign * 2.0 * U) + 0.5 + sign * 2.0 * U;
    (steps.floor() * STEP).max(0.0)
}
