//! The command line. What a flag means stands in its help.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::bubbles::Which as Bubbles;
use crate::extras::Condition;
use crate::pattern::Source;
use crate::settings::{LookWord, MediumName};
use crate::shore::Which as Shore;
use clap::{Args, Parser, Subcommand, ValueEnum};
use whitewater::io::picture::Tone;
use whitewater::water::settings::{Rule, Splat};
use whitewater_simulate::{FPS, FRAMES, Scene};

const EXIT_CODES: &str = "\
Exit codes:
  0  all is well
  1  pictures differ by more than the tolerance; or some frames of a sequence failed (the others
     are there, the failed ones are listed at the end)
  2  the command line cannot be understood
  3  an input is missing, damaged or of no known format
  4  the device: no Vulkan, no such device, lost, out of memory, validation messages
  5  the output cannot be written: no such folder, no permission, disk full (a reader that goes
     away, as head does, is no failure)
  130  broken off by Ctrl-C; no half-written file is left";

const SIMULATE_HELP: &str = "\
Scenes:
  waterfall  a chute pours into a basin, past a pillar (to 29k particles)
  corridor   a gate floods a corridor of obstacles (to 61k)
  bamboo     a bamboo pipe fills, tips into a bowl, and falls back (to 31k)
Each takes two to ten minutes.

In DIR, SCENE_0001.bgeo and so on hold positions, velocities, densities and ids; scene.json what
stands around the water, and how its parts move; camera.json a moving camera. The same on any
number of threads. To draw them:

  whitewater render 'DIR/SCENE_*.bgeo' --scene DIR/scene.json --camera DIR/camera.json -o %04d.png

Exit codes: 0 all is well; 2 the command line cannot be understood; 5 the output cannot be written;
130 broken off by Ctrl-C, finished frames are kept";

/// Draws particle water without a window: particle caches in, OpenEXR and PNG out.
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
    /// Make the particles of a scene: waterfall, corridor or bamboo
    #[command(after_help = SIMULATE_HELP)]
    Simulate(SimulateArgs),
    /// Say what particle files hold
    #[command(after_help = EXIT_CODES)]
    Info(InfoArgs),
    /// Compare two pictures
    #[command(after_help = EXIT_CODES)]
    Compare(CompareArgs),
    /// Turn a black and white pattern into the distance from it that shoreline foam's web is
    #[command(after_help = EXIT_CODES)]
    Pattern(PatternArgs),
    /// Time every pass over particle counts, sizes and ways to draw
    Bench(crate::bench::BenchArgs),
}

