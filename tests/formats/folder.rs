//! A temporary folder that is removed at the end of a test.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

pub struct Folder(PathBuf);

impl Folder {
    /// Creates a new folder: a test that was killed leaves its folder, and a later process may get
    /// the same id.
    pub fn new(name: &str) -> Self {
        for attempt in 0.. {
            let name = format!("whitewater-{name}-{}-{attempt}", std::process::id());
            let path = std::env::temp_dir().join(name);
            match std::fs::create_dir(&path) {
                Ok(()) => return Self(path),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => panic!("{}: {error}", path.display()),
            }
        }
        unreachable!("some name is free")
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file, and creates the folders of its path.
    pub fn put(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn what_another_test_left_is_not_there() {
    let left = Folder::new("left");
    left.put("a.csv", b"x");
    let own = Folder::new("left");
    assert_ne!(own.path(), left.path());
    assert_eq!(std::fs::read_dir(own.path()).unwrap().count(), 0);
}
