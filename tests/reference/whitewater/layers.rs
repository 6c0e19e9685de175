//! The foam images: the nearest particle, and sums over all.

use super::super::{Image, View};
use super::sprite::Sprite;
use super::{Particle, Settings};
use glam::DVec3;

/// The nearest foam in a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Its depth.
    pub depth: f64,
    /// h, the search radius of its particle over half the height of the picture.
    pub h: f64,
    /// Its normal in the world.
    pub normal: DVec3,
}

/// The images of foam.
#[derive(Clone, Debug)]
pub struct Foam {
    /// The nearest.
    pub front: Image<Option<Seen>>,
    /// Thickness above the fluid's surface, below it, and below it by how far.
    pub sums: Image<[f64; 3]>,
    /// Fragments.
    pub count: Image<u32>,
}

/// The images of some particles. `scene`: the eye depth of what hides them, `fluid`: that of the
/// fluid's surface, both [`EMPTY`](super::super::EMPTY) where there is nothing.
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
