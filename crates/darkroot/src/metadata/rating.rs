//! Stars of a photograph.

use darkroot_photo::Metadata;

use super::spaces::XMP;
use super::{About, asked, said_by};

/// Most stars.
const MOST_STARS: u8 = 5;

/// The property that holds them, as `set-tag` writes it.
const PROPERTY: &str = "xmp:Rating";

/// How many stars a photograph has, 0 to 5, by all that says so: Exif, XMP, sidecars, and `set-tag`, which counts most. `None`
/// where nobody says, or says that it is rejected.
pub fn rating(fields: &Metadata, about: &About) -> Option<u8> {
    let mut said = said_by(fields, about);
    asked(&mut said, about);
    let stars: f64 = said.text(XMP, "Rating")?.parse().ok()?;
    (0.0..=f64::from(MOST_STARS)).contains(&stars).then_some(stars.round() as u8)
}

/// A text of `set-tag` with so many stars, at most 5, and all else that it says.
pub fn with_rating(tags: &str, stars: u8) -> String {
    let is_other = |one: &&str| {
        let name = one.split('=').next().unwrap_or_default().trim();
        !one.is_empty() && name != PROPERTY
    };
    let others = tags.split(';').map(str::trim).filter(is_other).map(str::to_owned);
    let stars = format!("{PROPERTY}={}", stars.min(MOST_STARS));
    others.chain([stars]).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Key, Settings};

    #[test]
    fn stars_are_those_that_count_most() {
        assert_eq!(with_rating("", 4), "xmp:Rating=4");
        let tags = with_rating("dc:subject=fog, lake; xmp:Rating=2", 9);
        assert_eq!(tags, "dc:subject=fog, lake; xmp:Rating=5");
        let mut settings = Settings::default();
        assert_eq!(rating(&Metadata::default(), &settings.about), None);
        Key::named("set-tag").apply(&tags, &mut settings).unwrap();
        assert_eq!(rating(&Metadata::default(), &settings.about), Some(5));
        let mut metadata = Metadata::default();
        let stars = darkroot_photo::metadata::Value::Shorts(vec![3]);
        let tag = darkroot_photo::metadata::tag::RATING[0];
        metadata.set(darkroot_photo::metadata::Directory::Image, tag, stars);
        assert_eq!(rating(&metadata, &About::default()), Some(3));
    }
}
