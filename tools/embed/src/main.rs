//! The smallest host application. It owns all Vulkan objects, its scene is a cleared colour and depth image, and
//! whitewater records the water into its command buffers, with two frames in flight.
//!
//! `whitewater-embed [--validate] [PICTURE.ppm]` draws a few frames of a wave in a pool, prints the time of each pass
//! and writes the last frame. With `--validate` any message of core or synchronization validation is an error.
//!
//! `vulkan.rs` is what an engine already has: device, images, buffers. It shows how to choose the device and which
//! features to enable.

mod vulkan;

use std::error::Error;

use glam::{Mat4, Vec3, vec3};
pub use vulkan::take_messages;
use vulkan::{CLEAR, COPY, Gpu};
use whitewater::ash::vk;
use whitewater::gpu_allocator::MemoryLocation;
use whitewater::{
    Camera, Config, Context, Count, EnvironmentSource, Frame, Host, Particles, Renderer, Settings,
    Sky, Slot, Stream, Timing,
};

/// Size of the picture.
pub const EXTENT: vk::Extent2D = vk::Extent2D { width: 960, height: 540 };
const FRAMES: u32 = 4;
const FRAMES_IN_FLIGHT: u32 = 2;
const MAX_PARTICLES: usize = 32_768;
const SPACING: f32 = 0.03; // between particles at rest, in metres

/// A particle as this host stores it. Its size is the stride of both streams, positions and densities.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Particle {
    position: [f32; 3],
    density: f32,
}

/// Pixels in RGBA16F, the top row first: linear light, neither exposed nor tone mapped.
pub type Picture = Vec<[u16; 4]>;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let validate = arguments.iter().any(|argument| argument == "--validate");
    arguments.retain(|argument| argument != "--validate");
    if arguments.len() > 1 || arguments.iter().any(|argument| argument.starts_with('-')) {
        return Err("usage: whitewater-embed [--validate] [PICTURE.ppm]".into());
    }
    let (pixels, timings) = draw(validate, |_| ())?;
    for pass in &timings {
        println!("{:<20}{:>9.3} ms", pass.name, pass.nanoseconds * 1e-6);
    }
    let mut ppm = format!("P6 {} {} 255\n", EXTENT.width, EXTENT.height).into_bytes();
    ppm.extend(pixels.iter().flat_map(|rgba| &rgba[..3]).map(|&half| tone_map(half)));
    std::fs::write(arguments.first().map_or("embed.ppm", String::as_str), ppm)?;
    let messages = take_messages();
    for message in messages.iter().take(10) {
        eprintln!("{message}");
    }
    match messages.len() {
        0 => Ok(()),
        count => Err(format!("{count} messages from validation").into()),
    }
}

