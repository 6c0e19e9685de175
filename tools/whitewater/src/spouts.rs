//! Detects spouts: places in mid-air where a solver emits water. Files hold only the water, and a jet that begins in
//! the air as a flat face looks cut off, so a channel is drawn around the start of the jet.

use glam::{Mat3, Quat, Vec2, Vec3};
use whitewater::headless::scene::{Material, Mesh, Pattern};

use crate::cells::Cells;
use crate::sets;

/// Min number of particles of a mouth.
const FEW: usize = 12;
/// A particle belongs to the mouth of a spout only if a cylinder behind it holds no other particle. These are the
/// cylinder's length and radius in spacings.
const BEHIND: f32 = 2.5;
const BESIDE: f32 = 1.2;
/// Max difference between the velocities of neighbours, relative to their speed.
const ALIKE: f32 = 0.1;
/// Max sine of the angle between a jet and the horizontal. Without this limit the upper face of falling water would
/// count as a mouth.
const STEEP: f32 = 0.5;
/// Max distance of a mouth's particles from the mouth's plane, in spacings, and the min part of its bounding
/// rectangle that they fill (a circle fills 0.79).
const FLAT: f32 = 0.8;
const FULL: f32 = 0.55;

/// Length in spacings by which a spout's walls reach before its mouth.
const LIP: f32 = 2.5;

/// The start of a jet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spout {
    /// Centre of its mouth.
    pub mouth: Vec3,
    /// Right-handed coordinate axes: horizontal across the jet (to the right if the jet moves towards the eye),
    /// upwards across it, and along it.
    pub frame: Mat3,
    /// Half of the mouth's width and height.
    pub half: Vec2,
}

/// Finds the spouts among a frame's particles. A spout is a flat face above `floor` from which water moves away with
/// a uniform velocity, and behind which there is no water. Water that is slower than after a fall through a spacing
/// is left out.
pub fn find(
    positions: &[[f32; 3]],
    velocities: &[[f32; 3]],
    spacing: f32,
    floor: f32,
) -> Vec<Spout> {
    let reach = BEHIND * spacing;
    let slowest = (2.0 * 9.81 * spacing).sqrt();
    let velocity = |i: usize| Vec3::from(velocities[i]);
    let level = |v: Vec3| v.is_finite() && v.length() > slowest && v.y.abs() < STEEP * v.length();
    let cells = Cells::new(positions, reach, |_| true);
    let moving = |i: usize| level(velocity(i)) && positions[i][1] > floor + 2.0 * spacing;
    let first = cells.map(moving, |i, p, others| {
        let own = velocity(i);
        let along = own.normalize_or_zero();
        let mut before = 0;
        for (other, at) in others {
            let off = at - p;
            let ahead = off.dot(along);
            if other == i || off.length() > reach {
                continue;
            }
            let beside = (off - ahead * along).length();
            let behind = ahead < -0.5 * spacing && beside < BESIDE * spacing;
            let near = off.length() < 1.5 * spacing;
            if behind || near && (velocity(other) - own).length() > ALIKE * own.length() {
                return false;
            }
            before += usize::from(ahead > 0.5 * spacing);
        }
        before >= 4
    });
    let mut left: Vec<usize> = first.into_iter().filter(|(_, is)| *is).map(|(i, _)| i).collect();
    let mut spouts = Vec::new();
    while let Some(seed) = left.pop() {
        let mut mouth = vec![seed];
        let mut next = 0;
        while next < mouth.len() {
            let (at, v) = (Vec3::from(positions[mouth[next]]), velocity(mouth[next]));
            let joins = |i: &mut usize| {
                let near = Vec3::from(positions[*i]).distance(at) < 1.8 * spacing;
                near && (velocity(*i) - v).length() < ALIKE * v.length()
            };
            mouth.extend(left.extract_if(.., joins));
            next += 1;
        }
        spouts.extend(spout(positions, &mouth, velocity, spacing));
    }
    // Sorted, because the order from the threads differs from run to run.
    spouts.sort_by(|a, b| a.mouth.x.total_cmp(&b.mouth.x).then(a.mouth.z.total_cmp(&b.mouth.z)));
    spouts
}

