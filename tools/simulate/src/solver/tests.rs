//! Tests of the solver: equal results for any number of threads, water in a turning pipe, and the covered fraction of
//! solids.

use glam::Quat;

use super::*;
use crate::hinge::Hinge;
use crate::scene::{Fill, Shape, Solid};

fn run(threads: usize) -> Frame {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("a thread pool").install(|| {
        let mut simulation = Simulation::new(crate::scenes::waterfall(), 0.09, 1);
        simulation.advance_to(0.05);
        simulation.frame()
    })
}

#[test]
fn the_number_of_threads_changes_nothing() {
    assert_eq!(run(1), run(3));
}

/// A tilted pipe with water, on an axle below it: the scene 'bamboo' without the rest. A counterweight has `part` of
/// the water's moment.
fn pipe(part: f32) -> Simulation {
    let bamboo = crate::scenes::bamboo();
    let (angle, axle) = (-60_f32.to_radians(), Vec3::ZERO);
    let along = Quat::from_rotation_z(angle) * Vec3::Y;
    let solid = |shape, from: f32, to: f32, radius: f32| {
        let half = Vec3::new(radius, 0.5 * (to - from), radius);
        let centre = along * (0.5 * (from + to));
        let solid = Solid::new("pipe", "bamboo", shape, centre, half, angle);
        Solid { moves: true, ..solid }
    };
    let hinge = Hinge {
        axle,
        mass: 1.0,
        lever: Vec3::ZERO,
        inertia: 0.05,
        range: [-0.5, 0.0],
        ..bamboo.hinge.clone().expect("has one")
    };
    let foot = along * 0.1;
    let scene = Scene {
        solids: vec![
            solid(Shape::Tube { bore: 0.07, slope: 0.0 }, 0.06, 0.5, 0.095),
            solid(Shape::Cylinder, 0.06, 0.1, 0.07),
        ],
        fills: vec![Fill::Bore { foot, angle, radius: 0.07, length: 0.4, level: 0.15 }],
        inlets: Vec::new(),
        hinge: Some(hinge),
        lead: 0.0,
        ..bamboo
    };
    let mut simulation = Simulation::new(scene, 0.02, 1);
    simulation.advance_to(0.0);
    let moment: f32 = simulation.position.iter().map(|at| simulation.mass * at.x).sum();
    if let Some(hinge) = &mut simulation.scene.hinge {
        hinge.lever = -along * (part * moment / along.x);
    }
    simulation
}

#[test]
fn a_pipe_holds_its_water_and_feels_its_weight() {
    let mut held = pipe(1.1);
    let count = held.position.len();
    held.advance_to(0.5);
    assert_eq!((held.turn(), held.lost()), (0.0, 0));
    let spilt = held.position.iter().filter(|at| !held.obstacles[0].solid.holds(**at));
    assert_eq!(spilt.count(), 0, "of {count}");
    let mut tipped = pipe(0.9);
    tipped.advance_to(0.5);
    assert!(tipped.turn() < -0.02, "{}", tipped.turn());
}

#[test]
fn a_pipe_that_turns_takes_its_water_along() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a thread pool").install(|| {
            let mut simulation = pipe(0.2);
            simulation.advance_to(0.4);
            (simulation.turn(), simulation.frame(), simulation)
        })
    };
    let (turn, frame, simulation) = run(1);
    assert!(turn < -0.3, "{turn}");
    // Water can leave through the mouth, but not through the wall.
    for at in &simulation.position {
        let solid = &simulation.obstacles[0].solid;
        let local = Quat::from_rotation_z(-solid.angle) * (*at - solid.centre);
        assert!(local.y > -0.22, "{local}");
        assert!(local.x.hypot(local.z) < 0.07 || local.y > 0.22, "{local}");
    }
    let (other_turn, other_frame, _) = run(3);
    assert_eq!((turn, frame), (other_turn, other_frame));
}

#[test]
fn the_gradient_of_the_cover_is_its_derivative() {
    let simulation = Simulation::new(crate::scenes::waterfall(), 0.09, 1);
    let at = Vec3::new(-1.43, 0.06, 0.85);
    let gradient = simulation.covered(at).1;
    for axis in Vec3::AXES {
        let step = axis * 2e-3;
        let numeric = (simulation.covered(at + step).0 - simulation.covered(at - step).0) / 4e-3;
        assert!((numeric - gradient.dot(axis)).abs() < 0.03 * gradient.length() + 0.02);
    }
}
