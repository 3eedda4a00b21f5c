//! How much work DNG opcode lists ask for, known before any of it is done (DNG 1.7, chapter 7).

use flashraw::FrameInfo;

use crate::opcodes::{MAX_OPCODES, Reader};
use crate::{Damage, Error};

/// Times that a list may touch every sample of the frame. Lists of cameras do so less than ten times.
const PASSES: u64 = 32;
/// Samples that a list may touch in any case: a second's work at most.
const SMALL: u64 = 1 << 25;

/// Refuses a frame whose opcode lists would keep the program busy for long.
pub(crate) fn check(info: &FrameInfo) -> Result<(), Error> {
    let Some(opcodes) = &info.opcodes else { return Ok(()) };
    let frame = Frame { width: info.width.into(), height: info.height.into(), planes: info.cpp.into() };
    // The third list works on a picture of three colours.
    let picture = Frame { planes: 3, ..frame };
    let lists = [("OpcodeList1", frame), ("OpcodeList2", frame), ("OpcodeList3", picture)];
    for (list, (name, frame)) in opcodes.lists.iter().zip(lists) {
        if samples_touched(list, frame) > SMALL.max(PASSES * frame.samples()) {
            return Err(Damage::ManyOperations { list: name }.into());
        }
    }
    Ok(())
}

/// Size of what a list works on.
#[derive(Debug, Clone, Copy)]
struct Frame {
    width: u64,
    height: u64,
    planes: u64,
}

impl Frame {
    fn samples(self) -> u64 {
        self.width * self.height * self.planes
    }
}

/// Samples that all opcodes of a list touch together; what is cut short counts as far as it goes.
fn samples_touched(list: &[u8], frame: Frame) -> u64 {
    let mut bytes = Reader(list);
    let mut sum = 0u64;
    for _ in 0..bytes.u32().unwrap_or(0).min(MAX_OPCODES) {
        let header = (bytes.u32(), bytes.u32(), bytes.u32(), bytes.u32());
        let (Some(id), Some(_version), Some(_flags), Some(length)) = header else { break };
        let Some(body) = bytes.take(length as usize) else { break };
        sum = sum.saturating_add(of_opcode(id, &mut Reader(body), frame).unwrap_or(0));
    }
    sum
}

/// Samples that one opcode touches; `None` when it is too short to be applied.
fn of_opcode(id: u32, body: &mut Reader<'_>, frame: Frame) -> Option<u64> {
    Some(match id {
        // Warps, vignetting, a constant that stands for bad pixels: the whole frame.
        1..=4 | 14 => frame.samples(),
        5 => {
            let _phase = body.u32()?;
            let (points, rectangles) = (body.u32()?, body.u32()?);
            body.take((points as usize).checked_mul(8)?)?;
            let mut sum = frame.samples().saturating_add(points.into());
            for _ in 0..rectangles {
                let (top, left, bottom, right) = (body.u32()?, body.u32()?, body.u32()?, body.u32()?);
                sum = sum.saturating_add(covered((top, bottom, 1), (left, right, 1), frame) * frame.planes);
            }
            sum
        }
        7..=13 => {
            let (top, left, bottom, right) = (body.u32()?, body.u32()?, body.u32()?, body.u32()?);
            let (_plane, planes) = (body.u32()?, body.u32()?);
            let (row_pitch, column_pitch) = (body.u32()?, body.u32()?);
            let pixels = covered((top, bottom, row_pitch), (left, right, column_pitch), frame);
            pixels * u64::from(planes).min(frame.planes)
        }
        _ => 0,
    })
}

/// Pixels of the frame in rows and columns from .. to, every so many.
fn covered(rows: (u32, u32, u32), columns: (u32, u32, u32), frame: Frame) -> u64 {
    let count = |(from, to, pitch): (u32, u32, u32), size: u64| {
        u64::from(to).min(size).saturating_sub(from.into()).div_ceil(u64::from(pitch.max(1)))
    };
    count(rows, frame.height) * count(columns, frame.width)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame { width: 100, height: 80, planes: 1 };

    fn list(opcodes: &[(u32, &[u32])]) -> Vec<u8> {
        let mut words = vec![opcodes.len() as u32];
        for (id, body) in opcodes {
            words.extend([*id, 0, 0, 4 * body.len() as u32]);
            words.extend(*body);
        }
        words.iter().flat_map(|w| w.to_be_bytes()).collect()
    }

    #[test]
    fn an_area_counts_as_far_as_it_lies_in_the_frame_and_by_its_pitch() {
        let touched = |area: &[u32]| samples_touched(&list(&[(8, area)]), FRAME);
        assert_eq!(touched(&[0, 0, 10, 20, 0, 1, 1, 1]), 200);
        assert_eq!(touched(&[0, 0, 10, 20, 0, 9, 2, 2]), 50);
        assert_eq!(touched(&[70, 90, u32::MAX, u32::MAX, 0, 1, 0, 0]), 100);
        assert_eq!(touched(&[10, 10, 5, 5, 0, 1, 1, 1]), 0);
        assert_eq!(touched(&[0, 0, 10]), 0);
    }

    #[test]
    fn rectangles_of_bad_pixels_count_each_time() {
        let list = list(&[(5, &[0, 0, 2, 0, 0, 10, 10, 0, 0, 10, 10]), (4, &[0, 0])]);
        assert_eq!(samples_touched(&list, FRAME), 8000 + 200 + 8000);
        for length in 0..list.len() {
            assert!(samples_touched(&list[..length], FRAME) <= 16_200);
        }
    }
}
