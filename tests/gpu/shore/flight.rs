//! Frames in flight that show a distance map which changes between them.

use glam::{DVec2, Mat4};
use whitewater::shore::{Area, Edge, Heights, ShoreMapStep};
use whitewater::{Recorded, Shore, Shoreline, Slot};

use super::map::Mesh;
use super::shoreline::{AREA, heights, plain};
use super::{Mapped, with_shore};
use crate::reference::Image;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::{HOST_WRITE, Texture};
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::Lens;

const SLOTS: u32 = 2;
const FRAMES: u32 = 12;

/// Centre of an island that moves from frame to frame.
fn middle(frame: u32) -> DVec2 {
    DVec2::new(7.0 + 0.7 * f64::from(frame % 5), -5.0 - 0.5 * f64::from(frame % 3))
}

/// The map's area, which moves every fourth frame.
fn area(frame: u32) -> Area {
    Area { center: [7.0 + 0.5 * (frame / 4) as f32, -5.0], ..AREA }
}

/// How a frame updates the map: all of it from an image, a part from an image, all from a mesh, or
/// not at all.
enum Land {
    All(Texture),
    Part(Texture, [[f32; 2]; 2]),
    Mesh(Box<Mesh>),
    Same,
}

fn land(coasts: &Mapped<'_>, frame: u32) -> Land {
    let (area, middle) = (area(frame), middle(frame));
    let height = |at: DVec2| 0.4 * (3.0 - (at - middle).length());
    let image = || coasts.image(&heights(&area, coasts.size, height));
    match frame % 4 {
        0 => Land::All(image()),
        1 => Land::Part(image(), [[-9.0, -21.0], [23.0, 11.0]]),
        2 => Land::Mesh(Box::new(Mesh::of(coasts, &area, height))),
        _ => Land::Same,
    }
}

/// Draws all frames with one renderer and one map, which is updated in the first `steps` frames.
/// Waits after each frame, or only when its slot is used again.
fn drawn(gpu: &Gpu, steps: u32, wait: bool) -> Vec<Image<[f32; 4]>> {
    let size = extent(96, 64);
    let mut coasts = Mapped::with_slots(gpu, 64, SLOTS);
    let mut rig = Rig::with_slots(gpu, &with_shore(size, Edge::Smooth), SLOTS);
    // All data is uploaded before, because an upload between frames would wait.
    let mut shots: Vec<_> = (0..FRAMES)
        .map(|frame| {
            let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
            shot.settings.shore = plain();
            shot.settings.shore.time += 0.1 * f64::from(frame);
            shot
        })
        .collect();
    let cloud = rig.particles(&shots[0]);
    let scenes: Vec<_> = shots.iter().map(|shot| rig.scene(shot)).collect();
    let lands: Vec<_> = (0..FRAMES).map(|frame| land(&coasts, frame)).collect();
    for (frame, shot) in (0..FRAMES).zip(&mut shots) {
        let slot = frame % SLOTS;
        rig.stub.wait(slot);
        rig.collect(Slot(slot));
        let cmd = rig.stub.begin(slot);
        let meshes;
        let (heights, changed) = match &lands[frame as usize] {
            Land::All(image) => (Some(Heights::Image(image.host_image())), None),
            Land::Part(image, part) => (Some(Heights::Image(image.host_image())), Some(*part)),
            Land::Mesh(mesh) => {
                meshes = [mesh.mesh(Mat4::IDENTITY)];
                (Some(Heights::Meshes(&meshes)), None)
            }
            Land::Same => (None, None),
        };
        if let Some(heights) = heights.filter(|_| frame < steps) {
            let (area, before, after) = (area(frame), HOST_WRITE, HOST_WRITE);
            let step = ShoreMapStep::new(Slot(slot), area, heights).with(|it| {
                it.changed = changed;
                it.before = before;
                it.after = after;
            });
            let map = coasts.map.as_mut().expect("only drop takes it");
            // SAFETY: cmd is recording, the slot was waited for, and all handles live until the end
            // of this function.
            unsafe { map.record_step(cmd, &step) }.expect("a step");
        }
        let shoreline = Some(Shoreline::Map(coasts.shore_distances()));
        shot.shore = Some(Shore::new(AREA.level).with(|it| it.shoreline = shoreline));
        let (color, depth) = &scenes[frame as usize];
        let frame = shot
            .frame(color.host_image(), depth.host_image(), cloud.particles())
            .with(|it| it.slot = Slot(slot));
        // SAFETY: as above.
        unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
        rig.stub.end(slot);
        if wait {
            rig.stub.wait(slot);
        }
    }
    (0..SLOTS).for_each(|slot| rig.stub.wait(slot));
    let nothing = Recorded::default();
    scenes.iter().map(|(color, _)| rig.read(&color.host_image(), &nothing).output).collect()
}

/// If the map is updated while frames are in flight, each frame still shows the map at the time of
/// its record.
#[test]
fn frames_in_flight_show_their_own_map() {
    let gpu = Gpu::shared();
    let [expected, found] = [true, false].map(|wait| drawn(&gpu, FRAMES, wait));
    for (frame, (found, expected)) in found.iter().zip(&expected).enumerate() {
        compare::same_color(&format!("shore-flight-{frame}"), found, expected);
    }
    let first = drawn(&gpu, 1, true);
    for (frame, (first, own)) in first.iter().zip(&expected).enumerate().skip(1) {
        let differ = first.data.iter().zip(&own.data).filter(|(a, b)| a != b).count();
        assert!(differ > 200, "{frame}: with the first map {differ} pixels are others");
    }
}
