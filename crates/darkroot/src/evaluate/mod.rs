//! Figures that anybody can compute again: the tables of the papers from spectra and from shots, profiles of a chart and cameras
//! from published matrices on colours that nothing has seen.

mod cameras;
pub mod from_matrix;
pub mod held_out;
pub mod levels;
pub mod papers;
pub mod published;
mod seen;

pub use papers::{MODELS, ReflectanceSet, Row, in_brief, read_set, table};
