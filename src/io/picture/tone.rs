//! From scene-referred light to a screen.

/// Where the shoulder begins.
const START: f32 = 0.72;

/// The shoulder of Khronos' PBR Neutral tone map: colours below 0.72 stay what they are, what is brighter is
/// pressed towards white with its hue kept. Its toe, which takes the 4 % that dielectrics reflect away from dark
/// colours, is left out: it turns the shadows of a blue sky to ink. Negative and NaN input gives 0, infinite input
/// white.
pub fn neutral(c: [f32; 3]) -> [f32; 3] {
    const DESATURATION: f32 = 0.15;
    // NaN goes to 0.
    let c = c.map(|v| if v > 0.0 { v.min(1.0e9) } else { 0.0 });
    let peak = c[0].max(c[1]).max(c[2]);
    if peak < START {
        return c;
    }
    let d = 1.0 - START;
    let pressed = 1.0 - d * d / (peak + d - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - pressed) + 1.0);
    c.map(|v| {
        let v = v * pressed / peak;
        v + (pressed - v) * white
    })
}

/// Linear to sRGB's curve; clamped to 0 to 1.
pub fn srgb_encode(v: f32) -> f32 {
    if v <= 0.003_130_8 {
        12.92 * v.max(0.0)
    } else {
        (1.055 * v.min(1.0).powf(1.0 / 2.4) - 0.055).min(1.0)
    }
}

/// sRGB's curve to linear.
pub fn srgb_decode(v: f32) -> f32 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neutral_keeps_dim_colours_and_never_leaves_the_range() {
        assert_eq!(neutral([0.5, 0.3, 0.0]), [0.5, 0.3, 0.0]);
        let mut before = -1.0;
        for i in 0..2000 {
            let v = 0.01 * 1.01_f32.powi(i);
            let [r, g, b] = neutral([0.2 * v, 0.6 * v, v]);
            assert!((0.0..=1.0).contains(&r) && r <= g && g <= b && b <= 1.0, "{v}: {r} {g} {b}");
            assert!(b >= before);
            before = b;
        }
        assert_eq!(neutral([f32::NAN, -1.0, 0.0]), [0.0; 3]);
        assert!(neutral([f32::INFINITY; 3]).iter().all(|v| *v > 0.99 && *v <= 1.0));
    }

    #[test]
    fn srgb_and_back() {
        for i in 0..=255 {
            let v = i as f32 / 255.0;
            assert!((srgb_encode(srgb_decode(v)) - v).abs() < 1e-5);
        }
    }
}
