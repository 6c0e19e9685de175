//! Normals from depth, for files without a normal layer.

use super::EMPTY;

/// Eye-space normals of a depth picture (x, y and z per texel, towards the camera, which looks down -z).
///
/// `slope` = `[sx, sy, ox, oy]` maps a texel centre (u, v), in texels, to x / depth = sx u + ox and y / depth =
/// sy v + oy. A normal is the cross product of the differences to two neighbours, one along x and one along y. On each
/// axis the neighbour is used whose depth is closer to the texel's own, so that normals do not bend at silhouettes.
/// The normal of a texel without a neighbour on one axis points at the camera. Normals are zero where there is no
/// surface.
pub fn normals(depth: &[f32], width: usize, height: usize, slope: [f32; 4]) -> [Vec<f32>; 3] {
    let [sx, sy, ox, oy] = slope;
    let at = |x: usize, y: usize| depth.get(y * width + x).copied().unwrap_or(EMPTY);
    let point = |x: usize, y: usize| {
        let z = at(x, y);
        [z * (sx * (x as f32 + 0.5) + ox), z * (sy * (y as f32 + 0.5) + oy), -z]
    };
    let mut out = [(); 3].map(|()| vec![0.0; width * height]);
    for y in 0..height {
        for x in 0..width {
            let z = at(x, y);
            if z.is_nan() || z >= EMPTY {
                continue;
            }
            let here = point(x, y);
            // Difference along an axis, on the side whose depth is closer to the texel's own.
            let along = |before: Option<(usize, usize)>, after: Option<(usize, usize)>| {
                let step = |side: Option<(usize, usize)>| {
                    let (x, y) = side?;
                    let other = at(x, y);
                    (other < EMPTY).then(|| ((other - z).abs(), point(x, y)))
                };
                match (step(before), step(after)) {
                    (Some((a, p)), Some((b, _))) if a < b => Some(minus(here, p)),
                    (_, Some((_, p))) => Some(minus(p, here)),
                    (Some((_, p)), None) => Some(minus(here, p)),
                    (None, None) => None,
                }
            };
            let dx = along(x.checked_sub(1).map(|x| (x, y)), (x + 1 < width).then_some((x + 1, y)));
            let dy =
                along(y.checked_sub(1).map(|y| (x, y)), (y + 1 < height).then_some((x, y + 1)));
            let n = match (dx, dy) {
                (Some(dx), Some(dy)) => cross(dx, dy),
                // A lone texel faces the camera.
                _ => here.map(|v| -v),
            };
            let length = dot(n, n).sqrt();
            let sign = if dot(n, here) > 0.0 { -1.0 } else { 1.0 };
            if length > 0.0 {
                for (channel, v) in out.iter_mut().zip(n) {
                    channel[y * width + x] = sign * v / length;
                }
            }
        }
    }
    out
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_plane_has_its_normal() {
        // n·p = d with slopes s: depth = d / (n.x s.x + n.y s.y - n.z).
        let n = [0.36_f32, 0.48, 0.8];
        let slope = [0.01, -0.01, -0.16, 0.12];
        let (width, height) = (32, 24);
        let mut depth = vec![0.0; width * height];
        for (i, z) in depth.iter_mut().enumerate() {
            let (x, y) = ((i % width) as f32 + 0.5, (i / width) as f32 + 0.5);
            let (sx, sy) = (slope[0] * x + slope[2], slope[1] * y + slope[3]);
            *z = -2.0 / (n[0] * sx + n[1] * sy - n[2]);
        }
        depth[5] = EMPTY;
        let found = normals(&depth, width, height, slope);
        for i in 0..depth.len() {
            for (channel, n) in found.iter().zip(n) {
                let expected = if i == 5 { 0.0 } else { n };
                assert!((channel[i] - expected).abs() < 2e-3, "{i} {}", channel[i]);
            }
        }
    }
}
