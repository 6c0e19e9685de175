//! Finds the Weber number from which water foams.

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use whitewater::Settings;
use whitewater::io::particles::Particles;
use whitewater::water::WeberSettings;

use crate::air;
use crate::args::Foaming;
use crate::settings::{FoamBy, SurfaceFoamTable};
use crate::smoothstep::smoothstep;

/// Quantile of the Weber numbers that becomes the threshold.
const CALM: f64 = 0.95;
/// Max share of a frame's particles that foam or still carry foam; with foam everywhere no water would be visible.
const MOST: f64 = 0.3;
/// Lower limit of the speed of trapped air at which water foams, as a height of fall in spacings: the speed that
/// water has after this fall. Particles of calm water tremble at half that speed, so that water at rest, and water
/// that flows or falls as a whole, stays clear.
const FALL: f32 = 0.125;
/// Default of [`SurfaceFoamTable::turbulence`]: the speed of the eddies that particles do not resolve, divided by the
/// speed of the water relative to the frame's mean velocity. For jets from nozzles this ratio is 0.003 to 0.08 (Ervine
/// et al. 1980); the value here is chosen by eye, for water that is already torn.
pub const TURBULENCE: f32 = 0.17;
/// Root mean square of the relative speeds of a particle's neighbours over its speed relative to the frame's mean
/// velocity: up to the first the water moves as one and has no eddies, from the second on it has all. In scenes of
/// `simulate` most particles have 0.04 to 0.12 in a chute and in the jets that leave it and a spout, and 0.2 to 0.7
/// where the water meets a pillar, a floor or a pool. The spacing there is 0.02 to 0.04 metres; in a smooth shear the
/// ratio falls with the spacing.
const COHERENT: [f32; 2] = [0.1, 0.3];
/// Gravity, m/s².
const GRAVITY: f32 = 9.81;
/// Speed relative to its surroundings, m/s, from which water entrains air. A plunging jet does from 0.8 m/s (rough) to
/// 2.5 m/s (smooth), from about 1 m/s if it is as turbulent as most jets (Ervine et al. 1980, "Effect of turbulence
/// intensity on the rate of air entrainment by plunging water jets"; Chanson 1996, "Air bubble entrainment in
/// free-surface turbulent shear flows").
pub const ONSET: f32 = 1.0;
/// A frame is calm if less than this share of its particles differs from the frame's median velocity by [`ONSET`]. If
/// all frames are calm, no water foams.
const STIRRED: f64 = 0.001;
/// Water counts as flowing as a whole if its median velocity is more than this many times as long as the median
/// deviation of the particles' velocities from it. Foam by speed then ignores the median velocity.
const UNIFORM: f32 = 2.0;

/// Finds the settings of foam formation from some frames of a sequence and their times in seconds; `None` if no water
/// foams or velocities are missing. A threshold does not transfer from one simulation to another, so if neither
/// `wanted` (--surface-foam) nor `table` (the settings file) sets one, it is found from the frames.
pub fn settings(
    wanted: Foaming,
    (table, by): (&SurfaceFoamTable, FoamBy),
    frames: &[Particles],
    seconds: &[f32],
    settings: &Settings,
) -> Option<WeberSettings> {
    let spacing = settings.water.spacing;
    let mut foam = table.formation(&settings.water);
    let found = wanted == Foaming::Auto && table.threshold.is_none();
    let flows: Vec<_> = frames.iter().filter(|_| found).filter_map(Flow::of).collect();
    if found && flows.iter().all(|flow| flow.fast < ONSET) {
        return None;
    }
    let number = |squared: f32| foam.scale * foam.rest_density * squared;
    let (driven, floor): (Vec<Particles>, _) = match by {
        FoamBy::Speed if found => {
            // Water that moves with the surrounding water does not foam, however fast both are.
            let flow = Flow::together(&flows);
            let floor = number(ONSET * ONSET);
            if table.air.is_none() && flow.median.length() > UNIFORM * flow.deviation {
                foam.air = flow.median.to_array();
            }
            (Vec::new(), floor)
        }
        FoamBy::Speed => (Vec::new(), 0.0),
        FoamBy::Air => {
            let floor = number(2.0 * GRAVITY * FALL * spacing);
            // The speed is relative to neighbours or the mean velocity, so the wind does not matter.
            foam.air = [0.0; 3];
            let turbulence = table.turbulence.unwrap_or(0.0);
            (frames.iter().map(|frame| driven(frame, spacing, turbulence)).collect(), floor)
        }
    };
    let frames = if by == FoamBy::Air { &driven } else { frames };
    let wanted = match (wanted, table.threshold) {
        (Foaming::Auto, Some(threshold)) => Foaming::From(threshold),
        (wanted, _) => wanted,
    };
    let mut moving = frames.iter().filter(|frame| frame.velocities.is_some());
    let threshold = match wanted {
        Foaming::None => return None,
        Foaming::From(threshold) => moving.next().map(|_| threshold)?,
        Foaming::Auto => {
            let spray = settings.spray.all_spray_density * settings.water.rest_density;
            let all = moving.flat_map(|frame| numbers(frame, &foam, spray)).map(|(_, n)| n);
            let calm = quantile(all.collect(), CALM)?;
            let calm = calm.max(of_lifetimes(frames, seconds, &foam, spray).unwrap_or(0.0));
            // A single frame foams if some particle exceeds half of the lower limit. Of a sequence only some frames
            // are known, so it foams unless all of them are at rest.
            let least = if frames.len() == 1 { 0.5 * floor } else { 0.0 };
            let some = |frame| numbers(frame, &foam, spray).iter().any(|(_, n)| *n > least);
            if by == FoamBy::Air && !frames.iter().any(some) {
                return None;
            }
            calm.max(floor)
        }
    };
    // Water at rest does not foam.
    (threshold > 0.0).then_some(foam.with(|it| it.threshold = threshold))
}

