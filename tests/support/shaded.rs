//! Bounds on the difference between `composite` and its twin: running error analysis of the
//! shader's operations, pixel by pixel, from the surface and the background that the twin found.

use glam::{DVec2, DVec3};

use super::rounded::{Rounded, cross, dot, exact, mix, normalize, off, smoothstep};
use super::tolerance::U;
use crate::reference::composite::{
    Bed, Behind, Fresnel, Inputs, Medium, Met, Settings, Shown, bed_about, cut_look_up, direction,
    exit_about, look_up, look_up_both, met_about, met_scene,
};
use crate::reference::noise::Ripple;
use crate::reference::surface::{Case, Surface};
use crate::reference::{EMPTY, View, is_surface};

/// Errors of texture filtering.
#[derive(Clone, Copy)]
pub struct Filter {
    /// Positions within a texel are precise to 2^-bits.
    pub bits: u32,
    /// Largest change of the environment's channels per unit of direction.
    pub sky_slope: f64,
    /// Error of the environment's texels and of the interpolation between them.
    pub sky_error: f64,
}

/// A pixel's colour in the shader's order of operations, with its bounds.
pub struct Shaded {
    pub color: [Rounded; 3],
    /// Error of the background look-up, in pixels.
    pub moved: f64,
    /// Mirrored part of the scene, and whether rounding might make the march meet something else.
    pub met: Met,
    pub sure: bool,
}

/// Largest change of the scene's channels from texel to texel around a position, along x and y.
fn changes(inputs: &Inputs<'_>, at: DVec2) -> [[f64; 3]; 2] {
    let base = (at - 0.5).floor();
    let (x, y) = (base.x as isize, base.y as isize);
    let texel = |x: isize, y: isize| inputs.scene_color.clamped(x, y);
    let from = |at: [f64; 4], here: [f64; 4]| [0, 1, 2].map(|c| (at[c] - here[c]).abs());
    let mut most = [[0.0_f64; 3]; 2];
    for (i, j) in (-1..3).flat_map(|j| (-1..3).map(move |i| (x + i, y + j))) {
        let here = texel(i, j);
        let there = [from(texel(i + 1, j), here), from(texel(i, j + 1), here)];
        most = [0, 1].map(|axis| [0, 1, 2].map(|c| most[axis][c].max(there[axis][c])));
    }
    most
}

/// Slope of the smoothed surface per texel, along an axis. `rises` is the sum of the absolute depth
/// differences that enter the slope. Their rounding, that of the weights and of the weighted mean
/// are proportional to `rises`; the division and the sum of the weights add an error proportional
/// to the slope.
fn slope(surface: &Surface, axis: usize, drop: Rounded) -> Rounded {
    let parts = &surface.parts;
    let [smooth, rises] = parts.smooth.map(|s| s[axis]);
    let smooth = Rounded { v: smooth, e: U * (15.0 * rises + 9.0 * smooth.abs()) };
    let [sphere, rises] = parts.sphere.map(|s| s[axis]);
    let sphere = Rounded { v: sphere, e: U * (2.0 * rises + 4.0 * sphere.abs()) };
    mix(smooth, sphere, drop)
}

/// A channel of the light that water of a given path length passes on and scatters. `sunlit`:
/// brightness that a matte surface at the water's surface has in the sun, on level ground.
pub fn through(
    medium: &Medium,
    behind: Rounded,
    (path, sunlit): (Rounded, Rounded),
    i: usize,
) -> Rounded {
    match medium {
        Medium::Physical { absorption, scattering, ambient } => {
            let extinction = exact(absorption[i]) + exact(scattering[i]);
            let kept = (-extinction * path).exp();
            let least = Rounded { v: extinction.v.max(1e-9), e: extinction.e };
            let albedo = exact(scattering[i]) / least;
            behind * kept + exact(ambient[i]) * albedo * (exact(1.0) - kept)
        }
        Medium::Turbid { extinction, own, share, shade } => {
            // Sums, a root, products and quotients on the CPU.
            let kept = (-off(extinction[i], 1.0) * path).exp();
            let (share, shade) = (off(*share, 40.0), off(shade[i], 5.0));
            let lit = mix(exact(1.0), mix(sunlit, exact(1.0), shade), share);
            behind * kept + lit * off(own[i], 32.0) * (exact(1.0) - kept)
        }
        Medium::Source { base, k } => {
            let tint = exact(base[i]) * (-exact(k[i]) * path).exp();
            mix(tint, behind, (-exact(k[3]) * path).exp())
        }
    }
}

