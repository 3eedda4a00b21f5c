//! Nikon's compression: differences to the sample two columns to the left, in Huffman codes whose trees are constants of the
//! format. The lossy kinds store steps of a curve in place of samples; the later one drops the last bits of large
//! differences below a row.

use darkroot_encode::bits::{Bits, category};

/// A tree: numbers of codes of 1, 2, 3, ... bits, and their symbols in order. The low half of a symbol is the number of bits
/// of a difference, the high half how many of them are dropped.
struct Tree {
    counts: [u8; 11],
    symbols: [u8; 15],
}

const LOSSLESS_12: Tree = Tree {
    counts: [0, 1, 4, 2, 3, 1, 2, 0, 0, 0, 0],
    symbols: [5, 4, 6, 3, 7, 2, 8, 1, 9, 0, 10, 11, 12, 0, 0],
};
const LOSSLESS_14: Tree = Tree {
    counts: [0, 1, 4, 2, 2, 3, 1, 2, 0, 0, 0],
    symbols: [7, 6, 8, 5, 9, 4, 10, 3, 11, 12, 2, 0, 1, 13, 14],
};
const LOSSY_12: Tree = Tree {
    counts: [0, 1, 5, 1, 1, 1, 1, 1, 1, 2, 0],
    symbols: [5, 4, 3, 6, 2, 7, 1, 0, 8, 9, 11, 10, 12, 0, 0],
};
const LOSSY_12_SPLIT: Tree = Tree {
    counts: [0, 1, 5, 1, 1, 1, 1, 1, 1, 2, 0],
    symbols: [0x39, 0x5a, 0x38, 0x27, 0x16, 5, 4, 3, 2, 1, 0, 11, 12, 12, 0],
};
const LOSSY_14: Tree = Tree {
    counts: [0, 1, 4, 3, 1, 1, 1, 1, 1, 2, 0],
    symbols: [5, 6, 4, 7, 8, 3, 9, 2, 1, 0, 10, 11, 12, 13, 14],
};
const LOSSY_14_SPLIT: Tree = Tree {
    counts: [0, 1, 5, 1, 1, 1, 1, 1, 1, 1, 2],
    symbols: [8, 0x5c, 0x4b, 0x3a, 0x29, 7, 6, 5, 4, 3, 2, 1, 0, 13, 14],
};

/// What the first two samples of the first two rows are predicted to be.
const FIRST_PREDICTION: u16 = 2048;
/// Readers take this much of the note for granted.
const TABLE_BYTES: usize = 640;
/// Where the note of the later lossy kind has its row.
const SPLIT_AT: usize = 562;
/// Points of the curve in the note of the later lossy kind; of the earlier one every value stands there.
const POINTS: u16 = 257;

/// A code of a tree.
#[derive(Debug, Clone, Copy, Default)]
struct Code {
    code: u32,
    length: u32,
    /// How many of the last bits of a difference are dropped.
    dropped: u32,
}

impl Tree {
    /// The codes by number of bits of a difference.
    fn codes(&self) -> [Code; 16] {
        let mut codes = [Code::default(); 16];
        let mut next = 0;
        let mut symbols = self.symbols.iter();
        for (&count, length) in self.counts.iter().zip(1..) {
            for &symbol in symbols.by_ref().take(usize::from(count)) {
                let place = &mut codes[usize::from(symbol & 15)];
                // The trees name some sizes twice; the first is as good as the second.
                if place.length == 0 {
                    *place = Code { code: next, length, dropped: u32::from(symbol >> 4) };
                }
                next += 1;
            }
            next <<= 1;
        }
        codes
    }
}

/// The samples as they are.
pub(crate) fn lossless(samples: &[u16], width: usize, bits: u8) -> Vec<u8> {
    let tree = if bits == 12 { LOSSLESS_12 } else { LOSSLESS_14 };
    encode(samples, width, &tree, None, (1 << bits) - 1)
}

/// The steps of the curve that are nearest to the samples.
pub(crate) fn lossy(samples: &[u16], width: usize, bits: u8, split: Option<usize>) -> Vec<u8> {
    let curve = curve(bits);
    let steps: Vec<u16> = samples.iter().map(|&s| curve.partition_point(|&v| v < s) as u16).collect();
    let trees = if bits == 12 { (LOSSY_12, LOSSY_12_SPLIT) } else { (LOSSY_14, LOSSY_14_SPLIT) };
    // Readers take no step beyond the first that has the largest value.
    let most = curve.partition_point(|&v| v < (1 << bits) - 1) as i32;
    encode(&steps, width, &trees.0, split.map(|row| (row, &trees.1)), most)
}

/// Version 0x46 0x30 (lossless), the first predictions of the four filters, and a curve of no points.
pub(crate) fn lossless_table() -> Vec<u8> {
    let mut table = head([0x46, 0x30]);
    table.resize(TABLE_BYTES, 0);
    table
}

