//! Settings of shoreline foam (*Semi-procedural foam shader*, an indie developer's blog, 2019) and of contact
//! foam (D. Lettier, *3D Game Shaders For Beginners*, Foam). Lengths are in scene units. Defaults are in metres
//! and suit an island about a hundred metres wide.

use std::f64::consts::TAU;

use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(ShoreConfig, ShoreLook, ShorelineLook, ContactLook);

/// Maximum number of foam texture layers.
pub const LAYERS: usize = 4;

/// Configuration of shoreline and contact foam: what costs memory or pipelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShoreConfig {
    /// How the edge of foam within a pixel is computed.
    pub edge: Edge,
    /// Side length of the foam texture in texels, a power of two from 16 to 2048, default 512. 25⅓ bytes per
    /// texel.
    pub web_size: u32,
    /// Seed of the built-in foam texture and noise, default 1.
    pub seed: u32,
}

impl Default for ShoreConfig {
    fn default() -> Self {
        Self { edge: Edge::Smooth, web_size: 512, seed: 1 }
    }
}

impl ShoreConfig {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let size = self.web_size;
        if size.is_power_of_two() && (16..=2048).contains(&size) {
            return Ok(());
        }
        let why = format!("{size}: a power of two from 16 to 2048 expected");
        Err(Error::bad("Config.shore.web_size", why))
    }
}

/// How the edge of shoreline foam within a pixel is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Edge {
    /// The fraction of the pixel that foam covers, from the foam's derivatives and the variance of detail finer
    /// than the pixel. Default: it neither crawls nor sparkles.
    Smooth,
    /// A pixel is foam or not, as in the blog.
    Clip,
    /// The average of four alpha-to-coverage samples: [`Smooth`](Self::Smooth) quantised to quarters and
    /// dithered over 2×2 pixels.
    Coverage,
}

/// Appearance of shoreline and contact foam.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ShoreLook {
    /// Time in seconds, finite. Motion is derived from it in 64 bits. Default 0.
    pub time: f64,
    /// Period after which everything repeats, seconds, [0.1, 1e6]: speeds are rounded to whole cycles per
    /// period. `None` (default): no repetition.
    pub period: Option<f32>,
    /// Foam along shores.
    pub shoreline: ShorelineLook,
    /// Foam around objects in the water.
    pub contact: ContactLook,
}

impl ShoreLook {
    /// Converts this look from metres to scene units, for a number of scene units per metre.
    #[must_use]
    pub fn in_units(mut self, units_per_metre: f32) -> Self {
        let longer = |length: &mut f32| *length *= units_per_metre;
        let wider = |scale: &mut f32| *scale /= units_per_metre;
        let shore = &mut self.shoreline;
        shore.reach.iter_mut().chain(&mut shore.web_warp_speed).for_each(longer);
        for layer in &mut shore.layers {
            wider(&mut layer.scale);
            layer.speed.iter_mut().for_each(longer);
        }
        for noise in [
            &mut shore.frequency_noise,
            &mut shore.speed_noise,
            &mut shore.threshold_noise,
            &mut shore.rise_noise,
        ] {
            wider(&mut noise.scale);
        }
        // Of these the amplitude is a length too.
        for warp in [&mut shore.web_warp, &mut shore.warp] {
            wider(&mut warp.scale);
            longer(&mut warp.amplitude);
        }
        longer(&mut self.contact.depth);
        self.contact.particle_depth.iter_mut().for_each(longer);
        wider(&mut self.contact.mask_scale);
        self.contact.mask_speed.iter_mut().for_each(longer);
        self
    }
}

/// Zero-mean seamless noise over the water's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Maximum value, [-1000, 1000], in the unit of the quantity that it modulates.
    pub amplitude: f32,
    /// Repetitions per metre, [0, 100]. The coarsest cells are a quarter of a repetition wide.
    pub scale: f32,
}

impl Noise {
    /// No noise.
    pub const NONE: Self = Self { amplitude: 0.0, scale: 0.0 };

    const fn new(amplitude: f32, scale: f32) -> Self {
        Self { amplitude, scale }
    }

