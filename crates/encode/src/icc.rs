//! ICC profiles of RGB spaces (ICC.1:2022, version 4.3 of the format).
//!
//! Three colorants, the white and one parametric curve say all there is to say about such a space, in some 500
//! bytes. They are written here and not by a library because the one at hand stamps them with the time of day.

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Matrix3, RgbSpace, TransferCurve, white};
use darkroot_photo::PictureSpace;

/// Matrix profile of a space, for "monitor" use: colorants adapted to D50 by Bradford, its adaptation matrix,
/// its transfer curve, and the name of the space. The same space gives the same bytes.
pub fn profile(space: &RgbSpace) -> Vec<u8> {
    let colorants = colorants(space);
    let adaptation = bradford(space.white.xyz(), white::D50);
    let curve = curve(space.curve);
    let description = text(&PictureSpace::Rgb(*space).name());
    let copyright = text("CC0");
    let white = xyz(D50);

    // The three channels share one curve: tags may point to the same bytes (7.3.1).
    let elements: [(&[&[u8; 4]], &[u8]); 8] = [
        (&[b"desc"], &description),
        (&[b"cprt"], &copyright),
        (&[b"wtpt"], &white),
        (&[b"chad"], &matrix(&adaptation)),
        (&[b"rXYZ"], &xyz(colorants[0])),
        (&[b"gXYZ"], &xyz(colorants[1])),
        (&[b"bXYZ"], &xyz(colorants[2])),
        (&[b"rTRC", b"gTRC", b"bTRC"], &curve),
    ];

    let tags: usize = elements.iter().map(|(names, _)| names.len()).sum();
    let mut table = be(tags as u32).to_vec();
    let mut contents = Vec::new();
    let start = HEADER + 4 + 12 * tags;
    for (names, element) in elements {
        for name in names {
            table.extend_from_slice(*name);
            table.extend(be((start + contents.len()) as u32));
            table.extend(be(element.len() as u32));
        }
        contents.extend_from_slice(element);
        contents.resize(contents.len().next_multiple_of(4), 0); // Every element starts at a multiple of 4.
    }

    let mut profile = header(start + contents.len());
    profile.append(&mut table);
    profile.append(&mut contents);
    profile
}

/// Bytes of the header (7.2).
const HEADER: usize = 128;

/// D50 of the connection space in the numbers of the file: 0.9642, 1, 0.8249 in 65536ths (7.2.16).
const D50: [i32; 3] = [0xf6d6, 0x1_0000, 0xd32d];

/// The header (7.2): a display profile from RGB to XYZ. The date is the same for ever.
fn header(size: usize) -> Vec<u8> {
    let mut header = Vec::with_capacity(HEADER);
    header.extend(be(size as u32));
    header.extend([0; 4]); // No preferred colour management module.
    header.extend([4, 0x30, 0, 0]); // Version 4.3.
    header.extend_from_slice(b"mntrRGB XYZ ");
    header.extend([2026_u16, 1, 1, 0, 0, 0].iter().flat_map(|part| part.to_be_bytes()));
    header.extend_from_slice(b"acsp");
    header.extend([0; 24]); // Platform, flags, device maker, device model, device attributes.
    header.extend(be(1)); // Rendering intent: relative colorimetric.
    header.extend(D50.iter().flat_map(|v| v.to_be_bytes()));
    header.resize(HEADER, 0); // Creator, profile ID, reserved.
    header
}

/// XYZ of red, green and blue under D50 in 65536ths, rounded so that they add up to D50 exactly: white is white.
fn colorants(space: &RgbSpace) -> [[i32; 3]; 3] {
    let to_xyz = space.to_xyz_under(white::D50);
    let [red, _, blue] = [0, 1, 2].map(|c| [0, 1, 2].map(|row| fixed(to_xyz[(row, c)])));
    // Green, as it is the largest where an eye would notice.
    let green = [0, 1, 2].map(|row| D50[row] - red[row] - blue[row]);
    [red, green, blue]
}

/// s15Fixed16Number (4.6), saturated.
fn fixed(value: f64) -> i32 {
    (value * 65536.0).round() as i32
}

fn be(value: u32) -> [u8; 4] {
    value.to_be_bytes()
}

/// An element: its type, four zeros, its numbers.
fn numbers(kind: &[u8; 4], values: impl IntoIterator<Item = i32>) -> Vec<u8> {
    let mut element = kind.to_vec();
    element.extend([0; 4]);
    element.extend(values.into_iter().flat_map(i32::to_be_bytes));
    element
}

