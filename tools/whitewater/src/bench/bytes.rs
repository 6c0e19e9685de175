//! Minimum memory traffic of each pass in bytes: every input is read once and every output written once, at their
//! actual sizes. Caches may save repeated reads, but no pass can do with less than this. In the comments, "in" means
//! read by the pass and "out" means written by it.

use whitewater::water::{Convolution, Shadows, Splat};

use super::Drawn;

/// Minimum number of bytes that a pass has to read and write in memory for the frame `drawn`; `None` for a pass that
/// is not listed here.
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
        // Reads two words per particle. For each foaming particle it reads position and velocity, writes a sprite and
        // reads the sprite twice. Per texel it writes depth and thickness; without blending, it also clears two sums
        // and reads them.
        "surface_foam" => {
            let summed = drawn.config.thickness_splat != Some(Splat::Raster);
            let texel = if summed { 4 + 8 + 16 } else { 4 + 8 };
            8 * u64::from(drawn.particles) + (24 + 3 * 64) * drawn.foaming + texel * thick
        }
        // Reads the density of each particle. For each spray particle it reads the position, writes a sprite and
        // reads it. It clears the image. The traffic of blending is not counted.
        "spray" => {
            4 * u64::from(drawn.particles) + (12 + 64) * u64::from(drawn.counts.spray) + 4 * full
        }
        // Reads depth; writes two depths per texel and reads them; clears the sums, and on covered texels adds to
        // them and reads them; reads positions and velocities of all particles; reads depth, scene depth and surface;
        // writes motion vectors.
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
        // Reads positions. There are at least as many sprites as front spheres; each is written and read. The pass
        // clears the image, and reads the depth at each of the image's texels. The traffic of blending is not
        // counted.
        "noise" => {
            let texels = pixels(drawn.config.noise.unwrap_or(0));
            12 * u64::from(drawn.particles) + 32 * front + 8 * texels
        }
        // Positions in twice, both maps cleared.
        "light" => 24 * u64::from(drawn.particles) + 20 * texels,
        // Per texel of the map it writes four words and reads them again, reads the front depth, and writes four half
        // floats. It reads positions, kinds, ages and ids of the particles. The traffic of atomics is not counted.
        // Without particles the map is only cleared.
        "whitewater_light" => match u64::from(drawn.whitewater) {
            0 => 8 * texels,
            whitewater => (16 + 16 + 4 + 8) * texels + 24 * whitewater,
        },
        // Reads the front depth and smooths it twice, reads thickness, clears the photons, adds to them and reads
        // them, and writes the caustics.
        "caustics" => (4 * 4 + 4 + 16 + 12 + 4 + 4) * texels,
        // Reads the shadow map once for its depth range and once for each page. Each page of half floats is written
        // and read twice, and is written into the basis.
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
        // Reads scene colour and depth, writes the lit scene, reads it and writes it to the output. Reads of the maps
        // are not counted.
        "lit" => (8 + 4 + 8 + 8 + 8) * full,
        // Reads depth, and scene depth on covered pixels; writes two surfaces and the plan (the iteration count
        // and step size of each pixel).
        "reduce" => 4 * full + 4 * drawn.covered + 12 * reduced,
        // Without water near the camera, one word for each tile of the coarser levels. The traffic with near water is
        // not counted.
        "level" => 4 * reduced / 256 / 3,
        // Reads spheres. Per cell it clears two words, adds to them and reads them, writes three words of depth and
        // reads two of them. Per texel it writes the result.
        "gaps" => 16 * (front + visible) + full / 64 * 4 * 11 + 4 * thick,
        // Reads spheres. What the pass writes for tiles near a boundary between layers of water is not counted.
        "back" => 16 * visible,
        "tiles" => 8 * reduced / 256,
        // The list in and out, boundaries in.
        "split" => 8 * reduced / 256 + if drawn.config.sheets > 1 { 4 * thick } else { 0 },
        // For each active texel of the level that is shown there, each iteration reads surface and plan and writes
        // surface.
        "smooth" => 12 * drawn.iterations,
        // Reads spheres. Per texel it clears two words of sums, adds to the first, reads both and writes the
        // thickness. With two sheets (layers of water) it has two more sums, reads the first again, writes both
        // sheets, and reads and writes the boundaries between them.
        "thickness" => {
            let apart = if drawn.config.sheets > 1 { 32 + 8 + 16 + 8 } else { 0 };
            // With foam there is one more sum (the thickness in front of the foam), and its channel and depth are
            // read.
            let foam = if drawn.config.surface_foam { 16 + 4 + 4 } else { 0 };
            16 * visible + (24 + apart + foam) * thick
        }
        // Per pixel it reads two depths, writes eight words and reads them again, and writes two images of four
        // floats and one of half floats. Each dispatch reads positions, kinds, ages and ids. The traffic of atomics
        // is not counted.
        "splat" => {
            let read = drawn.goes * 24 * u64::from(drawn.whitewater);
            (8 + 32 + 32 + 32 + 8) * full + read
        }
        // Reads the depths twice and the water's depth once, and writes the light; on pixels with foam it also reads
        // the normal. Reads by the samples of ambient occlusion are not counted.
        "radiance" => (16 + 4 + 16 + 8) * full + 8 * foam,
        // Twice: depth and light in, light out; for foam pixels the normal in.
        "blur" => 2 * ((16 + 8 + 8) * full + 8 * foam),
        // Depth of the whole picture in.
        "shore-tiles" => 4 * full,
        // Foam cleared; for pixels with foam, depth in and foam out.
        "shoreline" => 4 * full + 8 * drawn.coat,
        // A copy of half-float colour.
        "scene" => 16 * full,
        // On covered pixels it reads depth, thickness, surface shares, scene colour and scene depth, and writes
        // colour. On pixels with whitewater foam it reads the foam's depth, thickness and light; if they hold nothing
        // else, it also reads the scene and writes colour.
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
