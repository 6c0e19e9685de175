//! The picture of two sheets against the twin, and planted faults that the check must detect.

use ash::vk;
use glam::{DVec2, DVec3, Mat4, Vec3};
use whitewater::water::{Fresnel, Medium, Shading, Splat};
use whitewater::{Camera, Config};

use crate::composite::{self, FLAT, Sky, twin_settings};
use crate::harness::fails;
use crate::reduce::{params, wide};
use crate::reference::composite::{
    self as twin, Behind, Inputs, Two, cut_look_up, hidden, look_up_both, scene_at,
};
use crate::reference::levels::Levels;
use crate::reference::{Image, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, coarsening, extent};
use crate::support::scenes::{self, Lens};
use crate::support::shaded::{Filter, Shaded, shaded_both};
use crate::support::tolerance::U;

use super::back::{back_level, twins_frame};
use super::{SPACING, of, shot, shot_of, some, two};

/// A slab before a slanted one, seen from above, so that reflected rays end above the horizon.
fn slabs(size: vk::Extent2D) -> Shot {
    let mut points = scenes::block(6, SPACING, [8, 6, 3], [-1.3, -0.7, 3.0]);
    let slanted = scenes::block(7, SPACING, [34, 20, 4], [-4.2, -2.4, 6.0]);
    points.extend(slanted.into_iter().map(|[x, y, z]| [x, y, z + 0.3 * x]));
    let mut shot = shot_of(size, Lens::Standard, &points);
    let view = Mat4::look_to_rh(Vec3::new(1.0, 9.0, 2.0), Vec3::NEG_Y, Vec3::NEG_Z);
    shot.camera = Camera { view: view.to_cols_array_2d(), ..shot.camera };
    shot.positions = scenes::world(&shot.camera, &points);
    shot.settings.water.specular = 0.0;
    shot
}

/// Inputs of the twins for a picture.
pub struct Layers {
    front: composite::Layers,
    boundaries: Image<f64>,
    back_surface: Image<f64>,
    parts: Image<[f64; 3]>,
}

impl Layers {
    pub fn new(drawn: &Drawn, shot: &Shot) -> Self {
        Self {
            front: composite::Layers::new(drawn, shot),
            boundaries: wide(&of(drawn).boundaries),
            back_surface: wide(&of(drawn).surface),
            parts: of(drawn).thickness.map(|t| t.map(f64::from)),
        }
    }

    pub fn inputs(&self, level: u32, thickness_level: u32) -> Inputs<'_> {
        self.front.inputs(level, thickness_level)
    }

    pub fn behind(&self, level: u32) -> Behind<'_> {
        Behind {
            boundaries: &self.boundaries,
            thickness: &self.parts,
            smoothed: &self.back_surface,
            level,
        }
    }
}

/// Number of pixels of each kind.
#[derive(Clone, Copy, Debug, Default)]
struct Kinds {
    /// `one`: a single sheet. `behind`: two sheets, of which the pixel shows only the back one.
    one: usize,
    behind: usize,
    /// The front sheet over the back sheet, which was found completely, partly, or not at all.
    both: usize,
    partly: usize,
    unfound: usize,
    /// The space between the sheets is not only air.
    touching: usize,
    /// The surface comes partly from the back sheet's image.
    mixed: usize,
    unsure: usize,
}

impl std::ops::AddAssign for Kinds {
    fn add_assign(&mut self, other: Self) {
        self.one += other.one;
        self.behind += other.behind;
        self.both += other.both;
        self.partly += other.partly;
        self.unfound += other.unfound;
        self.touching += other.touching;
        self.mixed += other.mixed;
        self.unsure += other.unsure;
    }
}

/// Asserts that a picture under a uniform sky equals the twin's, computed from the layers that were
/// read back. Bounds and undecided pixels are treated as in the tests of `composite`.
fn check_picture(
    name: &str,
    drawn: &Drawn,
    shot: &Shot,
    thickness_level: u32,
    bits: u32,
    fault: fn(&mut Layers),
) -> Kinds {
    let back_level = back_level(name, drawn, shot);
    let levels = [back_level - 1, back_level, thickness_level];
    check_levels(name, drawn, shot, levels, bits, fault, &|_, _| true)
}

