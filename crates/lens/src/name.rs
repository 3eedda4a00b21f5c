//! Names of makers, cameras and lenses as words, those of lenses sorted, so that spelling does not matter: "EF-S18-55mm f/3.5-5.6" and
//! "Canon EF-S 18-55mm F3.5-5.6" have the same, but for the maker.

/// No name is longer; what comes after is not read.
const LONGEST: usize = 200;

/// Words that say nothing.
const EMPTY: [&str; 5] = ["mm", "f", "mmf", "lens", "fmm"];

/// Words that makers write or leave out for one and the same lens.
const WEAK: [&str; 9] = ["zoom", "ed", "if", "al", "asph", "aspherical", "digital", "power", "mega"];

/// Words that cameras of a maker leave out of the names of its lenses.
const OMITTED: [(&str, &[&str]); 2] = [("olympus", &["pro", "is"]), ("panasonic", &["ois"])];

/// Words of firms, not of their names.
const FIRM: [&str; 18] = [
    "ag",
    "aktiengesellschaft",
    "camera",
    "cameras",
    "co",
    "company",
    "computer",
    "corp",
    "corporation",
    "electronics",
    "imaging",
    "inc",
    "ltd",
    "mobile",
    "optical",
    "solutions",
    "technology",
    "techwin",
];

/// Names under which one maker's lenses go. A name in two rows joins those makers.
const BRANDS: [&[&str]; 9] = [
    &["nikon", "nikkor"],
    &["olympus", "om", "zuiko", "system"],
    &["panasonic", "lumix", "leica"],
    &["pentax", "ricoh", "asahi"],
    &["zeiss", "carl"],
    &["minolta", "konica", "sony"],
    &["fujifilm", "fujinon", "fuji"],
    &["venus", "laowa"],
    &["samyang", "rokinon"],
];

/// Words of a name of a maker or camera as they come (a Canon EOS D2000 is no EOS 2000D): runs of letters or of digits
/// in small letters, numbers without closing zeros.
pub(crate) fn words(text: &str) -> Vec<String> {
    let text: String = text.chars().take(LONGEST).collect();
    let mut found = Vec::new();
    split(&text.to_lowercase(), &mut found);
    found
}

/// Words of a lens's name, sorted, without what says nothing: "mm", "f/", "1:", and the maker's number of a model
/// ("A007N", "018", "(SEL35F14GM)").
pub(crate) fn lens_words(text: &str) -> Vec<String> {
    let text: String = text.chars().take(LONGEST).collect();
    let text = text.to_lowercase().replace("o.i.s.", "ois").replace("1:", " ");
    let mut found = Vec::new();
    for (index, part) in text.split_whitespace().enumerate() {
        let bare = part.trim_matches(|c: char| !c.is_alphanumeric());
        if index > 0 && is_model_number(part, bare) {
            continue;
        }
        // The three lines of Sigma.
        match bare {
            "art" => found.push("a".to_owned()),
            "contemporary" => found.push("c".to_owned()),
            "sports" | "sport" => found.push("s".to_owned()),
            _ => split(part, &mut found),
        }
    }
    found.retain(|word| !EMPTY.contains(&word.as_str()));
    found.sort_unstable();
    // "Contemporary C 016".
    found.dedup_by(|a, b| a == b && !is_number(a));
    found
}

/// Runs of letters, numbers, stars and pluses.
fn split(part: &str, found: &mut Vec<String>) {
    let mut chars = part.chars().peekable();
    while let Some(first) = chars.next() {
        let mut word = String::from(first);
        if first.is_numeric() {
            while let Some(c) = chars.next_if(|c| c.is_numeric() || *c == '.') {
                word.push(c);
            }
            found.push(plain_number(word.trim_end_matches('.')));
        } else if first.is_alphabetic() {
            while let Some(c) = chars.next_if(|c| c.is_alphabetic()) {
                word.push(c);
            }
            found.push(word);
        } else if matches!(first, '*' | '+') {
            found.push(word);
        }
    }
}

/// A number without zeros at its end: "18.0" is "18".
fn plain_number(word: &str) -> String {
    match word.split_once('.') {
        Some(_) => word.trim_end_matches('0').trim_end_matches('.').to_owned(),
        None => word.to_owned(),
    }
}

/// Whether a part of a name is the maker's number of the model.
fn is_model_number(part: &str, bare: &str) -> bool {
    let letters: Vec<char> = bare.chars().collect();
    let digits = |range: &[char]| range.iter().all(char::is_ascii_digit);
    match letters.as_slice() {
        ['0', a, b] => digits(&[*a, *b]),
        [first, a, b, c, rest @ ..] => {
            let number = first.is_ascii_alphabetic() && digits(&[*a, *b, *c]);
            let tamron = number && rest.len() <= 1 && rest.iter().all(char::is_ascii_alphabetic);
            tamron || (part.starts_with('(') && (bare.starts_with("sel") || bare.starts_with("sal")))
        }
        _ => false,
    }
}

