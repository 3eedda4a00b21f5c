//! The numbers behind the plots of a report.

use darkroot_colour::{Lab, white};
use darkroot_profile::{Calibration, hue_plane};

use crate::JudgedPatch;

/// A patch that took part in the fit, as it should be and as the profile makes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual<'a> {
    /// The patch.
    pub patch: &'a JudgedPatch,
    /// As it should be.
    pub expected: Lab,
    /// As it is.
    pub found: Lab,
}

/// Every patch that took part in the fit.
pub fn residuals(patches: &[JudgedPatch]) -> Vec<Residual<'_>> {
    let used = patches.iter().filter(|p| p.excluded.is_none());
    used.map(|patch| Residual {
        patch,
        expected: patch.reference.lab(white::D50),
        found: patch.corrected.lab(white::D50),
    })
    .collect()
}

/// A cell of the disc of camera hues (round) and saturations (outwards, 0 to 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrustCell {
    /// Its ends in saturation.
    pub radii: [f64; 2],
    /// Its ends in hue, radians.
    pub angles: [f64; 2],
    /// Balanced camera RGB of its middle, the largest channel 1.
    pub rgb: [f64; 3],
    /// Distance to the nearest patch, in radii of the disc.
    pub nearest: f64,
    /// Whether the model folds over here: two camera colours become one.
    pub folds: bool,
}

/// Where a profile can be trusted.
#[derive(Debug, Clone, PartialEq)]
pub struct Trust {
    /// The disc.
    pub cells: Vec<TrustCell>,
    /// Patches in it, x to the right and y up.
    pub patches: Vec<[f64; 2]>,
}

/// Where a profile can be trusted: cells of camera colours with their distance from the patches of the fit.
pub fn trust(calibration: &Calibration, patches: &[JudgedPatch]) -> Trust {
    const HUES: usize = 48;
    const RINGS: usize = 10;
    let patches: Vec<[f64; 2]> =
        patches.iter().filter(|p| p.excluded.is_none()).map(|p| on_disc(p.rgb)).collect();
    let sign = calibration.model.jacobian([0.5; 3]).determinant().signum();
    let angle = |i: usize| i as f64 / HUES as f64 * std::f64::consts::TAU;
    let cell = |(ring, hue): (usize, usize)| {
        let radii = [ring as f64 / RINGS as f64, (ring + 1) as f64 / RINGS as f64];
        let saturation = ((radii[0] + radii[1]) / 2.0).min(0.97);
        let pure = hue_plane::at_position(6.0 * (hue as f64 + 0.5) / HUES as f64);
        let rgb = pure.map(|p| (1.0 - saturation + saturation * p).max(0.02));
        let here = on_disc(rgb);
        let distance = |[x, y]: &[f64; 2]| (x - here[0]).hypot(y - here[1]);
        TrustCell {
            radii,
            angles: [angle(hue), angle(hue + 1)],
            rgb,
            nearest: patches.iter().map(distance).fold(f64::INFINITY, f64::min),
            folds: calibration.model.jacobian(rgb).determinant() * sign <= 0.0,
        }
    };
    let cells = (0..RINGS).flat_map(|ring| (0..HUES).map(move |hue| (ring, hue))).map(cell).collect();
    Trust { cells, patches }
}

/// Place of a camera colour on the disc.
fn on_disc(rgb: [f64; 3]) -> [f64; 2] {
    let largest = rgb.iter().copied().fold(1e-9, f64::max);
    let least = rgb.iter().copied().fold(f64::INFINITY, f64::min).max(0.0);
    let (angle, radius) = (hue_plane::position(rgb) / 6.0 * std::f64::consts::TAU, 1.0 - least / largest);
    [radius * angle.cos(), radius * angle.sin()]
}
