//! TIFF: 8 and 16 bits and floating point, in strips, with the fields of the shot in directories of their own.

use std::io::{Seek, Write};

use darkroot_photo::metadata::Directory;
use darkroot_photo::{Metadata, PictureSpace, Size};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use tiff::encoder::{
    DirectoryEncoder, Predictor, Rational, TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard,
};
use tiff::tags::{CompressionMethod, PhotometricInterpretation, ResolutionUnit, SampleFormat, Tag, Type};
use tiff::{TiffError, TiffResult};

use crate::bands::{self, MakeBands, Outline, Sink};
use crate::format::profile_of;
use crate::output::Buffered;
use crate::tiff_entries::{EVEN, closed, shot_directories, write_bytes, write_fields};
use crate::{Error, Format, Options, Sample, TiffCompression};

const IMAGE_DESCRIPTION: u16 = 0x010e;
const ICC_PROFILE: u16 = 0x8773;

/// Level of deflate; see PNG's.
const LEVEL: u32 = 1;

/// Rows of a band, and of each of the strips that it becomes.
const BAND_ROWS: usize = 192;
const STRIP_ROWS: usize = 16;

/// Writes a picture of a size that [`Format::sides`] has allowed.
pub(crate) fn write<T: Sample>(
    outline: &Outline,
    options: &Options,
    metadata: &Metadata,
    out: &mut Buffered<'_, '_>,
    make: &mut MakeBands<'_, T>,
) -> Result<(), Error> {
    if needs_offsets_of_64_bits(outline.size, T::BITS) {
        write_kind::<TiffKindBig, _, _>(outline, options, metadata, out, make)
    } else {
        write_kind::<TiffKindStandard, _, _>(outline, options, metadata, out, make)
    }
}

/// Whether the file might be larger than offsets of 32 bits can say. What deflate may save is not known before.
fn needs_offsets_of_64_bits(size: Size, bits: u8) -> bool {
    // A sixteenth is left for strips that grow, tables and metadata.
    let bits = size.width as u64 * size.height as u64 * 3 * u64::from(bits);
    bits / 8 > u64::from(u32::MAX) / 16 * 15
}

fn write_kind<K: TiffKind<OffsetType: Send> + Send, T: Sample, W: Write + Seek + Send>(
    outline: &Outline,
    options: &Options,
    metadata: &Metadata,
    out: &mut W,
    make: &mut MakeBands<'_, T>,
) -> Result<(), Error> {
    let mut file = TiffEncoder::<_, K>::new_generic(out).map_err(error)?;
    let entries = begun(&mut file, outline, options, metadata, T::BITS).map_err(error)?;
    let strips = Strips { entries, offsets: Vec::new(), lengths: Vec::new() };
    let code = |_, samples: &[T]| {
        let strips = samples.chunks(3 * outline.size.width * STRIP_ROWS);
        strips.map(|strip| coded(strip, outline.size.width, options.compression)).collect()
    };
    let strips = bands::code(outline.size, BAND_ROWS, strips, code, make)?;
    strips.finish().map_err(error)
}

fn error(e: TiffError) -> Error {
    Error::encoder(Format::Tiff)(e.into())
}

