//! The command line. Each flag is documented in its help.

mod values;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::bubbles::Which as Bubbles;
use crate::extras::Condition;
use crate::fluids::FluidArg;
use crate::pattern::Source;
use crate::settings::{LookWord, MediumName};
use crate::shore::Which as Shore;
use clap::{Args, Parser, Subcommand, ValueEnum};
use whitewater::io::picture::Tone;
use whitewater::water::{Rule, Splat};
use whitewater_simulate::{FPS, FRAMES, Scene};

use values::{
    degrees, exposure, finite, foaming, no_less_than_0, positive, radius, rule, seconds, size,
    times_as_large, turntable, vector, was_foam,
};

const EXIT_CODES: &str = "\
Exit codes:
  0  success
  1  pictures differ by more than the tolerance; or some frames of a sequence failed (the others
     are written, the failed ones are listed at the end)
  2  invalid command line
  3  an input is missing, damaged or of an unknown format
  4  device trouble: no Vulkan, no such device, lost, out of memory, validation messages
  5  an output cannot be written: no such folder, no permission, disk full (a pipe that is closed
     early, as by head, is no failure)
  130  interrupted by Ctrl-C; no incomplete file remains";

const SIMULATE_HELP: &str = "\
Scenes:
  waterfall  a chute pours into a basin, past a pillar (to 29k particles)
  corridor   a gate floods a corridor of obstacles (to 61k)
  bamboo     a bamboo pipe fills, tips into a bowl, and falls back (to 31k)
Each takes two to ten minutes.

In DIR, SCENE_0001.bgeo and so on hold positions, velocities, densities and ids; scene.json holds
the solids and their motion, camera.json a moving camera. The result does not depend on the number
of threads. To draw it:

  whitewater render 'DIR/SCENE_*.bgeo' --scene DIR/scene.json --camera DIR/camera.json -o %04d.png

Exit codes: 0 success; 2 invalid command line; 5 an output cannot be written; 130 interrupted by
Ctrl-C, finished frames are kept";

/// Draws water from particle files, without a window. It writes pictures (OpenEXR, PNG) and films (MP4).
#[derive(Parser, Debug)]
#[command(name = "whitewater", version, after_help = EXIT_CODES, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand, Debug)]
pub enum Command {
    /// Draw one frame or a sequence
    #[command(after_help = EXIT_CODES)]
    Render(Box<RenderArgs>),
    /// Draw the built-in scene: water from a chute into a basin
    #[command(after_help = EXIT_CODES)]
    Demo(Box<DemoArgs>),
    /// Simulate the particles of a scene: waterfall, corridor or bamboo
    #[command(after_help = SIMULATE_HELP)]
    Simulate(SimulateArgs),
    /// Report what particle files hold
    ///
    /// For each frame 'whitewater info' prints the format, the number of particles, bounds, spacing, the meaning of
    /// each attribute, the up axis, and what is missing for foam. Of attributes that distinguish types of particles it
    /// prints the values, and which types are at rest while others move: probably walls. Below the frames of a sequence
    /// it prints a summary: the frame rate and how it was found, the least and the greatest number of particles, and
    /// the frame whose water is fastest (types at rest do not count). With --json it prints one object: `frames` is an
    /// array, `sequence` the summary, or null where the files are no sequence.
    #[command(after_help = EXIT_CODES)]
    Info(InfoArgs),
    /// Compare two pictures
    #[command(after_help = EXIT_CODES)]
    Compare(CompareArgs),
    /// Make a shoreline-foam texture from a black and white pattern
    #[command(after_help = EXIT_CODES)]
    Pattern(PatternArgs),
    /// Time every pass over particle counts, frame sizes and paths
    Bench(crate::bench::BenchArgs),
}

