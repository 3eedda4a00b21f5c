//! Decompositions of matrices that always come to an end.
//!
//! nalgebra's own iterate until they converge: for ever, where a number is infinite. `clippy.toml` forbids them elsewhere.

use nalgebra::allocator::Allocator;
use nalgebra::{DMatrix, DVector, DefaultAllocator, DimDiff, DimSub, OMatrix, SymmetricEigen, U1};

/// Differences that count as none, as in nalgebra itself.
const EPSILON: f64 = f64::EPSILON;
/// Iterations at most. Matrices of measurements take some for each of their columns.
const ITERATIONS: usize = 10_000;
/// Singular values below this are none.
const SMALLEST: f64 = 1e-12;

/// The `x` with the least squares of `design` x - `target`, the shortest where there are several. `None` where a number is
/// infinite or no number, and where none is found.
pub fn least_squares(design: DMatrix<f64>, target: &DVector<f64>) -> Option<DVector<f64>> {
    if !design.iter().chain(target.iter()).all(|v| v.is_finite()) {
        return None;
    }
    let found = design.try_svd(true, true, 5.0 * EPSILON, ITERATIONS)?.solve(target, SMALLEST).ok()?;
    found.iter().all(|v| v.is_finite()).then_some(found)
}

/// Eigenvalues and eigenvectors of a symmetric matrix. `None` where a number is infinite or no number, and where none are
/// found.
pub fn symmetric_eigen<D: DimSub<U1>>(matrix: OMatrix<f64, D, D>) -> Option<SymmetricEigen<f64, D>>
where
    DefaultAllocator: Allocator<D, D> + Allocator<DimDiff<D, U1>> + Allocator<D> + Allocator<DimDiff<D, U1>>,
{
    if !matrix.iter().all(|v| v.is_finite()) {
        return None;
    }
    SymmetricEigen::try_new(matrix, EPSILON, ITERATIONS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_infinite_or_no_number_has_no_solution() {
        for wrong in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            for place in 0..6 {
                let design = DMatrix::from_fn(3, 2, |i, k| if 2 * i + k == place { wrong } else { 1.0 });
                assert_eq!(least_squares(design, &DVector::zeros(3)), None);
            }
            let sound = DMatrix::from_fn(3, 2, |i, k| (i + k) as f64);
            assert_eq!(least_squares(sound, &DVector::from_element(3, wrong)), None);
            assert!(symmetric_eigen(DMatrix::from_element(3, 3, wrong)).is_none());
        }
    }

    #[test]
    fn numbers_of_every_size_come_to_an_end() {
        // Finite, but their squares are not; or so small that nothing converges.
        for size in [f64::MAX, 1e300, 1e-300, f64::MIN_POSITIVE, 5e-324] {
            for spread in [0.0, 1.0, 1e-8] {
                let entry = |i: usize, k: usize| size * (1.0 - spread * ((i * 7 + k * 3) % 5) as f64 / 5.0);
                // Any answer is good, as long as it comes.
                let _ = least_squares(DMatrix::from_fn(24, 6, entry), &DVector::from_element(24, size));
                let _ = symmetric_eigen(DMatrix::from_fn(9, 9, |i, k| entry(i.min(k), i.max(k))));
            }
        }
    }

    #[test]
    fn a_line_is_fitted() {
        let design = DMatrix::from_fn(5, 2, |i, k| if k == 0 { 1.0 } else { i as f64 });
        let target = DVector::from_fn(5, |i, _| 2.0 + 3.0 * i as f64);
        let found = least_squares(design, &target).unwrap();
        assert!((found[0] - 2.0).abs() < 1e-12 && (found[1] - 3.0).abs() < 1e-12);
    }
}
