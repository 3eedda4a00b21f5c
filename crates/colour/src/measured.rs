//! Spectra as instruments give them: at any wavelengths, often over less than the whole range.

use crate::Spectrum;
use crate::spectrum::{FIRST_NM, LAST_NM, STEP_NM};
use crate::sprague::Sprague;

/// A measurement must reach at least from here, nm. What lies below it and beyond [`MUST_REACH_NM`] is less than 0.1 %
/// of Y and 0.4 % of X and Z of a white under A, D65 and E; there values are carried on flat.
pub const MUST_START_NM: f64 = 400.0;
/// A measurement must reach at least to here, nm.
pub const MUST_REACH_NM: f64 = 700.0;
/// Widest distance of two samples that is accepted, nm: the coarsest of ASTM E308.
pub const WIDEST_STEP_NM: f64 = 20.0;

/// Why samples are no spectrum.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpectrumError {
    /// Not one value for each wavelength.
    #[error("{wavelengths} wavelengths but {values} values; give one value for each wavelength")]
    Lengths {
        /// Number of wavelengths.
        wavelengths: usize,
        /// Number of values.
        values: usize,
    },
    /// A wavelength or a value is infinite or not a number.
    #[error("sample {number} is not finite; give numbers only")]
    NotFinite {
        /// The sample, counted from 1.
        number: usize,
    },
    /// A wavelength does not exceed the one before it.
    #[error(
        "wavelengths must ascend, but {nm} nm follows {before} nm; sort the samples, each wavelength once"
    )]
    NotAscending {
        /// The wavelength before.
        before: f64,
        /// The wavelength that is too small.
        nm: f64,
    },
    /// Wavelengths that matter are missing.
    #[error("no samples from {from} to {to} nm; measure at least 400 to 700 nm, every 20 nm or closer")]
    Missing {
        /// Begin of the gap, nm.
        from: f64,
        /// End of the gap, nm.
        to: f64,
    },
    /// Wavelengths outside of the observer's table.
    #[error("{nm} nm is outside of 380 to 780 nm")]
    OutOfRange {
        /// The wavelength.
        nm: f64,
    },
    /// The light has no luminance, so nothing can be relative to its white.
    #[error("the light has no luminance; give its relative power, more than 0 in the visible range")]
    Dark,
}

/// A quantity over wavelength as it was measured: a reflectance (0..=1), a relative power, a sensitivity.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Ascending, nm.
    wavelengths: Vec<f64>,
    values: Vec<f64>,
}

/// Which part of 380 to 780 nm was measured; the rest is the nearest value, carried on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coverage {
    /// Begin of the measured range, nm, at least 380.
    pub first: f64,
    /// End of the measured range, nm, at most 780.
    pub last: f64,
}

impl Coverage {
    /// The whole range was measured, nothing carried on.
    pub fn is_whole(self) -> bool {
        self.first <= Spectrum::wavelength(0)
            && self.last >= Spectrum::wavelength(crate::spectrum::SAMPLES - 1)
    }
}

impl Measured {
    /// Samples at ascending wavelengths in nm, at least over 400 to 700 nm and never more than 20 nm apart there.
    /// Wavelengths beyond 380 to 780 nm may be among them.
    pub fn new(wavelengths: &[f64], values: &[f64]) -> Result<Self, SpectrumError> {
        if wavelengths.len() != values.len() {
            let (wavelengths, values) = (wavelengths.len(), values.len());
            return Err(SpectrumError::Lengths { wavelengths, values });
        }
        let finite = |(nm, value): (&f64, &f64)| nm.is_finite() && value.is_finite();
        if let Some(i) = wavelengths.iter().zip(values).position(|sample| !finite(sample)) {
            return Err(SpectrumError::NotFinite { number: i + 1 });
        }
        check_ascending(wavelengths)?;
        check_gaps(wavelengths)?;
        Ok(Self { wavelengths: wavelengths.to_vec(), values: values.to_vec() })
    }

    /// Which part of 380 to 780 nm was measured.
    pub fn coverage(&self) -> Coverage {
        let nearest = |nm: Option<&f64>| nm.map_or(0.0, |nm| nm.clamp(FIRST_NM, LAST_NM));
        Coverage { first: nearest(self.wavelengths.first()), last: nearest(self.wavelengths.last()) }
    }

    /// Value at `nm` by linear interpolation; the nearest value outside of what was measured.
    pub fn at(&self, nm: f64) -> f64 {
        let right = self.wavelengths.partition_point(|&w| w <= nm).clamp(1, self.wavelengths.len() - 1);
        let (left_nm, right_nm) = (self.wavelengths[right - 1], self.wavelengths[right]);
        let share = ((nm - left_nm) / (right_nm - left_nm)).clamp(0.0, 1.0);
        self.values[right - 1] + share * (self.values[right] - self.values[right - 1])
    }

    /// On 380 to 780 nm every 5 nm, by linear interpolation: for reflectances, sensitivities and smooth lights.
    pub fn spectrum(&self) -> Spectrum {
        Spectrum::from_fn(|nm| self.at(nm))
    }

    /// On 380 to 780 nm every 5 nm, by Sprague's interpolation, carried on flat at the ends: for smooth reflectances
    /// sampled every 10 or 20 nm (CIE 167:2005 recommends it). It may overshoot, so it is wrong for lights with
    /// lines. `None` unless there are at least six samples at equal distances.
    pub fn smooth(&self) -> Option<Spectrum> {
        let curve = Sprague::new(&self.wavelengths, &self.values)?;
        Some(Spectrum::from_fn(|nm| curve.at(nm)))
    }

