//! `render --shore`: shoreline and contact foam on a scene's sea.

use std::path::{Path, PathBuf};

use glam::{Mat4, Vec2, Vec3};
use whitewater::headless::scene::{Scene, Sea};
use whitewater::headless::{Headless, ShoreMesh};
use whitewater::io::particles::sequence;
use whitewater::shore::{Area, ShoreConfig};
use whitewater::{Error, LightVolume, Settings, Shore, Shoreline};

use super::own;
use super::scenes::{self, ShoreScene};
use super::strip::Strip;
use crate::args::RenderArgs;
use crate::camera::CameraFile;
use crate::failure::{Failure, Outcome};
use crate::output;
use crate::pattern;
use crate::session::{self, Look, Session};
use crate::settings::SettingsFile;
use crate::settings::shore::By;
use crate::stage;

/// Default size of the distance map in texels along an edge.
const MAP: u32 = 1024;

/// A scene with a shore.
#[derive(Clone, Debug, PartialEq)]
pub enum Which {
    Archipelago,
    Pool,
    Lava,
    /// A scene from a file.
    File(PathBuf),
}

/// Parses the name on the command line.
pub fn named(text: &str) -> Result<Which, String> {
    match text {
        "archipelago" => Ok(Which::Archipelago),
        "pool" => Ok(Which::Pool),
        "lava" => Ok(Which::Lava),
        "" => Err("expected archipelago, pool, lava or a scene's file".into()),
        file => Ok(Which::File(file.into())),
    }
}

/// Shoreline and contact foam of a run.
pub struct Shores {
    pub config: ShoreConfig,
    shore: Shore,
    land: Land,
    /// Size and texels of a user's picture of the web (the pattern of foam), and in the next field those of a picture
    /// that masks contact foam and is laid over the view.
    web: Option<([u32; 2], Vec<f32>)>,
    mask: Option<([u32; 2], Vec<f32>)>,
}

/// Source of the shore coordinate.
enum Land {
    /// The depth of the frame, or no source.
    None,
    Strip(Strip),
    Map {
        size: u32,
        area: Area,
    },
}

impl Shores {
    /// Contact foam on the water of the particles, without shoreline foam, if the settings file asks for it.
    pub fn of_particles(file: &SettingsFile) -> Outcome<Option<Self>> {
        file.contact.on_particles().then(|| Self::on_particles(file)).transpose()
    }

    /// The same, unconditionally.
    pub fn on_particles(file: &SettingsFile) -> Outcome<Self> {
        let shore = Shore::new(0.0).with(|it| it.surface = None);
        let config = file.shore.config();
        Ok(Self { config, shore, land: Land::None, web: web(file)?, mask: mask(file)? })
    }

    /// Foam on the sea of a scene.
    pub fn of(
        file: &SettingsFile,
        scene: &Scene,
        level: f32,
        strip: Option<Strip>,
        (reach, by): ([f32; 2], By),
    ) -> Outcome<Self> {
        let mut shore = Shore::new(level);
        let (strip, by) = match &file.shore.strip {
            Some(path) => (Some(own::read(path)?), By::Strip),
            None => (strip, by),
        };
        let land = match file.shore.by.unwrap_or(by) {
            By::None => Land::None,
            By::Screen => {
                shore.shoreline = Some(Shoreline::Screen);
                Land::None
            }
            By::Strip => Land::Strip(strip.ok_or_else(|| {
                let why = "no mesh of the scene is named strip, and shore.strip names no file of one: by = \"map\" \
                           finds the shore without";
                Failure::input(format!("shore.by = \"strip\": {why}"))
            })?),
            By::Map => {
                let (low, high) = scene.bounds();
                let (middle, size) = (0.5 * (low + high), high - low);
                let reach = reach[0].max(reach[1]);
                let edge = size.x.max(size.z) + 2.0 * reach;
                let (up, center) = ([0.0, 1.0, 0.0], [middle.x, middle.z]);
                let area = Area { up, center, edge, level, reach: reach.min(edge) };
                Land::Map { size: file.shore.map.unwrap_or(MAP), area }
            }
        };
        Ok(Self { config: file.shore.config(), shore, land, web: web(file)?, mask: mask(file)? })
    }

