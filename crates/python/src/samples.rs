//! The sensor's samples as memory that NumPy looks at, not copies.

use std::sync::Arc;

use darkroot_photo::{Capture, Counts, Layout};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Holds the samples of a photograph for NumPy.
///
/// It has NumPy's array interface: ``numpy.asarray(samples)`` is a read-only view of the memory that the photograph itself
/// uses, and keeps it alive. :attr:`Photo.mosaic` is that view.
#[pyclass(module = "darkroot", frozen)]
pub(crate) struct Samples(pub(crate) Arc<Capture>);

#[pymethods]
impl Samples {
    /// NumPy's array interface, version 3. The address is that of samples that nobody changes and that live as long as this
    /// object, which NumPy keeps.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let little = cfg!(target_endian = "little");
        let (address, kind) = match &self.0.counts {
            Counts::U16(mosaic) => (mosaic.samples.as_ptr() as usize, if little { "<u2" } else { ">u2" }),
            Counts::F32(mosaic) => (mosaic.samples.as_ptr() as usize, if little { "<f4" } else { ">f4" }),
        };
        let size = self.0.counts.size();
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", kind)?;
        interface.set_item("data", (address, true))?;
        match self.0.counts.layout() {
            Layout::Rgb => interface.set_item("shape", (size.height, size.width, 3))?,
            Layout::Cfa(_) | Layout::Monochrome => interface.set_item("shape", (size.height, size.width))?,
        }
        Ok(interface)
    }
}
