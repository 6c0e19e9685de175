//! Pass `convolution`: converts the host's shadow map to filtered images of a Fourier basis. Shaders that compare a
//! depth of their own with the map reconstruct the filtered result of the comparison from these images (Annen,
//! Mertens, Bekaert, Seidel, Kautz, *Convolution Shadow Maps*, EGSR 2007; the thesis' shadows, Sec. 4.9.4).
//!
//! Differences from that paper, and their reasons:
//! - Depths are normalised between the nearest and the farthest texel of the map, which the GPU finds. So any
//!   projection works, infinite ones too, and the transition from light to shadow is as short as the scene's depth
//!   range allows. Empty texels count as behind everything. The series is periodic, so the normalised depths keep
//!   margins to the ends of its period.
//! - The k-th of M terms is damped by exp(−α((k − ½)/M)²), where the paper has k in place of k − ½. This convolves
//!   the step with a Gaussian, so it keeps its height with few terms.
//! - The reconstructed result is steepened around one half, and clipped to 0 to 1, which hides ringing. It is shifted
//!   by a part of its rise (`ShadowFilter::offset`), so that a point that touches its occluder stays lit.
//! - The map is averaged to the size of the library's images first, then box-filtered: no mips.
//! - The pages of the basis, with two terms each, lie side by side in one image, not in an array, so that any other
//!   image can be bound in its place if the pass is off.
//!
//! Reads: the host's shadow map. Writes: min and max of its depths; the basis, RGBA8 signed or RGBA16F, with cosine
//! and sine of two terms per page, in two rows of pages that have a border of one texel.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use crate::contract::{Config, Frame, Layer, Shadow};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ, COPY_WRITE,
    FRAGMENT_SAMPLED, UNIFORM, VERTEX_SAMPLED, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Resource, bind_set};
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::Recording;
use crate::water::settings::{ShadowFilter, Shadows};

/// Side length, in texels of the shadow map, of the block that a workgroup reads when the pass finds the depth range.
const SPAN_BLOCK: u32 = 128;
/// Size in bytes of the buffer `span`, which holds the least and the greatest depth of the host's shadow map.
const SPAN: u64 = 16;
/// Format of a page (the image of two Fourier terms) before filtering, and after filtering along one axis. Every
/// device can store and sample this format.
const PAGE: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// Access by shading passes, and by the vertex shader of spray.
const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED).and(VERTEX_SAMPLED);
/// Last uses of the image `basis` in a frame, for which the next frame waits before it writes the image: sampling by
/// shading passes ([`AFTER`]), or a copy by the host.
const BEFORE: Access = AFTER.and(COPY_READ);

/// Configuration of convolution shadow maps ([`Shadows::Convolution`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Convolution {
    /// Number of terms of the Fourier series: 4, 8 or 16 (default). With the default [`ShadowFilter`], a point is fully
    /// in shadow if it lies behind its occluder by at least 23 % of the map's depth range (from its nearest to its
    /// farthest texel) with 4 terms, 9 % with 8, or 4 % with 16.
    pub terms: u32,
    /// Maximum side length of the filtered images in texels, 16 to 4096 (default 1024). A larger shadow map is
    /// reduced by averaging blocks of its texels. The size of the shadow map may change from frame to frame.
    pub texels: u32,
    /// Bits per value: 8 (default) or 16, which changes the picture by a few thousandths. The images take
    /// 2·`terms`·`bits`/8 + 16 bytes for each of `texels`² texels.
    pub bits: u32,
}

impl Default for Convolution {
    fn default() -> Self {
        Self { terms: 16, texels: 1024, bits: 8 }
    }
}

impl Convolution {
    /// Validates the configuration.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let Self { terms, texels, bits } = *self;
        let bad = |why: String| Err(Error::bad("Config.shadow", why));
        if ![4, 8, 16].contains(&terms) {
            return bad(format!("expected 4, 8 or 16 terms, found {terms}"));
        }
        if !(16..=4096).contains(&texels) {
            return bad(format!("expected 16 to 4096 texels, found {texels}"));
        }
        if ![8, 16].contains(&bits) {
            return bad(format!("expected 8 or 16 bits, found {bits}"));
        }
        Ok(())
    }

    /// Format of the basis.
    pub(crate) fn format(&self) -> vk::Format {
        match self.bits {
            8 => vk::Format::R8G8B8A8_SNORM,
            _ => vk::Format::R16G16B16A16_SFLOAT,
        }
    }

    /// Side length of a page in texels.
    fn page(&self) -> u32 {
        self.texels + 2
    }

    /// Size of the image that holds all pages.
    pub(crate) fn extent(&self) -> vk::Extent2D {
        vk::Extent2D { width: self.terms / 4 * self.page(), height: 2 * self.page() }
    }

    /// Returns how many texels of the shadow map a texel of the filtered image covers along each axis, and the size
    /// of the filtered image.
    fn size(&self, map: vk::Extent2D) -> (u32, vk::Extent2D) {
        let edge = map.width.max(map.height).div_ceil(self.texels).max(1);
        let (width, height) = (map.width.div_ceil(edge), map.height.div_ceil(edge));
        (edge, vk::Extent2D { width, height })
    }
}

