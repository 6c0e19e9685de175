//! The scene of the headless renderer: opaque meshes and a ground under a sky with a sun. Water runs over them,
//! refracts them and is hidden by them. An engine that embeds the library draws its own scene.

pub(in crate::headless) mod bake;
mod gltf;
mod load;
mod obj;
mod renderer;
mod sea;
mod shapes;
mod tracer;

use std::sync::Arc;

use glam::{Mat4, Vec3};

pub use load::SceneError;
pub use renderer::{SceneFrame, SceneRenderer};
pub use sea::{Liquid, Sea};

use crate::environment::Sky;
use crate::water::Pane;

/// Surroundings of the water. World space: right-handed, y up.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Opaque meshes; they cast and receive shadows.
    pub meshes: Vec<Mesh>,
    /// The sun.
    pub sun: SunLight,
    /// A level ground. It extends to the horizon, where it fades into the sky, or to its `reach`.
    pub ground: Option<Ground>,
    /// The camera that the scene file suggests.
    pub camera: Option<Viewpoint>,
    /// Motion of meshes from frame to frame. Meshes in no motion are static.
    pub motions: Vec<Motion>,
    /// The frame that is drawn. [`Headless::scene_frame`](super::Headless::scene_frame) applies a change of it.
    pub frame: u64,
    /// Water or lava that meshes and ground stand in.
    pub sea: Option<Sea>,
    /// Time of the frame in seconds, which moves the sea.
    pub time: f64,
    /// Distant opaque meshes around the scene: lawns, hedges, trees, a room's walls. How much of the sky and the sun is
    /// visible from them is baked at their own vertices, without subdivision, by rays: 64 per vertex to the sky near
    /// [`meshes`](Self::meshes), 6 or 4 farther away, none very far away. The backdrop casts no shadow on meshes,
    /// ground or water and reflects no light to them. [`bounds`](Self::bounds) and the shadow map ignore it. It is
    /// static.
    pub backdrop: Vec<Mesh>,
    /// Distance over which hazy air reduces the contrast of [`ground`](Self::ground), [`backdrop`](Self::backdrop) and
    /// [`sea`](Self::sea) to 1/e, towards the environment's colour at the horizon. World units, (0, ∞). If the sea is
    /// water, the distance holds for green light; red fades less and blue more. `None`, the default: clear air.
    /// [`meshes`](Self::meshes) are always in clear air.
    pub haze: Option<f32>,
    /// Strength, [0, 1], default 0, of three additions to the visible sky: thin high clouds, a bright band of haze
    /// over the horizon, and bluer air above that band. The [`sea`](Self::sea) reflects all three (the clouds as
    /// their mean opacity), meshes only the band. The clouds light meshes a little and soften the sun's shadows on
    /// them. The particles' water neither reflects any of the three nor is lit by them.
    pub clouds: f32,
    /// Rectangle, `[[min x, min z], [max x, max z]]`, of a basin whose water has splashed: stone and paving round
    /// it are damp in patches. `None`, the default: all is dry.
    pub splashed: Option<[[f32; 2]; 2]>,
    /// World units per metre, (0, ∞), for procedural surfaces: their fine detail, such as grains of sand and fibres
    /// of wood, has a fixed size in metres. (Lengths in [`Pattern`] are in world units.) `None`, the default: 1.
    pub metre: Option<f32>,
    /// Panes of glass in front of the water. At most [`MAX_PANES`](crate::water::MAX_PANES) are possible. They do not
    /// move. Neither the panes nor reflections on them are drawn; their edges and mounts can be
    /// [`meshes`](Self::meshes) or [`backdrop`](Self::backdrop).
    pub panes: Vec<Pane>,
}

/// Meshes that move as one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// Indices into [`Scene::meshes`].
    pub meshes: Vec<usize>,
    /// The frame of the first pose.
    pub first_frame: u64,
    /// One pose per frame: a transform from world space to world space that is applied after each mesh's own
    /// transform. Before the first frame the first pose holds, after the last frame the last one.
    pub poses: Vec<Mat4>,
}

impl Motion {
    /// The pose in a frame.
    pub fn pose(&self, frame: u64) -> Mat4 {
        let index = frame.saturating_sub(self.first_frame);
        let last = self.poses.len().saturating_sub(1);
        let pose = self.poses.get(usize::try_from(index).unwrap_or(last).min(last));
        pose.copied().unwrap_or(Mat4::IDENTITY)
    }
}

