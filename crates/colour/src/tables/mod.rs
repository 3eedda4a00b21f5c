//! Numbers that the CIE publishes as tables. They are facts; here they stand as the 5 nm tables of CIE 015:2018,
//! taken over from colour-science 0.4.7 (BSD-3-Clause).

#![allow(clippy::approx_constant)] // A lamp of relative power 3.14 has nothing to do with circles.

pub(crate) mod daylight;
pub(crate) mod discharge;
pub(crate) mod fluorescent;
pub(crate) mod fluorescent_3;
pub(crate) mod led;
pub(crate) mod observer;
