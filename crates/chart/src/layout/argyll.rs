//! Argyll's chart recognition files (.cht): where the boxes are and about which colours they have
//! (Argyll CMS, "File Formats", Chart Recognition).

use darkroot_colour::statistics::median;
use darkroot_colour::{Lab, Xyz, white};

use super::{ChartLayout, Hinge, LayoutError, PatchPlace};

/// More boxes than any chart has: a bound for hostile files.
const MOST_BOXES: usize = 4000;
/// How far boxes of one column may be apart, and columns from equal steps, in box widths.
const TOLERANCE: f64 = 0.06;

struct Patch {
    name: String,
    centre: [f64; 2],
    size: [f64; 2],
}

/// The layout of a file; ranges are not checked.
pub(super) fn layout(name: &str, text: &str) -> Result<ChartLayout, LayoutError> {
    let boxes = boxes(text)?;
    let first = boxes.first().ok_or(LayoutError::NotAGrid("it has no boxes"))?;
    let size = first.size;
    if boxes.iter().any(|b| (0..2).any(|k| (b.size[k] / size[k] - 1.0).abs() > TOLERANCE)) {
        return Err(LayoutError::NotAGrid("boxes differ in size"));
    }
    let columns = steps(boxes.iter().map(|b| b.centre[0]), size[0]);
    let rows = steps(boxes.iter().map(|b| b.centre[1]), size[1]);
    let (gap, hinge) = gaps(&columns, size[0])?;
    let (_, none) = gaps(&rows, size[1])?;
    if none.is_some() {
        return Err(LayoutError::NotAGrid("rows are not at equal steps"));
    }
    let colours = expected(text)?;
    let mut patches = Vec::new();
    for y in &rows {
        for x in &columns {
            let near = |b: &&Patch| {
                (b.centre[0] - x).abs() < TOLERANCE * size[0] && (b.centre[1] - y).abs() < TOLERANCE * size[1]
            };
            let found = boxes.iter().find(near).ok_or(LayoutError::NotAGrid("boxes are missing in it"))?;
            let lab = colours.iter().find(|(name, _)| same_name(name, &found.name)).map(|(_, lab)| *lab);
            let lab = lab.ok_or_else(|| LayoutError::NoColour(found.name.clone()))?;
            patches.push(PatchPlace { name: found.name.clone(), lab });
        }
    }
    let (columns, rows) = (columns.len(), rows.len());
    let (name, title) = (name.to_owned(), name.to_owned());
    Ok(ChartLayout { name, title, columns, rows, gap, hinge, patches, beside: None })
}

/// "A1" and "A01" are the same box.
fn same_name(one: &str, two: &str) -> bool {
    let split = |name: &str| {
        let letters = name.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
        let number = name[letters.len()..].trim_start_matches('0').to_owned();
        (letters, number)
    };
    split(one) == split(two)
}

/// The sorted different values.
fn steps(values: impl Iterator<Item = f64>, size: f64) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| (*b - *a).abs() < TOLERANCE * size);
    values
}

/// Gap and hinge of sorted columns.
fn gaps(centres: &[f64], size: f64) -> Result<(f64, Option<Hinge>), LayoutError> {
    let mut steps: Vec<f64> = centres.windows(2).map(|w| (w[1] - w[0]) / size).collect();
    let unsorted = steps.clone();
    let usual = median(&mut steps).ok_or(LayoutError::NotAGrid("it has a single column or row"))?;
    let mut other = unsorted.iter().enumerate().filter(|(_, s)| (**s - usual).abs() > TOLERANCE);
    let hinge = other.next().map(|(i, s)| Hinge { after: i + 1, width: s - usual });
    if other.next().is_some() || hinge.is_some_and(|h| h.width < 0.0) {
        return Err(LayoutError::NotAGrid("its boxes are not at equal steps"));
    }
    Ok((usual - 1.0, hinge))
}

fn boxes(text: &str) -> Result<Vec<Patch>, LayoutError> {
    let mut boxes = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some(kind @ ("X" | "Y")) = words.first().copied() else { continue };
        let wrong = |what| LayoutError::Cht { line: number + 1, what };
        let [_, x0, x1, y0, y1, numbers @ ..] = words.as_slice() else {
            return Err(wrong("a line of boxes has too few words"));
        };
        let values: Option<Vec<f64>> =
            numbers.iter().map(|n| n.parse().ok().filter(|v: &f64| v.is_finite())).collect();
        let Some([w, h, x, y, dx, dy]) = values.as_deref().and_then(|v| v.get(..6)) else {
            return Err(wrong("a line of boxes needs six numbers"));
        };
        if !(*w > 0.0 && *h > 0.0) {
            return Err(wrong("a box has no size"));
        }
        let across = labels(x0, x1).ok_or_else(|| wrong("labels across do not make a range"))?;
        let down = labels(y0, y1).ok_or_else(|| wrong("labels down do not make a range"))?;
        if boxes.len() + across.len() * down.len() > MOST_BOXES {
            return Err(wrong("there are too many boxes"));
        }
        for (i, one) in across.iter().enumerate() {
            for (j, two) in down.iter().enumerate() {
                let name = if kind == "X" { format!("{one}{two}") } else { format!("{two}{one}") };
                let centre = [x + dx * i as f64 + w / 2.0, y + dy * j as f64 + h / 2.0];
                boxes.push(Patch { name, centre, size: [*w, *h] });
            }
        }
    }
    Ok(boxes)
}

