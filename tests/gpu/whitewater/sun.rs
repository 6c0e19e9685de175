//! A sun that is in the environment map and also a light.

use whitewater::{Access, EnvironmentSource, Equirectangular, Recorded, Slot};

use super::*;

/// If the host says which part of the map is the sun, foam gathers only the light of the map
/// without it, bit for bit, in both ways to gather.
#[test]
fn the_sun_of_a_map_is_not_gathered() {
    let gpu = Gpu::shared();
    for irradiance in [Irradiance::Prefiltered, Irradiance::Sampled] {
        let whitewater = Some(WhitewaterConfig::new(4096).with(|it| it.irradiance = irradiance));
        let mut rig =
            Rig::new(&gpu, &whitewater_config(SIZE).with(|it| it.whitewater = whitewater));
        let mut cloud = Whitewater::new(Lens::Standard);
        // Without the light's direct part.
        cloud.shot.settings.light.shade = cloud.shot.settings.light.irradiance;
        let gathered = |rig: &mut Rig<'_>| {
            let light = cloud.draw(rig).whitewater.expect("whitewater particles").light;
            light.data.iter().map(|texel| texel.map(f32::to_bits)).collect::<Vec<_>>()
        };
        let size = extent(16, 8);
        let grey = [[0.7, 0.6, 0.5, 1.0]; 128];
        let mut sunny = grey;
        sunny[2 * 16 + 5] = [400.0, 300.0, 200.0, 1.0];
        rig.environment(size, &grey);
        let without = gathered(&mut rig);
        rig.environment(size, &sunny);
        let with = gathered(&mut rig);
        assert_ne!(without, with, "{irradiance:?}: the sun adds something");
        rig.environment_with_sun(size, [&sunny, &grey]);
        assert!(without == gathered(&mut rig), "{irradiance:?}: the sun of the map is gathered");
    }
}

/// A configuration that begins to sample the environment has to make the cube again, because the
/// old one lacks what sampling needs.
#[test]
fn to_sample_the_environment_makes_it_anew() {
    let gpu = Gpu::shared();
    let of = |irradiance| {
        let whitewater = Some(WhitewaterConfig::new(4096).with(|it| it.irradiance = irradiance));
        whitewater_config(SIZE).with(|it| it.whitewater = whitewater)
    };
    let mut rig = Rig::new(&gpu, &of(Irradiance::Prefiltered));
    let before = rig.renderer().memory().images;
    // Six faces with 8 bytes per texel, and their mip levels. A driver may add a border around each
    // face and align the whole.
    let size = rig.config.environment_size;
    let faces = |border: u32| -> u64 {
        let edges = (0..=size.ilog2()).map(|mip| u64::from((size >> mip) + 2 * border));
        edges.map(|edge| 48 * edge * edge).sum()
    };
    let cube = faces(0)..=faces(1) + 4096;
    for (irradiance, anew, more) in
        [(Irradiance::Prefiltered, false, 0..=0), (Irradiance::Sampled, true, cube)]
    {
        assert_eq!(rig.renderer().reconfigure(&of(irradiance)).expect("reconfigure"), anew);
        let found = rig.renderer().memory().images - before;
        assert!(more.contains(&found), "{irradiance:?}: {found} bytes more");
    }
}

/// If the environment changes while a frame is in flight, the frame still uses the one at the time
/// of its record.
#[test]
fn the_environment_changes_between_frames_in_flight() {
    let gpu = Gpu::shared();
    let size = extent(16, 8);
    let maps = [[0.7, 0.6, 0.5, 1.0], [0.1, 0.9, 0.3, 1.0]].map(|color| [color; 128]);
    for irradiance in [Irradiance::Prefiltered, Irradiance::Sampled] {
        let whitewater = Some(WhitewaterConfig::new(4096).with(|it| it.irradiance = irradiance));
        let config = whitewater_config(SIZE).with(|it| it.whitewater = whitewater);
        let mut cloud = Whitewater::new(Lens::Standard);
        cloud.shot.settings.light.shade = cloud.shot.settings.light.irradiance;
        let alone = maps.each_ref().map(|map| {
            let mut rig = Rig::lit(&gpu, &config, 1);
            rig.environment(size, map);
            cloud.draw(&mut rig).output
        });
        assert!(alone[0].data != alone[1].data, "{irradiance:?}: the environment shows");
        let mut rig = Rig::lit(&gpu, &config, 2);
        let maps = maps.each_ref().map(|map| rig.map(size, map));
        for round in 0..3 {
            let flights = [0, 1].map(|slot| {
                let (color, depth) = rig.scene(&cloud.shot);
                let (water, foam) = (rig.particles(&cloud.shot), rig.whitewater(&cloud.input()));
                let frame = cloud
                    .shot
                    .frame(color.host_image(), depth.host_image(), water.particles())
                    .with(|it| {
                        it.slot = Slot(slot);
                        it.whitewater = Some(foam.particles());
                    });
                let source = EnvironmentSource::Equirectangular(Equirectangular::new(
                    maps[slot as usize].host_image(),
                ));
                let cmd = rig.stub.begin(slot);
                let renderer = rig.renderer();
                // SAFETY: cmd is recording, the slot was waited for, and the handles live until the
                // end of the round.
                let recorded = unsafe {
                    renderer
                        .record_environment(cmd, Slot(slot), &source)
                        .and_then(|()| renderer.record(cmd, &frame))
                };
                recorded.expect("record");
                rig.stub.end(slot);
                (color, (depth, water, foam))
            });
            for (slot, (color, _)) in (0..).zip(&flights) {
                rig.stub.wait(slot);
                rig.collect(Slot(slot));
                let found = rig.read(&color.host_image(), &Recorded::default()).output;
                let name = format!("environment-{irradiance:?}-{round}-{slot}");
                compare::same_color(&name, &found, &alone[slot as usize]);
            }
        }
    }
}

/// Both pictures of an environment change their layouts once, although the one without the sun is read twice.
#[test]
fn pictures_are_taken_and_left_in_their_states() {
    let gpu = Gpu::shared();
    let size = extent(16, 8);
    let sampled = Some(WhitewaterConfig::new(16).with(|it| it.irradiance = Irradiance::Sampled));
    let mut rig = Rig::new(&gpu, &whitewater_config(SIZE).with(|it| it.whitewater = sampled));
    let general = Access::new(
        vk::PipelineStageFlags2::ALL_COMMANDS,
        vk::AccessFlags2::MEMORY_READ,
        vk::ImageLayout::GENERAL,
    );
    let maps = [0.7, 0.1].map(|light| rig.map(size, &[[light; 4]; 128]));
    let [mut image, mut without_sun] = maps.each_ref().map(|map| map.host_image());
    (image.after, without_sun.after) = (general, general);
    let source = EnvironmentSource::Equirectangular(
        Equirectangular::new(image).with(|it| it.without_sun = Some(without_sun)),
    );
    let cmd = rig.stub.begin(0);
    // SAFETY: cmd is recording, and the maps live until the slot was waited for.
    unsafe { rig.renderer().record_environment(cmd, Slot(0), &source) }.expect("record");
    for map in &maps {
        rig.stub.barrier(cmd, map.image, map.aspect, general, map.state);
    }
    rig.stub.end(0);
    rig.stub.wait(0);
}
