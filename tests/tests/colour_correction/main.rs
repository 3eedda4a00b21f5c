//! The colour correction against the published tables and against cameras and colours that it never saw. Needs the
//! measured spectra that `DARKROOT_DATA` points to; without them the tests are ignored.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // Helpers of tests; figures are meant to be seen.

mod auto_white;
mod chart_shots;
mod data;
mod estimated;
mod held_out;
mod passport;
mod published_tables;
mod references;
mod shipped;
mod spectral_prior;
mod twenty_four;
