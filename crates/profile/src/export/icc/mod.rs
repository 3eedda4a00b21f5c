//! ICC input profile of a camera (ICC.1:2022, version 4.3 of the format, or version 2.4 for programs that know no later
//! one): a table over camera RGB to CIELAB.
//!
//! What goes in is balanced, linear camera RGB, 0..=1, as `darkroot develop --space camera` writes it; what lies
//! beyond is cut. The three channels pass the curve of CIE lightness, so the nodes of the table stand at equal steps
//! of L\*, the white of the light and all greys are exact, and what is read between the nodes is nearly linear.

mod lut16;

use darkroot_colour::adaptation::bradford;
use darkroot_colour::{Lab, TransferCurve, Xyz, white};

use super::grid::Grid;
use super::{Error, IccFault};
use crate::{Calibration, Profile};

/// Nodes along each side that serve well.
pub const SIZE: usize = 33;

/// Bytes of the header (7.2).
const HEADER: usize = 128;

/// Greatest code of 16 bits.
const FULL: f64 = 65535.0;

/// Version of the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Version {
    /// 2.4, for older programs.
    Two,
    /// 4.3.
    #[default]
    Four,
}

/// The profile for one light, with a table of `size`^3 nodes. The same model gives the same bytes.
pub fn write(profile: &Profile, calibration: &Calibration, size: usize, version: Version) -> Vec<u8> {
    let light = &calibration.light;
    let name = format!("{} under {}, balanced linear RGB", profile.camera().name(), light.name);
    let encode = match version {
        Version::Two => lut16::encode,
        Version::Four => encode,
    };
    let table = Grid::sample(size, |coded| {
        let linear = coded.map(|v| TransferCurve::LStar.decode(v));
        encode(calibration.model.xyz(linear).lab(white::D50))
    });
    let white_point = fixed_numbers(b"XYZ ", [white::D50.x, white::D50.y, white::D50.z]);
    let free = "No copyright, use freely";
    let elements: Vec<(&[u8; 4], Vec<u8>)> = match version {
        Version::Two => vec![
            (b"desc", lut16::description(&name)),
            (b"cprt", lut16::text(free)),
            (b"wtpt", white_point),
            (b"A2B0", lut16::element(&table)),
        ],
        Version::Four => {
            let adaptation = bradford(light.xy.xyz(), white::D50);
            vec![
                (b"desc", text(&name)),
                (b"cprt", text(free)),
                (b"wtpt", white_point),
                (b"chad", fixed_numbers(b"sf32", adaptation.transpose().iter().copied())),
                (b"A2B0", table_element(&table)),
            ]
        }
    };
    let start = HEADER + 4 + 12 * elements.len();
    let mut directory = (elements.len() as u32).to_be_bytes().to_vec();
    let mut contents = Vec::new();
    for (name, element) in &elements {
        directory.extend_from_slice(*name);
        directory.extend(((start + contents.len()) as u32).to_be_bytes());
        directory.extend((element.len() as u32).to_be_bytes());
        contents.extend_from_slice(element);
        contents.resize(contents.len().next_multiple_of(4), 0);
    }
    [header(start + contents.len(), version), directory, contents].concat()
}

/// The header (7.2): an input device's RGB to CIELAB. The date is the same for ever.
fn header(size: usize, version: Version) -> Vec<u8> {
    let mut header = (size as u32).to_be_bytes().to_vec();
    header.extend([0; 4]);
    header.extend(match version {
        Version::Two => [2, 0x40, 0, 0],
        Version::Four => [4, 0x30, 0, 0],
    });
    header.extend_from_slice(b"scnrRGB Lab ");
    header.extend([2026_u16, 1, 1, 0, 0, 0].iter().flat_map(|part| part.to_be_bytes()));
    header.extend_from_slice(b"acsp");
    header.extend([0; 24]); // Platform, flags, maker, model, attributes.
    header.extend(1_u32.to_be_bytes()); // Relative colorimetric.
    header.extend([0xf6d6_i32, 0x1_0000, 0xd32d].iter().flat_map(|v| v.to_be_bytes()));
    header.resize(HEADER, 0);
    header
}

