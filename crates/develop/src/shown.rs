//! How light of the scene is shown: by the curve of a look, as the profile says, or in proportion.

use darkroot_photo::Capture;
use darkroot_profile::Profile;

use crate::error::Error;
use crate::recipe::{Look, Recipe};
use crate::tone::{Curve, ProfileLook};

/// How light of the scene is shown.
#[derive(Debug, Clone)]
pub(crate) enum Shown {
    /// By the curve of a look.
    Curve(Curve),
    /// As the profile says.
    Profile(ProfileLook),
}

impl Shown {
    /// `None` where light is shown in proportion, and for camera output, of which nothing is shown.
    pub(crate) fn of(
        recipe: &Recipe,
        profile: Option<&Profile>,
        camera_output: bool,
    ) -> Result<Option<Self>, Error> {
        let overlay = recipe.lut.as_ref();
        if recipe.look != Look::Profile {
            return Ok(Curve::of(recipe.look, &recipe.tones, overlay).map(Self::Curve));
        }
        match profile.and_then(Profile::rendering) {
            _ if camera_output => Ok(None),
            Some(rendering) => Ok(Some(Self::Profile(ProfileLook::of(rendering, &recipe.tones, overlay)))),
            None => Err(Error::NoProfileLook),
        }
    }

    /// Stops that makers add: none where light is shown in proportion.
    pub(crate) fn baseline(shown: Option<&Self>, capture: &Capture, profile: Option<&Profile>) -> f64 {
        let of_profile = || profile.and_then(Profile::rendering).map_or(0.0, |rendering| rendering.exposure);
        match shown {
            None => 0.0,
            Some(Self::Curve(_)) => capture.baseline_exposure,
            Some(Self::Profile(_)) => capture.baseline_exposure + of_profile(),
        }
    }
}
