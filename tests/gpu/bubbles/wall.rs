//! Construction of the walls: a wall passes through the common circle of two bubbles, and its
//! tangent there bisects the angle between them.

use glam::DVec3;

use crate::reference::bubbles::wall::{angle, between, common};
use crate::support::scenes::Random;

/// Pairs of bubbles that intersect, the larger one first.
fn pairs(count: usize) -> impl Iterator<Item = ((DVec3, f64), (DVec3, f64))> {
    let mut random = Random(41);
    (0..count).map(move |_| {
        let mut number = |low, high| f64::from(random.between(low, high));
        let a = DVec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0));
        let (r_a, part) = (number(0.5, 2.0), number(0.1, 0.98));
        let r_b = r_a * part;
        let way = DVec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(0.1, 1.0)).normalize();
        let apart = r_a - r_b + number(0.02, 0.98) * 2.0 * r_b;
        ((a, r_a), (a + way * apart, r_b))
    })
}

#[test]
fn walls_pass_through_the_common_circle_and_halve_its_angle() {
    for (a, b) in pairs(20_000) {
        let wall = between(a, b);
        for turn in [0.3, 2.0, 4.4] {
            let m = common(a, b, turn);
            let scale = a.1.max(wall.radius);
            assert!((m.distance(wall.center) - wall.radius).abs() < 1e-9 * scale, "{a:?} {b:?}");
            // The wall's radius at M makes equal angles with those of both bubbles.
            let normal = (m - wall.center).normalize();
            let to = [a, b].map(|(c, _)| (c - m).normalize().dot(normal));
            assert!((to[0] + to[1]).abs() < 1e-6, "{to:?} of {a:?} {b:?}");
        }
    }
}

#[test]
fn films_that_meet_at_120_degrees_have_laplaces_wall() {
    for (a, (direction, r_b)) in pairs(2000) {
        let apart = (a.1 * a.1 + r_b * r_b - a.1 * r_b).sqrt();
        let b = (a.0 + (direction - a.0).normalize() * apart, r_b);
        assert!((angle(a.1, r_b, apart).to_degrees() - 60.0).abs() < 1e-9);
        let wall = between(a, b);
        let curvature = 1.0 / r_b - 1.0 / a.1;
        assert!((1.0 / wall.radius - curvature).abs() < 1e-9 * (1.0 + curvature), "{a:?} {b:?}");
    }
}
