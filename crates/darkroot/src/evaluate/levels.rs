//! The root-polynomial paper's third table, from real shots: models that were fitted under one level of light, judged under
//! others.
//!
//! The chart is shot under the full light and again under less, at the same exposure, and every patch is measured both times
//! with a spectroradiometer. Each model is fitted to the first shot by plain least squares. It is judged there on each patch
//! left out, on the same patch in the other shots, and in the first shot scaled by a factor.

use std::path::PathBuf;

use darkroot_chart::reference::ReferenceColour;
use darkroot_chart::{ChartLayout, Reference};
use darkroot_colour::{Xyz, white};
use darkroot_profile::fit::{Samples, plain};
use darkroot_profile::{Errors, Kind};

use super::MODELS;
use crate::fault::ChartError;
use crate::shot::{self, ShotOptions};
use crate::{Error, Settings, charts, shown};

/// Factors of light that are simulated from the first shot, as in the paper.
const FACTORS: [f64; 2] = [1.1, 1.2];

/// What is judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// The shots, each with the table of its measured XYZ; models are fitted to the first.
    pub shots: Vec<(PathBuf, PathBuf)>,
    /// The chart.
    pub layout: ChartLayout,
    /// Leave out patches of the chart's border.
    pub inner: bool,
    /// How the shots are read.
    pub options: ShotOptions,
}

/// Every model at one level of light.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The level in words.
    pub name: String,
    /// Errors of each of [`MODELS`]; `None` where there are too few patches for it.
    pub errors: Vec<(Kind, Option<Errors>)>,
    /// What the paper prints there: mean, median, 95th percentile and maximum of dE*uv for each model.
    pub paper: Option<[[f64; 4]; 7]>,
}

/// One shot with its measurements.
struct Seen {
    rgb: Vec<[f64; 3]>,
    xyz: Vec<Xyz>,
    /// Measured XYZ of a perfect diffuser.
    white: Xyz,
}

/// Judges the models; the number of patches, and each level.
///
/// # Errors
/// Shots or tables that cannot be used, too few patches.
pub fn levels(request: &Levels, settings: &Settings) -> Result<(usize, Vec<Level>), Error> {
    let seen =
        request.shots.iter().map(|pair| see(pair, request, settings)).collect::<Result<Vec<_>, _>>()?;
    let whole = |i: usize| seen.iter().all(|(_, whole)| whole[i]);
    let patches = 0..request.layout.patches.len();
    let usable: Vec<usize> =
        patches.filter(|i| whole(*i) && (!request.inner || is_inner(*i, request))).collect();
    let taken = |(seen, _): &(Seen, Vec<bool>)| Seen {
        rgb: usable.iter().map(|i| seen.rgb[*i]).collect(),
        xyz: usable.iter().map(|i| seen.xyz[*i]).collect(),
        white: seen.white,
    };
    let seen: Vec<Seen> = seen.iter().map(taken).collect();
    let (first, others) = seen.split_first().ok_or(Error::NoLight)?;
    let samples = Samples::new(first.rgb.clone(), first.xyz.clone(), first.white);
    let samples = samples.map_err(|e| Error::chart(&request.shots[0].0, e))?;
    let judged = |name: String, seen: &Seen, paper: Option<[[f64; 4]; 7]>| {
        let errors = |kind: Kind| {
            let estimates = plain::left_out_seen_as(&samples, kind, &seen.rgb).ok()?;
            Some(Errors::between(&estimates, &seen.xyz, seen.white))
        };
        Level { name, errors: MODELS.map(|kind| (kind, errors(kind))).to_vec(), paper }
    };
    let mut levels = vec![judged("the light of the fit".to_owned(), first, Some(PAPER_FIXED))];
    for (seen, (path, _)) in others.iter().zip(&request.shots[1..]) {
        let factor = seen.white.y / first.white.y;
        let paper = ((0.4..=0.6).contains(&factor)).then_some(PAPER_HALVED);
        levels.push(judged(format!("{}: light x{factor:.2}, measured", shown(path)), seen, paper));
    }
    for (factor, paper) in FACTORS.into_iter().zip([PAPER_1_1, PAPER_1_2]) {
        let scaled = Seen {
            rgb: first.rgb.iter().map(|rgb| rgb.map(|v| v * factor)).collect(),
            xyz: first.xyz.iter().map(|c| c.scaled(factor)).collect(),
            white: first.white.scaled(factor),
        };
        levels.push(judged(format!("light x{factor}, simulated"), &scaled, Some(paper)));
    }
    Ok((usable.len(), levels))
}

