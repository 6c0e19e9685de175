//! Blobs of bubble foam: from a file, and built-in scenes.

use std::path::{Path, PathBuf};

use glam::{Quat, Vec3};
use serde::Deserialize;
use whitewater::bubbles::{BlobSimulationSettings, DistanceField, Solid};
use whitewater::headless::Bubble;
use whitewater::headless::scene::{Material, Mesh, Scene};
use whitewater::io::particles::sequence;
use whitewater::{LightVolume, Settings};

use crate::args::RenderArgs;
use crate::bounds::Bounds;
use crate::camera::CameraFile;
use crate::failure::{Failure, Outcome};
use crate::output;
use crate::session::{self, Look, Session};
use crate::settings::SettingsFile;
use crate::stage;

/// Frames per second of the built-in scenes.
pub const FPS: f32 = 60.0;

/// Source of the blobs.
#[derive(Clone, Debug, PartialEq)]
pub enum Which {
    /// One blob close up.
    One,
    /// This number of blobs, sliding down a slope.
    Slope(u32),
    /// This number of blobs, filling a box.
    Box(u32),
    /// A file.
    File(PathBuf),
}

impl Which {
    /// The name on the command line.
    pub fn name(&self) -> String {
        match self {
            Self::One => "one".into(),
            Self::Slope(count) => format!("slope:{count}"),
            Self::Box(count) => format!("box:{count}"),
            Self::File(path) => path.display().to_string(),
        }
    }
}

/// Parses a name from the command line.
pub fn named(text: &str) -> Result<Which, String> {
    let (name, count) = match text.split_once(':') {
        Some((name, count)) if matches!(name, "slope" | "box") => (name, Some(count)),
        _ => (text, None),
    };
    let many = |otherwise: u32| match count {
        None => Ok(otherwise),
        Some(count) => {
            let count = count.parse().ok().filter(|n| (1..=1_000_000).contains(n));
            count.ok_or_else(|| format!("{name}: expected 1 to 1000000 blobs, as in {name}:100"))
        }
    };
    match name {
        "one" => Ok(Which::One),
        "slope" => many(1000).map(Which::Slope),
        "box" => many(5000).map(Which::Box),
        _ if text.is_empty() => Err("expected one, slope, box or a file".into()),
        _ => Ok(Which::File(text.into())),
    }
}

/// Contents of a blob file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BlobFile {
    blobs: Vec<BlobEntry>,
    /// Whether the blobs fall, from frame 0 on.
    #[serde(default)]
    moves: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BlobEntry {
    center: [f32; 3],
    radius: f32,
    #[serde(default = "unturned")]
    turn: [f32; 4],
    id: Option<u32>,
}

fn unturned() -> [f32; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

/// Reads `{"blobs":[{"center":[x,y,z],"radius":r,"turn":[x,y,z,w],"id":n},...],"moves":true}`;
/// turn, id and moves are optional. Also returns whether the blobs move.
pub fn read(path: &Path) -> Outcome<(Vec<Bubble>, bool)> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::reading(path, &error))?;
    let bad = |why: String| Failure::input(format!("{}: {why}", path.display()));
    let file: BlobFile = serde_json::from_str(&text).map_err(|error| {
        bad(format!(
            "{error}; expected {{\"blobs\":[{{\"center\":[x,y,z],\"radius\":r,\"turn\":[x,y,z,w],\"id\":n}},...]}}, turn and \
             id may be left out, and \"moves\":true added"
        ))
    })?;
    let one = |(i, entry): (usize, BlobEntry)| {
        let BlobEntry { center: [x, y, z], radius, turn, id } = entry;
        let good = [x, y, z].iter().chain(&turn).all(|v| v.is_finite());
        if !good || !radius.is_finite() || radius <= 0.0 {
            return Err(bad(format!("blob {i}: finite numbers and a radius above 0 expected")));
        }
        Ok(Bubble { ball: [x, y, z, radius], turn, id: id.unwrap_or(i as u32) })
    };
    let blobs = file.blobs.into_iter().enumerate().map(one).collect::<Outcome<_>>()?;
    Ok((blobs, file.moves))
}

