//! What profiles of version 2 (ICC.1:2001-04) have otherwise: lut16Type, its codes of CIELAB, and texts in ASCII.

use darkroot_colour::{Lab, TransferCurve};

use super::{Curves, Icc, Version, long};
use crate::export::grid::Grid;

/// Entries of the curve of each channel: linear between them, it is within 0.0005 L\* of the curve of lightness.
const ENTRIES: usize = 4096;

/// Bytes before the curves.
const CURVES: usize = 52;

/// CIELAB as 16-bit codes of version 2 (6.3.4.2, "legacy" in version 4): 100 and 127 are 0xFF00.
pub(super) fn encode(lab: Lab) -> [f64; 3] {
    [lab.l * 652.8, (lab.a + 128.0) * 256.0, (lab.b + 128.0) * 256.0].map(|v| v.clamp(0.0, 65535.0))
}

/// CIELAB of codes.
pub(super) fn decode([l, a, b]: [f64; 3]) -> Lab {
    Lab { l: l / 652.8, a: a / 256.0 - 128.0, b: b / 256.0 - 128.0 }
}

/// lut16Type (6.5.7): no matrix, the curve of lightness for each channel, the table, straight lines.
pub(super) fn element(table: &Grid) -> Vec<u8> {
    let mut element = b"mft2\0\0\0\0\x03\x03".to_vec();
    element.extend([table.size() as u8, 0]);
    for i in 0..9 {
        element.extend(if i % 4 == 0 { 0x1_0000_u32 } else { 0 }.to_be_bytes());
    }
    element.extend([ENTRIES as u16, 2].iter().flat_map(|n| n.to_be_bytes()));
    let code = |v: f64| ((v * 65535.0).round() as u16).to_be_bytes();
    let entry = |i: usize| code(TransferCurve::LStar.encode(i as f64 / (ENTRIES - 1) as f64));
    let curve: Vec<u8> = (0..ENTRIES).flat_map(entry).collect();
    element.extend(curve.repeat(3));
    element.extend(table.nodes().iter().flatten().flat_map(|&v| (v.round() as u16).to_be_bytes()));
    element.extend([code(0.0), code(1.0)].concat().repeat(3));
    element
}

/// A table of this type, with straight lines after it.
pub(super) fn read(element: &[u8]) -> Option<Icc> {
    if element.get(..10)? != b"mft2\0\0\0\0\x03\x03" {
        return None;
    }
    let identity = (0..9).all(|i| long(element, 12 + 4 * i) == Some(if i % 4 == 0 { 0x1_0000 } else { 0 }));
    let size = usize::from(*element.get(10)?);
    let counts = long(element, 48)?;
    let (entries, after) = (counts >> 16, counts & 0xffff);
    let codes = |from: usize, count: usize| {
        let bytes = element.get(from..from.checked_add(2 * count)?)?.chunks_exact(2);
        Some(bytes.map(|c| f64::from(u16::from_be_bytes([c[0], c[1]]))).collect::<Vec<f64>>())
    };
    let inputs = codes(CURVES, 3 * entries)?;
    let nodes = codes(CURVES + 6 * entries, 3 * size.pow(3))?;
    let lines = codes(CURVES + 6 * entries + 6 * size.pow(3), 3 * after)?;
    if !identity || entries < 2 || after != 2 || lines != [0.0, 65535.0].repeat(3) {
        return None;
    }
    let mut curves = inputs.chunks_exact(entries).map(|c| c.iter().map(|v| v / 65535.0).collect());
    let curves = Curves::Sampled([curves.next()?, curves.next()?, curves.next()?]);
    let nodes = nodes.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    Some(Icc { curves, table: Grid::new(size, nodes)?, version: Version::Two })
}

/// textDescriptionType (6.5.17), for people.
pub(super) fn description(text: &str) -> Vec<u8> {
    let ascii = ascii(text);
    let mut element = b"desc\0\0\0\0".to_vec();
    element.extend((ascii.len() as u32).to_be_bytes());
    element.extend(ascii);
    element.extend([0; 4 + 4 + 2 + 1 + 67]); // No Unicode, no Macintosh text.
    element
}

/// textType (6.5.18).
pub(super) fn text(text: &str) -> Vec<u8> {
    [b"text\0\0\0\0".to_vec(), ascii(text)].concat()
}

fn ascii(text: &str) -> Vec<u8> {
    text.chars().map(|c| if c.is_ascii() { c as u8 } else { b'?' }).chain([0]).collect()
}
