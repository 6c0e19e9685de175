//! Shoreline and contact foam after changes of a renderer's size and configuration; a host's foam
//! texture, memory and errors.

use ash::vk;
use glam::DVec2;
use whitewater::shore::{ContactSettings, Edge, ShoreConfig, ShoreSettings, TextureLayer};
use whitewater::{Error, Shore, Shoreline, Slot, Strip, Surface, Triangles};

use super::shoreline::{AREA, heights, plain, web_alone};
use super::{Mapped, SAMPLED, Tally, shore_config, water, with_shore};
use crate::reference::Image;
use crate::reference::shore::exact;
use crate::reference::shore::foam::{Pixel, Shoreline as Look, covered, shoreline};
use crate::reference::shore::texture::Texture as Levels;
use crate::support::device::{Gpu, filters_in_halves};
use crate::support::host::HOST_WRITE;
use crate::support::rig::{Rig, Shot, config, extent, stream};
use crate::support::scenes::Lens;

fn land(at: DVec2) -> f64 {
    0.4 * (4.0 - (at - DVec2::new(7.0, -5.0)).length())
}

fn shot(coasts: &Mapped<'_>, width: u32, height: u32) -> Shot {
    let mut shot = Shot::new(extent(width, height), Lens::Standard, 0.2, &[[0.0, 0.0, 3.0]]);
    shot.settings.shore = plain();
    shot.settings.shore.contact.particle_opacity = 1.0;
    shot.scene_depth(|x, _| Some(4.0 + 0.1 * f64::from(x)));
    let shoreline = Some(Shoreline::Map(coasts.shore_distances()));
    shot.shore = Some(Shore::new(0.0).with(|it| it.shoreline = shoreline));
    shot
}

fn same(name: &str, rig: &mut Rig<'_>, fresh: &mut Rig<'_>, shot: &Shot) {
    let (found, expected) = (rig.draw(shot), fresh.draw(shot));
    assert_eq!(found.output.data, expected.output.data, "{name}");
    let [found, expected] = [found, expected].map(|drawn| drawn.shore.expect("foam"));
    assert!(expected.data.iter().any(|c| c[0] > 0), "{name}: something is drawn");
    assert_eq!(found.data, expected.data, "{name}");
}

#[test]
fn a_resize_and_a_reconfiguration_give_what_a_new_renderer_gives() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, land), None);
    let with = |size, shore| config(size).with(|it| it.shore = shore);
    let base = shore_config(Edge::Smooth);
    let mut rig = Rig::lit(&gpu, &with(extent(96, 64), Some(base)), 1);
    for (width, height) in [(33, 17), (120, 90)] {
        let shot = shot(&coasts, width, height);
        rig.resize(shot.size);
        let mut fresh = Rig::lit(&gpu, &with(shot.size, Some(base)), 1);
        same(&format!("{width}x{height}"), &mut rig, &mut fresh, &shot);
    }
    let shot = shot(&coasts, 120, 90);
    for (name, anew, shore) in [
        ("edge", false, Some(base.with(|it| it.edge = Edge::Clip))),
        ("web", true, Some(base.with(|it| it.texture_size = 64))),
        ("none", false, None),
        ("again", true, Some(base.with(|it| it.seed = 9))),
    ] {
        let config = with(shot.size, shore);
        assert_eq!(rig.renderer().reconfigure(&config).expect("reconfigure"), anew, "{name}");
        rig.config = config;
        if anew {
            rig.set_up();
            rig.light();
        }
        if shore.is_some() {
            let mut fresh = Rig::lit(&gpu, &config, 1);
            same(name, &mut rig, &mut fresh, &shot);
        }
    }
}

/// Memory of the foam texture with 16 bytes per texel at all mip levels, of a noise texture with
/// 256² texels, and of an image and lists of the frame's extent.
#[test]
fn memory_is_what_it_says() {
    let gpu = Gpu::shared();
    let of = |size, shore| {
        let mut rig = Rig::new(&gpu, &config(size).with(|it| it.shore = shore));
        let memory = rig.renderer().memory();
        (memory.images + memory.buffers) as f64
    };
    let size = extent(512, 512);
    let without = of(size, None);
    let [small, large] = [256, 1024].map(|texture_size| {
        of(size, Some(ShoreConfig::default().with(|it| it.texture_size = texture_size))) - without
    });
    println!("of 256 texels {small}, of 1024 {large} bytes");
    // Four channels in half precision, stored twice, as an image and packed; all levels add a
    // third. Then the source's floats.
    let web = |edge: f64| edge * edge * (2.0 * 8.0 * 4.0 / 3.0 + 4.0);
    let grown = (large - small) / (web(1024.0) - web(256.0));
    assert!((0.98..1.06).contains(&grown), "{grown} of what is said");
    let (noise, frame) = (256.0 * 256.0 * (16.0 * 4.0 / 3.0 + 16.0), 4.0 * 512.0 * 512.0);
    let rest = small - web(256.0) - noise - frame;
    assert!((0.0..0.3e6).contains(&rest), "{rest} bytes besides");
}

