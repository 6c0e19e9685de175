//! Compares pass `soap` with its CPU twin, in a uniform environment and in one with a gradient, with
//! a sun and without.

use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

use glam::{DVec2, DVec3};
use whitewater::Config;
use whitewater::bubbles::{BubbleConfig, BubbleSettings, Impostor};
use whitewater::headless::Bubble;
use whitewater::water::Shadows;

use super::film::bound;
use super::impostor::{NONE, blob, rays, templates};
use crate::light::even as light_past;
use crate::reference::bubbles::core::Picture;
use crate::reference::bubbles::soap::{
    Look, Medium, Met, Pixel, Placed, Sun, Table, Template, Water, pixel,
};
use crate::reference::classify::pcg;
use crate::reference::{Image, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{Lens, Random};
use crate::support::tolerance::U;

/// Radiance of the environment; half precision represents it and its half exactly.
const RADIANCE: DVec3 = DVec3::new(1.0, 0.625, 1.75);

/// Size of the core's image in texels (src/bubbles/templates.rs).
const PICTURE_SIZE: usize = 256;

/// Max angle by which rounding turns a ray: the positions of eye and blob are sums of about ten
/// numbers, each up to a few times their distance.
const TURNED: f64 = 64.0 * U;

/// If turning a ray by that angle changes its colour by more than this, the ray may hit another
/// wall or none.
const JUMP: f64 = 1.0 / 128.0;

/// One step of half precision at this value.
pub fn half_step(value: f64) -> f64 {
    (value.abs() / 1024.0).max(1.0 / f64::from(1 << 24))
}

/// Settings without noise and pattern.
pub fn even(film: f32) -> BubbleSettings {
    BubbleSettings::default().with(|it| {
        it.film = film;
        it.variation = 0.0;
        it.drainage = 0.0;
        it.albedo = [0.9, 0.8, 0.5];
        it.pattern = 0.0;
    })
}

/// The look as the twin takes it, where this much of the sun passes the host's scene.
fn twin(shot: &Shot, side: DVec3, past: f64) -> Look {
    let (look, light) = (&shot.settings.bubbles, &shot.settings.light);
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let to = vector(light.direction).normalize();
    // The irradiances are those of level ground.
    let high = to.dot(vector(shot.settings.up).normalize());
    let irradiance = past * (vector(light.irradiance) - vector(light.shade)) / high;
    let shininess = f64::from(look.shininess);
    Look {
        sun: Sun { to, irradiance, glint: past * vector(light.color), shininess },
        film: f64::from(look.film),
        variation: f64::from(look.variation),
        drainage: f64::from(look.drainage),
        core: [look.core_opaque_radius, look.core_outer_radius].map(f64::from),
        albedo: DVec3::from(look.albedo.map(f64::from)),
        pattern: f64::from(look.pattern),
        distortion: f64::from(look.distortion),
        roundness: f64::from(look.roundness),
        reflection: f64::from(look.reflection),
        walls: look.walls,
        plug: look.fill_holes,
        radiance: RADIANCE,
        side,
    }
}

/// A renderer, and the inputs of its twin.
pub struct Scene<'g> {
    pub rig: Rig<'g>,
    bubbles: BubbleConfig,
    templates: Vec<Template>,
    films: &'static Table,
    picture: &'static Picture,
    /// Gradient of the environment.
    side: DVec3,
    /// Fraction of the sun that passes the host's scene.
    past: f64,
}

/// A pixel of the twin.
#[derive(Clone)]
pub struct Expected {
    pub pixel: Pixel,
    /// Error bound of the picture.
    pub off: [f64; 4],
    /// Change of the colour if the ray turns by the rounding angle.
    change: f64,
}

impl<'g> Scene<'g> {
    /// An environment whose radiance grows linearly towards `side`.
    fn new(gpu: &'g Gpu, side: DVec3) -> Self {
        Self::of(gpu, side, 3, config(extent(112, 96)))
    }

