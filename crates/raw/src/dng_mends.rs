//! Where flashraw reads a DNG otherwise than Adobe's SDK does, and what is done about it.

use darkroot_photo::{Capture, Counts, Mosaic};
use flashraw::{Compression, FrameInfo, SampleFormat};

use crate::Error;
use crate::pieces::tag;
use crate::screen::{DNG_VERSION, LINEARIZATION_TABLE};
use crate::tiff::Directories;

/// TIFF Predictor.
const PREDICTOR: u16 = 0x013d;
/// DNG OpcodeList1, which flashraw applies itself.
const OPCODE_LIST_1: u16 = 0xc740;
/// Largest factor that is taken seriously.
const MAX_FACTOR: u64 = 16;

/// A picture whose rows or columns are stored in fields: every so many together (RowInterleaveFactor, DNG 1.2, and
/// ColumnInterleaveFactor, DNG 1.7). flashraw takes no notice, or takes each tile for a picture; so it gets a copy without
/// them, and the fields are brought together after.
#[derive(Debug)]
pub(crate) struct Fields {
    /// The file without its factors.
    pub(crate) bytes: Vec<u8>,
    rows: usize,
    columns: usize,
}

impl Fields {
    /// The fields of the main picture; `None` where it has none.
    ///
    /// # Errors
    /// Fields that cannot be brought together.
    pub(crate) fn of(tiff: &Directories<'_>) -> Result<Option<Self>, Error> {
        let main = |d: &&crate::tiff::Directory| d.number(tiff, tag::NEW_SUBFILE_TYPE).unwrap_or(0) == 0;
        let factor = |number| {
            let factors = tiff.all.iter().filter(main).filter_map(|d| d.number(tiff, number));
            factors.max().unwrap_or(1).max(1)
        };
        let (rows, columns) = (factor(tag::ROW_INTERLEAVE), factor(tag::COLUMN_INTERLEAVE));
        if !tiff.has(DNG_VERSION) || (rows, columns) == (1, 1) {
            return Ok(None);
        }
        if rows.max(columns) > MAX_FACTOR || tiff.has(OPCODE_LIST_1) {
            let compression = format!("{rows} x {columns} fields that are corrected before they are whole");
            return Err(Error::Compression { compression, decoder: "this program" });
        }
        let mut bytes = tiff.bytes().to_vec();
        for number in [tag::ROW_INTERLEAVE, tag::COLUMN_INTERLEAVE] {
            tiff.overwrite(number, 1, &mut bytes);
        }
        Ok(Some(Self { bytes, rows: rows as usize, columns: columns as usize }))
    }

    /// Brings the fields together.
    pub(crate) fn join(&self, mut capture: Capture) -> Capture {
        match &mut capture.counts {
            Counts::U16(mosaic) => self.join_mosaic(mosaic),
            Counts::F32(mosaic) => self.join_mosaic(mosaic),
        }
        capture
    }

    fn join_mosaic<T: Copy>(&self, mosaic: &mut Mosaic<T>) {
        let planes = mosaic.layout.planes();
        let (rows, columns) =
            (places(mosaic.size.height, self.rows), places(mosaic.size.width, self.columns));
        let mut whole = mosaic.samples.clone();
        for (&y, stored) in rows.iter().zip(mosaic.samples.chunks_exact(mosaic.size.width * planes)) {
            let row = &mut whole[y * stored.len()..][..stored.len()];
            for (&x, pixel) in columns.iter().zip(stored.chunks_exact(planes)) {
                row[x * planes..][..planes].copy_from_slice(pixel);
            }
        }
        mosaic.samples = whole;
    }
}

/// Where each stored row or column belongs.
fn places(count: usize, factor: usize) -> Vec<usize> {
    (0..factor).flat_map(|field| (field..count).step_by(factor)).collect()
}

/// Mends samples that flashraw decoded.
///
/// # Errors
/// Samples that cannot be mended.
pub(crate) fn mend(tiff: &Directories<'_>, info: &FrameInfo, counts: &mut Counts) -> Result<(), Error> {
    let Counts::U16(mosaic) = counts else { return Ok(()) };
    if info.sample_format != SampleFormat::U16 || !tiff.has(DNG_VERSION) {
        return Ok(());
    }
    let differences = tiff.all.iter().any(|d| d.number(tiff, PREDICTOR).is_some_and(|p| p != 1));
    if info.compression == Compression::Deflate && info.bits_per_sample == 8 && differences {
        // It sums differences of 8 bits in 16; a table has been applied to sums that are too large.
        if tiff.has(LINEARIZATION_TABLE) {
            let compression = "deflated differences of 8 bits and a table".to_owned();
            return Err(Error::Compression { compression, decoder: "flashraw" });
        }
        mosaic.samples.iter_mut().for_each(|s| *s &= 0xff);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_belong_where_adobe_s_sdk_puts_them() {
        assert_eq!(places(7, 2), [0, 2, 4, 6, 1, 3, 5]);
        assert_eq!(places(5, 3), [0, 3, 1, 4, 2]);
        assert_eq!(places(3, 1), [0, 1, 2]);
        assert_eq!(places(2, 4), [0, 1]);
    }
}
