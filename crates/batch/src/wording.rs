//! How errors are worded for people: the business of the program that shows them.

use std::error::Error;
use std::fmt;
use std::sync::Arc;

/// A program's way to word an error. Libraries say what is wrong; a program may add what to do in its own terms,
/// such as the name of an option or of a button. The default is the error's own text.
#[derive(Clone)]
pub struct Wording(Arc<Words>);

/// An error to words.
type Words = dyn Fn(&(dyn Error + 'static)) -> String + Send + Sync;

impl Wording {
    /// By this function.
    pub fn new(words: impl Fn(&(dyn Error + 'static)) -> String + Send + Sync + 'static) -> Self {
        Self(Arc::new(words))
    }

    /// The error in words.
    pub fn of(&self, error: &(dyn Error + 'static)) -> String {
        (self.0)(error)
    }
}

impl Default for Wording {
    fn default() -> Self {
        Self::new(ToString::to_string)
    }
}

impl fmt::Debug for Wording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Wording")
    }
}
