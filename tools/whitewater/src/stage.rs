//! Scenes behind the water: from a file, a basin around water that stands in a box, or paved ground below it.

use std::path::Path;

use glam::{Vec2, Vec3};
use whitewater::headless::scene::{Ground, Material, Mesh, Pattern, Scene};
use whitewater::water::Pane;

use crate::args::SetArg;
use crate::bounds::Bounds;
use crate::environment::Environment;
use crate::failure::{Failure, Outcome};
use crate::masonry;
use crate::sets::{self, Place, material};
use crate::spouts::Spout;

/// Reads a scene.
pub fn read(path: &Path) -> Outcome<Scene> {
    Scene::load(path).map_err(|error| Failure::input(format!("{error}; mend the file")))
}

/// Materials of the ground, of the inside of a basin and of its walls. The sizes of tiles and blocks are in
/// proportion to `longest`, the extent of the water.
fn materials(set: SetArg, longest: f32) -> [Material; 3] {
    let of = material;
    let tiles = |part: f32| Pattern::Tiles { size: round_length(longest / part), band: None };
    match set {
        // The tiles are blue, so that shallow and deep water have one colour.
        SetArg::Pool | SetArg::None => [
            of([0.195, 0.179, 0.16], 0.9, Pattern::Paving { size: round_length(longest / 14.0) }),
            of([0.29, 0.43, 0.48], 0.22, tiles(36.0)),
            of([0.40, 0.365, 0.305], 0.85, Pattern::Blocks { course: 0.036 * longest }),
        ],
        SetArg::Studio => [
            of([0.46; 3], 0.95, Pattern::Plain),
            of([0.62; 3], 0.5, Pattern::Plain),
            of([0.16; 3], 0.5, Pattern::Plain),
        ],
        SetArg::Beach => [
            of([0.50, 0.41, 0.29], 0.95, Pattern::Ripples { length: 0.03 * longest }),
            of([0.62, 0.52, 0.38], 0.9, Pattern::Sand),
            of([0.45, 0.42, 0.38], 0.85, Pattern::Stone { course: round_length(longest / 30.0) }),
        ],
        SetArg::Lab => {
            let resin = of([0.20, 0.23, 0.24], 0.42, Pattern::Plain);
            let enamel = of([0.70, 0.71, 0.70], 0.35, Pattern::Plain);
            [resin, of([0.74, 0.74, 0.73], 0.15, tiles(60.0)), enamel]
        }
    }
}

/// Surroundings with the ground below the bulk of the water.
pub fn ground_under(bounds: &Bounds, eye: Vec3, set: SetArg) -> Scene {
    let size = bounds.size();
    let middle = Vec3::new(bounds.center().x, bounds.min.y, bounds.center().z);
    let place = Place { middle, half: 0.5 * Vec2::new(size.x, size.z), eye };
    let mut scene = extent(bounds, set);
    let [material, ..] = materials(set, place.wide());
    sets::furnish(&mut scene, set, material, &place);
    scene
}

/// Adds surroundings to a scene that stands on level ground.
pub fn furnish(scene: &mut Scene, eye: Vec3, set: SetArg) {
    let (low, high) = scene.bounds();
    let ground = scene.ground.as_ref().map_or(low.y, |ground| ground.y);
    let middle = Vec3::new(0.5 * (low.x + high.x), ground, 0.5 * (low.z + high.z));
    let place = Place { middle, half: 0.5 * Vec2::new(high.x - low.x, high.z - low.z), eye };
    let [material, ..] = materials(set, place.wide());
    sets::furnish(scene, set, material, &place);
}

/// A paved plain and nothing else.
pub fn paving_under(bounds: &Bounds) -> Scene {
    let scene = extent(bounds, SetArg::Pool);
    let [material, ..] = materials(SetArg::Pool, bounds.size().max_element());
    Scene { ground: Some(Ground { y: bounds.min.y, material, reach: None }), ..scene }
}

/// An empty scene of the water's size.
fn extent(bounds: &Bounds, set: SetArg) -> Scene {
    let longest = bounds.size().max_element().max(f32::MIN_POSITIVE);
    let [_, material, _] = materials(set, longest);
    // A sheet just below the ground, which hides it. Its only purpose is to give the scene its size.
    let y = bounds.min.y - 1.0e-3 * longest;
    let corner = |x: f32, z: f32| {
        let at = bounds.center() + longest * glam::Vec3::new(x, 0.0, z);
        [at.x, y, at.z]
    };
    let sheet = Mesh {
        name: "extent".into(),
        positions: vec![corner(-0.5, -0.5), corner(-0.5, 0.5), corner(0.5, 0.5), corner(0.5, -0.5)],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        material,
        ..Mesh::default()
    };
    Scene { meshes: vec![sheet], ..Scene::default() }
}

