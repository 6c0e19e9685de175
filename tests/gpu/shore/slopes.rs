//! Slopes of the foam texture where pixels are much longer than wide must be rotated with the
//! texture.

use glam::{Mat4, Vec3};
use whitewater::shore::{Area, Edge, ShoreSettings, TextureLayer};
use whitewater::{Shore, Shoreline};

use super::shoreline::{AREA, amount, heights, pixel_by_map, twin_map, web_alone};
use super::{Mapped, Tally, water, with_shore};
use crate::reference::shore::Bounded;
use crate::reference::shore::foam::Pixel;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::Lens;

/// Rotation of the texture in degrees.
const ANGLE: f32 = 30.0;

/// Only the foam texture, with this number of layers, all rotated alike.
fn look(layers: usize) -> ShoreSettings {
    let all = [0.3, 0.47, 0.21].map(|scale| TextureLayer {
        weight: 1.0 / layers as f32,
        scale,
        angle: ANGLE,
        speed: [0.1, 0.0],
    });
    let layers = std::array::from_fn(|i| if i < layers { all[i] } else { TextureLayer::NONE });
    let shoreline = web_alone([50.0; 2], layers);
    ShoreSettings::default().with(|it| {
        it.time = 12.75;
        it.shoreline = shoreline;
    })
}

/// A vector rotated back by twice the texture's angle. The twin then rotates it by the angle, which
/// together is the transposed rotation. The area that two vectors span stays the same, and with it
/// the texture's level of detail.
fn transposed([x, y]: [Bounded; 2]) -> [Bounded; 2] {
    let (sine, cosine) = (2.0 * f64::from(ANGLE)).to_radians().sin_cos();
    [x * cosine + y * sine, y * cosine - x * sine]
}

/// Low over the water pixels are many times longer than wide, so slopes along them depend on the
/// texture's rotation. The picture lies within the twin's bounds, and far outside those of a twin
/// with transposed slopes.
#[test]
fn slopes_are_turned_with_the_web() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let area = Area { reach: AREA.edge, ..AREA };
    let mut coasts = Mapped::new(&gpu, 64);
    coasts.image_step(&area, &heights(&area, 64, |at| 0.3 * (at.x - 7.0)), None);
    let map = twin_map(&coasts);
    let mut rig = Rig::new(&gpu, &with_shore(size, Edge::Smooth));
    for layers in [1, 3] {
        let mut shot = Shot::new(size, Lens::ReversedInfinite, 0.1, &[]);
        let (eye, along) = (Vec3::new(4.0, 0.7, 9.0), Vec3::new(0.3, -0.3, -1.0));
        shot.camera.view = Mat4::look_to_rh(eye, along, Vec3::Y).to_cols_array_2d();
        let shoreline = Some(Shoreline::Map(coasts.shore_distances()));
        shot.shore = Some(Shore::new(area.level).with(|it| it.shoreline = shoreline));
        shot.settings.shore = look(layers);
        let found = rig.draw(&shot).shore.expect("foam");
        let level = water(&shot, Vec3::Y.as_dvec3(), 0.0);
        let (mut own, mut other, mut longest) = (Tally::default(), Tally::default(), 0.0_f64);
        for (i, texel) in found.data.iter().enumerate() {
            let at = [i % found.width, i / found.width];
            let point = level.at(at.map(|v| v as f64 + 0.5));
            if point.depth.low() <= 0.0 {
                continue;
            }
            let look = &shot.settings.shore;
            let told = pixel_by_map(&shot, &level, (&map, &area), at);
            let Some(pixel) = told else { continue };
            let long = point.change.map(|way| way[0].value.hypot(way[1].value));
            longest = longest.max(long[0].max(long[1]) / long[0].min(long[1]));
            let across = pixel.across.map(transposed);
            // Only the slopes change; the texture is read at the same position.
            let place = [0, 1].map(|i| {
                let moved = [0, 1].map(|k| (pixel.across[k][i] - across[k][i]) * pixel.off[k]);
                pixel.place[i] + moved[0] + moved[1]
            });
            let turned = Pixel { place, across, ..pixel };
            for (tally, pixel) in [(&mut own, pixel), (&mut other, turned)] {
                if let Some(expected) = amount(look, Edge::Smooth, &pixel, at) {
                    tally.add((at[0], at[1]), texel[0], expected);
                }
            }
        }
        let name = format!("layers: {layers}");
        let far = other.error / f64::from(other.partial);
        println!(
            "{name}: pixels up to {longest:.1} times as long as wide; transposed {} of {} are beyond the bounds, {far:.4} in the mean, at worst {:.0} of them",
            other.beyond, other.partial, other.worst
        );
        own.check(&name, 500, 0.02);
        assert!(
            other.beyond > 200 && other.worst > 10.0,
            "{name}: {} {}",
            other.beyond,
            other.worst
        );
    }
}
