//! Detects the up axis of files from the position and motion of the water.

use std::collections::HashMap;

use glam::Vec3;
use whitewater::io::particles::{self, Particles};

use crate::bounds::Bounds;

/// Columns that are looked at are so many spacings wide.
const COLUMN: f32 = 3.0;
/// Particles so many spacings from an end of an axis lie at it.
const NEAR: f32 = 2.0;
/// What is no thicker than so many spacings is one layer.
const LAYER: f32 = 0.6;
/// How much more of the water lies on a floor than under a lid of the same kind, so that it is taken for one.
const OPEN: f32 = 0.35;
/// Of the root mean square speed: how fast water as a whole goes up, or down.
const MOVES: f32 = 0.1;
/// The same of water that falls as a whole.
const FALLS: f32 = 0.25;
/// What little of a surface there is, of such water.
const SOME: f32 = 0.03;

/// What an axis looks like as the one that points up.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// Share of the columns along it that begin at its lower end, less those that end at its upper end.
    open: f32,
    /// Mean velocity along it, in root mean square speeds.
    moves: f32,
}

/// Whether z points up in the files and y does not, told by frames of a sequence as they are in the files: water lies on a
/// floor and is open above, and as a whole it comes down. Says what speaks for it. Where both may be up, or neither is told,
/// it is y.
pub fn is_z(frames: &[Particles]) -> Option<&'static str> {
    told(frames).or_else(|| {
        // Water that sinks from frame to frame lies on no floor of all of them: most frames by themselves tell as well.
        let all = frames.iter().map(std::slice::from_ref);
        let said: Vec<_> = all.filter_map(told).collect();
        said.first().copied().filter(|_| 2 * said.len() > frames.len())
    })
}

fn told(frames: &[Particles]) -> Option<&'static str> {
    let [y, z] = [1, 2].map(|axis| look(frames, axis));
    let (y, z) = (y?, z?);
    let lies = z.open >= OPEN && z.moves <= MOVES;
    if lies && z.open - y.open >= OPEN {
        return Some("the water lies at the lower end of z, and is open above");
    }
    // Against a wall it lies as on a floor: it goes away from one, and down on the other. Of a block that has just begun to
    // fall the surface is nearly a lid.
    let from_wall = lies && z.moves < -MOVES && y.moves > MOVES;
    let falls = z.moves < -FALLS && y.moves.abs() < MOVES && z.open - y.open > SOME;
    if from_wall || falls {
        return Some("the water comes down along z");
    }
    None
}

/// Across which axis all particles of all frames lie in one layer: they are two-dimensional.
pub fn flat(frames: &[Particles]) -> Option<usize> {
    let mut found = [true; 3];
    for frame in frames {
        let spacing = particles::estimate_spacing(&crate::bounds::together(&frame.positions))?;
        let size = Bounds::of_bulk(&frame.positions)?.size();
        (0..3).for_each(|axis| found[axis] &= size[axis] < LAYER * spacing);
    }
    // A line, or a point, lies in many planes.
    let mut flat = (0..3).filter(|axis| found[*axis] && !frames.is_empty());
    flat.next().filter(|_| flat.next().is_none())
}

