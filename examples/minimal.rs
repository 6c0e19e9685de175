//! Draws a pool of particles with a wave in it on a device of its own, and writes `minimal.png`.
//!
//! ```sh
//! cargo run --release --example minimal --features headless,io
//! ```
//!
//! [`Headless`] stands in for the engine: instance, device, images, submits. `tools/embed` is the same with a host that
//! owns all of them, as your engine does.

use std::error::Error;

use glam::{Mat4, Vec3, vec3};
use whitewater::headless::scene::Scene;
use whitewater::headless::{Background, Device, DeviceOptions, Headless};
use whitewater::io::picture::{Layers, write_png};
use whitewater::{Camera, Config, Settings};

const SIZE: [u32; 2] = [960, 540];
const SPACING: f32 = 0.03; // rest distance between particles, in metres
const BASIN: &str = r#"{"boxes": [
    {"centre": [0, -0.05, 0], "half": [1.1, 0.05, 0.7], "material": "concrete"},
    {"centre": [0, 0.2, -0.65], "half": [1.1, 0.2, 0.05], "material": "concrete"},
    {"centre": [0, 0.15, 0.65], "half": [1.1, 0.15, 0.05], "material": "concrete"},
    {"centre": [-1.1, 0.2, 0], "half": [0.05, 0.2, 0.7], "material": "concrete"},
    {"centre": [1.1, 0.2, 0], "half": [0.05, 0.2, 0.7], "material": "concrete"}]}"#;

fn main() -> Result<(), Box<dyn Error>> {
    let positions = particles();
    let extent = whitewater::ash::vk::Extent2D { width: SIZE[0], height: SIZE[1] };
    let config = Config::new(extent, whitewater::headless::COLOR_FORMAT, positions.len() as u32);
    let device = Device::new(&DeviceOptions::default())?;
    println!("{}", device.adapter);
    let mut headless = Headless::new(device, &config)?;
    headless.particles(&positions, None)?;
    headless.scene(&Scene::parse_json(BASIN.as_bytes())?, true)?;

    // Reversed depth without a far plane; row 0 is the top of the image, so y points down in clip space.
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let flip = Mat4::from_scale(vec3(1.0, -1.0, 1.0));
    let projection = flip * Mat4::perspective_infinite_reverse_rh(0.6, aspect, 0.1);
    let view = Mat4::look_at_rh(vec3(1.4, 1.5, 2.4), vec3(0.0, 0.1, 0.0), Vec3::Y);
    let camera = Camera::new(view.to_cols_array_2d(), projection.to_cols_array_2d());
    let settings = Settings::new(SPACING, 1.0); // one scene unit per metre
    headless.render(&camera, &settings, &Background::Scene)?;

    let picture = headless.color()?;
    let mut layers = Layers::new(picture.width, picture.height);
    for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
        let values = picture.data.iter().map(|rgba| rgba[channel]).collect();
        layers.push(name, picture.width, picture.height, values)?;
    }
    write_png(&layers, -1.8, std::fs::File::create("minimal.png")?)?;
    for pass in headless.timings() {
        println!("{:<12}{:>8.2} ms", pass.name, pass.nanoseconds * 1e-6);
    }
    headless.finish()?;
    Ok(())
}

/// A lattice of particles, each moved by up to a quarter of the spacing, below a wave.
fn particles() -> Vec<[f32; 3]> {
    let at = |cell: u32, axis: u32| ((cell * 3 + axis) as f32 * 12.9898).sin() * 0.25;
    let lattice = (0..68 * 16 * 40).map(|cell| {
        let (x, y, z) = (cell % 68, cell / 68 % 16, cell / (68 * 16));
        let offset = vec3(x as f32 - 33.5, y as f32 + 0.5, z as f32 - 19.5);
        SPACING * (offset + vec3(at(cell, 0), at(cell, 1), at(cell, 2)))
    });
    let below_wave = |p: &Vec3| p.y < 0.24 + 0.05 * (6.0 * p.x + 3.0 * p.z).sin();
    lattice.filter(below_wave).map(|position| position.to_array()).collect()
}
