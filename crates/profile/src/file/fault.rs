//! What can be wrong with one calibration of a profile file. Each message completes "has an unusable calibration for
//! LIGHT: ".

use crate::Kind;
use crate::kind::UnknownKind;

/// Why sensitivities cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SensitivitiesFault {
    /// Another number of samples.
    #[error("a channel has {0} numbers, not the 41 of 380 to 780 nm every 10 nm")]
    Count(usize),
    /// Values that no camera has.
    #[error("a value is not a finite number, or a channel sees nothing")]
    Blind,
}

/// Why a calibration cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationFault {
    /// A value that is infinite or no number.
    #[error("{}a value is not a finite number", place.as_ref().map_or_else(String::new, |p| format!("{p}: ")))]
    NotFinite {
        /// Where it stands, if that is known.
        place: Option<String>,
    },
    /// A model that this program does not know.
    #[error(transparent)]
    Kind(#[from] UnknownKind),
    /// Parts of another model.
    #[error("it does not have the parts of the model `{0}`, or has others")]
    Parts(Kind),
    /// A white that no light has.
    #[error("xy = [{}, {}] is no chromaticity of a light", .0[0], .0[1])]
    Chromaticity([f64; 2]),
    /// A temperature that is not that of the white.
    #[error("kelvin = {kelvin} is not the colour temperature of its xy, {own:.0}")]
    Kelvin {
        /// As it stands in the file.
        kelvin: f64,
        /// That of the white.
        own: f64,
    },
    /// An order of root polynomials that does not exist.
    #[error("there is no order {0}")]
    Order(u8),
    /// The order is not given.
    #[error("`order` is missing")]
    NoOrder,
    /// A polynomial of a model that has none.
    #[error("the model `{0}` has no [calibration.polynomial]")]
    NoPolynomial(Kind),
    /// A term that is not given.
    #[error("term `{0}` is missing")]
    MissingTerm(String),
    /// A term of another order or degree.
    #[error("term `{term}` does not belong to {of}")]
    ExtraTerm {
        /// The term.
        term: String,
        /// The order or degree.
        of: String,
    },
    /// A matrix that is none.
    #[error("a matrix of hue_plane has {0} values, not 9 numbers")]
    Matrix(usize),
    /// A number of matrices that does not divide the hues.
    #[error("hue_plane has {0} matrices (6, 12, 18 ... are needed) or a value is not a finite number")]
    Matrices(usize),
    /// A centre of a residual without colour.
    #[error("a centre of residual has no chromaticity or a value is not a finite number")]
    Centre,
}

impl CalibrationFault {
    /// A value that is not finite, somewhere.
    pub(super) const SOMEWHERE: Self = Self::NotFinite { place: None };
}
