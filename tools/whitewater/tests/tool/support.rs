//! A folder, particles to draw, and the program.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use whitewater::io::particles::{self, Particles, WriteFormat};
use whitewater::io::picture::{self, Layers};

/// Rest spacing of [`block`].
pub const SPACING: f32 = 0.1;

/// A test's own folder, which is removed at its end.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs the program with these arguments in this folder.
    pub fn run(&self, arguments: &str) -> Run {
        self.run_with(arguments, &[])
    }

    pub fn run_with(&self, arguments: &str, variables: &[(&str, &str)]) -> Run {
        Run(self.command(arguments).envs(variables.iter().copied()).output().unwrap())
    }

    /// The same, with standard output redirected.
    pub fn run_to(&self, arguments: &str, to: impl Into<Stdio>) -> Run {
        let child = self.command(arguments).stdout(to).stderr(Stdio::piped()).spawn();
        Run(child.unwrap().wait_with_output().unwrap())
    }

    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_whitewater"));
        command.args(arguments.split_whitespace()).current_dir(self.0.path());
        command
    }

    /// Writes particles as PLY.
    pub fn particles(&self, name: &str, positions: Vec<[f32; 3]>) {
        self.write(name, &Particles::from_positions(positions));
    }

    /// Writes frames `f_1.csv` to `f_4.csv` of a block of water that is fast in the second and third.
    pub fn water_that_is_fast_for_a_while(&self) {
        for (frame, speed) in [(1, 0.0), (2, 9.0), (3, 9.0), (4, 0.0)] {
            let mut rows = String::from("x,y,z,vx,vy,vz,id\n");
            for (i, [x, y, z]) in block(5).into_iter().enumerate() {
                rows += &format!("{x},{y},{z},{speed},0,0,{i}\n");
            }
            self.text(&format!("f_{frame}.csv"), &rows);
        }
    }

    /// Writes particles with all attributes, in the format of the name.
    pub fn write(&self, name: &str, particles: &Particles) {
        let path = self.path(name);
        particles::write(&path, particles, WriteFormat::from_path(&path).unwrap()).unwrap();
    }

    pub fn text(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    pub fn picture(&self, name: &str) -> Layers {
        picture::read(&self.path(name)).unwrap()
    }

    pub fn exists(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    /// Frame count and frame rate of a film, from its boxes (ISO 14496-12: `stsz`, `mdhd`, `stts`).
    pub fn film(&self, name: &str) -> (u32, f32) {
        let bytes = std::fs::read(self.path(name)).unwrap();
        // The word at an index after the name of a box, its version and flags.
        let word = |kind: &[u8], at: usize| {
            let found = bytes.windows(kind.len()).position(|w| w == kind).unwrap();
            let from = found + 8 + 4 * at;
            u32::from_be_bytes(bytes[from..from + 4].try_into().unwrap())
        };
        let (count, timescale) = (word(b"stsz", 1), word(b"mdhd", 2));
        let duration: u32 = (0..word(b"stts", 0) as usize)
            .map(|run| word(b"stts", 1 + 2 * run) * word(b"stts", 2 + 2 * run))
            .sum();
        let rate = count as f32 * timescale as f32 / duration as f32;
        (count, (1000.0 * rate).round() / 1000.0)
    }

    /// Names of all files, including hidden ones.
    pub fn files(&self) -> Vec<String> {
        names(self.0.path())
    }
}

pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Output of the program.
pub struct Run(pub Output);

impl Run {
    pub fn stderr(&self) -> String {
        String::from_utf8_lossy(&self.0.stderr).into_owned()
    }

    pub fn stdout(&self) -> String {
        String::from_utf8_lossy(&self.0.stdout).into_owned()
    }

    #[track_caller]
    pub fn ok(self) -> Self {
        assert_eq!(self.0.status.code(), Some(0), "{}{}", self.stdout(), self.stderr());
        self
    }

    /// The command line was not understood.
    #[track_caller]
    pub fn fails_at_once(self) {
        assert_eq!(self.0.status.code(), Some(2), "{}{}", self.stdout(), self.stderr());
    }

    /// Asserts this exit code, and that the last line has these parts.
    #[track_caller]
    pub fn fails(self, code: i32, parts: &[&str]) -> Self {
        let text = self.stderr();
        assert_eq!(self.0.status.code(), Some(code), "{}{text}", self.stdout());
        let last = text.lines().last().unwrap_or_default();
        assert!(last.starts_with("whitewater: "), "{text}");
        for part in parts {
            assert!(last.contains(part), "'{part}' is not in: {text}");
        }
        self
    }
}

/// Whether long tests are enabled.
pub fn slow() -> bool {
    std::env::var_os("WHITEWATER_SLOW").is_some_and(|value| value == "1")
}

/// A block of water of n³ particles at rest, its lowest layer on y = 0, its middle on the y axis.
pub fn block(n: usize) -> Vec<[f32; 3]> {
    let half = 0.5 * (n - 1) as f32 * SPACING;
    (0..n * n * n)
        .map(|i| {
            let at = |i: usize| (i % n) as f32 * SPACING;
            [at(i) - half, at(i / n), at(i / n / n) - half]
        })
        .collect()
}

/// Small and fast: one sample per picture, no set, one sheet. The cost of setting up does not depend on the picture's
/// size, and a set costs as much as all else, because its light must be computed.
pub const SMALL: &str = "--size 96x64 --samples 1 --set none --sheets 1";
/// The same with all layers, on a ground.
pub const GROUND: &str = "--size 96x64 --samples 1 --scene ground";
/// The same for tests that name a scene or test the set.
pub const SIZE: &str = "--size 96x64 --samples 1";
/// A view from 2 in front of the middle of `block(8)`, straight on.
pub const FRONT: &str = "--eye 0,0.35,2.35 --target 0,0.35,0 --fov 40 --radius 0.05";