/// A host's foam texture replaces the built-in one until `set_up` makes that again.
#[test]
fn a_web_of_the_host_s_is_what_is_seen() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, land), None);
    let mut rig = Rig::new(&gpu, &with_shore(extent(96, 64), Edge::Smooth));
    let mut shot = shot(&coasts, 96, 64);
    shot.positions.clear();
    shot.scene_depth(|_, _| None);
    let s = &mut shot.settings.shore.shoreline;
    let own = TextureLayer { weight: 1.0, scale: 0.25, angle: 30.0, speed: [0.1, 0.0] };
    *s = web_alone([6.0, 3.0], [own, TextureLayer::NONE, TextureLayer::NONE, TextureLayer::NONE]);
    let first = rig.draw(&shot).shore.expect("foam");
    // A smooth pattern of the foam texture's size, as a part of a larger image.
    let n = super::WEB as usize;
    let value = |x: usize, y: usize| {
        let turn = std::f64::consts::TAU / n as f64;
        (0.5 + 0.25 * (turn * 2.0 * x as f64).sin() + 0.25 * (turn * y as f64).cos()) as f32
    };
    let mut around = Image::new(n + 9, n + 5, f32::NAN);
    let mut texels = Vec::new();
    for y in 0..n {
        for x in 0..n {
            *around.at_mut(x + 4, y + 3) = value(x, y);
            texels.push(value(x, y));
        }
    }
    let size = extent(around.width as u32, around.height as u32);
    let bytes = bytemuck::cast_slice(&around.data);
    let format = vk::Format::R32_SFLOAT;
    let image = rig.stub.uploaded(format, size, vk::ImageUsageFlags::SAMPLED, bytes, SAMPLED);
    let rect =
        vk::Rect2D { offset: vk::Offset2D { x: 4, y: 3 }, extent: extent(super::WEB, super::WEB) };
    let image = image.host_image().with(|it| it.rect = rect);
    let cmd = rig.stub.begin(0);
    // SAFETY: cmd is recording, the slot's work is done, and the image outlives it.
    unsafe { rig.renderer().record_foam_texture(cmd, Slot(0), &image) }
        .expect("record_foam_texture");
    rig.stub.end(0);
    rig.stub.wait(0);
    rig.collect(Slot(0));
    let found = rig.draw(&shot).shore.expect("foam");
    assert_ne!(found.data, first.data);
    let web = Levels::web(n, &texels).filtered_in_halves(filters_in_halves());
    let [noise, _] = super::textures();
    let water = water(&shot, glam::DVec3::Y, 0.0);
    let look: Look = super::look_of(&shot.settings.shore);
    let mut tally = Tally::default();
    for (i, texel) in found.data.iter().enumerate() {
        let (x, y) = (i % 96, i / 96);
        let (at, off) = super::shared_at(super::is_shared(&shot), [x, y]);
        let point = water.at(at);
        let to = DVec2::new(point.place[0].value, point.place[1].value) - DVec2::new(7.0, -5.0);
        // Pixels well inside the band, where v has no influence.
        if point.depth.low() <= 0.0 || !(4.0..8.0).contains(&to.length()) {
            continue;
        }
        let (place, across) = (point.place, point.change);
        let pixel = Pixel { off, place, v: exact(1.0), across, dv: [exact(0.0); 2] };
        let foam = shoreline(&look, noise, &web, &pixel);
        tally.add((x, y), texel[0], covered(foam.over, foam.variance, foam.change));
    }
    tally.check("host's web", 50, 0.1);
    rig.set_up();
    assert_eq!(rig.draw(&shot).shore.expect("foam").data, first.data, "the built-in again");
}

