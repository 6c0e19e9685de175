//! The occlusion queries that end the smoothing: their counts, and the variant in which the host
//! reads them.

use glam::{Mat4, Vec3};
use whitewater::ash::vk;
use whitewater::headless::{Background, COLOR_FORMAT, Headless};
use whitewater::water::{Gate, Smoothing};
use whitewater::{Camera, Config, Settings};

use crate::support::device::Gpu;

/// Draws a slanted bed of spheres: near ones get many iterations, far ones few.
fn draw(read_back: bool, test: impl FnOnce(&mut Headless)) {
    let mut gpu = Gpu::own();
    let device = gpu.take_device();
    let extent = vk::Extent2D { width: 97, height: 61 };
    let config = Config::new(extent, COLOR_FORMAT, 4096).with(|it| {
        it.smoothing_level = 0;
        it.thickness_level = 0;
        // The queries count all levels together, so there is only one.
        it.coarsening = 0;
        it.smoothing = Some(Smoothing::Query(Gate::VertexCull));
    });
    let mut headless = Headless::new(device, &config).expect("a renderer");
    let positions: Vec<[f32; 3]> = (0..40)
        .flat_map(|x| (0..60).map(move |z| [0.1 * x as f32 - 2.0, 0.0, -0.1 * z as f32]))
        .collect();
    headless.particles(&positions, None).expect("particles");
    let camera = Camera::of(
        Mat4::look_at_rh(Vec3::new(0.0, 0.8, 1.0), Vec3::new(0.0, 0.0, -2.0), Vec3::Y),
        Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0))
            * Mat4::perspective_infinite_reverse_rh(0.8, 97.0 / 61.0, 0.1),
    );
    let mut settings = Settings::default();
    settings.water.spacing = 0.1;
    let background = Background::Color([0.3; 3]);
    let drawn = if read_back {
        headless.render_with_read_back(&camera, &settings, &background)
    } else {
        headless.render(&camera, &settings, &background)
    };
    drawn.expect("a frame");
    test(&mut headless);
    let messages = headless.device().take_messages();
    assert!(messages.is_empty(), "{}", messages.join("\n"));
    headless.finish().expect("an idle device");
}

/// The query after iteration i counts the pixels with N >= i. The first query that counts none ends
/// the smoothing.
#[test]
fn each_query_counts_the_active_pixels() {
    draw(false, |headless| {
        let iterations = headless.layer("water.iterations").expect("read").expect("kept");
        let samples = headless.active_samples().expect("read");
        let most = iterations.data.iter().fold(0.0_f32, |most, n| most.max(*n));
        assert!(most > 40.0 && most < 250.0, "{most} iterations at most test little");
        let mut running = true;
        for (block, counted) in samples.iter().enumerate().take(samples.len() - 1) {
            let i = 5 * (block as u32 + 1);
            let active = iterations.data.iter().filter(|n| **n >= i as f32).count() as u32;
            let expected = if running { active } else { 0 };
            assert_eq!(*counted, expected, "iteration {i}");
            running = running && active > 0;
        }
        assert!(!running, "no query stopped the smoothing");
    });
}

/// If the host reads the queries, the smoothing ends at the same iteration, with the same bits.
#[test]
fn the_hosts_look_gives_the_same_picture() {
    let mut drawn = Vec::new();
    for read_back in [false, true] {
        draw(read_back, |headless| {
            let surface = headless.layer("water.surface").expect("read").expect("kept");
            let color = headless.color().expect("read");
            drawn.push((surface, color));
            let samples = headless.active_samples().expect("read");
            assert_eq!(samples.is_empty(), read_back, "the host has read them itself");
        });
    }
    assert!(drawn[0].0 == drawn[1].0, "other surfaces");
    assert!(drawn[0].1 == drawn[1].1, "other pictures");
}
