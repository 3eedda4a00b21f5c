//! A root polynomial over planes.
//!
//! All terms are products of a few shared roots: three square roots give order 2, three cube roots more give
//! order 3, three fourth roots (roots of the square roots) order 4. No power function is called.

use super::{Out, PlanePart};
use crate::{Order, RootPolynomial};

/// A root polynomial with its coefficients as the loops want them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RootPlanes {
    order: Order,
    /// For each output channel, the coefficients of all terms.
    coefficients: [Vec<f32>; 3],
}

impl RootPlanes {
    pub(super) fn new(part: &RootPolynomial) -> Self {
        let channel = |k: usize| part.terms().map(|(_, c)| c[k] as f32).collect();
        Self { order: part.order(), coefficients: [channel(0), channel(1), channel(2)] }
    }

    /// Adds the terms of each pixel, as many as there are coefficients. All are summed at once: sums stay in registers.
    #[inline(always)]
    fn sum<const TERMS: usize>(
        &self,
        [r, g, b]: [&[f32]; 3],
        out: &mut Out,
        terms: impl Fn(f32, f32, f32) -> [f32; TERMS],
    ) {
        let mut coefficients = [[0f32; TERMS]; 3];
        for (known, given) in coefficients.iter_mut().zip(&self.coefficients) {
            known.copy_from_slice(&given[..TERMS]);
        }
        let [cx, cy, cz] = &coefficients;
        let [x, y, z] = out;
        for (((((x, y), z), &r), &g), &b) in x.iter_mut().zip(y).zip(z).zip(r).zip(g).zip(b) {
            let terms = terms(r, g, b);
            let (mut sum_x, mut sum_y, mut sum_z) = (*x, *y, *z);
            for k in 0..TERMS {
                sum_x += cx[k] * terms[k];
                sum_y += cy[k] * terms[k];
                sum_z += cz[k] * terms[k];
            }
            (*x, *y, *z) = (sum_x, sum_y, sum_z);
        }
    }
}

impl PlanePart for RootPlanes {
    #[inline(always)]
    fn add(&self, rgb: [&[f32]; 3], out: &mut Out) {
        match self.order {
            Order::One => self.sum(rgb, out, |r, g, b| [r, g, b]),
            Order::Two => self.sum(rgb, out, |r, g, b| {
                let [rg, gb, rb] = squares(sqrt(r), sqrt(g), sqrt(b));
                [r, g, b, rg, gb, rb]
            }),
            Order::Three => self.sum(rgb, out, |r, g, b| {
                let [rg, gb, rb] = squares(sqrt(r), sqrt(g), sqrt(b));
                let [rgg, gbb, rbb, rrg, ggb, rrb, rgb] = cubes(cbrt(r), cbrt(g), cbrt(b));
                [r, g, b, rg, gb, rb, rgg, gbb, rbb, rrg, ggb, rrb, rgb]
            }),
            Order::Four => self.sum(rgb, out, |r, g, b| {
                let (sr, sg, sb) = (sqrt(r), sqrt(g), sqrt(b));
                let [rg, gb, rb] = squares(sr, sg, sb);
                let [rgg, gbb, rbb, rrg, ggb, rrb, rgb] = cubes(cbrt(r), cbrt(g), cbrt(b));
                let (r4, g4, b4) = (sr.sqrt(), sg.sqrt(), sb.sqrt());
                // Products of fourth roots; their squares are the square roots.
                let (rg4, gb4, rb4) = (r4 * g4, g4 * b4, r4 * b4);
                [
                    r,
                    g,
                    b,
                    rg,
                    gb,
                    rb,
                    rgg,
                    gbb,
                    rbb,
                    rrg,
                    ggb,
                    rrb,
                    rgb,
                    sr * rg4,
                    sr * rb4,
                    sg * rg4,
                    sg * gb4,
                    sb * rb4,
                    sb * gb4,
                    sr * gb4,
                    sg * rb4,
                    sb * rg4,
                ]
            }),
        }
    }
}

/// Terms of order 2, from square roots, in the sequence of [`Order::terms`].
#[inline(always)]
fn squares(r: f32, g: f32, b: f32) -> [f32; 3] {
    [r * g, g * b, r * b]
}

/// Terms of order 3, from cube roots, in the sequence of [`Order::terms`].
#[inline(always)]
fn cubes(r: f32, g: f32, b: f32) -> [f32; 7] {
    let (rg, gb, rb) = (r * g, g * b, r * b);
    [rg * g, gb * b, rb * b, rg * r, gb * g, rb * r, rg * b]
}

#[inline(always)]
fn sqrt(v: f32) -> f32 {
    v.max(0.0).sqrt()
}

/// Cube root of a value of at least 0; negative values count as 0. A guess of its inverse from the bits (Warren,
/// "Hacker's Delight", 11-2), within 3.5 %; one step of a series for the inverse, one of Newton's method for the root: within
/// 1 unit in the last place for normal numbers, without a division.
#[inline(always)]
fn cbrt(v: f32) -> f32 {
    let v = v.max(0.0);
    // A third of the bits is a third of the exponent: 1/4 + 1/16, and that times 17/16 and 257/256. The constant
    // puts four thirds of the exponent's bias back.
    let bits = v.to_bits();
    let third = (bits >> 2) + (bits >> 4);
    let third = third + (third >> 4);
    let third = third + (third >> 8);
    let guess = f32::from_bits(0x54a2_1000 - third);
    // (1 - h)^(-1/3) = 1 + h/3 + 2/9 h^2 + 14/81 h^3 ...
    let h = 1.0 - v * (guess * guess * guess);
    let inverse = guess + guess * (h * (1.0 / 3.0 + h * (2.0 / 9.0 + h * (14.0 / 81.0))));
    let square = inverse * inverse;
    let root = v * square;
    let root = root - (root * root * root - v) * (square * (1.0 / 3.0));
    if v < f32::MIN_POSITIVE { 0.0 } else { root }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cube_roots_are_exact_to_single_precision() {
        let mut v = 1e-30f32;
        while v < 1e30 {
            let exact = f64::from(v).cbrt();
            assert!((f64::from(cbrt(v)) / exact - 1.0).abs() < 1.2e-7, "{v}");
            v *= 1.0371;
        }
        assert_eq!([cbrt(0.0), cbrt(-1.0)].map(f32::to_bits), [0, 0]);
    }
}
