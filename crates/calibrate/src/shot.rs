//! One shot of a chart: measured, corrected, judged. The three functions are called in that order.

use darkroot_chart::reference::ReferenceError;
use darkroot_chart::{ChartLayout, Measurement, Quad, Reference, ReferenceColour, Slope, edge_width};
use darkroot_colour::difference::de2000;
use darkroot_colour::{Xyz, white};
use darkroot_photo::Mosaic;

use crate::corrections::{
    self, ColourChange, Correct, Corrections, CrossValidation, Patches, SlopeModel, TakeOut,
};
use crate::gates::{self, Corrected, Gate, by_channel};
use crate::patch::{MeasuredPatch, is_clipped};

/// Why a shot cannot be measured.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShotError {
    /// The reference does not fit the chart.
    #[error("the reference {0}")]
    Reference(ReferenceError),
    /// The reference has the chart's patches, but other colours.
    #[error("of the reference: {0}")]
    ReferenceColours(ReferenceError),
    /// A patch that is too small.
    #[error("patch {patch} covers too few pixels to be measured; come nearer, or use a longer lens")]
    TooSmall {
        /// Its name.
        patch: String,
    },
    /// The shot of an even surface is clipped.
    #[error("the flat is clipped; take it with less light")]
    FlatClipped,
    /// A patch to leave out that the chart does not have.
    #[error("the chart has no patch `{name}` to exclude")]
    NoPatch {
        /// As it was given.
        name: String,
    },
}

/// A chart with the colours of its patches.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart<'a> {
    /// The layout.
    pub layout: &'a ChartLayout,
    /// What each patch is.
    pub colours: Vec<ReferenceColour>,
    /// The same relative to D50.
    pub expected: Vec<Xyz>,
    /// What had to be assumed of the reference.
    pub notes: Vec<String>,
}

impl<'a> Chart<'a> {
    /// Finds the colour of each patch in a reference.
    ///
    /// # Errors
    /// A reference that lacks patches, or is that of another chart.
    pub fn new(layout: &'a ChartLayout, reference: &Reference) -> Result<Self, ShotError> {
        let names: Vec<&str> = layout.patches.iter().map(|p| p.name.as_str()).collect();
        let of = |colours: Vec<ReferenceColour>, notes| {
            let expected: Vec<Xyz> = colours.iter().map(ReferenceColour::xyz_d50).collect();
            Self { layout, colours, expected, notes }
        };
        let missing = match reference.for_patches(&names) {
            Ok(colours) => {
                let chart = of(colours, Vec::new());
                return chart.check().map(|()| chart);
            }
            Err(missing) => missing,
        };
        // Names of another custom: which sequence is meant, the colours of the chart tell.
        let named = |(sequence, colours)| {
            let note = format!("the reference has other names for the patches: they were taken {sequence}");
            of(colours, vec![note])
        };
        let charts = reference.in_sequence(layout.columns, layout.rows).into_iter().map(named);
        let nearest = charts.min_by(|a, b| a.off().total_cmp(&b.off()));
        let chart = nearest.ok_or(ShotError::Reference(missing))?;
        chart.check().map(|()| chart)
    }

    /// Whether the colours are those of the layout, roughly.
    fn check(&self) -> Result<(), ShotError> {
        const MOST: f64 = 15.0;
        let mean = self.off();
        if mean <= MOST {
            return Ok(());
        }
        let chart = self.layout.title.clone();
        Err(ShotError::ReferenceColours(ReferenceError::OtherChart { chart, off: mean }))
    }

    /// How far the colours are from those of the layout, mean dE2000.
    fn off(&self) -> f64 {
        let pairs = self.layout.patches.iter().zip(&self.expected);
        let off = pairs.map(|(patch, xyz)| de2000(xyz.lab(white::D50), patch.lab));
        off.sum::<f64>() / self.colours.len().max(1) as f64
    }

    fn name(&self, i: usize) -> &str {
        &self.layout.patches[i].name
    }
}

