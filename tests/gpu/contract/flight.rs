//! Frames in flight: slots, read-backs between records, two renderers on one device.

use whitewater::water::{Convolution, Shading, Shadows};
use whitewater::{Frame, Recorded, Slot};

use crate::reference::Image;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::Texture;
use crate::support::rig::{Cloud, Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{LENSES, Lens};

use super::{sunny, water};

/// Resources that a frame in flight needs.
pub struct Flight {
    color: Texture,
    _depth: Texture,
    _cloud: Cloud,
    recorded: Recorded,
    pub expected: Drawn,
}

/// Records a shot in a slot and submits it without waiting.
pub fn launch(rig: &mut Rig<'_>, slot: u32, shot: &Shot, expected: Drawn) -> Flight {
    let (color, depth) = rig.scene(shot);
    let cloud = rig.particles(shot);
    let frame = shot
        .frame(color.host_image(), depth.host_image(), cloud.particles())
        .with(|it| it.slot = Slot(slot));
    let cmd = rig.stub.begin(slot);
    // SAFETY: cmd is recording, the slot was waited for, and the handles live in the returned
    // Flight.
    let recorded = unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    rig.stub.end(slot);
    Flight { color, _depth: depth, _cloud: cloud, recorded, expected }
}

pub fn output_of(rig: &Rig<'_>, flight: &Flight) -> Image<[f32; 4]> {
    let nothing = Recorded::default();
    rig.read(&flight.color.host_image(), &nothing).output
}

/// Three frames are submitted before the first is waited for, repeatedly, with resizes between.
#[test]
fn three_slots_in_flight_with_a_resize() {
    for composite in [Shading::Raster, Shading::Compute] {
        in_flight(composite);
    }
}

fn in_flight(composite: Shading) {
    let gpu = Gpu::shared();
    let noise = (composite == Shading::Compute).then_some(1);
    let config = |size| {
        config(size).with(|it| {
            it.composite = Some(composite);
            it.noise = noise;
        })
    };
    let sizes = [extent(96, 64), extent(61, 97), extent(128, 32), extent(33, 17)];
    let expected: Vec<Vec<Drawn>> = sizes
        .iter()
        .map(|size| {
            let mut rig = Rig::lit(&gpu, &config(*size), 1);
            LENSES[..3].iter().map(|lens| rig.draw(&water(*size, *lens))).collect()
        })
        .collect();
    let mut rig = Rig::lit(&gpu, &config(sizes[0]), 3);
    let mut flights: [Option<Flight>; 3] = [None, None, None];
    for frame in 0..24_usize {
        let slot = frame % 3;
        if let Some(flight) = flights[slot].take() {
            rig.stub.wait(slot as u32);
            rig.collect(Slot(slot as u32));
            let found = output_of(&rig, &flight);
            compare::same_color(&format!("flight-{frame}"), &found, &flight.expected.output);
        }
        // Resizes twice in a row, and with frames of all slots in flight.
        if [4, 5, 11, 13].contains(&frame) {
            rig.resize(sizes[frame % sizes.len()]);
            assert!(rig.renderer().retired() > 0, "the old images wait for their frames");
        }
        let size = rig.config.extent;
        let which = sizes.iter().position(|s| *s == size).expect("one of them");
        let expected = expected[which][slot].clone();
        let flight = launch(&mut rig, slot as u32, &water(size, LENSES[slot]), expected);
        flights[slot] = Some(flight);
    }
    for (slot, flight) in flights.iter_mut().enumerate() {
        rig.stub.wait(slot as u32);
        rig.collect(Slot(slot as u32));
        if let Some(flight) = flight.take() {
            compare::same_color("flight-last", &output_of(&rig, &flight), &flight.expected.output);
        }
    }
    assert_eq!(rig.renderer().retired(), 0, "all slots are back");
}

/// All slots share the images of a filtered shadow map. Frames with different maps, submitted
/// before the other is done, must be as each by itself.
#[test]
fn filtered_shadows_of_two_slots_in_flight() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let shadow = Shadows::Convolution(Convolution { terms: 8, texels: 48, bits: 16 });
    let config = config(size).with(|it| {
        it.surface_foam = true;
        it.shadow = Some(shadow);
    });
    let mut rig = Rig::lit(&gpu, &config, 2);
    let mut shots = [Lens::Standard, Lens::OffAxis].map(|lens| {
        let mut shot = water(size, lens);
        (shot.settings.water.specular, shot.settings.water.shininess) = (0.5, 4.0);
        shot
    });
    // One half of each picture is in shade.
    shots[0].scene_depth(|x, _| (x < 48).then_some(1.0));
    shots[1].scene_depth(|_, y| (y < 32).then_some(1.0));
    let _maps = shots.each_mut().map(|shot| sunny(&rig, shot));
    for shot in &mut shots {
        shot.scene_depth(|_, _| None);
    }
    let alone = shots.each_ref().map(|shot| Rig::lit(&gpu, &config, 1).draw(shot));
    let mut other = shots[0].clone();
    (other.shadow, other.light_volume) = (shots[1].shadow, shots[1].light_volume);
    let other = Rig::lit(&gpu, &config, 1).draw(&other).output;
    let differ = other.data.iter().zip(&alone[0].output.data).filter(|(a, b)| a != b).count();
    assert!(differ > 100, "in the other's shade only {differ} pixels differ");
    for round in 0..4 {
        let flights = [0, 1].map(|slot| {
            launch(&mut rig, slot, &shots[slot as usize], alone[slot as usize].clone())
        });
        for (slot, flight) in (0..).zip(&flights) {
            rig.stub.wait(slot);
            rig.collect(Slot(slot));
            let name = format!("filtered-{round}-{slot}");
            compare::same_color(&name, &output_of(&rig, flight), &flight.expected.output);
        }
    }
}