/// The configuration of the pass, if it is enabled.
pub fn convolution(config: &Config) -> Option<Convolution> {
    match config.shadow {
        Some(Shadows::Convolution(convolution)) => Some(convolution),
        _ => None,
    }
}

/// Values of a frame (glsl/include/frame.glsl).
#[derive(Clone, Copy, Default)]
pub struct Convolved {
    pub linear: [f32; 4],
    pub basis: [f32; 4],
    pub filter: [f32; 4],
    pub weight: [[f32; 4]; 4],
}

impl Convolved {
    /// `None` if the pass is disabled.
    pub fn new(frame: &Frame<'_>, config: &Config) -> Option<Self> {
        let (convolution, shadow) = (convolution(config)?, frame.shadow.as_ref()?);
        let settings = &frame.settings.shadow;
        let (edge, size) = convolution.size(shadow.image.rect.extent);
        let ramp = ramp(convolution.terms, settings);
        let mut weight = [[0.0; 4]; 4];
        for (i, w) in weights(convolution.terms, settings).enumerate() {
            weight[i / 4][i % 4] = settings.scale * w;
        }
        // A box filter narrower than one of our texels has no effect.
        let reach = (0.5 * settings.width / edge as f32).max(0.5);
        Some(Self {
            linear: linear(shadow, shadow.nearer(&frame.settings.light)),
            basis: [size.width as f32, size.height as f32, edge as f32, convolution.page() as f32],
            filter: [reach, settings.scale, settings.offset * ramp, ramp],
            weight,
        })
    }
}

/// 2 a_k / c_k, c_k = (2k − 1)π.
fn weights(terms: u32, settings: &ShadowFilter) -> impl Iterator<Item = f32> + use<> {
    let damping = settings.damping;
    (0..terms).map(move |i| {
        let half = i as f32 + 0.5;
        let part = half / terms as f32;
        (-damping * part * part).exp() / (std::f32::consts::PI * half)
    })
}

/// Half the width of the ramp by which the Fourier series replaces the step from shadow to light, in normalised
/// depths: the distance from the step at which the series, steepened by `settings.scale`, first reaches 1, or that of
/// its first maximum if it does not reach 1.
fn ramp(terms: u32, settings: &ShadowFilter) -> f32 {
    const STEPS: u32 = 256;
    // The first maximum is not beyond this, for every damping in range.
    let most = 0.85 / terms as f32;
    let mut before = 0.0;
    for step in 1..=STEPS {
        let t = most * step as f32 / STEPS as f32;
        let rise: f32 = weights(terms, settings)
            .enumerate()
            .map(|(i, w)| w * ((2 * i + 1) as f32 * std::f32::consts::PI * t).sin())
            .sum();
        if settings.scale * rise >= 0.5 || rise < before {
            return t;
        }
        before = rise;
    }
    most
}

/// Coefficients a, b, c, d of (a z + b) / (c z + d), which maps the map's device depth z to a depth that is linear
/// along the light and increases away from it. For a perspective projection the result is linear in the distance
/// along its axis. For a parallel projection, or one whose depth also depends on the position in the map, it is z or,
/// with reversed depth, −z.
fn linear(shadow: &Shadow, nearer: f32) -> [f32; 4] {
    let clip = shadow.clip();
    let (z, w) = (clip.row(2), clip.row(3));
    let (towards, across) = (z.truncate(), w.truncate());
    let even = [nearer, 0.0, 0.0, 1.0];
    if across.length() <= 1.0e-7 * w.w.abs() {
        return even;
    }
    // z/w = from + by/w.
    let from = towards.dot(across) / across.length_squared();
    let by = z.w - from * w.w;
    let rest = (towards - from * across).length();
    if rest > 1.0e-4 * towards.length() + 1.0e-6 * across.length() || by == 0.0 {
        return even;
    }
    [0.0, by, 1.0, -from]
}

/// The pass.
pub struct Convolving {
    find: Pipeline,
    make: Pipeline,
    across: Pipeline,
    down: Pipeline,
    span: Buffer,
    /// One page, and the page filtered along x.
    page: [Image; 2],
    basis: Image,
    pages: u32,
}

