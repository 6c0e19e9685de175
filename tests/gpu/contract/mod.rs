//! The contract with the host: frames in flight, resize, retired objects, bad input, abandoned
//! frames, every kind of host image, and what the renderer reports about itself.

mod allocate;
mod bad;
mod device;
mod flight;
mod images;
mod life;

use ash::vk;
use whitewater::water::Shadows;
use whitewater::{LightVolume, Shadow};

use crate::support::host::Texture;
use crate::support::rig::{Rig, Shot};
use crate::support::scenes::{self, Lens};

fn water(size: vk::Extent2D, lens: Lens) -> Shot {
    let points = scenes::block(3, 0.25, [12, 8, 4], [-1.6, -1.0, 4.0]);
    Shot::new(size, lens, 0.2, &points)
}

/// Gives a shot the light's inputs that the rig's configuration needs. The scene's depth serves as
/// shadow map; it lies before the water, so it shades the shot.
pub fn sunny(rig: &Rig<'_>, shot: &mut Shot) -> Option<Texture> {
    let center = scenes::world(&shot.camera, &[[0.0, 0.0, 5.0]])[0];
    shot.light_volume = rig.config.light_map_size.map(|_| LightVolume { center, radius: 4.0 });
    let kind = rig.config.shadow?;
    let (color, depth) = rig.scene(shot);
    let image = match kind {
        Shadows::Mask => color,
        Shadows::Map | Shadows::Convolution(_) => depth,
    };
    let view_projection = shot.camera.projection_matrix() * shot.camera.view_matrix();
    shot.shadow = Some(
        Shadow::new(image.host_image(), view_projection.to_cols_array_2d())
            .with(|it| it.bias = 0.1),
    );
    Some(image)
}