#[derive(Args, Debug)]
pub struct RenderArgs {
    /// Particle files: a folder with one sequence in it, names, a pattern such as 'fluid_*.bgeo', or 'fluid_%04d.bgeo'
    /// (%d where numbers have no zeros in front); or one file that holds all frames (a table with a column of times, XYZ, a dump of
    /// LAMMPS, VTKHDF, XDMF), which are counted from 0. 'whitewater info' says what they hold
    #[arg(required_unless_present_any = ["bubbles", "shore"], value_name = "INPUT")]
    pub inputs: Vec<String>,
    /// Bubble foam: 'one' (a blob from near), 'slope' (a thousand slide down one; frames from 0 on, 60 a second), 'box'
    /// (five thousand), slope:N and box:N of as many, or a .json of blobs, {"blobs":[{"center":[x,y,z],"radius":r,
    /// "turn":[x,y,z,w],"id":n},...]}, beside particles too; with "moves":true they fall, on what --scene shows. Table
    /// [bubbles] of --settings says how it looks
    #[arg(long, value_name = "one|slope|box|FILE", value_parser = crate::bubbles::named)]
    pub bubbles: Option<Bubbles>,
    /// Shoreline and contact foam on a sea: 'archipelago' (islands, of which one drifts), 'pool' (objects in it), 'lava' (a
    /// river of it), or a scene of your own (.glb, .gltf, .obj, .json) in the sea, without particles; frames from 1 on, which
    /// come round in ten seconds. A mesh of it that is named 'strip', or the file that [shore] strip names, is a strip of
    /// foam round the land: its second texture coordinate is 0 at the sea's edge, 1 at the shore line, 2 on the land. Tables
    /// [shore], [shoreline] and [contact] of --settings say how it looks; [contact] particle_opacity = 1 puts contact foam
    /// on particles' water
    #[arg(long, value_name = "archipelago|pool|lava|FILE", value_parser = crate::shore::named, conflicts_with_all = ["inputs", "bubbles", "whitewater", "scene"])]
    pub shore: Option<Shore>,
    /// Height of the sea in a scene of your own
    #[arg(long, value_name = "Y", default_value_t = 0.0, value_parser = finite, allow_hyphen_values = true, requires = "shore")]
    pub level: f32,
    /// Frames of the sequence to draw, as A-B or A. Camera, radius and ground are found from the
    /// whole sequence, so that its parts fit together
    #[arg(long, value_name = "A-B")]
    pub frames: Option<String>,
    /// Draws each Nth of them, from the first on; foam goes by all frames all the same
    #[arg(long, value_name = "N", default_value = "1")]
    pub every: NonZeroUsize,
    /// The camera goes once round what it looks at: in so many frames, or seconds of the film (4s). One file is drawn so often
    /// as it is, numbered from 1 on; a sequence runs meanwhile [default: of one file 96 frames, of a sequence those that are
    /// drawn]
    #[arg(long, value_name = "FRAMES|SECONDSs", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_parser = turntable, conflicts_with = "shore")]
    pub turntable: Option<Turntable>,
    /// Particle radius of the solver, half the spacing at rest, in metres (as --unit or --scale makes them) [default:
    /// that of the files, or estimated]
    #[arg(long, value_name = "R", value_parser = positive)]
    pub radius: Option<f32>,
    /// Frames a second of the sequence (of its files, whatever their numbers are apart), by which foam comes and goes and the motion layer is made
    /// [default: found from positions and velocities; without velocities, which are found by it, 30]
    #[arg(long, value_name = "N", value_parser = positive)]
    pub fps: Option<f32>,
    /// Diffuse particles of the same frames (spray, foam, bubbles), as FoamGenerator writes them: files named as the
    /// inputs, with their types and lifetimes, or KIND=FILES of one kind each, foam, spray or bubble; may be
    /// given several times. How large and opaque they are is found by how many there are (table [diffuse] sets it: radius,
    /// or radii = [foam, spray, bubbles], and half); 'generate': made of the water's particles, by where it traps air, breaks and is fast
    /// (table [generate] of --settings). Foam near the eye becomes blobs of soap bubbles where table [bubbles] has
    /// hand_over = [NEAR, FAR], all of it up to NEAR metres. The water's own foam and spray are drawn beside them only where
    /// --foam and --spray ask for it
    #[arg(long, value_name = "generate|[KIND=]FILES", value_parser = crate::diffuse::named)]
    pub whitewater: Vec<Whitewater>,
    /// Where the diffuse particles that are made go, a file a frame: .bgeo, .bgeo.gz, .vtu, .ply or .npz. They are
    /// read again as any others
    #[arg(long, value_name = "FILE")]
    pub write_whitewater: Option<PathBuf>,
    /// Puts files of one number together as one frame: phases, or the parts of a run on several processors, in a file each
    #[arg(long)]
    pub join: bool,
    /// Which axis of the particles points up; z is turned to y, scene and camera are y-up [default: z where the water lies on
    /// the lower end of z and is open above, or comes down along it, which is said; else y]
    #[arg(long, value_enum)]
    pub up_axis: Option<Up>,
    /// Draws the particles for which a comparison of an attribute holds, such as Type=3 (= != < > <= >=); of several, those
    /// for which all hold. Case and units in names say nothing. So walls that lie in the same files are left out
    #[arg(long = "where", value_name = "NAME=VALUE", value_parser = crate::extras::condition)]
    pub conditions: Vec<Condition>,
    /// Unit of lengths in the particle files, velocities too. All other lengths (--radius, --eye, --scene) are in metres
    /// [default: m]
    #[arg(long, value_enum, conflicts_with = "scale")]
    pub unit: Option<Unit>,
    /// Metres of a unit of length in the particle files: 0.001 is as --unit mm
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    pub scale: Option<f32>,
    /// What stands behind the water: .glb, .gltf, .obj, or .json (boxes, cylinders, tubes, spheres;
    /// parts may move, with a pose for each frame, as 'whitewater simulate' writes them);
    /// 'ground' [default: a basin round water that fills a box, else a ground under it]
    #[arg(long, value_name = "FILE|ground")]
    pub scene: Option<PathBuf>,
    /// Where the water is, if it is in no scene of a file: pool (a terrace in a garden), studio (a plain floor under a soft
    /// box), beach (sand before a sea) or lab (a tiled hall with lamps); studio and lab have light of their own where none is
    /// said. Or none: nothing but the water, its foam and spray, premultiplied, with
    /// the share in A that they hide of what is behind them (the mean of three channels), in EXR and PNG [default: pool]
    #[arg(long, value_enum, conflicts_with = "scene")]
    pub set: Option<SetArg>,
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub draw: DrawArgs,
}