    fn check(&self, [amplitude, scale]: [&'static str; 2]) -> Result<(), Error> {
        range(amplitude, self.amplitude, -1000.0, 1000.0)?;
        range(scale, self.scale, 0.0, 100.0)
    }
}

/// Shoreline foam. There is foam where
///
/// `wave_ratio · (sin((frequency + n₁)·v + phase) + a·v + b) + web_ratio · (web + a'·v + b') ≥ threshold + n₂`
///
/// with the shore coordinate v 0 at the sea's edge of the foam, 1 at the shore line and 2 inland (the blog, Sec. IV to VIII).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShorelineLook {
    /// Width of the foam seawards and inland of the shore line, metres, (0, 1e6], default 12 and 3, where v
    /// comes from a distance. A strip has its own v.
    pub reach: [f32; 2],
    /// Wave frequency in radians per v, [0, 1000], default 13: two waves between the sea's edge and the shore
    /// line.
    pub frequency: f32,
    /// Wave speed in radians per second, [-1000, 1000], default -0.9. Negative runs towards the shore, positive
    /// out to sea, as in the blog.
    pub speed: f32,
    /// Share of the motion that oscillates, 0 (none) to 1 (all), default 0.35.
    pub swing: f32,
    /// The oscillation's amplitude in radians, [0, 1000], default 2.2, and its period in seconds, [0.1, 1e6],
    /// default 7.
    pub swing_by: [f32; 2],
    /// Noise added to the frequency. Default 5, 1/90 m.
    pub frequency_noise: Noise,
    /// Noise added to the speed, radians per second. Default 0.35, 1/90 m. It oscillates, because places would
    /// otherwise drift apart without limit.
    pub speed_noise: Noise,
    /// Period of that oscillation, seconds, [0.1, 1e6], default 11.
    pub speed_period: f32,
    /// Slope a and offset b of the waves over v, [-100, 100], default 1.1 and -0.75.
    pub wave_rise: [f32; 2],
    /// Lower limit of the waves, [-100, 100]. `None` (default): no limit. The blog's first steps use 0.
    pub floor: Option<f32>,
    /// Weight of the waves in the mix, [0, 100], default 0.34.
    pub wave_ratio: f32,
    /// Weight of the foam texture in the mix, [0, 100], default 0.66.
    pub web_ratio: f32,
    /// Slope a' and offset b' of the foam texture over v, [-100, 100], default 0.95 and -0.62.
    pub web_rise: [f32; 2],
    /// Layers of the foam texture. Default: two.
    pub layers: [WebLayer; LAYERS],
    /// Domain warp of the foam texture, metres. Default 0.7, 1/18 m.
    pub web_warp: Noise,
    /// Velocity of that warp's noise, metres per second, [-1000, 1000], default 0.35 and 0.2.
    pub web_warp_speed: [f32; 2],
    /// Threshold of the mix from which there is foam, [-100, 100], default 0.39.
    pub threshold: f32,
    /// Noise added to the threshold. Default 0.1, 1/90 m.
    pub threshold_noise: Noise,
    /// Noise added to both offsets, so that the foam's reach varies along the shore. Default 0.22, 1/90 m.
    pub rise_noise: Noise,
    /// Domain warp applied to everything except v, metres. Default none.
    pub warp: Noise,
    /// Range of v over which foam fades out at the sea's edge and at the inland edge, [0.001, 1], default 0.2.
    pub fade: f32,
    /// Albedo, linear RGB, 0 to 1; default 0.9 of each.
    pub color: [f32; 3],
    /// Opacity, 0 to 1, default 1.
    pub opacity: f32,
}

/// One layer of the foam texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WebLayer {
    /// Weight of the layer, [0, 1], 0 = off.
    pub weight: f32,
    /// Repetitions per metre, [0, 100].
    pub scale: f32,
    /// Rotation in degrees.
    pub angle: f32,
    /// Velocity in metres per second, [-1000, 1000].
    pub speed: [f32; 2],
}

impl WebLayer {
    /// No layer.
    pub const NONE: Self = Self { weight: 0.0, scale: 0.0, angle: 0.0, speed: [0.0; 2] };
}

