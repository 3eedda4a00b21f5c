//! Functions that give the same bits on every machine: only +, -, *, / and rounding, which IEEE 754 defines exactly.
//! Those of the standard library may differ in the last bit from system to system.

use std::f64::consts::{LN_2, PI};

/// e^x for -700..=700, by Taylor's series after taking out the powers of two.
pub(crate) fn exp(x: f64) -> f64 {
    let x = x.clamp(-700.0, 700.0);
    let twos = (x / LN_2).round();
    let rest = x - twos * LN_2;
    let series = (1..=16).rev().fold(1.0, |sum, n| 1.0 + sum * rest / f64::from(n));
    series * f64::from_bits(((twos as i64 + 1023) as u64) << 52)
}

/// 2^x for -1000..=1000; exact for whole numbers.
pub(crate) fn exp2(x: f64) -> f64 {
    let twos = x.clamp(-1000.0, 1000.0).round();
    exp((x - twos) * LN_2) * f64::from_bits(((twos as i64 + 1023) as u64) << 52)
}

/// x^(1/2.4) for x >= 0, the exponent of sRGB, by Newton's method from x^(3/8).
pub(crate) fn root_2_4(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let eighth = x.sqrt().sqrt().sqrt();
    let start = eighth * eighth * eighth;
    // y^12 = x^5.
    let x5 = x * x * x * x * x;
    (0..8).fold(start, |y, _| {
        let y3 = y * y * y;
        y - (y - x5 / (y3 * y3 * y3 * y * y)) / 12.0
    })
}

/// cos(2 pi t), by Taylor's series.
pub(crate) fn cosine_of_turns(t: f64) -> f64 {
    let x = 2.0 * PI * (t - t.round());
    (1..=13).rev().fold(1.0, |sum, n| 1.0 - sum * x * x / f64::from((2 * n - 1) * 2 * n))
}

/// exp(-x^2 / 2) about `centre` with standard deviation `width`.
pub(crate) fn gaussian(x: f64, centre: f64, width: f64) -> f64 {
    let z = (x - centre) / width;
    exp(-z * z / 2.0)
}

/// 0 below `low`, 1 above `high`, smooth between (3 t^2 - 2 t^3).
pub(crate) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_agree_with_the_standard_library() {
        for i in -400..400 {
            let x = f64::from(i) / 40.0;
            assert!((exp(x) / x.exp() - 1.0).abs() < 1e-13, "{x}");
            assert!((exp2(x) / x.exp2() - 1.0).abs() < 1e-13, "{x}");
            assert!((cosine_of_turns(x) - (2.0 * PI * x).cos()).abs() < 1e-12, "{x}");
            let y = x.abs();
            assert!((root_2_4(y) - y.powf(1.0 / 2.4)).abs() < 1e-12, "{y}");
        }
    }
}
