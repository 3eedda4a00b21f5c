//! Settings of what is changed about a look: their rows of the table.

use darkroot_develop::Tones;

use super::Settings;
use super::setting::{Changes, Group, Kind, Setting};
use super::table::put;
use super::text::{NotAValue, number};

const fn row(
    name: &'static str,
    noun: &'static str,
    (least, most): (f64, f64),
    default: &'static str,
    help: &'static str,
    set: fn(&mut Settings, &str) -> Result<(), NotAValue>,
) -> Setting {
    Setting {
        name,
        alias: None,
        noun,
        kind: Kind::Number { least, most, whole: false, unit: "" },
        default,
        group: Group::Picture,
        placeholder: "N",
        help,
        changes: Changes::Picture,
        set,
    }
}

pub(super) const CONTRAST: Setting = row(
    "contrast",
    "contrast",
    (-1.0, 1.0),
    "0",
    "Stops by which what is two stops brighter than middle grey gets brighter, and what is two stops darker darker, -1 to 1",
    |to, text| put(&mut to.recipe.tones.contrast, number(text).map(|n| n as f32)),
);
pub(super) const SHADOWS: Setting = row(
    "shadows",
    "brightness of shadows",
    (-2.0, 2.0),
    "0",
    "Stops by which shadows get brighter, -2 to 2",
    |to, text| put(&mut to.recipe.tones.shadows, number(text).map(|n| n as f32)),
);
pub(super) const HIGHLIGHTS: Setting = row(
    "highlights-tone",
    "brightness of highlights",
    (-2.0, 2.0),
    "0",
    "Stops by which highlights get brighter (less than 0 brings back what a sky has), -2 to 2",
    |to, text| put(&mut to.recipe.tones.highlights, number(text).map(|n| n as f32)),
);
pub(super) const BLACK: Setting = row(
    "black",
    "brightness of black",
    (-2.0, 2.0),
    "0",
    "Stops by which what is nearly black gets brighter, -2 to 2",
    |to, text| put(&mut to.recipe.tones.black, number(text).map(|n| n as f32)),
);
pub(super) const WHITE: Setting = row(
    "white",
    "brightness of white",
    (-1.0, 1.0),
    "0",
    "Stops by which what is nearly white gets brighter, -1 to 1",
    |to, text| put(&mut to.recipe.tones.white, number(text).map(|n| n as f32)),
);
pub(super) const SATURATION: Setting = row(
    "saturation",
    "saturation",
    (0.0, 2.0),
    "1",
    "Factor on the chroma of all colours, 0 (none is left) to 2",
    |to, text| put(&mut to.recipe.tones.saturation, number(text).map(|n| n as f32)),
);
pub(super) const VIBRANCE: Setting = row(
    "vibrance",
    "vibrance",
    (-1.0, 1.0),
    "0",
    "Chroma that pale colours get more, as a share of theirs, -1 to 1; pure ones get none",
    |to, text| put(&mut to.recipe.tones.vibrance, number(text).map(|n| n as f32)),
);

/// Names of the settings that change something.
pub(super) fn changed(tones: &Tones) -> Vec<&'static str> {
    let fixed = Tones::default();
    let pairs = [
        (CONTRAST.name, tones.contrast, fixed.contrast),
        (SHADOWS.name, tones.shadows, fixed.shadows),
        (HIGHLIGHTS.name, tones.highlights, fixed.highlights),
        (BLACK.name, tones.black, fixed.black),
        (WHITE.name, tones.white, fixed.white),
        (SATURATION.name, tones.saturation, fixed.saturation),
        (VIBRANCE.name, tones.vibrance, fixed.vibrance),
    ];
    pairs.iter().filter(|(_, asked, fixed)| (asked - fixed).abs() > 0.0).map(|(name, ..)| *name).collect()
}
