//! Every setting that a person can name: the one place where it is written.
//!
//! Options of the command line with their help, recipe files and their errors, JSON and whatever face comes next are
//! made from this table. A new setting takes a field of a recipe, the stage that heeds it, and a row here.

use super::about::{ARTIST, COPYRIGHT, METADATA, SET_TAG};
use super::files::{CHROMA_SUBSAMPLING, HDR, PROGRESSIVE, QUALITY, TIFF_COMPRESSION, WEBP_KIND};
use super::frames::{DARK, FLAT};
use super::from_chart::{BLACK_FROM_CHART, CHART_LAYOUT, CHART_REFERENCE, EXPOSURE_FROM_CHART, set_balance};
use super::geometry::{
    CROP, DPI, ENLARGE, FLIP, FRINGES, LENS, LENS_NAME, RESIZE, ROTATE, STRAIGHTEN, VIGNETTING,
};
use super::noise::{BANDING, DENOISE, DENOISE_CHROMA, DENOISE_LUMA, HOT_PIXELS};
use super::perspective::PERSPECTIVE;
use super::setting::{Changes, Group, Kind, Setting};
use super::text::{NotAValue, amount, light, number, one_of, profile, space};
use super::tones::{
    BLACK, CONTRAST, CURVE, HIGHLIGHTS as HIGHLIGHTS_TONE, LOCAL_TONE, LUT, LUT_SPACE, SATURATION, SHADOWS,
    VIBRANCE, WHITE,
};
use super::words::{
    AUTO, BITS, DECODERS, DEMOSAIC, ENGINES, FORMATS, GAMUT, HIGHLIGHTS, LOOKS, SWITCH, plain,
};

/// Writes what a text means into its place.
pub(super) fn put<T>(place: &mut T, value: Result<T, NotAValue>) -> Result<(), NotAValue> {
    *place = value?;
    Ok(())
}

