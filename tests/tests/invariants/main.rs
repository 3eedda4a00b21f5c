//! What must hold of every picture, measured on simulated captures whose light is known.

#![allow(clippy::unwrap_used, clippy::panic)] // Clippy takes the helpers of tests for production code.
#![allow(clippy::float_cmp)] // Some facts are about the same bits.

mod black_level;
mod clipping;
mod corrections;
mod crop;
mod denoise;
mod exposure;
mod geometry;
mod grey;
mod highlights;
mod hostile;
mod lateral;
mod local_tone;
mod numbers;
mod perspective;
mod ramps;
mod resize;
mod sharpen;
mod tiles;
mod truth;
mod views;
mod white_balance;