/// The spout of connected particles, if they fill a flat mouth.
fn spout(
    positions: &[[f32; 3]],
    mouth: &[usize],
    velocity: impl Fn(usize) -> Vec3,
    spacing: f32,
) -> Option<Spout> {
    if mouth.len() < FEW {
        return None;
    }
    let along = mouth.iter().map(|i| velocity(*i)).sum::<Vec3>().try_normalize()?;
    let right = Vec3::Y.cross(along).try_normalize()?;
    let frame = Mat3::from_cols(right, along.cross(right), along);
    let own = |i: &usize| frame.transpose() * Vec3::from(positions[*i]);
    let mut depths: Vec<f32> = mouth.iter().map(|i| own(i).z).collect();
    depths.sort_unstable_by(f32::total_cmp);
    let plane = depths[depths.len() / 2];
    let flat = depths.iter().filter(|d| (**d - plane).abs() < FLAT * spacing).count();
    let low = mouth.iter().map(own).fold(Vec3::MAX, Vec3::min);
    let high = mouth.iter().map(own).fold(Vec3::MIN, Vec3::max);
    let half = 0.5 * (high - low).truncate() + 0.5 * spacing;
    let fills = mouth.len() as f32 * spacing * spacing / (4.0 * half.x * half.y);
    let middle = (0.5 * (low + high)).truncate().extend(plane);
    let is = 10 * flat >= 9 * mouth.len() && fills > FULL && half.min_element() > spacing;
    is.then_some(Spout { mouth: frame * middle, frame, half })
}

impl Spout {
    /// A channel with thick walls of `stone` around the spout, lined with dark metal. It extends back from the mouth by
    /// `back`, to a pier that stands on the floor.
    pub fn meshes(&self, spacing: f32, floor: f32, back: f32, stone: &Material) -> Vec<Mesh> {
        let wall = (0.25 * self.half.min_element()).max(0.7 * spacing);
        let turn = Quat::from_mat3(&self.frame).to_array();
        let push = |middle: Vec3, half: Vec3, of: &Material| {
            let at = self.mouth + self.frame * middle;
            let mesh = Mesh::cuboid(at.to_array(), half.to_array(), turn, of.clone());
            Mesh { name: "spout".into(), ..mesh }
        };
        let metal = sets::material([0.10, 0.095, 0.085], 0.5, Pattern::Plain);
        // The lip of the channel is in front of the box that fills the channel and hides the start of the water. Seen
        // through water, stone would look like a lump of glass, so box and lining are dark.
        let (lip, hidden, lining) = (LIP * spacing, 0.3 * spacing, 0.2 * wall);
        let Vec2 { x, y } = self.half + lining;
        let box_middle = Vec3::new(0.0, 0.0, hidden - 0.5 * back);
        let mut meshes = vec![push(box_middle, self.half.extend(0.5 * back), &metal)];
        // `x` and `y`: half of the width and height inside, `end`: how far the walls reach before the mouth.
        let mut walls = |Vec2 { x, y }: Vec2, wall: f32, end: f32, of: &Material| {
            let long = 0.5 * (back + end);
            let (across, up) =
                (Vec3::new(0.5 * wall, y, long), Vec3::new(x + wall, 0.5 * wall, long));
            for side in [-1.0, 1.0] {
                let middle = Vec3::new(side * (x + 0.5 * wall), 0.0, end - long);
                meshes.push(push(middle, across, of));
                let middle = Vec3::new(0.0, side * (y + 0.5 * wall), end - long);
                meshes.push(push(middle, up, of));
            }
        };
        walls(self.half, lining, lip + lining, &metal);
        walls(self.half + lining, wall, lip, stone);
        // The pier is upright for every slope of the jet.
        let end = self.mouth - back * self.frame.z_axis;
        let top = end.y + y + wall;
        let level = Vec3::new(self.frame.z_axis.x, 0.0, self.frame.z_axis.z).normalize_or(Vec3::Z);
        let upright = Mat3::from_cols(Vec3::Y.cross(level), Vec3::Y, level);
        let deep = 0.7 * (y + wall);
        let middle = end - 0.5 * deep * level;
        let at = Vec3::new(middle.x, 0.5 * (top + floor), middle.z);
        let half = Vec3::new(x + wall, 0.5 * (top - floor), deep);
        let turn = Quat::from_mat3(&upright).to_array();
        let pier = Mesh::cuboid(at.to_array(), half.to_array(), turn, stone.clone());
        meshes.push(Mesh { name: "spout pier".into(), ..pier });
        meshes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: f32 = 0.05;

    /// Particles of a test, and their velocities: a jet of 30 layers of 10 by 6 particles, which starts at `height`
    /// and moves in the direction `along`, and water at rest below it.
    fn jet(along: Vec3, speed: f32, height: f32) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
        let right = along.cross(Vec3::Y).normalize();
        let up = right.cross(along);
        let (mut positions, mut velocities) = (Vec::new(), Vec::new());
        let mut push = |p: Vec3, v: Vec3| {
            positions.push((SPACING * p).to_array());
            velocities.push(v.to_array());
        };
        for i in 0..1800 {
            let [x, y, z] = [i % 10, i / 10 % 6, i / 60].map(|v| v as f32);
            push(
                Vec3::Y * height / SPACING + (x - 4.5) * right + (y - 2.5) * up + z * along,
                speed * along,
            );
        }
        for i in 0..3000 {
            let [x, y, z] = [i % 20, i / 20 % 5, i / 100].map(|v| v as f32);
            push(Vec3::new(x - 10.0, y, z), Vec3::ZERO);
        }
        (positions, velocities)
    }

