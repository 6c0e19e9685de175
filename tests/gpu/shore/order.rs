//! Ordering of the shoreline passes by barriers on its buffers, of which a validation layer checks only a part: all
//! barriers are logged, and each is left out in turn.

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

/// How a frame uses a buffer, in its order; of a part of it, none where a command has the rest.
type Uses = Vec<(By, Mask)>;

const UPDATE: (By, Mask) = (By::Transfer, Mask::TRANSFER_WRITE);
const COMMAND: (By, Mask) = (By::Indirect, Mask::INDIRECT_COMMAND_READ);
const NO_COMMAND: (By, Mask) = (By::Indirect, Mask::empty());

fn compute(how: Mask) -> (By, Mask) {
    (By::Compute, how)
}

/// What of a frame there is once or not at all: a strip, contact foam on the particles' water.
#[derive(Clone, Copy)]
struct Has {
    strip: usize,
    contacts: usize,
}

/// A buffer's uses: by what fills it and lists tiles; by what a strip has of it, the shading of each of three lists, and what
/// makes runs of tiles; by what lists and shades tiles of the particles' water; by the coat's draw.
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

/// Which tiles have foam.
fn uses_of_marks(has: Has) -> [Uses; 1] {
    let adds = [compute(BOTH)];
    [uses(has, &[UPDATE], [&adds, &adds, &[compute(READ)]], &[], &[])]
}

/// The lists of the surface; the runs of tiles that have foam; the list of the particles' water.
fn uses_of_lists(has: Has) -> [Uses; 3] {
    let (writes, reads, none) = ([compute(WRITE)], [compute(READ)], [compute(Mask::empty())]);
    let (idle, undrawn) = (none.repeat(2), [(By::Graphics, Mask::empty())]);
    [
        uses(has, &writes, [&[], &reads, &none], &idle, &undrawn),
        uses(has, &none, [&[], &none, &writes], &idle, &[(By::Graphics, READ)]),
        uses(has, &none, [&[], &none, &none], &[writes, reads].concat(), &undrawn),
    ]
}

/// The arguments: of the dispatches over the surface's lists, with how many tiles each has; of the draw of those that have
/// foam; of the dispatch over the list of the particles' water, where that is.
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
        unsafe { rig.renderer().record(cmd, &frame.with(|it| it.slot = slot)) }.expect("record");
    }
    let events = spy::take_events();
    rig.stub.throw_away(0);
    (0..2).for_each(|slot| rig.abandon(Slot(slot)));
    events
}

/// Every barrier is needed, and what goes on without it is seen: by the log; by the validation layer too, but for some.
///
/// Those are after dispatches that change a buffer by atomics alone, which layer 1.3.239 takes for one that is read, and
/// between dispatches of which both write one. And a device that ends a dispatch before it begins another, as lavapipe,
/// draws the same picture without any of these barriers.
#[test]
fn each_barrier_of_the_tiles_lists_is_needed() {
    let mut gpu = Gpu::spied();
    spy::install(&mut gpu);
    // 25 by 22 tiles: no other buffer is as large.
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
        // Of a frame's barriers, of which the first is after the frame before, those that the layer sees to be missing:
        // 1.3.239 and 1.4.309, seen on Debian 12 and 13, see more of them than Chromium's, which is newer.
        let last = 3 + 2 * contacts;
        let seen: [&dyn Fn(usize) -> bool; 3] =
            if layer_version() <= vk::make_api_version(0, 1, 4, 309) {
                [&|at| at < 2, &|at| at == 0 || at == 2 || at == last, &|at| at < 3]
            } else {
                [&|at| at == 1, &|at| at == last, &|at| at == 1]
            };
        // Which of them is that before the runs.
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
            // Before the first there is nothing.
            for nth in 1..2 * barriers {
                spy::leave_out(buffer, nth);
                let events = recorded(&mut rig, &shot);
                let wrong = wrong_of(&events);
                let messages = gpu.expect_messages();
                println!("{name} {nth}: {} uses, {} messages", wrong.len(), messages.len());
                // Those before the runs and before the tiles of the particles' water are for those who take a buffer for one:
                // of their own list and arguments all is ordered before; of the runs it is after the latter.
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
