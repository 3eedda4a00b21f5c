//! From the light of a chart's shot to a calibration: patches, checks, corrections, fits, cross-validation.
//!
//! The order of the work is the order of the modules. [`shot`] measures the patches and [`corrections`] takes out what
//! the patches themselves show of uneven light and glare; [`gates`] say whether the shot is good enough; [`series`] makes
//! one measurement of several shots; [`fit`] fits every model, compares them on patches that they have not seen and takes
//! the best; [`judge`] holds a finished profile against a new shot; [`known_camera`] needs no shot, but a camera whose
//! spectral sensitivities are known.
//!
//! **What it does not do:** it reads no files, knows no paths and finds no charts. Light of the sensor, the chart and
//! where it stands come from the caller.

pub mod light;
pub use light::LightSource;

pub mod patch;
pub use patch::{JudgedPatch, MeasuredPatch};

pub mod shot;
pub use shot::{Chart, ShotError};

pub mod corrections;
pub use corrections::{Correct, CrossValidation};

pub mod gates;
pub use gates::{Finding, Gate, Verdict};

pub mod series;

pub mod reference;

mod balanced;
pub use balanced::{white_of, white_under};

mod compare;
pub use compare::{Compared, EXPOSURES};

pub mod fit;
pub use fit::{CalibrateError, Calibrated, calibrate};

pub mod known_camera;

pub mod delivery;

pub mod judge;

pub mod plot;
