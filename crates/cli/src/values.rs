//! Values of options that are more than a word from a list and no settings of a picture.

use std::time::Duration;

use darkroot::settings::{self, NotAValue};
use darkroot_develop::OutputSpace;

/// `--space`.
pub(crate) fn space(text: &str) -> Result<OutputSpace, NotAValue> {
    settings::text::space(text)
}

/// `--model`.
pub(crate) fn kind(text: &str) -> Result<darkroot_profile::Kind, String> {
    text.parse().map_err(|e: darkroot_profile::kind::UnknownKind| e.to_string())
}

/// `--timeout` and other times.
pub(crate) fn time(text: &str) -> Result<Duration, String> {
    let wrong = || format!("`{text}` is no time: write 90s, 10m or 1h");
    humantime::parse_duration(text).ok().filter(|t| !t.is_zero()).ok_or_else(wrong)
}

/// `--corners`.
pub(crate) fn corners(text: &str) -> Result<[[f64; 2]; 4], String> {
    let usage = || format!("`{text}` is not four corners: write x,y,x,y,x,y,x,y in pixels");
    let numbers = settings::text::numbers::<f64>(text).ok_or_else(usage)?;
    match numbers[..] {
        [a, b, c, d, e, f, g, h] if numbers.iter().all(|n| n.is_finite()) => {
            Ok([[a, b], [c, d], [e, f], [g, h]])
        }
        _ => Err(usage()),
    }
}

/// `--pixels-per-degree`.
pub(crate) fn pixels_per_degree(text: &str) -> Result<f64, String> {
    let pixels = text.trim().parse::<f64>().ok();
    let sound = pixels.filter(|pixels| (5.0..=1000.0).contains(pixels));
    sound.ok_or_else(|| format!("`{text}` is no number of pixels: write 5 to 1000"))
}

/// `--chart-pitch`.
pub(crate) fn millimetres(text: &str) -> Result<f64, String> {
    let length = text.trim().trim_end_matches("mm").trim_end().parse::<f64>().ok();
    let sound = length.filter(|length| (0.1..=1000.0).contains(length));
    sound.ok_or_else(|| format!("`{text}` is no length: write millimetres, 0.1 to 1000"))
}
