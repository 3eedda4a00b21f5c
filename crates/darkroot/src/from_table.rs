//! Tables of photographed patches to a profile, without a shot: what another program or a laboratory has measured.

use std::path::{Path, PathBuf};

use darkroot_calibrate::fit::Choice;
use darkroot_calibrate::{Calibrated, MeasuredPatch, calibrate};
use darkroot_chart::ReferenceColour;
use darkroot_chart::reference::{PhotographedPatch, photographed};
use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Vector3, Xyz, white};
use darkroot_profile::{Kind, Origin, Profile, ProfileCamera};

use crate::fault::ChartError;
use crate::light::LightSource;
use crate::{Error, charts, files};

/// What a profile is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct FromTable {
    /// The camera, as raw files name it.
    pub camera: ProfileCamera,
    /// Tables of patches, each with the light that they were photographed in.
    pub tables: Vec<(PathBuf, LightSource)>,
    /// Their XYZ were measured in that light, relative to its white. Else they are those under D50, as references have them.
    pub measured_in_light: bool,
    /// The model; the best one if not given.
    pub kind: Option<Kind>,
    /// Names of patches to leave out.
    pub exclude: Vec<String>,
    /// Day that the profile carries, YYYY-MM-DD; may be empty.
    pub date: String,
}

/// A profile and the fit under each light.
#[derive(Debug, Clone, PartialEq)]
pub struct TableProfile {
    /// The profile.
    pub profile: Profile,
    /// A light and its fit for each table.
    pub lights: Vec<(LightSource, Calibrated)>,
}

/// Fits the profile.
///
/// # Errors
/// Files that are no such tables, too few patches, a model that cannot be fitted.
pub fn from_table(request: &FromTable) -> Result<TableProfile, Error> {
    let (mut lights, mut names, mut hashes) = (Vec::new(), Vec::new(), Vec::new());
    for (path, light) in &request.tables {
        let text = charts::read(path)?;
        hashes.push(files::sha256(text.as_bytes()));
        names.push(path.file_name().unwrap_or_default().to_string_lossy().into_owned());
        let patches = patches(path, &text, light, request)?;
        // Colours measured in the light need no spectrum of it, and would be wrong by one.
        let seen_in = match request.measured_in_light {
            true => LightSource { spectrum: None, ..light.clone() },
            false => light.clone(),
        };
        let choice = Choice { kind: request.kind, ..Choice::default() };
        let mut calibrated = calibrate(&seen_in, &patches, &choice).map_err(|e| Error::fit(light, e))?;
        if request.measured_in_light {
            // What it says of adapted colours does not hold for these.
            calibrated.notes =
                vec!["the colours are those that were measured in the light itself".to_owned()];
        }
        lights.push((light.clone(), calibrated));
    }
    let origin = Origin {
        summary: format!("{} table{} of patches", lights.len(), if lights.len() == 1 { "" } else { "s" }),
        reference: names.join(", "),
        reference_sha256: hashes.join(", "),
        date: request.date.clone(),
        program: format!("darkroot {}", crate::VERSION),
        ..Origin::default()
    };
    let calibrations = lights.iter().map(|(_, c)| c.calibration.clone()).collect();
    let profile = Profile::new(request.camera.clone(), calibrations, origin).ok_or(Error::NoLight)?;
    Ok(TableProfile { profile, lights })
}

/// The patches of a table, as a shot would have given them.
fn patches(
    path: &Path,
    text: &str,
    light: &LightSource,
    request: &FromTable,
) -> Result<Vec<MeasuredPatch>, Error> {
    let patches = photographed(text).map_err(|e| Error::chart(path, e))?;
    let named = |name: &String| patches.iter().any(|p| p.name.eq_ignore_ascii_case(name));
    if let Some(name) = request.exclude.iter().find(|name| !named(name)) {
        return Err(Error::chart(path, ChartError::NoPatch { name: name.clone() }));
    }
    let to_d50 = bradford(light.light.xy.xyz(), white::D50);
    let one = |patch: PhotographedPatch| {
        let reference = match (patch.colour, request.measured_in_light) {
            // Adapted there and, in the fit, back again.
            (ReferenceColour::Xyz(xyz), true) => ReferenceColour::Xyz(Xyz::from(to_d50 * Vector3::from(xyz))),
            (_, true) => return Err(Error::chart(path, ChartError::NotXyz)),
            (colour, false) => colour,
        };
        let by_hand = request.exclude.iter().any(|name| name.eq_ignore_ascii_case(&patch.name));
        let dark = patch.rgb.iter().any(|v| *v <= 0.0).then_some("darker than black");
        let excluded = if by_hand { Some("left out by hand") } else { dark };
        let excluded = excluded.map(str::to_owned);
        let (name, rgb) = (patch.name, patch.rgb);
        Ok(MeasuredPatch { name, rgb, uncertainty: [0.0; 3], clipped: 0.0, reference, excluded })
    };
    patches.into_iter().map(one).collect()
}