/// Blobs of a frame, and how they move.
pub struct Blobs {
    pub blobs: Vec<Bubble>,
    pub motion: Option<Motion>,
}

/// Physics of the blobs: settings, obstacles, and the maximum number of successive splits.
pub struct Motion {
    pub settings: BlobSimulationSettings,
    pub solids: Vec<Solid>,
    pub field: Option<DistanceField>,
    pub max_splits: u32,
}

impl Motion {
    /// Motion on the scene's ground, with its meshes as obstacles.
    fn on(scene: &Scene, largest: f32) -> Outcome<Self> {
        let ground = scene.ground.as_ref().map(|ground| ground.y);
        let floor = |distance| Solid::Plane { normal: [0.0, 1.0, 0.0], distance };
        Ok(Self {
            settings: BlobSimulationSettings::default(),
            solids: ground.into_iter().map(floor).collect(),
            field: field_of(scene, largest)?,
            max_splits: HALVINGS,
        })
    }
}

/// Max number of times that a torn-off piece is halved: three halvings give eight pieces of half
/// the radius.
const HALVINGS: u32 = 3;

/// Max number of grid points of the distance field along an edge.
const FIELD: f32 = 64.0;

/// Distance field of a scene's meshes; `None` without meshes.
fn field_of(scene: &Scene, largest: f32) -> Outcome<Option<DistanceField>> {
    let triangles: Vec<[[f32; 3]; 3]> = scene
        .meshes
        .iter()
        .flat_map(|mesh| {
            let at = |i: u32| {
                let place = Vec3::from(mesh.positions[i as usize]);
                mesh.transform.transform_point3(place).to_array()
            };
            mesh.indices.chunks_exact(3).map(move |three| [0, 1, 2].map(|k| at(three[k])))
        })
        .collect();
    if triangles.is_empty() {
        return Ok(None);
    }
    let corners = || triangles.iter().flatten().map(|c| Vec3::from(*c));
    let size = corners().fold(Vec3::MIN, Vec3::max) - corners().fold(Vec3::MAX, Vec3::min);
    let edge = ((size.max_element() + 2.0 * largest) / FIELD).max(0.25 * largest);
    let field = DistanceField::of_mesh(&triangles, edge, largest + edge);
    field.map(Some).map_err(|error| Failure::input(format!("--scene: {error}")))
}

/// Uniform numbers (PCG, O'Neill 2014): the same in every run.
pub struct Random(pub u64);

impl Random {
    /// A number in [0, 1).
    pub fn next(&mut self) -> f32 {
        let old = self.0;
        self.0 =
            old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let word = (((old >> 18) ^ old) >> 27) as u32;
        let bits = word.rotate_right((old >> 59) as u32);
        (bits >> 8) as f32 / (1 << 24) as f32
    }

    /// A rotation, uniformly distributed (Shoemake 1992).
    fn turn(&mut self) -> [f32; 4] {
        let [a, b, c] = [self.next(), self.next(), self.next()];
        let (near, far) = ((1.0 - a).sqrt(), a.sqrt());
        let [b, c] = [b, c].map(|part| std::f32::consts::TAU * part);
        Quat::from_xyzw(near * b.sin(), near * b.cos(), far * c.sin(), far * c.cos())
            .normalize()
            .to_array()
    }
}

/// What is drawn: blobs, the scene around them, and the camera.
pub struct Set {
    pub blobs: Blobs,
    pub scene: Scene,
    /// Bounds of what casts and receives shadows.
    pub lit: Bounds,
    pub eye: [f32; 3],
    pub target: [f32; 3],
}

/// Concrete, or a plain material if there is none.
fn concrete() -> Material {
    Material::named("concrete").unwrap_or_default()
}