/// Where diffuse particles come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Whitewater {
    /// They are made of the water's.
    Generate,
    /// From files. What they all are; none: as the files say.
    Files { kind: Option<u32>, files: String },
}

#[derive(Args, Debug)]
pub struct DemoArgs {
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub draw: DrawArgs,
}

/// What every drawing command takes.
#[derive(Args, Debug)]
pub struct DrawArgs {
    /// Picture to write, .exr (linear light, all layers) or .png; may be given twice. A sequence
    /// puts the frame number where %04d stands, or before the extension. Or a film of all frames,
    /// .mp4 (H.264), at --fps
    #[arg(short, long = "output", required = true, value_name = "OUT")]
    pub outputs: Vec<PathBuf>,
    /// Size in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub size: (u32, u32),
    /// Draws that many times as wide and high, and makes the picture from it: 1, 2 or 4. Smooth
    /// outlines, drops and refraction of fine ripples; the times of --timings are of the large frame [default: 2, or 1
    /// where the picture is the mean of --samples]
    #[arg(long, value_name = "N", value_parser = times_as_large)]
    pub supersample: Option<u32>,
    /// Motion blur: seconds that the shutter is open, about the moment of the frame, as 1/50 or 0.02; 0: none. By the
    /// velocities of the water; diffuse particles and bubbles stand still [default: 1/100 of a single picture that is a PNG,
    /// else 0]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub shutter: Option<f32>,
    /// Depth of field: diameter of the lens in scene units, 0: all is sharp; 50 mm at f/2 are 0.025 metres [default: of a
    /// single picture that is a PNG 0.006 of the distance at which it is sharp, 0.06 at most, else 0]
    #[arg(long, value_name = "DIAMETER", value_parser = no_less_than_0)]
    pub aperture: Option<f32>,
    /// How far away it is sharp [default: as the camera's target]
    #[arg(long, value_name = "DISTANCE", value_parser = positive)]
    pub focus: Option<f32>,
    /// Pictures that one with --shutter or --aperture is the mean of, 1 to 256: each is drawn, and takes as long as one
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=256))]
    pub samples: u32,
    /// Settings as TOML, tables [water], [foam], [spray], [diffuse], [bubbles], [generate], [shore], [shoreline], [contact],
    /// [shadow], [noise] and [light]; what a picture was drawn with stands in its EXR, attribute 'settings', whole. Table
    /// [water] medium is as --medium, or by its numbers per metre: {absorption = [r, g, b], reduced_scattering = [r, g, b],
    /// emission = [r, g, b]} scatters many times, {absorption = [r, g, b], scattering = [r, g, b]} once. Table [foam] also says by what water foams: by = 'air' (the speed at which neighbours come nearer) or 'speed' (its own, the
    /// default of a sequence and where threshold or air is said), weber = 'full' (the number in SI units) or 'reduced' (of the spacing, the
    /// default), threshold (as --foam), lifetime = 1.0 (mean seconds until it is gone), air = [0, 0, 0] (the wind,
    /// scene units a second, y up) and seed = 0 (of its times)
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// The liquid, with its index of refraction and the colours of its foam: clear (pure water), pool, lake (green), ocean
    /// (clear, blue), river (silt, tan), glacier (rock flour, turquoise), milk, beer, honey, blood, lava (it glows), or
    /// source (the thesis'). Absorption and scattering are measured ones, per metre: beer, honey and blood are nearly black
    /// or opaque where they are metres deep. NAME:SHARE has so much of what absorbs and scatters in it: beer:0.05 is a glass
    /// of beer that is drawn twenty times as large, milk:0.01 a cup of milk in a hundred of water [default: clear of
    /// particles under 2 metres across, else pool]
    #[arg(long, value_name = "NAME[:SHARE]")]
    pub medium: Option<MediumName>,
    /// How all looks where nothing else is said: 'default', or 'thesis', as the source of the layered water has it (Bagar
    /// 2010): its composite, colours, foam and spray, its iterations (--rule source), one sheet, and the scene's shadows by
    /// its filter, without those of water and foam. The same as look = 'thesis' at the head of --settings
    #[arg(long, value_enum)]
    pub look: Option<LookWord>,
    /// What the water reflects: an equirectangular .hdr, .exr or .png, or 'sky'
    #[arg(long, value_name = "FILE|sky", default_value = "sky")]
    pub environment: String,
    /// Direction to the sun [default: of the sky -0.7,0.55,-0.35; of a file its brightest spot]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub sun: Option<[f32; 3]>,
    /// Layers of the EXR beside R G B A: all, none, or names such as water.depth,scene; and ladder, the
    /// picture up to each of its layers (background, back_water, foam, front_water). motion.X and
    /// motion.Y: pixels from where what a pixel shows was in the frame before, x to the right and y
    /// down; of the first frame of a sequence 0, of the scene by the camera alone
    #[arg(long, value_name = "NAMES", default_value = "all")]
    pub layers: String,
    /// Brightness of the PNG: 'auto', as a meter finds it that is held into the light of the environment, so that it is the
    /// same in all frames of a sequence; or stops on top of that
    #[arg(long, value_name = "auto|STOPS", default_value = "auto", value_parser = exposure, allow_hyphen_values = true)]
    pub exposure: f32,
    /// How the light of the picture becomes that of the PNG: aces (the Academy's, a film's, by Hill's fit), agx (Sobotka's:
    /// less contrast, bright colours go pale), neutral (Khronos': dim colours as they are) or linear (clipped). EXR is
    /// linear light always
    #[arg(long, value_enum, default_value_t = ToneArg::Aces)]
    pub tone: ToneArg,
    /// Resolution of the smoothing: 0 full, 1 half, 2 quarter
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(0..=2))]
    pub smoothing_level: u32,
    /// Resolution of the thickness: 0 full, 1 half, 2 quarter, 3 eighth
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(0..=3))]
    pub thickness_level: u32,
    /// Sheets of water told apart where one stands before another, as a drop before a pool: 1 or 2 [default: 2; of
    /// --look thesis 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=2))]
    pub sheets: Option<u32>,
    /// What of the water foams: auto (of one frame where it traps air, as neighbours run into each other: a twentieth of
    /// it at most, and none of water that rests, flows or falls as a whole; of a sequence the fastest twentieth, three tenths
    /// at a time; needs velocities), none,
    /// or the Weber number from which on it does, by its own speed. In a sequence with ids foam comes and goes in time;
    /// frames before those that are drawn are read for it [default: auto; with --whitewater none]
    #[arg(long, value_name = "WHEN", value_parser = foaming)]
    pub foam: Option<Foaming>,
    /// Spray, of particles that are alone or nearly: auto (by densities of the file or found, table [spray] densities, in
    /// shares of the rest density [default: 0.28, 0.62, 0.7]) or none [default: auto; with --whitewater none]
    #[arg(long, value_enum)]
    pub spray: Option<SprayArg>,
    /// Noise on the surface, of the baseline (van der Laan et al. 2009), for comparison: none, surface
    /// (its normals), or foam (its grey foam too); with --rule fixed:40 and --foam none it is whole
    #[arg(long, value_enum, default_value_t = NoiseArg::None)]
    pub noise: NoiseArg,
    /// What the sunlight does: shadows of the scene on foam and spray, shadows of water and foam, caustics
    /// (all), those of the scene alone (scene), or none [default: all; of --look thesis scene]
    #[arg(long, value_enum)]
    pub shadows: Option<ShadowArg>,
    /// How particles become pixels [default: the faster on the device]
    #[arg(long, value_enum)]
    pub splat: Option<SplatArg>,
    /// Iterations of the smoothing: source, constant-width, or fixed:N [default: constant-width; of --look thesis source]
    #[arg(long, value_parser = rule)]
    pub rule: Option<Rule>,
    /// Write the time of each pass to a .csv or .json; at Ctrl-C, of the frames until then. What is done once a step before
    /// a frame (classify: which water is foam; the passes that make diffuse particles or move blobs) stands before its
    /// passes, the last step's, once however often the frame is drawn
    #[arg(long, value_name = "FILE")]
    pub timings: Option<PathBuf>,
    /// Draws each frame so many times, all of which go to --timings
    #[arg(long, value_name = "N", default_value = "1")]
    pub repeat: NonZeroUsize,
    /// Write a trace for Perfetto or chrome://tracing (.json); at Ctrl-C, until then
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Part of the name of the device to draw on [default: a GPU if there is one]
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Draw under core and synchronization validation; its messages are errors
    #[arg(long)]
    pub validate: bool,
    /// Draw frames of a sequence again that are there already [default: they are skipped]
    #[arg(long)]
    pub overwrite: bool,
}

