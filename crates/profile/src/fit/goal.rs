//! A least-squares problem that was reduced to a triangle, and further rows.

use darkroot_colour::simd::vectorised;
use nalgebra::{DMatrix, DVector};

/// The least squares problem without folds in it, reduced to a triangle: a row for each unknown. The rows that keep folds
/// away are steep, so that with them only the triangle is exact enough, not its square.
pub(super) struct Goal {
    pub(super) rows: DMatrix<f64>,
    pub(super) targets: DVector<f64>,
    pub(super) weight: f64,
}

/// A further row of the problem.
pub(super) struct Row {
    pub(super) row: Vec<f64>,
    pub(super) target: f64,
}

impl Goal {
    /// The unknowns with the least sum of squares, further rows included. `None` where they are not determined.
    pub(super) fn solve(&self, further: &[Row]) -> Option<DVector<f64>> {
        let (mut triangle, mut reached) = (self.rows.clone(), self.targets.clone());
        let mut rest: Vec<f64> =
            (0..triangle.ncols()).flat_map(|c| further.iter().map(move |r| r.row[c])).collect();
        rest.extend(further.iter().map(|r| r.target));
        vectorised(
            #[inline(always)]
            || take_in(triangle.as_mut_slice(), reached.as_mut_slice(), &mut rest),
        );
        triangle.solve_upper_triangular(&reached).filter(|x| x.iter().all(|v| v.is_finite()))
    }

    /// Sum of squares for given unknowns, up to a constant.
    pub(super) fn cost(&self, unknowns: &DVector<f64>) -> f64 {
        (&self.rows * unknowns - &self.targets).norm_squared()
    }
}

/// Takes further rows into a triangle and its targets by Householder's reflections. What is zero below the triangle stays
/// so and is not touched. All are stored column by column; the last column of the rest has its targets.
#[inline(always)]
fn take_in(triangle: &mut [f64], reached: &mut [f64], rest: &mut [f64]) {
    let width = reached.len();
    let count = rest.len() / (width + 1);
    if count == 0 {
        return;
    }
    for j in 0..width {
        let (done, right) = rest.split_at_mut((j + 1) * count);
        let reflector = &done[j * count..];
        let below = dot(reflector, reflector);
        if below <= 0.0 {
            continue;
        }
        let own = triangle[j * width + j];
        let diagonal = -(own * own + below).sqrt().copysign(own);
        let first = own - diagonal;
        let twice = 2.0 / (first * first + below);
        triangle[j * width + j] = diagonal;
        // The columns to the right, and the targets at their end.
        let row = triangle.iter_mut().skip(j + (j + 1) * width).step_by(width);
        for (above, column) in row.chain([&mut reached[j]]).zip(right.chunks_exact_mut(count)) {
            let share = twice * (first * *above + dot(reflector, column));
            *above -= share * first;
            column.iter_mut().zip(reflector).for_each(|(v, r)| *v -= share * r);
        }
    }
}

/// The sum of products, in four sums that the processor can add side by side.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, rest) = (a.chunks_exact(4), a.chunks_exact(4).remainder());
    let tail = &b[b.len() - rest.len()..];
    for (a, b) in fours.zip(b.chunks_exact(4)) {
        for i in 0..4 {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f64 = rest.iter().zip(tail).map(|(a, b)| a * b).sum();
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by a decomposition of all rows.
    #[test]
    fn further_rows_are_taken_in_as_if_they_had_always_been_there() {
        let value = |i: usize, j: usize| ((i * 7 + j * 13 + i * j) as f64).sin();
        let rows =
            DMatrix::from_fn(5, 5, |i, j| if i > j { 0.0 } else { value(i, j) + 2.0 * f64::from(i == j) });
        let targets = DVector::from_fn(5, |i, _| value(i, 9));
        let further: Vec<Row> = (0..7)
            .map(|i| Row { row: (0..5).map(|j| value(i + 20, j)).collect(), target: value(i, 30) })
            .collect();
        let goal = Goal { rows: rows.clone(), targets: targets.clone(), weight: 1.0 };
        for count in [0, 1, 7] {
            let all =
                DMatrix::from_fn(
                    5 + count,
                    5,
                    |i, j| if i < 5 { rows[(i, j)] } else { further[i - 5].row[j] },
                );
            let wanted =
                DVector::from_fn(5 + count, |i, _| if i < 5 { targets[i] } else { further[i - 5].target });
            let qr = all.qr();
            let slow = qr.r().solve_upper_triangular(&(qr.q().transpose() * wanted)).unwrap();
            let fast = goal.solve(&further[..count]).unwrap();
            assert!((slow - fast).amax() < 1e-10);
        }
    }
}