/// One side of a box of water.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// Axis of the side's normal: 0 or 2.
    axis: usize,
    /// -1 or 1: the end of the axis.
    sign: f32,
    /// Coordinate on the axis.
    at: f32,
    /// Height of the water's surface along this side of the box: its 25 % quantile (`level`) and its 90 % quantile
    /// (`highest`).
    level: f32,
    highest: f32,
    /// Height up to which the water touches the side.
    reach: f32,
}

impl Side {
    /// The side of a box as a pane of glass that holds water in the box.
    fn pane(&self, low: Vec3, high: Vec3) -> Pane {
        let mut corner = low;
        corner[self.axis] = self.at;
        // The vector product of the next two axes is this axis, which points out of the box at its high end.
        let mut edges = [1, 2].map(|next| {
            let axis = (self.axis + next) % 3;
            let mut edge = Vec3::ZERO;
            edge[axis] = high[axis] - low[axis];
            edge.to_array()
        });
        if self.sign < 0.0 {
            edges.swap(0, 1);
        }
        Pane { corner: corner.to_array(), edges }
    }
}

/// Thickness of the outermost layer of particles in spacings; within it, some are pressed farther out than others.
const LAYER: f32 = 0.9;
/// Distance from the place where freely running water ends to the wall of the box on that side, as a part of the
/// longer horizontal side of the water's bounds.
const FREE: f32 = 0.3;

/// Sides of the box in which the particles stand or run; `None` if fewer than two sides hold the water. The box is
/// found from the particles, because most solvers write no walls to a file, and water without walls looks like fog.
fn sides(frames: &[&[[f32; 3]]], bounds: &Bounds, spacing: f32) -> Option<[Side; 4]> {
    let side = |axis: usize, sign: f32| {
        let all = frames.iter().copied().flatten();
        let mut places: Vec<f32> = all.map(|p| sign * p[axis]).collect();
        places.sort_unstable_by(f32::total_cmp);
        // Strays are excluded.
        let last = *places.get(places.len().checked_sub(1 + places.len() / 1000)?)?;
        // The wall is at the median of the outermost layer. Particles at the floor are pressed farther out; a wall at
        // their place would leave a gap above them. The next layer, one spacing inwards, does not count.
        let layer = &places[places.partition_point(|p| *p < last - LAYER * spacing)..];
        let at = sign * *layer.get(layer.len() / 2)?;
        let touches = |p: &&[f32; 3]| sign * (p[axis] - at) > -1.5 * spacing;
        let reach = |frames: &[&[[f32; 3]]]| {
            let mut touching: Vec<f32> =
                frames.iter().copied().flatten().filter(touches).map(|p| p[1]).collect();
            touching.sort_unstable_by(|a, b| b.total_cmp(a));
            // Drops are left out: above the returned height less than a row of particles per frame touches the side.
            let rows = (bounds.size()[2 - axis] / spacing + 1.5) * frames.len() as f32;
            touching.get(rows as usize).copied().unwrap_or(bounds.min.y)
        };
        // The max over frames, because the particles of a dam or a run-up wave in one frame are too few among all
        // frames.
        let each = frames.iter().map(|frame| reach(std::slice::from_ref(frame)));
        let reach = each.fold(reach(frames), f32::max);
        let across = 2 - axis;
        let (low, length) = (bounds.min[across], bounds.size()[across]);
        let count = ((length / (4.0 * spacing)) as usize).clamp(4, 64);
        let mut held = vec![false; count];
        let mut heights = Vec::new();
        for frame in frames {
            let mut bins = vec![(0, f32::MIN); count];
            for p in frame.iter().filter(|p| sign * (p[axis] - at) > -2.0 * spacing) {
                let bin = ((p[across] - low) / length * count as f32) as usize;
                let bin = &mut bins[bin.min(count - 1)];
                *bin = (bin.0 + 1, bin.1.max(p[1]));
            }
            for (bin, held) in bins.iter().zip(&mut held).filter(|(bin, _)| bin.0 >= 4) {
                *held = true;
                heights.push(bin.1);
            }
        }
        // If the water touches at least half of a side, a wall holds it there; otherwise it still runs, and the wall
        // is farther away.
        let share = held.iter().filter(|held| **held).count() as f32 / count as f32;
        heights.sort_unstable_by(f32::total_cmp);
        let free = |low: f32| low + sign * FREE * bounds.size().x.max(bounds.size().z);
        let floor = bounds.min.y;
        let open = Side { axis, sign, at: free(at), level: floor, highest: floor, reach: floor };
        let quantile = |part: f32| heights[(heights.len() as f32 * part) as usize];
        let held = || Side { at, level: quantile(0.25), highest: quantile(0.9), reach, ..open };
        Some(if share >= 0.5 { (held(), true) } else { (open, false) })
    };
    let sides = [side(0, -1.0)?, side(0, 1.0)?, side(2, -1.0)?, side(2, 1.0)?];
    let held = sides.iter().filter(|(_, held)| *held).count();
    (held >= 2).then_some(sides.map(|(side, _)| side))
}