    #[test]
    fn a_jet_in_mid_air_has_a_spout_and_other_water_none() {
        let of = |(positions, velocities): &(Vec<[f32; 3]>, Vec<[f32; 3]>)| {
            find(positions, velocities, SPACING, 0.0)
        };
        for along in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, -0.3, 0.954)] {
            let found = of(&jet(along, 3.0, 1.5));
            assert_eq!(found.len(), 1, "{along}");
            let one = found[0];
            assert!((one.mouth - 1.5 * Vec3::Y).length() < 0.01 * SPACING, "{one:?}");
            assert!(one.frame.z_axis.dot(along) > 0.999);
            assert!((one.half - SPACING * Vec2::new(5.0, 3.0)).length() < 1.0e-4, "{one:?}");
            assert!((one.frame.determinant() - 1.0).abs() < 1.0e-4);
        }
        assert!(of(&jet(Vec3::Z, 0.5, 1.5)).is_empty(), "at rest");
        assert!(of(&jet(Vec3::new(0.1, -0.99, 0.1).normalize(), 3.0, 2.5)).is_empty(), "it falls");
        assert!(of(&jet(Vec3::Z, 3.0, 0.05)).is_empty(), "on the floor");
    }

    #[test]
    fn a_spout_stands_on_the_floor_and_hides_where_the_water_begins() {
        let (positions, velocities) = jet(Vec3::Z, 3.0, 1.5);
        let one = find(&positions, &velocities, SPACING, 0.0)[0];
        let meshes = one.meshes(SPACING, -0.2, 0.8, &Material::default());
        let corners = |mesh: &Mesh| -> Vec<Vec3> {
            let points = mesh.positions.iter();
            points.map(|p| mesh.transform.transform_point3((*p).into())).collect()
        };
        let all: Vec<Vec3> = meshes.iter().flat_map(corners).collect();
        let low = all.iter().copied().reduce(Vec3::min).unwrap();
        let high = all.iter().copied().reduce(Vec3::max).unwrap();
        assert!((low.y + 0.2).abs() < 1.0e-4, "{low}");
        // The channel extends no farther forward than the lip, and back to the pier.
        assert!(high.z > 2.0 * SPACING && high.z < 3.0 * SPACING && low.z < -0.8, "{low} {high}");
        // Box and lining are dark whatever the stone is.
        let (metal, stone): (Vec<&Mesh>, Vec<&Mesh>) =
            meshes.iter().partition(|mesh| mesh.material != Material::default());
        assert_eq!((metal.len(), stone.len()), (5, 5));
        assert!(metal.iter().all(|mesh| mesh.material.base_color.iter().all(|c| *c <= 0.1)));
        let core = corners(&meshes[0]).into_iter().reduce(Vec3::max).unwrap();
        assert!(core.z > 0.1 * SPACING && core.z < high.z);
    }
}
