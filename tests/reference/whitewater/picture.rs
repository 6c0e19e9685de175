//! Intensity of foam, and foam composited over a picture.

use glam::DVec3;

/// Opacity of foam with a thickness: `rho^e / (m + rho^e)`.
pub fn intensity(thickness: f64, modifier: f64, power: f64) -> f64 {
    let grown = thickness.max(0.0).powf(power);
    grown / (modifier + grown)
}

/// Fraction of each channel that the shadow removes.
pub fn zeta_final(zeta: f64, shadow_colour: DVec3) -> DVec3 {
    (zeta * (1.0 - shadow_colour)).clamp(DVec3::ZERO, DVec3::ONE)
}

/// Foam over a background as in the source: the light is clamped to 1, and the shadow is
/// subtracted.
pub fn composite_source(
    background: DVec3,
    intensity: f64,
    zeta: f64,
    irradiance: DVec3,
    shadow_colour: DVec3,
    scale: DVec3,
) -> DVec3 {
    let light = (scale * irradiance).clamp(DVec3::ZERO, DVec3::ONE);
    let foam = (light - zeta_final(zeta, shadow_colour)).max(DVec3::ZERO);
    (1.0 - intensity) * background + intensity * foam
}

/// Foam over a background for light of any brightness: the light is multiplied by what the shadow
/// leaves.
pub fn composite_hdr(
    background: DVec3,
    intensity: f64,
    zeta: f64,
    irradiance: DVec3,
    shadow_colour: DVec3,
    scale: DVec3,
) -> DVec3 {
    let foam = scale * irradiance * (1.0 - zeta_final(zeta, shadow_colour));
    (1.0 - intensity) * background + intensity * foam
}
