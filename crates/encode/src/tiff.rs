//! TIFF: 8 and 16 bits and floating point, in strips, with the fields of the shot in directories of their own.

use std::io::{Seek, Write};

use darkroot_photo::metadata::{Directory, Value};
use darkroot_photo::{Metadata, PictureSpace, Samples};
use tiff::decoder::ifd::Entry;
use tiff::encoder::colortype::{ColorType, RGB8, RGB16, RGB32Float};
use tiff::encoder::{
    Compression, DeflateLevel, DirectoryEncoder, Predictor, TiffEncoder, TiffKind, TiffKindBig,
    TiffKindStandard, TiffValue,
};
use tiff::tags::{Tag, Type};
use tiff::{Directory as Entries, TiffError, TiffResult};

use crate::format::Frame;
use crate::{Error, Format, Options, TiffCompression, exif};

const IMAGE_DESCRIPTION: u16 = 0x010e;
const EXIF_DIRECTORY: u16 = 0x8769;
const GPS_DIRECTORY: u16 = 0x8825;
const ICC_PROFILE: u16 = 0x8773;

pub(crate) fn write(
    frame: &Frame<'_>,
    options: &Options,
    metadata: &Metadata,
    out: &mut (impl Write + Seek),
) -> Result<(), Error> {
    let written = if needs_offsets_of_64_bits(frame) {
        write_kind::<TiffKindBig>(frame, options, metadata, out)
    } else {
        write_kind::<TiffKindStandard>(frame, options, metadata, out)
    };
    written.map_err(|e| Error::encoder(Format::Tiff)(e.into()))
}

/// Whether the file might be larger than offsets of 32 bits can say. What deflate may save is not known before.
fn needs_offsets_of_64_bits(frame: &Frame<'_>) -> bool {
    // A sixteenth is left for strips that grow, tables and metadata.
    let bits = u64::from(frame.width) * u64::from(frame.height) * 3 * u64::from(frame.samples.bits());
    bits / 8 > u64::from(u32::MAX) / 16 * 15
}

fn write_kind<K: TiffKind>(
    frame: &Frame<'_>,
    options: &Options,
    metadata: &Metadata,
    out: &mut (impl Write + Seek),
) -> TiffResult<()> {
    match frame.samples {
        Samples::U8(v) => write_samples::<K, RGB8>(frame, v, Predictor::Horizontal, options, metadata, out),
        Samples::U16(v) => write_samples::<K, RGB16>(frame, v, Predictor::Horizontal, options, metadata, out),
        Samples::F32(v) => write_samples::<K, RGB32Float>(frame, v, Predictor::None, options, metadata, out),
    }
}

fn write_samples<K: TiffKind, C: ColorType>(
    frame: &Frame<'_>,
    samples: &[C::Inner],
    predictor: Predictor,
    options: &Options,
    metadata: &Metadata,
    out: &mut (impl Write + Seek),
) -> TiffResult<()>
where
    [C::Inner]: TiffValue,
{
    let (compression, predictor) = match options.compression {
        TiffCompression::None => (Compression::Uncompressed, Predictor::None),
        TiffCompression::Deflate => (Compression::Deflate(DeflateLevel::Fast), predictor),
    };
    let mut file =
        TiffEncoder::<_, K>::new_generic(out)?.with_compression(compression).with_predictor(predictor);

    let mut pointers = Vec::new();
    for (directory, pointer) in [(Directory::Exif, EXIF_DIRECTORY), (Directory::Gps, GPS_DIRECTORY)] {
        if exif::fields(metadata).any(|field| field.directory == directory) {
            let mut entries = file.extra_directory()?;
            write_fields(&mut entries, metadata, directory)?;
            pointers.push((pointer, entries.finish_with_offsets()?.offset));
        }
    }

    let mut image = file.new_image::<C>(frame.width, frame.height)?;
    let entries = image.encoder();
    write_fields(entries, metadata, Directory::Image)?;
    entries.write_tag(Tag::Orientation, 1_u16)?;
    for (pointer, offset) in pointers {
        entries.write_tag(Tag::from_u16_exhaustive(pointer), offset)?;
    }
    match frame.space {
        PictureSpace::Rgb(_) => {
            let profile = frame.profile();
            write_bytes(entries, ICC_PROFILE, Type::UNDEFINED, &profile)?;
        }
        PictureSpace::Camera => {
            let words = description_of_camera_rgb(metadata);
            write_bytes(entries, IMAGE_DESCRIPTION, Type::ASCII, &closed(&words))?;
        }
    }
    image.write_data(samples)
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

fn write_fields<W: Write + Seek, K: TiffKind>(
    entries: &mut DirectoryEncoder<'_, W, K>,
    metadata: &Metadata,
    directory: Directory,
) -> Result<(), TiffError> {
    for field in exif::fields(metadata).filter(|field| field.directory == directory) {
        let (kind, bytes) = match &field.value {
            Value::Text(text) => (Type::ASCII, closed(text)),
            Value::Bytes(v) => (Type::BYTE, v.clone()),
            Value::Undefined(v) => (Type::UNDEFINED, v.clone()),
            Value::Shorts(v) => (Type::SHORT, v.iter().flat_map(|n| n.to_ne_bytes()).collect()),
            Value::Longs(v) => (Type::LONG, v.iter().flat_map(|n| n.to_ne_bytes()).collect()),
            Value::Rationals(v) => {
                (Type::RATIONAL, v.iter().flat_map(|&(n, d)| [n, d]).flat_map(u32::to_ne_bytes).collect())
            }
            Value::SignedRationals(v) => {
                (Type::SRATIONAL, v.iter().flat_map(|&(n, d)| [n, d]).flat_map(i32::to_ne_bytes).collect())
            }
        };
        write_bytes(entries, field.tag, kind, &bytes)?;
    }
    Ok(())
}

/// Writes a value in the byte order of the machine, which is that of the file.
fn write_bytes<W: Write + Seek, K: TiffKind>(
    entries: &mut DirectoryEncoder<'_, W, K>,
    tag: u16,
    kind: Type,
    bytes: &[u8],
) -> Result<(), TiffError> {
    let entry: Entry = entries.write_entry_bytes(kind, bytes)?;
    entries.extend_from(&Entries::from_iter([(Tag::from_u16_exhaustive(tag), entry)]));
    Ok(())
}

/// Text with its closing zero.
fn closed(text: &str) -> Vec<u8> {
    text.bytes().chain([0]).collect()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::testing::{assert_lossless, decoded, encoded, metadata, picture};
    use darkroot_colour::RgbSpace;
    use darkroot_photo::metadata::tag;
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
        let frame = Frame::of(&picture, Format::Tiff).unwrap();
        let mut file = Cursor::new(Vec::new());
        write_kind::<TiffKindBig>(&frame, &Options::default(), &metadata(), &mut file).unwrap();
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
        let samples = Samples::U16(Vec::new());
        let frame = |width, height| Frame { width, height, samples: &samples, space: &SRGB };
        assert!(!needs_offsets_of_64_bits(&frame(6000, 4000)));
        assert!(!needs_offsets_of_64_bits(&frame(25_000, 25_000)));
        assert!(needs_offsets_of_64_bits(&frame(26_000, 26_000)));
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
