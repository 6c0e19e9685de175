//! Whitewater particles uploaded in parts give the same picture as a single upload, and wrong parts
//! are errors.

use whitewater::WhitewaterConfig;
use whitewater::headless::{Background, Device, Headless, Picture, Whitewater};
use whitewater::{Camera, Error, Settings};

use crate::support::device::Gpu;
use crate::support::rig::{Shot, config, extent};
use crate::support::scenes::{self, Lens, Random};

const COUNT: usize = 1500;

/// Particles of all kinds and ages.
struct Cloud {
    camera: Camera,
    positions: Vec<[f32; 3]>,
    kinds: Vec<u32>,
    radii: Vec<f32>,
    ages: Vec<f32>,
    ids: Vec<u32>,
}

impl Cloud {
    fn new() -> Self {
        let shot = Shot::new(extent(64, 48), Lens::Reversed, 0.2, &scenes::cloud(31, 40, 3.0, 9.0));
        let positions = scenes::world(&shot.camera, &scenes::cloud(7, COUNT, 2.0, 9.0));
        let mut random = Random(3);
        Self {
            camera: shot.camera,
            kinds: (0..COUNT).map(|i| i as u32 % 3).collect(),
            radii: (0..COUNT).map(|_| random.between(0.02, 0.4)).collect(),
            ages: (0..COUNT).map(|_| random.between(0.0, 1.0)).collect(),
            ids: (0..COUNT).map(|_| random.bits() as u32).collect(),
            positions,
        }
    }

    fn part(&self, range: std::ops::Range<usize>) -> Whitewater<'_> {
        Whitewater {
            positions: &self.positions[range.clone()],
            kinds: Some(&self.kinds[range.clone()]),
            radii: Some(&self.radii[range.clone()]),
            ages: Some(&self.ages[range.clone()]),
            ids: Some(&self.ids[range]),
        }
    }

    fn draw(&self, headless: &mut Headless) -> Picture<[f32; 4]> {
        let background = Background::Color([0.1, 0.2, 0.3]);
        headless.render(&self.camera, &Settings::default(), &background).expect("a frame");
        headless.color().expect("a picture")
    }
}

fn headless(device: Device, most: u32) -> Headless {
    let config =
        config(extent(64, 48)).with(|it| it.whitewater = Some(WhitewaterConfig::new(most)));
    let mut headless = Headless::new(device, &config).expect("headless");
    headless.particles(&[], None).expect("no water");
    headless
}

fn end(headless: Headless) {
    let messages = headless.device().take_messages();
    assert!(messages.is_empty(), "{messages:?}");
    drop(headless.finish().expect("finish"));
}

#[test]
fn parts_of_any_size_make_the_picture_of_all() {
    let mut gpu = Gpu::own();
    let mut headless = headless(gpu.take_device(), COUNT as u32);
    let cloud = Cloud::new();
    let none = cloud.draw(&mut headless);
    headless.whitewater(Some(&cloud.part(0..COUNT))).expect("all at once");
    // A word for each of four attributes, and three for the position.
    assert!(headless.whitewater_memory() >= 28 * COUNT as u64);
    let once = cloud.draw(&mut headless);
    assert_ne!(once, none, "it shows");
    for size in [7, 333, 1024, COUNT] {
        headless.whitewater(None).expect("none");
        assert_eq!(cloud.draw(&mut headless), none, "those before are gone");
        let mut parts = headless.whitewater_parts(COUNT).expect("room");
        // One particle first, then the others. An empty part changes nothing.
        parts.push(&cloud.part(0..1)).expect("the first");
        parts.push(&cloud.part(1..1)).expect("an empty one");
        for first in (1..COUNT).step_by(size) {
            parts.push(&cloud.part(first..COUNT.min(first + size))).expect("a part");
        }
        parts.finish().expect("all");
        assert_eq!(cloud.draw(&mut headless), once, "in parts of {size}");
    }
    end(headless);
}