/// Like [`check_picture`], for images at these levels: of the front sheet's surface, of the back
/// sheet's surface and of the thickness. `shows` selects the pixels that show these levels.
fn check_levels(
    name: &str,
    drawn: &Drawn,
    shot: &Shot,
    [level, back_level, thickness_level]: [u32; 3],
    bits: u32,
    fault: fn(&mut Layers),
    shows: &dyn Fn(usize, usize) -> bool,
) -> Kinds {
    let view = shot.view(shot.size);
    let settings = twin_settings(shot, &view);
    let mut layers = Layers::new(drawn, shot);
    fault(&mut layers);
    let inputs = layers.inputs(level, thickness_level);
    let behind = layers.behind(back_level);
    let (sky, falloff) = (Sky::Even.radiance(DVec3::Y), settings.falloff * settings.radius);
    let mut expected = twin::shade_sheets(&inputs, &behind, &settings, |_| sky, &view);
    let mut bounds = Image::new(view.width, view.height, [0.0; 4]);
    let filter = Filter { bits, sky_slope: 0.0, sky_error: 0.0 };
    let two = Two::new(&inputs, &behind, &settings, &view);
    let (mut kinds, mut decisions) = (Kinds::default(), 0);
    let pixels = (0..view.height).flat_map(|y| (0..view.width).map(move |x| (x, y)));
    for (x, y) in pixels {
        let Some(shown) = two.at(x, y) else { continue };
        if !shows(x, y) {
            *expected.at_mut(x, y) = drawn.output.at(x, y).map(f64::from);
            continue;
        }
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let (displaced, z) = look_up_both(&settings, &shown, &view, pixel);
        let (q, asked) = cut_look_up(&inputs, z, pixel, displaced);
        let seen = (scene_at(&inputs, q), [sky; 2]);
        let Shaded { color, moved, sure, .. } =
            shaded_both(&inputs, &behind, &settings, &shown, &view, (x, y), seen, &filter);
        for (i, c) in color.iter().enumerate() {
            let twin = expected.at(x, y)[i];
            let same = (c.v - twin).abs() <= 16.0 * U * (1.0 + twin);
            assert!(same, "{name} at ({x}, {y}): two orders, {} and {twin}, {shown:?}", c.v);
        }
        let moved = moved + 2.0 / f64::from(1 << bits);
        decisions += asked.len();
        let sides = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let either_way = |q: &DVec2| {
            let either = sides.map(|(dx, dy)| hidden(&inputs, z, *q + DVec2::new(dx, dy) * moved));
            either.iter().any(|h| *h != either[0])
        };
        // Depths are means with an error of 13u, mixed once more; the falloff is a product.
        let front = -shown.front.position.z;
        let mut unsure = shown.front.parts.margin <= 40.0 * U * (front + falloff);
        if let Some(back) = shown.back.filter(|back| is_surface(back.nearest)) {
            let (z, scene) = (-back.surface.position.z, inputs.scene(x, y));
            let near = 40.0 * U * (back.nearest + falloff);
            unsure |= shown.front.parts.margin <= near || (z - scene).abs() <= 40.0 * U * z;
        }
        unsure |= !sure || shown.barely || asked.iter().any(either_way);
        if unsure {
            kinds.unsure += 1;
            *expected.at_mut(x, y) = drawn.output.at(x, y).map(f64::from);
        } else {
            let kind = match &shown.back {
                Some(back) if back.covered == 0.0 => &mut kinds.unfound,
                Some(back) if back.covered < 1.0 => &mut kinds.partly,
                Some(_) => &mut kinds.both,
                None if shown.parted => &mut kinds.behind,
                None => &mut kinds.one,
            };
            *kind += 1;
            let apart = shown.back.map_or(1.0, |back| back.apart);
            kinds.touching += usize::from(apart < 0.999);
            kinds.mixed += usize::from(shown.front.parts.mixed > 0.01);
        }
        *bounds.at_mut(x, y) = [color[0].e, color[1].e, color[2].e, 0.0];
    }
    let census = compare::close_color(name, &drawn.output, &expected, |x, y| bounds.at(x, y));
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("{name}: {kinds:?}, {census}");
    }
    let unsure = kinds.unsure;
    assert!(unsure * 50 <= decisions, "{name}: {unsure} undecided of {decisions} decisions");
    kinds
}

const MEDIA: [(&str, Medium); 3] = [
    ("pool", Medium::POOL),
    ("milky", Medium::Physical { absorption: [0.05, 0.1, 0.25], scattering: [28.0, 27.0, 25.0] }),
    ("none", Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] }),
];

/// A uniform environment.
fn even(gpu: &Gpu, config: Config) -> Rig<'_> {
    let mut rig = Rig::new(gpu, &config);
    let [r, g, b] = Sky::Even.radiance(DVec3::Y).as_vec3().to_array();
    rig.environment(extent(4, 2), &[[r, g, b, 1.0]; 8]);
    rig
}

