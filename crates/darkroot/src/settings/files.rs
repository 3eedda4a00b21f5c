//! Settings of how files are written: their rows of the table.

use super::setting::{Changes, Group, Kind, Setting};
use super::table::put;
use super::text::{number, one_of};
use super::words::{CHROMA, COMPRESSION, SWITCH, WEBP, plain};

pub(super) const QUALITY: Setting = Setting {
    name: "quality",
    alias: None,
    noun: "quality",
    kind: Kind::Number { least: 1.0, most: 100.0, whole: true, unit: "" },
    default: "92",
    group: Group::Output,
    placeholder: "N",
    help: "Quality of JPEG, AVIF and lossy WebP, 1 to 100",
    changes: Changes::Encoding,
    set: |to, text| put(&mut to.encode.quality, number(text).map(|n| n as u8)),
};

pub(super) const CHROMA_SUBSAMPLING: Setting = Setting {
    name: "chroma",
    alias: None,
    noun: "chroma subsampling",
    kind: Kind::Words(const { &plain(&CHROMA) }),
    default: "444",
    group: Group::Output,
    placeholder: "",
    help: "Chroma subsampling of JPEG",
    changes: Changes::Encoding,
    set: |to, text| put(&mut to.encode.subsampling, one_of(&CHROMA, text)),
};

pub(super) const PROGRESSIVE: Setting = Setting {
    name: "progressive",
    alias: None,
    noun: "switch",
    kind: Kind::Switch,
    default: "false",
    group: Group::Output,
    placeholder: "BOOL",
    help: "Progressive JPEG: some per cent smaller, and seen early where it comes slowly",
    changes: Changes::Encoding,
    set: |to, text| put(&mut to.encode.progressive, one_of(&SWITCH, text)),
};

pub(super) const WEBP_KIND: Setting = Setting {
    name: "webp",
    alias: None,
    noun: "kind of WebP",
    kind: Kind::Words(const { &plain(&WEBP) }),
    default: "lossless",
    group: Group::Output,
    placeholder: "",
    help: "What WebP keeps",
    changes: Changes::Encoding,
    set: |to, text| put(&mut to.encode.webp, one_of(&WEBP, text)),
};

pub(super) const TIFF_COMPRESSION: Setting = Setting {
    name: "compression",
    alias: None,
    noun: "compression",
    kind: Kind::Words(const { &plain(&COMPRESSION) }),
    default: "deflate",
    group: Group::Output,
    placeholder: "",
    help: "Compression of TIFF",
    changes: Changes::Encoding,
    set: |to, text| put(&mut to.encode.compression, one_of(&COMPRESSION, text)),
};
