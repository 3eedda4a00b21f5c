//! Every setting that a person can name: the one place where it is written.
//!
//! Options of the command line with their help, recipe files and their errors, JSON and whatever face comes next are
//! made from this table. A new setting takes a field of a recipe, the stage that heeds it, and a row here.

use darkroot_develop::{Balance, Bits, Crop, Demosaic, Highlights, HotPixels, Look};
use darkroot_encode::{ChromaSubsampling, Format};
use darkroot_raw::Decoder;

use super::Engine;
use super::setting::{Changes, Group, Kind, Setting, Word};
use super::text::{NotAValue, balance, denoise, light, number, one_of, profile, space};

const fn word<T>(word: &'static str, value: T, help: &'static str) -> Word<T> {
    Word { word, also: "", value, help }
}

/// A word with another form.
const fn either<T>(word: &'static str, also: &'static str, value: T) -> Word<T> {
    Word { word, also, value, help: "" }
}

/// The words alone.
const fn plain<T, const N: usize>(words: &[Word<T>; N]) -> [Word<()>; N] {
    let mut plain = [word("", (), ""); N];
    let mut i = 0;
    while i < N {
        plain[i] = Word { word: words[i].word, also: words[i].also, value: (), help: words[i].help };
        i += 1;
    }
    plain
}

pub(super) const AUTO: &str = "auto";

pub(super) const FORMATS: [Word<Option<Format>>; 8] = [
    word(AUTO, None, "By the output's ending, else JPEG, or TIFF for linear light"),
    either("jpeg", "jpg", Some(Format::Jpeg)),
    word("png", Some(Format::Png), ""),
    either("tiff", "tif", Some(Format::Tiff)),
    word("webp", Some(Format::Webp), ""),
    word("avif", Some(Format::Avif), ""),
    word("exr", Some(Format::Exr), ""),
    word("jxl", Some(Format::Jxl), ""),
];
pub(super) const BITS: [Word<Option<Bits>>; 4] = [
    word(AUTO, None, "What suits the format: 8, 16 in TIFF, 32 in OpenEXR"),
    word("8", Some(Bits::Eight), ""),
    word("16", Some(Bits::Sixteen), ""),
    word("32", Some(Bits::Float), ""),
];
pub(super) const CHROMA: [Word<ChromaSubsampling>; 3] = [
    word("444", ChromaSubsampling::S444, ""),
    word("422", ChromaSubsampling::S422, ""),
    word("420", ChromaSubsampling::S420, ""),
];
pub(super) const SWITCH: [Word<bool>; 2] = [word("true", true, ""), word("false", false, "")];
pub(super) const LOOKS: [Word<Look>; 4] = [
    word("neutral", Look::Neutral, "Gentle contrast, soft highlights, colours as measured"),
    word("vivid", Look::Vivid, "More contrast and chroma"),
    word("flat", Look::Flat, "Low contrast, for further editing"),
    word("linear", Look::Linear, "Strictly scene-linear, for measurement"),
];
pub(super) const HIGHLIGHTS: [Word<Highlights>; 3] = [
    word("rebuild", Highlights::Rebuild, "Estimate clipped channels from the others"),
    word("clip", Highlights::Clip, "Cut all channels where the first one clips"),
    word("keep", Highlights::Keep, "Leave the values as they are"),
];
pub(super) const HOT_PIXELS: [Word<HotPixels>; 2] = [
    word(AUTO, HotPixels::Auto, "They take the light of those around them; stars stay"),
    word("off", HotPixels::Off, "They stay"),
];
pub(super) const DEMOSAIC: [Word<Demosaic>; 2] = [
    word("best", Demosaic::Best, "The best for the sensor"),
    word("bilinear", Demosaic::Bilinear, "Fast and soft"),
];
pub(super) const CROPS: [Word<Crop>; 2] = [
    word("default", Crop::Default, "What the maker shows"),
    word("active", Crop::Active, "Everything that light falls on"),
];
pub(super) const ENGINES: [Word<Engine>; 2] =
    [word("darkroot", Engine::Darkroot, ""), word("imagepipe", Engine::Imagepipe, "")];
pub(super) const DECODERS: [Word<Decoder>; 2] =
    [word("flashraw", Decoder::Flashraw, ""), word("rawloader", Decoder::Rawloader, "")];

