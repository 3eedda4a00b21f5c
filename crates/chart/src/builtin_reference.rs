//! Reference colours built into the program: what makers publish for their charts.

use darkroot_colour::Lab;

use crate::layout::{TABLES, table};

/// Names on the command line and the tables they stand for. The makers changed their colours in November 2014.
const REFERENCES: [(&str, &str); 4] = [
    ("classic24-before-2014", "classic24_before_2014.csv"),
    ("classic24", "classic24_after_2014.csv"),
    ("sg140-before-2014", "sg140_before_2014.csv"),
    ("sg140", "sg140_after_2014.csv"),
];

/// Names of the references, for messages.
pub fn names() -> impl Iterator<Item = &'static str> {
    REFERENCES.iter().map(|(name, _)| *name)
}

/// Patches and their colours under D50 for the 2 degree observer, row by row.
pub fn builtin(name: &str) -> Option<Vec<(String, Lab)>> {
    let (_, file) = REFERENCES.iter().find(|(known, _)| *known == name)?;
    TABLES.iter().find(|(table, _)| table == file).and_then(|(_, text)| table(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reference_has_all_of_its_patches() {
        for name in names() {
            let count = if name.starts_with("sg") { 140 } else { 24 };
            assert_eq!(builtin(name).unwrap().len(), count, "{name}");
        }
        assert_eq!(builtin("unknown"), None);
    }

    #[test]
    fn the_classic_patches_are_as_published() {
        // X-Rite, "ColorChecker Classic, formulations starting November 2014": dark skin 37.54, 14.37, 14.92.
        let classic = builtin("classic24").unwrap();
        assert_eq!(classic[0], ("dark skin".to_owned(), Lab { l: 37.54, a: 14.37, b: 14.92 }));
    }
}