impl Convolving {
    pub fn new(gpu: &Gpu, convolution: &Convolution) -> Result<Self, Error> {
        let image = |name, extent, format, more| {
            let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED | more;
            Image::new(gpu, &ImageDesc::new(name, extent, format, usage))
        };
        let texels = convolution.texels;
        let one = vk::Extent2D { width: texels, height: texels };
        let copied = vk::ImageUsageFlags::TRANSFER_SRC;
        Ok(Self {
            find: Pipeline::compute(gpu, shader::LIGHT_CONVOLUTION_SPAN_COMP, &[])?,
            make: Pipeline::compute(gpu, shader::LIGHT_CONVOLUTION_COMP, &[])?,
            across: Pipeline::compute(gpu, shader::LIGHT_CONVOLUTION_ACROSS_COMP, &[])?,
            down: Pipeline::compute(gpu, shader::LIGHT_CONVOLUTION_DOWN_COMP, &[])?,
            span: Buffer::new(
                gpu,
                "convolution/span",
                SPAN,
                vk::BufferUsageFlags::STORAGE_BUFFER
                    | vk::BufferUsageFlags::UNIFORM_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_DST,
                MemoryLocation::GpuOnly,
            )?,
            page: [
                image("convolution/page", one, PAGE, vk::ImageUsageFlags::empty())?,
                image("convolution/across", one, PAGE, vk::ImageUsageFlags::empty())?,
            ],
            basis: image("convolution", convolution.extent(), convolution.format(), copied)?,
            pages: convolution.terms / 2,
        })
    }

    /// Basis and span, as glsl/include/sunlight.glsl reads them.
    pub fn resources(&self, gpu: &Gpu) -> [Resource; 2] {
        [Resource::Sampled(self.basis.view, gpu.samplers.linear), self.span()]
    }

    fn span(&self) -> Resource {
        Resource::Buffer(self.span.handle, 0, SPAN)
    }