/// A wide highlight, and a scene of one colour or a gradient.
fn look(mut shot: Shot, flat: bool) -> Shot {
    let water = &mut shot.settings.water;
    (water.specular, water.shininess) = (0.3, 20.0);
    // If noise is drawn, its foam is only on the front sheet.
    shot.settings.noise.foam = 1.0;
    if flat {
        shot.color.fill(FLAT);
    }
    shot
}

/// Two sheets at all resolutions and with both ways of shading, including gaps that are not only
/// air, and surfaces that only the back sheet's image contains.
#[test]
fn the_picture_of_two_sheets_is_the_twins() {
    let gpu = Gpu::shared();
    let bits = gpu.limits().sub_texel_precision_bits;
    let size = extent(160, 100);
    let mut kinds = Kinds::default();
    let levels = [(0, 0), (1, 2), (2, 3), (1, 1), (0, 1), (2, 1)];
    for (smoothing_level, thickness_level) in levels.into_iter().take(some(3)) {
        for (way, splat) in [(Shading::Raster, Splat::Compute), (Shading::Compute, Splat::Raster)] {
            let config = two(size).with(|it| {
                it.smoothing_level = smoothing_level;
                it.thickness_level = thickness_level;
                it.coarsening = 0;
                it.composite = Some(way);
                it.thickness_splat = Some(splat);
                it.noise = (way == Shading::Compute).then_some(1);
            });
            let mut rig = even(&gpu, config);
            for (scene, lens) in
                [("torn", Lens::Standard), ("torn", Lens::OffAxis), ("slabs", Lens::Standard)]
            {
                for flat in [true, false] {
                    let shot = if scene == "torn" { shot(size, lens) } else { slabs(size) };
                    let shot = look(shot, flat);
                    let name = format!(
                        "picture-{smoothing_level}{thickness_level}-{way:?}-{scene}-{lens:?}-{flat}"
                    );
                    let drawn = rig.draw(&shot);
                    kinds += check_picture(&name, &drawn, &shot, thickness_level, bits, |_| ());
                }
            }
        }
    }
    let Kinds { one, behind, both, partly, unfound, touching, mixed, .. } = kinds;
    let least = [one, behind, both, partly, unfound, touching, mixed];
    assert!(least.iter().all(|pixels| *pixels >= 100), "{kinds:?}");
}

#[test]
fn the_front_sheet_lies_over_the_back_one() {
    let gpu = Gpu::shared();
    let bits = gpu.limits().sub_texel_precision_bits;
    let size = extent(96, 64);
    for way in [Shading::Raster, Shading::Compute].into_iter().take(some(1)) {
        let mut rig = even(
            &gpu,
            two(size).with(|it| {
                it.coarsening = 0;
                it.composite = Some(way);
            }),
        );
        for (medium_name, medium) in MEDIA.into_iter().chain([("source", Medium::source(0.3))]) {
            for bias in [0.0, 0.3] {
                for flat in [true, false] {
                    let mut shot = look(slabs(size), flat);
                    shot.settings.water.medium = medium;
                    shot.settings.water.fresnel = Fresnel::Source { bias, scale: 0.2, power: 2.0 };
                    let name = format!("over-{medium_name}-{bias}-{flat}-{way:?}");
                    let kinds = check_picture(&name, &rig.draw(&shot), &shot, 2, bits, |_| ());
                    assert!(kinds.both > 100, "{name}: {kinds:?}");
                }
            }
        }
    }
}

/// The scene stands before, between and behind the sheets. It hides the water behind it, and no
/// refracted look-up shows a part of the scene in front of the water.
#[test]
fn the_scene_stands_among_the_sheets() {
    let gpu = Gpu::shared();
    let bits = gpu.limits().sub_texel_precision_bits;
    let size = extent(160, 100);
    let mut kinds = Kinds::default();
    for (smoothing_level, thickness_level) in [(0, 0), (1, 2)] {
        let config = two(size).with(|it| {
            it.smoothing_level = smoothing_level;
            it.thickness_level = thickness_level;
            it.coarsening = 0;
        });
        let mut rig = even(&gpu, config);
        for lens in [Lens::Standard, Lens::OffAxis] {
            let mut shot = look(shot(size, lens), false);
            shot.settings.water.refraction = 0.6;
            shot.scene_depth(|x, y| ((x / 9 + y / 5) % 2 == 0).then_some(3.2 + f64::from(y % 9)));
            let name = format!("among-{smoothing_level}{thickness_level}-{lens:?}");
            kinds += check_picture(&name, &rig.draw(&shot), &shot, thickness_level, bits, |_| ());
        }
    }
    assert!(kinds.unfound > 100 && kinds.both > 100, "{kinds:?}");
}

