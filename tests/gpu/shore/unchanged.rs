//! Without shore foam in the frame, a renderer that supports it draws the same bits as one that
//! does not.

use glam::{DVec2, Mat4};
use whitewater::headless::scene::{Material, Mesh, Scene};
use whitewater::headless::{Background, Headless};
use whitewater::shore::Edge;
use whitewater::water::Shadows;
use whitewater::{Camera, Config, Shore, Shoreline};

use super::composite::{WAYS, look};
use super::shoreline::{AREA, heights};
use super::{Mapped, shore_config};
use crate::light::{SIZE, even, everything};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, config};
use crate::support::scenes::{self, Lens, projection};
use crate::surface_foam::Foamy;

fn same(name: &str, found: &Drawn, expected: &Drawn) {
    compare::same_color(&format!("{name}-output"), &found.whole, &expected.whole);
    compare::same(&format!("{name}-depth"), &found.depth, &expected.depth);
    compare::same(&format!("{name}-surface"), &found.surface, &expected.surface);
    compare::same(&format!("{name}-thickness"), &found.thickness, &expected.thickness);
    let spray = |drawn: &Drawn| drawn.spray.clone().expect("spray");
    compare::same(&format!("{name}-spray"), &spray(found), &spray(expected));
}

/// Water, foam, spray and shadows are compared without [`Frame::shore`], with one that has no
/// surface, and with a sea in which nothing stands, each after a frame with foam.
///
/// [`Frame::shore`]: whitewater::Frame::shore
#[test]
fn without_a_sea_nothing_is_another() {
    let gpu = Gpu::shared();
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&AREA, &heights(&AREA, 64, |_: DVec2| -1.0), None);
    let sea = Some(Shoreline::Map(coasts.shore_distances()));
    let (bare, level) = (Shore::new(0.0).with(|it| it.surface = None), Shore::new(0.0));
    for way in WAYS {
        let mut case = Foamy::new(SIZE, Lens::ReversedInfinite, 30.0);
        let plain = everything(&mut case).with(|it| it.composite = Some(way));
        let with = plain.with(|it| it.shore = Some(shore_config(Edge::Smooth)));
        case.shot.settings.shore = look();
        let contact = &mut case.shot.settings.shore.contact;
        (contact.particle_opacity, contact.particle_depth) = (1.0, Some(9.0));
        let [mut expected, mut rig] = [plain, with].map(|config| Rig::lit(&gpu, &config, 1));
        let (_image, shadow) = even(&expected, 0.625);
        case.shot.shadow = Some(shadow);
        let expected = case.draw(&mut expected);
        let mut foamy = case.clone();
        foamy.shot.scene_depth(|_, _| Some(9.0));
        foamy.shot.shore = Some(level.with(|it| it.shoreline = Some(Shoreline::Screen)));
        let foam = foamy.draw(&mut rig).shore.expect("foam");
        for channel in 0..4 {
            let count = foam.data.iter().filter(|texel| texel[channel] > 0).count();
            assert!(count > 100, "{way:?}: {count} pixels have some of {channel}");
        }
        for (name, shore) in [
            ("none", None),
            ("of nothing", Some(bare)),
            ("far below", Some(Shore::new(-1000.0))),
            ("no shore", Some(level.with(|it| it.shoreline = sea))),
        ] {
            case.shot.shore = shore;
            same(&format!("shore-{way:?}-{name}"), &case.draw(&mut rig), &expected);
        }
    }
}

/// A picture of a stand-in scene without a sea.
fn headless(config: &Config) -> Vec<[f32; 4]> {
    let mut headless = Headless::new(Gpu::own().take_device(), config).expect("headless");
    let floor = Mesh::plane([0.0, -1.0, 0.0], [30.0; 2], Material::named("island").expect("one"));
    let stone = Material::named("rock").expect("one");
    let stone = Mesh::cuboid([0.5, -0.5, 0.0], [1.0, 2.0, 1.0], [0.0, 0.0, 0.0, 1.0], stone);
    let scene = Scene { meshes: vec![floor, stone], ..Scene::default() };
    headless.scene(&scene, true).expect("scene");
    let points = scenes::block(3, 0.2, [12, 4, 12], [-1.2, -1.0, -1.2]);
    headless.particles(&points, None).expect("particles");
    let eye = Mat4::look_at_rh([2.0, 3.0, 4.0].into(), [0.0; 3].into(), [0.0, 1.0, 0.0].into());
    let camera = Camera::of(eye, projection(Lens::ReversedInfinite, config.extent));
    let mut settings = scenes::settings(0.13).with(|it| it.shore = look());
    settings.shore.contact.particle_opacity = 1.0;
    headless.render(&camera, &settings, &Background::Scene).expect("a frame");
    let color = headless.color().expect("read back").data;
    let device = headless.finish().expect("finish");
    assert_eq!(device.take_messages(), Vec::<String>::new());
    color
}

/// The command-line tool's renderer always supports shores, also for scenes without one.
#[test]
fn a_scene_without_a_sea_is_the_same() {
    let plain = config(SIZE).with(|it| {
        it.shadow = Some(Shadows::Map);
        it.sheets = 2;
    });
    let with = plain.with(|it| it.shore = Some(shore_config(Edge::Smooth)));
    let [expected, found] = [plain, with].map(|config| headless(&config));
    let differ = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "of {} pixels", expected.len());
}
