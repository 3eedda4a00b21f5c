//! Settings of noise and of faults of the sensor.

use darkroot_develop::{Denoise, DenoiseBy};

use super::setting::{Changes, Group, Kind, Setting};
use super::table::put;
use super::text::{NotAValue, amount, number, one_of};
use super::words::{self, AUTO, plain};

pub(super) const HOT_PIXELS: Setting = Setting {
    name: "hot-pixels",
    alias: None,
    noun: "way with hot pixels",
    kind: Kind::Words(const { &plain(&words::HOT_PIXELS) }),
    default: AUTO,
    group: Group::Picture,
    placeholder: "",
    help: "What becomes of hot and dead pixels (the linear look and camera RGB keep them)",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.hot_pixels, one_of(&words::HOT_PIXELS, text)),
};

pub(super) const BANDING: Setting = Setting {
    name: "banding",
    alias: None,
    noun: "way with banding",
    kind: Kind::Words(const { &plain(&words::BANDING) }),
    default: AUTO,
    group: Group::Picture,
    placeholder: "",
    help: "What becomes of rows that the sensor left too high or too low (the linear look and camera RGB keep them)",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.banding, one_of(&words::BANDING, text)),
};

pub(super) const DENOISE: Setting = Setting {
    name: "denoise",
    alias: None,
    noun: "amount of denoising",
    kind: Kind::Text { form: "auto, off, best, or a number from 0 to 2", example: "\"best\" or \"0.5\"" },
    default: AUTO,
    group: Group::Picture,
    placeholder: "AMOUNT",
    help: "Noise taken away before interpolation: auto (all that was measured; none in the linear look and in camera \
           RGB), off, best (all of it, by comparing parts of the picture: better and slow), or so many times what was \
           measured, 0 to 2",
    changes: Changes::Picture,
    set: |to, text| denoise(&mut to.recipe.denoise, text),
};

pub(super) const DENOISE_LUMA: Setting = Setting {
    name: "denoise-luma",
    alias: None,
    noun: "share of denoising",
    kind: Kind::Number { least: 0.0, most: 2.0, whole: false, unit: "" },
    default: "1",
    group: Group::Picture,
    placeholder: "SHARE",
    help: "Share of it for noise of brightness, 0 to 2",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.denoise.luma, number(text).map(|n| n as f32)),
};

pub(super) const DENOISE_CHROMA: Setting = Setting {
    name: "denoise-chroma",
    alias: None,
    noun: "share of denoising",
    kind: Kind::Number { least: 0.0, most: 2.0, whole: false, unit: "" },
    default: "1",
    group: Group::Picture,
    placeholder: "SHARE",
    help: "Share of it for noise of colour, 0 to 2",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.recipe.denoise.chroma, number(text).map(|n| n as f32)),
};

/// How much noise goes, and how it is told.
fn denoise(to: &mut Denoise, text: &str) -> Result<(), NotAValue> {
    (to.by, to.amount) = match text {
        "best" => (DenoiseBy::Likeness, Some(1.0)),
        _ => (DenoiseBy::Scales, amount(text, "amount of denoising")?),
    };
    Ok(())
}
