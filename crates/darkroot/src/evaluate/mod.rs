//! Figures that anybody can compute again from spectra: the tables of the papers, and cameras from published matrices.

pub mod from_matrix;
pub mod papers;
pub mod published;

pub use papers::{MODELS, ReflectanceSet, Row, in_brief, read_set, table};