#[derive(Args, Debug)]
pub struct RenderArgs {
    /// Particle files: a folder that holds one sequence, file names, a pattern such as 'fluid_*.bgeo' or
    /// 'fluid_%04d.bgeo', or one file that holds all frames
    ///
    /// In a pattern, %d stands for a frame number without leading zeros. These files can hold all frames: a table
    /// with a column of times, XYZ, a LAMMPS dump, VTKHDF, XDMF, Tecplot with several zones, a NumPy or HDF5 array of
    /// shape (frames, particles, 3) and a JSON list of frames. The frames in such a file are counted from 0.
    /// 'whitewater info' lists what the files hold.
    #[arg(required_unless_present_any = ["bubbles", "shore"], value_name = "INPUT")]
    pub inputs: Vec<String>,
    /// Draw bubble foam: one, slope, box, or a .json file of blobs
    ///
    /// A blob is a ball of soap bubbles. 'one' is a single blob close up, 'slope' a thousand blobs that start to
    /// slide down a slope in frame 0 (60 frames per second), 'box' five thousand at rest; slope:N and box:N set the
    /// number. These three are drawn without particles; the blobs of a file can be drawn together with particles. A
    /// file holds {"blobs":[{"center":[x,y,z],"radius":r,"turn":[x,y,z,w],"id":n},...]}; turn is a quaternion. If the
    /// file also has "moves":true, its blobs fall and collide with --scene, and cannot be combined with particles.
    /// Table [bubbles] of --settings sets the appearance.
    #[arg(long, value_name = "one|slope|box|FILE", value_parser = crate::bubbles::named)]
    pub bubbles: Option<Bubbles>,
    /// Draw shoreline and contact foam on a sea: archipelago, pool, lava, or a scene file
    ///
    /// 'archipelago' has islands, one of which drifts; 'pool' has objects in water; 'lava' is a river of lava. A scene
    /// of your own (.glb, .gltf, .obj, .json) is set in a sea. There are no water particles. Frames start at 1; the
    /// built-in scenes repeat, 'pool' after 6 seconds, the others after 10. A mesh whose name contains 'strip', or the
    /// file that the key strip in table [shore] names, is a strip of foam along the shore: its second texture
    /// coordinate is 0 at the strip's seaward edge, 1 at the shore line, 2 at its inland edge. Tables [shore],
    /// [shoreline] and [contact] of --settings set the appearance. Without --shore, particle_opacity = 1 in table
    /// [contact] draws contact foam on the water of the particles.
    #[arg(long, value_name = "archipelago|pool|lava|FILE", value_parser = crate::shore::named, conflicts_with_all = ["inputs", "bubbles", "whitewater", "scene"])]
    pub shore: Option<Shore>,
    /// Height of the sea in a scene of your own, scene units
    #[arg(long, value_name = "Y", default_value_t = 0.0, value_parser = finite, allow_hyphen_values = true, requires = "shore")]
    pub level: f32,
    /// Frames of the sequence to draw, as A-B or A [default: all; without particles, one frame]
    ///
    /// Camera, radius and ground are found from the whole sequence, so that parts of it that are drawn separately
    /// match.
    #[arg(long, value_name = "A-B")]
    pub frames: Option<String>,
    /// Draw every Nth of the selected frames
    ///
    /// The foam simulation still steps through every frame of the sequence, also through those before the first one
    /// of --frames.
    #[arg(long, value_name = "N", default_value = "1")]
    pub every: NonZeroUsize,
    /// Orbit the camera once around its target, in this many frames or seconds of the film (4s) [default: 96
    /// frames for one file; the drawn frames for a sequence]
    ///
    /// With --turntable a single file is drawn once for each frame of the orbit; these are numbered from 1. A
    /// sequence plays during the orbit.
    #[arg(long, value_name = "FRAMES|SECONDSs", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_parser = turntable, conflicts_with = "shore")]
    pub turntable: Option<Turntable>,
    /// Particle radius of the solver, half the rest spacing, in metres (after --unit or --scale), or the name of the
    /// attribute with a radius per particle [default: from the files, or estimated]
    ///
    /// A number sets one radius for all particles. Attributes called radius, pscale, diameter and the like are
    /// recognised. An attribute called only r is taken as radii if its values fit the particles' spacing and are not
    /// distances from the origin or an axis. If no number is given and radii in the files differ by more than a
    /// quarter, each large particle is drawn as several small ones of equal size, which makes at most 8 times as many
    /// particles in all.
    #[arg(long, value_name = "R|NAME", value_parser = radius)]
    pub radius: Option<Radius>,
    /// Frames per second of the sequence [default: from positions, velocities and ids; without these from the frames'
    /// times; without times 30]
    ///
    /// A frame is the usual step between the numbers in the files' names: files numbered 0, 10, 20 are one frame apart.
    /// The rate sets how fast foam forms and decays, how much whitewater 'generate' emits, how fast the sea and small
    /// waves move, how fast a film plays, the motion layer, and velocities that are estimated from the sequence.
    #[arg(long, value_name = "N", value_parser = positive)]
    pub fps: Option<f32>,
    /// Draw whitewater particles (spray, foam and bubbles) from files, or 'generate' them
    ///
    /// FILES are one file per frame, numbered like the inputs' frames, and named in the same way as the inputs. They
    /// hold types and lifetimes as SPlisHSPlasH's FoamGenerator writes them. KIND=FILES says that all particles in
    /// the files are of one kind: foam, spray or bubble. The option may be given several times. Size and opacity of
    /// the particles follow from their number; keys of table [whitewater] set them instead (half_intensity_thickness,
    /// radius, and for files also radii = [foam, spray, bubbles]). 'generate' emits whitewater from fast water, where
    /// it traps air or its waves break (table [generate]). With crossfade = [NEAR, FAR] in table [bubbles],
    /// foam is cross-faded to blobs of soap bubbles as its distance from the camera falls from FAR to NEAR metres.
    /// Surface foam and spray of the water particles are drawn as well; --surface-foam none and --spray none leave
    /// them out.
    #[arg(long, value_name = "generate|[KIND=]FILES", value_parser = crate::whitewater_source::named)]
    pub whitewater: Vec<Whitewater>,
    /// Write the whitewater of --whitewater generate to one file per frame: .bgeo, .bgeo.gz, .vtu, .ply or .npz
    ///
    /// A later run can read these files with --whitewater.
    #[arg(long, value_name = "FILE")]
    pub write_whitewater: Option<PathBuf>,
    /// Join files with the same frame number into one frame
    ///
    /// For example one file per phase, or per processor of a run.
    #[arg(long)]
    pub join: bool,
    /// Up axis of the files; particles are rotated so that it becomes y [default: y, z, -y or -z, from how the water
    /// lies and falls; y if that is ambiguous]
    ///
    /// -y means that y points down in the files, as in images. If the option is not given and the axis that is found is
    /// not y, the program says which one it is. Scene and camera are always y-up.
    #[arg(long, value_enum, allow_hyphen_values = true)]
    pub up_axis: Option<Up>,
    /// Draw only particles whose attribute satisfies a comparison, such as Type=3 (= != < > <= >=)
    ///
    /// If the option is given several times, all comparisons have to hold. Upper or lower case and units in names are
    /// ignored. Use it, for example, to leave out wall particles that are in the same files.
    #[arg(long = "where", value_name = "NAME=VALUE", value_parser = crate::extras::condition)]
    pub conditions: Vec<Condition>,
    /// Draw some particles as another liquid, such as 'Type=2:honey' or 'oil_*.vtk:beer:0.1'; several times for
    /// several fluids
    ///
    /// WHICH is a comparison as in --where, or further files with the same frame numbers, which are drawn in addition
    /// to the inputs. LIQUID is a name of --medium, 'water' for the look that the inputs have, or a settings file
    /// (.toml) applied over --settings. If any WHICH is a comparison, particles of the inputs that match no
    /// comparison are not drawn. Each pixel shows the nearest fluid with the others seen through it; a surface behind
    /// another liquid reflects nothing. A frame of two fluids takes 5 renders, of three 10. No fluid casts shadows on
    /// another. EXR layers and --whitewater generate use only one fluid: the inputs, or the first --fluid if any
    /// WHICH is a comparison.
    #[arg(long = "fluid", value_name = "WHICH:LIQUID", value_parser = crate::fluids::fluid, conflicts_with_all = ["bubbles", "shore"])]
    pub fluids: Vec<FluidArg>,
    /// Unit of lengths in the particle files, velocities included [default: m]
    ///
    /// Velocities whose names say their own unit, such as `vx [m/s]`, keep that one.
    /// All other lengths (--radius, --eye, --scene) are in metres.
    #[arg(long, value_enum, conflicts_with = "scale")]
    pub unit: Option<Unit>,
    /// Metres per unit of length in the particle files: 0.001 equals --unit mm
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    pub scale: Option<f32>,
    /// Scene behind the water: .glb, .gltf, .obj, .json, or 'ground' [default: a basin if the water stands against
    /// at least two sides of its bounding box, otherwise the ground]
    ///
    /// A .json scene is made of boxes, cylinders, tubes and spheres, for example
    /// {"ground": {"y": 0, "material": "paving"},
    /// "boxes": [{"material": "concrete", "centre": [0, 0.5, -1], "half": [2, 0.5, 0.1]}],
    /// "cylinders": [{"material": "plain", "centre": [1, 0.5, 0], "radius": 0.2, "height": 1}],
    /// "spheres": [{"material": "timber", "centre": [0, 1, 0], "radius": 0.1}]}. A part that moves has one pose per
    /// frame; 'whitewater simulate bamboo' writes such a file.
    #[arg(long, value_name = "FILE|ground")]
    pub scene: Option<PathBuf>,
    /// Surroundings: pool, studio, beach, lab or none [default: pool; with --scene the scene's own]
    ///
    /// 'pool' is a terrace over the sea, 'studio' a plain floor under a soft box, 'beach' sand in front of a sea,
    /// 'lab' a tiled hall with lamps. Studio and lab have their own light unless --environment or --sun sets one.
    /// Together with --scene, each of these four sets puts the scene on level ground in its surroundings and lights
    /// it. 'none' cannot be given together with --scene: only water, foam and spray are drawn, and the background
    /// stays transparent. Alpha, channel A of the EXR and the PNG, is then the fraction of the background that water,
    /// foam and spray hide, as the mean of red, green and blue. The colours of an EXR are premultiplied by alpha, those
    /// of a PNG are not.
    #[arg(long, value_enum)]
    pub set: Option<SetArg>,
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub draw: DrawArgs,
}

