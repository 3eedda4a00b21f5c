//! What a camera's own notes say of the lens. Radii are distances from the middle of what the maker shows, in halves of its diagonal.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// Steps that a function of the radius is kept in, and the last radius; beyond it the function stays as it is there.
const STEPS: usize = 320;
const LAST: f64 = 1.25;

/// A function of the radius, between steps by straight lines. Over 1/256 of half a diagonal these are right to a hundredth of a
/// pixel for any lens.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Radial {
    values: Vec<f64>,
}

impl Radial {
    /// Keeps a function.
    pub fn of(function: impl Fn(f64) -> f64) -> Self {
        Self { values: (0..=STEPS).map(|i| function(radius(i))).collect() }
    }

    /// Whether it has as many values as it must.
    pub fn is_sound(&self) -> bool {
        self.values.len() == STEPS + 1
    }

    /// The value at a radius.
    pub fn at(&self, radius: f64) -> f64 {
        let place = (radius * (STEPS as f64 / LAST)).clamp(0.0, STEPS as f64);
        let first = (place as usize).min(STEPS - 1);
        let [a, b] = [self.values[first], self.values[first + 1]];
        a + (b - a) * (place - first as f64)
    }

    /// Whether all values lie within these; no value that is no number does.
    pub fn is_within(&self, least: f64, most: f64) -> bool {
        self.values.iter().all(|v| (least..=most).contains(v))
    }

    /// Whether the radius times the value grows with the radius: whether the lens draws no two places in one.
    pub fn grows(&self) -> bool {
        let moved = |(i, v): (usize, &f64)| radius(i) * v;
        let all: Vec<f64> = self.values.iter().enumerate().map(moved).collect();
        all.is_sorted_by(|a, b| a < b)
    }
}

fn radius(step: usize) -> f64 {
    step as f64 * (LAST / STEPS as f64)
}

/// What a lens did to a picture, as its camera says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MakerLens {
    /// The maker.
    pub maker: Cow<'static, str>,
    /// For each of red, green and blue: by what the radius of a place in the corrected picture is multiplied to give that in the
    /// picture as taken.
    pub places: [Radial; 3],
    /// By what light is multiplied, by the radius in the picture as taken; `None` where that is not known.
    pub gain: Option<Radial>,
    /// What else the note says of the lens and is not used, with the reason.
    pub left: Option<Cow<'static, str>>,
}

impl MakerLens {
    /// Whether its parts are whole. Of what comes from another process that is not to be taken for granted.
    pub fn is_sound(&self) -> bool {
        self.places.iter().chain(&self.gain).all(Radial::is_sound)
    }

    /// Whether places move.
    pub fn has_distortion(&self) -> bool {
        !self.places[1].is_within(1.0 - NOTHING, 1.0 + NOTHING)
    }

    /// Whether red and blue move from where green is.
    pub fn has_fringes(&self) -> bool {
        let [red, green, blue] = &self.places;
        let apart = |plane: &Radial| {
            plane
                .values
                .iter()
                .zip(&green.values)
                .any(|(a, b)| !(a - b).abs().is_finite() || (a - b).abs() > NOTHING)
        };
        apart(red) || apart(blue)
    }

    /// What it says, in words.
    pub fn parts(&self) -> String {
        let parts = [
            (self.has_distortion(), "distortion"),
            (self.has_fringes(), "lateral chromatic aberration"),
            (self.gain.is_some(), "vignetting"),
        ];
        let parts: Vec<&str> = parts.into_iter().filter_map(|(is, name)| is.then_some(name)).collect();
        match &parts[..] {
            [] => "nothing".to_owned(),
            [one] => (*one).to_owned(),
            [first @ .., last] => format!("{} and {last}", first.join(", ")),
        }
    }

    /// What is left, as the end of a sentence; nothing where nothing is.
    pub fn and_left(&self) -> String {
        self.left.as_ref().map_or_else(String::new, |left| format!("; {left}"))
    }

    /// The same without what is not wanted.
    #[must_use]
    pub fn without(mut self, fringes: bool, vignetting: bool) -> Self {
        if fringes {
            let green = self.places[1].clone();
            self.places = [green.clone(), green.clone(), green];
        }
        if vignetting {
            self.gain = None;
        }
        self
    }
}

/// A factor so near to 1 moves nothing by a hundredth of a pixel.
const NOTHING: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_is_kept_and_stays_as_it_ends() {
        let kept = Radial::of(|r| 1.0 + 0.1 * r * r);
        for r in [0.0, 0.001, 0.3, 0.71, 1.0, 1.2499] {
            assert!((kept.at(r) - (1.0 + 0.1 * r * r)).abs() < 1e-6, "{r}");
        }
        assert!((kept.at(7.0) - kept.at(LAST)).abs() < 1e-12);
        assert!(kept.at(f64::NAN).is_nan() || kept.at(f64::NAN) > 0.0);
        assert!(kept.grows() && !Radial::of(|r| 1.0 - 0.9 * r).grows());
        assert!(kept.is_within(1.0, 1.2) && !Radial::of(|_| f64::NAN).is_within(0.0, 2.0));
    }

    #[test]
    fn parts_are_named_and_can_be_left_out() {
        let flat = || Radial::of(|_| 1.0);
        let lens = MakerLens {
            maker: "Sony".into(),
            places: [Radial::of(|_| 1.001), flat(), flat()],
            gain: Some(flat()),
            left: None,
        };
        assert_eq!(lens.parts(), "lateral chromatic aberration and vignetting");
        assert_eq!(lens.without(true, true).parts(), "nothing");
    }
}
