//! The CIE 1931 2-degree standard observer.

use crate::spectrum::{FIRST_NM, LAST_NM, interpolate};
use crate::tables::observer::{X_BAR, Y_BAR, Z_BAR};
use crate::{Spectrum, Xyz};

/// Colour-matching functions (x-bar, y-bar, z-bar) at `nm`, 380 to 780, by linear interpolation of the 5 nm table of
/// CIE 015:2018; 0 outside of that range.
pub fn cie_1931(nm: f64) -> Xyz {
    if !(FIRST_NM..=LAST_NM).contains(&nm) {
        return Xyz::default();
    }
    Xyz::new(interpolate(&X_BAR, nm), interpolate(&Y_BAR, nm), interpolate(&Z_BAR, nm))
}

/// The three colour-matching functions x-bar, y-bar, z-bar, 380 to 780 nm every 5 nm.
pub fn colour_matching_functions() -> [Spectrum; 3] {
    [Spectrum(X_BAR), Spectrum(Y_BAR), Spectrum(Z_BAR)]
}

/// 400 to 700 nm every 10 nm: the wavelengths of common reflectance tables and of the tables of Finlayson et al.
/// (2011) on root polynomials.
pub fn every_ten_nm() -> [f64; 31] {
    std::array::from_fn(|i| 400.0 + 10.0 * i as f64)
}
