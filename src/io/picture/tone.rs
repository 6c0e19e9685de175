//! Tone maps: from scene-referred light to a screen.

/// Value at which the shoulder begins.
const START: f32 = 0.72;

/// The shoulder of Khronos' PBR Neutral tone map, here from 0.72 on: colours whose channels are all below 0.72 are
/// unchanged, brighter ones are compressed towards white with their hue kept. The toe of that tone map, which
/// subtracts the 4 % that dielectrics reflect, is omitted, because it makes shadows under a blue sky nearly black. A
/// negative or NaN channel counts as 0. A colour with an infinite channel becomes white.
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

/// Tone map from scene-referred light to displayed light, both linear Rec. 709.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tone {
    /// No tone map: the screen clips each channel at 1.
    Linear,
    /// [`neutral`]: colours below 0.72 are unchanged.
    #[default]
    Neutral,
    /// [`aces`].
    Aces,
    /// [`agx`].
    Agx,
}

impl Tone {
    /// Maps a colour. Negative and NaN input counts as 0, input above 1e9 as 1e9.
    pub fn map(self, c: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Linear => c.map(light),
            Self::Neutral => neutral(c),
            Self::Aces => aces(c),
            Self::Agx => agx(c),
        }
    }
}

/// Clamps a channel to finite, non-negative values.
fn light(v: f32) -> f32 {
    // NaN becomes 0.
    if v > 0.0 { v.min(1.0e9) } else { 0.0 }
}

/// Product of a matrix, given by rows, and a colour.
fn times(rows: [[f32; 3]; 3], c: [f32; 3]) -> [f32; 3] {
    rows.map(|row| row[0] * c[0] + row[1] * c[1] + row[2] * c[2])
}

/// The film curve of the Academy Color Encoding System: Stephen Hill's fit of its reference rendering and
/// output transforms (RRT and ODT for sRGB). Light is multiplied by 1/0.6, as is usual in engines: mid grey is
/// displayed slightly brighter than it is, lit white slightly darker than white.
pub fn aces(c: [f32; 3]) -> [f32; 3] {
    const IN: [[f32; 3]; 3] = [
        [0.597_19, 0.354_58, 0.048_23],
        [0.076_00, 0.908_34, 0.015_66],
        [0.028_40, 0.133_83, 0.837_77],
    ];
    const OUT: [[f32; 3]; 3] = [
        [1.604_75, -0.531_08, -0.073_67],
        [-0.102_08, 1.108_13, -0.006_05],
        [-0.003_27, -0.072_76, 1.076_02],
    ];
    let fit = |v: f32| {
        let above = v * (v + 0.024_578_6) - 0.000_090_537;
        above / (v * (0.983_729 * v + 0.432_951) + 0.238_081)
    };
    let c = times(IN, c.map(|v| light(v) / 0.6)).map(fit);
    times(OUT, c).map(|v| v.clamp(0.0, 1.0))
}

/// Troy Sobotka's AgX, with Benjamin Wrensch's polynomial for its curve: a film curve that turns bright colours pale
/// on the way to white, where [`aces`] and clipping keep them saturated. The curve covers sixteen and a half stops,
/// four of them above 1. Light is multiplied by 2 before the curve, and the curve's value is raised to the power 1.35
/// (as in AgX's "punchy" look), so that lit white is nearly white on the screen.
pub fn agx(c: [f32; 3]) -> [f32; 3] {
    const IN: [[f32; 3]; 3] = [
        [0.842_479_06, 0.078_433_6, 0.079_223_745],
        [0.042_328_242, 0.878_468_64, 0.079_166_13],
        [0.042_375_655, 0.078_433_6, 0.879_143],
    ];
    const OUT: [[f32; 3]; 3] = [
        [1.196_879, -0.098_020_88, -0.099_029_74],
        [-0.052_896_85, 1.151_903_1, -0.098_961_18],
        [-0.052_971_635, -0.098_043_45, 1.151_073_7],
    ];
    const STOPS: [f32; 2] = [-12.473_93, 4.026_069];
    const GAIN: f32 = 2.0;
    const POWER: f32 = 1.35;
    let curve = |v: f32| {
        let stops = v.max(1.0e-10).log2().clamp(STOPS[0], STOPS[1]);
        let x = (stops - STOPS[0]) / (STOPS[1] - STOPS[0]);
        // Coefficients, from the highest power to the lowest.
        let terms = [15.5, -40.14, 31.96, -6.868, 0.429_8, 0.119_1, -0.002_32];
        terms.into_iter().fold(0.0, |sum, term| sum * x + term).max(0.0).powf(POWER)
    };
    let c = times(IN, c.map(|v| GAIN * light(v))).map(curve);
    times(OUT, c).map(|v| v.clamp(0.0, 1.0).powf(2.2))
}