/// Measures a shot and reads what an instrument made of its patches; and which of them the shot has whole.
fn see(
    (path, table): &(PathBuf, PathBuf),
    request: &Levels,
    settings: &Settings,
) -> Result<(Seen, Vec<bool>), Error> {
    let layout = &request.layout;
    // Only to find the chart and its brightest patch: what the patches are stands in the table.
    let maker = layout.patches.iter().map(|p| (p.name.clone(), ReferenceColour::Lab(p.lab)));
    let maker = Reference { patches: maker.collect() };
    let (shot, _) = shot::open(path, layout, &maker, &request.options, settings)?;
    let names: Vec<&str> = layout.patches.iter().map(|p| p.name.as_str()).collect();
    let measured = Reference::parse(&charts::read(table)?).map_err(|e| Error::chart(table, e))?;
    let colours = measured.for_patches(&names).map_err(|e| Error::chart(table, e))?;
    let xyz = colours.into_iter().map(|colour| match colour {
        ReferenceColour::Xyz(xyz) => Ok(xyz),
        _ => Err(Error::chart(table, ChartError::NotXyz)),
    });
    let xyz = xyz.collect::<Result<Vec<Xyz>, Error>>()?;
    let expected: Vec<f64> = layout.patches.iter().map(|p| p.lab.xyz(white::D50).y).collect();
    let brightest = (0..expected.len()).max_by(|a, b| expected[*a].total_cmp(&expected[*b])).unwrap_or(0);
    let diffuser = xyz[brightest].scaled(1.0 / expected[brightest].max(1e-6));
    let (rgb, whole) = shot.patches.iter().map(|p| (p.rgb, p.excluded.is_none())).unzip();
    Ok((Seen { rgb, xyz, white: diffuser }, whole))
}

/// Whether a patch does not lie at the border of the chart.
fn is_inner(patch: usize, request: &Levels) -> bool {
    let ChartLayout { columns, rows, .. } = request.layout;
    let (x, y) = (patch % columns, patch / columns);
    x > 0 && y > 0 && x + 1 < columns && y + 1 < rows
}

// Finlayson, Mackiewicz and Hurlbert, "Root-Polynomial Colour Correction", CIC 19, 2011, table 3: Nikon D60, 96 patches of
// the Digital SG under tungsten light.
const PAPER_FIXED: [[f64; 4]; 7] = [
    [2.8, 1.9, 8.4, 13.4],
    [2.3, 1.9, 7.0, 8.4],
    [2.2, 1.8, 6.0, 7.9],
    [2.4, 2.0, 6.3, 8.6],
    [2.1, 1.5, 6.6, 8.3],
    [2.1, 1.5, 6.4, 11.2],
    [2.2, 1.5, 6.2, 12.9],
];
const PAPER_HALVED: [[f64; 4]; 7] = [
    [2.7, 1.8, 8.6, 13.3],
    [2.6, 2.3, 7.0, 10.4],
    [2.6, 2.3, 6.0, 7.4],
    [3.1, 2.5, 7.2, 10.4],
    [2.2, 1.6, 7.4, 8.8],
    [2.2, 1.5, 6.1, 8.7],
    [2.2, 1.7, 6.2, 9.1],
];
const PAPER_1_1: [[f64; 4]; 7] = [
    PAPER_FIXED[0],
    [2.3, 1.9, 6.5, 8.3],
    [2.4, 1.9, 6.0, 7.6],
    [2.8, 2.2, 6.7, 14.0],
    PAPER_FIXED[4],
    PAPER_FIXED[5],
    PAPER_FIXED[6],
];
const PAPER_1_2: [[f64; 4]; 7] = [
    PAPER_FIXED[0],
    [2.4, 1.8, 7.0, 8.1],
    [2.6, 1.8, 6.8, 11.8],
    [3.5, 2.2, 10.5, 21.4],
    PAPER_FIXED[4],
    PAPER_FIXED[5],
    PAPER_FIXED[6],
];
