use super::*;
use crate::testing::{assert_lossless, encoded, picture, spaces};
use darkroot_photo::{Picture, Size};

const SRGB: PictureSpace = PictureSpace::Rgb(RgbSpace::SRGB);

#[test]
fn samples_of_8_bits_come_back() {
    assert_lossless(Format::Jxl, 8, SRGB);
}

#[test]
fn samples_of_16_bits_come_back() {
    assert_lossless(Format::Jxl, 16, SRGB);
}

#[test]
fn samples_come_back_in_every_space() {
    for space in spaces().into_iter().map(PictureSpace::Rgb) {
        if Format::Jxl.accepts(&space).is_ok() {
            for bits in [8, 16] {
                let picture = picture(31, 9, bits, space);
                let file = encoded(&picture, Format::Jxl, &Metadata::default()).unwrap();
                let (_, samples) = crate::testing::decoded(Format::Jxl, &file);
                assert!(samples == picture.samples, "{}", space.name());
            }
        }
    }
}

/// Noise of every bit, as no filter foretells it.
fn noise(size: Size) -> Picture {
    let mut state = 1_u32;
    let samples = (0..3 * size.area()).map(|_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 16) as u16
    });
    Picture { size, samples: Samples::U16(samples.collect()), space: SRGB }
}

#[test]
fn noise_comes_back() {
    for (width, height) in [(100, 100), (256, 256), (300, 280)] {
        let picture = noise(Size { width, height });
        let file = encoded(&picture, Format::Jxl, &Metadata::default()).unwrap();
        assert!(crate::testing::decoded(Format::Jxl, &file).1 == picture.samples);
    }
}

#[test]
fn a_picture_that_the_library_has_no_room_for_is_an_error_and_no_panic() {
    let size = Size { width: 512, height: 256 };
    let pixel = |i: usize| if (i + i / size.width).is_multiple_of(2) { [65535, 0, 0] } else { [0, 0, 65535] };
    let samples = Samples::U16((0..size.area()).flat_map(pixel).collect());
    let picture = Picture { size, samples, space: SRGB };
    match encoded(&picture, Format::Jxl, &Metadata::default()) {
        Ok(file) => assert!(crate::testing::decoded(Format::Jxl, &file).1 == picture.samples),
        Err(error) => assert!(matches!(error, Error::Encoder { .. })),
    }
}

#[test]
fn the_profile_that_a_reader_makes_of_the_header_is_that_of_the_space() {
    for space in spaces() {
        let picture = picture(4, 4, 16, PictureSpace::Rgb(space));
        let Ok(file) = encoded(&picture, Format::Jxl, &Metadata::default()) else { continue };
        let image = jxl_oxide::JxlImage::builder().read(&file[..]).unwrap();
        let read = moxcms::ColorProfile::new_from_slice(&image.rendered_icc()).unwrap();
        let wanted = space.to_xyz_under(white::D50);
        let found = read.colorant_matrix();
        for (row, column) in (0..9).map(|i| (i / 3, i % 3)) {
            let error = (wanted[(row, column)] - found.v[row][column]).abs();
            assert!(error < 2e-3, "{} {row} {column}: {error}", space.name);
        }
        let curve = read.red_trc.unwrap().make_linear_evaluator().unwrap();
        for encoded in [0.02, 0.1, 0.5, 0.9] {
            let error = space.curve.decode(encoded) - f64::from(curve.evaluate_value(encoded as f32));
            assert!(error.abs() < 1e-3, "{} at {encoded}: {error}", space.name);
        }
    }
}
