//! What a heap is asked for: how blobs move, what they run against, how many there are.

use bytemuck::{Pod, Zeroable};

use crate::contract::Slot;
use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(HeapConfig, HeapSettings, HeapStep<'_>);

/// Most parts of a step.
const MOST_SUBSTEPS: u32 = 64;

/// How blobs move.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HeapSettings {
    /// m/s², default (0, −9.81, 0).
    pub gravity: [f32; 3],
    /// What the air takes of their speed, 1/s, [0, 100], default 0.8.
    pub drag: f32,
    /// How far apart neighbours rest, in sums of their radii, (0, 1), default 0.75: they lie in each other.
    pub rest: f32,
    /// How near they pull each other, in sums of their radii, above `rest` to 1.2, default 0.95.
    pub reach: f32,
    /// How much they push, m/s² a metre, (0, 100 000], default 4000.
    pub stiffness: f32,
    /// How much they pull at most, m/s², [0, 1000], default 12.
    pub cohesion: f32,
    /// What two that touch take of each other's speed, along and across, 1/s, [0, 100], default 12 and 6.
    pub damping: [f32; 2],
    /// Distance at which solids begin, in radii, (0, 1], default 0.85: foam clings to what it lies on.
    pub contact: f32,
    /// How much solids push, m/s² a metre, (0, 100 000], default 20 000.
    pub solidity: f32,
    /// What solids take of the speed along their normal, 1/s, [0, 200], default 60.
    pub solid_damping: f32,
    /// Coefficient of friction on solids, [0, 10], default 0.35.
    pub friction: f32,
    /// Level of water that they float on, metres; default: none.
    pub water: Option<f32>,
    /// Density of the foam over the water's, [0.01, 10], default 0.2.
    pub density: f32,
    /// A blob splits in two where those that it touches have less than so many times its volume, [0, 100], default 2.5: one
    /// that is torn off becomes a clump of four and more. With [`HeapConfig::halvings`].
    pub support: f32,
    /// For so long, seconds, [0, 10], default 0.1.
    pub alone: f32,
    /// In which its halves part: one shrinks as the other grows out of it. Seconds, [0.01, 10], default 0.5.
    pub parting: f32,
    /// Parts of a step, 1 to 64, default 4: forces are stable to parts of 1/200 s.
    pub substeps: u32,
}

impl Default for HeapSettings {
    fn default() -> Self {
        Self {
            gravity: [0.0, -9.81, 0.0],
            drag: 0.8,
            rest: 0.75,
            reach: 0.95,
            stiffness: 4000.0,
            cohesion: 12.0,
            damping: [12.0, 6.0],
            contact: 0.85,
            solidity: 20_000.0,
            solid_damping: 60.0,
            friction: 0.35,
            water: None,
            density: 0.2,
            support: 2.5,
            alone: 0.1,
            parting: 0.5,
            substeps: 4,
        }
    }
}

impl HeapSettings {
    /// With the earth's gravity in a world of so many units a metre with a direction up, of unit length.
    #[must_use]
    pub fn with_gravity(self, units_per_metre: f32, up: [f32; 3]) -> Self {
        Self { gravity: up.map(|v| -9.81 * units_per_metre * v), ..self }
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        for part in self.gravity {
            range("HeapSettings.gravity", part, -1.0e4, 1.0e4)?;
        }
        range("HeapSettings.drag", self.drag, 0.0, 100.0)?;
        range("HeapSettings.rest", self.rest, 1.0e-3, 1.0)?;
        range("HeapSettings.reach", self.reach, self.rest + 1.0e-3, 1.2)?;
        range("HeapSettings.stiffness", self.stiffness, 1.0e-3, 1.0e5)?;
        range("HeapSettings.cohesion", self.cohesion, 0.0, 1000.0)?;
        range("HeapSettings.damping", self.damping[0], 0.0, 100.0)?;
        range("HeapSettings.damping", self.damping[1], 0.0, 100.0)?;
        range("HeapSettings.contact", self.contact, 1.0e-3, 1.0)?;
        range("HeapSettings.solidity", self.solidity, 1.0e-3, 1.0e5)?;
        range("HeapSettings.solid_damping", self.solid_damping, 0.0, 200.0)?;
        range("HeapSettings.friction", self.friction, 0.0, 10.0)?;
        range("HeapSettings.water", self.water.unwrap_or(0.0), -1.0e9, 1.0e9)?;
        range("HeapSettings.density", self.density, 0.01, 10.0)?;
        range("HeapSettings.support", self.support, 0.0, 100.0)?;
        range("HeapSettings.alone", self.alone, 0.0, 10.0)?;
        range("HeapSettings.parting", self.parting, 0.01, 10.0)?;
        if !(1..=MOST_SUBSTEPS).contains(&self.substeps) {
            let why = format!("expected 1 to {MOST_SUBSTEPS}, found {}", self.substeps);
            return Err(Error::bad("HeapSettings.substeps", why));
        }
        Ok(())
    }
}

