//! Twin of the selection of smoothing levels. A surface that needs n iterations at the first level
//! (as in `smooth::plan`, without the additional ones) needs n / 4^k at level k. Up to n of a
//! quarter of the cap (without the additional ones) the first level is shown; up to half the cap
//! the second fades in; from there to the whole cap the second is shown, which needs at most a
//! quarter of the cap, and so on. A level is smoothed where it is shown, or would be if n were a
//! quarter larger or a fifth smaller.

use glam::DVec2;

use super::smooth::{MORE, Params};
use super::{Image, View, is_surface};

/// The levels of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// View of the frame at full resolution.
    pub view: View,
    /// The configured level.
    pub first: u32,
    /// Number of coarser levels.
    pub coarser: u32,
    /// Settings of the smoothing, with the cap.
    pub params: Params,
}

impl Levels {
    /// n divided by a quarter of the cap.
    pub fn nearness(&self, slope: DVec2, depth: f64) -> f64 {
        let (x, y) = (self.view.c_x(), self.view.c_y());
        let sigma = self.params.sigma_w / (x * depth * f64::from(1 << self.first));
        let shape = (x / y).powi(2);
        let spread = 1.0 + slope.x.powi(2) + (1.0 + slope.y.powi(2)) * shape;
        4.0 * spread * sigma * sigma / (f64::from(self.params.cap) - MORE).max(1.0)
    }

    /// The nearness of a pixel at full resolution.
    pub fn nearness_at(&self, (x, y): (usize, usize), depth: f64) -> f64 {
        self.nearness(self.view.ray(x, y).truncate(), depth)
    }

    /// The shown level, counted from the first, and the fraction of the next coarser one.
    pub fn shown(&self, nearness: f64) -> (usize, f64) {
        let coarser = self.coarser as usize;
        for level in 0..coarser {
            // The next level fades in from 1 to 2, 4 to 8, 16 to 32.
            let own = nearness / 4.0_f64.powi(level as i32);
            if own < 2.0 {
                let part = own.max(1.0).log2();
                return (level, part * part * (3.0 - 2.0 * part));
            }
        }
        (coarser, 0.0)
    }

    /// Whether a level, counted from the first, is smoothed at this nearness; it may be the finest
    /// or the coarsest of its sheet.
    pub fn is_wanted(&self, nearness: f64, level: u32, finest: bool, coarsest: bool) -> bool {
        let own = nearness / 4.0_f64.powi(level as i32);
        (finest || own >= 0.25 / 1.25) && (coarsest || own <= 2.0 * 1.25)
    }

    /// The coarsest level that each tile of the first level needs (16x16 texels): by the nearest
    /// water in it, if that needed a quarter more iterations. `depth`: at full resolution.
    pub fn needed(&self, depth: &Image<f64>) -> Image<u32> {
        let texels = self.view.reduced(self.first);
        let blocks = super::reduce::nearest(depth, self.first);
        let near = Image::from_fn(texels.width, texels.height, |x, y| {
            let nearest = blocks.at(x, y);
            let slope = texels.ray(x, y).truncate();
            if is_surface(nearest) { self.nearness(slope, nearest) } else { 0.0 }
        });
        let tiles = |n: usize| n.div_ceil(16);
        Image::from_fn(tiles(texels.width), tiles(texels.height), |x, y| {
            let rows = y * 16..((y + 1) * 16).min(near.height);
            let columns = x * 16..((x + 1) * 16).min(near.width);
            let all = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
            let nearest = all.map(|(x, y)| near.at(x, y)).fold(0.0, f64::max);
            let needs = |level: &u32| 1.25 * nearest >= 4.0_f64.powi(*level as i32 - 1);
            (1..=self.coarser).filter(needs).max().unwrap_or(0)
        })
    }

    /// Whether a tile of a coarser level is computed: if any tile under it needs the level.
    pub fn is_made(&self, needed: &Image<u32>, level: u32, (x, y): (usize, usize)) -> bool {
        let side = 1_usize << level;
        let rows = y * side..((y + 1) * side).min(needed.height);
        let columns = x * side..((x + 1) * side).min(needed.width);
        let mut under = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        under.any(|(x, y)| needed.at(x, y) >= level)
    }

    /// A coarser level's image without remains of earlier frames, which are more than a tile away
    /// from computed tiles.
    pub fn made<T: Copy + Send + Sync>(
        &self,
        needed: &Image<u32>,
        level: u32,
        of: &Image<T>,
        none: T,
    ) -> Image<T> {
        let beside = |tile: usize| tile.saturating_sub(1)..tile + 2;
        Image::from_fn(of.width, of.height, |x, y| {
            let mut round = beside(y / 16).flat_map(|y| beside(x / 16).map(move |x| (x, y)));
            if round.any(|tile| self.is_made(needed, level, tile)) { of.at(x, y) } else { none }
        })
    }
}

/// The smoothed surfaces of a frame: of the first level, then of the coarser ones.
pub struct Smoothed<'a> {
    pub levels: Levels,
    pub surfaces: Vec<&'a Image<f32>>,
}

impl Smoothed<'_> {
    /// Depth of the surface in a pixel, from the level with the larger weight.
    pub fn at(&self, at: (usize, usize), front: f32, falloff: f32) -> f64 {
        let Levels { first, .. } = self.levels;
        let (level, fade) = self.levels.shown(self.levels.nearness_at(at, f64::from(front)));
        let level = if fade < 0.5 { level } else { level + 1 };
        let edge = 1 << (first as usize + level);
        super::motion::smoothed_at((self.surfaces[level], edge), at, front, falloff)
    }
}