/// The directory of the picture, with all entries but those of its strips. The fields of the shot stand in others, before it.
fn begun<'a, W: Write + Seek, K: TiffKind>(
    file: &'a mut TiffEncoder<W, K>,
    outline: &Outline,
    options: &Options,
    metadata: &Metadata,
    bits: u8,
) -> TiffResult<DirectoryEncoder<'a, W, K>> {
    let pointers = shot_directories(file, metadata)?;
    let mut entries = file.image_directory()?;
    let (compression, predictor) = match options.compression {
        TiffCompression::None => (CompressionMethod::None, Predictor::None),
        TiffCompression::Deflate if bits == 32 => (CompressionMethod::Deflate, Predictor::None),
        TiffCompression::Deflate => (CompressionMethod::Deflate, Predictor::Horizontal),
    };
    let format = if bits == 32 { SampleFormat::IEEEFP } else { SampleFormat::Uint };
    entries.write_tag(Tag::ImageWidth, outline.size.width as u32)?;
    entries.write_tag(Tag::ImageLength, outline.size.height as u32)?;
    entries.write_tag(Tag::BitsPerSample, &[u16::from(bits); 3][..])?;
    entries.write_tag(Tag::SampleFormat, &[format.to_u16(); 3][..])?;
    entries.write_tag(Tag::SamplesPerPixel, 3_u16)?;
    entries.write_tag(Tag::PhotometricInterpretation, PhotometricInterpretation::RGB.to_u16())?;
    entries.write_tag(Tag::Compression, compression.to_u16())?;
    entries.write_tag(Tag::Predictor, predictor.to_u16())?;
    entries.write_tag(Tag::RowsPerStrip, STRIP_ROWS as u32)?;
    // Of no known size on paper.
    entries.write_tag(Tag::XResolution, Rational { n: 1, d: 1 })?;
    entries.write_tag(Tag::YResolution, Rational { n: 1, d: 1 })?;
    entries.write_tag(Tag::ResolutionUnit, ResolutionUnit::None.to_u16())?;

    write_fields(&mut entries, metadata, Directory::Image)?;
    entries.write_tag(Tag::Orientation, 1_u16)?;
    for (pointer, offset) in pointers {
        entries.write_tag(Tag::from_u16_exhaustive(pointer), offset)?;
    }
    match outline.space {
        PictureSpace::Rgb(_) => {
            let profile = profile_of(&outline.space);
            write_bytes(&mut entries, ICC_PROFILE, Type::UNDEFINED, &profile)?;
        }
        PictureSpace::Camera | PictureSpace::Raw => {
            let words = description_of_camera_rgb(metadata);
            write_bytes(&mut entries, IMAGE_DESCRIPTION, Type::ASCII, &closed(&words))?;
        }
    }
    Ok(entries)
}

/// The bytes of a strip, in the order of the machine, which is that of the file.
fn coded<T: Sample>(samples: &[T], width: usize, compression: TiffCompression) -> Result<Vec<u8>, Error> {
    match compression {
        TiffCompression::None => Ok(bytemuck::cast_slice(samples).to_vec()),
        TiffCompression::Deflate => {
            let mut differences = samples.to_vec();
            for (out, row) in differences.chunks_exact_mut(3 * width).zip(samples.chunks_exact(3 * width)) {
                for ((out, left), now) in out[3..].iter_mut().zip(row).zip(&row[3..]) {
                    *out = now.less(*left);
                }
            }
            let mut deflate = ZlibEncoder::new(Vec::new(), Compression::new(LEVEL));
            deflate
                .write_all(bytemuck::cast_slice(&differences))
                .and_then(|()| deflate.finish())
                .map_err(Error::Io)
        }
    }
}

/// The strips that are written.
struct Strips<'a, W: Write + Seek, K: TiffKind> {
    entries: DirectoryEncoder<'a, W, K>,
    offsets: Vec<K::OffsetType>,
    lengths: Vec<K::OffsetType>,
}

impl<W: Write + Seek + Send, K: TiffKind<OffsetType: Send> + Send> Sink for Strips<'_, W, K> {
    type Coded = Vec<Vec<u8>>;

    fn put(&mut self, coded: Self::Coded) -> Result<(), Error> {
        for mut strip in coded {
            self.lengths.push(K::convert_offset(strip.len() as u64).map_err(error)?);
            strip.resize(strip.len().next_multiple_of(EVEN), 0);
            let offset = self.entries.write_data(&strip[..]).map_err(error)?;
            self.offsets.push(K::convert_offset(offset).map_err(error)?);
        }
        Ok(())
    }
}

impl<W: Write + Seek, K: TiffKind> Strips<'_, W, K> {
    fn finish(mut self) -> TiffResult<()> {
        self.entries.write_tag(Tag::StripOffsets, K::convert_slice(&self.offsets))?;
        self.entries.write_tag(Tag::StripByteCounts, K::convert_slice(&self.lengths))?;
        self.entries.finish()
    }
}