fn look(frames: &[Particles], axis: usize) -> Option<Axis> {
    let bounds = frames.iter().filter_map(|f| Bounds::of_bulk(&f.positions));
    let bounds = bounds.reduce(|a, b| a.union(&b))?;
    let (mut shares, mut moves) = (Vec::new(), Vec::new());
    for frame in frames {
        let inside: Vec<Vec3> = frame.positions.iter().map(|p| Vec3::from(*p)).collect();
        let spacing = particles::estimate_spacing(&crate::bounds::together(&frame.positions))?;
        let mut columns: HashMap<[i64; 2], [f32; 2]> = HashMap::new();
        let across = [(axis + 1) % 3, (axis + 2) % 3];
        for p in inside.iter().filter(|p| bounds.contains(**p)) {
            let at = across.map(|axis| (p[axis] / (COLUMN * spacing)).floor() as i64);
            let [low, high] = columns.entry(at).or_insert([f32::INFINITY, f32::NEG_INFINITY]);
            (*low, *high) = (low.min(p[axis]), high.max(p[axis]));
        }
        let of = |near: &dyn Fn(&[f32; 2]) -> bool| {
            columns.values().filter(|ends| near(ends)).count() as f32 / columns.len().max(1) as f32
        };
        let reach = NEAR * spacing;
        let lies = of(&|[low, _]| low - bounds.min[axis] < reach);
        let lid = of(&|[_, high]| bounds.max[axis] - high < reach);
        shares.push(lies - lid);
        if let Some(velocities) = &frame.velocities {
            let velocities = velocities.iter().map(|v| Vec3::from(*v)).filter(|v| v.is_finite());
            let (sum, squares, count) = velocities
                .fold((Vec3::ZERO, 0.0, 0_u32), |(s, q, n), v| {
                    (s + v, q + v.length_squared(), n + 1)
                });
            let mean = sum[axis] / count.max(1) as f32;
            moves.push(mean / (squares / count.max(1) as f32).sqrt().max(f32::MIN_POSITIVE));
        }
    }
    let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len().max(1) as f32;
    Some(Axis { open: mean(&shares), moves: mean(&moves) })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: f32 = 0.05;

    /// Water on a floor that slopes away from a wall, and velocities: along, across and up.
    fn dam(turn: impl Fn([f32; 3]) -> [f32; 3], moves: bool) -> Particles {
        let cells =
            (0..40).flat_map(|x| (0..12).flat_map(move |y| (0..20).map(move |z| (x, y, z))));
        let wet = cells.filter(|(x, _, z)| *z as f32 <= 19.0 - 0.5 * *x as f32);
        let at = wet.map(|(x, y, z)| [x, y, z].map(|i| SPACING * i as f32));
        let mut dam = Particles::from_positions(at.map(&turn).collect());
        dam.velocities = moves.then(|| vec![turn([1.0, 0.0, -0.6]); dam.positions.len()]);
        dam
    }

    #[test]
    fn sheets_are_told() {
        let sheet = |across: usize| {
            let at = |i: usize| {
                let mut p = [SPACING * (i % 30) as f32, SPACING * (i / 30) as f32, 0.0];
                p.swap(across, 2);
                p
            };
            [Particles::from_positions((0..600).map(at).collect())]
        };
        for across in 0..3 {
            assert_eq!(flat(&sheet(across)), Some(across));
        }
        let [mut thick] = sheet(2);
        thick.positions.push([0.3, 0.3, SPACING]);
        thick.positions.extend((0..20).map(|i| [0.3, SPACING * i as f32, SPACING]));
        assert_eq!(flat(&[thick]), None);
        let line = (0..50).map(|i| [SPACING * i as f32, 0.0, 0.0]).collect();
        assert_eq!(flat(&[Particles::from_positions(line)]), None);
        assert_eq!(flat(&[]), None);
    }

    #[test]
    fn water_lies_on_the_floor() {
        let z_up = |p: [f32; 3]| p;
        let y_up = |[x, y, z]: [f32; 3]| [x, z, -y];
        assert!(is_z(&[dam(z_up, false)]).is_some());
        assert!(is_z(&[dam(z_up, true)]).is_some());
        assert_eq!(is_z(&[dam(y_up, false)]), None);
        assert_eq!(is_z(&[dam(y_up, true)]), None);
        // The dam breaks along the axis that may be taken for the one that is up: how it moves tells.
        let z_up = |[x, y, z]: [f32; 3]| [y, x, z];
        let y_up = |[x, y, z]: [f32; 3]| [y, z, x];
        assert!(is_z(&[dam(z_up, true)]).is_some());
        assert_eq!(is_z(&[dam(y_up, true)]), None);
        assert_eq!(is_z(&[dam(z_up, false)]), None, "nothing tells: y");
        assert_eq!(is_z(&[dam(y_up, false)]), None);
        // A block that falls, of whose surface a part has sunk.
        let sunk = |turn: &dyn Fn([f32; 3]) -> [f32; 3]| {
            let at = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|i| SPACING * i as f32));
            let at = at.filter(|[x, _, z]| *x < 0.33 || *z < 0.33);
            let mut block = Particles::from_positions(at.map(turn).collect());
            block.velocities = Some(vec![turn([0.3, 0.0, -0.5]); block.positions.len()]);
            is_z(&[block]).is_some()
        };
        assert!(sunk(&|p| p));
        assert!(!sunk(&|[x, y, z]| [x, z, -y]));
        // Water that goes through its floor, from frame to frame.
        let sinking = |turn: &dyn Fn([f32; 3]) -> [f32; 3]| {
            let frame =
                |i: usize| dam(|[x, y, z]| turn([x, y, z - 3.0 * SPACING * i as f32]), false);
            is_z(&[frame(0), frame(1), frame(2)]).is_some()
        };
        assert!(sinking(&|p| p));
        assert!(!sinking(&|[x, y, z]| [x, z, -y]));
        // A block, and nothing.
        let block = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|i| SPACING * i as f32));
        assert_eq!(is_z(&[Particles::from_positions(block.collect())]), None);
        assert_eq!(is_z(&[Particles::from_positions(Vec::new())]), None);
        assert_eq!(is_z(&[]), None);
    }
}