    /// Uploads data that is the same in all frames.
    pub fn set_up(&self, headless: &mut Headless, scene: &Scene) -> Result<(), Error> {
        if let Some((size, texels)) = &self.web {
            headless.shore_web(*size, texels)?;
        }
        if let Some((size, texels)) = &self.mask {
            headless.shore_mask(*size, texels)?;
        }
        match &self.land {
            Land::None => {}
            Land::Strip(Strip { positions, v, indices }) => {
                headless.shore_strip(&ShoreMesh { positions, indices }, v)?;
            }
            Land::Map { size, area } => {
                let meshes = scene.meshes.iter();
                let meshes = meshes
                    .map(|mesh| ShoreMesh { positions: &mesh.positions, indices: &mesh.indices });
                headless.shore_map(*size, &meshes.collect::<Vec<_>>())?;
                headless.shore_map_step(area, &transforms(scene, scene.frame), None)?;
            }
        }
        headless.shore(Some(self.shore));
        Ok(())
    }

    /// Updates the land for the scene's frame; `before` is the previous one.
    pub fn moved(&self, headless: &mut Headless, scene: &Scene, before: u64) -> Result<(), Error> {
        let Some(changed) = changed(scene, before) else { return Ok(()) };
        self.step(headless, scene, Some(changed))
    }

    /// Updates the distance map, if there is one, for the scene's frame: the area `changed`, or with `None` all of
    /// it.
    pub fn step(
        &self,
        headless: &mut Headless,
        scene: &Scene,
        changed: Option<[[f32; 2]; 2]>,
    ) -> Result<(), Error> {
        let Land::Map { area, .. } = &self.land else { return Ok(()) };
        headless.shore_map_step(area, &transforms(scene, scene.frame), changed)
    }

    /// Whether a distance map gives the shore coordinate.
    pub fn by_map(&self) -> bool {
        matches!(self.land, Land::Map { .. })
    }
}

/// The user's web.
fn web(file: &SettingsFile) -> Outcome<Option<([u32; 2], Vec<f32>)>> {
    file.shore.web.as_deref().map(pattern::values).transpose()
}

/// The user's mask of contact foam.
fn mask(file: &SettingsFile) -> Outcome<Option<([u32; 2], Vec<f32>)>> {
    file.contact.mask_picture.as_deref().map(pattern::values).transpose()
}

/// Where each mesh is in a frame.
pub fn transforms(scene: &Scene, frame: u64) -> Vec<Mat4> {
    let pose = |index: usize| {
        let motion = scene.motions.iter().find(|motion| motion.meshes.contains(&index));
        motion.map_or(Mat4::IDENTITY, |motion| motion.pose(frame))
    };
    (0..scene.meshes.len()).map(|index| pose(index) * scene.meshes[index].transform).collect()
}

/// Bounds in x and z (min, max) of the meshes that moved since frame `before`. They contain each of these meshes
/// where it was then and where it is now.
pub fn changed(scene: &Scene, before: u64) -> Option<[[f32; 2]; 2]> {
    let [then, now] = [before, scene.frame].map(|frame| transforms(scene, frame));
    let (mut least, mut most) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for (i, mesh) in scene.meshes.iter().enumerate().filter(|(i, _)| then[*i] != now[*i]) {
        for at in [then[i], now[i]] {
            for place in &mesh.positions {
                let place = at.transform_point3(Vec3::from(*place));
                least = least.min(Vec2::new(place.x, place.z));
                most = most.max(Vec2::new(place.x, place.z));
            }
        }
    }
    least.cmple(most).all().then(|| [least.to_array(), most.to_array()])
}

/// Returns a built-in scene, or a user's scene whose sea is at height `level`, and the source of its shore
/// coordinate. Writes the look that contact foam has in a built-in scene to `settings`.
pub fn scene_of(which: &Which, level: f32, settings: &mut Settings) -> Outcome<(ShoreScene, By)> {
    let contact = &mut settings.shore.contact;
    Ok(match which {
        Which::Archipelago => (scenes::archipelago(), By::Map),
        Which::Pool => {
            (contact.depth, contact.mask_scale, contact.mask) = (0.4, 1.0 / 0.9, 0.7);
            (scenes::pool(), By::None)
        }
        Which::Lava => {
            // Contact foam glows in the colour of the hot lava.
            (contact.color, contact.lit) = ([4.2, 1.35, 0.12], 0.0);
            (contact.depth, contact.mask_scale, contact.mask) = (0.75, 1.0 / 1.8, 0.7);
            contact.mask_speed = [0.02, 0.3];
            (scenes::lava(), By::None)
        }
        Which::File(path) => {
            let own = file(path, level)?;
            let by = if own.strip.is_some() { By::Strip } else { By::Map };
            (own, by)
        }
    })
}

