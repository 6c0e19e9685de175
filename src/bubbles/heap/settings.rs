//! Settings of the blob simulation: motion, collisions, capacity. Lengths are in scene units, times in seconds; the
//! defaults are for scene units of one metre.

use bytemuck::{Pod, Zeroable};

use crate::contract::Slot;
use crate::error::Error;
use crate::water::settings::{GREATEST, range};

crate::contract::with!(BlobSimulationConfig, BlobSimulationSettings, BlobSimulationStep<'_>);

/// Max number of substeps per step.
const MOST_SUBSTEPS: u32 = 64;

/// How blobs move. Lengths are in scene units. Made by `default()`, whose units are metres, then, for other units,
/// [`in_units`](Self::in_units), then, unless +y is up, [`with_gravity`](Self::with_gravity).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BlobSimulationSettings {
    /// Gravity, scene units per second squared, each component [-1e4, 1e4], default (0, −9.81, 0).
    pub gravity: [f32; 3],
    /// Linear air drag, 1/s, [0, 100], default 0.8.
    pub drag: f32,
    /// Distance between the centres of two blobs at which they neither attract nor repel each other, relative to the
    /// sum of their radii, (0, 1], default 0.75: blobs at rest overlap.
    pub rest: f32,
    /// Distance between the centres of two blobs below which they attract each other, relative to the sum of their
    /// radii, (rest, 1.2], default 0.95. Below `rest` they repel each other.
    pub reach: f32,
    /// Repulsion of two blobs, 1/s², (0, 100 000], default 4000. The acceleration of blobs of equal size is this
    /// value times the length by which their centres are nearer to each other than the distance [`rest`](Self::rest).
    pub stiffness: f32,
    /// Maximum attraction of two blobs, scene units per second squared, [0, 100 000], default 12.
    pub cohesion: f32,
    /// Damping of the relative velocity of two touching blobs along the line through their centres, 1/s, [0, 100],
    /// default 12.
    pub normal_damping: f32,
    /// Damping of the relative velocity of two touching blobs perpendicular to the line through their centres, 1/s,
    /// [0, 100], default 6.
    pub tangential_damping: f32,
    /// Distance of a blob's centre from a solid below which the solid repels the blob, in radii of the blob, (0, 1],
    /// default 0.85: a blob at rest overlaps the solid, like foam that adheres to it.
    pub contact: f32,
    /// Repulsion of a blob by a solid, 1/s², (0, 100 000], default 20 000. The acceleration is this value times the
    /// length by which the blob's centre is nearer to the solid than the distance [`contact`](Self::contact).
    pub solidity: f32,
    /// Damping of the velocity along a solid's normal, 1/s, [0, 200], default 60.
    pub solid_damping: f32,
    /// Coefficient of friction on solids, [0, 10], default 0.35.
    pub friction: f32,
    /// Height of the level water surface that blobs float on, scene units, measured from the origin against gravity.
    /// Default `None`: no water.
    pub water: Option<f32>,
    /// Density of the foam relative to water, [0.01, 10], default 0.2.
    pub density: f32,
    /// A blob splits in two halves if the total volume of the blobs that it touches is less than this factor times
    /// its own volume, [0, 100], default 2.5. By repeated splits, a blob that was torn off thus becomes a clump of
    /// four or more. Needs [`BlobSimulationConfig::max_splits`] above 0.
    pub split_support: f32,
    /// Time that a blob must have touched too few others (`split_support`) before it splits, seconds, [0, 10],
    /// default 0.1.
    pub split_delay: f32,
    /// Duration of a split, seconds, [0.01, 10], default 0.5. In this time the blob shrinks to half its volume, and a
    /// second blob grows beside it from nothing to the other half.
    pub split_duration: f32,
    /// Number of substeps into which a step is divided, 1 to 64, default 4. The default forces are stable in substeps
    /// no longer than 1/200 s.
    pub substeps: u32,
}

impl Default for BlobSimulationSettings {
    fn default() -> Self {
        Self {
            gravity: [0.0, -9.81, 0.0],
            drag: 0.8,
            rest: 0.75,
            reach: 0.95,
            stiffness: 4000.0,
            cohesion: 12.0,
            normal_damping: 12.0,
            tangential_damping: 6.0,
            contact: 0.85,
            solidity: 20_000.0,
            solid_damping: 60.0,
            friction: 0.35,
            water: None,
            density: 0.2,
            split_support: 2.5,
            split_delay: 0.1,
            split_duration: 0.5,
            substeps: 4,
        }
    }
}

impl BlobSimulationSettings {
    /// Converts these settings from metres to scene units: multiplies gravity, cohesion and the height of the water by
    /// `units_per_metre`, the number of scene units per metre.
    #[must_use]
    pub fn in_units(self, units_per_metre: f32) -> Self {
        Self {
            gravity: self.gravity.map(|v| v * units_per_metre),
            cohesion: self.cohesion * units_per_metre,
            water: self.water.map(|height| height * units_per_metre),
            ..self
        }
    }

