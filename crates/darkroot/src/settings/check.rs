//! What of the settings does not go together.

use darkroot_colour::RgbSpace;
use darkroot_develop::{Bits, Look, OutputSpace, Recipe};

use darkroot_encode::Format;

use super::tones::changed;
use super::{ChartShot, Engine, ProfileChoice, Settings, SettingsError};

/// Linear light has no look that could be changed.
pub(super) fn tones(settings: &Settings, recipe: &Recipe, linear: bool) -> Result<(), SettingsError> {
    let settings = changed(settings);
    match recipe.look {
        _ if settings.is_empty() => Ok(()),
        _ if linear => Err(SettingsError::TonesOnLinear { settings }),
        Look::Reproduction => Err(SettingsError::TonesOnReproduction { settings }),
        _ => Ok(()),
    }
}

/// Light above white goes beside a JPEG or into an AVIF, by a look that bends highlights, which a table over it would not know.
pub(super) fn hdr(settings: &Settings, recipe: &Recipe, format: Format) -> Result<(), SettingsError> {
    let why = if settings.hdr <= 0.0 {
        return Ok(());
    } else if !matches!(format, Format::Jpeg | Format::Avif) {
        "has a place in JPEG and AVIF only"
    } else if format == Format::Avif
        && settings.space.is_some_and(|s| s != OutputSpace::Rgb(RgbSpace::REC2020))
    {
        "is in Rec. 2020 in an AVIF, and in no other space"
    } else if matches!(recipe.look, Look::Linear | Look::Reproduction) || settings.from_preview {
        "needs a look with a tone curve"
    } else if settings.lut.is_some() {
        "and a table over the look do not go together"
    } else if settings.engine == Engine::Imagepipe {
        "is not known to imagepipe"
    } else {
        return Ok(());
    };
    Err(SettingsError::Hdr { why })
}

/// What is about the sensor's light has no meaning for a picture that the camera rendered.
pub(super) fn preview(settings: &Settings, recipe: &Recipe) -> Result<(), SettingsError> {
    let asks = [
        ("look", matches!(recipe.look, Look::Reproduction | Look::Linear | Look::Camera | Look::Profile)),
        ("space", recipe.output.space == OutputSpace::Camera),
        ("format (DNG)", recipe.output.space == OutputSpace::Raw),
        ("profile", matches!(settings.profile, ProfileChoice::File(_))),
        ("engine", settings.engine == Engine::Imagepipe),
        ("dark", settings.dark.is_some()),
        ("flat", settings.flat.is_some()),
    ];
    let mut asked: Vec<&str> = asks.iter().filter(|(_, asks)| *asks).map(|(name, _)| *name).collect();
    // The camera's rendering has its own curve, and no look is laid over it.
    asked.extend(changed(settings));
    if asked.is_empty() { Ok(()) } else { Err(SettingsError::Preview { settings: asked }) }
}

pub(super) fn imagepipe(settings: &Settings, recipe: &Recipe) -> Result<(), SettingsError> {
    let fixed = Recipe::default();
    let heeded = [
        ("profile", settings.profile == ProfileChoice::Automatic),
        ("space", recipe.output.space == OutputSpace::Rgb(RgbSpace::SRGB)),
        ("bits", recipe.output.bits != Bits::Float),
        ("look", recipe.look == fixed.look),
        ("gamut", recipe.gamut == fixed.gamut),
        ("exposure-from-chart", settings.chart.shot == ChartShot::None),
        ("exposure", recipe.exposure == fixed.exposure),
        ("white-balance", recipe.balance == fixed.balance),
        ("highlights", recipe.highlights == fixed.highlights),
        ("local-tone", recipe.local_tone == fixed.local_tone),
        ("hot-pixels", recipe.hot_pixels == fixed.hot_pixels),
        ("banding", recipe.banding == fixed.banding),
        ("denoise", recipe.denoise == fixed.denoise),
        ("sharpen", recipe.sharpen == fixed.sharpen),
        ("demosaic", recipe.demosaic == fixed.demosaic),
        ("crop", recipe.crop == fixed.crop),
        ("contrast, saturation and their like", recipe.tones == fixed.tones),
        ("lut", settings.lut.is_none()),
        ("dark", settings.dark.is_none()),
        ("flat", settings.flat.is_none()),
        ("rotate, straighten, lens, resize and their like", recipe.geometry == fixed.geometry),
    ];
    let unheeded: Vec<&str> = heeded.iter().filter(|(_, fits)| !fits).map(|(name, _)| *name).collect();
    if unheeded.is_empty() { Ok(()) } else { Err(SettingsError::Engine { settings: unheeded }) }
}
