//! Settings of shoreline foam (*Semi-procedural foam shader*, an indie developer's blog, 2019) and of contact
//! foam (D. Lettier, *3D Game Shaders For Beginners*, Foam). Lengths are in scene units. The defaults are for scene
//! units of one metre, and suit an island about a hundred metres wide.

use std::f64::consts::TAU;

use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(ShoreConfig, ShoreSettings, ShorelineSettings, ContactSettings);

/// Maximum number of foam texture layers.
pub const LAYERS: usize = 4;

/// Configuration of shoreline and contact foam. It determines what memory and which pipelines are created.
/// `default()` makes it, and [`with`](Self::with) changes its fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShoreConfig {
    /// How a pixel at the edge of foam is computed.
    #[cfg(feature = "diagnostics")]
    pub edge: Edge,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) edge: Edge,
    /// Side length of the foam texture in texels, a power of two from 16 to 2048, default 512. The texture takes
    /// 25⅓ bytes of memory per texel.
    pub texture_size: u32,
    /// Seed of the built-in foam texture and noise, default 1.
    pub seed: u32,
}

impl Default for ShoreConfig {
    fn default() -> Self {
        Self { edge: Edge::Smooth, texture_size: 512, seed: 1 }
    }
}

impl ShoreConfig {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let size = self.texture_size;
        if size.is_power_of_two() && (16..=2048).contains(&size) {
            return Ok(());
        }
        let why = format!("expected a power of two from 16 to 2048, found {size}");
        Err(Error::bad("Config.shore.texture_size", why))
    }
}

/// How a pixel at the edge of shoreline foam is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Edge {
    /// A pixel gets the fraction of it that foam covers, estimated from the screen-space derivatives of the value
    /// that is compared with the threshold and from the variance of its detail finer than the pixel. Default, because
    /// edges of foam neither crawl nor sparkle.
    Smooth,
    /// A pixel is foam or not, as in the blog.
    Clip,
    /// A pixel gets the covered fraction of [`Smooth`](Self::Smooth), quantised to quarters and dithered over 2×2
    /// pixels, as the average of four alpha-to-coverage samples would be.
    Coverage,
}

/// Appearance of shoreline and contact foam.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ShoreSettings {
    /// Time in seconds, finite, default 0. All motion of shoreline and contact foam is computed from it in 64 bits.
    pub time: f64,
    /// Time after which all motion repeats, seconds, [0.1, 1e6]. For that, each speed is rounded to a whole number of
    /// cycles per period. `None` (default): no repetition.
    pub period: Option<f32>,
    /// Foam along shores.
    pub shoreline: ShorelineSettings,
    /// Foam around objects in the water.
    pub contact: ContactSettings,
}

