//! What a picture says of itself: the camera's fields, what people wrote (XMP and IPTC of the raw file, its sidecar, what was
//! asked for), and what developing changed. Exif, XMP and IPTC say the same (Metadata Working Group, Guidelines for Handling
//! Image Metadata 2.0, 2010).

mod exif;
mod iptc;
mod rating;
mod sidecar;
mod spaces;
mod tags;
mod xmp;

use std::sync::Arc;

use darkroot_encode::iptc as iim;
use darkroot_photo::Capture;
use darkroot_photo::metadata::{Directory, Field, Metadata, Value, tag};

use crate::VERSION;
pub use rating::{rating, with_rating};
pub(crate) use sidecar::{Beside, beside};
pub(crate) use spaces::DARKROOT;
use spaces::{DC, EXIF, XMP, is_of_the_raw_file};
pub(crate) use tags::{Tag, parse as parse_tags};
use xmp::Said;
pub use xmp::Xmp;

/// How much of what is known of a photograph goes into its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Keep {
    /// All that still holds.
    #[default]
    All,
    /// All but where it was taken.
    NoGps,
    /// Camera, exposure, dates, photographer and copyright; no sidecar, no place, no serial numbers.
    Basic,
    /// Nothing but what the picture needs to be shown.
    None,
}

/// What a picture shall say of itself.
#[derive(Debug, Clone, Default)]
pub struct About {
    /// How much of what is known.
    pub keep: Keep,
    /// The photographer, in place of what is known.
    pub artist: Option<String>,
    /// The copyright notice, in place of what is known.
    pub copyright: Option<String>,
    /// Properties of XMP, in place of what is known.
    pub(crate) tags: Vec<Tag>,
    /// What the photograph's sidecar says.
    pub(crate) sidecar: Option<Arc<Xmp>>,
    /// Which sidecar could not be used, and why.
    pub(crate) left_out: Option<String>,
}

/// What the picture of a capture says; of its size and colours the encoder says what holds. `provenance` has names and values of how a reproduction came about.
pub(crate) fn of_picture(
    capture: &Capture,
    dpi: Option<u32>,
    about: &About,
    provenance: &[(&'static str, String)],
) -> Metadata {
    let mut fields = capture.metadata.clone();
    let mut said = said_by(&fields, about);
    said.said.retain(|name, _| !is_of_the_raw_file(&name.space, &name.local));
    fields.retain(|field| !is_block(field) && kept(field, about.keep));
    if about.keep == Keep::NoGps {
        said.said.retain(|name, _| name.space != EXIF || !name.local.starts_with("GPS"));
    }
    asked(&mut said, about);
    exif::set(&mut fields, &said);
    if about.keep != Keep::None {
        let source = if capture.rendered { ", from the camera's embedded JPEG" } else { "" };
        fields.set(Directory::Image, tag::SOFTWARE, Value::Text(format!("Darkroot {VERSION}{source}")));
        for (name, value) in provenance.iter().filter(|(_, value)| !value.is_empty()) {
            said.set(DARKROOT, name, Said::text(value));
        }
    }
    if let Some(dpi) = dpi {
        state_size(&mut fields, dpi);
    }
    let block = iim::write(&iptc::datasets(&said));
    if !block.is_empty() {
        fields.set(Directory::Image, tag::IPTC, Value::Undefined(block));
    }
    if !said.said.is_empty() {
        said.set(XMP, "CreatorTool", Said::text(&format!("Darkroot {VERSION}")));
        fields.set(Directory::Image, tag::XMP, Value::Bytes(said.packet().into_bytes()));
    }
    fields
}

/// What Exif, IPTC, XMP and the sidecar of a photograph say, each counting more than those before.
fn said_by(fields: &Metadata, about: &About) -> Xmp {
    let mut said = Xmp::default();
    if about.keep == Keep::None {
        return said;
    }
    exif::tell(fields, &mut said, about.keep == Keep::Basic);
    if about.keep == Keep::Basic {
        return said;
    }
    if let Some(block) = fields.bytes(Directory::Image, tag::IPTC) {
        said.lay(&iptc::said(&iim::read(block)));
    }
    // A packet that is none says nothing.
    let packet = fields.bytes(Directory::Image, tag::XMP).and_then(|packet| std::str::from_utf8(packet).ok());
    if let Some(xmp) = packet.and_then(|packet| Xmp::parse(packet).ok()) {
        said.lay(&xmp);
    }
    if let Some(sidecar) = &about.sidecar {
        said.lay(sidecar);
    }
    said
}

/// What was asked for counts most.
fn asked(said: &mut Xmp, about: &About) {
    if let Some(artist) = &about.artist {
        said.set(DC, "creator", tags::shaped(DC, "creator", artist));
    }
    if let Some(notice) = &about.copyright {
        said.set(DC, "rights", tags::shaped(DC, "rights", notice));
    }
    for tag in &about.tags {
        match &tag.said {
            Some(value) => said.set(&tag.name.space, &tag.name.local, value.clone()),
            None => drop(said.said.remove(&tag.name)),
        }
    }
}

fn is_block(field: &Field) -> bool {
    field.directory == Directory::Image && [tag::XMP, tag::IPTC].contains(&field.tag)
}

fn kept(field: &Field, keep: Keep) -> bool {
    /// What tells one camera, lens or person from another.
    const WHOSE: [u16; 4] = [tag::SERIAL_NUMBERS[0], tag::SERIAL_NUMBERS[1], tag::OWNER, tag::UNIQUE_ID];
    let of_place = field.directory == Directory::Gps;
    match keep {
        Keep::All => true,
        Keep::Basic if field.directory == Directory::Exif => !WHOSE.contains(&field.tag),
        Keep::NoGps | Keep::Basic => !of_place,
        Keep::None => false,
    }
}

/// What the fields say of the size on paper.
fn state_size(fields: &mut Metadata, dpi: u32) {
    const INCH: u16 = 2;
    for tag in tag::RESOLUTION {
        fields.set(Directory::Image, tag, Value::Rationals(vec![(dpi, 1)]));
    }
    fields.set(Directory::Image, tag::RESOLUTION_UNIT, Value::Shorts(vec![INCH]));
}
