//! The fields that a picture gets.

use darkroot_photo::metadata::{Directory, Metadata, Value, tag};
use darkroot_photo::{Capture, PictureSpace};

use crate::VERSION;

/// The camera's fields with what developing changed.
pub(super) fn metadata_for(capture: &Capture, space: &PictureSpace, dpi: Option<u32>) -> Metadata {
    const INCH: u16 = 2;
    const SRGB: u16 = 1;
    const UNCALIBRATED: u16 = 65535;
    let mut metadata = capture.metadata.clone();
    let source = if capture.rendered { ", from the camera's embedded JPEG" } else { "" };
    metadata.set(Directory::Image, tag::SOFTWARE, Value::Text(format!("Darkroot {VERSION}{source}")));
    let srgb = *space == PictureSpace::Rgb(darkroot_colour::RgbSpace::SRGB);
    let space = if srgb { SRGB } else { UNCALIBRATED };
    metadata.set(Directory::Exif, tag::COLOUR_SPACE, Value::Shorts(vec![space]));
    if let Some(dpi) = dpi {
        for tag in tag::RESOLUTION {
            metadata.set(Directory::Image, tag, Value::Rationals(vec![(dpi, 1)]));
        }
        metadata.set(Directory::Image, tag::RESOLUTION_UNIT, Value::Shorts(vec![INCH]));
    }
    metadata
}
