//! The Python package `darkroot`: what Python says becomes calls of the library, and what comes back becomes arrays.
//!
//! Users see the package `python/darkroot`, which takes most of this as it is. Each file here is one noun of it. Work runs in
//! `run.rs`, without Python's lock and with an ear for Ctrl-C; what Python names as settings becomes texts of the table of
//! settings in `settings.rs`; errors of the library become exceptions in `fault.rs`.
//!
//! **What it does not do:** it develops nothing itself, opens no files but through the library, and has no unsafe code:
//! arrays that share memory with a photograph go by NumPy's array interface (`samples.rs`).

mod batch;
mod cancel;
mod chart;
mod fault;
mod files;
mod fit;
mod json;
mod opened;
mod order;
mod photo;
mod picture;
mod profile;
mod recipe;
mod run;
mod samples;
mod settings;
mod store;

/// What `darkroot` consists of; see the package.
#[pyo3::pymodule]
mod _core {
    use numpy::PyArray1;
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::batch::{batch, endings};
    #[pymodule_export]
    use crate::cancel::Cancel;
    #[pymodule_export]
    use crate::chart::{detect_charts, make_profile, measure_chart, verify_picture, verify_shot};
    #[pymodule_export]
    use crate::files::{abandon, develop_file, inspect};
    #[pymodule_export]
    use crate::fit::{fit_profile, from_matrix, from_sensitivities, from_spectra_file};
    #[pymodule_export]
    use crate::photo::Photo;
    #[pymodule_export]
    use crate::profile::Profile;
    #[pymodule_export]
    use crate::recipe::Recipe;
    #[pymodule_export]
    use crate::samples::Samples;
    #[pymodule_export]
    use crate::settings::describe;

    #[pymodule_export]
    #[allow(non_upper_case_globals)] // Python's own name for it.
    const __version__: &str = darkroot::VERSION;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        darkroot::keep_decoders_quiet();
        // NumPy's functions are looked up now: later, Ctrl-C could come in between.
        module.py().import("numpy")?;
        drop(PyArray1::<u8>::from_vec(module.py(), Vec::new()));
        Ok(())
    }
}