/// Inputs of a pixel's shading, with rounding errors.
struct Lit {
    z: Rounded,
    path: Rounded,
    /// Brightness of a matte surface with the same normal in the sun, on level ground.
    sunlit: Rounded,
    /// Displacement of the look-up.
    offset: [Rounded; 2],
    /// Share of the reflection in the pixel; `turned` is the error of the reflected direction,
    /// `shine` the sun's highlight.
    share: Rounded,
    /// Share of the reflection that comes from the environment, where the reflected ray does not
    /// hit the scene.
    sky: Rounded,
    turned: f64,
    shine: Rounded,
    /// Colour of the baseline's foam.
    foam: [Rounded; 3],
    /// Fraction to which the scene touches the water, and height of the water above the scene in
    /// scene units.
    wet: Rounded,
    down: Rounded,
    /// Fraction to which the water darkens the scene.
    film: Rounded,
    /// Thickness of the water along z in scene units.
    thick: Rounded,
}

/// Fraction to which the scene touches the water: it depends on how much of the distance from the
/// surface to the scene the water fills.
fn wet(t: Rounded, room: Rounded, limited: bool) -> Rounded {
    if limited || room.v == 0.0 {
        // The distance is a number divided by itself, or zero; rounding may decide which.
        let v = f64::from(u8::from(room.v > 0.0));
        return Rounded { v, e: if room.v <= room.e { room.e.min(1.0).ceil() } else { 0.0 } };
    }
    if room.v <= 2.0 * room.e {
        let v = crate::reference::smoothstep(0.5, 0.7, t.v / room.v);
        return Rounded { v, e: 1.0 };
    }
    smoothstep(off(0.5, 1.0), off(0.7, 1.0), t / room)
}

/// Ratio of the length of the refracted path to the eye to that of the straight path.
fn bent_way(bed: &Bed, n: [Rounded; 3], v: [Rounded; 3], up: [Rounded; 3]) -> Rounded {
    // The error of a root and two quotients.
    let ratio = off(bed.index.recip(), 8.0);
    let facing = dot(n, v).clamp(0.0, f64::MAX);
    let inside = (exact(1.0) - ratio * ratio * (exact(1.0) - facing * facing)).sqrt();
    let (level, rise) = (dot(n, up).clamp(0.0, f64::MAX), dot(v, up));
    let steep = ratio * rise + (inside - ratio * facing) * level;
    let bent = if steep.v > steep.e + 1e-6 {
        (rise / steep).clamp(0.0, 1.0)
    } else {
        Rounded { v: (rise.v / steep.v.max(1e-6)).clamp(0.0, 1.0), e: 1.0 }
    };
    mix(exact(1.0), bent, level)
}

/// Colour of the scene under water, of which the water lets only a fraction through.
fn under_water(settings: &Settings, lit: &Lit, part: Rounded, dry: [Rounded; 3]) -> [Rounded; 3] {
    let Some(bed) = settings.bed.filter(|_| lit.wet.v + lit.wet.e > 0.0) else { return dry };
    // Sums and products of a few rounded numbers, their quotients, and a power.
    let leaves = off(bed.comes_in / bed.index.powi(2), 16.0);
    let (sky_way, sun_way) = (off(bed.sky_way, 16.0), off(bed.sun_way, 16.0));
    let one = exact(1.0);
    [0, 1, 2].map(|i| {
        let extinction = match settings.medium {
            Medium::Physical { absorption, scattering, .. } => {
                exact(absorption[i]) + exact(scattering[i])
            }
            Medium::Turbid { extinction, .. } => off(extinction[i], 1.0),
            Medium::Source { k, .. } => exact(k[i]),
        };
        let sky = (-extinction * (sky_way * lit.down)).exp();
        let sun = (-extinction * (sun_way * lit.down)).exp();
        let shade = off(bed.shade[i], 5.0);
        let came = shade * sky + (one - shade) * sun * off(bed.sun, 24.0);
        let came = came / (shade + (one - shade));
        let albedo = dry[i] * off(std::f64::consts::PI / bed.irradiance[i], 4.0);
        let back = sky * sky * sky * sky * sky * (one - leaves);
        let wet = dry[i] * came * leaves / (one - albedo.clamp(0.0, 1.0) * back);
        mix(dry[i], wet, part * lit.wet * lit.film)
    })
}

