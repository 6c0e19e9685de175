//! Reports that a test did not run.

use std::io::Write;

/// Writes to stderr directly, because the test harness hides the output of passing tests. If only
/// one test runs, its thread has the harness's name.
pub fn skipped(why: &str) {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    let _ = writeln!(std::io::stderr(), "skipped: {test}: {why}");
}
