//! Name spaces of XMP: those that people write into, and those that say how another file stores or renders its picture.

pub(crate) const RDF: &str = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
pub(crate) const XML: &str = "http://www.w3.org/XML/1998/namespace";
pub(crate) const DC: &str = "http://purl.org/dc/elements/1.1/";
pub(crate) const XMP: &str = "http://ns.adobe.com/xap/1.0/";
pub(crate) const PHOTOSHOP: &str = "http://ns.adobe.com/photoshop/1.0/";
pub(crate) const LR: &str = "http://ns.adobe.com/lightroom/1.0/";
pub(crate) const EXIF: &str = "http://ns.adobe.com/exif/1.0/";
pub(crate) const EXIF_EX: &str = "http://cipa.jp/exif/1.0/";
pub(crate) const AUX: &str = "http://ns.adobe.com/exif/1.0/aux/";
pub(crate) const IPTC_CORE: &str = "http://iptc.org/std/Iptc4xmpCore/1.0/xmlns/";
/// What Darkroot says of how a picture came about.
pub(crate) const DARKROOT: &str = "urn:darkroot:provenance:1#";
const TIFF: &str = "http://ns.adobe.com/tiff/1.0/";

/// Prefixes that people know name spaces by, as the metadata of exiftool and of the standards have them.
pub(crate) const PREFIXES: [(&str, &str); 19] = [
    ("dc", DC),
    ("xmp", XMP),
    ("photoshop", PHOTOSHOP),
    ("lr", LR),
    ("exif", EXIF),
    ("exifEX", EXIF_EX),
    ("aux", AUX),
    ("Iptc4xmpCore", IPTC_CORE),
    ("Iptc4xmpExt", "http://iptc.org/std/Iptc4xmpExt/2008-02-29/"),
    ("xmpRights", "http://ns.adobe.com/xap/1.0/rights/"),
    ("xmpDM", "http://ns.adobe.com/xmp/1.0/DynamicMedia/"),
    ("plus", "http://ns.useplus.org/ldf/xmp/1.0/"),
    ("digiKam", "http://www.digikam.org/ns/1.0/"),
    ("MicrosoftPhoto", "http://ns.microsoft.com/photo/1.0/"),
    ("MP", "http://ns.microsoft.com/photo/1.2/"),
    ("acdsee", "http://ns.acdsee.com/iptc/1.0/"),
    ("mediapro", "http://ns.iview-multimedia.com/mediapro/1.0/"),
    ("mwg-rs", "http://www.metadataworkinggroup.com/schemas/regions/"),
    ("darkroot", DARKROOT),
];

/// The prefix of a name space that people know.
pub(crate) fn prefix_of(space: &str) -> Option<&'static str> {
    PREFIXES.iter().find(|(_, known)| *known == space).map(|(prefix, _)| *prefix)
}

/// Whether a property of a raw file or of its sidecar says nothing of the picture that is made of it: how the raw file is
/// stored, how another program renders it, what happened to it there.
pub(crate) fn is_of_the_raw_file(space: &str, local: &str) -> bool {
    /// Name spaces, by how they begin: settings of Camera Raw and Lightroom, darktable, RawTherapee, histories, notes.
    const WHOLE: [&str; 11] = [
        TIFF,
        "http://ns.adobe.com/camera-raw",
        "http://darktable.sf.net/",
        "http://rawtherapee.com/",
        "http://ns.adobe.com/xap/1.0/mm/",
        "http://ns.adobe.com/xap/1.0/sType/",
        "http://ns.adobe.com/xmp/note/",
        "http://ns.adobe.com/hdr-gain-map/",
        "http://ns.google.com/photos/1.0/",
        "http://ns.apple.com/HDRGainMap",
        "http://ns.adobe.com/dng/",
    ];
    const EXIF_OF_STORAGE: [&str; 6] = [
        "PixelXDimension",
        "PixelYDimension",
        "ColorSpace",
        "ExifVersion",
        "FlashpixVersion",
        "NativeDigest",
    ];
    match space {
        XMP => ["MetadataDate", "ModifyDate", "CreatorTool", "Thumbnails"].contains(&local),
        PHOTOSHOP => ["SidecarForExtension", "ColorMode", "ICCProfile", "History"].contains(&local),
        DC => local == "format",
        EXIF => EXIF_OF_STORAGE.contains(&local),
        DARKROOT => true,
        space => WHOLE.iter().any(|begin| space.starts_with(begin)),
    }
}