impl Default for ShorelineLook {
    fn default() -> Self {
        let layer = |weight, scale, angle, speed| WebLayer { weight, scale, angle, speed };
        Self {
            reach: [12.0, 3.0],
            frequency: 13.0,
            speed: -0.9,
            swing: 0.35,
            swing_by: [2.2, 7.0],
            frequency_noise: Noise::new(5.0, 1.0 / 90.0),
            speed_noise: Noise::new(0.35, 1.0 / 90.0),
            speed_period: 11.0,
            wave_rise: [1.1, -0.75],
            floor: None,
            wave_ratio: 0.34,
            web_ratio: 0.66,
            web_rise: [0.95, -0.62],
            layers: [
                layer(0.65, 1.0 / 10.5, 0.0, [0.12, 0.07]),
                layer(0.35, 1.0 / 6.4, 37.0, [-0.1, 0.13]),
                WebLayer::NONE,
                WebLayer::NONE,
            ],
            web_warp: Noise::new(0.7, 1.0 / 18.0),
            web_warp_speed: [0.35, 0.2],
            threshold: 0.39,
            threshold_noise: Noise::new(0.1, 1.0 / 90.0),
            rise_noise: Noise::new(0.22, 1.0 / 90.0),
            warp: Noise::NONE,
            fade: 0.2,
            color: [0.9; 3],
            opacity: 1.0,
        }
    }
}

/// Contact foam: the closer the scene is behind the water's surface, the more foam (Lettier).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactLook {
    /// Distance at which contact foam ends on the host's surface, metres, (0, 1e6], default 0.4. (The tutorial
    /// has 4 in its own units.)
    pub depth: f32,
    /// The same distance on the particles' water. `None` (default): four spacings.
    pub particle_depth: Option<f32>,
    /// How that distance is measured.
    pub measure: Measure,
    /// Strength of the mask, 0 (none) to 1 (no foam where it is black), default 0.8.
    pub mask: f32,
    /// Repetitions per metre of the foam texture that serves as mask if the host has none, [0, 100], default
    /// 1/2.2.
    pub mask_scale: f32,
    /// Velocity of that texture, metres per second, [-1000, 1000], default 0.05 and 0.03.
    pub mask_speed: [f32; 2],
    /// Albedo, linear RGB, 0 to 1, default the tutorial's (0.8, 0.85, 0.92 in sRGB). With `lit` of 0 it is a
    /// radiance, [0, ∞).
    pub color: [f32; 3],
    /// Share of its light that comes from sun and sky, 0 (it emits light) to 1 (default).
    pub lit: f32,
    /// Opacity on the host's surface, 0 (none) to 1 (default).
    pub opacity: f32,
    /// Opacity on the particles' water, 0 (none, default) to 1.
    pub particle_opacity: f32,
}

impl Default for ContactLook {
    fn default() -> Self {
        Self {
            depth: 0.4,
            particle_depth: None,
            measure: Measure::Distance,
            mask: 0.8,
            mask_scale: 1.0 / 2.2,
            mask_speed: [0.05, 0.03],
            color: [0.604, 0.692, 0.828],
            lit: 1.0,
            opacity: 1.0,
            particle_opacity: 0.0,
        }
    }
}

/// How the distance between the surface and the scene behind it is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Measure {
    /// The distance between both points of the pixel, as in the tutorial's program. Default.
    Distance,
    /// The difference of their depths along the view, as in the tutorial's text.
    View,
    /// The difference of their heights. No foam where the scene behind is not below.
    Vertical,
}

impl ShoreLook {
    pub(crate) fn check(&self) -> Result<(), Error> {
        if !self.time.is_finite() {
            return Err(Error::bad("ShoreLook.time", "not finite"));
        }
        range("ShoreLook.period", self.period.unwrap_or(1.0), 0.1, 1.0e6)?;
        self.shoreline.check()?;
        self.contact.check()
    }

    /// Phase, 0 to 1, of a motion with `rate` cycles per second.
    pub(crate) fn turned(&self, rate: f64) -> f64 {
        let rate = match self.period {
            Some(period) => (rate * f64::from(period)).round() / f64::from(period),
            None => rate,
        };
        (rate * self.time).rem_euclid(1.0)
    }

    /// The phase of the waves in radians, and what the noise on their speed is multiplied by.
    pub(crate) fn phases(&self) -> [f32; 2] {
        let s = &self.shoreline;
        let [by, seconds] = s.swing_by.map(f64::from);
        let swing = f64::from(s.swing);
        let straight = self.turned((1.0 - swing) * f64::from(s.speed) / TAU) * TAU;
        let swung = swing * by * (self.turned(1.0 / seconds) * TAU).sin();
        // Its derivative is a cosine of height 1: radians a second, as the noise has them.
        let period = f64::from(s.speed_period);
        let local = period / TAU * (self.turned(1.0 / period) * TAU).sin();
        [(straight + swung).rem_euclid(TAU) as f32, local as f32]
    }
}