/// Source of the whitewater particles.
#[derive(Clone, Debug, PartialEq)]
pub enum Whitewater {
    /// They are emitted from the water's particles.
    Generate,
    /// The whitewater particles are read from files. `kind` is the kind of all of them; if it is `None`, the files
    /// store each particle's kind.
    Files { kind: Option<u32>, files: String },
}

#[derive(Args, Debug)]
pub struct DemoArgs {
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub draw: DrawArgs,
}

/// Arguments that every drawing command takes.
#[derive(Args, Debug)]
pub struct DrawArgs {
    /// File to write: .exr (linear light, all layers), .png, or .mp4 (a film of all frames, H.264); may be given
    /// several times
    ///
    /// In the output names of a sequence, the frame number replaces %04d; in a name without it, the number is put
    /// before the extension.
    #[arg(short, long = "output", required = true, value_name = "OUT")]
    pub outputs: Vec<PathBuf>,
    /// Frames per second at which a film plays [default: as many as the sequence has, so that it plays in real time;
    /// for a still --fps, or 30 without it]
    ///
    /// At 25, a sequence of 500 frames a second plays 20 times slower than in reality. A still is an input of one
    /// frame, for example with --turntable.
    #[arg(long, value_name = "N", value_parser = positive)]
    pub film_fps: Option<f32>,
    /// Size in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub size: (u32, u32),
    /// Render at N times the width and height and average: 1, 2 or 4 [default: 2; 1 for pictures with motion blur or
    /// depth of field]
    ///
    /// A larger render smooths outlines, drops and the refraction of fine ripples. --timings measures the frame at
    /// the larger size.
    #[arg(long, value_name = "N", value_parser = times_as_large)]
    pub supersample: Option<u32>,
    /// Motion blur: exposure time in seconds, centred on the frame, such as 1/50 or 0.02; 0 for none [default:
    /// 1/200 for an input of one frame of which only PNG files are written; otherwise 0, and 0 with --turntable,
    /// --fluid, --set none or --look thesis]
    ///
    /// Water particles, and whitewater particles with velocities, are moved along their velocities during the exposure.
    /// The blobs of --bubbles, the scene and the camera stand still.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub shutter: Option<f32>,
    /// Depth of field: lens diameter in scene units, 0 for none [default: where that of --shutter is 1/200, 0.0015 of
    /// the focus distance but at most 0.015 scene units; otherwise 0]
    ///
    /// A lens of 50 mm at f/2 has a diameter of 0.025 metres.
    #[arg(long, value_name = "DIAMETER", value_parser = no_less_than_0)]
    pub aperture: Option<f32>,
    /// Focus distance in scene units [default: the distance to the camera's target]
    #[arg(long, value_name = "DISTANCE", value_parser = positive)]
    pub focus: Option<f32>,
    /// Number of renders that a picture with motion blur or depth of field averages, 1 to 256; with 1 there is no blur.
    /// The time for a picture is proportional to it
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=256))]
    pub samples: u32,
    /// Settings file in TOML
    ///
    /// Tables: [water], [surface_foam], [spray], [whitewater], [bubbles], [generate], [shore], [shoreline], [contact],
    /// [ellipsoids], [wavelets], [shadow], [noise] and [light]. The attribute 'settings' of each EXR file holds all
    /// settings that it was drawn with. The key medium of [water] takes the names of --medium, or numbers per metre:
    /// {absorption = [r, g, b], reduced_scattering = [r, g, b], emission = [r, g, b]} for multiple scattering,
    /// {absorption = [r, g, b], scattering = [r, g, b]} for single scattering. Keys of [surface_foam] also set which
    /// water foams. by is the speed in the Weber number: 'air', the speed at which neighbours approach a particle
    /// (default), or 'speed', the particle's own (default for demo, with --look thesis, and if threshold, air or a
    /// number for --surface-foam is given). With 'air' the speed is √(a² + e²): a is that of the approach, e is
    /// turbulence (0 to 1, default 0.17) times the particle's speed relative to the frame's mean velocity, or 0 where
    /// neighbours move alike. weber = 'full' (SI units) or 'reduced' (per spacing, default); threshold (as
    /// --surface-foam); lifetime = 1.0 (mean seconds until foam has decayed); air = [0, 0, 0] (wind, scene units per
    /// second, y up); seed = 0.
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// Liquid: clear, pool, lake, ocean, river, glacier, milk, beer, honey, blood, lava or source (the thesis')
    /// [default: clear for water under 2 metres across, otherwise pool, diluted above 10 metres and, without --scene,
    /// in the set 'pool'; for two-dimensional water, one spacing thick, pool as of a metre; source with --look thesis]
    ///
    /// It sets absorption, scattering, index of refraction and foam colours. 'clear' is pure water, 'lake' is green,
    /// 'ocean' clear and blue, 'river' tan with silt, 'glacier' turquoise with rock flour, and 'lava' glows. Absorption
    /// and scattering are values per metre, most of them measured, so a body of beer, honey or blood that is metres
    /// deep looks nearly black or opaque. NAME:SHARE multiplies absorption and scattering by SHARE: beer:0.05 is a
    /// glass of beer drawn at twenty times its size, milk:0.01 a cup of milk in a hundred cups of water.
    #[arg(long, value_name = "NAME[:SHARE]")]
    pub medium: Option<MediumName>,
    /// Preset for everything that is not set explicitly: 'default', or 'thesis' (Bagar 2010)
    ///
    /// 'thesis' uses the composite, colours, foam, spray and smoothing iterations (--rule source) of Bagar's thesis.
    /// It draws one layer of water, and filtered shadows that the scene casts; water and foam cast none. The line
    /// look = 'thesis' at the top of the --settings file has the same effect.
    #[arg(long, value_enum)]
    pub look: Option<LookWord>,
    /// Environment that the water reflects: an equirectangular .hdr, .exr or .png, or 'sky'
    #[arg(long, value_name = "FILE|sky", default_value = "sky")]
    pub environment: String,
    /// Direction to the sun [default: that of the brightest spot of the --environment file; with the sky, high and to
    /// one side of the view, -0.7,0.55,-0.35 with --scene and without --set, fixed with --bubbles and --shore]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub sun: Option<[f32; 3]>,
    /// EXR layers besides R G B A: all, none, or names such as water.depth,scene
    ///
    /// 'all' means all layers except debug_view, for which the frame is drawn four more times. debug_view consists of
    /// four pictures. Each adds a part to the one before: background is the refracted scene, back_water adds the water
    /// behind the frontmost foam, surface_foam the foam, front_water the water in front of it. Reflections, highlights
    /// and spray are in none of them. motion.X and motion.Y are the motion vectors since the previous frame, in
    /// pixels, x to the right, y down. They are 0 in the first frame of a sequence. Where the scene is visible, they
    /// hold only the camera's motion.
    #[arg(long, value_name = "NAMES", default_value = "all")]
    pub layers: String,
    /// Exposure of PNG files and films: 'auto', or stops relative to it (1 is twice as bright)
    ///
    /// The exposure 'auto' follows from the environment's light and from the surroundings that --set chooses, not
    /// from the picture, so it is the same in all frames of a sequence.
    #[arg(long, value_name = "auto|STOPS", default_value = "auto", value_parser = exposure, allow_hyphen_values = true)]
    pub exposure: f32,
    /// Tone map of PNG files and films: aces, agx, neutral or linear
    ///
    /// aces is the Academy's film curve (Hill's fit); agx is Sobotka's, with less contrast and paler bright
    /// colours; neutral is Khronos', which keeps dim colours; linear clips. EXR is always linear light.
    #[arg(long, value_enum, default_value_t = ToneArg::Aces)]
    pub tone: ToneArg,
    /// Resolution of the smoothing: 0 full, 1 half, 2 quarter
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(0..=2))]
    pub smoothing_level: u32,
    /// Resolution of water thickness and surface foam: 0 full, 1 half, 2 quarter, 3 eighth
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(0..=3))]
    pub thickness_level: u32,
    /// Number of water layers that are separated where one stands in front of another, such as a drop in front
    /// of a pool: 1 or 2 [default: 2; 1 with --look thesis]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=2))]
    pub sheets: Option<u32>,
    /// Surface foam: auto, none, or a Weber number as threshold [default: auto]
    ///
    /// 'auto' needs velocities. Foam forms where the water traps air, that is, where neighbouring particles move
    /// towards each other, and where it is fast and neighbouring particles move differently: on at most 5 % of the
    /// particles of the up to 16 frames that are read to find the threshold. Water that rests, flows or falls as a
    /// whole does not foam, nor does a smooth jet. None does if in each of these frames nearly all water moves within
    /// 1 m/s of the median velocity. If particles have ids, at most 30 % of the particles of such a frame carry foam
    /// at a time. A number for WHEN is the threshold of the Weber number that each particle's own speed gives. If
    /// particles have ids, foam forms and decays over time; earlier frames are read for that.
    #[arg(long, value_name = "WHEN", value_parser = foaming)]
    pub surface_foam: Option<Foaming>,
    /// The former name of --surface-foam
    #[arg(long = "foam", hide = true, value_name = "WHEN", value_parser = was_foam)]
    pub foam: Option<Foaming>,
    /// Spray of particles with few or no neighbours: auto or none [default: auto; none if there are very few
    /// particles, or if they are two-dimensional]
    ///
    /// Whether a particle is spray depends on its density (from the files, or estimated) and on its neighbours. Keys
    /// of table [spray] set the limits. few_neighbours = [FEW, MANY] [default: 3.5, 9]: if the sum of the neighbours'
    /// weights is at most FEW, the particle is spray; from MANY on its density alone decides. all_spray_density,
    /// full_water_density and no_spray_density are the limits of density, as fractions of the rest density [default:
    /// 0.44, 0.6, 0.63]. A particle inside a jet or another loose body of water is no spray, unless the sum of its
    /// neighbours' weights is at most FEW. A cluster of up to 8 particles with no others within four spacings is spray,
    /// however dense. With 'none' these particles are drawn as drops of water.
    #[arg(long, value_enum)]
    pub spray: Option<SprayArg>,
    /// Surface noise, finer than the particles and moving with them: air (on water in the air, such as jets and
    /// sheets), surface (on all water), foam (on all water, with grey foam), or none [default: air; none with --look
    /// thesis]
    ///
    /// The noise is that of van der Laan et al. 2009. Their complete method, for comparison, is --noise foam --rule
    /// fixed:40 --surface-foam none.
    #[arg(long, value_enum)]
    pub noise: Option<NoiseArg>,
    /// Shadows besides those of the scene on itself, which are always drawn: all (scene, water and foam cast them,
    /// with caustics), scene (only the scene casts them, on foam and spray; where it hides the sun, water has no
    /// highlight), or none [default: all; scene with --look thesis]
    #[arg(long, value_enum)]
    pub shadows: Option<ShadowArg>,
    /// How particles are rasterized: by a compute shader or as sprites (raster) [default: compute]
    #[arg(long, value_enum)]
    pub splat: Option<SplatArg>,
    /// Iteration rule of the smoothing: source, constant-width, or fixed:N [default: constant-width; source
    /// with --look thesis]
    #[arg(long, value_parser = rule)]
    pub rule: Option<Rule>,
    /// Write the time of each pass to a .csv or .json
    ///
    /// Some passes run once per simulation step: classify, which finds the foaming water; emission of whitewater;
    /// blob dynamics. They are listed once per frame, before its other passes, with the times of the last step. After
    /// Ctrl-C the file holds the frames so far.
    #[arg(long, value_name = "FILE")]
    pub timings: Option<PathBuf>,
    /// Draw each frame this many times; --timings has all of them
    #[arg(long, value_name = "N", default_value = "1")]
    pub repeat: NonZeroUsize,
    /// Write a trace for Perfetto or chrome://tracing (.json)
    ///
    /// After Ctrl-C it holds the frames so far.
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Device to draw on, by a part of its name [default: a GPU if there is one]
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Draw with core and synchronization validation; messages are errors
    #[arg(long)]
    pub validate: bool,
    /// Redraw frames of a sequence whose files exist [default: skip them]
    #[arg(long)]
    pub overwrite: bool,
}

