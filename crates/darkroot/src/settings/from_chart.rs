//! What is taken from a shot of a chart, and the rows of the table for it.

use std::path::PathBuf;

use darkroot_develop::{OutputSpace, Resize};

use super::setting::{Changes, Group, Kind, Setting};
use super::table::put;
use super::text::{balance, one_of};
use super::words::{AUTO, SWITCH};
use super::{Settings, SettingsError};

/// Which shot of a chart is asked.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum ChartShot {
    /// None.
    #[default]
    None,
    /// The photograph itself, which shows a chart.
    Itself,
    /// This file, of the same camera in the same light and at the same exposure.
    File(PathBuf),
}

/// What is taken from a shot of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FromChart {
    /// The shot; its white patch gives the exposure.
    pub shot: ChartShot,
    /// Whether black and glare are what its dark patches show.
    pub black: bool,
    /// Whether its greys give the white balance.
    pub balance: bool,
    /// Millimetres between the middles of two of its patches, where they are to tell the resolution.
    pub pitch: Option<f64>,
    /// The chart, by name or file; any with a built-in reference where it is not given.
    pub layout: Option<String>,
    /// Its reference, by name or file; the built-in one where it is not given.
    pub reference: Option<String>,
}

impl FromChart {
    /// Files that are read for it.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let shot = match &self.shot {
            ChartShot::File(path) => Some(path.clone()),
            ChartShot::None | ChartShot::Itself => None,
        };
        let texts = [&self.layout, &self.reference].into_iter().flatten().map(PathBuf::from);
        let asked = self.shot != ChartShot::None;
        shot.into_iter().chain(texts.filter(move |path| asked && path.is_file()))
    }
}

/// What of a chart cannot be had like that.
pub(super) fn check(settings: &Settings, space: OutputSpace) -> Result<(), SettingsError> {
    let chart = &settings.chart;
    let of_chart =
        [("white-balance", chart.balance), ("black-from-chart", chart.black), ("dpi", chart.pitch.is_some())];
    if chart.shot == ChartShot::None {
        return match of_chart.iter().find(|(_, asked)| *asked) {
            Some((setting, _)) => Err(SettingsError::NoChartShot { setting }),
            None => Ok(()),
        };
    }
    let geometry = &settings.recipe.geometry;
    let is_scaled = geometry.resize != Resize::default() || geometry.perspective.is_some();
    let other = [
        ("dpi", chart.pitch.is_some() && is_scaled),
        ("space", space == OutputSpace::Camera),
        // Samples of the sensor keep their stray light.
        ("black-from-chart", space == OutputSpace::Raw && chart.black),
        ("auto-exposure", settings.recipe.exposure.auto),
        ("from-preview", settings.from_preview),
    ];
    match other.iter().find(|(_, asked)| *asked) {
        Some((setting, _)) => Err(SettingsError::ChartWith { setting }),
        None => Ok(()),
    }
}

pub(super) const EXPOSURE_FROM_CHART: Setting = Setting {
    name: "exposure-from-chart",
    alias: None,
    noun: "shot of a chart",
    kind: Kind::Path(&["off", AUTO]),
    default: "off",
    group: Group::Picture,
    placeholder: "SHOT",
    help: "Make the white patch of a chart as light as its reference says: the raw shot of the chart (same camera, light and \
           exposure), auto (the chart that the photograph itself shows), or off; `--exposure` comes on top",
    changes: Changes::Picture,
    set: |to, text| {
        to.chart.shot = match text {
            "" => return Err(super::NotAValue::plain(text, "shot of a chart", "a file")),
            "off" => ChartShot::None,
            AUTO => ChartShot::Itself,
            file => ChartShot::File(file.into()),
        };
        Ok(())
    },
};

pub(super) const BLACK_FROM_CHART: Setting = Setting {
    name: "black-from-chart",
    alias: None,
    noun: "switch",
    kind: Kind::Switch,
    default: "false",
    group: Group::Picture,
    placeholder: "BOOL",
    help: "Take off the stray light (and an error of the black level) that the patches of the chart show, channel by channel",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.chart.black, one_of(&SWITCH, text)),
};

pub(super) const CHART_LAYOUT: Setting = Setting {
    name: "chart-layout",
    alias: None,
    noun: "chart",
    kind: Kind::File(&[AUTO]),
    default: AUTO,
    group: Group::Picture,
    placeholder: "CHART",
    help: "The chart of `--exposure-from-chart`: its name, a file that describes one, or auto (any with a built-in reference)",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.chart.layout, named(text, "chart")),
};

pub(super) const CHART_REFERENCE: Setting = Setting {
    name: "chart-reference",
    alias: None,
    noun: "reference",
    kind: Kind::File(&[AUTO]),
    default: AUTO,
    group: Group::Picture,
    placeholder: "REFERENCE",
    help: "What the patches of that chart are: the name of a built-in reference, a file, or auto (the chart's built-in one)",
    changes: Changes::Picture,
    set: |to, text| put(&mut to.chart.reference, named(text, "reference")),
};

fn named(text: &str, noun: &'static str) -> Result<Option<String>, super::NotAValue> {
    match text {
        "" => Err(super::NotAValue::plain(text, noun, "a name or a file")),
        AUTO => Ok(None),
        name => Ok(Some(name.to_owned())),
    }
}

/// A white balance, or the word for that of the chart.
pub(super) fn set_balance(to: &mut Settings, text: &str) -> Result<(), super::NotAValue> {
    to.chart.balance = text == "chart";
    if to.chart.balance {
        return Ok(());
    }
    put(&mut to.recipe.balance, balance(text))
}
