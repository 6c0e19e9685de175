//! Water on a bed, seen through water in front of it, with two interfaces.

use whitewater::Config;
use whitewater::water::{Exit, Medium};

use glam::{Mat4, Vec3};
use whitewater::Camera;

use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens};

const SIZE: (u32, u32) = (97, 61);
/// Depths of the front and of the back of the pool on the bed, in metres.
const POOL: (f32, f32) = (9.0, 11.4);

fn two_interfaces() -> Config {
    config(extent(SIZE.0, SIZE.1)).with(|it| {
        it.coarsening = 0;
        it.max_particles = 20_000;
        it.sheets = 2;
        it.exit = Exit::TwoInterfaces;
    })
}

/// Particles before a pool of eight layers on a bed, seen from above. The pool covers the view.
/// Points are in eye space.
fn before_pool(front: &[[f32; 3]], bed: impl Fn(u32) -> f32) -> Shot {
    let mut points = front.to_vec();
    points.extend(scenes::block(3, 0.3, [54, 40, 8], [-8.1, -6.0, POOL.0 + 0.15]));
    let mut shot = Shot::new(extent(SIZE.0, SIZE.1), Lens::Standard, 0.2, &points);
    let view = Mat4::look_to_rh(Vec3::ZERO, Vec3::NEG_Y, Vec3::NEG_Z);
    shot.camera = Camera { view: view.to_cols_array_2d(), ..shot.camera };
    shot.positions = scenes::world(&shot.camera, &points);
    shot.scene_depth(|_, _| Some(f64::from(POOL.1)));
    for (i, color) in shot.color.iter_mut().enumerate() {
        *color = [bed(i as u32 % SIZE.0); 4];
    }
    shot.settings.water.specular = 0.0;
    shot
}

/// Mean of the first channel over the pixels of the front water, and their number. Rows near the
/// view's edges are left out, because a refracted ray may leave the view there.
fn mean_of_front(drawn: &Drawn, columns: std::ops::Range<usize>) -> (f32, usize) {
    let all = columns.flat_map(|x| (20..41).map(move |y| (x, y)));
    let front: Vec<_> = all.filter(|&(x, y)| drawn.depth.at(x, y) < 6.0).collect();
    let sum: f32 = front.iter().map(|&(x, y)| drawn.output.at(x, y)[0]).sum();
    (sum / front.len() as f32, front.len())
}

/// Dark water attenuates the bed's light on its way up, and the light of sun and sky on its way
/// down to the bed. Water before the pool adds no light: a uniform bed looks at most as bright
/// through it as beside it. (A bed that is lit as if without water would look brighter.)
#[test]
fn a_bed_is_no_brighter_through_water_before_its_pool() {
    let gpu = Gpu::shared();
    let mut rig = Rig::new(&gpu, &two_interfaces());
    rig.environment(extent(4, 2), &[[0.0, 0.0, 0.0, 1.0]; 8]);
    let mut bumpy = Vec::new();
    for (x, y) in (-6..7).flat_map(|x| (-4..5).map(move |y| (x as f32, y as f32))) {
        let layers = (2.5 + 1.5 * (1.3 * x).sin() * (1.3 * y).cos()).round() as usize;
        bumpy.extend((0..layers).map(|layer| [0.2 * x, 0.2 * y, 5.0 - 0.2 * layer as f32]));
    }
    let mut shot = before_pool(&bumpy, |_| 1.0);
    shot.settings.water.medium = Medium::Physical { absorption: [0.5; 3], scattering: [0.0; 3] };
    let drawn = rig.draw(&shot);
    let mean = |front: bool| {
        let all = (8..89).flat_map(|x| (8..53).map(move |y| (x, y)));
        let of = all.filter(|&(x, y)| (drawn.depth.at(x, y) < 6.0) == front);
        let light: Vec<_> = of.map(|(x, y)| drawn.output.at(x, y)[0]).collect();
        (light.iter().sum::<f32>() / light.len() as f32, light.len())
    };
    let ((before, count), (beside, others)) = (mean(true), mean(false));
    assert!(
        count > 200 && others > 100 && before < beside,
        "{before} of {count}, {beside} of {others}"
    );
}

/// A wedge refracts rays towards its thick side. The bed is brighter on the right, so it looks
/// brighter through a wedge that is thicker on the right than through one that is thicker on the
/// left.
#[test]
fn a_wedge_before_a_pool_is_a_prism() {
    let gpu = Gpu::shared();
    let mut rig = Rig::new(&gpu, &two_interfaces());
    rig.environment(extent(4, 2), &[[0.0, 0.0, 0.0, 1.0]; 8]);
    let mut seen = |rises: f32| {
        let mut wedge = Vec::new();
        for (x, y) in (-8..9).flat_map(|x| (-6..7).map(move |y| (x as f32, y as f32))) {
            let layers = (3.0 + 0.35 * rises * x).round().max(1.0) as usize;
            let at = |layer: usize| [0.2 * x, 0.2 * y, 5.0 - 0.2 * layer as f32];
            wedge.extend((0..layers).map(at));
        }
        let mut shot = before_pool(&wedge, |x| 0.01 * x as f32);
        shot.settings.water.medium =
            Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] };
        mean_of_front(&rig.draw(&shot), 44..53)
    };
    let ((right, count), (left, _)) = (seen(1.0), seen(-1.0));
    assert!(count > 100 && right > left + 0.01, "{right} {left} over {count} pixels");
}
