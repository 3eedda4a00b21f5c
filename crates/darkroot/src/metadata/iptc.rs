//! Which property of XMP is which dataset of IPTC-IIM (IPTC Photo Metadata Standard 2023.2, mapping of its appendix).

use darkroot_encode::iptc::Dataset;

use super::spaces::{DC, IPTC_CORE, PHOTOSHOP};
use super::tags::shaped;
use super::xmp::{List, Said, Xmp};

/// Dataset and property.
const SAME: [(u8, &str, &str); 18] = [
    (5, DC, "title"),
    (25, DC, "subject"),
    (40, PHOTOSHOP, "Instructions"),
    (55, PHOTOSHOP, "DateCreated"),
    (80, DC, "creator"),
    (85, PHOTOSHOP, "AuthorsPosition"),
    (90, PHOTOSHOP, "City"),
    (92, IPTC_CORE, "Location"),
    (95, PHOTOSHOP, "State"),
    (100, IPTC_CORE, "CountryCode"),
    (101, PHOTOSHOP, "Country"),
    (103, PHOTOSHOP, "TransmissionReference"),
    (105, PHOTOSHOP, "Headline"),
    (110, PHOTOSHOP, "Credit"),
    (115, PHOTOSHOP, "Source"),
    (116, DC, "rights"),
    (120, DC, "description"),
    (122, PHOTOSHOP, "CaptionWriter"),
];
/// A day without its time.
const DATE: u8 = 55;

/// What the datasets say.
pub(super) fn said(datasets: &[Dataset]) -> Xmp {
    let mut xmp = Xmp::default();
    for &(number, space, local) in &SAME {
        let texts: Vec<&str> = datasets
            .iter()
            .filter(|(dataset, text)| *dataset == number && !text.trim().is_empty())
            .map(|(_, text)| text.trim())
            .collect();
        let Some(first) = texts.first() else { continue };
        let value = match shaped(space, local, first) {
            Said::Many(List::Alt, _) => shaped(space, local, first),
            Said::Many(list, _) => Said::Many(list, texts.iter().map(|text| Said::text(text)).collect()),
            _ if number == DATE => match day(first) {
                Some(day) => Said::text(&day),
                None => continue,
            },
            one => one,
        };
        xmp.set(space, local, value);
    }
    xmp
}

/// 20261127 as 2026-11-27.
fn day(text: &str) -> Option<String> {
    let digits = text.len() == 8 && text.bytes().all(|b| b.is_ascii_digit()) && !text.starts_with("0000");
    digits.then(|| format!("{}-{}-{}", &text[..4], &text[4..6], &text[6..]))
}

/// What is said, as datasets.
pub(super) fn datasets(xmp: &Xmp) -> Vec<Dataset> {
    let of = |&(number, space, local): &(u8, &str, &str)| -> Vec<Dataset> {
        let Some(value) = xmp.get(space, local) else { return Vec::new() };
        let texts = match value {
            Said::Many(List::Alt, _) => xmp.text(space, local).into_iter().collect(),
            value => value.texts().into_iter().map(str::to_owned).collect::<Vec<_>>(),
        };
        let texts = texts.into_iter().filter_map(|text| {
            if number != DATE {
                return Some(text);
            }
            let day: String = text.chars().take(10).filter(|&c| c != '-').collect();
            (day.len() == 8 && day.bytes().all(|b| b.is_ascii_digit())).then_some(day)
        });
        texts.filter(|text| !text.trim().is_empty()).map(|text| (number, text)).collect()
    };
    SAME.iter().flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn datasets_come_back_through_xmp() {
        let datasets: Vec<Dataset> = [
            (5, "Fog"),
            (25, "fog"),
            (25, "lake, deep"),
            (55, "20261127"),
            (80, "A"),
            (80, "B"),
            (90, "Bern"),
        ]
        .map(|(number, text)| (number, text.to_owned()))
        .to_vec();
        let xmp = said(&datasets);
        assert_eq!(xmp.text(PHOTOSHOP, "DateCreated").as_deref(), Some("2026-11-27"));
        assert_eq!(super::datasets(&xmp), datasets);
        assert!(said(&[(55, "today".to_owned()), (5, " ".to_owned())]).said.is_empty());
    }
}
