//! What the texts of settings mean, for the command line and for files alike.

use std::path::PathBuf;

use darkroot_develop::{Balance, OutputSpace};
use darkroot_raw::Decoder;

use super::ProfileChoice;
use super::setting::{Kind, Setting, Word};
use super::spaces::{self, SPACES};
use super::words::{AUTO, DECODERS, OFF, SWITCH};
use crate::light::LightSource;

/// A text that is no value. The message says what is.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{}` is no {noun}: use {allowed}", crate::quoted(text))]
pub struct NotAValue {
    text: String,
    noun: &'static str,
    allowed: String,
}

impl NotAValue {
    /// A text that is no value of a setting.
    pub(super) fn of(setting: &Setting, text: &str) -> Self {
        Self { text: text.to_owned(), noun: setting.noun, allowed: setting.allowed() }
    }

    /// The same in the words of the setting whose value it should be.
    pub(super) fn in_setting(self, setting: &Setting) -> Self {
        Self::of(setting, &self.text)
    }

    /// The path is relative to a folder whose name is no UTF-8.
    pub(crate) fn not_utf8(text: &str) -> Self {
        let allowed = "an absolute path, because the recipe's folder has a name that is not UTF-8".to_owned();
        Self { text: text.to_owned(), noun: "usable path", allowed }
    }

    pub(super) fn plain(text: &str, noun: &'static str, allowed: impl Into<String>) -> Self {
        Self { text: text.to_owned(), noun, allowed: allowed.into() }
    }
}

impl Setting {
    /// What its values are, in words.
    pub fn allowed(&self) -> String {
        match self.kind {
            Kind::Words(words) => one_of_words(words),
            Kind::Switch => one_of_words(&SWITCH),
            Kind::Number { least, most, whole: true, .. } => format!("a whole number in {least}..={most}"),
            Kind::Number { least, most, unit: "", .. } => format!("a number from {least} to {most}"),
            Kind::Number { least, most, unit, .. } => format!("a number of {unit} from {least} to {most}"),
            Kind::Text { form, .. } => form.to_owned(),
            Kind::File(words) if self.name == "profile" => {
                format!("a file, the name of a camera with a profile, {}", words.join(" or "))
            }
            Kind::File(words) => format!("a file, a name, {}", words.join(" or ")),
            Kind::Path(words) => format!("a file, {}", words.join(" or ")),
        }
    }

    /// How a value is written in a recipe file.
    pub fn example(&self) -> String {
        let numbers =
            |words: &[Word<()>]| words.iter().rev().find(|w| w.word.parse::<f64>().is_ok()).map(|w| w.word);
        match self.kind {
            Kind::Switch => "true or false".to_owned(),
            Kind::Number { whole: true, .. } => format!("a number such as {}", self.default),
            Kind::Number { .. } => "a number such as 0.5".to_owned(),
            Kind::Text { example, .. } => format!("a text in quotes such as {example}"),
            Kind::File(_) => "a text in quotes such as \"camera.toml\"".to_owned(),
            Kind::Path(_) => "a text in quotes such as \"frames/one.dng\"".to_owned(),
            Kind::Words(words) => match numbers(words) {
                Some(number) => format!("a number such as {number}"),
                None => {
                    let all: Vec<String> = words.iter().map(|w| format!("\"{}\"", w.word)).collect();
                    format!("one of these, in quotes: {}", all.join(", "))
                }
            },
        }
    }
}

fn one_of_words<T>(words: &[Word<T>]) -> String {
    match words.split_last() {
        Some((last, before)) => {
            let before: Vec<&str> = before.iter().map(|w| w.word).collect();
            format!("{} or {}", before.join(", "), last.word)
        }
        None => String::new(),
    }
}

/// The word of a list that a text is, by either of its forms.
pub(super) fn word<'w, T>(list: &'w [Word<T>], text: &str) -> Option<&'w Word<T>> {
    list.iter().find(|w| w.word == text || (!w.also.is_empty() && w.also == text))
}

/// Whether a text names a file, not a camera: it says in which folder, has the ending of a profile, or is there.
pub(crate) fn is_file_name(text: &str) -> bool {
    let path = std::path::Path::new(text);
    let ending =
        path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml") || e.eq_ignore_ascii_case("dcp"));
    !text.is_empty() && (ending || text.contains(std::path::is_separator) || path.is_file())
}

/// What a word of a list stands for.
pub(super) fn one_of<T: Copy>(list: &[Word<T>], text: &str) -> Result<T, NotAValue> {
    let found = word(list, text).map(|w| w.value);
    found.ok_or_else(|| NotAValue::plain(text, "value", one_of_words(list)))
}

/// A finite number.
pub(super) fn number(text: &str) -> Result<f64, NotAValue> {
    let number: Option<f64> = text.parse().ok();
    number.filter(|n| n.is_finite()).ok_or_else(|| NotAValue::plain(text, "number", "a number"))
}