#[derive(Args, Debug)]
pub struct CameraArgs {
    /// Camera as JSON: {"eye":[x,y,z],"target":[..],"up":[..],"fov_y_degrees":40,"near":0.1,
    /// "far":1000}, or {"view":[16],"projection":[16]} column-major, for Vulkan's clip space. It moves
    /// by {"keys":[{"frame":1,"eye":[..],"target":[..]},...]}, each with up and fov_y_degrees if it
    /// likes: a Catmull-Rom spline over the frames' numbers, at rest in the first key and the last
    #[arg(long = "camera", value_name = "FILE", conflicts_with_all = ["eye", "target", "up", "fov"])]
    pub file: Option<PathBuf>,
    /// Position of the camera [default: found from the particles]
    #[arg(long, value_name = "X,Y,Z", requires = "target", value_parser = vector, allow_hyphen_values = true)]
    pub eye: Option<[f32; 3]>,
    /// Point the camera looks at
    #[arg(long, value_name = "X,Y,Z", requires = "eye", value_parser = vector, allow_hyphen_values = true)]
    pub target: Option<[f32; 3]>,
    /// Direction that is up in the picture [default: 0,1,0]
    #[arg(long, value_name = "X,Y,Z", requires = "eye", value_parser = vector, allow_hyphen_values = true)]
    pub up: Option<[f32; 3]>,
    /// Vertical field of view in degrees [default: 40]
    #[arg(long, value_name = "DEG", value_parser = degrees)]
    pub fov: Option<f32>,
}