    /// A scene like that of [`new`](Self::new), with this number of layers and another
    /// configuration.
    pub fn of(gpu: &'g Gpu, side: DVec3, layers: u32, config: Config) -> Self {
        let bubbles = BubbleConfig::new(64).with(|it| {
            it.variants = 3;
            it.bubbles = 28;
            it.layers = layers;
        });
        let config = config.with(|it| it.bubbles = Some(bubbles));
        let mut rig = Rig::with_slots(gpu, &config, 1);
        let (width, height) = (64, 32);
        let texel = |i: u32| {
            let east = TAU * (f64::from(i % width) + 0.5) / f64::from(width) - PI;
            let (above, up) = (PI * (f64::from(i / width) + 0.5) / f64::from(height)).sin_cos();
            let direction = DVec3::new(east.sin() * above, up, -east.cos() * above);
            (RADIANCE * (1.0 + side.dot(direction))).as_vec3().extend(1.0).to_array()
        };
        let texels: Vec<_> = (0..width * height).map(texel).collect();
        rig.environment(extent(width, height), &texels);
        let bits = gpu.limits().sub_texel_precision_bits;
        let templates = templates(&bubbles).iter().map(|own| Template::new(own)).collect();
        static FILMS: OnceLock<Table> = OnceLock::new();
        let index = f64::from(bubbles.film.index);
        let films = FILMS.get_or_init(|| Table::new((64, 256), index, bits, bound));
        static PICTURE: OnceLock<Picture> = OnceLock::new();
        let picture = PICTURE.get_or_init(|| Picture::new(PICTURE_SIZE, bubbles.seed, bits));
        Self { rig, bubbles, templates, films, picture, side, past: 1.0 }
    }

    /// Blobs whose bubbles are several pixels large, entirely in front of the camera.
    fn shot(&self, lens: Lens, many: bool) -> Shot {
        self.shot_in(lens, many, (0.1, &[]))
    }

    /// A shot that also has water particles of this radius.
    pub fn shot_in(&self, lens: Lens, many: bool, (radius, points): (f32, &[[f32; 3]])) -> Shot {
        let mut shot = Shot::new(self.rig.config.extent, lens, radius, points);
        let mut random = Random(11);
        shot.blobs = match many {
            false => vec![blob(&shot, [0.0, 0.0, 3.0], 1.4, 3, &mut random)],
            true => heap(&shot, &mut random),
        };
        shot.settings.light.shade = shot.settings.light.irradiance;
        shot.settings.light.color = [0.0; 3];
        let view = shot.view(shot.size);
        let least = self.templates.iter().map(Template::least).fold(f64::INFINITY, f64::min);
        for blob in &shot.blobs {
            let [x, y, z, r] = blob.ball.map(f64::from);
            let depth = -view.view.transform_point3(DVec3::new(x, y, z)).z;
            let pixels = r * least / ((depth + r) * view.c_x().max(view.c_y()));
            assert!(depth - r > 0.2 && pixels > 3.0, "bubbles of {pixels} pixels at {depth}");
        }
        shot
    }

