//! Compares what particles with few neighbours lose with what a host takes from them.

use ash::vk;
use whitewater::water::Splat;
use whitewater::{Count, LightVolume, Packets};

use super::{askew, ellipsoids, lattice, twin_settings, world};
use crate::invariants::{packet_bytes, same_drawn};
use crate::reference::shape::shapes;
use crate::reference::{Image, smoothstep};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, extent};
use crate::support::scenes::{self, Lens};
use crate::surface_foam::Foamy;

/// A block of particles, clusters of five particles close together but not in a plane, and pairs.
fn clusters(size: vk::Extent2D) -> Foamy {
    let mut case = Foamy::new(size, Lens::Standard, 2.0);
    let center = scenes::world(&case.shot.camera, &[[0.0, 0.0, 5.0]])[0];
    case.shot.light_volume = Some(LightVolume { center, radius: 6.0 });
    case.shot.settings.water.spacing = 0.1;
    case.shot.positions = lattice(&case.shot, [0.4, 0.3, 4.0], askew(), [3, 3, 3]);
    for middle in [[-1.0, 0.6, 4.0], [-0.7, -0.6, 3.5], [0.2, -0.9, 4.0]] {
        let corner = lattice(&case.shot, middle, askew(), [1, 1, 1]);
        case.shot.positions.extend([12, 13, 14, 16, 22].map(|i| corner[i]));
    }
    for middle in [[-1.2, 0.0, 4.0], [1.2, -0.6, 4.5]] {
        let line = lattice(&case.shot, middle, askew(), [1, 0, 0]);
        case.shot.positions.extend(&line[..2]);
    }
    let count = case.shot.positions.len();
    case.amounts = (0..count).map(|i| [0.2 + 0.1 * (i % 7) as f32, 0.3]).collect();
    case.velocities = (0..count).map(|i| [0.3, 0.1 * (i % 5) as f32, -0.2]).collect();
    case.ids = Some((0..count as u32).map(|i| 3 * i).collect());
    case.shot.densities = Some(vec![case.shot.settings.water.rest_density; count]);
    case
}

/// Particles with few neighbours are drawn as if the host had set their foam to 0 and their density
/// to that of spray, in the passes `cull`, `light`, `surface_foam`, `spray` and `motion`; all other
/// particles as if it were off. With foam alone and with spray alone too.
#[test]
fn few_neighbours_make_spray_without_foam() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    // With the larger stride the device binds few particles at a time. (Blended sums depend on the
    // order of the particles.)
    for (stride, foam, spray) in
        [(32, true, true), (1 << 19, true, true), (32, true, false), (32, false, true)]
    {
        let config = ellipsoids(size, Splat::Compute).with(|it| {
            it.sheets = 2;
            it.light_map_size = Some(64);
            (it.surface_foam, it.spray, it.motion) = (true, true, true);
            it.max_stride = stride;
        });
        let mut rig = Rig::new(&gpu, &config);
        let mut case = clusters(size);
        // Off.
        let plain = case.draw(&mut rig);
        let sums: Vec<f64> = shapes(&world(&case.shot), &twin_settings(&case.shot))
            .iter()
            .map(|s| s.crowd)
            .collect();
        let ([foam_few, foam_many], [spray_few, spray_many]) = ([4.4, 5.4], [1.5, 2.5]);
        let mut expected = case.clone();
        let of = |on: bool, limits: [f32; 2]| if on { limits } else { [0.0; 2] };
        case.shot.settings.surface_foam.few_neighbours = of(foam, [foam_few, foam_many]);
        case.shot.settings.spray.few_neighbours = of(spray, [spray_few, spray_many]);
        let mut kinds = [0; 3];
        for (i, sum) in sums.into_iter().enumerate() {
            let between =
                |[few, many]: [f32; 2]| sum > f64::from(few) - 0.01 && sum < f64::from(many) + 0.01;
            assert!(!between([foam_few, foam_many]) && !between([spray_few, spray_many]), "{sum}");
            let (foams, alone) = (sum > f64::from(foam_many), sum < f64::from(spray_few));
            kinds[usize::from(foams) + 2 * usize::from(alone)] += 1;
            if foam && !foams {
                expected.amounts[i][0] = 0.0;
            }
            if spray && alone {
                // Any density of pure spray.
                expected.shot.densities.as_mut().expect("densities")[i] = 1.0;
            }
        }
        assert_eq!(kinds, [15, 343, 4], "clusters, block, pairs");
        let name = format!("shape-crowd-{stride}-{foam}-{spray}");
        let (found, expected) = (case.draw(&mut rig), expected.draw(&mut rig));
        same_drawn(&name, &found, &expected);
        let all = |drawn: &Drawn| {
            let foam = drawn.foam.as_ref().expect("foam");
            let spray = drawn.spray.as_ref().expect("spray");
            let light = drawn.light_thickness.as_ref().expect("light");
            let motion = drawn.motion.as_ref().expect("motion");
            let foam = foam.thickness.map(|[all, front]| [*all, *front, 0.0, 0.0]);
            let motion = motion.map(|[x, y]| [*x, *y, 0.0, 0.0]);
            (foam, spray.clone(), light.clone(), motion)
        };
        let (a, b) = (all(&found), all(&expected));
        compare::same_color(&format!("{name}-foam"), &a.0, &b.0);
        compare::same(&format!("{name}-spray"), &a.1, &b.1);
        compare::same_color(&format!("{name}-light"), &a.2, &b.2);
        compare::same_color(&format!("{name}-motion"), &a.3, &b.3);
        // Without it there is no spray, and more foam.
        let (before, sum) = (all(&plain), |image: &Image<f32>| image.data.iter().sum::<f32>());
        assert!(sum(&before.1) == 0.0 && (sum(&a.1) > 0.0) == spray);
        let [more, less] = [before.0, a.0].map(|foam| sum(&foam.map(|t| t[0])));
        assert!(less > 0.0 && more >= less && (more > 1.02 * less) == foam, "{more} {less}");
    }
}

