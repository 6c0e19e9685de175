//! Compares pass `depth`, the exact depth of spheres, with closed forms and with the CPU twin.

use whitewater::Config;
use whitewater::water::Splat;

use crate::reference::{Sphere, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens};
use crate::support::tolerance;

const BOTH: [Splat; 2] = [Splat::Raster, Splat::Compute];

fn splatted(size: ash::vk::Extent2D, splat: Splat) -> Config {
    config(size).with(|it| {
        it.depth_splat = Some(splat);
        it.smoothing_level = 0;
        it.thickness_level = 0;
    })
}

/// The spheres of a shot in eye space.
pub fn spheres(shot: &Shot) -> Vec<Sphere> {
    let view = shot.camera_view();
    let radius = f64::from(shot.settings.water.radius());
    shot.positions
        .iter()
        .map(|p| Sphere { center: view.transform_point3(p.map(f64::from).into()), radius })
        .collect()
}

/// One sphere: on the axis, off it, near the eye, over the picture's edge, partly before the near
/// plane, around the eye, behind the eye, smaller than a pixel, larger than the screen.
#[test]
fn one_sphere_has_its_closed_form() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let scenes = [
        ("on-axis", 0.3, [0.0, 0.0, 4.0], true),
        ("off-axis", 0.5, [1.6, -0.9, 3.0], true),
        ("near", 0.2, [0.05, 0.02, 0.35], true),
        ("edge", 0.8, [2.0, 0.3, 2.3], true),
        ("near-plane", 0.5, [0.2, 0.1, 0.55], true),
        ("eye-inside", 0.5, [0.1, 0.0, 0.3], false),
        ("behind", 0.5, [0.0, 0.0, -1.0], false),
        ("far", 0.3, [4.0, 2.0, 60.0], true),
        ("huge", 40.0, [3.0, 1.0, 45.0], true),
        ("wide", 2.0, [0.0, 0.0, 2.2], true),
    ];
    for splat in BOTH {
        let mut rig = Rig::new(&gpu, &splatted(size, splat));
        for (name, radius, at, seen) in scenes {
            let mut shot = Shot::new(size, Lens::ReversedInfinite, radius, &[at]);
            shot.settings.water.smoothing_width = 0.0;
            let drawn = rig.draw(&shot);
            let view = shot.view(size);
            let bounds = tolerance::depth(&spheres(&shot), &view);
            compare::between(&format!("depth-{name}-{splat:?}"), &drawn.depth, &bounds);
            let some = drawn.depth.data.iter().any(|d| is_surface(f64::from(*d)));
            assert!(some == seen || name == "far", "{name} {splat:?}: {some}");
        }
    }
}

#[test]
fn a_cloud_is_the_twins_through_every_lens() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let points = scenes::cloud(7, 600, 0.3, 20.0);
    for splat in BOTH {
        let mut rig = Rig::new(&gpu, &splatted(size, splat));
        for lens in LENSES {
            let shot = Shot::new(size, lens, 0.15, &points);
            let drawn = rig.draw(&shot);
            let bounds = tolerance::depth(&spheres(&shot), &shot.view(size));
            compare::between(&format!("depth-cloud-{lens:?}-{splat:?}"), &drawn.depth, &bounds);
        }
    }
}

/// Raster and compute run the same arithmetic on the same spheres. A compiler may contract it
/// differently in each (on an H200 a third of the pixels differ by bits), so both must lie within
/// the twin's bounds.
#[test]
fn raster_and_compute_agree() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for (radius, far) in [(0.15, 20.0), (1.0, 6.0)] {
        let shot = Shot::new(size, Lens::Standard, radius, &scenes::cloud(3, 400, 0.2, far));
        let [raster, compute] =
            BOTH.map(|splat| Rig::new(&gpu, &splatted(size, splat)).draw(&shot));
        let bounds = tolerance::depth(&spheres(&shot), &shot.view(size));
        compare::between("depth-agree-raster", &raster.depth, &bounds);
        compare::between("depth-agree-compute", &compute.depth, &bounds);
    }
}
