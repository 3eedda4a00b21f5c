//! The table of settings as JSON, for programs that offer them to a person.

use serde_json::{Value, json};

use super::key::Key;
use super::setting::{Changes, Group, Kind, Setting};

/// Where each part of the table begins, and what it is called: settings that a person looks for in one place.
const SECTIONS: [(Key, &str); 7] = [
    (Key::named("format"), "File"),
    (Key::named("exposure"), "Light"),
    (Key::named("white-balance"), "Colour and tone"),
    (Key::named("highlights"), "Detail"),
    (Key::named("rotate"), "Geometry"),
    (Key::named("profile"), "Camera"),
    (Key::named("engine"), "Comparison"),
];

/// Every setting in the order of the table: its name, its values, its default, words for people, what it changes, and the
/// section that it stands in. `darkroot recipe --describe` prints this.
pub fn describe() -> Value {
    Key::all().map(about).collect()
}

/// The part of the table that a setting stands in.
fn section(key: Key) -> &'static str {
    SECTIONS.iter().rev().find(|(first, _)| *first <= key).map_or("", |(_, name)| name)
}

fn about(key: Key) -> Value {
    let setting: &Setting = key.setting();
    let mut about = json!({
        "name": setting.name,
        "default": key.as_json(setting.default),
        "help": setting.help,
        "allowed": setting.allowed(),
        "group": match setting.group {
            Group::Output => "output",
            Group::Picture => "picture",
            Group::Comparison => "comparison",
        },
        "section": section(key),
        "changes": match setting.changes {
            Changes::Encoding => "encoding",
            Changes::Picture => "picture",
            Changes::Photo => "photo",
        },
    });
    match setting.kind {
        Kind::Words(words) => {
            about["type"] = "word".into();
            about["words"] = words.iter().map(|w| json!({ "word": w.word, "help": w.help })).collect();
        }
        Kind::Switch => about["type"] = "switch".into(),
        Kind::Number { least, most, whole, unit } => {
            about["type"] = if whole { "whole number" } else { "number" }.into();
            about["range"] = json!([least, most]);
            about["unit"] = unit.into();
        }
        Kind::Text { .. } => {
            about["type"] = "text".into();
            if let Some(most) = amount(key) {
                about["range"] = json!([0, most]);
            }
        }
        Kind::File(words) | Kind::Path(words) => {
            about["type"] = "file".into();
            about["words"] = words.iter().map(|word| json!({ "word": word, "help": "" })).collect();
        }
    }
    about
}

/// The largest number that a setting takes beside its words, where it takes them from 0 on and few: an amount.
fn amount(key: Key) -> Option<u8> {
    let takes = |number: &u8| key.checked(&number.to_string()).is_ok();
    let all: Vec<u8> = (0..=10).take_while(takes).collect();
    all.last().copied().filter(|most| (1..10).contains(most))
}

impl Key {
    /// A text of this setting as JSON: numbers and switches as such.
    pub fn as_json(self, text: &str) -> Value {
        let bare = self.is_number() || self.is_switch();
        bare.then(|| serde_json::from_str(text).ok()).flatten().unwrap_or_else(|| text.into())
    }
}

#[cfg(test)]
mod tests {
    use super::super::SETTINGS;
    use super::*;

    #[test]
    fn sections_follow_the_table() {
        assert!(SECTIONS.is_sorted_by(|a, b| a.0 < b.0));
        assert_eq!(SECTIONS[0].0, Key::named(SETTINGS[0].name));
        let described = describe();
        let all = described.as_array().unwrap();
        assert_eq!(all.len(), SETTINGS.len());
        for (name, expected) in
            [("quality", "File"), ("dpi", "Light"), ("vibrance", "Colour and tone"), ("crop", "Geometry")]
        {
            let setting = all.iter().find(|s| s["name"] == name).unwrap();
            assert_eq!(setting["section"], expected, "{name}");
        }
        let ranges = all.iter().filter(|s| s["type"] == "text" && !s["range"].is_null());
        let amounts: Vec<_> = ranges.map(|s| (s["name"].as_str().unwrap(), s["range"][1].as_u64())).collect();
        assert_eq!(amounts, [("denoise", Some(2)), ("sharpen", Some(2))]);
    }
}