/// lutAToBType (10.12): the curve of lightness for each channel, the table, three straight lines.
fn table_element(table: &Grid) -> Vec<u8> {
    let straight = [b"curv".as_slice(), &[0; 8]].concat().repeat(3);
    // parametricCurveType, function 4 (10.18): Y = (aX + b)^g + e for X >= d, cX + f below; g a b c d e f.
    let (kappa, foot) = (24389.0 / 27.0 / 100.0, 216.0 / 24389.0);
    let mut lightness = fixed_numbers(b"para", [1.0 / 3.0, 1.16_f64.powi(3), 0.0, kappa, foot, -0.16, 0.0]);
    lightness.splice(8..8, [0, 4, 0, 0]);
    let curves = lightness.repeat(3);
    const START: usize = 32;
    let (table_at, size) = (START + straight.len(), table.size() as u8);
    let mut clut = vec![size; 3];
    clut.resize(16, 0);
    clut.extend([2, 0, 0, 0]); // Two bytes a value.
    clut.extend(table.nodes().iter().flatten().flat_map(|&v| (v.round() as u16).to_be_bytes()));
    clut.resize(clut.len().next_multiple_of(4), 0);
    let mut element = b"mAB \0\0\0\0\x03\x03\0\0".to_vec();
    // Offsets of the last curves, matrix, middle curves (neither is there), table, first curves.
    for offset in [START, 0, 0, table_at, table_at + clut.len()] {
        element.extend((offset as u32).to_be_bytes());
    }
    [element, straight, clut, curves].concat()
}

/// CIELAB as 16-bit codes of version 4 (6.3.4.2): L\* 0..=100, a\* and b\* -128..=127; what lies beyond is cut.
fn encode(lab: Lab) -> [f64; 3] {
    [lab.l * FULL / 100.0, (lab.a + 128.0) * 257.0, (lab.b + 128.0) * 257.0].map(|v| v.clamp(0.0, FULL))
}

/// CIELAB of codes of version 4.
fn decode([l, a, b]: [f64; 3]) -> Lab {
    Lab { l: l * 100.0 / FULL, a: a / 257.0 - 128.0, b: b / 257.0 - 128.0 }
}

/// An element of s15Fixed16Numbers (4.6).
fn fixed_numbers(kind: &[u8; 4], values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    let mut element = kind.to_vec();
    element.extend([0; 4]);
    element.extend(values.into_iter().flat_map(|v| ((v * 65536.0).round() as i32).to_be_bytes()));
    element
}

/// multiLocalizedUnicodeType (10.15), English.
fn text(text: &str) -> Vec<u8> {
    let utf16: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let mut element = b"mluc\0\0\0\0\0\0\0\x01\0\0\0\x0cenUS".to_vec();
    element.extend((utf16.len() as u32).to_be_bytes());
    element.extend(28_u32.to_be_bytes());
    element.extend(utf16);
    element
}

/// What an input profile of [`write()`]'s kinds says: curves and a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Icc {
    curves: Curves,
    table: Grid,
    /// Whose codes the table has.
    version: Version,
}

/// The curve of each channel, 0..=1 to 0..=1.
#[derive(Debug, Clone, PartialEq)]
enum Curves {
    /// g a b c d e f of parametricCurveType, function 4.
    Parametric([[f64; 7]; 3]),
    /// Values at equal steps, linear between them; at least two.
    Sampled([Vec<f64>; 3]),
}

impl Curves {
    fn apply(&self, rgb: [f64; 3]) -> [f64; 3] {
        let x = rgb.map(|v| v.clamp(0.0, 1.0));
        match self {
            Self::Parametric(curves) => [0, 1, 2].map(|i| {
                let ([g, a, b, c, d, e, f], x) = (curves[i], x[i]);
                if x >= d { (a * x + b).max(0.0).powf(g) + e } else { c * x + f }
            }),
            Self::Sampled(curves) => [0, 1, 2].map(|i| {
                let at = x[i] * (curves[i].len() - 1) as f64;
                let first = (at as usize).min(curves[i].len() - 2);
                curves[i][first] + (at - first as f64) * (curves[i][first + 1] - curves[i][first])
            }),
        }
    }
}

