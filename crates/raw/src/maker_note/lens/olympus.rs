//! Olympus and OM System, in ImageProcessing of their notes; tags that ExifTool lists without a name.
//!
//! With the corner at radius 1 and s the last of four numbers, a radius R of the corrected picture comes from s R (1 + a (s R)^2 +
//! b (s R)^4 + c (s R)^6). Six numbers more say how red and blue lie off: by p + q R^2 + t R^4 of the radius each. That was found by
//! comparing them with what Adobe's converter makes of them (darktable, pull request 12760).

use darkroot_photo::Radial;

use super::super::{below_olympus, directory, notes};
use super::{Read, Said, numbers};

const PROCESSING: u16 = 0x2040;
/// Of older cameras, and of newer ones, which shows a little less.
const DISTORTION: [u16; 2] = [0x150a, 0x1510];
const FRINGES: u16 = 0x150c;

pub(super) fn said(tiff: &crate::tiff::Directories<'_>, make: &str) -> Read {
    for note in notes(tiff) {
        let Some((tiff, own)) = directory(&note, make) else { continue };
        let Some(processing) = below_olympus(&tiff, &own, PROCESSING) else { continue };
        let distortion = DISTORTION.into_iter().find_map(|number| processing.entry(number));
        let fringes = processing.entry(FRINGES);
        if distortion.is_none() && fringes.is_none() {
            continue;
        }
        let numbers = |entry: Option<&crate::tiff::Entry>, count: usize, what: &str| match entry {
            None => Ok(None),
            Some(entry) => match numbers(&tiff, entry) {
                Some(values) if values.len() == count => Ok(Some(values)),
                _ => Err(format!("its {what} is not {count} numbers")),
            },
        };
        let of_green = numbers(distortion, 4, "distortion")?.unwrap_or_else(|| vec![0.0, 0.0, 0.0, 1.0]);
        let of_colours = numbers(fringes, 6, "lateral chromatic aberration")?.unwrap_or_else(|| vec![0.0; 6]);
        let green = |r: f64| {
            let [a, b, c, s] = std::array::from_fn(|i| of_green[i]);
            let square = (s * r).powi(2);
            s * (1.0 + square * (a + square * (b + square * c)))
        };
        let plane = |first: usize| {
            let [p, q, t] = std::array::from_fn(|i| of_colours[first + i]);
            Radial::of(move |r| green(r) * (1.0 + p + r * r * (q + r * r * t)))
        };
        let places = Some([plane(0), Radial::of(green), plane(3)]);
        return Ok(Some(Said { places, gain: None, left: None }));
    }
    Ok(None)
}
