//! `--whitewater generate`: spray, foam and bubbles emitted from the water's particles.

use glam::Vec3;
use whitewater::Settings;
use whitewater::headless::Headless;
use whitewater::io::particles::Particles;
use whitewater::{GeneratorSettings, PotentialRange};

use crate::bounds::Bounds;
use crate::failure::Outcome;
use crate::fluids;
use crate::looks::round;
use crate::placing::Placing;
use crate::session::PRE_ROLLED;
use crate::settings::SettingsFile;
use crate::settings::generate::GenerateTable;
use crate::surface_foam::quantile;
use crate::whitewater_source::{Columns, Sizes};

/// Default max number of whitewater particles alive at once.
const MOST: u32 = 1_000_000;
/// Fraction of the max number of whitewater particles that the chosen emission rates keep alive in the steady state,
/// in which as many are emitted as die.
const FULL: f64 = 0.5;
/// Quantile of the potentials, over all probed frames, that becomes the upper limit.
const NEARLY_ALL: f64 = 0.999;
/// Lower limit of a potential as a part of its upper limit.
const LEAST: f32 = 0.1;
/// Min values of the upper limits of the emission potentials trapped air, wave crest and energy, so that water at
/// rest emits nothing. The limit of energy is given as a speed. Trapped air and this speed are in units of √(gravity
/// · spacing), the speed after a fall through half a spacing. The values lie in the middle of limits that artists
/// chose.
const FLOORS: [f32; 3] = [15.0, 4.0, 4.0];
/// Max number of whitewater particles that one water particle emits per second; more would form a cloud around it.
const MOST_RATE: f64 = 4000.0;
/// Limits while the table's are unset.
const ANY: PotentialRange = PotentialRange { min: 0.0, max: 1.0 };
/// How far spray may fly beyond the water on each horizontal axis, as a part of the water's width on this axis.
const ASIDE: f32 = 0.1;

/// Emission of whitewater, and the probed frames from which its settings are found.
pub struct Generate {
    table: GenerateTable,
    spacing: f32,
    bounds: [[f32; 3]; 2],
    /// Duration of the sequence in seconds; `None` for single frames.
    seconds: Option<f32>,
    probes: Vec<Particles>,
    found: Option<GeneratorSettings>,
    /// Mean number of emitted particles of each kind (foam, spray, bubbles) in a vertical column that holds any of
    /// that kind, over the probed frames; `None` if there are none.
    columns: [Option<f32>; 3],
}

/// Finds the limits between which emission by trapped air, wave crests and energy rises, from the particles'
/// potentials. `fall` is gravity times spacing, half the squared speed after a fall through a spacing.
fn limits_of(potentials: &[[f32; 4]], fall: f32) -> [PotentialRange; 3] {
    let floors = [FLOORS[0] * fall.sqrt(), FLOORS[1], FLOORS[2] * FLOORS[2] * 0.5 * fall];
    [0, 1, 2].map(|which| {
        let values = potentials.iter().map(|all| all[which]).collect();
        let most = quantile(values, NEARLY_ALL).unwrap_or(0.0).max(floors[which]);
        PotentialRange { min: LEAST * most, max: most }
    })
}

impl Generate {
    /// Prepares the emission. `bounds` are those of the water in the probed frames `probes`, `seconds` is the
    /// duration of the sequence, if there is one. Fails if a value of `table` is out of range.
    pub fn new(
        table: GenerateTable,
        spacing: f32,
        bounds: &Bounds,
        seconds: Option<f32>,
        probes: Vec<Particles>,
    ) -> Outcome<Self> {
        let mut settings = GeneratorSettings::new(spacing, [ANY; 3], 0.0);
        table.apply(&mut settings);
        settings.check()?;
        // No walls confine the spray, so it is removed outside these bounds: those of the water over all probed
        // frames, slightly enlarged, and higher by the water's longest side.
        let size = bounds.max - bounds.min;
        let aside = Vec3::new(ASIDE * size.x, 0.0, ASIDE * size.z) + spacing;
        let up = Vec3::Y * size.max_element();
        let bounds = [bounds.min - aside, bounds.max + aside + up].map(|corner| corner.to_array());
        let moving = |frame: &Particles| frame.velocities.is_some();
        let probes = probes.into_iter().filter(moving).collect();
        let columns = [None; 3];
        Ok(Self { table, spacing, bounds, seconds, probes, found: None, columns })
    }

