//! Light seen through water. For a bed: where the ray that is refracted at the front surface ends.
//! With air behind: refraction also at the far surface, which lies one thickness deeper and has the
//! slopes of the front and of the thickness; then a march to the scene, or the environment.

use glam::{DVec2, DVec3};

use super::super::surface::Surface;
use super::super::{Image, View, smoothstep};
use super::mirror::{Met, depth, march_from, on_screen};
use super::{Inputs, Settings, Under, met_scene};

/// Steps of the march.
const STEPS: u32 = 4;

/// Errors of the inputs: rotations of the normals and of the leaving ray; relative errors of the
/// thickness, its slope and the position; relative error of the first step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Off {
    pub front: DVec3,
    pub far: DVec3,
    pub leaving: DVec3,
    pub thick: f64,
    pub slope: f64,
    pub scale: f64,
    pub stretch: f64,
}

/// Light that enters the sheet from behind, and the path through it in scene units.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    pub light: DVec3,
    pub path: f64,
    pub met: Met,
    /// Whether the leaving ray is totally reflected.
    pub total: bool,
    /// Normalized direction of the leaving ray, in eye space.
    pub along: DVec3,
}

/// Slope of the thickness per pixel of the picture, by quadratic B-splines.
fn rise(thickness: &Image<f64>, level: u32, pixel: DVec2) -> DVec2 {
    let edge = f64::from(1 << level);
    let h = pixel / edge - 0.5;
    let spline = |u: f64| match u.abs() {
        a if a <= 0.5 => (0.75 - u * u, -2.0 * u),
        a if a < 1.5 => (0.5 * (1.5 - a).powi(2), -(1.5 - a) * u.signum()),
        _ => (0.0, 0.0),
    };
    let middle = (h + 0.5).floor();
    let mut sum = DVec2::ZERO;
    for (i, j) in (-1..=1).flat_map(|j| (-1..=1).map(move |i| (i, j))) {
        let at = middle + DVec2::new(f64::from(i), f64::from(j));
        let value = thickness.clamped(at.x as isize, at.y as isize);
        let ((x, dx), (y, dy)) = (spline(h.x - at.x), spline(h.y - at.y));
        sum += value * DVec2::new(dx * y, x * dy);
    }
    sum / edge
}

/// The ray refracted at a surface whose normal is on the ray's side; `ratio`: refractive index in
/// front over that behind. None for total reflection.
pub fn bend(ray: DVec3, normal: DVec3, ratio: f64) -> Option<DVec3> {
    let cosine = -ray.dot(normal);
    let along = (ray + normal * cosine) * ratio;
    let square = 1.0 - along.length_squared();
    (square > 0.0).then(|| along - normal * square.sqrt())
}

/// Displacement in pixels between the scene straight behind and the scene that the refracted ray
/// meets under water, and the share of the ray that meets it there: none of a ray that crosses four
/// times the water's thickness, or four spacings, and all up to two. The displacement takes five steps of regula falsi, from the depth straight behind. While the ray is
/// before the scene, it is extended by the remaining depth, at most to twice its length.
pub fn bed_offset(
    inputs: &Inputs<'_>,
    surface: &Surface,
    view: &View,
    pixel: DVec2,
    (index, spacing, off): (f64, f64, &Off),
) -> (DVec2, f64) {
    let position = surface.position * (1.0 + off.scale);
    let normal = (surface.normal + off.front).normalize();
    let inside =
        bend(position.normalize(), normal, index.recip()).expect("into water it always goes");
    let along = (-inside.z).max(0.25);
    let ends = |far: f64| {
        let end = on_screen(view, position + inside * far).truncate();
        end.clamp(DVec2::splat(0.5), view.extent() - 0.5)
    };
    // Lengths along the ray, and how much deeper the scene is there.
    let mut before = (0.0, (depth(inputs, view, pixel) + position.z).max(0.0));
    let mut beyond: Option<(f64, f64)> = None;
    let mut far = before.1 / along;
    for _ in 0..5 {
        let scene = depth(inputs, view, ends(far));
        if scene <= -position.z {
            // An object before the water.
            continue;
        }
        let deeper = scene + position.z + inside.z * far;
        if deeper > 0.0 {
            before = (far, deeper);
        } else {
            beyond = Some((far, deeper));
        }
        far = match beyond {
            Some((length, less)) => {
                let part = (before.1 / (before.1 - less)).clamp(0.1, 0.9);
                before.0 + part * (length - before.0)
            }
            None => (far + before.1 / along).min(2.0 * far),
        };
    }
    let found = on_screen(view, position + inside * far);
    let crossed = far * (-inside.z).max(0.0) / surface.thickness.max(spacing);
    let touches = 1.0 - smoothstep(2.0, 4.0, crossed);
    let at = ends(far);
    let inside = at == found.truncate() && depth(inputs, view, at) > -position.z;
    let at = if inside { on_plane(inputs, view, on_screen(view, position), found) } else { at };
    (at.clamp(DVec2::splat(0.5), view.extent() - 0.5) - pixel, touches)
}

