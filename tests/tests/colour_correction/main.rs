//! The colour correction against the published tables and against cameras and colours that it never saw. Needs the
//! measured spectra that `DARKROOT_DATA` points to; without them each test says so and passes.

mod data;
mod held_out;
mod published_tables;
mod shipped;
mod spectral_prior;
mod twenty_four;
mod chart_shots;
