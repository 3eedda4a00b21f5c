//! Linear least squares by QR decomposition, with the residuals of leaving rows out in closed form.

use nalgebra::{DMatrix, DVector, Dyn, QR};

/// A diagonal element of R below this share of the largest one means that the columns are dependent.
const SINGULAR: f64 = 1e-14;

/// A least squares problem: rows that stand for data, in blocks of equal size, then rows that are penalties.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// One row per equation, one column per unknown.
    pub rows: DMatrix<f64>,
    /// What the rows should give; each column is a problem of its own with the same rows.
    pub targets: DMatrix<f64>,
    /// How many of the first rows are data.
    pub data: usize,
    /// Rows that are left out together: 1, or 3 where X, Y and Z of a colour have a row each.
    pub block: usize,
}

/// The solution of a [`Problem`].
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The unknowns, a column for each column of targets.
    pub unknowns: DMatrix<f64>,
    /// Residual (target less estimate) of each data row when its block takes no part in the fit; infinite where
    /// the rest does not determine it.
    pub left_out: DMatrix<f64>,
}

impl Problem {
    /// The unknowns with the least sum of squares. `None` when the rows do not determine them.
    pub fn solve(&self) -> Option<DMatrix<f64>> {
        self.factorise().map(|(_, unknowns)| unknowns)
    }

    /// The unknowns, and each block's residuals when it is left out: (I - H_ii)^-1 r_i, where H = Q Q' is the hat
    /// matrix and r the residuals of the whole fit (Allen, "The relationship between variable selection and data
    /// augmentation and a method for prediction", Technometrics 16(1), 1974; in blocks by the
    /// Sherman-Morrison-Woodbury formula).
    pub fn solve_and_leave_out(&self) -> Option<Solution> {
        let (qr, unknowns) = self.factorise()?;
        let q = qr.q();
        let residuals = self.targets.rows(0, self.data) - self.rows.rows(0, self.data) * &unknowns;
        let mut left_out = residuals.clone();
        for first in (0..self.data).step_by(self.block) {
            let own = q.rows(first, self.block);
            let rest = DMatrix::identity(self.block, self.block) - own * own.transpose();
            let without = (rest.determinant().abs() > 1e-12)
                .then(|| rest.lu().solve(&residuals.rows(first, self.block).into_owned()))
                .flatten();
            match without {
                Some(without) => left_out.rows_mut(first, self.block).copy_from(&without),
                None => left_out.rows_mut(first, self.block).fill(f64::INFINITY),
            }
        }
        Some(Solution { unknowns, left_out })
    }

    /// For each row of `others` its estimate by the fit without the data row of the same number i: b M_i, where b is
    /// the row and M_i = M - R^-1 q_i r_i / (1 - h_i) are the unknowns of that fit. Blocks of one row only. `None` when
    /// the rows do not determine the unknowns.
    pub fn left_out_at(&self, others: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let (qr, unknowns) = self.factorise()?;
        let q = qr.q();
        let residuals = self.targets.rows(0, self.data) - self.rows.rows(0, self.data) * &unknowns;
        // R^-1 q_i is what the pseudo-inverse makes of data row i: solve for unit targets.
        let mut units = DMatrix::zeros(self.rows.nrows(), self.data);
        units.fill_diagonal(1.0);
        let influence = Self { targets: units, ..self.clone() }.solve()?;
        let mut estimates = others * &unknowns;
        for i in 0..self.data {
            let own = 1.0 - q.row(i).norm_squared();
            let reach = others.row(i).dot(&influence.column(i).transpose()) / own;
            for (estimate, residual) in estimates.row_mut(i).iter_mut().zip(residuals.row(i).iter()) {
                *estimate -= reach * residual;
            }
        }
        Some(estimates)
    }

    /// The decomposition of the rows, whose columns are scaled to length 1 first, and the unknowns. To make the
    /// orthonormal factor of it takes as long again, so that is left to those who need it.
    fn factorise(&self) -> Option<(QR<f64, Dyn, Dyn>, DMatrix<f64>)> {
        let columns = self.rows.ncols();
        if self.rows.nrows() < columns {
            return None;
        }
        let scale = DVector::from_iterator(
            columns,
            self.rows.column_iter().map(|c| if c.norm() > 0.0 { c.norm() } else { 1.0 }),
        );
        let mut scaled = self.rows.clone();
        for (mut column, scale) in scaled.column_iter_mut().zip(&scale) {
            column /= *scale;
        }
        let qr = scaled.qr();
        let r = qr.r();
        let largest = r.diagonal().amax();
        let determined = r.diagonal().iter().all(|d| d.abs() > SINGULAR * largest);
        if !determined {
            return None;
        }
        let mut rotated = self.targets.clone();
        qr.q_tr_mul(&mut rotated);
        let mut unknowns = r.solve_upper_triangular(&rotated.rows(0, columns).into_owned())?;
        for (mut row, scale) in unknowns.row_iter_mut().zip(&scale) {
            row /= *scale;
        }
        Some((qr, unknowns))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn problem(values: &[f64], block: usize) -> Problem {
        let (rows, columns) = (18, 4);
        let matrix = DMatrix::from_row_slice(rows + 2, columns, &values[..(rows + 2) * columns]);
        let targets = DMatrix::from_row_slice(rows + 2, 2, &values[100..100 + (rows + 2) * 2]);
        Problem { rows: matrix, targets, data: rows, block }
    }

    proptest! {
        #[test]
        fn leaving_out_in_closed_form_is_really_leaving_out(
            values in prop::collection::vec(-1f64..1.0, 160), block in prop::sample::select(vec![1usize, 3]),
        ) {
            let whole = problem(&values, block);
            let Some(solution) = whole.solve_and_leave_out() else { return Ok(()) };
            for first in (0..whole.data).step_by(block) {
                let rows = whole.rows.clone().remove_rows(first, block);
                let targets = whole.targets.clone().remove_rows(first, block);
                let rest = Problem { rows, targets, data: whole.data - block, block };
                let Some(unknowns) = rest.solve() else { continue };
                let own = whole.rows.rows(first, block);
                let residual = whole.targets.rows(first, block) - own * unknowns;
                let off = (residual - solution.left_out.rows(first, block)).amax();
                prop_assert!(off < 1e-8 * (1.0 + solution.left_out.amax()), "{off}");
            }
        }
    }

    #[test]
    fn dependent_columns_have_no_solution() {
        let rows = DMatrix::from_row_slice(3, 2, &[1.0, 2.0, 2.0, 4.0, 3.0, 6.0]);
        let targets = DMatrix::from_row_slice(3, 1, &[1.0, 2.0, 3.0]);
        assert_eq!(Problem { rows, targets, data: 3, block: 1 }.solve(), None);
    }
}