/// Encodes linear light with sRGB's curve; input is clamped to 0 to 1.
pub fn srgb_encode(v: f32) -> f32 {
    if v <= 0.003_130_8 {
        12.92 * v.max(0.0)
    } else {
        (1.055 * v.min(1.0).powf(1.0 / 2.4) - 0.055).min(1.0)
    }
}

/// Decodes sRGB's curve to linear light.
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

    /// The film curves ACES and AgX are monotonic, and their values stay from 0 to 1. Grey stays grey; mid grey and
    /// lit white stay about as bright. With AgX a bright cyan becomes pale instead of saturated.
    #[test]
    fn film_curves_rise_to_white() {
        for (tone, mid, white) in [(Tone::Aces, 0.2..0.26, 0.7), (Tone::Agx, 0.17..0.3, 0.55)] {
            let of = |c| tone.map(c);
            let mut before = -1.0;
            for i in 0..2400 {
                let v = 1.0e-4 * 1.01_f32.powi(i);
                let [r, g, b] = of([v; 3]);
                assert!(
                    (0.0..=1.0).contains(&g) && g >= before,
                    "{tone:?} {v}: {g} after {before}"
                );
                assert!((r - g).abs() < 2.0e-3 && (b - g).abs() < 2.0e-3, "{tone:?}: {r} {g} {b}");
                before = g;
            }
            let [_, grey, _] = of([0.2; 3]);
            let [_, lit, _] = of([1.1; 3]);
            assert!(
                mid.contains(&grey) && lit > white && before > 0.97,
                "{tone:?}: {grey} {lit} {before}"
            );
            assert!(of([0.0; 3]).iter().all(|v| *v < 1.0e-3), "{tone:?}");
            assert_eq!(of([f32::NAN, -1.0, 0.0]), of([0.0; 3]));
            assert!(of([f32::INFINITY; 3]).iter().all(|v| *v > 0.95 && *v <= 1.0));
        }
        // Cyan, as of light that passed through much water.
        let least = |tone: Tone| tone.map([1.0, 6.0, 6.0])[0];
        assert!(least(Tone::Agx) > 0.6, "{}", least(Tone::Agx));
        assert_eq!(Tone::Linear.map([0.5, 7.0, f32::NAN]), [0.5, 7.0, 0.0]);
        assert_eq!(Tone::default().map([0.9, 3.0, 0.1]), neutral([0.9, 3.0, 0.1]));
    }

    /// Saturated colours are those of the published matrices and curves, evaluated in double precision.
    #[test]
    fn film_curves_mix_colours_as_published() {
        for (light, aces, agx) in [
            ([0.5, 0.1, 0.05], [0.58947, 0.10959, 0.04634], [0.54328, 0.15378, 0.08333]),
            ([0.1, 0.4, 0.05], [0.15179, 0.47429, 0.06502], [0.15632, 0.46155, 0.08865]),
            ([0.05, 0.2, 0.6], [0.05340, 0.24285, 0.60465], [0.11390, 0.28178, 0.56625]),
        ] {
            for (tone, expected) in [(Tone::Aces, aces), (Tone::Agx, agx)] {
                let found = tone.map(light);
                // The curves and products round a dozen times.
                let off = found.iter().zip(expected).map(|(a, b): (_, f32)| (a - b).abs());
                assert!(off.into_iter().all(|off| off < 2.0e-5), "{tone:?} {light:?}: {found:?}");
            }
        }
    }

    /// Pairs of light and its code, from the formula of IEC 61966-2-1 in double precision.
    #[test]
    fn srgb_is_the_standards_curve() {
        for (light, code) in [
            (0.001, 0.012_92),
            (0.003_130_8, 0.040_45),
            (0.01, 0.099_852_8),
            (0.214_041_1, 0.5),
            (0.5, 0.735_357),
            (1.0, 1.0),
        ] {
            assert!((srgb_encode(light) - code).abs() < 1.0e-6, "{light}: {}", srgb_encode(light));
            assert!((srgb_decode(code) - light).abs() < 1.0e-6, "{code}: {}", srgb_decode(code));
        }
    }

    #[test]
    fn srgb_and_back() {
        for i in 0..=255 {
            let v = i as f32 / 255.0;
            assert!((srgb_encode(srgb_decode(v)) - v).abs() < 1e-5);
        }
    }
}
