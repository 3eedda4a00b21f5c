//! What is measured of a delivery, and whether it is kept.

use std::fmt;

use super::{Bound, Delivery};

/// What can be measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Metric {
    /// Mean colour difference.
    ColourMean,
    /// Largest colour difference.
    ColourMax,
    /// Colour difference that nine of ten patches keep.
    ColourP90,
    /// Largest error of L\* over the greys.
    Tone,
    /// Largest error of colour over the greys.
    WhiteBalance,
    /// Gain modulation in the highlights.
    GainHighlights,
    /// Gain modulation elsewhere.
    GainOther,
    /// Largest standard deviation of L\* over the greys.
    Noise,
    /// Largest visual noise over the greys.
    VisualNoise,
    /// Stops from saturation to where signal and noise are equal.
    DynamicRange,
    /// Largest standard deviation of L\* from line to line over an even surface.
    Banding,
    /// Sampling efficiency: the frequency of 10 % response over half a cycle a pixel, percent.
    SamplingEfficiency,
    /// Largest response of slanted edges from 0.1 to 0.5 cycles a pixel.
    Sharpening,
    /// Distance between the edges of two channels, pixels.
    Misregistration,
    /// Difference of luminance over an even surface, percent.
    Illumination,
    /// Pixels an inch of the original.
    SamplingRate,
}

impl Metric {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::ColourMean => "colour, mean dE2000",
            Self::ColourMax => "colour, largest dE2000",
            Self::ColourP90 => "colour, 90th percentile dE2000",
            Self::Tone => "tone response, largest error of L*",
            Self::WhiteBalance => "white balance, largest dE(a*b*)",
            Self::GainHighlights => "gain modulation, highlights",
            Self::GainOther => "gain modulation, elsewhere",
            Self::Noise => "noise, largest standard deviation of L*",
            Self::VisualNoise => "visual noise, largest",
            Self::DynamicRange => "dynamic range, stops",
            Self::Banding => "banding, standard deviation of L* over lines",
            Self::SamplingEfficiency => "sampling efficiency (SFR10), %",
            Self::Sharpening => "sharpening, largest SFR",
            Self::Misregistration => "colour misregistration, pixels",
            Self::Illumination => "illumination, largest difference, %",
            Self::SamplingRate => "sampling rate, pixels an inch",
        }
    }

    /// What it is called where there is little room.
    pub fn short(self) -> &'static str {
        match self {
            Self::ColourMean => "mean",
            Self::ColourMax => "largest",
            Self::ColourP90 => "90 %",
            Self::Tone => "tone",
            Self::WhiteBalance => "white",
            Self::GainHighlights => "gain in highlights",
            Self::GainOther => "gain elsewhere",
            Self::Noise => "noise",
            Self::VisualNoise => "visual noise",
            Self::DynamicRange => "dynamic range",
            Self::Banding => "banding",
            Self::SamplingEfficiency => "sampling",
            Self::Sharpening => "sharpening",
            Self::Misregistration => "registration",
            Self::Illumination => "illumination",
            Self::SamplingRate => "rate",
        }
    }

    /// What it takes to be measured, where a shot of a chart alone may not do.
    pub fn needs(self) -> &'static str {
        match self {
            Self::SamplingEfficiency | Self::Sharpening | Self::Misregistration => {
                "edges of grey patches that stand 2 to 30 degrees from the rows of pixels: turn the chart a little"
            }
            Self::Illumination | Self::Banding => "a picture of an even surface (`--flat`)",
            Self::VisualNoise => "grey patches of at least 24 pixels",
            Self::DynamicRange => "five different greys, unclipped and with noise",
            Self::SamplingRate => "the distance between two patches (`--chart-pitch`)",
            Self::GainHighlights => "two greys lighter than L* 75 in the mean",
            Self::GainOther | Self::Tone | Self::WhiteBalance | Self::Noise => "grey patches",
            Self::ColourMean | Self::ColourMax | Self::ColourP90 => "patches",
        }
    }
}