/// Largest error of a sum of weights: it has at most 64 addends, each rounded to a multiple of 1/65536 (shape.comp).
const SUM_OFF: f64 = 64.0 * 0.5 / 65536.0;

/// Between the limits, particles lose their foam and density gradually, as GLSL's smoothstep rises. A count on the GPU
/// and packets make no difference.
#[test]
fn few_neighbours_act_gradually() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let config =
        ellipsoids(size, Splat::Compute).with(|it| (it.surface_foam, it.spray) = (true, true));
    let mut rig = Rig::new(&gpu, &config);
    let mut case = clusters(size);
    case.shot.light_volume = None;
    let (of_foam, of_spray) = ([0.5, 40.0], [1.0, 60.0]);
    let rest = case.shot.settings.water.rest_density;
    // `SpraySettings::few_neighbours`: below the density of pure spray.
    let alone = 0.9 * case.shot.settings.spray.all_spray_density * rest;
    let mut expected = case.clone();
    let mut between = 0;
    for (i, twin) in shapes(&world(&case.shot), &twin_settings(&case.shot)).iter().enumerate() {
        let share = |[few, many]: [f64; 2]| smoothstep(few, many, twin.crowd);
        let (foam, spray) = (share(of_foam), share(of_spray));
        between += usize::from(foam > 0.1 && foam < 0.9 && spray > 0.05 && spray < 0.9);
        expected.amounts[i][0] *= foam as f32;
        let density = f64::from(alone) + spray * f64::from(rest - alone);
        expected.shot.densities.as_mut().expect("densities")[i] = density as f32;
    }
    assert!(between > 300, "{between}");
    case.shot.settings.surface_foam.few_neighbours = of_foam.map(|x| x as f32);
    case.shot.settings.spray.few_neighbours = of_spray.map(|x| x as f32);
    let foam = |drawn: &Drawn| drawn.foam.as_ref().expect("foam").thickness.map(|t| t[0]);
    let spray = |drawn: &Drawn| drawn.spray.as_ref().expect("spray").clone();
    let [found, wanted] = [&case, &expected].map(|case| case.draw(&mut rig));
    // The slope of smoothstep is at most 1.5 over the distance of the limits. Foam is proportional to the share, which is
    // at least 0.05 in the block. The share of spray changes with the density over a fifth of the rest density or more.
    let off = |[few, many]: [f64; 2]| 1.5 * SUM_OFF / (many - few);
    let most = |image: &Image<f32>| f64::from(image.data.iter().copied().fold(0.0, f32::max));
    for (name, a, b, tolerance) in [
        ("foam", foam(&found), foam(&wanted), off(of_foam) / 0.05),
        ("spray", spray(&found), spray(&wanted), 1.5 * off(of_spray) / 0.2),
    ] {
        let tolerance = tolerance * most(&b);
        assert!(tolerance > 0.0, "{name}: nothing is drawn");
        compare::close(name, &a, &b.map(|v| f64::from(*v)), 0, |_, _, _| tolerance);
    }
    let streams = case.streams(&rig);
    let plain = streams.particles();
    let n = case.shot.positions.len() as u32;
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let counted = rig.stub.data(&n.to_le_bytes(), usage);
    let count = Count::Gpu { buffer: counted.buffer, offset: 0 };
    let bytes = packet_bytes(&case.shot, &[(0, n / 3), (n / 3, n - n / 3)]);
    let packets = rig.stub.data(&bytes, usage);
    let packets = Packets { buffer: packets.buffer, offset: 0, count: 2 };
    for (name, particles) in [
        ("crowd-count", plain.with(|it| it.count = count)),
        ("crowd-packets", plain.with(|it| it.packets = Some(packets))),
    ] {
        let drawn = rig.draw_particles(&case.shot, &particles);
        same_drawn(name, &drawn, &found);
        compare::same(&format!("{name}-foam"), &foam(&drawn), &foam(&found));
        compare::same(&format!("{name}-spray"), &spray(&drawn), &spray(&found));
    }
}
