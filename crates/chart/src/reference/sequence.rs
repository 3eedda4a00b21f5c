//! References that name the patches of a chart by another custom.

use super::{Reference, ReferenceColour, key};

/// How the patches of a chart stand in a reference that has other names for them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sequence {
    /// As they stand in the file.
    File,
    /// By numbers from 1 on.
    Numbers,
    /// By a letter for the row and a number for the column.
    RowLetters,
    /// By a letter for the column and a number for the row.
    ColumnLetters,
}

impl std::fmt::Display for Sequence {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str(match self {
            Self::File => "in the sequence of the file",
            Self::Numbers => "by their numbers",
            Self::RowLetters => "by letters for rows and numbers for columns",
            Self::ColumnLetters => "by letters for columns and numbers for rows",
        })
    }
}

impl Reference {
    /// The colours of as many patches row by row, in every way in which they may be meant.
    pub fn in_sequence(&self, columns: usize, rows: usize) -> Vec<(Sequence, Vec<ReferenceColour>)> {
        if self.patches.len() != columns * rows {
            return Vec::new();
        }
        let places = |place: &dyn Fn(&str) -> Option<usize>| -> Option<Vec<ReferenceColour>> {
            let mut sorted = vec![None; self.patches.len()];
            for (name, colour) in &self.patches {
                let slot = sorted.get_mut(place(name)?)?;
                if slot.replace(colour.clone()).is_some() {
                    return None;
                }
            }
            sorted.into_iter().collect()
        };
        let number = |text: &str| text.parse::<usize>().ok()?.checked_sub(1);
        let cell = |name: &str| {
            let plain = key(name);
            let letter = plain.chars().next().filter(char::is_ascii_lowercase)?;
            Some((letter as usize - 'a' as usize, number(&plain[1..])?))
        };
        let within =
            |row: usize, column: usize| (row < rows && column < columns).then_some(row * columns + column);
        let all = [
            (Sequence::File, Some(self.patches.iter().map(|(_, colour)| colour.clone()).collect())),
            (Sequence::Numbers, places(&|name| number(&key(name)))),
            (Sequence::RowLetters, places(&|name| cell(name).and_then(|(letter, n)| within(letter, n)))),
            (Sequence::ColumnLetters, places(&|name| cell(name).and_then(|(letter, n)| within(n, letter)))),
        ];
        all.into_iter().filter_map(|(sequence, colours)| Some((sequence, colours?))).collect()
    }
}

#[cfg(test)]
mod tests {
    use darkroot_colour::Lab;

    use super::*;

    #[test]
    fn patches_of_other_names_stand_in_a_sequence() {
        let lab = |l: f64| ReferenceColour::Lab(Lab { l, a: 0.0, b: 0.0 });
        let reference = |names: &[&str]| Reference {
            patches: names.iter().enumerate().map(|(i, n)| ((*n).to_owned(), lab(i as f64))).collect(),
        };
        let found = |names: &[&str], sequence: Sequence| {
            let all = reference(names).in_sequence(3, 2);
            all.into_iter().find(|(s, _)| *s == sequence).map(|(_, colours)| colours)
        };
        let order = |places: [usize; 6]| Some(places.map(|i| lab(i as f64)).to_vec());
        assert_eq!(found(&["b", "c", "d", "e", "f", "g"], Sequence::File), order([0, 1, 2, 3, 4, 5]));
        assert_eq!(found(&["6", "5", "4", "3", "2", "01"], Sequence::Numbers), order([5, 4, 3, 2, 1, 0]));
        let columns = ["A1", "A2", "B1", "B2", "C1", "C2"];
        assert_eq!(found(&columns, Sequence::ColumnLetters), order([0, 2, 4, 1, 3, 5]));
        assert_eq!(found(&columns, Sequence::RowLetters), None);
        assert_eq!(
            found(&["A1", "A2", "A3", "B1", "B2", "B3"], Sequence::RowLetters),
            order([0, 1, 2, 3, 4, 5])
        );
        assert!(reference(&["1", "2"]).in_sequence(3, 2).is_empty());
    }
}
