//! Compares the snapshot's twin with closed forms.

use super::super::BUBBLE;
use super::super::tests::{SPACING, close, close_all, fluid, random_fluid, settings};
use super::*;

/// Each fluid particle makes 8 per second, whether it moves or not.
fn all_make() -> Settings {
    let limits = [-2.0, -1.0];
    Settings {
        trapped_air: limits,
        energy: limits,
        trapped_air_rate: 8.0,
        wave_crest_rate: 0.0,
        ..settings()
    }
}

/// Water along the x axis: particles a quarter of a support apart, with a velocity for each x.
fn line(from: f32, particles: usize, velocity: impl Fn(f32) -> [f32; 3]) -> Fluid {
    let one = |n| {
        let x = from + 0.25 * n as f32;
        ([x, 0.0, 0.0], velocity(x))
    };
    fluid(&(0..particles).map(one).collect::<Vec<_>>())
}

#[track_caller]
fn stages(fluid: &Fluid, settings: &Settings, i: usize) -> [Stage; STAGES] {
    Snapshot::new(fluid, settings, 5).stages(i).expect("it takes part")
}

#[test]
fn stages_are_a_life_together() {
    let settings = settings();
    close((0..STAGES).map(|k| share(k, &settings)).sum(), 4.0);
    for k in 0..STAGES {
        // Each stage lies in the interval that it stands for.
        let [begin, end] = [0.0, 1.0].map(|random| seconds(k, random, &settings));
        close(end - begin, share(k, &settings));
        close(begin, (0..k).map(|k| share(k, &settings)).sum());
    }
    close(seconds(2, 0.5, &settings), 4.0 * 2.5 * 2.5 / 225.0);

    // In a flow that makes equally many everywhere, the sum is the rate times the lifetime.
    let flow = line(-40.0, 200, |_| [6.0, 0.0, 0.0]);
    let same = Settings { lifetime: [4.0; 2], ..all_make() };
    let stages = stages(&flow, &same, 180);
    close(stages.iter().map(|stage| stage.make).sum(), 8.0 * 4.0);
    let seed = seed_of_step(&same, 5);
    for (k, stage) in stages.iter().enumerate() {
        close(stage.seconds, seconds(k, uniform_of(seed, 187, 0), &same));
        let chance = uniform_of(seed, 187, 1 + k as u32);
        let make = 8.0 * share(k, &same);
        let more = u32::from(chance < make - make.floor());
        assert_eq!(stage.count, make.floor() as u32 + more);
    }
}

#[test]
fn a_way_in_a_flow_is_straight() {
    let velocity = [3.0, 0.0, -0.25];
    let flow = line(-20.0, 120, |_| velocity);
    let x = 8.0;
    for stage in &stages(&flow, &all_make(), 112)[..11] {
        let s = stage.seconds;
        close_all(stage.place, [x - 3.0 * s, 0.0, 0.25 * s]);
        assert!(stage.off < 0.1, "{stage:?}");
    }
}

#[test]
fn a_way_goes_with_the_water_it_is_in() {
    // The first step uses the particle's own velocity, and then the water moves downwards.
    let mut flow = line(-40.0, 170, |_| [0.0, -0.0625, 0.0]);
    flow.positions.push([50.0, 0.0, 0.0]);
    flow.velocities.push([1.0, 0.0, 0.0]);
    flow.ids.push(3000);
    let s = stages(&flow, &all_make(), 170).map(|stage| stage.seconds);
    flow.velocities[170][0] = (51.0 / s[0]) as f32;
    let stages = stages(&flow, &all_make(), 170);
    for (stage, s_k) in stages.iter().zip(s) {
        let expected = [-1.0, 0.0625 * (s_k - s[0]), 0.0];
        assert!((stage.place - DVec3::from(expected)).length() < 1e-4, "{stage:?}");
    }
}

