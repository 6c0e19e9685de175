//! What orders the passes of shoreline foam by its buffers, of which a validation layer sees a part: a log of all barriers,
//! and each left out in turn.

use ash::vk;
use whitewater::shore::Edge;
use whitewater::water::Shading;
use whitewater::{Config, Frame, Shore, Shoreline, Slot};

use super::composite::look;
use super::shoreline::{AREA, heights};
use super::{Mapped, with_shore};
use crate::harness::is_hazard;
use crate::support::device::{Gpu, validates};
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::Lens;
use crate::support::spy::{self, By, Event, Scope};

type Stage = vk::PipelineStageFlags2;
type Mask = vk::AccessFlags2;

const READ: Mask = Mask::SHADER_STORAGE_READ;
const WRITE: Mask = Mask::SHADER_STORAGE_WRITE;
const BOTH: Mask = Mask::from_raw(READ.as_raw() | WRITE.as_raw());

/// How a frame uses a buffer, in its order.
type Uses = [(By, Mask)];

/// By a fill, the tiles' marks, the lists.
const MARKS: &Uses =
    &[(By::Transfer, Mask::TRANSFER_WRITE), (By::Compute, BOTH), (By::Compute, READ)];
/// By the lists, the shading of each of three, the coat's draw.
const LIST: &Uses = &[
    (By::Compute, WRITE),
    (By::Compute, READ),
    (By::Compute, READ),
    (By::Compute, READ),
    (By::Graphics, READ),
];
/// By an update, the lists, the shading of each, which they are the arguments of too, the coat's draw.
const ARGUMENTS: &Uses = &[
    (By::Transfer, Mask::TRANSFER_WRITE),
    (By::Compute, BOTH),
    (By::Compute, READ),
    (By::Indirect, Mask::INDIRECT_COMMAND_READ),
    (By::Compute, READ),
    (By::Indirect, Mask::INDIRECT_COMMAND_READ),
    (By::Compute, READ),
    (By::Indirect, Mask::INDIRECT_COMMAND_READ),
    (By::Indirect, Mask::INDIRECT_COMMAND_READ),
];

/// A use, and what is ordered after it.
struct Past {
    scope: Scope,
    after: Vec<Scope>,
}

fn is_write(access: Mask) -> bool {
    access.intersects(WRITE | Mask::TRANSFER_WRITE)
}

/// What is wrong with the order of a buffer's uses, of frame after frame: each must be after the write before it, and a write
/// after all reads since, by a barrier between them. (Which is narrower than Vulkan, to which a chain of them will do.)
fn unordered(events: &[Event], buffer: vk::Buffer, uses: &Uses) -> Vec<String> {
    let mut wrong = Vec::new();
    let (mut past, mut count): (Vec<Past>, usize) = (Vec::new(), 0);
    for event in events {
        match *event {
            Event::Barrier { buffer: of, before: (stage, access), after } => {
                for own in past.iter_mut().filter(|_| of.is_none_or(|of| of == buffer)) {
                    let (by, how) = own.scope;
                    let seen =
                        !is_write(how) || access.contains(how & (WRITE | Mask::TRANSFER_WRITE));
                    if stage.contains(by) && seen {
                        own.after.push(after);
                    }
                }
            }
            Event::Use { buffer: of, by } if of == buffer => {
                let (expected, access) = uses[count % uses.len()];
                if by != expected {
                    wrong.push(format!("use {count} is by {by:?}, not {expected:?}"));
                    return wrong;
                }
                let stage = match by {
                    // As older layers book it (src/gpu/access.rs).
                    By::Transfer => Stage::ALL_TRANSFER,
                    By::Compute => Stage::COMPUTE_SHADER,
                    By::Graphics => Stage::VERTEX_SHADER,
                    By::Indirect => Stage::DRAW_INDIRECT,
                };
                let reads = past.iter().any(|own| !is_write(own.scope.1));
                for (i, own) in past.iter().enumerate() {
                    let wrote = is_write(own.scope.1);
                    // Reads are after the write before: a write after them is after that too.
                    let needed = wrote != (is_write(access) && reads);
                    let ordered =
                        |(to, how): &Scope| to.contains(stage) && (!wrote || how.contains(access));
                    if needed && !own.after.iter().any(ordered) {
                        wrong.push(format!("use {count} is not after {i} of {}", past.len()));
                    }
                }
                if is_write(access) {
                    past.clear();
                }
                past.push(Past { scope: (stage, access), after: Vec::new() });
                count += 1;
            }
            Event::Use { .. } => {}
        }
    }
    if count == 0 || count % uses.len() != 0 {
        wrong.push(format!("{count} uses, of {} a frame", uses.len()));
    }
    wrong
}

