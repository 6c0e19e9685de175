//! Minimum traffic of each pass in bytes: every input read once and every output written once, at their actual sizes.
//! Caches may save repeated reads; no pass can save these.

use whitewater::water::{Convolution, Shadows, Splat};

use super::Drawn;

/// Minimum bytes of a pass, by the name of its shader; `None` for a pass that is not listed here.
pub fn moved(pass: &str, drawn: &Drawn) -> Option<u64> {
    let pixels = |level: u32| {
        let size = |n: u32| u64::from(n.div_ceil(1 << level));
        size(drawn.extent.width) * size(drawn.extent.height)
    };
    let full = pixels(0);
    let reduced = pixels(drawn.config.smoothing_level);
    let thick = pixels(drawn.config.thickness_level);
    let visible = u64::from(drawn.counts.visible);
    let front = u64::from(drawn.counts.front);
    let texels = u64::from(drawn.config.light_map_size.unwrap_or(0)).pow(2);
    let foam = drawn.foam;
    Some(match pass {
        // Positions in, spheres out.
        "cull" => 12 * u64::from(drawn.particles) + 16 * visible,
        // Spheres in twice, cells cleared and read, front spheres out.
        "front" => 32 * visible + 2 * full / 16 * 4 + 16 * front,
        // Cleared, spheres in, covered pixels written.
        "depth" => 4 * full + 16 * front + 4 * drawn.covered,
        // Two words a particle in. For each foaming particle: position and velocity in, sprite out and in twice. Depth
        // and thickness out; without blending, two sums are cleared and read.
        "surface_foam" => {
            let summed = drawn.config.thickness_splat != Some(Splat::Raster);
            let texel = if summed { 4 + 8 + 16 } else { 4 + 8 };
            8 * u64::from(drawn.particles) + (24 + 3 * 64) * drawn.foaming + texel * thick
        }
        // Positions and densities in. For each spray particle: position in, sprite out and in. The image is cleared.
        // The traffic of blending is not counted.
        "spray" => {
            4 * u64::from(drawn.particles) + (12 + 64) * u64::from(drawn.counts.spray) + 4 * full
        }
        // Depth in; two depths a texel out and in; sums cleared, and for visible particles added to and read; positions
        // and velocities in; depth, scene depth and surface in, motion vectors out.
        "motion" => {
            let sums = if drawn.config.thickness_level == 0 { 32 } else { 64 };
            let covered = drawn.covered / (full / thick).max(1);
            (4 + 4 + 8) * full
                + 4 * (full - drawn.covered)
                + 4 * reduced
                + (16 + sums) * thick
                + 3 * 32 * covered
                + 24 * u64::from(drawn.particles)
        }
        // Positions in. For each front sprite at least: sprite out and in. The image is cleared, depth read at its
        // texels. The traffic of blending is not counted.
        "noise" => {
            let texels = pixels(drawn.config.noise.unwrap_or(0));
            12 * u64::from(drawn.particles) + 32 * front + 8 * texels
        }
        // Positions in twice, both maps cleared.
        "light" => 24 * u64::from(drawn.particles) + 20 * texels,
        // Four words a texel out and in again, front in, four half floats a texel out; positions, kinds, ages and ids
        // in. The traffic of atomics is not counted. Without particles the map is only cleared.
        "whitewater_light" => match u64::from(drawn.whitewater) {
            0 => 8 * texels,
            whitewater => (16 + 16 + 4 + 8) * texels + 24 * whitewater,
        },
        // Front in and smoothed twice, thickness in, photons cleared, added to and read, caustics out.
        "caustics" => (4 * 4 + 4 + 16 + 12 + 4 + 4) * texels,
        // The shadow map in, once for its depth range and once for each page; a page of half floats out and in twice,
        // and into the basis.
        "convolution" => match drawn.config.shadow {
            Some(Shadows::Convolution(Convolution { terms, texels, bits })) => {
                let texels = u64::from(texels).pow(2);
                // The stand-in scene's map.
                let map = 4 * 2048_u64.pow(2);
                let pages = u64::from(terms / 2);
                map + pages * (map + texels * (32 + u64::from(bits / 2)))
            }
            _ => 0,
        },
        // Scene colour and depth in, lit scene out, in, and to the output. The maps are not counted.
        "lit" => (8 + 4 + 8 + 8 + 8) * full,
        // Depth in, scene depth of covered pixels in, two surfaces and the plan out.
        "reduce" => 4 * full + 4 * drawn.covered + 12 * reduced,
        // Without near water, one word for each tile of the coarser levels. With near water the traffic is not counted.
        "level" => 4 * reduced / 256 / 3,
        // Spheres in; two words a cell cleared, added to and read; three words of depth written, two of them read; the
        // texel's result out.
        "gaps" => 16 * (front + visible) + full / 64 * 4 * 11 + 4 * thick,
        // Spheres in. What the pass writes for tiles near a boundary is not counted.
        "back" => 16 * visible,
        "tiles" => 8 * reduced / 256,
        // The list in and out, boundaries in.
        "split" => 8 * reduced / 256 + if drawn.config.sheets > 1 { 4 * thick } else { 0 },
        // For each active texel and iteration of the level that is shown: surface and plan in, surface out.
        "smooth" => 12 * drawn.iterations,
        // Spheres in; sums (two words) cleared, the first added to, both read; thickness out. With two sheets: two more
        // sums, the first read again, both sheets out, boundaries in and out.
        "thickness" => {
            let apart = if drawn.config.sheets > 1 { 32 + 8 + 16 + 8 } else { 0 };
            // Foam needs one more sum (the thickness in front of it), its channel and its depth in.
            let foam = if drawn.config.surface_foam { 16 + 4 + 4 } else { 0 };
            16 * visible + (24 + apart + foam) * thick
        }
        // Two depths in, eight words a pixel out and in again; two images of four floats and one of half floats out;
        // positions, kinds, ages and ids in for each dispatch. The traffic of atomics is not counted.
        "splat" => {
            let read = drawn.goes * 24 * u64::from(drawn.whitewater);
            (8 + 32 + 32 + 32 + 8) * full + read
        }
        // Depths in twice, the water's depth in once, light out; for foam pixels the normal in. The samples are not
        // counted.
        "radiance" => (16 + 4 + 16 + 8) * full + 8 * foam,
        // Twice: depth and light in, light out; for foam pixels the normal in.
        "blur" => 2 * ((16 + 8 + 8) * full + 8 * foam),
        // Depth of the whole picture in.
        "shore-tiles" => 4 * full,
        // Foam cleared; for pixels with foam, depth in and foam out.
        "shoreline" => 4 * full + 8 * drawn.coat,
        // A copy of half-float colour.
        "scene" => 16 * full,
        // Depth, thickness, surface shares, scene colour and scene depth in, colour out; depth, thickness and light of
        // whitewater foam in. A pixel with nothing but whitewater foam also reads the scene and writes colour.
        "composite" => {
            let alone = foam.saturating_sub(drawn.covered);
            drawn.covered * (4 + 4 + 8 + 4 + 8)
                + 4 * reduced
                + (16 + 16 + 8) * foam
                + (8 + 4 + 8) * alone
                // The coat and the colour below it in, colour out.
                + (4 + 8 + 8) * drawn.coat
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use whitewater::Config;
    use whitewater::ash::vk;
    use whitewater::headless::COLOR_FORMAT;

    use super::*;

    #[test]
    fn whitewater_particles_cast_by_particle_and_texel() {
        let extent = vk::Extent2D { width: 64, height: 48 };
        let mut config = Config::new(extent, COLOR_FORMAT, 64);
        config.light_map_size = Some(512);
        let none = Drawn::nothing(config);
        let map = 512 * 512;
        assert_eq!(moved("whitewater_light", &none), Some(8 * map));
        let some = Drawn { whitewater: 1000, ..none };
        assert_eq!(moved("whitewater_light", &some), Some(44 * map + 24_000));
        assert_eq!(moved("no such pass", &some), None);
    }
}
