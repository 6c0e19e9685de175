//! A level sea, drawn by a ray per pixel: its properties, and its waves at a given time.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::Scene;
use crate::error::Error;

/// Number of waves that are summed.
pub(super) const WAVES: usize = 28;
/// Ratio of a wave's length to that of the next longer wave.
const SHORTER: f64 = 0.85;
/// Ratio of a wave's steepness to that of the next longer wave.
const FLATTER: f64 = 0.93;
/// Acceleration by gravity: 9.81 m/s², with a world unit taken as a metre.
const GRAVITY: f64 = 9.81;

/// A level sheet of water with gentle waves, or of lava, that extends to the horizon. Lengths are in world units, y is
/// up. The speed of the waves follows from gravity, for which a world unit is taken as a metre.
///
/// The sheet is visible but not in the depth buffer: the scene's depth and shadow map stay those of the ground below.
/// Water absorbs and scatters light along the refracted ray, but shows the scene along the straight one:
/// refraction moves no edges, it only makes the patterns on surfaces under water waver. Sunlight is focused on
/// the floor (caustics). Solids cast no shadow on the surface of water, which reflects only the environment and the
/// sun. A camera below the sheet's level does not see the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Sea {
    /// Mean height, default 0.
    pub level: f32,
    /// Absorption per world unit, linear RGB, [0, ∞), default that of a clear sea in a scene in metres.
    pub absorption: [f32; 3],
    /// Isotropic scattering per world unit, linear RGB, [0, ∞), default that of a clear sea in a scene in metres.
    pub scattering: [f32; 3],
    /// Height of the largest waves from trough to crest, world units, [0, ∞), default 0.22; 0 makes the water a flat
    /// mirror. Lava has no waves.
    pub waves: f32,
    /// Length of the largest waves, world units, (0, ∞), default 11. For lava: size of its crust's plates.
    pub length: f32,
    /// Direction of the largest waves, or of the lava's flow: world x and z, any length except 0, default [0.8,
    /// 0.6].
    pub towards: [f32; 2],
    /// Period in seconds, (0, ∞), after which the sea's motion repeats: the frequency of each wave is rounded to the
    /// nearest multiple of 1 / period, but not to 0. If the sea is lava, two copies of its flow cross-fade, of which
    /// one is a period behind the other. `None`, the default: the motion does not repeat.
    pub period: Option<f32>,
    /// Liquid, default water.
    pub liquid: Liquid,
}

/// Liquid of a [`Sea`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Liquid {
    /// Transparent, with the sea's absorption and scattering.
    #[default]
    Water,
    /// Opaque: a dark crust with glowing cracks. Its glow lights the scene's ground and meshes above the level of the
    /// lava. How strongly is estimated from their height above this level and their slope alone, as if lava were
    /// below them everywhere. Otherwise lava casts no light.
    Lava {
        /// Radiance of the hottest parts of the lava's cracks, linear RGB in the unit of the output, [0, ∞).
        radiance: [f32; 3],
        /// Speed of its flow, world units per second.
        speed: f32,
    },
}

impl Default for Sea {
    fn default() -> Self {
        Self {
            level: 0.0,
            absorption: [0.50, 0.058, 0.019],
            scattering: [0.002, 0.009, 0.014],
            waves: 0.22,
            length: 11.0,
            towards: [0.8, 0.6],
            period: None,
            liquid: Liquid::Water,
        }
    }
}

impl Liquid {
    /// Slow lava with a brightness for daylight.
    pub const LAVA: Self = Self::Lava { radiance: [6.0, 3.2, 0.2], speed: 0.5 };
}