impl ShorelineLook {
    fn check(&self) -> Result<(), Error> {
        for (field, value) in
            [("ShorelineLook.reach[0]", self.reach[0]), ("ShorelineLook.reach[1]", self.reach[1])]
        {
            range(field, value, 1.0e-6, 1.0e6)?;
        }
        range("ShorelineLook.frequency", self.frequency, 0.0, 1000.0)?;
        range("ShorelineLook.speed", self.speed, -1000.0, 1000.0)?;
        range("ShorelineLook.swing", self.swing, 0.0, 1.0)?;
        range("ShorelineLook.swing_by[0]", self.swing_by[0], 0.0, 1000.0)?;
        range("ShorelineLook.swing_by[1]", self.swing_by[1], 0.1, 1.0e6)?;
        range("ShorelineLook.speed_period", self.speed_period, 0.1, 1.0e6)?;
        range("ShorelineLook.floor", self.floor.unwrap_or(0.0), -100.0, 100.0)?;
        range("ShorelineLook.wave_ratio", self.wave_ratio, 0.0, 100.0)?;
        range("ShorelineLook.web_ratio", self.web_ratio, 0.0, 100.0)?;
        range("ShorelineLook.threshold", self.threshold, -100.0, 100.0)?;
        range("ShorelineLook.fade", self.fade, 0.001, 1.0)?;
        range("ShorelineLook.opacity", self.opacity, 0.0, 1.0)?;
        let pairs = [
            ("ShorelineLook.wave_rise", self.wave_rise, 100.0),
            ("ShorelineLook.web_rise", self.web_rise, 100.0),
            ("ShorelineLook.web_warp_speed", self.web_warp_speed, 1000.0),
        ];
        for (field, pair, most) in pairs {
            pair.into_iter().try_for_each(|value| range(field, value, -most, most))?;
        }
        self.color.into_iter().try_for_each(|c| range("ShorelineLook.color", c, 0.0, 1.0))?;
        for layer in &self.layers {
            range("WebLayer.weight", layer.weight, 0.0, 1.0)?;
            range("WebLayer.scale", layer.scale, 0.0, 100.0)?;
            range("WebLayer.angle", layer.angle, -1.0e6, 1.0e6)?;
            layer
                .speed
                .into_iter()
                .try_for_each(|value| range("WebLayer.speed", value, -1000.0, 1000.0))?;
        }
        self.frequency_noise.check([
            "ShorelineLook.frequency_noise.amplitude",
            "ShorelineLook.frequency_noise.scale",
        ])?;
        self.speed_noise
            .check(["ShorelineLook.speed_noise.amplitude", "ShorelineLook.speed_noise.scale"])?;
        self.threshold_noise.check([
            "ShorelineLook.threshold_noise.amplitude",
            "ShorelineLook.threshold_noise.scale",
        ])?;
        self.rise_noise
            .check(["ShorelineLook.rise_noise.amplitude", "ShorelineLook.rise_noise.scale"])?;
        self.warp.check(["ShorelineLook.warp.amplitude", "ShorelineLook.warp.scale"])?;
        self.web_warp.check(["ShorelineLook.web_warp.amplitude", "ShorelineLook.web_warp.scale"])
    }
}

impl ContactLook {
    fn check(&self) -> Result<(), Error> {
        range("ContactLook.depth", self.depth, 1.0e-6, 1.0e6)?;
        range("ContactLook.particle_depth", self.particle_depth.unwrap_or(1.0), 1.0e-6, 1.0e6)?;
        range("ContactLook.mask", self.mask, 0.0, 1.0)?;
        range("ContactLook.mask_scale", self.mask_scale, 0.0, 100.0)?;
        for speed in self.mask_speed {
            range("ContactLook.mask_speed", speed, -1000.0, 1000.0)?;
        }
        range("ContactLook.lit", self.lit, 0.0, 1.0)?;
        let most = if self.lit > 0.0 { 1.0 } else { f32::MAX };
        self.color.into_iter().try_for_each(|c| range("ContactLook.color", c, 0.0, most))?;
        range("ContactLook.opacity", self.opacity, 0.0, 1.0)?;
        range("ContactLook.particle_opacity", self.particle_opacity, 0.0, 1.0)
    }
}
