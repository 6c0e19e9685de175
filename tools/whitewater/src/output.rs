//! Writes files under a temporary name in the same folder, then renames them. Ctrl-C removes temporary files. What a
//! killed run has left is removed by the next run that writes the same file.
//!
//! An unnamed file (O_TMPFILE) would leave nothing behind. But it can only get a name that is free, so it could not
//! replace an existing picture, and not all file systems support it.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use fs4::{FileExt, TryLockError};
use whitewater::io::particles::WriteFormat;

use crate::failure::{Failure, Kind, Outcome};
use crate::out;

/// Existing temporary files, which Ctrl-C has to remove. The lock is also held while a file gets its final name.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn temporary() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A last action of Ctrl-C, which writes the measurements so far.
type Last = Box<dyn FnOnce() -> Outcome<()> + Send>;
static LAST: Mutex<Option<Last>> = Mutex::new(None);

/// Sets the last action of Ctrl-C, in place of an earlier one.
pub fn at_interrupt(last: impl FnOnce() -> Outcome<()> + Send + 'static) {
    *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(last));
}

/// Runs the action that [`at_interrupt`] has set, at the end of the program, and clears it, so that it runs only
/// once.
pub fn at_end() -> Outcome<()> {
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    last.take().map_or(Ok(()), |last| last())
}

/// Installs the handler: Ctrl-C and SIGTERM remove unfinished files and end the program with code 130.
pub fn clean_up_on_interrupt() {
    // If the handler cannot be installed, Ctrl-C ends the program without it: a partial file may remain, and nothing
    // else is lost.
    let _ = ctrlc::set_handler(|| {
        if let Err(failure) = at_end() {
            out::note(format_args!("{}", failure.message));
        }
        let files = temporary();
        for file in files.iter() {
            let _ = std::fs::remove_file(file);
        }
        out::note(format_args!("interrupted; finished files are kept"));
        // The lock is still held, so no other thread renames or creates a file. Standard output needs no flush here,
        // because `out` flushes after each write; and a flush could wait, because another thread may hold standard
        // output.
        end(130);
    });
}

/// Ends the process immediately. Threads of the driver may still run, and an ordinary exit would destroy data of the
/// driver and the validation layers while these threads use it.
fn end(code: i32) -> ! {
    #[cfg(unix)]
    // SAFETY: it ends this process, and nothing runs after it.
    unsafe {
        libc::_exit(code)
    }
    #[cfg(not(unix))]
    std::process::exit(code)
}

/// Removes the temporary file with this path when dropped, in case writing failed; after the rename it no longer
/// exists.
struct Guard(PathBuf);

impl Guard {
    /// Creates a temporary file for `path`. It stays locked while open, so that other runs know that it is in use.
    fn new(path: &Path) -> io::Result<(Self, File)> {
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        sweep(path, &name);
        let process = std::process::id();
        let mut files = temporary();
        // A name may be in use by another run with the same process number: a killed one, or one on another machine.
        for number in 0..100 {
            let path = path.with_file_name(format!(".{name}.{process}.{number}.tmp"));
            let file = match OpenOptions::new().write(true).create_new(true).open(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                opened => opened?,
            };
            // Until the lock is taken, another run may mistake the file for a leftover and remove it. On a file
            // system without locks no run removes leftovers.
            let locked = !matches!(FileExt::try_lock(&file), Err(TryLockError::WouldBlock));
            if locked && path.exists() {
                files.push(path.clone());
                return Ok((Self(path), file));
            }
        }
        Err(io::Error::other("no name is free for its temporary file"))
    }
}

