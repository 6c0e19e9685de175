//! Checks the barriers on the shoreline passes' buffers, of which a validation layer checks only a
//! part. The test logs all barriers, and leaves out each in turn.

use ash::vk;
use whitewater::shore::Edge;
use whitewater::water::Shading;
use whitewater::{Shore, Shoreline, Slot, Strip, Triangles};

use super::composite::look;
use super::shoreline::{AREA, heights};
use super::{Mapped, with_shore};
use crate::harness::is_hazard;
use crate::support::device::{Gpu, layer_version, sees_storage};
use crate::support::host::HOST_WRITE;
use crate::support::rig::{Rig, Shot, extent, stream};
use crate::support::scenes::Lens;
use crate::support::spy::{self, By, Event, Scope};

type Stage = vk::PipelineStageFlags2;
type Mask = vk::AccessFlags2;

const READ: Mask = Mask::SHADER_STORAGE_READ;
const WRITE: Mask = Mask::SHADER_STORAGE_WRITE;
const BOTH: Mask = Mask::from_raw(READ.as_raw() | WRITE.as_raw());

/// How a frame uses a part of a buffer, in order. An access without flags means that this command
/// uses another part.
type Uses = Vec<(By, Mask)>;

const UPDATE: (By, Mask) = (By::Transfer, Mask::TRANSFER_WRITE);
const COMMAND: (By, Mask) = (By::Indirect, Mask::INDIRECT_COMMAND_READ);
const NO_COMMAND: (By, Mask) = (By::Indirect, Mask::empty());

fn compute(how: Mask) -> (By, Mask) {
    (By::Compute, how)
}

/// What a frame may have once or not at all: a strip, and contact foam on the particles' water.
#[derive(Clone, Copy)]
struct Has {
    strip: usize,
    contacts: usize,
}

/// Uses of a buffer in order: filling it and listing tiles; drawing the strip; shading the three
/// lists; making runs of tiles; listing and shading tiles of the particles' water; drawing the
/// coat.
fn uses(
    has: Has,
    filled: &[(By, Mask)],
    [strip, shading, runs]: [&[(By, Mask)]; 3],
    contacts: &[(By, Mask)],
    draw: &[(By, Mask)],
) -> Uses {
    let (strip, contacts) = (strip.repeat(has.strip), contacts.repeat(has.contacts));
    [filled, &strip, &shading.repeat(3), runs, &contacts, draw].concat()
}

/// The marks of tiles with foam.
fn uses_of_marks(has: Has) -> [Uses; 1] {
    let adds = [compute(BOTH)];
    [uses(has, &[UPDATE], [&adds, &adds, &[compute(READ)]], &[], &[])]
}

/// The lists of the surface's tiles; the runs of tiles with foam; the list of tiles of the
/// particles' water.
fn uses_of_lists(has: Has) -> [Uses; 3] {
    let (writes, reads, none) = ([compute(WRITE)], [compute(READ)], [compute(Mask::empty())]);
    let (idle, undrawn) = (none.repeat(2), [(By::Graphics, Mask::empty())]);
    [
        uses(has, &writes, [&[], &reads, &none], &idle, &undrawn),
        uses(has, &none, [&[], &none, &writes], &idle, &[(By::Graphics, READ)]),
        uses(has, &none, [&[], &none, &none], &[writes, reads].concat(), &undrawn),
    ]
}

/// The arguments: of the dispatches over the surface's lists, with the lists' lengths; of the draw
/// of tiles with foam; of the dispatch over the list of the particles' water, if there is one.
fn uses_of_arguments(has: Has) -> Vec<Uses> {
    let none = compute(Mask::empty());
    let idle = [none, none, NO_COMMAND];
    let (lists, unread) = ([compute(READ), COMMAND], [none, NO_COMMAND]);
    let contacts = [compute(BOTH), compute(READ), COMMAND];
    let all = [
        uses(has, &[UPDATE, compute(BOTH)], [&[], &lists, &[none]], &idle, &[NO_COMMAND]),
        uses(has, &[UPDATE, none], [&[], &unread, &[compute(BOTH)]], &idle, &[COMMAND]),
        uses(has, &[UPDATE, none], [&[], &unread, &[none]], &contacts, &[NO_COMMAND]),
    ];
    all[..2 + has.contacts].to_vec()
}

/// A use of a buffer, and the scopes that barriers order after it.
struct Past {
    scope: Scope,
    after: Vec<Scope>,
}

fn is_write(access: Mask) -> bool {
    access.intersects(WRITE | Mask::TRANSFER_WRITE)
}

