//! A DCP to bytes: one directory as in TIFF, behind the magic number "RC".

use darkroot_colour::Matrix3;

use super::Dcp;

/// Tags of DNG 1.7.1, for the first and the second light.
pub(super) mod tag {
    pub(in super::super) const CAMERA: u16 = 50708;
    pub(in super::super) const COLOR_MATRIX: [u16; 2] = [50721, 50722];
    pub(in super::super) const ILLUMINANT: [u16; 2] = [50778, 50779];
    pub(in super::super) const NAME: u16 = 50936;
    pub(in super::super) const MAP_DIMENSIONS: u16 = 50937;
    pub(in super::super) const MAP: [u16; 2] = [50938, 50939];
    pub(in super::super) const TONE_CURVE: u16 = 50940;
    pub(in super::super) const EMBED_POLICY: u16 = 50941;
    pub(in super::super) const COPYRIGHT: u16 = 50942;
    pub(in super::super) const FORWARD_MATRIX: [u16; 2] = [50964, 50965];
    pub(in super::super) const LOOK_DIMENSIONS: u16 = 50981;
    pub(in super::super) const LOOK: u16 = 50982;
    pub(in super::super) const MAP_ENCODING: u16 = 51107;
    pub(in super::super) const LOOK_ENCODING: u16 = 51108;
    pub(in super::super) const BLACK_RENDER: u16 = 51110;
    pub(in super::super) const EXPOSURE_OFFSET: u16 = 51109;
    pub(in super::super) const THIRD_LIGHT: u16 = 52529;
}

/// Types of TIFF 6.0, section 2.
pub(super) mod kind {
    pub(in super::super) const BYTE: u16 = 1;
    pub(in super::super) const ASCII: u16 = 2;
    pub(in super::super) const SHORT: u16 = 3;
    pub(in super::super) const LONG: u16 = 4;
    pub(in super::super) const SIGNED_RATIONAL: u16 = 10;
    pub(in super::super) const FLOAT: u16 = 11;
}

/// Denominator of the fractions that are written.
const UNIT: f64 = 1e6;

/// The matrix as the fractions of the file have it.
pub(super) fn rounded(matrix: &Matrix3) -> Matrix3 {
    matrix.map(|v| (v * UNIT).round() / UNIT)
}

struct Entry {
    tag: u16,
    kind: u16,
    count: usize,
    bytes: Vec<u8>,
}

/// The file of a DCP.
pub(super) fn write(dcp: &Dcp) -> Vec<u8> {
    let text = |tag, text: &str| {
        // An end mark would end the text.
        let bytes = [text.replace('\0', "").as_bytes(), b"\0"].concat();
        Entry { tag, kind: kind::ASCII, count: bytes.len(), bytes }
    };
    let longs = |tag, values: &[usize]| Entry {
        tag,
        kind: kind::LONG,
        count: values.len(),
        bytes: values.iter().flat_map(|v| (*v as u32).to_le_bytes()).collect(),
    };
    let matrix = |tag, matrix: &Matrix3| {
        let fraction = |v: &f64| [(v * UNIT).round() as i32, UNIT as i32].map(i32::to_le_bytes).concat();
        let bytes = matrix.transpose().iter().flat_map(fraction).collect();
        Entry { tag, kind: kind::SIGNED_RATIONAL, count: 9, bytes }
    };
    let mut entries = vec![
        text(tag::CAMERA, &dcp.camera),
        text(tag::NAME, &dcp.name),
        longs(tag::EMBED_POLICY, &[3]), // No restrictions.
        text(tag::COPYRIGHT, "No copyright, use freely"),
        longs(tag::MAP_ENCODING, &[0]), // Linear.
        longs(tag::BLACK_RENDER, &[1]), // None.
    ];
    for (i, light) in dcp.lights.iter().take(2).enumerate() {
        let [hues, saturations] = light.map.dimensions();
        if i == 0 {
            entries.push(longs(tag::MAP_DIMENSIONS, &[hues, saturations, 1]));
        }
        let nodes = light.map.nodes().iter().flatten();
        let illuminant = light.illuminant.to_le_bytes().to_vec();
        entries.extend([
            matrix(tag::COLOR_MATRIX[i], &light.color_matrix),
            matrix(tag::FORWARD_MATRIX[i], &light.forward_matrix),
            Entry { tag: tag::ILLUMINANT[i], kind: kind::SHORT, count: 1, bytes: illuminant },
            Entry {
                tag: tag::MAP[i],
                kind: kind::FLOAT,
                count: 3 * hues * saturations,
                bytes: nodes.flat_map(|v| (*v as f32).to_le_bytes()).collect(),
            },
        ]);
    }
    directory(&mut entries)
}

/// Header, directory and the values that do not fit into it.
fn directory(entries: &mut [Entry]) -> Vec<u8> {
    entries.sort_by_key(|e| e.tag);
    let start = 8 + 2 + 12 * entries.len() + 4;
    let mut head = b"IIRC\x08\0\0\0".to_vec();
    head.extend((entries.len() as u16).to_le_bytes());
    let mut values: Vec<u8> = Vec::new();
    for Entry { tag, kind, count, bytes } in entries {
        head.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
        head.extend((*count as u32).to_le_bytes());
        if bytes.len() <= 4 {
            bytes.resize(4, 0);
            head.extend_from_slice(bytes);
        } else {
            head.extend(((start + values.len()) as u32).to_le_bytes());
            values.extend_from_slice(bytes);
            values.resize(values.len().next_multiple_of(2), 0);
        }
    }
    head.extend([0; 4]); // No further directory.
    [head, values].concat()
}
