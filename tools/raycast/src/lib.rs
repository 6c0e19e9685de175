//! Volume ray-casters of emission and absorption, as *Screen Space Foam Rendering* (Akinci et al. 2013, Sec. 3,
//! Table 1, Fig. 8) compares itself with, for the same comparison with `whitewater`'s foam:
//!
//! - [`Method::Kernel`], the paper's first: at each sample of a ray the kernels of nearby particles are summed
//!   (Ihmsen, Akinci, Akinci, Teschner, Unified spray, foam and bubbles for particle-based fluids, 2012), which
//!   a grid of cells finds (counting sort);
//! - [`Method::Grid`], its second: particles are splatted with integer atomics to a view-aligned perspective
//!   voxel grid, which rays march through (Fraedrich, Auer, Westermann, Efficient high-quality volume rendering
//!   of SPH data, 2010);
//! - [`Method::Plain`], the first one in its straightforward form: particles are sorted into a grid in space,
//!   and at each sample the cells around it are searched. The first two are faster because they use
//!   screen-space lists, which the paper does not mention.
//!
//! All run on the GPU and are optimised as far as the authors know how, to be fair. A ray ends at the scene, or
//! where nothing behind can change its pixel by half a step of 8 bits. Steps grow with the distance where
//! particles are smaller than a pixel. Cells and bricks of the first two are screen tiles times depth slabs, so
//! that a group of rays visits the same ones; in each tile they extend from the first particle to the last or
//! to the scene, and voxels exist only in bricks with particles. Cells of the third are a few kernels wide, and
//! its rays march through the bounding box of all particles, so empty space costs as much as full. Buffer sizes
//! are measured before the timed frames ([`Caster::new`]). If they exceed a device's storage buffers, particles
//! are processed in chunks.
//!
//! # What is drawn
//! The optical thickness ρ of a pixel's ray, and of that the intensity ι = ρ^e / (m + ρ^e) (Sec. 2.3), white: what
//! `whitewater` draws as its layer `whitewater.intensity`, whose ρ is the sum of the particles' sprites. Particles therefore have
//! their sprites' radius, life and widening (Sec. 2.1, 2.2), and each is a ball whose kernel's integral along a ray is the
//! thickness F(x) of the sprite at x radii from its centre. Balls face the camera as sprites do: distances across the view
//! are measured at the depth of the centre. The kernels are then the only difference, and at a fine step the pictures agree
//! up to that.
//!
//! # Kernels
//! Of a kernel K(q), q radii from the centre, F(x) = 2 ∫ₓ¹ K(q) q / √(q² − x²) dq (Abel's transform). With y = 1 − q²
//! and Y = 1 − x², K = √y·yᵏ has F = B(k + 3/2, 1/2) Yᵏ⁺¹: Y π/2, Y² 3π/8, Y³ 5π/16. So of
//! F̃ = Y (A + B Y + C Y²) ([`PROFILES`]) the kernel is √y (2/π A + 8/(3π) B y + 16/(5π) C y²) ([`ABEL`]), bounded, zero
//! at the border, and cheap; the sprites' own F = 1 − xⁿ have none of elementary functions. F̃ is the one of least
//! mean square over the disc of those with the sprite's mean:
//!
//! - foam, 1 − x^2.25: within 0.0064, 0.0010 RMS;
//! - spray, 1 − x^1.5: within 0.035 (its tip), 0.0042 RMS;
//! - bubbles, x² inside the disc: its own kernel, (2q² − 1) / (π √(1 − q²)), is less than nothing in the middle and
//!   endless at the border. Nearest of those that are never less than nothing is √y (1 − y / 0.74)², a hollow ball:
//!   0.32 RMS, of the same mean.
//!
//! # Order
//! The rays' midpoint rule meets the kernels' ends, which are roots: its error falls with the step to the power of
//! 3/2 (`tests/casters.rs`).

mod balls;
mod cells;
mod grid;
mod kernel;
mod plain;
mod scan;
mod vulkan;

use glam::{Mat4, Vec4};
use whitewater::headless::{Device, Picture};
use whitewater::{Camera, Error, Timing};
/// Whitewater particles; other kinds than foam, spray and bubbles are foam, those of NaN, infinite or past ages are not drawn.
pub use whitewater_seas::Foam;

