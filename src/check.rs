//! Validates everything that a host passes, before the first command is recorded.

use ash::vk;

use crate::contract::{
    Blobs, Config, Count, Frame, HostImage, Packets, Particles, Shore, Shoreline, Slot, Stream,
    Surface, WhitewaterParticles,
};
use crate::error::Error;
use crate::frame::{Lens, check_settings, check_up};
use crate::water::MOST_COARSENING;
use crate::water::panes;
use crate::water::settings::{Shadows, range};

/// The field names of a host image's states and rect, for [`image`].
macro_rules! fields {
    ($image:literal) => {
        [concat!($image, ".before"), concat!($image, ".after"), concat!($image, ".rect")]
    };
}
pub(crate) use fields;

/// Validates a frame for a renderer's configuration; returns its decomposed camera.
pub fn frame(
    frame: &Frame<'_>,
    config: &Config,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<Lens, Error> {
    check_up("Settings.up", frame.settings.up)?;
    check_settings(&frame.settings.water, &frame.settings.light)?;
    frame.settings.surface_foam.check()?;
    frame.settings.spray.check()?;
    frame.settings.shadow.check()?;
    frame.settings.noise.check()?;
    frame.settings.whitewater.check()?;
    frame.settings.bubbles.check()?;
    frame.settings.shore.check()?;
    let (part, most) = (frame.output.rect.extent, config.extent);
    if part.width > most.width || part.height > most.height {
        return Err(Error::bad(
            "Frame.output.rect",
            format!(
                "{}x{}, but the renderer is made for {}x{} at most: call resize first",
                part.width, part.height, most.width, most.height
            ),
        ));
    }
    if frame.output.format != config.output_format {
        return Err(Error::bad(
            "Frame.output.format",
            format!("{:?} is not Config.output_format", frame.output.format),
        ));
    }
    let shadow = frame.shadow.as_ref().map(|s| (fields!("Frame.shadow.image"), &s.image));
    let images = [
        (fields!("Frame.output"), &frame.output),
        (fields!("Frame.scene_color"), &frame.scene_color),
        (fields!("Frame.scene_depth"), &frame.scene_depth),
    ];
    let fluid = frame.whitewater.as_ref().and_then(|whitewater| whitewater.fluid_depth.as_ref());
    let fluid = fluid.map(|image| (fields!("Frame.whitewater.fluid_depth"), image));
    let own = frame.shore.as_ref();
    let surface = own.and_then(crate::shore::surface_of);
    let mask = own.and_then(|shore| shore.mask.as_ref());
    let shore = [(fields!("Frame.shore.surface"), surface), (fields!("Frame.shore.mask"), mask)];
    let shore = shore.into_iter().filter_map(|(fields, image)| Some((fields, image?)));
    let lent: Vec<_> = shadow.into_iter().chain(fluid).chain(shore).collect();
    for (fields, image) in images.into_iter().chain(lent.iter().copied()) {
        self::image(fields, image)?;
    }
    for (i, ([before, after, _], image)) in lent.iter().enumerate() {
        let Some((_, same)) = lent[..i].iter().find(|(_, other)| other.image == image.image) else {
            continue;
        };
        for (field, one, other) in
            [(*before, image.before, same.before), (*after, image.after, same.after)]
        {
            if one != other {
                let why = format!("{one:?}, but another input is the same image with {other:?}");
                return Err(Error::bad(field, why));
            }
        }
    }
    if frame.in_place() && !config.in_place {
        return Err(Error::bad(
            "Frame.scene_color",
            "is the output itself, but Config.in_place is false",
        ));
    }
    particles(&frame.particles, config, limits)?;
    if let Some(particles) = &frame.whitewater {
        whitewater(frame, particles, config, limits)?;
    }
    if let Some(blobs) = &frame.bubbles {
        bubbles(blobs, config, limits)?;
    }
    if let Some(own) = &frame.shore {
        self::shore(frame, own, config, limits)?;
    }
    sun(frame, config)?;
    previous(frame, config)?;
    panes::check(frame.panes)?;
    Lens::new(&frame.camera)
}

/// Checks an image that the host passes: its layouts `before` and `after`, and whether `rect` lies inside it. The
/// three strings are the names of these fields in error messages.
pub fn image([before, after, rect]: [&'static str; 3], image: &HostImage) -> Result<(), Error> {
    if image.before.layout == vk::ImageLayout::UNDEFINED {
        return Err(Error::bad(before, "UNDEFINED: its contents would be lost"));
    }
    if matches!(image.after.layout, vk::ImageLayout::UNDEFINED | vk::ImageLayout::PREINITIALIZED) {
        return Err(Error::bad(after, "no image can be left UNDEFINED"));
    }
    let vk::Rect2D { offset, extent } = image.rect;
    let fits = |at: i32, size: u32, whole: u32| {
        at >= 0 && size > 0 && u64::from(at.unsigned_abs()) + u64::from(size) <= whole.into()
    };
    if fits(offset.x, extent.width, image.extent.width)
        && fits(offset.y, extent.height, image.extent.height)
    {
        return Ok(());
    }
    Err(Error::bad(
        rect,
        format!(
            "{}x{} at ({}, {}) is not inside an image of {}x{}",
            extent.width,
            extent.height,
            offset.x,
            offset.y,
            image.extent.width,
            image.extent.height
        ),
    ))
}

fn shore(
    frame: &Frame<'_>,
    shore: &Shore,
    config: &Config,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<(), Error> {
    let bad = |field, why: &str| Err(Error::bad(field, why));
    if config.shore.is_none() {
        return bad("Frame.shore", "given, but Config.shore is None");
    }
    range("Frame.shore.bias", shore.bias, 0.0, 1000.0)?;
    let surface = crate::shore::surface_of(shore);
    if surface.is_some_and(|image| image.image == frame.scene_depth.image) {
        return bad("Frame.shore.surface", "expected another image than the scene's depth");
    }
    if let Some(Surface::Level(level)) = shore.surface {
        range("Frame.shore.surface", level, -1.0e9, 1.0e9)?;
    }
    match &shore.shoreline {
        Some(Shoreline::Strip(strip)) => {
            let positions = "Frame.shore.shoreline.triangles.positions";
            let indices = "Frame.shore.shoreline.triangles.indices";
            let fields = [positions, indices, "Frame.shore.shoreline.triangles"];
            strip.triangles.check(fields, limits)?;
            let vertices = strip.triangles.vertices;
            let most = ("the device's limit", limits.max_storage_buffer_range / vertices.max(1));
            strip.coordinates.check("Frame.shore.shoreline.coordinates", 4, vertices, most)
        }
        Some(_) if shore.surface.is_none() => bad(
            "Frame.shore.surface",
            "none, but Frame.shore.shoreline needs it, unless it is a strip",
        ),
        _ => Ok(()),
    }
}

fn particles(
    particles: &Particles,
    config: &Config,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<(), Error> {
    let fields = ["Frame.particles.count", "Frame.particles.count.offset"];
    let most = ("Config.max_particles", config.max_particles);
    let count = count(fields, particles.count, most, limits)?;
    let stream = |field, stream: &Stream, bytes: u64| {
        stream.check(field, bytes, count, ("Config.max_stride", config.max_stride))
    };
    stream("Frame.particles.positions", &particles.positions, 12)?;
    if let Some(densities) = &particles.densities {
        stream("Frame.particles.densities", densities, 4)?;
    }
    if let Some(velocities) = &particles.velocities {
        stream("Frame.particles.velocities", velocities, 12)?;
    }
    if let Some(ids) = &particles.ids {
        stream("Frame.particles.ids", ids, 4)?;
    }
    if let Some(foam) = &particles.surface_foam {
        stream("Frame.particles.surface_foam", foam, 8)?;
        if !config.surface_foam {
            let why = "given, but Config.surface_foam is false";
            return Err(Error::bad("Frame.particles.surface_foam", why));
        }
    }
    let fields = ["Frame.particles.packets.offset", "Frame.particles.packets.count"];
    particles.packets.map_or(Ok(()), |those| packets(fields, &those, limits))
}

fn packets(
    [offset, count]: [&'static str; 2],
    packets: &Packets,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<(), Error> {
    aligned(offset, packets.offset, limits)?;
    if packets.count > 65_535 {
        return Err(Error::bad(count, format!("{} is more than 65535", packets.count)));
    }
    Ok(())
}

fn whitewater(
    frame: &Frame<'_>,
    particles: &WhitewaterParticles,
    config: &Config,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<(), Error> {
    let Some(config) = &config.whitewater else {
        return Err(Error::bad("Frame.whitewater", "given, but Config.whitewater is None"));
    };
    let fields = ["Frame.whitewater.count", "Frame.whitewater.count.offset"];
    let most = ("Config.whitewater.max_particles", config.max_particles);
    let count = count(fields, particles.count, most, limits)?;
    let most = ("Config.whitewater.max_stride", config.max_stride);
    if particles.fluid_depth.is_some_and(|image| image.image == frame.scene_depth.image) {
        return Err(Error::bad(
            "Frame.whitewater.fluid_depth",
            "expected another image than the scene's depth",
        ));
    }
    particles.positions.check("Frame.whitewater.positions", 12, count, most)?;
    let others = [
        ("Frame.whitewater.kinds", &particles.kinds),
        ("Frame.whitewater.radii", &particles.radii),
        ("Frame.whitewater.ages", &particles.ages),
        ("Frame.whitewater.ids", &particles.ids),
    ];
    for (field, stream) in others {
        if let Some(stream) = stream {
            stream.check(field, 4, count, most)?;
        }
    }
    let fields = ["Frame.whitewater.packets.offset", "Frame.whitewater.packets.count"];
    match &particles.packets {
        Some(_) if !config.packets => Err(Error::bad(
            "Frame.whitewater.packets",
            "given, but Config.whitewater.packets is false",
        )),
        Some(those) => packets(fields, those, limits),
        None => Ok(()),
    }
}

fn bubbles(blobs: &Blobs, config: &Config, limits: &vk::PhysicalDeviceLimits) -> Result<(), Error> {
    let Some(config) = &config.bubbles else {
        return Err(Error::bad("Frame.bubbles", "given, but Config.bubbles is None"));
    };
    if config.crossfade {
        let why = "given, but Config.bubbles.crossfade makes the blobs of whitewater foam";
        return Err(Error::bad("Frame.bubbles", why));
    }
    let fields = ["Frame.bubbles.count", "Frame.bubbles.count.offset"];
    let most = ("Config.bubbles.max_blobs", config.max_blobs);
    let count = count(fields, blobs.count, most, limits)?;
    // All blobs are bound at once.
    let stride = (limits.max_storage_buffer_range / config.max_blobs) & !3;
    let most = ("the device's limit for Config.bubbles.max_blobs", stride);
    blobs.spheres.check("Frame.bubbles.spheres", 16, count, most)?;
    if let Some(turns) = &blobs.rotations {
        turns.check("Frame.bubbles.rotations", 16, count, most)?;
    }
    blobs.ids.map_or(Ok(()), |ids| ids.check("Frame.bubbles.ids", 4, count, most))
}

/// Returns a particle count after checking that it is at most `most`. If the count is in a GPU buffer, returns 0
/// after checking its offset. For error messages, `field` and `offset_field` are the names of the count and of the
/// offset, `name` that of the configured maximum `most`.
pub fn count(
    [field, offset_field]: [&'static str; 2],
    count: Count,
    (name, most): (&str, u32),
    limits: &vk::PhysicalDeviceLimits,
) -> Result<u32, Error> {
    match count {
        Count::Cpu(count) if count > most => {
            Err(Error::bad(field, format!("{count} is more than {name}, {most}")))
        }
        Count::Cpu(count) => Ok(count),
        Count::Gpu { offset, .. } => aligned(offset_field, offset, limits).map(|()| 0),
    }
}

/// Validates the slot and duration of a step.
pub fn step(
    [slot_field, dt_field]: [&'static str; 2],
    slot: Slot,
    slots: usize,
    dt: f32,
) -> Result<(), Error> {
    if slot.0 as usize >= slots {
        let why = format!("expected less than {slots} (the frames in flight), found {}", slot.0);
        return Err(Error::bad(slot_field, why));
    }
    if !dt.is_finite() || dt < 0.0 {
        return Err(Error::bad(dt_field, format!("expected seconds, found {dt}")));
    }
    Ok(())
}

/// Validates the offset of a storage-buffer binding.
fn aligned(
    field: &'static str,
    offset: u64,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<(), Error> {
    let to = limits.min_storage_buffer_offset_alignment.max(4);
    if offset.is_multiple_of(to) {
        return Ok(());
    }
    Err(Error::bad(field, format!("{offset} is not a multiple of the device's {to}")))
}

fn previous(frame: &Frame<'_>, config: &Config) -> Result<(), Error> {
    let Some(previous) = &frame.previous else { return Ok(()) };
    if !config.motion {
        return Err(Error::bad("Frame.previous", "given, but Config.motion is false"));
    }
    let dt = previous.dt;
    if !(dt.is_finite() && dt >= 0.0) {
        return Err(Error::bad("Frame.previous.dt", format!("expected at least 0, found {dt}")));
    }
    match Lens::new(&previous.camera) {
        Err(Error::BadInput { field: "Frame.camera.view", why }) => {
            Err(Error::bad("Frame.previous.camera.view", why))
        }
        Err(Error::BadInput { why, .. }) => {
            Err(Error::bad("Frame.previous.camera.projection", why))
        }
        Err(other) => Err(other),
        Ok(_) => Ok(()),
    }
}

fn sun(frame: &Frame<'_>, config: &Config) -> Result<(), Error> {
    let bad = |field, why: &str| Err(Error::bad(field, why));
    match (config.shadow, &frame.shadow) {
        (Some(_), None) => return bad("Frame.shadow", "none, but Config.shadow asks for it"),
        (None, Some(_)) => return bad("Frame.shadow", "given, but Config.shadow is None"),
        (Some(Shadows::Map | Shadows::Convolution(_)), Some(shadow)) => {
            let clip = shadow.clip();
            if !clip.is_finite() || clip.determinant().abs() < 1e-30 {
                return bad("Frame.shadow.view_projection", "not finite, or singular");
            }
            if !shadow.bias.is_finite() {
                return bad("Frame.shadow.bias", "not finite");
            }
        }
        _ => {}
    }
    match (config.light_map_size, &frame.light_volume) {
        (Some(_), None) => bad("Frame.light_volume", "none, but Config.light_map_size asks for it"),
        (None, Some(_)) => bad("Frame.light_volume", "given, but Config.light_map_size is None"),
        (Some(_), Some(region)) => {
            let finite = region.center.iter().all(|c| c.is_finite());
            if finite && region.radius.is_finite() && region.radius > 0.0 {
                Ok(())
            } else {
                bad("Frame.light_volume", "expected a finite centre and a radius above 0")
            }
        }
        (None, None) => Ok(()),
    }
}

/// Validates a configuration without looking at the device. [`DeviceSupport`](crate::DeviceSupport) tells what a
/// device lacks for it.
pub fn config(config: &Config) -> Result<(), Error> {
    let bad = |field, why: String| Err(Error::bad(field, why));
    if config.extent.width == 0 || config.extent.height == 0 {
        return bad("Config.extent", "zero; a minimised window has nothing to draw".into());
    }
    if config.max_particles == 0 {
        return bad("Config.max_particles", "zero; it sizes the buffers".into());
    }
    if config.max_stride < 4 || !config.max_stride.is_multiple_of(4) {
        return bad("Config.max_stride", format!("{} is not a multiple of 4", config.max_stride));
    }
    if config.smoothing_level > 2 {
        return bad(
            "Config.smoothing_level",
            format!("expected 0, 1 or 2, found {}", config.smoothing_level),
        );
    }
    if config.thickness_level > 3 {
        return bad(
            "Config.thickness_level",
            format!("expected 0 to 3, found {}", config.thickness_level),
        );
    }
    if !(1..=256).contains(&config.max_iterations) {
        return bad(
            "Config.max_iterations",
            format!("expected 1 to 256, found {}", config.max_iterations),
        );
    }
    if config.coarsening > MOST_COARSENING {
        return bad("Config.coarsening", format!("expected 0 to 3, found {}", config.coarsening));
    }
    if config.mirror_steps > 64 {
        return bad(
            "Config.mirror_steps",
            format!("expected 0 to 64, found {}", config.mirror_steps),
        );
    }
    if !(1..=2).contains(&config.sheets) {
        return bad("Config.sheets", format!("expected 1 or 2, found {}", config.sheets));
    }
    if let Some(Shadows::Convolution(convolution)) = config.shadow {
        convolution.check()?;
    }
    if let Some(whitewater) = &config.whitewater {
        whitewater.check()?;
    }
    if let Some(bubbles) = &config.bubbles {
        bubbles.check()?;
        if bubbles.crossfade && config.whitewater.is_none() {
            return bad("Config.bubbles.crossfade", "set, but Config.whitewater is None".into());
        }
    }
    if let Some(shore) = &config.shore {
        shore.check()?;
    }
    if let Some(level) = config.noise
        && level > 3
    {
        return bad("Config.noise", format!("expected 0 to 3, found {level}"));
    }
    if let Some(edge) = config.light_map_size
        && (!edge.is_multiple_of(16) || !(16..=4096).contains(&edge))
    {
        let why = format!("expected a multiple of 16 from 16 to 4096, found {edge}");
        return bad("Config.light_map_size", why);
    }
    let size = config.environment_size;
    if !size.is_power_of_two() || !(16..=2048).contains(&size) {
        return bad(
            "Config.environment_size",
            format!("expected a power of two from 16 to 2048, found {size}"),
        );
    }
    Ok(())
}
