//! Twin of the reduction before the smoothing (thesis Sec. 4.7): water behind the scene is removed,
//! then each block of `2^level` x `2^level` pixels keeps its nearest surface. If that is less than
//! a quarter of the block's water, the block keeps the surface behind it.

use super::{EMPTY, Image};

/// The depth without water at or behind the scene.
pub fn clip(depth: &Image<f64>, scene_eye_depth: Option<&Image<f64>>) -> Image<f64> {
    let Some(scene) = scene_eye_depth else {
        return depth.clone();
    };
    assert_eq!((depth.width, depth.height), (scene.width, scene.height), "extents");
    Image::from_fn(depth.width, depth.height, |x, y| {
        if depth.at(x, y) < scene.at(x, y) { depth.at(x, y) } else { EMPTY }
    })
}

/// Depth of each block; blocks at the right and lower border may be partly outside. Depths and
/// `falloff` are in `f32`: two depths belong to one surface if they differ by at most `falloff`.
/// The sum is rounded as on the device.
pub fn reduce(depth: &Image<f64>, level: u32, falloff: f32) -> Image<f64> {
    let block = 1_usize << level;
    Image::from_fn(depth.width.div_ceil(block), depth.height.div_ceil(block), |x, y| {
        let columns = x * block..((x + 1) * block).min(depth.width);
        let water: Vec<f64> = (y * block..((y + 1) * block).min(depth.height))
            .flat_map(|row| columns.clone().map(move |column| depth.at(column, row)))
            .filter(|z| *z < EMPTY)
            .collect();
        let nearest = water.iter().copied().fold(EMPTY, f64::min);
        let last = f64::from(nearest as f32 + falloff);
        let (own, behind): (Vec<f64>, Vec<f64>) = water.iter().partition(|z| **z <= last);
        let few = 4 * own.len() < water.len();
        if few { behind.into_iter().fold(EMPTY, f64::min) } else { nearest }
    })
}

/// The nearest depth of each block, whatever fraction of the block it is.
pub fn nearest(depth: &Image<f64>, level: u32) -> Image<f64> {
    let block = 1_usize << level;
    Image::from_fn(depth.width.div_ceil(block), depth.height.div_ceil(block), |x, y| {
        let columns = x * block..((x + 1) * block).min(depth.width);
        let rows = y * block..((y + 1) * block).min(depth.height);
        let all = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        all.map(|(x, y)| depth.at(x, y)).fold(EMPTY, f64::min)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scene_hides_what_is_behind_it() {
        let depth = Image::from_vec(4, 1, vec![1.0, 2.0, 3.0, EMPTY]).expect("4 values");
        let scene = Image::new(4, 1, 2.0);
        assert_eq!(clip(&depth, Some(&scene)).data, [1.0, EMPTY, EMPTY, EMPTY]);
        assert_eq!(clip(&depth, None), depth);
    }

    #[test]
    fn a_block_keeps_its_nearest_surface() {
        let depth = Image::from_fn(5, 3, |x, y| if x < 2 { EMPTY } else { (x * 10 + y) as f64 });
        let half = reduce(&depth, 1, 0.5);
        assert_eq!((half.width, half.height), (3, 2));
        assert_eq!(half.data, [EMPTY, 20.0, 40.0, EMPTY, 22.0, 42.0]);
        assert_eq!(reduce(&depth, 2, 2.5).data, [20.0, 40.0]);
        assert_eq!(reduce(&depth, 0, 0.5), depth);
    }

    #[test]
    fn a_drop_does_not_stand_for_a_block() {
        let drop = |pixels: usize| {
            Image::from_fn(4, 4, |x, y| if 4 * y + x < pixels { 1.0 } else { 5.0 + x as f64 })
        };
        assert_eq!(reduce(&drop(3), 2, 0.5).data, [5.0]);
        assert_eq!(reduce(&drop(4), 2, 0.5).data, [1.0]);
        // If the drop is on the same surface as the water behind, it is kept.
        assert_eq!(reduce(&drop(3), 2, 4.0).data, [1.0]);
        assert_eq!(reduce(&drop(1), 1, 0.5).data, [1.0, 7.0, 5.0, 7.0]);
    }
}
