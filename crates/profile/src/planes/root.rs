//! A root polynomial over planes.
//!
//! All terms are products of a few shared roots: three square roots give order 2, three cube roots more give
//! order 3, three fourth roots (roots of the square roots) order 4. No power function is called.

use super::{BLOCK, Out, PlanePart};
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
}

impl PlanePart for RootPlanes {
    #[inline(always)]
    fn add(&self, [r, g, b]: [&[f32]; 3], out: &mut Out) {
        let n = r.len();
        let mut terms = Terms { channels: &self.coefficients, next: 0, out, n };
        terms.add(r, |v| v);
        terms.add(g, |v| v);
        terms.add(b, |v| v);
        if self.order >= Order::Two {
            let (sr, sg, sb) = (map(r, sqrt), map(g, sqrt), map(b, sqrt));
            terms.add2(&sr, &sg, |r, g| r * g);
            terms.add2(&sg, &sb, |g, b| g * b);
            terms.add2(&sr, &sb, |r, b| r * b);
            if self.order >= Order::Three {
                let (cr, cg, cb) = (map(r, cbrt), map(g, cbrt), map(b, cbrt));
                terms.add2(&cr, &cg, |r, g| r * (g * g));
                terms.add2(&cg, &cb, |g, b| g * (b * b));
                terms.add2(&cr, &cb, |r, b| r * (b * b));
                terms.add2(&cr, &cg, |r, g| (r * r) * g);
                terms.add2(&cg, &cb, |g, b| (g * g) * b);
                terms.add2(&cr, &cb, |r, b| (r * r) * b);
                terms.add3(&cr, &cg, &cb, |r, g, b| r * g * b);
            }
            if self.order >= Order::Four {
                let (fr, fg, fb) = (map(&sr[..n], sqrt), map(&sg[..n], sqrt), map(&sb[..n], sqrt));
                terms.add2(&fr, &fg, |r, g| (r * r) * (r * g));
                terms.add2(&fr, &fb, |r, b| (r * r) * (r * b));
                terms.add2(&fr, &fg, |r, g| (g * g) * (r * g));
                terms.add2(&fg, &fb, |g, b| (g * g) * (g * b));
                terms.add2(&fr, &fb, |r, b| (b * b) * (r * b));
                terms.add2(&fg, &fb, |g, b| (b * b) * (g * b));
                terms.add3(&fr, &fg, &fb, |r, g, b| (r * r) * (g * b));
                terms.add3(&fr, &fg, &fb, |r, g, b| (g * g) * (r * b));
                terms.add3(&fr, &fg, &fb, |r, g, b| (b * b) * (r * g));
            }
        }
    }
}

/// Adds term after term, in the sequence of [`Order::terms`].
struct Terms<'a> {
    channels: &'a [Vec<f32>; 3],
    next: usize,
    out: &'a mut Out,
    n: usize,
}

impl Terms<'_> {
    #[inline(always)]
    fn coefficients(&mut self) -> [f32; 3] {
        let i = self.next;
        self.next += 1;
        [self.channels[0][i], self.channels[1][i], self.channels[2][i]]
    }

    #[inline(always)]
    fn add(&mut self, a: &[f32], f: impl Fn(f32) -> f32) {
        let c = self.coefficients();
        let [x, y, z] = &mut *self.out;
        for (((x, y), z), &a) in x.iter_mut().zip(y).zip(z).zip(&a[..self.n]) {
            let t = f(a);
            *x += c[0] * t;
            *y += c[1] * t;
            *z += c[2] * t;
        }
    }

    #[inline(always)]
    fn add2(&mut self, a: &[f32; BLOCK], b: &[f32; BLOCK], f: impl Fn(f32, f32) -> f32) {
        let c = self.coefficients();
        let [x, y, z] = &mut *self.out;
        for ((((x, y), z), &a), &b) in x.iter_mut().zip(y).zip(z).zip(a).zip(b) {
            let t = f(a, b);
            *x += c[0] * t;
            *y += c[1] * t;
            *z += c[2] * t;
        }
    }

    #[inline(always)]
    fn add3(
        &mut self,
        a: &[f32; BLOCK],
        b: &[f32; BLOCK],
        d: &[f32; BLOCK],
        f: impl Fn(f32, f32, f32) -> f32,
    ) {
        let c = self.coefficients();
        let [x, y, z] = &mut *self.out;
        for (((((x, y), z), &a), &b), &d) in x.iter_mut().zip(y).zip(z).zip(a).zip(b).zip(d) {
            let t = f(a, b, d);
            *x += c[0] * t;
            *y += c[1] * t;
            *z += c[2] * t;
        }
    }
}

#[inline(always)]
fn map(values: &[f32], f: impl Fn(f32) -> f32) -> [f32; BLOCK] {
    let mut out = [0f32; BLOCK];
    for (o, &v) in out.iter_mut().zip(values) {
        *o = f(v);
    }
    out
}

#[inline(always)]
fn sqrt(v: f32) -> f32 {
    v.max(0.0).sqrt()
}

/// Cube root of a value of at least 0; negative values count as 0. A guess from the bits (Warren, "Hacker's
/// Delight", 11-2), then Halley's iteration twice: within 2 units in the last place for normal numbers.
#[inline(always)]
fn cbrt(v: f32) -> f32 {
    let v = v.max(0.0);
    // A third of the bits is a third of the exponent: 1/4 + 1/16, and that times 17/16 and 257/256. The constant
    // puts two thirds of the exponent's bias back.
    let bits = v.to_bits();
    let third = (bits >> 2) + (bits >> 4);
    let third = third + (third >> 4);
    let third = third + (third >> 8);
    let guess = f32::from_bits(third + 0x2a51_37a0);
    let halley = |y: f32| {
        let y3 = y * y * y;
        y * ((y3 + 2.0 * v) / (2.0 * y3 + v))
    };
    let root = halley(halley(guess));
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
            assert!((f64::from(cbrt(v)) / exact - 1.0).abs() < 3e-7, "{v}");
            v *= 1.0371;
        }
        assert_eq!([cbrt(0.0), cbrt(-1.0)].map(f32::to_bits), [0, 0]);
    }
}
