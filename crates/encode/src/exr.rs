//! OpenEXR: three channels of 32-bit floats, PIZ (lossless wavelets), with the chromaticities of the space.
//!
//! Exif has no place in it. What OpenEXR has attributes for is written: owner, date, exposure time, aperture,
//! ISO speed and software; camera and lens stand in the comments.

use darkroot_photo::metadata::{Directory, tag};
use darkroot_photo::{Metadata, PictureSpace, Samples};
use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    Blocks, Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels, Text, Vec2,
    WritableImage,
};

use crate::format::Frame;
use crate::output::Buffered;
use crate::{Error, Format};

pub(crate) fn write(frame: &Frame<'_>, metadata: &Metadata, out: &mut Buffered<'_, '_>) -> Result<(), Error> {
    let samples: &[f32] = match frame.samples {
        Samples::F32(v) => v,
        // OpenEXR is written with no other samples, and Frame::of lets none through.
        Samples::U8(_) | Samples::U16(_) => &[],
    };
    let row = frame.row();
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
        let start = at.y() * row + 3 * at.x();
        match samples.get(start..start + 3) {
            Some(&[r, g, b]) => (r, g, b),
            _ => (0.0, 0.0, 0.0),
        }
    });
    let encoding = Encoding {
        compression: Compression::PIZ,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (frame.width as usize, frame.height as usize);
    let mut image = Image::from_layer(Layer::new(size, attributes(frame, metadata), encoding, channels));
    image.attributes.chromaticities = chromaticities(frame.space);
    image.write().to_buffered(out).map_err(|e| Error::encoder(Format::Exr)(e.into()))
}

/// The space; camera RGB has no chromaticities.
fn chromaticities(space: &PictureSpace) -> Option<Chromaticities> {
    let PictureSpace::Rgb(space) = space else { return None };
    let xy = |p: darkroot_colour::Xy| Vec2(p.x as f32, p.y as f32);
    let [red, green, blue] = space.primaries.map(xy);
    Some(Chromaticities { red, green, blue, white: xy(space.white) })
}

fn attributes(frame: &Frame<'_>, metadata: &Metadata) -> LayerAttributes {
    let text = |directory, tag| metadata.text(directory, tag).map(utf8);
    let number = |tag| metadata.number(Directory::Exif, tag).map(|v| v as f32);
    LayerAttributes {
        owner: text(Directory::Image, tag::COPYRIGHT).or_else(|| text(Directory::Image, tag::ARTIST)),
        software_name: text(Directory::Image, tag::SOFTWARE),
        capture_date: text(Directory::Exif, tag::DATE_TIME_ORIGINAL),
        exposure: number(tag::EXPOSURE_TIME),
        aperture: number(tag::F_NUMBER),
        iso_speed: number(tag::ISO),
        comments: Some(utf8(&comments(frame.space, metadata))),
        ..LayerAttributes::default()
    }
}

/// What the numbers are, which camera, which lens, who: "sRGB, linear; NIKON D700; AF 50mm f/1.8".
fn comments(space: &PictureSpace, metadata: &Metadata) -> String {
    let mut parts = vec![space.name()];
    let make = metadata.text(Directory::Image, tag::MAKE).unwrap_or_default();
    let model = metadata.text(Directory::Image, tag::MODEL).unwrap_or_default();
    // Some makers repeat their name in the model.
    let camera = if model.starts_with(make) { model.to_owned() } else { format!("{make} {model}") };
    parts.push(camera.trim().to_owned());
    for (directory, tag) in [(Directory::Exif, tag::LENS_MODEL), (Directory::Image, tag::ARTIST)] {
        parts.extend(metadata.text(directory, tag).map(str::to_owned));
    }
    parts.retain(|part| !part.is_empty());
    parts.join("; ")
}

/// Text as other programs read it, in UTF-8.
fn utf8(text: &str) -> Text {
    Text::from_bytes_unchecked(text.bytes().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_lossless, encoded, metadata, picture};
    use darkroot_colour::RgbSpace;
    use exr::meta::MetaData;

    const LINEAR: PictureSpace =
        PictureSpace::Rgb(RgbSpace { curve: darkroot_colour::TransferCurve::Linear, ..RgbSpace::REC2020 });

    #[test]
    fn the_samples_come_back() {
        assert_lossless(Format::Exr, 32, LINEAR);
        assert_lossless(Format::Exr, 32, PictureSpace::Camera);
    }

    #[test]
    fn samples_beyond_0_and_1_come_back() {
        let mut extreme = picture(64, 40, 32, LINEAR);
        if let Samples::F32(samples) = &mut extreme.samples {
            for (i, sample) in samples.iter_mut().enumerate() {
                *sample = (*sample - 0.5) * 2_f32.powi(i as i32 % 40 - 20);
            }
        }
        let file = encoded(&extreme, Format::Exr, &metadata()).unwrap();
        assert!(crate::testing::decoded(Format::Exr, &file).1 == extreme.samples);
    }

    fn read(space: PictureSpace) -> exr::meta::header::Header {
        let file = encoded(&picture(3, 2, 32, space), Format::Exr, &metadata()).unwrap();
        MetaData::read_from_buffered(&file[..], true).unwrap().headers.remove(0)
    }

    #[test]
    fn the_chromaticities_are_those_of_the_space() {
        let found = read(LINEAR).shared_attributes.chromaticities.unwrap();
        for (found, wanted) in
            [(found.green, RgbSpace::REC2020.primaries[1]), (found.white, RgbSpace::REC2020.white)]
        {
            assert!((f64::from(found.x()) - wanted.x).abs() < 1e-6);
            assert!((f64::from(found.y()) - wanted.y).abs() < 1e-6);
        }
        assert_eq!(read(PictureSpace::Camera).shared_attributes.chromaticities, None);
    }

    #[test]
    fn the_fields_of_the_shot_that_openexr_knows_come_back() {
        let found = read(LINEAR).own_attributes;
        let text = |text: Option<Text>| String::from_utf8(text.unwrap().as_slice().to_vec()).unwrap();
        assert_eq!(text(found.owner), "Zoë Müller, 2024");
        assert_eq!(text(found.capture_date), "2024:05:06 07:08:09");
        assert!((found.exposure.unwrap() - 0.004).abs() < 1e-9);
        assert!((found.aperture.unwrap() - 2.8).abs() < 1e-6);
        assert!((found.iso_speed.unwrap() - 400.0).abs() < 1e-6);
        assert_eq!(
            text(found.comments),
            "Rec. 2020, linear; NIKON CORPORATION NIKON D700; AF Nikkor 50mm f/1.8D; Zoë Müller"
        );
    }
}
