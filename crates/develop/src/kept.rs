//! A view that is rendered again and again while a setting moves: its camera RGB is kept, so that only the stages of single
//! pixels are done anew where the setting reaches no other.

use std::sync::{Arc, Mutex, PoisonError};

use darkroot_photo::{CameraSpace, Rgb};

use crate::base::Base;
use crate::view::View;

/// Balanced camera RGB of the view that was rendered last with it ([`crate::Plan::render_again`]): of exposure, colours, tone and
/// look it knows nothing. One view of at most [`Kept::LARGEST`] pixels, 12 bytes each.
#[derive(Debug, Default)]
pub struct Kept(Mutex<Option<Arc<Last>>>);

#[derive(Debug)]
pub(crate) struct Last {
    pub(crate) base: Base,
    pub(crate) view: View,
    pub(crate) camera: Rgb<CameraSpace>,
}

impl Kept {
    /// Pixels of the largest view that is kept; of a larger one nothing is.
    pub const LARGEST: usize = 8_000_000;

    /// Whether no view was rendered yet.
    pub fn is_empty(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_none()
    }

    /// What is kept of a view, if it is of the same base.
    pub(crate) fn of(&self, base: &Base, view: View) -> Option<Arc<Last>> {
        let last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        last.as_ref().filter(|last| last.view == view && last.base == *base).map(Arc::clone)
    }

    pub(crate) fn put(&self, last: Last) -> Arc<Last> {
        let last = Arc::new(last);
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::clone(&last));
        last
    }
}