#[derive(Args, Debug)]
pub struct CameraArgs {
    /// Camera as JSON
    ///
    /// {"eye":[x,y,z],"target":[..],"up":[..],"fov_y_degrees":40,"near":0.1,"far":1000}, or
    /// {"view":[16],"projection":[16]}, column-major, for Vulkan's clip space. A moving camera has keys:
    /// {"keys":[{"frame":1,"eye":[..],"target":[..]},...]}, each with optional up and fov_y_degrees. The camera
    /// follows a Catmull-Rom spline over the frame numbers, and is at rest at the first and the last key.
    #[arg(long = "camera", value_name = "FILE", conflicts_with_all = ["eye", "target", "up", "fov"])]
    pub file: Option<PathBuf>,
    /// Position of the camera [default: found from the particles]
    ///
    /// Particles that lie far from the origin, as in map coordinates, are moved near it. --eye and --target may be
    /// given where the particles were (in metres, y up) or where they are after the move.
    #[arg(long, value_name = "X,Y,Z", requires = "target", value_parser = vector, allow_hyphen_values = true)]
    pub eye: Option<[f32; 3]>,
    /// Point the camera looks at
    #[arg(long, value_name = "X,Y,Z", requires = "eye", value_parser = vector, allow_hyphen_values = true)]
    pub target: Option<[f32; 3]>,
    /// Up direction in the picture [default: 0,1,0]
    #[arg(long, value_name = "X,Y,Z", requires = "eye", value_parser = vector, allow_hyphen_values = true)]
    pub up: Option<[f32; 3]>,
    /// Vertical field of view in degrees [default: 40 with --eye, otherwise 36; with --shore that of the scene]
    #[arg(long, value_name = "DEG", value_parser = degrees)]
    pub fov: Option<f32>,
}

