//! Local tone maps of DNG files: ProfileGainTableMap (DNG 1.6) and ProfileGainTableMap2 (1.7), as Adobe's specification 1.7.1 has
//! them.

use darkroot_photo::LocalToneMap;

use crate::tiff::Directories;

const MAP: u16 = 0xcd2d;
const MAP2: u16 = 0xcd40;
/// Bytes before the gains of each.
const HEAD: usize = 64;
const HEAD2: usize = 80;
/// No real one is larger: Apple's have some 100 KiB.
const MAX_BYTES: usize = 16 << 20;

/// The local tone map of a file, the second kind before the first; `None` where there is none. One that breaks the
/// specification is left out, with a note.
pub(crate) fn read(tiff: &Directories<'_>, notes: &mut Vec<String>) -> Option<LocalToneMap> {
    for (tag, name, head) in [(MAP2, "ProfileGainTableMap2", HEAD2), (MAP, "ProfileGainTableMap", HEAD)] {
        let Some(entry) = tiff.all.iter().flat_map(|d| &d.entries).find(|e| e.tag == tag) else { continue };
        let found = tiff.value(entry, MAX_BYTES).and_then(|bytes| parse(tiff, bytes, head));
        if found.is_none() {
            notes.push(format!("the file's local tone map ({name}) is damaged and is not applied"));
        }
        return found;
    }
    None
}

/// The map in the bytes of a tag whose numbers are in the byte order of the file.
fn parse(tiff: &Directories<'_>, bytes: &[u8], head: usize) -> Option<LocalToneMap> {
    let (start, stored) = bytes.split_at_checked(head)?;
    let words = tiff.longs(start);
    let float = |i: usize| f32::from_bits(words[i]);
    let double = |i: usize| {
        let (low, high) = if tiff.is_little_endian() { (i, i + 1) } else { (i + 1, i) };
        f64::from_bits(u64::from(words[low]) | u64::from(words[high]) << 32)
    };
    let (kind, gamma, range) =
        if head == HEAD2 { (words[16], float(17), [float(18), float(19)]) } else { (3, 1.0, [0.0, 1.0]) };
    let coded = |code: f32| range[0] + code * (range[1] - range[0]);
    let gains: Vec<f32> = match kind {
        0 => stored.iter().map(|&v| coded(f32::from(v) / 255.0)).collect(),
        1 => tiff.shorts(stored).into_iter().map(|v| coded(f32::from(v) / 65535.0)).collect(),
        2 => tiff.shorts(stored).into_iter().map(half).collect(),
        3 => tiff.longs(stored).into_iter().map(f32::from_bits).collect(),
        _ => return None,
    };
    let map = LocalToneMap {
        points: [words[0] as usize, words[1] as usize],
        spacing: [double(2), double(4)],
        origin: [double(6), double(8)],
        entries: words[10] as usize,
        weights: [11, 12, 13, 14, 15].map(float),
        gamma,
        gains,
    };
    map.is_sound().then_some(map)
}