    /// On 380 to 780 nm every 5 nm, each sample the mean of what lies around it with triangular weight over
    /// +-5 nm: for lights with narrow lines that were measured more closely than every 5 nm, whose lines
    /// [`Measured::spectrum`] could miss.
    pub fn averaged(&self) -> Spectrum {
        const HALF: i32 = 20; // A quarter of a nanometre is finer than what instruments resolve.
        let triangle = |i: i32| f64::from(HALF - i.abs()) / f64::from(HALF * HALF);
        let offset = |i: i32| STEP_NM * f64::from(i) / f64::from(HALF);
        Spectrum::from_fn(|nm| (-HALF..=HALF).map(|i| triangle(i) * self.at(nm + offset(i))).sum())
    }
}

pub(crate) fn check_ascending(wavelengths: &[f64]) -> Result<(), SpectrumError> {
    match wavelengths.windows(2).find(|pair| pair[1] <= pair[0]) {
        Some(pair) => Err(SpectrumError::NotAscending { before: pair[0], nm: pair[1] }),
        None => Ok(()),
    }
}

/// Refuses samples that leave too much of 400 to 700 nm unknown.
fn check_gaps(wavelengths: &[f64]) -> Result<(), SpectrumError> {
    let (Some(&first), Some(&last)) = (wavelengths.first(), wavelengths.last()) else {
        return Err(SpectrumError::Missing { from: MUST_START_NM, to: MUST_REACH_NM });
    };
    if first > MUST_START_NM {
        return Err(SpectrumError::Missing { from: MUST_START_NM, to: first.min(MUST_REACH_NM) });
    }
    if last < MUST_REACH_NM {
        return Err(SpectrumError::Missing { from: last.max(MUST_START_NM), to: MUST_REACH_NM });
    }
    let seen = |pair: &[f64]| pair[1] > MUST_START_NM && pair[0] < MUST_REACH_NM;
    match wavelengths.windows(2).find(|pair| seen(pair) && pair[1] - pair[0] > WIDEST_STEP_NM) {
        Some(pair) => Err(SpectrumError::Missing { from: pair[0], to: pair[1] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(first: f64, last: f64, step: f64) -> Vec<f64> {
        (0..).map(|i| first + step * f64::from(i)).take_while(|nm| *nm <= last).collect()
    }

    #[test]
    fn samples_on_the_grid_are_kept_and_those_between_interpolated() {
        let line = |nm: f64| 0.1 + nm / 1000.0;
        for nm in [grid(380.0, 780.0, 5.0), grid(380.0, 780.0, 10.0), grid(360.0, 830.0, 1.0)] {
            let values: Vec<f64> = nm.iter().map(|&w| line(w)).collect();
            let measured = Measured::new(&nm, &values).unwrap();
            assert!(measured.coverage().is_whole());
            for (i, value) in measured.spectrum().0.iter().enumerate() {
                assert!((value - line(Spectrum::wavelength(i))).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn short_measurements_are_carried_on_flat_and_say_so() {
        let nm = grid(400.0, 700.0, 10.0);
        let values: Vec<f64> = nm.iter().map(|w| w / 1000.0).collect();
        let measured = Measured::new(&nm, &values).unwrap();
        assert_eq!(measured.coverage(), Coverage { first: 400.0, last: 700.0 });
        assert!(!measured.coverage().is_whole());
        let spectra = [measured.spectrum(), measured.smooth().unwrap()];
        for spectrum in spectra {
            assert!((spectrum.at(380.0) - 0.4).abs() < 1e-12 && (spectrum.at(780.0) - 0.7).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_no_spectrum_is_refused_with_the_reason() {
        use SpectrumError::{Lengths, Missing, NotAscending, NotFinite};
        let whole = grid(400.0, 700.0, 10.0);
        let flat = |nm: &[f64]| Measured::new(nm, &vec![1.0; nm.len()]).map(|_| ());
        assert_eq!(Measured::new(&whole, &[1.0]), Err(Lengths { wavelengths: 31, values: 1 }));
        assert_eq!(flat(&[]), Err(Missing { from: 400.0, to: 700.0 }));
        assert_eq!(flat(&grid(430.0, 730.0, 10.0)), Err(Missing { from: 400.0, to: 430.0 }));
        assert_eq!(flat(&grid(380.0, 650.0, 10.0)), Err(Missing { from: 650.0, to: 700.0 }));
        assert_eq!(flat(&grid(380.0, 780.0, 25.0)), Err(Missing { from: 380.0, to: 405.0 }));
        let mut turned = whole.clone();
        turned[5] = 400.0;
        assert_eq!(flat(&turned), Err(NotAscending { before: 440.0, nm: 400.0 }));
        let mut broken = whole.clone();
        broken[2] = f64::NAN;
        assert_eq!(flat(&broken), Err(NotFinite { number: 3 }));
    }

    #[test]
    fn a_narrow_line_between_the_samples_is_seen_by_the_average_only() {
        let nm = grid(380.0, 780.0, 0.5);
        let line: Vec<f64> = nm.iter().map(|w| f64::from((w - 547.5).abs() < 0.75)).collect();
        let measured = Measured::new(&nm, &line).unwrap();
        assert!(measured.spectrum().0.iter().sum::<f64>().abs() < 1e-12);
        // Three samples of 0.5 nm make 1.5 nm of power, which is 0.3 of a 5 nm step.
        assert!((measured.averaged().0.iter().sum::<f64>() - 0.3).abs() < 1e-12);
    }
}
