//! Seas to measure foam by: scenes like those of the source (Akinci, Dippel, Akinci, Teschner, Screen Space Foam
//! Rendering, 2013, Table 1 and Fig. 8) at any number of diffuse particles, by formula.
//!
//! Nothing is simulated. Where foam lies is a density that noise tears into sheets, laces and threads, and what
//! flies is thrown; a particle is drawn from it by its id alone, so that any part of a sea can be made by itself, and
//! more particles show the same sea finer. Metres, y up.
//!
//! Bubbles lie under the surface, which is opaque here: they cost what bubbles cost, and few of them are seen.

mod flood;
mod lighthouse;
mod noise;
mod random;
mod ship;
mod surface;
mod throw;
mod wave;

use std::ops::Range;

use glam::{Mat4, Vec3, vec3};
use rayon::prelude::*;
use whitewater::Camera;
use whitewater::headless::scene::{Ground, Material, Scene, SunLight};

use random::Random;

/// A scene of the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sea {
    /// A wave that breaks from one end to the other.
    Wave,
    /// A ship under way, with its bow wave and wake.
    Ship,
    /// A lighthouse on a rock that a wave has run against.
    Lighthouse,
    /// A flood that comes down a street.
    Flood,
}

/// Diffuse particles, each attribute as long as `positions`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Foam {
    /// World-space centres, metres.
    pub positions: Vec<[f32; 3]>,
    /// 0 foam, 1 spray, 2 bubble.
    pub kinds: Vec<u32>,
    /// What of their lives has passed, 0 to 1.
    pub ages: Vec<f32>,
    /// Their numbers.
    pub ids: Vec<u32>,
}

/// One of them.
struct Particle {
    position: Vec3,
    kind: u32,
    age: f32,
}

const FOAM: u32 = 0;
const SPRAY: u32 = 1;
const BUBBLE: u32 = 2;

/// What a module of a sea says of it.
struct Plan {
    /// Draws a particle of foam, spray and bubbles.
    draw: [fn(&mut Random) -> Particle; 3],
    /// What part of all each kind is; together 1.
    shares: [f32; 3],
    /// Corners of a box that holds all of them.
    bounds: [Vec3; 2],
    /// Radius of a particle where there are a million.
    radius: f32,
    eye: Vec3,
    target: Vec3,
    /// Vertical field of view, degrees.
    fov: f32,
    /// To the sun.
    sun: Vec3,
}

impl Sea {
    /// All of them, in the source's order.
    pub const ALL: [Self; 4] = [Self::Wave, Self::Ship, Self::Lighthouse, Self::Flood];

    /// Its name in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wave => "wave",
            Self::Ship => "ship",
            Self::Lighthouse => "lighthouse",
            Self::Flood => "flood",
        }
    }

    /// The one of a name; `None` for any other.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sea| sea.name() == name)
    }

    /// How many particles the source's scene has at most, and the size of its picture (Table 1).
    pub fn source(self) -> (u32, (u32, u32)) {
        match self {
            Self::Wave => (820_000, (800, 600)),
            Self::Ship => (9_000_000, (800, 600)),
            Self::Lighthouse => (15_000_000, (800, 600)),
            Self::Flood => (29_000_000, (1280, 960)),
        }
    }

    fn plan(self) -> Plan {
        match self {
            Self::Wave => wave::PLAN,
            Self::Ship => ship::PLAN,
            Self::Lighthouse => lighthouse::PLAN,
            Self::Flood => flood::PLAN,
        }
    }

    /// What part of the particles is foam, spray and bubbles.
    pub fn shares(self) -> [f32; 3] {
        self.plan().shares
    }

    /// Corners of a box that all particles lie in, metres.
    pub fn bounds(self) -> [[f32; 3]; 2] {
        self.plan().bounds.map(|corner| corner.to_array())
    }

    /// The particles of these ids, of a sea of `count`; ids from there on have none. Each goes by its id alone.
    pub fn foam(self, ids: Range<u32>, count: u32) -> Foam {
        let ids = ids.start..ids.end.min(count);
        let plan = self.plan();
        let [foam, spray, _] = plan.shares;
        let draw = |id: u32| {
            let mut random = Random::new(id, self as u32);
            let lot = random.unit();
            let kind = if lot < foam { 0 } else { 1 + usize::from(lot >= foam + spray) };
            (plan.draw[kind])(&mut random)
        };
        let mut all = Foam { ids: ids.clone().collect(), ..Foam::default() };
        let drawn: Vec<Particle> = ids.into_par_iter().map(draw).collect();
        all.positions = drawn.iter().map(|p| p.position.to_array()).collect();
        all.kinds = drawn.iter().map(|p| p.kind).collect();
        all.ages = drawn.iter().map(|p| p.age.clamp(0.0, 0.98)).collect();
        all
    }

    /// The radius with which so many particles cover as much as any other number of them, metres: for
    /// [`DiffuseLook::radius`](whitewater::foam::DiffuseLook::radius).
    pub fn radius(self, count: u32) -> f32 {
        self.plan().radius * (1.0e6 / count.max(1) as f32).sqrt()
    }

    /// The water's surface as a mesh, and what stands in it.
    pub fn scene(self) -> Scene {
        let meshes = match self {
            Self::Wave => wave::meshes(),
            Self::Ship => ship::meshes(),
            Self::Lighthouse => lighthouse::meshes(),
            Self::Flood => flood::meshes(),
        };
        let ground = match self {
            Self::Flood => Ground { y: 0.0, material: flood::ground(), reach: None },
            _ => Ground { y: OPEN_SEA, material: open_sea(), reach: None },
        };
        let sun = SunLight { direction: self.plan().sun.to_array(), ..SunLight::default() };
        Scene { meshes, sun, ground: Some(ground), ..Scene::default() }
    }

    /// From where the picture is taken, for a picture so many times as wide as high.
    pub fn camera(self, aspect: f32) -> Camera {
        let plan = self.plan();
        self.camera_from(plan.eye.distance(plan.target), aspect)
    }

    /// The same way, so many metres from what it looks at.
    pub fn camera_from(self, distance: f32, aspect: f32) -> Camera {
        let plan = self.plan();
        let eye = plan.target + distance * (plan.eye - plan.target).normalize();
        let flip = Mat4::from_scale(vec3(1.0, -1.0, 1.0));
        let angle = plan.fov.to_radians();
        Camera::of(
            Mat4::look_at_rh(eye, plan.target, Vec3::Y),
            flip * Mat4::perspective_infinite_reverse_rh(angle, aspect, 0.5),
        )
    }
}

/// Height of the sea out to the horizon, under the troughs of the waves that are a mesh.
const OPEN_SEA: f32 = -1.6;
/// Albedo of clear deep water.
const DEEP: Vec3 = vec3(0.010, 0.050, 0.070);
/// Of water that is full of bubbles.
const MILKY: Vec3 = vec3(0.12, 0.28, 0.30);

/// Albedo of water that was this, where foam covers so much of it.
fn aerated(clear: Vec3, amount: f32) -> Vec3 {
    let milky = clear.lerp(MILKY, noise::smooth(0.30, 0.85, amount));
    milky.lerp(vec3(0.42, 0.49, 0.49), 0.8 * noise::smooth(0.65, 1.1, amount))
}

fn open_sea() -> Material {
    // Matt: a mirror that is level would show the horizon, where waves show the sky above it.
    Material { base_color: [0.042, 0.130, 0.200], roughness: 0.95, ..Material::default() }
}

#[cfg(test)]
mod tests;
