//! The foam images: the frontmost particle, and sums over all particles.

use super::super::{Image, View};
use super::sprite::Sprite;
use super::{Particle, Settings};
use glam::DVec3;

/// The frontmost foam in a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Depth.
    pub depth: f64,
    /// h, the particle's search radius relative to half the picture's height.
    pub h: f64,
    /// Normal in world space.
    pub normal: DVec3,
}

/// The images of foam.
#[derive(Clone, Debug)]
pub struct Foam {
    /// The frontmost foam.
    pub front: Image<Option<Seen>>,
    /// Thickness above the fluid's surface, below it, and below it weighted by the distance.
    pub sums: Image<[f64; 3]>,
    /// Number of fragments.
    pub count: Image<u32>,
}

/// The images of some particles. `scene`: eye depth of the scene, `fluid`: eye depth of the fluid's
/// surface, both [`EMPTY`](super::super::EMPTY) where there is nothing.
pub fn foam(
    particles: &[Particle],
    view: &View,
    settings: &Settings,
    scene: &Image<f64>,
    fluid: &Image<f64>,
) -> Foam {
    let mut front = Image::new(view.width, view.height, None::<Seen>);
    let mut sums = Image::new(view.width, view.height, [0.0; 3]);
    let mut count = Image::new(view.width, view.height, 0);
    let back = view.view.inverse();
    for sprite in particles.iter().filter_map(|p| Sprite::new(p, view, settings)) {
        for (x, y) in sprite.pixels(view) {
            let Some(fragment) = sprite.meet(x, y) else { continue };
            if fragment.depth >= scene.at(x, y) {
                continue;
            }
            let nearest = front.at_mut(x, y);
            if nearest.is_none_or(|seen| fragment.depth < seen.depth) {
                let normal = back.transform_vector3(fragment.normal);
                *nearest = Some(Seen { depth: fragment.depth, h: sprite.h, normal });
            }
            let shares = settings.shares(fragment.depth, fluid.at(x, y));
            for (sum, share) in sums.at_mut(x, y).iter_mut().zip(shares) {
                *sum += fragment.amount * share;
            }
            *count.at_mut(x, y) += 1;
        }
    }
    Foam { front, sums, count }
}