impl Icc {
    /// Reads a profile of an RGB device with a table (A2B0) to CIELAB behind curves, of version 2 or 4.
    ///
    /// # Errors
    /// Bytes that are nothing of the sort.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        if bytes.get(16..24) != Some(b"RGB Lab ".as_slice()) || bytes.get(36..40) != Some(b"acsp".as_slice())
        {
            return Err(IccFault::Spaces.into());
        }
        Self::table(bytes).ok_or(IccFault::NoTable.into())
    }

    fn table(bytes: &[u8]) -> Option<Self> {
        const MOST_TAGS: usize = 100;
        let tags = long(bytes, HEADER)?.min(MOST_TAGS);
        let entry =
            (0..tags).map(|i| HEADER + 4 + 12 * i).find(|&at| bytes.get(at..at + 4) == Some(b"A2B0"))?;
        let (from, length) = (long(bytes, entry + 4)?, long(bytes, entry + 8)?);
        let element = bytes.get(from..from.checked_add(length)?)?;
        if element.starts_with(b"mft2") {
            return lut16::read(element);
        }
        if element.get(..10)? != b"mAB \0\0\0\0\x03\x03" || long(element, 16)? != 0 || long(element, 20)? != 0
        {
            return None;
        }
        let clut = element.get(long(element, 24)?..)?;
        let size = usize::from(*clut.first()?);
        if clut.get(..3)? != [size as u8; 3] || *clut.get(16)? != 2 {
            return None;
        }
        let codes = clut.get(20..20 + 6 * size.pow(3))?.chunks_exact(2);
        let codes: Vec<f64> = codes.map(|c| f64::from(u16::from_be_bytes([c[0], c[1]]))).collect();
        let nodes = codes.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let first = element.get(long(element, 28)?..)?;
        let mut curves = [[0.0; 7]; 3];
        for (channel, curve) in curves.iter_mut().enumerate() {
            let curve_bytes = first.get(40 * channel..40 * (channel + 1))?;
            if curve_bytes.get(..10)? != b"para\0\0\0\0\0\x04" {
                return None;
            }
            for (i, parameter) in curve.iter_mut().enumerate() {
                *parameter = f64::from(long(curve_bytes, 12 + 4 * i)? as i32) / 65536.0;
            }
        }
        Some(Self {
            curves: Curves::Parametric(curves),
            table: Grid::new(size, nodes)?,
            version: Version::Four,
        })
    }

    /// XYZ relative to D50 of device RGB, 0..=1.
    pub fn xyz(&self, rgb: [f64; 3]) -> Xyz {
        let codes = self.table.at(self.curves.apply(rgb));
        let lab = match self.version {
            Version::Two => lut16::decode(codes),
            Version::Four => decode(codes),
        };
        lab.xyz(white::D50)
    }
}

/// A number of four bytes.
fn long(bytes: &[u8], at: usize) -> Option<usize> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_be_bytes(four.try_into().ok()?) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::deviation;
    use crate::export::tests::{calibration, models, profile};

    const BOTH: [Version; 2] = [Version::Two, Version::Four];

    fn written(model: crate::Model, version: Version) -> Vec<u8> {
        let calibration = calibration(model);
        write(&profile(vec![calibration.clone()]), &calibration, SIZE, version)
    }

    #[test]
    fn what_is_read_back_is_the_model() {
        for (model, version) in models().into_iter().flat_map(|m| BOTH.map(|v| (m.clone(), v))) {
            let read = Icc::read(&written(model.clone(), version)).unwrap();
            let found = deviation(&calibration(model), |rgb| read.xyz(rgb)).de2000;
            assert!(found.mean < 0.1 && found.max < 2.0, "{version:?}: {found:?}");
        }
    }

    #[test]
    fn greys_are_exact_to_the_bits_of_the_file() {
        for version in BOTH {
            let read = Icc::read(&written(models().remove(1), version)).unwrap();
            for grey in [1.0, 0.5, 0.18, 0.01, 0.001, 0.0] {
                let lab = read.xyz([grey; 3]).lab(white::D50);
                let wanted = white::D50.scaled(grey).lab(white::D50);
                assert!((lab.l - wanted.l).abs() < 0.002 && lab.chroma() < 0.003, "{grey}: {lab:?}");
            }
        }
    }

    #[test]
    fn sizes_and_places_are_those_of_the_format() {
        for (version, major) in BOTH.into_iter().zip([2, 4]) {
            let bytes = written(models().remove(0), version);
            assert_eq!((long(&bytes, 0), bytes[8]), (Some(bytes.len()), major));
            for tag in 0..long(&bytes, 128).unwrap() {
                let (at, size) =
                    (long(&bytes, 136 + 12 * tag).unwrap(), long(&bytes, 140 + 12 * tag).unwrap());
                assert!(at % 4 == 0 && at + size <= bytes.len());
            }
        }
    }

    #[test]
    fn broken_profiles_are_errors() {
        for version in BOTH {
            let good = written(models().remove(0), version);
            for length in [0, 20, 127, 130, 200, 340, 1000, good.len() - 5] {
                assert!(Icc::read(&good[..length]).is_err(), "{version:?} {length}");
            }
            for at in (0..700).chain(good.len() - 130..good.len()) {
                let mut broken = good.clone();
                broken[at] ^= 0xff;
                if let Ok(read) = Icc::read(&broken) {
                    let _ = read.xyz([0.1, 0.5, 0.9]);
                }
            }
        }
    }
}
