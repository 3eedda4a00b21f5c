//! Random numbers by place, not by order: the same seed and index give the same number, whoever asks first.

/// A number from 0 to 2^64 - 1 for each index (the SplitMix64 generator of Steele, Lea and Flood, 2014).
pub(crate) fn bits(seed: u64, index: u64) -> u64 {
    let mut z = seed.wrapping_add(index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A number with mean 0 and variance 1, nearly normal: the sum of twelve uniform ones (Irwin and Hall, 1927).
pub(crate) fn normal(seed: u64, index: u64) -> f64 {
    let sum: u64 = (0..3)
        .map(|i| {
            let b = bits(seed, index.wrapping_mul(3).wrapping_add(i));
            (b & 0xffff) + (b >> 16 & 0xffff) + (b >> 32 & 0xffff) + (b >> 48)
        })
        .sum();
    (sum as f64 + 6.0) / 65536.0 - 6.0
}

/// Smooth noise over the plane, -1 to 1, with features of about unit size (value noise, Perlin 1985 without the
/// gradients).
pub(crate) fn smooth_noise(seed: u64, x: f64, y: f64) -> f64 {
    let (x0, y0) = (x.floor(), y.floor());
    let corner = |dx: i64, dy: i64| {
        let (cx, cy) = ((x0 as i64 + dx) as u64, (y0 as i64 + dy) as u64);
        (bits(seed, cx.wrapping_mul(0x1_0000_0001).wrapping_add(cy.rotate_left(32))) >> 40) as f64
            / f64::from(1 << 23)
            - 1.0
    };
    let ease = |t: f64| t * t * (3.0 - 2.0 * t);
    let (tx, ty) = (ease(x - x0), ease(y - y0));
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    mix(mix(corner(0, 0), corner(1, 0), tx), mix(corner(0, 1), corner(1, 1), tx), ty)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_mean_0_and_variance_1() {
        let n = 100_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for i in 0..n {
            let v = normal(7, i);
            sum += v;
            squares += v * v;
        }
        assert!((sum / n as f64).abs() < 0.02 && (squares / n as f64 - 1.0).abs() < 0.02);
    }

    #[test]
    fn smooth_noise_has_no_steps() {
        for i in 0..1000 {
            let x = f64::from(i) / 100.0;
            assert!((smooth_noise(1, x, 0.3) - smooth_noise(1, x + 1e-6, 0.3)).abs() < 1e-5);
        }
    }
}
