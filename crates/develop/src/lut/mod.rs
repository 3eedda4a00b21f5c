//! A look-up table that a person lays over a look: what `.cube` and CLF files hold.
//!
//! Colours of a look are fitted into the space that the table is made for, coded with its curve, sent through the steps of the
//! file and brought back. What treats all three channels alike and never mixes them is a tone curve: it joins the curve of the
//! look (`tone.rs`) and keeps hues as that does.

mod cube;
mod curves;
mod functions;

pub use cube::Cube;
pub use curves::{Curves, Entries, half};
pub use functions::{Cdl, Direction, Log, Outside, Power, Range};

use std::sync::Arc;

use darkroot_colour::RgbSpace;
use darkroot_colour::simd::vectorised;
use darkroot_photo::{Display, Rgb, Toned};

use crate::cones::{Rows, from_rgb, rows, times};
use crate::gamut::{self, Primaries};
use crate::transfer::Octaves;

/// One step of a table: three numbers in, three out.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A matrix by rows, and what is added after it.
    Matrix([[f32; 3]; 3], [f32; 3]),
    /// A curve for each channel.
    Curves(Curves),
    /// A table over all three.
    Cube(Cube),
    /// A straight line, cut at its ends.
    Range(Range),
    /// A power of each channel.
    Power([Power; 3]),
    /// A logarithm of each channel, or its inverse.
    Log([Log; 3]),
    /// Slope, offset, power and saturation as the American Society of Cinematographers defines them.
    Cdl(Cdl),
}

impl Step {
    #[inline]
    fn at(&self, v: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Matrix(matrix, offset) => {
                let out = times(*matrix, v);
                [0, 1, 2].map(|c| out[c] + offset[c])
            }
            Self::Curves(curves) => curves.at(v),
            Self::Cube(cube) => cube.at(v),
            Self::Range(range) => v.map(|v| range.at(v)),
            Self::Power(powers) => [0, 1, 2].map(|c| powers[c].at(v[c])),
            Self::Log(logs) => [0, 1, 2].map(|c| logs[c].at(v[c])),
            Self::Cdl(cdl) => cdl.at(v),
        }
    }

    /// Whether each channel gets the same, and nothing of the others.
    fn is_one_curve(&self) -> bool {
        match self {
            Self::Matrix(matrix, offset) => {
                let [[r, rg, rb], [gr, g, gb], [br, bg, b]] = *matrix;
                let beside = [rg, rb, gr, gb, br, bg];
                alike([r, g, b]) && alike(*offset) && beside.iter().all(|v| v.abs() <= 0.0)
            }
            Self::Curves(curves) => curves.are_alike(),
            Self::Cube(_) => false,
            Self::Range(_) => true,
            Self::Power([a, b, c]) => a == b && b == c,
            Self::Log([a, b, c]) => a == b && b == c,
            Self::Cdl(cdl) => cdl.is_one_curve(),
        }
    }
}

/// Whether three channels have the very same number.
fn alike(v: [f32; 3]) -> bool {
    v.iter().all(|x| x.to_bits() == v[0].to_bits())
}

/// The steps of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Lut {
    /// The first is taken first; values are scaled so that 1 is white, whatever bits the file counts in.
    pub steps: Vec<Step>,
}

impl Lut {
    /// What comes out for coded colours of the space that it is made for.
    pub fn at(&self, coded: [f32; 3]) -> [f32; 3] {
        self.steps.iter().fold(coded, |v, step| step.at(v))
    }

    /// Whether it is a tone curve.
    pub fn is_one_curve(&self) -> bool {
        self.steps.iter().all(Step::is_one_curve)
    }
}

/// A table, and the space in which it takes and gives colours.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// The table.
    pub lut: Arc<Lut>,
    /// Its space.
    pub space: RgbSpace,
}

impl Overlay {
    /// What becomes of a grey of that display light, 0..=1.
    pub(crate) fn grey(&self, light: f32) -> f32 {
        let coded = self.space.curve.encode(f64::from(light)) as f32;
        let out = self.lut.at([coded; 3])[1].clamp(0.0, 1.0);
        self.space.curve.decode(f64::from(out)) as f32
    }
}

/// A table made ready for loops.
#[derive(Debug, Clone)]
pub(crate) struct Laid {
    lut: Arc<Lut>,
    primaries: Primaries,
    to_cones: Rows,
    encode: Octaves,
    decode: Octaves,
}

impl Laid {
    /// `None` for a tone curve, which belongs to the look.
    pub(crate) fn of(overlay: &Overlay) -> Option<Self> {
        let Overlay { lut, space } = overlay;
        (!lut.is_one_curve()).then(|| Self {
            lut: Arc::clone(lut),
            primaries: Primaries::new(space),
            to_cones: rows(&from_rgb(space)),
            encode: Octaves::of(|linear| space.curve.encode(linear)),
            decode: Octaves::of(|coded| space.curve.decode(coded)),
        })
    }
}

/// Sends what a look shows through a table.
pub(crate) fn look_up(picture: Rgb<Toned>, laid: &Laid) -> Rgb<Toned> {
    let mut picture: Rgb<Display> = gamut::fit(picture, &laid.primaries);
    let [r, g, b] = picture.planes_mut();
    vectorised(
        #[inline(always)]
        || {
            for ((r, g), b) in r.iter_mut().zip(g.iter_mut()).zip(b.iter_mut()) {
                let coded = [*r, *g, *b].map(|v| laid.encode.at(v));
                let shown = laid.lut.at(coded).map(|v| laid.decode.at(v));
                [*r, *g, *b] = times(laid.to_cones, shown);
            }
        },
    );
    picture.into_space()
}

#[cfg(test)]
mod tests;
