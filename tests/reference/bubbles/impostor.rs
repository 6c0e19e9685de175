//! Intersection of a ray with all bubbles of a blob, by brute force.

use glam::{DQuat, DVec3};

/// First bubble that a ray with unit direction hits at a distance of `near` or more: the distance
/// and the bubble's index.
pub fn first(
    bubbles: &[[f32; 4]],
    origin: DVec3,
    direction: DVec3,
    near: f64,
) -> Option<(f64, usize)> {
    let hits = bubbles.iter().enumerate().filter_map(|(i, b)| {
        let [x, y, z, r] = b.map(f64::from);
        let to = DVec3::new(x, y, z) - origin;
        let along = to.dot(direction);
        let left = r * r - (to - along * direction).length_squared();
        if left < 0.0 {
            return None;
        }
        let (t, past) = (along - left.sqrt(), along + left.sqrt());
        (past > near).then(|| (t.max(near), i))
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Transforms a ray from world space to the blob's space.
pub fn into_blob(ball: [f32; 4], turn: [f32; 4], eye: DVec3, along: DVec3) -> (DVec3, DVec3) {
    let [x, y, z, r] = ball.map(f64::from);
    let back = DQuat::from_array(turn.map(f64::from)).normalize().inverse();
    (back * (eye - DVec3::new(x, y, z)) / r, back * along.normalize())
}
