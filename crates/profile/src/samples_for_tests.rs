//! Models with every part, for the tests of this crate.

use darkroot_colour::{Matrix3, Xyz};

use crate::residual::Centre;
use crate::{HuePlane, Model, Order, Polynomial, Residual, RootPolynomial};

/// One model with each part alone, one with all that are exposure invariant, one with all.
pub(crate) fn all_parts() -> Vec<Model> {
    let triple = |i: usize| [0.3 / (1.0 + i as f64), 0.4 / (2.0 + i as f64), 0.02 * (i as f64 - 3.0)];
    let matrix = |i: usize| {
        let turn = (i as f64).sin() * 0.2;
        Matrix3::new(0.7 + turn, 0.2, 0.1, 0.3, 0.7 - turn, 0.0, turn, 0.1, 0.8)
    };
    let root: Model =
        RootPolynomial::new(Order::Four, (0..22).map(triple).collect()).map(Model::from).unwrap_or_default();
    let hue: Model = HuePlane::new((0..12).map(matrix).collect()).map(Model::from).unwrap_or_default();
    let centre = |rgb: [f64; 3], i: usize| Centre { rgb, weight: triple(i).map(|v| v / 3.0) };
    let centres = vec![centre([0.8, 0.1, 0.1], 1), centre([0.0, 0.3, 0.7], 4), centre([0.4, 0.6, 0.0], 9)];
    let residual = Model { residual: Residual::new(centres), ..Model::default() };
    let polynomial = Model {
        polynomial: Polynomial::new(4, (0..34).map(|i| triple(i).map(|v| v / 100.0)).collect()),
        ..Model::default()
    };
    let invariant = Model { polynomial: None, ..sum(&sum(&root, &hue), &residual) };
    let all = sum(&invariant, &polynomial);
    vec![root, hue, residual, polynomial, invariant, all]
}

fn sum(one: &Model, other: &Model) -> Model {
    Model {
        root: one.root.clone().or_else(|| other.root.clone()),
        hue_plane: one.hue_plane.clone().or_else(|| other.hue_plane.clone()),
        residual: one.residual.clone().or_else(|| other.residual.clone()),
        polynomial: one.polynomial.clone().or_else(|| other.polynomial.clone()),
    }
}

/// Whether two colours agree within `bound`.
pub(crate) fn close(a: Xyz, b: Xyz, bound: f64) -> bool {
    (a.x - b.x).abs().max((a.y - b.y).abs()).max((a.z - b.z).abs()) <= bound
}
