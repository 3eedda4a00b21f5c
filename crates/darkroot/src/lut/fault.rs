//! What can be wrong with a file of a table.

use crate::quoted;

/// Why a text is no table that can be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LutFault {
    /// A line of a `.cube` file that is none.
    #[error("line {line} is none of a .cube file: `{}`", quoted(text))]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// The line.
        text: String,
    },
    /// A `.cube` file without a size.
    #[error("is no table: a .cube file says LUT_3D_SIZE or LUT_1D_SIZE, a CLF file begins with ProcessList")]
    NoSize,
    /// A size that no table has.
    #[error("has a table of {size} entries along a side; {least} to {most} can be used")]
    Size {
        /// What the file says.
        size: String,
        /// The least that can be used.
        least: usize,
        /// The most that can be used.
        most: usize,
    },
    /// Other numbers of rows than the sizes say.
    #[error("has {rows} rows of numbers, and its size asks for {wanted}; the file may be cut off")]
    Rows {
        /// Rows found.
        rows: usize,
        /// Rows that the sizes ask for.
        wanted: usize,
    },
    /// Numbers or ranges that no table can have.
    #[error("has a table whose numbers or range are none")]
    Numbers,
    /// Text that is no XML.
    #[error("is no XML that can be read: {message}")]
    Xml {
        /// What the reader says.
        message: String,
    },
    /// XML that is no CLF.
    #[error("is no CLF file: it begins with `{}` where ProcessList should stand", quoted(root))]
    NoProcess {
        /// Its first element.
        root: String,
    },
    /// A step that CLF does not have.
    #[error("has a step `{}` that CLF does not have", quoted(element))]
    Step {
        /// The element.
        element: String,
    },
    /// Something of a step that is missing or no value.
    #[error("has a step {step} whose `{part}` is missing or no value of it")]
    Part {
        /// The element.
        step: &'static str,
        /// What of it.
        part: &'static str,
    },
    /// More steps than a picture has time for.
    #[error("has {count} steps; {most} can be used")]
    Steps {
        /// Steps found.
        count: usize,
        /// The most that can be used.
        most: usize,
    },
    /// No step at all.
    #[error("holds no step")]
    Empty,
}