    /// What the pixels show by the twin. The layers are those of the frame; the tests of the
    /// impostors check them.
    pub fn expected(&self, shot: &Shot, drawn: &Drawn) -> Image<Expected> {
        let found = drawn.soap.as_ref().expect("bubble foam");
        let look = twin(shot, self.side, self.past);
        let own = |id: u32| &self.templates[(pcg(id) % self.bubbles.variants) as usize];
        let placed =
            |b: &Bubble| Placed { ball: b.ball, turn: b.turn, id: b.id, template: own(b.id) };
        let blobs: Vec<_> = shot.blobs.iter().map(placed).collect();
        let (eye, rays) = rays(shot);
        let (made, layers) = ((self.films, self.picture), self.bubbles.layers as usize);
        Image::from_fn(rays.width, rays.height, |x, y| {
            let words = &found.layers[y * rays.width + x];
            let (met, most) = words.split_at(layers);
            let met: Vec<_> = met
                .iter()
                .take_while(|word| **word != NONE)
                .map(|word| ((word >> 8) as usize, (word & 0xff) as usize))
                .collect();
            let most = f64::from(f32::from_bits(most[0]));
            let met = Met { blobs: &blobs, first: &met, most };
            let length = rays.at(x, y).length();
            let water = water(shot, drawn, (x, y), length);
            let shown =
                |look: &Look, along: DVec3| pixel(look, made, (eye, along), &met, (&water, TURNED));
            let along = rays.at(x, y).normalize();
            let pixel = shown(&look, along);
            let aside = along.any_orthonormal_vector();
            let below = along.cross(aside);
            let turned = [aside, -aside, below, -below].map(|by| shown(&look, along + TURNED * by));
            let change = [0, 1, 2, 3].map(|c| {
                let off = turned.iter().map(|other| (other.color[c] - pixel.color[c]).abs());
                off.fold(0.0, f64::max)
            });
            // The environment, its prefiltered light and the image have half precision. Each film
            // adds some tens of sums and products.
            let off = [0, 1, 2, 3].map(|c| {
                let value = pixel.color[c];
                let halves = if c < 3 { 3.0 } else { 1.0 };
                pixel.off[c]
                    + 2.0 * change[c]
                    + halves * half_step(value)
                    + 200.0 * U * (1.0 + value)
            });
            let change = change.into_iter().fold(0.0, f64::max);
            Expected { pixel, off, change }
        })
    }
}

/// The water on a pixel's ray; `length` is the ray's length per metre of depth. It begins at the
/// pixel's depth and has the thickness interpolated between the surrounding texels that have water.
pub fn water(shot: &Shot, drawn: &Drawn, (x, y): (usize, usize), length: f64) -> Water {
    let depth = f64::from(drawn.depth.at(x, y));
    if !is_surface(depth) {
        return Water::none();
    }
    let edge = (drawn.depth.width as f64 / drawn.thickness.width as f64).round();
    let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / edge;
    let (mut sum, mut all) = (0.0, 0.0);
    for (x, y, weight) in drawn.thickness.bilinear(at) {
        let there = f64::from(drawn.thickness.clamped(x, y));
        (sum, all) = if there > 0.0 { (sum + weight * there, all + weight) } else { (sum, all) };
    }
    let metres = if all > 0.0 { length * sum / all } else { 0.0 };
    Water { medium: medium(shot), from: length * depth, metres }
}

/// The water's medium as the twin takes it.
fn medium(shot: &Shot) -> Medium {
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    match shot.settings.water.medium {
        whitewater::water::Medium::Physical { absorption, scattering } => {
            let [a, s] = [absorption, scattering].map(vector);
            let share = s / (a + s).max(DVec3::splat(1.0e-9));
            Medium::Physical { extinction: a + s, own: vector(shot.settings.light.ambient) * share }
        }
        whitewater::water::Medium::Turbid { .. } => unreachable!("no shot has one"),
        whitewater::water::Medium::Source { base, falloff } => {
            Medium::Source { base: vector(base), falloff: falloff.map(f64::from) }
        }
    }
}

/// Blobs that overlap.
fn heap(shot: &Shot, random: &mut Random) -> Vec<Bubble> {
    (0..16)
        .map(|id| {
            let at =
                [random.between(-1.2, 1.2), random.between(-1.2, 1.2), random.between(2.6, 4.4)];
            let radius = random.between(0.65, 0.9);
            blob(shot, at, radius, 5 * id + 2, random)
        })
        .collect()
}

/// Statistics of a picture's errors.
#[derive(Default)]
struct Errors {
    sum: f64,
    worst: f64,
    /// Max error as a fraction of its bound.
    part: f64,
    /// Number of pixels beyond their bound.
    beyond: u32,
}

