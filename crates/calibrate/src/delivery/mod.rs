//! A finished picture of a chart against what the chart is: what a client gets, and may measure himself.
//!
//! Unlike a shot of the sensor nothing is fitted or balanced here: the numbers of the picture, through its own profile, are
//! colours relative to D50, and those are compared with the reference. [`guidelines`] says what they have to be.

pub mod guidelines;
pub use guidelines::{Bound, GUIDELINES, Guideline, Level, Row, UNLIMITED, preset};

mod dynamic_range;
pub use dynamic_range::DynamicRange;

mod tones;
pub use tones::{Grey, Step};

mod values;
pub use values::{Found, Metric, Verdict};

use darkroot_chart::{Banding, Distortion, PatchNoise};
use darkroot_colour::adaptation::bradford;
use darkroot_colour::difference::{de2000, de2000_sl1};
use darkroot_colour::{Lab, Vector3, Xyz, white};
use darkroot_profile::Summary;

use crate::patch::{Reference, with_spectra};
use crate::{JudgedPatch, LightSource, MeasuredPatch};

/// A finished picture, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Delivery {
    /// Every patch: its colour in the picture, and what it should be.
    pub patches: Vec<JudgedPatch>,
    /// CIEDE2000 over the patches that take part.
    pub de2000: Summary,
    /// The same with SL = 1, which weighs dark and bright as much as middle greys.
    pub sl1: Summary,
    /// CIEDE2000 that nine of ten patches keep.
    pub p90: f64,
    /// The grey patches, from light to dark.
    pub greys: Vec<Grey>,
    /// What lies between two neighbours of them.
    pub steps: Vec<Step>,
    /// How far they say that the picture reaches into the dark.
    pub dynamic_range: Option<DynamicRange>,
    /// What other pictures and the edges of the chart tell.
    pub details: Details,
    /// What had to be assumed of the reference.
    pub notes: Vec<String>,
}

/// What is measured beside the patches; `None` where the picture does not show it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Details {
    /// Differences over the picture of an even surface.
    pub uniformity: Option<Uniformity>,
    /// Bands of rows and columns in that picture.
    pub banding: Option<Banding>,
    /// Sharpness of slanted edges.
    pub edges: Option<Edges>,
    /// Pixels an inch of the original.
    pub scale: Option<Scale>,
    /// How far the chart's patches lie from a plane grid.
    pub distortion: Option<Distortion>,
}

/// How large the original is in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Pixels an inch, by the chart.
    pub found: f64,
    /// Pixels an inch that the file states, where it does.
    pub stated: Option<f64>,
}

/// How even a picture of an even surface is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uniformity {
    /// Largest difference of L\* between two parts of it.
    pub lightness: f64,
    /// Largest difference of luminance between two parts, in percent of the mean.
    pub luminance: f64,
    /// Largest distance in a\*b\* between a part and the mean.
    pub colour: f64,
}

/// What slanted edges show, the median over them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edges {
    /// How many there were.
    pub count: usize,
    /// Frequency at which half of the contrast is left, cycles a pixel.
    pub sfr50: f64,
    /// Frequency at which a tenth is left, cycles a pixel.
    pub sfr10: f64,
    /// Largest response from 0.1 to 0.5 cycles a pixel: above 1 the picture is sharpened.
    pub peak: f64,
    /// Largest distance of the edge in red or in blue from that in green, pixels.
    pub misregistration: f64,
}

