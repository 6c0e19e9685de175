//! Detects the up axis of files from the position and motion of the water.

use std::collections::HashMap;

use glam::Vec3;
use whitewater::io::particles::Particles;

use crate::args::Up;
use crate::bounds::Extent;

/// Width in spacings of the columns in which water is measured.
const COLUMN: f32 = 3.0;
/// Distance in spacings from an end of an axis within which particles count as being at that end.
const NEAR: f32 = 2.0;
/// Max thickness in spacings of a single layer.
const LAYER: f32 = 0.6;
/// Water lies on a floor at the lower end of an axis if [`Axis::open`] is at least this. `open`: the share of the
/// columns of water along the axis that touch the lower end, minus the share that touch the upper end.
const OPEN: f32 = 0.35;
/// Min mean velocity along an axis, relative to the root mean square speed, from which the water counts as moving
/// along the axis as a whole.
const MOVES: f32 = 0.1;
/// The same for water that falls as a whole.
const FALLS: f32 = 0.25;
/// Min difference of [`Axis::open`] between two axes for water that falls as a whole. It is small, because such water
/// has little open surface.
const SOME: f32 = 0.03;

/// Evidence for an axis as the up axis.
#[derive(Clone, Copy, Debug)]
struct Axis {
    up: Up,
    /// Share of the columns of water along the axis that touch the axis' lower end, minus the share that touch its
    /// upper end.
    open: f32,
    /// Mean velocity along the axis, relative to the root mean square speed.
    moves: f32,
}

impl Axis {
    /// The evidence for the opposite direction.
    fn against(self) -> Self {
        Self { up: Up::along(self.up.axis(), true), open: -self.open, moves: -self.moves }
    }

    /// Whether water lies at the lower end and is open above.
    fn lies(&self) -> bool {
        self.open >= OPEN && self.moves <= MOVES
    }

    fn found(&self, lies: bool) -> Found {
        let falls = self.moves < -MOVES;
        let name = self.up.name();
        let (end, axis) = match name.strip_prefix('-') {
            Some(axis) => ("upper", axis),
            None => ("lower", name),
        };
        let why = match (lies, falls, end) {
            (false, _, _) => format!("the water comes down along {name}"),
            (true, true, _) => {
                format!("the water lies at the {end} end of {axis}, and comes down towards it")
            }
            (true, false, "lower") => {
                format!("the water lies at the lower end of {axis}, and is open above")
            }
            (true, false, _) => {
                format!("the water lies at the upper end of {axis}, its open side at the lower")
            }
        };
        Found { up: self.up, why, sure: if lies && falls { CLEAR } else { LIKELY } }
    }
}

/// Position and motion agree.
const CLEAR: &str = "clear";
/// Only one of position and motion shows it.
const LIKELY: &str = "likely";

/// The up axis of files.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    pub up: Up,
    /// The reason, for the user.
    pub why: String,
    pub sure: &'static str,
}

/// Detects the up axis from frames of a sequence in the files' coordinates: water lies on a floor, is open above, and
/// moves down as a whole. Only y, -y, z and -z are candidates. x is none, because dams often break along x and then
/// move like falling water. `extents` has the extent of each frame. `None` if the evidence is missing or ambiguous;
/// callers then assume y.
pub fn find(frames: &[Particles], extents: &[Extent]) -> Option<Found> {
    let across = flat(extents);
    let of = |frames: &[Particles], extents: &[Extent]| {
        let asked = [1, 2].into_iter().filter(|axis| across != Some(*axis));
        asked.map(|axis| look(frames, extents, axis)).collect::<Option<Vec<_>>>()
    };
    let axes = of(frames, extents)?;
    let by_frames = || {
        // Water that sinks from frame to frame lies on no common floor. Then each frame is looked at by itself, and
        // the majority decides.
        if frames.len() < 2 {
            return None;
        }
        let all = frames.chunks(1).zip(extents.chunks(1));
        let said: Vec<_> = all.filter_map(|(one, extent)| other(&of(one, extent)?)).collect();
        let first = said.first()?;
        let same = said.iter().filter(|found| found.up == first.up).count();
        (2 * same > frames.len()).then(|| first.clone())
    };
    let usual = || match (across, axes.as_slice()) {
        (Some(1), _) => Some(Found {
            up: Up::Z,
            why: "the particles are two-dimensional, in the plane of x and z".into(),
            sure: LIKELY,
        }),
        (_, [y, ..]) => y.lies().then(|| y.found(true)),
        _ => None,
    };
    other(&axes).or_else(by_frames).or_else(usual)
}

