//! Settings of shoreline foam (*Semi-procedural foam shader*, an indie developer's blog, 2019) and of contact foam
//! (D. Lettier, *3D Game Shaders For Beginners*, Foam). Lengths are in the scene's unit, metres for what is said of
//! defaults, which are for an island of a hundred of them.

use std::f64::consts::TAU;

use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(ShoreConfig, ShoreLook, ShorelineLook, ContactLook);

/// Most layers of the web.
pub const LAYERS: usize = 4;

/// What of shoreline and contact foam costs memory or pipelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShoreConfig {
    /// Where foam begins and ends in a pixel.
    pub edge: Edge,
    /// Edge of the web's texture in texels, a power of two from 16 to 2048, default 512. 25⅓ bytes each.
    pub web_size: u32,
    /// What the built-in web and noise are made of, default 1.
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

/// The edge of shoreline foam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Edge {
    /// As much of a pixel as the foam covers of it, by the derivatives of the foam and by what of it is too fine for the
    /// pixel. Default: it neither crawls nor sparkles.
    Smooth,
    /// A pixel is foam or not: the source's.
    Clip,
    /// As alpha to coverage of four samples averages to: quarters of what [`Smooth`](Self::Smooth) says, dithered over two by
    /// two pixels.
    Coverage,
}

/// How shoreline and contact foam look.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ShoreLook {
    /// Seconds since some beginning, finite; what moves is found from it in 64 bits. Default 0.
    pub time: f64,
    /// All repeats after so many seconds, [0.1, 1e6]: speeds are rounded to whole numbers of periods. `None` (default): it
    /// does not.
    pub period: Option<f32>,
    /// Foam along shores.
    pub shoreline: ShorelineLook,
    /// Foam round what stands in the water.
    pub contact: ContactLook,
}

impl ShoreLook {
    /// The same look, in metres, in a world of so many units a metre.
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
    /// Its largest value, [-1000, 1000], in the unit of what it is added to.
    pub amplitude: f32,
    /// Repetitions a metre, [0, 100]; its coarsest cells are a quarter of one wide.
    pub scale: f32,
}

impl Noise {
    /// None.
    pub const NONE: Self = Self { amplitude: 0.0, scale: 0.0 };

    const fn new(amplitude: f32, scale: f32) -> Self {
        Self { amplitude, scale }
    }

    fn check(&self, [amplitude, scale]: [&'static str; 2]) -> Result<(), Error> {
        range(amplitude, self.amplitude, -1000.0, 1000.0)?;
        range(scale, self.scale, 0.0, 100.0)
    }
}

/// Shoreline foam: what is foam where
///
/// `wave_ratio · (sin((frequency + n₁)·v + phase) + a·v + b) + web_ratio · (web + a'·v + b') ≥ threshold + n₂`
///
/// with v 0 at the sea's edge, 1 at the shore, 2 inland (the blog, Sec. IV to VIII).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShorelineLook {
    /// Metres of foam to sea and inland of the shore, (0, 1e6], where v is found from a distance; default 12 and 3. A strip
    /// has its own v.
    pub reach: [f32; 2],
    /// Radians of the waves per v, [0, 1000], default 13: two of them from the sea's edge to the shore.
    pub frequency: f32,
    /// Radians a second, [-1000, 1000], default -0.9: towards the shore; more than 0, out to sea, as the blog's.
    pub speed: f32,
    /// How much of the speed is a coming and going, 0 (none) to 1 (all), default 0.35.
    pub swing: f32,
    /// Radians of that to either side, [0, 1000], default 2.2, and seconds of it, [0.1, 1e6], default 7.
    pub swing_by: [f32; 2],
    /// On the frequency; default 5, 1/90 m.
    pub frequency_noise: Noise,
    /// On the speed, radians a second; default 0.35, 1/90 m. It swings, or places would drift apart without end.
    pub speed_noise: Noise,
    /// Seconds of that swing, [0.1, 1e6], default 11.
    pub speed_period: f32,
    /// The waves' a and b, [-100, 100]; default 1.1 and -0.75.
    pub wave_rise: [f32; 2],
    /// Waves are no less than this, [-100, 100]; `None` (default): the mix has no floor, the blog's first steps have 0.
    pub floor: Option<f32>,
    /// Of the waves in the mix, [0, 100], default 0.34.
    pub wave_ratio: f32,
    /// Of the web in the mix, [0, 100], default 0.66.
    pub web_ratio: f32,
    /// The web's a' and b', [-100, 100]; default 0.95 and -0.62.
    pub web_rise: [f32; 2],
    /// Of the web; default two of them.
    pub layers: [WebLayer; LAYERS],
    /// Bends the web, metres; default 0.7, 1/18 m.
    pub web_warp: Noise,
    /// Metres a second by which that noise moves, [-1000, 1000], default 0.35 and 0.2.
    pub web_warp_speed: [f32; 2],
    /// Foam is where the mix is at least this, [-100, 100], default 0.39.
    pub threshold: f32,
    /// On the threshold; default 0.1, 1/90 m.
    pub threshold_noise: Noise,
    /// On both affine parts, so that foam reaches farther here than there; default 0.22, 1/90 m.
    pub rise_noise: Noise,
    /// Bends all but v, metres; default none.
    pub warp: Noise,
    /// Within so much v of the sea's edge foam ends, [0.001, 1], default 0.2; and of the inland edge.
    pub fade: f32,
    /// Albedo, linear RGB, 0 to 1; default 0.9 of each.
    pub color: [f32; 3],
    /// 0 to 1, default 1.
    pub opacity: f32,
}

/// One layer of the web.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WebLayer {
    /// How much of it there is in the web, [0, 1]; 0: none.
    pub weight: f32,
    /// Repetitions a metre, [0, 100].
    pub scale: f32,
    /// Degrees by which it is turned.
    pub angle: f32,
    /// Metres a second by which it moves, [-1000, 1000].
    pub speed: [f32; 2],
}

impl WebLayer {
    /// None.
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

/// Contact foam: the more the nearer what is behind the water's surface lies (Lettier).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactLook {
    /// Metres at which there is none left, on the host's surface, (0, 1e6], default 0.4 (the source has 4 in units of its
    /// own).
    pub depth: f32,
    /// The same on the particles' water; `None` (default): four spacings.
    pub particle_depth: Option<f32>,
    /// What those metres are.
    pub measure: Measure,
    /// How much the mask takes away, 0 (none) to 1 (all where it is black), default 0.8.
    pub mask: f32,
    /// Repetitions of the web a metre, which is the mask where the host has none, [0, 100], default 1/2.2.
    pub mask_scale: f32,
    /// Metres a second by which it moves, [-1000, 1000], default 0.05 and 0.03.
    pub mask_speed: [f32; 2],
    /// Albedo, linear RGB, 0 to 1, default the source's (0.8, 0.85, 0.92 in sRGB); with `lit` of 0 radiance, [0, ∞).
    pub color: [f32; 3],
    /// What of its light is the sun's and the sky's, 0 (it glows by itself) to 1 (default).
    pub lit: f32,
    /// On the host's surface, 0 (none) to 1 (default).
    pub opacity: f32,
    /// On the particles' water, 0 (none, default) to 1.
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

/// How far what is behind the surface is from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Measure {
    /// The distance between both points of the pixel: what the source's demo does. Default.
    Distance,
    /// The difference of their depths along the view: what its text says.
    View,
    /// Of their heights; no foam where what is behind is not below.
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

    /// Where something that goes round `rate` times a second is, 0 to 1.
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