/// A measured value: the least and the most of it, which for most metrics are one number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// The least.
    pub low: f64,
    /// The most.
    pub high: f64,
}

impl Found {
    fn one(value: f64) -> Self {
        Self { low: value, high: value }
    }

    fn range(values: impl Iterator<Item = f64>) -> Option<Self> {
        let join = |all: Option<Self>, v: f64| match all {
            Some(all) => Some(Self { low: all.low.min(v), high: all.high.max(v) }),
            None => Some(Self::one(v)),
        };
        values.fold(None, join)
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.low < self.high {
            write!(f, "{:.2} to {:.2}", self.low, self.high)
        } else {
            write!(f, "{:.2}", self.high)
        }
    }
}

impl Delivery {
    /// The value of a metric, colour differences with SL = 1 where that is asked for; `None` where the picture does not show
    /// it.
    pub fn value(&self, metric: Metric, sl1: bool) -> Option<Found> {
        let colour = if sl1 { self.sl1 } else { self.de2000 };
        let greys = |of: fn(&super::Grey) -> f64| {
            Found::range(self.greys.iter().map(of)).map(|range| Found::one(range.high))
        };
        let gains = |highlights: bool| {
            Found::range(self.steps.iter().filter(|s| s.is_highlight() == highlights).map(|s| s.gain))
        };
        let edges = self.details.edges;
        match metric {
            Metric::ColourMean => Some(Found::one(colour.mean)),
            Metric::ColourMax => Some(Found::one(colour.max)),
            Metric::ColourP90 => Some(Found::one(self.p90)),
            Metric::Tone => greys(|grey| grey.lightness_error().abs()),
            Metric::WhiteBalance => greys(super::Grey::colour_error),
            Metric::GainHighlights => gains(true),
            Metric::GainOther => gains(false),
            Metric::Noise => greys(|grey| grey.noise.lightness),
            Metric::VisualNoise => {
                let seen = self.greys.iter().filter_map(|grey| grey.noise.visual);
                Found::range(seen.map(|seen| seen.weighted())).map(|range| Found::one(range.high))
            }
            // The least can be relied on; a chart of paper says little more.
            Metric::DynamicRange => self.dynamic_range.map(|r| Found { low: r.least, high: r.stops }),
            Metric::Banding => self.details.banding.map(|b| Found::one(b.deviation())),
            Metric::SamplingEfficiency => edges.map(|e| Found::one(100.0 * e.sfr10 / 0.5)),
            Metric::Sharpening => edges.map(|e| Found::one(e.peak)),
            Metric::Misregistration => edges.map(|e| Found::one(e.misregistration)),
            Metric::SamplingRate => self.details.scale.map(|s| Found::one(s.found)),
            Metric::Illumination => self.details.uniformity.map(|u| Found::one(u.luminance)),
        }
    }
}

/// A limit, and what was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Verdict {
    /// What is limited.
    pub metric: Metric,
    /// What it is; `None` where the picture does not show it.
    pub found: Option<Found>,
    /// What it may be.
    pub bound: Bound,
    /// Where the limit is from.
    pub source: &'static str,
}

impl Verdict {
    /// Whether the limit is kept; `None` where it was not measured.
    pub fn kept(&self) -> Option<bool> {
        self.found.map(|found| self.bound.holds(found))
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.found {
            Some(found) => write!(f, "{}: {found}, limit {}", self.metric.name(), self.bound),
            None => write!(f, "{}: not measured; it takes {}", self.metric.name(), self.metric.needs()),
        }
    }
}

/// The value that a share of all keep, between the two nearest; 0 for none.
pub(super) fn percentile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share * (sorted.len().saturating_sub(1)) as f64;
    let at = |i: usize| sorted.get(i).copied().unwrap_or(0.0);
    let (low, part) = (place.floor() as usize, place.fract());
    at(low) + part * (at((low + 1).min(sorted.len().saturating_sub(1))) - at(low))
}