#[derive(Args, Debug)]
pub struct SimulateArgs {
    /// What to simulate
    #[arg(value_name = "SCENE", value_parser = clap::builder::PossibleValuesParser::new(Scene::NAMES))]
    pub scene: String,
    /// Folder for the frames, scene.json and camera.json; created if missing
    #[arg(short, long, value_name = "DIR")]
    pub out: PathBuf,
    /// Frames to write, as A-B or A; frames before A are simulated, not written
    #[arg(long, value_name = "A-B", default_value_t = format!("1-{FRAMES}"))]
    pub frames: String,
    /// Frames per second
    #[arg(long, value_name = "N", default_value_t = FPS, value_parser = positive)]
    pub fps: f32,
    /// Rest distance of particles in metres; half the distance means eight times as many particles [default: the
    /// scene's]
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub spacing: Option<f32>,
    /// Write only these frames of --frames, as A-B or A
    #[arg(long, value_name = "A-B")]
    pub keep: Option<String>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u32,
    /// Threads to use; 0: one per core
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
}

#[derive(Args, Debug)]
pub struct InfoArgs {
    /// Particle files, as for render
    #[arg(required = true, value_name = "INPUT")]
    pub inputs: Vec<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Debug)]
pub struct CompareArgs {
    /// Reference: .exr, .png or .hdr
    pub a: PathBuf,
    /// Test: .exr, .png or .hdr
    pub b: PathBuf,
    /// Print the mean FLIP error of the displayed colour (0 to 1) instead of the channels' RMSE; --tolerance then
    /// applies to it
    #[arg(long)]
    pub flip: bool,
    /// Largest RMSE of any channel (or mean FLIP) that counts as equal
    #[arg(long, default_value_t = 0.0, value_parser = finite)]
    pub tolerance: f32,
}

