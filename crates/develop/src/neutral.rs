//! Which white the recipe means: the neutral, camera RGB of a surface without colour in the light of the shot.

use darkroot_colour::Xy;
use darkroot_colour::temperature::{Temperature, daylight_xy};
use darkroot_photo::{AsShot, Layout, Rect};

use crate::analysis::Analysis;
use crate::error::{Error, SpotFault};
use crate::geometry::Laid;
use crate::recipe::Balance;
use crate::survey;
use crate::whites::Whites;

/// Daylight at noon, K.
const NOON: f64 = 5503.0;
/// Smallest and largest side of a grey spot, pixels.
const SPOT_SIDES: (usize, usize) = (8, 4096);
/// Light that a grey spot must have in every channel, and may not exceed.
const SPOT_LIGHT: (f64, f64) = (1e-3, 0.95);

/// Camera RGB of the light's white. What had to be assumed becomes a note.
pub(crate) fn neutral(
    analysis: &Analysis,
    whites: &Whites<'_>,
    balance: Balance,
    laid: &Laid,
    notes: &mut Vec<String>,
) -> Result<[f64; 3], Error> {
    let capture = analysis.capture();
    if *capture.counts.layout() == Layout::Monochrome {
        return Ok([1.0; 3]);
    }
    let of_white = |xy: Xy| whites.neutral_of(xy).ok_or(Error::NoMatrix);
    match balance {
        Balance::AsShot => match capture.as_shot {
            _ if capture.balance_applied => Ok([1.0; 3]),
            Some(AsShot::Neutral(neutral)) => Ok(neutral),
            Some(AsShot::White(xy)) => of_white(xy),
            // Linear files without a neutral are balanced.
            None if *capture.counts.layout() == Layout::Rgb => Ok([1.0; 3]),
            None => {
                notes.push("no white balance is recorded; it was estimated from the picture".to_owned());
                Ok(analysis.estimated_neutral(whites).unwrap_or([1.0; 3]))
            }
        },
        Balance::Auto => Ok(analysis.estimated_neutral(whites).unwrap_or_else(|| {
            notes.push(
                "the picture is too dark or too bright to estimate a white balance; none was applied".into(),
            );
            [1.0; 3]
        })),
        Balance::Daylight => of_white(daylight_xy(NOON)),
        Balance::Kelvin { kelvin, tint } => {
            if !((2000.0..=25000.0).contains(&kelvin) && (-150.0..=150.0).contains(&tint)) {
                return Err(Error::Temperature { kelvin, tint });
            }
            of_white(Temperature::from_kelvin_tint(kelvin, tint).xy())
        }
        Balance::Spot { x, y, side } => spot(analysis, laid, (x, y), side),
        Balance::Multipliers(m) => {
            let (low, high) =
                (m.iter().copied().fold(f64::MAX, f64::min), m.iter().copied().fold(0.0, f64::max));
            let sound = m.iter().all(|v| v.is_finite()) && low > 0.0 && high / low <= 100.0;
            if sound { Ok(m.map(|v| 1.0 / v)) } else { Err(Error::Multipliers) }
        }
    }
}

/// Neutral of a grey spot, given in pixels of the developed picture.
fn spot(analysis: &Analysis, laid: &Laid, (x, y): (usize, usize), side: usize) -> Result<[f64; 3], Error> {
    let capture = analysis.capture();
    let upright = laid.size;
    let wrong = |fault| Error::Spot { x, y, fault, size: upright };
    if x >= upright.width || y >= upright.height {
        return Err(wrong(SpotFault::Outside));
    }
    let (column, row) = laid.in_frame(capture, x, y);
    let side = side.clamp(SPOT_SIDES.0, SPOT_SIDES.1);
    let around = Rect {
        x: column.saturating_sub(side / 2),
        y: row.saturating_sub(side / 2),
        width: side,
        height: side,
    };
    let around = around.intersection(laid.crop).ok_or_else(|| wrong(SpotFault::Outside))?;
    if around.width < SPOT_SIDES.0 || around.height < SPOT_SIDES.0 {
        return Err(wrong(SpotFault::TooSmall));
    }
    let mean = survey::mean(capture, analysis.light(), around);
    if mean.iter().any(|&v| v < SPOT_LIGHT.0) {
        return Err(wrong(SpotFault::TooDark));
    }
    if mean.iter().any(|&v| v > SPOT_LIGHT.1) {
        return Err(wrong(SpotFault::Clipped));
    }
    Ok(mean)
}

/// White-balance multipliers of a neutral, the smallest 1.
pub(crate) fn multipliers(neutral: [f64; 3]) -> [f32; 3] {
    let largest = neutral.iter().copied().fold(0.0, f64::max);
    neutral.map(|v| (largest / v) as f32)
}