/// Motion of the water in a frame.
#[derive(Clone, Copy, Debug)]
struct Flow {
    median: Vec3,
    /// Distance of the particles' velocities from `median`: its median, and as `fast` its quantile at 1 - [`STIRRED`].
    deviation: f32,
    fast: f32,
}

impl Flow {
    fn of(frame: &Particles) -> Option<Self> {
        let velocities = frame.velocities.iter().flatten().map(|v| Vec3::from(*v));
        let velocities: Vec<Vec3> = velocities.filter(|v| v.is_finite()).collect();
        // The median of each component, which a few stray particles do not change.
        let middle = |axis: usize| quantile(velocities.iter().map(|v| v[axis]).collect(), 0.5);
        let median = Vec3::new(middle(0)?, middle(1)?, middle(2)?);
        let off: Vec<f32> = velocities.iter().map(|v| v.distance(median)).collect();
        let fast = quantile(off.clone(), 1.0 - STIRRED)?;
        Some(Self { median, deviation: quantile(off, 0.5)?, fast })
    }

    /// Combines frames; each may flow in another direction.
    fn together(flows: &[Self]) -> Self {
        let share = (flows.len().max(1) as f32).recip();
        let median = flows.iter().map(|flow| flow.median * share).sum();
        let off = |flow: &Self| flow.deviation.max(flow.median.distance(median));
        let deviation = flows.iter().map(off).fold(0.0, f32::max);
        Self { median, deviation, fast: flows.iter().map(|flow| flow.fast).fold(0.0, f32::max) }
    }
}

/// Returns substitutes for the velocities, if foam is driven by trapped air: for each particle a vector whose length
/// is the speed at which air is trapped. This is √(a² + e²), with a the speed at which neighbours approach, and e the
/// speed of the eddies that particles do not resolve: `turbulence` times the particle's speed relative to the frame's
/// mean velocity, where its neighbours move differently ([`COHERENT`]).
pub fn drive(particles: &Particles, spacing: f32, turbulence: f32) -> Option<Vec<[f32; 3]>> {
    let velocities = particles.velocities.as_ref()?;
    // Unlike the median, the mean does not jump from frame to frame where two bodies of water collide.
    let known = || velocities.iter().map(|v| Vec3::from(*v)).filter(|v| v.is_finite());
    let mean = known().map(|v| v.as_dvec3()).sum::<DVec3>() / known().count().max(1) as f64;
    let around = air::relative(&particles.positions, velocities, spacing);
    // As in `air::relative`, particles with a non-finite velocity have 0.
    let eddies = |v: &[f32; 3], spread: f32| {
        let speed = (Vec3::from(*v) - mean.as_vec3()).length();
        let is_valid = speed.is_finite() && speed > 0.0;
        if is_valid { turbulence * speed * smoothstep(COHERENT, spread / speed) } else { 0.0 }
    };
    let each = around.into_iter().zip(velocities);
    Some(each.map(|(one, v)| [one.trapped.hypot(eddies(v, one.spread)), 0.0, 0.0]).collect())
}