/// What the numbers of camera RGB are, as no profile says it, before the caption that there was.
fn description_of_camera_rgb(metadata: &Metadata) -> String {
    let words = "Linear camera RGB, white balanced, before any colour profile: 0 is no light, the largest \
                 integer or 1.0 is white.";
    match metadata.text(Directory::Image, IMAGE_DESCRIPTION) {
        Some(caption) => format!("{words} {caption}"),
        None => words.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::bands::TakeBand;
    use crate::testing::{assert_lossless, decoded, encoded, metadata, picture};
    use crate::tiff_entries::EXIF_DIRECTORY;
    use darkroot_colour::RgbSpace;
    use darkroot_photo::Samples;
    use darkroot_photo::metadata::{Value, tag};
    use tiff::decoder::Decoder;

    const SRGB: PictureSpace = PictureSpace::Rgb(RgbSpace::SRGB);

    #[test]
    fn samples_of_8_bits_come_back() {
        assert_lossless(Format::Tiff, 8, SRGB);
    }

    #[test]
    fn samples_of_16_bits_come_back() {
        assert_lossless(Format::Tiff, 16, SRGB);
    }

    #[test]
    fn samples_of_32_bits_come_back() {
        assert_lossless(Format::Tiff, 32, PictureSpace::Camera);
    }

    #[test]
    fn samples_come_back_without_compression() {
        let options = Options { compression: TiffCompression::None, ..Options::default() };
        for bits in [8, 16, 32] {
            let picture = picture(17, 13, bits, SRGB);
            let mut file = Cursor::new(Vec::new());
            crate::write(&picture, Format::Tiff, &options, &metadata(), &mut file).unwrap();
            assert!(decoded(Format::Tiff, &file.into_inner()).1 == picture.samples, "{bits}");
        }
    }

    #[test]
    fn samples_and_fields_come_back_from_bigtiff() {
        let picture = picture(600, 400, 16, SRGB);
        let Samples::U16(samples) = &picture.samples else { panic!() };
        let outline = Outline { size: picture.size, space: SRGB };
        let mut file = Cursor::new(Vec::new());
        let mut make = |rows: usize, take: &TakeBand<'_, u16>| -> Result<(), Error> {
            samples.chunks(3 * 600 * rows).enumerate().try_for_each(|(i, band)| take(i, band))
        };
        write_kind::<TiffKindBig, _, _>(&outline, &Options::default(), &metadata(), &mut file, &mut make)
            .unwrap();
        let file = file.into_inner();
        assert_eq!(&file[..4], b"II\x2b\0");
        assert!(decoded(Format::Tiff, &file).1 == picture.samples);
        let mut reader = Decoder::new(Cursor::new(&file)).unwrap();
        assert_eq!(reader.get_tag_ascii_string(Tag::Model).unwrap(), "NIKON D700");
        let exif = reader.read_directory_tags_at(EXIF_DIRECTORY);
        assert_eq!(exif.get(&tag::ISO), Some(&400));
    }

    #[test]
    fn only_a_file_that_might_reach_4_gb_has_offsets_of_64_bits() {
        let needs = |width, height| needs_offsets_of_64_bits(Size { width, height }, 16);
        assert!(!needs(6000, 4000));
        assert!(!needs(25_000, 25_000));
        assert!(needs(26_000, 26_000));
    }

    #[test]
    fn camera_rgb_has_no_profile_but_words() {
        let mut fields = metadata();
        fields.set(Directory::Image, IMAGE_DESCRIPTION, Value::Text("Gate at noon".into()));
        let file = encoded(&picture(2, 2, 32, PictureSpace::Camera), Format::Tiff, &fields).unwrap();
        let mut reader = Decoder::new(Cursor::new(file)).unwrap();
        assert!(reader.find_tag(Tag::IccProfile).unwrap().is_none());
        let words = reader.get_tag_ascii_string(Tag::ImageDescription).unwrap();
        assert!(words.starts_with("Linear camera RGB") && words.ends_with("Gate at noon"));
    }

    trait SubDirectory {
        fn read_directory_tags_at(&mut self, pointer: u16) -> std::collections::HashMap<u16, u32>;
    }

    impl<R: std::io::Read + Seek> SubDirectory for Decoder<R> {
        /// The numbers of the directory that a tag of the first one points to.
        fn read_directory_tags_at(&mut self, pointer: u16) -> std::collections::HashMap<u16, u32> {
            let offset = self.get_tag_u64(Tag::from_u16_exhaustive(pointer)).unwrap();
            let entries = self.read_directory(tiff::tags::IfdPointer(offset)).unwrap();
            let tags: Vec<_> = entries.iter().map(|(tag, _)| tag).collect();
            let mut directory = self.read_directory_tags(&entries);
            let numbers = tags.into_iter().filter_map(|tag| {
                let value = directory.find_tag(tag).ok().flatten()?;
                Some((tag.to_u16(), value.into_u32().ok()?))
            });
            numbers.collect()
        }
    }
}
