//! Frames whose unit of length differs from that of the others.

use crate::looks::round;
use crate::surface_foam::quantile;

/// Number of particles from which the extent is found.
const LOOKED_AT: usize = 4096;
/// Part of the particles at each end of an axis that do not count.
const ENDS: f64 = 0.05;
/// Max difference of the spacings' ratio from a power of ten, and of the extents' ratio, as decimal logarithms. Water
/// that spreads has other extents, but about the same spacing.
const NEAR: f32 = 0.2;
const ABOUT: f32 = 0.6;

/// The size of a frame's water, in one unit for all frames.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    pub number: u64,
    pub extent: f32,
}

impl Size {
    /// `None` if the particles have no extent.
    pub fn of(number: u64, positions: &[[f32; 3]]) -> Option<Self> {
        let step = positions.len().div_ceil(LOOKED_AT).max(1);
        let axis = |axis: usize| {
            let some = positions.iter().step_by(step).map(|p| p[axis]);
            let some: Vec<f32> = some.filter(|c| c.is_finite()).collect();
            Some(quantile(some.clone(), 1.0 - ENDS)? - quantile(some, ENDS)?)
        };
        let extent = (0..3).filter_map(axis).fold(0.0, f32::max);
        (extent > 0.0 && extent.is_finite()).then_some(Self { number, extent })
    }

    /// Of several frames, the one in the middle by extent.
    pub fn usual(mut all: Vec<Self>) -> Option<Self> {
        all.sort_by(|a, b| a.extent.total_cmp(&b.extent));
        all.get(all.len() / 2).copied()
    }

    /// A warning if this frame is in another unit than the usual one. `spacing` finds the spacing of this frame and of the
    /// usual one; it takes longer than the extent, and is asked for only if the extents differ.
    pub fn told(self, usual: &Self, spacing: impl FnOnce() -> [Option<f32>; 2]) -> Option<String> {
        let wider = (self.extent / usual.extent).log10();
        if self.number == usual.number || wider.abs() < 1.0 - ABOUT {
            return None;
        }
        let [own, other] = spacing();
        let ratio = own? / other?;
        let (power, of) = (ratio.log10(), ratio.log10().round());
        let fits = of != 0.0 && (power - of).abs() <= NEAR && (wider - of).abs() <= ABOUT;
        let (number, other) = (self.number, usual.number);
        fits.then(|| {
            format!(
                "the particles of frame {number} lie {} times as far apart as those of frame {other}, and the water is \
                 larger by about as much: another unit of length? Write frame {number} in the unit of the others \
                 (--unit and --scale convert all frames alike)",
                round(ratio)
            )
        })
    }
}

/// One line for the warnings about several frames.
pub fn together(mut all: impl Iterator<Item = String>) -> Option<String> {
    let first = all.next()?;
    Some(match all.count() {
        0 => first,
        more => format!("{first}; so do those of {more} other frames"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitewater::io::particles::estimate_spacing;

    /// A block of n³ particles with this spacing.
    fn block(n: usize, spacing: f32) -> Vec<[f32; 3]> {
        (0..n * n * n).map(|i| [i % n, i / n % n, i / n / n].map(|c| c as f32 * spacing)).collect()
    }

    #[test]
    fn frames_in_other_units_are_told() {
        let size = |number: u64, positions: &[[f32; 3]]| Size::of(number, positions).unwrap();
        let meters = block(10, 0.02);
        let usual = size(3, &meters);
        let told = |positions: &[[f32; 3]]| {
            size(7, positions).told(&usual, || [positions, &meters].map(estimate_spacing))
        };
        for (ratio, words) in
            [(1000.0, "lie 1000 times"), (100.0, "lie 100 times"), (0.001, "lie 0.001 times")]
        {
            let told = told(&block(10, 0.02 * ratio)).unwrap();
            assert!(told.contains("frame 7") && told.contains("of frame 3"), "{told}");
            assert!(told.contains(words), "{told}");
        }
        // More water of the same particles, finer particles in the same box, and water that spreads.
        assert_eq!(told(&block(30, 0.02)), None);
        assert_eq!(told(&block(40, 0.005)), None);
        let wide: Vec<_> = meters.iter().map(|[x, y, z]| [20.0 * x, 0.3 * y, 0.3 * z]).collect();
        assert_eq!(told(&wide), None);
        assert!(Size::of(1, &[[0.0; 3]]).is_none());
        let all = [0.02, 0.021, 20.0, 0.019].map(|spacing| size(1, &block(4, spacing)));
        assert!(Size::usual(all.into()).unwrap().extent < 0.1);
    }
}
