//! What a person can do about an error, in words of this program: its options and commands.
//!
//! Libraries say what is wrong; they know nothing of options. A file here for each part of the program turns its
//! errors into a hint.

mod batch;
mod charts;
mod core;
pub(crate) use charts::advice;

use std::error::Error;

/// An error with its hint: `FILE: exists already; add `--overwrite` to replace it`.
pub(crate) fn words(error: &(dyn Error + 'static)) -> String {
    match of(error) {
        // Behind a list the hint has a line of its own.
        Some(hint) if error.to_string().contains('\n') => format!("{error}\n{hint}"),
        Some(hint) => format!("{error}; {hint}"),
        None => error.to_string(),
    }
}

/// The hint for an error, where there is one.
pub(crate) fn of(error: &(dyn Error + 'static)) -> Option<String> {
    batch::hint(error).or_else(|| charts::hint(error)).or_else(|| core::hint(error))
}
