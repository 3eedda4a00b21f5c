//! Names of outputs made from facts about their inputs: `{year}/{camera}/{stem}.{ext}`.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use super::{NamingError, PathPart};

/// What a name can be made of.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Fields {
    /// The input's folder below its root; none where inputs have no root.
    pub folder: Option<PathBuf>,
    /// The input's name.
    pub name: OsString,
    /// Name of the folder that the input lies in.
    pub parent: OsString,
    /// Ending of the output's format.
    pub ext: String,
    /// The input's number.
    pub number: usize,
    /// Camera; empty if unknown.
    pub camera: String,
    /// Date of the shot, 2026-05-01; empty if unknown.
    pub date: String,
}

/// Placeholders of every template, in words.
pub(super) const PLACEHOLDERS: &str =
    "{stem} {suffix} {ext} {parent} {camera} {date} {year} {month} {day} {seq}";

/// Whether the template names what stands inside files.
pub fn needs_headers(template: &str) -> bool {
    ["{camera}", "{date}", "{year}", "{month}", "{day}"].iter().any(|name| template.contains(name))
}

/// Whether the template numbers its files.
pub fn needs_number(template: &str) -> bool {
    template.contains("{seq}")
}

/// Fills in a template. Every field becomes one [`PathPart`] (`{folder}`: one for each folder), so that only the
/// template's own text decides in which folder the name lies.
///
/// # Errors
/// A placeholder that does not exist.
pub fn fill(template: &str, fields: &Fields) -> Result<PathBuf, NamingError> {
    let unknown = |name: &str| NamingError::Placeholder {
        name: name.to_owned(),
        folder: if fields.folder.is_some() { "{folder} " } else { "" },
    };
    let mut out = OsString::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('{') {
        let (name, tail) = after.split_once('}').ok_or_else(|| unknown(after))?;
        out.push(before);
        match &fields.folder {
            Some(folder) if name == "folder" => out.push(parts(folder)),
            _ => out.push(PathPart::of(&value(name, fields).ok_or_else(|| unknown(name))?).name()),
        }
        rest = tail;
    }
    out.push(rest);
    Ok(out.into())
}

/// What stands for a placeholder; none where there is no such.
fn value(name: &str, fields: &Fields) -> Option<OsString> {
    let file = Path::new(&fields.name);
    let date = |from: usize, to: usize| fields.date.get(from..to).unwrap_or("undated").into();
    let or = |text: &str, other: &str| if text.is_empty() { other.into() } else { text.into() };
    Some(match name {
        "stem" => file.file_stem().unwrap_or(&fields.name).to_owned(),
        "suffix" => file.extension().map(OsStr::to_ascii_lowercase).unwrap_or_default(),
        "ext" => fields.ext.clone().into(),
        "parent" => fields.parent.clone(),
        "seq" => format!("{:04}", fields.number).into(),
        "camera" => or(&fields.camera, "unknown"),
        "date" => or(&fields.date, "undated"),
        "year" => date(0, 4),
        "month" => date(5, 7),
        "day" => date(8, 10),
        _ => return None,
    })
}

/// A path below some root, part by part.
fn parts(folder: &Path) -> PathBuf {
    folder.iter().map(|part| PathPart::of(part).name().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields() -> Fields {
        Fields {
            name: "x.v2.NEF".into(),
            parent: "roll".into(),
            ext: "jpg".into(),
            number: 7,
            ..Fields::default()
        }
    }

    fn filled(template: &str, fields: &Fields) -> String {
        fill(template, fields).unwrap().display().to_string()
    }

    #[test]
    fn every_placeholder_stands_for_its_fact() {
        let dated = Fields { date: "2026-05-01".into(), camera: "Nikon_D700".into(), ..fields() };
        let name = "{year}/{month}/{day}/{camera}-{parent}-{stem}-{suffix}-{seq}.{ext}";
        assert_eq!(filled(name, &dated), "2026/05/01/Nikon_D700-roll-x.v2-nef-0007.jpg");
        assert_eq!(filled("{date}/{year}-{camera}.{ext}", &fields()), "undated/undated-unknown.jpg");
        for name in PLACEHOLDERS.split(' ') {
            assert!(fill(name, &fields()).is_ok(), "{name}");
        }
        let below = Fields { folder: Some("a/b".into()), ..fields() };
        assert_eq!(filled("{folder}/{stem}", &below), "a/b/x.v2");
        for (fields, knows_folder) in [(fields(), false), (below, true)] {
            let wrong = fill("{name}.jpg", &fields).unwrap_err().to_string();
            assert!(wrong.contains(PLACEHOLDERS) && wrong.contains("{folder}") == knows_folder, "{wrong}");
        }
        assert!(fill("{folder}/{stem}", &fields()).is_err());
    }

    #[test]
    fn no_fact_leads_out_of_the_folder_that_the_template_names() {
        let evil = |text: &str| Fields {
            folder: Some(Path::new("..").join(text)),
            name: format!("{text}.nef").into(),
            parent: text.into(),
            camera: text.into(),
            date: text.into(),
            ..fields()
        };
        for text in ["..", ".", "../..", "/etc", "..........", "2026:05:..", "a/../../b"] {
            for name in ["folder", "stem", "suffix", "parent", "camera", "date", "year", "month", "day"] {
                let path = fill(&format!("out/{{{name}}}/x.jpg"), &evil(text)).unwrap();
                let normal = |c| matches!(c, std::path::Component::Normal(_));
                assert!(path.components().all(normal) && path.starts_with("out"), "{name} {text}: {path:?}");
            }
        }
    }
}
