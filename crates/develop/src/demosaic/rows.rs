//! Rows of a Bayer tile, even columns apart from odd ones.
//!
//! Under a Bayer array every second pixel of a row has the same filter. With even and odd columns apart, a loop over the
//! pixels of one colour runs over neighbours in memory, and the pixels of the other colour cost it nothing. Only the last
//! few rows are kept, so that all of them stay in the nearest caches.

/// One value for each pixel of a row.
pub(super) struct Row {
    /// Those of even columns, those of odd ones.
    pub(super) columns: [Vec<f32>; 2],
}

impl Row {
    /// A row of zeros with so many even columns, and as many odd ones.
    pub(super) fn new(half: usize) -> Self {
        Self { columns: [vec![0.0; half], vec![0.0; half]] }
    }

    /// For every column of one parity but the outermost `margin` on each side: the value `shift` columns to the right
    /// of it. The shift is at most twice the margin.
    #[inline(always)]
    pub(super) fn beside(&self, parity: usize, shift: isize, margin: usize) -> &[f32] {
        let place = parity as isize + shift;
        let columns = &self.columns[(place & 1) as usize];
        let first = (margin as isize + (place >> 1)) as usize;
        &columns[first..first + columns.len() - 2 * margin]
    }

    /// Takes a row of values apart.
    #[inline(always)]
    pub(super) fn part(&mut self, values: &[f32], change: impl Fn(f32) -> f32) {
        let [even, odd] = &mut self.columns;
        let pairs = values.chunks_exact(2);
        if let ([last], Some(even)) = (pairs.remainder(), even.last_mut()) {
            *even = change(*last);
        }
        for ((pair, even), odd) in pairs.zip(even).zip(odd) {
            *even = change(pair[0]);
            *odd = change(pair[1]);
        }
    }

    /// Puts the values from column `first` on together.
    #[inline(always)]
    pub(super) fn join(&self, first: usize, out: &mut [f32]) {
        let [even, odd] = &self.columns;
        let (even, odd) = match first % 2 {
            0 => (&even[first / 2..], &odd[first / 2..]),
            _ => (&odd[first / 2..], &even[first / 2 + 1..]),
        };
        let whole = out.len() / 2;
        let mut pairs = out.chunks_exact_mut(2);
        for ((pair, one), other) in (&mut pairs).zip(even).zip(odd) {
            pair[0] = *one;
            pair[1] = *other;
        }
        if let [last] = pairs.into_remainder() {
            *last = even[whole];
        }
    }
}

/// The last few rows.
pub(super) struct Rows(Vec<Row>);

impl Rows {
    pub(super) fn new(count: usize, half: usize) -> Self {
        Self((0..count).map(|_| Row::new(half)).collect())
    }

    /// Row `y`, one of the last that were written.
    #[inline(always)]
    pub(super) fn row(&self, y: usize) -> &Row {
        &self.0[y % self.0.len()]
    }

    /// Row `y`, to be written in place of the oldest.
    #[inline(always)]
    pub(super) fn next(&mut self, y: usize) -> &mut Row {
        let count = self.0.len();
        &mut self.0[y % count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_comes_together_again_from_any_column_on() {
        for width in 1..12usize {
            let values: Vec<f32> = (0..width).map(|x| x as f32).collect();
            let mut row = Row::new(width.div_ceil(2));
            row.part(&values, |v| v);
            for first in 0..width {
                let mut out = vec![-1.0; width - first];
                row.join(first, &mut out);
                assert_eq!(out, values[first..], "{width} from {first}");
            }
        }
    }

    #[test]
    fn what_lies_beside_is_so_many_columns_away() {
        let values: Vec<f32> = (0..16).map(|x| x as f32).collect();
        let mut row = Row::new(8);
        row.part(&values, |v| v);
        for (parity, shift) in [(0, -4), (0, -1), (0, 3), (1, -3), (1, 0), (1, 4)] {
            let seen = row.beside(parity, shift, 2);
            let wanted: Vec<f32> = (2..6).map(|j| (2 * j + parity as isize + shift) as f32).collect();
            assert_eq!(seen, wanted, "{parity} {shift}");
        }
    }
}
