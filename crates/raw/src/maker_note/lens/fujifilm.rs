//! Fujifilm, in the RAF's directory for development (ExifTool: GeometricDistortionParams, ChromaticAberrationParams,
//! VignettingParams).
//!
//! Each list has a number that nobody understands, then the knots, radii in the picture as taken where 1 is the corner, then values:
//! distortion in percent, by which places are nearer to the middle than they should be or farther; for red and for blue by what
//! part of the radius they lie off; the light that is left, in percent. Newer files have 9 knots, with one number more at the end of
//! the colours; older ones have 11, of which the colours lack the first. That is how people read it who compared it with the
//! cameras' pictures and with Adobe's converter (Exiv2, pull request 1409; darktable, pull requests 14297 and 14468).

use darkroot_photo::Radial;

use super::curve::Curve;
use super::{Read, Said, numbers};
use crate::raf::Raf;
use crate::tiff::{Directories, Directory};

const DISTORTION: u16 = 0xf00b;
const FRINGES: u16 = 0xf00f;
const VIGNETTING: u16 = 0xf010;

/// Of Fujifilm's note: which part of the sensor was read.
const CROP_MODE: u16 = 0x104d;
/// All of it, where the camera says so.
const WHOLE: [u64; 2] = [0, 1];

/// The farthest place of the picture as taken that is asked for: beyond it the corner of no corrected picture lies.
const FARTHEST: f64 = 2.0;

pub(super) fn said(raf: Raf<'_>) -> Read {
    let Some((tiff, directory)) = raf.development() else { return Ok(None) };
    let distortion = columns(&tiff, &directory, DISTORTION, 1, "distortion")?;
    let fringes = columns(&tiff, &directory, FRINGES, 2, "lateral chromatic aberration")?;
    let vignetting = columns(&tiff, &directory, VIGNETTING, 1, "vignetting")?;
    if distortion.is_none() && fringes.is_none() && vignetting.is_none() {
        return Ok(None);
    }
    let part = raf.note().and_then(|(tiff, note)| note.number(&tiff, CROP_MODE)).unwrap_or(0);
    if !WHOLE.contains(&part) {
        return Err("only a part of the sensor was read, and which radii its numbers mean then is not known"
            .to_owned());
    }
    let [distortion] = curves(distortion, "distortion", |v| v / 100.0)?;
    let [red, blue] = curves(fringes, "lateral chromatic aberration", |v| v)?;
    let gain = match vignetting {
        None => None,
        Some(columns) => {
            let [light] = curves(Some(columns), "vignetting", |v| 100.0 / v - 1.0)?;
            let gain = Radial::of(|r| 1.0 + value(&light, r));
            (!gain.is_within(1.0, 1.0)).then_some(gain)
        }
    };
    let factor = |taken: f64| 1.0 + value(&distortion, taken);
    if !Radial::of(|r| 1.0 / factor(r)).grows() {
        return Err("its distortion is that of no lens".to_owned());
    }
    let taken = Radial::of(|corrected| inverse(corrected, factor));
    let plane = |apart: &Option<Curve>| {
        Radial::of(|r| {
            let taken = taken.at(r);
            factor(taken) * (1.0 + value(apart, taken))
        })
    };
    Ok(Some(Said { places: Some([plane(&red), plane(&None), plane(&blue)]), gain, left: None }))
}

fn value(curve: &Option<Curve>, radius: f64) -> f64 {
    curve.as_ref().map_or(0.0, |curve| curve.at(radius))
}

/// The radius in the picture as taken of one in the corrected picture: where it over its factor is that. Found by halving.
fn inverse(corrected: f64, factor: impl Fn(f64) -> f64) -> f64 {
    let (mut least, mut most) = (0.0, FARTHEST);
    for _ in 0..50 {
        let between = 0.5 * (least + most);
        if between < corrected * factor(between) { least = between } else { most = between }
    }
    least
}

/// Knots, and a column of values for each of `N`.
struct Columns {
    knots: Vec<f64>,
    values: Vec<Vec<f64>>,
}

/// `None` where there is no such list, or nothing in it.
fn columns(
    tiff: &Directories<'_>,
    directory: &Directory,
    number: u16,
    columns: usize,
    what: &str,
) -> Result<Option<Columns>, String> {
    let Some(entry) = directory.entry(number) else { return Ok(None) };
    let all = numbers(tiff, entry)
        .ok_or_else(|| format!("its {what} is not the list of fractions that it should be"))?;
    let knots = match (columns, all.len()) {
        (1, 19) | (2, 29) => 9,
        (1, 23) => 11,
        (2, 31) => 10,
        (_, others) => return Err(format!("its {what} has {others} numbers, whose meaning is not known")),
    };
    if all[1..].iter().all(|v| *v == 0.0) {
        return Ok(None);
    }
    let mut runs = all[1..].chunks_exact(knots).map(<[f64]>::to_vec);
    let first = runs.next().unwrap_or_default();
    Ok(Some(Columns { knots: first, values: runs.take(columns).collect() }))
}

/// A curve for each column, 0 in the middle; `None` where it is 0 everywhere.
fn curves<const N: usize>(
    columns: Option<Columns>,
    what: &str,
    meaning: impl Fn(f64) -> f64,
) -> Result<[Option<Curve>; N], String> {
    let Some(Columns { knots, values }) = columns else { return Ok([const { None }; N]) };
    let mut curves = [const { None }; N];
    for (curve, values) in curves.iter_mut().zip(values) {
        let middle = knots.first().is_some_and(|&knot| knot > 0.0).then_some([0.0, 0.0]);
        let points = knots.iter().zip(&values).map(|(&knot, &v)| [knot, meaning(v)]);
        let through = Curve::through(middle.into_iter().chain(points).collect());
        *curve = Some(
            through.ok_or_else(|| format!("the radii or values of its {what} are no numbers in order"))?,
        );
    }
    Ok(curves)
}
