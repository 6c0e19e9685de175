//! Says that a test did not run.

use std::io::Write;

/// Past the harness, which keeps what passing tests print: a reader sees it. A test that runs alone has the harness's name.
pub fn skipped(why: &str) {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    let _ = writeln!(std::io::stderr(), "skipped: {test}: {why}");
}
