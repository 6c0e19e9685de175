//! Bad blobs, looks and configurations give errors that name the field.

use ash::vk;
use whitewater::bubbles::{BubbleConfig, BubbleSettings, Film};
use whitewater::{Blobs, Count, Error, Frame};

use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent, stream};
use crate::support::scenes::Lens;
use crate::support::spy;

type Spoil = (&'static str, fn(&mut Blobs));
type Look = (&'static str, fn(&mut BubbleSettings));

#[test]
fn bad_blobs_are_errors_before_any_command() {
    let mut gpu = Gpu::own();
    spy::install(&mut gpu);
    let gpu = gpu;
    let size = extent(32, 16);
    let bubbles = BubbleConfig::new(16).with(|it| {
        it.variants = 1;
        it.bubbles = 8;
    });
    let with = config(size).with(|it| it.bubbles = Some(bubbles));
    let mut rig = Rig::with_slots(&gpu, &with, 1);
    let shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    let (color, depth) = rig.scene(&shot);
    let cloud = rig.particles(&shot);
    let data = rig.stub.data(&[0; 36 * 16], vk::BufferUsageFlags::STORAGE_BUFFER);
    let all = stream(&data, 0, 36);
    let good = Blobs::new(all, Count::Cpu(16)).with(|it| {
        it.rotations = Some(all);
        it.ids = Some(all);
    });
    let spoils: [Spoil; 7] = [
        ("Frame.bubbles.count", |b| b.count = Count::Cpu(17)),
        ("Frame.bubbles.spheres", |b| b.spheres.stride = 12),
        ("Frame.bubbles.spheres", |b| b.spheres.stride = 18),
        ("Frame.bubbles.spheres", |b| b.spheres.size = 100),
        ("Frame.bubbles.rotations", |b| b.rotations.as_mut().expect("turns").offset = 2),
        ("Frame.bubbles.ids", |b| b.ids.as_mut().expect("ids").stride = 400),
        ("Frame.bubbles.count.offset", |b| {
            b.count = Count::Gpu { buffer: b.spheres.buffer, offset: 2 };
        }),
    ];
    let looks: [Look; 9] = [
        ("Settings.bubbles.film", |l| l.film = 0.0),
        ("Settings.bubbles.film", |l| l.film = f32::NAN),
        ("Settings.bubbles.variation", |l| l.variation = 1.5),
        ("Settings.bubbles.drainage", |l| l.drainage = -0.1),
        ("Settings.bubbles.core_opaque_radius", |l| {
            [l.core_opaque_radius, l.core_outer_radius] = [0.9, 0.9]
        }),
        ("Settings.bubbles.albedo", |l| l.albedo[1] = 2.0),
        ("Settings.bubbles.pattern", |l| l.pattern = -1.0),
        ("Settings.bubbles.reflection", |l| l.reflection = f32::INFINITY),
        ("Settings.bubbles.shininess", |l| l.shininess = 0.0),
    ];
    let cmd = rig.stub.begin(0);
    let frame = shot.frame(color.host_image(), depth.host_image(), cloud.particles());
    let mut refused = |field: &str, frame: &Frame<'_>| {
        spy::reset();
        // SAFETY: a frame with bad input uses no handle.
        let result = unsafe { rig.renderer().record(cmd, frame) };
        let commands: u32 = spy::COMMANDS.iter().map(|f| f.calls()).sum();
        match result {
            Err(Error::BadInput { field: found, why }) => {
                assert!(
                    found == field && !why.is_empty() && commands == 0,
                    "{field}: {found}, {why}"
                );
            }
            other => panic!("{field}: {:?}", other.map(|_| "no error")),
        }
    };
    for (field, spoil) in spoils {
        let mut bad = good;
        spoil(&mut bad);
        refused(field, &frame.with(|it| it.bubbles = Some(bad)));
    }
    for (field, spoil) in looks {
        let mut settings = shot.settings.clone();
        spoil(&mut settings.bubbles);
        refused(
            field,
            &frame.with(|it| {
                it.bubbles = Some(good);
                it.settings = &settings;
            }),
        );
    }
    // SAFETY: the frame is good, although all its blobs are invalid.
    unsafe { rig.renderer().record(cmd, &frame.with(|it| it.bubbles = Some(good))) }
        .expect("record");
    rig.stub.end(0);
    rig.stub.wait(0);
    // A renderer without bubble foam.
    let mut plain = Rig::with_slots(&gpu, &config(size), 1);
    let cmd = plain.stub.begin(0);
    // SAFETY: a frame with bad input uses no handle.
    let result = unsafe { plain.renderer().record(cmd, &frame.with(|it| it.bubbles = Some(good))) };
    plain.stub.end(0);
    plain.stub.wait(0);
    assert!(matches!(result, Err(Error::BadInput { field: "Frame.bubbles", .. })));
}

#[test]
fn bad_configurations_are_errors() {
    let gpu = Gpu::shared();
    let good = BubbleConfig::new(16);
    let film = |index| Film { index, ..Film::default() };
    for (field, bad) in [
        ("Config.bubbles.max_blobs", good.with(|it| it.max_blobs = 0)),
        ("Config.bubbles.max_blobs", good.with(|it| it.max_blobs = (1 << 20) + 1)),
        ("Config.bubbles.variants", good.with(|it| it.variants = 0)),
        ("Config.bubbles.variants", good.with(|it| it.variants = 33)),
        ("Config.bubbles.bubbles", good.with(|it| it.bubbles = 7)),
        ("Config.bubbles.bubbles", good.with(|it| it.bubbles = 257)),
        ("Config.bubbles.map_size", good.with(|it| it.map_size = 4)),
        ("Config.bubbles.map_size", good.with(|it| it.map_size = 30)),
        ("Config.bubbles.steps", good.with(|it| it.steps = 0)),
        ("Config.bubbles.layers", good.with(|it| it.layers = 9)),
        ("Config.bubbles.film.index", good.with(|it| it.film = film(0.5))),
    ] {
        let config = config(extent(32, 16)).with(|it| it.bubbles = Some(bad));
        match Rig::try_new(&gpu, &config, 1) {
            Err(Error::BadInput { field: found, .. }) => assert_eq!(found, field),
            Err(other) => panic!("{field}: {other}"),
            Ok(_) => panic!("{field}: no error for {bad:?}"),
        }
    }
}
