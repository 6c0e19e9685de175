//! Whitewater foam near the camera becomes blobs of soap bubbles.

use glam::{DVec3, Vec3, Vec4};
use whitewater::WhitewaterConfig;
use whitewater::bubbles::{BubbleConfig, Crossfade};
use whitewater::headless::{Bubble, Whitewater};
use whitewater::{Config, Error, LightVolume};

use crate::reference::classify::pcg;
use crate::reference::is_surface;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, Lens, Random};
use crate::support::tolerance::U;

const FOAM: u32 = 0;
const RINGS: f64 = 1024.0;

/// Whitewater particles.
#[derive(Clone)]
struct Cloud {
    shot: Shot,
    positions: Vec<[f32; 3]>,
    kinds: Vec<u32>,
    ages: Vec<f32>,
    ids: Vec<u32>,
}

/// Radius of all particles, before it is divided by a number from the id.
const RADIUS: f32 = 0.3;

impl Cloud {
    /// `count` particles, whose index gives the eye depth.
    fn new(count: usize, depth: impl Fn(usize) -> f32) -> Self {
        let mut shot = Shot::new(extent(96, 80), Lens::ReversedInfinite, 0.1, &[]);
        let center = scenes::world(&shot.camera, &[[0.0, 0.0, 3.0]])[0];
        shot.light_volume = Some(LightVolume { center, radius: 4.0 });
        shot.settings.whitewater.radius = RADIUS;
        // Keeps blobs that are small on the screen, whose merging another test checks.
        shot.settings.bubbles.min_pixels = 0.0;
        shot.settings.bubbles.crossfade = Crossfade { near: 2.0, far: 3.0, size: 1.25 };
        let mut random = Random(6);
        let place = |i| {
            let z = depth(i);
            [z * random.between(-0.4, 0.4), z * random.between(-0.3, 0.3), z]
        };
        let eye: Vec<[f32; 3]> = (0..count).map(place).collect();
        let ages = (0..count).map(|i| [0.0, 0.5, -0.1, 0.9][i % 4]).collect();
        Self {
            positions: scenes::world(&shot.camera, &eye),
            kinds: vec![FOAM; count],
            ages,
            ids: (0..count as u32).map(|i| 7 * i + 3).collect(),
            shot,
        }
    }

    fn input(&self) -> Whitewater<'_> {
        Whitewater {
            positions: &self.positions,
            kinds: Some(&self.kinds),
            radii: None,
            ages: Some(&self.ages),
            ids: Some(&self.ids),
        }
    }

    fn draw(&self, rig: &mut Rig<'_>) -> Drawn {
        let fluid = rig.particles(&self.shot);
        let cloud = rig.whitewater(&self.input());
        rig.draw_whitewater(&self.shot, &fluid.particles(), Some(cloud.particles()))
    }

    fn distance(&self, i: usize) -> f64 {
        let view = self.shot.view(self.shot.size).view;
        view.transform_point3(DVec3::from(self.positions[i].map(f64::from))).length()
    }

    /// Fraction of a particle that is drawn as a blob, if there is room.
    fn part(&self, i: usize) -> f64 {
        let Crossfade { near, far, .. } = self.shot.settings.bubbles.crossfade;
        let [near, far] = [near, far].map(f64::from);
        let t = ((self.distance(i) - near) / (far - near)).clamp(0.0, 1.0);
        if self.kinds[i] == FOAM { 1.0 - t * t * (3.0 - 2.0 * t) } else { 0.0 }
    }

    /// The blobs that the particles become.
    fn blobs(&self) -> Vec<Bubble> {
        self.blobs_of(RADIUS)
    }

    /// The blobs that particles of this radius become.
    fn blobs_of(&self, radius: f32) -> Vec<Bubble> {
        let size = f64::from(self.shot.settings.bubbles.crossfade.size);
        (0..self.positions.len())
            .filter(|i| self.part(*i) > 0.0)
            .map(|i| {
                let life = (1.0 - f64::from(self.ages[i].max(0.0)).powi(2)).powf(0.4);
                let own = f64::from(radius) / f64::from(self.ids[i] % 5 + 1);
                let radius = size * own * life * self.part(i).sqrt();
                let ball = Vec3::from(self.positions[i]).extend(radius as f32).to_array();
                Bubble { ball, turn: turn(self.ids[i]), id: self.ids[i] }
            })
            .collect()
    }
}

/// The orientation by the formula of near.comp.
fn turn(id: u32) -> [f32; 4] {
    let uniform = |n: u32| {
        let hash = pcg(id.wrapping_add(pcg(n.wrapping_add(pcg(1)))));
        (hash >> 8) as f32 / 16_777_216.0 - 0.5
    };
    Vec4::new(uniform(0), uniform(1), uniform(2), uniform(3)).normalize().to_array()
}