/// Every setting, in the order in which people are shown them.
pub const SETTINGS: [Setting; 60] = [
    Setting {
        name: "format",
        alias: None,
        noun: "format",
        kind: Kind::Words(const { &plain(&FORMATS) }),
        default: AUTO,
        group: Group::Output,
        placeholder: "",
        help: "Format, where the output's ending does not say it",
        changes: Changes::Encoding,
        set: |to, text| put(&mut to.format, one_of(&FORMATS, text)),
    },
    Setting {
        name: "space",
        alias: None,
        noun: "colour space",
        kind: Kind::Text {
            form: "srgb, display-p3, adobe-rgb, prophoto, rec2020, ecirgb-v2, each also with -linear, aces2065-1, camera \
                   or auto",
            example: "\"adobe-rgb\"",
        },
        default: AUTO,
        group: Group::Output,
        placeholder: "SPACE",
        help: "Colour space: srgb, display-p3, adobe-rgb, prophoto, rec2020, ecirgb-v2, each also with -linear; \
               aces2065-1; camera (linear camera RGB before any profile); auto (sRGB, linear where the format or the look \
               is)",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.space, if text == AUTO { Ok(None) } else { space(text).map(Some) }),
    },
    Setting {
        name: "bits",
        alias: None,
        noun: "number of bits",
        kind: Kind::Words(const { &plain(&BITS) }),
        default: AUTO,
        group: Group::Output,
        placeholder: "",
        help: "Bits a sample; 32 is floating point",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.bits, one_of(&BITS, text)),
    },
    QUALITY,
    CHROMA_SUBSAMPLING,
    PROGRESSIVE,
    HDR,
    TIFF_COMPRESSION,
    WEBP_KIND,
    METADATA,
    ARTIST,
    COPYRIGHT,
    SET_TAG,
    Setting {
        name: "exposure",
        alias: None,
        noun: "exposure",
        kind: Kind::Number { least: -20.0, most: 20.0, whole: false, unit: "stops" },
        default: "0",
        group: Group::Picture,
        placeholder: "EV",
        help: "Exposure in stops: 1 is twice the light",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.exposure.stops, number(text)),
    },
    Setting {
        name: "auto-exposure",
        alias: None,
        noun: "switch",
        kind: Kind::Switch,
        default: "false",
        group: Group::Picture,
        placeholder: "BOOL",
        help: "Choose the exposure from the picture (=false where a recipe does and this picture shall not)",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.exposure.auto, one_of(&SWITCH, text)),
    },
    EXPOSURE_FROM_CHART,
    BLACK_FROM_CHART,
    CHART_LAYOUT,
    CHART_REFERENCE,
    DPI,
    Setting {
        name: "white-balance",
        alias: Some("wb"),
        noun: "white balance",
        kind: Kind::Text {
            form: "as-shot, daylight, auto, chart, a temperature with or without tint (5200K or 5200K,+8), a grey spot \
                   (spot:X,Y or spot:X,Y,SIDE), or multipliers (2.1,1,1.5)",
            example: "\"5200K\" or \"2.1,1,1.5\"",
        },
        default: "as-shot",
        group: Group::Picture,
        placeholder: "WB",
        help: "as-shot, daylight, auto, 5200K, 5200K,+8 (tint), spot:X,Y[,SIDE] (grey in the picture), R,G,B, or chart (by \
               the greys of `--exposure-from-chart`)",
        changes: Changes::Picture,
        set: set_balance,
    },
    Setting {
        name: "look",
        alias: None,
        noun: "look",
        kind: Kind::Words(const { &plain(&LOOKS) }),
        default: "neutral",
        group: Group::Picture,
        placeholder: "",
        help: "Rendering from scene to display; reproduction shows an original as it was measured; linear is strict: numbers \
               proportional to light, nothing automatic",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.look, one_of(&LOOKS, text)),
    },
    Setting {
        name: "gamut",
        alias: None,
        noun: "way with the gamut",
        kind: Kind::Words(const { &plain(&GAMUT) }),
        default: AUTO,
        group: Group::Picture,
        placeholder: "",
        help: "What becomes of colours that the output's space cannot show",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.gamut, one_of(&GAMUT, text)),
    },
    CONTRAST,
    SHADOWS,
    HIGHLIGHTS_TONE,
    BLACK,
    WHITE,
    CURVE,
    SATURATION,
    VIBRANCE,
    LUT,
    LUT_SPACE,
    DARK,
    FLAT,
    Setting {
        name: "highlights",
        alias: None,
        noun: "way with highlights",
        kind: Kind::Words(const { &plain(&HIGHLIGHTS) }),
        default: "rebuild",
        group: Group::Picture,
        placeholder: "",
        help: "What becomes of clipped highlights (the linear look keeps them unless clip is asked for)",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.highlights, one_of(&HIGHLIGHTS, text)),
    },
    LOCAL_TONE,
    HOT_PIXELS,
    BANDING,
    DENOISE,
    DENOISE_LUMA,
    DENOISE_CHROMA,
    Setting {
        name: "sharpen",
        alias: None,
        noun: "amount of sharpening",
        kind: Kind::Text { form: "auto, off, or a number from 0 to 2", example: "\"off\" or \"0.5\"" },
        default: AUTO,
        group: Group::Picture,
        placeholder: "AMOUNT",
        help: "Sharpness that lens and sensor took, given back: auto (as much as the picture's edges show; none in the \
               linear look and in camera RGB), off, or so many times that, 0 to 2",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.sharpen, amount(text, "amount of sharpening")),
    },
    Setting {
        name: "demosaic",
        alias: None,
        noun: "demosaicing method",
        kind: Kind::Words(const { &plain(&DEMOSAIC) }),
        default: "best",
        group: Group::Picture,
        placeholder: "",
        help: "How missing colours are interpolated",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.demosaic, one_of(&DEMOSAIC, text)),
    },
    ROTATE,
    FLIP,
    STRAIGHTEN,
    PERSPECTIVE,
    LENS,
    LENS_NAME,
    VIGNETTING,
    FRINGES,
    CROP,
    RESIZE,
    ENLARGE,
    Setting {
        name: "profile",
        alias: None,
        noun: "profile",
        kind: Kind::File(&[AUTO, "matrix"]),
        default: AUTO,
        group: Group::Picture,
        placeholder: "FILE",
        help: "Colour profile: a file, the name of a camera with a profile (\"Nikon D700\"), `auto` (your folder, then \
               built in, then the file's matrices) or `matrix`",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.profile, profile(text)),
    },
    Setting {
        name: "illuminant",
        alias: None,
        noun: "illuminant",
        kind: Kind::Text {
            form: "auto, a CIE light (A, D65, FL11, LED-B3), a temperature (3000K), a chromaticity (0.34,0.36), or, on the \
                   command line, a CSV file of a spectrum (lamp.csv, lamps.csv:NAME)",
            example: "\"FL11\" or \"3000K\"",
        },
        default: AUTO,
        group: Group::Picture,
        placeholder: "LIGHT",
        help: "The light that the profile's colours are computed for: auto (what the white tells), a CIE light (FL11), \
               3000K, x,y, or a spectrum (lamp.csv, lamps.csv:NAME); the white balance stays as it is",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.light, light(text)),
    },
    Setting {
        name: "from-preview",
        alias: None,
        noun: "switch",
        kind: Kind::Switch,
        default: "false",
        group: Group::Picture,
        placeholder: "BOOL",
        help: "Develop the embedded JPEG in place of the samples: the camera's own rendering, often smaller, 8 bits; for \
               files whose samples cannot be decoded, such as Nikon's High Efficiency",
        changes: Changes::Photo,
        set: |to, text| put(&mut to.from_preview, one_of(&SWITCH, text)),
    },
    Setting {
        name: "engine",
        alias: None,
        noun: "engine",
        kind: Kind::Words(const { &plain(&ENGINES) }),
        default: "darkroot",
        group: Group::Comparison,
        placeholder: "",
        help: "Second opinion: develop with imagepipe's fixed pipeline",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.engine, one_of(&ENGINES, text)),
    },
    Setting {
        name: "decoder",
        alias: None,
        noun: "decoder",
        kind: Kind::Words(const { &plain(&DECODERS) }),
        default: "flashraw",
        group: Group::Comparison,
        placeholder: "",
        help: "Library that decodes the samples",
        changes: Changes::Photo,
        set: |to, text| put(&mut to.decoder, one_of(&DECODERS, text)),
    },
];
