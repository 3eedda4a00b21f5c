//! What guidelines ask of a delivery, level by level.
//!
//! The standards are for sale and were not at hand: every number is from a secondary source, which stands beside it with the
//! edition that it speaks of. Where sources contradict themselves a limit is left out and said so in `docs/laboratory.md`.

use std::fmt;

use super::{Delivery, Found, Metric, Verdict};

/// What a value may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// At least.
    pub least: Option<f64>,
    /// At most.
    pub most: Option<f64>,
}

impl Bound {
    /// Whether all of what was found lies within.
    pub fn holds(&self, found: Found) -> bool {
        self.least.is_none_or(|least| found.low >= least) && self.most.is_none_or(|most| found.high <= most)
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.least, self.most) {
            (Some(least), Some(most)) => write!(f, "{least} to {most}"),
            (Some(least), None) => write!(f, "at least {least}"),
            (None, Some(most)) => write!(f, "at most {most}"),
            (None, None) => f.write_str("none"),
        }
    }
}

/// A level of a guideline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Level {
    /// What it is called ("4 stars").
    pub name: &'static str,
    /// Name of the preset that asks for it ("fadgi-4star").
    pub preset: &'static str,
}

/// A limit for each level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// What is limited.
    pub metric: Metric,
    /// The limits, in the order of the levels; `None` where a level has none.
    pub bounds: &'static [Option<Bound>],
    /// Where the numbers are from.
    pub source: &'static str,
}

/// A guideline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guideline {
    /// Its name and edition.
    pub name: &'static str,
    /// Whether its colour differences are CIEDE2000 with SL = 1.
    pub sl1: bool,
    /// Its levels, the best first.
    pub levels: &'static [Level],
    /// Its limits.
    pub rows: &'static [Row],
}

impl Guideline {
    /// What a delivery makes of the limits of a level.
    pub fn verdicts(&self, level: usize, delivery: &Delivery) -> Vec<Verdict> {
        let one = |row: &Row| {
            let bound = row.bounds.get(level).copied().flatten()?;
            let found = delivery.value(row.metric, self.sl1);
            Some(Verdict { metric: row.metric, found, bound, source: row.source })
        };
        self.rows.iter().filter_map(one).collect()
    }

    /// The best level that a delivery reaches in one row; `None` where it reaches none.
    pub fn reached(&self, row: &Row, delivery: &Delivery) -> Option<&'static Level> {
        let found = delivery.value(row.metric, self.sl1)?;
        let holds = |bound: &Option<Bound>| bound.is_some_and(|bound| bound.holds(found));
        row.bounds.iter().position(holds).and_then(|level| self.levels.get(level))
    }
}

/// The guideline and the level of a preset.
pub fn preset(name: &str) -> Option<(&'static Guideline, usize)> {
    let levels =
        |g: &'static Guideline| g.levels.iter().position(|l| l.preset == name).map(|level| (g, level));
    GUIDELINES.iter().find_map(levels)
}

const fn most(v: f64) -> Option<Bound> {
    Some(Bound { least: None, most: Some(v) })
}

const fn least(v: f64) -> Option<Bound> {
    Some(Bound { least: Some(v), most: None })
}

const fn between(low: f64, high: f64) -> Option<Bound> {
    Some(Bound { least: Some(low), most: Some(high) })
}

const fn row(metric: Metric, bounds: &'static [Option<Bound>], source: &'static str) -> Row {
    Row { metric, bounds, source }
}

const fn level(name: &'static str, preset: &'static str) -> Level {
    Level { name, preset }
}

const COMPARED: &str =
    "secondary: comparison of FADGI 2023, ISO 19264-1:2021 and Metamorfoze 2.0 (draft) at skandalski.pl";
const VERSION_2: &str = "secondary: draft of June 2023 at preservationimaging.com";
const REVERSED: &str = "secondary: the comparison at skandalski.pl, whose row of FADGI 2023 is read backwards (4, 3, 2 stars as ISO A, B, C)";
const FADGI_2010: &str =
    "secondary: FADGI 2010 in translation at gxnsmy.com; the numbers of 2023 were not at hand";

