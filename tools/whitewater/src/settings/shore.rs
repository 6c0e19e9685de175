//! Tables `[shore]`, `[shoreline]` and `[contact]`.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use whitewater::shore::{
    ContactSettings, Edge, Measure, Noise, ShoreConfig, ShoreSettings, ShorelineSettings,
    TextureLayer,
};

use super::table::{table, words};

table! {
    /// Table `[shore]`: values that are the same in all frames.
    ShoreTable of ShoreSettings
    keys {}
    // Seconds after which the foam's animation repeats.
    optional { period: f32 }
    not { time, shoreline, contact }
    beside {
        edge: EdgeWord,
        texture_size: u32,
        seed: u32,
        /// A picture that replaces the built-in web.
        web: PathBuf,
        /// File of a mesh whose second texture coordinate is the shore coordinate v, for `by = "strip"`, which is the
        /// default if this key is set.
        strip: PathBuf,
        /// Source of the shore coordinate.
        by: By,
        /// Size of the distance map in texels along an edge.
        map: u32,
    }
}

/// Source of the shore coordinate.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum By {
    Map,
    Strip,
    Screen,
    /// No shoreline foam.
    None,
}

impl By {
    pub fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Strip => "strip",
            Self::Screen => "screen",
            Self::None => "none",
        }
    }
}

words!(EdgeWord of Edge { Smooth, Clip, Coverage });

impl ShoreTable {
    /// The configuration of passes.
    pub fn config(&self) -> ShoreConfig {
        let standard = ShoreConfig::default();
        standard.with(|it| {
            it.edge = self.edge.map_or(standard.edge, Into::into);
            it.texture_size = self.texture_size.unwrap_or(standard.texture_size);
            it.seed = self.seed.unwrap_or(standard.seed);
        })
    }

    /// The complete table of a look, with this table's configuration and files.
    pub fn all(&self, look: &ShoreSettings) -> Self {
        let ShoreConfig { edge, texture_size, seed, .. } = self.config();
        Self {
            edge: Some(edge.into()),
            texture_size: Some(texture_size),
            seed: Some(seed),
            web: self.web.clone(),
            strip: self.strip.clone(),
            by: self.by,
            map: self.map,
            ..Self::of(look)
        }
    }
}

table! {
    /// Table `[shoreline]`.
    ShorelineTable of ShorelineSettings
    keys {
        sea_reach: f32,
        land_reach: f32,
        frequency: f32,
        speed: f32,
        swing: f32,
        swing_amplitude: f32,
        swing_period: f32,
        frequency_noise: Pair,
        speed_noise: Pair,
        speed_period: f32,
        wave_slope: f32,
        wave_offset: f32,
        wave_weight: f32,
        texture_weight: f32,
        texture_slope: f32,
        texture_offset: f32,
        layers: Layers,
        texture_warp: Pair,
        texture_warp_velocity: [f32; 2],
        threshold: f32,
        threshold_noise: Pair,
        rise_noise: Pair,
        warp: Pair,
        fade: f32,
        color: [f32; 3],
        opacity: f32,
    }
    optional { floor: f32 }
    not {}
    beside {}
}

/// A noise: amplitude, and repetitions per scene unit.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Pair([f32; 2]);

impl From<Pair> for Noise {
    fn from(Pair([amplitude, scale]): Pair) -> Self {
        Self { amplitude, scale }
    }
}

impl From<Noise> for Pair {
    fn from(Noise { amplitude, scale }: Noise) -> Self {
        Self([amplitude, scale])
    }
}

/// Max number of layers of a web.
const LAYERS: usize = 4;

/// The layers of the web.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(try_from = "Vec<LayerTable>", into = "Vec<LayerTable>")]
pub struct Layers([TextureLayer; LAYERS]);

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct LayerTable {
    weight: f32,
    scale: f32,
    #[serde(default)]
    angle: f32,
    #[serde(default)]
    speed: [f32; 2],
}

impl TryFrom<Vec<LayerTable>> for Layers {
    type Error = String;

    fn try_from(tables: Vec<LayerTable>) -> Result<Self, String> {
        if tables.len() > LAYERS {
            return Err(format!(
                "shoreline.layers: expected at most {LAYERS}, found {}",
                tables.len()
            ));
        }
        let mut layers = [TextureLayer::NONE; LAYERS];
        for (layer, table) in layers.iter_mut().zip(tables) {
            let LayerTable { weight, scale, angle, speed } = table;
            *layer = TextureLayer { weight, scale, angle, speed };
        }
        Ok(Self(layers))
    }
}

impl From<Layers> for Vec<LayerTable> {
    fn from(Layers(layers): Layers) -> Self {
        let table = |TextureLayer { weight, scale, angle, speed }| LayerTable {
            weight,
            scale,
            angle,
            speed,
        };
        layers.map(table).into()
    }
}

impl From<Layers> for [TextureLayer; LAYERS] {
    fn from(Layers(layers): Layers) -> Self {
        layers
    }
}

impl From<[TextureLayer; LAYERS]> for Layers {
    fn from(layers: [TextureLayer; LAYERS]) -> Self {
        Self(layers)
    }
}

table! {
    /// Table `[contact]`.
    ContactTable of ContactSettings
    keys {
        depth: f32,
        measure: MeasureWord,
        mask: f32,
        mask_scale: f32,
        mask_speed: [f32; 2],
        color: [f32; 3],
        lit: f32,
        opacity: f32,
        particle_opacity: f32,
    }
    optional { particle_depth: f32 }
    not {}
    beside {
        /// A picture that is laid over the view and replaces the web (the foam texture) as a mask: black removes
        /// foam.
        mask_picture: PathBuf,
    }
}

words!(MeasureWord of Measure { Distance, View, Vertical });

impl ContactTable {
    /// The complete table of a look, with this table's picture.
    pub fn all(&self, look: &ContactSettings) -> Self {
        Self { mask_picture: self.mask_picture.clone(), ..Self::of(look) }
    }

    /// Whether contact foam is drawn on the particles' water.
    pub fn on_particles(&self) -> bool {
        self.particle_opacity.is_some_and(|opacity| opacity > 0.0)
    }
}
