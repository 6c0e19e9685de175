//! Bytes that each pass has to move at least, from what was drawn: every input read once and every
//! output written once, at the sizes they have. Caches may save reads, no pass can save these.

use whitewater::water::{Convolution, Shadows, Splat};

use super::Drawn;

/// Bytes of a pass by its stem; none for passes that are not known here.
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
        // Two words a particle in; of those with foam position and velocity in, the sprite out and in
        // twice; depth and thickness out, and two sums cleared and read where they are not blended.
        "surface_foam" => {
            let summed = drawn.config.thickness_splat != Some(Splat::Raster);
            let texel = if summed { 4 + 8 + 16 } else { 4 + 8 };
            8 * u64::from(drawn.particles) + (24 + 3 * 64) * drawn.foaming + texel * thick
        }
        // Positions and densities in; of those that are spray position in, the sprite out and in; the
        // image cleared. What blending moves is not counted.
        "spray" => {
            4 * u64::from(drawn.particles) + (12 + 64) * u64::from(drawn.counts.spray) + 4 * full
        }
        // Depth in, two depths a texel out and in, sums cleared, those seen added to and read; positions
        // and velocities in; depth, scene depth and surface in, vectors out.
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
        // Positions in; of the sprites, at least the front ones, the sprite out and in; the image cleared,
        // depth in at its texels. What blending moves is not counted.
        "noise" => {
            let texels = pixels(drawn.config.noise.unwrap_or(0));
            12 * u64::from(drawn.particles) + 32 * front + 8 * texels
        }
        // Positions in twice, both maps cleared.
        "light" => 24 * u64::from(drawn.particles) + 20 * texels,
        // Four words a texel out and in again, front in, a texel of four halves out; positions, kinds, ages and ids in.
        // What atomics move is not counted. Without particles the map is cleared.
        "whitewater_light" => match u64::from(drawn.whitewater) {
            0 => 8 * texels,
            whitewater => (16 + 16 + 4 + 8) * texels + 24 * whitewater,
        },
        // Front in and smoothed twice, thickness in, photons cleared, added to and read, caustics out.
        "caustics" => (4 * 4 + 4 + 16 + 12 + 4 + 4) * texels,
        // The map in for its span and for each page; a page of half floats out and in twice, and into the basis.
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
        // Where nothing is near, a word a tile of the coarser levels; where something is, it is not counted.
        "level" => 4 * reduced / 256 / 3,
        // Spheres in, two words a cell cleared, added to and read, three of depth written and two of
        // those read, a texel's out.
        "gaps" => 16 * (front + visible) + full / 64 * 4 * 11 + 4 * thick,
        // Spheres in. What it makes for the tiles near a boundary is not counted.
        "back" => 16 * visible,
        "tiles" => 8 * reduced / 256,
        // The list in and out, boundaries in.
        "split" => 8 * reduced / 256 + if drawn.config.sheets > 1 { 4 * thick } else { 0 },
        // Each active texel of each iteration of the level that shows: surface and plan in, surface out.
        "smooth" => 12 * drawn.iterations,
        // Spheres in, sums (two words) cleared, the first added to, both read, thickness out; of two
        // sheets two sums more, the first read again, both sheets out, boundaries in and out.
        "thickness" => {
            let apart = if drawn.config.sheets > 1 { 32 + 8 + 16 + 8 } else { 0 };
            // With foam a sum more, the channel of what is before it, and its depth in.
            let foam = if drawn.config.surface_foam { 16 + 4 + 4 } else { 0 };
            16 * visible + (24 + apart + foam) * thick
        }
        // Two depths in and eight words a pixel out, those in again, two images of four floats and one of halves
        // out; positions, kinds, ages and ids in at each go. What atomics move is not counted.
        "splat" => {
            let read = drawn.goes * 24 * u64::from(drawn.whitewater);
            (8 + 32 + 32 + 32 + 8) * full + read
        }
        // Depths in twice, the water's once, and light out; where there is foam its normal in. The samples are not
        // counted.
        "radiance" => (16 + 4 + 16 + 8) * full + 8 * foam,
        // Twice: depth and light in, light out; where there is foam its normal in.
        "blur" => 2 * ((16 + 8 + 8) * full + 8 * foam),
        // Depth in, of the whole picture.
        "shore-tiles" => 4 * full,
        // Foam cleared; depth in and foam out where there is some.
        "shoreline" => 4 * full + 8 * drawn.coat,
        // A copy of half-float colour.
        "scene" => 16 * full,
        // Depth, thickness and surface shares, scene colour and depth in, colour out; depth, thickness and light of
        // whitewater foam in, and of pixels with nothing but that the scene in and colour out too.
        "composite" => {
            let alone = foam.saturating_sub(drawn.covered);
            drawn.covered * (4 + 4 + 8 + 4 + 8)
                + 4 * reduced
                + (16 + 16 + 8) * foam
                + (8 + 4 + 8) * alone
                // The coat in, the colour under it in, out.
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