#[test]
fn a_way_ends_with_the_water() {
    // The water begins at 0, so there is none before -1, a support away.
    let flow = line(0.0, 9, |_| [2.0, 0.0, 0.0]);
    let (mut both, mut nothing) = ([0; 2], 0);
    for i in 0..9 {
        for stage in stages(&flow, &all_make(), i) {
            let x = f64::from(flow.positions[i][0]) - 2.0 * stage.seconds;
            let living = alive(stage.seconds, &all_make()) > 0.0;
            assert_eq!(stage.make > 0.0, x > -1.0 && living, "{stage:?}");
            both[usize::from(x > -1.0)] += 1;
            // The GPU decides in the same way, within the error of the position.
            let none = stage.counts == [0; 2];
            assert!(none || x > -1.01 - stage.off, "{stage:?}");
            nothing += u32::from(none && living);
        }
    }
    assert!(both.iter().all(|n| *n > 10) && nothing > 10, "{both:?} {nothing}");

    // After a gap, water farther back does not count.
    let mut gap = line(0.0, 9, |_| [2.0, 0.0, 0.0]);
    gap.positions[0] = [-6.0, 0.0, 0.0];
    gap.positions[1] = [-5.5, 0.0, 0.0];
    let beyond = stages(&gap, &all_make(), 8).into_iter().filter(|stage| stage.seconds > 1.6);
    let beyond = beyond.map(|stage| stage.make).collect::<Vec<_>>();
    assert!(beyond.len() > 4 && beyond.iter().all(|make| *make == 0.0), "{beyond:?}");

    // A lone particle is water for itself.
    let alone = fluid(&[([0.0; 3], [4.0, 0.0, 0.0])]);
    for stage in stages(&alone, &all_make(), 0) {
        // The particle leaves its own support once the first step is a support long.
        let first = seconds(0, uniform_of(seed_of_step(&all_make(), 5), 7, 0), &all_make());
        let place = DVec3::new(-4.0 * stage.seconds, 0.0, 0.0);
        assert!(first < 0.25 / 4.0);
        assert!(place.x <= -1.0 || (stage.place - place).length() < 1e-9, "{stage:?}");
        assert_eq!(stage.make > 0.0, stage.seconds < 0.25, "{stage:?}");
    }
}

#[test]
fn still_water_makes_what_its_place_does() {
    // Together with the first particle, the second has a trapped air of 1 with a W of 3/4, so it
    // makes 3/4; K is 0.71875.
    let p = [([0.0; 3], [0.0; 3]), ([0.25, 0.0, 0.0], [0.0; 3]), ([9.0; 3], [0.0; 3])];
    let still = fluid(&p);
    let settings = Settings {
        trapped_air: [-2.0, -1.0],
        wave_crest_rate: 0.0,
        energy: [-1.0, 1.0],
        trapped_air_rate: 8.0,
        ..settings()
    };
    // At rest the rate is half of the max.
    for stage in stages(&still, &settings, 0) {
        close_all(stage.place, [0.0; 3]);
        let part = share_by_hand(&stage);
        close(stage.make, 4.0 * part);
    }
    // A particle half a scene unit aside that moves across, with W = 1/2 and K = 1/4, makes the
    // max.
    let mut moved = still;
    moved.positions[2] = [0.0, 0.5, 0.0];
    moved.velocities[2] = [1e-3, 2.0, 0.0];
    let snapshot = Snapshot::new(&moved, &settings, 5);
    let water = snapshot.water(DVec3::ZERO, 0.0);
    let weight = 1.0 + 0.71875 + 0.25;
    close(water.rate.is, (4.0 * 1.71875 + 8.0 * 0.25) / weight);
    close_all(water.velocity, [1e-3 * 0.25 / weight, 0.5 / weight, 0.0]);
    assert!(water.is && !water.loose);
    assert!(water.rate.least < water.rate.is && water.rate.is < water.rate.most);
    assert!(water.rate.most - water.rate.least < 0.01);
}

/// Seconds that a stage stands for, with lifetimes of 2 to 4 s, reduced by the particles that are
/// already dead.
fn share_by_hand(stage: &Stage) -> f64 {
    let k = (15.0 * (stage.seconds / 4.0).sqrt()).floor();
    let alive = if stage.seconds < 2.0 { 1.0 } else { (4.0 - stage.seconds) / 2.0 };
    4.0 * (2.0 * k + 1.0) / 225.0 * alive
}

#[test]
fn lives_end_between_their_limits() {
    let settings = settings();
    for (seconds, part) in [(0.0, 1.0), (1.9, 1.0), (2.0, 1.0), (2.5, 0.75), (3.0, 0.5)] {
        close(alive(seconds, &settings), part);
    }
    for seconds in [4.0, 4.5, 1e9] {
        assert_eq!(alive(seconds, &settings), 0.0);
    }
    let same = Settings { lifetime: [4.0; 2], ..settings };
    assert_eq!([3.999, 4.001].map(|s| alive(s, &same)), [1.0, 0.0]);
}