/// Where the line between two places on the screen, or its continuation by at most four texels, crosses the
/// plane of the scene's texel at the second. All are pixels and reciprocal depths, in which lines and planes stay lines
/// and planes. The plane goes through the texel's centre and has the flatter of the slopes to the two neighbours on
/// each axis.
fn on_plane(inputs: &Inputs<'_>, view: &View, start: DVec3, found: DVec3) -> DVec2 {
    let (scene, pixels) = (inputs.scene_depth, view.extent());
    let size = pixels / DVec2::new(scene.width as f64, scene.height as f64);
    let centre = ((found.truncate() / size).floor() + 0.5) * size;
    let near = |x: f64, y: f64| depth(inputs, view, centre + DVec2::new(x, y) * size).recip();
    let flatter = |low: f64, middle: f64, high: f64| {
        let (rise, fall) = (high - middle, middle - low);
        if rise.abs() < fall.abs() { rise } else { fall }
    };
    let middle = near(0.0, 0.0);
    let slope = DVec2::new(
        flatter(near(-1.0, 0.0), middle, near(1.0, 0.0)),
        flatter(near(0.0, -1.0), middle, near(0.0, 1.0)),
    ) / size;
    // Height of the line over the plane, at its two places.
    let over = |p: DVec3| p.z - middle - slope.dot(p.truncate() - centre);
    let part = over(found) / (over(found) - over(start));
    let moved = (start - found).truncate() * part;
    found.truncate() + moved.clamp_length_max(4.0 * size.y)
}

/// Displacement of [`bed_offset`] and its error in pixels, and the share that touches with its error.
pub fn bed_about(
    inputs: &Inputs<'_>,
    surface: &Surface,
    view: &View,
    pixel: DVec2,
    (index, spacing, turned, share): (f64, f64, f64, f64),
) -> ((DVec2, f64), (f64, f64)) {
    let of = |off: &Off| bed_offset(inputs, surface, view, pixel, (index, spacing, off));
    let (found, touches) = of(&Off::default());
    let (mut moved, mut changed) = (0.0, 0.0);
    let fronts = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| (axis * turned, 0.0));
    for (front, scale) in fronts.into_iter().chain([(DVec3::ZERO, share)]) {
        let both = [1.0, -1.0].map(|sign| {
            let off = Off { front: front * sign, scale: scale * sign, ..Off::default() };
            let (there, other) = of(&off);
            (there.distance(found), (other - touches).abs())
        });
        moved += both[0].0.max(both[1].0);
        changed += both[0].1.max(both[1].1);
    }
    ((found, moved), (touches, changed))
}

