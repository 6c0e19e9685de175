//! Compares the generator's twin with closed forms, and its random numbers with values computed
//! separately.

use super::motion::carried_by;
use super::water::{Grid, near};
use super::*;

/// The support radius is twice this, 1.
pub(super) const SPACING: f32 = 0.5;

/// All rates are 1, and all limits 0 to 1.
pub(super) fn settings() -> Settings {
    Settings {
        spacing: SPACING,
        gravity: [0.0, -10.0, 0.0],
        trapped_air: [0.0, 1.0],
        wave_crest: [0.0, 1.0],
        energy: [0.0, 1.0],
        trapped_air_rate: 1.0,
        wave_crest_rate: 1.0,
        lifetime: [2.0, 4.0],
        buoyancy: 2.0,
        drag: 0.5,
        seed: 3,
        bounds: None,
    }
}

/// A fluid with these positions and velocities, and the ids 7, 8, ...
pub(super) fn fluid(particles: &[([f32; 3], [f32; 3])]) -> Fluid {
    let (positions, velocities) = particles.iter().copied().unzip();
    Fluid { positions, velocities, ids: (7..).take(particles.len()).collect() }
}

/// A fluid at rest.
fn still(positions: &[[f32; 3]]) -> Fluid {
    fluid(&positions.iter().map(|x| (*x, [0.0; 3])).collect::<Vec<_>>())
}

/// The potentials of a fluid whose particles are all valid.
fn all(fluid: &Fluid) -> Vec<Potentials> {
    potentials(fluid, &settings()).into_iter().map(|p| p.expect("it takes part")).collect()
}

/// Potentials of a particle without trapped air, crest and neighbours.
fn nothing() -> Potentials {
    all(&still(&[[0.0; 3]]))[0]
}

/// A random position in a cube with this edge.
fn somewhere(id: u32, edge: f64) -> [f32; 3] {
    [0, 1, 2].map(|n| (edge * uniform_of(11, id, n)) as f32)
}

/// Random particles, every 17th of them invalid.
pub(super) fn random_fluid(particles: u32) -> Fluid {
    let one = |id| (somewhere(id, 3.0), somewhere(id + 100_000, 4.0).map(|v| v - 2.0));
    let mut fluid = fluid(&(0..particles).map(one).collect::<Vec<_>>());
    for i in (0..fluid.positions.len()).step_by(17) {
        fluid.positions[i][i % 3] = f32::NAN;
    }
    fluid
}

/// A block of 7^3 particles, a little closer than the spacing, centred at 0.
fn block() -> Fluid {
    let along = |n: usize| 0.48 * (n as f32 - 3.0);
    let place = |n: usize| [along(n % 7), along(n / 7 % 7), along(n / 49)];
    still(&(0..343).map(place).collect::<Vec<_>>())
}

fn foam(position: [f64; 3], velocity: [f64; 3]) -> Particle {
    let [position, velocity] = [position, velocity].map(DVec3::from);
    Particle { position, velocity, age: 0.25, kind: FOAM, id: 7 }
}

/// Particles on a circle around the origin, all with the same velocity.
fn ring(particles: u32, distance: f64, velocity: [f32; 3]) -> Vec<([f32; 3], [f32; 3])> {
    let place = |n| {
        let (sine, cosine) = (TAU * f64::from(n) / f64::from(particles)).sin_cos();
        ([(distance * cosine) as f32, 0.0, (distance * sine) as f32], velocity)
    };
    (0..particles).map(place).collect()
}

#[track_caller]
pub(super) fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-7, "{a} is not {b}");
}

#[track_caller]
pub(super) fn close_all(a: DVec3, b: [f64; 3]) {
    assert!((a - DVec3::from(b)).length() < 1e-7, "{a} is not {b:?}");
}

