//! Hints for charts, profiles and what is judged by them.

use std::error::Error;

/// What to do about an error of a chart job.
pub(super) fn hint(_error: &(dyn Error + 'static)) -> Option<String> {
    None
}