#[derive(Args, Debug)]
pub struct SimulateArgs {
    /// What to simulate
    #[arg(value_name = "SCENE", value_parser = clap::builder::PossibleValuesParser::new(Scene::NAMES))]
    pub scene: String,
    /// Folder for the frames, scene.json and camera.json; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub out: PathBuf,
    /// Frames of the sequence, as A-B or A; what comes before A is simulated and not written
    #[arg(long, value_name = "A-B", default_value_t = format!("1-{FRAMES}"))]
    pub frames: String,
    /// Frames per second
    #[arg(long, value_name = "N", default_value_t = FPS, value_parser = positive)]
    pub fps: f32,
    /// Distance of particles at rest, metres: half of it, eight times as many [default: the scene's]
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub spacing: Option<f32>,
    /// Write these of the frames only, as A-B or A
    #[arg(long, value_name = "A-B")]
    pub keep: Option<String>,
    /// Of the random numbers
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
    /// As JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Debug)]
pub struct CompareArgs {
    /// Reference: .exr, .png or .hdr
    pub a: PathBuf,
    /// Test
    pub b: PathBuf,
    /// Also the mean FLIP error of the colour as a screen shows it (0 to 1); the tolerance is then
    /// for it
    #[arg(long)]
    pub flip: bool,
    /// Largest RMSE of any channel (or mean FLIP) that still counts as equal
    #[arg(long, default_value_t = 0.0, value_parser = finite)]
    pub tolerance: f32,
}

#[derive(Args, Debug)]
pub struct PatternArgs {
    /// A picture whose white is foam's lines: .png, .exr or .hdr, by its luminance; what is transparent is none. It wraps
    /// round, as it will on the water. 'web:SEED' and 'noise:SEED': the textures that foam has of its own
    #[arg(value_name = "IN|web:SEED|noise:SEED", value_parser = crate::pattern::named)]
    pub input: Source,
    /// Texture to write: .png (grey, 16 bits, without a curve) or .exr (32-bit float, channel Y). 1 on the lines, 0 far from
    /// them. Of noise R G B A: from -1 to 1, in a .png from 0 to 1
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// How far from the lines it is 0, in texels [default: the largest distance there is]
    #[arg(long, value_name = "TEXELS", value_parser = positive)]
    pub reach: Option<f32>,
    /// Black is foam's lines
    #[arg(long)]
    pub invert: bool,
    /// From which luminance on it is white [default: 0.5]
    #[arg(long, value_name = "T", value_parser = finite, allow_hyphen_values = true)]
    pub threshold: Option<f32>,
    /// Texels a side of 'web' and 'noise' [default: 512]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    pub size: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Up {
    Y,
    Z,
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

/// What stands round the water.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum SetArg {
    /// A terrace in a garden.
    #[default]
    Pool,
    /// A plain floor that passes into the dark.
    Studio,
    /// Sand before a sea.
    Beach,
    /// A tiled hall.
    Lab,
    /// Nothing.
    None,
}

/// From light to a screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ToneArg {
    /// Clipped.
    Linear,
    /// Khronos' PBR Neutral.
    Neutral,
    /// The Academy's.
    Aces,
    /// Sobotka's.
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

/// What casts shadows on what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ShadowArg {
    /// The scene, water and foam, on each other; with caustics.
    All,
    /// The scene on foam and spray.
    Scene,
    /// None.
    None,
}