#[test]
fn counts_are_of_chance_and_limited() {
    for (make, chance, expected) in [
        (0.0, 0.0, 0),
        (0.25, 0.2, 1),
        (0.25, 0.25, 0),
        (2.75, 0.7, 3),
        (2.75, 0.8, 2),
        (3.0, 0.0, 3),
        (62.5, 0.1, 63),
        (63.0, 0.0, 63),
    ] {
        assert_eq!(count(make, chance), expected, "{make} {chance}");
    }
    let flow = line(-40.0, 200, |_| [6.0, 0.0, 0.0]);
    let many = Settings { trapped_air_rate: 1e6, ..all_make() };
    let counts = stages(&flow, &many, 180).map(|stage| (stage.make, stage.counts));
    assert!(counts[..12].iter().all(|c| *c == (63.0, [63; 2])), "{counts:?}");
}

/// A river that is turbulent upstream, where it is pulled sideways, and calm downstream. Foam
/// downstream left the turbulent water long ago, and its age is that time.
#[test]
fn foam_downstream_is_as_old_as_its_way_is_long() {
    let speed = 4.0;
    let rough = |x: f32| (-1.0..=1.0).contains(&x);
    let river = line(-20.0, 200, |x| {
        let across = if rough(x) { 0.5 * (4.0 * x).rem_euclid(2.0) - 0.25 } else { 0.0 };
        [speed as f32, across, 0.0]
    });
    let settings = Settings {
        trapped_air: [0.01, 0.02],
        energy: [0.0, 1.0],
        trapped_air_rate: 200.0,
        wave_crest_rate: 0.0,
        lifetime: [4.0; 2],
        ..settings()
    };
    let snapshot = Snapshot::new(&river, &settings, 5);
    let mut made = 0;
    for i in (0..200).filter(|i| river.positions[*i][0] > 4.0) {
        let x = f64::from(river.positions[i][0]);
        // Neighbours of turbulent water also trap air, and their neighbours find them within a
        // support.
        let [soonest, latest] = [(x - 3.0) / speed, (x + 3.0) / speed];
        let [from, to] = [(x - 0.5) / speed, (x + 0.5) / speed];
        for stage in snapshot.stages(i).expect("it takes part") {
            let s = stage.seconds;
            if s < soonest || s > latest {
                assert_eq!(stage.make, 0.0, "{x}: {stage:?}");
            } else if (from..to).contains(&s) {
                assert!(stage.make > 1.0, "{x}: {stage:?}");
            }
            for m in 0..stage.count {
                let young = snapshot.newborn(i, m, s);
                assert_eq!(young.kind, FOAM);
                close(young.age, s / 4.0);
                made += 1;
            }
        }
    }
    assert!(made > 1000, "{made}");
    assert_eq!(snapshot.all().len(), {
        let all = (0..200).filter_map(|i| snapshot.stages(i)).flatten();
        all.map(|stage| stage.count as usize).sum::<usize>()
    });
}

#[test]
fn newborns_are_about_the_way_ahead() {
    // Two lines of ten particles side by side, so that foam is made.
    let places = (0..20_u32).map(|n| [0.1 * (n % 10) as f32, 0.1 * (n / 10) as f32, 0.0]);
    let water = |v| fluid(&places.clone().map(|x| (x, v)).collect::<Vec<_>>());
    let settings = settings();
    for velocity in [[1.0, 2.0, -2.0], [0.0, 0.0, -3.0], [0.0; 3]] {
        let water = water(velocity);
        let snapshot = Snapshot::new(&water, &settings, 5);
        let v = DVec3::from(velocity.map(f64::from));
        let ahead = if v == DVec3::ZERO { DVec3::Y } else { v.normalize() };
        let (mut farthest, mut ages) = ([0.0_f64; 2], [9.0_f64, 0.0]);
        for (i, m) in (0..20).flat_map(|i| (0..40).map(move |m| (i, m))) {
            let young = snapshot.newborn(i, m, 1.5);
            let from = young.position - DVec3::from(water.positions[i].map(f64::from));
            let along = from.dot(ahead);
            let aside = from - along * ahead;
            assert!((young.velocity - v - aside).length() < 1e-9);
            farthest = [farthest[0].max(along), farthest[1].max(aside.length())];
            assert!((-1e-9..0.5).contains(&along) && aside.length() <= 0.25);
            // Its lifetime is between 2 and 4 s.
            assert!(young.kind == FOAM && (0.375..=0.75).contains(&young.age), "{young:?}");
            ages = [ages[0].min(young.age), ages[1].max(young.age)];
        }
        let moves = v != DVec3::ZERO;
        assert_eq!(farthest[0] > 0.49, moves, "{farthest:?}");
        assert!(farthest[1] > 0.245 && ages[0] < 0.377 && ages[1] > 0.745, "{ages:?}");
    }
    // Foam older than the min lifetime lives from 3 to 4 s.
    let water = water([1.0; 3]);
    let snapshot = Snapshot::new(&water, &settings, 5);
    let ages = (0..200).map(|m| snapshot.newborn(0, m, 3.0).age).collect::<Vec<_>>();
    assert!(ages.iter().all(|age| (0.75..1.0).contains(age)), "{ages:?}");
    assert!(ages.iter().any(|age| *age > 0.98) && ages.iter().any(|age| *age < 0.76));
    // Computed separately: newborn 2 of id 9 at step 5.
    let id = snapshot.newborn(2, 2, 1.0).id;
    assert_eq!(id, 1_933_975_240);
}

