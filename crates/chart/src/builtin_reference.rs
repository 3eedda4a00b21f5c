//! References built into the program: what makers publish for their charts, and spectra that were measured.

use crate::layout::{TABLES, table};
use crate::reference::{Reference, ReferenceColour};

/// Names on the command line and the tables they stand for. The makers changed their colours in November 2014.
const PUBLISHED: [(&str, &str); 4] = [
    ("classic24-before-2014", "classic24_before_2014.csv"),
    ("classic24", "classic24_after_2014.csv"),
    ("sg140-before-2014", "sg140_before_2014.csv"),
    ("sg140", "sg140_after_2014.csv"),
];

/// Spectra of one chart. They are no part of what the fits know of surfaces in general, because the SG judges those.
const MEASURED: [(&str, &str); 1] = [("sg140-measured", include_str!("../data/sg140_measured.csv"))];

/// Names of the references, for messages.
pub fn names() -> impl Iterator<Item = &'static str> {
    PUBLISHED.iter().chain(&MEASURED).map(|(name, _)| *name)
}

/// Patches row by row: their colours under D50 for the 2 degree observer, or their reflectances.
pub fn builtin(name: &str) -> Option<Reference> {
    if let Some((_, text)) = MEASURED.iter().find(|(known, _)| *known == name) {
        return Reference::parse(text).ok();
    }
    let (_, file) = PUBLISHED.iter().find(|(known, _)| *known == name)?;
    let patches = TABLES.iter().find(|(table, _)| table == file).and_then(|(_, text)| table(text))?;
    let patches = patches.into_iter().map(|(name, lab)| (name, ReferenceColour::Lab(lab))).collect();
    Some(Reference { patches })
}

/// The references that a chart may be one of, by the name of its layout: first the maker's present colours, which count
/// where nothing tells more. Charts of the 24 classic patches have the same ones, whatever their size.
pub fn of_layout(layout: &str) -> &'static [&'static str] {
    match layout {
        "classic24" | "passport24" | "mini24" | "nano24" => &["classic24", "classic24-before-2014"],
        "sg140" => &["sg140", "sg140-before-2014", "sg140-measured"],
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ChartLayout;
    use darkroot_colour::difference::de2000;
    use darkroot_colour::{Lab, white};

    #[test]
    fn every_reference_has_all_of_its_patches() {
        for name in names() {
            let count = if name.starts_with("sg") { 140 } else { 24 };
            assert_eq!(builtin(name).unwrap().patches.len(), count, "{name}");
        }
        assert_eq!(builtin("unknown"), None);
        for layout in ChartLayout::builtin() {
            assert!(of_layout(&layout.name).iter().all(|name| builtin(name).is_some()));
        }
    }

    #[test]
    fn the_classic_patches_are_as_published() {
        // X-Rite, "ColorChecker Classic, formulations starting November 2014": dark skin 37.54, 14.37, 14.92.
        let classic = builtin("classic24").unwrap();
        let dark_skin = ReferenceColour::Lab(Lab { l: 37.54, a: 14.37, b: 14.92 });
        assert_eq!(classic.patches[0], ("dark skin".to_owned(), dark_skin));
    }

    /// Columns taken for rows would be off by dE2000 38 in the mean.
    #[test]
    fn the_measured_patches_are_those_that_the_maker_publishes() {
        let measured = builtin("sg140-measured").unwrap();
        for (published, most) in [("sg140", 0.85), ("sg140-before-2014", 0.65)] {
            let published = builtin(published).unwrap();
            let pairs = measured.patches.iter().zip(&published.patches);
            let off = pairs.map(|((name, a), (other, b))| {
                assert_eq!(name, other);
                de2000(a.xyz_d50().lab(white::D50), b.xyz_d50().lab(white::D50))
            });
            let mean = off.sum::<f64>() / 140.0;
            assert!(mean < most, "{mean}");
        }
    }
}