/// Whether there is spray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SprayArg {
    /// Where densities are known or can be found.
    Auto,
    /// None.
    None,
}

/// What the baseline's noise does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum NoiseArg {
    /// Nothing.
    None,
    /// Turns the surface's normals.
    Surface,
    /// And adds its foam.
    Foam,
}

/// What of the water foams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Foaming {
    Auto,
    None,
    /// From this Weber number on, of the source's reduced form.
    From(f32),
}

fn foaming(text: &str) -> Result<Foaming, String> {
    match text {
        "auto" => Ok(Foaming::Auto),
        "none" => Ok(Foaming::None),
        _ => positive(text)
            .map(Foaming::From)
            .map_err(|_| "expected auto, none or a number above 0".into()),
    }
}

/// How long a turn of the camera takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turntable {
    /// As long as there are frames.
    Auto,
    Frames(u32),
    Seconds(f32),
}

fn turntable(text: &str) -> Result<Turntable, String> {
    let bad = || "expected frames, 2 or more, or seconds, such as 96 or 4s".to_string();
    match (text, text.strip_suffix('s')) {
        ("auto", _) => Ok(Turntable::Auto),
        (_, Some(seconds)) => positive(seconds).map(Turntable::Seconds).map_err(|_| bad()),
        (frames, None) => match frames.parse() {
            Ok(frames @ 2..=100_000) => Ok(Turntable::Frames(frames)),
            _ => Err(bad()),
        },
    }
}

