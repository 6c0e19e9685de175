//! Whatever bits a host's streams hold, a frame ends and is finite: NaN, infinities, the largest and
//! smallest numbers, random bits. A driver that ends endless loops by
//! itself (lavapipe before Mesa 25) hides some faults, so these tests also run on a newer one.

use ash::vk;
use whitewater::bubbles::{BubbleConfig, Crossfade};
use whitewater::headless::Bubble;
use whitewater::water::Shading;
use whitewater::{Blobs, Count, Packets, Particles, Previous, WhitewaterParticles};
use whitewater::{Slot, Stream};
use whitewater::{WhitewaterConfig, WhitewaterSplat};

use crate::light::everything;
use crate::support::device::Gpu;
use crate::support::host::{Data, HOST_WRITE};
use crate::support::rig::{Rig, stream};
use crate::support::scenes::{self, Lens, Random};
use crate::surface_foam::Foamy;

const SIZE: vk::Extent2D = vk::Extent2D { width: 64, height: 48 };
const USAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;

/// Kinds of bits for a word, taken in turn. `None` means random bits.
const BITS: [Option<u32>; 13] = [
    Some(0x7fc0_0000), // NaN
    Some(0xff80_0001), // negative signalling NaN
    Some(0x7f80_0000), // infinity
    Some(0xff80_0000),
    Some(0x7f7f_ffff), // the largest
    Some(0xff7f_ffff),
    Some(0x0000_0001), // smallest denormal, then smallest normal
    Some(0x0080_0000),
    Some(0x7149_f2ca), // 1e30
    Some(0x0da2_4260), // 1e-30
    Some(0x8000_0000), // -0
    Some(0xffff_ffff),
    None,
];

/// Changes two of three entries: in some all words, in others one word. Each kind of bits comes to
/// each place if there are 39 entries for each word, and 39 for all words.
pub fn spoil(words: &mut [u32], entry: usize, random: &mut Random) {
    for (i, entry) in words.chunks_mut(entry).enumerate().filter(|(i, _)| i % 3 > 0) {
        let all = entry.len();
        let one = (i / 3) % (all + 1);
        for (k, word) in entry.iter_mut().enumerate() {
            if one == all || one == k {
                *word = BITS[(i / 3 + k) % BITS.len()].unwrap_or_else(|| random.bits() as u32);
            }
        }
    }
}

/// Changes two of three entries by the next pairs of a kind of bits and a place (a word, or all
/// words), from this pair on. Returns the pair after the last.
fn spoil_from(first: usize, words: &mut [u32], entry: usize, random: &mut Random) -> usize {
    let spoilt = words.chunks_mut(entry).enumerate().filter(|(i, _)| i % 3 > 0);
    let mut next = first;
    for (_, entry) in spoilt {
        let all = entry.len();
        let (kind, one) = (next % BITS.len(), next / BITS.len() % (all + 1));
        for (k, word) in entry.iter_mut().enumerate() {
            if one == all || one == k {
                *word = BITS[(kind + k) % BITS.len()].unwrap_or_else(|| random.bits() as u32);
            }
        }
        next += 1;
    }
    next
}