/// A built-in scene, or that of a file.
pub fn set(which: &Which) -> Outcome<Set> {
    let mut random = Random(1);
    let mut blob = |at: Vec3, radius: f32, id: u32| Bubble {
        ball: at.extend(radius).to_array(),
        turn: random.turn(),
        id,
    };
    let still = |blobs| Blobs { blobs, motion: None };
    Ok(match which {
        Which::One => {
            let blobs = still(vec![blob(Vec3::new(0.0, 0.97, 0.0), 1.0, 0)]);
            let scene = on_ground(&blobs.blobs);
            Set {
                lit: bounds_of(&blobs.blobs),
                blobs,
                scene,
                eye: [1.1, 1.75, 2.9],
                target: [0.0, 0.93, 0.0],
            }
        }
        Which::Box(count) => {
            let row = f64::from(*count).cbrt().ceil() as u32;
            let cell = 2.0 / (f64::from(*count).cbrt() as f32);
            let mut jitter = Random(7);
            let at = |i: u32| {
                let place = [i % row, i / (row * row), i / row % row].map(|n| n as f32 + 0.5);
                let off = [0, 1, 2].map(|_| 0.5 * (jitter.next() - 0.5));
                Vec3::from(place) + Vec3::from(off)
            };
            let blobs: Vec<Bubble> = (0..*count)
                .map(at)
                .enumerate()
                .map(|(i, at)| {
                    let middle = Vec3::new(0.5 * row as f32, -0.2, 0.5 * row as f32);
                    blob(cell * (at - middle), 0.85 * cell, i as u32)
                })
                .collect();
            let blobs = still(blobs);
            let scene = on_ground(&blobs.blobs);
            Set {
                lit: bounds_of(&blobs.blobs),
                blobs,
                scene,
                eye: [2.9, 2.9, 3.6],
                target: [0.0, 0.95, 0.0],
            }
        }
        Which::Slope(count) => slope(*count, &mut blob),
        Which::File(path) => {
            let (all, moves) = read(path)?;
            let scene = on_ground(&all);
            // The sheet under the slope is no obstacle.
            let ground = Scene { meshes: Vec::new(), ..scene.clone() };
            let motion = moves.then(|| Motion::on(&ground, largest(&all))).transpose()?;
            let blobs = Blobs { blobs: all, motion };
            let bounds = bounds_of(&blobs.blobs);
            let away = 1.6 * bounds.size().max_element().max(1.0e-3);
            let target = bounds.center();
            let eye = target + away * Vec3::new(0.5, 0.45, 0.85);
            Set { blobs, scene, lit: bounds, eye: eye.to_array(), target: target.to_array() }
        }
    })
}