#[test]
fn bubbles_are_new() {
    let places = (0..30_u32).map(|n| ([0.02 * n as f32, 0.0, 0.0], [1.0; 3]));
    let deep = fluid(&places.collect::<Vec<_>>());
    let settings = settings();
    let snapshot = Snapshot::new(&deep, &settings, 5);
    assert_eq!(snapshot.potentials(3).map(|p| p.neighbours), Some(29));
    let young = snapshot.newborn(3, 0, 1.0);
    assert_eq!((young.kind, young.age), (BUBBLE, 0.0));
}

#[test]
fn the_grid_finds_all_that_is_farther_off() {
    let water = random_fluid(500);
    let grid = Grid::new(&water, SPACING);
    for supports in [0.3, 1.0, 1.7, 2.6] {
        let place = DVec3::new(1.0, 1.6, 0.2);
        let quickly = grid.within(place, supports);
        let mut found = quickly.map(|near| near.part.index).collect::<Vec<_>>();
        found.sort_unstable();
        let parts = water.parts(SPACING);
        let slowly = parts.filter(|part| (place - part.position).length() < supports);
        assert_eq!(found, slowly.map(|part| part.index).collect::<Vec<_>>());
        assert!(supports < 0.5 || found.len() > 20);
    }
}

/// Computes like the GPU: in fixed-point steps and single precision.
#[test]
fn ways_of_whole_steps_are_as_near_as_said() {
    let settings = Settings {
        trapped_air: [1.0, 8.0],
        trapped_air_rate: 30.0,
        wave_crest_rate: 0.0,
        lifetime: [0.25, 0.5],
        ..settings()
    };
    let water = random_fluid(1200);
    let snapshot = Snapshot::new(&water, &settings, 5);
    let rates = snapshot.rates.iter().map(|rate| rate.is as f32).collect::<Vec<_>>();
    let unit = unit(&settings) as f32;
    let most_rate = 30.0 / 65536.0_f32;
    let parts = water.parts(SPACING).collect::<Vec<_>>();
    let (mut sure, mut all) = (0, 0);
    for i in (0..1200).step_by(11) {
        let Some(stages) = snapshot.stages(i) else { continue };
        let own = parts.iter().find(|part| part.index == i).expect("it takes part");
        let random = uniform_of(snapshot.seed, water.ids[i], 0) as f32;
        let at = |k: usize| 0.5 * ((k as f32 + random) / 15.0) * ((k as f32 + random) / 15.0);
        let mut place = own.position.as_vec3() - at(0) * own.velocity.as_vec3();
        for (k, stage) in stages.iter().enumerate() {
            all += 1;
            let away = (place.as_dvec3() - stage.place).length();
            assert!(away <= stage.off, "{i} {k}: {away} of {}", stage.off);
            let (mut weights, mut sum, mut rate) = (0.0_f32, glam::Vec3::ZERO, 0.0_f32);
            for part in &parts {
                let q = (place - part.position.as_vec3()).length();
                if q < 1.0 {
                    let weight = kernel(q.into()) as f32;
                    weights += (weight * 65536.0).round();
                    sum += (part.velocity.as_vec3() * (weight / unit)).round();
                    rate += (rates[part.index] * (weight / most_rate)).round();
                }
            }
            if weights == 0.0 {
                let none = stages[k..].iter().all(|stage| stage.counts[0] == 0);
                assert!(none, "{i} {k}: {stages:?}");
                break;
            }
            let make = rate * most_rate * 65536.0 / weights * 0.5 * (2 * k + 1) as f32 / 225.0
                * alive(at(k).into(), &settings) as f32;
            let chance = uniform_of(snapshot.seed, water.ids[i], 1 + k as u32);
            let found = count(make.into(), chance);
            let [least, most] = stage.counts;
            assert!((least..=most).contains(&found), "{i} {k}: {found} of {stage:?}");
            sure += usize::from(least == most);
            place -= (at(k + 1) - at(k)) * (sum * (unit * 65536.0 / weights));
        }
    }
    assert!(3 * sure > 2 * all, "{sure} of {all} are sure");
}
