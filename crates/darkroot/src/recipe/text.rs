//! What the texts of settings mean, for the command line and for files alike.

use darkroot_develop::{Balance, Bits, Crop, Demosaic, Highlights, Look, OutputSpace};
use darkroot_encode::{ChromaSubsampling, Format};
use darkroot_raw::Decoder;

use super::Key;
use crate::settings::{self, Engine, ProfileChoice, SPACES, Settings};

/// A text that is no value. The message says what is.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` is no {what}: use {allowed}")]
pub struct NotAValue {
    text: String,
    what: &'static str,
    allowed: String,
}

/// A word that stands for a value.
#[derive(Debug, Clone, Copy)]
pub struct Word<T> {
    /// As it is written.
    pub word: &'static str,
    /// What it stands for.
    pub value: T,
    /// What it means, for help; empty where the word says it.
    pub help: &'static str,
}

const fn word<T>(word: &'static str, value: T, help: &'static str) -> Word<T> {
    Word { word, value, help }
}

const AUTO: &str = "auto";

const FORMATS: [Word<Option<Format>>; 8] = [
    word(AUTO, None, "By the output's ending, else JPEG, or TIFF for linear light"),
    word("jpeg", Some(Format::Jpeg), ""),
    word("png", Some(Format::Png), ""),
    word("tiff", Some(Format::Tiff), ""),
    word("webp", Some(Format::Webp), ""),
    word("avif", Some(Format::Avif), ""),
    word("exr", Some(Format::Exr), ""),
    word("jxl", Some(Format::Jxl), ""),
];
const BITS: [Word<Option<Bits>>; 4] = [
    word(AUTO, None, "What suits the format: 8, 16 in TIFF, 32 in OpenEXR"),
    word("8", Some(Bits::Eight), ""),
    word("16", Some(Bits::Sixteen), ""),
    word("32", Some(Bits::Float), ""),
];
const CHROMA: [Word<ChromaSubsampling>; 3] = [
    word("444", ChromaSubsampling::S444, ""),
    word("422", ChromaSubsampling::S422, ""),
    word("420", ChromaSubsampling::S420, ""),
];
const SWITCH: [Word<bool>; 2] = [word("true", true, ""), word("false", false, "")];
const LOOKS: [Word<Look>; 4] = [
    word("neutral", Look::Neutral, "Gentle contrast, soft highlights, colours as measured"),
    word("vivid", Look::Vivid, "More contrast and chroma"),
    word("flat", Look::Flat, "Low contrast, for further editing"),
    word("linear", Look::Linear, "Strictly scene-linear, for measurement"),
];
const HIGHLIGHTS: [Word<Highlights>; 3] = [
    word("rebuild", Highlights::Rebuild, "Estimate clipped channels from the others"),
    word("clip", Highlights::Clip, "Cut all channels where the first one clips"),
    word("keep", Highlights::Keep, "Leave the values as they are"),
];
const DEMOSAIC: [Word<Demosaic>; 2] = [
    word("best", Demosaic::Best, "The best for the sensor"),
    word("bilinear", Demosaic::Bilinear, "Fast and soft"),
];
const CROPS: [Word<Crop>; 2] = [
    word("default", Crop::Default, "What the maker shows"),
    word("active", Crop::Active, "Everything that light falls on"),
];
const ENGINES: [Word<Engine>; 2] =
    [word("darkroot", Engine::Darkroot, ""), word("imagepipe", Engine::Imagepipe, "")];
const DECODERS: [Word<Decoder>; 2] =
    [word("flashraw", Decoder::Flashraw, ""), word("rawloader", Decoder::Rawloader, "")];

/// The words of a key, in the order of help; empty where there are other values than words from a list.
pub fn words(key: Key) -> Vec<Word<()>> {
    fn plain<T>(list: &[Word<T>]) -> Vec<Word<()>> {
        list.iter().map(|w| word(w.word, (), w.help)).collect()
    }
    match key {
        Key::Format => plain(&FORMATS),
        Key::Bits => plain(&BITS),
        Key::Chroma => plain(&CHROMA),
        Key::AutoExposure => plain(&SWITCH),
        Key::Look => plain(&LOOKS),
        Key::Highlights => plain(&HIGHLIGHTS),
        Key::Demosaic => plain(&DEMOSAIC),
        Key::Crop => plain(&CROPS),
        Key::Engine => plain(&ENGINES),
        Key::Decoder => plain(&DECODERS),
        Key::Space | Key::Quality | Key::Exposure | Key::WhiteBalance | Key::Profile => Vec::new(),
    }
}