fn finite(text: &str) -> Result<f32, String> {
    match text.trim().parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("expected a number".into()),
    }
}

fn exposure(text: &str) -> Result<f32, String> {
    match text {
        "auto" => Ok(0.0),
        stops => finite(stops).map_err(|_| "expected auto, or stops".into()),
    }
}

/// A number, or one over another.
fn seconds(text: &str) -> Result<f32, String> {
    let found = match text.split_once('/') {
        Some((over, under)) => finite(over).and_then(|over| Ok(over / finite(under)?)),
        None => finite(text),
    };
    let good = found.ok().filter(|v| (0.0..=10.0).contains(v));
    good.ok_or_else(|| "expected seconds from 0 to 10, as 1/50".into())
}

fn no_less_than_0(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| *v >= 0.0).ok_or_else(|| "expected 0 or more".into())
}

fn positive(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| *v > 0.0).ok_or_else(|| "expected a number above 0".into())
}

fn degrees(text: &str) -> Result<f32, String> {
    finite(text)
        .ok()
        .filter(|v| (0.1..=170.0).contains(v))
        .ok_or_else(|| "expected degrees from 0.1 to 170".into())
}

fn vector(text: &str) -> Result<[f32; 3], String> {
    let parts: Vec<f32> = text.split(',').map(finite).collect::<Result<_, _>>()?;
    parts.try_into().map_err(|_| "expected three numbers X,Y,Z".into())
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let bad = || "expected WIDTHxHEIGHT in pixels, such as 1280x720".to_string();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(bad)?;
    let number = |t: &str| t.trim().parse::<u32>().ok().filter(|n| *n > 0).ok_or_else(bad);
    Ok((number(width)?, number(height)?))
}

fn times_as_large(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| [1, 2, 4].contains(n)).ok_or_else(|| "expected 1, 2 or 4".into())
}

fn rule(text: &str) -> Result<Rule, String> {
    match text {
        "source" => Ok(Rule::Source),
        "constant-width" => Ok(Rule::ConstantWidth),
        _ => text
            .strip_prefix("fixed:")
            .and_then(|n| n.parse().ok())
            .map(Rule::Fixed)
            .ok_or_else(|| "expected source, constant-width, or fixed:N with a number".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }

    #[test]
    fn values_are_parsed() {
        assert_eq!(size("3x2"), Ok((3, 2)));
        assert!(size("0x2").is_err() && size("12").is_err());
        assert_eq!(times_as_large("4"), Ok(4));
        assert!(times_as_large("0").is_err() && times_as_large("3").is_err());
        assert_eq!(foaming("80"), Ok(Foaming::From(80.0)));
        assert_eq!((exposure("auto"), exposure("-1.5")), (Ok(0.0), Ok(-1.5)));
        assert!(exposure("bright").is_err());
        assert!(foaming("-1").is_err() && foaming("much").is_err());
        assert_eq!(vector("1,-2, 3e1"), Ok([1.0, -2.0, 30.0]));
        assert!(vector("1,2").is_err() && vector("1,2,nan").is_err());
        assert_eq!(turntable("auto"), Ok(Turntable::Auto));
        assert_eq!(turntable("24"), Ok(Turntable::Frames(24)));
        assert_eq!(turntable("2.5s"), Ok(Turntable::Seconds(2.5)));
        for bad in ["1", "0s", "-3", "s", "4 seconds", "1000000"] {
            assert!(turntable(bad).is_err(), "{bad}");
        }
        assert_eq!(rule("fixed:40"), Ok(Rule::Fixed(40)));
        assert!(rule("fixed:").is_err());
    }
}