/// What is wrong with the order of a buffer's uses over two frames. Each use must come after the
/// write before it, and a write after all reads since the last write, by a single barrier. (Vulkan
/// also permits a chain of barriers.)
fn unordered(events: &[Event], buffer: vk::Buffer, uses: &[(By, Mask)]) -> Vec<String> {
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
                if access.is_empty() {
                    count += 1;
                    continue;
                }
                let stage = match by {
                    // The stages that older passes use for these commands (src/gpu/access.rs).
                    By::Transfer => Stage::ALL_TRANSFER,
                    By::Compute => Stage::COMPUTE_SHADER,
                    By::Graphics => Stage::VERTEX_SHADER,
                    By::Indirect => Stage::DRAW_INDIRECT,
                };
                let reads = past.iter().any(|own| !is_write(own.scope.1));
                for (i, own) in past.iter().enumerate() {
                    let wrote = is_write(own.scope.1);
                    // If there are reads since the last write, a write only needs to come after
                    // those reads, which come after that write.
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

/// Records two consecutive frames and returns what they do with buffers. The commands are thrown
/// away, so faults cannot reach the device.
fn recorded(rig: &mut Rig<'_>, shot: &Shot) -> Vec<Event> {
    let (color, depth) = rig.scene(shot);
    let cloud = rig.particles(shot);
    let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    let cmd = rig.stub.begin(0);
    spy::watch();
    for slot in [0, 1].map(Slot) {
        // SAFETY: cmd is recording and never submitted.
        unsafe { rig.renderer().record(cmd, &frame.with(|it| it.slot = slot)) }.expect("record");
    }
    let events = spy::take_events();
    rig.stub.throw_away(0);
    (0..2).for_each(|slot| rig.abandon(Slot(slot)));
    events
}

/// Every barrier is needed: without it the log shows an error, and mostly the validation layer does
/// too.
///
/// The layer misses barriers after dispatches that only use atomics on a buffer, which layer
/// 1.3.239 treats as reads, and between dispatches that both write a buffer. A device like
/// lavapipe, which ends each dispatch before the next, draws the same picture without any of these
/// barriers.
#[test]
fn each_barrier_of_the_tiles_lists_is_needed() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    // 25 by 22 tiles; no other buffer has this size.
    let size = extent(200, 170);
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, |at| 0.4 * (at.x - 7.0)), None);
    let config = with_shore(size, Edge::Smooth).with(|it| it.composite = Some(Shading::Raster));
    let mut rig = Rig::with_slots(&gpu, &config, 2);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    shot.settings.shore = look();
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let corners = [[4.0_f32, 0.0, -9.0, 0.0], [11.0, 0.0, -9.0, 1.0], [4.0, 0.0, -1.0, 2.0]];
    let vertices = rig.stub.data(bytemuck::cast_slice(&corners), usage);
    let strip = Shoreline::Strip(Strip {
        triangles: Triangles { positions: stream(&vertices, 0, 16), vertices: 3, indices: None },
        coordinates: stream(&vertices, 12, 16),
        before: HOST_WRITE,
        after: HOST_WRITE,
    });
    let map = Shoreline::Map(coasts.shore_distances());
    for (way, shoreline, strip, contacts) in
        [("map", map, 0, 0), ("strip", strip, 1, 0), ("particles", map, 0, 1)]
    {
        let has = Has { strip, contacts };
        shot.settings.shore.contact.particle_opacity = contacts as f32;
        shot.shore = Some(Shore::new(AREA.level).with(|it| it.shoreline = Some(shoreline)));
        let good = recorded(&mut rig, &shot);
        let one = |bytes| match spy::buffers_of_size(bytes)[..] {
            [buffer] => buffer,
            ref all => panic!("{} buffers of {bytes} bytes", all.len()),
        };
        let [marks, list] = [one(4 * 25 * 22), one(20 * 25 * 22)];
        let beside = spy::buffers_beside(marks);
        let arguments = spy::buffers_of_size(96).into_iter().find(|own| beside.contains(own));
        let arguments = arguments.expect("in a set with the marks");
        // Barriers of a frame that the layer reports if they are missing; the first one orders a
        // frame after the frame before. Versions 1.3.239 and 1.4.309, as on Debian 12 and 13,
        // report more than the newer one of Chromium.
        let last = 3 + 2 * contacts;
        let seen: [&dyn Fn(usize) -> bool; 3] =
            if layer_version() <= vk::make_api_version(0, 1, 4, 309) {
                [&|at| at < 2, &|at| at == 0 || at == 2 || at == last, &|at| at < 3]
            } else {
                [&|at| at == 1, &|at| at == last, &|at| at == 1]
            };
        // Index of the barrier before the runs.
        let of_marks = 4 + strip;
        for (name, buffer, uses, [runs, barriers], seen) in [
            ("marks", marks, uses_of_marks(has).to_vec(), [of_marks, of_marks + 1], seen[0]),
            ("list", list, uses_of_lists(has).to_vec(), [2, last + 1], seen[1]),
            ("arguments", arguments, uses_of_arguments(has), [3, last + 2], seen[2]),
        ] {
            let name = format!("{way}, {name}");
            let wrong_of = |events: &[Event]| -> Vec<String> {
                uses.iter().flat_map(|uses| unordered(events, buffer, uses)).collect()
            };
            assert_eq!(wrong_of(&good), Vec::<String>::new(), "{name}");
            let own = |event: &&Event| matches!(event, Event::Barrier { buffer: Some(of), .. } if *of == buffer);
            assert_eq!(good.iter().filter(own).count(), 2 * barriers, "{name}: of two frames");
            assert_eq!(gpu.expect_messages(), Vec::<String>::new(), "{name}: no fault, no message");
            // Before the very first barrier no use needs it.
            for nth in 1..2 * barriers {
                spy::leave_out(buffer, nth);
                let events = recorded(&mut rig, &shot);
                let wrong = wrong_of(&events);
                let messages = gpu.expect_messages();
                println!("{name} {nth}: {} uses, {} messages", wrong.len(), messages.len());
                // The barriers before the runs and before the tiles of the particles' water cover
                // the whole buffer for validation. The parts used there are already ordered by
                // others.
                let spare =
                    buffer != marks && (runs..=runs + 2 * contacts).contains(&(nth % barriers));
                assert!(
                    spare || !wrong.is_empty(),
                    "{name}: without barrier {nth} nothing is wrong"
                );
                if sees_storage() && seen(nth % barriers) {
                    let hazard = messages.iter().any(|message| is_hazard(message));
                    assert!(hazard, "{name}: without barrier {nth} the layer says {messages:?}");
                }
            }
        }
    }
}