/// Puts what the text of a key means into the settings.
pub(super) fn apply(key: Key, text: &str, to: &mut Settings) -> Result<(), NotAValue> {
    match key {
        Key::Format => to.format = one_of(&FORMATS, "format", text)?,
        Key::Space => to.space = if text == AUTO { None } else { Some(space(text)?) },
        Key::Bits => to.bits = one_of(&BITS, "number of bits", text)?,
        Key::Quality => to.encode.quality = quality(text)?,
        Key::Chroma => to.encode.subsampling = one_of(&CHROMA, "chroma subsampling", text)?,
        Key::Exposure => to.recipe.exposure.stops = stops(text)?,
        Key::AutoExposure => to.recipe.exposure.auto = one_of(&SWITCH, "switch", text)?,
        Key::WhiteBalance => to.recipe.balance = balance(text)?,
        Key::Look => to.recipe.look = one_of(&LOOKS, "look", text)?,
        Key::Highlights => to.recipe.highlights = one_of(&HIGHLIGHTS, "way with highlights", text)?,
        Key::Demosaic => to.recipe.demosaic = one_of(&DEMOSAIC, "demosaicing method", text)?,
        Key::Crop => to.recipe.crop = one_of(&CROPS, "crop", text)?,
        Key::Profile => to.profile = profile(text)?,
        Key::Engine => to.engine = one_of(&ENGINES, "engine", text)?,
        Key::Decoder => to.decoder = decoder(text)?,
    }
    Ok(())
}

/// The text, if it is a value of the key; numbers in the one form that they are compared and stored in.
///
/// # Errors
/// It is none.
pub fn checked(key: Key, text: &str) -> Result<String, NotAValue> {
    let mut scratch = Settings::default();
    apply(key, text, &mut scratch)?;
    Ok(match key {
        Key::Quality => scratch.encode.quality.to_string(),
        // Never `-0`.
        Key::Exposure => (scratch.recipe.exposure.stops + 0.0).to_string(),
        _ => text.to_owned(),
    })
}

fn one_of<T: Copy>(list: &[Word<T>], what: &'static str, text: &str) -> Result<T, NotAValue> {
    list.iter().find(|w| w.word == text).map(|w| w.value).ok_or_else(|| {
        let words: Vec<&str> = list.iter().map(|w| w.word).collect();
        let allowed = match words.split_last() {
            Some((last, before)) => format!("{} or {last}", before.join(", ")),
            None => String::new(),
        };
        NotAValue { text: text.to_owned(), what, allowed }
    })
}

/// A colour space: one of [`SPACES`], each also with `-linear`, `aces2065-1` or `camera`.
///
/// # Errors
/// It is none.
pub fn space(text: &str) -> Result<OutputSpace, NotAValue> {
    settings::space(text).ok_or_else(|| {
        let names = SPACES.map(|(name, _)| name).join(", ");
        let allowed = format!("{names}, each also with -linear, aces2065-1, or camera");
        NotAValue { text: text.to_owned(), what: "colour space", allowed }
    })
}

/// A white balance: as-shot, daylight, auto, `5200K`, `5200K,+8`, `spot:X,Y[,SIDE]` or `R,G,B`.
///
/// # Errors
/// It is none.
pub fn balance(text: &str) -> Result<Balance, NotAValue> {
    let usage = || NotAValue {
        text: text.to_owned(),
        what: "white balance",
        allowed:
            "as-shot, daylight, auto, a temperature with or without tint (5200K or 5200K,+8), a grey spot \
                  (spot:X,Y or spot:X,Y,SIDE), or multipliers (2.1,1,1.5)"
                .to_owned(),
    };
    match text {
        "as-shot" => return Ok(Balance::AsShot),
        "daylight" => return Ok(Balance::Daylight),
        "auto" => return Ok(Balance::Auto),
        _ => {}
    }
    if let Some(place) = text.strip_prefix("spot:") {
        let numbers = numbers::<usize>(place).ok_or_else(usage)?;
        return match numbers[..] {
            [x, y] => Ok(Balance::Spot { x, y, side: 32 }),
            [x, y, side] => Ok(Balance::Spot { x, y, side }),
            _ => Err(usage()),
        };
    }
    let (first, rest) = text.split_once(',').unwrap_or((text, ""));
    if let Some(kelvin) = first.strip_suffix(['K', 'k']) {
        let kelvin = kelvin.parse().map_err(|_| usage())?;
        let tint = if rest.is_empty() { 0.0 } else { rest.parse().map_err(|_| usage())? };
        return Ok(Balance::Kelvin { kelvin, tint });
    }
    match numbers::<f64>(text).as_deref() {
        Some(&[r, g, b]) => Ok(Balance::Multipliers([r, g, b])),
        _ => Err(usage()),
    }
}

/// A decoder: flashraw or rawloader.
///
/// # Errors
/// It is none.
pub fn decoder(text: &str) -> Result<Decoder, NotAValue> {
    one_of(&DECODERS, "decoder", text)
}

