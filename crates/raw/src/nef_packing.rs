//! Uncompressed samples of Nikon's files, where nothing in a file says in which order its bits are packed.
//!
//! 14 bits stand in words of 16, or packed; 12 bits packed. Most cameras pack from the highest bit down, some from the
//! lowest up, and decoders decide by the camera's name. Here the samples decide: read in the wrong order, neighbours of
//! one colour differ wildly, because bits of one sample land in the next.

use flashraw::{Compression, FrameInfo, RawFormat, RawMetadata};

use crate::Error;
use crate::pieces::{Grid, tag};
use crate::tiff::Directories;

/// Rows that are looked at, spread over the frame.
const ROWS: usize = 64;
/// How many times rougher the wrong order must be to be known as such; in photographs it is more than ten times.
const ROUGHER: u64 = 2;
/// Some cameras fill rows up to this many bytes.
const PADDED: usize = 16;

/// Order of the bits of packed samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    /// A sample begins in the highest free bit of a byte.
    HighestFirst,
    /// A sample begins in the lowest free bit of a byte.
    LowestFirst,
}

/// Packed samples and what is known of them.
#[derive(Debug)]
pub(crate) struct Packed<'a> {
    bytes: &'a [u8],
    bits: u32,
    width: usize,
    stride: usize,
}

/// The samples of a frame whose order flashraw does not know, with a note on how it was found; `None` for all others, which
/// it reads itself.
///
/// # Errors
/// [`Error::Compression`] where neither order gives a picture.
pub(crate) fn samples(
    tiff: &Directories<'_>,
    meta: &RawMetadata,
    info: &FrameInfo,
) -> Result<Option<(Vec<u16>, String)>, Error> {
    let is_packed = meta.format == Some(RawFormat::Nef)
        && info.compression == Compression::Uncompressed
        && info.cpp == 1
        && matches!(info.bits_per_sample, 12 | 14);
    if !is_packed {
        return Ok(None);
    }
    let (width, height, bits) = (info.width as usize, info.height as usize, u32::from(info.bits_per_sample));
    let Some(packed) = Packed::of(tiff, width, height, bits)? else { return Ok(None) };
    let order = packed.order();
    if bits == 12 && order != Some(Order::LowestFirst) {
        return Ok(None); // As every decoder has it.
    }
    let Some(order) = order else { return Err(unknown(bits)) };
    let mut samples = vec![0; width * height];
    for (row, bytes) in samples.chunks_exact_mut(width).zip(packed.bytes.chunks(packed.stride)) {
        unpack(bytes, bits, order, row);
    }
    let from = match order {
        Order::HighestFirst => "highest",
        Order::LowestFirst => "lowest",
    };
    let note = format!(
        "the file does not say how its {bits}-bit samples are packed; they were read from the {from} bit on, \
         because only so neighbours are alike"
    );
    Ok(Some((samples, note)))
}

fn unknown(bits: u32) -> Error {
    Error::Compression {
        compression: format!("{bits}-bit samples in an unknown packing"),
        decoder: "flashraw",
    }
}

impl<'a> Packed<'a> {
    /// The packed samples of a frame; `None` for samples in words, and for what flashraw knows by itself.
    fn of(tiff: &Directories<'a>, width: usize, height: usize, bits: u32) -> Result<Option<Self>, Error> {
        let is = |d: &&crate::tiff::Directory, tag, value: usize| d.number(tiff, tag) == Some(value as u64);
        let of_frame = |d: &&crate::tiff::Directory| {
            is(d, tag::IMAGE_WIDTH, width)
                && is(d, tag::IMAGE_LENGTH, height)
                && is(d, tag::BITS_PER_SAMPLE, bits as usize)
        };
        let Some(directory) = tiff.all.iter().find(of_frame) else { return Ok(None) };
        let Some(grid) = Grid::of(tiff, directory, width, height) else { return Ok(None) };
        let touching = grid.pieces.windows(2).all(|pair| pair[0].0.saturating_add(pair[0].1) == pair[1].0);
        let length = grid.pieces.iter().map(|p| p.1).fold(0, usize::saturating_add);
        let Some(&(start, _)) = grid.pieces.first() else { return Ok(None) };
        // Words of 16 bits; in a small frame padded rows would take as much.
        if bits == 14 && length == 2 * width * height {
            return Ok(None);
        }
        let tight = (width * bits as usize).div_ceil(8);
        let padded = tight.next_multiple_of(PADDED);
        let stride = [tight, padded].into_iter().find(|stride| stride.saturating_mul(height) == length);
        match stride {
            Some(stride) if touching => {
                let bytes = tiff.bytes().get(start..start.saturating_add(length));
                Ok(bytes.map(|bytes| Self { bytes, bits, width, stride }))
            }
            // Too short for words of 16 bits, and no packing that anybody knows.
            _ if bits == 14 && length < 2 * width * height => Err(unknown(bits)),
            _ => Ok(None),
        }
    }