/// Light that enters a surface from behind, combined with what the front surface alone shows.
#[allow(clippy::too_many_arguments)] // each is one thing that a pixel goes by
pub fn exit(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    (x, y): (usize, usize),
    behind: DVec3,
    env: impl Fn(DVec3) -> DVec3,
    off: &Off,
) -> Seen {
    let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let under = Under::met(inputs, settings, surface, view, pixel);
    let position = surface.position * (1.0 + off.scale);
    let (v, n) = (-position.normalize(), (surface.normal + off.front).normalize());
    let t = surface.thickness * (1.0 + off.thick);
    let mut seen =
        Seen { light: behind, path: under.path, met: Met::default(), total: false, along: -v };
    let Some(index) = settings.exit.filter(|_| t > 0.0 && under.wet < 1.0) else { return seen };
    let inside = bend(-v, n, index.recip()).expect("into water it always goes");
    let path = t / (-inside.z).max(0.25);
    let z = t - position.z;
    let steepest = view.slope_step().abs() * z * 1.5;
    let rise = rise(inputs.thickness, inputs.thickness_level, pixel) * (1.0 + off.slope);
    let d = (surface.slope + rise).clamp(-steepest, steepest) / view.slope_step();
    let ray = view.ray(x, y);
    let far =
        (DVec3::new(d.x, d.y, z + ray.x * d.x + ray.y * d.y).normalize() + off.far).normalize();
    let leaves = bend(inside, far, index);
    seen.total = leaves.is_none();
    let thrown = leaves.map_or(1.0, |along| settings.fresnel.reflectance(-along.dot(far)));
    let inward = inside - 2.0 * inside.dot(far) * far;
    seen.along = (leaves.unwrap_or(inward) + off.leaving).normalize();
    if leaves.is_some() {
        let ray = (position + inside * path, seen.along, 1.0 + off.stretch);
        seen.met = march_from(inputs, view, ray, STEPS);
    }
    // A part of the light comes along the ray from what it meets: the scene, or the sky above the
    // horizon. The rest comes straight from behind. The part is half of the light that leaves, and
    // 15 % of the light that the far surface reflects.
    let mixed = |along: DVec3, part: f64, met: f64, scene: DVec3| {
        let world = view.view.inverse().transform_vector3(along);
        let sky = (1.0 - met) * smoothstep(-0.3, 0.0, world.y);
        part * (met * scene + sky * env(world)) + (1.0 - part * (met + sky)) * behind
    };
    let met = seen.met.share;
    let of_scene = if met > 0.0 {
        met_scene(inputs, None, settings, view, (seen.met.at, seen.along), &env)
    } else {
        DVec3::ZERO
    };
    let out = mixed(seen.along, 0.5, met, of_scene);
    let back = mixed((inward + off.leaving).normalize(), 0.15, 0.0, DVec3::ZERO);
    let air = (1.0 - under.wet) * smoothstep(0.0, settings.radius, t);
    seen.light = behind.lerp(out.lerp(back, thrown), air);
    seen.path += air * (path - under.path);
    seen
}