fn stops(text: &str) -> Result<f64, NotAValue> {
    const MOST: f64 = 20.0;
    let stops: Option<f64> = text.parse().ok();
    stops.filter(|s| s.abs() <= MOST).ok_or_else(|| NotAValue {
        text: text.to_owned(),
        what: "exposure",
        allowed: format!("a number of stops from -{MOST} to {MOST}"),
    })
}

fn quality(text: &str) -> Result<u8, NotAValue> {
    let quality: Option<u8> = text.parse().ok();
    quality.filter(|q| (1..=100).contains(q)).ok_or_else(|| NotAValue {
        text: text.to_owned(),
        what: "quality",
        allowed: "a whole number in 1..=100".to_owned(),
    })
}

fn profile(text: &str) -> Result<ProfileChoice, NotAValue> {
    match text {
        "" => Err(NotAValue {
            text: String::new(),
            what: "profile",
            allowed: "a file, auto or matrix".to_owned(),
        }),
        AUTO => Ok(ProfileChoice::Automatic),
        "matrix" => Ok(ProfileChoice::Matrix),
        file => Ok(ProfileChoice::File(file.into())),
    }
}

/// The path is relative to a folder whose name is no UTF-8.
pub(super) fn not_utf8(text: &str) -> NotAValue {
    let allowed = "an absolute path, because the recipe's folder has a name that is not UTF-8".to_owned();
    NotAValue { text: text.to_owned(), what: "usable profile", allowed }
}

/// Numbers with commas between them.
pub fn numbers<T: std::str::FromStr>(text: &str) -> Option<Vec<T>> {
    text.split(',').map(|n| n.trim().parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_balances_are_read_as_people_write_them() {
        assert_eq!(balance("as-shot"), Ok(Balance::AsShot));
        assert_eq!(balance("5200K"), Ok(Balance::Kelvin { kelvin: 5200.0, tint: 0.0 }));
        assert_eq!(balance("5200k,-8.5"), Ok(Balance::Kelvin { kelvin: 5200.0, tint: -8.5 }));
        assert_eq!(balance("spot:10,20"), Ok(Balance::Spot { x: 10, y: 20, side: 32 }));
        assert_eq!(balance("2.1,1,1.5"), Ok(Balance::Multipliers([2.1, 1.0, 1.5])));
        for wrong in ["", "warm", "5200", "5200K,", "spot:1", "1,2", "1,2,x"] {
            let accepted = wrong == "5200K,";
            assert_eq!(balance(wrong).is_ok(), accepted, "{wrong}");
        }
    }

    #[test]
    fn exposure_is_a_number_of_stops() {
        assert!((stops("-1.5").unwrap() + 1.5).abs() < 1e-12);
        assert!(stops("bright").is_err() && stops("nan").is_err() && stops("100").is_err());
        for (text, stored) in [("+.50", "0.5"), ("1e-1", "0.1"), ("-0", "0"), ("2.", "2")] {
            assert_eq!(checked(Key::Exposure, text).unwrap(), stored);
        }
    }

    #[test]
    fn the_default_texts_mean_the_default_settings() {
        let mut settings = Settings::default();
        settings.encode.quality = 1;
        for key in Key::ALL {
            apply(key, key.default_text(), &mut settings).unwrap();
            assert_eq!(checked(key, key.default_text()).unwrap(), key.default_text());
        }
        assert_eq!(format!("{settings:?}"), format!("{:?}", Settings::default()));
    }

    #[test]
    fn every_word_stands_for_the_value_of_that_name() {
        fn named<T: std::fmt::Debug>(list: &[Word<T>], names: &[&str]) {
            let values: Vec<String> = list.iter().map(|w| format!("{:?}", w.value)).collect();
            assert_eq!(values, names);
        }
        fn same<T: std::fmt::Debug>(list: &[Word<T>]) {
            for word in list {
                assert_eq!(format!("{:?}", word.value).to_lowercase(), word.word);
            }
        }
        same(&LOOKS);
        same(&HIGHLIGHTS);
        same(&DEMOSAIC);
        same(&CROPS);
        same(&ENGINES);
        same(&DECODERS);
        same(&SWITCH);
        named(&CHROMA, &["S444", "S422", "S420"]);
        named(&BITS, &["None", "Some(Eight)", "Some(Sixteen)", "Some(Float)"]);
        for format in Format::ALL {
            let word = FORMATS.iter().find(|w| w.value == Some(format)).unwrap().word;
            assert_eq!(word, format!("{format:?}").to_lowercase());
        }
    }

    #[test]
    fn every_word_is_a_value_and_a_wrong_one_names_them_all() {
        for key in Key::ALL {
            let words = words(key);
            for word in &words {
                assert!(checked(key, word.word).is_ok(), "{key} {}", word.word);
            }
            let error = checked(key, "");
            let message = error.unwrap_err().to_string();
            assert!(words.iter().all(|w| message.contains(w.word)), "{message}");
        }
    }
}