/// Packets of uploaded particles, in parts of any size, do not change the picture. The particles
/// lie on all sides of the view.
#[test]
fn packets_of_parts_make_the_same_picture() {
    let mut cloud = Cloud::new();
    // The particles extend along a line that begins and ends beside the view, and one has an
    // invalid position.
    let right = cloud.camera.view_matrix().row(0).truncate();
    let across = |p: [f32; 3]| right.dot(glam::Vec3::from(p));
    cloud.positions.sort_by(|a, b| across(*a).total_cmp(&across(*b)));
    for (i, position) in cloud.positions.iter_mut().enumerate() {
        let along = (i as f32 / COUNT as f32 - 0.5) * 40.0;
        *position = (glam::Vec3::from(*position) + along * right).to_array();
    }
    cloud.positions[COUNT / 2] = [f32::NAN; 3];
    let mut gpu = Gpu::own();
    let mut plain = headless(gpu.take_device(), COUNT as u32);
    plain.whitewater(Some(&cloud.part(0..COUNT))).expect("all at once");
    let (expected, memory) = (cloud.draw(&mut plain), plain.whitewater_memory());
    end(plain);
    let whitewater = WhitewaterConfig::new(COUNT as u32).with(|it| it.packets = true);
    let config = config(extent(64, 48)).with(|it| it.whitewater = Some(whitewater));
    let mut headless = Headless::new(Gpu::own().take_device(), &config).expect("headless");
    headless.particles(&[], None).expect("no water");
    for size in [100, 256, 700, COUNT] {
        let mut parts = headless.whitewater_parts(COUNT).expect("room");
        for first in (0..COUNT).step_by(size) {
            parts.push(&cloud.part(first..COUNT.min(first + size))).expect("a part");
        }
        parts.finish().expect("all");
        // Six packets of 256 particles.
        assert!(headless.whitewater_memory() >= memory + 6 * 32, "no packets");
        assert_eq!(cloud.draw(&mut headless), expected, "in parts of {size}");
    }
    headless.whitewater(None).expect("none");
    cloud.draw(&mut headless);
    end(headless);
}

/// More particles than the staging buffer holds at once. Most are too old, and come before the
/// visible ones.
#[test]
fn a_large_part_goes_piece_by_piece() {
    const OVER: usize = 400_001;
    let mut gpu = Gpu::own();
    let mut headless = headless(gpu.take_device(), (OVER + COUNT) as u32);
    let cloud = Cloud::new();
    headless.whitewater(Some(&cloud.part(0..COUNT))).expect("those alone");
    let alone = cloud.draw(&mut headless);
    let after = |own: &[u32], other: u32| [vec![other; OVER], own.to_vec()].concat();
    let lengthy = |own: &[f32]| [vec![1.0; OVER], own.to_vec()].concat();
    let all = Cloud {
        camera: cloud.camera,
        positions: [vec![cloud.positions[0]; OVER], cloud.positions.clone()].concat(),
        kinds: after(&cloud.kinds, 0),
        radii: lengthy(&cloud.radii),
        ages: lengthy(&cloud.ages),
        ids: after(&cloud.ids, 0),
    };
    headless.whitewater(Some(&all.part(0..OVER + COUNT))).expect("all");
    assert_eq!(cloud.draw(&mut headless), alone);
    end(headless);
}

fn field_and_why(error: Error) -> (&'static str, String) {
    match error {
        Error::BadInput { field, why } => (field, why),
        other => panic!("{other}"),
    }
}

#[test]
fn what_does_not_fit_is_an_error_and_leaves_none() {
    let mut gpu = Gpu::own();
    let mut headless = headless(gpu.take_device(), COUNT as u32);
    let cloud = Cloud::new();
    let none = cloud.draw(&mut headless);
    let wrong = |result: Result<(), Error>, says: &str| {
        let (field, why) = field_and_why(result.expect_err(says));
        assert!(field == "whitewater" && why.contains(says), "{field}: {why}");
    };
    // More particles than the renderer has room for.
    wrong(headless.whitewater_parts(COUNT + 1).map(drop), "1501 is more than");
    let mut parts = headless.whitewater_parts(COUNT).expect("room");
    let short = Whitewater { ages: Some(&cloud.ages[..9]), ..cloud.part(0..10) };
    wrong(parts.push(&short), "not as long as positions");
    parts.push(&cloud.part(0..1000)).expect("a part");
    let other = Whitewater { radii: None, ..cloud.part(1000..1100) };
    wrong(parts.push(&other), "its attributes differ");
    wrong(
        parts.push(&cloud.part(900..COUNT)),
        "expected at most 500 more particles, found a part of 600",
    );
    wrong(parts.finish(), "expected 1500 particles, found 1000");
    assert_eq!(cloud.draw(&mut headless), none);
    // The parts are abandoned half way.
    headless.whitewater(Some(&cloud.part(0..COUNT))).expect("all at once");
    let mut parts = headless.whitewater_parts(COUNT).expect("room");
    parts.push(&cloud.part(0..1000)).expect("a part");
    drop(parts);
    assert_eq!(cloud.draw(&mut headless), none);
    // An upload of 0 particles, and one of all particles after the failures.
    headless.whitewater_parts(0).expect("room").finish().expect("none");
    assert_eq!(cloud.draw(&mut headless), none);
    headless.whitewater(Some(&cloud.part(0..COUNT))).expect("all at once");
    assert_ne!(cloud.draw(&mut headless), none);
    end(headless);
}
