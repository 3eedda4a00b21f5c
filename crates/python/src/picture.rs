//! Finished pictures as arrays.

use darkroot_photo::{Picture, Samples};
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// The picture as an array of height x width x 3, whose memory goes over to Python without a copy.
pub(crate) fn array(py: Python<'_>, picture: Picture) -> PyResult<Bound<'_, PyAny>> {
    fn of<T: Element>(
        py: Python<'_>,
        samples: Vec<T>,
        (height, width): (usize, usize),
    ) -> PyResult<Bound<'_, PyAny>> {
        Ok(PyArray1::from_vec(py, samples).reshape([height, width, 3])?.into_any())
    }
    let size = (picture.size.height, picture.size.width);
    match picture.samples {
        Samples::U8(samples) => of(py, samples, size),
        Samples::U16(samples) => of(py, samples, size),
        Samples::F32(samples) => of(py, samples, size),
    }
}