/// Writes what a text means into its place.
fn put<T>(place: &mut T, value: Result<T, NotAValue>) -> Result<(), NotAValue> {
    *place = value?;
    Ok(())
}

/// Every setting, in the order in which people are shown them.
pub const SETTINGS: [Setting; 21] = [
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
    Setting {
        name: "quality",
        alias: None,
        noun: "quality",
        kind: Kind::Number { least: 1.0, most: 100.0, whole: true, unit: "" },
        default: "92",
        group: Group::Output,
        placeholder: "N",
        help: "Quality of JPEG and AVIF, 1 to 100",
        changes: Changes::Encoding,
        set: |to, text| put(&mut to.encode.quality, number(text).map(|n| n as u8)),
    },
    Setting {
        name: "chroma",
        alias: None,
        noun: "chroma subsampling",
        kind: Kind::Words(const { &plain(&CHROMA) }),
        default: "444",
        group: Group::Output,
        placeholder: "",
        help: "Chroma subsampling of JPEG",
        changes: Changes::Encoding,
        set: |to, text| put(&mut to.encode.subsampling, one_of(&CHROMA, text)),
    },
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
    Setting {
        name: "white-balance",
        alias: Some("wb"),
        noun: "white balance",
        kind: Kind::Text {
            form: "as-shot, daylight, auto, a temperature with or without tint (5200K or 5200K,+8), a grey spot \
                   (spot:X,Y or spot:X,Y,SIDE), or multipliers (2.1,1,1.5)",
            example: "\"5200K\" or \"2.1,1,1.5\"",
        },
        default: "as-shot",
        group: Group::Picture,
        placeholder: "WB",
        help: "as-shot, daylight, auto, 5200K, 5200K,+8 (tint), spot:X,Y[,SIDE] (grey in the picture), or R,G,B",
        changes: Changes::Picture,
        set: |to, text| put::<Balance>(&mut to.recipe.balance, balance(text)),
    },
    Setting {
        name: "look",
        alias: None,
        noun: "look",
        kind: Kind::Words(const { &plain(&LOOKS) }),
        default: "neutral",
        group: Group::Picture,
        placeholder: "",
        help: "Rendering from scene to display; linear is strict: numbers proportional to light, nothing automatic",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.look, one_of(&LOOKS, text)),
    },
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
    Setting {
        name: "hot-pixels",
        alias: None,
        noun: "way with hot pixels",
        kind: Kind::Words(const { &plain(&HOT_PIXELS) }),
        default: AUTO,
        group: Group::Picture,
        placeholder: "",
        help: "What becomes of hot and dead pixels (the linear look and camera RGB keep them)",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.hot_pixels, one_of(&HOT_PIXELS, text)),
    },
    Setting {
        name: "denoise",
        alias: None,
        noun: "amount of denoising",
        kind: Kind::Text { form: "auto, off, or a number from 0 to 2", example: "\"off\" or \"0.5\"" },
        default: AUTO,
        group: Group::Picture,
        placeholder: "AMOUNT",
        help: "Noise taken away before interpolation: auto (all that was measured; none in the linear look and in camera \
               RGB), off, or so many times that, 0 to 2",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.denoise.amount, denoise(text)),
    },
    Setting {
        name: "denoise-luma",
        alias: None,
        noun: "share of denoising",
        kind: Kind::Number { least: 0.0, most: 2.0, whole: false, unit: "" },
        default: "1",
        group: Group::Picture,
        placeholder: "SHARE",
        help: "Share of it for noise of brightness, 0 to 2",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.denoise.luma, number(text).map(|n| n as f32)),
    },
    Setting {
        name: "denoise-chroma",
        alias: None,
        noun: "share of denoising",
        kind: Kind::Number { least: 0.0, most: 2.0, whole: false, unit: "" },
        default: "1",
        group: Group::Picture,
        placeholder: "SHARE",
        help: "Share of it for noise of colour, 0 to 2",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.denoise.chroma, number(text).map(|n| n as f32)),
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
    Setting {
        name: "crop",
        alias: None,
        noun: "crop",
        kind: Kind::Words(const { &plain(&CROPS) }),
        default: "default",
        group: Group::Picture,
        placeholder: "",
        help: "Which part of the frame",
        changes: Changes::Picture,
        set: |to, text| put(&mut to.recipe.crop, one_of(&CROPS, text)),
    },
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