impl Sea {
    /// Whether it is static.
    pub fn rests(&self) -> bool {
        match self.liquid {
            Liquid::Water => self.waves == 0.0,
            Liquid::Lava { speed, .. } => speed == 0.0,
        }
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        let light = |c: &[f32; 3]| c.iter().all(|v| v.is_finite() && *v >= 0.0);
        let number = |good: bool, field: &'static str, expected: &str, found: String| match good {
            true => Ok(()),
            false => Err(Error::bad(field, format!("expected {expected}, found {found}"))),
        };
        let least = "finite values of at least 0";
        let Self { level, absorption, scattering, waves, length, towards, period, liquid } = self;
        number(level.is_finite(), "Scene.sea.level", "a finite height", level.to_string())?;
        let found = |c: &[f32; 3]| format!("{c:?}");
        number(light(absorption), "Scene.sea.absorption", least, found(absorption))?;
        number(light(scattering), "Scene.sea.scattering", least, found(scattering))?;
        let good = waves.is_finite() && *waves >= 0.0;
        number(good, "Scene.sea.waves", "a finite height of at least 0", waves.to_string())?;
        let good = length.is_finite() && *length > 0.0;
        number(good, "Scene.sea.length", "a finite length above 0", length.to_string())?;
        let [x, z] = *towards;
        let good = x.hypot(z).is_finite() && x.hypot(z) > 0.0;
        number(good, "Scene.sea.towards", "finite, of some length", format!("{towards:?}"))?;
        let good = period.is_none_or(|t| t.is_finite() && t > 0.0);
        number(good, "Scene.sea.period", "finite seconds above 0", format!("{period:?}"))?;
        if let Liquid::Lava { radiance, speed } = liquid {
            number(light(radiance), "Scene.sea.liquid.radiance", least, found(radiance))?;
            let good = speed.is_finite();
            number(good, "Scene.sea.liquid.speed", "a finite speed", speed.to_string())?;
        }
        Ok(())
    }

    /// Direction of the largest waves, normalized.
    fn ahead(&self) -> DVec2 {
        DVec2::from(self.towards.map(f64::from)).normalize_or(DVec2::X)
    }

    /// The waves at a time in seconds, the longest first. Each has a wave number along x and one along z in radians
    /// per world unit, an amplitude in world units, and a phase in radians.
    pub(super) fn waves_at(&self, time: f64) -> [[f32; 4]; WAVES] {
        let longest = TAU / f64::from(self.length);
        let steepest = 0.5 * f64::from(self.waves) * longest;
        std::array::from_fn(|i| {
            let n = i as f64;
            let number = longest * SHORTER.powf(-n);
            // The directions spread evenly around that of the largest wave; short waves deviate more.
            let aside = (n * 0.618_034 + 0.5).fract() - 0.5;
            let turn = aside * PI * (0.5 + 0.6 * n / WAVES as f64);
            let wave = number * self.ahead().rotate(DVec2::from_angle(turn));
            // Dispersion of waves on deep water.
            let mut rate = (GRAVITY * number).sqrt();
            if let Some(period) = self.period {
                let whole = TAU / f64::from(period);
                rate = (rate / whole).round().max(1.0) * whole;
            }
            let phase = (2.4 * n * n + 1.7 * n - rate * time).rem_euclid(TAU);
            let height = steepest * FLATTER.powf(n) / number;
            [wave.x as f32, wave.y as f32, height as f32, phase as f32]
        })
    }

    /// For each wave: the phase is shifted by x · u.x + y · u.y radians, where u is the slow displacement that
    /// `unrest` in `sea.glsl` gives for each place; shorter waves are shifted more. z is the variance of the slopes
    /// of this wave and all shorter ones.
    pub(super) fn shifts_of(waves: &[[f32; 4]; WAVES]) -> [[f32; 4]; WAVES] {
        std::array::from_fn(|i| {
            let (more, turn) = (1.0 + 0.35 * i as f32, 2.1 * i as f32);
            let square = |[x, z, height, _]: &[f32; 4]| 0.5 * (x * x + z * z) * height * height;
            let rest = waves[i..].iter().map(square).sum();
            [more * turn.cos(), more * turn.sin(), rest, 0.0]
        })
    }

    /// Returns the distance that the lava has flowed by a time in seconds, in world units; with a period, that since
    /// the period's start. In the option (`None` without a period) are the distance of a second copy of the flow,
    /// which is a period behind (so negative), and the weight of this copy. The weight rises from 0 to 1, so that the
    /// copy has replaced the flow when the next period starts.
    pub(super) fn drift_at(&self, time: f64) -> (f32, Option<[f32; 2]>) {
        let speed = match self.liquid {
            Liquid::Lava { speed, .. } => f64::from(speed),
            Liquid::Water => 0.0,
        };
        match self.period.map(f64::from) {
            None => ((speed * time) as f32, None),
            Some(period) => {
                let passed = time.rem_euclid(period);
                let share = (passed / period) as f32;
                ((speed * passed) as f32, Some([(speed * (passed - period)) as f32, share]))
            }
        }
    }

    pub(super) fn flow(&self) -> [f32; 2] {
        self.ahead().as_vec2().to_array()
    }
}

impl Scene {
    /// The scene's sea (`None` without one) after a check of its values and of [`Scene::time`]; an error if one of
    /// them is out of range.
    pub(super) fn checked_sea(&self) -> Result<Option<&Sea>, Error> {
        let Some(sea) = &self.sea else { return Ok(None) };
        sea.check()?;
        match self.time.is_finite() {
            true => Ok(Some(sea)),
            false => {
                Err(Error::bad("Scene.time", format!("expected seconds, found {}", self.time)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_are_as_high_and_long_as_is_said_and_come_again() {
        let sea = Sea { period: Some(6.0), ..Sea::default() };
        let [x, z, height, _] = sea.waves_at(0.0)[0];
        assert!((x.hypot(z) * sea.length / TAU as f32 - 1.0).abs() < 1e-5);
        assert!((2.0 * height / sea.waves - 1.0).abs() < 1e-5);
        // At the loop's end all phases are whole turns from where they were.
        for (a, b) in sea.waves_at(1.5).iter().zip(sea.waves_at(7.5)) {
            let apart = f64::from(a[3] - b[3]).rem_euclid(TAU);
            assert!(apart.min(TAU - apart) < 1e-4, "{a:?} {b:?}");
        }
        assert_ne!(sea.waves_at(0.0), sea.waves_at(1.0));
    }

    /// The largest waves run where the sea says, and each crest has the speed of its length on deep water.
    #[test]
    fn crests_run_with_their_speed() {
        let towards = [-0.6, 0.8];
        let sea = Sea { towards, ..Sea::default() };
        let (before, after) = (sea.waves_at(0.0), sea.waves_at(0.01));
        let way = |wave: &[f32; 4]| DVec2::new(wave[0].into(), wave[1].into());
        assert!(way(&before[0]).normalize().distance(DVec2::from(towards.map(f64::from))) < 1e-6);
        for (a, b) in before.iter().zip(&after) {
            let number = way(a).length();
            let speed = (9.81 / number).sqrt();
            // A place that moves with a crest stays at its phase, which single precision rounds.
            let apart = (number * speed * 0.01 + f64::from(b[3] - a[3])).rem_euclid(TAU);
            assert!(apart.min(TAU - apart) < 1e-5, "{a:?} {b:?}");
        }
    }
}