use balls::Balls;
use vulkan::Buffer;

/// Coefficients A, B, C of a sprite's thickness Y (A + B Y + C Y²), Y = 1 − x² at x radii from its middle, by kind: 0 foam,
/// 1 spray, 2 bubble.
pub const PROFILES: [[f64; 3]; 3] = [
    [1.11000391, 0.00375636, -0.10736924],
    [0.80382775, -0.16404648, 0.32535885],
    [4.55953372, -9.24229808, 5.20399667],
];

/// Factors from the coefficients of the thickness to those of the kernel: 2/π, 8/(3π), 16/(5π).
pub const ABEL: [f64; 3] = [
    2.0 / std::f64::consts::PI,
    8.0 / (3.0 * std::f64::consts::PI),
    16.0 / (5.0 * std::f64::consts::PI),
];

/// Least half-axis of a sprite in pixels, the same as `whitewater`'s.
pub const LEAST_REACH: f32 = 0.75;

/// Most pixels of a picture: one invocation each, in one dispatch of groups of 64.
const MOST_PIXELS: u64 = 64 * 65_535;

/// Eye depth of a pixel without scene.
pub const EMPTY: f32 = 1.0e10;

/// The opaque scene that ends the rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SceneDepth {
    /// No scene.
    #[default]
    Nothing,
    /// Positive eye depth of each pixel, row 0 on top; [`EMPTY`] where there is no scene.
    Depths(Vec<f32>),
}

impl SceneDepth {
    /// Converts a depth image, as a depth buffer stores it, to eye depths.
    ///
    /// # Errors
    /// The camera is not a perspective one.
    pub fn of_device(camera: &Camera, depths: &[f32]) -> Result<Self, Error> {
        let lens = Lens::new(camera)?;
        let eye = |device: &f32| {
            let depth = lens.linear[0] / (device + lens.linear[1]);
            // Reversed infinite depth at infinity: 1/0, or negative by rounding.
            if depth > 0.0 { depth.min(EMPTY) } else { EMPTY }
        };
        Ok(Self::Depths(depths.iter().map(eye).collect()))
    }
}

/// Sampling of rays, and the parameters of the intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Distance between a ray's samples in particle radii, [1/256, 64], default 1/2. The unit is the default radius, or
    /// the least drawn radius ([`LEAST_REACH`] pixels) where that is larger.
    pub step: f32,
    /// Samples are shifted from pixel to pixel by a pattern of 4 × 4 instead of lying side by side; default true.
    pub shifted: bool,
    /// m of the intensity ρ^e / (m + ρ^e), [1e-6, 1e6], default 3.
    pub half: f32,
    /// Exponent e of the intensity, [0.1, 16], default 1.25.
    pub exponent: f32,
    /// Intensity at which a ray ends, [1e-6, 1]; default 1 − 1/512, half a step of 8 bits.
    pub opaque: f32,
    /// Edge of a tile in pixels, 4, 8 or 16; for [`Method::Plain`] the edge of a group of rays. `None` takes the
    /// fastest measured value.
    pub tile: Option<u32>,
    /// Edge of a cell of [`Method::Plain`] in radii of the largest ball that may lie in it, [1, 16]. At 1 a cell is as
    /// wide as a kernel's reach, and 27 cells are searched. `None` takes the fastest measured value.
    pub cell: Option<f32>,
    /// Most particles that are processed together, at least 1; `None`: as many as fit on the device.
    pub chunk: Option<u32>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            step: 0.5,
            shifted: true,
            half: 3.0,
            exponent: 1.25,
            opaque: 1.0 - 1.0 / 512.0,
            tile: None,
            cell: None,
            chunk: None,
        }
    }
}

impl Settings {
    fn check(&self) -> Result<(), Error> {
        let range = |field, value: f32, least: f32, most: f32| {
            if value >= least && value <= most {
                return Ok(());
            }
            Err(bad(field, format!("{value}: from {least} to {most} expected")))
        };
        range("Settings.step", self.step, 1.0 / 256.0, 64.0)?;
        range("Settings.half", self.half, 1.0e-6, 1.0e6)?;
        range("Settings.exponent", self.exponent, 0.1, 16.0)?;
        range("Settings.opaque", self.opaque, 1.0e-6, 1.0)?;
        range("Settings.cell", self.cell.unwrap_or(1.0), 1.0, 16.0)?;
        if self.chunk == Some(0) {
            return Err(bad("Settings.chunk", "0: at least 1 expected".into()));
        }
        match self.tile {
            None | Some(4 | 8 | 16) => Ok(()),
            Some(tile) => Err(bad("Settings.tile", format!("{tile}: 4, 8 or 16 expected"))),
        }
    }

