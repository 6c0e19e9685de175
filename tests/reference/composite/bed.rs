//! Effect of water on the scene under it (Lekner and Dorf 1988), from Snell's law and the
//! reflectance alone:
//! ```text
//! F = mean of F(c) over 2 c dc    q = (1 - F) / n^2    wet = q E' / (1 - A (1 - q) T_in)
//! E' = (S exp(-k w h) + (1 - S) exp(-k h / c_s) (1 - F(sun)) / (1 - F)) / (S + 1 - S)
//! ```
//! for a bed of reflectance A under h of water, with the fraction S of the sky's light, its mean
//! path w per depth, and the sun's cosine c_s in water; T_in = exp(-5 k w h) is the way up and down
//! again.

use glam::{DVec2, DVec3};

use super::super::surface::Surface;
use super::super::{View, smoothstep};
use super::exit::{Off, bed_offset};
use super::{Fresnel, Inputs, Medium, Settings};

/// Light on the scene under water.
#[derive(Clone, Copy, Debug)]
pub struct Bed {
    /// Refractive index.
    pub index: f64,
    /// Fraction of the sky's light that enters the water.
    pub comes_in: f64,
    /// Mean path of that light per unit of depth.
    pub sky_way: f64,
    /// Path of the sun's light per unit of depth.
    pub sun_way: f64,
    /// Fraction of sunlight that enters, relative to that of the sky's light.
    pub sun: f64,
    /// Irradiance of level ground.
    pub irradiance: [f64; 3],
    /// Fraction of the irradiance that comes from the sky.
    pub shade: [f64; 3],
}

/// Mean over a uniform sky of a function of the cosine of incidence, by the midpoint rule.
fn over_sky(f: impl Fn(f64) -> f64) -> f64 {
    let steps = 20_000_u32;
    let sum: f64 = (0..steps)
        .map(|i| (f64::from(i) + 0.5) / f64::from(steps))
        .map(|cosine| 2.0 * cosine * f(cosine))
        .sum();
    sum / f64::from(steps)
}

impl Bed {
    /// For a surface with this reflectance, and a sun at the cosine `sun` from the vertical.
    pub fn new(fresnel: Fresnel, sun: f64, irradiance: [f64; 3], shade: [f64; 3]) -> Self {
        // At normal incidence the reflectance is ((n - 1) / (n + 1))^2.
        let index = match fresnel {
            Fresnel::Schlick { f0 } => 2.0 / (1.0 - f0.sqrt()) - 1.0,
            Fresnel::Source { .. } => 1.333,
        };
        let inside = |cosine: f64| (((1.0 - cosine * cosine).sqrt() / index).asin()).cos();
        let sun = sun.clamp(0.0, 1.0);
        let comes_in = over_sky(|cosine| 1.0 - fresnel.reflectance(cosine));
        Self {
            index,
            comes_in,
            sky_way: over_sky(|cosine| inside(cosine).recip()),
            sun_way: inside(sun).recip(),
            sun: (1.0 - fresnel.reflectance(sun)) / comes_in,
            irradiance,
            shade: [0, 1, 2].map(|i| (shade[i] / irradiance[i]).clamp(0.0, 1.0)),
        }
    }
}

/// How the water lies over the scene.
#[derive(Clone, Copy, Debug)]
pub struct Under {
    /// Fraction to which the scene behind is under water.
    pub wet: f64,
    /// Depth of that water in scene units, vertically.
    pub down: f64,
    /// Path through that water to the eye, in scene units.
    pub path: f64,
    /// Fraction to which it darkens the scene: a film, not at all.
    pub film: f64,
}

/// Water darkens the scene fully from 2 spacings on, and not at all below half a spacing.
pub fn film(settings: &Settings, thickness: f64) -> f64 {
    smoothstep(0.5, 2.0, thickness / (settings.radius / 0.656))
}

impl Under {
    pub fn of(settings: &Settings, surface: &Surface, view: &View) -> Self {
        let Surface { position, normal: n, thickness, room, .. } = *surface;
        let (v, up) = (-position.normalize(), view.view.transform_vector3(DVec3::Y));
        let straight = thickness * position.length() / -position.z;
        let Some(bed) = settings.bed else {
            return Self { wet: 0.0, down: 0.0, path: straight, film: 0.0 };
        };
        let filled = if room > 0.0 { thickness / room } else { 0.0 };
        let wet = smoothstep(0.5, 0.7, filled);
        let (level, rise) = (n.dot(up).max(0.0), v.dot(up));
        // Refraction conserves n sin along the surface; the component along the normal follows from
        // the length.
        let facing = n.dot(v).max(0.0);
        let inward = (1.0 - (1.0 - facing * facing) / bed.index.powi(2)).sqrt();
        // Slope of the refracted ray in the water, which is -((v - n facing) / index + n inward).
        let steep = (rise - level * facing) / bed.index + level * inward;
        let bent = (rise / steep.max(1.0e-6)).clamp(0.0, 1.0);
        let way = 1.0 + level * (bent - 1.0);
        let path = straight * (1.0 + wet * (way - 1.0));
        Self { wet, down: straight * rise.max(0.0), path, film: film(settings, thickness) }
    }

    /// As [`Under::of`], but a refracted ray that leaves the water beside the scene is not under it.
    pub fn met(
        inputs: &Inputs<'_>,
        settings: &Settings,
        surface: &Surface,
        view: &View,
        pixel: DVec2,
    ) -> Self {
        let under = Self::of(settings, surface, view);
        let Some(index) = settings.exit.filter(|_| under.wet > 0.0) else { return under };
        let by = (index, settings.radius / 0.656, &Off::default());
        let (_, touches) = bed_offset(inputs, surface, view, pixel, by);
        Self { wet: under.wet * touches, ..under }
    }
}