/// Error of the look-up in pixels. Limiting the offset does not increase its error; the offset and
/// the position add 16u of the picture.
fn moved(offset: [Rounded; 2], view: &View) -> f64 {
    offset[0].e.hypot(offset[1].e) + 16.0 * U * view.extent().max_element()
}

/// A normal tilted by the noise. Its differences are weighted means like those of a slope, with one
/// more product; the height of 1 takes two products.
fn turned(
    n: [Rounded; 3],
    [px, py]: [[Rounded; 3]; 2],
    ripple: &Ripple,
    part: Rounded,
) -> [Rounded; 3] {
    let height = |i: usize| {
        let (v, rises) = (ripple.height[i], ripple.rises[i]);
        part * Rounded { v, e: U * (16.0 * rises + 12.0 * v.abs()) }
    };
    let (along_x, along_y) = (cross(py, n), cross(n, px));
    let area = dot(px, along_x);
    let (area, sign) = if area.v < 0.0 { (-area, -1.0) } else { (area, 1.0) };
    let by = |i: usize| exact(sign) * (height(0) * along_x[i] + height(1) * along_y[i]);
    normalize([0, 1, 2].map(|i| area * n[i] - by(i)))
}

/// Shades a surface with a number of pixels per texel, a thickness, and a visible part of its
/// reflection.
fn lit(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    texel: f64,
    (t, part): (Rounded, Rounded),
    view: &View,
    (x, y): (usize, usize),
) -> Lit {
    let radius = off(settings.radius, 2.0);
    let spacing = off(settings.radius / 0.656, 1.0);
    // Weighted means: four products, three sums, weights with 9u. A mean of two weighted means adds
    // the same error again.
    let means = if surface.parts.case == Case::Whole { 4.0 } else { 13.0 };
    let means = if surface.parts.mixed > 0.0 { means + 26.0 } else { means };
    let z = off(-surface.position.z, means);
    let (low, high) = (off(0.6, 1.0) * spacing, off(0.9, 1.0) * spacing);
    // Without a slope of its own depth the pixel cannot be a drop.
    let drop = match surface.parts.drop {
        0.0 => exact(0.0),
        _ => exact(1.0) - smoothstep(low, high, t),
    };
    let (dx, dy) = (slope(surface, 0, drop), slope(surface, 1, drop));
    // The scene's depth is a rounded quotient of two projection entries.
    let room = match surface.room.is_finite() {
        true => (off(inputs.scene(x, y), 8.0) - z).clamp(0.0, f64::MAX),
        false => exact(EMPTY),
    };
    let (own, limited) = (t.e, surface.thickness < surface.parts.full);
    let t = if limited { room } else { t };
    // Rounding may choose either case.
    let near = room.e.is_finite() && (surface.parts.full - room.v).abs() <= own + room.e;
    let t = if near { Rounded { e: own.max(room.e), ..t } } else { t };

    // Scale and offset of the slopes are quotients of rounded numbers.
    let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let step = view.slope_step();
    let (first, ray) = (view.ray_at(DVec2::ZERO), view.ray(x, y));
    let along = |pixel: f64, step: f64, first: f64, slope: f64| {
        let sum = exact(pixel) * off(step, 2.0) + off(first, 2.0);
        Rounded { v: slope, e: sum.e }
    };
    let sx = along(pixel.x, step.x, first.x, ray.x);
    let sy = along(pixel.y, step.y, first.y, ray.y);
    let px = [off(step.x * texel, 2.0) * z + sx * dx, sy * dx, -dx];
    let py = [sx * dy, off(step.y * texel, 2.0) * z + sy * dy, -dy];
    let mut n = normalize(cross(px, py));
    let position = [sx * z, sy * z, -z];
    if dot(n, position).v > 0.0 {
        n = n.map(|c| -c);
    }
    let wet = match &settings.bed {
        Some(_) => wet(t, room, limited && !near),
        None => exact(0.0),
    };
    let ripple = &surface.ripple;
    if ripple.height != DVec2::ZERO {
        // Tangents that span a full pixel.
        let part = exact(1.0 / texel);
        let tangents = [px, py].map(|p| p.map(|c| c * part));
        let airborne = inputs.noise.map_or(0.0, |noise| noise.look.airborne);
        n = turned(n, tangents, ripple, exact(1.0) - exact(airborne) * wet);
    }
    let away = dot(position, position).sqrt();
    let v = position.map(|c| -c / away);
    let straight = t * away / z;
    let up = view.view.transform_vector3(DVec3::Y).to_array();
    let up = up.map(|v| Rounded { v, e: 16.0 * U });
    let down = straight * dot(v, up).clamp(0.0, f64::MAX);
    let way = settings.bed.as_ref().map_or(exact(1.0), |bed| bent_way(bed, n, v, up));
    let path = straight * mix(exact(1.0), way, wet);
    let torn = exact(2.0) * spacing;
    let torn = if t.v < torn.v { t } else { torn };
    let lens = exact(settings.refraction) * mix(torn, t, off(surface.parts.found, means));
    let scale = |wide: f64| lens / (off(wide, 2.0) * z);
    let offset = [n[0] * scale(step.x.abs()), n[1] * scale(step.y.abs())];

    let w = part * smoothstep(exact(0.0), exact(0.25) * radius, t);
    let cosine = dot(n, v);
    let twice = exact(2.0) * cosine;
    let reflected = [0, 1, 2].map(|i| twice * n[i] - v[i]);
    // The inverse of the view has an error of 16u of its entries, which are at most 1.
    let world = view.view.inverse();
    let world = |row: usize| [0, 1, 2].map(|i| Rounded { v: world.col(i)[row], e: 16.0 * U });
    let reflected = [0, 1, 2].map(|row| dot(world(row), reflected));
    let sky = smoothstep(off(-0.3, 1.0), exact(0.0), reflected[1]);
    let grazing = (exact(1.0) - cosine).clamp(0.0, 1.0);
    let fresnel = match settings.fresnel {
        Fresnel::Schlick { f0 } => {
            let square = grazing * grazing;
            exact(f0) + off(1.0 - f0, 1.0) * square * square * grazing
        }
        Fresnel::Source { bias, scale, power } => {
            (exact(bias) + exact(scale) * grazing.pow(exact(power))).clamp(0.0, 1.0)
        }
    };
    let turned = reflected.iter().map(|c| c.e).fold(0.0, f64::max);
    let share = w * fresnel;

    let sun = settings.sun_direction.to_array().map(|v| Rounded { v, e: 16.0 * U });
    let level = settings.sun_direction.dot(view.view.transform_vector3(DVec3::Y)).max(0.05);
    let sunlit = dot(n, sun).clamp(0.0, f64::MAX) / Rounded { v: level, e: 40.0 * U };
    let half = normalize([0, 1, 2].map(|i| v[i] + sun[i]));
    let facing = dot(n, half);
    // The shader cuts the base at 2^-100.
    let shine = facing.pow(exact(settings.shininess)) + Rounded { v: 0.0, e: 0.5_f64.powi(100) };
    // The weights of the mean have an error of 13u, plus a product; the radiance is two products
    // and a constant.
    let grey = surface.ripple.foam.to_array().map(|c| w * off(c, 19.0));
    Lit {
        z,
        path,
        sunlit,
        offset,
        share,
        sky,
        turned,
        shine: w * shine,
        foam: grey,
        wet,
        down,
        film: smoothstep(exact(0.5) * spacing, exact(2.0) * spacing, t),
        thick: t,
    }
}