/// A frame with these vectors as velocities, and without positions.
fn driven(frame: &Particles, spacing: f32, turbulence: f32) -> Particles {
    Particles {
        velocities: drive(frame, spacing, turbulence),
        densities: frame.densities.clone(),
        ids: frame.ids.clone(),
        ..Particles::from_positions(Vec::new())
    }
}

/// The quantile of the numbers at `share`.
pub fn quantile(mut numbers: Vec<f32>, share: f64) -> Option<f32> {
    let at = (numbers.len() as f64 * share) as usize;
    (at < numbers.len()).then(|| *numbers.select_nth_unstable_by(at, f32::total_cmp).1)
}

/// Returns the Weber number as threshold at which in none of the given frames more than [`MOST`] of the particles
/// carry foam, that is, have exceeded it in this frame or in one less than foam's lifetime earlier; `None` without
/// ids.
fn of_lifetimes(
    frames: &[Particles],
    seconds: &[f32],
    foam: &WeberSettings,
    spray: f32,
) -> Option<f32> {
    let each: Vec<HashMap<u32, f32>> = frames
        .iter()
        .map(|frame| {
            let id = |(i, number): (usize, f32)| Some((*frame.ids.as_ref()?.get(i)?, number));
            numbers(frame, foam, spray).into_iter().filter_map(id).collect()
        })
        .collect();
    let lasts = |now: usize, then: usize| seconds[now] - seconds[then] < foam.foam_lifetime;
    let of_frame = |now: usize| {
        let most = |(id, number): (&u32, &f32)| {
            let before = (0..now).filter(|&then| lasts(now, then));
            before.filter_map(|then| each[then].get(id).copied()).fold(*number, f32::max)
        };
        quantile(each[now].iter().map(most).collect(), 1.0 - MOST)
    };
    (0..frames.len().min(seconds.len())).filter_map(of_frame).reduce(f32::max)
}