/// A basin around water that stands in a box: low walls towards the camera, high ones behind; all walls are low if
/// the camera orbits. Panes of glass on the walls hold water that stands higher than them, and channels are built
/// around the `spouts`. `None` if no box holds the particles.
pub fn basin_round(
    frames: &[&[[f32; 3]]],
    bounds: &Bounds,
    spacing: f32,
    (eye, from_all_sides): (Vec3, bool),
    set: SetArg,
    spouts: &[Spout],
) -> Option<Scene> {
    let sides = sides(frames, bounds, spacing)?;
    let mut scene = extent(bounds, set);
    let longest = bounds.size().max_element();
    let wide = bounds.size().x.max(bounds.size().z);
    let (thick, lining) = (0.035 * wide, 0.006 * wide);
    // The slab on the wall, and its overhang.
    let (slab, over) = (0.011 * wide, 0.008 * wide);
    // Thickness of panes of glass.
    let edge = 0.0022 * wide;
    let floor = bounds.min.y;
    let [ground, tiles, stone] = materials(set, wide);
    let slabs = |color, roughness| material(color, roughness, Pattern::Stone { course: wide });
    let glass = material([0.42, 0.56, 0.52], 0.15, Pattern::Plain);
    let steel = material([0.30, 0.31, 0.32], 0.3, Pattern::Plain);
    // The inner faces cut the drawn spheres of the outermost layer, so that the water reaches its walls.
    let face = |side: &Side| side.at;
    let [left, right, back, front] = &sides;
    let (low, high) = (
        glam::Vec3::new(face(left), floor, face(back)),
        glam::Vec3::new(face(right), floor, face(front)),
    );
    let middle = 0.5 * (low + high);
    let paved = set == SetArg::Pool;
    let (coping, edging) = match paved {
        true => (slabs([0.47, 0.435, 0.375], 0.8), slabs([0.245, 0.227, 0.2], 0.8)),
        false => (stone.clone(), stone.clone()),
    };
    // Faces that other objects hide are left out, because the lighting of each vertex costs rays.
    let cuboid = |name: &str, from: Vec3, to: Vec3, material: &Material, hidden: &[usize]| {
        let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
        let turn = [0.0, 0.0, 0.0, 1.0];
        let mut mesh = Mesh::cuboid(centre.into(), half.into(), turn, material.clone());
        let faces = mesh.indices.chunks(6).enumerate().filter(|(face, _)| !hidden.contains(face));
        mesh.indices = faces.flat_map(|(_, indices)| indices).copied().collect();
        mesh.name = name.into();
        mesh
    };
    let (mut meshes, mut panes) = (Vec::new(), Vec::new());
    // All near walls have one height, and all far walls have one.
    let towards_eye =
        |side: &Side| from_all_sides || side.sign * (eye[side.axis] - face(side)) > 0.0;
    let highest = |near: bool| {
        let of = sides.iter().filter(|side| towards_eye(side) == near);
        of.map(|s| if near { s.level + spacing } else { s.highest + thick }).fold(floor, f32::max)
    };
    // Walls behind standing water (not splashes) are as high as the water.
    let stands = sides.iter().filter(|side| !towards_eye(side)).map(|side| side.level + thick);
    let stands = stands.fold(floor, f32::max);
    // Walls other than those behind standing water have a limited height, so that they neither hide the water nor
    // shade it.
    let top_of = |near: bool| {
        let most = if near { 0.12 } else { 0.2 };
        let top = highest(near).clamp(floor + thick, floor + most * wide) - slab;
        if near { top } else { top.max(stands - slab) }
    };
    // Panes hold water that is higher than the walls; all panes have one height.
    let foot = |side: &Side| top_of(towards_eye(side)) + slab;
    // Water that rests above a wall needs glass, water that splashes over it only where it is high.
    let holds = |side: &Side| {
        side.reach.min(side.level) > foot(side) + 0.5 * spacing
            || side.reach > foot(side) + 4.0 * spacing
    };
    let held = sides.iter().filter(|side| holds(side));
    // The upper edge of the glass is above its mount.
    let upper = |side: &Side| (side.reach + spacing + 2.0 * edge).max(foot(side) + 6.0 * edge);
    let head = held.map(upper).fold(floor, f32::max);
    let sheet = 1.0e-3 * longest;
    let (from, to) = (low - glam::Vec3::Y * sheet, high + glam::Vec3::Y * sheet);
    meshes.push(cuboid("basin floor", from, to, &tiles, &[3]));
    for side in &sides {
        let top = top_of(towards_eye(side));
        let across = 2 - side.axis;
        let wall = |inner: f32, outer: f32, top: f32, longer: f32| {
            let mut from = middle;
            let mut to = middle;
            (from[side.axis], to[side.axis]) = (inner.min(outer), inner.max(outer));
            (from[across], to[across]) = (low[across] - longer, high[across] + longer);
            (from.y, to.y) = (floor - 2.0 * sheet, top);
            (from, to)
        };
        let inner = face(side);
        // Faces of a box: +x -x +y -y +z -z.
        let outside = 2 * side.axis + usize::from(side.sign < 0.0);
        let (from, to) = wall(inner, inner + side.sign * lining, top, lining);
        meshes.push(cuboid("basin lining", from, to, &tiles, &[2, 3, outside]));
        let outer = inner + side.sign * thick;
        // The wall ends inside the slab on top of it. There its upper vertices take the light of their neighbours, so
        // no dark edge is visible.
        let (from, to) = wall(inner + side.sign * lining, outer, top + 0.5 * slab, thick);
        let mut mesh = masonry::dressed(from, to, 0.3 * lining, stone.clone(), &[2, 3]);
        mesh.name = "basin wall".into();
        meshes.push(mesh);
        let (mut from, to) = wall(inner, outer + side.sign * over, top + slab, thick + over);
        from.y = top;
        // Two adjacent sides share a corner; one of them is cut off there.
        let (length, chamfer) = (0.16 * wide, 0.14 * slab);
        let seed = 20 + 2 * outside as u32;
        for mut mesh in masonry::row((from, to), across, length, chamfer, &coping, seed) {
            mesh.name = "basin coping".into();
            meshes.push(mesh);
        }
        if paved {
            // A course of stones in the paving, along the foot.
            let course = outer + side.sign * 0.055 * wide;
            let (from, mut to) = wall(outer, course, floor, thick + 0.055 * wide);
            to.y = floor + 0.0002 * wide;
            let stones = (from, to);
            for mut mesh in
                masonry::row(stones, across, 0.1 * wide, 0.01 * slab, &edging, 40 + seed)
            {
                mesh.name = "basin foot".into();
                meshes.push(mesh);
            }
        }
        // The edges of clear glass are visible, and its mount.
        let foot = foot(side);
        if head > foot + 4.0 * spacing || holds(side) {
            scene.panes.push(side.pane(low, Vec3::new(high.x, head, high.z)));
            for (name, material, inner, outer, low, high, ends) in [
                (
                    "pane foot",
                    &steel,
                    inner,
                    inner + side.sign * 3.0 * edge,
                    foot,
                    foot + 3.0 * edge,
                    false,
                ),
                ("pane edge", &glass, inner, inner + side.sign * edge, head - edge, head, false),
                // From the top of the mount.
                (
                    "pane edge",
                    &glass,
                    inner,
                    inner + side.sign * edge,
                    foot + 3.2 * edge,
                    head,
                    true,
                ),
            ] {
                // At the corners the level edges of the glass end before the upright ones: a vertex inside a solid
                // would be dark.
                let (mut from, to) =
                    wall(inner, outer, high, if ends { edge } else { -0.1 * edge });
                from.y = low;
                if ends {
                    let (mut first, mut last) = (to, from);
                    first[across] = from[across] + edge;
                    last[across] = to[across] - edge;
                    // The upright edge at the far corner is left out; through the water it would look like a crack.
                    let beside = |sign: f32| {
                        let at = |s: &&Side| s.axis == across && s.sign == sign;
                        sides.iter().find(at).is_some_and(towards_eye)
                    };
                    if towards_eye(side) || beside(-1.0) {
                        panes.push(cuboid(name, from, first, material, &[]));
                    }
                    if towards_eye(side) || beside(1.0) {
                        panes.push(cuboid(name, last, to, material, &[]));
                    }
                } else {
                    let mesh = cuboid(name, from, to, material, &[]);
                    if name == "pane foot" { meshes.push(mesh) } else { panes.push(mesh) }
                }
            }
        }
    }
    scene.meshes.extend(meshes);
    // Glass edges are thin and transparent, and the sun's disc blurs their shadow, so they cast none.
    scene.backdrop = panes;
    for spout in spouts {
        // Extends to behind the wall that the spout comes through.
        let way = -spout.frame.z_axis;
        let beyond = |side: &Side| {
            let towards = side.sign * way[side.axis];
            let gap = side.sign * (face(side) - spout.mouth[side.axis]);
            if towards > 0.5 { (gap.max(0.0) + thick + over) / towards } else { 0.0 }
        };
        let back = sides.iter().map(beyond).fold(4.0 * spacing, f32::max);
        scene.meshes.extend(spout.meshes(spacing, floor - 2.0 * sheet, back, &stone));
    }
    if paved {
        let out = Vec2::splat(thick);
        let (low, high) = (Vec2::new(low.x, low.z) - out, Vec2::new(high.x, high.z) + out);
        scene.splashed = Some([low.to_array(), high.to_array()]);
    }
    let place = Place {
        middle: Vec3::new(middle.x, floor, middle.z),
        half: 0.5 * Vec2::new(high.x - low.x, high.z - low.z) + thick + over,
        eye,
    };
    sets::furnish(&mut scene, set, ground, &place);
    Some(scene)
}