/// Light that a surface passes on from the colour behind it.
fn over(
    settings: &Settings,
    lit: &Lit,
    behind: [Rounded; 3],
    env: DVec3,
    (met, scene): (Rounded, [Rounded; 3]),
    filter: &Filter,
) -> [Rounded; 3] {
    let free = lit.sky * (exact(1.0) - met);
    let all = if met.v + met.e > 0.0 { free + met } else { lit.sky };
    [0, 1, 2].map(|i| {
        let water = through(&settings.medium, behind[i], (lit.path, lit.sunlit), i);
        let seen = filter.sky_slope * lit.turned + filter.sky_error + 4.0 * U * env[i];
        let seen = Rounded { v: env[i], e: seen };
        let mirrored = if met.v + met.e == 0.0 || all.v == 0.0 {
            seen
        } else {
            (met * scene[i] + free * seen) / all
        };
        let c = mix(water, mirrored, lit.share * all);
        c + (exact(settings.specular[i]) * lit.shine * exact(settings.sun_color[i]) + lit.foam[i])
    })
}

/// The scene's reflection in the front surface: its share, its colour, and the result of the march.
#[allow(clippy::too_many_arguments)] // each is one thing that a pixel goes by
fn mirrored(
    inputs: &Inputs<'_>,
    behind: Option<&Behind<'_>>,
    settings: &Settings,
    surface: &Surface,
    lit: &Lit,
    view: &View,
    env: DVec3,
    filter: &Filter,
) -> ((Rounded, [Rounded; 3]), Met, bool) {
    if settings.mirror_steps == 0 || surface.thickness == 0.0 && lit.share.e == 0.0 {
        return (NOTHING, Met::default(), true);
    }
    // The direction in the world has the error of that in eye space, and of the rotation.
    let off_by = (4.0 * lit.turned, 4.0 * (lit.z.e / lit.z.v + 16.0 * U));
    let (met, moved, sure) = met_about(inputs, settings, surface, view, off_by);
    if met.share == 0.0 {
        return (NOTHING, met, sure);
    }
    let at =
        met_water(inputs, behind, settings, surface, view, (met.at, moved, off_by.0), env, filter);
    let share = Rounded { v: met.share, e: moved * 16.0 / view.extent().y + 16.0 * U };
    ((share, at), met, sure)
}

