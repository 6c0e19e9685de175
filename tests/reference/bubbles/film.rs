//! Twin of the film's table: the sum of all light reflected inside a soap film in air, with phases.

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Sub};

/// A complex number.
#[derive(Clone, Copy)]
struct Complex(f64, f64);

impl Add for Complex {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0, self.1 + o.1)
    }
}
impl Sub for Complex {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0, self.1 - o.1)
    }
}
impl Mul for Complex {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }
}
impl Div for Complex {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let n = o.0 * o.0 + o.1 * o.1;
        self * Self(o.0 / n, -o.1 / n)
    }
}

/// Reflectance of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Face {
    Exact,
    Schlick,
    Source,
}

/// Cosine of the ray inside.
pub fn inside(cosine: f64, index: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).sqrt() / index;
    (1.0 - sine * sine).sqrt()
}

/// Amplitudes reflected by a face from outside, for both polarizations.
fn amplitudes(cosine: f64, index: f64, face: Face) -> [f64; 2] {
    let within = inside(cosine, index);
    match face {
        Face::Exact => {
            // From the angles (Fresnel's own form), unless they are 0.
            let (i, t) = (cosine.acos(), within.acos());
            if i < 1e-6 {
                let r = (1.0 - index) / (1.0 + index);
                return [r, -r];
            }
            [-(i - t).sin() / (i + t).sin(), (i - t).tan() / (i + t).tan()]
        }
        Face::Schlick => {
            let r0 = ((index - 1.0) / (index + 1.0)).powi(2);
            [(r0 + (1.0 - r0) * (1.0 - cosine).powi(5)).sqrt(); 2]
        }
        Face::Source => [(1.0 - cosine).sqrt(); 2],
    }
}

/// Reflectance of a film for unpolarized light of one wavelength; lengths in nanometres.
pub fn reflectance(cosine: f64, index: f64, thickness: f64, wavelength: f64, face: Face) -> f64 {
    let phase = 4.0 * PI * index * thickness * inside(cosine, index) / wavelength;
    let faces = amplitudes(cosine, index, face);
    if face == Face::Source {
        return (4.0 * faces[0].powi(2) * (phase / 2.0).sin().powi(2)).min(1.0);
    }
    let turn = Complex(phase.cos(), phase.sin());
    let one = Complex(1.0, 0.0);
    let share = |r: f64| {
        if (1.0 - r.abs()) < 1e-12 {
            return if phase == 0.0 { 0.0 } else { 1.0 };
        }
        // r - r t + r^3 ...: reflection by the first face, minus all repeated reflections from the
        // second.
        let sum = Complex(r, 0.0) * (one - turn) / (one - Complex(r * r, 0.0) * turn);
        sum.0 * sum.0 + sum.1 * sum.1
    };
    (share(faces[0]) + share(faces[1])) / 2.0
}

/// The CIE 1931 observer (Wyman, Sloan, Shirley 2013), converted to linear Rec. 709.
pub fn color(w: f64) -> [f64; 3] {
    let lobe = |middle: f64, below: f64, above: f64| {
        let t = (w - middle) * if w < middle { below } else { above };
        (-t * t / 2.0).exp()
    };
    let x = 0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323)
        - 0.065 * lobe(501.1, 0.0490, 0.0382);
    let y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322);
    let z = 1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725);
    [
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266_0 * x + 1.876_010_8 * y + 0.041_556_0 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    ]
}

/// The wavelengths that represent red, green and blue.
pub const LINES: [f64; 3] = [610.0, 550.0, 465.0];

/// Reflected light for an illumination that is equal at all wavelengths, and the sum's error per
/// error of its terms: weights may be negative.
pub fn spectral(cosine: f64, index: f64, thickness: f64, face: Face) -> ([f64; 3], [f64; 3]) {
    let (mut sum, mut all, mut sizes) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    for i in 0..81 {
        let w = 380.0 + 5.0 * f64::from(i);
        let share = reflectance(cosine, index, thickness, w, face);
        for (c, part) in color(w).into_iter().enumerate() {
            sum[c] += part * share;
            all[c] += part;
            sizes[c] += part.abs();
        }
    }
    let parts = [0, 1, 2];
    (parts.map(|c| sum[c] / all[c]), parts.map(|c| sizes[c] / all[c]))
}