fn bubbles(max_blobs: u32) -> BubbleConfig {
    BubbleConfig::new(max_blobs).with(|it| {
        it.variants = 2;
        it.bubbles = 32;
        it.map_size = 64;
    })
}

fn with(cloud: &Cloud, bubbles: BubbleConfig) -> Config {
    let most = cloud.positions.len() as u32;
    config(cloud.shot.size).with(|it| {
        it.whitewater = Some(WhitewaterConfig::new(most));
        it.bubbles = Some(bubbles);
        it.light_map_size = Some(32);
    })
}

/// Number of pixels that differ by more than rounding explains.
fn off(a: &Drawn, b: &Drawn) -> usize {
    let apart =
        |(a, b): (&[f32; 4], &[f32; 4])| (0..3).any(|c| (a[c] - b[c]).abs() > 0.01 * (1.0 + a[c]));
    a.output.data.iter().zip(&b.output.data).filter(|pair| apart(*pair)).count()
}

/// A name, and a function from a particle's index to its eye depth.
type Depths = (&'static str, fn(usize) -> f32);

/// Near foam is drawn as blobs, like blobs from the host; far foam as sprites; between the two
/// distances both are drawn, reduced.
#[test]
fn foam_near_the_eye_is_blobs() {
    let gpu = Gpu::shared();
    let depths: [Depths; 2] = [
        ("apart", |i| if i % 2 == 0 { 1.3 + 0.005 * i as f32 } else { 3.8 + 0.05 * i as f32 }),
        ("between", |i| 2.1 + 0.02 * i as f32),
    ];
    for (name, depth) in depths {
        let mut cloud = Cloud::new(40, depth);
        // Particles of other kinds stay sprites, also near the camera.
        for i in (0..40).step_by(10) {
            cloud.kinds[i] = 1 + i as u32 / 10 % 2;
        }
        let over = bubbles(64).with(|it| it.crossfade = true);
        let found = cloud.draw(&mut Rig::lit(&gpu, &with(&cloud, over), 1));
        let soap = found.soap.as_ref().expect("bubble foam");
        let mut other = cloud.clone();
        other.shot.blobs = cloud.blobs();
        let seen = soap.range[2] as usize;
        assert!(seen > 10 && seen <= other.shot.blobs.len(), "{name}: {seen} blobs");
        // A particle drawn as a whole blob has no sprite. Here a max age hides these sprites.
        for i in 0..40 {
            if cloud.part(i) == 1.0 {
                other.ages[i] = 1.0;
            }
        }
        let expected = other.draw(&mut Rig::lit(&gpu, &with(&cloud, bubbles(64)), 1));
        let theirs = expected.soap.as_ref().expect("bubble foam");
        let mut edges = 0;
        for (a, b) in soap.depth.data.iter().zip(&theirs.depth.data) {
            let both = is_surface((*a).into()) && is_surface((*b).into());
            edges += usize::from(if both { (a - b).abs() > 0.002 } else { a != b });
        }
        let all = soap.depth.data.iter().filter(|z| is_surface((**z).into())).count();
        println!(
            "{name}: {seen} blobs on {all} pixels, {edges} of other depth, {} off",
            off(&found, &expected)
        );
        assert!(all > 300 && edges * 100 < all, "{name}: {edges} of {all} pixels have other blobs");
        if name == "apart" {
            assert!(off(&found, &expected) * 100 < all, "{name}");
            let plain = cloud.draw(&mut Rig::lit(&gpu, &with(&cloud, bubbles(64)), 1));
            assert!(off(&found, &plain) > all / 2, "{name}: sprites do not look so");
        } else {
            // Where both are drawn, each sprite has the rest of its thickness.
            let thickness =
                |drawn: &Drawn| drawn.whitewater.as_ref().expect("foam").thickness.clone();
            let mut rig = Rig::lit(&gpu, &with(&cloud, bubbles(64)), 1);
            let mut sum = vec![0.0; found.output.data.len()];
            let mut thinner = 0;
            for i in 0..40 {
                let mut one = other.clone();
                one.ages.fill(1.0);
                one.ages[i] = other.ages[i];
                let whole = thickness(&one.draw(&mut rig));
                for (sum, whole) in sum.iter_mut().zip(&whole.data) {
                    let left = (1.0 - cloud.part(i)) * f64::from(whole[0]);
                    thinner += usize::from(f64::from(whole[0]) - left > 0.1);
                    *sum += left;
                }
            }
            assert!(thinner > 300, "{thinner} contributions are less than whole");
            for (i, (found, sum)) in thickness(&found).data.iter().zip(&sum).enumerate() {
                // Both are sums of up to 40 multiples of 2^-16, and a fade errs by some ten
                // roundings of the distance.
                let off = 80.0 / 65_536.0 + 32.0 * U * sum;
                assert!((f64::from(found[0]) - sum).abs() < off, "{i}: {}, not {sum}", found[0]);
            }
        }
    }
}

/// If there are more candidates than `max_blobs`, the nearest become blobs and the others stay
/// sprites, whatever their order.
#[test]
fn where_blobs_have_no_room_sprites_stay() {
    let gpu = Gpu::shared();
    let mut cloud = Cloud::new(120, |i| 1.2 + 0.014 * i as f32);
    cloud.ages.fill(0.0);
    let over = bubbles(30).with(|it| it.crossfade = true);
    let mut rig = Rig::lit(&gpu, &with(&cloud, over), 1);
    let one = cloud.draw(&mut rig);
    let far = f64::from(cloud.shot.settings.bubbles.crossfade.far);
    let mut rings: Vec<_> = (0..120).map(|i| (cloud.distance(i) / far * RINGS) as u32).collect();
    rings.sort_unstable();
    let ends = rings[30];
    let expected = rings.iter().filter(|ring| **ring < ends).count() as u32;
    let [_, _, seen, dropped, _] = one.soap.as_ref().expect("bubble foam").range;
    // The selection is by distance rings. The last selected blobs may be too small to be drawn.
    assert_eq!(dropped, 0);
    assert!(seen <= expected && seen + 2 >= expected, "{seen} of {expected} blobs");
    let mut other = cloud.clone();
    for (to, from) in Random(1).order(120).into_iter().enumerate() {
        other.positions[to] = cloud.positions[from];
        other.ids[to] = cloud.ids[from];
    }
    let again = other.draw(&mut rig);
    compare::same_color("near-order", &again.output, &one.output);
    // Sprites of particles that are no blobs are as thick as in a renderer without blobs: equal
    // wherever there is no sprite of the others.
    let mut rig_plain = Rig::lit(&gpu, &with(&cloud, bubbles(30)), 1);
    let plain = cloud.draw(&mut rig_plain);
    let mut nearer = cloud.clone();
    for i in 0..120 {
        if (cloud.distance(i) / far * RINGS) as u32 > ends {
            nearer.ages[i] = 1.0;
        }
    }
    let nearer = nearer.draw(&mut rig_plain);
    let mut alone = 0;
    for i in 0..one.output.data.len() {
        let [one, plain, nearer] = [&one, &plain, &nearer]
            .map(|drawn| drawn.whitewater.as_ref().expect("foam").thickness.data[i][0]);
        if plain > 0.0 && nearer == 0.0 {
            alone += 1;
            assert_eq!(one, plain, "pixel {i}");
        }
    }
    println!("{alone} pixels show none of the nearest");
    assert!(alone > 100, "{alone} pixels");
    // All particles are too old.
    cloud.ages.fill(1.0);
    let none = cloud.draw(&mut rig);
    assert_eq!(none.output.data, cloud.shot.color);
}

/// Foam so near to the end of the cross-fade that nothing of it is a blob yet is not counted as
/// invalid blobs.
#[test]
fn foam_that_is_no_blob_yet_is_not_invalid() {
    let gpu = Gpu::shared();
    let mut cloud = Cloud::new(6, |_| 2.0);
    // A smooth step rounds to 1 at less than 8e-5 before its end.
    let eye: Vec<_> = (1..=6).map(|i| [0.0, 0.0, 3.0 - 1.0e-5 * i as f32]).collect();
    cloud.positions = scenes::world(&cloud.shot.camera, &eye);
    let over = bubbles(8).with(|it| it.crossfade = true);
    let drawn = cloud.draw(&mut Rig::lit(&gpu, &with(&cloud, over), 1));
    let [_, _, seen, dropped, _] = drawn.soap.as_ref().expect("bubble foam").range;
    assert!(seen < 6, "all of them are blobs");
    assert_eq!(dropped, 0);
}

/// A dense patch of foam around `from` in eye space, and a sun that casts its shadow on a wall.
/// Returns also the patch's mean distance.
fn shading(from: [f32; 3]) -> (Cloud, f64) {
    const WALL: f64 = 5.0;
    let mut cloud = Cloud::new(0, |_| 0.0);
    let mut random = Random(8);
    let mut eye = Vec::new();
    while eye.len() < 60 {
        let [x, y] = [0, 1].map(|_| random.between(-1.0, 1.0));
        if x * x + y * y < 1.0 {
            eye.push([from[0] + 0.6 * x, from[1] + 0.6 * y, from[2] + random.between(-0.1, 0.1)]);
        }
    }
    let shot = &mut cloud.shot;
    shot.scene_depth(|_, _| Some(WALL));
    let to = [0.9, 0.0, WALL as f32];
    let [at, there] = [from, to].map(|p| Vec3::from(scenes::world(&shot.camera, &[p])[0]));
    shot.settings.light.direction = (at - there).normalize().to_array();
    shot.settings.light.irradiance = [2.0; 3];
    shot.settings.light.shade = [0.0; 3];
    shot.settings.whitewater.radius = 0.15;
    // Sprites are less opaque than blobs, so their shadows differ.
    shot.settings.whitewater.half_intensity_thickness *= 2.0;
    shot.light_volume = Some(LightVolume { center: there.to_array(), radius: 5.0 });
    cloud.positions = scenes::world(&shot.camera, &eye);
    cloud.kinds = vec![FOAM; eye.len()];
    cloud.ages = vec![0.0; eye.len()];
    // With these ids all particles have the same radius.
    cloud.ids = (0..eye.len() as u32).map(|i| 5 * i).collect();
    let away = (0..eye.len()).map(|i| cloud.distance(i)).sum::<f64>() / eye.len() as f64;
    (cloud, away)
}

/// Mean fraction of light left on the wall, over pixels that show no foam and are dark in at least
/// one of the pictures.
fn left(drawn: &[Drawn], lit: &Drawn) -> Vec<f64> {
    let share = |drawn: &Drawn, i: usize| {
        f64::from(drawn.output.data[i][0]) / f64::from(lit.output.data[i][0])
    };
    let beside = |i: &usize| {
        drawn.iter().all(|drawn| {
            let (soap, foam) = (drawn.soap.as_ref(), drawn.whitewater.as_ref());
            soap.is_none_or(|soap| soap.color.data[*i][3] == 0.0)
                && foam.is_none_or(|foam| foam.thickness.data[*i][0] == 0.0)
        })
    };
    let dim = |i: &usize| drawn.iter().any(|drawn| share(drawn, *i) < 0.6);
    let dark: Vec<_> = (0..lit.output.data.len()).filter(beside).filter(dim).collect();
    assert!(dark.len() > 60, "{} pixels in the shade", dark.len());
    let mean = |drawn| dark.iter().map(|i| share(drawn, *i)).sum::<f64>() / dark.len() as f64;
    drawn.iter().map(mean).collect()
}

/// Foam drawn as blobs has the blobs' shadow, and while it fades a shadow between that and the
/// sprites'. A particle does not cast both shadows, neither on the wall nor on itself.
#[test]
fn foam_that_is_handed_over_casts_one_shadow() {
    let gpu = Gpu::shared();
    let (mut cloud, away) = shading([-0.9, 0.0, 3.0]);
    let config = |crossfade| {
        let own = with(&cloud, bubbles(256).with(|it| it.crossfade = crossfade));
        own.with(|it| it.light_map_size = Some(128))
    };
    let [mut over_rig, mut rig] =
        [true, false].map(|crossfade| Rig::lit(&gpu, &config(crossfade), 1));
    let mut none = cloud.clone();
    none.ages.fill(1.0);
    let lit = none.draw(&mut rig);
    let sprites = cloud.draw(&mut rig);
    let mut over = |near: f64, far: f64| {
        let crossfade = Crossfade { near: near as f32, far: far as f32, size: 1.0 };
        cloud.shot.settings.bubbles.crossfade = crossfade;
        cloud.draw(&mut over_rig)
    };
    let handed = over(2.0 * away, 3.0 * away);
    let half = over(0.5 * away, 1.5 * away);
    none.shot.settings.bubbles.crossfade =
        Crossfade { near: 2.0 * away as f32, far: 3.0 * away as f32, size: 1.0 };
    none.shot.blobs = Cloud { ages: vec![0.0; cloud.ages.len()], ..none.clone() }.blobs_of(0.15);
    let blobs = none.draw(&mut rig);
    let all = [sprites, blobs, handed, half];
    let [sprites, blobs, handed, half] = left(&all, &lit)[..] else { unreachable!() };
    println!("sprites {sprites:.4}, blobs {blobs:.4}, handed over {handed:.4}, half-way {half:.4}");
    assert!(sprites > blobs + 0.1, "they differ");
    // Two divisions and one or two roundings to half precision in the map.
    assert!((handed - blobs).abs() < 1.0e-3, "{handed}, of blobs alone {blobs}");
    assert!((blobs..sprites).contains(&half), "{half} is not between {blobs} and {sprites}");
    // The sprites' shadow must not fall on their own blobs.
    let light = |drawn: &Drawn| {
        let soap = drawn.soap.as_ref().expect("bubble foam");
        soap.color.data.iter().map(|c| f64::from(c[0])).sum::<f64>()
    };
    let [alone, both] = [&all[1], &all[2]].map(light);
    println!("light of blobs: {alone:.1} alone, {both:.1} handed over");
    assert!((both - alone).abs() < 0.01 * alone, "{both} and {alone}");
}

/// Foam beside the view is not drawn as blobs, and still casts its sprites' shadow into the view.
#[test]
fn foam_beside_the_view_casts_the_shadow_of_sprites() {
    let gpu = Gpu::shared();
    let (mut cloud, away) = shading([-3.6, 0.0, 2.6]);
    let [handed, sprites] = [true, false].map(|crossfade| {
        let own = with(&cloud, bubbles(256).with(|it| it.crossfade = crossfade));
        let mut rig = Rig::lit(&gpu, &own.with(|it| it.light_map_size = Some(128)), 1);
        let crossfade = Crossfade { near: 2.0 * away as f32, far: 3.0 * away as f32, size: 1.0 };
        cloud.shot.settings.bubbles.crossfade = crossfade;
        cloud.draw(&mut rig)
    });
    let mut none = cloud.clone();
    none.ages.fill(1.0);
    let own = with(&none, bubbles(256));
    let lit = none.draw(&mut Rig::lit(&gpu, &own.with(|it| it.light_map_size = Some(128)), 1));
    assert_eq!(handed.soap.as_ref().expect("bubble foam").range[2], 0, "none is on the screen");
    let all = [sprites, handed];
    let shares = left(&all, &lit);
    println!("sprites {:.4}, handed over {:.4}", shares[0], shares[1]);
    compare::same_color("near-beside", &all[1].output, &all[0].output);
}

/// 36 bytes per blob, and some KiB.
#[test]
fn it_takes_the_memory_it_says() {
    let gpu = Gpu::shared();
    let cloud = Cloud::new(4, |_| 2.0);
    let [with_it, without] = [true, false].map(|crossfade| {
        let bubbles = bubbles(1 << 18).with(|it| it.crossfade = crossfade);
        let mut rig = Rig::with_slots(&gpu, &with(&cloud, bubbles), 1);
        rig.renderer().memory().buffers
    });
    let more = with_it - without;
    assert!((36 << 18..(36 << 18) + (16 << 10)).contains(&more), "{more} bytes");
}

#[test]
fn bad_crossfades_are_errors() {
    let gpu = Gpu::shared();
    let cloud = Cloud::new(4, |_| 2.0);
    let over = bubbles(8).with(|it| it.crossfade = true);
    let without = with(&cloud, over).with(|it| it.whitewater = None);
    assert!(matches!(
        Rig::try_new(&gpu, &without, 1),
        Err(Error::BadInput { field: "Config.bubbles.crossfade", .. })
    ));
    let mut rig = Rig::lit(&gpu, &with(&cloud, over), 1);
    let (color, depth) = rig.scene(&cloud.shot);
    let fluid = rig.particles(&cloud.shot);
    let blobs = rig.blobs(&cloud.shot);
    let frame = cloud.shot.frame(color.host_image(), depth.host_image(), fluid.particles());
    let bad = frame.with(|it| it.bubbles = Some(blobs.streams()));
    let cmd = rig.stub.begin(0);
    // SAFETY: a frame with bad input uses no handle.
    let result = unsafe { rig.renderer().record(cmd, &bad) };
    assert!(matches!(result, Err(Error::BadInput { field: "Frame.bubbles", .. })));
    for (field, crossfade) in [
        ("Settings.bubbles.crossfade.far", Crossfade { near: 2.0, far: 2.0, size: 1.0 }),
        ("Settings.bubbles.crossfade.near", Crossfade { near: -1.0, far: 2.0, size: 1.0 }),
        ("Settings.bubbles.crossfade.size", Crossfade { near: 1.0, far: 2.0, size: f32::NAN }),
    ] {
        let mut settings = cloud.shot.settings.clone();
        settings.bubbles = settings.bubbles.with(|it| it.crossfade = crossfade);
        // SAFETY: as above.
        let result =
            unsafe { rig.renderer().record(cmd, &frame.with(|it| it.settings = &settings)) };
        assert!(matches!(result, Err(Error::BadInput { field: found, .. }) if found == field));
    }
    rig.stub.end(0);
    rig.stub.wait(0);
}
