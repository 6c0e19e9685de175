//! Where the bulk of the particles is, whatever a few strays do.

use glam::Vec3;
use whitewater::Region;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: Vec3,
    pub max: Vec3,
}

impl Bounds {
    /// Of the finite particles, without strays: at most 1 in 500 at each end of an axis, and only where they are
    /// far off. `None` where there is no particle.
    pub fn of_bulk(positions: &[[f32; 3]]) -> Option<Self> {
        let mut bounds = Self { min: Vec3::ZERO, max: Vec3::ZERO };
        for axis in 0..3 {
            let mut values: Vec<f32> = positions
                .iter()
                .filter(|p| p.iter().all(|c| c.is_finite()))
                .map(|p| p[axis])
                .collect();
            values.sort_unstable_by(f32::total_cmp);
            let (first, last) = (*values.first()?, *values.last()?);
            let cut = values.len() / 500;
            let (low, high) = (values[cut], values[values.len() - 1 - cut]);
            // What is just outside belongs to the bulk.
            let near = 0.2 * (high - low);
            bounds.min[axis] = first.max(low - near);
            bounds.max[axis] = last.min(high + near);
        }
        Some(bounds)
    }

    pub fn center(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// A ball round it, with some room.
    pub fn region(&self) -> Region {
        let radius = (0.52 * self.size().length()).max(1.0e-6);
        Region { center: self.center().to_array(), radius }
    }

    pub fn contains(&self, p: Vec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Larger by a length on all sides.
    pub fn padded(&self, by: f32) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strays_do_not_count() {
        let mut positions: Vec<[f32; 3]> =
            (0..2000).map(|i| [(i % 20) as f32, (i / 20 % 10) as f32, (i / 200) as f32]).collect();
        positions.push([0.0, 1.0e6, 0.0]);
        positions.push([f32::NAN, 0.0, 0.0]);
        let bounds = Bounds::of_bulk(&positions).unwrap();
        assert_eq!(bounds.min, Vec3::ZERO);
        assert!((bounds.max - Vec3::new(19.0, 9.0, 9.0)).abs().max_element() < 2.0, "{bounds:?}");
        assert_eq!(Bounds::of_bulk(&[]), None);
        assert_eq!(Bounds::of_bulk(&[[f32::NAN; 3]]), None);
    }
}