/// Returns the up axis if the evidence shows that it is z, -y or -z, else `None`. `axes`: the evidence for y and z,
/// or for one of them.
fn other(axes: &[Axis]) -> Option<Found> {
    if let [y, z] = axes {
        if z.lies() && z.open - y.open >= OPEN {
            return Some(z.found(true));
        }
        // `from_wall`: water that leans on a wall looks like water on a floor, and motion decides, because it moves
        // away from the wall and down towards the floor. `falls`: a block that has just begun to fall has almost no
        // open surface.
        let from_wall = z.lies() && z.moves < -MOVES && y.moves > MOVES;
        let falls = z.moves < -FALLS && y.moves.abs() < MOVES && z.open - y.open > SOME;
        if from_wall || falls {
            return Some(z.found(from_wall));
        }
    }
    // Files whose axis points down are rare, so more evidence is needed.
    axes.iter().find_map(|axis| {
        let against = axis.against();
        let mut others = axes.iter().filter(|other| other.up != axis.up);
        let clear = others.clone().all(|other| against.open - other.open.abs() >= OPEN);
        let from_wall =
            against.moves < -FALLS && others.all(|other| other.moves * other.open.signum() > MOVES);
        (against.lies() && (clear || from_wall)).then(|| against.found(true))
    })
}

/// If all particles of all frames form a single layer, that is, if they are two-dimensional, the axis perpendicular
/// to the layer. `extents` has the extent of each frame.
pub fn flat(extents: &[Extent]) -> Option<usize> {
    let mut found = [true; 3];
    for extent in extents {
        let (spacing, size) = (extent.spacing?, extent.bulk?.size());
        (0..3).for_each(|axis| found[axis] &= size[axis] < LAYER * spacing);
    }
    // A line or a point lies in several planes.
    let mut flat = (0..3).filter(|axis| found[*axis] && !extents.is_empty());
    flat.next().filter(|_| flat.next().is_none())
}