impl Errors {
    fn add(&mut self, found: [f32; 4], expected: [f64; 4], off: [f64; 4]) {
        let mut most = 0.0_f64;
        for c in 0..4 {
            let error = (f64::from(found[c]) - expected[c]).abs();
            self.sum += error / 4.0;
            self.worst = self.worst.max(error);
            most = most.max(error / off[c]);
        }
        self.part = self.part.max(most);
        self.beyond += u32::from(most > 1.0);
    }
}

/// Min number of pixels that show two blobs, three blobs, a wall, a plug.
type Seen = [u32; 4];

#[test]
fn films_walls_cores_and_plugs_are_the_twins() {
    let gpu = Gpu::shared();
    let mut scene = Scene::new(&gpu, DVec3::ZERO);
    let drained = even(380.0).with(|it| it.drainage = 0.35);
    let thin = even(380.0).with(|it| [it.core_opaque_radius, it.core_outer_radius] = [0.1, 0.5]);
    let varied = drained.with(|it| it.variation = 0.35);
    let cores = even(380.0).with(|it| {
        it.reflection = 0.0;
        it.pattern = 0.7;
    });
    let cases: [(_, _, _, Seen); 14] = [
        ("one", false, drained, [0, 0, 3000, 0]),
        ("one-thick", false, thin.with(|it| it.film = 900.0), [0, 0, 3000, 0]),
        ("one-no-walls", false, thin.with(|it| it.walls = false), [0; 4]),
        ("one-dull", false, thin.with(|it| it.reflection = 0.0), [0, 0, 3000, 0]),
        ("heap", true, drained, [1000, 400, 5000, 20]),
        ("heap-thin", true, thin.with(|it| it.drainage = 0.35), [3000, 2000, 5000, 20]),
        (
            "heap-open",
            true,
            thin.with(|it| {
                it.film = 900.0;
                it.fill_holes = false;
            }),
            [3000, 2000, 5000, 0],
        ),
        ("heap-no-walls", true, thin.with(|it| it.walls = false), [3000, 2000, 0, 0]),
        ("heap-bright", true, thin.with(|it| it.reflection = 2.5), [3000, 2000, 5000, 10]),
        ("one-varied", false, varied, [0, 0, 3000, 0]),
        ("heap-varied", true, thin.with(|it| it.variation = 1.0), [3000, 2000, 5000, 10]),
        ("one-pattern", false, cores.with(|it| it.distortion = 0.6), [0, 0, 3000, 0]),
        ("heap-pattern", true, cores.with(|it| it.pattern = 1.0), [1000, 400, 5000, 20]),
        ("heap-default", true, BubbleSettings::default(), [1000, 400, 5000, 5]),
    ];
    let shots = [Lens::Standard, Lens::LeftHanded];
    let mut shots = shots.map(|lens| [false, true].map(|many| scene.shot(lens, many)));
    let (mut all, mut jumps) = (0, 0);
    for (i, (name, many, look, least)) in cases.into_iter().enumerate() {
        let shot = &mut shots[i % 2][usize::from(many)];
        shot.settings.bubbles = look;
        let drawn = scene.rig.draw(shot);
        let expected = scene.expected(shot, &drawn);
        let found = drawn.soap.expect("bubble foam");
        let mut own = Errors::default();
        let (mut covered, mut seen, mut wide) = (0, Seen::default(), 0.0);
        for (color, Expected { pixel, off, change }) in found.color.data.iter().zip(&expected.data)
        {
            if pixel.layers == 0 {
                assert_eq!(*color, [0.0; 4], "{name}: nothing is there");
                continue;
            }
            covered += 1;
            jumps += u32::from(*change > JUMP);
            let shows =
                [pixel.layers > 1, pixel.layers > 2, pixel.walls > 0, pixel.plugged > 1.0 / 64.0];
            for (seen, shows) in seen.iter_mut().zip(shows) {
                *seen += u32::from(shows);
            }
            own.add(*color, pixel.color, *off);
            wide += off.iter().sum::<f64>() / 4.0;
        }
        all += covered;
        wide /= f64::from(covered);
        let [two, three, walls, plugs] = seen;
        println!(
            "{name}: mean error {:.1e}, worst {:.1e}, {:.2} of the bound, which is {wide:.4} in the \
             mean; of {covered} pixels {two} show two blobs, {three} three, {walls} a wall, {plugs} a plug",
            own.sum / f64::from(covered),
            own.worst,
            own.part
        );
        let enough = seen.iter().zip(&least).all(|(seen, least)| seen >= least);
        assert!(enough, "{name}: {seen:?} of {least:?}");
        // The pattern's texels have a contrast that the filter's steps blur.
        let most = if look.pattern > 0.0 { 0.02 } else { 0.005 };
        assert!(
            wide < most * f64::from(look.reflection.max(1.0)),
            "{name}: bounds of {wide} in the mean"
        );
        let colors = expected.map(|e| e.pixel.color);
        let off = |x: usize, y: usize| expected.data[y * expected.width + x].off;
        compare::close_color(&format!("soap-{name}"), &found.color, &colors, off);
    }
    println!("{jumps} of {all} pixels may show another wall by rounding");
    assert!(500 * jumps < all, "{jumps} of {all} pixels may show another wall by rounding");
}

