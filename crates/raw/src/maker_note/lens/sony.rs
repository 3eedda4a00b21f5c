//! Sony, in the directory of the raw picture (ExifTool: VignettingCorrParams, ChromaticAberrationCorrParams, DistortionCorrParams).
//!
//! Each list begins with how many numbers follow that count: knots at even steps of the radius in the corrected picture, the i-th of n
//! at (i + 1/2) / (n - 1), where 1 is the corner. The factor on the radius is 1 + v / 2^14 for distortion; for red and then for
//! blue, on top of it, 1 + v / 2^21. That is how people read it who compared it with the cameras' pictures (stannum.io, "Sony ARW
//! distortion correction"; lensfun, issue 1304; darktable, pull request 7092).

use darkroot_photo::Radial;

use super::curve::Curve;
use super::{Read, Said, numbers};
use crate::tiff::{Directories, Directory};

const VIGNETTING: u16 = 0x7032;
const FRINGES: u16 = 0x7035;
const DISTORTION: u16 = 0x7037;

pub(super) fn said(tiff: &Directories<'_>) -> Read {
    let has = |directory: &&Directory| directory.entry(DISTORTION).is_some();
    let Some(directory) = tiff.all.iter().find(has) else { return Ok(None) };
    let distortion = list(tiff, directory, DISTORTION, "distortion")?.unwrap_or_default();
    let fringes = list(tiff, directory, FRINGES, "lateral chromatic aberration")?.unwrap_or_default();
    let vignetting = list(tiff, directory, VIGNETTING, "vignetting")?.unwrap_or_default();
    if fringes.len() % 2 == 1 {
        return Err("its lateral chromatic aberration has numbers for red that blue has not".to_owned());
    }
    let (red, blue) = fringes.split_at(fringes.len() / 2);
    let factor = |values: &[f64], unit: f64, what: &str| -> Result<Radial, String> {
        if values.is_empty() {
            return Ok(Radial::of(|_| 1.0));
        }
        let last = values.len() as f64 - 1.0;
        let knot = |(i, v): (usize, &f64)| [(i as f64 + 0.5) / last, 1.0 + v / unit];
        let curve = Curve::through(values.iter().enumerate().map(knot).collect());
        let curve = curve.ok_or_else(|| format!("its {what} has a single number"))?;
        Ok(Radial::of(|r| curve.at(r)))
    };
    let green = factor(&distortion, f64::from(1 << 14), "distortion")?;
    let colour = |values: &[f64]| {
        let apart = factor(values, f64::from(1 << 21), "lateral chromatic aberration")?;
        Ok::<_, String>(Radial::of(|r| green.at(r) * apart.at(r)))
    };
    let places = [colour(red)?, green.clone(), colour(blue)?];
    let left = vignetting.iter().any(|v| *v != 0.0).then_some(
        "its vignetting is not applied: published readings of it differ by a factor of two, in stops",
    );
    Ok(Some(Said { places: Some(places), gain: None, left }))
}

/// The numbers of a list that count; `None` where there is none.
fn list(
    tiff: &Directories<'_>,
    directory: &Directory,
    number: u16,
    what: &str,
) -> Result<Option<Vec<f64>>, String> {
    let Some(entry) = directory.entry(number) else { return Ok(None) };
    let all = numbers(tiff, entry)
        .ok_or_else(|| format!("its {what} is not the list of numbers that it should be"))?;
    let Some((&count, values)) = all.split_first() else { return Ok(None) };
    if count < 0.0 || count as usize > values.len() {
        return Err(format!("its {what} names {count} numbers and has {}", values.len()));
    }
    Ok(Some(values[..count as usize].to_vec()))
}