fn look(frames: &[Particles], extents: &[Extent], axis: usize) -> Option<Axis> {
    let bounds = extents.iter().filter_map(|extent| extent.bulk).reduce(|a, b| a.union(&b))?;
    let (mut shares, mut moves) = (Vec::new(), Vec::new());
    for (frame, extent) in frames.iter().zip(extents) {
        let inside: Vec<Vec3> = frame.positions.iter().map(|p| Vec3::from(*p)).collect();
        let spacing = extent.spacing?;
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
    Some(Axis { up: Up::along(axis, false), open: mean(&shares), moves: mean(&moves) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extents(frames: &[Particles]) -> Vec<Extent> {
        frames.iter().map(|frame| Extent::of(&frame.positions)).collect()
    }

    fn find(frames: &[Particles]) -> Option<Found> {
        super::find(frames, &extents(frames))
    }

    fn flat(frames: &[Particles]) -> Option<usize> {
        super::flat(&extents(frames))
    }

    fn is_z(frames: &[Particles]) -> Option<Found> {
        find(frames).filter(|found| found.up == Up::Z)
    }

    const SPACING: f32 = 0.05;

    /// For tests: water on a floor, with a surface that slopes down from a wall. `turn` converts coordinates (along
    /// the slope, across it, upwards) to those of a file. If `moves` is true, the water has a velocity away from the
    /// wall and down.
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
        // The dam breaks along the other axis that could be the up axis; the motion decides.
        let z_up = |[x, y, z]: [f32; 3]| [y, x, z];
        let y_up = |[x, y, z]: [f32; 3]| [y, z, x];
        assert!(is_z(&[dam(z_up, true)]).is_some());
        assert_eq!(is_z(&[dam(y_up, true)]), None);
        assert_eq!(is_z(&[dam(z_up, false)]), None, "nothing tells: y");
        assert_eq!(is_z(&[dam(y_up, false)]), None);
        // A falling block; part of its surface has sunk.
        let sunk = |turn: &dyn Fn([f32; 3]) -> [f32; 3]| {
            let at = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|i| SPACING * i as f32));
            let at = at.filter(|[x, _, z]| *x < 0.33 || *z < 0.33);
            let mut block = Particles::from_positions(at.map(turn).collect());
            block.velocities = Some(vec![turn([0.3, 0.0, -0.5]); block.positions.len()]);
            is_z(&[block]).is_some()
        };
        assert!(sunk(&|p| p));
        assert!(!sunk(&|[x, y, z]| [x, z, -y]));
        // Water that sinks through its floor from frame to frame.
        let sinking = |turn: &dyn Fn([f32; 3]) -> [f32; 3]| {
            let frame =
                |i: usize| dam(|[x, y, z]| turn([x, y, z - 3.0 * SPACING * i as f32]), false);
            is_z(&[frame(0), frame(1), frame(2)]).is_some()
        };
        assert!(sinking(&|p| p));
        assert!(!sinking(&|[x, y, z]| [x, z, -y]));
        // A block, and no particles.
        let block = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|i| SPACING * i as f32));
        assert_eq!(is_z(&[Particles::from_positions(block.collect())]), None);
        assert_eq!(is_z(&[Particles::from_positions(Vec::new())]), None);
        assert_eq!(is_z(&[]), None);
    }

    /// `find` on a dam in every orientation: `clear` with motion, `likely` without; with x up, only y or nothing is
    /// found.
    #[test]
    fn water_that_hangs_is_turned() {
        let up = |particles: Particles| find(&[particles]).map(|found| (found.up, found.sure));
        for up_axis in [Up::Y, Up::MinusY, Up::Z, Up::MinusZ] {
            let way = |[x, y, z]: [f32; 3]| up_axis.turn_back([x, z, -y]);
            assert_eq!(up(dam(way, true)), Some((up_axis, "clear")));
            assert_eq!(up(dam(way, false)), Some((up_axis, "likely")));
            // The dam breaks along the other candidate axis, from its low or its high end.
            for side in [1.0, -1.0] {
                let way = |[x, y, z]: [f32; 3]| up_axis.turn_back([y, z, side * x]);
                assert_eq!(up(dam(way, true)).map(|found| found.0), Some(up_axis), "{side}");
            }
        }
        // With x up no axis is detected except perhaps y, the default: x is no candidate.
        let side = |[x, y, z]: [f32; 3]| Up::X.turn_back([y, z, x]);
        assert!(up(dam(side, true)).is_none_or(|found| found.0 == Up::Y));
        // A jet that rises from a floor is not taken for water that falls towards a lid.
        let mut fountain = dam(|[x, y, z]| [x, z, -y], false);
        fountain.velocities = Some(vec![[0.0, 1.0, 0.0]; fountain.positions.len()]);
        assert_eq!(find(&[fountain]), None);
    }

    /// Two-dimensional water, with y down as in images, and with z down.
    #[test]
    fn sheets_that_hang_are_turned() {
        let sheet = |turn: &dyn Fn([f32; 2]) -> [f32; 3]| {
            let mut sheet = dam(|p| p, false);
            sheet.positions.retain(|p| p[1] == 0.0);
            sheet.positions.iter_mut().for_each(|[x, y, z]| [*x, *y, *z] = turn([*x, *z]));
            find(&[sheet]).map(|found| found.up)
        };
        assert_eq!(sheet(&|[x, z]| [x, z, 0.0]), Some(Up::Y));
        assert_eq!(sheet(&|[x, z]| [x, 4.0 - z, 0.0]), Some(Up::MinusY));
        assert_eq!(sheet(&|[x, z]| [x, 0.0, z]), Some(Up::Z));
        assert_eq!(sheet(&|[x, z]| [x, 0.0, -z]), Some(Up::MinusZ));
    }
}
