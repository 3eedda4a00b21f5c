//! What a camera makes of whites.

use std::path::Path;

use darkroot_colour::Xy;
use darkroot_develop::{CameraMatrix, Whites};
use darkroot_profile::Profile;

use crate::fault::NeutralError;
use crate::{Error, Settings, files, store};

/// Unbalanced camera RGB of these whites, by the matrices that a raw file of the profile's camera carries or that
/// the decoder knows for it. The largest channel of each is 1.
///
/// # Errors
/// A file that cannot be read, one of another camera, or one without matrices.
pub fn neutrals(profile: &Profile, raw_file: &Path, whites: &[Xy]) -> Result<Vec<[f64; 3]>, Error> {
    let settings = Settings::default();
    let bytes = files::read(raw_file)?;
    let capture = darkroot_raw::decode(&bytes, settings.decoder, &settings.limits)
        .map_err(|source| Error::Raw { path: raw_file.to_owned(), source })?;
    let unusable = |source: NeutralError| Error::Neutral { path: raw_file.to_owned(), source };
    if !store::is_for(profile, &capture.camera) {
        let (camera, of) = (capture.camera.name(), profile.camera().name());
        return Err(unusable(NeutralError::OtherCamera { camera, of }));
    }
    let matrix = CameraMatrix::of(&capture);
    let known = Whites::of(matrix.as_ref(), Some(profile));
    let neutral = |white: &Xy| matrix.as_ref().and_then(|_| known.neutral_of(*white));
    let all: Option<Vec<[f64; 3]>> = whites.iter().map(neutral).collect();
    all.ok_or_else(|| unusable(NeutralError::NoMatrix))
}