/// The layers that a record returns contain its own frame.
#[test]
fn layers_are_read_between_records() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut rig = Rig::with_slots(&gpu, &config(size), 3);
    for slot in [0, 2, 1, 2] {
        let shot = water(size, LENSES[slot as usize]);
        let expected = Rig::new(&gpu, &config(size)).draw(&shot);
        let flight = launch(&mut rig, slot, &shot, expected);
        rig.stub.wait(slot);
        rig.collect(Slot(slot));
        let found = rig.read(&flight.color.host_image(), &flight.recorded);
        compare::same("layers-surface", &found.surface, &flight.expected.surface);
        compare::same("layers-thickness", &found.thickness, &flight.expected.thickness);
    }
}

#[test]
fn two_renderers_share_a_device_and_a_command_buffer() {
    let gpu = Gpu::shared();
    let (small, large) = (extent(48, 32), extent(96, 64));
    let shots = [water(small, Lens::Standard), water(large, Lens::OffAxis)];
    let mut first = Rig::new(&gpu, &config(small));
    let mut second = Rig::new(&gpu, &config(large));
    let expected = [first.draw(&shots[0]), second.draw(&shots[1])];
    let scenes = [first.scene(&shots[0]), second.scene(&shots[1])];
    let clouds = [first.particles(&shots[0]), second.particles(&shots[1])];
    let cmd = first.stub.begin(0);
    for (i, rig) in [&mut first, &mut second].into_iter().enumerate() {
        let frame = Frame::new(
            Slot(0),
            scenes[i].0.host_image(),
            scenes[i].1.host_image(),
            clouds[i].particles(),
            shots[i].camera,
            &shots[i].settings,
        );
        // SAFETY: cmd is recording, and slot 0 of both renderers was waited for.
        unsafe { rig.renderer().record(cmd, &frame) }.expect("record");
    }
    first.stub.end(0);
    first.stub.wait(0);
    for (i, rig) in [&first, &second].into_iter().enumerate() {
        let found = rig.read(&scenes[i].0.host_image(), &Recorded::default());
        compare::same_color(&format!("two-{i}"), &found.output, &expected[i].output);
    }
}