/// Name and words of a stream, and the number of words per entry.
#[derive(Clone)]
struct Words(&'static str, Vec<u32>, usize);

impl Words {
    fn of<T: bytemuck::NoUninit>(name: &'static str, entries: &[T]) -> Self {
        Self(name, bytemuck::cast_slice(entries).to_vec(), size_of::<T>() / 4)
    }
}

/// The streams of a frame with everything, in this order.
fn streams(case: &Foamy) -> Vec<Words> {
    let shot = &case.shot;
    let (points, mut random) = (scenes::cloud(7, 300, 1.0, 9.0), Random(3));
    let whitewater = scenes::world(&shot.camera, &points);
    let count = whitewater.len() as u32;
    let packets = |count: u32| -> Vec<[u32; 8]> {
        let wide = 1e3_f32.to_bits();
        let low = (-1e3_f32).to_bits();
        // They are small, so that they are many.
        (0..count / 2).map(|i| [2 * i, 2, low, low, low, wide, wide, wide]).collect()
    };
    let blob = |p: &[f32; 3], i: usize| Bubble {
        ball: [p[0], p[1], p[2], 0.3],
        turn: [0.1, 0.2, 0.3, 0.9],
        id: i as u32,
    };
    let blobs: Vec<_> = whitewater.iter().take(60).enumerate().map(|(i, p)| blob(p, i)).collect();
    let radii: Vec<f32> = (0..count).map(|_| random.between(0.001, 0.4)).collect();
    vec![
        Words::of("positions", &shot.positions),
        Words::of("densities", shot.densities.as_ref().expect("densities")),
        Words::of("velocities", &case.velocities),
        Words::of("foam", &case.amounts),
        Words::of("ids", case.ids.as_ref().expect("ids")),
        Words::of("packets", &packets(shot.positions.len() as u32)),
        Words::of("whitewater positions", &whitewater),
        Words::of("whitewater kinds", &(0..count).map(|i| i % 4).collect::<Vec<_>>()),
        Words::of("whitewater radii", &radii),
        Words::of("whitewater ages", &radii),
        Words::of("whitewater ids", &(0..count).collect::<Vec<_>>()),
        Words::of("whitewater packets", &packets(count)),
        Words::of("blobs", &blobs),
        Words::of("count", &[shot.positions.len() as u32]),
        Words::of("whitewater count", &[count]),
        Words::of("blob count", &[60]),
    ]
}

fn draw(rig: &mut Rig<'_>, case: &Foamy, all: &[Words]) -> Vec<[f32; 4]> {
    let data: Vec<Data> =
        all.iter().map(|w| rig.stub.data(bytemuck::cast_slice(&w.1), USAGE)).collect();
    let at = |name: &str| all.iter().position(|w| w.0 == name).expect("a stream");
    let of = |name: &str| -> Stream { stream(&data[at(name)], 0, 4 * all[at(name)].2 as u32) };
    let count = |name: &str| Count::Gpu { buffer: data[at(name)].buffer, offset: 0 };
    let packets = |name: &str| Packets {
        buffer: data[at(name)].buffer,
        offset: 0,
        count: (all[at(name)].1.len() / 8) as u32,
    };
    let (before, after) = (HOST_WRITE, HOST_WRITE);
    let particles = Particles::new(of("positions"), count("count")).with(|it| {
        it.densities = Some(of("densities"));
        it.velocities = Some(of("velocities"));
        it.surface_foam = Some(of("foam"));
        it.ids = Some(of("ids"));
        it.packets = Some(packets("packets"));
        it.before = before;
        it.after = after;
    });
    let whitewater =
        WhitewaterParticles::new(of("whitewater positions"), count("whitewater count")).with(
            |it| {
                it.kinds = Some(of("whitewater kinds"));
                it.radii = Some(of("whitewater radii"));
                it.ages = Some(of("whitewater ages"));
                it.ids = Some(of("whitewater ids"));
                it.packets = Some(packets("whitewater packets"));
                it.before = before;
                it.after = after;
            },
        );
    let balls = of("blobs");
    let part = |offset| Stream { offset, ..balls };
    let blobs = Blobs::new(balls, count("blob count")).with(|it| {
        it.rotations = Some(part(16));
        it.ids = Some(part(32));
        it.before = before;
        it.after = after;
    });
    let theirs = rig.config.bubbles.filter(|bubbles| !bubbles.crossfade);
    let (color, depth) = rig.scene(&case.shot);
    let output = color.host_image();
    let frame = case.shot.frame(output, depth.host_image(), particles).with(|it| {
        it.whitewater = rig.config.whitewater.map(|_| whitewater);
        it.bubbles = theirs.map(|_| blobs);
    });
    let cmd = rig.stub.begin(0);
    // SAFETY: cmd is recording, the slot was waited for, and all handles live until the end of this
    // function.
    let recorded = unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    rig.stub.end(0);
    rig.stub.wait(0);
    let drawn = rig.read(&output, &recorded);
    // SAFETY: the slot was waited for.
    unsafe { rig.renderer().collect(Slot(0)) };
    drawn.output.data
}

#[test]
fn hostile_bits_in_any_stream_of_a_frame() {
    let gpu = Gpu::shared();
    let mut case = Foamy::new(SIZE, Lens::Standard, 40.0);
    case.shot.settings.bubbles.crossfade = Crossfade { near: 2.0, far: 4.0, size: 1.0 };
    let base = everything(&mut case);
    case.shot.previous = Some(Previous { camera: case.shot.camera, dt: 0.02 });
    let bubbles = BubbleConfig::new(64).with(|it| {
        it.variants = 2;
        it.bubbles = 32;
        it.map_size = 64;
    });
    let whitewater = WhitewaterConfig::new(1024).with(|it| it.packets = true);
    let base = base.with(|it| {
        it.motion = true;
        it.noise = Some(1);
        it.whitewater = Some(whitewater);
        it.bubbles = Some(bubbles);
        it.shadow = None;
    });
    let others = [
        ("compute", base),
        (
            "raster",
            base.with(|it| {
                it.depth_splat = Some(whitewater::water::Splat::Raster);
                it.thickness_splat = Some(whitewater::water::Splat::Raster);
                it.composite = Some(Shading::Compute);
                it.whitewater =
                    Some(whitewater.with(|it| it.splat = Some(WhitewaterSplat::Raster)));
                it.bubbles = Some(bubbles.with(|it| it.crossfade = true));
            }),
        ),
    ];
    for (name, config) in others {
        let mut rig = Rig::lit(&gpu, &config, 1);
        let all = streams(&case);
        let mut random = Random(5);
        // The next pair of bits and place of each stream. Counts are only too large.
        let mut next = vec![0; all.len()];
        loop {
            let (mut spoiled, mut due) = (all.clone(), Vec::new());
            for (i, words) in spoiled.iter_mut().enumerate() {
                let count = words.0.ends_with("count");
                if next[i] < if count { 1 } else { BITS.len() * (words.2 + 1) } {
                    due.push(i);
                }
                if count {
                    words.1.fill(u32::MAX);
                    next[i] = 1;
                } else {
                    next[i] = spoil_from(next[i], &mut words.1, words.2, &mut random);
                }
            }
            if due.is_empty() {
                break;
            }
            for one in due.into_iter().map(Some).chain([None]) {
                let mut these = one.map_or(spoiled.clone(), |_| all.clone());
                if let Some(i) = one {
                    these[i] = spoiled[i].clone();
                }
                let what = one.map_or("all", |i| all[i].0);
                eprintln!("{name}: {what}");
                let picture = draw(&mut rig, &case, &these);
                let bad = picture.iter().flatten().filter(|v| !v.is_finite()).count();
                assert_eq!(bad, 0, "{name}: values that are not finite, by {what}");
            }
        }
    }
}
