//! Ultra HDR: a JPEG that any program shows, and behind it a second one that says how much brighter each place is on a screen that
//! can show it (ISO 21496-1:2025; Android, "Ultra HDR Image Format", 1.1; CIPA DC-007, Multi-Picture Format).
//!
//! Both ways of saying what the second picture means are written: the binary one of the standard, and XMP, which older readers
//! take. Libraries were looked at: ultrahdr-core is young, changes its interface and has a licence that does not fit; libultrahdr is
//! C++ with a JPEG encoder of its own.

use std::io::{Seek, Write};

use darkroot_photo::Size;
use jpeg_encoder::{ColorType, Encoder, EncodingError};

use crate::output::{Buffered, fill};
use crate::{Error, Format};

/// How much brighter a picture is where there is room above white.
#[derive(Debug, Clone, PartialEq)]
pub struct GainMap {
    /// Its size, any share of the picture's, in pixels: at most 65,535 a side.
    pub size: Size,
    /// Gain of each pixel, row by row: 0 for none, 255 for [`Self::most`].
    pub samples: Vec<u8>,
    /// The largest gain, stops.
    pub most: f64,
}

/// What is added to light of 0 to 1 before it is divided, so that black divides.
pub const OFFSET: f64 = 1.0 / 64.0;

/// JPEG quality of the second picture: it is small and smooth.
const QUALITY: u8 = 90;

/// Name of the segments of the standard.
const ISO: &[u8] = b"urn:iso:std:iso:ts:21496:-1\0";
/// The only version there is: what a reader must know, and what was written.
const VERSION: [u8; 4] = [0; 4];
/// The gain is that of the base picture's own primaries.
const OF_BASE_COLOURS: u8 = 0x40;

/// The second picture as a file.
pub(super) fn file(map: &GainMap) -> Result<Vec<u8>, Error> {
    let made = || -> Result<Vec<u8>, EncodingError> {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, QUALITY);
        encoder.add_app_segment(1, [XMP, meaning(map).as_bytes()].concat())?;
        encoder.add_app_segment(2, [ISO, &numbers(map)].concat())?;
        encoder.encode(&map.samples, map.size.width as u16, map.size.height as u16, ColorType::Luma)?;
        Ok(file)
    };
    made().map_err(|e| Error::encoder(Format::Jpeg)(e.into()))
}

/// What the gains mean, as the standard has it.
fn numbers(map: &GainMap) -> Vec<u8> {
    const UNIT: u32 = 1_000_000;
    let fraction =
        |v: f64| [((v * f64::from(UNIT)).round() as u32).to_be_bytes(), UNIT.to_be_bytes()].concat();
    let (base_headroom, gamma) = (0.0, 1.0);
    let values = [base_headroom, map.most, 0.0, map.most, gamma, OFFSET, OFFSET];
    let mut out = VERSION.to_vec();
    out.push(OF_BASE_COLOURS);
    out.extend(values.into_iter().flat_map(fraction));
    out
}

/// Head of a segment with XMP (XMP specification, part 3, 1.1.3).
const XMP: &[u8] = b"http://ns.adobe.com/xap/1.0/\0";

/// The same as a packet of XMP.
fn meaning(map: &GainMap) -> String {
    let most = map.most;
    packet(&format!(
        "<rdf:Description rdf:about=\"\" xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" hdrgm:Version=\"1.0\" \
         hdrgm:GainMapMin=\"0\" hdrgm:GainMapMax=\"{most:.6}\" hdrgm:Gamma=\"1\" hdrgm:OffsetSDR=\"{OFFSET}\" \
         hdrgm:OffsetHDR=\"{OFFSET}\" hdrgm:HDRCapacityMin=\"0\" hdrgm:HDRCapacityMax=\"{most:.6}\" \
         hdrgm:BaseRenditionIsHDR=\"False\"/>"
    ))
}

const END_OF_RDF: &str = "</rdf:RDF>";

fn packet(content: &str) -> String {
    format!(
        "<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?><x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\
         <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">{content}{END_OF_RDF}</x:xmpmeta>\
         <?xpacket end=\"w\"?>"
    )
}

/// The XMP of the first picture, which names the second; what it says besides stays.
pub(super) fn naming(xmp: &[u8], length: usize) -> Vec<u8> {
    const ITEM: &str =
        "<rdf:li rdf:parseType=\"Resource\"><Container:Item Item:Mime=\"image/jpeg\" Item:Semantic=";
    let content = format!(
        "<rdf:Description rdf:about=\"\" xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" \
         xmlns:Container=\"http://ns.google.com/photos/1.0/container/\" \
         xmlns:Item=\"http://ns.google.com/photos/1.0/container/item/\" hdrgm:Version=\"1.0\">\
         <Container:Directory><rdf:Seq>{ITEM}\"Primary\"/></rdf:li>{ITEM}\"GainMap\" Item:Length=\"{length}\"/></rdf:li>\
         </rdf:Seq></Container:Directory></rdf:Description>"
    );
    let text = std::str::from_utf8(xmp).unwrap_or_default();
    match text.rfind(END_OF_RDF) {
        Some(end) => [&text[..end], &content, &text[end..]].concat(),
        None => packet(&content),
    }
    .into_bytes()
}