/// Water so near that coarser levels are shown, for each sheet the level for its distance.
#[test]
fn near_sheets_are_the_twins() {
    let gpu = Gpu::shared();
    let bits = gpu.limits().sub_texel_precision_bits;
    let size = extent(160, 100);
    let (mut kinds, mut seen) = (Kinds::default(), [0; 3]);
    for (way, lens, thickness_level) in
        [(Shading::Raster, Lens::Standard, 0), (Shading::Compute, Lens::OffAxis, 3)]
    {
        let config = coarsening(two(size)).with(|it| {
            it.smoothing_level = 0;
            it.thickness_level = thickness_level;
            it.composite = Some(way);
        });
        let mut rig = even(&gpu, config);
        for (torn, width) in
            [(true, 2.0), (true, 2.8), (true, 5.7), (false, 4.2), (false, 7.8), (false, 15.6)]
        {
            let shot = if torn { shot(size, lens) } else { slabs(size) };
            let mut shot = look(shot, false);
            shot.settings.water.smoothing_width = width;
            let drawn = rig.draw(&shot);
            let levels = Levels {
                view: shot.view(size),
                first: 0,
                coarser: 3,
                params: params(&shot, config.max_iterations),
            };
            let boundary = |x: usize, y: usize| {
                of(&drawn).boundaries.at(x >> thickness_level, y >> thickness_level)
            };
            // Levels of the front and of the back sheet that a pixel shows without blending; 0 if
            // it blends levels.
            let shown = Image::from_fn(160, 100, |x, y| {
                let of_pixel = |z: f32| levels.shown(levels.nearness_at((x, y), f64::from(z)));
                let z = drawn.depth.at(x, y);
                let (front, fade) = of_pixel(z);
                let behind = |boundary: f32| {
                    let covers = z < boundary && boundary < 1e9;
                    let (back, behind) = of_pixel(if covers { boundary } else { z });
                    (back.max(1), back == 0 || behind == 0.0, covers)
                };
                let (back, whole, covers) = behind(boundary(x, y));
                // The pixel may use the boundary of any of the four texels around it.
                let half = (1 << thickness_level) / 2;
                let near =
                    |at: usize, size: usize| [at.saturating_sub(half), (at + half).min(size - 1)];
                let mut around =
                    near(y, 100).into_iter().flat_map(|y| near(x, 160).map(|x| boundary(x, y)));
                let same = around.all(|other| behind(other) == (back, whole, covers));
                let alone = fade == 0.0 && whole && same && z < 1e9;
                (if alone { front } else { 0 }, back, covers)
            });
            for (front, back) in (1..4).flat_map(|front| (1..4).map(move |back| (front, back))) {
                // Tiles without a boundary, up to a texel beyond their edge, are drawn as one
                // sheet.
                let two = |x: usize, y: usize| {
                    let around = |at: usize, size: usize| {
                        let tile = at / 16 * 16;
                        tile.saturating_sub(1 << front)..(tile + 16 + (1 << front)).min(size)
                    };
                    around(y, 100).any(|y| around(x, 160).any(|x| boundary(x, y) < 1e9))
                };
                let shows = |x: usize, y: usize| {
                    let (f, b, _) = shown.at(x, y);
                    (f, b) == (front, back) && two(x, y)
                };
                let own =
                    |(f, b, covers): &&(usize, usize, bool)| *covers && (*f, *b) == (front, back);
                // If thickness and surface have the same level, the twin reads the thickness texel
                // by texel. The renderer, whose level changes from pixel to pixel, filters it by
                // the surface at each texel's centre. These cases are skipped.
                let other = thickness_level == 0 || thickness_level != front as u32;
                if !other || shown.data.iter().filter(own).count() < 20 {
                    continue;
                }
                let mut told = drawn.clone();
                told.surface = drawn.coarser[front - 1].0.clone();
                if let (Some(sheets), true) = (&mut told.sheets, back > 1) {
                    sheets.surface = sheets.coarser[back - 2].0.clone();
                }
                let at = [front as u32, back as u32, thickness_level];
                let name = format!("near-sheets-{way:?}-{width}-{front}{back}");
                let found = check_levels(&name, &told, &shot, at, bits, |_| (), &shows);
                seen[back - 1] += found.both + found.partly;
                kinds += found;
            }
        }
    }
    let Kinds { one, behind, .. } = kinds;
    assert!(one >= 100 && behind >= 100, "{kinds:?}");
    assert!(seen.iter().all(|pixels| *pixels >= 100), "{seen:?} pixels of the back sheet's levels");
}