    /// The order in which neighbours are much more alike than in the other; `None` where neither is.
    fn order(&self) -> Option<Order> {
        let high = self.roughness(Order::HighestFirst);
        let low = self.roughness(Order::LowestFirst);
        if high.saturating_mul(ROUGHER) < low {
            Some(Order::HighestFirst)
        } else if low.saturating_mul(ROUGHER) < high {
            Some(Order::LowestFirst)
        } else {
            None
        }
    }

    /// Sum of differences between neighbours of one colour.
    fn roughness(&self, order: Order) -> u64 {
        let mut row = vec![0; self.width];
        let rows = self.bytes.len() / self.stride.max(1);
        let mut sum = 0;
        for bytes in self.bytes.chunks(self.stride).step_by((rows / ROWS).max(1)) {
            unpack(bytes, self.bits, order, &mut row);
            sum += row.windows(3).map(|w| u64::from(w[0].abs_diff(w[2]))).sum::<u64>();
        }
        sum
    }
}

/// Unpacks a row; samples beyond its bytes stay as they are.
fn unpack(bytes: &[u8], bits: u32, order: Order, row: &mut [u16]) {
    let (mut pending, mut count) = (0u32, 0);
    let mut bytes = bytes.iter().map(|&b| u32::from(b));
    for sample in row {
        while count < bits {
            let Some(byte) = bytes.next() else { return };
            match order {
                Order::HighestFirst => pending = pending << 8 | byte,
                Order::LowestFirst => pending |= byte << count,
            }
            count += 8;
        }
        count -= bits;
        let mask = (1 << bits) - 1;
        match order {
            Order::HighestFirst => *sample = (pending >> count & mask) as u16,
            Order::LowestFirst => {
                *sample = (pending & mask) as u16;
                pending >>= bits;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_read_in_both_orders() {
        let read = |bytes: &[u8], bits, order| {
            let mut row = [0; 2];
            unpack(bytes, bits, order, &mut row);
            row
        };
        assert_eq!(read(&[0xab, 0xc1, 0x23], 12, Order::HighestFirst), [0xabc, 0x123]);
        assert_eq!(read(&[0xbc, 0x3a, 0x12], 12, Order::LowestFirst), [0xabc, 0x123]);
        assert_eq!(
            read(&[0b1010_1010, 0b1011_1111, 0b1111_1111, 0b0001_0000], 14, Order::HighestFirst),
            [0b10_1010_1010_1111, 0b11_1111_1111_0001]
        );
        assert_eq!(read(&[0xff, 0x7f, 0x00, 0x00], 14, Order::LowestFirst), [0x3fff, 1]);
    }

    #[test]
    fn the_smooth_order_is_found_and_noise_has_none() {
        let packed =
            |bytes: &[u8]| Packed { bytes: &bytes.repeat(64), bits: 12, width: 64, stride: 96 }.order();
        // Two colours, both smooth: 0x4a1 and 0x251.
        assert_eq!(packed(&[0x4a, 0x12, 0x51].repeat(32)), None); // Even rows are smooth in every order ...
        let slope: Vec<u16> = (0..64).map(|x| 1000 + 13 * x + 700 * (x % 2)).collect();
        let high: Vec<u8> = slope
            .chunks(2)
            .flat_map(|p| [(p[0] >> 4) as u8, (p[0] << 4 | p[1] >> 8) as u8, p[1] as u8])
            .collect();
        let low: Vec<u8> = slope
            .chunks(2)
            .flat_map(|p| [p[0] as u8, (p[0] >> 8 | p[1] << 4) as u8, (p[1] >> 4) as u8])
            .collect();
        assert_eq!(packed(&high), Some(Order::HighestFirst)); // ... a slope is in one.
        assert_eq!(packed(&low), Some(Order::LowestFirst));
        assert_eq!(packed(&[0; 96]), None);
    }
}
