//! Colour correction: the camera's profile takes balanced camera RGB to scene-linear Rec. 2020.

use darkroot_photo::{CameraSpace, Rgb, Scene};
use darkroot_profile::PlaneModel;

/// Applies a model whose output is linear Rec. 2020.
pub fn correct(mut picture: Rgb<CameraSpace>, model: &PlaneModel) -> Rgb<Scene> {
    model.apply(picture.planes_mut());
    picture.into_space()
}
