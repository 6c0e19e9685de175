//! Twin of the source's composite of one pixel (thesis Sec. 3.2.3, Listing A.20 with Eq. 3.5 to
//! 3.7):
//! ```text
//! c_wb = base exp(-T_wb k)    a_wb = exp(-T_wb k_a)    likewise for wf   a_f = exp(-k_f T_f)
//! C_wb = mix(c_wb, C_background, a_wb)    C_f = mix(c_foam, C_wb, a_f)    C_wf = mix(c_wf, C_f, a_wf)
//! C = C_wf + (F env + highlight) sat(1 - a_wf + a_f) (1 - a_wf)
//! ```
//! The listing's last line has one bracket too many; it is read so that reflection and highlight
//! have the same weight.

use glam::DVec3;

/// The layers of a pixel along its ray, its background and its reflection.
#[derive(Clone, Copy, Debug)]
pub struct Layers {
    /// Thickness of the water behind and before the frontmost foam.
    pub water: [f64; 2],
    /// Thickness of the foam.
    pub foam: f64,
    /// Colour of the foam.
    pub foam_color: DVec3,
    /// Colour of the background.
    pub background: DVec3,
    /// Reflected light times the reflectance, and the highlight.
    pub added: DVec3,
}

/// Falloffs of the light.
#[derive(Clone, Copy, Debug)]
pub struct Falloffs {
    /// The water's own colour.
    pub base: DVec3,
    /// Falloff of that colour per scene unit of water.
    pub color: DVec3,
    /// Falloff of the background per scene unit of water.
    pub behind: f64,
    /// Falloff of the background per scene unit of foam.
    pub foam: f64,
}

/// Weight of the added light, from the transmittances of the front water and of the foam.
pub fn weight(front_water: f64, foam: f64) -> f64 {
    (1.0 - front_water + foam).clamp(0.0, 1.0) * (1.0 - front_water)
}

/// The colour of the pixel.
pub fn color(layers: &Layers, falloffs: &Falloffs) -> DVec3 {
    let through = |behind: DVec3, metres: f64| {
        let own = falloffs.base * (-metres * falloffs.color).exp();
        let kept = (-metres * falloffs.behind).exp();
        (own.lerp(behind, kept), kept)
    };
    let [back, front] = layers.water;
    let (back_water, _) = through(layers.background, back);
    let foam = (-layers.foam * falloffs.foam).exp();
    let (all, front_water) = through(layers.foam_color.lerp(back_water, foam), front);
    all + layers.added * weight(front_water, foam)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without water there is no surface; deep water has the full weight, unless all of it is
    /// behind opaque foam.
    #[test]
    fn foam_in_front_does_not_shine() {
        assert_eq!(weight(1.0, 1.0), 0.0);
        assert_eq!(weight(1.0, 0.0), 0.0);
        assert_eq!(weight(0.0, 1.0), 1.0);
        assert_eq!(weight(0.0, 0.0), 1.0);
        // A veil of foam behind a little water: the weight of the water.
        assert!((weight(0.9, 1.0) - 0.1).abs() < 1.0e-12);
        // Opaque foam behind a little water: the weight squared.
        assert!((weight(0.9, 0.0) - 0.01).abs() < 1.0e-12);
    }
}