/// Whether a word is a number.
pub(crate) fn is_number(word: &str) -> bool {
    word.starts_with(|first: char| first.is_ascii_digit())
}

/// The words that are numbers.
pub(crate) fn numbers(words: &[String]) -> Vec<&str> {
    words.iter().map(String::as_str).filter(|word| is_number(word)).collect()
}

/// What a maker goes by, from names of the firm: its words, and the names under which its lenses go.
pub(crate) fn brand<'a>(makers: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut found: Vec<String> =
        makers.into_iter().flat_map(words).filter(|w| !FIRM.contains(&w.as_str())).collect();
    let own = found.len();
    for row in BRANDS {
        if found[..own].iter().any(|word| row.contains(&word.as_str())) {
            found.extend(row.iter().map(|word| (*word).to_owned()));
        }
    }
    found
}

/// Whether a name has the words by which Sigma, and nobody else, names its lenses. Other makers' bodies do
/// not write whose a lens is.
pub(crate) fn is_sigma(words: &[String]) -> bool {
    let has = |word: &str| words.iter().any(|w| w == word);
    has("dg") && (has("hsm") || has("dn") || has("os")) || has("dc") && (has("hsm") || has("dn"))
}

/// How many words the name of a lens of a maker differs in from the one asked for, if all of these say little; `None` if
/// one matters. Both sorted.
pub(crate) fn difference(asked: &[String], known: &[String], brand: &[String]) -> Option<usize> {
    let is_omitted = |word: &str| {
        OMITTED.iter().any(|(maker, words)| words.contains(&word) && brand.iter().any(|name| name == maker))
    };
    let (mut i, mut j, mut count) = (0, 0, 0);
    while i < asked.len() || j < known.len() {
        let (odd, is_known) = match (asked.get(i), known.get(j)) {
            (Some(a), Some(b)) if a == b => {
                (i, j) = (i + 1, j + 1);
                continue;
            }
            (Some(a), b) if b.is_none_or(|b| a < b) => {
                i += 1;
                (a, false)
            }
            (_, Some(b)) => {
                j += 1;
                (b, true)
            }
            (Some(_), None) | (None, None) => return None,
        };
        if !(WEAK.contains(&odd.as_str()) || is_known && is_omitted(odd)) {
            return None;
        }
        count += 1;
    }
    Some(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn differ(one: &str, other: &str) -> Option<usize> {
        difference(&lens_words(one), &lens_words(other), &brand(["Panasonic"]))
    }

    #[test]
    fn spelling_does_not_matter() {
        assert_eq!(lens_words("EF-S18-55mm f/3.5-5.6"), ["18", "3.5", "5.6", "55", "ef", "s"]);
        assert_eq!(differ("XF18-55mmF2.8-4 R LM OIS", "XF 18-55mm f/2.8-4.0 R LM OIS"), Some(0));
        assert_eq!(differ("24-70mm F2.8 DG DN | Art 019", "24-70mm f/2.8 DG DN [A]"), Some(0));
        assert_eq!(differ("SP 24-70mm F/2.8 Di VC USD A007N", "SP 24-70mm F/2.8 Di VC USD"), Some(0));
        assert_eq!(differ("FE 35mm F1.4 GM", "FE 35mm f/1.4 GM (SEL35F14GM)"), Some(0));
        assert_eq!(differ("smc PENTAX-M 1:4 50mm", "smc Pentax-M 50mm f/4"), Some(0));
    }

    #[test]
    fn words_that_name_another_lens_matter() {
        assert_eq!(differ("18-55mm f/3.5-5.6G VR", "18-55mm f/3.5-5.6G VR II"), None);
        assert_eq!(differ("18-55mm f/3.5-5.6G ED VR", "Zoom 18-55mm f/3.5-5.6G VR"), Some(2));
        assert_eq!(differ("150-600mm F5-6.3 | Contemporary", "150-600mm F5-6.3 | Sports"), None);
        assert_eq!(differ("50mm f/1.8", "50mm f/1.4"), None);
        assert_eq!(differ("DA* 16-50mm", "DA 16-50mm"), None);
        assert_eq!(differ("", ""), Some(0));
        // Left out by the camera, never added.
        assert_eq!(differ("12-32/F3.5-5.6", "12-32mm f/3.5-5.6 Asph. Mega OIS"), Some(3));
        assert_eq!(differ("12-32/F3.5-5.6 Asph. Mega OIS", "12-32mm f/3.5-5.6"), None);
    }

    #[test]
    fn makers_go_by_more_than_one_name() {
        assert!(brand(["NIKON CORPORATION"]).contains(&"nikkor".to_owned()));
        assert!(brand(["OM Digital Solutions"]).contains(&"olympus".to_owned()));
        assert!(!brand(["Panasonic"]).contains(&"corporation".to_owned()));
        assert!(brand([""]).is_empty());
    }
}