    /// Max number of whitewater particles alive at once.
    pub fn max_particles(&self) -> u32 {
        self.table.max_particles.unwrap_or(MOST)
    }

    /// Max number of water particles in a probed frame.
    pub fn probed(&self) -> usize {
        if self.found.is_some() {
            return 0;
        }
        self.probes.iter().map(|frame| frame.positions.len()).max().unwrap_or(0)
    }

    /// Returns the settings of the emission. The first call finds them from the probed frames, and also returns a
    /// message that says what was found.
    pub fn settings(
        &mut self,
        headless: &mut Headless,
    ) -> Outcome<(GeneratorSettings, Option<String>)> {
        if let Some(found) = self.found {
            return Ok((found, None));
        }
        let found = self.find(headless)?;
        self.columns = self.count(headless, &found)?;
        self.found = Some(found);
        self.probes = Vec::new();
        let limits =
            |limits: PotentialRange| format!("{} to {}", round(limits.min), round(limits.max));
        let line = format!(
            "whitewater particles from trapped air {}, wave crest {}, energy {}, {:.0} and {:.0} a second \
             (found; table [generate] sets them)",
            limits(found.trapped_air),
            limits(found.wave_crest),
            limits(found.energy),
            found.trapped_air_rate,
            found.wave_crest_rate,
        );
        Ok((found, Some(line)))
    }

    /// Sets size and opacity of the whitewater from how densely its particles lie, once the settings of the emission
    /// are found. Values in the settings file are kept, and so is the thesis' look.
    pub fn choose(&self, file: &SettingsFile, settings: &mut Settings) -> Option<String> {
        if file.is_thesis() || self.columns == [None; 3] {
            return None;
        }
        let Sizes { radii: [foam, spray, _], half } = Sizes::of_columns(self.columns, self.spacing);
        // All kinds have one radius: that of foam, the most frequent kind, if there is any.
        let radius = if self.columns[0].is_some() { foam } else { spray };
        let table = &file.whitewater;
        settings.whitewater.radius = table.radius.unwrap_or(radius);
        settings.whitewater.half_intensity_thickness =
            table.half_intensity_thickness.unwrap_or(half);
        let [radius, half] =
            [settings.whitewater.radius, settings.whitewater.half_intensity_thickness].map(round);
        Some(format!(
            "radius {radius} and half_intensity_thickness = {half} of whitewater particles (found; table [whitewater] sets them)"
        ))
    }

    /// Returns the mean number of whitewater particles of each kind in a vertical column that holds any of the kind,
    /// if each probed frame emits as a frame of its own. In a sequence a column has about as many.
    fn count(
        &self,
        headless: &mut Headless,
        settings: &GeneratorSettings,
    ) -> Outcome<[Option<f32>; 3]> {
        let mut columns = Columns::default();
        // A different capacity makes the frames that follow start without particles.
        let most = self.max_particles();
        let room = if most > 1 { most - 1 } else { 2 };
        self.each_probe(headless, |headless| {
            headless.generate_snapshot(0, settings, room)?;
            let made = headless.generated()?;
            let made =
                Particles { kinds: Some(made.kinds), ..Particles::from_positions(made.positions) };
            columns.add(&made, None, Placing::default(), self.spacing);
            columns.end_frame();
            Ok(())
        })?;
        Ok(columns.means())
    }

