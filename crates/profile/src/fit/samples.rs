//! The colours of a fit.

use darkroot_colour::Xyz;

use super::FitError;

/// Colours whose balanced camera RGB and XYZ are both known, under one light.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    rgb: Vec<[f64; 3]>,
    xyz: Vec<Xyz>,
    white: Xyz,
}

impl Samples {
    /// Colours by their balanced camera RGB, 1 for the white of the light, and their XYZ under the light, relative
    /// to `white` (Y = 1).
    ///
    /// # Errors
    /// Lists of different lengths, values that are not finite, a white without X, Y or Z.
    pub fn new(rgb: Vec<[f64; 3]>, xyz: Vec<Xyz>, white: Xyz) -> Result<Self, FitError> {
        if rgb.len() != xyz.len() {
            return Err(FitError::Samples("there are not as many camera colours as reference colours"));
        }
        let finite = |c: &Xyz| c.x.is_finite() && c.y.is_finite() && c.z.is_finite();
        if !rgb.iter().flatten().all(|v| v.is_finite()) || !xyz.iter().all(finite) {
            return Err(FitError::Samples("a value is not a finite number"));
        }
        if !finite(&white) || white.x <= 0.0 || white.y <= 0.0 || white.z <= 0.0 {
            return Err(FitError::Samples("the white has no X, Y or Z"));
        }
        Ok(Self { rgb, xyz, white })
    }

    /// Number of colours.
    pub fn len(&self) -> usize {
        self.rgb.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rgb.is_empty()
    }

    /// Balanced camera RGB.
    pub fn rgb(&self) -> &[[f64; 3]] {
        &self.rgb
    }

    /// XYZ under the light.
    pub fn xyz(&self) -> &[Xyz] {
        &self.xyz
    }

    /// The white of the light.
    pub fn white(&self) -> Xyz {
        self.white
    }

    /// All colours but one. Indices beyond the last leave all.
    #[must_use]
    pub fn without(&self, left_out: usize) -> Self {
        let mut rest = self.clone();
        if left_out < self.len() {
            rest.rgb.remove(left_out);
            rest.xyz.remove(left_out);
        }
        rest
    }
}
