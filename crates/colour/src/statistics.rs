//! Robust statistics.

use std::cmp::Ordering;

/// The median: always one of the values, the upper one of the two in the middle where their count is even. Puts them
/// into another order; a NaN counts as the largest. `None` where there are none.
pub fn median(values: &mut [f64]) -> Option<f64> {
    median_by(values, f64::total_cmp)
}

/// The median in an order of one's own.
pub fn median_by<T: Copy>(values: &mut [T], order: impl FnMut(&T, &T) -> Ordering) -> Option<T> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, order).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_upper_one_of_two() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), Some(3.0));
        assert_eq!(median(&mut [f64::NAN, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut []), None);
    }
}
