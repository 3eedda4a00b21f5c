//! Fits of models to colours whose camera RGB and XYZ are both known.
//!
//! Every fit is linear least squares by QR decomposition, and gives, beside the model, what each colour would have
//! been had it been left out of the fit. [`choose`] knows which fit belongs to which kind of model.

pub mod samples;
pub use samples::Samples;

pub mod least_squares;

pub mod metric;

pub mod plain;

pub mod anchored;

pub mod hue_plane;

pub mod population;

pub mod prior;

pub mod recovered;

pub mod representatives;

pub mod virtual_set;

mod folds;
mod goal;
pub mod root_set;

pub mod chromatic;

pub mod spectral;
pub use spectral::Knowledge;

pub mod white;
pub use white::white_through;

pub mod choose;
pub use choose::{Background, Candidate, fit, fit_knowing};

use darkroot_colour::Xyz;

use crate::{Errors, Figures, Kind, Model};

/// A fitted model and what it makes of colours that it has not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Balanced camera RGB to XYZ under the light of the samples.
    pub model: Model,
    /// For each sample, its XYZ by a fit without it.
    pub left_out: Vec<Xyz>,
    /// What was chosen inside the fit, in words ("order 4, ridge 0.001, anchors 0.0001"); may be empty.
    pub settings: String,
}

impl Fit {
    /// Errors on the samples and on each sample left out.
    pub fn figures(&self, samples: &Samples) -> Figures {
        let seen: Vec<Xyz> = samples.rgb().iter().map(|rgb| self.model.xyz(*rgb)).collect();
        Figures {
            training: Some(Errors::between(&seen, samples.xyz(), samples.white())),
            leave_one_out: Some(Errors::between(&self.left_out, samples.xyz(), samples.white())),
            held_out: None,
        }
    }
}

/// Why a model cannot be fitted.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Lists of different lengths, or a value that is not finite.
    #[error("the colours are not usable: {0}")]
    Samples(&'static str),
    /// Fewer colours than the model needs.
    #[error(
        "{kind} needs at least {need} colours and there are {have}; take a simpler model or a larger chart"
    )]
    TooFew {
        /// The kind of model.
        kind: Kind,
        /// Colours that it needs.
        need: usize,
        /// Colours that there are.
        have: usize,
    },
    /// The colours do not determine the model: too much alike, or all grey.
    #[error("the colours are too much alike to determine {kind}; take a chart with more colours")]
    Undetermined {
        /// The kind of model.
        kind: Kind,
    },
    /// The model needs the reflectances of the colours.
    #[error("{kind} needs the spectral reflectances of the patches; take anchored or half")]
    NoSpectra {
        /// The kind of model.
        kind: Kind,
    },
}
