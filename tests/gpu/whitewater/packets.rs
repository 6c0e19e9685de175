//! The host's packets of whitewater particles: culling packets makes no visible difference, and
//! particles in no packet are not drawn.

use ash::vk;
use whitewater::WhitewaterSplat;
use whitewater::{Config, Packets};

use super::{SIZE, Whitewater, by, ways};
use crate::invariants::packet_bytes;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot};
use crate::support::scenes::{LENSES, Lens};

const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;

fn with_packets(way: WhitewaterSplat, max_stride: u32) -> Config {
    let config = by(way, SIZE);
    let whitewater = config.whitewater.map(|whitewater| {
        whitewater.with(|it| {
            it.packets = true;
            it.max_stride = max_stride;
        })
    });
    config.with(|it| it.whitewater = whitewater)
}

/// Packets of ranges of particles, with boxes that contain their spheres.
pub fn boxes(positions: &[[f32; 3]], radii: Option<&[f32]>, ranges: &[(u32, u32)]) -> Vec<u8> {
    let corners = |(p, r): (&[f32; 3], f32)| [p.map(|v| v - r), p.map(|v| v + r)];
    let radius = |i: usize| radii.map_or(0.0, |radii| radii[i]);
    let all: Vec<_> =
        positions.iter().enumerate().flat_map(|(i, p)| corners((p, radius(i)))).collect();
    // Two corners per particle stand for its sphere.
    let mut shot = Shot::new(SIZE, Lens::Standard, 1.0, &[]);
    shot.positions = all;
    let twice: Vec<_> = ranges.iter().map(|(first, n)| (2 * first, n.saturating_mul(2))).collect();
    let mut bytes = packet_bytes(&shot, &twice);
    for (record, (first, n)) in bytes.chunks_exact_mut(32).zip(ranges) {
        record[..4].copy_from_slice(&first.to_ne_bytes());
        record[4..8].copy_from_slice(&n.to_ne_bytes());
    }
    bytes
}

fn draw(rig: &mut Rig<'_>, cloud: &Whitewater, packets: &[u8]) -> Drawn {
    let (water, particles) = (rig.particles(&cloud.shot), rig.whitewater(&cloud.input()));
    let data = rig.stub.data(packets, STORAGE);
    let count = packets.len() as u32 / 32;
    let packets = Some(Packets { buffer: data.buffer, offset: 0, count });
    let particles = particles.particles().with(|it| it.packets = packets);
    rig.draw_whitewater(&cloud.shot, &water.particles(), Some(particles))
}

/// Particles on all sides of the view, sorted so that consecutive ones are near each other.
fn around(lens: Lens) -> Whitewater {
    let mut cloud = Whitewater::new(lens);
    let n = cloud.positions.len();
    let camera = cloud.shot.camera.view_matrix().inverse();
    let side = |v: [f32; 3], offset: [f32; 3]| {
        let moved = camera.transform_vector3(glam::Vec3::from(offset));
        (glam::Vec3::from(v) + moved).to_array()
    };
    for offset in [[-9.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 7.0, 0.0], [0.0, 0.0, 12.0]] {
        for i in 0..n {
            cloud.positions.push(side(cloud.positions[i], offset));
            cloud.kinds.push(cloud.kinds[i]);
            cloud.ages.push(cloud.ages[i]);
            let radii = cloud.radii.as_mut().expect("radii");
            radii.push(radii[i]);
            cloud.ids.as_mut().expect("ids").push(i as u32);
        }
    }
    let cell = |i: &usize| {
        let p = cloud.positions[*i];
        [p[2], p[1], p[0]].map(|v| (v * 0.7).floor() as i32)
    };
    let mut order: Vec<usize> = (0..cloud.positions.len()).collect();
    order.sort_by_key(cell);
    fn sorted<T: Copy>(all: &[T], order: &[usize]) -> Vec<T> {
        order.iter().map(|i| all[*i]).collect()
    }
    Whitewater {
        positions: sorted(&cloud.positions, &order),
        kinds: sorted(&cloud.kinds, &order),
        radii: cloud.radii.as_ref().map(|radii| sorted(radii, &order)),
        ages: sorted(&cloud.ages, &order),
        ids: cloud.ids.as_ref().map(|ids| sorted(ids, &order)),
        ..cloud
    }
}