#[derive(Args, Debug)]
pub struct PatternArgs {
    /// Picture whose white areas are foam: .png, .exr or .hdr; or web:SEED or noise:SEED for a built-in texture
    ///
    /// A pixel of the picture is white by its luminance; transparent pixels are no foam. The texture that is written
    /// can be repeated without seams.
    #[arg(value_name = "IN|web:SEED|noise:SEED", value_parser = crate::pattern::named)]
    pub input: Source,
    /// Texture to write: .png (16-bit grey, linear) or .exr (32-bit float, channel Y)
    ///
    /// A pattern or web is 1 on the lines of foam and 0 far from them. Noise has channels R G B A, from -1 to 1 in an
    /// .exr and from 0 to 1 in a .png.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Distance from the lines of foam at which the texture's value has fallen to 0, texels [default: the largest
    /// distance in the picture]
    #[arg(long, value_name = "TEXELS", value_parser = positive)]
    pub reach: Option<f32>,
    /// Black areas are foam
    #[arg(long)]
    pub invert: bool,
    /// Luminance from which a pixel is white [default: 0.5]
    #[arg(long, value_name = "T", value_parser = finite, allow_hyphen_values = true)]
    pub threshold: Option<f32>,
    /// Side length of 'web' and 'noise' in texels [default: 512]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    pub size: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Up {
    Y,
    Z,
    X,
    #[value(name = "-y")]
    MinusY,
    #[value(name = "-z")]
    MinusZ,
    #[value(name = "-x")]
    MinusX,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Unit {
    Mm,
    Cm,
    M,
    Km,
}

impl Unit {
    pub fn metres(self) -> f32 {
        match self {
            Self::Mm => 1.0e-3,
            Self::Cm => 1.0e-2,
            Self::M => 1.0,
            Self::Km => 1.0e3,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::M => "m",
            Self::Km => "km",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SplatArg {
    Raster,
    Compute,
}

impl From<SplatArg> for Splat {
    fn from(splat: SplatArg) -> Self {
        match splat {
            SplatArg::Raster => Self::Raster,
            SplatArg::Compute => Self::Compute,
        }
    }
}

/// Surroundings of the water.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum SetArg {
    /// A terrace over the sea
    #[default]
    Pool,
    /// A plain floor that passes into the dark.
    Studio,
    /// Sand in front of a sea.
    Beach,
    /// A tiled hall.
    Lab,
    /// Nothing.
    None,
}

/// Tone map: from linear light to a screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ToneArg {
    /// Clipped.
    Linear,
    /// Khronos' PBR Neutral.
    Neutral,
    /// The Academy's film curve.
    Aces,
    /// Sobotka's AgX.
    Agx,
}

impl From<ToneArg> for Tone {
    fn from(tone: ToneArg) -> Self {
        match tone {
            ToneArg::Linear => Self::Linear,
            ToneArg::Neutral => Self::Neutral,
            ToneArg::Aces => Self::Aces,
            ToneArg::Agx => Self::Agx,
        }
    }
}

/// Which objects cast shadows, and on what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ShadowArg {
    /// Scene, water and foam cast shadows on each other; with caustics.
    All,
    /// The scene casts shadows on foam, spray and the sun's highlights.
    Scene,
    /// None.
    None,
}

/// Whether particles of low density are drawn as spray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SprayArg {
    /// Spray, if densities are in the files or can be estimated.
    Auto,
    /// No spray.
    None,
}

/// What the surface noise changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum NoiseArg {
    /// Nothing.
    None,
    /// The normals of water in the air.
    Air,
    /// The normals of all water.
    Surface,
    /// The normals of all water, and grey foam.
    Foam,
}

/// Radius of the particles.
#[derive(Clone, Debug, PartialEq)]
pub enum Radius {
    Metres(f32),
    /// The attribute with this name, one radius per particle.
    Of(String),
}

/// Which water foams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Foaming {
    Auto,
    None,
    /// Water with at least this Weber number, in the source's reduced form.
    From(f32),
}

/// Duration of one orbit of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turntable {
    /// The number of drawn frames.
    Auto,
    Frames(u32),
    Seconds(f32),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_their_metres() {
        let all = [Unit::Mm, Unit::Cm, Unit::M, Unit::Km].map(|unit| (unit.name(), unit.metres()));
        assert_eq!(all, [("mm", 0.001), ("cm", 0.01), ("m", 1.0), ("km", 1000.0)]);
    }

    #[test]
    fn the_command_line_is_sound() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