    /// `shadow` is the host's map, `map` its resource for compute shaders.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        convolution: &Convolution,
        shadow: &Shadow,
        map: Resource,
    ) -> Result<(), Error> {
        let scope = r.begin(c"convolution");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let span = self.span.handle;
        let extent = shadow.image.rect.extent;
        gpu.barriers(cmd, &[], &[buffer(span, UNIFORM, COPY_WRITE)]);
        // SAFETY: outside a render pass; the frame before has read it (barrier).
        unsafe { gpu.device.cmd_fill_buffer(cmd, span, 0, vk::WHOLE_SIZE, u32::MAX) };
        gpu.barriers(cmd, &[], &[buffer(span, COPY_WRITE, COMPUTE_READ_WRITE)]);
        let resources = [(0, r.uniforms), (1, map), (2, self.span())];
        r.descriptors.bind(gpu, cmd, &self.find, &resources)?;
        r.dispatch_over(extent, [SPAN_BLOCK, SPAN_BLOCK, 1]);
        let before = BEFORE.discarded();
        gpu.barriers(
            cmd,
            &[access::image(&self.basis, before, COMPUTE_WRITE)],
            &[buffer(span, COMPUTE_READ_WRITE, UNIFORM)],
        );

        let [page, across] = &self.page;
        let sampled = |image: &Image| Resource::Sampled(image.view, gpu.samplers.nearest);
        let set =
            |pipeline, resources: &[(u32, Resource)]| r.descriptors.set(gpu, pipeline, resources);
        let stored = Resource::storage;
        let made =
            set(&self.make, &[(0, r.uniforms), (1, map), (2, self.span()), (3, stored(page))])?;
        let moved = set(&self.across, &[(0, r.uniforms), (1, sampled(page)), (2, stored(across))])?;
        let kept =
            set(&self.down, &[(0, r.uniforms), (1, sampled(across)), (2, stored(&self.basis))])?;
        let (_, size) = convolution.size(extent);
        let bordered = vk::Extent2D { width: size.width + 2, height: size.height + 2 };
        let bind = |pipeline: &Pipeline, set| {
            pipeline.bind(gpu, cmd);
            bind_set(gpu, cmd, pipeline, set);
        };
        let begin = |image| access::image(image, COMPUTE_SAMPLED.discarded(), COMPUTE_WRITE);
        let end = |image| access::image(image, COMPUTE_WRITE, COMPUTE_SAMPLED);
        for index in 0..self.pages as i32 {
            gpu.barriers(cmd, &[begin(page)], &[]);
            bind(&self.make, made);
            self.make.push(gpu, cmd, &index);
            r.dispatch_over(size, self.make.local_size);
            gpu.barriers(cmd, &[end(page), begin(across)], &[]);
            bind(&self.across, moved);
            r.dispatch_over(size, self.across.local_size);
            // Pages are separate, but a validation layer tracks only whole images.
            let next = access::image(&self.basis, COMPUTE_WRITE, COMPUTE_WRITE);
            gpu.barriers(cmd, &[end(across), next], &[]);
            bind(&self.down, kept);
            self.down.push(gpu, cmd, &index);
            r.dispatch_over(bordered, self.down.local_size);
        }
        gpu.barriers(cmd, &[access::image(&self.basis, COMPUTE_WRITE, AFTER)], &[]);
        r.end(scope);
        Ok(())
    }

    /// Layer for the host.
    pub fn layer(&self) -> Layer {
        let Image { handle: image, view, format, extent, .. } = self.basis;
        Layer { name: "light.shadow", image, view, format, extent, access: AFTER }
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        (self.basis.size + self.page.iter().map(|image| image.size).sum::<u64>(), self.span.size)
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec3};

    use super::*;

    fn rise(terms: u32, settings: &ShadowFilter, t: f32) -> f32 {
        let wave = |i: usize| ((2 * i + 1) as f32 * std::f32::consts::PI * t).sin();
        let sum: f32 = weights(terms, settings).enumerate().map(|(i, w)| w * wave(i)).sum();
        0.5 + settings.scale * sum
    }

    /// With the default settings the reconstructed light is 1 at all distances from the step between r and 1 − r,
    /// where r is half the width of the ramp, and the series repeats after a distance of 2. A larger `scale` makes
    /// the ramp shorter.
    #[test]
    fn the_ramp_ends_where_the_light_is_whole() {
        for terms in [4, 8, 16] {
            let settings = ShadowFilter::default();
            let ramp = super::ramp(terms, &settings);
            assert!(ramp * (terms as f32) < 0.5, "{ramp} of {terms}");
            let mut t = ramp;
            while t < 1.0 - ramp {
                assert!(rise(terms, &settings, t) > 0.9999, "{t} of {terms}");
                t += 1.0e-3;
            }
            let steeper = ShadowFilter { scale: 3.0, ..settings };
            assert!(super::ramp(terms, &steeper) < 0.5 * ramp);
            // Even with the max damping the series reaches its ends.
            let soft = ShadowFilter { damping: 2.0, scale: 1.0, ..settings };
            let ramp = super::ramp(terms, &soft);
            assert!(4.0 * ramp < 1.0 && rise(terms, &soft, ramp) > 0.99, "{ramp} of {terms}");
        }
    }

    /// Depths of points along a light's axis are evenly spaced for every projection.
    #[test]
    fn depths_are_even_away_from_the_light() {
        let view = Mat4::look_at_rh(Vec3::new(3.0, 8.0, 2.0), Vec3::ZERO, Vec3::Y);
        let axis = Vec3::new(3.0, 8.0, 2.0).normalize();
        for (projection, nearer) in [
            (Mat4::orthographic_rh(-4.0, 3.0, -2.0, 5.0, 1.0, 20.0), 1.0),
            (Mat4::orthographic_rh(-4.0, 3.0, -2.0, 5.0, 20.0, 1.0), -1.0),
            (Mat4::perspective_rh(0.5, 1.2, 1.0, 20.0), 1.0),
            (Mat4::perspective_rh(0.5, 1.2, 20.0, 1.0), -1.0),
            (Mat4::perspective_infinite_reverse_rh(0.5, 1.2, 0.5), -1.0),
            (Mat4::perspective_infinite_rh(0.5, 1.2, 0.5), 1.0),
        ] {
            let view_projection = projection * view;
            let image = crate::contract::HostImage {
                image: vk::Image::null(),
                view: vk::ImageView::null(),
                format: vk::Format::UNDEFINED,
                aspect: vk::ImageAspectFlags::DEPTH,
                extent: vk::Extent2D::default(),
                rect: vk::Rect2D::default(),
                before: access::NOTHING,
                after: access::NOTHING,
            };
            let shadow = Shadow::new(image, view_projection.to_cols_array_2d());
            let [a, b, c, d] = linear(&shadow, nearer);
            let at = |along: f32| {
                let z = view_projection.project_point3(-along * axis).z;
                (a * z + b) / (c * z + d)
            };
            let (near, middle, far) = (at(-2.0), at(0.0), at(2.0));
            assert!(near < middle && middle < far, "{projection}");
            let uneven = (far - middle) / (middle - near) - 1.0;
            assert!(uneven.abs() < 1.0e-3, "{uneven} of {projection}");
        }
    }
}
