//! GLSL's smoothstep.

/// Rises from 0 at `from` and below to 1 at `to` and above.
pub fn smoothstep([from, to]: [f32; 2], x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_rises_between_its_limits() {
        let cases = [
            (-9.0, 0.0),
            (0.2, 0.0),
            (0.25, 0.15625),
            (0.3, 0.5),
            (0.4, 1.0),
            (f32::INFINITY, 1.0),
        ];
        for (x, wanted) in cases {
            assert!((smoothstep([0.2, 0.4], x) - wanted).abs() < 1.0e-6, "{x}");
        }
    }
}