/// A user's scene in a sea.
fn file(path: &Path, level: f32) -> Outcome<ShoreScene> {
    let mut scene = stage::read(path)?;
    let strip = own::taken(path, &mut scene)?;
    let (low, high) = scene.bounds();
    if !(low.y..=high.y).contains(&level) {
        let why = format!("it goes from {} to {} in height", low.y, high.y);
        let path = path.display();
        return Err(Failure::input(format!(
            "{path}: {why}, and has no shore at {level}: --level says where the sea is"
        )));
    }
    scene.sea = Some(Sea { level, ..Sea::default() });
    scene.ground = None;
    let camera = scene.camera;
    let (middle, size) = (0.5 * (low + high), high - low);
    let away = 0.75 * size.x.max(size.z);
    let eye =
        middle + away * Vec3::new(-0.45, 0.0, 0.9) + Vec3::Y * (level + 0.35 * away - middle.y);
    Ok(ShoreScene {
        eye: camera.map_or(eye.to_array(), |camera| camera.eye),
        target: camera.map_or([middle.x, level, middle.z], |camera| camera.target),
        fov: camera.map_or(40.0, |camera| camera.fov_y_degrees),
        sun: [-0.6, 0.5, 0.4],
        exposure: 0.0,
        level,
        frames: 240,
        fps: 24.0,
        strip,
        scene,
    })
}

/// `render --shore`.
pub fn run(args: &RenderArgs, which: &Which) -> Outcome<()> {
    let range = args.frames.as_deref().map(sequence::parse_range).transpose()?;
    let mut file = SettingsFile::of_args(&args.draw)?;
    let mut settings = Settings::default();
    let (mut shown, by) = scene_of(which, args.level, &mut settings)?;
    let (first, last) = range.map_or((1, 1), |range| (*range.start(), *range.end()));
    let frames: Vec<u64> = (first..=last).step_by(args.every.get()).collect();
    let checked = session::check(&args.draw, frames.len() > 1)?;
    let environment = session::environment(&args.draw, Some(shown.sun))?;
    let camera = CameraFile::from_args(&args.camera)?.unwrap_or_else(|| CameraFile {
        eye: Some(shown.eye),
        target: Some(shown.target),
        up: Some([0.0, 1.0, 0.0]),
        fov_y_degrees: args.camera.fov.or(Some(shown.fov)),
        ..CameraFile::default()
    });
    camera.check(frames.iter().copied(), args.draw.size)?;
    if let Some(number) = frames.first() {
        for target in &checked.0 {
            output::probe(&target.path(*number))?;
        }
    }
    settings.light = environment.light();
    // The built-in scenes repeat.
    let built_in = !matches!(which, Which::File(_));
    if built_in {
        shown.repeat(first, last, args.fps.unwrap_or(shown.fps));
    }
    settings.shore.period = built_in.then(|| shown.frames as f32 / shown.fps);
    file.apply(&mut settings);
    let mut scene = shown.scene;
    scene.frame = frames.first().copied().unwrap_or(1);
    environment.light_scene(&mut scene);
    let reach = [settings.shore.shoreline.sea_reach, settings.shore.shoreline.land_reach];
    let shores = Shores::of(&file, &scene, shown.level, shown.strip, (reach, by))?;
    file.shore.by.get_or_insert(by);
    let (low, high) = scene.bounds();
    let fps = args.fps.unwrap_or(shown.fps);
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
        bubbles: None,
        shores: Some(shores),
        exposure: shown.exposure,
        spray: false,
        region: LightVolume {
            center: (0.5 * (low + high)).to_array(),
            radius: 0.5 * (high - low).length().max(1.0e-3),
        },
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
    session.frames_without_particles(&frames, ("shore", ""), &mut progress)?;
    progress.finish();
    session.finish()
}