/// A camera from a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Position.
    pub eye: [f32; 3],
    /// Point that it looks at.
    pub target: [f32; 3],
    /// Up direction in the picture.
    pub up: [f32; 3],
    /// Vertical field of view in degrees.
    pub fov_y_degrees: f32,
}

/// The sun as a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunLight {
    /// World direction to the sun; any length but zero.
    pub direction: [f32; 3],
    /// Irradiance by the sun on a surface that faces it, linear RGB, [0, ∞), in the unit of the output.
    pub color: [f32; 3],
}

impl SunLight {
    /// The sun of the built-in sky, attenuated and reddened by its air.
    pub fn of(sky: &Sky) -> Self {
        let direction = Vec3::from(sky.sun).normalize_or(Vec3::Y);
        Self { direction: direction.to_array(), color: sky.sun_irradiance() }
    }
}

impl Default for SunLight {
    fn default() -> Self {
        Self::of(&Sky::default())
    }
}

/// The ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// Its height.
    pub y: f32,
    /// Material.
    pub material: Material,
    /// Half the side length of the square ground, world units, (0, ∞): its extent along x and along z to each side of
    /// the centre of the scene's [`bounds`](Scene::bounds). `None`: it extends to the horizon.
    pub reach: Option<f32>,
}

/// Triangles of one material.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Its name in messages.
    pub name: String,
    /// Vertices.
    pub positions: Vec<[f32; 3]>,
    /// A unit normal for each vertex.
    pub normals: Vec<[f32; 3]>,
    /// A texture coordinate for each vertex (v = 0 is the texture's top row); empty for a mesh without texture
    /// coordinates.
    pub uvs: Vec<[f32; 2]>,
    /// Vertex indices, three per triangle.
    pub indices: Vec<u32>,
    /// Material.
    pub material: Material,
    /// Transform to world space. If the mesh is rotated, its procedural pattern is laid out in the mesh's own frame,
    /// turned and moved with it. The patterns of meshes that are not rotated are laid out in world space, so they
    /// continue from one such mesh to the next.
    pub transform: Mat4,
}

/// Appearance of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Albedo, linear RGB, 0 to 1.
    pub base_color: [f32; 3],
    /// Roughness, 0 mirror-like to 1 matte.
    pub roughness: f32,
    /// Procedural pattern.
    pub pattern: Pattern,
    /// Texture that multiplies the base colour.
    pub texture: Option<Arc<Texture>>,
}

/// A repeating picture on a surface.
#[derive(Debug, PartialEq, Eq)]
pub struct Texture {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// width × height texels, sRGB, row 0 on top.
    pub data: Vec<[u8; 4]>,
}

/// A procedural surface; lengths in world units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Pattern {
    /// Only the base colour.
    #[default]
    Plain,
    /// Glazed square tiles with grout.
    Tiles {
        /// Edge of a tile.
        size: f32,
        /// Height in world space at which upright faces have a row of darker tiles, as pools have at the water's
        /// level; `None`: no such row.
        band: Option<f32>,
    },
    /// Weathered boards along the mesh's x axis.
    Planks {
        /// Width of a board.
        width: f32,
    },
    /// Weathered cast concrete.
    Concrete,
    /// Dressed stone in level courses.
    Stone {
        /// Height of a course.
        course: f32,
    },
    /// Dressed stone in blocks, whose courses begin at the ground.
    Blocks {
        /// Height of a course.
        course: f32,
    },
    /// Sand.
    Sand,
    /// Stone slabs, one and a half times as long as wide.
    Paving {
        /// Width of a slab.
        size: f32,
    },
    /// Sand around the height of the [`Sea`] (0 without one), grass above, rock where it is steep, some weed
    /// under water.
    Island {
        /// Height above the sea up to which there is sand.
        beach: f32,
    },
    /// Natural rock; dark where the [`Sea`] wets it.
    Rock,
    /// Leaves of bushes and hedges.
    Leaves,
    /// Leaves of trees and hedges in masses, translucent against the sun.
    Foliage,
    /// Grass, mown in stripes along z.
    Lawn {
        /// Width of a stripe.
        stripe: f32,
    },
    /// Sand with ripples, as the sea leaves it, and pebbles.
    Ripples {
        /// Distance from crest to crest.
        length: f32,
    },
}

impl Default for Material {
    fn default() -> Self {
        Self { base_color: [0.6; 3], roughness: 0.7, pattern: Pattern::Plain, texture: None }
    }
}

impl Material {
    fn new(base_color: [f32; 3], roughness: f32, pattern: Pattern) -> Self {
        Self { base_color, roughness, pattern, texture: None }
    }

