//! The words that settings of the table have for their values.

use darkroot_develop::{Bits, Demosaic, Gamut, Highlights, LocalTone, Look, Mending};
use darkroot_encode::{ChromaSubsampling, Format, TiffCompression, WebpKind};
use darkroot_raw::Decoder;

use super::Engine;
use super::setting::Word;

pub(super) const fn word<T>(word: &'static str, value: T, help: &'static str) -> Word<T> {
    Word { word, also: "", value, help }
}

/// A word with another form.
const fn either<T>(word: &'static str, also: &'static str, value: T) -> Word<T> {
    Word { word, also, value, help: "" }
}

/// The words alone.
pub(super) const fn plain<T, const N: usize>(words: &[Word<T>; N]) -> [Word<()>; N] {
    let mut plain = [word("", (), ""); N];
    let mut i = 0;
    while i < N {
        plain[i] = Word { word: words[i].word, also: words[i].also, value: (), help: words[i].help };
        i += 1;
    }
    plain
}

pub(super) const AUTO: &str = "auto";
pub(super) const OFF: &str = "off";

pub(super) const FORMATS: [Word<Option<Format>>; 9] = [
    word(AUTO, None, "By the output's ending, else JPEG, or TIFF for reproductions and linear light"),
    either("jpeg", "jpg", Some(Format::Jpeg)),
    word("png", Some(Format::Png), ""),
    either("tiff", "tif", Some(Format::Tiff)),
    word("webp", Some(Format::Webp), ""),
    word("avif", Some(Format::Avif), ""),
    word("exr", Some(Format::Exr), ""),
    word("jxl", Some(Format::Jxl), ""),
    word("dng", Some(Format::Dng), "Linear DNG: camera RGB without a look, for another raw developer"),
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
pub(super) const WEBP: [Word<WebpKind>; 2] = [
    word("lossless", WebpKind::Lossless, ""),
    word("lossy", WebpKind::Lossy, "By the quality, with half the colour resolution"),
];
pub(super) const SWITCH: [Word<bool>; 2] = [word("true", true, ""), word("false", false, "")];
pub(super) const LOOKS: [Word<Look>; 7] = [
    word("neutral", Look::Neutral, "Gentle contrast, soft highlights, colours as measured"),
    word("vivid", Look::Vivid, "More contrast and chroma"),
    word("flat", Look::Flat, "Low contrast, for further editing"),
    word(
        "camera",
        Look::Camera,
        "As the camera rendered it: a curve and chroma fitted to the embedded preview",
    ),
    word(
        "dcp",
        Look::Profile,
        "As the maker of the profile in use would show it: look table and tone curve of a DCP",
    ),
    word("reproduction", Look::Reproduction, "Colorimetric, no tone curve: an original as it was measured"),
    word("linear", Look::Linear, "Strictly scene-linear, for measurement"),
];
pub(super) const HIGHLIGHTS: [Word<Highlights>; 3] = [
    word("rebuild", Highlights::Rebuild, "Estimate clipped channels from the others"),
    word("clip", Highlights::Clip, "Cut all channels where the first one clips"),
    word("keep", Highlights::Keep, "Leave the values as they are"),
];
pub(super) const GAMUT: [Word<Gamut>; 3] = [
    word(AUTO, Gamut::Auto, "Cut in the reproduction look, mapped in the others"),
    word("clip", Gamut::Clip, "Cut each channel; a note says how much that was"),
    word("map", Gamut::Map, "Less chroma at the same hue and lightness"),
];
pub(super) const COMPRESSION: [Word<TiffCompression>; 2] = [
    word("deflate", TiffCompression::Deflate, "Lossless"),
    word("none", TiffCompression::None, "Any program reads it, and guidelines for archives ask for it"),
];
pub(super) const BANDING: [Word<Mending>; 2] = [
    word(AUTO, Mending::Auto, "It is taken away where it is certain"),
    word("off", Mending::Off, "It stays"),
];
pub(super) const LOCAL_TONE: [Word<LocalTone>; 2] =
    [word(AUTO, LocalTone::Auto, "It is applied"), word("off", LocalTone::Off, "It is left out")];
pub(super) const HOT_PIXELS: [Word<Mending>; 2] = [
    word(AUTO, Mending::Auto, "They take the light of those around them; stars stay"),
    word("off", Mending::Off, "They stay"),
];
pub(super) const DEMOSAIC: [Word<Demosaic>; 2] = [
    word("best", Demosaic::Best, "The best for the sensor"),
    word("bilinear", Demosaic::Bilinear, "Fast and soft"),
];
pub(super) const ENGINES: [Word<Engine>; 2] =
    [word("darkroot", Engine::Darkroot, ""), word("imagepipe", Engine::Imagepipe, "")];
pub(super) const DECODERS: [Word<Decoder>; 2] =
    [word("flashraw", Decoder::Flashraw, ""), word("rawloader", Decoder::Rawloader, "")];
