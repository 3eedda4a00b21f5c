//! What a person may have meant by a word that is none.

/// The known word that a slip of the finger or two turns into the one that was typed; none where they have less in common.
pub fn nearest<'k>(typed: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    /// A second slip in a word of fewer letters makes another word of it.
    const LONG: usize = 8;
    let typed = typed.to_lowercase();
    let most = match typed.chars().count() {
        0..=2 => 0,
        letters => 1 + usize::from(letters >= LONG),
    };
    let (slips, word) = known.into_iter().map(|word| (slips(&typed, &word.to_lowercase()), word)).min()?;
    (slips <= most).then_some(word)
}

/// Letters to insert, delete, replace or swap with their neighbour between two words (optimal string alignment).
fn slips(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = vec![(0..=b.len()).collect::<Vec<usize>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let above = &rows[i - 1];
            let mut least =
                (above[j] + 1).min(row[j - 1] + 1).min(above[j - 1] + usize::from(a[i - 1] != b[j - 1]));
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_near_and_other_words_are_not() {
        let known = ["recipe", "space", "exposure", "white-balance", "D55", "D65", "FL11"];
        for (typed, meant) in [
            ("spcae", Some("space")),
            ("exposre", Some("exposure")),
            ("white_balanc", Some("white-balance")),
            ("FL-11", Some("FL11")),
            ("resize", None),
            ("sharpening", None),
            ("D6", None),
            ("", None),
        ] {
            assert_eq!(nearest(typed, known), meant, "{typed}");
        }
    }
}
