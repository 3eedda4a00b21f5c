//! Settings of how files are written: their rows of the table.

use super::setting::{Changes, Group, Kind, Setting};
use super::table::put;
use super::text::{NotAValue, number, one_of};
use super::words::{CHROMA, COMPRESSION, OFF, SWITCH, WEBP, plain};

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

pub(super) const HDR: Setting = Setting {
    name: "hdr",
    alias: None,
    noun: "number of stops",
    kind: Kind::Text { form: "off, or stops from 0.5 to 4", example: "\"off\" or \"2\"" },
    default: OFF,
    group: Group::Output,
    placeholder: "STOPS",
    help: "Stops above white that screens with room for them show: off, or 0.5 to 4 (JPEG gets a gain map, Ultra HDR; \
           AVIF is written in Rec. 2020 and PQ)",
    changes: Changes::Encoding,
    set: |to, text| put(&mut to.hdr, stops_above_white(text)),
};

fn stops_above_white(text: &str) -> Result<f32, NotAValue> {
    if text == OFF {
        return Ok(0.0);
    }
    let stops = number(text).ok().filter(|stops| (0.5..=4.0).contains(stops));
    stops
        .map(|stops| stops as f32)
        .ok_or_else(|| NotAValue::plain(text, "number of stops", "off, or stops from 0.5 to 4"))
}

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
