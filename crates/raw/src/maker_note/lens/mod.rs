//! What makers' notes say of the lens: distortion, lateral chromatic aberration, vignetting.
//!
//! No maker publishes what the numbers mean. Where people who compared them with the cameras' own pictures, or with what Adobe's
//! converter makes of them, agree, they are read; where they do not, a note says that they are there. None of it could be checked
//! here against a picture of a camera, so nobody gets it unasked.

mod curve;
mod fujifilm;
mod nikon;
mod olympus;
mod panasonic;
mod sony;
#[cfg(test)]
mod tests;

use darkroot_photo::{MakerLens, Radial};

use super::{is_olympus, maker};
use crate::raf::Raf;
use crate::tiff::{Directories, Entry};

/// By what places move at most, as a factor on their radius.
const LEAST_PLACE: f64 = 0.5;
const MOST_PLACE: f64 = 2.0;
/// By how much red and blue differ from green at most, as a part of the radius.
const MOST_FRINGE: f64 = 0.02;
/// By what light is multiplied at least and at most.
const LEAST_GAIN: f64 = 0.5;
const MOST_GAIN: f64 = 16.0;

/// What a note holds, as far as it is understood.
struct Said {
    /// As [`MakerLens::places`]; `None` where nothing moves.
    places: Option<[Radial; 3]>,
    gain: Option<Radial>,
    left: Option<&'static str>,
}

/// What the file's own note says of the lens; why not, where it says something that is not used.
pub(crate) fn lens(
    bytes: &[u8],
    tiff: Option<&Directories<'_>>,
    notes: &mut Vec<String>,
) -> Option<MakerLens> {
    let (maker, said) = match (Raf::of(bytes), tiff) {
        (Some(raf), _) => ("Fujifilm", fujifilm::said(raf)),
        (None, Some(tiff)) => of_tiff(tiff)?,
        (None, None) => return None,
    };
    match said.and_then(|said| said.map_or(Ok(None), |said| sound(maker, said))) {
        Ok(lens) => lens,
        Err(why) => {
            notes.push(format!("{maker}'s note on the lens is not applied: {why}"));
            None
        }
    }
}

type Read = Result<Option<Said>, String>;

fn of_tiff(tiff: &Directories<'_>) -> Option<(&'static str, Read)> {
    Some(match maker(tiff)?.as_str() {
        make if make.starts_with("sony") => ("Sony", sony::said(tiff)),
        make if is_olympus(make) => ("Olympus", olympus::said(tiff, make)),
        make if make.starts_with("nikon") => ("Nikon", nikon::said(tiff)),
        make if make.starts_with("panasonic") || make.starts_with("leica") => {
            ("Panasonic", panasonic::said(tiff))
        }
        _ => return None,
    })
}

/// A lens that can be one; `None` where nothing is to be corrected.
fn sound(maker: &'static str, said: Said) -> Result<Option<MakerLens>, String> {
    let Said { places, gain, left } = said;
    if let Some([red, green, blue]) = &places {
        if ![red, green, blue].iter().all(|plane| plane.is_within(LEAST_PLACE, MOST_PLACE) && plane.grows()) {
            return Err("its distortion is that of no lens".to_owned());
        }
        let apart = |plane: &Radial| Radial::of(|r| plane.at(r) / green.at(r) - 1.0);
        if ![red, blue].iter().all(|plane| apart(plane).is_within(-MOST_FRINGE, MOST_FRINGE)) {
            return Err("its lateral chromatic aberration is that of no lens".to_owned());
        }
    }
    if gain.as_ref().is_some_and(|gain| !gain.is_within(LEAST_GAIN, MOST_GAIN)) {
        return Err("its vignetting is that of no lens".to_owned());
    }
    let flat = || Radial::of(|_| 1.0);
    let places = places.unwrap_or_else(|| [flat(), flat(), flat()]);
    let lens = MakerLens { maker: maker.into(), places, gain, left: left.map(Into::into) };
    Ok((lens.has_distortion() || lens.has_fringes() || lens.gain.is_some()).then_some(lens))
}

/// No list of numbers on a lens is longer.
const MOST_NUMBERS: usize = 128;

/// The numbers of an entry, signed, whatever their type; `None` for types that no note has. A fraction over nothing is no number.
fn numbers(tiff: &Directories<'_>, entry: &Entry) -> Option<Vec<f64>> {
    let bytes = tiff.value(entry, 8 * MOST_NUMBERS)?;
    let longs = || tiff.longs(bytes).into_iter();
    Some(match entry.kind {
        3 | 8 => tiff.shorts(bytes).into_iter().map(|v| f64::from(v as i16)).collect(),
        5 => fractions(&tiff.longs(bytes), f64::from),
        10 => fractions(&tiff.longs(bytes), |v| f64::from(v as i32)),
        11 => longs().map(|v| f64::from(f32::from_bits(v))).collect(),
        _ => return None,
    })
}

fn fractions(longs: &[u32], number: impl Fn(u32) -> f64) -> Vec<f64> {
    longs.as_chunks().0.iter().map(|&[above, below]| number(above) / number(below)).collect()
}