/// Colour of a scene under water from its dry colour.
pub fn under_water(settings: &Settings, under: &Under, dry: DVec3) -> DVec3 {
    let Some(bed) = settings.bed.filter(|_| under.wet > 0.0) else { return dry };
    let q = bed.comes_in / bed.index.powi(2);
    let extinction = match settings.medium {
        Medium::Physical { absorption, scattering, .. } => {
            DVec3::from(absorption) + DVec3::from(scattering)
        }
        Medium::Turbid { extinction, .. } => DVec3::from(extinction),
        Medium::Source { k: [r, g, b, _], .. } => DVec3::new(r, g, b),
    };
    let wet = [0, 1, 2].map(|i| {
        let (k, shade) = (extinction[i] * under.down, bed.shade[i]);
        let sky = (-k * bed.sky_way).exp();
        let came = shade * sky + (1.0 - shade) * bed.sun * (-k * bed.sun_way).exp();
        let albedo = (dry[i] * std::f64::consts::PI / bed.irradiance[i]).clamp(0.0, 1.0);
        // Light is reflected repeatedly between bed and surface: a geometric series.
        dry[i] * came * q / (1.0 - albedo * (1.0 - q) * sky.powi(5))
    });
    dry.lerp(DVec3::from(wet), under.wet * under.film)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WATER: Fresnel = Fresnel::Schlick { f0: 0.02 };

    /// For an index of 1.333, Fresnel's equations reflect 0.0665 of a uniform sky's light, and
    /// 0.472 of diffuse light from inside; Schlick's approximation is within a hundredth.
    #[test]
    fn what_comes_in_and_is_thrown_back_is_known() {
        let bed = Bed::new(WATER, 1.0, [3.0; 3], [1.0; 3]);
        assert!((bed.index - 1.333).abs() < 0.005, "{}", bed.index);
        assert!((1.0 - bed.comes_in - 0.0665).abs() < 5e-4, "{}", bed.comes_in);
        let back = 1.0 - bed.comes_in / bed.index.powi(2);
        assert!((back - 0.472).abs() < 0.002, "{back}");
        // Mean path per depth: 2 n^2 (1 - sqrt(1 - 1/n^2)); for a sun at the zenith 1.
        let n2 = bed.index.powi(2);
        let way = 2.0 * n2 * (1.0 - (1.0 - n2.recip()).sqrt());
        assert!((bed.sky_way - way).abs() < 1e-7, "{} and {way}", bed.sky_way);
        assert!((bed.sun_way - 1.0).abs() < 1e-12);
        // Light from the horizon refracts to the critical angle of 48.6 degrees, and none of it
        // enters.
        let low = Bed::new(WATER, 0.0, [3.0; 3], [1.0; 3]);
        let critical = low.sun_way.recip().acos().to_degrees();
        assert!((critical - 48.6).abs() < 0.3 && low.sun.abs() < 1e-12, "{critical}");
    }

    /// A white bed returns all light that enters, for any index; a grey one of 0.4 is darkened to
    /// 0.65 of its dry colour.
    #[test]
    fn a_wet_bed_is_darker_and_a_white_one_is_not() {
        let plain = super::super::tests::PLAIN;
        let clear =
            Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3], ambient: [0.0; 3] };
        for f0 in [0.0, 0.02, 0.3] {
            let fresnel = Fresnel::Schlick { f0 };
            let bed = Some(Bed::new(fresnel, 0.7, [1.0; 3], [1.0; 3]));
            let settings = Settings { medium: clear, bed, fresnel, ..plain };
            let under = Under { wet: 1.0, down: 3.0, path: 5.0, film: 1.0 };
            let dry = DVec3::new(1.0, 0.4, 0.0) / std::f64::consts::PI;
            let wet = under_water(&settings, &under, dry) / dry;
            assert!((wet.x - 1.0).abs() < 1e-12, "{wet}");
            if f0 == 0.02 {
                assert!((wet.y - 0.65).abs() < 0.005, "{wet}");
            }
        }
    }

    /// Through a level surface the path follows Snell's law: seen at 60 degrees from the vertical,
    /// it is 40.5 degrees inside.
    #[test]
    fn the_way_to_the_eye_is_bent() {
        use glam::{DMat4, DVec2};

        use crate::reference::tests::{Depth, projection};

        let view = DMat4::from_rotation_x(30.0_f64.to_radians());
        let p = projection(DVec2::new(1.2, -1.2), DVec2::ZERO, Depth::Standard);
        let view = View::new(view, p, 65, 65).expect("a valid view");
        let up = view.view.transform_vector3(DVec3::Y);
        let fresnel = Fresnel::Source { bias: 0.0, scale: 0.0, power: 1.0 };
        let bed = Some(Bed::new(fresnel, 1.0, [1.0; 3], [1.0; 3]));
        let settings = Settings { bed, fresnel, ..super::super::tests::PLAIN };
        let surface = super::super::tests::facing(DVec3::new(0.0, 0.0, -10.0), up, 2.0, 2.0);
        let under = Under::of(&settings, &surface, &view);
        assert!((under.down - 1.0).abs() < 1e-9, "{under:?}: half of the way, at 60 degrees");
        let inside = (60.0_f64.to_radians().sin() / 1.333).asin().cos();
        assert!((under.path - under.down / inside).abs() < 1e-9, "{under:?}");
        assert_eq!(under.wet, 1.0);
        // With air behind the water the path is straight.
        let surface = super::super::tests::facing(DVec3::new(0.0, 0.0, -10.0), up, 2.0, 4.0);
        let under = Under::of(&settings, &surface, &view);
        assert_eq!((under.wet, under.path), (0.0, 2.0));
    }
}
