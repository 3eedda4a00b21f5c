//! Coefficients over a picture of known size: where light is that belongs elsewhere, and how much of it is missing.

/// The largest factor that [`Corrections::gain`] gives: four stops, more than any lens of the database loses. Beyond
/// where vignetting was measured its polynomial may reach zero.
pub const MOST_GAIN: f64 = 16.0;

/// A radial polynomial, `r' = r * (p[0] + p[1] r + ... + p[4] r^4)`, with its radii in units of a picture's pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Radial {
    /// Coefficients, of pixels.
    pub(crate) terms: [f64; 5],
}

impl Radial {
    /// From coefficients of a radius that is `scale` times the radius in pixels.
    fn scaled(terms: [f64; 5], scale: f64) -> Self {
        let mut power = 1.0;
        let terms = terms.map(|term| {
            let scaled = term * power;
            power *= scale;
            scaled
        });
        Self { terms }
    }

    /// By what a place at this distance from the centre, in pixels, moves away from it.
    fn factor(&self, radius: f64) -> f64 {
        self.terms.iter().rev().fold(0.0, |sum, term| sum * radius + term)
    }

    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let factor = self.factor((x * x + y * y).sqrt());
        (x * factor, y * factor)
    }
}

/// What a lens did to a picture of one size. Places are in pixels from the picture's middle, x to the right, y
/// downwards; a middle pixel's middle is (0, 0), and the outermost pixels of a picture of width w have x = ±(w - 1)/2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Corrections {
    pub(crate) distortion: Option<Radial>,
    /// Red and blue, from where distortion puts green.
    pub(crate) tca: Option<[Radial; 2]>,
    /// Coefficients of the squared radius in pixels, of its square and of its cube.
    pub(crate) vignetting: Option<[f64; 3]>,
}

impl Corrections {
    /// Whether [`Self::place`] moves anything because of distortion.
    pub fn has_distortion(&self) -> bool {
        self.distortion.is_some()
    }

    /// Whether [`Self::place`] gives red and blue other places than green.
    pub fn has_tca(&self) -> bool {
        self.tca.is_some()
    }

    /// Whether [`Self::gain`] is ever other than 1.
    pub fn has_vignetting(&self) -> bool {
        self.vignetting.is_some()
    }

    /// The same without correction of distortion.
    pub fn without_distortion(self) -> Self {
        Self { distortion: None, ..self }
    }

    /// The same without correction of lateral chromatic aberration.
    pub fn without_tca(self) -> Self {
        Self { tca: None, ..self }
    }

    /// The same without correction of vignetting.
    pub fn without_vignetting(self) -> Self {
        Self { vignetting: None, ..self }
    }

    /// Where the light for a place of the corrected picture is in the picture as taken: for red, green and blue.
    ///
    /// As in lensfun 0.3, the models `ptlens` and `poly3` keep the radius 1 where it is (half the shorter side of the
    /// picture that was measured), so that a corrected picture may need places beyond the edge of the picture as
    /// taken, or not reach it: scale x and y before.
    pub fn place(&self, x: f64, y: f64) -> [(f64, f64); 3] {
        let green = self.distortion.map_or((x, y), |d| d.place((x, y)));
        match &self.tca {
            Some([red, blue]) => [red.place(green), green, blue.place(green)],
            None => [green; 3],
        }
    }

    /// By what the light at a place of the picture as taken must be multiplied: from 1/[`MOST_GAIN`] to [`MOST_GAIN`],
    /// 1 where nothing is known.
    pub fn gain(&self, x: f64, y: f64) -> f64 {
        let Some([first, second, third]) = self.vignetting else { return 1.0 };
        let r2 = x * x + y * y;
        let left = 1.0 + r2 * (first + r2 * (second + r2 * third));
        if left.is_nan() { 1.0 } else { 1.0 / left.clamp(1.0 / MOST_GAIN, MOST_GAIN) }
    }
}

/// Distortion at one focal length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Distortion {
    /// `a b c` of `ptlens`, or `k1 k2 0` of `poly5`.
    pub(crate) terms: [f64; 3],
    pub(crate) is_poly5: bool,
    pub(crate) measured: Measured,
}

impl Distortion {
    /// Coefficients of powers of the radius (manual of lensfun, "Distortion": `poly3`, `poly5`, `ptlens`).
    fn polynomial(&self) -> [f64; 5] {
        let [a, b, c] = self.terms;
        if self.is_poly5 { [1.0, 0.0, a, 0.0, b] } else { [1.0 - a - b - c, c, b, a, 0.0] }
    }
}

/// Lateral chromatic aberration at one focal length: constant, linear and quadratic coefficients (manual of lensfun,
/// "Lateral chromatic aberration": `linear`, `poly3`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tca {
    pub(crate) red: [f64; 3],
    pub(crate) blue: [f64; 3],
    pub(crate) measured: Measured,
}