    /// Optical thickness at which a ray ends.
    fn most(&self) -> f32 {
        let ratio = f64::from(self.opaque) / (1.0 - f64::from(self.opaque));
        ((f64::from(self.half) * ratio).powf(1.0 / f64::from(self.exponent)) as f32).min(f32::MAX)
    }
}

/// A ray-casting method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Sums kernels at each sample, found by screen-space lists.
    Kernel,
    /// Marches through a grid of densities.
    Grid,
    /// Sums kernels at each sample, found by a search of the surrounding cells.
    Plain,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 3] = [Self::Kernel, Self::Grid, Self::Plain];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kernel => "kernel",
            Self::Grid => "grid",
            Self::Plain => "plain",
        }
    }
}

/// Everything that a picture shows.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The particles.
    pub foam: &'a Foam,
    /// Default radius in scene units, (0, ∞). A particle's radius is this divided by `id % 5 + 1`, and half of that for
    /// a bubble.
    pub radius: f32,
    /// The view; it must be a perspective one.
    pub camera: &'a Camera,
    /// Width and height in pixels, at least 1 each, and at most 4 194 240 pixels in all.
    pub size: [u32; 2],
    /// The opaque scene that ends the rays.
    pub scene: &'a SceneDepth,
}

impl Input<'_> {
    fn check(&self) -> Result<(), Error> {
        let Foam { positions, kinds, ages, ids } = self.foam;
        if [kinds.len(), ages.len(), ids.len()].iter().any(|length| *length != positions.len()) {
            return Err(bad("Input.foam", "an attribute is not as long as positions".into()));
        }
        if !(self.radius > 0.0 && self.radius < EMPTY) {
            return Err(bad("Input.radius", format!("{}: more than 0 expected", self.radius)));
        }
        let [width, height] = self.size;
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || pixels > MOST_PIXELS {
            let why = format!("{width}x{height}: from 1 to {MOST_PIXELS} pixels expected");
            return Err(bad("Input.size", why));
        }
        if let SceneDepth::Depths(depths) = self.scene
            && depths.len() != width as usize * height as usize
        {
            let why = format!("{} depths of {width}x{height} pixels", depths.len());
            return Err(bad("Input.scene", why));
        }
        Ok(())
    }

    /// Eye depth of the scene in each pixel.
    fn depths(&self) -> Vec<f32> {
        let [width, height] = self.size;
        match self.scene {
            SceneDepth::Nothing => vec![EMPTY; width as usize * height as usize],
            SceneDepth::Depths(depths) => depths.clone(),
        }
    }
}

fn bad(field: &'static str, why: String) -> Error {
    Error::BadInput { field, why }
}

/// Components of a perspective camera.
struct Lens {
    /// Transform from world space to an eye space that looks down −z.
    view: Mat4,
    /// P₀₀, P₁₁, P₂₀, P₂₁: ndc = P₀₀₁₁ · slope − P₂₀₂₁.
    p: Vec4,
    /// Device depth z to eye depth: a / (z + b).
    linear: [f32; 2],
    near: f32,
}

impl Lens {
    fn new(camera: &Camera) -> Result<Self, Error> {
        let field = "Input.camera";
        let m = camera.projection_matrix().to_cols_array_2d();
        if !camera.view_matrix().is_finite() || !camera.projection_matrix().is_finite() {
            return Err(bad(field, "not finite".into()));
        }
        // m[column][row]; w = m[2][3] z + m[3][3].
        if m[2][3].abs() < 0.5 {
            return Err(bad(field, "only perspective projections are supported".into()));
        }
        let mirror = if m[2][3] < 0.0 { 1.0 } else { -1.0 };
        let scale = 1.0 / m[2][3].abs();
        let linear = [m[3][2] * scale, mirror * m[2][2] * scale];
        let p = Vec4::new(m[0][0], m[1][1], mirror * m[2][0], mirror * m[2][1]) * scale;
        if p.x.abs() < 1e-6 || p.y.abs() < 1e-6 || linear[0].abs() < 1e-12 {
            return Err(bad(field, "a singular projection".into()));
        }
        let at = |z: f32| {
            let depth = linear[0] / (z + linear[1]);
            if depth.is_finite() && depth > 0.0 { depth } else { f32::INFINITY }
        };
        let near = at(0.0).min(at(1.0));
        let view = Mat4::from_diagonal(Vec4::new(1.0, 1.0, mirror, 1.0)) * camera.view_matrix();
        Ok(Self { view, p, linear, near })
    }

