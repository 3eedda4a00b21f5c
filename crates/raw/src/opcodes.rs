//! DNG opcode lists 2 and 3 as corrections (DNG 1.7, chapter 7). Numbers in them are big-endian.

use darkroot_photo::Rect;
use darkroot_photo::correction::{Area, Correction, Distortion, GainMap, Projection, Vignette, Warp};

/// Flag bit: a reader that does not know the opcode may skip it.
const OPTIONAL: u32 = 1;
/// Largest number of opcodes that is taken seriously.
pub(crate) const MAX_OPCODES: u32 = 4096;

/// Parses a list. What cannot be applied is named in `notes`.
pub(crate) fn parse(list: &[u8], name: &str, notes: &mut Vec<String>) -> Vec<Correction> {
    let mut corrections = Vec::new();
    let mut bytes = Reader(list);
    let count = bytes.u32().unwrap_or(0).min(MAX_OPCODES);
    for _ in 0..count {
        let header = (bytes.u32(), bytes.u32(), bytes.u32(), bytes.u32());
        let (Some(id), Some(_version), Some(flags), Some(length)) = header else {
            notes.push(format!("{name} is cut short; the rest of it is not applied"));
            break;
        };
        let Some(body) = bytes.take(length as usize) else {
            notes.push(format!("{name} is cut short; the rest of it is not applied"));
            break;
        };
        let why = match correction(id, &mut Reader(body)) {
            Some(correction) => {
                corrections.push(correction);
                continue;
            }
            None if is_whole(id, &mut Reader(body)).unwrap_or(false) => "is not applied",
            None => "is damaged and left out",
        };
        let weight = if flags & OPTIONAL != 0 { "optional" } else { "mandatory" };
        notes.push(format!("{name}: the {weight} correction {} {why}", opcode_name(id)));
    }
    corrections
}

/// Whether an opcode that is not applied has all that it should have; of those that nobody knows, nobody can say.
fn is_whole(id: u32, body: &mut Reader<'_>) -> Option<bool> {
    let length = body.0.len();
    Some(match id {
        // A constant and the phase of the filters.
        4 => length == 8,
        // Phase, points and rectangles.
        5 => {
            let (_phase, points, rectangles) = (body.u32()?, body.u32()? as usize, body.u32()? as usize);
            Some(length) == points.checked_mul(8)?.checked_add(rectangles.checked_mul(16)?)?.checked_add(12)
        }
        // A rectangle.
        6 => {
            let (top, left, bottom, right) = (body.u32()?, body.u32()?, body.u32()?, body.u32()?);
            length == 16 && top < bottom && left < right
        }
        // Those that are applied where they are whole.
        1..=3 | 7..=14 => false,
        _ => true,
    })
}

fn opcode_name(id: u32) -> String {
    match id {
        1 => "WarpRectilinear".into(),
        2 => "WarpFisheye".into(),
        3 => "FixVignetteRadial".into(),
        4 => "FixBadPixelsConstant".into(),
        5 => "FixBadPixelsList".into(),
        6 => "TrimBounds".into(),
        7 => "MapTable".into(),
        8 => "MapPolynomial".into(),
        9 => "GainMap".into(),
        10 => "DeltaPerRow".into(),
        11 => "DeltaPerColumn".into(),
        12 => "ScalePerRow".into(),
        13 => "ScalePerColumn".into(),
        14 => "WarpRectilinear2".into(),
        other => format!("number {other}"),
    }
}