/// Draws the frames; returns the last one with the times of its passes. `adjust` changes the default configuration.
/// After an error the Vulkan objects are not destroyed, as the process ends.
pub fn draw(
    validate: bool,
    adjust: impl FnOnce(&mut Config),
) -> Result<(Picture, Vec<Timing>), Box<dyn Error>> {
    let format = vk::Format::R16G16B16A16_SFLOAT; // linear light, above 1 too
    let mut config = Config::new(EXTENT, format, MAX_PARTICLES as u32);
    adjust(&mut config);
    let gpu = Gpu::new(validate, &config)?;
    let device = &gpu.device;

    // The water is drawn into the scene's image, which must also be a copy's source.
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let (color, color_memory) =
        gpu.image(format, EXTENT, vk::ImageAspectFlags::COLOR, usage, COPY)?;
    // The depth image is only sampled, but its layout is an attachment's, so it needs that usage too.
    let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED;
    let (depth, depth_memory) =
        gpu.image(vk::Format::D32_SFLOAT, EXTENT, vk::ImageAspectFlags::DEPTH, usage, CLEAR)?;
    // A region for each frame in flight: the CPU writes one while the GPU reads another.
    let region = (MAX_PARTICLES * size_of::<Particle>()) as u64;
    let size = region * u64::from(FRAMES_IN_FLIGHT);
    let (buffer, mut buffer_memory) =
        gpu.buffer(size, vk::BufferUsageFlags::STORAGE_BUFFER, MemoryLocation::CpuToGpu)?;
    let picture_size = u64::from(EXTENT.width * EXTENT.height) * 8;
    let (picture, picture_memory) =
        gpu.buffer(picture_size, vk::BufferUsageFlags::TRANSFER_DST, MemoryLocation::GpuToCpu)?;

    let host =
        Host::new(&gpu.instance, gpu.physical_device, device, gpu.queue_family, FRAMES_IN_FLIGHT)
            .with_allocator(gpu.allocator.clone())
            .with_enabled(gpu.enabled);
    // SAFETY: the handles belong together and outlive context and renderer; `enabled` holds exactly the enabled
    // features.
    let context = unsafe { Context::new(&host)? };
    let mut water = Renderer::new(&context, &config)?;
    drop((host, context)); // they share the allocator, which has to go before the device
    let settings = Settings::new(SPACING, 1.0); // metres; the light is that of the sky below

    let family = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.queue_family);
    let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
    let mut slots = Vec::new();
    for _ in 0..FRAMES_IN_FLIGHT {
        // SAFETY: valid create infos on a live device.
        unsafe {
            let pool = device.create_command_pool(&family, None)?;
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool);
            let cmd = device.allocate_command_buffers(&info.command_buffer_count(1))?[0];
            slots.push((pool, cmd, device.create_fence(&signaled, None)?));
        }
    }

    for number in 0..FRAMES {
        let slot = Slot(number % FRAMES_IN_FLIGHT);
        let (pool, cmd, fence) = slots[slot.0 as usize];
        // SAFETY: after the fence nothing uses the slot's commands or its pool.
        unsafe {
            device.wait_for_fences(&[fence], true, u64::MAX)?;
            device.reset_fences(&[fence])?;
            device.reset_command_pool(pool, vk::CommandPoolResetFlags::empty())?;
            device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
            water.collect(slot);
        }

        let time = number as f32 / 30.0;
        let wave = wave(time);
        let offset = region * u64::from(slot.0);
        let bytes: &[u8] = bytemuck::cast_slice(&wave);
        let mapped = buffer_memory.mapped_slice_mut().ok_or("the particles are not mapped")?;
        mapped[offset as usize..][..bytes.len()].copy_from_slice(bytes);
        let stream = |field: usize| {
            let stride = size_of::<Particle>() as u32;
            Stream { buffer, size, offset: offset + field as u64, stride }
        };
        // The CPU wrote before the submit, which needs no barrier: before and after stay `access::NOTHING`.
        let particles = Particles::new(
            stream(std::mem::offset_of!(Particle, position)),
            Count::Cpu(wave.len() as u32),
        )
        .with_densities(stream(std::mem::offset_of!(Particle, density)));
        // Reversed depth without a far plane. Row 0 is the bottom in glam and the top in Vulkan.
        let aspect = EXTENT.width as f32 / EXTENT.height as f32;
        let projection = Mat4::from_scale(vec3(1.0, -1.0, 1.0))
            * Mat4::perspective_infinite_reverse_rh(0.6, aspect, 0.1);
        let view = Mat4::look_at_rh(vec3(1.2 - 2.0 * time, 1.9, 1.8), vec3(0.0, 0.1, 0.0), Vec3::Y);
        let camera = Camera::new(view.to_cols_array_2d(), projection.to_cols_array_2d());
        let frame = Frame::new(slot, color, depth, particles, camera, &settings);

        // SAFETY: cmd is recording outside a render pass; all objects that it uses live until the fence.
        unsafe {
            gpu.clear(cmd, &color, &depth);
            if number == 0 {
                water.record_setup(cmd);
                water.record_environment(cmd, slot, &EnvironmentSource::Sky(Sky::default()))?;
            }
            water.record(cmd, &frame)?;
            if number + 1 == FRAMES {
                gpu.copy(cmd, &color, picture);
            }
            device.end_command_buffer(cmd)?;
            let submit = vk::SubmitInfo::default().command_buffers(std::slice::from_ref(&cmd));
            device.queue_submit(gpu.queue, &[submit], fence)?;
        }
    }

    // SAFETY: nothing is destroyed before the GPU is idle, nor used afterwards.
    unsafe {
        device.device_wait_idle()?;
        let timings = water.timings(Slot((FRAMES - 1) % FRAMES_IN_FLIGHT)).to_vec();
        let bytes = picture_memory.mapped_slice().ok_or("the picture is not mapped")?;
        let pixels = bytemuck::cast_slice(&bytes[..picture_size as usize]).to_vec();
        water.destroy();
        for (pool, _, fence) in slots {
            device.destroy_command_pool(pool, None);
            device.destroy_fence(fence, None);
        }
        for image in [color, depth] {
            device.destroy_image_view(image.view, None);
            device.destroy_image(image.image, None);
        }
        device.destroy_buffer(buffer, None);
        device.destroy_buffer(picture, None);
        gpu.destroy([color_memory, depth_memory, buffer_memory, picture_memory])?;
        Ok((pixels, timings))
    }
}

/// About 20 000 particles: a box of water with a wave running through it.
fn wave(time: f32) -> Vec<Particle> {
    let mut particles = Vec::with_capacity(MAX_PARTICLES);
    for cell in 0..64 * 24 * 32 {
        let (x, y, z) = (cell % 64, cell / 64 % 24, cell / (64 * 24));
        // Jitter of up to a quarter of the lattice, as simulated particles are irregular.
        let jitter = |axis: u32| ((cell * 3 + axis) as f32 * 12.9898).sin() * 0.25;
        let position = SPACING
            * vec3(
                x as f32 - 31.5 + jitter(0),
                y as f32 + 0.5 + jitter(1),
                z as f32 - 15.5 + jitter(2),
            );
        let phase = 6.0 * position.x + 3.0 * position.z - 6.0 * time;
        if position.y < 0.28 + 0.06 * phase.sin() {
            particles.push(Particle { position: position.to_array(), density: 1000.0 });
        }
    }
    particles
}

/// Converts a half float of linear light to a display byte, approximately: x / (1 + x), gamma 2.2.
fn tone_map(half: u16) -> u8 {
    // A float with the bits of a positive half, shifted into place, has 2^-112 of its value.
    let linear = f32::from_bits(u32::from(half & 0x7fff) << 13) * 2f32.powi(112);
    (255.0 * (linear / (1.0 + linear)).powf(1.0 / 2.2)).round() as u8
}
