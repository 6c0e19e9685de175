//! Irradiance of foam, from samples of the environment in the hemisphere around the foam's normal.

use super::super::{Image, View};
use super::{Occlusion, Seen, points};
use glam::DVec3;

/// Mean of radiance times cosine over the directions of the points. Directions below the surface
/// are mirrored into the hemisphere of the normal. For constant radiance the mean tends to half of
/// that radiance.
pub fn irradiance_of(
    points: &[DVec3],
    view: &View,
    normal: DVec3,
    light: impl Fn(DVec3) -> DVec3,
) -> DVec3 {
    let back = view.view.inverse();
    let sum: DVec3 = points
        .iter()
        .map(|s| {
            let dir = back.transform_vector3(s.normalize());
            let cosine = dir.dot(normal);
            let dir = if cosine < 0.0 { dir - 2.0 * cosine * normal } else { dir };
            light(dir) * dir.dot(normal)
        })
        .sum();
    sum / points.len().max(1) as f64
}

/// Irradiance of each pixel with foam, from all samples of the first occlusion pass, including
/// those outside the picture.
pub fn irradiance(
    front: &Image<Option<Seen>>,
    view: &View,
    settings: &Occlusion,
    light: impl Fn(DVec3) -> DVec3 + Sync,
) -> Image<Option<DVec3>> {
    let points = points(settings.counts[1].ceil() as usize + 1);
    Image::from_fn(view.width, view.height, |x, y| {
        let seen = front.at(x, y)?;
        let h_px = 0.5 * settings.search(seen.h, 1) * view.extent().y;
        let first = &points[..settings.samples(h_px)];
        Some(irradiance_of(first, view, seen.normal, &light))
    })
}