/// "A".."D" or "01".."12", or one name when both are the same; "_" is empty.
fn labels(first: &str, last: &str) -> Option<Vec<String>> {
    if first == last {
        return Some(vec![if first == "_" { String::new() } else { first.to_owned() }]);
    }
    if let (Ok(from), Ok(to)) = (first.parse::<usize>(), last.parse::<usize>()) {
        let ordered = from <= to && to - from < MOST_BOXES;
        return ordered.then(|| (from..=to).map(|n| format!("{n:0width$}", width = first.len())).collect());
    }
    let letters = |name: &str| {
        let known = name.len() <= 2 && name.bytes().all(|b| b.is_ascii_uppercase());
        known.then(|| name.bytes().fold(0usize, |n, b| n * 26 + usize::from(b - b'A') + 1))
    };
    let (from, to) = (letters(first)?, letters(last)?);
    let name = |n: usize| {
        let letter = |n: usize| char::from(b'A' + (n % 26) as u8);
        let n = n - 1;
        if n < 26 { letter(n).to_string() } else { format!("{}{}", letter(n / 26 - 1), letter(n)) }
    };
    (from <= to).then(|| (from..=to).map(name).collect())
}

/// The table of expected colours, D50.
fn expected(text: &str) -> Result<Vec<(String, Lab)>, LayoutError> {
    let mut lines =
        text.lines().enumerate().skip_while(|(_, line)| !line.trim_start().starts_with("EXPECTED"));
    let Some((_, head)) = lines.next() else { return Ok(Vec::new()) };
    let is_lab = head.split_whitespace().nth(1) == Some("LAB");
    let mut colours = Vec::new();
    for (number, line) in lines.take(MOST_BOXES) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [name, x, y, z, ..] = words.as_slice() else {
            if words.is_empty() {
                continue;
            }
            break;
        };
        let value = |word: &str| {
            let wrong = LayoutError::Cht { line: number + 1, what: "a colour is no number" };
            word.parse().ok().filter(|v: &f64| v.is_finite()).ok_or(wrong)
        };
        let [x, y, z] = [value(x)?, value(y)?, value(z)?];
        let xyz = Xyz::new(x / 100.0, y / 100.0, z / 100.0);
        colours
            .push(((*name).to_owned(), if is_lab { Lab { l: x, a: y, b: z } } else { xyz.lab(white::D50) }));
    }
    Ok(colours)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = "BOXES 7\n  F _ _ 0 0 30 0 30 20 0 20\n  D ALL ALL _ _ 34 24 0 0 0 0\n\
        X A C 1 2 10 10 1 1 12 12\nBOX_SHRINK 1\nEXPECTED XYZ 6\nA1 90 95 80\nB1 20 20 20\nC1 5 5 5\n\
        A2 40 20 5\nB2 10 20 5\nC2 8 6 30\n";

    #[test]
    fn a_grid_of_boxes_becomes_a_layout() {
        let layout = ChartLayout::from_cht("small", SMALL).unwrap();
        assert_eq!((layout.columns, layout.rows), (3, 2));
        assert!((layout.gap - 0.2).abs() < 1e-9);
        let names: Vec<&str> = layout.patches.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["A1", "B1", "C1", "A2", "B2", "C2"]);
    }

    #[test]
    fn broken_files_are_errors_that_say_what() {
        let check =
            |from: &str, to: &str| ChartLayout::from_cht("small", &SMALL.replace(from, to)).unwrap_err();
        assert_eq!(check("C2 8 6 30\n", ""), LayoutError::NoColour("C2".to_owned()));
        assert!(matches!(check("10 10 1 1", "10 10 1 x"), LayoutError::Cht { line: 4, .. }));
        assert!(matches!(check("A C 1 2", "A C 2 1"), LayoutError::Cht { line: 4, .. }));
        assert!(matches!(check("A C 1 2", "A C 1 999999999"), LayoutError::Cht { line: 4, .. }));
        assert!(matches!(ChartLayout::from_cht("none", ""), Err(LayoutError::NotAGrid(_))));
    }
}