impl ShoreSettings {
    /// Converts the lengths and velocities of these settings from metres to scene units. `units_per_metre` is the
    /// number of scene units per metre.
    #[must_use]
    pub fn in_units(mut self, units_per_metre: f32) -> Self {
        let longer = |length: &mut f32| *length *= units_per_metre;
        let wider = |scale: &mut f32| *scale /= units_per_metre;
        let shore = &mut self.shoreline;
        [&mut shore.sea_reach, &mut shore.land_reach]
            .into_iter()
            .chain(&mut shore.texture_warp_velocity)
            .for_each(longer);
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
        // The amplitude of these noises is a length, too.
        for warp in [&mut shore.texture_warp, &mut shore.warp] {
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
    /// Factor of the noise, which has the mean 0 and the maximum absolute value 1. [-1000, 1000], in the unit of the
    /// quantity to which the product is added.
    pub amplitude: f32,
    /// Repetitions of the noise texture per scene unit, [0, 100]. The coarsest cells of the noise are a quarter of a
    /// repetition wide.
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
/// ```text
/// wave_weight · (sin((frequency + n₁)·v + phase) + a·v + b + n₃)
///     + texture_weight · (web + a'·v + b' + n₃) ≥ threshold + n₂
/// ```
///
/// In this condition for foam the shore coordinate v is 0 at the foam's seaward edge, 1 at the shore line and 2 at
/// the foam's inland edge (the blog, Sec. IV to VIII). The phase changes over time by `speed`, `swing` and
/// `speed_noise`. a and b are `wave_slope` and `wave_offset`, a' and b' are `texture_slope` and `texture_offset`.
/// `web` is the foam texture: the sum of its `layers`, each times its weight. n₁, n₂ and n₃ are `frequency_noise`,
/// `threshold_noise` and `rise_noise`. `fade` reduces the foam further near v = 0 and v = 2.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShorelineSettings {
    /// Width of the foam seawards of the shore line, scene units, (0, 1e6], default 12. It converts a distance from
    /// the shore to v; it has no effect on a strip, whose vertices give v themselves.
    pub sea_reach: f32,
    /// Width of the foam inland of the shore line, scene units, (0, 1e6], default 3. Land that rises above the water's
    /// surface hides this foam, except where it lies at most `bias` of [`Shore`](crate::Shore) in front of the surface.
    /// The width converts a distance from the shore to v; it has no effect on a strip, whose vertices give v
    /// themselves.
    pub land_reach: f32,
    /// Wave frequency in radians per unit of v, [0, 1000], default 13: two waves between the foam's seaward edge and
    /// the shore line.
    pub frequency: f32,
    /// Wave speed in radians of phase per second, [-1000, 1000], default -0.9. With a negative speed waves run
    /// towards the shore; with a positive one, as in the blog, out to sea.
    pub speed: f32,
    /// Share of the waves' motion that is an oscillation to and fro instead of an advance with `speed`, 0 (none) to 1
    /// (all), default 0.35. `speed` is multiplied by 1 − `swing`, `swing_amplitude` by `swing`.
    pub swing: f32,
    /// Amplitude of the oscillation of the waves' phase, radians, [0, 1000], default 2.2. It is multiplied by
    /// `swing`.
    pub swing_amplitude: f32,
    /// Period of the oscillation, seconds, [0.1, 1e6], default 7.
    pub swing_period: f32,
    /// Noise added to the frequency, radians per unit of v. Default: amplitude 5, scale 1/90 (one repetition in 90 scene units).
    pub frequency_noise: Noise,
    /// Noise added to the wave speed, radians per second. Default: amplitude 0.35, scale 1/90 (one repetition in 90 scene units). At each
    /// place the added speed oscillates over time around 0, because with a constant added speed the phases of
    /// different places would drift apart without limit.
    pub speed_noise: Noise,
    /// Period of the oscillation of `speed_noise`, seconds, [0.1, 1e6], default 11.
    pub speed_period: f32,
    /// Slope a of the waves over v, [-100, 100], default 1.1.
    pub wave_slope: f32,
    /// Offset b of the waves, [-100, 100], default -0.75.
    pub wave_offset: f32,
    /// Lower limit at which the waves' term `sin((frequency + n₁)·v + phase) + a·v + b + n₃` is clamped before it is
    /// weighted, [-100, 100]. `None` (default): no limit. The blog's first steps use 0.
    pub floor: Option<f32>,
    /// Weight of the waves in the mix, [0, 100], default 0.34.
    pub wave_weight: f32,
    /// Weight of the foam texture in the mix, [0, 100], default 0.66.
    pub texture_weight: f32,
    /// Slope a' of the foam texture over v, [-100, 100], default 0.95.
    pub texture_slope: f32,
    /// Offset b' of the foam texture, [-100, 100], default -0.62.
    pub texture_offset: f32,
    /// Layers of the foam texture. Default: two.
    pub layers: [TextureLayer; LAYERS],
    /// Noise that displaces the positions at which the foam texture is looked up, scene units. Default: amplitude
    /// 0.7, scale 1/18 (one repetition in 18 scene units).
    pub texture_warp: Noise,
    /// Velocity of the positions at which the noise of `texture_warp` is looked up, along the two horizontal axes
    /// ([`Area::axes`](super::Area::axes)), scene units per second, [-1000, 1000], default 0.35 and 0.2. The noise
    /// thus moves the opposite way over the water.
    pub texture_warp_velocity: [f32; 2],
    /// Threshold: there is foam where the mix of waves and foam texture is at least this plus
    /// [`threshold_noise`](Self::threshold_noise). [-100, 100], default 0.39.
    pub threshold: f32,
    /// Noise added to the threshold. Default: amplitude 0.1, scale 1/90 (one repetition in 90 scene units).
    pub threshold_noise: Noise,
    /// Noise n₃ added to both `wave_offset` and `texture_offset`, so that from place to place along the shore the foam
    /// reaches less or more far out. Default: amplitude 0.22, scale 1/90 (one repetition in 90 scene units).
    pub rise_noise: Noise,
    /// Noise that displaces, in scene units, the positions at which the foam texture and all other noises are looked
    /// up. The shore coordinate v, which runs across the shore, is not displaced. Default: none.
    pub warp: Noise,
    /// Width of the bands in which foam fades out, at its seaward edge and at its inland edge, in units of the
    /// coordinate v, which runs across the shore; [0.001, 1], default 0.2.
    pub fade: f32,
    /// Albedo, linear RGB, 0 to 1; default 0.9 of each.
    pub color: [f32; 3],
    /// Opacity, 0 to 1, default 1.
    pub opacity: f32,
}

/// One layer of the foam texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureLayer {
    /// Weight of the layer, [0, 1], 0 = off.
    pub weight: f32,
    /// Repetitions per scene unit, [0, 100].
    pub scale: f32,
    /// Rotation in degrees, [-1e6, 1e6].
    pub angle: f32,
    /// Velocity of the positions at which the layer is looked up, along the two horizontal axes
    /// ([`Area::axes`](super::Area::axes)), scene units per second, [-1000, 1000]. The layer thus moves the opposite
    /// way over the water.
    pub speed: [f32; 2],
}

impl TextureLayer {
    /// No layer.
    pub const NONE: Self = Self { weight: 0.0, scale: 0.0, angle: 0.0, speed: [0.0; 2] };
}

impl Default for ShorelineSettings {
    fn default() -> Self {
        let layer = |weight, scale, angle, speed| TextureLayer { weight, scale, angle, speed };
        Self {
            sea_reach: 12.0,
            land_reach: 3.0,
            frequency: 13.0,
            speed: -0.9,
            swing: 0.35,
            swing_amplitude: 2.2,
            swing_period: 7.0,
            frequency_noise: Noise::new(5.0, 1.0 / 90.0),
            speed_noise: Noise::new(0.35, 1.0 / 90.0),
            speed_period: 11.0,
            wave_slope: 1.1,
            wave_offset: -0.75,
            floor: None,
            wave_weight: 0.34,
            texture_weight: 0.66,
            texture_slope: 0.95,
            texture_offset: -0.62,
            layers: [
                layer(0.65, 1.0 / 10.5, 0.0, [0.12, 0.07]),
                layer(0.35, 1.0 / 6.4, 37.0, [-0.1, 0.13]),
                TextureLayer::NONE,
                TextureLayer::NONE,
            ],
            texture_warp: Noise::new(0.7, 1.0 / 18.0),
            texture_warp_velocity: [0.35, 0.2],
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

/// Contact foam: foam on water around the objects in it. The closer the scene is behind the water's surface, the more
/// foam there is (Lettier).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactSettings {
    /// Distance between water surface and scene, measured as [`measure`](Self::measure) says, at which contact foam
    /// ends on the application's own water surface, scene units, (0, 1e6], default 0.4. (The tutorial has 4 in its
    /// own units.)
    pub depth: f32,
    /// Distance between water surface and scene, measured as [`measure`](Self::measure) says, at which contact foam
    /// ends on the particles' water, scene units, (0, 1e6]. `None` (default): four particle spacings.
    pub particle_depth: Option<f32>,
    /// How the distance between water surface and scene is measured.
    pub measure: Measure,
    /// Strength of the mask that removes contact foam, 0 (no effect) to 1 (no foam where the mask is black), default
    /// 0.8.
    pub mask: f32,
    /// Repetitions per scene unit, [0, 100], default 1/2.2, of the foam texture where it serves as mask of contact
    /// foam, because the application gives no mask.
    pub mask_scale: f32,
    /// Velocity of the positions at which the foam texture is looked up where it serves as mask of contact foam, along
    /// the two horizontal axes ([`Area::axes`](super::Area::axes)), scene units per second, [-1000, 1000], default
    /// 0.05 and 0.03. The mask thus moves the opposite way over the water.
    pub mask_speed: [f32; 2],
    /// Albedo of contact foam, linear RGB, 0 to 1, default the tutorial's (0.8, 0.85, 0.92 in sRGB). If `lit` is 0,
    /// it is the radiance that the foam emits, [0, ∞).
    pub color: [f32; 3],
    /// Mix of emission and reflection: 0, the foam emits `color` as its radiance; 1 (default), it reflects sun and
    /// sky with `color` as its albedo.
    pub lit: f32,
    /// Opacity of contact foam on the application's own water surface, 0 (none) to 1 (default).
    pub opacity: f32,
    /// Opacity of contact foam on the particles' water, 0 (none, default) to 1.
    pub particle_opacity: f32,
}

impl Default for ContactSettings {
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

/// How the distance between the water's surface and the scene behind it is measured, at each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Measure {
    /// The distance from the water's surface to the scene along the pixel's view ray, as in the tutorial's program.
    /// Default.
    Distance,
    /// The eye depth of the scene less that of the water's surface at the pixel (along the view axis), as in the
    /// tutorial's text.
    View,
    /// The height of the water's surface less that of the scene which the pixel shows behind it. Where the pixel's view
    /// ray does not descend, there is no contact foam.
    Vertical,
}

impl ShoreSettings {
    pub(crate) fn check(&self) -> Result<(), Error> {
        if !self.time.is_finite() {
            return Err(Error::bad("Settings.shore.time", "not finite"));
        }
        range("Settings.shore.period", self.period.unwrap_or(1.0), 0.1, 1.0e6)?;
        self.shoreline.check()?;
        self.contact.check()
    }

    /// Phase, 0 to 1 cycle, at `self.time` of a motion that repeats `rate` times per second. With a `period`, `rate`
    /// is rounded to a whole number of cycles per period.
    pub(crate) fn turned(&self, rate: f64) -> f64 {
        let rate = match self.period {
            Some(period) => (rate * f64::from(period)).round() / f64::from(period),
            None => rate,
        };
        (rate * self.time).rem_euclid(1.0)
    }

    /// Returns the phase of the waves at the settings' time in radians, and the factor in seconds with which
    /// `speed_noise` (radians per second) is multiplied before it is added to the phase.
    pub(crate) fn phases(&self) -> [f32; 2] {
        let s = &self.shoreline;
        let (by, seconds) = (f64::from(s.swing_amplitude), f64::from(s.swing_period));
        let swing = f64::from(s.swing);
        let straight = self.turned((1.0 - swing) * f64::from(s.speed) / TAU) * TAU;
        let swung = swing * by * (self.turned(1.0 / seconds) * TAU).sin();
        // The derivative of `local` by time is a cosine with amplitude 1, so the noise is in radians per second.
        let period = f64::from(s.speed_period);
        let local = period / TAU * (self.turned(1.0 / period) * TAU).sin();
        [(straight + swung).rem_euclid(TAU) as f32, local as f32]
    }
}

impl ShorelineSettings {
    fn check(&self) -> Result<(), Error> {
        for (field, value) in [
            ("Settings.shore.shoreline.sea_reach", self.sea_reach),
            ("Settings.shore.shoreline.land_reach", self.land_reach),
        ] {
            range(field, value, 1.0e-6, 1.0e6)?;
        }
        range("Settings.shore.shoreline.frequency", self.frequency, 0.0, 1000.0)?;
        range("Settings.shore.shoreline.speed", self.speed, -1000.0, 1000.0)?;
        range("Settings.shore.shoreline.swing", self.swing, 0.0, 1.0)?;
        range("Settings.shore.shoreline.swing_amplitude", self.swing_amplitude, 0.0, 1000.0)?;
        range("Settings.shore.shoreline.swing_period", self.swing_period, 0.1, 1.0e6)?;
        range("Settings.shore.shoreline.speed_period", self.speed_period, 0.1, 1.0e6)?;
        range("Settings.shore.shoreline.floor", self.floor.unwrap_or(0.0), -100.0, 100.0)?;
        range("Settings.shore.shoreline.wave_weight", self.wave_weight, 0.0, 100.0)?;
        range("Settings.shore.shoreline.texture_weight", self.texture_weight, 0.0, 100.0)?;
        range("Settings.shore.shoreline.wave_slope", self.wave_slope, -100.0, 100.0)?;
        range("Settings.shore.shoreline.wave_offset", self.wave_offset, -100.0, 100.0)?;
        range("Settings.shore.shoreline.texture_slope", self.texture_slope, -100.0, 100.0)?;
        range("Settings.shore.shoreline.texture_offset", self.texture_offset, -100.0, 100.0)?;
        range("Settings.shore.shoreline.threshold", self.threshold, -100.0, 100.0)?;
        range("Settings.shore.shoreline.fade", self.fade, 0.001, 1.0)?;
        range("Settings.shore.shoreline.opacity", self.opacity, 0.0, 1.0)?;
        let pairs = [(
            "Settings.shore.shoreline.texture_warp_velocity",
            self.texture_warp_velocity,
            1000.0,
        )];
        for (field, pair, most) in pairs {
            pair.into_iter().try_for_each(|value| range(field, value, -most, most))?;
        }
        self.color
            .into_iter()
            .try_for_each(|c| range("Settings.shore.shoreline.color", c, 0.0, 1.0))?;
        for layer in &self.layers {
            range("Settings.shore.shoreline.layers.weight", layer.weight, 0.0, 1.0)?;
            range("Settings.shore.shoreline.layers.scale", layer.scale, 0.0, 100.0)?;
            range("Settings.shore.shoreline.layers.angle", layer.angle, -1.0e6, 1.0e6)?;
            layer.speed.into_iter().try_for_each(|value| {
                range("Settings.shore.shoreline.layers.speed", value, -1000.0, 1000.0)
            })?;
        }
        self.frequency_noise.check([
            "Settings.shore.shoreline.frequency_noise.amplitude",
            "Settings.shore.shoreline.frequency_noise.scale",
        ])?;
        self.speed_noise.check([
            "Settings.shore.shoreline.speed_noise.amplitude",
            "Settings.shore.shoreline.speed_noise.scale",
        ])?;
        self.threshold_noise.check([
            "Settings.shore.shoreline.threshold_noise.amplitude",
            "Settings.shore.shoreline.threshold_noise.scale",
        ])?;
        self.rise_noise.check([
            "Settings.shore.shoreline.rise_noise.amplitude",
            "Settings.shore.shoreline.rise_noise.scale",
        ])?;
        self.warp.check([
            "Settings.shore.shoreline.warp.amplitude",
            "Settings.shore.shoreline.warp.scale",
        ])?;
        self.texture_warp.check([
            "Settings.shore.shoreline.texture_warp.amplitude",
            "Settings.shore.shoreline.texture_warp.scale",
        ])
    }
}

impl ContactSettings {
    fn check(&self) -> Result<(), Error> {
        range("Settings.shore.contact.depth", self.depth, 1.0e-6, 1.0e6)?;
        range(
            "Settings.shore.contact.particle_depth",
            self.particle_depth.unwrap_or(1.0),
            1.0e-6,
            1.0e6,
        )?;
        range("Settings.shore.contact.mask", self.mask, 0.0, 1.0)?;
        range("Settings.shore.contact.mask_scale", self.mask_scale, 0.0, 100.0)?;
        for speed in self.mask_speed {
            range("Settings.shore.contact.mask_speed", speed, -1000.0, 1000.0)?;
        }
        range("Settings.shore.contact.lit", self.lit, 0.0, 1.0)?;
        let most = if self.lit > 0.0 { 1.0 } else { f32::MAX };
        self.color
            .into_iter()
            .try_for_each(|c| range("Settings.shore.contact.color", c, 0.0, most))?;
        range("Settings.shore.contact.opacity", self.opacity, 0.0, 1.0)?;
        range("Settings.shore.contact.particle_opacity", self.particle_opacity, 0.0, 1.0)
    }
}