/// Light and path of the exit, with their errors, summed over the effects of each input's error in
/// both directions, and whether the ray certainly meets the same surface.
#[allow(clippy::too_many_arguments)] // each is one thing that a pixel goes by
pub fn exit_about(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    at: (usize, usize),
    behind: DVec3,
    env: impl Fn(DVec3) -> DVec3,
    (turned, share): (f64, f64),
) -> (Seen, DVec3, f64, bool) {
    let of = |off: &Off| exit(inputs, settings, surface, view, at, behind, &env, off);
    let found = of(&Off::default());
    let (mut light, mut path, mut sure) = (DVec3::ZERO, 0.0, true);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * turned);
    let parts = axes
        .into_iter()
        .flat_map(|turn| {
            [
                Off { front: turn, ..Off::default() },
                Off { far: turn, ..Off::default() },
                Off { leaving: turn, ..Off::default() },
            ]
        })
        .chain([
            Off { thick: share, ..Off::default() },
            Off { slope: share, ..Off::default() },
            Off { scale: share, ..Off::default() },
            Off { stretch: 8.0 * share, ..Off::default() },
        ]);
    for off in parts {
        let Off { front, far, leaving, thick, slope, scale, stretch } = off;
        let back = Off {
            front: -front,
            far: -far,
            leaving: -leaving,
            thick: -thick,
            slope: -slope,
            scale: -scale,
            stretch: -stretch,
        };
        let both = [of(&off), of(&back)];
        let most = |a: DVec3, seen: &Seen| a.max((seen.light - found.light).abs());
        light += both.iter().fold(DVec3::ZERO, most);
        path += both.iter().map(|seen| (seen.path - found.path).abs()).fold(0.0, f64::max);
        sure &= both.iter().all(|seen| {
            (seen.met.share > 0.0) == (found.met.share > 0.0)
                && seen.total == found.total
                && seen.met.at.distance(found.met.at) < 1.0
        });
    }
    (found, light, path, sure)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{PLAIN, facing};
    use super::super::{Fresnel, Medium};
    use super::*;
    use crate::reference::EMPTY;
    use crate::reference::tests::view;

    /// Through a slab a ray leaves at the angle at which it entered. From 48.6 degrees on none
    /// leaves.
    #[test]
    fn a_slab_bends_twice_and_total_reflection_begins_at_its_angle() {
        let normal = DVec3::Z;
        for degrees in [0.0_f64, 20.0, 60.0, 85.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let ray = DVec3::new(sin, 0.0, -cos);
            let inside = bend(ray, normal, 1.0 / 1.333).expect("comes in");
            assert!((inside.x - sin / 1.333).abs() < 1e-12 && inside.is_normalized());
            let out = bend(inside, normal, 1.333).expect("comes out");
            assert!((out - ray).length() < 1e-9, "{out}");
        }
        for (degrees, leaves) in [(48.5_f64, true), (48.7, false)] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let out = bend(DVec3::new(sin, 0.0, -cos), normal, 1.333);
            assert_eq!(out.is_some(), leaves, "{degrees}");
        }
    }

    /// A clear slab that faces the eye, before light of 1 and with none behind the eye. The far
    /// surface transmits 0.98; of the rest, which is mirrored back, 85 % is what lies straight
    /// behind. The front surface mirrors 0.02 of everything.
    #[test]
    fn a_clear_slab_loses_light_at_both_surfaces() {
        let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 65, 65);
        let clear =
            Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3], ambient: [0.0; 3] };
        let fresnel = Fresnel::Schlick { f0: 0.02 };
        let settings = Settings { medium: clear, fresnel, exit: Some(1.333), ..PLAIN };
        let image = |v: f64| Image::new(65, 65, v);
        let (depth, thickness) = (image(10.0), image(2.0));
        let color = Image::new(65, 65, [1.0; 4]);
        let surface = facing(DVec3::new(0.0, 0.0, -10.0), DVec3::Z, 2.0, f64::INFINITY);
        for scene in [40.0, EMPTY] {
            let scene = image(scene);
            let inputs = Inputs {
                depth: &depth,
                smoothed: &depth,
                level: 0,
                thickness: &thickness,
                thickness_level: 0,
                scene_color: &color,
                scene_depth: &scene,
                noise: None,
            };
            let env = |world| {
                if view.view.transform_vector3(world).z < 0.0 { DVec3::ONE } else { DVec3::ZERO }
            };
            let at = (32, 32);
            let seen =
                exit(&inputs, &settings, &surface, &view, at, DVec3::ONE, env, &Off::default());
            assert!((seen.light - 0.997).length() < 1e-9, "{seen:?}");
            assert!((seen.path - 2.0).abs() < 1e-9, "{seen:?}");
            let through = seen.light * (1.0 - fresnel.reflectance(1.0));
            assert!((through.x - 0.98 * 0.997).abs() < 1e-9, "{through}");
        }
    }
}
