//! Properties of XMP that a person names: `xmp:Rating=4; dc:subject=fog, lake`.

use super::spaces::{DC, LR, PREFIXES};
use super::xmp::{List, Name, Said};

/// A property and what it shall say; nothing takes it away.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Tag {
    pub(crate) name: Name,
    pub(crate) said: Option<Said>,
}

/// Properties of a text, with semicolons between them; `None` where it is no such text.
pub(crate) fn parse(text: &str) -> Option<Vec<Tag>> {
    text.split(';').map(str::trim).filter(|one| !one.is_empty()).map(one).collect()
}

fn one(text: &str) -> Option<Tag> {
    let (name, value) = text.split_once('=')?;
    let (prefix, local) = name.trim().split_once(':')?;
    let (_, space) = PREFIXES.iter().find(|(known, _)| *known == prefix)?;
    let is_name = local.starts_with(|c: char| c.is_ascii_alphabetic())
        && local.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let value = value.trim();
    is_name.then(|| Tag {
        name: Name::new(space, local),
        said: (!value.is_empty()).then(|| shaped(space, local, value)),
    })
}

/// A text in the form that the property has: one text, a text in any language, or a list with commas between its values
/// (creators with semicolons, as Exif has them).
pub(super) fn shaped(space: &str, local: &str, text: &str) -> Said {
    let list = |kind, between: char| {
        let values = text.split(between).map(str::trim).filter(|one| !one.is_empty());
        Said::Many(kind, values.map(Said::text).collect())
    };
    match (space, local) {
        (DC, "title" | "description" | "rights") => Said::in_any_language(text),
        (_, "UsageTerms") => Said::in_any_language(text),
        (DC, "creator") => list(List::Seq, ';'),
        (DC, "subject" | "contributor" | "publisher" | "relation" | "language" | "type") => {
            list(List::Bag, ',')
        }
        (LR, "hierarchicalSubject") | (_, "PersonInImage" | "OrganisationInImageName") => {
            list(List::Bag, ',')
        }
        (_, "TagsList") => list(List::Seq, ','),
        _ => Said::text(text),
    }
}

#[cfg(test)]
mod tests {
    use super::super::spaces::XMP;
    use super::*;

    #[test]
    fn tags_take_the_form_of_their_property() {
        let tags = parse(" xmp:Rating=4; dc:subject = fog, lake;dc:title=; ").unwrap();
        assert_eq!(tags[0].name, Name::new(XMP, "Rating"));
        assert_eq!(tags[0].said, Some(Said::text("4")));
        assert_eq!(tags[1].said.as_ref().unwrap().texts(), ["fog", "lake"]);
        assert_eq!((tags[2].said.clone(), tags.len()), (None, 3));
        for wrong in ["Rating=4", "xmp:Rating", "own:x=1", "xmp:a b=1", "xmp:=1"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
        assert_eq!(parse(""), Some(Vec::new()));
    }
}
