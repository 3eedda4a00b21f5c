//! The samples, in tiles of lossless JPEG.

use std::io::{Seek, Write};

use tiff::TiffResult;
use tiff::tags::Tag;

use super::{Entries, error};
use crate::bands::Sink;
use crate::tiff_entries::EVEN;
use crate::{Error, ljpeg};

/// Side of a tile, pixels; a multiple of 16 (TIFF 6.0, section 15).
pub(super) const SIDE: usize = 256;

/// Red, green and blue.
const PLANES: usize = 3;

/// The tiles of a band, left to right. Where they reach beyond the picture the last column and row are repeated.
pub(super) fn coded(samples: &[u16], width: usize) -> Vec<Vec<u8>> {
    let rows = samples.len() / (PLANES * width);
    let mut tile = Vec::with_capacity(PLANES * SIDE * SIDE);
    let tiles = (0..width).step_by(SIDE).map(|x| {
        tile.clear();
        let whole = SIDE.min(width - x);
        for y in 0..SIDE {
            let row = &samples[y.min(rows - 1) * PLANES * width..][..PLANES * width];
            tile.extend_from_slice(&row[PLANES * x..PLANES * (x + whole)]);
            for _ in whole..SIDE {
                tile.extend_from_slice(&row[PLANES * (width - 1)..]);
            }
        }
        ljpeg::encode(&tile, PLANES * SIDE, PLANES, 16)
    });
    tiles.collect()
}

/// The tiles that are written, and the directory that will say where they are.
pub(super) struct Tiles<'a, W: Write + Seek> {
    entries: Entries<'a, W>,
    offsets: Vec<u32>,
    lengths: Vec<u32>,
}

impl<'a, W: Write + Seek> Tiles<'a, W> {
    pub(super) fn new(entries: Entries<'a, W>) -> Self {
        Self { entries, offsets: Vec::new(), lengths: Vec::new() }
    }

    /// The directory, which knows its tiles.
    pub(super) fn finish(mut self) -> TiffResult<Entries<'a, W>> {
        self.entries.write_tag(Tag::TileWidth, SIDE as u32)?;
        self.entries.write_tag(Tag::TileLength, SIDE as u32)?;
        self.entries.write_tag(Tag::TileOffsets, &self.offsets[..])?;
        self.entries.write_tag(Tag::TileByteCounts, &self.lengths[..])?;
        Ok(self.entries)
    }
}

impl<W: Write + Seek + Send> Sink for Tiles<'_, W> {
    type Coded = Vec<Vec<u8>>;

    fn put(&mut self, coded: Self::Coded) -> Result<(), Error> {
        for mut tile in coded {
            let length = tile.len() as u32;
            tile.resize(tile.len().next_multiple_of(EVEN), 0);
            let offset = self.entries.write_data(&tile[..]).map_err(error)?;
            self.offsets.push(u32::try_from(offset).map_err(|e| error(e.into()))?);
            self.lengths.push(length);
        }
        Ok(())
    }
}