/// Version 0x44 0x10, the first predictions and the curve; with a split version 0x44 0x20, some points of the curve, and the
/// row.
pub(crate) fn lossy_table(bits: u8, split: Option<usize>) -> Vec<u8> {
    let curve = curve(bits);
    let Some(row) = split else {
        let mut table = head([0x44, 0x10]);
        table.extend((curve.len() as u16).to_le_bytes());
        table.extend(curve.iter().flat_map(|v| v.to_le_bytes()));
        return table;
    };
    let mut table = head([0x44, 0x20]);
    table.extend(POINTS.to_le_bytes());
    let step = (1usize << bits) / usize::from(POINTS - 1);
    let points = (0..usize::from(POINTS)).map(|i| curve[(i * step).min(curve.len() - 1)]);
    table.extend(points.flat_map(u16::to_le_bytes));
    table.resize(SPLIT_AT, 0);
    table.extend((row as u16).to_le_bytes());
    table.resize(TABLE_BYTES, 0);
    table
}

fn head(version: [u8; 2]) -> Vec<u8> {
    let predictions = [FIRST_PREDICTION; 4].into_iter().flat_map(u16::to_le_bytes);
    version.into_iter().chain(predictions).collect()
}

/// The value of each step: from one to the next the curve rises by 1 where it is dark and by 3 where it is bright, in lines
/// between its points, and stays at the largest value in the end.
fn curve(bits: u8) -> Vec<u16> {
    let most = (1u32 << bits) - 1;
    let at = |step: u32| {
        let (knee, rest) = (most / 4, step.saturating_sub(most / 4));
        (step.min(knee) + 3 * rest).min(most)
    };
    // Lines between points, as readers draw them.
    let step = (1u32 << bits) / u32::from(POINTS - 1);
    let line = |i: u32| {
        let (low, high) = (at(i / step * step), at((i / step + 1) * step));
        ((low * (step - i % step) + high * (i % step)) / step) as u16
    };
    (0..1 << bits).map(line).collect()
}

/// Each sample as its difference to the one two columns to the left; the first two of a row to those two rows above.
fn encode(samples: &[u16], width: usize, tree: &Tree, split: Option<(usize, &Tree)>, most: i32) -> Vec<u8> {
    let mut out = Bits::default();
    let mut codes = tree.codes();
    let mut first = [[i32::from(FIRST_PREDICTION); 2]; 2];
    for (y, row) in samples.chunks_exact(width.max(1)).enumerate() {
        if let Some((_, tree)) = split.filter(|(split, _)| *split == y) {
            codes = tree.codes();
        }
        let mut prediction = first[y % 2];
        for (x, &sample) in row.iter().enumerate() {
            let before = prediction[x % 2];
            let stored = put(&mut out, &codes, i32::from(sample) - before, before, most);
            prediction[x % 2] = stored;
            if x < 2 {
                first[y % 2][x] = stored;
            }
        }
    }
    out.finish(false)
}

/// Writes a difference, and says what readers make of the sample.
fn put(out: &mut Bits, codes: &[Code; 16], difference: i32, before: i32, most: i32) -> i32 {
    let (size, extra) = category(difference);
    let Code { code, length, dropped } = codes[usize::from(size)];
    if dropped == 0 {
        out.push(code, length);
        out.push(extra, u32::from(size));
        return before + difference;
    }
    // The middle of what the kept bits stand for; a difference of another size where that leaves the range.
    let kept = extra as i32 >> dropped;
    let middle = (kept << dropped) + (1 << (dropped - 1)) - if difference < 0 { 1 << size } else { 0 };
    if !(0..=most).contains(&(before + middle)) {
        return put(out, codes, difference - difference.signum() * (1 << dropped), before, most);
    }
    out.push(code, length);
    out.push(kept as u32, u32::from(size) - dropped);
    before + middle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lossless_trees_have_a_code_for_every_size_of_error_and_no_room_left() {
        for (tree, symbols) in [(LOSSLESS_12, 13), (LOSSLESS_14, 15)] {
            let codes = tree.codes();
            let space: f64 =
                codes.iter().filter(|c| c.length > 0).map(|c| 0.5f64.powi(c.length as i32)).sum();
            assert!((space - 1.0).abs() < 1e-12);
            assert!(codes[..symbols].iter().all(|c| c.length > 0));
        }
    }

    #[test]
    fn every_tree_has_a_code_for_the_sizes_that_it_needs() {
        for (tree, sizes) in [(LOSSY_12, 13), (LOSSY_14, 15), (LOSSY_12_SPLIT, 13), (LOSSY_14_SPLIT, 15)] {
            assert!(tree.codes()[..sizes].iter().all(|c| c.length > 0));
        }
    }

    #[test]
    fn the_curve_rises_and_loses_little() {
        for bits in [12, 14] {
            let curve = curve(bits);
            assert_eq!((curve[0], curve[curve.len() - 1]), (0, (1 << bits) - 1));
            assert!(
                curve.windows(2).all(|pair| (0..=3).contains(&(i32::from(pair[1]) - i32::from(pair[0]))))
            );
        }
    }
}
