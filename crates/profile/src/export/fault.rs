//! What can be wrong with an export, or with a file that is read back or imported.

/// Why a profile cannot be exported, or why a file is not read. Messages about files complete "FILE: ".
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A DCP cannot hold the model.
    #[error("DCP cannot hold this model: {0}")]
    Unfit(#[from] DcpLimit),
    /// Not a DCP, or a damaged one.
    #[error("is not a DCP file that this program reads: {0}")]
    Dcp(#[from] DcpFault),
    /// Not an ICC profile, or a damaged one.
    #[error("is not an ICC file that this program reads: {0}")]
    Icc(#[from] IccFault),
    /// Not a Common LUT Format file, or a damaged one.
    #[error("is not a CLF file that this program reads: {0}")]
    Clf(#[from] ClfFault),
    /// Not a `.cube` file, or a damaged one.
    #[error("is not a cube file that this program reads: {0}")]
    Cube(#[from] CubeFault),
}

/// Why a DCP cannot hold a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DcpLimit {
    /// No light, or more than two.
    #[error("it has one light or two")]
    Lights,
    /// Two lights that programs could not interpolate between.
    #[error("its two lights would have the same temperature; choose one")]
    SameTemperature,
    /// A model whose colours change with exposure.
    #[error("its table cannot change with exposure as a plain polynomial does; export to ICC")]
    ChangesWithExposure,
    /// A neutral that is no light.
    #[error("the neutral needs three numbers above 0")]
    Neutral,
    /// Colours near grey from which camera RGB cannot be told.
    #[error("its matrix near grey has no inverse")]
    NoInverse,
}

/// Why bytes are no usable DCP.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DcpFault {
    /// Other first bytes.
    #[error("it does not begin like one")]
    Begin,
    /// No name of a camera.
    #[error("it names no camera")]
    NoCamera,
    /// Matrices or tables that are missing or broken.
    #[error("it lacks a color matrix or has an unusable one or table")]
    Light,
    /// Matrices and tables that are whole but make no colours.
    #[error("its matrices and tables give no usable colours")]
    NoColours,
}

/// Why bytes are no usable ICC profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum IccFault {
    /// A profile between other spaces, or none.
    #[error("it is no profile from RGB to CIELAB")]
    Spaces,
    /// No table of the kind that is read.
    #[error("it has no table A2B0 of 16 bits behind curves")]
    NoTable,
}

/// Why a text is no usable file of the Common LUT Format.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ClfFault {
    /// Markup that does not end.
    #[error("a tag has no end")]
    OpenTag,
    /// An element that is not read.
    #[error("`{0}` is not known")]
    UnknownElement(String),
    /// An element with broken contents.
    #[error("`{0}` cannot be understood")]
    BrokenElement(String),
    /// Nothing in it.
    #[error("it has no steps")]
    NoSteps,
}

/// Why a text is no usable `.cube` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CubeFault {
    /// A line that is wrong.
    #[error("line {line}: {wrong}")]
    Line {
        /// Its number, from 1.
        line: usize,
        /// What is wrong.
        wrong: CubeLine,
    },
    /// No line with the size.
    #[error("it has no LUT_3D_SIZE")]
    NoSize,
    /// Too few or too many rows for the size.
    #[error("it has {rows} rows of numbers, not {wanted}")]
    Rows {
        /// Rows that there are.
        rows: usize,
        /// Rows that the size asks for.
        wanted: usize,
    },
    /// Infinity, or not a number.
    #[error("a number is not finite")]
    NotFinite,
}

/// What is wrong with a line of a `.cube` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CubeLine {
    /// A table that is too small or too large.
    #[error("this size of table is not known")]
    Size,
    /// Three words that are no numbers.
    #[error("there should be three numbers")]
    NotNumbers,
    /// Something else.
    #[error("it is not known what this means")]
    Unknown,
}