    fn find(&self, headless: &mut Headless) -> Outcome<GeneratorSettings> {
        let mut settings = GeneratorSettings::new(self.spacing, [ANY; 3], 0.0);
        settings.bounds = Some(self.bounds);
        self.table.apply(&mut settings);
        let mut potentials: Vec<[f32; 4]> = Vec::new();
        let frames = self.each_probe(headless, |headless| {
            headless.generate(0.0, 0, &settings, self.max_particles())?;
            potentials.extend(headless.potentials()?);
            Ok(())
        })?;
        let gravity = Vec3::from(settings.gravity).length();
        let [trapped_air, wave_crest, energy] = limits_of(&potentials, gravity * self.spacing);
        settings.trapped_air = trapped_air;
        settings.wave_crest = wave_crest;
        settings.energy = energy;
        self.table.apply(&mut settings);
        if self.table.rates.is_none() {
            let phi = |limits: PotentialRange, v: f32| {
                f64::from(((v - limits.min) / (limits.max - limits.min)).clamp(0.0, 1.0))
            };
            let each = potentials.iter().map(|&[air, crest, energy, _]| {
                phi(settings.energy, energy)
                    * (phi(settings.trapped_air, air) + phi(settings.wave_crest, crest))
            });
            let a_frame = each.sum::<f64>() / f64::from(frames.max(1));
            // In a short sequence emission stops before the steady state.
            let life = 0.5 * (settings.min_lifetime + settings.max_lifetime);
            let life =
                f64::from(self.seconds.map_or(life, |seconds| life.min(seconds + PRE_ROLLED)));
            // If the potentials are zero or tiny, the max rate applies.
            let rate_of = |seconds: f64| {
                (FULL * f64::from(self.max_particles()) / (seconds * a_frame)).min(MOST_RATE) as f32
            };
            let set = |settings: &mut GeneratorSettings, rate| {
                settings.trapped_air_rate = rate;
                settings.wave_crest_rate = rate;
            };
            set(&mut settings, rate_of(life));
            if self.seconds.is_none() {
                // In a single frame a splash emits less than this rate gives, because part of the water has just
                // arrived there.
                let mut made = 0.0;
                self.each_probe(headless, |headless| {
                    headless.generate_snapshot(0, &settings, self.max_particles())?;
                    let (shown, lost) = headless.generated_count()?;
                    made += f64::from(shown) + f64::from(lost);
                    Ok(())
                })?;
                let all = f64::from(frames.max(1)) * f64::from(settings.trapped_air_rate) * a_frame;
                let seconds = if all > 0.0 { made / all } else { 0.0 };
                set(&mut settings, rate_of(seconds + f64::from(PRE_ROLLED)));
            }
        }
        Ok(settings)
    }

    /// Calls `act` for each probed frame, with the particles of the fluid that emits; returns the number of frames.
    fn each_probe(
        &self,
        headless: &mut Headless,
        mut act: impl FnMut(&mut Headless) -> Outcome<()>,
    ) -> Outcome<u32> {
        let mut frames = 0;
        for frame in &self.probes {
            let Some(velocities) = &frame.velocities else { continue };
            headless.particles(&frame.positions, None)?;
            headless.motion(velocities, frame.ids.as_deref())?;
            frames += 1;
            let emitting = fluids::emitting(frame);
            if emitting.as_ref().is_none_or(|range| !range.is_empty()) {
                headless.show(emitting);
                act(headless)?;
            }
        }
        headless.show(None);
        Ok(frames)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test: a pool whose particles tremble at a tenth of √(gravity · spacing) emits nothing. The upper limits that
    /// are found are [`FLOORS`], and the particles' potentials are below all lower limits.
    #[test]
    fn a_calm_pool_makes_nothing() {
        for spacing in [0.02_f32, 0.5] {
            let fall = 9.81 * spacing;
            let calm = [fall.sqrt(), 0.3, 0.005 * fall, 30.0];
            let limits = limits_of(&vec![calm; 5000], fall);
            assert_eq!(limits.map(|limits| limits.max), [15.0 * fall.sqrt(), 4.0, 8.0 * fall]);
            assert_eq!(limits, limits_of(&[], fall));
            assert!(limits.iter().zip(calm).all(|(limits, potential)| potential < limits.min));
        }
    }

    /// Test: the upper limit of each emission potential is its quantile [`NEARLY_ALL`], the tenth largest value of 10
    /// 000 particles, also if most have a potential of 0.
    #[test]
    fn limits_are_by_nearly_all_particles() {
        let wild: Vec<_> = (0..10_000_u16).map(|i| [100.0 + f32::from(i); 4]).collect();
        for limits in limits_of(&wild, 1.0e-4) {
            assert_eq!((limits.max, limits.min), (10_090.0, LEAST * 10_090.0));
        }
        let few: Vec<_> =
            (0..10_000_u16).map(|i| [if i < 9_950 { 0.0 } else { f32::from(i) }; 4]).collect();
        assert_eq!(limits_of(&few, 1.0e-4)[1].max, 9_990.0);
    }
}
