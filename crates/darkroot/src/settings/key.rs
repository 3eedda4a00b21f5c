//! A setting by its place in the table.

use std::fmt;

use super::Settings;
use super::setting::{Kind, Setting};
use super::table::SETTINGS;
use super::text::{self, NotAValue};

/// A setting. Its name is the same on the command line and in files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key(usize);

impl Key {
    /// Format of the outputs, which an output's name can say, too.
    pub const FORMAT: Self = Self::named("format");
    /// Which profile.
    pub const PROFILE: Self = Self::named("profile");
    /// The setting of what pictures say of themselves.
    pub const METADATA: Self = Self::named("metadata");

    /// Every key, in the order of the table.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..SETTINGS.len()).map(Self)
    }

    /// The key of a name that is in the table, for constants: any other name does not compile there.
    pub const fn named(name: &str) -> Self {
        let mut i = 0;
        while !same(SETTINGS[i].name, name) {
            i += 1;
        }
        Self(i)
    }

    /// The key of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|key| key.name() == name)
    }

    /// All about it.
    pub fn setting(self) -> &'static Setting {
        &SETTINGS[self.0]
    }

    /// Its name: that of the option, without the dashes before it.
    pub fn name(self) -> &'static str {
        self.setting().name
    }

    /// What holds where nobody says anything.
    pub fn default_text(self) -> &'static str {
        self.setting().default
    }

    /// Whether its values are numbers (where they are not `auto`).
    pub fn is_number(self) -> bool {
        match self.setting().kind {
            Kind::Number { .. } => true,
            Kind::Words(words) => words.iter().any(|w| w.word.parse::<f64>().is_ok()),
            // An amount is a word or a number.
            Kind::Text { .. } => (self.setting().set)(&mut Settings::default(), "1").is_ok(),
            _ => false,
        }
    }

    /// Whether its values are `true` and `false`.
    pub fn is_switch(self) -> bool {
        self.setting().kind == Kind::Switch
    }

    /// Whether a text names a file, not one of the words that the setting has, too.
    pub fn is_file(self, text: &str) -> bool {
        match self.setting().kind {
            Kind::Path(_) => self.may_be_file(text),
            _ => self.may_be_file(text) && text::is_file_name(text),
        }
    }

    /// Whether a text is the name of a file if there is one of that name.
    pub(crate) fn may_be_file(self, text: &str) -> bool {
        match self.setting().kind {
            Kind::File(words) | Kind::Path(words) => !text.is_empty() && !words.contains(&text),
            _ => false,
        }
    }

    /// Puts what a text means into settings.
    ///
    /// # Errors
    /// It is no value of this setting.
    pub fn apply(self, text: &str, to: &mut Settings) -> Result<(), NotAValue> {
        let setting = self.setting();
        if let Kind::Number { least, most, whole, .. } = setting.kind {
            let allowed = |n: &f64| (least..=most).contains(n) && (!whole || n.fract().abs() < f64::EPSILON);
            let number = text::number(text).ok().filter(allowed);
            number.ok_or_else(|| NotAValue::of(setting, text))?;
        }
        (setting.set)(to, text).map_err(|wrong| wrong.in_setting(setting))
    }

    /// The text, if it is a value of the key; numbers in the one form that they are compared and stored in.
    ///
    /// # Errors
    /// It is none.
    pub fn checked(self, text: &str) -> Result<String, NotAValue> {
        self.apply(text, &mut Settings::default())?;
        Ok(match self.setting().kind {
            // Never `-0`.
            Kind::Number { .. } => (text::number(text)? + 0.0).to_string(),
            Kind::Words(words) => text::word(words, text).map_or(text, |w| w.word).to_owned(),
            _ => text.to_owned(),
        })
    }

    /// The key that a person may have meant by a name that is none.
    pub fn nearest(name: &str) -> Option<Self> {
        let name = name.to_lowercase().replace(['_', ' '], "-");
        if let Some(key) = Self::all().find(|key| key.setting().alias == Some(name.as_str())) {
            return Some(key);
        }
        crate::nearest(&name, Self::all().map(Self::name)).and_then(Self::from_name)
    }

    /// Every name, for messages.
    pub(crate) fn names() -> String {
        SETTINGS.each_ref().map(|setting| setting.name).join(", ")
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Whether two texts are the same, for constants.
const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    if a.len() != b.len() {
        return false;
    }
    let mut i = 0;
    while i < a.len() {
        if a[i] != b[i] {
            return false;
        }
        i += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_name_is_the_name_of_one_key() {
        for key in Key::all() {
            assert_eq!(Key::from_name(key.name()), Some(key));
            assert_eq!(Key::named(key.name()), key);
        }
    }

    #[test]
    fn slips_of_the_finger_are_recognised() {
        for (typed, meant) in [
            ("spcae", Some("space")),
            ("white_balance", Some("white-balance")),
            ("wb", Some("white-balance")),
            ("Exposre", Some("exposure")),
            ("sharpening", None),
            ("", None),
        ] {
            assert_eq!(Key::nearest(typed).map(Key::name), meant, "{typed}");
        }
    }
}
