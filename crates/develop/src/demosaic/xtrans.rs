//! Demosaicing for Fujifilm X-Trans sensors: linear prediction under several models of the picture, joined by how
//! well each predicts the samples that are there.
//!
//! A model says how alike two samples are, by their distance, by the angle between them and by their colours; the
//! best linear prediction of a missing colour under it is a fixed weighting of the samples around the pixel
//! (kriging: G. Matheron, "Principles of geostatistics", Economic Geology 58, 1963; for filter arrays: H. J.
//! Trussell and R. E. Hartley, "Mathematics for demosaicking", IEEE Transactions on Image Processing 11(4),
//! 2002). No model is right everywhere, so there are eight: edges that run in four directions, each with colours
//! that change along with brightness and with colours that change on their own.
//!
//! Which of them fits is seen from the samples themselves: each sample is predicted from those around it without
//! itself (O. Dubrule, "Cross validation of kriging in a unique neighborhood", Mathematical Geology 15(6), 1983),
//! and the models are joined by the errors that this shows nearby.

use std::sync::LazyLock;

use photo::{CameraSpace, Cfa, Filter, Mosaic, Rgb};

use super::{signed_sqrt, signed_square};

/// Pixels around the result that the method looks at: [`REACH`] for the prediction, [`HALF`] for its errors.
pub const BORDER: usize = REACH + HALF;

/// Samples within this distance, and half a pixel more, predict.
const REACH: usize = 4;
/// Half the width of the window of the errors.
const HALF: usize = 4;
/// Weights of the errors by rows and by columns away: a triangle.
const WINDOW: [f32; 2 * HALF + 1] = [0.04, 0.08, 0.12, 0.16, 0.2, 0.16, 0.12, 0.08, 0.04];
/// Keeps quotients of vanishing errors finite; far below the square of any sample.
const TINY: f32 = 1e-30;

/// Columns and rows after which the array repeats.
const PERIOD: usize = 6;
/// The array of every X-Trans sensor, but for where it begins.
const ARRAY: [&[u8; PERIOD]; PERIOD] = [b"GBGGRG", b"RGRBGB", b"GBGGRG", b"GRGGBG", b"BGBRGR", b"GRGGBG"];

/// The array's colour (0 red, 1 green, 2 blue) in column `x` of row `y`.
fn colour(x: usize, y: usize) -> usize {
    match ARRAY[y % PERIOD][x % PERIOD] {
        b'R' => 0,
        b'G' => 1,
        _ => 2,
    }
}

/// Column and row of the X-Trans array at which `cfa` begins; `None` for any other array.
pub fn phase(cfa: &Cfa) -> Option<(usize, usize)> {
    let places = (0..PERIOD * PERIOD).map(|i| (i % PERIOD, i / PERIOD));
    let same = |x: usize, y: usize, (u, v): (usize, usize)| {
        cfa.at(x, y).plane() == Some(colour(x + u, y + v))
    };
    let six = cfa.width() == PERIOD && cfa.height() == PERIOD;
    places.clone().find(|&begin| six && places.clone().all(|(x, y)| same(x, y, begin)))
}