fn correction(id: u32, body: &mut Reader<'_>) -> Option<Correction> {
    Some(match id {
        1 => {
            let count = body.u32()?.min(4);
            let plane = |_| body.f64s::<6>().map(Distortion::from);
            let planes = (0..count).map(plane).collect::<Option<Vec<_>>>()?;
            let projection = Projection::Rectilinear;
            Correction::Warp(Warp { projection, planes, centre: (body.f64()?, body.f64()?) })
        }
        2 => {
            let radial = |[a, b, c, d]: [f64; 4]| Distortion::from([a, b, c, d, 0.0, 0.0]);
            let planes =
                (0..body.u32()?.min(4)).map(|_| body.f64s().map(radial)).collect::<Option<Vec<_>>>()?;
            let projection = Projection::Fisheye;
            Correction::Warp(Warp { projection, planes, centre: (body.f64()?, body.f64()?) })
        }
        3 => {
            Correction::Vignette(Vignette { coefficients: body.f64s()?, centre: (body.f64()?, body.f64()?) })
        }
        7 => {
            let area = body.area()?;
            let count = body.u32()?;
            Correction::Table(area, (0..count).map(|_| body.u16()).collect::<Option<Vec<_>>>()?)
        }
        8 => {
            let area = body.area()?;
            let degree = body.u32()?;
            // The specification allows degrees up to 8.
            if degree > 8 {
                return None;
            }
            Correction::Polynomial(area, (0..=degree).map(|_| body.f64()).collect::<Option<Vec<_>>>()?)
        }
        9 => {
            let area = body.area()?;
            let (rows, columns) = (body.u32()? as usize, body.u32()? as usize);
            let (spacing_v, spacing_h) = (body.f64()?, body.f64()?);
            let (origin_v, origin_h) = (body.f64()?, body.f64()?);
            let planes = body.u32()? as usize;
            let count = rows.checked_mul(columns)?.checked_mul(planes)?;
            if count == 0 || count.checked_mul(4)? > body.0.len() {
                return None;
            }
            let gains = (0..count).map(|_| body.f32()).collect::<Option<Vec<_>>>()?;
            let (vertical, horizontal) = ((origin_v, spacing_v), (origin_h, spacing_h));
            Correction::Gain(area, GainMap { rows, columns, planes, vertical, horizontal, gains })
        }
        10..=13 => {
            let area = body.area()?;
            let count = body.u32()?;
            let values = (0..count).map(|_| body.f32()).collect::<Option<Vec<_>>>()?;
            match id {
                10 => Correction::RowDelta(area, values),
                11 => Correction::ColumnDelta(area, values),
                12 => Correction::RowScale(area, values),
                _ => Correction::ColumnScale(area, values),
            }
        }
        14 => {
            let count = body.u32()?.min(4);
            let plane = |_| {
                let (radial, tangential) = (body.f64s()?, body.f64s()?);
                Some(Distortion { radial, tangential, valid: body.f64s()? })
            };
            let planes = (0..count).map(plane).collect::<Option<Vec<_>>>()?;
            let centre = (body.f64()?, body.f64()?);
            let projection = match body.u32()? {
                0 => Projection::Rectilinear,
                _ => Projection::RectilinearInverse,
            };
            let sound = planes.iter().all(|plane| plane.valid[0] <= plane.valid[1]);
            return sound.then_some(Correction::Warp(Warp { projection, planes, centre }));
        }
        _ => return None,
    })
}

/// Big-endian reading that cannot run out of bounds; infinities and NaN count as damage.
pub(crate) struct Reader<'a>(pub(crate) &'a [u8]);

