//! The tables of the root-polynomial papers, from spectra.

use std::path::{Path, PathBuf};

use darkroot_calibrate::CalibrateError;
use darkroot_colour::{Spectrum, Xyz};
use darkroot_profile::fit::{Samples, plain};
use darkroot_profile::spectra::in_31_channels;
use darkroot_profile::{Errors, Kind, Order, Summary};

use crate::fault::SpectraError;
use crate::light::LightSource;
use crate::{Error, files, shown, spectra};

/// Models of the papers, in their sequence.
pub const MODELS: [Kind; 7] = [
    Kind::Linear,
    Kind::Polynomial(2),
    Kind::Polynomial(3),
    Kind::Polynomial(4),
    Kind::Root(Order::Two),
    Kind::Root(Order::Three),
    Kind::Root(Order::Four),
];

/// A set of reflectances with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct ReflectanceSet {
    /// Its name ("SG").
    pub name: String,
    /// The reflectances.
    pub reflectances: Vec<Spectrum>,
}

/// Errors of one model, each colour left out of the fit, at one exposure.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The model.
    pub kind: Kind,
    /// The errors; `None` where there are too few colours for it.
    pub errors: Option<Errors>,
    /// What the paper prints for it, if it does: mean, median and 95th percentile of dE*uv.
    pub paper: Option<[f64; 3]>,
}

/// The set that no file has.
const SKY: &str = "sky";

/// Reads a set: `NAME=FILE`, or `NAME=FILE:LIST` with a text file of the names to take, or `sky`, which is computed.
///
/// # Errors
/// Another form, files that cannot be used, names that the file does not have.
pub fn read_set(text: &str) -> Result<ReflectanceSet, Error> {
    if text == SKY {
        return Ok(ReflectanceSet { name: SKY.to_owned(), reflectances: sky() });
    }
    let (name, place) =
        text.split_once('=').ok_or_else(|| Error::spectra(Path::new(text), SpectraError::NoSet))?;
    let (file, list) = match place.rsplit_once(':') {
        Some((file, list)) if !Path::new(place).is_file() => (PathBuf::from(file), Some(PathBuf::from(list))),
        _ => (PathBuf::from(place), None),
    };
    let mut all = spectra::read(&file)?;
    if let Some(list) = list {
        let names = String::from_utf8(files::read_text(&list)?);
        let names = names.map_err(|_| Error::spectra(&list, SpectraError::NotText))?;
        let names: Vec<String> =
            names.lines().map(|l| l.trim().to_owned()).filter(|l| !l.is_empty()).collect();
        all = all
            .only(&names)
            .map_err(|name| Error::spectra(&file, SpectraError::Missing { name, list: shown(&list) }))?;
    }
    Ok(ReflectanceSet { name: name.to_owned(), reflectances: all.reflectances() })
}

/// Blue sky as a surface that daylight shows: CIE daylight of 7000 to 25000 K over D65, of luminance 0.1 to 0.5.
fn sky() -> Vec<Spectrum> {
    let d65 = Spectrum::daylight(6504.0);
    let blue = |kelvin: f64| {
        let day = Spectrum::daylight(kelvin);
        let ratio = Spectrum(std::array::from_fn(|i| day.0[i] / d65.0[i]));
        let own = ratio.reflected_xyz(&d65).y;
        [0.1, 0.2, 0.35, 0.5].map(|luminance| ratio.scaled(luminance / own))
    };
    [7000.0, 8500.0, 11000.0, 15000.0, 25000.0].into_iter().flat_map(blue).collect()
}

/// One table: every model on a set, fitted at exposure 1 and judged at `exposure`, in the papers' protocol: 31
/// channels from 400 to 700 nm, plain least squares, each colour left out, errors relative to the light's white at
/// that exposure.
///
/// # Errors
/// A camera that cannot be read, a light without a spectrum.
pub fn table(
    camera: &Path,
    light: &LightSource,
    set: &ReflectanceSet,
    exposure: f64,
) -> Result<Vec<Row>, Error> {
    let fault = |source: CalibrateError| Error::fit(light, source);
    let spectrum = light.spectrum.as_ref().ok_or_else(|| fault(CalibrateError::NoSpectrum))?;
    let channels = in_31_channels(spectrum);
    let (sensitivities, _) = spectra::read_sensitivities(camera)?;
    let seen = sensitivities.under(&channels);
    let samples = seen.ok_or_else(|| fault(CalibrateError::BlindChannel))?;
    let samples = samples.render(&set.reflectances, &channels).map_err(|e| fault(e.into()))?;
    let row = |kind: Kind| Row {
        kind,
        errors: errors(&samples, kind, exposure),
        paper: published(camera, &light.light.name, &set.name, exposure, kind),
    };
    Ok(MODELS.into_iter().map(row).collect())
}