/// What blobs run against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// All that lies behind a plane: `normal · x < distance`.
    Plane {
        /// Unit length.
        normal: [f32; 3],
        /// Of the plane from 0, along the normal.
        distance: f32,
    },
    /// A box.
    Box {
        /// Its middle.
        center: [f32; 3],
        /// Half its edges.
        half: [f32; 3],
        /// How it is turned: a unit quaternion, the real part last.
        turn: [f32; 4],
    },
}

/// The same for the shader (glsl/include/solid.glsl).
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct GpuSolid {
    place: [f32; 4],
    size: [f32; 4],
    turn: [f32; 4],
}

impl Solid {
    pub(super) fn check(&self) -> Result<(), Error> {
        let whole = |all: &[f32]| all.iter().all(|v| v.is_finite());
        let unit = |all: &[f32]| (all.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1.0e-3;
        let good = match self {
            Self::Plane { normal, distance } => unit(normal) && distance.is_finite(),
            Self::Box { center, half, turn } => {
                whole(center) && whole(half) && half.iter().all(|v| *v >= 0.0) && unit(turn)
            }
        };
        if good {
            return Ok(());
        }
        let why = format!("{self:?}: finite, with a unit normal or turn expected");
        Err(Error::bad("HeapStep.solids", why))
    }

    pub(super) fn on_gpu(self) -> GpuSolid {
        match self {
            Self::Plane { normal: [x, y, z], distance } => GpuSolid {
                place: [x, y, z, 0.0],
                size: [0.0, 0.0, 0.0, distance],
                turn: [0.0, 0.0, 0.0, 1.0],
            },
            Self::Box { center: [x, y, z], half: [a, b, c], turn } => {
                GpuSolid { place: [x, y, z, 1.0], size: [a, b, c, 0.0], turn }
            }
        }
    }
}

/// What fixes the memory of a [`Heap`](super::Heap).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct HeapConfig {
    /// Most blobs, 1 to 2^20.
    pub max_blobs: u32,
    /// Most solids of a step, default 64.
    pub max_solids: u32,
    /// How often a blob may split in two ([`HeapSettings::support`]), 0 to 6, default 0. There are places for 2^halvings
    /// times `max_blobs`, 2^20 in all at most.
    pub halvings: u32,
}

impl HeapConfig {
    /// The defaults for so many blobs.
    pub fn new(max_blobs: u32) -> Self {
        Self { max_blobs, max_solids: 64, halvings: 0 }
    }
}

/// One step of a heap.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct HeapStep<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// Seconds, [0, 1].
    pub dt: f32,
    /// Uniform settings.
    pub settings: &'a HeapSettings,
    /// What is solid, as it is at the step's end.
    pub solids: &'a [Solid],
}

impl<'a> HeapStep<'a> {
    /// A step of so many seconds without solids.
    pub fn new(slot: Slot, dt: f32, settings: &'a HeapSettings) -> Self {
        Self { slot, dt, settings, solids: &[] }
    }
}