/// Horizontal angle in degrees between the directions from the water to the camera and to the sun. The sun is in
/// front of the water, so that the visible faces are lit, and far enough to the side to show the water's relief.
const SUN_ASIDE: f32 = 72.0;

/// Direction to a high sun, on the side of the box face that the camera sees more of.
pub fn side_light(towards_eye: glam::Vec3) -> [f32; 3] {
    let level = glam::Vec3::new(towards_eye.x, 0.0, towards_eye.z).normalize_or(glam::Vec3::Z);
    let faces = match level.x.abs() > level.z.abs() {
        true => level.x.signum() * glam::Vec3::X,
        false => level.z.signum() * glam::Vec3::Z,
    };
    let aside = if level.cross(faces).y > 0.0 { SUN_ASIDE } else { -SUN_ASIDE };
    let turned = glam::Quat::from_rotation_y(aside.to_radians()) * level;
    (0.36 * turned + 0.933 * glam::Vec3::Y).to_array()
}

/// Exposure correction of a set in stops: dark stone is photographed brighter.
pub fn exposure(set: SetArg) -> f32 {
    if set == SetArg::Pool { 0.3 } else { 0.0 }
}

/// The light of a set (the surroundings that `--set` chooses); `None` if the set has no light of its own.
/// `towards_eye` is the direction from the water to the camera.
pub fn light(set: SetArg, towards_eye: Vec3) -> Outcome<Option<Environment>> {
    let key = side_light(towards_eye);
    let grey = |from: f32, to: f32, d: Vec3| Vec3::splat(from + (to - from) * (0.5 + 0.5 * d.y));
    Ok(match set {
        // A soft box in a dark room below a grey ceiling: the floor fades into the dark, and the water is bright in
        // front of the dark.
        SetArg::Studio => {
            let room = |d: Vec3| {
                let [up, over] = [d.y / 0.2, (d.y - 0.35) / 0.45].map(|t| t.clamp(0.0, 1.0));
                Vec3::splat(0.28 - 0.19 * up * up * (3.0 - 2.0 * up) + 0.5 * over)
            };
            Some(Environment::lit(room, key, (Vec3::splat(7.0), 0.8))?)
        }
        // Rows of lamps below a ceiling.
        SetArg::Lab => {
            let room = |d: Vec3| {
                let lamp = match d.y > 0.1 {
                    true => {
                        let (x, z) = (d.x / d.y, d.z / d.y);
                        let on =
                            (1.1 * x).rem_euclid(1.0) < 0.28 && (0.5 * z).rem_euclid(1.0) < 0.85;
                        if on { 5.0 } else { 0.0 }
                    }
                    false => 0.0,
                };
                grey(0.35, 0.5, d) + lamp * Vec3::new(1.0, 0.97, 0.92)
            };
            Some(Environment::lit(room, key, (Vec3::new(8.0, 7.8, 7.4), 0.55))?)
        }
        SetArg::Pool | SetArg::Beach | SetArg::None => None,
    })
}

