//! The table of settings for programs that offer them to a person.

use serde_json::{Value, json};

use super::{Changes, Key, Kind};

/// The table of settings as JSON, for programs that offer them to a person.
pub fn json() -> Value {
    let one = |key: Key| {
        let setting = key.setting();
        let mut about = json!({
            "name": setting.name,
            "default": key.json(setting.default),
            "help": setting.help,
            "allowed": setting.allowed(),
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
            Kind::Text { .. } => about["type"] = "text".into(),
            Kind::File(words) => {
                about["type"] = "file".into();
                about["words"] = words.iter().map(|word| json!({ "word": word, "help": "" })).collect();
            }
        }
        about
    };
    Key::all().map(one).collect()
}
