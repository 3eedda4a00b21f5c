//! A chart of 24 patches in the layout of the ColorChecker Classic.

use darkroot_colour::{Lab, Spectrum};

use crate::reflectance;

/// Patches in a row.
pub const COLUMNS: usize = 6;
/// Rows of patches.
pub const ROWS: usize = 4;
/// The patch of [`PATCHES`] that exposures are measured by: white.
pub const WHITE: usize = 18;

/// Name and published colour of each patch, row by row from dark skin to black: L\*, a\*, b\* under D50 for the
/// 2-degree observer (X-Rite, "Colorimetric values for ColorChecker Family of Targets", charts made from November
/// 2014 on).
pub const PATCHES: [(&str, Lab); COLUMNS * ROWS] = [
    ("dark skin", lab(37.54, 14.37, 14.92)),
    ("light skin", lab(64.66, 19.27, 17.50)),
    ("blue sky", lab(49.32, -3.82, -22.54)),
    ("foliage", lab(43.46, -12.74, 22.72)),
    ("blue flower", lab(54.94, 9.61, -24.79)),
    ("bluish green", lab(70.48, -32.26, -0.37)),
    ("orange", lab(62.73, 35.83, 56.50)),
    ("purplish blue", lab(39.43, 10.75, -45.17)),
    ("moderate red", lab(50.57, 48.64, 16.67)),
    ("purple", lab(30.10, 22.54, -20.87)),
    ("yellow green", lab(71.77, -24.13, 58.19)),
    ("orange yellow", lab(71.51, 18.24, 67.37)),
    ("blue", lab(28.37, 15.42, -49.80)),
    ("green", lab(54.38, -39.72, 32.27)),
    ("red", lab(42.43, 51.05, 28.62)),
    ("yellow", lab(81.80, 2.67, 80.41)),
    ("magenta", lab(50.63, 51.28, -14.12)),
    ("cyan", lab(49.57, -29.71, -28.32)),
    ("white", lab(95.19, -1.03, 2.93)),
    ("neutral 8", lab(81.29, -0.57, 0.44)),
    ("neutral 6.5", lab(66.89, -0.75, -0.06)),
    ("neutral 5", lab(50.76, -0.13, 0.14)),
    ("neutral 3.5", lab(35.63, -0.46, -0.48)),
    ("black", lab(20.64, 0.07, -0.46)),
];

/// Smooth reflectances with the colours of [`PATCHES`]: the formula's spectra, not those of a real chart.
pub fn reflectances() -> Vec<Spectrum> {
    PATCHES.iter().map(|(_, lab)| reflectance::of_lab(*lab)).collect()
}

/// Reflectance of the white patch.
pub fn white() -> Spectrum {
    reflectance::of_lab(PATCHES[WHITE].1)
}

const fn lab(l: f64, a: f64, b: f64) -> Lab {
    Lab { l, a, b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::difference::de2000;

    #[test]
    fn every_patch_has_its_published_colour() {
        for (spectrum, (name, lab)) in reflectances().iter().zip(PATCHES) {
            assert!(de2000(reflectance::lab_of(spectrum), lab) < 1e-4, "{name}");
        }
    }
}
