//! Exposure: a plain factor on scene-linear light.

use darkroot_photo::{Rgb, Scene};

/// Multiplies every value by `gain` (2 is one stop more light).
pub fn expose(mut picture: Rgb<Scene>, gain: f32) -> Rgb<Scene> {
    for plane in picture.planes_mut() {
        for v in plane {
            *v *= gain;
        }
    }
    picture
}