/// The picture is the same to the bit as with single particles, for packets of any size and in any
/// order, also if chunks cut them.
#[test]
fn what_packets_pass_over_does_not_show() {
    let gpu = Gpu::shared();
    let range = u64::from(gpu.limits().max_storage_buffer_range);
    // A chunk holds 150 particles.
    let short = (range / 150).next_multiple_of(4).min(1 << 20) as u32;
    for way in ways(&gpu) {
        for (max_stride, lens) in [(12, LENSES[0]), (short, LENSES[1])] {
            let mut rig = Rig::lit(&gpu, &with_packets(way, max_stride), 1);
            for own in [true, false] {
                let mut cloud = around(lens);
                cloud.radii = cloud.radii.filter(|_| own);
                let n = cloud.positions.len() as u32;
                let expected = cloud.draw(&mut rig);
                for size in [1, 3, 64, 83] {
                    let mut ranges: Vec<_> =
                        (0..n).step_by(size).map(|i| (i, (size as u32).min(n - i))).collect();
                    // The last packet's count reaches beyond the particles, and its end beyond 32
                    // bits.
                    ranges.last_mut().expect("some").1 = u32::MAX - 1;
                    ranges.reverse();
                    let packets = boxes(&cloud.positions, cloud.radii.as_deref(), &ranges);
                    let drawn = draw(&mut rig, &cloud, &packets);
                    let name = format!("whitewater-packets-{way:?}-{lens:?}-{own}-{size}");
                    compare::same_color(&name, &drawn.output, &expected.output);
                }
            }
        }
    }
}

/// Particles in no packet are not drawn, nor are those whose box lies beside the view: culling
/// tests only the boxes.
#[test]
fn particles_are_where_their_packets_are() {
    let gpu = Gpu::shared();
    for way in ways(&gpu).into_iter().filter(|way| *way != WhitewaterSplat::Raster) {
        let mut rig = Rig::lit(&gpu, &with_packets(way, 12), 1);
        let cloud = Whitewater::new(Lens::Standard);
        let n = cloud.positions.len() as u32;
        let radii = cloud.radii.as_deref();
        let mut less = cloud.clone();
        less.positions.truncate(n as usize / 2);
        less.kinds.truncate(n as usize / 2);
        less.ages.truncate(n as usize / 2);
        less.radii.as_mut().expect("radii").truncate(n as usize / 2);
        less.ids.as_mut().expect("ids").truncate(n as usize / 2);
        let expected = less.draw(&mut rig);
        let half = boxes(&cloud.positions, radii, &[(0, n / 2)]);
        let found = draw(&mut rig, &cloud, &half);
        compare::same_color("whitewater-packets-half", &found.output, &expected.output);
        for offset in [[0.0, 0.0, 60.0], [200.0, 0.0, 0.0], [0.0, -200.0, 0.0], [f32::NAN; 3]] {
            let moved = cloud.shot.camera.view_matrix().inverse().transform_vector3(offset.into());
            let beside: Vec<_> =
                cloud.positions.iter().map(|p| (glam::Vec3::from(*p) + moved).to_array()).collect();
            let beside = boxes(&beside, radii, &[(n / 2, n - n / 2)]);
            let found = draw(&mut rig, &cloud, &[&half[..], &beside].concat());
            let name = format!("whitewater-packets-beside-{offset:?}");
            compare::same_color(&name, &found.output, &expected.output);
        }
        // Without packets no particle is drawn.
        let none = Whitewater { positions: Vec::new(), ..cloud.clone() };
        let expected = rig.draw_particles(&none.shot, &rig.particles(&none.shot).particles());
        let found = draw(&mut rig, &cloud, &[]);
        compare::same_color("whitewater-packets-none", &found.output, &expected.output);
    }
}

#[test]
fn bad_packets_are_errors() {
    let gpu = Gpu::shared();
    let cloud = Whitewater::new(Lens::Standard);
    let config = with_packets(WhitewaterSplat::Compute, 12);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let particles = rig.whitewater(&cloud.input());
    let data = rig.stub.data(&[0; 64], STORAGE);
    let good = Packets { buffer: data.buffer, offset: 0, count: 1 };
    let given = |packets| particles.particles().with(|it| it.packets = Some(packets));
    for (field, packets) in [
        ("Frame.whitewater.packets.offset", Packets { offset: 2, ..good }),
        ("Frame.whitewater.packets.count", Packets { count: 65_536, ..good }),
    ] {
        let error = rig.refused(&cloud.shot, Some(given(packets)));
        assert!(error.contains(field), "{field}: {error}");
    }
    let mut rig = Rig::lit(&gpu, &by(WhitewaterSplat::Compute, SIZE), 1);
    let error = rig.refused(&cloud.shot, Some(given(good)));
    assert!(error.contains("Config.whitewater.packets"), "{error}");
}
