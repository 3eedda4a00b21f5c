//! Hints for batches and watched folders.

use std::error::Error;

/// What to do about an error of a batch.
pub(super) fn hint(_error: &(dyn Error + 'static)) -> Option<String> {
    None
}