/// Light of a sensor, before anything is interpolated.
#[derive(Debug, Clone, Copy)]
pub struct SensorLight<'a> {
    /// Samples, 0 = black, 1 = the white level.
    pub light: &'a Mosaic<f32>,
    /// Light at which red, green and blue clip.
    pub saturation: [f32; 3],
}

impl SensorLight<'_> {
    fn measure(self, windows: &[Quad]) -> Vec<Measurement> {
        darkroot_chart::measure(self.light, self.saturation, windows)
    }
}

/// Shots that help to measure a chart.
#[derive(Debug, Clone, Copy, Default)]
pub struct Companions<'a> {
    /// A shot with the lens closed, which is subtracted.
    pub dark: Option<SensorLight<'a>>,
    /// A shot of an even surface in the same light, by which the chart's is divided.
    pub flat: Option<SensorLight<'a>>,
}

/// Patches as they were measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The measurements as they are.
    pub measurements: Vec<Measurement>,
    /// Camera RGB of each patch, by the companions.
    pub rgb: Vec<[f64; 3]>,
}

/// Measures the patches of a chart. `windows` are the parts to measure, in pixels of the sensor.
///
/// # Errors
/// Patches that are too small, a flat that is clipped.
pub fn measure(
    chart: &Chart<'_>,
    shot: SensorLight<'_>,
    companions: Companions<'_>,
    windows: &[Quad],
) -> Result<Measured, ShotError> {
    let measurements = shot.measure(windows);
    if let Some(i) = measurements.iter().position(|m| !m.is_complete()) {
        return Err(ShotError::TooSmall { patch: chart.name(i).to_owned() });
    }
    let mut rgb: Vec<[f64; 3]> = measurements.iter().map(|m| m.mean).collect();
    if let Some(dark) = companions.dark {
        for (rgb, black) in rgb.iter_mut().zip(dark.measure(windows)) {
            *rgb = [0, 1, 2].map(|c| rgb[c] - black.mean[c]);
        }
    }
    if let Some(flat) = companions.flat {
        let even = flat.measure(windows);
        if even.iter().any(|m| m.clipped > 0.01) {
            return Err(ShotError::FlatClipped);
        }
        for c in 0..3 {
            let mean = even.iter().map(|m| m.mean[c]).sum::<f64>() / even.len() as f64;
            for (rgb, even) in rgb.iter_mut().zip(&even) {
                rgb[c] *= mean / even.mean[c].max(1e-6);
            }
        }
    }
    Ok(Measured { measurements, rgb })
}

/// What is taken out of a shot, and what is left out of it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Treatment<'a> {
    /// Whether the slope of light over the chart is taken out, as far as the patches show it.
    pub even_out: Correct,
    /// Whether the glare is taken out that the patches show.
    pub correct_glare: Correct,
    /// Names of patches to leave out.
    pub exclude: &'a [String],
}

/// Patches as they go into a fit, and what they showed of the light.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrectedShot {
    /// Every patch of the layout.
    pub patches: Vec<MeasuredPatch>,
    /// Slope of light over the chart, as it was.
    pub slope: Slope,
    /// Glare of red, green and blue as shares of white, as it was.
    pub glare: [f64; 3],
    /// Change of the light's colour over the chart, as it was.
    pub colour_change: ColourChange,
    /// Rounds of cross-validation; empty where nothing was corrected by the patches themselves.
    pub cross_validation: Vec<CrossValidation>,
    /// What was taken out.
    pub corrected: Corrected,
    /// The same in words.
    pub notes: Vec<String>,
}