const NOTHING: (Rounded, [Rounded; 3]) =
    (Rounded { v: 0.0, e: 0.0 }, [Rounded { v: 0.0, e: 0.0 }; 3]);

/// Max change of a wet surface's colour relative to the change of its dry colour: 1/q, with q =
/// 0.53 for water.
const WET: f64 = 1.9;

/// The colour where a ray meets the scene, with the water that lies on it. Its error is the largest
/// change of that colour within the errors of the position (pixels) and of the direction, plus the
/// error of filtering the dry scene.
#[allow(clippy::too_many_arguments)] // each is one thing that a pixel goes by
fn met_water(
    inputs: &Inputs<'_>,
    behind: Option<&Behind<'_>>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    (at, moved, turned): (DVec2, f64, f64),
    env: DVec3,
    filter: &Filter,
) -> [Rounded; 3] {
    let by = moved + 1.0 / f64::from(1 << filter.bits);
    let last = view.extent() - 1.0e-6;
    let color = |at: DVec2, along: DVec3| {
        let at = at.clamp(DVec2::ZERO, last);
        met_scene(inputs, behind, settings, view, (at, along.normalize()), |_| env)
    };
    let along = direction(surface);
    let found = color(at, along);
    let mut off = DVec3::ZERO;
    for axis in [DVec2::X, DVec2::Y, DVec2::ONE, DVec2::new(1.0, -1.0)] {
        for side in [by, -by] {
            off = off.max((color(at + axis * side, along) - found).abs());
        }
    }
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        for side in [turned, -turned] {
            off = off.max((color(at, along + axis * side) - found).abs());
        }
    }
    let changes = changes(inputs, at);
    [0, 1, 2].map(|i| {
        let dry = by * (changes[0][i] + changes[1][i]);
        Rounded { v: found[i], e: WET * dry + off[i] + 64.0 * U * (found[i].abs() + env[i]) }
    })
}

