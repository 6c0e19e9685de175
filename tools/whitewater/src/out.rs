//! Output: results to standard output, everything else to standard error.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write, stderr, stdout};

use crate::failure::{Failure, Kind, Outcome};

/// Writes to standard output and flushes.
///
/// If the reader has closed the pipe (`| head`), the error is [`Kind::Closed`], and the program ends with code 0 and
/// without a message.
pub fn print(text: Arguments<'_>) -> Outcome<()> {
    let mut to = stdout().lock();
    to.write_fmt(text).and_then(|()| to.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::new(Kind::Closed, ""),
        _ => Failure::writing("the standard output".as_ref(), &error),
    })
}

/// Prints a line for the user on stderr. If that fails, only the line is lost.
pub fn note(text: Arguments<'_>) {
    let _ = writeln!(stderr(), "whitewater: {text}");
}