type Spoil = (&'static str, fn(&mut ShoreSettings));

#[test]
fn bad_looks_shores_and_configurations_name_their_field() {
    let gpu = Gpu::shared();
    let size = extent(32, 16);
    for texture_size in [0, 8, 100, 4096] {
        let shore = Some(ShoreConfig::default().with(|it| it.texture_size = texture_size));
        match Rig::try_new(&gpu, &config(size).with(|it| it.shore = shore), 1) {
            Err(Error::BadInput { field, .. }) => assert_eq!(field, "Config.shore.texture_size"),
            _ => panic!("no error for a web of {texture_size}"),
        }
    }
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    let spoils: [Spoil; 22] = [
        ("Settings.shore.time", |l| l.time = f64::NAN),
        ("Settings.shore.period", |l| l.period = Some(0.0)),
        ("Settings.shore.shoreline.sea_reach", |l| l.shoreline.sea_reach = 0.0),
        ("Settings.shore.shoreline.land_reach", |l| l.shoreline.land_reach = f32::NAN),
        ("Settings.shore.shoreline.frequency", |l| l.shoreline.frequency = -1.0),
        ("Settings.shore.shoreline.speed", |l| l.shoreline.speed = f32::INFINITY),
        ("Settings.shore.shoreline.swing", |l| l.shoreline.swing = 1.5),
        ("Settings.shore.shoreline.swing_period", |l| l.shoreline.swing_period = 0.0),
        ("Settings.shore.shoreline.speed_period", |l| l.shoreline.speed_period = 0.0),
        ("Settings.shore.shoreline.wave_offset", |l| l.shoreline.wave_offset = 101.0),
        ("Settings.shore.shoreline.floor", |l| l.shoreline.floor = Some(f32::NAN)),
        ("Settings.shore.shoreline.texture_weight", |l| l.shoreline.texture_weight = -1.0),
        ("Settings.shore.shoreline.fade", |l| l.shoreline.fade = 0.0),
        ("Settings.shore.shoreline.color", |l| l.shoreline.color[2] = 1.5),
        ("Settings.shore.shoreline.opacity", |l| l.shoreline.opacity = 2.0),
        ("Settings.shore.shoreline.layers.weight", |l| l.shoreline.layers[1].weight = 2.0),
        ("Settings.shore.shoreline.layers.scale", |l| l.shoreline.layers[3].scale = -1.0),
        ("Settings.shore.shoreline.warp.amplitude", |l| l.shoreline.warp.amplitude = f32::NAN),
        ("Settings.shore.contact.depth", |l| l.contact.depth = 0.0),
        ("Settings.shore.contact.particle_depth", |l| l.contact.particle_depth = Some(-1.0)),
        ("Settings.shore.contact.mask", |l| l.contact.mask = 1.5),
        ("Settings.shore.contact.color", |l| l.contact.color[0] = 1.5),
    ];
    let mut shot = Shot::new(size, Lens::Standard, 0.2, &[]);
    shot.shore = Some(Shore::new(0.0));
    for (field, spoil) in spoils {
        let mut bad = shot.clone();
        spoil(&mut bad.settings.shore);
        let why = rig.refused(&bad, None);
        assert!(why.contains(field), "{field}: {why}");
    }
    // Unlit contact foam may have any colour.
    let glowing = ContactSettings::default().with(|it| {
        it.lit = 0.0;
        it.color = [40.0, 9.0, 1.0];
    });
    let mut good = shot.clone();
    good.settings.shore.contact = glowing;
    rig.draw(&good);
    let data = rig.stub.data(&[0; 16 * 16], vk::BufferUsageFlags::STORAGE_BUFFER);
    let strip = Strip {
        triangles: Triangles { positions: stream(&data, 0, 16), vertices: 6, indices: None },
        coordinates: stream(&data, 12, 16),
        before: HOST_WRITE,
        after: HOST_WRITE,
    };
    let of = |spoil: fn(&mut Strip)| {
        let mut strip = strip;
        spoil(&mut strip);
        Some(Shoreline::Strip(strip))
    };
    let (_color, depth) = rig.scene(&shot);
    let nowhere = depth.host_image().with(|it| it.rect = extent(33, 16).into());
    let base = Shore::new(0.0);
    for (field, shore) in [
        ("Frame.shore.bias", base.with(|it| it.bias = -1.0)),
        ("Frame.shore.surface", base.with(|it| it.surface = Some(Surface::Level(f32::NAN)))),
        (
            "Frame.shore.surface",
            base.with(|it| {
                it.surface = None;
                it.shoreline = Some(Shoreline::Screen);
            }),
        ),
        ("Frame.shore.surface.rect", base.with(|it| it.surface = Some(Surface::Depth(nowhere)))),
        (
            "Frame.shore.shoreline.triangles",
            base.with(|it| it.shoreline = of(|s| s.triangles.vertices = 5)),
        ),
        (
            "Frame.shore.shoreline.triangles.positions",
            base.with(|it| it.shoreline = of(|s| s.triangles.positions.stride = 4)),
        ),
        (
            "Frame.shore.shoreline.coordinates",
            base.with(|it| it.shoreline = of(|s| s.coordinates.offset = 250)),
        ),
    ] {
        let bad = Shot { shore: Some(shore), ..shot.clone() };
        let why = rig.refused(&bad, None);
        assert!(why.contains(field), "{field}: {why}");
    }
    let mut plainly = Rig::new(&gpu, &config(size));
    let why = plainly.refused(&shot, None);
    assert!(why.contains("Frame.shore"), "{why}");
    let image = depth.host_image();
    let cmd = plainly.stub.begin(0);
    // SAFETY: a call with bad input uses no handle.
    let result = unsafe { plainly.renderer().record_foam_texture(cmd, Slot(0), &image) };
    plainly.stub.end(0);
    plainly.stub.wait(0);
    assert!(matches!(result, Err(Error::BadInput { field: "Config.shore", .. })));
}