/// Takes out of a shot what its patches show of uneven light and glare.
///
/// # Errors
/// A patch to leave out that the chart does not have.
pub fn correct(
    chart: &Chart<'_>,
    measured: &Measured,
    treatment: Treatment<'_>,
) -> Result<CorrectedShot, ShotError> {
    let count = chart.colours.len();
    let by_hand = |i: usize| treatment.exclude.iter().any(|e| e.eq_ignore_ascii_case(chart.name(i)));
    let known = |e: &&String| (0..count).any(|i| chart.name(i).eq_ignore_ascii_case(e));
    if let Some(unknown) = treatment.exclude.iter().find(|e| !known(e)) {
        return Err(ShotError::NoPatch { name: unknown.clone() });
    }
    let places = darkroot_chart::windows::places(chart.layout);
    let used: Vec<bool> =
        (0..count).map(|i| !is_clipped(measured.measurements[i].clipped) && !by_hand(i)).collect();
    let patches = Patches { rgb: &measured.rgb, expected: &chart.expected, places: &places, used: &used };
    let luminance = corrections::luminances(&measured.rgb, &chart.expected);
    let targets: Vec<f64> = chart.expected.iter().map(|c| c.y).collect();
    let slope = Slope::of(&places, &luminance, &targets).unwrap_or_default();
    let glare = corrections::glare(patches);
    let colour_change = ColourChange::of(patches);
    let slope_model = if colour_change.is_certain() { SlopeModel::PerChannel } else { SlopeModel::Common };
    let take_out = TakeOut::what_helps(patches, treatment.correct_glare, treatment.even_out, slope_model);
    let correction = Corrections::of(patches, take_out);
    let rgb = correction.applied(patches);
    let reason = |i: usize| {
        if is_clipped(measured.measurements[i].clipped) {
            Some("clipped")
        } else if by_hand(i) {
            Some("left out by hand")
        } else if rgb[i].iter().any(|v| *v <= 0.0) {
            Some("darker than black")
        } else {
            None
        }
    };
    let patch = |i: usize| MeasuredPatch {
        name: chart.name(i).to_owned(),
        rgb: rgb[i],
        uncertainty: measured.measurements[i].uncertainty(),
        clipped: measured.measurements[i].clipped,
        reference: chart.colours[i].clone(),
        excluded: reason(i).map(str::to_owned),
    };
    Ok(CorrectedShot {
        patches: (0..count).map(patch).collect(),
        slope,
        glare,
        colour_change,
        cross_validation: corrections::rounds_of_a_fit(patches, take_out),
        corrected: Corrected { unevenness: take_out.slope != SlopeModel::None, glare: take_out.glare },
        notes: notes(take_out, &correction, glare, colour_change),
    })
}

fn notes(take_out: TakeOut, correction: &Corrections, glare: [f64; 3], change: ColourChange) -> Vec<String> {
    let slope = match take_out.slope {
        SlopeModel::None => None,
        SlopeModel::Common => Some(format!(
            "a slope of light of {:.1} % over the chart was taken out",
            100.0 * correction.slopes[1].range()
        )),
        SlopeModel::PerChannel => Some(format!(
            "a slope of light was taken out for each channel: {} % over the chart; the light's colour changes by {:.1} %",
            by_channel(correction.slopes.map(Slope::range)),
            100.0 * change.range
        )),
    };
    let glare = take_out.glare.then(|| format!("glare was taken out: {} % of white", by_channel(glare)));
    slope.into_iter().chain(glare).collect()
}

/// Where a chart stands.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// Its corners in pixels of the developed picture.
    pub corners: &'a Quad,
    /// Whole patches in pixels of the sensor.
    pub patches: &'a [Quad],
}

/// Checks a shot: every gate that one shot can be held against.
pub fn judge(
    chart: &Chart<'_>,
    shot: SensorLight<'_>,
    place: Place<'_>,
    measured: &Measured,
    found: &CorrectedShot,
    corrected: Corrected,
) -> Vec<Gate> {
    let (measurements, expected) = (&measured.measurements, &chart.expected);
    let edges = edge_width(shot.light, shot.saturation, place.patches, chart.layout.columns);
    vec![
        gates::exposure(shot.saturation, measurements, expected),
        gates::clipping(measurements),
        gates::evenness(found.slope.range(), corrected),
        gates::glare(found.glare, corrected),
        gates::noise(measurements, expected),
        gates::size(place.corners, chart.layout),
        gates::angle(place.corners),
        gates::colour_of_light(found.colour_change, corrected),
        gates::sharpness(edges),
    ]
}
