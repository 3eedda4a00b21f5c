//! What stands before the bits of a JPEG (T.81, B.2; JFIF 1.02; Exif 2.32, 4.7.2; ICC.1:2022, B.4).

use darkroot_photo::Size;

use crate::iptc;

use super::tables::{Kind, ZIGZAG};
use super::units::Subsampling;

/// The marker behind the last bit.
pub(super) const END: [u8; 2] = [0xff, 0xd9];

/// Bytes that a segment has for what it holds: 65535, less its length.
const SEGMENT: usize = 65_533;

pub(super) struct Header<'a> {
    pub(super) size: Size,
    pub(super) subsampling: Subsampling,
    pub(super) quality: u8,
    /// Units between two restart markers; 0 where there are none.
    pub(super) restart: u16,
    /// ICC profile, or nothing.
    pub(super) profile: &'a [u8],
    /// Exif block that fits into a segment, or nothing.
    pub(super) exif: &'a [u8],
    /// Packet of XMP, or nothing. One that is too large for a segment is left out.
    pub(super) xmp: &'a [u8],
    /// Block of IPTC-IIM, or nothing. One that is too large for a segment is left out.
    pub(super) iptc: &'a [u8],
    /// Further segments of APP2.
    pub(super) more: &'a [Vec<u8>],
}

impl Header<'_> {
    /// All that stands before the bits of a baseline file.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let mut out = self.about();
        self.tables(&mut out);
        out
    }

    /// What the file says of the picture, with the file's beginning.
    pub(super) fn about(&self) -> Vec<u8> {
        let mut out = vec![0xff, 0xd8];
        // JFIF 1.02, square pixels, no thumbnail.
        segment(&mut out, 0xe0, &[b"JFIF\0", &[1, 2, 0, 0, 1, 0, 1, 0, 0]]);
        if !self.exif.is_empty() {
            segment(&mut out, 0xe1, &[b"Exif\0\0", self.exif]);
        }
        // XMP specification, part 3, 1.1.3.
        const XMP: &[u8] = b"http://ns.adobe.com/xap/1.0/\0";
        if (1..=SEGMENT - XMP.len()).contains(&self.xmp.len()) {
            segment(&mut out, 0xe1, &[XMP, self.xmp]);
        }
        let resources = iptc::resources(self.iptc);
        if !self.iptc.is_empty() && resources.len() <= SEGMENT {
            segment(&mut out, 0xed, &[&resources]);
        }
        const ICC: &[u8] = b"ICC_PROFILE\0";
        let parts = self.profile.chunks(SEGMENT - ICC.len() - 2);
        let count = parts.len() as u8;
        for (number, part) in (1..).zip(parts) {
            segment(&mut out, 0xe2, &[ICC, &[number, count], part]);
        }
        for content in self.more {
            segment(&mut out, 0xe2, &[content]);
        }
        out
    }

    /// Steps, frame, codes, and the beginning of the scan.
    fn tables(&self, out: &mut Vec<u8>) {
        for (table, kind) in (0..).zip(Kind::BOTH) {
            let steps = kind.steps(self.quality);
            segment(out, 0xdb, &[&[table], &ZIGZAG.map(|at| steps[usize::from(at)])]);
        }
        self.frame(out);
        for (table, kind) in (0..).zip(Kind::BOTH) {
            for (class, code) in [(0x00, kind.mean_code()), (0x10, kind.code())] {
                segment(out, 0xc4, &[&[class | table], &code.lengths, code.values]);
            }
        }
        if self.restart > 0 {
            segment(out, 0xdd, &[&self.restart.to_be_bytes()]);
        }
        // All coefficients of three components, with the codes of the first for lightness.
        segment(out, 0xda, &[&[3, 1, 0x00, 2, 0x11, 3, 0x11], &[0, 63, 0]]);
    }

    /// Baseline: eight bits, three components.
    fn frame(&self, out: &mut Vec<u8>) {
        let Size { width, height } = self.size;
        let sampling = (self.subsampling.across << 4 | self.subsampling.down) as u8;
        segment(
            out,
            0xc0,
            &[
                &[8],
                &(height as u16).to_be_bytes(),
                &(width as u16).to_be_bytes(),
                &[3, 1, sampling, 0, 2, 0x11, 1, 3, 0x11, 1],
            ],
        );
    }
}

fn segment(out: &mut Vec<u8>, marker: u8, parts: &[&[u8]]) {
    let length = 2 + parts.iter().map(|part| part.len()).sum::<usize>();
    out.extend([0xff, marker]);
    out.extend((length as u16).to_be_bytes());
    out.extend(parts.concat());
}
