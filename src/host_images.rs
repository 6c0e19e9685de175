//! How the passes use the host's images, and the barriers that acquire and release each of them.

use ash::vk;

use crate::bubbles::Bubbles;
use crate::contract::{Frame, HostImage, Shadow};
use crate::gpu::Gpu;
use crate::gpu::access::{self, Access, COPY_READ, FRAGMENT_SAMPLED};
use crate::gpu::descriptors::Resource;
use crate::light::{Convolving, Light, Sunlight};

/// Layout in which the scene's depth is sampled.
pub fn depth_layout(image: &HostImage) -> vk::ImageLayout {
    if image.aspect.contains(vk::ImageAspectFlags::DEPTH) {
        vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL
    } else {
        vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL
    }
}

/// Access of the passes to the scene's depth.
pub fn depth_use(layout: vk::ImageLayout, spray: bool) -> Access {
    let sampled = access::COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED);
    // The vertex shader binds it as well, as a stand-in for the shadow resources.
    let sampled = if spray { sampled.and(access::VERTEX_SAMPLED) } else { sampled };
    Access { layout, ..sampled }
}

/// Access of the passes to the host's images.
pub struct Uses {
    /// Whether the output is also the scene's colour.
    pub in_place: bool,
    pub depth: Access,
    /// Access of `composite` to the output.
    pub output: Access,
    /// Access of `composite` to the scene's colour or its copy.
    pub scene: Access,
    /// Whether `lit` reads the scene first.
    pub lit: bool,
    /// Whether only `convolution` reads the shadow map.
    pub convolved: bool,
}

impl Uses {
    /// The first use of the output.
    pub fn output_first(&self) -> Access {
        match (self.in_place, self.lit) {
            (true, true) => Light::SCENE_USE,
            (true, false) => COPY_READ,
            (false, _) => self.output,
        }
    }

    /// The first use of the host's scene image.
    fn scene_first(&self) -> Access {
        if self.lit { Light::SCENE_USE } else { self.scene }
    }
}

/// Access of the passes to a shadow map or mask.
fn shadow_use(image: &HostImage, convolved: bool) -> Access {
    let shading = FRAGMENT_SAMPLED.and(access::VERTEX_SAMPLED);
    let sampled = access::COMPUTE_SAMPLED;
    let sampled = if convolved { sampled } else { sampled.and(shading) };
    Access { layout: depth_layout(image), ..sampled }
}

/// The host's own fluid surface.
fn fluid<'a>(frame: &'a Frame<'_>) -> Option<(&'a HostImage, Access)> {
    let image = frame.whitewater.as_ref()?.fluid_depth.as_ref()?;
    Some((image, Access { layout: depth_layout(image), ..access::COMPUTE_SAMPLED }))
}

/// The host's water surface and the mask of its contact foam.
fn shore<'a>(frame: &'a Frame<'_>) -> impl Iterator<Item = (&'a HostImage, Access)> {
    let own = frame.shore.as_ref();
    let images = own.map(|shore| [crate::shore::surface_of(shore), shore.mask.as_ref()]);
    let sampled = FRAGMENT_SAMPLED.and(access::COMPUTE_SAMPLED);
    let used = move |image| (image, Access { layout: depth_layout(image), ..sampled });
    images.into_iter().flatten().flatten().map(used)
}

/// The host's shadow map or mask.
pub fn shadow_map(shadow: &Shadow, gpu: &Gpu) -> Resource {
    let layout = depth_layout(&shadow.image);
    Resource::SampledIn(shadow.image.view, gpu.samplers.nearest, layout)
}

/// Returns the resources with which shaders compute the sun's shadows. For those that do not exist in this
/// configuration, the scene's depth and the frame's uniforms are bound and not read.
pub fn sunlight(
    frame: &Frame<'_>,
    (light, convolving, bubbles): (Option<&Light>, Option<&Convolving>, Option<&Bubbles>),
    gpu: &Gpu,
    (depth, uniforms): (Resource, Resource),
) -> Sunlight {
    let map = frame.shadow.as_ref().filter(|_| convolving.is_none());
    Sunlight {
        shadow: map.map_or(depth, |shadow| shadow_map(shadow, gpu)),
        thickness: light.map_or(depth, |light| light.thickness(gpu)),
        whitewater: light.and_then(|light| light.whitewater(gpu)).unwrap_or(depth),
        bubbles: bubbles.and_then(|bubbles| bubbles.cast(gpu)).unwrap_or(depth),
        convolved: convolving.map_or([depth, uniforms], |convolving| convolving.resources(gpu)),
    }
}

/// The other images that the host only lends for reading. If it hands in one image twice, such as the depth of its sea,
/// that image has one use.
fn others<'a>(frame: &'a Frame<'_>, uses: &Uses) -> Vec<(&'a HostImage, Access)> {
    let shadow = frame.shadow.iter().map(|shadow| &shadow.image);
    let shadow = shadow.map(|image| (image, shadow_use(image, uses.convolved)));
    let mut all: Vec<(&HostImage, Access)> = Vec::new();
    for (image, used) in shadow.chain(fluid(frame)).chain(shore(frame)) {
        match all.iter_mut().find(|(known, _)| known.image == image.image) {
            Some((_, known)) => *known = known.and(used),
            None => all.push((image, used)),
        }
    }
    all
}

/// The acquire barriers, one for each host image.
pub fn acquire(frame: &Frame<'_>, uses: &Uses) -> Vec<vk::ImageMemoryBarrier2<'static>> {
    let barrier =
        |image: &HostImage, to| access::raw_image(image.image, image.aspect, image.before, to);
    let mut all =
        vec![barrier(&frame.scene_depth, uses.depth), barrier(&frame.output, uses.output_first())];
    if !uses.in_place {
        all.push(barrier(&frame.scene_color, uses.scene_first()));
    }
    all.extend(others(frame, uses).into_iter().map(|(image, used)| barrier(image, used)));
    all
}

/// The release barriers, one for each host image.
pub fn release(frame: &Frame<'_>, uses: &Uses) -> Vec<vk::ImageMemoryBarrier2<'static>> {
    let barrier =
        |image: &HostImage, from| access::raw_image(image.image, image.aspect, from, image.after);
    let mut all =
        vec![barrier(&frame.scene_depth, uses.depth), barrier(&frame.output, uses.output)];
    if !uses.in_place {
        all.push(barrier(&frame.scene_color, uses.scene_first()));
    }
    all.extend(others(frame, uses).into_iter().map(|(image, used)| barrier(image, used)));
    all
}