/// The sun lights cores and has a mirror image in films, as much of it as passes the host's scene.
#[test]
fn sunlit_films_and_cores_are_the_twins() {
    let gpu = Gpu::shared();
    let masked = config(extent(112, 96)).with(|it| it.shadow = Some(Shadows::Mask));
    let mut scene = Scene::of(&gpu, DVec3::ZERO, 3, masked);
    let thin = even(380.0).with(|it| [it.core_opaque_radius, it.core_outer_radius] = [0.1, 0.5]);
    // The power errs by some 2^-19 of itself with this exponent, less than half precision.
    let broad = |look: BubbleSettings| look.with(|it| it.shininess = 20.0);
    for (name, lens, many, look) in [
        ("one", Lens::Standard, false, broad(thin)),
        ("heap", Lens::LeftHanded, true, broad(even(380.0))),
        ("heap-cores", Lens::Standard, true, broad(even(380.0).with(|it| it.reflection = 0.0))),
    ] {
        let mut shot = scene.shot(lens, many);
        shot.settings.bubbles = look;
        let toward = shot.camera_view().inverse().transform_vector3(DVec3::new(0.6, 0.3, 0.7));
        let light = &mut shot.settings.light;
        light.direction = toward.as_vec3().to_array();
        (light.color, light.shade) = ([3.0, 2.0, 1.0], [0.5, 1.0, 3.0]);
        let mut before: Option<Image<[f32; 4]>> = None;
        for past in [0.0, 0.5, 1.0] {
            let (_texture, shadow) = light_past(&scene.rig, past);
            (shot.shadow, scene.past) = (Some(shadow), f64::from(past));
            let drawn = scene.rig.draw(&shot);
            let expected = scene.expected(&shot, &drawn);
            let found = drawn.soap.expect("bubble foam").color;
            let colors = expected.map(|e| e.pixel.color);
            let off = |x: usize, y: usize| expected.data[y * expected.width + x].off;
            compare::close_color(&format!("soap-sun-{name}-{past}"), &found, &colors, off);
            if let Some(before) = &before {
                let lighter =
                    found.data.iter().zip(&before.data).filter(|(a, b)| a[0] > b[0] + 0.05);
                let lighter = lighter.count();
                println!("{name}, {past}: {lighter} pixels are lighter");
                assert!(lighter > 500, "{name}, {past}: {lighter} pixels are lighter");
            }
            before = Some(found);
        }
    }
}