    /// The material that scene files know by this name; `None` for a name that is not in
    /// [`NAMES`](Self::NAMES).
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "plain" => Self::default(),
            "concrete" => Self::new([0.44, 0.42, 0.385], 0.8, Pattern::Concrete),
            "tiles" => {
                Self::new([0.50, 0.62, 0.63], 0.22, Pattern::Tiles { size: 0.1, band: None })
            }
            "timber" => Self::new([0.36, 0.235, 0.135], 0.75, Pattern::Planks { width: 0.12 }),
            "stone" => Self::new([0.47, 0.40, 0.32], 0.8, Pattern::Stone { course: 0.3 }),
            "steel" => Self::new([0.13, 0.14, 0.15], 0.45, Pattern::Plain),
            "bamboo" => Self::new([0.34, 0.36, 0.10], 0.5, Pattern::Plain),
            "sand" => Self::new([0.44, 0.37, 0.275], 0.95, Pattern::Sand),
            "ground" | "paving" => {
                Self::new([0.35, 0.315, 0.265], 0.85, Pattern::Paving { size: 0.5 })
            }
            "island" => Self::new([0.66, 0.58, 0.44], 0.9, Pattern::Island { beach: 2.0 }),
            "rock" => Self::new([0.25, 0.225, 0.20], 0.85, Pattern::Rock),
            _ => return None,
        })
    }

    /// The names that [`Material::named`] knows.
    pub const NAMES: &'static [&'static str] = &[
        "plain", "concrete", "tiles", "timber", "stone", "steel", "bamboo", "sand", "ground",
        "paving", "island", "rock",
    ];

    /// Mean colour of the whole pattern, for bounced light.
    fn albedo(&self) -> Vec3 {
        let base = Vec3::from(self.base_color);
        let Some(texture) = &self.texture else { return base };
        let linear = |v: u8| (f32::from(v) / 255.0).powf(2.2);
        let step = (texture.data.len() / 4096).max(1);
        let texels = texture.data.iter().step_by(step);
        let count = texels.len().max(1) as f32;
        let sum = texels
            .fold(Vec3::ZERO, |sum, c| sum + Vec3::new(linear(c[0]), linear(c[1]), linear(c[2])));
        base * sum / count
    }
}

impl Scene {
    /// Bounding box of the meshes (not the ground) over their whole motion, in world space; if there are none, the
    /// box from −0.5 to 0.5 on each axis.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.bounds_in(Mat4::IDENTITY).unwrap_or((Vec3::splat(-0.5), Vec3::splat(0.5)))
    }

    /// The bounding box in another space; `None` for an empty scene.
    fn bounds_in(&self, space: Mat4) -> Option<(Vec3, Vec3)> {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (index, mesh) in self.meshes.iter().enumerate() {
            // Over all frames, so that the ground and the shadow map, which depend on the box, do not move.
            let poses = match self.motion_of(index) {
                Some(motion) => &motion.poses[..],
                None => &[Mat4::IDENTITY],
            };
            for pose in poses {
                let transform = space * *pose * mesh.transform;
                for &position in &mesh.positions {
                    let at = transform.transform_point3(position.into());
                    if at.is_finite() {
                        low = low.min(at);
                        high = high.max(at);
                    }
                }
            }
        }
        low.cmple(high).all().then_some((low, high))
    }

    /// Metres per world unit for procedural surfaces.
    fn metres_per_unit(&self) -> f32 {
        self.metre.map_or(1.0, f32::recip)
    }

    fn motion_of(&self, mesh: usize) -> Option<&Motion> {
        let mut motions = self.motions.iter().filter(|motion| !motion.poses.is_empty());
        motions.find(|motion| motion.meshes.contains(&mesh))
    }

    /// Transform that moves the mesh with this index, in world space, to its pose in the frame that is drawn; `None`
    /// if the mesh is static.
    fn pose(&self, mesh: usize) -> Option<Mat4> {
        self.motion_of(mesh).map(|motion| motion.pose(self.frame))
    }

    /// Whether two frames look the same.
    pub fn rests_between(&self, a: u64, b: u64) -> bool {
        let sea = a == b || self.sea.as_ref().is_none_or(Sea::rests);
        sea && self.solids_rest_between(a, b)
    }

    /// Whether nothing but the sea moves.
    pub(in crate::headless) fn solids_rest_between(&self, a: u64, b: u64) -> bool {
        self.motions.iter().all(|motion| motion.pose(a) == motion.pose(b))
    }
}
