//! A new shot of a chart against a profile, and the log of such shots.

pub(crate) mod history;
pub use history::history;

mod log;
pub use log::{LogLine, Outcome, append, read_log};

use std::path::Path;

use darkroot_calibrate::judge::judge;
use darkroot_profile::Profile;

pub use darkroot_calibrate::judge::{Broken, Judgement, Limits, PRESETS};

use crate::fault::ChartError;
use crate::light::LightSource;
use crate::shot::ChartRequest;
use crate::shot::{Shot, common_name, light_of, open};
use crate::{Error, Settings};

/// What a shot says about a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// The shot.
    pub shot: Shot,
    /// The light that it was judged under.
    pub light: LightSource,
    /// Whether nobody named it and nothing shows it, so that it was assumed.
    pub light_assumed: bool,
    /// What its patches say.
    pub judgement: Judgement,
}

/// Measures a shot of a request's chart and judges it by a profile, under the light that was named, or the one that the
/// shot shows.
///
/// # Errors
/// A shot that cannot be used, is of another camera than the profile's, or was taken in another light than the one named.
pub fn verify(
    profile: &Profile,
    path: &Path,
    light: Option<&LightSource>,
    request: &ChartRequest,
    settings: &Settings,
) -> Result<Verification, Error> {
    // Where nobody named one, the chart is what it was when the profile was made.
    let recorded = &profile.origin().reference;
    let same = request.other_references.iter().find(|other| other.name == *recorded);
    let reference = same.map_or(&request.reference, |same| &same.colours);
    let (shot, view) = open(path, &request.layout, reference, &request.options, settings)?;
    if !crate::store::is_for(profile, &shot.camera) {
        let (camera, of) = (common_name(&shot.camera), profile.camera().name());
        return Err(Error::chart(path, ChartError::OtherCamera { camera, of }));
    }
    let found = light_of(&shot, &view, light, request.options.accept)?;
    let light_assumed = found.is_none();
    let light = found.unwrap_or_else(LightSource::assumed);
    let judgement = judge(profile, &light, &shot.patches).map_err(|e| Error::fit(&light, e))?;
    Ok(Verification { shot, light, light_assumed, judgement })
}