fn errors(samples: &Samples, kind: Kind, exposure: f64) -> Option<Errors> {
    let estimates = plain::left_out_at_exposure(samples, kind, exposure).ok()?;
    let truths: Vec<Xyz> = samples.xyz().iter().map(|c| c.scaled(exposure)).collect();
    Some(Errors::between(&estimates, &truths, samples.white().scaled(exposure)))
}

/// Three figures in the paper's form.
pub fn in_brief(s: &Summary) -> String {
    format!("{:5.2} {:5.2} {:6.2}", s.mean, s.median, s.p95)
}

/// Finlayson, Mackiewicz and Hurlbert, "Root-Polynomial Colour Correction", CIC 19, 2011, tables 1 and 2: Sony
/// DXC-930 under D65.
fn published(camera: &Path, light: &str, set: &str, exposure: f64, kind: Kind) -> Option<[f64; 3]> {
    let sony = camera.file_stem()?.to_str()?.to_lowercase().replace(['-', '_', ' '], "").contains("dxc930");
    if !sony || light != "D65" {
        return None;
    }
    let at = |k: f64| (exposure - k).abs() < 1e-9;
    let column: [[f64; 3]; 7] = match set.to_uppercase().as_str() {
        "SG" if at(1.0) => PAPER_SG,
        "DC" if at(1.0) => PAPER_DC,
        "SFU" if at(1.0) => PAPER_SFU,
        "DC" if at(0.5) => PAPER_DC_HALF,
        "DC" if at(1.5) => PAPER_DC_MORE,
        "SFU" if at(0.5) => PAPER_SFU_HALF,
        "SFU" if at(1.5) => PAPER_SFU_MORE,
        _ => return None,
    };
    MODELS.iter().position(|k| *k == kind).map(|i| column[i])
}

const PAPER_SG: [[f64; 3]; 7] = [
    [4.8, 2.9, 20.0],
    [4.0, 2.7, 11.0],
    [3.2, 2.2, 7.5],
    [3.1, 2.2, 8.2],
    [2.8, 1.8, 8.7],
    [2.6, 1.6, 8.1],
    [2.6, 1.6, 8.3],
];
const PAPER_DC: [[f64; 3]; 7] = [
    [3.8, 1.9, 14.0],
    [3.1, 1.8, 10.0],
    [2.4, 1.3, 7.7],
    [2.0, 1.2, 6.9],
    [2.4, 1.3, 8.5],
    [2.2, 1.3, 7.5],
    [2.2, 1.3, 7.7],
];
const PAPER_SFU: [[f64; 3]; 7] = [
    [2.6, 1.4, 7.7],
    [2.4, 1.4, 7.2],
    [1.9, 1.2, 6.5],
    [1.8, 1.1, 6.0],
    [2.1, 1.2, 7.0],
    [1.8, 1.2, 6.1],
    [1.8, 1.1, 6.1],
];
const PAPER_DC_HALF: [[f64; 3]; 7] = [
    PAPER_DC[0],
    [3.9, 2.5, 12.0],
    [3.3, 1.9, 10.0],
    [3.0, 1.6, 11.0],
    PAPER_DC[4],
    PAPER_DC[5],
    PAPER_DC[6],
];
const PAPER_DC_MORE: [[f64; 3]; 7] = [
    PAPER_DC[0],
    [3.5, 2.2, 11.0],
    [3.5, 1.5, 15.0],
    [5.0, 1.8, 23.0],
    PAPER_DC[4],
    PAPER_DC[5],
    PAPER_DC[6],
];
const PAPER_SFU_HALF: [[f64; 3]; 7] = [
    PAPER_SFU[0],
    [2.6, 1.6, 8.0],
    [2.5, 1.5, 7.8],
    [2.4, 1.4, 8.0],
    PAPER_SFU[4],
    PAPER_SFU[5],
    PAPER_SFU[6],
];
const PAPER_SFU_MORE: [[f64; 3]; 7] = [
    PAPER_SFU[0],
    [2.4, 1.5, 7.3],
    [2.7, 1.4, 9.6],
    [2.5, 1.3, 8.9],
    PAPER_SFU[4],
    PAPER_SFU[5],
    PAPER_SFU[6],
];
