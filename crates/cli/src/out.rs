//! What the program says: the only ways to stdout and stderr. Texts from outside cannot order a terminal about.

use std::fmt;
use std::io::{self, Write};

/// Words for a person, on stderr. That nobody reads them any more must not stop the work.
pub(crate) fn say(words: fmt::Arguments<'_>) {
    let _ = writeln!(io::stderr(), "{}", darkroot::lines(&words.to_string()));
}

/// Lines for a person, on stdout.
pub(crate) fn lines() -> Stdout {
    Stdout(darkroot::lines)
}

/// JSON on stdout.
pub(crate) fn json() -> Stdout {
    Stdout(darkroot::json_lines)
}

/// Text on stdout in which nothing is from outside.
pub(crate) fn ours() -> Stdout {
    Stdout(str::to_owned)
}

/// Standard output, with how texts are written to it. What goes wrong is told as [`NoStdout`].
pub(crate) struct Stdout(fn(&str) -> String);

impl Write for Stdout {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = (self.0)(&String::from_utf8_lossy(bytes));
        io::stdout().write_all(text.as_bytes()).map_err(NoStdout::of)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stdout().flush().map_err(NoStdout::of)
    }
}

/// Standard output takes no more.
#[derive(Debug)]
pub(crate) struct NoStdout(io::Error);

impl NoStdout {
    fn of(error: io::Error) -> io::Error {
        io::Error::new(error.kind(), Self(error))
    }

    /// What of an error says so, if it does.
    pub(crate) fn within<'e>(error: &'e (dyn std::error::Error + 'static)) -> Option<&'e Self> {
        error.downcast_ref::<io::Error>()?.get_ref()?.downcast_ref()
    }
}

impl fmt::Display for NoStdout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "standard output cannot be written: {}", self.0)
    }
}

impl std::error::Error for NoStdout {}

/// Writes what is still held back, at the end.
///
/// # Errors
/// Nobody can take it.
pub(crate) fn finish() -> io::Result<()> {
    io::stdout().flush().map_err(NoStdout::of)
}
