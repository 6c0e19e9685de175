//! Bounds of the foam images for single precision and fixed-point sums.

use super::super::surface_foam::Off;
use super::super::{EMPTY, Image, View};
use super::loose::{LooseSprite, loose_shares};
use super::{Particle, STEP, Settings};
use crate::support::rounded::Rounded;
use crate::support::tolerance::{Between, U};

/// What may be the nearest foam in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Which of the particles.
    pub particle: usize,
    /// Its depth.
    pub depth: Rounded,
    /// Its search radius over half the height of the picture.
    pub h: Rounded,
    /// Its normal in the world, and the length of the error.
    pub normal: Off,
}

/// Bounds of [`foam`](super::foam). What may or may not be there, by the rim of its disc, the scene
/// or the near plane, is in the upper ones alone.
pub struct Bounds {
    /// The depth of the nearest: `low` of any that may be there, `high` of those that surely are.
    pub depth: Between,
    /// What may be the nearest; there is none for sure where `depth.high` is [`EMPTY`].
    pub candidates: Image<Vec<Candidate>>,
    /// Of the three sums. Each addend is between the whole steps that its ends are rounded to:
    /// beyond what is known of the addends a sum is off by no more than n/2 [`STEP`]s.
    pub sums: [Between; 3],
    /// n, fragments that may be there.
    pub count: Image<u32>,
}

/// Bounds of the images of some particles, `scene` and `fluid` as in [`foam`](super::foam).
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
    // The sum of steps becomes a number of single precision.
    let sums = [0, 1, 2].map(|i| Between {
        low: ends.map(|sum| sum[i][0] * (1.0 - U)),
        high: ends.map(|sum| sum[i][1] * (1.0 + U)),
    });
    Bounds { depth, candidates, sums, count }
}

/// What an addend may be rounded to, at least or at most by the sign: it and a half are added in
/// single precision, or not.
fn in_steps(addend: f64, sign: f64) -> f64 {
    let steps = addend / STEP * (1.0 + sign * 2.0 * U) + 0.5 + sign * 2.0 * U;
    (steps.floor() * STEP).max(0.0)
}
