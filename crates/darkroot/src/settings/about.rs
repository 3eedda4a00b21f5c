//! Settings of what a picture says of itself: their rows of the table.

use super::setting::{Changes, Group, Kind, Setting, Word};
use super::table::put;
use super::text::{NotAValue, one_of};
use super::words::{plain, word};
use crate::metadata::{Keep, parse_tags};

const KEEP: [Word<Keep>; 4] = [
    word("all", Keep::All, "Exif, XMP, IPTC and the sidecar beside the file (FILE.xmp)"),
    word("no-gps", Keep::NoGps, "All but where it was taken"),
    word("basic", Keep::Basic, "Camera, exposure, dates, photographer and copyright"),
    word("none", Keep::None, "Nothing"),
];

pub(super) const METADATA: Setting = Setting {
    name: "metadata",
    alias: None,
    noun: "choice",
    kind: Kind::Words(const { &plain(&KEEP) }),
    default: "all",
    group: Group::Output,
    placeholder: "",
    help: "How much of what is known of the photograph goes into the picture",
    changes: Changes::Encoding,
    set: |to, text| put(&mut to.about.keep, one_of(&KEEP, text)),
};

const fn text(
    name: &'static str,
    noun: &'static str,
    help: &'static str,
    (form, example): (&'static str, &'static str),
    set: fn(&mut super::Settings, &str) -> Result<(), NotAValue>,
) -> Setting {
    Setting {
        name,
        alias: None,
        noun,
        kind: Kind::Text { form, example },
        default: "",
        group: Group::Output,
        placeholder: "TEXT",
        help,
        changes: Changes::Encoding,
        set,
    }
}

/// What is not empty.
fn some(text: &str) -> Option<String> {
    (!text.trim().is_empty()).then(|| text.trim().to_owned())
}

pub(super) const ARTIST: Setting = text(
    "artist",
    "name",
    "Photographer that the picture names, several with semicolons between them",
    ("a name", "\"Ann Example\""),
    |to, text| put(&mut to.about.artist, Ok(some(text))),
);

pub(super) const COPYRIGHT: Setting = text(
    "copyright",
    "notice",
    "Copyright notice of the picture",
    ("a notice", "\"(c) 2026 Ann Example\""),
    |to, text| put(&mut to.about.copyright, Ok(some(text))),
);

pub(super) const SET_TAG: Setting = text(
    "set-tag",
    "list of properties",
    "Properties that the picture states, by their names in XMP: \"xmp:Rating=4; dc:title=Fog; dc:subject=fog, lake\"; no value \
     takes one away",
    (
        "PREFIX:NAME=VALUE with semicolons between them, with a prefix such as dc, xmp, photoshop or Iptc4xmpCore",
        "\"xmp:Rating=4; dc:subject=fog, lake\"",
    ),
    |to, text| put(&mut to.about.tags, parse_tags(text).ok_or_else(|| NotAValue::of(&SET_TAG, text))),
);
