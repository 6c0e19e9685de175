//! Twin of the reduction before the smoothing (section 5): what the scene hides is cut away, then
//! the nearest surface of each block of `2^level` pixels is kept.

use super::{EMPTY, Image};

/// The depth without what lies at or behind the scene.
pub fn clip(depth: &Image<f64>, scene_eye_depth: Option<&Image<f64>>) -> Image<f64> {
    let Some(scene) = scene_eye_depth else {
        return depth.clone();
    };
    assert_eq!((depth.width, depth.height), (scene.width, scene.height), "extents");
    Image::from_fn(depth.width, depth.height, |x, y| {
        if depth.at(x, y) < scene.at(x, y) { depth.at(x, y) } else { EMPTY }
    })
}

/// The nearest depth of each block; at the right and lower border a block may be partly outside.
pub fn reduce(depth: &Image<f64>, level: u32) -> Image<f64> {
    let block = 1_usize << level;
    Image::from_fn(depth.width.div_ceil(block), depth.height.div_ceil(block), |x, y| {
        let columns = x * block..((x + 1) * block).min(depth.width);
        (y * block..((y + 1) * block).min(depth.height))
            .flat_map(|row| columns.clone().map(move |column| (column, row)))
            .fold(EMPTY, |nearest, (column, row)| nearest.min(depth.at(column, row)))
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
        let half = reduce(&depth, 1);
        assert_eq!((half.width, half.height), (3, 2));
        assert_eq!(half.data, [EMPTY, 20.0, 40.0, EMPTY, 22.0, 42.0]);
        assert_eq!(reduce(&depth, 2).data, [20.0, 40.0]);
        assert_eq!(reduce(&depth, 0), depth);
    }
}
