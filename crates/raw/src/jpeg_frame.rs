//! The frame headers of a JPEG (ITU-T T.81, B.2.2), without decoding any of it.

/// Samples of the largest frame that a JPEG announces before its scan; `None` for bytes that are no JPEG, or that
/// announce none. Extra luma samples of subsampled pictures count.
///
/// Markers are found as careless decoders find them: bytes between segments are skipped.
pub(crate) fn most_samples(jpeg: &[u8]) -> Option<u64> {
    let mut rest = jpeg.strip_prefix(&[0xff, 0xd8])?;
    let mut most = None;
    while let Some((marker, segment, after)) = next(rest) {
        match marker {
            // Every kind of frame; 0xc4, 0xc8 and 0xcc are tables and an extension.
            0xc0..=0xcf if !matches!(marker, 0xc4 | 0xc8 | 0xcc) => most = most.max(samples(segment)),
            // The scan, or the end.
            0xd9 | 0xda => break,
            _ => {}
        }
        rest = after;
    }
    most
}

/// The next marker, the segment that belongs to it, and what follows.
fn next(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let start = bytes.iter().position(|&b| b == 0xff)?;
    let code = start + bytes.get(start..)?.iter().position(|&b| b != 0xff)?;
    let (&marker, after) = bytes.get(code..)?.split_first()?;
    // Markers that stand alone.
    if matches!(marker, 0x00 | 0x01 | 0xd0..=0xd9) {
        return Some((marker, &[], after));
    }
    let &[high, low, ..] = after else { return None };
    let length = usize::from(u16::from_be_bytes([high, low])).max(2);
    let (segment, after) = after.split_at(length.min(after.len()));
    Some((marker, &segment[2..], after))
}

/// Samples of a frame: height, width, components, and sampling factors of the first.
fn samples(frame: &[u8]) -> Option<u64> {
    let &[_, h1, h0, w1, w0, components, ..] = frame else { return None };
    let (height, width) = (u16::from_be_bytes([h1, h0]), u16::from_be_bytes([w1, w0]));
    let factors = frame.get(7).map_or(1, |f| u64::from(f >> 4) * u64::from(f & 15));
    let of_pixel = u64::from(components) + factors.clamp(1, 4) - 1;
    Some(u64::from(width) * u64::from(height) * of_pixel)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: &[u8] = b"\xff\xc3\0\x0b\x0e\x01\0\x02\0\x01\0\x11\0";

    #[test]
    fn the_largest_frame_before_the_scan_counts() {
        let scan = b"\xff\xda\0\x08\x01\0\0\x01\0\0";
        let larger = b"\xff\xc0\0\x11\x08\x10\0\x10\0\x03\0\x22\0\x01\x11\0\x02\x11\0";
        let jpeg = |parts: &[&[u8]]| [&b"\xff\xd8"[..], &parts.concat()].concat();
        assert_eq!(most_samples(&jpeg(&[FRAME, scan])), Some(256 * 512));
        assert_eq!(most_samples(&jpeg(&[FRAME, larger, scan])), Some(4096 * 4096 * 6));
        assert_eq!(most_samples(&jpeg(&[larger, FRAME, scan])), Some(4096 * 4096 * 6));
        assert_eq!(most_samples(&jpeg(&[FRAME, scan, larger])), Some(256 * 512));
        assert_eq!(most_samples(&jpeg(&[b"rubbish\xff", FRAME, scan])), Some(256 * 512));
    }

    #[test]
    fn what_is_cut_off_or_no_jpeg_has_no_frame() {
        assert_eq!(most_samples(b"II*\0"), None);
        let jpeg = [b"\xff\xd8", FRAME].concat();
        for length in 0..11 {
            assert_eq!(most_samples(&jpeg[..length]), None, "{length}");
        }
    }
}
