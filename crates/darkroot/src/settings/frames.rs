//! Settings of dark and flat frames: their rows of the table.

use super::setting::{Changes, Group, Kind, Setting};
use super::table::put;
use super::text::path;
use super::words::OFF;

pub(super) const DARK: Setting = Setting {
    name: "dark",
    alias: None,
    noun: "dark frame",
    kind: Kind::Path(&[OFF]),
    default: OFF,
    group: Group::Picture,
    placeholder: "FRAME",
    help: "Take off what the sensor gives without light, and mend pixels that are hot there: a raw file (same camera, time and \
           sensitivity, lens covered), a folder of them (their median), or off",
    changes: Changes::Photo,
    set: |to, text| put(&mut to.dark, path(text, &DARK)),
};

pub(super) const FLAT: Setting = Setting {
    name: "flat",
    alias: None,
    noun: "flat frame",
    kind: Kind::Path(&[OFF]),
    default: OFF,
    group: Group::Picture,
    placeholder: "FRAME",
    help: "Even out what a photograph of an even surface shows (shading by lens and lamps, dust), channel by channel, in place \
           of corrections for vignetting: a raw file (same camera, lens, aperture and light), a folder of them (their median), \
           or off",
    changes: Changes::Photo,
    set: |to, text| put(&mut to.flat, path(text, &FLAT)),
};