/// Judges the patches of a finished picture. `patches` have linear light of the picture as their `rgb`, which `colour` turns
/// into XYZ relative to D50; `noise` is that of each. The reference is that under `light`, adapted
/// to D50 (Bradford): for D50 itself the colours as they are given, else those of the spectra, which are recovered where the
/// reference has none.
pub fn judge(
    patches: &[MeasuredPatch],
    noise: &[PatchNoise],
    colour: impl Fn([f64; 3]) -> Xyz,
    light: &LightSource,
    details: Details,
) -> Delivery {
    let mut notes = Vec::new();
    let with_light;
    let known = if light.light.name == "D50" {
        patches
    } else {
        with_light = with_spectra(patches, light, &mut notes);
        &*with_light
    };
    let light_white = light.light.xy.xyz();
    let reference = Reference::new(known, light, light_white, &mut notes);
    let to_d50 = bradford(light_white, white::D50);
    let judged: Vec<JudgedPatch> = known
        .iter()
        .map(|patch| {
            let truth = Xyz::from(to_d50 * Vector3::from(reference.xyz(patch)));
            JudgedPatch::new(patch, patch.rgb, truth, colour(patch.rgb), None)
        })
        .collect();
    let used = || judged.iter().zip(noise).filter(|(patch, _)| patch.excluded.is_none());
    let labs = |patch: &JudgedPatch| (patch.corrected.lab(white::D50), patch.reference.lab(white::D50));
    let all = |difference: fn(Lab, Lab) -> f64| -> Vec<f64> {
        used().map(|(patch, _)| labs(patch)).map(|(found, truth)| difference(found, truth)).collect()
    };
    let plain = all(de2000);
    let greys = tones::greys(used());
    Delivery {
        de2000: Summary::of(&plain),
        sl1: Summary::of(&all(de2000_sl1)),
        p90: values::percentile(&plain, 0.9),
        steps: tones::steps(&greys),
        dynamic_range: dynamic_range::dynamic_range(&greys),
        greys,
        details,
        notes,
        patches: judged,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_chart::ReferenceColour;

    /// Patches of a chart whose XYZ are their `rgb`, changed in L*.
    fn delivered(change: impl Fn(f64) -> f64) -> Delivery {
        let labs = [
            (95.0, 0.0, 1.0),
            (81.0, 0.0, 0.0),
            (66.0, 0.0, 0.0),
            (50.0, 0.5, 0.0),
            (35.0, 0.0, 0.0),
            (40.0, 50.0, 30.0),
        ];
        let patch = |(i, (l, a, b)): (usize, &(f64, f64, f64))| {
            let truth = Lab { l: *l, a: *a, b: *b };
            let found = Lab { l: change(*l), ..truth }.xyz(white::D50);
            MeasuredPatch {
                name: format!("{i}"),
                rgb: [found.x, found.y, found.z],
                uncertainty: [0.0; 3],
                clipped: 0.0,
                reference: ReferenceColour::Lab(truth),
                excluded: None,
            }
        };
        let patches: Vec<MeasuredPatch> = labs.iter().enumerate().map(patch).collect();
        let noise = [PatchNoise { lightness: 0.5, ..PatchNoise::default() }; 6];
        judge(&patches, &noise, |[x, y, z]| Xyz::new(x, y, z), &LightSource::assumed(), Details::default())
    }

    #[test]
    fn a_picture_as_it_should_be_has_no_errors() {
        let found = delivered(|l| l);
        assert!(found.de2000.max < 1e-6 && found.greys.len() == 5 && found.notes.is_empty());
        assert!(found.steps.iter().all(|step| (step.gain - 1.0).abs() < 1e-6));
        let best =
            |name: &str| preset(name).map(|(guideline, level)| guideline.verdicts(level, &found)).unwrap();
        for name in ["fadgi-4star", "iso19264-a", "metamorfoze-full"] {
            assert!(best(name).iter().all(|verdict| verdict.kept() != Some(false)), "{name}");
        }
    }

    #[test]
    fn tones_that_are_off_are_told_by_how_much_and_where() {
        // Middle tones three L* too light: steps towards white get flatter, those towards black steeper.
        let found = delivered(|l| if (60.0..90.0).contains(&l) { l + 3.0 } else { l });
        let worst = found.greys.iter().map(|grey| grey.lightness_error().abs()).fold(0.0, f64::max);
        assert!((worst - 3.0).abs() < 1e-6, "{worst}");
        let gains: Vec<f64> = found.steps.iter().map(|step| step.gain).collect();
        assert!((gains[0] - 11.0 / 14.0).abs() < 1e-6 && (gains[2] - 19.0 / 16.0).abs() < 1e-6, "{gains:?}");
        let broken = |name: &str| {
            let (guideline, level) = preset(name).unwrap();
            let verdicts = guideline.verdicts(level, &found);
            let broken = verdicts.iter().filter(|verdict| verdict.kept() == Some(false));
            broken.map(|verdict| verdict.metric).collect::<Vec<_>>()
        };
        assert_eq!(broken("iso19264-a"), [Metric::Tone, Metric::GainHighlights]);
        assert_eq!(broken("iso19264-b"), []);
    }

    #[test]
    fn what_was_not_measured_is_neither_kept_nor_broken() {
        let (guideline, level) = preset("iso19264-a").unwrap();
        let verdicts = guideline.verdicts(level, &delivered(|l| l));
        let sharp = verdicts.iter().find(|v| v.metric == Metric::SamplingEfficiency).unwrap();
        assert_eq!((sharp.kept(), sharp.found), (None, None));
    }
}
