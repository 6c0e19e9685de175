//! When water foams: the Weber number from which on it does, of the data themselves.

use whitewater::Settings;
use whitewater::io::particles::Particles;
use whitewater::water::FoamSettings;

use crate::args::Foaming;

/// Share of the water that does not foam.
const CALM: f64 = 0.95;

/// The settings for frames of a sequence, where they have velocities. A threshold does not transfer
/// from one simulation to another: where none is given it is taken from the frames.
pub fn settings(
    wanted: Foaming,
    frames: &[Particles],
    settings: &Settings,
) -> Option<FoamSettings> {
    let foam = FoamSettings::reduced(settings.water.spacing, 1.0);
    let foam = FoamSettings { rest_density: settings.water.rest_density, ..foam };
    let mut moving = frames.iter().filter(|frame| frame.velocities.is_some());
    let threshold = match wanted {
        Foaming::None => return None,
        Foaming::From(threshold) => moving.next().map(|_| threshold)?,
        Foaming::Auto => {
            let spray = settings.spray.densities[0] * settings.water.rest_density;
            let mut numbers: Vec<f32> =
                moving.flat_map(|frame| numbers(frame, &foam, spray)).collect();
            numbers.sort_unstable_by(f32::total_cmp);
            *numbers.get((numbers.len() as f64 * CALM) as usize)?
        }
    };
    // Water at rest does not foam.
    (threshold > 0.0).then_some(FoamSettings { threshold, ..foam })
}

/// Weber numbers of the particles that are no spray.
fn numbers(frame: &Particles, foam: &FoamSettings, spray: f32) -> Vec<f32> {
    let density = |i: usize| frame.densities.as_ref().map_or(foam.rest_density, |d| d[i]);
    let velocities = frame.velocities.iter().flatten().enumerate();
    velocities
        .filter(|(i, _)| density(*i) >= spray)
        .map(|(i, v)| foam.scale * density(i) * v.iter().map(|c| c * c).sum::<f32>())
        .filter(|number| number.is_finite())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitewater::io::particles::Extension;
    use whitewater::io::particles::read_bytes;

    /// A hundred particles, each faster than the one before.
    fn csv() -> Particles {
        let rows = (0..100).map(|i| format!("0,{i},0,{i},0,0\n"));
        let text = format!("x,y,z,vx,vy,vz\n{}", rows.collect::<String>());
        read_bytes(text.as_bytes(), Extension::Csv).unwrap()
    }

    #[test]
    fn the_fastest_twentieth_foams() {
        let mut frame = csv();
        let look = Settings::default();
        let of = |wanted, frame: &Particles| settings(wanted, std::slice::from_ref(frame), &look);
        let found = of(Foaming::Auto, &frame).unwrap();
        let number = |speed: f32| found.scale * 1000.0 * speed * speed;
        assert!((found.threshold / number(95.0) - 1.0).abs() < 1.0e-5, "{found:?}");
        assert_eq!(of(Foaming::From(7.0), &frame).unwrap().threshold, 7.0);
        assert!(of(Foaming::None, &frame).is_none());
        // Spray is no water: then it is the particle before.
        frame.densities = Some((0..100).map(|i| if i > 95 { 1.0 } else { 1000.0 }).collect());
        let without = of(Foaming::Auto, &frame).unwrap();
        assert!((without.threshold / number(91.0) - 1.0).abs() < 1.0e-5, "{without:?}");
        frame.velocities = Some(vec![[0.0; 3]; 100]);
        assert!(of(Foaming::Auto, &frame).is_none(), "water at rest");
        frame.velocities = None;
        assert!(of(Foaming::Auto, &frame).is_none() && of(Foaming::From(7.0), &frame).is_none());
    }
}