/// Indices and Weber numbers of the particles that are not spray.
fn numbers(frame: &Particles, foam: &WeberSettings, spray: f32) -> Vec<(usize, f32)> {
    // 0 marks a particle that was just emitted and has no sum yet.
    let known = |i: usize| frame.densities.as_ref().map(|d| d[i]).filter(|d| *d > 0.0);
    let density = |i: usize| known(i).unwrap_or(foam.rest_density);
    let velocities = frame.velocities.iter().flatten().enumerate();
    velocities
        .filter(|(i, _)| density(*i) >= spray)
        .map(|(i, v)| {
            let wind = Vec3::from(*v) - Vec3::from(foam.air);
            (i, foam.scale * density(i) * wind.length_squared())
        })
        .filter(|(_, number)| number.is_finite())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Weber;
    use whitewater::io::particles::Extension;
    use whitewater::io::particles::read_bytes;

    /// A hundred particles; each is faster than the previous one.
    fn csv() -> Particles {
        let rows = (0..100).map(|i| format!("0,{i},0,{i},0,0\n"));
        let text = format!("x,y,z,vx,vy,vz\n{}", rows.collect::<String>());
        read_bytes(text.as_bytes(), Extension::Csv).unwrap()
    }

    #[test]
    fn the_fastest_twentieth_foams() {
        let mut frame = csv();
        let look = Settings::default();
        let of = |wanted, frame: &Particles| {
            settings(
                wanted,
                (&SurfaceFoamTable::default(), FoamBy::Speed),
                std::slice::from_ref(frame),
                &[0.0],
                &look,
            )
        };
        let found = of(Foaming::Auto, &frame).unwrap();
        let number = |speed: f32| found.scale * 1000.0 * speed * speed;
        assert!((found.threshold / number(95.0) - 1.0).abs() < 1.0e-5, "{found:?}");
        assert_eq!(of(Foaming::From(7.0), &frame).unwrap().threshold, 7.0);
        assert!(of(Foaming::None, &frame).is_none());
        // Spray does not count as water, so the threshold is that of the next slower particle.
        frame.densities = Some((0..100).map(|i| if i > 95 { 1.0 } else { 1000.0 }).collect());
        let without = of(Foaming::Auto, &frame).unwrap();
        assert!((without.threshold / number(91.0) - 1.0).abs() < 1.0e-5, "{without:?}");
        // A particle that was just emitted has no density yet, and counts as water.
        frame.densities = Some(vec![0.0; 100]);
        assert_eq!(of(Foaming::Auto, &frame), Some(found));
        frame.velocities = Some(vec![[0.0; 3]; 100]);
        assert!(of(Foaming::Auto, &frame).is_none(), "water at rest");
        frame.velocities = None;
        assert!(of(Foaming::Auto, &frame).is_none() && of(Foaming::From(7.0), &frame).is_none());
    }

    /// Test: water that moves with the wind does not foam, and water at rest in wind does, because the Weber number
    /// uses the velocity relative to the wind (Eq. 3.1 of the thesis). This holds for its reduced and its full form.
    #[test]
    fn water_foams_by_its_speed_through_the_air() {
        let frame = csv();
        let of = |air: [f32; 3], weber| {
            let table = SurfaceFoamTable { air: Some(air), weber, ..SurfaceFoamTable::default() };
            let look = Settings::default();
            settings(
                Foaming::Auto,
                (&table, FoamBy::Speed),
                std::slice::from_ref(&frame),
                &[0.0],
                &look,
            )
            .unwrap()
        };
        for weber in [None, Some(Weber::Full)] {
            let against = of([-10.0, 0.0, 0.0], weber);
            let with = of([200.0, 0.0, 0.0], weber);
            let speed = |foam: WeberSettings| (foam.threshold / (foam.scale * 1000.0)).sqrt();
            assert!((speed(against) - 105.0).abs() < 1.0e-3, "{against:?}");
            // The slowest particles are now the fastest, from 101 to 200.
            assert!((speed(with) - 196.0).abs() < 1.0e-3, "{with:?}");
        }
        let said = SurfaceFoamTable { threshold: Some(7.0), ..SurfaceFoamTable::default() };
        let of = |wanted| {
            let look = Settings::default();
            settings(wanted, (&said, FoamBy::Speed), std::slice::from_ref(&frame), &[0.0], &look)
        };
        assert_eq!(of(Foaming::Auto).unwrap().threshold, 7.0);
        assert_eq!(of(Foaming::From(8.0)).unwrap().threshold, 8.0, "the command line goes first");
        assert!(of(Foaming::None).is_none());
    }

    /// Two blocks that collide foam where they meet. A block that flows at any speed does not, and neither does one
    /// that trembles.
    #[test]
    fn water_foams_where_it_traps_air() {
        let spacing = Settings::default().water.spacing;
        let at = |i: u16| [i % 16, i / 16 % 16, i / 256].map(|i| spacing * (f32::from(i) - 7.5));
        let mut frame = Particles::from_positions((0..4096).map(at).collect());
        let mut of = |velocity: &dyn Fn(usize, [f32; 3]) -> [f32; 3]| {
            let each = frame.positions.iter().enumerate().map(|(i, p)| velocity(i, *p));
            frame.velocities = Some(each.collect());
            let table = SurfaceFoamTable::default();
            let by = (&table, FoamBy::Air);
            let frames = std::slice::from_ref(&frame);
            settings(Foaming::Auto, by, frames, &[0.0], &Settings::default()).map(|found| {
                let numbers = numbers(&driven(&frame, spacing, 0.0), &found, 0.0);
                let foam = numbers.iter().filter(|(_, n)| *n >= found.threshold);
                (
                    foam.clone().count(),
                    foam.map(|(i, _)| frame.positions[*i][1].abs()).fold(0.0, f32::max),
                )
            })
        };
        assert_eq!(of(&|_, _| [0.0; 3]), None, "at rest");
        assert_eq!(of(&|_, _| [20.0, -7.0, 3.0]), None, "flows");
        let tremble = |i: usize, _| {
            [0.05 * ((i * 7919) as f32).sin(), 0.05 * ((i * 104_729) as f32).cos(), 0.0]
        };
        assert_eq!(of(&tremble), None, "trembles");
        assert_eq!(of(&|_, p| [0.0, -0.4 * p[1].signum(), 0.0]), None, "collides too slowly");
        let (count, farthest) = of(&|_, p| [0.0, -2.0 * p[1].signum(), 0.0]).unwrap();
        // Of two layers of 256 particles on either side, those with neighbours all around.
        assert!((100..=512).contains(&count) && farthest < 1.6 * spacing, "{count} {farthest}");
        frame.velocities = None;
        let by = (&SurfaceFoamTable::default(), FoamBy::Air);
        let frames = std::slice::from_ref(&frame);
        assert_eq!(settings(Foaming::Auto, by, frames, &[0.0], &Settings::default()), None);
    }

    /// A jet falls beside water at rest. A smooth one is glassy, however fast; a fast one whose particles move
    /// differently foams, because it is turbulent.
    #[test]
    fn a_fast_torn_jet_foams() {
        let look = Settings::default();
        let at = |i: u16| {
            let aside = if i < 3584 { 0.0 } else { 30.0 };
            let [x, y, z] = [i % 16, i / 16 % 16, i / 256].map(f32::from);
            [x + aside, y, z].map(|v| look.water.spacing * v)
        };
        let mut frame = Particles::from_positions((0..4096).map(at).collect());
        // Every second row of the jet is slower by the share `torn`.
        let mut of = |speed: f32, torn: f32| {
            let fall = |i: u16| {
                let slower = if (i / 16 + i / 256).is_multiple_of(2) { 1.0 - torn } else { 1.0 };
                [0.0, if i < 3584 { 0.0 } else { -speed * slower }, 0.0]
            };
            frame.velocities = Some((0..4096).map(fall).collect());
            let turbulence = Some(TURBULENCE);
            let table = SurfaceFoamTable { turbulence, ..SurfaceFoamTable::default() };
            let by = (&table, FoamBy::Air);
            let found = settings(Foaming::Auto, by, std::slice::from_ref(&frame), &[0.0], &look)?;
            let numbers = numbers(&driven(&frame, look.water.spacing, TURBULENCE), &found, 0.0);
            let foams = numbers.iter().filter(|(_, n)| *n >= found.threshold).map(|(i, _)| *i);
            Some(foams.collect::<Vec<_>>())
        };
        assert_eq!(of(9.0, 0.0), None, "smooth");
        assert_eq!(of(1.2, 0.02), None, "slow");
        let torn = of(9.0, 0.6).unwrap();
        assert!(torn.len() > 150 && torn.iter().all(|i| *i >= 3584), "{torn:?}");
        frame.velocities.as_mut().unwrap()[7] = [f32::NAN; 3];
        let found = drive(&frame, look.water.spacing, TURBULENCE).unwrap();
        assert_eq!(found[7], [0.0; 3], "a particle without a valid velocity");
        assert!(found.iter().all(|[speed, ..]| speed.is_finite()));
    }

    /// The eddies' speed is `turbulence` times the speed where neighbours move differently, and 0 where they do not.
    #[test]
    fn eddies_need_neighbours_that_move_differently() {
        let row = |i: u16| [0.1 * f32::from(i), 0.0, 0.0];
        let mut frame = Particles::from_positions((0..8).map(row).collect());
        // Neighbours recede from each other, which traps no air. The mean velocity is 0.
        let mut of = |gradient: f32| {
            let speeds = (0..8_u16).map(|i| {
                let side = if i < 4 { -1.0 } else { 1.0 };
                [gradient * (f32::from(i) - 3.5), 4.0 * side, 0.0]
            });
            frame.velocities = Some(speeds.collect());
            drive(&frame, 0.1, 0.2).unwrap()[1][0]
        };
        assert_eq!(of(0.0), 0.0);
        assert!((of(3.0) - 0.2 * 4.0_f32.hypot(7.5)).abs() < 1.0e-3, "all eddies: {}", of(3.0));
        // Particle 1 has the neighbours 0 and 2, one spacing away.
        let speed = |gradient: f32| (4.0_f32).hypot(2.5 * gradient);
        for gradient in [0.4, 0.8, 1.5] {
            let spread: f32 = gradient / speed(gradient);
            let t = ((spread - 0.1) / 0.2).clamp(0.0, 1.0);
            let wanted = 0.2 * speed(gradient) * t * t * (3.0 - 2.0 * t);
            assert!(
                (of(gradient) - wanted).abs() < 1.0e-3,
                "{gradient}: {} {wanted}",
                of(gradient)
            );
        }
    }

    /// Test of foam by speed: water that trembles weakly, flows as a whole or is slower than 1 m/s does not foam.
    /// Otherwise only particles foam whose velocity differs by at least [`ONSET`] from the common flow: the median
    /// velocity of all particles if the water flows as a whole, else 0.
    #[test]
    fn air_is_not_drawn_in_by_calm_water() {
        let noise = |i: usize, seed: usize| ((i * 7919 + seed * 104_729) as f32).sin();
        let of = |velocity: &dyn Fn(usize) -> [f32; 3]| {
            let mut frame = Particles::from_positions(vec![[0.0; 3]; 2000]);
            frame.velocities = Some((0..2000).map(velocity).collect());
            let by = (&SurfaceFoamTable::default(), FoamBy::Speed);
            let frames = [frame.clone(), frame];
            settings(Foaming::Auto, by, &frames, &[0.0, 0.1], &Settings::default())
        };
        let trembles = |size: f32| move |i| [1, 2, 3].map(|seed| size * noise(i, seed));
        assert_eq!(of(&trembles(0.003)), None, "millimetres a second");
        assert_eq!(of(&trembles(0.5)), None, "less than a metre a second");
        assert_eq!(of(&|_| [3.0, 0.0, 0.0]), None, "uniform");
        assert_eq!(of(&|i| [3.0 + 0.01 * noise(i, 1), 0.0, 0.01 * noise(i, 2)]), None, "a river");
        assert!(of(&trembles(3.0)).is_some());
        // A jet, one particle in a hundred, into a pool at rest: slower water does not foam, although a twentieth of
        // the particles would be above the quantile.
        let jet = of(&|i| [0.0, if i % 100 == 0 { -4.0 } else { 0.2 * noise(i, 1) }, 0.0]).unwrap();
        assert!((jet.threshold / (jet.scale * 1000.0) - ONSET * ONSET).abs() < 1.0e-4, "{jet:?}");
        assert_eq!(jet.air, [0.0; 3]);
        // The wake of a stone in a river.
        let wake = of(&|i| [if i % 50 == 0 { -1.0 } else { 3.0 }, 0.0, 0.0]).unwrap();
        assert_eq!(wake.air, [3.0, 0.0, 0.0], "the water's own speed does not count");
        // A threshold that the user sets is used unchanged.
        let mut frame = Particles::from_positions(vec![[0.0; 3]; 10]);
        frame.velocities = Some(vec![[0.001; 3]; 10]);
        let by = (&SurfaceFoamTable::default(), FoamBy::Speed);
        let said = Foaming::From(1.0e-6);
        assert!(settings(said, by, &[frame], &[0.0], &Settings::default()).is_some());
    }

    #[test]
    fn numbers_that_are_said_are_of_the_own_speed() {
        let of = |table: SurfaceFoamTable, wanted| table.by(wanted, false);
        assert_eq!(of(SurfaceFoamTable::default(), Foaming::Auto), FoamBy::Air);
        assert_eq!(
            SurfaceFoamTable::default().by(Foaming::Auto, true),
            FoamBy::Speed,
            "as in the thesis"
        );
        assert_eq!(of(SurfaceFoamTable::default(), Foaming::From(80.0)), FoamBy::Speed);
        let threshold =
            || SurfaceFoamTable { threshold: Some(80.0), ..SurfaceFoamTable::default() };
        assert_eq!(of(threshold(), Foaming::Auto), FoamBy::Speed);
        let wind = SurfaceFoamTable { air: Some([3.0, 0.0, 0.0]), ..SurfaceFoamTable::default() };
        assert_eq!(of(wind, Foaming::Auto), FoamBy::Speed);
        assert_eq!(
            of(SurfaceFoamTable { by: Some(FoamBy::Air), ..threshold() }, Foaming::Auto),
            FoamBy::Air
        );
    }

    /// Test of the limit [`MOST`]: in each of ten frames a different 4 % of the particles is fast, less than the
    /// twentieth that may foam. The particles that were fast within a lifetime of foam are more than three tenths.
    #[test]
    fn no_more_than_three_tenths_foam_at_a_time() {
        let mut frames: Vec<Particles> = (0..10)
            .map(|frame| {
                let speed = |i: usize| if i / 4 == frame { 9.0 } else { 0.04 * i as f32 };
                let mut particles = csv();
                particles.velocities = Some((0..100).map(|i| [speed(i), 0.0, 0.0]).collect());
                particles.ids = Some((0..100).collect());
                particles
            })
            .collect();
        let of = |frames: &[Particles], apart: f32| {
            let seconds: Vec<f32> = (0..10_u8).map(|i| apart * f32::from(i)).collect();
            let table = SurfaceFoamTable::default();
            let look = Settings::default();
            let found =
                settings(Foaming::Auto, (&table, FoamBy::Speed), frames, &seconds, &look).unwrap();
            (found.threshold / (found.scale * 1000.0)).sqrt()
        };
        assert!((of(&frames, 0.1) - 9.0).abs() < 1.0e-3, "{}", of(&frames, 0.1));
        assert!(of(&frames, 0.2) < 4.0, "five frames to a lifetime: two tenths");
        frames.iter_mut().for_each(|frame| frame.ids = None);
        assert!(of(&frames, 0.1) < 4.0, "nobody knows who they are");
    }
}