/// What two frames after each other do with buffers; they are thrown away: what is wrong on purpose no device need survive.
fn recorded(rig: &mut Rig<'_>, shot: &Shot) -> Vec<Event> {
    let (color, depth) = rig.scene(shot);
    let cloud = rig.particles(shot);
    let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    let cmd = rig.stub.begin(0);
    spy::watch();
    for slot in [0, 1].map(Slot) {
        // SAFETY: cmd is recording and never submitted.
        unsafe { rig.renderer().record(cmd, &Frame { slot, ..frame }) }.expect("record");
    }
    let events = spy::take_events();
    rig.stub.throw_away(0);
    (0..2).for_each(|slot| rig.renderer().abandon(Slot(slot)));
    events
}

/// Every barrier is needed, and what goes on without it is seen: by the log; by the validation layer too, but for one.
///
/// That is between the marks and the lists. Layer 1.3.239 takes a buffer that a shader changes by atomics alone for one that
/// is read: to it nothing is written there. (With a store in place of the atomic it sees it.) And a device that ends a
/// dispatch before it begins another, as lavapipe, draws the same picture without any of these barriers.
#[test]
fn each_barrier_of_the_tiles_lists_is_needed() {
    let mut gpu = Gpu::spied();
    spy::install(&mut gpu);
    // 13 by 11 tiles: no other buffer is as large.
    let size = extent(200, 170);
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, |at| 0.4 * (at.x - 7.0)), None);
    let config = Config { composite: Some(Shading::Raster), ..with_shore(size, Edge::Smooth) };
    let mut rig = Rig::with_slots(&gpu, &config, 2);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    shot.settings.shore = look();
    let shoreline = Some(Shoreline::Map(coasts.coast()));
    shot.shore = Some(Shore { shoreline, ..Shore::new(AREA.level) });
    let good = recorded(&mut rig, &shot);
    let one = |bytes| match spy::buffers_of_size(bytes)[..] {
        [buffer] => buffer,
        ref all => panic!("{} buffers of {bytes} bytes", all.len()),
    };
    let [marks, list] = [one(4 * 13 * 11), one(16 * 13 * 11)];
    let beside = spy::buffers_beside(marks);
    let arguments = spy::buffers_of_size(64).into_iter().find(|own| beside.contains(own));
    let arguments = arguments.expect("in a set with the marks");
    // Of each barrier of a frame, the first of which is after the frame before, whether the layer sees that it is missing.
    for (name, buffer, uses, seen) in [
        ("marks", marks, MARKS, &[true, true, false][..]),
        ("list", list, LIST, &[true, true]),
        ("arguments", arguments, ARGUMENTS, &[true, true, true]),
    ] {
        assert_eq!(unordered(&good, buffer, uses), Vec::<String>::new(), "{name}");
        let own = |event: &&Event| matches!(event, Event::Barrier { buffer: Some(of), .. } if *of == buffer);
        assert_eq!(
            good.iter().filter(own).count(),
            2 * seen.len(),
            "{name}: barriers of two frames"
        );
        assert_eq!(gpu.expect_messages(), Vec::<String>::new(), "{name}: no fault, no message");
        // Before the first there is nothing.
        for nth in 1..2 * seen.len() {
            spy::leave_out(buffer, nth);
            let events = recorded(&mut rig, &shot);
            let wrong = unordered(&events, buffer, uses);
            let messages = gpu.expect_messages();
            println!("{name} {nth}: {} uses, {} messages", wrong.len(), messages.len());
            assert!(!wrong.is_empty(), "{name}: without barrier {nth} nothing is wrong");
            if validates() && seen[nth % seen.len()] {
                let hazard = messages.iter().any(|message| is_hazard(message));
                assert!(hazard, "{name}: without barrier {nth} the layer says {messages:?}");
            }
        }
    }
}