/// Vignetting at one focal length, aperture and distance: coefficients of the squared radius and its powers (manual of
/// lensfun, "Vignetting": `pa`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vignetting {
    pub(crate) terms: [f64; 3],
    pub(crate) measured: Measured,
}

/// The sensor that coefficients were measured on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measured {
    /// Its crop factor through that of the sensor at hand.
    pub(crate) crop: f64,
    /// Its longer side through its shorter one.
    pub(crate) aspect: f64,
}

/// What is known of a lens at the settings of one shot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Known {
    pub(crate) distortion: Option<Distortion>,
    pub(crate) tca: Option<Tca>,
    pub(crate) vignetting: Option<Vignetting>,
}

impl Known {
    /// For a picture of the whole sensor.
    ///
    /// Radii of distortion and TCA are 1 at the middle of the longer edge of the picture that was measured, those of
    /// vignetting at its corner (manual of lensfun, "Coordinate systems"); the frames of all sensors have the same
    /// middle, and diagonals as their crop factors say. As in lensfun, a picture reaches from the middle of its first
    /// pixel to that of its last one.
    pub(crate) fn over(&self, (width, height): (usize, usize)) -> Corrections {
        let half_diagonal = width.saturating_sub(1).max(1) as f64;
        let half_diagonal = half_diagonal.hypot(height.saturating_sub(1).max(1) as f64) / 2.0;
        let short_side = |m: Measured| m.aspect.hypot(1.0) * m.crop / half_diagonal;
        let radial = |[constant, linear, quadratic]: [f64; 3], scale| {
            Radial::scaled([constant, linear, quadratic, 0.0, 0.0], scale)
        };
        Corrections {
            distortion: self.distortion.map(|d| Radial::scaled(d.polynomial(), short_side(d.measured))),
            tca: self.tca.map(|t| [t.red, t.blue].map(|channel| radial(channel, short_side(t.measured)))),
            vignetting: self.vignetting.map(|v| {
                let square = (v.measured.crop / half_diagonal).powi(2);
                [v.terms[0] * square, v.terms[1] * square.powi(2), v.terms[2] * square.powi(3)]
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAME: Measured = Measured { crop: 1.0, aspect: 1.5 };

    fn known() -> Known {
        Known {
            distortion: Some(Distortion { terms: [0.0, -0.1, 0.0], is_poly5: false, measured: SAME }),
            tca: Some(Tca { red: [1.001, 0.0, 0.0], blue: [0.999, 0.0, 0.0], measured: SAME }),
            vignetting: Some(Vignetting { terms: [-0.5, 0.0, 0.0], measured: SAME }),
        }
    }

    #[test]
    fn ptlens_keeps_the_middle_of_the_longer_edge_and_vignetting_is_counted_to_the_corner() {
        let corrections = known().over((6001, 4001));
        let [red, green, blue] = corrections.place(0.0, 2000.0);
        assert!((green.1 - 2000.0).abs() < 1e-9);
        assert!((red.1 - 2002.0).abs() < 1e-9 && (blue.1 - 1998.0).abs() < 1e-9);
        assert!((corrections.gain(3000.0, -2000.0) - 2.0).abs() < 1e-9);
        assert!((corrections.gain(0.0, 0.0) - 1.0).abs() < 1e-12);
        // Barrel: outside of the radius 1, light is nearer to the middle than it should be.
        assert!(corrections.place(3000.0, 2000.0)[1].0 < 3000.0);
    }

    #[test]
    fn a_smaller_sensor_sees_the_middle_only() {
        let cropped = Measured { crop: 1.0 / 1.5, aspect: 1.5 };
        let known = Known {
            vignetting: Some(Vignetting { terms: [-0.5, 0.0, 0.0], measured: cropped }),
            ..Known::default()
        };
        let corner = known.over((6001, 4001)).gain(3000.0, 2000.0);
        assert!((corner - 1.0 / (1.0 - 0.5 / 2.25)).abs() < 1e-9);
    }

    #[test]
    fn a_picture_on_its_side_is_corrected_the_same() {
        let (lying, standing) = (known().over((6000, 4000)), known().over((4000, 6000)));
        assert_eq!(lying, standing);
    }

    #[test]
    fn parts_can_be_left_out() {
        let all = known().over((6000, 4000));
        let none = all.without_distortion().without_tca().without_vignetting();
        assert_eq!(none.place(100.0, 50.0), [(100.0, 50.0); 3]);
        assert!(none.gain(2000.0, 2000.0).eq(&1.0) && none == Corrections::default());
    }

    #[test]
    fn pictures_without_size_and_places_without_numbers_do_no_harm() {
        for size in [(0, 0), (1, 1), (0, 4000), (usize::MAX, usize::MAX)] {
            let corrections = known().over(size);
            for place in [0.0, 1e300, f64::INFINITY, f64::NAN] {
                let gain = corrections.gain(place, -place);
                assert!((1.0 / MOST_GAIN..=MOST_GAIN).contains(&gain), "{size:?} {place}: {gain}");
                let _ = corrections.place(place, place);
            }
        }
    }
}