/// Between two pictures with slightly different smoothing, pixels whose back sheet changes its
/// level change on average at most twice as much as the others.
#[test]
fn the_back_sheets_levels_pass_without_a_step() {
    let gpu = Gpu::shared();
    let size = extent(160, 100);
    // So few iterations that the surfaces of two levels differ clearly.
    let config = coarsening(two(size)).with(|it| {
        it.smoothing_level = 0;
        it.thickness_level = 0;
        it.max_iterations = 6;
    });
    let mut rig = even(&gpu, config);
    let (mut crossing, mut others) = ([0.0; 2], [0.0; 2]);
    let mut before: Option<(Drawn, Vec<usize>)> = None;
    for step in 0..54 {
        let mut shot = look(slabs(size), true);
        shot.settings.water.smoothing_width = 1.01_f32.powi(step);
        let drawn = rig.draw(&shot);
        let params = params(&shot, config.max_iterations);
        assert_eq!((drawn.coarser.len(), of(&drawn).coarser.len()), (3, 2), "the levels drawn");
        let levels = Levels { view: shot.view(size), first: 0, coarser: 3, params };
        let level = |i: usize| {
            let (x, y) = (i % 160, i / 160);
            let boundary = f64::from(of(&drawn).boundaries.at(x, y));
            levels.shown(levels.nearness_at((x, y), boundary)).0
        };
        let shown: Vec<_> = (0..drawn.depth.data.len()).map(level).collect();
        if let Some((last, was)) = &before {
            for i in 0..shown.len() {
                let (z, boundary) = (drawn.depth.data[i], of(&drawn).boundaries.data[i]);
                let covers = z < boundary && boundary < 1e9;
                if !covers || boundary != of(last).boundaries.data[i] {
                    continue;
                }
                let change = (0..3)
                    .map(|c| f64::from((drawn.output.data[i][c] - last.output.data[i][c]).abs()))
                    .sum::<f64>();
                // The front sheet's first two levels correspond to a single level of the back
                // sheet.
                let moved = shown[i] > was[i] && was[i] > 0;
                let sums = if moved { &mut crossing } else { &mut others };
                sums[0] += change;
                sums[1] += 1.0;
            }
        }
        before = Some((drawn, shown));
    }
    let [step, rest] = [crossing, others].map(|[sum, count]| sum / count);
    eprintln!("{step} a pixel of {} that cross, {rest} of {}", crossing[1], others[1]);
    assert!(crossing[1] > 200.0, "{} pixels cross", crossing[1]);
    assert!(step < 2.0 * rest, "{step} a pixel that crosses, {rest} of others");
}

type Fault = fn(&mut Layers);

/// Faults of the layers that the check of a picture must detect.
const FAULTS: [(&str, Fault); 7] = [
    ("order", |layers| layers.parts.data.iter_mut().for_each(|t| t.swap(0, 1))),
    ("front", |layers| layers.parts.data.iter_mut().for_each(|t| t[0] *= 1.001)),
    ("back", |layers| layers.parts.data.iter_mut().for_each(|t| t[1] *= 1.001)),
    ("window", |layers| layers.parts.data.iter_mut().for_each(|t| t[2] *= 1.05)),
    ("all", |layers| layers.front.thickness.data.iter_mut().for_each(|t| *t *= 1.001)),
    ("depth", |layers| layers.back_surface.data.iter_mut().for_each(|z| *z *= 1.05)),
    ("boundary", |layers| layers.boundaries.data.iter_mut().for_each(|b| *b -= 1.0)),
];

/// The check of the picture accepts the twin's own layers, and detects small faults.
#[test]
fn a_planted_fault_of_the_picture_is_seen() {
    let size = extent(160, 100);
    for (smoothing_level, thickness_level) in [(0, 0), (1, 2)] {
        for flat in [true, false].into_iter().take(some(1)) {
            let shot = look(shot(size, Lens::Standard), flat);
            let drawn = twins_frame(&shot, smoothing_level, thickness_level);
            let check = |fault| {
                check_picture("planted-picture", &drawn, &shot, thickness_level, 8, fault);
            };
            check(|_| ());
            for (name, fault) in FAULTS {
                let seen = fails(|| check(fault));
                assert!(seen, "{name} passes at {smoothing_level}{thickness_level}, {flat}");
            }
        }
    }
}
