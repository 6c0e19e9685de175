//! Tables `[shore]`, `[shoreline]` and `[contact]`.

use std::path::PathBuf;

use serde::Deserialize;
use whitewater::shore::{ContactLook, Edge, Measure, Noise, ShoreConfig, ShorelineLook, WebLayer};

/// What is the same in all frames.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ShoreTable {
    edge: Option<EdgeTable>,
    web_size: Option<u32>,
    seed: Option<u32>,
    /// A picture in place of the built-in web.
    pub web: Option<PathBuf>,
    /// What tells how far the shore is.
    pub by: Option<By>,
    /// Texels of the map each way.
    pub map: Option<u32>,
    /// Seconds after which all repeats.
    pub period: Option<f32>,
}

/// What tells how far the shore is.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
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

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum EdgeTable {
    Smooth,
    Clip,
    Coverage,
}

impl ShoreTable {
    /// What of it chooses passes.
    pub fn config(&self) -> ShoreConfig {
        let standard = ShoreConfig::default();
        ShoreConfig {
            edge: match self.edge {
                Some(EdgeTable::Clip) => Edge::Clip,
                Some(EdgeTable::Coverage) => Edge::Coverage,
                Some(EdgeTable::Smooth) | None => Edge::Smooth,
            },
            web_size: self.web_size.unwrap_or(standard.web_size),
            seed: self.seed.unwrap_or(standard.seed),
        }
    }
}

/// A noise: amplitude and repetitions a metre.
type Pair = [f32; 2];

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ShorelineTable {
    reach: Option<[f32; 2]>,
    frequency: Option<f32>,
    speed: Option<f32>,
    swing: Option<f32>,
    swing_by: Option<[f32; 2]>,
    frequency_noise: Option<Pair>,
    speed_noise: Option<Pair>,
    speed_period: Option<f32>,
    wave_rise: Option<[f32; 2]>,
    floor: Option<f32>,
    wave_ratio: Option<f32>,
    web_ratio: Option<f32>,
    web_rise: Option<[f32; 2]>,
    layers: Option<Vec<LayerTable>>,
    web_warp: Option<Pair>,
    web_warp_speed: Option<[f32; 2]>,
    threshold: Option<f32>,
    threshold_noise: Option<Pair>,
    rise_noise: Option<Pair>,
    warp: Option<Pair>,
    fade: Option<f32>,
    color: Option<[f32; 3]>,
    opacity: Option<f32>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct LayerTable {
    weight: f32,
    scale: f32,
    #[serde(default)]
    angle: f32,
    #[serde(default)]
    speed: [f32; 2],
}

fn put<T>(to: &mut T, from: Option<T>) {
    if let Some(from) = from {
        *to = from;
    }
}

impl ShorelineTable {
    /// Puts what the table says over a look.
    pub fn apply(&self, look: &mut ShorelineLook) -> Result<(), String> {
        put(&mut look.reach, self.reach);
        put(&mut look.frequency, self.frequency);
        put(&mut look.speed, self.speed);
        put(&mut look.swing, self.swing);
        put(&mut look.swing_by, self.swing_by);
        put(&mut look.speed_period, self.speed_period);
        put(&mut look.wave_rise, self.wave_rise);
        look.floor = self.floor.or(look.floor);
        put(&mut look.wave_ratio, self.wave_ratio);
        put(&mut look.web_ratio, self.web_ratio);
        put(&mut look.web_rise, self.web_rise);
        put(&mut look.web_warp_speed, self.web_warp_speed);
        put(&mut look.threshold, self.threshold);
        put(&mut look.fade, self.fade);
        put(&mut look.color, self.color);
        put(&mut look.opacity, self.opacity);
        for (to, from) in [
            (&mut look.frequency_noise, self.frequency_noise),
            (&mut look.speed_noise, self.speed_noise),
            (&mut look.web_warp, self.web_warp),
            (&mut look.threshold_noise, self.threshold_noise),
            (&mut look.rise_noise, self.rise_noise),
            (&mut look.warp, self.warp),
        ] {
            put(to, from.map(|[amplitude, scale]| Noise { amplitude, scale }));
        }
        if let Some(layers) = &self.layers {
            if layers.len() > look.layers.len() {
                let most = look.layers.len();
                return Err(format!(
                    "shoreline.layers: expected at most {most}, found {}",
                    layers.len()
                ));
            }
            look.layers = [WebLayer::NONE; 4];
            for (to, from) in look.layers.iter_mut().zip(layers) {
                let LayerTable { weight, scale, angle, speed } = *from;
                *to = WebLayer { weight, scale, angle, speed };
            }
        }
        Ok(())
    }
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ContactTable {
    depth: Option<f32>,
    particle_depth: Option<f32>,
    measure: Option<MeasureTable>,
    mask: Option<f32>,
    mask_scale: Option<f32>,
    mask_speed: Option<[f32; 2]>,
    color: Option<[f32; 3]>,
    lit: Option<f32>,
    opacity: Option<f32>,
    particle_opacity: Option<f32>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum MeasureTable {
    Distance,
    View,
    Vertical,
}

impl ContactTable {
    /// Whether there is some on the particles' water.
    pub fn on_particles(&self) -> bool {
        self.particle_opacity.is_some_and(|opacity| opacity > 0.0)
    }

    /// Puts what the table says over a look.
    pub fn apply(&self, look: &mut ContactLook) {
        put(&mut look.depth, self.depth);
        look.particle_depth = self.particle_depth.or(look.particle_depth);
        let measure = |measure| match measure {
            MeasureTable::Distance => Measure::Distance,
            MeasureTable::View => Measure::View,
            MeasureTable::Vertical => Measure::Vertical,
        };
        put(&mut look.measure, self.measure.map(measure));
        put(&mut look.mask, self.mask);
        put(&mut look.mask_scale, self.mask_scale);
        put(&mut look.mask_speed, self.mask_speed);
        put(&mut look.color, self.color);
        put(&mut look.lit, self.lit);
        put(&mut look.opacity, self.opacity);
        put(&mut look.particle_opacity, self.particle_opacity);
    }
}