/// All guidelines.
pub const GUIDELINES: [Guideline; 3] = [
    Guideline {
        name: "FADGI 2023 (bound general collections)",
        sl1: false,
        levels: &[
            level("4 stars", "fadgi-4star"),
            level("3 stars", "fadgi-3star"),
            level("2 stars", "fadgi-2star"),
            level("1 star", "fadgi-1star"),
        ],
        rows: &[
            row(Metric::ColourMean, &[most(2.0), most(3.5), most(5.0), most(6.5)], COMPARED),
            row(Metric::ColourP90, &[most(4.0), most(7.0), most(10.0), most(13.0)], COMPARED),
            row(Metric::Tone, &[most(1.5), most(3.0), most(4.5), most(6.0)], COMPARED),
            row(Metric::WhiteBalance, &[most(2.0), most(4.0), most(6.0), most(8.0)], COMPARED),
            row(
                Metric::GainHighlights,
                &[between(0.8, 1.1), between(0.7, 1.2), between(0.6, 1.3), between(0.5, 1.4)],
                COMPARED,
            ),
            row(
                Metric::GainOther,
                &[between(0.7, 1.3), between(0.6, 1.4), between(0.3, 1.6), between(0.25, 1.7)],
                REVERSED,
            ),
            row(Metric::Noise, &[most(1.0), most(2.0), most(3.0), most(4.0)], COMPARED),
            row(Metric::SamplingEfficiency, &[least(90.0), least(80.0), least(70.0), least(60.0)], COMPARED),
            row(Metric::SamplingRate, &[least(396.0), least(294.0), least(242.5), least(190.0)], COMPARED),
            row(Metric::Sharpening, &[most(1.0), most(1.1), most(1.2), None], FADGI_2010),
            row(Metric::Misregistration, &[most(0.33), most(0.5), most(0.8), None], FADGI_2010),
            row(Metric::Illumination, &[most(1.0), most(3.0), most(5.0), None], FADGI_2010),
        ],
    },
    Guideline {
        name: "ISO 19264-1:2021",
        sl1: false,
        levels: &[level("A", "iso19264-a"), level("B", "iso19264-b"), level("C", "iso19264-c")],
        rows: &[
            row(Metric::ColourMean, &[most(4.0), most(5.0), most(5.0)], COMPARED),
            row(Metric::ColourMax, &[most(10.0), most(15.0), most(15.0)], COMPARED),
            row(Metric::Tone, &[most(2.0), most(3.0), most(4.0)], COMPARED),
            row(Metric::WhiteBalance, &[most(3.0), most(4.0), most(5.0)], COMPARED),
            row(Metric::GainHighlights, &[between(0.8, 1.1), between(0.7, 1.2), between(0.6, 1.3)], COMPARED),
            row(Metric::GainOther, &[between(0.7, 1.3), between(0.6, 1.4), between(0.3, 1.6)], COMPARED),
            row(Metric::Noise, &[most(1.6), most(2.0), most(2.2)], COMPARED),
            row(Metric::SamplingEfficiency, &[least(85.0), least(80.0), least(70.0)], COMPARED),
        ],
    },
    Guideline {
        name: "Metamorfoze 2.0 (draft of June 2023)",
        sl1: true,
        levels: &[
            level("full", "metamorfoze-full"),
            level("light", "metamorfoze-light"),
            level("extra light", "metamorfoze-extra-light"),
        ],
        rows: &[
            row(Metric::ColourMean, &[most(3.0), most(4.0), None], VERSION_2),
            row(Metric::ColourMax, &[most(7.0), most(14.0), None], VERSION_2),
            row(Metric::Tone, &[most(2.0), most(2.0), most(4.0)], COMPARED),
            row(Metric::WhiteBalance, &[most(3.0), most(3.0), most(5.0)], VERSION_2),
            row(
                Metric::GainHighlights,
                &[between(0.8, 1.1), between(0.8, 1.1), between(0.8, 1.1)],
                VERSION_2,
            ),
            row(Metric::GainOther, &[between(0.7, 1.2), between(0.7, 1.2), between(0.6, 1.3)], COMPARED),
            row(Metric::Noise, &[most(1.6), most(1.6), most(2.0)], COMPARED),
            row(Metric::SamplingEfficiency, &[least(85.0), None, None], COMPARED),
        ],
    },
];

/// What is measured without a limit, and after what: no source at hand has a number for it.
pub const UNLIMITED: [(Metric, &str); 3] = [
    (
        Metric::VisualNoise,
        "ISO 15739:2013, annex B, by secondary sources (Imatest, Image Engineering), sensitivities of Johnson and Fairchild 2003 \
         and Baxter et al. 2012; that of 2023 is another",
    ),
    (
        Metric::DynamicRange,
        "ISO 15739:2013, 6.4, by secondary sources (Kerr 2008), extrapolated by the noise of the greys: an estimate; the lower \
         number can be relied on",
    ),
    (
        Metric::Banding,
        "Darkroot's own; FADGI 2016 names field artifacts and leaves their measure to the future",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_row_has_a_limit_for_each_level_and_they_get_no_stricter() {
        for guideline in GUIDELINES {
            for row in guideline.rows {
                assert_eq!(row.bounds.len(), guideline.levels.len(), "{:?}", row.metric);
                for pair in row.bounds.windows(2) {
                    let [Some(better), Some(worse)] = pair else { continue };
                    let most = |b: &Bound| b.most.unwrap_or(f64::INFINITY);
                    let least = |b: &Bound| b.least.unwrap_or(f64::NEG_INFINITY);
                    assert!(most(worse) >= most(better) && least(worse) <= least(better), "{:?}", row.metric);
                }
            }
        }
    }

    #[test]
    fn presets_of_shots_ask_for_no_other_colours() {
        for (name, limits) in crate::judge::PRESETS {
            let (guideline, level) = preset(name).unwrap();
            let bound = |metric| {
                let row = guideline.rows.iter().find(|row| row.metric == metric)?;
                row.bounds[level].and_then(|bound| bound.most)
            };
            assert_eq!((bound(Metric::ColourMean), guideline.sl1), (limits.mean, limits.sl1), "{name}");
            assert_eq!(bound(Metric::ColourMax), limits.max, "{name}");
        }
    }
}
