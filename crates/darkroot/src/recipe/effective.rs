//! What holds for one file: a value for every key, and where each is from.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use darkroot_encode::Format;

use super::written::written;
use super::{Layer, Origin, RecipeError};
use crate::metadata::{self, Beside, Xmp};
use crate::naming::{NamingError, Target};
use crate::settings::{Key, Settings};

/// Every key with its text and its origin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Effective {
    values: BTreeMap<Key, (String, Origin)>,
    /// What the photograph's sidecar of XMP says, as a packet.
    said: Option<String>,
    /// Which sidecar of XMP could not be used, and why.
    left_out: Option<String>,
}

/// What the sidecar says, and which one was left out, go by these names among [`texts`](Effective::texts).
const SAID: &str = "sidecar";
const LEFT_OUT: &str = "sidecar-left-out";

impl Default for Effective {
    /// The defaults.
    fn default() -> Self {
        let value = |key: Key| (key, (key.default_text().to_owned(), Origin::Default));
        Self { values: Key::all().map(value).collect(), said: None, left_out: None }
    }
}

impl Effective {
    /// What the layer says counts more than what was there.
    pub(super) fn lay(&mut self, layer: &Layer) {
        for (key, text) in layer.iter() {
            self.values.insert(key, (text.to_owned(), layer.origin.clone()));
        }
    }

    /// Takes what stands in the sidecar of XMP beside a photograph, if that goes into its picture.
    pub(super) fn read_sidecar(&mut self, input: &Path) {
        if matches!(self.get(Key::METADATA).0, "all" | "no-gps") {
            let Beside { packet, left_out } = metadata::beside(input);
            (self.said, self.left_out) = (packet, left_out);
        }
    }

    /// The text of a key and where it is from.
    pub fn get(&self, key: Key) -> (&str, &Origin) {
        // Every key is there from the beginning.
        self.values.get(&key).map_or((key.default_text(), &Origin::Default), |(text, origin)| (text, origin))
    }

    /// The settings that the texts mean.
    ///
    /// # Errors
    /// A text that is no value of its key; none when this is from [`Layers`](super::Layers).
    pub fn settings(&self) -> Result<Settings, RecipeError> {
        let mut settings = Settings::default();
        for (key, (text, _)) in &self.values {
            let key = *key;
            key.apply(text, &mut settings).map_err(|wrong| RecipeError::Flag { key, wrong })?;
            if text != key.default_text() {
                settings.told.push((key.name(), text.clone()));
            }
        }
        if let Some(packet) = &self.said {
            let said = Xmp::parse(packet).map_err(|message| RecipeError::Sidecar { message })?;
            settings.about.sidecar = Some(Arc::new(said));
        }
        settings.about.left_out.clone_from(&self.left_out);
        Ok(settings)
    }

    /// The format of the picture: `--format`, else what the ending of `-o` says, else what recipes say, else
    /// what suits the settings.
    ///
    /// # Errors
    /// Nobody says a format but a name whose ending is none, or `--format` and the ending of `-o` say different ones.
    pub fn format(&self, target: &Target, settings: &Settings, flags: &Layer) -> Result<Format, NamingError> {
        let asked = settings.format;
        let by_flag = flags.get(Key::FORMAT).is_some_and(|text| text != "auto");
        match (asked, target.format()) {
            (Some(asked), Ok(Some(named))) if by_flag && asked != named => {
                Err(NamingError::OtherFormat { path: target.path().to_owned(), named, asked })
            }
            (Some(format), _) if by_flag => Ok(format),
            (_, Ok(Some(format))) => Ok(format),
            (Some(format), _) => Ok(format),
            (None, Ok(None)) => Ok(settings.default_format()),
            (None, Err(error)) => Err(error),
        }
    }

    /// The files that a value of this is from, with the keys that each of them decided; the weakest first.
    pub fn files(&self) -> Vec<(&Origin, Vec<Key>)> {
        let mut files: Vec<(&Origin, Vec<Key>)> = Vec::new();
        for (key, (_, origin)) in &self.values {
            if origin.path().is_none() {
                continue;
            }
            match files.iter_mut().find(|(o, _)| *o == origin) {
                Some((_, keys)) => keys.push(*key),
                None => files.push((origin, vec![*key])),
            }
        }
        // A folder that is deeper counts more, and its path is longer.
        files.sort_by_key(|(origin, _)| match origin {
            Origin::Default | Origin::Flag => (0, 0),
            Origin::Folder(path) => (1, path.components().count()),
            Origin::Recipe(_) => (2, 0),
            Origin::Sidecar(_) => (3, 0),
        });
        files
    }

    /// Name and text of every key: all that another process must know to make the same picture.
    pub fn texts(&self) -> BTreeMap<String, String> {
        let beside = [(SAID, &self.said), (LEFT_OUT, &self.left_out)];
        let beside = beside.into_iter().filter_map(|(name, text)| Some((name.to_owned(), text.clone()?)));
        self.values
            .iter()
            .map(|(key, (text, _))| (key.name().to_owned(), text.clone()))
            .chain(beside)
            .collect()
    }

