//! Output: results to standard output, everything else to standard error.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write, stderr, stdout};

use crate::failure::{Failure, Kind, Outcome};

/// Writes to the standard output, at once.
///
/// A reader that has gone (`| head`) is [`Kind::Closed`], which ends the program without a word.
pub fn print(text: Arguments<'_>) -> Outcome<()> {
    let mut to = stdout().lock();
    to.write_fmt(text).and_then(|()| to.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::new(Kind::Closed, ""),
        _ => Failure::writing("the standard output".as_ref(), &error),
    })
}

/// A line for the user. Where it cannot be written nothing is lost but the line.
pub fn note(text: Arguments<'_>) {
    let _ = writeln!(stderr(), "whitewater: {text}");
}