/// The scene's colour at the look-up, which has an error in pixels.
fn scene(
    inputs: &Inputs<'_>,
    at: DVec2,
    moved: f64,
    background: DVec3,
    filter: &Filter,
) -> [Rounded; 3] {
    let by = moved + 1.0 / f64::from(1 << filter.bits);
    let changes = changes(inputs, at);
    [0, 1, 2].map(|i| {
        let e = by * (changes[0][i] + changes[1][i]) + 4.0 * U * background[i].abs();
        Rounded { v: background[i], e }
    })
}

/// The pixel at (x, y), in the order of glsl/composite.frag. `background` and `env` are the twin's.
pub fn shaded(
    inputs: &Inputs<'_>,
    settings: &Settings,
    surface: &Surface,
    view: &View,
    (x, y): (usize, usize),
    (background, env): (DVec3, DVec3),
    filter: &Filter,
) -> Shaded {
    let texel = f64::from(1 << inputs.level);
    let t = off(surface.parts.full, if inputs.thickness_level == 0 { 0.0 } else { 13.0 });
    let mut lit = lit(inputs, settings, surface, texel, (t, exact(1.0)), view, (x, y));
    let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let mut moved = moved(lit.offset, view);
    // Without a scene there is no bed.
    let bed = lit.wet.v + lit.wet.e > 0.0 && is_surface(inputs.scene(x, y));
    if let Some(index) = settings.exit.filter(|_| bed) {
        let spacing = settings.radius / 0.656;
        let by = (index, spacing, 4.0 * lit.turned, 4.0 * (lit.z.e / lit.z.v + 16.0 * U));
        let ((offset, more), (touches, error)) = bed_about(inputs, surface, view, pixel, by);
        // The thickness' relative error changes the share at most 1.5 · 4 / 2 = 3 times as much.
        let error = error + 3.0 * lit.thick.e / lit.thick.v.max(spacing);
        lit.wet = lit.wet * Rounded { v: touches, e: error };
        moved += more + lit.wet.e * (offset.length() + view.extent().y / 16.0);
    }
    let q = look_up(inputs, settings, surface, view, pixel);
    let (q, _) = cut_look_up(inputs, lit.z.v, pixel, q);
    let behind = scene(inputs, q, moved, background, filter);
    let behind = under_water(settings, &lit, exact(1.0), behind);
    let (of_scene, met, mut sure) =
        mirrored(inputs, None, settings, surface, &lit, view, env, filter);
    let mut behind = behind;
    if settings.exit.is_some() && surface.thickness > 0.0 {
        // A uniform environment: its reflection is the same in all directions.
        let color = DVec3::from(behind.map(|c| c.v));
        // Four times the error of normals. The slope of the thickness is a difference of numbers no
        // larger than the thickness, over the width of a pixel.
        let width = view.slope_step().abs().min_element() * lit.z.v;
        let around = surface.parts.full.max(surface.thickness) + settings.radius;
        let turned = 4.0 * (lit.turned + 16.0 * U * (1.0 + around / width));
        let share = 4.0 * (lit.z.e / lit.z.v + lit.thick.e / lit.thick.v + 32.0 * U);
        let (seen, light, path, same) = exit_about(
            inputs,
            settings,
            surface,
            view,
            (x, y),
            color,
            |_| env,
            (turned, share.min(0.5)),
        );
        sure &= same;
        let by = 1.0 / f64::from(1 << filter.bits);
        let changes = changes(inputs, seen.met.at);
        behind = [0, 1, 2].map(|i| Rounded {
            v: seen.light[i],
            e: light[i]
                + behind[i].e
                + WET * by * (changes[0][i] + changes[1][i])
                + 64.0 * U * (seen.light[i].abs() + env[i]),
        });
        lit.path = Rounded { v: seen.path, e: path + lit.path.e + 64.0 * U * seen.path };
    }
    Shaded { color: over(settings, &lit, behind, env, of_scene, filter), moved, met, sure }
}