    /// These settings with the earth's gravity, for a number of scene units per metre and an up direction of unit
    /// length. Only gravity is replaced, so call [`in_units`](Self::in_units) before, which scales the other lengths;
    /// called after, it would scale gravity again.
    #[must_use]
    pub fn with_gravity(self, units_per_metre: f32, up: [f32; 3]) -> Self {
        Self { gravity: up.map(|v| -9.81 * units_per_metre * v), ..self }
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        for part in self.gravity {
            range("BlobSimulationSettings.gravity", part, -1.0e4, 1.0e4)?;
        }
        range("BlobSimulationSettings.drag", self.drag, 0.0, 100.0)?;
        range("BlobSimulationSettings.rest", self.rest, 1.0e-3, 1.0)?;
        range("BlobSimulationSettings.reach", self.reach, self.rest + 1.0e-3, 1.2)?;
        range("BlobSimulationSettings.stiffness", self.stiffness, 1.0e-3, 1.0e5)?;
        range("BlobSimulationSettings.cohesion", self.cohesion, 0.0, 1.0e5)?;
        range("BlobSimulationSettings.normal_damping", self.normal_damping, 0.0, 100.0)?;
        range("BlobSimulationSettings.tangential_damping", self.tangential_damping, 0.0, 100.0)?;
        range("BlobSimulationSettings.contact", self.contact, 1.0e-3, 1.0)?;
        range("BlobSimulationSettings.solidity", self.solidity, 1.0e-3, 1.0e5)?;
        range("BlobSimulationSettings.solid_damping", self.solid_damping, 0.0, 200.0)?;
        range("BlobSimulationSettings.friction", self.friction, 0.0, 10.0)?;
        range("BlobSimulationSettings.water", self.water.unwrap_or(0.0), -1.0e9, 1.0e9)?;
        range("BlobSimulationSettings.density", self.density, 0.01, 10.0)?;
        range("BlobSimulationSettings.split_support", self.split_support, 0.0, 100.0)?;
        range("BlobSimulationSettings.split_delay", self.split_delay, 0.0, 10.0)?;
        range("BlobSimulationSettings.split_duration", self.split_duration, 0.01, 10.0)?;
        if !(1..=MOST_SUBSTEPS).contains(&self.substeps) {
            let why = format!("expected 1 to {MOST_SUBSTEPS}, found {}", self.substeps);
            return Err(Error::bad("BlobSimulationSettings.substeps", why));
        }
        Ok(())
    }
}

/// A solid that blobs collide with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// A half space: everything behind a plane, `normal · x < distance`.
    Plane {
        /// Normal, of unit length.
        normal: [f32; 3],
        /// Distance of the plane from the origin along the normal, scene units, [-1e12, 1e12].
        distance: f32,
    },
    /// An oriented box.
    Box {
        /// Centre, scene units, each component [-1e12, 1e12].
        center: [f32; 3],
        /// Half-extents, scene units, each [0, 1e12].
        half_extents: [f32; 3],
        /// Orientation: a unit quaternion, the real part last.
        rotation: [f32; 4],
    },
}

/// A solid as the shader reads it (glsl/include/solid.glsl).
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct GpuSolid {
    place: [f32; 4],
    size: [f32; 4],
    turn: [f32; 4],
}

impl Solid {
    pub(super) fn check(&self) -> Result<(), Error> {
        // Beyond this, squares and products in the shader may overflow. Comparisons with NaN are false.
        let near = |all: &[f32]| all.iter().all(|v| v.abs() <= GREATEST);
        let unit = |all: &[f32]| (all.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1.0e-3;
        let good = match self {
            Self::Plane { normal, distance } => unit(normal) && near(&[*distance]),
            Self::Box { center, half_extents: half, rotation: turn } => {
                near(center) && near(half) && half.iter().all(|v| *v >= 0.0) && unit(turn)
            }
        };
        if good {
            return Ok(());
        }
        let why = format!(
            "expected numbers within ±1e12, half-extents of at least 0, and a unit normal or rotation, found {self:?}"
        );
        Err(Error::bad("BlobSimulationStep.solids", why))
    }

    pub(super) fn on_gpu(self) -> GpuSolid {
        match self {
            Self::Plane { normal: [x, y, z], distance } => GpuSolid {
                place: [x, y, z, 0.0],
                size: [0.0, 0.0, 0.0, distance],
                turn: [0.0, 0.0, 0.0, 1.0],
            },
            Self::Box { center: [x, y, z], half_extents: [a, b, c], rotation: turn } => {
                GpuSolid { place: [x, y, z, 1.0], size: [a, b, c, 0.0], turn }
            }
        }
    }
}

/// Configuration of a [`BlobSimulation`](super::BlobSimulation). It determines how much memory is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BlobSimulationConfig {
    /// Maximum number of blobs, 1 to 2^20.
    pub max_blobs: u32,
    /// Maximum number of solids per step, default 64.
    pub max_solids: u32,
    /// Maximum number of generations of splits, 0 to 6, default 0. In each generation a blob can split into two
    /// ([`BlobSimulationSettings::split_support`]), so one blob becomes at most 2^`max_splits`. Memory is allocated for
    /// `max_blobs` × 2^`max_splits` blobs; this product must be at most 2^20.
    pub max_splits: u32,
}

impl BlobSimulationConfig {
    /// The defaults for a maximum number of blobs.
    pub fn new(max_blobs: u32) -> Self {
        Self { max_blobs, max_solids: 64, max_splits: 0 }
    }
}

/// One step of the simulation.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct BlobSimulationStep<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// Duration in seconds, [0, 1].
    pub dt: f32,
    /// Uniform settings.
    pub settings: &'a BlobSimulationSettings,
    /// Solids, in their state at the end of the step.
    pub solids: &'a [Solid],
}

impl<'a> BlobSimulationStep<'a> {
    /// A step of this many seconds, without solids.
    pub fn new(slot: Slot, dt: f32, settings: &'a BlobSimulationSettings) -> Self {
        Self { slot, dt, settings, solids: &[] }
    }

    /// The step with these solids, in their state at its end.
    #[must_use]
    pub fn with_solids(self, solids: &'a [Solid]) -> Self {
        Self { solids, ..self }
    }
}