/// Rounds a length to 1, 2 or 5 times a power of ten, which are usual sizes of slabs.
fn round_length(rough: f32) -> f32 {
    let power = 10.0_f32.powf(rough.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|n| n * power);
    steps.into_iter().find(|t| *t >= 0.75 * rough).unwrap_or(rough)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Particles of a test: a block of water with a spacing of 0.1 scene units, and with a corner cut off if `cut` is
    /// set.
    fn block(cut: bool) -> Vec<[f32; 3]> {
        let cells = (0..20).flat_map(|x| (0..6).flat_map(move |y| (0..30).map(move |z| (x, y, z))));
        cells
            .filter(|(x, _, z)| !cut || x + z < 16)
            .map(|(x, y, z)| [0.1 * x as f32, 0.1 * y as f32, 0.1 * z as f32])
            .collect()
    }

    /// The lower part of the block, which the near walls hold.
    fn shallow() -> Vec<[f32; 3]> {
        block(false).into_iter().filter(|p| p[1] < 0.35).collect()
    }

    #[test]
    fn water_that_fills_a_box_gets_a_basin() {
        let eye = Vec3::new(9.0, 5.0, 9.0);
        let basin = |points: &[[f32; 3]]| {
            let bounds = Bounds::of_bulk(points).unwrap();
            basin_round(&[points], &bounds, 0.1, (eye, false), SetArg::Pool, &[])
        };
        let scene = basin(&block(false)).unwrap();
        let top = |mesh: &Mesh| {
            let points =
                mesh.positions.iter().map(|p| mesh.transform.transform_point3((*p).into()));
            points.map(|p| p.y).fold(f32::MIN, f32::max)
        };
        let walls: Vec<f32> =
            scene.meshes.iter().filter(|m| m.name == "basin wall").map(top).collect();
        assert_eq!(walls.len(), 4);
        // The far walls, at -x and -z, are with the slabs on them at least as high as the water; the near ones hide
        // little of it.
        assert!(walls[0] > 0.46 && walls[2] > 0.46, "{walls:?}");
        assert!(walls[1] < 0.4 && walls[3] < 0.4, "{walls:?}");
        // The tiles are blue.
        let [r, g, b] =
            scene.meshes.iter().find(|m| m.name == "basin floor").unwrap().material.base_color;
        assert!(r < g && g < b, "{r} {g} {b}");
        // A tall block stands in front of walls of its own height.
        let tall: Vec<_> =
            (0..12_000).map(|i| [i % 20, i / 20 % 30, i / 600].map(|i| 0.1 * i as f32)).collect();
        let scene = basin(&tall).unwrap();
        let walls: Vec<f32> =
            scene.meshes.iter().filter(|m| m.name == "basin wall").map(top).collect();
        assert!(
            walls[0] > 2.86 && walls[2] > 2.86 && walls[1] < 0.4 && walls[3] < 0.4,
            "{walls:?}"
        );
        // A wedge leans against two sides; on the others, where it runs freely, walls are farther away.
        let wide = |scene: &Scene| {
            let walls = scene.meshes.iter().filter(|m| m.name == "basin wall");
            let all = walls.flat_map(|m| {
                m.positions.iter().map(|p| m.transform.transform_point3((*p).into()).x)
            });
            let (low, high) = all.fold((f32::MAX, f32::MIN), |(l, h), x| (l.min(x), h.max(x)));
            high - low
        };
        let [whole, wedge] = [false, true].map(|cut| wide(&basin(&block(cut)).unwrap()));
        let reaches = block(true).iter().map(|p| p[0]).fold(0.0, f32::max);
        assert!(whole < 1.9 + 0.4 && wedge > reaches + 0.3 * reaches, "{whole} {wedge}");
        let pile: Vec<_> = block(false).into_iter().filter(|p| p[0] + p[1] + p[2] < 2.0).collect();
        let pile: Vec<_> = pile.iter().map(|p| [p[0] - p[2], p[1], p[0] + p[2]]).collect();
        assert!(basin(&pile).is_none(), "a pile leans on nothing");
        assert!(basin(&[[0.0; 3]]).is_none());
    }

    /// If a few particles at the floor are pressed outwards, the wall of the basin stays at the median of the
    /// outermost particles: no gap opens between it and the water above them.
    #[test]
    fn walls_touch_most_of_the_water() {
        let right = |points: &[[f32; 3]]| {
            let bounds = Bounds::of_bulk(points).unwrap();
            sides(&[points], &bounds, 0.1).unwrap()[1].at
        };
        let mut points = block(false);
        let still = right(&points);
        assert!((still - 1.9).abs() < 1.0e-4, "{still}");
        // On an exact lattice the next layer does not move the wall, although it has more particles than the
        // outermost.
        let exact: Vec<_> = (0..20 * 6 * 30)
            .map(|i| [i % 20, i / 20 % 6, i / 120].map(|c| c as f32))
            .filter(|p| p[0] < 18.5 || p[1] < 4.5)
            .collect();
        let bounds = Bounds::of_bulk(&exact).unwrap();
        assert_eq!(sides(&[&exact], &bounds, 1.0).unwrap()[1].at, 19.0);
        points.extend((0..10).map(|z| [1.97, 0.0, 0.3 * z as f32]));
        assert!((right(&points) - still).abs() < 0.011, "{}", right(&points));
    }

    /// The sun shines on the box face that the camera sees more of.
    #[test]
    fn the_sun_shines_on_the_face_that_is_seen() {
        for degrees in (0..360).step_by(7) {
            let (sin, cos) = f32::to_radians(degrees as f32).sin_cos();
            let eye = Vec3::new(5.0 * sin, 2.0, 5.0 * cos);
            let face = match sin.abs() > cos.abs() {
                true => sin.signum() * Vec3::X,
                false => cos.signum() * Vec3::Z,
            };
            let sun = Vec3::from(side_light(eye));
            assert!(sun.dot(face) > 0.1 && sun.y > 0.9, "{degrees}: {sun}");
        }
    }

    #[test]
    fn panes_hold_what_would_stand_in_the_air() {
        let edges = |points: &[[f32; 3]]| -> Vec<f32> {
            let bounds = Bounds::of_bulk(points).unwrap();
            let seen_from = (Vec3::new(9.0, 5.0, 9.0), false);
            let scene = basin_round(&[points], &bounds, 0.1, seen_from, SetArg::Pool, &[]).unwrap();
            let panes = scene.backdrop.iter().filter(|mesh| mesh.name == "pane edge");
            let top = |mesh: &Mesh| {
                let points = mesh.positions.iter();
                let heights = points.map(|p| mesh.transform.transform_point3((*p).into()).y);
                heights.fold(f32::MIN, f32::max)
            };
            panes.map(top).collect()
        };
        assert!(edges(&shallow()).is_empty(), "the walls hold it");
        // `rows` rows of particles on all of the wall towards the camera, the highest at a height of 2.
        let on_wall = |rows: usize| {
            let at = |i: usize| [1.9, 2.0 - 0.1 * (i / 30) as f32, 0.1 * (i % 30) as f32];
            let mut all = shallow();
            all.extend((0..30 * rows).map(at));
            all
        };
        let found = edges(&on_wall(14));
        // Four upper edges, and two upright ones each except at the far corner.
        assert_eq!(found.len(), 10);
        // The height of all but a row, equal for all panes.
        assert!(found.iter().all(|top| (1.9..2.2).contains(top)), "{found:?}");
        assert!(found.iter().all(|top| (top - found[0]).abs() < 1.0e-4), "{found:?}");
        assert!(edges(&on_wall(1)).is_empty(), "drops");
    }

    /// Each drawn pane is handed to the renderer as well: in the plane of the wall's inner face, from the floor to its
    /// upper edge, with its normal out of the basin.
    #[test]
    fn panes_face_out_of_the_basin() {
        let dam: Vec<_> =
            (0..12_000).map(|i| [i % 20, i / 20 % 30, i / 600].map(|i| 0.1 * i as f32)).collect();
        let bounds = Bounds::of_bulk(&dam).unwrap();
        let middle = bounds.center();
        for (eye, from_all_sides, wanted) in [
            (Vec3::new(9.0, 5.0, 9.0), false, vec![Vec3::X, Vec3::Z]),
            (Vec3::new(-9.0, 5.0, 9.0), false, vec![-Vec3::X, Vec3::Z]),
            (Vec3::new(9.0, 5.0, -9.0), true, vec![-Vec3::X, Vec3::X, -Vec3::Z, Vec3::Z]),
        ] {
            let from = (eye, from_all_sides);
            let scene = basin_round(&[&dam], &bounds, 0.1, from, SetArg::Pool, &[]).unwrap();
            let normals = scene.panes.iter().map(|pane| {
                let [a, b] = pane.edges.map(Vec3::from);
                let normal = a.cross(b).normalize();
                // The block's faces lie at 0 and 1.9, its floor at 0, its top at 2.9.
                let corner = Vec3::from(pane.corner);
                let far = corner + a + b;
                assert!((normal.dot(corner - middle) - 0.95).abs() < 0.02, "{pane:?}");
                assert!(corner.y.abs() < 0.01 && (2.9..3.2).contains(&far.y), "{pane:?}");
                normal
            });
            assert_eq!(normals.collect::<Vec<_>>(), wanted);
            let mounts = scene.meshes.iter().filter(|mesh| mesh.name == "pane foot");
            assert_eq!(mounts.count(), wanted.len());
        }
    }

    /// Water that stands a little higher than a wall is held by glass, and not by air.
    #[test]
    fn panes_hold_water_that_rests_above_the_walls() {
        // Coarse particles: 3 rows higher than the near walls.
        let tank: Vec<_> =
            (0..20 * 6 * 12).map(|i| [i % 20, i / 20 % 6, i / 120].map(|i| i as f32)).collect();
        let bounds = Bounds::of_bulk(&tank).unwrap();
        let from = (Vec3::new(60.0, 30.0, 60.0), false);
        let scene = basin_round(&[&tank], &bounds, 1.0, from, SetArg::Pool, &[]).unwrap();
        assert_eq!(scene.panes.len(), 2);
        assert!(scene.backdrop.iter().any(|mesh| mesh.name == "pane edge"));
        // Fine particles, which rest above the walls by less than the glass is thick: its edges stay right side out.
        let (fine, wide) = (2.0e-3, 2.95);
        let round = (0..1475).flat_map(|i| {
            let at = fine * i as f32;
            [[at, 0.0], [at, wide], [0.0, at], [wide, at]]
        });
        let rows = [0.0, 0.35, 0.352, 0.354, 0.356];
        let thin: Vec<_> = round.flat_map(|[x, z]| rows.map(|y| [x, y, z])).collect();
        let bounds = Bounds::of_bulk(&thin).unwrap();
        let from = (Vec3::new(9.0, 5.0, 9.0), false);
        let scene = basin_round(&[&thin], &bounds, fine, from, SetArg::Pool, &[]).unwrap();
        assert_eq!(scene.panes.len(), 2);
        for mesh in scene.backdrop.iter().filter(|mesh| mesh.name == "pane edge") {
            let points = mesh.positions.iter().map(|p| Vec3::from(*p));
            let middle = points.clone().sum::<Vec3>() / mesh.positions.len() as f32;
            for (p, normal) in points.zip(&mesh.normals) {
                assert!((p - middle).dot(Vec3::from(*normal)) > 0.0, "{p} {normal:?}");
            }
        }
    }

    /// If a high dam of water stands in only one frame, the first or another, the panes of glass on the basin's walls
    /// are as high as the dam.
    #[test]
    fn panes_hold_the_dam_that_falls() {
        let dam: Vec<_> =
            (0..12_000).map(|i| [i % 20, i / 20 % 30, i / 600].map(|i| 0.1 * i as f32)).collect();
        let pool = shallow();
        let frames = vec![&pool[..]; 12];
        let top = |frames: &[&[[f32; 3]]]| {
            let bounds = frames.iter().filter_map(|frame| Bounds::of_bulk(frame));
            let bounds = bounds.reduce(|a, b| a.union(&b)).unwrap();
            let seen_from = (Vec3::new(9.0, 5.0, 9.0), false);
            let scene = basin_round(frames, &bounds, 0.1, seen_from, SetArg::Pool, &[]).unwrap();
            let panes = scene.backdrop.iter().filter(|mesh| mesh.name == "pane edge");
            let points = panes.flat_map(|mesh| {
                mesh.positions.iter().map(|p| mesh.transform.transform_point3((*p).into()).y)
            });
            points.fold(f32::MIN, f32::max)
        };
        assert_eq!(top(&frames), f32::MIN, "the walls hold it");
        for at in [0, 7, 11] {
            let mut frames = frames.clone();
            frames[at] = &dam;
            assert!((2.8..3.2).contains(&top(&frames)), "{at}: {}", top(&frames));
        }
    }

    #[test]
    fn slabs_have_round_sizes() {
        for (rough, expected) in
            [(0.3, 0.5), (0.12, 0.1), (1.1, 1.0), (7.9, 10.0), (2.0e-5, 2.0e-5)]
        {
            assert!((round_length(rough) / expected - 1.0).abs() < 1.0e-4, "{rough}");
        }
    }
}