/// Thickness of the front sheet, of the back sheet and of the gap, with rounding errors.
fn sheets(
    inputs: &Inputs<'_>,
    behind: &Behind<'_>,
    settings: &Settings,
    shown: &Shown,
    f: f64,
) -> [Rounded; 3] {
    // The sums of the mean, and the quotient of its weights.
    let weight = |w: f64| off(w, if inputs.thickness_level == 0 { 0.0 } else { 13.0 });
    let mut sums = [exact(0.0); 3];
    let spacing = off(settings.radius / 0.656, 2.0);
    for (i, j, w) in shown.texels.iter().copied() {
        if !shown.parted {
            sums[0] = sums[0] + weight(w) * exact(inputs.thickness.at(i, j));
            continue;
        }
        let [front, back, window] = behind.thickness.at(i, j).map(exact);
        let (low, high) = (off(0.1, 1.0) * spacing, off(0.6, 1.0) * spacing);
        let other_part = smoothstep(low, high, window);
        let air = exact(1.0) - other_part;
        let before = f < behind.boundaries.at(i, j);
        let (own, other) = if before { (front, back) } else { (back, front) };
        sums[0] = sums[0] + weight(w) * (own + other_part * other);
        sums[1] = sums[1] + weight(w) * (air * back);
        sums[2] = sums[2] + weight(w) * air;
    }
    let Some(back) = shown.back.filter(|back| is_surface(back.nearest)) else { return sums };
    // Depths are means with an error of 13u, mixed once more.
    let z = |surface: &Surface| off(-surface.position.z, 39.0);
    let [t, t2, apart] = sums;
    let gap = (z(&back.surface) - z(&shown.front) - t) / spacing;
    let open = smoothstep(exact(1.0), exact(4.0), gap);
    [t + (exact(1.0) - open) * t2, t2 * open, apart * open]
}

/// The pixel at (x, y) if it may show two sheets. `envs` holds the environment for the front and
/// for the back sheet.
#[allow(clippy::too_many_arguments)] // each is one thing that a pixel goes by
pub fn shaded_both(
    inputs: &Inputs<'_>,
    behind: &Behind<'_>,
    settings: &Settings,
    shown: &Shown,
    view: &View,
    (x, y): (usize, usize),
    (background, envs): (DVec3, [DVec3; 2]),
    filter: &Filter,
) -> Shaded {
    let [t, t2, apart] = sheets(inputs, behind, settings, shown, inputs.depth.at(x, y));
    let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let texel = |level: u32| f64::from(1 << level);
    let front = (t, exact(1.0));
    let front = lit(inputs, settings, &shown.front, texel(inputs.level), front, view, (x, y));
    let mut offset = front.offset;
    let back = shown.back.map(|back| {
        let covered = off(back.covered, 6.0);
        let found = lit(
            inputs,
            settings,
            &back.surface,
            texel(behind.level),
            (t2, covered * apart),
            view,
            (x, y),
        );
        if back.covered > 0.0 {
            offset = [0, 1].map(|i| offset[i] + covered * found.offset[i]);
        }
        (found, covered * apart)
    });
    let moved = moved(offset, view);
    let (q, z) = look_up_both(settings, shown, view, pixel);
    let (q, _) = cut_look_up(inputs, z, pixel, q);
    let mut color = scene(inputs, q, moved, background, filter);
    color = under_water(settings, &front, exact(1.0), color);
    if let Some((back, part)) = &back {
        color = under_water(settings, back, *part, color);
    }
    if let Some((back, _)) = back {
        color = over(settings, &back, color, envs[1], NOTHING, filter);
    }
    let (of_scene, met, sure) =
        mirrored(inputs, Some(behind), settings, &shown.front, &front, view, envs[0], filter);
    Shaded { color: over(settings, &front, color, envs[0], of_scene, filter), moved, met, sure }
}
