//! Settings of what is changed about a look: their rows of the table.

use darkroot_develop::{OutputSpace, Points, Tones};

use super::Settings;
use super::setting::{Changes, Group, Kind, Setting};
use super::spaces::space;
use super::table::put;
use super::text::{NotAValue, number, one_of, path};
use super::words::{self, AUTO, OFF, plain};

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

pub(super) const LOCAL_TONE: Setting = Setting {
    name: "local-tone",
    alias: None,
    noun: "way with local tone maps",
    kind: Kind::Words(const { &plain(&words::LOCAL_TONE) }),
    default: AUTO,
    group: Group::Picture,
    placeholder: "",
    help: "What becomes of the local tone map that a DNG carries, as phones write it (linear and reproduction leave it out)",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.local_tone, one_of(&words::LOCAL_TONE, text)),
};
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
pub(super) const CURVE: Setting = Setting {
    name: "curve",
    alias: None,
    noun: "tone curve",
    kind: Kind::Text {
        form: "points BEFORE:AFTER of lightness (0 black, 50 middle grey, 100 white) with commas between them, at most 16, from \
               dark to light, that do not fall",
        example: "\"25:18,75:82\"",
    },
    default: "",
    group: Group::Picture,
    placeholder: "POINTS",
    help: "Tone curve through points of lightness as the look shows it and as it shall be: 25:18,75:82 darkens shadows and \
           brightens highlights; black and white stay where nothing is said of 0 and 100",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.tones.curve, points(text)),
};

/// Points of a curve; none of an empty text.
fn points(text: &str) -> Result<Option<Points>, NotAValue> {
    if text.trim().is_empty() {
        return Ok(None);
    }
    let wrong = || NotAValue::of(&CURVE, text);
    let one = |pair: &str| {
        let (before, after) = pair.split_once(':')?;
        Some([before.trim().parse().ok()?, after.trim().parse().ok()?])
    };
    let points: Option<Vec<[f64; 2]>> = text.split(',').map(one).collect();
    Points::new(&points.ok_or_else(wrong)?).map(Some).map_err(|_| wrong())
}

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

pub(super) const LUT: Setting = Setting {
    name: "lut",
    alias: None,
    noun: "look-up table",
    kind: Kind::Path(&[OFF]),
    default: OFF,
    group: Group::Picture,
    placeholder: "FILE",
    help: "Table laid over the look: a .cube file of one or three dimensions or a CLF file, or off",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.lut, path(text, &LUT)),
};

pub(super) const LUT_SPACE: Setting = Setting {
    name: "lut-space",
    alias: None,
    noun: "colour space",
    kind: Kind::Text {
        form: "srgb, display-p3, adobe-rgb, prophoto, rec2020, ecirgb-v2, each also with -linear, or aces2065-1",
        example: "\"rec2020\"",
    },
    default: "srgb",
    group: Group::Picture,
    placeholder: "SPACE",
    help: "Colour space that the table of `--lut` takes and gives: srgb, display-p3, adobe-rgb, prophoto, rec2020, ecirgb-v2, \
           each also with -linear, or aces2065-1",
    changes: Changes::Picture,
    set: |to, text| match space(text) {
        Some(OutputSpace::Rgb(space)) => {
            to.lut_space = space;
            Ok(())
        }
        _ => Err(NotAValue::of(&LUT_SPACE, text)),
    },
};

/// Names of the settings that change something.
pub(super) fn changed(settings: &Settings) -> Vec<&'static str> {
    let tones = &settings.recipe.tones;
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
    let by_amount =
        pairs.iter().filter(|(_, asked, fixed)| (asked - fixed).abs() > 0.0).map(|(name, ..)| *name);
    by_amount.chain(tones.curve.map(|_| CURVE.name)).chain(settings.lut.as_ref().map(|_| LUT.name)).collect()
}