/// XYZType (10.31).
fn xyz(values: [i32; 3]) -> Vec<u8> {
    numbers(b"XYZ ", values)
}

/// s15Fixed16ArrayType (10.22), row by row.
fn matrix(matrix: &Matrix3) -> Vec<u8> {
    numbers(b"sf32", matrix.transpose().iter().map(|&v| fixed(v)))
}

/// multiLocalizedUnicodeType (10.15), English.
fn text(text: &str) -> Vec<u8> {
    let utf16: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let mut element = numbers(b"mluc", [1, 12]);
    element.extend_from_slice(b"enUS");
    element.extend(be(utf16.len() as u32));
    element.extend(be(28));
    element.extend(utf16);
    element
}

/// The curve from encoded to linear values: curveType (10.6) for the straight line, else parametricCurveType
/// (10.18), function 0 for a plain power and function 3 for one with a linear foot:
/// Y = (aX + b)^g for X >= d, Y = cX below.
fn curve(curve: TransferCurve) -> Vec<u8> {
    let parametric = |function: i32, parameters: &[f64]| {
        // The function is 16 bits, then 16 bits are reserved.
        numbers(b"para", std::iter::once(function << 16).chain(parameters.iter().map(|&p| fixed(p))))
    };
    // The foot's slope and end are taken from the curve itself.
    let with_foot = |g: f64, a: f64, b: f64, foot: f64| {
        let slope = curve.decode(foot / 2.0) / (foot / 2.0);
        parametric(3, &[g, a, b, slope, foot])
    };
    match curve {
        TransferCurve::Linear => numbers(b"curv", [0]),
        TransferCurve::Gamma(gamma) => parametric(0, &[gamma]),
        TransferCurve::Srgb => with_foot(2.4, 1.0 / 1.055, 0.055 / 1.055, 0.040_45),
        TransferCurve::Romm => with_foot(1.8, 1.0, 0.0, 16.0 / 512.0),
        TransferCurve::Rec2020 => {
            let (alpha, beta) = (1.099_296_826_809_442, 0.018_053_968_510_807);
            with_foot(1.0 / 0.45, 1.0 / alpha, (alpha - 1.0) / alpha, 4.5 * beta)
        }
        TransferCurve::LStar => with_foot(3.0, 1.0 / 1.16, 0.16 / 1.16, 0.08),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::spaces;
    use darkroot_colour::Vector3;
    use moxcms::{ColorProfile, Layout, TransformOptions};

    fn parsed(space: &RgbSpace) -> ColorProfile {
        ColorProfile::new_from_slice(&profile(space)).unwrap()
    }

    /// Encoded values through the profile, as a colour management module computes them, in sRGB.
    fn in_srgb(space: &RgbSpace, encoded: &[f32]) -> Vec<f32> {
        let target = parsed(&RgbSpace::SRGB);
        let options = TransformOptions::default();
        let transform =
            parsed(space).create_transform_f32(Layout::Rgb, &target, Layout::Rgb, options).unwrap();
        let mut result = vec![0.0; encoded.len()];
        transform.transform(encoded, &mut result).unwrap();
        result
    }

    #[test]
    fn the_colorants_add_up_to_d50() {
        for space in spaces() {
            let colorants = colorants(&space);
            for row in 0..3 {
                assert_eq!(colorants.iter().map(|c| c[row]).sum::<i32>(), D50[row], "{}", space.name);
            }
        }
    }

    #[test]
    fn the_colorants_are_those_of_the_space() {
        for space in spaces() {
            let ours = space.to_xyz_under(white::D50);
            let theirs = parsed(&space).colorant_matrix();
            for row in 0..3 {
                for column in 0..3 {
                    assert!((ours[(row, column)] - theirs.v[row][column]).abs() < 4e-5, "{}", space.name);
                }
            }
        }
    }

    /// Colours in sRGB, 0..=1, and the same in `space`: from dark to light in each channel.
    fn samples(space: &RgbSpace) -> (Vec<f64>, Vec<f32>) {
        let from_srgb = space.from_xyz_under(white::D50) * RgbSpace::SRGB.to_xyz_under(white::D50);
        let (mut srgb, mut encoded) = (Vec::new(), Vec::new());
        for i in 0..512 {
            let colour = [i & 7, (i >> 3) & 7, i >> 6].map(|v| 0.04 + 0.92 * f64::from(v) / 7.0);
            let linear = from_srgb * Vector3::from(colour.map(|v| TransferCurve::Srgb.decode(v)));
            if linear.min() < 0.0 || linear.max() > 1.0 {
                continue; // sRGB has blues that eciRGB has not.
            }
            srgb.extend(colour);
            encoded.extend(linear.iter().map(|&v| space.curve.encode(v) as f32));
        }
        (srgb, encoded)
    }

    #[test]
    fn colours_through_the_numbers_of_the_profile_are_those_of_our_matrices() {
        let to_srgb = RgbSpace::SRGB.from_xyz_under(white::D50);
        for space in spaces() {
            let profile = parsed(&space);
            let colorants = profile.colorant_matrix().v;
            let to_xyz = Matrix3::from_fn(|row, column| colorants[row][column]);
            let curve = profile.red_trc.unwrap().make_linear_evaluator().unwrap();
            let (wanted, encoded) = samples(&space);
            for (wanted, encoded) in wanted.chunks(3).zip(encoded.chunks(3)) {
                let linear = Vector3::from_fn(|i, _| f64::from(curve.evaluate_value(encoded[i])));
                let srgb = (to_srgb * to_xyz * linear).map(|v| TransferCurve::Srgb.encode(v));
                let error = (srgb - Vector3::from_row_slice(wanted)).amax();
                assert!(error < 1e-3, "{} {:?}: {srgb} for {wanted:?}", space.name, space.curve);
            }
        }
    }

    #[test]
    fn colours_through_a_colour_management_module_are_those_of_our_matrices() {
        for space in spaces() {
            let (wanted, encoded) = samples(&space);
            for (got, wanted) in in_srgb(&space, &encoded).iter().zip(wanted) {
                // The module computes with 14 bits or so; the straight foot of sRGB's curve is the worst for that.
                let error =
                    (TransferCurve::Srgb.decode(f64::from(*got)) - TransferCurve::Srgb.decode(wanted)).abs();
                assert!(error < 1e-3, "{} {:?}: {got} for {wanted}", space.name, space.curve);
            }
        }
    }

    #[test]
    fn white_is_white_and_black_is_black() {
        for space in spaces() {
            let result = in_srgb(&space, &[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
            assert!(result[..3].iter().all(|v| (v - 1.0).abs() < 1e-4), "{} {result:?}", space.name);
            assert!(result[3..].iter().all(|v| v.abs() < 1e-4), "{} {result:?}", space.name);
        }
    }

    #[test]
    fn our_srgb_is_that_of_others() {
        let (ours, theirs) = (parsed(&RgbSpace::SRGB), ColorProfile::new_srgb());
        for (ours, theirs) in ours.colorant_matrix().v.iter().zip(theirs.colorant_matrix().v) {
            assert!(ours.iter().zip(theirs).all(|(a, b)| (a - b).abs() < 3e-4));
        }
    }

    #[test]
    fn a_curve_and_its_foot_meet() {
        for space in spaces() {
            let element = curve(space.curve);
            if element.len() == 32 {
                let number = |i: usize| {
                    let bytes = element[12 + 4 * i..16 + 4 * i].try_into().unwrap();
                    f64::from(i32::from_be_bytes(bytes)) / 65536.0
                };
                let [g, a, b, c, d] = [0, 1, 2, 3, 4].map(number);
                assert!(((a * d + b).powf(g) - c * d).abs() < 5e-5, "{}", space.name);
            }
        }
    }

    #[test]
    fn the_name_is_that_of_the_space() {
        for space in spaces() {
            let text = format!("{:?}", parsed(&space).description);
            assert!(text.contains(&PictureSpace::Rgb(space).name()), "{text}");
        }
    }

    #[test]
    fn a_profile_is_small_and_its_size_and_elements_are_in_place() {
        for space in spaces() {
            let profile = profile(&space);
            let number = |at: usize| u32::from_be_bytes(profile[at..at + 4].try_into().unwrap()) as usize;
            assert!(profile.len() < 600 && number(0) == profile.len());
            for tag in 0..number(128) {
                let (offset, size) = (number(136 + 12 * tag), number(140 + 12 * tag));
                assert!(offset % 4 == 0 && offset + size <= profile.len());
            }
        }
    }
}