/// A colour space: one of [`SPACES`], each also with `-linear`, `aces2065-1` or `camera`.
///
/// # Errors
/// It is none.
pub fn space(text: &str) -> Result<OutputSpace, NotAValue> {
    spaces::space(text).ok_or_else(|| {
        let names = SPACES.map(|(name, _)| name).join(", ");
        let allowed = format!("{names}, each also with -linear, aces2065-1, or camera");
        NotAValue::plain(text, "colour space", allowed)
    })
}

/// An amount of what `noun` says: auto (`None`), off, or a number from 0 to 2.
///
/// # Errors
/// It is none.
pub fn amount(text: &str, noun: &'static str) -> Result<Option<f32>, NotAValue> {
    match text {
        AUTO => Ok(None),
        "off" => Ok(Some(0.0)),
        _ => match number(text) {
            Ok(amount) if (0.0..=2.0).contains(&amount) => Ok(Some(amount as f32)),
            _ => Err(NotAValue::plain(text, noun, "auto, off, or a number from 0 to 2")),
        },
    }
}

/// A white balance: as-shot, daylight, auto, `5200K`, `5200K,+8`, `spot:X,Y[,SIDE]` or `R,G,B`.
///
/// # Errors
/// It is none.
pub fn balance(text: &str) -> Result<Balance, NotAValue> {
    let usage = || NotAValue::plain(text, "white balance", "a white balance");
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
    one_of(&DECODERS, text)
}

pub(super) fn profile(text: &str) -> Result<ProfileChoice, NotAValue> {
    match text {
        "" => Err(NotAValue::plain(text, "profile", "a file")),
        AUTO => Ok(ProfileChoice::Automatic),
        "matrix" => Ok(ProfileChoice::Matrix),
        file => Ok(ProfileChoice::File(file.into())),
    }
}

/// A light that needs no file.
pub(super) fn light(text: &str) -> Result<Option<LightSource>, NotAValue> {
    if text == AUTO {
        return Ok(None);
    }
    let named = LightSource::by_name(text);
    named.map(Some).ok_or_else(|| NotAValue::plain(text, "illuminant", crate::light::known_names()))
}

/// A path of a setting; none for the word that says so.
pub(super) fn path(text: &str, setting: &Setting) -> Result<Option<PathBuf>, NotAValue> {
    match text {
        "" => Err(NotAValue::of(setting, text)),
        OFF => Ok(None),
        path => Ok(Some(path.into())),
    }
}

/// Numbers with commas between them.
pub fn numbers<T: std::str::FromStr>(text: &str) -> Option<Vec<T>> {
    text.split(',').map(|n| n.trim().parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::words::{
        BITS, CHROMA, COMPRESSION, DEMOSAIC, ENGINES, FORMATS, GAMUT, HIGHLIGHTS, LOOKS,
    };
    use super::super::{Key, Settings};
    use super::*;
    use darkroot_encode::Format;

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
        let exposure = |text: &str| Key::named("exposure").checked(text);
        assert!(exposure("bright").is_err() && exposure("nan").is_err() && exposure("100").is_err());
        for (text, stored) in [("-1.5", "-1.5"), ("+.50", "0.5"), ("1e-1", "0.1"), ("-0", "0"), ("2.", "2")] {
            assert_eq!(exposure(text).unwrap(), stored);
        }
    }

    #[test]
    fn quality_is_a_whole_number() {
        let quality = |text: &str| Key::named("quality").checked(text);
        assert_eq!(quality("80"), Ok("80".to_owned()));
        assert!(["0", "101", "80.5", "good"].iter().all(|text| quality(text).is_err()));
    }

    #[test]
    fn the_default_texts_mean_the_default_settings() {
        let mut settings = Settings::default();
        settings.encode.quality = 1;
        for key in Key::all() {
            key.apply(key.default_text(), &mut settings).unwrap();
            assert_eq!(key.checked(key.default_text()).unwrap(), key.default_text());
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
        named(&LOOKS, &["Neutral", "Vivid", "Flat", "Camera", "Profile", "Reproduction", "Linear"]);
        same(&HIGHLIGHTS);
        same(&GAMUT);
        same(&COMPRESSION);
        same(&DEMOSAIC);
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
        for key in Key::all() {
            let words = if let Kind::Words(words) = key.setting().kind { words } else { &[] };
            for word in words {
                assert!(key.checked(word.word).is_ok(), "{key} {}", word.word);
            }
            if key.default_text().is_empty() {
                assert_eq!(key.checked("").as_deref(), Ok(""), "{key}");
                continue;
            }
            let message = key.checked("").unwrap_err().to_string();
            assert!(words.iter().all(|w| message.contains(w.word)), "{message}");
        }
    }

    #[test]
    fn every_space_that_can_be_named_is_offered() {
        let setting = Key::named("space").setting();
        for (name, _) in SPACES {
            assert!(setting.allowed().contains(name) && setting.help.contains(name), "{name}");
        }
    }
}
