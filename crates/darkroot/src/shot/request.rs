//! Shots of a chart, and what is known of them.

use std::path::PathBuf;

use darkroot_calibrate::LightSource;
use darkroot_chart::{ChartLayout, Reference};
use darkroot_profile::Kind;

use super::ShotOptions;
use crate::charts::NamedReference;

/// What a profile is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartRequest {
    /// Shots of the chart with the light of each. Those under one light are an exposure bracket, or `average` is set.
    pub shots: Vec<(PathBuf, LightSource)>,
    /// The chart.
    pub layout: ChartLayout,
    /// What its patches are.
    pub reference: Reference,
    /// Name of the reference, for the profile ("classic24-after-2014", "my-chart.cie").
    pub reference_name: String,
    /// SHA-256 of its file; empty for those built in.
    pub reference_sha256: String,
    /// What else the chart may be. The shot decides, by its patches left out of a fit.
    pub other_references: Vec<NamedReference>,
    /// How the shots are treated.
    pub options: ShotOptions,
    /// Take the mean of shots under one light at one exposure. Without it they are refused, because two lights may
    /// have been meant.
    pub average: bool,
    /// The model; the best one if not given.
    pub kind: Option<Kind>,
    /// Day that the profile carries, YYYY-MM-DD; may be empty.
    pub date: String,
}

impl ChartRequest {
    /// For shots with the light of each: the best model, no day, and no mean of shots at one exposure.
    pub fn of(
        shots: Vec<(PathBuf, LightSource)>,
        layout: ChartLayout,
        reference: NamedReference,
        options: ShotOptions,
    ) -> Self {
        Self {
            shots,
            layout,
            reference: reference.colours,
            reference_name: reference.name,
            reference_sha256: reference.sha256,
            other_references: reference.others,
            options,
            average: false,
            kind: None,
            date: String::new(),
        }
    }
}
