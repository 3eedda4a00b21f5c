//! What there is to say about a setting.

use super::Settings;
use super::text::NotAValue;

/// A setting.
#[derive(Debug)]
pub struct Setting {
    /// Its name, on the command line and in files.
    pub name: &'static str,
    /// Another name for it, for those who type.
    pub alias: Option<&'static str>,
    /// What a value of it is called in messages.
    pub noun: &'static str,
    /// What values it has.
    pub kind: Kind,
    /// What holds where nobody says anything.
    pub default: &'static str,
    /// Which settings it stands with.
    pub group: Group,
    /// How a value is called in a list of options; empty where its words say it.
    pub placeholder: &'static str,
    /// What it is, for a person.
    pub help: &'static str,
    /// What has to be done again when it changes.
    pub changes: Changes,
    /// Puts what a text means into settings.
    pub(super) set: fn(&mut Settings, &str) -> Result<(), NotAValue>,
}

/// What values a setting has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// One of some words.
    Words(&'static [Word<()>]),
    /// On or off.
    Switch,
    /// A number.
    Number {
        /// The least.
        least: f64,
        /// The most.
        most: f64,
        /// Whether it has no fraction.
        whole: bool,
        /// What is counted, for messages.
        unit: &'static str,
    },
    /// A text of a form of its own.
    Text {
        /// What can be written, in words.
        form: &'static str,
        /// Values to show a person who wrote something else.
        example: &'static str,
    },
    /// A file, the name of something, or one of some words.
    File(&'static [&'static str]),
    /// A file (or, where the setting says so, a folder), or one of some words.
    Path(&'static [&'static str]),
}

/// Settings that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// The file that is written.
    Output,
    /// The picture.
    Picture,
    /// Other decoders and engines.
    Comparison,
}

/// What has to be done again when a setting changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Changes {
    /// Writing the file.
    Encoding,
    /// The plan, and with it every view.
    Picture,
    /// Everything from decoding on.
    Photo,
}

/// A word that stands for a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Word<T> {
    /// As it is written.
    pub word: &'static str,
    /// As it may be written as well; empty where there is no other form.
    pub also: &'static str,
    /// What it stands for.
    pub value: T,
    /// What it means; empty where the word says it.
    pub help: &'static str,
}