/// Removes temporary files of `path` that no run has locked; the runs that made them were killed.
fn sweep(path: &Path, name: &str) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new("."))).into_iter().flatten();
    for entry in entries.flatten() {
        let regular = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !regular || !is_temporary(&entry.file_name().to_string_lossy(), name) {
            continue;
        }
        // Opened for writing, because some file systems grant locks only then.
        let file = OpenOptions::new().write(true).open(entry.path());
        if file.is_ok_and(|file| FileExt::try_lock(&file).is_ok()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Whether a file name is that of a temporary file of `of`.
fn is_temporary(name: &str, of: &str) -> bool {
    let numbers = name
        .strip_prefix('.')
        .and_then(|name| name.strip_prefix(of))
        .and_then(|rest| rest.strip_prefix('.'))
        .and_then(|rest| rest.strip_suffix(".tmp"))
        .and_then(|rest| rest.split_once('.'));
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    numbers.is_some_and(|(process, number)| digits(process) && digits(number))
}

impl Drop for Guard {
    fn drop(&mut self) {
        let mut files = temporary();
        let _ = std::fs::remove_file(&self.0);
        files.retain(|file| *file != self.0);
    }
}

/// Writes a file as a whole or not at all. Special files (`/dev/stdout`, or a link to a device) are written directly.
pub fn write(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Outcome<()> {
    write_io(path, content).map_err(|error| Failure::writing(path, &error))
}

fn write_io(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    // A link is followed: its target is what the user means to write.
    let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    match std::fs::metadata(&path) {
        Ok(found) if found.is_dir() => return Err(io::Error::other("it is a directory")),
        Ok(found) if !found.is_file() => {
            let mut to = BufWriter::new(OpenOptions::new().write(true).open(&path)?);
            content(&mut to)?;
            return to.flush();
        }
        _ => {}
    }
    let (guard, file) = Guard::new(&path)?;
    let mut to = BufWriter::with_capacity(1 << 20, file);
    content(&mut to)?;
    to.flush()?;
    // Some file systems report a full disk only here.
    to.get_ref().sync_all()?;
    let lock = temporary();
    let renamed = std::fs::rename(&guard.0, &path);
    drop(lock);
    renamed
}

/// Fails early if a file cannot be written, before time is spent on its contents.
pub fn probe(path: &Path) -> Outcome<()> {
    let fail = |error: io::Error| Failure::writing(path, &error);
    match std::fs::metadata(path) {
        Ok(found) if found.is_dir() => {
            let path = path.display();
            return Err(Failure::new(
                Kind::Output,
                format!("{path} is a directory; name a file such as {path}/water.exr"),
            ));
        }
        Ok(found) if !found.is_file() => return Ok(()),
        _ => {}
    }
    let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    Guard::new(&path).map(drop).map_err(fail)
}

/// Picture formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    Exr,
    Png,
}

impl PictureFormat {
    /// The format for a file extension.
    fn of(name: &Path) -> Option<Self> {
        match name.extension()?.to_string_lossy().to_lowercase().as_str() {
            "exr" => Some(Self::Exr),
            "png" => Some(Self::Png),
            _ => None,
        }
    }
}

fn no_such(pattern: &Path, endings: &str) -> Failure {
    let pattern = pattern.display();
    Failure::usage(format!("expected an output that ends in {endings}, found {pattern}; rename it"))
}

/// What the frames are written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// One file per frame.
    Picture(PictureFormat),
    /// One file for all frames.
    Film,
}

/// Output files of each frame: pictures, or particles.
#[derive(Clone, Debug)]
pub struct Target<F = PictureFormat> {
    pattern: PathBuf,
    pub format: F,
    sequence: bool,
}

impl Target<WriteFormat> {
    /// The same for particles.
    pub fn of_particles(pattern: &Path, sequence: bool) -> Outcome<Self> {
        let Some(format) = WriteFormat::from_path(pattern) else {
            let pattern = pattern.display();
            return Err(Failure::usage(format!(
                "expected particles in .bgeo, .bgeo.gz, .vtu, .ply or .npz, found {pattern}; rename it"
            )));
        };
        Self::named(pattern, format, sequence)
    }
}

impl Target {
    /// Target for pictures of this name, possibly with a frame number `%04d`. `sequence`: whether there are several
    /// frames.
    pub fn new(pattern: &Path, sequence: bool) -> Outcome<Self> {
        let Some(format) = PictureFormat::of(pattern) else {
            return Err(no_such(pattern, ".exr or .png"));
        };
        Self::named(pattern, format, sequence)
    }
}

impl Target<Output> {
    /// The same for outputs that may also be a film.
    pub fn of_frames(pattern: &Path, sequence: bool) -> Outcome<Self> {
        let film = pattern.extension().is_some_and(|end| end.eq_ignore_ascii_case("mp4"));
        if !film {
            let Some(format) = PictureFormat::of(pattern) else {
                return Err(no_such(pattern, ".exr, .png or .mp4"));
            };
            let Target { pattern, format, sequence } = Target::named(pattern, format, sequence)?;
            return Ok(Self { pattern, format: Output::Picture(format), sequence });
        }
        let target = Self { pattern: pattern.to_path_buf(), format: Output::Film, sequence: false };
        if target.name().contains('%') {
            return Err(Failure::usage(format!(
                "expected one .mp4 for all frames, found {}; rename it without %",
                pattern.display()
            )));
        }
        Ok(target)
    }
}

impl<F> Target<F> {
    fn named(pattern: &Path, format: F, sequence: bool) -> Outcome<Self> {
        let target = Self { pattern: pattern.to_path_buf(), format, sequence };
        let name = target.name();
        if name.contains('%') && number_field(&name).is_none() {
            return Err(Failure::usage(format!(
                "expected one frame number such as %04d in {name}, found another use of %; rename it"
            )));
        }
        Ok(target)
    }

    fn name(&self) -> String {
        self.pattern.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default()
    }

    /// Whether each frame has its own file.
    pub fn is_numbered(&self) -> bool {
        self.sequence || self.name().contains('%')
    }

    /// Whether the file of a frame exists and is not empty.
    pub fn is_written(&self, frame: u64) -> bool {
        std::fs::metadata(self.path(frame)).is_ok_and(|file| file.len() > 0)
    }

    /// The file of a frame.
    pub fn path(&self, frame: u64) -> PathBuf {
        let name = self.name();
        if let Some((before, width, after)) = number_field(&name) {
            return self.pattern.with_file_name(format!("{before}{frame:0width$}{after}"));
        }
        let packed = name.to_lowercase().ends_with(".gz");
        let (name, gz) = if packed { name.split_at(name.len() - 3) } else { (&name[..], "") };
        match (self.sequence, name.rsplit_once('.')) {
            (true, Some((stem, extension))) => {
                self.pattern.with_file_name(format!("{stem}.{frame:04}.{extension}{gz}"))
            }
            _ => self.pattern.clone(),
        }
    }
}

/// Splits a name at its only `%d` or `%0Nd` (N at most 20): the text before, the width (0 for `%d`), the text after.
/// `None` for any other use of `%`, or none.
fn number_field(name: &str) -> Option<(&str, usize, &str)> {
    let (before, rest) = name.split_once('%')?;
    let (spec, after) = rest.split_once('d')?;
    let width = match spec {
        "" => 0,
        spec => spec.strip_prefix('0')?.parse().ok().filter(|w| *w <= 20)?,
    };
    (!after.contains('%')).then_some((before, width, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_get_their_numbers() {
        let path = |name: &str, sequence| {
            Target::new(Path::new(name), sequence).unwrap().path(7).display().to_string()
        };
        assert_eq!(path("a/out.exr", false), "a/out.exr");
        assert_eq!(path("a/out.exr", true), "a/out.0007.exr");
        let made = Target::of_particles(Path::new("made.bgeo.gz"), true).unwrap().path(7);
        assert_eq!(made.display().to_string(), "made.0007.bgeo.gz");
        assert_eq!(path("a/out_%06d.png", true), "a/out_000007.png");
        assert_eq!(path("a/out_%d.png", false), "a/out_7.png");
        for bad in ["out.mp4", "out.jpg", "out", "o%x.png", "%04d_%04d.png", "%4d.png"] {
            assert_eq!(Target::new(Path::new(bad), true).unwrap_err().kind, Kind::Usage, "{bad}");
        }
    }

    #[test]
    fn a_film_is_one_file() {
        let film = Target::of_frames(Path::new("a/out.MP4"), true).unwrap();
        assert_eq!((film.format, film.is_numbered()), (Output::Film, false));
        assert_eq!(film.path(7), Path::new("a/out.MP4"));
        let picture = Target::of_frames(Path::new("out.png"), true).unwrap();
        assert_eq!(picture.format, Output::Picture(PictureFormat::Png));
        assert_eq!(picture.path(7), Path::new("out.0007.png"));
        let bad = Target::of_frames(Path::new("out_%04d.mp4"), true).unwrap_err();
        assert_eq!(bad.kind, Kind::Usage);
    }

    #[test]
    fn temporary_names_are_told_from_others() {
        for name in [".a.exr.7.0.tmp", ".a.exr.4194304.12.tmp"] {
            assert!(is_temporary(name, "a.exr"), "{name}");
        }
        let others = [
            "a.exr",
            ".a.exr.tmp",
            ".a.exr.7.tmp",
            ".a.exr..0.tmp",
            ".a.exr.7.0",
            ".a.exr.x.0.tmp",
            ".a.exr.7.0.1.tmp",
            "a.exr.7.0.tmp",
            ".b.exr.7.0.tmp",
            ".a.exr.png.7.0.tmp",
        ];
        for name in others {
            assert!(!is_temporary(name, "a.exr"), "{name}");
        }
    }

    #[test]
    fn only_leftovers_of_the_same_file_are_swept() {
        let folder = tempfile::tempdir().unwrap();
        let leftovers = [".a.txt.1.0.tmp", ".a.txt.4194304.3.tmp"];
        // A name that no temporary file has, a temporary file of another file, and one that is in use.
        let others = [".a.txt.notes.tmp", ".b.txt.1.0.tmp", ".a.txt.2.0.tmp"];
        for name in leftovers.iter().chain(&others) {
            std::fs::write(folder.path().join(name), "half").unwrap();
        }
        std::fs::create_dir(folder.path().join(".a.txt.5.0.tmp")).unwrap();
        let used = File::open(folder.path().join(".a.txt.2.0.tmp")).unwrap();
        FileExt::try_lock(&used).unwrap();
        write(&folder.path().join("a.txt"), |to| to.write_all(b"one")).unwrap();
        for name in leftovers {
            assert!(!folder.path().join(name).exists(), "{name}");
        }
        for name in others.into_iter().chain([".a.txt.5.0.tmp", "a.txt"]) {
            assert!(folder.path().join(name).exists(), "{name}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 5);
    }

    #[test]
    fn a_failed_write_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write(&path, |to| to.write_all(b"one")).unwrap();
        let failure = write(&path, |to| {
            to.write_all(b"two")?;
            Err(io::Error::other("no"))
        });
        assert_eq!(failure.unwrap_err().kind, Kind::Output);
        assert_eq!(std::fs::read(&path).unwrap(), b"one");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
