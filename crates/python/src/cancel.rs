//! A wish to stop.

use std::sync::Arc;

use pyo3::prelude::*;

/// A wish to stop, which any thread may utter.
///
/// Give it to a call, and call :meth:`cancel` from elsewhere: the call ends within a tile and raises
/// :class:`darkroot.Cancelled`.
#[pyclass(module = "darkroot", frozen)]
#[derive(Default)]
pub(crate) struct Cancel(Arc<darkroot::Cancel>);

#[pymethods]
impl Cancel {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Ends every call that was given this.
    fn cancel(&self) {
        self.0.cancel();
    }

    /// Whether somebody cancelled.
    #[getter]
    fn cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

/// The wish that was given, or one of its own.
pub(crate) fn given(cancel: Option<&Bound<'_, Cancel>>) -> Arc<darkroot::Cancel> {
    cancel.map_or_else(Arc::default, |cancel| Arc::clone(&cancel.get().0))
}