/// The value of a floating-point number of 16 bits (IEEE 754).
fn half(bits: u16) -> f32 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f32::from(bits & 0x3ff) / 1024.0);
    let size = match exponent {
        0 => fraction * 2f32.powi(-14),
        31 => return if bits & 0x3ff == 0 { f32::INFINITY } else { f32::NAN },
        _ => (1.0 + fraction) * 2f32.powi(exponent - 15),
    };
    if bits >> 15 == 0 { size } else { -size }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A DNG of one directory with a map.
    fn dng(tag: u16, value: &[u8], big_endian: bool) -> Vec<u8> {
        let short = |v: u16| if big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
        let long = |v: u32| if big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
        let mut out = if big_endian { b"MM\0\x2a".to_vec() } else { b"II\x2a\0".to_vec() };
        out.extend(long(8));
        out.extend(short(1));
        out.extend([&short(tag)[..], &short(7), &long(value.len() as u32), &long(26)].concat());
        out.extend(long(0));
        out.extend(value);
        out
    }

    /// 1 x 2 tables of two entries, gains 0.5 to 2; kinds from 0 to 3, or the first version.
    fn map(kind: Option<u32>, big_endian: bool) -> Vec<u8> {
        let mut out = Vec::new();
        let order = |bytes: &[u8]| -> Vec<u8> {
            if big_endian { bytes.iter().rev().copied().collect() } else { bytes.to_vec() }
        };
        for v in [1u32, 2] {
            out.extend(order(&v.to_le_bytes()));
        }
        for v in [1.0f64, 0.5, 0.5, 0.25] {
            out.extend(order(&v.to_le_bytes()));
        }
        out.extend(order(&2u32.to_le_bytes()));
        for v in [0.25f32, 0.5, 0.25, 0.0, 0.0] {
            out.extend(order(&v.to_le_bytes()));
        }
        if let Some(kind) = kind {
            out.extend(order(&kind.to_le_bytes()));
            for v in [0.5f32, 0.5, 2.0] {
                out.extend(order(&v.to_le_bytes()));
            }
        }
        for gain in [0.5f32, 1.25, 1.0, 2.0] {
            let share = (gain - 0.5) / 1.5;
            match kind {
                Some(0) => out.push((share * 255.0).round() as u8),
                Some(1) => out.extend(order(&((share * 65535.0).round() as u16).to_le_bytes())),
                Some(2) => {
                    let bits = match gain {
                        0.5 => 0x3800u16,
                        1.25 => 0x3d00,
                        1.0 => 0x3c00,
                        _ => 0x4000,
                    };
                    out.extend(order(&bits.to_le_bytes()));
                }
                _ => out.extend(order(&gain.to_le_bytes())),
            }
        }
        out
    }

    fn found(tag: u16, value: &[u8], big_endian: bool) -> (Option<LocalToneMap>, Vec<String>) {
        let bytes = dng(tag, value, big_endian);
        let mut notes = Vec::new();
        (read(&Directories::walk(&bytes).unwrap().unwrap(), &mut notes), notes)
    }

    #[test]
    fn every_kind_of_gain_and_both_byte_orders_say_the_same() {
        for big_endian in [false, true] {
            for (tag, kind) in
                [(MAP, None), (MAP2, Some(0)), (MAP2, Some(1)), (MAP2, Some(2)), (MAP2, Some(3))]
            {
                let (map, notes) = found(tag, &map(kind, big_endian), big_endian);
                let map = map.unwrap();
                assert!(notes.is_empty());
                assert_eq!((map.points, map.entries), ([1, 2], 2));
                assert_eq!([map.spacing, map.origin], [[1.0, 0.5], [0.5, 0.25]]);
                assert_eq!(map.weights.map(f32::to_bits), [0.25f32, 0.5, 0.25, 0.0, 0.0].map(f32::to_bits));
                assert_eq!(map.gamma.to_bits(), if kind.is_some() { 0.5f32 } else { 1.0 }.to_bits());
                for (gain, wanted) in map.gains.iter().zip([0.5, 1.25, 1.0, 2.0]) {
                    assert!((gain - wanted).abs() < 3e-3, "{kind:?}: {gain}, not {wanted}");
                }
            }
        }
    }

    #[test]
    fn a_broken_one_is_left_out_with_a_note() {
        let whole = map(Some(3), false);
        let mut negative = whole.clone();
        negative[80..84].copy_from_slice(&(-1.0f32).to_le_bytes());
        let mut huge = whole.clone();
        huge[0..4].copy_from_slice(&u32::MAX.to_le_bytes());
        let mut no_spacing = whole.clone();
        no_spacing[16..24].copy_from_slice(&0.0f64.to_le_bytes());
        let mut gamma = whole.clone();
        gamma[68..72].copy_from_slice(&f32::NAN.to_le_bytes());
        for broken in [&whole[..95], &whole[..40], &[], &negative, &huge, &no_spacing, &gamma] {
            let (map, notes) = found(MAP2, broken, false);
            assert!(map.is_none());
            assert_eq!(
                notes,
                ["the file's local tone map (ProfileGainTableMap2) is damaged and is not applied"]
            );
        }
    }
}
