//! A plain polynomial over planes. It is for comparisons, so it is short, not fast.

use super::{Out, PlanePart};
use crate::Polynomial;

/// Exponents and coefficients of every term.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PolynomialPlanes {
    terms: Vec<([u8; 3], [f32; 3])>,
}

impl PolynomialPlanes {
    pub(super) fn new(part: &Polynomial) -> Self {
        Self { terms: part.terms().map(|(t, c)| (t, c.map(|v| v as f32))).collect() }
    }
}

impl PlanePart for PolynomialPlanes {
    #[inline(always)]
    fn add(&self, [r, g, b]: [&[f32]; 3], out: &mut Out) {
        for (i, ((&r, &g), &b)) in r.iter().zip(g).zip(b).enumerate() {
            let powers = |v: f32| [1.0, v, v * v, v * v * v, v * v * v * v];
            let (r, g, b) = (powers(r), powers(g), powers(b));
            for (term, c) in &self.terms {
                let [i_r, i_g, i_b] = term.map(usize::from);
                let value = r[i_r] * g[i_g] * b[i_b];
                for k in 0..3 {
                    out[k][i] += c[k] * value;
                }
            }
        }
    }
}
