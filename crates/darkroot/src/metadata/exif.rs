//! What Exif and XMP both have a place for.

use darkroot_photo::metadata::{Directory, Metadata, Value, tag};

use super::spaces::{AUX, DC, EXIF, EXIF_EX, XMP};
use super::tags::shaped;
use super::xmp::Xmp;

/// Fields of Exif that people write, and their properties.
const TEXTS: [(u16, &str); 3] =
    [(tag::IMAGE_DESCRIPTION, "description"), (tag::ARTIST, "creator"), (tag::COPYRIGHT, "rights")];
/// Fields that XMP knows of files whose Exif lacks them, and their properties.
const SHOT: [(u16, &str, &str); 5] = [
    (tag::LENS_MODEL, EXIF_EX, "LensModel"),
    (tag::LENS_MODEL, AUX, "Lens"),
    (tag::SERIAL_NUMBERS[0], AUX, "SerialNumber"),
    (tag::SERIAL_NUMBERS[1], AUX, "LensSerialNumber"),
    (tag::OWNER, AUX, "OwnerName"),
];

/// What the fields of a photograph say that XMP has a place for; of a `short` telling only who made it.
pub(super) fn tell(fields: &Metadata, said: &mut Xmp, short: bool) {
    for (tag, local) in TEXTS {
        let wanted = !short || tag != tag::IMAGE_DESCRIPTION;
        if let Some(text) = fields.text(Directory::Image, tag).filter(|_| wanted) {
            said.set(DC, local, shaped(DC, local, text));
        }
    }
    if let Some(stars) = fields.number(Directory::Image, tag::RATING[0]).filter(|_| !short)
        && (1.0..=5.0).contains(&stars)
    {
        said.set(XMP, "Rating", shaped(XMP, "Rating", &format!("{stars:.0}")));
    }
}

/// Fields that say the same as the properties.
pub(super) fn set(fields: &mut Metadata, said: &Xmp) {
    for (tag, local) in TEXTS {
        match said.text(DC, local) {
            Some(text) => fields.set(Directory::Image, tag, Value::Text(text)),
            None if tag != tag::IMAGE_DESCRIPTION => {
                fields.retain(|f| (f.directory, f.tag) != (Directory::Image, tag))
            }
            None => (),
        }
    }
    for (tag, space, local) in SHOT {
        let better = |known: &str| tag == tag::LENS_MODEL && has_only_numbers(known);
        let wanted = fields.text(Directory::Exif, tag).is_none_or(better);
        if let Some(text) = said.text(space, local).filter(|_| wanted) {
            fields.set(Directory::Exif, tag, Value::Text(text));
        }
    }
    // The standard's place for it is XMP; cameras and Windows have one of their own in Exif.
    fields.retain(|field| field.directory != Directory::Image || !tag::RATING.contains(&field.tag));
    place(fields, said);
}

/// Whether a lens goes by its focal lengths and f-numbers alone ("18.0-55.0 mm f/3.5-5.6").
fn has_only_numbers(lens: &str) -> bool {
    let mut words = lens.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    words.all(|word| matches!(word, "mm" | "f" | "F"))
}

/// The position, where properties state one.
fn place(fields: &mut Metadata, said: &Xmp) {
    let at = |local, sides| said.text(EXIF, local).and_then(|text| angle(&text, sides));
    let (Some(latitude), Some(longitude)) = (at("GPSLatitude", ['N', 'S']), at("GPSLongitude", ['E', 'W']))
    else {
        return;
    };
    // Exif 2.32, 4.6.6: version, and references with values.
    fields.set(Directory::Gps, 0, Value::Bytes(vec![2, 3, 0, 0]));
    for (tag, (side, parts)) in [(1, latitude), (3, longitude)] {
        fields.set(Directory::Gps, tag, Value::Text(side.to_string()));
        fields.set(Directory::Gps, tag + 1, Value::Rationals(parts));
    }
    let height = said.text(EXIF, "GPSAltitude").and_then(|text| {
        let (above, below) = text.split_once('/').unwrap_or((&text, "1"));
        Some((above.trim().parse().ok()?, below.trim().parse().ok().filter(|&n| n > 0)?))
    });
    if let Some(height) = height {
        let below_sea = said.text(EXIF, "GPSAltitudeRef").as_deref() == Some("1");
        fields.set(Directory::Gps, 5, Value::Bytes(vec![u8::from(below_sea)]));
        fields.set(Directory::Gps, 6, Value::Rationals(vec![height]));
    }
}

/// A position as XMP writes it (part 2, GPSCoordinate: "47,22,30N" or "47,22.5N"): its side, and degrees and minutes.
fn angle(text: &str, sides: [char; 2]) -> Option<(char, Vec<(u32, u32)>)> {
    const PARTS_OF_MINUTE: f64 = 1e6;
    let text = text.trim();
    let side = text.chars().next_back().filter(|side| sides.contains(side))?;
    let parts: Option<Vec<f64>> =
        text[..text.len() - 1].split(',').map(|part| part.trim().parse().ok()).collect();
    let parts = parts.filter(|parts| (2..=3).contains(&parts.len()))?;
    let minutes = parts[1] + parts.get(2).unwrap_or(&0.0) / 60.0;
    let sane = (0.0..=180.0).contains(&parts[0]) && (0.0..=60.0).contains(&minutes);
    let minutes = (minutes * PARTS_OF_MINUTE).round() as u32;
    sane.then(|| (side, vec![(parts[0] as u32, 1), (minutes, PARTS_OF_MINUTE as u32), (0, 1)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lens_that_goes_by_numbers_gets_the_name_that_a_sidecar_knows() {
        let named = |known: &str| {
            let mut fields = Metadata::default();
            fields.set(Directory::Exif, tag::LENS_MODEL, Value::Text(known.into()));
            let mut said = Xmp::default();
            said.set(AUX, "Lens", super::super::xmp::Said::text("AF-S DX 18-55mm"));
            set(&mut fields, &said);
            fields.text(Directory::Exif, tag::LENS_MODEL).map(str::to_owned)
        };
        assert_eq!(named("18.0-55.0 mm f/3.5-5.6").as_deref(), Some("AF-S DX 18-55mm"));
        assert_eq!(named("EF24-105mm f/4L").as_deref(), Some("EF24-105mm f/4L"));
    }

    #[test]
    fn positions_are_read_in_both_forms() {
        let half = Some(('N', vec![(47, 1), (22_500_000, 1_000_000), (0, 1)]));
        assert_eq!(angle("47,22,30N", ['N', 'S']), half);
        assert_eq!(angle("47,22.5N", ['N', 'S']), half);
        for wrong in ["47,22.5E", "47N", "", "N", "470,0N", "1,2,3,4N", "a,bN", "47,22.5ü"] {
            assert_eq!(angle(wrong, ['N', 'S']), None, "{wrong}");
        }
    }
}
