//! Exposure: a plain factor on scene-linear light; and the veil that is taken off before it.

use darkroot_photo::{CameraSpace, Rgb, Scene};

/// Multiplies every value by `gain` (2 is one stop more light).
pub fn expose(mut picture: Rgb<Scene>, gain: f32) -> Rgb<Scene> {
    for plane in picture.planes_mut() {
        for v in plane {
            *v *= gain;
        }
    }
    picture
}

/// Takes stray light off balanced camera RGB: what each channel has where no light comes from.
pub fn darken(mut picture: Rgb<CameraSpace>, veil: [f32; 3]) -> Rgb<CameraSpace> {
    for (plane, veil) in picture.planes_mut().into_iter().zip(veil).filter(|(_, veil)| *veil != 0.0) {
        for v in plane {
            *v -= veil;
        }
    }
    picture
}
