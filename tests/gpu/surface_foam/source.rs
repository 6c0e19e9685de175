//! Compares the picture composed as in the thesis with its CPU twin, on the layers read back.

use glam::DVec3;
use whitewater::water::{Compositing, Fresnel, Medium, Shading};

use super::Foamy;
use super::picture::{veiled, whole};
use crate::composite::{SKY, Sky};
use crate::reference::composite::source::{self, Falloffs, Layers};
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, extent};
use crate::support::tolerance::U;

const BASE: [f32; 3] = [0.306, 0.545, 0.957];
const FALLOFF: [f32; 4] = [0.7, 0.6, 0.5, 0.8];
const REFLECTANCE: f32 = 0.25;
const FOAM: f32 = 2.0;

/// A pool with foam deep inside and a veil of foam over a part of it; then the same pool without
/// foam.
#[test]
fn the_sources_picture_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for shading in [Shading::Raster, Shading::Compute] {
        let config = whole(size, shading).with(|it| {
            it.sheets = 1;
            it.max_particles = 6000;
        });
        let mut rig = Rig::new(&gpu, &config);
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        let mut case = veiled(size);
        let water = &mut case.shot.settings.water;
        water.compositing = Compositing::Source;
        water.medium = Medium::Source { base: BASE, falloff: FALLOFF };
        // The reflectance is the same from every direction.
        water.fresnel = Fresnel::Source { bias: REFLECTANCE, scale: 0.0, power: 1.0 };
        let [open, veiled, under] = check(&case, &case.draw(&mut rig));
        assert!(open > 100 && veiled > 50 && under > 100, "{open} {veiled} {under}");

        let mut rig = Rig::new(&gpu, &config.with(|it| it.surface_foam = false));
        rig.environment(extent(SKY.0, SKY.1), &Sky::Even.texels());
        let [open, ..] = check(&case, &rig.draw(&case.shot));
        assert!(open > 100, "{open}");
    }
}

/// Counts the pixels without foam, those with a veil and little water before it, and those with
/// foam under water.
fn check(case: &Foamy, drawn: &Drawn) -> [usize; 3] {
    let view = case.shot.view(case.shot.size);
    let falloffs = Falloffs {
        base: BASE.map(f64::from).into(),
        color: DVec3::from([FALLOFF[0], FALLOFF[1], FALLOFF[2]].map(f64::from)),
        behind: f64::from(FALLOFF[3]),
        foam: f64::from(FOAM),
    };
    let (back, front) = (DVec3::new(0.7, 0.6, 0.5), DVec3::new(0.9, 0.8, 0.7));
    let mut kinds = [0; 3];
    for (i, color) in drawn.output.data.iter().enumerate() {
        let (x, y) = (i % 97, i / 97);
        if drawn.depth.data[i] >= 1e9 {
            continue;
        }
        let t = f64::from(drawn.thickness.data[i]);
        // Without foam all water counts as before it.
        let (foam, layer, before) = drawn.foam.as_ref().map_or((0.0, 0.0, t), |found| {
            let [foam, layer] = found.thickness.data[i].map(f64::from);
            (foam, layer, f64::from(found.before.data[i]).min(t))
        });
        let long = view.ray(x, y).length();
        let [r, g, b, _] = case.shot.color[i].map(f64::from);
        let layers = Layers {
            water: [t - before, before].map(|metres| metres * long),
            foam: foam * long,
            foam_color: front.lerp(back, (-5.0 * layer * long).exp()),
            background: DVec3::new(r, g, b),
            added: f64::from(REFLECTANCE) * Sky::Even.radiance(DVec3::Z),
        };
        let expected = source::color(&layers, &falloffs);
        kinds[0] += usize::from(foam == 0.0 && t > 0.5);
        kinds[1] += usize::from(foam > 0.01 && before < 0.05);
        kinds[2] += usize::from(foam > 0.01 && before > 0.5);
        // Exponents of a few units in metres, as in the other composite, and one more product and
        // sum.
        let bound = 500.0 * U * (1.0 + expected.max_element());
        for c in 0..3 {
            let (found, expected) = (f64::from(color[c]), expected[c]);
            assert!((found - expected).abs() <= bound, "({x}, {y}) {c}: {found}, {expected}");
        }
    }
    kinds
}