    /// Scale and offset from pixels to slopes.
    fn slope(&self, [width, height]: [u32; 2]) -> Vec4 {
        let p = self.p;
        Vec4::new(
            2.0 / (width as f32 * p.x),
            2.0 / (height as f32 * p.y),
            (p.z - 1.0) / p.x,
            (p.w - 1.0) / p.y,
        )
    }
}

/// A ray-caster, ready to draw one picture any number of times.
pub struct Caster<'d> {
    way: Way<'d>,
}

enum Way<'d> {
    Kernel(kernel::Kernel<'d>),
    Grid(grid::Grid<'d>),
    Plain(plain::Plain<'d>),
}

impl<'d> Caster<'d> {
    /// Uploads the particles and allocates buffers for this view. It counts on the GPU how large they must be, and
    /// waits for that.
    ///
    /// # Errors
    /// The input is bad, the step is too fine for the device's memory, or Vulkan fails.
    pub fn new(
        device: &'d Device,
        method: Method,
        input: &Input<'_>,
        settings: &Settings,
    ) -> Result<Self, Error> {
        input.check()?;
        settings.check()?;
        let way = match method {
            Method::Kernel => Way::Kernel(kernel::Kernel::new(device, input, settings)?),
            Method::Grid => Way::Grid(grid::Grid::new(device, input, settings)?),
            Method::Plain => Way::Plain(plain::Plain::new(device, input, settings)?),
        };
        Ok(Self { way })
    }

    fn balls(&self) -> &Balls<'d> {
        match &self.way {
            Way::Kernel(kernel) => &kernel.cells.balls,
            Way::Grid(grid) => &grid.cells.balls,
            Way::Plain(plain) => &plain.balls,
        }
    }

    /// Draws and waits. Returns the time of each pass, in their order, once per chunk of particles.
    ///
    /// # Errors
    /// Vulkan fails.
    pub fn draw(&self) -> Result<Vec<Timing>, Error> {
        let balls = self.balls();
        balls.queue.run(|frame| {
            balls.record_begin(frame);
            for chunk in &balls.chunks {
                match &self.way {
                    Way::Kernel(kernel) => kernel.record(frame, chunk)?,
                    Way::Grid(grid) => grid.record(frame, chunk)?,
                    Way::Plain(plain) => plain.record(frame, chunk)?,
                }
            }
            balls.record_end(frame)
        })
    }

    fn picture(&self, buffer: &Buffer<'_>) -> Result<Picture<f32>, Error> {
        let balls = self.balls();
        let [width, height] = balls.size.map(|n| n as usize);
        let words = balls.queue.read(buffer, 0, width * height)?;
        let data = words.into_iter().map(f32::from_bits).collect();
        Ok(Picture { width, height, data })
    }

    /// Reads back the optical thickness of the last picture.
    ///
    /// # Errors
    /// Vulkan fails.
    pub fn thickness(&self) -> Result<Picture<f32>, Error> {
        self.picture(&self.balls().thickness)
    }

    /// Reads back the intensity of the last picture, 0 to 1.
    ///
    /// # Errors
    /// Vulkan fails.
    pub fn intensity(&self) -> Result<Picture<f32>, Error> {
        self.picture(&self.balls().intensity)
    }

    /// Bytes of device memory, the particles included.
    pub fn memory(&self) -> u64 {
        match &self.way {
            Way::Kernel(kernel) => kernel.memory(),
            Way::Grid(grid) => grid.memory(),
            Way::Plain(plain) => plain.memory(),
        }
    }

    /// Number of chunks that the particles are processed in.
    pub fn chunk_count(&self) -> usize {
        self.balls().chunks.len()
    }
}