#[test]
fn air_is_trapped_by_what_comes_together() {
    let air = |velocities: [[f32; 3]; 2]| {
        let pair = fluid(&[([1.0; 3], velocities[0]), ([1.5, 1.0, 1.0], velocities[1])]);
        let [a, b] = [0, 1].map(|i| all(&pair)[i].trapped_air);
        close(a, b);
        a
    };
    // At a distance of half a support W is 1/2. Head on, the air is 2 |v_ij| W.
    close(air([[2.0, 0.0, 0.0], [0.0; 3]]), 2.0);
    close(air([[2.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]), 3.0);
    // Moving apart, together, sideways, and at 60 degrees.
    close(air([[-2.0, 0.0, 0.0], [0.0; 3]]), 0.0);
    close(air([[5.0, 1.0, 0.0]; 2]), 0.0);
    close(air([[0.0, 2.0, 0.0], [0.0; 3]]), 1.0);
    close(air([[1.0, 0.0, 3.0_f32.sqrt()], [0.0; 3]]), 1.5);
    // A term is at most 2^17 steps: 512 sqrt(10 s).
    close(air([[1e9, 0.0, 0.0], [0.0; 3]]), 1_144.866_804_479_892_4);
    assert!(air([[1144.0, 0.0, 0.0], [0.0; 3]]) < 1144.5);
}

/// The limit grows with gravity and spacing, so it is the same speed in every unit of length.
#[test]
fn the_limit_of_speeds_goes_by_gravity() {
    let limit = |gravity, spacing| 131_072.0 * unit(&Settings { gravity, spacing, ..settings() });
    close(limit([0.0, -3.0, 4.0], 0.5), 809.543_081_003_105_2);
    close(limit([0.0; 3], 0.5), 1_133.938_411_025_925_2);
    let [one, other] = [1.0_f32, 1024.0].map(|m| limit([0.0, -9.75 * m, 0.0], 0.5 * m));
    close(1024.0 * one, other);
}

#[test]
fn each_neighbour_traps_air() {
    let three = fluid(&[
        ([0.0; 3], [1.0, 0.0, 0.0]),
        ([0.25, 0.0, 0.0], [0.0; 3]),
        ([0.0, 0.0, 0.75], [1.0, 0.0, -2.0]),
    ]);
    let p = all(&three);
    // 2 * 3/4 by the second neighbour, 4 * 1/4 by the third.
    close(p[0].trapped_air, 1.5 + 1.0);
    // For the third: sqrt(5) (1 - cos) W at a distance of sqrt(10)/4, with v_ij = (-1, 0, 2) and
    // x_ij = (1, 0, -3) / 4, whose product term is sqrt(5) + 7 / sqrt(10).
    let third = (5.0_f64.sqrt() + 7.0 / 10.0_f64.sqrt()) * (1.0 - 10.0_f64.sqrt() / 4.0);
    close(p[1].trapped_air, 1.5 + third);
    close(p[2].trapped_air, 1.0 + third);
    assert_eq!(p.iter().map(|p| p.neighbours).collect::<Vec<_>>(), [2; 3]);
    assert_eq!(p.iter().map(|p| p.energy).collect::<Vec<_>>(), [0.5, 0.0, 2.5]);
}

#[test]
fn sums_go_by_the_support() {
    let pair = fluid(&[([0.0; 3], [2.0, 0.0, 0.0]), ([0.5, 0.0, 0.0], [0.0; 3])]);
    let air = |spacing| {
        let settings = Settings { spacing, ..settings() };
        potentials(&pair, &settings)[0].map(|p| (p.neighbours, p.trapped_air))
    };
    assert_eq!(air(1.0), Some((1, 3.0)));
    assert_eq!(air(0.5), Some((1, 2.0)));
    // At a distance of exactly the support there is no neighbour.
    assert_eq!(air(0.25), Some((0, 0.0)));
}

#[test]
fn two_at_a_place_have_no_way_apart() {
    let p = all(&fluid(&[([1.0; 3], [1.0, 0.0, 0.0]), ([1.0; 3], [0.0; 3])]));
    for p in p {
        assert_eq!((p.neighbours, p.trapped_air, p.wave_crest, p.normal), (1, 0.0, 0.0, None));
        assert!(!p.loose);
    }
}

#[test]
fn the_surface_is_where_neighbours_are_to_one_side() {
    assert_eq!((nothing().neighbours, nothing().normal, nothing().loose), (0, None, false));
    // To the left W and its offset are 1/2. To the right, |m| exceeds 0.15 of the whole from
    // 0.81949 on.
    let normal = |right: f32| {
        let p = all(&still(&[[0.0; 3], [-0.5, 0.0, 0.0], [right, 0.0, 0.0]]))[0];
        (p.normal.map(|n| n.to_array()), p.loose)
    };
    assert_eq!(normal(0.815), (None, false));
    assert_eq!(normal(0.82), (Some([1.0, 0.0, 0.0]), false));
    assert!(normal(0.8195).1, "rounding decides");
    // |m| is longest at half a support; from there on the right neighbour has less weight.
    assert_eq!(normal(0.95).0, Some([1.0, 0.0, 0.0]));
    assert_eq!(normal(0.4), (None, false));
    assert_eq!(normal(0.01).0, Some([1.0, 0.0, 0.0]));
}

#[test]
fn the_surface_of_a_block_is_its_outside() {
    let p = all(&block());
    let at = |x: usize, y: usize, z: usize| p[x + 7 * y + 49 * z];
    let third = 3.0_f64.sqrt().recip();
    for (place, neighbours, normal) in [
        ((3, 6, 3), 22, [0.0, 1.0, 0.0]),
        ((3, 0, 3), 22, [0.0, -1.0, 0.0]),
        ((6, 3, 3), 22, [1.0, 0.0, 0.0]),
        ((3, 3, 0), 22, [0.0, 0.0, -1.0]),
        ((6, 6, 6), 10, [third, third, third]),
        ((0, 6, 0), 10, [-third, third, -third]),
    ] {
        let p = at(place.0, place.1, place.2);
        close_all(p.normal.expect("it is at the surface"), normal);
        // A particle inside has 6 + 12 + 8 + 6 neighbours within a support.
        assert_eq!((p.neighbours, p.loose), (neighbours, false), "{place:?}");
    }
    for n in 0..125 {
        let p = at(1 + n % 5, 1 + n / 5 % 5, 1 + n / 25);
        let outermost = [n % 5, n / 5 % 5, n / 25].iter().any(|x| *x == 0 || *x == 4);
        assert!(outermost || (p.normal.is_none() && p.neighbours == 32 && !p.loose));
    }
}

#[test]
fn a_crest_is_where_normals_part() {
    // Two particles at half a support, whose normals point apart.
    let crest = |velocity: [f32; 3]| {
        let p = all(&fluid(&[([0.5, 0.0, 0.0], velocity), ([0.0; 3], [0.0; 3])]));
        assert_eq!((p[1].wave_crest, p[1].crest_terms), (0.0, 0), "it does not move");
        assert_eq!(p[0].normal, Some(DVec3::X));
        (p[0].wave_crest, p[0].crest_terms, p[0].loose)
    };
    assert_eq!(crest([3.0, 0.0, 0.0]), (1.0, 1, false));
    assert_eq!(crest([-3.0, 0.0, 0.0]), (0.0, 0, false));
    assert_eq!(crest([0.0, 1.0, 0.0]), (0.0, 0, false));
    assert_eq!(crest([0.61, 0.0, 0.79]), (1.0, 1, false));
    assert_eq!(crest([0.59, 0.0, 0.81]), (0.0, 0, false));
    assert!(crest([0.6, 0.0, 0.8]).2, "rounding decides");
}

#[test]
fn only_the_surface_behind_makes_a_crest() {
    let outwards = |x: [f32; 3]| (x, [-1.0, 0.0, 0.0]);
    // The middle particle is not at the surface; the far one contributes 2 * 1/5.
    let p =
        all(&fluid(&[outwards([0.0; 3]), outwards([0.4, 0.0, 0.0]), outwards([0.8, 0.0, 0.0])]));
    close(p[0].wave_crest, 0.4);
    assert_eq!([0, 1, 2].map(|i| p[i].crest_terms), [1, 0, 0]);
    assert_eq!([0, 1, 2].map(|i| p[i].normal), [Some(-DVec3::X), None, Some(DVec3::X)]);

    // n is along (1/4, 0) - (5/8, 5/8) (1 - 5/8 sqrt(2)), so the third particle lies before the
    // surface plane of the first.
    let w = 1.0 - 0.625 * 2.0_f64.sqrt();
    let n = DVec3::new(0.25 - 0.625 * w, -0.625 * w, 0.0).normalize();
    assert!(n.x + n.y > 0.5);
    let places = [[0.0; 3], [-0.5, 0.0, 0.0], [0.625, 0.625, 0.0]];
    let p = all(&fluid(&places.map(|x| (x, [1.0, 0.0, 0.0]))));
    close_all(p[0].normal.expect("it is at the surface"), n.to_array());
    close(p[0].wave_crest, 0.5 * (1.0 + n.x));
    assert_eq!((p[0].crest_terms, p[0].loose), (1, false));
    // The third moves at 45 degrees to its normal; the first is behind it.
    close(p[2].wave_crest, w * (1.0 - (n.x + n.y) / 2.0_f64.sqrt()));

    // Two neighbours lie exactly in the plane across the normal, so rounding decides whether they
    // are before it.
    let places = [[0.0; 3], [-0.75, 0.0, 0.0], [0.0, 0.7, 0.0], [0.0, -0.7, 0.0]];
    let p = all(&fluid(&places.map(|x| (x, [1.0, 0.0, 0.0]))));
    assert_eq!(p[0].normal, Some(DVec3::X));
    assert!(p[0].loose);
    // Each of them may add 0.3 (1 - 0), plus the rounding of the normals.
    assert!((0.6..0.601).contains(&p[0].crest_off), "{}", p[0].crest_off);
}

/// Computes normals like the GPU: m and w in fixed-point steps, in single precision.
#[test]
fn normals_of_whole_steps_are_as_near_as_said() {
    let fluid = random_fluid(600);
    let grid = Grid::new(&fluid, SPACING);
    let mut normals = vec![None; 600];
    for part in fluid.parts(SPACING) {
        let (mut m, mut w) = (DVec3::ZERO, 0.0);
        for near in grid.near(part.position).filter(|near| near.part.index != part.index) {
            if near.q < 1.0 {
                let step = |x: f64| (x as f32 * 65536.0).round_ties_even();
                let term = (near.offset.as_vec3() * (1.0 - near.q as f32)).as_dvec3();
                m += DVec3::from(term.to_array().map(step).map(f64::from));
                w += f64::from(step(near.weight()));
            }
        }
        normals[part.index] =
            (w > 0.0 && m.length() > 0.15 * w).then(|| m.as_vec3().normalize().as_dvec3());
    }
    let (mut crests, mut looses) = (0, 0);
    for (p, index) in potentials(&fluid, &settings()).iter().zip(0..) {
        let Some(p) = p else { continue };
        looses += u32::from(p.loose);
        if p.loose {
            continue;
        }
        let normal: Option<DVec3> = normals[index];
        assert_eq!(p.normal.is_some(), normal.is_some());
        let Some(normal) = normal.filter(|_| p.crest_terms > 0) else { continue };
        let place = DVec3::from(fluid.positions[index].map(f64::from));
        let mut crest = 0.0;
        for near in grid.near(place).filter(|near| near.part.index != index) {
            if let Some(other) = normals[near.part.index].filter(|_| near.offset.dot(normal) > 0.0)
            {
                crest += (1.0 - normal.dot(other)) * near.weight();
            }
        }
        let off = (crest - p.wave_crest).abs();
        assert!(off <= p.crest_off && p.crest_off < 0.05, "{off} of {}", p.crest_off);
        crests += 1;
    }
    assert!(crests > 50 && looses < 30, "{crests} crests, {looses} loose");
}

#[test]
fn rounding_decides_near_a_support() {
    let loose = |distance| all(&still(&[[0.0; 3], [0.0, distance, 0.0]]))[0];
    assert!(loose(1.0).loose && loose(1.0).neighbours == 0);
    assert!(loose(0.999_995).loose && loose(0.999_995).neighbours == 1);
    assert!(loose(1.000_005).loose && !loose(1.000_1).loose);
    // m and w may differ from 0 by less than half a step.
    assert!(loose(0.999_99).loose && !loose(0.999_9).loose);
}

#[test]
fn what_rounding_decides_goes_on() {
    // One particle is certainly a neighbour and makes a surface, another may be a neighbour.
    let p = all(&still(&[[0.0; 3], [-0.5, 0.0, 0.0], [0.0, 0.999_999, 0.0]]));
    assert!(p[0].normal.is_some());
    assert_eq!([0, 1, 2].map(|i| p[i].loose), [true, false, true]);
    let spray = foam([0.0; 3], [0.0; 3]);
    let loose = |y| moved(&spray, &still(&[[0.0, y, 0.0]]), &settings(), 0.1).1;
    assert_eq!([0.999_9, 0.999_995, 1.000_005, 1.000_1].map(loose), [false, true, true, false]);

    // The first particle may be at the surface, so the third may have a crest if it moves outwards.
    let crest = |x: f32| {
        let places = [[0.0; 3], [-0.5, 0.0, 0.0], [0.8195, 0.0, 0.0]];
        let p = all(&fluid(&places.map(|place| (place, [x, 0.0, 0.0]))));
        [p[0].loose, p[2].loose]
    };
    assert_eq!((crest(1.0), crest(-1.0)), ([true, true], [true, false]));
}

#[test]
fn the_grid_finds_all() {
    let fluid = random_fluid(500);
    let grid = Grid::new(&fluid, SPACING);
    let mut found = 0;
    let near_far = (0..60).map(|id| somewhere(id + 5000, 5.0).map(|x| f64::from(x) - 1.0));
    for place in near_far.chain([[1e30; 3], [-1e30; 3], [f64::NAN; 3]]) {
        let place = DVec3::from(place);
        let mut quickly = grid.near(place).collect::<Vec<_>>();
        quickly.sort_by_key(|near| near.part.index);
        let slowly = near(place, SPACING, fluid.parts(SPACING)).collect::<Vec<_>>();
        assert_eq!(quickly, slowly);
        found += slowly.len();
    }
    assert!(found > 500, "{found} neighbours");
    // Grid cells on both sides of 0.
    let line = still(&[-0.9, -0.1, 0.2, 0.85].map(|x| [x, 0.0, 0.0]));
    assert_eq!(all(&line).iter().map(|p| p.neighbours).collect::<Vec<_>>(), [1, 3, 2, 2]);
}

#[test]
fn phi_is_a_ramp() {
    let at = |potential| phi(potential, [2.0, 6.0]);
    assert_eq!([-9.0, 2.0, 3.0, 5.0, 6.0, 1e30].map(at), [0.0, 0.0, 0.25, 0.75, 1.0, 1.0]);
    assert_eq!([1.9, 2.0, 2.1].map(|potential| phi(potential, [2.0; 2])), [0.0, 0.0, 1.0]);
}

#[test]
fn particles_are_wanted_by_the_potentials() {
    let settings = Settings {
        trapped_air: [1.0, 5.0],
        wave_crest: [2.0, 4.0],
        energy: [4.0, 8.0],
        trapped_air_rate: 100.0,
        wave_crest_rate: 10.0,
        ..settings()
    };
    let at = |trapped_air, wave_crest, energy| {
        wanted(&Potentials { trapped_air, wave_crest, energy, ..nothing() }, &settings, 0.5)
    };
    assert_eq!(at(2.0, 3.5, 7.0), 0.75 * (25.0 + 7.5) * 0.5);
    assert_eq!(at(9.0, 0.0, 9.0), 50.0);
    assert_eq!(at(0.0, 9.0, 9.0), 5.0);
    assert_eq!(at(9.0, 9.0, 4.0), 0.0);
}

#[test]
fn random_numbers_are_those_of_the_others() {
    assert_eq!(uniform_of(42, 7, 0) * 16_777_216.0, 7_461_844.0);
    assert_eq!(uniform_of(42, 7, 1) * 16_777_216.0, 11_415_383.0);
    // The settings' seed is 3.
    assert_eq!(seed_of_step(&settings(), 5), 0xa135_dc47);
}

#[test]
fn the_count_is_as_wanted_on_average() {
    let counts = |n, seed, number| {
        let settings = Settings { seed, ..settings() };
        (0..20_000).map(|id| count(n, &settings, id, number)).collect::<Vec<_>>()
    };
    for n in [0.0, 0.3, 2.0, 2.3, 17.96] {
        let drawn = counts(n, 3, 5);
        assert_eq!(drawn, counts(n, 3, 5));
        assert!(drawn.iter().all(|c| *c == n as u32 || (*c == n as u32 + 1 && n.fract() > 0.0)));
        let mean = drawn.iter().sum::<u32>() as f64 / 20_000.0;
        assert!((mean - n).abs() < 0.0163, "{mean} is five deviations off {n}");
    }
    assert_ne!(counts(0.3, 3, 5), counts(0.3, 3, 6));
    assert_ne!(counts(0.3, 3, 5), counts(0.3, 4, 5));
    // Computed separately: the ids 7 and 99 draw 0.35197 and 0.82463 in step 5.
    let one = |n, id| count(n, &settings(), id, 5);
    assert_eq!([one(1.351, 7), one(1.352, 7), one(1.824, 99), one(1.825, 99)], [1, 2, 1, 2]);
    assert_eq!([63.9, 64.0, 64.9, 1e30, f64::INFINITY].map(|n| one(n, 7)), [64; 5]);
    assert_eq!([62.1, 0.0, -0.5, f64::NAN].map(|n| one(n, 7)), [62, 0, 0, 0]);
}

#[test]
fn a_newborn_is_where_it_was_worked_out() {
    let parent = fluid(&[([1.0, 2.0, 3.0], [0.0, 0.0, 4.0])]);
    let p = Potentials { neighbours: 19, ..nothing() };
    let particle = newborn(&parent, 0, &p, 2, &settings(), 0.125, 5);
    close_all(particle.position, [1.133_258_920_7, 2.167_771_626_2, 3.330_086_857_1]);
    close_all(particle.velocity, [0.133_258_920_7, 0.167_771_626_2, 4.0]);
    assert_eq!((particle.id, particle.kind, particle.age), (0x53f8_2c05 >> 1, FOAM, 0.0));
    let kind = |neighbours| {
        newborn(&parent, 0, &Potentials { neighbours, ..p }, 2, &settings(), 0.125, 5).kind
    };
    // `neighbours` does not include the parent.
    assert_eq!([0, 4, 5, 19, 20, 99].map(kind), [SPRAY, SPRAY, FOAM, FOAM, BUBBLE, BUBBLE]);
}

#[test]
fn newborns_fill_a_cylinder() {
    for velocity in [[0.0, 0.0, -4.0], [3.0, 2.0, 1.0], [0.0, -4.0, 0.0], [-0.5, 0.1, -9.0]] {
        let mut parent = fluid(&[([1.0, 2.0, 3.0], velocity)]);
        let v = DVec3::from(velocity.map(f64::from));
        let (axis, sweep) = (v.normalize(), v.length() * 0.125);
        let (mut squares, mut along, mut aside) = (0.0, 0.0, DVec3::ZERO);
        for n in 0..6400 {
            parent.ids[0] = n / 64;
            let particle = newborn(&parent, 0, &nothing(), n % 64, &settings(), 0.125, 5);
            let offset = particle.position - DVec3::new(1.0, 2.0, 3.0);
            let x = offset.dot(axis);
            let across = offset - x * axis;
            assert!((0.0..sweep).contains(&x) && across.length() <= 0.25);
            assert!((particle.velocity - v - across).length() < 1e-12);
            squares += across.length_squared() / 6400.0;
            along += x / 6400.0;
            aside += across / 6400.0;
        }
        // Uniform in the cylinder: the mean squared distance from the axis is half the squared
        // radius, the mean along it half its length. Allowed are five standard deviations of 0.289
        // and 0.5.
        assert!((squares * 16.0 - 0.5).abs() < 0.018, "{squares}");
        assert!((along / sweep - 0.5).abs() < 0.018, "{along}");
        assert!(aside.length() < 0.016, "{aside}");
    }
}

#[test]
fn the_basis_is_right_handed() {
    let many = (0..2000).map(|id| {
        let level = 2.0 * uniform_of(1, id, 0) - 1.0;
        let (sine, cosine) = (TAU * uniform_of(1, id, 1)).sin_cos();
        let ring = (1.0 - level * level).sqrt();
        DVec3::new(ring * cosine, ring * sine, level)
    });
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let almost = DVec3::new(1e-4, -2e-4, -1.0).normalize();
    for z in many.chain(axes).chain([almost, -almost]) {
        let [e1, e2] = basis(z);
        close(e1.length(), 1.0);
        close(e2.length(), 1.0);
        close(e1.dot(z), 0.0);
        close_all(e1.cross(e2), z.to_array());
    }
    assert_eq!(basis(DVec3::Z), [DVec3::X, DVec3::Y]);
    assert_eq!(basis(DVec3::NEG_Z), [DVec3::X, DVec3::NEG_Y]);
}

#[test]
fn one_at_rest_still_makes_some() {
    // Without a direction the disc lies across z, and nothing is swept along it.
    let parent = fluid(&[([0.0; 3], [0.0; 3])]);
    let particle = newborn(&parent, 0, &nothing(), 2, &settings(), 0.125, 5);
    close_all(particle.position, [0.133_258_920_7, 0.167_771_626_2, 0.0]);
}

#[test]
fn spray_falls() {
    for neighbours in [0, 5] {
        let water = fluid(&ring(neighbours, 0.5, [9.0; 3]));
        let (after, loose) = moved(&foam([0.0; 3], [1.0, 2.0, 0.0]), &water, &settings(), 0.125);
        close_all(after.velocity, [1.0, 0.75, 0.0]);
        close_all(after.position, [0.125, 0.09375, 0.0]);
        assert_eq!((after.kind, after.age, after.id, loose), (SPRAY, 0.25, 7, false));
    }
}

#[test]
fn foam_goes_with_the_water() {
    for neighbours in [6, 20] {
        let water = fluid(&ring(neighbours, 0.5, [1.0, 0.0, -3.0]));
        let spray = Particle { kind: SPRAY, ..foam([0.0; 3], [9.0, 2.0, 0.0]) };
        let (after, loose) = moved(&spray, &water, &settings(), 0.125);
        close_all(after.velocity, [1.0, 0.0, -3.0]);
        close_all(after.position, [0.125, 0.0, -0.375]);
        assert_eq!((after.kind, loose), (FOAM, false));
        // Its lifetime is 2 s plus 0.86026 of 2 s.
        close(after.age, 0.25 + 0.125 / 3.720_527_172_088_623);
    }
}

#[test]
fn near_water_weighs_more() {
    // K is 0.71875 at a distance of 1/4, 0.25 at 1/2 and 0.03125 at 3/4.
    let slow = [0.0, 4.0, 0.0];
    let mut particles = ring(3, 0.25, [1.0, 0.0, 0.0]);
    particles.extend(ring(2, 0.5, [0.0; 3]));
    particles.extend(ring(2, 0.75, slow));
    particles.extend(ring(4, 1.01, [9.0; 3]));
    let around = carried(DVec3::ZERO, &fluid(&particles), &settings());
    let sum = 3.0 * 0.71875 + 2.0 * 0.25 + 2.0 * 0.03125;
    close(around.weight, sum);
    close_all(around.velocity, [3.0 * 0.71875 / sum, 8.0 * 0.03125 / sum, 0.0]);
    assert_eq!((around.neighbours, around.loose), (7, false));
    // The error is 7 half steps of U = sqrt(5) / 256, and a tenth of that from the weights.
    assert!((around.off * sum / 3.5 / unit(&settings()) - 1.0).abs() < 0.002, "{}", around.off);
    assert_eq!(kernel_at(0.0), 1.0);
    // A component is limited to 2^17 steps in both directions.
    let fast = fluid(&ring(1, 0.5, [1e9, -1e9, 0.0]));
    let most = 1_144.866_804_479_892_4 / 0.25;
    close_all(carried(DVec3::ZERO, &fast, &settings()).velocity, [most, -most, 0.0]);
}

/// K of one neighbour at this distance.
fn kernel_at(distance: f64) -> f64 {
    carried(DVec3::ZERO, &fluid(&ring(1, distance, [0.0; 3])), &settings()).weight
}

#[test]
fn water_of_no_weight_carries_by_chance() {
    // K is 2e-6 for each neighbour, and a step is 15e-6.
    let water = fluid(&ring(6, 0.99, [1.0, 0.0, 0.0]));
    let around = carried(DVec3::ZERO, &water, &settings());
    close_all(around.velocity, [1.0, 0.0, 0.0]);
    assert!(around.off.is_infinite() && !around.loose);
    assert!(moved(&foam([0.0; 3], [0.0; 3]), &water, &settings(), 0.125).1);
}

#[test]
fn bubbles_rise() {
    let water = fluid(&ring(21, 0.5, [4.0, 0.0, 2.0]));
    let (after, loose) = moved(&foam([0.0; 3], [2.0, 0.0, 0.0]), &water, &settings(), 0.125);
    // Buoyancy of 2 times gravity upwards for 1/8 s, and drag towards the water's velocity by a
    // half.
    close_all(after.velocity, [3.0, 2.5, 1.0]);
    close_all(after.position, [0.375, 0.3125, 0.125]);
    assert_eq!((after.kind, after.age, loose), (BUBBLE, 0.25, false));
}

#[test]
fn foam_lives_within_its_limits() {
    let water = fluid(&ring(6, 0.5, [0.0; 3]));
    let life = |id| {
        let young = Particle { id, age: 0.0, ..foam([0.0; 3], [0.0; 3]) };
        0.125 / moved(&young, &water, &settings(), 0.125).0.age
    };
    let lives = (0..2000).map(life).collect::<Vec<_>>();
    let (least, most) = lives.iter().fold((9.0_f64, 0.0_f64), |(a, b), l| (a.min(*l), b.max(*l)));
    assert!((2.0..2.01).contains(&least) && (3.99..4.0).contains(&most), "{least} to {most}");
    // The lifetime depends on the settings' seed and not on the step; computed separately.
    close(life(7), 3.720_527_172_088_623);
    close(life(8), 3.188_362_360_000_61);
    let other = Settings { seed: 4, ..settings() };
    let age = moved(&foam([0.0; 3], [0.0; 3]), &water, &other, 0.125).0.age;
    assert!((age - 0.25 - 0.125 / life(7)).abs() > 1e-4, "it goes by the seed");

    // With a lifetime of 0 a particle dies at once, even in a step of 0 s.
    let none = Settings { lifetime: [0.0; 2], ..settings() };
    for dt in [0.0, 0.1] {
        assert_eq!(moved(&foam([0.0; 3], [0.0; 3]), &water, &none, dt).0.age, 1.0);
    }
}

#[test]
fn foam_is_gone_when_its_life_is_over() {
    let water = fluid(&ring(6, 0.5, [0.0; 3]));
    let settings = Settings { lifetime: [2.0; 2], ..settings() };
    let after = |age, dt| {
        let (after, loose) =
            moved(&Particle { age, ..foam([0.0; 3], [0.0; 3]) }, &water, &settings, dt);
        (after.age, loose)
    };
    assert_eq!(after(0.875, 0.125), (0.9375, false));
    assert_eq!(after(0.875, 0.25), (1.0, true));
    assert_eq!(after(0.875, 0.5), (1.0, false));
    assert!(after(0.875, 0.249_999_9).1, "rounding decides");
    // A dead particle does not move.
    let over = Particle { age: 1.5, ..foam([3.0; 3], [1.0; 3]) };
    assert_eq!(moved(&over, &water, &settings, 1.0), (Particle { age: 1.0, ..over }, false));
}

#[test]
fn one_is_gone_out_of_bounds() {
    let bounds = Some([[-1.0, -2.0, -3.0], [1.0, 2.0, 0.0]]);
    let boxed = Settings { bounds, gravity: [0.0; 3], ..settings() };
    let free = Settings { bounds: None, ..boxed };
    let nothing = Fluid::default();
    for (velocity, gone) in [
        ([0.0, 0.0, 0.0], false),
        ([1.49, 0.0, 0.0], false),
        ([1.51, 0.0, 0.0], true),
        ([-0.51, 0.0, 0.0], true),
        ([-0.49, -2.49, -2.49], false),
        ([0.0, -2.51, 0.0], true),
        ([0.0, 1.51, 0.0], true),
        ([0.0, 0.0, 0.51], true),
        ([0.0, 0.0, -2.51], true),
    ] {
        let particle = foam([-0.5, 0.5, -0.5], velocity);
        let (after, loose) = moved(&particle, &nothing, &boxed, 1.0);
        assert_eq!((after.age == 1.0, loose), (gone, false), "{velocity:?}");
        assert_eq!(moved(&particle, &nothing, &free, 1.0).0.age, 0.25);
    }
    let loose = |x| moved(&foam([0.0, 0.0, -0.5], [x, 0.0, 0.0]), &nothing, &boxed, 1.0).1;
    assert!([1.0, 1.0 + 5e-7, 1.0 - 5e-7, -1.0].iter().all(|x| loose(*x)));
    assert!([1.0 + 2e-6, 1.0 - 2e-6, 0.0].iter().all(|x| !loose(*x)));
    // Near 0 the error depends on the position before the step.
    let back = |z| moved(&foam([0.0, 0.0, -0.5], [0.0, 0.0, z]), &nothing, &boxed, 1.0).1;
    assert!(back(0.5 + 4e-7) && !back(0.5 + 6e-7));
    // For foam the error includes that of the water's velocity.
    let water = fluid(&ring(6, 0.9, [1.0, 0.0, 0.0]));
    let off = carried(DVec3::ZERO, &water, &settings()).off;
    assert!(off > 0.01);
    let above =
        |part: f64| moved(&foam([0.0; 3], [0.0; 3]), &water, &with_top(1.0 + part * off), 1.0).1;
    assert!(above(0.9) && !above(1.1));
}

/// Settings with a box that ends at this x.
fn with_top(x: f64) -> Settings {
    Settings { bounds: Some([[-9.0; 3], [x as f32, 9.0, 9.0]]), ..settings() }
}

#[test]
fn nowhere_is_gone() {
    for position in [[f64::NAN, 0.0, 0.0], [0.0, f64::INFINITY, 0.0], [0.0, 0.0, 1e39]] {
        assert_eq!(
            moved(&foam(position, [0.0; 3]), &Fluid::default(), &settings(), 0.1).0.age,
            1.0
        );
    }
    let lost = foam([0.0; 3], [f64::NAN, 0.0, 0.0]);
    assert_eq!(moved(&lost, &Fluid::default(), &settings(), 0.1).0.age, 1.0);
}

#[test]
fn what_is_nowhere_takes_no_part() {
    let pair = [([0.0; 3], [1.0, 0.0, 0.0]), ([0.5, 0.0, 0.0], [-1.0, 0.0, 0.0])];
    let far = 1_073_741_824.0;
    let (up, there) = ([0.0, 1.0, 0.0], [0.25, 0.25, 0.0]);
    for odd in [
        ([0.25, f32::NAN, 0.0], up),
        ([0.25, 0.25, f32::INFINITY], up),
        ([0.25, -2e18, 0.0], up),
        ([0.0, far, 0.0], up),
        ([-far, 0.0, 0.0], up),
        (there, [0.0, f32::NAN, 0.0]),
        (there, [f32::NEG_INFINITY, 0.0, 0.0]),
        (there, [0.0, 0.0, 1e18]),
        (there, [0.0, 0.0, -1e18]),
    ] {
        let three = fluid(&[pair[0], odd, pair[1]]);
        let p = potentials(&three, &settings());
        let [a, b] = [0, 1].map(|i| all(&fluid(&pair))[i]);
        assert_eq!(p, [Some(a), None, Some(b)], "{odd:?}");
        assert_eq!(carried(DVec3::ZERO, &three, &settings()).neighbours, 2);
    }
    // These particles are still valid.
    for odd in [([0.0, 0.999 * far, 0.0], up), (there, [0.0, 0.99e18, 0.0])] {
        assert!(potentials(&fluid(&[pair[0], odd]), &settings())[1].is_some(), "{odd:?}");
    }
    // Invalid particles do not create any.
    let violent = Settings { energy: [-2.0, -1.0], trapped_air: [-2.0, -1.0], ..settings() };
    let three = fluid(&[(pair[0].0, [f32::NAN; 3]), ([0.0, far, 0.0], up), pair[1]]);
    let mut slots = Slots { most: 99, ..Slots::default() };
    slots.step(&three, &violent, 2.0, 1);
    assert_eq!(slots.particles.len(), 2);
    assert!(slots.particles.iter().all(|particle| particle.velocity.x < -0.7));
}

/// Settings with which each particle of the fluid creates two in a step of 1/8 s.
fn two_each() -> Settings {
    let limits = [-2.0, -1.0];
    Settings { trapped_air: limits, energy: limits, trapped_air_rate: 16.0, ..settings() }
}

#[test]
fn newborns_take_the_free_slots_in_order() {
    let quiet = Settings { wave_crest_rate: 0.0, ..two_each() };
    let water = still(&[[0.0; 3], [50.0; 3]]);
    let mut slots = Slots { most: 7, ..Slots::default() };
    slots.step(&water, &quiet, 0.125, 1);
    let p = all(&water);
    let born = |i: usize, k, number| newborn(&water, i, &p[i], k, &quiet, 0.125, number);
    assert_eq!(slots.particles, [born(0, 0, 1), born(0, 1, 1), born(1, 0, 1), born(1, 1, 1)]);
    assert_eq!(slots.lost, 0);

    // The second and third particle are dead, so their slots are free for the first two newborn
    // ones; the others get new slots.
    slots.particles[1].age = 1.5;
    slots.particles[2].position.x = f64::NAN;
    let before = slots.particles.clone();
    slots.step(&water, &quiet, 0.125, 2);
    let first = moved(&before[0], &water, &quiet, 0.125).0;
    let fourth = moved(&before[3], &water, &quiet, 0.125).0;
    let after = [first, born(0, 0, 2), born(0, 1, 2), fourth, born(1, 0, 2), born(1, 1, 2)];
    assert_eq!(slots.particles, after);
    assert_eq!(slots.lost, 0);

    // One slot of seven is left and three newborn particles are lost; then all are lost.
    slots.step(&water, &quiet, 0.125, 3);
    assert_eq!((slots.particles.len(), slots.lost), (7, 3));
    assert_eq!(slots.particles[6], born(0, 0, 3));
    slots.step(&water, &quiet, 0.125, 4);
    assert_eq!((slots.particles.len(), slots.lost), (7, 7));
    slots.particles[5].age = 1.0;
    slots.step(&water, &quiet, 0.125, 5);
    assert_eq!((slots.particles[5], slots.lost), (born(0, 0, 5), 10));
}

#[test]
fn slots_move_by_all_of_the_water() {
    let water = random_fluid(400);
    let particle = |id| {
        let position = DVec3::from(somewhere(id + 9000, 3.5).map(f64::from));
        Particle { position, velocity: DVec3::ONE, age: 0.5, kind: SPRAY, id }
    };
    let before = (0..300).map(particle).collect::<Vec<_>>();
    let mut slots = Slots { particles: before.clone(), most: 300, lost: 0 };
    slots.step(&water, &settings(), 0.125, 9);
    let mut kinds = [0; 3];
    for (before, after) in before.iter().zip(&slots.particles) {
        let expected = moved(before, &water, &settings(), 0.125).0;
        assert!((expected.position - after.position).length() < 1e-12);
        assert_eq!((expected.kind, expected.age), (after.kind, after.age));
        kinds[after.kind as usize] += 1;
    }
    assert!(kinds.iter().all(|n| *n > 10), "{kinds:?}");
    // No slot was free.
    let p = potentials(&water, &settings());
    let born = p.iter().zip(&water.ids).map(|(p, id)| {
        let n = p.map_or(0.0, |p| wanted(&p, &settings(), 0.125));
        u64::from(count(n, &settings(), *id, 9))
    });
    let born = born.sum::<u64>();
    assert!(born > 10 && slots.lost == born, "{born} born, {} lost", slots.lost);
}

#[test]
fn water_is_found_either_way() {
    let water = random_fluid(300);
    let grid = Grid::new(&water, SPACING);
    let quickly = carried_by(grid.near(DVec3::splat(1.5)), &settings());
    let slowly = carried(DVec3::splat(1.5), &water, &settings());
    assert_eq!(quickly.neighbours, slowly.neighbours);
    close_all(quickly.velocity, slowly.velocity.to_array());
}