    /// What [`texts`](Self::texts) gave; keys that are missing have their defaults. Where the values were from
    /// is not known any more: they count as flags.
    ///
    /// # Errors
    /// A name that is no key, or a text that is no value of it.
    pub fn from_texts(texts: &BTreeMap<String, String>) -> Result<Self, RecipeError> {
        let named = |(name, text): (&String, &String)| {
            let key = Key::from_name(name).ok_or_else(|| RecipeError::Name { name: name.clone() })?;
            Ok((key, text.clone()))
        };
        let settings = texts.iter().filter(|(name, _)| ![SAID, LEFT_OUT].contains(&name.as_str()));
        let values: Vec<(Key, String)> = settings.map(named).collect::<Result<_, RecipeError>>()?;
        let beside = |name| texts.get(name).cloned();
        let mut effective = Self { said: beside(SAID), left_out: beside(LEFT_OUT), ..Self::default() };
        effective.lay(&Layer::flags(values)?);
        Ok(effective)
    }

    /// As a recipe file, each line with where its value is from. `shown` says how a path is written for people.
    pub fn to_toml(&self, shown: impl Fn(&Path) -> String) -> String {
        /// Columns of a value, so that most comments stand below each other.
        const WIDTH: usize = 34;
        let mut out = String::new();
        for (key, (text, origin)) in &self.values {
            let line = format!("{key} = {}", written(*key, text));
            let from = origin.path().map_or_else(|| origin.to_string(), &shown);
            let from = crate::shown(&from);
            let _ = writeln!(out, "{line:WIDTH$}  # {from}");
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::SETTINGS;

    fn with(values: &[(Key, &str)]) -> (Effective, Layer) {
        let flags = Layer::flags(values.iter().map(|(key, text)| (*key, (*text).to_owned()))).unwrap();
        let mut effective = Effective::default();
        effective.lay(&flags);
        (effective, flags)
    }

    #[test]
    fn texts_make_the_same_settings_in_another_process() {
        let (effective, _) = with(&[
            (Key::named("exposure"), "0.50"),
            (Key::named("white-balance"), "5200K,+8"),
            (Key::named("bits"), "16"),
        ]);
        let texts = effective.texts();
        assert_eq!((texts.len(), texts["exposure"].as_str()), (SETTINGS.len(), "0.5"));
        let again = Effective::from_texts(&texts).unwrap();
        assert_eq!(again.texts(), texts);
        let debug = |e: &Effective| format!("{:?}", e.settings().unwrap());
        assert_eq!(debug(&again), debug(&effective));
    }

    #[test]
    fn texts_that_mean_nothing_are_refused() {
        let one = |name: &str, text: &str| [(name.to_owned(), text.to_owned())].into();
        assert!(Effective::from_texts(&one("clarity", "1")).is_err());
        assert!(Effective::from_texts(&one("look", "film")).is_err());
        assert_eq!(Effective::from_texts(&BTreeMap::new()).unwrap(), Effective::default());
    }

    #[test]
    fn the_format_is_what_the_flag_says_then_the_ending_then_a_recipe() {
        let nobody = Layer::flags([]).unwrap();
        let format = |recipe: &str, flag: Option<&str>, target: &str| {
            let (mut effective, _) = with(&[(Key::named("format"), recipe)]);
            let flags = flag.map(|f| Layer::flags([(Key::named("format"), f.to_owned())]).unwrap());
            let flags = flags.as_ref().unwrap_or(&nobody);
            effective.lay(flags);
            effective.format(&Target::parse(target.as_ref()).unwrap(), &effective.settings().unwrap(), flags)
        };
        assert_eq!(format("auto", None, "out/"), Ok(Format::Jpeg));
        assert_eq!(format("png", None, "out/"), Ok(Format::Png));
        assert_eq!(format("png", None, "o.tif"), Ok(Format::Tiff));
        assert_eq!(format("png", None, "{stem}.{ext}"), Ok(Format::Png));
        assert_eq!(format("png", None, "o.bin"), Ok(Format::Png));
        assert_eq!(format("png", Some("webp"), "o.bin"), Ok(Format::Webp));
        assert!(matches!(format("png", Some("webp"), "o.tif"), Err(NamingError::OtherFormat { .. })));
        assert_eq!(format("png", Some("auto"), "out/"), Ok(Format::Jpeg));
        assert!(format("auto", None, "o.bin").is_err());
    }

    #[test]
    fn a_recipe_that_is_written_can_be_read() {
        let (effective, _) = with(&[
            (Key::named("white-balance"), "2.1,1,1.5"),
            (Key::named("profile"), "a \"b\".toml"),
            (Key::named("exposure"), "-1"),
        ]);
        let table: toml::Table = effective.to_toml(|p| p.display().to_string()).parse().unwrap();
        assert_eq!(table.len(), SETTINGS.len());
        assert_eq!(table["exposure"].as_integer(), Some(-1));
        assert_eq!(table["white-balance"].as_str(), Some("2.1,1,1.5"));
        assert!(Path::new(table["profile"].as_str().unwrap()).is_absolute());
        assert!(table["profile"].as_str().unwrap().ends_with("a \"b\".toml"));
    }
}
