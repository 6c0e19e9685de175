//! Files out: under a temporary name in the same folder, then renamed. Ctrl-C leaves none behind.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::failure::{Failure, Kind, Outcome};
use crate::out;

/// Temporary files there are now. What Ctrl-C has to remove; the lock is held while one is renamed.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn temporary() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What Ctrl-C does first: writes what was measured until then.
type Last = Box<dyn FnOnce() -> Outcome<()> + Send>;
static LAST: Mutex<Option<Last>> = Mutex::new(None);

/// Has Ctrl-C do this before it ends the program; nothing else that was set so.
pub fn at_interrupt(last: impl FnOnce() -> Outcome<()> + Send + 'static) {
    *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(last));
}

/// Does at the end what Ctrl-C would have done, so that it is done once.
pub fn at_end() -> Outcome<()> {
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    last.take().map_or(Ok(()), |last| last())
}

/// From here on Ctrl-C (and SIGTERM) removes what is half written, and ends with code 130.
pub fn clean_up_on_interrupt() {
    // Without a handler the system's own holds: a half file may stay, and nothing else is lost.
    let _ = ctrlc::set_handler(|| {
        if let Err(failure) = at_end() {
            out::note(format_args!("{}", failure.message));
        }
        let files = temporary();
        for file in files.iter() {
            let _ = std::fs::remove_file(file);
        }
        out::note(format_args!("interrupted; finished files are kept"));
        // The lock is still held: no other thread renames or makes a file now.
        std::process::exit(130);
    });
}

/// Takes a temporary file away where writing failed; after the renaming there is none.
struct Guard(PathBuf);

impl Guard {
    fn new(path: &Path) -> io::Result<(Self, File)> {
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let path = path.with_file_name(format!(".{name}.{}.tmp", std::process::id()));
        let mut files = temporary();
        let file = OpenOptions::new().write(true).create(true).truncate(true).open(&path)?;
        files.push(path.clone());
        Ok((Self(path), file))
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        let mut files = temporary();
        let _ = std::fs::remove_file(&self.0);
        files.retain(|file| *file != self.0);
    }
}

/// Writes a file as a whole or not at all. What is no regular file (`/dev/stdout`, a link to a device) is written
/// to as it is.
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

/// Fails where a file could not be written, before time is spent on what shall be in it.
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

/// Kinds of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    Exr,
    Png,
}

/// Where pictures go.
#[derive(Clone, Debug)]
pub struct Target {
    pattern: PathBuf,
    pub format: PictureFormat,
    sequence: bool,
}

impl Target {
    /// Understands the name of an output; `sequence`: there is more than one frame.
    pub fn new(pattern: &Path, sequence: bool) -> Outcome<Self> {
        let extension = pattern.extension().map(|e| e.to_string_lossy().to_lowercase());
        let format = match extension.as_deref() {
            Some("exr") => PictureFormat::Exr,
            Some("png") => PictureFormat::Png,
            _ => {
                let pattern = pattern.display();
                return Err(Failure::usage(format!(
                    "expected an output that ends in .exr or .png, found {pattern}; rename it"
                )));
            }
        };
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

    /// True where each frame has a file of its own.
    pub fn is_numbered(&self) -> bool {
        self.sequence || self.name().contains('%')
    }

    /// The file of a frame.
    pub fn path(&self, frame: u64) -> PathBuf {
        let name = self.name();
        if let Some((before, width, after)) = number_field(&name) {
            return self.pattern.with_file_name(format!("{before}{frame:0width$}{after}"));
        }
        match (self.sequence, name.rsplit_once('.')) {
            (true, Some((stem, extension))) => {
                self.pattern.with_file_name(format!("{stem}.{frame:04}.{extension}"))
            }
            _ => self.pattern.clone(),
        }
    }
}

/// Text before, width and text after the one `%d` or `%04d`.
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
        assert_eq!(path("a/out_%06d.png", true), "a/out_000007.png");
        assert_eq!(path("a/out_%d.png", false), "a/out_7.png");
        for bad in ["out.jpg", "out", "o%x.png", "%04d_%04d.png", "%4d.png"] {
            assert_eq!(Target::new(Path::new(bad), true).unwrap_err().kind, Kind::Usage, "{bad}");
        }
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
