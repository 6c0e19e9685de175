//! Attributes without a meaning that a caller asks for by name.
//!
//! The readers decide deep inside which attributes to keep ([`names::wanted`](super::names::wanted)). The requested names
//! are therefore thread-local, and set only while one file is read.

use std::cell::RefCell;

use super::names;

thread_local! {
    /// Plain names.
    static ASKED: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// Nothing is asked for any more when it is gone, however reading ends.
struct Until(Vec<String>);

impl Drop for Until {
    fn drop(&mut self) {
        let before = std::mem::take(&mut self.0);
        ASKED.with(|asked| asked.replace(before));
    }
}

/// Reads with attributes of these names.
pub(super) fn with<T>(asked_for: &[&str], read: impl FnOnce() -> T) -> T {
    let plain = asked_for.iter().map(|name| names::plain(name)).collect();
    let _until = Until(ASKED.with(|asked| asked.replace(plain)));
    read()
}

/// Whether an attribute of this plain name is asked for.
pub(super) fn has(plain: &str) -> bool {
    ASKED.with(|asked| asked.borrow().iter().any(|name| name == plain))
}