/// A ramp between walls, and foam on top of it.
fn slope(count: u32, blob: &mut impl FnMut(Vec3, f32, u32) -> Bubble) -> Set {
    let steep = 27.0_f32.to_radians();
    let turn = Quat::from_rotation_z(-steep);
    // Its upper face goes down to the ground at x = 1.
    let (length, wide, thick) = (2.6, 1.0, 0.05);
    let middle = Vec3::new(1.0, 0.0, 0.0) + turn * Vec3::new(-0.5 * length, -thick, 0.0);
    let ramp = (middle, Vec3::new(0.5 * length, thick, 0.5 * wide));
    let wall = |side: f32| {
        let at = middle + turn * Vec3::new(0.0, 0.1, side * (0.5 * wide + 0.03));
        (at, Vec3::new(0.5 * length, 0.18, 0.03))
    };
    let boxes = [ramp, wall(-1.0), wall(1.0)];
    let material = concrete();
    let meshes = boxes.iter().map(|(at, half)| {
        Mesh::cuboid(at.to_array(), half.to_array(), turn.to_array(), material.clone())
    });
    // The blobs lie in layers on the upper half of the ramp, to a height of about two thirds of its width.
    let radius = 0.062 * (1000.0 / count as f32).cbrt();
    let apart = 1.45 * radius;
    let across = ((wide - 2.0 * radius) / apart).floor().max(1.0) as u32 + 1;
    let along = ((0.5 * length) / apart).floor().max(1.0) as u32;
    let mut jitter = Random(3);
    let blobs = (0..count)
        .map(|i| {
            let (x, z, y) = (i / across % along, i % across, i / (across * along));
            let off = [0, 1, 2].map(|_| 0.2 * apart * (jitter.next() - 0.5));
            let place = Vec3::new(
                -length + radius + apart * x as f32,
                radius + apart * y as f32,
                apart * (z as f32 - 0.5 * (across - 1) as f32),
            );
            // Many small blobs and few large ones; of one size they would look like balls.
            let size = radius * (0.6 + 0.7 * jitter.next().powi(2));
            blob(Vec3::new(1.0, 0.0, 0.0) + turn * (place + Vec3::from(off)), size, i)
        })
        .collect();
    let solids = boxes.iter().map(|(at, half)| Solid::Box {
        center: at.to_array(),
        half_extents: half.to_array(),
        rotation: turn.to_array(),
    });
    let floor = Solid::Plane { normal: [0.0, 1.0, 0.0], distance: 0.0 };
    let solids = solids.chain([floor]).collect();
    let settings = BlobSimulationSettings::default().with(|it| it.friction = 0.25);
    let low = Bounds { min: Vec3::new(-1.5, 0.0, -0.6), max: Vec3::new(2.2, 1.6, 0.6) };
    let mut scene = stage::paving_under(&low);
    scene.meshes.extend(meshes);
    Set {
        blobs: Blobs {
            blobs,
            motion: Some(Motion { settings, solids, field: None, max_splits: HALVINGS }),
        },
        scene,
        lit: low,
        eye: [2.7, 1.7, 2.9],
        target: [0.35, 0.35, 0.0],
    }
}

fn largest(blobs: &[Bubble]) -> f32 {
    blobs.iter().map(|b| b.ball[3]).fold(f32::MIN_POSITIVE, f32::max)
}

fn bounds_of(blobs: &[Bubble]) -> Bounds {
    let corner = |sign: f32| {
        let of = move |b: &Bubble| {
            let [x, y, z, r] = b.ball;
            Vec3::new(x, y, z) + sign * r
        };
        blobs.iter().map(of)
    };
    let unit = (Vec3::splat(-1.0), Vec3::ONE);
    Bounds {
        min: corner(-1.0).reduce(Vec3::min).unwrap_or(unit.0),
        max: corner(1.0).reduce(Vec3::max).unwrap_or(unit.1),
    }
}

fn on_ground(blobs: &[Bubble]) -> Scene {
    stage::paving_under(&bounds_of(blobs))
}