/// Segments of the first picture: that there is a gain map, and where the second picture is. Sizes are 0 until [`settle`] is called.
pub(super) fn segments() -> [Vec<u8>; 2] {
    [[ISO, &VERSION[..]].concat(), [MPF, &directory([0; 3])[..]].concat()]
}

const MPF: &[u8] = b"MPF\0";

/// The directory of two pictures: length of the first, length of the second, and where it begins behind this directory's start.
fn directory([first, second, place]: [u32; 3]) -> Vec<u8> {
    // The first is the one that is shown (CIPA DC-007, 5.2.3.3.1), the second of no kind that has a number.
    const SHOWN: u32 = 0x0003_0000;
    let entries: [([u16; 2], u32, [u8; 4]); 3] = [
        ([0xb000, 7], 4, *b"0100"),
        ([0xb001, 4], 1, 2u32.to_be_bytes()),
        ([0xb002, 7], 32, 50u32.to_be_bytes()),
    ];
    let mut out = b"MM\0\x2a\0\0\0\x08\0\x03".to_vec();
    for (head, count, value) in entries {
        out.extend(head.into_iter().flat_map(u16::to_be_bytes));
        out.extend(count.to_be_bytes());
        out.extend(value);
    }
    out.extend([0; 4]);
    for number in [SHOWN, first, 0, 0, 0, second, place, 0] {
        out.extend(number.to_be_bytes());
    }
    out
}

/// Writes the second picture behind the first, which has been written from `start` on with `header` as its beginning, and says in
/// the first where it is.
pub(super) fn settle(
    header: &[u8],
    start: u64,
    second: &[u8],
    out: &mut Buffered<'_, '_>,
) -> Result<(), Error> {
    let first = out.stream_position().map_err(Error::Io)? - start;
    out.write_all(second).map_err(Error::Io)?;
    let Some(at) = header.windows(MPF.len()).rposition(|w| w == MPF).map(|at| at + MPF.len()) else {
        return Ok(());
    };
    let sizes = [first as u32, second.len() as u32, first as u32 - at as u32];
    fill(out, &[(start + at as u64, &directory(sizes))])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{metadata, picture};
    use crate::{ChromaSubsampling, Options};
    use darkroot_colour::RgbSpace;
    use darkroot_photo::metadata::{Directory, Value, tag};
    use darkroot_photo::{Metadata, PictureSpace};
    use std::sync::Arc;

    fn with_map(progressive: bool, metadata: &Metadata) -> Vec<u8> {
        let map = GainMap { size: Size { width: 50, height: 40 }, samples: vec![128; 2000], most: 2.0 };
        let subsampling = ChromaSubsampling::S420;
        let options =
            Options { gain_map: Some(Arc::new(map)), progressive, subsampling, ..Options::default() };
        let mut file = std::io::Cursor::new(Vec::new());
        let picture = picture(200, 160, 8, PictureSpace::Rgb(RgbSpace::DISPLAY_P3));
        crate::write(&picture, Format::Jpeg, &options, metadata, &mut file).unwrap();
        file.into_inner()
    }

    /// A big-endian number.
    fn number(file: &[u8], at: usize) -> usize {
        u32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize
    }

    #[test]
    fn the_second_picture_lies_where_the_first_says() {
        let mut metadata = metadata();
        let said = packet("<rdf:Description rdf:about=\"\"><x:said/></rdf:Description>");
        metadata.set(Directory::Image, tag::XMP, Value::Bytes(said.into_bytes()));
        for progressive in [false, true] {
            let file = with_map(progressive, &metadata);
            let start = file.windows(4).position(|w| w == MPF).unwrap() + 4;
            let entries = start + 50;
            let (first, second) = (number(&file, entries + 4), number(&file, entries + 20));
            let place = start + number(&file, entries + 24);
            assert_eq!((place, place + second), (first, file.len()));
            let map = image::load_from_memory(&file[place..]).unwrap().into_luma8();
            assert!(map.dimensions() == (50, 40) && map.pixels().all(|p| p.0[0].abs_diff(128) < 2));
            assert_eq!(image::load_from_memory(&file[..first]).unwrap().width(), 200);
            let text = String::from_utf8_lossy(&file[..first]);
            assert!(text.contains(&format!("Item:Length=\"{second}\"")) && text.contains("<x:said/>"));
            assert!(file[place..].windows(ISO.len()).any(|w| w == ISO));
        }
    }

    #[test]
    fn without_a_map_nothing_is_said_of_one() {
        let picture = picture(20, 16, 8, PictureSpace::Rgb(RgbSpace::SRGB));
        let file = crate::testing::encoded(&picture, Format::Jpeg, &metadata()).unwrap();
        assert!(!file.windows(4).any(|w| w == MPF) && !file.windows(ISO.len()).any(|w| w == ISO));
    }
}
