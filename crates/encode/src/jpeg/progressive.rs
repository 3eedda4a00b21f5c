//! Progressive JPEG: the whole picture in rising detail, by a library (jpeg-encoder). It is smaller by some per cent, is seen
//! early where it comes slowly, and takes the whole picture in memory.

use darkroot_photo::Size;
use jpeg_encoder::{ChromaSubsamplingMethod, ColorType, Encoder, QuantizationTableType, SamplingFactor};

use super::tables::Kind;
use crate::{ChromaSubsampling, Error, Format, Options};

/// The library's name for a subsampling.
pub(super) fn sampling(subsampling: ChromaSubsampling) -> SamplingFactor {
    match subsampling {
        ChromaSubsampling::S444 => SamplingFactor::R_4_4_4,
        ChromaSubsampling::S422 => SamplingFactor::R_4_2_2,
        ChromaSubsampling::S420 => SamplingFactor::R_4_2_0,
    }
}

/// What stands in a file behind what it says of the picture: tables, scans, the end.
pub(super) fn scans(size: Size, samples: &[u8], options: &Options) -> Result<Vec<u8>, Error> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, options.quality);
    encoder.set_sampling_factor(sampling(options.subsampling));
    encoder.set_chroma_subsampling_method(ChromaSubsamplingMethod::Average);
    // The same steps as in the baseline.
    let [luma, chroma] = Kind::BOTH
        .map(|kind| QuantizationTableType::Custom(Box::new(kind.steps(options.quality).map(u16::from))));
    encoder.set_quantization_tables(luma, chroma);
    encoder.set_progressive(true);
    encoder.set_optimized_huffman_tables(true);
    encoder
        .encode(samples, size.width as u16, size.height as u16, ColorType::Rgb)
        .map_err(|e| Error::encoder(Format::Jpeg)(e.into()))?;
    // The file's beginning and its JFIF segment are written by us, with the others of their kind.
    let jfif = 4 + file.get(4..6).map_or(0, |l| usize::from(l[0]) << 8 | usize::from(l[1]));
    Ok(file.split_off(jfif.min(file.len())))
}
