//! Whether colours seen are those of a chart, whatever the light, the camera and its tone curve.
//!
//! Everything is in logarithms, and compared by linear regression. The ratios of the channels (red to green, blue to
//! green) are regressed on the ratios that the chart should have, the lightness on ratios and lightness, both also on a
//! plane, which takes up shade over the chart. What a camera may do to colours is then linear: white balance and
//! exposure add a constant, a gamma is a factor, overlapping filters mix the ratios. The share of the variance that
//! stays unexplained tells a chart from anything else.

use darkroot_colour::{Lab, RgbSpace, Vector3, white};
use nalgebra::DMatrix;

/// Terms of the regression: a constant, column and row; two ratios of channels; lightness.
const TERMS: usize = 6;
/// So many of the first terms describe shade. What they explain is no evidence for a chart.
const SHADE: usize = 3;
/// So many of the first terms explain the ratios of channels: shade and ratios, not lightness.
const RATIOS: usize = 5;
/// Light added before taking logarithms, as a share of the brightest patch: glare and noise hide what is darker.
const FLOOR: f64 = 0.015;

/// The terms of all patches of a chart, prepared for the regression.
#[derive(Debug, Clone)]
pub(super) struct Expected {
    /// The terms made orthonormal one after another (Q of a QR decomposition): a row for each patch.
    basis: Vec<[f64; TERMS]>,
    /// R of that decomposition, an upper triangle: the terms are `basis` times this.
    triangle: [[f64; TERMS]; TERMS],
}

/// How well colours seen are explained.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fit {
    /// Share of the variance of lightness that is not explained.
    pub(super) lightness: f64,
    /// Share of the variance of the ratios of channels that is not explained.
    pub(super) chroma: f64,
    /// Standard deviation of the logarithms of the ratios of channels.
    pub(super) colourfulness: f64,
}

impl Fit {
    /// Mean of both: 0 for a perfect chart, about 0.75 for 24 random colours.
    pub(super) fn unexplained(&self) -> f64 {
        0.5 * (self.lightness + self.chroma)
    }
}

impl Expected {
    /// `places` are the patches' columns and rows, in any units.
    pub(super) fn new(colours: &[Lab], places: &[[f64; 2]]) -> Self {
        let matrix = RgbSpace::REC2020.from_xyz_under(white::D50);
        let rows: Vec<[f64; TERMS]> = colours
            .iter()
            .zip(places)
            .map(|(lab, [x, y])| {
                let xyz = lab.xyz(white::D50);
                let rgb = matrix * Vector3::new(xyz.x, xyz.y, xyz.z);
                let [lightness, red, blue] = signals([0, 1, 2].map(|c| rgb[c]), [1.0; 3]);
                [1.0, *x, *y, red, blue, lightness]
            })
            .collect();
        let (q, r) = DMatrix::from_fn(rows.len(), TERMS, |i, j| rows[i][j]).qr().unpack();
        let fits = q.ncols() == TERMS;
        let at = |m: &DMatrix<f64>, i: usize, j: usize| if fits { m[(i, j)] } else { 0.0 };
        let basis = (0..rows.len()).map(|i| std::array::from_fn(|j| at(&q, i, j))).collect();
        Self { basis, triangle: std::array::from_fn(|i| std::array::from_fn(|j| at(&r, i, j))) }
    }

    /// How well the colours seen, in the sequence of the chart's patches, are explained.
    pub(super) fn fit(&self, seen: impl Fn(usize) -> [f64; 3]) -> Fit {
        let count = self.basis.len();
        let brightest =
            (0..count).map(&seen).fold([1e-9f64; 3], |m, s| std::array::from_fn(|c| m[c].max(s[c])));
        let signals: Vec<[f64; 3]> = (0..count).map(|i| signals(seen(i), brightest)).collect();
        let mut along = [[0.0; TERMS]; 3];
        let mut squares = [0.0; 3];
        for (row, s) in self.basis.iter().zip(&signals) {
            for c in 0..3 {
                squares[c] += s[c] * s[c];
                for (sum, q) in along[c].iter_mut().zip(row) {
                    *sum += q * s[c];
                }
            }
        }
        let part =
            |c: usize, terms: std::ops::Range<usize>| along[c][terms].iter().map(|k| k * k).sum::<f64>();
        let variance = [0, 1, 2].map(|c| squares[c] - part(c, 0..SHADE));
        let explained = [part(0, SHADE..TERMS), part(1, SHADE..RATIOS), part(2, SHADE..RATIOS)];
        let share =
            |part: f64, whole: f64| if whole > 1e-9 { (1.0 - part / whole).clamp(0.0, 1.0) } else { 1.0 };
        let possible = self.is_camera(&along);
        let unless_odd = |unexplained: f64| if possible { unexplained } else { unexplained.max(0.7) };
        Fit {
            lightness: unless_odd(share(explained[0], variance[0])),
            chroma: unless_odd(share(explained[1] + explained[2], variance[1] + variance[2])),
            colourfulness: ((variance[1] + variance[2]).max(0.0) / (2 * count) as f64).sqrt(),
        }
    }

    /// Whether what explains the colours can be a camera: light is light, red is redder, blue is bluer, and hues keep
    /// their sequence.
    fn is_camera(&self, along: &[[f64; TERMS]; 3]) -> bool {
        let t = &self.triangle;
        let ratios = |c: usize| {
            let blue = along[c][4] / t[4][4];
            [(along[c][3] - t[3][4] * blue) / t[3][3], blue]
        };
        let ([rr, rb], [br, bb]) = (ratios(1), ratios(2));
        let lightness = along[0][5] / t[5][5];
        rr > 0.0 && bb > 0.0 && rr * bb - rb * br > 0.0 && lightness > 0.0
    }
}

/// Lightness and the ratios of red and blue to green, as logarithms.
fn signals(rgb: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = [0, 1, 2].map(|c| (rgb[c].max(0.0) / white[c] + FLOOR).ln());
    [(r + g + b) / 3.0, r - g, b - g]
}