impl<'a> Reader<'a> {
    pub(crate) fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (head, tail) = self.0.split_at_checked(n)?;
        self.0 = tail;
        Some(head)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_be_bytes)
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_be_bytes)
    }

    fn f32(&mut self) -> Option<f32> {
        self.array().map(f32::from_be_bytes).filter(|v| v.is_finite())
    }

    fn f64(&mut self) -> Option<f64> {
        self.array().map(f64::from_be_bytes).filter(|v| v.is_finite())
    }

    fn f64s<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut values = [0.0; N];
        for v in &mut values {
            *v = self.f64()?;
        }
        Some(values)
    }

    fn area(&mut self) -> Option<Area> {
        let (top, left) = (self.u32()? as usize, self.u32()? as usize);
        let (bottom, right) = (self.u32()? as usize, self.u32()? as usize);
        let (plane, planes) = (self.u32()? as usize, self.u32()? as usize);
        let (row_pitch, column_pitch) = (self.u32()? as usize, self.u32()? as usize);
        let whole = bottom >= top && right >= left && row_pitch > 0 && column_pitch > 0 && planes > 0;
        let rect =
            Rect { x: left, y: top, width: right.checked_sub(left)?, height: bottom.checked_sub(top)? };
        whole.then_some(Area { rect, plane, planes, row_pitch, column_pitch })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(opcodes: &[(u32, u32, Vec<u8>)]) -> Vec<u8> {
        let mut bytes = (opcodes.len() as u32).to_be_bytes().to_vec();
        for (id, flags, body) in opcodes {
            for word in [*id, 0x0103_0000, *flags, body.len() as u32] {
                bytes.extend(word.to_be_bytes());
            }
            bytes.extend(body);
        }
        bytes
    }

    fn area_bytes() -> Vec<u8> {
        [0u32, 0, 10, 20, 1, 1, 1, 1].iter().flat_map(|v| v.to_be_bytes()).collect()
    }

    #[test]
    fn a_polynomial_keeps_its_area_and_coefficients() {
        let mut body = area_bytes();
        body.extend(1u32.to_be_bytes());
        body.extend(0.5f64.to_be_bytes());
        body.extend(2.0f64.to_be_bytes());
        let mut notes = Vec::new();
        let parsed = parse(&list(&[(8, 0, body)]), "OpcodeList2", &mut notes);
        let rect = Rect { x: 0, y: 0, width: 20, height: 10 };
        let area = Area { rect, plane: 1, planes: 1, row_pitch: 1, column_pitch: 1 };
        assert_eq!(parsed, vec![Correction::Polynomial(area, vec![0.5, 2.0])]);
        assert!(notes.is_empty());
    }

    #[test]
    fn an_unknown_opcode_is_named_and_the_rest_goes_on() {
        let mut vignette: Vec<u8> = (0..5).flat_map(|_| 0f64.to_be_bytes()).collect();
        vignette.extend(0.5f64.to_be_bytes());
        vignette.extend(0.5f64.to_be_bytes());
        let mut notes = Vec::new();
        let parsed = parse(&list(&[(99, 0, vec![]), (3, 0, vignette)]), "OpcodeList3", &mut notes);
        assert_eq!(parsed.len(), 1);
        assert_eq!(notes, ["OpcodeList3: the mandatory correction number 99 is not applied"]);
    }

    #[test]
    fn every_opcode_is_read_and_one_that_is_not_applied_or_damaged_is_named() {
        let words = |numbers: &[u32]| numbers.iter().flat_map(|n| n.to_be_bytes()).collect::<Vec<u8>>();
        for (id, whole, name) in [
            (4, words(&[0, 1]), "FixBadPixelsConstant"),
            (5, words(&[0, 1, 1, 7, 7, 1, 1, 2, 2]), "FixBadPixelsList"),
            (6, words(&[0, 0, 9, 9]), "TrimBounds"),
        ] {
            let said = |body: Vec<u8>| {
                let mut notes = Vec::new();
                assert!(parse(&list(&[(id, 1, body)]), "OpcodeList3", &mut notes).is_empty());
                notes
            };
            assert_eq!(
                said(whole.clone()),
                [format!("OpcodeList3: the optional correction {name} is not applied")]
            );
            let damaged = [format!("OpcodeList3: the optional correction {name} is damaged and left out")];
            assert_eq!(said(whole[..whole.len() - 1].to_vec()), damaged);
            assert_eq!(said(Vec::new()), damaged);
        }
        for id in (7..=14).chain([1, 3]) {
            let mut notes = Vec::new();
            assert!(parse(&list(&[(id, 0, vec![0; 3])]), "OpcodeList2", &mut notes).is_empty());
            let damaged = format!("the mandatory correction {} is damaged", opcode_name(id));
            assert!(notes.len() == 1 && notes[0].contains(&damaged), "{notes:?}");
        }
    }

    #[test]
    fn a_list_that_is_cut_short_says_so() {
        let whole = list(&[(3, 0, vec![0; 56])]);
        for length in 5..whole.len() {
            let mut notes = Vec::new();
            assert!(parse(&whole[..length], "OpcodeList3", &mut notes).is_empty());
            assert_eq!(notes.len(), 1, "{length}");
        }
    }
}
