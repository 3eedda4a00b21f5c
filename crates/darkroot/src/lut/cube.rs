//! `.cube` files ("Cube LUT Specification 1.0", Adobe 2013), also those with a curve before the table, and with input ranges,
//! as DaVinci Resolve writes them.

use darkroot_develop::lut::{Cube, Curves, Entries, Lut, Step};

use super::LutFault;

/// What the head of a file says.
#[derive(Default)]
struct Head {
    curve: Option<usize>,
    table: Option<usize>,
    least: Option<[f32; 3]>,
    most: Option<[f32; 3]>,
    curve_range: Option<[f32; 2]>,
    table_range: Option<[f32; 2]>,
}

pub(super) fn parse(text: &str) -> Result<Lut, LutFault> {
    let mut head = Head::default();
    let mut rows: Vec<[f32; 3]> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().take(5).collect();
        let known = match words[..] {
            [] | ["TITLE" | "LUT_IN_VIDEO_RANGE" | "LUT_OUT_VIDEO_RANGE", ..] => true,
            [word, ..] if word.starts_with('#') => true,
            ["LUT_3D_SIZE", size] => {
                head.table = Some(sized(size, Cube::SIZES)?);
                true
            }
            ["LUT_1D_SIZE", size] => {
                head.curve = Some(sized(size, Curves::SIZES)?);
                true
            }
            ["DOMAIN_MIN", ref v @ ..] => put(&mut head.least, v),
            ["DOMAIN_MAX", ref v @ ..] => put(&mut head.most, v),
            ["LUT_1D_INPUT_RANGE", ref v @ ..] => put(&mut head.curve_range, v),
            ["LUT_3D_INPUT_RANGE", ref v @ ..] => put(&mut head.table_range, v),
            _ => match numbers(&words) {
                Some(row) => {
                    rows.push(row);
                    true
                }
                None => false,
            },
        };
        if !known {
            return Err(LutFault::Line { line: i + 1, text: line.to_owned() });
        }
    }
    let wanted = head.curve.unwrap_or(0) + head.table.map_or(0, |n| n.pow(3));
    if wanted == 0 {
        return Err(LutFault::NoSize);
    }
    if rows.len() != wanted {
        return Err(LutFault::Rows { rows: rows.len(), wanted });
    }
    // The range of a file with one table is its domain; one with both says the range of each.
    let range = |own: Option<[f32; 2]>| match own {
        Some([least, most]) => [[least; 3], [most; 3]],
        None => [head.least.unwrap_or([0.0; 3]), head.most.unwrap_or([1.0; 3])],
    };
    let mut steps = Vec::new();
    let mut rows = rows.into_iter();
    if let Some(size) = head.curve {
        let entries: Vec<[f32; 3]> = rows.by_ref().take(size).collect();
        let [least, most] = range(head.curve_range);
        let tables = (0..3).map(|c| entries.iter().map(|entry| entry[c]).collect()).collect();
        let curves = Curves::new(Entries::Even { least, most }, tables).ok_or(LutFault::Numbers)?;
        steps.push(Step::Curves(curves));
    }
    if let Some(size) = head.table {
        let nodes: Vec<[f32; 3]> = rows.collect();
        // In the file red changes fastest.
        let turned = (0..nodes.len())
            .map(|i| nodes[(i % size * size + i / size % size) * size + i / (size * size)])
            .collect();
        let table = Cube::new(size, range(head.table_range), turned).ok_or(LutFault::Numbers)?;
        steps.push(Step::Cube(table));
    }
    Ok(Lut { steps })
}

/// Exactly so many finite numbers.
fn numbers<const N: usize>(words: &[&str]) -> Option<[f32; N]> {
    let numbers: Option<Vec<f32>> =
        words.iter().map(|w| w.parse().ok().filter(|v: &f32| v.is_finite())).collect();
    numbers?.try_into().ok()
}

fn put<const N: usize>(place: &mut Option<[f32; N]>, words: &[&str]) -> bool {
    *place = numbers(words);
    place.is_some()
}

fn sized(text: &str, sizes: std::ops::RangeInclusive<usize>) -> Result<usize, LutFault> {
    let size = text.parse().ok().filter(|n| sizes.contains(n));
    size.ok_or_else(|| LutFault::Size {
        size: crate::quoted(text),
        least: *sizes.start(),
        most: *sizes.end(),
    })
}