/// `render --bubbles` without particles.
pub fn run(args: &RenderArgs, which: &Which) -> Outcome<()> {
    let range = args.frames.as_deref().map(sequence::parse_range).transpose()?;
    let Set { mut blobs, mut scene, lit, eye, target } = set(which)?;
    let (first, last) = match (range, &blobs.motion) {
        (Some(range), _) => (*range.start(), *range.end()),
        // A frame in which the blobs are under way.
        (None, Some(_)) => (75, 75),
        (None, None) => (1, 1),
    };
    let frames: Vec<u64> = (first..=last).step_by(args.every.get()).collect();
    let checked = session::check(&args.draw, frames.len() > 1)?;
    let file = SettingsFile::of_args(&args.draw)?;
    let environment = session::environment(&args.draw, Some([-0.55, 0.6, 0.45]))?;
    let camera = CameraFile::from_args(&args.camera)?.unwrap_or_else(|| CameraFile {
        eye: Some(eye),
        target: Some(target),
        up: Some([0.0, 1.0, 0.0]),
        fov_y_degrees: args.camera.fov.or(Some(36.0)),
        ..CameraFile::default()
    });
    camera.check(frames.iter().copied(), args.draw.size)?;
    if let Some(number) = frames.first() {
        for target in &checked.0 {
            output::probe(&target.path(*number))?;
        }
    }
    if let Some(path) = args.scene.as_ref().filter(|path| path.as_os_str() != "ground") {
        scene = stage::read(path)?;
        // Blobs that move collide with the scene of `--scene`. It replaces the built-in scene, and with it the
        // slope's ramp.
        if blobs.motion.is_some() {
            blobs.motion = Some(Motion::on(&scene, largest(&blobs.blobs))?);
        }
    }
    environment.light_scene(&mut scene);
    let mut settings = Settings::default().with(|it| it.light = environment.light());
    file.apply(&mut settings);
    let LightVolume { center, radius } = lit.region();
    let count = blobs.blobs.len();
    let bubbles = file.bubbles.config().with(|it| it.crossfade = false);
    let fps = args.fps.unwrap_or(FPS);
    let look = Look {
        camera,
        settings,
        fluids: Vec::new(),
        file,
        environment,
        scene,
        matte: false,
        photograph: false,
        still: None,
        foam: None,
        whitewater: None,
        bubbles: Some((blobs, bubbles)),
        shores: None,
        exposure: 0.0,
        spray: false,
        region: LightVolume { center, radius: 1.5 * radius },
        fps: Some(fps),
        clock: Some(fps),
        rate: Some(fps),
        film: fps / args.every.get() as f32,
        fullest: 1,
    };
    let (frames, mut progress) = session::unfinished(&args.draw, &checked.0, frames);
    if frames.is_empty() {
        return Ok(());
    }
    let mut session = Session::new(&args.draw, checked, look, progress.steps())?;
    session.frames_without_particles(
        &frames,
        ("bubbles", &format!("{count} blobs, ")),
        &mut progress,
    )?;
    progress.finish();
    session.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_named() {
        assert_eq!(named("one"), Ok(Which::One));
        assert_eq!(named("box"), Ok(Which::Box(5000)));
        assert_eq!(named("slope:20"), Ok(Which::Slope(20)));
        assert_eq!(named("foam.json"), Ok(Which::File("foam.json".into())));
        assert_eq!(named("c:/foam.json"), Ok(Which::File("c:/foam.json".into())));
        for bad in ["", "box:0", "slope:many", "box:"] {
            assert!(named(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn boxes_are_filled_and_slopes_are_covered() {
        for count in [1, 100, 5000] {
            let all = set(&Which::Box(count)).unwrap().blobs.blobs;
            let bounds = bounds_of(&all);
            assert_eq!(all.len(), count as usize);
            assert!(bounds.size().x < 4.5 && bounds.min.y > -1.0, "{count}: {bounds:?}");
        }
        let set = set(&Which::Slope(300)).unwrap();
        assert_eq!(set.blobs.blobs.len(), 300);
        assert_eq!(set.blobs.motion.unwrap().solids.len(), 4);
    }

    #[test]
    fn files_are_read_and_their_faults_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("foam.json");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read(&path)
        };
        let good = read(
            r#"{"blobs":[{"center":[1,2,3],"radius":0.5},{"center":[0,0,0],"radius":1,"turn":[1,0,0,0],"id":9}]}"#,
        );
        let (good, moves) = good.unwrap();
        assert!(!moves);
        assert_eq!(good[0], Bubble { ball: [1.0, 2.0, 3.0, 0.5], turn: unturned(), id: 0 });
        assert_eq!((good[1].turn, good[1].id), ([1.0, 0.0, 0.0, 0.0], 9));
        assert!(read(r#"{"blobs":[],"moves":true}"#).unwrap().1);
        for bad in [
            "",
            "[]",
            r#"{"blobs":[{"center":[1,2],"radius":1}]}"#,
            r#"{"blobs":[{"center":[1,2,3],"radius":0}]}"#,
        ] {
            let message = read(bad).unwrap_err().message;
            assert!(message.contains("foam.json") && message.contains("expected"), "{message}");
        }
        assert!(super::read(&folder.path().join("none.json")).is_err());
    }
}