/// Both impostors turn a blob's surface alike: lit by the sun alone, they look more alike than one of
/// them does with a sun from the other side.
#[test]
fn both_impostors_are_lit_from_one_side() {
    let gpu = Gpu::shared();
    let lit = |impostor: Impostor, aside: DVec3| {
        let bubbles = BubbleConfig::new(1).with(|it| {
            (it.variants, it.bubbles, it.impostor) = (1, 28, impostor);
            (it.map_size, it.steps) = (impostor.map_size(), impostor.steps());
        });
        let size = extent(112, 96);
        let mut rig = Rig::with_slots(&gpu, &config(size).with(|it| it.bubbles = Some(bubbles)), 1);
        rig.environment(extent(2, 1), &[[0.0, 0.0, 0.0, 1.0]; 2]);
        let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
        shot.blobs = vec![blob(&shot, [0.0, 0.0, 3.0], 1.4, 3, &mut Random(11))];
        // An opaque core without films, whose normals are those of the bubbles.
        shot.settings.bubbles = even(380.0).with(|it| {
            [it.core_opaque_radius, it.core_outer_radius] = [1.9, 2.0];
            (it.reflection, it.roundness) = (0.0, 0.0);
        });
        let to = shot.camera_view().inverse().transform_vector3(aside);
        shot.settings.light.direction = to.normalize().as_vec3().to_array();
        shot.settings.light.shade = [0.0; 3];
        rig.draw(&shot).soap.expect("bubble foam").color
    };
    for aside in [DVec3::new(0.9, 0.1, 0.4), DVec3::new(0.1, 0.9, 0.4)] {
        let across = DVec3::new(-aside.x, -aside.y, aside.z);
        let [own, exact] = [Impostor::Distance, Impostor::Ids].map(|it| lit(it, aside));
        let other = lit(Impostor::Ids, across);
        let apart = |a: &Image<[f32; 4]>, b: &Image<[f32; 4]>| {
            a.data.iter().zip(&b.data).map(|(a, b)| f64::from((a[0] - b[0]).abs())).sum::<f64>()
                / a.data.len() as f64
        };
        let [same, mirrored] = [&exact, &other].map(|it| apart(&own, it));
        println!("{aside}: {same:.4} apart, {mirrored:.4} with the sun on the other side");
        assert!(mirrored > 0.05 && 4.0 * same < mirrored, "{same}, {mirrored}");
    }
}

/// The environment's texels and the cones of small bubbles are wide, so only the mean is compared.
#[test]
fn films_and_cores_show_where_the_light_comes_from() {
    let gpu = Gpu::shared();
    let mut scene = Scene::new(&gpu, DVec3::new(0.3, 0.4, -0.5));
    let films = even(380.0).with(|it| {
        it.albedo = [0.0; 3];
        [it.core_opaque_radius, it.core_outer_radius] = [0.1, 0.5];
    });
    let cores = even(380.0).with(|it| {
        it.reflection = 0.0;
        it.roundness = 0.7;
    });
    let lean = cores.with(|it| {
        it.pattern = 1.0;
        it.roundness = 0.2;
    });
    for (name, lens, many, look, part) in [
        ("films", Lens::Standard, false, films, 64.0),
        ("cores", Lens::LeftHanded, false, cores, 400.0),
        ("heap-films", Lens::LeftHanded, true, films, 64.0),
        ("heap-cores", Lens::Standard, true, cores, 400.0),
        ("leaning cores", Lens::Standard, false, lean, 400.0),
    ] {
        let mut shot = scene.shot(lens, many);
        shot.settings.bubbles = look;
        let drawn = scene.rig.draw(&shot);
        let expected = scene.expected(&shot, &drawn);
        let found = drawn.soap.expect("bubble foam");
        let (mut errors, mut covered, mut light) = (Errors::default(), 0, 0.0);
        for (color, Expected { pixel, off, .. }) in found.color.data.iter().zip(&expected.data) {
            if pixel.layers > 0 {
                covered += 1;
                light += pixel.color.iter().sum::<f64>() / 4.0;
                errors.add(*color, pixel.color, *off);
            }
        }
        let [mean, light] = [errors.sum, light].map(|sum| sum / f64::from(covered));
        println!("{name}: mean error {mean:.1e} of {light:.2}, worst {:.1e}", errors.worst);
        assert!(covered > 4000 && mean < light / part, "{name}: {mean} of {light}");
    }
}
