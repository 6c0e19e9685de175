//! Intensity, and foam composited over a picture.

use glam::DVec3;

/// How much of what is behind it foam of a thickness hides, `rho^e / (m + rho^e)`.
pub fn intensity(thickness: f64, modifier: f64, power: f64) -> f64 {
    let grown = thickness.max(0.0).powf(power);
    grown / (modifier + grown)
}

/// What the shadow takes of each channel.
pub fn zeta_final(zeta: f64, shadow_colour: DVec3) -> DVec3 {
    (zeta * (1.0 - shadow_colour)).clamp(DVec3::ZERO, DVec3::ONE)
}

/// Foam over a background as the source has it: light of at most 1, less the shadow.
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

/// The same for light of any brightness: the shadow takes its part of it.
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
